// test_elimination.c - the order of elimination, against elimination by definition: of random graphs, of trees, of several beside
// one another.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "core/elimination.h"
#include "harness/random.h"

enum { MOST = 60 };

typedef struct fixture {
    pl_memory memory;
    pl_elimination e;
} fixture;

static int open_memory(void **state)
{
    static fixture f;
    f = (fixture){ .e = { .count = 0 } };
    pl_memory_init(&f.memory, NULL);
    *state = &f;
    return 0;
}

static int close_memory(void **state)
{
    fixture *f = *state;
    pl_elimination_free(&f->memory, &f->e);
    assert_int_equal(f->memory.bytes, 0);
    return 0;
}

typedef struct graph {
    uint32_t count;
    bool near[MOST][MOST];
} graph;

static void join(graph *g, uint32_t a, uint32_t b)
{
    if (a != b) {
        g->near[a][b] = g->near[b][a] = true;
    }
}

// Pairs in both directions, some of them twice.
static void run_in_parts(const graph *g, fixture *f, uint32_t most, uint32_t whole)
{
    pl_elimination *e = &f->e;
    assert_true(pl_elimination_open(&f->memory, e, g->count, 3 * MOST * MOST / 2));
    for (uint32_t a = 0; a < g->count; ++a) {
        for (uint32_t b = 0; b < g->count; ++b) {
            if (g->near[a][b] && (a < b || (a + b) % 3 == 0)) {
                uint32_t *pair = e->pairs + 2 * (size_t)e->pair_count++;
                pair[0] = a, pair[1] = b;
            }
        }
    }
    e->whole = whole;
    assert_true(pl_elimination_run(&f->memory, e, most));
}

static void run(const graph *g, fixture *f, uint32_t most)
{
    run_in_parts(g, f, most, UINT32_MAX);
}

// Each vertex once; each component by itself, in order of lowest vertices.
static void assert_order(const graph *g, const pl_elimination *e)
{
    bool seen[MOST] = { false };
    for (uint32_t i = 0; i < g->count; ++i) {
        const uint32_t v = e->order[i];
        assert_true(v < g->count && !seen[v] && e->rank[v] == i);
        seen[v] = true;
        const uint32_t c = e->component[v];
        assert_true(c < e->component_count && i >= e->start[c] && i < e->start[c + 1]);
        for (uint32_t u = 0; u < g->count; ++u) {
            assert_true(!g->near[v][u] || e->component[u] == c);
        }
    }
    assert_int_equal(e->start[e->component_count], g->count);
}

// What a vertex leaves as neighbours of one another is what its column has. Returns how many entries there are.
static uint32_t assert_fill(const graph *g, const pl_elimination *e)
{
    graph left = *g;
    uint32_t entries = 0;
    for (uint32_t i = 0; i < g->count; ++i) {
        const uint32_t v = e->order[i];
        const uint32_t *column = (const uint32_t *)e->entries.data + e->column[i];
        uint32_t degree = 0;
        for (uint32_t u = 0; u < g->count; ++u) {
            degree += left.near[v][u];
        }
        assert_int_equal(degree, e->fill[i]);
        for (uint32_t k = 0; k < degree; ++k) {
            assert_true(left.near[v][column[k]]);
            left.near[v][column[k]] = left.near[column[k]][v] = false;
            for (uint32_t l = 0; l < k; ++l) {
                join(&left, column[k], column[l]);
            }
        }
        entries += degree;
    }
    assert_int_equal(entries, e->entry_count);
    return entries;
}

// Of all that are left of its component none has less neighbours than the one that goes.
static void assert_least(const graph *g, const pl_elimination *e)
{
    graph left = *g;
    for (uint32_t i = 0; i < g->count; ++i) {
        const uint32_t v = e->order[i];
        for (uint32_t j = i; j < e->start[e->component[v] + 1]; ++j) {
            uint32_t degree = 0;
            for (uint32_t u = 0; u < g->count; ++u) {
                degree += left.near[e->order[j]][u];
            }
            assert_true(degree >= e->fill[i]);
        }
        for (uint32_t u = 0; u < g->count; ++u) {
            for (uint32_t w = 0; w < u && left.near[v][u]; ++w) {
                if (left.near[v][w]) {
                    join(&left, u, w);
                }
            }
        }
        for (uint32_t u = 0; u < g->count; ++u) {
            left.near[v][u] = left.near[u][v] = false;
        }
    }
}

static void random_graphs(void **state)
{
    fixture *f = *state;
    uint32_t seed = 7;
    for (int n = 0; n < 400; ++n) {
        graph g = { .count = sim_random(&seed) % MOST };
        const uint32_t pairs = g.count > 0 ? sim_random(&seed) % (3 * g.count) : 0;
        for (uint32_t i = 0; i < pairs; ++i) {
            join(&g, sim_random(&seed) % g.count, sim_random(&seed) % g.count);
        }
        run(&g, f, UINT32_MAX);
        assert_order(&g, &f->e);
        assert_fill(&g, &f->e);
        assert_least(&g, &f->e);
    }
}

// Cut in parts or not, what is told of an order is true.
static void random_graphs_in_parts(void **state)
{
    fixture *f = *state;
    uint32_t seed = 13;
    for (uint32_t n = 0; n < 400; ++n) {
        graph g = { .count = MOST - sim_random(&seed) % 12 };
        for (uint32_t v = 1; v < g.count; ++v) { // a strip, or two, and some pairs at random
            const uint32_t across = 3 + n % 5;
            join(&g, v, v % across > 0 && v != 45 ? v - 1 : v);
            join(&g, v, v >= across && (v < 45 || v >= 45 + across) ? v - across : v);
        }
        for (uint32_t i = 0; i < n % 8; ++i) {
            join(&g, sim_random(&seed) % g.count, sim_random(&seed) % g.count);
        }
        run_in_parts(&g, f, UINT32_MAX, n % 20);
        assert_order(&g, &f->e);
        assert_fill(&g, &f->e);
    }
}

// Products of a cloth of so many nodes a side.
static double products_of_cloth(fixture *f, uint32_t side, uint32_t whole)
{
    pl_elimination *e = &f->e;
    assert_true(pl_elimination_open(&f->memory, e, side * side, 4 * side * side));
    for (uint32_t v = 0; v < side * side; ++v) {
        const bool right = v % side + 1 < side, up = v + side < side * side;
        const uint32_t pairs[4][2] = {
            { v, v + 1 }, { v, v + side }, { v, v + side + 1 }, { v + 1, v + side }
        };
        const bool there[4] = { right, up, right && up, right && up };
        for (int k = 0; k < 4; ++k) {
            if (there[k]) {
                memcpy(e->pairs + 2 * (size_t)e->pair_count++, pairs[k], sizeof pairs[k]);
            }
        }
    }
    e->whole = whole;
    assert_true(pl_elimination_run(&f->memory, e, UINT32_MAX));
    double products = 0;
    for (uint32_t i = 0; i < e->count; ++i) {
        products += (double)e->fill[i] * (e->fill[i] + 1) / 2;
    }
    return products;
}

// Cut in parts, a cloth takes a third less where it has 1,000 nodes, and what lines through its middle would take (217,703).
static void parts_are_cheaper(void **state)
{
    fixture *f = *state;
    const double by_degree = products_of_cloth(f, 32, UINT32_MAX);
    const double in_parts = products_of_cloth(f, 32, 100);
    assert_true(in_parts < 0.75 * by_degree && in_parts < 240000);
}

// A forest fills in nothing, however many neighbours one of a tree has.
static void trees_fill_in_nothing(void **state)
{
    fixture *f = *state;
    uint32_t seed = 11;
    for (uint32_t n = 0; n < 100; ++n) {
        graph g = { .count = MOST };
        uint32_t trees = 0;
        for (uint32_t v = 0; v < MOST; ++v) {
            const bool root = v == 0 || sim_random(&seed) % 10 == 0;
            trees += root;
            if (!root) {
                join(&g, v, n % 2 == 0 ? sim_random(&seed) % v : v - 1);
            }
        }
        run(&g, f, UINT32_MAX);
        assert_int_equal(assert_fill(&g, &f->e), MOST - trees);
        assert_int_equal(f->e.component_count, trees);
    }
}

// A rope with a crate on every fourth node, as a crate touches three: it fills in a few entries a crate, not their square.
static void what_hangs_on_a_rope_fills_in_little(void **state)
{
    fixture *f = *state;
    graph g = { .count = 60 };
    for (uint32_t v = 1; v < 48; ++v) {
        join(&g, v - 1, v);
    }
    for (uint32_t crate = 48; crate < 60; ++crate) {
        for (uint32_t k = 0; k < 3; ++k) {
            join(&g, crate, 4 * (crate - 48) + k);
        }
    }
    run(&g, f, UINT32_MAX);
    assert_true(assert_fill(&g, &f->e) <= 47 + 36 + 12);
}

// One that is too dense has no entries; those beside it are as they are alone.
static void what_is_dense_is_left_alone(void **state)
{
    fixture *f = *state;
    graph g = { .count = 30 };
    for (uint32_t v = 0; v < 30; ++v) {
        for (uint32_t u = 0; u < v; ++u) {
            if ((v < 10 && u == v - 1) || (v >= 10 && v < 20 && u >= 10) ||
                (v > 20 && u == v - 1)) {
                join(&g, u, v);
            }
        }
    }
    run(&g, f, 20);
    assert_order(&g, &f->e);
    assert_int_equal(f->e.component_count, 3);
    for (uint32_t i = 0; i < 30; ++i) {
        const bool dense = i >= 10 && i < 20;
        assert_int_equal(f->e.fill[i], dense || i == 9 || i == 29 ? 0 : 1);
    }
    assert_int_equal(f->e.entry_count, 18);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(random_graphs, open_memory, close_memory),
        cmocka_unit_test_setup_teardown(random_graphs_in_parts, open_memory, close_memory),
        cmocka_unit_test_setup_teardown(parts_are_cheaper, open_memory, close_memory),
        cmocka_unit_test_setup_teardown(trees_fill_in_nothing, open_memory, close_memory),
        cmocka_unit_test_setup_teardown(what_hangs_on_a_rope_fills_in_little, open_memory,
                                        close_memory),
        cmocka_unit_test_setup_teardown(what_is_dense_is_left_alone, open_memory, close_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
