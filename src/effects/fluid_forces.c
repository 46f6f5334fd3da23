// fluid_forces.c - what fluids do to those who are in them, in each substep.
//
// Of the immersed outline, in the middle of the substep's way x + h v / 2: buoyancy, the weight of what is displaced, at its
// centroid; drag, -D u / 2 with the velocity u against the fluid, of which -D is the derivative (geometry/drag.c); and
// the waves that what floats would make, -B u. The acceleration is that of Kahan's method (1993), which takes products
// of velocities as v v': implicit by one solution of three equations, of second order,
//     (M + h/2 (D + B) + E) a = M a0 + F(x + h v / 2, u),
// exact for quadratic drag alone, and with terminal speeds that are right for any h. M has the mass that the fluid
// lends (fluid.c). A place in the middle of the way keeps the energy of what bobs, as long as its surface pushes back with
// less than K = 4 M / h^2; E is what K has too much, and what is so stiff is damped as by the implicit method of first
// order, so that nothing is too light, nor any step too long.
//
// Reads: solver bodies, lists of fluid.c. Writes: accelerations, times of rest. Order: behind whatever else accelerates. Cost: O(edges)
// a piece in a volume and substep.
#include "effects/fluid.h"
#include "effects/waves.h"

#include "core/quad.h"
#include "world/island.h"
#include "world/substep.h"

#include <math.h>

// So many bodies are worth a thread.
#define LEAST 16

// All that acts on a body.
typedef struct pl_pull {
    double force[3];             // [N], [N], [N m]
    double resist[3][3];         // [kg/s] and so on: D + B
    double lift, lift_x, lift_y; // [kg/s] of what spins, and times its velocity
    double excess[3][3];         // [kg] and so on: E
} pl_pull;

typedef struct passage {
    plumb_world *world;
    const pl_swimmer *swimmers;
    double h, time; // [s] of the middle of the substep, since the step began
} passage;

static void add_drag(pl_pull *pull, const pl_drag *d)
{
    pull->resist[0][0] += d->xx;
    pull->resist[1][1] += d->yy;
    pull->resist[2][2] += d->ww;
    pull->resist[0][1] += d->xy, pull->resist[1][0] += d->xy;
    pull->resist[0][2] += d->xw, pull->resist[2][0] += d->xw;
    pull->resist[1][2] += d->yw, pull->resist[2][1] += d->yw;
}

// Force and torque of f at a place.
static void add_force(pl_pull *pull, double fx, double fy, double x, double y)
{
    pull->force[0] += fx;
    pull->force[1] += fy;
    pull->force[2] += x * fy - y * fx;
}

static void add_square(double (*to)[3], double weight, double x, double y)
{
    to[0][0] += weight * x * x;
    to[0][1] += weight * x * y, to[1][0] += weight * x * y;
    to[1][1] += weight * y * y;
}

// What is too much of a surface that pushes a mass back with `stiffness` a metre. Twice as stiff as alone, for heave and
// roll come together; half of what a step bears, for edges go in and out.
static double excess_of(double stiffness, double mass, double h)
{
    const double excess = h * h / 2 * stiffness - mass / 2;
    return excess > 0 ? excess : 0;
}

// Buoyancy, waves, and what the surface pushes back too much. Where there are waves they are the wave drag; what a body has done to
// the surface since the step began, the modes know when it ends: until then it is the tide's answer.
static void float_up(const plumb_world *world, const pl_swimmer *s, const pl_volume *volume,
                     const pl_tide *tide, uint32_t row, const pl_contour *contour, pl_spin u,
                     const double moved[3], double h, pl_pull *pull)
{
    const pl_materials *m = &world->materials;
    const double density = (double)m->density[volume->material];
    const double scale = (double)world->bodies.gravity_scale[row];
    const double gx = (double)world->effects.gravity.x * scale;
    const double gy = (double)world->effects.gravity.y * scale;
    const double g = sqrt(gx * gx + gy * gy);
    const pl_area a = pl_contour_area(contour);
    if (!(a.area > 0) || g == 0) {
        return;
    }
    add_force(pull, -density * a.area * gx, -density * a.area * gy, a.x / a.area, a.y / a.area);
    if (tide != NULL) {
        add_force(pull, tide->force[0], tide->force[1], 0, 0);
        pull->force[2] += tide->force[2];
    }
    const double ux = -gx / g, uy = -gy / g;
    const pl_waterline line = pl_contour_waterline(contour, ux, uy);
    if (!(line.width > 0)) {
        return;
    }
    const double drag = tide != NULL ? 0 : (double)m->wave_drag[volume->material];
    const double waves = drag * density * a.area * sqrt(g / line.width);
    const double turns = waves * line.second / line.width, rise = u.vx * ux + u.vy * uy;
    // A side of the mean draft pushes waves as a bottom of the width does.
    const double draft = a.area / (line.width * line.width),
                 sways = waves * (draft < 1 ? draft : 1);
    const double sway = u.vy * ux - u.vx * uy;
    add_force(pull, -waves * rise * ux + sways * sway * uy, -waves * rise * uy - sways * sway * ux,
              0, 0);
    pull->force[2] -= turns * u.w;
    add_square(pull->resist, waves, ux, uy);
    add_square(pull->resist, sways, -uy, ux);
    pull->resist[2][2] += turns;
    const double push = density * g * line.width, back = density * g * line.second;
    const double answer = tide != NULL ? tide->answer : 0;
    const double heave = excess_of((1 + answer) * push, s->mass + s->lent, h),
                 roll = excess_of((1 + answer) * back, s->inertia, h);
    if (answer > 0) {
        const double risen = moved[0] * ux + moved[1] * uy;
        add_force(pull, -answer * push * risen * ux, -answer * push * risen * uy, 0, 0);
        pull->force[2] -= answer * back * moved[2];
    }
    add_square(pull->excess, heave, ux, uy);
    pull->excess[2][2] += roll;
    add_force(pull, -heave / h * rise * ux, -heave / h * rise * uy, 0, 0);
    pull->force[2] -= roll / h * u.w;
    add_square(pull->resist, 2 * heave / h, ux, uy);
    pull->resist[2][2] += 2 * roll / h;
}

// Velocity of a body against the fluid, as if both were rigid; and the flow.
static pl_spin against(const plumb_world *world, const pl_volume *volume, uint32_t row,
                       const pl_solver_body *body, const double away[2], double time,
                       double flow[2])
{
    const pl_bodies *b = &world->bodies;
    const uint32_t holder = world->pieces.body[volume->piece];
    const double height = -(volume->up_x * away[0] + volume->up_y * away[1]) - volume->bottom;
    pl_fluid_flow(world, volume, (double)b->center_x[row] + (double)body->dx,
                  (double)b->center_y[row] + (double)body->dy, height, world->time + time, flow);
    const double w = (double)b->w[holder];
    return (pl_spin){ (double)body->vx - flow[0] - (double)b->vx[holder] - w * away[1],
                      (double)body->vy - flow[1] - (double)b->vy[holder] + w * away[0],
                      (double)body->w - w };
}

// The drag of an outline at a velocity against the even flow.
static void drag_outline(const pl_immersed *in, const pl_contour *contour, pl_spin u, pl_pull *pull)
{
    const pl_materials *m = &in->world->materials;
    const uint32_t material = in->volume->material;
    const double pressure = (double)(m->drag[material] * m->density[material]);
    const double skin = (double)(m->skin_drag[material] * m->density[material]);
    pl_drag d = { 0 };
    if (in->volume->grain > 0) {
        pl_local_drag(in, contour, u, pressure, skin, &d, pull->force);
    } else {
        pl_contour_drag(contour, u, pressure, skin, &d);
        pl_drag_force(&d, u, pull->force);
    }
    add_drag(pull, &d);
}

// What of an outline lies from low to high across a unit vector.
static void drag_strip(const pl_immersed *in, const pl_contour *contour, const double n[2],
                       double low, double high, pl_spin u, pl_pull *pull)
{
    pl_contour strip = *contour;
    if (high < INFINITY) {
        pl_contour_cut(&strip, (pl_half_plane){ n[0], n[1], high });
    }
    if (low > -INFINITY && strip.count > 0) {
        pl_contour_cut(&strip, (pl_half_plane){ -n[0], -n[1], -low });
    }
    if (strip.count > 0) {
        drag_outline(in, &strip, u, pull);
    }
}

// The same strip by strip where some are sheltered; (x, y): what the outline is relative to, in the world.
static void drag_shaded(const pl_immersed *in, const pl_contour *contour, pl_shadow shadow,
                        const double flow[2], double x, double y, pl_spin u, pl_pull *pull)
{
    const plumb_world *world = in->world;
    const uint32_t material = in->volume->material;
    const pl_shade *shades = (const pl_shade *)world->effects.shelter->shades.data + shadow.first;
    const double fx = (double)world->materials.flow_x[material];
    const double fy = (double)world->materials.flow_y[material], speed = sqrt(fx * fx + fy * fy);
    const double n[2] = { -fy / speed, fx / speed }, at = n[0] * x + n[1] * y;
    double from = -INFINITY;
    for (uint32_t i = 0; i < shadow.count; ++i) {
        const pl_shade *s = &shades[i];
        if (s->low - at > from) {
            drag_strip(in, contour, n, from, s->low - at, u, pull);
        }
        const pl_spin v = { u.vx + s->share * flow[0], u.vy + s->share * flow[1], u.w };
        drag_strip(in, contour, n, s->low - at, s->high - at, v, pull);
        from = s->high - at;
    }
    drag_strip(in, contour, n, from, INFINITY, u, pull);
}

static pl_shadow shadow_of(const plumb_world *world, const pl_keyed *immersion)
{
    const pl_effects *e = &world->effects;
    if (e->shelter == NULL || !e->shelter->any) {
        return (pl_shadow){ 0, 0 };
    }
    const pl_shadow *shadows = e->shelter->shadows.data;
    return shadows[immersion - (const pl_keyed *)e->immersions.data];
}

// The local flow at a body's centre: it is against that, too; and pushed as the fluid is that it displaces.
static void go_along(const pl_immersed *in, const pl_contour *contour, double flow[2], pl_spin *u,
                     pl_pull *pull)
{
    const pl_materials *m = &in->world->materials;
    const uint32_t of = in->volume->material;
    double local[2], a[2];
    pl_local_flow(in->world, in->volume, -in->away[0], -in->away[1], in->since, local);
    u->vx -= local[0];
    u->vy -= local[1];
    flow[0] += local[0];
    flow[1] += local[1];
    if (m->weightless[of]) {
        return;
    }
    const pl_area part = pl_contour_area(contour);
    if (!(part.area > 0)) {
        return;
    }
    const double mass = (double)m->density[of] * (1 + (double)m->added_mass[of]) * part.area;
    const double x = part.x / part.area, y = part.y / part.area;
    pl_local_acceleration(in->world, in->volume, x - in->away[0], y - in->away[1], in->since, flow,
                          a);
    add_force(pull, mass * a[0], mass * a[1], x, y);
}

static void immerse(const passage *p, const pl_swimmer *s, const pl_keyed *immersion,
                    const pl_solver_body *body, pl_pull *pull)
{
    const plumb_world *world = p->world;
    const pl_volume *volume = (const pl_volume *)world->effects.volumes.data + immersion->order;
    const pl_materials *m = &world->materials;
    const uint32_t of = volume->material, piece = immersion->value;
    const pl_tide *tide =
        pl_tide_of(world, (uint32_t)(immersion - (const pl_keyed *)world->effects.immersions.data));
    const double half = p->h / 2;
    const double moved[3] = { (double)body->dx + half * (double)body->vx,
                              (double)body->dy + half * (double)body->vy,
                              (double)body->da + half * (double)body->w };
    pl_contour contour;
    pl_immersed in = { .world = world, .volume = volume, .since = p->time };
    pl_fluid_contour(world, volume, tide, piece, moved, p->time, &contour, in.away);
    if (contour.count == 0) {
        return;
    }
    const uint32_t row = world->pieces.body[piece];
    double flow[2];
    pl_spin u = against(world, volume, row, body, in.away, p->time, flow);
    if (tide != NULL) {
        flow[0] += tide->flow[0], u.vx -= tide->flow[0];
        flow[1] += tide->flow[1], u.vy -= tide->flow[1];
    }
    const pl_shadow shadow = shadow_of(world, immersion);
    if (shadow.count > 0) {
        const double x = (double)world->bodies.center_x[row] + moved[0];
        const double y = (double)world->bodies.center_y[row] + moved[1];
        drag_shaded(&in, &contour, shadow, flow, x, y, u, pull);
    } else {
        drag_outline(&in, &contour, u, pull);
    }
    if (volume->grain > 0) {
        go_along(&in, &contour, flow, &u, pull);
    }
    if (m->magnus[of] > 0) {
        const double area = pl_contour_area(&contour).area;
        const double lift = 2 * (double)(m->magnus[of] * m->density[of]) * area * u.w;
        pull->lift += lift;
        pull->lift_x += lift * u.vx;
        pull->lift_y += lift * u.vy;
    }
    if (!m->weightless[of]) {
        float_up(world, s, volume, tide, row, &contour, u, moved, p->h, pull);
    }
}

// Solves the symmetric positive definite m a = b by L D L'; axes that do not move have m 1 and b 0.
static void solve(double m[3][3], double b[3])
{
    const double l10 = m[1][0] / m[0][0], l20 = m[2][0] / m[0][0];
    const double d1 = m[1][1] - l10 * m[1][0], l21 = (m[2][1] - l20 * m[1][0]) / d1;
    const double d2 = m[2][2] - l20 * m[2][0] - l21 * l21 * d1;
    b[1] -= l10 * b[0];
    b[2] -= l20 * b[0] + l21 * b[1];
    b[2] /= d2;
    b[1] = b[1] / d1 - l21 * b[2];
    b[0] = b[0] / m[0][0] - l10 * b[1] - l20 * b[2];
}

// Adds the lift of what spins, k J (v + v') / 2 with J the quarter turn: it takes no energy.
static void lift(const pl_pull *pull, double mass, double h, double a[3])
{
    const double k = pull->lift / mass, q = h * k / 2;
    const double x = pull->lift_x / mass + q * a[0], y = pull->lift_y / mass + q * a[1];
    a[0] += (-y - q * x) / (1 + q * q);
    a[1] += (x - q * y) / (1 + q * q);
}

static void accelerate(const passage *p, const pl_swimmer *s, const pl_pull *pull, uint32_t row)
{
    pl_solver_motion *motion = &pl_solver_motions(&p->world->solver)[s->slot];
    const uint32_t flags = p->world->bodies.flags[row];
    const bool still[3] = { (flags & PL_BODY_LOCK_X) != 0, (flags & PL_BODY_LOCK_Y) != 0,
                            s->inertia == 0 };
    const double own[3] = { s->mass, s->mass, s->inertia };
    const double lent[3] = { s->lent, s->lent, 0 };
    double a[3] = { (double)motion->ax, (double)motion->ay, (double)motion->aw }, m[3][3];
    for (int i = 0; i < 3; ++i) {
        a[i] = still[i] ? 0 : own[i] * a[i] + pull->force[i];
        for (int k = 0; k < 3; ++k) {
            const bool off = still[i] || still[k];
            m[i][k] = off ? 0 : p->h / 2 * pull->resist[i][k] + pull->excess[i][k];
        }
        m[i][i] = still[i] ? 1 : m[i][i] + own[i] + lent[i];
    }
    solve(m, a);
    if (pull->lift != 0 && !still[0] && !still[1]) {
        lift(pull, s->mass + s->lent, p->h, a);
    }
    motion->ax = (near_real)a[0];
    motion->ay = (near_real)a[1];
    motion->aw = (near_real)a[2];
}

static void act(void *context, uint32_t first, uint32_t count)
{
    const passage *p = context;
    plumb_world *world = p->world;
    const pl_keyed *all = world->effects.immersions.data;
    for (uint32_t i = first; i < first + count; ++i) {
        const pl_swimmer *s = &p->swimmers[i];
        const pl_solver_body *body = &pl_solver_bodies(&world->solver)[s->slot];
        pl_pull pull = { .force = { 0 } };
        for (uint32_t k = s->first; k < s->first + s->count; ++k) {
            immerse(p, s, &all[k], body, &pull);
        }
        const uint32_t row = ((const uint32_t *)world->solver.rows.data)[s->slot];
        accelerate(p, s, &pull, row);
        if (s->restless) { // here, where no step is refused any more
            world->bodies.rest_time[row] = PL_NOT_RESTING;
        }
    }
}

void pl_fluid_row(pl_substep *s)
{
    const pl_effects *e = &s->world->effects;
    const pl_share mine = pl_substep_share(e->swimmers.data, sizeof(pl_swimmer),
                                           offsetof(pl_swimmer, slot), e->swimmer_count, s);
    passage p = { .world = s->world,
                  .swimmers = (const pl_swimmer *)e->swimmers.data + mine.first,
                  .h = (double)s->h,
                  .time = (double)s->h * (s->number + 0.5) };
    pl_tasks_ranges(s->tasks, mine.end - mine.first, LEAST, act, &p);
}
