// test_internal_edges_shapes.c - ground made of many pieces: what stands out of it stops, ends and bends are followed,
// tiles of different kinds take turns, and events and systems see every one of them.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "harness/near.h"
#include "internal_edges_ground.h"

//---- what stands out ---------------------------------------------------------------------------------

static plumb_world *floor_of_tiles(plumb_material *m, double friction)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    *m = sim_material(w, friction, 0);
    for (int i = 0; i < 40; ++i) {
        tile(w, i * 0.5, -0.25, 0.25, 0.25, 0, *m);
    }
    return w;
}

// A tile that is 1 cm higher stops a box at every speed; one that is 0.5 mm higher does not.
static void steps_stop(void **state)
{
    (void)state;
    const double speeds[] = { 1, 5, 20, 100 }, rises[] = { 5e-4, 0.01, 0.1 };
    for (int r0 = 0; r0 < 3; ++r0) {
        for (int k = 0; k < 4; ++k) {
            plumb_material m;
            plumb_world *w = floor_of_tiles(&m, 0);
            tile(w, 10, rises[r0] - 0.25, 0.25, 0.25, 0, m); // in the place of one that lies lower
            plumb_body b = make_body(w, BOX, 6, 0, m);
            sim_run(w, 60, HZ60);
            sim_launch(w, b, speeds[k], 0, 0);
            double slowest = speeds[k];
            for (int i = 0; i < 60 * 4 && sim_x(w, b) < 12; ++i) {
                sim_step(w, HZ60);
                slowest = fmin(slowest, sim_vx(w, b));
            }
            print_message("a step of %4.1f mm at %3.0f m/s leaves %.4f of the speed\n",
                          rises[r0] * 1e3, speeds[k], slowest / speeds[k]);
            assert_true(rises[r0] < 1e-3 ? slowest > 0.99 * speeds[k] : slowest < 0.7 * speeds[k]);
            plumb_world_destroy(w);
        }
    }
}

static void walls_stop(void **state)
{
    (void)state;
    const double speeds[] = { 1, 20, 100, 500 };
    for (int body = 0; body < BODY_KINDS; ++body) {
        for (int k = 0; k < 4; ++k) {
            plumb_material m;
            plumb_world *w = floor_of_tiles(&m, 0);
            for (int i = 0; i < 6; ++i) { // on the floor, whose tiles go on below it
                tile(w, 12, 0.25 + 0.5 * i, 0.25, 0.25, 0, m);
            }
            plumb_body b = make_body(w, (body_kind)body, 5, 0, m);
            sim_run(w, 60, HZ60);
            sim_launch(w, b, speeds[k], 0, 0);
            for (int i = 0; i < 60 * 8; ++i) {
                sim_step(w, HZ60);
                assert_true(sim_x(w, b) < 11.75 ||
                            sim_y(w, b) > 3); // a triangle may be thrown over it
            }
            double reach = sim_x(w, b), off = sim_y(w, b) - height_of((body_kind)body);
            if (body == TRIANGLE) { // struck at its foot it tips over
                plumb_world_destroy(w);
                continue;
            }
            print_message("%-9s at %3.0f m/s comes to x = %.4f, lifted by %.1e m\n",
                          body_names[body], speeds[k], reach, off);
            assert_true(reach < 11.75 - 0.2 && fabs(sim_vx(w, b)) < 0.01 && fabs(off) < 5e-3);
            plumb_world_destroy(w);
        }
    }
}

// Off the end of a row, and through a gap that is wide enough.
static void ends_and_gaps_let_fall(void **state)
{
    (void)state;
    for (int gap = 0; gap < 2; ++gap) {
        plumb_material m;
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        m = sim_material(w, 0, 0);
        for (int i = 0; i < 12; ++i) {
            if (!gap || i != 8) {
                tile(w, i * 0.5, -0.25, 0.25, 0.25, 0, m);
            }
        }
        plumb_body b = sim_ball(w, 1, 0.1, 0.1, m);
        sim_launch(w, b, 1, 0, 0);
        sim_run(w, gap ? 260 : 400, HZ60);
        assert_true(sim_y(w, b) < -0.2);
        plumb_world_destroy(w);
    }
}

// A chain that bends up, and one that bends down: bodies follow it and do not get into it.
static void bends_are_followed(void **state)
{
    (void)state;
    const double speeds[] = { 1, 5, 20, 60 }, bends[] = { 20, 5, -5, -20 };
    for (int body = 0; body < BODY_KINDS; ++body) {
        for (int c = 0; c < 4; ++c) {
            for (int k = 0; k < 4; ++k) {
                plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
                plumb_material m = sim_material(w, 0, 0);
                plumb_vec2 p[62];
                double slope = tan(bends[c] * SIM_PI / 180);
                for (int i = 0; i < 62; ++i) {
                    p[i] = sim_vec(i, i < 10 ? 0 : slope * (i - 10));
                }
                plumb_shape_desc desc = {
                    .kind = PLUMB_CHAIN, .points = p, .count = 62, .material = m
                };
                plumb_shape_create(w, sim_body(w, PLUMB_STATIC, 0, 0, 0), &desc);
                plumb_body b = make_body(w, (body_kind)body, 5, 0, m);
                sim_run(w, 30, HZ60);
                sim_launch(w, b, speeds[k], 0, 0);
                double deepest = 0;
                for (int i = 0; i < 600 && sim_x(w, b) < 50 && sim_x(w, b) > 1; ++i) {
                    sim_step(w, HZ60);
                    double depth = (double)plumb_world_stats(w).max_penetration;
                    deepest = depth <= deepest ? deepest : depth;
                    double ground = sim_x(w, b) < 10 ? 0 : slope * (sim_x(w, b) - 10);
                    assert_true(sim_y(w, b) > ground);
                }
                print_message("%-9s bend %3.0f at %2.0f m/s: %.1e m deep\n", body_names[body],
                              bends[c], speeds[k], deepest);
                assert_true(deepest <
                            0.025); // 0.022 of a box at 60 m/s in the far build, else 0.0075
                plumb_world_destroy(w);
            }
        }
    }
}

//---- tiles of different kinds ------------------------------------------------------------------------

// Neighbours of different friction have a contact each: the support goes from one to the other.
static void rough_and_smooth_tiles_take_turns(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_material smooth = sim_material(w, 0, 0), also = sim_material(w, 0, 0);
    for (int i = 0; i < 200; ++i) {
        tile(w, i * 0.5, -0.25, 0.25, 0.25, 0, i % 2 == 0 ? smooth : also);
    }
    plumb_body b = make_body(w, BOX, 2, 0, smooth);
    sim_run(w, 120, HZ60);
    sim_launch(w, b, 20, 0, 0);
    double worst = 0;
    for (int i = 0; i < 240; ++i) {
        sim_step(w, HZ60);
        worst = fmax(worst, fmax(fabs(sim_vy(w, b)), fabs(sim_w(w, b))));
    }
    print_message("tiles of two materials at 20 m/s: %.1e of the speed\n", worst / 20);
    assert_true(worst / 20 < 1e-3 && fabs(sim_vx(w, b) - 20) < 1e-3);
    plumb_world_destroy(w);
}

// Events tell the tiles that are touched, whichever bears the load.
static void every_tile_is_told(void **state)
{
    (void)state;
    plumb_material m;
    plumb_world *w = floor_of_tiles(&m, 0);
    plumb_body b = make_body(w, BOX, 2, 0, m);
    sim_run(w, 60, HZ60);
    sim_launch(w, b, 4, 0, 0);
    int begun = 0, ended = 0;
    plumb_contact contacts[8];
    double h = HZ60 / plumb_world_settings(w).substeps;
    double weight = (double)plumb_body_mass(w, b) * SIM_G;
    for (int i = 0; i < 120; ++i) {
        sim_step(w, HZ60);
        int count;
        plumb_world_begin_events(w, &count);
        begun += count;
        plumb_world_end_events(w, &count);
        ended += count;
        count = plumb_body_contacts(w, b, contacts, 8);
        double force = 0;
        for (int k = 0; k < count; ++k) {
            for (int j = 0; j < contacts[k].point_count; ++j) {
                force += (double)contacts[k].points[j].normal_impulse / h;
            }
        }
        assert_true(count >= 2 && count <= 4);
        assert_near(force / weight, 1, ROUNDED(1e-3));
    }
    print_message("8 m: %d tiles begun, %d ended\n", begun, ended);
    assert_true(begun == 16 && ended == 16);
    plumb_world_destroy(w);
}

static void count_edits(const plumb_system_call *call)
{
    *(int *)call->context = plumb_contact_edit_count(call->world);
}

// A system that looks at contacts sees one for each tile, so that it can change any of them.
static void systems_see_every_tile(void **state)
{
    (void)state;
    plumb_material m;
    plumb_world *w = floor_of_tiles(&m, 0);
    make_body(w, BOX, 2, 0, m);
    sim_run(w, 60, HZ60);
    int seen = 0;
    plumb_system_desc desc = {
        .name = "count", .phase = PLUMB_PHASE_CONTACTS, .run = count_edits, .context = &seen
    };
    assert_int_equal(plumb_system_create(w, &desc), PLUMB_OK);
    sim_step(w, HZ60);
    assert_int_equal(seen, 3);
    plumb_world_destroy(w);
}

// Two thin plates end to end, and a slat that has a corner deep in them, down to where a sweep of
// src/continuous lets it go (seven tenths of the half widths): farther than a plate is thick, it sticks
// out below. It lies on the plates in the end, wherever the internal edge is. Returns how deep, in metres.
static double rest_depth(int solver, double thickness, double share, double angle, double beside)
{
    const double hx = 0.1, hy = 0.02;
    plumb_world *w = sim_world(&(plumb_world_desc){ .solver = (plumb_solver)solver });
    plumb_material m = sim_material(w, 0.3, 0);
    plumb_body ground = sim_body(w, PLUMB_STATIC, 0, 0, 0);
    for (int side = -1; side <= 1; side += 2) {
        add_box_at(w, ground, 5 * side, -thickness / 2, 5, thickness / 2, m);
    }
    double depth = share * (thickness / 2 + hy), c = cos(angle), s = sin(angle);
    plumb_body b =
        sim_body(w, PLUMB_DYNAMIC, beside + c * hx - s * hy, s * hx + c * hy - depth, angle);
    sim_add_box(w, b, hx, hy, m);
    sim_run(w, 120, HZ60);
    double lowest = INFINITY;
    for (int k = 0; k < 4; ++k) {
        plumb_vec2 corner = sim_vec(k % 2 ? hx : -hx, k / 2 ? hy : -hy);
        lowest = fmin(lowest, (double)plumb_body_world_point(w, b, corner).y);
    }
    plumb_world_destroy(w);
    return -lowest;
}

static void thin_plates_hold_what_sticks_through(void **state)
{
    (void)state;
    const double thick[] = { 0.001, 0.003, 0.01 };
    for (int solver = 0; solver < 3; ++solver) {
        double deepest = 0;
        for (int i = 0; i < 3 * 5 * 4 * 9; ++i) {
            double depth = rest_depth(solver, thick[i % 3], 0.175 * (i / 3 % 5),
                                      0.2 + 0.35 * (i / 15 % 4), 0.01 * (i / 60 - 4));
            deepest = fmax(deepest, depth);
            assert_true(depth < 0.006); // the classic solver leaves 5 mm
        }
        print_message("slats that stuck through, solver %d: %.2g m deep in the end\n", solver,
                      deepest);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_stop),
        cmocka_unit_test(walls_stop),
        cmocka_unit_test(ends_and_gaps_let_fall),
        cmocka_unit_test(bends_are_followed),
        cmocka_unit_test(rough_and_smooth_tiles_take_turns),
        cmocka_unit_test(every_tile_is_told),
        cmocka_unit_test(systems_see_every_tile),
        cmocka_unit_test(thin_plates_hold_what_sticks_through),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
