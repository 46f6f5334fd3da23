// test_pairs_threads.c - the pair list made by several threads against that of one: the same pairs in the same
// order, with what they kept, and the same ends told in the same order; so many that every thread has a share.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "event/event.h"
#include "broad/pairs.h"
#include "plumb/plumb.h"
#include "random_world.h"
#include "world/state.h"

#define DT ((plumb_real)(1.0 / 60))

enum { bodies_count = 3000, most_threads = 4, pairs_a_thread = 4096 };

typedef struct crowd {
    plumb_world *world;
    plumb_body bodies[bodies_count];
} crowd;

static void add(crowd *c, int i, bool one_kind)
{
    const plumb_body_type types[] = { PLUMB_DYNAMIC, PLUMB_DYNAMIC, PLUMB_DYNAMIC, PLUMB_KINEMATIC,
                                      PLUMB_STATIC };
    plumb_body_desc desc = { .type = types[(int)uniform(0, 4.999)], .position = place(16) };
    c->bodies[i] = plumb_body_create(c->world, &desc);
    double size = i % 500 == 0 ? 15 : spread(0.5, 1.2); // some meet thousands
    random_shape(c->world, c->bodies[i], one_kind ? PLUMB_CIRCLE : (int)uniform(0, 6.999), size,
                 (plumb_material)PLUMB_NULL_INIT);
}

static void make(crowd *c, int workers, bool one_kind)
{
    random_state = 77;
    plumb_world_desc desc = { .zero_gravity = true, .workers = workers };
    assert_int_equal(plumb_world_create(&desc, &c->world), PLUMB_OK);
    for (int i = 0; i < bodies_count; ++i) {
        add(c, i, one_kind);
    }
}

// One in so many is moved, as the solver does it.
static void move(crowd *c, int one_in)
{
    for (int i = 0; i < bodies_count; ++i) {
        double x = uniform(-1, 1), y = uniform(-1, 1);
        uint32_t row = pl_body_row(c->world, c->bodies[i]);
        if (i % one_in == 0 && c->world->bodies.type[row] != PLUMB_STATIC) {
            c->world->bodies.x[row] += (plumb_real)x;
            c->world->bodies.y[row] += (plumb_real)y;
            pl_body_update_center(c->world, row);
        }
    }
}

static void replace(crowd *c, int one_in, bool one_kind)
{
    for (int i = 0; i < bodies_count; i += one_in) {
        assert_int_equal(plumb_body_destroy(c->world, c->bodies[i]), PLUMB_OK);
    }
    for (int i = 0; i < bodies_count; i += one_in) {
        add(c, i, one_kind);
    }
}

// Something to keep; two in three touch, so that their ends are told.
static void mark(crowd *c)
{
    pl_pair *pairs = pl_pairs(&c->world->broad.pairs);
    for (uint32_t i = 0; i < c->world->broad.pairs.count; ++i) {
        pairs[i].normal[0] = (near_real)i;
        pairs[i].flags = i % 3 > 0 ? PL_PAIR_TOUCHING : 0;
        pairs[i].manifold = i % 3 > 0 ? i : PL_NONE;
    }
}

static void expect_same_pairs(const plumb_world *a, const plumb_world *b)
{
    const pl_pair_list *one = &a->broad.pairs, *several = &b->broad.pairs;
    assert_int_equal(one->count, several->count);
    assert_memory_equal(one->first, several->first, sizeof one->first);
    assert_memory_equal(one->size, several->size, sizeof one->size);
    for (uint32_t i = 0; i < one->count; ++i) {
        const pl_pair *p = &pl_pairs(one)[i], *q = &pl_pairs(several)[i];
        assert_true(p->a == q->a && p->b == q->b && p->body_a == q->body_a &&
                    p->body_b == q->body_b && p->manifold == q->manifold && p->flags == q->flags &&
                    p->feature[0] == q->feature[0] && p->normal[0] == q->normal[0]);
    }
    assert_int_equal(a->end_count, b->end_count);
    for (int i = 0; i < a->end_count; ++i) {
        const plumb_contact_end *p = (const plumb_contact_end *)a->end_events.data + i;
        const plumb_contact_end *q = (const plumb_contact_end *)b->end_events.data + i;
        assert_true(p->shape_a.entity.index == q->shape_a.entity.index &&
                    p->shape_b.entity.index == q->shape_b.entity.index);
    }
}

static void act(crowd *c, int step, bool one_kind)
{
    random_state = (uint32_t)step * 2654435761u + 1;
    switch (step % 4) {
    case 0:
        move(c, 20); // the list is brought up to date
        break;
    case 1:
        move(c, 1); // it is made from nothing
        break;
    case 2:
        replace(c, 50, one_kind); // slots have other pieces
        break;
    default:
        move(c, 3);
        break;
    }
}

static void compare(int workers, bool one_kind)
{
    static crowd one, several;
    make(&one, 1, one_kind);
    make(&several, workers, one_kind);
    int ends = 0;
    for (int step = 0; step < 6; ++step) {
        assert_true(pl_broad_update(one.world, DT, &pl_end_listener));
        assert_true(pl_broad_update(several.world, DT, &pl_end_listener));
        pl_tasks_rest(several.world->tasks);
        assert_true(one.world->broad.pairs.count > most_threads * pairs_a_thread);
        expect_same_pairs(one.world, several.world);
        ends += one.world->end_count;
        pl_events_clear(one.world);
        pl_events_clear(several.world);
        mark(&one);
        mark(&several);
        act(&one, step, one_kind);
        act(&several, step, one_kind);
    }
    assert_true(ends > 10000);
    plumb_world_destroy(one.world);
    plumb_world_destroy(several.world);
}

static void test_all_kinds(void **state)
{
    (void)state;
    compare(2, false);
    compare(most_threads, false);
}

static void test_one_kind(void **state)
{
    (void)state;
    compare(3, true);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_kinds),
        cmocka_unit_test(test_one_kind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
