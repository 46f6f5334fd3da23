// test_joint_plan.c - joints solved several at a time: who shares a bundle, when a plan is kept, that
// widths give the same bits, and lanes what one by one gives.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "world/joint_list.h"
#include "joints/wide.h"
#include "joints/joint.h"
#include "harness/sim.h"
#include "plumb/math.h"
#include "world/state.h"

#define DT ((plumb_real)(1 / 60.0))

static const plumb_material none = PLUMB_NULL_INIT;

// A descriptor with parts switched on by the bits of `parts` where the kind has them.
static plumb_joint_desc desc_of(plumb_joint_kind kind, unsigned parts, double x, double y)
{
    unsigned has = pl_joint_classes[kind]->has;
    plumb_joint_desc d = { .kind = kind, .anchor = sim_vec(x, y), .anchor_b = sim_vec(x + 1, y) };
    d.ground_a = sim_vec(x, y + 4);
    d.ground_b = sim_vec(x + 1, y + 4);
    d.enable_limit = (has & PL_JOINT_LIMIT) != 0 && (parts & 1) != 0;
    d.upper = d.enable_limit ? (plumb_real)0.5 : 0;
    d.enable_motor = (has & PL_JOINT_MOTOR) != 0 && (parts & 2) != 0;
    d.motor_speed = 1;
    d.max_motor = 2;
    d.hertz = (plumb_real)((has & PL_JOINT_SPRING) != 0 && (parts & 4) != 0 ? 3 : 0);
    d.damping = (plumb_real)0.2;
    d.max_force = (plumb_real)(parts & 8 ? 4 : 0);
    d.max_torque = 3;
    d.break_force = (plumb_real)(parts & 16 ? 1e6 : 0);
    d.pitch = kind == PLUMB_RATCHET ? (plumb_real)0.3 : 0;
    sim_fit_joint(&d);
    return d;
}

static plumb_joint add(plumb_world *w, plumb_joint_desc d, plumb_body a, plumb_body b)
{
    d.body_a = a;
    d.body_b = b;
    plumb_joint j = plumb_joint_create(w, &d);
    assert_false(plumb_is_null(j));
    return j;
}

// Chains of every kind in every outfit over a floor, a net of hinges, and a hub with more joints than
// there are colours.
static plumb_world *zoo(int width)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ .simd_width = width });
    sim_floor(w, none);
    for (int kind = 0; kind < pl_joint_class_count; ++kind) {
        for (unsigned parts = 0; parts < 16; ++parts) {
            double x = 3 * kind, y = 2 + 3.0 * parts;
            plumb_body a = parts % 3 == 0 ? (plumb_body)PLUMB_NULL_INIT
                                          : sim_crate(w, x - 0.5, y, 0.4, 0.2, none);
            plumb_body b = sim_crate(w, x + 0.5, y, 0.4, 0.2, none);
            add(w, desc_of((plumb_joint_kind)kind, parts, x, y), a, b);
        }
    }
    plumb_body hub = sim_crate(w, -10, 5, 0.5, 0.5, none);
    for (int i = 0; i < 70; ++i) {
        plumb_body rod = sim_crate(w, -10 + 0.01 * i, 5.6, 0.05, 0.4, none);
        add(w, desc_of(PLUMB_REVOLUTE, 0, -10 + 0.01 * i, 5.3), hub, rod);
    }
    return w;
}

static uint64_t bits_of(const plumb_world *w)
{
    uint64_t hash = UINT64_C(14695981039346656037);
    const pl_bodies *b = &w->bodies;
    for (uint32_t row = 0; row < w->dynamic_count; ++row) {
        const plumb_real values[] = { b->center_x[row], b->center_y[row], b->c[row],
                                      b->s[row],        b->vx[row],       b->w[row] };
        unsigned char bytes[sizeof values];
        memcpy(bytes, values, sizeof values);
        for (size_t i = 0; i < sizeof bytes; ++i) {
            hash = (hash ^ bytes[i]) * UINT64_C(1099511628211);
        }
    }
    return hash;
}

// Joints that are solved one by one.
static uint32_t alone_count(const plumb_world *w)
{
    uint32_t count = 0;
    for (uint32_t g = 0; g < w->joints.plan.group_count; ++g) {
        const pl_joint_group *group = &pl_joint_groups(&w->joints)[g];
        count += group->end - group->alone;
    }
    return count;
}

static void widths_give_the_same_bits(void **state)
{
    (void)state;
    uint64_t expected = 0;
    for (int width = 4; width <= 16; width *= 2) {
        plumb_world *w = zoo(width);
        for (int i = 0; i < 90; ++i) {
            plumb_joint j = pl_joint_items(&w->joints)[i].entity;
            if (i % 10 == 5) {
                plumb_joint_destroy(w, j);
            } else if (i % 10 == 7 && plumb_joint_get_kind(w, j) == PLUMB_REVOLUTE) {
                plumb_joint_set_motor(w, j, i % 20 == 7, 2, 1);
            }
            assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
        }
        uint64_t bits = bits_of(w);
        assert_true(w->joints.plan.bundle_count > 0 && alone_count(w) > 30);
        assert_true(width == 4 || bits == expected);
        expected = bits;
        plumb_world_destroy(w);
    }
}

// Springs in newtons of each kind between crates that turn, beside their centres. Breaking by impulse makes a joint one
// that is solved by itself.
static plumb_world *stiff_zoo(int width, bool alone)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ .simd_width = width });
    for (int i = 0; i < 60; ++i) {
        plumb_joint_desc d = { .kind = (plumb_joint_kind)(i % 7),
                               .anchor = sim_vec(3 * i, 0.3),
                               .stiffness = (plumb_real)(5 + 3 * i),
                               .damper = (plumb_real)(i % 3),
                               .break_impulse = alone ? (plumb_real)1e6 : 0 };
        d.anchor_b = sim_vec(d.kind == PLUMB_DISTANCE ? 3 * i + 1.2 : 0,
                             d.kind == PLUMB_DISTANCE ? -0.3 : 0);
        plumb_body a = sim_crate(w, 3 * i - 0.5, 0, 0.4, 0.2, none);
        plumb_body b = sim_crate(w, 3 * i + 0.5, 0, 0.4, 0.2, none);
        sim_launch(w, a, 0.3, 1, 2);
        add(w, d, a, b);
    }
    return w;
}

static void springs_in_newtons_are_the_same_in_lanes_and_alone(void **state)
{
    (void)state;
    plumb_world *w[] = { stiff_zoo(4, false), stiff_zoo(8, false), stiff_zoo(16, false),
                         stiff_zoo(4, true) };
    for (int i = 0; i < 60; ++i) {
        for (int k = 0; k < 4; ++k) {
            assert_int_equal(plumb_world_step(w[k], DT), PLUMB_OK);
        }
    }
    assert_true(bits_of(w[0]) == bits_of(w[1]) && bits_of(w[0]) == bits_of(w[2]));
    assert_true(alone_count(w[0]) < 30 && alone_count(w[3]) == 60); // mice and motors
    double apart = 0;
    for (uint32_t row = 0; row < w[0]->dynamic_count; ++row) {
        apart =
            fmax(apart, fabs((double)(w[0]->bodies.center_y[row] - w[3]->bodies.center_y[row])));
    }
    assert_true(apart < SIM_TOLERANCE(1e-4, 1e-11));
    for (int k = 0; k < 4; ++k) {
        plumb_world_destroy(w[k]);
    }
}

static void bundles_share_no_body_and_leave_no_joint_out(void **state)
{
    (void)state;
    plumb_world *w = zoo(8);
    plumb_world_step(w, DT);
    const pl_joint_plan *plan = &w->joints.plan;
    const pl_joint_lane *lanes = plan->lanes.data;
    const uint32_t width = (uint32_t)pl_joint_kernels_of(w)->width;
    uint32_t seen = alone_count(w);
    for (uint32_t k = 0; k < plan->bundle_count; ++k) {
        uint32_t rows[32], count = 0;
        for (uint32_t i = 0; i < width; ++i) {
            if (lanes[k * width + i].joint == PL_NONE) {
                continue;
            }
            const pl_joint_mark *mark = &pl_joint_marks(&w->joints)[lanes[k * width + i].joint];
            assert_true(pl_joint_is_wide(mark));
            rows[count++] = mark->row_a;
            rows[count++] = mark->row_b;
            ++seen;
        }
        for (uint32_t i = 0; i < count; ++i) {
            for (uint32_t m = 0; m < i; ++m) {
                assert_true(rows[i] != rows[m] || rows[i] >= w->dynamic_count);
            }
        }
    }
    assert_int_equal(seen, w->joints.live);
    plumb_world_destroy(w);
}

static void a_plan_is_kept_until_something_changes(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_body a = sim_crate(w, 0, 0, 0.5, 0.5, none), b = sim_crate(w, 2, 0, 0.5, 0.5, none);
    plumb_joint j = add(w, desc_of(PLUMB_REVOLUTE, 3, 1, 0), a, b);
    const pl_joint_plan *plan = &w->joints.plan;
    plumb_world_step(w, DT);
    assert_true(plan->made);
    plumb_joint_set_motor(w, j, true, 5, 3);
    plumb_joint_set_limit(w, j, true, -1, 1);
    assert_true(plan->made); // other numbers, the same rows
    for (int change = 0; change < 6; ++change) {
        switch (change) {
        case 0:
            plumb_joint_set_motor(w, j, false, 0, 0);
            break;
        case 1:
            plumb_joint_set_limit(w, j, false, 0, 0);
            break;
        case 2:
            plumb_joint_set_spring(w, j, 2, 1, 0);
            break;
        case 3:
            plumb_joint_set_break(w, j, 1e6, 0);
            break;
        case 4:
            add(w, desc_of(PLUMB_WELD, 0, 1, 0), a, b);
            break;
        default:
            plumb_joint_destroy(w, j);
            break;
        }
        assert_false(plan->made);
        plumb_world_step(w, DT);
        assert_true(plan->made);
    }
    assert_int_equal(plan->bundle_count, 1);
    plumb_world_destroy(w);
}

// Joints that came and went leave no trace.
static void a_plan_does_not_depend_on_the_past(void **state)
{
    (void)state;
    plumb_world *plain = zoo(8), *busy = zoo(8);
    plumb_body extra = sim_crate(busy, -20, 5, 0.5, 0.5, none);
    plumb_joint j = add(busy, desc_of(PLUMB_REVOLUTE, 0, -20, 5), (plumb_body){ 0 }, extra);
    plumb_world_step(plain, DT);
    plumb_world_step(busy, DT);
    plumb_joint_destroy(busy, j);
    plumb_body_destroy(busy, extra);
    for (int i = 0; i < 30; ++i) {
        plumb_world_step(plain, DT);
        plumb_world_step(busy, DT);
    }
    assert_true(bits_of(plain) == bits_of(busy));
    plumb_world_destroy(plain);
    plumb_world_destroy(busy);
}

// Gears, pulleys and cables have rows of their own form; springs of motor joints beside centres are blocks in newtons; wheels that
// slide freely are solved together.
static bool goes_in_lanes(plumb_joint_kind kind, unsigned parts)
{
    const bool limit = (parts & 1) != 0, spring = (parts & 4) != 0;
    return kind != PLUMB_GEAR && kind != PLUMB_PULLEY && kind != PLUMB_CABLE &&
           !(kind == PLUMB_MOTOR && spring) && !(kind == PLUMB_WHEEL && !limit && !spring);
}

// Two crates tied together fly and spin; `crowded`: so many patterns are there before that this one
// is solved by itself. Returns where the second one is.
static plumb_vec2 swing(plumb_joint_kind kind, unsigned parts, bool crowded)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_body s = sim_body(w, PLUMB_STATIC, 50, 0, 0), t = sim_body(w, PLUMB_STATIC, 51, 0, 0);
    // Each has a limit, a motor, a spring, and may break, or not: 16 patterns of each of two other kinds.
    static const plumb_joint_kind fillers[] = { PLUMB_REVOLUTE, PLUMB_PRISMATIC, PLUMB_WHEEL };
    for (unsigned i = 0; crowded && i < 16 * 3; ++i) {
        if (fillers[i / 16] != kind) {
            add(w, desc_of(fillers[i / 16], (i & 7u) | (i & 8u) << 1, 50, 0), s, t);
        }
    }
    plumb_body a = sim_crate(w, 0.5, 0, 0.4, 0.2, none), b = sim_crate(w, 1.5, 0.2, 0.4, 0.2, none);
    plumb_joint hook = add(w, desc_of(kind, parts, 1, 0), a, b);
    sim_launch(w, a, 1, 2, 1);
    sim_launch(w, b, -1, 0.5, -2);
    if (pl_joint_classes[kind]->has & PL_JOINT_TARGET) {
        plumb_joint_set_target(w, hook, sim_vec(0.8, 0.4));
    }
    for (int i = 0; i < 30; ++i) {
        plumb_world_step(w, DT);
    }
    const pl_joint_mark *mark = &pl_joint_marks(&w->joints)[pl_joint_slot(w, hook)];
    assert_true(pl_joint_is_wide(mark) == (!crowded && goes_in_lanes(kind, parts)));
    plumb_vec2 place = plumb_body_center(w, b);
    plumb_vec2 force = plumb_joint_force(w, hook);
    plumb_world_destroy(w);
    return plumb_v2(place.x + force.x / 1000, place.y + force.y / 1000);
}

static void lanes_do_what_one_by_one_does(void **state)
{
    (void)state;
    double worst = 0;
    for (int kind = 0; kind < pl_joint_class_count; ++kind) {
        for (unsigned parts = 0; parts < 16; ++parts) {
            plumb_vec2 wide = swing((plumb_joint_kind)kind, parts, false);
            plumb_vec2 alone = swing((plumb_joint_kind)kind, parts, true);
            double off = (double)plumb_vec2_distance(wide, alone);
            if (kind == PLUMB_RATCHET) { // a pawl on its tooth: the last bit says if it is apart
                assert_true(off < 1e-3);
                continue;
            }
            if (!(off < SIM_TOLERANCE(1e-4, 1e-10))) {
                print_error("%s, parts %u: off by %g\n", pl_joint_classes[kind]->name, parts, off);
            }
            worst = fmax(worst, off);
        }
    }
    print_message("lanes and one by one: off by %.2g at most\n", worst);
    assert_true(worst < SIM_TOLERANCE(1e-4, 1e-10));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(widths_give_the_same_bits),
        cmocka_unit_test(springs_in_newtons_are_the_same_in_lanes_and_alone),
        cmocka_unit_test(bundles_share_no_body_and_leave_no_joint_out),
        cmocka_unit_test(a_plan_is_kept_until_something_changes),
        cmocka_unit_test(a_plan_does_not_depend_on_the_past),
        cmocka_unit_test(lanes_do_what_one_by_one_does),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
