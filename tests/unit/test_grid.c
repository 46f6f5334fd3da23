// test_grid.c - the grid against brute force: every box that overlaps is visited, and once,
// whatever the sizes, places and numbers of the boxes; the same along a segment.

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/heap.h"
#include "harness/random.h"
#include "broad/grid.h"
#include "query/walk.h"

#define MOST 3000

static uint32_t random_state;

static double uniform(double low, double high)
{
    return sim_uniform(&random_state, low, high);
}

// Sizes and distances of many orders of magnitude.
static double spread(double low, double high)
{
    return exp(uniform(log(low), log(high)));
}

typedef struct boxes {
    pl_memory memory;
    pl_grid grid;
    pl_box fat[MOST];
    uint32_t pieces[MOST];
    uint8_t visits[MOST];
    uint32_t count;
    uint32_t stop_after; // visits; 0: never
} boxes;

static boxes *setup(uint32_t seed)
{
    boxes *b = calloc(1, sizeof *b);
    assert_non_null(b);
    pl_memory_init(&b->memory, NULL);
    random_state = seed;
    return b;
}

static void teardown(boxes *b)
{
    pl_grid_free(&b->memory, &b->grid);
    assert_int_equal(b->memory.bytes, 0);
    free(b);
}

static void add_box(boxes *b, double x, double y, double w, double h)
{
    b->fat[b->count] =
        (pl_box){ (plumb_real)x, (plumb_real)y, (plumb_real)(x + w), (plumb_real)(y + h) };
    b->pieces[b->count] = b->count;
    ++b->count;
}

static void build(boxes *b)
{
    assert_true(pl_grid_build(&b->memory, NULL, &b->grid, b->pieces, b->count, b->fat));
    assert_int_equal(b->grid.entry_count, b->count);
    assert_false(b->grid.mapped);
    assert_true(pl_grid_make_maps(&b->memory, &b->grid));
}

static bool count_visit(void *context, const pl_grid_entry *entry)
{
    boxes *b = context;
    ++b->visits[entry->piece];
    assert_memory_equal(&entry->box, &b->fat[entry->piece], sizeof entry->box);
    return b->stop_after == 0 || --b->stop_after > 0;
}

// With maps, where there are enough boxes for some, and without.
static void check_query(boxes *b, pl_box box)
{
    for (int mapped = 0; mapped < (b->grid.maps.data == NULL ? 1 : 2); ++mapped) {
        b->grid.mapped = mapped == 1;
        memset(b->visits, 0, sizeof b->visits);
        assert_true(pl_grid_query(&b->grid, box, count_visit, b));
        for (uint32_t i = 0; i < b->count; ++i) {
            if (b->visits[b->pieces[i]] != pl_boxes_overlap(&b->fat[b->pieces[i]], &box)) {
                fail_msg("box %u of %u: visited %d times", i, b->count, b->visits[b->pieces[i]]);
            }
        }
    }
}

// The segment crosses the box, tested by cutting it at the box's sides (Liang and Barsky 1984). 1:
// it does; -1: it does not; 0: too close to tell.
static int crosses(const pl_walk *w, const pl_box *box)
{
    for (int round = 0; round < 2; ++round) {
        double margin = round == 0 ? -w->slack : 2 * w->slack; // surely in, surely out
        double enter = 0, leave = w->limit;
        const double o[2] = { w->ox, w->oy }, d[2] = { w->dx, w->dy };
        const double low[2] = { (double)box->min_x - margin, (double)box->min_y - margin };
        const double high[2] = { (double)box->max_x + margin, (double)box->max_y + margin };
        bool in = true;
        for (int k = 0; k < 2; ++k) {
            if (d[k] == 0) {
                in = in && o[k] >= low[k] && o[k] <= high[k];
                continue;
            }
            enter = fmax(enter, fmin((low[k] - o[k]) / d[k], (high[k] - o[k]) / d[k]));
            leave = fmin(leave, fmax((low[k] - o[k]) / d[k], (high[k] - o[k]) / d[k]));
        }
        in = in && enter <= leave;
        if (in == (round == 0)) {
            return in ? 1 : -1;
        }
    }
    return 0;
}

static void check_walk(boxes *b, plumb_vec2 from, plumb_vec2 to, double limit)
{
    pl_walk walk = pl_walk_make(from, to);
    walk.limit = limit;
    memset(b->visits, 0, sizeof b->visits);
    assert_true(pl_walk_grid(&b->grid, &walk, count_visit, b));
    for (uint32_t i = 0; i < b->count; ++i) {
        int visits = b->visits[b->pieces[i]];
        int expected = crosses(&walk, &b->fat[b->pieces[i]]);
        if (visits > 1 || (expected == 1 && visits == 0) || (expected == -1 && visits == 1)) {
            fail_msg("box %u of %u: visited %d times, crosses %d; (%.9g %.9g) to (%.9g %.9g)", i,
                     b->count, visits, expected, (double)from.x, (double)from.y, (double)to.x,
                     (double)to.y);
        }
    }
}

// Boxes that are asked about: small and large ones near others, points, everything.
static void check_queries(boxes *b, int count, double reach)
{
    for (int i = 0; i < count; ++i) {
        double size = spread(1e-4, reach);
        double x = uniform(-reach, reach), y = uniform(-reach, reach);
        if (b->count > 0 && i % 2 == 0) {
            const pl_box *near = &b->fat[b->pieces[(uint32_t)i * 7 % b->count]];
            x = (double)near->min_x - size * uniform(0, 1);
            y = (double)near->max_y - size * uniform(0, 1);
        }
        double w = i % 5 == 0 ? 0 : size;
        check_query(b, (pl_box){ (plumb_real)x, (plumb_real)y, (plumb_real)(x + w),
                                 (plumb_real)(y + size * uniform(0, 1)) });
    }
    check_query(b, (pl_box){ -PLUMB_REAL_MAX, -PLUMB_REAL_MAX, PLUMB_REAL_MAX, PLUMB_REAL_MAX });
    check_query(b, (pl_box){ (plumb_real)-reach, 0, (plumb_real)reach, 0 });
}

static plumb_vec2 place_near(const boxes *b, double reach)
{
    plumb_vec2 p = { (plumb_real)uniform(-reach, reach), (plumb_real)uniform(-reach, reach) };
    if (b->count > 0 && uniform(0, 1) < 0.6) {
        const pl_box *near = &b->fat[b->pieces[(uint32_t)uniform(0, b->count - 1)]];
        double grow = spread(1e-3, reach) * uniform(-1, 1);
        p.x = (plumb_real)(uniform((double)near->min_x, (double)near->max_x) + grow);
        p.y = (plumb_real)(uniform((double)near->min_y, (double)near->max_y) + grow);
    }
    return p;
}

static void check_walks(boxes *b, int count, double reach)
{
    for (int i = 0; i < count; ++i) {
        plumb_vec2 from = place_near(b, reach);
        plumb_vec2 to = place_near(b, reach);
        if (i % 5 == 0) {
            to.y = from.y;
        } else if (i % 5 == 1) {
            to.x = from.x;
        } else if (i % 25 == 2) {
            to = from;
        }
        if (i % 3 == 0 && b->grid.level_count > 0) { // on borders of cells
            const pl_grid_level *level = &b->grid.levels[(uint32_t)i % b->grid.level_count];
            from.x = (plumb_real)(rint((double)from.x / level->cell) * level->cell);
            from.y = (plumb_real)(rint((double)from.y / level->cell) * level->cell);
        }
        check_walk(b, from, to, i % 4 == 0 ? uniform(0, 1) : 1);
    }
}

static void test_empty(void **state)
{
    (void)state;
    boxes *b = setup(1);
    check_query(b, (pl_box){ -1, -1, 1, 1 }); // not built
    build(b);
    check_queries(b, 5, 10);
    check_walks(b, 5, 10);
    add_box(b, 0, 0, 1, 1);
    build(b);
    b->count = 0;
    build(b); // emptied again
    check_queries(b, 5, 10);
    teardown(b);
}

static void test_one_size(void **state)
{
    (void)state;
    for (uint32_t n = 1; n <= 2000; n = n * 3 + 1) {
        boxes *b = setup(n);
        double reach = sqrt(n);
        while (b->count < n) {
            add_box(b, uniform(-reach, reach), uniform(-reach, reach), uniform(0.51, 1),
                    uniform(0.1, 1));
        }
        build(b);
        assert_int_equal(b->grid.level_count, 1);
        check_queries(b, 300, reach);
        check_walks(b, 300, 2 * reach);
        teardown(b);
    }
}

// Corners on borders of cells, sides that touch.
static void test_lattice(void **state)
{
    (void)state;
    boxes *b = setup(5);
    for (int i = 0; i < 40; ++i) {
        for (int k = 0; k < 40; ++k) {
            add_box(b, i - 20, k - 20, 1, 1);
        }
    }
    build(b);
    for (int i = -21; i <= 21; ++i) {
        for (int k = -21; k <= 21; ++k) {
            plumb_real x = (plumb_real)i, y = (plumb_real)k;
            check_query(b, (pl_box){ x, y, x, y });
            check_query(b, (pl_box){ x, y, x + 1, y + 1 });
            check_walk(b, plumb_v2(x, -30), plumb_v2(y, 30), 1);
        }
        check_walk(b, plumb_v2((plumb_real)i, -30), plumb_v2((plumb_real)i, 30), 1);
        check_walk(b, plumb_v2(-30, (plumb_real)i), plumb_v2(30, (plumb_real)i), 1);
        check_walk(b, plumb_v2((plumb_real)i, (plumb_real)i), plumb_v2(-25, -25), 1);
    }
    teardown(b);
}

static void test_mixed_sizes(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 12; ++seed) {
        boxes *b = setup(seed * 77);
        double reach = spread(1, 1e6);
        while (b->count < 1500) {
            double place = spread(1e-3, reach);
            add_box(b, uniform(-place, place), uniform(-place, place), spread(1e-4, 1e5),
                    spread(1e-4, 1e5));
        }
        build(b);
        assert_true(b->grid.level_count > 20);
        check_queries(b, 150, reach);
        check_walks(b, 150, reach);
        teardown(b);
    }
}

// Clusters with nothing in between: rows of cells have to be scattered over the buckets.
static void test_far_clusters(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 12; ++seed) {
        boxes *b = setup(seed * 191);
        for (int cluster = 0; cluster < 20; ++cluster) {
            double x = uniform(-1, 1) * spread(1, 1e9), y = uniform(-1, 1) * spread(1, 1e9);
            for (int i = 0; i < 50; ++i) {
                add_box(b, x + uniform(-9, 9), y + uniform(-9, 9), spread(0.2, 2), spread(0.2, 2));
            }
        }
        build(b);
        check_queries(b, 150, 1e9);
        check_walks(b, 150, 1e9);
        teardown(b);
    }
}

// Farther out than there are cells.
static void test_beyond_cells(void **state)
{
    (void)state;
    boxes *b = setup(3);
    while (b->count < 600) {
        double x = b->count % 3 == 0 ? -1e9 : 1e9;
        double y = b->count % 2 == 0 ? 1e9 : 0;
        add_box(b, x + uniform(-300, 300), y + uniform(-300, 300), 0.01, 0.01);
    }
    build(b);
    check_queries(b, 200, 1e9);
    check_walks(b, 200, 1e9);
    teardown(b);
}

static void test_one_cell(void **state)
{
    (void)state;
    boxes *b = setup(4);
    while (b->count < MOST) {
        add_box(b, uniform(3, 3.01), uniform(-7, -6.99), 1, 1);
    }
    build(b);
    check_queries(b, 100, 10);
    check_walks(b, 100, 10);
    b->count = 0;
    while (b->count < 500) {
        add_box(b, -2, 8, 0, 0); // points, all the same
    }
    build(b);
    check_queries(b, 50, 10);
    check_query(b, (pl_box){ -2, 8, -2, 8 });
    check_walks(b, 50, 10);
    teardown(b);
}

// Pieces are a part of all boxes, in any order.
static void test_chosen_pieces(void **state)
{
    (void)state;
    boxes *b = setup(6);
    while (b->count < 1000) {
        add_box(b, uniform(-20, 20), uniform(-20, 20), spread(0.01, 2), spread(0.01, 2));
    }
    for (uint32_t i = 999; i > 0; --i) { // Fisher and Yates
        uint32_t k = (uint32_t)uniform(0, i + 0.999);
        uint32_t piece = b->pieces[i];
        b->pieces[i] = b->pieces[k];
        b->pieces[k] = piece;
    }
    b->count = 400;
    build(b);
    check_queries(b, 300, 20);
    teardown(b);
}

static void test_stop(void **state)
{
    (void)state;
    boxes *b = setup(7);
    while (b->count < 300) {
        add_box(b, uniform(-5, 5), uniform(-5, 5), spread(0.05, 2), spread(0.05, 2));
    }
    build(b);
    for (uint32_t most = 1; most < 30; ++most) {
        memset(b->visits, 0, sizeof b->visits);
        b->stop_after = most;
        assert_false(pl_grid_query(&b->grid, (pl_box){ -9, -9, 9, 9 }, count_visit, b));
        pl_walk walk = pl_walk_make(plumb_v2(-9, -9), plumb_v2(9, 9));
        b->stop_after = 1;
        assert_false(pl_walk_grid(&b->grid, &walk, count_visit, b));
        uint32_t visits = 0;
        for (uint32_t i = 0; i < b->count; ++i) {
            visits += b->visits[i];
        }
        assert_int_equal(visits, most + 1);
    }
    teardown(b);
}

// The order of the visits depends on the boxes alone, not on what was filed before.
static uint64_t order_of(boxes *b, pl_box box);

static bool mix_visit(void *context, const pl_grid_entry *entry)
{
    uint64_t *hash = context;
    *hash = (*hash ^ entry->piece) * 1099511628211u; // FNV-1a
    return true;
}

static uint64_t order_of(boxes *b, pl_box box)
{
    uint64_t hash = 14695981039346656037u;
    assert_true(pl_grid_query(&b->grid, box, mix_visit, &hash));
    return hash;
}

static void test_order(void **state)
{
    (void)state;
    boxes *b = setup(8);
    while (b->count < 500) {
        add_box(b, uniform(-50, 50), uniform(-50, 50), spread(0.05, 20), spread(0.05, 20));
    }
    build(b);
    uint64_t before = order_of(b, (pl_box){ -9, -9, 9, 9 });
    b->count = 100;
    build(b);
    assert_true(order_of(b, (pl_box){ -9, -9, 9, 9 }) != before);
    b->count = 500;
    build(b);
    assert_true(order_of(b, (pl_box){ -9, -9, 9, 9 }) == before);
    teardown(b);
}

static void test_no_memory(void **state)
{
    (void)state;
    boxes *b = setup(9);
    while (b->count < 200) {
        add_box(b, uniform(-50, 50), uniform(-50, 50), 1, 1);
    }
    heap h = { .fail_at = -1, .limit = 1 };
    const plumb_allocator hooks = heap_allocator(&h);
    pl_memory_init(&b->memory, &hooks);
    int refused = 0;
    for (; !pl_grid_build(&b->memory, NULL, &b->grid, b->pieces, b->count, b->fat);
         h.limit += 512) {
        ++refused;
        assert_int_equal(b->grid.level_count, 0);
        assert_int_equal(b->grid.entry_count, 0);
    }
    assert_true(refused > 3);
    for (; !pl_grid_make_maps(&b->memory, &b->grid); h.limit += 512) {
        ++refused;
        assert_false(b->grid.mapped);
    }
    assert_true(refused > 4);
    check_queries(b, 20, 50);
    teardown(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_empty),        cmocka_unit_test(test_one_size),
        cmocka_unit_test(test_lattice),      cmocka_unit_test(test_mixed_sizes),
        cmocka_unit_test(test_far_clusters), cmocka_unit_test(test_beyond_cells),
        cmocka_unit_test(test_one_cell),     cmocka_unit_test(test_chosen_pieces),
        cmocka_unit_test(test_stop),         cmocka_unit_test(test_order),
        cmocka_unit_test(test_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
