// dull.simd.c - restitution of dull contacts (dull.h), many at a time: the formulas of bounce.c in lanes.
//
// A dull contact strikes once in a substep, so nothing that it does comes back to it, and contacts of one
// colour have no moving body in common: whatever their order, they strike as if one after another. Of
// each colour the prediction first settles most contacts, W at a time; those left open are looked at
// in doubles, four at a time from whatever bundles they lie in, and struck where an impact is due.
//
// Each lane does what bounce.c does to one contact, operation for operation: the bits are the same.
//
// Reads: solver bodies, motions, bundles. Writes: those bodies, the contact kernel's separations, the pairs'
// flags, totals of impulses. Cost: the prediction; 90 instructions an open contact, as many again in fours of
// which one strikes.
#include "solver/prediction.h"

typedef pl_near_quad row; // of a solver body
typedef pl_near_mask row_mask;
typedef double four __attribute__((vector_size(32), PL_REGISTER(16)));
typedef int64_t mask __attribute__((vector_size(32), PL_REGISTER(16)));
typedef uint32_t slots __attribute__((vector_size(16)));

//---- four doubles --------------------------------------------------------------------------------

// GCC 12 makes one instruction of this, and five of __builtin_convertvector.
WIDE_INLINE four widen(row v)
{
    return (four){ v[0], v[1], v[2], v[3] };
}

// Not lane by lane: of what is narrowed and widened so, GCC 12 forgets the rounding.
WIDE_INLINE row narrow(four v)
{
    return __builtin_convertvector(v, row);
}

WIDE_INLINE four all(double v)
{
    return v - (four){ 0 };
}

WIDE_INLINE four choose(mask m, four a, four b)
{
    return (four)((m & (mask)a) | (~m & (mask)b));
}

WIDE_INLINE row choose_row(row_mask m, row a, row b)
{
    return (row)((m & (row_mask)a) | (~m & (row_mask)b));
}

WIDE_INLINE row_mask mask_row(mask m)
{
#if PL_NEAR_IS_DOUBLE
    return m;
#else
    typedef int32_t halves __attribute__((vector_size(32)));
    return __builtin_shufflevector((halves)m, (halves)m, 0, 2, 4, 6);
#endif
}

WIDE_INLINE four root(four v)
{
    return (four){ __builtin_sqrt(v[0]), __builtin_sqrt(v[1]), __builtin_sqrt(v[2]),
                   __builtin_sqrt(v[3]) };
}

WIDE_INLINE bool any_of(mask m)
{
    return (m[0] | m[1] | m[2] | m[3]) != 0;
}

WIDE_INLINE void transpose_rows(row r[4])
{
    row t0 = __builtin_shufflevector(r[0], r[1], 0, 4, 1, 5);
    row t1 = __builtin_shufflevector(r[0], r[1], 2, 6, 3, 7);
    row t2 = __builtin_shufflevector(r[2], r[3], 0, 4, 1, 5);
    row t3 = __builtin_shufflevector(r[2], r[3], 2, 6, 3, 7);
    r[0] = __builtin_shufflevector(t0, t2, 0, 1, 4, 5);
    r[1] = __builtin_shufflevector(t0, t2, 2, 3, 6, 7);
    r[2] = __builtin_shufflevector(t1, t3, 0, 1, 4, 5);
    r[3] = __builtin_shufflevector(t1, t3, 2, 3, 6, 7);
}

//---- four contacts -------------------------------------------------------------------------------

// One body of each.
typedef struct side {
    const uint32_t *slot;
    mask moves; // it is dynamic, and the lane is taken
    row v[4];   // vx vy w inv_mass
    row d[4];   // dx dy da inv_inertia
    row a[4];   // forces: ax ay aw, none
    row u[4];   // ux uy uw inv_mass
    row low[4]; // what rounding took from v; whether it is kept
    row struck; // [s]
} side;

// Contacts in the lanes of bundles; those from `count` on repeat the last one and change nothing.
typedef struct contacts {
    uint32_t lane[4], count;
    near_real *bundles[4]; // each from its lane on: its fields are whole bundles of lanes apart
    uint32_t slot_a[4], slot_b[4];
    mask taken;
    four nx, ny, restitution;
    four ran[2], rbn[2], separation[2];
    mask present[2], unloaded[2];
    four weight; // [m/s^2] of the forces on both bodies
} contacts;

typedef struct approach {
    mask due, clear;
    four speed, time; // [m/s], [s]
} approach;

WIDE_INLINE void gather_rows(row out[4], const near_real *base, size_t stride,
                             const uint32_t slot[4])
{
    for (int i = 0; i < 4; ++i) {
        out[i] = *(const row *)(const void *)(base + stride * slot[i]);
    }
    transpose_rows(out);
}

WIDE_INLINE void gather_side(side *s, const pl_dull_call *call, const uint32_t slot[4], mask taken)
{
    s->slot = slot;
    s->moves = taken & (__builtin_convertvector((slots){ slot[0], slot[1], slot[2], slot[3] },
                                                mask) < (mask){ 0 } + call->dynamic_slots);
    s->struck = (row){ call->struck[slot[0]], call->struck[slot[1]], call->struck[slot[2]],
                       call->struck[slot[3]] };
    gather_rows(s->v, &call->bodies->vx, 8, slot);
    gather_rows(s->d, &call->bodies->dx, 8, slot);
    gather_rows(s->a, &call->motions->ax, 8, slot);
    gather_rows(s->u, &call->motions->ux, 8, slot);
    gather_rows(s->low, call->residuals, 4, slot);
}

// A field of each contact's bundle.
#define OF_BUNDLE(c, i, field) ((c)->bundles[i][offsetof(bundle, field) / sizeof(near_real)])
#define OF_BUNDLES(c, field)                                                                       \
    (row)                                                                                          \
    {                                                                                              \
        OF_BUNDLE(c, 0, field), OF_BUNDLE(c, 1, field), OF_BUNDLE(c, 2, field),                    \
            OF_BUNDLE(c, 3, field)                                                                 \
    }

// One of the fields that dull impacts have.
WIDE_INLINE row dull_field(const contacts *c, const pl_dull_call *call, size_t field)
{
    near_real r[4];
    for (int i = 0; i < 4; ++i) {
        const size_t at = c->lane[i] % PL_WIDTH, first = c->lane[i] - at;
        r[i] = call->fields[first * PL_PREDICTED_FIELDS + field * PL_WIDTH + at];
    }
    return (row){ r[0], r[1], r[2], r[3] };
}

WIDE_INLINE void gather_contacts(contacts *c, const pl_dull_call *call, const uint32_t *lanes,
                                 uint32_t count)
{
    c->count = count;
    for (uint32_t i = 0; i < 4; ++i) {
        c->lane[i] = lanes[i < count ? i : count - 1];
        bundle *of = (bundle *)call->bundles + c->lane[i] / PL_WIDTH;
        const uint32_t at = c->lane[i] % PL_WIDTH;
        c->bundles[i] = (near_real *)(void *)of + at;
        c->slot_a[i] = of->a[at];
        c->slot_b[i] = of->b[at];
    }
    c->taken = (mask){ 0, 1, 2, 3 } < (mask){ 0 } + count;
    c->nx = widen(OF_BUNDLES(c, nx));
    c->ny = widen(OF_BUNDLES(c, ny));
    c->restitution = widen(dull_field(c, call, PL_PREDICTED_RESTITUTION));
    for (int j = 0; j < 2; ++j) {
        c->ran[j] = widen(OF_BUNDLES(c, p[j].ran));
        c->rbn[j] = widen(OF_BUNDLES(c, p[j].rbn));
        c->separation[j] = widen(dull_field(c, call, PL_PREDICTED_SEPARATION(j)));
        c->present[j] = c->separation[j] < all(PL_APART / 2);
        c->unloaded[j] = widen(OF_BUNDLES(c, p[j].ln)) <= all(0);
    }
}

//---- what happens to them ------------------------------------------------------------------------

typedef struct relation {
    four along, a, b; // along the normal, and the turns
} relation;

WIDE_INLINE relation relate(const contacts *c, four ax, four ay, four aw, four bx, four by, four bw)
{
    return (relation){ c->nx * (bx - ax) + c->ny * (by - ay), aw, bw };
}

WIDE_INLINE four at_contact(const contacts *c, int j, const relation *r)
{
    return r->along + c->rbn[j] * r->b - c->ran[j] * r->a;
}

typedef struct view {
    relation place, velocity, force, push;
    four after; // [s]
} view;

WIDE_INLINE void view_contacts(view *o, const contacts *c, const side *a, const side *b)
{
    four va[3], vb[3];
    for (int k = 0; k < 3; ++k) {
        va[k] = widen(a->v[k]) + widen(a->low[k]);
        vb[k] = widen(b->v[k]) + widen(b->low[k]);
    }
    o->place = relate(c, widen(a->d[0]), widen(a->d[1]), widen(a->d[2]), widen(b->d[0]),
                      widen(b->d[1]), widen(b->d[2]));
    o->velocity = relate(c, va[0], va[1], va[2], vb[0], vb[1], vb[2]);
    o->force = relate(c, widen(a->a[0]), widen(a->a[1]), widen(a->a[2]), widen(b->a[0]),
                      widen(b->a[1]), widen(b->a[2]));
    o->push =
        relate(c, widen(a->v[0] - a->u[0]), widen(a->v[1] - a->u[1]), widen(a->v[2] - a->u[2]),
               widen(b->v[0] - b->u[0]), widen(b->v[1] - b->u[1]), widen(b->v[2] - b->u[2]));
    four after_a = widen(a->struck), after_b = widen(b->struck);
    o->after = choose(after_a > after_b, after_a, after_b);
}

typedef struct travel {
    four separation, v, u, acceleration;
    mask clear;
} travel;

// Over the substep, if nothing happens.
WIDE_INLINE travel run_travel(const contacts *c, const view *o, int j, four h)
{
    travel r;
    r.separation = c->separation[j] + at_contact(c, j, &o->place);
    r.v = at_contact(c, j, &o->velocity);
    r.acceleration = at_contact(c, j, &o->force) + at_contact(c, j, &o->push) / h;
    r.u = r.v - h * r.acceleration;
    r.clear = r.separation + h * (r.u + r.v) / all(2) >= all(0);
    return r;
}

WIDE_INLINE approach foresee(const contacts *c, const view *o, int j, const pl_dull_call *call)
{
    const four zero = all(0), h = all((double)call->h);
    const travel r = run_travel(c, o, j, h);
    approach out = { .clear = r.clear };
    four square = r.u * r.u - all(2) * r.acceleration * r.separation;
    mask real_root = square > zero, overlaps = r.separation < zero;
    four speed = choose(real_root, root(choose(real_root, square, zero)), zero);
    four time = all(2) * r.separation / (speed - r.u);
    four fastest = choose(r.v < r.u, -r.v, -r.u);
    mask old = ~real_root | (time < -h) | (speed > fastest);
    speed = choose(old, choose(overlaps, -r.u, fastest), speed);
    time = choose(old, choose(overlaps, zero, r.separation / fastest), time);
    out.speed = speed;
    out.time = choose(time < o->after, o->after, time);
    mask gentle = (speed <= all(call->restitution_speed)) |
                  (~c->unloaded[j] & (speed <= all(4) * c->weight * h));
    four rest = h - out.time;
    mask returns = c->restitution * speed + r.acceleration * rest / all(2) > zero;
    out.due = c->taken & c->present[j] & ~r.clear & (r.u < zero) & ~gentle & returns;
    return out;
}

WIDE_INLINE four length(row x, row y)
{
    four wx = widen(x), wy = widen(y);
    return root(wx * wx + wy * wy);
}

//---- impacts -------------------------------------------------------------------------------------

WIDE_INLINE four coupling(const contacts *c, const side *a, const side *b, int i, int j)
{
    return (widen(a->v[3]) + widen(b->v[3])) * (c->nx * c->nx + c->ny * c->ny) +
           widen(a->d[3]) * c->ran[i] * c->ran[j] + widen(b->d[3]) * c->rbn[i] * c->rbn[j];
}

// Of both points, where an impact is due [N s]; 0 where not.
WIDE_INLINE void find_impulses(four impulse[2], const contacts *c, const side *a, const side *b,
                               const approach at[2])
{
    const four zero = all(0), gain = all(1) + c->restitution;
    four k00 = coupling(c, a, b, 0, 0), k11 = coupling(c, a, b, 1, 1),
         k01 = coupling(c, a, b, 0, 1);
    four r0 = gain * at[0].speed, r1 = gain * at[1].speed;
    four det = k00 * k11 - k01 * k01;
    four i0 = (k11 * r0 - k01 * r1) / det, i1 = (k00 * r1 - k01 * r0) / det;
    // Nearly dependent rows (points close together) are resolved one at a time.
    mask both = at[0].due & at[1].due & (det > all(1e-4) * k00 * k11) & (i0 > zero) & (i1 > zero);
    mask first = at[0].due & (~at[1].due | (at[0].speed >= at[1].speed));
    mask second = at[1].due & ~first;
    impulse[0] = choose(both, i0, choose(first & (k00 > zero), r0 / k00, zero));
    impulse[1] = choose(both, i1, choose(second & (k11 > zero), r1 / k11, zero));
}

// See kick() and strike() in bounce.c.
WIDE_INLINE void strike_side(side *s, mask which, double sign, four px, four py, four turn,
                             four time)
{
    const four im = all(sign) * widen(s->v[3]), ii = all(sign) * widen(s->d[3]);
    const four change[3] = { im * px, im * py, ii * turn };
    which &= s->moves;
    const row_mask m = mask_row(which);
    for (int k = 0; k < 3; ++k) {
        row_mask free = s->u[k] == s->v[k];
        four sum = widen(s->v[k]) + widen(s->low[k]) + change[k];
        row v = narrow(sum);
        s->low[k] = choose_row(m, narrow(sum - widen(v)), s->low[k]);
        s->u[k] = choose_row(m, choose_row(free, v, s->u[k] + narrow(change[k])), s->u[k]);
        s->v[k] = choose_row(m, v, s->v[k]);
        s->d[k] = choose_row(m, s->d[k] - narrow(time * change[k]), s->d[k]);
    }
    s->struck = choose_row(m, narrow(time), s->struck);
}

typedef struct lever {
    four n[2], t[2]; // [m] of A and B, along the normal and the tangent
} lever;

WIDE_INLINE void strike_both(const contacts *c, side *a, side *b, mask which, const lever *arm,
                             four along_n, four along_t, four time)
{
    four px = c->nx * along_n - c->ny * along_t;
    four py = c->ny * along_n + c->nx * along_t;
    strike_side(a, which, -1, px, py, arm->n[0] * along_n + arm->t[0] * along_t, time);
    strike_side(b, which, 1, px, py, arm->n[1] * along_n + arm->t[1] * along_t, time);
}

// What stops the slip, at most mu times the normal impulse.
WIDE_INLINE four friction_impulse(const contacts *c, const side *a, const side *b, const lever *arm,
                                  four surface_speed, four bound)
{
    four slip = c->nx * widen(b->v[1] - a->v[1]) - c->ny * widen(b->v[0] - a->v[0]) +
                arm->t[1] * widen(b->v[2]) - arm->t[0] * widen(a->v[2]) + surface_speed;
    four k = widen(a->v[3]) + widen(b->v[3]) + widen(a->d[3]) * arm->t[0] * arm->t[0] +
             widen(b->d[3]) * arm->t[1] * arm->t[1];
    four impulse = choose(k > all(0), -slip / k, all(0));
    return choose(impulse > bound, bound, choose(impulse < -bound, -bound, impulse));
}

// Tells pairs and manifolds of their impacts; the speed at which their surfaces run on comes back. Most are
// not in the cache, so they are left alone where nothing is to be read or added.
WIDE_INLINE four note_impacts(const contacts *c, const pl_dull_call *call, const four impulse[2],
                              const approach at[2])
{
    near_real surface_speed[4] = { 0 };
    for (uint32_t i = 0; i < c->count; ++i) {
        uint8_t *mark = &call->marks[c->lane[i]];
        if (!(impulse[0][i] > 0 || impulse[1][i] > 0)) {
            continue;
        }
        if ((*mark & PL_DULL_HIT) == 0 || call->looks_up) {
            pl_manifold *m = &call->manifolds[call->lanes[c->lane[i]]];
            surface_speed[i] = m->surface_speed;
            call->pairs[m->pair].flags |= PL_PAIR_HIT;
            for (int j = 0; j < 2; ++j) {
                if (impulse[j][i] > 0) {
                    pl_manifold_strike(m, (near_real)at[j].speed[i]);
                }
            }
            m->point[0].total += call->looks_up ? (near_real)impulse[0][i] : 0;
            m->point[1].total += call->looks_up ? (near_real)impulse[1][i] : 0;
        }
        *mark = PL_DULL_HIT | PL_DULL_STRUCK;
    }
    return widen((row){ surface_speed[0], surface_speed[1], surface_speed[2], surface_speed[3] });
}

WIDE_INLINE void resolve(const contacts *c, side *a, side *b, const approach at[2],
                         const pl_dull_call *call)
{
    four impulse[2];
    lever arm[2];
    find_impulses(impulse, c, a, b, at);
    const four surface_speed = note_impacts(c, call, impulse, at);
    const four mu = widen(OF_BUNDLES(c, friction));
    for (int j = 0; j < 2; ++j) {
        arm[j] = (lever){ .n = { c->ran[j], c->rbn[j] },
                          .t = { widen(OF_BUNDLES(c, p[j].rat)), widen(OF_BUNDLES(c, p[j].rbt)) } };
        if (any_of(impulse[j] > all(0))) {
            strike_both(c, a, b, impulse[j] > all(0), &arm[j], impulse[j], all(0), at[j].time);
        }
    }
    for (int j = 0; j < 2; ++j) {
        const mask rubs = (impulse[j] > all(0)) & (mu > all(0));
        if (any_of(rubs)) {
            four along = friction_impulse(c, a, b, &arm[j], surface_speed, mu * impulse[j]);
            strike_both(c, a, b, rubs, &arm[j], all(0), along, at[j].time);
        }
    }
}

WIDE_INLINE void scatter_side(side *s, const pl_dull_call *call)
{
    transpose_rows(s->v);
    transpose_rows(s->d);
    transpose_rows(s->u);
    transpose_rows(s->low);
    for (int i = 0; i < 4; ++i) {
        if (s->moves[i] != 0) {
            const size_t slot = s->slot[i];
            *(row *)(void *)&call->bodies[slot].vx = s->v[i];
            *(row *)(void *)&call->bodies[slot].dx = s->d[i];
            *(row *)(void *)&call->motions[slot].ux = s->u[i];
            *(row *)(void *)&call->residuals[slot * 4] = s->low[i];
            call->struck[slot] = s->struck[i];
        }
    }
}

// Points that stay clear of their own accord are none of the contact kernel's business.
WIDE_INLINE void tell_kernel(const contacts *c, const mask clear[2])
{
    for (int j = 0; j < 2; ++j) {
        row_mask off = mask_row(c->present[j] & c->unloaded[j] & clear[j]);
        row told = narrow(c->separation[j]) + (row)(off & (row_mask)narrow(all(PL_APART)));
        for (int i = 3; i >= 0; --i) { // repeated lanes first: they were not struck
            OF_BUNDLE(c, i, p[j].separation) = told[i];
        }
    }
}

static void take_four(const pl_dull_call *call, const uint32_t *lanes, uint32_t count)
{
    contacts c;
    side a, b;
    view o;
    approach at[2];
    gather_contacts(&c, call, lanes, count);
    gather_side(&a, call, c.slot_a, c.taken);
    gather_side(&b, call, c.slot_b, c.taken);
    c.weight = length(a.a[0], a.a[1]) + length(b.a[0], b.a[1]);
    view_contacts(&o, &c, &a, &b);
    for (int j = 0; j < 2; ++j) {
        at[j] = foresee(&c, &o, j, call);
    }
    mask clear[2] = { at[0].clear, at[1].clear };
    if (any_of(at[0].due | at[1].due)) {
        resolve(&c, &a, &b, at, call);
        view_contacts(&o, &c, &a, &b);
        for (int j = 0; j < 2; ++j) {
            clear[j] = run_travel(&c, &o, j, all((double)call->h)).clear;
        }
        scatter_side(&a, call);
        scatter_side(&b, call);
    }
    tell_kernel(&c, clear);
}

//---- kernels -------------------------------------------------------------------------------------

WIDE_INLINE bool is_live(const near_real *fields)
{
    return any(load(fields + PL_PREDICTED_RESTITUTION * PL_WIDTH) > splat(0));
}

pl_dull_counter PL_WIDE_NAME(pl_dull_prepare);
uint32_t PL_WIDE_NAME(pl_dull_prepare)(const pl_dull_call *call, uint32_t first, uint32_t count)
{
    uint32_t lively = 0;
    for (uint32_t k = first; k < first + count; ++k) {
        const bundle *c = (const bundle *)call->bundles + k;
        near_real *fields = call->fields + (size_t)k * PL_WIDTH * PL_PREDICTED_FIELDS;
        near_real restitution[PL_WIDTH] = { 0 };
        for (int i = 0; i < PL_WIDTH; ++i) {
            const uint32_t at = call->lanes[(size_t)k * PL_WIDTH + (size_t)i];
            if (at != PL_NONE && pl_bounces(&call->manifolds[at])) {
                const near_real e = call->manifolds[at].restitution;
                lively += !pl_is_dull(e);
                restitution[i] = pl_is_dull(e) ? e : 0;
            }
        }
        memset(call->marks + (size_t)k * PL_WIDTH, 0, PL_WIDTH);
        vm dull = load(restitution) > splat(0);
        store(fields + PL_PREDICTED_RESTITUTION * PL_WIDTH, load(restitution));
        for (int j = 0; j < 2; ++j) {
            store(fields + PL_PREDICTED_SEPARATION(j) * PL_WIDTH,
                  sel(dull, c->p[j].separation, splat(PL_APART)));
        }
    }
    return lively;
}

pl_dull_kernel PL_WIDE_NAME(pl_dull_look);
void PL_WIDE_NAME(pl_dull_look)(const pl_dull_call *call, uint32_t first, uint32_t count)
{
    for (uint32_t k = first; k < first + count; ++k) {
        const near_real *fields = call->fields + (size_t)k * PL_WIDTH * PL_PREDICTED_FIELDS;
        if (is_live(fields)) {
            vm settled = look_at_bundle(call, fields, (bundle *)call->bundles + k);
            for (int i = 0; i < PL_WIDTH; ++i) {
                call->marks[(size_t)k * PL_WIDTH + (size_t)i] = settled[i] == 0;
            }
        }
    }
}

// Takes the lanes that wait, in fours; those that do not fill one stay, unless `all_of_them`.
WIDE_INLINE uint32_t take_waiting(const pl_dull_call *call, uint32_t *waiting, uint32_t held,
                                  bool all_of_them)
{
    uint32_t done = 0;
    for (; held - done >= 4; done += 4) {
        take_four(call, waiting + done, 4);
    }
    if (all_of_them && held > done) {
        take_four(call, waiting + done, held - done);
        return 0;
    }
    for (uint32_t i = done; i < held; ++i) {
        waiting[i - done] = waiting[i];
    }
    return held - done;
}

pl_dull_kernel PL_WIDE_NAME(pl_dull_strike);
void PL_WIDE_NAME(pl_dull_strike)(const pl_dull_call *call, uint32_t first, uint32_t count)
{
    uint32_t waiting[PL_WIDTH + 4], held = 0, color = 0;
    for (uint32_t k = first; k < first + count; ++k) {
        const near_real *fields = call->fields + (size_t)k * PL_WIDTH * PL_PREDICTED_FIELDS;
        for (int i = 0; i < PL_WIDTH; ++i) {
            call->marks[(size_t)k * PL_WIDTH + (size_t)i] &= PL_DULL_HIT;
        }
        if (is_live(fields)) {
            vm settled = look_at_bundle(call, fields, (bundle *)call->bundles + k);
            for (uint32_t i = 0; i < PL_WIDTH; ++i) {
                waiting[held] = k * PL_WIDTH + i;
                held += settled[i] == 0;
            }
        }
        // Behind the last bundle of a colour nothing may wait: the next one may share its bodies. Without
        // colour, each stands by itself.
        while (color < PL_COLORS && call->color_first[color + 1] <= k) {
            ++color;
        }
        const bool ends = color == PL_COLORS || call->color_first[color + 1] == k + 1;
        held = take_waiting(call, waiting, held, ends || k + 1 == first + count);
    }
}
