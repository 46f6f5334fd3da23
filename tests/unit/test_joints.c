// test_joints.c - rows of every kind of joint against finite differences of their errors, conserved
// momentum, impulses kept from step to step, slots and lists, breaking.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "harness/near.h"
#include "world/joint_list.h"
#include "joints/joint.h"
#include "harness/sim.h"
#include "plumb/math.h"
#include "world/state.h"

#define DT ((plumb_real)(1 / 60.0))

// A joint of the kind with all its parts switched on, between two bodies that are anywhere.
static plumb_joint_desc busy(plumb_joint_kind kind, unsigned *seed)
{
    unsigned has = pl_joint_classes[kind]->has;
    plumb_joint_desc d = { .kind = kind };
    d.anchor = sim_vec(sim_uniform(seed, -2, 2), sim_uniform(seed, -2, 2));
    d.anchor_b = sim_vec(sim_uniform(seed, -2, 2), sim_uniform(seed, -2, 2));
    d.ground_a = sim_vec(sim_uniform(seed, -2, 2), 6);
    d.ground_b = sim_vec(sim_uniform(seed, -2, 2), 7);
    if (kind == PLUMB_PRISMATIC || kind == PLUMB_WHEEL || (kind == PLUMB_GEAR && *seed % 2)) {
        d.axis = sim_vec(sim_uniform(seed, -1, 1), sim_uniform(seed, 1, 2));
    }
    d.ratio = kind == PLUMB_GEAR || kind == PLUMB_PULLEY ? (plumb_real)1.5 : 0;
    d.enable_limit = (has & PL_JOINT_LIMIT) != 0;
    d.enable_motor = (has & PL_JOINT_MOTOR) != 0;
    d.hertz = (plumb_real)(has & PL_JOINT_SPRING ? 2 : 0);
    d.lower = d.enable_limit ? (plumb_real)0.25 : 0;
    d.upper = d.enable_limit ? 4 : 0;
    d.pitch = kind == PLUMB_RATCHET ? (plumb_real)(*seed % 3 == 0 ? -0.3 : 0.3) : 0;
    d.radius_a =
        (plumb_real)(*seed % 2 == 0 ? 0.2 : -0.1); // where no line touches both rims it is refused
    d.radius_b = (plumb_real)(kind == PLUMB_CABLE ? 0.1 : 0);
    d.max_motor = 3;
    d.max_force = 10;
    d.max_torque = 10;
    sim_fit_joint(&d);
    return d;
}

// Pose `p` after the body has moved along coordinate k (x, y, angle) by e.
static pl_joint_pose nudged(pl_joint_pose p, int k, double e)
{
    if (k < 2) {
        *(k == 0 ? &p.x : &p.y) += (plumb_real)e;
        return p;
    }
    double c = cos(e), s = sin(e), rx = (double)p.rx, ry = (double)p.ry;
    double pc = (double)p.c, ps = (double)p.s;
    p.angle += e;
    p.rx = (plumb_real)(c * rx - s * ry);
    p.ry = (plumb_real)(s * rx + c * ry);
    p.c = (plumb_real)(c * pc - s * ps);
    p.s = (plumb_real)(s * pc + c * ps);
    return p;
}

// What J has besides the slope of C: a point's rows push half-way between the anchors. [m]
static double shift(const pl_rows *rows, int i, int k)
{
    bool point = rows->row[i].form == PL_FORM_POINT_X || rows->row[i].form == PL_FORM_POINT_Y;
    if (!point || (k != 2 && k != 5)) {
        return 0;
    }
    double ex = (double)rows->row[0].error, ey = (double)rows->row[1].error;
    return (rows->row[i].form == PL_FORM_POINT_X ? ey : -ex) / 2;
}

// [-] largest difference of a row's J from the central difference of its C.
static double jacobian_error(const pl_joint *j)
{
    const double e = SIM_TOLERANCE(2e-3, 1e-5);
    const pl_joint_class *kind = pl_joint_classes[j->desc.kind];
    const pl_joint_pose a = j->pose_a, b = j->pose_b;
    pl_rows rows, up, down;
    double worst = 0;
    kind->rows(j, &a, &b, &rows);
    for (int k = 0; k < 6; ++k) {
        pl_joint_pose a_up = k < 3 ? nudged(a, k, e) : a, a_down = k < 3 ? nudged(a, k, -e) : a;
        pl_joint_pose b_up = k < 3 ? b : nudged(b, k - 3, e);
        pl_joint_pose b_down = k < 3 ? b : nudged(b, k - 3, -e);
        kind->rows(j, &a_up, &b_up, &up);
        kind->rows(j, &a_down, &b_down, &down);
        for (int i = 0; i < rows.count; ++i) {
            const pl_row *r = &rows.row[i];
            const plumb_real jacobian[] = { r->ax, r->ay, r->aw, r->bx, r->by, r->bw };
            double slope = ((double)up.row[i].error - (double)down.row[i].error) / (2 * e);
            worst = fmax(worst, fabs(slope + shift(&rows, i, k) - (double)jacobian[k]));
        }
    }
    return worst;
}

static void jacobians_are_the_slopes_of_errors(void **state)
{
    (void)state;
    unsigned seed = 99;
    for (int kind = 0; kind < pl_joint_class_count; ++kind) {
        double worst = 0;
        for (int n = 0; n < 40; ++n) {
            plumb_world *w = sim_space();
            plumb_body a = sim_body(w, PLUMB_DYNAMIC, sim_uniform(&seed, -2, 2),
                                    sim_uniform(&seed, -2, 2), sim_uniform(&seed, -3, 3));
            plumb_body b = sim_body(w, PLUMB_DYNAMIC, sim_uniform(&seed, -2, 2),
                                    sim_uniform(&seed, -2, 2), sim_uniform(&seed, -3, 3));
            plumb_joint_desc d = busy((plumb_joint_kind)kind, &seed);
            d.body_a = a;
            d.body_b = b;
            plumb_joint handle = plumb_joint_create(w, &d);
            assert_false(plumb_is_null(handle));
            if (pl_joint_classes[kind]->has & PL_JOINT_TARGET) {
                plumb_joint_set_target(w, handle, sim_vec(0.5, -0.25));
            }
            // Away from where it was made, so that errors are not 0.
            plumb_body_teleport(w, b, sim_vec(sim_uniform(&seed, 3, 4), sim_uniform(&seed, -2, 2)),
                                (plumb_real)sim_uniform(&seed, -3, 3));
            pl_joint *j = &pl_joint_items(&w->joints)[pl_joint_slot(w, handle)];
            pl_joint_begin(w, j);
            // What a hinge is more than a radian beyond its limit it takes back as one.
            const double turn = (double)plumb_joint_value(w, handle);
            const bool is_far = kind == PLUMB_REVOLUTE &&
                                (turn < (double)d.lower - 1 || turn > (double)d.upper + 1);
            worst = is_far ? worst : fmax(worst, jacobian_error(j));
            plumb_world_destroy(w);
        }
        print_message("%-10s J off by %.2g at most\n", pl_joint_classes[kind]->name, worst);
        assert_true(worst < SIM_TOLERANCE(5e-3, 1e-7));
    }
}

// Two bodies tied to each other alone in space keep momentum and angular momentum.
static void joints_between_bodies_conserve_momentum(void **state)
{
    (void)state;
    unsigned seed = 7;
    for (int kind = 0; kind < pl_joint_class_count; ++kind) {
        if (kind == PLUMB_GEAR || kind == PLUMB_PULLEY) {
            continue; // held by the world
        }
        plumb_world *w = sim_space();
        plumb_body a = sim_crate(w, -1, 0, 0.5, 0.25, (plumb_material)PLUMB_NULL_INIT);
        plumb_body b = sim_crate(w, 1, 0.5, 0.25, 0.5, (plumb_material)PLUMB_NULL_INIT);
        plumb_joint_desc d = busy((plumb_joint_kind)kind, &seed);
        d.body_a = a;
        d.body_b = b;
        d.anchor = sim_vec(0, 0.25);
        d.anchor_b = sim_vec(1, 0.5);
        d.axis = d.axis.x != 0 ? sim_vec(1, 1) : sim_vec(0, 0);
        sim_fit_joint(&d);
        assert_false(plumb_is_null(plumb_joint_create(w, &d)));
        sim_launch(w, a, 1, 2, 1);
        sim_launch(w, b, -1, 0.5, -2);
        plumb_energy before = plumb_world_energy(w);
        sim_run(w, 120, 1 / 60.0);
        plumb_energy after = plumb_world_energy(w);
        double dp =
            hypot(after.momentum_x - before.momentum_x, after.momentum_y - before.momentum_y);
        double dl = fabs(after.angular_momentum - before.angular_momentum);
        print_message("%-10s momentum off by %.2g N s, angular by %.2g N m s\n",
                      pl_joint_classes[kind]->name, dp, dl);
        assert_true(dp < SIM_TOLERANCE(1e-4, 1e-12));
        assert_true(dl < SIM_TOLERANCE(1e-4, 1e-12));
        plumb_world_destroy(w);
    }
}

// Of a chain of ten: what one step moves the lowest link, with impulses kept and without.
static void impulses_are_kept_from_step_to_step(void **state)
{
    (void)state;
    enum { LINKS = 10 };
    plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true });
    plumb_body last = PLUMB_NULL_INIT;
    for (int i = 0; i < LINKS; ++i) {
        plumb_body link = sim_crate(w, 0, -i - 0.5, 0.125, 0.5, (plumb_material)PLUMB_NULL_INIT);
        plumb_joint_desc d = { .body_a = last, .body_b = link, .anchor = sim_vec(0, -i) };
        assert_false(plumb_is_null(plumb_joint_create(w, &d)));
        last = link;
    }
    sim_run(w, 1200, 1 / 60.0);
    pl_joint *joints = pl_joint_items(&w->joints);
    for (int i = 0; i < LINKS; ++i) {
        double pull = (LINKS - i) * 0.25 * SIM_G;
        assert_near((double)plumb_joint_force(w, joints[i].entity).y / pull, 1, ROUNDED(0.01));
    }
    double y = sim_y(w, last);
    plumb_world_step(w, DT);
    double kept = fabs(sim_y(w, last) - y);
    for (int i = 0; i < LINKS; ++i) {
        memset(joints[i].impulse, 0, sizeof joints[i].impulse);
    }
    y = sim_y(w, last);
    plumb_world_step(w, DT);
    double cold = fabs(sim_y(w, last) - y);
    print_message("chain of %d: a step moves the end by %.2g m, without impulses by %.2g m\n",
                  LINKS, kept, cold);
    assert_true(kept < 1e-5);
    assert_true(cold > 10 * kept && cold > 1e-4);
    plumb_world_destroy(w);
}

static void slots_are_used_again_and_lists_stay_whole(void **state)
{
    (void)state;
    enum { BODIES = 12, ROUNDS = 400 };
    unsigned seed = 3;
    plumb_world *w = sim_space();
    plumb_body bodies[BODIES];
    plumb_joint joints[64];
    int count = 0, most = 0;
    for (int i = 0; i < BODIES; ++i) {
        bodies[i] = sim_body(w, i % 3 == 0 ? PLUMB_STATIC : PLUMB_DYNAMIC, i, 0, 0);
    }
    for (int n = 0; n < ROUNDS; ++n) {
        if (count < 40 && sim_random(&seed) % 3 != 0) {
            unsigned a = sim_random(&seed) % BODIES, b = sim_random(&seed) % BODIES;
            plumb_joint_desc d = { .body_a = bodies[a], .body_b = bodies[b] };
            if (a != b) {
                joints[count++] = plumb_joint_create(w, &d);
                assert_true(plumb_joint_valid(w, joints[count - 1]));
            }
        } else if (count > 0 && sim_random(&seed) % 4 != 0) {
            unsigned i = sim_random(&seed) % (unsigned)count;
            assert_int_equal(plumb_joint_destroy(w, joints[i]), PLUMB_OK);
            joints[i] = joints[--count];
        } else {
            unsigned i = sim_random(&seed) % BODIES;
            int of_body = plumb_body_joints(w, bodies[i], NULL, 0);
            int before = plumb_world_joints(w, NULL, 0);
            plumb_body_destroy(w, bodies[i]);
            assert_int_equal(plumb_world_joints(w, NULL, 0), before - of_body);
            bodies[i] = sim_body(w, PLUMB_DYNAMIC, i, 0, 0);
            int left = 0;
            for (int k = 0; k < count; ++k) {
                if (plumb_joint_valid(w, joints[k])) {
                    joints[left++] = joints[k];
                }
            }
            count = left;
        }
        most = count > most ? count : most;
        int sum = 0;
        for (int i = 0; i < BODIES; ++i) {
            sum += plumb_body_joints(w, bodies[i], NULL, 0);
        }
        assert_int_equal(plumb_world_joints(w, NULL, 0), count);
        assert_int_equal(sum, 2 * count);
        assert_int_equal(w->joints.live, count);
    }
    assert_true(w->joints.count <= (uint32_t)most + 1);
    plumb_world_destroy(w);
}

static void overloaded_joints_break_with_an_event(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_body b = sim_crate(w, 0, 0, 0.5, 0.5, (plumb_material)PLUMB_NULL_INIT);
    int tag = 0;
    plumb_joint j = plumb_joint_create(
        w, &(plumb_joint_desc){
               .kind = PLUMB_WELD, .body_b = b, .break_force = 15, .user_data = &tag });
    int count = 0;
    sim_run(w, 60, 1 / 60.0);
    assert_null(plumb_world_joint_break_events(w, &count));
    assert_int_equal(count, 0);
    assert_true(plumb_joint_valid(w, j));
    double y = sim_y(w, b);
    for (int i = 0; i < 60 && count == 0; ++i) { // 9.81 N of weight and 10 N more
        plumb_body_apply_force_center(w, b, sim_vec(0, -10));
        sim_step(w, 1 / 60.0);
        plumb_world_joint_break_events(w, &count);
    }
    const plumb_joint_break *event = plumb_world_joint_break_events(w, &count);
    assert_int_equal(count, 1);
    assert_true(plumb_same(event->joint, j) && plumb_same(event->body_b, b));
    assert_true(plumb_is_null(event->body_a));
    assert_int_equal(event->kind, PLUMB_WELD);
    assert_ptr_equal(event->user_data, &tag);
    assert_true((double)event->force.y > 15);
    assert_false(plumb_joint_valid(w, j));
    sim_run(w, 60, 1 / 60.0);
    assert_null(plumb_world_joint_break_events(w, &count));
    assert_true(sim_y(w, b) < y - 3);
    // By torque: the arm is 1 m.
    b = sim_crate(w, 10, 0, 0.5, 0.5, (plumb_material)PLUMB_NULL_INIT);
    j = plumb_joint_create(
        w, &(plumb_joint_desc){
               .kind = PLUMB_WELD, .body_b = b, .anchor = { 9, 0 }, .break_torque = 5 });
    sim_run(w, 10, 1 / 60.0);
    assert_false(plumb_joint_valid(w, j));
    plumb_world_destroy(w);
}

// Tied bodies pass through one another unless told otherwise, also when the joint comes or goes
// later.
static void connected_bodies_do_not_collide(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_body a = sim_crate(w, 0, 0, 0.5, 0.5, (plumb_material)PLUMB_NULL_INIT);
    plumb_body b = sim_crate(w, 0.9, 0, 0.5, 0.5, (plumb_material)PLUMB_NULL_INIT);
    plumb_joint_desc d = { .body_a = a, .body_b = b };
    plumb_world_step(w, DT);
    assert_int_equal(plumb_world_contacts(w, NULL, 0), 1);
    plumb_joint j = plumb_joint_create(w, &d);
    plumb_world_step(w, DT);
    assert_int_equal(plumb_world_contacts(w, NULL, 0), 0);
    d.collide_connected = true;
    plumb_joint k = plumb_joint_create(w, &d);
    plumb_world_step(w, DT);
    assert_int_equal(plumb_world_contacts(w, NULL, 0), 0);
    plumb_joint_destroy(w, j);
    plumb_body_teleport(w, a, sim_vec(0, 0), 0);
    plumb_body_teleport(w, b, sim_vec(0.9, 0), 0);
    plumb_world_step(w, DT);
    assert_int_equal(plumb_world_contacts(w, NULL, 0), 1);
    plumb_joint_destroy(w, k);
    plumb_world_destroy(w);
}

// Nothing that cannot move is moved, and nothing becomes no number.
static void immovable_ends_are_harmless(void **state)
{
    (void)state;
    for (int kind = 0; kind < pl_joint_class_count; ++kind) {
        unsigned seed = 5;
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        plumb_body b = plumb_body_create(
            w, &(plumb_body_desc){ .fixed_rotation = true, .position = { 1, 1 } });
        plumb_body k = sim_body(w, PLUMB_KINEMATIC, 3, 0, 0),
                   s = sim_body(w, PLUMB_STATIC, 0, 0, 0);
        plumb_joint_desc d = busy((plumb_joint_kind)kind, &seed);
        const plumb_body ends[][2] = { { k, s }, { k, b }, { s, b }, { b, PLUMB_NULL_INIT } };
        for (int i = 0; i < 4; ++i) {
            d.body_a = ends[i][0];
            d.body_b = ends[i][1];
            assert_false(plumb_is_null(plumb_joint_create(w, &d)));
        }
        plumb_body_set_velocity(w, k, sim_vec(1, 0));
        sim_run(w, 60, 1 / 60.0);
        assert_true(isfinite(sim_x(w, b)) && isfinite(sim_y(w, b)));
        assert_near(sim_angle(w, b), 0, 0);
        assert_true(fabs(sim_x(w, k) - 4) < 1e-4 && fabs(sim_y(w, k)) <= 0);
        assert_near(sim_x(w, s), 0, 0);
        plumb_world_destroy(w);
    }
}

// What lay on the stack before: every byte of a NaN.
static __attribute__((noinline)) void leave_nans_on_the_stack(void)
{
    volatile unsigned char left[1 << 14];
    for (size_t i = 0; i < sizeof left; ++i) {
        left[i] = 0xff;
    }
}

// Reactions of locked bodies come from rows made for them alone, of which those of parts that are switched
// off are not filled in.
static void reactions_of_locked_bodies_are_told(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_body b = sim_crate(w, 0, 0, 0.5, 0.5, (plumb_material)PLUMB_NULL_INIT);
    assert_int_equal(plumb_body_set_locks(w, b, (plumb_axis_locks){ .x = true }), PLUMB_OK);
    plumb_joint j = plumb_joint_create(w, &(plumb_joint_desc){ .body_b = b, .break_torque = 1 });
    for (int i = 0; i < 60; ++i) {
        leave_nans_on_the_stack();
        assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
        const plumb_vec2 force = plumb_joint_force(w, j);
        assert_true(fabs((double)force.x) < 1e-6 && isfinite((double)force.y));
        assert_near((double)plumb_joint_torque(w, j), 0, ROUNDED(1e-3));
    }
    const double weight = SIM_G * (double)plumb_body_mass(w, b);
    assert_near((double)plumb_joint_force(w, j).y, weight, 1e-3 * weight);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jacobians_are_the_slopes_of_errors),
        cmocka_unit_test(joints_between_bodies_conserve_momentum),
        cmocka_unit_test(impulses_are_kept_from_step_to_step),
        cmocka_unit_test(slots_are_used_again_and_lists_stay_whole),
        cmocka_unit_test(overloaded_joints_break_with_an_event),
        cmocka_unit_test(connected_bodies_do_not_collide),
        cmocka_unit_test(immovable_ends_are_harmless),
        cmocka_unit_test(reactions_of_locked_bodies_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
