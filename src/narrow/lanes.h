// lanes.h - what every narrow-phase kernel begins and ends with: W pairs gathered into lanes, W
// results written as manifolds. Included by *.simd.c only.
//
// All kernels work relative to the core centre of A, in world axes, so that distance from the
// world's origin costs no precision. d is the core centre of B.
#ifndef PL_LANES_H
#define PL_LANES_H

#include "core/wide.h"
#include "narrow/narrow.h"

typedef struct lanes {
    uint32_t pair[PL_WIDTH];           // places in the pair list
    uint32_t a[PL_WIDTH], b[PL_WIDTH]; // piece slots
    vf dx, dy;                         // [m] core centre of B seen from that of A
    vf ac, as, bc, bs;                 // rotations of the pieces' own frames (boxes, capsules)
    vf pac, pas, pbc, pbs;             // rotations of the bodies (for pool vertices)
    vf ahx, ahy, bhx, bhy;             // half extents
    vf ar, br;                         // radii
    vf acx, acy, bcx, bcy;             // core centres in the bodies' frames
    vf oax, oay, obx, oby; // [m] core centre seen from the centre of mass, in world axes
    vf vx, vy;             // [m/s] of the centre of mass of B against that of A
} lanes;

// Up to two points; an absent one has separation PL_APART.
typedef struct touch {
    vf nx, ny;
    vf px[2], py[2]; // midway between the surfaces, from A's core centre
    vf sep[2];
    vm feature[2];
    vm turns; // PL_MET_TURNS_...
} touch;

//---- where the cores are -----------------------------------------------------------------------------
//
// Places are plumb_real. Where these are wider than lanes, in the far build, they are subtracted pair by
// pair; else W pairs at a time.

#if PLUMB_IS_FAR
typedef plumb_real place;
#define EACH(x) (x)
#else
typedef vf place;
#define EACH(x) splat(x)
#endif

#define POSE (PLUMB_IS_FAR ? 10 : 8) // reals of a pl_pose

// Adding and taking it away rounds to whole numbers.
#if PLUMB_REAL_IS_DOUBLE
#define WHOLE ((plumb_real)6755399441055744) // 1.5 x 2^52
#else
#define WHOLE ((plumb_real)12582912) // 1.5 x 2^23
#endif

// (b - a) + arm by the nearest image in a world of this period [m]. Half of the periods between is taken from
// either side: near the edge that is exact, where it would not be to take them from one.
WIDE_INLINE place nearest_image(place a, place b, place arm, plumb_real period)
{
    if (!(period > 0)) {
        return (b - a) + arm;
    }
    place whole = EACH(WHOLE);
    place half = ((((b - a) + arm) / EACH(period) + whole) - whole) * EACH(period / 2);
    return ((b - half) - (a + half)) + arm;
}

// (x, y) turned by (c, s).
WIDE_INLINE void turn(place out[2], place c, place s, place x, place y)
{
#if PLUMB_IS_FAR
    // As vectors: of c x - s y beside s x + c y GCC 12 makes a fused vfmaddsub for AVX-512, whatever -ffp-contract
    // says, and the bits would depend on the width.
    typedef plumb_real two __attribute__((vector_size(2 * sizeof(plumb_real))));
    const two turned = (two){ c, c } * (two){ x, y } + (two){ -s, s } * (two){ y, x };
    out[0] = turned[0], out[1] = turned[1];
#else
    out[0] = c * x - s * y, out[1] = s * x + c * y;
#endif
}

typedef struct centres {
    place dx, dy; // as in `lanes`
    place oax, oay, obx, oby;
} centres;

// From x y c s dx dy (vx vy residual_x residual_y) of the poses, x y of the cores.
WIDE_INLINE void centres_of(centres *o, const pl_narrow_input *in, const place *pa, const place *pb,
                            const place *ca, const place *cb)
{
    place a[2], b[2]; // from the body's origin to the core centre
    turn(a, pa[2], pa[3], ca[0], ca[1]);
    turn(b, pb[2], pb[3], cb[0], cb[1]);
    place arm_x = b[0] - a[0], arm_y = b[1] - a[1];
    if (PLUMB_IS_FAR) {
        arm_x += pb[8] - pa[8];
        arm_y += pb[9] - pa[9];
    }
    if (in->wrapped) {
        o->dx = nearest_image(pa[0], pb[0], arm_x, in->wrap_x);
        o->dy = nearest_image(pa[1], pb[1], arm_y, in->wrap_y);
    } else {
        o->dx = (pb[0] - pa[0]) + arm_x;
        o->dy = (pb[1] - pa[1]) + arm_y;
    }
    o->oax = a[0] - pa[4], o->oay = a[1] - pa[5];
    o->obx = b[0] - pb[4], o->oby = b[1] - pb[5];
}

#if PLUMB_IS_FAR
WIDE_INLINE void centres_gather(lanes *l, const pl_narrow_input *in, const place *const *pose_a,
                                const place *const *pose_b, const place *const *core_a,
                                const place *const *core_b)
{
    near_real rows[PL_WIDTH][8] __attribute__((aligned(64)));
    const near_real *row[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        centres o;
        centres_of(&o, in, pose_a[i], pose_b[i], core_a[i], core_b[i]);
        rows[i][0] = (near_real)o.dx, rows[i][1] = (near_real)o.dy;
        rows[i][2] = (near_real)o.oax, rows[i][3] = (near_real)o.oay;
        rows[i][4] = (near_real)o.obx, rows[i][5] = (near_real)o.oby;
        rows[i][6] = rows[i][7] = 0;
        row[i] = rows[i];
    }
    vf r[8];
    gather8(r, row);
    l->dx = r[0], l->dy = r[1];
    l->oax = r[2], l->oay = r[3], l->obx = r[4], l->oby = r[5];
}
#endif

// Gathers the `count` <= W pairs at these places; lanes beyond repeat the last one.
WIDE_PART void lanes_gather(lanes *l, const pl_narrow_input *in, const uint32_t *places,
                            uint32_t count)
{
    const plumb_real *pose_a[PL_WIDTH], *pose_b[PL_WIDTH], *core_a[PL_WIDTH], *core_b[PL_WIDTH];
    for (uint32_t i = 0; i < PL_WIDTH; ++i) {
        l->pair[i] = places[i < count ? i : count - 1];
        const pl_pair *pair = &in->pairs[l->pair[i]];
        l->a[i] = pair->a;
        l->b[i] = pair->b;
        pose_a[i] = in->poses + (size_t)pair->body_a * POSE;
        pose_b[i] = in->poses + (size_t)pair->body_b * POSE;
        core_a[i] = (const plumb_real *)(const void *)&in->cores[pair->a];
        core_b[i] = (const plumb_real *)(const void *)&in->cores[pair->b];
    }
    vf pa[8], pb[8], ca[8], cb[8]; // x y c s dx dy vx vy; x y c s hx hy radius reach
    gather8_far(pa, pose_a);
    gather8_far(pb, pose_b);
    gather8_far(ca, core_a);
    gather8_far(cb, core_b);
#if PLUMB_IS_FAR
    centres_gather(l, in, pose_a, pose_b, core_a, core_b);
#else
    centres o;
    centres_of(&o, in, pa, pb, ca, cb);
    l->dx = o.dx, l->dy = o.dy;
    l->oax = o.oax, l->oay = o.oay, l->obx = o.obx, l->oby = o.oby;
#endif
    l->acx = ca[0], l->acy = ca[1], l->bcx = cb[0], l->bcy = cb[1];
    l->ac = pa[2] * ca[2] - pa[3] * ca[3];
    l->as = pa[3] * ca[2] + pa[2] * ca[3];
    l->bc = pb[2] * cb[2] - pb[3] * cb[3];
    l->bs = pb[3] * cb[2] + pb[2] * cb[3];
    l->pac = pa[2], l->pas = pa[3], l->pbc = pb[2], l->pbs = pb[3];
    l->ahx = ca[4], l->ahy = ca[5], l->bhx = cb[4], l->bhy = cb[5];
    l->ar = ca[6], l->br = cb[6];
    l->vx = pb[6] - pa[6];
    l->vy = pb[7] - pa[7];
}

// A pair that is apart: nothing is carried over.
static inline void part(pl_pair *pair)
{
    if (pair->manifold != PL_NONE) {
        pair->feature[0] = pair->feature[1] = PL_NONE;
        pair->normal[0] = pair->normal[1] = 0;
        pair->tangent[0] = pair->tangent[1] = 0;
        pair->manifold = PL_NONE;
    }
    pair->flags &= ~(PL_PAIR_HIT | PL_PAIR_AHEAD | PL_PAIR_SLIDES | PL_PAIR_LOADS);
}

// What points are, and whose impulses they go on with: those that are nearer than their `limit`, by feature.
static inline uint32_t keep_points(pl_pair *pair, pl_manifold *m, const near_real limit[2],
                                   const uint32_t feature[2])
{
    const pl_pair old = *pair;
    uint32_t count = 0;
    for (int k = 0; k < 2; ++k) {
        if (!(m->point[k].separation < limit[k])) {
            continue;
        }
        pl_manifold_point *p = &m->point[count];
        *p = m->point[k];
        for (int j = 0; j < 2; ++j) {
            if (old.feature[j] == feature[k]) {
                p->normal = old.normal[j];
                p->tangent = old.tangent[j];
            }
        }
        m->feature[count] = pair->feature[count] = feature[k];
        pair->normal[count] = p->normal;
        pair->tangent[count] = p->tangent;
        ++count;
    }
    for (uint32_t k = count; k < 2; ++k) {
        m->point[k] = (pl_manifold_point){ .separation = PL_APART };
        m->feature[k] = pair->feature[k] = PL_NONE;
        pair->normal[k] = pair->tangent[k] = 0;
    }
    return count;
}

// The same where both points are as they were, as most of a pile's are.
static inline uint32_t keep_both(const pl_pair *pair, pl_manifold *m)
{
    for (int k = 0; k < 2; ++k) {
        m->point[k].normal = pair->normal[k];
        m->point[k].tangent = pair->tangent[k];
        m->feature[k] = pair->feature[k];
    }
    return 2;
}

// What is carried over to one lane's manifold, whose rows are there.
static inline void emit_lane(pl_pair *pair, pl_manifold *m, const near_real limit[2],
                             const uint32_t feature[2])
{
    const bool both = m->point[0].separation < limit[0] && m->point[1].separation < limit[1];
    const bool same = pair->feature[0] == feature[0] && pair->feature[1] == feature[1];
    m->count = (uint16_t)(both && same ? keep_both(pair, m) : keep_points(pair, m, limit, feature));
    m->waits = m->ends = 0;
    m->disabled = 0;
    m->before = pair->manifold;
    m->body_a = pair->body_a;
    m->body_b = pair->body_b;
    pair->flags &= ~(PL_PAIR_HIT | PL_PAIR_AHEAD);
}

// pl_overlaps_count() of the lanes in `here`.
WIDE_INLINE void count_overlaps(pl_overlaps *o, const touch *t, const vf limit[2], vm here)
{
    const vf zero = splat(0);
    const vm near[2] = { here & (t->sep[0] < limit[0]), here & (t->sep[1] < limit[1]) };
    o->point_count += count_set(near[0]) + count_set(near[1]);
    const vm met[2] = { here & (t->sep[0] <= zero), here & (t->sep[1] <= zero) };
    const vm touching = met[0] | met[1];
    if (!any(touching)) {
        return;
    }
    const vf depth = vmax(sel(met[0], -t->sep[0], zero), sel(met[1], -t->sep[1], zero));
    o->touching_count += count_set(touching);
    o->sum_penetration += sum_whole(vmin(depth, splat(1000)) / splat((near_real)PL_DEPTH_UNIT));
    const near_real most = most_of(depth);
    o->max_penetration = most > o->max_penetration ? most : o->max_penetration;
}

// [m] sum of what two points close by until the horizon.
WIDE_INLINE vf closed(const touch *t, const vf arm[4], const vf way[2], const vf turned[2])
{
    return (t->nx * way[0] + t->ny * way[1]) + ((arm[0] * t->ny - arm[1] * t->nx) * turned[0] -
                                                (arm[2] * t->ny - arm[3] * t->nx) * turned[1]);
}

// Which contacts that lie ahead may reach their plane while the bodies fly on, and which of the others close. More
// than do: ahead.c looks closely.
WIDE_INLINE vm lanes_act(const lanes *l, const touch *t, const pl_narrow_input *in,
                         const vf turn_rates[2], const vf arms[2][4], vm ahead)
{
    if (!in->plain) {
        return ~(vm){ 0 };
    }
    near_real falls[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        const pl_pair *pair = &in->pairs[l->pair[i]];
        falls[i] =
            (near_real)((pair->body_a < in->dynamic_count) - (pair->body_b < in->dynamic_count));
    }
    const vf horizon = splat(in->horizon), fall = load(falls);
    const vf way[2] = { splat(in->fall_x) * fall - l->vx * horizon,
                        splat(in->fall_y) * fall - l->vy * horizon };
    const vf turned[2] = { turn_rates[0] * horizon, turn_rates[1] * horizon };
    vm acts = { 0 };
    for (int k = 0; k < 2; ++k) {
        const vf most = closed(t, arms[k], way, turned);
        const vf rounding = splat((near_real)1e-5) + vabs(most) * splat((near_real)1e-4);
        acts |= most + rounding > sel(ahead, t->sep[k], splat(PL_TURNED));
    }
    return acts;
}

// Which contacts lie ahead. What touched goes on to touch while it is near, and is none of those.
WIDE_INLINE vm lanes_ahead(const lanes *l, const touch *t, const pl_narrow_input *in,
                           vf restitution)
{
    const vm far = (t->sep[0] > splat(PL_AHEAD)) & (t->sep[1] > splat(PL_AHEAD));
    const vm apart = (t->sep[0] > splat(PL_AHEAD_HIT)) & (t->sep[1] > splat(PL_AHEAD_HIT));
    vm hits = (restitution > splat(0)) & apart & ~far &
              ((t->turns & (pl_lane)PL_MET_TURNS) == (pl_lane)PL_MET_TURNS_MID);
    if (!any(hits)) {
        return far;
    }
    for (int i = 0; i < PL_WIDTH; ++i) {
        if ((in->pairs[l->pair[i]].flags & PL_PAIR_TOUCHING) != 0) {
            hits[i] = 0;
        }
    }
    return far | hits;
}

static inline void note_restitutions(pl_narrow *out, vm here, vf restitution)
{
    for (int i = 0; i < PL_WIDTH; ++i) {
        if (here[i] != 0 && restitution[i] > 0) {
            pl_narrow_note_restitution(out, restitution[i]);
        }
    }
}

// The lanes of pairs that are PL_PAIR_SOUGHT.
static inline vm sought_lanes(const lanes *l, const pl_narrow_input *in)
{
    pl_lane sought[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        sought[i] = (in->pairs[l->pair[i]].flags & PL_PAIR_SOUGHT) != 0 ? -1 : 0;
    }
    vm out;
    memcpy(&out, sought, sizeof out);
    return out;
}

// [rad/s] of A and B.
WIDE_INLINE void turn_rates_of(vf out[2], const lanes *l, const pl_narrow_input *in)
{
    if (in->w == NULL) {
        out[0] = out[1] = splat(0);
        return;
    }
    near_real wa[PL_WIDTH], wb[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        const pl_pair *pair = &in->pairs[l->pair[i]];
        wa[i] = (near_real)in->w[pair->body_a];
        wb[i] = (near_real)in->w[pair->body_b];
    }
    out[0] = load(wa), out[1] = load(wb);
}

// [m] the separations below which points are contacts. Points that will meet within the step are contacts already: they stop
// at the surface instead of inside it, and an elastic impact can be put where it happens. What turns brings its corners
// down with it; by how little makes no difference (PL_BESIDE_SPIN).
WIDE_INLINE void limits_of(vf limit[2], const lanes *l, const touch *t, const pl_narrow_input *in,
                           const vf turn_rates[2], vf restitution)
{
    const vf least = splat(PL_SPECULATIVE), dt = splat(in->dt);
    const vf linear = -(t->nx * l->vx + t->ny * l->vy) * dt;
    // It may come back from another impact.
    const vf back = sel(restitution > splat(in->elastic_above),
                        vsqrt(l->vx * l->vx + l->vy * l->vy) * dt, linear);
    for (int k = 0; k < 2; ++k) {
        const vf ax = t->px[k] + l->oax, ay = t->py[k] + l->oay;
        const vf bx = t->px[k] - l->dx + l->obx, by = t->py[k] - l->dy + l->oby;
        const vf spin = ((ax * t->ny - ay * t->nx) * turn_rates[0] -
                         (bx * t->ny - by * t->nx) * turn_rates[1]) *
                        dt;
        limit[k] = vmax(vmax(least, least + back), linear + spin + splat(PL_BESIDE_SPIN));
    }
}

// Appends the manifolds of `count` lanes, straight to where they stay.
WIDE_PART void lanes_emit(const lanes *l, const touch *t, const pl_narrow_input *in, uint32_t count,
                          pl_narrow *out)
{
    near_real friction_a[PL_WIDTH], friction_b[PL_WIDTH], bounce_a[PL_WIDTH], bounce_b[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        friction_a[i] = (near_real)in->friction[l->a[i]];
        friction_b[i] = (near_real)in->friction[l->b[i]];
        bounce_a[i] = (near_real)in->restitution[l->a[i]];
        bounce_b[i] = (near_real)in->restitution[l->b[i]];
    }
    vf zero = splat(0);
    vf friction = vsqrt(load(friction_a) * load(friction_b));
    vf restitution = vmax(load(bounce_a), load(bounce_b));
    vf turn_rates[2], limit[2];
    turn_rates_of(turn_rates, l, in);
    limits_of(limit, l, t, in, turn_rates, restitution);
    const vm sought = in->seeks ? sought_lanes(l, in) : (vm){ 0 };
    limit[0] = sel(sought, splat(PL_APART), limit[0]);
    limit[1] = sel(sought, splat(PL_APART), limit[1]);

    if (!any((t->sep[0] < limit[0]) | (t->sep[1] < limit[1]))) {
        for (uint32_t i = 0; i < count; ++i) {
            part(&in->pairs[l->pair[i]]);
        }
        return;
    }
    near_real told[2]
                  [PL_WIDTH]; // limits of the points; the lanes that have a manifold, and its place
    pl_lane keeps[PL_WIDTH];
    uint32_t end = out->manifold_count;
    const vm here = ((t->sep[0] < limit[0]) | (t->sep[1] < limit[1])) & lanes_below(count);
    memcpy(keeps, &here, sizeof keeps);
    store(told[0], limit[0]);
    store(told[1], limit[1]);
    pl_manifold none; // of lanes that have none
    near_real *row[PL_WIDTH], *point0[PL_WIDTH], *point1[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        pl_manifold *m = keeps[i] != 0 ? &pl_manifolds(out)[end] : &none;
        end += keeps[i] != 0;
        row[i] = &m->nx, point0[i] = &m->point[0].ax, point1[i] = &m->point[1].ax;
    }
    scatter8(row, (vf[8]){ t->nx, t->ny, friction, restitution, zero, zero, zero, zero });
    // Anchors lie on the surfaces, half the separation to either side of the middle: an elastic
    // contact seen from afar has its true lever arms.
    vf arms[2][4];
    for (int k = 0; k < 2; ++k) {
        vf gap = t->sep[k] * splat((near_real)0.5);
        vf gx = t->nx * gap, gy = t->ny * gap;
        arms[k][0] = t->px[k] - gx + l->oax, arms[k][1] = t->py[k] - gy + l->oay;
        arms[k][2] = t->px[k] + gx - l->dx + l->obx, arms[k][3] = t->py[k] + gy - l->dy + l->oby;
        scatter8(k == 0 ? point0 : point1, (vf[8]){ arms[k][0], arms[k][1], arms[k][2], arms[k][3],
                                                    t->sep[k], zero, zero, zero });
    }
    const vm ahead = lanes_ahead(l, t, in, restitution);
    const vm acts = lanes_act(l, t, in, turn_rates, (const vf(*)[4])arms, ahead);
    const vm notes = (~ahead & (pl_lane)PL_CANDIDATE_STRIKES) |
                     (acts & (pl_lane)PL_CANDIDATE_ACTS) | (sought & (pl_lane)PL_CANDIDATE_SOUGHT) |
                     ((restitution > zero) & (pl_lane)PL_CANDIDATE_BOUNCES);
    const vm noted = here & (ahead | acts | (restitution * restitution > splat(PL_IMPACT_KEPT)));
    const bool some_noted = any(noted);
    out->any_friction |= any(here & (friction > zero));
    if (any(here & (restitution > zero))) {
        note_restitutions(out, here, restitution);
    }
    count_overlaps(&out->overlaps, t, limit, here);
    pl_ends *ends = out->ends.data;
    uint32_t *fresh = out->fresh.data, fresh_count = out->fresh_count;
    uint32_t at = out->manifold_count;
    for (uint32_t i = 0; i < count; ++i) {
        pl_pair *pair = &in->pairs[l->pair[i]];
        if (keeps[i] == 0) {
            part(pair);
            continue;
        }
        pl_manifold *m = (pl_manifold *)(void *)row[i];
        const uint32_t feature[2] = { (uint32_t)t->feature[0][i], (uint32_t)t->feature[1][i] };
        emit_lane(pair, m, (const near_real[2]){ told[0][i], told[1][i] }, feature);
        m->pair = l->pair[i];
        m->met = (uint16_t)t->turns[i];
        fresh[fresh_count] = l->pair[i];
        fresh_count += (pair->flags & PL_PAIR_TOUCHING) == 0;
        ends[at] = (pl_ends){ pair->body_a, pair->body_b };
        if (some_noted && noted[i] != 0) {
            ((uint32_t *)out->candidates.data)[out->candidate_count++] = at | (uint32_t)notes[i];
        }
        pair->manifold = at++;
    }
    out->fresh_count = fresh_count;
    out->manifold_count = at;
}

// A kernel that takes every pair of its range through `name(touch *, const lanes *, input *, kind_b)`.
#define DEFINE_KERNEL(name)                                                                        \
    pl_narrow_kernel PL_WIDE_NAME(pl_##name);                                                      \
    void PL_WIDE_NAME(pl_##name)(const pl_narrow_input *in, uint32_t first, uint32_t count,        \
                                 int kind_b, pl_narrow *out)                                       \
    {                                                                                              \
        for (uint32_t i = 0; i < count; i += PL_WIDTH) {                                           \
            uint32_t n = count - i < PL_WIDTH ? count - i : PL_WIDTH;                              \
            uint32_t places[PL_WIDTH];                                                             \
            for (uint32_t j = 0; j < n; ++j) {                                                     \
                places[j] = first + i + j;                                                         \
            }                                                                                      \
            lanes l;                                                                               \
            touch t;                                                                               \
            lanes_gather(&l, in, places, n);                                                       \
            name(&t, &l, in, kind_b);                                                              \
            lanes_emit(&l, &t, in, n, out);                                                        \
        }                                                                                          \
    }

#endif
