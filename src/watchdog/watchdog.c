// watchdog.c - the rows of the watchdog, and what it knows of each body: how it moves, which row of the step changed
// that, what was called last.
//
// Bodies are looked at as the step begins and behind each row that moves them; detectors look behind the last row.
// Reads: bodies, and what detectors read. Writes: world->watchdog alone. Order: first and last row, and around others.
// Cost: O(bodies) for each row that moves bodies, while the world has a watchdog; else nothing.
#include "watchdog/watchdog.h"

#include "world/rows.h"

#include <stdio.h>
#include <string.h>

void pl_watchdog_free(pl_memory *memory, pl_watchdog *dog)
{
    pl_buffer *buffers[] = { &dog->entities, &dog->flights, &dog->leaders, &dog->islands,
                             &dog->stored,   &dog->deep,    &dog->alarms };
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; ++i) {
        pl_buffer_free(memory, buffers[i]);
    }
}

void pl_watchdog_forget(pl_watchdog *dog)
{
    if (dog->entities.data != NULL) {
        memset(dog->entities.data, 0, dog->entities.size);
    }
    dog->begun = false;
    dog->count = 0;
    dog->given = dog->stored_most = dog->worked_most = dog->heaviest = 0;
}

bool pl_want_watchdog(const plumb_world *world, const char **reason)
{
    *reason = world->desc.watchdog ? "the world has a watchdog" : "nobody asked for a watchdog";
    return world->desc.watchdog;
}

const char *pl_watchdog_solver(const plumb_world *world)
{
    static const char *const names[] = { "soft step", "classic solver", "exact solver" };
    return names[world->desc.solver];
}

double pl_watchdog_bound(plumb_alarm_kind kind)
{
    static const double bounds[] = {
#define BOUND(NAME, name, bound, ...) bound,
        PLUMB_ALARM_LIST(BOUND)
#undef BOUND
    };
    return bounds[kind];
}

static const char *name_of(plumb_alarm_kind kind)
{
    static const char *const names[] = {
#define NAME_OF(NAME, name, ...) name,
        PLUMB_ALARM_LIST(NAME_OF)
#undef NAME_OF
    };
    return names[kind];
}

//---- telling -------------------------------------------------------------------------------------

static const char *system_named(const plumb_world *world, uint32_t serial)
{
    for (uint32_t i = 0; i < world->systems.count; ++i) {
        if (world->systems.items[i].serial == serial) {
            return world->systems.items[i].name;
        }
    }
    return "?";
}

// The later of the last commands of two records; either may be NULL.
static const pl_watched *later(const pl_watched *a, const pl_watched *b)
{
    const bool none_a = a == NULL || (a->command[0] == '\0' && a->system == 0);
    const bool none_b = b == NULL || (b->command[0] == '\0' && b->system == 0);
    if (none_a || none_b) {
        return none_a ? (none_b ? NULL : b) : a;
    }
    return b->command_step > a->command_step ? b : a;
}

static const pl_watched *find(plumb_world *world, plumb_entity entity)
{
    return plumb_is_null(entity) ? NULL : pl_watched_find(world, entity);
}

static void name_command(const plumb_world *world, plumb_alarm *alarm, char *text,
                         const pl_watched *w)
{
    alarm->command = "";
    if (w == NULL) {
        return;
    }
    alarm->command = w->command;
    alarm->command_step = w->command_step;
    if (w->system > 0) {
        snprintf(text, PL_ALARM_TEXT, "system '%s'", system_named(world, w->system - 1));
        alarm->command = text;
    }
}

static plumb_alarm alarm_of(const plumb_world *world, const pl_finding *f)
{
    const pl_bodies *b = &world->bodies;
    plumb_alarm a = { .kind = f->kind,
                      .value = (plumb_real)f->value,
                      .bound = (plumb_real)pl_watchdog_bound(f->kind),
                      .step = world->step_count,
                      .time = world->time,
                      .pass = f->pass,
                      .work = f->work != NULL ? f->work : "" };
    if (f->row != PL_NONE) {
        a.body = b->entity[f->row];
        a.point = plumb_v2(b->center_x[f->row], b->center_y[f->row]);
    }
    if (f->other != PL_NONE) {
        a.other = b->entity[f->other];
    }
    if (f->joint != NULL) {
        a.joint = f->joint->entity;
    }
    return a;
}

static void log_alarm(const plumb_world *world, const plumb_alarm *a)
{
    pl_warn(
        world, "watchdog: %s: body %u:%u: %.3g, bound %.3g, in '%s'%s%s of step %llu (%.6g s)%s%s",
        name_of(a->kind), (unsigned)a->body.entity.index, (unsigned)a->body.entity.generation,
        (double)a->value, (double)a->bound, a->pass, a->work[0] != '\0' ? " by " : "", a->work,
        (unsigned long long)a->step, a->time, a->command[0] != '\0' ? ", after " : "", a->command);
}

void pl_watchdog_tell(plumb_world *world, const pl_finding *f)
{
    pl_watchdog *dog = &world->watchdog;
    const plumb_entity who =
        f->joint != NULL ? f->joint->entity.entity : world->bodies.entity[f->row].entity;
    pl_watched *w = pl_watched_find(world, who); // there is room: open made it
    const uint64_t now = world->step_count + 1;
    const bool known =
        w->told[f->kind] > 0 && now - w->told[f->kind] <= (uint64_t)PLUMB_ALARM_SILENCE;
    w->told[f->kind] = now;
    if (known) {
        return;
    }
    ++dog->total;
    plumb_alarm *alarms = dog->alarms.data;
    char *texts =
        (char *)(alarms + PLUMB_ALARM_MAX + 1); // the last of both is of what there is no room for
    char *text = texts + (size_t)dog->count * PL_ALARM_TEXT;
    plumb_alarm a = alarm_of(world, f);
    const pl_watched *last = w;
    if (f->joint != NULL) {
        last = later(last, later(find(world, f->joint->a.body.entity),
                                 find(world, f->joint->b.body.entity)));
    } else if (f->other != PL_NONE && later(w, NULL) == NULL) {
        last = find(world, world->bodies.entity[f->other].entity);
    }
    name_command(world, &a, text, later(last, NULL));
    log_alarm(world, &a);
    if (dog->count < PLUMB_ALARM_MAX) {
        alarms[dog->count++] = a;
    }
}

//---- looking at bodies ---------------------------------------------------------------------------

static double kinetic(const pl_bodies *b, uint32_t row, double vx, double vy, double w)
{
    const double inertia = b->inv_inertia[row] > 0 ? (double)b->inertia[row] : 0;
    return ((double)b->mass[row] * (vx * vx + vy * vy) + inertia * w * w) / 2;
}

// What a row of the step did.
typedef struct deed {
    const char *pass;
    uint32_t system; // 1 + serial; 0: none
    pl_doing doing;
} deed;

static bool has_sped(const pl_bodies *b, uint32_t row, const pl_watched *w)
{
    return (double)b->vx[row] != w->vx || (double)b->vy[row] != w->vy || (double)b->w[row] != w->w;
}

static bool has_moved(const pl_bodies *b, uint32_t row, const pl_watched *w)
{
    return (double)b->center_x[row] != w->x || (double)b->center_y[row] != w->y ||
           (double)b->c[row] != w->c || (double)b->s[row] != w->s;
}

static void look(const plumb_world *world, uint32_t row, pl_watched *w)
{
    const pl_bodies *b = &world->bodies;
    w->vx = (double)b->vx[row], w->vy = (double)b->vy[row], w->w = (double)b->w[row];
    w->x = (double)b->center_x[row], w->y = (double)b->center_y[row];
    w->c = (double)b->c[row], w->s = (double)b->s[row];
}

// [m/s] of the fastest point of a row.
static double speed_of(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    return pl_length((double)b->vx[row], (double)b->vy[row]) +
           fabs((double)b->w[row]) * (double)b->extent[row];
}

static void note(plumb_world *world, uint32_t row, deed d)
{
    const pl_bodies *b = &world->bodies;
    pl_watched *w = pl_watched_row(world, row);
    const bool sped = has_sped(b, row, w), moved = has_moved(b, row, w);
    if (!sped && !moved) {
        return;
    }
    if (d.doing == PL_DOES_SHIFT) {
        w->from_x += (double)b->center_x[row] - w->x;
        w->from_y += (double)b->center_y[row] - w->y;
        look(world, row, w);
        return;
    }
    const double gained =
        kinetic(b, row, (double)b->vx[row], (double)b->vy[row], (double)b->w[row]) -
        kinetic(b, row, w->vx, w->vy, w->w);
    if (gained > w->hastened_by) {
        w->hastened_by = gained;
        w->hastened = d.pass;
    }
    w->moved = moved ? d.pass : w->moved;
    w->stopped |= moved && d.doing == PL_DOES_STOP;
    if (d.system > 0) {
        w->system = d.system;
        w->command_step = world->step_count;
        world->watchdog.given = pl_more(world->watchdog.given, sped ? speed_of(world, row) : 0);
    }
    look(world, row, w);
}

static uint32_t moving_rows(const plumb_world *world)
{
    return world->dynamic_count + world->kinematic_count;
}

void pl_watchdog_before(plumb_world *world, pl_doing doing)
{
    if (doing == PL_DOES_MOTION) {
        pl_watch_energy_before(world);
    }
}

//---- as the step begins --------------------------------------------------------------------------

static bool reserve(plumb_world *world)
{
    pl_watchdog *dog = &world->watchdog;
    pl_memory *memory = &world->memory;
    const size_t rows = (size_t)world->dynamic_count + world->asleep_count + 1;
    const uint32_t slots = world->registry.count;
    const size_t pieces = world->pieces.table.count + (size_t)1;
    return (slots == 0 ||
            pl_watched_find(
                world, (plumb_entity){ slots - 1, world->registry.slots[slots - 1].generation }) !=
                NULL) &&
           pl_buffer_reserve(memory, &dog->flights, rows * sizeof(pl_watched_flight)) &&
           pl_buffer_reserve(memory, &dog->leaders, rows * sizeof(uint32_t)) &&
           pl_buffer_reserve(memory, &dog->islands, rows * sizeof(pl_watched_island)) &&
           pl_buffer_reserve(memory, &dog->stored, (world->joints.count + 1) * sizeof(double)) &&
           pl_buffer_reserve(memory, &dog->deep, pieces * sizeof(uint32_t)) &&
           pl_buffer_reserve(memory, &dog->alarms,
                             (PLUMB_ALARM_MAX + 1) * (sizeof(plumb_alarm) + PL_ALARM_TEXT));
}

// Speeds that nothing in a step accounts for were given: by calls, or before anybody watched.
static void open_row(plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    pl_watchdog *dog = &world->watchdog;
    pl_watched *w = pl_watched_find(world, b->entity[row].entity);
    if (row >= world->dynamic_count || has_sped(b, row, w)) {
        dog->given = pl_more(dog->given, speed_of(world, row));
    }
    look(world, row, w);
    w->seen = world->step_count + 1;
    w->from_vx = w->vx, w->from_vy = w->vy, w->from_w = w->w;
    w->from_x = w->x, w->from_y = w->y, w->from_c = w->c, w->from_s = w->s;
    w->hastened = w->moved = "";
    w->hastened_by = 0;
    w->stopped = false;
    if (row < world->dynamic_count) {
        const double height = -((double)world->gravity.x * w->x + (double)world->gravity.y * w->y);
        dog->highest = pl_more(dog->highest, height);
        dog->lowest = pl_less(dog->lowest, height);
        dog->heaviest = pl_more(dog->heaviest, (double)b->mass[row]);
    }
}

static void open_gravity(plumb_world *world)
{
    pl_watchdog *dog = &world->watchdog;
    if (dog->begun && dog->gravity.x == world->gravity.x && dog->gravity.y == world->gravity.y) {
        return;
    }
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        dog->given = pl_more(dog->given, speed_of(world, row)); // what fell by another gravity
    }
    dog->gravity = world->gravity;
    dog->highest = -HUGE_VAL;
    dog->lowest = HUGE_VAL;
}

plumb_result pl_run_watch(plumb_world *world, real dt)
{
    (void)dt;
    if (!reserve(world)) {
        return PLUMB_E_MEMORY;
    }
    open_gravity(world);
    world->watchdog.count = 0;
    world->watchdog.begun = true;
    world->watchdog.filed = false;
    for (uint32_t row = 0; row < moving_rows(world); ++row) {
        open_row(world, row);
    }
    return PLUMB_OK;
}

// Who woke in this step begins it now.
static void open_woken(plumb_world *world)
{
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        const pl_watched *w = pl_watched_find(world, world->bodies.entity[row].entity);
        if (w->seen != world->step_count + 1) {
            open_row(world, row);
        }
    }
}

//---- behind rows ---------------------------------------------------------------------------------

void pl_watchdog_after(plumb_world *world, pl_doing doing, const char *pass, uint32_t system,
                       real dt)
{
    pl_watchdog *dog = &world->watchdog;
    dog->filed |= doing == PL_DOES_FILE;
    if (!dog->begun || doing < PL_DOES_WAKE) {
        return;
    }
    if (doing == PL_DOES_WAKE) {
        open_woken(world);
        return;
    }
    if (doing == PL_DOES_MOTION) {
        pl_watch_energy_after(world, dt);
    }
    const uint32_t *slots = world->solver.slots.data;
    const bool solved = doing == PL_DOES_MOTION && world->solver.slot_count > 0;
    deed d = { pass, system != PL_NO_SYSTEM ? world->systems.items[system].serial + 1 : 0, doing };
    for (uint32_t row = 0; row < moving_rows(world); ++row) {
        d.pass = solved && row < world->dynamic_count && slots[row] != PL_NONE
                     ? pl_watchdog_solver(world)
                     : pass;
        note(world, row, d);
    }
}

//---- as it ends ----------------------------------------------------------------------------------

plumb_result pl_run_watchdog(plumb_world *world, real dt)
{
    pl_watch_speeds(world, dt);
    pl_watch_passages(world, dt);
    pl_watch_contacts(world, dt);
    pl_watch_joints(world, dt);
    return PLUMB_OK;
}
