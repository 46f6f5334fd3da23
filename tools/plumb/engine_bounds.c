/// engine_bounds.c - what of a stage is worth seeing: boxes around what moves and around what does not. Compiled once for each
/// precision, as engine.c.
///
/// Who has left the others does not count: the middle half of all that moves, along x and along y, is the bulk, and
/// whoever is farther from it than `reach` and its own size is on its own. So a picture follows what falls or drives
/// away as one, and lets go the crate that an explosion threw out.
/// Cost: O(bodies log bodies).
#include "engine_session.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/// Boxes of what moves.
struct crowd {
    plumb_aabb *boxes;
    double *sorted; ///< room for a coordinate of each
    int count;
};

static void add_to_box(engine_box *box, plumb_aabb b)
{
    box->min_x = fmin(box->min_x, (double)b.min.x);
    box->min_y = fmin(box->min_y, (double)b.min.y);
    box->max_x = fmax(box->max_x, (double)b.max.x);
    box->max_y = fmax(box->max_y, (double)b.max.y);
}

/// Without room nobody is left out.
static void add_mover(struct crowd *c, plumb_aabb b, engine_box *moving)
{
    if (c->boxes != NULL && c->sorted != NULL) {
        c->boxes[c->count++] = b;
    } else {
        add_to_box(moving, b);
    }
}

static double middle_x(plumb_aabb b)
{
    return ((double)b.min.x + (double)b.max.x) / 2;
}

static double middle_y(plumb_aabb b)
{
    return ((double)b.min.y + (double)b.max.y) / 2;
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// Least and largest coordinate of the middle half.
static void bulk_of(struct crowd *c, double (*middle)(plumb_aabb b), double *least, double *most)
{
    for (int i = 0; i < c->count; i++) {
        c->sorted[i] = middle(c->boxes[i]);
    }
    qsort(c->sorted, (size_t)c->count, sizeof *c->sorted, by_value);
    const int out = c->count / 4;
    *least = c->sorted[out];
    *most = c->sorted[c->count - 1 - out];
}

static void add_bulk(struct crowd *c, double reach, engine_box *moving)
{
    engine_box bulk;
    bulk_of(c, middle_x, &bulk.min_x, &bulk.max_x);
    bulk_of(c, middle_y, &bulk.min_y, &bulk.max_y);
    reach += fmax(bulk.max_x - bulk.min_x, bulk.max_y - bulk.min_y);
    for (int i = 0; i < c->count; i++) {
        const double x = middle_x(c->boxes[i]), y = middle_y(c->boxes[i]);
        if (x >= bulk.min_x - reach && x <= bulk.max_x + reach && y >= bulk.min_y - reach &&
            y <= bulk.max_y + reach) {
            add_to_box(moving, c->boxes[i]);
        }
    }
}

void pl_stage_bounds(const engine_stage *stage, double reach, engine_box *moving, engine_box *fixed)
{
    const engine_box empty = { DBL_MAX, DBL_MAX, -DBL_MAX, -DBL_MAX };
    const int count = pl_stage_body_count(stage);
    int soft_count;
    plumb_softbody *soft = pl_stage_softbodies(stage, &soft_count);
    const size_t room = (size_t)count + (size_t)soft_count + 1;
    struct crowd c = { malloc(room * sizeof *c.boxes), malloc(room * sizeof *c.sorted), 0 };

    *moving = *fixed = empty;
    for (int i = 0; i < count; i++) {
        scene_body body = pl_stage_body(stage, i);
        plumb_aabb b = plumb_body_aabb(stage->world, body.entity);
        bool is_static = plumb_body_get_type(stage->world, body.entity) == PLUMB_STATIC;
        if (body.hidden || !(b.min.x <= b.max.x)) {
            continue;
        }
        if (is_static) {
            add_to_box(fixed, b);
        } else {
            add_mover(&c, b, moving);
        }
    }
    for (int i = 0; soft != NULL && i < soft_count; i++) {
        add_mover(&c, pl_stage_softbody_box(stage, soft[i]), moving);
    }
    if (c.count > 0) {
        add_bulk(&c, reach, moving);
    }
    free(soft);
    free(c.boxes);
    free(c.sorted);
    // Of a world that wraps around all is worth seeing, and nothing twice.
    plumb_world_desc world = plumb_world_settings(stage->world);
    double x = (double)world.wrap_x / 2, y = (double)world.wrap_y / 2;
    if (x > 0) {
        moving->min_x = fixed->min_x = -x;
        moving->max_x = fixed->max_x = x;
    }
    if (y > 0) {
        moving->min_y = fixed->min_y = -y;
        moving->max_y = fixed->max_y = y;
    }
}
