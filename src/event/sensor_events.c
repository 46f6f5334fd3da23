// sensor_events.c - what overlaps each sensor, and what began and ceased to.
//
// Pair finding lists what is near each sensor (broad->sensed); sorted by shapes, that is the list
// of candidates, made anew only when the pairs are. After the bodies have moved, each candidate is
// tested exactly, shape against shape, in double. The overlaps are sorted as the candidates are, so
// those of the step before are compared with them in one pass.
//
// Pairs of which neither piece moves (a static sensor over what sleeps) are kept apart, and looked for
// and tested only in steps in which something falls asleep, wakes, is placed or goes.
//
// Reads: broad->sensed, pieces, poses. Writes: overlaps, sensor events. Order: candidates after the
// broad phase and the sleep pass, overlaps after motion. Cost: O(candidates that move); a world without
// sensors has neither pass.
#include "broad/images.h"
#include "broad/pairs.h"
#include "core/sort.h"
#include "event/event.h"
#include "query/overlap.h"
#include "query/query.h"
#include "world/check.h"
#include "world/filter.h"
#include "world/island.h"
#include "world/rows.h"

void pl_sensing_free(pl_memory *memory, pl_sensing *s)
{
    pl_buffer *buffers[] = { &s->candidates,    &s->overlaps, &s->old,    &s->rest_candidates,
                             &s->rest_overlaps, &s->rest_old, &s->begins, &s->ends };
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
    pl_found *found = world->broad.sensed.data;
    const plumb_shape *shape = world->pieces.shape;
    pl_keyed *to = s->candidates.data;
    for (uint32_t i = 0; i < count; ++i) {
        to[i] =
            (pl_keyed){ pl_key(shape[found[i].low].entity.index, shape[found[i].high].entity.index),
                        found[i].low, found[i].high };
    }
    pl_sort_keyed(to, count);
    for (uint32_t i = 0; i < count; ++i) { // in an order that no grid decides: it is saved
        found[i] = (pl_found){ to[i].order, to[i].value };
    }
    s->candidate_count = count;
    s->rebuilds = world->broad.rebuilds;
    return true;
}

// Neither by itself nor by contacts: static or asleep.
static bool is_at_rest(const plumb_world *world, uint32_t piece)
{
    const pl_pieces *p = &world->pieces;
    return p->kind[piece] != PL_PIECE_FREE &&
           (p->moving[piece] == PL_NONE || (p->flags[piece] & PL_PIECE_ASLEEP) != 0);
}

typedef struct rest_finder {
    plumb_world *world;
    uint32_t sensor;
} rest_finder;

static bool add_at_rest(void *context, const pl_grid_entry *entry)
{
    const rest_finder *f = context;
    plumb_world *world = f->world;
    const pl_pieces *p = &world->pieces;
    pl_sensing *s = &world->sensing;
    uint32_t q = entry->piece;
    if (!is_at_rest(world, q) || p->body[q] == p->body[f->sensor] ||
        !pl_pieces_meet(world, f->sensor, q)) {
        return true;
    }
    size_t room = ((size_t)s->rest_candidate_count + 1) * sizeof(pl_keyed);
    if (!pl_buffer_reserve(&world->memory, &s->rest_candidates, room)) {
        return false;
    }
    ((pl_keyed *)s->rest_candidates.data)[s->rest_candidate_count++] =
        (pl_keyed){ pl_key(p->shape[f->sensor].entity.index, p->shape[q].entity.index), f->sensor,
                    q };
    return true;
}

// The grid of what sleeps may name pieces that sleep no more; some of those are static now.
static bool add_asleep(void *context, const pl_grid_entry *entry)
{
    const rest_finder *f = context;
    return (f->world->pieces.flags[entry->piece] & PL_PIECE_ASLEEP) == 0 ||
           add_at_rest(context, entry);
}

// What sleeps near a sensor at rest, and what is static near a sensor that sleeps.
static bool list_rest_candidates(plumb_world *world)
{
    const pl_pieces *p = &world->pieces;
    pl_sensing *s = &world->sensing;
    s->rest_candidate_count = 0;
    for (uint32_t piece = 0; world->sensor_pieces > 0 && piece < p->table.count; ++piece) {
        rest_finder f = { world, piece };
        bool asleep = (p->flags[piece] & PL_PIECE_ASLEEP) != 0;
        if (!is_at_rest(world, piece) || (p->flags[piece] & PL_PIECE_SENSOR) == 0) {
            continue;
        }
        if (!pl_world_query(world, &world->broad.resting, p->fat[piece], add_asleep, &f) ||
            (asleep &&
             !pl_world_query(world, &world->broad.fixed, p->fat[piece], add_at_rest, &f))) {
            return false;
        }
    }
    pl_sort_keyed(s->rest_candidates.data, s->rest_candidate_count);
    return true;
}

bool pl_sensing_prepare(plumb_world *world)
{
    pl_sensing *s = &world->sensing;
    pl_memory *memory = &world->memory;
    size_t rest = 0;
    if (s->rebuilds != world->broad.rebuilds && !list_candidates(world)) {
        return false;
    }
    if (s->rest_stale) {
        if (!pl_broad_update_resting(world) || !list_rest_candidates(world)) {
            return false;
        }
        rest = s->rest_candidate_count;
    }
    size_t begins = s->candidate_count + rest, ends = (size_t)s->count + s->rest_count;
    return pl_buffer_reserve(memory, &s->old, s->candidate_count * sizeof(pl_overlap)) &&
           pl_buffer_reserve(memory, &s->rest_old, rest * sizeof(pl_overlap)) &&
           pl_buffer_reserve(memory, &s->begins, begins * sizeof(plumb_sensor_event)) &&
           pl_buffer_reserve(memory, &s->ends, ends * sizeof(plumb_sensor_event));
}

//---- after motion --------------------------------------------------------------------------------

static bool pieces_overlap(const plumb_world *world, uint32_t p, uint32_t q)
{
    pl_box box_p = pl_piece_tight_box(world, p), box_q = pl_piece_tight_box(world, q);
    plumb_vec2 middle = { box_p.min_x + (box_p.max_x - box_p.min_x) / 2,
                          box_p.min_y + (box_p.max_y - box_p.min_y) / 2 };
    if (!pl_is_wrapped(world) && !pl_boxes_overlap(&box_p, &box_q)) {
        return false;
    }
    plumb_convex convex;
    pl_round round_p, round_q;
    plumb_transform frame = pl_query_frame(world, p, middle);
    pl_piece_convex(world, p, &convex);
    pl_round_make(&convex, frame, frame.p, &round_p);
    pl_piece_convex(world, q, &convex);
    pl_round_make(&convex, pl_query_frame(world, q, middle), frame.p, &round_q);
    return pl_rounds_overlap(&round_p, &round_q);
}

// The overlaps among candidates, one a pair of shapes; returns how many. `rest`: those of which neither
// moves, which are left out otherwise.
static uint32_t test_candidates(const plumb_world *world, const pl_buffer *candidates,
                                uint32_t candidate_count, bool rest, pl_buffer *overlaps)
{
    const pl_pieces *pieces = &world->pieces;
    const pl_keyed *c = candidates->data;
    pl_overlap *out = overlaps->data;
    uint32_t count = 0;
    for (uint32_t i = 0; i < candidate_count; ++i) {
        uint32_t sensor = c[i].order, other = c[i].value;
        bool known = count > 0 && out[count - 1].key == c[i].key;
        bool wanted = rest == (is_at_rest(world, sensor) && is_at_rest(world, other));
        if (!known && wanted && pieces_overlap(world, sensor, other)) {
            out[count++] =
                (pl_overlap){ c[i].key,
                              { .sensor = pieces->shape[sensor],
                                .shape = pieces->shape[other],
                                .sensor_body = world->bodies.entity[pieces->body[sensor]],
                                .body = world->bodies.entity[pieces->body[other]] } };
        }
    }
    return count;
}

static bool is_same(const pl_overlap *a, const pl_overlap *b)
{
    return plumb_same(a->who.sensor, b->who.sensor) && plumb_same(a->who.shape, b->who.shape);
}

// Two sorted lists read as one: of pairs that move, and of pairs at rest.
typedef struct cursor {
    const pl_overlap *at, *end, *rest, *rest_end;
} cursor;

static const pl_overlap *peek(const cursor *c)
{
    if (c->at == c->end || (c->rest < c->rest_end && c->rest->key < c->at->key)) {
        return c->rest < c->rest_end ? c->rest : NULL;
    }
    return c->at;
}

static void advance(cursor *c)
{
    if (peek(c) == c->at && c->at < c->end) {
        ++c->at;
    } else {
        ++c->rest;
    }
}

// Slots may have been taken anew, hence is_same.
static void compare(pl_sensing *s, cursor now, cursor old)
{
    plumb_sensor_event *begins = s->begins.data, *ends = s->ends.data;
    for (;;) {
        const pl_overlap *n = peek(&now), *o = peek(&old);
        if (n == NULL && o == NULL) {
            return;
        }
        bool takes_now = n != NULL && (o == NULL || n->key <= o->key);
        bool takes_old = o != NULL && (n == NULL || o->key <= n->key);
        bool goes_on = takes_now && takes_old && is_same(n, o);
        if (takes_now && !goes_on) {
            begins[s->begin_count++] = n->who;
        }
        if (takes_old && !goes_on) {
            ends[s->end_count++] = o->who;
        }
        if (takes_now) {
            advance(&now);
        }
        if (takes_old) {
            advance(&old);
        }
    }
}

static void exchange(pl_buffer *a, pl_buffer *b)
{
    pl_buffer kept = *a;
    *a = *b;
    *b = kept;
}

// No offset to a list that is not there.
static const pl_overlap *overlap_at(const pl_buffer *overlaps, uint32_t i)
{
    const pl_overlap *first = overlaps->data;
    return i > 0 ? first + i : first;
}

static cursor cursor_over(const pl_buffer *overlaps, uint32_t count, const pl_buffer *rest,
                          uint32_t rest_count)
{
    return (cursor){ overlap_at(overlaps, 0), overlap_at(overlaps, count), overlap_at(rest, 0),
                     overlap_at(rest, rest_count) };
}

// A fluid where something sleeps: it floats up.
static void wake_drowned(plumb_world *world)
{
    const pl_sensing *s = &world->sensing;
    const plumb_sensor_event *begins = s->begins.data;
    for (int i = 0; i < s->begin_count; ++i) {
        const uint32_t piece = pl_shape_piece(world, begins[i].sensor);
        const uint32_t row = pl_body_row(world, begins[i].body);
        if (pl_row_is_asleep(world, row) && world->materials.fluid[world->pieces.material[piece]]) {
            pl_sleep_disturb(world, row);
        }
    }
}

// Pairs at rest overlap as they did, unless something was laid to rest, or woke.
void pl_sensing_run(plumb_world *world)
{
    pl_sensing *s = &world->sensing;
    uint32_t rest_count = 0, rest_old_count = 0;
    exchange(&s->overlaps, &s->old);
    s->old_count = s->count;
    s->count = test_candidates(world, &s->candidates, s->candidate_count, false, &s->overlaps);
    world->schedule_dirty |= (s->count > 0) != (s->old_count > 0);
    if (s->rest_stale) {
        exchange(&s->rest_overlaps, &s->rest_old);
        rest_old_count = s->rest_count;
        rest_count = s->rest_count = test_candidates(
            world, &s->rest_candidates, s->rest_candidate_count, true, &s->rest_overlaps);
        s->rest_stale = false;
        world->schedule_dirty = true;
    }
    compare(s, cursor_over(&s->overlaps, s->count, &s->rest_overlaps, rest_count),
            cursor_over(&s->old, s->old_count, &s->rest_old, rest_old_count));
    wake_drowned(world);
}

//---- read ----------------------------------------------------------------------------------------

// Where the overlaps of a sensor begin.
static const pl_overlap *from_sensor(const pl_buffer *overlaps, uint32_t count, plumb_shape sensor)
{
    bool found;
    return overlap_at(overlaps, pl_find_key(overlaps->data, count, sizeof(pl_overlap),
                                            pl_key(sensor.entity.index, 0), &found));
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
    cursor all = { from_sensor(&s->overlaps, s->count, sensor), overlap_at(&s->overlaps, s->count),
                   from_sensor(&s->rest_overlaps, s->rest_count, sensor),
                   overlap_at(&s->rest_overlaps, s->rest_count) };
    int count = 0;
    for (const pl_overlap *at = peek(&all);
         at != NULL && (uint32_t)(at->key >> 32) == sensor.entity.index;
         advance(&all), at = peek(&all)) {
        // Since the step, either may have been destroyed.
        if (!plumb_same(at->who.sensor, sensor) ||
            pl_shape_piece(world, at->who.shape) == PL_NONE) {
            continue;
        }
        if (count < capacity) {
            shapes[count] = at->who.shape;
        }
        ++count;
    }
    return count;
}
