// test_far.c - far from the origin: in the double and the far build a pyramid, and a bridge, do what they do at
// the origin; in the float build within what the spacing of floats there allows. src/world/README.md has the table.
#include "plumb/plumb.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#define R(x) ((plumb_real)(x))
#define MOST 210 // boxes of 20 rows

static const double places[] = { 1e3, 1e4, 1e5, 1e6, 1e7, 1e8 };
#define PLACES (sizeof places / sizeof places[0])

// Where box i begins. Exact in doubles as far out as 1e8 m.
static void start_of(int rows, int i, double *x, double *y)
{
    int row = 0;
    for (; i >= rows - row; ++row) {
        i -= rows - row;
    }
    *x = (i - (rows - row - 1) * 0.5) * 1.125;
    *y = 0.5 + row;
}

// A box of its own where the boxes are; or a polygon that is as far from its body, which is at the origin.
static void add_ground(plumb_world *w, double far, bool of_origin)
{
    const double at = of_origin ? 0 : far, to = far - at;
    const plumb_vec2 corners[] = { { R(to - 40), R(to - 2) },
                                   { R(to + 40), R(to - 2) },
                                   { R(to + 40), R(to) },
                                   { R(to - 40), R(to) } };
    plumb_body ground = plumb_body_create(
        w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { R(at), R(at) } });
    const plumb_shape_desc desc =
        of_origin ? (plumb_shape_desc){ .kind = PLUMB_POLYGON, .points = corners, .count = 4 }
                  : (plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 40, 1 }, .center = { 0, -1 } };
    assert_true(plumb_shape_valid(w, plumb_shape_create(w, ground, &desc)));
}

// How far each box has moved in 10 s [m]; returns the farthest.
static double drift(int rows, double far, bool ground_of_origin, double moved[MOST][2])
{
    plumb_world *w;
    plumb_body boxes[MOST];
    const int count = rows * (rows + 1) / 2;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .no_sleep = true }, &w), PLUMB_OK);
    add_ground(w, far, ground_of_origin);
    for (int i = 0; i < count; ++i) {
        double x, y;
        start_of(rows, i, &x, &y);
        boxes[i] =
            plumb_body_create(w, &(plumb_body_desc){ .position = { R(far + x), R(far + y) } });
        plumb_shape_create(w, boxes[i],
                           &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } });
    }
    for (int step = 0; step < 600; ++step) {
        assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
    }
    double most = 0;
    for (int i = 0; i < count; ++i) {
        double x, y;
        start_of(rows, i, &x, &y);
        plumb_vec2 p = plumb_body_position(w, boxes[i]);
        moved[i][0] = (double)p.x - far - x;
        moved[i][1] = (double)p.y - far - y;
        double d = hypot(moved[i][0], moved[i][1]);
        most = d > most ? d : most;
    }
    plumb_world_destroy(w);
    return most;
}

// In double to 1e8 m; a float pyramid is still one at 1 km.
static size_t tried(void)
{
    return sizeof(plumb_real) > sizeof(float) ? PLACES : 1;
}

// A polygon whose corners are farther than 1e6 m from its body is refused.
static void compare(int rows, bool ground_of_origin, double allowed)
{
    static double here[MOST][2], there[MOST][2];
    drift(rows, 0, ground_of_origin, here);
    for (size_t i = 0; i < tried() && !(ground_of_origin && places[i] > 1e6); ++i) {
        double worst = 0;
        drift(rows, places[i], ground_of_origin, there);
        for (int k = 0; k < rows * (rows + 1) / 2; ++k) {
            double d = hypot(there[k][0] - here[k][0], there[k][1] - here[k][1]);
            worst = d <= worst ? worst : d;
        }
        print_message("%d rows at %g m: %.2g m from where they are at the origin\n", rows,
                      places[i], worst);
        assert_true(worst < allowed);
    }
}

static void every_box_where_it_is_at_the_origin(void **state)
{
    (void)state;
    compare(10, false, PLUMB_IS_FAR ? 2e-8 : sizeof(plumb_real) > sizeof(float) ? 1e-6 : 5e-3);
    if (PLUMB_IS_FAR) { // what boxes do there is the same bit for bit: a position is a rounding off
        compare(20, false, 2e-8);
    }
}

// The ground may be of a body at the origin.
static void on_ground_of_the_origin(void **state)
{
    (void)state;
    compare(10, true, sizeof(plumb_real) > sizeof(float) ? 1e-6 : 5e-3);
}

#define PLANKS 12

// Where the planks of a bridge are after 10 s, seen from `far`; it hangs on a body at the origin.
static void hang(double far, double where[PLANKS][2])
{
    plumb_world *w;
    plumb_body planks[PLANKS];
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .no_sleep = true }, &w), PLUMB_OK);
    plumb_body rock = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    for (int i = 0; i <= PLANKS; ++i) {
        if (i < PLANKS) {
            planks[i] = plumb_body_create(
                w, &(plumb_body_desc){ .position = { R(far + i + 0.5), R(far) } });
            plumb_shape_create(
                w, planks[i],
                &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.125) } });
        }
        plumb_joint hinge =
            plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                       .body_a = i > 0 ? planks[i - 1] : rock,
                                                       .body_b = i < PLANKS ? planks[i] : rock,
                                                       .anchor = { R(far + i), R(far) } });
        assert_true(plumb_joint_valid(w, hinge));
    }
    for (int step = 0; step < 600; ++step) {
        assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
    }
    for (int i = 0; i < PLANKS; ++i) {
        plumb_vec2 p = plumb_body_position(w, planks[i]);
        where[i][0] = (double)p.x - far;
        where[i][1] = (double)p.y - far;
    }
    plumb_world_destroy(w);
}

static void bridge_hangs_as_at_the_origin(void **state)
{
    (void)state;
    double here[PLANKS][2], there[PLANKS][2];
    const double allowed = sizeof(plumb_real) > sizeof(float) ? 1e-6 : 5e-3;
    hang(0, here);
    for (size_t i = 0; i < tried(); ++i) {
        double worst = 0;
        hang(places[i], there);
        for (int k = 0; k < PLANKS; ++k) {
            double d = hypot(there[k][0] - here[k][0], there[k][1] - here[k][1]);
            worst = d <= worst ? worst : d;
        }
        print_message("bridge at %g m: %.2g m from where it is at the origin\n", places[i], worst);
        assert_true(worst < allowed);
    }
}

// Where a crate without friction is that slides over a row of tiles, bodies of their own, and a ball that was shot
// up through a platform of one way and fell on it, after 5 s, seen from `far`.
static void slide(double far, double where[4])
{
    plumb_world *w;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .no_sleep = true }, &w), PLUMB_OK);
    plumb_material ice = plumb_material_create(w, &(plumb_material_desc){ .frictionless = true });
    for (int i = 0; i < 24; ++i) {
        plumb_body tile =
            plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC,
                                                     .position = { R(far + i), R(far - 0.5) } });
        const bool passed = i == 20; // higher than the rest, and behind what slides
        const plumb_shape_desc box = { .kind = PLUMB_BOX,
                                       .half = { R(0.5), R(0.5) },
                                       .center = { 0, passed ? 2 : 0 },
                                       .one_way = { .direction = { 0, passed ? 1 : 0 } },
                                       .material = ice };
        assert_true(plumb_shape_valid(w, plumb_shape_create(w, tile, &box)));
    }
    const plumb_body bodies[2] = {
        plumb_body_create(w, &(plumb_body_desc){ .position = { R(far + 0.3125), R(far + 0.25) },
                                                 .velocity = { R(3.1), 0 } }),
        plumb_body_create(w, &(plumb_body_desc){ .position = { R(far + 20.125), R(far + 0.25) },
                                                 .velocity = { 0, R(8.3) } })
    };
    const plumb_shape_desc shapes[2] = {
        { .kind = PLUMB_BOX, .half = { R(0.25), R(0.25) }, .material = ice },
        { .kind = PLUMB_CIRCLE, .radius = R(0.2), .material = ice }
    };
    for (int i = 0; i < 2; ++i) {
        assert_true(plumb_shape_valid(w, plumb_shape_create(w, bodies[i], &shapes[i])));
    }
    for (int step = 0; step < 300; ++step) {
        assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
    }
    for (int i = 0; i < 2; ++i) {
        plumb_vec2 p = plumb_body_position(w, bodies[i]);
        where[2 * i] = (double)p.x - far;
        where[2 * i + 1] = (double)p.y - far;
    }
    plumb_world_destroy(w);
}

static void internal_edges_and_platforms_are_as_at_the_origin(void **state)
{
    (void)state;
    double here[4], there[4];
    // In double each of the 1,200 substeps may round a place by 7.5e-9 m at 1e8 m; the far build loses nothing there.
    const double allowed = PLUMB_IS_FAR ? 2e-8 : sizeof(plumb_real) > sizeof(float) ? 1e-5 : 5e-3;
    slide(0, here);
    assert_true(here[0] > 15 && here[3] > 2); // over the tiles; on the platform
    for (size_t i = 0; i < tried(); ++i) {
        double worst = 0;
        slide(places[i], there);
        for (int k = 0; k < 4; ++k) {
            worst = fmax(worst, fabs(there[k] - here[k]));
        }
        print_message("tiles at %g m: %.2g m from where they are at the origin\n", places[i],
                      worst);
        assert_true(worst < allowed);
    }
}

// In 20 rows the last bit decides early on which of two faces that lie flush carries a contact (at 1 m from the
// origin as at 1e8 m): single boxes then end some micrometres apart.
static void large_pyramid_drifts_as_at_the_origin(void **state)
{
    (void)state;
    static double moved[MOST][2];
    const double allowed = sizeof(plumb_real) > sizeof(float) ? 1e-6 : 5e-3;
    const double here = drift(20, 0, false, moved);
    assert_true(here < 0.03);
    for (size_t i = 0; i < tried(); ++i) {
        double d = fabs(drift(20, places[i], false, moved) - here);
        if (!(d < allowed)) {
            fail_msg("at %g m it drifts by %g m more or less", places[i], d);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_box_where_it_is_at_the_origin),
        cmocka_unit_test(on_ground_of_the_origin),
        cmocka_unit_test(large_pyramid_drifts_as_at_the_origin),
        cmocka_unit_test(bridge_hangs_as_at_the_origin),
        cmocka_unit_test(internal_edges_and_platforms_are_as_at_the_origin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
