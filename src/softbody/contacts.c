// contacts.c - nodes that touch shapes.
//
// In each substep it is found whom of the pieces near (near.c) a node reaches. A node that is on its way into a piece is held where it would enter it, one that is in it is pushed out
// slowly, so that nothing tunnels and nothing is shot out. The law is that of a stiff spring asked for at x' + h v' / 2
// (elements.c), stiff for all of the mass that may press: no restitution, and what is pressed sinks by less than
// g h^2 / 10. Friction: a damper that gives all that Coulomb's law allows at a slip of a four-hundredth of g h, so what is held
// creeps by less. Coulomb's law goes by the normal forces of the pass before, and after a few passes by those that it has then: so
// the function stays one, and convex, and Newton's iteration ends. Where they are others by then, it goes on, once, by
// these. What slides has no stiffness; a fiftieth of the secant's keeps light nodes from being sent far (DECISIONS.md).
//
// Reads: points, bodies and obstacles of the step. Writes: contacts, the matrix. Cost: O(what is near).
#include "softbody/softbody.h"

#include <math.h>

#define STIFFNESS 10.0 // of a contact, times mass / h^2
#define PUSH_OUT  0.2  // [m/s]
#define LAG       5    // passes; after these the normal forces that bound friction stay as they are
#define BOUND     0.3  // of all bounds of friction: a change that is worth more passes
#define SLIDING   0.02 // of the secant stiffness of what slides
#define LIES      0.05 // of its radius: nearer, a node has its contact wherever it is on its way to

//---- contacts of a substep -----------------------------------------------------------------------

double pl_soft_distance(const pl_soft_obstacle *o, double x, double y, double n[2])
{
    double best = INFINITY, out[2] = { 0, 1 }, inside = -INFINITY, in[2] = { 0, 1 };
    bool within = o->count > 2;
    for (int i = 0; i < o->count; ++i) {
        const int k = i + 1 < o->count ? i + 1 : 0;
        const double ex = o->x[k] - o->x[i], ey = o->y[k] - o->y[i];
        const double px = x - o->x[i], py = y - o->y[i], square = ex * ex + ey * ey;
        double t = square > 0 ? (px * ex + py * ey) / square : 0;
        t = t < 0 ? 0 : t > 1 ? 1 : t;
        const double dx = px - t * ex, dy = py - t * ey, d = dx * dx + dy * dy;
        if (d < best) {
            best = d, out[0] = dx, out[1] = dy;
        }
        if (o->count > 2) {
            const double length = sqrt(square), side = (px * ey - py * ex) / length;
            within &= side <= 0;
            if (side > inside) {
                inside = side, in[0] = ey / length, in[1] = -ex / length;
            }
        }
    }
    const double d = sqrt(best);
    if (within || d < 1e-9) {
        n[0] = in[0], n[1] = in[1];
        return (within ? inside : 0) - o->radius;
    }
    n[0] = out[0] / d, n[1] = out[1] / d;
    return d - o->radius;
}

// Where a node that moves by (dx, dy), in the frame of the piece, comes to be as near as its radius: by steps that are
// safe. False: nowhere.
static bool advance(const pl_soft_obstacle *o, double x, double y, double dx, double dy,
                    double radius, double n[2], double *gap)
{
    const double way = sqrt(dx * dx + dy * dy);
    const double start = pl_soft_distance(o, x, y, n) - radius;
    double t = 0, d = start;
    if (start <= LIES * radius) { // as it lies
        *gap = start;
        return true;
    }
    if (start > way) {
        return false;
    }
    for (int k = 0; k < 24 && d > 0.01 * radius; ++k) {
        t += d / way;
        if (t > 1) {
            return false;
        }
        d = pl_soft_distance(o, x + t * dx, y + t * dy, n) - radius;
    }
    *gap = d - t * (dx * n[0] + dy * n[1]); // from the plane that it would meet
    return true;
}

static bool touch(const pl_soft_step *s, const pl_soft_near *near, double h, pl_soft_contact *out)
{
    const pl_soft_obstacle *o = (const pl_soft_obstacle *)s->obstacles.data + near->obstacle;
    const pl_soft_body *b = pl_soft_bodies(s) + o->body;
    const pl_soft_point *p = pl_soft_points(s) + near->point;
    const double rx = p->x - b->x, ry = p->y - b->y;
    const double later = b->block == PL_NONE ? 0 : h;
    const double vx = p->vx + p->cx - (b->vx + later * b->ax - b->w * ry);
    const double vy = p->vy + p->cy - (b->vy + later * b->ay + b->w * rx);
    const double reach =
        1.5 * h * (fabs(vx) + fabs(vy)) + (1 + LIES) * p->radius + o->radius + o->extent;
    if (rx * rx + ry * ry > reach * reach) {
        return false;
    }
    double n[2], gap;
    if (!advance(o, b->c * rx + b->s * ry, b->c * ry - b->s * rx, 1.5 * h * (b->c * vx + b->s * vy),
                 1.5 * h * (b->c * vy - b->s * vx), p->radius, n, &gap)) {
        return false;
    }
    out->point = near->point;
    out->body = o->body;
    out->nx = b->c * n[0] - b->s * n[1];
    out->ny = b->s * n[0] + b->c * n[1];
    out->gap = gap > -PUSH_OUT * h ? gap : -PUSH_OUT * h;
    // Friction at the rim of a node turns the body, and a node has no spin that could take the same. What is moored hands
    // that on to the world; else it acts at the node's centre, and angular momentum stays (DECISIONS.md).
    const double rim = p->moored ? p->radius + gap : 0;
    out->rx = rx - rim * out->nx;
    out->ry = ry - rim * out->ny;
    const double heavy = p->heavy + (b->block == PL_NONE ? 0 : b->mass);
    out->stiffness = STIFFNESS * heavy / (h * h);
    out->friction = sqrt(o->friction * p->friction);
    out->force = out->most = 0;
    return true;
}

void pl_soft_find_contacts(plumb_world *world, double h)
{
    pl_soft_step *s = world->softbodies.step;
    const pl_soft_near *near = s->near_.data;
    pl_soft_contact *contacts = s->contacts.data;
    s->contact_count = 0;
    for (uint32_t k = 0; k < s->member_count; ++k) {
        pl_soft_member *m = &pl_soft_members(s)[k];
        m->first_contact = s->contact_count;
        for (uint32_t i = m->first_near; i < m->end_near; ++i) {
            s->contact_count += touch(s, &near[i], h, &contacts[s->contact_count]);
        }
        m->end_contact = s->contact_count;
    }
}

//---- what they press with ------------------------------------------------------------------------

// Along a direction d: of the node against the body.
typedef struct way {
    double node[2], body[3]; // by which unknowns it grows
} way;

static way way_along(const pl_soft_step *s, const pl_soft_contact *c, double x, double y)
{
    const pl_soft_body *b = pl_soft_bodies(s) + c->body;
    return (way){ { x, y },
                  { -x * b->locked_x, -y * b->locked_y, -(c->rx * y - c->ry * x) * b->locked_w } };
}

static double rate_of(const pl_soft_step *s, const pl_soft_contact *c, const way *w, bool added)
{
    const pl_soft_point *p = pl_soft_points(s) + c->point;
    const pl_soft_body *b = pl_soft_bodies(s) + c->body;
    if (added) {
        const double of_node = p->cx * w->node[0] + p->cy * w->node[1];
        const double *u = s->matrix.u + (b->block == PL_NONE ? 0 : 3 * (size_t)b->block);
        return b->block == PL_NONE
                   ? of_node
                   : of_node + u[0] * w->body[0] + u[1] * w->body[1] + u[2] * w->body[2];
    }
    const double x = w->node[0], y = w->node[1];
    return p->vx * x + p->vy * y - b->vx * x - b->vy * y - b->w * (c->rx * y - c->ry * x);
}

// An impulse along a way, and a stiffness for the matrix.
static void act(const pl_soft_step *s, const pl_soft_contact *c, const way *w, double impulse,
                double stiff, pl_soft_fill fill)
{
    const pl_soft_matrix *m = &s->matrix;
    const pl_soft_point *p = pl_soft_points(s) + c->point;
    const pl_soft_body *b = pl_soft_bodies(s) + c->body;
    const bool moves = b->block != PL_NONE;
    double *right = m->right + 3 * (size_t)p->block;
    for (int r = 0; r < 2; ++r) {
        right[r] += impulse * w->node[r];
    }
    for (int r = 0; r < 3 && moves; ++r) {
        m->right[3 * (size_t)b->block + (size_t)r] += impulse * w->body[r];
    }
    if (fill != PL_SOFT_ALL) {
        return;
    }
    double *own = m->diagonal + 9 * (size_t)p->block;
    for (int r = 0; r < 2; ++r) {
        own[3 * r] += stiff * w->node[r] * w->node[0];
        own[3 * r + 1] += stiff * w->node[r] * w->node[1];
    }
    if (!moves) {
        return;
    }
    const bool behind = b->block > p->block;
    double *other =
        behind ? pl_soft_entry(m, b->block, p->block) : pl_soft_entry(m, p->block, b->block);
    double *body = m->diagonal + 9 * (size_t)b->block;
    for (int r = 0; r < 3; ++r) {
        for (int k = 0; k < 3; ++k) {
            body[3 * r + k] += stiff * w->body[r] * w->body[k];
        }
        other[behind ? 3 * r : r] += stiff * w->body[r] * w->node[0];
        other[behind ? 3 * r + 1 : 3 + r] += stiff * w->body[r] * w->node[1];
    }
}

static double press(const pl_soft_step *s, pl_soft_contact *c, int pass, double h,
                    pl_soft_fill fill)
{
    const way n = way_along(s, c, c->nx, c->ny), t = way_along(s, c, -c->ny, c->nx);
    const double gap = c->gap + h * (1.5 * rate_of(s, c, &n, false) + rate_of(s, c, &n, true));
    const double force = gap < 0 ? -c->stiffness * gap : 0;
    if (fill == PL_SOFT_ALL) {
        c->most = pass == 0 ? 0 : pass < LAG ? c->friction * force : c->most;
    }
    c->force = force;
    double energy = force * -gap / 2;
    if (force > 0 && fill != PL_SOFT_VALUE) {
        act(s, c, &n, h * force, h * h * c->stiffness, fill);
    }
    if (!(c->most > 0)) {
        return energy;
    }
    const double slip = rate_of(s, c, &t, false) + rate_of(s, c, &t, true), speed = fabs(slip);
    const bool slides = speed > s->creep;
    const double hold = c->most / (slides ? speed : s->creep);
    energy += h * c->most * (slides ? speed - s->creep / 2 : speed * speed / (2 * s->creep));
    if (fill != PL_SOFT_VALUE) {
        act(s, c, &t, -h * hold * slip, h * hold * (slides ? SLIDING : 1), fill);
    }
    return energy;
}

// Of a group: its members' contacts are one behind the other.
static uint32_t first_contact(const pl_soft_step *s, const pl_soft_group *g)
{
    return pl_soft_members(s)[g->first_member].first_contact;
}

static uint32_t end_contact(const pl_soft_step *s, const pl_soft_group *g)
{
    return pl_soft_members(s)[g->end_member - 1].end_contact;
}

double pl_soft_press(const pl_soft_step *s, const pl_soft_group *g, double h, pl_soft_fill fill)
{
    pl_soft_contact *contacts = s->contacts.data;
    double energy = 0;
    for (uint32_t i = first_contact(s, g); i < end_contact(s, g); ++i) {
        energy += press(s, &contacts[i], g->pass, h, fill);
    }
    return energy;
}

// So early as the first passes end normal forces may be those of a rope that is not tight yet.
bool pl_soft_bind(const pl_soft_step *s, pl_soft_group *g)
{
    pl_soft_contact *contacts = s->contacts.data;
    double changed = 0, sum = 0;
    for (uint32_t i = first_contact(s, g); i < end_contact(s, g); ++i) {
        pl_soft_contact *c = &contacts[i];
        const double most = c->friction * c->force;
        changed += fabs(most - c->most);
        sum += most;
        c->most = most;
    }
    g->pass = g->pass < LAG ? LAG : g->pass; // from now on they stay
    return changed > BOUND * sum;
}
