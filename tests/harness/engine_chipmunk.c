// engine_chipmunk.c - Chipmunk 7.0.3 (C, double) behind the neutral interface of engine.h.
// Reads: nothing but its arguments. Writes: the cpSpace it owns.
//
// Facts of that version that the code rests on (its public headers and manual): positions are those of the body's origin,
// velocities those of its centre of gravity; a step is not divided, so options.substeps steps it that many times; friction
// and restitution of a pair are products of the two, so shapes have the root of their friction, and a handler sets
// the larger restitution; infinite moments mean no rotation; joints tell the size of their impulse, not its direction.
#include "engine.h"

#include <chipmunk/chipmunk.h>

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { DEFAULT_ITERATIONS = 10 };
static const double STIFF_SLOP = 1e-4; // [m] the default is a tenth of a unit

struct engine_world {
    cpSpace *space;
    cpBody **bodies;
    int *groups; // of the bodies
    int count;
    cpConstraint **joints;
    cpConstraint **motors; // of joints; NULL: none
    int joint_count;
    int substeps;
    double inner_step; // [s] the last
};

static cpVect vec(double x, double y)
{
    return cpv(x, y);
}

static void describe(char *text, size_t size)
{
    snprintf(text, size, "Chipmunk %s (C, %s)", cpVersionString,
             sizeof(cpFloat) == sizeof(double) ? "double" : "float");
}

// The larger restitution of the two, which their shapes carry beside their product.
static cpBool mix_restitution(cpArbiter *arbiter, cpSpace *space, cpDataPointer unused)
{
    (void)space;
    (void)unused;
    cpShape *a, *b;
    cpArbiterGetShapes(arbiter, &a, &b);
    cpArbiterSetRestitution(arbiter, fmax(cpShapeGetElasticity(a), cpShapeGetElasticity(b)));
    return cpTrue;
}

static struct engine_world *create(const struct engine_options *options)
{
    struct engine_world *w = calloc(1, sizeof *w);
    if (w == NULL) {
        return NULL;
    }
    w->space = cpSpaceNew();
    w->substeps = options->substeps > 0 ? options->substeps : 1;
    cpSpaceSetGravity(w->space, vec(options->gravity_x, options->gravity_y));
    cpSpaceSetIterations(w->space, options->velocity_iterations > 0 ? options->velocity_iterations
                                                                    : DEFAULT_ITERATIONS);
    if (options->sleep) {
        cpSpaceSetSleepTimeThreshold(w->space, 0.5);
    }
    if (options->stiff) {
        cpSpaceSetCollisionSlop(w->space, STIFF_SLOP);
    }
    cpSpaceAddDefaultCollisionHandler(w->space)->preSolveFunc = mix_restitution;
    return w;
}

static void free_shape(cpBody *body, cpShape *shape, void *space)
{
    (void)body;
    cpSpaceRemoveShape(space, shape);
    cpShapeFree(shape);
}

static void free_joint(cpBody *body, cpConstraint *joint, void *world)
{
    struct engine_world *w = world;
    (void)body;
    for (int i = 0; i < w->joint_count; ++i) {
        w->joints[i] = w->joints[i] == joint ? NULL : w->joints[i];
        w->motors[i] = w->motors[i] == joint ? NULL : w->motors[i];
    }
    cpSpaceRemoveConstraint(w->space, joint);
    cpConstraintFree(joint);
}

static void destroy_body(struct engine_world *w, int body)
{
    cpBody *b = w->bodies[body];
    if (b != NULL) {
        cpBodyEachConstraint(b, free_joint, w);
        cpBodyEachShape(b, free_shape, w->space);
        cpSpaceRemoveBody(w->space, b);
        cpBodyFree(b);
        w->bodies[body] = NULL;
    }
}

static void destroy(struct engine_world *w)
{
    for (int i = 0; i < w->count; ++i) {
        destroy_body(w, i);
    }
    cpSpaceFree(w->space);
    free(w->bodies);
    free(w->groups);
    free(w->joints);
    free(w->motors);
    free(w);
}

static int add_body(struct engine_world *w, const struct engine_body_def *def)
{
    cpBody **bodies = engine_grown(w->bodies, sizeof *bodies, w->count);
    w->bodies = bodies != NULL ? bodies : w->bodies;
    int *groups = engine_grown(w->groups, sizeof *groups, w->count);
    w->groups = groups != NULL ? groups : w->groups;
    if (bodies == NULL || groups == NULL) {
        return ENGINE_FAILED;
    }
    cpBody *b = def->type == ENGINE_STATIC      ? cpBodyNewStatic()
                : def->type == ENGINE_KINEMATIC ? cpBodyNewKinematic()
                                                : cpBodyNew(0, 0);
    cpSpaceAddBody(w->space, b);
    cpBodySetPosition(b, vec(def->x, def->y));
    cpBodySetAngle(b, def->angle);
    if (def->type != ENGINE_STATIC) {
        cpBodySetVelocity(b, vec(def->vx, def->vy));
        cpBodySetAngularVelocity(b, def->w);
    }
    w->bodies[w->count] = b;
    w->groups[w->count] = def->group;
    return w->count++;
}

static int set_mass(struct engine_world *w, int body, const struct engine_mass *mass)
{
    cpBody *b = w->bodies[body];
    cpBodySetMass(b, mass->mass);
    cpBodySetMoment(b, mass->inertia > 0 ? mass->inertia : INFINITY);
    cpBodySetCenterOfGravity(b, vec(mass->x, mass->y));
    return ENGINE_OK;
}

static int keep_joint(struct engine_world *w, cpConstraint *joint, bool collide)
{
    cpConstraint **joints = engine_grown(w->joints, sizeof(cpConstraint *), w->joint_count);
    w->joints = joints != NULL ? joints : w->joints;
    cpConstraint **motors = engine_grown(w->motors, sizeof(cpConstraint *), w->joint_count);
    w->motors = motors != NULL ? motors : w->motors;
    if (joints == NULL || motors == NULL) {
        cpConstraintFree(joint);
        return ENGINE_FAILED;
    }
    w->motors[w->joint_count] = NULL;
    cpConstraintSetCollideBodies(joint, collide);
    w->joints[w->joint_count] = cpSpaceAddConstraint(w->space, joint);
    return w->joint_count++;
}

static cpConstraint *make_distance(cpBody *a, cpBody *b, cpVect at_a, cpVect at_b,
                                   const struct engine_joint_def *def)
{
    if (def->hertz > 0) {
        return cpDampedSpringNew(a, b, at_a, at_b, def->rest, def->stiffness, def->resistance);
    }
    if (def->enable_limit) {
        return cpSlideJointNew(a, b, at_a, at_b, def->lower, def->upper);
    }
    cpConstraint *joint = cpPinJointNew(a, b, at_a, at_b);
    cpPinJointSetDist(joint, def->rest);
    return joint;
}

static int set_motor(struct engine_world *w, int joint, bool on, double speed, double max)
{
    cpConstraint *j = w->joints[joint], *motor = w->motors[joint];
    if (j == NULL || !cpConstraintIsPivotJoint(j)) {
        return ENGINE_UNSUPPORTED;
    }
    if (motor == NULL) {
        motor = cpSimpleMotorNew(cpConstraintGetBodyA(j), cpConstraintGetBodyB(j), 0);
        w->motors[joint] = cpSpaceAddConstraint(w->space, motor);
    }
    cpSimpleMotorSetRate(motor, -speed);
    cpConstraintSetMaxForce(motor, on ? max : 0);
    return ENGINE_OK;
}

// What takes two joints of Chipmunk (limits, motors, slides that do not turn) keeps the first as the one that is told.
static int add_joint(struct engine_world *w, const struct engine_joint_def *def)
{
    cpBody *a = w->bodies[def->body_a], *b = w->bodies[def->body_b];
    cpVect at = vec(def->ax, def->ay);
    bool slides = def->kind == ENGINE_PRISMATIC;
    if ((def->hertz > 0 && ((def->kind != ENGINE_DISTANCE && !slides) || def->enable_limit)) ||
        (slides && def->enable_motor)) {
        return ENGINE_UNSUPPORTED;
    }
    cpVect at_a = cpBodyWorldToLocal(a, at);
    cpVect at_b = cpBodyWorldToLocal(b, vec(def->bx, def->by));
    if (def->kind == ENGINE_DISTANCE) {
        return keep_joint(w, make_distance(a, b, at_a, at_b, def), def->collide);
    }
    if (def->kind == ENGINE_PRISMATIC) {
        const double far = 1e3; // [m] a groove has two ends
        const double ends[2] = { def->enable_limit ? def->lower : -far,
                                 def->enable_limit ? def->upper : far };
        cpVect axis = vec(def->ux, def->uy), u = cpvmult(axis, far);
        cpVect first = cpvadd(at, cpvmult(axis, ends[0]));
        cpVect last = cpvadd(at, cpvmult(axis, ends[1]));
        int joint = keep_joint(
            w,
            cpGrooveJointNew(a, b, cpBodyWorldToLocal(a, first), cpBodyWorldToLocal(a, last), at_b),
            def->collide);
        double turn = cpBodyGetAngle(b) - cpBodyGetAngle(a);
        cpSpaceAddConstraint(w->space, cpGearJointNew(a, b, turn, 1));
        if (def->hertz > 0) { // from a point far down the groove: along it, that is the same spring
            cpVect away = cpBodyWorldToLocal(a, cpvsub(at, u));
            cpSpaceAddConstraint(w->space, cpDampedSpringNew(a, b, away, at_b, far + def->rest,
                                                             def->stiffness, def->resistance));
        }
        return joint;
    }
    int joint = keep_joint(w, cpPivotJointNew2(a, b, at_a, at_b), def->collide);
    double turn = cpBodyGetAngle(b) - cpBodyGetAngle(a);
    if (def->kind == ENGINE_WELD) {
        cpSpaceAddConstraint(w->space, cpGearJointNew(a, b, turn, 1));
    }
    if (def->enable_limit) {
        cpSpaceAddConstraint(w->space,
                             cpRotaryLimitJointNew(a, b, turn + def->lower, turn + def->upper));
    }
    if (def->enable_motor && joint >= 0) {
        (void)set_motor(w, joint, true, def->motor_speed, def->max_motor);
    }
    return joint;
}

static void joint_force(const struct engine_world *w, int joint, double force[2], double *torque)
{
    cpConstraint *j = w->joints[joint];
    force[0] = j != NULL && w->inner_step > 0 ? cpConstraintGetImpulse(j) / w->inner_step : 0;
    force[1] = *torque = 0;
}

static int add_hinge(struct engine_world *w, const struct engine_hinge_def *def)
{
    struct engine_joint_def joint = { .kind = ENGINE_REVOLUTE,
                                      .body_a = def->body_a,
                                      .body_b = def->body_b,
                                      .ax = def->x,
                                      .ay = def->y,
                                      .bx = def->x,
                                      .by = def->y,
                                      .enable_limit = def->enable_limit,
                                      .lower = def->lower,
                                      .upper = def->upper,
                                      .enable_motor = def->enable_motor,
                                      .motor_speed = def->motor_speed,
                                      .max_motor = def->max_torque };
    return add_joint(w, &joint) >= 0 ? ENGINE_OK : ENGINE_FAILED;
}

static int add_shape(struct engine_world *w, int body, const struct engine_material *material,
                     cpShape *shape, bool has_mass)
{
    bool moves = cpBodyGetType(w->bodies[body]) == CP_BODY_TYPE_DYNAMIC;
    if (shape == NULL) {
        return ENGINE_FAILED;
    }
    cpShapeSetFriction(shape, sqrt(material->friction));
    cpShapeSetElasticity(shape, material->restitution);
    if (moves && has_mass) {
        cpShapeSetDensity(shape, material->density);
    }
    cpShapeSetFilter(
        shape, cpShapeFilterNew((cpGroup)w->groups[body], CP_ALL_CATEGORIES, CP_ALL_CATEGORIES));
    cpSpaceAddShape(w->space, shape);
    return ENGINE_OK;
}

static int add_circle(struct engine_world *w, int body, const struct engine_material *material,
                      double x, double y, double radius)
{
    return add_shape(w, body, material, cpCircleShapeNew(w->bodies[body], radius, vec(x, y)), true);
}

static int add_capsule(struct engine_world *w, int body, const struct engine_material *material,
                       double x1, double y1, double x2, double y2, double radius)
{
    return add_shape(w, body, material,
                     cpSegmentShapeNew(w->bodies[body], vec(x1, y1), vec(x2, y2), radius), true);
}

static int add_polygon(struct engine_world *w, int body, const struct engine_material *material,
                       const double *x, const double *y, int count, double radius)
{
    cpVect points[64];
    if (count > 64) {
        return ENGINE_UNSUPPORTED;
    }
    for (int i = 0; i < count; ++i) {
        points[i] = vec(x[i], y[i]);
    }
    return add_shape(w, body, material,
                     cpPolyShapeNew(w->bodies[body], count, points, cpTransformIdentity, radius),
                     true);
}

static int add_segment(struct engine_world *w, int body, const struct engine_material *material,
                       double x1, double y1, double x2, double y2)
{
    return add_shape(w, body, material,
                     cpSegmentShapeNew(w->bodies[body], vec(x1, y1), vec(x2, y2), 0), false);
}

// Chipmunk has no chains: edges that know their neighbours.
static int add_chain(struct engine_world *w, int body, const struct engine_material *material,
                     const double *x, const double *y, int count, bool loop)
{
    for (int i = 0; i < count - !loop; ++i) {
        int k = (i + 1) % count, before = (i + count - 1) % count, after = (k + 1) % count;
        cpShape *edge = cpSegmentShapeNew(w->bodies[body], vec(x[i], y[i]), vec(x[k], y[k]), 0);
        if (edge != NULL && (loop || (i > 0 && k < count - 1))) {
            cpSegmentShapeSetNeighbors(edge, vec(x[before], y[before]), vec(x[after], y[after]));
        }
        if (add_shape(w, body, material, edge, false) != ENGINE_OK) {
            return ENGINE_FAILED;
        }
    }
    return ENGINE_OK;
}

static void set_velocity(struct engine_world *w, int body, double vx, double vy, double angular)
{
    cpBodySetVelocity(w->bodies[body], vec(vx, vy));
    cpBodySetAngularVelocity(w->bodies[body], angular);
}

static void apply_force(struct engine_world *w, int body, double fx, double fy, double torque)
{
    cpBody *b = w->bodies[body];
    cpBodySetForce(b, cpvadd(cpBodyGetForce(b), vec(fx, fy)));
    cpBodySetTorque(b, cpBodyGetTorque(b) + torque);
}

static void step(struct engine_world *w, double dt)
{
    w->inner_step = dt / w->substeps;
    for (int i = 0; i < w->substeps; ++i) {
        cpSpaceStep(w->space, w->inner_step); // which forgets forces at its end
    }
}

static struct engine_pose get_pose(const struct engine_world *w, int body)
{
    cpBody *b = w->bodies[body];
    cpVect p = cpBodyGetPosition(b);
    double angle = cpBodyGetAngle(b);
    return (struct engine_pose){ p.x, p.y, cos(angle), sin(angle), angle };
}

static struct engine_velocity get_velocity(const struct engine_world *w, int body)
{
    cpVect v = cpBodyGetVelocity(w->bodies[body]);
    return (struct engine_velocity){ v.x, v.y, cpBodyGetAngularVelocity(w->bodies[body]) };
}

static struct engine_mass get_mass(const struct engine_world *w, int body)
{
    cpBody *b = w->bodies[body];
    bool moves = cpBodyGetType(b) == CP_BODY_TYPE_DYNAMIC;
    cpVect c = cpBodyGetCenterOfGravity(b);
    double inertia = moves && isfinite(cpBodyGetMoment(b)) ? cpBodyGetMoment(b) : 0;
    return (struct engine_mass){ moves ? cpBodyGetMass(b) : 0, inertia, c.x, c.y };
}

static void contacts(const struct engine_world *w, engine_contact_fn *visit, void *context)
{
    (void)w; // not asked for by any test of this engine
    (void)visit;
    (void)context;
}

static struct engine_counts counts(const struct engine_world *w)
{
    return (struct engine_counts){ w->count, 0, w->joint_count };
}

static struct engine_touches touches(const struct engine_world *w)
{
    (void)w;
    return (struct engine_touches){ 0, 0 };
}

static double skin(const struct engine_world *w)
{
    (void)w;
    return 0;
}

static size_t bytes(const struct engine_world *w)
{
    (void)w;
    return 0;
}

const struct engine engine_chipmunk = {
    .name = "chipmunk",
    .has_threads = false,
    .has_solver = false,
    ENGINE_FUNCTIONS,
};
