// scene.c - keeping a scene's bodies and shapes, and filling a world with them.
// Reads and writes: the scene. Cost: amortised O(1) an item.
#include "scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *resized(void *items, size_t size)
{
    void *more = realloc(items, size);
    if (more == NULL) {
        fputs("bench: out of memory while building a scene\n", stderr);
        exit(1);
    }
    return more;
}

// Makes room for one more item.
static void *grown(void *items, int count, int *capacity, size_t size)
{
    if (count < *capacity) {
        return items;
    }
    *capacity = *capacity > 0 ? 2 * *capacity : 64;
    return resized(items, (size_t)*capacity * size);
}

int scene_body(struct scene *scene, enum engine_body_type type, double x, double y)
{
    scene->bodies =
        grown(scene->bodies, scene->body_count, &scene->body_capacity, sizeof *scene->bodies);
    scene->bodies[scene->body_count] = (struct scene_member){
        .def = { .type = type, .x = x, .y = y }, .from = scene->now, .to = SCENE_NEVER
    };
    return scene->body_count++;
}

void scene_convex(struct scene *scene, int body, struct engine_material material, const double *x,
                  const double *y, int count, double radius)
{
    scene->shapes =
        grown(scene->shapes, scene->shape_count, &scene->shape_capacity, sizeof *scene->shapes);
    struct scene_shape *shape = &scene->shapes[scene->shape_count++];
    memset(shape, 0, sizeof *shape);
    shape->body = body;
    shape->count = count;
    shape->radius = radius;
    shape->material = material;
    memcpy(shape->x, x, (size_t)count * sizeof *x);
    memcpy(shape->y, y, (size_t)count * sizeof *y);
}

void scene_box(struct scene *scene, int body, struct engine_material material, double hx, double hy,
               double x, double y)
{
    const double xs[4] = { x - hx, x + hx, x + hx, x - hx };
    const double ys[4] = { y - hy, y - hy, y + hy, y + hy };
    scene_convex(scene, body, material, xs, ys, 4, 0.0);
}

static double *copy_of(const double *values, int count)
{
    size_t size = (size_t)count * sizeof *values;
    return memcpy(resized(NULL, size), values, size);
}

void scene_add_chain(struct scene *scene, int body, struct engine_material material,
                     const double *x, const double *y, int count, bool loop)
{
    scene->chains =
        grown(scene->chains, scene->chain_count, &scene->chain_capacity, sizeof *scene->chains);
    scene->chains[scene->chain_count++] = (struct scene_chain){ .body = body,
                                                                .count = count,
                                                                .x = copy_of(x, count),
                                                                .y = copy_of(y, count),
                                                                .loop = loop,
                                                                .material = material };
}

void scene_hinge(struct scene *scene, struct engine_hinge_def def)
{
    scene->hinges =
        grown(scene->hinges, scene->hinge_count, &scene->hinge_capacity, sizeof *scene->hinges);
    scene->hinges[scene->hinge_count++] = def;
}

void scene_build(const struct scene_row *row, struct scene *scene)
{
    memset(scene, 0, sizeof *scene);
    scene->gravity_y = -10.0;
    row->build(scene);
}

void scene_free(struct scene *scene)
{
    free(scene->bodies);
    free(scene->shapes);
    for (int i = 0; i < scene->chain_count; ++i) {
        free(scene->chains[i].x);
        free(scene->chains[i].y);
    }
    free(scene->chains);
    free(scene->hinges);
    memset(scene, 0, sizeof *scene);
}

static int fill_shape(const struct scene_shape *s, const struct engine *engine,
                      struct engine_world *world)
{
    const struct engine_material *m = &s->material;
    if (s->count == 1) {
        return engine->add_circle(world, s->body, m, s->x[0], s->y[0], s->radius);
    }
    if (s->count == 2 && s->radius > 0.0) {
        return engine->add_capsule(world, s->body, m, s->x[0], s->y[0], s->x[1], s->y[1],
                                   s->radius);
    }
    if (s->count == 2) {
        return engine->add_segment(world, s->body, m, s->x[0], s->y[0], s->x[1], s->y[1]);
    }
    return engine->add_polygon(world, s->body, m, s->x, s->y, s->count, s->radius);
}

// A body with its shapes and the hinges to bodies before it, as a game would.
static int enter(const struct scene *scene, const struct engine *engine, struct engine_world *world,
                 struct scene_cursor *at)
{
    int body = at->body++;
    if (engine->add_body(world, &scene->bodies[body].def) != body) {
        return ENGINE_FAILED;
    }
    int status = ENGINE_OK;
    for (; status == ENGINE_OK && at->shape < scene->shape_count &&
           scene->shapes[at->shape].body == body;
         ++at->shape) {
        status = fill_shape(&scene->shapes[at->shape], engine, world);
    }
    for (; status == ENGINE_OK && at->chain < scene->chain_count &&
           scene->chains[at->chain].body == body;
         ++at->chain) {
        const struct scene_chain *c = &scene->chains[at->chain];
        status = engine->add_chain(world, body, &c->material, c->x, c->y, c->count, c->loop);
    }
    for (; status == ENGINE_OK && at->hinge < scene->hinge_count &&
           scene->hinges[at->hinge].body_a <= body && scene->hinges[at->hinge].body_b <= body;
         ++at->hinge) {
        status = engine->add_hinge(world, &scene->hinges[at->hinge]);
    }
    return status;
}

int scene_advance(const struct scene *scene, const struct engine *engine,
                  struct engine_world *world, struct scene_cursor *cursor, int step)
{
    for (; cursor->gone < cursor->body; ++cursor->gone) {
        int to = scene->bodies[cursor->gone].to;
        if (to <= step) {
            engine->destroy_body(world, cursor->gone);
        } else if (to < SCENE_NEVER) {
            break;
        }
    }
    while (cursor->body < scene->body_count && scene->bodies[cursor->body].from <= step) {
        int status = enter(scene, engine, world, cursor);
        if (status != ENGINE_OK) {
            return status;
        }
    }
    return ENGINE_OK;
}
