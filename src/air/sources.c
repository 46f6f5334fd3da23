// sources.c - where smoke and heat come from, what fades, fans, and heat that rises.
//
// A source is strongest in its middle, by 1 - (r/R)^2; one that is smaller than a cell acts on the cell that it lies in. Air that
// is warmer by T is lighter by T / T0 of what it weighs (Boussinesq): it is driven against gravity by so much.
//
// Reads: sources, bodies, settings. Writes: columns. Cost: O(cells of sources); of what fades, and of heat, O(cells).
#include "air/air.h"
#include "math/decay.h"
#include "world/rows.h"

#include <math.h>

// A source as it lies now, in cells of the box.
typedef struct spot {
    double x, y, radius;
    double push_x, push_y; // [m/s^2]
    int32_t low_x, low_y, high_x, high_y;
} spot;

static int32_t within(double cells, int32_t most)
{
    return cells > most ? most : cells > 0 ? (int32_t)cells : 0;
}

// False: its body is gone, or out of the simulation.
static bool find_spot(const plumb_world *world, const pl_air_scratch *s,
                      const plumb_air_source *source, double h, spot *out)
{
    double x = (double)source->position.x, y = (double)source->position.y;
    out->push_x = (double)source->push.x;
    out->push_y = (double)source->push.y;
    if (!plumb_is_null(source->body)) {
        const uint32_t row = pl_body_row(world, source->body);
        if (row == PL_NONE || row >= pl_partition_first(world, PL_PART_DISABLED)) {
            return false;
        }
        const pl_bodies *b = &world->bodies;
        const double c = (double)b->c[row], sine = (double)b->s[row];
        const double turned = c * x - sine * y;
        y = (double)b->y[row] + sine * x + c * y;
        x = (double)b->x[row] + turned;
        out->push_x = c * (double)source->push.x - sine * (double)source->push.y;
        out->push_y = sine * (double)source->push.x + c * (double)source->push.y;
    }
    out->x = x / h - s->low_x;
    out->y = y / h - s->low_y;
    out->radius = (double)source->radius / h;
    // Whoever is smaller than a cell is in the middle of one.
    if (out->radius < 0.75) {
        out->x = floor(out->x) + 0.5;
        out->y = floor(out->y) + 0.5;
        out->radius = 0.75;
    }
    out->low_x = within(out->x - out->radius, s->columns_x);
    out->low_y = within(out->y - out->radius, s->columns_y);
    out->high_x = within(out->x + out->radius + 1, s->columns_x);
    out->high_y = within(out->y + out->radius + 1, s->columns_y);
    return true;
}

static double weight_at(const spot *p, double x, double y)
{
    const double dx = x - p->x, dy = y - p->y, r = p->radius;
    const double w = 1 - (dx * dx + dy * dy) / (r * r);
    return w > 0 ? w : 0;
}

//---- smoke and heat ------------------------------------------------------------------------------

static void fade(pl_air_scratch *s, near_real *q, double rate, double dt)
{
    const near_real left = (near_real)pl_decay_of(rate * dt).left;
    for (int32_t j = 0; j < s->columns_y && rate > 0; ++j) {
        const size_t line = pl_air_at(s, 0, j);
        for (int32_t i = 0; i < s->columns_x; ++i) {
            q[line + (size_t)i] *= left;
        }
    }
}

void pl_air_feed(const plumb_world *world, pl_air_scratch *s, double dt)
{
    const pl_air *air = &world->air;
    const plumb_air_desc *d = pl_air_desc(air);
    fade(s, s->smoke, (double)d->fading, dt);
    fade(s, s->heat, (double)d->cooling, dt);
    for (uint32_t n = 0; n < air->source_count; ++n) {
        const plumb_air_source *source = &pl_air_sources(air)[n];
        spot p;
        if ((source->smoke == 0 && source->heat == 0) ||
            !find_spot(world, s, source, (double)d->cell, &p)) {
            continue;
        }
        for (int32_t j = p.low_y; j < p.high_y; ++j) {
            for (int32_t i = p.low_x; i < p.high_x; ++i) {
                const size_t k = pl_air_at(s, i, j);
                const double w = s->room[k] > 0 ? dt * weight_at(&p, i + 0.5, j + 0.5) : 0;
                const double smoke = (double)s->smoke[k] + w * (double)source->smoke;
                const double heat = (double)s->heat[k] + w * (double)source->heat;
                s->smoke[k] = (near_real)pl_liquid_held(smoke > 0 ? smoke : 0, PL_AIR_MOST);
                s->heat[k] = (near_real)pl_liquid_held(heat, PL_AIR_MOST);
            }
        }
    }
}

//---- forces --------------------------------------------------------------------------------------

// Of a face: the mean of what is beside it and is air.
static near_real warmth(const pl_air_scratch *s, size_t before, size_t behind)
{
    const bool a = s->room[before] > 0, b = s->room[behind] > 0;
    return a && b ? (s->heat[before] + s->heat[behind]) / 2
           : a    ? s->heat[before]
           : b    ? s->heat[behind]
                  : 0;
}

// Of periodic sides the last cell lies before the first, of others a cell itself.
static int32_t before(int32_t i, int32_t count, bool periodic)
{
    return i > 0 ? i - 1 : periodic ? count - 1 : 0;
}

static int32_t behind(int32_t i, int32_t count, bool periodic)
{
    return i < count ? i : periodic ? 0 : count - 1;
}

static void rise(const plumb_world *world, pl_air_scratch *s, double dt)
{
    const plumb_air_desc *d = pl_air_desc(&world->air);
    const double per_kelvin = dt / (double)d->temperature;
    const near_real x = (near_real)pl_liquid_held(-(double)world->gravity.x * per_kelvin, 1e6);
    const near_real y = (near_real)pl_liquid_held(-(double)world->gravity.y * per_kelvin, 1e6);
    const bool wraps_x = d->left == PLUMB_AIR_PERIODIC, wraps_y = d->bottom == PLUMB_AIR_PERIODIC;
    const int32_t nx = s->columns_x, ny = s->columns_y;
    for (int32_t j = 0; j < ny && x != 0; ++j) {
        for (int32_t i = 0; i <= nx; ++i) {
            const size_t k = pl_air_at(s, i, j);
            s->u[k] += s->open_u[k] > 0 ? x * warmth(s, pl_air_at(s, before(i, nx, wraps_x), j),
                                                     pl_air_at(s, behind(i, nx, wraps_x), j))
                                        : 0;
        }
    }
    for (int32_t j = 0; j <= ny && y != 0; ++j) {
        for (int32_t i = 0; i < nx; ++i) {
            const size_t k = pl_air_at(s, i, j);
            s->v[k] += s->open_v[k] > 0 ? y * warmth(s, pl_air_at(s, i, before(j, ny, wraps_y)),
                                                     pl_air_at(s, i, behind(j, ny, wraps_y)))
                                        : 0;
        }
    }
}

// What a fan gives the air: momentum over the mass of a cell, and its moment about the corner of the box, in cells.
typedef struct thrust {
    double x, y, turn;
} thrust;

static thrust drive_fan(pl_air_scratch *s, const spot *p, double dt)
{
    thrust sum = { 0, 0, 0 };
    for (int32_t j = p->low_y; j < p->high_y; ++j) {
        for (int32_t i = p->low_x; i < p->high_x; ++i) {
            const size_t k = pl_air_at(s, i, j);
            const double u = s->open_u[k] > 0 ? dt * p->push_x * weight_at(p, i, j + 0.5) : 0;
            const double v = s->open_v[k] > 0 ? dt * p->push_y * weight_at(p, i + 0.5, j) : 0;
            s->u[k] += (near_real)u;
            s->v[k] += (near_real)v;
            sum.x += u * (double)s->open_u[k];
            sum.y += v * (double)s->open_v[k];
            sum.turn += (i + 0.5) * v * (double)s->open_v[k] - (j + 0.5) * u * (double)s->open_u[k];
        }
    }
    return sum;
}

// Whoever carries a fan is pushed the other way; `mass` of a cell [kg].
static void push_back(pl_air_scratch *s, plumb_body body, thrust t, double mass)
{
    pl_liquid_grid *g = &s->liquid.grid;
    const double h = (double)g->h;
    for (uint32_t i = 0; i < g->body_count; ++i) {
        pl_liquid_body *b = &g->bodies[i];
        if (!b->moves || !plumb_same(b->body, body)) {
            continue;
        }
        const double x = -mass * t.x, y = -mass * t.y;
        const double arm_x = s->low_x * h - b->x,
                     arm_y = s->low_y * h - b->y; // of the box's corner
        const double turn = -mass * h * t.turn + arm_x * y - arm_y * x;
        b->impulse_x += b->inv_mass_x > 0 ? x : 0;
        b->impulse_y += b->inv_mass_y > 0 ? y : 0;
        b->turn += b->inv_inertia > 0 ? turn : 0;
        b->vx += b->inv_mass_x * x;
        b->vy += b->inv_mass_y * y;
        b->w += b->inv_inertia * turn;
    }
}

void pl_air_drive(const plumb_world *world, pl_air_scratch *s, double dt)
{
    const pl_air *air = &world->air;
    const plumb_air_desc *d = pl_air_desc(air);
    const double h = (double)d->cell;
    rise(world, s, dt);
    for (uint32_t n = 0; n < air->source_count; ++n) {
        const plumb_air_source *source = &pl_air_sources(air)[n];
        spot p;
        if ((source->push.x != 0 || source->push.y != 0) && find_spot(world, s, source, h, &p)) {
            const thrust t = drive_fan(s, &p, dt);
            if (!plumb_is_null(source->body)) {
                push_back(s, source->body, t, (double)d->density * h * h);
            }
        }
    }
}
