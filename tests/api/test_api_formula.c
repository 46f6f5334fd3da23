// test_api_formula.c - laws that are formulas as a user has them: texts that are none, what they give at a place, zones and
// priorities, energy. What steps make of them: test_api_formula_step.c; motion against closed forms:
// tests/analytic/test_formula_motion.c; programs by themselves: tests/unit/test_formula.c.
#include "formula_fixture.h"

#include "harness/random.h"
#include "harness/trials.h"

#include <stdio.h>

//---- calls ---------------------------------------------------------------------------------------

static void refused(fixture *f, plumb_law_desc d, const char *text)
{
    const int before = f->errors;
    const uint64_t hash = plumb_world_hash(f->world);
    assert_true(plumb_is_null(plumb_law_create(f->world, &d)));
    assert_int_equal(plumb_world_error(f->world).code, PLUMB_E_RANGE);
    if (strstr(f->logged, text) == NULL) {
        print_error("%s\n", f->logged);
        fail();
    }
    assert_int_equal(f->errors, before + 1);
    assert_true(plumb_world_hash(f->world) == hash);
}

static void bad_formulas_are_refused(void **state)
{
    fixture *f = *state;
    static char text[4096];
    refused(f, (plumb_law_desc){ FORMULA }, "a formula needs formula_x, formula_y or potential");
    refused(f, (plumb_law_desc){ .potential = "x" }, "only laws of the kind formula have one");
    refused(f, (plumb_law_desc){ .kind = PLUMB_LAW_MUTUAL, .formula_y = "x" },
            "only laws of the kind formula have one");
    refused(f, (plumb_law_desc){ FORMULA, .potential = "x", .formula_x = "x" },
            "a formula has either");
    refused(f, (plumb_law_desc){ FORMULA, .potential = "2 * xx" },
            "plumb_law_create: potential: unknown name 'xx' at 5; known are x, y, r, t, pi, e");
    refused(f, (plumb_law_desc){ FORMULA, .formula_x = "x", .formula_y = "1 +" },
            "formula_y: expected a number, a name or '(' at 4, not the end");
    refused(f, (plumb_law_desc){ FORMULA, .formula_x = "" }, "formula_x: empty");
    refused(f, (plumb_law_desc){ FORMULA, .potential = "vx^2" }, "'vx' at 1 is a velocity");
    refused(f, (plumb_law_desc){ FORMULA, .potential = "1e999" }, "the number at 1 is too large");
    memset(text, '(', 200);
    refused(f, (plumb_law_desc){ FORMULA, .potential = text }, "nested more than 48 deep");
    memset(text, 'x', sizeof text - 1);
    refused(f, (plumb_law_desc){ FORMULA, .potential = text }, "more than 511 characters");
    refused(f, (plumb_law_desc){ FORMULA, .potential = "x", .half = { 1, 0 } },
            "both must be above 0");
    assert_int_equal(plumb_world_laws(f->world, NULL, 0), 0);
    // What is wrong changes nothing of a law that is there.
    const plumb_law law = add(f->world, (plumb_law_desc){ .potential = "x^2" });
    plumb_law_desc d;
    plumb_law_settings(f->world, law, &d);
    d.potential = "x^";
    assert_int_equal(plumb_law_set(f->world, law, &d), PLUMB_E_RANGE);
    plumb_law_settings(f->world, law, &d);
    assert_string_equal(d.potential, "x^2");
}

static void texts_come_back(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    char text[] = "  2*x ";
    plumb_law_desc d = { .formula_x = text };
    const plumb_law a = add(w, d);
    text[2] = '9'; // the world has a copy
    assert_int_equal(plumb_law_settings(w, a, &d), PLUMB_OK);
    assert_string_equal(d.formula_x, "  2*x ");
    assert_true(d.formula_y == NULL && d.potential == NULL && d.kind == PLUMB_LAW_FORMULA);
    d.formula_x = NULL, d.formula_y = "y";
    assert_int_equal(plumb_law_set(w, a, &d), PLUMB_OK);
    assert_int_equal(plumb_law_settings(w, a, &d), PLUMB_OK);
    assert_true(d.formula_x == NULL && strcmp(d.formula_y, "y") == 0);
    // Texts that are the world's own may be handed back, while the list grows.
    for (int i = 0; i < 40; ++i) {
        assert_int_equal(plumb_law_settings(w, a, &d), PLUMB_OK);
        const plumb_law other = plumb_law_create(w, &d);
        assert_int_equal(plumb_law_settings(w, other, &d), PLUMB_OK);
        assert_string_equal(d.formula_y, "y");
    }
    // The same text as a potential is something else.
    d.potential = d.formula_y, d.formula_y = NULL;
    const uint64_t before = plumb_world_hash(w);
    assert_int_equal(plumb_law_set(w, a, &d), PLUMB_OK);
    assert_true(plumb_world_hash(w) != before);
    assert_near(at(w, 0, 2).y, -9.81 - 1 + 40 * 2, 1e-4);
    assert_int_equal(plumb_law_settings(w, a, &d), PLUMB_OK);
    assert_string_equal(d.potential, "y");
}

// Laws of all kinds come, change their kind, go: each keeps its own text.
static void each_law_has_its_own_text(void **state)
{
    (void)state;
    plumb_world *w = make_world((plumb_world_desc){ 0 });
    plumb_law laws[24];
    char texts[24][64];
    int count = 0;
    uint32_t random = 5;
    const uint32_t turns = trials_count(3000);
    for (uint32_t n = 0; n < turns; ++n) {
        const int which = count > 0 ? (int)(sim_random(&random) % (uint32_t)count) : 0;
        const uint32_t what = sim_random(&random) % 4;
        const bool is_formula = sim_random(&random) % 3 > 0;
        char text[64] = "";
        if (is_formula) {
            snprintf(text, sizeof text, "%u * x", n);
        }
        const plumb_law_desc d = { .kind = is_formula ? PLUMB_LAW_FORMULA : PLUMB_LAW_UNIFORM,
                                   .formula_x = is_formula ? text : NULL };
        if (what == 0 && count < 24) {
            laws[count] = plumb_law_create(w, &d);
            memcpy(texts[count++], text, sizeof text);
        } else if (what == 1 && count > 0) {
            assert_int_equal(plumb_law_destroy(w, laws[which]), PLUMB_OK);
            memmove(&laws[which], &laws[which + 1], (size_t)(count - which - 1) * sizeof *laws);
            memmove(texts[which], texts[which + 1], (size_t)(count - which - 1) * sizeof *texts);
            --count;
        } else if (count > 0) {
            assert_int_equal(plumb_law_set(w, laws[which], &d), PLUMB_OK);
            memcpy(texts[which], text, sizeof text);
        }
        for (int i = 0; i < count; ++i) {
            plumb_law_desc is;
            assert_int_equal(plumb_law_settings(w, laws[i], &is), PLUMB_OK);
            assert_true((is.formula_x != NULL) == (texts[i][0] != 0));
            assert_true(is.formula_x == NULL || strcmp(is.formula_x, texts[i]) == 0);
        }
    }
    plumb_world_destroy(w);
}

//---- what they give ------------------------------------------------------------------------------

static void a_place_has_what_the_formula_says(void **state)
{
    (void)state;
    plumb_world *w = make_world((plumb_world_desc){ .zero_gravity = true });
    plumb_law_desc d = { .position = { 1, 0 }, .formula_x = "-4 * x + vy", .formula_y = "2 - vx" };
    const plumb_law law = add(w, d);
    const plumb_vec2 a = plumb_world_law_at(w, plumb_v2(3, 5), plumb_v2(7, 0.5), 0);
    assert_near(a.x, -7.5, 1e-6);
    assert_near(a.y, -5, 1e-6);
    d.kind = PLUMB_LAW_FORMULA;
    d.formula_x = NULL, d.formula_y = NULL;
    d.potential = "x^2 * y + t";
    assert_int_equal(plumb_law_set(w, law, &d), PLUMB_OK);
    assert_near(at(w, 3, 5).x, -20, 1e-6);
    assert_near(at(w, 3, 5).y, -4, 1e-6);
    // Of charges it is a force.
    d.hold = PLUMB_LAW_ON_CHARGE;
    assert_int_equal(plumb_law_set(w, law, &d), PLUMB_OK);
    assert_near(at(w, 3, 5).x, 0, 0);
    assert_near(plumb_world_law_at(w, plumb_v2(3, 5), plumb_v2(0, 0), R(0.5)).x, -10, 1e-6);
    plumb_world_destroy(w);
}

static void what_is_not_finite_is_nothing(void **state)
{
    (void)state;
    static const char *const texts[] = { "1 / x",           "log(x - 1)",        "sqrt(-1 - x^2)",
                                         "exp(1000 + x)",   "1e200 * 1e200 + x", "0 / x",
                                         "1e31 + x",        "(x - 1)^0.3",       "acos(2 + x)",
                                         "atan2(1 / x, 1)", "tan(1 / x)",        "x^-8" };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; ++i) {
        plumb_world *w = make_world((plumb_world_desc){ .zero_gravity = true });
        add(w, (plumb_law_desc){ .formula_x = texts[i], .formula_y = "3" });
        add(w, (plumb_law_desc){ .formula_y = "1" });
        assert_near(at(w, 0, 0).x, 0, 0);
        assert_near(at(w, 0, 0).y, 1, 0); // neither component
        const plumb_body flies = ball(w, 0, 0, (plumb_body_desc){ 0 });
        const plumb_body pushed = ball(w, 0, 5, (plumb_body_desc){ .damping = R(1e-30) });
        plumb_body many[40];
        for (int k = 0; k < 40; ++k) { // in columns, too
            many[k] = ball(w, 0, R(10 + k), (plumb_body_desc){ 0 });
        }
        for (int step = 0; step < 30; ++step) {
            assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
            assert_near(plumb_body_velocity(w, flies).x, 0, 0);
            assert_near(plumb_body_velocity(w, pushed).x, 0, 0);
            assert_near(plumb_body_velocity(w, many[step]).x, 0, 0);
        }
        assert_near(plumb_body_velocity(w, flies).y, 0.5, 1e-5);
        plumb_world_destroy(w);
    }
}

static void zones_end_and_replace(void **state)
{
    (void)state;
    plumb_world *w = make_world((plumb_world_desc){ 0 });
    add(w, (plumb_law_desc){ .formula_x = "1 + 0 * x", .half = { 2, 1 }, .angle = R(1.5707963) });
    assert_near(at(w, 0, R(1.9)).y, -9.81 + 1, 1e-5); // the box stands, and so do the axes
    assert_near(at(w, R(1.9), 0).y, -9.81, 1e-5);
    add(w, (plumb_law_desc){
               .formula_y = "3", .radius = 1, .combine = PLUMB_LAW_REPLACE, .priority = 2 });
    assert_near(at(w, 0, R(0.5)).x, 0, 0);
    assert_near(at(w, 0, R(0.5)).y, 3, 0); // in place of gravity and of the box
    assert_near(at(w, 0, R(1.5)).y, -8.81, 1e-5);
    add(w, (plumb_law_desc){ .formula_x = "5", .priority = 2 });
    assert_near(at(w, 0, R(0.5)).x, 5, 0);
    // Uniform laws replace formulas, and formulas them.
    plumb_law_create(w, &(plumb_law_desc){ .vector = { 0, 7 },
                                           .position = { 20, 0 },
                                           .radius = 1,
                                           .combine = PLUMB_LAW_REPLACE,
                                           .priority = 3 });
    plumb_law_create(w, &(plumb_law_desc){ .vector = { 0, 9 }, .priority = 1 });
    assert_near(at(w, 20, 0).x, 0, 0);
    assert_near(at(w, 20, 0).y, 7, 0);
    assert_near(at(w, 0, R(0.5)).y, 3, 0);
    assert_near(at(w, 40, 0).y, -9.81 + 9, 1e-5);
    // Bodies have what places have, one by one and in columns.
    const double places[][4] = { { 0, 0.5, 5, 3 }, { 20, 0, 0, 7 }, { 40, 0, 5, -0.81 } };
    for (int many = 0; many < 2; ++many) {
        plumb_body bodies[3][2];
        for (int i = 0; i < 3; ++i) {
            for (int k = 0; k < 2; ++k) {
                bodies[i][k] = plumb_body_create(
                    w, &(plumb_body_desc){ .position = { R(places[i][0]), R(places[i][1]) },
                                           .damping = k == 0 ? 0 : R(1e-30) });
            }
        }
        plumb_world_step(w, R(0.01));
        for (int i = 0; i < 6; ++i) {
            assert_near(plumb_body_velocity(w, bodies[i / 2][i % 2]).x, 0.01 * places[i / 2][2],
                        1e-6);
            assert_near(plumb_body_velocity(w, bodies[i / 2][i % 2]).y, 0.01 * places[i / 2][3],
                        1e-6);
        }
        for (int i = 0; i < 60; ++i) {
            plumb_body_create(w, &(plumb_body_desc){ .position = { R(i % 41), R(0.2) } });
        }
    }
    plumb_world_destroy(w);
}

static void categories_choose(void **state)
{
    (void)state;
    plumb_world *w = make_world((plumb_world_desc){ .zero_gravity = true });
    add(w, (plumb_law_desc){ .formula_x = "1", .categories = 2 });
    const plumb_body a = plumb_body_create(w, &(plumb_body_desc){ 0 });
    const plumb_body b = ball(w, 5, 0, (plumb_body_desc){ 0 });
    plumb_shape_create(w, a,
                       &(plumb_shape_desc){ .kind = PLUMB_CIRCLE,
                                            .radius = R(0.2),
                                            .filter = { .category = 6, .mask = UINT64_MAX } });
    run(w, 60);
    assert_near(plumb_body_velocity(w, a).x, 1, 1e-5);
    assert_near(plumb_body_velocity(w, b).x, 0, 0);
    plumb_world_destroy(w);
}

static void energy_knows_potentials(void **state)
{
    (void)state;
    plumb_world *w = make_world((plumb_world_desc){ .zero_gravity = true });
    plumb_body_create(w, &(plumb_body_desc){ .position = { 3, 4 }, .mass = 2, .charge = 5 });
    plumb_law_desc d = { .position = { 0, 1 }, .potential = "x^2 + 10 * y + 100 * t" };
    const plumb_law law = add(w, d);
    assert_near(plumb_world_energy(w).potential, 2 * (9 + 30), 1e-5);
    plumb_world_set_time(w, 3);
    assert_near(plumb_world_energy(w).potential, 2 * (9 + 30 + 300), 1e-4);
    d.kind = PLUMB_LAW_FORMULA;
    d.hold = PLUMB_LAW_ON_CHARGE;
    plumb_law_set(w, law, &d);
    assert_near(plumb_world_energy(w).potential, 5 * (9 + 30 + 300), 1e-4);
    d.radius = 100; // ends somewhere: none
    plumb_law_set(w, law, &d);
    assert_near(plumb_world_energy(w).potential, 0, 0);
    d.radius = 0, d.potential = "log(x - 3)"; // has none there
    plumb_law_set(w, law, &d);
    assert_near(plumb_world_energy(w).potential, 0, 0);
    d.potential = NULL, d.formula_x = "x";
    plumb_law_set(w, law, &d);
    assert_near(plumb_world_energy(w).potential, 0, 0);
    plumb_world_destroy(w);
}

// What explain --energy adds up: the work of laws is what kinetic energy gains.
static void the_ledger_has_their_work(void **state)
{
    (void)state;
    plumb_world *w = make_world((plumb_world_desc){ .zero_gravity = true, .measure = true });
    add(w, (plumb_law_desc){ .potential = "2 * r^2" });
    const plumb_body b = plumb_body_create(
        w, &(plumb_body_desc){ .position = { 1, 0 }, .mass = 2, .no_sleep = true });
    const plumb_body pushed = plumb_body_create(
        w, &(plumb_body_desc){ .position = { 0, 1 }, .mass = 2, .damping = R(1e-30) });
    (void)b, (void)pushed;
    double work = 0;
    for (int i = 0; i < 30; ++i) {
        run(w, 1);
        work += plumb_world_measures(w)->work[PLUMB_WORK_LAWS].kinetic;
    }
    const plumb_energy e = plumb_world_energy(w);
    assert_near(work, e.kinetic, 1e-3);
    assert_near(e.kinetic + e.potential, 8, 2e-3);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(bad_formulas_are_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(texts_come_back, set_up, tear_down),
        cmocka_unit_test(each_law_has_its_own_text),
        cmocka_unit_test(a_place_has_what_the_formula_says),
        cmocka_unit_test(what_is_not_finite_is_nothing),
        cmocka_unit_test(zones_end_and_replace),
        cmocka_unit_test(categories_choose),
        cmocka_unit_test(energy_knows_potentials),
        cmocka_unit_test(the_ledger_has_their_work),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
