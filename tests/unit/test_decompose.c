// test_decompose.c - plumb_outline_decompose on stars, combs, bowls, spirals, random simple
// polygons, degenerate input, and outlines on a coarse grid with points in line everywhere. Each
// result is checked in full: pieces convex and counter-clockwise, made of the outline's vertices,
// areas adding up to the outline's, no place in two pieces, none outside or missed.

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/random.h"
#include "plumb/geometry.h"

#define PI   3.14159265358979323846
#define R(x) PLUMB_REAL(x)
#define MAX  PLUMB_OUTLINE_MAX_VERTICES

#define SAYS(call, code) assert_int_equal(call, PLUMB_##code)

typedef struct outline {
    plumb_vec2 points[MAX];
    int count;
} outline;

static uint32_t random_state;

static double uniform(double low, double high)
{
    return sim_uniform(&random_state, low, high);
}

static int seed(void **state)
{
    (void)state;
    random_state = 271828u;
    return 0;
}

static void add(outline *o, double x, double y)
{
    assert_true(o->count < MAX);
    o->points[o->count++] = plumb_v2(R(x), R(y));
}

static void add_polar(outline *o, double radius, double angle)
{
    add(o, radius * cos(angle), radius * sin(angle));
}

static outline reversed(const outline *o)
{
    outline r = { .count = o->count };
    for (int i = 0; i < o->count; i++) {
        r.points[i] = o->points[o->count - 1 - i];
    }
    return r;
}

static bool is_vertex(const outline *o, plumb_vec2 p)
{
    for (int i = 0; i < o->count; i++) {
        if (memcmp(&o->points[i], &p, sizeof p) == 0) {
            return true;
        }
    }
    return false;
}

static void check_piece(const outline *o, const plumb_convex_piece *piece)
{
    assert_true(piece->count >= 3 && piece->count <= PLUMB_POLYGON_MAX_VERTICES);
    assert_true(plumb_outline_area(piece->vertices, piece->count) > 0);
    assert_true(plumb_outline_is_convex(piece->vertices, piece->count));
    for (int i = 0; i < piece->count; i++) {
        assert_true(is_vertex(o, piece->vertices[i]));
        plumb_vec2 corner[3] = { piece->vertices[i], piece->vertices[(i + 1) % piece->count],
                                 piece->vertices[(i + 2) % piece->count] };
        assert_true(plumb_outline_area(corner, 3) > 0); // no three in line
    }
}

// Every sampled place is in as many pieces as outlines: one or none. (Which side a place on an
// edge belongs to is decided alike for both, since common edges are the same two points.)
static void check_cover(const outline *o, const plumb_convex_piece *pieces, int count)
{
    plumb_aabb box = plumb_aabb_empty();
    for (int i = 0; i < o->count; i++) {
        box = plumb_aabb_add_point(box, o->points[i]);
    }
    plumb_vec2 c = plumb_aabb_center(box), half = plumb_aabb_extent(box);
    int doubtful = 0;
    for (int k = 0; k < 400; k++) {
        plumb_real x = c.x + half.x * R(uniform(-1.02, 1.02));
        plumb_vec2 p = plumb_v2(x, c.y + half.y * R(uniform(-1.02, 1.02)));
        int held = 0;
        for (int i = 0; i < count; i++) {
            held += plumb_outline_contains(pieces[i].vertices, pieces[i].count, p);
        }
        doubtful += held != (int)plumb_outline_contains(o->points, o->count, p);
    }
    // Left-out points in line may move an edge by a few roundings across a sample.
    assert_true(doubtful <= 1);
}

// What the area may change when points in line are left out that rounding had put beside it: the
// perimeter times 8 roundings of the largest coordinate. Nothing when no two edges are in line.
static double in_line_slack(const outline *o)
{
    double size = 0, perimeter = 0;
    bool in_line = false;
    for (int i = 0; i < o->count; i++) {
        plumb_vec2 a = o->points[i], b = o->points[(i + 1) % o->count];
        plumb_vec2 c = o->points[(i + 2) % o->count];
        size = fmax(size, fmax(fabs((double)a.x), fabs((double)a.y)));
        perimeter += (double)plumb_vec2_distance(a, b);
        in_line = in_line ||
                  plumb_vec2_angle_between(plumb_vec2_sub(b, a), plumb_vec2_sub(c, b)) < R(1e-4);
    }
    return in_line ? 4 * (double)PLUMB_REAL_EPSILON * size * perimeter : 0;
}

// Decomposes in both directions and checks everything; returns the number of pieces.
static int check(const outline *o)
{
    plumb_convex_piece pieces[MAX];
    int count = -1;
    outline back = reversed(o);
    SAYS(plumb_outline_decompose(back.points, back.count, pieces, MAX, &count), OK);
    count = -1;
    SAYS(plumb_outline_decompose(o->points, o->count, pieces, MAX, &count), OK);
    assert_true(count >= 1 && count <= o->count - 2);
    double want = fabs((double)plumb_outline_area(o->points, o->count)), sum = 0;
    for (int i = 0; i < count; i++) {
        check_piece(o, &pieces[i]);
        sum += (double)plumb_outline_area(pieces[i].vertices, pieces[i].count);
    }
    if (!(fabs(sum - want) <= 1e-6 * want + in_line_slack(o))) {
        fail_msg("areas add up to %.9g, not %.9g", sum, want);
    }
    check_cover(o, pieces, count);
    return count;
}

// The same outline elsewhere, with repeated points and points on its edges.
static outline disturbed(const outline *o, double x, double y)
{
    outline r = { .count = 0 };
    for (int i = 0; i < o->count; i++) {
        plumb_vec2 a = o->points[i], b = o->points[(i + 1) % o->count];
        add(&r, (double)a.x + x, (double)a.y + y);
        if (r.count + 2 * (o->count - i) < MAX && i % 3 == 0) {
            add(&r, (double)a.x + x, (double)a.y + y);
            add(&r, ((double)a.x + (double)b.x) / 2 + x, ((double)a.y + (double)b.y) / 2 + y);
        }
    }
    return r;
}

static int check_thoroughly(const outline *o)
{
    outline moved = disturbed(o, 3.7, -11.3);
    check(&moved);
    return check(o);
}

static outline star(int tips, double inner)
{
    outline o = { .count = 0 };
    for (int i = 0; i < 2 * tips; i++) {
        add_polar(&o, i % 2 == 0 ? 1 : inner, PI * i / tips);
    }
    return o;
}

static outline comb(int teeth)
{
    outline o = { .count = 0 };
    add(&o, 0, -1);
    add(&o, 2 * teeth - 1, -1);
    for (int i = teeth - 1; i >= 0; i--) {
        add(&o, 2 * i + 1, 0);
        add(&o, 2 * i + 1, 3);
        add(&o, 2 * i, 3);
        add(&o, 2 * i, 0);
    }
    return o;
}

// A half ring, open at the top.
static outline bowl(int steps)
{
    outline o = { .count = 0 };
    for (int i = 0; i <= steps; i++) {
        add_polar(&o, 2, PI + PI * i / steps);
    }
    for (int i = steps; i >= 0; i--) {
        add_polar(&o, 1.8, PI + PI * i / steps);
    }
    return o;
}

static outline spiral(int steps, double turns)
{
    outline o = { .count = 0 };
    for (int i = 0; i <= steps; i++) {
        double t = turns * 2 * PI * i / steps;
        add_polar(&o, 1 + 0.2 * t, t);
    }
    for (int i = steps; i >= 0; i--) {
        double t = turns * 2 * PI * i / steps;
        add_polar(&o, 0.6 + 0.2 * t, t);
    }
    return o;
}

// Random points joined into a simple polygon: a random tour whose crossings are undone until
// none is left (2-opt; each undoing shortens the tour, so it ends).
static bool cross_properly(plumb_vec2 a, plumb_vec2 b, plumb_vec2 c, plumb_vec2 d)
{
    plumb_vec2 line[3] = { a, b, c };
    double s1 = (double)plumb_outline_area(line, 3);
    line[2] = d;
    double s2 = (double)plumb_outline_area(line, 3);
    plumb_vec2 other[3] = { c, d, a };
    double s3 = (double)plumb_outline_area(other, 3);
    other[2] = b;
    double s4 = (double)plumb_outline_area(other, 3);
    return s1 * s2 < 0 && s3 * s4 < 0;
}

static outline random_simple(int count)
{
    outline o = { .count = 0 };
    for (int i = 0; i < count; i++) {
        double x = uniform(-1, 1);
        add(&o, x, uniform(-1, 1));
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (int i = 0; i < count; i++) {
            for (int k = i + 2; k < count; k++) {
                plumb_vec2 *p = o.points;
                if (cross_properly(p[i], p[i + 1], p[k], p[(k + 1) % count])) {
                    for (int a = i + 1, b = k; a < b; a++, b--) {
                        plumb_vec2 t = p[a];
                        p[a] = p[b];
                        p[b] = t;
                    }
                    changed = true;
                }
            }
        }
    }
    return o;
}

// Outline of a random stretch of skyline on whole numbers: full of right angles, equal heights
// and points in line.
static outline skyline(int width)
{
    outline o = { .count = 0 };
    int heights[64];
    for (int i = 0; i < width; i++) {
        heights[i] = 1 + (int)uniform(0, 3.999);
    }
    add(&o, 0, 0);
    for (int i = 1; i <= width; i++) {
        add(&o, i, 0);
    }
    for (int i = width - 1; i >= 0; i--) {
        add(&o, i + 1, heights[i]);
        add(&o, i, heights[i]); // repeats the next one when heights are equal
    }
    return o;
}

static void convex_outlines_stay_whole(void **state)
{
    (void)state;
    for (int n = 3; n <= 16; n++) {
        outline o = { .count = 0 };
        for (int i = 0; i < n; i++) {
            add_polar(&o, 3, 2 * PI * i / n);
        }
        assert_int_equal(check_thoroughly(&o), 1);
    }
    outline many = { .count = 0 };
    for (int i = 0; i < 256; i++) {
        add_polar(&many, 3, 2 * PI * i / 256);
    }
    int pieces = check(&many); // 254 triangles' worth of corners, 14 a piece at best
    print_message("a regular 256-gon: %d pieces\n", pieces);
    assert_true(pieces >= 19 && pieces <= 40);
}

static void known_shapes_come_out_well(void **state)
{
    (void)state;
    outline l = { .count = 0 };
    add(&l, 0, 0);
    add(&l, 4, 0);
    add(&l, 4, 1);
    add(&l, 1, 1);
    add(&l, 1, 3);
    add(&l, 0, 3);
    assert_int_equal(check_thoroughly(&l), 2);
    outline s5 = star(5, 0.4), s60 = star(60, 0.5), thin = star(40, 0.05);
    int n5 = check_thoroughly(&s5);
    print_message("stars of 5, 60 and 40 thin tips: %d, %d, %d pieces\n", n5,
                  check_thoroughly(&s60), check_thoroughly(&thin));
    assert_true(n5 <= 5);
    outline c10 = comb(10), c60 = comb(60);
    int n10 = check_thoroughly(&c10);
    print_message("combs of 10 and 60 teeth: %d, %d pieces\n", n10, check_thoroughly(&c60));
    assert_true(n10 <= 20);
    outline b24 = bowl(24), b127 = bowl(127);
    int nb = check_thoroughly(&b24);
    print_message("bowls of 24 and 127 steps: %d, %d pieces\n", nb, check(&b127));
    assert_true(nb <= 24);
    outline s = spiral(120, 4), wide = spiral(127, 1);
    print_message("spirals: %d, %d pieces\n", check_thoroughly(&s), check_thoroughly(&wide));
}

static void random_polygons_are_covered(void **state)
{
    (void)state;
    long pieces = 0, corners = 0;
    for (int trial = 0; trial < 150; trial++) {
        outline o = random_simple(4 + trial % 77);
        pieces += trial % 5 == 0 ? check_thoroughly(&o) : check(&o);
        corners += o.count;
    }
    outline large = random_simple(256);
    int n = check(&large);
    print_message("random: %ld pieces for %ld vertices; 256 vertices: %d pieces\n", pieces, corners,
                  n);
}

static void points_in_line_and_repeats_do_no_harm(void **state)
{
    (void)state;
    for (int trial = 0; trial < 200; trial++) {
        outline o = skyline(2 + trial % 60);
        check(&o);
    }
    // Slanted edges with points that rounding has put to either side of the line.
    for (int trial = 0; trial < 100; trial++) {
        outline o = { .count = 0 }, bent = star(3 + trial % 9, 0.5);
        plumb_rot q = plumb_rot_make(R(uniform(-3, 3)));
        for (int i = 0; i < bent.count; i++) {
            plumb_vec2 a = plumb_rot_apply(q, bent.points[i]);
            plumb_vec2 b = plumb_rot_apply(q, bent.points[(i + 1) % bent.count]);
            for (int k = 0; k < 5; k++) {
                plumb_vec2 p = plumb_vec2_lerp(a, b, R(k / 5.0));
                add(&o, (double)p.x, (double)p.y);
            }
        }
        assert_int_equal(check(&o), check(&bent));
    }
}

// Any few points of a small grid, most of which are no outline: whatever passes the check must
// decompose, and whatever does not must be refused.
static void checking_and_decomposing_agree(void **state)
{
    (void)state;
    int simple = 0;
    for (int trial = 0; trial < 30000; trial++) {
        outline o = { .count = 0 };
        int count = 3 + trial % 7;
        for (int i = 0; i < count; i++) {
            double x = floor(uniform(0, 3.999));
            add(&o, x, floor(uniform(0, 3.999)));
        }
        plumb_result checked = plumb_outline_check(o.points, o.count);
        if (checked == PLUMB_OK) {
            simple++;
            check(&o);
        } else {
            plumb_convex_piece pieces[MAX];
            int n;
            SAYS(checked, E_GEOMETRY);
            SAYS(plumb_outline_decompose(o.points, o.count, pieces, MAX, &n), E_GEOMETRY);
        }
    }
    print_message("%d outlines of 30000 are simple\n", simple);
    assert_true(simple > 3000);
}

static void sizes_from_pebble_to_continent(void **state)
{
    (void)state;
    static const double sizes[] = { 1e-3, 1, 1e3, 1e6 };
    outline s = star(7, 0.4);
    int want = check(&s);
    for (int i = 0; i < 4; i++) {
        outline o = { .count = s.count };
        for (int k = 0; k < s.count; k++) {
            o.points[k] = plumb_vec2_scale(R(sizes[i]), s.points[k]);
        }
        assert_int_equal(check(&o), want);
    }
}

static void pieces_become_shapes(void **state)
{
    (void)state;
    // A bowl's pieces as shapes: the masses combine to the outline's.
    outline o = bowl(24);
    plumb_convex_piece pieces[MAX];
    plumb_mass_properties parts[MAX];
    int count = 0;
    SAYS(plumb_outline_decompose(o.points, o.count, pieces, MAX, &count), OK);
    for (int i = 0; i < count; i++) {
        plumb_convex shape;
        SAYS(plumb_convex_polygon(pieces[i].vertices, pieces[i].count, 0, &shape), OK);
        assert_int_equal(shape.count, pieces[i].count);
        parts[i] = plumb_convex_mass(&shape, 600);
    }
    plumb_mass_properties got = plumb_mass_combine(parts, count);
    plumb_mass_properties want = plumb_outline_mass(o.points, o.count, 600);
    assert_near((double)(got.mass - want.mass), 0, 1e-6 * (double)want.mass);
    assert_near((double)(got.inertia - want.inertia), 0, 1e-6 * (double)want.inertia);
    assert_true(plumb_vec2_distance(got.center, want.center) <= R(1e-6));
}

static void wrong_calls_are_refused(void **state)
{
    (void)state;
    outline o = comb(4);
    plumb_convex_piece pieces[MAX], before;
    memset(pieces, 0x5a, sizeof pieces);
    before = pieces[0];
    int count = -7;
    SAYS(plumb_outline_decompose(NULL, 4, pieces, MAX, &count), E_NULL);
    SAYS(plumb_outline_decompose(o.points, o.count, NULL, MAX, &count), E_NULL);
    SAYS(plumb_outline_decompose(o.points, o.count, pieces, MAX, NULL), E_NULL);
    SAYS(plumb_outline_decompose(o.points, 2, pieces, MAX, &count), E_RANGE);
    SAYS(plumb_outline_decompose(o.points, -1, pieces, MAX, &count), E_RANGE);
    SAYS(plumb_outline_decompose(o.points, 257, pieces, MAX, &count), E_CAPACITY);
    plumb_vec2 bow_tie[] = { { 0, 0 }, { 1, 1 }, { 1, 0 }, { 0, 1 } };
    SAYS(plumb_outline_decompose(bow_tie, 4, pieces, MAX, &count), E_GEOMETRY);
    plumb_vec2 same[] = { { 1, 1 }, { 1, 1 }, { 1, 1 }, { 1, 1 } };
    SAYS(plumb_outline_decompose(same, 4, pieces, MAX, &count), E_GEOMETRY);
    plumb_real zero = 0;
    plumb_vec2 bad[] = { { 0, 0 }, { 1, 1 }, { 1 / zero, 0 } };
    SAYS(plumb_outline_decompose(bad, 3, pieces, MAX, &count), E_NOT_FINITE);
    plumb_vec2 far[] = { { 0, 0 }, { R(1e8), 0 }, { 0, 1 } };
    SAYS(plumb_outline_decompose(far, 3, pieces, MAX, &count), E_RANGE);
    assert_int_equal(count, -7);
    SAYS(plumb_outline_decompose(o.points, o.count, pieces, 1, &count), E_CAPACITY);
    assert_memory_equal(&pieces[0], &before, sizeof before);
    int needed = count;
    SAYS(plumb_outline_decompose(o.points, o.count, pieces, needed, &count), OK);
    assert_int_equal(count, needed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(convex_outlines_stay_whole, seed),
        cmocka_unit_test_setup(known_shapes_come_out_well, seed),
        cmocka_unit_test_setup(random_polygons_are_covered, seed),
        cmocka_unit_test_setup(points_in_line_and_repeats_do_no_harm, seed),
        cmocka_unit_test_setup(checking_and_decomposing_agree, seed),
        cmocka_unit_test_setup(sizes_from_pebble_to_continent, seed),
        cmocka_unit_test_setup(pieces_become_shapes, seed),
        cmocka_unit_test_setup(wrong_calls_are_refused, seed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
