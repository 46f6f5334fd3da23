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

/// A line of joined segments, one-sided where an engine has that: see struct engine, add_chain.
struct scene_chain {
    int body;
    int count;
    double *x, *y; ///< [m] in the frame of the body
    bool loop;
    struct engine_material material;
};

enum { SCENE_NEVER = 1 << 30 };

/// A body and the steps before which it comes and goes. Bodies stand in the order in which they come.
struct scene_member {
    struct engine_body_def def;
    int from, to; ///< SCENE_NEVER: it stays
};

/// Filled by the build function of a row; see scene_free.
struct scene {
    double gravity_y; ///< [m/s^2]
    bool sleeps;      ///< its origin lets bodies sleep (obeyed only with --sleep)
    int now;          ///< [steps] bodies that are added come before this step: build sets it
    int body_count, body_capacity;
    struct scene_member *bodies;
    int shape_count, shape_capacity;
    struct scene_shape *shapes;
    int chain_count, chain_capacity;
    struct scene_chain *chains;
    int hinge_count, hinge_capacity;
    struct engine_hinge_def *hinges;
};

/// How far a world has been filled; {0} before the first step.
struct scene_cursor {
    int body, shape, chain, hinge; ///< the next one to come
    int gone;                      ///< bodies before this one have gone or stay
};

/// One row a scene.
struct scene_row {
    const char *name;
    int settle; ///< steps before the clock runs
    int steps;  ///< of 1/60 s
    void (*build)(struct scene *scene);
    /// Called before each step, not timed; may be null.
    void (*before_step)(const struct scene *scene, const struct engine *engine,
                        struct engine_world *world, int step, double dt);
    const char *note; ///< what the scene asks of an engine
};

/// The table of scenes.
extern const struct scene_row scene_rows[];
extern const int scene_row_count;
/// So many of them, from the first, run when none is named.
extern const int scene_default_count;

/// Adds a body at rest; returns its index. Memory running out ends the program.
int scene_body(struct scene *scene, enum engine_body_type type, double x, double y);
/// Adds a convex shape of `count` points, counter-clockwise.
void scene_convex(struct scene *scene, int body, struct engine_material material, const double *x,
                  const double *y, int count, double radius);
/// Adds a box with half sizes hx, hy about (x, y) of the body's frame.
void scene_box(struct scene *scene, int body, struct engine_material material, double hx, double hy,
               double x, double y);

/// Adds a chain; the points are copied.
void scene_add_chain(struct scene *scene, int body, struct engine_material material,
                     const double *x, const double *y, int count, bool loop);
/// Adds a hinge; the later one of its bodies must be the last that was added. Bodies hinged together do
/// not collide: where their shapes meet they must be of one group, for the referee asks the group alone.
void scene_hinge(struct scene *scene, struct engine_hinge_def def);

/// Runs the row's build on an empty scene with gravity -10.
void scene_build(const struct scene_row *row, struct scene *scene);
void scene_free(struct scene *scene);

/// Takes out of a world what goes before `step`, and puts in what comes. ENGINE_OK, or the first error
/// of the engine.
int scene_advance(const struct scene *scene, const struct engine *engine,
                  struct engine_world *world, struct scene_cursor *cursor, int step);

/// Whether a body is in the world during `step`.
static inline bool scene_has(const struct scene *scene, int body, int step)
{
    return scene->bodies[body].from <= step && step < scene->bodies[body].to;
}

#endif
