// step.c - the air's two passes.
//
// "air" comes before the broad phase, as the liquid does: bodies are pushed before contacts are looked for. It leaves the
// air as it will be in scratch, and "air motion", behind the last pass that can run out of memory, takes that over; so a
// refused step has changed nothing.
//
// A step is advection-reflection (Zehnder, Narain, Thomaszewski 2018): half a step with the velocities that there are, a projection,
// which is undone as often again, and half a step with the velocities of the middle, and a projection. What the first
// projection takes of the energy the reflection gives back, so what turns keeps turning: of second order in time, at the price
// of two solutions of the same matrix. Smoke and heat are carried by the velocities of the middle. A projection takes bodies along,
// and is reflected for them, too: the impulse of the first counts twice.
//
// Reads: cells, supports, gravity, poses, velocities, masses, forces, pieces. Writes: forces, cells, supports. Cost: see DECISIONS.md.
#include "air/air.h"
#include "schema/passes.h"
#include "world/rows.h"

#include <math.h>
#include <string.h>

#define MOST_PARTS        8   // of a step
#define CELLS_A_PART      8.0 // that air may cross
#define BODY_CELLS_A_PART 1.0 // that bodies may
#define MARGIN            2   // cells round the box in which solids are looked for
#define SOLVE_TO          1e-4
#define REST              1e-6 // [m/s], [rad/s] of air and bodies: what is slower does not flow

bool pl_want_air(const plumb_world *world, const char **reason)
{
    const bool wanted = world->air.cell_count > 0;
    *reason = wanted ? "there is air" : "there is no air";
    return wanted;
}

//---- what there is to do -------------------------------------------------------------------------

static double greater(double a, double b)
{
    return a > b ? a : b;
}

// [m/s]
static double fastest_body(const pl_liquid_grid *g)
{
    double most = 0;
    for (uint32_t i = 0; i < g->body_count; ++i) {
        const pl_liquid_body *b = &g->bodies[i];
        most = greater(most, greater(fabs(b->vx), fabs(b->vy)));
    }
    // Corners of what turns.
    for (uint32_t i = 0; i < g->solid_count; ++i) {
        const pl_liquid_solid *s = &g->solids[i];
        if (s->body != PL_LIQUID_NONE && s->piece != PL_LIQUID_NONE) {
            const double size = greater(s->high_x - s->low_x, s->high_y - s->low_y);
            most = greater(most, fabs(g->bodies[s->body].w) * size * (double)g->h);
        }
    }
    return most;
}

static double fastest_air(const pl_air *air)
{
    const plumb_air_cell *c = pl_air_items(air);
    double most = 0;
    for (uint32_t i = 0; i < air->cell_count; ++i) {
        most = greater(most, greater(fabs((double)c[i].u), fabs((double)c[i].v)));
    }
    return most;
}

static int parts_of(const plumb_world *world, double dt)
{
    const double h = (double)pl_air_desc(&world->air)->cell;
    const double air = fastest_air(&world->air) * dt / h / CELLS_A_PART;
    const double body = fastest_body(&world->air.scratch->liquid.grid) * dt / h / BODY_CELLS_A_PART;
    const double parts = greater(air, body);
    return parts > MOST_PARTS ? MOST_PARTS : parts > 1 ? (int)ceil(parts) : 1;
}

// Nothing flows, nothing drives it.
static bool is_still(const plumb_world *world)
{
    const pl_air *air = &world->air;
    const plumb_air_desc *d = pl_air_desc(air);
    const plumb_air_cell *c = pl_air_items(air);
    const bool driven = d->left == PLUMB_AIR_FLOW || d->right == PLUMB_AIR_FLOW ||
                        d->bottom == PLUMB_AIR_FLOW || d->top == PLUMB_AIR_FLOW;
    if (air->source_count > 0 || (driven && (d->flow.x != 0 || d->flow.y != 0))) {
        return false;
    }
    const pl_liquid_grid *g = &air->scratch->liquid.grid;
    for (uint32_t i = 1; i < g->body_count; ++i) {
        const pl_liquid_body *b = &g->bodies[i];
        if (fabs(b->vx) > REST || fabs(b->vy) > REST || fabs(b->w) > REST) {
            return false;
        }
    }
    for (uint32_t i = 0; i < air->cell_count; ++i) {
        if (c[i].heat != 0 || (c[i].smoke != 0 && d->fading > 0)) {
            return false;
        }
    }
    return fastest_air(air) <= REST;
}

//---- a part of the step --------------------------------------------------------------------------

// What bodies got since faces followed them.
static void find_gain(const pl_liquid_grid *g, double (*gain)[3])
{
    for (uint32_t i = 0; i < g->body_count; ++i) {
        const pl_liquid_body *b = &g->bodies[i];
        gain[i][0] = b->vx - b->seen[0];
        gain[i][1] = b->vy - b->seen[1];
        gain[i][2] = b->w - b->seen[2];
    }
}

// What a projection gave bodies, once more.
static void reflect_bodies(pl_liquid_grid *g, double (*gain)[3])
{
    for (uint32_t i = 0; i < g->body_count; ++i) {
        pl_liquid_body *b = &g->bodies[i];
        const double *m = gain[i];
        b->vx += m[0], b->vy += m[1], b->w += m[2];
        b->impulse_x += b->inv_mass_x > 0 ? m[0] / b->inv_mass_x : 0;
        b->impulse_y += b->inv_mass_y > 0 ? m[1] / b->inv_mass_y : 0;
        b->turn += b->inv_inertia > 0 ? m[2] / b->inv_inertia : 0;
    }
}

static void reflect(pl_air_scratch *s)
{
    const size_t count = pl_air_column_bytes(s) / sizeof(near_real);
    for (size_t k = 0; k < count; ++k) {
        s->u[k] += s->open_u[k] > 0 ? s->u[k] - s->now[k] : 0;
        s->v[k] += s->open_v[k] > 0 ? s->v[k] - s->now_v[k] : 0;
    }
}

typedef struct part {
    plumb_world *world;
    const plumb_air_desc *d;
    pl_air_scratch *s;
    double h, push; // [m], [kg]
    double (*gain)[3];
} part;

// Half a part: carried, driven, slowed by viscosity, and made free of divergence. `now` gets what there was before that.
static bool run_half(const part *p, double dt)
{
    pl_air_scratch *s = p->s;
    pl_liquid_grid *g = &s->liquid.grid;
    pl_memory *memory = &p->world->memory;
    const size_t bytes = pl_air_column_bytes(s);
    const double amount = (double)p->d->viscosity * dt / (p->h * p->h);
    pl_air_carry_velocities(s, p->d, p->world->tasks, dt, p->h);
    pl_air_drive(p->world, s, dt);
    pl_liquid_pull_bodies(p->world, g, (real)dt);
    pl_liquid_follow_bodies(g);
    pl_air_to_grid(s);
    if (amount > 0) {
        g->drag = p->push;
        if (!pl_liquid_diffuse(memory, &s->liquid, amount)) {
            return false;
        }
        pl_liquid_follow_bodies(g);
        pl_air_from_grid(s);
    }
    memcpy(s->now, s->u, bytes);
    memcpy(s->now_v, s->v, bytes);
    pl_liquid_find_inflow(g);
    if (!pl_liquid_balance_rooms(memory, &s->liquid)) {
        return false;
    }
    pl_liquid_solve(g, p->push, SOLVE_TO, 0);
    pl_liquid_take_pressure(g, p->push);
    find_gain(g, p->gain);
    pl_liquid_follow_bodies(g);
    pl_liquid_extrapolate(g, g->u, g->v, 2);
    pl_liquid_bound(g);
    pl_air_from_grid(s);
    return true;
}

static bool close_faces(plumb_world *world)
{
    pl_air_scratch *s = world->air.scratch;
    if (!pl_air_make_grid(&world->memory, s, pl_air_desc(&world->air)) ||
        !pl_liquid_close_faces(&world->memory, &s->liquid)) {
        return false;
    }
    pl_air_shut_slits(s);
    return true;
}

// Solids go on, and close other faces.
static bool move_solids(plumb_world *world, double dt)
{
    pl_air_scratch *s = world->air.scratch;
    pl_liquid_place_solids(world, &s->liquid, dt);
    if (s->liquid.grid.link_count == 0 && s->liquid.grid.body_count < 2) {
        return true;
    }
    pl_air_keep_speeds(s);
    if (!close_faces(world)) {
        return false;
    }
    pl_air_uncover(s);
    return true;
}

static bool run_part(plumb_world *world, double dt)
{
    pl_air_scratch *s = world->air.scratch;
    pl_liquid_grid *g = &s->liquid.grid;
    pl_memory *memory = &world->memory;
    const plumb_air_desc *d = pl_air_desc(&world->air);
    const double h = (double)d->cell;
    if (!pl_liquid_plan(memory, &s->liquid) || !pl_air_make_wraps(memory, s, d) ||
        !pl_buffer_reserve(memory, &s->gains, g->body_count * sizeof(double[3]))) {
        return false;
    }
    const part p = { world, d, s, h, (double)d->density * h * h, s->gains.data };
    pl_air_find_room(s, d);
    pl_air_feed(world, s, dt);
    pl_air_find_fluxes(s, d);
    if (!run_half(&p, dt / 2)) {
        return false;
    }
    pl_air_find_fluxes(s, d);
    pl_air_find_filled(s, d);
    pl_air_carry_scalars(s, d, world->tasks, dt, h);
    reflect(s);
    reflect_bodies(g, p.gain);
    pl_liquid_follow_bodies(g);
    if (!run_half(&p, dt / 2)) {
        return false;
    }
    return move_solids(world, dt);
}

//---- the passes ----------------------------------------------------------------------------------

static bool make_scratch(plumb_world *world)
{
    pl_air *air = &world->air;
    if (air->scratch == NULL) {
        air->scratch = pl_resize(&world->memory, NULL, 0, sizeof *air->scratch);
        if (air->scratch != NULL) {
            *air->scratch = (pl_air_scratch){ .stride = 0 };
        }
    }
    return air->scratch != NULL;
}

static pl_liquid_region region_of(const pl_air_scratch *s, double h)
{
    return (pl_liquid_region){ (s->low_x - MARGIN) * h, (s->low_y - MARGIN) * h,
                               (s->low_x + s->columns_x + MARGIN) * h,
                               (s->low_y + s->columns_y + MARGIN) * h };
}

plumb_result pl_run_air(plumb_world *world, plumb_real dt)
{
    pl_air *air = &world->air;
    const plumb_air_desc *d = pl_air_desc(air);
    const size_t bytes = air->cell_count * sizeof(plumb_air_cell);
    const double h = (double)d->cell;
    if (!make_scratch(world)) {
        return PLUMB_E_MEMORY;
    }
    pl_air_scratch *s = air->scratch;
    s->liquid.push_count = 0;
    s->liquid.grid.h = (near_real)h;
    s->liquid.grid.tasks = world->tasks;
    s->liquid.grid.kernels = pl_liquid_kernels_for(world->desc.simd_width);
    if (!pl_buffer_reserve(&world->memory, &s->moved, bytes) ||
        !pl_air_make_columns(&world->memory, s, pl_air_extent_of(d)) ||
        !pl_air_add_sides(&world->memory, s, d) ||
        !pl_liquid_find_solids(world, &s->liquid, region_of(s, h), dt) ||
        !pl_liquid_recall_supports(&world->memory, &air->supports, &s->liquid)) {
        return PLUMB_E_MEMORY;
    }
    memcpy(s->moved.data, air->cells.data, bytes);
    pl_liquid_hold_newcomers(world, &s->liquid.grid);
    if (is_still(world)) {
        pl_liquid_pull_bodies(world, &s->liquid.grid, dt);
        return PLUMB_OK;
    }
    pl_liquid_place_solids(world, &s->liquid, 0);
    const int parts = parts_of(world, (double)dt);
    const double part_dt = (double)dt / parts;
    pl_air_load(s, pl_air_items(air), MOST_PARTS * CELLS_A_PART * h / (double)dt);
    if (!close_faces(world)) {
        return PLUMB_E_MEMORY;
    }
    for (int i = 0; i < parts; ++i) {
        if (!run_part(world, part_dt)) {
            return PLUMB_E_MEMORY;
        }
    }
    pl_air_store(s, s->moved.data);
    pl_liquid_push_rows(world, &s->liquid, dt);
    return PLUMB_OK;
}

plumb_result pl_run_air_motion(plumb_world *world, plumb_real dt)
{
    pl_air *air = &world->air;
    pl_liquid_scratch *scratch = &air->scratch->liquid;
    const uint32_t notes = pl_liquid_note_supports(world, &air->supports, scratch, dt);
    pl_liquid_take_supports(&air->supports, scratch, notes);
    memcpy(air->cells.data, air->scratch->moved.data, air->cell_count * sizeof(plumb_air_cell));
    scratch->push_count = 0;
    return PLUMB_OK;
}

void pl_air_undo(plumb_world *world)
{
    if (world->air.scratch != NULL) {
        pl_liquid_unpush_rows(world, &world->air.scratch->liquid);
    }
}
