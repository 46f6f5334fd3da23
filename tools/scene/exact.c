// exact.c - the closed forms that a scene declares, and how far the world is from them now: for `plumb cost` and for
// expect{} with 'exact'.
//
// A form is about the motion of a body (x, y, angle, vx, vy, spin), or about anything the script can measure
// (`measure` against `value`): forces, energies, moments of events.
#include <math.h>
#include <string.h>

#include "internal.h"

#define HAS(def, member) SC_GIVEN(&sc_list_exact, (def), sc_exact_def, member)

/// One evaluation, handed into the protected call.
typedef struct evaluation {
    int index;
    double t;
    double *values;
} evaluation;

int scene_exact_count(const scene *s)
{
    return s->exact_count;
}

// Bits of the quantities of a body that are given.
static unsigned given_of(const sc_exact_def *d)
{
    const bool given[SCENE_EXACT_COUNT] = { HAS(d, x),  HAS(d, y),  HAS(d, angle),
                                            HAS(d, vx), HAS(d, vy), HAS(d, spin) };
    unsigned bits = 0;
    for (int q = 0; q < SCENE_EXACT_COUNT; q++) {
        bits |= given[q] ? 1u << q : 0;
    }
    return bits;
}

static const unsigned place = 1u << SCENE_EXACT_X | 1u << SCENE_EXACT_Y;
static const unsigned velocity = 1u << SCENE_EXACT_VX | 1u << SCENE_EXACT_VY;

static const char *unit_of(const sc_exact_def *d)
{
    unsigned given = given_of(d);
    if (HAS(d, scale)) {
        return "1";
    }
    if (HAS(d, measure)) {
        return HAS(d, unit) ? d->unit : "1";
    }
    return (given & place) != 0                     ? "m"
           : (given & 1u << SCENE_EXACT_ANGLE) != 0 ? "rad"
           : (given & velocity) != 0                ? "m/s"
                                                    : "rad/s";
}

scene_exact scene_exact_get(const scene *s, int i)
{
    const sc_exact_def *d = &s->exacts[i].def;
    scene_exact out = { .name = d->name,
                        .body = d->body,
                        .unit = unit_of(d),
                        .given = given_of(d),
                        .from = HAS(d, from) ? d->from : s->start_time,
                        .till = HAS(d, till) ? d->till : s->start_time + s->duration };
    if (HAS(d, at)) { // the step nearest to it
        out.from = d->at - 0.499999 * s->dt;
        out.till = d->at + 0.499999 * s->dt;
    }
    return out;
}

int sc_exact_find(const scene *s, const char *name)
{
    for (int i = 0; i < s->exact_count; i++) {
        if (strcmp(s->exacts[i].def.name, name) == 0) {
            return i;
        }
    }
    return -1;
}

bool sc_exact_holds(scene *s, int i)
{
    scene_exact form = scene_exact_get(s, i);
    double now = scene_time(s), slack = s->dt / 10; // times are sums of steps
    bool at = HAS(&s->exacts[i].def, at);
    bool gone = form.body[0] != 0 && plumb_is_null(scene_body_find(s, form.body).entity);
    return !gone && now >= form.from - (at ? 0 : slack) && now <= form.till + (at ? 0 : slack);
}

// Calls a function of the form with the time; a finite number.
static double ask(scene *s, int i, int function, double t)
{
    lua_State *L = s->L;
    lua_rawgeti(L, LUA_REGISTRYINDEX, function);
    lua_pushnumber(L, t);
    sc_call(s, 1, 1);
    if (lua_type(L, -1) != LUA_TNUMBER || !isfinite(lua_tonumber(L, -1))) {
        sc_site site = { .construct = "exact", .line = s->exacts[i].line };
        sc_raise(s, SCENE_E_TYPE, &site, NULL, 0, NULL,
                 "a function of exact{} must return a finite number, not %s at t = %.10g",
                 sc_type_name(s, -1), t);
    }
    double value = lua_tonumber(L, -1);
    lua_pop(L, 1);
    return value;
}

static void evaluate(scene *s, void *argument)
{
    const evaluation *e = argument;
    const sc_exact_def d = s->exacts[e->index].def;
    const int functions[SCENE_EXACT_COUNT] = { d.x, d.y, d.angle, d.vx, d.vy, d.spin };
    unsigned given = given_of(&d);
    for (int q = 0; q < SCENE_EXACT_COUNT; q++) {
        bool is_given = (given >> q & 1u) != 0;
        e->values[q] = is_given ? ask(s, e->index, functions[q], e->t) : (double)NAN;
    }
}

/// Distance of a body from its closed form `values`, of which `given` are there.
static double body_error(const plumb_world *world, plumb_body body, unsigned given,
                         const double values[SCENE_EXACT_COUNT])
{
    const double turn = 6.283185307179586; // [rad] angles are equal modulo one
    plumb_vec2 p = plumb_body_position(world, body), v = plumb_body_velocity(world, body);
    double error[SCENE_EXACT_COUNT] = { 0 };
    const double now[SCENE_EXACT_COUNT] = {
        [SCENE_EXACT_X] = (double)p.x,
        [SCENE_EXACT_Y] = (double)p.y,
        [SCENE_EXACT_ANGLE] = (double)plumb_body_angle(world, body),
        [SCENE_EXACT_VX] = (double)v.x,
        [SCENE_EXACT_VY] = (double)v.y,
        [SCENE_EXACT_SPIN] = (double)plumb_body_angular_velocity(world, body),
    };
    for (int q = 0; q < SCENE_EXACT_COUNT; q++) {
        error[q] = (given >> q & 1u) != 0 ? now[q] - values[q] : 0;
    }
    error[SCENE_EXACT_ANGLE] = remainder(error[SCENE_EXACT_ANGLE], turn);
    if ((given & place) != 0) {
        return hypot(error[SCENE_EXACT_X], error[SCENE_EXACT_Y]);
    }
    if ((given & 1u << SCENE_EXACT_ANGLE) != 0) {
        return fabs(error[SCENE_EXACT_ANGLE]);
    }
    if ((given & velocity) != 0) {
        return hypot(error[SCENE_EXACT_VX], error[SCENE_EXACT_VY]);
    }
    return fabs(error[SCENE_EXACT_SPIN]);
}

double sc_exact_error(scene *s, int i)
{
    const sc_exact_def d = s->exacts[i].def; // a function may move the list
    double values[SCENE_EXACT_COUNT], error, now = scene_time(s);
    if (HAS(&d, measure)) {
        double measured = ask(s, i, d.measure, now);
        error = fabs(measured - ask(s, i, d.value, now));
    } else {
        evaluate(s, &(evaluation){ i, now, values });
        error = body_error(s->world, scene_body_find(s, d.body).entity, given_of(&d), values);
    }
    return HAS(&d, scale) ? error / d.scale : error;
}

static void error_inside(scene *s, void *argument)
{
    const evaluation *e = argument;
    *e->values = sc_exact_error(s, e->index);
}

static scene_code protect(scene *s, sc_protected_fn *run, evaluation *e, scene_error *err)
{
    if (s->error.code == SCENE_OK) {
        sc_begin_handlers(s);
        sc_protect(s, run, e);
    }
    if (err != NULL) {
        *err = s->error;
    }
    return s->error.code;
}

scene_code scene_exact_eval(scene *s, int i, double t, double values[SCENE_EXACT_COUNT],
                            scene_error *err)
{
    return protect(s, evaluate, &(evaluation){ i, t, values }, err);
}

scene_code scene_exact_error(scene *s, int i, double *error, scene_error *err)
{
    *error = -1;
    if (!sc_exact_holds(s, i)) {
        return SCENE_OK;
    }
    return protect(s, error_inside, &(evaluation){ i, scene_time(s), error }, err);
}

static void truth_inside(scene *s, void *argument)
{
    const evaluation *e = argument;
    const sc_exact_def d = s->exacts[e->index].def;
    unsigned given = given_of(&d);
    double all[SCENE_EXACT_COUNT] = { 0 };
    if (HAS(&d, measure)) {
        e->values[0] = ask(s, e->index, d.value, e->t);
        return;
    }
    evaluate(s, &(evaluation){ e->index, e->t, all });
    for (int q = 0; q < SCENE_EXACT_COUNT; q++) {
        all[q] = (given >> q & 1u) != 0 ? all[q] : 0;
    }
    bool moves = (given & velocity) != 0, turns = (given & 1u << SCENE_EXACT_ANGLE) != 0;
    int first = (given & place) != 0 ? SCENE_EXACT_X
                : turns              ? SCENE_EXACT_ANGLE
                : moves              ? SCENE_EXACT_VX
                                     : SCENE_EXACT_SPIN;
    e->values[0] = all[first];
    e->values[1] = first == SCENE_EXACT_X || first == SCENE_EXACT_VX ? all[first + 1] : 0;
}

scene_code scene_exact_truth(scene *s, int i, double truth[2], bool *scaled, scene_error *err)
{
    const sc_exact_def d = s->exacts[i].def;
    truth[0] = truth[1] = 0;
    *scaled = HAS(&d, scale);
    return protect(s, truth_inside, &(evaluation){ i, scene_time(s), truth }, err);
}

// ---------------------------------------------------------------------------------- registering

static void check_exact(scene *s, const sc_site *site, const sc_exact_def *d)
{
    bool moves = given_of(d) != 0, measures = HAS(d, measure) || HAS(d, value);
    if (!moves && !measures) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL,
                 "exact{} needs a function of time, such as y = function(t) ... end");
    }
    if (moves && measures) {
        sc_raise(s, SCENE_E_CONFLICT, site, HAS(d, measure) ? "measure" : "value", 0, NULL,
                 "exact{} takes the motion of a body or 'measure' and 'value', not both");
    }
    if (HAS(d, measure) != HAS(d, value)) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL,
                 "exact{} needs 'measure' and 'value' together");
    }
    if (moves && d->body[0] == 0) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL,
                 "exact{} needs 'body' to know whose motion is meant");
    }
    if (HAS(d, unit) && !measures) {
        sc_raise(s, SCENE_E_UNUSED, site, "unit", 0, NULL,
                 "'unit' of exact{} is for 'measure': motion has units of its own");
    }
    if (HAS(d, at) && (HAS(d, from) || HAS(d, till))) {
        sc_raise(s, SCENE_E_CONFLICT, site, "at", 0, NULL,
                 "exact{} takes one of 'at' and 'from'/'till'");
    }
    if (d->name[0] != 0 && sc_exact_find(s, d->name) >= 0) {
        sc_raise(s, SCENE_E_DUPLICATE, site, "name", 0, NULL, "another exact{} is called '%s'",
                 d->name);
    }
}

void sc_build_exact(scene *s, const sc_site *site, int table)
{
    sc_exact_def def = { 0 };
    sc_read(s, site, &sc_list_exact, table, &def);
    check_exact(s, site, &def);
    sc_grow(s, &s->exacts, s->exact_count, &s->exact_capacity, sizeof *s->exacts);
    s->exacts[s->exact_count].def = def;
    s->exacts[s->exact_count].line = site->line;
    s->exact_count++;
}
