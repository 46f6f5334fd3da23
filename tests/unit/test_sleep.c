// test_sleep.c - islands against brute force on random graphs; the books of sleeping (rows, lists,
// islands, contacts, grid) under random changes; and that no pass visits what sleeps.
#include "world/island.h"
#include "sleep/sleep.h"
#include "harness/random.h"
#include "plumb/plumb.h"
#include "world/rows.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#define R(x) ((plumb_real)(x))

static const plumb_real dt = R(1.0 / 60);

static uint32_t choose(uint32_t *seed, uint32_t below)
{
    return sim_random(seed) % below;
}

static plumb_body disc_at(plumb_world *w, plumb_body_type type, double x, double y)
{
    plumb_body body =
        plumb_body_create(w, &(plumb_body_desc){ .type = type, .position = { R(x), R(y) } });
    plumb_shape shape =
        plumb_shape_create(w, body, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.5) });
    assert_false(plumb_is_null(shape));
    return body;
}

static void steps(plumb_world *w, int count)
{
    for (int i = 0; i < count; ++i) {
        assert_int_equal(plumb_world_step(w, dt), PLUMB_OK);
    }
}

//---- books ---------------------------------------------------------------------------------------

static void check_bodies_of(const plumb_world *w, uint32_t island, uint32_t *bodies)
{
    const pl_island *i = &pl_islands(&w->sleep)[island];
    uint32_t count = 0, before = PL_NONE;
    for (uint32_t slot = i->first_body; slot != PL_NONE;) {
        uint32_t row = w->registry.slots[slot].row;
        assert_int_equal(w->registry.slots[slot].kind, PLUMB_KIND_BODY);
        assert_true(pl_row_is_asleep(w, row));
        assert_int_equal(w->bodies.island[row], island);
        assert_int_equal(w->bodies.previous_asleep[row], before);
        before = slot;
        slot = w->bodies.next_asleep[row];
        ++count;
    }
    assert_int_equal(i->last_body, before);
    assert_int_equal(count, i->body_count);
    *bodies += count;
}

static void check_contacts_of(const plumb_world *w, uint32_t island, uint32_t *contacts)
{
    const pl_island *i = &pl_islands(&w->sleep)[island];
    const pl_sleeping_contact *all = pl_sleeping_contacts(&w->sleep);
    uint32_t count = 0, touching = 0;
    for (uint32_t c = i->first_contact; c != PL_NONE; c = all[c].next) {
        assert_int_equal(all[c].island, island);
        assert_true(all[c].whole || all[c].recalled || (all[c].pair.flags & PL_PAIR_TOUCHING) != 0);
        touching += all[c].whole && (all[c].manifold.point[0].separation <= 0 ||
                                     all[c].manifold.point[1].separation <= 0);
        if (all[c].fixed != PL_NONE) { // it is in the list of that piece
            uint32_t at = w->pieces.first_sleeping[all[c].fixed];
            while (at != c) {
                assert_int_not_equal(at, PL_NONE);
                at = all[at].fixed_next;
            }
        } else if (pl_sleeping_contact_is_intact(w, &all[c])) { // both ends are in the island
            assert_int_equal(w->bodies.island[w->pieces.body[all[c].pair.a]], island);
            assert_int_equal(w->bodies.island[w->pieces.body[all[c].pair.b]], island);
        }
        ++count;
    }
    assert_int_equal(count, i->contact_count);
    assert_int_equal(touching, i->overlaps.touching_count);
    *contacts += count;
}

static void check_rows(const plumb_world *w)
{
    const pl_bodies *b = &w->bodies;
    uint32_t first = pl_partition_first(w, PL_PART_ASLEEP);
    uint32_t after = pl_partition_first(w, PL_PART_STATIC);
    for (uint32_t row = 0; row < b->table.count; ++row) {
        bool asleep = row >= first && row < after;
        assert_int_equal(w->registry.slots[b->entity[row].entity.index].row, row);
        assert_int_equal(b->island[row] != PL_NONE, asleep);
        plumb_body_type type = row < w->dynamic_count || asleep ? PLUMB_DYNAMIC
                               : row < first                    ? PLUMB_KINEMATIC
                                                                : PLUMB_STATIC;
        assert_int_equal(b->type[row], type);
        for (uint32_t p = b->first_piece[row]; p != PL_NONE; p = w->pieces.next_in_body[p]) {
            const uint32_t *list = asleep ? pl_resting(&w->sleep) : pl_moving(w);
            assert_int_equal(w->pieces.body[p], row);
            assert_int_equal((w->pieces.flags[p] & PL_PIECE_ASLEEP) != 0, asleep);
            assert_int_equal(w->pieces.moving[p] == PL_NONE, type == PLUMB_STATIC);
            assert_true(type == PLUMB_STATIC || list[w->pieces.moving[p]] == p);
            assert_true(type != PLUMB_DYNAMIC || w->pieces.first_sleeping[p] == PL_NONE);
        }
    }
}

static void check_free(const plumb_world *w)
{
    const pl_sleep *s = &w->sleep;
    uint32_t count = 0, slot = s->free_island;
    for (; count < s->island_slots - s->island_count; ++count) {
        assert_false(pl_island_is_open(&pl_islands(s)[slot]));
        slot = pl_islands(s)[slot].first_body;
    }
    for (count = 0, slot = s->free_contact; count < s->contact_slots - s->contact_count; ++count) {
        slot = pl_sleeping_contacts(s)[slot].next;
    }
}

static void check_books(const plumb_world *w)
{
    const pl_sleep *s = &w->sleep;
    uint32_t bodies = 0, contacts = 0, islands = 0, due = 0;
    check_rows(w);
    for (uint32_t i = 0; i < s->island_slots; ++i) {
        if (pl_island_is_open(&pl_islands(s)[i])) {
            check_bodies_of(w, i, &bodies);
            check_contacts_of(w, i, &contacts);
            assert_false(pl_islands(s)[i].marked);
            due += pl_islands(s)[i].due;
            ++islands;
        }
    }
    assert_int_equal(bodies, w->asleep_count);
    assert_int_equal(contacts, s->contact_count);
    assert_int_equal(islands, s->island_count);
    for (uint32_t i = s->first_due; i != PL_NONE; i = pl_islands(s)[i].next_due) {
        assert_true(pl_islands(s)[i].due);
        --due;
    }
    assert_int_equal(due, 0);
    check_free(w);
}

// After a step: nothing that sleeps is in the pair list, and nothing awake is close to it.
static void check_apart(plumb_world *w)
{
    const pl_pair *pairs = pl_pairs(&w->broad.pairs);
    for (uint32_t i = 0; i < w->broad.pairs.count; ++i) {
        assert_false(pl_row_is_asleep(w, pairs[i].body_a) || pl_row_is_asleep(w, pairs[i].body_b));
    }
    for (uint32_t i = 0; i < w->joints.count; ++i) {
        const pl_joint *j = &pl_joint_items(&w->joints)[i];
        if (!plumb_is_null(j->entity) && !plumb_is_null(j->a.body) && !plumb_is_null(j->b.body)) {
            uint32_t a = pl_body_row(w, j->a.body), b = pl_body_row(w, j->b.body);
            bool dynamic = w->bodies.type[a] == PLUMB_DYNAMIC && w->bodies.type[b] == PLUMB_DYNAMIC;
            assert_true(!dynamic || pl_row_is_asleep(w, a) == pl_row_is_asleep(w, b));
        }
    }
}

//---- random graphs -------------------------------------------------------------------------------

#define SIDE  9
#define NODES (SIDE * SIDE)

typedef struct graph {
    plumb_body bodies[NODES]; // null: nobody
    bool held[NODES];         // it keeps its island awake
    bool kinematic[NODES];
    bool joined[NODES][NODES];
    int label[NODES];
} graph;

static bool adjacent(int a, int b)
{
    int dx = a % SIDE - b % SIDE, dy = a / SIDE - b / SIDE;
    return dx * dx + dy * dy == 1;
}

// Depth first.
static void spread(graph *g, int node, int label)
{
    g->label[node] = label;
    for (int other = 0; other < NODES; ++other) {
        bool linked = adjacent(node, other) || g->joined[node][other];
        if (!plumb_is_null(g->bodies[other]) && linked && !g->kinematic[other] &&
            g->label[other] < 0) {
            spread(g, other, label);
        }
    }
}

// Discs on a lattice, 1 cm apart: neighbours are linked, and no force acts.
static void fill_graph(plumb_world *w, graph *g, uint32_t *seed)
{
    for (int i = 0; i < NODES; ++i) {
        uint32_t kind = choose(seed, 20);
        if (kind >= 11) {
            continue;
        }
        g->kinematic[i] = kind < 2;
        g->bodies[i] = disc_at(w, g->kinematic[i] ? PLUMB_KINEMATIC : PLUMB_DYNAMIC,
                               i % SIDE * 1.01, i / SIDE * 1.01);
        g->held[i] = kind == 0 || kind == 10;
        if (kind == 0) {
            plumb_body_set_angular_velocity(w, g->bodies[i], R(0.1));
        } else if (kind == 10) {
            plumb_body_set_no_sleep(w, g->bodies[i], true);
        }
    }
    for (int k = 0; k < 6; ++k) {
        int a = (int)choose(seed, NODES), b = (int)choose(seed, NODES);
        if (a == b || plumb_is_null(g->bodies[a]) || plumb_is_null(g->bodies[b]) ||
            g->kinematic[a] || g->kinematic[b]) {
            continue;
        }
        g->joined[a][b] = g->joined[b][a] = true;
        assert_false(
            plumb_is_null(plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_WELD,
                                                                     .body_a = g->bodies[a],
                                                                     .body_b = g->bodies[b],
                                                                     .collide_connected = true })));
    }
}

static void compare_graph(const plumb_world *w, graph *g, int *asleep, int *awake)
{
    bool held[NODES] = { false };
    for (int i = 0; i < NODES; ++i) {
        if (!plumb_is_null(g->bodies[i]) && !g->kinematic[i] && g->label[i] < 0) {
            spread(g, i, i);
        }
    }
    for (int i = 0; i < NODES; ++i) {
        if (plumb_is_null(g->bodies[i]) || !g->held[i]) {
            continue;
        }
        for (int k = 0; k < NODES; ++k) {
            if (g->label[k] >= 0 && (k == i || (g->kinematic[i] && adjacent(i, k)))) {
                held[g->label[k]] = true;
            }
        }
    }
    uint32_t island[NODES];
    memset(island, 0xff, sizeof island);
    for (int i = 0; i < NODES; ++i) {
        if (g->label[i] < 0) {
            continue;
        }
        uint32_t row = pl_body_row(w, g->bodies[i]);
        assert_int_equal(w->bodies.island[row] != PL_NONE, !held[g->label[i]]);
        *(held[g->label[i]] ? awake : asleep) += 1;
        if (island[g->label[i]] == PL_NONE) {
            island[g->label[i]] = w->bodies.island[row];
        }
        assert_int_equal(w->bodies.island[row], island[g->label[i]]);
    }
    for (int i = 0; i < NODES; ++i) {
        for (int k = 0; k < i; ++k) {
            assert_true(island[i] == PL_NONE || island[i] != island[k]);
        }
    }
}

static void islands_are_those_of_brute_force(void **state)
{
    (void)state;
    uint32_t seed = 77;
    int asleep = 0, awake = 0;
    for (int round = 0; round < 60; ++round) {
        static graph g;
        plumb_world *w;
        memset(&g, 0, sizeof g);
        memset(g.label, 0xff, sizeof g.label);
        const plumb_world_desc desc = { .zero_gravity = true, .sleep_time = R(0.1) };
        assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
        fill_graph(w, &g, &seed);
        steps(w, 12);
        compare_graph(w, &g, &asleep, &awake);
        check_books(w);
        check_apart(w);
        plumb_world_destroy(w);
    }
    print_message("%d asleep, %d awake\n", asleep, awake);
    assert_true(asleep > 300 && awake > 300);
}

//---- random changes ------------------------------------------------------------------------------

#define MOST 48

typedef struct crowd {
    plumb_world *w;
    uint32_t seed;
    int count;
    plumb_body bodies[MOST];
    plumb_joint joint;
} crowd;

static void add_one(crowd *c)
{
    if (c->count == MOST) {
        return;
    }
    uint32_t kind = choose(&c->seed, 12);
    plumb_body_type type = kind == 0 ? PLUMB_STATIC : kind == 1 ? PLUMB_KINEMATIC : PLUMB_DYNAMIC;
    const plumb_body_desc desc = { .type = type,
                                   .position = { R(choose(&c->seed, 80) * 0.1 - 4),
                                                 R(0.5 + choose(&c->seed, 60) * 0.1) },
                                   .asleep = kind > 8 };
    static const plumb_vec2 ell[] = { { 0, 0 },           { 1, 0 },      { 1, R(0.5) },
                                      { R(0.5), R(0.5) }, { R(0.5), 1 }, { 0, 1 } };
    const plumb_shape_desc shapes[] = {
        { .kind = PLUMB_CIRCLE, .radius = R(0.3) },
        { .kind = PLUMB_BOX, .half = { R(0.3), R(0.3) } },
        { .kind = PLUMB_OUTLINE, .points = ell, .count = 6 },
        { .kind = PLUMB_CIRCLE, .radius = R(0.6), .sensor = true }
    };
    c->bodies[c->count] = plumb_body_create(c->w, &desc);
    plumb_shape_create(c->w, c->bodies[c->count], &shapes[choose(&c->seed, 4)]);
    if (kind == 1) {
        plumb_body_set_velocity(c->w, c->bodies[c->count], plumb_v2(R(0.2), 0));
    }
    ++c->count;
}

static void join_two(crowd *c, plumb_body body)
{
    plumb_body other = c->bodies[choose(&c->seed, (uint32_t)c->count)];
    if (plumb_joint_valid(c->w, c->joint)) {
        plumb_joint_destroy(c->w, c->joint);
    } else if (!plumb_same(body, other)) {
        c->joint = plumb_joint_create(
            c->w, &(plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                       .body_a = body,
                                       .body_b = other,
                                       .anchor = plumb_body_position(c->w, body),
                                       .anchor_b = plumb_vec2_add(plumb_body_position(c->w, other),
                                                                  plumb_v2(0, R(0.01))) });
    }
}

static void change_one(crowd *c)
{
    plumb_world *w = c->w;
    int i = (int)choose(&c->seed, (uint32_t)c->count);
    plumb_body body = c->bodies[i];
    plumb_shape shape;
    switch (choose(&c->seed, 11)) {
    case 0:
        plumb_body_destroy(w, body);
        c->bodies[i] = c->bodies[--c->count];
        break;
    case 1:
        plumb_body_wake(w, body);
        break;
    case 2:
    case 3:
        plumb_body_sleep(w, body);
        break;
    case 4:
        plumb_body_teleport(w, body, plumb_v2(R(choose(&c->seed, 80) * 0.1 - 4), 3), 0);
        break;
    case 5:
        plumb_body_apply_impulse_center(w, body, plumb_v2(0, 1));
        break;
    case 6:
        join_two(c, body);
        break;
    case 7:
        if (plumb_body_shapes(w, body, &shape, 1) > 0) {
            plumb_shape_destroy(w, shape);
        }
        break;
    case 8:
        if (plumb_body_shapes(w, body, &shape, 1) > 0) {
            plumb_shape_set_filter(w, shape, (plumb_filter){ .mask = 1 + choose(&c->seed, 2) });
        }
        break;
    case 9:
        plumb_world_ray(w, plumb_v2(-9, 1), plumb_v2(9, 1), NULL,
                        &(plumb_ray_hit){ .fraction = 0 });
        break;
    default:
        plumb_body_set_no_sleep(w, body, choose(&c->seed, 3) == 0);
        break;
    }
}

static void books_are_kept_under_random_changes(void **state)
{
    (void)state;
    static crowd c;
    uint32_t slept = 0, woken = 0;
    c = (crowd){ .seed = 5 };
    const plumb_world_desc desc = { .sleep_time = R(0.1), .hit_speed = R(0.5) };
    assert_int_equal(plumb_world_create(&desc, &c.w), PLUMB_OK);
    plumb_body ground =
        plumb_body_create(c.w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { 0, -1 } });
    plumb_shape_create(c.w, ground, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 20, 1 } });
    for (int round = 0; round < 8000; ++round) {
        if (c.count < 4 || choose(&c.seed, 12) == 0) {
            add_one(&c);
        } else if (choose(&c.seed, 6) == 0) {
            change_one(&c);
        }
        check_books(c.w);
        int fell, woke;
        steps(c.w, 1);
        plumb_world_sleep_events(c.w, &fell);
        plumb_world_wake_events(c.w, &woke);
        slept += (uint32_t)fell;
        woken += (uint32_t)woke;
        check_books(c.w);
        check_apart(c.w);
    }
    print_message("%u fell asleep, %u woke\n", slept, woken);
    assert_true(slept > 200 && woken > 200);
    while (c.count > 0) {
        plumb_body_destroy(c.w, c.bodies[--c.count]);
        check_books(c.w);
    }
    steps(c.w, 2);
    assert_int_equal(c.w->sleep.island_count, 0);
    assert_int_equal(c.w->sleep.contact_count, 0);
    assert_int_equal(c.w->sleep.resting_count, 0);
    plumb_world_destroy(c.w);
}

//---- what sleeps costs nothing -------------------------------------------------------------------

static plumb_world *pile(int count)
{
    plumb_world *w;
    assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
    plumb_body ground =
        plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { 0, -1 } });
    plumb_shape_create(w, ground, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 1000, 1 } });
    for (int i = 0; i < count; ++i) {
        plumb_body box = plumb_body_create(
            w, &(plumb_body_desc){ .position = { R(i / 3 * 2), R(i % 3 + 0.5) } });
        plumb_shape_create(w, box,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } });
    }
    return w;
}

static bool is_scheduled(const plumb_world *w, const char *name)
{
    plumb_pass_info rows[PL_PASS_MAX];
    int count = plumb_world_schedule(w, rows, PL_PASS_MAX);
    for (int i = 0; i < count; ++i) {
        if (strcmp(rows[i].name, name) == 0) {
            return rows[i].scheduled;
        }
    }
    fail_msg("no pass is called %s", name);
    return false;
}

static void no_pass_visits_what_sleeps(void **state)
{
    (void)state;
    plumb_world *w = pile(300);
    plumb_body bodies[2] = { w->bodies.entity[0], w->bodies.entity[3] };
    plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                               .body_a = bodies[0],
                                               .body_b = bodies[1],
                                               .anchor = plumb_body_position(w, bodies[0]),
                                               .anchor_b = plumb_body_position(w, bodies[1]) });
    steps(w, 120);
    assert_int_equal(w->asleep_count, 300);
    assert_int_equal(w->sleep.island_count, 99); // two stacks of 100 are joined
    static const char *const left_out[] = { "broad phase", "narrow phase", "sleep",
                                            "graph",       "soft step",    "joints",
                                            "reactions",   "events",       "sensor pairs" };
    for (size_t i = 0; i < sizeof left_out / sizeof left_out[0]; ++i) {
        assert_false(is_scheduled(w, left_out[i]));
    }
    assert_true(is_scheduled(w, "waking"));
    assert_int_equal(w->moving_count, 0);
    assert_int_equal(w->broad.pairs.count, 0);
    assert_int_equal(w->sleep.near.count, 0);

    // One that moves far away: the lists have what is awake, and no more.
    plumb_body ball = disc_at(w, PLUMB_DYNAMIC, -100, 0.5);
    plumb_body_set_velocity(w, ball, plumb_v2(-5, 0));
    steps(w, 30);
    assert_int_equal(w->asleep_count, 300);
    assert_int_equal(w->moving_count, 1);
    assert_int_equal(w->broad.pairs.count, 1);
    assert_int_equal(w->broad.moving.entry_count, 1);
    assert_int_equal(w->sleep.near.count, 0);
    assert_int_equal(w->solver.slot_count, 2);
    assert_int_equal(w->joints.awake_count, 0);
    assert_false(is_scheduled(w, "reactions"));
    plumb_world_destroy(w);
}

// Waking one after another files the grid of the others anew only when half of it has gone.
static void the_grid_is_filed_rarely_while_bodies_wake(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .zero_gravity = true }, &w), PLUMB_OK);
    plumb_body bodies[200];
    for (int i = 0; i < 200; ++i) {
        bodies[i] =
            plumb_body_create(w, &(plumb_body_desc){ .position = { R(i * 2), 0 }, .asleep = true });
        plumb_shape_create(w, bodies[i],
                           &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.5) });
    }
    int filed = 0;
    uint32_t entries = 0;
    for (int i = 0; i < 200; ++i) {
        plumb_body_set_velocity(w, bodies[i], plumb_v2(0, 1));
        steps(w, 1);
        assert_int_equal(w->asleep_count, 199 - i);
        filed += w->broad.resting.entry_count != entries;
        entries = w->broad.resting.entry_count;
        check_books(w);
    }
    assert_in_range(filed, 3, 9); // about log2(200)
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(islands_are_those_of_brute_force),
        cmocka_unit_test(books_are_kept_under_random_changes),
        cmocka_unit_test(no_pass_visits_what_sleeps),
        cmocka_unit_test(the_grid_is_filed_rarely_while_bodies_wake),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
