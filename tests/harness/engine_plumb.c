// engine_plumb.c - Plumb behind the neutral interface of engine.h, through its public headers only.
// Reads: nothing but its arguments. Writes: the world it owns. Refused calls are told on stderr.
//
// Materials are shared: one handle for each pair of friction and restitution; the density goes
// with the shape. Plumb gives impulses per substep: they are multiplied by the substeps here.
#include "engine.h"

#include "plumb/plumb.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { max_materials = 64 };

struct shared_material {
    double friction;
    double restitution;
    plumb_material handle;
};

struct engine_world {
    plumb_world *world;
    plumb_body *bodies;
    int *groups; // of the bodies
    int count;
    int material_count;
    struct shared_material materials[max_materials];
};

static plumb_vec2 vec(double x, double y)
{
    return (plumb_vec2){ (plumb_real)x, (plumb_real)y };
}

static void describe(char *text, size_t size)
{
    int lanes = 0;
    plumb_world *world = NULL;
    if (plumb_world_create(NULL, &world) == PLUMB_OK) {
        lanes = plumb_world_settings(world).simd_width;
        plumb_world_destroy(world);
    }
    snprintf(text, size, "Plumb %s (C, %s, %d lanes unless told otherwise)", PLUMB_VERSION,
             PLUMB_IS_FAR                           ? "far"
             : sizeof(plumb_real) == sizeof(double) ? "double"
                                                    : "float",
             lanes);
}

static void tell(void *context, plumb_log_level level, const char *message)
{
    (void)context;
    if (level == PLUMB_LOG_ERROR) {
        fprintf(stderr, "plumb: %s\n", message);
    }
}

// What can be switched in a world of the soft step, as members of its description.
static bool *switch_of(plumb_world_desc *desc, const char *name)
{
    const struct {
        const char *name;
        bool *member;
    } switches[] = {
        { "direct_joints", &desc->direct_joints },
        { "no_exact_islands", &desc->no_exact_islands },
        { "no_fine_islands", &desc->no_fine_islands },
        { "no_continuous", &desc->no_continuous },
        { "contact_impulses", &desc->contact_impulses },
        { "watchdog", &desc->watchdog },
        { "measure", &desc->measure },
    };
    for (size_t i = 0; i < sizeof switches / sizeof switches[0]; ++i) {
        if (strcmp(switches[i].name, name) == 0) {
            return switches[i].member;
        }
    }
    return NULL;
}

// False for a name that is neither a solver nor a switch.
static bool choose_solver(const struct engine_options *options, plumb_world_desc *desc)
{
    if (options->solver == NULL || strcmp(options->solver, "soft") == 0) {
        desc->solver = PLUMB_SOLVER_SOFT;
        return true;
    }
    if (strcmp(options->solver, "baseline") == 0) {
        desc->solver = PLUMB_SOLVER_PGS;
        desc->iterations = options->velocity_iterations;
        return true;
    }
    bool *member = switch_of(desc, options->solver);
    if (member != NULL) {
        *member = true;
    }
    return member != NULL;
}

static struct engine_world *create(const struct engine_options *options)
{
    plumb_world_desc desc = { 0 };
    struct engine_world *w = calloc(1, sizeof *w);
    if (w == NULL || !choose_solver(options, &desc)) {
        free(w);
        return NULL;
    }
    desc.gravity = vec(options->gravity_x, options->gravity_y);
    desc.zero_gravity = !(fabs(options->gravity_x) + fabs(options->gravity_y) > 0.0);
    desc.substeps = options->substeps;
    desc.no_continuous |= !options->continuous;
    desc.simd_width = options->width;
    desc.workers = options->workers;
    desc.no_sleep = !options->sleep;
    desc.log = tell;
    if (options->restitution_threshold > 0.0) {
        desc.restitution_speed = (plumb_real)options->restitution_threshold;
    }
    if (plumb_world_create(&desc, &w->world) != PLUMB_OK) {
        free(w);
        return NULL;
    }
    return w;
}

static void destroy(struct engine_world *w)
{
    plumb_world_destroy(w->world);
    free(w->bodies);
    free(w->groups);
    free(w);
}

static int add_body(struct engine_world *w, const struct engine_body_def *def)
{
    plumb_body *bodies = engine_grown(w->bodies, sizeof *bodies, w->count);
    w->bodies = bodies != NULL ? bodies : w->bodies;
    int *groups = engine_grown(w->groups, sizeof *groups, w->count);
    w->groups = groups != NULL ? groups : w->groups;
    if (bodies == NULL || groups == NULL) {
        return ENGINE_FAILED;
    }
    plumb_body_desc desc = { 0 };
    desc.type = def->type == ENGINE_DYNAMIC     ? PLUMB_DYNAMIC
                : def->type == ENGINE_KINEMATIC ? PLUMB_KINEMATIC
                                                : PLUMB_STATIC;
    desc.position = vec(def->x, def->y);
    desc.angle = (plumb_real)def->angle;
    desc.velocity = vec(def->vx, def->vy);
    desc.angular_velocity = (plumb_real)def->w;
    desc.fixed_rotation = def->fixed_rotation;
    desc.asleep = def->asleep;
    desc.user_data = (void *)(intptr_t)w->count;
    plumb_body body = plumb_body_create(w->world, &desc);
    if (plumb_is_null(body)) {
        return ENGINE_FAILED;
    }
    w->bodies[w->count] = body;
    w->groups[w->count] = def->group;
    return w->count++;
}

// Scenes of masses and joints of their own come to Plumb by its loader, not by this interface.
static int set_mass(struct engine_world *w, int body, const struct engine_mass *mass)
{
    (void)w;
    (void)body;
    (void)mass;
    return ENGINE_UNSUPPORTED;
}

static int add_joint(struct engine_world *w, const struct engine_joint_def *def)
{
    (void)w;
    (void)def;
    return ENGINE_UNSUPPORTED;
}

static int set_motor(struct engine_world *w, int joint, bool on, double speed, double max)
{
    (void)w;
    (void)joint;
    (void)on;
    (void)speed;
    (void)max;
    return ENGINE_UNSUPPORTED;
}

static void joint_force(const struct engine_world *w, int joint, double force[2], double *torque)
{
    (void)w;
    (void)joint;
    force[0] = force[1] = *torque = 0;
}

static void destroy_body(struct engine_world *w, int body)
{
    (void)plumb_body_destroy(w->world, w->bodies[body]);
}

static int add_hinge(struct engine_world *w, const struct engine_hinge_def *def)
{
    plumb_joint_desc desc = { .kind = PLUMB_REVOLUTE,
                              .body_a = w->bodies[def->body_a],
                              .body_b = w->bodies[def->body_b],
                              .anchor = vec(def->x, def->y),
                              .enable_limit = def->enable_limit,
                              .lower = (plumb_real)def->lower,
                              .upper = (plumb_real)def->upper,
                              .enable_motor = def->enable_motor,
                              .motor_speed = (plumb_real)def->motor_speed,
                              .max_motor = (plumb_real)def->max_torque };
    return plumb_is_null(plumb_joint_create(w->world, &desc)) ? ENGINE_FAILED : ENGINE_OK;
}

// The shared handle of a material; null when it cannot be made.
static plumb_material shared(struct engine_world *w, const struct engine_material *material)
{
    for (int i = 0; i < w->material_count; ++i) {
        const struct shared_material *m = &w->materials[i];
        if (!(m->friction < material->friction || m->friction > material->friction ||
              m->restitution < material->restitution || m->restitution > material->restitution)) {
            return m->handle;
        }
    }
    plumb_material none = PLUMB_NULL_INIT;
    if (w->material_count == max_materials) {
        return none;
    }
    plumb_material_desc desc = { 0 };
    desc.friction = (plumb_real)material->friction;
    desc.frictionless = desc.friction == 0;
    desc.restitution = (plumb_real)material->restitution;
    plumb_material handle = plumb_material_create(w->world, &desc);
    if (!plumb_is_null(handle)) {
        w->materials[w->material_count++] =
            (struct shared_material){ material->friction, material->restitution, handle };
    }
    return handle;
}

static int add_shape(struct engine_world *w, int body, const struct engine_material *material,
                     plumb_shape_desc *desc)
{
    desc->material = shared(w, material);
    if (plumb_is_null(desc->material)) {
        return ENGINE_FAILED;
    }
    // Lines have no mass, and so no density.
    if (desc->kind != PLUMB_SEGMENT && desc->kind != PLUMB_CHAIN) {
        desc->density = (plumb_real)material->density;
    }
    desc->filter.group = -w->groups[body];
    return plumb_is_null(plumb_shape_create(w->world, w->bodies[body], desc)) ? ENGINE_FAILED
                                                                              : ENGINE_OK;
}

static int add_circle(struct engine_world *w, int body, const struct engine_material *material,
                      double x, double y, double radius)
{
    plumb_shape_desc desc = { 0 };
    desc.kind = PLUMB_CIRCLE;
    desc.center = vec(x, y);
    desc.radius = (plumb_real)radius;
    return add_shape(w, body, material, &desc);
}

// Any shape that is given by points.
static int add_points(struct engine_world *w, int body, const struct engine_material *material,
                      plumb_shape_desc *desc, const double *x, const double *y, int count)
{
    plumb_vec2 *points = calloc((size_t)count, sizeof *points);
    if (points == NULL) {
        return ENGINE_FAILED;
    }
    for (int i = 0; i < count; ++i) {
        points[i] = vec(x[i], y[i]);
    }
    desc->points = points;
    desc->count = count;
    int status = add_shape(w, body, material, desc);
    free(points);
    return status;
}

static int add_capsule(struct engine_world *w, int body, const struct engine_material *material,
                       double x1, double y1, double x2, double y2, double radius)
{
    plumb_shape_desc desc = { 0 };
    desc.kind = PLUMB_CAPSULE;
    desc.radius = (plumb_real)radius;
    const double x[2] = { x1, x2 };
    const double y[2] = { y1, y2 };
    return add_points(w, body, material, &desc, x, y, 2);
}

static int add_polygon(struct engine_world *w, int body, const struct engine_material *material,
                       const double *x, const double *y, int count, double radius)
{
    if (count > PLUMB_POLYGON_MAX_VERTICES) {
        return ENGINE_UNSUPPORTED;
    }
    plumb_shape_desc desc = { 0 };
    desc.kind = PLUMB_POLYGON;
    desc.radius = (plumb_real)radius;
    return add_points(w, body, material, &desc, x, y, count);
}

static int add_segment(struct engine_world *w, int body, const struct engine_material *material,
                       double x1, double y1, double x2, double y2)
{
    plumb_shape_desc desc = { 0 };
    desc.kind = PLUMB_SEGMENT;
    const double x[2] = { x1, x2 };
    const double y[2] = { y1, y2 };
    return add_points(w, body, material, &desc, x, y, 2);
}

static int add_chain(struct engine_world *w, int body, const struct engine_material *material,
                     const double *x, const double *y, int count, bool loop)
{
    if (count < 3) {
        return ENGINE_UNSUPPORTED;
    }
    plumb_shape_desc desc = { 0 };
    desc.kind = PLUMB_CHAIN;
    desc.closed = loop;
    return add_points(w, body, material, &desc, x, y, count);
}

static void set_velocity(struct engine_world *w, int body, double vx, double vy, double angular)
{
    (void)plumb_body_set_velocity(w->world, w->bodies[body], vec(vx, vy));
    (void)plumb_body_set_angular_velocity(w->world, w->bodies[body], (plumb_real)angular);
}

static void apply_force(struct engine_world *w, int body, double fx, double fy, double torque)
{
    (void)plumb_body_apply_force_center(w->world, w->bodies[body], vec(fx, fy));
    (void)plumb_body_apply_torque(w->world, w->bodies[body], (plumb_real)torque);
}

static void step(struct engine_world *w, double dt)
{
    if (plumb_world_step(w->world, (plumb_real)dt) != PLUMB_OK) {
        // A world that does not step would pass for a very fast one.
        fprintf(stderr, "plumb: the step was refused\n");
        abort();
    }
}

static struct engine_pose get_pose(const struct engine_world *w, int body)
{
    plumb_transform t = plumb_body_transform(w->world, w->bodies[body]);
    double c = (double)t.q.c;
    double s = (double)t.q.s;
    return (struct engine_pose){ (double)t.p.x, (double)t.p.y, c, s, atan2(s, c) };
}

static struct engine_velocity get_velocity(const struct engine_world *w, int body)
{
    plumb_vec2 v = plumb_body_velocity(w->world, w->bodies[body]);
    double angular = (double)plumb_body_angular_velocity(w->world, w->bodies[body]);
    return (struct engine_velocity){ (double)v.x, (double)v.y, angular };
}

static struct engine_mass get_mass(const struct engine_world *w, int body)
{
    plumb_vec2 c = plumb_body_local_center(w->world, w->bodies[body]);
    return (struct engine_mass){ (double)plumb_body_mass(w->world, w->bodies[body]),
                                 (double)plumb_body_inertia(w->world, w->bodies[body]), (double)c.x,
                                 (double)c.y };
}

static int body_index(const struct engine_world *w, plumb_body body)
{
    return (int)(intptr_t)plumb_body_user_data(w->world, body);
}

static void contacts(const struct engine_world *w, engine_contact_fn *visit, void *context)
{
    int count = plumb_world_contacts(w->world, NULL, 0);
    plumb_contact *list = calloc((size_t)(count > 0 ? count : 1), sizeof *list);
    if (list == NULL) {
        return;
    }
    const int substeps = plumb_world_settings(w->world).substeps;
    count = plumb_world_contacts(w->world, list, count);
    for (int i = 0; i < count; ++i) {
        struct engine_contact point;
        point.body_a = body_index(w, list[i].body_a);
        point.body_b = body_index(w, list[i].body_b);
        point.nx = (double)list[i].normal.x;
        point.ny = (double)list[i].normal.y;
        for (int k = 0; k < list[i].point_count; ++k) {
            const plumb_contact_point *p = &list[i].points[k];
            point.x = (double)p->point.x;
            point.y = (double)p->point.y;
            point.separation = (double)p->separation;
            point.impulse = (double)p->normal_impulse * substeps;
            visit(context, &point);
        }
    }
    free(list);
}

static struct engine_counts counts(const struct engine_world *w)
{
    plumb_stats stats = plumb_world_stats(w->world);
    return (struct engine_counts){ (int)stats.body_count, (int)stats.contact_count,
                                   plumb_world_joints(w->world, NULL, 0) };
}

static struct engine_touches touches(const struct engine_world *w)
{
    struct engine_touches t;
    plumb_world_begin_events(w->world, &t.begins);
    plumb_world_end_events(w->world, &t.ends);
    return t;
}

static double skin(const struct engine_world *w)
{
    (void)w;
    return 0.0;
}

static size_t bytes(const struct engine_world *w)
{
    return plumb_world_stats(w->world).bytes;
}

const struct engine engine_plumb = {
    .name = "plumb",
    .has_threads = true,
    .has_solver = true,
    ENGINE_FUNCTIONS,
};
