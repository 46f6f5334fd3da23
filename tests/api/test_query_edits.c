// test_query_edits.c - a world that is asked between one edit and the next answers as its copy, which never saw it otherwise.
//
// Queries keep the grids of the first one and look for what was edited since apart; the copy files all anew.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/random.h"
#include "harness/sim.h"
#include "harness/trials.h"

enum { BODIES = 120, MOST = 512, EDITS = 150 };

typedef struct stage {
    plumb_world *world, *copy;
    plumb_body body[BODIES];
    uint32_t random;
} stage;

static double in(stage *s, double low, double high)
{
    return sim_uniform(&s->random, low, high);
}

static void add_shape(stage *s, plumb_body body)
{
    const double x = in(s, -1, 1), y = in(s, -1, 1), size = in(s, 0.1, 0.6);
    const plumb_shape_desc d = { .kind = sim_random(&s->random) % 2 == 0 ? PLUMB_CIRCLE : PLUMB_BOX,
                                 .center = sim_vec(x, y),
                                 .sensor = sim_random(&s->random) % 8 == 0 };
    plumb_shape_desc made = d;
    if (d.kind == PLUMB_CIRCLE) {
        made.radius = (plumb_real)size;
    } else {
        made.half = sim_vec(size, 0.5 * size);
    }
    assert_false(plumb_is_null(plumb_shape_create(s->world, body, &made)));
}

static void make(stage *s, int i)
{
    static const plumb_body_type types[] = { PLUMB_STATIC, PLUMB_KINEMATIC, PLUMB_DYNAMIC,
                                             PLUMB_DYNAMIC };
    const double x = in(s, -12, 12), y = in(s, -12, 12), angle = in(s, -3, 3);
    s->body[i] =
        plumb_body_create(s->world, &(plumb_body_desc){ .type = types[sim_random(&s->random) % 4],
                                                        .position = sim_vec(x, y),
                                                        .angle = (plumb_real)angle });
    for (uint32_t k = sim_random(&s->random) % 3; k < 3; ++k) {
        add_shape(s, s->body[i]);
    }
}

static void edit(stage *s)
{
    const int i = (int)(sim_random(&s->random) % BODIES);
    const plumb_body body = s->body[i];
    const double x = in(s, -12, 12), y = in(s, -12, 12);
    plumb_shape shape[8];
    const int shapes = plumb_body_shapes(s->world, body, shape, 8);
    switch (sim_random(&s->random) % 9) {
    case 0:
        plumb_body_set_position(s->world, body, sim_vec(x, y));
        break;
    case 1:
        plumb_body_set_angle(s->world, body, (plumb_real)x);
        break;
    case 2:
        plumb_body_destroy(s->world, body);
        make(s, i);
        break;
    case 3:
        plumb_body_set_enabled(s->world, body, !plumb_body_is_enabled(s->world, body));
        break;
    case 4:
        plumb_body_set_type(s->world, body, (plumb_body_type)(sim_random(&s->random) % 3));
        break;
    case 5:
        if (shapes > 1) {
            plumb_shape_destroy(s->world, shape[0]);
        }
        break;
    case 6:
        if (shapes < 8) {
            add_shape(s, body);
        }
        break;
    case 7:
        plumb_shape_set_filter(s->world, shape[0],
                               (plumb_filter){ .category = 1u << sim_random(&s->random) % 3 });
        break;
    default:
        if (plumb_body_get_type(s->world, body) == PLUMB_DYNAMIC &&
            plumb_body_is_enabled(s->world, body)) {
            (void)(plumb_body_is_awake(s->world, body) ? plumb_body_sleep(s->world, body)
                                                       : plumb_body_wake(s->world, body));
        }
        break;
    }
}

static void copy_world(stage *s)
{
    const size_t size = plumb_world_snapshot_size(s->world);
    void *image = malloc(size);
    assert_int_equal(plumb_world_save(s->world, image, size), PLUMB_OK);
    assert_int_equal(plumb_world_restore(s->copy, image, size), PLUMB_OK);
    free(image);
}

static void same_shapes(const plumb_shape *a, int count, const plumb_shape *b, int expected)
{
    assert_int_equal(count, expected);
    for (int i = 0; i < count; ++i) {
        assert_true(plumb_same(a[i], b[i]));
    }
}

static void same_rays(stage *s, plumb_vec2 from, plumb_vec2 to, const plumb_query_filter *f)
{
    plumb_ray_hit one = { .fraction = 0 }, other = { .fraction = 0 }, all[MOST], others[MOST];
    assert_int_equal(plumb_world_ray(s->world, from, to, f, &one),
                     plumb_world_ray(s->copy, from, to, f, &other));
    assert_true(plumb_same(one.shape, other.shape) && one.fraction == other.fraction);
    assert_int_equal(plumb_world_ray_any(s->world, from, to, f), !plumb_is_null(one.shape));
    const int count = plumb_world_ray_all(s->world, from, to, f, all, MOST);
    assert_int_equal(count, plumb_world_ray_all(s->copy, from, to, f, others, MOST));
    for (int i = 0; i < count; ++i) {
        assert_true(plumb_same(all[i].shape, others[i].shape) &&
                    all[i].fraction == others[i].fraction);
    }
}

static void same_nearest(stage *s, plumb_vec2 point, const plumb_query_filter *f)
{
    plumb_nearest_hit one = { .distance = 0 }, other = { .distance = 0 }, all[MOST], others[MOST];
    assert_int_equal(plumb_world_nearest(s->world, point, 30, f, &one),
                     plumb_world_nearest(s->copy, point, 30, f, &other));
    assert_true(plumb_same(one.shape, other.shape) && one.distance == other.distance);
    const int count = plumb_world_nearest_all(s->world, point, 4, f, all, MOST);
    assert_int_equal(count, plumb_world_nearest_all(s->copy, point, 4, f, others, MOST));
    for (int i = 0; i < count; ++i) {
        assert_true(plumb_same(all[i].shape, others[i].shape) &&
                    all[i].distance == others[i].distance);
    }
}

static void same_overlaps(stage *s, plumb_vec2 p, const plumb_query_filter *f)
{
    const plumb_aabb box = { { p.x - 2, p.y - 2 }, { p.x + 2, p.y + 2 } };
    plumb_shape a[MOST], b[MOST];
    int count = plumb_world_overlap_aabb(s->world, box, f, a, MOST);
    same_shapes(a, count, b, plumb_world_overlap_aabb(s->copy, box, f, b, MOST));
    count = plumb_world_overlap_point(s->world, p, f, a, MOST);
    same_shapes(a, count, b, plumb_world_overlap_point(s->copy, p, f, b, MOST));
}

static void same_answers(stage *s)
{
    const plumb_query_filter filters[] = { { .sensors = true },
                                           { .ignore_static = true },
                                           { .ignore_dynamic = true, .sensors = true },
                                           { .mask = 2 } };
    const plumb_query_filter *f = &filters[sim_random(&s->random) % 4];
    const double x = in(s, -13, 13), y = in(s, -13, 13), u = in(s, -13, 13), v = in(s, -13, 13);
    same_rays(s, sim_vec(x, y), sim_vec(u, v), f);
    same_nearest(s, sim_vec(x, v), f);
    same_overlaps(s, sim_vec(u, y), f);
}

// What a blast gives each body, in both.
static void same_blast(stage *s)
{
    const double x = in(s, -8, 8), y = in(s, -8, 8);
    const plumb_explosion_desc d = {
        .position = sim_vec(x, y), .radius = 2, .falloff = 2, .impulse = 3
    };
    plumb_world_explode(s->world, &d);
    plumb_world_explode(s->copy, &d);
    for (int i = 0; i < BODIES; ++i) {
        const plumb_vec2 a = plumb_body_velocity(s->world, s->body[i]),
                         b = plumb_body_velocity(s->copy, s->body[i]);
        assert_true(a.x == b.x && a.y == b.y);
    }
}

static void queries_see_edits(void **state)
{
    (void)state;
    const trials t = trials_from(1, 12);
    for (uint32_t seed = t.first; seed < t.end; ++seed) {
        const bool wraps = seed % 4 == 0;
        const plumb_world_desc d = { .wrap_x = wraps ? 30 : 0, .wrap_y = wraps ? 30 : 0 };
        stage s = { .world = sim_world(&d),
                    .copy = sim_world(&d),
                    .random = (seed * 2654435761u) | 1 };
        for (int i = 0; i < BODIES; ++i) {
            make(&s, i);
        }
        for (int i = 0; i < EDITS; ++i) {
            // Edits alone, several, and so many that all is filed anew.
            const uint32_t edits =
                sim_random(&s.random) % 16 == 0 ? 90 : 1 + sim_random(&s.random) % 3;
            for (uint32_t k = 0; k < edits; ++k) {
                edit(&s);
            }
            copy_world(&s);
            same_answers(&s);
            if (i % 10 == 9) {
                same_blast(&s);
            }
            if (i % 25 == 24) {
                sim_step(s.world, 1.0 / 60);
            }
        }
        plumb_world_destroy(s.world);
        plumb_world_destroy(s.copy);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(queries_see_edits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
