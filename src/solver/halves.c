// halves.c - the kick of a substep in halves: contacts are solved and bodies move between them, so that what contacts push
// moves to second order in the substep, as what flies does.
//
// integrate (soft.c) makes of v the velocity by all of the substep's kick: h a, and what contacts did in the substep
// before, P. Half of it is taken back before contacts are solved and given behind the drift, before they are relaxed:
//     w = v + (h a + P) / 2,    x' = x + h w,    v' = w + (h a + P) / 2
// as in RATTLE (Andersen 1983); sweeps change w and v'. Kicked whole before the drift, a body that is pushed with the
// acceleration A is ahead by A h T / 2 after a time T (slide_stop: 0.021 m; in halves 1.5e-4 m). What rests is kicked
// by nothing, and what flies moves on its parabola.
//
// A hit is no force: what it did is not to be expected again. Contacts take a push back that is given whole in the
// sweep that solves them and what is left in the one that relaxes; of two halves each sweep would leave some. (A box of
// 100 m/s against a wall of six went back 4 m.) So the kick is whole after a hit, and before the first push; and always for
// bodies with joints, whose rows turn and whose springs are made for it (joints/one.c, spring.c).
//
// Reads: solver bodies, motions. Writes: solver bodies. Order: behind impacts, before the sweeps; the drift. Cost: two passes
// over the bodies of a substep.
#include "core/quad.h"
#include "solver/substep.h"
#include "world/state.h"

#define HALF ((near_real)0.5)

// A push is a hit that has so many times the energy of the forces' kick, and such a share of the body's.
#define HIT_FORCES ((near_real)16)
#define HIT_SPEED  ((near_real)(1.0 / 64))

// Of a push, what is left where contacts took it back, by rounding.
#define LEFT ((near_real)1e-6)

typedef struct passage {
    const pl_solver *solver;
    uint32_t first; // slot
    near_real h;    // [s]
} passage;

void pl_soft_share(const plumb_world *world, uint32_t row, uint32_t slot)
{
    pl_near_quad *kicked = (pl_near_quad *)world->solver.kicked.data + slot;
    const bool tied = row >= world->dynamic_count || world->bodies.first_joint[row] != PL_NONE;
    (*kicked)[3] = tied ? 0 : HALF;
}

// Twice the energy of a velocity, for each kilogram; `arm` [m^2]: inertia for each kilogram.
static inline near_real energy_of(const pl_near_quad *v, near_real arm)
{
    const pl_near_quad square = *v * *v;
    return square[0] + square[1] + arm * square[2];
}

// The share of a slot is negative while its kick is whole.
static void halve(void *context, uint32_t first, uint32_t count)
{
    const passage *p = context;
    const pl_solver *s = p->solver;
    pl_near_quad *body = (pl_near_quad *)(void *)(pl_solver_bodies(s) + p->first);
    const pl_near_quad *motion = (const pl_near_quad *)(void *)(pl_solver_motions(s) + p->first);
    pl_near_quad *kicked = (pl_near_quad *)s->kicked.data + p->first;
    for (uint32_t i = first; i < first + count; ++i) {
        const pl_near_quad v = body[2 * i], force = p->h * motion[2 * i];
        const pl_near_quad pushed = v - motion[2 * i + 1], before = motion[2 * i + 1] - force;
        const near_real ease = body[2 * i + 1][3], arm = ease > 0 ? v[3] / ease : 0;
        const near_real energy = energy_of(&pushed, arm);
        const bool hit = !(energy > 0) || (energy > HIT_FORCES * energy_of(&force, arm) &&
                                           energy > HIT_SPEED * energy_of(&before, arm));
        near_real share = kicked[i][3] < 0 ? -kicked[i][3] : kicked[i][3];
        share = hit ? -share : share;
        kicked[i] = v;
        kicked[i][3] = share;
        body[2 * i] = v - (share > 0 ? share : 0) * (force + pushed);
    }
}

void pl_soft_halve(pl_substep *s)
{
    const pl_slots slots = s->cluster->slots[0];
    pl_tasks_ranges(s->tasks, slots.count, PL_BODIES_SHARED, halve,
                    &(passage){ &s->world->solver, slots.first, s->h });
}

static inline bool is_same(const pl_near_quad *a, const pl_near_quad *b)
{
    return (*a)[0] == (*b)[0] && (*a)[1] == (*b)[1] && (*a)[2] == (*b)[2];
}

// Who was pushed by nothing ends with the very velocity of the whole kick: else rounding would be a push from then on.
static void drift(void *context, uint32_t first, uint32_t count)
{
    const passage *p = context;
    const pl_solver *s = p->solver;
    const near_real h = p->h;
    pl_near_quad *body = (pl_near_quad *)(void *)(pl_solver_bodies(s) + p->first);
    const pl_near_quad *motion = (const pl_near_quad *)(void *)(pl_solver_motions(s) + p->first);
    const pl_near_quad *kicked = (const pl_near_quad *)s->kicked.data + p->first;
    for (uint32_t i = first; i < first + count; ++i) {
        const pl_near_quad v = body[2 * i], whole = kicked[i], force = h * motion[2 * i];
        const pl_near_quad pushed = whole - motion[2 * i + 1];
        const near_real share = whole[3] > 0 ? whole[3] : 0;
        const pl_near_quad behind = share * (force + pushed), half = whole - behind;
        pl_near_quad way = h * v, now = v + behind;
        if (is_same(&v, &half)) {
            now = whole;
        }
        const pl_near_quad u = motion[2 * i + 1], kept = now - u;
        const near_real left = share > 0 ? LEFT * energy_of(&pushed, 1) : 0;
        if (energy_of(&kept, 1) <= left) { // it flies
            way = h * u - HALF * h * force;
        }
        way[3] = 0, now[3] = v[3];
        body[2 * i + 1] += way;
        body[2 * i] = now;
    }
}

void pl_soft_move(pl_substep *s)
{
    const pl_slots slots = s->cluster->slots[0];
    pl_tasks_ranges(s->tasks, slots.count, PL_BODIES_SHARED, drift,
                    &(passage){ &s->world->solver, slots.first, s->h });
    pl_move_kinematic(s);
}
