/// engine.h - one small neutral interface over several 2D engines.
///
/// The benchmark (tests/bench) and the cross-validation tests (tests/crossval) run the same
/// scene through Plumb and through foreign engines behind this table of functions. Everything is
/// double here whatever the engine computes in; units are SI, angles radians, counter-clockwise.
///
///     const struct engine *e = &engine_box2d2;
///     struct engine_options options = engine_options_default();
///     struct engine_world *world = e->create(&options);
///     struct engine_body_def ball = { .type = ENGINE_DYNAMIC, .y = 5 };
///     int body = e->add_body(world, &ball);
///     e->add_circle(world, body, &engine_material_default, 0, 0, 0.5);
///     for (int i = 0; i < 60; ++i) { e->step(world, 1.0 / 60); }
///     struct engine_pose pose = e->get_pose(world, body);
///     e->destroy(world);
///
/// Bodies are dense indices 0, 1, 2, ... in the order of creation; a destroyed body's index
/// is not given again and may only be forgotten. A shape call returns ENGINE_OK,
/// ENGINE_UNSUPPORTED (the engine has no such shape; the body is as before) or ENGINE_FAILED.
/// One thread calls; an engine may have more of its own (`workers`). The worlds are independent.
///
/// What differs between engines and cannot be set away, so that a test can allow for it:
/// - Box2D 2.4.1 puts a skin of 0.01 m round polygons, edges and chains (`skin`): boxes at rest
///   keep about 15 mm of air, and fall there if they are placed touching. `skin` in the
///   options replaces it (0 works). Polygons have at most 8 vertices and no rounding, capsules do
///   not exist. No body travels more than 2 m or turns more than 90 degrees in a step; these are
///   macros compiled into the library. One step is one substep; more are taken as that many shorter
///   steps.
/// - Box2D 3: polygons have at most 8 vertices; a speed limit of 400 m/s and a spin limit of
///   45 degrees a substep. Contacts can be speculative: up to 20 mm apart and without impulse.
/// - Both combine friction as sqrt(fa fb), restitution as max(ea, eb).
#ifndef HARNESS_ENGINE_H
#define HARNESS_ENGINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ENGINE_OK = 0, ENGINE_UNSUPPORTED = -1, ENGINE_FAILED = -2 };

enum engine_body_type { ENGINE_STATIC, ENGINE_KINEMATIC, ENGINE_DYNAMIC };

/// Defined privately by every adapter.
struct engine_world;

/// How a world behaves. Start from engine_options_default().
struct engine_options {
    double gravity_x;        ///< [m/s^2]
    double gravity_y;        ///< [m/s^2]
    int substeps;            ///< a step; 0: the engine's default (Box2D 2.4.1: 1, others: 4)
    int velocity_iterations; ///< 0: default (Box2D 2.4.1: 8, Plumb's baseline: 10); others: unused
    int position_iterations; ///< 0: default (Box2D 2.4.1: 3); others: unused
    bool sleep;              ///< let resting bodies fall asleep
    bool continuous;         ///< continuous collision where the engine has it
    double restitution_threshold; ///< [m/s] no bounce below; < 0: its own (Box2D 1.0, Plumb 0)
    double skin;                  ///< [m] round polygons, where the engine has one; < 0: its own
    int width;                    ///< SIMD lanes where they can be chosen; 0: the engine's choice
    int workers;                  ///< threads, where the engine has them; 0: one
    const char *solver;           ///< Plumb: "soft", "baseline", or a switch of "soft"; NULL: soft
    bool
        stiff; ///< what its manual offers for the least give: Box2D 2.4.1: no skin; Box2D 3: contacts
    ///< and joints as stiff as the step allows; Chipmunk: overlap of 0.1 mm instead of 0.1 m
};

struct engine_body_def {
    enum engine_body_type type;
    double x, y;         ///< [m] origin of the body
    double angle;        ///< [rad]
    double vx, vy;       ///< [m/s] of the centre of mass
    double w;            ///< [rad/s]
    bool fixed_rotation; ///< infinite rotational inertia
    bool asleep;         ///< starts asleep (only where options.sleep is on)
    int group;           ///< > 0: its shapes do not collide with those of bodies of the same group
};

/// A hinge between two bodies; they do not collide with one another.
struct engine_hinge_def {
    int body_a, body_b;
    double x, y;         ///< [m] world, as things are when the hinge is made
    bool enable_limit;   ///< lower <= turn of B relative to A since then <= upper
    double lower, upper; ///< [rad]
    bool enable_motor;   ///< drives that turn; speed 0 is friction
    double motor_speed;  ///< [rad/s]
    double max_torque;   ///< [N m]
};

enum engine_joint_kind { ENGINE_REVOLUTE, ENGINE_PRISMATIC, ENGINE_DISTANCE, ENGINE_WELD };

/// A joint of any kind that all engines have; rigid, or with one spring.
struct engine_joint_def {
    enum engine_joint_kind kind;
    int body_a, body_b;
    double ax, ay;       ///< [m] world: the joint's point on A
    double bx, by;       ///< [m] world: the same on B; apart where a joint begins open
    double ux, uy;       ///< of a prismatic: unit vector of its axis
    bool enable_limit;   ///< of a distance: instead of the rod
    double lower, upper; ///< [rad] [m]
    bool enable_motor;
    double motor_speed, max_motor; ///< [rad/s] [m/s], [N m] [N]
    double hertz, damping;         ///< of a spring; 0: none
    double stiffness, resistance;  ///< the same in [N/m], [N s/m] or by the radian
    double rest;                   ///< [m] [rad] where the spring, or the rod, is at rest
    bool collide;                  ///< the two bodies collide with one another
};

struct engine_material {
    double density; ///< [kg/m^2] > 0
    double friction;
    double restitution;
};

/// Density 1 kg/m^2, friction 0.6, no bounce: what Box2D 3 takes as its default.
static const struct engine_material engine_material_default = { 1.0, 0.6, 0.0 };

struct engine_pose {
    double x, y;  ///< [m] origin of the body, not its centre of mass
    double c, s;  ///< cosine and sine of the angle, as the engine has them
    double angle; ///< [rad] in [-pi, pi]
};

struct engine_velocity {
    double x, y; ///< [m/s] of the centre of mass
    double w;    ///< [rad/s]
};

struct engine_mass {
    double mass;    ///< [kg] 0 for static and kinematic bodies
    double inertia; ///< [kg m^2] about the centre of mass; 0 when it cannot rotate
    double x, y;    ///< [m] centre of mass in the body's frame
};

/// One point of a contact manifold.
struct engine_contact {
    int body_a;
    int body_b;
    double x, y;       ///< [m] world, midway between the two surfaces
    double nx, ny;     ///< unit normal from A to B
    double separation; ///< [m] negative when overlapping, skin included
    double impulse;    ///< [N s] normal impulse of the last step, all substeps together
};

typedef void engine_contact_fn(void *context, const struct engine_contact *contact);

struct engine_counts {
    int bodies;
    int contacts; ///< pairs of shapes with at least one manifold point
    int joints;
};

/// Touches of pairs of shapes that the last step told of, those of all its inner steps together.
struct engine_touches {
    int begins, ends;
};

/// One engine. Every pointer is set in every engine.
struct engine {
    const char *name; ///< short: column title and --engines key
    bool has_threads; ///< options.workers means something
    bool has_solver;  ///< options.solver and options.width mean something

    /// Writes name, version and what is known of the build, one line.
    void (*describe)(char *text, size_t size);

    /// NULL when the engine refuses the options or has no memory.
    struct engine_world *(*create)(const struct engine_options *options);
    void (*destroy)(struct engine_world *world);

    /// Index of the new body, or ENGINE_FAILED.
    int (*add_body)(struct engine_world *world, const struct engine_body_def *def);
    /// With its shapes and hinges.
    void (*destroy_body)(struct engine_world *world, int body);
    /// [kg], [kg m^2] about the centre of mass, which is in the body's frame [m]; after its shapes. ENGINE_OK or
    /// ENGINE_UNSUPPORTED.
    int (*set_mass)(struct engine_world *world, int body, const struct engine_mass *mass);
    /// Index of the new joint (hinges are not counted), ENGINE_UNSUPPORTED or ENGINE_FAILED.
    int (*add_joint)(struct engine_world *world, const struct engine_joint_def *def);
    /// Drives a revolute, as motor_speed and max_motor of its definition say; `on` false: it turns freely. Wakes. ENGINE_OK
    /// or ENGINE_UNSUPPORTED.
    int (*set_motor)(struct engine_world *world, int joint, bool on, double speed, double max);
    /// What a joint bore in the last inner step [N], [N m]; of some kinds an engine knows the size alone: then y is 0.
    void (*joint_force)(const struct engine_world *world, int joint, double force[2],
                        double *torque);
    /// ENGINE_OK or ENGINE_FAILED.
    int (*add_hinge)(struct engine_world *world, const struct engine_hinge_def *def);

    // Shapes are in the frame of the body. x and y arrays hold `count` values each.
    int (*add_circle)(struct engine_world *world, int body, const struct engine_material *material,
                      double x, double y, double radius);
    int (*add_capsule)(struct engine_world *world, int body, const struct engine_material *material,
                       double x1, double y1, double x2, double y2, double radius);
    /// Convex, any winding; `radius` rounds it outwards.
    int (*add_polygon)(struct engine_world *world, int body, const struct engine_material *material,
                       const double *x, const double *y, int count, double radius);
    /// Two-sided, without mass.
    int (*add_segment)(struct engine_world *world, int body, const struct engine_material *material,
                       double x1, double y1, double x2, double y2);
    /// One-sided and smooth, without mass: free space on the right of the direction of travel.
    /// Every edge of an open chain collides. At least 3 points, a loop of Box2D 3 at least 4.
    int (*add_chain)(struct engine_world *world, int body, const struct engine_material *material,
                     const double *x, const double *y, int count, bool loop);

    /// Of dynamic and kinematic bodies; wakes.
    void (*set_velocity)(struct engine_world *world, int body, double vx, double vy, double w);
    /// At the centre of mass, for the next step only; wakes.
    void (*apply_force)(struct engine_world *world, int body, double fx, double fy, double torque);

    void (*step)(struct engine_world *world, double dt);

    struct engine_pose (*get_pose)(const struct engine_world *world, int body);
    struct engine_velocity (*get_velocity)(const struct engine_world *world, int body);
    struct engine_mass (*get_mass)(const struct engine_world *world, int body);

    /// Calls `visit` once for each manifold point, in an order of the engine's own.
    void (*contacts)(const struct engine_world *world, engine_contact_fn *visit, void *context);
    struct engine_counts (*counts)(const struct engine_world *world);
    struct engine_touches (*touches)(const struct engine_world *world);

    /// [m] the engine keeps its polygons, edges and chains this much thicker than they were given.
    double (*skin)(const struct engine_world *world);
    /// Bytes that the engine has allocated and not freed; 0 when it cannot tell.
    size_t (*bytes)(const struct engine_world *world);
};

// clang-format off
/// The rows of an adapter whose functions have the names of the members.
#define ENGINE_FUNCTIONS                                                                          \
    .describe = describe, .create = create, .destroy = destroy, .add_body = add_body,             \
    .destroy_body = destroy_body, .set_mass = set_mass, .add_joint = add_joint,                   \
    .set_motor = set_motor, .joint_force = joint_force, .add_hinge = add_hinge, .add_circle = add_circle,               \
    .add_capsule = add_capsule, .add_polygon = add_polygon, .add_segment = add_segment,           \
    .add_chain = add_chain, .set_velocity = set_velocity, .apply_force = apply_force,             \
    .step = step, .get_pose = get_pose, .get_velocity = get_velocity, .get_mass = get_mass,       \
    .contacts = contacts, .counts = counts, .touches = touches, .skin = skin, .bytes = bytes
// clang-format on

/// Gravity (0, -10), 4 substeps and 8/3 iterations, no sleep, continuous on, thresholds the
/// engine's own.
static inline struct engine_options engine_options_default(void)
{
    // In order: engine_box2d2.cpp is C++17.
    struct engine_options options = { 0.0,  -10.0, 0, 0, 0,    false, true,
                                      -1.0, -1.0,  0, 0, NULL, false };
    return options;
}

/// `items` of `size` bytes, of which there are `count`, with room for one more: it doubles. NULL: out of memory, and they are
/// where they were.
static inline void *engine_grown(void *items, size_t size, int count)
{
    const bool full = (count & (count - 1)) == 0; // 0, 1, 2, 4, ...
    return full ? realloc(items, (size_t)(count > 0 ? 2 * count : 1) * size) : items;
}

extern const struct engine engine_plumb;
extern const struct engine engine_box2d2;   ///< Box2D 2.4.1
extern const struct engine engine_chipmunk; ///< Chipmunk 7.0.3
extern const struct engine engine_box2d3;   ///< Box2D 3; only in builds with BOX2D3=/prefix

#ifdef __cplusplus
}
#endif

#endif
