// test_dull.c - impacts in lanes (dull.simd.c) are those of bounce.c, bit for bit: what the prediction settles,
// which contacts strike, how hard, and what the contact kernel is told. Stirred heaps of every kind of
// contact, at every width, looked at again in the state in which a step has left them.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "solver/impact.c" // record_impacts: static there

#include "plumb/plumb.h"

#include <string.h>

#define R(x) ((plumb_real)(x))

// A plank under more bodies than there are colours.
static void add_plank(plumb_world *w, plumb_material dull)
{
    const plumb_shape_desc box = { .kind = PLUMB_BOX, .half = { R(40), R(0.3) }, .material = dull };
    for (int i = 0; i < 2; ++i) {
        plumb_body b =
            plumb_body_create(w, &(plumb_body_desc){ .type = i == 0 ? PLUMB_STATIC : PLUMB_DYNAMIC,
                                                     .position = { R(100), R(0.7) * R(i) } });
        plumb_shape_create(w, b, &box);
    }
    for (int i = 0; i < 90; ++i) {
        plumb_body b = plumb_body_create(
            w, &(plumb_body_desc){ .position = { R(61) + R(0.85) * R(i), R(1.6) } });
        plumb_shape_create(
            w, b, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.4), .material = dull });
    }
}

// `belt` [m/s]: the floor runs.
static plumb_world *make_heap(int width, double belt)
{
    plumb_world *w = NULL;
    const plumb_world_desc desc = { .simd_width = width,
                                    .no_sleep = true,
                                    .contact_impulses = true };
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    plumb_material dull = plumb_material_create(
        w, &(plumb_material_desc){ .friction = R(0.4), .restitution = R(0.1) });
    plumb_material dead = plumb_material_create(w, &(plumb_material_desc){ .friction = R(0.4) });
    plumb_material floor = plumb_material_create(
        w, &(plumb_material_desc){ .friction = R(0.4), .surface_speed = R(belt) });
    const plumb_vec2 at[] = { { 0, -1 }, { -9, 6 }, { 9, 6 } };
    const plumb_vec2 half[] = { { 12, 1 }, { 1, 8 }, { 1, 8 } };
    for (int i = 0; i < 3; ++i) {
        plumb_body b =
            plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = at[i] });
        plumb_shape_create(w, b,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                .half = half[i],
                                                .material = i == 0 ? floor : dead });
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
    add_plank(w, dull);
    return w;
}

// All that impacts read of one another and write.
typedef struct moment {
    void *part[5];
    size_t size[5];
    pl_manifold *manifolds;
    pl_pair *pairs;
    uint32_t bounces;
} moment;

static void *copy_of(const void *data, size_t size)
{
    void *copy = test_malloc(size);
    memcpy(copy, data, size);
    return copy;
}

static void parts_of(const plumb_world *w, void *part[5], size_t size[5])
{
    const pl_solver *s = &w->solver;
    const pl_buffer *from[5] = { &s->bodies, &s->motions, &s->residuals, &s->struck, &s->bundles };
    const size_t sizes[5] = { s->dynamic_slots * sizeof(pl_solver_body),
                              s->dynamic_slots * sizeof(pl_solver_motion),
                              s->dynamic_slots * 4 * sizeof(near_real),
                              s->dynamic_slots * sizeof(near_real),
                              s->bundle_count * pl_solver_kernels(w)->bundle_size };
    for (int i = 0; i < 5; ++i) {
        part[i] = from[i]->data;
        size[i] = sizes[i];
    }
}

static moment save(const plumb_world *w)
{
    moment s;
    void *part[5];
    parts_of(w, part, s.size);
    for (int i = 0; i < 5; ++i) {
        s.part[i] = copy_of(part[i], s.size[i]);
    }
    s.manifolds = copy_of(pl_manifolds(&w->narrow), w->narrow.manifold_count * sizeof(pl_manifold));
    s.pairs = copy_of(pl_pairs(&w->broad.pairs), w->broad.pairs.count * sizeof(pl_pair));
    s.bounces = w->solver.bounce_count;
    return s;
}

static void bring_back(plumb_world *w, const moment *s)
{
    void *part[5];
    size_t size[5];
    parts_of(w, part, size);
    for (int i = 0; i < 5; ++i) {
        memcpy(part[i], s->part[i], size[i]);
    }
    memcpy(pl_manifolds(&w->narrow), s->manifolds, w->narrow.manifold_count * sizeof(pl_manifold));
    memcpy(pl_pairs(&w->broad.pairs), s->pairs, w->broad.pairs.count * sizeof(pl_pair));
    w->solver.bounce_count = s->bounces;
}

static void check_same(const plumb_world *w, const moment *s)
{
    void *part[5];
    size_t size[5];
    parts_of(w, part, size);
    for (int i = 0; i < 5; ++i) {
        assert_memory_equal(part[i], s->part[i], size[i]);
    }
    assert_memory_equal(pl_manifolds(&w->narrow), s->manifolds,
                        w->narrow.manifold_count * sizeof(pl_manifold));
    assert_memory_equal(pl_pairs(&w->broad.pairs), s->pairs,
                        w->broad.pairs.count * sizeof(pl_pair));
    assert_int_equal(w->solver.bounce_count, s->bounces);
}

static void drop(moment *s)
{
    for (int i = 0; i < 5; ++i) {
        test_free(s->part[i]);
    }
    test_free(s->manifolds);
    test_free(s->pairs);
}

typedef struct tally {
    uint32_t contacts, open, impacts, pairs_of_impacts, overflow;
} tally;

// Impacts of a substep from the present state: in lanes, one after another, and those alone that the
// prediction leaves open.
static void check_substep(plumb_world *w, near_real h, tally *t)
{
    pl_solver *s = &w->solver;
    moment before = save(w);
    pl_impacts_run(w, h);
    assert_int_equal(s->impact_count, 0); // no record was needed
    moment after = save(w);

    bring_back(w, &before);
    record_impacts(w);
    assert_int_equal(s->lively_count, 0);
    pl_impacts_run(w, h);
    check_same(w, &after);
    for (uint32_t lane = 0; lane < s->predicted_lanes; ++lane) {
        if (((const pl_predicted_ends *)s->predicted_ends.data)[lane].impact != PL_NONE) {
            t->open += ((const uint8_t *)s->predicted_open.data)[lane];
        }
    }

    bring_back(w, &before);
    s->predicted_lanes = 0;
    pl_impacts_run(w, h);
    check_same(w, &after);

    t->contacts += s->impact_count;
    t->overflow += s->overflow_count;
    t->impacts += after.bounces - before.bounces;
    for (uint32_t i = 0; i < w->narrow.manifold_count; ++i) {
        const pl_manifold_point *was = before.manifolds[i].point, *is = after.manifolds[i].point;
        t->pairs_of_impacts += is[0].total > was[0].total && is[1].total > was[1].total;
    }
    drop(&before);
    drop(&after);
}

static void check_heap(int width, double belt)
{
    plumb_world *w = make_heap(width, belt);
    tally t = { 0 };
    for (int i = 0; i < 200; ++i) {
        assert_int_equal(plumb_world_step(w, R(1) / 60), PLUMB_OK);
        if (w->solver.bundle_count > 0) {
            check_substep(w, (near_real)R(1) / 240, &t);
            w->solver.impact_count = 0;
        }
    }
    print_message("width %d: %u contacts, %u left open, %u struck, %u at both points\n", width,
                  t.contacts, t.open, t.impacts, t.pairs_of_impacts);
    assert_true(t.contacts > 10000 && t.open < t.contacts / 2);
    assert_true(t.overflow > 1000 && t.impacts > 1000 && t.pairs_of_impacts > 50);
    plumb_world_destroy(w);
}

static void lanes_strike_as_one_by_one(void **state)
{
    (void)state;
    for (int width = 4; width <= 16; width *= 2) {
        check_heap(width, 0);
        check_heap(width, 2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lanes_strike_as_one_by_one),
    };
    return cmocka_run_group_tests_name("dull", tests, NULL, NULL);
}
