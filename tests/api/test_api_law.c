// test_api_law.c - laws as a user has them: refused calls, what they give at a place, momentum, images, recordings, threads,
// sleep, out of memory. Orbits against closed forms: tests/analytic/test_orbits.c.
#include "harness/heap.h"
#include "harness/recording.h"
#include "harness/sim.h"
#include "world_fixture.h"

#include <stdlib.h>

#define DT R(1.0 / 60)

static plumb_world *make_world(plumb_world_desc desc)
{
    plumb_world *w;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    return w;
}

static plumb_body ball(plumb_world *w, plumb_real x, plumb_real y, plumb_body_desc desc)
{
    desc.position = (plumb_vec2){ x, y };
    const plumb_body b = plumb_body_create(w, &desc);
    plumb_shape_create(w, b, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.2) });
    return b;
}

static void run(plumb_world *w, int steps)
{
    for (int i = 0; i < steps; ++i) {
        assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
    }
}

//---- calls ---------------------------------------------------------------------------------------

static void refused(fixture *f, plumb_law_desc d, plumb_result code, const char *text)
{
    const int before = f->errors;
    assert_true(plumb_is_null(plumb_law_create(f->world, &d)));
    assert_int_equal(plumb_world_error(f->world).code, code);
    assert_non_null(strstr(f->logged, text));
    assert_int_equal(f->errors, before + 1);
}

static void bad_laws_are_refused(void **state)
{
    fixture *f = *state;
    const plumb_real nan = R(NAN), inf = R(INFINITY);
    assert_true(plumb_is_null(plumb_law_create(NULL, &(plumb_law_desc){ 0 })));
    assert_true(plumb_is_null(plumb_law_create(f->world, NULL)));
    assert_int_equal(plumb_world_error(f->world).code, PLUMB_E_NULL);
    refused(f, (plumb_law_desc){ .kind = 5 }, PLUMB_E_RANGE, "kind is 5; it must be 0 to 4");
    refused(f, (plumb_law_desc){ .hold = 2 }, PLUMB_E_RANGE, "hold is 2");
    refused(f, (plumb_law_desc){ .falloff = 5 }, PLUMB_E_RANGE, "falloff is 5");
    refused(f, (plumb_law_desc){ .combine = 2 }, PLUMB_E_RANGE, "combine is 2");
    refused(f, (plumb_law_desc){ .priority = 1000001 }, PLUMB_E_RANGE, "priority is 1000001");
    refused(f, (plumb_law_desc){ .position = { nan, 0 } }, PLUMB_E_NOT_FINITE, "position.x");
    refused(f, (plumb_law_desc){ .position = { 0, R(2e9) } }, PLUMB_E_RANGE, "position.y");
    refused(f, (plumb_law_desc){ .angle = inf }, PLUMB_E_NOT_FINITE, "angle");
    refused(f, (plumb_law_desc){ .vector = { inf, 0 } }, PLUMB_E_NOT_FINITE, "vector.x");
    refused(f, (plumb_law_desc){ .vector = { 0, nan } }, PLUMB_E_NOT_FINITE, "vector.y");
    refused(f, (plumb_law_desc){ .strength = nan }, PLUMB_E_NOT_FINITE, "strength");
    refused(f, (plumb_law_desc){ .strength = R(2e30) }, PLUMB_E_RANGE, "strength");
    refused(f, (plumb_law_desc){ .softening = -1 }, PLUMB_E_RANGE, "softening is -1");
    refused(f, (plumb_law_desc){ .radius = -1 }, PLUMB_E_RANGE, "radius is -1");
    refused(f, (plumb_law_desc){ .half = { -1, 1 } }, PLUMB_E_RANGE, "half.x is -1");
    refused(f, (plumb_law_desc){ .half = { 1, nan } }, PLUMB_E_NOT_FINITE, "half.y");
    refused(f, (plumb_law_desc){ .half = { 1, 0 } }, PLUMB_E_RANGE, "both must be above 0");
    refused(f, (plumb_law_desc){ .half = { 1, 1 }, .radius = 1 }, PLUMB_E_RANGE,
            "a zone is a circle or a box");
    refused(f, (plumb_law_desc){ .kind = PLUMB_LAW_ATTRACTOR, .half = { 1, 1 } }, PLUMB_E_RANGE,
            "only uniform and magnetic laws and formulas have a box");
    refused(f, (plumb_law_desc){ .kind = PLUMB_LAW_MUTUAL, .body = f->dynamic }, PLUMB_E_RANGE,
            "a mutual law has none");
    refused(f, (plumb_law_desc){ .kind = PLUMB_LAW_MAGNETIC, .combine = PLUMB_LAW_REPLACE },
            PLUMB_E_RANGE, "only uniform laws, attractors and formulas do");
    refused(f, (plumb_law_desc){ .body = f->stale }, PLUMB_E_HANDLE, "plumb_law_create: body");
    assert_int_equal(plumb_world_laws(f->world, NULL, 0), 0);
    plumb_world *round = make_world((plumb_world_desc){ .wrap_x = 10 });
    assert_true(plumb_is_null(plumb_law_create(round, &(plumb_law_desc){ 0 })));
    assert_int_equal(plumb_world_error(round).code, PLUMB_E_STATE);
    plumb_world_destroy(round);
}

static void laws_are_made_changed_and_go(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_law_desc d = { .kind = PLUMB_LAW_ATTRACTOR, .body = f->kinematic, .strength = 3 };
    const plumb_law a = plumb_law_create(w, &d);
    const plumb_law b = plumb_law_create(w, &(plumb_law_desc){ .vector = { 1, 2 } });
    plumb_law all[2];
    assert_int_equal(plumb_world_laws(w, all, 2), 2);
    assert_true(plumb_same(all[0], a) && plumb_same(all[1], b));
    assert_int_equal(plumb_entity_get_kind(w, a.entity), PLUMB_KIND_LAW);
    assert_int_equal(plumb_law_settings(w, b, &d), PLUMB_OK);
    assert_true(d.vector.y == 2);
    d.vector.y = 5;
    assert_int_equal(plumb_law_set(w, b, &d), PLUMB_OK);
    assert_int_equal(plumb_law_settings(w, b, &d), PLUMB_OK);
    assert_true(d.vector.y == 5);
    d.vector.y = R(NAN);
    assert_int_equal(plumb_law_set(w, b, &d), PLUMB_E_NOT_FINITE);
    assert_int_equal(plumb_law_set(w, b, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_law_settings(w, b, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_body_destroy(w, f->kinematic), PLUMB_OK); // and its law
    assert_int_equal(plumb_world_laws(w, all, 2), 1);
    assert_true(plumb_same(all[0], b));
    assert_int_equal(plumb_law_destroy(w, a), PLUMB_E_HANDLE);
    assert_int_equal(plumb_law_set(w, a, &d), PLUMB_E_HANDLE);
    assert_int_equal(plumb_law_settings(w, a, &d), PLUMB_E_HANDLE);
    assert_int_equal(plumb_law_destroy(w, b), PLUMB_OK);
    assert_int_equal(plumb_world_laws(w, NULL, 0), 0);
    assert_int_equal(plumb_world_laws(NULL, NULL, 0), 0);
    assert_int_equal(plumb_law_destroy(NULL, b), PLUMB_E_NULL);
}

static void orbits_and_properties_are_checked(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_orbit_desc d;
    assert_int_equal(plumb_world_orbits(w, &d), PLUMB_OK);
    assert_true(d.order == 2 && d.tolerance == 0);
    assert_int_equal(plumb_world_set_orbits(w, &(plumb_orbit_desc){ .order = 3 }), PLUMB_E_RANGE);
    assert_int_equal(plumb_world_set_orbits(w, &(plumb_orbit_desc){ .tolerance = -1 }),
                     PLUMB_E_RANGE);
    assert_int_equal(plumb_world_set_orbits(w, &(plumb_orbit_desc){ .tolerance = R(NAN) }),
                     PLUMB_E_NOT_FINITE);
    const uint64_t before = plumb_world_hash(w);
    assert_int_equal(plumb_world_set_orbits(w, &(plumb_orbit_desc){ 4, R(1e-6) }), PLUMB_OK);
    assert_int_equal(plumb_world_orbits(w, &d), PLUMB_OK);
    assert_true(d.order == 4 && d.tolerance == R(1e-6));
    assert_true(plumb_world_hash(w) != before);
    assert_int_equal(plumb_world_set_orbits(w, NULL), PLUMB_OK);
    assert_true(plumb_world_hash(w) == before); // the default is what was never said
    assert_int_equal(plumb_world_orbits(w, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_world_orbits(NULL, &d), PLUMB_E_NULL);
    assert_int_equal(plumb_world_set_orbits(NULL, &d), PLUMB_E_NULL);
    assert_int_equal(plumb_body_set_charge(w, f->dynamic, R(-2)), PLUMB_OK);
    assert_true(plumb_body_charge(w, f->dynamic) == -2);
    assert_true(plumb_world_hash(w) != before);
    assert_int_equal(plumb_body_set_charge(w, f->dynamic, R(INFINITY)), PLUMB_E_NOT_FINITE);
    assert_int_equal(plumb_body_set_charge(w, f->dynamic, R(2e9)), PLUMB_E_RANGE);
    assert_int_equal(plumb_body_set_charge(w, f->stale, 1), PLUMB_E_HANDLE);
    assert_int_equal(plumb_body_set_attraction(w, f->dynamic, 1), PLUMB_OK);
    assert_true(plumb_body_attraction(w, f->dynamic) == 1);
    assert_int_equal(plumb_body_set_attraction(w, f->dynamic, R(-1)), PLUMB_E_RANGE);
    assert_int_equal(plumb_body_set_attraction(w, f->stale, 1), PLUMB_E_HANDLE);
}

//---- what they give ------------------------------------------------------------------------------

static plumb_vec2 at(const plumb_world *w, plumb_real x, plumb_real y)
{
    return plumb_world_law_at(w, plumb_v2(x, y), plumb_v2(0, 0), 0);
}

static void pulls_fall_off_as_they_say(void **state)
{
    (void)state;
    const double r = 3, soft = 0.5, q = r * r + soft * soft;
    const double expected[] = { r / (q * sqrt(q)), r / q, r / (q * q), r / sqrt(q), r };
    for (int i = 0; i < 5; ++i) {
        plumb_world *w = make_world((plumb_world_desc){ 0 });
        plumb_law_desc d = { .kind = PLUMB_LAW_ATTRACTOR,
                             .falloff = (plumb_falloff)i,
                             .position = { 1, 0 },
                             .strength = 7,
                             .softening = R(soft),
                             .radius = 4 };
        const plumb_law law = plumb_law_create(w, &d);
        assert_near(at(w, 4, 0).x, R(-7 * expected[i]), 1e-6);
        assert_near(at(w, 4, 0).y, -9.81, 1e-6); // with gravity
        assert_near(at(w, R(5.01), 0).x, 0, 0);
        d.strength = -7;
        assert_int_equal(plumb_law_set(w, law, &d), PLUMB_OK);
        assert_near(at(w, 4, 0).x, R(7 * expected[i]), 1e-6);
        plumb_world_destroy(w);
    }
}

static void zones_add_and_replace_by_priority(void **state)
{
    (void)state;
    plumb_world *w = make_world((plumb_world_desc){ 0 });
    plumb_law_desc box = { .vector = { 1, 0 }, .half = { 2, 1 }, .angle = R(1.5707963) };
    plumb_law_create(w, &box);
    assert_near(at(w, 0, R(1.9)).x, 1, 0); // it stands
    assert_near(at(w, R(1.9), 0).x, 0, 0);
    plumb_law_create(
        w, &(plumb_law_desc){
               .vector = { 0, 3 }, .radius = 1, .combine = PLUMB_LAW_REPLACE, .priority = 1 });
    assert_near(at(w, 0, R(0.5)).x, 0, 0);
    assert_near(at(w, 0, R(0.5)).y, 3, 0); // in place of gravity, too
    assert_near(at(w, 0, R(1.5)).y, R(-9.81), 0);
    plumb_law_create(w, &(plumb_law_desc){ .vector = { 5, 0 }, .priority = 1 });
    assert_near(at(w, 0, R(0.5)).x, 5, 0);
    assert_near(at(w, 0, R(1.5)).x, 6, 0);
    const plumb_vec2 bad = plumb_world_law_at(w, plumb_v2(R(NAN), 0), plumb_v2(0, 0), 0);
    assert_true(bad.x == 0 && bad.y == 0);
    assert_int_equal(plumb_world_error(w).code, PLUMB_E_NOT_FINITE);
    // A body does what was told, in free flight and where something touches it.
    const plumb_body flies = ball(w, 0, R(0.5), (plumb_body_desc){ 0 });
    const plumb_body held = ball(w, R(0.5), 0, (plumb_body_desc){ .damping = R(1e-9) });
    plumb_world_step(w, R(0.01));
    const plumb_body both[] = { flies, held };
    for (int i = 0; i < 2; ++i) {
        assert_near(plumb_body_velocity(w, both[i]).x, 0.05, 1e-6);
        assert_near(plumb_body_velocity(w, both[i]).y, 0.03, 1e-6);
    }
    plumb_world_destroy(w);
}

static void categories_choose(void **state)
{
    (void)state;
    plumb_world *w = make_world((plumb_world_desc){ .zero_gravity = true });
    plumb_law_create(w, &(plumb_law_desc){ .vector = { 1, 0 }, .categories = 2 });
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

// Bodies that attract one another, one that carries an attractor, charges, a contact and a joint among them: the sum of
// momenta stays.
static void momentum_is_kept(void **state)
{
    (void)state;
    plumb_world *w = make_world((plumb_world_desc){ .zero_gravity = true });
    plumb_law_create(w, &(plumb_law_desc){ .kind = PLUMB_LAW_MUTUAL, .strength = 2 });
    plumb_law_create(w, &(plumb_law_desc){ .kind = PLUMB_LAW_MUTUAL,
                                           .strength = 3,
                                           .hold = PLUMB_LAW_ON_CHARGE,
                                           .softening = R(0.1) });
    plumb_body bodies[6];
    for (int i = 0; i < 6; ++i) {
        bodies[i] = ball(w, R(0.9 * i), R(0.7 * (i % 3)),
                         (plumb_body_desc){ .velocity = { R(0.3 * i), R(1 - i % 2) },
                                            .attraction = R(i % 2),
                                            .charge = R(0.1 * (i - 2)) });
    }
    plumb_law_create(w, &(plumb_law_desc){ .kind = PLUMB_LAW_ATTRACTOR,
                                           .body = bodies[2],
                                           .strength = 1,
                                           .softening = R(0.3) });
    for (int round = 0; round < 2; ++round) {
        const plumb_energy before = plumb_world_energy(w);
        const double size = fabs(before.momentum_x) + fabs(before.momentum_y);
        run(w, 240);
        const plumb_energy after = plumb_world_energy(w);
        assert_true(fabs(after.momentum_x - before.momentum_x) < 4e-6 * size);
        assert_true(fabs(after.momentum_y - before.momentum_y) < 4e-6 * size);
        plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                                   .body_a = bodies[0],
                                                   .body_b = bodies[3],
                                                   .anchor = plumb_body_center(w, bodies[0]),
                                                   .anchor_b = plumb_body_center(w, bodies[3]) });
    }
    plumb_world_destroy(w);
}

// A push within the step brings a body into reach of what it was far from when the step began: of any of many bodies that carry a law, whether
// it flies or is pushed.
static void who_comes_into_reach_by_surprise_keeps_momentum(void **state)
{
    (void)state;
    for (int i = 0; i < 48; ++i) {
        const int carriers = 1 + i % 12;
        plumb_world *w = make_world((plumb_world_desc){ .zero_gravity = true });
        plumb_law_create(w,
                         &(plumb_law_desc){ .kind = PLUMB_LAW_UNIFORM, .vector = { 0, R(0.5) } });
        for (int k = 0; k < carriers; ++k) {
            const plumb_body carrier = ball(w, R(10 * k), 0, (plumb_body_desc){ 0 });
            plumb_law_create(w, &(plumb_law_desc){ .kind = PLUMB_LAW_ATTRACTOR,
                                                   .body = carrier,
                                                   .strength = 50,
                                                   .softening = R(0.1),
                                                   .radius = 2 });
        }
        const plumb_body guest = ball(w, R(10 * (i / 12 * carriers / 4)), R(2.2),
                                      (plumb_body_desc){ .damping = i % 2 == 0 ? 0 : R(1e-30) });
        plumb_world_set_substeps(w, 8, 1);
        const double push = -3 * (double)plumb_body_mass(w, guest) * 3600;
        double mass = 0;
        const plumb_body_span span = plumb_world_bodies(w);
        for (int k = 0; k < span.count; ++k) {
            mass += (double)plumb_body_mass(w, span.body[k]);
        }
        plumb_body_apply_force_center(w, guest, plumb_v2(0, R(push)));
        run(w, 1);
        const plumb_energy after = plumb_world_energy(w);
        const double due = push / 60 + mass * 0.5 / 60;
        assert_true(fabs(after.momentum_x) < 1e-5 * fabs(push / 60));
        assert_true(fabs(after.momentum_y - due) < 1e-5 * fabs(push / 60));
        plumb_world_destroy(w);
    }
}

//---- the step ------------------------------------------------------------------------------------

// A round planet with boxes on it, a moon, and planets that attract one another far away.
static plumb_world *make_sky(plumb_world_desc desc)
{
    desc.zero_gravity = true;
    plumb_world *w = make_world(desc);
    const plumb_body planet = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(w, planet, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 3 });
    for (int i = 0; i < 12; ++i) {
        const plumb_rot q = plumb_rot_make(R(i / 2));
        const plumb_real r = R(3.3 + 0.55 * (i % 2));
        const plumb_body box = plumb_body_create(
            w, &(plumb_body_desc){ .position = { r * q.c, r * q.s }, .angle = R(i / 2) });
        plumb_shape_create(w, box,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.25), R(0.25) } });
    }
    ball(w, 9, 0, (plumb_body_desc){ .velocity = { 0, R(3.5) }, .charge = 1 });
    for (int i = 0; i < 3; ++i) {
        ball(w, R(40 + 2 * i), R(i % 2), (plumb_body_desc){ .attraction = 1, .no_sleep = true });
    }
    return w;
}

static void add_laws(plumb_world *w, plumb_law out[3])
{
    while (plumb_is_null(
        out[0] = plumb_law_create(
            w, &(plumb_law_desc){ .kind = PLUMB_LAW_ATTRACTOR, .strength = 100, .radius = 20 }))) {
    }
    while (plumb_is_null(
        out[1] = plumb_law_create(
            w, &(plumb_law_desc){ .kind = PLUMB_LAW_MUTUAL, .radius = 30, .strength = 5 }))) {
    }
    while (plumb_is_null(out[2] = plumb_law_create(w, &(plumb_law_desc){ .kind = PLUMB_LAW_MAGNETIC,
                                                                         .strength = R(0.1) }))) {
    }
}

static plumb_world *make_full_sky(plumb_world_desc desc)
{
    plumb_law laws[3];
    plumb_world *w = make_sky(desc);
    add_laws(w, laws);
    return w;
}

static void without_laws_there_is_no_pass(void **state)
{
    (void)state;
    const char *const rows[] = { "laws", "law slots", "law forces", "orbits" };
    plumb_world *w = make_sky((plumb_world_desc){ 0 }), *like = make_sky((plumb_world_desc){ 0 });
    plumb_law laws[3];
    run(w, 1);
    for (int i = 0; i < 4; ++i) {
        assert_false(sim_has_pass(w, rows[i]));
    }
    add_laws(w, laws);
    run(w, 1);
    for (int i = 0; i < 4; ++i) {
        assert_true(sim_has_pass(w, rows[i]));
    }
    for (int i = 0; i < 3; ++i) {
        assert_int_equal(plumb_law_destroy(w, laws[i]), PLUMB_OK);
    }
    run(w, 1);
    assert_false(sim_has_pass(w, "laws"));
    // Laws that act on nobody change nothing.
    run(like, 30);
    plumb_world *other = make_sky((plumb_world_desc){ 0 });
    const plumb_law far = plumb_law_create(
        other, &(plumb_law_desc){ .vector = { 1, 1 }, .radius = 1, .position = { 500, 0 } });
    run(other, 30);
    for (int i = 0; i < 16; ++i) {
        assert_true(plumb_world_bodies(other).center_x[i] == plumb_world_bodies(like).center_x[i]);
    }
    assert_int_equal(plumb_law_destroy(other, far), PLUMB_OK);
    plumb_world_destroy(w), plumb_world_destroy(like), plumb_world_destroy(other);
}

static void threads_and_widths_change_no_bit(void **state)
{
    (void)state;
    const int widths[] = { 4, 8, 16, 8 }, workers[] = { 1, 1, 1, 3 };
    uint64_t first = 0;
    for (int i = 0; i < 4; ++i) {
        plumb_world *w =
            make_full_sky((plumb_world_desc){ .simd_width = widths[i], .workers = workers[i] });
        run(w, 200);
        first = i == 0 ? plumb_world_hash(w) : first;
        assert_true(plumb_world_hash(w) == first);
        plumb_world_destroy(w);
    }
}

static void images_go_on_with_the_same_bits(void **state)
{
    (void)state;
    plumb_world *w = make_full_sky((plumb_world_desc){ 0 });
    plumb_world *other = make_sky((plumb_world_desc){ .workers = 2 });
    plumb_world_set_orbits(w, &(plumb_orbit_desc){ .order = 4 });
    size_t size, later_size;
    run(w, 40);
    void *bytes = sim_save(w, &size);
    run(w, 80);
    const uint64_t end = plumb_world_hash(w);
    void *later = sim_save(w, &later_size);
    assert_int_equal(plumb_world_restore(other, bytes, size), PLUMB_OK);
    plumb_orbit_desc d;
    plumb_world_orbits(other, &d);
    assert_int_equal(d.order, 4);
    assert_int_equal(plumb_world_laws(other, NULL, 0), 3);
    run(other, 80);
    assert_true(plumb_world_hash(other) == end);
    assert_int_equal(plumb_world_restore_trusted(w, bytes, size), PLUMB_OK); // rollback
    run(w, 80);
    assert_true(plumb_world_hash(w) == end);
    const size_t bound = plumb_snapshot_delta_bound(later_size);
    void *delta = malloc(bound), *again = malloc(later_size);
    size_t used, got;
    assert_int_equal(plumb_snapshot_delta(bytes, size, later, later_size, delta, bound, &used),
                     PLUMB_OK);
    assert_int_equal(plumb_snapshot_apply(bytes, size, delta, used, again, later_size, &got),
                     PLUMB_OK);
    assert_true(got == later_size && memcmp(again, later, got) == 0);
    free(bytes), free(later), free(delta), free(again);
    plumb_world_destroy(w), plumb_world_destroy(other);
}

static void recordings_hold_them(void **state)
{
    (void)state;
    plumb_world *w = make_sky((plumb_world_desc){ 0 });
    recording tape = { 0 };
    uint64_t hashes[61];
    plumb_law laws[3];
    assert_int_equal(
        plumb_recorder_start(w, &(plumb_recorder_desc){ .write = to_recording, .context = &tape }),
        PLUMB_OK);
    for (int i = 1; i <= 60; ++i) {
        if (i == 10) {
            add_laws(w, laws);
        } else if (i == 45) {
            assert_int_equal(plumb_law_destroy(w, laws[1]), PLUMB_OK);
        }
        run(w, 1);
        hashes[i] = plumb_world_hash(w);
    }
    plumb_recorder_stop(w);
    plumb_replay *replay;
    assert_int_equal(plumb_replay_open(tape.bytes, tape.size, NULL, &replay), PLUMB_OK);
    for (int i = 1; i <= 60; ++i) {
        assert_int_equal(plumb_replay_step(replay), PLUMB_OK);
        assert_true(plumb_world_hash(plumb_replay_world(replay)) == hashes[i]);
    }
    plumb_replay_close(replay);
    recording_free(&tape);
    plumb_world_destroy(w);
}

// Boxes on a round planet fall asleep, and wake when their law is changed or goes, or somebody comes near who attracts them.
static void what_rests_in_a_steady_law_sleeps(void **state)
{
    (void)state;
    plumb_law laws[3];
    plumb_world *w = make_sky((plumb_world_desc){ 0 });
    add_laws(w, laws);
    run(w, 400);
    assert_int_equal(plumb_world_stats(w).asleep_count, 12);
    plumb_law_desc d;
    plumb_law_settings(w, laws[0], &d);
    d.strength = 50;
    plumb_law_set(w, laws[0], &d);
    run(w, 1);
    assert_int_equal(plumb_world_stats(w).asleep_count, 0);
    run(w, 400);
    assert_int_equal(plumb_world_stats(w).asleep_count, 12);
    const plumb_body comet = ball(w, 0, 14, (plumb_body_desc){ .attraction = 10, .mass = 5 });
    run(w, 2);
    assert_int_equal(plumb_world_stats(w).asleep_count, 0);
    plumb_body_destroy(w, comet);
    run(w, 400);
    assert_int_equal(plumb_world_stats(w).asleep_count, 12);
    plumb_law_destroy(w, laws[0]);
    run(w, 1);
    assert_int_equal(plumb_world_stats(w).asleep_count, 0);
    plumb_world_destroy(w);
}

// What of bodies a user sees.
static double sum_of(plumb_world *w)
{
    const plumb_body_span b = plumb_world_bodies(w);
    double sum = 0;
    for (int i = 0; i < b.count; ++i) {
        sum += (i + 1) * ((double)b.center_x[i] + 3 * (double)b.center_y[i]) + (double)b.vx[i] * 5 +
               7 * (double)b.vy[i] + 11 * (double)b.w[i];
    }
    return sum;
}

static int refused_steps; // of all plays

// Every allocation fails once: the step is refused, moves nothing, and succeeds when it is tried again.
static uint64_t play(heap *h, long fail_at, long *calls, int *refused)
{
    *h = (heap){ .fail_at = -1 };
    plumb_world *w =
        make_sky((plumb_world_desc){ .allocator = heap_allocator(h), .no_sleep = true });
    plumb_law laws[3];
    run(w, 1);
    const long before = h->calls;
    h->fail_at = fail_at < 0 ? -1 : before + fail_at;
    add_laws(w, laws);
    for (int i = 0; i < 40; ++i) {
        const double before_it = sum_of(w);
        plumb_result r;
        while ((r = plumb_world_step(w, DT)) == PLUMB_E_MEMORY) {
            ++refused_steps;
            assert_true(sum_of(w) == before_it);
        }
        assert_int_equal(r, PLUMB_OK);
    }
    *calls = h->calls - before;
    *refused = (int)h->refused;
    const uint64_t hash = plumb_world_hash(w);
    plumb_world_destroy(w);
    assert_int_equal(h->bytes, 0);
    return hash;
}

static void any_allocation_may_fail(void **state)
{
    (void)state;
    refused_steps = 0;
    heap_fail_each(play, 6, 400);
    assert_in_range(refused_steps, 4, 400);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(bad_laws_are_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(laws_are_made_changed_and_go, set_up, tear_down),
        cmocka_unit_test_setup_teardown(orbits_and_properties_are_checked, set_up, tear_down),
        cmocka_unit_test(pulls_fall_off_as_they_say),
        cmocka_unit_test(zones_add_and_replace_by_priority),
        cmocka_unit_test(categories_choose),
        cmocka_unit_test(momentum_is_kept),
        cmocka_unit_test(who_comes_into_reach_by_surprise_keeps_momentum),
        cmocka_unit_test(without_laws_there_is_no_pass),
        cmocka_unit_test(threads_and_widths_change_no_bit),
        cmocka_unit_test(images_go_on_with_the_same_bits),
        cmocka_unit_test(recordings_hold_them),
        cmocka_unit_test(what_rests_in_a_steady_law_sleeps),
        cmocka_unit_test(any_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
