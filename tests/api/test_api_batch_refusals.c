// test_api_batch_refusals.c - many worlds: who is refused, and that the others go on; out of memory.
#include "batch_fixture.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arguments_are_refused),
        cmocka_unit_test(null_is_no_batch),
        cmocka_unit_test(bad_descriptors_make_no_batch),
        cmocka_unit_test(a_refused_world_does_not_stop_the_others),
        cmocka_unit_test(creation_out_of_memory_leaves_nothing),
        cmocka_unit_test(a_world_out_of_memory_does_not_stop_the_others),
        cmocka_unit_test(episodes_allocate_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
