// waves.c - standing waves of a volume of water: how the surface lies, its modes in time, what bodies did to it.
//
// Linear waves: with phi = sum phi_n cos(k x) cosh(k (z + H)) / cosh(k H), k = n pi / width, height and potential of a
// mode swing at omega^2 = g k tanh(k H) (Lamb, Hydrodynamics, 228); a mode is kept as height and rate and turned exactly, half a step before bodies
// act and half a step behind it. Bodies push water aside: with psi the mode's function of place, Green's identity gives
//     d height / dt = rate + 2 / width d s / dt,   s = integral of psi over what is immersed,
// exact for a body that is small beside the wave and for a long wave under any: a heaving one of breadth B sends out
// waves of k B times its own amplitude (Ursell 1949). Water that goes along with a body is not pushed aside: from that of the
// body's way goes the dipole of the water's, and what the fluid lends the body adds to both (Batchelor, 6.4). The force on the body is
// the same function's derivative (tides.c), so that waves get what the body loses. Mode 0, the mean level, is left out. Steeper
// than k a = 0.44 waves break (Stokes).
//
// Reads: pieces, poses, tides. Writes: modes. Order: "waves" before "immersion"; "wave motion" behind all that
// moves bodies. Cost: O(modes) a surface; O(modes corners) a tide.
#include "effects/waves.h"

#include "core/sort.h"
#include "math/decay.h"
#include "math/trig.h"
#include "schema/passes.h"
#include "world/island.h"
#include "world/rows.h"
#include "world/waves_list.h"

#include <math.h>
#include <string.h>

#define TURN     6.283185307179586
#define PI       3.141592653589793
#define STEEPEST 0.44 // [-] k a of a wave that breaks
#define LEVEL    5e-7 // [-] 1 - cosine of the slope that an upper side may have
#define FLUNG    PL_WAVES_MOST
#define LIVELY   0.25 // [-] of sleep_speed

bool pl_want_waves(const plumb_world *world, const char **reason)
{
    *reason = world->waves.count > 0 ? "some water has waves" : "no water has waves";
    return world->waves.count > 0;
}

void pl_waves_free(pl_memory *memory, pl_waves *w)
{
    pl_buffer *buffers[] = { &w->items,         &w->modes,        &w->step.basins,
                             &w->step.midway,   &w->step.tides,   &w->step.order,
                             &w->step.stirrers, &w->step.spectra, &w->step.soundings,
                             &w->step.swings };
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; ++i) {
        pl_buffer_free(memory, buffers[i]);
    }
    *w = (pl_waves){ 0 };
}

//---- how it lies ---------------------------------------------------------------------------------

// Ends and depth below the upper side of a convex polygon, from the centre of its body.
static void measure(const plumb_convex *shape, plumb_transform frame, pl_basin *b)
{
    double high = -INFINITY, low = INFINITY, right = -INFINITY, area = 0;
    plumb_vec2 p[PLUMB_POLYGON_MAX_VERTICES];
    for (int i = 0; i < shape->count; ++i) {
        p[i] = plumb_transform_apply(frame, shape->points[i]);
        const double z = b->up * (double)p[i].y;
        high = z > high ? z : high;
        low = z < low ? z : low;
    }
    b->left = INFINITY;
    for (int i = 0; i < shape->count; ++i) {
        const plumb_vec2 q = p[i + 1 < shape->count ? i + 1 : 0];
        const double x = (double)p[i].x;
        area += (x * (double)q.y - (double)q.x * (double)p[i].y) / 2;
        if (b->up * (double)p[i].y >= high - 1e-3 * (high - low)) {
            b->left = x < b->left ? x : b->left;
            right = x > right ? x : right;
        }
    }
    b->level = high;
    b->width = right - b->left;
    b->depth = b->width > 0 ? area / b->width : 0;
}

pl_basin pl_basin_of(const plumb_world *world, const pl_wave_surface *surface)
{
    const pl_bodies *bodies = &world->bodies;
    const pl_materials *m = &world->materials;
    const uint32_t piece = pl_shape_piece(world, surface->shape);
    const uint32_t row = world->pieces.body[piece], of = world->pieces.material[piece];
    pl_basin b = { .piece = piece,
                   .up = world->gravity.y < 0 ? 1 : -1,
                   .gravity = fabs((double)world->gravity.y),
                   .density = (double)m->density[of],
                   .added = m->added_mass[of] < 1 ? (double)m->added_mass[of] : 1 };
    plumb_convex shape;
    pl_piece_convex(world, piece, &shape);
    const plumb_rot q = { bodies->c[row], bodies->s[row] };
    const plumb_vec2 local = { bodies->local_x[row], bodies->local_y[row] };
    const plumb_vec2 arm = plumb_rot_apply(q, local);
    const plumb_transform frame = { { -arm.x, -arm.y }, q };
    bool level = false;
    for (int i = 0; i < shape.count; ++i) {
        level |= b.up * (double)plumb_rot_apply(q, shape.normals[i]).y > 1 - LEVEL;
    }
    measure(&shape, frame, &b);
    b.stands = level && shape.radius == 0 && shape.count > 2 && b.width > 0 && b.depth > 0 &&
               world->gravity.x == 0 && b.gravity > 0 && m->fluid[of] && !m->weightless[of] &&
               bodies->type[row] == PLUMB_STATIC && (bodies->flags[row] & PL_BODY_DISABLED) == 0 &&
               (world->pieces.flags[piece] & PL_PIECE_SENSOR) != 0;
    return b;
}

double pl_wave_tanh(const pl_basin *basin, double k)
{
    const double left = pl_decay_of(2 * k * basin->depth).left;
    return (1 - left) / (1 + left);
}

double pl_wave_omega(const pl_basin *basin, double k)
{
    return sqrt(basin->gravity * k * pl_wave_tanh(basin, k));
}

pl_wave_term pl_swell_term(const pl_basin *basin, const plumb_waves_desc *desc, double time)
{
    const double length = (double)desc->swell_length, k = TURN / fabs(length);
    const double omega = pl_wave_omega(basin, k), side = length < 0 ? -1 : 1;
    double turns = omega * time / TURN, s, c;
    turns -= floor(turns);
    pl_sincos(TURN * turns, &s, &c);
    const double a = (double)desc->swell;
    return (pl_wave_term){ k, { a * c, side * a * s }, { -omega * a * s, side * omega * a * c } };
}

//---- at a place ----------------------------------------------------------------------------------

// Sums Re(conj(c) E), Re(conj(c) i k E) and Re(conj(rate) E) at E = e^(ikx).
static void add_term(const pl_wave_term *t, pl_complex e, double out[3])
{
    out[0] += t->height.re * e.re + t->height.im * e.im;
    out[1] += t->k * (t->height.im * e.re - t->height.re * e.im);
    out[2] += t->rate.re * e.re + t->rate.im * e.im;
}

static pl_complex wave_at(double k, double x)
{
    pl_complex e;
    pl_sincos(k * x, &e.im, &e.re);
    return e;
}

void pl_waves_sample(const pl_basin *basin, const pl_wave_surface *surface,
                     const plumb_wave_mode *modes, double time, double x, double out[3])
{
    const double k = PI / basin->width;
    const pl_complex base = wave_at(k, x);
    pl_complex e = base;
    out[0] = out[1] = out[2] = 0;
    for (int n = 0; n < surface->desc.modes; ++n, e = pl_times(e, base)) {
        const pl_wave_term t = { k * (n + 1), { modes[n].height, 0 }, { modes[n].rate, 0 } };
        add_term(&t, e, out);
    }
    if (surface->desc.swell > 0) {
        const pl_wave_term t = pl_swell_term(basin, &surface->desc, time);
        add_term(&t, wave_at(t.k, x), out);
    }
}

// Adds the flow of a wave: its potential is rate / (k tanh) Re(conj E) cosh(k (z + H)) / cosh(k H).
static void add_flow(const pl_basin *basin, const pl_wave_term *t, pl_complex e, double z,
                     double out[2])
{
    const double here = pl_decay_of(-t->k * z).left;
    const double mirrored = pl_decay_of(t->k * (z + 2 * basin->depth)).left;
    const double left = pl_decay_of(2 * t->k * basin->depth).left;
    const double across = (t->rate.im * e.re - t->rate.re * e.im) * (here + mirrored);
    const double upward = (t->rate.re * e.re + t->rate.im * e.im) * (here - mirrored);
    out[0] += across / (1 - left);
    out[1] += basin->up * upward / (1 - left);
}

void pl_waves_flow(const pl_basin *basin, const pl_wave_surface *surface,
                   const plumb_wave_mode *modes, double time, double x, double z, double out[2])
{
    const double k = PI / basin->width;
    const pl_complex base = wave_at(k, x);
    pl_complex e = base;
    out[0] = out[1] = 0;
    for (int n = 0; n < surface->desc.modes; ++n, e = pl_times(e, base)) {
        const pl_wave_term t = { k * (n + 1), { modes[n].height, 0 }, { modes[n].rate, 0 } };
        add_flow(basin, &t, e, z, out);
    }
    if (surface->desc.swell > 0) {
        const pl_wave_term t = pl_swell_term(basin, &surface->desc, time);
        add_flow(basin, &t, wave_at(t.k, x), z, out);
    }
}

//---- in time -------------------------------------------------------------------------------------

// Root mean square of how fast the surface rises.
static double speed_of(const plumb_world *world, const pl_wave_surface *surface,
                       const pl_basin *basin)
{
    const plumb_wave_mode *modes = pl_wave_modes(&world->waves) + surface->first;
    double sum = 0;
    for (int n = 0; n < surface->desc.modes; ++n) {
        sum += modes[n].rate * modes[n].rate;
    }
    if (surface->desc.swell > 0) {
        const double w = pl_wave_omega(basin, TURN / fabs((double)surface->desc.swell_length));
        const double rate = w * (double)surface->desc.swell;
        sum += rate * rate;
    }
    return sqrt(sum / 2);
}

bool pl_waves_are_lively(const plumb_world *world, uint32_t piece)
{
    const pl_wave_surface *surface = pl_waves_of(world, world->pieces.shape[piece]);
    if (surface == NULL) {
        return false;
    }
    const pl_basin basin = pl_basin_of(world, surface);
    return basin.stands &&
           speed_of(world, surface, &basin) > LIVELY * (double)world->desc.sleep_speed;
}

static void set_swings(const pl_basin *basin, int count, double half, pl_wave_swing *out)
{
    for (int n = 0; n < count; ++n) {
        pl_wave_swing *s = &out[n];
        s->k = PI / basin->width * (n + 1);
        s->omega = pl_wave_omega(basin, s->k);
        pl_sincos(s->omega * half, &s->sine, &s->cosine);
    }
}

// By half a step.
static void turn_modes(const pl_wave_swing *swings, int count, plumb_wave_mode *modes)
{
    for (int n = 0; n < count; ++n) {
        const pl_wave_swing *s = &swings[n];
        const plumb_wave_mode m = modes[n];
        modes[n].height = s->cosine * m.height + s->sine / s->omega * m.rate;
        modes[n].rate = s->cosine * m.rate - s->sine * s->omega * m.height;
    }
}

bool pl_waves_open(plumb_world *world, real dt)
{
    pl_waves *w = &world->waves;
    pl_waves_step *s = &w->step;
    const size_t bytes = w->mode_count * sizeof(plumb_wave_mode);
    if (!pl_buffer_reserve(&world->memory, &s->basins, w->count * sizeof(pl_basin)) ||
        !pl_buffer_reserve(&world->memory, &s->soundings, sizeof(pl_soundings)) ||
        !pl_buffer_reserve(&world->memory, &s->swings, w->mode_count * sizeof(pl_wave_swing)) ||
        !pl_buffer_reserve(&world->memory, &s->midway, bytes)) {
        return false;
    }
    s->dt = (double)dt;
    s->tide_count = 0;
    memcpy(s->midway.data, w->modes.data, bytes);
    for (uint32_t i = 0; i < w->count; ++i) {
        const pl_wave_surface *surface = &pl_wave_surfaces(w)[i];
        pl_basin *b = &pl_basins(world)[i];
        *b = pl_basin_of(world, surface);
        if (!b->stands) {
            continue;
        }
        pl_wave_swing *swings = (pl_wave_swing *)s->swings.data + surface->first;
        set_swings(b, surface->desc.modes, s->dt / 2, swings);
        turn_modes(swings, surface->desc.modes, (plumb_wave_mode *)s->midway.data + surface->first);
    }
    return true;
}

// What a body did to the modes in the middle of the step.
static void stir(plumb_world *world, const pl_tide *tide)
{
    pl_waves_step *s = &world->waves.step;
    const pl_basin *basin = &pl_basins(world)[tide->basin];
    const pl_wave_surface *surface = &pl_wave_surfaces(&world->waves)[tide->basin];
    plumb_wave_mode *modes = (plumb_wave_mode *)s->midway.data + surface->first;
    const pl_spectrum *before = (const pl_spectrum *)s->spectra.data + tide->spectrum;
    pl_soundings *soundings = s->soundings.data;
    double away[2];
    pl_tide_sound(world, tide, soundings, away);
    // What moves along with the body does as the body does against the water; so does the body itself as a dipole.
    const double c = basin->added, way[2] = { tide->away[0] - away[0], tide->away[1] - away[1] };
    const double dx = c * way[0] - (1 + c) * tide->flow[0] * s->dt;
    const double dz = basin->up * (c * way[1] - (1 + c) * tide->flow[1] * s->dt);
    for (int n = 0; n < surface->desc.modes; ++n) {
        const double k = PI / basin->width * (n + 1);
        const pl_spectrum after = pl_soundings_next(soundings);
        const double along = -k * (before[n].sum.im + after.sum.im) / 2;
        const double upward = k * (before[n].difference.re + after.difference.re) / 2;
        const double change = after.sum.re - before[n].sum.re + along * dx + upward * dz;
        modes[n].height += 2 / basin->width * change;
    }
}

static void fade_and_break(const pl_wave_swing *swings, const plumb_waves_desc *desc, double dt,
                           plumb_wave_mode *modes)
{
    const double left = pl_decay_of((double)desc->damping * dt).left;
    for (int n = 0; n < desc->modes; ++n) {
        const pl_wave_swing *swing = &swings[n];
        plumb_wave_mode *m = &modes[n];
        const double rate = m->rate / swing->omega;
        const double high = swing->k * sqrt(m->height * m->height + rate * rate);
        const double share = high > STEEPEST ? left * STEEPEST / high : left;
        // What was flung out of the world leaves no wave.
        const bool sound = high < FLUNG && fabs(m->rate) < FLUNG && fabs(m->height) < FLUNG;
        m->height = sound ? share * m->height : 0;
        m->rate = sound ? share * m->rate : 0;
    }
}

plumb_result pl_run_wave_motion(plumb_world *world, plumb_real dt)
{
    (void)dt;
    pl_waves *w = &world->waves;
    pl_waves_step *s = &w->step;
    // By pieces, an order that no solver decides.
    const pl_keyed *order = s->order.data;
    for (uint32_t i = 0; i < s->tide_count; ++i) {
        const pl_tide *tide = (const pl_tide *)s->tides.data + order[i].value;
        if (tide->basin != PL_NONE && world->pieces.kind[tide->piece] != PL_PIECE_FREE) {
            stir(world, tide);
        }
    }
    for (uint32_t i = 0; i < w->count; ++i) {
        const pl_wave_surface *surface = &pl_wave_surfaces(w)[i];
        const pl_basin *b = &pl_basins(world)[i];
        plumb_wave_mode *modes = (plumb_wave_mode *)s->midway.data + surface->first;
        if (b->stands) {
            const pl_wave_swing *swings = (const pl_wave_swing *)s->swings.data + surface->first;
            turn_modes(swings, surface->desc.modes, modes);
            fade_and_break(swings, &surface->desc, s->dt, modes);
            if (world->asleep_count > 0 && pl_waves_are_lively(world, b->piece)) {
                pl_sleep_wake_swimmers(world, b->piece);
            }
        }
    }
    memcpy(w->modes.data, s->midway.data, w->mode_count * sizeof(plumb_wave_mode));
    s->tide_count = 0;
    return PLUMB_OK;
}
