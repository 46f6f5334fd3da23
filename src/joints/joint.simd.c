// joint.simd.c - what one.c does to a joint, W at a time, and how a step begins and ends.
//
// What J's turning owes, (J' - J)^T impulse, is paid joint by joint as it is pulled; rows at the moved
// places are made as it is relaxed: so a substep of one sweep each goes over the bodies twice.
//
// Reads: starts, slots, joints. Writes: records, solver bodies, impulses and reactions of joints.
// Cost, 8 lanes: 340 instructions a bundle of bare hinges and sweep, 600 with new rows.
#include "joints/lanes.h"

//---- sweeps --------------------------------------------------------------------------------------

// What a motor may drive at: it comes to a stop where a limit of the same value begins. Else limit and motor, two rows of one
// direction, would push against one another, and the limit gives way by what the motor has.
WIDE_INLINE vf drive_speed(const parts *at, const pl_joint_pattern *p, int drive, vf inv_h)
{
    const vf speed = at->singles[drive - p->block].speed;
    const int upper = drive - 1, lower = drive - 2; // where there is a limit (parts.c)
    if (lower < p->block || p->row[upper].type != PL_ROW_LEAST ||
        p->row[upper].form != p->row[drive].form) {
        return speed;
    }
    const vf down = vmax(at->rows[lower].error, splat(0)) * inv_h;
    const vf up = vmax(at->rows[upper].error, splat(0)) * inv_h;
    return vmin(vmax(speed, -down), up);
}

// What a row behind the block lacks, for a mass of 1, and what of its impulse gives way.
typedef struct demand {
    vf lack;      // [m/s] or [rad/s]
    vf give, lag; // [-], [N s]
    vf low;       // [N s] least impulse
} demand;

WIDE_INLINE void demand_of(demand *d, const parts *at, const pl_joint_pattern *p, int i, vf driven,
                           const pl_joint_call *call, const bool pull, const bool first,
                           const body *a, const body *b)
{
    const row *r = &at->rows[i];
    const single *s = &at->singles[i - p->block];
    const pl_pattern_row *kind = &p->row[i];
    const vf zero = splat(0), one = splat(1);
    vf velocity = one, error_rate = zero, give = zero, speed = zero, before = zero, lag = zero;
    vf low = -s->most;
    if (kind->type == PL_ROW_DRIVE) {
        speed = driven;
    } else if (kind->spring) {
        velocity = s->spring.velocity[!pull], error_rate = s->spring.error_rate[!pull];
        give = one - velocity;
        before = s->spring.before[!pull] * s->before;
        lag = s->lag;
        if (pull) {
            lag = at->c->lag * r->start;
        }
    } else if (pull) {
        velocity = splat((near_real)call->rigid.velocity);
        error_rate = splat((near_real)call->rigid.error);
        give = splat((near_real)call->rigid.impulse);
        lag = at->c->lag * at->c->spared * r->start;
    }
    if (kind->type == PL_ROW_LEAST) {
        vm apart = r->error > zero; // may close the gap
        velocity = sel(apart, one, velocity);
        error_rate = sel(apart, splat((near_real)(1 / call->h)), error_rate);
        give = sel(apart, zero, give);
        before = sel(apart, zero, before);
        low = zero;
    }
    vf v = rate(r, a, b);
    if (pull && !first && !kind->spring && kind->form == PL_FORM_LENGTH) {
        v += bow(r, &at->sources[i], a, b, splat((near_real)call->h));
    }
    d->lack = velocity * (v - speed) - before + error_rate * r->error;
    d->give = give, d->lag = lag, d->low = low;
}

// Gives a row of this mass the impulse that meets the demand; answers by how much that changes.
WIDE_INLINE vf meet(row *r, const demand *d, vf mass, vf most)
{
    vf total = r->impulse - mass * d->lack - d->give * (r->impulse - d->lag);
    total = vclamp(total, d->low, most);
    vf change = total - r->impulse;
    r->impulse = total;
    return change;
}

WIDE_INLINE void solve_single(const parts *at, const pl_joint_pattern *p, int i,
                              const pl_joint_call *call, const bool pull, const bool first, body *a,
                              body *b)
{
    row *r = &at->rows[i];
    const single *s = &at->singles[i - p->block];
    vf driven = splat(0);
    if (p->row[i].type == PL_ROW_DRIVE) {
        driven = drive_speed(at, p, i, splat((near_real)(1 / call->h)));
    }
    demand d;
    demand_of(&d, at, p, i, driven, call, pull, first, a, b);
    const vf change = meet(r, &d, s->mass, s->most);
    push(a, b, r->nx * change, r->ny * change, r->wa * change, r->wb * change);
}

// What a block of n rows answers to an impulse of 1 along row r, as in one.c; and the mass of all.
WIDE_INLINE vf answer_of(vf answer[3], const parts *at, const int n, const row *r, vf mass,
                         const body *a, const body *b)
{
    static const int at_row[3][3] = { { 0, 1, 3 }, { 1, 2, 4 }, { 3, 4, 5 } }; // in bundle.inverse
    const vf own = coupling(r, r, a, b);
    vf coupled[3], whole = own;
    for (int k = 0; k < n; ++k) {
        coupled[k] = coupling(&at->rows[k], r, a, b);
    }
    for (int k = 0; k < n; ++k) {
        answer[k] = splat(0);
        for (int m = 0; m < n; ++m) {
            answer[k] -= at->c->inverse[at_row[k][m]] * coupled[m];
        }
        whole += coupled[k] * answer[k];
    }
    const vm answered = whole > splat(PL_PIVOT) * own;
    for (int k = 0; k < n; ++k) {
        answer[k] = sel(answered, answer[k], splat(0));
    }
    return sel(answered, splat(1) / sel(answered, whole, splat(1)), mass);
}

// A limit, with what a rigid block answers to it: an angle is stopped about the hinge, not about the centre.
WIDE_PART void solve_limit(const parts *at, const pl_joint_pattern *p, int i,
                           const pl_joint_call *call, const bool pull, const bool first, body *a,
                           body *b)
{
    const int n = p->block;
    row *r = &at->rows[i];
    const single *s = &at->singles[i - p->block];
    demand d;
    demand_of(&d, at, p, i, splat(0), call, pull, first, a, b);
    if (!any((r->impulse > splat(0)) | (d.lack < splat(0)))) {
        return; // nobody is at it
    }
    vf answer[3];
    const vf mass = answer_of(answer, at, n, r, s->mass, a, b);
    const vf change = meet(r, &d, mass, s->most);
    vf x = r->nx * change, y = r->ny * change, wa = r->wa * change, wb = r->wb * change;
    for (int k = 0; k < n; ++k) {
        row *of = &at->rows[k];
        const vf due = answer[k] * change;
        of->impulse += due;
        x += of->nx * due, y += of->ny * due, wa += of->wa * due, wb += of->wb * due;
    }
    push(a, b, x, y, wa, wb);
}

// A point of two bodies that move, apart by more than `most` and than its arms sweep over in a substep, is drawn together no
// faster than if it were by that, and gives way less by the same share: it bears what its spring would. (What hangs on the world
// adds up to nothing; a rod that spins there may be a metre off after a substep.)
WIDE_INLINE void hold_back(const row r[2], const body *a, const body *b, vf error[2], vf kept[2],
                           vf most, vf h)
{
    const vf gap = vmax(vabs(error[0]), vabs(error[1]));
    if (!any(gap > most)) {
        return;
    }
    const vf swept = vabs(a->w) * vmax(vabs(r[0].wa), vabs(r[1].wa)) +
                     vabs(b->w) * vmax(vabs(r[0].wb), vabs(r[1].wb));
    const vf one = splat(1), reach = most + h * swept, share = reach / vmax(gap, reach);
    const vm far = (gap > reach) & (a->inv_mass > splat(0)) & (b->inv_mass > splat(0));
    for (int i = 0; i < 2; ++i) {
        error[i] *= sel(far, share, one);
        kept[i] = sel(far, one - (one - kept[i]) * share, kept[i]);
    }
}

WIDE_INLINE void solve_block(const parts *at, const pl_joint_pattern *p, const int n,
                             const pl_joint_call *call, const bool pull, const bool first, body *a,
                             body *b)
{
    row r[3];
    for (int i = 0; i < n; ++i) {
        r[i] = at->rows[i];
    }
    const vf *inverse = at->c->inverse;
    vf velocity = splat(1), error_rate = splat(0), keep = splat(1);
    const bool driven = p->tempered && (p->row[0].spring || p->row[0].type == PL_ROW_DRIVE);
    if (driven) {
        velocity = at->temper->spring.velocity[!pull];
        error_rate = at->temper->spring.error_rate[!pull];
        keep = velocity; // 1 - what gives
    } else if (pull) {
        velocity = splat((near_real)call->rigid.velocity);
        error_rate = splat((near_real)call->rigid.error);
        keep = splat((near_real)(1 - call->rigid.impulse));
    }
    vf wrong[3], total[3];
    for (int i = 0; i < n; ++i) {
        wrong[i] = rate(&r[i], a, b);
    }
    if (n > 1 && pull && !first && !driven && p->row[0].form == PL_FORM_POINT_X) {
        add_arc(wrong, a->w, splat((near_real)call->h), r[0].wa, r[1].wa);
        add_arc(wrong, b->w, splat((near_real)call->h), r[0].wb, r[1].wb);
    }
    vf error[3], kept[3];
    for (int i = 0; i < n; ++i) {
        error[i] = r[i].error;
        kept[i] = keep;
    }
    if (n > 1 && pull && !driven && p->row[0].form == PL_FORM_POINT_X) {
        hold_back(r, a, b, error, kept, splat((near_real)(PL_CLOSES / call->rigid.error)),
                  splat((near_real)call->h));
    }
    for (int i = 0; i < n; ++i) {
        if (pull || driven) {
            wrong[i] = velocity * wrong[i] + error_rate * error[i];
        }
        total[i] = kept[i] * r[i].impulse;
        if (pull && !driven) {
            total[i] += (splat(1) - kept[i]) * (at->c->lag * at->c->spared) * r[i].start;
        }
        if (driven) {
            wrong[i] -= at->temper->spring.before[!pull] * at->temper->before[i];
            vf lag = at->temper->lag[i];
            if (pull) {
                lag = at->c->lag * r[i].start;
            }
            total[i] += (splat(1) - keep) * lag;
        }
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

// A block that yields or has a bound does not answer.
WIDE_INLINE bool is_answered(const pl_joint_pattern *p, int i)
{
    return p->row[i].type == PL_ROW_LEAST && p->block > 0 && p->row[0].type == PL_ROW_EQUAL &&
           !p->tempered;
}

// Motors and springs first: what must hold has the last word.
WIDE_INLINE void solve_rows(const parts *at, const pl_joint_pattern *p, const pl_joint_call *call,
                            const bool pull, const bool first, body *a, body *b)
{
    for (int i = p->count - 1; i >= p->block; --i) {
        if (!is_answered(p, i)) {
            solve_single(at, p, i, call, pull, first, a, b);
        }
    }
    switch (p->block) {
    case 1:
        solve_block(at, p, 1, call, pull, first, a, b);
        break;
    case 2:
        solve_block(at, p, 2, call, pull, first, a, b);
        break;
    case 3:
        solve_block(at, p, 3, call, pull, first, a, b);
        break;
    default:
        break;
    }
    for (int i = p->count - 1; i >= p->block; --i) {
        if (is_answered(p, i)) {
            solve_limit(at, p, i, call, pull, first, a, b);
        }
    }
}

// Eight doubles still leave room for all of it in one frame.
#if PL_WIDTH > 8
#define SWEEP_PART WIDE_PART
#else
#define SWEEP_PART WIDE_INLINE
#endif

SWEEP_PART void solve_bundle(const parts *at, const pl_joint_pattern *p, const pl_joint_call *call,
                             const bool pull, const bool first, body *a, body *b)
{
    solve_rows(at, p, call, pull, first, a, b);
}

WIDE_INLINE bool has_springs(const pl_joint_pattern *p)
{
    bool any = false;
    for (int i = 0; i < p->count; ++i) {
        any |= p->row[i].spring != PL_SPRING_NONE;
    }
    return any;
}

static void fill_spring(oscillator *to, int lane, const pl_row *from, real mass, real h,
                        uint32_t degree)
{
    const pl_oscillator o = pl_joint_oscillator(from, mass, h, degree);
    for (int i = 0; i < 2; ++i) {
        to->velocity[i][lane] = (near_real)o.half[i].velocity;
        to->error_rate[i][lane] = (near_real)o.half[i].error;
        to->before[i][lane] = (near_real)o.half[i].before;
    }
}

// Factors of springs in newtons, which follow the mass that they meet.
static void tune_springs(const parts *at, const pl_joint_pattern *p, const pl_joint_call *call,
                         uint32_t k)
{
    const pl_joint_lane *lanes = &call->lanes[(size_t)k * PL_WIDTH];
    for (int i = p->block; i < p->count; ++i) {
        single *s = &at->singles[i - p->block];
        for (int n = 0; n < PL_WIDTH && p->row[i].spring == PL_SPRING_NEWTONS; ++n) {
            if (lanes[n].joint != PL_NONE) {
                const pl_joint *j = &call->joints[lanes[n].joint];
                pl_row told = { .type = PL_ROW_EQUAL };
                pl_row_soften(&told, &j->desc, j->spring_mass);
                fill_spring(&s->spring, n, &told, (real)s->mass[n], call->h, j->degree);
            }
        }
    }
}

// Rows where the bodies are, of bundle k.
WIDE_INLINE momentum remake(const parts *at, const pl_joint_pattern *p, const pl_joint_call *call,
                            uint32_t k, const body *a, const body *b)
{
    const momentum due = make_rows(at, p, a, b);
    if (p->newtons) {
        tune_springs(at, p, call, k);
    }
    return due;
}

// What springs go by from the start of a substep on: how fast they are.
WIDE_INLINE void note_springs(const parts *at, const pl_joint_pattern *p, const body *a,
                              const body *b)
{
    for (int i = 0; i < p->count; ++i) {
        const row *r = &at->rows[i];
        if (!p->row[i].spring) {
            continue;
        }
        const vf v = rate(r, a, b);
        if (i < p->block) {
            at->temper->before[i] = v;
        } else {
            at->singles[i - p->block].before = v;
        }
    }
}

// The same from where the places have moved on; `old`: errors before.
WIDE_INLINE void turn_springs(const parts *at, const pl_joint_pattern *p, const vf *old,
                              const pl_joint_call *call)
{
    const vf rate_of = splat((near_real)(1 / call->h));
    for (int i = 0; i < p->count; ++i) {
        const row *r = &at->rows[i];
        if (!p->row[i].spring) {
            continue;
        }
        const vf u = (r->error - old[i]) * rate_of, lag = r->impulse - at->c->lag * r->start;
        if (i < p->block) {
            at->temper->before[i] = u;
            at->temper->lag[i] = lag;
        } else {
            at->singles[i - p->block].before = u;
            at->singles[i - p->block].lag = lag;
        }
    }
}

// Where bodies have moved: rows of now, and what comes behind the drift of what turns.
SWEEP_PART void move_on(const parts *at, const pl_joint_pattern *p, const pl_joint_call *call,
                        uint32_t k, body *a, body *b)
{
    const bundle *c = at->c;
    const momentum owed = c->owed;
    vf old[PL_JOINT_ROWS];
    for (int i = 0; i < p->count; ++i) {
        old[i] = at->rows[i].error;
    }
    gather_body(a, call, at->a);
    gather_body(b, call, at->b);
    const momentum due = remake(at, p, call, k, a, b);
    give(a, b, &owed, c->behind_a, c->behind_b);
    give(a, b, &due, splat(1), splat(1));
    turn_springs(at, p, old, call);
}

// Before the drift: what is owed, but for the share that comes behind.
WIDE_INLINE void begin_half(const parts *at, const pl_joint_pattern *p, const pl_joint_call *call,
                            body *a, body *b)
{
    bundle *c = at->c;
    const uint32_t end = call->dynamic_slots;
    for (int i = 0; i < PL_WIDTH; ++i) {
        c->behind_a[i] = pl_joint_behind(call->kicked, end, at->a[i]);
        c->behind_b[i] = pl_joint_behind(call->kicked, end, at->b[i]);
        c->lag[i] = pl_joint_lag(call->kicked, end, at->a[i], at->b[i]);
    }
    give(a, b, &c->owed, splat(1) - c->behind_a, splat(1) - c->behind_b);
    for (int i = 0; i < p->count; ++i) {
        at->rows[i].start = at->rows[i].impulse;
    }
}

WIDE_INLINE void sweep_bundle(const pl_joint_call *call, uint32_t k, const pl_joint_pattern *p,
                              const bool pull, const bool first)
{
    parts at = open(call, k, p);
    bundle *c = at.c;
    body a, b;
    if (first && !pull) {
        move_on(&at, p, call, k, &a, &b);
    } else {
        gather_velocity(&a, call, at.a, c->inertia_a);
        gather_velocity(&b, call, at.b, c->inertia_b);
    }
    if (first && pull) {
        begin_half(&at, p, call, &a, &b);
    }
    solve_bundle(&at, p, call, pull, first, &a, &b);
    if (!pull && !first) {
        note_springs(&at, p, &a, &b);
    }
    scatter_velocity(&a, call, at.a);
    scatter_velocity(&b, call, at.b);
}

// These patterns are known to the compiler, which makes a kernel of its own of each: bare hinges, and hinges with
// limits and a motor, such as ragdolls have.
static const pl_joint_pattern bare_pattern = {
    .count = 2,
    .block = 2,
    .bare = true,
    .row = { { .index = 0, .form = PL_FORM_POINT_X, .type = PL_ROW_EQUAL },
             { .index = 1, .form = PL_FORM_POINT_Y, .type = PL_ROW_EQUAL } },
};

static const pl_joint_pattern limited_pattern = {
    .count = 5,
    .block = 2,
    .row = { { .index = 0, .form = PL_FORM_POINT_X, .type = PL_ROW_EQUAL },
             { .index = 1, .form = PL_FORM_POINT_Y, .type = PL_ROW_EQUAL },
             { .index = 3, .form = PL_FORM_ANGLE, .type = PL_ROW_LEAST },
             { .index = 4, .form = PL_FORM_ANGLE, .type = PL_ROW_LEAST },
             { .index = 5, .form = PL_FORM_ANGLE, .type = PL_ROW_DRIVE } },
};

// Whether the kernels would do the same for both.
WIDE_INLINE bool is_alike(const pl_joint_pattern *p, const pl_joint_pattern *q)
{
    return p->count == q->count && p->block == q->block && p->bare == q->bare &&
           p->tempered == q->tempered && memcmp(p->row, q->row, sizeof p->row) == 0;
}

SWEEP_PART void sweep_bare(const pl_joint_call *call, uint32_t k, const bool pull, const bool first)
{
    sweep_bundle(call, k, &bare_pattern, pull, first);
}

SWEEP_PART void sweep_limited(const pl_joint_call *call, uint32_t k, const bool pull,
                              const bool first)
{
    sweep_bundle(call, k, &limited_pattern, pull, first);
}

WIDE_PART void sweep_any(const pl_joint_call *call, uint32_t k, const bool pull, const bool first)
{
    sweep_bundle(call, k, &call->patterns[call->bundles[k].pattern], pull, first);
}

WIDE_INLINE void sweep(const pl_joint_call *call, const bool pull, const bool first)
{
    for (uint32_t k = call->first; k < call->end; ++k) {
        const pl_joint_pattern *p = &call->patterns[call->bundles[k].pattern];
        if (p->bare) {
            sweep_bare(call, k, pull, first);
        } else if (is_alike(p, &limited_pattern)) {
            sweep_limited(call, k, pull, first);
        } else {
            sweep_any(call, k, pull, first);
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

static void fill_row(const parts *at, const pl_joint_pattern *p, int i, int lane,
                     const pl_rows *rows, plumb_vec2 apart, real h, uint32_t degree)
{
    const pl_row *from = &rows->row[p->row[i].index];
    const bool length = p->row[i].form == PL_FORM_LENGTH;
    row *r = &at->rows[i];
    source *s = &at->sources[i];
    r->nx[lane] = (near_real)from->bx, r->ny[lane] = (near_real)from->by;
    r->wa[lane] = (near_real)from->aw, r->wb[lane] = (near_real)from->bw;
    real along = apart.x * from->bx + apart.y * from->by;
    bool flipped = along < 0 || (along == 0 && from->bx < 0);
    s->nx[lane] = !length ? (near_real)from->bx : flipped ? (near_real)-1 : (near_real)1;
    s->ny[lane] = (near_real)from->by;
    s->offset[lane] =
        (near_real)(p->row[i].form == PL_FORM_ANGLE ? from->error : from->error - along);
    if (i < p->block) {
        return;
    }
    single *e = &at->singles[i - p->block];
    e->most[lane] = (near_real)(from->most * h);
    e->speed[lane] = (near_real)from->speed;
    if (p->row[i].spring == PL_SPRING_HERTZ) {
        fill_spring(&e->spring, lane, from, 0, h, degree);
    }
}

static void fill_temper(temper *t, int lane, const pl_rows *rows, real h, uint32_t degree)
{
    fill_spring(&t->spring, lane, &rows->row[0], 0, h, degree); // none in newtons: plan.c
    t->most[lane] = (near_real)(rows->block_most * h);
}

static void fill_lane(const parts *at, const pl_joint_pattern *p, int lane, const pl_joint *j,
                      const pl_rows *rows, real h)
{
    const pl_joint_pose *a = &j->pose_a, *b = &j->pose_b;
    plumb_vec2 apart = pl_joint_apart(a, b);
    for (int i = 0; i < p->count; ++i) {
        at->rows[i].impulse[lane] = (near_real)j->impulse[p->row[i].index];
        fill_row(at, p, i, lane, rows, apart, h, j->degree);
    }
    if (p->row[0].form == PL_FORM_POINT_X) {
        // What B's anchor is held to, seen from A: the anchor, or a target beside it.
        at->c->ra_x[lane] = (near_real)(a->rx + apart.x - rows->row[0].error);
        at->c->ra_y[lane] = (near_real)(a->ry + apart.y - rows->row[1].error);
    }
    if (p->tempered) {
        fill_temper(at->temper, lane, rows, h, j->degree);
    }
}

// What all joints have, and bare ones nothing besides.
WIDE_INLINE void fill_start(const parts *at, const pl_joint_start *starts, const bool bare)
{
    const near_real *from[PL_WIDTH];
    vf r[8];
    for (int i = 0; i < PL_WIDTH; ++i) {
        from[i] = starts[i].arm_a;
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

typedef struct pull {
    vf a, b; // [N m s]
} pull_of_joint;

// Impulse times arm, of A and of B.
WIDE_INLINE pull_of_joint pulls(const parts *at, const pl_joint_pattern *p)
{
    vf x = splat(0), y = splat(0);
    for (int i = 0; i < p->count; ++i) {
        x += at->rows[i].nx * at->rows[i].impulse;
        y += at->rows[i].ny * at->rows[i].impulse;
    }
    const bundle *c = at->c;
    return (pull_of_joint){ -(x * c->ra_x + y * c->ra_y), x * c->rb_x + y * c->rb_y };
}

WIDE_INLINE bool is_tense(const parts *at, const pl_joint_pattern *p, const pl_joint_call *call)
{
    const pull_of_joint pull = pulls(at, p);
    const vf share = splat((near_real)call->h), free = splat((near_real)0.5);
    return any((pull.a * share * at->c->inertia_a > free) |
               (pull.b * share * at->c->inertia_b > free));
}

static void stiffen(const pl_joint_call *call)
{
    for (uint32_t k = call->first; k < call->end; ++k) {
        const pl_joint_pattern *p = &call->patterns[call->bundles[k].pattern];
        parts at = open(call, k, p);
        if (!is_tense(&at, p, call)) {
            continue;
        }
        const pull_of_joint pull = pulls(&at, p);
        for (int i = 0; i < PL_WIDTH; ++i) {
            pl_joint_stiffen(&call->bodies[at.a[i]], pull.a[i], (near_real)call->h,
                             at.c->inertia_a[i]);
            pl_joint_stiffen(&call->bodies[at.b[i]], pull.b[i], (near_real)call->h,
                             at.c->inertia_b[i]);
        }
    }
}

// Bundles of which a body has more inertia than when they were filled.
static void refill(const pl_joint_call *call)
{
    for (uint32_t k = call->first; k < call->end; ++k) {
        const pl_joint_pattern *p = &call->patterns[call->bundles[k].pattern];
        parts at = open(call, k, p);
        body a, b;
        gather_body(&a, call, at.a);
        gather_body(&b, call, at.b);
        if (any((a.inv_inertia < at.c->inertia_a) | (b.inv_inertia < at.c->inertia_b))) {
            at.c->inertia_a = a.inv_inertia;
            at.c->inertia_b = b.inv_inertia;
            remake(&at, p, call, k, &a, &b);
        }
    }
}

static void fill(const pl_joint_call *call)
{
    const uint32_t k = call->first;
    const pl_joint_pattern *p = &call->patterns[call->bundles[k].pattern];
    parts at = open(call, k, p);
    const pl_joint_lane *lanes = &call->lanes[(size_t)k * PL_WIDTH];
    memset(at.c, 0, record_size(p));
    fill_start(&at, call->starts, p->bare);
    for (int i = 0; i < PL_WIDTH; ++i) {
        at.c->spared[i] =
            pl_joint_spared(lanes[i].joint != PL_NONE ? call->marks[lanes[i].joint].degree : 1);
    }
    for (int i = 0; i < PL_WIDTH && !p->bare; ++i) {
        if (lanes[i].joint != PL_NONE) {
            fill_lane(&at, p, i, &call->joints[lanes[i].joint], &call->rows[i], call->h);
        }
    }
    body a, b;
    gather_body(&a, call, at.a);
    gather_body(&b, call, at.b);
    at.c->inertia_a = a.inv_inertia;
    at.c->inertia_b = b.inv_inertia;
    remake(&at, p, call, k, &a, &b);
    at.c->owed = (momentum){ .ax = splat(0) };
    if (has_springs(p)) {
        note_springs(&at, p, &a, &b);
    }
    if (is_tense(&at, p, call)) {
        *call->tense = true;
    }
}

static void warm_start(const pl_joint_call *call)
{
    for (uint32_t k = call->first; k < call->end; ++k) {
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

// The reaction of one lane in double, and no more than a real holds: see react_beyond in finish.c.
static void hold_reaction(const parts *at, int count, int i, const place *now, pl_joint *j)
{
    double x = 0, y = 0, turn = 0;
    for (int m = 0; m < count; ++m) {
        const row *r = &at->rows[m];
        double push = (double)pl_held((double)r->impulse[i]) / (double)j->h;
        x += (double)r->nx[i] * push;
        y += (double)r->ny[i] * push;
        turn += (double)r->wb[i] * push;
    }
    j->force = plumb_v2(pl_held(x), pl_held(y));
    j->torque = pl_held(turn - ((double)now->rb_x[i] * y - (double)now->rb_y[i] * x));
}

// J^T impulse on B; what turns is told about B's anchor. [N s], [N m s]
WIDE_INLINE void react(const parts *at, const pl_joint_pattern *p, const pl_joint_call *call,
                       place *now, vf sum[3])
{
    body a, b;
    gather_body(&a, call, at->a);
    gather_body(&b, call, at->b);
    *now = place_now(at->c, &a, &b);
    vf x = splat(0), y = splat(0), w = splat(0);
    for (int i = 0; i < p->count; ++i) {
        const row *r = &at->rows[i];
        x += r->nx * r->impulse;
        y += r->ny * r->impulse;
        w += r->wb * r->impulse;
    }
    sum[0] = x, sum[1] = y;
    sum[2] = w - (now->rb_x * y - now->rb_y * x);
}

static void tally(const pl_joint_call *call)
{
    for (uint32_t k = call->first; k < call->end; ++k) {
        const pl_joint_pattern *p = &call->patterns[call->bundles[k].pattern];
        if ((p->variant & PL_JOINT_WATCHED) != 0) {
            parts at = open(call, k, p);
            place now;
            vf sum[3];
            react(&at, p, call, &now, sum);
            // What J's turning owes is not given yet: it is paid to what the next substep begins with.
            bundle *c = at.c;
            const momentum *owed = &c->owed;
            c->sum_x += sum[0] - owed->bx;
            c->sum_y += sum[1] - owed->by;
            c->sum_w += sum[2] - (owed->bw - (now.rb_x * owed->by - now.rb_y * owed->bx));
        }
    }
}

static void store_all(const pl_joint_call *call)
{
    const vf inv_h = splat((near_real)(1 / call->h));
    for (uint32_t k = call->first; k < call->end; ++k) {
        const pl_joint_pattern *p = &call->patterns[call->bundles[k].pattern];
        const pl_joint_lane *lanes = &call->lanes[(size_t)k * PL_WIDTH];
        parts at = open(call, k, p);
        for (int i = 0; i < PL_WIDTH && k + 1 < call->end; ++i) {
            if (lanes[PL_WIDTH + i].joint != PL_NONE) {
                __builtin_prefetch(&call->joints[lanes[PL_WIDTH + i].joint], 1);
            }
        }
        place now;
        vf sum[3];
        react(&at, p, call, &now, sum);
        vf x = sum[0] * inv_h, y = sum[1] * inv_h, w = sum[2] * inv_h;
        const vf marked =
            (x - x) + (y - y) + (w - w); // 0, or no number where one of them is not finite
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
            if (marked[i] != 0) {
                hold_reaction(&at, p->count, i, &now, j);
            }
            if ((p->variant & PL_JOINT_WATCHED) != 0) {
                j->step_impulse = plumb_v2(at.c->sum_x[i], at.c->sum_y[i]);
                j->step_turn = at.c->sum_w[i];
            }
        }
    }
}

const pl_joint_kernels PL_WIDE_NAME(pl_joint_kernels) = {
    .width = PL_WIDTH,
    .record_size = record_size,
    .fill = fill,
    .stiffen = stiffen,
    .refill = refill,
    .warm_start = warm_start,
    .pull_first = pull_first,
    .pull = pull,
    .relax_first = relax_first,
    .relax = relax,
    .tally = tally,
    .store = store_all,
    .measure = PL_WIDE_NAME(pl_joint_measure),
};
