// joint_api.c - joints as Lua objects: the methods that handlers and test functions call.
// An object holds the world's handle only, so a joint that broke or went with its body is noticed;
// its record hangs on the world's user data. To add a method: one function, one row in `methods`.
#include <stdio.h>
#include <string.h>

#include "internal.h"

void sc_joint_push(scene *s, plumb_joint joint)
{
    plumb_joint *object = lua_newuserdatauv(s->L, sizeof *object, 0);
    *object = joint;
    luaL_setmetatable(s->L, SC_META_JOINT);
}

// ------------------------------------------------------------------------------------ arguments

/// What a method needs: filled by `self`.
typedef struct call {
    scene *s;
    plumb_world *world;
    sc_joint *joint;
    plumb_joint entity;
    const char *method;
} call;

static call self(lua_State *L, const char *method)
{
    call c = { .s = sc_of(L), .method = method };
    sc_work(c.s, 10);
    sc_site site = sc_here(c.s, method);
    if (!sc_joint_at_index(L, 1, &c.entity)) {
        sc_raise(c.s, SCENE_E_TYPE, &site, NULL, 0, NULL, "%s is a method: write joint:%s(...)",
                 method, method);
    }
    c.world = c.s->world;
    c.joint = sc_joint_of(c.s, c.entity);
    if (c.joint == NULL) {
        sc_raise(c.s, SCENE_E_STATE, &site, NULL, 0, NULL, "%s() of a joint that is gone", method);
    }
    return c;
}

_Noreturn static void fail_state(const call *c, const char *what)
{
    sc_site site = sc_here(c->s, c->method);
    sc_raise(c->s, SCENE_E_STATE, &site, NULL, 0, NULL, "%s() of '%s': a %s joint has no %s",
             c->method, c->joint->def.name, plumb_joint_kind_name(c->joint->def.kind), what);
}

static int check(const call *c, plumb_result result, const char *what)
{
    if (result == PLUMB_E_STATE) {
        fail_state(c, what);
    }
    if (result != PLUMB_OK) {
        sc_site site = sc_here(c->s, c->method);
        sc_refused(c->s, &site, NULL, result, "%s() of '%s'", c->method, c->joint->def.name);
    }
    return 0;
}

static int push_body(const call *c, plumb_body body)
{
    const sc_body *b = sc_body_of(c->s, body);
    if (b == NULL) {
        lua_getglobal(c->s->L, "world");
    } else {
        sc_body_push(c->s, b);
    }
    return 1;
}

static plumb_joint_desc settings(const call *c)
{
    plumb_joint_desc d = { .kind = c->joint->def.kind };
    plumb_joint_settings(c->world, c->entity, &d);
    return d;
}

// -------------------------------------------------------------------------------------- getters

static int method_name(lua_State *L)
{
    lua_pushstring(L, self(L, "name").joint->def.name);
    return 1;
}

static int method_kind(lua_State *L)
{
    lua_pushstring(L, plumb_joint_kind_name(self(L, "kind").joint->def.kind));
    return 1;
}

static int method_alive(lua_State *L)
{
    const plumb_joint *object = luaL_checkudata(L, 1, SC_META_JOINT);
    lua_pushboolean(L, sc_joint_of(sc_of(L), *object) != NULL);
    return 1;
}

static int method_a(lua_State *L)
{
    call c = self(L, "a");
    return push_body(&c, plumb_joint_body_a(c.world, c.entity));
}

static int method_b(lua_State *L)
{
    call c = self(L, "b");
    return push_body(&c, plumb_joint_body_b(c.world, c.entity));
}

static int method_anchor_a(lua_State *L)
{
    call c = self(L, "anchor_a");
    return sc_push_vector(L, plumb_joint_anchor_a(c.world, c.entity));
}

static int method_anchor_b(lua_State *L)
{
    call c = self(L, "anchor_b");
    return sc_push_vector(L, plumb_joint_anchor_b(c.world, c.entity));
}

static int method_value(lua_State *L)
{
    call c = self(L, "value");
    return sc_push_real(L, plumb_joint_value(c.world, c.entity));
}

static int method_angle(lua_State *L)
{
    call c = self(L, "angle");
    switch (c.joint->def.kind) {
    case PLUMB_REVOLUTE:
    case PLUMB_WELD:
    case PLUMB_MOTOR:
    case PLUMB_RATCHET:
    case PLUMB_FRICTION:
        return sc_push_real(L, plumb_joint_value(c.world, c.entity));
    default:
        fail_state(&c, "angle: see value()");
    }
}

static int method_error(lua_State *L)
{
    call c = self(L, "error");
    return sc_push_real(L, plumb_joint_error(c.world, c.entity));
}

// Force and torque of a joint: of the world, or of what moves it instead.
static plumb_vec2 bears(lua_State *L, const call *c, double *torque)
{
    const scene_options *options = &sc_of(L)->options;
    plumb_vec2 force = plumb_joint_force(c->world, c->entity);
    *torque = (double)plumb_joint_torque(c->world, c->entity);
    if (options->joint_force != NULL) {
        double other[2] = { 0 };
        options->joint_force(options->step_context, c->entity, other, torque);
        force = (plumb_vec2){ (plumb_real)other[0], (plumb_real)other[1] };
    }
    return force;
}

static int method_force(lua_State *L)
{
    call c = self(L, "force");
    double torque;
    return sc_push_vector(L, bears(L, &c, &torque));
}

// impulse(): x, y [N s] on b over the last step; turn [N m s] as the third. With tell_impulse, or a bound of breaking.
static int method_impulse(lua_State *L)
{
    call c = self(L, "impulse");
    const plumb_joint_desc d = settings(&c);
    if (!d.tell_impulse && !(d.break_force > 0 || d.break_torque > 0 || d.break_impulse > 0 ||
                             d.event_force > 0 || d.event_torque > 0)) {
        fail_state(&c, "sum of impulses: say tell_impulse = true");
    }
    const int count = sc_push_vector(L, plumb_joint_impulse(c.world, c.entity));
    return count + sc_push_real(L, plumb_joint_angular_impulse(c.world, c.entity));
}

static int method_torque(lua_State *L)
{
    call c = self(L, "torque");
    double torque;
    (void)bears(L, &c, &torque);
    return sc_push_real(L, (plumb_real)torque);
}

static int method_reaction(lua_State *L)
{
    call c = self(L, "reaction");
    double torque;
    return sc_push_real(L, plumb_vec2_magnitude(bears(L, &c, &torque)));
}

// -------------------------------------------------------------------------------------- setters

// set_limits(lower, upper); set_limits() takes them away.
static int method_set_limits(lua_State *L)
{
    call c = self(L, "set_limits");
    bool on = !lua_isnoneornil(L, 2);
    plumb_real lower = on ? (plumb_real)sc_finite_number(L, 2) : 0;
    plumb_real upper = on ? (plumb_real)sc_finite_number(L, 3) : 0;
    return check(&c, plumb_joint_set_limit(c.world, c.entity, on, lower, upper), "limits");
}

static int method_set_restitution(lua_State *L)
{
    call c = self(L, "set_restitution");
    return check(&c,
                 plumb_joint_set_restitution(c.world, c.entity, (plumb_real)sc_finite_number(L, 2)),
                 "limit");
}

// set_motor(speed, torque or force); set_motor() switches it off.
static int method_set_motor(lua_State *L)
{
    call c = self(L, "set_motor");
    bool on = !lua_isnoneornil(L, 2);
    plumb_real speed = on ? (plumb_real)sc_finite_number(L, 2) : 0;
    plumb_real most = on ? (plumb_real)sc_finite_number(L, 3) : 0;
    return check(&c, plumb_joint_set_motor(c.world, c.entity, on, speed, most), "motor");
}

static int method_set_motor_speed(lua_State *L)
{
    call c = self(L, "set_motor_speed");
    plumb_joint_desc d = settings(&c);
    if (!d.enable_motor) {
        fail_state(&c, "motor that is on: call set_motor(speed, torque or force)");
    }
    return check(&c,
                 plumb_joint_set_motor(c.world, c.entity, true, (plumb_real)sc_finite_number(L, 2),
                                       d.max_motor),
                 "motor");
}

// set_spring(frequency, damping [, rest]); set_spring() makes it rigid, or takes the spring away.
static int method_set_spring(lua_State *L)
{
    call c = self(L, "set_spring");
    plumb_joint_desc d = settings(&c);
    plumb_real hertz = lua_isnoneornil(L, 2) ? 0 : (plumb_real)sc_finite_number(L, 2);
    plumb_real damping = lua_isnoneornil(L, 3) ? 0 : (plumb_real)sc_finite_number(L, 3);
    plumb_real rest = lua_isnoneornil(L, 4) ? d.rest : (plumb_real)sc_finite_number(L, 4);
    return check(&c, plumb_joint_set_spring(c.world, c.entity, hertz, damping, rest), "spring");
}

// set_stiffness(stiffness, damper [, rest]), in N/m and N s/m, or by the radian.
static int method_set_stiffness(lua_State *L)
{
    call c = self(L, "set_stiffness");
    plumb_joint_desc d = settings(&c);
    plumb_real stiffness = lua_isnoneornil(L, 2) ? 0 : (plumb_real)sc_finite_number(L, 2);
    plumb_real damper = lua_isnoneornil(L, 3) ? 0 : (plumb_real)sc_finite_number(L, 3);
    plumb_real rest = lua_isnoneornil(L, 4) ? d.rest : (plumb_real)sc_finite_number(L, 4);
    return check(&c, plumb_joint_set_stiffness(c.world, c.entity, stiffness, damper, rest),
                 "spring");
}

// Motor: the angle that is wanted; others: where the spring is at rest.
static int method_set_rest(lua_State *L)
{
    call c = self(L, "set_rest");
    plumb_joint_desc d = settings(&c);
    plumb_real rest = (plumb_real)sc_finite_number(L, 2);
    const bool stiff = d.stiffness > 0 || d.damper > 0;
    return check(&c,
                 stiff ? plumb_joint_set_stiffness(c.world, c.entity, d.stiffness, d.damper, rest)
                       : plumb_joint_set_spring(c.world, c.entity, d.hertz, d.damping, rest),
                 "spring");
}

static int method_set_target(lua_State *L)
{
    call c = self(L, "set_target");
    int index = 2;
    plumb_vec2 target = sc_vector(L, &index);
    return check(&c, plumb_joint_set_target(c.world, c.entity, target), "target");
}

// set_break(force [, torque]); 0 or nothing: it does not break.
static int method_set_break(lua_State *L)
{
    call c = self(L, "set_break");
    plumb_real force = lua_isnoneornil(L, 2) ? 0 : (plumb_real)sc_finite_number(L, 2);
    plumb_real torque = lua_isnoneornil(L, 3) ? 0 : (plumb_real)sc_finite_number(L, 3);
    return check(&c, plumb_joint_set_break(c.world, c.entity, force, torque), "break");
}

// set_break_impulse(impulse); 0 or nothing: no impulse breaks it.
static int method_set_break_impulse(lua_State *L)
{
    call c = self(L, "set_break_impulse");
    plumb_real impulse = lua_isnoneornil(L, 2) ? 0 : (plumb_real)sc_finite_number(L, 2);
    return check(&c, plumb_joint_set_break_impulse(c.world, c.entity, impulse), "break");
}

static int method_rate(lua_State *L)
{
    call c = self(L, "rate");
    return sc_push_real(L, plumb_joint_rate(c.world, c.entity));
}

static int method_destroy(lua_State *L)
{
    call c = self(L, "destroy");
    sc_work(c.s, 100 + (uint64_t)c.s->joints.count / 8);
    check(&c, plumb_joint_destroy(c.world, c.entity), "end");
    sc_joint_release(c.s, c.joint);
    return 0;
}

// --------------------------------------------------------------------------------- metamethods

static const luaL_Reg methods[] = {
    { "a", method_a },
    { "alive", method_alive },
    { "anchor_a", method_anchor_a },
    { "anchor_b", method_anchor_b },
    { "angle", method_angle },
    { "b", method_b },
    { "destroy", method_destroy },
    { "error", method_error },
    { "force", method_force },
    { "impulse", method_impulse },
    { "kind", method_kind },
    { "name", method_name },
    { "rate", method_rate },
    { "reaction", method_reaction },
    { "set_break", method_set_break },
    { "set_break_impulse", method_set_break_impulse },
    { "set_limits", method_set_limits },
    { "set_motor", method_set_motor },
    { "set_motor_speed", method_set_motor_speed },
    { "set_rest", method_set_rest },
    { "set_restitution", method_set_restitution },
    { "set_spring", method_set_spring },
    { "set_stiffness", method_set_stiffness },
    { "set_target", method_set_target },
    { "torque", method_torque },
    { "value", method_value },
    { NULL, NULL },
};

// Upvalue 1: the methods.
static int joint_index(lua_State *L)
{
    lua_pushvalue(L, 2);
    if (lua_rawget(L, lua_upvalueindex(1)) == LUA_TNIL) {
        scene *s = sc_of(L);
        const char *name = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "?";
        sc_suggest g = sc_suggest_start(name);
        for (const luaL_Reg *m = methods; m->name != NULL; m++) {
            sc_suggest_offer(&g, m->name);
        }
        sc_site site = sc_here(s, name);
        sc_raise(s, SCENE_E_NAME, &site, NULL, 0, sc_suggest_best(&g), "a joint has no '%.40s'",
                 name);
    }
    return 1;
}

static int joint_newindex(lua_State *L)
{
    const char *name = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "?";
    scene *s = sc_of(L);
    sc_site site = sc_here(s, name);
    sc_raise(s, SCENE_E_STATE, &site, NULL, 0, NULL,
             "a joint's '%.40s' cannot be assigned: call a method", name);
}

static int joint_equal(lua_State *L)
{
    const plumb_joint *a = luaL_testudata(L, 1, SC_META_JOINT);
    const plumb_joint *b = luaL_testudata(L, 2, SC_META_JOINT);
    lua_pushboolean(L, a != NULL && b != NULL && plumb_same(*a, *b));
    return 1;
}

static int joint_tostring(lua_State *L)
{
    const plumb_joint *object = luaL_checkudata(L, 1, SC_META_JOINT);
    const sc_joint *j = sc_joint_of(sc_of(L), *object);
    lua_pushstring(L, j == NULL ? "joint that is gone" : j->def.name);
    return 1;
}

static int lua_find_joint(lua_State *L)
{
    scene *s = sc_of(L);
    const sc_joint *j = sc_joint_named(s, luaL_checkstring(L, 1));
    if (j == NULL) {
        sc_missed_set(s, "find_joint", lua_tostring(L, 1));
        lua_pushnil(L);
    } else {
        sc_joint_push(s, j->entity);
    }
    return 1;
}

static int lua_joint_count(lua_State *L)
{
    lua_pushinteger(L, sc_of(L)->joints.count);
    return 1;
}

void sc_open_joint(lua_State *L)
{
    luaL_newmetatable(L, SC_META_JOINT);
    lua_newtable(L);
    luaL_setfuncs(L, methods, 0);
    lua_pushcclosure(L, joint_index, 1);
    lua_setfield(L, -2, "__index");
    lua_pushcfunction(L, joint_newindex);
    lua_setfield(L, -2, "__newindex");
    lua_pushcfunction(L, joint_equal);
    lua_setfield(L, -2, "__eq");
    lua_pushcfunction(L, joint_tostring);
    lua_setfield(L, -2, "__tostring");
    lua_pop(L, 1);
    lua_register(L, "find_joint", lua_find_joint);
    lua_register(L, "joint_count", lua_joint_count);
}
