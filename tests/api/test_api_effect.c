// test_api_effect.c - explosions: who is pushed, what shields, what is refused. How hard: see
// tests/analytic/test_effects.c.
#include "world_fixture.h"

#define W          f->world
#define NAN_       ((plumb_real)NAN)
#define BLAST(...) plumb_world_explode(W, &(plumb_explosion_desc){ __VA_ARGS__ })

static plumb_body disc(plumb_world *w, double x, double y, plumb_shape_desc d)
{
    plumb_body b =
        plumb_body_create(w, &(plumb_body_desc){ .position = { R(x), R(y) }, .no_gravity = true });
    d.kind = PLUMB_CIRCLE;
    d.radius = R(0.5);
    assert_false(plumb_is_null(plumb_shape_create(w, b, &d)));
    return b;
}

static double speed(const plumb_world *w, plumb_body b)
{
    return (double)plumb_vec2_magnitude(plumb_body_velocity(w, b));
}

static void only_what_is_near_is_pushed(void **state)
{
    fixture *f = *state;
    plumb_body near = disc(W, 52, 0, (plumb_shape_desc){ 0 });
    plumb_body half = disc(W, 50, 4.5, (plumb_shape_desc){ 0 });
    plumb_body far = disc(W, 50, -7, (plumb_shape_desc){ 0 });
    assert_int_equal(BLAST(.position = { 50, 0 }, .radius = 3, .falloff = 2, .impulse = 1),
                     PLUMB_OK);
    assert_true(plumb_body_velocity(W, near).x > 1);
    assert_near(plumb_body_velocity(W, near).y, 0, ROUNDED(1e-5));
    assert_true(plumb_body_velocity(W, half).y > 0.2 && speed(W, half) < speed(W, near));
    assert_true(speed(W, far) == 0);
    assert_true(speed(W, f->dynamic) == 0);
    plumb_body_set_velocity(W, near, plumb_v2(0, 0));
    assert_int_equal(BLAST(.position = { 50, 0 }, .radius = 3, .impulse = -1), PLUMB_OK);
    assert_true(plumb_body_velocity(W, near).x < -1); // drawn in
    assert_int_equal(f->errors, 0);
}

// At half of the falloff, half of the strength; sensors, filters, ignored bodies, other types.
static void strength_and_filter(void **state)
{
    fixture *f = *state;
    plumb_body full = disc(W, 60, 0, (plumb_shape_desc){ 0 });
    plumb_body ghost = disc(W, 50, 10, (plumb_shape_desc){ .sensor = true });
    plumb_body other = disc(W, 50, -10, (plumb_shape_desc){ .filter = { .category = 4 } });
    plumb_explosion_desc d = { .position = { 50, 0 }, .radius = 100, .impulse = 1 };
    d.filter.mask = 1;
    assert_int_equal(plumb_world_explode(W, &d), PLUMB_OK);
    double whole = speed(W, full);
    assert_true(whole > 0);
    assert_true(speed(W, ghost) == 0 && speed(W, other) == 0);
    assert_true(speed(W, f->kinematic) == 0);
    plumb_body_set_velocity(W, full, plumb_v2(0, 0));
    d.filter = (plumb_query_filter){ .ignore_body = full };
    assert_int_equal(plumb_world_explode(W, &d), PLUMB_OK);
    assert_true(speed(W, full) == 0 && speed(W, other) > 0);
    d.filter = (plumb_query_filter){ 0 };
    d.radius = 0;
    d.falloff = 19; // the near face is at 9.5
    assert_int_equal(plumb_world_explode(W, &d), PLUMB_OK);
    assert_near(speed(W, full) / whole, 0.5, 0.02);
}

static void a_body_can_get_its_whole_impulse(void **state)
{
    fixture *f = *state;
    plumb_body small = disc(W, 55, 0, (plumb_shape_desc){ 0 });
    plumb_body large = plumb_body_create(
        W, &(plumb_body_desc){ .position = { 50, 8 }, .no_gravity = true, .mass = 3 });
    const plumb_shape_desc box = { .kind = PLUMB_BOX, .half = { 3, 1 } };
    const plumb_shape_desc cap = { .kind = PLUMB_CIRCLE, .radius = 1, .center = { 3, 1 } };
    plumb_shape_create(W, large, &box);
    plumb_shape_create(W, large, &cap);
    assert_int_equal(BLAST(.position = { 50, 0 }, .radius = 20, .impulse = 6, .per_body = true),
                     PLUMB_OK);
    assert_near(speed(W, small) * (double)plumb_body_mass(W, small), 6, ROUNDED(1e-4));
    assert_near(speed(W, large) * 3, 6, ROUNDED(1e-4));
    assert_near(plumb_body_angular_velocity(W, large), 0, 0);
    // Away from the point, through the centre.
    plumb_vec2 arm = plumb_vec2_sub(plumb_body_center(W, large), plumb_v2(50, 0));
    assert_near(plumb_vec2_cross(arm, plumb_body_velocity(W, large)), 0, ROUNDED(1e-4));
}

// The lower box hides the upper one of the same body: together they stop what one front carries.
static void parts_of_a_body_shield_one_another(void **state)
{
    fixture *f = *state;
    double impulse[2];
    for (int k = 0; k < 2; ++k) {
        plumb_body b = plumb_body_create(
            W, &(plumb_body_desc){ .position = { R(200 + 100 * k), 5 }, .no_gravity = true });
        plumb_shape_desc box = { .kind = PLUMB_BOX, .half = { 1, R(0.25) } };
        plumb_shape_create(W, b, &box);
        box.center.y = 1;
        box.half.x = R(0.5);
        if (k == 1) {
            plumb_shape_create(W, b, &box);
        }
        BLAST(.position = { R(200 + 100 * k), 0 }, .radius = 20, .impulse = 1);
        impulse[k] = speed(W, b) * (double)plumb_body_mass(W, b);
    }
    assert_near(impulse[1], impulse[0], ROUNDED(1e-4));
    assert_near(impulse[0], 2, 0.05);
}

static void occlusion_says_what_shields(void **state)
{
    fixture *f = *state;
    // Blast, screen, target in a row; the screen is a wall, a door, a crate.
    const plumb_body_type types[] = { PLUMB_STATIC, PLUMB_KINEMATIC, PLUMB_DYNAMIC };
    for (int screen = 0; screen < 3; ++screen) {
        for (int occlusion = 0; occlusion < 3; ++occlusion) {
            plumb_real x = R(1000 + 100 * (3 * screen + occlusion));
            plumb_body target = disc(W, (double)x + 10, 0, (plumb_shape_desc){ 0 });
            plumb_body cover = plumb_body_create(
                W, &(plumb_body_desc){ .type = types[screen], .position = { x + 5, 0 } });
            plumb_shape_create(W, cover,
                               &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.2), 3 } });
            BLAST(.position = { x, 0 }, .radius = 20, .impulse = 1,
                  .occlusion = (plumb_occlusion)occlusion);
            bool shielded = occlusion == PLUMB_OCCLUDE_ALL ||
                            (occlusion == PLUMB_OCCLUDE_WALLS && types[screen] != PLUMB_DYNAMIC);
            assert_int_equal(speed(W, target) == 0, shielded);
            assert_true(types[screen] != PLUMB_DYNAMIC || speed(W, cover) > 0);
        }
    }
}

static void a_blast_inside_a_body_drives_it_out(void **state)
{
    fixture *f = *state;
    plumb_body b = disc(W, 50, 0, (plumb_shape_desc){ 0 });
    BLAST(.position = { R(49.8), 0 }, .radius = 1, .impulse = 2);
    double mass = (double)plumb_body_mass(W, b);
    assert_near(plumb_body_velocity(W, b).x, 2 / mass, 1e-4); // one width of 1 m
    plumb_body c = disc(W, 70, 0, (plumb_shape_desc){ 0 });
    BLAST(.position = { 70, 0 }, .radius = 1, .impulse = 2);
    assert_true(speed(W, c) == 0); // no way is away
}

static void locked_axes_take_nothing(void **state)
{
    fixture *f = *state;
    plumb_body b = disc(W, 53, 3, (plumb_shape_desc){ 0 });
    plumb_body_set_locks(W, b, (plumb_axis_locks){ .y = true });
    BLAST(.position = { 50, 0 }, .radius = 10, .impulse = 2);
    assert_true(plumb_body_velocity(W, b).x > 0 && plumb_body_velocity(W, b).y == 0);
}

static void explosions_are_refused(void **state)
{
    fixture *f = *state;
    REFUSED(E_NULL, "plumb_world_explode: desc is null; it must be given",
            plumb_world_explode(W, NULL));
    REFUSED(E_RANGE,
            "plumb_world_explode: radius + falloff is 0; it must be above 0 and at most 1e+07",
            BLAST(.impulse = 1));
    REFUSED(E_RANGE, "plumb_world_explode: radius is -1; it must be 0 to 1e+07",
            BLAST(.radius = -1, .falloff = 2));
    REFUSED(E_RANGE, "plumb_world_explode: falloff is -1; it must be 0 to 1e+07",
            BLAST(.radius = 2, .falloff = -1));
    REFUSED(E_NOT_FINITE, "plumb_world_explode: impulse is nan; it must be finite",
            BLAST(.radius = 2, .impulse = NAN_));
    REFUSED(E_NOT_FINITE, "plumb_world_explode: position is (nan, 0); it must be finite",
            BLAST(.radius = 2, .position = { NAN_, 0 }));
    REFUSED(E_RANGE, "plumb_world_explode: occlusion is 3; it must be a plumb_occlusion",
            BLAST(.radius = 2, .occlusion = (plumb_occlusion)3));
    REFUSED(
        E_HANDLE,
        "plumb_world_explode: filter.ignore_body is stale (0:1); it must be a live body or null",
        BLAST(.radius = 2, .filter = { .ignore_body = f->stale }));
    disc(W, 2, 5, (plumb_shape_desc){ .density = R(1e-30) });
    REFUSED(E_NOT_FINITE,
            "plumb_world_explode: impulse is too large; the sum over the body must be finite",
            BLAST(.position = { R(3.5), 5 }, .radius = 10, .impulse = PLUMB_REAL_MAX / 8));
    assert_int_equal(plumb_world_explode(NULL, NULL), PLUMB_E_NULL);
}

// A library without some: test_effects.sh.
static void all_effects_are_in_the_library(void **state)
{
    int count;
    const plumb_effect *effects = plumb_effects(&count);
    (void)state;
    assert_true(count >= 21);
    for (int i = 0; i < count; ++i) {
        assert_true(effects[i].present && effects[i].name[0] != '\0' && effects[i].text[0] != '\0');
        assert_true(i == 0 || strcmp(effects[i].name, effects[i - 1].name) != 0);
    }
    assert_ptr_equal(plumb_effects(NULL), effects);
    assert_string_equal(plumb_result_text(PLUMB_E_UNSUPPORTED),
                        "this library was built without what is asked for");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(only_what_is_near_is_pushed),
        API_TEST(strength_and_filter),
        API_TEST(a_body_can_get_its_whole_impulse),
        API_TEST(parts_of_a_body_shield_one_another),
        API_TEST(occlusion_says_what_shields),
        API_TEST(a_blast_inside_a_body_drives_it_out),
        API_TEST(locked_axes_take_nothing),
        API_TEST(explosions_are_refused),
        cmocka_unit_test(all_effects_are_in_the_library),
    };
    return cmocka_run_group_tests_name("effect", tests, NULL, NULL);
}
