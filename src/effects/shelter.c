// shelter.c - what stands behind what in a fluid that flows: shades (casts.c) of one piece are laid over one another, the deepest
// on top: a one-dimensional depth buffer.
//
// Reads: volumes, immersions, pieces, poses. Writes: shades. Order: behind immersions, before the substeps. Cost: that of casts,
// and O(n log n) for those of one piece.
#include "effects/casts.h"

#include "world/wrap.h"

#include <string.h>

//---- shades over one another ---------------------------------------------------------------------

// Places between the ends of all shades of a piece: taken ones lead to the next that is free.
static uint32_t next_free(uint32_t *next, uint32_t at)
{
    while (next[at] != at) {
        next[at] = next[next[at]];
        at = next[at];
    }
    return at;
}

static uint32_t place_of(const pl_keyed *ends, uint32_t count, double at)
{
    bool found;
    return pl_find_key(ends, count, sizeof *ends, pl_key_of_number(at), &found);
}

// Room for the ends, places and shares of n shades.
static size_t room_of(uint32_t n)
{
    return (size_t)(2 * n + 1) * (sizeof(pl_keyed) + 2 * sizeof(double) + sizeof(uint32_t));
}

static bool overlay(plumb_world *world, const pl_cast *casts, uint32_t n, pl_shadow *out)
{
    pl_shelter *e = world->effects.shelter;
    const uint32_t most = 2 * n;
    if (!pl_buffer_reserve(&world->memory, &e->blockers, room_of(n)) ||
        !pl_buffer_reserve(&world->memory, &e->shades,
                           (e->shade_count + most) * sizeof(pl_shade))) {
        return false;
    }
    pl_keyed *ends = e->blockers.data;
    double *share = (double *)(void *)(ends + most + 1), *place = share + most + 1;
    uint32_t *next = (uint32_t *)(void *)(place + most + 1);
    uint32_t count = 0;
    for (uint32_t i = 0; i < n; ++i) {
        ends[2 * i] = (pl_keyed){ pl_key_of_number(casts[i].low), 2 * i, 2 * i };
        ends[2 * i + 1] = (pl_keyed){ pl_key_of_number(casts[i].high), 2 * i + 1, 2 * i + 1 };
    }
    pl_sort_keyed(ends, most);
    for (uint32_t i = 0; i < most; ++i) {
        const pl_cast *of = &casts[ends[i].value / 2];
        if (count == 0 || ends[count - 1].key != ends[i].key) {
            place[count] = ends[i].value % 2 == 0 ? of->low : of->high;
            ends[count++] = ends[i];
        }
    }
    for (uint32_t i = 0; i <= count; ++i) {
        next[i] = i;
        share[i] = 0;
    }
    for (uint32_t i = 0; i < n; ++i) {
        const uint32_t last = place_of(ends, count, casts[i].high);
        uint32_t at = next_free(next, place_of(ends, count, casts[i].low));
        for (; at < last; at = next_free(next, at)) {
            share[at] = casts[i].share;
            next[at] = at + 1;
        }
    }
    pl_shade *shades = e->shades.data;
    out->first = e->shade_count;
    for (uint32_t i = 0; i + 1 < count; ++i) {
        pl_shade *before = e->shade_count > out->first ? &shades[e->shade_count - 1] : NULL;
        if (share[i] > 0 && before != NULL && before->high == place[i] &&
            before->share == share[i]) {
            before->high = place[i + 1];
        } else if (share[i] > 0) {
            shades[e->shade_count++] = (pl_shade){ place[i], place[i + 1], share[i] };
        }
    }
    out->count = e->shade_count - out->first;
    return true;
}

static bool overlay_all(plumb_world *world, uint32_t cast_count)
{
    pl_shelter *e = world->effects.shelter;
    const pl_cast *all = e->casts.data;
    pl_shadow *shadows = e->shadows.data;
    e->shade_count = 0;
    for (uint32_t first = 0, end; first < cast_count; first = end) {
        const uint32_t immersion = (uint32_t)(all[first].order >> 32);
        for (end = first; end < cast_count && all[end].order >> 32 == immersion;) {
            ++end;
        }
        if (!overlay(world, all + first, end - first, &shadows[immersion])) {
            return false;
        }
    }
    return true;
}

// Casts by immersion, the deepest first. False when out of memory.
static bool sort_casts(plumb_world *world, uint32_t count)
{
    pl_shelter *e = world->effects.shelter;
    if (!pl_buffer_reserve(&world->memory, &e->blockers,
                           count * (sizeof(pl_keyed) + sizeof(pl_cast)))) {
        return false;
    }
    pl_cast *copy = e->blockers.data, *all = e->casts.data;
    pl_keyed *order = (pl_keyed *)(void *)(copy + count);
    memcpy(copy, all, count * sizeof *copy);
    for (uint32_t i = 0; i < count; ++i) {
        order[i] = (pl_keyed){ copy[i].order, i, i };
    }
    pl_sort_keyed(order, count);
    for (uint32_t i = 0; i < count; ++i) {
        all[i] = copy[order[i].value];
    }
    return true;
}

//---- all volumes ---------------------------------------------------------------------------------

static bool shelters(const plumb_world *world, const pl_volume *volume)
{
    const pl_materials *m = &world->materials;
    const uint32_t row = volume->material;
    return m->shelter[row] > 0 && (m->flow_x[row] != 0 || m->flow_y[row] != 0) &&
           !pl_is_wrapped(world);
}

// Whether any does; makes what that takes. False when out of memory.
static bool open_shelter(plumb_world *world)
{
    pl_effects *e = &world->effects;
    const pl_volume *volumes = e->volumes.data;
    bool any = false;
    for (uint32_t i = 0; i < e->volume_count; ++i) {
        any |= shelters(world, &volumes[i]);
    }
    if (any && e->shelter == NULL) {
        e->shelter = pl_resize(&world->memory, NULL, 0, sizeof *e->shelter);
        if (e->shelter == NULL) {
            return false;
        }
        *e->shelter = (pl_shelter){ .shade_count = 0 };
    }
    if (e->shelter != NULL) {
        e->shelter->any = any;
    }
    return true;
}

bool pl_shelter_find(plumb_world *world)
{
    pl_effects *e = &world->effects;
    const pl_volume *volumes = e->volumes.data;
    uint32_t cast_count = 0;
    if (!open_shelter(world)) {
        return false;
    }
    if (e->shelter == NULL || !e->shelter->any) {
        return true;
    }
    const size_t bytes = e->immersion_count * sizeof(pl_shadow);
    if (!pl_buffer_reserve(&world->memory, &e->shelter->shadows, bytes)) {
        return false;
    }
    memset(e->shelter->shadows.data, 0, bytes);
    for (uint32_t i = 0; i < e->volume_count; ++i) {
        if (shelters(world, &volumes[i]) && !pl_cast_shades(world, i, &cast_count)) {
            return false;
        }
    }
    return cast_count == 0 || (sort_casts(world, cast_count) && overlay_all(world, cast_count));
}
