// schedule.c - which rows this world wants, those of the substeps as a list, times, and the schedule's public view.
//
// Reads: the table, systems, counters. Writes: world->schedule. Cost: O(rows), when something structural changed.
#include "step/system.h"
#include "core/clock.h"
#include "step/measure.h"
#include "solver/substep.h"
#include "step/acting.h"
#include "step/place.h"
#include "world/check.h"
#include "world/state.h"

#include <string.h>

_Static_assert((int)PL_STAGE_STORE - (int)PL_STAGE_PREPARE + 1 == (int)PL_SUBSTEP_STAGES,
               "the stages of the substeps are listed twice");
_Static_assert(sizeof((pl_schedule *)0)->ends / sizeof(uint32_t) == PL_SUBSTEP_STAGES,
               "an end a stage");

void pl_schedule_free(pl_memory *memory, pl_schedule *schedule)
{
    pl_buffer_free(memory, &schedule->places);
    pl_buffer_free(memory, &schedule->rows);
    pl_buffer_free(memory, &schedule->next);
    pl_buffer_free(memory, &schedule->times);
    pl_buffer_free(memory, &schedule->shares);
    pl_buffer_free(memory, &schedule->digests);
}

static bool times_are_watched(const plumb_world *world)
{
    return (world->schedule.watched & PLUMB_WATCH_TIMES) != 0;
}

static bool writes_are_watched(const plumb_world *world)
{
    return (world->schedule.watched & PLUMB_WATCH_WRITES) != 0;
}

//---- what is wanted ------------------------------------------------------------------------------

static pl_substep_fn *fn_of(const plumb_world *world, const pl_pass *pass)
{
    return pass->row[world->desc.solver];
}

bool pl_pass_wanted(const plumb_world *world, int i, const char **reason)
{
    const pl_pass *pass = &pl_passes[i];
    *reason = "part of every step";
    if (pl_is_home(pass)) {
        return false;
    }
    if (pass->wanted != NULL && !pass->wanted(world, reason)) {
        return false;
    }
    const bool held =
        world->desc.solver == PLUMB_SOLVER_SOFT && pass->row[PLUMB_SOLVER_EXACT] != NULL;
    if (pl_is_substep_stage(pass->stage) && fn_of(world, pass) == NULL && !held) {
        *reason = "the world's solver has no such part";
        return false;
    }
    if ((pass->kind & PL_REPLACEABLE) != 0 && pl_place_instead(world, i) != NULL) {
        *reason = "a system of the user's runs in its place";
        return false;
    }
    return true;
}

bool pl_schedule_reserve(plumb_world *world)
{
    pl_schedule *s = &world->schedule;
    const size_t rows = (size_t)pl_pass_count + world->systems.count;
    const size_t threads = times_are_watched(world) ? (size_t)pl_tasks_workers(world->tasks) : 0;
    return pl_buffer_reserve(&world->memory, &s->rows, rows * sizeof(pl_substep_row)) &&
           pl_buffer_reserve(&world->memory, &s->next, (rows + 1) * sizeof(uint16_t)) &&
           pl_buffer_reserve(&world->memory, &s->shares, threads * rows * sizeof(double));
}

static void add_row(pl_schedule *s, uint32_t *count, pl_substep_fn *run, pl_substep_fn *exact,
                    uint32_t place, uint32_t system)
{
    ((pl_substep_row *)s->rows.data)[(*count)++] =
        (pl_substep_row){ .run = run, .exact = exact, .place = place, .system = system };
}

// The rows of the substeps, as they are run.
static void list_rows(plumb_world *world)
{
    pl_schedule *s = &world->schedule;
    uint32_t count = 0;
    int stage = PL_STAGE_PREPARE;
    for (uint32_t i = 0; i < pl_schedule_count(world); ++i) {
        const pl_line place = pl_schedule_place(world, i);
        const pl_pass *pass = &pl_passes[place.pass];
        const char *unused;
        if (!pl_is_substep_stage(pass->stage)) {
            continue;
        }
        while (stage < (int)pass->stage) {
            s->ends[stage++ - PL_STAGE_PREPARE] = count;
        }
        if (place.system != PL_NO_SYSTEM) {
            if (pl_system_wanted(world, &world->systems.items[place.system], &unused)) {
                add_row(s, &count, pl_system_row, pl_system_row, i, place.system);
            }
        } else if (s->scheduled[place.pass]) {
            add_row(s, &count, fn_of(world, pass), pass->row[PLUMB_SOLVER_EXACT], i, PL_NO_SYSTEM);
        }
    }
    while (stage <= PL_STAGE_STORE) {
        s->ends[stage++ - PL_STAGE_PREPARE] = count;
    }
}

// The lines that run outside of the substeps: passes that are wanted, and systems, which are asked when they are reached.
// Most lines of a small world are none of these, and to ask each of them took a sixth of its step.
static void link_lines(plumb_world *world)
{
    const pl_schedule *s = &world->schedule;
    uint16_t *next = s->next.data;
    uint32_t i = pl_schedule_count(world);
    next[i] = (uint16_t)i;
    while (i-- > 0) {
        const pl_line place = pl_schedule_place(world, i);
        const bool runs = place.system != PL_NO_SYSTEM ||
                          (s->scheduled[place.pass] && pl_passes[place.pass].run != NULL);
        next[i] = runs ? (uint16_t)i : next[i + 1];
    }
}

void pl_schedule_revise(plumb_world *world)
{
    pl_schedule *s = &world->schedule;
    const char *unused;
    for (int i = 0; i < pl_pass_count; ++i) {
        s->scheduled[i] = pl_pass_wanted(world, i, &unused);
    }
    world->effects.decays_stale = true;
    world->effects.resets = s->scheduled[pl_pass_find("forces of now")];
    world->effects.damps = s->scheduled[pl_pass_find("damping")];
    world->effects.caps = s->scheduled[pl_pass_find("speed caps")];
    list_rows(world);
    link_lines(world);
    world->schedule_dirty = false;
}

//---- times ---------------------------------------------------------------------------------------

static pl_time *time_of(plumb_world *world, pl_line place)
{
    return place.system != PL_NO_SYSTEM ? &world->systems.items[place.system].time
                                        : (pl_time *)world->schedule.times.data + place.pass;
}

void pl_schedule_begin(plumb_world *world)
{
    for (uint32_t i = 0; times_are_watched(world) && i < pl_schedule_count(world); ++i) {
        time_of(world, pl_schedule_place(world, i))->last_ns = 0;
    }
    for (uint32_t i = 0; i < world->systems.count; ++i) {
        world->systems.items[i].ran = false;
    }
}

void pl_schedule_note(plumb_world *world, pl_line place, double ns)
{
    pl_time *time = time_of(world, place);
    time->last_ns += ns;
    time->total_ns += ns;
}

plumb_result plumb_world_watch(plumb_world *world, unsigned what)
{
    PL_TRY(pl_check_unlocked(world, __func__));
    if (what > (PLUMB_WATCH_TIMES | PLUMB_WATCH_WRITES)) {
        return pl_fail(world, PLUMB_E_RANGE, __func__,
                       "what is %u; it must be a sum of plumb_watch", what);
    }
    pl_schedule *s = &world->schedule;
    const size_t known = s->times.size;
    if (!pl_buffer_reserve(&world->memory, &s->times, PL_PASS_MAX * sizeof(pl_time)) ||
        !pl_check_reserve(world)) {
        return pl_fail_memory(world, __func__);
    }
    memset((char *)s->times.data + known, 0, s->times.size - known);
    s->watched = pl_watched_bits(what, &world->desc);
    return PLUMB_OK;
}

//---- the substeps --------------------------------------------------------------------------------

static const char *name_at(const plumb_world *world, uint32_t line)
{
    const pl_line place = pl_schedule_place(world, line);
    return place.system != PL_NO_SYSTEM ? world->systems.items[place.system].name
                                        : pl_passes[place.pass].name;
}

void pl_schedule_check(plumb_world *world, uint32_t line)
{
    const pl_line place = pl_schedule_place(world, line);
    uint32_t writes;
    const char *unknown;
    int length;
    if (place.system != PL_NO_SYSTEM) {
        const pl_system *system = &world->systems.items[place.system];
        writes = system->checked ? system->written : UINT32_MAX;
    } else if (!pl_data_parse(NULL, pl_passes[place.pass].writes, &writes, &unknown, &length)) {
        writes = 0;
    }
    pl_check_after(world, name_at(world, line), writes);
}

static void check_before(pl_substep *s)
{
    pl_check_before(s->world);
}

static void check_after(pl_substep *s)
{
    pl_schedule_check(s->world, s->row->place);
}

// Of a world that measures itself as well.
static void look_before(pl_substep *s)
{
    pl_measure_before_row(s);
    pl_check_before(s->world);
}

static void look_after(pl_substep *s)
{
    pl_schedule_check(s->world, s->row->place);
    pl_measure_after_row(s);
}

static void watch_rows(const plumb_world *world, pl_substep_rows *rows)
{
    const bool checked = writes_are_watched(world);
    rows->alone = checked;
    if (checked) {
        rows->before = check_before, rows->after = check_after;
    }
    if (world->desc.measure) {
        rows->before = checked ? look_before : pl_measure_before_row;
        rows->after = checked ? look_after : pl_measure_after_row;
    }
}

void pl_schedule_substeps(plumb_world *world, real dt)
{
    pl_schedule *s = &world->schedule;
    const char *locked_by = world->locked_by;
    const bool timed = times_are_watched(world);
    pl_substep_rows rows = { .items = s->rows.data,
                             .count = s->ends[PL_SUBSTEP_STAGES - 1],
                             .ns = timed ? s->shares.data : NULL };
    watch_rows(world, &rows);
    memcpy(rows.end, s->ends, sizeof rows.end);
    const uint32_t threads = (uint32_t)pl_tasks_workers(world->tasks);
    if (timed) {
        memset(rows.ns, 0, (size_t)threads * rows.count * sizeof(double));
    }
    if (world->systems.in_substeps > 0) {
        world->locked_by = "systems of the substep";
    }
    const double start = timed ? pl_now_ns() : 0;
    pl_substeps_run(world, &rows, dt);
    world->locked_by = locked_by;
    if (!timed) {
        return;
    }
    // Of several threads rows have their share of the time that the whole took.
    const double whole = pl_now_ns() - start;
    double sum = 0;
    for (uint32_t i = 0; i < threads * rows.count; ++i) {
        sum += rows.ns[i];
    }
    const double part = sum > whole ? whole / sum : 1;
    s->inner_ns = sum * part;
    for (uint32_t i = 0; i < rows.count; ++i) {
        double ns = 0;
        for (uint32_t k = 0; k < threads; ++k) {
            ns += rows.ns[k * rows.count + i];
        }
        pl_schedule_note(world, pl_schedule_place(world, rows.items[i].place), ns * part);
    }
}

//---- shown ---------------------------------------------------------------------------------------

static plumb_pass_info system_info(const plumb_world *world, pl_line place)
{
    const pl_system *s = &world->systems.items[place.system];
    plumb_pass_info row = { .name = s->name,
                            .phase = pl_stage_names[pl_passes[place.pass].stage],
                            .reads = s->reads,
                            .writes = s->writes,
                            .in_substeps = pl_is_substep_stage(pl_passes[place.pass].stage),
                            .is_user = true,
                            .last_ns = s->time.last_ns,
                            .total_ns = s->time.total_ns };
    row.scheduled = pl_system_wanted(world, s, &row.reason);
    return row;
}

static plumb_pass_info pass_info(const plumb_world *world, uint32_t i)
{
    const pl_pass *pass = &pl_passes[i];
    const pl_time *times = world->schedule.times.data;
    plumb_pass_info row = { .name = pass->name,
                            .phase = pl_stage_names[pass->stage],
                            .reads = pass->reads,
                            .writes = pass->writes,
                            .in_substeps = pl_is_substep_stage(pass->stage),
                            .last_ns = times == NULL ? 0 : times[i].last_ns,
                            .total_ns = times == NULL ? 0 : times[i].total_ns };
    row.scheduled = pl_pass_wanted(world, (int)i, &row.reason);
    pl_variants v = { 0, 0, { NULL }, { NULL } };
    if (pass->variants != NULL) {
        pass->variants(world, &v);
    }
    row.variant_count = v.count, row.away_count = v.away_count;
    memcpy(row.variants, v.names, sizeof v.names);
    memcpy(row.away, v.away, sizeof v.away);
    return row;
}

int plumb_world_schedule(const plumb_world *world, plumb_pass_info *rows, int capacity)
{
    int count = 0;
    for (uint32_t i = 0; world != NULL && i < pl_schedule_count(world); ++i) {
        const pl_line place = pl_schedule_place(world, i);
        if (place.system == PL_NO_SYSTEM && pl_is_home(&pl_passes[place.pass])) {
            continue;
        }
        if (rows != NULL && count < capacity) {
            rows[count] = place.system != PL_NO_SYSTEM ? system_info(world, place)
                                                       : pass_info(world, place.pass);
        }
        ++count;
    }
    return count;
}

const char *plumb_data_name(int index)
{
    return index >= 0 && index < PL_DATA_COUNT ? pl_data_name(index) : NULL;
}
