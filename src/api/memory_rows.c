// memory_rows.c - where the memory of a world is.
//
// A part's own function that frees it knows all of its buffers. Here it is given a copy of the part and
// an allocator that gives nothing back but adds up what it is told: no second list of buffers to
// keep. Only components and the queries' grids are counted by hand, for theirs are reached through pointers.
//
// Reads: sizes. Writes: nothing. Cost: O(buffers).
#include "api/command.h"
#include "broad/broad.h"
#include "broad/grid.h"
#include "character/character.h"
#include "continuous/continuous.h"
#include "effects/effects.h"
#include "event/event.h"
#include "internal_edges/internal_edges.h"
#include "joints/joint.h"
#include "effects/laws.h"
#include "effects/waves.h"
#include "air/air.h"
#include "liquid/liquid.h"
#include "softbody/softbody.h"
#include "step/measure.h"
#include "narrow/narrow.h"
#include "plumb/world.h"
#include "sleep/sleep.h"
#include "solver/solver.h"
#include "step/pass.h"
#include "step/quarantine.h"
#include "step/system.h"
#include "watchdog/watchdog.h"
#include "world/rows.h"

typedef struct listing {
    plumb_memory_row *rows;
    int capacity, count;
    size_t bytes; // of all rows so far
} listing;

static void *add_up(void *context, void *memory, size_t old_size, size_t new_size)
{
    (void)memory, (void)new_size;
    *(size_t *)context += old_size;
    return NULL;
}

static void tell(listing *out, const char *name, size_t bytes, uint32_t count)
{
    if (out->count < out->capacity) {
        out->rows[out->count] = (plumb_memory_row){ name, bytes, count };
    }
    ++out->count;
    out->bytes += bytes;
}

static size_t buffer_bytes(const pl_buffer *const *buffers, size_t count)
{
    size_t bytes = 0;
    for (size_t i = 0; i < count; ++i) {
        bytes += buffers[i]->size;
    }
    return bytes;
}

#define BUFFERS(...)                                                                               \
    buffer_bytes((const pl_buffer *const[]){ __VA_ARGS__ },                                        \
                 sizeof((const pl_buffer *[]){ __VA_ARGS__ }) / sizeof(pl_buffer *))

// What a part would give back.
#define PART(bytes, type, part, ...)                                                               \
    do {                                                                                           \
        type copy = (part);                                                                        \
        pl_memory dry = { .hooks = { add_up, &(bytes) } };                                         \
        __VA_ARGS__;                                                                               \
    } while (0)

static void tell_tables(listing *out, const plumb_world *w)
{
    size_t bodies = BUFFERS(&w->poses), shapes = BUFFERS(&w->made, &w->outline, &w->moving);
    size_t materials = BUFFERS(&w->material_pairs),
           entities = BUFFERS(&w->tombstones, &w->excluded);
    PART(bodies, pl_bodies, w->bodies,
         pl_table_free(&dry, &copy.table, pl_body_columns, pl_body_column_count));
    PART(shapes, pl_pieces, w->pieces,
         pl_table_free(&dry, &copy.table, pl_piece_columns, pl_piece_column_count));
    PART(shapes, pl_vertex_pool, w->vertices, pl_pool_free(&dry, &copy));
    PART(materials, pl_materials, w->materials,
         pl_table_free(&dry, &copy.table, pl_material_columns, pl_material_column_count));
    PART(entities, pl_registry, w->registry, pl_registry_free(&dry, &copy));
    tell(out, "bodies", bodies, w->bodies.table.count);
    tell(out, "shapes", shapes, w->pieces.live);
    tell(out, "materials", materials, w->materials.table.count);
    tell(out, "entities", entities, 0);
}

static void tell_passes(listing *out, const plumb_world *w)
{
    size_t broad = 0, narrow = 0, solver = 0, joints = 0, internal_edges = 0, sleep = 0, swept = 0;
    PART(broad, pl_broad, w->broad, pl_broad_free(&dry, &copy));
    PART(narrow, pl_narrow, w->narrow, pl_narrow_free(&dry, &copy));
    PART(narrow, pl_lookahead, w->lookahead, pl_ahead_free(&dry, &copy));
    PART(solver, pl_solver, w->solver, pl_solver_free(&dry, &copy));
    PART(solver, pl_quarantine, w->quarantine, pl_quarantine_free(&dry, &copy));
    PART(joints, pl_joints, w->joints, pl_joints_free(&dry, &copy));
    PART(internal_edges, pl_internal_edges, w->internal_edges, pl_internal_edges_free(&dry, &copy));
    PART(sleep, pl_sleep, w->sleep, pl_sleep_free(&dry, &copy));
    PART(swept, pl_continuous, w->continuous, pl_continuous_free(&dry, &copy));
    tell(out, "broad phase", broad, w->broad.pairs.count);
    tell(out, "contacts", narrow, w->narrow.overlaps.touching_count);
    tell(out, "solver", solver, 0);
    tell(out, "joints", joints, 0);
    tell(out, "internal edges", internal_edges, 0);
    tell(out, "sleep", sleep, w->asleep_count);
    tell(out, "continuous", swept, 0);
}

static size_t component_bytes(const pl_components *all)
{
    size_t bytes = all->bytes;
    for (uint32_t i = 0; i < all->count; ++i) {
        const pl_component *c = &all->items[i];
        bytes += c->fields_bytes + BUFFERS(&c->values, &c->owners, &c->rows, &c->order, &c->runs);
    }
    return bytes;
}

static size_t query_grid_bytes(const pl_query_grid_set *set)
{
    const pl_grid *grids = set->grids.data;
    size_t bytes = BUFFERS(&set->grids, &set->boxes, &set->list, &set->strays);
    for (int i = 0; grids != NULL && i < PL_QUERY_GRID_COUNT; ++i) {
        PART(bytes, pl_grid, grids[i], pl_grid_free(&dry, &copy));
    }
    return bytes;
}

static void tell_rest(listing *out, const plumb_world *w)
{
    size_t characters = 0, liquid = 0, air = 0, softbodies = 0, laws = 0, systems = 0, measures = 0;
    size_t watchdog = 0, waves = 0;
    size_t effects = BUFFERS(&w->settings.items, &w->targets.items, &w->tracks.items);
    size_t events = BUFFERS(&w->begin_events, &w->end_events, &w->changed_pairs, &w->hit_events);
    PART(characters, pl_characters, w->characters, pl_characters_free(&dry, &copy));
    PART(liquid, pl_liquid, w->liquid, pl_liquid_free(&dry, &copy));
    PART(air, pl_air, w->air, pl_air_free(&dry, &copy));
    PART(softbodies, pl_softbodies, w->softbodies, pl_softbodies_free(&dry, &copy));
    PART(laws, pl_laws, w->laws, pl_laws_free(&dry, &copy));
    PART(waves, pl_waves, w->waves, pl_waves_free(&dry, &copy));
    PART(systems, pl_systems, w->systems, pl_systems_free(&dry, &copy));
    PART(systems, pl_schedule, w->schedule, pl_schedule_free(&dry, &copy));
    PART(measures, pl_measure, w->measure, pl_measure_free(&dry, &copy));
    PART(watchdog, pl_watchdog, w->watchdog, pl_watchdog_free(&dry, &copy));
    PART(effects, pl_effects, w->effects, pl_effects_free(&dry, &copy));
    PART(systems, pl_commands, w->commands, pl_commands_free(&dry, &copy));
    PART(events, pl_parts, w->parts, pl_parts_free(&dry, &copy));
    PART(events, pl_pending_hits, w->pending_hits, pl_pending_hits_free(&dry, &copy));
    PART(events, pl_sensing, w->sensing, pl_sensing_free(&dry, &copy));
    PART(events, pl_contact_index, w->contact_index, pl_contact_index_free(&dry, &copy));
    tell(out, "queries", query_grid_bytes(&w->query_grids), 0);
    tell(out, "characters", characters, 0);
    tell(out, "liquid", liquid, w->liquid.count);
    tell(out, "air", air, w->air.cell_count);
    tell(out, "soft bodies", softbodies, w->softbodies.count);
    tell(out, "laws", laws, w->laws.count);
    tell(out, "waves", waves, w->waves.mode_count);
    tell(out, "effects", effects, 0);
    tell(out, "events", events, 0);
    tell(out, "components", component_bytes(&w->components), w->components.count);
    tell(out, "systems", systems, w->systems.count);
    tell(out, "measures", measures, 0);
    tell(out, "watchdog", watchdog, 0);
}

int plumb_world_memory(const plumb_world *world, plumb_memory_row *rows, int capacity)
{
    if (world == NULL) {
        return 0;
    }
    listing out = { rows, rows == NULL ? 0 : capacity, 0, 0 };
    tell_tables(&out, world);
    tell_passes(&out, world);
    tell_rest(&out, world);
    tell(&out, "world", world->memory.bytes - out.bytes, 1); // the world itself, and its threads
    return out.count;
}
