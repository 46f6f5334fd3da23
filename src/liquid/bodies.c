// bodies.c - shapes of the world as solids in the liquid's grid, and what the liquid does to bodies.
//
// The liquid has copies of the bodies near it, which fall and are pushed within the step; the rigid solver is handed
// the impulses as forces, before it looks for contacts. What sleeps is pushed as well: the same force every step lets it
// sleep on, another one wakes it (world/push.c).
//
// Reads: rows, pieces, particles. Writes: bodies and solids of the grid; forces, with what they were, so that a
// refused step can be undone. Cost: O(bodies + pieces), and the links of what is near.
#include "liquid/liquid.h"
#include "math/trig.h"
#include "world/push.h"
#include "world/rows.h"

#include <math.h>
#include <string.h>

#define MARGIN 6.0 // cells round the particles in which solids are looked for
// [cells] across: less of a body, drawn in by films, would not always have a line of the grid within. Without films it is a cell.
#define THIN 1.5

typedef pl_liquid_region region;

pl_liquid_region pl_liquid_region_of(const pl_liquid *liquid)
{
    const plumb_particle *p = pl_liquid_items(liquid);
    const double margin = MARGIN * (double)liquid->scratch->grid.h;
    region r = { INFINITY, INFINITY, -INFINITY, -INFINITY };
    for (uint32_t i = 0; i < liquid->count; ++i) {
        const double x = (double)p[i].position.x, y = (double)p[i].position.y;
        r.low_x = x < r.low_x ? x : r.low_x, r.high_x = x > r.high_x ? x : r.high_x;
        r.low_y = y < r.low_y ? y : r.low_y, r.high_y = y > r.high_y ? y : r.high_y;
    }
    return (region){ r.low_x - margin, r.low_y - margin, r.high_x + margin, r.high_y + margin };
}

//---- what is near --------------------------------------------------------------------------------

static bool is_near(const plumb_world *world, uint32_t piece, const region *r, double way)
{
    const pl_box box = pl_piece_tight_box(world, piece);
    return (double)box.min_x - way < r->high_x && (double)box.max_x + way > r->low_x &&
           (double)box.min_y - way < r->high_y && (double)box.max_y + way > r->low_y;
}

// [cells] across, at the narrowest.
static double width_of(const plumb_convex *shape, double scale)
{
    double least = shape->count > 2 ? INFINITY : 0;
    for (int i = 0; i < shape->count && shape->count > 2; ++i) {
        const plumb_vec2 a = shape->points[i], b = shape->points[(i + 1) % shape->count];
        const double dx = (double)b.x - (double)a.x, dy = (double)b.y - (double)a.y;
        const double length = sqrt(dx * dx + dy * dy);
        double most = 0;
        for (int k = 0; k < shape->count; ++k) {
            const double x = (double)shape->points[k].x - (double)a.x;
            const double y = (double)shape->points[k].y - (double)a.y;
            const double d = (x * dy - y * dx) / length;
            most = -d > most ? -d : most;
        }
        least = most < least ? most : least;
    }
    return (least + 2 * (double)shape->radius) * scale;
}

static bool add_solid(plumb_world *world, pl_liquid_scratch *scratch, uint32_t piece, uint32_t body)
{
    pl_liquid_grid *g = &scratch->grid;
    plumb_convex shape;
    if (!pl_buffer_reserve(&world->memory, &scratch->solids,
                           (g->solid_count + 1) * sizeof(pl_liquid_solid))) {
        return false;
    }
    g->solids = scratch->solids.data;
    pl_liquid_solid *s = &g->solids[g->solid_count++];
    pl_piece_convex(world, piece, &shape);
    const double scale = 1 / (double)g->h;
    memset(s, 0, sizeof *s);
    s->piece = piece;
    s->body = body;
    s->count = shape.count;
    s->radius = (double)shape.radius * scale;
    s->width = width_of(&shape, scale);
    s->thin = s->width < (g->films && body != PL_LIQUID_NONE ? THIN : 1);
    s->exits = UINT32_MAX;
    return true;
}

static bool add_body(plumb_world *world, pl_liquid_scratch *scratch, uint32_t row)
{
    pl_liquid_grid *g = &scratch->grid;
    const pl_bodies *b = &world->bodies;
    if (!pl_buffer_reserve(&world->memory, &scratch->bodies,
                           (g->body_count + 1) * sizeof(pl_liquid_body)) ||
        !pl_buffer_reserve(&world->memory, &scratch->pushes,
                           (g->body_count + 1) * sizeof(pl_liquid_push))) {
        return false;
    }
    g->bodies = scratch->bodies.data;
    const bool locked_x = (b->flags[row] & PL_BODY_LOCK_X) != 0;
    const bool locked_y = (b->flags[row] & PL_BODY_LOCK_Y) != 0;
    g->bodies[g->body_count++] = (pl_liquid_body){
        .body = b->entity[row],
        .x = (double)b->center_x[row],
        .y = (double)b->center_y[row],
        .c = (double)b->c[row],
        .s = (double)b->s[row],
        .vx = (double)b->vx[row],
        .vy = (double)b->vy[row],
        .w = (double)b->w[row],
        .inv_mass_x = locked_x ? 0 : (double)b->inv_mass[row],
        .inv_mass_y = locked_y ? 0 : (double)b->inv_mass[row],
        .inv_inertia = (double)b->inv_inertia[row],
        .moves = b->type[row] == PLUMB_DYNAMIC,
    };
    return true;
}

// The pieces of a row that are near; its body only if there are any.
static bool add_row(plumb_world *world, pl_liquid_scratch *scratch, uint32_t row, const region *r,
                    real dt)
{
    const pl_bodies *b = &world->bodies;
    const pl_pieces *pieces = &world->pieces;
    const bool is_static = b->type[row] == PLUMB_STATIC;
    const double way = is_static ? 0
                                 : (fabs((double)b->vx[row]) + fabs((double)b->vy[row]) +
                                    fabs((double)b->w[row]) * (double)b->extent[row]) *
                                       (double)dt;
    uint32_t body = PL_LIQUID_NONE;
    for (uint32_t p = b->first_piece[row]; p != PL_NONE; p = pieces->next_in_body[p]) {
        if ((pieces->flags[p] & PL_PIECE_SENSOR) != 0 || !is_near(world, p, r, way)) {
            continue;
        }
        if (!is_static && body == PL_LIQUID_NONE) {
            body = scratch->grid.body_count;
            if (!add_body(world, scratch, row)) {
                return false;
            }
        }
        if (!add_solid(world, scratch, p, body)) {
            return false;
        }
    }
    return true;
}

bool pl_liquid_find_solids(plumb_world *world, pl_liquid_scratch *scratch, pl_liquid_region r,
                           real dt)
{
    const uint32_t end = pl_partition_first(world, PL_PART_DISABLED);
    for (int yields = 0; yields < 2; ++yields) { // a face that the ground closes is the ground's
        for (uint32_t row = 0; row < end; ++row) {
            if ((world->bodies.type[row] == PLUMB_DYNAMIC) == yields &&
                !add_row(world, scratch, row, &r, dt)) {
                return false;
            }
        }
    }
    return true;
}

//---- within the step -----------------------------------------------------------------------------

void pl_liquid_pull_bodies(const plumb_world *world, pl_liquid_grid *g, real dt)
{
    const pl_bodies *b = &world->bodies;
    for (uint32_t i = 0; i < g->body_count; ++i) {
        pl_liquid_body *body = &g->bodies[i];
        const uint32_t row = pl_body_row(world, body->body);
        if (!body->moves) {
            continue;
        }
        const double h = (double)dt, fall = h * (double)b->gravity_scale[row];
        const bool falls_x = body->inv_mass_x > 0, falls_y = body->inv_mass_y > 0;
        body->vx += falls_x ? fall * (double)world->gravity.x : 0;
        body->vy += falls_y ? fall * (double)world->gravity.y : 0;
        body->vx += h * ((double)b->fx[row] + body->held[0]) * body->inv_mass_x;
        body->vy += h * ((double)b->fy[row] + body->held[1]) * body->inv_mass_y;
        body->w += h * ((double)b->torque[row] + body->held[2]) * body->inv_inertia;
    }
}

void pl_liquid_hold_newcomers(const plumb_world *world, pl_liquid_grid *g)
{
    const pl_bodies *b = &world->bodies;
    for (uint32_t i = 0; i < g->body_count; ++i) {
        pl_liquid_body *body = &g->bodies[i];
        if (!body->moves || body->known) {
            continue;
        }
        const uint32_t row = pl_body_row(world, body->body);
        const double scale = (double)b->gravity_scale[row];
        const double x = body->inv_mass_x > 0 ? scale / body->inv_mass_x : 0;
        const double y = body->inv_mass_y > 0 ? scale / body->inv_mass_y : 0;
        body->held[0] = -(x * (double)world->gravity.x + (double)b->fx[row]);
        body->held[1] = -(y * (double)world->gravity.y + (double)b->fy[row]);
        body->held[2] = -(double)b->torque[row];
    }
}

static double least(double a, double b)
{
    return a < b ? a : b;
}

void pl_liquid_find_reach(pl_liquid_solid *s)
{
    s->low_x = s->low_y = INFINITY;
    s->high_x = s->high_y = -INFINITY;
    for (int i = 0; i < s->count; ++i) {
        const int k = i + 1 < s->count ? i + 1 : 0;
        const double dx = s->x[k] - s->x[i], dy = s->y[k] - s->y[i];
        const double length = sqrt(dx * dx + dy * dy);
        s->nx[i] = length > 0 ? dy / length : 0;
        s->ny[i] = length > 0 ? -dx / length : 0;
        s->low_x = least(s->low_x, s->x[i] - s->radius);
        s->low_y = least(s->low_y, s->y[i] - s->radius);
        s->high_x = -least(-s->high_x, -s->x[i] - s->radius);
        s->high_y = -least(-s->high_y, -s->y[i] - s->radius);
    }
}

static void place_solid(const plumb_world *world, const pl_liquid_grid *g, pl_liquid_solid *s)
{
    const uint32_t row = world->pieces.body[s->piece];
    const pl_bodies *b = &world->bodies;
    const pl_liquid_body *body = s->body == PL_LIQUID_NONE ? NULL : &g->bodies[s->body];
    const double scale = 1 / (double)g->h;
    const double c = body != NULL ? body->c : (double)b->c[row];
    const double sine = body != NULL ? body->s : (double)b->s[row];
    const double x = body != NULL ? body->x : (double)b->center_x[row];
    const double y = body != NULL ? body->y : (double)b->center_y[row];
    plumb_convex shape;
    pl_piece_convex(world, s->piece, &shape);
    for (int i = 0; i < s->count; ++i) {
        const double px = (double)shape.points[i].x - (double)b->local_x[row];
        const double py = (double)shape.points[i].y - (double)b->local_y[row];
        s->x[i] = (x + c * px - sine * py) * scale;
        s->y[i] = (y + sine * px + c * py) * scale;
    }
    pl_liquid_find_reach(s);
}

void pl_liquid_place_solids(plumb_world *world, pl_liquid_scratch *scratch, double dt)
{
    pl_liquid_grid *g = &scratch->grid;
    for (uint32_t i = 0; i < g->body_count; ++i) {
        pl_liquid_body *b = &g->bodies[i];
        double s, c;
        pl_sincos(b->w * dt, &s, &c);
        const double turned = b->c * c - b->s * s;
        b->s = b->s * c + b->c * s;
        b->c = turned;
        b->x += b->vx * dt;
        b->y += b->vy * dt;
    }
    pl_liquid_place_nodes(g, dt);
    for (uint32_t i = 0; i < g->solid_count; ++i) {
        if (g->solids[i].piece != PL_LIQUID_NONE) {
            place_solid(world, g, &g->solids[i]);
        } else if (g->solids[i].soft) {
            pl_liquid_place_triangle(g, &g->solids[i]);
        }
    }
    if (dt == 0 && g->films) { // as the step begins: pieces keep where they lie in a body
        pl_liquid_find_inner(g);
    }
    for (uint32_t i = 0; i < g->solid_count; ++i) {
        if (pl_liquid_yields(g, &g->solids[i])) {
            pl_liquid_draw_in(&g->solids[i]);
        }
    }
}

//---- what they get -------------------------------------------------------------------------------

void pl_liquid_push_rows(plumb_world *world, pl_liquid_scratch *scratch, real dt)
{
    pl_bodies *b = &world->bodies;
    pl_liquid_push *pushes = scratch->pushes.data;
    for (uint32_t i = 0; i < scratch->grid.body_count; ++i) {
        const pl_liquid_body *body = &scratch->grid.bodies[i];
        if (!body->moves || (body->impulse_x == 0 && body->impulse_y == 0 && body->turn == 0)) {
            continue;
        }
        const uint32_t row = pl_body_row(world, body->body);
        pushes[scratch->push_count++] =
            (pl_liquid_push){ body->body, b->fx[row], b->fy[row], b->torque[row] };
        pl_sleep_push(world, row);
        b->fx[row] = pl_held((double)b->fx[row] + body->impulse_x / (double)dt);
        b->fy[row] = pl_held((double)b->fy[row] + body->impulse_y / (double)dt);
        b->torque[row] = pl_held((double)b->torque[row] + body->turn / (double)dt);
    }
}

void pl_liquid_unpush_rows(plumb_world *world, pl_liquid_scratch *scratch)
{
    while (scratch != NULL && scratch->push_count > 0) {
        const pl_liquid_push *pushes = scratch->pushes.data;
        const pl_liquid_push *p = &pushes[--scratch->push_count];
        const uint32_t row = pl_body_row(world, p->body); // it may have moved: bodies woke
        world->bodies.fx[row] = p->fx;
        world->bodies.fy[row] = p->fy;
        world->bodies.torque[row] = p->torque;
    }
}
