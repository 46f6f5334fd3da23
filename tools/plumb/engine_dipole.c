/// engine_dipole.c - the needle of a dipole, as large as the body that it is of lets it be. Compiled once for each precision, as
/// engine.c.
/// Cost: O(corners of the body).
#include "engine_session.h"

#include <math.h>

#include "../render/render.h"

/// [-] of half the body along it, and of half the body across; and at most so wide for its length.
static const double LENGTH = 0.8, WIDTH = 0.6, STOUT = 0.3;

/// [m] from a place to the farthest point of the shapes along a unit vector.
static double reach(const engine_stage *stage, int count, plumb_transform where, render_vec from,
                    double ux, double uy)
{
    double most = 0;
    for (int i = 0; i < count; i++) {
        plumb_convex piece;
        for (int k = 0; k < plumb_shape_piece_count(stage->world, stage->shapes[i]); k++) {
            if (plumb_shape_piece(stage->world, stage->shapes[i], k, &piece, NULL) != PLUMB_OK) {
                continue;
            }
            for (int n = 0; n < piece.count; n++) {
                const render_vec p = pl_to_world(where, piece.points[n]);
                const double along = (p.x - from.x) * ux + (p.y - from.y) * uy;
                most = fmax(most, along + (double)piece.radius);
            }
        }
    }
    return most;
}

void pl_stage_add_dipole(const engine_stage *stage, plumb_body body, int count, render_frame *frame)
{
    const double moment = (double)plumb_body_dipole(stage->world, body);
    if (moment == 0) {
        return;
    }
    const plumb_transform where = plumb_body_transform(stage->world, body);
    const plumb_vec2 center = plumb_body_center(stage->world, body);
    const render_vec at = { (double)center.x, (double)center.y };
    const double angle = (double)plumb_body_angle(stage->world, body) +
                         (double)plumb_body_dipole_angle(stage->world, body);
    const double sign = moment > 0 ? 1 : -1, ux = sign * cos(angle), uy = sign * sin(angle);
    const double along =
        fmin(reach(stage, count, where, at, ux, uy), reach(stage, count, where, at, -ux, -uy));
    const double across =
        fmin(reach(stage, count, where, at, -uy, ux), reach(stage, count, where, at, uy, -ux));
    const double half = LENGTH * along;
    render_add_dipole(frame, at.x, at.y, half * ux, half * uy, fmin(STOUT * half, WIDTH * across));
}
