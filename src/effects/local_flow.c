// local_flow.c - flow that is another at each place: a vortex, a source, a jet, eddies; and drag in it.
//
// Vortex and source are that of Lamb and Oseen, (1 - exp(-(r / a)^2)) / (2 pi r), across the radius and along it. The jet is the
// plane turbulent one: half its width w at the slot goes into a core that is gone at 6 w, beside it a layer of profile sech^2 that is
// d = x / 8 thick; behind, U = jet sqrt(6 w / x). With 2 c + 4/3 d = w, c half the core, the momentum is that of the slot at each
// x. (Schlichting, Boundary-Layer Theory: half the speed at 0.11 x, which is 0.881 d.) Eddies are 16 waves of a stream function, which
// has no divergence, with speeds as k^(-1/3), which is Kolmogorov's spectrum where wave numbers are so many to an octave, and
// frequencies k u / 2 (Fung, Hunt, Malik, Perkins 1992).
//
// An element of an outline feels the flow that goes across its chord linear from end to end, and the mean along it: as if
// the fluid there moved rigidly, for which drag.c is exact. Elements longer than the grain are divided.
//
// Reads: the material, the volume. Cost: an exponential of each of vortex, source and jet, 16 cosines of eddies, at each corner.
#include "effects/fluid.h"

#include "math/decay.h"
#include "math/trig.h"

#include <math.h>

#define TURN  6.283185307179586
#define WAVES 16
// Of one element.
#define PARTS_MOST 64

// Direction, wave number over that of the largest, speed over the root mean square.
// clang-format off
static const double wave_x[WAVES] = {
    1.0, -0.36237489008048013, 0.73736887807831963, -0.89678282236527651,
    0.087425724716959669, 0.96014459713430578, -0.60843886097886235, 0.51917866639848997,
    -0.98471348531542879, -0.19449221560540009, 0.84375529481239675, -0.80600368003033129,
    0.25960430490148895, 0.99415184293652437, -0.46090702471337092, 0.66010957810086646,
};
static const double wave_y[WAVES] = {
    0.0, 0.9320324238132276, 0.67549029426152396, 0.44247098154632569,
    0.99617104086482777, 0.27950376132317362, 0.79360075129169616, 0.85466573135740354,
    0.17418195037931125, 0.98090406160281673, 0.53672805262632339, 0.5919105234556683,
    0.96571507437577819, 0.10799126439630252, 0.88744842924525369, 0.75116931839598999,
};
static const double wave_number[WAVES] = {
    1.0, 1.2030250360821166, 1.4472692374403782, 1.7411011265922482,
    2.0945882456412535, 2.5198420997897464, 3.0314331330207964, 3.6468899542328672,
    4.3872999187785036, 5.2780316430915768, 6.3496042078727974, 7.6387328312833311,
    9.1895868399762808, 11.05530303974221, 13.299806338284604, 16.0,
};
static const double wave_speed[WAVES] = {
    0.51901689280110186, 0.48800387610975648, 0.45884399217312138, 0.43142651003455468,
    0.40564731528699965, 0.38140851471174314, 0.35861806454134854, 0.33718942093513571,
    0.31704121133993496, 0.29809692548814909, 0.28028462485972711, 0.26353666950476845,
    0.24778946118940243, 0.23298320188957003, 0.21906166671562091, 0.20597199040543385,
};
// clang-format on

//---- the flow ------------------------------------------------------------------------------------

static void add_vortex(const pl_materials *m, uint32_t row, double x, double y, double out[2])
{
    const double swirl = (double)m->swirl[row], outflow = (double)m->outflow[row];
    if (swirl == 0 && outflow == 0) {
        return;
    }
    const double core = (double)m->core_radius[row], square = core * core;
    const double share = pl_decay_of((x * x + y * y) / square).mean / (TURN * square);
    out[0] += share * (outflow * x - swirl * y);
    out[1] += share * (outflow * y + swirl * x);
}

// Speed of a jet of speed 1 at a place ahead of a slot and beside its axis.
static double jet_at(double width, double ahead, double beside)
{
    if (ahead < 0) {
        return 0;
    }
    const double core = width / 2 - ahead / 12, layer = ahead / 8;
    const double out = beside - (core > 0 ? core : 0);
    const double axis = core > 0 ? 1 : sqrt(6 * width / ahead);
    if (out <= 0) {
        return axis;
    }
    if (layer == 0) {
        return 0;
    }
    const double e = pl_decay_of(2 * out / layer).left, half = 1 + e;
    return axis * 4 * e / (half * half);
}

// Along the x axis of the body, which turns within the step.
static void add_jet(const plumb_world *world, const pl_volume *volume, double x, double y,
                    double since, double out[2])
{
    const pl_materials *m = &world->materials;
    const double speed = (double)m->jet[volume->material], way = speed < 0 ? -1 : 1;
    if (speed == 0) {
        return;
    }
    const uint32_t holder = world->pieces.body[volume->piece];
    double s, c;
    pl_sincos((double)world->bodies.w[holder] * since, &s, &c);
    const double body_c = (double)world->bodies.c[holder], body_s = (double)world->bodies.s[holder];
    const double ex = c * body_c - s * body_s, ey = s * body_c + c * body_s;
    const double share = jet_at((double)m->jet_width[volume->material], way * (ex * x + ey * y),
                                fabs(ex * y - ey * x));
    out[0] += speed * share * ex;
    out[1] += speed * share * ey;
}

// Cosine of so many turns, below 2^51 in size, within 1e-13 (beyond, it is -1 to 1): the sine's Taylor series about a quarter. Without branches: all waves
// go through it in lanes (DECISIONS.md).
static double cosine_of_turns(double turns)
{
    const double whole = 6755399441055744.0; // 1.5 * 2^52: what is added to it is rounded
    const double off = fabs(turns - ((turns + whole) - whole));
    const double x = TURN * (0.25 - (off < 0.5 ? off : 0.5)), z = x * x;
    double p = 1 - z * (1 / 272.0);
    p = 1 - z * (1 / 210.0) * p;
    p = 1 - z * (1 / 156.0) * p;
    p = 1 - z * (1 / 110.0) * p;
    p = 1 - z * (1 / 72.0) * p;
    p = 1 - z * (1 / 42.0) * p;
    p = 1 - z * (1 / 20.0) * p;
    p = 1 - z * (1 / 6.0) * p;
    return x * p;
}

static void add_eddies(const pl_materials *m, uint32_t row, double x, double y, double time,
                       double out[2])
{
    const double speed = (double)m->eddies[row], length = (double)m->eddy_length[row];
    if (speed == 0) {
        return;
    }
    const double u = (x - (double)m->flow_x[row] * time) / length;
    const double v = (y - (double)m->flow_y[row] * time) / length;
    const double ran = speed / length * time / 2;
    double along[WAVES];
    for (int i = 0; i < WAVES; ++i) {
        const double turns = wave_number[i] * (wave_x[i] * u + wave_y[i] * v + wave_speed[i] * ran);
        along[i] = speed * wave_speed[i] * cosine_of_turns(turns + 0.6180339887498949 * (i + 1));
    }
    for (int i = 0; i < WAVES; ++i) {
        out[0] -= along[i] * wave_y[i];
        out[1] += along[i] * wave_x[i];
    }
}

void pl_local_flow(const plumb_world *world, const pl_volume *volume, double x, double y,
                   double since, double out[2])
{
    const pl_materials *m = &world->materials;
    const double ox = x - volume->origin_x, oy = y - volume->origin_y;
    out[0] = out[1] = 0;
    if (volume->grain == 0) {
        return;
    }
    add_vortex(m, volume->material, ox, oy, out);
    add_jet(world, volume, ox, oy, since, out);
    add_eddies(m, volume->material, ox, oy, world->time + since, out);
}

static double finer(double grain, bool there, double length)
{
    return there && (grain == 0 || length < grain) ? length : grain;
}

double pl_local_grain(const plumb_world *world, uint32_t row)
{
    const pl_materials *m = &world->materials;
    double grain = 0;
    grain = finer(grain, m->swirl[row] != 0 || m->outflow[row] != 0, (double)m->core_radius[row]);
    grain = finer(grain, m->jet[row] != 0, (double)m->jet_width[row] / 8);
    return finer(grain, m->eddies[row] != 0, (double)m->eddy_length[row] / 16);
}

// Along the way of what flows, by a thousandth of the grain to both sides.
void pl_local_acceleration(const plumb_world *world, const pl_volume *volume, double x, double y,
                           double since, const double flow[2], double out[2])
{
    const double speed = sqrt(flow[0] * flow[0] + flow[1] * flow[1]);
    out[0] = out[1] = 0;
    if (!(speed > 0)) {
        return;
    }
    const double time = volume->grain / 1000 / speed;
    double before[2], behind[2];
    pl_local_flow(world, volume, x - flow[0] * time, y - flow[1] * time, since - time, before);
    pl_local_flow(world, volume, x + flow[0] * time, y + flow[1] * time, since + time, behind);
    out[0] = (behind[0] - before[0]) / (2 * time);
    out[1] = (behind[1] - before[1]) / (2 * time);
}

//---- drag in it ----------------------------------------------------------------------------------

typedef struct dragging {
    const pl_immersed *in;
    pl_spin u; // against the even flow
    double pressure, skin;
    pl_drag *drag;
    double *force;
} dragging;

static void flow_at(const dragging *w, const pl_element *e, double out[2])
{
    const pl_immersed *in = w->in;
    pl_local_flow(in->world, in->volume, e->x - in->away[0], e->y - in->away[1], in->since, out);
}

// What is dragged between two places with the flows there.
static void drag_part(const dragging *w, const pl_element *e, const pl_element *to,
                      const double from[2], const double at_end[2])
{
    const double dx = to->x - e->x, dy = to->y - e->y, square = dx * dx + dy * dy;
    if (!(square > 0)) {
        return;
    }
    // A turn about the middle gives its ends velocities of opposite sign across the chord.
    const double spin = (dx * (at_end[1] - from[1]) - dy * (at_end[0] - from[0])) / square;
    const double mx = (e->x + to->x) / 2, my = (e->y + to->y) / 2;
    const pl_spin v = { w->u.vx - (from[0] + at_end[0]) / 2 - spin * my,
                        w->u.vy - (from[1] + at_end[1]) / 2 + spin * mx, w->u.w - spin };
    pl_drag d = { 0 };
    pl_element_drag(e, to, v, w->pressure, w->skin, &d);
    w->drag->xx += d.xx, w->drag->xy += d.xy, w->drag->yy += d.yy;
    w->drag->xw += d.xw, w->drag->yw += d.yw, w->drag->ww += d.ww;
    pl_drag_force(&d, v, w->force);
}

// A place on the way along an element; of an arc, on it.
static pl_element part_of(const pl_element *e, const pl_element *to, double share)
{
    pl_element at = *e;
    at.x += share * (to->x - e->x);
    at.y += share * (to->y - e->y);
    if (e->r > 0) {
        const double x = at.x - e->cx, y = at.y - e->cy, length = sqrt(x * x + y * y);
        at.x = e->cx + x * e->r / length;
        at.y = e->cy + y * e->r / length;
    }
    return at;
}

static void drag_element(const dragging *w, const pl_element *e, const pl_element *next,
                         double flow[2])
{
    const double dx = next->x - e->x, dy = next->y - e->y;
    const double wanted = sqrt(dx * dx + dy * dy) / w->in->volume->grain;
    const int parts = wanted < PARTS_MOST ? (int)wanted + 1 : PARTS_MOST;
    pl_element from = *e;
    for (int i = 1; i <= parts; ++i) {
        const pl_element to = i == parts ? *next : part_of(e, next, (double)i / parts);
        double at_end[2];
        flow_at(w, &to, at_end);
        drag_part(w, &from, &to, flow, at_end);
        from = to;
        flow[0] = at_end[0], flow[1] = at_end[1];
    }
}

void pl_local_drag(const pl_immersed *in, const pl_contour *contour, pl_spin u, double pressure,
                   double skin, pl_drag *drag, double force[3])
{
    const dragging w = { in, u, pressure, skin, drag, force };
    bool known = false;
    double flow[2];
    for (int i = 0; i < contour->count; ++i) {
        const pl_element *e = &contour->at[i];
        const pl_element *next = &contour->at[i + 1 == contour->count ? 0 : i + 1];
        if (e->cut || e->inner) {
            known = false;
            continue;
        }
        if (!known) {
            flow_at(&w, e, flow);
        }
        drag_element(&w, e, next, flow);
        known = true;
    }
}
