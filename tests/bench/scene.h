/// scene.h - a benchmark scene as data: bodies and shapes that any engine can be filled with, and
/// from whose poses the penetration is measured without asking the engine.
#ifndef BENCH_SCENE_H
#define BENCH_SCENE_H

#include "../harness/engine.h"

enum { SCENE_MAX_POINTS = 16 }; ///< corners of one shape: Plumb's limit

/// A convex shape: 1 point and a radius is a disc, 2 points a segment or (with a radius) a
/// capsule, 3 or more a polygon, counter-clockwise.
struct scene_shape {
    int body;
    int count;
    double x[SCENE_MAX_POINTS], y[SCENE_MAX_POINTS]; ///< [m] in the frame of the body
    double radius;                                   ///< [m]
    struct engine_material material;
};

/// Filled by the build function of a row; see scene_free.
struct scene {
    double gravity_y; ///< [m/s^2]
    bool sleeps;      ///< its origin lets bodies sleep (obeyed only with --sleep)
    int body_count, body_capacity;
    struct engine_body_def *bodies;
    int shape_count, shape_capacity;
    struct scene_shape *shapes;
};

/// One row a scene.
struct scene_row {
    const char *name;
    int steps; ///< of 1/60 s
    void (*build)(struct scene *scene);
    /// Called before each step, not timed; may be null.
    void (*before_step)(const struct scene *scene, const struct engine *engine,
                        struct engine_world *world, int step, double dt);
    const char *note; ///< what the scene asks of an engine
};

/// The table of scenes.
extern const struct scene_row scene_rows[];
extern const int scene_row_count;

/// Adds a body at rest; returns its index. Memory running out ends the program.
int scene_body(struct scene *scene, enum engine_body_type type, double x, double y);
/// Adds a convex shape of `count` points, counter-clockwise.
void scene_convex(struct scene *scene, int body, struct engine_material material, const double *x,
                  const double *y, int count, double radius);
/// Adds a box with half sizes hx, hy about (x, y) of the body's frame.
void scene_box(struct scene *scene, int body, struct engine_material material, double hx, double hy,
               double x, double y);

/// Runs the row's build on an empty scene with gravity -10.
void scene_build(const struct scene_row *row, struct scene *scene);
void scene_free(struct scene *scene);

/// Puts all of a scene into a world. ENGINE_OK, or the first error of the engine.
int scene_fill(const struct scene *scene, const struct engine *engine, struct engine_world *world);

#endif
