// events.c - what a script does about what happened in a step: on_contact, on_end, on_hit, on_enter,
// on_leave, on_break, on_strain, on_shatter, on_gone, on_wet, on_dry, from copies of the world's event arrays (a handler may make and destroy
// things). edit_contact is registered here; edits.c asks it. Whoever has heard on_contact or on_enter hears on_end or
// on_leave, also of bodies that are gone by then: their objects still have name and user table (body_record.c).
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
    { "on_shatter", SC_ON_SHATTER, &sc_list_contact },
    { "on_gone", SC_ON_GONE, &sc_list_contact },
    { "on_wet", SC_ON_WET, &sc_list_contact },
    { "on_dry", SC_ON_DRY, &sc_list_contact },
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

bool sc_handler_any(const scene *s, sc_handler_kind kind)
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
        sc_open_edits(s, &site);
    }
    return 0;
}

// ---------------------------------------------------------------------------------------- matching

// Whether the handler wants this pair; *swapped when a's pattern fits the second body. Sensor events
// are never swapped: `a` is the sensor.
bool sc_handler_wants(const sc_handler *h, const char *a, const char *b, bool *swapped)
{
    const sc_contact_def *d = &h->contact;
    *swapped = false;
    if (d->a[0] == 0) {
        return true;
    }
    const char *second = d->b[0] != 0 ? d->b : "*";
    if (sc_name_matches(d->a, a) && sc_name_matches(second, b)) {
        return true;
    }
    *swapped = true;
    return h->kind != SC_ON_ENTER && h->kind != SC_ON_LEAVE && sc_name_matches(d->a, b) &&
           sc_name_matches(second, a);
}

void sc_push_field(lua_State *L, const char *name, plumb_real v)
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
    sc_push_told(L, SC_TOLD_CONTACT);
    sc_push_field(L, "x", e->point.x);
    sc_push_field(L, "y", e->point.y);
    sc_push_field(L, "nx", sign * e->normal.x);
    sc_push_field(L, "ny", sign * e->normal.y);
    sc_push_field(L, "speed", e->speed);
    if (e->impulse >= 0) {
        sc_push_field(L, "impulse", e->impulse);
        lua_pushnumber(L, e->time);
        lua_setfield(L, -2, "time");
    }
}

// ------------------------------------------------------------------------------------- calling

/// Who an event is about; `shapes` are null where no end follows.
typedef struct pair {
    plumb_body a, b;
    plumb_shape shape_a, shape_b;
} pair;

static bool is_end(sc_handler_kind kind)
{
    return kind == SC_ON_END || kind == SC_ON_LEAVE;
}

// Who was destroyed before any handler heard of the beginning: nobody hears of the end.
static bool is_unheard(scene *s, sc_handler_kind kind, const pair *p)
{
    const bool either_way = kind == SC_ON_END; // a sensor is always the first
    sc_step_work(s, (uint64_t)s->unheard.count / 4);
    for (int i = 0; i < s->unheard.count; i++) {
        const plumb_contact_end *u = &s->unheard.items[i];
        if ((plumb_same(u->shape_a, p->shape_a) && plumb_same(u->shape_b, p->shape_b)) ||
            (either_way && plumb_same(u->shape_a, p->shape_b) &&
             plumb_same(u->shape_b, p->shape_a))) {
            return true;
        }
    }
    return false;
}

// With the objects of both bodies below. True: a handler was called, or none is for these two.
static bool call_handlers(scene *s, sc_handler_kind kind, const pair *p, const char *name_a,
                          const char *name_b, const blow *event)
{
    lua_State *L = s->L;
    const int first = lua_gettop(L) - 1, second = first + 1;
    int count = s->handlers.count; // those registered meanwhile start with the next event
    bool called = false;
    sc_step_work(s, (uint64_t)count);
    for (int i = 0; i < count; i++) {
        const sc_handler *h = &s->handlers.items[i];
        bool swapped;
        if (h->kind != kind || !sc_handler_wants(h, name_a, name_b, &swapped) ||
            (kind == SC_ON_HIT && (double)event->speed < h->contact.speed)) {
            continue;
        }
        if (!is_end(kind) && (sc_body_of(s, p->a) == NULL || sc_body_of(s, p->b) == NULL)) {
            return called; // destroyed by an earlier handler
        }
        called = true;
        lua_rawgeti(L, LUA_REGISTRYINDEX, h->contact.function);
        lua_pushvalue(L, swapped ? second : first);
        lua_pushvalue(L, swapped ? first : second);
        if (event != NULL) {
            push_blow(L, event, swapped);
        }
        sc_call(s, event != NULL ? 3 : 2, 0);
    }
    return true;
}

// What ends may have ended because it was destroyed; what begins is told of what is there.
static void dispatch(scene *s, sc_handler_kind kind, const pair *p, const blow *event)
{
    char name_a[SC_NAME_SIZE], name_b[SC_NAME_SIZE];
    if (is_end(kind) && is_unheard(s, kind, p)) {
        return;
    }
    const int top = lua_gettop(s->L);
    if (sc_body_recall(s, p->a, name_a) && sc_body_recall(s, p->b, name_b) &&
        !call_handlers(s, kind, p, name_a, name_b, event) && kind != SC_ON_HIT) {
        *SC_PUSH(s, s->unheard) = (plumb_contact_end){ p->shape_a, p->shape_b, p->a, p->b };
    }
    lua_settop(s->L, top);
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
    if (sc_handler_any(s, SC_ON_CONTACT)) {
        TAKE(begins, plumb_world_begin_events);
    }
    if (sc_handler_any(s, SC_ON_END)) {
        TAKE(ends, plumb_world_end_events);
    }
    if (sc_handler_any(s, SC_ON_HIT)) {
        TAKE(hits, plumb_world_hit_events);
    }
}

static void after_sensors(scene *s)
{
    s->enters.count = s->leaves.count = 0;
    if (s->wants_visits || sc_handler_any(s, SC_ON_ENTER)) {
        TAKE(enters, plumb_world_sensor_begin_events);
    }
    if (sc_handler_any(s, SC_ON_LEAVE)) {
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
    if (sc_handler_any(s, SC_ON_STRAIN)) {
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
        sc_push_told(L, SC_TOLD_JOINT);
        push_end(s, "a", e->body_a);
        push_end(s, "b", e->body_b);
        sc_push_field(L, "x", e->point.x);
        sc_push_field(L, "y", e->point.y);
        sc_push_field(L, "fx", e->force.x);
        sc_push_field(L, "fy", e->force.y);
        sc_push_field(L, "torque", e->torque);
        lua_pushstring(L, plumb_joint_kind_name(e->kind));
        lua_setfield(L, -2, "kind");
        sc_call(s, 2, 0);
    }
}

static void tell_begins(scene *s)
{
    for (int i = 0; i < s->begins.count; i++) {
        const plumb_contact_begin e = s->begins.items[i];
        const blow b = { e.point, e.normal, e.approach_speed, -1, 0 };
        dispatch(s, SC_ON_CONTACT, &(pair){ e.body_a, e.body_b, e.shape_a, e.shape_b }, &b);
    }
    for (int i = 0; i < s->hits.count; i++) {
        const plumb_contact_hit e = s->hits.items[i];
        const double time = plumb_world_stats(s->world).time - s->dt / s->split + (double)e.moment;
        const blow b = { e.point, e.normal, e.approach_speed, e.impulse, time };
        dispatch(s, SC_ON_HIT, &(pair){ e.body_a, e.body_b, e.shape_a, e.shape_b }, &b);
    }
}

static void dispatch_visit(scene *s, sc_handler_kind kind, plumb_sensor_event e)
{
    dispatch(s, kind, &(pair){ e.sensor_body, e.body, e.sensor, e.shape }, NULL);
}

void sc_events_after(scene *s)
{
    sc_shatters_take(s);
    sc_gone_take(s);
    sc_wet_take(s);
    after_contacts(s); // all arrays first: a handler that changes the world ends them
    after_sensors(s);
    after_breaks(s);
    after_strains(s);
    sc_departed_turn(s);
    const int unheard = s->unheard.count; // of the step before
    sc_shatters_tell(s);
    sc_gone_tell(s);
    sc_wet_tell(s);
    tell_begins(s);
    for (int i = 0; i < s->ends.count; i++) {
        const plumb_contact_end e = s->ends.items[i];
        dispatch(s, SC_ON_END, &(pair){ e.body_a, e.body_b, e.shape_a, e.shape_b }, NULL);
    }
    for (int i = 0; i < s->enters.count; i++) {
        dispatch_visit(s, SC_ON_ENTER, s->enters.items[i]);
    }
    for (int i = 0; i < s->leaves.count; i++) {
        dispatch_visit(s, SC_ON_LEAVE, s->leaves.items[i]);
    }
    if (unheard > 0) {
        s->unheard.count -= unheard;
        memmove(s->unheard.items, s->unheard.items + unheard,
                (size_t)s->unheard.count * sizeof *s->unheard.items);
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

void sc_open_events(lua_State *L)
{
    for (int k = 0; k < KINDS; k++) {
        lua_pushinteger(L, k);
        lua_pushcclosure(L, lua_event, 1);
        lua_setglobal(L, kinds[k].name);
    }
}
