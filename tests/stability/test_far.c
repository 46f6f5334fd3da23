// test_far.c - far from the origin: in the double build a pyramid does what it does at the origin; in the float
// build within what the spacing of floats there allows. src/world/README.md has the table.
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

// How far each box has moved in 10 s [m]; returns the farthest.
static double drift(int rows, double far, double moved[MOST][2])
{
    plumb_world *w;
    plumb_body boxes[MOST];
    const int count = rows * (rows + 1) / 2;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .no_sleep = true }, &w), PLUMB_OK);
    plumb_body ground = plumb_body_create(
        w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { R(far), R(far - 1) } });
    plumb_shape_create(w, ground, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 40, 1 } });
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

// In the double build to 1e8 m; a float pyramid is still one at 1 km.
static size_t tried(void)
{
    return sizeof(plumb_real) > sizeof(float) ? PLACES : 1;
}

static void every_box_where_it_is_at_the_origin(void **state)
{
    (void)state;
    static double here[MOST][2], there[MOST][2];
    const double allowed = sizeof(plumb_real) > sizeof(float) ? 1e-6 : 5e-3;
    drift(10, 0, here);
    for (size_t i = 0; i < tried(); ++i) {
        drift(10, places[i], there);
        for (int k = 0; k < 55; ++k) {
            double d = hypot(there[k][0] - here[k][0], there[k][1] - here[k][1]);
            if (!(d < allowed)) {
                fail_msg("at %g m, box %d: %g m from where it is at the origin", places[i], k, d);
            }
        }
    }
}

// In 20 rows the last bit decides early on which of two faces that lie flush carries a contact (at 1 m from the
// origin as at 1e8 m): single boxes then end some micrometres apart.
static void large_pyramid_drifts_as_at_the_origin(void **state)
{
    (void)state;
    static double moved[MOST][2];
    const double allowed = sizeof(plumb_real) > sizeof(float) ? 1e-6 : 5e-3;
    const double here = drift(20, 0, moved);
    assert_true(here < 0.03);
    for (size_t i = 0; i < tried(); ++i) {
        double d = fabs(drift(20, places[i], moved) - here);
        if (!(d < allowed)) {
            fail_msg("at %g m it drifts by %g m more or less", places[i], d);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_box_where_it_is_at_the_origin),
        cmocka_unit_test(large_pyramid_drifts_as_at_the_origin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
