// body_api.c - bodies as Lua objects: the methods that handlers and test functions call.
// An object holds the world's handle only, so a destroyed body is noticed; the record (name, looks,
// user table) hangs on the world's user data. To add a method: one function, one row in `methods`.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "internal.h"

// ------------------------------------------------------------------------------------ arguments

/// What a method needs: filled by `self`.
typedef struct call {
    scene *s;
    plumb_world *world;
    sc_body *body;
    plumb_body entity;
    const char *method;
} call;

static call self(lua_State *L, const char *method)
{
    call c = { .s = sc_of(L), .method = method };
    const plumb_body *object = luaL_testudata(L, 1, SC_META_BODY);
    sc_site site = sc_here(c.s, method);
    if (object == NULL) {
        sc_raise(c.s, SCENE_E_TYPE, &site, NULL, 0, NULL, "%s is a method: write body:%s(...)",
                 method, method);
    }
    c.world = c.s->world;
    c.entity = *object;
    c.body = sc_body_of(c.s, c.entity);
    if (c.body == NULL) {
        sc_raise(c.s, SCENE_E_STATE, &site, NULL, 0, NULL, "%s() of a body that was destroyed",
                 method);
    }
    return c;
}

static double finite_number(lua_State *L, int index)
{
    double v = luaL_checknumber(L, index);
    luaL_argcheck(L, isfinite(v), index, "must be finite");
    return v;
}

// Two numbers, or a table {x, y}, at *index, which moves on.
static plumb_vec2 vector(lua_State *L, int *index)
{
    double v[2];
    if (lua_istable(L, *index)) {
        luaL_argcheck(L, sc_to_vec2(sc_of(L), *index, v) && isfinite(v[0]) && isfinite(v[1]),
                      *index, "must be two finite numbers {x, y}");
        *index += 1;
    } else {
        v[0] = finite_number(L, *index);
        v[1] = finite_number(L, *index + 1);
        *index += 2;
    }
    return (plumb_vec2){ (plumb_real)v[0], (plumb_real)v[1] };
}

static int check(const call *c, plumb_result result)
{
    if (result != PLUMB_OK) {
        sc_site site = sc_here(c->s, c->method);
        sc_refused(c->s, &site, NULL, result, "%s() of '%s'", c->method, c->body->def.name);
    }
    return 0;
}

// -------------------------------------------------------------------------------------- getters

static int method_name(lua_State *L)
{
    lua_pushstring(L, self(L, "name").body->def.name);
    return 1;
}

static int method_alive(lua_State *L)
{
    const plumb_body *object = luaL_checkudata(L, 1, SC_META_BODY);
    lua_pushboolean(L, sc_body_of(sc_of(L), *object) != NULL);
    return 1;
}

static const char *const types[] = { "dynamic", "kinematic", "static", NULL };

static int method_type(lua_State *L)
{
    lua_pushstring(L, types[self(L, "type").body->def.type]);
    return 1;
}

static int method_position(lua_State *L)
{
    call c = self(L, "position");
    return sc_push_vector(L, plumb_body_position(c.world, c.entity));
}

static int method_center(lua_State *L)
{
    call c = self(L, "center");
    return sc_push_vector(L, plumb_body_center(c.world, c.entity));
}

static int method_velocity(lua_State *L)
{
    call c = self(L, "velocity");
    return sc_push_vector(L, plumb_body_velocity(c.world, c.entity));
}

static int method_speed(lua_State *L)
{
    call c = self(L, "speed");
    return sc_push_real(L, plumb_vec2_magnitude(plumb_body_velocity(c.world, c.entity)));
}

static int method_angle(lua_State *L)
{
    call c = self(L, "angle");
    return sc_push_real(L, plumb_body_angle(c.world, c.entity));
}

static int method_spin(lua_State *L)
{
    call c = self(L, "spin");
    return sc_push_real(L, plumb_body_angular_velocity(c.world, c.entity));
}

static int method_mass(lua_State *L)
{
    call c = self(L, "mass");
    return sc_push_real(L, plumb_body_mass(c.world, c.entity));
}

static int method_inertia(lua_State *L)
{
    call c = self(L, "inertia");
    return sc_push_real(L, plumb_body_inertia(c.world, c.entity));
}

// -------------------------------------------------------------------------------------- setters

static int method_set_velocity(lua_State *L)
{
    call c = self(L, "set_velocity");
    int index = 2;
    return check(&c, plumb_body_set_velocity(c.world, c.entity, vector(L, &index)));
}

static int method_set_spin(lua_State *L)
{
    call c = self(L, "set_spin");
    return check(
        &c, plumb_body_set_angular_velocity(c.world, c.entity, (plumb_real)finite_number(L, 2)));
}

static int method_teleport(lua_State *L)
{
    call c = self(L, "teleport");
    int index = 2;
    plumb_vec2 p = vector(L, &index);
    plumb_real angle = lua_isnoneornil(L, index) ? plumb_body_angle(c.world, c.entity)
                                                 : (plumb_real)finite_number(L, index);
    check(&c, plumb_body_teleport(c.world, c.entity, p, angle));
    c.body->def.angle = (double)angle;
    c.body->set_rot = plumb_body_transform(c.world, c.entity).q;
    return 0;
}

static int method_set_mass(lua_State *L)
{
    call c = self(L, "set_mass");
    double mass = finite_number(L, 2);
    check(&c, plumb_body_set_mass(c.world, c.entity, (plumb_real)mass));
    c.body->def.mass = mass;
    SC_GIVE(&sc_list_body, &c.body->def, sc_body_def, mass);
    return 0;
}

static int method_set_gravity_scale(lua_State *L)
{
    call c = self(L, "set_gravity_scale");
    double scale = finite_number(L, 2);
    check(&c, plumb_body_set_gravity_scale(c.world, c.entity, (plumb_real)scale));
    c.body->def.gravity_scale = scale;
    SC_GIVE(&sc_list_body, &c.body->def, sc_body_def, gravity_scale);
    return 0;
}

static int method_set_fixed_rotation(lua_State *L)
{
    call c = self(L, "set_fixed_rotation");
    luaL_checktype(L, 2, LUA_TBOOLEAN);
    bool fixed = lua_toboolean(L, 2) != 0;
    check(&c, plumb_body_set_fixed_rotation(c.world, c.entity, fixed));
    c.body->def.fixed_rotation = fixed;
    SC_GIVE(&sc_list_body, &c.body->def, sc_body_def, fixed_rotation);
    return 0;
}

static int method_set_continuous(lua_State *L)
{
    call c = self(L, "set_continuous");
    luaL_checktype(L, 2, LUA_TBOOLEAN);
    bool continuous = lua_toboolean(L, 2) != 0;
    check(&c, plumb_body_set_continuous(c.world, c.entity, continuous));
    c.body->def.continuous = continuous;
    SC_GIVE(&sc_list_body, &c.body->def, sc_body_def, continuous);
    return 0;
}

// ------------------------------------------------------------------------------ taking part

static int method_set_type(lua_State *L)
{
    static const plumb_body_type all[] = { PLUMB_DYNAMIC, PLUMB_KINEMATIC, PLUMB_STATIC };
    call c = self(L, "set_type");
    int type = luaL_checkoption(L, 2, NULL, types);
    check(&c, plumb_body_set_type(c.world, c.entity, all[type]));
    c.body->def.type = type;
    return 0;
}

static int method_set_enabled(lua_State *L)
{
    call c = self(L, "set_enabled");
    luaL_checktype(L, 2, LUA_TBOOLEAN);
    bool enabled = lua_toboolean(L, 2) != 0;
    check(&c, plumb_body_set_enabled(c.world, c.entity, enabled));
    c.body->def.enabled = enabled;
    SC_GIVE(&sc_list_body, &c.body->def, sc_body_def, enabled);
    return 0;
}

static int method_enabled(lua_State *L)
{
    call c = self(L, "enabled");
    lua_pushboolean(L, plumb_body_is_enabled(c.world, c.entity));
    return 1;
}

// body:set_lock("x", "rotation"): these axes and no others.
static int method_set_lock(lua_State *L)
{
    call c = self(L, "set_lock");
    int axes = 0;
    for (int i = 2; i <= lua_gettop(L); i++) {
        int bit = sc_axis_bit(luaL_checkstring(L, i));
        luaL_argcheck(L, bit != 0, i, "must be \"x\", \"y\" or \"rotation\"");
        axes |= bit;
    }
    plumb_axis_locks locks = { .x = (axes & SC_LOCK_X) != 0,
                               .y = (axes & SC_LOCK_Y) != 0,
                               .rotation = (axes & SC_LOCK_ROTATION) != 0 };
    check(&c, plumb_body_set_locks(c.world, c.entity, locks));
    c.body->def.lock = axes;
    c.body->def.fixed_rotation = false;
    SC_GIVE(&sc_list_body, &c.body->def, sc_body_def, lock);
    return 0;
}

// body:set_damping(c [, c of the spin])
static int method_set_damping(lua_State *L)
{
    call c = self(L, "set_damping");
    double linear = finite_number(L, 2);
    double angular =
        lua_isnoneornil(L, 3) ? c.body->def.angular_damping : finite_number(L, 3);
    check(&c, plumb_body_set_damping(c.world, c.entity, (plumb_real)linear, (plumb_real)angular));
    c.body->def.damping = linear;
    c.body->def.angular_damping = angular;
    SC_GIVE(&sc_list_body, &c.body->def, sc_body_def, damping);
    SC_GIVE(&sc_list_body, &c.body->def, sc_body_def, angular_damping);
    return 0;
}

static int method_set_time_scale(lua_State *L)
{
    call c = self(L, "set_time_scale");
    double scale = finite_number(L, 2);
    check(&c, plumb_body_set_time_scale(c.world, c.entity, (plumb_real)scale));
    c.body->def.time_scale = scale;
    SC_GIVE(&sc_list_body, &c.body->def, sc_body_def, time_scale);
    return 0;
}

// body:move_to(x, y [, angle [, seconds]]): by default within the next step.
static int method_move_to(lua_State *L)
{
    call c = self(L, "move_to");
    int index = 2;
    plumb_vec2 p = vector(L, &index);
    plumb_real angle = lua_isnoneornil(L, index) ? plumb_body_angle(c.world, c.entity)
                                                 : (plumb_real)finite_number(L, index);
    double time = lua_isnoneornil(L, index + 1) ? c.s->dt : finite_number(L, index + 1);
    return check(&c, plumb_body_set_target(c.world, c.entity, p, angle, (plumb_real)time));
}

static int method_set_label(lua_State *L)
{
    call c = self(L, "set_label");
    snprintf(c.body->def.label, sizeof c.body->def.label, "%s", luaL_checkstring(L, 2));
    SC_GIVE(&sc_list_body, &c.body->def, sc_body_def, label);
    return 0;
}

static int method_set_color(lua_State *L)
{
    call c = self(L, "set_color");
    if (lua_type(L, 2) == LUA_TNUMBER) {
        lua_Integer n = luaL_checkinteger(L, 2);
        luaL_argcheck(L, n >= 0 && n <= 1000, 2, "must be a palette number 0..1000");
        c.body->def.color = (sc_color){ (int)n, { 0 } };
    } else {
        luaL_argcheck(L, sc_parse_color(luaL_checkstring(L, 2), &c.body->def.color), 2,
                      "must be \"#rrggbb\" or a palette number");
    }
    SC_GIVE(&sc_list_body, &c.body->def, sc_body_def, color);
    return 0;
}

// ------------------------------------------------------------------------------------- pushing

// body:apply_force(fx, fy [, px, py]): at the centre of mass when no point is given.
static int method_apply_force(lua_State *L)
{
    call c = self(L, "apply_force");
    int index = 2;
    plumb_vec2 f = vector(L, &index);
    if (lua_isnoneornil(L, index)) {
        return check(&c, plumb_body_apply_force_center(c.world, c.entity, f));
    }
    return check(&c, plumb_body_apply_force(c.world, c.entity, f, vector(L, &index)));
}

static int method_apply_impulse(lua_State *L)
{
    call c = self(L, "apply_impulse");
    int index = 2;
    plumb_vec2 j = vector(L, &index);
    if (lua_isnoneornil(L, index)) {
        return check(&c, plumb_body_apply_impulse_center(c.world, c.entity, j));
    }
    return check(&c, plumb_body_apply_impulse(c.world, c.entity, j, vector(L, &index)));
}

static int method_apply_torque(lua_State *L)
{
    call c = self(L, "apply_torque");
    return check(&c, plumb_body_apply_torque(c.world, c.entity, (plumb_real)finite_number(L, 2)));
}

static int method_apply_angular_impulse(lua_State *L)
{
    call c = self(L, "apply_angular_impulse");
    return check(
        &c, plumb_body_apply_angular_impulse(c.world, c.entity, (plumb_real)finite_number(L, 2)));
}

static int method_awake(lua_State *L)
{
    call c = self(L, "awake");
    lua_pushboolean(L, plumb_body_is_awake(c.world, c.entity));
    return 1;
}

static int method_wake(lua_State *L)
{
    call c = self(L, "wake");
    return check(&c, plumb_body_wake(c.world, c.entity));
}

static int method_sleep(lua_State *L)
{
    call c = self(L, "sleep");
    return check(&c, plumb_body_sleep(c.world, c.entity));
}

// ------------------------------------------------------------------------- sensors and filters

// The shapes of the body, in memory that Lua collects; *count is set.
static plumb_entity *shapes_of(const call *c, int *count)
{
    *count = plumb_body_shapes(c->world, c->entity, NULL, 0);
    plumb_entity *list = lua_newuserdatauv(c->s->L, (size_t)(*count + 1) * sizeof *list, 0);
    plumb_body_shapes(c->world, c->entity, list, *count);
    return list;
}

// Bodies that now overlap the sensors of this one, each once, in a list on the stack; how many.
int sc_body_overlaps(scene *s, plumb_body body)
{
    lua_State *L = s->L;
    call c = { .s = s, .world = s->world, .entity = body };
    int count, found = 0;
    sc_need_stack(s, 10);
    lua_newtable(L);
    int result = lua_gettop(L);
    const plumb_entity *shapes = shapes_of(&c, &count);
    for (int i = 0; i < count; i++) {
        if (!plumb_shape_is_sensor(c.world, shapes[i])) {
            continue;
        }
        int seen = plumb_shape_overlaps(c.world, shapes[i], NULL, 0);
        plumb_shape *list = lua_newuserdatauv(L, (size_t)(seen + 1) * sizeof *list, 0);
        plumb_shape_overlaps(c.world, shapes[i], list, seen);
        for (int k = 0; k < seen; k++) {
            const sc_body *b = sc_body_of(s, plumb_shape_body(c.world, list[k]));
            bool known = b == NULL;
            for (int m = 1; m <= found && !known; m++) {
                plumb_body other = PLUMB_NULL_INIT;
                lua_rawgeti(L, result, m);
                known = sc_body_at_index(L, -1, &other) && plumb_same(other, b->entity);
                lua_pop(L, 1);
            }
            if (!known) {
                sc_body_push(s, b);
                lua_rawseti(L, result, ++found);
            }
        }
        lua_pop(L, 1);
    }
    lua_settop(L, result);
    return found;
}

static int method_overlaps(lua_State *L)
{
    call c = self(L, "overlaps");
    int count = 0, sensors = 0;
    const plumb_entity *shapes = shapes_of(&c, &count);
    for (int i = 0; i < count; i++) {
        sensors += plumb_shape_is_sensor(c.world, shapes[i]);
    }
    if (sensors == 0) {
        sc_site site = sc_here(c.s, c.method);
        sc_raise(c.s, SCENE_E_STATE, &site, NULL, 0, NULL, "overlaps() of '%s': it has no sensor",
                 c.body->def.name);
    }
    sc_body_overlaps(c.s, c.entity);
    return 1;
}

// body:set_filter{ collides = {} }: for all shapes of the body, whatever they said themselves.
static int method_set_filter(lua_State *L)
{
    call c = self(L, "set_filter");
    sc_site site = sc_here(c.s, c.method);
    sc_body_def def = { 0 };
    if (lua_gettop(L) != 2 || lua_type(L, 2) != LUA_TTABLE) {
        sc_raise(c.s, SCENE_E_TYPE, &site, NULL, 0, NULL,
                 "set_filter takes one table: body:set_filter{...}");
    }
    sc_read(c.s, &site, &sc_list_filter, 2, &def);
    sc_filter_given g = SC_FILTER_GIVEN(&sc_list_filter, &def, sc_body_def);
    sc_filter_check(c.s, &site, &g);
    plumb_filter f = sc_filter_resolve(c.s, &def.filter, g, &def.filter, g);
    int count;
    const plumb_entity *shapes = shapes_of(&c, &count);
    for (int i = 0; i < count; i++) {
        check(&c, plumb_shape_set_filter(c.world, shapes[i], f));
    }
    sc_filter_record(c.body, &def.filter, g);
    return 0;
}

// -------------------------------------------------------------------------------------- the end

// Joints go with their bodies; their records are ours to forget.
static plumb_result destroy_body(scene *s, plumb_body body)
{
    plumb_joint joint;
    while (plumb_body_joints(s->world, body, &joint, 1) > 0) {
        sc_joint *record = sc_joint_of(s, joint);
        plumb_result r = plumb_joint_destroy(s->world, joint);
        if (r != PLUMB_OK) {
            return r;
        }
        sc_joint_release(s, record);
    }
    plumb_result r = plumb_body_destroy(s->world, body);
    if (r == PLUMB_OK) {
        sc_excluded_forget(s, body);
    }
    return r;
}

static int method_destroy(lua_State *L)
{
    call c = self(L, "destroy");
    check(&c, destroy_body(c.s, c.entity));
    sc_body_release(c.s, c.body);
    return 0;
}

// --------------------------------------------------------------------------------- metamethods

static const luaL_Reg methods[] = {
    { "alive", method_alive },
    { "angle", method_angle },
    { "apply_angular_impulse", method_apply_angular_impulse },
    { "apply_force", method_apply_force },
    { "apply_impulse", method_apply_impulse },
    { "apply_torque", method_apply_torque },
    { "awake", method_awake },
    { "center", method_center },
    { "destroy", method_destroy },
    { "enabled", method_enabled },
    { "inertia", method_inertia },
    { "mass", method_mass },
    { "move_to", method_move_to },
    { "name", method_name },
    { "overlaps", method_overlaps },
    { "position", method_position },
    { "set_color", method_set_color },
    { "set_continuous", method_set_continuous },
    { "set_damping", method_set_damping },
    { "set_enabled", method_set_enabled },
    { "set_filter", method_set_filter },
    { "set_fixed_rotation", method_set_fixed_rotation },
    { "set_gravity_scale", method_set_gravity_scale },
    { "set_label", method_set_label },
    { "set_lock", method_set_lock },
    { "set_mass", method_set_mass },
    { "set_spin", method_set_spin },
    { "set_time_scale", method_set_time_scale },
    { "set_type", method_set_type },
    { "set_velocity", method_set_velocity },
    { "sleep", method_sleep },
    { "speed", method_speed },
    { "spin", method_spin },
    { "teleport", method_teleport },
    { "type", method_type },
    { "velocity", method_velocity },
    { "wake", method_wake },
    { NULL, NULL },
};

_Noreturn static void fail_member(lua_State *L, const char *name)
{
    scene *s = sc_of(L);
    sc_suggest g = sc_suggest_start(name);
    sc_suggest_offer(&g, "user");
    for (const luaL_Reg *m = methods; m->name != NULL; m++) {
        sc_suggest_offer(&g, m->name);
    }
    for (const luaL_Reg *m = sc_character_methods; m->name != NULL; m++) {
        sc_suggest_offer(&g, m->name);
    }
    sc_site site = sc_here(s, name);
    sc_raise(s, SCENE_E_NAME, &site, NULL, 0, sc_suggest_best(&g), "a body has no '%.40s'", name);
}

// body.user, else a method (upvalue 1).
static int body_index(lua_State *L)
{
    scene *s = sc_of(L);
    const char *name = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "?";
    if (strcmp(name, "user") == 0) {
        sc_body *b = self(L, "user").body;
        if (b->user == LUA_NOREF) {
            lua_newtable(L);
            b->user = luaL_ref(L, LUA_REGISTRYINDEX);
        }
        lua_rawgeti(L, LUA_REGISTRYINDEX, b->user);
        return 1;
    }
    (void)s;
    lua_pushvalue(L, 2);
    if (lua_rawget(L, lua_upvalueindex(1)) == LUA_TNIL) {
        fail_member(L, name);
    }
    return 1;
}

static int body_newindex(lua_State *L)
{
    const char *name = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "?";
    scene *s = sc_of(L);
    sc_site site = sc_here(s, name);
    sc_raise(s, SCENE_E_STATE, &site, NULL, 0, NULL,
             "a body's '%.40s' cannot be assigned: call a method, or keep values in body.user",
             name);
}

static int body_tostring(lua_State *L)
{
    const plumb_body *object = luaL_checkudata(L, 1, SC_META_BODY);
    const sc_body *b = sc_body_of(sc_of(L), *object);
    lua_pushstring(L, b == NULL ? "destroyed body" : b->def.name);
    return 1;
}

void sc_open_body(lua_State *L)
{
    luaL_newmetatable(L, SC_META_BODY);
    lua_newtable(L);
    luaL_setfuncs(L, methods, 0);
    luaL_setfuncs(L, sc_character_methods, 0);
    lua_pushcclosure(L, body_index, 1);
    lua_setfield(L, -2, "__index");
    lua_pushcfunction(L, body_newindex);
    lua_setfield(L, -2, "__newindex");
    lua_pushcfunction(L, body_tostring);
    lua_setfield(L, -2, "__tostring");
    lua_pop(L, 1);
}
