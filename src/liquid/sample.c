// sample.c - questions to the liquid between steps: how full is it at a place, where does a ray meet its surface.
//
// Particles are filed by bins of three spacings, as far as one reaches; a table of slots has the first of each chain. `fill` is the sum of
// their quadratic B-splines, 1.5 cells to either side, times the quarter of a cell that each stands for: it is 1 throughout a lattice
// at rest (B-splines of a cell's width sum up to 2 over places half a cell apart).
//
// Reads: particles. Writes: the index. Cost: O(particles) to file them; then O(1) a place.
#include "liquid/sample.h"

#include "math/compare.h"
#include "world/state.h"

#include <math.h>

#define REACH 3.0 // [spacings]

static double bin_side(const pl_liquid *liquid)
{
    return REACH * (double)pl_liquid_desc(liquid)->spacing;
}

static uint32_t slot_of(const pl_liquid_index *index, int64_t i, int64_t j)
{
    const uint64_t mixed =
        (uint64_t)i * UINT64_C(0x9e3779b97f4a7c15) + (uint64_t)j * UINT64_C(0xc2b2ae3d27d4eb4f);
    return (uint32_t)((mixed ^ mixed >> 29) * UINT64_C(0xbf58476d1ce4e5b9) >> 32) & index->mask;
}

static int64_t bin_of(double x, double side)
{
    return (int64_t)floor(x / side);
}

// Slots, a power of 2 and no fewer than particles.
static uint32_t slots_for(uint32_t count)
{
    uint32_t slots = 64;
    while (slots < count) {
        slots *= 2;
    }
    return slots;
}

bool pl_liquid_file(plumb_world *world)
{
    pl_liquid *liquid = &world->liquid;
    pl_liquid_index *index = &liquid->index;
    if (index->fresh) {
        return true;
    }
    const uint32_t slots = slots_for(liquid->count);
    if (!pl_buffer_reserve(&world->memory, &index->heads, slots * sizeof(uint32_t)) ||
        !pl_buffer_reserve(&world->memory, &index->next, liquid->count * sizeof(uint32_t))) {
        return false;
    }
    uint32_t *heads = index->heads.data, *next = index->next.data;
    const plumb_particle *p = pl_liquid_items(liquid);
    const double side = bin_side(liquid);
    index->mask = slots - 1;
    index->low_x = index->low_y = INFINITY;
    index->high_x = index->high_y = -INFINITY;
    for (uint32_t i = 0; i < slots; ++i) {
        heads[i] = PL_NONE;
    }
    for (uint32_t i = 0; i < liquid->count; ++i) {
        const double x = (double)p[i].position.x, y = (double)p[i].position.y;
        const uint32_t slot = slot_of(index, bin_of(x, side), bin_of(y, side));
        next[i] = heads[slot];
        heads[slot] = i;
        index->low_x = pl_lesser(index->low_x, x), index->high_x = pl_greater(index->high_x, x);
        index->low_y = pl_lesser(index->low_y, y), index->high_y = pl_greater(index->high_y, y);
    }
    index->fresh = true;
    return true;
}

//---- a place -------------------------------------------------------------------------------------

// A B-spline and its slope at t [cells] from its middle.
static double spline(double t, double *slope)
{
    const double far = fabs(t);
    if (far < 0.5) {
        *slope = -2 * t;
        return 0.75 - t * t;
    }
    const double left = far < 1.5 ? 1.5 - far : 0;
    *slope = t < 0 ? left : -left;
    return left * left / 2;
}

static void add_particle(pl_liquid_fill *f, const plumb_particle *p, double x, double y,
                         double cell)
{
    const double dx = x - (double)p->position.x, dy = y - (double)p->position.y;
    double slope_x, slope_y;
    const double wx = spline(dx / cell, &slope_x), wy = spline(dy / cell, &slope_y);
    const double w = wx * wy / 4;
    if (!(w > 0)) {
        return;
    }
    const double square = dx * dx + dy * dy;
    f->fill += w;
    f->rise_x += slope_x * wy, f->rise_y += wx * slope_y;
    f->vx +=
        w * ((double)p->velocity.x + (double)p->gradient[0] * dx + (double)p->gradient[1] * dy);
    f->vy +=
        w * ((double)p->velocity.y + (double)p->gradient[2] * dx + (double)p->gradient[3] * dy);
    if (square < f->square) {
        f->square = square;
        f->phase = p->phase;
    }
}

pl_liquid_fill pl_liquid_fill_at(const pl_liquid *liquid, double x, double y)
{
    const pl_liquid_index *index = &liquid->index;
    const plumb_particle *p = pl_liquid_items(liquid);
    const uint32_t *heads = index->heads.data, *next = index->next.data;
    const double side = bin_side(liquid), cell = side * (2 / REACH);
    pl_liquid_fill f = { .square = INFINITY };
    if (!(x > index->low_x - side && x < index->high_x + side && y > index->low_y - side &&
          y < index->high_y + side)) {
        return f;
    }
    const int64_t i0 = bin_of(x, side), j0 = bin_of(y, side);
    for (int64_t j = j0 - 1; j <= j0 + 1; ++j) {
        for (int64_t i = i0 - 1; i <= i0 + 1; ++i) {
            for (uint32_t k = heads[slot_of(index, i, j)]; k != PL_NONE; k = next[k]) {
                if (bin_of((double)p[k].position.x, side) == i &&
                    bin_of((double)p[k].position.y, side) == j) { // others share the slot
                    add_particle(&f, &p[k], x, y, cell);
                }
            }
        }
    }
    if (f.fill > 0) {
        f.vx /= f.fill, f.vy /= f.fill;
    }
    return f;
}

//---- a ray ---------------------------------------------------------------------------------------

typedef struct ray {
    const pl_liquid *liquid;
    double x, y, dx, dy; // [m] start, unit direction
    double side;         // [m] of a bin
} ray;

static pl_liquid_fill fill_along(const ray *r, double at)
{
    return pl_liquid_fill_at(r->liquid, r->x + r->dx * at, r->y + r->dy * at);
}

// [m] along the ray from `at` on to where the next particle is within reach; INFINITY: none is. O(particles).
static double next_within_reach(const ray *r, double at)
{
    const plumb_particle *p = pl_liquid_items(r->liquid);
    const double reach = r->side * 1.5; // a corner of its square
    double first = INFINITY;
    for (uint32_t i = 0; i < r->liquid->count; ++i) {
        const double px = (double)p[i].position.x - r->x, py = (double)p[i].position.y - r->y;
        const double along = px * r->dx + py * r->dy, across = px * r->dy - py * r->dx;
        if (fabs(across) < reach && along + reach > at) {
            first = pl_lesser(first, pl_greater(at, along - reach));
        }
    }
    return first;
}

// Of an interval [low, high], the part at which one coordinate is between two bounds.
static void clip(double from, double way, double least, double most, double *low, double *high)
{
    if (way == 0) {
        *high = from >= least && from <= most ? *high : -INFINITY;
        return;
    }
    const double a = (least - from) / way, b = (most - from) / way;
    *low = pl_greater(*low, pl_lesser(a, b));
    *high = pl_lesser(*high, pl_greater(a, b));
}

// So many steps in the open, one after another, before the next particle is looked for.
#define OPEN_STEPS 256

// From `low`, which is out of the liquid, to `high`, which is in it.
static double surface_between(const ray *r, double low, double high)
{
    for (int i = 0; i < 12; ++i) {
        const double middle = (low + high) / 2;
        if (fill_along(r, middle).fill >= 0.5) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return high;
}

double pl_liquid_ray_to_surface(const pl_liquid *liquid, double x, double y, double dx, double dy,
                                double length)
{
    const pl_liquid_index *index = &liquid->index;
    const ray r = { liquid, x, y, dx, dy, bin_side(liquid) };
    const double fine = r.side / (2 * REACH), wide = r.side / 2;
    double at = 0, end = length, fill = fill_along(&r, 0).fill;
    if (fill >= 0.5) {
        return 0;
    }
    clip(x, dx, index->low_x - r.side, index->high_x + r.side, &at, &end);
    clip(y, dy, index->low_y - r.side, index->high_y + r.side, &at, &end);
    for (int open = 0; at < end;) {
        const double before = at;
        open = fill > 0 ? 0 : open + 1;
        at = before + (fill > 0 ? fine : wide);
        if (open == OPEN_STEPS) {
            open = 0;
            at = pl_greater(at, next_within_reach(&r, before));
        }
        at = pl_lesser(at, end);
        fill = fill_along(&r, at).fill;
        if (fill >= 0.5) {
            return surface_between(&r, before, at);
        }
    }
    return INFINITY;
}
