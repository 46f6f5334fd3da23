// test_api_heat.c - heat as a user has it: refused calls, settings and their defaults, what is asked, images and rollback while bodies melt
// and burn, recordings, threads and widths, systems, out of memory.
#include "harness/heap.h"
#include "harness/recording.h"
#include "world_fixture.h"

#include <stdlib.h>

#define DT   R(1.0 / 60)
#define NAN_ ((plumb_real)NAN)
#define NONE ((plumb_body)PLUMB_NULL_INIT)

// Of world w and body b: what is set, what must not be, and how.
#define PROPERTIES(X)                                                                              \
    X(temperature, 300, 2e6, plumb_body_set_temperature(w, b, v))                                  \
    X(heat_capacity, 450, -1, plumb_body_set_heat_capacity(w, b, v))                               \
    X(conductance, 12, 2e9, plumb_body_set_conductance(w, b, v))                                   \
    X(emissivity, 0.5, 1.5, plumb_body_set_emissivity(w, b, v))                                    \
    X(ambient, 250, -1, plumb_body_set_ambient(w, b, v))                                           \
    X(heating, -40, 2e12, plumb_body_set_heating(w, b, v))                                         \
    X(melting_point, 273, -1, plumb_body_set_melting_point(w, b, v))                               \
    X(latent_heat, 3e5, -1, plumb_body_set_latent_heat(w, b, v))                                   \
    X(melt_phase, 2, 8, plumb_body_set_melt_phase(w, b, v))                                        \
    X(ignition, 600, -1, plumb_body_set_ignition(w, b, v))                                         \
    X(burn_rate, 0.25, -1, plumb_body_set_burn_rate(w, b, v))                                      \
    X(burn_heat, 1e6, -1, plumb_body_set_burn_heat(w, b, v))                                       \
    X(growth, -0.5, 101, plumb_body_set_growth(w, b, v))                                           \
    X(smallest, 0.125, 2e4, plumb_body_set_smallest(w, b, v))

static void each_is_set_and_read(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_body b = f->dynamic;
    plumb_body_desc d, all = { 0 };
    assert_int_equal(plumb_body_settings(w, b, &d), PLUMB_OK);
    assert_true(d.temperature == 0 && d.heat_capacity == 1000 && d.ambient == 293 &&
                d.smallest == R(0.02) && d.growth == 0);
#define SET(name, value, bad, call)                                                                \
    {                                                                                              \
        const plumb_real v = R(value);                                                             \
        assert_int_equal(call, PLUMB_OK);                                                          \
        assert_near(plumb_body_##name(w, b), v, 0);                                                \
        all.name = v;                                                                              \
    }
    PROPERTIES(SET)
    assert_int_equal(plumb_body_settings(w, b, &d), PLUMB_OK);
    const plumb_body made = plumb_body_create(w, &all);
#define IS(name, value, bad, call)                                                                 \
    assert_true(d.name == R(value));                                                               \
    assert_near(plumb_body_##name(w, made), R(value), 0);
    PROPERTIES(IS)
    assert_near(plumb_body_temperature(w, f->fixed), 0, 0);
    assert_near(plumb_body_heat_capacity(w, f->fixed), 1000, 0);
}

static plumb_result refused_body(plumb_world *w, const plumb_body_desc *d)
{
    assert_true(plumb_is_null(plumb_body_create(w, d)));
    return plumb_world_error(w).code;
}

#define REFUSED_AS(code, call)                                                                     \
    do {                                                                                           \
        const uint64_t before_ = digest_world(f->world);                                           \
        assert_int_equal((call), PLUMB_##code);                                                    \
        assert_true(digest_world(f->world) == before_);                                            \
    } while (0)

static void bad_calls_are_refused(void **state)
{
    fixture *f = *state;
    plumb_heat_sums sums;
#define REFUSE(name, value, bad, call)                                                             \
    {                                                                                              \
        plumb_world *w = f->world;                                                                 \
        plumb_body b = f->dynamic;                                                                 \
        plumb_real v = R(bad);                                                                     \
        REFUSED_AS(E_RANGE, call);                                                                 \
        REFUSED_AS(E_RANGE, refused_body(w, &(plumb_body_desc){ .name = v }));                     \
        v = NAN_;                                                                                  \
        REFUSED_AS(E_NOT_FINITE, call);                                                            \
        v = R(value);                                                                              \
        b = NONE;                                                                                  \
        REFUSED_AS(E_HANDLE, call);                                                                \
        assert_near(plumb_body_##name(w, b), 0, 0);                                                \
        w = NULL;                                                                                  \
        REFUSED_AS(E_NULL, call);                                                                  \
    }
    PROPERTIES(REFUSE)
    plumb_world *w = f->world;
    REFUSED(E_RANGE, "plumb_body_set_temperature: temperature is -1; it must be 0 to 1e+06",
            plumb_body_set_temperature(w, f->dynamic, -1));
    assert_int_equal(plumb_world_heat(NULL, &sums), PLUMB_E_NULL);
    REFUSED(E_NULL, "plumb_world_heat: sums is null; it must be given", plumb_world_heat(w, NULL));
    int count = 7;
    assert_null(plumb_world_body_gone_events(NULL, &count));
    assert_int_equal(count, 0);
    assert_null(plumb_world_body_gone_events(w, NULL));
    assert_int_equal(plumb_world_heat(w, &sums), PLUMB_OK);
    assert_true(sums.content == 0 && sums.gone == 0 && sums.owed == 0);
}

//---- a pile that melts and burns -----------------------------------------------------------------

static plumb_world *make_pile(plumb_world_desc desc)
{
    plumb_world *w;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    assert_int_equal(plumb_liquid_create(w, &(plumb_liquid_desc){ .spacing = R(0.1) }), PLUMB_OK);
    const plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC,
                                                                       .position = { 0, -1 },
                                                                       .temperature = 700,
                                                                       .conductance = R(1e9) });
    plumb_shape_create(w, ground, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 10, 1 } });
    for (int i = 0; i < 12; ++i) {
        plumb_body_desc d = { .position = { R(1.1 * (i % 4)), R(0.5 + i / 4) },
                              .temperature = R(260 + i),
                              .heat_capacity = 2000,
                              .conductance = R(5e5),
                              .emissivity = R(0.5),
                              .smallest = R(0.3) };
        if (i % 2 == 0) {
            d.melting_point = 273, d.latent_heat = R(1e5);
        } else {
            d.ignition = 500, d.burn_rate = R(0.05), d.burn_heat = R(1e5);
        }
        d.growth = i == 11 ? R(-0.4) : i == 10 ? R(0.1) : 0;
        const plumb_body b = plumb_body_create(w, &d);
        const plumb_shape_desc box = { .kind = PLUMB_BOX,
                                       .half = { R(0.4), R(0.4) },
                                       .density = 500 };
        const plumb_shape_desc ball = { .kind = PLUMB_CIRCLE, .radius = R(0.4), .density = 500 };
        plumb_shape_create(w, b, i % 3 == 0 ? &ball : &box);
    }
    return w;
}

static int run(plumb_world *w, int steps)
{
    int gone = 0;
    for (int i = 0; i < steps; ++i) {
        int count;
        assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
        const plumb_body_gone *e = plumb_world_body_gone_events(w, &count);
        for (int k = 0; k < count; ++k) {
            assert_false(plumb_body_valid(w, e[k].body));
            assert_true(e[k].mass >= 0 && e[k].end >= PLUMB_END_MELTED &&
                        e[k].end <= PLUMB_END_SHRUNK);
        }
        gone += count;
    }
    return gone;
}

static uint64_t hash_of(plumb_world_desc desc)
{
    plumb_world *w = make_pile(desc);
    run(w, 200);
    const uint64_t hash = plumb_world_hash(w);
    plumb_world_destroy(w);
    return hash;
}

static void threads_and_widths_change_no_bit(void **state)
{
    (void)state;
    const uint64_t hash = hash_of((plumb_world_desc){ 0 });
    const int widths[] = { 4, 8, 16 };
    for (int i = 0; i < 3; ++i) {
        assert_true(hash_of((plumb_world_desc){ .simd_width = widths[i] }) == hash);
        assert_true(hash_of((plumb_world_desc){ .workers = i + 2 }) == hash);
    }
}

static void images_go_on_with_the_same_bits(void **state)
{
    (void)state;
    plumb_world *w = make_pile((plumb_world_desc){ 0 }),
                *other = make_pile((plumb_world_desc){ 0 });
    int gone = 0, particles;
    for (int i = 0; i < 150; ++i) {
        const size_t size = plumb_world_snapshot_size(w);
        void *bytes = malloc(size);
        assert_int_equal(plumb_world_save(w, bytes, size), PLUMB_OK);
        gone += run(w, 3);
        const uint64_t hash = plumb_world_hash(w);
        assert_int_equal(plumb_world_restore(other, bytes, size), PLUMB_OK);
        run(other, 3);
        assert_true(plumb_world_hash(other) == hash);
        assert_int_equal(plumb_world_restore_trusted(w, bytes, size), PLUMB_OK); // rollback
        run(w, 2);
        free(bytes);
    }
    plumb_liquid_particles(w, &particles);
    print_message("%d bodies gone, %d particles\n", gone, particles);
    assert_true(gone > 4 && particles > 50);
    plumb_world_destroy(w), plumb_world_destroy(other);
}

static void recordings_hold_it(void **state)
{
    (void)state;
    plumb_world *w = make_pile((plumb_world_desc){ 0 });
    recording tape = { 0 };
    enum { STEPS = 240 };
    uint64_t hashes[STEPS + 1];
    assert_int_equal(
        plumb_recorder_start(w, &(plumb_recorder_desc){ .write = to_recording, .context = &tape }),
        PLUMB_OK);
    for (int i = 1; i <= STEPS; ++i) {
        if (i == 30) {
            const plumb_body first = plumb_world_bodies(w).body[0];
            assert_int_equal(plumb_body_set_heating(w, first, R(1e6)), PLUMB_OK);
        }
        run(w, 1);
        hashes[i] = plumb_world_hash(w);
    }
    plumb_recorder_stop(w);
    plumb_replay *replay;
    assert_int_equal(plumb_replay_open(tape.bytes, tape.size, NULL, &replay), PLUMB_OK);
    for (int i = 1; i <= STEPS; ++i) {
        assert_int_equal(plumb_replay_step(replay), PLUMB_OK);
        assert_true(plumb_world_hash(plumb_replay_world(replay)) == hashes[i]);
    }
    plumb_replay_close(replay);
    recording_free(&tape);
    plumb_world_destroy(w);
}

//---- systems -------------------------------------------------------------------------------------

// Bodies get their first heat in the middle of a step, and more of it than there was.
static void warm_up(const plumb_system_call *call)
{
    const plumb_body_span span = plumb_world_bodies(call->world);
    for (int i = 0; i < span.count; ++i) {
        plumb_body_set_temperature(call->world, span.body[i], R(300 + i));
        plumb_body_set_conductance(call->world, span.body[i], 100);
    }
}

static void systems_may_warm(void **state)
{
    (void)state;
    for (int phase = PLUMB_PHASE_BEGIN; phase <= PLUMB_PHASE_END; ++phase) {
        if (phase == PLUMB_PHASE_SUBSTEP) {
            continue; // for columns of those that it asks for
        }
        plumb_world *w;
        assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
        for (int i = 0; i < 40; ++i) {
            const plumb_body b =
                plumb_body_create(w, &(plumb_body_desc){ .position = { R(i % 8), R(i / 8) } });
            plumb_shape_create(w, b, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.5) });
        }
        plumb_system_desc d = { .name = "stove", .phase = (plumb_phase)phase, .run = warm_up };
        assert_int_equal(plumb_system_create(w, &d), PLUMB_OK);
        run(w, 5);
        plumb_heat_sums sums;
        plumb_world_heat(w, &sums);
        assert_true(sums.content > 40 * 300 * 700);
        plumb_world_destroy(w);
    }
}

//---- out of memory -------------------------------------------------------------------------------

static uint64_t play(heap *h, long fail_at, long *calls, int *refused)
{
    *h = (heap){ .fail_at = -1 };
    plumb_world *w = make_pile((plumb_world_desc){ .allocator = heap_allocator(h) });
    const long before = h->calls;
    h->fail_at = fail_at < 0 ? -1 : before + fail_at;
    for (int i = 0; i < 150; ++i) {
        plumb_result r;
        if (i == 3) {
            const plumb_body_span span = plumb_world_bodies(w);
            const plumb_body last = span.body[span.count - 1];
            while ((r = plumb_body_set_growth(w, last, 0)) == PLUMB_E_MEMORY) {
                ++*refused;
            }
        }
        while ((r = plumb_world_step(w, DT)) == PLUMB_E_MEMORY) {
            ++*refused;
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
    heap_fail_each(play, 1, 100000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(each_is_set_and_read),
        API_TEST(bad_calls_are_refused),
        cmocka_unit_test(threads_and_widths_change_no_bit),
        cmocka_unit_test(images_go_on_with_the_same_bits),
        cmocka_unit_test(recordings_hold_it),
        cmocka_unit_test(systems_may_warm),
        cmocka_unit_test(any_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
