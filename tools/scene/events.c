// events.c - what a script does about what happened in a step: on_contact, on_end, on_hit, on_enter,
// on_leave, on_break, on_strain, from copies of the world's event arrays (a handler may make and destroy
// things); and edit_contact, which is asked in the middle of a step, after the narrow phase.
// Handlers of one kind are called in the order in which they were registered. Cost: O(events *
// handlers of their kind); kinds without handlers are not looked at.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "internal.h"

static const struct {
    const char *name;
    sc_handler_kind kind;
    const sc_list *list;
} kinds[] = {
    { "on_contact", SC_ON_CONTACT, &sc_list_contact },
    { "on_end", SC_ON_END, &sc_list_contact },
    { "on_hit", SC_ON_HIT, &sc_list_hit },
    { "on_enter", SC_ON_ENTER, &sc_list_contact },
    { "on_leave", SC_ON_LEAVE, &sc_list_contact },
    { "on_break", SC_ON_BREAK, &sc_list_break },
    { "on_strain", SC_ON_STRAIN, &sc_list_break },
    { "edit_contact", SC_EDIT_CONTACT, &sc_list_contact },
};
enum { KINDS = (int)(sizeof kinds / sizeof kinds[0]) };

static const double HIT_SPEED = 1; // [m/s] above which on_hit is told when it does not say

const char *sc_handler_name(sc_handler_kind kind)
{
    for (int i = 0; i < KINDS; i++) {
        if (kinds[i].kind == kind) {
            return kinds[i].name;
        }
    }
    return kind == SC_FIELD        ? "field"
           : kind == SC_EVERY      ? "every"
           : kind == SC_EVERY_STEP ? "every_step"
                                   : "at";
}

static bool has_kind(const scene *s, sc_handler_kind kind)
{
    for (int i = 0; i < s->handlers.count; i++) {
        if (s->handlers.items[i].kind == kind) {
            return true;
        }
    }
    return false;
}

// ------------------------------------------------------------------------------------ registering

// The world tells of blows that any handler wants.
static void set_hit_speed(scene *s, const sc_site *site)
{
    double least = HUGE_VAL;
    sc_work(s, (uint64_t)s->handlers.count);
    for (int i = 0; i < s->handlers.count; i++) {
        const sc_handler *h = &s->handlers.items[i];
        least = h->kind == SC_ON_HIT ? fmin(least, h->contact.speed) : least;
    }
    plumb_result r = plumb_world_set_hit_speed(s->world, (plumb_real)least);
    if (r != PLUMB_OK) {
        sc_refused(s, site, NULL, r, "on_hit");
    }
}

static void open_edits(scene *s, const sc_site *site);

// on_contact(function) or on_contact{a = ..., b = ..., function}. Upvalue: place in `kinds`.
static int lua_event(lua_State *L)
{
    scene *s = sc_of(L);
    int k = (int)lua_tointeger(L, lua_upvalueindex(1));
    sc_site site = sc_here(s, kinds[k].name);
    if (lua_gettop(L) == 1 && lua_type(L, 1) == LUA_TFUNCTION) {
        lua_createtable(L, 1, 0);
        lua_insert(L, 1);
        lua_rawseti(L, 1, 1);
    }
    if (lua_gettop(L) != 1 || lua_type(L, 1) != LUA_TTABLE) {
        const char *keys = kinds[k].list == &sc_list_break ? "joint = ..." : "a = ..., b = ...";
        sc_raise(s, SCENE_E_TYPE, &site, NULL, 0, NULL,
                 "%s takes a function or a table: %s{%s, function}", kinds[k].name, kinds[k].name,
                 keys);
    }
    sc_contact_def def = { .function = LUA_NOREF, .speed = HIT_SPEED };
    sc_read(s, &site, kinds[k].list, 1, &def);
    if (def.b[0] != 0 && def.a[0] == 0) {
        sc_raise(s, SCENE_E_MISSING, &site, "b", 0, NULL, "%s{} with 'b' needs 'a'", kinds[k].name);
    }
    if (!s->building) {
        sc_check_body_name(s, &site, "a", def.a);
        sc_check_body_name(s, &site, "b", def.b);
        sc_check_joint_name(s, &site, "joint", def.joint);
    }
    sc_handler_add(s, kinds[k].kind, &site)->contact = def;
    if (kinds[k].kind == SC_ON_HIT) {
        set_hit_speed(s, &site);
    } else if (kinds[k].kind == SC_EDIT_CONTACT) {
        open_edits(s, &site);
    }
    return 0;
}

// ---------------------------------------------------------------------------------------- matching

// Whether the handler wants this pair; *swapped when a's pattern fits the second body. Sensor events
// are never swapped: `a` is the sensor.
static bool wants(const sc_handler *h, const sc_body *a, const sc_body *b, bool *swapped)
{
    const sc_contact_def *d = &h->contact;
    *swapped = false;
    if (d->a[0] == 0) {
        return true;
    }
    const char *second = d->b[0] != 0 ? d->b : "*";
    if (sc_name_matches(d->a, a->def.name) && sc_name_matches(second, b->def.name)) {
        return true;
    }
    *swapped = true;
    return h->kind != SC_ON_ENTER && h->kind != SC_ON_LEAVE && sc_name_matches(d->a, b->def.name) &&
           sc_name_matches(second, a->def.name);
}

static void push_field(lua_State *L, const char *name, plumb_real v)
{
    lua_pushnumber(L, (double)v);
    lua_setfield(L, -2, name);
}

/// Where a contact is and how hard it was; `impulse` < 0: not known.
typedef struct blow {
    plumb_vec2 point, normal;
    plumb_real speed, impulse;
    double time; // [s] simulated; of a blow whose impulse is known
} blow;

// The third argument; the normal points from the handler's first body to its second.
static void push_blow(lua_State *L, const blow *e, bool swapped)
{
    plumb_real sign = swapped ? (plumb_real)-1 : (plumb_real)1;
    lua_createtable(L, 0, 6);
    push_field(L, "x", e->point.x);
    push_field(L, "y", e->point.y);
    push_field(L, "nx", sign * e->normal.x);
    push_field(L, "ny", sign * e->normal.y);
    push_field(L, "speed", e->speed);
    if (e->impulse >= 0) {
        push_field(L, "impulse", e->impulse);
        lua_pushnumber(L, e->time);
        lua_setfield(L, -2, "time");
    }
}

static void dispatch(scene *s, sc_handler_kind kind, plumb_body body_a, plumb_body body_b,
                     const blow *event)
{
    lua_State *L = s->L;
    int count = s->handlers.count; // those registered meanwhile start with the next event
    sc_step_work(s, (uint64_t)count);
    for (int i = 0; i < count; i++) {
        const sc_handler *h = &s->handlers.items[i];
        const sc_body *a = sc_body_of(s, body_a);
        const sc_body *b = sc_body_of(s, body_b);
        bool swapped;
        if (a == NULL || b == NULL) {
            return; // destroyed by an earlier handler
        }
        if (h->kind != kind || !wants(h, a, b, &swapped) ||
            (kind == SC_ON_HIT && (double)event->speed < h->contact.speed)) {
            continue;
        }
        lua_rawgeti(L, LUA_REGISTRYINDEX, h->contact.function);
        sc_body_push(s, swapped ? b : a);
        sc_body_push(s, swapped ? a : b);
        if (event != NULL) {
            push_blow(L, event, swapped);
        }
        sc_call(s, event != NULL ? 3 : 2, 0);
    }
}

// ------------------------------------------------------------------------------- after the step

// Copies the world's events of one kind into s->list.
#define TAKE(list, get)                                                                            \
    do {                                                                                           \
        int taken = 0;                                                                             \
        s->list.count = 0;                                                                         \
        for (int i = (get(s->world, &taken), 0); i < taken; i++) {                                 \
            *SC_PUSH(s, s->list) = get(s->world, &taken)[i];                                       \
        }                                                                                          \
    } while (0)

static void after_contacts(scene *s)
{
    s->begins.count = s->ends.count = s->hits.count = 0;
    if (has_kind(s, SC_ON_CONTACT)) {
        TAKE(begins, plumb_world_begin_events);
    }
    if (has_kind(s, SC_ON_END)) {
        TAKE(ends, plumb_world_end_events);
    }
    if (has_kind(s, SC_ON_HIT)) {
        TAKE(hits, plumb_world_hit_events);
    }
}

static void after_sensors(scene *s)
{
    s->enters.count = s->leaves.count = 0;
    if (s->wants_visits || has_kind(s, SC_ON_ENTER)) {
        TAKE(enters, plumb_world_sensor_begin_events);
    }
    if (has_kind(s, SC_ON_LEAVE)) {
        TAKE(leaves, plumb_world_sensor_end_events);
    }
    for (int i = 0; i < s->enters.count; i++) {
        sc_body *b = sc_body_of(s, s->enters.items[i].sensor_body);
        if (b != NULL) {
            b->visits++;
        }
    }
}

// The names of what broke are kept, their records are not: the world's joints are gone.
static void after_breaks(scene *s)
{
    int first = s->broken.count;
    TAKE(breaks, plumb_world_joint_break_events);
    for (int i = 0; i < s->breaks.count; i++) {
        sc_joint *j = s->breaks.items[i].user_data;
        sc_name *name = SC_PUSH(s, s->broken);
        memcpy(name->text, j->def.name, sizeof name->text);
        sc_joint_release(s, j);
    }
    s->broken_before = first;
}

static void after_strains(scene *s)
{
    s->strains.count = s->strained.count = 0;
    if (has_kind(s, SC_ON_STRAIN)) {
        TAKE(strains, plumb_world_joint_strain_events);
    }
    for (int i = 0; i < s->strains.count; i++) {
        const sc_joint *j = s->strains.items[i].user_data;
        memcpy(SC_PUSH(s, s->strained)->text, j->def.name, sizeof j->def.name);
    }
}

static void push_end(scene *s, const char *key, plumb_body body)
{
    const sc_body *b = sc_body_of(s, body);
    if (b == NULL) {
        lua_getglobal(s->L, "world");
    } else {
        sc_body_push(s, b);
    }
    lua_setfield(s->L, -2, key);
}

// on_break, on_strain: the name of the joint, and what it is or was and what broke or strained it.
static void dispatch_joint(scene *s, sc_handler_kind kind, const sc_name *name,
                           const plumb_joint_break *e)
{
    lua_State *L = s->L;
    int count = s->handlers.count;
    sc_step_work(s, (uint64_t)count);
    for (int i = 0; i < count; i++) {
        const sc_handler *h = &s->handlers.items[i];
        if (h->kind != kind ||
            (h->contact.joint[0] != 0 && !sc_name_matches(h->contact.joint, name->text))) {
            continue;
        }
        lua_rawgeti(L, LUA_REGISTRYINDEX, h->contact.function);
        lua_pushstring(L, name->text);
        lua_createtable(L, 0, 8);
        push_end(s, "a", e->body_a);
        push_end(s, "b", e->body_b);
        push_field(L, "x", e->point.x);
        push_field(L, "y", e->point.y);
        push_field(L, "fx", e->force.x);
        push_field(L, "fy", e->force.y);
        push_field(L, "torque", e->torque);
        lua_pushstring(L, plumb_joint_kind_name(e->kind));
        lua_setfield(L, -2, "kind");
        sc_call(s, 2, 0);
    }
}

void sc_events_after(scene *s)
{
    after_contacts(s); // all arrays first: a handler that changes the world ends them
    after_sensors(s);
    after_breaks(s);
    after_strains(s);
    for (int i = 0; i < s->begins.count; i++) {
        plumb_contact_begin e = s->begins.items[i];
        const blow b = { e.point, e.normal, e.approach_speed, -1, 0 };
        dispatch(s, SC_ON_CONTACT, e.body_a, e.body_b, &b);
    }
    for (int i = 0; i < s->hits.count; i++) {
        plumb_contact_hit e = s->hits.items[i];
        const double time = plumb_world_stats(s->world).time - s->dt / s->split + (double)e.moment;
        const blow b = { e.point, e.normal, e.approach_speed, e.impulse, time };
        dispatch(s, SC_ON_HIT, e.body_a, e.body_b, &b);
    }
    for (int i = 0; i < s->ends.count; i++) {
        dispatch(s, SC_ON_END, s->ends.items[i].body_a, s->ends.items[i].body_b, NULL);
    }
    for (int i = 0; i < s->enters.count; i++) {
        dispatch(s, SC_ON_ENTER, s->enters.items[i].sensor_body, s->enters.items[i].body, NULL);
    }
    for (int i = 0; i < s->leaves.count; i++) {
        dispatch(s, SC_ON_LEAVE, s->leaves.items[i].sensor_body, s->leaves.items[i].body, NULL);
    }
    for (int i = 0; i < s->breaks.count; i++) {
        sc_name name = s->broken.items[s->broken_before + i];
        plumb_joint_break e = s->breaks.items[i];
        dispatch_joint(s, SC_ON_BREAK, &name, &e);
    }
    for (int i = 0; i < s->strains.count; i++) {
        const sc_name name = s->strained.items[i];
        const plumb_joint_strain e = s->strains.items[i];
        dispatch_joint(s, SC_ON_STRAIN, &name, &e);
    }
}

// ----------------------------------------------------------------------------- within the step

// Puts the contact as the script sees it on the stack.
static void push_edit(lua_State *L, const plumb_contact_edit *e, bool swapped)
{
    plumb_real sign = swapped ? (plumb_real)-1 : (plumb_real)1;
    lua_createtable(L, 0, 12);
    push_field(L, "x", e->points[0].x);
    push_field(L, "y", e->points[0].y);
    push_field(L, "nx", sign * e->normal.x);
    push_field(L, "ny", sign * e->normal.y);
    push_field(L, "separation", e->separation[0]);
    push_field(L, "friction", e->friction);
    push_field(L, "restitution", e->restitution);
    push_field(L, "rolling_resistance", e->rolling_resistance);
    push_field(L, "surface_speed", e->surface_speed);
    lua_pushboolean(L, e->touching);
    lua_setfield(L, -2, "touching");
    lua_pushboolean(L, e->enabled);
    lua_setfield(L, -2, "enabled");
}

// What the handler left in the table, in the struct.
static void pull_edit(scene *s, const sc_site *site, int table, plumb_contact_edit *e)
{
    lua_State *L = s->L;
    const struct {
        const char *name;
        plumb_real *value;
    } numbers[] = { { "friction", &e->friction },
                    { "restitution", &e->restitution },
                    { "rolling_resistance", &e->rolling_resistance },
                    { "surface_speed", &e->surface_speed } };
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        if (lua_getfield(L, table, numbers[i].name) != LUA_TNUMBER) {
            sc_raise(s, SCENE_E_TYPE, site, NULL, 0, NULL,
                     "'%s' of a contact must be a number, not %s", numbers[i].name,
                     sc_type_name(s, -1));
        }
        *numbers[i].value = (plumb_real)lua_tonumber(L, -1);
        lua_pop(L, 1);
    }
    if (lua_getfield(L, table, "enabled") != LUA_TBOOLEAN) {
        sc_raise(s, SCENE_E_TYPE, site, NULL, 0, NULL,
                 "'enabled' of a contact must be true or false, not %s", sc_type_name(s, -1));
    }
    e->enabled = lua_toboolean(L, -1) != 0;
    lua_pop(L, 1);
}

static void edit_one(scene *s, int index)
{
    lua_State *L = s->L;
    plumb_contact_edit e;
    plumb_contact_edit_get(s->world, index, &e);
    const sc_body *a = sc_body_of(s, e.body_a), *b = sc_body_of(s, e.body_b);
    sc_step_work(s, (uint64_t)s->handlers.count);
    for (int i = 0; i < s->handlers.count; i++) {
        const sc_handler *h = &s->handlers.items[i];
        bool swapped;
        if (h->kind != SC_EDIT_CONTACT || !wants(h, a, b, &swapped)) {
            continue;
        }
        sc_site site = { .construct = "edit_contact", .line = h->line };
        push_edit(L, &e, swapped);
        lua_rawgeti(L, LUA_REGISTRYINDEX, h->contact.function);
        sc_body_push(s, swapped ? b : a);
        sc_body_push(s, swapped ? a : b);
        lua_pushvalue(L, -4);
        sc_call(s, 3, 0);
        pull_edit(s, &site, lua_gettop(L), &e);
        lua_pop(L, 1);
        plumb_result r = plumb_contact_edit_set(s->world, index, &e);
        if (r != PLUMB_OK) {
            sc_refused(s, &site, NULL, r, "edit_contact");
        }
    }
}

static void edit_all(scene *s, void *unused)
{
    (void)unused;
    int count = plumb_contact_edit_count(s->world);
    for (int i = 0; i < count; i++) {
        edit_one(s, i);
    }
}

// The system. An error must not leave through the world's step: it is kept for scene.c to raise.
static void run_edits(const plumb_system_call *call)
{
    scene *s = call->context;
    if (s->edit_failed || !has_kind(s, SC_EDIT_CONTACT)) {
        return;
    }
    s->edit_failed = !sc_protect(s, edit_all, NULL);
}

static void open_edits(scene *s, const sc_site *site)
{
    if (s->edits) {
        return;
    }
    plumb_system_desc system = { .name = "edit_contact",
                                 .phase = PLUMB_PHASE_CONTACTS,
                                 .run = run_edits,
                                 .reads = "manifolds",
                                 .writes = "manifolds",
                                 .context = s };
    plumb_result r = plumb_system_create(s->world, &system);
    if (r != PLUMB_OK) {
        sc_refused(s, site, NULL, r, "edit_contact");
    }
    s->edits = true;
}

void sc_open_events(lua_State *L)
{
    for (int k = 0; k < KINDS; k++) {
        lua_pushinteger(L, k);
        lua_pushcclosure(L, lua_event, 1);
        lua_setglobal(L, kinds[k].name);
    }
}
