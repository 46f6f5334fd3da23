// system.c - the user's systems: registered by name, run with the world locked.
//
// Reads, writes: the list of systems; what a system does is its own. Cost: O(systems) to register one.
#include "step/system.h"

#include "step/place.h"
#include "world/check.h"
#include "world/island.h"
#include "world/push.h"
#include "world/state.h"

#include <string.h>

//---- registration --------------------------------------------------------------------------------

// NULL: none has the name.
static pl_system *system_find(const plumb_world *world, const char *name)
{
    for (uint32_t i = 0; i < world->systems.count; ++i) {
        if (strcmp(world->systems.items[i].name, name) == 0) {
            return &world->systems.items[i];
        }
    }
    return NULL;
}

static plumb_result check_text(const plumb_world *world, const char *fn, const char *field,
                               const char *text, size_t room)
{
    if (text == NULL || memchr(text, '\0', room) != NULL) {
        return PLUMB_OK;
    }
    return pl_fail(world, PLUMB_E_RANGE, fn,
                   "%s is '%.16s...'; it must have at most %zu characters", field, text, room - 1);
}

static plumb_result check_data(const plumb_world *world, const char *fn, const char *field,
                               const char *text)
{
    uint32_t mask;
    const char *unknown;
    int length;
    if (text == NULL || pl_data_parse(world, text, &mask, &unknown, &length)) {
        return PLUMB_OK;
    }
    return pl_fail(world, PLUMB_E_MISSING, fn,
                   "%s names '%.*s'; it must name data of plumb_data_name or components", field,
                   length, unknown);
}

static plumb_result check_needs(const plumb_world *world, const char *fn,
                                const plumb_system_desc *desc)
{
    for (int k = 0; k < PLUMB_NEEDS_MOST && desc->needs[k].id != 0; ++k) {
        if (desc->needs[k].id > world->components.count) {
            return pl_fail(world, PLUMB_E_HANDLE, fn,
                           "needs[%d] is %u; it must be a registered component or null", k,
                           (unsigned)desc->needs[k].id);
        }
    }
    return PLUMB_OK;
}

static plumb_result check_desc(const plumb_world *world, const char *fn,
                               const plumb_system_desc *desc)
{
    const pl_system *form = NULL;
    PL_TRY(pl_check_pointer(world, fn, "desc", desc));
    PL_TRY(pl_check_name(world, fn, "name", desc->name));
    if ((unsigned)desc->phase > PLUMB_PHASE_SUBSTEP) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "phase is %d; it must be a plumb_phase",
                       (int)desc->phase);
    }
    if (desc->run == NULL) {
        return pl_fail(world, PLUMB_E_NULL, fn, "run is null; it must be given");
    }
    PL_TRY(check_text(world, fn, "reads", desc->reads, sizeof form->reads));
    PL_TRY(check_text(world, fn, "writes", desc->writes, sizeof form->writes));
    PL_TRY(check_text(world, fn, "before", desc->before, sizeof form->before));
    PL_TRY(check_text(world, fn, "after", desc->after, sizeof form->after));
    PL_TRY(check_text(world, fn, "instead", desc->instead, sizeof form->instead));
    PL_TRY(check_data(world, fn, "reads", desc->reads));
    PL_TRY(check_data(world, fn, "writes", desc->writes));
    PL_TRY(check_needs(world, fn, desc));
    if ((system_find(world, desc->name) != NULL || pl_pass_find(desc->name) >= 0)) {
        return pl_fail(world, PLUMB_E_DUPLICATE, fn, "name is '%s'; it must be new", desc->name);
    }
    if (world->systems.count == PL_SYSTEM_MAX) {
        return pl_fail(world, PLUMB_E_CAPACITY, fn, "system is the %dth; there must be at most %d",
                       PL_SYSTEM_MAX + 1, PL_SYSTEM_MAX);
    }
    if (world->observer != NULL && pl_system_is_placed(desc)) {
        return pl_fail(
            world, PLUMB_E_STATE, fn,
            "'%s' runs in the substep or at a place of its own; a recording does not hold "
            "what such a system does: it must come after the recording ends",
            desc->name);
    }
    return pl_place_check_system(world, fn, desc);
}

static bool grow_items(pl_memory *memory, pl_systems *systems)
{
    size_t bytes = (systems->count + 1) * sizeof(pl_system);
    if (bytes <= systems->bytes) {
        return true;
    }
    pl_system *items = pl_resize(memory, systems->items, systems->bytes, bytes);
    if (items == NULL) {
        return false;
    }
    systems->items = items;
    systems->bytes = bytes;
    return true;
}

static void copy_text(char *to, const char *from)
{
    if (from != NULL) {
        memcpy(to, from, strlen(from) + 1);
    }
}

// Strings of the descriptors point into the items, which may have moved.
static void point_strings(pl_systems *systems)
{
    for (uint32_t i = 0; i < systems->count; ++i) {
        pl_system *s = &systems->items[i];
        s->desc.name = s->name;
        s->desc.reads = s->reads;
        s->desc.writes = s->writes;
        s->desc.before = s->before;
        s->desc.after = s->after;
        s->desc.instead = s->instead;
    }
}

// Contacts that sleep are not shown to systems: what may change them wakes them.
static void wake_for(plumb_world *world, plumb_phase phase)
{
    if (phase == PLUMB_PHASE_CONTACTS) {
        pl_sleep_disturb_all(world);
    }
}

plumb_result plumb_system_create(plumb_world *world, const plumb_system_desc *desc)
{
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(check_desc(world, __func__, desc));
    pl_systems *systems = &world->systems;
    if (!grow_items(&world->memory, systems) || !pl_place_reserve(world)) {
        return pl_fail_memory(world, __func__);
    }
    uint32_t at = systems->count;
    while (at > 0 && systems->items[at - 1].desc.phase > desc->phase) {
        --at;
    }
    pl_system *made = &systems->items[at];
    memmove(made + 1, made, (systems->count - at) * sizeof *made);
    ++systems->count;
    *made = (pl_system){ .desc = *desc, .serial = systems->made++, .enabled = true };
    while (made->need_count < PLUMB_NEEDS_MOST && desc->needs[made->need_count].id != 0) {
        ++made->need_count;
    }
    copy_text(made->name, desc->name);
    copy_text(made->reads, desc->reads);
    copy_text(made->writes, desc->writes);
    copy_text(made->before, desc->before);
    copy_text(made->after, desc->after);
    copy_text(made->instead, desc->instead);
    const char *unknown;
    int length;
    pl_data_parse(world, made->writes, &made->written, &unknown, &length);
    made->checked = desc->writes != NULL;
    point_strings(systems);
    systems->in_substeps += desc->phase == PLUMB_PHASE_SUBSTEP;
    pl_place_all(world);
    wake_for(world, desc->phase);
    world->schedule_dirty = true;
    return PLUMB_OK;
}

plumb_result plumb_system_enable(plumb_world *world, const char *name, bool enabled)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(pl_check_pointer(world, __func__, "name", name));
    pl_system *system = system_find(world, name);
    if (system == NULL) {
        return pl_fail(world, PLUMB_E_MISSING, __func__,
                       "name is '%.64s'; it must be that of a system", name);
    }
    if (system->enabled != enabled) {
        wake_for(world, system->desc.phase);
        pl_sleep_wake_untold(world);
    }
    system->enabled = enabled;
    world->schedule_dirty = true;
    return PLUMB_OK;
}

void pl_systems_free(pl_memory *memory, pl_systems *systems)
{
    for (uint32_t i = 0; i < systems->count; ++i) {
        const pl_acting *a = &systems->items[i].acting;
        pl_resize(memory, a->slots.data, a->slots.size, 0);
        pl_resize(memory, a->rows.data, a->rows.size, 0);
        for (int k = 0; k < PLUMB_NEEDS_MOST; ++k) {
            pl_resize(memory, a->at[k].data, a->at[k].size, 0);
        }
    }
    pl_resize(memory, systems->items, systems->bytes, 0);
    *systems = (pl_systems){ 0 };
}

//---- running -------------------------------------------------------------------------------------

bool pl_system_wanted(const plumb_world *world, const pl_system *system, const char **reason)
{
    if (!system->enabled) {
        *reason = "switched off";
        return false;
    }
    if (system->need_count == 0) {
        *reason = "registered";
        return true;
    }
    bool used = true;
    for (uint32_t k = 0; k < system->need_count; ++k) {
        used &= pl_component_in_use(world, system->desc.needs[k]);
    }
    if (system->need_count == 1) {
        *reason = used ? "some entity has the component that it needs"
                       : "no entity has the component that it needs";
    } else {
        *reason = used ? "all components that it needs are in use"
                       : "no entity has one of the components that it needs";
    }
    return used;
}

bool pl_system_sees_contacts(const plumb_world *world)
{
    const char *unused;
    for (uint32_t i = 0; i < world->systems.count; ++i) {
        const pl_system *system = &world->systems.items[i];
        if (system->desc.phase == PLUMB_PHASE_CONTACTS &&
            pl_system_wanted(world, system, &unused)) {
            return true;
        }
    }
    return false;
}

// A range of body rows of a parallel system.
typedef struct part {
    const pl_system *system;
    plumb_system_call call;
} part;

static void run_part(void *context, uint32_t first, uint32_t count)
{
    const part *p = context;
    plumb_system_call call = p->call;
    call.first = (int)first;
    call.end = (int)(first + count);
    p->system->desc.run(&call);
}

// So many body rows are worth a thread.
#define LEAST 256

void pl_system_run(plumb_world *world, pl_system *system, plumb_real dt)
{
    const char *locked_by = world->locked_by;
    const uint32_t rows = world->bodies.table.count;
    part p = { system,
               { .world = world,
                 .dt = dt,
                 .time = world->time,
                 .context = system->desc.context,
                 .end = (int)rows } };
    world->locked_by = system->name;
    if (system->desc.parallel) {
        pl_sleep_heed(world);
        pl_tasks_ranges(world->tasks, rows, LEAST, run_part, &p);
    } else {
        system->desc.run(&p.call);
    }
    world->locked_by = locked_by;
    system->ran = true;
}
