// test_geometry_mass.c - mass, centre and inertia of shapes against closed forms, fine grids and their parts.
#include "geometry_fixture.h"

static void near_mass(plumb_mass_properties a, plumb_mass_properties b, double relative)
{
    double mass = (double)b.mass, inertia = (double)b.inertia;
    double length = sqrt(inertia / mass);
    assert_near(a.mass, mass, relative * mass);
    assert_near(a.center.x, b.center.x, relative * length);
    assert_near(a.center.y, b.center.y, relative * length);
    assert_near(a.inertia, inertia, relative * inertia);
}

static void masses_match_closed_forms(void **state)
{
    (void)state;
    plumb_mass_properties m = plumb_circle_mass(plumb_v2(3, 4), 2, 5);
    assert_near(m.mass, 20 * PI, 1e2 * EPS);
    assert_near(m.inertia, 40 * PI, 2e2 * EPS);
    plumb_convex s;
    SAYS(plumb_convex_box(plumb_v2(2, 1), plumb_v2(7, -3), R(0.4), 0, &s), OK);
    m = plumb_convex_mass(&s, 3);
    assert_near(m.mass, 24, 24 * 20 * EPS);
    assert_near(m.center.x, 7, 20 * EPS);
    assert_near(m.center.y, -3, 20 * EPS);
    assert_near(m.inertia, 24 * (16 + 4) / 12.0, 40 * 20 * EPS);
    // A capsule is a thin disc when its ends meet, and a bar when its radius vanishes.
    near_mass(plumb_capsule_mass(plumb_v2(1, 1), plumb_v2(1, 1), 2, 5),
              plumb_circle_mass(plumb_v2(1, 1), 2, 5), 10 * EPS);
    m = plumb_capsule_mass(plumb_v2(-3, 0), plumb_v2(3, 0), R(1e-3), 1);
    assert_near((double)m.inertia / (double)m.mass, 36 / 12.0, 2e-3);
    SAYS(plumb_convex_segment(plumb_v2(0, 0), plumb_v2(2, 4), &s), OK);
    m = plumb_convex_mass(&s, 3);
    assert_near(m.mass, 0, 0);
    assert_near(m.inertia, 0, 0);
    assert_near(m.center.y, 2, 0);
    // A right triangle: centre at a third, I = m (a^2 + b^2) / 18. Far away, too.
    plumb_vec2 triangle[3] = { { 4096, 4096 }, { 4096, 4099 }, { 4102, 4096 } };
    m = plumb_outline_mass(triangle, 3, 2);
    assert_near(m.mass, 18, 1e2 * EPS);
    assert_near(m.center.x, 4098, 4096 * EPS);
    assert_near(m.center.y, 4097, 4096 * EPS);
    assert_near(m.inertia, 18 * (36 + 9) / 18.0, 1e2 * EPS);
    plumb_vec2 line[3] = { { 0, 0 }, { 1, 0 }, { 2, 3 } };
    line[2].y = 0;
    m = plumb_outline_mass(line, 3, 2);
    assert_near(m.mass, 0, 0);
    assert_near(m.center.x, 1, 0);
    assert_near(plumb_mass_inertia_about(plumb_circle_mass(plumb_v2(1, 0), 1, 1), plumb_v2(3, 0)),
                PI / 2 + 4 * PI, 1e2 * EPS);
    m = plumb_mass_with_total(plumb_circle_mass(plumb_v2(1, 0), 2, 7), 3);
    assert_near(m.mass, 3, 0);
    assert_near(m.inertia, 6, 1e2 * EPS);
}

// A box rounded outside has a closed form of its own: three rectangles and a disc in quarters,
// each quarter with its centroid 4 r / (3 pi) from both of its edges.
static void masses_of_rounded_boxes_match_their_closed_form(void **state)
{
    (void)state;
    for (int trial = 0; trial < 200; trial++) {
        double a = uniform(0.1, 3), b = uniform(0.1, 3), r = uniform(0.01, 2), d = 7;
        double g = 4 * r / (3 * PI), quarter = PI * r * r / 4;
        double mass = d * (4 * a * b + 4 * r * (a + b) + 4 * quarter);
        double about_own = PI * r * r * r * r / 8 - quarter * 2 * g * g;
        double inertia = 4 * a * b * (a * a + b * b) / 3;
        inertia += 2 * (2 * a * r) * ((4 * a * a + r * r) / 12 + (b + r / 2) * (b + r / 2));
        inertia += 2 * (2 * b * r) * ((4 * b * b + r * r) / 12 + (a + r / 2) * (a + r / 2));
        inertia += 4 * (about_own + quarter * ((a + g) * (a + g) + (b + g) * (b + g)));
        plumb_convex s;
        plumb_vec2 c = random_point(10);
        SAYS(plumb_convex_box(plumb_v2(R(a), R(b)), c, R(uniform(-3, 3)), R(r), &s), OK);
        plumb_mass_properties want = { R(mass), c, R(d * inertia) };
        near_mass(plumb_convex_mass(&s, R(d)), want, 400 * EPS);
    }
}

// Moments by counting the cells of a grid whose centres lie in the shape. The error of the area
// is below perimeter * cell, and in practice far below.
static plumb_mass_properties count_cells(const plumb_convex *s, int cells)
{
    plumb_aabb box = plumb_convex_aabb(s, plumb_transform_identity());
    double w = (double)(box.max.x - box.min.x) / cells, h = (double)(box.max.y - box.min.y) / cells;
    double n = 0, sx = 0, sy = 0, j = 0;
    for (int iy = 0; iy < cells; iy++) {
        for (int ix = 0; ix < cells; ix++) {
            double x = (double)box.min.x + (ix + 0.5) * w, y = (double)box.min.y + (iy + 0.5) * h;
            if (plumb_convex_contains(s, plumb_v2(R(x), R(y)))) {
                n += 1;
                sx += x;
                sy += y;
                j += x * x + y * y + (w * w + h * h) / 12;
            }
        }
    }
    double cx = sx / n, cy = sy / n;
    plumb_mass_properties m = { R(n * w * h),
                                { R(cx), R(cy) },
                                R(w * h * (j - n * (cx * cx + cy * cy))) };
    return m;
}

static void masses_match_a_fine_grid(void **state)
{
    (void)state;
    for (int trial = 0; trial < 25; trial++) {
        plumb_convex s = random_shape(trial % 5 == 2 ? 4 : trial); // a segment has no area
        near_mass(plumb_convex_mass(&s, 1), count_cells(&s, 300), 3e-3);
    }
}

static void masses_combine_to_the_whole(void **state)
{
    (void)state;
    // An L of two boxes against its outline, in both directions.
    plumb_vec2 l[6] = { { 0, 0 }, { 4, 0 }, { 4, 1 }, { 1, 1 }, { 1, 3 }, { 0, 3 } }, back[6];
    plumb_convex foot, leg;
    SAYS(plumb_convex_box(plumb_v2(2, R(0.5)), plumb_v2(2, R(0.5)), 0, 0, &foot), OK);
    SAYS(plumb_convex_box(plumb_v2(R(0.5), 1), plumb_v2(R(0.5), 2), 0, 0, &leg), OK);
    plumb_mass_properties parts[2] = { plumb_convex_mass(&foot, 2), plumb_convex_mass(&leg, 2) };
    for (int i = 0; i < 6; i++) {
        back[i] = l[5 - i];
    }
    near_mass(plumb_mass_combine(parts, 2), plumb_outline_mass(l, 6, 2), 50 * EPS);
    near_mass(plumb_mass_combine(parts, 2), plumb_outline_mass(back, 6, 2), 50 * EPS);
    plumb_mass_properties none[2] = { { 0, { 1, 2 }, 0 }, { 0, { 3, 4 }, 0 } };
    plumb_mass_properties m = plumb_mass_combine(none, 2);
    assert_near(m.mass, 0, 0);
    assert_near(m.center.x, 2, 0);
    m = plumb_mass_combine(none, 0);
    assert_near(m.mass + m.center.x + m.center.y + m.inertia, 0, 0);
    // A rounded polygon is the sharp one plus strips plus sectors; its mass does not move with it.
    for (int trial = 0; trial < 100; trial++) {
        plumb_convex s = random_shape(4 + 5 * trial), moved;
        plumb_transform t = plumb_transform_make(random_point(5), R(uniform(-3, 3)));
        plumb_convex_transform(&s, t, &moved);
        plumb_mass_properties want = plumb_convex_mass(&s, 1);
        want.center = plumb_transform_apply(t, want.center);
        near_mass(plumb_convex_mass(&moved, 1), want, 200 * EPS);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(masses_match_closed_forms, seed),
        cmocka_unit_test_setup(masses_of_rounded_boxes_match_their_closed_form, seed),
        cmocka_unit_test_setup(masses_match_a_fine_grid, seed),
        cmocka_unit_test_setup(masses_combine_to_the_whole, seed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
