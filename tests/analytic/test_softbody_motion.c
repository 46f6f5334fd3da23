// test_softbody_motion.c - soft bodies against closed forms: a spring and its order, 1,000 kg on a rope of 1 kg at four rates,
// a catenary and its order, a rope on a slope, gas at p A constant, jelly that flies with its momentum, a streamer in a wind.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

static void run(plumb_world *w, int steps, double hz)
{
    for (int i = 0; i < steps; ++i) {
        assert_int_equal(plumb_world_step(w, (plumb_real)(1 / hz)), PLUMB_OK);
    }
}

static double within(const char *what, double error, double bound)
{
    printf("%s: error %.3g, bound %.3g\n", what, error, bound);
    assert_true(fabs(error) <= bound);
    return fabs(error);
}

static plumb_softbody_state look(const plumb_world *w, plumb_softbody s)
{
    plumb_softbody_state state;
    assert_int_equal(plumb_softbody_measure(w, s, &state), PLUMB_OK);
    return state;
}

// 1 kg at 100 N/m: x = 1 + 0.1 cos 10 t.
static double spring_error(int substeps)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ .zero_gravity = true, .substeps = substeps });
    const plumb_softbody_node nodes[2] = { { .mass = 1 },
                                           { .position = sim_vec(1.1, 0), .mass = 1 } };
    const plumb_softbody_edge edge = { .b = 1, .length = 1, .stiffness = 100 };
    const plumb_softbody_pin pin = { .node = 0 };
    const plumb_softbody s = plumb_softbody_create(w, &(plumb_softbody_desc){ .nodes = nodes,
                                                                              .edges = &edge,
                                                                              .pins = &pin,
                                                                              .node_count = 2,
                                                                              .edge_count = 1,
                                                                              .pin_count = 1 });
    run(w, 60, 60);
    const double error = (double)look(w, s).center.x - 1 - 0.1 * cos(10);
    plumb_world_destroy(w);
    return error;
}

static void a_spring_swings_to_second_order(void **state)
{
    (void)state;
    const double coarse = spring_error(2), fine = spring_error(8);
    within("spring, 8 substeps", fine, 2.5e-5);
    within("its order, less 2", log2(coarse / fine) / 2 - 2, 0.1);
}

// Stiffness 1e6 N: it is longer by L (M + m / 2) g / 1e6, whatever the step.
static void a_rope_of_1_kg_carries_1000(void **state)
{
    (void)state;
    for (int hz = 30; hz <= 240; hz *= 2) {
        plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true });
        const plumb_body b = sim_body(w, PLUMB_DYNAMIC, 0, -2.5, 0);
        sim_add_box(w, b, 0.5, 0.5, (plumb_material)PLUMB_NULL_INIT);
        assert_int_equal(plumb_body_set_mass(w, b, 1000), PLUMB_OK);
        const plumb_softbody s =
            plumb_rope_create(w, &(plumb_rope_desc){ .to = { 0, -2 },
                                                     .mass = 1,
                                                     .stiffness = (plumb_real)1e6,
                                                     .damping = 20000,
                                                     .hold_from = true,
                                                     .to_body = b,
                                                     .radius = (plumb_real)0.01 });
        run(w, 4 * hz, hz);
        within("m that 1,000 kg hang too low",
               (double)plumb_body_position(w, b).y + 2.5 + 2 * 9.81 * 1000.5 / 1e6, 2e-5);
        within("N of the rope, over its load", (double)look(w, s).tension - 9.81 * 1001, 15);
        plumb_world_destroy(w);
    }
}

// 3 m between ends 2 m apart: sag a (cosh(1 / a) - 1), 2 a sinh(1 / a) = 3.
static double catenary_error(int nodes)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true });
    const plumb_softbody s = plumb_rope_create(w, &(plumb_rope_desc){ .from = { -1, 0 },
                                                                      .to = { 1, 0 },
                                                                      .length = 3,
                                                                      .nodes = nodes,
                                                                      .mass = 3,
                                                                      .stiffness = (plumb_real)1e8,
                                                                      .damping = 10000,
                                                                      .drag = 4,
                                                                      .hold_from = true,
                                                                      .hold_to = true });
    run(w, 900, 60);
    double low = 0.1, high = 10;
    for (int i = 0; i < 100; ++i) {
        const double a = (low + high) / 2;
        *(2 * a * sinh(1 / a) > 3 ? &low : &high) = a;
    }
    plumb_softbody_desc d;
    plumb_softbody_settings(w, s, &d);
    const double sag = -(double)d.nodes[nodes / 2].position.y;
    const double rest = (double)look(w, s).kinetic;
    plumb_world_destroy(w);
    assert_true(rest < 1e-8);
    return sag - low * (cosh(1 / low) - 1);
}

static void a_rope_hangs_as_a_catenary(void **state)
{
    (void)state;
    const double coarse = catenary_error(11), fine = catenary_error(41);
    within("m of its sag, 41 nodes", fine, 5e-4);
    within("its order in the length of a piece, less 2", log2(coarse / fine) / 2 - 2, 0.1);
}

// Friction 0.5 holds below atan 0.5 = 0.464; above, g t^2 / 2 (sin a - 0.5 cos a).
static void a_rope_slides_on_a_slope(void **state)
{
    (void)state;
    for (int k = 0; k < 2; ++k) {
        const double a = k == 0 ? -0.4 : -0.5, c = cos(a), s = sin(a);
        plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true });
        const plumb_body ground = sim_body(w, PLUMB_STATIC, 0, 0, a);
        sim_add_box(
            w, ground, 50, 0.5,
            plumb_material_create(w, &(plumb_material_desc){ .friction = (plumb_real)0.5 }));
        const plumb_vec2 from = sim_vec(-s * 0.55, c * 0.55);
        const plumb_softbody rope = plumb_rope_create(
            w, &(plumb_rope_desc){ .from = from,
                                   .nodes = 21,
                                   .mass = 1,
                                   .to = sim_vec((double)from.x + 2 * c, (double)from.y + 2 * s),
                                   .radius = (plumb_real)0.05 });
        const plumb_vec2 before = look(w, rope).center;
        run(w, 120, 60);
        const plumb_vec2 after = look(w, rope).center;
        const double way =
            hypot((double)after.x - (double)before.x, (double)after.y - (double)before.y);
        within("m down a slope", way - fmax(0, 2 * 9.81 * (-s - 0.5 * c)), 0.005);
        plumb_world_destroy(w);
    }
}

static void gas_keeps_p_a(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true });
    sim_add_box(w, sim_body(w, PLUMB_STATIC, 0, -1, 0), 10, 1, (plumb_material)PLUMB_NULL_INIT);
    const plumb_softbody s = plumb_skin_create(w, &(plumb_skin_desc){ .center = { 0, 2 },
                                                                      .radius = 1,
                                                                      .mass = 2,
                                                                      .pressure = 300,
                                                                      .stiffness = 2000,
                                                                      .damping = 20,
                                                                      .drag = 1 });
    const plumb_softbody_state first = look(w, s);
    run(w, 600, 60);
    const plumb_softbody_state last = look(w, s);
    assert_true(last.area > first.area);
    within("p A", (double)(last.area * last.pressure) / (double)(first.area * first.pressure) - 1,
           1e-5);
    // Over where it lies, half its width times the pressure is its weight; it stays above the ground.
    assert_true(last.center.y > 1 && last.center.y < (plumb_real)1.3);
    plumb_world_destroy(w);
}

// Sheared and turning, it keeps its momentum and its angular momentum, and comes to rest in its own frame.
static void jelly_keeps_its_momentum(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ .zero_gravity = true });
    const plumb_vec2 square[4] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    const plumb_softbody s = plumb_jelly_create(
        w, &(plumb_jelly_desc){ .points = square, .count = 4, .damping = (plumb_real)0.02 });
    plumb_softbody_desc d;
    plumb_softbody_settings(w, s, &d);
    for (int i = 0; i < d.node_count; ++i) {
        plumb_softbody_node n = d.nodes[i];
        n.velocity = sim_vec(3 * ((double)n.position.y - 0.5),
                             (double)n.position.x - 0.5 + (double)n.position.y);
        assert_int_equal(plumb_softbody_set_node(w, s, i, &n), PLUMB_OK);
    }
    const plumb_energy before = plumb_world_energy(w);
    run(w, 300, 60);
    const plumb_energy after = plumb_world_energy(w);
    within("N s", hypot(after.momentum_x - before.momentum_x, after.momentum_y - before.momentum_y),
           1e-5);
    within("N m s", after.angular_momentum - before.angular_momentum, 2e-3);
    within("J in a shape that it is back to", after.stored, 0.01);
    assert_true(after.kinetic < before.kinetic);
    plumb_world_destroy(w);
}

// 200 m/s against a wall of 1 cm.
static void fast_thread_does_not_tunnel(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true });
    sim_add_box(w, sim_body(w, PLUMB_STATIC, 5, 0, 0), 0.005, 10, (plumb_material)PLUMB_NULL_INIT);
    const plumb_softbody s = plumb_rope_create(
        w, &(plumb_rope_desc){ .from = sim_vec(0, -0.5), .to = sim_vec(0, 0.5), .nodes = 21 });
    plumb_softbody_desc d;
    plumb_softbody_settings(w, s, &d);
    for (int i = 0; i < d.node_count; ++i) {
        plumb_softbody_node n = d.nodes[i];
        n.velocity.x = 200;
        assert_int_equal(plumb_softbody_set_node(w, s, i, &n), PLUMB_OK);
    }
    for (int i = 0; i < 60; ++i) {
        run(w, 1, 60);
        plumb_softbody_settings(w, s, &d);
        for (int k = 0; k < d.node_count; ++k) {
            assert_true(d.nodes[k].position.x < (plumb_real)4.995);
        }
    }
    plumb_world_destroy(w);
}

// A streamer in an even wind of 4 m/s, held by a pole that stands, or in still air on one that moves against it with its volume:
// it hangs straight, at tan(angle) = drag U / g. One whose filter does not meet the wind hangs down.
static void a_streamer_hangs_as_the_wind_has_it(void **state)
{
    (void)state;
    for (int k = 0; k < 3; ++k) {
        plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true });
        const plumb_material air = plumb_material_create(
            w,
            &(plumb_material_desc){ .fluid = true, .weightless = true, .flow_x = k == 1 ? 1 : 4 });
        const plumb_body holder = sim_body(w, PLUMB_KINEMATIC, 0, 0, 0);
        plumb_body_set_velocity(w, holder, sim_vec(k == 1 ? 3 : 0, 0));
        plumb_shape_create(w, holder,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                .half = sim_vec(50, 50),
                                                .sensor = true,
                                                .material = air,
                                                .filter = { .category = 2, .mask = UINT64_MAX } });
        const plumb_softbody s = plumb_rope_create(
            w, &(plumb_rope_desc){ .from = sim_vec(0, 4),
                                   .to = sim_vec(0, 2),
                                   .nodes = 15,
                                   .mass = (plumb_real)0.1,
                                   .drag = 3,
                                   .hold_from = true,
                                   .filter = { .category = 1, .mask = k == 2 ? 1 : 3 } });
        run(w, 900, 60);
        plumb_softbody_desc d;
        plumb_softbody_settings(w, s, &d);
        const double tangent =
            (double)d.nodes[14].position.x / (4 - (double)d.nodes[14].position.y);
        within("streamer", tangent - (k == 2 ? 0 : 12 / 9.81), 2e-5);
        plumb_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_spring_swings_to_second_order),
        cmocka_unit_test(a_rope_of_1_kg_carries_1000),
        cmocka_unit_test(a_rope_hangs_as_a_catenary),
        cmocka_unit_test(a_rope_slides_on_a_slope),
        cmocka_unit_test(gas_keeps_p_a),
        cmocka_unit_test(jelly_keeps_its_momentum),
        cmocka_unit_test(fast_thread_does_not_tunnel),
        cmocka_unit_test(a_streamer_hangs_as_the_wind_has_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
