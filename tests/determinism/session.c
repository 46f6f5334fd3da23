// session.c - see session.h.
#include "session.h"

#include "harness/random.h"

#include <string.h>

#define R(x)      ((plumb_real)(x))
#define SOMETHING ((void *)(uintptr_t)64) // a pointer of the user's, the same in every session

typedef struct mark {
    float heat;
    uint32_t hits;
    plumb_body other;
    bool hot; // with padding behind it
} mark;

static double uniform(session *s, double low, double high)
{
    return sim_uniform(&s->seed, low, high);
}

static uint32_t pick(session *s, uint32_t count)
{
    return sim_random(&s->seed) % count;
}

static bool one_in(session *s, uint32_t count)
{
    return pick(s, count) == 0;
}

static plumb_real number(session *s, double low, double high)
{
    return R(uniform(s, low, high));
}

static plumb_vec2 place(session *s, double left, double right, double low, double high)
{
    plumb_real x = number(s, left, right);
    return (plumb_vec2){ x, number(s, low, high) };
}

//---- systems and hooks: what they do follows from the world alone --------------------------------

static uint64_t steps_of(const plumb_world *w)
{
    return plumb_world_stats(w).step_count;
}

static plumb_body body_by(plumb_world *w, uint64_t salt)
{
    plumb_body_span b = plumb_world_bodies(w);
    plumb_body none = PLUMB_NULL_INIT;
    return b.dynamic_count == 0 ? none : b.body[salt % (uint64_t)b.dynamic_count];
}

// Commands of every kind.
static void give_command(const session *s, plumb_body who, uint32_t salt)
{
    plumb_world *w = s->world;
    plumb_vec2 dart[] = { { R(-0.3), 0 }, { 0, R(-0.3) }, { R(0.3), 0 }, { 0, R(0.3) } };
    const plumb_shape_desc shapes[] = {
        { .kind = PLUMB_CIRCLE, .radius = R(0.2), .user_data = SOMETHING },
        { .kind = PLUMB_OUTLINE, .points = dart, .count = 4 },
        { .kind = PLUMB_CAPSULE, .points = dart, .count = 2, .radius = R(0.1) },
    };
    mark value;
    memset(&value, 0, sizeof value); // padding, too: it is saved
    value.heat = (float)salt;
    value.other = who;
    value.hot = true;
    plumb_body made = PLUMB_NULL_INIT;
    const plumb_vec2 at = plumb_body_center(w, who);
    switch (salt % 11) {
    case 0:
        made = plumb_command_body_create(
            w, &(plumb_body_desc){ .position = { R(salt % 9) - 4, 6 }, .user_data = SOMETHING });
        plumb_command_shape_create(w, made, &shapes[salt % 3]);
        plumb_command_component_set(w, made.entity, s->mark, &value);
        break;
    case 1:
        plumb_command_component_set(w, plumb_command_entity_create(w), s->mark, &value);
        break;
    case 2:
        plumb_command_shape_create(w, who, &shapes[salt / 7 % 3]);
        break;
    case 3:
        plumb_command_teleport(w, who, (plumb_vec2){ R(salt % 5), 5 }, R(salt % 3));
        break;
    case 4:
        plumb_command_component_set(w, who.entity, s->mark, salt % 2 ? &value : NULL);
        break;
    case 5:
        plumb_command_component_remove(w, who.entity, s->mark);
        break;
    case 6:
        plumb_command_body_cut(w, who, at, (plumb_vec2){ R(salt % 7) - 3, 1 });
        break;
    case 7:
        plumb_command_body_shatter(w, who,
                                   &(plumb_shatter_desc){ .point = at, .cells = 4, .seed = salt });
        break;
    case 8:
        plumb_command_body_merge(w, who, body_by(w, salt / 11));
        break;
    case 9:
        plumb_command_body_scale(w, who, salt % 2 ? R(1.25) : R(0.8));
        break;
    default:
        plumb_command_destroy(w, who.entity);
        break;
    }
}

// A hook is called at any time: also within a step, by a joint that breaks.
static void on_mark(plumb_world *w, plumb_entity entity, void *value, void *context)
{
    const session *s = context;
    mark *m = value;
    m->hits += 1;
    if (entity.index % 3 == 0) {
        uint64_t salt = entity.index + steps_of(w);
        give_command(s, body_by(w, salt), (uint32_t)salt);
    }
    mark *other = plumb_component_get(w, m->other.entity, s->mark);
    if (other != NULL) {
        other->heat += 0.5f;
    }
}

static void on_tag(plumb_world *w, plumb_entity entity, void *value, void *context)
{
    const session *s = context;
    (void)value;
    plumb_body_apply_impulse_center(w, body_by(w, entity.index), (plumb_vec2){ R(0.3), R(0.2) });
    give_command(s, body_by(w, steps_of(w)), entity.index + entity.generation);
}

static void at_begin(const plumb_system_call *call)
{
    const session *s = call->context;
    plumb_component_span span = plumb_world_column(call->world, s->mark);
    for (int i = 0; i < span.count; ++i) {
        ((mark *)span.values)[i].heat *= 0.75f;
    }
    if (steps_of(call->world) % 3 == 0) {
        plumb_body_wake(call->world, body_by(call->world, steps_of(call->world)));
    }
}

static void at_forces(const plumb_system_call *call)
{
    plumb_body_span b = plumb_world_bodies(call->world);
    for (int i = 0; i < b.dynamic_count; i += 3) {
        b.fx[i] += R(0.5);
    }
}

static void at_contacts(const plumb_system_call *call)
{
    for (int i = 0; i < plumb_contact_edit_count(call->world); i += 3) {
        plumb_contact_edit e;
        assert_int_equal(plumb_contact_edit_get(call->world, i, &e), PLUMB_OK);
        e.enabled = (e.shape_a.entity.index + steps_of(call->world) / 8) % 5 != 0;
        e.friction = R(0.1);
        plumb_contact_edit_set(call->world, i, &e);
    }
    if (steps_of(call->world) % 5 == 1) {
        plumb_body_set_velocity(call->world, body_by(call->world, 3), (plumb_vec2){ 1, 1 });
    }
}

static void at_end(const plumb_system_call *call)
{
    const session *s = call->context;
    uint32_t step = (uint32_t)steps_of(call->world);
    if (step % 4 == 0) {
        give_command(s, body_by(call->world, step * 7), step / 4);
    }
}

static void register_late(session *s)
{
    s->late = plumb_component_create(
        s->world, &(plumb_component_desc){ .name = "late", .size = sizeof(double) });
}

static void register_all(session *s)
{
    static const plumb_field fields[] = {
        { "heat", PLUMB_FIELD_F32, offsetof(mark, heat), "K" },
        { "hits", PLUMB_FIELD_U32, offsetof(mark, hits), "1" },
        { "hot", PLUMB_FIELD_BOOL, offsetof(mark, hot), "1" },
    };
    const plumb_component_desc components[] = {
        { .name = "mark",
          .size = sizeof(mark),
          .fields = fields,
          .field_count = 3,
          .on_add = on_mark,
          .on_remove = on_mark,
          .context = s },
        { .name = "tag", .size = 3, .on_add = on_tag, .on_remove = on_tag, .context = s },
    };
    s->mark = plumb_component_create(s->world, &components[0]);
    s->tag = plumb_component_create(s->world, &components[1]);
    const plumb_system_desc systems[] = {
        { .name = "cool", .phase = PLUMB_PHASE_BEGIN, .run = at_begin, .needs = { s->mark } },
        { .name = "wind", .phase = PLUMB_PHASE_FORCES, .run = at_forces },
        { .name = "ice", .phase = PLUMB_PHASE_CONTACTS, .run = at_contacts },
        { .name = "rules", .phase = PLUMB_PHASE_END, .run = at_end },
    };
    for (size_t i = 0; s->has_systems && i < sizeof systems / sizeof systems[0]; ++i) {
        plumb_system_desc d = systems[i];
        d.context = s;
        plumb_system_create(s->world, &d);
    }
}

//---- what is made --------------------------------------------------------------------------------

static plumb_shape_desc shape_of(session *s)
{
    static const plumb_vec2 ell[] = { { 0, 0 },           { 1, 0 },      { 1, R(0.5) },
                                      { R(0.5), R(0.5) }, { R(0.5), 1 }, { 0, 1 } };
    static const plumb_vec2 gem[] = {
        { R(-0.4), 0 }, { R(-0.1), R(-0.3) }, { R(0.3), R(-0.2) }, { R(0.4), R(0.2) }, { 0, R(0.4) }
    };
    plumb_shape_desc d = { .material = s->material[pick(s, SESSION_MATERIALS)],
                           .user_data = one_in(s, 3) ? SOMETHING : NULL };
    d.sensor = one_in(s, 10);
    if (one_in(s, 6)) {
        d.filter = (plumb_filter){ .category = 2, .mask = one_in(s, 2) ? 1 : 3 };
    }
    switch (pick(s, 7)) {
    case 0:
        d.kind = PLUMB_CIRCLE;
        d.radius = number(s, 0.1, 0.5);
        break;
    case 1:
        d.kind = PLUMB_CAPSULE;
        d.points = ell;
        d.count = 2;
        d.radius = R(0.2);
        break;
    case 2:
        d.kind = PLUMB_OUTLINE;
        d.points = ell;
        d.count = 6;
        break;
    case 3:
        d.kind = PLUMB_POLYGON;
        d.points = gem;
        d.count = 5;
        d.radius = one_in(s, 2) ? R(0.05) : 0;
        break;
    case 4:
        d.kind = PLUMB_CHAIN;
        d.points = ell;
        d.count = 6;
        d.closed = one_in(s, 2);
        break;
    default:
        d.kind = PLUMB_BOX;
        d.half = (plumb_vec2){ number(s, 0.2, 0.9), R(0.3) };
        break;
    }
    return d;
}

static void add_shape(session *s, plumb_body body, bool ground)
{
    plumb_shape_desc d = shape_of(s);
    if (ground && d.kind == PLUMB_BOX) {
        d.half = (plumb_vec2){ R(0.5), R(0.25) };
        d.one_way.direction.y = !d.sensor && one_in(s, 3) ? 1 : 0;
    }
    plumb_shape_create(s->world, body, &d);
}

static void make_body(session *s, uint32_t i)
{
    const uint32_t type = pick(s, 8);
    plumb_body_desc d = { .position = place(s, -6, 6, 0.5, 5), .user_data = SOMETHING };
    d.angle = one_in(s, 3) ? number(s, -3, 3) : 0;
    if (type == 0) {
        d.type = PLUMB_STATIC;
        d.position = (plumb_vec2){ R(pick(s, 13)) - 6, R(0.5) * R(pick(s, 8)) - R(0.25) };
        d.angle = 0;
    } else if (type == 1) {
        d.type = PLUMB_KINEMATIC;
        d.velocity.x = number(s, -1, 1);
    } else {
        d.asleep = one_in(s, 6);
        d.continuous = one_in(s, 4);
        d.disabled = one_in(s, 12);
        d.velocity = d.asleep ? d.velocity : place(s, -3, 3, -3, 3);
        d.damping = one_in(s, 5) ? R(0.5) : 0;
    }
    s->body[i] = plumb_body_create(s->world, &d);
    for (uint32_t k = pick(s, 3); k < 3; ++k) {
        add_shape(s, s->body[i], type == 0);
    }
    if (type > 0 && one_in(s, 6)) {
        plumb_character_create(s->world, s->body[i], NULL);
        plumb_character_walk(s->world, s->body[i], number(s, -2, 2));
    }
}

static void make_joint(session *s, uint32_t i)
{
    plumb_body a = s->body[pick(s, SESSION_BODIES)], b = s->body[pick(s, SESSION_BODIES)];
    plumb_joint_desc d = { .kind = (plumb_joint_kind)pick(s, 12), .body_a = a, .body_b = b };
    d.anchor = plumb_body_position(s->world, a);
    if (d.kind == PLUMB_DISTANCE || d.kind == PLUMB_PULLEY || d.kind == PLUMB_CABLE) {
        d.anchor_b = plumb_body_position(s->world, b);
    }
    d.radius_a = d.kind == PLUMB_CABLE ? R(0.2) : 0;
    if (d.kind == PLUMB_PULLEY) {
        d.ground_a = (plumb_vec2){ 0, 9 };
        d.ground_b = (plumb_vec2){ 1, 9 };
    }
    d.pitch = d.kind == PLUMB_RATCHET ? R(0.3) : 0;
    d.break_force = one_in(s, 2) ? number(s, 1, 100) : 0;
    d.break_impulse = one_in(s, 4) ? number(s, 0.1, 5) : 0;
    d.user_data = SOMETHING;
    s->joint[i] = plumb_joint_create(s->world, &d);
    if (plumb_joint_valid(s->world, s->joint[i])) {
        plumb_component_set(s->world, s->joint[i].entity, one_in(s, 2) ? s->tag : s->mark, NULL);
    }
}

static void make_ground(session *s)
{
    plumb_body tiles = plumb_body_create(s->world, &(plumb_body_desc){ .type = PLUMB_STATIC });
    for (int i = -8; i <= 8; ++i) {
        plumb_shape_create(s->world, tiles,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                .half = { R(0.5), R(0.25) },
                                                .center = { R(i), R(-0.75) },
                                                .material = s->material[0] });
    }
}

static plumb_world_desc desc_of(session *s, const plumb_world_desc *settings)
{
    plumb_world_desc d = settings == NULL ? (plumb_world_desc){ 0 } : *settings;
    d.solver = one_in(s, 4)   ? PLUMB_SOLVER_PGS
               : one_in(s, 6) ? PLUMB_SOLVER_EXACT
                              : PLUMB_SOLVER_SOFT;
    d.sleep_time = one_in(s, 4) ? 0 : R(0.1);
    d.hit_speed = one_in(s, 2) ? 1 : 0;
    d.contact_impulses = one_in(s, 4);
    s->wrapped = one_in(s, 5);
    d.wrap_x = s->wrapped ? 14 : 0;
    return d;
}

void session_begin(session *s, uint32_t seed, const plumb_world_desc *settings)
{
    *s = (session){ .seed = seed * 2654435761u | 1 };
    const plumb_world_desc d = desc_of(s, settings);
    assert_int_equal(plumb_world_create(&d, &s->world), PLUMB_OK);
    s->has_systems = one_in(s, 2);
    register_all(s);
    for (uint32_t i = 0; i < SESSION_MATERIALS; ++i) {
        const plumb_material_desc m = { .friction = number(s, 0, 1),
                                        .restitution = one_in(s, 3) ? R(0.5) : 0,
                                        .surface_speed = one_in(s, 6) ? 1 : 0,
                                        .adhesion = one_in(s, 8) ? 5 : 0,
                                        .kinetic_friction = one_in(s, 4) ? R(0.2) : 0,
                                        .refractive_index = i % 3 == 1 ? R(1.5) : 0,
                                        .reflectance = i % 3 == 2 ? R(0.7) : 0 };
        s->material[i] = plumb_material_create(s->world, &m);
    }
    make_ground(s);
    for (uint32_t i = 0; i < SESSION_BODIES / 2; ++i) {
        make_body(s, i);
    }
    for (uint32_t i = 0; i < SESSION_JOINTS / 2; ++i) {
        make_joint(s, i);
    }
}

void session_twin(session *s, const session *like, const plumb_world_desc *settings)
{
    *s = *like;
    const plumb_world_desc d = settings == NULL ? (plumb_world_desc){ 0 } : *settings;
    assert_int_equal(plumb_world_create(&d, &s->world), PLUMB_OK);
    register_all(s);
    if (like->late.id != 0) {
        register_late(s);
    }
}

//---- what is done --------------------------------------------------------------------------------

static plumb_shape shape_on(session *s, plumb_body body)
{
    plumb_shape shapes[8];
    int count = plumb_body_shapes(s->world, body, shapes, 8);
    plumb_shape none = PLUMB_NULL_INIT;
    return count <= 0 ? none : shapes[pick(s, (uint32_t)(count < 8 ? count : 8))];
}

static void change_motion(session *s, plumb_body b)
{
    plumb_world *w = s->world;
    switch (pick(s, 11)) {
    case 0:
        plumb_body_apply_impulse_center(w, b, place(s, -2, 2, 0, 3));
        break;
    case 1:
        plumb_body_set_velocity(w, b, place(s, -8, 8, -8, 8));
        break;
    case 2:
        plumb_body_teleport(w, b, place(s, -6, 6, 0, 5), number(s, -3, 3));
        break;
    case 3:
        if (one_in(s, 2)) {
            plumb_body_set_target(w, b, place(s, -6, 6, 0, 5), 1, R(0.2));
        } else {
            plumb_body_set_target_moving(w, b, place(s, -6, 6, 0, 5), 1, place(s, -3, 3, -3, 3), 2,
                                         R(0.3));
        }
        break;
    case 4:
        plumb_body_set_time_scale(w, b, one_in(s, 3) ? 0 : number(s, 0.2, 2));
        break;
    case 5:
        plumb_body_set_damping(w, b, one_in(s, 2) ? R(0.3) : 0, 0);
        plumb_body_set_drag(w, b, one_in(s, 2) ? R(0.1) : 0);
        plumb_body_set_thrust(w, b, one_in(s, 3) ? R(2) : 0);
        plumb_body_set_exhaust(w, b, 20);
        plumb_body_set_fuel(w, b, R(0.2));
        plumb_body_set_thrust_x(w, b, R(0.1));
        plumb_body_set_thrust_angle(w, b, number(s, -3, 3));
        break;
    case 10:
        plumb_body_set_temperature(w, b, one_in(s, 3) ? 0 : number(s, 200, 900));
        plumb_body_set_conductance(w, b, one_in(s, 2) ? 500 : 0);
        plumb_body_set_emissivity(w, b, R(0.5));
        plumb_body_set_melting_point(w, b, one_in(s, 2) ? 400 : 0);
        plumb_body_set_latent_heat(w, b, 2000);
        plumb_body_set_ignition(w, b, one_in(s, 3) ? 600 : 0);
        plumb_body_set_burn_rate(w, b, R(0.02));
        plumb_body_set_growth(w, b, one_in(s, 4) ? number(s, -0.5, 0.2) : 0);
        plumb_body_set_smallest(w, b, R(0.1));
        break;
    case 6:
        plumb_body_set_speed_cap(w, b, one_in(s, 2) ? 2 : 0, 0);
        break;
    case 7:
        plumb_body_set_locks(w, b, (plumb_axis_locks){ .x = one_in(s, 2), .y = one_in(s, 3) });
        break;
    case 8:
        plumb_body_apply_torque(w, b, number(s, -1, 1));
        break;
    default:
        plumb_world_explode(w, &(plumb_explosion_desc){ .position = place(s, -5, 5, 0, 3),
                                                        .radius = 2,
                                                        .impulse = 1,
                                                        .occlusion = (plumb_occlusion)pick(s, 3) });
        break;
    }
}

static void change_body(session *s, plumb_body b, uint32_t i)
{
    plumb_world *w = s->world;
    switch (pick(s, 11)) {
    case 0:
    case 1:
        plumb_body_destroy(w, b);
        make_body(s, i);
        break;
    case 2:
        plumb_body_set_enabled(w, b, one_in(s, 2));
        break;
    case 3:
        plumb_body_set_type(w, b, (plumb_body_type)pick(s, 3));
        break;
    case 4:
        plumb_body_sleep(w, b);
        break;
    case 5:
        plumb_body_wake(w, b);
        break;
    case 6:
        plumb_body_set_mass(w, b, number(s, 0.1, 5));
        break;
    case 7:
        plumb_body_set_fixed_rotation(w, b, one_in(s, 2));
        break;
    case 8:
        plumb_world_exclude_pair(w, b, s->body[pick(s, SESSION_BODIES)], one_in(s, 2));
        break;
    case 9:
        plumb_character_create(w, b, NULL);
        plumb_character_jump(w, b, 4);
        break;
    case 10:
        plumb_character_walk(w, b, number(s, -2, 2));
        plumb_character_drop(w, b);
        plumb_body_drop_through(w, b);
        break;
    default:
        plumb_character_destroy(w, b);
        break;
    }
}

static void change_shape(session *s, plumb_body b)
{
    plumb_world *w = s->world;
    plumb_shape shape = shape_on(s, b);
    plumb_shape_desc d = shape_of(s);
    switch (pick(s, 8)) {
    case 0:
    case 1:
        add_shape(s, b, false);
        break;
    case 2:
        plumb_shape_destroy(w, shape);
        break;
    case 3:
        plumb_shape_set_geometry(w, shape,
                                 &(plumb_shape_desc){ .kind = d.kind,
                                                      .radius = d.radius,
                                                      .half = d.half,
                                                      .points = d.points,
                                                      .count = d.count,
                                                      .closed = d.closed });
        break;
    case 4:
        plumb_shape_set_filter(w, shape, (plumb_filter){ .group = one_in(s, 2) ? -1 : 0 });
        break;
    case 5:
        plumb_shape_set_sensor(w, shape, one_in(s, 3));
        break;
    case 6:
        plumb_shape_set_material(w, shape, s->material[pick(s, SESSION_MATERIALS)]);
        break;
    default:
        plumb_shape_set_one_way(w, shape, (plumb_one_way){ { 0, one_in(s, 2) ? 1 : 0 }, 0 });
        break;
    }
}

static void change_joint(session *s)
{
    uint32_t i = pick(s, SESSION_JOINTS);
    switch (pick(s, 6)) {
    case 0:
    case 1:
        make_joint(s, i);
        break;
    case 2:
        plumb_joint_destroy(s->world, s->joint[i]);
        break;
    case 3:
        plumb_joint_set_break(s->world, s->joint[i], number(s, 1, 40), 0);
        break;
    case 4:
        plumb_joint_set_motor(s->world, s->joint[i], one_in(s, 2), 2, 10);
        break;
    default:
        plumb_joint_set_enabled(s->world, s->joint[i], one_in(s, 2));
        break;
    }
}

// Pours some, takes some away; worlds that wrap refuse it.
static void change_liquid(session *s)
{
    plumb_world *w = s->world;
    const plumb_vec2 at = place(s, -4, 3, 0, 2), far = { at.x + R(0.6), at.y + R(0.3) };
    plumb_particle like = { .velocity = place(s, -2, 2, -1, 1), .tag = 3 };
    plumb_liquid_desc d;
    if (plumb_liquid_settings(w, &d) != PLUMB_OK) {
        plumb_liquid_create(w, &(plumb_liquid_desc){ .spacing = R(0.1) });
    } else if (one_in(s, 2)) { // soon: it takes most of a step
        plumb_liquid_destroy(w);
        return;
    } else if (one_in(s, 4)) {
        plumb_liquid_remove(w, at, far);
    } else if (one_in(s, 4)) {
        plumb_liquid_set(w, &(plumb_liquid_desc){ .density = 700, .viscosity = 1 });
    }
    if (one_in(s, 2)) {
        const plumb_liquid_phase oil = { .density = number(s, 300, 2000),
                                         .viscosity = number(s, 0, 1),
                                         .friction = one_in(s, 2) ? number(s, 0, 1) : 0 };
        like.phase = 1;
        plumb_liquid_set_phases(w, &oil, 1);
    }
    plumb_liquid_add_box(w, at, far, &like);
}

// A box of air, what is in it, what feeds it; worlds that wrap refuse it.
static void change_air(session *s)
{
    plumb_world *w = s->world;
    const plumb_air_source source = { .position = place(s, -2, 2, 0, 2),
                                      .radius = number(s, 0, 1) + R(0.1),
                                      .smoke = number(s, 0, 5),
                                      .heat = number(s, -90, 90),
                                      .push = place(s, -9, 9, -9, 9),
                                      .body = one_in(s, 2) ? s->body[pick(s, SESSION_BODIES)]
                                                           : s->body[0] };
    plumb_air_desc d = { .position = place(s, -2, 2, 1, 2),
                         .half = { 2, 1 },
                         .cell = R(0.25),
                         .viscosity = one_in(s, 2) ? R(0.02) : 0,
                         .bottom = PLUMB_AIR_CLOSED,
                         .left = one_in(s, 2) ? PLUMB_AIR_FLOW : PLUMB_AIR_OPEN,
                         .flow = { 1, 0 } };
    if (plumb_air_create(w, &d) == PLUMB_OK) {
        plumb_air_set_sources(w, &source, 1);
    } else if (one_in(s, 2)) { // soon: it takes most of a step
        plumb_air_destroy(w);
    } else if (plumb_air_settings(w, &d) == PLUMB_OK) {
        d.right = PLUMB_AIR_CLOSED;
        plumb_air_set(w, &d);
        plumb_air_set_sources(w, &source, one_in(s, 2));
    }
}

// Water with waves, made and taken away; worlds that wrap refuse it.
static void change_waves(session *s)
{
    plumb_world *w = s->world;
    plumb_shape shape;
    const plumb_wave_mode splash[2] = { { 0.05, 0.1 }, { -0.1, 0.2 } };
    if (plumb_world_waves(w, &shape, 1) > 0) {
        if (one_in(s, 2)) {
            plumb_body_destroy(w, plumb_shape_body(w, shape));
        } else if (one_in(s, 2)) {
            plumb_waves_set(w, shape, &(plumb_waves_desc){ .modes = 1 + (int)pick(s, 20) });
        } else {
            plumb_waves_set_modes(w, shape, splash, one_in(s, 2) ? 1 : 0);
        }
        return;
    }
    const plumb_material m =
        plumb_material_create(w, &(plumb_material_desc){ .density = 900, .fluid = true });
    const plumb_body holder = plumb_body_create(
        w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = place(s, -2, 2, -1, 1) });
    shape = plumb_shape_create(
        w, holder,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 3, 1 }, .sensor = true, .material = m });
    plumb_waves_create(w, shape,
                       &(plumb_waves_desc){ .modes = 1 + (int)pick(s, 30),
                                            .swell = one_in(s, 2) ? R(0.05) : 0,
                                            .no_damping = one_in(s, 3) });
}

// Bodies are cut, shatter, become one, grow, and may break.
static void change_fracture(session *s)
{
    plumb_world *w = s->world;
    const plumb_body b = s->body[pick(s, SESSION_BODIES)], other = s->body[pick(s, SESSION_BODIES)];
    const plumb_vec2 aside = place(s, -0.3, 0.3, -0.3, 0.3), along = place(s, -1, 1, -1, 1);
    const plumb_vec2 at = plumb_body_position(w, b);
    const plumb_vec2 point = { at.x + aside.x, at.y + aside.y };
    const plumb_real factor = number(s, 0.6, 1.5);
    plumb_body parts[8];
    switch (pick(s, 5)) {
    case 0:
        plumb_body_cut(w, b, point, along, parts, 8);
        break;
    case 1:
        plumb_body_shatter(
            w, b, &(plumb_shatter_desc){ .point = point, .cells = 5, .seed = pick(s, 1000) }, parts,
            8);
        break;
    case 2:
        plumb_body_merge(w, b, other, NULL);
        break;
    case 3:
        plumb_body_scale(w, b, factor);
        break;
    default:
        plumb_body_set_break_impulse(w, b, one_in(s, 3) ? 0 : number(s, 0.1, 5));
        plumb_body_set_break_force(w, b, one_in(s, 3) ? number(s, 1, 500) : 0);
        plumb_body_set_break_cells(w, b, 4);
        break;
    }
}

// Whether soft bodies sleep, and those that hold them.
static void change_soft_sleep(session *s, plumb_softbody soft)
{
    plumb_world *w = s->world;
    switch (pick(s, 4)) {
    case 0:
        plumb_softbody_sleep(w, soft);
        break;
    case 1:
        plumb_softbody_wake(w, soft);
        break;
    case 2:
        plumb_softbody_set_no_sleep(w, soft, !plumb_softbody_no_sleep(w, soft));
        break;
    default:
        plumb_softbody_hold(w, soft, 1, s->body[pick(s, SESSION_BODIES)], plumb_v2(0, 0));
        break;
    }
}

// Ropes between a body and a place, jelly, skins: made, cut, taken away. Worlds that wrap refuse them.
static void change_softbodies(session *s)
{
    plumb_world *w = s->world;
    plumb_softbody all[4];
    const int count = plumb_world_softbodies(w, all, 4);
    const plumb_vec2 at = place(s, -2, 2, 1, 2), far = place(s, 2, 3, 2, 3);
    const bool first = one_in(s, 2), second = one_in(s, 2);
    const uint32_t which = pick(s, 4), edge = pick(s, 6);
    if (count > 0 && one_in(s, 3)) {
        change_soft_sleep(s, all[which % (uint32_t)(count < 4 ? count : 4)]);
        return;
    }
    if (count > 2 || (count > 0 && first && second)) {
        plumb_softbody_destroy(w, all[which % (uint32_t)count]);
    } else if (count > 0 && first) {
        plumb_softbody_desc d;
        if (plumb_softbody_settings(w, all[which % (uint32_t)count], &d) == PLUMB_OK &&
            (int)edge < d.edge_count) {
            plumb_softbody_edge torn = d.edges[edge];
            torn.flags |= PLUMB_EDGE_TORN;
            plumb_softbody_set_edge(w, all[which % (uint32_t)count], (int)edge, &torn);
        }
    } else if (second) {
        plumb_skin_create(w, &(plumb_skin_desc){ .center = at, .radius = R(0.4), .nodes = 10 });
    } else {
        plumb_rope_create(w, &(plumb_rope_desc){ .from = at,
                                                 .to = far,
                                                 .nodes = 7,
                                                 .break_strain = R(0.1),
                                                 .hold_from = true,
                                                 .to_body = s->body[which] });
    }
}

// Makes one of any kind, or changes or takes away another; worlds that wrap refuse them.
static void change_laws(session *s)
{
    plumb_world *w = s->world;
    plumb_law laws[4];
    const int count = plumb_world_laws(w, laws, 4);
    static const char *const formulas[][3] = {
        { "-2 * x - 0.1 * vx * hypot(vx, vy)", "cos(3 * t) - y", NULL },
        { NULL, "3 * step(sin(t)) / r", NULL },
        { NULL, NULL, "(x^2 - 1)^2 + 0.5 * y^2 - exp(-r^2)" },
        { NULL, NULL, "0.2 * sin(4 * x - t) * y" },
    };
    const plumb_law_kind kind = (plumb_law_kind)pick(s, 5);
    const bool is_formula = kind == PLUMB_LAW_FORMULA;
    const char *const *formula = formulas[pick(s, 4)];
    const bool zone = kind == PLUMB_LAW_UNIFORM || kind == PLUMB_LAW_MAGNETIC || is_formula;
    const plumb_body body = s->body[pick(s, SESSION_BODIES)];
    const plumb_law_desc d = {
        .kind = kind,
        .hold = one_in(s, 4) ? PLUMB_LAW_ON_CHARGE : PLUMB_LAW_ON_MASS,
        .falloff = (plumb_falloff)pick(s, 5),
        .combine = (kind == PLUMB_LAW_UNIFORM || is_formula) && one_in(s, 3) ? PLUMB_LAW_REPLACE
                                                                             : PLUMB_LAW_ADD,
        .body = kind != PLUMB_LAW_MUTUAL && one_in(s, 2) ? body : (plumb_body)PLUMB_NULL_INIT,
        .position = place(s, -3, 3, 0, 4),
        .vector = place(s, -5, 5, -5, 5),
        .strength = number(s, -3, 3),
        .softening = number(s, R(0.1), 1),
        .radius = zone ? 0 : number(s, 1, 9),
        .half = zone && one_in(s, 2) ? plumb_v2(3, 2) : plumb_v2(0, 0),
        .formula_x = is_formula ? formula[0] : NULL,
        .formula_y = is_formula ? formula[1] : NULL,
        .potential = is_formula ? formula[2] : NULL
    };
    plumb_body_set_charge(w, body, number(s, -1, 1));
    plumb_body_set_dipole(w, s->body[pick(s, SESSION_BODIES)], number(s, R(-0.2), R(0.2)));
    plumb_body_set_dipole_angle(w, body, number(s, -3, 3));
    plumb_body_set_attraction(w, body, one_in(s, 2) ? 1 : 0);
    plumb_world_set_orbits(w,
                           &(plumb_orbit_desc){ one_in(s, 2) ? 4 : 2, one_in(s, 3) ? R(1e-4) : 0 });
    if (count < 4 && one_in(s, 2)) {
        plumb_law_create(w, &d);
    } else if (count > 0 && one_in(s, 2)) {
        plumb_law_set(w, laws[0], &d);
    } else if (count > 0) {
        plumb_law_destroy(w, laws[count - 1]);
    }
}

static void change_world(session *s)
{
    plumb_world *w = s->world;
    uint32_t m = pick(s, SESSION_MATERIALS);
    switch (pick(s, 14)) {
    case 0:
        plumb_world_set_gravity(w, place(s, -2, 2, -12, 0));
        break;
    case 1:
        plumb_material_set(w, s->material[m],
                           &(plumb_material_desc){ .friction = number(s, 0, 1) });
        break;
    case 2:
        plumb_material_pair_set(w, s->material[m], s->material[0],
                                &(plumb_material_pair){ .friction = R(0.2) });
        break;
    case 3:
        plumb_material_destroy(w, s->material[m]);
        s->material[m] = plumb_material_create(w, &(plumb_material_desc){ .friction = 1 });
        break;
    case 4:
        plumb_world_set_substeps(w, (int)pick(s, 5) + 1, 1);
        break;
    case 5:
        plumb_system_enable(w, "wind", one_in(s, 2));
        break;
    case 6:
        plumb_world_set_sleep(w, !one_in(s, 3), 0, 0);
        break;
    case 7:
        change_liquid(s);
        break;
    case 9:
        change_laws(s);
        break;
    case 8:
        if (s->late.id == 0) { // registered in the midst of it
            register_late(s);
        } else {
            change_air(s);
        }
        break;
    case 10:
        change_softbodies(s);
        break;
    case 11:
        change_waves(s);
        break;
    case 12:
        change_fracture(s);
        break;
    default:
        plumb_commands_apply(w);
        break;
    }
}

static void change_components(session *s, plumb_body b)
{
    plumb_component which[] = { s->mark, s->tag, s->late };
    plumb_component c = which[pick(s, s->late.id != 0 ? 3 : 2)];
    if (one_in(s, 3)) {
        plumb_component_remove(s->world, b.entity, c);
    } else if (one_in(s, 2)) {
        give_command(s, b, pick(s, 1000));
    } else {
        plumb_component_set(s->world, b.entity, c, NULL);
    }
}

void session_act(session *s)
{
    for (uint32_t n = pick(s, 4) * pick(s, 3); n > 0; --n) {
        uint32_t i = pick(s, SESSION_BODIES);
        plumb_body b = s->body[i];
        switch (pick(s, 9)) {
        case 0:
        case 1:
            change_motion(s, b);
            break;
        case 2:
        case 3:
            change_body(s, b, i);
            break;
        case 4:
        case 5:
            change_shape(s, b);
            break;
        case 6:
            change_joint(s);
            break;
        case 7:
            change_components(s, b);
            break;
        default:
            change_world(s);
            break;
        }
    }
}

plumb_real session_dt(session *s)
{
    return one_in(s, 4) ? number(s, 0.005, 0.03) : R(1.0 / 60);
}

void session_end(session *s)
{
    plumb_world_destroy(s->world);
}
