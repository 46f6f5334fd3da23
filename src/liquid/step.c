// step.c - the liquid's two passes.
//
// "liquid" comes before the broad phase: bodies are pushed before contacts are looked for, or boats would hop. It
// leaves where particles will be in scratch, and "liquid motion", behind the last pass that can run out of memory, takes
// that over; so a refused step has moved nothing. A step is cut where the fastest particle, of those that are not alone, would cross more
// than a cell.
//
// Reads: particles, poses, velocities, masses, pieces. Writes: forces, particles. Cost: see DECISIONS.md.
#include "liquid/liquid.h"
#include "schema/passes.h"
#include "softbody/softbody.h"

#include <math.h>
#include <string.h>

#define MOST_PARTS   8 // of a step
#define CELLS_A_PART 1.0
#define TWO_PI       6.283185307179586

bool pl_want_liquid(const plumb_world *world, const char **reason)
{
    const bool wanted = world->liquid.count > 0 || world->liquid.supports.count > 0;
    *reason = wanted ? "there is liquid, or was in the last step" : "there is no liquid";
    return wanted;
}

// [s] half of that above which the shortest waves that tension makes would grow (Brackbill et al. 1992).
static double longest_part(const plumb_liquid_desc *d)
{
    const double h = 2 * (double)d->spacing, tension = (double)d->tension;
    return tension > 0 ? sqrt((double)d->density * h * h * h / (4 * TWO_PI * tension)) : INFINITY;
}

// [m/s] of a curvature of one a cell in a part of dt, of as much tension as such a part can follow.
static double pull_of(const plumb_liquid_desc *d, double dt)
{
    const double h = 2 * (double)d->spacing,
                 pull = (double)d->tension * dt / ((double)d->density * h * h);
    const double most = h / (4 * TWO_PI * dt);
    return pull < most ? pull : most;
}

static int parts_of(const plumb_world *world, double h, double dt)
{
    const plumb_particle *p = pl_liquid_items(&world->liquid);
    const uint8_t *strays = world->liquid.scratch->grid.strays;
    double most = 0;
    for (uint32_t i = 0; i < world->liquid.count; ++i) {
        if (strays[i]) {
            continue;
        }
        const double x = fabs((double)p[i].velocity.x), y = fabs((double)p[i].velocity.y);
        most = x > most ? x : most;
        most = y > most ? y : most;
    }
    most += dt * (fabs((double)world->gravity.x) + fabs((double)world->gravity.y));
    const double moving = most * dt / h / CELLS_A_PART;
    const double pulled = dt / longest_part(pl_liquid_desc(&world->liquid));
    const double parts = moving > pulled ? moving : pulled;
    return parts > MOST_PARTS ? MOST_PARTS : parts > 1 ? (int)ceil(parts) : 1;
}

static near_real kick_of(real gravity, real dt)
{
    return (near_real)pl_liquid_held((double)gravity * (double)dt, PL_LIQUID_SPEED);
}

// What grains bear pushes faces and bodies, before gravity does.
static bool bear(plumb_world *world, real dt)
{
    pl_liquid_scratch *scratch = world->liquid.scratch;
    const plumb_liquid_desc *d = pl_liquid_desc(&world->liquid);
    const double x = (double)world->gravity.x, y = (double)world->gravity.y;
    const double unit = (double)d->density * (double)scratch->grid.h / (double)dt;
    return scratch->grid.grains == NULL ||
           (pl_liquid_gather_grains(&world->memory, scratch, unit,
                                    sqrt(x * x + y * y) * (double)dt) &&
            pl_liquid_push_shear(&world->memory, scratch));
}

// Viscosity, and grains that rub. Gravity is balanced before: else walls would hold back what only gravity moves, and a tank at rest
// would stir itself.
static bool rub(pl_memory *memory, pl_liquid_scratch *scratch, double amount)
{
    pl_liquid_grid *g = &scratch->grid;
    if (amount == 0 && g->grains == NULL) {
        return true;
    }
    if (!pl_liquid_project(memory, scratch, g->drag)) {
        return false;
    }
    if (g->grains != NULL) {
        pl_liquid_press_grains(g);
    }
    pl_liquid_follow_bodies(g);
    if (!pl_liquid_diffuse(memory, scratch, amount)) {
        return false;
    }
    pl_liquid_follow_bodies(g);
    return true;
}

// Part i of a step, of all particles in `moved`.
static bool run_part(plumb_world *world, real dt, int i, int parts)
{
    pl_liquid_scratch *scratch = world->liquid.scratch;
    pl_liquid_grid *g = &scratch->grid;
    pl_memory *memory = &world->memory;
    const plumb_liquid_desc *d = pl_liquid_desc(&world->liquid);
    plumb_particle *moved = scratch->moved.data;
    const double h = 2 * (double)d->spacing;
    const uint32_t count = world->liquid.count;
    pl_liquid_pull_bodies(world, g, dt);
    if ((i > 0 && !pl_liquid_find_spots(memory, scratch, moved, count)) || // else strays had these
        !pl_liquid_grid_build(memory, scratch, moved, count) ||
        !pl_liquid_close_faces(memory, scratch) || !pl_liquid_sum_cells(memory, scratch)) {
        return false;
    }
    pl_liquid_to_grid(g);
    if (!pl_liquid_plan(memory, scratch) ||
        (i == 0 && !pl_liquid_foresee_soft(world, g, dt * (real)parts))) {
        return false;
    }
    pl_liquid_pull_nodes(g, 1.0 / parts);
    pl_liquid_extrapolate(g, g->u, g->v, 2);
    const double push = (double)d->density * h * h;
    g->drag = push;
    if (!bear(world, dt)) {
        return false;
    }
    pl_liquid_accelerate(g, kick_of(world->gravity.x, dt), kick_of(world->gravity.y, dt));
    if (d->tension > 0 && !pl_liquid_tighten(memory, scratch, pull_of(d, (double)dt))) {
        return false;
    }
    pl_liquid_bear_rests(g, push, (double)world->gravity.x * (double)dt,
                         (double)world->gravity.y * (double)dt);
    const double amount =
        pl_liquid_thickest(&world->liquid) / (double)d->density * (double)dt / (h * h);
    if (!rub(memory, scratch, amount) || !pl_liquid_project(memory, scratch, push)) {
        return false;
    }
    if (d->tension > 0 || g->grains != NULL) {
        pl_liquid_forget_far(g);
    }
    pl_liquid_extrapolate(g, g->u, g->v, 2);
    pl_liquid_bound(g);
    if (g->grains != NULL) {
        pl_liquid_press_grains(g);
        pl_liquid_follow_bodies(g);
        if (!pl_liquid_strain(memory, scratch)) {
            return false;
        }
        pl_liquid_bear_shear(g, (double)dt / h);
    }
    if (!pl_liquid_even_out(memory, scratch)) {
        return false;
    }
    if (d->tension > 0) {
        pl_liquid_keep_momentum(g, scratch, (double)world->gravity.x * (double)dt,
                                (double)world->gravity.y * (double)dt);
    }
    pl_liquid_move(g, (double)dt / h, moved);
    pl_liquid_place_solids(world, scratch, (double)dt);
    return true;
}

static bool make_scratch(plumb_world *world)
{
    pl_liquid *liquid = &world->liquid;
    if (liquid->scratch == NULL) {
        liquid->scratch = pl_resize(&world->memory, NULL, 0, sizeof *liquid->scratch);
        if (liquid->scratch != NULL) {
            *liquid->scratch = (pl_liquid_scratch){ .push_count = 0 };
        }
    }
    return liquid->scratch != NULL;
}

plumb_result pl_run_liquid(plumb_world *world, plumb_real dt)
{
    pl_liquid *liquid = &world->liquid;
    const size_t bytes = liquid->count * sizeof(plumb_particle);
    const double h = 2 * (double)pl_liquid_desc(liquid)->spacing;
    if (!make_scratch(world)) {
        return PLUMB_E_MEMORY;
    }
    pl_liquid_scratch *scratch = liquid->scratch;
    scratch->push_count = 0;
    scratch->grid.h = (near_real)h;
    scratch->grid.tasks = world->tasks;
    scratch->grid.kernels = pl_liquid_kernels_for(world->desc.simd_width);
    scratch->grid.films = true;
    scratch->grid.body_count = scratch->grid.solid_count = 0;
    const pl_liquid_region region = pl_liquid_region_of(liquid);
    if (!pl_buffer_reserve(&world->memory, &scratch->moved, bytes) ||
        !pl_liquid_find_solids(world, scratch, region, dt) ||
        !pl_liquid_find_soft(world, scratch, region, dt) ||
        !pl_liquid_recall_supports(&world->memory, &liquid->supports, scratch) ||
        !pl_liquid_reserve_touches(&world->memory, liquid)) {
        return PLUMB_E_MEMORY;
    }
    if (liquid->count == 0) { // it has gone, which those whom it touched have not been told
        return PLUMB_OK;
    }
    memcpy(scratch->moved.data, liquid->particles.data, bytes);
    pl_liquid_find_mixture(liquid, world->gravity);
    pl_liquid_find_grains(liquid);
    pl_liquid_place_solids(world, scratch, 0);
    if (!pl_liquid_find_strays(&world->memory, scratch, scratch->moved.data, liquid->count)) {
        return PLUMB_E_MEMORY;
    }
    const int parts = parts_of(world, h, (double)dt);
    for (int i = 0; i < parts; ++i) {
        if (!run_part(world, dt / (real)parts, i, parts)) {
            return PLUMB_E_MEMORY;
        }
    }
    pl_liquid_fly(&scratch->grid, world->gravity, (double)dt, scratch->moved.data, liquid->count);
    pl_liquid_push_soft(world, &scratch->grid, (double)dt);
    pl_liquid_push_rows(world, scratch, dt);
    return PLUMB_OK;
}

plumb_result pl_run_liquid_motion(plumb_world *world, plumb_real dt)
{
    pl_liquid *liquid = &world->liquid;
    const uint32_t notes = pl_liquid_note_supports(world, &liquid->supports, liquid->scratch, dt);
    pl_liquid_tell_touches(world, (double)dt);
    pl_liquid_take_supports(&liquid->supports, liquid->scratch, notes);
    pl_soft_drop_pushes(world);
    if (liquid->count > 0) {
        memcpy(liquid->particles.data, liquid->scratch->moved.data,
               liquid->count * sizeof(plumb_particle));
    }
    liquid->scratch->push_count = 0;
    liquid->index.fresh = false;
    world->schedule_dirty |= liquid->count == 0; // the last to be told are
    return PLUMB_OK;
}

void pl_liquid_undo(plumb_world *world)
{
    pl_liquid_unpush_rows(world, world->liquid.scratch);
    pl_soft_drop_pushes(world);
}
