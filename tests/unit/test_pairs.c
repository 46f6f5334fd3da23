// test_pairs.c - the pair list against brute force over all fat boxes, in worlds of all kinds of
// shapes that move, come and go; and what a pair carries over from list to list.

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
#include "world/rows.h"
#include "plumb/plumb.h"
#include "random_world.h"
#include "world/state.h"

#define DT   ((plumb_real)(1.0 / 60))
#define MOST 400
#define R(x) ((plumb_real)(x))

static plumb_body add_body(plumb_world *world, plumb_body_type type, double reach, double speed)
{
    plumb_body_desc desc = { .type = type, .position = place(reach) };
    desc.angle = (plumb_real)uniform(-4, 4);
    if (type != PLUMB_STATIC) {
        desc.velocity = place(speed);
        desc.angular_velocity = (plumb_real)uniform(-2, 2);
    }
    plumb_body body = plumb_body_create(world, &desc);
    assert_true(plumb_body_valid(world, body));
    return body;
}

static plumb_body add_random(plumb_world *world, double reach, double least, double most)
{
    const plumb_body_type types[] = { PLUMB_DYNAMIC, PLUMB_DYNAMIC, PLUMB_DYNAMIC, PLUMB_KINEMATIC,
                                      PLUMB_STATIC };
    plumb_body body = add_body(world, types[(int)uniform(0, 4.999)], reach, 3);
    int shapes = uniform(0, 1) < 0.8 ? 1 : (int)uniform(0, 3.999);
    for (int i = 0; i < shapes; ++i) {
        random_shape(world, body, (int)uniform(0, 6.999), spread(least, most),
                     (plumb_material)PLUMB_NULL_INIT);
    }
    return body;
}

//---- brute force ---------------------------------------------------------------------------------

static bool is_dynamic(const plumb_world *world, uint32_t piece)
{
    return world->bodies.type[world->pieces.body[piece]] == PLUMB_DYNAMIC;
}

static bool should_pair(const plumb_world *world, uint32_t p, uint32_t q)
{
    const pl_pieces *pieces = &world->pieces;
    return pieces->kind[p] != PL_PIECE_FREE && pieces->kind[q] != PL_PIECE_FREE &&
           pieces->body[p] != pieces->body[q] && (is_dynamic(world, p) || is_dynamic(world, q)) &&
           pl_boxes_overlap(&pieces->fat[p], &pieces->fat[q]);
}

// The tight box, and what the speculative distance asks for, lie in the fat box.
static void check_fat_boxes(const plumb_world *world)
{
    for (uint32_t p = 0; p < world->pieces.table.count; ++p) {
        if (world->pieces.kind[p] == PL_PIECE_FREE) {
            continue;
        }
        pl_box tight = pl_piece_tight_box(world, p);
        const pl_box *fat = &world->pieces.fat[p];
        plumb_real margin = PL_SPECULATIVE / 2;
        assert_true(fat->min_x <= tight.min_x - margin && fat->max_x >= tight.max_x + margin);
        assert_true(fat->min_y <= tight.min_y - margin && fat->max_y >= tight.max_y + margin);
    }
}

static uint64_t key_of(const pl_pair *pair)
{
    uint64_t low = pair->a < pair->b ? pair->a : pair->b;
    uint64_t high = pair->a < pair->b ? pair->b : pair->a;
    return low << 32 | high;
}

// Sorted by kinds, then slots, which also means: each pair once. Ranges by kinds are right.
static void check_order(const plumb_world *world)
{
    const pl_pair_list *list = &world->broad.pairs;
    const pl_pair *pairs = pl_pairs(list);
    uint32_t seen = 0;
    for (int a = 0; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = 0; b < PL_PIECE_KIND_COUNT; ++b) {
            uint32_t first = list->first[a][b];
            seen += list->size[a][b];
            for (uint32_t i = first; i < first + list->size[a][b]; ++i) {
                assert_int_equal(world->pieces.kind[pairs[i].a], a);
                assert_int_equal(world->pieces.kind[pairs[i].b], b);
                assert_true(a < b || (a == b && pairs[i].a < pairs[i].b));
                assert_true(i == first || key_of(&pairs[i - 1]) < key_of(&pairs[i]));
            }
        }
    }
    assert_int_equal(seen, list->count);
}

static void check_pairs(const plumb_world *world)
{
    check_fat_boxes(world);
    check_order(world);
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    for (uint32_t i = 0; i < world->broad.pairs.count; ++i) {
        assert_true(should_pair(world, pairs[i].a, pairs[i].b));
        assert_int_equal(pairs[i].body_a, world->pieces.body[pairs[i].a]);
        assert_int_equal(pairs[i].body_b, world->pieces.body[pairs[i].b]);
    }
    uint32_t expected = 0;
    for (uint32_t p = 0; p < world->pieces.table.count; ++p) {
        for (uint32_t q = p + 1; q < world->pieces.table.count; ++q) {
            expected += should_pair(world, p, q);
        }
    }
    // All that are there should be and none is there twice: with the right number, none is missing.
    assert_int_equal(world->broad.pairs.count, expected);
}

static void update(plumb_world *world)
{
    assert_true(pl_broad_update(world, DT, &pl_end_listener));
    check_pairs(world);
}

//---- lists ---------------------------------------------------------------------------------------

static void test_random_worlds(void **state)
{
    (void)state;
    uint32_t pairs = 0;
    for (uint32_t seed = 1; seed <= 40; ++seed) {
        plumb_world *world = make_world(seed);
        int count = (int)spread(2, MOST);
        double reach = sqrt(count) * spread(0.3, 2);
        for (int i = 0; i < count; ++i) {
            add_random(world, reach, 0.1, 1);
        }
        update(world);
        pairs += world->broad.pairs.count;
        plumb_world_destroy(world);
    }
    assert_true(pairs > 5000);
}

static void test_mixed_sizes(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 20; ++seed) {
        plumb_world *world = make_world(seed);
        double reach = spread(1, 1e4);
        for (int i = 0; i < 200; ++i) {
            add_random(world, spread(1e-2, reach), 1e-3, 1e5);
        }
        update(world);
        assert_true(world->broad.pairs.count > 100);
        plumb_world_destroy(world);
    }
}

static void test_far_away(void **state)
{
    (void)state;
    plumb_world *world = make_world(3);
    for (int i = 0; i < 200; ++i) {
        plumb_body body = add_random(world, 10, 0.2, 2);
        double far = (double)PLUMB_REAL_EPSILON < 1e-10 ? 9e8 : 1e4;
        plumb_vec2 at = plumb_v2((plumb_real)((i % 3 - 1) * far + uniform(-9, 9)),
                                 (plumb_real)((i % 2) * far + uniform(-9, 9)));
        assert_int_equal(plumb_body_teleport(world, body, at, 1), PLUMB_OK);
    }
    update(world);
    assert_true(world->broad.pairs.count > 50);
    plumb_world_destroy(world);
}

// All in one place: every dynamic one against every other.
static void test_pile_up(void **state)
{
    (void)state;
    plumb_world *world = make_world(4);
    for (int i = 0; i < 100; ++i) {
        plumb_body body = add_body(world, (plumb_body_type)(i % 3), 0.01, 1);
        random_shape(world, body, PLUMB_CIRCLE, 1, (plumb_material)PLUMB_NULL_INIT);
    }
    update(world); // 34 dynamic, 66 others
    assert_int_equal(world->broad.pairs.count, 34 * 33 / 2 + 34 * 66);
    plumb_world_destroy(world);
}

static void test_nothing_dynamic(void **state)
{
    (void)state;
    plumb_world *world = make_world(5);
    update(world);
    for (int i = 0; i < 50; ++i) {
        plumb_body body = add_body(world, i % 2 ? PLUMB_STATIC : PLUMB_KINEMATIC, 2, 1);
        random_shape(world, body, i % 7, 1, (plumb_material)PLUMB_NULL_INIT);
    }
    update(world);
    assert_int_equal(world->broad.pairs.count, 0);
    plumb_world_destroy(world);
}

// Bodies fly about without touching the solver: what changes from update to update is position
// alone.
static void test_moving(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 5; ++seed) {
        plumb_world *world = make_world(seed);
        plumb_body bodies[120];
        for (int i = 0; i < 120; ++i) {
            bodies[i] = add_random(world, 6, 0.1, 0.8);
        }
        uint64_t before = world->broad.rebuilds;
        for (int step = 0; step < 200; ++step) {
            for (int i = 0; i < 120; ++i) {
                uint32_t row = pl_body_row(world, bodies[i]);
                world->bodies.x[row] += world->bodies.vx[row] / 600; // as the solver does it
                world->bodies.y[row] += world->bodies.vy[row] / 600;
                pl_body_update_center(world, row);
            }
            update(world);
        }
        uint64_t rebuilds = world->broad.rebuilds - before;
        assert_true(rebuilds > 5 && rebuilds < 200); // fat boxes spare some
        plumb_world_destroy(world);
    }
}

static void test_stepped(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 4; ++seed) {
        plumb_world *world = make_world(seed + 100);
        plumb_world_set_sleep(world, false, 0, 0); // see test_sleep.c
        for (int i = 0; i < 100; ++i) {
            add_random(world, 8, 0.2, 0.7);
        }
        for (int step = 0; step < 60; ++step) {
            assert_int_equal(plumb_world_step(world, DT), PLUMB_OK);
            check_order(world);
            update(world);
        }
        plumb_world_destroy(world);
    }
}

// Bodies and shapes come, go, and are moved by hand.
static void test_structural_changes(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 6; ++seed) {
        plumb_world *world = make_world(seed + 200);
        plumb_body bodies[MOST];
        int count = 0;
        for (int round = 0; round < 250; ++round) {
            double dice = uniform(0, 1);
            int chosen = (int)uniform(0, count - 0.001);
            if (count < 20 || (dice < 0.4 && count < MOST)) {
                bodies[count++] = add_random(world, 4, 0.1, 1);
            } else if (dice < 0.6) {
                assert_int_equal(plumb_body_destroy(world, bodies[chosen]), PLUMB_OK);
                bodies[chosen] = bodies[--count];
            } else if (dice < 0.75) {
                assert_int_equal(plumb_body_teleport(world, bodies[chosen], place(4), 1), PLUMB_OK);
            } else if (dice < 0.9) {
                random_shape(world, bodies[chosen], (int)uniform(0, 6.999), spread(0.1, 1),
                             (plumb_material)PLUMB_NULL_INIT);
            } else {
                plumb_shape shapes[8];
                int n = plumb_body_shapes(world, bodies[chosen], shapes, 8);
                if (n > 0) {
                    assert_int_equal(plumb_shape_destroy(world, shapes[0]), PLUMB_OK);
                }
            }
            if (round % 3 == 0) {
                update(world);
            }
        }
        plumb_world_destroy(world);
    }
}

// Rows of bodies change places when a body without shapes comes or goes: the pairs stay and follow.
static void test_rows_move(void **state)
{
    (void)state;
    plumb_world *world = make_world(6);
    plumb_body empty[10];
    for (int i = 0; i < 10; ++i) {
        empty[i] = add_body(world, PLUMB_DYNAMIC, 1, 1);
        add_random(world, 3, 0.3, 1);
        add_random(world, 3, 0.3, 1);
    }
    update(world);
    uint64_t rebuilds = world->broad.rebuilds;
    assert_true(world->broad.pairs.count > 10);
    for (int i = 0; i < 10; ++i) {
        assert_int_equal(plumb_body_destroy(world, empty[i]), PLUMB_OK);
        update(world);
        add_body(world, PLUMB_KINEMATIC, 1, 1);
        update(world);
    }
    assert_int_equal(world->broad.rebuilds, rebuilds);
    plumb_world_destroy(world);
}

// A piece is paired with what it will reach within the step, elastic or not, and with nothing
// beyond.
static void test_reach_of_a_step(void **state)
{
    (void)state;
    for (int elastic = 0; elastic < 4; ++elastic) {
        plumb_world *world = make_world(7);
        plumb_material rubber = plumb_material_create(
            world, &(plumb_material_desc){ .frictionless = true, .restitution = 1 });
        plumb_material none = PLUMB_NULL_INIT;
        for (int i = 0; i < 2; ++i) {
            plumb_body_desc wall = { .type = PLUMB_STATIC, .position = { R(-6 * i), 0 } };
            random_shape(world, plumb_body_create(world, &wall), PLUMB_CIRCLE, 1,
                         elastic & 1 ? rubber : none);
        }
        plumb_body ball = plumb_body_create(
            world, &(plumb_body_desc){ .position = { 4, 0 }, .velocity = { -300, 0 } });
        random_shape(world, ball, PLUMB_CIRCLE, 1, elastic & 2 ? rubber : none);
        update(world); // 5 m to go, 2 m to one wall, 8 m to the other
        assert_int_equal(world->broad.pairs.count, 1);
        plumb_world_destroy(world);
    }
}

//---- what a pair carries over --------------------------------------------------------------------

// Marks every pair by its pieces' serials, so that a carried value can be told from a fresh one.
static void mark(plumb_world *world)
{
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    for (uint32_t i = 0; i < world->broad.pairs.count; ++i) {
        pl_pair *p = &pairs[i];
        uint32_t a = world->pieces.serial[p->a], b = world->pieces.serial[p->b];
        p->feature[0] = a;
        p->feature[1] = b;
        p->normal[0] = (near_real)(a + 1);
        p->normal[1] = (near_real)(b + 1);
        p->tangent[0] = -(near_real)a;
        p->tangent[1] = -(near_real)b;
    }
}

static uint32_t check_marks(const plumb_world *world, uint32_t newest)
{
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    uint32_t carried = 0;
    for (uint32_t i = 0; i < world->broad.pairs.count; ++i) {
        const pl_pair *p = &pairs[i];
        uint32_t a = world->pieces.serial[p->a], b = world->pieces.serial[p->b];
        if (p->feature[0] == PL_NONE) {
            assert_int_equal(p->feature[1], PL_NONE);
            assert_true(p->normal[0] == 0 && p->normal[1] == 0);
            assert_true(p->tangent[0] == 0 && p->tangent[1] == 0);
            assert_int_equal(p->flags, 0);
            continue;
        }
        ++carried;
        assert_true(a <= newest && b <= newest); // slots reused do not inherit
        assert_int_equal(p->feature[0], a);
        assert_int_equal(p->feature[1], b);
        assert_true(p->normal[0] == (plumb_real)(a + 1) && p->normal[1] == (plumb_real)(b + 1));
        assert_true(p->tangent[0] == -(plumb_real)a && p->tangent[1] == -(plumb_real)b);
    }
    return carried;
}

static uint32_t common_pairs(const plumb_world *world, const uint64_t *keys, uint32_t count)
{
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    uint32_t common = 0;
    for (uint32_t i = 0; i < world->broad.pairs.count; ++i) {
        uint64_t key =
            (uint64_t)world->pieces.serial[pairs[i].a] << 32 | world->pieces.serial[pairs[i].b];
        for (uint32_t k = 0; k < count; ++k) {
            common += keys[k] == key;
        }
    }
    return common;
}

// Through teleports, destruction and slots that are taken again: exactly the pairs of the same two
// pieces, made before, that are in both lists carry over.
static void test_carry_over(void **state)
{
    (void)state;
    static uint64_t keys[20000];
    uint32_t carried = 0, lost = 0;
    for (uint32_t seed = 1; seed <= 10; ++seed) {
        plumb_world *world = make_world(seed + 300);
        plumb_body bodies[80];
        for (int i = 0; i < 80; ++i) {
            bodies[i] = add_random(world, 4, 0.2, 1);
        }
        update(world);
        for (int round = 0; round < 20; ++round) {
            mark(world);
            uint32_t count = world->broad.pairs.count;
            assert_true(count < 20000);
            for (uint32_t i = 0; i < count; ++i) {
                const pl_pair *p = &pl_pairs(&world->broad.pairs)[i];
                keys[i] = (uint64_t)world->pieces.serial[p->a] << 32 | world->pieces.serial[p->b];
            }
            uint32_t newest = world->serial;
            for (int i = 0; i < 8; ++i) {
                int chosen = (int)uniform(0, 79.999);
                if (i % 2 == 0) {
                    assert_int_equal(plumb_body_destroy(world, bodies[chosen]), PLUMB_OK);
                    bodies[chosen] = add_random(world, 4, 0.2, 1);
                } else {
                    plumb_body_teleport(world, bodies[chosen], place(4), 0);
                }
            }
            update(world);
            uint32_t kept = check_marks(world, newest);
            assert_int_equal(kept, common_pairs(world, keys, count));
            carried += kept;
            lost += count - kept;
        }
        plumb_world_destroy(world);
    }
    assert_true(carried > 1000 && lost > 1000);
}

// The same slots, kinds and places, but another body: nothing is inherited.
static void test_twins(void **state)
{
    (void)state;
    plumb_world *world = make_world(8);
    plumb_body ground = add_body(world, PLUMB_STATIC, 0, 0);
    random_shape(world, ground, PLUMB_BOX, 1, (plumb_material)PLUMB_NULL_INIT);
    plumb_body ball = add_body(world, PLUMB_DYNAMIC, 0, 0);
    random_shape(world, ball, PLUMB_CIRCLE, 1, (plumb_material)PLUMB_NULL_INIT);
    update(world);
    assert_int_equal(world->broad.pairs.count, 1);
    mark(world);
    uint32_t slot = pl_pairs(&world->broad.pairs)[0].a;
    assert_int_equal(plumb_body_destroy(world, ball), PLUMB_OK);
    ball = add_body(world, PLUMB_DYNAMIC, 0, 0);
    random_shape(world, ball, PLUMB_CIRCLE, 1, (plumb_material)PLUMB_NULL_INIT);
    update(world);
    assert_int_equal(world->broad.pairs.count, 1);
    assert_int_equal(pl_pairs(&world->broad.pairs)[0].a, slot);
    assert_int_equal(pl_pairs(&world->broad.pairs)[0].feature[0], PL_NONE);
    assert_true(pl_pairs(&world->broad.pairs)[0].normal[0] == 0);
    plumb_world_destroy(world);
}

// Nothing but the poses of now and the slots decides about the list, not how it came to be.
static void test_history_does_not_matter(void **state)
{
    (void)state;
    plumb_world *worlds[2];
    for (int w = 0; w < 2; ++w) {
        worlds[w] = make_world(9);
        plumb_body bodies[60];
        for (int i = 0; i < 60; ++i) {
            bodies[i] = add_random(worlds[w], 5, 0.2, 1);
        }
        for (int i = 0; w == 1 && i < 60; ++i) { // there and back, with updates in between
            plumb_transform t = plumb_body_transform(worlds[w], bodies[i]);
            plumb_body_teleport(worlds[w], bodies[i], plumb_v2(100, 100), 0);
            assert_true(pl_broad_update(worlds[w], DT, &pl_end_listener));
            uint32_t row = pl_body_row(worlds[w], bodies[i]);
            worlds[w]->bodies.x[row] = t.p.x;
            worlds[w]->bodies.y[row] = t.p.y;
            worlds[w]->bodies.c[row] = t.q.c;
            worlds[w]->bodies.s[row] = t.q.s;
            pl_body_update_center(worlds[w], row);
            worlds[w]->static_dirty = true;
            uint32_t p = worlds[w]->bodies.first_piece[row];
            for (; p != PL_NONE; p = worlds[w]->pieces.next_in_body[p]) {
                pl_piece_lose_box(worlds[w], p);
            }
        }
        update(worlds[w]);
    }
    uint32_t count = worlds[0]->broad.pairs.count;
    assert_true(count > 50);
    assert_int_equal(worlds[1]->broad.pairs.count, count);
    for (uint32_t i = 0; i < count; ++i) {
        assert_int_equal(key_of(&pl_pairs(&worlds[0]->broad.pairs)[i]),
                         key_of(&pl_pairs(&worlds[1]->broad.pairs)[i]));
    }
    plumb_world_destroy(worlds[0]);
    plumb_world_destroy(worlds[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_worlds),
        cmocka_unit_test(test_mixed_sizes),
        cmocka_unit_test(test_far_away),
        cmocka_unit_test(test_pile_up),
        cmocka_unit_test(test_nothing_dynamic),
        cmocka_unit_test(test_moving),
        cmocka_unit_test(test_stepped),
        cmocka_unit_test(test_structural_changes),
        cmocka_unit_test(test_rows_move),
        cmocka_unit_test(test_reach_of_a_step),
        cmocka_unit_test(test_carry_over),
        cmocka_unit_test(test_twins),
        cmocka_unit_test(test_history_does_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
