// test_api_geometry.c - shapes as plain data, angles: what each public function answers on shapes known by
// heart, and every call that is refused, outputs untouched. Depth: tests/unit/test_geometry.c,
// test_decompose.c, test_math.c, test_trig.c.
#include "world_fixture.h"

#define PI 3.14159265358979323846

static plumb_convex unit_box(void)
{
    plumb_convex box;
    assert_int_equal(plumb_convex_box(plumb_v2(1, 1), plumb_v2(0, 0), 0, 0, &box), PLUMB_OK);
    return box;
}

static void angles(void **state)
{
    (void)state;
    plumb_rot q;
    plumb_sincos(R(PI / 6), &q);
    assert_near(q.c, 0.8660254, 1e-6);
    assert_near(q.s, 0.5, ROUNDED(1e-6));
    assert_near(plumb_atan2(1, -1), 3 * PI / 4, ROUNDED(1e-6));
    assert_near(plumb_atan2(-2, 0), -PI / 2, ROUNDED(1e-6));
    assert_near(plumb_angle_wrap(R(3 * PI / 2)), -PI / 2, ROUNDED(1e-5));
    assert_near(plumb_angle_wrap(R(-5)), -5 + 2 * PI, ROUNDED(1e-5));
}

static void makers(void **state)
{
    (void)state;
    plumb_convex c;
    assert_int_equal(plumb_convex_circle(plumb_v2(1, 2), 3, &c), PLUMB_OK);
    assert_int_equal(c.count, 1);
    assert_int_equal(plumb_convex_capsule(plumb_v2(0, 0), plumb_v2(2, 0), 1, &c), PLUMB_OK);
    assert_int_equal(c.count, 2);
    assert_true(c.radius == 1);
    assert_int_equal(plumb_convex_segment(plumb_v2(0, 0), plumb_v2(0, 4), &c), PLUMB_OK);
    assert_true(c.count == 2 && c.radius == 0);
    const plumb_vec2 cloud[] = { { 0, 0 }, { 1, 1 }, { 2, 0 }, { 2, 2 }, { 0, 2 } };
    assert_int_equal(plumb_convex_polygon(cloud, 5, R(0.1), &c), PLUMB_OK);
    assert_int_equal(c.count, 4); // (1, 1) lies inside
    plumb_vec2 hull[5];
    int count = 0;
    assert_int_equal(plumb_hull(cloud, 5, hull, 5, &count), PLUMB_OK);
    assert_int_equal(count, 4);
    assert_vec_near(hull[0], 0, 0, 0);
    assert_vec_near(hull[2], 2, 2, 0);
    plumb_transform turn = { { 10, 0 }, { 0, 1 } };
    plumb_convex box = unit_box(), moved;
    plumb_convex_transform(&box, turn, &moved);
    assert_vec_near(moved.points[0], 11, -1, 1e-6); // was (-1, -1)
}

static void masses(void **state)
{
    (void)state;
    plumb_convex box = unit_box();
    plumb_mass_properties disc = plumb_circle_mass(plumb_v2(4, 0), 1, 2);
    assert_near(disc.mass, 2 * PI, ROUNDED(1e-5));
    assert_near(disc.inertia, PI, ROUNDED(1e-5));
    plumb_mass_properties rod = plumb_capsule_mass(plumb_v2(-1, 0), plumb_v2(1, 0), 1, 1);
    assert_near(rod.mass, 4 + PI, ROUNDED(1e-5));
    assert_vec_near(rod.center, 0, 0, ROUNDED(1e-6));
    plumb_mass_properties m = plumb_convex_mass(&box, 3);
    assert_near(m.mass, 12, ROUNDED(1e-5));
    assert_near(m.inertia, 12 * 8.0 / 12, 1e-4); // m (w^2 + h^2) / 12
    assert_near(plumb_mass_inertia_about(m, plumb_v2(0, 2)), 8 + 12 * 4, ROUNDED(1e-4));
    plumb_mass_properties heavy = plumb_mass_with_total(m, 24);
    assert_near(heavy.inertia, 16, ROUNDED(1e-4));
    const plumb_mass_properties two[] = { { 1, { -1, 0 }, 0 }, { 3, { 1, 0 }, 0 } };
    plumb_mass_properties sum = plumb_mass_combine(two, 2);
    assert_near(sum.mass, 4, ROUNDED(1e-6));
    assert_vec_near(sum.center, 0.5, 0, ROUNDED(1e-6));
    assert_near(sum.inertia, 1 * 2.25 + 3 * 0.25, ROUNDED(1e-5));
}

static const plumb_vec2 ell[] = { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } };
static const plumb_vec2 bow[] = { { 0, 0 }, { 1, 1 }, { 1, 0 }, { 0, 1 } }; // crosses itself

static void outlines(void **state)
{
    (void)state;
    assert_int_equal(plumb_outline_check(ell, 6), PLUMB_OK);
    assert_near(plumb_outline_area(ell, 6), 3, ROUNDED(1e-6));
    assert_false(plumb_outline_is_convex(ell, 6));
    assert_true(plumb_outline_is_convex(ell, 3));
    assert_true(plumb_outline_contains(ell, 6, plumb_v2(R(0.5), R(1.5))));
    assert_false(plumb_outline_contains(ell, 6, plumb_v2(R(1.5), R(1.5))));
    plumb_mass_properties m = plumb_outline_mass(ell, 6, 2);
    assert_near(m.mass, 6, ROUNDED(1e-5));
    assert_vec_near(m.center, 2.5 / 3, 2.5 / 3, ROUNDED(1e-5));
    plumb_convex_piece pieces[4];
    int count = 0;
    assert_int_equal(plumb_outline_decompose(ell, 6, pieces, 4, &count), PLUMB_OK);
    assert_int_equal(count, 2);
    double area = 0;
    for (int i = 0; i < count; ++i) {
        area += (double)plumb_outline_area(pieces[i].vertices, pieces[i].count);
    }
    assert_near(area, 3, ROUNDED(1e-6));
}

static void questions(void **state)
{
    (void)state;
    plumb_convex box = unit_box();
    plumb_aabb around = plumb_convex_aabb(&box, (plumb_transform){ { 5, 0 }, { 1, 0 } });
    assert_vec_near(around.min, 4, -1, ROUNDED(1e-6));
    assert_vec_near(around.max, 6, 1, ROUNDED(1e-6));
    int far = plumb_convex_support_index(&box, plumb_v2(1, 2));
    assert_vec_near(box.points[far], 1, 1, ROUNDED(1e-6));
    assert_vec_near(plumb_convex_support(&box, plumb_v2(-1, 2)), -1, 1, ROUNDED(1e-6));
    assert_true(plumb_convex_contains(&box, plumb_v2(R(0.9), R(-0.9))));
    assert_false(plumb_convex_contains(&box, plumb_v2(R(1.1), 0)));
    plumb_convex_near near = plumb_convex_nearest(&box, plumb_v2(3, R(0.5)));
    assert_near(near.distance, 2, ROUNDED(1e-6));
    assert_vec_near(near.normal, 1, 0, ROUNDED(1e-6));
    plumb_convex_hit hit;
    assert_true(plumb_convex_ray(&box, plumb_v2(-5, 0), plumb_v2(8, 0), &hit));
    assert_near(hit.fraction, 0.5, ROUNDED(1e-6));
    assert_vec_near(hit.normal, -1, 0, ROUNDED(1e-6));
    assert_false(plumb_convex_ray(&box, plumb_v2(-5, 2), plumb_v2(8, 0), &hit));
}

//---- refused calls -------------------------------------------------------------------------------

static void shapes_are_refused(void **state)
{
    (void)state;
    plumb_convex c = { .count = 77 };
    const plumb_real nan_ = (plumb_real)NAN;
    const plumb_vec2 o = { 0, 0 }, x = { 1, 0 }, bad = { nan_, 0 };
    plumb_vec2 many[257] = { { 0, 0 } }, round[17];
    for (int i = 0; i < 17; ++i) {
        round[i] = plumb_v2(R(cos(2 * PI * i / 17)), R(sin(2 * PI * i / 17)));
    }
    assert_int_equal(plumb_convex_circle(o, 1, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_convex_circle(bad, 1, &c), PLUMB_E_NOT_FINITE);
    assert_int_equal(plumb_convex_circle(o, 0, &c), PLUMB_E_RANGE);
    assert_int_equal(plumb_convex_capsule(o, x, 1, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_convex_capsule(o, x, nan_, &c), PLUMB_E_NOT_FINITE);
    assert_int_equal(plumb_convex_capsule(o, x, -1, &c), PLUMB_E_RANGE);
    assert_int_equal(plumb_convex_capsule(o, o, 1, &c), PLUMB_E_GEOMETRY);
    assert_int_equal(plumb_convex_segment(o, x, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_convex_segment(bad, x, &c), PLUMB_E_NOT_FINITE);
    assert_int_equal(plumb_convex_segment(o, plumb_v2(R(1e8), 0), &c), PLUMB_E_RANGE);
    assert_int_equal(plumb_convex_segment(x, x, &c), PLUMB_E_GEOMETRY);
    assert_int_equal(plumb_convex_box(x, o, 0, 0, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_convex_box(x, o, nan_, 0, &c), PLUMB_E_NOT_FINITE);
    assert_int_equal(plumb_convex_box(x, o, 0, 0, &c), PLUMB_E_RANGE); // half height 0
    assert_int_equal(plumb_convex_polygon(NULL, 3, 0, &c), PLUMB_E_NULL);
    assert_int_equal(plumb_convex_polygon(ell, 2, 0, &c), PLUMB_E_RANGE);
    assert_int_equal(plumb_convex_polygon(ell, 6, nan_, &c), PLUMB_E_NOT_FINITE);
    assert_int_equal(plumb_convex_polygon(many, 257, 0, &c), PLUMB_E_CAPACITY);
    assert_int_equal(plumb_convex_polygon(round, 17, 0, &c), PLUMB_E_CAPACITY);
    assert_int_equal(plumb_convex_polygon(many, 4, 0, &c), PLUMB_E_GEOMETRY);
    assert_int_equal(c.count, 77);
}

static void outlines_are_refused(void **state)
{
    (void)state;
    const plumb_vec2 bad[] = { { (plumb_real)NAN, 0 }, { 1, 0 }, { 0, 1 } };
    plumb_vec2 hull[8], many[257] = { { 0, 0 } };
    plumb_convex_piece pieces[4];
    int count = 77;
    assert_int_equal(plumb_hull(NULL, 3, hull, 8, &count), PLUMB_E_NULL);
    assert_int_equal(plumb_hull(ell, 2, hull, 8, &count), PLUMB_E_RANGE);
    assert_int_equal(plumb_hull(bad, 3, hull, 8, &count), PLUMB_E_NOT_FINITE);
    assert_int_equal(plumb_hull(many, 257, hull, 8, &count), PLUMB_E_CAPACITY);
    assert_int_equal(plumb_hull(ell, 6, hull, 3, &count), PLUMB_E_CAPACITY);
    assert_int_equal(plumb_hull(many, 5, hull, 8, &count), PLUMB_E_GEOMETRY);
    assert_int_equal(plumb_outline_check(NULL, 3), PLUMB_E_NULL);
    assert_int_equal(plumb_outline_check(ell, 2), PLUMB_E_RANGE);
    assert_int_equal(plumb_outline_check(bad, 3), PLUMB_E_NOT_FINITE);
    assert_int_equal(plumb_outline_check(many, 257), PLUMB_E_CAPACITY);
    assert_int_equal(plumb_outline_check(bow, 4), PLUMB_E_GEOMETRY);
    assert_int_equal(plumb_outline_decompose(NULL, 3, pieces, 4, &count), PLUMB_E_NULL);
    assert_int_equal(plumb_outline_decompose(ell, 2, pieces, 4, &count), PLUMB_E_RANGE);
    assert_int_equal(plumb_outline_decompose(bad, 3, pieces, 4, &count), PLUMB_E_NOT_FINITE);
    assert_int_equal(plumb_outline_decompose(bow, 4, pieces, 4, &count), PLUMB_E_GEOMETRY);
    assert_int_equal(count, 77);
    assert_int_equal(plumb_outline_decompose(ell, 6, pieces, 1, &count), PLUMB_E_CAPACITY);
    assert_int_equal(count, 2); // so many are needed
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(angles),
        cmocka_unit_test(makers),
        cmocka_unit_test(masses),
        cmocka_unit_test(outlines),
        cmocka_unit_test(questions),
        cmocka_unit_test(shapes_are_refused),
        cmocka_unit_test(outlines_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
