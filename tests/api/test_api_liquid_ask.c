// test_api_liquid_ask.c - questions to the liquid as a user has them: refused calls; who counts what begins and ends is right,
// whatever happens to bodies and water; worlds that are asked, restored or run on threads go on as others.
#include "harness/heap.h"
#include "harness/random.h"
#include "world_fixture.h"

#include <stdlib.h>

#define DT     R(1.0 / 60)
#define BODIES 8
#define SHEETS 2

static void bad_questions_are_refused(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_vec2 lost = { R(NAN), 0 }, far = { 0, R(INFINITY) };
    plumb_liquid_hit hit;
    int count = 5;
    assert_true(plumb_liquid_at(NULL, plumb_v2(0, 0)).fill == 0);
    assert_false(plumb_liquid_ray(NULL, plumb_v2(0, 0), plumb_v2(1, 0), &hit));
    assert_null(plumb_liquid_contacts(NULL, &count));
    assert_int_equal(count, 0);
    count = 5;
    assert_null(plumb_liquid_ends(NULL, &count));
    assert_int_equal(count, 0);
    assert_null(plumb_liquid_contacts(w, NULL));
    assert_null(plumb_liquid_ends(w, NULL));
    assert_true(plumb_liquid_at(w, plumb_v2(0, 0)).fill == 0);
    assert_int_equal(plumb_world_error(w).code, PLUMB_E_STATE);
    assert_false(plumb_liquid_ray(w, plumb_v2(0, 0), plumb_v2(1, 0), &hit));
    assert_int_equal(plumb_world_error(w).code, PLUMB_E_STATE);
    assert_int_equal(plumb_liquid_create(w, NULL), PLUMB_OK);
    const int errors = f->errors;
    assert_true(plumb_liquid_at(w, plumb_v2(0, 0)).fill == 0); // nothing there is no error
    assert_false(plumb_liquid_ray(w, plumb_v2(0, 0), plumb_v2(1, 0), &hit));
    assert_int_equal(f->errors, errors);
    assert_true(plumb_liquid_at(w, lost).fill == 0);
    assert_int_equal(plumb_world_error(w).code, PLUMB_E_NOT_FINITE);
    assert_false(plumb_liquid_ray(w, lost, plumb_v2(1, 0), &hit));
    assert_int_equal(plumb_world_error(w).code, PLUMB_E_NOT_FINITE);
    assert_false(plumb_liquid_ray(w, plumb_v2(1, 0), far, &hit));
    assert_int_equal(plumb_world_error(w).code, PLUMB_E_NOT_FINITE);
    assert_false(plumb_liquid_ray(w, plumb_v2(1, 0), plumb_v2(1, 0), NULL));
    assert_int_equal(plumb_world_error(w).code, PLUMB_E_NULL);
    assert_int_equal(f->errors, errors + 4);
}

//---- sessions ------------------------------------------------------------------------------------

// A basin with boxes and sheets, by which anything happens; who is wet by all that was told.
typedef struct session {
    plumb_world *w;
    uint32_t seed;
    plumb_body body[BODIES];
    plumb_softbody sheet[SHEETS];
    plumb_entity wet[64];
    int wet_count, begins, ends;
} session;

static plumb_vec2 anywhere(session *s)
{
    return plumb_v2(R(sim_uniform(&s->seed, -1.5, 1.5)), R(sim_uniform(&s->seed, 0.3, 3)));
}

static void make_body(session *s, int i)
{
    s->body[i] = plumb_body_create(s->w, &(plumb_body_desc){ .position = anywhere(s) });
    plumb_shape_create(s->w, s->body[i],
                       &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                            .half = { R(0.15), R(0.1) },
                                            .density = R(sim_uniform(&s->seed, 100, 900)) });
}

static void make_sheet(session *s, int i)
{
    const plumb_vec2 at = anywhere(s);
    plumb_softbody_node nodes[4];
    for (int k = 0; k < 4; ++k) {
        nodes[k] = (plumb_softbody_node){
            .position = { at.x + R(k % 2) * R(0.3), at.y + R(k / 2) * R(0.3) },
            .mass = 5,
            .radius = R(0.01),
        };
    }
    const plumb_softbody_triangle triangles[] = { { .a = 0, .b = 1, .c = 3, .young = 5e4f },
                                                  { .a = 0, .b = 3, .c = 2, .young = 5e4f } };
    s->sheet[i] = plumb_softbody_create(
        s->w, &(plumb_softbody_desc){
                  .nodes = nodes, .node_count = 4, .triangles = triangles, .triangle_count = 2 });
    assert_false(plumb_is_null(s->sheet[i]));
}

static void pour(session *s)
{
    assert_int_equal(plumb_liquid_add_box(s->w, plumb_v2(-2, 0), plumb_v2(2, R(0.5)), NULL),
                     PLUMB_OK);
}

static void begin(session *s, uint32_t seed, int workers)
{
    *s = (session){ .seed = seed };
    const plumb_world_desc desc = { .workers = workers };
    assert_int_equal(plumb_world_create(&desc, &s->w), PLUMB_OK);
    const plumb_body ground = plumb_body_create(s->w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    const plumb_vec2 line[] = { { -2, 4 }, { -2, 0 }, { 2, 0 }, { 2, 4 } };
    plumb_shape_create(s->w, ground,
                       &(plumb_shape_desc){ .kind = PLUMB_CHAIN, .points = line, .count = 4 });
    assert_int_equal(plumb_liquid_create(s->w, &(plumb_liquid_desc){ .spacing = R(0.08) }),
                     PLUMB_OK);
    for (int i = 0; i < BODIES; ++i) {
        make_body(s, i);
    }
    for (int i = 0; i < SHEETS; ++i) {
        make_sheet(s, i);
    }
    pour(s);
}

// One thing in ten or so steps.
static void meddle(session *s)
{
    const int i = (int)(sim_random(&s->seed) % BODIES);
    const plumb_body b = s->body[i];
    const plumb_body_type type = plumb_body_get_type(s->w, b);
    switch (sim_random(&s->seed) % 80) {
    case 0:
        plumb_body_destroy(s->w, b);
        make_body(s, i);
        break;
    case 1:
        plumb_body_set_enabled(s->w, b, !plumb_body_is_enabled(s->w, b));
        break;
    case 2:
    case 3:
        plumb_body_teleport(s->w, b, anywhere(s), 0);
        break;
    case 4:
        plumb_body_set_type(s->w, b, type == PLUMB_DYNAMIC ? PLUMB_KINEMATIC : PLUMB_DYNAMIC);
        break;
    case 5:
        plumb_softbody_destroy(s->w, s->sheet[i % SHEETS]);
        make_sheet(s, i % SHEETS);
        break;
    case 6:
        plumb_liquid_remove(s->w, plumb_v2(-9, -9), plumb_v2(i < 2 ? R(9) : R(0), 9));
        break;
    case 7:
        plumb_liquid_remove(s->w, plumb_v2(-9, -9), plumb_v2(9, 9));
        pour(s);
        break;
    default:
        break;
    }
}

static int find_wet(const session *s, plumb_entity e)
{
    for (int i = 0; i < s->wet_count; ++i) {
        if (s->wet[i].index == e.index && s->wet[i].generation == e.generation) {
            return i;
        }
    }
    return -1;
}

// Begins and ends as they were told, against who is told to be wet.
static void count(session *s)
{
    int contact_count, end_count;
    const plumb_liquid_contact *c = plumb_liquid_contacts(s->w, &contact_count);
    const plumb_liquid_end *e = plumb_liquid_ends(s->w, &end_count);
    for (int i = 0; i < end_count; ++i) {
        assert_true(plumb_is_null(e[i].body) != plumb_is_null(e[i].softbody));
        const int at =
            find_wet(s, plumb_is_null(e[i].body) ? e[i].softbody.entity : e[i].body.entity);
        assert_true(at >= 0);
        s->wet[at] = s->wet[--s->wet_count];
        ++s->ends;
    }
    for (int i = 0; i < contact_count; ++i) {
        assert_true(plumb_is_null(c[i].body) != plumb_is_null(c[i].softbody));
        const plumb_entity who = plumb_is_null(c[i].body) ? c[i].softbody.entity : c[i].body.entity;
        assert_int_equal(c[i].began, find_wet(s, who) < 0);
        if (c[i].began) {
            s->wet[s->wet_count++] = who;
            ++s->begins;
        }
    }
    assert_int_equal(contact_count, s->wet_count);
}

static void step(session *s)
{
    meddle(s);
    assert_int_equal(plumb_world_step(s->w, DT), PLUMB_OK);
    count(s);
}

static void who_counts_is_right(void **state)
{
    (void)state;
    int begins = 0, ends = 0;
    for (uint32_t seed = 1; seed <= 6; ++seed) {
        session s;
        begin(&s, seed, 0);
        for (int i = 0; i < 300; ++i) {
            step(&s);
        }
        plumb_liquid_remove(s.w, plumb_v2(-9, -9), plumb_v2(9, 9));
        assert_int_equal(plumb_world_step(s.w, DT), PLUMB_OK);
        count(&s);
        assert_int_equal(s.wet_count, 0);
        assert_int_equal(plumb_world_step(s.w, DT), PLUMB_OK);
        assert_null(plumb_liquid_ends(s.w, NULL));
        begins += s.begins, ends += s.ends;
        plumb_world_destroy(s.w);
    }
    assert_true(begins > 100 && ends == begins);
}

// One is asked in each step, the other is not; one goes back ten steps now and then, the third has threads.
static void questions_change_nothing(void **state)
{
    (void)state;
    session a, b, c;
    begin(&a, 77, 0);
    begin(&b, 77, 0);
    begin(&c, 77, 2);
    const size_t room = 4u << 20;
    void *image = malloc(room);
    for (int i = 0; i < 120; ++i) {
        plumb_liquid_hit hit;
        plumb_liquid_ray(b.w, plumb_v2(R(0.1), 5), plumb_v2(R(0.2), -1), &hit);
        plumb_liquid_at(b.w, plumb_v2(0, R(0.2)));
        step(&a);
        if (i % 20 == 7) {
            const size_t size = plumb_world_snapshot_size(b.w);
            assert_true(size <= room);
            assert_int_equal(plumb_world_save(b.w, image, size), PLUMB_OK);
            for (int k = 0; k < 5; ++k) {
                plumb_world_step(b.w, DT);
            }
            assert_int_equal(plumb_world_restore(b.w, image, size), PLUMB_OK);
            assert_null(plumb_liquid_contacts(b.w, NULL));
        }
        step(&b);
        step(&c);
        assert_int_equal(plumb_world_hash(a.w), plumb_world_hash(b.w));
        assert_int_equal(plumb_world_hash(a.w), plumb_world_hash(c.w));
        assert_int_equal(a.begins, b.begins);
        assert_int_equal(a.ends, c.ends);
    }
    free(image);
    plumb_world_destroy(a.w);
    plumb_world_destroy(b.w);
    plumb_world_destroy(c.w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(bad_questions_are_refused, set_up, tear_down),
        cmocka_unit_test(who_counts_is_right),
        cmocka_unit_test(questions_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
