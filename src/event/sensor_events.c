// sensor_events.c - what overlaps each sensor, and what began and ceased to.
//
// Pair finding lists what is near each sensor (broad->sensed); sorted by shapes, that is the list
// of candidates, made anew only when the pairs are. After the bodies have moved, each candidate is
// tested exactly, shape against shape, in double. The overlaps are sorted as the candidates are, so
// those of the step before are compared with them in one pass.
//
// Reads: broad->sensed, pieces, poses. Writes: overlaps, sensor events. Order: candidates after the
// broad phase, overlaps after motion. Cost: O(candidates); a world without sensors has neither
// pass.
#include "broad/pairs.h"
#include "core/sort.h"
#include "event/event.h"
#include "query/overlap.h"
#include "query/query.h"
#include "world/check.h"
#include "world/state.h"

void pl_sensing_free(pl_memory *memory, pl_sensing *s)
{
    pl_buffer *buffers[] = { &s->candidates, &s->overlaps, &s->old, &s->begins, &s->ends };
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; ++i) {
        pl_buffer_free(memory, buffers[i]);
    }
    *s = (pl_sensing){ 0 };
}

//---- before the step -----------------------------------------------------------------------------

static bool list_candidates(plumb_world *world)
{
    pl_sensing *s = &world->sensing;
    uint32_t count = world->sensor_pieces > 0 ? world->broad.sensed_count : 0;
    if (!pl_buffer_reserve(&world->memory, &s->candidates, count * sizeof(pl_keyed))) {
        return false;
    }
    const pl_found *found = world->broad.sensed.data;
    const plumb_entity *shape = world->pieces.shape;
    pl_keyed *to = s->candidates.data;
    for (uint32_t i = 0; i < count; ++i) {
        to[i] = (pl_keyed){ pl_key(shape[found[i].low].index, shape[found[i].high].index),
                            found[i].low, found[i].high };
    }
    pl_sort_keyed(to, count);
    s->candidate_count = count;
    s->rebuilds = world->broad.rebuilds;
    return true;
}

bool pl_sensing_prepare(plumb_world *world)
{
    pl_sensing *s = &world->sensing;
    if (s->rebuilds != world->broad.rebuilds && !list_candidates(world)) {
        return false;
    }
    pl_memory *memory = &world->memory;
    return pl_buffer_reserve(memory, &s->old, s->candidate_count * sizeof(pl_overlap)) &&
           pl_buffer_reserve(memory, &s->begins, s->candidate_count * sizeof(plumb_sensor_event)) &&
           pl_buffer_reserve(memory, &s->ends, s->count * sizeof(plumb_sensor_event));
}

//---- after motion --------------------------------------------------------------------------------

static bool pieces_overlap(const plumb_world *world, uint32_t p, uint32_t q)
{
    pl_box box_p = pl_piece_tight_box(world, p), box_q = pl_piece_tight_box(world, q);
    if (!pl_boxes_overlap(&box_p, &box_q)) {
        return false;
    }
    plumb_convex convex;
    pl_round round_p, round_q;
    plumb_vec2 origin = pl_query_frame(world, p).p;
    pl_piece_convex(world, p, &convex);
    pl_round_make(&convex, pl_query_frame(world, p), origin, &round_p);
    pl_piece_convex(world, q, &convex);
    pl_round_make(&convex, pl_query_frame(world, q), origin, &round_q);
    return pl_rounds_overlap(&round_p, &round_q);
}

// Fills s->overlaps from the candidates: one a pair of shapes.
static void test_candidates(plumb_world *world)
{
    pl_sensing *s = &world->sensing;
    const pl_pieces *pieces = &world->pieces;
    const pl_keyed *c = s->candidates.data;
    pl_overlap *out = s->overlaps.data;
    s->count = 0;
    for (uint32_t i = 0; i < s->candidate_count; ++i) {
        uint32_t sensor = c[i].order, other = c[i].value;
        bool known = s->count > 0 && out[s->count - 1].key == c[i].key;
        if (!known && pieces_overlap(world, sensor, other)) {
            out[s->count++] =
                (pl_overlap){ c[i].key,
                              { .sensor = pieces->shape[sensor],
                                .shape = pieces->shape[other],
                                .sensor_body = world->bodies.entity[pieces->body[sensor]],
                                .body = world->bodies.entity[pieces->body[other]] } };
        }
    }
}

static bool is_same(const pl_overlap *a, const pl_overlap *b)
{
    return plumb_same(a->who.sensor, b->who.sensor) && plumb_same(a->who.shape, b->who.shape);
}

// Both lists are sorted; slots may have been taken anew, hence is_same.
static void compare(pl_sensing *s)
{
    const pl_overlap *now = s->overlaps.data, *old = s->old.data;
    plumb_sensor_event *begins = s->begins.data, *ends = s->ends.data;
    uint32_t i = 0, k = 0;
    while (i < s->count || k < s->old_count) {
        bool takes_now = i < s->count && (k == s->old_count || now[i].key <= old[k].key);
        bool takes_old = k < s->old_count && (i == s->count || old[k].key <= now[i].key);
        bool goes_on = takes_now && takes_old && is_same(&now[i], &old[k]);
        if (takes_now && !goes_on) {
            begins[s->begin_count++] = now[i].who;
        }
        if (takes_old && !goes_on) {
            ends[s->end_count++] = old[k].who;
        }
        i += takes_now;
        k += takes_old;
    }
}

void pl_sensing_run(plumb_world *world)
{
    pl_sensing *s = &world->sensing;
    pl_buffer overlaps = s->overlaps;
    s->overlaps = s->old;
    s->old = overlaps;
    s->old_count = s->count;
    test_candidates(world);
    compare(s);
}

//---- read ----------------------------------------------------------------------------------------

static const plumb_sensor_event *events(const pl_buffer *buffer, int events, int *count)
{
    if (count != NULL) {
        *count = events;
    }
    return events == 0 ? NULL : buffer->data;
}

const plumb_sensor_event *plumb_world_sensor_begin_events(const plumb_world *world, int *count)
{
    return world == NULL ? events(NULL, 0, count)
                         : events(&world->sensing.begins, world->sensing.begin_count, count);
}

const plumb_sensor_event *plumb_world_sensor_end_events(const plumb_world *world, int *count)
{
    return world == NULL ? events(NULL, 0, count)
                         : events(&world->sensing.ends, world->sensing.end_count, count);
}

int plumb_shape_overlaps(const plumb_world *world, plumb_shape sensor, plumb_shape *shapes,
                         int capacity)
{
    uint32_t piece;
    plumb_result r = pl_check_shape(world, __func__, sensor, &piece);
    if (r == PLUMB_OK && (world->pieces.flags[piece] & PL_PIECE_SENSOR) == 0) {
        r = pl_fail(world, PLUMB_E_STATE, __func__, "shape is no sensor; it must be one");
    }
    r = r != PLUMB_OK ? r : pl_query_check_output(world, __func__, "shapes", shapes, capacity);
    if (r != PLUMB_OK) {
        return -1;
    }
    const pl_sensing *s = &world->sensing;
    const pl_overlap *at = s->overlaps.data;
    bool found;
    uint32_t i = pl_find_key(at, s->count, sizeof *at, pl_key(sensor.index, 0), &found);
    int count = 0;
    for (; i < s->count && (uint32_t)(at[i].key >> 32) == sensor.index; ++i) {
        // Since the step, either may have been destroyed.
        if (!plumb_same(at[i].who.sensor, sensor) || !plumb_shape_valid(world, at[i].who.shape)) {
            continue;
        }
        if (count < capacity) {
            shapes[count] = at[i].who.shape;
        }
        ++count;
    }
    return count;
}
