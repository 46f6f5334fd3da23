// target.c - a picture: runs the painters over a frame and hands the triangles to the backend.
//
// Reads the frame and the camera, writes the target's pixels. Cost: O(points) triangles, then the
// backend's rasteriser.
#include "internal.h"

#include <math.h>
#include <string.h>

struct render_target {
    render_allocator allocator;
    const plr_backend *backend;
    void *state;
    int width, height;
    plr_batch batch;
    plr_text *text;
    plr_group *group;
    render_vec *contour; // three arrays of PLR_CONTOUR_MAX
};

// Pictures of this height are drawn with lines and text at their nominal sizes.
static const double nominal_height = 540.0;
static const double ui_min = 0.6;
// Bound of the camera's numbers; keeps pixel coordinates within double.
static const double view_max = 1e30;

void render_target_destroy(render_target *target)
{
    if (target == NULL) {
        return;
    }
    if (target->state != NULL) {
        target->backend->destroy(target->state);
    }
    plr_text_destroy(target->text);
    plr_group_destroy(target->group);
    plr_batch_free(&target->batch);
    const render_allocator memory = target->allocator;
    plr_release(&memory, target->contour, 3 * PLR_CONTOUR_MAX, sizeof *target->contour);
    plr_release(&memory, target, 1, sizeof *target);
}

static render_result create_parts(render_target *target, const render_target_desc *desc,
                                  render_error *error)
{
    const render_allocator *memory = &target->allocator;
    target->group = plr_group_create(memory);
    target->contour = memory->resize(memory->user, NULL, 0,
                                     (size_t)3 * PLR_CONTOUR_MAX * sizeof *target->contour);
    if (target->group == NULL || target->contour == NULL) {
        return plr_fail(error, RENDER_E_MEMORY, "out of memory");
    }
    const render_result result = plr_text_create(&target->text, desc, memory, error);
    if (result != RENDER_OK) {
        return result;
    }
    return target->backend->create(&target->state, target->width, target->height, memory, error);
}

render_result render_target_create(render_target **out, int width, int height,
                                   const render_target_desc *desc, render_error *error)
{
    const render_target_desc plain = { 0 };
    plr_fail(error, RENDER_OK, "%s", "");
    if (out == NULL) {
        return plr_fail(error, RENDER_E_ARGUMENT, "no place for the target");
    }
    *out = NULL;
    if (width < 1 || height < 1 || width > RENDER_SIZE_MAX || height > RENDER_SIZE_MAX) {
        return plr_fail(error, RENDER_E_ARGUMENT, "picture size %d x %d is not within 1..%d", width,
                        height, RENDER_SIZE_MAX);
    }
    if (desc == NULL) {
        desc = &plain;
    }
    const render_allocator memory = plr_allocator(&desc->allocator);
    render_target *target = memory.resize(memory.user, NULL, 0, sizeof *target);
    if (target == NULL) {
        return plr_fail(error, RENDER_E_MEMORY, "out of memory");
    }
    *target = (render_target){
        .allocator = memory, .backend = &plr_backend_osmesa, .width = width, .height = height
    };
    target->batch.allocator = memory;
    const render_result result = create_parts(target, desc, error);
    if (result != RENDER_OK) {
        render_target_destroy(target);
        return result;
    }
    *out = target;
    return RENDER_OK;
}

static render_options with_defaults(const render_options *given, int height)
{
    render_options options = given != NULL ? *given : (render_options){ 0 };
    if (options.show == 0) {
        options.show = RENDER_SHOW_DEFAULT;
    }
    if (!(options.ui_scale > 0.0)) {
        options.ui_scale = fmax(height / nominal_height, ui_min);
    }
    options.ui_scale = fmin(options.ui_scale, 8.0); // glyphs larger than that crowd the atlas
    if (options.background.a == 0) {
        options.background = plr_background;
    }
    if (options.unit == NULL) {
        options.unit = "m";
    }
    return options;
}

static void paint(plr_painter *painter)
{
    plr_draw_grid(painter);
    plr_for_images(painter, plr_draw_liquids);
    plr_for_images(painter, plr_draw_smoke);
    plr_for_images(painter, plr_draw_underlay);
    plr_for_images(painter, plr_draw_bodies);
    plr_for_images(painter, plr_draw_beams);
    plr_for_images(painter, plr_draw_overlay);
    plr_for_images(painter, plr_draw_labels);
    plr_draw_period(painter);
    plr_draw_texts(painter);
    plr_draw_hud(painter);
}

render_result render_target_draw(render_target *target, const render_frame *frame,
                                 const render_camera *camera, const render_options *options,
                                 render_error *error)
{
    plr_fail(error, RENDER_OK, "%s", "");
    if (target == NULL || frame == NULL || camera == NULL || frame->body_open) {
        return plr_fail(error, RENDER_E_ARGUMENT,
                        "drawing needs a target, a frame without an open body, and a camera");
    }
    if (!(camera->view_height >= 1.0 / view_max) || !(camera->view_height <= view_max) ||
        !(fabs(camera->center.x) <= view_max) || !(fabs(camera->center.y) <= view_max)) {
        return plr_fail(error, RENDER_E_ARGUMENT, "the camera's view is not positive and finite");
    }
    if (frame->status == RENDER_E_MEMORY) {
        return plr_fail(error, RENDER_E_MEMORY, "out of memory while the frame was filled");
    }
    plr_painter painter = { .batch = &target->batch,
                            .text = target->text,
                            .frame = frame,
                            .camera = camera,
                            .options = with_defaults(options, target->height),
                            .width = target->width,
                            .height = target->height,
                            .scale = target->height / camera->view_height,
                            .group = target->group };
    painter.ui = painter.options.ui_scale;
    painter.contour.base = target->contour;
    painter.contour.normal = target->contour + PLR_CONTOUR_MAX;
    painter.contour.mitre = target->contour + (size_t)2 * PLR_CONTOUR_MAX;
    plr_batch_clear(&target->batch);
    target->batch.background = painter.options.background;
    plr_text_begin(target->text);
    paint(&painter);
    plr_text_end(target->text, &target->batch);
    if (target->batch.failed) {
        return plr_fail(error, RENDER_E_MEMORY, "out of memory while drawing");
    }
    return target->backend->submit(target->state, &target->batch, error);
}

const uint8_t *render_target_pixels(const render_target *target)
{
    return target->backend->pixels(target->state);
}

int render_target_width(const render_target *target)
{
    return target->width;
}

int render_target_height(const render_target *target)
{
    return target->height;
}
