/// engine_sides.c - what is drawn at the sides of shapes: the surface of water, and from where one may come through a one-way
/// platform. Compiled once for each precision, as engine.c.
/// Cost: O(sides).
#include "engine_session.h"

#include <math.h>

#include "../render/render.h"

/// [-] of the platform's width: a sign, and from one sign to the next.
static const double SIGN = 0.07, SIGN_EVERY = 0.25;
/// [m] no sign is larger.
static const double SIGN_MOST = 0.3;

render_vec pl_to_world(plumb_transform frame, plumb_vec2 p)
{
    double c = (double)frame.q.c, s = (double)frame.q.s;
    double x = (double)p.x, y = (double)p.y;
    return (render_vec){ (double)frame.p.x + c * x - s * y, (double)frame.p.y + s * x + c * y };
}

void pl_stage_add_water_line(const plumb_world *world, plumb_shape shape, plumb_transform where,
                             render_frame *frame)
{
    const plumb_vec2 g = plumb_world_gravity(world), standing = plumb_world_up(world);
    const plumb_vec2 up = g.x != 0 || g.y != 0 ? plumb_vec2_unit(plumb_vec2_neg(g)) : standing;
    for (int i = 0; i < plumb_shape_piece_count(world, shape); i++) {
        plumb_convex piece;
        uint32_t cuts = 0;
        if (plumb_shape_piece(world, shape, i, &piece, &cuts) != PLUMB_OK || piece.count < 3) {
            continue;
        }
        for (int k = 0; k < piece.count; k++) {
            const plumb_vec2 out = plumb_rot_apply(where.q, piece.normals[k]);
            if ((cuts >> k & 1) == 0 && (double)plumb_vec2_dot(out, up) > 0.9) {
                const render_vec line[2] = { pl_to_world(where, piece.points[k]),
                                             pl_to_world(where,
                                                         piece.points[(k + 1) % piece.count]) };
                render_add_polyline(frame, line, 2, 0, 0);
            }
        }
    }
}

/// How far a shape reaches along a direction of its body and across it.
typedef struct reach {
    double low, left, right; ///< [m]
} reach;

static reach reach_of(const plumb_world *world, plumb_shape shape, plumb_vec2 along)
{
    reach r = { HUGE_VAL, HUGE_VAL, -HUGE_VAL };
    for (int i = 0; i < plumb_shape_piece_count(world, shape); i++) {
        plumb_convex piece = { .count = 0 };
        (void)plumb_shape_piece(world, shape, i, &piece, NULL);
        for (int k = 0; k < piece.count; k++) {
            const double radius = (double)piece.radius;
            const double u = (double)plumb_vec2_dot(piece.points[k], along);
            const double v = (double)plumb_vec2_dot(piece.points[k], plumb_vec2_right(along));
            r.low = fmin(r.low, u - radius);
            r.left = fmin(r.left, v - radius);
            r.right = fmax(r.right, v + radius);
        }
    }
    return r;
}

/// Where `u` along and `v` to the right of a direction of the body is.
static render_vec place_of(plumb_transform where, plumb_vec2 along, double u, double v)
{
    const plumb_vec2 right = plumb_vec2_right(along);
    return pl_to_world(where,
                       (plumb_vec2){ (plumb_real)(u * (double)along.x + v * (double)right.x),
                                     (plumb_real)(u * (double)along.y + v * (double)right.y) });
}

void pl_stage_add_one_way(const plumb_world *world, plumb_shape shape, plumb_transform where,
                          render_frame *frame)
{
    const plumb_one_way way = plumb_shape_one_way(world, shape);
    if (way.direction.x == 0 && way.direction.y == 0) {
        return;
    }
    const plumb_vec2 along = plumb_vec2_unit(way.direction);
    const reach r = reach_of(world, shape, along);
    const double width = r.right - r.left, size = fmin(SIGN * width, SIGN_MOST), tip = r.low - size;
    for (double at = SIGN_EVERY / 2; at < 1 && width > 0; at += SIGN_EVERY) {
        const double v = r.left + at * width;
        const render_vec line[3] = { place_of(where, along, tip - size, v - size),
                                     place_of(where, along, tip, v),
                                     place_of(where, along, tip - size, v + size) };
        render_add_polyline(frame, line, 3, 0, 0);
    }
}
