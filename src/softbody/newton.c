// newton.c - a substep of soft bodies: Newton's iteration finds what it adds to the velocities of nodes and of the bodies that are
// solved with them, u: M u = h f(u), as the place where a function is least (elements.c, contacts.c).
//
// Reads: solver bodies, elements, contacts. Writes: points, accelerations of bodies. Cost: passes times what the matrix costs.
#include "math/trig.h"
#include "softbody/softbody.h"

#include <math.h>
#include <string.h>

#define ROUNDS 2    // of passes: friction of the second goes by the normal forces of the first
#define CHORDS 12   // of a way, at most
#define NARROW 1e-3 // part of a way that is not worth another
#define LEVEL  0.01 // of the slope that a way begins with: what it may end with
#define CREEP                                                                                      \
    2.5e-3 // of what gravity adds to velocities: the slip at which friction is all that Coulomb's law gives
#define CREEP_LEAST 1e-5 // [m/s] likewise where nothing falls: less, and passes do not end
#define ENOUGH_OF_IT                                                                               \
    0.25 // of what is gained along the whole way, where a half is what Newton's step promises
#define SMALL 1e-3 // of what gravity adds to velocities: what the last pass may
#define TOLD  0.1  // likewise: what is told, where passes end before

static void turn(pl_soft_body *b, double angle)
{
    double s, c;
    pl_sincos(angle, &s, &c);
    b->c = b->c0 * c - b->s0 * s;
    b->s = b->s0 * c + b->c0 * s;
}

// A node that a body holds. Its arm is the mean of those that it begins and ends with, as far as the body's motion is known: forces act
// at the mean of both places, and an arm from the beginning would turn the body by itself.
static void hold(const pl_soft_body *b, double h, pl_soft_point *p)
{
    double s, c;
    pl_sincos(h * (b->w + h * b->aw / 2), &s, &c);
    const double x = b->c * p->px - b->s * p->py, y = b->s * p->px + b->c * p->py;
    p->rx = ((1 + c) * x - s * y) / 2, p->ry = (s * x + (1 + c) * y) / 2;
    p->x = b->x + p->rx + h * b->w * p->ry / 2, p->y = b->y + p->ry - h * b->w * p->rx / 2;
    p->vx = b->vx - b->w * p->ry, p->vy = b->vy + b->w * p->rx;
}

// Bodies and what they hold, as a substep of h begins, `since` [s] after the step did.
static void see_bodies(const plumb_world *world, double since, double h)
{
    const pl_soft_step *s = world->softbodies.step;
    for (uint32_t i = 0; i < s->body_count; ++i) {
        pl_soft_body *b = &pl_soft_bodies(s)[i];
        if (b->slot == PL_NONE) {
            b->x = b->x0 + since * b->vx, b->y = b->y0 + since * b->vy;
            turn(b, since * b->w);
            continue;
        }
        const pl_solver_body *now = &pl_solver_bodies(&world->solver)[b->slot];
        const pl_solver_motion *motion = &pl_solver_motions(&world->solver)[b->slot];
        b->x = b->x0 + (double)now->dx, b->y = b->y0 + (double)now->dy;
        b->vx = (double)now->vx, b->vy = (double)now->vy, b->w = (double)now->w;
        b->ax = (double)motion->ax, b->ay = (double)motion->ay, b->aw = (double)motion->aw;
        turn(b, (double)now->da);
    }
    for (uint32_t i = 0; i < s->point_count; ++i) {
        pl_soft_point *p = &pl_soft_points(s)[i];
        if (p->body == PL_NONE) {
            continue;
        }
        hold(&pl_soft_bodies(s)[p->body], h, p);
    }
}

static pl_soft_body *body_of(const pl_soft_step *s, uint32_t grouped)
{
    return &pl_soft_bodies(s)[((const uint32_t *)s->grouped.data)[grouped]];
}

// What velocities gain if nothing pulls.
static void guess(const plumb_world *world, const pl_soft_group *g, double h)
{
    const pl_soft_step *s = world->softbodies.step;
    double *u = s->matrix.u;
    for (uint32_t k = g->first_block; k < g->end_block; ++k) {
        u[3 * (size_t)k] = u[3 * (size_t)k + 1] = u[3 * (size_t)k + 2] = 0;
    }
    for (uint32_t k = g->first_member; k < g->end_member; ++k) {
        const pl_soft_member *m = &pl_soft_members(s)[k];
        for (uint32_t i = m->at.point; i < m->at.point + m->nodes; ++i) {
            const pl_soft_point *p = &pl_soft_points(s)[i];
            if (p->block != PL_NONE && p->body == PL_NONE) {
                u[3 * (size_t)p->block] = h * (double)world->gravity.x;
                u[3 * (size_t)p->block + 1] = h * (double)world->gravity.y;
            }
        }
    }
    for (uint32_t k = g->first_body; k < g->end_body; ++k) {
        const pl_soft_body *b = body_of(s, k);
        double *to = u + 3 * (size_t)b->block;
        to[0] = h * b->ax, to[1] = h * b->ay, to[2] = h * b->aw;
    }
}

// What u adds to the velocities of all points of a group.
static void change(const plumb_world *world, const pl_soft_group *g)
{
    const pl_soft_step *s = world->softbodies.step;
    for (uint32_t k = g->first_member; k < g->end_member; ++k) {
        const pl_soft_member *m = &pl_soft_members(s)[k];
        pl_soft_change(s, m->at.point, m->nodes);
    }
}

// Of a mass that would gain u0 and gains u, in a unit of u.
typedef struct inertia {
    double mass, free, damping, velocity;
} inertia;

static double add_inertia(const inertia *i, double u, double *diagonal, double *right,
                          pl_soft_fill fill)
{
    const double c = i->damping, share = 0.5 + 0.5 * c / (c + 4);
    const double rate = i->velocity + share * u, off = u - i->free;
    if (fill == PL_SOFT_ALL) {
        *diagonal += i->mass * (1 + share * c);
    }
    if (fill != PL_SOFT_VALUE) {
        *right -= i->mass * (off + c * rate);
    }
    return i->mass * (off * off + c * rate * rate / share) / 2;
}

static double add_nodes(const plumb_world *world, const pl_soft_member *m, double h,
                        pl_soft_fill fill)
{
    const pl_soft_step *s = world->softbodies.step;
    const pl_soft_matrix *mx = &s->matrix;
    const double gx = h * (double)world->gravity.x, gy = h * (double)world->gravity.y;
    double energy = 0;
    for (uint32_t i = m->at.point; i < m->at.point + m->nodes; ++i) {
        const pl_soft_point *p = &pl_soft_points(s)[i];
        if (p->block == PL_NONE || p->body != PL_NONE) {
            continue;
        }
        double *at = mx->diagonal + 9 * (size_t)p->block, *to = mx->right + 3 * (size_t)p->block;
        const inertia x = { p->mass, gx, h * p->damping, p->vx - p->wind_x };
        const inertia y = { p->mass, gy, h * p->damping, p->vy - p->wind_y };
        energy += add_inertia(&x, p->cx, at, to, fill);
        energy += add_inertia(&y, p->cy, at + 4, to + 1, fill);
    }
    return energy;
}

static double add_body(const pl_soft_matrix *m, const pl_soft_body *b, double h, pl_soft_fill fill)
{
    double *at = m->diagonal + 9 * (size_t)b->block, *to = m->right + 3 * (size_t)b->block;
    const double *u = m->u + 3 * (size_t)b->block;
    const inertia own[3] = { { b->mass, h * b->ax, 0, 0 },
                             { b->mass, h * b->ay, 0, 0 },
                             { b->inertia, h * b->aw, 0, 0 } };
    double energy = 0;
    for (int k = 0; k < 3; ++k) {
        energy += add_inertia(&own[k], u[k], at + 4 * (size_t)k, to + k, fill);
    }
    return energy;
}

static double add_masses(const plumb_world *world, const pl_soft_group *g, double h,
                         pl_soft_fill fill)
{
    const pl_soft_step *s = world->softbodies.step;
    double energy = 0;
    for (uint32_t k = g->first_member; k < g->end_member; ++k) {
        energy += add_nodes(world, &pl_soft_members(s)[k], h, fill);
    }
    for (uint32_t k = g->first_body; k < g->end_body; ++k) {
        energy += add_body(&s->matrix, body_of(s, k), h, fill);
    }
    return energy;
}

// Numbers of a group in a vector of the matrix.
static double *of_group(const pl_soft_group *g, double *vector)
{
    return vector + 3 * (size_t)g->first_block;
}

static size_t size_of(const pl_soft_group *g)
{
    return 3 * (size_t)(g->end_block - g->first_block);
}

// The function of a group that is to be least, where u is, but for its triangles.
static double evaluate_rest(plumb_world *world, const pl_soft_group *g, double h, pl_soft_fill fill)
{
    const double pushes = pl_soft_add_pushes(world->softbodies.step, g, h, fill);
    const double masses = add_masses(world, g, h, fill) + pushes;
    return masses + pl_soft_elements(world, g, h, fill) +
           pl_soft_press(world->softbodies.step, g, h, fill);
}

// With its triangles: where slopes are asked for, `sheets` becomes what these add to them.
static double evaluate(plumb_world *world, const pl_soft_group *g, double h, pl_soft_fill fill)
{
    pl_soft_matrix *m = &world->softbodies.step->matrix;
    change(world, g);
    if (fill == PL_SOFT_ALL) {
        pl_soft_clear(m, g->first_block, g->end_block);
    } else if (fill == PL_SOFT_SLOPES) {
        pl_soft_clear_right(m, g->first_block, g->end_block);
    }
    double energy = 0;
    if (g->triangles) {
        energy = pl_soft_triangles(world, g, h, fill);
        memcpy(of_group(g, m->sheets), of_group(g, m->right), size_of(g) * sizeof(double));
    }
    return energy + evaluate_rest(world, g, h, fill);
}

// u = tried + part way.
static void try_part(const pl_soft_matrix *m, const pl_soft_group *g, double part)
{
    double *u = of_group(g, m->u);
    const double *tried = of_group(g, m->tried), *way = of_group(g, m->way);
    for (size_t i = 0; i < size_of(g); ++i) {
        u[i] = tried[i] + part * way[i];
    }
}

static double product(const double *a, const double *b, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; ++i) {
        sum += a[i] * b[i];
    }
    return sum;
}

// How a part of the function grows along the way: `right` is what that part adds to the right side.
static double slope_of(const pl_soft_matrix *m, const pl_soft_group *g, double *right)
{
    return -product(of_group(g, right), of_group(g, m->way), size_of(g));
}

static double slope_of_triangles(const pl_soft_matrix *m, const pl_soft_group *g)
{
    return g->triangles ? slope_of(m, g, m->sheets) : 0;
}

// How the function grows at a part of the way, but for its triangles.
static double rest_at(plumb_world *world, const pl_soft_group *g, double h, double part)
{
    pl_soft_matrix *m = &world->softbodies.step->matrix;
    try_part(m, g, part);
    change(world, g);
    pl_soft_clear_right(m, g->first_block, g->end_block);
    evaluate_rest(world, g, h, PL_SOFT_SLOPES);
    return slope_of(m, g, m->right);
}

// The part of a way along which the function falls the most: it is convex but for what folds, and its slope passes 0 there. By chords,
// of which an end that stays counts half (Dowell, Jarratt 1971). Near enough to exact where steps are halved (Armijo 1966), for
// what friction holds lies in a fold of the function: a way to halve ends before or behind it, and the passes go to and fro over it.
// Triangles, which cost the most, have no folds: their slope is taken as even between the ends of the way.
static double best_part(plumb_world *world, pl_soft_group *g, double h, double gain)
{
    const pl_soft_matrix *m = &world->softbodies.step->matrix;
    const double sheets = slope_of_triangles(m, g);
    try_part(m, g, 1);
    const double before = g->value;
    g->value = evaluate(world, g, h, g->touches ? PL_SOFT_SLOPES : PL_SOFT_ALL);
    const double more = slope_of_triangles(m, g) - sheets;
    double high = 1, at_high = slope_of(m, g, m->right), low = 0, at_low = -gain;
    if (g->value <= before - ENOUGH_OF_IT * gain || at_high <= 0) {
        g->known = !g->touches;
        return 1;
    }
    double part = 1;
    for (int i = 0, kept = 0; i < CHORDS && high - low > NARROW; ++i) {
        part = low - at_low * (high - low) / (at_high - at_low);
        const double at = rest_at(world, g, h, part) + sheets + part * more;
        if (fabs(at) < LEVEL * gain) {
            break;
        }
        if (at < 0) {
            low = part, at_low = at;
            at_high *= kept < 0 ? 0.5 : 1;
            kept = -1;
        } else {
            high = part, at_high = at;
            at_low *= kept > 0 ? 0.5 : 1;
            kept = 1;
        }
    }
    return part;
}

// A pass of Newton's iteration. Twice what is to be gained by it: no number where there is none.
static double pass(plumb_world *world, pl_soft_group *g, double h, double enough)
{
    pl_soft_matrix *m = &world->softbodies.step->matrix;
    const size_t count = size_of(g), bytes = count * sizeof(double);
    g->value = g->known ? g->value : evaluate(world, g, h, PL_SOFT_ALL);
    g->known = false;
    double *right = of_group(g, m->right), *way = of_group(g, m->way);
    double *slope = of_group(g, m->slope);
    memcpy(of_group(g, m->tried), of_group(g, m->u), bytes);
    memcpy(slope, right, bytes);
    pl_soft_factor(m, g->first_block, g->end_block);
    pl_soft_solve(m, g->first_block, g->end_block);
    memcpy(way, right, bytes);
    const double gain = product(slope, way, count);
    const bool goes_on = gain > enough && gain < 1e300;
    try_part(m, g, goes_on ? best_part(world, g, h, gain) : 1);
    return gain;
}

static void store_substep(plumb_world *world, double h)
{
    const pl_soft_step *s = world->softbodies.step;
    for (uint32_t i = 0; i < s->point_count; ++i) {
        pl_soft_point *p = &pl_soft_points(s)[i];
        if (p->body == PL_NONE) {
            p->x += h * (p->vx + p->cx / 2), p->y += h * (p->vy + p->cy / 2);
            p->vx += p->cx, p->vy += p->cy;
        }
    }
    for (uint32_t i = 0; i < s->body_count; ++i) {
        const pl_soft_body *b = &pl_soft_bodies(s)[i];
        if (b->block != PL_NONE) {
            pl_solver_motion *motion = &pl_solver_motions(&world->solver)[b->slot];
            const double *u = s->matrix.u + 3 * (size_t)b->block;
            motion->ax = b->locked_x > 0 ? (near_real)(u[0] / h) : motion->ax;
            motion->ay = b->locked_y > 0 ? (near_real)(u[1] / h) : motion->ay;
            motion->aw = b->locked_w > 0 ? (near_real)(u[2] / h) : motion->aw;
        }
    }
    const pl_soft_contact *contacts = s->contacts.data;
    for (uint32_t i = 0; i < s->contact_count; ++i) {
        pl_soft_bodies(s)[contacts[i].body].touched |= contacts[i].force > 0;
    }
}

// [kg] of nodes and of bodies that are unknowns.
static double moved_mass(const pl_soft_step *s, const pl_soft_group *g)
{
    double sum = g->mass;
    for (uint32_t k = g->first_body; k < g->end_body; ++k) {
        sum += body_of(s, k)->mass;
    }
    return sum;
}

static bool has_contacts(const pl_soft_step *s, const pl_soft_group *g)
{
    return pl_soft_members(s)[g->end_member - 1].end_contact >
           pl_soft_members(s)[g->first_member].first_contact;
}

// Rounds of at most so many passes; `fall` [m/s]: what gravity adds. Whether the group has settled.
static bool settle(plumb_world *world, pl_soft_group *g, double h, double fall, int passes)
{
    const pl_soft_step *s = world->softbodies.step;
    const double small = SMALL * fall, told = TOLD * fall;
    const double enough = g->mass * (small * small + 1e-12);
    bool settled = false;
    g->touches = has_contacts(s, g);
    g->known = false;
    g->pass = 0;
    for (int round = 0; round < ROUNDS && (round == 0 || pl_soft_bind(s, g)); ++round) {
        const int until = g->pass + passes;
        double gain = INFINITY;
        while (g->pass < until && (gain > enough || (g->pass < 3 && g->touches))) {
            gain = pass(world, g, h, enough);
            if (!(gain < 1e300)) { // no number: as if nothing pulled
                guess(world, g, h);
                break;
            }
            ++g->pass;
        }
        settled = gain <= moved_mass(s, g) * (told * told + 1e-12);
        evaluate(world, g, h, PL_SOFT_VALUE);
        if (!settled) {
            break;
        }
    }
    return settled;
}

void pl_soft_newton(plumb_world *world, double h, int passes)
{
    pl_soft_step *s = world->softbodies.step;
    pl_soft_group *groups = pl_soft_groups(s);
    see_bodies(world, h * s->done, h);
    pl_soft_feel_winds(world, h * (s->done + 0.5));
    pl_soft_turn_pushes(world, h);
    pl_soft_see_edges(world, h);
    for (uint32_t k = 0; k < s->group_count; ++k) {
        guess(world, &groups[k], h);
        change(world, &groups[k]); // where they are on their way to
    }
    pl_soft_find_contacts(world, h);
    const double fall = h * (fabs((double)world->gravity.x) + fabs((double)world->gravity.y));
    s->creep = CREEP * fall > CREEP_LEAST ? CREEP * fall : CREEP_LEAST;
    bool settled = true;
    for (uint32_t k = 0; k < s->group_count; ++k) {
        settled = settle(world, &groups[k], h, fall, passes) && settled;
    }
    s->missed += settled ? 0 : 1;
    store_substep(world, h);
    ++s->done;
}
