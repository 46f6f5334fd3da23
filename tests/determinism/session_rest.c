// session_rest.c - see session_rest.h.
#include "session_rest.h"

#include "harness/random.h"

#include <stddef.h>

#define R(x) ((plumb_real)(x))

static uint32_t pick(session *s, uint32_t count)
{
    return sim_random(&s->seed) % count;
}

static plumb_real number(session *s, double low, double high)
{
    return R(sim_uniform(&s->seed, low, high));
}

static plumb_vec2 place(session *s, double reach)
{
    const plumb_real x = number(s, -reach, reach);
    return plumb_v2(x, number(s, -reach, reach));
}

//---- bodies --------------------------------------------------------------------------------------

typedef plumb_result set_fn(plumb_world *world, plumb_body body, plumb_real value);

// A property of bodies, and what it may be.
typedef struct setter {
    set_fn *set;
    double low, high;
} setter;

static const setter setters[] = {
    { plumb_body_set_temperature, 0, 900 },   { plumb_body_set_heat_capacity, 1, 2000 },
    { plumb_body_set_conductance, 0, 1e3 },   { plumb_body_set_emissivity, 0, 1 },
    { plumb_body_set_ambient, 1, 500 },       { plumb_body_set_heating, -1e4, 1e5 },
    { plumb_body_set_melting_point, 0, 300 }, { plumb_body_set_latent_heat, 0, 1e3 },
    { plumb_body_set_melt_phase, 0, 0 },      { plumb_body_set_ignition, 0, 500 },
    { plumb_body_set_burn_rate, 0, 3 },       { plumb_body_set_burn_heat, 0, 1e4 },
    { plumb_body_set_growth, -5, 3 },         { plumb_body_set_smallest, 0.01, 0.3 },
    { plumb_body_set_thrust, 0, 30 },         { plumb_body_set_exhaust, 0, 100 },
    { plumb_body_set_fuel, 0, 0.2 },          { plumb_body_set_thrust_x, -0.3, 0.3 },
    { plumb_body_set_thrust_angle, -3, 3 },   { plumb_body_set_inertia, 0.01, 3 },
    { plumb_body_set_gravity_scale, -1, 2 },  { plumb_body_set_break_energy, 0, 2 },
    { plumb_body_set_break_impulse, 0, 1 },   { plumb_body_set_charge, -1, 1 },
    { plumb_body_set_dipole, -0.3, 0.3 },     { plumb_body_set_dipole_angle, -3, 3 },
    { plumb_body_set_angle, -9, 9 },          { plumb_body_set_angular_velocity, -9, 9 },
};

static void set_body(session *s, plumb_body b)
{
    const setter *t = &setters[pick(s, sizeof setters / sizeof setters[0])];
    t->set(s->world, b, number(s, t->low, t->high));
}

static void treat_body(session *s, plumb_body b)
{
    plumb_world *w = s->world;
    switch (pick(s, 8)) {
    case 0: // it burns away
        plumb_body_set_temperature(w, b, 400);
        plumb_body_set_ignition(w, b, 300);
        plumb_body_set_burn_rate(w, b, 3);
        break;
    case 1: // nothing that a step bears
        plumb_body_set_velocity(w, b, plumb_v2(R(1e11), 0));
        break;
    case 2:
        plumb_body_set_locks(w, b,
                             (plumb_axis_locks){ .x = pick(s, 2) == 0, .y = pick(s, 2) == 0 });
        break;
    case 3:
        plumb_body_set_local_center(w, b, place(s, 0.2));
        break;
    case 4:
        plumb_body_reset_mass(w, b);
        break;
    case 5:
        plumb_body_apply_force(w, b, place(s, 9), place(s, 2));
        break;
    case 6:
        plumb_body_set_no_sleep(w, b, pick(s, 2) == 0);
        break;
    default:
        plumb_body_set_speed_cap(w, b, number(s, 0, 5), number(s, 0, 5));
        break;
    }
}

//---- joints --------------------------------------------------------------------------------------

static void set_joint(session *s)
{
    plumb_world *w = s->world;
    const plumb_joint j = s->joint[pick(s, SESSION_JOINTS)];
    const plumb_real a = number(s, 0, 5), b = number(s, 0, 1), c = number(s, 0, 1);
    switch (pick(s, 9)) {
    case 0:
        plumb_joint_set_limit(w, j, pick(s, 2) == 0, -b, c);
        break;
    case 1:
        plumb_joint_set_restitution(w, j, b);
        break;
    case 2:
        plumb_joint_set_spring(w, j, a, b, c);
        break;
    case 3:
        plumb_joint_set_stiffness(w, j, 10 * a, b, c);
        break;
    case 4:
        plumb_joint_set_target(w, j, plumb_v2(a - 2, 3 * b));
        break;
    case 5:
        plumb_joint_set_break_impulse(w, j, a / 2);
        break;
    case 6:
        plumb_joint_set_event(w, j, a, a);
        break;
    case 7:
        plumb_joint_set_tell_impulse(w, j, pick(s, 2) == 0);
        break;
    default:
        plumb_joint_set_break(w, j, a, b);
        break;
    }
}

//---- the world -----------------------------------------------------------------------------------

static void set_material(session *s)
{
    const plumb_material_desc d = { .density = number(s, 0.5, 3),
                                    .friction = R(0.3),
                                    .restitution = number(s, 0, 1.5),
                                    .rolling_resistance = R(0.01),
                                    .surface_speed = number(s, -1, 1),
                                    .adhesion = number(s, 0, 3) };
    plumb_material_set(s->world, s->material[pick(s, SESSION_MATERIALS)], &d);
}

static void set_world(session *s)
{
    plumb_world *w = s->world;
    const plumb_real a = number(s, 0, 1);
    switch (pick(s, 9)) {
    case 0:
        plumb_world_set_contact_tuning(w, 60 * a, 1 + a, 1 + 8 * a);
        break;
    case 1:
        plumb_world_set_restitution_speed(w, a);
        break;
    case 2:
        plumb_world_set_hit_speed(w, 2 * a);
        break;
    case 3:
        plumb_world_set_tolerance(w, pick(s, 2) == 0 ? 0 : R(1e-2));
        break;
    case 4:
        plumb_world_set_time(w, 100 * (double)a);
        break;
    case 5:
        plumb_world_set_measure(w, pick(s, 2) == 0);
        break;
    case 6:
        plumb_world_set_watchdog(w, pick(s, 2) == 0);
        break;
    case 7:
        plumb_world_set_substeps(w, 1 + (int)pick(s, 12), 1 + (int)pick(s, 4));
        break;
    default:
        plumb_world_step(w, -1); // refused
        break;
    }
}

void session_act_besides(session *s)
{
    for (uint32_t n = pick(s, 6); n > 0; --n) {
        const plumb_body b = s->body[pick(s, SESSION_BODIES)];
        switch (pick(s, 6)) {
        case 0:
        case 1:
            set_body(s, b);
            break;
        case 2:
            treat_body(s, b);
            break;
        case 3:
            set_joint(s);
            break;
        case 4:
            set_material(s);
            break;
        default:
            set_world(s);
            break;
        }
    }
}
