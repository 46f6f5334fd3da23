// test_settings.c - what is set afterwards is what was made so: a world whose bodies, shapes, joints, material or
// settings get other values by setters goes on, bit for bit, as one that was made with those values.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/sim.h"

#define HZ60 (1 / 60.0)

enum { BODIES = 6, JOINTS = BODIES / 2, STEPS = 30, SEEDS = 12 };

// What of a world is other than plain; values are drawn in any case, so that both ways draw the same.
typedef enum change {
    LIMIT,
    BOUNCE,
    MOTOR,
    SPRING,
    STIFFNESS,
    BREAK,
    JOINT_OFF,
    DAMPING,
    CAP,
    GRAVITY_SCALE,
    TIME_SCALE,
    LOCKS,
    MASS,
    DRAG,
    THRUST,
    BODY_OFF,
    FILTER,
    ONE_WAY,
    SHAPE_MATERIAL,
    MATERIAL,
    GRAVITY,
    SUBSTEPS,
    TUNING,
    CHANGES
} change;

static const char *const names[] = { "limit",
                                     "bounce",
                                     "motor",
                                     "spring",
                                     "stiffness",
                                     "break",
                                     "joint off",
                                     "damping",
                                     "cap",
                                     "gravity scale",
                                     "time scale",
                                     "locks",
                                     "mass",
                                     "drag",
                                     "thrust",
                                     "body off",
                                     "filter",
                                     "one way",
                                     "shape's material",
                                     "material",
                                     "gravity",
                                     "substeps",
                                     "tuning" };

typedef struct draft {
    plumb_world *world;
    uint32_t seed;
    change what;
    bool later; // by setters
    plumb_material plain, other;
    plumb_body body[BODIES];
} draft;

static plumb_real any(draft *d, double low, double high)
{
    return (plumb_real)sim_uniform(&d->seed, low, high);
}

static bool one_of(draft *d, double of)
{
    return sim_uniform(&d->seed, 0, of) < 1;
}

static void set_joint(draft *d, plumb_joint joint, const plumb_joint_desc *to)
{
    plumb_world *w = d->world;
    const plumb_real rest = to->kind == PLUMB_DISTANCE ? to->length : to->rest;
    plumb_result r = PLUMB_OK;
    switch (d->what) {
    case LIMIT:
        r = plumb_joint_set_limit(w, joint, to->enable_limit, to->lower, to->upper);
        break;
    case BOUNCE:
        r = plumb_joint_set_limit(w, joint, to->enable_limit, to->lower, to->upper);
        r = r == PLUMB_OK ? plumb_joint_set_restitution(w, joint, to->restitution) : r;
        break;
    case MOTOR:
        r = plumb_joint_set_motor(w, joint, true, to->motor_speed, to->max_motor);
        break;
    case SPRING:
        r = plumb_joint_set_spring(w, joint, to->hertz, to->damping, rest);
        break;
    case STIFFNESS:
        r = plumb_joint_set_stiffness(w, joint, to->stiffness, to->damper, rest);
        break;
    case BREAK:
        r = plumb_joint_set_break(w, joint, to->break_force, to->break_torque);
        break;
    case JOINT_OFF:
        r = plumb_joint_set_enabled(w, joint, false);
        break;
    default:
        break;
    }
    assert_int_equal(r, PLUMB_OK);
}

static void add_joint(draft *d, int pair)
{
    static const plumb_joint_kind kinds[] = { PLUMB_REVOLUTE, PLUMB_PRISMATIC, PLUMB_WHEEL,
                                              PLUMB_DISTANCE, PLUMB_WELD,      PLUMB_MOTOR,
                                              PLUMB_MOUSE };
    plumb_joint_desc plain = { .kind = kinds[(int)sim_uniform(&d->seed, 0, 7)],
                               .body_a = d->body[2 * pair],
                               .body_b = d->body[2 * pair + 1],
                               .anchor = plumb_body_position(d->world, d->body[2 * pair]) };
    const bool rod = plain.kind == PLUMB_DISTANCE;
    const bool turns = plain.kind != PLUMB_WELD && plain.kind != PLUMB_MOUSE;
    plain.anchor_b = plumb_body_position(d->world, d->body[2 * pair + 1]);
    plumb_joint_desc to = plain;
    const plumb_real low = any(d, -0.5, 0), high = any(d, 1, 2), rest = any(d, -0.5, 0.5);
    if (d->what == LIMIT || d->what == BOUNCE) {
        to.enable_limit = true;
        to.lower = rod ? -low : low, to.upper = high;
        to.restitution = d->what == BOUNCE ? any(d, 0, 1) : 0;
    } else if (d->what == MOTOR) {
        to.enable_motor = true;
        to.motor_speed = any(d, -5, 5), to.max_motor = any(d, 0, 20);
    } else if (d->what == SPRING || d->what == STIFFNESS) {
        *(d->what == SPRING ? &to.hertz : &to.stiffness) = any(d, 1, 8);
        *(d->what == SPRING ? &to.damping : &to.damper) = any(d, 0, 1);
        *(rod ? &to.length : &to.rest) = rod ? high : turns ? rest : 0;
    } else if (d->what == BREAK) {
        to.break_force = any(d, 1, 20), to.break_torque = any(d, 1, 5);
    }
    to.disabled = d->what == JOINT_OFF;
    plumb_joint_desc fit = to;
    sim_fit_joint(&fit);
    sim_fit_joint(&plain);
    const bool has = (d->what != LIMIT && d->what != BOUNCE) || fit.enable_limit;
    const bool set = has && (d->what != MOTOR || fit.enable_motor) && !one_of(d, 3);
    const plumb_joint joint = sim_joint(d->world, set && !d->later ? fit : plain);
    if (set && d->later) {
        set_joint(d, joint, &fit);
    }
}

static void set_body(draft *d, plumb_body b, const plumb_body_desc *to)
{
    plumb_world *w = d->world;
    plumb_result r = PLUMB_OK;
    switch (d->what) {
    case DAMPING:
        r = plumb_body_set_damping(w, b, to->damping, to->angular_damping);
        break;
    case CAP:
        r = plumb_body_set_speed_cap(w, b, to->max_speed, to->max_spin);
        break;
    case GRAVITY_SCALE:
        r = plumb_body_set_gravity_scale(w, b, to->gravity_scale);
        break;
    case TIME_SCALE:
        r = plumb_body_set_time_scale(w, b, to->time_scale);
        break;
    case LOCKS:
        r = plumb_body_set_locks(w, b,
                                 (plumb_axis_locks){ to->lock_x, to->lock_y, to->fixed_rotation });
        break;
    case MASS:
        r = plumb_body_set_mass(w, b, to->mass);
        break;
    case DRAG:
        r = plumb_body_set_drag(w, b, to->drag);
        break;
    case THRUST:
        r = plumb_body_set_thrust(w, b, to->thrust);
        break;
    case BODY_OFF:
        r = plumb_body_set_enabled(w, b, false);
        break;
    default:
        break;
    }
    assert_int_equal(r, PLUMB_OK);
}

static void set_shape(draft *d, plumb_shape shape, const plumb_shape_desc *to)
{
    plumb_result r = PLUMB_OK;
    if (d->what == FILTER) {
        r = plumb_shape_set_filter(d->world, shape, to->filter);
    } else if (d->what == ONE_WAY) {
        r = plumb_shape_set_one_way(d->world, shape, to->one_way);
    } else if (d->what == SHAPE_MATERIAL) {
        r = plumb_shape_set_material(d->world, shape, to->material);
    }
    assert_int_equal(r, PLUMB_OK);
}

static void add_shape(draft *d, plumb_body b, bool set)
{
    const plumb_shape_desc plain = { .kind = PLUMB_BOX,
                                     .half = { any(d, 0.1, 0.5), any(d, 0.1, 0.5) },
                                     .center = { any(d, -0.3, 0.3), any(d, -0.3, 0.3) },
                                     .material = d->plain };
    plumb_shape_desc to = plain;
    if (d->what == FILTER) {
        to.filter = (plumb_filter){ .category = 1u << (int)any(d, 0, 3), .mask = 5 };
    } else if (d->what == ONE_WAY) {
        to.one_way = (plumb_one_way){ .direction = { any(d, -1, 1), 1 }, .angle = any(d, 0.2, 1) };
    } else if (d->what == SHAPE_MATERIAL) {
        to.material = d->other;
    }
    const plumb_shape shape = plumb_shape_create(d->world, b, set && !d->later ? &to : &plain);
    if (set && d->later) {
        set_shape(d, shape, &to);
    }
}

static void add_body(draft *d, int i)
{
    const bool still = d->what == LOCKS;
    const plumb_body_desc plain = { .position = { any(d, -3, 3), any(d, 0, 6) },
                                    .angle = any(d, -3, 3),
                                    .velocity = { still ? 0 : any(d, -2, 2), 0 },
                                    .angular_velocity = still ? 0 : any(d, -2, 2) };
    plumb_body_desc to = plain;
    const bool set = !one_of(d, 3);
    to.damping = d->what == DAMPING ? any(d, 0, 3) : 0;
    to.angular_damping = to.damping / 2;
    to.max_speed = d->what == CAP ? any(d, 0.5, 3) : 0;
    to.max_spin = to.max_speed;
    to.gravity_scale = d->what == GRAVITY_SCALE ? any(d, -1, 2) : 0;
    to.time_scale = d->what == TIME_SCALE ? any(d, 0.3, 2) : 0;
    to.lock_x = d->what == LOCKS && one_of(d, 2);
    to.lock_y = d->what == LOCKS && one_of(d, 2);
    to.fixed_rotation = d->what == LOCKS && one_of(d, 2);
    to.mass = d->what == MASS ? any(d, 0.5, 4) : 0;
    to.drag = d->what == DRAG ? any(d, 0, 2) : 0;
    to.thrust = d->what == THRUST ? any(d, 0, 20) : 0;
    to.disabled = d->what == BODY_OFF;
    d->body[i] = plumb_body_create(d->world, set && !d->later ? &to : &plain);
    add_shape(d, d->body[i], set);
    if (set && d->later) {
        set_body(d, d->body[i], &to);
    }
}

static plumb_world *make(change what, uint32_t seed, bool later)
{
    draft d = { .seed = seed, .what = what, .later = later };
    const plumb_vec2 gravity = { any(&d, -3, 3), any(&d, -12, -5) };
    const int substeps = 1 + (int)any(&d, 0, 8), sweeps = 1 + (int)any(&d, 0, 3);
    const plumb_real hertz = any(&d, 5, 60), damping = any(&d, 1, 5), push = any(&d, 1, 6);
    plumb_world_desc world = { 0 };
    if (!later && what == GRAVITY) {
        world.gravity = gravity;
    } else if (!later && what == SUBSTEPS) {
        world.substeps = substeps, world.iterations = sweeps;
    } else if (!later && what == TUNING) {
        world.contact_hertz = hertz, world.contact_damping = damping, world.push_speed = push;
    }
    d.world = sim_world(&world);
    const plumb_material_desc one = { .friction = any(&d, 0.1, 1) };
    const plumb_material_desc two = { .friction = any(&d, 0.1, 1),
                                      .restitution = any(&d, 0, 0.8),
                                      .rolling_resistance = any(&d, 0, 0.1) };
    d.plain = plumb_material_create(d.world, !later && what == MATERIAL ? &two : &one);
    d.other = plumb_material_create(d.world, &two);
    sim_floor(d.world, d.plain);
    for (int i = 0; i < BODIES; ++i) {
        add_body(&d, i);
    }
    for (int i = 0; i < JOINTS; ++i) {
        add_joint(&d, i);
    }
    if (later && what == MATERIAL) {
        assert_int_equal(plumb_material_set(d.world, d.plain, &two), PLUMB_OK);
    } else if (later && what == GRAVITY) {
        assert_int_equal(plumb_world_set_gravity(d.world, gravity), PLUMB_OK);
    } else if (later && what == SUBSTEPS) {
        assert_int_equal(plumb_world_set_substeps(d.world, substeps, sweeps), PLUMB_OK);
    } else if (later && what == TUNING) {
        assert_int_equal(plumb_world_set_contact_tuning(d.world, hertz, damping, push), PLUMB_OK);
    }
    return d.world;
}

// True when all bodies are where they are in the other world, as fast.
static bool alike(plumb_world *a, plumb_world *b)
{
    const plumb_body_span p = plumb_world_bodies(a), q = plumb_world_bodies(b);
    bool same = p.count == q.count;
    for (int i = 0; same && i < p.count; ++i) {
        same = p.x[i] == q.x[i] && p.y[i] == q.y[i] && p.c[i] == q.c[i] && p.s[i] == q.s[i] &&
               p.vx[i] == q.vx[i] && p.vy[i] == q.vy[i] && p.w[i] == q.w[i];
    }
    return same;
}

static void what_is_set_later_is_what_was_made(void **state)
{
    (void)state;
    int others = 0;
    for (int what = 0; what < CHANGES; ++what) {
        for (uint32_t seed = 1; seed <= SEEDS; ++seed) {
            plumb_world *made = make((change)what, 7919 * seed, false);
            plumb_world *set = make((change)what, 7919 * seed, true);
            int step = 0;
            while (step < STEPS && alike(made, set)) {
                sim_step(made, HZ60);
                sim_step(set, HZ60);
                ++step;
            }
            if (!alike(made, set)) {
                print_message("%s, seed %u: others after step %d\n", names[what], seed, step);
                ++others;
            }
            plumb_world_destroy(made);
            plumb_world_destroy(set);
        }
    }
    assert_int_equal(others, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_set_later_is_what_was_made),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
