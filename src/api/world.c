// world.c - a world is made, destroyed, set and summed up.
//
// Reads: the descriptor; for stats and energy, the whole state. Writes: the world.
// Cost: O(1), plumb_world_destroy O(components), plumb_world_energy O(dynamic bodies + joints).
#include "accuracy/dial.h"
#include "api/command.h"
#include "broad/broad.h"
#include "broad/query_grids.h"
#include "character/character.h"
#include "continuous/continuous.h"
#include "core/bits.h"
#include "effects/effects.h"
#include "event/event.h"
#include "internal_edges/internal_edges.h"
#include "joints/energy.h"
#include "joints/joint.h"
#include "effects/laws.h"
#include "effects/waves.h"
#include "api/fracture.h"
#include "air/air.h"
#include "liquid/liquid.h"
#include "softbody/softbody.h"
#include "step/measure.h"
#include "narrow/narrow.h"
#include "plumb/world.h"
#include "schema/world.h"
#include "sleep/sleep.h"
#include "exact/exact.h"
#include "solver/solver.h"
#include "step/pass.h"
#include "step/quarantine.h"
#include "step/system.h"
#include "watchdog/watchdog.h"
#include "world/check.h"
#include "world/heat_list.h"
#include "world/island.h"
#include "world/observer.h"
#include "world/rows.h"
#include "world/wrap.h"

#include <string.h>

#define STANDARD_GRAVITY ((real)9.81) // [m/s^2]
#define CAPACITY_MOST                                                                              \
    (UINT32_C(1) << 24) // rows: more than any machine steps, less than wraps sizes
#define CLASSIC_ITERATIONS 10
#define SUBSTEPS_MOST      64
#define ITERATIONS_MOST    1000
#define BOX_CORNERS        4 // reserved a shape

//---- the descriptor ------------------------------------------------------------------------------

static plumb_result check_integers(const plumb_world *world, const char *fn,
                                   const plumb_world_desc *d)
{
    const struct {
        const char *name;
        int64_t value, high;
    } fields[] = {
        { "body_capacity", d->body_capacity, CAPACITY_MOST },
        { "shape_capacity", d->shape_capacity, CAPACITY_MOST },
        { "contact_capacity", d->contact_capacity, CAPACITY_MOST },
    };
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i) {
        if (fields[i].value < 0 || fields[i].value > fields[i].high) {
            return pl_fail(world, PLUMB_E_RANGE, fn, "%s is %lld; it must be 0 to %lld",
                           fields[i].name, (long long)fields[i].value, (long long)fields[i].high);
        }
    }
    if (d->simd_width != 0 && d->simd_width != 4 && d->simd_width != 8 && d->simd_width != 16) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "simd_width is %d; it must be 0, 4, 8 or 16",
                       d->simd_width);
    }
    return PLUMB_OK;
}

static plumb_result check_desc(const plumb_world *world, const char *fn, const plumb_world_desc *d)
{
    PL_TRY(pl_check_desc(world, fn, "", PLUMB_TABLE_WORLD, d));
    if (d->zero_gravity && (d->gravity.x != 0 || d->gravity.y != 0)) {
        return pl_fail(world, PLUMB_E_RANGE, fn,
                       "gravity is (%g, %g); it must be (0, 0) with zero_gravity",
                       (double)d->gravity.x, (double)d->gravity.y);
    }
    if (d->solver == PLUMB_SOLVER_PGS) {
        PL_TRY(PL_CHECK_HAS(world, fn, "solver pgs", PGS, "pgs"));
    } else if (d->solver == PLUMB_SOLVER_EXACT) {
        PL_TRY(PL_CHECK_HAS(world, fn, "solver exact", EXACT, "exact"));
    }
    return check_integers(world, fn, d);
}

#define RESOLVE(X, store, kind, name, word, unit, range, initial, ...) RESOLVE_##kind(name, initial)
#define RESOLVE_REAL(name, initial)                                    desc->name = desc->name != 0 ? desc->name : (real)(initial);
#define RESOLVE_INT(name, initial)                                     desc->name = desc->name != 0 ? desc->name : (initial);
#define RESOLVE_VEC2(name, initial)
#define RESOLVE_BOOL(name, initial)
#define RESOLVE_Y_AXIS(name, initial)
#define RESOLVE_SOLVER(name, initial)

// contact_hertz stays 0: "a sixth of the substep rate", which is known only when a step is taken.
void pl_world_resolve(plumb_world_desc *desc)
{
    desc->zero_gravity |= !PL_HAS(GRAVITY);
    if (!desc->zero_gravity && desc->gravity.x == 0 && desc->gravity.y == 0) {
        desc->gravity.y = desc->y_axis == PLUMB_Y_UP ? -STANDARD_GRAVITY : STANDARD_GRAVITY;
    }
    if (desc->solver == PLUMB_SOLVER_PGS) {
        desc->substeps = desc->substeps != 0 ? desc->substeps : 1;
        desc->iterations = desc->iterations != 0 ? desc->iterations : CLASSIC_ITERATIONS;
    }
    PL_WORLD_ROWS(RESOLVE, )
    desc->simd_width = pl_solver_best_width(desc->simd_width);
}

//---- create, destroy -----------------------------------------------------------------------------

static void init_tables(plumb_world *world)
{
    pl_registry_init(&world->registry);
    pl_pool_init(&world->vertices);
    world->pieces.free_head = PL_NONE;
    world->joints.free_head = PL_NONE;
    world->sleep.first_due = PL_NONE;
    world->continuous.least_slack = PLUMB_REAL_MAX;
    world->schedule_dirty = true;
}

static bool make_default_material(plumb_world *world)
{
    pl_materials *m = &world->materials;
    if (!pl_table_reserve(&world->memory, &m->table, pl_material_columns, pl_material_column_count,
                          1)) {
        return false;
    }
    m->table.count = 1;
    pl_material_fill(world, 0, &(plumb_material_desc){ 0 });
    return true;
}

static bool reserve_rows(plumb_world *world)
{
    const plumb_world_desc *d = &world->desc;
    size_t pairs = d->contact_capacity * sizeof(pl_pair);
    pl_memory *memory = &world->memory;
    return pl_registry_reserve(memory, &world->registry, d->body_capacity + d->shape_capacity) &&
           pl_rows_reserve(world, d->body_capacity) &&
           pl_pieces_reserve(world, d->shape_capacity) &&
           pl_pool_reserve(memory, &world->vertices, d->shape_capacity * BOX_CORNERS) &&
           pl_buffer_reserve(memory, &world->broad.pairs.items, pairs) &&
           pl_buffer_reserve(memory, &world->broad.pairs.old_items, pairs) &&
           pl_buffer_reserve(memory, &world->narrow.manifolds,
                             d->contact_capacity * sizeof(pl_manifold));
}

// A world of one worker and no hooks has no pool.
static bool start_workers(plumb_world *world)
{
    const plumb_world_desc *d = &world->desc;
    if (d->workers == 1 && d->tasks.run == NULL) {
        return true;
    }
    world->tasks = pl_tasks_create(&world->memory, d->workers, &d->tasks, d->hook_context);
    return world->tasks != NULL;
}

static void free_world(plumb_world *world)
{
    pl_memory memory = world->memory;
    pl_tasks_destroy(&memory, world->tasks);
    pl_broad_free(&memory, &world->broad);
    pl_query_grids_free(&memory, &world->query_grids);
    pl_narrow_free(&memory, &world->narrow);
    pl_ahead_free(&memory, &world->lookahead);
    pl_internal_edges_free(&memory, &world->internal_edges);
    pl_solver_free(&memory, &world->solver);
    pl_exact_free(&memory, &world->exact);
    pl_joints_free(&memory, &world->joints);
    pl_characters_free(&memory, &world->characters);
    pl_liquid_free(&memory, &world->liquid);
    pl_air_free(&memory, &world->air);
    pl_softbodies_free(&memory, &world->softbodies);
    pl_laws_free(&memory, &world->laws);
    pl_waves_free(&memory, &world->waves);
    pl_fracture_free(&memory, &world->fracture);
    pl_continuous_free(&memory, &world->continuous);
    pl_quarantine_free(&memory, &world->quarantine);
    pl_registry_free(&memory, &world->registry);
    pl_table_free(&memory, &world->bodies.table, pl_body_columns, pl_body_column_count);
    pl_table_free(&memory, &world->pieces.table, pl_piece_columns, pl_piece_column_count);
    pl_table_free(&memory, &world->materials.table, pl_material_columns, pl_material_column_count);
    pl_pool_free(&memory, &world->vertices);
    pl_components_free(&memory, &world->components);
    pl_systems_free(&memory, &world->systems);
    pl_schedule_free(&memory, &world->schedule);
    pl_effects_free(&memory, &world->effects);
    pl_measure_free(&memory, &world->measure);
    pl_watchdog_free(&memory, &world->watchdog);
    pl_commands_free(&memory, &world->commands);
    pl_buffer_free(&memory, &world->made);
    pl_buffer_free(&memory, &world->outline);
    pl_buffer_free(&memory, &world->moving);
    pl_buffer_free(&memory, &world->poses);
    pl_buffer_free(&memory, &world->begin_events);
    pl_buffer_free(&memory, &world->changed_pairs);
    pl_buffer_free(&memory, &world->end_events);
    pl_buffer_free(&memory, &world->hit_events);
    pl_buffer_free(&memory, &world->excluded);
    pl_buffer_free(&memory, &world->material_pairs);
    pl_buffer_free(&memory, &world->tombstones);
    pl_buffer_free(&memory, &world->checking);
    pl_buffer_free(&memory, &world->checked);
    pl_buffer_free(&memory, &world->settings.items);
    pl_heats_free(&memory, &world->heats);
    pl_buffer_free(&memory, &world->targets.items);
    pl_buffer_free(&memory, &world->tracks.items);
    pl_parts_free(&memory, &world->parts);
    pl_pending_hits_free(&memory, &world->pending_hits);
    pl_sensing_free(&memory, &world->sensing);
    pl_contact_index_free(&memory, &world->contact_index);
    pl_sleep_free(&memory, &world->sleep);
    pl_resize(&memory, world, sizeof *world, 0);
}

// What is said of a world that does not come to be: the record would go with it.
static plumb_result refuse_world(const plumb_world_desc *desc, plumb_result code,
                                 const char *message)
{
    if (desc->log != NULL) {
        desc->log(desc->hook_context, PLUMB_LOG_ERROR, message);
    }
    return code;
}

plumb_result plumb_world_create(const plumb_world_desc *desc, plumb_world **world)
{
    const plumb_world_desc zero = { 0 };
    desc = desc == NULL ? &zero : desc;
    if (world == NULL) {
        return refuse_world(desc, PLUMB_E_NULL,
                            "plumb_world_create: world is null; it must be given");
    }
    *world = NULL;
    pl_memory memory;
    pl_memory_init(&memory, &desc->allocator);
    plumb_world *made = pl_resize(&memory, NULL, 0, sizeof *made);
    if (made == NULL) {
        return refuse_world(desc, PLUMB_E_MEMORY,
                            "plumb_world_create: the allocator returned no memory");
    }
    memset(made, 0, sizeof *made); // a compound literal would be built on the stack
    made->desc = *desc;
    made->memory = memory;
    made->schedule.watched = pl_watched_bits(0, desc);
    init_tables(made);
    plumb_result r = check_desc(made, "plumb_world_create", desc);
    if (r == PLUMB_OK) {
        pl_world_resolve(&made->desc);
        made->desc.allocator = memory.hooks;
        made->gravity = made->desc.gravity;
        pl_dial_reset(made);
        if (!make_default_material(made) || !reserve_rows(made) || !start_workers(made)) {
            r = pl_fail_memory(made, "plumb_world_create");
        }
    }
    if (r != PLUMB_OK) {
        free_world(made);
        return r;
    }
    *world = made;
    return PLUMB_OK;
}

void plumb_world_destroy(plumb_world *world)
{
    if (world == NULL) {
        return;
    }
    if (world->observer != NULL && world->observer->gone != NULL) {
        world->observer->gone(world->observer, world);
    }
    pl_components_bury(world);
    free_world(world);
}

//---- settings ------------------------------------------------------------------------------------

plumb_world_desc plumb_world_settings(const plumb_world *world)
{
    return world == NULL ? (plumb_world_desc){ 0 } : world->desc;
}

plumb_result plumb_world_set_gravity(plumb_world *world, plumb_vec2 gravity)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(pl_check_finite_vec(world, __func__, "gravity", gravity));
    if (gravity.x != 0 || gravity.y != 0) {
        PL_TRY(PL_CHECK_HAS(world, __func__, "gravity", GRAVITY, "gravity"));
    }
    if (gravity.x != world->gravity.x || gravity.y != world->gravity.y) {
        pl_sleep_disturb_all(world);
    }
    world->gravity = world->desc.gravity = gravity;
    world->desc.zero_gravity = gravity.x == 0 && gravity.y == 0;
    world->schedule_dirty = true;
    return PLUMB_OK;
}

plumb_result plumb_world_set_time(plumb_world *world, double time)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(pl_check_unlocked(world, __func__));
    if (time - time != 0) {
        return pl_fail(world, PLUMB_E_NOT_FINITE, __func__, "time is %g; it must be finite", time);
    }
    if (time < 0 || time > 1e12) {
        return pl_fail(world, PLUMB_E_RANGE, __func__, "time is %g; it must be 0 to 1e12", time);
    }
    for (uint32_t i = 0; i < world->laws.count && time != world->time; ++i) {
        const pl_law_formula *formula =
            pl_law_formula_of(&world->laws, &pl_law_items(&world->laws)[i]);
        if (formula != NULL && formula->program.uses_time != 0) {
            pl_sleep_disturb_all(world); // it may be another force
        }
    }
    world->time = time;
    return PLUMB_OK;
}

static plumb_result check_count(const plumb_world *world, const char *fn, const char *field,
                                int value, int most)
{
    return value >= 1 && value <= most
               ? PLUMB_OK
               : pl_fail(world, PLUMB_E_RANGE, fn, "%s is %d; it must be 1 to %d", field, value,
                         most);
}

plumb_result plumb_world_set_substeps(plumb_world *world, int substeps, int iterations)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(check_count(world, __func__, "substeps", substeps, SUBSTEPS_MOST));
    PL_TRY(check_count(world, __func__, "iterations", iterations, ITERATIONS_MOST));
    PL_TRY(pl_check_unlocked(world, __func__));
    world->desc.substeps = substeps;
    world->desc.iterations = iterations;
    return PLUMB_OK;
}

plumb_result plumb_world_set_workers(plumb_world *world, int workers)
{
    PL_TRY(pl_check_unlocked(world, __func__));
    if (workers < 0 || workers > PLUMB_WORKERS_MAX) {
        return pl_fail(world, PLUMB_E_RANGE, __func__, "workers is %d; it must be 0 to %d", workers,
                       PLUMB_WORKERS_MAX);
    }
    workers = workers == 0 ? 1 : workers;
    if (workers == world->desc.workers) {
        return PLUMB_OK;
    }
    pl_tasks *old = world->tasks;
    const int before = world->desc.workers;
    world->tasks = NULL;
    world->desc.workers = workers;
    if (!start_workers(world)) {
        world->tasks = old;
        world->desc.workers = before;
        return pl_fail_memory(world, __func__);
    }
    pl_tasks_destroy(&world->memory, old);
    return PLUMB_OK;
}

plumb_result plumb_world_set_contact_tuning(plumb_world *world, plumb_real hertz,
                                            plumb_real damping, plumb_real push_speed)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(pl_check_range(world, __func__, "hertz", hertz, 0, PLUMB_REAL_MAX));
    PL_TRY(pl_check_range(world, __func__, "damping", damping, 0, PLUMB_REAL_MAX));
    PL_TRY(pl_check_range(world, __func__, "push_speed", push_speed, 0, PLUMB_REAL_MAX));
    PL_TRY(pl_check_unlocked(world, __func__));
    const plumb_world_desc before = world->desc;
    world->desc.contact_hertz = hertz;
    world->desc.contact_damping = damping;
    world->desc.push_speed = push_speed;
    pl_world_resolve(&world->desc);
    if (world->desc.contact_hertz != before.contact_hertz ||
        world->desc.contact_damping != before.contact_damping ||
        world->desc.push_speed != before.push_speed) {
        pl_sleep_disturb_all(world); // what rests sinks by another way
    }
    return PLUMB_OK;
}

plumb_result plumb_world_set_restitution_speed(plumb_world *world, plumb_real speed)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(pl_check_range(world, __func__, "speed", speed, 0, PLUMB_REAL_MAX));
    PL_TRY(pl_check_unlocked(world, __func__));
    world->desc.restitution_speed = speed;
    return PLUMB_OK;
}

plumb_result plumb_world_set_user_data(plumb_world *world, void *user_data)
{
    PL_TRY(pl_check_world(world));
    world->desc.user_data = user_data;
    return PLUMB_OK;
}

plumb_vec2 plumb_world_gravity(const plumb_world *world)
{
    return world == NULL ? plumb_v2(0, 0) : world->gravity;
}

plumb_vec2 plumb_world_up(const plumb_world *world)
{
    return world == NULL ? plumb_v2(0, 1) : pl_world_up(world);
}

void *plumb_world_user_data(const plumb_world *world)
{
    return world == NULL ? NULL : world->desc.user_data;
}

//---- sums ----------------------------------------------------------------------------------------

// The summary of contacts that sleep, as it was when they fell asleep.
static void add_sleeping(const plumb_world *world, pl_overlaps *sum)
{
    for (uint32_t k = 0; k < world->sleep.island_slots; ++k) {
        const pl_island *island = &pl_islands(&world->sleep)[k]; // a free slot has none
        pl_overlaps_add(sum, &island->overlaps);
        pl_overlaps_add(sum, &island->recalled);
    }
}

plumb_stats plumb_world_stats(const plumb_world *world)
{
    if (world == NULL) {
        return (plumb_stats){ 0 };
    }
    uint32_t bodies = world->bodies.table.count;
    pl_overlaps all = world->narrow.overlaps;
    add_sleeping(world, &all);
    return (plumb_stats){
        .step_count = world->step_count,
        .time = world->time,
        .body_count = bodies,
        .dynamic_count = world->dynamic_count,
        .kinematic_count = world->kinematic_count,
        .static_count = bodies - world->disabled_count - pl_partition_first(world, PL_PART_STATIC),
        .asleep_count = world->asleep_count,
        .island_count = world->sleep.island_count,
        .disabled_count = world->disabled_count,
        .shape_count = world->shape_count,
        .piece_count = world->pieces.live,
        .pair_count = world->broad.pairs.count + world->sleep.contact_count,
        .contact_count = all.touching_count,
        .point_count = all.point_count,
        .color_count = pl_count_bits(world->solver.colors_used),
        .overflow_count = world->solver.overflow_count,
        .pair_rebuilds = (uint32_t)world->broad.rebuilds,
        .bounce_count = world->solver.bounce_count,
        .exact_factored = world->exact.factored,
        .exact_islands = world->solver.hard_islands,
        .fine_islands = world->solver.fine_islands,
        .fine_substeps = pl_fine_substeps(world),
        .exact_missed = world->exact.missed,
        .exact_residual = world->exact.residual,
        .cut_chain_count = world->solver.cut_count,
        .soft_missed = world->softbodies.missed_count,
        .soft_count = world->softbodies.count,
        .soft_asleep = world->softbodies.asleep_count,
        .arrested_count = world->arrested_count,
        .alarm_count = world->watchdog.total,
        .fast_count = world->continuous.count,
        .stopped_count = world->continuous.stopped_count,
        .simd_width = pl_solver_kernels(world)->width,
        .max_penetration = all.max_penetration,
        .mean_penetration = all.touching_count > 0 ? (real)((double)all.sum_penetration *
                                                            PL_DEPTH_UNIT / all.touching_count)
                                                   : 0,
        .bytes = world->memory.bytes,
        .peak_bytes = world->memory.peak,
    };
}

static void add_energy(const plumb_world *world, uint32_t row, plumb_energy *e)
{
    const pl_bodies *b = &world->bodies;
    double m = (double)b->mass[row];
    double inertia = b->inv_inertia[row] > 0 ? (double)b->inertia[row] : 0;
    double x = (double)b->center_x[row];
    double y = (double)b->center_y[row];
    double vx = (double)b->vx[row];
    double vy = (double)b->vy[row];
    double w = (double)b->w[row];
    double g = (double)b->gravity_scale[row];
    e->kinetic += (m * (vx * vx + vy * vy) + inertia * w * w) / 2;
    e->potential -= m * g * ((double)world->gravity.x * x + (double)world->gravity.y * y);
    e->momentum_x += m * vx;
    e->momentum_y += m * vy;
    e->angular_momentum += m * (x * vy - y * vx) + inertia * w;
    e->mass += m;
}

plumb_energy plumb_world_energy(const plumb_world *world)
{
    plumb_energy energy = { 0 };
    if (world == NULL) {
        return energy;
    }
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        add_energy(world, row, &energy);
    }
    uint32_t asleep = pl_partition_first(world, PL_PART_ASLEEP);
    for (uint32_t row = asleep; row < asleep + world->asleep_count; ++row) {
        add_energy(world, row, &energy);
    }
    pl_softbodies_energy(world, &energy);
    if (world->laws.count > 0) {
        energy.potential += pl_laws_potential(world);
    }
    energy.stored += pl_joints_stored(world);
    return energy;
}
