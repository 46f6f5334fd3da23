// extent.c - how thin a body is and how far it reaches: what the continuous pass measures motion by.
//
// A body passes through a thing without thickness only when its middle does. A piece whose points
// all move less than half of its half width from a place on one side is still on that side, and the
// contact puts it right: its slack. That of a body is the least of its pieces.
//
// Reads: piece geometry, centre of mass. Writes: extent, slack. Cost: O(pieces of the body), with
// the square of the corners of a polygon.
#include "plumb/math.h"
#include "world/rows.h"

// Share of the half width that may be moved in a step without a sweep.
#define SLACK_SHARE ((real)0.5)
// [m] half the thickness that a body of lines is taken to have.
#define LINE_HALF_WIDTH ((real)0.005)

// Half of the least width of a polygon's core across an edge that is a side.
static real polygon_half_width(const plumb_world *world, uint32_t piece, bool cuts)
{
    const pl_vertex *v = world->vertices.items + world->pieces.vertices[piece];
    int count = world->pieces.vertex_count[piece];
    real least = PLUMB_REAL_MAX;
    for (int i = 0; i < count; ++i) {
        if (cuts && (world->pieces.cuts[piece] >> i & 1u) != 0) {
            continue;
        }
        real width = 0;
        for (int k = 0; k < count; ++k) {
            real depth = (v[i].x - v[k].x) * v[i].nx + (v[i].y - v[k].y) * v[i].ny;
            width = depth > width ? depth : width;
        }
        least = width / 2 < least ? width / 2 : least;
    }
    return least;
}

real pl_piece_half_width(const plumb_world *world, uint32_t piece, bool cuts)
{
    const pl_core *core = &world->pieces.core[piece];
    switch (world->pieces.kind[piece]) {
    case PL_PIECE_BOX:
        return core->hx < core->hy ? core->hx : core->hy;
    case PL_PIECE_POLYGON: {
        real half = polygon_half_width(world, piece, cuts);
        return half < PLUMB_REAL_MAX ? half + core->radius : half;
    }
    default:
        return core->radius;
    }
}

// [m] of the piece's farthest point from the centre of mass.
static real reach_of(const plumb_world *world, uint32_t piece, plumb_vec2 center)
{
    plumb_convex convex;
    pl_piece_convex(world, piece, &convex);
    real farthest = 0;
    for (int i = 0; i < convex.count; ++i) {
        real distance = plumb_vec2_distance(convex.points[i], center);
        farthest = distance > farthest ? distance : farthest;
    }
    return farthest + convex.radius;
}

void pl_extent_revise(plumb_world *world, uint32_t row)
{
    pl_bodies *b = &world->bodies;
    if (b->type[row] == PLUMB_STATIC) {
        return;
    }
    plumb_vec2 center = { b->local_x[row], b->local_y[row] };
    real extent = 0, half = PLUMB_REAL_MAX;
    for (uint32_t p = b->first_piece[row]; p != PL_NONE; p = world->pieces.next_in_body[p]) {
        if ((world->pieces.flags[p] & PL_PIECE_SENSOR) != 0) {
            continue;
        }
        real reach = reach_of(world, p, center);
        real width = pl_piece_half_width(world, p, true);
        extent = reach > extent ? reach : extent;
        width = width > 0 ? width : LINE_HALF_WIDTH;
        half = width < half ? width : half;
    }
    // What turns must not count as slow for want of shapes.
    real gyration = b->mass[row] > 0 ? plumb_sqrt(b->inertia[row] / b->mass[row]) : 0;
    b->extent[row] = extent > gyration ? extent : gyration;
    b->slack[row] = half < PLUMB_REAL_MAX ? half * SLACK_SHARE : PLUMB_REAL_MAX;
    if (b->slack[row] < world->continuous.least_slack) {
        world->continuous.least_slack = b->slack[row];
    }
}
