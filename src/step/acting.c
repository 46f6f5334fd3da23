// acting.c - whom rows of the substep act on, and the user's systems as such rows.
//
// A system of the substep acts on the awake dynamic bodies that have all components that it needs. These are moved by
// the solver, even where nothing touches them: "called" marks them before the graph gives out slots. Behind it, slots
// and places in the columns are listed side by side, by rising slot, so those of a cluster follow one another, and each
// cluster calls the system with its own. A system that is not parallel acts alone: its bodies are all of cluster 0,
// which is solved before the others. An effect of ours (ACTS of schema/passes.h) says whom it acts on, and looks its
// bodies up among the slots of a cluster itself.
//
// Reads: components, settings, slots. Writes: lists. Cost: O(bodies of the solver) a system and step; a system's row
// O(bodies that it acts on) and a search a cluster and substep.
#include "step/acting.h"

#include "core/quad.h"
#include "effects/drag.h"
#include "effects/effects.h"
#include "effects/laws.h"
#include "softbody/softbody.h"
#include "step/system.h"
#include "world/push.h"
#include "world/state.h"

#include <string.h>

static bool is_of_substeps(const plumb_world *world, const pl_system *system)
{
    const char *unused;
    return system->desc.phase == PLUMB_PHASE_SUBSTEP && pl_system_wanted(world, system, &unused);
}

static bool any_system(const plumb_world *world)
{
    for (uint32_t i = 0; i < world->systems.count && world->systems.in_substeps > 0; ++i) {
        if (is_of_substeps(world, &world->systems.items[i])) {
            return true;
        }
    }
    return false;
}

static bool any_effect(const plumb_world *world)
{
    const char *unused;
    for (int i = 0; i < pl_pass_count; ++i) {
        if (pl_passes[i].acts_on != NULL && pl_pass_wanted(world, i, &unused)) {
            return true;
        }
    }
    return false;
}

bool pl_want_called(const plumb_world *world, const char **reason)
{
    const bool wanted = world->dynamic_count > 0 && (any_system(world) || any_effect(world));
    *reason = wanted ? "systems or effects act on bodies in the substeps"
                     : "no system and no effect acts on a body in the substeps";
    return wanted;
}

bool pl_want_acting(const plumb_world *world, const char **reason)
{
    if (pl_want_called(world, reason)) {
        return true;
    }
    const bool wanted = world->settings.damped + world->settings.capped > 0;
    *reason = wanted ? "some body is damped or has a speed cap"
                     : "nothing acts on a body in the substeps";
    return wanted;
}

// Damping by itself starts from the accelerations of the step each time.
bool pl_want_reset(const plumb_world *world, const char **reason)
{
    if (pl_want_called(world, reason)) {
        return true;
    }
    const bool wanted = world->settings.capped > 0;
    *reason = wanted ? "some body has a speed cap"
                     : "no more than damping acts on a body in the substeps";
    return wanted;
}

//---- lists ---------------------------------------------------------------------------------------

// Whether the body of a row has all that a system needs, and where.
static bool find_places(const plumb_world *world, const pl_system *system, uint32_t row,
                        uint32_t at[PLUMB_NEEDS_MOST])
{
    const uint32_t entity = world->bodies.entity[row].entity.index;
    for (uint32_t k = 0; k < system->need_count; ++k) {
        at[k] = pl_component_place(&world->components.items[system->desc.needs[k].id - 1], entity);
        if (at[k] == PL_ABSENT) {
            return false;
        }
    }
    return true;
}

static void call_effect(plumb_world *world, const pl_pass *effect)
{
    uint8_t *called = world->effects.called.data;
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        if (effect->acts_on(world, row)) {
            called[row] |= PL_CALLED_SHARED;
            world->effects.any_called = true;
        }
    }
}

bool pl_acting_call(plumb_world *world)
{
    pl_effects *e = &world->effects;
    if (!pl_buffer_reserve(&world->memory, &e->called, world->dynamic_count)) {
        return false;
    }
    uint8_t *called = e->called.data;
    memset(called, 0, world->dynamic_count);
    for (int i = 0; i < pl_pass_count; ++i) {
        if (pl_passes[i].acts_on != NULL && world->schedule.scheduled[i]) {
            call_effect(world, &pl_passes[i]);
        }
    }
    e->any_alone |= world->laws.count > 0 && pl_laws_couple(world, called);
    e->any_alone |= world->softbodies.count > world->softbodies.asleep_count &&
                    pl_softbodies_couple(world, called);
    for (uint32_t i = 0; i < world->systems.count; ++i) {
        const pl_system *system = &world->systems.items[i];
        if (!is_of_substeps(world, system)) {
            continue;
        }
        const uint8_t how = system->desc.parallel ? PL_CALLED_SHARED : PL_CALLED_ALONE;
        for (uint32_t row = 0; row < world->dynamic_count; ++row) {
            uint32_t at[PLUMB_NEEDS_MOST];
            if (find_places(world, system, row, at)) {
                called[row] |= how;
                e->any_called = true;
            }
        }
        e->any_alone |= how == PL_CALLED_ALONE;
    }
    return true;
}

static bool reserve_list(plumb_world *world, pl_acting *list, uint32_t needs, uint32_t slots)
{
    const size_t bytes = slots * sizeof(uint32_t);
    bool room = pl_buffer_reserve(&world->memory, &list->slots, bytes) &&
                pl_buffer_reserve(&world->memory, &list->rows, bytes);
    for (uint32_t k = 0; k < needs; ++k) {
        room = room && pl_buffer_reserve(&world->memory, &list->at[k], bytes);
    }
    return room;
}

static bool list_slots(plumb_world *world, pl_system *system)
{
    pl_acting *list = &system->acting;
    const pl_solver *s = &world->solver;
    const uint32_t *rows = s->rows.data;
    if (!reserve_list(world, list, system->need_count, s->dynamic_slots)) {
        return false;
    }
    list->count = 0;
    for (uint32_t slot = 0; slot < s->dynamic_slots; ++slot) {
        uint32_t at[PLUMB_NEEDS_MOST];
        if (!find_places(world, system, rows[slot], at)) {
            continue;
        }
        ((uint32_t *)list->slots.data)[list->count] = slot;
        ((uint32_t *)list->rows.data)[list->count] = rows[slot];
        for (uint32_t k = 0; k < system->need_count; ++k) {
            ((uint32_t *)list->at[k].data)[list->count] = at[k];
        }
        ++list->count;
    }
    return true;
}

static bool keep_accelerations(plumb_world *world)
{
    pl_buffer *bases = &world->effects.bases;
    const uint32_t slots = world->solver.dynamic_slots;
    if (!pl_buffer_reserve(&world->memory, bases, slots * sizeof(pl_near_quad))) {
        return false;
    }
    pl_near_quad *to = bases->data;
    const pl_near_quad *motion = (const pl_near_quad *)(void *)pl_solver_motions(&world->solver);
    for (uint32_t slot = 0; slot < slots; ++slot) {
        to[slot] = motion[2 * (size_t)slot];
    }
    return true;
}

bool pl_acting_find(plumb_world *world, real dt)
{
    const bool solves = world->solver.slot_count > 0;
    if (!pl_damping_find(world, dt) || !pl_drag_find(world) || !pl_caps_find(world) ||
        (solves && !keep_accelerations(world))) {
        return false;
    }
    for (uint32_t i = 0; i < world->systems.count && solves; ++i) {
        pl_system *system = &world->systems.items[i];
        if (!is_of_substeps(world, system)) {
            continue;
        }
        pl_sleep_heed(world);
        if (!list_slots(world, system)) {
            return false;
        }
    }
    return true;
}

//---- rows ----------------------------------------------------------------------------------------

void pl_acting_reset(pl_substep *s)
{
    const plumb_world *world = s->world;
    const pl_slots slots = s->cluster->slots[0];
    const pl_near_quad *from = world->effects.bases.data;
    pl_near_quad *motion = (pl_near_quad *)(void *)pl_solver_motions(&world->solver);
    for (uint32_t slot = slots.first; slot < slots.first + slots.count; ++slot) {
        motion[2 * (size_t)slot] = from[slot];
    }
}

// A system's part of a cluster.
typedef struct part {
    const pl_system *system;
    const pl_substep *substep;
    uint32_t first;
} part;

static void call_system(void *context, uint32_t first, uint32_t count)
{
    const part *p = context;
    const pl_system *system = p->system;
    const pl_acting *list = &system->acting;
    plumb_world *world = p->substep->world;
    const uint32_t at = p->first + first;
    plumb_substep part_of = { .count = (int)count,
                              .number = p->substep->number,
                              .slot = (const uint32_t *)list->slots.data + at,
                              .row = (const uint32_t *)list->rows.data + at,
                              .bodies = pl_solver_bodies(&world->solver),
                              .motions = pl_solver_motions(&world->solver) };
    for (uint32_t k = 0; k < system->need_count; ++k) {
        part_of.at[k] = (const uint32_t *)list->at[k].data + at;
        part_of.values[k] = world->components.items[system->desc.needs[k].id - 1].values.data;
    }
    const real h = (real)p->substep->h;
    const plumb_system_call call = { .world = world,
                                     .dt = h,
                                     .time = world->time + (double)h * p->substep->number,
                                     .context = system->desc.context,
                                     .substep = &part_of };
    system->desc.run(&call);
}

void pl_system_row(pl_substep *s)
{
    plumb_world *world = s->world;
    const pl_system *system = &world->systems.items[s->row->system];
    const pl_acting *list = &system->acting;
    const pl_share mine = pl_substep_share(list->slots.data, sizeof(uint32_t), 0, list->count, s);
    const uint32_t count = mine.end - mine.first;
    part p = { system, s, mine.first };
    if (count == 0) {
        return;
    }
    if (system->desc.parallel) {
        pl_tasks_ranges(s->tasks, count, PL_BODIES_SHARED, call_system, &p);
    } else {
        call_system(&p, 0, count);
    }
}
