// scene.c - keeping a scene's bodies and shapes, and filling a world with them.
// Reads and writes: the scene. Cost: amortised O(1) an item.
#include "scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Makes room for one more item.
static void *grown(void *items, int count, int *capacity, size_t size)
{
    if (count < *capacity) {
        return items;
    }
    *capacity = *capacity > 0 ? 2 * *capacity : 64;
    void *more = realloc(items, (size_t)*capacity * size);
    if (more == NULL) {
        fputs("bench: out of memory while building a scene\n", stderr);
        exit(1);
    }
    return more;
}

int scene_body(struct scene *scene, enum engine_body_type type, double x, double y)
{
    scene->bodies =
        grown(scene->bodies, scene->body_count, &scene->body_capacity, sizeof *scene->bodies);
    struct engine_body_def def = { .type = type, .x = x, .y = y };
    scene->bodies[scene->body_count] = def;
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

int scene_fill(const struct scene *scene, const struct engine *engine, struct engine_world *world)
{
    // Body by body with its shapes, as a game would: shapes are stored in the order of bodies.
    int next = 0;
    for (int i = 0; i < scene->body_count; ++i) {
        if (engine->add_body(world, &scene->bodies[i]) != i) {
            return ENGINE_FAILED;
        }
        for (; next < scene->shape_count && scene->shapes[next].body == i; ++next) {
            int status = fill_shape(&scene->shapes[next], engine, world);
            if (status != ENGINE_OK) {
                return status;
            }
        }
    }
    return next == scene->shape_count ? ENGINE_OK : ENGINE_FAILED;
}
