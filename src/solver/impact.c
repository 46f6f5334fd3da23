// impact.c - restitution by events: an impact is put at its moment inside the substep.
//
// Seen along the normal of a contact point, a substep begins at separation s with speed u
// (negative: approaching) under constant acceleration a. The surfaces meet at speed
//     c = sqrt(u^2 - 2 a s)            after the time          t = 2 s / (c - u),
// and part at e c. The impulse m (1 + e) c that does this acts from t to the end of the substep, so
// it moves the bodies by (h - t) times the change of velocity; the sweep that integrates positions
// will count h times, hence t times is taken off here. Speed, height and time of the bounce are
// those of the parabola: no threshold, and no energy lost or won. An overlap at the start of the
// substep (s < 0) is an impact that lies in the past (t < 0): the same formulas set it right.
//
// A bounce whose own parabola would end within the substep is not resolved: such a contact rests,
// and the soft constraint holds it. Contacts that carry load rest too, unless struck at more than
// what gravity makes of the substep. Impacts are resolved one after the other until none is left,
// so that a row of touching balls passes momentum on (Newton's cradle); the two points of one
// manifold are resolved together, so that a flat landing does not turn.
//
// Reads, writes: solver bodies. Order: after velocities are integrated, before contacts are solved.
// Cost: O(elastic contacts) a substep, times the length of chains of impacts.
#include "world/state.h"

#include <math.h>

// Longest chain of impacts followed within one substep; what is left then is solved without bounce.
#define SWEEPS 64

#if defined(PLUMB_DOUBLE) && PLUMB_DOUBLE
#define ROOT sqrt
#else
#define ROOT sqrtf
#endif

typedef struct approach {
    bool due;   // an impact falls into this substep and bounces
    bool clear; // the point stays apart in this substep
    real speed; // [m/s] at which the surfaces meet, > 0
    real time;  // [s] since the start of the substep
} approach;

static real *lane_value(pl_solver *s, const pl_contact_kernels *kernels, size_t lane, size_t offset)
{
    size_t width = (size_t)kernels->width;
    char *bundle = (char *)s->bundles.data + lane / width * kernels->bundle_size;
    return (real *)(void *)(bundle + offset) + lane % width;
}

void pl_impacts_prepare(plumb_world *world)
{
    pl_solver *s = &world->solver;
    const pl_contact_kernels *kernels = pl_solver_kernels(world);
    const uint32_t *lanes = s->lanes.data;
    pl_impact *impacts = s->impacts.data;
    uint32_t count = 0;
    uint32_t movable = world->dynamic_count + world->kinematic_count;
    for (size_t lane = 0; lane < (size_t)s->bundle_count * (size_t)kernels->width; ++lane) {
        if (lanes[lane] == PL_NONE) {
            continue;
        }
        const pl_manifold *m = &pl_manifolds(&world->narrow)[lanes[lane]];
        if (!(m->restitution > 0)) {
            continue;
        }
        pl_impact *impact = &impacts[count++];
        *impact = (pl_impact){ .a = pl_solver_slot(s, m->body_a, movable),
                               .b = pl_solver_slot(s, m->body_b, movable),
                               .pair = m->pair,
                               .count = m->count,
                               .nx = m->nx,
                               .ny = m->ny,
                               .friction = m->friction,
                               .restitution = m->restitution };
        for (uint32_t j = 0; j < m->count; ++j) {
            const pl_manifold_point *p = &m->point[j];
            impact->point[j] = (pl_impact_point){
                .ran = p->ax * m->ny - p->ay * m->nx,
                .rbn = p->bx * m->ny - p->by * m->nx,
                .rat = p->ax * m->nx + p->ay * m->ny,
                .rbt = p->bx * m->nx + p->by * m->ny,
                .separation = p->separation,
                .lane_separation = lane_value(s, kernels, lane, kernels->separation_offset[j]),
                .lane_impulse = lane_value(s, kernels, lane, kernels->impulse_offset[j])
            };
        }
    }
    s->impact_count = count;
    s->bounce_count = 0;
}

// What happens to point j in the substep if nothing else does.
static approach foresee(const plumb_world *world, const pl_impact *m, uint32_t j, real h)
{
    const pl_solver *s = &world->solver;
    const pl_solver_body *a = &pl_solver_bodies(s)[m->a], *b = &pl_solver_bodies(s)[m->b];
    const pl_solver_motion *ma = &pl_solver_motions(s)[m->a], *mb = &pl_solver_motions(s)[m->b];
    const pl_impact_point *p = &m->point[j];
    real sep = p->separation + m->nx * (b->dx - a->dx) + m->ny * (b->dy - a->dy) + p->rbn * b->da -
               p->ran * a->da;
    real v = m->nx * (b->vx - a->vx) + m->ny * (b->vy - a->vy) + p->rbn * b->w - p->ran * a->w;
    // What the substep's forces and resting contacts added: h a, and v - u from the contacts.
    real kick_x = (h * mb->ax + (b->vx - mb->ux)) - (h * ma->ax + (a->vx - ma->ux));
    real kick_y = (h * mb->ay + (b->vy - mb->uy)) - (h * ma->ay + (a->vy - ma->uy));
    real kick = m->nx * kick_x + m->ny * kick_y + p->rbn * (h * mb->aw + (b->w - mb->uw)) -
                p->ran * (h * ma->aw + (a->w - ma->uw));
    real u = v - kick;
    real acceleration = kick / h;
    approach out = { 0 };
    if (sep + h * (u + v) / 2 >= 0) {
        out.clear = true;
        return out;
    }
    real square = u * u - 2 * acceleration * sep;
    if (!(u < 0) || !(square > 0)) {
        return out;
    }
    out.speed = ROOT(square);
    out.time = 2 * sep / (out.speed - u);
    real loaded = *p->lane_impulse;
    real weight = acceleration < 0 ? -acceleration : acceleration;
    if (out.speed <= world->desc.restitution_speed || (loaded > 0 && out.speed <= 4 * weight * h)) {
        return out;
    }
    real rest = h - out.time;
    out.due = m->restitution * out.speed + acceleration * rest / 2 > 0;
    return out;
}

// Applies impulse (along n, along t) at a point, as of `time` into the substep.
static void strike(const plumb_world *world, const pl_impact *m, uint32_t j, real along_n,
                   real along_t, real time)
{
    const pl_solver *s = &world->solver;
    const pl_impact_point *p = &m->point[j];
    real px = m->nx * along_n - m->ny * along_t;
    real py = m->ny * along_n + m->nx * along_t;
    for (int side = 0; side < 2; ++side) {
        uint32_t slot = side == 0 ? m->a : m->b;
        if (slot >= s->dynamic_slots) {
            continue;
        }
        pl_solver_body *body = &pl_solver_bodies(s)[slot];
        pl_solver_motion *motion = &pl_solver_motions(s)[slot];
        real sign = side == 0 ? -1 : 1;
        real turn =
            side == 0 ? p->ran * along_n + p->rat * along_t : p->rbn * along_n + p->rbt * along_t;
        real dvx = sign * body->inv_mass * px;
        real dvy = sign * body->inv_mass * py;
        real dw = sign * body->inv_inertia * turn;
        body->vx += dvx, motion->ux += dvx, body->dx -= time * dvx;
        body->vy += dvy, motion->uy += dvy, body->dy -= time * dvy;
        body->w += dw, motion->uw += dw, body->da -= time * dw;
    }
}

// Entry (i, j) of the inverse effective mass of a manifold's normal rows.
static real coupling(const plumb_world *world, const pl_impact *m, uint32_t i, uint32_t j)
{
    const pl_solver_body *a = &pl_solver_bodies(&world->solver)[m->a];
    const pl_solver_body *b = &pl_solver_bodies(&world->solver)[m->b];
    return a->inv_mass + b->inv_mass + a->inv_inertia * m->point[i].ran * m->point[j].ran +
           b->inv_inertia * m->point[i].rbn * m->point[j].rbn;
}

// Friction of an impact: what stops the slip, at most mu times the normal impulse.
static void strike_tangent(const plumb_world *world, const pl_impact *m, uint32_t j, real normal,
                           real time)
{
    const pl_solver_body *a = &pl_solver_bodies(&world->solver)[m->a];
    const pl_solver_body *b = &pl_solver_bodies(&world->solver)[m->b];
    const pl_impact_point *p = &m->point[j];
    real slip = m->nx * (b->vy - a->vy) - m->ny * (b->vx - a->vx) + p->rbt * b->w - p->rat * a->w;
    real k = a->inv_mass + b->inv_mass + a->inv_inertia * p->rat * p->rat +
             b->inv_inertia * p->rbt * p->rbt;
    real bound = m->friction * normal;
    real impulse = -slip / k;
    impulse = impulse > bound ? bound : impulse < -bound ? -bound : impulse;
    strike(world, m, j, 0, impulse, time);
}

// Resolves a manifold's impacts; true when there was one.
static bool resolve(plumb_world *world, const pl_impact *m, const approach at[2])
{
    const real gain = 1 + m->restitution;
    real impulse[2] = { 0, 0 };
    if (at[0].due && at[1].due) {
        real k00 = coupling(world, m, 0, 0), k11 = coupling(world, m, 1, 1),
             k01 = coupling(world, m, 0, 1);
        real det = k00 * k11 - k01 * k01;
        real r0 = gain * at[0].speed, r1 = gain * at[1].speed;
        // Nearly dependent rows (points close together) are resolved one at a time.
        if (det > (real)1e-4 * k00 * k11) {
            impulse[0] = (k11 * r0 - k01 * r1) / det;
            impulse[1] = (k00 * r1 - k01 * r0) / det;
        }
        if (!(impulse[0] > 0 && impulse[1] > 0)) {
            int first = at[0].speed >= at[1].speed ? 0 : 1;
            impulse[first] = first == 0 ? r0 / k00 : r1 / k11;
            impulse[1 - first] = 0;
        }
    } else if (at[0].due || at[1].due) {
        uint32_t j = at[0].due ? 0 : 1;
        real k = coupling(world, m, j, j);
        impulse[j] = k > 0 ? gain * at[j].speed / k : 0;
    }
    bool struck = false;
    for (uint32_t j = 0; j < m->count; ++j) {
        if (impulse[j] > 0) {
            strike(world, m, j, impulse[j], 0, at[j].time);
            struck = true;
        }
    }
    for (uint32_t j = 0; j < m->count && m->friction > 0; ++j) {
        if (impulse[j] > 0) {
            strike_tangent(world, m, j, impulse[j], at[j].time);
        }
    }
    return struck;
}

void pl_impacts_run(plumb_world *world, real h)
{
    pl_solver *s = &world->solver;
    pl_impact *impacts = s->impacts.data;
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    bool again = true;
    for (int k = 0; k < SWEEPS && again; ++k) {
        again = false;
        for (uint32_t i = 0; i < s->impact_count; ++i) {
            pl_impact *m = &impacts[i];
            approach at[2] = { { 0 }, { 0 } };
            for (uint32_t j = 0; j < m->count; ++j) {
                at[j] = foresee(world, m, j, h);
            }
            if ((at[0].due || at[1].due) && resolve(world, m, at)) {
                pairs[m->pair].flags |= PL_PAIR_HIT;
                ++s->bounce_count;
                again = true;
            }
        }
    }
    // Points that stay clear of their own accord are none of the contact kernel's business.
    for (uint32_t i = 0; i < s->impact_count; ++i) {
        pl_impact *m = &impacts[i];
        for (uint32_t j = 0; j < m->count; ++j) {
            pl_impact_point *p = &m->point[j];
            bool off = *p->lane_impulse <= 0 && foresee(world, m, j, h).clear;
            *p->lane_separation = p->separation + (off ? PL_APART : 0);
        }
    }
}
