/// defs.h - what constructors hold: the structs that lists (lists.c, lists_joints.c) fill, and the
/// records of what was made. Included by internal.h, which has the types of fields.
#ifndef SCENE_DEFS_H
#define SCENE_DEFS_H

#ifndef SCENE_INTERNAL_H
#error "include internal.h"
#endif

typedef struct sc_settings {
    uint64_t present;
    char title[128];
    char description[512];
    double dt, duration, seed;
    PL_WORLD_ROWS(SC_MEMBER, )
} sc_settings;

typedef struct sc_material_def {
    uint64_t present;
    char name[SC_NAME_SIZE];
    PL_MATERIAL_ROWS(SC_MEMBER, )
} sc_material_def;

typedef struct sc_material {
    sc_material_def def;
    plumb_material handle;
    bool used, collected;
    int line;
    char id[SC_NAME_SIZE]; ///< its name, or material1, material2, ...
} sc_material;

/// material_pair{}: what two materials have between them.
typedef struct sc_pair_def {
    uint64_t present;
    sc_material *a, *b;
    PL_MATERIAL_PAIR_ROWS(SC_MEMBER, )
} sc_pair_def;

/// Which shapes may meet, by names; a body's is for those of its shapes that say nothing.
typedef struct sc_filter {
    uint64_t category;           ///< bits: see sc_category
    uint64_t collides;           ///< bits: meets these alone
    uint64_t ignores;            ///< bits: meets all but these
    char apart[SC_NAME_SIZE];    ///< shapes with the same word never meet
    char together[SC_NAME_SIZE]; ///< shapes with the same word always do
} sc_filter;

typedef enum sc_shape_kind {
    SC_CIRCLE,
    SC_CAPSULE,
    SC_BOX_SHAPE,
    SC_POLYGON,
    SC_OUTLINE,
    SC_SEGMENT,
    SC_CHAIN,
    SC_REGULAR,
    SC_SHAPE_KINDS
} sc_shape_kind;

typedef struct sc_shape_def {
    uint64_t present;
    sc_shape_kind kind;
    double w, h, r, n, length, round;
    double at[2], angle, angle_deg, density;
    bool closed, sensor;
    sc_filter filter;
    sc_material *material;
    int point_count;
    double (*points)[2]; ///< as written, before at and angle
} sc_shape_def;

/// The table `character` of a body, and what character{} may say of it.
typedef struct sc_character_def {
    uint64_t present;
    double up[2], max_slope, max_slope_deg, skin, step_height, step_width, snap_distance;
    double acceleration, air_acceleration, max_fall_speed, mass, push_force, gravity_scale;
    bool steps, snap, push, air_control;
} sc_character_def;

/// What handlers may ask: ray{}, cast{}, nearest{}, inside{}.
typedef enum sc_query { SC_RAY, SC_CAST, SC_NEAREST, SC_INSIDE, SC_QUERIES } sc_query;

typedef struct sc_query_def {
    uint64_t present;
    double from[2], to[2], angle, within;
    char ignore[SC_NAME_SIZE];
    bool one_way, sensors;
    int shape_count;
} sc_query_def;

typedef struct sc_body_def {
    uint64_t present[2];
    PL_BODY_ROWS(SC_MEMBER, )
    double angle_deg, density;
    double one_way[2], one_way_angle;
    sc_character_def character;
    int lock; ///< bits: SC_LOCK_X, ...
    bool hidden, user, sensor;
    sc_filter filter;
    char name[SC_NAME_SIZE];
    char label[SC_NAME_SIZE];
    sc_color color;
    sc_material *material;
    int shape_count;
} sc_body_def;

/// A body of the scene; the world's user data of the body point here.
typedef struct sc_body {
    sc_body_def def;
    plumb_body entity;
    bool is_named;
    int line;
    int object;        ///< registry reference of its Lua object
    int user;          ///< registry reference of its user table
    plumb_rot set_rot; ///< rotation right after `def.angle` was given to the world
    int visits;        ///< how often something began to overlap its sensors
    uint64_t listed;   ///< scene.list_number of the last list of bodies that it was put into
    sc_shape_def *shapes;
    bool is_part; ///< of a body that was cut or broke: "pane.3"
    bool is_seen; ///< a body that melts, burns or grows: its first shape, as the record has it
    plumb_real seen_mass;
    plumb_vec2 seen_corner;
} sc_body;

/// What a joint holds on to: a body, or the world.
typedef struct sc_end {
    plumb_body body;   ///< null: the world
    plumb_joint joint; ///< not null: given as a joint, whose B this is
    bool given;
} sc_end;

typedef struct sc_motor {
    uint64_t present;
    double speed, torque, force;
} sc_motor;

typedef struct sc_spring {
    uint64_t present;
    double damper, damping, frequency, rest, stiffness;
} sc_spring;

/// What plumb_joint_memory holds: only JSON says it.
typedef struct sc_joint_state {
    uint64_t present;
    double anchor_a[2], anchor_b[2], axis[2], offset[2], start[2], turns[2];
    double kept, substep, impulses[6];
} sc_joint_state;

typedef struct sc_joint_def {
    uint64_t present;
    plumb_joint_kind kind;
    char name[SC_NAME_SIZE];
    sc_end a, b;
    double at[2], at_a[2], at_b[2], wheel_a[2], wheel_b[2], axis[2], target[2], offset[2];
    double reference, limits[2], restitution, angle, length, ratio, pitch, radius_a, radius_b;
    double max_force, max_torque;
    PL_JOINT_BOUND_ROWS(SC_MEMBER, )
    bool collide, hidden;
    sc_motor motor;
    sc_spring spring;
    sc_joint_state state;
} sc_joint_def;

/// A joint of the scene; the world's user data of the joint point here.
typedef struct sc_joint {
    sc_joint_def def;
    plumb_joint entity;
    bool is_named;
    int line;
} sc_joint;

typedef struct sc_camera {
    uint64_t present;
    double center[2], height, fit[4], at, trail;
    char follow[SC_NAME_SIZE];
} sc_camera;

typedef struct sc_expect_def {
    uint64_t present;
    char name[128];
    double at, from, till;
    bool always;
    char body[SC_NAME_SIZE];
    double position[2], tolerance;
    double x[2], y[2], vx[2], vy[2], angle[2], spin[2], speed[2], temperature[2];
    double max_speed, min_speed, max_spin, max_penetration, energy_drift, momentum_drift;
    double count[2], value[2];
    char joint[SC_NAME_SIZE];
    double joint_value[2], reaction[2], reaction_torque[2], max_joint_error;
    double broken[2], visits[2], inside[2], alarms[2];
    char alarm[SC_NAME_SIZE]; ///< kind of the alarms that are meant; "": all
    char score[SC_NAME_SIZE];
    char exact[SC_NAME_SIZE];
    int test;
} sc_expect_def;

typedef struct sc_expect {
    sc_expect_def def;
    int line;
    scene_expect_status status;
    bool done;
    int exact;    ///< index of the exact{} that is meant
    double ratio; ///< how near to the limit: > 1 is broken
    double measured, limit, time;
    char quantity[2 * SC_NAME_SIZE];
    const char *unit;
    char description[320];
} sc_expect;

/// liquid{}
typedef struct sc_liquid_def {
    uint64_t present;
    char name[SC_NAME_SIZE]; ///< of its first phase
    char phase[SC_NAME_SIZE];
    double spacing, density, viscosity, tension, friction, velocity[2];
    sc_color color, dye;
    bool particles, phases, refill;
    int shape_count;
} sc_liquid_def;

/// One of `phases` of liquid{}
typedef struct sc_phase_def {
    uint64_t present;
    char name[SC_NAME_SIZE];
    double density, viscosity, friction;
    sc_color color;
} sc_phase_def;

/// air{}
typedef struct sc_air_def {
    uint64_t present;
    double at[2], size[2], cell, density, viscosity, temperature, fading, cooling, flow[2];
    int left, right, bottom, top;
    sc_color color;
    bool cells, hidden;
} sc_air_def;

/// waves{}
typedef struct sc_waves_def {
    uint64_t present;
    char body[SC_NAME_SIZE];
    double modes, damping, height, swell, swell_length;
    bool state;
} sc_waves_def;

typedef struct sc_waves {
    sc_waves_def def;
    plumb_shape shape;
} sc_waves;

/// light{}
typedef struct sc_light_def {
    uint64_t present;
    char name[SC_NAME_SIZE], body[SC_NAME_SIZE];
    double at[2], angle, power, length, polarization, bounces, least, around;
    double rays, width, spread;
    sc_color color;
    bool hidden, sensors;
} sc_light_def;

typedef struct sc_light {
    sc_light_def def;
    int number; ///< its object's
} sc_light;

/// air_source{}
typedef struct sc_source_def {
    uint64_t present;
    double at[2], radius, smoke, heat, push[2];
    char body[SC_NAME_SIZE];
} sc_source_def;

typedef struct sc_source {
    sc_source_def def;
    int number; ///< its object's
} sc_source;

/// rope{}, cloth{}, jelly{}, balloon{}, softbody{}
typedef enum sc_softbody_kind {
    SC_ROPE,
    SC_CLOTH,
    SC_JELLY,
    SC_BALLOON,
    SC_SOFTBODY,
    SC_SOFTBODY_KINDS
} sc_softbody_kind;

enum { SC_HOLD_FROM = 1, SC_HOLD_TO = 2 }; ///< bits of `hold`: "none|from|to|both"
enum { SC_HELD_NOT, SC_HELD_TOP, SC_HELD_CORNERS };

typedef struct sc_softbody_def {
    uint64_t present;
    double at[2], from[2], to[2], size[2], velocity[2];
    double length, mass, density, spacing, radius;
    double stiffness, shear, damping, bending, young, poisson;
    double friction, drag, break_strain, yield_strain;
    double pressure, ambient, area;
    double node_count, columns, row_count;
    char from_body[SC_NAME_SIZE], to_body[SC_NAME_SIZE];
    int hold, held, shape_count;
    bool pushes, sleep, asleep, nodes, edges, bends, triangles, ring, pins;
    sc_color color;
    sc_filter filter;
} sc_softbody_def;

typedef struct sc_softbody {
    sc_softbody_def def;
    sc_softbody_kind kind;
    plumb_softbody handle;
} sc_softbody;

/// attractor{}, zone{}, magnetic{}, mutual{}, formula{}
typedef enum sc_law_kind {
    SC_ATTRACTOR,
    SC_ZONE,
    SC_MAGNETIC,
    SC_MUTUAL,
    SC_FORMULA,
    SC_LAW_KINDS
} sc_law_kind;

typedef struct sc_law_def {
    uint64_t present;
    sc_law_kind kind;
    double at[2], angle, gravity[2], electric[2], half[2];
    double strength, softening, radius, priority;
    char body[SC_NAME_SIZE];
    uint64_t only; ///< bits: categories
    int on, falloff;
    bool replace;
    char x[PLUMB_LAW_FORMULA_MOST + 1], y[PLUMB_LAW_FORMULA_MOST + 1];
    char potential[PLUMB_LAW_FORMULA_MOST + 1];
} sc_law_def;

typedef struct sc_law {
    sc_law_def def;
    plumb_law handle;
} sc_law;

/// orbits{}
typedef struct sc_orbits_def {
    uint64_t present;
    double order, tolerance;
} sc_orbits_def;

/// blast{}
typedef struct sc_blast_def {
    uint64_t present;
    double at[2], radius, falloff, impulse;
    bool per_body;
    int occlusion;
    char ignore[SC_NAME_SIZE];
} sc_blast_def;

typedef struct sc_exact_def {
    uint64_t present;
    char name[SC_NAME_SIZE], body[SC_NAME_SIZE], unit[16];
    int x, y, angle, vx, vy, spin;
    int measure, value; ///< of what the script measures itself
    double at, from, till, scale;
} sc_exact_def;

typedef struct sc_contact_def {
    uint64_t present;
    char a[SC_NAME_SIZE], b[SC_NAME_SIZE];
    char joint[SC_NAME_SIZE]; ///< on_break, on_strain
    double speed;             ///< [m/s] on_hit
    int function;
} sc_contact_def;

/// A body that broke by itself in the last step.
typedef struct sc_shattered {
    plumb_body_break event;
    int parts; ///< registry reference of the list of their objects
} sc_shattered;

/// A body that melted, burnt or shrank away in the last step.
typedef struct sc_gone {
    plumb_body_gone event;
    char name[SC_NAME_SIZE];
    int object; ///< registry reference of its Lua object
} sc_gone;

typedef enum sc_handler_kind {
    SC_AT,
    SC_EVERY,
    SC_EVERY_STEP,
    SC_ON_CONTACT,
    SC_ON_END,
    SC_ON_HIT,
    SC_ON_ENTER,
    SC_ON_LEAVE,
    SC_ON_BREAK,
    SC_ON_STRAIN,
    SC_ON_SHATTER,
    SC_ON_GONE,
    SC_ON_WET,
    SC_ON_DRY,
    SC_EDIT_CONTACT,
    SC_FIELD ///< `a` is the body
} sc_handler_kind;

typedef struct sc_handler {
    sc_handler_kind kind;
    double time; ///< [s] at: when; every: the period
    double next; ///< every: number of the next call, whole; above 2^53 no whole number is left out
    bool spent;  ///< at: has been called
    int line;
    sc_contact_def contact;
} sc_handler;

typedef struct sc_score {
    char name[SC_NAME_SIZE];
    double value;
} sc_score;

typedef struct sc_param {
    char name[SC_NAME_SIZE];
    char value[SC_NAME_SIZE];
    bool overridden;
} sc_param;

typedef struct sc_set {
    char key[SC_NAME_SIZE];
    char value[256];
    bool used;
} sc_set;

/// A shape that the script made: for "is never used".
typedef struct sc_made {
    sc_shape_kind kind;
    int line;
    bool used, collected;
} sc_made;

/// What a Lua shape object holds; the points follow in the same block.
typedef struct sc_shape_object {
    sc_shape_def def;
    int made;  ///< index into s->made
    int epoch; ///< valid while s->epoch is the same
} sc_shape_object;

typedef struct sc_name {
    char text[SC_NAME_SIZE];
} sc_name;

/// A category of shapes; its bit is its place in the list. The first one is "default".
typedef struct sc_category {
    char name[SC_NAME_SIZE];
    bool is_had; ///< some shape is of it
    // Where it was named first, as sc_site.
    const char *construct, *key;
    int line;
    char path[SC_NAME_SIZE];
} sc_category;

/// Two bodies kept apart by exclude().
typedef struct sc_excluded {
    plumb_body a, b;
} sc_excluded;

#endif
