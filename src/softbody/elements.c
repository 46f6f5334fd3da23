// elements.c - edges, bends, triangles, gas: what they pull with, how stiff they are.
//
// A substep takes nodes by x' = x + h (v + v') / 2, as the solver takes bodies. An element's force is asked for in the
// middle, at x + h v / 2 + h u / 4, u = v' - v: the implicit midpoint rule, of second order, which loses neither energy nor
// momentum nor angular momentum. To that comes a damper beside each spring, of s h k for a spring of k, that sees
// the rate of v + 3 u / 4. With s = 1 what is infinitely stiff is at rest at once (both eigenvalues are 0), the product of the
// eigenvalues of a stiff mode is (1 - s) / (1 + 3 s), and a slow one has a damping ratio of s w h / 2. Each element has its
// s = z^2 / (z^2 + SOFTNESS), z = h sqrt(k / m): what the substep sees is kept, the error is of second order; what is
// faster dies out. A damper does not see turns, so that what swings and spins is not slowed.
//
// Edges have no such damper: it and the turning of thread that is stiff, limp and heavily loaded gained energy between them
// (DECISIONS.md). They are asked for at x + (1/2 + s) h v + (1/4 + 3 s / 4) h u, s up to 1/2: for one along the other the
// same equation, and a gradient whatever turns. What swings is damped a little, by s w h / 2.
//
// All forces but dampers and friction are gradients by u of one function; with these it is one nearly, and Newton's iteration
// makes it least (step.c).
//
// Edge: k (l - length)^2 / 2, of thread only where l is longer. Bend: E = (E I / 2 L) (turn - angle)^2.
// Triangle: stable neo-Hookean, psi = mu / 2 (tr F'F - 2) + lambda / 2 (det F - 1 - mu / lambda)^2 (Smith, de Goes, Kim
// 2018, ACM Trans. Graph. 37), in the plane: mu = E / 2 (1 + nu), lambda = E nu / (1 - nu^2) + mu. Gas: (p + ambient) A is
// constant; how it stiffens is one more unknown, for it ties all nodes of the ring to each other.
// Matrices of stiffness are made positive definite: what would make them otherwise is left out (Newton's
// iteration then takes more passes and ends in the same place).
//
// Reads: points, elements. Writes: the matrix and its right side. Cost: O(elements) a pass.
#include "math/trig.h"
#include "softbody/softbody.h"

#include <math.h>

#define SOFTNESS 16.0 // of z^2: where s is one half
#define LATE     PL_SOFT_LATE

#define LEAD_MOST     0.5 // of s of edges
#define LEAD_SOFTNESS 8.0

//---- when forces are asked for -------------------------------------------------------------------

// [s] of the damper beside a spring, over its stiffness: of what is h^2 k / m = z2.
static double calm(double z2, double h)
{
    return h * z2 / (z2 + SOFTNESS);
}

static void place(const pl_soft_point *p, double h, double out[2])
{
    out[0] = p->x + h * (p->vx / 2 + p->cx / 4);
    out[1] = p->y + h * (p->vy / 2 + p->cy / 4);
}

static double ease(const pl_soft_point *p)
{
    return p->block == PL_NONE || p->body != PL_NONE ? 0 : 1 / p->mass;
}

//---- edges ---------------------------------------------------------------------------------------

// What an edge is asked for along its way q = n . (u_b - u_a): stretch and its rate, and how they grow with q.
typedef struct asked {
    double stretch, rate; // [m], [m/s]
    double late, share;   // [s], [-]
} asked;

// Its answer: tension [N], how it grows with q [kg/s^2], its part in the function over h.
typedef struct answer {
    double tension, slope, part;
} answer;

static answer spring_and_damper(double k, double c, const asked *e)
{
    return (answer){ k * e->stretch + c * e->rate, k * e->late + c * e->share,
                     k * e->stretch * e->stretch / (2 * e->late) +
                         c * e->rate * e->rate / (2 * e->share) };
}

// A thread pulls only where it is longer than at rest, as it is here, and its damper no more than its spring: what would be there at once
// with the first stretch would have no least function, and passes went to and fro about it. Along q the rate is `own`
// where the thread is at its length, and grows by `turn` with the stretch; the damper is the spring's equal up to the stretch
// `from`, or, where it is the faster to grow, from `to` on.
static answer thread(double k, double c, const asked *e)
{
    const double s = e->stretch, turn = e->share / e->late, own = e->rate - turn * s;
    const double equal = k - c * turn, meets = equal != 0 ? c * own / equal : -1;
    const double from = own >= 0 ? (equal > 0 ? meets : INFINITY) : -c * own / (k + c * turn);
    const double to = own < 0 && equal < 0 ? meets : INFINITY;
    const double first = own >= 0 ? k : 0; // 2 k s or nothing up to `from`
    if (s <= from) {
        return (answer){ 2 * first * s, 2 * first * e->late, first * s * s / e->late };
    }
    const double end = s < to ? s : to;
    const double part = first * from * from + (k + c * turn) * (end * end - from * from) / 2 +
                        c * own * (end - from) + (s > to ? k * (s * s - to * to) : 0);
    return s > to ? (answer){ 2 * k * s, 2 * k * e->late, part / e->late }
                  : (answer){ k * s + c * e->rate, k * e->late + c * e->share, part / e->late };
}

// What of an edge stays as it is while a substep is solved.
static void see_edge(const pl_soft_step *s, const plumb_softbody_edge *e, uint32_t first, double h,
                     pl_soft_pull *out)
{
    const pl_soft_point *a = pl_soft_point_at(s, first + e->a);
    const pl_soft_point *b = pl_soft_point_at(s, first + e->b);
    const double k = (double)e->stiffness, follow = a->follow * k;
    const double c = (double)e->damping + follow, w = ease(a) + ease(b);
    const double z2 = h * h * k * w, zc = h * c * w;
    const double lead = LEAD_MOST * z2 / (z2 + LEAD_SOFTNESS);
    out->damping = c;
    out->of = c > 0 ? follow / c : 0;
    out->ahead = h * (0.5 + lead), out->late = h * (0.25 + 0.75 * lead);
    out->share = 0.5 + 0.5 * zc / (zc + 4);
}

void pl_soft_see_edges(plumb_world *world, double h)
{
    const pl_softbodies *all = &world->softbodies;
    const pl_soft_step *s = all->step;
    for (uint32_t i = 0; i < s->member_count; ++i) {
        const pl_soft_member *m = &pl_soft_members(s)[i];
        const plumb_softbody_edge *edges = pl_softbody_edges(all) + m->at.edge;
        pl_soft_pull *pulls = (pl_soft_pull *)s->pulls.data + m->at.edge;
        for (uint32_t k = 0; k < pl_softbody_items(all)[m->item].edges; ++k) {
            see_edge(s, &edges[k], m->at.point, h, &pulls[k]);
        }
    }
}

// How an edge answers: its stiffness goes to both ends, and between them.
static void stiffen(const pl_soft_step *s, uint32_t ia, uint32_t ib, const double own[4])
{
    const double other[4] = { -own[0], -own[1], -own[2], -own[3] };
    pl_soft_add(s, ia, ia, own);
    pl_soft_add(s, ib, ib, own);
    pl_soft_add(s, ia, ib, other);
}

static double pull(const pl_soft_step *s, const plumb_softbody_edge *e, uint32_t first, double h,
                   pl_soft_fill fill, pl_soft_pull *now)
{
    const uint32_t ia = first + e->a, ib = first + e->b;
    const pl_soft_point *a = pl_soft_point_at(s, ia), *b = pl_soft_point_at(s, ib);
    const double k = (double)e->stiffness, rest = (double)e->length;
    const double ta = now->ahead, tb = now->late, share = now->share, of = now->of;
    const double dx = b->x - a->x + ta * (b->vx - a->vx) + tb * (b->cx - a->cx);
    const double dy = b->y - a->y + ta * (b->vy - a->vy) + tb * (b->cy - a->cy);
    const double length = sqrt(dx * dx + dy * dy), stretch = length - rest;
    const bool pulls = (e->flags & PLUMB_EDGE_PULLS) != 0;
    now->tension = 0, now->stretch = stretch;
    if (length < 1e-12 || (pulls && stretch <= 0)) {
        return 0;
    }
    const double x = dx / length, y = dy / length;
    const double rate = x * (b->vx - a->vx + share * (b->cx - a->cx) - of * (b->way_x - a->way_x)) +
                        y * (b->vy - a->vy + share * (b->cy - a->cy) - of * (b->way_y - a->way_y));
    const asked way = { stretch, rate, tb, share };
    const answer f =
        pulls ? thread(k, now->damping, &way) : spring_and_damper(k, now->damping, &way);
    now->tension = f.tension;
    if (fill != PL_SOFT_VALUE && f.tension != 0) {
        pl_soft_push(s, ia, h * f.tension * x, h * f.tension * y);
        pl_soft_push(s, ib, -h * f.tension * x, -h * f.tension * y);
    }
    if (fill == PL_SOFT_ALL && (f.tension != 0 || f.slope != 0)) {
        const double along = h * f.slope, across = stretch > 0 ? h * tb * k * stretch / length : 0;
        stiffen(s, ia, ib,
                (const double[4]){ along * x * x + across * y * y, (along - across) * x * y,
                                   (along - across) * x * y, along * y * y + across * x * x });
    }
    return h * f.part;
}

// Of a force that grows with u along its way by `slope` a unit of it [kg/s]: its part in the function.
static double part_of(double force, double slope, double h)
{
    return slope > 0 ? h * force * force / (2 * slope) : 0;
}

//---- bends ---------------------------------------------------------------------------------------

static double turn_of(const double a[2], const double b[2], const double c[2])
{
    const double ux = b[0] - a[0], uy = b[1] - a[1], vx = c[0] - b[0], vy = c[1] - b[1];
    return pl_atan2(ux * vy - uy * vx, ux * vx + uy * vy);
}

// How a turn grows with the places of its nodes.
static bool turn_slopes(const double a[2], const double b[2], const double c[2], double out[6])
{
    const double ux = b[0] - a[0], uy = b[1] - a[1], vx = c[0] - b[0], vy = c[1] - b[1];
    const double u = ux * ux + uy * uy, v = vx * vx + vy * vy;
    if (u < 1e-24 || v < 1e-24) {
        return false;
    }
    out[0] = -uy / u, out[1] = ux / u;
    out[4] = -vy / v, out[5] = vx / v;
    out[2] = -out[0] - out[4], out[3] = -out[1] - out[5];
    return true;
}

static double wrapped(double angle)
{
    const double pi = 3.14159265358979323846;
    return angle > pi ? angle - 2 * pi : angle < -pi ? angle + 2 * pi : angle;
}

static double bend(const pl_soft_step *s, const plumb_softbody_bend *e, uint32_t first, double h,
                   pl_soft_fill fill)
{
    const uint32_t i[3] = { first + e->a, first + e->b, first + e->c };
    const double k = (double)e->stiffness / (double)e->length, l = (double)e->length;
    const double w = ease(pl_soft_point_at(s, i[0])) + 4 * ease(pl_soft_point_at(s, i[1])) +
                     ease(pl_soft_point_at(s, i[2]));
    const double follow = pl_soft_point_at(s, i[1])->follow * k;
    const double c = k * calm(h * h * k * w / (l * l), h) + follow, slope = h * k / 4 + LATE * c;
    const double of = c > 0 ? follow / c : 0;
    double p[3][2], g[6], rate = 0;
    for (int n = 0; n < 3; ++n) {
        place(pl_soft_point_at(s, i[n]), h, p[n]);
    }
    if (!turn_slopes(p[0], p[1], p[2], g)) {
        return 0;
    }
    for (int n = 0; n < 3; ++n) {
        const pl_soft_point *q = pl_soft_point_at(s, i[n]);
        rate += g[2 * n] * (q->vx + LATE * q->cx - of * q->way_x) +
                g[2 * n + 1] * (q->vy + LATE * q->cy - of * q->way_y);
    }
    const double turn = wrapped(turn_of(p[0], p[1], p[2]) - (double)e->angle);
    const double moment = k * turn + c * rate;
    for (int n = 0; n < 3 && fill != PL_SOFT_VALUE; ++n) {
        pl_soft_push(s, i[n], -h * moment * g[2 * n], -h * moment * g[2 * n + 1]);
        for (int o = n; o < 3 && fill == PL_SOFT_ALL; ++o) {
            const double x = h * slope * g[2 * n], y = h * slope * g[2 * n + 1];
            const double block[4] = { x * g[2 * o], x * g[2 * o + 1], y * g[2 * o],
                                      y * g[2 * o + 1] };
            pl_soft_add(s, i[n], i[o], block);
        }
    }
    return part_of(moment, slope, h);
}

//---- triangles -----------------------------------------------------------------------------------

// A triangle at rest: gradients of its nodes' shares, its area, its constants.
typedef struct sheet {
    double g[3][2];
    double area, mu, lambda;
} sheet;

static bool sheet_of(const plumb_softbody_triangle *e, sheet *out)
{
    const double ux = (double)e->ab.x, uy = (double)e->ab.y;
    const double vx = (double)e->ac.x, vy = (double)e->ac.y, d = ux * vy - uy * vx;
    const double young = (double)e->young, nu = (double)e->poisson;
    if (!(d > 0)) {
        return false;
    }
    out->g[1][0] = vy / d, out->g[1][1] = -vx / d;
    out->g[2][0] = -uy / d, out->g[2][1] = ux / d;
    out->g[0][0] = -out->g[1][0] - out->g[2][0], out->g[0][1] = -out->g[1][1] - out->g[2][1];
    out->area = d / 2;
    out->mu = young / (2 * (1 + nu));
    out->lambda = young * nu / (1 - nu * nu) + out->mu;
    return true;
}

// F by rows.
static void deform(const sheet *t, const double p[3][2], double f[4])
{
    f[0] = f[1] = f[2] = f[3] = 0;
    for (int n = 0; n < 3; ++n) {
        f[0] += p[n][0] * t->g[n][0], f[1] += p[n][0] * t->g[n][1];
        f[2] += p[n][1] * t->g[n][0], f[3] += p[n][1] * t->g[n][1];
    }
}

// [J] over its area.
static double density_of(const sheet *t, const double f[4])
{
    const double squares = f[0] * f[0] + f[1] * f[1] + f[2] * f[2] + f[3] * f[3];
    const double j = f[0] * f[3] - f[1] * f[2] - 1, off = t->mu / t->lambda;
    return t->mu / 2 * (squares - 2) + t->lambda / 2 * (j * j - 2 * j * off);
}

static double stretch(const pl_soft_step *s, const plumb_softbody_triangle *e, uint32_t first,
                      double h, pl_soft_fill fill)
{
    const uint32_t i[3] = { first + e->a, first + e->b, first + e->c };
    sheet t;
    if (!sheet_of(e, &t)) {
        return 0;
    }
    double w = 0;
    for (int n = 0; n < 3; ++n) {
        w += ease(pl_soft_point_at(s, i[n])) * (t.g[n][0] * t.g[n][0] + t.g[n][1] * t.g[n][1]);
    }
    const double follow = pl_soft_point_at(s, i[0])->follow;
    const double time =
        (double)e->damping + calm(h * h * (t.lambda + t.mu) * t.area * w, h) + follow;
    const double of = time > 0 ? follow / time : 0;
    double p[3][2], f[4], slope[3][2];
    for (int n = 0; n < 3; ++n) {
        place(pl_soft_point_at(s, i[n]), h, p[n]);
    }
    deform(&t, (const double(*)[2])p, f);
    const double excess = t.lambda * (f[0] * f[3] - f[1] * f[2] - 1) - t.mu;
    const double twist = excess > t.mu ? t.mu : excess < -t.mu ? -t.mu : excess;
    for (int n = 0; n < 3; ++n) { // of det F
        slope[n][0] = f[3] * t.g[n][0] - f[2] * t.g[n][1];
        slope[n][1] = f[0] * t.g[n][1] - f[1] * t.g[n][0];
    }
    // The damper sees the rate of Green's strain (11, 22, twice 12), which no turn has.
    double sees[3][3][2], rate[3] = { 0, 0, 0 };
    for (int n = 0; n < 3; ++n) {
        const pl_soft_point *q = pl_soft_point_at(s, i[n]);
        for (int k = 0; k < 2; ++k) {
            const double f1 = f[2 * k], f2 = f[2 * k + 1];
            const double v = k == 0 ? q->vx + LATE * q->cx - of * q->way_x
                                    : q->vy + LATE * q->cy - of * q->way_y;
            sees[0][n][k] = f1 * t.g[n][0], sees[1][n][k] = f2 * t.g[n][1];
            sees[2][n][k] = f1 * t.g[n][1] + f2 * t.g[n][0];
            for (int c = 0; c < 3; ++c) {
                rate[c] += sees[c][n][k] * v;
            }
        }
    }
    const double sum = time * (t.lambda - t.mu) * (rate[0] + rate[1]);
    const double stress[3] = { sum + 2 * time * t.mu * rate[0], sum + 2 * time * t.mu * rate[1],
                               time * t.mu * rate[2] };
    if (fill != PL_SOFT_VALUE) {
        const double near = h * h / 4 * t.area, late = h * LATE * time * t.area;
        for (int n = 0; n < 3; ++n) {
            double push[2], drag[3][2];
            for (int k = 0; k < 2; ++k) {
                push[k] =
                    t.mu * (f[2 * k] * t.g[n][0] + f[2 * k + 1] * t.g[n][1]) + excess * slope[n][k];
                const double both = sees[0][n][k] + sees[1][n][k];
                drag[0][k] = (t.lambda - t.mu) * both + 2 * t.mu * sees[0][n][k];
                drag[1][k] = (t.lambda - t.mu) * both + 2 * t.mu * sees[1][n][k];
                drag[2][k] = t.mu * sees[2][n][k];
                for (int c = 0; c < 3; ++c) {
                    push[k] += stress[c] * sees[c][n][k];
                }
            }
            pl_soft_push(s, i[n], -h * t.area * push[0], -h * t.area * push[1]);
            for (int o = n; o < 3 && fill == PL_SOFT_ALL; ++o) {
                const double even = t.mu * (t.g[n][0] * t.g[o][0] + t.g[n][1] * t.g[o][1]);
                const double cross = twist * (t.g[n][0] * t.g[o][1] - t.g[n][1] * t.g[o][0]);
                double block[4] = { even, cross, -cross, even };
                for (int k = 0; k < 4; ++k) {
                    const int r = k / 2, c = k % 2;
                    block[k] = near * (block[k] + t.lambda * slope[n][r] * slope[o][c]);
                    for (int q = 0; q < 3; ++q) {
                        block[k] += late * drag[q][r] * sees[q][o][c];
                    }
                }
                pl_soft_add(s, i[n], i[o], block);
            }
        }
    }
    const double lost = stress[0] * rate[0] + stress[1] * rate[1] + stress[2] * rate[2];
    return t.area * (4 * density_of(&t, f) + h * lost / (2 * LATE));
}

//---- gas -----------------------------------------------------------------------------------------

double pl_soft_pressure(const pl_softbody *item, double area)
{
    const double outside = (double)item->ambient, rest = (double)item->area;
    const double least = rest * 1e-3;
    return ((double)item->pressure + outside) * rest / (area > least ? area : least) - outside;
}

// Natural logarithm of x > 0, by roots and a series.
static double logarithm(double x)
{
    double scale = 2;
    for (; x > 1.1 || x < 0.9; scale *= 2) {
        x = sqrt(x);
    }
    const double t = (x - 1) / (x + 1), q = t * t;
    return scale * t * (1 + q * (1 / 3.0 + q * (1 / 5.0 + q * (1 / 7.0 + q / 9.0))));
}

static double energy_of_gas(const pl_softbody *item, double area)
{
    const double rest = (double)item->area, outside = (double)item->ambient;
    return -((double)item->pressure + outside) * rest *
               logarithm(area > rest * 1e-3 ? area / rest : 1e-3) +
           outside * (area - rest);
}

// How the area grows with the place of a node of the ring.
static void slope_of_area(const pl_soft_step *s, uint32_t first, const uint32_t *ring, uint32_t n,
                          uint32_t i, double h, double out[2])
{
    double before[2], behind[2];
    place(pl_soft_point_at(s, first + ring[(i + n - 1) % n]), h, before);
    place(pl_soft_point_at(s, first + ring[(i + 1) % n]), h, behind);
    out[0] = (behind[1] - before[1]) / 2, out[1] = (before[0] - behind[0]) / 2;
}

// Its unknown is the impulse of pressure, scaled so that the matrix is symmetric.
static double inflate(const pl_soft_step *s, const pl_softbody *item, uint32_t first,
                      const uint32_t *ring, uint32_t block, double h, pl_soft_fill fill)
{
    const pl_soft_matrix *mx = &s->matrix;
    const uint32_t n = item->ring;
    double area = 0, rate = 0, p[3][2];
    place(pl_soft_point_at(s, first + ring[n - 1]), h, p[0]);
    for (uint32_t i = 0; i < n; ++i) {
        place(pl_soft_point_at(s, first + ring[i]), h, p[1]);
        area += (p[0][0] * p[1][1] - p[0][1] * p[1][0]) / 2;
        p[0][0] = p[1][0], p[0][1] = p[1][1];
    }
    const double least = (double)item->area * 1e-3, held = area > least ? area : least;
    const double pressure = pl_soft_pressure(item, area);
    const double stiff = (pressure + (double)item->ambient) / held;
    const double follow = pl_soft_point_at(s, first + ring[0])->follow;
    const double c = stiff * (h / 2 + follow), of = follow / (h / 2 + follow);
    if (fill == PL_SOFT_ALL) {
        mx->diagonal[9 * (size_t)block] = stiff > 0 ? -1 / (h * (h * stiff / 4 + LATE * c)) : -1;
    }
    for (uint32_t i = 0; i < n; ++i) {
        const pl_soft_point *node = pl_soft_point_at(s, first + ring[i]);
        double g[2];
        slope_of_area(s, first, ring, n, i, h, g);
        rate += g[0] * (node->vx + LATE * node->cx - of * node->way_x) +
                g[1] * (node->vy + LATE * node->cy - of * node->way_y);
    }
    for (uint32_t i = 0; i < n && fill != PL_SOFT_VALUE; ++i) {
        const uint32_t at = first + ring[i];
        double g[2], j[6];
        slope_of_area(s, first, ring, n, i, h, g);
        pl_soft_push(s, at, h * (pressure - c * rate) * g[0], h * (pressure - c * rate) * g[1]);
        const pl_soft_point *node = pl_soft_point_at(s, at);
        if (fill != PL_SOFT_ALL || node->block == PL_NONE || !(stiff > 0)) {
            continue;
        }
        pl_soft_follow(s, node, j);
        const bool behind = block > node->block;
        double *to =
            behind ? pl_soft_entry(mx, block, node->block) : pl_soft_entry(mx, node->block, block);
        for (int k = 0; k < 3; ++k) {
            to[behind ? k : 3 * k] += g[0] * j[k] + g[1] * j[3 + k];
        }
    }
    return 4 * energy_of_gas(item, area) + h * c * rate * rate / (2 * LATE);
}

//---- all of them ---------------------------------------------------------------------------------

static double elements_of(const pl_softbodies *all, const pl_soft_member *m, double h,
                          pl_soft_fill fill)
{
    const pl_soft_step *s = all->step;
    const pl_softbody *item = &pl_softbody_items(all)[m->item];
    const pl_softbody_place at = m->at;
    pl_soft_pull *pulls = (pl_soft_pull *)s->pulls.data + at.edge;
    double energy = 0;
    for (uint32_t k = 0; k < item->edges; ++k) {
        const plumb_softbody_edge *e = &pl_softbody_edges(all)[at.edge + k];
        if ((e->flags & PLUMB_EDGE_TORN) == 0) {
            energy += pull(s, e, at.point, h, fill, &pulls[k]);
        }
    }
    for (uint32_t k = 0; k < item->bends; ++k) {
        energy += bend(s, &pl_softbody_bends(all)[at.bend + k], at.point, h, fill);
    }
    if (item->ring > 0) {
        energy += inflate(s, item, at.point, pl_softbody_rings(all) + at.ring, m->gas, h, fill);
    }
    return energy;
}

double pl_soft_triangles(plumb_world *world, const pl_soft_group *g, double h, pl_soft_fill fill)
{
    const pl_softbodies *all = &world->softbodies;
    const pl_soft_step *s = all->step;
    double energy = 0;
    for (uint32_t i = g->first_member; i < g->end_member; ++i) {
        const pl_soft_member *m = &pl_soft_members(s)[i];
        const plumb_softbody_triangle *triangles = pl_softbody_triangles(all) + m->at.triangle;
        for (uint32_t k = 0; k < pl_softbody_items(all)[m->item].triangles; ++k) {
            energy += stretch(s, &triangles[k], m->at.point, h, fill);
        }
    }
    return energy;
}

double pl_soft_elements(plumb_world *world, const pl_soft_group *g, double h, pl_soft_fill fill)
{
    const pl_softbodies *all = &world->softbodies;
    double energy = 0;
    for (uint32_t i = g->first_member; i < g->end_member; ++i) {
        energy += elements_of(all, &pl_soft_members(all->step)[i], h, fill);
    }
    return energy;
}

//---- energy --------------------------------------------------------------------------------------

double pl_soft_area(const plumb_world *world, const pl_softbody *item, pl_softbody_place at)
{
    const plumb_softbody_node *nodes = pl_softbody_nodes(&world->softbodies) + at.node;
    double area = 0, p[2], q[2];
    for (uint32_t i = 0; i < item->ring; ++i) {
        const uint32_t *ring = pl_softbody_rings(&world->softbodies) + at.ring;
        pl_soft_node_place(&nodes[ring[i]], p);
        pl_soft_node_place(&nodes[ring[(i + 1) % item->ring]], q);
        area += (p[0] * q[1] - p[1] * q[0]) / 2;
    }
    return area;
}

static double length_of(const plumb_softbody_node *nodes, const plumb_softbody_edge *e)
{
    double a[2], b[2];
    pl_soft_node_place(&nodes[e->a], a);
    pl_soft_node_place(&nodes[e->b], b);
    const double dx = b[0] - a[0], dy = b[1] - a[1];
    return sqrt(dx * dx + dy * dy);
}

double pl_soft_elastic(const plumb_world *world, uint32_t row, pl_softbody_place at)
{
    const pl_softbodies *all = &world->softbodies;
    const pl_softbody *item = &pl_softbody_items(all)[row];
    const plumb_softbody_node *nodes = pl_softbody_nodes(all) + at.node;
    double sum = item->ring > 0 ? energy_of_gas(item, pl_soft_area(world, item, at)) : 0;
    for (uint32_t k = 0; k < item->edges; ++k) {
        const plumb_softbody_edge *e = &pl_softbody_edges(all)[at.edge + k];
        const double d = length_of(nodes, e) - (double)e->length;
        const bool idle =
            (e->flags & PLUMB_EDGE_TORN) != 0 || ((e->flags & PLUMB_EDGE_PULLS) != 0 && d < 0);
        sum += idle ? 0 : (double)e->stiffness * d * d / 2;
    }
    for (uint32_t k = 0; k < item->bends; ++k) {
        const plumb_softbody_bend *e = &pl_softbody_bends(all)[at.bend + k];
        double a[2], b[2], c[2];
        pl_soft_node_place(&nodes[e->a], a);
        pl_soft_node_place(&nodes[e->b], b);
        pl_soft_node_place(&nodes[e->c], c);
        const double turn = wrapped(turn_of(a, b, c) - (double)e->angle);
        sum += (double)e->stiffness / (double)e->length * turn * turn / 2;
    }
    for (uint32_t k = 0; k < item->triangles; ++k) {
        const plumb_softbody_triangle *e = &pl_softbody_triangles(all)[at.triangle + k];
        sheet t;
        double p[3][2], f[4];
        if (!sheet_of(e, &t)) {
            continue;
        }
        pl_soft_node_place(&nodes[e->a], p[0]);
        pl_soft_node_place(&nodes[e->b], p[1]);
        pl_soft_node_place(&nodes[e->c], p[2]);
        deform(&t, (const double(*)[2])p, f);
        sum += t.area * density_of(&t, f);
    }
    return sum;
}
