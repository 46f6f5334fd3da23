// joints.c - the joint constructors: revolute{}, wheel{}, ... as their lists (lists_joints.c) say.
// One function serves all kinds: ends, anchors, limits, motor, spring, break. The world's joint is
// made at once, so that what it refuses is reported at the author's line. The same function serves
// JSON, where `state` gives a joint its past. Cost: O(joints) for a name.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "internal.h"

#define GIVEN(d, member) SC_GIVEN(&sc_list_joints[(d)->kind], (d), sc_joint_def, member)

static plumb_vec2 real2(const double v[2])
{
    return (plumb_vec2){ (plumb_real)v[0], (plumb_real)v[1] };
}

// ---------------------------------------------------------------------------------------- ends

static const char *end_name(const scene *s, const sc_end *end)
{
    const sc_body *b = sc_body_of(s, end->body);
    return b != NULL ? b->def.name : "world";
}

static bool is_dynamic(const scene *s, const sc_end *end)
{
    const sc_body *b = sc_body_of(s, end->body);
    return b != NULL && b->def.type == 0;
}

static void settle_ends(scene *s, const sc_site *site, sc_joint_def *d)
{
    const char *name = site->construct;
    bool alone = d->a.given != d->b.given;
    if (!d->a.given && !d->b.given) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL, "%s{} needs two bodies, or one and world",
                 name);
    }
    if (alone && (d->kind == PLUMB_GEAR || d->kind == PLUMB_PULLEY)) {
        sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL, "%s{} needs two bodies", name);
    }
    if (alone && d->a.given) { // one body hangs on the world
        d->b = d->a;
        d->a = (sc_end){ .given = true };
    }
    if (plumb_same(d->a.body, d->b.body)) {
        sc_raise(s, SCENE_E_CONFLICT, site, NULL, 0, NULL,
                 "both ends of %s{} are '%s': a joint holds two different ones", name,
                 end_name(s, &d->a));
    }
    if (!is_dynamic(s, &d->a) && !is_dynamic(s, &d->b)) {
        sc_raise(s, SCENE_E_CONFLICT, site, NULL, 0, NULL,
                 "a %s{} of '%s' and '%s' does nothing: neither is dynamic", name,
                 end_name(s, &d->a), end_name(s, &d->b));
    }
}

static void center_of(const scene *s, const sc_end *end, double out[2])
{
    plumb_vec2 p = plumb_body_center(s->world, end->body);
    out[0] = (double)p.x;
    out[1] = (double)p.y;
}

// Where an anchor in the frame of its body is in the world.
static void place(const scene *s, const sc_end *end, const double anchor[2], double out[2])
{
    plumb_vec2 p = real2(anchor);
    p = plumb_is_null(end->body) ? p : plumb_body_world_point(s->world, end->body, p);
    out[0] = (double)p.x;
    out[1] = (double)p.y;
}

// It has a point on each body.
static bool has_two(plumb_joint_kind kind)
{
    return kind == PLUMB_DISTANCE || kind == PLUMB_PULLEY || kind == PLUMB_CABLE;
}

// Anchors that were not given: where `state` says, else the centre of mass of the body in question.
static void settle_anchors(scene *s, const sc_site *site, sc_joint_def *d)
{
    if (GIVEN(d, state)) {
        place(s, &d->a, d->state.anchor_a, d->at_a);
        place(s, &d->b, d->state.anchor_b, d->at_b);
        place(s, &d->b, d->state.anchor_b, d->at);
        return;
    }
    if (!has_two(d->kind)) {
        if (!GIVEN(d, at)) {
            center_of(s, plumb_is_null(d->b.body) ? &d->a : &d->b, d->at);
        }
        return;
    }
    struct {
        const sc_end *end;
        double *at;
        bool given;
        const char *name;
    } ends[] = { { &d->a, d->at_a, GIVEN(d, at_a), "at_a" },
                 { &d->b, d->at_b, GIVEN(d, at_b), "at_b" } };
    for (int i = 0; i < 2; i++) {
        if (!ends[i].given && plumb_is_null(ends[i].end->body)) {
            sc_raise(s, SCENE_E_MISSING, site, NULL, 0, NULL,
                     "%s{} needs '%s': where on the world it is tied", site->construct,
                     ends[i].name);
        }
        if (!ends[i].given) {
            center_of(s, ends[i].end, ends[i].at);
        }
    }
}

static void check_zero(scene *s, const sc_site *site, bool given, const char *key, double v)
{
    if (given && v == 0) {
        sc_raise(s, SCENE_E_RANGE, site, key, 0, NULL, "'%s' of %s{} must not be 0", key,
                 site->construct);
    }
}

// A gear of joints turns with what they turn: their B. A slider's travel is along its axis.
static void settle_gear(scene *s, sc_joint_def *d)
{
    if (d->kind != PLUMB_GEAR) {
        return;
    }
    plumb_joint_desc of;
    if (!plumb_is_null(d->b.joint) && !GIVEN(d, axis) &&
        plumb_joint_settings(s->world, d->b.joint, &of) == PLUMB_OK && of.kind == PLUMB_PRISMATIC) {
        d->axis[0] = (double)of.axis.x;
        d->axis[1] = (double)of.axis.y;
        SC_GIVE(&sc_list_joints[d->kind], d, sc_joint_def, axis);
    }
}

// ------------------------------------------------------------------------------ motor and spring

static void check_motor(scene *s, const sc_site *site, const sc_joint_def *d)
{
    sc_site inner = { .construct = "motor", .line = site->line, .path = site->path };
    inner.outer = site->path == NULL ? site->construct : NULL;
    bool slides = d->kind == PLUMB_PRISMATIC;
    bool torque = SC_GIVEN(&sc_list_motor, &d->motor, sc_motor, torque);
    bool force = SC_GIVEN(&sc_list_motor, &d->motor, sc_motor, force);
    const char *wanted = slides ? "force" : "torque";
    if (slides ? torque : force) {
        sc_raise(s, SCENE_E_KEY, &inner, slides ? "torque" : "force", 0, wanted,
                 "the motor of a %s{} has no '%s'", site->construct, slides ? "torque" : "force");
    }
    if (!torque && !force) {
        sc_raise(s, SCENE_E_MISSING, &inner, NULL, 0, NULL, "the motor of a %s{} needs '%s'",
                 site->construct, wanted);
    }
}

static void check_spring(scene *s, const sc_site *site, const sc_joint_def *d)
{
    sc_site inner = { .construct = "spring", .line = site->line, .path = site->path };
    inner.outer = site->path == NULL ? site->construct : NULL;
    const char *instead = d->kind == PLUMB_DISTANCE ? "length"
                          : d->kind == PLUMB_MOTOR  ? "angle"
                          : d->kind == PLUMB_MOUSE  ? "target"
                                                    : NULL;
    bool hertz = SC_GIVEN(&sc_list_spring, &d->spring, sc_spring, frequency);
    bool damping = SC_GIVEN(&sc_list_spring, &d->spring, sc_spring, damping);
    bool newtons = d->spring.stiffness > 0 || d->spring.damper > 0;
    if (newtons && (hertz || damping)) {
        sc_raise(s, SCENE_E_CONFLICT, &inner, NULL, 0, NULL,
                 "the spring of a %s{} has either 'frequency' and 'damping', or 'stiffness' and "
                 "'damper'",
                 site->construct);
    }
    if (!newtons && !hertz) {
        sc_raise(s, SCENE_E_MISSING, &inner, NULL, 0, NULL,
                 "the spring of a %s{} needs 'frequency', or 'stiffness' or 'damper' above 0",
                 site->construct);
    }
    if (instead != NULL && SC_GIVEN(&sc_list_spring, &d->spring, sc_spring, rest)) {
        sc_raise(s, SCENE_E_KEY, &inner, "rest", 0, NULL,
                 "the spring of a %s{} has no 'rest': give the joint's '%s'", site->construct,
                 instead);
    }
}

// ---------------------------------------------------------------------------------- the world's

static plumb_joint_desc describe(const sc_joint_def *d, sc_joint *record)
{
    bool two = has_two(d->kind);
    bool slides = d->kind == PLUMB_PRISMATIC;
    plumb_joint_desc desc = {
        .kind = d->kind,
        .body_a = d->a.body,
        .body_b = d->b.body,
        .anchor = real2(two ? d->at_a : d->at),
        .anchor_b = two ? real2(d->at_b) : (plumb_vec2){ 0, 0 },
        .ground_a = real2(d->wheel_a),
        .ground_b = real2(d->wheel_b),
        .axis = real2(d->axis),
        .reference = (plumb_real)d->reference,
        .enable_limit = GIVEN(d, limits),
        .lower = (plumb_real)d->limits[0],
        .upper = (plumb_real)d->limits[1],
        .restitution = (plumb_real)d->restitution,
        .enable_motor = GIVEN(d, motor),
        .motor_speed = (plumb_real)d->motor.speed,
        .max_motor = (plumb_real)(slides ? d->motor.force : d->motor.torque),
        .hertz = (plumb_real)d->spring.frequency,
        .damping = (plumb_real)d->spring.damping,
        .stiffness = (plumb_real)d->spring.stiffness,
        .damper = (plumb_real)d->spring.damper,
        .rest = (plumb_real)(d->kind == PLUMB_MOTOR ? d->angle : d->spring.rest),
        .length = (plumb_real)d->length,
        .radius_a = (plumb_real)d->radius_a,
        .radius_b = (plumb_real)d->radius_b,
        .ratio = (plumb_real)d->ratio,
        .pitch = (plumb_real)d->pitch,
        .max_force = (plumb_real)d->max_force,
        .max_torque = (plumb_real)d->max_torque,
        .collide_connected = d->collide,
        .user_data = record,
    };
    const sc_joint_def *def = d;
#define BOUND_GIVEN(word) GIVEN(def, word)
    PL_JOINT_BOUND_ROWS(SC_DESCRIBE, BOUND_GIVEN)
#undef BOUND_GIVEN
    return desc;
}

static plumb_joint_memory recall(const sc_joint_state *t)
{
    plumb_joint_memory m = {
        .anchor_a = real2(t->anchor_a),
        .anchor_b = real2(t->anchor_b),
        .axis = real2(t->axis),
        .offset = real2(t->offset),
        .start_a = (plumb_real)t->start[0],
        .start_b = (plumb_real)t->start[1],
        .turns_a = (int32_t)t->turns[0],
        .turns_b = (int32_t)t->turns[1],
        .kept = (plumb_real)t->kept,
        .substep = (plumb_real)t->substep,
    };
    for (int i = 0; i < 6; i++) {
        m.impulses[i] = (plumb_real)t->impulses[i];
    }
    return m;
}

_Noreturn static void fail_world(scene *s, const sc_site *site)
{
    sc_refused(s, site, NULL, plumb_world_error(s->world).code, "%s{}", site->construct);
}

static void create(scene *s, const sc_site *site, sc_joint *j)
{
    const sc_joint_def *d = &j->def;
    plumb_joint_desc desc = describe(d, j);
    j->entity = plumb_joint_create(s->world, &desc);
    plumb_result r = plumb_is_null(j->entity) ? PLUMB_E_RANGE : PLUMB_OK;
    bool aimed = (d->kind == PLUMB_MOUSE && GIVEN(d, target)) ||
                 (d->kind == PLUMB_MOTOR && GIVEN(d, offset));
    if (r == PLUMB_OK && aimed) {
        r = plumb_joint_set_target(s->world, j->entity,
                                   real2(d->kind == PLUMB_MOUSE ? d->target : d->offset));
    }
    if (r == PLUMB_OK && GIVEN(d, state)) {
        plumb_joint_memory m = recall(&d->state);
        r = plumb_joint_set_memory(s->world, j->entity, &m);
    }
    if (r != PLUMB_OK) {
        fail_world(s, site);
    }
}

// ------------------------------------------------------------------------------------ the record

static void check_name(scene *s, const sc_site *site, const sc_joint_def *d)
{
    if (strchr(d->name, '*') != NULL) {
        sc_raise(s, SCENE_E_RANGE, site, "name", 0, NULL,
                 "'name' of %s{} must not contain '*': it stands for any ending elsewhere",
                 site->construct);
    }
    if (d->name[0] != 0 && sc_joint_named(s, d->name) != NULL) {
        sc_raise(s, SCENE_E_DUPLICATE, site, "name", 0, NULL, "two joints are called '%s'",
                 d->name);
    }
}

static sc_joint *add_record(scene *s, const sc_joint_def *def)
{
    sc_joint **slot = SC_PUSH(s, s->joints);
    s->joints.count--; // until there is a record
    sc_joint *j = sc_need(s, NULL, 0, sizeof *j);
    *j = (sc_joint){ .def = *def, .is_named = def->name[0] != 0 };
    *slot = j;
    s->joints.count++;
    unsigned long long number = ++s->joint_serial;
    while (j->def.name[0] == 0) { // skip a number that the author has taken
        char name[SC_NAME_SIZE];
        snprintf(name, sizeof name, "joint%llu", number++);
        if (sc_joint_named(s, name) == NULL) {
            snprintf(j->def.name, sizeof j->def.name, "%s", name);
        }
    }
    sc_record_name(s, &sc_joints, j->def.name, j);
    return j;
}

void sc_joint_release(scene *s, sc_joint *joint)
{
    sc_record_name(s, &sc_joints, joint->def.name, NULL);
    int at = 0;
    while (s->joints.items[at] != joint) {
        at++;
    }
    s->joints.count--;
    memmove(&s->joints.items[at], &s->joints.items[at + 1],
            (size_t)(s->joints.count - at) * sizeof(sc_joint *));
    sc_resize(s, joint, sizeof *joint, 0);
}

void sc_build_joint(scene *s, const sc_site *site, plumb_joint_kind kind, int table)
{
    sc_need_stack(s, 20);
    sc_need_world(s);
    sc_joint_def def = { .kind = kind };
    sc_read(s, site, &sc_list_joints[kind], table, &def);
    check_name(s, site, &def);
    settle_ends(s, site, &def);
    settle_anchors(s, site, &def);
    settle_gear(s, &def);
    check_zero(s, site, GIVEN(&def, ratio), "ratio", def.ratio);
    check_zero(s, site, GIVEN(&def, pitch), "pitch", def.pitch);
    if (GIVEN(&def, motor)) {
        check_motor(s, site, &def);
    }
    if (GIVEN(&def, spring)) {
        check_spring(s, site, &def);
    }
    sc_joint *j = add_record(s, &def);
    j->line = site->line;
    create(s, site, j);
    sc_joint_push(s, j->entity);
}

// ------------------------------------------------------------------------------------- for JSON

static void double2(double out[2], plumb_vec2 v)
{
    out[0] = (double)v.x;
    out[1] = (double)v.y;
}

static void remember(const scene *s, const sc_joint *j, sc_joint_state *t)
{
    plumb_joint_memory m = { .substep = 0 };
    plumb_joint_get_memory(s->world, j->entity, &m);
    t->present = ((uint64_t)1 << sc_list_state.count) - 1;
    double2(t->anchor_a, m.anchor_a);
    double2(t->anchor_b, m.anchor_b);
    double2(t->axis, m.axis);
    double2(t->offset, m.offset);
    t->start[0] = (double)m.start_a;
    t->start[1] = (double)m.start_b;
    t->turns[0] = m.turns_a;
    t->turns[1] = m.turns_b;
    t->kept = (double)m.kept;
    t->substep = (double)m.substep;
    for (int i = 0; i < 6; i++) {
        t->impulses[i] = (double)m.impulses[i];
    }
}

#define MARK(d, member, given)                                                                     \
    SC_MARK(&sc_list_joints[(d)->kind], (d), sc_joint_def, member, (given))

// A bound of the reaction as setters left it.
#define REMEMBER(X, store, kind, name, word, ...) PL_CALL(REMEMBER_OF, name, PL_WORD_##word)
#define REMEMBER_OF(name, how, word)              REMEMBER_##how(name, word)
#define REMEMBER_SAID(name, word)                                                                  \
    d->word = (double)now->name;                                                                   \
    MARK(d, word, now->name > 0);
#define REMEMBER_UNSAID(name, word)

// Limits, motor and spring as setters left them.
static void read_parts(sc_joint_def *d, const plumb_joint_desc *now)
{
    d->limits[0] = (double)now->lower;
    d->limits[1] = (double)now->upper;
    MARK(d, limits, now->enable_limit);
    d->motor = (sc_motor){ .speed = (double)now->motor_speed };
    SC_GIVE(&sc_list_motor, &d->motor, sc_motor, speed);
    if (d->kind == PLUMB_PRISMATIC) {
        d->motor.force = (double)now->max_motor;
        SC_GIVE(&sc_list_motor, &d->motor, sc_motor, force);
    } else {
        d->motor.torque = (double)now->max_motor;
        SC_GIVE(&sc_list_motor, &d->motor, sc_motor, torque);
    }
    MARK(d, motor, now->enable_motor);
    d->spring = (sc_spring){ .frequency = (double)now->hertz, .damping = (double)now->damping };
    SC_GIVE(&sc_list_spring, &d->spring, sc_spring, frequency);
    SC_GIVE(&sc_list_spring, &d->spring, sc_spring, damping);
    if (d->kind != PLUMB_DISTANCE && d->kind != PLUMB_MOUSE && d->kind != PLUMB_MOTOR) {
        d->spring.rest = (double)now->rest;
        SC_GIVE(&sc_list_spring, &d->spring, sc_spring, rest);
    }
    MARK(d, spring, now->hertz > 0);
    PL_JOINT_BOUND_ROWS(REMEMBER, )
}

sc_joint_def sc_joint_now(const scene *s, const sc_joint *joint)
{
    sc_joint_def d = joint->def;
    plumb_joint_desc now = { .kind = d.kind };
    plumb_joint_settings(s->world, joint->entity, &now);
    read_parts(&d, &now);
    d.angle = (double)now.rest;
    d.length = (double)now.length;
    MARK(&d, a, true);
    MARK(&d, b, true);
    MARK(&d, at, false); // the state has the anchors, as the bodies have them
    MARK(&d, at_a, false);
    MARK(&d, at_b, false);
    MARK(&d, target, false);
    MARK(&d, offset, false);
    MARK(&d, angle, true);
    MARK(&d, length, d.length > 0);
    MARK(&d, name, true);
    MARK(&d, state, true);
    remember(s, joint, &d.state);
    return d;
}

// ----------------------------------------------------------------------------- Lua's side of it

// Upvalue: the kind.
static int lua_joint(lua_State *L)
{
    scene *s = sc_of(L);
    plumb_joint_kind kind = (plumb_joint_kind)lua_tointeger(L, lua_upvalueindex(1));
    sc_site site = sc_here(s, sc_list_joints[kind].name);
    if (lua_gettop(L) != 1 || lua_type(L, 1) != LUA_TTABLE) {
        sc_raise(s, SCENE_E_TYPE, &site, NULL, 0, NULL, "%s takes one table: %s{...}",
                 site.construct, site.construct);
    }
    sc_build_joint(s, &site, kind, 1);
    return 1;
}

bool sc_is_world(lua_State *L, int index)
{
    return luaL_testudata(L, index, SC_META_WORLD) != NULL;
}

void sc_open_joints(lua_State *L)
{
    sc_records_open(L, &sc_joints);
    for (int kind = 0; kind < SC_JOINT_KINDS; kind++) {
        lua_pushinteger(L, kind);
        lua_pushcclosure(L, lua_joint, 1);
        lua_setglobal(L, sc_list_joints[kind].name);
    }
    lua_newuserdatauv(L, 1, 0);
    luaL_newmetatable(L, SC_META_WORLD);
    lua_pushliteral(L, "world");
    lua_setfield(L, -2, "__name");
    lua_setmetatable(L, -2);
    lua_setglobal(L, "world");
}
