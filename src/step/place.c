// place.c - where the user's systems stand among the rows of the step.
//
// A system stands behind those that are already at the place of its phase, or right before or behind the row that it
// names, or where the row stood in whose place it runs. Its phase says what it may do, so it can only stand where that
// makes sense: see `windows`. Systems are placed in the order of their registration, so that what one names is there.
//
// Reads: the table, systems. Writes: the places of the schedule. Cost: O(systems x rows), when one is registered.
#include "step/place.h"

#include "core/try.h"
#include "world/state.h"

#include <string.h>

const char *const pl_stage_names[PL_STAGES] = {
    [PL_STAGE_COMMANDS] = "commands",
    [PL_STAGE_BEGIN] = "begin",
    [PL_STAGE_FORCES] = "forces",
    [PL_STAGE_PAIRS] = "pairs",
    [PL_STAGE_CONTACTS] = "contacts",
    [PL_STAGE_EDITS] = "edits",
    [PL_STAGE_GRAPH] = "graph",
    [PL_STAGE_SOLVE] = "solve",
    [PL_STAGE_PREPARE] = "prepare",
    [PL_STAGE_MOMENT] = "moment",
    [PL_STAGE_VELOCITIES] = "velocities",
    [PL_STAGE_CONSTRAINTS] = "constraints",
    [PL_STAGE_POSITIONS] = "positions",
    [PL_STAGE_RELAX] = "relax",
    [PL_STAGE_SUMS] = "sums",
    [PL_STAGE_STORE] = "store",
    [PL_STAGE_FINISH] = "finish",
    [PL_STAGE_EVENTS] = "events",
    [PL_STAGE_END] = "end",
};

// The stages in which a system of a phase may stand, and the row that it stands behind if it names none.
static const struct {
    pl_stage first, last;
    const char *home, *where;
} windows[] = {
    // Velocities and forces that it writes are still taken up.
    [PLUMB_PHASE_BEGIN] = { PL_STAGE_BEGIN, PL_STAGE_CONTACTS, "begin systems",
                            "the stages begin to contacts" },
    [PLUMB_PHASE_FORCES] = { PL_STAGE_BEGIN, PL_STAGE_CONTACTS, "force systems",
                             "the stages begin to contacts" },
    // Contacts can be edited there alone.
    [PLUMB_PHASE_CONTACTS] = { PL_STAGE_EDITS, PL_STAGE_EDITS, "contact systems",
                               "the stage edits" },
    [PLUMB_PHASE_END] = { PL_STAGE_FINISH, PL_STAGE_END, "end systems",
                          "the stages finish to end" },
    [PLUMB_PHASE_SUBSTEP] = { PL_STAGE_MOMENT, PL_STAGE_SUMS, "substep systems",
                              "the stages moment to sums" },
};

static bool is_given(const char *name)
{
    return name != NULL && name[0] != '\0';
}

bool pl_system_is_placed(const plumb_system_desc *d)
{
    return d->phase == PLUMB_PHASE_SUBSTEP || is_given(d->before) || is_given(d->after) ||
           is_given(d->instead);
}

int pl_pass_find(const char *name)
{
    for (int i = 0; i < pl_pass_count; ++i) {
        if (strcmp(pl_passes[i].name, name) == 0) {
            return i;
        }
    }
    return -1;
}

static pl_line *places_of(const plumb_world *world)
{
    return world->schedule.places.data;
}

uint32_t pl_schedule_count(const plumb_world *world)
{
    return world->schedule.count > 0 ? world->schedule.count : (uint32_t)pl_pass_count;
}

pl_line pl_schedule_place(const plumb_world *world, uint32_t i)
{
    return world->schedule.count > 0 ? places_of(world)[i] : (pl_line){ i, PL_NO_SYSTEM };
}

static const char *name_of(const plumb_world *world, pl_line place)
{
    return place.system == PL_NO_SYSTEM ? pl_passes[place.pass].name
                                        : world->systems.items[place.system].name;
}

// PL_NONE: no row has the name.
static uint32_t line_of(const plumb_world *world, const char *name)
{
    for (uint32_t i = 0; i < pl_schedule_count(world); ++i) {
        if (strcmp(name_of(world, pl_schedule_place(world, i)), name) == 0) {
            return i;
        }
    }
    return PL_NONE;
}

//---- checks --------------------------------------------------------------------------------------

static plumb_result check_row(const plumb_world *world, const char *fn, const plumb_system_desc *d,
                              const char *field, const char *name)
{
    if (!is_given(name)) {
        return PLUMB_OK;
    }
    const uint32_t line = line_of(world, name);
    if (line == PL_NONE) {
        return pl_fail(world, PLUMB_E_MISSING, fn,
                       "%s is '%.64s'; it must be a row of the schedule: a pass or a system", field,
                       name);
    }
    const pl_stage stage = pl_passes[pl_schedule_place(world, line).pass].stage;
    if (stage < windows[d->phase].first || stage > windows[d->phase].last) {
        return pl_fail(world, PLUMB_E_STATE, fn,
                       "%s is '%.64s' in the stage %s; a system of this phase must stand in %s",
                       field, name, pl_stage_names[stage], windows[d->phase].where);
    }
    return PLUMB_OK;
}

static plumb_result check_instead(const plumb_world *world, const char *fn,
                                  const plumb_system_desc *d)
{
    const int pass = pl_pass_find(d->instead);
    if (pass < 0 || pl_is_home(&pl_passes[pass])) {
        return pl_fail(world, PLUMB_E_MISSING, fn, "instead is '%.64s'; it must be a pass",
                       d->instead);
    }
    if ((pl_passes[pass].kind & PL_REPLACEABLE) == 0) {
        return pl_fail(world, PLUMB_E_STATE, fn,
                       "instead is '%s'; the rows behind it rely on what it leaves: it cannot be "
                       "replaced",
                       d->instead);
    }
    for (uint32_t i = 0; i < world->systems.count; ++i) {
        if (strcmp(world->systems.items[i].instead, d->instead) == 0) {
            return pl_fail(world, PLUMB_E_DUPLICATE, fn,
                           "instead is '%s'; '%s' runs in its place already", d->instead,
                           world->systems.items[i].name);
        }
    }
    return PLUMB_OK;
}

plumb_result pl_place_check_system(const plumb_world *world, const char *fn,
                                   const plumb_system_desc *d)
{
    PL_TRY(check_row(world, fn, d, "before", d->before));
    PL_TRY(check_row(world, fn, d, "after", d->after));
    if (is_given(d->before) && is_given(d->after) &&
        line_of(world, d->after) >= line_of(world, d->before)) {
        return pl_fail(
            world, PLUMB_E_STATE, fn,
            "after is '%.64s' and before is '%.64s'; the first must stand before the second",
            d->after, d->before);
    }
    return is_given(d->instead) ? check_instead(world, fn, d) : PLUMB_OK;
}

//---- placing -------------------------------------------------------------------------------------

bool pl_place_reserve(plumb_world *world)
{
    return pl_buffer_reserve(&world->memory, &world->schedule.places,
                             ((size_t)pl_pass_count + world->systems.count + 1) * sizeof(pl_line));
}

// The line before which a system comes.
static uint32_t line_for(const plumb_world *world, const pl_system *system)
{
    const uint32_t count = world->schedule.count;
    const pl_line *places = places_of(world);
    if (is_given(system->after)) { // and behind those that asked for the same before
        uint32_t at = line_of(world, system->after) + 1;
        while (at < count && places[at].system != PL_NO_SYSTEM &&
               strcmp(world->systems.items[places[at].system].after, system->after) == 0) {
            ++at;
        }
        return at;
    }
    if (is_given(system->before)) {
        return line_of(world, system->before);
    }
    const plumb_phase phase = system->desc.phase;
    uint32_t home = line_of(world, windows[phase].home);
    if (is_given(system->instead)) {
        const pl_stage stage = pl_passes[pl_pass_find(system->instead)].stage;
        if (stage >= windows[phase].first && stage <= windows[phase].last) {
            home = line_of(world, system->instead);
        }
    }
    uint32_t at = home + 1;
    while (at < count && places[at].system != PL_NO_SYSTEM) {
        ++at;
    }
    return at;
}

static uint32_t registered(const plumb_world *world, uint32_t serial)
{
    for (uint32_t i = 0; i < world->systems.count; ++i) {
        if (world->systems.items[i].serial == serial) {
            return i;
        }
    }
    return PL_NONE;
}

void pl_place_all(plumb_world *world)
{
    pl_schedule *s = &world->schedule;
    pl_line *places = places_of(world);
    for (s->count = 0; s->count < (uint32_t)pl_pass_count; ++s->count) {
        places[s->count] = (pl_line){ s->count, PL_NO_SYSTEM };
    }
    for (uint32_t serial = 0; serial < world->systems.made; ++serial) {
        const uint32_t i = registered(world, serial);
        const uint32_t at = line_for(world, &world->systems.items[i]);
        memmove(&places[at + 1], &places[at], (s->count - at) * sizeof *places);
        // Of the stage of the row that it names.
        const bool before =
            is_given(world->systems.items[i].before) && !is_given(world->systems.items[i].after);
        places[at] = (pl_line){ places[before ? at + 1 : at - 1].pass, i };
        ++s->count;
    }
}

const char *pl_place_instead(const plumb_world *world, int pass)
{
    for (uint32_t i = 0; i < world->systems.count; ++i) {
        const pl_system *s = &world->systems.items[i];
        if (s->enabled && strcmp(s->instead, pl_passes[pass].name) == 0) {
            return s->name;
        }
    }
    return NULL;
}
