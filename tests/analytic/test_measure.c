// test_measure.c - the error of a step as the world measures it: the energy of a step adds up to rounding by what changed
// it, in any world; and rows of it, and residuals, against closed forms.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/random.h"
#include "harness/sim.h"

#define DT (1 / 60.0)

static uint32_t seed;

static double uniform(double low, double high)
{
    return sim_uniform(&seed, low, high);
}

static bool often(double share)
{
    return uniform(0, 1) < share;
}

static plumb_balance work(const plumb_world *w, plumb_work of)
{
    return plumb_world_measures(w)->work[of];
}

static double total(plumb_balance b)
{
    return b.kinetic + b.potential;
}

//---- random worlds -------------------------------------------------------------------------------

#define BODIES 24
#define BURST  1e6 // [J]

static plumb_world_desc random_settings(int threads)
{
    const bool classic = often(0.3), exact = often(0.2);
    return (plumb_world_desc){
        .measure = true,
        .workers = threads,
        .solver = classic ? PLUMB_SOLVER_PGS
                  : exact ? PLUMB_SOLVER_EXACT
                          : PLUMB_SOLVER_SOFT,
        .substeps = (int)uniform(1, 7),
        .iterations = often(0.5) ? 0 : (int)uniform(1, 5),
        .direct_joints = often(0.3),
        .contact_impulses = often(0.3),
        .hit_speed = often(0.3) ? 1 : 0,
        .no_continuous = often(0.3),
        .gravity = { (plumb_real)uniform(-2, 2), (plumb_real)-uniform(1, 12) },
    };
}

static plumb_body random_body(plumb_world *w, int i, plumb_material m)
{
    const bool odd = often(0.3), fixed = often(0.1);
    plumb_body b = plumb_body_create(
        w, &(plumb_body_desc){ .position = sim_vec(i % 6 * 1.1 - 3, 0.6 + i / 6 * 1.05),
                               .angle = (plumb_real)uniform(-3, 3),
                               .velocity = sim_vec(uniform(-3, 3), uniform(-3, 1)),
                               .angular_velocity = fixed ? 0 : (plumb_real)uniform(-4, 4),
                               .fixed_rotation = fixed,
                               .gravity_scale = odd ? (plumb_real)uniform(0.1, 2) : 0,
                               .damping = odd ? (plumb_real)uniform(0, 2) : 0,
                               .angular_damping = odd ? (plumb_real)uniform(0, 2) : 0,
                               .max_speed = often(0.1) ? 2 : 0,
                               .time_scale = often(0.1) ? (plumb_real)uniform(0.3, 2) : 0 });
    assert_false(plumb_is_null(b));
    if (often(0.5)) {
        sim_add_circle(w, b, uniform(0.2, 0.5), m);
    } else {
        sim_add_box(w, b, uniform(0.2, 0.5), uniform(0.2, 0.5), m);
    }
    return b;
}

static void random_joint(plumb_world *w, plumb_body a, plumb_body b)
{
    const plumb_vec2 at = plumb_body_center(w, a), to = plumb_body_center(w, b);
    plumb_joint_desc d = { .kind = (plumb_joint_kind)uniform(0, 11),
                           .body_a = a,
                           .body_b = b,
                           .anchor = at,
                           .anchor_b = to,
                           .ground_a = { at.x, at.y + 3 },
                           .ground_b = { to.x, to.y + 4 },
                           .axis = { 1, 0 },
                           .enable_limit = often(0.4),
                           .lower = -1,
                           .upper = 2,
                           .enable_motor = often(0.4),
                           .motor_speed = 3,
                           .max_motor = 20,
                           .hertz = often(0.5) ? (plumb_real)uniform(0.5, 6) : 0,
                           .damping = often(0.5) ? (plumb_real)uniform(0, 1) : 0,
                           .ratio = 2,
                           .pitch = 1,
                           .max_force = 30,
                           .max_torque = 30,
                           .event_force = often(0.3) ? 1 : 0 };
    sim_fit_joint(&d);
    d.lower = d.kind == PLUMB_DISTANCE ? 0 : d.lower;
    assert_false(plumb_is_null(plumb_joint_create(w, &d)));
}

// Pushes what a system of the substep may push.
static void push_about(const plumb_system_call *call)
{
    for (int i = 0; i < call->substep->count; ++i) {
        const uint32_t slot = call->substep->slot[i];
        call->substep->motions[slot].ax += 3;
        call->substep->motions[slot].aw -= 1;
    }
}

static plumb_world *random_world(uint32_t of, int threads)
{
    seed = of * 2654435761u + 17;
    const plumb_world_desc desc = random_settings(threads);
    plumb_world *w = sim_world(&desc);
    plumb_material m[3];
    for (int i = 0; i < 3; ++i) {
        m[i] = plumb_material_create(
            w, &(plumb_material_desc){
                   .friction = (plumb_real)uniform(0.1, 1),
                   .restitution = often(0.4) ? (plumb_real)uniform(0, 1) : 0,
                   .rolling_resistance = often(0.2) ? (plumb_real)uniform(0, 0.05) : 0,
                   .surface_speed = often(0.2) ? (plumb_real)uniform(-2, 2) : 0 });
    }
    sim_floor(w, m[0]);
    plumb_body lift = sim_body(w, PLUMB_KINEMATIC, 1, 0.2, 0.1);
    sim_add_box(w, lift, 1, 0.1, m[1]);
    plumb_body_set_velocity(w, lift, sim_vec(0.5, 0.3));
    const plumb_component pushed =
        plumb_component_create(w, &(plumb_component_desc){ .name = "pushed", .size = 1 });
    plumb_system_create(w, &(plumb_system_desc){ .name = "push about",
                                                 .phase = PLUMB_PHASE_SUBSTEP,
                                                 .run = push_about,
                                                 .needs = { pushed } });
    plumb_body b[BODIES];
    for (int i = 0; i < BODIES; ++i) {
        b[i] = random_body(w, i, m[(int)uniform(0, 3)]);
        if (often(0.1)) {
            plumb_component_set(w, b[i].entity, pushed, "");
        }
    }
    for (int i = 0; i < (int)uniform(0, 12); ++i) {
        const int k = (int)uniform(0, BODIES - 1);
        random_joint(w, b[k], b[k + 1]);
    }
    return w;
}

static void push_some(plumb_world *w, int step)
{
    const plumb_body_span s = plumb_world_bodies(w);
    for (int i = step % 3; i < s.dynamic_count; i += 5) {
        plumb_body_apply_force(w, s.body[i], sim_vec(3, 20), sim_vec(s.x[i], s.y[i]));
        plumb_body_apply_torque(w, s.body[i], 2);
    }
}

// What a step moved back and forth: what is left of it by rounding is measured against this.
static double scale_of(const plumb_measures *m)
{
    double scale = fabs(m->before) + 1;
    for (int i = 0; i < PLUMB_WORKS; ++i) {
        scale += fabs(m->work[i].kinetic) + fabs(m->work[i].potential);
    }
    return scale;
}

static void the_energy_of_a_step_adds_up(void **state)
{
    (void)state;
    double worst = 0, moved[PLUMB_WORKS] = { 0 };
    int burst = 0;
    for (uint32_t of = 0; of < 120; ++of) {
        plumb_world *w = random_world(of, 1 + (int)of % 3);
        for (int i = 0; i < 60; ++i) {
            push_some(w, i);
            const plumb_energy before = plumb_world_energy(w);
            sim_step(w, i % 20 == 7 ? DT / 3 : DT);
            const plumb_energy after = plumb_world_energy(w);
            const plumb_measures *m = plumb_world_measures(w);
            const double rest = fabs(total(m->work[PLUMB_WORK_REST])) / scale_of(m);
            if (m->after > BURST) { // what contradicts itself, joined by chance, may burst
                ++burst;
                break;
            }
            assert_int_equal(m->step, i + 1);
            assert_near(m->before, before.kinetic + before.potential + before.stored,
                        1e-9 * scale_of(m));
            assert_near(m->after, after.kinetic + after.potential + after.stored,
                        1e-9 * scale_of(m));
            // Joints against one another, solved together, may get impulses that are huge and cancel.
            const bool direct = plumb_world_settings(w).direct_joints;
            const double bound = direct ? 1e-3 : ROUNDED(1e-5);
            if (!(rest <= bound)) {
                print_error("world %u, step %d: %.3g of the energy unexplained\n", of, i, rest);
            }
            assert_true(rest <= bound);
            worst = fmax(worst, direct ? 0 : rest);
            for (int k = 0; k < PLUMB_WORKS; ++k) {
                moved[k] += fabs(m->work[k].kinetic) + fabs(m->work[k].potential);
            }
        }
        plumb_world_destroy(w);
    }
    print_message("unexplained at most: %.3g; %d worlds burst\n", worst, burst);
    assert_true(burst <= 2);
    for (int k = 0; k < PLUMB_WORKS; ++k) {
        print_message("  %-8s %.4g J\n", plumb_work_name((plumb_work)k), moved[k]);
    }
}

//---- nothing else changes ------------------------------------------------------------------------

// Bits of a run, measured or not; the last measures.
static uint64_t run(uint32_t of, int threads, bool measure, plumb_measures *last)
{
    plumb_world *w = random_world(of, threads);
    assert_int_equal(plumb_world_set_measure(w, measure), PLUMB_OK);
    for (int i = 0; i < 40; ++i) {
        push_some(w, i);
        sim_step(w, DT);
    }
    *last = *plumb_world_measures(w);
    const uint64_t hash = plumb_world_hash(w);
    plumb_world_destroy(w);
    return hash;
}

static void measuring_changes_no_bit_and_needs_no_threads(void **state)
{
    (void)state;
    for (uint32_t of = 200; of < 220; ++of) {
        plumb_measures none, one, three;
        const uint64_t hash = run(of, 1, false, &none);
        assert_true(run(of, 1, true, &one) == hash);
        assert_true(run(of, 3, true, &three) == hash);
        assert_int_equal(none.step, 0);
        assert_int_equal(one.step, 40);
        assert_memory_equal(&one, &three, sizeof one);
    }
}

static void a_world_that_is_taken_back_measures_the_same(void **state)
{
    (void)state;
    plumb_world *w = random_world(300, 1);
    sim_run(w, 20, DT);
    const size_t size = plumb_world_snapshot_size(w);
    void *image = malloc(size);
    assert_int_equal(plumb_world_save(w, image, size), PLUMB_OK);
    sim_run(w, 5, DT);
    const plumb_measures first = *plumb_world_measures(w);
    assert_int_equal(plumb_world_restore(w, image, size), PLUMB_OK);
    sim_run(w, 5, DT);
    const plumb_measures *again = plumb_world_measures(w);
    assert_memory_equal(&first, again, sizeof first);
    free(image);
    plumb_world_destroy(w);
}

// Watched for what rows write, a world measures as well.
static void a_watched_world_is_measured(void **state)
{
    (void)state;
    plumb_measures m[2];
    for (int i = 0; i < 2; ++i) {
        plumb_world *w = random_world(301, 2);
        assert_int_equal(plumb_world_watch(w, i == 0 ? PLUMB_WATCH_NOTHING : PLUMB_WATCH_WRITES),
                         PLUMB_OK);
        sim_run(w, 10, DT);
        m[i] = *plumb_world_measures(w);
        assert_int_equal(m[i].step, 10);
        plumb_world_destroy(w);
    }
    assert_memory_equal(&m[0], &m[1], sizeof m[0]);
}

//---- closed forms --------------------------------------------------------------------------------

static plumb_world *measured(plumb_world_desc desc)
{
    desc.measure = true;
    return sim_world(&desc);
}

// Adds up a kind of work over some steps.
static plumb_balance add_up(plumb_world *w, int steps, plumb_work of)
{
    plumb_balance sum = { 0 };
    for (int i = 0; i < steps; ++i) {
        sim_step(w, DT);
        sum.kinetic += work(w, of).kinetic;
        sum.potential += work(w, of).potential;
    }
    return sum;
}

// What falls freely gets what its height gives; a force does F s.
static void falling_and_pushing(void **state)
{
    (void)state;
    plumb_world *w = measured((plumb_world_desc){ 0 });
    plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .mass = 2 });
    plumb_balance fall = add_up(w, 60, PLUMB_WORK_GRAVITY);
    assert_near(fall.kinetic, 2 * SIM_G * SIM_G / 2, ROUNDED(1e-3));
    assert_near(total(fall), 0, ROUNDED(1e-3));
    plumb_world_set_gravity(w, sim_vec(0, 0));
    plumb_body_set_velocity(w, b, sim_vec(0, 0));
    plumb_body_apply_force_center(w, b, sim_vec(12, 0));
    sim_step(w, DT);
    assert_near(work(w, PLUMB_WORK_FORCES).kinetic, 12 * (6 * DT * DT / 2), ROUNDED(1e-6));
    plumb_world_destroy(w);
}

// A crate slides to rest: friction takes all of it, mu m g along its way, and nothing else does anything.
static void friction_takes_what_slides(void **state)
{
    (void)state;
    for (int classic = 0; classic < 2; ++classic) {
        plumb_world *w = measured(
            (plumb_world_desc){ .solver = classic ? PLUMB_SOLVER_PGS : PLUMB_SOLVER_SOFT });
        plumb_material wood = sim_material(w, 0.4, 0);
        sim_floor(w, wood);
        plumb_body b = sim_crate(w, 0, 0.25, 0.5, 0.25, wood);
        sim_run(w, 60, DT);
        sim_launch(w, b, 4, 0, 0);
        const double m = (double)plumb_body_mass(w, b), x = sim_x(w, b);
        plumb_balance sum = add_up(w, 120, PLUMB_WORK_FRICTION);
        const double way = sim_x(w, b) - x;
        print_message("%s: friction took %.6f J of %.6f, mu m g s is %.6f\n",
                      classic ? "pgs" : "soft", -sum.kinetic, m * 8, 0.4 * m * SIM_G * way);
        assert_near(sum.kinetic / (-m * 8), 1, 1e-3);
        assert_near(sum.kinetic / (-0.4 * m * SIM_G * way), 1, 0.02);
        assert_near(sum.potential, 0, 0);
        plumb_world_destroy(w);
    }
}

// A bounce of e keeps e^2, and gives what is more; a blow without restitution is the normal's.
static void blows_take_one_less_e_squared(void **state)
{
    (void)state;
    const double es[] = { 0, 0.5, 1, 1.5 };
    for (int i = 0; i < 4; ++i) {
        plumb_world *w = measured((plumb_world_desc){ .zero_gravity = true });
        plumb_material m = sim_material(w, 0, es[i]);
        plumb_body wall = sim_body(w, PLUMB_STATIC, 2, 0, 0);
        sim_add_box(w, wall, 0.5, 2, m);
        plumb_body b = sim_ball(w, 0, 0, 0.5, m);
        sim_launch(w, b, 3, 0, 0);
        const double start = plumb_world_energy(w).kinetic;
        plumb_balance normal = { 0 }, impacts = { 0 };
        for (int k = 0; k < 60; ++k) {
            sim_step(w, DT);
            normal.kinetic += work(w, PLUMB_WORK_NORMAL).kinetic;
            impacts.kinetic += work(w, PLUMB_WORK_IMPACTS).kinetic;
        }
        const double lost = es[i] > 0 ? impacts.kinetic : normal.kinetic;
        const double other = es[i] > 0 ? normal.kinetic : impacts.kinetic;
        assert_near(lost / start, es[i] * es[i] - 1, ROUNDED(1e-4));
        assert_near(other / start, 0, ROUNDED(1e-4));
        plumb_world_destroy(w);
    }
}

// A swinging mass: what the spring does is what it had stored; a motor's work is torque times angle.
static void springs_and_motors(void **state)
{
    (void)state;
    plumb_world *w = measured((plumb_world_desc){ .zero_gravity = true, .substeps = 32 });
    plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .mass = 2, .position = { 1.5, 0 } });
    plumb_joint_create(
        w,
        &(plumb_joint_desc){
            .kind = PLUMB_DISTANCE, .body_b = b, .anchor_b = { 1.5, 0 }, .length = 1, .hertz = 1 });
    const double stored = plumb_world_energy(w).stored;
    const plumb_balance spring = add_up(w, 15, PLUMB_WORK_SPRINGS); // a quarter of its period
    assert_near(spring.kinetic / stored, 1, 0.01);
    assert_near(spring.potential / stored, -1, 0.01);
    plumb_world_destroy(w);

    w = measured((plumb_world_desc){ .zero_gravity = true });
    plumb_body wheel = plumb_body_create(w, &(plumb_body_desc){ .mass = 1, .inertia = 2 });
    plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                               .body_b = wheel,
                                               .enable_motor = true,
                                               .motor_speed = 100,
                                               .max_motor = 6 });
    const plumb_balance motor = add_up(w, 30, PLUMB_WORK_MOTORS); // 3 rad/s^2 for half a second
    assert_near(motor.kinetic, 2 * 1.5 * 1.5 / 2, ROUNDED(1e-3));
    plumb_world_destroy(w);
}

//---- residuals -----------------------------------------------------------------------------------

// A stack at rest obeys but for the way that it sinks; a heavy box on a light one, and bodies that overlap, do not.
static void residuals_tell_what_is_not_solved(void **state)
{
    (void)state;
    double momentum = 0;
    plumb_world *w = measured((plumb_world_desc){ .no_sleep = true });
    plumb_material wood = sim_material(w, 0.5, 0);
    sim_floor(w, wood);
    sim_crate(w, 0, 0.5, 0.5, 0.5, wood);
    plumb_body top = sim_crate(w, 0, 1.5, 0.5, 0.5, wood);
    for (int i = 0; i < 240; ++i) {
        sim_step(w, DT);
        const plumb_measures *m = plumb_world_measures(w);
        momentum = fmax(momentum, m->momentum);
        assert_true(m->cone <= ROUNDED(1e-6) && m->complementarity >= 0);
    }
    const plumb_measures rest = *plumb_world_measures(w);
    print_message("two boxes: gap %.3g m, approach %.3g m/s, momentum %.3g N s\n", rest.gap,
                  rest.approach, momentum);
    assert_true(rest.gap > 1e-6 && rest.gap < 1e-3);
    assert_true(rest.approach < 1e-5);
    assert_true(momentum < ROUNDED(1e-4));
    plumb_body_teleport(w, top, sim_vec(0, 1.3), 0);
    sim_step(w, DT);
    assert_true(plumb_world_measures(w)->gap > 0.05);
    plumb_world_destroy(w);
}

static void joint_errors_are_lengths_and_angles(void **state)
{
    (void)state;
    plumb_world *w = measured((plumb_world_desc){ .zero_gravity = true, .substeps = 1 });
    plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .mass = 1, .inertia = 1 });
    plumb_joint weld =
        plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_WELD, .body_b = b });
    plumb_body_teleport(w, b, sim_vec(0.3, 0), (plumb_real)0.2);
    sim_step(w, (plumb_real)1e-6);
    const plumb_measures *m = plumb_world_measures(w);
    assert_near(m->joint_angle, 0.2, 0.2);
    assert_true(m->joint_length > 0.01 && m->joint_length <= 0.31);
    sim_run(w, 600, DT);
    assert_near(m->joint_length, 0, 1e-4);
    assert_near(m->joint_angle, 0, 1e-4);
    assert_near((double)plumb_joint_error(w, weld), hypot(m->joint_length, m->joint_angle), 1e-6);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_energy_of_a_step_adds_up),
        cmocka_unit_test(measuring_changes_no_bit_and_needs_no_threads),
        cmocka_unit_test(a_world_that_is_taken_back_measures_the_same),
        cmocka_unit_test(a_watched_world_is_measured),
        cmocka_unit_test(falling_and_pushing),
        cmocka_unit_test(friction_takes_what_slides),
        cmocka_unit_test(blows_take_one_less_e_squared),
        cmocka_unit_test(springs_and_motors),
        cmocka_unit_test(residuals_tell_what_is_not_solved),
        cmocka_unit_test(joint_errors_are_lengths_and_angles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
