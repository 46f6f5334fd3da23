// expect_measure.c - what expect{} can measure: bodies, joints, sensors, counters, drifts. Each
// criterion gives a value, a limit and a ratio (1: just at the limit); the line keeps the worst one.
//
// energy_drift = |E - E0| / (largest kinetic energy so far): the same wherever the origin lies.
// momentum_drift = |p - p0| / (largest sum of m |v| so far), for scenes without outside forces.
// Cost: O(bodies or joints that are meant) a look.
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "internal.h"

#define HAS(def, member) SC_GIVEN(&sc_list_expect, (def), sc_expect_def, member)

static void widen(sc_expect_def *d, double range[2])
{
    if (range[0] == range[1]) {
        range[0] -= d->tolerance;
        range[1] += d->tolerance;
    }
}

/// One measured criterion.
typedef struct sample {
    const char *body, *what; // "" and what, or body.what
    const char *unit;
    double measured, limit, ratio;
} sample;

// Keeps the worst of the line so far, and the verdict. Only what is kept is named: that takes longer than to measure it.
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
    snprintf(e->quantity, sizeof e->quantity, "%s%s%s", m->body, m->body[0] != 0 ? "." : "",
             m->what);
}

static void at_most(scene *s, sc_expect *e, const char *body, const char *what, const char *unit,
                    double v, double limit)
{
    sample m = { body, what, unit, v, limit, 0 };
    m.ratio = limit > 0 ? v / limit : v <= limit ? 1 : DBL_MAX / 2;
    keep(s, e, &m);
}

static void at_least(scene *s, sc_expect *e, const char *body, const char *what, const char *unit,
                     double v, double limit)
{
    sample m = { body, what, unit, v, limit, 0 };
    m.ratio = v >= limit ? (v > 0 ? limit / v : 1) : DBL_MAX / 2;
    keep(s, e, &m);
}

static void within(scene *s, sc_expect *e, const char *body, const char *what, const char *unit,
                   double v, const double range[2])
{
    sample m = { body, what, unit, v, 0, 0 };
    double middle = isinf(range[0]) || isinf(range[1]) ? v : (range[0] + range[1]) / 2;
    double half = (range[1] - range[0]) / 2;
    m.limit = fabs(v - range[0]) < fabs(v - range[1]) ? range[0] : range[1];
    bool inside = v >= range[0] && v <= range[1];
    m.ratio = inside ? (half > 0 ? fmin(fabs(v - middle) / half, 1) : 1) : 1 + fabs(v - m.limit);
    keep(s, e, &m);
}

// What a body must have within a range.
enum { IN_X, IN_Y, IN_VX, IN_VY, IN_ANGLE, IN_SPIN, IN_SPEED, IN_TEMPERATURE, IN_COUNT };
#define RANGE(member, unit)                                                                        \
    {                                                                                              \
        offsetof(sc_expect_def, member), #member, unit                                             \
    }
static const struct {
    size_t offset; // of the range
    const char *what, *unit;
} body_ranges[IN_COUNT] = {
    [IN_X] = RANGE(x, "m"),           [IN_Y] = RANGE(y, "m"),
    [IN_VX] = RANGE(vx, "m/s"),       [IN_VY] = RANGE(vy, "m/s"),
    [IN_ANGLE] = RANGE(angle, "rad"), [IN_SPIN] = RANGE(spin, "rad/s"),
    [IN_SPEED] = RANGE(speed, "m/s"), [IN_TEMPERATURE] = RANGE(temperature, "K"),
};

// What an expectation asks of bodies, found once for all of them.
typedef struct asked {
    bool position, max_speed, min_speed, max_spin, count, ranges[IN_COUNT];
    bool any;
} asked;

static asked asked_of(const sc_expect_def *d)
{
    // Without a body only limits on every moving one are meant.
    asked a = { .position = d->body[0] != 0 && HAS(d, position),
                .max_speed = HAS(d, max_speed),
                .min_speed = HAS(d, min_speed),
                .max_spin = HAS(d, max_spin),
                .count = HAS(d, count) };
    a.any = a.position || a.max_speed || a.min_speed || a.max_spin;
    for (int i = 0; i < IN_COUNT; i++) {
        a.ranges[i] = sc_given(&sc_list_expect, d, body_ranges[i].offset);
        a.any |= a.ranges[i];
    }
    return a;
}

static void measure_body(scene *s, sc_expect *e, const asked *a, const sc_body *b)
{
    const sc_expect_def *d = &e->def;
    const char *name = b->def.name;
    plumb_vec2 p = plumb_body_position(s->world, b->entity);
    plumb_vec2 v = plumb_body_velocity(s->world, b->entity);
    double px = (double)p.x, py = (double)p.y, vx = (double)v.x, vy = (double)v.y;
    double speed = sqrt(vx * vx + vy * vy);
    double spin = (double)plumb_body_angular_velocity(s->world, b->entity);
    if (a->position) {
        double dx = px - d->position[0], dy = py - d->position[1];
        at_most(s, e, name, "distance from position", "m", sqrt(dx * dx + dy * dy), d->tolerance);
    }
    const double values[IN_COUNT] = { px,
                                      py,
                                      vx,
                                      vy,
                                      (double)plumb_body_angle(s->world, b->entity),
                                      spin,
                                      speed,
                                      (double)plumb_body_temperature(s->world, b->entity) };
    for (int i = 0; i < IN_COUNT; i++) {
        if (a->ranges[i]) {
            double range[2];
            memcpy(range, (const char *)d + body_ranges[i].offset, sizeof range);
            widen(&e->def, range);
            within(s, e, name, body_ranges[i].what, body_ranges[i].unit, values[i], range);
        }
    }
    if (a->max_speed) {
        at_most(s, e, name, "speed", "m/s", speed, d->max_speed);
    }
    if (a->min_speed) {
        at_least(s, e, name, "speed", "m/s", speed, d->min_speed);
    }
    if (a->max_spin) {
        at_most(s, e, name, "spin", "rad/s", fabs(spin), d->max_spin);
    }
}

static void measure_bodies(scene *s, sc_expect *e)
{
    const sc_expect_def *d = &e->def;
    const asked a = asked_of(d);
    int count = 0;
    for (int i = 0; i < s->bodies.count && (a.any || d->body[0] != 0); i++) {
        const sc_body *b = s->bodies.items[i];
        if (d->body[0] == 0 ? b->def.type == 0 : sc_name_matches(d->body, b->def.name)) {
            measure_body(s, e, &a, b);
            count++;
        }
    }
    if (a.count) {
        double range[2] = { d->count[0], d->count[1] };
        widen(&e->def, range);
        within(s, e, d->body, "count", "1", d->body[0] == 0 ? s->bodies.count : count, range);
    } else if (d->body[0] != 0 && count == 0) {
        sample m = { d->body, "bodies left", "1", 0, 1, DBL_MAX };
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
        double change = fabs(now.kinetic + now.potential + now.stored - s->energy_start);
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

// Raises unless the function of `test` has returned true or false and, if it did, numbers after that.
static void check_verdict(scene *s, const sc_expect *e)
{
    lua_State *L = s->L;
    const sc_site site = { .construct = "expect", .line = e->line };
    const char *name = e->def.name;
    if (lua_type(L, -3) != LUA_TBOOLEAN) {
        sc_raise(s, SCENE_E_TYPE, &site, "test", 0, NULL,
                 "the function 'test' of '%s' must return true or false first, not %s", name,
                 lua_isnil(L, -3) ? "nothing (nil)" : sc_type_name(s, -3));
    }
    for (int i = -2; i < 0; i++) {
        if (!lua_isnil(L, i) && lua_type(L, i) != LUA_TNUMBER) {
            sc_raise(s, SCENE_E_TYPE, &site, "test", 0, NULL,
                     "the function 'test' of '%s' must return a number as its %s, not %s", name,
                     i == -2 ? "second value, what was measured" : "third value, the limit",
                     sc_type_name(s, i));
        }
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
    check_verdict(s, e);
    bool good = lua_toboolean(L, -3) != 0;
    sample m = { .body = "", .what = "test", .unit = "1", .ratio = good ? 1 : DBL_MAX / 2 };
    m.measured = lua_type(L, -2) == LUA_TNUMBER ? lua_tonumber(L, -2) : good;
    m.limit = lua_type(L, -1) == LUA_TNUMBER ? lua_tonumber(L, -1) : 1;
    if (isnan(m.measured)) {
        m.measured = 0; // the verdict is the author's
    }
    lua_pop(L, 3);
    keep(s, e, &m);
}

// ------------------------------------------------------------------------- joints and sensors

// A number that must lie in a range, or within the tolerance of one.
static void in_range(scene *s, sc_expect *e, const char *name, const char *what, const char *unit,
                     double v, const double wanted[2])
{
    double range[2] = { wanted[0], wanted[1] };
    widen(&e->def, range);
    within(s, e, name, what, unit, v, range);
}

static bool is_meant(const char *pattern, const char *name)
{
    return pattern[0] == 0 || sc_name_matches(pattern, name);
}

static void measure_joint(scene *s, sc_expect *e, const sc_joint *j)
{
    const sc_expect_def *d = &e->def;
    const char *name = j->def.name;
    if (HAS(d, joint_value)) {
        in_range(s, e, name, "value", "rad or m", (double)plumb_joint_value(s->world, j->entity),
                 d->joint_value);
    }
    if (HAS(d, reaction)) {
        plumb_vec2 f = plumb_joint_force(s->world, j->entity);
        double fx = (double)f.x, fy = (double)f.y;
        in_range(s, e, name, "reaction", "N", sqrt(fx * fx + fy * fy), d->reaction);
    }
    if (HAS(d, reaction_torque)) {
        in_range(s, e, name, "reaction_torque", "N m",
                 (double)plumb_joint_torque(s->world, j->entity), d->reaction_torque);
    }
    if (HAS(d, max_joint_error)) {
        at_most(s, e, name, "joint_error", "m", (double)plumb_joint_error(s->world, j->entity),
                d->max_joint_error);
    }
}

static void measure_joints(scene *s, sc_expect *e)
{
    const sc_expect_def *d = &e->def;
    bool each = HAS(d, joint_value) || HAS(d, reaction) || HAS(d, reaction_torque);
    int count = 0;
    for (int i = 0; i < s->joints.count && (each || HAS(d, max_joint_error)); i++) {
        const sc_joint *j = s->joints.items[i];
        if (is_meant(d->joint, j->def.name)) {
            measure_joint(s, e, j);
            count++;
        }
    }
    if (each && count == 0) {
        sample m = { d->joint, "joints left", "1", 0, 1, DBL_MAX };
        keep(s, e, &m);
    } else if (HAS(d, max_joint_error) && count == 0) {
        at_most(s, e, d->joint, "joint_error", "m", 0, d->max_joint_error);
    }
    if (HAS(d, broken)) {
        int broken = 0;
        for (int i = 0; i < s->broken.count; i++) {
            broken += is_meant(d->joint, s->broken.items[i].text);
        }
        in_range(s, e, d->joint, "broken", "1", broken, d->broken);
    }
}

static void measure_sensors(scene *s, sc_expect *e)
{
    const bool visits = HAS(&e->def, visits), inside = HAS(&e->def, inside);
    for (int i = 0; i < s->bodies.count && (visits || inside); i++) {
        const sc_body *b = s->bodies.items[i];
        if (!sc_name_matches(e->def.body, b->def.name)) {
            continue;
        }
        if (visits) {
            in_range(s, e, b->def.name, "visits", "1", b->visits, e->def.visits);
        }
        if (inside) {
            int count = sc_body_overlaps(s, b->entity);
            lua_pop(s->L, 1);
            in_range(s, e, b->def.name, "inside", "1", count, e->def.inside);
        }
    }
}

static double alarms_of(const scene *s, const char *kind)
{
    double sum = 0;
    for (int i = 0; i < PLUMB_ALARM_KINDS; i++) {
        const bool meant = kind[0] == 0 || strcmp(kind, plumb_alarm_name((plumb_alarm_kind)i)) == 0;
        sum += meant ? s->alarms[i] : 0;
    }
    return sum;
}

void sc_measure(scene *s, sc_expect *e)
{
    const sc_expect_def *d = &e->def;
    sc_step_work(s, (uint64_t)s->bodies.count + (uint64_t)s->joints.count + 10);
    measure_bodies(s, e);
    measure_joints(s, e);
    measure_sensors(s, e);
    if (HAS(d, max_penetration)) {
        at_most(s, e, "", "max_penetration", "m",
                (double)plumb_world_stats(s->world).max_penetration, d->max_penetration);
    }
    measure_drift(s, e);
    if (HAS(d, alarms)) {
        in_range(s, e, d->alarm, "alarms", "1", alarms_of(s, d->alarm), d->alarms);
    }
    if (HAS(d, value)) {
        const sc_score *score = sc_score_find(s, d->score);
        in_range(s, e, d->score, "score", "1", score == NULL ? 0 : score->value, d->value);
    }
    if (HAS(d, exact)) {
        int index = (int)(e - s->expects.items);
        double error = sc_exact_error(s, e->exact);
        e = &s->expects.items[index]; // a function may have moved the list
        at_most(s, e, e->def.exact, "error", scene_exact_get(s, e->exact).unit, error,
                e->def.tolerance);
    }
    if (HAS(&e->def, test)) {
        measure_test(s, e);
    }
}
