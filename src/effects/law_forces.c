// law_forces.c - what laws give bodies: accelerations at places, the row of the substeps, potentials.
//
// A pull at an offset d, q = d^2 + softening^2:  a = -k d f(q),  f = q^(-3/2), q^-1, q^-2, q^(-1/2), 1 for 1/r^2, 1/r, 1/r^3,
// constant, r. Only square roots and divisions: the same bits everywhere. (Softened as Plummer 1911, Mon. Not. R. Astron.
// Soc. 71.) Of a pair one force is worked out and given to both, so momentum is kept to rounding.
//
// In a substep, places are those of its middle without what the laws do, x + v h / 2: with the solver's kick and parabola
// that is the leapfrog (drift, kick, drift). A magnetic law turns velocities as Boris does (1970, Proc. 4th Conf.
// Numerical Simulation of Plasmas): half of the other acceleration, a turn by 2 atan(w h / 2), the other half: no energy
// is gained, and circles have the radius m v / (q B).
//
// Reads: laws and bodies of the step, solver bodies. Writes: accelerations. Cost: O(bodies laws) a substep, coupled bodies
// O(those that attract x all).
#include "effects/laws.h"

#include "core/sort.h"
#include "schema/passes.h"

#include <math.h>

// [-] the determinant of what a velocity in the middle is solved for.
#define SLOWEST 0.25

bool pl_law_reaches(const pl_law_now *law, double dx, double dy)
{
    const double hx = (double)law->desc->half.x, hy = (double)law->desc->half.y;
    if (hx > 0) {
        const double x = law->c * dx + law->s * dy, y = law->c * dy - law->s * dx;
        return fabs(x) <= hx && fabs(y) <= hy;
    }
    return dx * dx + dy * dy <= law->reach * law->reach;
}

double pl_law_falloff(const pl_law_now *law, double square)
{
    const plumb_falloff kind = law->desc->falloff;
    const double q = square + law->square;
    if (!(q > 0) || square > law->reach * law->reach) {
        return 0;
    }
    switch (kind) {
    case PLUMB_FALLOFF_INVERSE:
        return 1 / q;
    case PLUMB_FALLOFF_CUBE:
        return 1 / (q * q);
    case PLUMB_FALLOFF_NONE:
        return 1 / sqrt(q);
    case PLUMB_FALLOFF_SPRING:
        return 1;
    default:
        return 1 / (q * sqrt(q));
    }
}

//---- laws with a place ---------------------------------------------------------------------------

static void offset(const pl_law_now *law, const pl_law_state *states, const pl_law_state *at,
                   double time, double d[2])
{
    const bool follows = law->member != PL_NONE;
    d[0] = at->x - (follows ? states[law->member].x : law->x + law->vx * time);
    d[1] = at->y - (follows ? states[law->member].y : law->y + law->vy * time);
}

bool pl_law_acts(const pl_law_system *system, const pl_law_now *law, const pl_law_state *states,
                 uint32_t i, double time)
{
    double way[2];
    const bool is_elsewhere = system->alone && law->member != PL_NONE;
    if (pl_law_hold_of(law->desc, &system->bodies[i]) == 0 || is_elsewhere || law->member == i) {
        return false;
    }
    if (pl_law_is_endless(law->desc)) {
        return true;
    }
    offset(law, states, &states[i], time, way);
    return pl_law_reaches(law, way[0], way[1]);
}

// It gives no force here, and replaces none.
static inline bool is_other(const pl_law_data *d)
{
    return d->kind > PLUMB_LAW_ATTRACTOR &&
           (d->kind != PLUMB_LAW_FORMULA || d->combine != PLUMB_LAW_REPLACE);
}

// The body of index i, from uniform laws and attractors; formulas may replace them.
static void pull_one(const pl_law_system *system, const pl_law_state *states, uint32_t i,
                     double time, double *out)
{
    const pl_law_body *body = &system->bodies[i];
    int floor[] = { INT32_MIN, INT32_MIN };
    for (uint32_t k = 0; k < system->law_count; ++k) {
        const pl_law_now *law = &system->laws[k];
        const pl_law_data *d = law->desc;
        const double hold = pl_law_hold_of(d, body);
        const bool is_elsewhere = system->alone && law->member != PL_NONE;
        if (hold == 0 || is_elsewhere || law->member == i || is_other(d) ||
            d->priority < floor[d->hold] || (!system->replaces && pl_law_is_endless(d))) {
            continue;
        }
        double way[2] = { 0, 0 };
        if (!pl_law_is_endless(d)) {
            offset(law, states, &states[i], time, way);
            if (!pl_law_reaches(law, way[0], way[1])) {
                continue;
            }
        }
        if (d->combine == PLUMB_LAW_REPLACE) {
            floor[d->hold] = d->priority;
            if (d->kind == PLUMB_LAW_FORMULA) {
                continue; // law_formula.c
            }
        }
        const bool pulls = d->kind == PLUMB_LAW_ATTRACTOR;
        const double r = way[0] * way[0] + way[1] * way[1];
        const double k_f = pulls ? -(double)d->strength * pl_law_falloff(law, r) * hold : hold;
        const double fx = k_f * (pulls ? way[0] : (double)d->vector.x);
        const double fy = k_f * (pulls ? way[1] : (double)d->vector.y);
        if (body->mass > 0) {
            out[2 * i] += fx / body->mass, out[2 * i + 1] += fy / body->mass;
        }
        if (law->member != PL_NONE) {
            const double m = system->bodies[law->member].mass;
            out[2 * law->member] -= fx / m, out[2 * law->member + 1] -= fy / m;
        }
    }
    if (floor[PLUMB_LAW_ON_MASS] != INT32_MIN && body->mass > 0) {
        const plumb_vec2 g = system->gravity;
        out[2 * i] -= body->weight / body->mass * (double)g.x;
        out[2 * i + 1] -= body->weight / body->mass * (double)g.y;
    }
}

//---- laws between bodies -------------------------------------------------------------------------

double pl_law_pair(const pl_law_now *law, const pl_law_body *a, const pl_law_body *b)
{
    const pl_law_data *d = law->desc;
    const double factor = d->hold == PLUMB_LAW_ON_CHARGE  ? -1
                          : a->attraction > b->attraction ? a->attraction
                                                          : b->attraction;
    return (double)d->strength * factor * pl_law_hold_of(d, a) * pl_law_hold_of(d, b);
}

static void pull_pairs(const pl_law_system *system, const pl_law_now *law,
                       const pl_law_state *states, double *out)
{
    const pl_law_body *bodies = system->bodies;
    for (uint32_t i = 0; i < system->sources; ++i) {
        double ax = 0, ay = 0;
        const double ease = bodies[i].mass > 0 ? 1 / bodies[i].mass : 0;
        for (uint32_t k = i + 1; k < system->count; ++k) {
            const double dx = states[k].x - states[i].x, dy = states[k].y - states[i].y;
            const double f =
                pl_law_pair(law, &bodies[i], &bodies[k]) * pl_law_falloff(law, dx * dx + dy * dy);
            const double other = bodies[k].mass > 0 ? f / bodies[k].mass : 0;
            ax += f * ease * dx, ay += f * ease * dy;
            out[2 * k] -= other * dx, out[2 * k + 1] -= other * dy;
        }
        out[2 * i] += ax, out[2 * i + 1] += ay;
    }
}

void pl_laws_pull_plain(const pl_law_system *system, const pl_law_state *states, double time,
                        double *out)
{
    for (uint32_t i = 0; i < 2 * system->count; ++i) {
        out[i] = 0;
    }
    for (uint32_t k = 0; k < system->law_count && system->sources > 0; ++k) {
        if (system->laws[k].desc->kind == PLUMB_LAW_MUTUAL) {
            pull_pairs(system, &system->laws[k], states, out);
        }
    }
    for (uint32_t i = 0; i < system->count; ++i) {
        pull_one(system, states, i, time, out);
    }
}

// The velocity on the way, v + s h k, has the acceleration a + s h J k = k. In the middle, s = 1/2, what turns keeps its speed; drag
// of a mean rate z / h needs the end the more, the stronger it is, or it would overshoot: with s = 1/2 + z^2 / (8 + 2 z^2) it never
// does, and the order stays.
void pl_law_kick(const double a[2], const double slopes[4], double h, double out[2])
{
    const double z = -h / 2 * (slopes[0] + slopes[3]), square = z > 0 ? z * z : 0;
    const double part = h * (0.5 + 0.5 * square / (4 + square));
    const double xx = 1 - part * slopes[0], xy = -part * slopes[1];
    const double yx = -part * slopes[2], yy = 1 - part * slopes[3];
    const double det = xx * yy - xy * yx;
    const bool turns_over = !(det > SLOWEST); // what drives so hard is not solved for
    const double ax = turns_over ? a[0] : (yy * a[0] - xy * a[1]) / det;
    const double ay = turns_over ? a[1] : (xx * a[1] - yx * a[0]) / det;
    out[0] = ax, out[1] = ay;
}

double pl_laws_spin(const pl_law_system *system, const pl_law_body *body, const pl_law_state *state,
                    double time)
{
    double spin = 0;
    for (uint32_t k = 0; k < system->law_count && body->charge != 0 && body->mass > 0; ++k) {
        const pl_law_now *law = &system->laws[k];
        const double dx = state->x - law->x - law->vx * time;
        const double dy = state->y - law->y - law->vy * time;
        if (law->desc->kind == PLUMB_LAW_MAGNETIC && pl_law_hold_of(law->desc, body) != 0 &&
            pl_law_reaches(law, dx, dy)) {
            spin += body->charge / body->mass * (double)law->desc->strength;
        }
    }
    return spin;
}

//---- the row -------------------------------------------------------------------------------------

typedef struct passage {
    plumb_world *world;
    const pl_keyed *pushed;
    double h, time; // [s] the substep; since the step began, in its middle
} passage;

static pl_law_system system_of(const plumb_world *world, pl_law_body *bodies, uint32_t count,
                               uint32_t sources)
{
    const pl_law_step *s = &world->laws.step;
    return (pl_law_system){ .world = world,
                            .laws = pl_laws_now(world),
                            .law_count = s->law_count,
                            .bodies = bodies,
                            .count = count,
                            .sources = sources,
                            .gravity = world->effects.gravity,
                            .replaces = s->replaces,
                            .formulas = s->formulas,
                            .others = s->others };
}

pl_law_state pl_law_middle(const plumb_world *world, const pl_law_body *body, double h)
{
    const pl_bodies *b = &world->bodies;
    const uint32_t row = body->row;
    pl_law_state s = { (double)b->center_x[row] + (double)b->residual_x[row],
                       (double)b->center_y[row] + (double)b->residual_y[row], 0, 0 };
    if (body->slot != PL_NONE) {
        const pl_solver_body *now = &pl_solver_bodies(&world->solver)[body->slot];
        s.vx = (double)now->vx, s.vy = (double)now->vy;
        s.x += (double)now->dx + h / 2 * s.vx;
        s.y += (double)now->dy + h / 2 * s.vy;
    }
    return s;
}

static void set_motion(const passage *p, const pl_law_body *body, double ax, double ay)
{
    const uint32_t flags = p->world->bodies.flags[body->row];
    pl_solver_motion *motion = &pl_solver_motions(&p->world->solver)[body->slot];
    motion->ax = (flags & PL_BODY_LOCK_X) != 0 ? 0 : (near_real)ax;
    motion->ay = (flags & PL_BODY_LOCK_Y) != 0 ? 0 : (near_real)ay;
}

// a, and the turn, become what the solver is to add to the velocity in a second.
static void give(const passage *p, const pl_law_system *system, const pl_law_body *body,
                 const pl_law_state *state, const double a[2])
{
    const pl_solver_motion *motion = &pl_solver_motions(&p->world->solver)[body->slot];
    const double own = body->time * body->time;
    double ax = (double)motion->ax + own * (a[0] + body->ax);
    double ay = (double)motion->ay + own * (a[1] + body->ay);
    const double t = pl_laws_spin(system, body, state, p->time) * body->time * p->h / 2;
    if (t != 0) {
        const double vx = state->vx + p->h / 2 * ax, vy = state->vy + p->h / 2 * ay;
        const double s = 2 * t / (1 + t * t);
        ax += s * (vy - t * vx) / p->h;
        ay -= s * (vx + t * vy) / p->h;
    }
    set_motion(p, body, ax, ay);
}

// The same where a formula asks for velocities. The turn is one more slope: where there is no other, that is Boris again.
static void give_solved(const passage *p, const pl_law_system *system, const pl_law_body *body,
                        const pl_law_state *state, const double a[2], const double slopes[4])
{
    const pl_solver_motion *motion = &pl_solver_motions(&p->world->solver)[body->slot];
    const double own = body->time * body->time;
    const double w = pl_laws_spin(system, body, state, p->time) * body->time;
    const double all[] = { own * slopes[0], own * slopes[1] + w, own * slopes[2] - w,
                           own * slopes[3] };
    const double from[] = { (double)motion->ax + own * (a[0] + body->ax) + w * state->vy,
                            (double)motion->ay + own * (a[1] + body->ay) - w * state->vx };
    double kick[2];
    pl_law_kick(from, all, p->h, kick);
    set_motion(p, body, kick[0], kick[1]);
}

static void give_either(const passage *p, const pl_law_system *system, uint32_t i,
                        const pl_law_state *states, const double *a, const double *slopes)
{
    const pl_law_body *body = &system->bodies[i];
    if (body->dragged) {
        give_solved(p, system, body, &states[i], &a[2 * i], &slopes[4 * i]);
    } else {
        give(p, system, body, &states[i], &a[2 * i]);
    }
}

static void push_single(void *context, uint32_t first, uint32_t count)
{
    const passage *p = context;
    for (uint32_t i = first; i < first + count; ++i) {
        pl_law_body *body = &pl_law_bodies(p->world)[p->pushed[i].value];
        pl_law_system system = system_of(p->world, body, 1, 0);
        system.alone = true;
        const pl_law_state state = pl_law_middle(p->world, body, p->h);
        double a[2];
        pl_laws_pull(&system, &state, p->time, a, NULL);
        give(p, &system, body, &state, a);
    }
}

// The same in blocks, for formulas. A body has the same bits whoever else is in its block.
static void push_block(const passage *p, const pl_keyed *pushed, uint32_t count)
{
    pl_law_body bodies[PL_LAW_BLOCK];
    pl_law_state states[PL_LAW_BLOCK];
    double a[2 * PL_LAW_BLOCK], slopes[4 * PL_LAW_BLOCK];
    pl_law_system system = system_of(p->world, bodies, count, 0);
    system.alone = true;
    for (uint32_t i = 0; i < count; ++i) {
        bodies[i] = pl_law_bodies(p->world)[pushed[i].value];
        states[i] = pl_law_middle(p->world, &bodies[i], p->h);
    }
    pl_laws_pull(&system, states, p->time, a, slopes);
    for (uint32_t i = 0; i < count; ++i) {
        give_either(p, &system, i, states, a, slopes);
    }
}

static void push_blocks(void *context, uint32_t first, uint32_t count)
{
    const passage *p = context;
    for (uint32_t i = 0; i < count; i += PL_LAW_BLOCK) {
        const uint32_t left = count - i;
        push_block(p, p->pushed + first + i, left < PL_LAW_BLOCK ? left : PL_LAW_BLOCK);
    }
}

static void push_coupled(const passage *p)
{
    const pl_law_step *s = &p->world->laws.step;
    const pl_law_system system =
        system_of(p->world, pl_law_bodies(p->world), s->coupled_count, s->source_count);
    pl_law_state *states = s->states.data;
    double *a = s->forces.data, *slopes = a + 2 * (size_t)s->coupled_count;
    for (uint32_t i = 0; i < system.count; ++i) {
        states[i] = pl_law_middle(p->world, &system.bodies[i], p->h);
    }
    pl_laws_pull(&system, states, p->time, a, slopes);
    for (uint32_t i = 0; i < system.count; ++i) {
        if (system.bodies[i].slot != PL_NONE) {
            give_either(p, &system, i, states, a, slopes);
        }
    }
}

// So many bodies are worth a thread: blocks of formulas are not cut.
#define LEAST (2 * PL_LAW_BLOCK)

void pl_law_row(pl_substep *sub)
{
    const pl_law_step *s = &sub->world->laws.step;
    const pl_keyed *all = s->order.data;
    const pl_share mine =
        pl_substep_share(all, sizeof *all, offsetof(pl_keyed, order), s->pushed_count, sub);
    passage p = { .world = sub->world,
                  .pushed = all + mine.first,
                  .h = (double)sub->h,
                  .time = (double)sub->h * (sub->number + 0.5) };
    pl_tasks_ranges(sub->tasks, mine.end - mine.first, LEAST,
                    s->formulas ? push_blocks : push_single, &p);
    if (s->couples && sub->cluster == pl_clusters(&sub->world->solver)) {
        push_coupled(&p);
    }
}
