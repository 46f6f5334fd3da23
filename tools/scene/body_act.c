// body_act.c - methods of bodies that change them: settings, pushes, sleep, filters; and what their sensors see.
// To add a method: one function, one row in `sc_body_acts`; one that sets a number or a flag: its name in NUMBERS
// or FLAGS.
#include <stdio.h>

#include "internal.h"

// -------------------------------------------------------------------------------------- setters

static int method_set_velocity(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "set_velocity");
    int index = 2;
    return sc_body_check(&c, plumb_body_set_velocity(c.world, c.entity, sc_vector(L, &index)));
}

static int method_set_spin(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "set_spin");
    return sc_body_check(
        &c, plumb_body_set_angular_velocity(c.world, c.entity, (plumb_real)sc_finite_number(L, 2)));
}

static int method_teleport(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "teleport");
    int index = 2;
    plumb_vec2 p = sc_vector(L, &index);
    plumb_real angle = lua_isnoneornil(L, index) ? plumb_body_angle(c.world, c.entity)
                                                 : (plumb_real)sc_finite_number(L, index);
    sc_body_check(&c, plumb_body_teleport(c.world, c.entity, p, angle));
    c.body->def.angle = (double)angle;
    c.body->set_rot = plumb_body_transform(c.world, c.entity).q;
    return 0;
}

// What takes one number or one flag: body:set_mass(2). The world has it, or refuses; the record keeps it as given,
// and whoever writes the scene out writes it.
#define NUMBERS(X)                                                                                 \
    X(ambient)                                                                                     \
    X(attraction)                                                                                  \
    X(break_cells)                                                                                 \
    X(break_energy)                                                                                \
    X(break_force)                                                                                 \
    X(break_impulse)                                                                               \
    X(burn_heat)                                                                                   \
    X(burn_rate)                                                                                   \
    X(charge)                                                                                      \
    X(conductance)                                                                                 \
    X(dipole)                                                                                      \
    X(dipole_angle)                                                                                \
    X(drag)                                                                                        \
    X(emissivity)                                                                                  \
    X(exhaust)                                                                                     \
    X(fuel)                                                                                        \
    X(gravity_scale)                                                                               \
    X(growth)                                                                                      \
    X(heat_capacity)                                                                               \
    X(heating)                                                                                     \
    X(ignition)                                                                                    \
    X(latent_heat)                                                                                 \
    X(mass)                                                                                        \
    X(melt_phase)                                                                                  \
    X(melting_point)                                                                               \
    X(smallest)                                                                                    \
    X(temperature)                                                                                 \
    X(thrust)                                                                                      \
    X(thrust_angle)                                                                                \
    X(thrust_x)                                                                                    \
    X(thrust_y)                                                                                    \
    X(time_scale)
#define FLAGS(X) X(continuous) X(enabled) X(fixed_rotation)

#define NUMBER_SETTER(field)                                                                       \
    static int method_set_##field(lua_State *L)                                                    \
    {                                                                                              \
        sc_body_call c = sc_body_self(L, "set_" #field);                                           \
        double value = sc_finite_number(L, 2);                                                     \
        sc_body_check(&c, plumb_body_set_##field(c.world, c.entity, (plumb_real)value));           \
        c.body->def.field = value;                                                                 \
        SC_GIVE(&sc_list_body, &c.body->def, sc_body_def, field);                                  \
        return 0;                                                                                  \
    }
#define FLAG_SETTER(field)                                                                         \
    static int method_set_##field(lua_State *L)                                                    \
    {                                                                                              \
        sc_body_call c = sc_body_self(L, "set_" #field);                                           \
        luaL_checktype(L, 2, LUA_TBOOLEAN);                                                        \
        bool value = lua_toboolean(L, 2) != 0;                                                     \
        sc_body_check(&c, plumb_body_set_##field(c.world, c.entity, value));                       \
        c.body->def.field = value;                                                                 \
        SC_GIVE(&sc_list_body, &c.body->def, sc_body_def, field);                                  \
        return 0;                                                                                  \
    }
NUMBERS(NUMBER_SETTER)
FLAGS(FLAG_SETTER)

// ------------------------------------------------------------------------------ taking part

static int method_set_type(lua_State *L)
{
    static const plumb_body_type all[] = { PLUMB_DYNAMIC, PLUMB_KINEMATIC, PLUMB_STATIC };
    sc_body_call c = sc_body_self(L, "set_type");
    int type = luaL_checkoption(L, 2, NULL, sc_body_types);
    sc_body_check(&c, plumb_body_set_type(c.world, c.entity, all[type]));
    c.body->def.type = type;
    return 0;
}

static int method_enabled(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "enabled");
    lua_pushboolean(L, plumb_body_is_enabled(c.world, c.entity));
    return 1;
}

// body:set_lock("x", "rotation"): these axes and no others.
static int method_set_lock(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "set_lock");
    int axes = 0;
    for (int i = 2; i <= lua_gettop(L); i++) {
        int bit = sc_axis_bit(luaL_checkstring(L, i));
        luaL_argcheck(L, bit != 0, i, "must be \"x\", \"y\" or \"rotation\"");
        axes |= bit;
    }
    plumb_axis_locks locks = { .x = (axes & SC_LOCK_X) != 0,
                               .y = (axes & SC_LOCK_Y) != 0,
                               .rotation = (axes & SC_LOCK_ROTATION) != 0 };
    sc_body_check(&c, plumb_body_set_locks(c.world, c.entity, locks));
    c.body->def.lock = axes;
    c.body->def.fixed_rotation = false;
    SC_GIVE(&sc_list_body, &c.body->def, sc_body_def, lock);
    return 0;
}

// body:set_damping(c [, c of the spin])
static int method_set_damping(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "set_damping");
    double linear = sc_finite_number(L, 2);
    double angular = lua_isnoneornil(L, 3) ? c.body->def.angular_damping : sc_finite_number(L, 3);
    sc_body_check(
        &c, plumb_body_set_damping(c.world, c.entity, (plumb_real)linear, (plumb_real)angular));
    c.body->def.damping = linear;
    c.body->def.angular_damping = angular;
    SC_GIVE(&sc_list_body, &c.body->def, sc_body_def, damping);
    SC_GIVE(&sc_list_body, &c.body->def, sc_body_def, angular_damping);
    return 0;
}

// body:move_to(x, y [, angle [, seconds [, vx, vy [, spin]]]]): by default within the next step. With a velocity it arrives with that,
// by a smooth path.
static int method_move_to(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "move_to");
    int index = 2;
    plumb_vec2 p = sc_vector(L, &index);
    plumb_real angle = lua_isnoneornil(L, index) ? plumb_body_angle(c.world, c.entity)
                                                 : (plumb_real)sc_finite_number(L, index);
    double time = lua_isnoneornil(L, index + 1) ? c.s->dt : sc_finite_number(L, index + 1);
    index += 2;
    if (lua_isnoneornil(L, index)) {
        return sc_body_check(&c,
                             plumb_body_set_target(c.world, c.entity, p, angle, (plumb_real)time));
    }
    const plumb_vec2 v = sc_vector(L, &index);
    const double spin = lua_isnoneornil(L, index) ? 0 : sc_finite_number(L, index);
    return sc_body_check(&c, plumb_body_set_target_moving(c.world, c.entity, p, angle, v,
                                                          (plumb_real)spin, (plumb_real)time));
}

static int method_set_label(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "set_label");
    snprintf(c.body->def.label, sizeof c.body->def.label, "%s", luaL_checkstring(L, 2));
    SC_GIVE(&sc_list_body, &c.body->def, sc_body_def, label);
    return 0;
}

static int method_set_color(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "set_color");
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

typedef plumb_result push_fn(plumb_world *, plumb_body, plumb_vec2);
typedef plumb_result push_at_fn(plumb_world *, plumb_body, plumb_vec2, plumb_vec2 point);
typedef plumb_result turn_fn(plumb_world *, plumb_body, plumb_real);

// body:apply_force(fx, fy [, px, py]): at the centre of mass when no point is given.
static int push(lua_State *L, const char *method, push_fn *at_center, push_at_fn *at_point)
{
    sc_body_call c = sc_body_self(L, method);
    int index = 2;
    plumb_vec2 v = sc_vector(L, &index);
    if (lua_isnoneornil(L, index)) {
        return sc_body_check(&c, at_center(c.world, c.entity, v));
    }
    return sc_body_check(&c, at_point(c.world, c.entity, v, sc_vector(L, &index)));
}

static int turn(lua_State *L, const char *method, turn_fn *turn_body)
{
    sc_body_call c = sc_body_self(L, method);
    return sc_body_check(&c, turn_body(c.world, c.entity, (plumb_real)sc_finite_number(L, 2)));
}

static int method_apply_force(lua_State *L)
{
    return push(L, "apply_force", plumb_body_apply_force_center, plumb_body_apply_force);
}

static int method_apply_impulse(lua_State *L)
{
    return push(L, "apply_impulse", plumb_body_apply_impulse_center, plumb_body_apply_impulse);
}

static int method_apply_torque(lua_State *L)
{
    return turn(L, "apply_torque", plumb_body_apply_torque);
}

static int method_apply_angular_impulse(lua_State *L)
{
    return turn(L, "apply_angular_impulse", plumb_body_apply_angular_impulse);
}

static int method_awake(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "awake");
    lua_pushboolean(L, plumb_body_is_awake(c.world, c.entity));
    return 1;
}

static int method_wake(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "wake");
    return sc_body_check(&c, plumb_body_wake(c.world, c.entity));
}

static int method_sleep(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "sleep");
    return sc_body_check(&c, plumb_body_sleep(c.world, c.entity));
}

// ------------------------------------------------------------------------- sensors and filters

// The shapes of the body, in memory that Lua collects; *count is set.
static plumb_shape *shapes_of(const sc_body_call *c, int *count)
{
    *count = plumb_body_shapes(c->world, c->entity, NULL, 0);
    sc_work(c->s, 10 * (uint64_t)*count);
    plumb_shape *list = lua_newuserdatauv(c->s->L, (size_t)(*count + 1) * sizeof *list, 0);
    plumb_body_shapes(c->world, c->entity, list, *count);
    return list;
}

// Bodies that now overlap the sensors of this one, each once, in a list on the stack; how many.
int sc_body_overlaps(scene *s, plumb_body body)
{
    lua_State *L = s->L;
    sc_body_call c = { .s = s, .world = s->world, .entity = body };
    int count, found = 0;
    sc_need_stack(s, 10);
    lua_newtable(L);
    int result = lua_gettop(L);
    const plumb_shape *shapes = shapes_of(&c, &count);
    s->list_number++;
    for (int i = 0; i < count; i++) {
        if (!plumb_shape_is_sensor(c.world, shapes[i])) {
            continue;
        }
        int seen = plumb_shape_overlaps(c.world, shapes[i], NULL, 0);
        plumb_shape *list = lua_newuserdatauv(L, (size_t)(seen + 1) * sizeof *list, 0);
        plumb_shape_overlaps(c.world, shapes[i], list, seen);
        sc_work(s, 10 * (uint64_t)seen);
        for (int k = 0; k < seen; k++) {
            sc_body *b = sc_body_of(s, plumb_shape_body(c.world, list[k]));
            if (b != NULL && b->listed != s->list_number) {
                b->listed = s->list_number;
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
    sc_body_call c = sc_body_self(L, "overlaps");
    int count = 0, sensors = 0;
    const plumb_shape *shapes = shapes_of(&c, &count);
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
    sc_body_call c = sc_body_self(L, "set_filter");
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
    const plumb_shape *shapes = shapes_of(&c, &count);
    for (int i = 0; i < count; i++) {
        sc_body_check(&c, plumb_shape_set_filter(c.world, shapes[i], f));
    }
    sc_filter_record(c.body, &def.filter, g);
    return 0;
}

const luaL_Reg sc_body_acts[] = {
    { "apply_angular_impulse", method_apply_angular_impulse },
    { "apply_force", method_apply_force },
    { "apply_impulse", method_apply_impulse },
    { "apply_torque", method_apply_torque },
    { "awake", method_awake },
    { "enabled", method_enabled },
    { "move_to", method_move_to },
    { "overlaps", method_overlaps },
    { "set_color", method_set_color },
    { "set_damping", method_set_damping },
    { "set_filter", method_set_filter },
    { "set_label", method_set_label },
    { "set_lock", method_set_lock },
    { "set_spin", method_set_spin },
    { "set_type", method_set_type },
    { "set_velocity", method_set_velocity },
    { "sleep", method_sleep },
    { "teleport", method_teleport },
    { "wake", method_wake },
#define SETTER_ROW(field) { "set_" #field, method_set_##field },
    NUMBERS(SETTER_ROW) FLAGS(SETTER_ROW){ NULL, NULL },
};
