// joint.simd.c - joints, W at a time: the rows of rows.c and the sweeps of solve.c in lanes.
//
// Every row between two bodies has J = (-n, wa, n, wb): n = 0 for angles. At the start of a step the
// rows come from the joints (rows.c); after each substep they are made anew from how the bodies
// have moved since, by their form:
//     point    C = (x_B + r_B) - (x_A + r_A), along x or y
//     along    C = n . d + offset, n turning with A
//     angle    C = wa a_A + wb a_B + offset
//     length   C = |d| + offset, or its negative
// with d the way between the anchors, a what the bodies have turned. The two rows of a point push
// both bodies half-way between the anchors: angular momentum is kept, and the arms stay those of
// the joint however far the anchors are apart.
//
// What J's turning owes, (J' - J)^T impulse, is paid joint by joint as it is pulled.
//
// Cost: a bundle of hinges takes about 150 instructions a pull, 250 a relax with new rows.
#include "core/wide.h"
#include "joints/joint.h"
#include "solver/solver.h"

typedef struct row {
    vf nx, ny, wa, wb; // J
    vf error;          // C
    vf impulse;        // [N s]
} row;

// What a row is made of, but for points.
typedef struct source {
    vf nx, ny; // along: n at the start of the step; length: nx its sign
    vf offset;
} source;

// What a row outside the block has besides.
typedef struct single {
    vf mass;                       // [kg] effective
    vf most;                       // [N s] bound
    vf speed;                      // [m/s] or [rad/s] of drives
    vf velocity, error_rate, give; // of springs: see pl_joint_soft
} single;

// A block that is a spring or bounded.
typedef struct temper {
    vf velocity, error_rate, give;
    vf most; // [N s] of two rows as a vector
} temper;

// Followed by the rows, a source for each if the block is no point, a temper, the singles.
typedef struct bundle {
    vf inertia_a, inertia_b;           // inverse
    vf owed_x, owed_y, owed_a, owed_b; // momentum that J's turning owes
    vf inverse[6];                     // of the block's K: 00, 01, 11, 02, 12, 22
    vf ra_x, ra_y, rb_x, rb_y;         // [m] arms at the start of the step
    vf apart_x, apart_y;               // [m] from A's centre to B's at the start of the step
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

static size_t record_size(const pl_joint_pattern *p)
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
    const plumb_real *at[PL_WIDTH];
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
    const plumb_real *at[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        at[i] = &call->bodies[slot[i]].vx;
    }
    vf r[4];
    gather4(r, at, 0);
    *out = (body){ .vx = r[0], .vy = r[1], .w = r[2], .inv_mass = r[3] };
    out->inv_inertia = inv_inertia;
}

// Lanes of immovable bodies write to a sink, for others share those rows.
WIDE_INLINE void scatter_velocity(const body *in, const pl_joint_call *call, const uint32_t *slot)
{
    plumb_real sink[4] __attribute__((aligned(32)));
    plumb_real *at[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        at[i] = slot[i] < call->dynamic_slots ? &call->bodies[slot[i]].vx : sink;
    }
    scatter4(at, 0, (vf[4]){ in->vx, in->vy, in->w, in->inv_mass });
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

WIDE_INLINE vf rate(const row *r, const body *a, const body *b)
{
    return (r->nx * (b->vx - a->vx) + r->ny * (b->vy - a->vy)) + (r->wa * a->w + r->wb * b->w);
}

//---- rows where the bodies are now ---------------------------------------------------------------

#define TAYLOR(n) splat((plumb_real)(1.0 / (n)))

// Bodies turn little in a step: see turned_by in solve.c.
WIDE_INLINE void turned_by(vf x, vf *c, vf *s)
{
    vf xx = x * x;
    const vf one = splat(1);
    *c = one - xx * splat((plumb_real)0.5) *
                   (one - xx * TAYLOR(12) * (one - xx * TAYLOR(30) * (one - xx * TAYLOR(56))));
    *s = x * (one - xx * TAYLOR(6) * (one - xx * TAYLOR(20) * (one - xx * TAYLOR(42))));
    vm far = vabs(x) > splat((plumb_real)0.1);
    if (any(far)) {
        for (int i = 0; i < PL_WIDTH; ++i) {
            if (far[i]) {
                plumb_rot q = plumb_rot_make(x[i]);
                (*c)[i] = q.c;
                (*s)[i] = q.s;
            }
        }
    }
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

WIDE_INLINE void make_row(row *r, const source *from, const uint8_t form, const place *p,
                          const body *a, const body *b)
{
    const vf zero = splat(0), half = splat((plumb_real)0.5);
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
        break;
    }
    }
}

// Rows, effective masses and what is owed, from where the bodies are.
WIDE_INLINE void make_rows(const parts *at, const pl_joint_pattern *p, const body *a, const body *b)
{
    bundle *c = at->c;
    const place now = place_now(c, a, b);
    c->owed_x = c->owed_y = c->owed_a = c->owed_b = splat(0);
    for (int i = 0; i < p->count; ++i) {
        row *r = &at->rows[i];
        const row old = *r;
        make_row(r, p->bare ? NULL : &at->sources[i], p->row[i].form, &now, a, b);
        c->owed_x += (r->nx - old.nx) * r->impulse;
        c->owed_y += (r->ny - old.ny) * r->impulse;
        c->owed_a += (r->wa - old.wa) * r->impulse;
        c->owed_b += (r->wb - old.wb) * r->impulse;
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
}

//---- sweeps --------------------------------------------------------------------------------------

WIDE_INLINE void solve_single(row *r, const single *s, const pl_pattern_row *kind,
                              const pl_joint_call *call, const bool pull, body *a, body *b)
{
    const vf zero = splat(0), one = splat(1);
    vf velocity = one, error_rate = zero, give = zero, speed = zero;
    vf low = -s->most;
    if (kind->type == PL_ROW_DRIVE) {
        speed = s->speed;
    } else if (kind->spring) {
        velocity = s->velocity, error_rate = s->error_rate, give = s->give;
    } else if (pull) {
        velocity = splat(call->rigid.velocity);
        error_rate = splat(call->rigid.error);
        give = splat(call->rigid.impulse);
    }
    if (kind->type == PL_ROW_LEAST) {
        vm apart = r->error > zero; // may close the gap
        velocity = sel(apart, one, velocity);
        error_rate = sel(apart, splat(1 / call->h), error_rate);
        give = sel(apart, zero, give);
        low = zero;
    }
    vf v = rate(r, a, b) - speed;
    vf total = r->impulse - s->mass * (velocity * v + error_rate * r->error) - give * r->impulse;
    total = vclamp(total, low, s->most);
    vf change = total - r->impulse;
    r->impulse = total;
    push(a, b, r->nx * change, r->ny * change, r->wa * change, r->wb * change);
}

WIDE_INLINE void solve_block(const parts *at, const pl_joint_pattern *p, const int n,
                             const pl_joint_call *call, const bool pull, body *a, body *b)
{
    row r[3];
    for (int i = 0; i < n; ++i) {
        r[i] = at->rows[i];
    }
    const vf *inverse = at->c->inverse;
    vf velocity = splat(1), error_rate = splat(0), keep = splat(1);
    if (p->tempered && (p->row[0].spring || p->row[0].type == PL_ROW_DRIVE)) {
        velocity = at->temper->velocity;
        error_rate = at->temper->error_rate;
        keep = splat(1) - at->temper->give;
    } else if (pull) {
        velocity = splat(call->rigid.velocity);
        error_rate = splat(call->rigid.error);
        keep = splat(1 - call->rigid.impulse);
    }
    vf wrong[3], total[3];
    for (int i = 0; i < n; ++i) {
        wrong[i] = rate(&r[i], a, b);
        if (pull) {
            wrong[i] = velocity * wrong[i] + error_rate * r[i].error;
        }
        total[i] = keep * r[i].impulse;
    }
    total[0] -= inverse[0] * wrong[0];
    if (n > 1) {
        total[0] -= inverse[1] * wrong[1];
        total[1] -= inverse[1] * wrong[0] + inverse[2] * wrong[1];
    }
    if (n > 2) {
        total[0] -= inverse[3] * wrong[2];
        total[1] -= inverse[4] * wrong[2];
        total[2] -= inverse[3] * wrong[0] + inverse[4] * wrong[1] + inverse[5] * wrong[2];
    }
    if (p->tempered && n == 2) {
        vf now = vsqrt(total[0] * total[0] + total[1] * total[1]);
        vm over = now > at->temper->most;
        vf scale = sel(over, at->temper->most / sel(over, now, splat(1)), splat(1));
        total[0] *= scale;
        total[1] *= scale;
    }
    vf x = splat(0), y = splat(0), wa = splat(0), wb = splat(0);
    for (int i = 0; i < n; ++i) {
        vf change = total[i] - r[i].impulse;
        at->rows[i].impulse = total[i];
        x += r[i].nx * change;
        y += r[i].ny * change;
        wa += r[i].wa * change;
        wb += r[i].wb * change;
    }
    push(a, b, x, y, wa, wb);
}

// Motors and springs first: what must hold has the last word.
WIDE_INLINE void solve_rows(const parts *at, const pl_joint_pattern *p, const pl_joint_call *call,
                            const bool pull, body *a, body *b)
{
    for (int i = p->count - 1; i >= p->block; --i) {
        if (pull || !p->row[i].spring) {
            solve_single(&at->rows[i], &at->singles[i - p->block], &p->row[i], call, pull, a, b);
        }
    }
    if (!pull && p->row[0].spring) {
        return;
    }
    switch (p->block) {
    case 1:
        solve_block(at, p, 1, call, pull, a, b);
        break;
    case 2:
        solve_block(at, p, 2, call, pull, a, b);
        break;
    case 3:
        solve_block(at, p, 3, call, pull, a, b);
        break;
    default:
        break;
    }
}

WIDE_INLINE void sweep_bundle(const pl_joint_call *call, uint32_t k, const pl_joint_pattern *p,
                              const bool pull, const bool first)
{
    parts at = open(call, k, p);
    bundle *c = at.c;
    body a, b;
    if (first && !pull) {
        gather_body(&a, call, at.a);
        gather_body(&b, call, at.b);
        make_rows(&at, p, &a, &b);
    } else {
        gather_velocity(&a, call, at.a, c->inertia_a);
        gather_velocity(&b, call, at.b, c->inertia_b);
    }
    if (first && pull) {
        push(&a, &b, c->owed_x, c->owed_y, c->owed_a, c->owed_b);
    }
    solve_rows(&at, p, call, pull, &a, &b);
    scatter_velocity(&a, call, at.a);
    scatter_velocity(&b, call, at.b);
}

// The pattern of bare hinges is known to the compiler, which makes a kernel of their own of it.
static const pl_joint_pattern bare_pattern = {
    .count = 2,
    .block = 2,
    .bare = true,
    .row = { { .index = 0, .form = PL_FORM_POINT_X, .type = PL_ROW_EQUAL },
             { .index = 1, .form = PL_FORM_POINT_Y, .type = PL_ROW_EQUAL } },
};

WIDE_INLINE void sweep(const pl_joint_call *call, const bool pull, const bool first)
{
    for (uint32_t k = 0; k < call->bundle_count; ++k) {
        const pl_joint_pattern *p = &call->patterns[call->bundles[k].pattern];
        if (p->bare) {
            sweep_bundle(call, k, &bare_pattern, pull, first);
        } else {
            sweep_bundle(call, k, p, pull, first);
        }
    }
}

static void pull_first(const pl_joint_call *call)
{
    sweep(call, true, true);
}

static void pull(const pl_joint_call *call)
{
    sweep(call, true, false);
}

static void relax_first(const pl_joint_call *call)
{
    sweep(call, false, true);
}

static void relax(const pl_joint_call *call)
{
    sweep(call, false, false);
}

//---- joints <-> lanes ----------------------------------------------------------------------------

static void fill_row(const parts *at, const pl_joint_pattern *p, int i, int lane, const pl_joint *j,
                     plumb_vec2 apart, real h)
{
    const pl_row *from = &j->rows.row[p->row[i].index];
    const bool length = p->row[i].form == PL_FORM_LENGTH;
    row *r = &at->rows[i];
    source *s = &at->sources[i];
    r->nx[lane] = from->bx, r->ny[lane] = from->by;
    r->wa[lane] = from->aw, r->wb[lane] = from->bw;
    real along = apart.x * from->bx + apart.y * from->by;
    bool flipped = along < 0 || (along == 0 && from->bx < 0);
    s->nx[lane] = !length ? from->bx : flipped ? (real)-1 : (real)1;
    s->ny[lane] = from->by;
    s->offset[lane] = p->row[i].form == PL_FORM_ANGLE ? from->error : from->error - along;
    if (i < p->block) {
        return;
    }
    single *e = &at->singles[i - p->block];
    pl_joint_soft soft = pl_joint_spring(from, h);
    e->most[lane] = from->most * h;
    e->speed[lane] = from->speed;
    e->velocity[lane] = soft.velocity;
    e->error_rate[lane] = soft.error;
    e->give[lane] = soft.impulse;
}

static void fill_temper(temper *t, int lane, const pl_joint *j, real h)
{
    pl_joint_soft soft = pl_joint_spring(&j->rows.row[0], h);
    t->velocity[lane] = soft.velocity;
    t->error_rate[lane] = soft.error;
    t->give[lane] = soft.impulse;
    t->most[lane] = j->rows.block_most * h;
}

static void fill_lane(const parts *at, const pl_joint_pattern *p, int lane, const pl_joint *j,
                      real h)
{
    const pl_joint_pose *a = &j->a.pose, *b = &j->b.pose;
    plumb_vec2 apart = pl_joint_apart(a, b);
    for (int i = 0; i < p->count; ++i) {
        at->rows[i].impulse[lane] = j->impulse[p->row[i].index];
        fill_row(at, p, i, lane, j, apart, h);
    }
    if (p->row[0].form == PL_FORM_POINT_X) {
        // What B's anchor is held to, seen from A: the anchor, or a target beside it.
        at->c->ra_x[lane] = a->rx + apart.x - j->rows.row[0].error;
        at->c->ra_y[lane] = a->ry + apart.y - j->rows.row[1].error;
    }
    if (p->tempered) {
        fill_temper(at->temper, lane, j, h);
    }
}

// What all joints have, and bare ones nothing besides.
WIDE_INLINE void fill_start(const parts *at, const pl_joint_start *starts, const bool bare)
{
    const plumb_real *from[PL_WIDTH];
    vf r[8];
    for (int i = 0; i < PL_WIDTH; ++i) {
        from[i] = &starts[i].arm_a.x;
    }
    gather8(r, from);
    bundle *c = at->c;
    c->ra_x = r[0], c->ra_y = r[1];
    c->rb_x = r[2], c->rb_y = r[3];
    c->apart_x = r[4], c->apart_y = r[5];
    if (bare) {
        at->rows[0].impulse = r[6];
        at->rows[1].impulse = r[7];
    }
}

static void fill(const pl_joint_call *call)
{
    for (uint32_t k = 0; k < call->bundle_count; ++k) {
        const pl_joint_pattern *p = &call->patterns[call->bundles[k].pattern];
        parts at = open(call, k, p);
        const pl_joint_lane *lanes = &call->lanes[(size_t)k * PL_WIDTH];
        memset(at.c, 0, record_size(p));
        fill_start(&at, &call->starts[(size_t)k * PL_WIDTH], p->bare);
        for (int i = 0; i < PL_WIDTH && !p->bare; ++i) {
            if (lanes[i].joint != PL_NONE) {
                fill_lane(&at, p, i, &call->joints[lanes[i].joint], call->h);
            }
        }
        body a, b;
        gather_body(&a, call, at.a);
        gather_body(&b, call, at.b);
        at.c->inertia_a = a.inv_inertia;
        at.c->inertia_b = b.inv_inertia;
        make_rows(&at, p, &a, &b);
        at.c->owed_x = at.c->owed_y = at.c->owed_a = at.c->owed_b = splat(0);
    }
}

static void warm_start(const pl_joint_call *call)
{
    for (uint32_t k = 0; k < call->bundle_count; ++k) {
        const pl_joint_pattern *p = &call->patterns[call->bundles[k].pattern];
        parts at = open(call, k, p);
        body a, b;
        gather_velocity(&a, call, at.a, at.c->inertia_a);
        gather_velocity(&b, call, at.b, at.c->inertia_b);
        for (int i = 0; i < p->count; ++i) {
            const row *r = &at.rows[i];
            push(&a, &b, r->nx * r->impulse, r->ny * r->impulse, r->wa * r->impulse,
                 r->wb * r->impulse);
        }
        scatter_velocity(&a, call, at.a);
        scatter_velocity(&b, call, at.b);
    }
}

// The reaction is J^T impulse on B; its torque is told about B's anchor.
static void store_all(const pl_joint_call *call)
{
    const vf inv_h = splat(1 / call->h);
    for (uint32_t k = 0; k < call->bundle_count; ++k) {
        const pl_joint_pattern *p = &call->patterns[call->bundles[k].pattern];
        const pl_joint_lane *lanes = &call->lanes[(size_t)k * PL_WIDTH];
        parts at = open(call, k, p);
        for (int i = 0; i < PL_WIDTH && k + 1 < call->bundle_count; ++i) {
            if (lanes[PL_WIDTH + i].joint != PL_NONE) {
                __builtin_prefetch(&call->joints[lanes[PL_WIDTH + i].joint], 1);
            }
        }
        body a, b;
        gather_body(&a, call, at.a);
        gather_body(&b, call, at.b);
        const place now = place_now(at.c, &a, &b);
        vf x = splat(0), y = splat(0), w = splat(0);
        for (int i = 0; i < p->count; ++i) {
            const row *r = &at.rows[i];
            x += r->nx * r->impulse;
            y += r->ny * r->impulse;
            w += r->wb * r->impulse;
        }
        w = (w - (now.rb_x * y - now.rb_y * x)) * inv_h;
        x *= inv_h;
        y *= inv_h;
        for (int i = 0; i < PL_WIDTH; ++i) {
            if (lanes[i].joint == PL_NONE) {
                continue;
            }
            pl_joint *j = &call->joints[lanes[i].joint];
            for (int m = 0; m < p->count; ++m) {
                j->impulse[p->row[m].index] = at.rows[m].impulse[i];
            }
            j->h = call->h;
            j->force = plumb_v2(x[i], y[i]);
            j->torque = w[i];
        }
    }
}

const pl_joint_kernels PL_WIDE_NAME(pl_joint_kernels) = {
    .width = PL_WIDTH,
    .record_size = record_size,
    .fill = fill,
    .warm_start = warm_start,
    .pull_first = pull_first,
    .pull = pull,
    .relax_first = relax_first,
    .relax = relax,
    .store = store_all,
};
