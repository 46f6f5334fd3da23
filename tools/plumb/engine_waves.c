/// engine_waves.c - water whose surface has waves, drawn as strips up to where the surface is.
///
/// Cost: O(strips modes).
#include <math.h>

#include "engine_session.h"
#include "../render/render.h"

enum { STRIPS = 240 };

/// What of a convex piece lies below `level`, against gravity along y; returns how many points.
static size_t below_level(const plumb_convex *piece, plumb_transform where, double up, double level,
                          render_vec out[2 * PLUMB_POLYGON_MAX_VERTICES])
{
    size_t count = 0;
    for (int i = 0; i < piece->count; i++) {
        const plumb_vec2 p = plumb_transform_apply(where, piece->points[i]);
        const plumb_vec2 q = plumb_transform_apply(where, piece->points[(i + 1) % piece->count]);
        const double a = up * (double)p.y - level, b = up * (double)q.y - level;
        if (a <= 0) {
            out[count++] = (render_vec){ (double)p.x, (double)p.y };
        }
        if ((a <= 0) != (b <= 0)) {
            const double share = a / (a - b);
            out[count++] = (render_vec){ (double)p.x + share * ((double)q.x - (double)p.x),
                                         (double)p.y + share * ((double)q.y - (double)p.y) };
        }
    }
    return count;
}

bool pl_stage_add_waves(const engine_stage *stage, plumb_shape shape, plumb_transform where,
                        struct render_frame *frame)
{
    const plumb_world *world = stage->world;
    const double up = (double)plumb_world_gravity(world).y < 0 ? 1 : -1;
    plumb_convex piece;
    if (plumb_waves_modes(world, shape, NULL) == NULL ||
        plumb_shape_piece(world, shape, 0, &piece, NULL) != PLUMB_OK) {
        return false;
    }
    const plumb_aabb box = plumb_shape_aabb(world, shape);
    const double left = (double)box.min.x, width = (double)box.max.x - left;
    render_vec surface[STRIPS + 1], bulk[2 * PLUMB_POLYGON_MAX_VERTICES];
    double level = INFINITY;
    for (int i = 0; i <= STRIPS; i++) {
        const double x = left + width * i / STRIPS;
        // Not beyond the box: at its very ends a rounded x lies outside.
        const double inside = fmin(fmax(x, left + 1e-6 * width), left + (1 - 1e-6) * width);
        surface[i] = (render_vec){ x, (double)plumb_waves_at(world, shape, (plumb_real)inside).y };
        level = fmin(level, up * surface[i].y);
    }
    // Strips only above the lowest place: their seams would show.
    const size_t count = below_level(&piece, where, up, level, bulk);
    if (count > 2) {
        render_add_polygon(frame, bulk, count, 0);
    }
    for (int i = 0; i < STRIPS; i++) {
        const render_vec strip[4] = { { surface[i].x, up * level },
                                      { surface[i + 1].x, up * level },
                                      surface[i + 1],
                                      surface[i] };
        render_add_polygon(frame, strip, 4, 0);
    }
    render_add_polyline(frame, surface, STRIPS + 1, 0, 0);
    return true;
}
