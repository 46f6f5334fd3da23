// scenes_joints.c - the benchmark scenes with hinges.
// Reads: nothing. Writes: the scene it is given. Cost: paid once, before any engine runs.
//
// Sizes, places and speeds as in scenes.c, but for the ragdoll, which is our own: boxes and a disc,
// so that every engine can have it.
#include "scenes.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

void build_tumbler(struct scene *scene)
{
    enum { grid = 45 };
    const double pitch = 0.4;
    scene->sleeps = true;
    int ground = scene_body(scene, ENGINE_STATIC, 0.0, 0.0);
    int drum = scene_body(scene, ENGINE_DYNAMIC, 0.0, 10.0);
    struct engine_material heavy = engine_material_default;
    heavy.density = 50.0;
    for (int side = -1; side <= 1; side += 2) {
        scene_box(scene, drum, heavy, 0.5, 10.0, 10.0 * side, 0.0);
        scene_box(scene, drum, heavy, 10.0, 0.5, 0.0, 10.0 * side);
    }
    scene_hinge(scene, (struct engine_hinge_def){ .body_a = ground,
                                                  .body_b = drum,
                                                  .y = 10.0,
                                                  .enable_motor = true,
                                                  .motor_speed = 25.0 * pi / 180.0,
                                                  .max_torque = 1e8 });
    const double corner = -0.5 * pitch * grid;
    for (int i = 0; i < grid; ++i) {
        for (int j = 0; j < grid; ++j) {
            double y = corner + pitch * i + 10.0;
            int body = scene_body(scene, ENGINE_DYNAMIC, corner + pitch * j, y);
            scene_box(scene, body, engine_material_default, 0.125, 0.125, 0.0, 0.0);
        }
    }
}

// Columns of discs, each hinged half-way to the one above and to the one on its left.
void build_joint_grid(struct scene *scene)
{
    enum { side = 100, nails = 3 };
    for (int k = 0; k < side; ++k) {
        for (int i = 0; i < side; ++i) {
            bool nailed = i == 0 && k >= side / 2 - nails && k <= side / 2 + nails;
            int body = scene_body(scene, nailed ? ENGINE_STATIC : ENGINE_DYNAMIC, k, -i);
            scene->bodies[body].def.group = 1;
            const double center = 0.0;
            scene_convex(scene, body, engine_material_default, &center, &center, 1, 0.4);
            if (i > 0) {
                scene_hinge(scene, (struct engine_hinge_def){
                                       .body_a = body - 1, .body_b = body, .x = k, .y = -i + 0.5 });
            }
            if (k > 0) {
                scene_hinge(scene,
                            (struct engine_hinge_def){
                                .body_a = body - side, .body_b = body, .x = k - 0.5, .y = -i });
            }
        }
    }
}

void build_spinner(struct scene *scene)
{
    enum { points = 360, bodies = 6076 };
    const struct engine_material smooth = { 1.0, 0.0, 0.0 };
    const struct engine_material light = { 0.25, 0.1, 0.1 };
    struct engine_material slippery = engine_material_default;
    slippery.friction = 0.1;
    scene->sleeps = true;
    int ground = scene_body(scene, ENGINE_STATIC, 0.0, 0.0);
    double x[points];
    double y[points];
    for (int i = 0; i < points; ++i) { // clockwise: free space is inside
        x[i] = 40.0 * cos(-2.0 * pi * i / points);
        y[i] = 40.0 * sin(-2.0 * pi * i / points) + 32.0;
    }
    scene_add_chain(scene, ground, slippery, x, y, points, true);
    int rod = scene_body(scene, ENGINE_DYNAMIC, 0.0, 12.0);
    scene->bodies[ground].def.group = scene->bodies[rod].def.group = 1;
    const double rod_x[4] = { -0.4, 0.4, 0.4, -0.4 };
    const double rod_y[4] = { -20.0, -20.0, 20.0, 20.0 };
    scene_convex(scene, rod, smooth, rod_x, rod_y, 4, 0.2);
    scene_hinge(scene, (struct engine_hinge_def){ .body_a = ground,
                                                  .body_b = rod,
                                                  .y = 12.0,
                                                  .enable_motor = true,
                                                  .motor_speed = 5.0,
                                                  .max_torque = 1e12 });
    const double ends_x[2] = { -0.25, 0.25 };
    const double ends_y[2] = { 0.0, 0.0 };
    for (int i = 0; i < bodies; ++i) {
        enum { columns = 92 }; // from x = -23 every half metre to below 23
        int body = scene_body(scene, ENGINE_DYNAMIC, -23.0 + 0.5 * (i % columns),
                              2.0 + 0.5 * (int)(i / columns));
        if (i % 3 == 0) {
            scene_convex(scene, body, light, ends_x, ends_y, 2, 0.25);
        } else if (i % 3 == 1) {
            scene_convex(scene, body, light, &ends_y[0], &ends_y[0], 1, 0.35);
        } else {
            scene_box(scene, body, light, 0.35, 0.35, 0.0, 0.0);
        }
    }
}

// ---- ragdolls

// A part of the ragdoll, 1.76 m tall and seen from the front, feet at y = 0: a box, or the head's
// disc. It hangs at a part before it.
struct part {
    int parent;
    double x, y, hx, hy; // [m] centre, half sizes
    double at_x, at_y;   // [m] hinge
    double lower, upper; // [rad]
    double friction;     // [N m] of the hinge
};

static const struct part ragdoll[] = {
    // parent  x     y     hx    hy    hinge        limits       friction
    { -1, 0.00, 1.00, 0.16, 0.10, 0.00, 0.00, 0.0, 0.0, 0.0 },    // hip
    { 0, 0.00, 1.30, 0.18, 0.20, 0.00, 1.10, -0.5, 0.5, 0.03 },   // chest
    { 1, 0.00, 1.64, 0.12, 0.12, 0.00, 1.52, -0.7, 0.7, 0.01 },   // head
    { 1, -0.24, 1.31, 0.05, 0.16, -0.22, 1.45, -2.6, 0.3, 0.01 }, // upper arms
    { 1, 0.24, 1.31, 0.05, 0.16, 0.22, 1.45, -0.3, 2.6, 0.01 },
    { 3, -0.24, 1.01, 0.04, 0.14, -0.24, 1.15, -2.2, 0.1, 0.01 }, // lower arms
    { 4, 0.24, 1.01, 0.04, 0.14, 0.24, 1.15, -0.1, 2.2, 0.01 },
    { 0, -0.09, 0.69, 0.07, 0.21, -0.09, 0.90, -0.9, 0.3, 0.02 }, // thighs
    { 0, 0.09, 0.69, 0.07, 0.21, 0.09, 0.90, -0.3, 0.9, 0.02 },
    { 7, -0.09, 0.24, 0.06, 0.24, -0.09, 0.48, -0.1, 1.8, 0.01 }, // shanks
    { 8, 0.09, 0.24, 0.06, 0.24, 0.09, 0.48, -1.8, 0.1, 0.01 },
};

enum { parts = sizeof ragdoll / sizeof ragdoll[0], head = 2 };

// Stands with its feet at (x, y) until step `to`.
static void add_ragdoll(struct scene *scene, double x, double y, int to, int group)
{
    int first = scene->body_count;
    for (int i = 0; i < (int)parts; ++i) {
        const struct part *p = &ragdoll[i];
        int body = scene_body(scene, ENGINE_DYNAMIC, x + p->x, y + p->y);
        scene->bodies[body].to = to;
        scene->bodies[body].def.group = group;
        const double center = 0.0;
        if (i == head) {
            scene_convex(scene, body, engine_material_default, &center, &center, 1, p->hx);
        } else {
            scene_box(scene, body, engine_material_default, p->hx, p->hy, 0.0, 0.0);
        }
        if (p->parent >= 0) {
            scene_hinge(scene, (struct engine_hinge_def){ .body_a = first + p->parent,
                                                          .body_b = body,
                                                          .x = x + p->at_x,
                                                          .y = y + p->at_y,
                                                          .enable_limit = true,
                                                          .lower = p->lower,
                                                          .upper = p->upper,
                                                          .enable_motor = true,
                                                          .max_torque = p->friction });
        }
    }
}

void build_rain(struct scene *scene)
{
    enum { floors = 5, boxes = 501, columns = 40, crowd = 5, every = 8, waves = 1000 / every };
    const double half = 0.25, storey = 45.0, width = 2.0 * half * boxes;
    scene->sleeps = true;
    for (int f = 0; f < floors; ++f) {
        int ground = scene_body(scene, ENGINE_STATIC, 0.0, storey * f);
        for (int i = 0; i < boxes; ++i) {
            scene_box(scene, ground, engine_material_default, half, half,
                      2.0 * half * (i - boxes / 2), 0.0);
        }
    }
    int group = 0;
    for (int w = 0; w < waves; ++w) {
        scene->now = every * w;
        for (int f = 0; f < floors; ++f) {
            double left = width * ((double)(w % columns) / columns - 0.5);
            for (int i = 0; i < crowd; ++i) {
                add_ragdoll(scene, left + 0.8 * (i + 1), storey * f + 30.0 + 0.5 * i,
                            scene->now + every * columns, ++group);
            }
        }
    }
}
