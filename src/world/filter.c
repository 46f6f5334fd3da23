// filter.c - which shapes may meet: filters, excluded pairs of bodies, and what is a sensor.
//
// A pair that may not meet is never made: the rules are asked when pairs are found (pair_find.c),
// so a change makes the pair list anew. Counters of the world tell whether any rule is there to
// ask.
//
// Excluded pairs are a sorted array of keys, made of the registry slots of two bodies; a flag of
// the body tells whether it is worth looking. Reads: pieces, body entities. Writes: filter columns,
// flags, counters, the table. Cost: O(1) a pair, O(log table) where both bodies have the flag.
#include "world/filter.h"

#include "core/sort.h"
#include "world/check.h"
#include "world/island.h"
#include "world/rows.h"
#include "world/stale_edges.h"

#include <string.h>

//---- filters -------------------------------------------------------------------------------------

plumb_result pl_filter_check(const plumb_world *world, const char *function,
                             const plumb_filter *filter)
{
    if (!filter->nothing || filter->mask == 0) {
        return PLUMB_OK;
    }
    return pl_fail(world, PLUMB_E_RANGE, function,
                   "filter.mask is 0x%llx; it must be 0 with nothing",
                   (unsigned long long)filter->mask);
}

// Zeros replaced by what they mean; a mask of 0 then means no category.
static plumb_filter resolved(plumb_filter f)
{
    f.category = f.category != 0 ? f.category : 1;
    f.mask = f.nothing ? 0 : f.mask != 0 ? f.mask : UINT64_MAX;
    return f;
}

static bool is_default(const plumb_filter *f)
{
    return f->category == 1 && f->mask == UINT64_MAX && f->group == 0;
}

// `f` and `g` resolved.
static inline bool meet(uint64_t f_category, uint64_t f_mask, int32_t f_group, uint64_t g_category,
                        uint64_t g_mask, int32_t g_group)
{
    if (f_group == g_group && f_group != 0) {
        return f_group > 0;
    }
    return (f_mask & g_category) != 0 && (g_mask & f_category) != 0;
}

bool plumb_filters_meet(plumb_filter a, plumb_filter b)
{
    a = resolved(a);
    b = resolved(b);
    return meet(a.category, a.mask, a.group, b.category, b.mask, b.group);
}

void pl_piece_flag(plumb_world *world, uint32_t piece, uint8_t flag, bool on, uint32_t *counter)
{
    uint8_t *flags = &world->pieces.flags[piece];
    *counter += (on ? 1u : 0u) - ((*flags & flag) != 0 ? 1u : 0u);
    *flags = (uint8_t)(on ? *flags | flag : *flags & (uint8_t)~flag);
}

void pl_filter_apply(plumb_world *world, uint32_t first, const plumb_filter *filter)
{
    pl_pieces *pieces = &world->pieces;
    plumb_filter f = resolved(*filter);
    for (uint32_t p = first; p != PL_NONE; p = pieces->next_in_shape[p]) {
        pieces->category[p] = f.category;
        pieces->mask[p] = f.mask;
        pieces->group[p] = f.group;
        pl_piece_flag(world, p, PL_PIECE_FILTERED, !is_default(&f), &world->filtered_pieces);
    }
}

plumb_filter plumb_shape_filter(const plumb_world *world, plumb_shape shape)
{
    uint32_t p = pl_ask_shape(world, __func__, shape);
    if (p == PL_NONE) {
        return (plumb_filter){ 0 };
    }
    const pl_pieces *pieces = &world->pieces;
    return (plumb_filter){ pieces->category[p], pieces->mask[p], pieces->group[p],
                           pieces->mask[p] == 0 };
}

plumb_result plumb_shape_set_filter(plumb_world *world, plumb_shape shape, plumb_filter filter)
{
    uint32_t first;
    PL_TRY(pl_check_shape(world, __func__, shape, &first));
    PL_TRY(pl_filter_check(world, __func__, &filter));
    const plumb_filter was = plumb_shape_filter(world, shape), wanted = resolved(filter);
    if (wanted.category == was.category && wanted.mask == was.mask && wanted.group == was.group) {
        return PLUMB_OK;
    }
    for (uint32_t p = first; p != PL_NONE; p = world->pieces.next_in_shape[p]) {
        pl_sleep_see_anew(world, p);
    }
    pl_filter_apply(world, first, &filter);
    pl_internal_edges_touch_shape(world, first);
    pl_rearranged(world);
    return PLUMB_OK;
}

bool pl_pieces_meet(const plumb_world *world, uint32_t p, uint32_t q)
{
    const pl_pieces *s = &world->pieces;
    return meet(s->category[p], s->mask[p], s->group[p], s->category[q], s->mask[q], s->group[q]) &&
           !pl_rows_excluded(world, s->body[p], s->body[q]);
}

//---- sensors -------------------------------------------------------------------------------------

void pl_sensor_apply(plumb_world *world, uint32_t first, bool sensor)
{
    pl_pieces *pieces = &world->pieces;
    for (uint32_t p = first; p != PL_NONE; p = pieces->next_in_shape[p]) {
        pl_piece_flag(world, p, PL_PIECE_SENSOR, sensor, &world->sensor_pieces);
        pieces->density[p] = pl_density_of(world, p);
    }
}

bool plumb_shape_is_sensor(const plumb_world *world, plumb_shape shape)
{
    uint32_t p = pl_ask_shape(world, __func__, shape);
    return p != PL_NONE && (world->pieces.flags[p] & PL_PIECE_SENSOR) != 0;
}

plumb_result plumb_shape_set_sensor(plumb_world *world, plumb_shape shape, bool sensor)
{
    uint32_t first;
    PL_TRY(pl_check_shape(world, __func__, shape, &first));
    PL_TRY(pl_check_unlocked(world, __func__));
    if (sensor) {
        PL_TRY(PL_CHECK_HAS(world, __func__, "a sensor", SENSORS, "sensors"));
    }
    if (sensor != plumb_shape_is_sensor(world, shape)) {
        for (uint32_t p = first; p != PL_NONE; p = world->pieces.next_in_shape[p]) {
            pl_sleep_see_anew(world, p);
        }
        pl_sensor_apply(world, first, sensor);
        pl_mass_revise(world, world->pieces.body[first]);
        pl_internal_edges_touch_shape(world, first);
        pl_rearranged(world);
        world->schedule_dirty = true;
    }
    return PLUMB_OK;
}

//---- excluded pairs ------------------------------------------------------------------------------

static uint64_t key_of(plumb_body a, plumb_body b)
{
    return pl_pair_key(a.entity.index, b.entity.index);
}

static uint32_t find(const plumb_world *world, uint64_t key, bool *found)
{
    return pl_find_key(world->excluded.data, world->excluded_count, sizeof key, key, found);
}

bool pl_rows_excluded(const plumb_world *world, uint32_t row_a, uint32_t row_b)
{
    const pl_bodies *b = &world->bodies;
    if ((b->flags[row_a] & b->flags[row_b] & PL_BODY_EXCLUDING) == 0) {
        return false;
    }
    bool found;
    find(world, key_of(b->entity[row_a], b->entity[row_b]), &found);
    return found;
}

void pl_exclusions_forget(plumb_world *world, uint32_t row)
{
    if ((world->bodies.flags[row] & PL_BODY_EXCLUDING) == 0) {
        return;
    }
    uint32_t slot = world->bodies.entity[row].entity.index;
    uint64_t *keys = world->excluded.data;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < world->excluded_count; ++i) {
        if ((uint32_t)(keys[i] >> 32) != slot && (uint32_t)keys[i] != slot) {
            keys[kept++] = keys[i];
        }
    }
    world->excluded_count = kept;
}

static plumb_result insert(plumb_world *world, const char *function, uint64_t key, uint32_t at)
{
    size_t bytes = ((size_t)world->excluded_count + 1) * sizeof key;
    if (!pl_buffer_reserve(&world->memory, &world->excluded, bytes)) {
        return pl_fail_memory(world, function);
    }
    uint64_t *keys = world->excluded.data;
    memmove(keys + at + 1, keys + at, (world->excluded_count - at) * sizeof key);
    keys[at] = key;
    ++world->excluded_count;
    return PLUMB_OK;
}

static plumb_result check_two(const plumb_world *world, const char *function, plumb_body a,
                              plumb_body b, uint32_t *row_a, uint32_t *row_b)
{
    *row_a = pl_body_row(world, a);
    *row_b = pl_body_row(world, b);
    if (*row_a == PL_NONE) {
        return pl_fail_handle(world, function, "a", a.entity, "a live body");
    }
    if (*row_b == PL_NONE) {
        return pl_fail_handle(world, function, "b", b.entity, "a live body");
    }
    return *row_a != *row_b ? PLUMB_OK
                            : pl_fail(world, PLUMB_E_RANGE, function,
                                      "b is the same body as a; it must be another");
}

plumb_result plumb_world_exclude_pair(plumb_world *world, plumb_body a, plumb_body b, bool exclude)
{
    PL_TRY(pl_check_world(world));
    uint32_t row_a, row_b;
    PL_TRY(check_two(world, __func__, a, b, &row_a, &row_b));
    bool found;
    uint64_t key = key_of(a, b);
    uint32_t at = find(world, key, &found);
    if (found == exclude) {
        return PLUMB_OK;
    }
    if (exclude) {
        PL_TRY(insert(world, __func__, key, at));
        world->bodies.flags[row_a] |= PL_BODY_EXCLUDING;
        world->bodies.flags[row_b] |= PL_BODY_EXCLUDING;
        pl_internal_edges_touch_static(world, row_a);
        pl_internal_edges_touch_static(world, row_b);
    } else {
        uint64_t *keys = world->excluded.data;
        --world->excluded_count;
        memmove(keys + at, keys + at + 1, (world->excluded_count - at) * sizeof key);
    }
    pl_sleep_disturb(world, row_a);
    pl_sleep_disturb(world, row_b);
    pl_rearranged(world);
    return PLUMB_OK;
}

bool plumb_world_is_excluded(const plumb_world *world, plumb_body a, plumb_body b)
{
    uint32_t row_a = pl_ask_body(world, __func__, a);
    uint32_t row_b = row_a == PL_NONE ? PL_NONE : pl_ask_body(world, __func__, b);
    return row_b != PL_NONE && pl_rows_excluded(world, row_a, row_b);
}

bool pl_one_way_blocks(const plumb_world *world, uint32_t piece, plumb_vec2 out, real separation)
{
    const pl_pieces *p = &world->pieces;
    const pl_pose *pose = &pl_poses(world)[p->body[piece]];
    plumb_vec2 d = plumb_rot_apply((plumb_rot){ pose->c, pose->s },
                                   plumb_v2(p->one_way_x[piece], p->one_way_y[piece]));
    return separation >= -PL_ONE_WAY_FOUND && (out.x != 0 || out.y != 0) &&
           plumb_vec2_dot(out, d) >= p->one_way_cos[piece];
}
