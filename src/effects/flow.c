// flow.c - how the fluid of a volume flows: evenly, less near the bottom, in gusts that pass.
//
// Gusts are a sum of 16 cosines of the distance that the flow has gone, xi = (U t - s) / L, with s along the flow: frozen
// turbulence, without state, so that any moment can be asked for. Frequencies share out Kaimal's spectrum in its form for
// engineers (IEC 61400-1), S df = 4 (1 + 6 f)^(-5/3) df of variance 1, in equal parts: up to f it has
// 1 - (1 + 6 f)^(-2/3) of it, and each cosine stands for a sixteenth. Near the bottom, u = U (1 - exp(-z / d)), which a
// wall that draws fluid in makes (Schlichting, the asymptotic suction profile).
//
// Reads: the material. Cost: 16 cosines and an exponential where there are gusts and a layer.
#include "effects/fluid.h"
#include "effects/waves.h"

#include "math/decay.h"
#include "math/trig.h"
#include "world/waves_list.h"

#include <math.h>

#define WAVES 16

// [-] ((1 - F)^(-3/2) - 1) / 6 at F = 1/32, 3/32, ... 31/32
static const double frequencies[WAVES] = {
    0.0081292070540256445, 0.026519809264879179, 0.048377700326643902, 0.074692447978341556,
    0.10684884620038888,   0.14683855230393275,  0.19762003341644921,  0.26376115486747315,
    0.3526554619308242,    0.47699654609455272,  0.66029368768236774,  0.95073664187503804,
    1.4623542364185866,    2.5318102700103502,   5.6395312421527182,   30.003222663959363
};

static double gust_at(double xi)
{
    double sum = 0;
    for (int i = 0; i < WAVES; ++i) {
        double sine, cosine, turns = frequencies[i] * xi + 0.6180339887498949 * (i + 1);
        turns -= floor(turns);
        pl_sincos(6.283185307179586 * turns, &sine, &cosine);
        sum += cosine;
    }
    return sum * sqrt(2.0 / WAVES);
}

void pl_fluid_flow(const plumb_world *world, const pl_volume *volume, double x, double y,
                   double height, double time, double out[2])
{
    const pl_materials *m = &world->materials;
    const uint32_t row = volume->material;
    const double fx = (double)m->flow_x[row], fy = (double)m->flow_y[row];
    const double speed = sqrt(fx * fx + fy * fy);
    double share = 1;
    if (speed > 0 && m->gust[row] > 0) {
        const double gone = speed * time - (fx * x + fy * y) / speed;
        share += (double)m->gust[row] * gust_at(gone / (double)m->gust_length[row]);
    }
    if (m->shear_height[row] > 0) {
        share *= height > 0 ? 1 - pl_decay_of(height / (double)m->shear_height[row]).left : 0;
    }
    out[0] = share * fx;
    out[1] = share * fy;
}

// Of waves, at a place from the centre of the volume's body; nothing above the surface.
static void add_waves(const plumb_world *world, const pl_volume *volume, const double from[2],
                      double since, double out[2])
{
    const pl_wave_surface *surface = (world->pieces.flags[volume->piece] & PL_PIECE_WAVES) == 0
                                         ? NULL
                                         : pl_waves_of(world, world->pieces.shape[volume->piece]);
    if (surface == NULL) {
        return;
    }
    const pl_basin b = pl_basin_of(world, surface);
    const plumb_wave_mode *modes = pl_wave_modes(&world->waves) + surface->first;
    const double x = from[0] - b.left, time = world->time + since;
    if (!b.stands || x < 0 || x > b.width) {
        return;
    }
    double wave[3], flow[2];
    pl_waves_sample(&b, surface, modes, time, x, wave);
    const double z = b.up * from[1] - b.level - wave[0];
    if (z <= 0) {
        pl_waves_flow(&b, surface, modes, time, x, z, flow);
        out[0] += flow[0];
        out[1] += flow[1];
    }
}

void pl_fluid_velocity(const plumb_world *world, const pl_volume *volume, double x, double y,
                       const double from[2], double since, double out[2])
{
    const pl_bodies *b = &world->bodies;
    const uint32_t holder = world->pieces.body[volume->piece];
    const double height = volume->up_x * from[0] + volume->up_y * from[1] - volume->bottom;
    const double w = (double)b->w[holder];
    double even[2], local[2];
    pl_fluid_flow(world, volume, x, y, height, world->time + since, even);
    pl_local_flow(world, volume, from[0], from[1], since, local);
    out[0] = even[0] + local[0] + (double)b->vx[holder] - w * from[1];
    out[1] = even[1] + local[1] + (double)b->vy[holder] + w * from[0];
    add_waves(world, volume, from, since, out);
}
