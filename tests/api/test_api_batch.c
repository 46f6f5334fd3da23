// test_api_batch.c - many worlds: the bits of each are those it has alone, whatever the workers; reset,
// randomise, observe and act; who is refused, and that the others go on; out of memory.
#include "harness/heap.h"
#include "world_fixture.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

#define DT ((plumb_real)(1.0 / 60))

//---- the worlds: a ground, a cart that is pushed, a pole that stands on it ------------------------

enum { GROUND, CART, POLE, PEOPLE };
static const plumb_body people[PEOPLE] = { { 0, 1 }, { 2, 1 }, { 4, 1 } };

static plumb_result build(plumb_world *world, uint32_t index, plumb_random *random, void *context)
{
    (void)index, (void)random, (void)context;
    const plumb_vec2 at[PEOPLE] = { { 0, -1 }, { 0, R(0.25) }, { 0, 1 } };
    const plumb_vec2 half[PEOPLE] = { { 40, 1 }, { R(0.5), R(0.25) }, { R(0.1), R(0.5) } };
    for (int i = 0; i < PEOPLE; ++i) {
        plumb_body b = plumb_body_create(
            world, &(plumb_body_desc){ .type = i == GROUND ? PLUMB_STATIC : PLUMB_DYNAMIC,
                                       .position = at[i] });
        const plumb_shape_desc box = { .kind = PLUMB_BOX, .half = half[i] };
        if (plumb_is_null(b) || plumb_is_null(plumb_shape_create(world, b, &box))) {
            return plumb_world_error(world).code;
        }
        if (b.index != people[i].index || b.generation != people[i].generation) {
            return PLUMB_E_STATE;
        }
    }
    return PLUMB_OK;
}

static plumb_result randomise(plumb_world *world, uint32_t index, plumb_random *random,
                              void *context)
{
    (void)index, (void)context;
    plumb_vec2 v = { plumb_random_range(random, -1, 1), 0 };
    plumb_result r = plumb_body_set_velocity(world, people[CART], v);
    return r != PLUMB_OK ? r
                         : plumb_body_set_angular_velocity(world, people[POLE],
                                                           plumb_random_range(random, -1, 1));
}

static plumb_batch *make(plumb_batch_desc d)
{
    plumb_batch *batch = NULL;
    d.build = d.build == NULL ? build : d.build;
    assert_int_equal(plumb_batch_create(&d, &batch), PLUMB_OK);
    assert_non_null(batch);
    return batch;
}

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

//---- bits ----------------------------------------------------------------------------------------

enum { WORLDS = 37 };

static void run_backwards(void *context, plumb_task_fn *task, void *job, uint32_t chunks)
{
    ++*(int *)context;
    while (chunks-- > 0) {
        task(job, chunks);
    }
}

static void play(plumb_batch *batch)
{
    const plumb_batch_field push[] = { PLUMB_FIELD_FORCE_X };
    const plumb_batch_view how = { &people[CART], 1, push, 1 };
    plumb_real force[WORLDS];
    for (int step = 0; step < 40; ++step) {
        for (int i = 0; i < WORLDS; ++i) {
            force[i] = R((i + step) % 5 - 2);
        }
        assert_int_equal(plumb_batch_act(batch, &how, force, WORLDS), PLUMB_OK);
        assert_int_equal(plumb_batch_step(batch, DT, 2), PLUMB_OK);
        const uint32_t some[] = { 30, 2, (uint32_t)step % 20 + 5 };
        if (step % 8 == 7) {
            assert_int_equal(plumb_batch_reset(batch, some, 3), PLUMB_OK);
        }
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

static plumb_result build_unlike(plumb_world *world, uint32_t index, plumb_random *random,
                                 void *context)
{
    plumb_result r = build(world, index, random, context);
    plumb_vec2 v = { R(index), 0 };
    return r != PLUMB_OK ? r : plumb_body_set_velocity(world, people[CART], v);
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
    assert_vec_near(plumb_body_position(w, people[POLE]), 0, 5, 1e-6);
    assert_vec_near(plumb_body_velocity(w, people[POLE]), 2, 0, 1e-6);
    assert_int_equal(plumb_batch_step(batch, DT, 1), PLUMB_OK);
    assert_vec_near(plumb_body_velocity(w, people[POLE]), 2 + 0.6 / (double)mass / 60,
                    (1.2 / (double)mass - 9.81) / 60, 1e-5);
    assert_near(plumb_body_angular_velocity(w, people[POLE]), 3 + 0.1 / (double)inertia / 60, 1e-4);
    w = plumb_batch_world(batch, 1);
    assert_vec_near(plumb_body_velocity(w, people[POLE]), -2, -9.81 / 60, 1e-5);
    assert_true(plumb_body_position(w, people[POLE]).y > 6.9);
    assert_int_equal(plumb_batch_step(batch, DT, 1), PLUMB_OK); // the force was for one step
    assert_near(plumb_body_velocity(w, people[POLE]).x, -2, 1e-6);
    plumb_batch_destroy(batch);
}

//---- refused calls -------------------------------------------------------------------------------

#define REFUSED_BY(batch, code_, message_, call)                                                   \
    do {                                                                                           \
        assert_int_equal((call), PLUMB_##code_);                                                   \
        assert_int_equal(plumb_batch_error(batch).code, PLUMB_##code_);                            \
        assert_string_equal(plumb_batch_error(batch).message, (message_));                         \
    } while (0)

static void arguments_are_refused(void **state)
{
    (void)state;
    plumb_batch *b = make((plumb_batch_desc){ .count = 3 });
    uint64_t before = plumb_world_hash(plumb_batch_world(b, 1));
    plumb_real numbers[9] = { 0 };
    const plumb_batch_field x = PLUMB_FIELD_X, force = PLUMB_FIELD_FORCE_X;
    const plumb_batch_field cos = PLUMB_FIELD_COS, none = (plumb_batch_field)11;
    const plumb_batch_field twice[] = { PLUMB_FIELD_VX, PLUMB_FIELD_VX };
    const uint32_t same[] = { 1, 0, 1 }, far[] = { 3 };
    assert_string_equal(plumb_batch_error(b).message, "");
    REFUSED_BY(b, E_RANGE, "plumb_batch_step: dt is 0; it must be above 0 and at most 1",
               plumb_batch_step(b, 0, 1));
    REFUSED_BY(b, E_NOT_FINITE, "plumb_batch_step: dt is not finite",
               plumb_batch_step(b, (plumb_real)NAN, 1));
    REFUSED_BY(b, E_RANGE, "plumb_batch_step: steps is -1; it must be 0 to 1000000",
               plumb_batch_step(b, DT, -1));
    REFUSED_BY(b, E_RANGE, "plumb_batch_reset: worlds[0] is 3; it must be below 3",
               plumb_batch_reset(b, far, 1));
    REFUSED_BY(b, E_DUPLICATE, "plumb_batch_reset: worlds[2] is 1 for the second time",
               plumb_batch_reset(b, same, 3));
    REFUSED_BY(b, E_NULL, "plumb_batch_observe: view is null; it must be given",
               plumb_batch_observe(b, NULL, numbers, 9));
    plumb_batch_view v = { people, PEOPLE, &x, 1 };
    REFUSED_BY(b, E_NULL, "plumb_batch_observe: numbers is null; it must be given",
               plumb_batch_observe(b, &v, NULL, 9));
    REFUSED_BY(b, E_RANGE, "plumb_batch_observe: capacity is 8; it must be at least 9",
               plumb_batch_observe(b, &v, numbers, 8));
    v.bodies = NULL;
    REFUSED_BY(b, E_NULL, "plumb_batch_act: view.bodies is null; it must be given",
               plumb_batch_act(b, &v, numbers, 9));
    v = (plumb_batch_view){ people, PEOPLE, NULL, 1 };
    REFUSED_BY(b, E_NULL, "plumb_batch_act: view.fields is null; it must be given",
               plumb_batch_act(b, &v, numbers, 9));
    v = (plumb_batch_view){ people, (1u << 20) + 1, &x, 1 };
    REFUSED_BY(b, E_RANGE, "plumb_batch_act: view.body_count is 1048577; it must be 0 to 1048576",
               plumb_batch_act(b, &v, numbers, 9));
    v = (plumb_batch_view){ people, 1, &x, 65 };
    REFUSED_BY(b, E_RANGE, "plumb_batch_act: view.field_count is 65; it must be 0 to 64",
               plumb_batch_act(b, &v, numbers, 9));
    v = (plumb_batch_view){ people, 1, &force, 1 };
    REFUSED_BY(b, E_RANGE,
               "plumb_batch_observe: fields[0] is 8; it must be a field that can be read",
               plumb_batch_observe(b, &v, numbers, 9));
    v.fields = &cos;
    REFUSED_BY(b, E_RANGE,
               "plumb_batch_act: fields[0] is 2; it must be a field that can be written",
               plumb_batch_act(b, &v, numbers, 9));
    v.fields = &none;
    REFUSED_BY(b, E_RANGE,
               "plumb_batch_act: fields[0] is 11; it must be a field that can be written",
               plumb_batch_act(b, &v, numbers, 9));
    v = (plumb_batch_view){ people, 1, twice, 2 };
    REFUSED_BY(b, E_DUPLICATE, "plumb_batch_act: fields[1] is 5 for the second time",
               plumb_batch_act(b, &v, numbers, 9));
    assert_true(plumb_world_hash(plumb_batch_world(b, 1)) == before);
    assert_int_equal(plumb_batch_error(b).world_count, 0);
    assert_null(plumb_batch_world(b, 3));
    assert_int_equal(plumb_batch_result(b, 3), PLUMB_E_RANGE);
    assert_int_equal(plumb_batch_episode(b, 3), 0);
    plumb_batch_destroy(b);
}

static void null_is_no_batch(void **state)
{
    (void)state;
    plumb_real number = 0;
    const plumb_batch_view view = { 0 };
    assert_int_equal(plumb_batch_step(NULL, DT, 1), PLUMB_E_NULL);
    assert_int_equal(plumb_batch_reset(NULL, NULL, 0), PLUMB_E_NULL);
    assert_int_equal(plumb_batch_observe(NULL, &view, &number, 1), PLUMB_E_NULL);
    assert_int_equal(plumb_batch_act(NULL, &view, &number, 1), PLUMB_E_NULL);
    assert_int_equal(plumb_batch_result(NULL, 0), PLUMB_E_RANGE);
    assert_int_equal(plumb_batch_error(NULL).code, PLUMB_OK);
    assert_int_equal(plumb_batch_count(NULL), 0);
    assert_int_equal(plumb_batch_bytes(NULL), 0);
    assert_int_equal(plumb_batch_episode(NULL, 0), 0);
    assert_null(plumb_batch_world(NULL, 0));
    plumb_batch_destroy(NULL);
}

static plumb_result refuse_third(plumb_world *world, uint32_t index, plumb_random *random,
                                 void *context)
{
    (void)world, (void)random, (void)context;
    return index == 2 ? PLUMB_E_MISSING : PLUMB_OK;
}

static void bad_descriptors_make_no_batch(void **state)
{
    (void)state;
    fixture f = { .errors = 0 };
    plumb_world_desc world = { .log = keep_log, .hook_context = &f };
    plumb_batch_desc d = { .world = &world };
    plumb_batch *b = (plumb_batch *)(void *)&f;
    const struct {
        plumb_batch_desc desc;
        plumb_result code;
        const char *message;
    } rows[] = {
        { { .count = 0 },
          PLUMB_E_RANGE,
          "plumb_batch_create: count is 0; it must be 1 to 1048576" },
        { { .count = 1048577 },
          PLUMB_E_RANGE,
          "plumb_batch_create: count is 1048577; it must be 1 to 1048576" },
        { { .count = 1, .workers = -1 },
          PLUMB_E_RANGE,
          "plumb_batch_create: workers is -1; it must be 0 to 64" },
        { { .count = 1, .workers = 65 },
          PLUMB_E_RANGE,
          "plumb_batch_create: workers is 65; it must be 0 to 64" },
        { { .count = 5, .build = refuse_third },
          PLUMB_E_MISSING,
          "plumb_batch_create: the thing asked for is not there" },
        { { .count = 5, .randomise = refuse_third },
          PLUMB_E_MISSING,
          "plumb_batch_create: the thing asked for is not there" },
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        d = rows[i].desc;
        d.world = &world;
        b = (plumb_batch *)(void *)&f;
        assert_int_equal(plumb_batch_create(&d, &b), rows[i].code);
        assert_null(b);
        assert_string_equal(f.logged, rows[i].message);
    }
    d = (plumb_batch_desc){ .count = 1, .world = &world };
    world.workers = 2;
    assert_int_equal(plumb_batch_create(&d, &b), PLUMB_E_RANGE);
    assert_string_equal(f.logged, "plumb_batch_create: world.workers is 2; worlds of a batch work "
                                  "with one thread and no tasks");
    world.workers = 0;
    world.substeps = 65; // the world's own refusal
    assert_int_equal(plumb_batch_create(&d, &b), PLUMB_E_RANGE);
    assert_int_equal(plumb_batch_create(&d, NULL), PLUMB_E_NULL);
    assert_string_equal(f.logged, "plumb_batch_create: batch is null; it must be given");
    assert_int_equal(plumb_batch_create(NULL, &b), PLUMB_E_NULL);
    assert_null(b);
}

// A stale handle and a number that is not finite, in one world each: the others are read and moved.
static void a_refused_world_does_not_stop_the_others(void **state)
{
    (void)state;
    plumb_batch *b = make((plumb_batch_desc){ .count = 6, .workers = 2 });
    plumb_body_destroy(plumb_batch_world(b, 4), people[POLE]);
    const plumb_batch_field vx = PLUMB_FIELD_VX;
    const plumb_batch_view view = { &people[CART], 2, &vx, 1 };
    plumb_real in[12] = { 1, 1, 1, 1, 1, (plumb_real)NAN, 1, 1, 1, 1, 1, 1 }, out[12];
    REFUSED_BY(b, E_NOT_FINITE,
               "world 2: plumb_body_set_velocity: velocity is (nan, 0); it must be finite",
               plumb_batch_act(b, &view, in, 12));
    assert_int_equal(plumb_batch_error(b).world, 2);
    assert_int_equal(plumb_batch_error(b).world_count, 2);
    const plumb_result results[] = { PLUMB_OK, PLUMB_OK,       PLUMB_E_NOT_FINITE,
                                     PLUMB_OK, PLUMB_E_HANDLE, PLUMB_OK };
    for (uint32_t i = 0; i < 6; ++i) {
        assert_int_equal(plumb_batch_result(b, i), results[i]);
    }
    REFUSED_BY(b, E_HANDLE,
               "world 4: plumb_batch_observe: body is stale (4:1); it must be a live body",
               plumb_batch_observe(b, &view, out, 12));
    const plumb_real seen[12] = { 1, 1, 1, 1, 1, 0, 1, 1, 1, 0, 1, 1 };
    assert_memory_equal(out, seen, sizeof seen);
    plumb_batch_destroy(b);
}

//---- memory --------------------------------------------------------------------------------------

static void creation_out_of_memory_leaves_nothing(void **state)
{
    (void)state;
    heap h = { .fail_at = 0, .from_there = true };
    const plumb_world_desc world = { .allocator = heap_allocator(&h) };
    const plumb_batch_desc d = { .count = 3,
                                 .workers = 2,
                                 .world = &world,
                                 .build = build_unlike,
                                 .randomise = randomise,
                                 .allocator = heap_allocator(&h) };
    plumb_batch *batch = NULL;
    plumb_result r = PLUMB_E_MEMORY;
    while (r == PLUMB_E_MEMORY) {
        atomic_store(&h.calls, 0);
        r = plumb_batch_create(&d, &batch);
        if (r == PLUMB_E_MEMORY) {
            assert_null(batch);
            assert_int_equal(h.blocks, 0);
            assert_int_equal(h.bytes, 0);
        }
        ++h.fail_at;
    }
    assert_int_equal(r, PLUMB_OK);
    assert_in_range(h.fail_at, 20, 10000);
    assert_int_equal(plumb_batch_bytes(batch), h.bytes);
    plumb_batch_destroy(batch);
    assert_int_equal(h.blocks, 0);
}

static void a_world_out_of_memory_does_not_stop_the_others(void **state)
{
    (void)state;
    heap h = { .fail_at = -1, .from_there = true };
    const plumb_world_desc desc = { .allocator = heap_allocator(&h) };
    plumb_batch *b = make((plumb_batch_desc){ .count = 6, .workers = 2, .world = &desc });
    assert_int_equal(plumb_batch_step(b, DT, 60), PLUMB_OK);
    build(plumb_batch_world(b, 3), 3, NULL, NULL); // as many bodies again: room is needed
    plumb_vec2 before = plumb_body_position(plumb_batch_world(b, 3), people[CART]);
    h.fail_at = 0;
    REFUSED_BY(b, E_MEMORY, "world 3: plumb_world_step: the allocator returned no memory",
               plumb_batch_step(b, DT, 10));
    assert_int_equal(plumb_batch_error(b).world, 3);
    assert_int_equal(plumb_batch_error(b).world_count, 1);
    plumb_vec2 after = plumb_body_position(plumb_batch_world(b, 3), people[CART]);
    assert_true(after.x == before.x && after.y == before.y);
    assert_int_equal(plumb_world_stats(plumb_batch_world(b, 3)).step_count, 60);
    assert_int_equal(plumb_world_stats(plumb_batch_world(b, 4)).step_count, 70);
    h.fail_at = -1;
    assert_int_equal(plumb_batch_step(b, DT, 10), PLUMB_OK);
    assert_int_equal(plumb_batch_result(b, 3), PLUMB_OK);
    plumb_batch_destroy(b);
    assert_int_equal(h.blocks, 0);
}

// Episodes that repeat: each world has held as much before.
static void episodes_allocate_nothing(void **state)
{
    (void)state;
    heap h = HEAP_INIT;
    const plumb_world_desc desc = { .allocator = heap_allocator(&h) };
    plumb_batch *b = make((plumb_batch_desc){
        .count = WORLDS, .workers = 2, .world = &desc, .allocator = heap_allocator(&h) });
    const plumb_batch_field fields[] = { PLUMB_FIELD_X, PLUMB_FIELD_VX };
    const plumb_batch_view view = { &people[CART], 1, fields, 2 };
    plumb_real numbers[WORLDS * 2];
    for (int warm = 0; warm < 2; ++warm) {
        play(b);
        plumb_batch_reset(b, NULL, 0);
    }
    long calls = h.calls;
    play(b);
    plumb_batch_reset(b, NULL, 0);
    plumb_batch_observe(b, &view, numbers, WORLDS * 2);
    assert_int_equal(h.calls, calls);
    plumb_batch_destroy(b);
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
        cmocka_unit_test(arguments_are_refused),
        cmocka_unit_test(null_is_no_batch),
        cmocka_unit_test(bad_descriptors_make_no_batch),
        cmocka_unit_test(a_refused_world_does_not_stop_the_others),
        cmocka_unit_test(creation_out_of_memory_leaves_nothing),
        cmocka_unit_test(a_world_out_of_memory_does_not_stop_the_others),
        cmocka_unit_test(episodes_allocate_nothing),
        cmocka_unit_test(worlds_live_on_many_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
