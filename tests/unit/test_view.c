// test_view.c - views over bodies against a plain search, under random changes of components, rows and
// states; the order in which a step puts values; what a restored world walks.
#include "random_world.h"

#include <string.h>

#define BODIES     60
#define COMPONENTS 3
#define ROUNDS     400

typedef struct value {
    uint32_t owner, kind; // slot of the owner; which component
    char rest[292];       // longer than what is exchanged at once
} value;

typedef struct scene {
    plumb_world *world;
    plumb_body body[BODIES];
    plumb_entity bare;
    plumb_component component[COMPONENTS];
} scene;

static void give(scene *s, plumb_entity e, int k)
{
    const value v = { .owner = e.index, .kind = (uint32_t)k };
    assert_int_equal(plumb_component_set(s->world, e, s->component[k], &v), PLUMB_OK);
}

static void add_body(scene *s, int i)
{
    const plumb_body_type types[] = { PLUMB_DYNAMIC, PLUMB_DYNAMIC, PLUMB_DYNAMIC, PLUMB_KINEMATIC,
                                      PLUMB_STATIC };
    s->body[i] = plumb_body_create(s->world, &(plumb_body_desc){ .type = types[(int)uniform(0, 5)],
                                                                 .disabled = uniform(0, 1) < 0.1 });
    for (int k = 0; k < COMPONENTS; ++k) {
        if (uniform(0, 1) < 0.7) {
            give(s, s->body[i].entity, k);
        }
    }
}

static scene make_scene(uint32_t seed)
{
    static const char *const names[] = { "a", "b", "c" };
    scene s = { .world = make_world(seed) };
    s.bare = plumb_entity_create(s.world);
    for (int k = 0; k < COMPONENTS; ++k) {
        s.component[k] = plumb_component_create(
            s.world, &(plumb_component_desc){ .name = names[k], .size = sizeof(value) });
        if (k == 1) {
            give(&s, s.bare, k); // no view shows it
        }
    }
    for (int i = 0; i < BODIES; ++i) {
        add_body(&s, i);
    }
    return s;
}

static void change(scene *s)
{
    plumb_world *w = s->world;
    const int i = (int)uniform(0, BODIES), k = (int)uniform(0, COMPONENTS);
    switch ((int)uniform(0, 8)) {
    case 0:
        plumb_body_destroy(w, s->body[i]);
        add_body(s, i);
        break;
    case 1:
    case 2:
        give(s, s->body[i].entity, k);
        break;
    case 3:
        plumb_component_remove(w, s->body[i].entity, s->component[k]);
        break;
    case 4:
        plumb_body_sleep(w, s->body[i]); // refused for some
        break;
    case 5:
        plumb_body_wake(w, s->body[i]);
        break;
    case 6:
        plumb_body_set_type(w, s->body[i], (plumb_body_type)(int)uniform(0, 3));
        break;
    default:
        assert_int_equal(plumb_world_step(w, (plumb_real)(1.0 / 60)), PLUMB_OK);
        break;
    }
}

static plumb_body_view_desc random_desc(const scene *s)
{
    plumb_body_view_desc desc = { .rows = (plumb_view_rows)(int)uniform(0, 4) };
    const int count = 1 + (int)uniform(0, COMPONENTS);
    const int first = (int)uniform(0, COMPONENTS);
    for (int k = 0; k < count; ++k) {
        desc.with[k] = s->component[(first + k) % COMPONENTS];
    }
    return desc;
}

static bool is_looked_at(const plumb_body_span *b, plumb_view_rows rows, int row)
{
    const int kinematic = b->dynamic_count, asleep = kinematic + b->kinematic_count;
    switch (rows) {
    case PLUMB_VIEW_AWAKE:
        return row < kinematic;
    case PLUMB_VIEW_MOVING:
        return row < asleep;
    case PLUMB_VIEW_DYNAMIC:
        return row < kinematic || (row >= asleep && row < asleep + b->asleep_count);
    default:
        return true;
    }
}

static bool has_all(const scene *s, const plumb_body_view_desc *desc, plumb_body body)
{
    for (int k = 0; k < PLUMB_VIEW_MOST && desc->with[k].id != 0; ++k) {
        if (plumb_component_get(s->world, body.entity, desc->with[k]) == NULL) {
            return false;
        }
    }
    return true;
}

// Every row of a range has its own values, and ranges rise. Returns how many ranges there were.
static int check_walk(const scene *s, const plumb_body_view_desc *desc, plumb_body_view view,
                      int first, int end)
{
    const plumb_body_span b = plumb_world_bodies(s->world);
    int row = 0, ranges = 0;
    bool seen[2 * BODIES] = { false };
    for (; plumb_body_view_next(&view); ++ranges) {
        assert_true(view.count > 0 && view.row >= row);
        row = view.row;
        for (int i = 0; i < view.count; ++i, ++row) {
            for (int k = 0; k < PLUMB_VIEW_MOST && desc->with[k].id != 0; ++k) {
                const value *v = (const value *)view.values[k] + i;
                assert_ptr_equal(v,
                                 plumb_component_get(s->world, b.body[row].entity, desc->with[k]));
                assert_int_equal(v->owner, b.body[row].entity.index);
                assert_int_equal(v->kind, desc->with[k].id - s->component[0].id);
            }
            seen[row] = true;
        }
    }
    assert_false(plumb_body_view_next(&view));
    for (int r = 0; r < b.count; ++r) {
        assert_int_equal(seen[r], r >= first && r < end && is_looked_at(&b, desc->rows, r) &&
                                      has_all(s, desc, b.body[r]));
    }
    return ranges;
}

static void a_view_shows_who_has_all_by_rising_row(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 6; ++seed) {
        scene s = make_scene(seed);
        for (int round = 0; round < ROUNDS; ++round) {
            change(&s);
            const plumb_body_view_desc desc = random_desc(&s);
            plumb_body_view view;
            assert_int_equal(plumb_body_view_open(s.world, &desc, &view), PLUMB_OK);
            check_walk(&s, &desc, view, 0, BODIES);
            const int first = (int)uniform(-2, BODIES + 2), end = (int)uniform(-2, BODIES + 2);
            check_walk(&s, &desc, plumb_body_view_part(&view, first, end), first, end);
        }
        plumb_world_destroy(s.world);
    }
}

// The order of values, as a step leaves it behind: bodies by row, then the others.
static void check_order(const scene *s, plumb_component c, const plumb_body_span *b)
{
    const plumb_component_span span = plumb_world_column(s->world, c);
    int at = 0;
    for (int row = 0; row < b->count; ++row) {
        if (plumb_component_get(s->world, b->body[row].entity, c) != NULL) {
            assert_true(at < span.count && plumb_same(span.entity[at], b->body[row].entity));
            assert_int_equal(((const value *)span.values)[at].owner, span.entity[at].index);
            ++at;
        }
    }
    assert_true(span.count - at <= 1);
    assert_true(at == span.count || plumb_same(span.entity[at], s->bare));
}

static void look(const plumb_system_call *call)
{
    const scene *s = call->context;
    const plumb_body_span b = plumb_world_bodies(s->world);
    for (int k = 0; k < COMPONENTS; ++k) {
        check_order(s, s->component[k], &b);
    }
}

static void a_step_begins_with_values_by_row(void **state)
{
    (void)state;
    scene s = make_scene(77);
    const plumb_system_desc desc = {
        .name = "look", .phase = PLUMB_PHASE_BEGIN, .run = look, .context = &s
    };
    assert_int_equal(plumb_system_create(s.world, &desc), PLUMB_OK);
    for (int round = 0; round < ROUNDS; ++round) {
        change(&s);
        assert_int_equal(plumb_world_step(s.world, (plumb_real)(1.0 / 60)), PLUMB_OK);
    }
    plumb_world_destroy(s.world);
}

static void who_all_have_it_makes_one_range(void **state)
{
    (void)state;
    scene s = make_scene(5);
    for (int i = 0; i < BODIES; ++i) {
        give(&s, s.body[i].entity, 0);
        give(&s, s.body[i].entity, 2);
    }
    assert_int_equal(plumb_world_step(s.world, (plumb_real)(1.0 / 60)), PLUMB_OK);
    const plumb_body_view_desc desc = { .with = { s.component[0], s.component[2] },
                                        .rows = PLUMB_VIEW_ALL };
    plumb_body_view view;
    assert_int_equal(plumb_body_view_open(s.world, &desc, &view), PLUMB_OK);
    assert_int_equal(check_walk(&s, &desc, view, 0, BODIES), 1);
    plumb_world_destroy(s.world);
}

// Order is state: a restored world walks as the one that was saved, to the last value.
static void a_restored_world_has_the_same_order(void **state)
{
    (void)state;
    scene s = make_scene(9);
    static char image[1 << 20];
    for (int round = 0; round < ROUNDS / 4; ++round) {
        change(&s);
        size_t size = plumb_world_snapshot_size(s.world);
        assert_true(size <= sizeof image);
        assert_int_equal(plumb_world_save(s.world, image, size), PLUMB_OK);
        const uint64_t saved = plumb_world_hash(s.world);
        assert_int_equal(plumb_world_step(s.world, (plumb_real)(1.0 / 60)), PLUMB_OK);
        const uint64_t after = plumb_world_hash(s.world);
        assert_int_equal(plumb_world_restore(s.world, image, size), PLUMB_OK);
        assert_true(plumb_world_hash(s.world) == saved);
        const plumb_body_view_desc desc = random_desc(&s);
        plumb_body_view view;
        assert_int_equal(plumb_body_view_open(s.world, &desc, &view), PLUMB_OK);
        check_walk(&s, &desc, view, 0, BODIES);
        assert_true(plumb_world_hash(s.world) == saved); // to look changes nothing
        assert_int_equal(plumb_world_step(s.world, (plumb_real)(1.0 / 60)), PLUMB_OK);
        assert_true(plumb_world_hash(s.world) == after);
    }
    plumb_world_destroy(s.world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_view_shows_who_has_all_by_rising_row),
        cmocka_unit_test(a_step_begins_with_values_by_row),
        cmocka_unit_test(who_all_have_it_makes_one_range),
        cmocka_unit_test(a_restored_world_has_the_same_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
