// test_component.c - the sparse sets behind user components: against a plain array under random
// changes, hooks in order, values that move.
#include "harness/random.h"
#include "ecs/component.h"
#include "plumb/plumb.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#define ENTITIES 40
#define ROUNDS   20000

static void a_set_behaves_as_a_plain_array(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
    plumb_component c =
        plumb_component_create(w, &(plumb_component_desc){ .name = "n", .size = sizeof(uint32_t) });
    plumb_entity entity[ENTITIES];
    uint32_t value[ENTITIES];
    bool has[ENTITIES] = { false };
    for (int i = 0; i < ENTITIES; ++i) {
        entity[i] = plumb_entity_create(w);
    }
    uint32_t seed = 12345;
    for (int round = 0; round < ROUNDS; ++round) {
        uint32_t i = sim_random(&seed) % ENTITIES;
        switch (sim_random(&seed) % 4) {
        case 0:
        case 1:
            value[i] = sim_random(&seed);
            has[i] = true;
            assert_int_equal(plumb_component_set(w, entity[i], c, &value[i]), PLUMB_OK);
            break;
        case 2:
            assert_int_equal(plumb_component_remove(w, entity[i], c),
                             has[i] ? PLUMB_OK : PLUMB_E_MISSING);
            has[i] = false;
            break;
        default:
            assert_int_equal(plumb_entity_destroy(w, entity[i]), PLUMB_OK);
            entity[i] = plumb_entity_create(w);
            has[i] = false;
            break;
        }
        plumb_component_span span = plumb_world_column(w, c);
        int count = 0;
        for (int k = 0; k < ENTITIES; ++k) {
            const uint32_t *got = plumb_component_get(w, entity[k], c);
            assert_int_equal(got != NULL, has[k]);
            if (got != NULL) {
                assert_int_equal(*got, value[k]);
                ptrdiff_t row = got - (const uint32_t *)span.values;
                assert_in_range(row, 0, span.count - 1);
                assert_true(plumb_same(span.entity[row], entity[k]));
                ++count;
            }
        }
        assert_int_equal(span.count, count);
    }
    plumb_world_destroy(w);
}

static void values_lie_in_order_of_addition_and_the_last_fills_a_gap(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
    plumb_component c =
        plumb_component_create(w, &(plumb_component_desc){ .name = "n", .size = sizeof(int) });
    plumb_entity e[4];
    for (int i = 3; i >= 0; --i) {
        e[i] = plumb_entity_create(w);
        plumb_component_set(w, e[i], c, &i);
    }
    plumb_component_span span = plumb_world_column(w, c);
    assert_int_equal(span.count, 4);
    assert_int_equal(span.stride, sizeof(int));
    assert_memory_equal(span.values, ((int[]){ 3, 2, 1, 0 }), 4 * sizeof(int));
    plumb_component_remove(w, e[3], c);
    span = plumb_world_column(w, c);
    assert_memory_equal(span.values, ((int[]){ 0, 2, 1 }), 3 * sizeof(int));
    plumb_world_destroy(w);
}

static void a_value_of_the_column_itself_may_be_given(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
    plumb_component c =
        plumb_component_create(w, &(plumb_component_desc){ .name = "block", .size = 64 });
    plumb_entity first = plumb_entity_create(w);
    char block[64];
    memset(block, 'a', sizeof block);
    plumb_component_set(w, first, c, block);
    for (int i = 0; i < 200; ++i) { // grows several times while it copies from itself
        plumb_entity e = plumb_entity_create(w);
        assert_int_equal(plumb_component_set(w, e, c, plumb_component_get(w, first, c)), PLUMB_OK);
        assert_memory_equal(plumb_component_get(w, e, c), block, sizeof block);
    }
    plumb_world_destroy(w);
}

//---- hooks ---------------------------------------------------------------------------------------

typedef struct record {
    char text[256];
    plumb_result direct;
} record;

static void note(record *r, char what, const void *value)
{
    size_t used = strlen(r->text);
    r->text[used] = what;
    r->text[used + 1] = *(const char *)value;
    r->text[used + 2] = '\0';
}

static void on_add(plumb_world *w, plumb_entity e, void *value, void *context)
{
    record *r = context;
    note(r, '+', value);
    r->direct = plumb_entity_destroy(w, e);
}

static void on_remove(plumb_world *w, plumb_entity e, void *value, void *context)
{
    assert_true(plumb_entity_alive(w, e));
    note(context, '-', value);
}

static void hooks_see_values_and_a_locked_world(void **state)
{
    (void)state;
    plumb_world *w;
    record r = { .text = "" };
    assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
    const plumb_component_desc desc = {
        .name = "tag", .size = 1, .on_add = on_add, .on_remove = on_remove, .context = &r
    };
    plumb_component c = plumb_component_create(w, &desc);
    plumb_entity e = plumb_entity_create(w);
    plumb_component_set(w, e, c, "a");
    assert_int_equal(r.direct, PLUMB_E_LOCKED);
    assert_string_equal(plumb_world_error(w).message,
                        "plumb_entity_destroy: a hook of component 'tag' runs; "
                        "use plumb_command_destroy");
    plumb_component_set(w, e, c, "b"); // overwriting is no addition
    plumb_component_remove(w, e, c);
    plumb_component_set(w, e, c, "c");
    assert_int_equal(plumb_entity_destroy(w, e), PLUMB_OK);
    plumb_body body = plumb_body_create(w, &(plumb_body_desc){ 0 });
    plumb_shape_desc circle = { .kind = PLUMB_CIRCLE, .radius = 1 };
    plumb_component_set(w, body.entity, c, "B");
    plumb_component_set(w, plumb_shape_create(w, body, &circle).entity, c, "1");
    plumb_component_set(w, plumb_shape_create(w, body, &circle).entity, c, "2");
    assert_int_equal(plumb_body_destroy(w, body), PLUMB_OK);
    plumb_component_set(w, plumb_entity_create(w), c, "z");
    plumb_world_destroy(w);
    assert_string_equal(r.text, "+a-b+c-c+B+1+2-2-1-B+z-z");
}

static void fields_are_copied_with_their_names(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(NULL, &w), PLUMB_OK);
    char name[] = "health";
    char unit[] = "J";
    plumb_field fields[] = { { name, PLUMB_FIELD_F32, 0, unit },
                             { "armed", PLUMB_FIELD_BOOL, 4, NULL } };
    plumb_component c = plumb_component_create(
        w, &(plumb_component_desc){ .name = name, .size = 8, .fields = fields, .field_count = 2 });
    memset(name, '?', 3);
    memset(unit, '?', 1);
    memset(fields, 0, sizeof fields);
    for (char other = 'a'; other < 'k'; ++other) { // the list of components grows and moves
        char text[2] = { other, '\0' };
        plumb_component_create(w, &(plumb_component_desc){ .name = text, .size = 1 });
    }
    plumb_component_desc info;
    assert_int_equal(plumb_component_info(w, c, &info), PLUMB_OK);
    assert_string_equal(info.name, "health");
    assert_int_equal(info.size, 8);
    assert_int_equal(info.field_count, 2);
    assert_string_equal(info.fields[0].name, "health");
    assert_string_equal(info.fields[0].unit, "J");
    assert_string_equal(info.fields[1].name, "armed");
    assert_null(info.fields[1].unit);
    assert_int_equal(info.fields[1].offset, 4);
    assert_int_equal(plumb_component_find(w, "health").id, c.id);
    assert_int_equal(plumb_component_find(w, "j").id, 11);
    assert_int_equal(plumb_component_find(w, "none").id, 0);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_set_behaves_as_a_plain_array),
        cmocka_unit_test(values_lie_in_order_of_addition_and_the_last_fills_a_gap),
        cmocka_unit_test(a_value_of_the_column_itself_may_be_given),
        cmocka_unit_test(hooks_see_values_and_a_locked_world),
        cmocka_unit_test(fields_are_copied_with_their_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
