// test_api_waves.c - waves as a user has them: refused calls, what is absent costs nothing, images and deltas, threads and widths,
// recordings, out of memory.
#include "harness/heap.h"
#include "harness/recording.h"
#include "harness/sim.h"
#include "world_fixture.h"

#include <stdlib.h>

#define DT R(1.0 / 60)

typedef struct bay {
    plumb_world *w;
    plumb_body holder;
    plumb_shape water;
    plumb_material fluid;
} bay;

// Water 20 m wide and 4 deep up to y = 0; boxes, a disc and a capsule that fall into it, a paddle.
static bay make_bay(plumb_world_desc desc)
{
    bay b;
    assert_int_equal(plumb_world_create(&desc, &b.w), PLUMB_OK);
    b.fluid = plumb_material_create(b.w, &(plumb_material_desc){ .density = 1000, .fluid = true });
    b.holder =
        plumb_body_create(b.w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { 0, -2 } });
    b.water = plumb_shape_create(
        b.w, b.holder,
        &(plumb_shape_desc){
            .kind = PLUMB_BOX, .half = { 10, 2 }, .sensor = true, .material = b.fluid });
    const plumb_material light =
        plumb_material_create(b.w, &(plumb_material_desc){ .density = 400 });
    const plumb_vec2 ends[2] = { { R(-0.4), 0 }, { R(0.4), 0 } };
    for (int i = 0; i < 8; ++i) {
        const plumb_body body = plumb_body_create(
            b.w, &(plumb_body_desc){ .position = { R(-7 + 2 * i), R(0.4 + 0.3 * (i % 3)) },
                                     .angle = R(0.3 * i) });
        const plumb_shape_desc shapes[] = {
            { .kind = PLUMB_BOX, .half = { R(0.4), R(0.3) }, .material = light },
            { .kind = PLUMB_CIRCLE, .radius = R(0.4), .material = light },
            { .kind = PLUMB_CAPSULE,
              .points = ends,
              .count = 2,
              .radius = R(0.2),
              .material = light },
        };
        plumb_shape_create(b.w, body, &shapes[i % 3]);
    }
    const plumb_body paddle = plumb_body_create(
        b.w, &(plumb_body_desc){
                 .type = PLUMB_KINEMATIC, .position = { 9, 0 }, .velocity = { R(-0.3), 0 } });
    plumb_shape_create(b.w, paddle,
                       &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.2), 1 } });
    return b;
}

static const plumb_waves_desc swell = { .modes = 40, .swell = R(0.1), .swell_length = R(-5) };

static bay make_waves(plumb_world_desc desc)
{
    bay b = make_bay(desc);
    assert_int_equal(plumb_waves_create(b.w, b.water, &swell), PLUMB_OK);
    return b;
}

static void run(plumb_world *w, int steps)
{
    for (int i = 0; i < steps; ++i) {
        assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
    }
}

//---- calls ---------------------------------------------------------------------------------------

static void no_descriptor_means_the_defaults(void **state)
{
    (void)state;
    plumb_waves_desc zero = { 0 }, told[3];
    bay b = make_bay((plumb_world_desc){ 0 });
    assert_int_equal(plumb_waves_create(b.w, b.water, &zero), PLUMB_OK);
    assert_int_equal(plumb_waves_settings(b.w, b.water, &told[0]), PLUMB_OK);
    assert_int_equal(plumb_waves_destroy(b.w, b.water), PLUMB_OK);
    assert_int_equal(plumb_waves_create(b.w, b.water, NULL), PLUMB_OK);
    assert_int_equal(plumb_waves_settings(b.w, b.water, &told[1]), PLUMB_OK);
    zero.modes = 8;
    assert_int_equal(plumb_waves_set(b.w, b.water, &zero), PLUMB_OK);
    assert_int_equal(plumb_waves_set(b.w, b.water, NULL), PLUMB_OK);
    assert_int_equal(plumb_waves_settings(b.w, b.water, &told[2]), PLUMB_OK);
    assert_memory_equal(&told[0], &told[1], sizeof told[0]);
    assert_memory_equal(&told[0], &told[2], sizeof told[0]);
    plumb_world_destroy(b.w);
}

static void bad_settings_are_refused(void **state)
{
    (void)state;
    bay b = make_bay((plumb_world_desc){ 0 });
    plumb_world *w = b.w;
    const plumb_real bad[] = { R(NAN), R(INFINITY), PLUMB_REAL_MAX, -PLUMB_REAL_MAX };
    plumb_waves_desc d = { .modes = 8 };
    assert_int_equal(plumb_waves_create(NULL, b.water, &d), PLUMB_E_NULL);
    assert_int_equal(plumb_waves_create(w, (plumb_shape)PLUMB_NULL_INIT, &d), PLUMB_E_HANDLE);
    for (int made = 0; made < 2; ++made) {
        plumb_real *const members[] = { &d.damping, &d.height, &d.swell, &d.swell_length };
        for (int i = 0; i < 4; ++i) {
            for (int k = 0; k < 4; ++k) {
                *members[k] = bad[i];
                assert_true((made ? plumb_waves_set(w, b.water, &d)
                                  : plumb_waves_create(w, b.water, &d)) != PLUMB_OK);
                *members[k] = 0;
            }
        }
        const int modes[] = { -1, PLUMB_WAVES_MAX_MODES + 1 };
        for (int i = 0; i < 2; ++i) {
            d.modes = modes[i];
            assert_int_equal(made ? plumb_waves_set(w, b.water, &d)
                                  : plumb_waves_create(w, b.water, &d),
                             PLUMB_E_RANGE);
        }
        d = (plumb_waves_desc){ .damping = 1, .no_damping = true };
        assert_int_equal(made ? plumb_waves_set(w, b.water, &d)
                              : plumb_waves_create(w, b.water, &d),
                         PLUMB_E_RANGE);
        d = (plumb_waves_desc){ .height = R(1e-9) };
        assert_int_equal(made ? plumb_waves_set(w, b.water, &d)
                              : plumb_waves_create(w, b.water, &d),
                         PLUMB_E_RANGE);
        d = (plumb_waves_desc){ .modes = 8 };
        if (!made) {
            assert_int_equal(plumb_waves_set(w, b.water, &d), PLUMB_E_STATE);
            assert_int_equal(plumb_waves_settings(w, b.water, &d), PLUMB_E_STATE);
            assert_int_equal(plumb_waves_destroy(w, b.water), PLUMB_E_STATE);
            assert_int_equal(plumb_waves_set_modes(w, b.water, NULL, 0), PLUMB_E_STATE);
            assert_int_equal(plumb_waves_create(w, b.water, &d), PLUMB_OK);
            assert_int_equal(plumb_waves_create(w, b.water, &d), PLUMB_E_STATE);
        }
    }
    assert_int_equal(plumb_waves_settings(w, b.water, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_waves_settings(w, b.water, &d), PLUMB_OK);
    assert_true(d.modes == 8 && d.damping == R(0.1) && d.height == 1 && d.swell_length == 10);
    plumb_wave_mode modes[9] = { { 0.1, 0.2 } };
    int count;
    assert_int_equal(plumb_waves_set_modes(w, b.water, modes, 9), PLUMB_E_RANGE);
    assert_int_equal(plumb_waves_set_modes(w, b.water, modes, -1), PLUMB_E_RANGE);
    assert_int_equal(plumb_waves_set_modes(w, b.water, NULL, 1), PLUMB_E_NULL);
    assert_int_equal(plumb_waves_set_modes(w, b.water, modes, 1), PLUMB_OK);
    modes[1].rate = NAN;
    assert_int_equal(plumb_waves_set_modes(w, b.water, modes, 2), PLUMB_E_NOT_FINITE);
    modes[1].rate = -2e6;
    assert_int_equal(plumb_waves_set_modes(w, b.water, modes, 2), PLUMB_E_RANGE);
    const plumb_wave_mode *now = plumb_waves_modes(w, b.water, &count);
    assert_int_equal(count, 8);
    assert_true(now[0].height == 0.1 && now[0].rate == 0.2 && now[1].rate == 0);
    d.modes = 12;
    assert_int_equal(plumb_waves_set(w, b.water, &d), PLUMB_OK);
    now = plumb_waves_modes(w, b.water, &count);
    assert_true(count == 12 && now[0].height == 0.1 && now[11].height == 0);
    plumb_shape shapes[2];
    assert_int_equal(plumb_world_waves(w, shapes, 2), 1);
    assert_true(plumb_same(shapes[0], b.water));
    assert_int_equal(plumb_world_waves(NULL, NULL, 0), 0);
    plumb_world_destroy(w);
}

static void shapes_that_cannot_have_waves(void **state)
{
    (void)state;
    const plumb_waves_desc d = { 0 };
    for (int i = 0; i < 8; ++i) {
        bay b = make_bay((plumb_world_desc){ .wrap_x = i == 7 ? 100 : 0 });
        const plumb_body boat = plumb_world_bodies(b.w).body[0];
        plumb_shape shape = b.water;
        switch (i) {
        case 0: // no fluid
            plumb_shape_set_material(b.w, shape, plumb_material_create(b.w, NULL));
            break;
        case 1: // no sensor
            plumb_body_shapes(b.w, boat, &shape, 1);
            break;
        case 2: // round
            shape = plumb_shape_create(
                b.w, b.holder,
                &(plumb_shape_desc){
                    .kind = PLUMB_CIRCLE, .radius = 1, .sensor = true, .material = b.fluid });
            break;
        case 3: // of a body that moves
            shape = plumb_shape_create(
                b.w, boat,
                &(plumb_shape_desc){
                    .kind = PLUMB_BOX, .half = { 1, 1 }, .sensor = true, .material = b.fluid });
            break;
        case 4: // not level
            plumb_body_set_angle(b.w, b.holder, R(0.01));
            break;
        case 5: // gravity to the side
            plumb_world_set_gravity(b.w, plumb_v2(1, -9));
            break;
        case 6: // weightless
            plumb_shape_set_material(
                b.w, shape,
                plumb_material_create(b.w, &(plumb_material_desc){
                                               .fluid = true, .weightless = true, .density = 1 }));
            break;
        default:
            break;
        }
        assert_int_equal(plumb_waves_create(b.w, shape, &d), PLUMB_E_STATE);
        plumb_world_destroy(b.w);
    }
}

static void a_surface_is_asked(void **state)
{
    (void)state;
    bay b = make_bay((plumb_world_desc){ 0 });
    assert_true(plumb_waves_at(b.w, b.water, 1).y == 0 && plumb_waves_energy(b.w, b.water) == 0);
    assert_null(plumb_waves_modes(b.w, b.water, NULL));
    assert_null(plumb_waves_modes(NULL, b.water, NULL));
    assert_int_equal(plumb_waves_create(b.w, b.water, &(plumb_waves_desc){ .modes = 4 }), PLUMB_OK);
    const plumb_wave_mode modes[] = { { 0, 0 }, { 0.2, 0.6 } };
    assert_int_equal(plumb_waves_set_modes(b.w, b.water, modes, 2), PLUMB_OK);
    const double k = 3.14159265358979 / 10;
    const plumb_wave_sample s = plumb_waves_at(b.w, b.water, R(-7.5));
    assert_near(s.height, 0.2 * cos(2.5 * k), 1e-6);
    assert_near(s.y, s.height, 1e-6);
    assert_near(s.slope, -0.2 * k * sin(2.5 * k), 1e-6);
    assert_near(s.rate, 0.6 * cos(2.5 * k), 1e-6);
    assert_true(plumb_waves_at(b.w, b.water, 11).height == 0);
    assert_true(plumb_waves_at(b.w, b.water, R(NAN)).height == 0);
    assert_true(plumb_waves_at(NULL, b.water, 0).y == 0);
    // rho g width / 4 (height^2 + rate^2 / omega^2)
    const double omega = sqrt(9.81 * k * tanh(4 * k));
    assert_near(plumb_waves_energy(b.w, b.water),
                1000 * 9.81 * 20 / 4 * (0.04 + 0.36 / omega / omega), 0.1);
    // In it flows what the potential says; above it nothing does.
    const plumb_fluid_sample f = plumb_fluid_at(b.w, plumb_v2(R(-7.5), R(-0.8)));
    const double z = -0.8 - (double)s.height;
    assert_near(f.velocity.y, 0.6 * cos(2.5 * k) * sinh(k * (z + 4)) / sinh(4 * k), 1e-5);
    assert_near(f.velocity.x, -0.6 * sin(2.5 * k) * cosh(k * (z + 4)) / sinh(4 * k), 1e-5);
    // Still where it is not level.
    plumb_body_set_angle(b.w, b.holder, R(0.2));
    run(b.w, 3);
    assert_true(plumb_waves_modes(b.w, b.water, NULL)[1].height == 0.2);
    assert_true(plumb_waves_at(b.w, b.water, 1).height == 0);
    plumb_world_destroy(b.w);
}

// Flat water with waves is water.
static void waves_end_with_their_shape(void **state)
{
    (void)state;
    for (int i = 0; i < 3; ++i) {
        bay b = make_waves((plumb_world_desc){ 0 });
        run(b.w, 20);
        assert_int_equal(i == 0   ? plumb_waves_destroy(b.w, b.water)
                         : i == 1 ? plumb_shape_destroy(b.w, b.water)
                                  : plumb_body_destroy(b.w, b.holder),
                         PLUMB_OK);
        assert_int_equal(plumb_world_waves(b.w, NULL, 0), 0);
        run(b.w, 20);
        plumb_world_destroy(b.w);
    }
}

// Several surfaces: each keeps its modes when another goes or grows.
static void surfaces_keep_their_modes(void **state)
{
    (void)state;
    bay b = make_bay((plumb_world_desc){ 0 });
    plumb_shape all[3] = { b.water };
    for (int i = 1; i < 3; ++i) {
        const plumb_body holder = plumb_body_create(
            b.w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { R(30.0 * i), -1 } });
        all[i] = plumb_shape_create(
            b.w, holder,
            &(plumb_shape_desc){
                .kind = PLUMB_BOX, .half = { 5, 1 }, .sensor = true, .material = b.fluid });
    }
    for (int i = 0; i < 3; ++i) {
        const plumb_wave_mode modes[2] = { { 0.01 * (i + 1), 0 }, { 0.02 * (i + 1), 0 } };
        assert_int_equal(plumb_waves_create(b.w, all[i], &(plumb_waves_desc){ .modes = 2 + i }),
                         PLUMB_OK);
        assert_int_equal(plumb_waves_set_modes(b.w, all[i], modes, 2), PLUMB_OK);
    }
    assert_int_equal(plumb_waves_set(b.w, all[0], &(plumb_waves_desc){ .modes = 9 }), PLUMB_OK);
    assert_int_equal(plumb_waves_destroy(b.w, all[1]), PLUMB_OK);
    int count;
    assert_true(plumb_waves_modes(b.w, all[0], &count)[1].height == 0.02 && count == 9);
    assert_null(plumb_waves_modes(b.w, all[1], NULL));
    assert_true(plumb_waves_modes(b.w, all[2], &count)[1].height == 0.06 && count == 4);
    assert_int_equal(plumb_waves_set(b.w, all[0], &(plumb_waves_desc){ .modes = 1 }), PLUMB_OK);
    assert_true(plumb_waves_modes(b.w, all[2], &count)[0].height == 0.03 && count == 4);
    run(b.w, 5);
    plumb_world_destroy(b.w);
}

// What sleeps on the water wakes when a wave comes, and sleeps again when it has gone.
static void waves_wake_and_let_sleep(void **state)
{
    (void)state;
    bay b = make_bay((plumb_world_desc){ 0 });
    const plumb_body raft =
        plumb_body_create(b.w, &(plumb_body_desc){ .position = { R(-9), R(0.1) } });
    const plumb_material light =
        plumb_material_create(b.w, &(plumb_material_desc){ .density = 500 });
    plumb_shape_create(
        b.w, raft,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.2) }, .material = light });
    for (int i = 0; i < plumb_world_bodies(b.w).count;) {
        const plumb_body other = plumb_world_bodies(b.w).body[i];
        if (plumb_same(other, raft) || plumb_same(other, b.holder)) {
            ++i;
        } else {
            plumb_body_destroy(b.w, other);
        }
    }
    assert_int_equal(plumb_waves_create(b.w, b.water, &(plumb_waves_desc){ .damping = 4 }),
                     PLUMB_OK);
    int steps = 0;
    for (int round = 0; round < 2; ++round) {
        for (steps = 0; steps < 3000 && plumb_body_is_awake(b.w, raft); ++steps) {
            run(b.w, 1);
        }
        print_message("asleep after %d steps\n", steps);
        assert_false(plumb_body_is_awake(b.w, raft));
        if (round == 0) {
            const plumb_wave_mode wave[] = { { 0.1, 0 } };
            assert_int_equal(plumb_waves_set_modes(b.w, b.water, wave, 1), PLUMB_OK);
            run(b.w, 2);
            assert_true(plumb_body_is_awake(b.w, raft));
        }
    }
    plumb_world_destroy(b.w);
}

// Speeds and sizes that no water has: nothing that is not finite comes of it.
static void extremes_stay_finite(void **state)
{
    (void)state;
    const plumb_real most = PLUMB_REAL_MAX / 4;
    for (int i = 0; i < 4; ++i) {
        bay b = make_bay((plumb_world_desc){ 0 });
        const plumb_waves_desc d = { .modes = i == 3 ? 1 : PLUMB_WAVES_MAX_MODES,
                                     .no_damping = true,
                                     .height = i == 0 ? R(1e6) : 0,
                                     .swell = i == 1 ? 1000 : R(0.1),
                                     .swell_length = i == 2 ? R(1e-3) : R(-1e6) };
        const plumb_wave_mode wild[] = { { 1e6, -1e6 } };
        assert_int_equal(plumb_waves_create(b.w, b.water, &d), PLUMB_OK);
        assert_int_equal(plumb_waves_set_modes(b.w, b.water, wild, 1), PLUMB_OK);
        for (int k = 0; k < 4; ++k) {
            const plumb_body body = plumb_world_bodies(b.w).body[k];
            plumb_body_set_velocity(b.w, body,
                                    plumb_v2(k == 1 ? -most : most, k == 2 ? R(1e3) : most));
            plumb_body_set_angular_velocity(b.w, body, k == 3 ? most : 100);
        }
        for (int k = 0; k < 30; ++k) {
            plumb_world_set_gravity(b.w, plumb_v2(0, k == 9 ? -most : R(-9.81)));
            plumb_world_step(b.w, DT); // bodies may be taken out: that is told
        }
        int count;
        const plumb_wave_mode *now = plumb_waves_modes(b.w, b.water, &count);
        for (int k = 0; k < count; ++k) {
            assert_true(now[k].height - now[k].height == 0 && now[k].rate - now[k].rate == 0);
        }
        plumb_world_destroy(b.w);
    }
}

//---- what is absent ------------------------------------------------------------------------------

static void without_waves_there_is_no_pass(void **state)
{
    (void)state;
    bay b = make_bay((plumb_world_desc){ 0 }), never = make_bay((plumb_world_desc){ 0 });
    run(b.w, 1);
    assert_false(sim_has_pass(b.w, "waves"));
    assert_false(sim_has_pass(b.w, "wave motion"));
    assert_int_equal(plumb_waves_create(b.w, b.water, &swell), PLUMB_OK);
    assert_int_equal(plumb_waves_destroy(b.w, b.water), PLUMB_OK); // and has left nothing
    run(b.w, 60);
    run(never.w, 61);
    assert_true(plumb_world_hash(b.w) == plumb_world_hash(never.w));
    assert_int_equal(plumb_waves_create(b.w, b.water, &swell), PLUMB_OK);
    run(b.w, 1);
    assert_true(sim_has_pass(b.w, "waves"));
    assert_true(sim_has_pass(b.w, "wave motion"));
    plumb_world_destroy(b.w);
    plumb_world_destroy(never.w);
}

//---- the same bits -------------------------------------------------------------------------------

static void threads_and_widths_change_no_bit(void **state)
{
    (void)state;
    const int widths[] = { 4, 8, 16, 8 }, workers[] = { 1, 1, 1, 3 };
    uint64_t hashes[4];
    for (int i = 0; i < 4; ++i) {
        bay b = make_waves((plumb_world_desc){ .simd_width = widths[i], .workers = workers[i] });
        run(b.w, 200);
        hashes[i] = plumb_world_hash(b.w);
        assert_true(hashes[i] == hashes[0]);
        plumb_world_destroy(b.w);
    }
}

// Water that comes to another body, gets another size and its own again, or another form that is the same.
static void make_anew(bay *b, int how)
{
    if (how == 1) {
        const plumb_body other = plumb_body_create(
            b->w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { 3, -4 } });
        assert_int_equal(plumb_body_merge(b->w, other, b->holder, NULL), PLUMB_OK);
    } else if (how == 2) {
        assert_int_equal(plumb_body_scale(b->w, b->holder, 2), PLUMB_OK);
        assert_int_equal(plumb_body_scale(b->w, b->holder, R(0.5)), PLUMB_OK);
    } else if (how == 3) {
        const plumb_shape_desc same = { .kind = PLUMB_BOX, .half = { 10, 2 } };
        assert_int_equal(plumb_shape_set_geometry(b->w, b->water, &same), PLUMB_OK);
    }
}

static double heights(plumb_world *w)
{
    const plumb_body_span span = plumb_world_bodies(w);
    double sum = 0;
    for (int i = 0; i < span.dynamic_count; ++i) {
        sum += (double)plumb_body_center(w, span.body[i]).y;
    }
    return sum / span.dynamic_count;
}

static void waves_stay_with_a_shape_that_is_made_anew(void **state)
{
    (void)state;
    double mean[4];
    for (int how = 0; how < 4; ++how) {
        bay b = make_waves((plumb_world_desc){ 0 }), other = make_waves((plumb_world_desc){ 0 });
        run(b.w, 90);
        make_anew(&b, how);
        const size_t size = plumb_world_snapshot_size(b.w);
        void *bytes = malloc(size);
        assert_int_equal(plumb_world_save(b.w, bytes, size), PLUMB_OK);
        assert_int_equal(plumb_world_restore(other.w, bytes, size), PLUMB_OK);
        free(bytes);
        mean[how] = 0;
        for (int i = 0; i < 60; ++i) {
            run(b.w, 1), run(other.w, 1);
            assert_true(plumb_world_hash(b.w) == plumb_world_hash(other.w));
            mean[how] += heights(b.w) / 60;
        }
        print_message("mean height of what floats: %.5f m\n", mean[how]);
        assert_near(mean[how], mean[0], 1e-4);
        plumb_world_destroy(b.w), plumb_world_destroy(other.w);
    }
}

static void images_go_on_with_the_same_bits(void **state)
{
    (void)state;
    bay b = make_waves((plumb_world_desc){ 0 });
    bay other = make_bay((plumb_world_desc){ .workers = 2 });
    size_t size, later_size;
    run(b.w, 50); // in mid splash
    void *bytes = sim_save(b.w, &size);
    run(b.w, 60);
    const uint64_t end = plumb_world_hash(b.w);
    void *later = sim_save(b.w, &later_size);
    assert_int_equal(plumb_world_restore(other.w, bytes, size), PLUMB_OK);
    run(other.w, 60);
    assert_true(plumb_world_hash(other.w) == end);
    assert_int_equal(plumb_world_restore_trusted(b.w, bytes, size), PLUMB_OK); // rollback
    run(b.w, 60);
    assert_true(plumb_world_hash(b.w) == end);
    const size_t bound = plumb_snapshot_delta_bound(later_size);
    void *delta = malloc(bound), *again = malloc(later_size);
    size_t used, got;
    assert_int_equal(plumb_snapshot_delta(bytes, size, later, later_size, delta, bound, &used),
                     PLUMB_OK);
    assert_int_equal(plumb_snapshot_apply(bytes, size, delta, used, again, later_size, &got),
                     PLUMB_OK);
    assert_true(got == later_size && memcmp(again, later, got) == 0);
    // One where there are none.
    bay none = make_bay((plumb_world_desc){ 0 });
    size_t none_size;
    void *none_bytes = sim_save(none.w, &none_size);
    assert_int_equal(plumb_world_restore(b.w, none_bytes, none_size), PLUMB_OK);
    assert_int_equal(plumb_world_waves(b.w, NULL, 0), 0);
    run(b.w, 20);
    run(none.w, 20);
    assert_true(plumb_world_hash(b.w) == plumb_world_hash(none.w));
    free(bytes), free(later), free(delta), free(again), free(none_bytes);
    plumb_world_destroy(b.w), plumb_world_destroy(other.w), plumb_world_destroy(none.w);
}

static void recordings_hold_them(void **state)
{
    (void)state;
    bay b = make_bay((plumb_world_desc){ 0 });
    recording tape = { 0 };
    uint64_t hashes[61];
    assert_int_equal(plumb_recorder_start(
                         b.w, &(plumb_recorder_desc){ .write = to_recording, .context = &tape }),
                     PLUMB_OK);
    for (int i = 1; i <= 60; ++i) {
        const plumb_wave_mode wave[] = { { 0.05, 0.1 }, { -0.1, 0 } };
        if (i == 10) {
            assert_int_equal(plumb_waves_create(b.w, b.water, &swell), PLUMB_OK);
        }
        if (i == 25) {
            assert_int_equal(plumb_waves_set_modes(b.w, b.water, wave, 2), PLUMB_OK);
        }
        if (i == 40) {
            assert_int_equal(plumb_world_set_time(b.w, 77.7), PLUMB_OK);
            assert_true(plumb_world_stats(b.w).time == 77.7);
        }
        if (i == 50) {
            assert_int_equal(plumb_waves_set(b.w, b.water, &(plumb_waves_desc){ .modes = 50 }),
                             PLUMB_OK);
        }
        run(b.w, 1);
        hashes[i] = plumb_world_hash(b.w);
    }
    plumb_recorder_stop(b.w);
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
    plumb_world_destroy(b.w);
}

//---- out of memory -------------------------------------------------------------------------------

// Every allocation of making and stepping fails once: the call is refused, and when it is tried again all goes on as without
// that.
static uint64_t play(heap *h, long fail_at, long *calls, int *refused)
{
    *h = (heap){ .fail_at = -1 };
    bay b = make_bay((plumb_world_desc){ .allocator = heap_allocator(h) });
    run(b.w, 10);
    const long before = h->calls;
    h->fail_at = fail_at < 0 ? -1 : before + fail_at;
    plumb_result r;
    while ((r = plumb_waves_create(b.w, b.water, &swell)) == PLUMB_E_MEMORY) {
        ++*refused;
        assert_int_equal(plumb_world_waves(b.w, NULL, 0), 0);
    }
    assert_int_equal(r, PLUMB_OK);
    for (int i = 0; i < 8; ++i) {
        while ((r = plumb_world_step(b.w, DT)) == PLUMB_E_MEMORY) {
            ++*refused;
        }
        assert_int_equal(r, PLUMB_OK);
    }
    *calls = h->calls - before;
    const uint64_t hash = plumb_world_hash(b.w);
    plumb_world_destroy(b.w);
    assert_int_equal(h->bytes, 0);
    return hash;
}

static void any_allocation_may_fail(void **state)
{
    (void)state;
    heap_fail_each(play, 8, 200);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_descriptor_means_the_defaults),
        cmocka_unit_test(bad_settings_are_refused),
        cmocka_unit_test(shapes_that_cannot_have_waves),
        cmocka_unit_test(a_surface_is_asked),
        cmocka_unit_test(waves_end_with_their_shape),
        cmocka_unit_test(surfaces_keep_their_modes),
        cmocka_unit_test(waves_wake_and_let_sleep),
        cmocka_unit_test(extremes_stay_finite),
        cmocka_unit_test(without_waves_there_is_no_pass),
        cmocka_unit_test(threads_and_widths_change_no_bit),
        cmocka_unit_test(waves_stay_with_a_shape_that_is_made_anew),
        cmocka_unit_test(images_go_on_with_the_same_bits),
        cmocka_unit_test(recordings_hold_them),
        cmocka_unit_test(any_allocation_may_fail),
    };
    return cmocka_run_group_tests_name("waves", tests, NULL, NULL);
}
