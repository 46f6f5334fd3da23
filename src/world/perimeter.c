// perimeter.c - the surface of a body: its pieces one after another, of each its sides, then its round.
//
// The round of a piece of radius r is a circle of that radius, cut at corners and moved to them: 2 pi r in all, and at an
// angle it is at the corner that lies farthest that way. Reads: pieces. Cost: O(corners).
#include "world/perimeter.h"

#include "math/trig.h"
#include "plumb/math.h"

#include <math.h>

#define TURN 6.283185307179586

static bool has_surface(const plumb_world *world, uint32_t piece)
{
    const pl_pieces *p = &world->pieces;
    return (p->flags[piece] & PL_PIECE_SENSOR) == 0 &&
           (p->kind[piece] != PL_PIECE_CAPSULE || p->core[piece].radius > 0);
}

static bool is_open(const plumb_world *world, uint32_t piece, const plumb_convex *c, int side)
{
    return c->count > 1 && (world->pieces.cuts[piece] >> side & 1u) == 0;
}

static plumb_vec2 corner(const plumb_convex *c, int k)
{
    return c->points[k < c->count ? k : 0];
}

static double side_of(const plumb_convex *c, int k)
{
    const plumb_vec2 a = corner(c, k), b = corner(c, k + 1);
    const double x = (double)b.x - (double)a.x, y = (double)b.y - (double)a.y;
    return sqrt(x * x + y * y);
}

static double length_of(const plumb_world *world, uint32_t piece, const plumb_convex *c)
{
    double sum = TURN * (double)c->radius;
    for (int k = 0; k < c->count; ++k) {
        sum += is_open(world, piece, c, k) ? side_of(c, k) : 0;
    }
    return sum;
}

double pl_perimeter(const plumb_world *world, uint32_t row)
{
    double sum = 0;
    for (uint32_t p = world->bodies.first_piece[row]; p != PL_NONE;
         p = world->pieces.next_in_body[p]) {
        if (has_surface(world, p)) {
            plumb_convex c;
            pl_piece_convex(world, p, &c);
            sum += length_of(world, p, &c);
        }
    }
    return sum;
}

double pl_body_area(const plumb_world *world, uint32_t row)
{
    double sum = 0;
    for (uint32_t p = world->bodies.first_piece[row]; p != PL_NONE;
         p = world->pieces.next_in_body[p]) {
        sum += has_surface(world, p) ? (double)world->pieces.area[p].mass : 0;
    }
    return sum;
}

// On the round of a piece, in the frame of the body.
static plumb_vec2 place_on_round(const plumb_convex *c, double way)
{
    double s, co;
    pl_sincos(way / (double)c->radius, &s, &co);
    int farthest = 0;
    double most = -HUGE_VAL;
    for (int k = 0; k < c->count; ++k) {
        const double along = co * (double)c->points[k].x + s * (double)c->points[k].y;
        if (along > most) {
            most = along;
            farthest = k;
        }
    }
    const double r = (double)c->radius;
    return plumb_v2((real)((double)c->points[farthest].x + r * co),
                    (real)((double)c->points[farthest].y + r * s));
}

static plumb_vec2 place_on(const plumb_world *world, uint32_t piece, const plumb_convex *c,
                           double way)
{
    for (int k = 0; k < c->count; ++k) {
        if (!is_open(world, piece, c, k)) {
            continue;
        }
        const double side = side_of(c, k);
        if (way < side) {
            const plumb_vec2 at =
                plumb_vec2_lerp(corner(c, k), corner(c, k + 1), (real)(way / side));
            return plumb_vec2_add(at, plumb_vec2_scale(c->radius, c->normals[k]));
        }
        way -= side;
    }
    return c->radius > 0 ? place_on_round(c, way) : c->points[0];
}

plumb_vec2 pl_perimeter_place(const plumb_world *world, uint32_t row, double way)
{
    const pl_bodies *b = &world->bodies;
    plumb_vec2 local = plumb_v2(b->local_x[row], b->local_y[row]);
    for (uint32_t p = b->first_piece[row]; p != PL_NONE; p = world->pieces.next_in_body[p]) {
        if (!has_surface(world, p)) {
            continue;
        }
        plumb_convex c;
        pl_piece_convex(world, p, &c);
        const double length = length_of(world, p, &c);
        local = place_on(world, p, &c, way < length ? way : length);
        if (way <= length) {
            break;
        }
        way -= length;
    }
    return plumb_v2(b->x[row] + b->c[row] * local.x - b->s[row] * local.y,
                    b->y[row] + b->s[row] * local.x + b->c[row] * local.y);
}
