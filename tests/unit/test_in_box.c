// test_in_box.c - what triangles have of upright boxes: parts add up, whatever the boxes are.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "geometry/in_box.h"
#include "harness/random.h"

// A grid of boxes has all of a triangle: its area, and its first moments.
static void boxes_have_all_of_a_triangle(void **state)
{
    (void)state;
    uint32_t seed = 7;
    for (int n = 0; n < 2000; ++n) {
        double x[3], y[3];
        for (int k = 0; k < 3; ++k) {
            // Every other one has corners on the lines of the grid.
            x[k] = sim_uniform(&seed, 0, 4), y[k] = sim_uniform(&seed, 0, 4);
            x[k] = n % 2 == 0 ? x[k] : floor(x[k]), y[k] = n % 2 == 0 ? y[k] : floor(y[k]);
        }
        const double area = ((x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0])) / 2;
        double sum = 0, mx = 0, my = 0;
        for (int i = 0; i < 4 && area > 0; ++i) {
            for (int j = 0; j < 4; ++j) {
                const pl_in_box part = pl_triangle_in_box(x, y, i, j, i + 1, j + 1);
                assert_true(part.area >= -1e-15 && part.area <= 1 + 1e-12);
                sum += part.area, mx += part.area * part.x, my += part.area * part.y;
            }
        }
        if (area > 0) {
            assert_true(fabs(sum - area) < 1e-13);
            assert_true(fabs(mx - area * (x[0] + x[1] + x[2]) / 3) < 1e-12);
            assert_true(fabs(my - area * (y[0] + y[1] + y[2]) / 3) < 1e-12);
        }
    }
}

static void what_is_apart_has_nothing(void **state)
{
    (void)state;
    const double x[3] = { 0, 1, 0 }, y[3] = { 0, 0, 1 };
    assert_true(pl_triangle_in_box(x, y, 2, 2, 3, 3).area == 0);
    assert_true(pl_triangle_in_box(x, y, 1, 0, 2, 1).area == 0);
    assert_true(pl_triangle_in_box(x, y, 0.6, 0.6, 1, 1).area == 0);
    assert_true(fabs(pl_triangle_in_box(x, y, -1, -1, 2, 2).area - 0.5) < 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_have_all_of_a_triangle),
        cmocka_unit_test(what_is_apart_has_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
