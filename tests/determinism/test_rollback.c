// test_rollback.c - a world that uses everything, with a script that makes and destroys as it runs: 2,000
// steps with random rollbacks of 1 to 12 steps end in the same bits as without.
//
// The script decides by the state of the world alone (its step count, its rows, a clock that is an
// entity), so that it does the same after going back. It goes back to moments after a step and to
// moments between direct calls and the step.
#include "rollback.h"

#include "harness/trials.h"

#include <stdlib.h>
#include <string.h>

#define R(x) ((plumb_real)(x))

#define STEPS 2000 // of the world; the script takes two for each

typedef struct counted {
    float heat;
    uint32_t seen;
} counted;

typedef struct script {
    plumb_component counted, marked, clock;
    plumb_material rubber, ice, belt;
} script;

//---- systems and hooks ---------------------------------------------------------------------------

static void heat(const plumb_system_call *call)
{
    const script *s = call->context;
    plumb_component_span span = plumb_world_column(call->world, s->counted);
    counted *values = span.values;
    for (int i = 0; i < span.count; ++i) {
        values[i].heat += (float)call->dt * (float)(i + 1);
        ++values[i].seen;
    }
}

static void push(const plumb_system_call *call)
{
    plumb_body_span b = plumb_world_bodies(call->world);
    for (int i = 0; i < b.dynamic_count; i += 5) {
        b.fx[i] += R(0.5);
    }
}

// Some contacts are let through, some lose their friction.
static void edit(const plumb_system_call *call)
{
    int count = plumb_contact_edit_count(call->world);
    for (int i = 0; i < count; i += 7) {
        plumb_contact_edit e;
        plumb_contact_edit_get(call->world, i, &e);
        e.friction = 0;
        e.enabled = plumb_world_stats(call->world).step_count % 5 != 0;
        plumb_contact_edit_set(call->world, i, &e);
    }
}

static plumb_body row_body(const plumb_world *w, uint32_t number)
{
    plumb_body_span b = plumb_world_bodies((plumb_world *)w);
    plumb_body none = PLUMB_NULL_INIT;
    return b.dynamic_count == 0 ? none : b.body[number % (uint32_t)b.dynamic_count];
}

// At the end of a step: what comes next is asked for by commands.
static void order(const plumb_system_call *call)
{
    const script *s = call->context;
    plumb_world *w = call->world;
    uint32_t step = (uint32_t)plumb_world_stats(w).step_count;
    if (step % 6 == 0) {
        const plumb_body_desc desc = { .position = { R(step % 40) / 4 - 5, 12 },
                                       .angular_velocity = R(step % 3) };
        plumb_body b = plumb_command_body_create(w, &desc);
        static const plumb_vec2 dart[] = {
            { R(-0.4), 0 }, { 0, R(-0.5) }, { R(0.4), 0 }, { 0, R(-0.2) }
        };
        const plumb_shape_desc shapes[] = {
            { .kind = PLUMB_BOX, .half = { R(0.3), R(0.2) }, .material = s->rubber },
            { .kind = PLUMB_CIRCLE, .radius = R(0.3) },
            { .kind = PLUMB_OUTLINE, .points = dart, .count = 4, .material = s->ice },
        };
        plumb_command_shape_create(w, b, &shapes[step / 6 % 3]);
        plumb_command_component_set(w, b.entity, s->counted, &(counted){ .heat = (float)step });
    }
    if (step % 9 == 4) {
        plumb_command_destroy(w, row_body(w, step * 7).entity);
    }
    if (step % 31 == 3) {
        plumb_command_teleport(w, row_body(w, step), (plumb_vec2){ 0, 9 }, R(step) / 10);
    }
}

//---- the world -----------------------------------------------------------------------------------

static void make_ground(plumb_world *w, const script *s)
{
    static const plumb_vec2 hills[] = { { -14, 8 }, { -10, 0 }, { -3, 1 },
                                        { 3, 0 },   { 10, 1 },  { 14, 8 } };
    plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(w, ground,
                       &(plumb_shape_desc){ .kind = PLUMB_CHAIN, .points = hills, .count = 6 });
    plumb_shape_create(
        w, ground,
        &(plumb_shape_desc){
            .kind = PLUMB_BOX, .half = { 1, R(0.25) }, .center = { 6, 3 }, .material = s->belt });
    plumb_shape_create(
        w, ground,
        &(plumb_shape_desc){
            .kind = PLUMB_BOX, .half = { 2, 2 }, .center = { 0, 3 }, .sensor = true });
    plumb_body paddle = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC,
                                                                 .position = { -5, 4 },
                                                                 .angular_velocity = 2 });
    plumb_shape_create(w, paddle,
                       &(plumb_shape_desc){ .kind = PLUMB_CAPSULE,
                                            .points = (plumb_vec2[]){ { -2, 0 }, { 2, 0 } },
                                            .count = 2,
                                            .radius = R(0.2) });
}

// One joint of each kind, on bodies of its own.
static void make_joints(plumb_world *w)
{
    for (int kind = 0; kind <= PLUMB_CABLE; ++kind) {
        plumb_real x = R(kind) * 2 - 10;
        plumb_body pair[2];
        for (int i = 0; i < 2; ++i) {
            pair[i] =
                plumb_body_create(w, &(plumb_body_desc){ .position = { x, 7 + R(i) }, .angle = 1 });
            plumb_shape_create(w, pair[i],
                               &(plumb_shape_desc){ .kind = PLUMB_CIRCLE,
                                                    .radius = R(0.3),
                                                    .filter = { .group = -1 } });
        }
        plumb_joint_desc d = { .kind = (plumb_joint_kind)kind,
                               .body_a = pair[0],
                               .body_b = pair[1],
                               .anchor = { x, R(7.5) },
                               .break_force = kind % 3 == 1 ? R(400) : 0 };
        switch (kind) {
        case PLUMB_DISTANCE:
            d.anchor_b = (plumb_vec2){ x, 8 };
            d.hertz = 2;
            break;
        case PLUMB_PULLEY:
            d.anchor_b = (plumb_vec2){ x, 8 };
            d.ground_a = (plumb_vec2){ x, 10 };
            d.ground_b = (plumb_vec2){ x + 1, 10 };
            break;
        case PLUMB_CABLE:
            d.anchor_b = (plumb_vec2){ x, 8 };
            d.radius_a = R(0.3);
            d.radius_b = R(-0.1);
            break;
        case PLUMB_RATCHET:
            d.pitch = R(0.25);
            break;
        case PLUMB_MOTOR:
        case PLUMB_FRICTION:
            d.max_force = 20;
            d.max_torque = 5;
            break;
        case PLUMB_REVOLUTE:
            d.enable_motor = true;
            d.motor_speed = 3;
            d.max_motor = 10;
            d.enable_limit = true;
            d.lower = -2;
            d.upper = 2;
            break;
        default:
            break;
        }
        assert_false(plumb_is_null(plumb_joint_create(w, &d)));
    }
}

// Components and systems: what an image does not bring along.
static plumb_world *make_empty(script *s, const plumb_world_desc *desc)
{
    plumb_world *w = NULL;
    assert_int_equal(plumb_world_create(desc, &w), PLUMB_OK);
    static const plumb_field fields[] = { { "heat", PLUMB_FIELD_F32, 0, "K" },
                                          { "seen", PLUMB_FIELD_U32, 4, "1" } };
    s->counted = plumb_component_create(
        w, &(plumb_component_desc){
               .name = "counted", .size = sizeof(counted), .fields = fields, .field_count = 2 });
    s->marked = plumb_component_create(w, &(plumb_component_desc){ .name = "marked", .size = 3 });
    s->clock = plumb_component_create(w, &(plumb_component_desc){ .name = "clock", .size = 4 });
    const plumb_system_desc systems[] = {
        { .name = "push", .phase = PLUMB_PHASE_FORCES, .run = push },
        { .name = "edit", .phase = PLUMB_PHASE_CONTACTS, .run = edit },
        { .name = "heat",
          .phase = PLUMB_PHASE_END,
          .run = heat,
          .needs = { s->counted },
          .context = s },
        { .name = "order", .phase = PLUMB_PHASE_END, .run = order, .context = s },
    };
    for (size_t i = 0; i < sizeof systems / sizeof systems[0]; ++i) {
        assert_int_equal(plumb_system_create(w, &systems[i]), PLUMB_OK);
    }
    return w;
}

// Out of the way: a tiled floor with stacks that fall asleep, and a ball that wakes one now and then.
static void make_corner(plumb_world *w)
{
    plumb_body floor =
        plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { 50, 0 } });
    for (int i = 0; i < 8; ++i) {
        plumb_shape_create(w, floor,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                .half = { 1, R(0.5) },
                                                .center = { R(2 * i), 0 } });
    }
    for (int i = 0; i < 16; ++i) {
        plumb_body b = plumb_body_create(
            w, &(plumb_body_desc){ .position = { 50 + R(i % 4) * 3, R(0.9) + R(i / 4) * R(0.8) } });
        plumb_shape_create(w, b,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.4), R(0.4) } });
    }
    // A hero who walks to and fro under a ledge that can be jumped through, and pushes a crate.
    plumb_shape_create(w, floor,
                       &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                            .half = { 2, R(0.1) },
                                            .center = { 18, 2 },
                                            .one_way = { .direction = { 0, 1 } } });
    plumb_shape_create(
        w, floor,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 3, R(0.5) }, .center = { 18, 0 } });
    plumb_body hero = plumb_body_create(
        w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .position = { 68, R(1.5) } });
    plumb_shape_create(
        w, hero,
        &(plumb_shape_desc){ .kind = PLUMB_CAPSULE,
                             .points = (plumb_vec2[]){ { 0, R(-0.4) }, { 0, R(0.4) } },
                             .count = 2,
                             .radius = R(0.3) });
    assert_int_equal(plumb_character_create(w, hero, NULL), PLUMB_OK);
    plumb_body crate = plumb_body_create(w, &(plumb_body_desc){ .position = { 69, R(0.9) } });
    plumb_shape_create(w, crate,
                       &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.3), R(0.3) } });
    plumb_body post =
        plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .position = { 47, 3 } });
    plumb_body ball = plumb_body_create(w, &(plumb_body_desc){ .position = { 47, 6 } });
    plumb_shape_create(w, ball, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.4) });
    plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                               .body_a = post,
                                               .body_b = ball,
                                               .anchor = { 47, 3 },
                                               .anchor_b = { 47, 6 } });
}

// No setting has its default value.
static plumb_world *make_world(script *s, plumb_solver solver)
{
    const plumb_world_desc desc = { .gravity = { R(0.25), -9 },
                                    .y_axis = PLUMB_Y_DOWN,
                                    .solver = solver,
                                    .substeps = 3,
                                    .iterations = 2,
                                    .contact_hertz = 25,
                                    .contact_damping = 2,
                                    .push_speed = 4,
                                    .restitution_speed = R(0.5),
                                    .hit_speed = 2,
                                    .contact_impulses = true,
                                    .sleep_speed = R(0.1),
                                    .sleep_time = R(0.25) };
    plumb_world *w = make_empty(s, &desc);
    s->rubber = plumb_material_create(w, &(plumb_material_desc){ .friction = 1,
                                                                 .kinetic_friction = R(0.5),
                                                                 .restitution = R(0.75) });
    s->ice = plumb_material_create(
        w, &(plumb_material_desc){ .frictionless = true, .rolling_resistance = R(0.01) });
    s->belt =
        plumb_material_create(w, &(plumb_material_desc){ .friction = R(0.8), .surface_speed = 2 });
    plumb_material_pair_set(w, s->rubber, s->ice, &(plumb_material_pair){ .friction = R(0.1) });
    plumb_component_set(w, plumb_entity_create(w), s->clock, NULL);
    make_ground(w, s);
    make_joints(w);
    make_corner(w);
    return w;
}

//---- what is done between steps ------------------------------------------------------------------

static void make_material(plumb_world *w, uint32_t step)
{
    plumb_material m =
        plumb_material_create(w, &(plumb_material_desc){ .friction = R(step % 10) / 10 });
    plumb_body b = row_body(w, step);
    plumb_shape shape;
    if (plumb_body_shapes(w, b, &shape, 1) > 0) {
        plumb_shape_set_material(w, shape, m);
    }
}

// What makes bodies move unlike the rest.
static void act_on_motion(plumb_world *w, uint32_t step, plumb_body a, plumb_body b)
{
    switch (step % 48) {
    case 25:
        plumb_body_set_locks(w, a, (plumb_axis_locks){ .x = true });
        plumb_body_set_locks(w, b, (plumb_axis_locks){ .y = step % 96 == 25 });
        break;
    case 27:
        plumb_body_set_damping(w, a, 1, 2);
        plumb_body_set_damping(w, b, 0, 0);
        break;
    case 29:
        plumb_body_set_speed_cap(w, a, 3, 4);
        break;
    case 31:
        plumb_body_set_time_scale(w, a, R(0.5));
        plumb_body_set_time_scale(w, b, 1);
        break;
    case 33:
        plumb_body_set_continuous(w, a, true);
        plumb_body_set_velocity(w, a, (plumb_vec2){ 90, -20 });
        break;
    case 35:
        plumb_body_set_enabled(w, a, false);
        break;
    case 37:
        plumb_body_set_type(w, a, step % 96 == 37 ? PLUMB_KINEMATIC : PLUMB_STATIC);
        break;
    case 39: {
        plumb_body_span span = plumb_world_bodies(w);
        if (span.kinematic_count > 0) {
            plumb_body_set_target(w, span.body[span.dynamic_count], (plumb_vec2){ 1, 5 }, 0,
                                  R(0.5));
        }
        if (span.kinematic_count > 1) {
            plumb_body_set_target_moving(w, span.body[span.dynamic_count + 1], (plumb_vec2){ 3, 5 },
                                         1, (plumb_vec2){ 1, -1 }, 2, R(0.6));
        }
        break;
    }
    case 41:
        plumb_world_explode(w, &(plumb_explosion_desc){ .position = { R(step % 7) - 3, 1 },
                                                        .radius = 2,
                                                        .falloff = 1,
                                                        .impulse = R(0.5) });
        break;
    case 43:
        plumb_body_sleep(w, a);
        break;
    case 45: {
        plumb_joint joint;
        if (plumb_world_joints(w, &joint, 1) > 0) {
            plumb_joint_set_enabled(w, joint, step % 96 == 45);
        }
        break;
    }
    case 46: {
        plumb_body_span span = plumb_world_bodies(w);
        for (int i = span.dynamic_count; i < span.dynamic_count + span.kinematic_count; ++i) {
            if (plumb_body_is_character(w, span.body[i])) {
                plumb_character_walk(w, span.body[i], step % 96 == 46 ? 2 : -2);
                plumb_character_jump(w, span.body[i], 6);
                plumb_character_drop(w, span.body[i]);
            }
        }
        break;
    }
    case 47:
        plumb_body_set_no_sleep(w, b, step % 96 == 47);
        break;
    default:
        break;
    }
}

// A direct call between two steps.
static void act(plumb_world *w, const script *s)
{
    uint32_t step = (uint32_t)plumb_world_stats(w).step_count;
    plumb_body a = row_body(w, step), b = row_body(w, step * 3 + 1);
    switch (step % 48) {
    case 0:
        plumb_body_apply_impulse_center(w, a, (plumb_vec2){ 0, R(0.5) });
        break;
    case 3:
        plumb_body_set_velocity(w, a, (plumb_vec2){ 3, 1 });
        break;
    case 5:
        plumb_world_exclude_pair(w, a, b, step % 96 == 5);
        break;
    case 7:
        plumb_component_set(w, a.entity, s->marked, "ab");
        break;
    case 9:
        plumb_world_set_gravity(w, (plumb_vec2){ R(step % 5) - 2, -9 });
        break;
    case 11:
        make_material(w, step);
        break;
    case 13:
        plumb_joint_create(
            w, &(plumb_joint_desc){
                   .kind = PLUMB_DISTANCE, .body_a = a, .body_b = b, .length = 1, .hertz = 1 });
        break;
    case 15:
        plumb_body_set_fixed_rotation(w, a, step % 96 == 15);
        break;
    case 17:
        plumb_system_enable(w, "push", step % 96 == 17);
        break;
    case 19:
        plumb_world_set_hit_speed(w, step % 96 == 19 ? 0 : 1);
        break;
    case 21:
        plumb_shape_create(
            w, a,
            &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.2), .center = { R(0.3), 0 } });
        break;
    case 23:
        plumb_body_destroy(w, b);
        break;
    default:
        act_on_motion(w, step, a, b);
        break;
    }
}

static void step(plumb_world *world, void *context)
{
    const script *s = context;
    uint32_t *clock = plumb_world_column(world, s->clock).values;
    *clock = !*clock;
    if (*clock) {
        act(world, context);
    } else {
        assert_int_equal(plumb_world_step(world, R(1.0 / 60)), PLUMB_OK);
    }
}

// `turns`: going back is into a world that was empty at first, with other settings.
static void roll(plumb_solver solver, int all, bool frames, bool turns)
{
    static uint64_t hashes[2 * STEPS + 1];
    const int steps = trials_steps(all);
    script s = { 0 };
    plumb_world *straight = make_world(&s, solver), *rolled = make_world(&s, solver);
    plumb_world *other = turns ? make_empty(&s, NULL) : NULL;
    rollback_reference(straight, step, &s, 2 * steps, hashes);
    int times = rollback_run(rolled, other, step, &s, 2 * steps, 24, frames, hashes);
    assert_in_range(times, steps / 4, steps);
    print_message("went back %d times in %d steps; %u bodies, %u contacts at the end\n", times,
                  steps, plumb_world_stats(straight).body_count,
                  plumb_world_stats(straight).contact_count);
    plumb_world_destroy(straight);
    plumb_world_destroy(rolled);
    plumb_world_destroy(other);
}

static void whole_images_in_the_soft_step(void **state)
{
    (void)state;
    roll(PLUMB_SOLVER_SOFT, STEPS, false, false);
}

static void frames_in_the_soft_step(void **state)
{
    (void)state;
    roll(PLUMB_SOLVER_SOFT, STEPS, true, true);
}

static void whole_images_in_the_classic_solver(void **state)
{
    (void)state;
    roll(PLUMB_SOLVER_PGS, STEPS, false, true);
}

static void whole_images_in_the_exact_solver(void **state)
{
    (void)state;
    roll(PLUMB_SOLVER_EXACT, STEPS / 4, false, true);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whole_images_in_the_soft_step),
        cmocka_unit_test(frames_in_the_soft_step),
        cmocka_unit_test(whole_images_in_the_classic_solver),
        cmocka_unit_test(whole_images_in_the_exact_solver),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
