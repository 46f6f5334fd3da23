// test_api_memory.c - out of memory: a script that uses all of the API runs with an allocator that
// fails its k-th call, for every k. A refused call changes nothing and succeeds when it is tried
// again; the script ends in the same state as without failures, and every byte is given back.
#include "harness/heap.h"
#include "harness/trials.h"
#include "world_fixture.h"

//---- the script ----------------------------------------------------------------------------------

typedef struct run {
    heap heap;
    plumb_world *world;
    plumb_body bodies[24];
    int refused;
    bool keep_trying;
} run;

// Repeats a call that runs out of memory; before, the world must be what it was.
#define TRY(r, call)                                                                               \
    do {                                                                                           \
        uint64_t before_ = digest_world((r)->world);                                               \
        while ((call) == PLUMB_E_MEMORY) {                                                         \
            ++(r)->refused;                                                                        \
            assert_true(digest_world((r)->world) == before_);                                      \
            assert_int_equal(plumb_world_stats((r)->world).bytes, (r)->heap.bytes);                \
            if (!(r)->keep_trying) {                                                               \
                return false;                                                                      \
            }                                                                                      \
        }                                                                                          \
    } while (0)

#define TRY_MAKE(r, handle, call) TRY(r, made((r)->world, handle = (call)))

static const plumb_vec2 ell[] = { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } };
// The second half is two links in a line: bodies on them rest on a run (src/internal_edges).
static const plumb_vec2 ground[] = { { -40, 0 }, { 0, -1 }, { R(2), R(-0.95) }, { 40, 0 } };

// As if there were threads: what they need is reserved, too.
static void run_here(void *hook_context, plumb_task_fn *task, void *context, uint32_t chunks)
{
    (void)hook_context;
    for (uint32_t i = 0; i < chunks; ++i) {
        task(context, i);
    }
}

static bool make_world(run *r)
{
    const plumb_world_desc desc = { .allocator = heap_allocator(&r->heap),
                                    .body_capacity = 4,
                                    .shape_capacity = 4,
                                    .contact_capacity = 8,
                                    .workers = 2,
                                    .tasks = { run_here },
                                    .hit_speed = 1 };
    while (plumb_world_create(&desc, &r->world) == PLUMB_E_MEMORY) {
        assert_null(r->world);
        assert_int_equal(r->heap.blocks, 0);
        ++r->refused;
        if (!r->keep_trying) {
            return false;
        }
    }
    return true;
}

static bool fill_world(run *r)
{
    plumb_shape shape;
    plumb_material ice;
    plumb_body base;
    TRY_MAKE(r, ice,
             plumb_material_create(r->world, &(plumb_material_desc){ .restitution = R(0.5) }));
    TRY_MAKE(r, base, plumb_body_create(r->world, &(plumb_body_desc){ .type = PLUMB_STATIC }));
    TRY_MAKE(r, shape,
             plumb_shape_create(
                 r->world, base,
                 &(plumb_shape_desc){ .kind = PLUMB_CHAIN, .points = ground, .count = 4 }));
    const plumb_material none = PLUMB_NULL_INIT;
    TRY(r, plumb_material_pair_set(
               r->world, ice, none,
               &(plumb_material_pair){ .friction = R(0.25), .rolling_resistance = R(0.01) }));
    TRY_MAKE(r, shape,
             plumb_shape_create(r->world, base,
                                &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                     .half = { 3, 2 },
                                                     .filter = { .category = 2 },
                                                     .sensor = true }));
    const plumb_shape_desc descs[] = {
        { .kind = PLUMB_CIRCLE, .radius = R(0.5), .material = ice },
        { .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } },
        { .kind = PLUMB_CAPSULE, .points = ell, .count = 2, .radius = R(0.25) },
        { .kind = PLUMB_OUTLINE, .points = ell, .count = 6 },
        { .kind = PLUMB_POLYGON, .points = ell, .count = 6 },
    };
    for (int i = 0; i < 24; ++i) {
        const plumb_body_desc desc = { .position = { R(i % 6 * 2.5 - 6), R(1 + i / 6 * 2.25) },
                                       .type = i % 7 == 6 ? PLUMB_KINEMATIC : PLUMB_DYNAMIC };
        TRY_MAKE(r, r->bodies[i], plumb_body_create(r->world, &desc));
        TRY_MAKE(r, shape, plumb_shape_create(r->world, r->bodies[i], &descs[i % 5]));
    }
    TRY(r, plumb_body_set_damping(r->world, r->bodies[2], 1, 0));
    TRY(r, plumb_body_set_time_scale(r->world, r->bodies[8], R(0.5)));
    TRY(r, plumb_body_set_speed_cap(r->world, r->bodies[9], 9, 9));
    TRY(r, plumb_body_set_locks(r->world, r->bodies[10], (plumb_axis_locks){ .x = true }));
    TRY(r, plumb_body_set_target(r->world, r->bodies[6], plumb_v2(9, 9), 1, R(0.25)));
    TRY(r, plumb_body_set_target_moving(r->world, r->bodies[6], plumb_v2(9, 9), 1, plumb_v2(1, 0),
                                        0, R(0.25)));
    TRY(r, plumb_world_exclude_pair(r->world, r->bodies[0], r->bodies[1], true));
    // A kinematic character among them, one that stands on a plank, and a dynamic one.
    TRY_MAKE(r, base, plumb_body_create(r->world, &(plumb_body_desc){ .position = { 20, 1 } }));
    TRY_MAKE(r, shape,
             plumb_shape_create(r->world, base,
                                &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                     .half = { 2, R(0.25) },
                                                     .one_way = { { 0, 1 }, 0 } }));
    TRY(r, plumb_character_create(r->world, r->bodies[6], NULL));
    TRY(r, plumb_character_create(r->world, r->bodies[13], NULL));
    TRY(r, plumb_character_create(r->world, r->bodies[0], NULL));
    plumb_body_teleport(r->world, r->bodies[13], plumb_v2(20, R(1.8)), 0);
    plumb_character_walk(r->world, r->bodies[6], 2);
    plumb_character_walk(r->world, r->bodies[13], R(0.25));
    plumb_character_walk(r->world, r->bodies[0], -1);
    return true;
}

// At the end of a step: systems before it run again when a step that was refused is tried again.
static void push(const plumb_system_call *call)
{
    plumb_body_span b = plumb_world_bodies(call->world);
    for (int i = 0; i < b.dynamic_count; ++i) {
        b.vx[i] += R(0.01);
    }
}

static plumb_result make_component(run *r, plumb_component *c)
{
    const plumb_field field = { "level", PLUMB_FIELD_F32, 0, "m" };
    *c = plumb_component_create(
        r->world,
        &(plumb_component_desc){ .name = "fuel", .size = 32, .fields = &field, .field_count = 1 });
    return c->id == 0 ? plumb_world_error(r->world).code : PLUMB_OK;
}

static bool extend_world(run *r)
{
    plumb_component fuel;
    plumb_entity e;
    TRY(r, make_component(r, &fuel));
    TRY(r, plumb_system_create(r->world, &(plumb_system_desc){ .name = "push",
                                                               .phase = PLUMB_PHASE_END,
                                                               .run = push,
                                                               .needs = { fuel } }));
    for (int i = 0; i < 10; ++i) {
        TRY_MAKE(r, e, plumb_entity_create(r->world));
        TRY(r, plumb_component_set(r->world, e, fuel, NULL));
    }
    for (int i = 24; i-- > 0;) { // against the order of rows, which the next step makes
        TRY(r, plumb_component_set(r->world, r->bodies[i].entity, fuel, NULL));
    }
    plumb_body_view view;
    TRY(r, plumb_body_view_open(r->world, &(plumb_body_view_desc){ .with = { fuel } }, &view));
    plumb_body b;
    plumb_shape s;
    TRY_MAKE(r, b,
             plumb_command_body_create(r->world, &(plumb_body_desc){ .position = { 0, 20 } }));
    TRY_MAKE(
        r, s,
        plumb_command_shape_create(
            r->world, b, &(plumb_shape_desc){ .kind = PLUMB_OUTLINE, .points = ell, .count = 6 }));
    TRY_MAKE(r, e, plumb_command_entity_create(r->world));
    TRY(r, plumb_command_component_set(r->world, e, fuel, NULL));
    TRY(r, plumb_command_teleport(r->world, b, plumb_v2(1, 20), 1));
    TRY(r, plumb_command_component_remove(r->world, e, fuel));
    TRY(r, plumb_command_destroy(r->world, r->bodies[3].entity));
    return true;
}

// Applies commands: what was done before memory ran out stays done, so only the end is compared.
static bool apply(run *r)
{
    while (plumb_commands_apply(r->world) == PLUMB_E_MEMORY) {
        ++r->refused;
        if (!r->keep_trying) {
            return false;
        }
    }
    return true;
}

static uint64_t digest_places(const run *r)
{
    uint64_t digest = UINT64_C(14695981039346656037);
    for (int i = 0; i < 24; ++i) {
        plumb_transform t = plumb_body_transform(r->world, r->bodies[i]);
        digest_bytes(&digest, &t, sizeof t);
    }
    return digest;
}

// Everybody is put to sleep, and wakes bit by bit. A step that is refused may have woken bodies, which
// changes their rows, but it has moved nobody.
static bool sleep_and_wake(run *r)
{
    int slept = 0, woken = 0;
    plumb_world_set_sleep(r->world, true, 1, R(0.2));
    plumb_system_enable(r->world, "push", false);
    for (int i = 0; i < 24; ++i) {
        TRY(r, plumb_body_sleep(r->world, r->bodies[i]));
    }
    for (int i = 0; i < 180; ++i) {
        int fell, woke;
        if (i % 6 == 0 && i < 60) {
            plumb_body_apply_impulse_center(r->world, r->bodies[i / 3], plumb_v2(0, 1));
        }
        uint64_t before = digest_places(r);
        while (plumb_world_step(r->world, R(1.0 / 60)) == PLUMB_E_MEMORY) {
            ++r->refused;
            assert_true(digest_places(r) == before);
            if (!r->keep_trying) {
                return false;
            }
        }
        plumb_world_sleep_events(r->world, &fell);
        plumb_world_wake_events(r->world, &woke);
        slept += fell;
        woken += woke;
    }
    assert_in_range(slept, 4, 100);
    assert_in_range(woken, 10, 100);
    return true;
}

static bool play(run *r)
{
    if (!make_world(r) || !fill_world(r) || !extend_world(r) || !apply(r)) {
        return false;
    }
    for (int i = 0; i < 40; ++i) {
        TRY(r, plumb_world_step(r->world, R(1.0 / 60)));
        if (i == 20) {
            plumb_body_destroy(r->world, r->bodies[5]);
            assert_int_equal(plumb_body_set_type(r->world, r->bodies[7], PLUMB_STATIC), PLUMB_OK);
            assert_int_equal(plumb_body_set_enabled(r->world, r->bodies[12], false), PLUMB_OK);
        }
        if (i == 25) {
            const plumb_explosion_desc blast = { .radius = 9,
                                                 .impulse = 1,
                                                 .occlusion = PLUMB_OCCLUDE_ALL };
            TRY(r, plumb_world_set_workers(r->world, 3));
            TRY(r, plumb_world_explode(r->world, &blast));
            assert_int_equal(plumb_body_set_type(r->world, r->bodies[7], PLUMB_DYNAMIC), PLUMB_OK);
            assert_int_equal(plumb_body_set_enabled(r->world, r->bodies[12], true), PLUMB_OK);
        }
    }
    plumb_contact contacts[4];
    plumb_world_contacts(r->world, contacts, 4);
    return sleep_and_wake(r);
}

// Returns the digest at the end; 0 when the script was given up.
static uint64_t run_script(run *r, long fail_at, bool from_there)
{
    *r = (run){ .heap = { .fail_at = fail_at, .from_there = from_there },
                .keep_trying = !from_there };
    uint64_t digest = play(r) ? digest_world(r->world) : 0;
    if (r->world != NULL) {
        assert_int_equal(plumb_world_stats(r->world).bytes, r->heap.bytes);
    }
    plumb_world_destroy(r->world);
    assert_int_equal(r->heap.bytes, 0);
    assert_int_equal(r->heap.blocks, 0);
    return digest;
}

static void any_single_allocation_may_fail(void **state)
{
    (void)state;
    static run r;
    uint64_t digest = run_script(&r, -1, false);
    long calls = r.heap.calls;
    assert_int_equal(r.refused, 0);
    assert_in_range(calls, 30, 5000);
    long unequal = 0;
    for (long k = 0; k < calls; ++k) {
        if (!trials_takes((uint32_t)k, 4)) {
            continue;
        }
        bool same = run_script(&r, k, false) == digest;
        unequal += same ? 0 : 1;
        assert_in_range(r.refused, 1, 2);
    }
    print_message("%ld allocations, each failed once; %ld with another end\n", calls, unequal);
    // Not mended yet: sensors that run out of room in a step in which others fall asleep cost a warm start.
    assert_int_equal(unequal, 0);
}

static void memory_may_run_out_for_good_at_any_time(void **state)
{
    (void)state;
    static run r;
    run_script(&r, -1, false);
    long calls = r.heap.calls;
    for (long k = 0; k < calls; ++k) {
        assert_true(run_script(&r, k, true) == 0);
        assert_int_equal(r.refused, 1);
    }
}

static void a_steady_state_step_allocates_nothing(void **state)
{
    (void)state;
    static run r;
    r = (run){ .heap = { .fail_at = -1 }, .keep_trying = true };
    assert_true(play(&r));
    for (int i = 0; i < 400; ++i) {
        plumb_world_step(r.world, R(1.0 / 60));
    }
    long calls = r.heap.calls;
    for (int i = 0; i < 60; ++i) {
        assert_int_equal(plumb_world_step(r.world, R(1.0 / 60)), PLUMB_OK);
    }
    assert_int_equal(r.heap.calls, calls);
    plumb_world_destroy(r.world);
}

// A ground and two crates on it, stepped: what a batch holds of each of thousands of worlds.
static void a_small_world_is_small(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .simd_width = 8 }, &w), PLUMB_OK);
    for (int i = 0; i < 3; ++i) {
        const plumb_body body =
            plumb_body_create(w, &(plumb_body_desc){ .type = i == 0 ? PLUMB_STATIC : PLUMB_DYNAMIC,
                                                     .position = { 0, R(1.5 * i) } });
        plumb_shape_create(
            w, body,
            &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { i == 0 ? 10 : R(0.5), R(0.5) } });
    }
    for (int i = 0; i < 120; ++i) {
        plumb_world_step(w, R(1.0 / 60));
    }
    // Measured: 38,016 B in the float library, of which 10,752 are the world itself; 49,912 in the double one, with 16 lanes,
    // the choice of some machines, which take 2,200 more.
    assert_in_range(plumb_world_stats(w).peak_bytes, 1, PLUMB_REAL_IS_DOUBLE ? 50500 : 38500);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_small_world_is_small),
        cmocka_unit_test(any_single_allocation_may_fail),
        cmocka_unit_test(memory_may_run_out_for_good_at_any_time),
        cmocka_unit_test(a_steady_state_step_allocates_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
