// expect.c - expect{} and exact{}: what the author says must be true, measured while the scene
// runs. A line is due at one time, in a window, after every step, or (when it names no time) at the
// end. Each criterion gives a value, a limit and a ratio (1: just at the limit); the line keeps the
// worst one.
//
// energy_drift = |E - E0| / (largest kinetic energy so far): the same wherever the origin lies.
// momentum_drift = |p - p0| / (largest sum of m |v| so far), for scenes without outside forces.
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "internal.h"

#define LIST             (&sc_list_expect)
#define HAS(def, member) SC_GIVEN(LIST, (def), sc_expect_def, member)

// ---------------------------------------------------------------------------------- registering

static void check_expect(scene *s, const sc_site *site, const sc_expect_def *d)
{
    bool window = HAS(d, from) || HAS(d, till);
    if (HAS(d, at) + d->always + window > 1) {
        sc_raise(s, SCENE_E_CONFLICT, site, HAS(d, at) ? "at" : "always", 0, NULL,
                 "expect{} takes one of 'at', 'always' and 'from'/'till'");
    }
    if (HAS(d, from) && HAS(d, till) && d->from > d->till) {
        sc_raise(s, SCENE_E_RANGE, site, "till", 0, NULL, "'till' of expect{} is before 'from'");
    }
    bool body_only = HAS(d, position) || HAS(d, x) || HAS(d, y) || HAS(d, vx) || HAS(d, vy) ||
                     HAS(d, angle) || HAS(d, spin) || HAS(d, speed);
    if (body_only && d->body[0] == 0) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL,
                 "expect{} needs 'body' to know whose position, angle or velocity is meant");
    }
    if (HAS(d, position) && !HAS(d, tolerance)) {
        sc_raise(s, SCENE_E_MISSING, site, "position", 0, NULL,
                 "expect{} with 'position' needs 'tolerance'");
    }
    if (HAS(d, score) != HAS(d, value)) {
        sc_raise(s, SCENE_E_MISSING, site, HAS(d, score) ? "score" : "value", 0, NULL,
                 "expect{} needs 'score' and 'value' together");
    }
    bool any = body_only || HAS(d, max_speed) || HAS(d, min_speed) || HAS(d, max_spin) ||
               HAS(d, max_penetration) || HAS(d, energy_drift) || HAS(d, momentum_drift) ||
               HAS(d, count) || HAS(d, value) || HAS(d, test);
    if (!any) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL,
                 "expect{} needs something to measure, such as max_penetration = 0.005");
    }
    if (HAS(d, tolerance) && !body_only && !HAS(d, count) && !HAS(d, value)) {
        sc_raise(s, SCENE_E_UNUSED, site, "tolerance", 0, NULL,
                 "'tolerance' of expect{} is not used");
    }
}

static void widen(sc_expect_def *d, double range[2])
{
    if (range[0] == range[1]) {
        range[0] -= d->tolerance;
        range[1] += d->tolerance;
    }
}

void sc_build_expect(scene *s, const sc_site *site, int table)
{
    sc_need_world(s);
    sc_expect_def def = { .test = LUA_NOREF };
    sc_read(s, site, LIST, table, &def);
    check_expect(s, site, &def);
    if (!s->building) {
        sc_raise(s, SCENE_E_STATE, site, NULL, 0, NULL,
                 "expect{} belongs to the script, not to a handler");
    }
    sc_expect *e = SC_PUSH(s, s->expects);
    *e = (sc_expect){ .def = def, .line = site->line, .ratio = -1, .unit = "1" };
    s->wants_energy |= HAS(&def, energy_drift) || HAS(&def, momentum_drift);
}

static int lua_expect(lua_State *L)
{
    scene *s = sc_of(L);
    sc_site site = sc_here(s, "expect");
    if (lua_gettop(L) != 1 || lua_type(L, 1) != LUA_TTABLE) {
        sc_raise(s, SCENE_E_TYPE, &site, NULL, 0, NULL, "expect takes one table: expect{...}");
    }
    sc_build_expect(s, &site, 1);
    return 0;
}

static int lua_exact(lua_State *L)
{
    scene *s = sc_of(L);
    sc_site site = sc_here(s, "exact");
    if (lua_gettop(L) != 1 || lua_type(L, 1) != LUA_TTABLE) {
        sc_raise(s, SCENE_E_TYPE, &site, NULL, 0, NULL, "exact takes one table: exact{...}");
    }
    sc_exact_def def = { 0 };
    sc_read(s, &site, &sc_list_exact, 1, &def);
    bool any = false;
    for (int i = 0; i < sc_list_exact.count; i++) {
        any |= sc_list_exact.rows[i].kind == SC_FUNCTION && ((def.present >> i) & 1) != 0;
    }
    if (!any) {
        sc_raise(s, SCENE_E_MISSING, &site, NULL, 0, NULL,
                 "exact{} needs a function of time, such as y = function(t) ... end");
    }
    sc_grow(s, &s->exacts, s->exact_count, &s->exact_capacity, sizeof *s->exacts);
    s->exacts[s->exact_count].def = def;
    s->exacts[s->exact_count].line = site.line;
    s->exact_count++;
    return 0;
}

void sc_open_expect(lua_State *L)
{
    lua_register(L, "expect", lua_expect);
    lua_register(L, "exact", lua_exact);
}

// ------------------------------------------------------------------------------------ measuring

/// One measured criterion.
typedef struct sample {
    char quantity[2 * SC_NAME_SIZE];
    const char *unit;
    double measured, limit, ratio;
} sample;

// Keeps the worst of the line so far, and the verdict.
static void keep(scene *s, sc_expect *e, const sample *m)
{
    double ratio = isnan(m->measured) || isnan(m->ratio) ? DBL_MAX : m->ratio;
    if (ratio < e->ratio) {
        return;
    }
    e->ratio = ratio;
    e->measured = m->measured;
    e->limit = m->limit;
    e->unit = m->unit;
    e->time = scene_time(s);
    memcpy(e->quantity, m->quantity, sizeof e->quantity);
}

static void name_quantity(sample *m, const char *body, const char *what)
{
    snprintf(m->quantity, sizeof m->quantity, "%s%s%s", body, body[0] != 0 ? "." : "", what);
}

static void at_most(scene *s, sc_expect *e, const char *body, const char *what, const char *unit,
                    double v, double limit)
{
    sample m = { .unit = unit, .measured = v, .limit = limit };
    m.ratio = limit > 0 ? v / limit : v <= limit ? 1 : DBL_MAX / 2;
    name_quantity(&m, body, what);
    keep(s, e, &m);
}

static void at_least(scene *s, sc_expect *e, const char *body, const char *what, const char *unit,
                     double v, double limit)
{
    sample m = { .unit = unit, .measured = v, .limit = limit };
    m.ratio = v >= limit ? (v > 0 ? limit / v : 1) : DBL_MAX / 2;
    name_quantity(&m, body, what);
    keep(s, e, &m);
}

static void within(scene *s, sc_expect *e, const char *body, const char *what, const char *unit,
                   double v, const double range[2])
{
    sample m = { .unit = unit, .measured = v };
    double middle = isinf(range[0]) || isinf(range[1]) ? v : (range[0] + range[1]) / 2;
    double half = (range[1] - range[0]) / 2;
    m.limit = fabs(v - range[0]) < fabs(v - range[1]) ? range[0] : range[1];
    bool inside = v >= range[0] && v <= range[1];
    m.ratio = inside ? (half > 0 ? fmin(fabs(v - middle) / half, 1) : 1) : 1 + fabs(v - m.limit);
    name_quantity(&m, body, what);
    keep(s, e, &m);
}

static void measure_body(scene *s, sc_expect *e, const sc_body *b)
{
    const sc_expect_def *d = &e->def;
    const char *name = b->def.name;
    plumb_vec2 p = plumb_body_position(s->world, b->entity);
    plumb_vec2 v = plumb_body_velocity(s->world, b->entity);
    double px = (double)p.x, py = (double)p.y, vx = (double)v.x, vy = (double)v.y;
    double speed = sqrt(vx * vx + vy * vy);
    double spin = (double)plumb_body_angular_velocity(s->world, b->entity);
    bool own = d->body[0] != 0; // else only limits on every moving body are meant
    if (own && HAS(d, position)) {
        double dx = px - d->position[0], dy = py - d->position[1];
        at_most(s, e, name, "distance from position", "m", sqrt(dx * dx + dy * dy), d->tolerance);
    }
    const struct {
        bool given;
        const char *what, *unit;
        double value;
        const double *range;
    } ranges[] = {
        { HAS(d, x), "x", "m", px, d->x },
        { HAS(d, y), "y", "m", py, d->y },
        { HAS(d, vx), "vx", "m/s", vx, d->vx },
        { HAS(d, vy), "vy", "m/s", vy, d->vy },
        { HAS(d, angle), "angle", "rad", (double)plumb_body_angle(s->world, b->entity), d->angle },
        { HAS(d, spin), "spin", "rad/s", spin, d->spin },
        { HAS(d, speed), "speed", "m/s", speed, d->speed },
    };
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++) {
        if (ranges[i].given) {
            double range[2] = { ranges[i].range[0], ranges[i].range[1] };
            widen(&e->def, range);
            within(s, e, name, ranges[i].what, ranges[i].unit, ranges[i].value, range);
        }
    }
    if (HAS(d, max_speed)) {
        at_most(s, e, name, "speed", "m/s", speed, d->max_speed);
    }
    if (HAS(d, min_speed)) {
        at_least(s, e, name, "speed", "m/s", speed, d->min_speed);
    }
    if (HAS(d, max_spin)) {
        at_most(s, e, name, "spin", "rad/s", fabs(spin), d->max_spin);
    }
}

static void measure_bodies(scene *s, sc_expect *e)
{
    const sc_expect_def *d = &e->def;
    int count = 0;
    for (int i = 0; i < s->bodies.count; i++) {
        const sc_body *b = s->bodies.items[i];
        if (d->body[0] == 0 ? b->def.type == 0 : sc_name_matches(d->body, b->def.name)) {
            measure_body(s, e, b);
            count++;
        }
    }
    if (HAS(d, count)) {
        double range[2] = { d->count[0], d->count[1] };
        widen(&e->def, range);
        within(s, e, d->body, "count", "1", d->body[0] == 0 ? s->bodies.count : count, range);
    } else if (d->body[0] != 0 && count == 0) {
        sample m = { .unit = "1", .measured = 0, .limit = 1, .ratio = DBL_MAX };
        name_quantity(&m, d->body, "bodies left");
        keep(s, e, &m);
    }
}

static void measure_drift(scene *s, sc_expect *e)
{
    const sc_expect_def *d = &e->def;
    if (!HAS(d, energy_drift) && !HAS(d, momentum_drift)) {
        return;
    }
    plumb_energy now = plumb_world_energy(s->world);
    if (HAS(d, energy_drift)) {
        double change = fabs(now.kinetic + now.potential - s->energy_start);
        at_most(s, e, "", "energy_drift", "1", change == 0 ? 0 : change / s->energy_scale,
                d->energy_drift);
    }
    if (HAS(d, momentum_drift)) {
        double dx = now.momentum_x - s->momentum_start[0],
               dy = now.momentum_y - s->momentum_start[1];
        double change = sqrt(dx * dx + dy * dy);
        at_most(s, e, "", "momentum_drift", "1", change == 0 ? 0 : change / s->momentum_scale,
                d->momentum_drift);
    }
}

// test = function() return ok [, measured [, limit]] end
static void measure_test(scene *s, sc_expect *e)
{
    lua_State *L = s->L;
    int index = (int)(e - s->expects.items);
    lua_rawgeti(L, LUA_REGISTRYINDEX, e->def.test);
    sc_call(s, 0, 3);
    e = &s->expects.items[index];
    bool good = lua_toboolean(L, -3) != 0;
    sample m = { .quantity = "test", .unit = "1", .ratio = good ? 1 : DBL_MAX / 2 };
    m.measured = lua_type(L, -2) == LUA_TNUMBER ? lua_tonumber(L, -2) : good;
    m.limit = lua_type(L, -1) == LUA_TNUMBER ? lua_tonumber(L, -1) : 1;
    if (isnan(m.measured)) {
        m.measured = 0; // the verdict is the author's
    }
    lua_pop(L, 3);
    keep(s, e, &m);
}

static void describe(sc_expect *e)
{
    const char *relation = e->status == SCENE_EXPECT_PASSED ? "ok, limit" : "breaks limit";
    snprintf(e->description, sizeof e->description, "%s %.6g %s (%s %.6g %s) at %.6g s",
             e->quantity, e->measured, e->unit, relation, e->limit, e->unit, e->time);
}

static void evaluate(scene *s, sc_expect *e)
{
    const sc_expect_def *d = &e->def;
    int index = (int)(e - s->expects.items);
    measure_bodies(s, e);
    if (HAS(d, max_penetration)) {
        at_most(s, e, "", "max_penetration", "m",
                (double)plumb_world_stats(s->world).max_penetration, d->max_penetration);
    }
    measure_drift(s, e);
    if (HAS(d, value)) {
        const sc_score *score = sc_score_find(s, d->score);
        double range[2] = { d->value[0], d->value[1] };
        widen(&e->def, range);
        within(s, e, d->score, "score", "1", score == NULL ? 0 : score->value, range);
    }
    if (HAS(d, test)) {
        measure_test(s, e);
        e = &s->expects.items[index];
    }
    e->status = e->ratio <= 1 ? SCENE_EXPECT_PASSED : SCENE_EXPECT_FAILED;
    describe(e);
}

// ---------------------------------------------------------------------------------------- timing

// Largest kinetic energy and sum of m |v| so far: what drifts are measured against.
static void track_scales(scene *s)
{
    plumb_energy now = plumb_world_energy(s->world);
    s->energy_scale = fmax(s->energy_scale, now.kinetic);
    plumb_body_span span = plumb_world_bodies(s->world);
    double sum = 0;
    for (int i = 0; i < span.dynamic_count; i++) {
        double vx = (double)span.vx[i], vy = (double)span.vy[i];
        sum += span.inv_mass[i] > 0 ? sqrt(vx * vx + vy * vy) / (double)span.inv_mass[i] : 0;
    }
    s->momentum_scale = fmax(s->momentum_scale, sum);
}

void sc_expect_begin(scene *s)
{
    if (!s->wants_energy) {
        return;
    }
    plumb_energy now = plumb_world_energy(s->world);
    s->energy_start = now.kinetic + now.potential;
    s->momentum_start[0] = now.momentum_x;
    s->momentum_start[1] = now.momentum_y;
    track_scales(s);
}

void sc_expect_step(scene *s)
{
    double now = scene_time(s);
    double slack = 1e-9 * s->dt;
    if (s->wants_energy) {
        track_scales(s);
    }
    for (int i = 0; i < s->expects.count; i++) {
        sc_expect *e = &s->expects.items[i];
        const sc_expect_def *d = &e->def;
        if (HAS(d, at)) {
            if (!e->done && now >= d->at - 0.5 * s->dt) { // the step nearest to the time
                e->done = true;
                evaluate(s, e);
            }
        } else if (d->always || HAS(d, from) || HAS(d, till)) {
            bool open = (!HAS(d, from) || now >= d->from - slack) &&
                        (!HAS(d, till) || now <= d->till + slack);
            if (open && e->status != SCENE_EXPECT_FAILED) { // the first break is what is reported
                evaluate(s, e);
            }
        }
    }
}

void sc_expect_finish(scene *s)
{
    for (int i = 0; i < s->expects.count; i++) {
        sc_expect *e = &s->expects.items[i];
        const sc_expect_def *d = &e->def;
        bool timed = HAS(d, at) || d->always || HAS(d, from) || HAS(d, till);
        if (!timed && !e->done) {
            e->done = true;
            evaluate(s, e);
        } else if (e->status == SCENE_EXPECT_PENDING) {
            e->status = SCENE_EXPECT_NOT_REACHED;
            snprintf(e->description, sizeof e->description, "not reached: the run ended at %.6g s",
                     scene_time(s));
        }
    }
}
