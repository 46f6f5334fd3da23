// test_body_contacts.c - what a body touches is what the list of the whole world says of it: after steps, after edits between them, in
// rollback, whether all bodies were asked in the last step or none.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "harness/random.h"
#include "harness/sim.h"
#include "harness/trials.h"

enum { BODIES = 60, MOST = 2000, FRAMES = 120 };

typedef struct stage {
    plumb_world *world;
    plumb_body body[BODIES];
    uint32_t random;
    plumb_contact all[MOST];
    int count;
} stage;

static void make(stage *s, int i)
{
    const double x = sim_uniform(&s->random, -4, 4), y = sim_uniform(&s->random, 0.5, 9),
                 size = sim_uniform(&s->random, 0.15, 0.4);
    const bool kinematic = i % 15 == 14;
    s->body[i] = plumb_body_create(
        s->world, &(plumb_body_desc){ .type = kinematic ? PLUMB_KINEMATIC : PLUMB_DYNAMIC,
                                      .position = sim_vec(x, y) });
    const int shapes = i % 5 == 0 ? 2 : 1;
    for (int k = 0; k < shapes; ++k) {
        const plumb_shape_desc box = { .kind = PLUMB_BOX,
                                       .half = sim_vec(size, 0.5 * size),
                                       .center = sim_vec(k * size, 0),
                                       .angle = (plumb_real)k };
        const plumb_shape_desc disc = { .kind = PLUMB_CIRCLE, .radius = (plumb_real)size };
        assert_false(plumb_is_null(
            plumb_shape_create(s->world, s->body[i], i % 3 == 1 && shapes == 1 ? &disc : &box)));
    }
}

static void edit(stage *s)
{
    const int i = (int)(sim_random(&s->random) % BODIES);
    const plumb_body body = s->body[i];
    const bool can_sleep = plumb_body_get_type(s->world, body) == PLUMB_DYNAMIC &&
                           plumb_body_is_enabled(s->world, body);
    switch (sim_random(&s->random) % 7) {
    case 0:
        plumb_body_destroy(s->world, body);
        make(s, i);
        break;
    case 1:
        plumb_body_set_position(s->world, body, sim_vec(sim_uniform(&s->random, -4, 4), 5));
        break;
    case 2:
        plumb_body_set_enabled(s->world, body, !plumb_body_is_enabled(s->world, body));
        break;
    case 3:
        plumb_body_set_type(s->world, body, (plumb_body_type)(sim_random(&s->random) % 3));
        break;
    case 4:
        if (can_sleep) {
            plumb_body_sleep(s->world, body);
        }
        break;
    case 5:
        if (can_sleep) {
            plumb_body_wake(s->world, body);
        }
        break;
    default: {
        plumb_shape shape[4];
        plumb_body_shapes(s->world, body, shape, 4);
        plumb_shape_set_filter(s->world, shape[0],
                               (plumb_filter){ .nothing = sim_random(&s->random) % 2 == 0 });
        break;
    }
    }
}

static bool are_equal(const plumb_contact *a, const plumb_contact *b)
{
    bool equal = plumb_same(a->shape_a, b->shape_a) && plumb_same(a->shape_b, b->shape_b) &&
                 a->point_count == b->point_count;
    for (int k = 0; k < a->point_count && equal; ++k) {
        const plumb_contact_point *p = &a->points[k], *q = &b->points[k];
        equal = p->point.x == q->point.x && p->point.y == q->point.y &&
                p->normal_impulse == q->normal_impulse && p->step_impulse == q->step_impulse &&
                p->feature == q->feature;
    }
    return equal;
}

static bool is_listed(const stage *s, const plumb_contact *c)
{
    for (int i = 0; i < s->count; ++i) {
        if (are_equal(&s->all[i], c)) {
            return true;
        }
    }
    return false;
}

static bool names(const plumb_contact *c, plumb_body body)
{
    return plumb_same(c->body_a, body) || plumb_same(c->body_b, body);
}

// Of all contacts, as they were listed last.
static int count_of(const stage *s, plumb_body body)
{
    int count = 0;
    for (int i = 0; i < s->count; ++i) {
        count += names(&s->all[i], body);
    }
    return count;
}

// Every body has of all contacts those that name it, each once.
static void check(stage *s)
{
    s->count = plumb_world_contacts(s->world, s->all, MOST);
    for (int b = 0; b < BODIES; ++b) {
        plumb_contact own[64];
        const int count = plumb_body_contacts(s->world, s->body[b], own, 64);
        assert_int_equal(count, count_of(s, s->body[b]));
        for (int i = 0; i < count; ++i) {
            assert_true(names(&own[i], s->body[b]));
            assert_true(is_listed(s, &own[i]));
            for (int k = 0; k < i; ++k) {
                assert_false(are_equal(&own[i], &own[k]));
            }
        }
    }
}

static void a_body_has_what_the_world_says(void **state)
{
    (void)state;
    const trials t = trials_from(1, 12);
    static stage s;
    for (uint32_t seed = t.first; seed < t.end; ++seed) {
        s = (stage){ .world = sim_world(&(plumb_world_desc){ .contact_impulses = seed % 2 == 0 }),
                     .random = (seed * 2654435761u) | 1 };
        sim_floor(s.world, sim_material(s.world, 0.5, 0.2));
        for (int i = 0; i < BODIES; ++i) {
            make(&s, i);
        }
        int found = 0;
        void *image = NULL;
        size_t size = 0;
        for (int frame = 0; frame < FRAMES; ++frame) {
            sim_step(s.world, sim_random(&s.random) % 8 == 0 ? 0 : 1.0 / 60);
            if (sim_random(&s.random) % 2 ==
                0) { // else nobody is asked, and the next step has no index
                check(&s);
                found += s.count;
            }
            for (uint32_t k = sim_random(&s.random) % 3; k-- > 0;) {
                edit(&s);
                check(&s);
            }
            if (frame == 40) {
                size = plumb_world_snapshot_size(s.world);
                image = malloc(size);
                assert_int_equal(plumb_world_save(s.world, image, size), PLUMB_OK);
            }
        }
        assert_true(found > 300);
        assert_int_equal(plumb_world_restore(s.world, image, size), PLUMB_OK);
        free(image);
        s.count = plumb_world_contacts(s.world, s.all, MOST);
        for (int b = 0; b < BODIES; ++b) {
            if (plumb_body_valid(s.world, s.body[b])) {
                const int count = plumb_body_contacts(s.world, s.body[b], NULL, 0);
                assert_int_equal(count, count_of(&s, s.body[b]));
            }
        }
        plumb_world_destroy(s.world);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_body_has_what_the_world_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
