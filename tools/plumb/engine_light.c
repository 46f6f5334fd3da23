/// engine_light.c - beams of the scene's lamps, as a draw list. Compiled once for each precision, as engine.c.
///
/// Cost: that of their rays.
#include <math.h>
#include <stdlib.h>

#include "engine_session.h"
#include "../render/render.h"

/// Pieces of a path that are drawn, a ray.
enum { PATH_MOST = 512 };

static void add_path(const plumb_light_segment *path, int count, double whole, render_rgba color,
                     render_frame *frame)
{
    for (int i = 0; i < count; i++) {
        const plumb_light_segment *p = &path[i];
        render_add_beam(frame, (render_vec){ (double)p->from.x, (double)p->from.y },
                        (render_vec){ (double)p->to.x, (double)p->to.y },
                        fmin((double)p->power / whole, 1), fmin((double)p->power_end / whole, 1),
                        color);
    }
}

bool pl_stage_add_light(const engine_stage *stage, struct render_frame *frame)
{
    const int count = stage->scene != NULL ? scene_light_count(stage->scene) : 0;
    plumb_light_segment *path = count > 0 ? malloc(PATH_MOST * sizeof *path) : NULL;
    for (int i = 0; i < count && path != NULL; i++) {
        const scene_light light = scene_light_get(stage->scene, i);
        const render_rgba said = { light.color.r, light.color.g, light.color.b, light.color.a };
        const render_rgba color = light.palette >= 0 ? render_palette(light.palette) : said;
        for (int ray = 0; ray < light.rays; ray++) {
            const int pieces = scene_light_trace(stage->scene, i, ray, path, PATH_MOST, NULL);
            add_path(path, pieces, light.power / light.rays, color, frame);
        }
    }
    const bool good = count == 0 || path != NULL;
    free(path);
    return good;
}
