// expect.c - expect{}: what the author says must be true, and when it is looked at: at
// one time, in a window, after every step, or (when it names no time) at the end; errors of exact{} whenever the form
// holds. What is measured is in expect_measure.c.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "internal.h"

#define LIST             (&sc_list_expect)
#define HAS(def, member) SC_GIVEN(LIST, (def), sc_expect_def, member)

// Criteria of joints, and of the sensors of a body.
static bool of_joints(const sc_expect_def *d)
{
    return HAS(d, joint_value) || HAS(d, reaction) || HAS(d, reaction_torque);
}

static bool of_sensors(const sc_expect_def *d)
{
    return HAS(d, visits) || HAS(d, inside);
}

// ---------------------------------------------------------------------------------- registering

// The kind of alarms that are meant is one.
static void check_alarm(scene *s, const sc_site *site, const sc_expect_def *d)
{
    bool known = false;
    for (int i = 0; i < PLUMB_ALARM_KINDS; i++) {
        known |= strcmp(d->alarm, plumb_alarm_name((plumb_alarm_kind)i)) == 0;
    }
    if (!known) {
        sc_raise(s, SCENE_E_RANGE, site, "alarm", 0, NULL,
                 "there is no alarm '%s': plumb help check lists them", d->alarm);
    }
    if (!HAS(d, alarms)) {
        sc_raise(s, SCENE_E_MISSING, site, "alarm", 0, NULL,
                 "expect{} with 'alarm' needs 'alarms', how many");
    }
}

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
                     HAS(d, angle) || HAS(d, spin) || HAS(d, speed) || HAS(d, temperature);
    if (body_only && d->body[0] == 0) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL,
                 "expect{} needs 'body' to know whose position, angle or velocity is meant");
    }
    if (of_joints(d) && d->joint[0] == 0) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL,
                 "expect{} needs 'joint' to know whose value or reaction is meant");
    }
    if (of_sensors(d) && d->body[0] == 0) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL,
                 "expect{} needs 'body' to know whose sensors are meant");
    }
    if (d->joint[0] != 0 && !of_joints(d) && !HAS(d, broken) && !HAS(d, max_joint_error)) {
        sc_raise(s, SCENE_E_UNUSED, site, "joint", 0, NULL, "'joint' of expect{} is not used");
    }
    if (HAS(d, position) && !HAS(d, tolerance)) {
        sc_raise(s, SCENE_E_MISSING, site, "position", 0, NULL,
                 "expect{} with 'position' needs 'tolerance'");
    }
    if (HAS(d, exact) && !HAS(d, tolerance)) {
        sc_raise(s, SCENE_E_MISSING, site, "exact", 0, NULL,
                 "expect{} with 'exact' needs 'tolerance'");
    }
    if (HAS(d, score) != HAS(d, value)) {
        sc_raise(s, SCENE_E_MISSING, site, HAS(d, score) ? "score" : "value", 0, NULL,
                 "expect{} needs 'score' and 'value' together");
    }
    if (HAS(d, alarm)) {
        check_alarm(s, site, d);
    }
    bool any = body_only || HAS(d, max_speed) || HAS(d, min_speed) || HAS(d, max_spin) ||
               HAS(d, max_penetration) || HAS(d, energy_drift) || HAS(d, momentum_drift) ||
               HAS(d, count) || HAS(d, value) || HAS(d, test) || of_joints(d) || of_sensors(d) ||
               HAS(d, broken) || HAS(d, max_joint_error) || HAS(d, exact) || HAS(d, alarms);
    if (!any) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL,
                 "expect{} needs something to measure, such as max_penetration = 0.005");
    }
    if (HAS(d, tolerance) && !body_only && !HAS(d, count) && !HAS(d, value) && !of_joints(d) &&
        !of_sensors(d) && !HAS(d, broken) && !HAS(d, exact) && !HAS(d, alarms)) {
        sc_raise(s, SCENE_E_UNUSED, site, "tolerance", 0, NULL,
                 "'tolerance' of expect{} is not used");
    }
}

void sc_build_expect(scene *s, const sc_site *site, int table)
{
    sc_need_world(s);
    sc_expect_def def = { .test = LUA_NOREF };
    sc_read(s, site, LIST, table, &def);
    check_expect(s, site, &def);
    if (HAS(&def, exact) && !HAS(&def, at) && !HAS(&def, from) && !HAS(&def, till)) {
        def.always = true; // whenever the form holds
    }
    if (!s->building) {
        sc_raise(s, SCENE_E_STATE, site, NULL, 0, NULL,
                 "expect{} belongs to the script, not to a handler");
    }
    sc_expect *e = SC_PUSH(s, s->expects);
    *e = (sc_expect){ .def = def, .line = site->line, .ratio = -1, .unit = "1" };
    s->wants_visits |= HAS(&def, visits);
    if (HAS(&def, alarms)) {
        plumb_world_set_watchdog(s->world, true);
    }
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
    sc_build_exact(s, &site, 1);
    return 0;
}

void sc_open_expect(lua_State *L)
{
    lua_register(L, "expect", lua_expect);
    lua_register(L, "exact", lua_exact);
}

// When somebody asks: an expectation that is always looked at is measured at every step.
const char *sc_expect_describe(sc_expect *e)
{
    const char *relation = e->status == SCENE_EXPECT_PASSED ? "ok, limit" : "breaks limit";
    if (e->status == SCENE_EXPECT_PENDING) {
        return "";
    }
    if (e->status == SCENE_EXPECT_NOT_REACHED) {
        snprintf(e->description, sizeof e->description, "not reached: the run ended at %.6g s",
                 e->time);
        return e->description;
    }
    bool plain = strcmp(e->unit, "1") == 0; // a number without a unit
    const char *gap = plain ? "" : " ", *unit = plain ? "" : e->unit;
    snprintf(e->description, sizeof e->description, "%s %.6g%s%s (%s %.6g%s%s) at %.6g s",
             e->quantity, e->measured, gap, unit, relation, e->limit, gap, unit, e->time);
    return e->description;
}

static void evaluate(scene *s, sc_expect *e)
{
    int index = (int)(e - s->expects.items);
    sc_measure(s, e);
    e = &s->expects.items[index]; // a test function may have moved the list
    e->status = e->ratio <= 1 ? SCENE_EXPECT_PASSED : SCENE_EXPECT_FAILED;
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
    s->energy_start = now.kinetic + now.potential + now.stored;
    s->momentum_start[0] = now.momentum_x;
    s->momentum_start[1] = now.momentum_y;
    track_scales(s);
}

static void count_alarms(scene *s)
{
    int count;
    const plumb_alarm *alarms = plumb_world_alarms(s->world, &count);
    for (int i = 0; i < count; i++) {
        s->alarms[alarms[i].kind]++;
    }
}

void sc_expect_step(scene *s)
{
    double now = scene_time(s);
    double slack = 1e-9 * s->dt;
    if (s->options.no_expect) {
        return;
    }
    if (s->wants_energy) {
        track_scales(s);
    }
    count_alarms(s);
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
            if (HAS(d, exact)) { // of a form the largest error is told, even beyond the limit
                open = open && sc_exact_holds(s, e->exact);
            } else if (!s->options.worst) { // else the first break
                open = open && e->status != SCENE_EXPECT_FAILED;
            }
            if (open) {
                evaluate(s, e);
            }
        }
    }
}

void sc_expect_finish(scene *s)
{
    for (int i = 0; i < s->expects.count && !s->options.no_expect; i++) {
        sc_expect *e = &s->expects.items[i];
        const sc_expect_def *d = &e->def;
        bool timed = HAS(d, at) || d->always || HAS(d, from) || HAS(d, till);
        if (!timed && !e->done) {
            e->done = true;
            evaluate(s, e);
        } else if (e->status == SCENE_EXPECT_PENDING) {
            e->status = SCENE_EXPECT_NOT_REACHED;
            e->time = scene_time(s);
        }
    }
}
