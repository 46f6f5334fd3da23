// contact.simd.c - soft contact constraints of W pairs at a time: warm start, solve, relax. Their rows come from
// contact_rows.simd.c.
//
// A contact point holds n . (v_B + w_B x r_B - v_A - w_A x r_A) >= 0 by an impulse >= 0. With
// anchors frozen over the step its separation after the bodies moved by (d, a) is
//     s = s0 + n . (d_B - d_A) + a_B (r_B x n) - a_A (r_A x n).
// Apart (s > 0), the point may approach by s within the substep; overlapping, it is pushed apart
// like a damped spring of frequency w and damping ratio z, integrated implicitly (Catto, Soft
// Constraints, GDC 2011): with a1 = 2 z + h w, a2 = h w a1, a3 = 1 / (1 + a2),
//     bias = w / a1 s,  impulse change = -a2 a3 m (v_n + bias) - a3 lambda.
// What was let approach arrives at s = 0 but for a rounding: the spring sets in by degrees before that.
// Relaxing is the same without spring: it takes the push out of the velocities again.
//
// Friction acts along t = (-n_y, n_x), bounded by mu times the point's normal impulse, and is solved after
// the normals: a pyramid of 100 rows leans by 0.5 m while it settles, with friction first by 2 m.
//
// Where what slides bears less than what sticks, the relaxing sweep decides for each contact which of the two it is; it is one
// for both points, which slide alike.
//
// The two points of a contact are one 2x2 block, solved exactly: of the four cases (both push, one of
// them, none) the one is taken that leaves no point approaching and no impulse pulling.
//
// Symbols: ran = r_A x n, rat = r_A x t; kn inverse effective mass; ln, lt accumulated impulses.
// Cost: per bundle two gathers of W body rows, about 150 flops, one scatter.
#include "narrow/surface.h"
#include "schema/effects.h"
#include "solver/bundle.h"

// [m] gap from which on a contact is rigid; it gives as its spring where bodies touch. DECISIONS.md: what jumps at 0 is decided by
// rounding.
#define RIGID_FROM ((near_real)1e-5)

WIDE_INLINE void push_normal(const bundle *c, const point *p, body *a, body *b, vf impulse,
                             bool rotation)
{
    vf px = c->nx * impulse;
    vf py = c->ny * impulse;
    a->vx -= a->inv_mass * px;
    a->vy -= a->inv_mass * py;
    b->vx += b->inv_mass * px;
    b->vy += b->inv_mass * py;
    if (rotation) {
        a->w -= a->inv_inertia * (p->ran * impulse);
        b->w += b->inv_inertia * (p->rbn * impulse);
    }
}

WIDE_INLINE void warm_start_all(const pl_contact_call *call, uint32_t first, uint32_t count,
                                bool friction, bool rotation, bool running, bool special_ones)
{
    bundle *bundles = call->bundles;
    const extra *extras = call->extras;
    const special *specials = call->specials;
    for (uint32_t k = first; k < first + count; ++k) {
        bundle *c = &bundles[k];
        body a, b;
        gather_body(&a, call, c->a);
        gather_body(&b, call, c->b);
        for (int j = 0; j < 2; ++j) {
            if (friction) {
                push(c, special_ones ? &specials[k] : NULL, &c->p[j], &a, &b, c->p[j].ln,
                     c->p[j].lt, rotation);
            } else {
                push_normal(c, &c->p[j], &a, &b, c->p[j].ln, rotation);
            }
        }
        if (running && rotation) {
            push_turn(&a, &b, extras[k].lr);
        }
        scatter_velocity(&a, call, c->a);
        scatter_velocity(&b, call, c->b);
    }
}

WIDE_INLINE vf separation_now(const bundle *c, const point *p, const body *a, const body *b)
{
    return p->separation + c->nx * (b->dx - a->dx) + c->ny * (b->dy - a->dy) + p->rbn * b->da -
           p->ran * a->da;
}

// What a special contact is in this substep: only points within reach pull.
WIDE_INLINE special special_now(const special *s, const bundle *c, const body *a, const body *b)
{
    special now = *s;
    for (int j = 0; j < 2; ++j) {
        vm near = separation_now(c, &c->p[j], a, b) < s->reach;
        now.pull[j] = sel(near, s->pull[j], splat(0));
    }
    return now;
}

// The speed that point p lacks to be where it should be, its diagonal with the spring's give, and the speed that
// it has.
WIDE_INLINE vf shortfall(const bundle *c, const point *p, const body *a, const body *b,
                         const pl_contact_call *call, bool soft, bool rotation, vf *diagonal,
                         vf *speed, vf *apart_by)
{
    vf zero = splat(0);
    vf s = p->separation + c->nx * (b->dx - a->dx) + c->ny * (b->dy - a->dy);
    vf vn = c->nx * (b->vx - a->vx) + c->ny * (b->vy - a->vy);
    if (rotation) {
        s += p->rbn * b->da - p->ran * a->da;
        vn += p->rbn * b->w - p->ran * a->w;
    }
    *speed = vn;
    *apart_by = s;
    *diagonal = p->kn;
    if (soft) {
        const vm apart = s > zero;
        const vf rigid = vclamp(s * splat(1 / RIGID_FROM), zero, splat(1));
        *diagonal += (splat(1) - rigid) * p->give;
        return vn +
               sel(apart, s * splat(call->inv_h), vmax(s * c->bias_rate, splat(-call->push_speed)));
    }
    return vn + vmax(s, zero) * splat(call->inv_h);
}

// What the forces of the substep made of the velocities of both bodies, before anything else pushed them.
WIDE_PART void velocities_before(const bundle *c, const pl_contact_call *call, body *a, body *b)
{
    body *of[2] = { a, b };
    const uint32_t *places[2] = { c->a, c->b };
    for (int k = 0; k < 2; ++k) {
        const near_real *row[PL_WIDTH];
        for (int i = 0; i < PL_WIDTH; ++i) {
            row[i] = &call->motions[slot_at(places[k][i])].ux;
        }
        vf r[4];
        gather4(r, row, 0);
        of[k]->vx = r[0], of[k]->vy = r[1], of[k]->w = r[2];
    }
}

// A point that bore nothing and pushes now has been struck, at the speed that it had when the substep began: another contact of the
// body may have turned it since (DECISIONS.md). Or at the speed that it has now, where another threw it at this one. So has, in
// the first sweep of a step, one that bears more than in the step before.
WIDE_PART void note_strikes(extra *e, const bundle *c, const pl_contact_call *call,
                            const vm struck[2], const vf speed[2], const vf gap[2])
{
    body a, b;
    velocities_before(c, call, &a, &b);
    const vf along = c->nx * (b.vx - a.vx) + c->ny * (b.vy - a.vy);
    for (int j = 0; j < 2; ++j) {
        const vf before = along + c->p[j].rbn * b.w - c->p[j].ran * a.w;
        const vf v = sel(struck[j], vmax(-speed[j], -before), e->struck);
        const vf way = vmax(gap[j], splat(0));
        const vm faster = v > e->struck;
        const vf time = splat(call->since) + vmin(way / sel(faster, v, splat(1)), splat(call->h));
        e->struck = sel(faster, v, e->struck);
        e->struck_at = sel(faster, time, e->struck_at);
    }
}

// `e` not null: notes who is struck.
WIDE_INLINE void solve_normals(const bundle *c, const special *s, extra *e, point p[2], body *a,
                               body *b, const pl_contact_call *call, bool soft, bool rotation)
{
    vf zero = splat(0), one = splat(1);
    vf d0, d1, v0, v1, s0, s1;
    vf lack0 = shortfall(c, &p[0], a, b, call, soft, rotation, &d0, &v0, &s0);
    vf lack1 = shortfall(c, &p[1], a, b, call, soft, rotation, &d1, &v1, &s1);
    vf k01 = c->k01;
    vf old0 = p[0].ln, old1 = p[1].ln;
    if (s != NULL) {
        old0 += s->pull[0];
        old1 += s->pull[1];
    }
    vf b0 = p[0].kn * old0 + k01 * old1 - lack0;
    vf b1 = k01 * old0 + p[1].kn * old1 - lack1;
    vf det = d0 * d1 - k01 * k01;
    vm regular = det > splat((near_real)1e-3) * d0 * d1;
    vf inv = one / sel(regular, det, one);
    vf both0 = (d1 * b0 - k01 * b1) * inv;
    vf both1 = (d0 * b1 - k01 * b0) * inv;
    vm both = regular & (both0 >= zero) & (both1 >= zero);
    vf only0 = vmax(b0 / sel(d0 > zero, d0, one), zero);
    vf only1 = vmax(b1 / sel(d1 > zero, d1, one), zero);
    vm first = k01 * only0 >= b1;
    vf total0 = sel(both, both0, sel(first, only0, zero));
    vf total1 = sel(both, both1, sel(first, zero, only1));
    if (s != NULL) { // nothing can push two immovable bodies
        total0 = sel(d0 > zero, total0, s->pull[0]);
        total1 = sel(d1 > zero, total1, s->pull[1]);
    }
    vf impulse0 = total0 - old0;
    vf impulse1 = total1 - old1;
    if (e != NULL) {
        const vf unloaded = splat(call->unloaded);
        const vm struck0 = (p[0].ln <= unloaded) & (impulse0 > zero) & (-v0 > e->struck);
        const vm struck1 = (p[1].ln <= unloaded) & (impulse1 > zero) & (-v1 > e->struck);
        if (any(struck0 | struck1)) {
            note_strikes(e, c, call, (vm[2]){ struck0, struck1 }, (vf[2]){ v0, v1 },
                         (vf[2]){ s0, s1 });
        }
    }
    p[0].ln = s != NULL ? (vf)(total0 - s->pull[0]) : total0;
    p[1].ln = s != NULL ? (vf)(total1 - s->pull[1]) : total1;
    vf px = c->nx * (impulse0 + impulse1);
    vf py = c->ny * (impulse0 + impulse1);
    shove(a, b, s, px, py);
    if (rotation) {
        a->w -= a->inv_inertia * (p[0].ran * impulse0 + p[1].ran * impulse1);
        b->w += b->inv_inertia * (p[0].rbn * impulse0 + p[1].rbn * impulse1);
    }
}

WIDE_INLINE void solve_rolling(const bundle *c, const special *s, extra *e, body *a, body *b)
{
    vf load = c->p[0].ln + c->p[1].ln;
    if (s != NULL) {
        load += s->pull[0] + s->pull[1];
    }
    vf bound = e->rolling * load;
    vf total = vclamp(e->lr - e->mr * (b->w - a->w), -bound, bound);
    push_turn(a, b, total - e->lr);
    e->lr = total;
}

// The points rub by `total` from now on, in the shares of `r`.
WIDE_INLINE void set_friction(vf total, const friction_row *r, const bundle *c, const special *s,
                              point p[2], body *a, body *b, bool rotation)
{
    const vf change = total - (p[0].lt + p[1].lt);
    shove(a, b, s, -c->ny * change, c->nx * change);
    if (rotation) {
        a->w -= a->inv_inertia * (r->rat * total - (p[0].rat * p[0].lt + p[1].rat * p[1].lt));
        b->w += b->inv_inertia * (r->rbt * total - (p[0].rbt * p[0].lt + p[1].rbt * p[1].lt));
    }
    p[1].lt = r->share * total;
    p[0].lt = total - p[1].lt;
}

// What starts to slide rubs by `total` from now on. Setting the others to what they have would move them by a rounding.
WIDE_INLINE void slip_off(bundle *c, const special *s, const friction_row *r, vm starts, vf total,
                          body *a, body *b, bool rotation)
{
    const body a_was = *a, b_was = *b;
    const vf was[2] = { c->p[0].lt, c->p[1].lt };
    set_friction(total, r, c, s, c->p, a, b, rotation);
    for (int j = 0; j < 2; ++j) {
        c->p[j].lt = sel(starts, c->p[j].lt, was[j]);
    }
    a->vx = sel(starts, a->vx, a_was.vx), b->vx = sel(starts, b->vx, b_was.vx);
    a->vy = sel(starts, a->vy, a_was.vy), b->vy = sel(starts, b->vy, b_was.vy);
    a->w = sel(starts, a->w, a_was.w), b->w = sel(starts, b->w, b_was.w);
}

// What the contact bears from now on. It slides where its points do not hold; what slides since this sweep bears less at once.
// What bears nothing will stick if it is slow.
WIDE_INLINE void settle_grip(bundle *c, const special *s, const extra *e, const grip *g,
                             const friction_row *r, vf total, vf load, body *a, body *b,
                             bool rotation)
{
    const vm loaded = load > splat(0);
    const vm slow = vabs(slip_at(c, e, r, a, b, rotation)) <= splat(PL_SLIDES_FROM);
    const vm slides = selm(loaded, vabs(total) >= c->friction * load, ~slow);
    const vm starts = loaded & slides & (c->friction > g->slides);
    c->friction = sel(slides, g->slides, g->sticks);
    if (any(starts)) {
        const vf most = c->friction * load;
        slip_off(c, s, r, starts, vclamp(total, -most, most), a, b, rotation);
    }
}

// `g` null: slides as it holds.
WIDE_INLINE void solve_friction(bundle *c, const special *s, const extra *e, const grip *g, body *a,
                                body *b, bool rotation)
{
    point *p = c->p;
    vf load0 = p[0].ln, load1 = p[1].ln;
    if (s != NULL) {
        load0 += s->pull[0];
        load1 += s->pull[1];
    }
    const friction_row r = friction_row_of(p, load0, load1);
    const vf load = load0 + load1, bound = c->friction * load;
    const vf wish = p[0].lt + p[1].lt - r.mt * slip_at(c, e, &r, a, b, rotation);
    const vf total = vclamp(wish, -bound, bound);
    set_friction(total, &r, c, s, p, a, b, rotation);
    if (g != NULL) {
        settle_grip(c, s, e, g, &r, total, load, a, b, rotation);
    }
}

WIDE_INLINE void sweep(const pl_contact_call *call, uint32_t first, uint32_t count, bool soft,
                       bool friction, bool rotation, bool running, bool special_ones, bool telling)
{
    bundle *bundles = call->bundles;
    extra *extras = call->extras;
    const special *specials = call->specials;
    for (uint32_t k = first; k < first + count; ++k) {
        bundle *c = &bundles[k];
        body a, b;
        gather_body(&a, call, c->a);
        gather_body(&b, call, c->b);
        special now;
        if (special_ones) {
            now = special_now(&specials[k], c, &a, &b);
        }
        const special *s = special_ones ? &now : NULL;
        solve_normals(c, s, telling ? &extras[k] : NULL, c->p, &a, &b, call, soft, rotation);
        if (!soft) {
            c->pushed = vmax(c->pushed, vmax(c->p[0].ln, c->p[1].ln));
        }
        if (friction) {
            extra *e = running ? &extras[k] : NULL;
            if (running && rotation) {
                solve_rolling(c, s, e, &a, &b);
            }
            const grip *g = NULL;
            if (special_ones && !soft && call->grips != NULL) {
                g = (const grip *)call->grips + k;
            }
            solve_friction(c, s, e, g, &a, &b, rotation);
        }
        scatter_velocity(&a, call, c->a);
        scatter_velocity(&b, call, c->b);
    }
}

// The variants: friction F, rotation R, running surfaces S, locked axes, adhesion and kinetic friction X, hits told T. Names that are
// put together carry the width (tools/amalgamate cannot see them).
#define DEFINE_SWEEPS(F, R, S, X, T)                                                               \
    static void PL_WIDE_NAME(solve_##F##R##S##X##T)(const pl_contact_call *call, uint32_t first,   \
                                                    uint32_t count)                                \
    {                                                                                              \
        sweep(call, first, count, true, F, R, S, X, T);                                            \
    }                                                                                              \
    static void PL_WIDE_NAME(relax_##F##R##S##X##T)(const pl_contact_call *call, uint32_t first,   \
                                                    uint32_t count)                                \
    {                                                                                              \
        sweep(call, first, count, false, F, R, S, X, T);                                           \
    }

#define DEFINE_WARM_START(F, R, S, X)                                                              \
    static void PL_WIDE_NAME(warm_start_##F##R##S##X)(const pl_contact_call *call, uint32_t first, \
                                                      uint32_t count)                              \
    {                                                                                              \
        warm_start_all(call, first, count, F, R, S, X);                                            \
    }

// clang-format off
#define DEFINE_STRAIGHT(F, S)   DEFINE_WARM_START(F, 0, S, 0) DEFINE_SWEEPS(F, 0, S, 0, 0)
#define DEFINE_TURNING(F, S, X) DEFINE_WARM_START(F, 1, S, X) DEFINE_SWEEPS(F, 1, S, X, 0) DEFINE_SWEEPS(F, 1, S, X, 1)

DEFINE_STRAIGHT(0, 0)
DEFINE_TURNING(0, 0, 0)
DEFINE_TURNING(1, 1, 1)
#if PL_HAS(FRICTION)
DEFINE_STRAIGHT(1, 0)
DEFINE_STRAIGHT(1, 1)
DEFINE_TURNING(1, 0, 0)
DEFINE_TURNING(1, 1, 0)
#define ROUGH(with, without) PL_WIDE_NAME(with)
#else
#define ROUGH(with, without) PL_WIDE_NAME(without)
#endif

// In the order of pl_motion_variant.
#define SWEEPS(name)                                                                               \
    { { PL_WIDE_NAME(name##_00000), PL_WIDE_NAME(name##_01000), PL_WIDE_NAME(name##_01001) },      \
      { ROUGH(name##_10000, name##_00000), ROUGH(name##_11000, name##_01000), ROUGH(name##_11001, name##_01001) }, \
      { ROUGH(name##_10100, name##_00000), ROUGH(name##_11100, name##_01000), ROUGH(name##_11101, name##_01001) }, \
      { PL_WIDE_NAME(name##_11110), PL_WIDE_NAME(name##_11110), PL_WIDE_NAME(name##_11111) } }
#define WARM_STARTS                                                                                \
    { { PL_WIDE_NAME(warm_start_0000), PL_WIDE_NAME(warm_start_0100), PL_WIDE_NAME(warm_start_0100) }, \
      { ROUGH(warm_start_1000, warm_start_0000), ROUGH(warm_start_1100, warm_start_0100), ROUGH(warm_start_1100, warm_start_0100) }, \
      { ROUGH(warm_start_1010, warm_start_0000), ROUGH(warm_start_1110, warm_start_0100), ROUGH(warm_start_1110, warm_start_0100) }, \
      { PL_WIDE_NAME(warm_start_1111), PL_WIDE_NAME(warm_start_1111), PL_WIDE_NAME(warm_start_1111) } }
// clang-format on

const pl_contact_kernels PL_WIDE_NAME(pl_contact_kernels) = {
    .width = PL_WIDTH,
    .bundle_size = sizeof(bundle),
    .separation_offset = { offsetof(bundle, p[0].separation), offsetof(bundle, p[1].separation) },
    .impulse_offset = { offsetof(bundle, p[0].ln), offsetof(bundle, p[1].ln) },
    .prepare = PL_WIDE_NAME(pl_contact_prepare),
    .prepare_fine = PL_WIDE_NAME(pl_contact_prepare_fine),
    .close_fine = PL_WIDE_NAME(pl_contact_close_fine),
    .warm_start = WARM_STARTS,
    .solve = SWEEPS(solve),
    .relax = SWEEPS(relax),
    .store = PL_WIDE_NAME(pl_contact_store),
    .extra_size = sizeof(extra),
    .prepare_extras = PL_WIDE_NAME(pl_contact_prepare_extras),
    .special_size = sizeof(special),
    .prepare_specials = PL_WIDE_NAME(pl_contact_prepare_specials),
    .bounce_size = sizeof(bounce),
    .prepare_bounces = PL_WIDE_NAME(pl_contact_prepare_bounces),
    .bounce = PL_WIDE_NAME(pl_contact_bounce),
    .bounce_special = PL_WIDE_NAME(pl_contact_bounce_special),
    .store_bounces = PL_WIDE_NAME(pl_contact_store_bounces),
    .turning_size = sizeof(turning),
    .grip_size = sizeof(grip),
    .prepare_grips = PL_WIDE_NAME(pl_contact_prepare_grips),
    .store_grips = PL_WIDE_NAME(pl_contact_store_grips),
    .prepare_moment = PL_WIDE_NAME(pl_contact_prepare_moment),
    .open_moment = PL_WIDE_NAME(pl_contact_open_moment),
    .follow_moment = PL_WIDE_NAME(pl_contact_follow_moment),
    .halve = PL_WIDE_NAME(pl_bodies_halve),
    .drift = PL_WIDE_NAME(pl_bodies_drift),
    .place = PL_WIDE_NAME(pl_bodies_place),
    .tally = PL_WIDE_NAME(pl_contact_tally),
    .store_extras = PL_WIDE_NAME(pl_contact_store_extras),
    .measure = PL_WIDE_NAME(pl_contact_measure),
    .residual = PL_WIDE_NAME(pl_contact_residual),
};
