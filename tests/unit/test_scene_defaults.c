// test_scene_defaults.c - what a script leaves out is what {0} leaves out in C: world, material, body, shape and
// joints, made by an empty constructor and by an empty descriptor, answer every question alike.
#define _POSIX_C_SOURCE 200809L
#include "scene_fixture.h"

#include "api/getters.h"

typedef struct answers {
    const char *name[64];
    unsigned char bytes[64][32];
    int count;
} answers;

static void keep(answers *a, const char *name, const void *bytes, size_t size)
{
    assert_true(a->count < 64 && size <= sizeof a->bytes[0]);
    if (strstr(name, "_user_data") != NULL) {
        return; // a scene keeps its records there
    }
    a->name[a->count] = name;
    memcpy(a->bytes[a->count++], bytes, size);
}

static void check_alike(const answers *a, const answers *b)
{
    assert_int_equal(a->count, b->count);
    for (int i = 0; i < a->count; ++i) {
        if (memcmp(a->bytes[i], b->bytes[i], sizeof a->bytes[i]) != 0) {
            fail_msg("%s of {0} differs from that of an empty table", a->name[i]);
        }
    }
}

#define KEEP(name, answer)                                                                         \
    {                                                                                              \
        __typeof__(answer) got = (answer);                                                         \
        keep(&a, #name, &got, sizeof got);                                                         \
    }

static answers of_body(const plumb_world *w, plumb_body h)
{
    const plumb_vec2 point = { 3, 4 };
    answers a = { .count = 0 };
    BODY_GETTERS(KEEP)
    return a;
}

static answers of_shape(const plumb_world *w, plumb_shape h)
{
    const plumb_vec2 point = { (plumb_real)0.5, 0 };
    answers a = { .count = 0 };
    SHAPE_GETTERS(KEEP)
    return a;
}

static answers of_joint(const plumb_world *w, plumb_joint h)
{
    answers a = { .count = 0 };
    plumb_joint_desc d;
    assert_int_equal(plumb_joint_settings(w, h, &d), PLUMB_OK);
    JOINT_GETTERS(KEEP)
    const plumb_real numbers[] = { d.lower,       d.upper,        d.motor_speed,  d.max_motor,
                                   d.hertz,       d.damping,      d.rest,         d.length,
                                   d.ratio,       d.pitch,        d.max_force,    d.max_torque,
                                   d.axis.x,      d.axis.y,       d.anchor.x,     d.anchor.y,
                                   d.break_force, d.break_torque, d.break_impulse };
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; ++i) {
        keep(&a, "a number of plumb_joint_settings", &numbers[i], sizeof numbers[i]);
    }
    const bool switches[] = { d.enable_limit, d.enable_motor, d.disabled, d.collide_connected };
    keep(&a, "a switch of plumb_joint_settings", switches, sizeof switches);
    return a;
}

static answers of_material(const plumb_world *w, plumb_material m)
{
    answers a = { .count = 0 };
    plumb_material_desc d;
    assert_int_equal(plumb_material_settings(w, m, &d), PLUMB_OK);
    const plumb_real numbers[] = { d.density,         d.friction,
                                   d.restitution,     d.rolling_resistance,
                                   d.surface_speed,   d.adhesion,
                                   d.kinetic_friction };
    const int rules[] = { (int)d.friction_mix, (int)d.restitution_mix, (int)d.adhesion_mix,
                          d.frictionless };
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; ++i) {
        keep(&a, "a number of plumb_material_settings", &numbers[i], sizeof numbers[i]);
    }
    keep(&a, "a rule of plumb_material_settings", rules, sizeof rules);
    return a;
}

static answers of_world(const plumb_world *w)
{
    answers a = { .count = 0 };
    const plumb_world_desc d = plumb_world_settings(w);
    const plumb_real numbers[] = { d.gravity.x,       d.gravity.y,  d.contact_hertz,
                                   d.contact_damping, d.push_speed, d.restitution_speed,
                                   d.sleep_speed,     d.sleep_time, d.wrap_x,
                                   d.wrap_y };
    const int choices[] = { (int)d.y_axis, (int)d.solver, d.substeps,
                            d.iterations,  d.no_sleep,    d.no_continuous };
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; ++i) {
        keep(&a, "a number of plumb_world_settings", &numbers[i], sizeof numbers[i]);
    }
    keep(&a, "a choice of plumb_world_settings", choices, sizeof choices);
    return a;
}

static void an_empty_table_is_an_empty_descriptor(void **state)
{
    (void)state;
    scene *s = load("body{ name = 'b', circle{ 1 } }\n"
                    "body{ name = 'm', circle{ 1 }, material = material{} }\n");
    const plumb_world *there = scene_world(s);
    plumb_world *here;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ 0 }, &here), PLUMB_OK);
    plumb_body body = plumb_body_create(here, &(plumb_body_desc){ 0 });
    plumb_material stuff = plumb_material_create(here, &(plumb_material_desc){ 0 });
    plumb_shape_desc circle = { .kind = PLUMB_CIRCLE, .radius = 1 };
    plumb_shape shape = plumb_shape_create(here, body, &circle), theirs, made;
    plumb_body_shapes(there, scene_body_find(s, "b").entity, &theirs, 1);
    plumb_body_shapes(there, scene_body_find(s, "m").entity, &made, 1);

    answers a = of_world(here), b = of_world(there);
    check_alike(&a, &b);
    a = of_body(here, body), b = of_body(there, scene_body_find(s, "b").entity);
    check_alike(&a, &b);
    a = of_shape(here, shape), b = of_shape(there, theirs);
    check_alike(&a, &b);
    // {0}, material{}, and what a shape without material has
    a = of_material(here, stuff), b = of_material(there, plumb_shape_material(there, made));
    check_alike(&a, &b);
    b = of_material(here, (plumb_material)PLUMB_NULL_INIT);
    check_alike(&a, &b);
    plumb_world_destroy(here);
    scene_destroy(s);
}

// Kinds that need nothing but a body.
static void an_empty_joint_is_an_empty_descriptor(void **state)
{
    (void)state;
    static const plumb_joint_kind kinds[] = { PLUMB_REVOLUTE, PLUMB_PRISMATIC, PLUMB_WELD,
                                              PLUMB_WHEEL,    PLUMB_MOUSE,     PLUMB_MOTOR,
                                              PLUMB_FRICTION };
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; ++i) {
        char text[128];
        snprintf(text, sizeof text, "local b = body{ circle{ 1 } }\n%s{ b }\n",
                 plumb_joint_kind_name(kinds[i]));
        scene *s = load(text);
        plumb_world *here;
        assert_int_equal(plumb_world_create(&(plumb_world_desc){ 0 }, &here), PLUMB_OK);
        plumb_body body = plumb_body_create(here, &(plumb_body_desc){ 0 });
        plumb_shape_create(here, body, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1 });
        plumb_joint joint =
            plumb_joint_create(here, &(plumb_joint_desc){ .kind = kinds[i], .body_b = body });
        plumb_joint theirs;
        assert_int_equal(plumb_world_joints(scene_world(s), &theirs, 1), 1);
        answers a = of_joint(here, joint), b = of_joint(scene_world(s), theirs);
        check_alike(&a, &b);
        plumb_world_destroy(here);
        scene_destroy(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_empty_table_is_an_empty_descriptor),
        cmocka_unit_test(an_empty_joint_is_an_empty_descriptor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
