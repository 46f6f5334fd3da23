// engine_box2d3.c - Box2D 3 (C) behind the neutral interface of engine.h.
// Built only when BOX2D3=/prefix is given; uses that library's public headers and nothing else.
// Reads: nothing but its arguments. Writes: the world it owns.
//
// Angles go in and out as cosine and sine, because the library's own arc tangent is an
// approximation. Threads are its own, as many as asked for; contact stiffness, damping and recycling are the library's defaults.
#include "engine.h"

#include <box2d/box2d.h>

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

// The value that Box2D 3 recommends and its own benchmark uses.
enum { default_substeps = 4 };

struct engine_world {
    b2WorldId id;
    b2BodyId *bodies;
    int *groups; // of the bodies
    int count;
    int substeps;
    bool stiff;
    b2JointId *joints; // of add_joint
    int joint_count;
};

static b2Vec2 vec(double x, double y)
{
    return (b2Vec2){ (float)x, (float)y };
}

static void describe(char *text, size_t size)
{
    b2Version v = b2GetVersion();
    snprintf(text, size, "Box2D %d.%d.%d (C, built beside by hand)", v.major, v.minor, v.revision);
}

static struct engine_world *create(const struct engine_options *options)
{
    struct engine_world *w = calloc(1, sizeof *w);
    if (w == NULL) {
        return NULL;
    }
    b2WorldDef def = b2DefaultWorldDef();
    def.gravity = vec(options->gravity_x, options->gravity_y);
    def.enableSleep = options->sleep;
    def.enableContinuous = options->continuous;
    def.workerCount = options->workers > 1 ? options->workers : 1;
    if (options->restitution_threshold >= 0.0) {
        def.restitutionThreshold = (float)options->restitution_threshold;
    }
    if (options->stiff) {
        // The library lowers what is stiffer than the step allows: the manual's advice for the least give.
        def.contactHertz = 1e4f;
    }
    w->stiff = options->stiff;
    w->substeps = options->substeps > 0 ? options->substeps : default_substeps;
    w->id = b2CreateWorld(&def);
    return w;
}

static void destroy(struct engine_world *w)
{
    b2DestroyWorld(w->id);
    free(w->bodies);
    free(w->groups);
    free(w->joints);
    free(w);
}

static int add_body(struct engine_world *w, const struct engine_body_def *def)
{
    b2BodyId *bodies = engine_grown(w->bodies, sizeof *bodies, w->count);
    w->bodies = bodies != NULL ? bodies : w->bodies;
    int *groups = engine_grown(w->groups, sizeof *groups, w->count);
    w->groups = groups != NULL ? groups : w->groups;
    if (bodies == NULL || groups == NULL) {
        return ENGINE_FAILED;
    }
    b2BodyDef b = b2DefaultBodyDef();
    b.type = def->type == ENGINE_DYNAMIC     ? b2_dynamicBody
             : def->type == ENGINE_KINEMATIC ? b2_kinematicBody
                                             : b2_staticBody;
    b.position = b2ToPos(vec(def->x, def->y));
    b.rotation = (b2Rot){ (float)cos(def->angle), (float)sin(def->angle) };
    b.linearVelocity = vec(def->vx, def->vy);
    b.angularVelocity = (float)def->w;
    b.motionLocks.angularZ = def->fixed_rotation;
    b.isAwake = !def->asleep;
    b.userData = (void *)(intptr_t)w->count;
    w->bodies[w->count] = b2CreateBody(w->id, &b);
    w->groups[w->count] = def->group;
    return w->count++;
}

static void destroy_body(struct engine_world *w, int body)
{
    b2DestroyBody(w->bodies[body]);
    w->bodies[body] = b2_nullBodyId;
}

static b2Transform frame_at(b2BodyId body, double x, double y)
{
    // Both frames have the world's axes now, so that the angle between them is 0.
    b2Rot turn = b2Body_GetRotation(body);
    return (b2Transform){ b2Body_GetLocalPoint(body, b2ToPos(vec(x, y))), b2InvertRot(turn) };
}

static int set_mass(struct engine_world *w, int body, const struct engine_mass *mass)
{
    b2MassData data = { (float)mass->mass, vec(mass->x, mass->y), (float)mass->inertia };
    b2Vec2 v = b2Body_GetLinearVelocity(w->bodies[body]);
    b2Body_SetMassData(w->bodies[body], data);
    b2Body_SetLinearVelocity(w->bodies[body], v); // of the centre of mass, which has moved
    return ENGINE_OK;
}

// Frames at the anchors whose x axis is the joint's, both as things are.
static void place_frames(const struct engine_joint_def *def, b2JointDef *base)
{
    b2Rot axis = def->kind == ENGINE_PRISMATIC ? (b2Rot){ (float)def->ux, (float)def->uy }
                                               : (b2Rot){ 1.0f, 0.0f };
    bool two = def->kind == ENGINE_DISTANCE || def->kind == ENGINE_REVOLUTE;
    base->localFrameA = frame_at(base->bodyIdA, def->ax, def->ay);
    base->localFrameB = frame_at(base->bodyIdB, two ? def->bx : def->ax, two ? def->by : def->ay);
    base->localFrameA.q = b2MulRot(base->localFrameA.q, axis);
    base->localFrameB.q = b2MulRot(base->localFrameB.q, axis);
    base->collideConnected = def->collide;
}

static b2JointId make_revolute(struct engine_world *w, const struct engine_joint_def *def,
                               const b2JointDef *base)
{
    b2RevoluteJointDef j = b2DefaultRevoluteJointDef();
    j.base = *base;
    j.enableLimit = def->enable_limit;
    j.lowerAngle = (float)def->lower;
    j.upperAngle = (float)def->upper;
    j.enableMotor = def->enable_motor;
    j.motorSpeed = (float)def->motor_speed;
    j.maxMotorTorque = (float)def->max_motor;
    return b2CreateRevoluteJoint(w->id, &j);
}

static b2JointId make_prismatic(struct engine_world *w, const struct engine_joint_def *def,
                                const b2JointDef *base)
{
    b2PrismaticJointDef j = b2DefaultPrismaticJointDef();
    j.base = *base;
    j.enableLimit = def->enable_limit;
    j.lowerTranslation = (float)def->lower;
    j.upperTranslation = (float)def->upper;
    j.enableMotor = def->enable_motor;
    j.motorSpeed = (float)def->motor_speed;
    j.maxMotorForce = (float)def->max_motor;
    j.enableSpring = def->hertz > 0;
    j.hertz = (float)def->hertz;
    j.dampingRatio = (float)def->damping;
    j.targetTranslation = (float)def->rest;
    return b2CreatePrismaticJoint(w->id, &j);
}

static b2JointId make_distance(struct engine_world *w, const struct engine_joint_def *def,
                               const b2JointDef *base)
{
    b2DistanceJointDef j = b2DefaultDistanceJointDef();
    j.base = *base;
    j.length = (float)def->rest;
    j.enableLimit = def->enable_limit;
    j.minLength = (float)def->lower;
    j.maxLength = (float)def->upper;
    // A rope is a spring without force between its stops.
    j.enableSpring = def->hertz > 0 || def->enable_limit;
    j.hertz = (float)def->hertz;
    j.dampingRatio = (float)def->damping;
    return b2CreateDistanceJoint(w->id, &j);
}

static int add_joint(struct engine_world *w, const struct engine_joint_def *def)
{
    if (def->hertz > 0 && def->kind != ENGINE_DISTANCE && def->kind != ENGINE_PRISMATIC) {
        return ENGINE_UNSUPPORTED;
    }
    b2JointId *joints = engine_grown(w->joints, sizeof *joints, w->joint_count);
    if (joints == NULL) {
        return ENGINE_FAILED;
    }
    w->joints = joints;
    b2WeldJointDef weld = b2DefaultWeldJointDef();
    b2JointDef base = weld.base;
    base.bodyIdA = w->bodies[def->body_a];
    base.bodyIdB = w->bodies[def->body_b];
    if (w->stiff) {
        base.constraintHertz = 1e4f; // lowered to what the step allows
    }
    place_frames(def, &base);
    weld.base = base;
    b2JointId joint = def->kind == ENGINE_REVOLUTE    ? make_revolute(w, def, &base)
                      : def->kind == ENGINE_PRISMATIC ? make_prismatic(w, def, &base)
                      : def->kind == ENGINE_DISTANCE  ? make_distance(w, def, &base)
                                                      : b2CreateWeldJoint(w->id, &weld);
    w->joints[w->joint_count] = joint;
    return b2Joint_IsValid(joint) ? w->joint_count++ : ENGINE_FAILED;
}

static int set_motor(struct engine_world *w, int joint, bool on, double speed, double max)
{
    b2JointId j = w->joints[joint];
    if (b2Joint_GetType(j) != b2_revoluteJoint) {
        return ENGINE_UNSUPPORTED;
    }
    b2RevoluteJoint_EnableMotor(j, on);
    b2RevoluteJoint_SetMotorSpeed(j, (float)speed);
    b2RevoluteJoint_SetMaxMotorTorque(j, (float)max);
    b2Joint_WakeBodies(j);
    return ENGINE_OK;
}

static void joint_force(const struct engine_world *w, int joint, double force[2], double *torque)
{
    b2Vec2 f = b2Joint_GetConstraintForce(w->joints[joint]);
    force[0] = (double)f.x;
    force[1] = (double)f.y;
    *torque = (double)b2Joint_GetConstraintTorque(w->joints[joint]);
}

static int add_hinge(struct engine_world *w, const struct engine_hinge_def *def)
{
    b2RevoluteJointDef j = b2DefaultRevoluteJointDef();
    j.base.bodyIdA = w->bodies[def->body_a];
    j.base.bodyIdB = w->bodies[def->body_b];
    j.base.localFrameA = frame_at(j.base.bodyIdA, def->x, def->y);
    j.base.localFrameB = frame_at(j.base.bodyIdB, def->x, def->y);
    j.enableLimit = def->enable_limit;
    j.lowerAngle = (float)def->lower;
    j.upperAngle = (float)def->upper;
    j.enableMotor = def->enable_motor;
    j.motorSpeed = (float)def->motor_speed;
    j.maxMotorTorque = (float)def->max_torque;
    return b2Joint_IsValid(b2CreateRevoluteJoint(w->id, &j)) ? ENGINE_OK : ENGINE_FAILED;
}

static b2ShapeDef shape_def(const struct engine_world *w, int body,
                            const struct engine_material *material)
{
    b2ShapeDef def = b2DefaultShapeDef();
    def.filter.groupIndex = -w->groups[body];
    def.density = (float)material->density;
    def.material.friction = (float)material->friction;
    def.material.restitution = (float)material->restitution;
    return def;
}

static int add_circle(struct engine_world *w, int body, const struct engine_material *material,
                      double x, double y, double radius)
{
    b2ShapeDef def = shape_def(w, body, material);
    b2Circle circle = { vec(x, y), (float)radius };
    return b2Shape_IsValid(b2CreateCircleShape(w->bodies[body], &def, &circle)) ? ENGINE_OK
                                                                                : ENGINE_FAILED;
}

static int add_capsule(struct engine_world *w, int body, const struct engine_material *material,
                       double x1, double y1, double x2, double y2, double radius)
{
    b2ShapeDef def = shape_def(w, body, material);
    b2Capsule capsule = { vec(x1, y1), vec(x2, y2), (float)radius };
    return b2Shape_IsValid(b2CreateCapsuleShape(w->bodies[body], &def, &capsule)) ? ENGINE_OK
                                                                                  : ENGINE_FAILED;
}

static int add_polygon(struct engine_world *w, int body, const struct engine_material *material,
                       const double *x, const double *y, int count, double radius)
{
    if (count > B2_MAX_POLYGON_VERTICES) {
        return ENGINE_UNSUPPORTED;
    }
    b2Vec2 points[B2_MAX_POLYGON_VERTICES];
    for (int i = 0; i < count; ++i) {
        points[i] = vec(x[i], y[i]);
    }
    b2Hull hull = b2ComputeHull(points, count);
    if (hull.count == 0) {
        return ENGINE_FAILED;
    }
    b2ShapeDef def = shape_def(w, body, material);
    b2Polygon polygon = b2MakePolygon(&hull, (float)radius);
    return b2Shape_IsValid(b2CreatePolygonShape(w->bodies[body], &def, &polygon)) ? ENGINE_OK
                                                                                  : ENGINE_FAILED;
}

static int add_segment(struct engine_world *w, int body, const struct engine_material *material,
                       double x1, double y1, double x2, double y2)
{
    b2ShapeDef def = shape_def(w, body, material);
    b2Segment segment = { vec(x1, y1), vec(x2, y2) };
    return b2Shape_IsValid(b2CreateSegmentShape(w->bodies[body], &def, &segment)) ? ENGINE_OK
                                                                                  : ENGINE_FAILED;
}

static int add_chain(struct engine_world *w, int body, const struct engine_material *material,
                     const double *x, const double *y, int count, bool loop)
{
    if (count < (loop ? 4 : 3)) {
        return ENGINE_UNSUPPORTED;
    }
    // The first and last edge of an open chain do not collide there: one more is put at each
    // end, straight on.
    b2Vec2 *points = malloc((size_t)(count + 2) * sizeof *points);
    if (points == NULL) {
        return ENGINE_FAILED;
    }
    int used = 0;
    if (!loop) {
        points[used++] = vec(2.0 * x[0] - x[1], 2.0 * y[0] - y[1]);
    }
    for (int i = 0; i < count; ++i) {
        points[used++] = vec(x[i], y[i]);
    }
    if (!loop) {
        points[used++] = vec(2.0 * x[count - 1] - x[count - 2], 2.0 * y[count - 1] - y[count - 2]);
    }
    b2SurfaceMaterial surface = b2DefaultSurfaceMaterial();
    surface.friction = (float)material->friction;
    surface.restitution = (float)material->restitution;
    b2ChainDef def = b2DefaultChainDef();
    def.points = points;
    def.count = used;
    def.materials = &surface;
    def.materialCount = 1;
    def.isLoop = loop;
    def.filter.groupIndex = -w->groups[body];
    b2ChainId chain = b2CreateChain(w->bodies[body], &def);
    free(points);
    return b2Chain_IsValid(chain) ? ENGINE_OK : ENGINE_FAILED;
}

static void set_velocity(struct engine_world *w, int body, double vx, double vy, double angular)
{
    b2Body_SetAwake(w->bodies[body], true);
    b2Body_SetLinearVelocity(w->bodies[body], vec(vx, vy));
    b2Body_SetAngularVelocity(w->bodies[body], (float)angular);
}

static void apply_force(struct engine_world *w, int body, double fx, double fy, double torque)
{
    b2Body_ApplyForceToCenter(w->bodies[body], vec(fx, fy), true);
    b2Body_ApplyTorque(w->bodies[body], (float)torque, true);
}

static void step(struct engine_world *w, double dt)
{
    b2World_Step(w->id, (float)dt, w->substeps);
}

static struct engine_pose get_pose(const struct engine_world *w, int body)
{
    b2WorldTransform t = b2Body_GetTransform(w->bodies[body]);
    double c = (double)t.q.c;
    double s = (double)t.q.s;
    return (struct engine_pose){ (double)t.p.x, (double)t.p.y, c, s, atan2(s, c) };
}

static struct engine_velocity get_velocity(const struct engine_world *w, int body)
{
    b2Vec2 v = b2Body_GetLinearVelocity(w->bodies[body]);
    double angular = (double)b2Body_GetAngularVelocity(w->bodies[body]);
    return (struct engine_velocity){ (double)v.x, (double)v.y, angular };
}

static struct engine_mass get_mass(const struct engine_world *w, int body)
{
    b2BodyId id = w->bodies[body];
    b2Vec2 c = b2Body_GetLocalCenter(id);
    bool turns = !b2Body_GetMotionLocks(id).angularZ;
    double inertia = turns ? (double)b2Body_GetRotationalInertia(id) : 0.0;
    return (struct engine_mass){ (double)b2Body_GetMass(id), inertia, (double)c.x, (double)c.y };
}

static int body_index(b2ShapeId shape)
{
    return (int)(intptr_t)b2Body_GetUserData(b2Shape_GetBody(shape));
}

typedef void contact_fn(const struct engine_world *w, const b2ContactData *data, void *context);

// Calls `use` once for every touching pair of shapes.
static void each_contact(const struct engine_world *w, contact_fn *use, void *context)
{
    b2ContactData *data = NULL;
    int capacity = 0;
    for (int i = 0; i < w->count; ++i) {
        if (B2_IS_NULL(w->bodies[i])) {
            continue;
        }
        int wanted = b2Body_GetContactCapacity(w->bodies[i]);
        if (wanted > capacity) {
            free(data);
            capacity = 2 * wanted;
            data = malloc((size_t)capacity * sizeof *data);
            if (data == NULL) {
                return;
            }
        }
        int count = wanted > 0 ? b2Body_GetContactData(w->bodies[i], data, capacity) : 0;
        for (int k = 0; k < count; ++k) {
            // Both bodies list a contact: it is used from its body A.
            if (data[k].manifold.pointCount > 0 && body_index(data[k].shapeIdA) == i) {
                use(w, &data[k], context);
            }
        }
    }
    free(data);
}

struct visitor {
    engine_contact_fn *visit;
    void *context;
};

static void visit_points(const struct engine_world *w, const b2ContactData *data, void *context)
{
    const struct visitor *visitor = context;
    struct engine_contact point;
    point.body_a = body_index(data->shapeIdA);
    point.body_b = body_index(data->shapeIdB);
    point.nx = (double)data->manifold.normal.x;
    point.ny = (double)data->manifold.normal.y;
    b2Pos center = b2Body_GetWorldCenter(w->bodies[point.body_a]);
    for (int i = 0; i < data->manifold.pointCount; ++i) {
        const b2ManifoldPoint *p = &data->manifold.points[i];
        point.x = (double)center.x + (double)p->anchorA.x;
        point.y = (double)center.y + (double)p->anchorA.y;
        point.separation = (double)p->separation;
        point.impulse = (double)p->totalNormalImpulse;
        visitor->visit(visitor->context, &point);
    }
}

static void contacts(const struct engine_world *w, engine_contact_fn *visit, void *context)
{
    struct visitor visitor = { visit, context };
    each_contact(w, visit_points, &visitor);
}

static void count_one(const struct engine_world *w, const b2ContactData *data, void *context)
{
    (void)w;
    (void)data;
    ++*(int *)context;
}

static struct engine_counts counts(const struct engine_world *w)
{
    b2Counters c = b2World_GetCounters(w->id);
    int touching = 0;
    each_contact(w, count_one, &touching);
    return (struct engine_counts){ c.bodyCount, touching, c.jointCount };
}

static struct engine_touches touches(const struct engine_world *w)
{
    const b2ContactEvents e = b2World_GetContactEvents(w->id);
    return (struct engine_touches){ e.beginCount, e.endCount };
}

static double skin(const struct engine_world *w)
{
    (void)w;
    return 0.0;
}

// All worlds of the process together: the library keeps one count.
static size_t bytes(const struct engine_world *w)
{
    (void)w;
    return (size_t)b2GetByteCount();
}

const struct engine engine_box2d3 = {
    .name = "box2d3",
    .has_threads = true,
    .has_solver = false,
    ENGINE_FUNCTIONS,
};
