// test_api_loop.c - plumb/loop.h and the blends of math.h: how many steps frames make, where bodies are between them,
// what does not smear, every refusal.
#include "harness/heap.h"
#include "harness/random.h"
#include "world_fixture.h"

static const double TAU = 6.283185307179586;

static void blends_go_the_shorter_way(void **state)
{
    (void)state;
    uint32_t seed = 3;
    for (int i = 0; i < 5000; ++i) {
        const double a = sim_uniform(&seed, -4, 4), turn = sim_uniform(&seed, -3.14, 3.14);
        const double t = sim_uniform(&seed, 0, 1);
        const plumb_rot from = plumb_rot_make(R(a)), to = plumb_rot_make(R(a + turn));
        const plumb_rot q = plumb_rot_blend(from, to, R(t));
        assert_near(cos(a + t * turn), q.c, ROUNDED(3e-6));
        assert_near(sin(a + t * turn), q.s, ROUNDED(3e-6));
    }
    const plumb_transform a = plumb_transform_make(plumb_v2(1, 2), 1);
    const plumb_transform b = plumb_transform_make(plumb_v2(3, -2), -1);
    const plumb_transform middle = plumb_transform_blend(a, b, R(0.5));
    assert_vec_near(middle.p, 2, 0, ROUNDED(1e-6));
    assert_near(plumb_rot_angle(middle.q), 0, ROUNDED(1e-6));
    assert_near(plumb_rot_angle(plumb_transform_blend(a, b, 1).q), -1, ROUNDED(1e-6));
}

static plumb_loop *make_loop(plumb_world *w, plumb_loop_desc desc)
{
    plumb_loop *loop;
    assert_int_equal(plumb_loop_create(w, &desc, &loop), PLUMB_OK);
    return loop;
}

static void frames_make_steps(void **state)
{
    fixture *f = *state;
    plumb_loop *loop = make_loop(f->world, (plumb_loop_desc){ 0 });
    uint32_t seed = 5;
    double time = 0;
    int steps = 0;
    assert_true(plumb_loop_alpha(loop) == 0);
    for (int i = 0; i < 20000; ++i) { // frames of any length: no time is lost or won
        const double frame = sim_uniform(&seed, 0, 0.04);
        steps += plumb_loop_frame(loop, frame);
        time += frame;
        const double alpha = (double)plumb_loop_alpha(loop);
        assert_true(alpha >= 0 && alpha <= 1);
        assert_near(((double)steps + alpha) / 60 - time, 0, 1e-6);
    }
    plumb_loop_destroy(loop);
    loop = make_loop(f->world, (plumb_loop_desc){ .dt = 0.01, .steps_max = 3 });
    for (int i = 0; i < 1000; ++i) { // a frame a step, though a hundredth is no binary number
        assert_int_equal(plumb_loop_frame(loop, 0.01), 1);
    }
    assert_int_equal(plumb_loop_frame(loop, 0), 0);
    assert_int_equal(plumb_loop_frame(loop, 0.032), 3);
    assert_near(plumb_loop_alpha(loop), 0.2, ROUNDED(1e-5));
    assert_int_equal(plumb_loop_frame(loop, 1e300),
                     3); // what a breakpoint took is not caught up with
    assert_true(plumb_loop_alpha(loop) == 0);
    plumb_loop_destroy(loop);
}

// A quarter of a step into the next one, a body is shown three quarters of a step back.
static void bodies_are_shown_on_their_way(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_loop *loop = make_loop(w, (plumb_loop_desc){ .dt = 0.125 });
    plumb_world_set_gravity(w, plumb_v2(0, 0));
    // It spins about a centre that is not its origin.
    plumb_shape_destroy(w, f->box);
    plumb_shape_create(
        w, f->dynamic,
        &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1, .center = { 2, 0 } });
    plumb_body_set_velocity(w, f->dynamic, plumb_v2(8, 0));
    plumb_body_set_angular_velocity(w, f->dynamic, R(TAU));
    for (int i = 0; i < 7; ++i) {
        assert_int_equal(plumb_loop_frame(loop, 0.125), 1);
        assert_int_equal(plumb_loop_step(loop), PLUMB_OK);
    }
    assert_int_equal(plumb_loop_frame(loop, 0.03125), 0);
    assert_near(plumb_loop_alpha(loop), 0.25, ROUNDED(1e-6));
    const double then = 6.25 * 0.125;
    const plumb_transform seen = plumb_loop_transform(loop, f->dynamic);
    assert_vec_near(plumb_transform_apply(seen, plumb_v2(2, 0)), 2 + 8 * then, 5, ROUNDED(1e-4));
    assert_near(cos(then * TAU), seen.q.c, ROUNDED(1e-4));
    assert_near(sin(then * TAU), seen.q.s, ROUNDED(1e-4));
    const plumb_transform still = plumb_loop_transform(loop, f->fixed);
    assert_vec_near(still.p, 0, 0, 0);
    plumb_loop_destroy(loop);
}

static plumb_vec2 shown(const plumb_loop *loop, plumb_body body)
{
    return plumb_loop_transform(loop, body).p;
}

static void nothing_smears(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_loop *loop = make_loop(w, (plumb_loop_desc){ .dt = 0.0625 });
    plumb_world_set_gravity(w, plumb_v2(0, 0));
    plumb_body_set_velocity(w, f->dynamic, plumb_v2(4, 0));
    for (int i = 0; i < 4; ++i) {
        plumb_loop_step(loop);
    }
    plumb_loop_frame(loop, 0.03125); // half a step
    assert_vec_near(shown(loop, f->dynamic), 1 - 0.125, 5, ROUNDED(1e-5));
    // Behind the step, before it, and by a command that the step carries out.
    plumb_body_teleport(w, f->dynamic, plumb_v2(-50, 5), 0);
    assert_vec_near(shown(loop, f->dynamic), -50, 5, 0);
    plumb_loop_step(loop);
    assert_vec_near(shown(loop, f->dynamic), -50 + 0.125, 5, ROUNDED(1e-4));
    plumb_command_teleport(w, f->dynamic, plumb_v2(70, 5), 0);
    plumb_loop_step(loop);
    assert_vec_near(shown(loop, f->dynamic), 70 + 0.125, 5, ROUNDED(1e-4));
    // Just made, and made in the slot of another.
    plumb_body fresh = plumb_body_create(w, &(plumb_body_desc){ .position = { 9, 9 } });
    assert_vec_near(shown(loop, fresh), 9, 9, 0);
    plumb_body_destroy(w, fresh);
    assert_true(plumb_loop_transform(loop, fresh).q.c == 0);
    plumb_loop_step(loop);
    for (int i = 0; i < 3000; ++i) { // until the slot comes round
        const plumb_body next = plumb_body_create(w, &(plumb_body_desc){ .position = { -9, 9 } });
        assert_vec_near(shown(loop, next), -9, 9, 0);
        plumb_body_destroy(w, next);
    }
    plumb_loop_destroy(loop);
}

static void sleepers_wake_smoothly(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_loop *loop = make_loop(w, (plumb_loop_desc){ .dt = 0.0625 });
    plumb_world_set_gravity(w, plumb_v2(0, 0));
    for (int i = 0; i < 20; ++i) {
        plumb_loop_step(loop);
    }
    assert_false(plumb_body_is_awake(w, f->dynamic));
    plumb_body_set_velocity(w, f->dynamic, plumb_v2(16, 0));
    plumb_loop_step(loop);
    plumb_loop_frame(loop, 0.03125);
    assert_vec_near(shown(loop, f->dynamic), 0.5, 5, ROUNDED(1e-5));
    plumb_loop_destroy(loop);
}

static void over_the_edge_it_is_the_shorter_way(void **state)
{
    (void)state;
    plumb_world *w;
    const plumb_world_desc desc = { .zero_gravity = true, .wrap_x = 20 };
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    const plumb_body body = plumb_body_create(
        w, &(plumb_body_desc){ .position = { R(9.5), 0 }, .velocity = { 16, 0 } });
    plumb_loop *loop = make_loop(w, (plumb_loop_desc){ .dt = 0.0625 });
    plumb_loop_step(loop);
    plumb_loop_frame(loop, 0.03125 / 2); // a quarter
    assert_vec_near(plumb_body_position(w, body), -9.5, 0, ROUNDED(1e-5));
    assert_vec_near(shown(loop, body), -9.5 - 0.75, 0, ROUNDED(1e-5));
    plumb_loop_destroy(loop);
    plumb_world_destroy(w);
}

// The loop keeps no state of the world's: it gives the same bits as plain steps.
static void a_loop_changes_nothing(void **state)
{
    fixture *f = *state;
    static char image[200000];
    const size_t size = plumb_world_snapshot_size(f->world);
    assert_in_range(size, 1, sizeof image);
    plumb_world_save(f->world, image, sizeof image);
    plumb_loop *loop = make_loop(f->world, (plumb_loop_desc){ 0 });
    for (int i = 0; i < 30; ++i) {
        plumb_loop_step(loop);
    }
    const uint64_t hash = plumb_world_hash(f->world);
    assert_int_equal(plumb_world_restore(f->world, image, sizeof image), PLUMB_OK);
    for (int i = 0; i < 30; ++i) {
        plumb_world_step(f->world, R(1.0 / 60));
    }
    assert_true(plumb_world_hash(f->world) == hash);
    plumb_loop_destroy(loop);
}

static void step_in_a_system(const plumb_system_call *call)
{
    assert_int_equal(plumb_loop_step(call->context), PLUMB_E_LOCKED);
}

static void loops_refuse(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_loop *loop = NULL;
    assert_int_equal(plumb_loop_create(NULL, NULL, &loop), PLUMB_E_NULL);
    REFUSED(E_NULL, "plumb_loop_create: loop is null; it must be given",
            plumb_loop_create(w, NULL, NULL));
    REFUSED(E_RANGE, "plumb_loop_create: dt is 1.5; it must be 0 to 1",
            plumb_loop_create(w, &(plumb_loop_desc){ .dt = 1.5 }, &loop));
    REFUSED(E_NOT_FINITE, "plumb_loop_create: dt is nan; it must be finite",
            plumb_loop_create(w, &(plumb_loop_desc){ .dt = (double)NAN }, &loop));
    REFUSED(E_RANGE, "plumb_loop_create: steps_max is 1001; it must be 0 to 1000",
            plumb_loop_create(w, &(plumb_loop_desc){ .steps_max = 1001 }, &loop));
    REFUSED(E_RANGE, "plumb_loop_create: steps_max is -1; it must be 0 to 1000",
            plumb_loop_create(w, &(plumb_loop_desc){ .steps_max = -1 }, &loop));
    assert_null(loop);
    assert_int_equal(plumb_loop_create(w, NULL, &loop), PLUMB_OK);
    REFUSED(E_RANGE, "plumb_loop_frame: seconds is -0.5; it must be 0 or more",
            plumb_loop_frame(loop, -0.5) == -1 ? PLUMB_E_RANGE : PLUMB_OK);
    REFUSED(E_NOT_FINITE, "plumb_loop_frame: seconds is inf; it must be finite",
            plumb_loop_frame(loop, (double)INFINITY) == -1 ? PLUMB_E_NOT_FINITE : PLUMB_OK);
    assert_int_equal(plumb_loop_frame(NULL, 1), -1);
    assert_int_equal(plumb_loop_step(NULL), PLUMB_E_NULL);
    assert_true(plumb_loop_alpha(NULL) == 0);
    assert_true(plumb_loop_transform(NULL, f->dynamic).q.c == 0);
    assert_true(plumb_loop_transform(loop, f->stale).q.c == 0);
    plumb_loop_destroy(NULL);
    const plumb_system_desc system = {
        .name = "nested", .phase = PLUMB_PHASE_END, .run = step_in_a_system, .context = loop
    };
    assert_int_equal(plumb_system_create(w, &system), PLUMB_OK);
    assert_int_equal(plumb_loop_step(loop), PLUMB_OK);
    plumb_loop_destroy(loop);
}

static void a_loop_without_memory_moves_nothing(void **state)
{
    (void)state;
    heap h = HEAP_INIT;
    plumb_world *w;
    const plumb_world_desc desc = { .allocator = heap_allocator(&h) };
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    const plumb_body body = plumb_body_create(w, &(plumb_body_desc){ 0 });
    plumb_loop *loop;
    heap_fail(&h, 0);
    assert_int_equal(plumb_loop_create(w, NULL, &loop), PLUMB_E_MEMORY);
    assert_null(loop);
    heap_fail(&h, -1);
    assert_int_equal(plumb_loop_create(w, NULL, &loop), PLUMB_OK);
    heap_fail(&h, 0);
    assert_int_equal(plumb_loop_step(loop), PLUMB_E_MEMORY);
    heap_fail(&h, -1);
    assert_true(plumb_world_stats(w).step_count == 0);
    assert_int_equal(plumb_loop_step(loop), PLUMB_OK);
    assert_true(plumb_body_position(w, body).y < 0);
    plumb_loop_destroy(loop);
    plumb_world_destroy(w);
    assert_int_equal(h.blocks, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blends_go_the_shorter_way),
        API_TEST(frames_make_steps),
        API_TEST(bodies_are_shown_on_their_way),
        API_TEST(nothing_smears),
        API_TEST(sleepers_wake_smoothly),
        cmocka_unit_test(over_the_edge_it_is_the_shorter_way),
        API_TEST(a_loop_changes_nothing),
        API_TEST(loops_refuse),
        cmocka_unit_test(a_loop_without_memory_moves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
