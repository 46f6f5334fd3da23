// test_touches.c - the books that a game keeps: every touch that began ends, once, whatever is done to what touches, awake or
// asleep: destroyed, disabled, of another type, form, filter or size, moved, put to sleep, joined, excluded, a sensor.
//
// Random worlds of crates, balls and sensors under a lift that comes and goes. After each step, of dt 0 too: who begins did not touch
// and is there, who ends did, whoever touches is there and enabled; contacts that are listed are those that touch; overlaps of
// sensors likewise. Every few steps a restored copy tells the same events and has the same hash.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/sim.h"

#define BODIES 40
#define JOINTS 10
#define PAIRS  4096
#define WORLDS 60
#define STEPS  400

typedef struct book {
    plumb_shape a[PAIRS], b[PAIRS];
    int count;
} book;

typedef struct game {
    plumb_world *w, *copy;
    plumb_body body[BODIES], lift;
    plumb_joint joint[JOINTS];
    book touches, overlaps;
    uint32_t chance;
    long begins, ends, asleep; // told in all; changes of what slept
} game;

static double between(game *g, double low, double high)
{
    return sim_uniform(&g->chance, low, high);
}

static int below(game *g, int count)
{
    return (int)(sim_random(&g->chance) % (uint32_t)count);
}

//---- the books -----------------------------------------------------------------------------------

static int find(const book *all, plumb_shape a, plumb_shape b)
{
    int at = 0;
    while (at < all->count && !(plumb_same(all->a[at], a) && plumb_same(all->b[at], b))) {
        ++at;
    }
    return at;
}

static int find_touch(const book *all, plumb_shape a, plumb_shape b)
{
    const int at = find(all, a, b);
    return at < all->count ? at : find(all, b, a);
}

static void strike_out(book *all, int at)
{
    assert_in_range(at, 0, all->count - 1);
    --all->count;
    all->a[at] = all->a[all->count], all->b[at] = all->b[all->count];
}

static void enter(book *all, plumb_shape a, plumb_shape b)
{
    assert_true(all->count < PAIRS);
    all->a[all->count] = a, all->b[all->count] = b;
    ++all->count;
}

static bool is_there(const plumb_world *w, plumb_shape shape)
{
    return plumb_shape_valid(w, shape) && plumb_body_is_enabled(w, plumb_shape_body(w, shape));
}

static void keep_touches(game *g)
{
    int begins, ends;
    const plumb_contact_begin *begun = plumb_world_begin_events(g->w, &begins);
    const plumb_contact_end *ended = plumb_world_end_events(g->w, &ends);
    for (int i = 0; i < ends; ++i) {
        strike_out(&g->touches, find_touch(&g->touches, ended[i].shape_a, ended[i].shape_b));
    }
    for (int i = 0; i < begins; ++i) {
        assert_int_equal(find_touch(&g->touches, begun[i].shape_a, begun[i].shape_b),
                         g->touches.count);
        enter(&g->touches, begun[i].shape_a, begun[i].shape_b);
    }
    for (int i = 0; i < g->touches.count; ++i) {
        assert_true(is_there(g->w, g->touches.a[i]) && is_there(g->w, g->touches.b[i]));
    }
    static plumb_contact contacts[PAIRS];
    const int listed = plumb_world_contacts(g->w, contacts, PAIRS);
    assert_int_equal(listed, g->touches.count);
    for (int i = 0; i < listed; ++i) {
        assert_true(find_touch(&g->touches, contacts[i].shape_a, contacts[i].shape_b) <
                    g->touches.count);
    }
    g->begins += begins, g->ends += ends;
}

static void keep_overlaps(game *g)
{
    int begins, ends;
    const plumb_sensor_event *begun = plumb_world_sensor_begin_events(g->w, &begins);
    const plumb_sensor_event *ended = plumb_world_sensor_end_events(g->w, &ends);
    for (int i = 0; i < ends; ++i) {
        strike_out(&g->overlaps, find(&g->overlaps, ended[i].sensor, ended[i].shape));
    }
    for (int i = 0; i < begins; ++i) {
        assert_int_equal(find(&g->overlaps, begun[i].sensor, begun[i].shape), g->overlaps.count);
        enter(&g->overlaps, begun[i].sensor, begun[i].shape);
    }
    for (int i = 0; i < g->overlaps.count; ++i) {
        assert_true(is_there(g->w, g->overlaps.a[i]) && is_there(g->w, g->overlaps.b[i]));
    }
}

static void step(game *g, double dt, bool beside)
{
    if (beside) {
        const size_t size = plumb_world_snapshot_size(g->w);
        void *image = malloc(size);
        assert_int_equal(plumb_world_save(g->w, image, size), PLUMB_OK);
        assert_int_equal(plumb_world_restore(g->copy, image, size), PLUMB_OK);
        free(image);
        assert_int_equal(plumb_world_step(g->copy, (plumb_real)dt), PLUMB_OK);
    }
    assert_int_equal(plumb_world_step(g->w, (plumb_real)dt), PLUMB_OK);
    if (beside) {
        int ends, of_copy;
        assert_true(plumb_world_hash(g->w) == plumb_world_hash(g->copy));
        const plumb_contact_end *told = plumb_world_end_events(g->w, &ends);
        const plumb_contact_end *again = plumb_world_end_events(g->copy, &of_copy);
        assert_int_equal(ends, of_copy);
        assert_true(ends == 0 || memcmp(told, again, (size_t)ends * sizeof *told) == 0);
    }
    keep_touches(g);
    keep_overlaps(g);
}

//---- what is done --------------------------------------------------------------------------------

static void add_shape(game *g, plumb_body b, bool sensor)
{
    const plumb_vec2 half = sim_vec(between(g, 0.2, 0.7), between(g, 0.2, 0.7));
    plumb_shape_desc d = { .kind = PLUMB_BOX, .half = half, .sensor = sensor };
    if (below(g, 2) == 0) {
        d = (plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = half.x, .sensor = sensor };
    }
    plumb_shape_create(g->w, b, &d);
}

static void make_body(game *g, plumb_body *b)
{
    *b = sim_body(g->w, PLUMB_DYNAMIC, between(g, -10, 10), between(g, 0.5, 8), between(g, -3, 3));
    add_shape(g, *b, false);
    if (below(g, 4) == 0) {
        add_shape(g, *b, true);
    }
}

static void change_shape(game *g, plumb_shape s, int how)
{
    switch (how) {
    case 0:
        plumb_shape_set_geometry(g->w, s,
                                 &(plumb_shape_desc){ .kind = PLUMB_CIRCLE,
                                                      .radius = (plumb_real)between(g, 0.2, 0.7) });
        break;
    case 1:
        plumb_shape_set_filter(
            g->w, s,
            (plumb_filter){ .category = 1u << below(g, 3), .mask = below(g, 3) == 0 ? 2 : 0 });
        break;
    case 2:
        plumb_shape_set_sensor(g->w, s, !plumb_shape_is_sensor(g->w, s));
        break;
    default:
        plumb_shape_destroy(g->w, s);
        break;
    }
}

static void join(game *g, plumb_body b, plumb_body other)
{
    plumb_joint *j = &g->joint[below(g, JOINTS)];
    if (plumb_joint_valid(g->w, *j)) {
        plumb_joint_destroy(g->w, *j);
    } else if (plumb_body_valid(g->w, other) && !plumb_same(b, other)) {
        *j =
            plumb_joint_create(g->w, &(plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                                          .body_a = b,
                                                          .body_b = other,
                                                          .anchor = plumb_body_position(g->w, b) });
    }
}

static void change(game *g)
{
    plumb_world *w = g->w;
    plumb_body *b = &g->body[below(g, BODIES)];
    const plumb_body other = g->body[below(g, BODIES)];
    if (!plumb_body_valid(w, *b)) {
        make_body(g, b);
        return;
    }
    plumb_shape s = PLUMB_NULL_INIT;
    plumb_body_shapes(w, *b, &s, 1);
    g->asleep += !plumb_body_is_awake(w, *b);
    const int how = below(g, 13);
    if (how < 4 && plumb_shape_valid(w, s)) {
        change_shape(g, s, how);
    } else if (how == 4) {
        plumb_body_destroy(w, *b);
    } else if (how == 5 || how == 6) {
        plumb_body_set_enabled(w, *b, !plumb_body_is_enabled(w, *b));
    } else if (how == 7) {
        plumb_body_set_type(w, *b, (plumb_body_type)below(g, 3));
    } else if (how == 8) {
        plumb_body_teleport(w, *b, sim_vec(between(g, -10, 10), between(g, 0.5, 8)), 0);
    } else if (how == 9 && plumb_body_get_type(w, *b) == PLUMB_DYNAMIC &&
               plumb_body_is_enabled(w, *b)) {
        plumb_body_sleep(w, *b);
    } else if (how == 10) {
        join(g, *b, other);
    } else if (how == 11 && plumb_body_valid(w, other) && !plumb_same(*b, other)) {
        plumb_world_exclude_pair(w, *b, other, !plumb_world_is_excluded(w, *b, other));
    } else if (how == 12) {
        plumb_body_scale(w, *b, (plumb_real)between(g, 0.8, 1.2));
    }
}

static void clear_away(game *g)
{
    for (int i = 0; i < BODIES; ++i) {
        if (plumb_body_valid(g->w, g->body[i]) &&
            (sim_y(g->w, g->body[i]) < -50 || sim_y(g->w, g->body[i]) > 500)) {
            plumb_body_destroy(g->w, g->body[i]);
        }
    }
}

//---- the test ------------------------------------------------------------------------------------

static void begin(game *g, uint32_t seed)
{
    *g = (game){ .chance = 2 * seed + 1 };
    assert_int_equal(plumb_world_create(NULL, &g->w), PLUMB_OK);
    assert_int_equal(plumb_world_create(NULL, &g->copy), PLUMB_OK);
    const plumb_material none = PLUMB_NULL_INIT;
    plumb_body ground = sim_body(g->w, PLUMB_STATIC, 0, -1, 0);
    sim_add_box(g->w, ground, 20, 1, none);
    plumb_body zone = sim_body(g->w, PLUMB_STATIC, 0, 1, 0);
    plumb_shape_create(
        g->w, zone,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = sim_vec(3, 1), .sensor = true });
    g->lift = sim_body(g->w, PLUMB_KINEMATIC, -6, 1, 0);
    sim_add_box(g->w, g->lift, 2, 0.2, none);
}

static void every_touch_ends_once(void **state)
{
    (void)state;
    static game g;
    for (uint32_t seed = 0; seed < WORLDS; ++seed) {
        begin(&g, seed);
        bool busy = true;
        for (int i = 0; i < STEPS; ++i) {
            busy ^= below(&g, 60) == 0;
            if (i % 100 == 0) {
                plumb_body_set_target(g.w, g.lift, sim_vec(-6, between(&g, 0.3, 3)), 0,
                                      (plumb_real)between(&g, 0.1, 2));
            }
            for (int k = busy || below(&g, 50) == 0 ? below(&g, 4) : 0; k > 0; --k) {
                change(&g);
            }
            if (below(&g, 10) == 0) {
                step(&g, 0, i % 7 == 0);
            }
            step(&g, 1 / 60.0, i % 5 == 0);
            clear_away(&g);
        }
        print_message("seed %u: %ld begins, %ld ends, %ld changes of what slept\n", (unsigned)seed,
                      g.begins, g.ends, g.asleep);
        assert_true(g.ends > 20 && g.begins - g.ends == g.touches.count);
        plumb_world_destroy(g.w);
        plumb_world_destroy(g.copy);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(every_touch_ends_once) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
