// test_rows.c - body rows and pieces under random creation and destruction, against a model that
// knows nothing but a list of bodies: partitions, handles, lists, counters and poses agree after
// every change.
#include "harness/random.h"
#include "plumb/plumb.h"
#include "world/rows.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#define MOST_BODIES 60
#define MOST_SHAPES 4
#define ROUNDS      6000

typedef struct model_body {
    plumb_body body;
    plumb_body_type type;
    plumb_real x;
    int shape_count;
    plumb_shape shapes[MOST_SHAPES]; // in order of creation
    int pieces[MOST_SHAPES];
} model_body;

typedef struct model {
    plumb_world *world;
    uint32_t seed;
    int count;
    model_body bodies[MOST_BODIES];
} model;

static uint32_t choose(model *m, uint32_t below)
{
    return sim_random(&m->seed) % below;
}

//---- changes -------------------------------------------------------------------------------------

static void create_body(model *m)
{
    model_body *b = &m->bodies[m->count++];
    *b = (model_body){ .type = (plumb_body_type)choose(m, 3), .x = (plumb_real)choose(m, 1000) };
    const plumb_body_desc desc = { .type = b->type,
                                   .position = { b->x, 1 },
                                   .fixed_rotation = choose(m, 4) == 0 };
    b->body = plumb_body_create(m->world, &desc);
    assert_false(plumb_is_null(b->body));
}

static void create_shape(model *m, model_body *b)
{
    static const plumb_vec2 ell[] = { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } };
    static const plumb_vec2 line[] = { { 0, 0 }, { 1, 0 }, { 2, 1 }, { 3, 0 } };
    static const plumb_vec2 hexagon[] = { { 2, 0 },  { 1, 2 },   { -1, 2 },
                                          { -2, 0 }, { -1, -2 }, { 1, -2 } };
    const plumb_shape_desc descs[] = {
        { .kind = PLUMB_CIRCLE, .radius = 1 },
        { .kind = PLUMB_BOX, .half = { 1, 2 } },
        { .kind = PLUMB_CAPSULE, .points = line, .count = 2, .radius = 1 },
        { .kind = PLUMB_CHAIN, .points = line, .count = 4 },
        { .kind = PLUMB_OUTLINE, .points = ell, .count = 6 },
        { .kind = PLUMB_POLYGON, .points = hexagon, .count = 6 },
    };
    const plumb_shape_desc *desc = &descs[choose(m, 6)];
    int i = b->shape_count++;
    b->shapes[i] = plumb_shape_create(m->world, b->body, desc);
    assert_false(plumb_is_null(b->shapes[i]));
    b->pieces[i] = plumb_shape_piece_count(m->world, b->shapes[i]);
    assert_in_range(b->pieces[i], 1, 3);
}

static void destroy_shape(model *m, model_body *b)
{
    int i = (int)choose(m, (uint32_t)b->shape_count);
    assert_int_equal(plumb_shape_destroy(m->world, b->shapes[i]), PLUMB_OK);
    for (--b->shape_count; i < b->shape_count; ++i) {
        b->shapes[i] = b->shapes[i + 1];
        b->pieces[i] = b->pieces[i + 1];
    }
}

static void destroy_body(model *m, model_body *b)
{
    plumb_body gone = b->body;
    assert_int_equal(plumb_body_destroy(m->world, gone), PLUMB_OK);
    assert_false(plumb_body_valid(m->world, gone));
    *b = m->bodies[--m->count];
}

static void change(model *m)
{
    model_body *b = m->count > 0 ? &m->bodies[choose(m, (uint32_t)m->count)] : NULL;
    switch (choose(m, 8)) {
    case 0:
    case 1:
        if (m->count < MOST_BODIES) {
            create_body(m);
        }
        break;
    case 2:
        if (b != NULL) {
            destroy_body(m, b);
        }
        break;
    case 3:
        if (b != NULL && b->shape_count > 0) {
            destroy_shape(m, b);
        }
        break;
    default:
        if (b != NULL && b->shape_count < MOST_SHAPES) {
            create_shape(m, b);
        }
        break;
    }
}

//---- agreement -----------------------------------------------------------------------------------

static void check_partitions(const model *m)
{
    const plumb_world *w = m->world;
    uint32_t of_type[3] = { 0 };
    for (int i = 0; i < m->count; ++i) {
        ++of_type[m->bodies[i].type];
    }
    assert_int_equal(w->bodies.table.count, m->count);
    assert_int_equal(w->dynamic_count, of_type[PLUMB_DYNAMIC]);
    assert_int_equal(w->kinematic_count, of_type[PLUMB_KINEMATIC]);
    assert_int_equal(w->asleep_count, 0);
    for (uint32_t row = 0; row < w->bodies.table.count; ++row) {
        pl_partition p = pl_partition_of((plumb_body_type)w->bodies.type[row]);
        assert_in_range(row, pl_partition_first(w, p),
                        pl_partition_first(w, (pl_partition)(p + 1)) - 1);
        assert_int_equal(pl_body_row(w, w->bodies.entity[row]), row);
    }
}

static void check_row(const plumb_world *w, uint32_t row)
{
    const pl_bodies *b = &w->bodies;
    const pl_pose *pose = &pl_poses(w)[row];
    assert_true(pose->x == b->x[row] && pose->y == b->y[row]);
    assert_true(pose->c == b->c[row] && pose->s == b->s[row]);
    assert_true(pose->dx == b->local_x[row] && pose->dy == b->local_y[row]); // none is turned
    assert_true(b->center_x[row] == b->x[row] + b->local_x[row]);
    bool turns = b->type[row] == PLUMB_DYNAMIC && b->inertia[row] > 0 &&
                 !(b->flags[row] & PL_BODY_FIXED_ROTATION);
    assert_int_equal(b->inv_inertia[row] > 0, turns);
    assert_int_equal(b->inv_mass[row] > 0, b->type[row] == PLUMB_DYNAMIC);
}

static void check_body(const model *m, const model_body *b, uint32_t *pieces, uint32_t *moving)
{
    const plumb_world *w = m->world;
    uint32_t row = pl_body_row(w, b->body);
    assert_int_equal(w->bodies.type[row], b->type);
    assert_true(w->bodies.x[row] == b->x);
    check_row(w, row);

    plumb_shape shapes[MOST_SHAPES];
    assert_int_equal(plumb_body_shapes(w, b->body, shapes, MOST_SHAPES), b->shape_count);
    uint32_t in_body = 0;
    for (int i = 0; i < b->shape_count; ++i) {
        assert_true(plumb_same(shapes[i], b->shapes[i]));
        assert_true(plumb_same(plumb_shape_body(w, shapes[i]), b->body));
        uint32_t p = pl_shape_piece(w, shapes[i]);
        for (int k = 0; k < b->pieces[i]; ++k) {
            assert_true(plumb_same(w->pieces.shape[p], shapes[i]));
            assert_int_equal(w->pieces.body[p], row);
            assert_int_equal(w->pieces.moving[p] == PL_NONE, b->type == PLUMB_STATIC);
            *moving += b->type != PLUMB_STATIC;
            ++in_body;
            p = w->pieces.next_in_shape[p];
        }
        assert_int_equal(p, PL_NONE);
    }
    *pieces += in_body;
    for (uint32_t p = w->bodies.first_piece[row]; p != PL_NONE; p = w->pieces.next_in_body[p]) {
        --in_body;
    }
    assert_int_equal(in_body, 0);
}

static void check_counters(const plumb_world *w, uint32_t pieces, uint32_t moving)
{
    assert_int_equal(w->pieces.live, pieces);
    assert_int_equal(w->moving_count, moving);
    for (uint32_t i = 0; i < moving; ++i) {
        assert_int_equal(w->pieces.moving[pl_moving(w)[i]], i);
    }
    uint32_t kinds[PL_PIECE_KIND_COUNT] = { 0 };
    uint32_t corners = 0;
    for (uint32_t p = 0; p < w->pieces.table.count; ++p) {
        if (w->pieces.kind[p] != PL_PIECE_FREE) {
            ++kinds[w->pieces.kind[p]];
            corners += w->pieces.vertex_count[p] > 0 ? pl_pool_run(w->pieces.vertex_class[p]) : 0;
        }
    }
    assert_memory_equal(kinds, w->piece_kinds, sizeof kinds);
    assert_true(corners <= w->vertices.count);
    assert_int_equal(w->materials.users[0], pieces);
    uint32_t free_slots = 0;
    for (uint32_t p = w->pieces.free_head; p != PL_NONE; p = w->pieces.next_in_shape[p]) {
        ++free_slots;
    }
    assert_int_equal(free_slots + pieces, w->pieces.table.count);
    uint32_t turning = 0;
    for (uint32_t row = 0; row < w->dynamic_count; ++row) {
        turning += w->bodies.inv_inertia[row] > 0;
    }
    assert_int_equal(w->turning_bodies, turning);
}

// How many bodies that were there before have another row now.
static int count_moves(const plumb_world *w, const plumb_body *before, uint32_t rows)
{
    int moves = 0;
    for (uint32_t row = 0; row < rows; ++row) {
        uint32_t now = pl_body_row(w, before[row]);
        moves += now != PL_NONE && now != row;
    }
    return moves;
}

static void rows_agree_with_a_plain_list(void **state)
{
    (void)state;
    static model m;
    memset(&m, 0, sizeof m);
    m.seed = 2024;
    assert_int_equal(plumb_world_create(NULL, &m.world), PLUMB_OK);
    for (int round = 0; round < ROUNDS; ++round) {
        plumb_body before[MOST_BODIES];
        uint32_t rows = m.world->bodies.table.count;
        if (rows > 0) {
            memcpy(before, m.world->bodies.entity, rows * sizeof before[0]);
        }
        m.world->rows_moved = false;
        change(&m);
        int moves = count_moves(m.world, before, rows);
        assert_in_range(moves, 0, PL_PART_COUNT);
        assert_int_equal(m.world->rows_moved, moves > 0);
        check_partitions(&m);
        uint32_t pieces = 0;
        uint32_t moving = 0;
        for (int i = 0; i < m.count; ++i) {
            check_body(&m, &m.bodies[i], &pieces, &moving);
        }
        check_counters(m.world, pieces, moving);
    }
    while (m.count > 0) {
        destroy_body(&m, &m.bodies[0]);
    }
    check_counters(m.world, 0, 0);
    // Nothing was lost in the pool: all of it is in the free lists.
    uint32_t corners = 0;
    for (uint8_t c = 0; c < PL_VERTEX_CLASSES; ++c) {
        while (m.world->vertices.free_head[c] != PL_NONE) {
            pl_pool_take(&m.world->vertices, c);
            corners += pl_pool_run(c);
        }
    }
    assert_int_equal(corners, m.world->vertices.count);
    plumb_world_destroy(m.world);
}

//---- flags and slots -----------------------------------------------------------------------------

static void clear_flags(plumb_world *w)
{
    w->pairs_dirty = w->static_dirty = w->schedule_dirty = w->rows_moved = false;
}

static void changes_set_the_flags_that_the_step_reads(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
    const plumb_shape_desc box = { .kind = PLUMB_BOX, .half = { 1, 1 } };
    plumb_body fixed = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    clear_flags(w);
    plumb_shape ground = plumb_shape_create(w, fixed, &box);
    assert_true(w->pairs_dirty && w->static_dirty && w->schedule_dirty);
    clear_flags(w);
    plumb_body loose =
        plumb_body_create(w, &(plumb_body_desc){ 0 }); // takes the static row's place
    assert_true(w->rows_moved && w->schedule_dirty && !w->pairs_dirty && !w->static_dirty);
    assert_int_equal(w->pieces.body[pl_shape_piece(w, ground)], 1);
    clear_flags(w);
    plumb_shape crate = plumb_shape_create(w, loose, &box);
    assert_true(w->pairs_dirty && !w->static_dirty);
    const pl_box *fat = &w->pieces.fat[pl_shape_piece(w, crate)];
    assert_true(fat->min_x > fat->max_x && fat->min_y > fat->max_y);
    clear_flags(w);
    plumb_body_teleport(w, loose, plumb_v2(5, 5), 0);
    assert_true(w->pairs_dirty && !w->static_dirty);
    clear_flags(w);
    plumb_body_teleport(w, fixed, plumb_v2(0, -5), 0);
    assert_true(w->pairs_dirty && w->static_dirty);
    clear_flags(w);
    plumb_shape_destroy(w, ground);
    assert_true(w->pairs_dirty && w->static_dirty && w->schedule_dirty);
    clear_flags(w);
    plumb_body_destroy(w, loose);
    assert_true(w->pairs_dirty && !w->static_dirty && w->rows_moved);
    plumb_world_destroy(w);
}

static void a_slot_taken_anew_has_a_newer_serial(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
    plumb_body body = plumb_body_create(w, &(plumb_body_desc){ 0 });
    const plumb_shape_desc circle = { .kind = PLUMB_CIRCLE, .radius = 1 };
    plumb_shape old = plumb_shape_create(w, body, &circle);
    uint32_t slot = pl_shape_piece(w, old);
    uint32_t serial = w->pieces.serial[slot];
    plumb_shape_destroy(w, old);
    assert_true(plumb_same(w->pieces.shape[slot], old)); // an end event can still name it
    plumb_shape fresh = plumb_shape_create(w, body, &circle);
    assert_int_equal(pl_shape_piece(w, fresh), slot);
    assert_true(w->pieces.serial[slot] > serial);
    assert_false(plumb_shape_valid(w, old));
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_agree_with_a_plain_list),
        cmocka_unit_test(changes_set_the_flags_that_the_step_reads),
        cmocka_unit_test(a_slot_taken_anew_has_a_newer_serial),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
