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

//---- bodies of flush boxes -----------------------------------------------------------------------------

// A box that is put together of columns x rows of smaller ones.
static plumb_body add_blocks(plumb_world *w, double x, double y, double hx, double hy, int columns,
                             int rows, double density, plumb_material m)
{
    const plumb_body b = sim_body(w, PLUMB_DYNAMIC, x, y, 0);
    const double bx = hx / columns, by = hy / rows;
    for (int i = 0; i < columns * rows; ++i) {
        const double cx = -hx + bx * (2 * (i % columns) + 1);
        const double cy = -hy + by * (2 * (i / columns) + 1);
        const plumb_shape_desc desc = { .kind = PLUMB_BOX,
                                        .half = sim_vec(bx, by),
                                        .center = sim_vec(cx, cy),
                                        .density = (plumb_real)density,
                                        .material = m };
        assert_true(plumb_shape_valid(w, plumb_shape_create(w, b, &desc)));
    }
    return b;
}

// A stack of bodies of flush boxes on a floor or on tiles lies still and falls asleep, as one of boxes does. Where flat corners of both lay
// on one another each left the contact to the other's neighbour: 26 of 60 stacks never slept and moved by up to 0.97 m.
static void stacks_of_blocks_rest(void **state)
{
    (void)state;
    int moved = 0, awake = 0;
    for (uint32_t first = 1; first <= 60; ++first) {
        uint32_t seed = first;
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        const plumb_material m = sim_material(w, sim_uniform(&seed, 0.2, 1), 0);
        const int count = 2 + (int)sim_uniform(&seed, 0, 4);
        const int columns = 1 + (int)sim_uniform(&seed, 0, 4),
                  rows = 1 + (int)sim_uniform(&seed, 0, 3);
        const double hx = sim_uniform(&seed, 0.3, 1), hy = sim_uniform(&seed, 0.2, 0.6);
        for (int i = 0; i < 16 && first % 2 == 0; ++i) {
            tile(w, i - 7.5, -0.5, 0.5, 0.5, 0, m);
        }
        if (first % 2 != 0) {
            sim_floor(w, m);
        }
        plumb_body stack[5];
        for (int i = 0; i < count; ++i) {
            stack[i] = add_blocks(w, 0, hy * (2 * i + 1), hx, hy, columns, rows, 1, m);
        }
        double most = 0;
        for (int step = 0; step < 300; ++step) {
            sim_step(w, 1 / 60.0);
            const plumb_body top = stack[count - 1];
            most = fmax(most, fabs(sim_x(w, top)) + hx * fabs(sim_angle(w, top)));
        }
        moved += most > 0.005;
        awake += plumb_world_stats(w).asleep_count < (uint32_t)count;
        plumb_world_destroy(w);
    }
    print_message("60 stacks of blocks: %d moved by 5 mm, %d awake after 5 s\n", moved, awake);
    assert_int_equal(moved, 0);
    assert_int_equal(awake, 0);
}

// What slides on a floor does not feel what lands on the same floor 100 m away: runs of flush faces bore for one another.
static void blocks_far_away_do_not_show(void **state)
{
    (void)state;
    plumb_transform at[2];
    for (int other = 0; other < 2; ++other) {
        plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
        const plumb_material m = sim_material(w, 0.5, 0);
        sim_floor(w, m);
        const plumb_body b = add_blocks(w, 0, 0.3, 0.5, 0.3, 3, 1, 1, m);
        sim_launch(w, b, 2, 0, 0);
        if (other == 1) {
            sim_launch(w, add_blocks(w, 100, 0.6, 0.5, 0.3, 3, 1, 1000, m), 1, 0, 0);
        }
        sim_run(w, 200, 1 / 60.0);
        at[other] = plumb_body_transform(w, b);
        plumb_world_destroy(w);
    }
    assert_memory_equal(&at[0], &at[1], sizeof at[0]);
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
        cmocka_unit_test(stacks_of_blocks_rest),
        cmocka_unit_test(blocks_far_away_do_not_show),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
