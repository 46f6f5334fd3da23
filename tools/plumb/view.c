/// view.c - aims the camera: as the scene says, else so that all that moves stays visible.
///
/// Reads positions and boxes of what is drawn. What does not move is shown as far as it is near what
/// does: a ground of a kilometre must not make a stack of boxes a dot. What flies away or falls
/// off is let go once it is a picture's size away from the others (engine_bounds.c).
#include "view.h"

#include "scene_args.h"

#include <math.h>
#include <string.h>

/// [-] share of the picture left free on each side.
static const double MARGIN = 0.1;
/// [-] how far, in sizes of the first state, things may stray from the others and still be fitted.
static const double STRAY = 0.75;
/// [-] how much larger than the first state a picture becomes at most.
static const double LARGEST = 40;
/// [-] how much of the fixed surroundings is shown around what moves, in sizes of that; and above and below where none is so near.
static const double AROUND = 0.35, AROUND_FAR = 8;

static bool is_empty(engine_box b)
{
    return !(b.min_x <= b.max_x && b.min_y <= b.max_y);
}

static engine_box join(engine_box a, engine_box b)
{
    return (engine_box){ fmin(a.min_x, b.min_x), fmin(a.min_y, b.min_y), fmax(a.max_x, b.max_x),
                         fmax(a.max_y, b.max_y) };
}

static engine_box cut(engine_box a, engine_box b)
{
    return (engine_box){ fmax(a.min_x, b.min_x), fmax(a.min_y, b.min_y), fmin(a.max_x, b.max_x),
                         fmin(a.max_y, b.max_y) };
}

static double size_of(engine_box b)
{
    return fmax(b.max_x - b.min_x, b.max_y - b.min_y);
}

static engine_box grow(engine_box b, double by)
{
    return (engine_box){ b.min_x - by, b.min_y - by, b.max_x + by, b.max_y + by };
}

/// What is worth seeing of a state: what moves, and the surroundings near it.
static engine_box interest(const engine_scenery *of, double reach)
{
    engine_box moving, fixed;
    of->engine->bounds(of->stage, reach, &moving, &fixed);
    if (is_empty(moving)) {
        return fixed;
    }
    engine_box near_by = cut(fixed, grow(moving, AROUND * size_of(moving)));
    if (is_empty(near_by)) { // in the air: with what it may fall on
        engine_box tall = grow(moving, AROUND * size_of(moving));
        tall.min_y = moving.min_y - AROUND_FAR * size_of(moving);
        tall.max_y = moving.max_y + AROUND_FAR * size_of(moving);
        near_by = cut(fixed, tall);
    }
    return is_empty(near_by) ? moving : join(moving, near_by);
}

static const engine_row *find_row(const engine_scenery *of, const char *name, int *count,
                                  const engine_row **rows)
{
    *count = of->engine->rows(of->stage, rows);
    for (int i = 0; i < *count; i++) {
        if (strcmp((*rows)[i].name, name) == 0) {
            return &(*rows)[i];
        }
    }
    return NULL;
}

int view_begin(view *v, const view_wish *wish, const engine_scenery *of)
{
    const engine_row *rows;
    int count;

    *v = (view){ .wish = *wish, .y_down = of->info.y_down, .hint = of->info.camera };
    const char *follow = wish->follow != NULL ? wish->follow : v->hint.follow;
    snprintf(v->follow, sizeof v->follow, "%s", follow);
    v->seen = interest(of, INFINITY);
    v->size = size_of(v->seen);
    if (v->follow[0] == '\0') {
        return CLI_OK;
    }
    const engine_row *row = find_row(of, v->follow, &count, &rows);
    return row != NULL ? CLI_OK : scene_unknown_body(of, "follow", v->follow);
}

bool view_needs_run(const view *v)
{
    return v->follow[0] == '\0' && !v->hint.has_view && !v->hint.has_fit;
}

void view_forget(view *v)
{
    v->seen = (engine_box){ 1, 1, -1, -1 };
}

void view_feed(view *v, const engine_scenery *of)
{
    const engine_box now = interest(of, STRAY * v->size);
    const engine_box all = is_empty(v->seen) ? now : join(v->seen, now);
    if (size_of(all) <= LARGEST * v->size || is_empty(v->seen)) {
        v->seen = all;
    }
}

/// The fitted camera, before following and zoom.
static render_camera fitted(const view *v)
{
    if (v->hint.has_view) {
        return (render_camera){ { v->hint.x, v->hint.y }, v->hint.height, v->y_down };
    }
    render_box box = { { v->seen.min_x, v->seen.min_y }, { v->seen.max_x, v->seen.max_y } };
    if (v->hint.has_fit) {
        box =
            (render_box){ { v->hint.box[0], v->hint.box[1] }, { v->hint.box[2], v->hint.box[3] } };
    }
    return render_camera_fit(box, v->wish.width, v->wish.height, MARGIN, v->y_down);
}

render_camera view_camera(view *v, const engine_scenery *of)
{
    render_camera camera = fitted(v);
    if (v->follow[0] != '\0') {
        const engine_row *rows;
        int count;
        const engine_row *row = find_row(of, v->follow, &count, &rows);
        if (row != NULL) {
            v->x = row->x;
            v->y = row->y;
            v->has_center = true;
        }
        if (v->has_center) {
            camera.center = (render_vec){ v->x, v->y };
        }
    }
    camera.view_height /= v->wish.zoom;
    return camera;
}
