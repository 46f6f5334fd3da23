// frame.c - the draw list: dynamic arrays filled by the caller, read by the painters.
//
// Every adder validates its numbers first and appends after all memory is reserved, so that a
// failed call leaves the list as it was. Cost: amortised O(1) a point.
#include "internal.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- memory and messages

static void *default_resize(void *user, void *block, size_t old_size, size_t new_size)
{
    (void)user;
    (void)old_size;
    if (new_size == 0) {
        free(block);
        return NULL;
    }
    return realloc(block, new_size);
}

render_allocator plr_allocator(const render_allocator *given)
{
    if (given != NULL && given->resize != NULL) {
        return *given;
    }
    return (render_allocator){ .resize = default_resize };
}

bool plr_reserve(const render_allocator *allocator, void **data, size_t *capacity, size_t need,
                 size_t size)
{
    if (need <= *capacity) {
        return true;
    }
    if (need > SIZE_MAX / 2 / size) {
        return false;
    }
    const size_t first_capacity = 64; // small enough for toys, large enough to skip tiny growth
    size_t wanted = *capacity < first_capacity ? first_capacity : *capacity * 2;
    if (wanted < need) {
        wanted = need;
    }
    if (wanted > SIZE_MAX / size) {
        wanted = need;
    }
    void *grown = allocator->resize(allocator->user, *data, *capacity * size, wanted * size);
    if (grown == NULL) {
        return false;
    }
    *data = grown;
    *capacity = wanted;
    return true;
}

void plr_release(const render_allocator *allocator, void *data, size_t capacity, size_t size)
{
    if (data != NULL) {
        allocator->resize(allocator->user, data, capacity * size, 0);
    }
}

render_result plr_fail(render_error *error, render_result result, const char *format, ...)
{
    if (error != NULL) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(error->text, sizeof error->text, format, arguments);
        va_end(arguments);
    }
    return result;
}

// ---- life cycle

render_frame *render_frame_create(const render_allocator *allocator)
{
    render_allocator memory = plr_allocator(allocator);
    render_frame *frame = memory.resize(memory.user, NULL, 0, sizeof *frame);
    if (frame == NULL) {
        return NULL;
    }
    *frame = (render_frame){ .allocator = memory };
    render_frame_clear(frame);
    return frame;
}

void render_frame_destroy(render_frame *frame)
{
    if (frame == NULL) {
        return;
    }
    const render_allocator memory = frame->allocator;
    plr_release(&memory, frame->bodies, frame->body_capacity, sizeof *frame->bodies);
    plr_release(&memory, frame->shapes, frame->shape_capacity, sizeof *frame->shapes);
    plr_release(&memory, frame->points, frame->point_capacity, sizeof *frame->points);
    plr_release(&memory, frame->marks, frame->mark_capacity, sizeof *frame->marks);
    plr_release(&memory, frame->joints, frame->joint_capacity, sizeof *frame->joints);
    plr_release(&memory, frame->text, frame->text_capacity, sizeof *frame->text);
    plr_release(&memory, frame, 1, sizeof *frame);
}

void render_frame_clear(render_frame *frame)
{
    frame->body_count = 0;
    frame->shape_count = 0;
    frame->point_count = 0;
    frame->mark_count = 0;
    frame->joint_count = 0;
    frame->text_count = 0;
    memset(frame->mark_kind_count, 0, sizeof frame->mark_kind_count);
    frame->title = PLR_NO_TEXT;
    frame->caption = PLR_NO_TEXT;
    frame->period = (render_vec){ 0.0, 0.0 };
    frame->body_open = false;
    frame->status = RENDER_OK;
}

render_result render_frame_status(const render_frame *frame)
{
    return frame->status;
}

const char *plr_frame_text(const render_frame *frame, size_t offset)
{
    return offset == PLR_NO_TEXT ? NULL : frame->text + offset;
}

// Remembers the first trouble; memory trouble wins, because it makes the picture incomplete.
static render_result note(render_frame *frame, render_result result)
{
    if (frame->status == RENDER_OK || result == RENDER_E_MEMORY) {
        frame->status = result;
    }
    return result;
}

// Coordinates beyond this are treated like infinite ones: their pixels could not be computed.
static const double coordinate_max = 1e30;

static bool finite2(double x, double y)
{
    return fabs(x) <= coordinate_max && fabs(y) <= coordinate_max; // false for NaN
}

// Copies a string into the text pool; *offset is PLR_NO_TEXT for NULL and "".
static bool keep_text(render_frame *frame, const char *text, size_t *offset)
{
    *offset = PLR_NO_TEXT;
    if (text == NULL || text[0] == '\0') {
        return true;
    }
    const size_t size = strlen(text) + 1;
    if (!plr_reserve(&frame->allocator, (void **)&frame->text, &frame->text_capacity,
                     frame->text_count + size, 1)) {
        return false;
    }
    memcpy(frame->text + frame->text_count, text, size);
    *offset = frame->text_count;
    frame->text_count += size;
    return true;
}

// ---- bodies

render_result render_body_begin(render_frame *frame, const render_style *style)
{
    const render_style plain = { 0 };
    const render_style *s = style != NULL ? style : &plain;
    if (frame->body_open || (int)s->kind < 0 || s->kind >= RENDER_CLASS_COUNT) {
        return note(frame, RENDER_E_ARGUMENT);
    }
    if (!plr_reserve(&frame->allocator, (void **)&frame->bodies, &frame->body_capacity,
                     frame->body_count + 1, sizeof *frame->bodies)) {
        return note(frame, RENDER_E_MEMORY);
    }
    plr_body *body = &frame->bodies[frame->body_count];
    *body = (plr_body){
        .kind = s->kind, .palette = s->palette, .color = s->color, .first_shape = frame->shape_count
    };
    if (!keep_text(frame, s->label, &body->label)) {
        return note(frame, RENDER_E_MEMORY);
    }
    frame->body_count++;
    frame->body_open = true;
    return RENDER_OK;
}

render_result render_body_end(render_frame *frame)
{
    if (!frame->body_open) {
        return note(frame, RENDER_E_ARGUMENT);
    }
    frame->body_open = false;
    plr_body *body = &frame->bodies[frame->body_count - 1];
    body->shape_count = frame->shape_count - body->first_shape;
    if (body->shape_count == 0) {
        frame->body_count--;
    }
    return RENDER_OK;
}

static render_result add_shape(render_frame *frame, plr_shape shape, const render_vec *points,
                               size_t count)
{
    if (!frame->body_open || !(shape.radius >= 0.0)) {
        return note(frame, isnan(shape.radius) ? RENDER_E_NOT_FINITE : RENDER_E_ARGUMENT);
    }
    bool finite = shape.radius <= coordinate_max && isfinite(shape.angle);
    for (size_t i = 0; i < count; i++) {
        finite = finite && finite2(points[i].x, points[i].y);
    }
    if (!finite) {
        return note(frame, RENDER_E_NOT_FINITE);
    }
    if (!plr_reserve(&frame->allocator, (void **)&frame->shapes, &frame->shape_capacity,
                     frame->shape_count + 1, sizeof *frame->shapes) ||
        !plr_reserve(&frame->allocator, (void **)&frame->points, &frame->point_capacity,
                     frame->point_count + count, sizeof *frame->points)) {
        return note(frame, RENDER_E_MEMORY);
    }
    shape.first_point = frame->point_count;
    shape.point_count = count;
    memcpy(frame->points + frame->point_count, points, count * sizeof *points);
    frame->point_count += count;
    frame->shapes[frame->shape_count++] = shape;
    return RENDER_OK;
}

render_result render_add_circle(render_frame *frame, double x, double y, double radius,
                                double angle)
{
    const render_vec center = { x, y };
    const plr_shape shape = { .kind = PLR_CIRCLE, .radius = radius, .angle = angle };
    return add_shape(frame, shape, &center, 1);
}

render_result render_add_capsule(render_frame *frame, double ax, double ay, double bx, double by,
                                 double radius)
{
    const render_vec ends[2] = { { ax, ay }, { bx, by } };
    return add_shape(frame, (plr_shape){ .kind = PLR_CAPSULE, .radius = radius }, ends, 2);
}

render_result render_add_polygon(render_frame *frame, const render_vec *points, size_t count,
                                 double radius)
{
    if (points == NULL || count < 3 || count > RENDER_POLYGON_MAX) {
        return note(frame, RENDER_E_ARGUMENT);
    }
    return add_shape(frame, (plr_shape){ .kind = PLR_POLYGON, .radius = radius }, points, count);
}

render_result render_add_box(render_frame *frame, double x, double y, double hx, double hy,
                             double angle, double radius)
{
    if (!(hx >= 0.0) || !(hy >= 0.0)) {
        return note(frame, isnan(hx) || isnan(hy) ? RENDER_E_NOT_FINITE : RENDER_E_ARGUMENT);
    }
    const double c = cos(angle), s = sin(angle);
    const render_vec corners[4] = {
        { x - c * hx + s * hy, y - s * hx - c * hy },
        { x + c * hx + s * hy, y + s * hx - c * hy },
        { x + c * hx - s * hy, y + s * hx + c * hy },
        { x - c * hx - s * hy, y - s * hx + c * hy },
    };
    return render_add_polygon(frame, corners, 4, radius);
}

render_result render_add_polyline(render_frame *frame, const render_vec *points, size_t count,
                                  double radius, unsigned flags)
{
    if (points == NULL || count < 2) {
        return note(frame, RENDER_E_ARGUMENT);
    }
    const plr_shape shape = { .kind = PLR_POLYLINE, .radius = radius, .flags = flags };
    return add_shape(frame, shape, points, count);
}

// ---- overlays

static render_result add_mark(render_frame *frame, plr_mark mark, const char *text)
{
    if (!finite2(mark.a.x, mark.a.y) || !finite2(mark.b.x, mark.b.y) || !finite2(mark.value, 0.0)) {
        return note(frame, RENDER_E_NOT_FINITE);
    }
    if (!plr_reserve(&frame->allocator, (void **)&frame->marks, &frame->mark_capacity,
                     frame->mark_count + 1, sizeof *frame->marks) ||
        !keep_text(frame, text, &mark.text)) {
        return note(frame, RENDER_E_MEMORY);
    }
    frame->marks[frame->mark_count++] = mark;
    frame->mark_kind_count[mark.kind]++;
    return RENDER_OK;
}

static render_result add_pair(render_frame *frame, plr_mark_kind kind, double ax, double ay,
                              double bx, double by)
{
    return add_mark(frame, (plr_mark){ .kind = kind, .a = { ax, ay }, .b = { bx, by } }, NULL);
}

render_result render_add_contact(render_frame *frame, double x, double y, double nx, double ny,
                                 double depth)
{
    const plr_mark mark = { .kind = PLR_CONTACT, .a = { x, y }, .b = { nx, ny }, .value = depth };
    return add_mark(frame, mark, NULL);
}

render_result render_add_impulse(render_frame *frame, double x, double y, double jx, double jy)
{
    return add_pair(frame, PLR_IMPULSE, x, y, jx, jy);
}

render_result render_add_velocity(render_frame *frame, double x, double y, double vx, double vy)
{
    return add_pair(frame, PLR_VELOCITY, x, y, vx, vy);
}

render_result render_add_field(render_frame *frame, double x, double y, double length_x,
                               double length_y, double strength, double share)
{
    if (!(share >= 0.0 && share <= 1.0)) {
        return note(frame, RENDER_E_ARGUMENT);
    }
    const plr_mark mark = { .kind = PLR_FIELD,
                            .variant = (int)(255.0 * share + 0.5),
                            .a = { x, y },
                            .b = { length_x, length_y },
                            .value = strength };
    return add_mark(frame, mark, NULL);
}

render_result render_add_dipole(render_frame *frame, double x, double y, double half_x,
                                double half_y, double across)
{
    if (!(across >= 0.0)) {
        return note(frame, RENDER_E_ARGUMENT);
    }
    const plr_mark mark = {
        .kind = PLR_DIPOLE, .a = { x, y }, .b = { half_x, half_y }, .value = across
    };
    return add_mark(frame, mark, NULL);
}

render_result render_add_beam(render_frame *frame, render_vec a, render_vec b, double bright_a,
                              double bright_b, render_rgba color)
{
    if (!(bright_a >= 0.0 && bright_a <= 1.0 && bright_b >= 0.0 && bright_b <= 1.0)) {
        return note(frame, RENDER_E_ARGUMENT);
    }
    const plr_mark mark = {
        .kind = PLR_BEAM, .a = a, .b = b, .bright_a = bright_a, .bright_b = bright_b, .color = color
    };
    return add_mark(frame, mark, NULL);
}

render_result render_add_aabb(render_frame *frame, render_box box)
{
    return add_pair(frame, PLR_AABB, box.min.x, box.min.y, box.max.x, box.max.y);
}

render_result render_add_cell(render_frame *frame, render_box box)
{
    return add_pair(frame, PLR_CELL, box.min.x, box.min.y, box.max.x, box.max.y);
}

// A mark with a run of points, `least` of them or more.
static render_result add_path(render_frame *frame, plr_mark mark, const render_vec *points,
                              size_t count, size_t least)
{
    if (points == NULL || count < least) {
        return note(frame, RENDER_E_ARGUMENT);
    }
    for (size_t i = 0; i < count; i++) {
        if (!finite2(points[i].x, points[i].y)) {
            return note(frame, RENDER_E_NOT_FINITE);
        }
    }
    if (!plr_reserve(&frame->allocator, (void **)&frame->points, &frame->point_capacity,
                     frame->point_count + count, sizeof *frame->points)) {
        return note(frame, RENDER_E_MEMORY);
    }
    mark.first_point = frame->point_count;
    mark.point_count = count;
    const render_result result = add_mark(frame, mark, NULL);
    if (result == RENDER_OK) {
        memcpy(frame->points + frame->point_count, points, count * sizeof *points);
        frame->point_count += count;
    }
    return result;
}

render_result render_add_trail(render_frame *frame, const render_vec *points, size_t count,
                               render_rgba color)
{
    return add_path(frame, (plr_mark){ .kind = PLR_TRAIL, .color = color }, points, count, 2);
}

render_result render_add_liquid(render_frame *frame, const render_vec *points, size_t count,
                                double spacing, render_rgba color)
{
    if (count == 0) {
        return RENDER_OK;
    }
    if (!(spacing > 0)) {
        return note(frame, RENDER_E_ARGUMENT);
    }
    const plr_mark mark = { .kind = PLR_LIQUID, .value = spacing, .color = color };
    return add_path(frame, mark, points, count, 1);
}

render_result render_add_smoke(render_frame *frame, render_vec low, double cell, int columns,
                               const render_vec *points, size_t count, render_rgba color)
{
    if (!(cell > 0) || columns < 1 || count % (size_t)columns != 0) {
        return note(frame, RENDER_E_ARGUMENT);
    }
    if (!finite2(low.x, low.y)) {
        return note(frame, RENDER_E_NOT_FINITE);
    }
    const plr_mark mark = {
        .kind = PLR_SMOKE, .variant = columns, .a = low, .value = cell, .color = color
    };
    return add_path(frame, mark, points, count, 1);
}

render_result render_add_flow(render_frame *frame, const render_vec *points, size_t count,
                              double speed, double share)
{
    if (!(share >= 0.0 && share <= 1.0)) {
        return note(frame, RENDER_E_ARGUMENT);
    }
    const plr_mark mark = { .kind = PLR_FLOW,
                            .variant = (int)(255.0 * share + 0.5),
                            .value = speed };
    return add_path(frame, mark, points, count, 2);
}

render_result render_add_joint(render_frame *frame, const render_joint *joint)
{
    const render_joint *j = joint;
    if (j == NULL || (int)j->kind < 0 || j->kind >= RENDER_JOINT_KINDS ||
        ((j->kind == RENDER_JOINT_SLIDER || j->kind == RENDER_JOINT_WHEEL) && j->axis.x == 0.0 &&
         j->axis.y == 0.0)) {
        return note(frame, RENDER_E_ARGUMENT);
    }
    const render_vec vectors[] = { j->a,
                                   j->b,
                                   j->via_a,
                                   j->via_b,
                                   j->axis,
                                   { j->lower, j->upper },
                                   { j->value, j->drive },
                                   { j->slack, j->reach } };
    for (size_t i = 0; i < sizeof vectors / sizeof vectors[0]; i++) {
        if (!finite2(vectors[i].x, vectors[i].y)) {
            return note(frame, RENDER_E_NOT_FINITE);
        }
    }
    if (!plr_reserve(&frame->allocator, (void **)&frame->joints, &frame->joint_capacity,
                     frame->joint_count + 1, sizeof *frame->joints)) {
        return note(frame, RENDER_E_MEMORY);
    }
    frame->joints[frame->joint_count++] = *j;
    return RENDER_OK;
}

render_result render_add_surface(render_frame *frame, const render_vec *points, size_t count,
                                 bool closed, double travel)
{
    const plr_mark mark = { .kind = PLR_SURFACE, .variant = closed, .value = travel };
    return add_path(frame, mark, points, count, 2);
}

render_result render_add_text(render_frame *frame, double x, double y, render_anchor anchor,
                              const char *text)
{
    if (text == NULL || (int)anchor < 0 || anchor > RENDER_ANCHOR_BELOW) {
        return note(frame, RENDER_E_ARGUMENT);
    }
    if (text[0] == '\0') {
        return RENDER_OK;
    }
    const plr_mark mark = { .kind = PLR_TEXT, .variant = (int)anchor, .a = { x, y } };
    return add_mark(frame, mark, text);
}

render_result render_frame_set_period(render_frame *frame, double x, double y)
{
    if (!isfinite(x) || !isfinite(y)) {
        return note(frame, RENDER_E_NOT_FINITE);
    }
    if (x < 0.0 || y < 0.0) {
        return note(frame, RENDER_E_ARGUMENT);
    }
    frame->period = (render_vec){ x, y };
    return RENDER_OK;
}

render_result render_frame_set_title(render_frame *frame, const char *text)
{
    return keep_text(frame, text, &frame->title) ? RENDER_OK : note(frame, RENDER_E_MEMORY);
}

render_result render_frame_set_caption(render_frame *frame, const char *text)
{
    return keep_text(frame, text, &frame->caption) ? RENDER_OK : note(frame, RENDER_E_MEMORY);
}
