// engine_box2d2.cpp - Box2D 2.4.1 (C++) behind the neutral interface of engine.h.
// Reads: nothing but its arguments. Writes: the b2World it owns. Cost: one virtual-free call each.
//
// Facts of that version that the code below rests on (its public headers): b2_polygonRadius is the
// default m_radius of polygons, edges and chains and may be changed per shape after set-up; the
// restitution threshold is a member of the fixture; forces are cleared at the end of a step; the
// length of a step is not divided, so options.substeps steps it that many times.
#include "engine.h"

#include <box2d/box2d.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

// Iterations that the manual of Box2D 2.4 recommends.
static const int default_velocity_iterations = 8;
static const int default_position_iterations = 3;

// Counts what a step tells of touches.
struct touch_listener : b2ContactListener {
    engine_touches told = { 0, 0 };

    void BeginContact(b2Contact *) override { ++told.begins; }
    void EndContact(b2Contact *) override { ++told.ends; }
};

struct engine_world {
    explicit engine_world(const b2Vec2 &gravity) : world(gravity)
    {
        world.SetContactListener(&listener);
    }

    touch_listener listener; // before the world, which tells it of its end
    b2World world;
    std::vector<b2Body *> bodies; // null: destroyed
    std::vector<int> groups;      // of the bodies
    int substeps = 1;
    int velocity_iterations = default_velocity_iterations;
    int position_iterations = default_position_iterations;
    double restitution_threshold = -1.0; // < 0: b2FixtureDef's own
    double skin = b2_polygonRadius;
    std::vector<b2Joint *> joints; // of add_joint
    float inverse_step = 0.0f;     // [1/s] of the last inner step
};

namespace
{

b2Vec2 vec(double x, double y)
{
    return b2Vec2(static_cast<float>(x), static_cast<float>(y));
}

void describe(char *text, size_t size)
{
    // The b2_version of release 2.4.1 still reads 2.4.0, so it is told as the library's own word.
    std::snprintf(text, size,
                  "Box2D 2.4.1 (C++; the installed library, which calls itself %d.%d.%d)",
                  b2_version.major, b2_version.minor, b2_version.revision);
}

engine_world *create(const engine_options *options)
{
    engine_world *w = new engine_world(vec(options->gravity_x, options->gravity_y));
    w->world.SetAllowSleeping(options->sleep);
    w->world.SetContinuousPhysics(options->continuous);
    // Forces must outlast all but the last of the inner steps.
    w->world.SetAutoClearForces(false);
    if (options->substeps > 0) {
        w->substeps = options->substeps;
    }
    if (options->velocity_iterations > 0) {
        w->velocity_iterations = options->velocity_iterations;
    }
    if (options->position_iterations > 0) {
        w->position_iterations = options->position_iterations;
    }
    w->restitution_threshold = options->restitution_threshold;
    if (options->skin >= 0.0 || options->stiff) {
        w->skin = options->stiff ? 0.0 : options->skin;
    }
    return w;
}

void destroy(engine_world *w)
{
    delete w;
}

int add_body(engine_world *w, const engine_body_def *def)
{
    b2BodyDef b;
    b.type = def->type == ENGINE_DYNAMIC     ? b2_dynamicBody
             : def->type == ENGINE_KINEMATIC ? b2_kinematicBody
                                             : b2_staticBody;
    b.position = vec(def->x, def->y);
    b.angle = static_cast<float>(def->angle);
    b.linearVelocity = vec(def->vx, def->vy);
    b.angularVelocity = static_cast<float>(def->w);
    b.fixedRotation = def->fixed_rotation;
    b.awake = !def->asleep;
    b.userData.pointer = w->bodies.size();
    w->bodies.push_back(w->world.CreateBody(&b));
    w->groups.push_back(def->group);
    return static_cast<int>(w->bodies.size()) - 1;
}

void destroy_body(engine_world *w, int body)
{
    b2Body *&b = w->bodies[static_cast<size_t>(body)];
    w->world.DestroyBody(b);
    b = nullptr;
}

int add_hinge(engine_world *w, const engine_hinge_def *def)
{
    b2RevoluteJointDef j;
    j.Initialize(w->bodies[static_cast<size_t>(def->body_a)],
                 w->bodies[static_cast<size_t>(def->body_b)], vec(def->x, def->y));
    j.enableLimit = def->enable_limit;
    j.lowerAngle = static_cast<float>(def->lower);
    j.upperAngle = static_cast<float>(def->upper);
    j.enableMotor = def->enable_motor;
    j.motorSpeed = static_cast<float>(def->motor_speed);
    j.maxMotorTorque = static_cast<float>(def->max_torque);
    return w->world.CreateJoint(&j) ? ENGINE_OK : ENGINE_FAILED;
}

int set_mass(engine_world *w, int body, const engine_mass *mass)
{
    b2MassData data;
    data.mass = static_cast<float>(mass->mass);
    data.center = vec(mass->x, mass->y);
    // About the origin, as GetInertia.
    data.I =
        static_cast<float>(mass->inertia + mass->mass * (mass->x * mass->x + mass->y * mass->y));
    b2Body *b = w->bodies[static_cast<size_t>(body)];
    const b2Vec2 v = b->GetLinearVelocity();
    b->SetMassData(&data);
    b->SetLinearVelocity(v); // of the centre of mass, which has moved
    return ENGINE_OK;
}

b2JointDef *define_distance(const engine_joint_def *def, b2Body *a, b2Body *b,
                            b2DistanceJointDef &j)
{
    j.Initialize(a, b, vec(def->ax, def->ay), vec(def->bx, def->by));
    j.length = static_cast<float>(def->rest);
    j.minLength = j.maxLength = j.length;
    if (def->enable_limit) {
        j.minLength = static_cast<float>(def->lower);
        j.maxLength = static_cast<float>(def->upper);
    }
    if (def->hertz > 0.0) {
        j.stiffness = static_cast<float>(def->stiffness);
        j.damping = static_cast<float>(def->resistance);
        if (!def->enable_limit) { // a spring alone: no stops
            j.minLength = 0.0f;
            j.maxLength = b2_maxFloat;
        }
    }
    return &j;
}

b2JointDef *define_revolute(const engine_joint_def *def, b2Body *a, b2Body *b,
                            b2RevoluteJointDef &j)
{
    j.Initialize(a, b, vec(def->ax, def->ay));
    j.localAnchorB = b->GetLocalPoint(vec(def->bx, def->by));
    j.enableLimit = def->enable_limit;
    j.lowerAngle = static_cast<float>(def->lower);
    j.upperAngle = static_cast<float>(def->upper);
    j.enableMotor = def->enable_motor;
    j.motorSpeed = static_cast<float>(def->motor_speed);
    j.maxMotorTorque = static_cast<float>(def->max_motor);
    return &j;
}

b2JointDef *define_prismatic(const engine_joint_def *def, b2Body *a, b2Body *b,
                             b2PrismaticJointDef &j)
{
    j.Initialize(a, b, vec(def->ax, def->ay), vec(def->ux, def->uy));
    j.enableLimit = def->enable_limit;
    j.lowerTranslation = static_cast<float>(def->lower);
    j.upperTranslation = static_cast<float>(def->upper);
    j.enableMotor = def->enable_motor;
    j.motorSpeed = static_cast<float>(def->motor_speed);
    j.maxMotorForce = static_cast<float>(def->max_motor);
    return &j;
}

// A slide with a spring is a wheel's suspension here; it leaves the turn free. Its rest is where both anchors meet.
b2JointDef *define_suspension(const engine_joint_def *def, b2Body *a, b2Body *b, b2WheelJointDef &j)
{
    j.Initialize(a, b, vec(def->ax, def->ay), vec(def->ux, def->uy));
    j.localAnchorA =
        a->GetLocalPoint(vec(def->ax + def->rest * def->ux, def->ay + def->rest * def->uy));
    j.stiffness = static_cast<float>(def->stiffness);
    j.damping = static_cast<float>(def->resistance);
    return &j;
}

int add_joint(engine_world *w, const engine_joint_def *def)
{
    b2Body *a = w->bodies[static_cast<size_t>(def->body_a)];
    b2Body *b = w->bodies[static_cast<size_t>(def->body_b)];
    b2DistanceJointDef distance;
    b2RevoluteJointDef revolute;
    b2PrismaticJointDef prismatic;
    b2WeldJointDef weld;
    b2WheelJointDef wheel;
    b2JointDef *j = &weld;
    const bool suspended = def->hertz > 0.0 && def->kind == ENGINE_PRISMATIC;
    if (def->hertz > 0.0 && def->kind != ENGINE_DISTANCE &&
        (!suspended || def->enable_limit || def->enable_motor)) {
        return ENGINE_UNSUPPORTED;
    }
    if (suspended) {
        j = define_suspension(def, a, b, wheel);
    } else if (def->kind == ENGINE_DISTANCE) {
        j = define_distance(def, a, b, distance);
    } else if (def->kind == ENGINE_REVOLUTE) {
        j = define_revolute(def, a, b, revolute);
    } else if (def->kind == ENGINE_PRISMATIC) {
        j = define_prismatic(def, a, b, prismatic);
    } else {
        weld.Initialize(a, b, vec(def->ax, def->ay));
    }
    j->collideConnected = def->collide;
    w->joints.push_back(w->world.CreateJoint(j));
    return static_cast<int>(w->joints.size()) - 1;
}

int set_motor(engine_world *w, int joint, bool on, double speed, double max)
{
    b2Joint *j = w->joints[static_cast<size_t>(joint)];
    if (j->GetType() != e_revoluteJoint) {
        return ENGINE_UNSUPPORTED;
    }
    b2RevoluteJoint *hinge = static_cast<b2RevoluteJoint *>(j);
    hinge->EnableMotor(on);
    hinge->SetMotorSpeed(static_cast<float>(speed));
    hinge->SetMaxMotorTorque(static_cast<float>(max));
    return ENGINE_OK;
}

void joint_force(const engine_world *w, int joint, double force[2], double *torque)
{
    const b2Joint *j = w->joints[static_cast<size_t>(joint)];
    const b2Vec2 f = j->GetReactionForce(w->inverse_step);
    force[0] = f.x;
    force[1] = f.y;
    *torque = j->GetReactionTorque(w->inverse_step);
}

int add_shape(engine_world *w, int body, const engine_material *material, const b2Shape &shape)
{
    b2FixtureDef def;
    def.shape = &shape;
    def.filter.groupIndex = static_cast<int16>(-w->groups[static_cast<size_t>(body)]);
    def.density = static_cast<float>(material->density);
    def.friction = static_cast<float>(material->friction);
    def.restitution = static_cast<float>(material->restitution);
    if (w->restitution_threshold >= 0.0) {
        def.restitutionThreshold = static_cast<float>(w->restitution_threshold);
    }
    return w->bodies[static_cast<size_t>(body)]->CreateFixture(&def) ? ENGINE_OK : ENGINE_FAILED;
}

int add_circle(engine_world *w, int body, const engine_material *material, double x, double y,
               double radius)
{
    b2CircleShape shape;
    shape.m_p = vec(x, y);
    shape.m_radius = static_cast<float>(radius);
    return add_shape(w, body, material, shape);
}

int add_capsule(engine_world *, int, const engine_material *, double, double, double, double,
                double)
{
    return ENGINE_UNSUPPORTED;
}

int add_polygon(engine_world *w, int body, const engine_material *material, const double *x,
                const double *y, int count, double radius)
{
    // m_radius is a collision skin that leaves corners sharp and carries no mass: not a rounding.
    if (count > b2_maxPolygonVertices || radius > 0.0) {
        return ENGINE_UNSUPPORTED;
    }
    b2Vec2 points[b2_maxPolygonVertices];
    for (int i = 0; i < count; ++i) {
        points[i] = vec(x[i], y[i]);
        for (int k = 0; k < i; ++k) {
            // Corners so near are welded, and what is left may be no polygon: that is an assertion.
            if (b2Distance(points[i], points[k]) < b2_linearSlop) {
                return ENGINE_UNSUPPORTED;
            }
        }
    }
    b2PolygonShape shape;
    shape.Set(points, count);
    shape.m_radius = static_cast<float>(w->skin);
    return add_shape(w, body, material, shape);
}

int add_segment(engine_world *w, int body, const engine_material *material, double x1, double y1,
                double x2, double y2)
{
    b2EdgeShape shape;
    shape.SetTwoSided(vec(x1, y1), vec(x2, y2));
    shape.m_radius = static_cast<float>(w->skin);
    return add_shape(w, body, material, shape);
}

int add_chain(engine_world *w, int body, const engine_material *material, const double *x,
              const double *y, int count, bool loop)
{
    if (count < 3) {
        return ENGINE_UNSUPPORTED;
    }
    std::vector<b2Vec2> points;
    for (int i = 0; i < count; ++i) {
        points.push_back(vec(x[i], y[i]));
    }
    b2ChainShape shape;
    if (loop) {
        shape.CreateLoop(points.data(), count);
    } else {
        // Ghost points that continue the first and last edge straight on.
        const b2Vec2 before = 2.0f * points[0] - points[1];
        const b2Vec2 after = 2.0f * points.back() - points[points.size() - 2];
        shape.CreateChain(points.data(), count, before, after);
    }
    shape.m_radius = static_cast<float>(w->skin);
    return add_shape(w, body, material, shape);
}

void set_velocity(engine_world *w, int body, double vx, double vy, double angular)
{
    b2Body *b = w->bodies[static_cast<size_t>(body)];
    b->SetLinearVelocity(vec(vx, vy));
    b->SetAngularVelocity(static_cast<float>(angular));
}

void apply_force(engine_world *w, int body, double fx, double fy, double torque)
{
    b2Body *b = w->bodies[static_cast<size_t>(body)];
    b->ApplyForceToCenter(vec(fx, fy), true);
    b->ApplyTorque(static_cast<float>(torque), true);
}

void step(engine_world *w, double dt)
{
    const float h = static_cast<float>(dt / w->substeps);
    w->listener.told = { 0, 0 };
    w->inverse_step = 1.0f / h;
    for (int i = 0; i < w->substeps; ++i) {
        w->world.Step(h, w->velocity_iterations, w->position_iterations);
    }
    w->world.ClearForces();
}

engine_pose get_pose(const engine_world *w, int body)
{
    const b2Transform &t = w->bodies[static_cast<size_t>(body)]->GetTransform();
    return { t.p.x, t.p.y, t.q.c, t.q.s, std::atan2(double(t.q.s), double(t.q.c)) };
}

engine_velocity get_velocity(const engine_world *w, int body)
{
    const b2Body *b = w->bodies[static_cast<size_t>(body)];
    return { b->GetLinearVelocity().x, b->GetLinearVelocity().y, b->GetAngularVelocity() };
}

engine_mass get_mass(const engine_world *w, int body)
{
    const b2Body *b = w->bodies[static_cast<size_t>(body)];
    const b2Vec2 c = b->GetLocalCenter();
    const double mass = b->GetMass();
    // GetInertia is about the origin.
    const double inertia = b->IsFixedRotation()
                               ? 0.0
                               : b->GetInertia() - mass * (double(c.x) * c.x + double(c.y) * c.y);
    return { mass, inertia, c.x, c.y };
}

int body_index(const b2Fixture *fixture)
{
    // GetUserData has no const form; nothing is written.
    b2Body *body = const_cast<b2Body *>(fixture->GetBody());
    return static_cast<int>(body->GetUserData().pointer);
}

void contacts(const engine_world *w, engine_contact_fn *visit, void *context)
{
    for (const b2Contact *c = w->world.GetContactList(); c != nullptr; c = c->GetNext()) {
        if (!c->IsTouching()) {
            continue;
        }
        b2WorldManifold manifold;
        c->GetWorldManifold(&manifold);
        for (int i = 0; i < c->GetManifold()->pointCount; ++i) {
            engine_contact point;
            point.body_a = body_index(c->GetFixtureA());
            point.body_b = body_index(c->GetFixtureB());
            point.x = manifold.points[i].x;
            point.y = manifold.points[i].y;
            point.nx = manifold.normal.x;
            point.ny = manifold.normal.y;
            point.separation = manifold.separations[i];
            // The last inner step's, times their number: the load of a step at rest.
            point.impulse = double(c->GetManifold()->points[i].normalImpulse) * w->substeps;
            visit(context, &point);
        }
    }
}

engine_counts counts(const engine_world *w)
{
    engine_counts n = { w->world.GetBodyCount(), 0, w->world.GetJointCount() };
    for (const b2Contact *c = w->world.GetContactList(); c != nullptr; c = c->GetNext()) {
        n.contacts += c->IsTouching() ? 1 : 0;
    }
    return n;
}

engine_touches touches(const engine_world *w)
{
    return w->listener.told;
}

double skin(const engine_world *w)
{
    return w->skin;
}

size_t bytes(const engine_world *)
{
    return 0; // its block allocator does not tell
}

} // namespace

extern "C" const engine engine_box2d2 = {
    .name = "box2d2",
    .has_threads = false,
    .has_solver = false,
    ENGINE_FUNCTIONS,
};
