// test_api_air.c - air as a user has it: refused calls, what is absent costs nothing, images and deltas, threads and widths,
// recordings, out of memory.
#include "harness/heap.h"
#include "harness/recording.h"
#include "harness/sim.h"
#include "world_fixture.h"

#include <stdlib.h>

#define DT R(1.0 / 60)

static const plumb_air_desc small_box = { .position = { 0, R(0.75) },
                                          .half = { 1, R(0.75) },
                                          .cell = R(0.0625),
                                          .viscosity = R(0.002),
                                          .bottom = PLUMB_AIR_CLOSED,
                                          .left = PLUMB_AIR_FLOW,
                                          .flow = { R(0.5), 0 } };

// A floor, a post, a vane on a hinge in the world's frame, a ball that falls, something that the air never meets.
static plumb_world *make_room(plumb_world_desc desc)
{
    plumb_world *w;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    const plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(
        w, ground,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 20, R(0.5) }, .center = { 0, R(-0.5) } });
    plumb_shape_create(w, ground,
                       &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                            .half = { R(0.1), R(0.3) },
                                            .center = { R(0.5), R(0.3) } });
    const plumb_material light = plumb_material_create(w, &(plumb_material_desc){ .density = 3 });
    const plumb_vec2 places[] = { { R(-0.3), R(0.9) }, { R(0.1), R(1.2) }, { 10, 3 } };
    for (int i = 0; i < 3; ++i) {
        const plumb_body b =
            plumb_body_create(w, &(plumb_body_desc){ .position = places[i], .angle = R(0.4) });
        plumb_shape_create(
            w, b,
            i == 1
                ? &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.12), .material = light }
                : &(plumb_shape_desc){
                      .kind = PLUMB_BOX, .half = { R(0.25), R(0.08) }, .material = light });
    }
    return w;
}

static plumb_result fill(plumb_world *w)
{
    const plumb_air_source sources[] = {
        { .position = { 0, R(0.2) }, .radius = R(0.15), .heat = 300, .smoke = 5 },
        { .body = plumb_world_bodies(w).body[0],
          .radius = R(0.05),
          .position = { R(0.3), 0 },
          .smoke = 2,
          .push = { 4, 0 } }
    };
    const plumb_result r = plumb_air_create(w, &small_box);
    return r == PLUMB_OK ? plumb_air_set_sources(w, sources, 2) : r;
}

static plumb_world *make_full_room(plumb_world_desc desc)
{
    plumb_world *w = make_room(desc);
    assert_int_equal(fill(w), PLUMB_OK);
    return w;
}

static void run(plumb_world *w, int steps)
{
    for (int i = 0; i < steps; ++i) {
        assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
    }
}

//---- calls ---------------------------------------------------------------------------------------

static void bad_settings_are_refused(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_real bad[] = { R(-1), R(NAN), R(INFINITY), PLUMB_REAL_MAX };
    plumb_air_desc d = { .half = { 1, 1 } };
    plumb_real *const members[] = { &d.half.x,    &d.half.y, &d.cell,    &d.density,
                                    &d.viscosity, &d.fading, &d.cooling, &d.temperature };
    assert_int_equal(plumb_air_create(NULL, &d), PLUMB_E_NULL);
    assert_int_equal(plumb_air_create(w, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_air_create(w, &(plumb_air_desc){ 0 }), PLUMB_E_RANGE);
    for (int i = 0; i < 4; ++i) {
        for (int k = 0; k < 8; ++k) {
            const plumb_real good = *members[k];
            *members[k] = bad[i];
            assert_true(plumb_air_create(w, &d) != PLUMB_OK);
            *members[k] = good;
        }
        d.position.x = d.flow.y = i == 0 ? R(-2e6) : bad[i];
        assert_true(plumb_air_create(w, &d) != PLUMB_OK);
        d.position.x = 0;
        assert_true(plumb_air_create(w, &d) != PLUMB_OK);
        d.flow.y = 0;
    }
    d.left = (plumb_air_side)4;
    assert_int_equal(plumb_air_create(w, &d), PLUMB_E_RANGE);
    d.left = PLUMB_AIR_PERIODIC;
    assert_int_equal(plumb_air_create(w, &d), PLUMB_E_RANGE);
    d.left = PLUMB_AIR_OPEN;
    d.cell = R(0.0005); // too many
    assert_int_equal(plumb_air_create(w, &d), PLUMB_E_RANGE);
    d.cell = 0;
    assert_int_equal(plumb_air_settings(w, &d), PLUMB_E_STATE);
    assert_int_equal(plumb_air_set(w, &d), PLUMB_E_STATE);
    assert_int_equal(plumb_air_destroy(w), PLUMB_E_STATE);
    assert_int_equal(plumb_air_create(w, &d), PLUMB_OK);
    assert_int_equal(plumb_air_create(w, &d), PLUMB_E_STATE);
    assert_int_equal(plumb_air_settings(w, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_air_settings(w, &d), PLUMB_OK);
    assert_true(d.cell == R(2.0 / 64) && d.density == R(1.2) && d.temperature == 293);
    d.viscosity = 3;
    d.left = PLUMB_AIR_CLOSED;
    assert_int_equal(plumb_air_set(w, &d), PLUMB_OK);
    d.cell = 1;
    assert_int_equal(plumb_air_set(w, &d), PLUMB_E_STATE);
    assert_int_equal(plumb_air_set(w, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_air_settings(w, &d), PLUMB_OK);
    assert_true(d.viscosity == 3 && d.left == PLUMB_AIR_CLOSED);
    assert_int_equal(plumb_air_destroy(w), PLUMB_OK);
    assert_int_equal(plumb_air_create(w, &d), PLUMB_OK);
}

static void a_world_that_wraps_has_none(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .wrap_x = 10 }, &w), PLUMB_OK);
    assert_int_equal(plumb_air_create(w, &small_box), PLUMB_E_STATE);
    plumb_world_destroy(w);
}

static void bad_sources_are_refused(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_real bad[] = { R(NAN), R(INFINITY), R(-2e9), R(2e9) };
    plumb_air_source s = { .radius = 1 };
    int count = 9;
    assert_int_equal(plumb_air_set_sources(w, &s, 1), PLUMB_E_STATE);
    assert_int_equal(plumb_air_create(w, &small_box), PLUMB_OK);
    assert_int_equal(plumb_air_set_sources(w, &s, 1), PLUMB_OK);
    assert_int_equal(plumb_air_set_sources(NULL, &s, 1), PLUMB_E_NULL);
    assert_int_equal(plumb_air_set_sources(w, NULL, 1), PLUMB_E_NULL);
    assert_int_equal(plumb_air_set_sources(w, &s, -1), PLUMB_E_RANGE);
    assert_int_equal(plumb_air_set_sources(w, &s, PLUMB_AIR_MAX_SOURCES + 1), PLUMB_E_RANGE);
    plumb_real *const members[] = { &s.position.x, &s.position.y, &s.radius, &s.smoke,
                                    &s.heat,       &s.push.x,     &s.push.y };
    for (int i = 0; i < 4; ++i) {
        for (int k = 0; k < 7; ++k) {
            const plumb_real good = *members[k];
            *members[k] = bad[i];
            assert_true(plumb_air_set_sources(w, &s, 1) != PLUMB_OK);
            *members[k] = good;
        }
    }
    s.radius = 0;
    assert_int_equal(plumb_air_set_sources(w, &s, 1), PLUMB_E_RANGE);
    s.radius = 2;
    s.body = f->dynamic;
    assert_int_equal(plumb_air_set_sources(w, &s, 1), PLUMB_OK);
    assert_true(plumb_air_sources(w, &count)[0].radius == 2);
    assert_int_equal(count, 1);
    plumb_body_destroy(w, f->dynamic);
    assert_int_equal(plumb_air_set_sources(w, &s, 1), PLUMB_E_HANDLE);
    run(w, 2); // what was its source does nothing
    assert_true(plumb_air_at(w, plumb_v2(0, R(0.5))).smoke == 0);
    assert_int_equal(plumb_air_set_sources(w, NULL, 0), PLUMB_OK);
    assert_null(plumb_air_sources(w, &count));
    assert_int_equal(count, 0);
    assert_null(plumb_air_sources(NULL, NULL));
}

static void whirl(void *context, plumb_vec2 at, plumb_air_sample *s)
{
    ++*(int *)context;
    s->velocity = plumb_v2(at.y, -at.x);
    s->smoke = at.x > 0 ? R(-3) : R(2);
    s->heat = at.y > R(0.5) ? R(NAN) : R(1e9);
}

static void cells_are_filled_and_asked(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_air_box box;
    plumb_air_sums sums;
    int calls = 0;
    assert_int_equal(plumb_air_fill(w, whirl, &calls), PLUMB_E_STATE);
    assert_int_equal(plumb_air_cells(w, &box), PLUMB_E_STATE);
    assert_int_equal(plumb_air_sum(w, &sums), PLUMB_E_STATE);
    assert_true(plumb_air_at(w, plumb_v2(0, 0)).smoke == 0);
    assert_int_equal(plumb_air_create(w, &small_box), PLUMB_OK);
    assert_int_equal(plumb_air_fill(w, NULL, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_air_fill(w, whirl, &calls), PLUMB_OK);
    assert_int_equal(plumb_air_cells(w, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_air_cells(w, &box), PLUMB_OK);
    assert_true(box.columns == 32 && box.rows == 24 && box.low.x == -1 && box.high.y == R(1.5));
    assert_int_equal(calls, 33 * 24 + 32 * 25 + 32 * 24);
    const plumb_air_sample s = plumb_air_at(w, plumb_v2(R(-0.4), R(0.7)));
    assert_near(s.velocity.x, 0.7, 1e-6);
    assert_near(s.velocity.y, 0.4, 1e-6);
    assert_true(s.smoke == 2 && s.heat == 0);
    assert_true(plumb_air_at(w, plumb_v2(R(0.5), R(0.2))).heat == R(1e6));
    assert_true(plumb_air_at(w, plumb_v2(R(0.5), R(0.2))).smoke == 0);
    assert_true(plumb_air_at(w, plumb_v2(2, 0)).velocity.x == 0);
    assert_true(plumb_air_at(w, plumb_v2(R(NAN), 0)).velocity.x == 0);
    assert_int_equal(plumb_air_sum(w, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_air_sum(w, &sums), PLUMB_OK);
    assert_near(sums.smoke, 2 * 1 * 1.5, 1e-6);
    assert_near(sums.momentum_x, 1.2 * 2 * 1.5 * 0.75, 2e-3);
    // All cells at once.
    const int count = 33 * 25;
    plumb_air_cell *cells = malloc((size_t)count * sizeof *cells);
    assert_non_null(cells);
    memcpy(cells, box.at, (size_t)count * sizeof *cells);
    assert_int_equal(plumb_air_set_cells(w, NULL, count), PLUMB_E_NULL);
    assert_int_equal(plumb_air_set_cells(w, cells, count - 1), PLUMB_E_RANGE);
    cells[7].u = 3;
    assert_int_equal(plumb_air_set_cells(w, cells, count), PLUMB_OK);
    assert_true(box.at[7].u == 3);
    plumb_real *const members[] = { &cells[9].u, &cells[9].v, &cells[9].smoke, &cells[9].heat,
                                    &cells[9].room };
    for (int k = 0; k < 5; ++k) {
        const plumb_real good = *members[k];
        *members[k] = R(-1e8);
        assert_int_equal(plumb_air_set_cells(w, cells, count), PLUMB_E_RANGE);
        *members[k] = R(NAN);
        assert_int_equal(plumb_air_set_cells(w, cells, count), PLUMB_E_NOT_FINITE);
        *members[k] = good;
    }
    free(cells);
}

// The fastest, hottest and thickest that calls allow: nothing that is not finite comes of it.
static void extremes_stay_finite(void **state)
{
    (void)state;
    const plumb_real most = PLUMB_REAL_MAX / 4, densities[] = { R(1e-9), R(1e9), R(1e-3) };
    for (int i = 0; i < 3; ++i) {
        plumb_world *w = make_room((plumb_world_desc){ 0 });
        plumb_air_desc d = small_box;
        d.density = densities[i];
        d.viscosity = i == 1 ? R(1e9) : 0;
        d.temperature = R(1e-3);
        d.flow = (plumb_vec2){ R(1e4), R(-1e4) };
        d.right = PLUMB_AIR_FLOW;
        assert_int_equal(plumb_air_create(w, &d), PLUMB_OK);
        const plumb_air_source sources[] = {
            { .radius = R(1e6), .smoke = R(1e6), .heat = R(1e6), .push = { R(1e6), R(-1e6) } },
            { .position = { R(1e6), R(-1e6) }, .radius = R(1e-6), .smoke = R(-1e6) },
            { .position = { 0, 1 }, .radius = R(0.3), .heat = R(-1e6) }
        };
        assert_int_equal(plumb_air_set_sources(w, sources, 3), PLUMB_OK);
        for (int k = 0; k < 3; ++k) {
            const plumb_body b = plumb_world_bodies(w).body[k];
            plumb_body_set_velocity(w, b, plumb_v2(k == 1 ? -most : most, most));
            plumb_body_set_angular_velocity(w, b, most);
        }
        for (int k = 0; k < 20; ++k) {
            plumb_world_set_gravity(w, plumb_v2(0, k == 9 ? -most : R(-9.81)));
            plumb_world_step(w, DT); // bodies may be taken out: that is told
        }
        plumb_air_box box;
        assert_int_equal(plumb_air_cells(w, &box), PLUMB_OK);
        for (int k = 0; k < 33 * 25; ++k) {
            assert_in_range((int)box.at[k].u + 10000, 0, 20000);
            assert_in_range((int)box.at[k].v + 10000, 0, 20000);
            assert_in_range((int)box.at[k].smoke, 0, 1000000);
            assert_in_range((int)box.at[k].heat + 1000000, 0, 2000000);
        }
        plumb_world_destroy(w);
    }
}

// A piston presses into rooms without a way out: air cannot be pressed, so a light one stays, a driven one does no harm.
static void pistons_in_closed_rooms(void **state)
{
    (void)state;
    for (int driven = 0; driven < 2; ++driven) {
        plumb_world *w;
        assert_int_equal(plumb_world_create(&(plumb_world_desc){ .zero_gravity = true }, &w),
                         PLUMB_OK);
        const plumb_air_desc d = { .half = { 1, R(0.5) },
                                   .cell = R(0.125),
                                   .left = PLUMB_AIR_CLOSED,
                                   .right = PLUMB_AIR_CLOSED,
                                   .bottom = PLUMB_AIR_CLOSED,
                                   .top = PLUMB_AIR_CLOSED };
        assert_int_equal(plumb_air_create(w, &d), PLUMB_OK);
        const plumb_body b = plumb_body_create(
            w, &(plumb_body_desc){ .type = driven ? PLUMB_KINEMATIC : PLUMB_DYNAMIC,
                                   .velocity = { R(0.5), 0 } });
        plumb_shape_create(w, b,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.2), R(0.6) } });
        run(w, 60);
        plumb_air_sums sums;
        assert_int_equal(plumb_air_sum(w, &sums), PLUMB_OK);
        const double way = (double)plumb_body_position(w, b).x;
        print_message("%s piston: way %.4f m, energy %.3g J\n", driven ? "driven" : "free", way,
                      sums.energy);
        assert_near(way, driven ? 0.5 : 0, 0.01);
        assert_true(sums.energy < 1);
        plumb_world_destroy(w);
    }
}

//---- what is absent ------------------------------------------------------------------------------

static void without_air_there_is_no_pass(void **state)
{
    (void)state;
    plumb_world *w = make_room((plumb_world_desc){ 0 }),
                *never = make_room((plumb_world_desc){ 0 });
    run(w, 1);
    assert_false(sim_has_pass(w, "air"));
    assert_false(sim_has_pass(w, "air motion"));
    assert_int_equal(fill(w), PLUMB_OK);
    plumb_air_destroy(w); // and has left nothing
    run(w, 30);
    run(never, 31);
    assert_true(plumb_world_hash(w) == plumb_world_hash(never));
    assert_int_equal(fill(w), PLUMB_OK);
    run(w, 1);
    assert_true(sim_has_pass(w, "air"));
    assert_true(sim_has_pass(w, "air motion"));
    assert_int_equal(plumb_air_destroy(w), PLUMB_OK);
    run(w, 1);
    assert_false(sim_has_pass(w, "air"));
    plumb_world_destroy(w);
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
            make_full_room((plumb_world_desc){ .simd_width = widths[i], .workers = workers[i] });
        run(w, 60);
        hashes[i] = plumb_world_hash(w);
        assert_true(hashes[i] == hashes[0]);
        plumb_world_destroy(w);
    }
}

static void images_go_on_with_the_same_bits(void **state)
{
    (void)state;
    plumb_world *w = make_full_room((plumb_world_desc){ 0 });
    plumb_world *other = make_room((plumb_world_desc){ .workers = 2 });
    size_t size, later_size;
    run(w, 30);
    void *bytes = sim_save(w, &size);
    run(w, 30);
    const uint64_t end = plumb_world_hash(w);
    void *later = sim_save(w, &later_size);
    assert_int_equal(plumb_world_restore(other, bytes, size), PLUMB_OK);
    run(other, 30);
    assert_true(plumb_world_hash(other) == end);
    assert_int_equal(plumb_world_restore_trusted(w, bytes, size), PLUMB_OK); // rollback
    run(w, 30);
    assert_true(plumb_world_hash(w) == end);
    const size_t bound = plumb_snapshot_delta_bound(later_size);
    void *delta = malloc(bound), *again = malloc(later_size);
    size_t used, got;
    assert_int_equal(plumb_snapshot_delta(bytes, size, later, later_size, delta, bound, &used),
                     PLUMB_OK);
    assert_int_equal(plumb_snapshot_apply(bytes, size, delta, used, again, later_size, &got),
                     PLUMB_OK);
    assert_true(got == later_size && memcmp(again, later, got) == 0);
    // One where there is no air.
    plumb_world *none = make_room((plumb_world_desc){ 0 });
    size_t none_size;
    void *none_bytes = sim_save(none, &none_size);
    assert_int_equal(plumb_world_restore(w, none_bytes, none_size), PLUMB_OK);
    assert_null(plumb_air_sources(w, NULL));
    run(w, 20);
    run(none, 20);
    assert_true(plumb_world_hash(w) == plumb_world_hash(none));
    free(bytes), free(later), free(delta), free(again), free(none_bytes);
    plumb_world_destroy(w), plumb_world_destroy(other), plumb_world_destroy(none);
}

static void recordings_hold_it(void **state)
{
    (void)state;
    plumb_world *w = make_room((plumb_world_desc){ 0 });
    recording tape = { 0 };
    uint64_t hashes[41];
    int calls = 0;
    assert_int_equal(
        plumb_recorder_start(w, &(plumb_recorder_desc){ .write = to_recording, .context = &tape }),
        PLUMB_OK);
    for (int i = 1; i <= 40; ++i) {
        if (i == 10) {
            assert_int_equal(fill(w), PLUMB_OK);
        }
        if (i == 25) {
            assert_int_equal(plumb_air_fill(w, whirl, &calls), PLUMB_OK);
        }
        run(w, 1);
        hashes[i] = plumb_world_hash(w);
    }
    plumb_recorder_stop(w);
    plumb_replay *replay;
    assert_int_equal(plumb_replay_open(tape.bytes, tape.size, NULL, &replay), PLUMB_OK);
    for (int i = 1; i <= 40; ++i) {
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

// Every allocation of making and stepping fails once: the call is refused, changes nothing, and succeeds when it is tried
// again.
static uint64_t play(heap *h, long fail_at, long *calls, int *refused)
{
    *h = (heap){ .fail_at = -1 };
    plumb_world *w = make_room((plumb_world_desc){ .allocator = heap_allocator(h) });
    const plumb_air_source source = { .radius = R(0.3), .heat = 100, .smoke = 1 };
    plumb_air_desc d = small_box;
    d.left = d.right = PLUMB_AIR_PERIODIC;
    run(w, 1);
    const long before = h->calls;
    h->fail_at = fail_at < 0 ? -1 : before + fail_at;
    plumb_result r;
    while ((r = plumb_air_create(w, &d)) == PLUMB_E_MEMORY) {
        ++*refused;
        assert_int_equal(plumb_air_destroy(w), PLUMB_E_STATE);
    }
    assert_int_equal(r, PLUMB_OK);
    while ((r = plumb_air_set_sources(w, &source, 1)) == PLUMB_E_MEMORY) {
        ++*refused;
        assert_null(plumb_air_sources(w, NULL));
    }
    for (int i = 0; i < 8; ++i) {
        const uint64_t hash = plumb_world_hash(w);
        while ((r = plumb_world_step(w, DT)) == PLUMB_E_MEMORY) {
            ++*refused;
            assert_true(plumb_world_hash(w) == hash);
        }
        assert_int_equal(r, PLUMB_OK);
    }
    *calls = h->calls - before;
    const uint64_t hash = plumb_world_hash(w);
    plumb_world_destroy(w);
    assert_int_equal(h->bytes, 0);
    return hash;
}

static void any_allocation_may_fail(void **state)
{
    (void)state;
    heap_fail_each(play, 12, 200);
}

static void air_that_flows_allocates_nothing(void **state)
{
    (void)state;
    static heap h;
    h = (heap){ .fail_at = -1 };
    plumb_world *w = make_full_room((plumb_world_desc){ .allocator = heap_allocator(&h) });
    run(w, 120);
    const long calls = h.calls;
    run(w, 60);
    assert_int_equal(h.calls, calls);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(bad_settings_are_refused),
        cmocka_unit_test(a_world_that_wraps_has_none),
        API_TEST(bad_sources_are_refused),
        API_TEST(cells_are_filled_and_asked),
        cmocka_unit_test(extremes_stay_finite),
        cmocka_unit_test(pistons_in_closed_rooms),
        cmocka_unit_test(without_air_there_is_no_pass),
        cmocka_unit_test(threads_and_widths_change_no_bit),
        cmocka_unit_test(images_go_on_with_the_same_bits),
        cmocka_unit_test(recordings_hold_it),
        cmocka_unit_test(any_allocation_may_fail),
        cmocka_unit_test(air_that_flows_allocates_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
