// strays.c - particles on their own: drops that fly as points, without tiles.
//
// What spills over an edge spreads out without end, and a particle alone would take tiles of its own. Where a tile
// and those beside it hold but a few particles each, and no body but static ones is near, there is no pressure to speak of:
// such particles fly on parabolas, and lose what of their velocity goes into a solid. Who is a stray is found anew in
// each step, so it is no state.
//
// Reads: particles, solids. Writes: spots, strays; those particles. Cost: O(particles + tiles with few of them x bodies near +
// strays x solids).
#include "liquid/liquid.h"

#include <string.h>

#define MANY   24   // particles that make a tile lively
#define FEWEST 2048 // particles that are worth a thread

static const pl_liquid_home *homes_of(const pl_liquid_scratch *scratch)
{
    return scratch->homes.data;
}

static bool many_near(const pl_liquid_scratch *scratch, const pl_liquid_home *home)
{
    for (int32_t j = -1; j <= 1; ++j) {
        for (int32_t i = -1; i <= 1; ++i) {
            const uint32_t t = pl_liquid_tile_at(scratch, home->x + i, home->y + j);
            if (t != PL_LIQUID_NONE && homes_of(scratch)[t].points >= MANY) {
                return true;
            }
        }
    }
    return false;
}

// A body, or a soft body, may be pushed, or push.
static bool body_near(const pl_liquid_grid *g, const pl_liquid_home *home)
{
    const double side = PL_LIQUID_SIDE, x = home->x * side, y = home->y * side;
    for (uint32_t i = 0; i < g->solid_count; ++i) {
        const pl_liquid_solid *s = &g->solids[i];
        if ((s->body != PL_LIQUID_NONE || s->soft) && s->low_x < x + 2 * side &&
            s->high_x > x - side && s->low_y < y + 2 * side && s->high_y > y - side) {
            return true;
        }
    }
    return false;
}

bool pl_liquid_find_strays(pl_memory *memory, pl_liquid_scratch *scratch,
                           const plumb_particle *particles, uint32_t count)
{
    pl_liquid_grid *g = &scratch->grid;
    g->strays = NULL;
    if (!pl_buffer_reserve(memory, &scratch->strays, count + 1) ||
        !pl_liquid_find_spots(memory, scratch, particles, count)) {
        return false;
    }
    pl_liquid_home *homes = scratch->homes.data;
    bool any = false;
    for (uint32_t i = 0; i < scratch->home_count; ++i) {
        homes[i].lively = many_near(scratch, &homes[i]) || body_near(g, &homes[i]);
        any |= !homes[i].lively;
    }
    const pl_liquid_spot *spots = scratch->spots.data;
    g->strays = scratch->strays.data;
    if (!any) {
        memset(g->strays, 0, count);
        return true;
    }
    for (uint32_t k = 0; k < count; ++k) {
        g->strays[k] = !homes[spots[k].cell].lively;
    }
    return true;
}

//---- flight --------------------------------------------------------------------------------------

typedef struct flight {
    const pl_liquid_grid *g;
    plumb_vec2 gravity;
    double dt;
    plumb_particle *particles;
} flight;

static double held(double velocity)
{
    return pl_liquid_held(velocity, PL_LIQUID_SPEED);
}

static void fly(const flight *f, plumb_particle *p)
{
    const pl_liquid_grid *g = f->g;
    const double h = (double)g->h, ax = (double)f->gravity.x, ay = (double)f->gravity.y;
    double vx = held((double)p->velocity.x), vy = held((double)p->velocity.y);
    const pl_liquid_place from = { (double)p->position.x / h, (double)p->position.y / h };
    pl_liquid_place to = { from.x + f->dt * (vx + f->dt / 2 * ax) / h,
                           from.y + f->dt * (vy + f->dt / 2 * ay) / h };
    vx = held(vx + f->dt * ax);
    vy = held(vy + f->dt * ay);
    pl_liquid_place n, unused;
    to = pl_liquid_slide_all(g, from, to, &n, &unused);
    const double into = vx * n.x + vy * n.y, along = vy * n.x - vx * n.y;
    if (into < 0) {
        const double held = pl_liquid_held(along, -into * pl_liquid_friction(g, p->phase));
        vx -= into * n.x - held * n.y;
        vy -= into * n.y + held * n.x;
    }
    *p = (plumb_particle){ .position = { pl_held(to.x * h), pl_held(to.y * h) },
                           .velocity = { (plumb_real)vx, (plumb_real)vy },
                           .phase = p->phase,
                           .tag = p->tag };
}

static void fly_range(void *context, uint32_t first, uint32_t count)
{
    const flight *f = context;
    for (uint32_t k = first; k < first + count; ++k) {
        if (f->g->strays[k]) {
            fly(f, &f->particles[k]);
        }
    }
}

void pl_liquid_fly(const pl_liquid_grid *g, plumb_vec2 gravity, double dt,
                   plumb_particle *particles, uint32_t count)
{
    flight f = { g, gravity, dt, particles };
    pl_tasks_ranges(g->tasks, count, FEWEST, fly_range, &f);
}
