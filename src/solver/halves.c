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
// 100 m/s against a wall of six went back 4 m.) So the kick is whole after a hit, and before the first push. What joints push
// is no hit. Joints know what of their impulses comes behind the drift, of either body (joints/one.c, spring.c), and some
// assemblies of theirs are always kicked whole (joints/assembly.c).
//
// Reads: solver bodies, motions. Writes: solver bodies. Order: behind impacts, before the sweeps; the drift. Cost: two passes
// over the bodies of a substep.
#include "core/quad.h"
#include "solver/substep.h"
#include "world/state.h"

#define HALF ((near_real)0.5)

// Squares of a push that is a hit, over those of the forces' kick and of the body's speed.
#define HIT_FORCES ((near_real)16)
#define HIT_SPEED  ((near_real)(1.0 / 64))

void pl_soft_share(const plumb_world *world, uint32_t row, uint32_t slot)
{
    pl_near_quad *kicked = (pl_near_quad *)world->solver.kicked.data + slot;
    (*kicked)[3] = row < world->dynamic_count ? HALF : 0;
}

static inline near_real square_of(const pl_near_quad *v)
{
    const pl_near_quad square = *v * *v;
    return square[0] + square[1];
}

// Of a body with joints that no contact pushes: what joints push is never a hit, and is there from the first substep on.
static bool is_only_tied(const plumb_world *world, uint32_t slot)
{
    const pl_solver *s = &world->solver;
    const uint32_t row = ((const uint32_t *)s->rows.data)[slot];
    return ((const uint64_t *)s->masks.data)[slot] == 0 &&
           world->bodies.first_joint[row] != PL_NONE;
}

// The share of a slot is negative while its kick is whole.
static void halve(void *context, uint32_t first, uint32_t count)
{
    const pl_passage *p = context;
    const pl_solver *s = &p->world->solver;
    pl_near_quad *body = (pl_near_quad *)(void *)(pl_solver_bodies(s) + p->first);
    const pl_near_quad *motion = (const pl_near_quad *)(void *)(pl_solver_motions(s) + p->first);
    pl_near_quad *kicked = (pl_near_quad *)s->kicked.data + p->first;
    for (uint32_t i = first; i < first + count; ++i) {
        const pl_near_quad v = body[2 * i], force = p->h * motion[2 * i];
        const pl_near_quad pushed = v - motion[2 * i + 1], before = motion[2 * i + 1] - force;
        const near_real square = square_of(&pushed);
        const bool hit = (!(square > 0) || (square > HIT_FORCES * square_of(&force) &&
                                            square > HIT_SPEED * square_of(&before))) &&
                         !is_only_tied(p->world, p->first + i);
        const near_real share = kicked[i][3] < 0 ? -kicked[i][3] : kicked[i][3];
        const pl_near_quad behind = (hit ? 0 : share) * (force + pushed);
        kicked[i] = behind;
        kicked[i][3] = hit ? -share : share;
        body[2 * i] = v - behind;
        body[2 * i][3] = v[3];
    }
}

void pl_soft_halve(pl_substep *s)
{
    pl_pass_bodies(s, 0, halve);
}

// Contacts that give up more than they have given yet would pull until the drift is over: where bodies leave them. [-] of
// P, what is too much of it, when they took so much back.
static inline near_real pulled(const pl_near_quad *taken, const pl_near_quad *push)
{
    const pl_near_quad dot = *taken * *push;
    const near_real all = square_of(push), back = dot[0] + dot[1];
    const near_real over = all > 0 ? 10 * back / all - 9 : 0; // a load that shifts is no leave
    return over < 0 ? 0 : over > 1 ? HALF : HALF * over;
}

// Who is not pushed flies on the parabola, to the bit.
static void drift(void *context, uint32_t first, uint32_t count)
{
    const pl_passage *p = context;
    const pl_solver *s = &p->world->solver;
    const near_real h = p->h;
    pl_near_quad *body = (pl_near_quad *)(void *)(pl_solver_bodies(s) + p->first);
    const pl_near_quad *motion = (const pl_near_quad *)(void *)(pl_solver_motions(s) + p->first);
    const pl_near_quad *kicked = (const pl_near_quad *)s->kicked.data + p->first;
    for (uint32_t i = first; i < first + count; ++i) {
        const pl_near_quad v = body[2 * i], force = h * motion[2 * i], u = motion[2 * i + 1];
        const pl_near_quad behind = kicked[i], now = v + behind, kept = now - u;
        pl_near_quad way = h * v;
        if (behind[3] > 0) {
            const pl_near_quad push = 2 * behind - force, taken = u + push - now;
            const near_real over = pulled(&taken, &push);
            if (over > 0 && !is_only_tied(p->world, p->first + i)) {
                way += h * over * push;
            }
        } else if (square_of(&kept) == 0 && kept[2] == 0) {
            way -= HALF * h * force;
        }
        way[3] = 0;
        body[2 * i + 1] += way;
        body[2 * i] = now;
        body[2 * i][3] = v[3];
    }
}

void pl_soft_move(pl_substep *s)
{
    pl_pass_bodies(s, 0, drift);
    pl_move_kinematic(s);
}
