// test_api_batch.c - many worlds: random numbers; the bits of each are those it has alone, whatever the workers;
// reset, randomise, observe and act.
#define _POSIX_C_SOURCE 199309L // nanosleep
#include "batch_fixture.h"

#include <time.h>

//---- random numbers ------------------------------------------------------------------------------
static void random_numbers_are_splitmix64(void **state)
{
    (void)state;
    plumb_random r = { .key = 0 }; // the published generator, seed 0
    assert_true(plumb_random_bits(&r) == UINT64_C(0xe220a8397b1dcdaf));
    assert_true(plumb_random_bits(&r) == UINT64_C(0x6e789e6aa1b965f4));
    assert_true(plumb_random_bits(&r) == UINT64_C(0x06c45d188009454f));
    assert_int_equal(r.drawn, 3);
    r.drawn = 1; // going back
    assert_true(plumb_random_bits(&r) == UINT64_C(0x6e789e6aa1b965f4));
    assert_int_equal(plumb_random_bits(NULL), 0);
}

static void random_ranges_are_even(void **state)
{
    (void)state;
    enum { draws = 100000, bins = 10 };
    int count[bins] = { 0 };
    plumb_random r = plumb_random_stream(7, 3);
    for (int i = 0; i < draws; ++i) {
        plumb_real x = plumb_random_range(&r, -2, 3);
        assert_true(x >= -2 && x < 3);
        ++count[(int)((x + 2) * 2)];
    }
    double chi = 0;
    for (int i = 0; i < bins; ++i) {
        chi += ((double)count[i] - draws / bins) * ((double)count[i] - draws / bins);
    }
    assert_true(chi / (draws / bins) < 27.9); // 9 degrees of freedom, 0.1 %
    assert_true(plumb_random_range(&r, 5, 5) == 5 && plumb_random_range(&r, 5, 4) == 5);
    assert_int_equal(r.drawn, draws + 2);
}

// Streams of neighbouring numbers, and of neighbouring seeds, do not follow one another.
static void random_streams_are_apart(void **state)
{
    (void)state;
    double sum = 0;
    enum { streams = 4000 };
    for (uint64_t i = 0; i < streams; ++i) {
        plumb_random a = plumb_random_stream(1, i), b = plumb_random_stream(1, i + 1);
        plumb_random c = plumb_random_stream(2, i);
        assert_true(a.key != b.key && a.key != c.key);
        sum += (double)(plumb_random_range(&a, -1, 1) * plumb_random_range(&b, -1, 1));
        sum += (double)(plumb_random_range(&a, -1, 1) * plumb_random_range(&c, -1, 1));
    }
    // A sum of 8,000 products of variance 1/9 each: 30 is its spread, 100 beyond three of them.
    assert_true(sum > -100 && sum < 100);
}

static void run_backwards(void *context, plumb_task_fn *task, void *job, uint32_t chunks)
{
    ++*(int *)context;
    while (chunks-- > 0) {
        task(job, chunks);
    }
}

static void workers_do_not_change_a_bit(void **state)
{
    (void)state;
    uint64_t first[WORLDS];
    int jobs = 0;
    for (int kind = 0; kind < 5; ++kind) {
        static const int workers[] = { 0, 2, 3, 8, 4 };
        plumb_batch_desc d = {
            .count = WORLDS, .workers = workers[kind], .randomise = randomise, .seed = 5
        };
        if (kind == 4) {
            d.tasks.run = run_backwards;
            d.hook_context = &jobs;
        }
        plumb_batch *batch = make(d);
        play(batch);
        for (uint32_t i = 0; i < WORLDS; ++i) {
            uint64_t hash = plumb_world_hash(plumb_batch_world(batch, i));
            first[i] = kind == 0 ? hash : first[i];
            assert_true(hash == first[i]);
            assert_true(i == 0 || hash != first[i - 1]);
        }
        plumb_batch_destroy(batch);
    }
    assert_true(jobs > 80);
}

static void a_world_is_what_it_would_be_alone(void **state)
{
    (void)state;
    plumb_batch *batch = make((plumb_batch_desc){ .count = 5, .randomise = randomise, .seed = 9 });
    plumb_world *alone;
    assert_int_equal(plumb_world_create(NULL, &alone), PLUMB_OK);
    plumb_random random = plumb_random_stream(plumb_random_stream(9, 3).key, 0);
    assert_int_equal(build(alone, 3, NULL, NULL), PLUMB_OK);
    assert_int_equal(randomise(alone, 3, &random, NULL), PLUMB_OK);
    assert_int_equal(plumb_batch_step(batch, DT, 50), PLUMB_OK);
    for (int i = 0; i < 50; ++i) {
        plumb_world_step(alone, DT);
    }
    assert_true(plumb_world_hash(plumb_batch_world(batch, 3)) == plumb_world_hash(alone));
    assert_true(plumb_world_hash(plumb_batch_world(batch, 2)) != plumb_world_hash(alone));
    plumb_world_destroy(alone);
    plumb_batch_destroy(batch);
}

//---- reset ---------------------------------------------------------------------------------------
static void a_reset_begins_a_new_episode(void **state)
{
    (void)state;
    plumb_batch *batch = make((plumb_batch_desc){ .count = 4, .randomise = randomise, .seed = 1 });
    plumb_batch *plain = make((plumb_batch_desc){ .count = 4 });
    uint64_t built = plumb_world_hash(plumb_batch_world(plain, 2));
    uint64_t begun = plumb_world_hash(plumb_batch_world(batch, 2));
    assert_true(built != begun);
    plumb_batch_step(batch, DT, 30);
    plumb_batch_step(plain, DT, 30);
    assert_int_equal(plumb_batch_reset(batch, (const uint32_t[]){ 2 }, 1), PLUMB_OK);
    assert_int_equal(plumb_batch_reset(plain, NULL, 0), PLUMB_OK);
    assert_true(plumb_world_hash(plumb_batch_world(plain, 2)) == built);
    assert_true(plumb_world_hash(plumb_batch_world(batch, 2)) != begun);
    assert_int_equal(plumb_batch_episode(batch, 2), 1);
    assert_int_equal(plumb_batch_episode(batch, 1), 0);
    assert_int_equal(plumb_batch_episode(plain, 1), 1);
    assert_int_equal(plumb_world_stats(plumb_batch_world(batch, 1)).step_count, 30);
    assert_int_equal(plumb_world_stats(plumb_batch_world(batch, 2)).step_count, 0);
    // The first episode comes back when its numbers do.
    plumb_random again = plumb_random_stream(plumb_random_stream(1, 2).key, 0);
    assert_int_equal(randomise(plumb_batch_world(plain, 2), 2, &again, NULL), PLUMB_OK);
    assert_true(plumb_world_hash(plumb_batch_world(plain, 2)) == begun);
    plumb_batch_destroy(plain);
    plumb_batch_destroy(batch);
}

static void worlds_alike_share_their_image(void **state)
{
    (void)state;
    plumb_batch *alike = make((plumb_batch_desc){ .count = 50 });
    plumb_batch *unlike = make((plumb_batch_desc){ .count = 50, .build = build_unlike });
    size_t image = plumb_world_snapshot_size(plumb_batch_world(alike, 0));
    assert_int_equal(plumb_batch_bytes(unlike) - plumb_batch_bytes(alike), 49 * image);
    plumb_batch_step(unlike, DT, 20);
    plumb_batch_reset(unlike, NULL, 0);
    for (uint32_t i = 0; i < 50; ++i) {
        assert_true(plumb_body_velocity(plumb_batch_world(unlike, i), people[CART]).x == R(i));
    }
    plumb_batch_destroy(unlike);
    plumb_batch_destroy(alike);
}

//---- observe, act --------------------------------------------------------------------------------
static void observe_gathers_every_field(void **state)
{
    (void)state;
    plumb_batch *batch =
        make((plumb_batch_desc){ .count = 3, .workers = 2, .randomise = randomise, .seed = 4 });
    plumb_batch_step(batch, DT, 25);
    const plumb_batch_field fields[] = { PLUMB_FIELD_W,     PLUMB_FIELD_X,   PLUMB_FIELD_Y,
                                         PLUMB_FIELD_ANGLE, PLUMB_FIELD_COS, PLUMB_FIELD_SIN,
                                         PLUMB_FIELD_VX,    PLUMB_FIELD_VY,  PLUMB_FIELD_X };
    const plumb_batch_view view = { &people[CART], 2, fields, 9 };
    plumb_real out[3 * 2 * 9 + 1];
    out[54] = 77;
    assert_int_equal(plumb_batch_observe(batch, &view, out, 54), PLUMB_OK);
    for (uint32_t w = 0; w < 3; ++w) {
        const plumb_world *world = plumb_batch_world(batch, w);
        for (uint32_t b = 0; b < 2; ++b) {
            const plumb_real *got = &out[(w * 2 + b) * 9];
            plumb_transform t = plumb_body_transform(world, people[CART + b]);
            plumb_vec2 v = plumb_body_velocity(world, people[CART + b]);
            const plumb_real want[] = { plumb_body_angular_velocity(world, people[CART + b]),
                                        t.p.x,
                                        t.p.y,
                                        plumb_body_angle(world, people[CART + b]),
                                        t.q.c,
                                        t.q.s,
                                        v.x,
                                        v.y,
                                        t.p.x };
            assert_memory_equal(got, want, sizeof want);
            assert_true(v.x != 0);
        }
    }
    assert_true(out[54] == 77);
    assert_int_equal(plumb_batch_observe(
                         batch, &(plumb_batch_view){ .field_count = 9, .fields = fields }, out, 0),
                     PLUMB_OK);
    plumb_batch_destroy(batch);
}

static void act_sets_and_pushes(void **state)
{
    (void)state;
    plumb_batch *batch = make((plumb_batch_desc){ .count = 2 });
    const plumb_batch_field fields[] = { PLUMB_FIELD_Y,       PLUMB_FIELD_VX,
                                         PLUMB_FIELD_W,       PLUMB_FIELD_FORCE_X,
                                         PLUMB_FIELD_FORCE_Y, PLUMB_FIELD_TORQUE };
    const plumb_batch_view view = { &people[POLE], 1, fields, 6 };
    const plumb_real in[] = { 5, 2, 3, R(0.6), R(1.2), R(0.1), 7, -2, 0, 0, 0, 0 };
    assert_int_equal(plumb_batch_act(batch, &view, in, 12), PLUMB_OK);
    plumb_world *w = plumb_batch_world(batch, 0);
    plumb_real mass = plumb_body_mass(w, people[POLE]);
    plumb_real inertia = plumb_body_inertia(w, people[POLE]);
    assert_vec_near(plumb_body_position(w, people[POLE]), 0, 5, ROUNDED(1e-6));
    assert_vec_near(plumb_body_velocity(w, people[POLE]), 2, 0, ROUNDED(1e-6));
    assert_int_equal(plumb_batch_step(batch, DT, 1), PLUMB_OK);
    assert_vec_near(plumb_body_velocity(w, people[POLE]), 2 + 0.6 / (double)mass / 60,
                    (1.2 / (double)mass - 9.81) / 60, ROUNDED(1e-5));
    assert_near(plumb_body_angular_velocity(w, people[POLE]), 3 + 0.1 / (double)inertia / 60,
                ROUNDED(1e-4));
    w = plumb_batch_world(batch, 1);
    assert_vec_near(plumb_body_velocity(w, people[POLE]), -2, -9.81 / 60, ROUNDED(1e-5));
    assert_true(plumb_body_position(w, people[POLE]).y > 6.9);
    assert_int_equal(plumb_batch_step(batch, DT, 1), PLUMB_OK); // the force was for one step
    assert_near(plumb_body_velocity(w, people[POLE]).x, -2, ROUNDED(1e-6));
    plumb_batch_destroy(batch);
}

//---- threads -------------------------------------------------------------------------------------

// Worlds and batches come, step and go on several threads at once; the sums are those of one thread.
static void *live(void *out)
{
    uint64_t sum = 0;
    for (int round = 0; round < 6; ++round) {
        plumb_world *world;
        if (plumb_world_create(NULL, &world) != PLUMB_OK) {
            return NULL;
        }
        build(world, 0, NULL, NULL);
        plumb_batch *batch = NULL;
        const plumb_batch_desc d = {
            .count = 8, .workers = 2, .build = build, .randomise = randomise
        };
        if (plumb_batch_create(&d, &batch) != PLUMB_OK) {
            return NULL;
        }
        for (int i = 0; i < 20; ++i) {
            plumb_world_step(world, DT);
        }
        plumb_batch_step(batch, DT, 20);
        sum = sum * 31 + plumb_world_hash(world);
        for (uint32_t i = 0; i < plumb_batch_count(batch); ++i) {
            sum = sum * 31 + plumb_world_hash(plumb_batch_world(batch, i));
        }
        plumb_batch_destroy(batch);
        plumb_world_destroy(world);
    }
    *(uint64_t *)out = sum;
    return NULL;
}

static void worlds_live_on_many_threads(void **state)
{
    (void)state;
    enum { threads = 4 };
    uint64_t sums[threads + 1] = { 0 };
    pthread_t thread[threads];
    for (int i = 0; i < threads; ++i) {
        assert_int_equal(pthread_create(&thread[i], NULL, live, &sums[i]), 0);
    }
    for (int i = 0; i < threads; ++i) {
        pthread_join(thread[i], NULL);
    }
    live(&sums[threads]);
    for (int i = 0; i < threads; ++i) {
        assert_true(sums[i] == sums[threads] && sums[i] != 0);
    }
}

// Between two calls nobody waits in a loop: a tenth of a second costs next to no processor time.
static void workers_sleep_between_calls(void **state)
{
    (void)state;
    plumb_batch *batch = make((plumb_batch_desc){ .count = WORLDS, .workers = 4 });
    assert_int_equal(plumb_batch_step(batch, DT, 3), PLUMB_OK);
    const struct timespec pause = { 0, 100000000 };
    nanosleep(&(struct timespec){ 0, 20000000 }, NULL);
    clock_t before = clock();
    nanosleep(&pause, NULL);
    assert_true((double)(clock() - before) / CLOCKS_PER_SEC < 0.05);
    plumb_batch_destroy(batch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_numbers_are_splitmix64),
        cmocka_unit_test(random_ranges_are_even),
        cmocka_unit_test(random_streams_are_apart),
        cmocka_unit_test(workers_do_not_change_a_bit),
        cmocka_unit_test(a_world_is_what_it_would_be_alone),
        cmocka_unit_test(a_reset_begins_a_new_episode),
        cmocka_unit_test(worlds_alike_share_their_image),
        cmocka_unit_test(observe_gathers_every_field),
        cmocka_unit_test(act_sets_and_pushes),
        cmocka_unit_test(worlds_live_on_many_threads),
        cmocka_unit_test(workers_sleep_between_calls),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
