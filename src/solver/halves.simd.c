// halves.simd.c - the kick of a substep in halves: contacts are solved and bodies move between them, so that what contacts
// push moves to second order in the substep, as what flies does. W bodies at a time.
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
// 100 m/s against a wall of six went back 4 m.) So the kick is whole after a hit, and before the first push of a step; once
// it is in halves it stays so where nothing pushes, as contacts that let go push again. What joints push is no hit. Joints
// know what of their impulses comes behind the drift, of either body (joints/one.c, spring.c), and some assemblies of theirs are
// always kicked whole (joints/assembly.c).
//
// Reads: solver bodies, motions. Writes: solver bodies. Order: behind impacts, before the sweeps; the drift. Cost: two passes
// over the bodies of a substep; washer, W = 8: 20.5 and 28.3 million instructions (a body at a time 35.8 and 42.1).
#include "solver/bundle.h"
#include "solver/substep.h"
#include "world/state.h"

#define HALF ((near_real)0.5)

// Square of a push that is a hit, over that of the forces' kick. The body's speed must not count: seen from a train all have more
// of it (DECISIONS.md).
#define HIT_FORCES ((near_real)16)

// Square of a push that is none, over that of the forces' kick. What contacts give and take back leaves a rounding or nothing at
// all, by the side from which a body came: mirrored boxes parted by up to 8 m/s within a second (tests/stability/test_mirror.c).
#define NO_PUSH ((near_real)1e-8)

// Reals of a solver body and of its motion; of what it is kicked by.
enum { BODY = sizeof(pl_solver_body) / sizeof(near_real), KICK = 4 };
_Static_assert(sizeof(pl_solver_motion) == sizeof(pl_solver_body),
               "a motion is as long as its body");

// Bodies in a row, W or the first few of them.
typedef struct block {
    near_real *body, *motion, *kicked;
    uint32_t slot, count; // of the first; bodies that there are
} block;

// A vector along x, y and the turn.
typedef struct kick {
    vf x, y, w;
} kick;

WIDE_INLINE vf square_of(kick k)
{
    return k.x * k.x + k.y * k.y;
}

// Four reals of each body from `from` on.
WIDE_INLINE void take(vf out[4], near_real *from, int stride)
{
    const near_real *row[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        row[i] = from + i * stride;
    }
    gather4(out, row, 0);
}

WIDE_INLINE void give(near_real *to, int stride, const vf in[4])
{
    near_real *row[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        row[i] = to + i * stride;
    }
    scatter4(row, 0, in);
}

WIDE_INLINE kick kick_of(const vf r[4])
{
    return (kick){ r[0], r[1], r[2] };
}

WIDE_INLINE kick times(vf by, kick k)
{
    return (kick){ by * k.x, by * k.y, by * k.w };
}

WIDE_INLINE kick plus(kick a, kick b)
{
    return (kick){ a.x + b.x, a.y + b.y, a.w + b.w };
}

WIDE_INLINE kick minus(kick a, kick b)
{
    return (kick){ a.x - b.x, a.y - b.y, a.w - b.w };
}

// Of those, bodies without joints or that contacts push, too: what joints push is never a hit, and is there from the first
// substep on.
WIDE_PART vm not_only_tied(const plumb_world *world, const block *b, vm of)
{
    const pl_solver *s = &world->solver;
    const uint32_t *rows = s->rows.data;
    const uint64_t *masks = s->masks.data;
    for (uint32_t i = 0; i < b->count; ++i) {
        const uint32_t slot = b->slot + i;
        if (of[i] && masks[slot] == 0 && world->bodies.first_joint[rows[slot]] != PL_NONE) {
            of[i] = 0;
        }
    }
    return of;
}

// The share of a slot is negative while its kick is whole.
WIDE_INLINE void halve(const pl_passage *p, const block *b)
{
    vf velocity[4], acceleration[4], flown[4], before[4];
    take(velocity, b->body, BODY);
    take(acceleration, b->motion, BODY);
    take(flown, b->motion + 4, BODY);
    take(before, b->kicked, KICK);
    const kick v = kick_of(velocity), u = kick_of(flown);
    const kick force = times(splat(p->h), kick_of(acceleration)), pushed = minus(v, u);
    const vf zero = splat(0), square = square_of(pushed), share = vabs(before[3]);
    const vf weight = square_of(force);
    const vm flew = ~(square > splat(NO_PUSH) * weight) & ~(before[3] > zero);
    vm hit = flew | (square > splat(HIT_FORCES) * weight);
    if (any(hit) && p->world->joints.live > 0) {
        hit = not_only_tied(p->world, b, hit);
    }
    const kick behind = times(sel(hit, zero, share), plus(force, pushed)), now = minus(v, behind);
    give(b->body, BODY, (vf[4]){ now.x, now.y, now.w, velocity[3] });
    give(b->kicked, KICK, (vf[4]){ behind.x, behind.y, behind.w, sel(hit, -share, share) });
}

// Contacts that give up more than they have given yet would pull until the drift is over: where bodies leave them. [-] of
// P, what is too much of it, when they took so much back.
WIDE_INLINE vf pulled(kick taken, kick push)
{
    const vf zero = splat(0), one = splat(1), all = square_of(push);
    const vf back = taken.x * push.x + taken.y * push.y;
    const vm some = all > zero;
    // A load that shifts is no leave.
    const vf over = sel(some, splat(10) * back / sel(some, all, one) - splat(9), zero);
    return sel(over < zero, zero, sel(over > one, splat(HALF), splat(HALF) * over));
}

// Who is not pushed flies on the parabola, to the bit.
WIDE_INLINE void drift(const pl_passage *p, const block *b)
{
    vf velocity[4], gone[4], acceleration[4], flown[4], kicked[4];
    take(velocity, b->body, BODY);
    take(gone, b->body + 4, BODY);
    take(acceleration, b->motion, BODY);
    take(flown, b->motion + 4, BODY);
    take(kicked, b->kicked, KICK);
    const vf zero = splat(0), h = splat(p->h);
    const kick v = kick_of(velocity), u = kick_of(flown), behind = kick_of(kicked);
    const kick force = times(h, kick_of(acceleration)), now = plus(v, behind), kept = minus(now, u);
    const vm halved = kicked[3] > zero;
    const kick push = minus(times(splat(2), behind), force);
    const vf over = pulled(minus(plus(u, push), now), push);
    vm leaves = halved & (over > zero);
    if (any(leaves) && p->world->joints.live > 0) {
        leaves = not_only_tied(p->world, b, leaves);
    }
    const vm flies = ~halved & (square_of(kept) <= splat(NO_PUSH) * square_of(force));
    const vm turns = ~halved & (kept.w * kept.w <= splat(NO_PUSH) * force.w * force.w);
    kick way = times(h, v);
    const kick more = plus(way, times(h * over, push));
    const kick less = minus(way, times(splat(HALF) * h, force));
    way.x = sel(leaves, more.x, sel(flies, less.x, way.x));
    way.y = sel(leaves, more.y, sel(flies, less.y, way.y));
    way.w = sel(leaves, more.w, sel(turns, less.w, way.w));
    give(b->body + 4, BODY, (vf[4]){ gone[0] + way.x, gone[1] + way.y, gone[2] + way.w, gone[3] });
    give(b->body, BODY, (vf[4]){ now.x, now.y, now.w, velocity[3] });
}

typedef void run_block(const pl_passage *p, const block *b);

// The bodies that are left over go through as the first of a block whose others are nothing.
WIDE_INLINE void run_rest(const pl_passage *p, const block *b, run_block *run)
{
    near_real bodies[PL_WIDTH * BODY] __attribute__((aligned(64))) = { 0 };
    near_real motions[PL_WIDTH * BODY] __attribute__((aligned(64))) = { 0 };
    near_real kicks[PL_WIDTH * KICK] __attribute__((aligned(64))) = { 0 };
    const size_t size = b->count * sizeof(near_real);
    memcpy(bodies, b->body, BODY * size);
    memcpy(motions, b->motion, BODY * size);
    memcpy(kicks, b->kicked, KICK * size);
    run(p, &(block){ bodies, motions, kicks, b->slot, b->count });
    memcpy(b->body, bodies, BODY * size);
    memcpy(b->kicked, kicks, KICK * size);
}

WIDE_INLINE void run_all(const pl_passage *p, uint32_t first, uint32_t count, run_block *run)
{
    const pl_solver *s = &p->world->solver;
    for (uint32_t i = 0; i < count; i += PL_WIDTH) {
        const uint32_t slot = p->first + first + i, left = count - i;
        const block b = { &pl_solver_bodies(s)[slot].vx, &pl_solver_motions(s)[slot].ax,
                          (near_real *)s->kicked.data + KICK * (size_t)slot, slot,
                          left < PL_WIDTH ? left : PL_WIDTH };
        if (left < PL_WIDTH) {
            run_rest(p, &b, run);
        } else {
            run(p, &b);
        }
    }
}

void PL_WIDE_NAME(pl_bodies_halve)(void *passage, uint32_t first, uint32_t count)
{
    run_all(passage, first, count, halve);
}

void PL_WIDE_NAME(pl_bodies_drift)(void *passage, uint32_t first, uint32_t count)
{
    run_all(passage, first, count, drift);
}
