// characters.c - character{}, the table `character` of a body, one-way platforms, and the methods
// with which handlers drive characters. To add a key: a member in defs.h, a row in lists_play.c, a
// line in `describe`.
#include <math.h>
#include <string.h>

#include "internal.h"

#define LIST             (&sc_list_character)
#define HAS(def, member) SC_GIVEN(LIST, (def), sc_character_def, member)

// ------------------------------------------------------------------------------------- building

static plumb_character_desc describe(const sc_character_def *d)
{
    double slope =
        HAS(d, max_slope_deg) ? d->max_slope_deg * (3.141592653589793 / 180) : d->max_slope;
    return (plumb_character_desc){
        .up = { (plumb_real)d->up[0], (plumb_real)d->up[1] },
        .max_slope = (plumb_real)slope,
        .skin = (plumb_real)d->skin,
        .step_height = (plumb_real)d->step_height,
        .step_width = (plumb_real)d->step_width,
        .snap_distance = (plumb_real)d->snap_distance,
        .acceleration = (plumb_real)d->acceleration,
        .air_acceleration = (plumb_real)d->air_acceleration,
        .max_fall_speed = (plumb_real)d->max_fall_speed,
        .mass = (plumb_real)d->mass,
        .push_force = (plumb_real)d->push_force,
        .no_steps = HAS(d, steps) && !d->steps,
        .no_snap = HAS(d, snap) && !d->snap,
        .no_push = HAS(d, push) && !d->push,
        .no_air_control = HAS(d, air_control) && !d->air_control,
    };
}

static bool given(const sc_character_def *d, const char *name)
{
    for (int i = 0; i < LIST->count; i++) {
        if (strcmp(LIST->rows[i].name, name) == 0) {
            return (d->present >> i & 1) != 0;
        }
    }
    return false;
}

// What would have no effect.
static void check_conflicts(scene *s, const sc_site *site, const sc_body *b)
{
    const sc_character_def *d = &b->def.character;
    static const char *const kinematic[] = { "mass",          "max_fall_speed", "push",
                                             "push_force",    "skin",           "snap",
                                             "snap_distance", "step_height",    "step_width",
                                             "steps" };
    const struct {
        const char *key, *off;
        bool is_off;
    } pairs[] = {
        { "step_height", "steps", HAS(d, steps) && !d->steps },
        { "step_width", "steps", HAS(d, steps) && !d->steps },
        { "snap_distance", "snap", HAS(d, snap) && !d->snap },
        { "push_force", "push", HAS(d, push) && !d->push },
        { "air_acceleration", "air_control", HAS(d, air_control) && !d->air_control },
    };
    if (HAS(d, max_slope) && HAS(d, max_slope_deg)) {
        sc_raise(s, SCENE_E_CONFLICT, site, "character", 0, NULL,
                 "character{} has both 'max_slope' and 'max_slope_deg'");
    }
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        if (pairs[i].is_off && given(d, pairs[i].key)) {
            sc_raise(s, SCENE_E_CONFLICT, site, "character", 0, NULL,
                     "character{} cannot have '%s' with %s = false", pairs[i].key, pairs[i].off);
        }
    }
    for (size_t i = 0; b->def.type == 0 && i < sizeof kinematic / sizeof *kinematic; i++) {
        if (given(d, kinematic[i])) {
            sc_raise(s, SCENE_E_CONFLICT, site, "character", 0, NULL,
                     "a dynamic character{} cannot have '%s'", kinematic[i]);
        }
    }
    if (b->def.type == 2) {
        sc_raise(s, SCENE_E_CONFLICT, site, "character", 0, NULL,
                 "a static body{} cannot be a character");
    }
}

void sc_character_make(scene *s, const sc_site *site, const sc_body *b)
{
    const sc_character_def *d = &b->def.character;
    check_conflicts(s, site, b);
    plumb_character_desc desc = describe(d);
    plumb_result r = plumb_character_create(s->world, b->entity, &desc);
    if (r != PLUMB_OK) {
        sc_refused(s, site, "character", r, "character{}");
    }
    if (HAS(d, gravity_scale)) {
        plumb_body_set_gravity_scale(s->world, b->entity, (plumb_real)d->gravity_scale);
    }
}

plumb_one_way sc_one_way_of(const sc_body_def *d)
{
    return (plumb_one_way){ { (plumb_real)d->one_way[0], (plumb_real)d->one_way[1] },
                            (plumb_real)d->one_way_angle };
}

void sc_one_way_check(scene *s, const sc_site *site, const sc_body_def *d)
{
    bool given = SC_GIVEN(&sc_list_body, d, sc_body_def, one_way);
    if (given && d->one_way[0] == 0 && d->one_way[1] == 0) {
        sc_raise(s, SCENE_E_RANGE, site, "one_way", 0, NULL,
                 "'one_way' of body{} must be a direction: {0, 1} lets things up through it");
    }
    if (!given && SC_GIVEN(&sc_list_body, d, sc_body_def, one_way_angle)) {
        sc_raise(s, SCENE_E_MISSING, site, "one_way_angle", 0, NULL,
                 "'one_way_angle' of body{} needs 'one_way'");
    }
}

// Sets a key of the table on top unless the author has; the value is what `push` pushes.
static bool lacks(lua_State *L, const char *key)
{
    bool missing = lua_getfield(L, 1, key) == LUA_TNIL;
    lua_pop(L, 1);
    return missing;
}

// character{...} is body{...} that walks: kinematic, and an upright capsule unless it says otherwise.
static int lua_character(lua_State *L)
{
    if (lua_gettop(L) == 1 && lua_type(L, 1) == LUA_TTABLE) {
        if (lacks(L, "type")) {
            lua_pushliteral(L, "kinematic");
            lua_setfield(L, 1, "type");
        }
        if (lacks(L, "character")) {
            lua_newtable(L);
            lua_setfield(L, 1, "character");
        }
        if (lacks(L, "shapes") && lua_rawlen(L, 1) == 0) {
            lua_getglobal(L, "capsule");
            lua_createtable(L, 0, 3);
            lua_pushnumber(L, 1.2);
            lua_setfield(L, -2, "length");
            lua_pushnumber(L, 0.3);
            lua_setfield(L, -2, "r");
            lua_pushnumber(L, 90);
            lua_setfield(L, -2, "angle_deg");
            lua_call(L, 1, 1);
            lua_rawseti(L, 1, 1);
        }
    }
    return sc_construct(L, "character", sc_build_body, 1);
}

// -------------------------------------------------------------------------------------- methods

_Noreturn static void fail(const sc_body_call *c, scene_code code, const char *why)
{
    sc_site site = sc_here(c->s, c->method);
    sc_raise(c->s, code, &site, NULL, 0, NULL, "%s() of '%s': %s", c->method, c->body->def.name,
             why);
}

static sc_body_call character(lua_State *L, const char *method)
{
    sc_body_call c = sc_body_self(L, method);
    if (!plumb_body_is_character(c.world, c.entity)) {
        fail(&c, SCENE_E_STATE, "it is no character");
    }
    return c;
}

static int method_walk(lua_State *L)
{
    sc_body_call c = character(L, "walk");
    sc_body_check(&c, plumb_character_walk(c.world, c.entity, (plumb_real)luaL_checknumber(L, 2)));
    return 0;
}

static int method_fly(lua_State *L)
{
    sc_body_call c = character(L, "fly");
    int index = 2;
    sc_body_check(&c, plumb_character_fly(c.world, c.entity, sc_vector(L, &index)));
    return 0;
}

// hero:jump(5): whether it did.
static int method_jump(lua_State *L)
{
    sc_body_call c = character(L, "jump");
    double speed = luaL_checknumber(L, 2);
    if (!(speed > 0 && speed <= 1e6)) {
        fail(&c, SCENE_E_RANGE, "the speed must be above 0 and at most 1e+06 m/s");
    }
    lua_pushboolean(L, plumb_character_jump(c.world, c.entity, (plumb_real)speed));
    return 1;
}

static int method_throw(lua_State *L)
{
    sc_body_call c = character(L, "throw");
    int index = 2;
    sc_body_check(&c, plumb_character_set_velocity(c.world, c.entity, sc_vector(L, &index)));
    return 0;
}

// Through the one-way shapes under it; of a character, whether there was one.
static int method_drop(lua_State *L)
{
    sc_body_call c = sc_body_self(L, "drop");
    if (plumb_body_is_character(c.world, c.entity)) {
        lua_pushboolean(L, plumb_character_drop(c.world, c.entity));
        return 1;
    }
    plumb_result r = plumb_body_drop_through(c.world, c.entity);
    if (r != PLUMB_OK) {
        fail(&c, SCENE_E_STATE, "only dynamic bodies and characters drop");
    }
    return 0;
}

static plumb_character_state state_of(const sc_body_call *c)
{
    plumb_character_state state;
    sc_body_check(c, plumb_character_get(c->world, c->entity, &state));
    return state;
}

static int method_on_ground(lua_State *L)
{
    sc_body_call c = character(L, "on_ground");
    lua_pushboolean(L, state_of(&c).on_ground);
    return 1;
}

// The body that it stands on, then the normal of the ground; nil in the air.
static int method_ground(lua_State *L)
{
    sc_body_call c = character(L, "ground");
    plumb_character_state state = state_of(&c);
    const sc_body *b = sc_body_of(c.s, state.ground_body);
    if (b == NULL) {
        lua_pushnil(L);
        return 1;
    }
    sc_body_push(c.s, b);
    lua_pushnumber(L, (double)state.ground_normal.x);
    lua_pushnumber(L, (double)state.ground_normal.y);
    return 3;
}

const luaL_Reg sc_character_methods[] = {
    { "drop", method_drop },           { "fly", method_fly },
    { "ground", method_ground },       { "jump", method_jump },
    { "on_ground", method_on_ground }, { "throw", method_throw },
    { "walk", method_walk },           { NULL, NULL },
};

void sc_open_characters(lua_State *L)
{
    lua_register(L, "character", lua_character);
}
