// test_internal_edges.c - cones, stretches, neighbours, normals; bodies asleep on internal edges.
#include "internal_edges_fixture.h"

//---- cones ---------------------------------------------------------------------------------------
static pl_cone arc(double from, double to)
{
    return (pl_cone){ cos(from), sin(from), cos(to), sin(to), PL_CONE_ARC };
}

// Every arc of whole steps of 30 degrees against every other, asked at every half step.
static void cones_meet_as_sets_do(void **state)
{
    (void)state;
    const double step = SIM_PI / 6;
    for (int a = 0; a < 12; ++a) {
        for (int wide_a = 0; wide_a <= 6; ++wide_a) {
            for (int b = 0; b < 12; ++b) {
                for (int wide_b = 0; wide_b <= 6; ++wide_b) {
                    pl_cone p = arc(a * step, (a + wide_a) * step);
                    pl_cone q = arc(b * step, (b + wide_b) * step);
                    pl_cone both = pl_cone_meet(&p, &q, 1e-3);
                    for (int k = 0; k < 24; ++k) {
                        bool in_p = (k - 2 * a + 48) % 24 <= 2 * wide_a;
                        bool in_q = (k - 2 * b + 48) % 24 <= 2 * wide_b;
                        double x = cos(k * step / 2), y = sin(k * step / 2);
                        assert_int_equal(pl_cone_contains(&p, x, y, 1e-9), in_p);
                        assert_int_equal(pl_cone_contains(&both, x, y, 1e-9), in_p && in_q);
                    }
                }
            }
        }
    }
}

static void nearly_flat_is_flat(void **state)
{
    (void)state;
    for (int i = -1; i <= 1; ++i) { // the neighbour rises, is flush, falls by half the tolerance
        pl_cone own = arc(0, SIM_PI / 2), next = arc(SIM_PI / 2 + i * 5e-4, SIM_PI);
        pl_cone met = pl_cone_meet(&own, &next, PL_EDGE_ANGLE);
        assert_true(pl_cone_is_flat(&met) && met.form == PL_CONE_ARC);
        assert_true(met.lo_x == own.hi_x && met.lo_y == own.hi_y);
    }
    pl_cone own = arc(0, SIM_PI / 2), inner = arc(SIM_PI / 2 + 0.01, SIM_PI);
    assert_int_equal(pl_cone_meet(&own, &inner, PL_EDGE_ANGLE).form, PL_CONE_NONE);
    pl_cone outer = arc(SIM_PI / 2 - 0.01, SIM_PI);
    pl_cone met = pl_cone_meet(&own, &outer, PL_EDGE_ANGLE);
    assert_true(met.form == PL_CONE_ARC && !pl_cone_is_flat(&met));
    // Two lines end to end: both sides, not what lies between.
    pl_cone left = arc(-SIM_PI / 2, SIM_PI / 2), right = arc(SIM_PI / 2, 3 * SIM_PI / 2);
    met = pl_cone_meet(&left, &right, PL_EDGE_ANGLE);
    assert_int_equal(met.form, PL_CONE_ENDS);
    assert_true(pl_cone_is_flat(&met) && pl_cone_contains(&met, 0, 1, 1e-9) &&
                pl_cone_contains(&met, 0, -1, 1e-9) && !pl_cone_contains(&met, 1, 0, 1e-9) &&
                !pl_cone_contains(&met, -1, 0, 1e-9));
    // A third that hangs from there takes the lower side.
    pl_cone hanging = arc(0, SIM_PI);
    met = pl_cone_meet(&met, &hanging, PL_EDGE_ANGLE);
    assert_true(met.form == PL_CONE_ARC && pl_cone_contains(&met, 0, 1, 1e-9) &&
                !pl_cone_contains(&met, 0, -1, 1e-9));
}

//---- stretches -----------------------------------------------------------------------------------
static void stretches_are_merged(void **state)
{
    (void)state;
    unsigned seed = 7;
    for (int round = 0; round < 300; ++round) {
        pl_interval intervals[40];
        bool covered[400] = { false };
        uint32_t count = sim_random(&seed) % 40;
        for (uint32_t i = 0; i < count; ++i) {
            uint32_t from = sim_random(&seed) % 380, to = from + 1 + sim_random(&seed) % 19;
            intervals[i] = (pl_interval){ (real)from, (real)to };
            memset(covered + from, true, to - from);
        }
        uint32_t merged = pl_intervals_merge(intervals, count);
        for (uint32_t i = 0; i + 1 < merged; ++i) {
            assert_true(intervals[i].to < intervals[i + 1].from);
        }
        for (int k = 0; k < 400; ++k) {
            assert_int_equal(pl_intervals_leave_open(intervals, merged, k + 0.5, k + 0.5),
                             !covered[k]);
        }
        for (int k = 0; k < 50; ++k) {
            uint32_t low = sim_random(&seed) % 400, high = low + sim_random(&seed) % (400 - low);
            bool open = false;
            for (uint32_t c = low; c <= high; ++c) {
                open |= !covered[c];
            }
            assert_int_equal(pl_intervals_leave_open(intervals, merged, low + 0.5, high + 0.5),
                             open);
        }
    }
}

//---- who is a neighbour --------------------------------------------------------------------------
typedef struct two_tiles {
    const char *name;
    double gap, rise; // [m] of the second tile
    double size;      // [m] of both
    double radius;    // [m] rounding of the second
    bool joined;
} two_tiles;

static void neighbours_are_within_the_slop(void **state)
{
    (void)state;
    const two_tiles cases[] = {
        { "touching", 0, 0, 1, 0, true },
        { "0.9 mm apart", 9e-4, 0, 1, 0, true },
        { "1.2 mm apart", 1.2e-3, 0, 1, 0, false },
        { "0.9 mm higher", 0, 9e-4, 1, 0, true },
        { "1.2 mm higher", 0, 1.2e-3, 1, 0, false },
        { "small ones 0.9 mm apart", 9e-4, 0, 0.05, 0, false },
        { "small ones 0.4 mm apart", 4e-4, 0, 0.05, 0, true },
        { "overlapping by 1 cm", -0.01, 0, 1, 0, true },
        { "one rounded", 0, 0, 1, 0.1, false },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const two_tiles *c = &cases[i];
        plumb_world *w = sim_space();
        plumb_material m = sim_material(w, 0, 0);
        sim_ball(w, -300, 0, 0.5, m);
        plumb_body a = sim_body(w, PLUMB_STATIC, 0, 0, 0);
        sim_add_box(w, a, c->size / 2, c->size / 2, m);
        plumb_body b = sim_body(w, PLUMB_STATIC, c->size + c->gap, c->rise, 0);
        plumb_shape_desc desc = { .kind = PLUMB_BOX,
                                  .half = sim_vec(c->size / 2 - c->radius, c->size / 2 - c->radius),
                                  .radius = (plumb_real)c->radius };
        plumb_shape_create(w, b, &desc);
        take_a_step(w);
        pl_side side = pl_side_of(w, w->bodies.first_piece[pl_body_row(w, a)]);
        bool flat = pl_side_edge_end(&side, 2, true) == PL_END_FLAT;
        print_message("%-24s %s\n", c->name, flat ? "one ground" : "two");
        assert_int_equal(flat, c->joined);
        // What lies in front of the side covers it even where the tops differ.
        plumb_world_destroy(w);
    }
}

static uint32_t tile_at(plumb_world *w, double x, plumb_body *b, plumb_material m)
{
    *b = sim_body(w, PLUMB_STATIC, x, 0, 0);
    sim_add_box(w, *b, 0.5, 0.5, m);
    return w->bodies.first_piece[pl_body_row(w, *b)];
}

// What something passes through is not one ground with what it meets.
static void passed_bodies_are_apart(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_material m = sim_material(w, 0, 0);
    plumb_body ball = sim_ball(w, -300, 0, 0.5, m), a, b, c;
    uint32_t p = tile_at(w, 0, &a, m), q = tile_at(w, 1, &b, m), r = tile_at(w, 2, &c, m);
    take_a_step(w);
    assert_true(pl_piece_has_internal_edges(&w->pieces, p) &&
                pl_piece_has_internal_edges(&w->pieces, q));
    plumb_world_exclude_pair(w, a, ball, true);
    take_a_step(w);
    assert_true(!pl_piece_has_internal_edges(&w->pieces, p) &&
                pl_piece_has_internal_edges(&w->pieces, q));
    plumb_joint joint = plumb_joint_create(
        w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .body_a = c, .body_b = ball });
    take_a_step(w);
    assert_true(!pl_piece_has_internal_edges(&w->pieces, q) &&
                !pl_piece_has_internal_edges(&w->pieces, r));
    assert_int_equal(w->internal_edges.count, 0);
    plumb_joint_destroy(w, joint);
    take_a_step(w);
    assert_true(pl_piece_has_internal_edges(&w->pieces, q) &&
                pl_piece_has_internal_edges(&w->pieces, r));
    plumb_world_destroy(w);
}

// A floor of two lines and a ramp: what stands at the end of which face.
static void walls_stand_at_inner_ends(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    sim_ball(w, -300, 0, 0.5, sim_material(w, 0, 0));
    plumb_vec2 p[] = { sim_vec(0, 0), sim_vec(1, 0), sim_vec(2, 0), sim_vec(3, 1) };
    plumb_shape_desc desc = { .kind = PLUMB_CHAIN, .points = p, .count = 4 };
    plumb_shape chain = plumb_shape_create(w, sim_body(w, PLUMB_STATIC, 0, 0, 0), &desc);
    take_a_step(w);
    uint32_t first = pl_shape_piece(w, chain), second = w->pieces.next_in_shape[first];
    uint32_t ramp = w->pieces.next_in_shape[second];
    // Edge 0 of a line is its right side, seen along it: the lower one; edge 1 runs back above.
    pl_side a = pl_side_of(w, first), b = pl_side_of(w, second), c = pl_side_of(w, ramp);
    assert_int_equal(pl_side_edge_end(&a, 1, false), PL_END_OUTER);
    assert_int_equal(pl_side_edge_end(&a, 1, true), PL_END_FLAT);
    assert_int_equal(pl_side_edge_end(&b, 1, false), PL_END_FLAT);
    assert_int_equal(pl_side_edge_end(&b, 1, true), PL_END_INNER);
    assert_int_equal(pl_side_edge_end(&c, 1, false), PL_END_INNER);
    assert_int_equal(pl_side_edge_end(&b, 0, false), PL_END_OUTER); // below, the bend is convex
    assert_int_equal(pl_side_edge_end(&c, 1, true), PL_END_OUTER);
    const real *up = b.edges[1].walls[1], *floor = c.edges[0].walls[0];
    assert_true(fabs((double)up[0] + sqrt(0.5)) < 1e-6 && fabs((double)up[1] - sqrt(0.5)) < 1e-6);
    assert_true(fabs((double)floor[0]) < 1e-6 && fabs((double)floor[1] - 1) < 1e-6);
    assert_true(pl_side_corner_is_flat(&a, 1) && !pl_side_corner_is_flat(&b, 1));
    plumb_world_destroy(w);
}

// The question for impacts, in world axes.
static void normals_are_asked_in_world_axes(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_material m = sim_material(w, 0, 0);
    sim_ball(w, -300, 0, 0.5, m);
    double angle = 0.7, c = cos(angle), s = sin(angle);
    uint32_t piece = PL_NONE;
    for (int i = -1; i <= 1; ++i) {
        plumb_body b = sim_body(w, PLUMB_STATIC, c * i, s * i, angle);
        sim_add_box(w, b, 0.5, 0.5, m);
        piece = i == 0 ? w->bodies.first_piece[pl_body_row(w, b)] : piece;
    }
    take_a_step(w);
    const pl_pose *pose = &pl_poses(w)[w->pieces.body[piece]];
    c = (double)pose->c, s = (double)pose->s; // as rounded: normals are compared to a few roundings
    assert_true(pl_internal_edges_allow(w, piece, -s, c, -0.5 * s, 0.5 * c));    // the top
    assert_true(pl_internal_edges_allow(w, piece, s, -c, 0.5 * s, -0.5 * c));    // the bottom
    assert_false(pl_internal_edges_allow(w, piece, c, s, 0.5 * c, 0.5 * s));     // a covered side
    assert_false(pl_internal_edges_allow(w, piece, -c, -s, -0.5 * c, -0.5 * s)); // the other
    double d = 0.1, nx = -s * cos(d) + c * sin(d), ny = c * cos(d) + s * sin(d);
    assert_false(pl_internal_edges_allow(w, piece, nx, ny, 0, 0)); // leaning on a flat corner
    plumb_world_destroy(w);
}

// A body of several pieces has internal edges of its own. When it goes as the last one that has any, what was noted
// of its pairs goes too: they name places in a pair list that is no more.
static void what_was_noted_goes_with_the_last_internal_edges(void **state)
{
    (void)state;
    enum { BALLS = 200 };
    for (int how = 0; how < 3; ++how) {
        plumb_world *w = sim_space();
        plumb_material m = sim_material(w, 0, 0);
        plumb_body floor = sim_floor(w, m), balls[BALLS];
        plumb_body tee = sim_body(w, PLUMB_DYNAMIC, 0, 0, 0);
        const plumb_vec2 outline[] = { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } };
        plumb_shape_desc desc = {
            .kind = PLUMB_OUTLINE, .points = outline, .count = 6, .material = m
        };
        plumb_shape shape = plumb_shape_create(w, tee, &desc);
        take_a_step(w); // few pairs
        for (int i = 0; i < BALLS; ++i) {
            balls[i] = sim_ball(w, 4 + i, 0.5, 0.4999, m);
        }
        take_a_step(w); // and many, in another buffer
        assert_true(w->internal_edges.pair_count > 0);
        for (int i = 4; i < BALLS; ++i) {
            plumb_body_destroy(w, balls[i]);
        }
        if (how == 0) {
            plumb_body_destroy(w, tee);
        } else if (how == 1) {
            plumb_shape_destroy(w, shape);
        } else {
            plumb_body_set_enabled(w, tee, false);
        }
        for (int step = 0; step < 3; ++step) {
            take_a_step(w);
            assert_int_equal(w->internal_edges.count, 0);
            assert_int_equal(w->internal_edges.pair_count, 0);
        }
        assert_true(plumb_body_valid(w, floor));
        plumb_world_destroy(w);
    }
}

// A body of several pieces has its internal edges whether it is awake or asleep when they are looked for.
static void bodies_asleep_keep_their_internal_edges(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_material m = sim_material(w, 0, 0);
    const plumb_vec2 outline[] = { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } };
    const plumb_shape_desc desc = {
        .kind = PLUMB_OUTLINE, .points = outline, .count = 6, .material = m
    };
    sim_ball(w, -300, 0, 0.5, m);
    plumb_body bodies[2];
    for (int i = 0; i < 2; ++i) {
        bodies[i] = plumb_body_create(
            w, &(plumb_body_desc){ .position = sim_vec(10 * i, 0), .asleep = i == 1 });
        assert_true(plumb_shape_valid(w, plumb_shape_create(w, bodies[i], &desc)));
    }
    for (int round = 0; round < 3; ++round) {
        take_a_step(w);
        assert_int_equal(plumb_body_is_awake(w, bodies[1]), round == 2);
        uint32_t p = w->bodies.first_piece[pl_body_row(w, bodies[0])];
        uint32_t q = w->bodies.first_piece[pl_body_row(w, bodies[1])];
        for (; p != PL_NONE; p = w->pieces.next_in_body[p], q = w->pieces.next_in_body[q]) {
            assert_true(pl_piece_has_internal_edges(&w->pieces, p));
            assert_int_equal(w->pieces.internal_corners[p], w->pieces.internal_corners[q]);
            assert_int_equal(w->pieces.internal_edges[p], w->pieces.internal_edges[q]);
        }
        w->internal_edges.all = w->internal_edges.dirty = true; // as after a restore
        w->schedule_dirty = true;
        if (round == 1) {
            plumb_body_wake(w, bodies[1]);
        }
    }
    plumb_world_destroy(w);
}

// A box that slides over tiles, beside boxes that fall asleep meanwhile: its pairs move up in the list,
// and what it bears, and on which tile, with them.
static plumb_world *tiles_and_sleepers(int sleepers, plumb_body *slider)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ .sleep_time = (plumb_real)0.1 });
    plumb_material m = sim_material(w, 0.3, 0);
    for (int i = 0; i < 60; ++i) {
        plumb_body tile = sim_body(w, PLUMB_STATIC, 0.5 * i, -0.25, 0);
        sim_add_box(w, tile, 0.25, 0.25, m);
    }
    for (int i = 0; i < sleepers; ++i) {
        // Each rests a step later than the one before it.
        plumb_body b = sim_crate(w, 0.3 + 0.11 * i, 10 + 0.5, 0.04, 0.5, m);
        plumb_body shelf = sim_body(w, PLUMB_STATIC, 0.3 + 0.11 * i, 9, 0);
        sim_add_box(w, shelf, 0.05, 1, m);
        sim_launch(w, b, 0, 0.01 * i, 0);
    }
    *slider = sim_crate(w, 1, 0.4, 0.9, 0.4, m);
    plumb_body_set_no_sleep(w, *slider, true);
    sim_launch(w, *slider, 5, 0, 0);
    return w;
}

static void those_who_fall_asleep_change_nothing_for_others(void **state)
{
    (void)state;
    plumb_body with, alone;
    plumb_world *w = tiles_and_sleepers(40, &with), *v = tiles_and_sleepers(0, &alone);
    uint32_t asleep = 0, falls = 0;
    for (int step = 0; step < 200; ++step) {
        plumb_contact a[8], b[8];
        take_a_step(w);
        take_a_step(v);
        uint32_t now = plumb_world_stats(w).asleep_count;
        falls += now > asleep;
        asleep = now;
        assert_true(sim_x(w, with) == sim_x(v, alone) && sim_y(w, with) == sim_y(v, alone) &&
                    sim_angle(w, with) == sim_angle(v, alone));
        int count = plumb_body_contacts(w, with, a, 8);
        assert_int_equal(count, plumb_body_contacts(v, alone, b, 8));
        for (int i = 0; i < count; ++i) {
            assert_true(plumb_same(a[i].body_a, with) || plumb_same(a[i].body_b, with));
            assert_memory_equal(&a[i].normal, &b[i].normal, sizeof a[i].normal);
            assert_memory_equal(a[i].points, b[i].points, sizeof a[i].points);
        }
    }
    assert_true(falls > 5 && asleep == 40);
    plumb_world_destroy(w);
    plumb_world_destroy(v);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cones_meet_as_sets_do),
        cmocka_unit_test(nearly_flat_is_flat),
        cmocka_unit_test(stretches_are_merged),
        cmocka_unit_test(neighbours_are_within_the_slop),
        cmocka_unit_test(passed_bodies_are_apart),
        cmocka_unit_test(walls_stand_at_inner_ends),
        cmocka_unit_test(normals_are_asked_in_world_axes),
        cmocka_unit_test(what_was_noted_goes_with_the_last_internal_edges),
        cmocka_unit_test(bodies_asleep_keep_their_internal_edges),
        cmocka_unit_test(those_who_fall_asleep_change_nothing_for_others),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
