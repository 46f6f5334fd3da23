// lanes.h - joints in lanes: what a bundle holds of them, bodies to and from lanes, and rows made anew
// from where the bodies are. Included by joint.simd.c only.
//
// Every row between two bodies has J = (-n, wa, n, wb): n = 0 for angles. At the start of a step rows
// come from the joints (rows.c); after each substep they are made anew from how the bodies have moved
// since, by their form:
//     point    C = (x_B + r_B) - (x_A + r_A), along x or y
//     along    C = n . d + offset, n turning with A
//     angle    C = wa a_A + wb a_B + offset
//     length   C = |d| + offset, or its negative
// with d the way from A's anchor to B's, a what a body has turned. The two rows of a point push both
// bodies half-way between the anchors: see pl_rows_point.
#ifndef PL_JOINT_LANES_H
#define PL_JOINT_LANES_H

#include "world/tables/solver.h"
#include "core/wide.h"
#include "joints/joint.h"

// joints/measure.simd.c
void PL_WIDE_NAME(pl_joint_measure)(const pl_joint_call *call, const struct pl_measuring *m);

typedef struct row {
    vf nx, ny, wa, wb; // J
    vf error;          // C
    vf impulse;        // [N s]
    vf start;          // [N s] of it, what the substep began with
} row;

// What a row is made of, but for points.
typedef struct source {
    vf nx, ny; // along: n at the start of the step; length: nx its sign
    vf offset;
    vf along_a, along_b, over; // length: n . r of A and of B [m], 1 / |d| [1/m]
} source;

// Of the halves of a substep: see pl_oscillator.
typedef struct oscillator {
    vf velocity[2], error_rate[2], before[2];
} oscillator;

// What a row outside the block has besides.
typedef struct single {
    vf mass;        // [kg] effective
    vf most;        // [N s] bound
    vf speed;       // [m/s] or [rad/s] of drives
    vf before, lag; // of springs: see pl_row_half
    oscillator spring;
} single;

// A block that is a spring or bounded.
typedef struct temper {
    oscillator spring;
    vf before[3], lag[3]; // of its rows, as of a single
    vf most;              // [N s] of two rows as a vector
} temper;

// Given to A and to B.
typedef struct momentum {
    vf ax, ay, aw, bx, by, bw;
} momentum;

// Followed by the rows, a source for each if the block is no point, a temper, the singles.
typedef struct bundle {
    vf inertia_a, inertia_b;    // inverse
    momentum owed;              // because J has turned
    vf behind_a, behind_b, lag; // shares: see pl_joint_behind, pl_joint_lag
    vf spared;                  // see pl_joint_spared
    vf inverse[6];              // of the block's K: 00, 01, 11, 02, 12, 22
    vf ra_x, ra_y, rb_x, rb_y;  // [m] arms at the start of the step
    vf apart_x, apart_y;        // [m] from A's centre to B's at the start of the step
    vf sum_x, sum_y, sum_w;     // [N s], [N m s] as pl_joint.step_impulse, step_turn
} bundle;

typedef struct parts {
    const uint32_t *a, *b; // solver slots
    bundle *c;
    row *rows;
    source *sources;
    temper *temper;
    single *singles; // of the rows behind the block
} parts;

typedef struct body {
    vf vx, vy, w, inv_mass;
    vf dx, dy, da, inv_inertia;
} body;

WIDE_INLINE size_t record_size(const pl_joint_pattern *p)
{
    size_t sources = p->bare ? 0 : p->count;
    return sizeof(bundle) + p->count * sizeof(row) + sources * sizeof(source) +
           (p->tempered ? sizeof(temper) : 0) + (size_t)(p->count - p->block) * sizeof(single);
}

WIDE_INLINE parts open(const pl_joint_call *call, uint32_t k, const pl_joint_pattern *p)
{
    parts at;
    at.a = call->slots + (size_t)k * 2 * PL_WIDTH;
    at.b = at.a + PL_WIDTH;
    at.c = (bundle *)(void *)(call->records + call->bundles[k].at);
    at.rows = (row *)(void *)(at.c + 1);
    at.sources = (source *)(void *)(at.rows + p->count);
    at.temper = (temper *)(void *)(at.sources + (p->bare ? 0 : p->count));
    at.singles = (single *)(void *)(at.temper + (p->tempered ? 1 : 0));
    return at;
}

//---- bodies --------------------------------------------------------------------------------------

WIDE_INLINE void gather_body(body *out, const pl_joint_call *call, const uint32_t *slot)
{
    const near_real *at[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        at[i] = &call->bodies[slot[i]].vx;
    }
    vf r[8];
    gather8(r, at);
    *out = (body){ r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7] };
}

WIDE_INLINE void gather_velocity(body *out, const pl_joint_call *call, const uint32_t *slot,
                                 vf inv_inertia)
{
    const near_real *at[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        at[i] = &call->bodies[slot[i]].vx;
    }
    vf r[4];
    gather4(r, at, 0);
    *out = (body){ .vx = r[0], .vy = r[1], .w = r[2], .inv_mass = r[3] };
    out->inv_inertia = inv_inertia;
}

// Lanes of immovable bodies write to a sink, for others share those rows. Most bundles have none.
WIDE_INLINE void scatter_velocity(const body *in, const pl_joint_call *call, const uint32_t *slot)
{
    const vf out[4] = { in->vx, in->vy, in->w, in->inv_mass };
    near_real *at[PL_WIDTH];
    __asm__("" : "+r"(slot)); // read again: see solver/bundle.h
    if (all_below(slot, call->dynamic_slots)) {
        for (int i = 0; i < PL_WIDTH; ++i) {
            at[i] = &call->bodies[slot[i]].vx;
        }
        scatter4(at, 0, out);
        return;
    }
    near_real sink[4] __attribute__((aligned(32)));
    for (int i = 0; i < PL_WIDTH; ++i) {
        at[i] = slot[i] < call->dynamic_slots ? &call->bodies[slot[i]].vx : sink;
    }
    scatter4(at, 0, out);
}

// Adds the momentum (-x, -y, wa) to A and (x, y, wb) to B.
WIDE_INLINE void push(body *a, body *b, vf x, vf y, vf wa, vf wb)
{
    a->vx -= a->inv_mass * x;
    a->vy -= a->inv_mass * y;
    a->w += a->inv_inertia * wa;
    b->vx += b->inv_mass * x;
    b->vy += b->inv_mass * y;
    b->w += b->inv_inertia * wb;
}

// A share of m to each.
WIDE_INLINE void give(body *a, body *b, const momentum *m, vf share_a, vf share_b)
{
    const vf mass_a = a->inv_mass * share_a, mass_b = b->inv_mass * share_b;
    a->vx += mass_a * m->ax;
    a->vy += mass_a * m->ay;
    a->w += a->inv_inertia * share_a * m->aw;
    b->vx += mass_b * m->bx;
    b->vy += mass_b * m->by;
    b->w += b->inv_inertia * share_b * m->bw;
}

// What impulses of A and of B along a row get by its turning.
WIDE_INLINE void add_turning(momentum *m, const row *now, const row *old, vf of)
{
    const vf x = now->nx - old->nx, y = now->ny - old->ny;
    m->ax -= x * of, m->ay -= y * of, m->aw += (now->wa - old->wa) * of;
    m->bx += x * of, m->by += y * of, m->bw += (now->wb - old->wb) * of;
}

WIDE_INLINE vf rate(const row *r, const body *a, const body *b)
{
    return (r->nx * (b->vx - a->vx) + r->ny * (b->vy - a->vy)) + (r->wa * a->w + r->wb * b->w);
}

//---- rows where the bodies are now ---------------------------------------------------------------

#define TAYLOR(n) splat((near_real)(1.0 / (n)))

#define PL_TINY_TURN ((near_real)1e-10) // [rad]

// Bodies turn little in a step: see turned_by in one.c.
WIDE_INLINE void turned_by(vf x, vf *c, vf *s)
{
    // Squares of less than this change no bit, but may be subnormal, which costs hundreds of cycles.
    vf large = sel(vabs(x) > splat(PL_TINY_TURN), x, splat(0));
    vf xx = large * large;
    const vf one = splat(1);
    *c = one - xx * splat((near_real)0.5) *
                   (one - xx * TAYLOR(12) * (one - xx * TAYLOR(30) * (one - xx * TAYLOR(56))));
    *s = x * (one - xx * TAYLOR(6) * (one - xx * TAYLOR(20) * (one - xx * TAYLOR(42))));
    vm far = vabs(x) > splat((near_real)0.1);
    if (any(far)) {
        for (int i = 0; i < PL_WIDTH; ++i) {
            if (far[i]) {
                plumb_rot q = plumb_rot_make(x[i]);
                (*c)[i] = (near_real)q.c;
                (*s)[i] = (near_real)q.s;
            }
        }
    }
}

// Adds to J v of a point what the arc of a body's anchor does, as in one.c.
WIDE_INLINE void add_arc(vf v[2], vf w, vf h, vf w0, vf w1)
{
    vf turn = vabs(h * w);
    vf u = sel((turn > splat(PL_LEAST_ARC)) & (turn < splat(1)), w, splat(0));
    vf x = h * u, xx = x * x;
    u *= splat(1) - xx * xx;
    vf c = x * u * splat((near_real)-0.5), s = xx * u * -TAYLOR(6);
    v[0] += c * w1 + s * w0;
    v[1] += s * w1 - c * w0;
}

WIDE_INLINE vf fading(vf x)
{
    const vf xx = x * x, one = splat(1);
    return sel(xx < one, one - xx * xx, splat(0));
}

// The same for a length: what the way across d and the arcs of its ends add to it, C'' h / 2.
WIDE_INLINE vf bow(const row *r, const source *s, const body *a, const body *b, vf h)
{
    const vf across =
        r->nx * (b->vy - a->vy) - r->ny * (b->vx - a->vx) + s->along_b * b->w - s->along_a * a->w;
    const vf turn = across * s->over, of_a = fading(h * a->w) * a->w * a->w;
    const vf of_b = fading(h * b->w) * b->w * b->w;
    const vf way = fading(h * turn) * across * turn;
    return splat((near_real)0.5) * h * (way + (of_a * s->along_a - of_b * s->along_b));
}

WIDE_INLINE vf inverse_or_zero(vf k)
{
    vm positive = k > splat(0);
    return sel(positive, splat(1) / sel(positive, k, splat(1)), splat(0));
}

// J M^-1 J'^T of two rows.
WIDE_INLINE vf coupling(const row *r, const row *q, const body *a, const body *b)
{
    return (a->inv_mass + b->inv_mass) * (r->nx * q->nx + r->ny * q->ny) +
           (a->inv_inertia * r->wa * q->wa + b->inv_inertia * r->wb * q->wb);
}

// 1 / pivot; 0 where the pivot is no direction of its own (PL_PIVOT of the diagonal).
WIDE_INLINE vf pivot(vf value, vf diagonal)
{
    vm usable = value > splat(PL_PIVOT) * diagonal;
    return sel(usable, splat(1) / sel(usable, value, splat(1)), splat(0));
}

// Inverse of the block's K by elimination, n rows.
WIDE_INLINE void invert(bundle *c, const row *r, const int n, const body *a, const body *b)
{
    vf k00 = coupling(&r[0], &r[0], a, b);
    vf p0 = pivot(k00, k00);
    c->inverse[0] = p0;
    if (n == 1) {
        return;
    }
    vf k01 = coupling(&r[0], &r[1], a, b), k11 = coupling(&r[1], &r[1], a, b);
    vf l1 = k01 * p0;
    vf p1 = pivot(k11 - l1 * k01, k11);
    vf m = -l1 * p1;
    c->inverse[0] = p0 - l1 * m;
    c->inverse[1] = m;
    c->inverse[2] = p1;
    if (n == 2) {
        return;
    }
    vf k02 = coupling(&r[0], &r[2], a, b), k12 = coupling(&r[1], &r[2], a, b);
    vf k22 = coupling(&r[2], &r[2], a, b);
    // The inverse of the first two rows, times the third column.
    vf u0 = c->inverse[0] * k02 + c->inverse[1] * k12;
    vf u1 = c->inverse[1] * k02 + c->inverse[2] * k12;
    vf p2 = pivot(k22 - (u0 * k02 + u1 * k12), k22);
    c->inverse[0] += u0 * u0 * p2;
    c->inverse[1] += u0 * u1 * p2;
    c->inverse[2] += u1 * u1 * p2;
    c->inverse[3] = -u0 * p2;
    c->inverse[4] = -u1 * p2;
    c->inverse[5] = p2;
}

// Where the anchors are.
typedef struct place {
    vf ca, sa;                 // by which A has turned
    vf ra_x, ra_y, rb_x, rb_y; // [m] arms now
    vf dx, dy;                 // [m] from A's anchor to B's
} place;

WIDE_INLINE place place_now(const bundle *c, const body *a, const body *b)
{
    place p;
    vf cb, sb;
    turned_by(a->da, &p.ca, &p.sa);
    turned_by(b->da, &cb, &sb);
    p.ra_x = p.ca * c->ra_x - p.sa * c->ra_y;
    p.ra_y = p.sa * c->ra_x + p.ca * c->ra_y;
    p.rb_x = cb * c->rb_x - sb * c->rb_y;
    p.rb_y = sb * c->rb_x + cb * c->rb_y;
    p.dx = (c->apart_x + (b->dx - a->dx)) + (p.rb_x - p.ra_x);
    p.dy = (c->apart_y + (b->dy - a->dy)) + (p.rb_y - p.ra_y);
    return p;
}

WIDE_INLINE void make_row(row *r, source *from, const uint8_t form, const place *p, const body *a,
                          const body *b)
{
    const vf zero = splat(0), half = splat((near_real)0.5);
    switch (form) {
    case PL_FORM_POINT_X:
        r->nx = splat(1), r->ny = zero;
        r->wa = p->ra_y + half * p->dy;
        r->wb = half * p->dy - p->rb_y;
        r->error = p->dx;
        break;
    case PL_FORM_POINT_Y:
        r->nx = zero, r->ny = splat(1);
        r->wa = -(p->ra_x + half * p->dx);
        r->wb = p->rb_x - half * p->dx;
        r->error = p->dy;
        break;
    case PL_FORM_ANGLE:
        r->error = r->wa * a->da + r->wb * b->da + from->offset;
        break;
    case PL_FORM_ALONG:
        r->nx = p->ca * from->nx - p->sa * from->ny;
        r->ny = p->sa * from->nx + p->ca * from->ny;
        r->wa = -((p->ra_x + p->dx) * r->ny - (p->ra_y + p->dy) * r->nx);
        r->wb = p->rb_x * r->ny - p->rb_y * r->nx;
        r->error = (p->dx * r->nx + p->dy * r->ny) + from->offset;
        break;
    default: { // PL_FORM_LENGTH; without length, any direction will do
        vf length = vsqrt(p->dx * p->dx + p->dy * p->dy);
        vm there = length > zero;
        vf over = from->nx / sel(there, length, splat(1));
        r->nx = sel(there, p->dx * over, from->nx);
        r->ny = sel(there, p->dy * over, zero);
        r->wa = -(p->ra_x * r->ny - p->ra_y * r->nx);
        r->wb = p->rb_x * r->ny - p->rb_y * r->nx;
        r->error = from->nx * length + from->offset;
        from->along_a = p->ra_x * r->nx + p->ra_y * r->ny;
        from->along_b = p->rb_x * r->nx + p->rb_y * r->ny;
        from->over = sel(there, from->nx / sel(there, length, splat(1)), splat(0));
        break;
    }
    }
}

// Rows, effective masses and what is owed, from where the bodies are. Answers what is due now: of the impulses
// with which the substep began, what comes behind the drift gets by their turning; the rest is owed (one.c).
WIDE_INLINE momentum make_rows(const parts *at, const pl_joint_pattern *p, const body *a,
                               const body *b)
{
    bundle *c = at->c;
    const place now = place_now(c, a, b);
    momentum due = { .ax = splat(0) };
    c->owed = due;
    for (int i = 0; i < p->count; ++i) {
        row *r = &at->rows[i];
        const row old = *r;
        make_row(r, p->bare ? NULL : &at->sources[i], p->row[i].form, &now, a, b);
        const vf behind = c->lag * r->start; // of both the same, or momentum would come of it
        add_turning(&due, r, &old, behind);
        add_turning(&c->owed, r, &old, r->impulse - behind);
    }
    switch (p->block) {
    case 1:
        invert(c, at->rows, 1, a, b);
        break;
    case 2:
        invert(c, at->rows, 2, a, b);
        break;
    case 3:
        invert(c, at->rows, 3, a, b);
        break;
    default:
        break;
    }
    for (int i = p->block; i < p->count; ++i) {
        row *r = &at->rows[i];
        vf mass = inverse_or_zero(coupling(r, r, a, b));
        at->singles[i - p->block].mass = mass;
        r->impulse = sel(mass > splat(0), r->impulse, splat(0));
    }
    return due;
}

#endif
