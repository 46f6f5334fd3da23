// system.c - user systems: registered by name, kept in order of phase and registration, run with
// the world locked.
//
// Reads, writes: the list of systems; what a system does is its own. Cost: O(systems) a phase.
#define _POSIX_C_SOURCE 200809L // clock_gettime

#include "ecs/system.h"

#include "world/check.h"
#include "world/state.h"

#include <string.h>
#include <time.h>

//---- registration --------------------------------------------------------------------------------

static pl_system *find(const plumb_world *world, const char *name)
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

static plumb_result check_desc(const plumb_world *world, const char *fn,
                               const plumb_system_desc *desc)
{
    const pl_system *form = NULL;
    plumb_result r = pl_check_pointer(world, fn, "desc", desc);
    r = r != PLUMB_OK ? r : pl_check_name(world, fn, "name", desc->name);
    if (r == PLUMB_OK && (unsigned)desc->phase > PLUMB_PHASE_END) {
        r = pl_fail(world, PLUMB_E_RANGE, fn, "phase is %d; it must be a plumb_phase",
                    (int)desc->phase);
    }
    if (r == PLUMB_OK && desc->run == NULL) {
        r = pl_fail(world, PLUMB_E_NULL, fn, "run is null; it must be given");
    }
    r = r != PLUMB_OK ? r : check_text(world, fn, "reads", desc->reads, sizeof form->reads);
    r = r != PLUMB_OK ? r : check_text(world, fn, "writes", desc->writes, sizeof form->writes);
    if (r == PLUMB_OK && desc->needs.id > world->components.count) {
        r = pl_fail(world, PLUMB_E_HANDLE, fn,
                    "needs is %u; it must be a registered component or null",
                    (unsigned)desc->needs.id);
    }
    if (r == PLUMB_OK && find(world, desc->name) != NULL) {
        r = pl_fail(world, PLUMB_E_DUPLICATE, fn, "name is '%s'; it must be new", desc->name);
    }
    if (r == PLUMB_OK && world->systems.count == PL_SYSTEM_MAX) {
        r = pl_fail(world, PLUMB_E_CAPACITY, fn, "system is the %dth; there must be at most %d",
                    PL_SYSTEM_MAX + 1, PL_SYSTEM_MAX);
    }
    return r;
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
    if (world == NULL) {
        return PLUMB_E_NULL;
    }
    plumb_result r = pl_check_unlocked(world, __func__);
    r = r != PLUMB_OK ? r : check_desc(world, __func__, desc);
    if (r != PLUMB_OK) {
        return r;
    }
    pl_systems *systems = &world->systems;
    if (!grow_items(&world->memory, systems)) {
        return pl_fail_memory(world, __func__);
    }
    uint32_t at = systems->count;
    while (at > 0 && systems->items[at - 1].desc.phase > desc->phase) {
        --at;
    }
    pl_system *made = &systems->items[at];
    memmove(made + 1, made, (systems->count - at) * sizeof *made);
    ++systems->count;
    *made = (pl_system){ .desc = *desc, .enabled = true };
    copy_text(made->name, desc->name);
    copy_text(made->reads, desc->reads);
    copy_text(made->writes, desc->writes);
    point_strings(systems);
    wake_for(world, desc->phase);
    world->schedule_dirty = true;
    return PLUMB_OK;
}

plumb_result plumb_system_enable(plumb_world *world, const char *name, bool enabled)
{
    if (world == NULL) {
        return PLUMB_E_NULL;
    }
    plumb_result r = pl_check_pointer(world, __func__, "name", name);
    if (r != PLUMB_OK) {
        return r;
    }
    pl_system *system = find(world, name);
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
    if (system->desc.needs.id == 0) {
        *reason = "registered";
        return true;
    }
    bool used = pl_component_in_use(world, system->desc.needs);
    *reason = used ? "some entity has the component that it needs"
                   : "no entity has the component that it needs";
    return used;
}

static double now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

void pl_systems_run(plumb_world *world, plumb_phase phase, plumb_real dt, double time)
{
    const char *locked_by = world->locked_by;
    for (uint32_t i = 0; i < world->systems.count; ++i) {
        pl_system *system = &world->systems.items[i];
        const char *reason;
        if (system->desc.phase != phase) {
            continue;
        }
        system->last_ns = 0;
        if (!pl_system_wanted(world, system, &reason)) {
            continue;
        }
        const plumb_system_call call = { world, dt, time, system->desc.context };
        double start = now_ns();
        world->locked_by = system->name;
        system->desc.run(&call);
        world->locked_by = locked_by;
        system->last_ns = now_ns() - start;
        system->total_ns += system->last_ns;
    }
}
