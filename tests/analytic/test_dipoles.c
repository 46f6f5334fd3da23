// test_dipoles.c - dipoles against closed forms and against rigid pairs of charges: periods of a compass, its energy over many
// periods, the pull of charges and dipoles, worlds of both that keep momentum, angular momentum and energy, moved, turned, mirrored.
#include "harness/near.h"
#include "harness/random.h"
#include "harness/trials.h"

#include <string.h>

#define R(x)      ((plumb_real)(x))
#define TAU       6.283185307179586
#define IS_DOUBLE (sizeof(plumb_real) == 8 && !PLUMB_IS_FAR)

static plumb_world *make_world(plumb_world_desc desc)
{
    plumb_world *w;
    desc.zero_gravity = true;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    return w;
}

static void step(plumb_world *w, double dt)
{
    assert_int_equal(plumb_world_step(w, R(dt)), PLUMB_OK);
}

// An electric field, or what a magnet's field is to a compass.
static plumb_law add_field(plumb_world *w, double x, double y)
{
    return plumb_law_create(w, &(plumb_law_desc){ .kind = PLUMB_LAW_UNIFORM,
                                                  .hold = PLUMB_LAW_ON_CHARGE,
                                                  .vector = { R(x), R(y) } });
}

static plumb_law add_mutual(plumb_world *w, double k, double softening, plumb_falloff falloff)
{
    return plumb_law_create(w, &(plumb_law_desc){ .kind = PLUMB_LAW_MUTUAL,
                                                  .hold = PLUMB_LAW_ON_CHARGE,
                                                  .falloff = falloff,
                                                  .strength = R(k),
                                                  .softening = R(softening) });
}

// Without a shape a body has no inertia unless it is given.
static plumb_body make_body(plumb_world *w, plumb_body_desc desc)
{
    desc.inertia = desc.inertia > 0 ? desc.inertia : 1;
    desc.no_sleep = true;
    const plumb_body b = plumb_body_create(w, &desc);
    assert_true(plumb_body_valid(w, b));
    return b;
}

//---- a compass -----------------------------------------------------------------------------------

// Inertia 0.5, moment 2, field 3: w0^2 = p E / I = 12.
#define INERTIA 0.5
#define MOMENT  2.0
#define FIELD   3.0

static double arithmetic_geometric(double a, double b)
{
    for (int i = 0; i < 40; ++i) {
        const double mean = (a + b) / 2;
        b = sqrt(a * b);
        a = mean;
    }
    return a;
}

// Of a pendulum that is let go at an angle: 4 K(sin(angle / 2)) / w0, K by the arithmetic-geometric mean.
static double period_of(double angle)
{
    const double w0 = sqrt(MOMENT * FIELD / INERTIA);
    return TAU / (w0 * arithmetic_geometric(1, cos(angle / 2)));
}

static plumb_body make_compass(plumb_world *w, double angle, plumb_body_desc desc)
{
    desc.inertia = R(INERTIA);
    desc.dipole = R(MOMENT);
    desc.angle = R(angle);
    return make_body(w, desc);
}

// [rad] off the place at which it is 2 1/4 periods on: it goes through the middle, and its speed tells the time that it is off by.
static double swing(double amplitude, int steps, plumb_solver solver)
{
    plumb_world *w = make_world((plumb_world_desc){ .substeps = 1, .solver = solver });
    add_field(w, FIELD, 0);
    const plumb_body b = make_compass(w, amplitude, (plumb_body_desc){ 0 });
    for (int i = 0; i < steps; ++i) {
        step(w, 2.25 * period_of(amplitude) / steps);
    }
    const double off = fabs((double)plumb_body_angle(w, b)) / amplitude;
    plumb_world_destroy(w);
    return off;
}

static void a_compass_swings_like_a_pendulum(void **state)
{
    (void)state;
    const double amplitudes[] = { 0.01, 1, 2.5, 3.1 };
    const plumb_solver solvers[] = { PLUMB_SOLVER_SOFT, PLUMB_SOLVER_PGS, PLUMB_SOLVER_EXACT };
    for (int i = 0; i < 4; ++i) {
        for (int k = 0; k < (i == 1 ? 3 : 1); ++k) {
            double last = swing(amplitudes[i], 200, solvers[k]);
            for (int n = 400; n <= 1600; n *= 2) {
                const double off = swing(amplitudes[i], n, solvers[k]);
                const double order = log(last / off) / log(2);
                print_message("from %g rad, %d steps: off by %.3g of it, order %.2f\n",
                              amplitudes[i], n, off, order);
                assert_true(!IS_DOUBLE || fabs(order - 2) < 0.1);
                last = off;
            }
            // Next to the top the time that it takes hangs on the last bits of the angle.
            assert_true(last < (amplitudes[i] > 3 ? 1.2e-3 + ROUNDED(1e-2) : 2e-4));
        }
    }
}

// However it swings, the energy of the last hundred periods is off by no more than that of the first: with h w of 1, too.
static void energy_of_a_compass_stays_bounded(void **state)
{
    (void)state;
    const double w0 = sqrt(MOMENT * FIELD / INERTIA), ratios[] = { 1, 0.5, 0.1 };
    for (int i = 0; i < 3; ++i) {
        plumb_world *w = make_world((plumb_world_desc){ .substeps = 1 });
        add_field(w, FIELD, 0);
        make_compass(w, 2, (plumb_body_desc){ 0 });
        const double h = ratios[i] / w0, deep = MOMENT * FIELD;
        const long steps = trials_steps((int)(1e4 * TAU / ratios[i]));
        const double start = plumb_world_energy(w).potential;
        assert_near(start, -deep * cos(2), 1e-6);
        double worst[2] = { 0, 0 };
        for (long k = 0; k < steps; ++k) {
            step(w, h);
            if (k < steps / 100 || k >= steps - steps / 100) {
                const plumb_energy e = plumb_world_energy(w);
                const double off = fabs(e.kinetic + e.potential - start) / deep;
                worst[k >= steps / 100] = fmax(worst[k >= steps / 100], off);
            }
        }
        print_message("h w %g: %ld steps, off by %.4g of p E, then by %.4g\n", ratios[i], steps,
                      worst[0], worst[1]);
        assert_true(worst[1] < 1.1 * worst[0] + ROUNDED(2e-3));
        plumb_world_destroy(w);
    }
}

// Its own time, a lock, and a law of nothing.
static void settings_of_a_compass_hold(void **state)
{
    (void)state;
    plumb_world *w = make_world((plumb_world_desc){ .substeps = 8 });
    add_field(w, FIELD, 0);
    const plumb_body plain = make_compass(w, 1, (plumb_body_desc){ 0 });
    const plumb_body slow = make_compass(w, 1, (plumb_body_desc){ .time_scale = R(0.5) });
    const plumb_body stiff = make_compass(w, 1, (plumb_body_desc){ .fixed_rotation = true });
    const plumb_body turned =
        make_compass(w, 0.25, (plumb_body_desc){ .dipole_angle = R(0.75), .position = { 3, 4 } });
    const plumb_body none = make_body(w, (plumb_body_desc){ .angle = 1 });
    const plumb_body held = make_compass(w, 1, (plumb_body_desc){ .lock_x = true, .lock_y = true });
    double angle = 0;
    for (int i = 0; i < 240; ++i) {
        step(w, 1.0 / 240);
        if (i == 119) {
            angle = (double)plumb_body_angle(w, plain);
        }
    }
    assert_near(plumb_body_angle(w, slow), angle, 1e-4);
    assert_near(plumb_body_angle(w, stiff), 1, ROUNDED(1e-6));
    assert_near(plumb_body_angle(w, none), 1, ROUNDED(1e-6));
    assert_near(plumb_body_angle(w, turned), (double)plumb_body_angle(w, plain) - 0.75,
                ROUNDED(2e-5));
    assert_near(plumb_body_angle(w, held), plumb_body_angle(w, plain), ROUNDED(1e-5));
    assert_vec_near(plumb_body_position(w, turned), 3, 4, 0);
    plumb_world_destroy(w);
}

//---- pulls ---------------------------------------------------------------------------------------

typedef struct pulled {
    double fx, fy, torque;
} pulled;

// What a body of mass 1 and inertia 1 has of a very short step.
static pulled pull_on(plumb_world *w, plumb_body b)
{
    const double dt = 1e-4;
    step(w, dt);
    const plumb_vec2 v = plumb_body_velocity(w, b);
    return (pulled){ (double)v.x / dt, (double)v.y / dt,
                     (double)plumb_body_angular_velocity(w, b) / dt };
}

static pulled pull_between(plumb_body_desc a, plumb_body_desc b)
{
    plumb_world *w = make_world((plumb_world_desc){ .substeps = 1 });
    add_mutual(w, 1.5, 0, PLUMB_FALLOFF_SQUARE);
    make_body(w, a);
    const pulled p = pull_on(w, make_body(w, b));
    plumb_world_destroy(w);
    return p;
}

static void assert_pull(pulled p, double fx, double fy, double torque)
{
    const double noise = 1e-6 + ROUNDED(1e-5);
    assert_near(p.fx, fx, noise);
    assert_near(p.fy, fy, noise);
    assert_near(p.torque, torque, noise);
}

// k = 1.5, r = 2, q = 3, p = 0.5.
static void pulls_are_those_of_textbooks(void **state)
{
    (void)state;
    const double k = 1.5, r = 2, q = 3, p = 0.5;
    const plumb_body_desc charge = { .charge = 3 }, magnet = { .dipole = R(0.5) };
    const plumb_body_desc across = { .dipole = R(0.5), .dipole_angle = R(TAU / 4) };
    plumb_body_desc other = { .position = { 0, 2 }, .dipole = R(0.5), .angle = R(TAU / 4) };
    assert_pull(pull_between(charge, other), 0, -2 * k * q * p / (r * r * r), 0);
    other.angle = 0;
    assert_pull(pull_between(charge, other), k * q * p / (r * r * r), 0, k * q * p / (r * r));
    other.time_scale = R(0.5); // of its own time, of which half as much has passed
    assert_pull(pull_between(charge, other), k * q * p / (r * r * r) / 2, 0,
                k * q * p / (r * r) / 2);
    other.time_scale = 1;
    other.angle = R(TAU / 4);
    assert_pull(pull_between(across, other), 0, -6 * k * p * p / (r * r * r * r), 0);
    other.angle = 0;
    assert_pull(pull_between(magnet, other), 0, 3 * k * p * p / (r * r * r * r), 0);
    other.angle = R(TAU / 2);
    assert_pull(pull_between(magnet, other), 0, -3 * k * p * p / (r * r * r * r), 0);
}

// Sources of what is felt at a place: a charge on top of a dipole, without and with.
static void dipoles_count_where_fields_are_asked(void **state)
{
    (void)state;
    plumb_world *w = make_world((plumb_world_desc){ 0 });
    add_mutual(w, 1.5, 0, PLUMB_FALLOFF_SQUARE);
    make_body(w, (plumb_body_desc){ .dipole = R(0.5) });
    const plumb_vec2 along = plumb_world_law_at(w, plumb_v2(2, 0), plumb_v2(0, 0), 4);
    assert_vec_near(along, 4 * 2 * 1.5 * 0.5 / 8, 0, ROUNDED(1e-6));
    const plumb_vec2 beside = plumb_world_law_at(w, plumb_v2(0, 2), plumb_v2(0, 0), 4);
    assert_vec_near(beside, -4 * 1.5 * 0.5 / 8, 0, ROUNDED(1e-6));
    plumb_world_destroy(w);
}

// Zones turn what is in them, the one of higher priority alone; attractors that a body carries have a reaction.
static void zones_and_carriers_act(void **state)
{
    (void)state;
    plumb_world *w = make_world((plumb_world_desc){ .substeps = 1 });
    const plumb_law field = add_field(w, 0, 2);
    plumb_law_create(w, &(plumb_law_desc){ .kind = PLUMB_LAW_UNIFORM,
                                           .hold = PLUMB_LAW_ON_CHARGE,
                                           .combine = PLUMB_LAW_REPLACE,
                                           .priority = 1,
                                           .position = { 9, 0 },
                                           .radius = 1,
                                           .vector = { 0, -5 } });
    const plumb_body in = make_body(w, (plumb_body_desc){ .position = { 9, R(0.5) }, .dipole = 3 });
    const plumb_body out = make_body(w, (plumb_body_desc){ .position = { 9, 2 }, .dipole = 3 });
    pulled p = pull_on(w, in);
    assert_pull(p, 0, 0, -15);
    assert_near((double)plumb_body_angular_velocity(w, out) / 1e-4, 6, 1e-3);
    plumb_law_destroy(w, field);
    plumb_body_destroy(w, in), plumb_body_destroy(w, out);
    const plumb_body star = make_body(w, (plumb_body_desc){ .position = { 20, 0 }, .mass = 4 });
    plumb_law_create(w, &(plumb_law_desc){ .kind = PLUMB_LAW_ATTRACTOR,
                                           .hold = PLUMB_LAW_ON_CHARGE,
                                           .body = star,
                                           .strength = 3 });
    const plumb_body moon =
        make_body(w, (plumb_body_desc){ .position = { 22, 0 }, .dipole = R(0.5) });
    p = pull_on(w, moon);
    assert_pull(p, 2 * 3 * 0.5 / 8, 0, 0); // its nearer end is pushed away by what pulls the other
    assert_near((double)plumb_body_velocity(w, star).x / 1e-4, -0.375 / 4, 1e-4);
    plumb_world_destroy(w);
}

// The same potential as an attractor and as a formula: a dipole is pulled and turned alike, and has the same energy.
static void formulas_act_as_attractors_do(void **state)
{
    (void)state;
    double at[2][3], energy[2];
    for (int k = 0; k < 2; ++k) {
        plumb_world *w = make_world((plumb_world_desc){ .substeps = 4 });
        plumb_law_desc d = { .kind = PLUMB_LAW_ATTRACTOR,
                             .hold = PLUMB_LAW_ON_CHARGE,
                             .strength = 3,
                             .softening = R(0.5),
                             .position = { 1, 0 } };
        if (k == 1) {
            d.kind = PLUMB_LAW_FORMULA;
            d.strength = d.softening = 0;
            d.potential = "-3 / sqrt(x^2 + y^2 + 0.25)";
        }
        assert_false(plumb_is_null(plumb_law_create(w, &d)));
        const plumb_body b = make_body(
            w,
            (plumb_body_desc){ .dipole = 2, .charge = R(-0.5), .angle = 1, .position = { 0, 1 } });
        energy[k] = plumb_world_energy(w).potential;
        for (int i = 0; i < 60; ++i) {
            step(w, 1.0 / 60);
        }
        const plumb_vec2 p = plumb_body_center(w, b);
        at[k][0] = (double)p.x, at[k][1] = (double)p.y, at[k][2] = (double)plumb_body_angle(w, b);
        plumb_world_destroy(w);
    }
    assert_near(energy[1], energy[0], 1e-6);
    for (int i = 0; i < 3; ++i) {
        assert_near(at[1][i], at[0][i], 1e-5 + ROUNDED(1e-4));
    }
}

//---- worlds of charges and dipoles ---------------------------------------------------------------

enum { THINGS = 6 };

// State, and what it is.
typedef struct thing {
    double x, y, angle, vx, vy, w;
    double mass, inertia, charge, dipole, dipole_angle;
} thing;

typedef struct many {
    thing things[THINGS];
    double k, softening;
    plumb_falloff falloff;
    double field[2], pull, at[2]; // uniform; of an attractor at a place
} many;

// Far enough apart for steps of a second's 60th to be fine.
static many anything(uint32_t *seed)
{
    many m = { .k = sim_uniform(seed, -1, 1),
               .softening = sim_uniform(seed, 0.2, 0.6),
               .falloff = (plumb_falloff)(sim_random(seed) % 5) };
    for (int i = 0; i < THINGS; ++i) {
        thing *t = &m.things[i];
        *t = (thing){ .x = 1.6 * (i % 3) + sim_uniform(seed, -0.3, 0.3),
                      .y = 1.6 * (i / 3) + sim_uniform(seed, -0.3, 0.3),
                      .angle = sim_uniform(seed, -3, 3),
                      .vx = sim_uniform(seed, -0.5, 0.5),
                      .vy = sim_uniform(seed, -0.5, 0.5),
                      .w = sim_uniform(seed, -1, 1),
                      .mass = sim_uniform(seed, 0.5, 2),
                      .inertia = sim_uniform(seed, 0.3, 1),
                      .charge = sim_random(seed) % 2 == 0 ? sim_uniform(seed, -1, 1) : 0,
                      .dipole = i < 2 || sim_random(seed) % 2 == 0 ? sim_uniform(seed, -1, 1) : 0,
                      .dipole_angle = sim_uniform(seed, -3, 3) };
    }
    return m;
}

static plumb_world *world_of(const many *m, plumb_world_desc desc, plumb_body out[THINGS])
{
    plumb_world *w = make_world(desc);
    add_mutual(w, m->k, m->softening, m->falloff);
    add_field(w, m->field[0], m->field[1]);
    plumb_law_create(w, &(plumb_law_desc){ .kind = PLUMB_LAW_ATTRACTOR,
                                           .hold = PLUMB_LAW_ON_CHARGE,
                                           .falloff = m->falloff,
                                           .position = { R(m->at[0]), R(m->at[1]) },
                                           .strength = R(m->pull),
                                           .softening = R(m->softening) });
    for (int i = 0; i < THINGS; ++i) {
        const thing *t = &m->things[i];
        out[i] = make_body(w, (plumb_body_desc){ .position = { R(t->x), R(t->y) },
                                                 .angle = R(t->angle),
                                                 .velocity = { R(t->vx), R(t->vy) },
                                                 .angular_velocity = R(t->w),
                                                 .mass = R(t->mass),
                                                 .inertia = R(t->inertia),
                                                 .charge = R(t->charge),
                                                 .dipole = R(t->dipole),
                                                 .dipole_angle = R(t->dipole_angle) });
    }
    return w;
}

static double total(const plumb_energy *e)
{
    return e->kinetic + e->potential;
}

// [J] most that the energy is off in half a second; momenta are held to rounding on the way, and `drift` is the most of it.
static double run_closed(const many *m, double dt, double *drift)
{
    plumb_body bodies[THINGS];
    plumb_world *w = world_of(m, (plumb_world_desc){ .substeps = 1 }, bodies);
    const plumb_energy before = plumb_world_energy(w);
    const int steps = (int)(0.5 / dt + 0.5);
    double worst = 0;
    for (int i = 0; i < steps; ++i) {
        step(w, dt);
        const plumb_energy now = plumb_world_energy(w);
        const double noise = ROUNDED(2e-6) * (10 + i);
        assert_near(now.momentum_x, before.momentum_x, noise);
        assert_near(now.momentum_y, before.momentum_y, noise);
        assert_near(now.angular_momentum, before.angular_momentum, 4 * noise);
        *drift = fmax(*drift, fabs(now.momentum_x - before.momentum_x));
        *drift = fmax(*drift, fabs(now.angular_momentum - before.angular_momentum));
        worst = fmax(worst, fabs(total(&now) - total(&before)));
    }
    plumb_world_destroy(w);
    return worst;
}

static void closed_worlds_keep_what_they_should(void **state)
{
    (void)state;
    const trials t = trials_from(1, 60);
    int seen = 0;
    double drift = 0, worst = 0;
    for (uint32_t n = t.first; n < t.end; ++n) {
        uint32_t seed = n * 2654435761u + 1;
        const many m = anything(&seed);
        const double coarse = run_closed(&m, 1.0 / 64, &drift);
        const double fine = run_closed(&m, 1.0 / 128, &drift);
        const double finest = run_closed(&m, 1.0 / 256, &drift);
        worst = fmax(worst, finest);
        const double order = log(fine / finest) / log(2);
        if (IS_DOUBLE) {
            assert_true(finest < 1e-9 || fabs(order - 2) < 0.35);
        }
        assert_true(finest < 1e-3 + ROUNDED(1e-4) && finest <= coarse + ROUNDED(1e-4));
        seen += finest > 1e-6;
    }
    print_message("momenta drift by %.2g, energies by %.2g J at 256 Hz\n", drift, worst);
    assert_true(seen > 0); // there was something to keep
}

// Two strong ones without shapes fall into each other again and again: softening bounds what they do where they meet, where
// k p^2 / softening^3 is 1,125 J and h w, at 240 Hz, 1.2. The share of that by which the energy is off at the most.
static double fall_together(double dt)
{
    plumb_world *w = make_world((plumb_world_desc){ .substeps = 1 });
    add_mutual(w, 1, 0.2, PLUMB_FALLOFF_SQUARE);
    const plumb_body a = make_body(w, (plumb_body_desc){ .dipole = 3, .angle = R(0.3) });
    make_body(w, (plumb_body_desc){ .dipole = 3, .position = { 1, R(0.1) }, .angle = R(-0.2) });
    const plumb_energy start = plumb_world_energy(w);
    double worst = 0, fastest = 0;
    for (int i = 0; i < (int)(5 / dt); ++i) {
        step(w, dt);
        const plumb_energy now = plumb_world_energy(w);
        const plumb_vec2 v = plumb_body_velocity(w, a);
        worst = fmax(worst, fabs(total(&now) - total(&start)) / 1125);
        fastest = fmax(fastest, hypot((double)v.x, (double)v.y));
    }
    print_message("at %.0f Hz: %.3g of 1,125 J off, up to %.3g m/s\n", 1 / dt, worst, fastest);
    assert_true(fastest > 3 && fastest < 50);
    plumb_world_destroy(w);
    return worst;
}

static void softening_bounds_those_that_meet(void **state)
{
    (void)state;
    const double coarse = fall_together(1.0 / 240), fine = fall_together(1.0 / 960);
    assert_true(coarse < 0.2 && fine < coarse / 3);
}

//---- moved, turned, mirrored ---------------------------------------------------------------------

static void turn(double angle, double v[2])
{
    const double c = cos(angle), s = sin(angle), x = v[0];
    v[0] = c * x - s * v[1];
    v[1] = s * x + c * v[1];
}

// The same world elsewhere: mirrored (y becomes -y), then turned, then moved.
static many moved(const many *from, bool mirrored, double angle, double dx, double dy)
{
    many m = *from;
    const double sign = mirrored ? -1 : 1;
    for (int i = 0; i < THINGS; ++i) {
        thing *t = &m.things[i];
        double at[] = { t->x, sign * t->y }, v[] = { t->vx, sign * t->vy };
        turn(angle, at), turn(angle, v);
        t->x = at[0] + dx, t->y = at[1] + dy;
        t->vx = v[0], t->vy = v[1];
        t->angle = sign * t->angle + angle;
        t->w *= sign;
        t->dipole_angle *= sign;
    }
    m.field[1] *= sign, m.at[1] *= sign;
    turn(angle, m.field), turn(angle, m.at);
    m.at[0] += dx, m.at[1] += dy;
    return m;
}

static many with_fields(many m, uint32_t *seed)
{
    m.field[0] = sim_uniform(seed, -1, 1), m.field[1] = sim_uniform(seed, -1, 1);
    m.pull = sim_uniform(seed, -1, 1);
    m.at[0] = sim_uniform(seed, -2, -1), m.at[1] = sim_uniform(seed, -2, -1);
    return m;
}

static void go(const many *m, int steps, double dt, int substeps, thing out[THINGS])
{
    plumb_body bodies[THINGS];
    plumb_world *w = world_of(m, (plumb_world_desc){ .substeps = substeps }, bodies);
    for (int i = 0; i < steps; ++i) {
        step(w, dt);
    }
    for (int i = 0; i < THINGS; ++i) {
        const plumb_vec2 at = plumb_body_center(w, bodies[i]),
                         v = plumb_body_velocity(w, bodies[i]);
        out[i] = (thing){ .x = (double)at.x,
                          .y = (double)at.y,
                          .angle = (double)plumb_body_angle(w, bodies[i]),
                          .vx = (double)v.x,
                          .vy = (double)v.y,
                          .w = (double)plumb_body_angular_velocity(w, bodies[i]) };
    }
    plumb_world_destroy(w);
}

static double off_by(const thing *a, const thing *b)
{
    double most = 0;
    for (int i = 0; i < THINGS; ++i) {
        const double angle = a[i].angle - b[i].angle;
        const double parts[] = { a[i].x - b[i].x, a[i].y - b[i].y, 2 * sin(angle / 2),
                                 a[i].w - b[i].w };
        for (int k = 0; k < 4; ++k) {
            most = fmax(most, fabs(parts[k]));
        }
    }
    return most;
}

static void the_world_may_be_moved_turned_and_mirrored(void **state)
{
    (void)state;
    const trials t = trials_from(1, 40);
    for (uint32_t n = t.first; n < t.end; ++n) {
        uint32_t seed = n * 2246822519u + 1;
        many m = anything(&seed);
        m = with_fields(m, &seed);
        const bool mirrored = n % 2 == 0;
        const double angle = sim_uniform(&seed, -3, 3), dx = sim_uniform(&seed, -4, 4),
                     dy = sim_uniform(&seed, -4, 4);
        const many other = moved(&m, mirrored, angle, dx, dy);
        thing here[THINGS], there[THINGS];
        go(&m, 30, 1.0 / 60, 2, here);
        go(&other, 30, 1.0 / 60, 2, there);
        many end = m;
        memcpy(end.things, here, sizeof here);
        end = moved(&end, mirrored, angle, dx, dy);
        assert_true(off_by(end.things, there) < 1e-12 + ROUNDED(2e-4));
    }
}

//---- against pairs of charges --------------------------------------------------------------------

typedef struct end {
    double x, y, q; // from the body's middle
} end;

static void ends_of(const thing *t, double apart, end out[3])
{
    const double c = cos(t->angle + t->dipole_angle), s = sin(t->angle + t->dipole_angle);
    out[0] = (end){ 0, 0, t->charge };
    out[1] = (end){ apart * c, apart * s, t->dipole / (2 * apart) };
    out[2] = (end){ -apart * c, -apart * s, -t->dipole / (2 * apart) };
}

// [N] over the way between two charges of 1.
static double falloff_at(const many *m, double square)
{
    static const double powers[] = { -1.5, -1, -2, -0.5, 0 };
    return pow(square + m->softening * m->softening, powers[m->falloff]);
}

static void push(double force[3], const end *at, double fx, double fy)
{
    force[0] += fx, force[1] += fy;
    force[2] += at->x * fy - at->y * fx;
}

static void force_of(const many *m, double apart, double out[THINGS][3])
{
    end ends[THINGS][3];
    memset(out, 0, THINGS * sizeof out[0]);
    for (int i = 0; i < THINGS; ++i) {
        ends_of(&m->things[i], apart, ends[i]);
    }
    for (int i = 0; i < THINGS; ++i) {
        for (int a = 0; a < 3; ++a) {
            const end *p = &ends[i][a];
            const double x = m->things[i].x + p->x, y = m->things[i].y + p->y;
            const double px = x - m->at[0], py = y - m->at[1];
            const double f = -m->pull * falloff_at(m, px * px + py * py);
            push(out[i], p, p->q * (m->field[0] + f * px), p->q * (m->field[1] + f * py));
            for (int k = i + 1; k < THINGS; ++k) {
                for (int b = 0; b < 3; ++b) {
                    const end *o = &ends[k][b];
                    const double dx = m->things[k].x + o->x - x, dy = m->things[k].y + o->y - y;
                    const double g = m->k * p->q * o->q * falloff_at(m, dx * dx + dy * dy);
                    push(out[k], o, g * dx, g * dy);
                    push(out[i], p, -g * dx, -g * dy);
                }
            }
        }
    }
}

// The leapfrog of rigid bodies with three charges each.
static void go_rigid(const many *m, double apart, int steps, double h, thing out[THINGS])
{
    many now = *m;
    double f[THINGS][3];
    for (int i = 0; i < steps; ++i) {
        for (int half = 0; half < 2; ++half) {
            for (int k = 0; k < THINGS; ++k) {
                thing *t = &now.things[k];
                t->x += h / 2 * t->vx, t->y += h / 2 * t->vy, t->angle += h / 2 * t->w;
            }
            if (half == 0) {
                force_of(&now, apart, f);
                for (int k = 0; k < THINGS; ++k) {
                    thing *t = &now.things[k];
                    t->vx += h * f[k][0] / t->mass, t->vy += h * f[k][1] / t->mass;
                    t->w += h * f[k][2] / t->inertia;
                }
            }
        }
    }
    memcpy(out, now.things, sizeof now.things);
}

// The distance of the ends is halved: what the world is off by falls to a quarter. Same steps on both sides: what is left is the distance.
static void dipoles_are_the_limit_of_pairs_of_charges(void **state)
{
    (void)state;
    const trials t = trials_from(1, 60);
    double worst = 0;
    for (uint32_t n = t.first; n < t.end; ++n) {
        uint32_t seed = n * 3266489917u + 1;
        many m = anything(&seed);
        m = with_fields(m, &seed);
        thing world[THINGS], wide[THINGS], narrow[THINGS];
        go(&m, 120, 1.0 / 240, 1, world);
        go_rigid(&m, 0.04, 120, 1.0 / 240, wide);
        go_rigid(&m, 0.02, 120, 1.0 / 240, narrow);
        const double coarse = off_by(world, wide), fine = off_by(world, narrow);
        worst = fmax(worst, fine);
        assert_true(fine < 0.02);
        if (IS_DOUBLE) {
            assert_true(fine < 1e-9 || fabs(coarse / fine - 4) < 0.3);
        }
    }
    print_message("ends 4 cm apart: off by %.2g at the most\n", worst);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_compass_swings_like_a_pendulum),
        cmocka_unit_test(energy_of_a_compass_stays_bounded),
        cmocka_unit_test(settings_of_a_compass_hold),
        cmocka_unit_test(pulls_are_those_of_textbooks),
        cmocka_unit_test(dipoles_count_where_fields_are_asked),
        cmocka_unit_test(zones_and_carriers_act),
        cmocka_unit_test(formulas_act_as_attractors_do),
        cmocka_unit_test(closed_worlds_keep_what_they_should),
        cmocka_unit_test(softening_bounds_those_that_meet),
        cmocka_unit_test(the_world_may_be_moved_turned_and_mirrored),
        cmocka_unit_test(dipoles_are_the_limit_of_pairs_of_charges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
