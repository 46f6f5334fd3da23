// edits.c - edit_contact: what a script does about contacts in the middle of a step, after the narrow phase. Handlers are
// asked in the order in which they were registered. Cost: O(contacts * handlers); nothing without handlers.
#include "internal.h"

// Puts the contact as the script sees it on the stack.
static void push_edit(lua_State *L, const plumb_contact_edit *e, bool swapped)
{
    plumb_real sign = swapped ? (plumb_real)-1 : (plumb_real)1;
    sc_push_told(L, SC_TOLD_EDIT);
    sc_push_field(L, "x", e->points[0].x);
    sc_push_field(L, "y", e->points[0].y);
    sc_push_field(L, "nx", sign * e->normal.x);
    sc_push_field(L, "ny", sign * e->normal.y);
    sc_push_field(L, "separation", e->separation[0]);
    sc_push_field(L, "friction", e->friction);
    sc_push_field(L, "restitution", e->restitution);
    sc_push_field(L, "rolling_resistance", e->rolling_resistance);
    sc_push_field(L, "surface_speed", e->surface_speed);
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
        if (h->kind != SC_EDIT_CONTACT ||
            !sc_handler_wants(h, a->def.name, b->def.name, &swapped)) {
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
    if (s->edit_failed) {
        return;
    }
    s->edit_failed = !sc_protect(s, edit_all, NULL);
}

void sc_open_edits(scene *s, const sc_site *site)
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
