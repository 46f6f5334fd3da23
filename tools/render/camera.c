// camera.c - from world to pixels and back, fitting a box, bounds of a frame.
//
// A picture shows view_height world units from its lower to its upper edge; one unit has the same
// number of pixels both ways. Cost: O(1) a point, bounds O(points).
#include "internal.h"

#include <math.h>

// Share of a side that the margin may take at most; beyond it the content would vanish.
static const double margin_max = 0.45;
// View of an empty scene, in world units: about one thrown ball.
static const double empty_view = 10.0;

render_camera render_camera_fit(render_box box, int width, int height, double margin, bool y_down)
{
    render_camera camera = { .view_height = empty_view, .y_down = y_down };
    if (width < 1 || height < 1 || !(box.min.x <= box.max.x) || !(box.min.y <= box.max.y)) {
        return camera;
    }
    if (!(margin >= 0.0)) {
        margin = 0.0;
    }
    const double room = 1.0 - 2.0 * fmin(margin, margin_max);
    const double w = box.max.x - box.min.x, h = box.max.y - box.min.y;
    camera.center = (render_vec){ box.min.x + 0.5 * w, box.min.y + 0.5 * h };
    const double needed = fmax(h, w * height / width) / room;
    if (needed > 0.0 && isfinite(needed)) {
        camera.view_height = needed;
    }
    return camera;
}

render_vec render_camera_to_pixel(const render_camera *camera, int width, int height,
                                  render_vec world)
{
    const double scale = height / camera->view_height;
    const double up = camera->y_down ? 1.0 : -1.0;
    return (render_vec){ 0.5 * width + (world.x - camera->center.x) * scale,
                         0.5 * height + up * (world.y - camera->center.y) * scale };
}

render_vec render_camera_to_world(const render_camera *camera, int width, int height,
                                  render_vec pixel)
{
    const double scale = camera->view_height / height;
    const double up = camera->y_down ? 1.0 : -1.0;
    return (render_vec){ camera->center.x + (pixel.x - 0.5 * width) * scale,
                         camera->center.y + up * (pixel.y - 0.5 * height) * scale };
}

static void grow(render_box *box, render_vec point, double radius)
{
    box->min.x = fmin(box->min.x, point.x - radius);
    box->min.y = fmin(box->min.y, point.y - radius);
    box->max.x = fmax(box->max.x, point.x + radius);
    box->max.y = fmax(box->max.y, point.y + radius);
}

render_box render_frame_bounds(const render_frame *frame)
{
    render_box box = { { INFINITY, INFINITY }, { -INFINITY, -INFINITY } };
    for (size_t i = 0; i < frame->shape_count; i++) {
        const plr_shape *shape = &frame->shapes[i];
        for (size_t k = 0; k < shape->point_count; k++) {
            grow(&box, frame->points[shape->first_point + k], shape->radius);
        }
    }
    for (size_t i = 0; i < frame->mark_count; i++) {
        const plr_mark *mark = &frame->marks[i];
        for (size_t k = 0; mark->kind == PLR_TRAIL && k < mark->point_count; k++) {
            grow(&box, frame->points[mark->first_point + k], 0.0);
        }
    }
    return box;
}

render_vec plr_pixel(const plr_painter *painter, render_vec world)
{
    const double up = painter->camera->y_down ? 1.0 : -1.0;
    return (render_vec){
        0.5 * painter->width + (world.x - painter->camera->center.x) * painter->scale,
        0.5 * painter->height + up * (world.y - painter->camera->center.y) * painter->scale
    };
}

bool plr_shows(const plr_painter *painter, unsigned flag)
{
    return (painter->options.show & flag) != 0;
}
