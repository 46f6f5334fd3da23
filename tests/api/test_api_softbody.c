// test_api_softbody.c - soft bodies as a user has them: refused calls, pins, destruction, images while cloth tears.
#include "world_fixture.h"

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
    assert_int_equal(plumb_softbody_get(w, stale, &d), PLUMB_E_HANDLE);
    assert_int_equal(plumb_softbody_get(w, s, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_softbody_get(w, s, &d), PLUMB_OK);
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
    plumb_softbody_get(w, s, &d);
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
    plumb_softbody_get(w, rope, &d);
    assert_int_equal(d.pin_count, 1);
    run(w, 10);
    assert_int_equal(plumb_entity_get_kind(w, rope.entity), PLUMB_KIND_SOFTBODY);
    assert_int_equal(plumb_softbody_destroy(w, rope), PLUMB_OK);
    plumb_softbody_get(w, other, &d);
    assert_int_equal(d.pin_count, 13);
    run(w, 10);
    assert_int_equal(plumb_world_softbodies(w, NULL, 0), 1);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(bad_ones_are_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(calls_are_checked, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_goes_takes_its_pins_along, set_up, tear_down),
        cmocka_unit_test_setup_teardown(an_image_is_taken_while_it_tears, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
