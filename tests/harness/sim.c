// sim.c - small worlds for tests. Reads, writes: the worlds that it is given. A refused call is a
// mistake of the test: it is told on stderr and ends the program.
#include "harness/sim.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void tell(void *context, plumb_log_level level, const char *message)
{
    (void)context;
    if (level == PLUMB_LOG_ERROR) {
        fprintf(stderr, "plumb: %s\n", message);
    }
}

static void need(bool ok, const char *what)
{
    if (!ok) {
        fprintf(stderr, "sim: %s was refused\n", what);
        abort();
    }
}

plumb_vec2 sim_vec(double x, double y)
{
    return (plumb_vec2){ (plumb_real)x, (plumb_real)y };
}

plumb_world *sim_world(const plumb_world_desc *desc)
{
    plumb_world_desc d = *desc;
    if (d.log == NULL) {
        d.log = tell;
    }
    plumb_world *world = NULL;
    need(plumb_world_create(&d, &world) == PLUMB_OK, "the world");
    return world;
}

plumb_world *sim_space(void)
{
    return sim_world(&(plumb_world_desc){ .zero_gravity = true });
}

plumb_material sim_material(plumb_world *w, double friction, double restitution)
{
    plumb_material m =
        plumb_material_create(w, &(plumb_material_desc){ .friction = (plumb_real)friction,
                                                         .frictionless = friction == 0,
                                                         .restitution = (plumb_real)restitution });
    need(!plumb_is_null(m), "the material");
    return m;
}

plumb_body sim_body(plumb_world *w, plumb_body_type type, double x, double y, double angle)
{
    plumb_body b = plumb_body_create(
        w,
        &(plumb_body_desc){ .type = type, .position = sim_vec(x, y), .angle = (plumb_real)angle });
    need(!plumb_is_null(b), "the body");
    return b;
}

plumb_body sim_mass(plumb_world *w, double x, double y, double kg, double inertia)
{
    plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .position = sim_vec(x, y),
                                                            .mass = (plumb_real)kg,
                                                            .inertia = (plumb_real)inertia });
    need(!plumb_is_null(b), "a mass");
    return b;
}

plumb_joint sim_joint(plumb_world *w, plumb_joint_desc desc)
{
    plumb_joint joint = plumb_joint_create(w, &desc);
    need(!plumb_is_null(joint), "a joint");
    return joint;
}

static void add(plumb_world *w, plumb_body b, const plumb_shape_desc *desc)
{
    need(!plumb_is_null(plumb_shape_create(w, b, desc)), "the shape");
}

void sim_add_circle(plumb_world *w, plumb_body b, double r, plumb_material m)
{
    add(w, b, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = (plumb_real)r, .material = m });
}

void sim_add_box(plumb_world *w, plumb_body b, double hx, double hy, plumb_material m)
{
    add(w, b, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = sim_vec(hx, hy), .material = m });
}

void sim_add_segment(plumb_world *w, plumb_body b, plumb_vec2 p, plumb_vec2 q, plumb_material m)
{
    plumb_vec2 points[2] = { p, q };
    add(w, b,
        &(plumb_shape_desc){ .kind = PLUMB_SEGMENT, .points = points, .count = 2, .material = m });
}

plumb_body sim_ball(plumb_world *w, double x, double y, double r, plumb_material m)
{
    plumb_body b = sim_body(w, PLUMB_DYNAMIC, x, y, 0);
    sim_add_circle(w, b, r, m);
    return b;
}

plumb_body sim_crate(plumb_world *w, double x, double y, double hx, double hy, plumb_material m)
{
    plumb_body b = sim_body(w, PLUMB_DYNAMIC, x, y, 0);
    sim_add_box(w, b, hx, hy, m);
    return b;
}

plumb_body sim_floor(plumb_world *w, plumb_material m)
{
    plumb_body b = sim_body(w, PLUMB_STATIC, 0, -1, 0);
    sim_add_box(w, b, 200, 1, m);
    return b;
}

void sim_step(plumb_world *w, double dt)
{
    need(plumb_world_step(w, (plumb_real)dt) == PLUMB_OK, "the step");
}

void sim_run(plumb_world *w, int count, double dt)
{
    for (int i = 0; i < count; ++i) {
        sim_step(w, dt);
    }
}

void *sim_save(const plumb_world *w, size_t *size)
{
    *size = plumb_world_snapshot_size(w);
    void *image = malloc(*size);
    need(image != NULL && plumb_world_save(w, image, *size) == PLUMB_OK, "the image");
    return image;
}

bool sim_has_pass(const plumb_world *w, const char *name)
{
    plumb_pass_info rows[128];
    const int count = plumb_world_schedule(w, rows, 128);
    int i = 0;
    while (i < count && strcmp(rows[i].name, name) != 0) {
        ++i;
    }
    need(i < count, "the name of a pass");
    return rows[i].scheduled;
}

double sim_x(const plumb_world *w, plumb_body b)
{
    return (double)plumb_body_position(w, b).x;
}

double sim_y(const plumb_world *w, plumb_body b)
{
    return (double)plumb_body_position(w, b).y;
}

double sim_angle(const plumb_world *w, plumb_body b)
{
    return (double)plumb_body_angle(w, b);
}

double sim_vx(const plumb_world *w, plumb_body b)
{
    return (double)plumb_body_velocity(w, b).x;
}

double sim_vy(const plumb_world *w, plumb_body b)
{
    return (double)plumb_body_velocity(w, b).y;
}

double sim_w(const plumb_world *w, plumb_body b)
{
    return (double)plumb_body_angular_velocity(w, b);
}

void sim_launch(plumb_world *w, plumb_body b, double vx, double vy, double spin)
{
    need(plumb_body_set_velocity(w, b, sim_vec(vx, vy)) == PLUMB_OK, "the velocity");
    need(plumb_body_set_angular_velocity(w, b, (plumb_real)spin) == PLUMB_OK, "the spin");
}

double sim_energy(const plumb_world *w)
{
    plumb_energy e = plumb_world_energy(w);
    return e.kinetic + e.potential;
}

double sim_max_speed(plumb_world *w)
{
    plumb_body_span s = plumb_world_bodies(w);
    double fastest = 0;
    for (int i = 0; i < s.dynamic_count; ++i) {
        double v = hypot((double)s.vx[i], (double)s.vy[i]);
        // A NaN must not pass for rest.
        fastest = v <= fastest ? fastest : v;
    }
    return fastest;
}

double sim_normal_force(const plumb_world *w, plumb_body a, plumb_body b, double dt)
{
    int count = plumb_world_contacts(w, NULL, 0);
    plumb_contact *list = calloc((size_t)count + 1, sizeof *list);
    need(list != NULL, "memory");
    count = plumb_world_contacts(w, list, count);
    double impulse = 0;
    for (int i = 0; i < count; ++i) {
        if ((plumb_same(list[i].body_a, a) && plumb_same(list[i].body_b, b)) ||
            (plumb_same(list[i].body_a, b) && plumb_same(list[i].body_b, a))) {
            for (int k = 0; k < list[i].point_count; ++k) {
                impulse += (double)list[i].points[k].normal_impulse;
            }
        }
    }
    free(list);
    return impulse * plumb_world_settings(w).substeps / dt;
}

double sim_order(const double *error, int count)
{
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (int i = 0; i < count; ++i) {
        double x = -i * log(2.0);
        double y = log(error[i] > 1e-300 ? error[i] : 1e-300);
        sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

void sim_fit_joint(plumb_joint_desc *desc)
{
    const plumb_joint_kind k = desc->kind;
    const plumb_joint_desc given = *desc;
    const bool slides = k == PLUMB_PRISMATIC || k == PLUMB_WHEEL;
    const bool drives = slides || k == PLUMB_REVOLUTE;
    const bool pulls = k == PLUMB_MOTOR || k == PLUMB_FRICTION;
    *desc = (plumb_joint_desc){ .kind = k,
                                .body_a = given.body_a,
                                .body_b = given.body_b,
                                .anchor = given.anchor,
                                .break_force = given.break_force,
                                .break_torque = given.break_torque,
                                .break_impulse = given.break_impulse,
                                .event_force = given.event_force,
                                .event_torque = given.event_torque,
                                .tell_impulse = given.tell_impulse,
                                .disabled = given.disabled,
                                .collide_connected = given.collide_connected,
                                .user_data = given.user_data };
    const bool two = k == PLUMB_DISTANCE || k == PLUMB_PULLEY || k == PLUMB_CABLE;
    desc->anchor_b = two ? given.anchor_b : desc->anchor_b;
    desc->ground_a = k == PLUMB_PULLEY ? given.ground_a : desc->ground_a;
    desc->ground_b = k == PLUMB_PULLEY ? given.ground_b : desc->ground_b;
    desc->axis = slides || k == PLUMB_GEAR ? given.axis : desc->axis;
    desc->length = k == PLUMB_DISTANCE || k == PLUMB_CABLE ? given.length : 0;
    desc->radius_a = k == PLUMB_CABLE ? given.radius_a : 0;
    desc->radius_b = k == PLUMB_CABLE ? given.radius_b : 0;
    desc->ratio = k == PLUMB_GEAR || k == PLUMB_PULLEY ? given.ratio : 0;
    desc->pitch = k == PLUMB_RATCHET ? given.pitch : 0;
    desc->max_force = pulls || k == PLUMB_MOUSE ? given.max_force : 0;
    desc->max_torque = pulls ? given.max_torque : 0;
    if (drives || k == PLUMB_DISTANCE) {
        desc->enable_limit = given.enable_limit;
        desc->lower = given.lower;
        desc->upper = given.upper;
        desc->restitution = given.restitution;
    }
    if (drives) {
        desc->enable_motor = given.enable_motor;
        desc->motor_speed = given.motor_speed;
        desc->max_motor = given.max_motor;
    }
    if (drives || k == PLUMB_WELD || k == PLUMB_DISTANCE || k == PLUMB_MOUSE || k == PLUMB_MOTOR) {
        desc->hertz = given.hertz;
        desc->damping = given.damping;
        desc->stiffness = given.stiffness;
        desc->damper = given.damper;
        desc->rest = k == PLUMB_DISTANCE || k == PLUMB_MOUSE ? 0 : given.rest;
    }
}
