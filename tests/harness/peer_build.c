// peer_build.c - a scene's bodies, shapes and joints in another engine (peer.h). Reads the scene's world through libplumb's
// public headers; what the peer has no words for is refused with the reason.
#include "peer_world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SHAPES_MAX = 256, BOX2D2_POSITION = 3, BOX2D2_VELOCITY = 8 };

bool pl_peer_refuse(struct peer *p, const char *reason)
{
    snprintf(p->reason, sizeof p->reason, "%s", reason);
    return false;
}

static bool read_material(struct peer *p, const plumb_world *world, plumb_shape shape,
                          struct engine_material *out)
{
    plumb_material_desc m = { 0 };
    (void)plumb_material_settings(world, plumb_shape_material(world, shape), &m);
    if (m.surface_speed != 0) {
        return pl_peer_refuse(p, "surfaces that run");
    }
    if (m.rolling_resistance > 0 || m.adhesion > 0) {
        return pl_peer_refuse(p, "rolling resistance, adhesion");
    }
    if (m.kinetic_friction > 0) {
        return pl_peer_refuse(p, "kinetic friction");
    }
    if (m.friction_mix != PLUMB_MIX_DEFAULT || m.restitution_mix != PLUMB_MIX_DEFAULT) {
        return pl_peer_refuse(p, "rules of mixing");
    }
    plumb_one_way way = plumb_shape_one_way(world, shape);
    if (way.direction.x != 0 || way.direction.y != 0) {
        return pl_peer_refuse(p, "one-way shapes");
    }
    double density = (double)plumb_shape_density(world, shape);
    *out = (struct engine_material){ density > 0 ? density : 1, (double)m.friction,
                                     (double)m.restitution };
    return true;
}

// Where an engine has no capsules: a box and a circle at either end, which are the same set of points.
static int add_capsule(struct peer *p, int body, const struct engine_material *material,
                       const double *x, const double *y, double r)
{
    const struct engine *e = p->engine;
    int code = e->add_capsule(p->world, body, material, x[0], y[0], x[1], y[1], r);
    if (code != ENGINE_UNSUPPORTED) {
        return code;
    }
    double dx = x[1] - x[0], dy = y[1] - y[0], length = hypot(dx, dy);
    double u = length > 0 ? -dy / length * r : 0, v = length > 0 ? dx / length * r : 0;
    const double bx[4] = { x[0] - u, x[1] - u, x[1] + u, x[0] + u };
    const double by[4] = { y[0] - v, y[1] - v, y[1] + v, y[0] + v };
    code = e->add_circle(p->world, body, material, x[0], y[0], r);
    code = code == ENGINE_OK ? e->add_circle(p->world, body, material, x[1], y[1], r) : code;
    return code == ENGINE_OK ? e->add_polygon(p->world, body, material, bx, by, 4, 0) : code;
}

// A shape is brought over piece by piece: circles, capsules, convex polygons, lines.
static bool add_pieces(struct peer *p, const plumb_world *world, plumb_shape shape, int body)
{
    struct engine_material material;
    if (plumb_shape_is_sensor(world, shape)) {
        return true; // it exerts no force
    }
    if (!read_material(p, world, shape, &material)) {
        return false;
    }
    for (int i = 0; i < plumb_shape_piece_count(world, shape); i++) {
        plumb_convex c;
        double x[PLUMB_POLYGON_MAX_VERTICES], y[PLUMB_POLYGON_MAX_VERTICES];
        if (plumb_shape_piece(world, shape, i, &c, NULL) != PLUMB_OK) {
            return pl_peer_refuse(p, "a shape");
        }
        for (int k = 0; k < c.count; k++) {
            x[k] = (double)c.points[k].x;
            y[k] = (double)c.points[k].y;
        }
        double r = (double)c.radius;
        const struct engine *e = p->engine;
        int code = c.count == 1  ? e->add_circle(p->world, body, &material, x[0], y[0], r)
                   : c.count > 2 ? e->add_polygon(p->world, body, &material, x, y, c.count, r)
                   : r > 0       ? add_capsule(p, body, &material, x, y, r)
                           : e->add_segment(p->world, body, &material, x[0], y[0], x[1], y[1]);
        if (code != ENGINE_OK) {
            return pl_peer_refuse(p, c.count == 2 ? "capsules, or lines that are very short"
                                                  : "rounded, thin or many-cornered polygons");
        }
    }
    return true;
}

static bool is_plain(struct peer *p, const plumb_body_desc *d)
{
    if (d->damping > 0 || d->angular_damping > 0 || d->drag > 0 || d->thrust > 0) {
        return pl_peer_refuse(p, "damping of a body by its own law");
    }
    if (d->no_gravity || (d->gravity_scale != 0 && d->gravity_scale != 1)) {
        return pl_peer_refuse(p, "gravity of a body's own");
    }
    if (d->lock_x || d->lock_y || d->max_speed > 0 || d->max_spin > 0 ||
        (d->time_scale != 0 && d->time_scale != 1)) {
        return pl_peer_refuse(p, "locked axes, caps, time scales");
    }
    return true;
}

// Groups of bodies that stay apart: the negative groups of Plumb's filters. Other filters are refused.
static bool find_group(struct peer *p, const plumb_world *world, const plumb_shape *shapes,
                       int count, int *group)
{
    *group = 0;
    for (int i = 0; i < count; i++) {
        plumb_filter f = plumb_shape_filter(world, shapes[i]);
        if (f.group > 0 || f.nothing || f.category != 1 || f.mask != UINT64_MAX) {
            return pl_peer_refuse(p, "filters by category");
        }
        *group = -f.group;
    }
    return true;
}

static bool add_body(struct peer *p, plumb_world *world, plumb_body body)
{
    plumb_body_desc d = { 0 };
    plumb_shape shapes[SHAPES_MAX];
    int group, count = plumb_body_shapes(world, body, shapes, SHAPES_MAX);
    (void)plumb_body_settings(world, body, &d);
    if (count > SHAPES_MAX || !is_plain(p, &d) || !find_group(p, world, shapes, count, &group)) {
        return p->reason[0] != '\0' ? false : pl_peer_refuse(p, "more shapes of a body than 256");
    }
    plumb_vec2 at = plumb_body_position(world, body), v = plumb_body_velocity(world, body);
    struct engine_body_def def = { .type = d.type == PLUMB_DYNAMIC     ? ENGINE_DYNAMIC
                                           : d.type == PLUMB_KINEMATIC ? ENGINE_KINEMATIC
                                                                       : ENGINE_STATIC,
                                   .x = (double)at.x,
                                   .y = (double)at.y,
                                   .angle = (double)plumb_body_angle(world, body),
                                   .vx = (double)v.x,
                                   .vy = (double)v.y,
                                   .w = (double)plumb_body_angular_velocity(world, body),
                                   .fixed_rotation = d.fixed_rotation,
                                   .group = group };
    struct pair *pair = &p->pairs[p->count];
    *pair = (struct pair){ body,
                           p->engine->add_body(p->world, &def),
                           d.type == PLUMB_DYNAMIC,
                           d.type != PLUMB_STATIC,
                           { def.vx, def.vy, def.w } };
    if (pair->other < 0) {
        return pl_peer_refuse(p, "a body");
    }
    p->count++;
    for (int i = 0; i < count; i++) {
        if (!add_pieces(p, world, shapes[i], pair->other)) {
            return false;
        }
    }
    if (pair->dynamic) {
        plumb_vec2 c = plumb_body_local_center(world, body);
        struct engine_mass mass = { (double)plumb_body_mass(world, body),
                                    d.fixed_rotation ? 0 : (double)plumb_body_inertia(world, body),
                                    (double)c.x, (double)c.y };
        (void)p->engine->set_mass(p->world, pair->other, &mass);
    }
    return true;
}

static int other_of(const struct peer *p, plumb_body body)
{
    for (int i = 0; i < p->count; i++) {
        if (p->pairs[i].body.entity.index == body.entity.index &&
            p->pairs[i].body.entity.generation == body.entity.generation) {
            return p->pairs[i].other;
        }
    }
    return p->ground;
}

// [kg] or [kg m^2] of 1 / (1/m + r x n^2 / I) along the line of a distance: what its spring moves. 0: nothing.
static double effective_mass(const plumb_world *world, const plumb_joint_desc *d, const double n[2])
{
    double inverse = 0;
    for (int k = 0; k < 2; k++) {
        plumb_body b = k == 0 ? d->body_a : d->body_b;
        if (plumb_is_null(b.entity) || plumb_body_get_type(world, b) != PLUMB_DYNAMIC) {
            continue;
        }
        plumb_vec2 at = k == 0 ? d->anchor : d->anchor_b, c = plumb_body_center(world, b);
        double arm = ((double)at.x - (double)c.x) * n[1] - ((double)at.y - (double)c.y) * n[0];
        double inertia = (double)plumb_body_inertia(world, b);
        inverse += 1 / (double)plumb_body_mass(world, b) + (inertia > 0 ? arm * arm / inertia : 0);
    }
    return inverse > 0 ? 1 / inverse : 0;
}

// Frequency and damping ratio of Plumb's springs as stiffness: k = m w^2, c = 2 z m w.
static void set_spring(const plumb_world *world, const plumb_joint_desc *d,
                       struct engine_joint_def *def)
{
    double n[2] = { def->bx - def->ax, def->by - def->ay }, length = hypot(n[0], n[1]);
    double w = 6.283185307179586 * (double)d->hertz;
    bool slides = def->kind == ENGINE_PRISMATIC;
    n[0] = slides ? def->ux : length > 0 ? n[0] / length : 1;
    n[1] = slides ? def->uy : length > 0 ? n[1] / length : 0;
    double mass = effective_mass(world, d, n);
    def->hertz = (double)d->hertz;
    def->damping = (double)d->damping;
    def->stiffness = mass * w * w;
    def->resistance = 2 * (double)d->damping * mass * w;
}

static bool add_joint(struct peer *p, const plumb_world *world, plumb_joint joint)
{
    plumb_joint_desc d = { 0 };
    (void)plumb_joint_settings(world, joint, &d);
    bool is_known = d.kind == PLUMB_REVOLUTE || d.kind == PLUMB_PRISMATIC ||
                    d.kind == PLUMB_DISTANCE || d.kind == PLUMB_WELD;
    if (!is_known) {
        return pl_peer_refuse(p, plumb_joint_kind_name(d.kind));
    }
    plumb_vec2 a = plumb_joint_anchor_a(world, joint), b = plumb_joint_anchor_b(world, joint);
    double length = hypot((double)d.axis.x, (double)d.axis.y);
    struct engine_joint_def def = { .kind = d.kind == PLUMB_REVOLUTE    ? ENGINE_REVOLUTE
                                            : d.kind == PLUMB_PRISMATIC ? ENGINE_PRISMATIC
                                            : d.kind == PLUMB_DISTANCE  ? ENGINE_DISTANCE
                                                                        : ENGINE_WELD,
                                    .body_a = other_of(p, d.body_a),
                                    .body_b = other_of(p, d.body_b),
                                    .ax = (double)a.x,
                                    .ay = (double)a.y,
                                    .bx = (double)b.x,
                                    .by = (double)b.y,
                                    .ux = length > 0 ? (double)d.axis.x / length : 1,
                                    .uy = length > 0 ? (double)d.axis.y / length : 0,
                                    .enable_limit = d.enable_limit,
                                    .lower = (double)d.lower,
                                    .upper = (double)d.upper,
                                    .enable_motor = d.enable_motor,
                                    .motor_speed = (double)d.motor_speed,
                                    .max_motor = (double)d.max_motor,
                                    .rest = (double)(d.hertz > 0 && d.rest > 0 ? d.rest : d.length),
                                    .collide = d.collide_connected };
    if (d.break_force > 0 || d.break_torque > 0 || d.break_impulse > 0) {
        return pl_peer_refuse(p, "joints that break");
    }
    if (d.hertz > 0) {
        d.anchor = a;
        d.anchor_b = b;
        set_spring(world, &d, &def);
    }
    if (def.kind == ENGINE_PRISMATIC) {
        def.rest = (double)d.rest;
    } else if (def.rest <= 0) {
        def.rest = hypot(def.bx - def.ax, def.by - def.ay);
    }
    int other = p->tie_count < PEER_JOINTS ? p->engine->add_joint(p->world, &def) : ENGINE_FAILED;
    if (other < 0) {
        return pl_peer_refuse(p, "a joint with these springs, limits or motors");
    }
    p->ties[p->tie_count++] =
        (struct tie){ joint, other, def.enable_motor, def.motor_speed, def.max_motor };
    return true;
}

bool pl_peer_build(struct peer *p, const engine_settings *settings, const scene *s)
{
    plumb_world *world = scene_world(s);
    plumb_world_desc d = plumb_world_settings(world);
    scene_info info = scene_get_info(s);
    struct engine_options o = engine_options_default();
    unsigned activity = scene_activity(s);
    if ((activity & (SCENE_FIELDS | SCENE_LISTENS)) != 0) {
        return pl_peer_refuse(p,
                              (activity & SCENE_FIELDS) != 0 ? "field{}" : "handlers of contacts");
    }
    if (d.wrap_x > 0 || d.wrap_y > 0) {
        return pl_peer_refuse(p, "a world that wraps around");
    }
    o.gravity_x = d.zero_gravity ? 0 : (double)d.gravity.x;
    o.gravity_y = d.zero_gravity ? 0 : (double)d.gravity.y;
    o.substeps = info.substeps;
    o.velocity_iterations = info.iterations;
    o.position_iterations = info.iterations * BOX2D2_POSITION / BOX2D2_VELOCITY;
    o.restitution_threshold = 0;
    o.sleep = !settings->no_expect && !d.no_sleep; // of what is timed nobody sleeps
    o.stiff = settings->solver == 1;
    p->dt = info.dt;
    p->bare = settings->unseen && activity == 0;
    p->world = p->engine->create(&o);
    p->pairs = calloc((size_t)scene_body_count(s) + 1, sizeof *p->pairs);
    if (p->world == NULL || p->pairs == NULL) {
        return pl_peer_refuse(p, "memory");
    }
    struct engine_body_def ground = { .type = ENGINE_STATIC };
    p->ground = p->engine->add_body(p->world, &ground);
    for (int i = 0; i < scene_body_count(s); i++) {
        if (!add_body(p, world, scene_body_get(s, i).entity)) {
            return false;
        }
    }
    for (int i = 0; i < scene_joint_count(s); i++) {
        if (!add_joint(p, world, scene_joint_get(s, i).entity)) {
            return false;
        }
    }
    return true;
}
