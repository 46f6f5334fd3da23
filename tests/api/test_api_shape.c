// test_api_shape.c - shapes: every kind with its pieces, mass, box and containment; materials of
// shapes; outlines and their cuts.
#include "world_fixture.h"

#define PI 3.14159265358979323846

static const plumb_vec2 triangle[] = { { 0, 0 }, { 4, 0 }, { 0, 3 } };
static const plumb_vec2 ell[] = { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } };
static const plumb_vec2 tilted[] = {
    { 3, 1 }, { 7, 4 }, { 4, 8 }, { 0, 5 }
}; // a 5 x 5 square, 3-4-5

typedef struct expected {
    plumb_shape_desc desc;
    int pieces, corners; // corners of the first piece
    double mass;         // at density 1
    plumb_aabb box;
    plumb_vec2 inside, outside;
} expected;

static const expected kinds[] = {
    { { .kind = PLUMB_CIRCLE, .center = { 1, 2 }, .radius = 2 },
      1,
      1,
      4 * PI,
      { { -1, 0 }, { 3, 4 } },
      { R(2.3), R(3.3) },
      { R(2.6), R(3.6) } },
    { { .kind = PLUMB_CAPSULE, .points = triangle, .count = 2, .radius = 1 },
      1,
      2,
      8 + PI,
      { { -1, -1 }, { 5, 1 } },
      { R(4.9), 0 },
      { R(4.9), R(0.9) } },
    { { .kind = PLUMB_BOX, .half = { 2, 1 }, .center = { 1, 1 } },
      1,
      4,
      8,
      { { -1, 0 }, { 3, 2 } },
      { R(2.9), R(1.9) },
      { R(3.1), 1 } },
    { { .kind = PLUMB_BOX, .half = { 1, 1 }, .radius = R(0.5) },
      1,
      4,
      4 + 4 + PI / 4,
      { { R(-1.5), R(-1.5) }, { R(1.5), R(1.5) } },
      { R(1.3), R(1.3) },
      { R(1.4), R(1.4) } },
    { { .kind = PLUMB_POLYGON, .points = triangle, .count = 3 },
      1,
      3,
      6,
      { { 0, 0 }, { 4, 3 } },
      { 1, 1 },
      { 3, 2 } },
    { { .kind = PLUMB_POLYGON, .points = tilted, .count = 4 },
      1,
      4,
      25,
      { { 0, 1 }, { 7, 8 } },
      { 3, R(1.1) },
      { 2, 1 } },
    { { .kind = PLUMB_OUTLINE, .points = ell, .count = 6 },
      2,
      4,
      3,
      { { 0, 0 }, { 2, 2 } },
      { R(0.5), R(1.5) },
      { R(1.5), R(1.5) } },
    { { .kind = PLUMB_SEGMENT, .points = triangle, .count = 2 },
      1,
      2,
      0,
      { { 0, 0 }, { 4, 0 } },
      { 2, 0 },
      { 2, R(0.1) } },
    { { .kind = PLUMB_CHAIN, .points = triangle, .count = 3 },
      2,
      2,
      0,
      { { 0, 0 }, { 4, 3 } },
      { 2, R(1.5) },
      { 0, 1 } },
    { { .kind = PLUMB_CHAIN, .points = triangle, .count = 3, .closed = true },
      3,
      2,
      0,
      { { 0, 0 }, { 4, 3 } },
      { 0, 1 },
      { 1, 1 } },
};
#define KIND_COUNT (sizeof kinds / sizeof kinds[0])

static void every_kind_has_its_pieces_mass_and_box(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    for (size_t i = 0; i < KIND_COUNT; ++i) {
        const expected *e = &kinds[i];
        plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .position = { 100, 50 } });
        plumb_shape s = plumb_shape_create(w, b, &e->desc);
        assert_true(plumb_shape_valid(w, s));
        assert_int_equal(plumb_shape_get_kind(w, s), e->desc.kind);
        assert_true(plumb_same(plumb_shape_body(w, s), b));
        assert_int_equal(plumb_shape_piece_count(w, s), e->pieces);
        plumb_convex piece;
        assert_int_equal(plumb_shape_piece(w, s, 0, &piece, NULL), PLUMB_OK);
        assert_int_equal(piece.count, e->corners);
        assert_near(piece.radius, e->desc.radius, 0);
        assert_near(plumb_body_mass(w, b), e->mass > 0 ? e->mass : 1, ROUNDED(1e-5));
        plumb_aabb box = plumb_shape_aabb(w, s);
        assert_vec_near(box.min, 100 + e->box.min.x, 50 + e->box.min.y, ROUNDED(1e-4));
        assert_vec_near(box.max, 100 + e->box.max.x, 50 + e->box.max.y, ROUNDED(1e-4));
        plumb_vec2 at = { 100, 50 };
        if (e->desc.kind != PLUMB_CHAIN) { // a slanted line contains what rounding lets it
            assert_true(plumb_shape_contains(w, s, plumb_vec2_add(at, e->inside)));
        }
        assert_false(plumb_shape_contains(w, s, plumb_vec2_add(at, e->outside)));
        assert_int_equal(plumb_shape_destroy(w, s), PLUMB_OK);
        assert_false(plumb_shape_valid(w, s));
        assert_int_equal(plumb_shape_piece_count(w, s), 0);
    }
}

static void pieces_are_what_the_geometry_functions_make(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_convex want;
    plumb_convex got;
    const plumb_shape_desc desc = {
        .kind = PLUMB_BOX, .half = { 2, 1 }, .center = { 3, 4 }, .angle = 1, .radius = R(0.25)
    };
    plumb_shape s = plumb_shape_create(w, f->dynamic, &desc);
    plumb_convex_box(desc.half, desc.center, desc.angle, desc.radius, &want);
    assert_int_equal(plumb_shape_piece(w, s, 0, &got, NULL), PLUMB_OK);
    assert_memory_equal(&got, &want, sizeof want);
    s = plumb_shape_create(
        w, f->dynamic, &(plumb_shape_desc){ .kind = PLUMB_POLYGON, .points = tilted, .count = 4 });
    plumb_convex_polygon(tilted, 4, 0, &want);
    assert_int_equal(plumb_shape_piece(w, s, 0, &got, NULL), PLUMB_OK);
    assert_memory_equal(&got, &want, sizeof want);
}

static double area_of_pieces(const plumb_world *w, plumb_shape s)
{
    double area = 0;
    for (int i = 0; i < plumb_shape_piece_count(w, s); ++i) {
        plumb_convex piece;
        plumb_shape_piece(w, s, i, &piece, NULL);
        area += (double)plumb_outline_area(piece.points, piece.count);
    }
    return area;
}

// Length of all edges that are not cuts.
static double rim_of_pieces(const plumb_world *w, plumb_shape s)
{
    double rim = 0;
    for (int i = 0; i < plumb_shape_piece_count(w, s); ++i) {
        plumb_convex piece;
        uint32_t inner;
        plumb_shape_piece(w, s, i, &piece, &inner);
        assert_true(inner >> piece.count == 0);
        for (int k = 0; k < piece.count; ++k) {
            if (!(inner >> k & 1)) {
                rim += (double)plumb_vec2_distance(piece.points[k],
                                                   piece.points[(k + 1) % piece.count]);
            }
        }
    }
    return rim;
}

static void cuts_are_the_edges_that_are_not_of_the_outline(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_vec2 star[40];
    plumb_vec2 comb[42];
    for (int i = 0; i < 40; ++i) {
        star[i] = plumb_vec2_polar(i % 2 ? R(0.4) : 1, R(i * PI / 20));
        // Teeth that point up. Each gap has a floor of its own height, so that no cut runs along
        // one.
        bool top = i % 4 == 1 || i % 4 == 2;
        comb[i] = plumb_v2(R(i / 4 * 2 + (i % 4 >= 2)), top ? 3 : R(1 + 0.0625 * ((i + 1) / 4)));
    }
    comb[40] = plumb_v2(19, 0);
    comb[41] = plumb_v2(0, 0);
    const struct {
        const plumb_vec2 *points;
        int count;
    } outlines[] = { { star, 40 }, { comb, 42 }, { ell, 6 } };
    for (int i = 0; i < 3; ++i) {
        const plumb_vec2 *points = outlines[i].points;
        int count = outlines[i].count;
        double rim = 0;
        for (int k = 0; k < count; ++k) {
            rim += (double)plumb_vec2_distance(points[k], points[(k + 1) % count]);
        }
        plumb_shape s = plumb_shape_create(
            w, f->dynamic,
            &(plumb_shape_desc){ .kind = PLUMB_OUTLINE, .points = points, .count = count });
        assert_in_range(plumb_shape_piece_count(w, s), 2, count - 2);
        assert_near(area_of_pieces(w, s), fabs((double)plumb_outline_area(points, count)),
                    ROUNDED(1e-4));
        assert_near(rim_of_pieces(w, s), rim, ROUNDED(1e-3));
    }
}

// The foot of a T: its cut lies in line with edges of the outline on both sides of it, and touches
// them.
static void a_cut_in_line_with_the_outline_is_a_cut(void **state)
{
    fixture *f = *state;
    static const plumb_vec2 tee[] = { { 0, 0 }, { 3, 0 }, { 3, 1 }, { 2, 1 },
                                      { 2, 9 }, { 1, 9 }, { 1, 1 }, { 0, 1 } };
    plumb_shape s =
        plumb_shape_create(f->world, f->dynamic,
                           &(plumb_shape_desc){ .kind = PLUMB_OUTLINE, .points = tee, .count = 8 });
    int cuts = 0;
    for (int i = 0; i < plumb_shape_piece_count(f->world, s); ++i) {
        plumb_convex piece;
        uint32_t inner;
        plumb_shape_piece(f->world, s, i, &piece, &inner);
        for (int k = 0; k < piece.count; ++k) {
            plumb_vec2 p = piece.points[k];
            plumb_vec2 q = piece.points[(k + 1) % piece.count];
            if (p.y == 1 && q.y == 1 && plumb_abs(p.x - q.x) == 1 && p.x + q.x == 3) {
                ++cuts;
                assert_true(inner >> k & 1);
            }
        }
    }
    assert_in_range(cuts, 1, 2);
}

static void a_convex_outline_has_one_piece_without_cuts(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_shape s = plumb_shape_create(
        w, f->dynamic, &(plumb_shape_desc){ .kind = PLUMB_OUTLINE, .points = tilted, .count = 4 });
    plumb_convex piece;
    uint32_t inner = 99;
    assert_int_equal(plumb_shape_piece_count(w, s), 1);
    assert_int_equal(plumb_shape_piece(w, s, 0, &piece, &inner), PLUMB_OK);
    assert_int_equal(inner, 0);
}

static void shapes_carry_material_and_user_data(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    int mine;
    plumb_shape s = plumb_shape_create(
        w, f->dynamic,
        &(plumb_shape_desc){
            .kind = PLUMB_CIRCLE, .radius = 1, .material = f->wood, .user_data = &mine });
    assert_true(plumb_same(plumb_shape_material(w, s), f->wood));
    assert_ptr_equal(plumb_shape_user_data(w, s), &mine);
    assert_near(plumb_body_mass(w, f->dynamic), 4 + 2 * PI, ROUNDED(1e-5));
    assert_int_equal(plumb_shape_set_user_data(w, s, NULL), PLUMB_OK);
    assert_null(plumb_shape_user_data(w, s));
    const plumb_material none = PLUMB_NULL_INIT;
    assert_int_equal(plumb_shape_set_material(w, s, none), PLUMB_OK);
    assert_true(plumb_is_null(plumb_shape_material(w, s)));
    assert_near(plumb_body_mass(w, f->dynamic), 4 + 2 * PI, 1e-5); // not revised
    assert_int_equal(plumb_material_destroy(w, f->wood), PLUMB_OK);
}

static void shapes_of_the_world_are_listed(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_shape chain = plumb_shape_create(
        w, f->fixed, &(plumb_shape_desc){ .kind = PLUMB_CHAIN, .points = triangle, .count = 3 });
    plumb_shape shapes[8] = { PLUMB_NULL_INIT };
    assert_int_equal(plumb_world_shapes(w, shapes, 8), 4);
    assert_true(plumb_same(shapes[0], f->box));
    assert_true(plumb_same(shapes[3], chain));
    assert_int_equal(plumb_world_shapes(w, NULL, 0), 4);
    plumb_shape_destroy(w, f->box);
    assert_int_equal(plumb_world_shapes(w, shapes, 1), 3);
    assert_false(plumb_same(shapes[0], f->box));
    assert_int_equal(plumb_world_shapes(NULL, shapes, 8), 0);
}

static void bad_handles_are_answered_with_nothing(void **state)
{
    fixture *f = *state;
    const plumb_shape handles[] = {
        PLUMB_NULL_INIT, { f->stale.entity }, { f->dynamic.entity }, { f->wood.entity }
    };
    for (int i = 0; i < 4; ++i) {
        plumb_shape s = handles[i];
        assert_false(plumb_shape_valid(f->world, s));
        assert_int_equal(plumb_shape_get_kind(f->world, s), 0);
        assert_true(plumb_is_null(plumb_shape_body(f->world, s)));
        assert_true(plumb_is_null(plumb_shape_material(f->world, s)));
        assert_null(plumb_shape_user_data(f->world, s));
        assert_int_equal(plumb_shape_piece_count(f->world, s), 0);
        assert_true(plumb_aabb_is_empty(plumb_shape_aabb(f->world, s)));
        assert_false(plumb_shape_contains(f->world, s, plumb_v2(0, 0)));
    }
}

static void points_are_copied(void **state)
{
    fixture *f = *state;
    plumb_vec2 points[] = { { 0, 0 }, { 1, 0 }, { 0, 1 } };
    plumb_shape s = plumb_shape_create(
        f->world, f->dynamic,
        &(plumb_shape_desc){ .kind = PLUMB_POLYGON, .points = points, .count = 3 });
    memset(points, 0xff, sizeof points);
    plumb_convex piece;
    plumb_shape_piece(f->world, s, 0, &piece, NULL);
    assert_near(plumb_outline_area(piece.points, 3), 0.5, ROUNDED(1e-6));
}

//---- materials -----------------------------------------------------------------------------------

static void materials_are_read_and_changed(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_material_desc d;
    const plumb_material none = PLUMB_NULL_INIT;
    assert_int_equal(plumb_material_settings(w, none, &d), PLUMB_OK);
    assert_near(d.density, 1, 0);
    assert_near(d.friction, 0.6, ROUNDED(1e-7));
    assert_near(d.restitution, 0, 0);
    assert_int_equal(plumb_material_settings(w, f->wood, &d), PLUMB_OK);
    assert_near(d.density, 2, 0);
    plumb_material zero = plumb_material_create(w, &(plumb_material_desc){ 0 });
    assert_int_equal(plumb_material_settings(w, zero, &d), PLUMB_OK);
    assert_true(d.density == 1 && d.restitution == 0 && !d.frictionless);
    assert_near(d.friction, 0.6, 1e-7); // as a shape without material
    d = (plumb_material_desc){ .frictionless = true };
    assert_int_equal(plumb_material_set(w, zero, &d), PLUMB_OK);
    assert_int_equal(plumb_material_settings(w, zero, &d), PLUMB_OK);
    assert_true(d.friction == 0 && d.frictionless); // what was read can be given back
    assert_int_equal(plumb_material_set(w, zero, &d), PLUMB_OK);
    d = (plumb_material_desc){ .density = 3, .friction = 10, .restitution = 1 };
    assert_int_equal(plumb_material_set(w, none, &d), PLUMB_OK);
    assert_int_equal(plumb_material_settings(w, none, &d), PLUMB_OK);
    assert_true(d.density == 3 && d.friction == 10 && d.restitution == 1);
}

static void a_destroyed_material_leaves_the_others_as_they_were(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_material last = plumb_material_create(w, &(plumb_material_desc){ .density = 9 });
    plumb_shape s = plumb_shape_create(
        w, f->fixed, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1, .material = last });
    assert_int_equal(plumb_material_destroy(w, f->wood), PLUMB_OK); // rows of materials move
    plumb_material_desc d;
    assert_int_equal(plumb_material_settings(w, last, &d), PLUMB_OK);
    assert_near(d.density, 9, 0);
    assert_true(plumb_same(plumb_shape_material(w, s), last));
    assert_int_equal(plumb_material_destroy(w, last), PLUMB_E_STATE);
    plumb_shape_destroy(w, s);
    assert_int_equal(plumb_material_destroy(w, last), PLUMB_OK);
    assert_int_equal(plumb_material_settings(w, last, &d), PLUMB_E_HANDLE);
}

// Turned, scaled and in any order: what counts is that points lie within the hull.
static void points_within_the_hull_of_a_polygon_are_warned_of(void **state)
{
    fixture *f = *state;
    const plumb_vec2 star[] = { { 0, 3 },  { R(0.5), R(0.5) },   { 3, 0 },  { R(0.5), R(-0.5) },
                                { 0, -3 }, { R(-0.5), R(-0.5) }, { -3, 0 }, { R(-0.5), R(0.5) } };
    const plumb_vec2 square[] = { { 1, 1 }, { 1, 0 }, { -1, -1 }, { 1, -1 }, { -1, 1 }, { 0, 1 } };
    for (int turn = 0; turn < 12; ++turn) {
        plumb_rot q = plumb_rot_make(R(0.5) * R(turn));
        plumb_vec2 a[8], b[6];
        for (int i = 0; i < 8; ++i) {
            a[i] = plumb_vec2_scale(R(turn + 1) / 4, plumb_rot_apply(q, star[i]));
        }
        for (int i = 0; i < 6; ++i) {
            b[i] = plumb_vec2_scale(R(turn + 1) / 4, plumb_rot_apply(q, square[i]));
        }
        const plumb_shape_desc convex = { .kind = PLUMB_POLYGON, .points = b, .count = 6 };
        const plumb_shape_desc concave = { .kind = PLUMB_POLYGON, .points = a, .count = 8 };
        assert_false(plumb_is_null(plumb_shape_create(f->world, f->dynamic, &convex)));
        assert_int_equal(f->warnings, turn);
        assert_false(plumb_is_null(plumb_shape_create(f->world, f->dynamic, &concave)));
        assert_int_equal(f->warnings, turn + 1);
        assert_string_equal(f->logged,
                            "plumb_shape_create: 4 of 8 points lie within the convex hull "
                            "and are left out; PLUMB_OUTLINE may be concave");
    }
    assert_int_equal(f->errors, 0);
}

static void check_order(const fixture *f, plumb_body body, const plumb_shape *made, int count)
{
    plumb_shape told[8];
    assert_int_equal(plumb_body_shapes(f->world, body, told, 8), count);
    assert_memory_equal(told, made, (size_t)count * sizeof *made);
}

// A shape of any kind that is given the form that it has stays as it is: its body sleeps on.
static void the_same_form_changes_nothing(void **state)
{
    fixture *f = *state;
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; ++i) {
        for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; ++k) {
            plumb_shape_desc desc = kinds[i].desc, other = kinds[k].desc;
            desc.density = other.density = 1; // else lines have no mass to fall asleep with
            plumb_body body = plumb_body_create(
                f->world,
                &(plumb_body_desc){
                    .position = { R(1e4), R(i) }, .mass = 1, .inertia = 1, .asleep = true });
            plumb_shape shape = plumb_shape_create(f->world, body, &desc);
            assert_false(plumb_is_null(shape));
            assert_int_equal(plumb_world_step(f->world, R(0.01)), PLUMB_OK);
            assert_false(plumb_body_is_awake(f->world, body));
            assert_int_equal(plumb_shape_set_geometry(f->world, shape, &other), PLUMB_OK);
            assert_int_equal(plumb_body_is_awake(f->world, body), i != k);
            assert_int_equal(plumb_body_destroy(f->world, body), PLUMB_OK);
        }
    }
}

// Shapes are told in the order in which they were made, whatever form they get, and what is cut off them.
static void other_forms_keep_the_order(void **state)
{
    fixture *f = *state;
    const plumb_shape_desc forms[] = { { .kind = PLUMB_BOX, .half = { 2, 1 } },
                                       { .kind = PLUMB_OUTLINE, .points = ell, .count = 6 },
                                       { .kind = PLUMB_CIRCLE, .radius = 1 } };
    plumb_body body = plumb_body_create(f->world, &(plumb_body_desc){ .position = { 50, 0 } });
    plumb_shape made[5];
    for (int i = 0; i < 5; ++i) {
        made[i] = plumb_shape_create(f->world, body, &forms[i % 3]);
    }
    for (int i = 0; i < 40; ++i) {
        const plumb_shape shape = made[7 * i % 5];
        assert_int_equal(plumb_shape_set_geometry(f->world, shape, &forms[5 * i % 3]), PLUMB_OK);
        check_order(f, body, made, 5);
    }
    assert_int_equal(plumb_body_scale(f->world, body, 2), PLUMB_OK);
    check_order(f, body, made, 5);
    // Those that the line misses stay as they are, the others are made anew.
    const plumb_shape_desc small = { .kind = PLUMB_BOX, .half = { 1, R(0.125) } };
    for (int i = 0; i < 5; i += 2) {
        assert_int_equal(plumb_shape_set_geometry(f->world, made[i], &small), PLUMB_OK);
    }
    const plumb_vec2 at = { 50, R(-0.5) };
    plumb_body parts[8];
    assert_true(plumb_body_cut(f->world, body, at, plumb_v2(1, 0), parts, 8) > 0);
    check_order(f, body, made, 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(points_within_the_hull_of_a_polygon_are_warned_of),
        API_TEST(every_kind_has_its_pieces_mass_and_box),
        API_TEST(pieces_are_what_the_geometry_functions_make),
        API_TEST(cuts_are_the_edges_that_are_not_of_the_outline),
        API_TEST(a_cut_in_line_with_the_outline_is_a_cut),
        API_TEST(a_convex_outline_has_one_piece_without_cuts),
        API_TEST(shapes_carry_material_and_user_data),
        API_TEST(shapes_of_the_world_are_listed),
        API_TEST(bad_handles_are_answered_with_nothing),
        API_TEST(points_are_copied),
        API_TEST(the_same_form_changes_nothing),
        API_TEST(other_forms_keep_the_order),
        API_TEST(materials_are_read_and_changed),
        API_TEST(a_destroyed_material_leaves_the_others_as_they_were),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
