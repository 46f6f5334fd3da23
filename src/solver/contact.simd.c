// contact.simd.c - soft contact constraints of W pairs at a time: prepare, warm start, solve,
// relax, store.
//
// A contact point holds n . (v_B + w_B x r_B - v_A - w_A x r_A) >= 0 by an impulse >= 0. With
// anchors frozen over the step its separation after the bodies moved by (d, a) is
//     s = s0 + n . (d_B - d_A) + a_B (r_B x n) - a_A (r_A x n).
// Apart (s > 0), the point may approach by s within the substep; overlapping, it is pushed apart
// like a damped spring of frequency w and damping ratio z, integrated implicitly (Catto, Soft
// Constraints, GDC 2011): with a1 = 2 z + h w, a2 = h w a1, a3 = 1 / (1 + a2),
//     bias = w / a1 s,  impulse change = -a2 a3 m (v_n + bias) - a3 lambda.
// Relaxing is the same without spring: it takes the push out of the velocities again.
//
// Friction acts along t = (-n_y, n_x), bounded by mu times the point's normal impulse, and is solved after
// the normals: a pyramid of 100 rows leans by 0.5 m while it settles, with friction first by 2 m.
//
// The two points of a contact are one 2x2 block, solved exactly: of the four cases (both push, one of
// them, none) the one is taken that leaves no point approaching and no impulse pulling.
//
// Symbols: ran = r_A x n, rat = r_A x t; kn inverse effective mass; ln, lt accumulated impulses.
// Cost: per bundle two gathers of W body rows, about 150 flops, one scatter.
#include "solver/bundle.h"

// What only running surfaces and counted impulses need, apart from the bundle, so that others do
// not read it. Rolling resistance: a torque between the bodies that opposes their relative turning,
// at most f times the normal impulse of the contact; like friction it acts in the relaxing sweeps.
typedef struct extra {
    vf surface_speed; // [m/s]
    vf rolling;       // [m]
    vf mr;            // [kg m^2] effective inertia
    vf lr;            // [N m s]
    vf total[2];      // [N s] normal impulses of the substeps so far
    vf struck;        // [m/s] fastest at which a point was struck in this step
} extra;

// What only locked axes, bodies whose time stands still and surfaces that stick need. A body locked along an axis has infinite mass
// that way. A point that sticks may pull while it is nearer than its reach: its impulse is at least
// -pull, and so l + pull is what is never negative, what friction goes by, and what the springs carry.
typedef struct special {
    vf aix, aiy, bix, biy; // [1/kg] inverse masses along the axes
    vf pull[2];            // [N s]
    vf reach;              // [m]
} special;

typedef struct body {
    vf vx, vy, w, inv_mass, dx, dy, da, inv_inertia;
} body;

WIDE_INLINE void gather_body(body *out, const pl_contact_call *call, const uint32_t *slot)
{
    const near_real *row[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        row[i] = &call->bodies[slot[i]].vx;
    }
    vf r[8];
    gather8(r, row);
    *out = (body){ r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7] };
}

// Writes velocities back; lanes of immovable bodies write to a sink, for others share those rows.
WIDE_INLINE void scatter_velocity(const body *in, const pl_contact_call *call, const uint32_t *slot)
{
    near_real sink[4] __attribute__((aligned(32)));
    near_real *row[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        row[i] = slot[i] < call->dynamic_slots ? &call->bodies[slot[i]].vx : sink;
    }
    scatter4(row, 0, (vf[4]){ in->vx, in->vy, in->w, in->inv_mass });
}

WIDE_INLINE vf inverse_or_zero(vf k)
{
    vm positive = k > splat(0);
    return sel(positive, splat(1) / sel(positive, k, splat(1)), splat(0));
}

WIDE_INLINE void prepare_point(point *p, const vf row[8], const bundle *c, const body *a,
                               const body *b)
{
    vf ax = row[0], ay = row[1], bx = row[2], by = row[3];
    p->ran = ax * c->ny - ay * c->nx;
    p->rbn = bx * c->ny - by * c->nx;
    p->rat = ax * c->nx + ay * c->ny; // r x t with t = (-ny, nx)
    p->rbt = bx * c->nx + by * c->ny;
    p->separation = row[4];
    vf mass = a->inv_mass + b->inv_mass;
    p->kn = mass + a->inv_inertia * p->ran * p->ran + b->inv_inertia * p->rbn * p->rbn;
    p->mt =
        inverse_or_zero(mass + a->inv_inertia * p->rat * p->rat + b->inv_inertia * p->rbt * p->rbt);
    p->ln = row[5];
    p->lt = row[6];
}

// Contacts with immovable bodies are so many times stiffer: what carries a pile yields last, and no
// mass ratio can make them unstable.
#define STATIC_STIFFNESS ((near_real)2)

typedef struct softness {
    vf bias_rate, give;
} softness;

// Numbers of a soft contact of `factor` times the call's frequency; formulas on top.
WIDE_INLINE softness soften(const pl_contact_call *call, near_real factor)
{
    near_real omega = (near_real)6.283185307179586 * call->hertz * factor;
    near_real a1 = 2 * call->damping + call->h * omega;
    near_real a2 = call->h * omega * a1;
    return (softness){ splat(omega / a1), splat(1 / a2) };
}

// A point deeper than the push may undo in a second is pushed less than its spring would. It gives
// way less by the same share, or the spring would bear no more than the push speed stands for: a
// point below a heavy pile would sink for ever.
WIDE_INLINE vf held_back(const bundle *c, const point *p, const pl_contact_call *call)
{
    vf limit = splat(call->push_speed);
    return limit / vmax(-p->separation * c->bias_rate, limit);
}

// An empty lane: no mass, no impulse, out of reach.
static const pl_manifold empty_manifold __attribute__((
    aligned(64))) = { .point = { { .separation = PL_APART }, { .separation = PL_APART } } };

static void prepare(const pl_contact_call *call, uint32_t first, uint32_t count)
{
    bundle *bundles = call->bundles;
    const softness pair = soften(call, 1), ground = soften(call, STATIC_STIFFNESS);
    for (uint32_t k = first; k < first + count; ++k) {
        bundle *c = &bundles[k];
        const near_real *row[3][PL_WIDTH];
        for (int i = 0; i < PL_WIDTH && k + 2 < first + count; ++i) {
            uint32_t at = call->lanes[(size_t)(k + 2) * PL_WIDTH + (size_t)i];
            if (at != PL_NONE) {
                __builtin_prefetch(&call->manifolds[at]);
                __builtin_prefetch(&call->manifolds[at].point[1]);
            }
        }
        for (int i = 0; i < PL_WIDTH; ++i) {
            uint32_t at = call->lanes[(size_t)k * PL_WIDTH + (size_t)i];
            const pl_manifold *m = at == PL_NONE ? &empty_manifold : &call->manifolds[at];
            c->a[i] = c->b[i] = call->immovable_slot;
            if (at != PL_NONE && m->body_a < call->movable_rows) {
                c->a[i] = call->slots[m->body_a];
            }
            if (at != PL_NONE && m->body_b < call->movable_rows) {
                c->b[i] = call->slots[m->body_b];
            }
            row[0][i] = &m->nx;
            row[1][i] = &m->point[0].ax;
            row[2][i] = &m->point[1].ax;
        }
        body a, b;
        gather_body(&a, call, c->a);
        gather_body(&b, call, c->b);
        vf r[8];
        gather4(r, row[0], 0);
        c->pushed = splat(0);
        c->nx = r[0], c->ny = r[1], c->friction = r[2];
        vm fixed = (a.inv_mass == splat(0)) | (b.inv_mass == splat(0));
        c->bias_rate = sel(fixed, ground.bias_rate, pair.bias_rate);
        vf give = sel(fixed, ground.give, pair.give);
        for (int j = 0; j < 2; ++j) {
            gather8(r, row[1 + j]);
            prepare_point(&c->p[j], r, c, &a, &b);
            c->p[j].give = c->p[j].kn * give * held_back(c, &c->p[j], call);
        }
        c->k01 = a.inv_mass + b.inv_mass + a.inv_inertia * c->p[0].ran * c->p[1].ran +
                 b.inv_inertia * c->p[0].rbn * c->p[1].rbn;
    }
}

static void prepare_extras(const pl_contact_call *call, uint32_t first, uint32_t count)
{
    const bundle *bundles = call->bundles;
    extra *extras = call->extras;
    for (uint32_t k = first; k < first + count; ++k) {
        const bundle *c = &bundles[k];
        extra *e = &extras[k];
        *e = (extra){ .surface_speed = splat(0) };
        body a, b;
        gather_body(&a, call, c->a);
        gather_body(&b, call, c->b);
        e->mr = inverse_or_zero(a.inv_inertia + b.inv_inertia);
        for (int i = 0; i < PL_WIDTH; ++i) {
            uint32_t at = call->lanes[(size_t)k * PL_WIDTH + (size_t)i];
            if (at != PL_NONE) {
                e->surface_speed[i] = call->manifolds[at].surface_speed;
                e->rolling[i] = call->manifolds[at].rolling;
                e->lr[i] = call->pairs[call->manifolds[at].pair].rolling;
            }
        }
        vf bound = e->rolling * (c->p[0].ln + c->p[1].ln);
        e->lr = vclamp(e->lr, -bound, bound);
    }
}

static void prepare_specials(const pl_contact_call *call, uint32_t first, uint32_t count)
{
    const softness pair = soften(call, 1), ground = soften(call, STATIC_STIFFNESS);
    bundle *bundles = call->bundles;
    special *specials = call->specials;
    for (uint32_t k = first; k < first + count; ++k) {
        bundle *c = &bundles[k];
        special *s = &specials[k];
        body a, b;
        gather_body(&a, call, c->a);
        gather_body(&b, call, c->b);
        *s =
            (special){ .aix = a.inv_mass, .aiy = a.inv_mass, .bix = b.inv_mass, .biy = b.inv_mass };
        s->pull[0] = s->pull[1] = s->reach = splat(0);
        for (int i = 0; i < PL_WIDTH; ++i) {
            uint32_t at = call->lanes[(size_t)k * PL_WIDTH + (size_t)i];
            if (at == PL_NONE) {
                continue;
            }
            const pl_manifold *m = &call->manifolds[at];
            uint32_t fa = call->flags[m->body_a], fb = call->flags[m->body_b];
            s->aix[i] = (fa & PL_BODY_LOCK_X) != 0 ? 0 : s->aix[i];
            s->aiy[i] = (fa & PL_BODY_LOCK_Y) != 0 ? 0 : s->aiy[i];
            s->bix[i] = (fb & PL_BODY_LOCK_X) != 0 ? 0 : s->bix[i];
            s->biy[i] = (fb & PL_BODY_LOCK_Y) != 0 ? 0 : s->biy[i];
            s->reach[i] = pl_adhesion_reach(call->pairs[m->pair].flags);
            for (uint32_t j = 0; j < m->count; ++j) {
                s->pull[j][i] = m->adhesion * call->h / (near_real)m->count;
            }
        }
        vf nxx = c->nx * c->nx, nyy = c->ny * c->ny;
        vf mass_a = s->aix * nxx + s->aiy * nyy, mass_b = s->bix * nxx + s->biy * nyy;
        vf mass_n = mass_a + mass_b, mass_t = (s->aix + s->bix) * nyy + (s->aiy + s->biy) * nxx;
        for (int j = 0; j < 2; ++j) {
            point *p = &c->p[j];
            p->kn = mass_n + a.inv_inertia * p->ran * p->ran + b.inv_inertia * p->rbn * p->rbn;
            p->mt = inverse_or_zero(mass_t + a.inv_inertia * p->rat * p->rat +
                                    b.inv_inertia * p->rbt * p->rbt);
        }
        c->k01 = mass_n + a.inv_inertia * c->p[0].ran * c->p[1].ran +
                 b.inv_inertia * c->p[0].rbn * c->p[1].rbn;
        vm fixed = ((mass_a == splat(0)) & (a.inv_inertia == splat(0))) |
                   ((mass_b == splat(0)) & (b.inv_inertia == splat(0)));
        c->bias_rate = sel(fixed, ground.bias_rate, pair.bias_rate);
        vf give = sel(fixed, ground.give, pair.give);
        for (int j = 0; j < 2; ++j) {
            c->p[j].give = c->p[j].kn * give * held_back(c, &c->p[j], call);
        }
    }
}

// Adds an impulse (px, py) to B and takes it from A; `s` null: no axis is locked.
WIDE_INLINE void shove(body *a, body *b, const special *s, vf px, vf py)
{
    a->vx -= (s != NULL ? s->aix : a->inv_mass) * px;
    a->vy -= (s != NULL ? s->aiy : a->inv_mass) * py;
    b->vx += (s != NULL ? s->bix : b->inv_mass) * px;
    b->vy += (s != NULL ? s->biy : b->inv_mass) * py;
}

WIDE_INLINE void push_turn(body *a, body *b, vf impulse)
{
    a->w -= a->inv_inertia * impulse;
    b->w += b->inv_inertia * impulse;
}

// Adds the impulses (along n and t) of a point to both bodies.
WIDE_INLINE void push(const bundle *c, const special *s, const point *p, body *a, body *b,
                      vf along_n, vf along_t, bool rotation)
{
    vf px = c->nx * along_n - c->ny * along_t;
    vf py = c->ny * along_n + c->nx * along_t;
    shove(a, b, s, px, py);
    if (rotation) {
        a->w -= a->inv_inertia * (p->ran * along_n + p->rat * along_t);
        b->w += b->inv_inertia * (p->rbn * along_n + p->rbt * along_t);
    }
}

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

WIDE_INLINE void push_tangent(const bundle *c, const special *s, const point *p, body *a, body *b,
                              vf impulse, bool rotation)
{
    vf px = -c->ny * impulse;
    vf py = c->nx * impulse;
    shove(a, b, s, px, py);
    if (rotation) {
        a->w -= a->inv_inertia * (p->rat * impulse);
        b->w += b->inv_inertia * (p->rbt * impulse);
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
                         vf *speed)
{
    vf zero = splat(0);
    vf s = p->separation + c->nx * (b->dx - a->dx) + c->ny * (b->dy - a->dy);
    vf vn = c->nx * (b->vx - a->vx) + c->ny * (b->vy - a->vy);
    if (rotation) {
        s += p->rbn * b->da - p->ran * a->da;
        vn += p->rbn * b->w - p->ran * a->w;
    }
    vm apart = s > zero;
    *speed = vn;
    *diagonal = p->kn;
    if (soft) {
        *diagonal += sel(apart, zero, p->give);
        return vn +
               sel(apart, s * splat(call->inv_h), vmax(s * c->bias_rate, splat(-call->push_speed)));
    }
    return vn + sel(apart, s * splat(call->inv_h), zero);
}

// A point that bore nothing and pushes now has been struck, at the speed v [m/s] that it had; so has, in the first
// sweep of a step, one that bears more than in the step before.
WIDE_INLINE void note_strike(extra *e, const pl_contact_call *call, vf load, vf impulse, vf v)
{
    vm struck = (load <= splat(call->unloaded)) & (impulse > splat(0));
    e->struck = vmax(e->struck, sel(struck, -v, splat(0)));
}

// `e` not null: notes who is struck.
WIDE_INLINE void solve_normals(const bundle *c, const special *s, extra *e, point p[2], body *a,
                               body *b, const pl_contact_call *call, bool soft, bool rotation)
{
    vf zero = splat(0), one = splat(1);
    vf d0, d1, v0, v1;
    vf lack0 = shortfall(c, &p[0], a, b, call, soft, rotation, &d0, &v0);
    vf lack1 = shortfall(c, &p[1], a, b, call, soft, rotation, &d1, &v1);
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
        note_strike(e, call, p[0].ln, impulse0, v0);
        note_strike(e, call, p[1].ln, impulse1, v1);
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

// `e` null: the surfaces move with their bodies.
WIDE_INLINE void solve_tangent(const bundle *c, const special *s, const extra *e, int j, point *p,
                               body *a, body *b, bool rotation)
{
    vf vt = c->nx * (b->vy - a->vy) - c->ny * (b->vx - a->vx);
    if (e != NULL) {
        vt += e->surface_speed;
    }
    if (rotation) {
        vt += p->rbt * b->w - p->rat * a->w;
    }
    vf bound = c->friction * (s != NULL ? (vf)(p->ln + s->pull[j]) : p->ln);
    vf total = vclamp(p->lt - p->mt * vt, -bound, bound);
    vf impulse = total - p->lt;
    p->lt = total;
    push_tangent(c, s, p, a, b, impulse, rotation);
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
            solve_tangent(c, s, e, 0, &c->p[0], &a, &b, rotation);
            solve_tangent(c, s, e, 1, &c->p[1], &a, &b, rotation);
        }
        scatter_velocity(&a, call, c->a);
        scatter_velocity(&b, call, c->b);
    }
}

// Events have to know of what pushed in an earlier substep alone; the others are told by their impulses.
WIDE_INLINE void note_early(const pl_contact_call *call, const bundle *c, const uint32_t *lanes)
{
    const vf zero = splat(0);
    vm early = (c->pushed > zero) & (c->p[0].ln <= zero) & (c->p[1].ln <= zero);
    for (int i = 0; i < PL_WIDTH && any(early); ++i) {
        if (early[i] && lanes[i] != PL_NONE) {
            call->manifolds[lanes[i]].met |= PL_MET_ACTED;
        }
    }
}

static void store_impulses(const pl_contact_call *call, uint32_t first, uint32_t count)
{
    const bundle *bundles = call->bundles;
    for (uint32_t k = first; k < first + count; ++k) {
        const bundle *c = &bundles[k];
        note_early(call, c, &call->lanes[(size_t)k * PL_WIDTH]);
        for (int i = 0; i < PL_WIDTH && k + 1 < first + count; ++i) {
            uint32_t at = call->lanes[(size_t)(k + 1) * PL_WIDTH + (size_t)i];
            if (at != PL_NONE) {
                __builtin_prefetch(&call->pairs[call->manifolds[at].pair], 1);
            }
        }
        for (int i = 0; i < PL_WIDTH; ++i) {
            uint32_t at = call->lanes[(size_t)k * PL_WIDTH + (size_t)i];
            if (at != PL_NONE) {
                pl_pair *pair = &call->pairs[call->manifolds[at].pair];
                for (int j = 0; j < 2; ++j) {
                    pair->normal[j] = c->p[j].ln[i];
                    pair->tangent[j] = c->p[j].lt[i];
                }
            }
        }
    }
}

static void tally(const pl_contact_call *call, uint32_t first, uint32_t count)
{
    const bundle *bundles = call->bundles;
    extra *extras = call->extras;
    for (uint32_t k = first; k < first + count; ++k) {
        extras[k].total[0] += bundles[k].p[0].ln;
        extras[k].total[1] += bundles[k].p[1].ln;
    }
}

static void store_extras(const pl_contact_call *call, uint32_t first, uint32_t count)
{
    const extra *extras = call->extras;
    for (uint32_t k = first; k < first + count; ++k) {
        for (int i = 0; i < PL_WIDTH; ++i) {
            uint32_t at = call->lanes[(size_t)k * PL_WIDTH + (size_t)i];
            if (at != PL_NONE) {
                pl_manifold *m = &call->manifolds[at];
                call->pairs[m->pair].rolling = extras[k].lr[i];
                m->point[0].total += extras[k].total[0][i];
                m->point[1].total += extras[k].total[1][i];
                if (extras[k].struck[i] > 0) {
                    pl_manifold_strike(m, extras[k].struck[i]);
                }
            }
        }
    }
}

// The variants: friction F, rotation R, running surfaces S, locked axes and adhesion X, hits told T. Names that are
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
DEFINE_STRAIGHT(1, 0)
DEFINE_STRAIGHT(1, 1)
DEFINE_TURNING(0, 0, 0)
DEFINE_TURNING(1, 0, 0)
DEFINE_TURNING(1, 1, 0)
DEFINE_TURNING(1, 1, 1)

// In the order of pl_motion_variant.
#define SWEEPS(name)                                                                               \
    { { PL_WIDE_NAME(name##_00000), PL_WIDE_NAME(name##_01000), PL_WIDE_NAME(name##_01001) },      \
      { PL_WIDE_NAME(name##_10000), PL_WIDE_NAME(name##_11000), PL_WIDE_NAME(name##_11001) },      \
      { PL_WIDE_NAME(name##_10100), PL_WIDE_NAME(name##_11100), PL_WIDE_NAME(name##_11101) },      \
      { PL_WIDE_NAME(name##_11110), PL_WIDE_NAME(name##_11110), PL_WIDE_NAME(name##_11111) } }
#define WARM_STARTS                                                                                \
    { { PL_WIDE_NAME(warm_start_0000), PL_WIDE_NAME(warm_start_0100), PL_WIDE_NAME(warm_start_0100) }, \
      { PL_WIDE_NAME(warm_start_1000), PL_WIDE_NAME(warm_start_1100), PL_WIDE_NAME(warm_start_1100) }, \
      { PL_WIDE_NAME(warm_start_1010), PL_WIDE_NAME(warm_start_1110), PL_WIDE_NAME(warm_start_1110) }, \
      { PL_WIDE_NAME(warm_start_1111), PL_WIDE_NAME(warm_start_1111), PL_WIDE_NAME(warm_start_1111) } }
// clang-format on

// dull.simd.c
pl_dull_counter PL_WIDE_NAME(pl_dull_prepare);
pl_dull_kernel PL_WIDE_NAME(pl_dull_look), PL_WIDE_NAME(pl_dull_strike);

const pl_contact_kernels PL_WIDE_NAME(pl_contact_kernels) = {
    .width = PL_WIDTH,
    .bundle_size = sizeof(bundle),
    .separation_offset = { offsetof(bundle, p[0].separation), offsetof(bundle, p[1].separation) },
    .impulse_offset = { offsetof(bundle, p[0].ln), offsetof(bundle, p[1].ln) },
    .prepare = prepare,
    .warm_start = WARM_STARTS,
    .solve = SWEEPS(solve),
    .relax = SWEEPS(relax),
    .store = store_impulses,
    .extra_size = sizeof(extra),
    .prepare_extras = prepare_extras,
    .special_size = sizeof(special),
    .prepare_specials = prepare_specials,
    .dull_prepare = PL_WIDE_NAME(pl_dull_prepare),
    .dull_look = PL_WIDE_NAME(pl_dull_look),
    .dull_strike = PL_WIDE_NAME(pl_dull_strike),
    .tally = tally,
    .store_extras = store_extras,
};
