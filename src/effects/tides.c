// tides.c - what bodies feel of waves: where the surface is near each, the pressure of waves, how the water flows about it.
//
// The surface over a body's breadth is the line that fits it best; heights below are counted from there (Wheeler 1970), so that what rides on a wave
// is as deep in it as in still water. The pressure of waves on what is immersed (Froude and Krylov) is the integral of its
// gradient, mode by mode, exact over the outline; a body that takes water along is pushed by what that would be
// (Morison). Where the line cuts is the rest of the pressure, and buoyancy.
//
// Reads: modes in the middle of the step, immersions, poses. Writes: tides. Order: within "immersion". Cost: O(modes corners) a
// body in such a volume.
#include "effects/waves.h"

#include "core/sort.h"
#include "math/decay.h"
#include "math/trig.h"
#include "world/rows.h"

#include <math.h>

#define PI       3.141592653589793
#define SHALLOW  20.0 // [-] k depth of a wave that does not feel the bottom
#define STEEPEST 2.0  // [-] slope of a line

static bool is_volume_of(const pl_basin *basin, uint32_t piece)
{
    return basin->stands && basin->piece == piece;
}

static pl_complex wave_at(double angle)
{
    pl_complex e;
    pl_sincos(angle, &e.im, &e.re);
    return e;
}

// The mean of e^(iks) from x - w/2 to x + w/2, for k, 2k, 3k, ..., with t = k w / 2: sin t / t of its middle. Over i k the slope of
// the line that fits it best is 3 (sin t - t cos t) / t^3 of that.
typedef struct mode_means {
    double k, theta, slope;
    pl_complex middle, half, middle_now, half_now;
    int number;
} mode_means;

static mode_means means_open(double k, double x, double w)
{
    const pl_complex one = { 1, 0 };
    return (mode_means){ k, k * w / 2, 1, wave_at(k * x), wave_at(k * w / 2), one, one, 0 };
}

static pl_complex means_next(mode_means *m)
{
    m->middle_now = pl_times(m->middle_now, m->middle);
    m->half_now = pl_times(m->half_now, m->half);
    const double t = m->theta * ++m->number, s = m->half_now.im, c = m->half_now.re;
    const double mean = t < 0.02 ? 1 - t * t / 6 : s / t;
    m->slope = t < 0.02 ? 1 - t * t / 10 : 3 * (s - t * c) / (t * t * t);
    return (pl_complex){ mean * m->middle_now.re, mean * m->middle_now.im };
}

typedef struct line_sum {
    double height, slope, rate;
} line_sum;

static void add_line(const pl_wave_term *t, const mode_means *m, pl_complex mean, line_sum *out)
{
    const pl_complex middle = m->middle_now;
    out->height += t->height.re * mean.re + t->height.im * mean.im;
    out->slope += m->slope * t->k * (t->height.im * middle.re - t->height.re * middle.im);
    out->rate += t->rate.re * mean.re + t->rate.im * mean.im;
}

static double clamped(double v, double most)
{
    return v > most ? most : v < -most ? -most : v;
}

// The line that fits the surface best from x - w/2 to x + w/2, x from the left end.
static void fit(const plumb_world *world, const pl_basin *basin, const pl_wave_surface *surface,
                const plumb_wave_mode *modes, double x, double w, pl_tide *tide)
{
    mode_means m = means_open(PI / basin->width, x, w);
    line_sum sum = { 0 };
    for (int n = 0; n < surface->desc.modes; ++n) {
        const pl_complex mean = means_next(&m);
        const pl_wave_term t = { m.k * (n + 1), { modes[n].height, 0 }, { modes[n].rate, 0 } };
        add_line(&t, &m, mean, &sum);
    }
    if (surface->desc.swell > 0) {
        const pl_wave_term t =
            pl_swell_term(basin, &surface->desc, world->time + world->waves.step.dt / 2);
        mode_means swell = means_open(t.k, x, w);
        const pl_complex mean = means_next(&swell);
        add_line(&t, &swell, mean, &sum);
    }
    tide->at = basin->left + x;
    tide->height = clamped(sum.height, (double)surface->desc.height);
    tide->slope = clamped(sum.slope, STEEPEST);
    tide->rate = tide->height == sum.height ? sum.rate : 0;
}

// From where to where a piece is along x, from the left end of the surface.
static void breadth(const pl_contour *outline, double from, double *low, double *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    for (int i = 0; i < outline->count; ++i) {
        const pl_element *e = &outline->at[i];
        const double a = e->r > 0 ? e->cx - e->r : e->x, b = e->r > 0 ? e->cx + e->r : e->x;
        *low = a + from < *low ? a + from : *low;
        *high = b + from > *high ? b + from : *high;
    }
}

static pl_depths depths_of(const pl_basin *basin, const pl_tide *tide, const double away[2])
{
    const double line = basin->level + tide->height - tide->slope * (tide->at - basin->left);
    return (pl_depths){ .px = -away[0] - basin->left,
                        .py = -away[1] - basin->up * line,
                        .up = basin->up,
                        .slope = tide->slope,
                        .bottom = basin->depth };
}

static void sound(const pl_contour *outline, const pl_depths *where, double k, pl_soundings *out)
{
    out->shallow = k * where->bottom < SHALLOW;
    out->left = pl_decay_of(2 * k * where->bottom).left;
    out->power = 1;
    pl_harmonics_open(outline, where, false, k, &out->here);
    if (out->shallow) {
        pl_harmonics_open(outline, where, true, k, &out->mirrored);
    }
}

pl_spectrum pl_soundings_next(pl_soundings *s)
{
    const pl_harmonic none = { { 0, 0 }, { 0, 0 } };
    const pl_harmonic a = pl_harmonics_next(&s->here);
    const pl_harmonic b = s->shallow ? pl_harmonics_next(&s->mirrored) : none;
    s->power *= s->left;
    const double by = 1 / (1 + s->power), k = by * s->here.k * s->here.number;
    return (pl_spectrum){
        { by * (a.sum.re + b.sum.re), by * (a.sum.im + b.sum.im) },
        { by * (a.sum.re - b.sum.re), by * (a.sum.im - b.sum.im) },
        { k * (a.moment.re - b.moment.re), k * (a.moment.im - b.moment.im) },
    };
}

void pl_tide_sound(const plumb_world *world, const pl_tide *tide, pl_soundings *out, double away[2])
{
    static const double still[3] = { 0, 0, 0 };
    const pl_basin *basin = &pl_basins(world)[tide->basin];
    pl_volume volume;
    pl_contour contour;
    pl_fluid_volume(world, basin->piece, &volume);
    pl_fluid_contour(world, &volume, tide, tide->piece, still, world->waves.step.dt / 2, &contour,
                     away);
    const pl_depths where = depths_of(basin, tide, away);
    sound(&contour, &where, PI / basin->width, out);
}

// Adds the integrals of a wave's pressure gradient over rho g, with its torque, and of its flow.
static void add_push(const pl_basin *basin, const pl_wave_term *t, const pl_spectrum *p,
                     double push[3], double flow[2])
{
    const double by = 1 / pl_wave_tanh(basin, t->k);
    push[0] += t->k * (t->height.im * p->sum.re - t->height.re * p->sum.im);
    push[1] += t->k * (t->height.re * p->difference.re + t->height.im * p->difference.im);
    push[2] += t->height.re * p->turn.re + t->height.im * p->turn.im;
    flow[0] += by * (t->rate.im * p->sum.re - t->rate.re * p->sum.im);
    flow[1] += by * (t->rate.re * p->difference.re + t->rate.im * p->difference.im);
}

static void feel(const plumb_world *world, uint32_t number, const pl_volume *volume, pl_tide *tide,
                 pl_spectrum *spectrum)
{
    static const double still[3] = { 0, 0, 0 };
    const pl_basin *basin = &pl_basins(world)[number];
    const pl_wave_surface *surface = &pl_wave_surfaces(&world->waves)[number];
    const plumb_wave_mode *modes =
        (const plumb_wave_mode *)world->waves.step.midway.data + surface->first;
    const double half = world->waves.step.dt / 2;
    pl_volume open = *volume;
    pl_contour contour;
    double away[2], low, high;
    open.plane_count = 0;
    pl_fluid_contour(world, &open, NULL, tide->piece, still, 0, &contour, tide->away);
    breadth(&contour, -tide->away[0] - basin->left, &low, &high);
    low = low > 0 ? low : 0;
    high = high < basin->width ? high : basin->width;
    if (!(high > low)) {
        return;
    }
    tide->basin = number;
    fit(world, basin, surface, modes, (low + high) / 2, high - low, tide);
    pl_fluid_contour(world, volume, tide, tide->piece, still, half, &contour, away);
    const pl_depths where = depths_of(basin, tide, away);
    const double area = contour.count > 0 ? pl_contour_area(&contour).area : 0;
    double push[3] = { 0, 0, 0 }, flow[2] = { 0, 0 };
    const pl_waterline line =
        contour.count > 0 ? pl_contour_waterline(&contour, 0, basin->up) : (pl_waterline){ 0, 0 };
    mode_means m = means_open(PI / basin->width, (low + high) / 2, high - low);
    pl_soundings *s = world->waves.step.soundings.data;
    sound(&contour, &where, PI / basin->width, s);
    for (int n = 0; n < surface->desc.modes; ++n) {
        const pl_wave_term t = { PI / basin->width * (n + 1),
                                 { modes[n].height, 0 },
                                 { modes[n].rate, 0 } };
        spectrum[n] = pl_soundings_next(s);
        add_push(basin, &t, &spectrum[n], push, flow);
        const double rise =
            means_next(&m).re * line.width - (1 + basin->added) * t.k * spectrum[n].difference.re;
        tide->answer += rise * rise;
    }
    tide->answer *= line.width > 0 ? 2 / (basin->width * line.width) : 0;
    if (surface->desc.swell > 0) {
        const pl_wave_term t = pl_swell_term(basin, &surface->desc, world->time + half);
        sound(&contour, &where, t.k, s);
        const pl_spectrum p = pl_soundings_next(s);
        add_push(basin, &t, &p, push, flow);
    }
    if (area > 0) {
        const double weight = -basin->density * basin->gravity, by = weight * (1 + basin->added);
        tide->force[0] = by * push[0];
        tide->force[1] = by * basin->up * push[1];
        tide->force[2] = weight * basin->up * push[2];
        tide->flow[0] = flow[0] / area;
        tide->flow[1] = basin->up * flow[1] / area;
    }
}

bool pl_waves_feel(plumb_world *world)
{
    pl_waves *w = &world->waves;
    pl_waves_step *s = &w->step;
    const pl_effects *e = &world->effects;
    s->tide_count = 0;
    if (w->count == 0) {
        return true;
    }
    const pl_keyed *immersions = e->immersions.data, *stirrers = s->stirrers.data;
    const pl_volume *volumes = e->volumes.data;
    const uint32_t all = e->immersion_count + s->stirrer_count;
    size_t spectra = 0;
    for (uint32_t i = 0; i < w->count; ++i) {
        const size_t modes = (size_t)pl_wave_surfaces(w)[i].desc.modes;
        spectra = modes > spectra ? modes : spectra;
    }
    if (!pl_buffer_reserve(&world->memory, &s->tides, all * sizeof(pl_tide)) ||
        !pl_buffer_reserve(&world->memory, &s->order, all * sizeof(pl_keyed)) ||
        !pl_buffer_reserve(&world->memory, &s->spectra, all * spectra * sizeof(pl_spectrum))) {
        return false;
    }
    for (uint32_t i = 0; i < all; ++i) {
        const pl_keyed *who =
            i < e->immersion_count ? &immersions[i] : &stirrers[i - e->immersion_count];
        const pl_volume *volume = &volumes[who->order];
        pl_tide *tide = (pl_tide *)s->tides.data + i;
        *tide =
            (pl_tide){ .basin = PL_NONE, .piece = who->value, .spectrum = (uint32_t)(i * spectra) };
        ((pl_keyed *)s->order.data)[i] =
            (pl_keyed){ pl_key(who->value, volume->piece), who->value, i };
        for (uint32_t k = 0; k < w->count; ++k) {
            if (is_volume_of(&pl_basins(world)[k], volume->piece)) {
                feel(world, k, volume, tide, (pl_spectrum *)s->spectra.data + tide->spectrum);
            }
        }
    }
    pl_sort_keyed(s->order.data, all);
    s->tide_count = all;
    return true;
}
