/// engine_overlap.c - which bodies of a scene begin inside one another. Compiled once for each precision, as engine.c.
///
/// Reads the scene's world; the contacts are found in a copy of it that is refreshed (a step of 0 s), so that
/// filters, joints and sensors count as in a run and the scene itself does not notice. Cost: a copy of the world
/// and its contacts.
#include "engine_session.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/// [-] of the smaller body's thickness that may overlap: corners that meet, planks laid roughly.
static const double MOST = 0.05;

plumb_world *pl_stage_refreshed(const engine_stage *stage)
{
    const plumb_world *world = stage->world;
    plumb_world_desc settings = plumb_world_settings(world);
    plumb_world_desc desc = { .simd_width = settings.simd_width };
    size_t size = plumb_world_snapshot_size(world);
    void *image = malloc(size > 0 ? size : 1);
    plumb_world *copy = NULL;
    bool good = image != NULL && plumb_world_save(world, image, size) == PLUMB_OK &&
                plumb_world_create(&desc, &copy) == PLUMB_OK &&
                plumb_world_restore(copy, image, size) == PLUMB_OK;
    free(image);
    for (int i = 0; good && i < scene_body_count(stage->scene); i++) {
        plumb_body_wake(copy,
                        scene_body_get(stage->scene, i).entity); // who sleeps looks at nothing
    }
    good = good && plumb_world_step(copy, 0) == PLUMB_OK;
    if (!good) {
        plumb_world_destroy(copy);
        copy = NULL;
    }
    return copy;
}

/// [m] how thick a body is, of lines how long.
static double thickness(const plumb_world *world, plumb_body body)
{
    plumb_aabb box = plumb_body_aabb(world, body);
    double w = (double)(box.max.x - box.min.x), h = (double)(box.max.y - box.min.y);
    return fmin(w, h) > 0 ? fmin(w, h) : fmax(w, h);
}

static double depth_of(const plumb_contact *c)
{
    double depth = 0;
    for (int i = 0; i < c->point_count; i++) {
        depth = fmax(depth, -(double)c->points[i].separation);
    }
    return depth;
}

static int by_pair(const void *pa, const void *pb)
{
    const engine_overlap *a = pa, *b = pb;
    int order = strcmp(a->a, b->a);
    order = order != 0 ? order : strcmp(a->b, b->b);
    return order != 0 ? order : (a->depth < b->depth) - (a->depth > b->depth);
}

static int by_depth(const void *pa, const void *pb)
{
    const engine_overlap *a = pa, *b = pb;
    int order = (a->depth < b->depth) - (a->depth > b->depth);
    return order != 0 ? order : by_pair(pa, pb);
}

/// Each pair once, deepest first.
static int sort_pairs(engine_overlap *list, int count)
{
    int kept = 0;
    qsort(list, (size_t)count, sizeof *list, by_pair);
    for (int i = 0; i < count; i++) {
        if (kept == 0 || strcmp(list[kept - 1].a, list[i].a) != 0 ||
            strcmp(list[kept - 1].b, list[i].b) != 0) {
            list[kept++] = list[i];
        }
    }
    qsort(list, (size_t)kept, sizeof *list, by_depth);
    return kept;
}

int pl_session_overlaps(engine_session *session, const engine_overlap **list)
{
    engine_stage *stage = &session->stage;
    plumb_world *copy = pl_stage_refreshed(stage);
    int count = copy != NULL ? plumb_world_contacts(copy, NULL, 0) : 0, found = 0;
    if (copy == NULL ||
        !pl_session_reserve(&stage->contacts, &stage->contact_room, count,
                            sizeof *stage->contacts) ||
        !pl_session_reserve(&session->overlaps, &session->overlap_room, count,
                            sizeof *session->overlaps)) {
        plumb_world_destroy(copy);
        return -1;
    }
    plumb_world_contacts(copy, stage->contacts, count);
    for (int i = 0; i < count; i++) {
        const plumb_contact *c = &stage->contacts[i];
        double depth = depth_of(c);
        double size = fmin(thickness(copy, c->body_a), thickness(copy, c->body_b));
        if (depth > MOST * size) {
            session->overlaps[found++] =
                (engine_overlap){ .a = scene_body_of(stage->scene, c->body_a).name,
                                  .b = scene_body_of(stage->scene, c->body_b).name,
                                  .depth = depth };
        }
    }
    plumb_world_destroy(copy);
    *list = session->overlaps;
    return sort_pairs(session->overlaps, found);
}
