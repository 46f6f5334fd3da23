// waves_list.c - see waves_list.h.
//
// Reads, writes: the list, flags of pieces. Cost: O(surfaces + modes).
#include "world/waves_list.h"

#include "world/island.h"
#include "world/rows.h"
#include "world/stale_edges.h"

#include <string.h>

pl_wave_surface *pl_waves_of(const plumb_world *world, plumb_shape shape)
{
    pl_wave_surface *all = pl_wave_surfaces(&world->waves);
    for (uint32_t i = 0; i < world->waves.count; ++i) {
        if (plumb_same(all[i].shape, shape)) {
            return &all[i];
        }
    }
    return NULL;
}

real pl_waves_reach(const plumb_world *world, uint32_t piece)
{
    const pl_wave_surface *surface = pl_waves_of(world, world->pieces.shape[piece]);
    return surface == NULL ? 0 : surface->desc.height;
}

bool pl_waves_reserve(plumb_world *world, uint32_t surfaces, uint32_t modes)
{
    pl_waves *w = &world->waves;
    return pl_buffer_reserve(&world->memory, &w->items,
                             (w->count + surfaces) * sizeof(pl_wave_surface)) &&
           pl_buffer_reserve(&world->memory, &w->modes,
                             (w->mode_count + modes) * sizeof(plumb_wave_mode));
}

void pl_waves_resize(plumb_world *world, pl_wave_surface *surface, int modes)
{
    pl_waves *w = &world->waves;
    pl_wave_surface *all = pl_wave_surfaces(w);
    const uint32_t now = (uint32_t)modes, before = (uint32_t)surface->desc.modes;
    const uint32_t end = surface->first + before;
    plumb_wave_mode *at = pl_wave_modes(w) + surface->first;
    memmove(at + now, at + before, (w->mode_count - end) * sizeof *at);
    for (uint32_t i = before; i < now; ++i) {
        at[i] = (plumb_wave_mode){ 0, 0 };
    }
    w->mode_count += now - before;
    for (uint32_t i = 0; i < w->count; ++i) {
        all[i].first += all[i].first >= end && &all[i] != surface ? now - before : 0;
    }
    surface->desc.modes = modes;
}

void pl_waves_refile(plumb_world *world, plumb_shape shape, bool on)
{
    for (uint32_t p = pl_shape_piece(world, shape); p != PL_NONE;
         p = world->pieces.next_in_shape[p]) {
        uint8_t *flags = &world->pieces.flags[p];
        *flags = (uint8_t)(on ? *flags | PL_PIECE_WAVES : *flags & ~PL_PIECE_WAVES);
        if (pl_piece_is_static(world, p)) {
            pl_piece_lose_box(world, p);
        }
        pl_sleep_wake_swimmers(world, p);
    }
    world->static_dirty = true;
    world->schedule_dirty = true;
    pl_rearranged(world);
}

void pl_waves_forget(plumb_world *world, plumb_shape shape)
{
    pl_waves *w = &world->waves;
    pl_wave_surface *surface = w->count > 0 ? pl_waves_of(world, shape) : NULL;
    if (surface == NULL) {
        return;
    }
    pl_waves_resize(world, surface, 0);
    const uint32_t behind = (uint32_t)(&pl_wave_surfaces(w)[w->count--] - surface) - 1;
    memmove(surface, surface + 1, behind * sizeof *surface);
    pl_waves_refile(world, shape, false);
}

static bool is_between(real v, real low, real high)
{
    return v >= low && v <= high;
}

bool pl_waves_desc_is_sound(const plumb_waves_desc *d)
{
    return d->modes >= 1 && d->modes <= PLUMB_WAVES_MAX_MODES &&
           *(const uint8_t *)&d->no_damping <= 1 && is_between(d->damping, 0, 1000) &&
           is_between(d->height, PL_WAVES_LEAST, PL_WAVES_FAR) && is_between(d->swell, 0, 1000) &&
           is_between(plumb_abs(d->swell_length), PL_WAVES_LEAST, PL_WAVES_FAR);
}
