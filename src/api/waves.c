// waves.c - waves of water: given to a shape, changed, asked.
//
// Reads: arguments. Writes: the list of surfaces, their modes. Cost: O(modes) to ask for a place.
#include "plumb/waves.h"

#include "effects/waves.h"
#include "schema/effects.h"
#include "world/check.h"
#include "world/island.h"
#include "world/rows.h"
#include "world/waves_list.h"
#include "world/wrap.h"

#include <math.h>
#include <string.h>

#define MODES_DEFAULT   64
#define DAMPING_DEFAULT PLUMB_REAL(0.1)
#define MOST            1e6

//---- checks --------------------------------------------------------------------------------------

// What a surface with these settings is; the defaults of the rest need how it lies.
static plumb_waves_desc resolved(const plumb_waves_desc *d, const pl_basin *basin)
{
    plumb_waves_desc out;
    memset(&out, 0, sizeof out); // padding, too: it is saved
    const real quarter = (real)(basin->depth / 4), half = (real)(basin->width / 2);
    out.modes = d->modes != 0 ? d->modes : MODES_DEFAULT;
    out.damping = d->no_damping ? 0 : d->damping != 0 ? d->damping : DAMPING_DEFAULT;
    out.no_damping = d->no_damping;
    out.height = d->height != 0 ? d->height : quarter;
    out.swell = d->swell;
    out.swell_length = d->swell_length != 0 ? d->swell_length : half;
    return out;
}

static plumb_result check_desc(const plumb_world *world, const char *fn, const plumb_waves_desc *d)
{
    if (d->modes < 0 || d->modes > PLUMB_WAVES_MAX_MODES) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "modes is %d; it must be 1 to %d, or 0", d->modes,
                       PLUMB_WAVES_MAX_MODES);
    }
    PL_TRY(pl_check_range(world, fn, "damping", d->damping, 0, 1000));
    if (d->no_damping && d->damping != 0) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "damping is %g; it must be 0 with no_damping",
                       (double)d->damping);
    }
    PL_TRY(pl_check_range(world, fn, "height", d->height, 0, PL_WAVES_FAR));
    PL_TRY(pl_check_range(world, fn, "swell", d->swell, 0, 1000));
    PL_TRY(pl_check_range(world, fn, "swell_length", d->swell_length, -PL_WAVES_FAR, PL_WAVES_FAR));
    return PLUMB_OK;
}

// Of settings with their defaults: a very small box makes some too small.
static plumb_result check_resolved(const plumb_world *world, const char *fn,
                                   const plumb_waves_desc *d)
{
    PL_TRY(pl_check_range(world, fn, "height", d->height, PL_WAVES_LEAST, PL_WAVES_FAR));
    return pl_check_range(world, fn, "swell_length",
                          d->swell_length < 0 ? -d->swell_length : d->swell_length, PL_WAVES_LEAST,
                          PL_WAVES_FAR);
}

static plumb_result check_waves(const plumb_world *world, const char *fn, plumb_shape shape,
                                pl_wave_surface **surface)
{
    uint32_t first;
    PL_TRY(pl_check_shape(world, fn, shape, &first));
    *surface = pl_waves_of(world, shape);
    return *surface != NULL ? PLUMB_OK
                            : pl_fail(world, PLUMB_E_STATE, fn,
                                      "the shape has no waves; they must be made with "
                                      "plumb_waves_create");
}

// Why a shape cannot have waves; NULL: it can.
static const char *unfit(const plumb_world *world, uint32_t first, const pl_basin *basin)
{
    const pl_pieces *p = &world->pieces;
    const uint32_t of = p->material[first], row = p->body[first];
    return (p->flags[first] & PL_PIECE_SENSOR) == 0            ? "it is no sensor"
           : p->next_in_shape[first] != PL_NONE                ? "it has several convex pieces"
           : !world->materials.fluid[of]                       ? "its material is no fluid"
           : world->materials.weightless[of]                   ? "its fluid is weightless"
           : world->bodies.type[row] != PLUMB_STATIC           ? "its body is not static"
           : world->gravity.x != 0 || world->gravity.y == 0    ? "gravity is not along y"
           : p->core[first].radius != 0 || !(basin->depth > 0) ? "it is no polygon, or rounded"
           : !basin->stands ? "it has no level upper side, or its body is disabled"
                            : NULL;
}

//---- made, changed -------------------------------------------------------------------------------

// What no descriptor at all means.
static const plumb_waves_desc defaults = { 0 };

plumb_result plumb_waves_create(plumb_world *world, plumb_shape shape, const plumb_waves_desc *desc)
{
    uint32_t first;
    PL_TRY(pl_check_shape(world, __func__, shape, &first));
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(PL_CHECK_HAS(world, __func__, "waves", WAVES, "waves"));
    desc = desc == NULL ? &defaults : desc;
    if (pl_waves_of(world, shape) != NULL) {
        return pl_fail(world, PLUMB_E_STATE, __func__, "the shape has waves; it must have none");
    }
    if (pl_is_wrapped(world)) {
        return pl_fail(world, PLUMB_E_STATE, __func__,
                       "the world wraps around; one with waves must not");
    }
    PL_TRY(check_desc(world, __func__, desc));
    pl_wave_surface made;
    memset(&made, 0, sizeof made);
    made.shape = shape;
    const pl_basin basin = pl_basin_of(world, &made);
    const char *why = unfit(world, first, &basin);
    if (why != NULL) {
        return pl_fail(world, PLUMB_E_STATE, __func__, "the shape can have no waves: %s", why);
    }
    const plumb_waves_desc full = resolved(desc, &basin);
    PL_TRY(check_resolved(world, __func__, &full));
    if (!pl_waves_reserve(world, 1, (uint32_t)full.modes)) {
        return pl_fail_memory(world, __func__);
    }
    pl_waves *w = &world->waves;
    made.first = w->mode_count;
    memcpy(&made.desc, &full, sizeof full);
    made.desc.modes = 0;
    pl_wave_surface *surface = &pl_wave_surfaces(w)[w->count++];
    memcpy(surface, &made, sizeof made);
    pl_waves_resize(world, surface, full.modes);
    pl_waves_refile(world, shape, true);
    return PLUMB_OK;
}

plumb_result plumb_waves_destroy(plumb_world *world, plumb_shape shape)
{
    pl_wave_surface *surface;
    PL_TRY(check_waves(world, __func__, shape, &surface));
    PL_TRY(pl_check_unlocked(world, __func__));
    pl_waves_forget(world, shape);
    return PLUMB_OK;
}

plumb_result plumb_waves_settings(const plumb_world *world, plumb_shape shape,
                                  plumb_waves_desc *desc)
{
    pl_wave_surface *surface;
    PL_TRY(check_waves(world, __func__, shape, &surface));
    PL_TRY(pl_check_pointer(world, __func__, "desc", desc));
    *desc = surface->desc;
    return PLUMB_OK;
}

plumb_result plumb_waves_set(plumb_world *world, plumb_shape shape, const plumb_waves_desc *desc)
{
    pl_wave_surface *surface;
    PL_TRY(check_waves(world, __func__, shape, &surface));
    PL_TRY(pl_check_unlocked(world, __func__));
    desc = desc == NULL ? &defaults : desc;
    PL_TRY(check_desc(world, __func__, desc));
    const pl_basin basin = pl_basin_of(world, surface);
    const plumb_waves_desc full = resolved(desc, &basin);
    PL_TRY(check_resolved(world, __func__, &full));
    if (!pl_waves_reserve(world, 0, (uint32_t)full.modes)) {
        return pl_fail_memory(world, __func__);
    }
    pl_waves_resize(world, surface, full.modes);
    memcpy(&surface->desc, &full, sizeof full);
    pl_waves_refile(world, shape, true);
    return PLUMB_OK;
}

plumb_result plumb_waves_set_modes(plumb_world *world, plumb_shape shape,
                                   const plumb_wave_mode *modes, int count)
{
    pl_wave_surface *surface;
    PL_TRY(check_waves(world, __func__, shape, &surface));
    PL_TRY(pl_check_unlocked(world, __func__));
    if (count < 0 || count > surface->desc.modes) {
        return pl_fail(world, PLUMB_E_RANGE, __func__, "count is %d; it must be 0 to %d", count,
                       surface->desc.modes);
    }
    PL_TRY(count == 0 ? PLUMB_OK : pl_check_pointer(world, __func__, "modes", modes));
    for (int i = 0; i < count; ++i) {
        const double values[2] = { modes[i].height, modes[i].rate };
        for (int k = 0; k < 2; ++k) {
            if (values[k] - values[k] != 0) {
                return pl_fail(world, PLUMB_E_NOT_FINITE, __func__, "modes[%d] is not finite", i);
            }
            if (fabs(values[k]) > MOST) {
                return pl_fail(world, PLUMB_E_RANGE, __func__,
                               "modes[%d] has %g; it must be -1e6 to 1e6", i, values[k]);
            }
        }
    }
    plumb_wave_mode *to = pl_wave_modes(&world->waves) + surface->first;
    for (int i = 0; i < surface->desc.modes; ++i) {
        to[i] = i < count ? modes[i] : (plumb_wave_mode){ 0, 0 };
    }
    pl_sleep_wake_swimmers(world, pl_shape_piece(world, shape));
    return PLUMB_OK;
}

//---- asked ---------------------------------------------------------------------------------------

const plumb_wave_mode *plumb_waves_modes(const plumb_world *world, plumb_shape shape, int *count)
{
    const pl_wave_surface *surface = world != NULL ? pl_waves_of(world, shape) : NULL;
    if (count != NULL) {
        *count = surface != NULL ? surface->desc.modes : 0;
    }
    return surface != NULL ? pl_wave_modes(&world->waves) + surface->first : NULL;
}

plumb_wave_sample plumb_waves_at(const plumb_world *world, plumb_shape shape, plumb_real x)
{
    const pl_wave_surface *surface = world != NULL ? pl_waves_of(world, shape) : NULL;
    plumb_wave_sample out = { 0, 0, 0, 0 };
    if (surface == NULL || x - x != 0) {
        return out;
    }
    const pl_basin b = pl_basin_of(world, surface);
    const uint32_t row = world->pieces.body[b.piece];
    const double from = (double)x - (double)world->bodies.center_x[row] - b.left;
    double wave[3] = { 0, 0, 0 };
    if (b.stands && from >= 0 && from <= b.width) {
        pl_waves_sample(&b, surface, pl_wave_modes(&world->waves) + surface->first, world->time,
                        from, wave);
    }
    out.y = (real)((double)world->bodies.center_y[row] + b.up * (b.level + wave[0]));
    out.height = (real)wave[0];
    out.slope = (real)wave[1];
    out.rate = (real)wave[2];
    return out;
}

double plumb_waves_energy(const plumb_world *world, plumb_shape shape)
{
    const pl_wave_surface *surface = world != NULL ? pl_waves_of(world, shape) : NULL;
    double sum = 0;
    if (surface == NULL) {
        return 0;
    }
    const pl_basin b = pl_basin_of(world, surface);
    const plumb_wave_mode *modes = pl_wave_modes(&world->waves) + surface->first;
    for (int n = 0; n < surface->desc.modes && b.stands; ++n) {
        const double omega = pl_wave_omega(&b, 3.141592653589793 / b.width * (n + 1));
        const double rate = modes[n].rate / omega;
        sum += modes[n].height * modes[n].height + rate * rate;
    }
    return b.density * b.gravity * b.width / 4 * sum;
}

int plumb_world_waves(const plumb_world *world, plumb_shape *shapes, int capacity)
{
    const int count = world != NULL ? (int)world->waves.count : 0;
    for (int i = 0; i < count && i < capacity && shapes != NULL; ++i) {
        shapes[i] = pl_wave_surfaces(&world->waves)[i].shape;
    }
    return count;
}
