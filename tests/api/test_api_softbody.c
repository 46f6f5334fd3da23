// test_api_softbody.c - soft bodies as a user has them: refused calls, pins, destruction, sleep, images while cloth tears,
// threads and widths, recordings, out of memory, what did not settle.
#include "harness/heap.h"
#include "harness/recording.h"
#include "world_fixture.h"

#include <math.h>
#include <stdlib.h>

#define DT R(1.0 / 60)

static plumb_softbody cloth(plumb_world *w)
{
    return plumb_cloth_create(w, &(plumb_cloth_desc){ .low = { -2, 0 },
                                                      .high = { 2, 3 },
                                                      .columns = 12,
                                                      .rows = 9,
                                                      .mass = 3,
                                                      .stiffness = 20000,
                                                      .break_strain = R(0.1),
                                                      .hold_top = true });
}

static plumb_body ball(plumb_world *w)
{
    const plumb_body b =
        plumb_body_create(w, &(plumb_body_desc){ .position = { -4, 2 }, .velocity = { 12, 2 } });
    plumb_shape_create(
        w, b, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.3), .density = 200 });
    return b;
}

static void run(plumb_world *w, int steps)
{
    for (int i = 0; i < steps; ++i) {
        assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
    }
}

static void refused(fixture *f, plumb_softbody_desc d, plumb_result code, const char *text)
{
    assert_true(plumb_is_null(plumb_softbody_create(f->world, &d)));
    assert_int_equal(plumb_world_error(f->world).code, code);
    assert_non_null(strstr(f->logged, text));
    assert_int_equal(plumb_world_softbodies(f->world, NULL, 0), 0);
}

static void bad_ones_are_refused(void **state)
{
    fixture *f = *state;
    plumb_softbody_node n[3] = { { .mass = 1 },
                                 { .position = { 1, 0 }, .mass = 1 },
                                 { .position = { 0, 1 }, .mass = 1 } };
    plumb_softbody_edge e = { .b = 1, .stiffness = 1 };
    plumb_softbody_desc d = { .nodes = n, .edges = &e, .node_count = 3, .edge_count = 1 };
    assert_true(plumb_is_null(plumb_softbody_create(NULL, &d)));
    assert_true(plumb_is_null(plumb_softbody_create(f->world, NULL)));
    refused(f, (plumb_softbody_desc){ 0 }, PLUMB_E_RANGE, "nodes are 0");
    refused(f, (plumb_softbody_desc){ .node_count = 1 }, PLUMB_E_NULL, "nodes");
    e.b = 0;
    refused(f, d, PLUMB_E_RANGE, "edge 0 names nodes");
    e.b = 1, e.stiffness = -1;
    refused(f, d, PLUMB_E_RANGE, "edge stiffness");
    e.stiffness = R(NAN);
    refused(f, d, PLUMB_E_NOT_FINITE, "edge stiffness");
    e.stiffness = 1, n[0].mass = 0;
    refused(f, d, PLUMB_E_RANGE, "node mass");
    n[0].mass = 1;
    plumb_softbody_triangle t = { .a = 0, .b = 2, .c = 1, .young = 100 };
    d.triangles = &t, d.triangle_count = 1;
    refused(f, d, PLUMB_E_RANGE, "area of a triangle"); // it turns the wrong way
    d.triangle_count = 0;
    plumb_softbody_pin pins[2] = { { .node = 1 }, { .node = 1 } };
    d.pins = pins, d.pin_count = 2;
    refused(f, d, PLUMB_E_RANGE, "pin 1 names nodes");
    pins[1] = (plumb_softbody_pin){ .node = 2, .body = { { 77, 3 } } };
    refused(f, d, PLUMB_E_HANDLE, "body");
}

static void calls_are_checked(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_softbody s = cloth(w), stale = { { 99, 9 } };
    const plumb_body nobody = PLUMB_NULL_INIT;
    plumb_softbody_desc d;
    plumb_softbody_state m;
    assert_int_equal(plumb_softbody_settings(w, stale, &d), PLUMB_E_HANDLE);
    assert_int_equal(plumb_softbody_settings(w, s, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_softbody_settings(w, s, &d), PLUMB_OK);
    assert_int_equal(d.node_count, 130);
    assert_int_equal(d.pin_count, 13);
    assert_int_equal(plumb_softbody_measure(w, s, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_softbody_measure(w, s, &m), PLUMB_OK);
    plumb_softbody_node n = d.nodes[0];
    assert_int_equal(plumb_softbody_set_node(w, s, 130, &n), PLUMB_E_RANGE);
    n.mass = 0;
    assert_int_equal(plumb_softbody_set_node(w, s, 0, &n), PLUMB_E_RANGE);
    plumb_softbody_edge e = d.edges[0];
    assert_int_equal(plumb_softbody_set_edge(w, s, -1, &e), PLUMB_E_RANGE);
    e.length = 0;
    assert_int_equal(plumb_softbody_set_edge(w, s, 0, &e), PLUMB_E_RANGE);
    assert_int_equal(plumb_softbody_set_gas(w, s, 1, 0), PLUMB_E_STATE);
    assert_int_equal(plumb_softbody_hold(w, s, 0, nobody, (plumb_vec2){ R(2e9), 0 }),
                     PLUMB_E_RANGE);
    assert_int_equal(plumb_softbody_hold(w, s, 0, nobody, (plumb_vec2){ -2, 0 }), PLUMB_OK);
    assert_int_equal(plumb_softbody_hold(w, s, 0, nobody, (plumb_vec2){ -2, 1 }), PLUMB_OK);
    plumb_softbody_settings(w, s, &d);
    assert_int_equal(d.pin_count, 14);
    assert_int_equal(plumb_softbody_release(w, s, 0), PLUMB_OK);
    assert_int_equal(plumb_softbody_release(w, s, 0), PLUMB_E_STATE);
    assert_int_equal(plumb_softbody_destroy(w, s), PLUMB_OK);
    assert_int_equal(plumb_softbody_destroy(w, s), PLUMB_E_HANDLE);
    assert_true(plumb_is_null(plumb_rope_create(w, &(plumb_rope_desc){ 0 })));
    assert_true(plumb_is_null(plumb_cloth_create(w, &(plumb_cloth_desc){ 0 })));
    assert_true(plumb_is_null(plumb_jelly_create(w, &(plumb_jelly_desc){ 0 })));
    assert_true(plumb_is_null(plumb_skin_create(w, &(plumb_skin_desc){ .nodes = 5 })));
}

// Pins go with their bodies, soft bodies keep their order.
static void what_goes_takes_its_pins_along(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_body b = ball(w);
    const plumb_softbody rope = plumb_rope_create(
        w,
        &(plumb_rope_desc){ .from = { -4, 2 }, .to = { 0, 2 }, .from_body = b, .hold_to = true });
    const plumb_softbody other = cloth(w);
    plumb_softbody_desc d;
    run(w, 10);
    assert_int_equal(plumb_body_destroy(w, b), PLUMB_OK);
    plumb_softbody_settings(w, rope, &d);
    assert_int_equal(d.pin_count, 1);
    run(w, 10);
    assert_int_equal(plumb_entity_get_kind(w, rope.entity), PLUMB_KIND_SOFTBODY);
    assert_int_equal(plumb_softbody_destroy(w, rope), PLUMB_OK);
    plumb_softbody_settings(w, other, &d);
    assert_int_equal(d.pin_count, 13);
    run(w, 10);
    assert_int_equal(plumb_world_softbodies(w, NULL, 0), 1);
}

// A skin of twelve nodes with gas, and a thread across: edge 12.
static plumb_softbody skin_with_thread(plumb_world *w)
{
    plumb_softbody_node n[12] = { 0 };
    plumb_softbody_edge e[13] = { 0 };
    plumb_softbody_bend b[12] = { 0 };
    uint32_t ring[12];
    for (uint32_t i = 0; i < 12; ++i) {
        const double at = 0.523598775598 * i;
        n[i] = (plumb_softbody_node){ .position = { R(cos(at)), R(sin(at)) }, .mass = R(0.1) };
        e[i] = (plumb_softbody_edge){ .a = i, .b = (i + 1) % 12, .stiffness = 5000 };
        b[i] = (plumb_softbody_bend){
            .a = i, .b = (i + 1) % 12, .c = (i + 2) % 12, .stiffness = 1, .angle = R(0.52)
        };
        ring[i] = i;
    }
    e[12] = (plumb_softbody_edge){ .a = 2, .b = 8, .stiffness = 100 };
    const plumb_softbody_desc desc = { .nodes = n,
                                       .edges = e,
                                       .bends = b,
                                       .ring = ring,
                                       .node_count = 12,
                                       .edge_count = 13,
                                       .bend_count = 12,
                                       .ring_count = 12,
                                       .pressure = 500,
                                       .damping = 5 };
    return plumb_softbody_create(w, &desc);
}

// What is cut does as what tears: the gas is out where the ring is open, so that nothing flies apart, and nothing bends there.
static void what_is_cut_is_open(void **state)
{
    (void)state;
    for (int cut = 0; cut < 13; ++cut) {
        plumb_world *w;
        assert_int_equal(plumb_world_create(&(plumb_world_desc){ .zero_gravity = true }, &w),
                         PLUMB_OK);
        const plumb_softbody s = skin_with_thread(w);
        run(w, 120);
        plumb_softbody_desc d;
        assert_int_equal(plumb_softbody_settings(w, s, &d), PLUMB_OK);
        plumb_softbody_edge torn = d.edges[cut];
        torn.flags |= PLUMB_EDGE_TORN;
        assert_int_equal(plumb_softbody_set_edge(w, s, cut, &torn), PLUMB_OK);
        assert_int_equal(plumb_softbody_settings(w, s, &d), PLUMB_OK);
        assert_true((d.pressure == 0) == (cut < 12) && d.ambient == 0);
        for (int i = 0; i < 12; ++i) {
            const bool over = cut < 12 && (i == cut || (i + 1) % 12 == cut);
            assert_true((d.bends[i].stiffness == 0) == over);
        }
        run(w, 60);
        plumb_softbody_state m;
        assert_int_equal(plumb_softbody_measure(w, s, &m), PLUMB_OK);
        assert_true((double)m.kinetic < 20);
        if (cut == 12) {
            assert_true((double)m.pressure > 100);
        }
        plumb_world_destroy(w);
    }
}

static void an_image_is_taken_while_it_tears(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_softbody_state before, after;
    const plumb_softbody s = cloth(w);
    ball(w);
    run(w, 20);
    plumb_softbody_measure(w, s, &before);
    const size_t size = plumb_world_snapshot_size(w);
    void *image = malloc(size);
    assert_int_equal(plumb_world_save(w, image, size), PLUMB_OK);
    run(w, 40);
    plumb_softbody_measure(w, s, &after);
    const uint64_t hash = plumb_world_hash(w);
    assert_true(after.torn > before.torn);
    assert_int_equal(plumb_world_restore(w, image, size), PLUMB_OK);
    run(w, 40);
    assert_true(plumb_world_hash(w) == hash);
    free(image);
}

//---- the same bits -------------------------------------------------------------------------------

// One of each, with bodies that fall onto them, are held by them, or lie apart.
static plumb_world *make_yard(plumb_world_desc desc)
{
    plumb_world *w;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    const plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(
        w, ground,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 20, R(0.5) }, .center = { 0, R(-0.5) } });
    plumb_body boxes[6];
    for (int i = 0; i < 6; ++i) {
        boxes[i] = plumb_body_create(
            w, &(plumb_body_desc){ .position = { R(i * 1.1 - 4), R(3.2) }, .angle = R(0.1 * i) });
        plumb_shape_create(w, boxes[i],
                           &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.2), R(0.2) } });
    }
    return w;
}

static plumb_result furnish(plumb_world *w)
{
    const plumb_vec2 outline[] = { { 4, 1 }, { 5, 1 }, { 5, 2 }, { 4, 2 } };
    const plumb_body held = plumb_world_bodies(w).body[0];
    const plumb_softbody made[] = {
        plumb_rope_create(w, &(plumb_rope_desc){ .from = { -6, 2 },
                                                 .to = { R(-2.5), 2 },
                                                 .nodes = 16,
                                                 .bending = R(0.1),
                                                 .hold_from = true,
                                                 .hold_to = true }),
        plumb_rope_create(w, &(plumb_rope_desc){ .from = { -4, 5 },
                                                 .to = { R(-4), R(3.2) },
                                                 .nodes = 8,
                                                 .hold_from = true,
                                                 .to_body = held }),
        plumb_cloth_create(w, &(plumb_cloth_desc){ .low = { R(-1.5), R(1.5) },
                                                   .high = { 1, R(2.5) },
                                                   .columns = 8,
                                                   .break_strain = R(0.08),
                                                   .hold_corners = true }),
        plumb_jelly_create(
            w, &(plumb_jelly_desc){ .points = outline, .count = 4, .spacing = R(0.25) }),
        plumb_skin_create(w, &(plumb_skin_desc){ .center = { 2, R(0.8) }, .nodes = 16 })
    };
    for (int i = 0; i < 5; ++i) {
        if (plumb_is_null(made[i])) {
            const plumb_result code = plumb_world_error(w).code;
            for (int k = 0; k < 5; ++k) {
                plumb_softbody_destroy(w, made[k]);
            }
            return code;
        }
    }
    return PLUMB_OK;
}

static plumb_world *make_full_yard(plumb_world_desc desc)
{
    plumb_world *w = make_yard(desc);
    assert_int_equal(furnish(w), PLUMB_OK);
    return w;
}

static void threads_and_widths_change_no_bit(void **state)
{
    (void)state;
    const int widths[] = { 4, 8, 16, 8 }, workers[] = { 1, 1, 1, 3 };
    uint64_t hashes[4];
    for (int i = 0; i < 4; ++i) {
        plumb_world *w =
            make_full_yard((plumb_world_desc){ .simd_width = widths[i], .workers = workers[i] });
        run(w, 120);
        hashes[i] = plumb_world_hash(w);
        assert_true(hashes[i] == hashes[0]);
        plumb_world_destroy(w);
    }
}

static void recordings_have_it(void **state)
{
    (void)state;
    recording tape = { 0 };
    uint64_t hashes[61];
    plumb_world *w = make_yard((plumb_world_desc){ 0 });
    assert_int_equal(plumb_recorder_start(w, &(plumb_recorder_desc){ .write = to_recording,
                                                                     .context = &tape,
                                                                     .keyframe_every = 16 }),
                     PLUMB_OK);
    for (int i = 1; i <= 60; ++i) {
        plumb_softbody all[5];
        if (i == 5) {
            assert_int_equal(furnish(w), PLUMB_OK);
        }
        if (i == 30) { // cut, freed, gone
            plumb_softbody_desc d;
            assert_int_equal(plumb_world_softbodies(w, all, 5), 5);
            assert_int_equal(plumb_softbody_settings(w, all[0], &d), PLUMB_OK);
            plumb_softbody_edge e = d.edges[7];
            e.flags |= PLUMB_EDGE_TORN;
            assert_int_equal(plumb_softbody_set_edge(w, all[0], 7, &e), PLUMB_OK);
            assert_int_equal(plumb_softbody_release(w, all[1], 0), PLUMB_OK);
            assert_int_equal(plumb_softbody_destroy(w, all[3]), PLUMB_OK);
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

// All that a user can see; times of rest go on in a step that is refused (plumb_world_step).
static uint64_t digest_all(plumb_world *w)
{
    uint64_t digest = digest_world(w);
    plumb_softbody all[5];
    const int count = plumb_world_softbodies(w, all, 5);
    for (int i = 0; i < count; ++i) {
        plumb_softbody_desc d;
        assert_int_equal(plumb_softbody_settings(w, all[i], &d), PLUMB_OK);
        digest_bytes(&digest, d.nodes, (size_t)d.node_count * sizeof *d.nodes);
        digest_bytes(&digest, d.edges, (size_t)d.edge_count * sizeof *d.edges);
    }
    return digest;
}

// Every allocation of making and stepping fails once: the call is refused, changes nothing, and succeeds when it is tried
// again.
static uint64_t play(heap *h, long fail_at, long *calls, int *refusals)
{
    *h = (heap){ .fail_at = -1 };
    plumb_world *w = // a refused step may count as rest for bodies that could sleep
        make_yard((plumb_world_desc){ .allocator = heap_allocator(h), .no_sleep = true });
    run(w, 1);
    const long before = h->calls;
    h->fail_at = fail_at < 0 ? -1 : before + fail_at;
    plumb_result r;
    while ((r = furnish(w)) == PLUMB_E_MEMORY) {
        ++*refusals;
        assert_int_equal(plumb_world_softbodies(w, NULL, 0), 0);
    }
    assert_int_equal(r, PLUMB_OK);
    for (int i = 0; i < 12; ++i) {
        const uint64_t digest = digest_all(w);
        while ((r = plumb_world_step(w, DT)) == PLUMB_E_MEMORY) {
            ++*refusals;
            assert_true(digest_all(w) == digest);
        }
        assert_int_equal(r, PLUMB_OK);
    }
    plumb_softbody all[5];
    plumb_world_softbodies(w, all, 5);
    while ((r = plumb_softbody_hold(w, all[4], 0, (plumb_body)PLUMB_NULL_INIT,
                                    (plumb_vec2){ 2, 1 })) == PLUMB_E_MEMORY) {
        ++*refusals;
    }
    assert_int_equal(r, PLUMB_OK);
    run(w, 1);
    *calls = h->calls - before;
    plumb_softbody_state sum;
    plumb_softbody_measure(w, all[0], &sum);
    plumb_softbody_desc d;
    plumb_softbody_settings(w, all[4], &d);
    assert_int_equal(d.pin_count, 1);
    const double end = (double)sum.center.y;
    plumb_world_destroy(w);
    assert_int_equal(h->bytes, 0);
    uint64_t bits;
    memcpy(&bits, &end,
           sizeof bits); // handles differ, for those that were taken back: what moved does not
    return bits;
}

static void any_allocation_may_fail(void **state)
{
    (void)state;
    heap_fail_each(play, 20, 400);
}

static void a_steady_step_allocates_nothing(void **state)
{
    (void)state;
    static heap h;
    h = (heap){ .fail_at = -1 };
    plumb_world *w = make_full_yard((plumb_world_desc){ .allocator = heap_allocator(&h) });
    run(w, 240);
    const long calls = h.calls;
    run(w, 60);
    assert_int_equal(h.calls, calls);
    plumb_world_destroy(w);
}

//---- sleep, what did not settle ------------------------------------------------------------------

// What lies on a rope sleeps with it, and so does what lies on that; gone is the rope, and both fall.
static void nothing_sleeps_in_thin_air(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body_destroy(w, f->dynamic);
    plumb_body_destroy(w, f->fixed);
    const plumb_softbody rope = plumb_rope_create(w, &(plumb_rope_desc){ .from = { -2, 4 },
                                                                         .to = { 2, 4 },
                                                                         .length = R(4.5),
                                                                         .damping = 50,
                                                                         .drag = 1,
                                                                         .hold_from = true,
                                                                         .hold_to = true });
    plumb_body boxes[2];
    for (int i = 0; i < 2; ++i) {
        boxes[i] = plumb_body_create(w, &(plumb_body_desc){ .position = { 0, R(4 + i * 0.5) } });
        plumb_shape_create(
            w, boxes[i],
            &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.4 - 0.1 * i), R(0.2) } });
    }
    for (int i = 0; i < 3000 && plumb_softbody_is_awake(w, rope); ++i) {
        run(w, 1);
    }
    const double low = (double)plumb_body_position(w, boxes[0]).y;
    assert_true(low > 2 && (double)plumb_body_position(w, boxes[1]).y > low + 0.3);
    assert_true((double)plumb_body_velocity(w, boxes[0]).y == 0);
    assert_false(plumb_softbody_is_awake(w, rope));
    assert_false(plumb_body_is_awake(w, boxes[0]) || plumb_body_is_awake(w, boxes[1]));
    assert_int_equal(plumb_softbody_destroy(w, rope), PLUMB_OK);
    run(w, 30);
    assert_true((double)plumb_body_position(w, boxes[0]).y < low - 1);
    assert_true((double)plumb_body_position(w, boxes[1]).y < low - 0.5);
}

static void call_sleep(const plumb_system_call *call)
{
    const plumb_softbody *s = call->context;
    assert_int_equal(plumb_softbody_sleep(call->world, *s), PLUMB_E_LOCKED);
    assert_int_equal(plumb_softbody_wake(call->world, *s), PLUMB_OK);
}

// At once and whatever its speed, with what it holds; who may not sleep is told.
static void sleep_by_a_call(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_softbody stale = { { 99, 9 } };
    const plumb_softbody rope = plumb_rope_create(
        w, &(plumb_rope_desc){
               .from = { 0, 8 }, .to = { 0, 6 }, .hold_from = true, .to_body = f->dynamic });
    plumb_softbody_desc d;
    run(w, 20);
    assert_false(plumb_softbody_is_awake(w, stale) || plumb_softbody_is_awake(NULL, rope));
    assert_false(plumb_softbody_no_sleep(w, stale) || plumb_softbody_no_sleep(NULL, rope));
    assert_int_equal(plumb_softbody_wake(w, stale), PLUMB_E_HANDLE);
    assert_int_equal(plumb_softbody_sleep(w, stale), PLUMB_E_HANDLE);
    assert_int_equal(plumb_softbody_set_no_sleep(w, stale, true), PLUMB_E_HANDLE);
    assert_int_equal(plumb_softbody_wake(NULL, rope), PLUMB_E_NULL);
    assert_int_equal(plumb_softbody_sleep(NULL, rope), PLUMB_E_NULL);
    assert_int_equal(plumb_softbody_set_no_sleep(NULL, rope, true), PLUMB_E_NULL);

    assert_int_equal(plumb_softbody_set_no_sleep(w, rope, true), PLUMB_OK);
    assert_true(plumb_softbody_no_sleep(w, rope));
    assert_int_equal(plumb_softbody_sleep(w, rope), PLUMB_E_STATE);
    assert_non_null(strstr(f->logged, "soft body that may not sleep"));
    assert_int_equal(plumb_body_sleep(w, f->dynamic), PLUMB_E_STATE);
    plumb_softbody_set_no_sleep(w, rope, false);
    plumb_body_set_no_sleep(w, f->dynamic, true);
    assert_int_equal(plumb_softbody_sleep(w, rope), PLUMB_E_STATE);
    assert_non_null(strstr(f->logged, "one that may not sleep"));
    plumb_body_set_no_sleep(w, f->dynamic, false);
    plumb_world_set_sleep(w, false, 0, 0);
    assert_int_equal(plumb_softbody_sleep(w, rope), PLUMB_E_STATE);
    assert_non_null(strstr(f->logged, "no_sleep"));
    plumb_world_set_sleep(w, true, 0, 0);

    assert_int_equal(plumb_softbody_sleep(w, rope), PLUMB_OK);
    assert_int_equal(plumb_softbody_sleep(w, rope), PLUMB_OK);
    assert_false(plumb_softbody_is_awake(w, rope) || plumb_body_is_awake(w, f->dynamic));
    assert_int_equal(plumb_world_stats(w).soft_asleep, 1);
    run(w, 10);
    assert_false(plumb_softbody_is_awake(w, rope) || plumb_body_is_awake(w, f->dynamic));
    plumb_softbody_settings(w, rope, &d);
    assert_true(d.asleep && d.nodes[12].velocity.y == 0);
    assert_int_equal(plumb_body_wake(w, f->dynamic),
                     PLUMB_OK); // and to sleep again before a step has seen it
    assert_int_equal(plumb_body_sleep(w, f->dynamic), PLUMB_OK);
    assert_int_equal(plumb_softbody_sleep(w, rope), PLUMB_OK);
    run(w, 1);
    assert_false(plumb_softbody_is_awake(w, rope) || plumb_body_is_awake(w, f->dynamic));
    plumb_softbody its = rope;
    assert_int_equal(plumb_system_create(w, &(plumb_system_desc){ .name = "rouse",
                                                                  .phase = PLUMB_PHASE_BEGIN,
                                                                  .run = call_sleep,
                                                                  .context = &its }),
                     PLUMB_OK);
    run(w, 1); // it wakes for this step
    assert_true(plumb_softbody_is_awake(w, rope) && plumb_body_is_awake(w, f->dynamic));
    plumb_system_enable(w, "rouse", false);
    assert_int_equal(plumb_body_sleep(w, f->dynamic), PLUMB_OK); // from its other end
    assert_false(plumb_softbody_is_awake(w, rope));
    assert_int_equal(plumb_softbody_destroy(w, rope), PLUMB_OK);
    assert_true(plumb_body_is_awake(w, f->dynamic));
    assert_int_equal(plumb_world_stats(w).soft_asleep, 0);
    run(w, 1);
}

// As a descriptor may have it: it sleeps until something comes near.
static void made_asleep(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_softbody_node n[2] = {
        { .position = { 0, 20 }, .velocity = { 3, 0 }, .mass = 1, .radius = 1 },
        { .position = { 1, 20 }, .mass = 1 }
    };
    plumb_softbody_desc d = { .nodes = n, .node_count = 2, .asleep = true };
    const plumb_softbody s = plumb_softbody_create(w, &d);
    run(w, 30);
    assert_false(plumb_softbody_is_awake(w, s));
    plumb_softbody_settings(w, s, &d);
    assert_true(d.asleep && d.nodes[0].velocity.x == 0 && d.nodes[0].position.x == 0);
    plumb_body_set_position(w, f->dynamic, plumb_v2(0, R(21.9)));
    run(w, 1);
    assert_true(plumb_softbody_is_awake(w, s));
    d = (plumb_softbody_desc){ .nodes = n, .node_count = 2, .asleep = true, .no_sleep = true };
    assert_true(plumb_softbody_is_awake(w, plumb_softbody_create(w, &d)));
    plumb_world_set_sleep(w, false, 0, 0);
    d.no_sleep = false;
    assert_true(plumb_softbody_is_awake(w, plumb_softbody_create(w, &d)));
}

// A rope as stiff as a rod of steel, under boxes of 22 tons with a single substep at 10 Hz: the iteration ends before it has settled.
static void what_did_not_settle_is_told(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_body_destroy(w, f->dynamic);
    plumb_world_set_substeps(w, 1, 1);
    plumb_rope_create(w, &(plumb_rope_desc){ .from = { -2, 4 },
                                             .to = { 2, 4 },
                                             .length = R(4.4),
                                             .nodes = 80,
                                             .mass = R(0.5),
                                             .stiffness = R(1e9),
                                             .friction = 2,
                                             .hold_from = true,
                                             .hold_to = true });
    const plumb_material heavy =
        plumb_material_create(w, &(plumb_material_desc){ .density = 20000 });
    for (int i = 0; i < 9; ++i) {
        const plumb_body b =
            plumb_body_create(w, &(plumb_body_desc){ .position = { R(0.4 * i - 1.6), R(6 + i % 3) },
                                                     .angular_velocity = 20 });
        plumb_shape_create(w, b,
                           &(plumb_shape_desc){
                               .kind = PLUMB_BOX, .half = { R(0.2), R(0.15) }, .material = heavy });
    }
    for (int i = 0; i < 60; ++i) {
        assert_int_equal(plumb_world_step(w, R(0.1)), PLUMB_OK);
    }
    print_message("%u substeps missed\n", plumb_world_stats(w).soft_missed);
    assert_true(plumb_world_stats(w).soft_missed > 0);
    assert_non_null(strstr(f->logged, "did not settle"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(bad_ones_are_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(calls_are_checked, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_goes_takes_its_pins_along, set_up, tear_down),
        cmocka_unit_test_setup_teardown(an_image_is_taken_while_it_tears, set_up, tear_down),
        cmocka_unit_test_setup_teardown(nothing_sleeps_in_thin_air, set_up, tear_down),
        cmocka_unit_test_setup_teardown(sleep_by_a_call, set_up, tear_down),
        cmocka_unit_test_setup_teardown(made_asleep, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_did_not_settle_is_told, set_up, tear_down),
        cmocka_unit_test(what_is_cut_is_open),
        cmocka_unit_test(threads_and_widths_change_no_bit),
        cmocka_unit_test(recordings_have_it),
        cmocka_unit_test(any_allocation_may_fail),
        cmocka_unit_test(a_steady_step_allocates_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
