// test_outlook.c - what the outlook kernel settles in lanes is what impact.c foresees in double: nothing
// falls due, and the contact kernel is told the same separations. Stirred heaps of every kind of contact,
// at every width, looked at again in the state in which a step has left them.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "solver/impact.c" // foresees one contact: static there

#include "plumb/plumb.h"

#define R(x) ((plumb_real)(x))

static plumb_world *make_heap(int width)
{
    plumb_world *w = NULL;
    const plumb_world_desc desc = { .simd_width = width, .no_sleep = true };
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    plumb_material dull = plumb_material_create(
        w, &(plumb_material_desc){ .friction = R(0.4), .restitution = R(0.1) });
    plumb_material dead = plumb_material_create(w, &(plumb_material_desc){ .friction = R(0.4) });
    const plumb_vec2 at[] = { { 0, -1 }, { -9, 6 }, { 9, 6 } };
    const plumb_vec2 half[] = { { 12, 1 }, { 1, 8 }, { 1, 8 } };
    for (int i = 0; i < 3; ++i) {
        plumb_body b =
            plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = at[i] });
        plumb_shape_create(
            w, b, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = half[i], .material = dead });
    }
    plumb_body arm = plumb_body_create(
        w,
        &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .position = { 0, 3 }, .angular_velocity = 3 });
    plumb_shape_create(w, arm, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 4, R(0.3) } });
    for (int i = 0; i < 240; ++i) {
        plumb_body b = plumb_body_create(
            w, &(plumb_body_desc){ .position = { R(i % 16) - R(7.5), R(0.6) + R(i / 16) },
                                   .angle = R(i) });
        plumb_shape_create(w, b,
                           &(plumb_shape_desc){ .kind = i % 3 == 0 ? PLUMB_CIRCLE : PLUMB_BOX,
                                                .radius = i % 3 == 0 ? R(0.4) : 0,
                                                .half = { R(0.4), R(0.3) },
                                                .material = i % 5 == 0 ? dead : dull });
    }
    return w;
}

// Looks at all lanes in the present state; returns how many were settled.
static uint32_t check_lanes(plumb_world *w, near_real h)
{
    pl_solver *s = &w->solver;
    const pl_outlook_ends *ends = s->outlook_ends.data;
    const uint8_t *open = s->outlook_open.data;
    for (uint32_t slot = 0; slot < s->slot_count; ++slot) {
        ((near_real *)s->struck.data)[slot] = -h;
    }
    look_ahead(w, h);
    uint32_t settled = 0;
    for (uint32_t lane = 0; lane < s->outlook_lanes; ++lane) {
        if (ends[lane].impact == PL_NONE || open[lane] != 0) {
            continue;
        }
        pl_impact *m = (pl_impact *)s->impacts.data + ends[lane].impact;
        approach unused[2];
        near_real told[2] = { 0, 0 };
        ++settled;
        m->left = 1;
        foresee_all(w, m, (double)h, unused);
        assert_false(m->due);
        for (uint32_t j = 0; j < m->count; ++j) {
            told[j] = *m->point[j].lane_separation;
        }
        tell_kernel(m);
        for (uint32_t j = 0; j < m->count; ++j) {
            assert_memory_equal(&told[j], m->point[j].lane_separation, sizeof told[j]);
        }
    }
    return settled;
}

static void what_is_settled_is_beyond_doubt(void **state)
{
    (void)state;
    for (int width = 4; width <= 16; width *= 2) {
        plumb_world *w = make_heap(width);
        uint32_t settled = 0, all = 0;
        for (int i = 0; i < 200; ++i) {
            assert_int_equal(plumb_world_step(w, R(1) / 60), PLUMB_OK);
            const pl_outlook_ends *ends = w->solver.outlook_ends.data;
            for (uint32_t lane = 0; lane < w->solver.outlook_lanes; ++lane) {
                all += ends[lane].impact != PL_NONE;
            }
            settled += check_lanes(w, (near_real)(R(1) / 240));
        }
        print_message("width %d: %u of %u settled in lanes\n", width, settled, all);
        assert_true(all > 10000 && settled > all / 2);
        plumb_world_destroy(w);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_settled_is_beyond_doubt),
    };
    return cmocka_run_group_tests_name("outlook", tests, NULL, NULL);
}
