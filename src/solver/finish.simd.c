// finish.simd.c - bodies moved by a step, W dynamic rows at a time: what finish.c does to each of them, to the bit.
//
// Formulas and order of operations are those of finish.c and plumb_rot_integrate. Rows that an effect concerns, that turn far or
// would be lost are left to finish.c, and their neighbours with them. In the float build alone: of doubles a
// register holds few, and the columns of the far build are doubles.
//
// Reads: solver bodies, forces, masses. Writes: transforms, velocities, poses, movers. Cost: of large_pyramid 1.1 % of a step
// in place of 4.7.
#include "solver/bundle.h"
#include "solver/finish.h"
#include "world/flight.h"

#if PLUMB_REAL_IS_DOUBLE

bool PL_WIDE_NAME(pl_bodies_place)(const pl_finish *p, uint32_t row, pl_mover *movers,
                                   uint32_t *count)
{
    (void)p, (void)row, (void)movers, (void)count;
    return false;
}

#else

#define HALF_WIDTH (PL_WIDTH / 2)

typedef float half_lanes __attribute__((vector_size(HALF_WIDTH * sizeof(float))));
typedef double half_doubles __attribute__((vector_size(HALF_WIDTH * sizeof(double))));

WIDE_INLINE half_doubles widened(const near_real *p)
{
    half_lanes v;
    memcpy(&v, p, sizeof v);
    return __builtin_convertvector(v, half_doubles);
}

// pl_add: a value, and what rounding took from it.
typedef struct sum {
    vf value, low;
} sum;

WIDE_INLINE void add(sum *s, vf change)
{
    near_real value[PL_WIDTH], low[PL_WIDTH], more[PL_WIDTH];
    store(value, s->value);
    store(low, s->low);
    store(more, change);
    for (int i = 0; i < PL_WIDTH; i += HALF_WIDTH) {
        const half_doubles wanted = widened(value + i) + (widened(more + i) + widened(low + i));
        const half_lanes rounded = __builtin_convertvector(wanted, half_lanes);
        const half_lanes rest = __builtin_convertvector(
            wanted - __builtin_convertvector(rounded, half_doubles), half_lanes);
        memcpy(value + i, &rounded, sizeof rounded);
        memcpy(low + i, &rest, sizeof rest);
    }
    s->value = load(value);
    s->low = load(low);
}

// W bodies.
typedef struct places {
    sum x, y, vx, vy;
    vf c, s, w, angle;
} places;

WIDE_INLINE sum sum_of(const near_real *value, const near_real *low, uint32_t row)
{
    return (sum){ load(value + row), load(low + row) };
}

WIDE_INLINE void put_sum(near_real *value, near_real *low, uint32_t row, sum s)
{
    store(value + row, s.value);
    store(low + row, s.low);
}

WIDE_INLINE vf noticed(vf speed)
{
    return sel(vabs(speed) > splat(PL_NO_SPEED), speed, splat(0));
}

// Of bodies in contacts or joints; the others get what is at their place in `row`.
WIDE_INLINE void take_over(places *q, const near_real *const *row, const near_real *const *low)
{
    vf moved[8]; // vx vy w .., dx dy da ..
    gather8(moved, row);
    add(&q->x, moved[4]);
    add(&q->y, moved[5]);
    q->angle = moved[6];
    q->vx.value = noticed(moved[0]);
    q->vy.value = noticed(moved[1]);
    q->w = noticed(moved[2]);
    q->vx.low = q->vy.low = splat(0);
    if (low != NULL) {
        vf rest[4];
        gather4(rest, low, 0);
        const vm kept = rest[3] != splat(0);
        q->vx.low = sel(kept, rest[0], splat(0));
        q->vy.low = sel(kept, rest[1], splat(0));
    }
}

// Of bodies in no contact.
WIDE_INLINE void fly(places *q, const plumb_world *world, uint32_t row, vf dt)
{
    const pl_bodies *b = &world->bodies;
    const vf gravity = load(b->gravity_scale + row), inv_mass = load(b->inv_mass + row);
    const vf two = splat(2);
    const vf ax = splat(world->effects.gravity.x) * gravity + load(b->fx + row) * inv_mass;
    const vf ay = splat(world->effects.gravity.y) * gravity + load(b->fy + row) * inv_mass;
    const vf aw = load(b->torque + row) * load(b->inv_inertia + row);
    add(&q->x, dt * (q->vx.low + ax * dt / two));
    add(&q->y, dt * (q->vy.low + ay * dt / two));
    add(&q->x, dt * q->vx.value);
    add(&q->y, dt * q->vy.value);
    q->angle = dt * (q->w + aw * dt / two);
    add(&q->vx, ax * dt);
    add(&q->vy, ay * dt);
    q->w += aw * dt;
}

WIDE_INLINE sum choose(vm mask, sum a, sum b)
{
    return (sum){ sel(mask, a.value, b.value), sel(mask, a.low, b.low) };
}

WIDE_INLINE void keep(places *q, vm mask, const places *other)
{
    q->x = choose(mask, other->x, q->x);
    q->y = choose(mask, other->y, q->y);
    q->vx = choose(mask, other->vx, q->vx);
    q->vy = choose(mask, other->vy, q->vy);
    q->w = sel(mask, other->w, q->w);
    q->angle = sel(mask, other->angle, q->angle);
}

// Turns by less than PLUMB_ROT_SMALL_TURN.
WIDE_INLINE void turn(places *q)
{
    const vf one = splat(1), two = splat(2);
    const vf h = q->angle / two, z = h * h;
    vf t = splat(PLUMB_REAL(17.0 / 315.0)) + z * splat(PLUMB_REAL(62.0 / 2835.0));
    t = h + h * z * (splat(PLUMB_REAL(1.0 / 3.0)) + z * (splat(PLUMB_REAL(2.0 / 15.0)) + z * t));
    const vf by = one / (one + t * t);
    const vf dc = (one - t * t) * by, ds = two * t * by;
    const vf c = q->c * dc - q->s * ds, s = q->s * dc + q->c * ds;
    const vf k = (splat(3) - (c * c + s * s)) / two;
    const vm turns = vabs(q->angle) > splat(PL_NO_TURN);
    q->c = sel(turns, c * k, q->c);
    q->s = sel(turns, s * k, q->s);
}

WIDE_INLINE vm sane(vf v)
{
    return (v >= splat(-PL_LARGEST)) & (v <= splat(PL_LARGEST));
}

static const near_real nothing[8] __attribute__((aligned(64))) = { 0 };

// What the W bodies come to. False: not all are of those that go through lanes.
WIDE_INLINE bool find_places(places *q, const pl_finish *p, uint32_t row)
{
    const plumb_world *world = p->world;
    const pl_bodies *b = &world->bodies;
    const uint32_t *slots = p->collided ? (const uint32_t *)world->solver.slots.data + row : NULL;
    const near_real *solved[PL_WIDTH], *low[PL_WIDTH];
    pl_lane flying[PL_WIDTH];
    uint32_t flags = 0, fly_count = 0;
    for (int i = 0; i < PL_WIDTH; ++i) {
        const uint32_t slot = slots == NULL ? PL_NONE : slots[i];
        const bool flies = slot == PL_NONE;
        solved[i] = flies ? nothing : &pl_solver_bodies(&world->solver)[slot].vx;
        low[i] = flies || p->residuals == NULL ? nothing : &p->residuals[(size_t)slot * 4];
        flying[i] = flies ? -1 : 0;
        fly_count += flies;
        flags |= b->flags[row + (uint32_t)i];
    }
    if ((flags & PL_BODY_HAS_EFFECTS) != 0) {
        return false;
    }
    const places before = { .x = sum_of(b->center_x, b->residual_x, row),
                            .y = sum_of(b->center_y, b->residual_y, row),
                            .vx = sum_of(b->vx, b->residual_vx, row),
                            .vy = sum_of(b->vy, b->residual_vy, row),
                            .c = load(b->c + row),
                            .s = load(b->s + row),
                            .w = load(b->w + row) };
    *q = before;
    if (fly_count < PL_WIDTH) {
        take_over(q, solved, p->residuals == NULL ? NULL : low);
    }
    if (fly_count > 0) {
        places free = before;
        vm flies;
        memcpy(&flies, flying, sizeof flies);
        fly(&free, world, row, splat(p->dt));
        keep(q, flies, &free);
    }
    turn(q);
    const vm good = (vabs(q->angle) <= splat(PLUMB_ROT_SMALL_TURN)) & sane(q->x.value) &
                    sane(q->y.value) & sane(q->c) & sane(q->s) & sane(q->vx.value) &
                    sane(q->vy.value) & sane(q->w);
    return !any(~good);
}

// Those whose points may have moved farther than their slack. Returns how many.
WIDE_INLINE uint32_t note_fast(const pl_bodies *b, uint32_t row, const places *q, pl_mover *out)
{
    const vf moved = vabs(q->x.value - load(b->center_x + row)) +
                     vabs(q->y.value - load(b->center_y + row)) +
                     vabs(q->angle) * load(b->extent + row);
    const vm fast = moved > load(b->slack + row);
    uint32_t count = 0;
    for (uint32_t i = 0; i < PL_WIDTH && any(fast); ++i) {
        if (fast[i] != 0) {
            const uint32_t at = row + i;
            out[count++] = (pl_mover){ .row = at,
                                       .x = b->center_x[at],
                                       .y = b->center_y[at],
                                       .c = b->c[at],
                                       .s = b->s[at],
                                       .angle = q->angle[i],
                                       .moved = moved[i],
                                       .stop = 1 };
        }
    }
    return count;
}

// Centres to origins and poses.
WIDE_INLINE void write_poses(plumb_world *world, uint32_t row, const places *q)
{
    pl_bodies *b = &world->bodies;
    const vf lx = load(b->local_x + row), ly = load(b->local_y + row);
    const vf dx = q->c * lx - q->s * ly, dy = q->s * lx + q->c * ly;
    const vf x = q->x.value - dx, y = q->y.value - dy;
    store(b->x + row, x);
    store(b->y + row, y);
    near_real *pose[PL_WIDTH];
    for (uint32_t i = 0; i < PL_WIDTH; ++i) {
        pose[i] = &pl_poses(world)[row + i].x;
    }
    scatter8(pose, (vf[8]){ x, y, q->c, q->s, dx, dy, q->vx.value, q->vy.value });
}

bool PL_WIDE_NAME(pl_bodies_place)(const pl_finish *p, uint32_t row, pl_mover *movers,
                                   uint32_t *count)
{
    plumb_world *world = p->world;
    pl_bodies *b = &world->bodies;
    places q;
    if (!find_places(&q, p, row)) {
        return false;
    }
    if (p->noting) {
        *count += note_fast(b, row, &q, movers + *count);
    }
    put_sum(b->center_x, b->residual_x, row, q.x);
    put_sum(b->center_y, b->residual_y, row, q.y);
    put_sum(b->vx, b->residual_vx, row, q.vx);
    put_sum(b->vy, b->residual_vy, row, q.vy);
    store(b->c + row, q.c);
    store(b->s + row, q.s);
    store(b->w + row, q.w);
    write_poses(world, row, &q);
    store(b->fx + row, splat(0));
    store(b->fy + row, splat(0));
    store(b->torque + row, splat(0));
    return true;
}

#endif
