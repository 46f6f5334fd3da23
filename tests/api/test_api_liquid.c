// test_api_liquid.c - the liquid as a user has it: refused calls, what is absent costs nothing, images and
// deltas, threads and widths, recordings, out of memory.
#include "harness/heap.h"
#include "harness/recording.h"
#include "harness/sim.h"
#include "world_fixture.h"

#include <stdlib.h>

#define DT R(1.0 / 60)

// A tank with a crate and a plank on water, some of which falls; something beside it that the water never meets.
static plumb_world *make_tank(plumb_world_desc desc)
{
    plumb_world *w;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    const plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    const plumb_vec2 line[] = { { R(-1.1), 4 }, { R(-1.1), 0 }, { R(1.3), 0 }, { R(1.3), 4 } };
    plumb_shape_create(w, ground,
                       &(plumb_shape_desc){ .kind = PLUMB_CHAIN, .points = line, .count = 4 });
    for (int i = 0; i < 2; ++i) {
        const plumb_body crate =
            plumb_body_create(w, &(plumb_body_desc){ .position = { R(i - 0.4), R(1.2 + i) } });
        const plumb_material m =
            plumb_material_create(w, &(plumb_material_desc){ .density = R(i == 0 ? 400 : 700) });
        plumb_shape_create(
            w, crate,
            &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.25), R(0.2) }, .material = m });
    }
    return w;
}

static plumb_result fill(plumb_world *w)
{
    plumb_result r = plumb_liquid_create(w, &(plumb_liquid_desc){ .viscosity = R(0.5) });
    if (r == PLUMB_OK) {
        r = plumb_liquid_add_box(w, plumb_v2(-1, 0), plumb_v2(1, R(0.6)), NULL);
    }
    if (r == PLUMB_OK) {
        const plumb_vec2 drop[] = { { R(-0.2), 3 }, { R(0.6), 3 }, { R(0.2), R(3.6) } };
        r = plumb_liquid_add_shape(w, drop, 3, &(plumb_particle){ .velocity = { 1, 0 } });
    }
    return r;
}

static plumb_world *make_full_tank(plumb_world_desc desc)
{
    plumb_world *w = make_tank(desc);
    assert_int_equal(fill(w), PLUMB_OK);
    return w;
}

static void run(plumb_world *w, int steps)
{
    for (int i = 0; i < steps; ++i) {
        assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
    }
}

static int count_of(const plumb_world *w)
{
    int count;
    plumb_liquid_particles(w, &count);
    return count;
}

//---- calls ---------------------------------------------------------------------------------------

static void bad_settings_are_refused(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_real bad[] = { R(-1), R(NAN), R(INFINITY), PLUMB_REAL_MAX };
    assert_int_equal(plumb_liquid_create(NULL, NULL), PLUMB_E_NULL);
    for (int i = 0; i < 4; ++i) {
        assert_true(plumb_liquid_create(w, &(plumb_liquid_desc){ .spacing = bad[i] }) != PLUMB_OK);
        assert_true(plumb_liquid_create(w, &(plumb_liquid_desc){ .density = bad[i] }) != PLUMB_OK);
        assert_true(plumb_liquid_create(w, &(plumb_liquid_desc){ .viscosity = bad[i] }) !=
                    PLUMB_OK);
        assert_true(plumb_liquid_create(w, &(plumb_liquid_desc){ .tension = bad[i] }) != PLUMB_OK);
        assert_true(plumb_liquid_create(w, &(plumb_liquid_desc){ .friction = bad[i] }) != PLUMB_OK);
    }
    plumb_liquid_desc d;
    assert_int_equal(plumb_liquid_settings(w, &d), PLUMB_E_STATE);
    assert_int_equal(plumb_liquid_set(w, NULL), PLUMB_E_STATE);
    assert_int_equal(plumb_liquid_destroy(w), PLUMB_E_STATE);
    assert_int_equal(plumb_liquid_create(w, NULL), PLUMB_OK);
    assert_int_equal(plumb_liquid_create(w, NULL), PLUMB_E_STATE);
    assert_int_equal(plumb_liquid_settings(w, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_liquid_settings(w, &d), PLUMB_OK);
    assert_true(d.spacing == R(0.05) && d.density == 1000 && d.viscosity == 0 && d.tension == 0);
    assert_true(d.friction == 0);
    assert_int_equal(plumb_liquid_set(w, &(plumb_liquid_desc){ .spacing = 1 }), PLUMB_E_STATE);
    assert_int_equal(plumb_liquid_set(w, &(plumb_liquid_desc){ .tension = -1 }), PLUMB_E_RANGE);
    assert_int_equal(plumb_liquid_set(w, &(plumb_liquid_desc){ .friction = 11 }), PLUMB_E_RANGE);
    assert_int_equal(
        plumb_liquid_set(
            w, &(plumb_liquid_desc){ .density = 3, .viscosity = 2, .tension = 5, .friction = 1 }),
        PLUMB_OK);
    assert_int_equal(plumb_liquid_settings(w, &d), PLUMB_OK);
    assert_true(d.spacing == R(0.05) && d.density == 3 && d.viscosity == 2 && d.tension == 5);
    assert_true(d.friction == 1);
    assert_int_equal(plumb_liquid_destroy(w), PLUMB_OK);
    assert_int_equal(plumb_liquid_create(w, &(plumb_liquid_desc){ .spacing = 1 }), PLUMB_OK);
}

static void a_world_that_wraps_has_none(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .wrap_x = 10 }, &w), PLUMB_OK);
    assert_int_equal(plumb_liquid_create(w, NULL), PLUMB_E_STATE);
    plumb_world_destroy(w);
}

static void bad_particles_are_refused(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_real bad[] = { R(NAN), R(INFINITY), R(-2e9), R(2e9) };
    plumb_particle p = { .position = { 1, 1 } };
    assert_int_equal(plumb_liquid_add(w, &p, 1), PLUMB_E_STATE);
    plumb_liquid_create(w, NULL);
    assert_int_equal(plumb_liquid_add(w, NULL, 1), PLUMB_E_NULL);
    assert_int_equal(plumb_liquid_add(w, &p, -1), PLUMB_E_RANGE);
    for (int i = 0; i < 4; ++i) {
        plumb_particle two[2] = { p, p };
        plumb_real *const members[] = { &two[1].position.x,  &two[1].position.y,
                                        &two[1].velocity.x,  &two[1].velocity.y,
                                        &two[1].gradient[0], &two[1].gradient[3],
                                        &two[1].shear[0],    &two[1].shear[1] };
        for (int k = 0; k < (i < 2 ? 8 : 6); ++k) { // 2e9 Pa is a stress
            const plumb_real good = *members[k];
            *members[k] = bad[i];
            assert_true(plumb_liquid_add(w, two, 2) != PLUMB_OK);
            *members[k] = good;
        }
        assert_true(plumb_liquid_add_box(w, plumb_v2(0, bad[i]), plumb_v2(1, 1), NULL) != PLUMB_OK);
        assert_true(plumb_liquid_add_box(w, plumb_v2(0, 0), plumb_v2(1, 1),
                                         &(plumb_particle){ .velocity = { bad[i], 0 } }) !=
                    PLUMB_OK);
        const plumb_vec2 three[] = { { 0, 0 }, { 1, 0 }, { 0, bad[i] } };
        assert_true(plumb_liquid_add_shape(w, three, 3, NULL) != PLUMB_OK);
        assert_int_equal(plumb_liquid_remove(w, plumb_v2(0, bad[i]), plumb_v2(1, 1)), -1);
    }
    assert_int_equal(plumb_liquid_add_box(w, plumb_v2(1, 0), plumb_v2(0, 1), NULL), PLUMB_E_RANGE);
    assert_int_equal(plumb_liquid_add_box(w, plumb_v2(0, 0), plumb_v2(1000, 1000), NULL),
                     PLUMB_E_RANGE); // too many
    assert_int_equal(count_of(w), 0);
    assert_int_equal(plumb_liquid_add(w, &p, 1), PLUMB_OK);
    assert_int_equal(plumb_liquid_add_box(w, plumb_v2(0, 0), plumb_v2(R(0.5), R(0.25)), NULL),
                     PLUMB_OK);
    assert_int_equal(count_of(w), 1 + 10 * 5);
    assert_int_equal(plumb_liquid_remove(w, plumb_v2(0, 0), plumb_v2(R(0.25), 1)), 25);
    const plumb_particle *left = plumb_liquid_particles(w, NULL);
    assert_true(left[0].position.x == 1 && left[1].position.x > R(0.25));
}

static const plumb_particle jet = { .velocity = { 3, 0 } };

// A source: nothing where it is full; a jet of 3 m/s and 0.4 m for a second is 1.2 m^2, whatever the steps.
static void refilling_keeps_a_shape_full(void **state)
{
    (void)state;
    const plumb_vec2 box[] = { { 0, 0 }, { R(0.2), 0 }, { R(0.2), R(0.4) }, { 0, R(0.4) } };
    const plumb_vec2 bad[] = { { 0, 0 }, { R(NAN), 0 }, { 0, 1 } };
    for (int hz = 30; hz <= 240; hz *= 2) {
        plumb_world *w;
        assert_int_equal(plumb_world_create(&(plumb_world_desc){ .zero_gravity = true }, &w),
                         PLUMB_OK);
        assert_int_equal(plumb_liquid_refill(w, box, 4, &jet), PLUMB_E_STATE);
        plumb_liquid_create(w, NULL);
        assert_int_equal(plumb_liquid_refill(NULL, box, 4, &jet), PLUMB_E_NULL);
        assert_int_equal(plumb_liquid_refill(w, NULL, 4, &jet), PLUMB_E_NULL);
        assert_int_equal(plumb_liquid_refill(w, box, 2, &jet), PLUMB_E_RANGE);
        assert_int_equal(plumb_liquid_refill(w, bad, 3, &jet), PLUMB_E_NOT_FINITE);
        assert_int_equal(
            plumb_liquid_refill(w, box, 4, &(plumb_particle){ .velocity = { 3, R(INFINITY) } }),
            PLUMB_E_NOT_FINITE);
        assert_int_equal(plumb_liquid_refill(w, box, 4, &jet), PLUMB_OK);
        assert_int_equal(count_of(w), 32);
        assert_int_equal(plumb_liquid_refill(w, box, 4, &jet), PLUMB_OK);
        assert_int_equal(count_of(w), 32);
        for (int i = 0; i < hz; ++i) {
            assert_int_equal(plumb_world_step(w, 1 / (plumb_real)hz), PLUMB_OK);
            assert_int_equal(plumb_liquid_refill(w, box, 4, &jet), PLUMB_OK);
        }
        print_message("%d Hz: %d particles\n", hz, count_of(w) - 32);
        assert_in_range(count_of(w) - 32, 480 * 0.85, 480 * 1.1);
        plumb_world_destroy(w);
    }
}

// The fastest, densest and farthest that calls allow: nothing that is not finite comes of it.
static void extremes_stay_finite(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    assert_int_equal(
        plumb_liquid_create(
            w, &(plumb_liquid_desc){ .spacing = R(0.2), .density = R(1e9), .viscosity = R(1e9) }),
        PLUMB_OK);
    for (int i = 0; i < 50; ++i) {
        const plumb_real s = i % 2 == 0 ? R(1e6) : R(-1e6);
        const plumb_particle p = { { R(0.001 * i), R(i % 3) },
                                   { s, -s },
                                   { R(1e9), R(-1e9), R(1e9), R(1e9) },
                                   0,
                                   7,
                                   { 0, 0 } };
        assert_int_equal(plumb_liquid_add(w, &p, 1), PLUMB_OK);
    }
    const plumb_particle far = { .position = { R(1e8), R(-1e8) } };
    assert_int_equal(plumb_liquid_add(w, &far, 1), PLUMB_OK);
    run(w, 60);
    const plumb_particle *p = plumb_liquid_particles(w, NULL);
    for (int i = 0; i < 51; ++i) {
        const plumb_real *v = (const plumb_real *)&p[i];
        for (size_t k = 0; k < sizeof *p / sizeof *v; ++k) {
            assert_true(v[k] - v[k] == 0);
        }
    }
    const plumb_vec2 at = plumb_body_position(w, f->dynamic);
    assert_true(at.x - at.x == 0 && at.y - at.y == 0);
}

// Bodies that fly as no float can tell, weigh nothing or all, and a gravity beyond all: particles stay within the bounds
// of what may be added.
static void bodies_beyond_bounds_leave_it_finite(void **state)
{
    (void)state;
    const plumb_real most = PLUMB_REAL_MAX / 4;
    plumb_world *w = make_full_tank((plumb_world_desc){ 0 });
    const plumb_real densities[] = { R(1e-9), R(1e9), 1 };
    for (int i = 0; i < 3; ++i) {
        const plumb_body b = plumb_body_create(
            w, &(plumb_body_desc){ .type = i == 2 ? PLUMB_KINEMATIC : PLUMB_DYNAMIC,
                                   .position = { R(0.3 * i - 0.3), R(0.3) } });
        const plumb_material m =
            plumb_material_create(w, &(plumb_material_desc){ .density = densities[i] });
        plumb_shape_create(
            w, b,
            &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.2), R(0.1) }, .material = m });
        plumb_body_set_velocity(w, b, plumb_v2(i == 1 ? -most : most, most));
        plumb_body_set_angular_velocity(w, b, most);
    }
    for (int k = 0; k < 3; ++k) {
        plumb_world_set_gravity(w, plumb_v2(0, k == 1 ? -most : R(-9.81)));
        for (int i = 0; i < 10; ++i) {
            plumb_world_step(w, DT); // bodies may be taken out: that is told
        }
        int count;
        const plumb_particle *p = plumb_liquid_particles(w, &count);
        for (int i = 0; i < count; ++i) {
            assert_true(p[i].position.x - p[i].position.x == 0);
            assert_true(p[i].position.y - p[i].position.y == 0);
            assert_in_range((int64_t)p[i].velocity.x + 1000000, 0, 2000000);
            assert_in_range((int64_t)p[i].velocity.y + 1000000, 0, 2000000);
        }
    }
    plumb_world_destroy(w);
}

//---- what is absent ------------------------------------------------------------------------------

static void without_particles_there_is_no_pass(void **state)
{
    (void)state;
    plumb_world *w = make_tank((plumb_world_desc){ 0 }), *like = make_tank((plumb_world_desc){ 0 });
    run(w, 1);
    assert_false(sim_has_pass(w, "liquid"));
    assert_false(sim_has_pass(w, "liquid motion"));
    assert_int_equal(fill(w), PLUMB_OK);
    run(w, 1);
    assert_true(sim_has_pass(w, "liquid"));
    assert_true(sim_has_pass(w, "liquid motion"));
    assert_int_equal(plumb_liquid_destroy(w), PLUMB_OK);
    run(w, 1);
    assert_false(sim_has_pass(w, "liquid"));
    run(like, 3);
    // A liquid without particles moves nothing, and one that is gone has left nothing.
    plumb_liquid_create(like, NULL);
    run(like, 30);
    plumb_liquid_destroy(like);
    plumb_world *never = make_tank((plumb_world_desc){ 0 });
    run(never, 33);
    assert_true(plumb_world_hash(like) == plumb_world_hash(never));
    plumb_world_destroy(w);
    plumb_world_destroy(like);
    plumb_world_destroy(never);
}

//---- the same bits -------------------------------------------------------------------------------

static void threads_and_widths_change_no_bit(void **state)
{
    (void)state;
    const int widths[] = { 4, 8, 16, 8 }, workers[] = { 1, 1, 1, 3 };
    uint64_t hashes[4];
    for (int i = 0; i < 4; ++i) {
        plumb_world *w =
            make_full_tank((plumb_world_desc){ .simd_width = widths[i], .workers = workers[i] });
        run(w, 120);
        hashes[i] = plumb_world_hash(w);
        assert_true(hashes[i] == hashes[0]);
        plumb_world_destroy(w);
    }
}

// A dam of 8,000 particles with crates in it: enough for every pass to be shared out.
static void large_pools_are_shared_out_without_a_bit(void **state)
{
    (void)state;
    const int workers[] = { 1, 2, 3 };
    uint64_t hashes[3];
    for (int k = 0; k < 3; ++k) {
        plumb_world *w;
        assert_int_equal(plumb_world_create(&(plumb_world_desc){ .workers = workers[k] }, &w),
                         PLUMB_OK);
        const plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
        const plumb_vec2 corners[] = { { 0, 6 }, { 0, 0 }, { 8, 0 }, { 8, 6 } };
        plumb_shape_create(w, ground,
                           &(plumb_shape_desc){
                               .kind = PLUMB_CHAIN, .points = (plumb_vec2 *)corners, .count = 4 });
        for (int i = 0; i < 12; ++i) {
            const plumb_body crate = plumb_body_create(
                w, &(plumb_body_desc){ .type = PLUMB_DYNAMIC,
                                       .position = { R(0.5) + R(0.6) * (plumb_real)i, 3 } });
            plumb_shape_create(
                w, crate, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.2), R(0.2) } });
        }
        plumb_liquid_create(w, NULL);
        plumb_liquid_add_box(w, plumb_v2(0, 0), plumb_v2(8, R(2.5)),
                             &(plumb_particle){ .velocity = { 1, 0 } });
        assert_int_equal(count_of(w), 8000);
        run(w, 30);
        hashes[k] = plumb_world_hash(w);
        assert_true(hashes[k] == hashes[0]);
        plumb_world_destroy(w);
    }
}

//---- what spills ---------------------------------------------------------------------------------

// A particle alone is a point: its parabola is exact, and it comes to rest where it lands.
static void a_particle_alone_flies_and_lands(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ 0 }, &w), PLUMB_OK);
    const plumb_body ground = plumb_body_create(
        w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { 100, R(-31) } });
    plumb_shape_create(w, ground,
                       &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 200, R(0.1) } });
    plumb_liquid_create(w, NULL);
    const plumb_particle drop = { .position = { 0, 10 }, .velocity = { 7, 3 } };
    assert_int_equal(plumb_liquid_add(w, &drop, 1), PLUMB_OK);
    run(w, 120);
    const plumb_particle *p = plumb_liquid_particles(w, NULL);
    assert_true(fabs((double)p->position.x - 14) < 1e-4);
    assert_true(fabs((double)p->position.y - (10 + 3 * 2 - 9.81 * 2)) < 1e-4);
    run(w, 300); // it meets the ground, a plate thinner than its way in a step
    p = plumb_liquid_particles(w, NULL);
    assert_true(fabs((double)p->position.y + 30.9) < 0.01);
    assert_true(fabs((double)p->velocity.y) < 1e-3 && fabs((double)p->velocity.x - 7) < 1e-3);
    plumb_world_destroy(w);
}

// 800 particles run off a table, and fall for 6 s. They would take up to four tiles each, 80 kB.
static void what_spills_takes_no_room(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ 0 }, &w), PLUMB_OK);
    const plumb_body table = plumb_body_create(
        w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { 0, R(-0.5) } });
    plumb_shape_create(w, table, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 1, R(0.5) } });
    plumb_liquid_create(w, NULL);
    plumb_liquid_add_box(w, plumb_v2(-1, 0), plumb_v2(1, 1), NULL);
    assert_int_equal(count_of(w), 800);
    run(w, 20);
    const double before = (double)plumb_world_stats(w).peak_bytes;
    run(w, 340);
    const double most = (double)plumb_world_stats(w).peak_bytes;
    int count, fallen = 0;
    const plumb_particle *p = plumb_liquid_particles(w, &count);
    for (int i = 0; i < count; ++i) {
        fallen += p[i].position.y < -20;
    }
    print_message("%d of %d particles fell from the table; memory grew from %.1f to %.1f MB\n",
                  fallen, count, before * 1e-6, most * 1e-6);
    assert_true(fallen > 0.9 * count);
    assert_true(most < 16 * before);
    plumb_world_destroy(w);
}

static void images_go_on_with_the_same_bits(void **state)
{
    (void)state;
    plumb_world *w = make_full_tank((plumb_world_desc){ 0 });
    plumb_world *other = make_tank((plumb_world_desc){ .workers = 2 });
    size_t size, later_size;
    run(w, 40); // the drop is in the midst of its splash
    void *bytes = sim_save(w, &size);
    run(w, 40);
    const uint64_t end = plumb_world_hash(w);
    void *later = sim_save(w, &later_size);
    assert_int_equal(plumb_world_restore(other, bytes, size), PLUMB_OK);
    run(other, 40);
    assert_true(plumb_world_hash(other) == end);
    assert_int_equal(plumb_world_restore_trusted(w, bytes, size), PLUMB_OK); // rollback
    run(w, 40);
    assert_true(plumb_world_hash(w) == end);
    // Deltas.
    const size_t bound = plumb_snapshot_delta_bound(later_size);
    void *delta = malloc(bound), *again = malloc(later_size);
    size_t used, got;
    assert_int_equal(plumb_snapshot_delta(bytes, size, later, later_size, delta, bound, &used),
                     PLUMB_OK);
    assert_int_equal(plumb_snapshot_apply(bytes, size, delta, used, again, later_size, &got),
                     PLUMB_OK);
    assert_true(got == later_size && memcmp(again, later, got) == 0);
    // One where there is no liquid.
    plumb_world *dry = make_tank((plumb_world_desc){ 0 });
    size_t dry_size;
    void *dry_bytes = sim_save(dry, &dry_size);
    assert_int_equal(plumb_world_restore(w, dry_bytes, dry_size), PLUMB_OK);
    assert_int_equal(count_of(w), 0);
    run(w, 20);
    run(dry, 20);
    assert_true(plumb_world_hash(w) == plumb_world_hash(dry));
    free(bytes), free(later), free(delta), free(again), free(dry_bytes);
    plumb_world_destroy(w), plumb_world_destroy(other), plumb_world_destroy(dry);
}

static void recordings_hold_it(void **state)
{
    (void)state;
    plumb_world *w = make_tank((plumb_world_desc){ 0 });
    recording tape = { 0 };
    uint64_t hashes[61];
    assert_int_equal(
        plumb_recorder_start(w, &(plumb_recorder_desc){ .write = to_recording, .context = &tape }),
        PLUMB_OK);
    for (int i = 1; i <= 60; ++i) {
        if (i == 10) {
            assert_int_equal(fill(w), PLUMB_OK);
        }
        if (i == 45) {
            assert_in_range(plumb_liquid_remove(w, plumb_v2(-1, 0), plumb_v2(0, 1)), 50, 1000);
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
    assert_int_equal(plumb_replay_seek(replay, 33), PLUMB_OK);
    assert_true(plumb_world_hash(plumb_replay_world(replay)) == hashes[33]);
    plumb_replay_close(replay);
    recording_free(&tape);
    plumb_world_destroy(w);
}

//---- out of memory -------------------------------------------------------------------------------

static void add_soft_bodies(plumb_world *w)
{
    const plumb_vec2 square[4] = {
        { R(0.1), R(0.4) }, { R(0.6), R(0.4) }, { R(0.6), R(0.9) }, { R(0.1), R(0.9) }
    };
    const plumb_jelly_desc jelly = { .points = square, .count = 4, .spacing = R(0.25) };
    const plumb_skin_desc skin = { .center = { R(-0.5), R(0.8) }, .radius = R(0.25), .nodes = 12 };
    assert_false(plumb_is_null(plumb_jelly_create(w, &jelly)));
    assert_false(plumb_is_null(plumb_skin_create(w, &skin)));
}

// Every allocation of filling and stepping fails once: the call is refused, changes nothing, and succeeds
// when it is tried again. Soft bodies take memory where a refused step has looked at pairs, and may count as rest for bodies
// that could sleep: there what comes of it is the same.
static uint64_t play(heap *h, bool soft, long fail_at, long *calls, int *refused)
{
    *h = (heap){ .fail_at = -1 };
    plumb_world *w =
        make_tank((plumb_world_desc){ .allocator = heap_allocator(h), .no_sleep = soft });
    if (soft) {
        add_soft_bodies(w);
    }
    run(w, 1);
    const long before = h->calls;
    h->fail_at = fail_at < 0 ? -1 : before + fail_at;
    plumb_result r;
    while ((r = plumb_liquid_create(w, NULL)) == PLUMB_E_MEMORY) {
        ++*refused;
    }
    assert_int_equal(r, PLUMB_OK);
    while ((r = plumb_liquid_add_box(w, plumb_v2(-1, 0), plumb_v2(1, R(0.6)), NULL)) ==
           PLUMB_E_MEMORY) {
        ++*refused;
        assert_int_equal(count_of(w), 0);
    }
    for (int i = 0; i < 40; ++i) {
        const uint64_t hash = plumb_world_hash(w);
        while ((r = plumb_world_step(w, DT)) == PLUMB_E_MEMORY) {
            ++*refused;
            assert_true(soft || plumb_world_hash(w) == hash);
        }
        assert_int_equal(r, PLUMB_OK);
    }
    *calls = h->calls - before;
    const uint64_t hash = plumb_world_hash(w);
    plumb_world_destroy(w);
    assert_int_equal(h->bytes, 0);
    return hash;
}

static uint64_t play_water(heap *h, long fail_at, long *calls, int *refused)
{
    return play(h, false, fail_at, calls, refused);
}

static uint64_t play_soft(heap *h, long fail_at, long *calls, int *refused)
{
    return play(h, true, fail_at, calls, refused);
}

static void any_allocation_may_fail(void **state)
{
    (void)state;
    heap_fail_each(play_water, 12, 400);
    heap_fail_each(play_soft, 12, 400);
}

// What the liquid put on bodies in a step that went well is no business of a later one that is refused.
static void forces_of_a_step_are_not_taken_back_by_the_next(void **state)
{
    (void)state;
    static heap h;
    h = (heap){ .fail_at = -1 };
    plumb_world *w = make_full_tank((plumb_world_desc){ .allocator = heap_allocator(&h) });
    run(w, 60);
    const plumb_body crate = plumb_world_bodies(w).body[0];
    assert_int_equal(plumb_body_apply_force_center(w, crate, plumb_v2(1, 1)), PLUMB_OK);
    run(w, 1);
    assert_true(plumb_liquid_remove(w, plumb_v2(-100, -100), plumb_v2(100, 100)) > 0);
    for (int i = 0; i < 200; ++i) { // a step that needs room
        const plumb_body ball =
            plumb_body_create(w, &(plumb_body_desc){ .position = { R(0.01 * i), 2 } });
        plumb_shape_create(w, ball, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.5) });
    }
    heap_fail(&h, 0);
    assert_int_equal(plumb_world_step(w, DT), PLUMB_E_MEMORY);
    assert_true(plumb_body_force(w, crate).x == 0 && plumb_body_force(w, crate).y == 0);
    plumb_world_destroy(w);
}

static void a_pool_at_rest_allocates_nothing(void **state)
{
    (void)state;
    static heap h;
    h = (heap){ .fail_at = -1 };
    plumb_world *w = make_full_tank((plumb_world_desc){ .allocator = heap_allocator(&h) });
    run(w, 300);
    const long calls = h.calls;
    run(w, 60);
    assert_int_equal(h.calls, calls);
    plumb_world_destroy(w);
}

//---- phases --------------------------------------------------------------------------------------

static void phases_are_set_and_told(void **state)
{
    (void)state;
    plumb_world *w;
    int count = 9;
    assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
    const plumb_liquid_phase two[] = { { .density = 800, .viscosity = 1, .friction = R(0.5) },
                                       { .viscosity = 0 } };
    assert_int_equal(plumb_liquid_set_phases(NULL, two, 2), PLUMB_E_NULL);
    assert_int_equal(plumb_liquid_set_phases(w, two, 2), PLUMB_E_STATE);
    assert_null(plumb_liquid_phases(w, &count));
    assert_int_equal(count, 0);
    plumb_liquid_create(w, &(plumb_liquid_desc){ .density = 500 });
    assert_int_equal(plumb_liquid_set_phases(w, NULL, 1), PLUMB_E_NULL);
    assert_int_equal(plumb_liquid_set_phases(w, two, -1), PLUMB_E_RANGE);
    assert_int_equal(plumb_liquid_set_phases(w, two, PLUMB_LIQUID_MAX_PHASES + 1), PLUMB_E_RANGE);
    const plumb_real bad[] = { -1, R(NAN), R(INFINITY), R(0.4), R(6e5) };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        const plumb_liquid_phase p = { .density = bad[i] };
        const plumb_liquid_phase q = { .viscosity = i < 3 ? bad[i] : R(1e10) };
        const plumb_liquid_phase r = { .friction = i < 3 ? bad[i] : R(10.5) };
        assert_true(plumb_liquid_set_phases(w, &r, 1) != PLUMB_OK);
        assert_true(plumb_liquid_set_phases(w, &p, 1) != PLUMB_OK);
        assert_true(plumb_liquid_set_phases(w, &q, 1) != PLUMB_OK);
    }
    assert_null(plumb_liquid_phases(w, NULL));
    assert_int_equal(plumb_liquid_set_phases(w, two, 2), PLUMB_OK);
    const plumb_liquid_phase *told = plumb_liquid_phases(w, &count);
    assert_int_equal(count, 2);
    assert_true(told[0].density == 800 && told[0].viscosity == 1 && told[0].friction == R(0.5));
    assert_true(told[1].density == 1000 && told[1].viscosity == 0 && told[1].friction == 0);
    // The first must stay within a thousandth to a thousand times each.
    assert_int_equal(plumb_liquid_set(w, &(plumb_liquid_desc){ .density = R(0.5) }), PLUMB_E_RANGE);
    assert_int_equal(plumb_liquid_set(w, &(plumb_liquid_desc){ .density = 2 }), PLUMB_OK);
    assert_null(plumb_liquid_phases(NULL, &count));
    assert_int_equal(plumb_liquid_destroy(w), PLUMB_OK);
    assert_null(plumb_liquid_phases(w, &count));
    plumb_world_destroy(w);
}

static int count_phase(const plumb_world *w, uint32_t phase)
{
    int count, of = 0;
    const plumb_particle *p = plumb_liquid_particles(w, &count);
    for (int i = 0; i < count; ++i) {
        of += p[i].phase == phase && p[i].tag == 5;
    }
    return of;
}

static void particles_have_and_change_phases(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .zero_gravity = true }, &w), PLUMB_OK);
    plumb_liquid_create(w, &(plumb_liquid_desc){ .spacing = R(0.1) });
    const plumb_particle oil = { .phase = 1, .tag = 5 };
    const plumb_vec2 low = { 0, 0 }, mid = { R(0.5), 1 }, high = { 1, 1 };
    assert_int_equal(plumb_liquid_add_box(w, low, high, &oil), PLUMB_E_RANGE);
    assert_int_equal(plumb_liquid_add(w, &oil, 1), PLUMB_E_RANGE);
    plumb_liquid_set_phases(w, &(plumb_liquid_phase){ .density = 800 }, 1);
    assert_int_equal(plumb_liquid_add_box(w, low, high, &oil), PLUMB_OK);
    assert_int_equal(count_phase(w, 1), 100);
    assert_int_equal(plumb_liquid_set_phases(w, NULL, 0), PLUMB_E_STATE);
    assert_int_equal(plumb_liquid_change_phase(NULL, low, mid, 1, 0), -1);
    assert_int_equal(plumb_liquid_change_phase(w, mid, low, 1, 0), -1);
    assert_int_equal(plumb_liquid_change_phase(w, low, plumb_v2(R(NAN), 1), 1, 0), -1);
    assert_int_equal(plumb_liquid_change_phase(w, low, mid, 2, 0), -1);
    assert_int_equal(plumb_liquid_change_phase(w, low, mid, 1, -1), -1);
    assert_int_equal(plumb_liquid_change_phase(w, low, mid, 0, 1), 0);
    assert_int_equal(plumb_liquid_change_phase(w, low, mid, 1, 0), 50);
    assert_int_equal(count_phase(w, 0), 50);
    run(w, 10);
    assert_int_equal(count_phase(w, 0), 50);
    assert_int_equal(count_phase(w, 1), 50);
    assert_int_equal(plumb_liquid_change_phase(w, plumb_v2(-9, -9), plumb_v2(9, 9), 1, 0), 50);
    assert_int_equal(plumb_liquid_set_phases(w, NULL, 0), PLUMB_OK);
    plumb_world_destroy(w);
}

// Whatever they are, and whoever shares the work: nothing but numbers, nothing lost, the same bits.
static void hostile_phases_stay_finite(void **state)
{
    (void)state;
    plumb_vec2 first = { 0, 0 };
    for (int workers = 1; workers <= 2; ++workers) {
        plumb_world *w;
        assert_int_equal(plumb_world_create(&(plumb_world_desc){ .workers = workers }, &w),
                         PLUMB_OK);
        plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
        plumb_shape_create(
            w, ground,
            &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 5, 1 }, .center = { 0, -1 } });
        plumb_liquid_create(w, &(plumb_liquid_desc){ .spacing = R(0.05) });
        const plumb_liquid_phase three[] = { { .density = 1, .viscosity = 0 },
                                             { .density = R(1e6), .viscosity = R(1e9) },
                                             { .density = 1, .viscosity = 1 } };
        assert_int_equal(plumb_liquid_set_phases(w, three, 3), PLUMB_OK);
        for (uint32_t i = 0; i < 40; ++i) {
            const plumb_real x = R(0.05) * (plumb_real)(i % 8), y = R(0.3) * (plumb_real)(i / 8);
            const plumb_particle like = { .phase = i % 4, .velocity = { i % 3 == 0 ? 9 : -9, 0 } };
            plumb_liquid_add_box(w, plumb_v2(x, y), plumb_v2(x + R(0.3), y + R(0.3)), &like);
        }
        const int count = count_of(w);
        run(w, 60);
        assert_int_equal(count_of(w), count);
        const plumb_particle *p = plumb_liquid_particles(w, NULL);
        for (int i = 0; i < count; ++i) {
            assert_true(isfinite((double)p[i].position.x) && isfinite((double)p[i].velocity.y));
        }
        first = workers == 1 ? p[17].position : first;
        assert_true(p[17].position.x == first.x && p[17].position.y == first.y);
        plumb_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(bad_settings_are_refused),
        API_TEST(bad_particles_are_refused),
        cmocka_unit_test(refilling_keeps_a_shape_full),
        API_TEST(extremes_stay_finite),
        cmocka_unit_test(bodies_beyond_bounds_leave_it_finite),
        cmocka_unit_test(a_world_that_wraps_has_none),
        cmocka_unit_test(without_particles_there_is_no_pass),
        cmocka_unit_test(threads_and_widths_change_no_bit),
        cmocka_unit_test(large_pools_are_shared_out_without_a_bit),
        cmocka_unit_test(a_particle_alone_flies_and_lands),
        cmocka_unit_test(what_spills_takes_no_room),
        cmocka_unit_test(images_go_on_with_the_same_bits),
        cmocka_unit_test(recordings_hold_it),
        cmocka_unit_test(any_allocation_may_fail),
        cmocka_unit_test(forces_of_a_step_are_not_taken_back_by_the_next),
        cmocka_unit_test(a_pool_at_rest_allocates_nothing),
        cmocka_unit_test(phases_are_set_and_told),
        cmocka_unit_test(particles_have_and_change_phases),
        cmocka_unit_test(hostile_phases_stay_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
