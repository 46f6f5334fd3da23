// test_api_errors.c - wrong calls: each must give its code and its message, word for word, leave
// one line in the log, and change nothing.
#include "world_fixture.h"

#define W          f->world
#define BODY(...)  made(W, plumb_body_create(W, &(plumb_body_desc){ __VA_ARGS__ }))
#define SHAPE(...) made(W, plumb_shape_create(W, f->dynamic, &(plumb_shape_desc){ __VA_ARGS__ }))
#define STUFF(...) made(W, plumb_material_create(W, &(plumb_material_desc){ __VA_ARGS__ }))
#define KIND(...)                                                                                  \
    component_code(W, plumb_component_create(W, &(plumb_component_desc){ __VA_ARGS__ }))
#define SYSTEM(...) plumb_system_create(W, &(plumb_system_desc){ __VA_ARGS__ })

#define NAN_  ((plumb_real)NAN)
#define INF_  ((plumb_real)INFINITY)
#define LONG_ "a-name-of-more-than-sixty-three-characters-is-longer-than-any-name"

static plumb_result component_code(const plumb_world *w, plumb_component c)
{
    return c.id == 0 ? plumb_world_error(w).code : PLUMB_OK;
}

static void nothing(const plumb_system_call *call)
{
    (void)call;
}

static void bodies_refuse(void **state)
{
    fixture *f = *state;
    REFUSED(E_NULL, "plumb_body_create: desc is null; it must be given",
            made(W, plumb_body_create(W, NULL)));
    // No float is 2^31 - 1.
    REFUSED(E_RANGE,
            "plumb_body_create: type is 2147483647; it must be one of dynamic|kinematic|static",
            BODY(.type = (plumb_body_type)2147483647));
    REFUSED(E_RANGE, "plumb_body_create: type is 3; it must be one of dynamic|kinematic|static",
            BODY(.type = (plumb_body_type)3));
    REFUSED(E_NOT_FINITE, "plumb_body_create: position is (nan, 0); it must be finite",
            BODY(.position = { NAN_, 0 }));
    REFUSED(E_RANGE,
            "plumb_body_create: position is (2e+09, 0); each component must be -1e+09 to 1e+09",
            BODY(.position = { R(2e9), 0 }));
    REFUSED(E_NOT_FINITE, "plumb_body_create: angle is nan; it must be finite",
            BODY(.angle = -NAN_));
    REFUSED(E_NOT_FINITE, "plumb_body_create: velocity is (0, -inf); it must be finite",
            BODY(.velocity = { 0, -INF_ }));
    REFUSED(E_NOT_FINITE, "plumb_body_create: angular_velocity is inf; it must be finite",
            BODY(.angular_velocity = INF_));
    REFUSED(E_RANGE, "plumb_body_create: velocity is (1, 0); it must be (0, 0) for a static body",
            BODY(.type = PLUMB_STATIC, .velocity = { 1, 0 }));
    REFUSED(E_RANGE, "plumb_body_create: angular_velocity is 2; it must be 0 for a static body",
            BODY(.type = PLUMB_STATIC, .angular_velocity = 2));
    REFUSED(E_RANGE, "plumb_body_create: angular_velocity is 2; it must be 0 with fixed_rotation",
            BODY(.fixed_rotation = true, .angular_velocity = 2));
    REFUSED(E_RANGE, "plumb_body_create: continuous is true; it must be false for a static body",
            BODY(.type = PLUMB_STATIC, .continuous = true));
    REFUSED(E_RANGE, "plumb_body_create: continuous is true; it must be false for a kinematic body",
            BODY(.type = PLUMB_KINEMATIC, .continuous = true));
    REFUSED(E_RANGE, "plumb_body_create: mass is -1; it must be 0, or 1e-36 to 1e+36",
            BODY(.mass = -1));
    REFUSED(E_RANGE, "plumb_body_create: mass is 1e-37; it must be 0, or 1e-36 to 1e+36",
            BODY(.mass = R(1e-37)));
    REFUSED(E_NOT_FINITE, "plumb_body_create: inertia is nan; it must be finite",
            BODY(.inertia = NAN_));
    REFUSED(E_NOT_FINITE, "plumb_body_create: gravity_scale is inf; it must be finite",
            BODY(.gravity_scale = INF_));

    REFUSED(E_HANDLE, "plumb_body_destroy: body is null; it must be a live body",
            plumb_body_destroy(W, NO_BODY));
    REFUSED(E_HANDLE, "plumb_body_destroy: body is stale (0:1); it must be a live body",
            plumb_body_destroy(W, f->stale));
    REFUSED(E_HANDLE, "plumb_body_destroy: body is a shape; it must be a live body",
            plumb_body_destroy(W, (plumb_body){ f->box.entity }));
    REFUSED(E_HANDLE, "plumb_body_destroy: body is a material; it must be a live body",
            plumb_body_destroy(W, (plumb_body){ f->wood.entity }));
    const plumb_law law = plumb_law_create(W, &(plumb_law_desc){ .vector = { 1, 2 } });
    REFUSED(E_HANDLE, "plumb_body_destroy: body is a law; it must be a live body",
            plumb_body_destroy(W, (plumb_body){ law.entity }));
    const plumb_entity bare = plumb_entity_create(W);
    REFUSED(E_HANDLE, "plumb_body_destroy: body is a bare entity; it must be a live body",
            plumb_body_destroy(W, (plumb_body){ bare }));
    assert_int_equal(plumb_law_destroy(W, law), PLUMB_OK);
    assert_int_equal(plumb_entity_destroy(W, bare), PLUMB_OK);
    REFUSED(E_HANDLE, "plumb_body_teleport: body is null; it must be a live body",
            plumb_body_teleport(W, NO_BODY, plumb_v2(0, 0), 0));
    REFUSED(E_RANGE,
            "plumb_body_teleport: position is (0, -1e+10); each component must be -1e+09 to 1e+09",
            plumb_body_teleport(W, f->dynamic, plumb_v2(0, R(-1e10)), 0));
    REFUSED(E_NOT_FINITE, "plumb_body_teleport: angle is inf; it must be finite",
            plumb_body_teleport(W, f->dynamic, plumb_v2(0, 0), INF_));
}

static void motion_is_refused(void **state)
{
    fixture *f = *state;
    plumb_vec2 zero = { 0, 0 };
    REFUSED(E_HANDLE, "plumb_body_set_velocity: body is null; it must be a live body",
            plumb_body_set_velocity(W, NO_BODY, zero));
    REFUSED(E_NOT_FINITE, "plumb_body_set_velocity: velocity is (nan, 1); it must be finite",
            plumb_body_set_velocity(W, f->dynamic, plumb_v2(NAN_, 1)));
    REFUSED(E_STATE, "plumb_body_set_velocity: body is static; it must be dynamic or kinematic",
            plumb_body_set_velocity(W, f->fixed, zero));
    REFUSED(E_HANDLE, "plumb_body_set_angular_velocity: body is null; it must be a live body",
            plumb_body_set_angular_velocity(W, NO_BODY, 0));
    REFUSED(E_NOT_FINITE, "plumb_body_set_angular_velocity: w is nan; it must be finite",
            plumb_body_set_angular_velocity(W, f->dynamic, NAN_));
    REFUSED(E_STATE,
            "plumb_body_set_angular_velocity: body is static; it must be dynamic or kinematic",
            plumb_body_set_angular_velocity(W, f->fixed, 1));
    plumb_body upright = plumb_body_create(W, &(plumb_body_desc){ .fixed_rotation = true });
    REFUSED(E_STATE,
            "plumb_body_set_angular_velocity: w is 1; it must be 0 for a body of fixed rotation",
            plumb_body_set_angular_velocity(W, upright, 1));

    REFUSED(E_HANDLE, "plumb_body_apply_force: body is stale (0:1); it must be a live body",
            plumb_body_apply_force(W, f->stale, zero, zero));
    REFUSED(E_NOT_FINITE, "plumb_body_apply_force: force is (inf, 0); it must be finite",
            plumb_body_apply_force(W, f->dynamic, plumb_v2(INF_, 0), zero));
    REFUSED(E_NOT_FINITE, "plumb_body_apply_force: point is (0, nan); it must be finite",
            plumb_body_apply_force(W, f->dynamic, zero, plumb_v2(0, NAN_)));
    REFUSED(E_STATE, "plumb_body_apply_force: body is kinematic; it must be dynamic",
            plumb_body_apply_force(W, f->kinematic, zero, zero));
    REFUSED(E_STATE, "plumb_body_apply_force_center: body is static; it must be dynamic",
            plumb_body_apply_force_center(W, f->fixed, zero));
    REFUSED(E_NOT_FINITE, "plumb_body_apply_force_center: force is (nan, 0); it must be finite",
            plumb_body_apply_force_center(W, f->dynamic, plumb_v2(NAN_, 0)));
    REFUSED(E_NOT_FINITE, "plumb_body_apply_torque: torque is inf; it must be finite",
            plumb_body_apply_torque(W, f->dynamic, INF_));
    REFUSED(E_STATE, "plumb_body_apply_torque: body is kinematic; it must be dynamic",
            plumb_body_apply_torque(W, f->kinematic, 1));
    REFUSED(E_HANDLE, "plumb_body_apply_impulse: body is null; it must be a live body",
            plumb_body_apply_impulse(W, NO_BODY, zero, zero));
    REFUSED(E_NOT_FINITE, "plumb_body_apply_impulse: point is (inf, 0); it must be finite",
            plumb_body_apply_impulse(W, f->dynamic, zero, plumb_v2(INF_, 0)));
    REFUSED(E_STATE, "plumb_body_apply_impulse_center: body is kinematic; it must be dynamic",
            plumb_body_apply_impulse_center(W, f->kinematic, zero));
    REFUSED(E_NOT_FINITE, "plumb_body_apply_angular_impulse: impulse is nan; it must be finite",
            plumb_body_apply_angular_impulse(W, f->dynamic, NAN_));
    plumb_body_apply_force_center(W, f->dynamic, plumb_v2(PLUMB_REAL_MAX, 0));
    REFUSED(
        E_NOT_FINITE,
        "plumb_body_apply_force_center: force is too large; the sum over the body must be finite",
        plumb_body_apply_force_center(W, f->dynamic, plumb_v2(PLUMB_REAL_MAX, 0)));
}

static void masses_are_refused(void **state)
{
    fixture *f = *state;
    REFUSED(E_RANGE, "plumb_body_set_mass: mass is 0; it must be 1e-36 to 1e+36",
            plumb_body_set_mass(W, f->dynamic, 0));
    REFUSED(E_NOT_FINITE, "plumb_body_set_mass: mass is nan; it must be finite",
            plumb_body_set_mass(W, f->dynamic, NAN_));
    REFUSED(E_STATE, "plumb_body_set_mass: body is kinematic; it must be dynamic",
            plumb_body_set_mass(W, f->kinematic, 1));
    REFUSED(
        E_RANGE,
        "plumb_body_set_mass: mass is 1.25e-36; the inertia that follows must be 1e-36 to 1e+36",
        plumb_body_set_mass(W, f->dynamic, R(1.25e-36)));
    REFUSED(E_STATE, "plumb_body_reset_mass: body is static; it must be dynamic",
            plumb_body_reset_mass(W, f->fixed));
    REFUSED(E_HANDLE, "plumb_body_reset_mass: body is null; it must be a live body",
            plumb_body_reset_mass(W, NO_BODY));
    REFUSED(E_STATE, "plumb_body_set_fixed_rotation: body is kinematic; it must be dynamic",
            plumb_body_set_fixed_rotation(W, f->kinematic, true));
    REFUSED(E_STATE, "plumb_body_set_continuous: body is kinematic; it must be dynamic",
            plumb_body_set_continuous(W, f->kinematic, true));
    REFUSED(E_HANDLE, "plumb_body_set_continuous: body is null; it must be a live body",
            plumb_body_set_continuous(W, NO_BODY, true));
    REFUSED(E_NOT_FINITE, "plumb_body_set_gravity_scale: gravity_scale is inf; it must be finite",
            plumb_body_set_gravity_scale(W, f->dynamic, INF_));
    REFUSED(E_HANDLE, "plumb_body_set_gravity_scale: body is null; it must be a live body",
            plumb_body_set_gravity_scale(W, NO_BODY, 1));
    REFUSED(E_HANDLE, "plumb_body_set_user_data: body is null; it must be a live body",
            plumb_body_set_user_data(W, NO_BODY, NULL));
    REFUSED(E_NOT_FINITE, "plumb_world_set_gravity: gravity is (nan, 0); it must be finite",
            plumb_world_set_gravity(W, plumb_v2(NAN_, 0)));
    REFUSED(E_NOT_FINITE, "plumb_world_set_time: time is nan; it must be finite",
            plumb_world_set_time(W, (double)NAN_));
    REFUSED(E_RANGE, "plumb_world_set_time: time is -1; it must be 0 to 1e12",
            plumb_world_set_time(W, -1));
    REFUSED(E_RANGE, "plumb_world_step: dt is 2; it must be 0 to 1", plumb_world_step(W, 2));
    REFUSED(E_RANGE, "plumb_world_step: dt is -0.01; it must be 0 to 1",
            plumb_world_step(W, R(-0.01)));
    REFUSED(E_NOT_FINITE, "plumb_world_step: dt is nan; it must be finite",
            plumb_world_step(W, NAN_));
}

static void shapes_refuse(void **state)
{
    fixture *f = *state;
    static const plumb_vec2 points[300] = { { 0, 0 }, { 1, 0 }, { 2, 0 } };
    static const plumb_vec2 bow[] = { { 0, 0 }, { 1, 1 }, { 1, 0 }, { 0, 1 } };
    const plumb_vec2 wild[] = { { 0, 0 }, { 1, NAN_ }, { 2, 0 } };
    const plumb_vec2 far[] = { { 0, 0 }, { R(2e7), 0 }, { 2, 0 } };
    plumb_vec2 ring[20];
    for (int i = 0; i < 20; ++i) {
        ring[i] = plumb_vec2_polar(1, R(i * 0.3141592653589793));
    }
    const plumb_shape_desc circle = { .kind = PLUMB_CIRCLE, .radius = 1 };
    REFUSED(E_NULL, "plumb_shape_create: desc is null; it must be given",
            made(W, plumb_shape_create(W, f->dynamic, NULL)));
    REFUSED(E_HANDLE, "plumb_shape_create: body is null; it must be a live body",
            made(W, plumb_shape_create(W, NO_BODY, &circle)));
    REFUSED(
        E_HANDLE, "plumb_shape_create: material is a body; it must be a live material or null",
        SHAPE(.kind = PLUMB_CIRCLE, .radius = 1, .material = (plumb_material){ f->fixed.entity }));
    REFUSED(E_RANGE, "plumb_shape_create: kind is 7; it must be a plumb_shape_kind",
            SHAPE(.kind = (plumb_shape_kind)7));
    REFUSED(E_RANGE, "plumb_shape_create: radius is 0; it must be 0.0001 to 1e+07",
            SHAPE(.kind = PLUMB_CIRCLE));
    REFUSED(E_NOT_FINITE, "plumb_shape_create: radius is inf; it must be finite",
            SHAPE(.kind = PLUMB_CIRCLE, .radius = INF_));
    REFUSED(E_RANGE, "plumb_shape_create: half is given; it must be 0 for a circle",
            SHAPE(.kind = PLUMB_CIRCLE, .radius = 1, .half = { 1, 1 }));
    REFUSED(E_RANGE, "plumb_shape_create: points is given; it must be 0 for a circle",
            SHAPE(.kind = PLUMB_CIRCLE, .radius = 1, .points = points));
    REFUSED(E_RANGE, "plumb_shape_create: count is given; it must be 0 for a box",
            SHAPE(.kind = PLUMB_BOX, .half = { 1, 1 }, .count = 4));
    REFUSED(E_RANGE, "plumb_shape_create: closed is given; it must be 0 for a segment",
            SHAPE(.kind = PLUMB_SEGMENT, .points = points, .count = 2, .closed = true));
    REFUSED(E_RANGE, "plumb_shape_create: center is given; it must be 0 for a capsule",
            SHAPE(.kind = PLUMB_CAPSULE, .center = { 1, 0 }, .points = points, .count = 2));
    REFUSED(E_RANGE, "plumb_shape_create: angle is given; it must be 0 for a polygon",
            SHAPE(.kind = PLUMB_POLYGON, .points = bow, .count = 4, .angle = 1));
    REFUSED(E_RANGE, "plumb_shape_create: radius is given; it must be 0 for an outline",
            SHAPE(.kind = PLUMB_OUTLINE, .points = points, .count = 3, .radius = 1));
    REFUSED(E_RANGE, "plumb_shape_create: half.y is -1; it must be 0.0001 to 1e+07",
            SHAPE(.kind = PLUMB_BOX, .half = { 1, -1 }));
    REFUSED(E_NOT_FINITE, "plumb_shape_create: half.x is nan; it must be finite",
            SHAPE(.kind = PLUMB_BOX, .half = { NAN_, 1 }));
    REFUSED(E_NOT_FINITE, "plumb_shape_create: angle is inf; it must be finite",
            SHAPE(.kind = PLUMB_BOX, .half = { 1, 1 }, .angle = INF_));
    REFUSED(E_NOT_FINITE, "plumb_shape_create: center is (nan, 0); it must be finite",
            SHAPE(.kind = PLUMB_BOX, .half = { 1, 1 }, .center = { NAN_, 0 }));
    REFUSED(E_RANGE, "plumb_shape_create: density is -1; it must be at least 0",
            SHAPE(.kind = PLUMB_CIRCLE, .radius = 1, .density = -1));
    REFUSED(E_RANGE,
            "plumb_shape_create: density is 1e+38; mass and inertia of the body must be "
            "1e-36 to 1e+36",
            SHAPE(.kind = PLUMB_CIRCLE, .radius = 1, .density = R(1e38)));
    REFUSED(E_NULL, "plumb_shape_create: points is null; it must be given",
            SHAPE(.kind = PLUMB_POLYGON, .count = 3));
    REFUSED(E_RANGE, "plumb_shape_create: count is 3; it must be 2 for a capsule",
            SHAPE(.kind = PLUMB_CAPSULE, .radius = 1, .points = points, .count = 3));
    REFUSED(E_RANGE, "plumb_shape_create: count is 65; it must be 3 to 64 for a polygon",
            SHAPE(.kind = PLUMB_POLYGON, .points = points, .count = 65));
    REFUSED(E_RANGE, "plumb_shape_create: count is 257; it must be 3 to 256 for an outline",
            SHAPE(.kind = PLUMB_OUTLINE, .points = points, .count = 257));
    REFUSED(E_RANGE, "plumb_shape_create: count is 1; it must be at least 2 for a chain",
            SHAPE(.kind = PLUMB_CHAIN, .points = points, .count = 1));
    REFUSED(E_RANGE, "plumb_shape_create: count is 2; it must be at least 3 for a closed chain",
            SHAPE(.kind = PLUMB_CHAIN, .points = points, .count = 2, .closed = true));
    REFUSED(E_NOT_FINITE, "plumb_shape_create: points[1] is (1, nan); it must be finite",
            SHAPE(.kind = PLUMB_CHAIN, .points = wild, .count = 3));
    REFUSED(E_RANGE,
            "plumb_shape_create: points[1] is (2e+07, 0); each component must be -1e+07 to 1e+07",
            SHAPE(.kind = PLUMB_CHAIN, .points = far, .count = 3));
    REFUSED(E_GEOMETRY,
            "plumb_shape_create: points enclose no area; their hull must have 3 corners",
            SHAPE(.kind = PLUMB_POLYGON, .points = points, .count = 3));
    REFUSED(E_CAPACITY,
            "plumb_shape_create: points have more than 16 corners; a polygon must have fewer",
            SHAPE(.kind = PLUMB_POLYGON, .points = ring, .count = 20));
    REFUSED(
        E_GEOMETRY,
        "plumb_shape_create: points cross, touch or enclose no area; the outline must be simple",
        SHAPE(.kind = PLUMB_OUTLINE, .points = bow, .count = 4));
    REFUSED(E_GEOMETRY,
            "plumb_shape_create: points are too near each other; neighbours must be 0.0001 apart",
            SHAPE(.kind = PLUMB_CHAIN, .points = points + 3, .count = 2));
    if (sizeof(plumb_real) == sizeof(float)) {
        REFUSED(E_GEOMETRY,
                "plumb_shape_create: half is too small for its distance from the origin; "
                "it must be larger",
                SHAPE(.kind = PLUMB_BOX, .half = { R(0.001), R(0.001) }, .center = { R(1e6), 0 }));
    }
}

static void shape_calls_are_refused(void **state)
{
    fixture *f = *state;
    plumb_convex piece;
    REFUSED(E_HANDLE, "plumb_shape_destroy: shape is a body; it must be a live shape",
            plumb_shape_destroy(W, (plumb_shape){ f->dynamic.entity }));
    REFUSED(E_HANDLE, "plumb_shape_set_material: shape is null; it must be a live shape",
            plumb_shape_set_material(W, NO_SHAPE, f->wood));
    REFUSED(E_HANDLE,
            "plumb_shape_set_material: material is stale (0:1); it must be a live material or null",
            plumb_shape_set_material(W, f->box, (plumb_material){ f->stale.entity }));
    REFUSED(E_HANDLE, "plumb_shape_set_user_data: shape is null; it must be a live shape",
            plumb_shape_set_user_data(W, NO_SHAPE, NULL));
    REFUSED(E_HANDLE, "plumb_shape_piece: shape is null; it must be a live shape",
            plumb_shape_piece(W, NO_SHAPE, 0, &piece, NULL));
    REFUSED(E_NULL, "plumb_shape_piece: piece is null; it must be given",
            plumb_shape_piece(W, f->box, 0, NULL, NULL));
    REFUSED(E_RANGE, "plumb_shape_piece: i is 1; it must be 0 to 0",
            plumb_shape_piece(W, f->box, 1, &piece, NULL));
}

static void materials_refuse(void **state)
{
    fixture *f = *state;
    plumb_material_desc desc = { 0 };
    REFUSED(E_NULL, "plumb_material_create: desc is null; it must be given",
            made(W, plumb_material_create(W, NULL)));
    REFUSED(E_RANGE, "plumb_material_create: density is -1; it must be at least 0",
            STUFF(.density = -1));
    REFUSED(E_RANGE, "plumb_material_create: friction is 11; it must be 0 to 10",
            STUFF(.friction = 11));
    REFUSED(E_RANGE,
            "plumb_material_create: friction is 1; it must be 0 together with frictionless",
            STUFF(.friction = 1, .frictionless = true));
    REFUSED(E_RANGE, "plumb_material_create: restitution is 11; it must be 0 to 10",
            STUFF(.restitution = 11));
    REFUSED(E_NOT_FINITE, "plumb_material_create: friction is nan; it must be finite",
            STUFF(.friction = NAN_));
    REFUSED(E_HANDLE, "plumb_material_destroy: material is null; it must be a live material",
            plumb_material_destroy(W, NO_MATERIAL));
    REFUSED(E_STATE, "plumb_material_destroy: material is used by 1 piece; no shape may name it",
            plumb_material_destroy(W, f->used));
    REFUSED(E_HANDLE,
            "plumb_material_settings: material is a body; it must be a live material or null",
            plumb_material_settings(W, (plumb_material){ f->dynamic.entity }, &desc));
    REFUSED(E_NULL, "plumb_material_settings: desc is null; it must be given",
            plumb_material_settings(W, f->wood, NULL));
    REFUSED(E_NULL, "plumb_material_set: desc is null; it must be given",
            plumb_material_set(W, f->wood, NULL));
    REFUSED(E_HANDLE, "plumb_material_set: material is a shape; it must be a live material or null",
            plumb_material_set(W, (plumb_material){ f->box.entity }, &desc));
    desc.restitution = -1;
    REFUSED(E_RANGE, "plumb_material_set: restitution is -1; it must be 0 to 10",
            plumb_material_set(W, f->wood, &desc));
}

static void entities_and_components_refuse(void **state)
{
    fixture *f = *state;
    const plumb_component none = { 0 };
    const plumb_component later = { 99 };
    const plumb_field outside = { "hp", PLUMB_FIELD_F64, 4, NULL };
    const plumb_field odd = { "hp", (plumb_field_type)9, 0, NULL };
    const plumb_field nameless = { NULL, PLUMB_FIELD_F32, 0, NULL };
    REFUSED(E_HANDLE, "plumb_entity_destroy: entity is null; it must be a live entity",
            plumb_entity_destroy(W, NO_ENTITY));
    REFUSED(E_STATE, "plumb_entity_destroy: material is used by 1 piece; no shape may name it",
            plumb_entity_destroy(W, f->used.entity));
    REFUSED(E_NULL, "plumb_component_create: desc is null; it must be given",
            component_code(W, plumb_component_create(W, NULL)));
    REFUSED(E_NULL, "plumb_component_create: name is null; it must be given", KIND(.size = 4));
    REFUSED(E_RANGE, "plumb_component_create: name is empty; it must have 1 to 63 characters",
            KIND(.name = "", .size = 4));
    REFUSED(
        E_RANGE,
        "plumb_component_create: name is 'a-name-of-more-t...'; it must have 1 to 63 characters",
        KIND(.name = LONG_, .size = 4));
    REFUSED(E_RANGE, "plumb_component_create: size is 0; it must be 1 to 65536", KIND(.name = "a"));
    REFUSED(E_RANGE, "plumb_component_create: size is 65537; it must be 1 to 65536",
            KIND(.name = "a", .size = 65537));
    REFUSED(E_RANGE, "plumb_component_create: field_count is 65; it must be 0 to 64",
            KIND(.name = "a", .size = 4, .field_count = 65));
    REFUSED(E_NULL, "plumb_component_create: fields is null; it must be given",
            KIND(.name = "a", .size = 4, .field_count = 1));
    REFUSED(E_NULL, "plumb_component_create: field name is null; it must be given",
            KIND(.name = "a", .size = 4, .fields = &nameless, .field_count = 1));
    REFUSED(E_RANGE,
            "plumb_component_create: type of field 'hp' is 9; it must be a plumb_field_type",
            KIND(.name = "a", .size = 4, .fields = &odd, .field_count = 1));
    REFUSED(E_RANGE,
            "plumb_component_create: offset of field 'hp' is 4; "
            "the field must lie in the 8 bytes of a value",
            KIND(.name = "a", .size = 8, .fields = &outside, .field_count = 1));
    REFUSED(E_DUPLICATE, "plumb_component_create: name is 'health'; it must be new",
            KIND(.name = "health", .size = 4));
    REFUSED(E_HANDLE, "plumb_component_info: component is 0; it must be a registered component",
            plumb_component_info(W, none, NULL));
    REFUSED(E_NULL, "plumb_component_info: desc is null; it must be given",
            plumb_component_info(W, f->health, NULL));
    REFUSED(E_HANDLE, "plumb_component_set: entity is null; it must be a live entity",
            plumb_component_set(W, NO_ENTITY, f->health, NULL));
    REFUSED(E_HANDLE, "plumb_component_set: component is 99; it must be a registered component",
            plumb_component_set(W, f->dynamic.entity, later, NULL));
    REFUSED(E_HANDLE, "plumb_component_remove: entity is stale (0:1); it must be a live entity",
            plumb_component_remove(W, f->stale.entity, f->health));
    REFUSED(E_HANDLE, "plumb_component_remove: component is 0; it must be a registered component",
            plumb_component_remove(W, f->dynamic.entity, none));
    REFUSED(E_MISSING, "plumb_component_remove: entity has no 'health'; it must have it",
            plumb_component_remove(W, f->dynamic.entity, f->health));
}

#define VIEW(...) plumb_body_view_open(W, &(plumb_body_view_desc){ __VA_ARGS__ }, &view)

static void views_refuse(void **state)
{
    fixture *f = *state;
    plumb_body_view view = { .components = 1 };
    REFUSED(E_NULL, "plumb_body_view_open: view is null; it must be given",
            plumb_body_view_open(W, &(plumb_body_view_desc){ .with = { f->health } }, NULL));
    REFUSED(E_NULL, "plumb_body_view_open: desc is null; it must be given",
            plumb_body_view_open(W, NULL, &view));
    assert_false(plumb_body_view_next(&view));
    REFUSED(E_HANDLE, "plumb_body_view_open: with[0] is 0; it must be a registered component",
            VIEW(.rows = PLUMB_VIEW_ALL));
    REFUSED(E_HANDLE, "plumb_body_view_open: with[1] is 99; it must be a registered component",
            VIEW(.with = { f->health, { 99 } }));
    REFUSED(E_RANGE, "plumb_body_view_open: rows is 4; it must be a plumb_view_rows",
            VIEW(.with = { f->health }, .rows = (plumb_view_rows)4));
    assert_int_equal(plumb_body_view_open(NULL, NULL, &view), PLUMB_E_NULL);
    assert_false(plumb_body_view_next(&view));
    assert_false(plumb_body_view_next(NULL));
    plumb_body_view none = plumb_body_view_part(NULL, 0, 10);
    assert_false(plumb_body_view_next(&none));
    assert_int_equal(VIEW(.with = { f->health }), PLUMB_OK); // nobody has it
    assert_false(plumb_body_view_next(&view));
}

static void systems_and_capacities_refuse(void **state)
{
    fixture *f = *state;
    char wide[200] = { 0 };
    memset(wide, 'x', sizeof wide - 1);
    REFUSED(E_NULL, "plumb_system_create: desc is null; it must be given",
            plumb_system_create(W, NULL));
    REFUSED(E_NULL, "plumb_system_create: name is null; it must be given", SYSTEM(.run = nothing));
    REFUSED(E_NULL, "plumb_system_create: run is null; it must be given", SYSTEM(.name = "a"));
    REFUSED(E_RANGE, "plumb_system_create: phase is 5; it must be a plumb_phase",
            SYSTEM(.name = "a", .run = nothing, .phase = (plumb_phase)5));
    REFUSED(
        E_RANGE,
        "plumb_system_create: reads is 'xxxxxxxxxxxxxxxx...'; it must have at most 127 characters",
        SYSTEM(.name = "a", .run = nothing, .reads = wide));
    REFUSED(E_HANDLE,
            "plumb_system_create: needs[0] is 7; it must be a registered component or null",
            SYSTEM(.name = "a", .run = nothing, .needs = { { 7 } }));
    REFUSED(E_MISSING, "plumb_system_enable: name is 'a'; it must be that of a system",
            plumb_system_enable(W, "a", true));
    REFUSED(E_NULL, "plumb_system_enable: name is null; it must be given",
            plumb_system_enable(W, NULL, true));
    for (int i = 0; i < 256; ++i) {
        char name[] = { 's', (char)('a' + i / 16), (char)('a' + i % 16), '\0' };
        assert_int_equal(SYSTEM(.name = name, .run = nothing), PLUMB_OK);
        if (i < 255) { // "health" is there already
            assert_int_equal(KIND(.name = name, .size = 1), PLUMB_OK);
        }
    }
    REFUSED(E_DUPLICATE, "plumb_system_create: name is 'saa'; it must be new",
            SYSTEM(.name = "saa", .run = nothing));
    REFUSED(E_CAPACITY, "plumb_system_create: system is the 257th; there must be at most 256",
            SYSTEM(.name = "a", .run = nothing));
    REFUSED(E_CAPACITY, "plumb_component_create: component is the 257th; there must be at most 256",
            KIND(.name = "a", .size = 1));
}

static void commands_refuse(void **state)
{
    fixture *f = *state;
    const plumb_component none = { 0 };
    const plumb_shape_desc nought = { .kind = PLUMB_CIRCLE };
    const plumb_body_desc wild = { .angle = NAN_ };
    REFUSED(E_NOT_FINITE, "plumb_command_body_create: angle is nan; it must be finite",
            made(W, plumb_command_body_create(W, &wild)));
    REFUSED(E_NULL, "plumb_command_body_create: desc is null; it must be given",
            made(W, plumb_command_body_create(W, NULL)));
    REFUSED(E_RANGE, "plumb_command_shape_create: radius is 0; it must be 0.0001 to 1e+07",
            made(W, plumb_command_shape_create(W, f->dynamic, &nought)));
    REFUSED(
        E_HANDLE,
        "plumb_command_shape_create: body is null; it must be a body or one that a command makes",
        made(W, plumb_command_shape_create(W, NO_BODY, &nought)));
    REFUSED(E_HANDLE,
            "plumb_command_destroy: entity is stale (0:1); "
            "it must be an entity or one that a command makes",
            plumb_command_destroy(W, f->stale.entity));
    REFUSED(E_STATE, "plumb_command_destroy: material is used by 1 piece; no shape may name it",
            plumb_command_destroy(W, f->used.entity));
    REFUSED(
        E_HANDLE,
        "plumb_command_teleport: body is a shape; it must be a body or one that a command makes",
        plumb_command_teleport(W, (plumb_body){ f->box.entity }, plumb_v2(0, 0), 0));
    REFUSED(E_NOT_FINITE, "plumb_command_teleport: position is (nan, 0); it must be finite",
            plumb_command_teleport(W, f->dynamic, plumb_v2(NAN_, 0), 0));
    REFUSED(E_HANDLE,
            "plumb_command_component_set: component is 0; it must be a registered component",
            plumb_command_component_set(W, f->dynamic.entity, none, NULL));
    REFUSED(E_HANDLE,
            "plumb_command_component_remove: entity is null; "
            "it must be an entity or one that a command makes",
            plumb_command_component_remove(W, NO_ENTITY, f->health));
    plumb_body pending = plumb_command_body_create(W, &(plumb_body_desc){ 0 });
    REFUSED(E_HANDLE,
            "plumb_body_destroy: body is not yet made by its command; it must be a live body",
            plumb_body_destroy(W, pending));
}

//---- a locked world ------------------------------------------------------------------------------

static void try_everything(const plumb_system_call *call)
{
    fixture *f = call->context;
    const plumb_body_desc body = { 0 };
    const plumb_shape_desc circle = { .kind = PLUMB_CIRCLE, .radius = 1 };
#define STEPS(function) #function ": the world is stepping (system 'spawner'); "
    REFUSED(E_LOCKED, STEPS(plumb_body_create) "use plumb_command_body_create",
            made(W, plumb_body_create(W, &body)));
    REFUSED(E_LOCKED, STEPS(plumb_body_destroy) "use plumb_command_destroy",
            plumb_body_destroy(W, f->dynamic));
    REFUSED(E_LOCKED, STEPS(plumb_body_teleport) "use plumb_command_teleport",
            plumb_body_teleport(W, f->dynamic, plumb_v2(0, 0), 0));
    REFUSED(E_LOCKED, STEPS(plumb_shape_create) "use plumb_command_shape_create",
            made(W, plumb_shape_create(W, f->dynamic, &circle)));
    REFUSED(E_LOCKED, STEPS(plumb_shape_destroy) "use plumb_command_destroy",
            plumb_shape_destroy(W, f->box));
    REFUSED(E_LOCKED, STEPS(plumb_material_create) "call it between steps", STUFF(.friction = 1));
    REFUSED(E_LOCKED, STEPS(plumb_material_destroy) "use plumb_command_destroy",
            plumb_material_destroy(W, f->wood));
    REFUSED(E_LOCKED, STEPS(plumb_entity_create) "use plumb_command_entity_create",
            made(W, plumb_entity_create(W)));
    REFUSED(E_LOCKED, STEPS(plumb_entity_destroy) "use plumb_command_destroy",
            plumb_entity_destroy(W, f->box.entity));
    REFUSED(E_LOCKED, STEPS(plumb_component_create) "call it between steps",
            KIND(.name = "b", .size = 1));
    REFUSED(E_LOCKED, STEPS(plumb_component_set) "use plumb_command_component_set",
            plumb_component_set(W, f->fixed.entity, f->health, NULL));
    REFUSED(E_LOCKED, STEPS(plumb_component_remove) "use plumb_command_component_remove",
            plumb_component_remove(W, f->dynamic.entity, f->health));
    REFUSED(E_LOCKED, STEPS(plumb_system_create) "call it between steps",
            SYSTEM(.name = "b", .run = nothing));
    REFUSED(E_LOCKED, STEPS(plumb_commands_apply) "call it between steps", plumb_commands_apply(W));
    REFUSED(E_LOCKED, STEPS(plumb_world_step) "call it between steps",
            plumb_world_step(W, R(0.01)));
    // Overwriting a value is no structural change.
    assert_int_equal(plumb_component_set(W, f->dynamic.entity, f->health, &(float){ 5 }), PLUMB_OK);
}

static void a_stepping_world_refuses_structural_changes(void **state)
{
    fixture *f = *state;
    plumb_component_set(W, f->dynamic.entity, f->health, NULL);
    for (int phase = PLUMB_PHASE_BEGIN; phase <= PLUMB_PHASE_END; ++phase) {
        static const char *const idle[] = { "w", "x", "y", "z" };
        assert_int_equal(SYSTEM(.name = idle[phase], .run = nothing), PLUMB_OK);
    }
    assert_int_equal(SYSTEM(.name = "spawner", .run = try_everything, .context = f), PLUMB_OK);
    assert_int_equal(plumb_world_step(W, R(0.01)), PLUMB_OK);
    assert_int_equal(f->errors, 15);
    assert_int_equal(*(float *)plumb_component_get(W, f->dynamic.entity, f->health) == 5, true);
    assert_false(plumb_is_null(plumb_body_create(W, &(plumb_body_desc){ 0 })));
}

static void a_null_world_is_refused_everywhere(void **state)
{
    (void)state;
    const plumb_entity e = { 0, 1 };
    const plumb_component c = { 1 };
    const plumb_vec2 v = { 0, 0 };
    plumb_material_desc material;
    plumb_component_desc info;
    plumb_convex piece;
    const plumb_result results[] = {
        plumb_world_step(NULL, 1),
        plumb_world_set_gravity(NULL, v),
        plumb_world_set_time(NULL, 0),
        plumb_body_destroy(NULL, (plumb_body){ e }),
        plumb_body_teleport(NULL, (plumb_body){ e }, v, 0),
        plumb_body_set_velocity(NULL, (plumb_body){ e }, v),
        plumb_body_set_angular_velocity(NULL, (plumb_body){ e }, 0),
        plumb_body_apply_force(NULL, (plumb_body){ e }, v, v),
        plumb_body_apply_force_center(NULL, (plumb_body){ e }, v),
        plumb_body_apply_torque(NULL, (plumb_body){ e }, 0),
        plumb_body_apply_impulse(NULL, (plumb_body){ e }, v, v),
        plumb_body_apply_impulse_center(NULL, (plumb_body){ e }, v),
        plumb_body_apply_angular_impulse(NULL, (plumb_body){ e }, 0),
        plumb_body_set_mass(NULL, (plumb_body){ e }, 1),
        plumb_body_reset_mass(NULL, (plumb_body){ e }),
        plumb_body_set_fixed_rotation(NULL, (plumb_body){ e }, true),
        plumb_body_set_continuous(NULL, (plumb_body){ e }, true),
        plumb_body_set_gravity_scale(NULL, (plumb_body){ e }, 1),
        plumb_body_set_user_data(NULL, (plumb_body){ e }, NULL),
        plumb_shape_destroy(NULL, (plumb_shape){ e }),
        plumb_shape_set_material(NULL, (plumb_shape){ e }, (plumb_material){ e }),
        plumb_shape_set_user_data(NULL, (plumb_shape){ e }, NULL),
        plumb_shape_piece(NULL, (plumb_shape){ e }, 0, &piece, NULL),
        plumb_material_destroy(NULL, (plumb_material){ e }),
        plumb_material_settings(NULL, (plumb_material){ e }, &material),
        plumb_material_set(NULL, (plumb_material){ e }, &material),
        plumb_entity_destroy(NULL, e),
        plumb_component_info(NULL, c, &info),
        plumb_component_set(NULL, e, c, NULL),
        plumb_component_remove(NULL, e, c),
        plumb_system_create(NULL, NULL),
        plumb_system_enable(NULL, "a", true),
        plumb_command_destroy(NULL, e),
        plumb_command_teleport(NULL, (plumb_body){ e }, v, 0),
        plumb_command_component_set(NULL, e, c, NULL),
        plumb_command_component_remove(NULL, e, c),
        plumb_commands_apply(NULL),
    };
    for (size_t i = 0; i < sizeof results / sizeof results[0]; ++i) {
        assert_int_equal(results[i], PLUMB_E_NULL);
    }
    assert_true(plumb_is_null(plumb_body_create(NULL, &(plumb_body_desc){ 0 })));
    assert_true(
        plumb_is_null(plumb_shape_create(NULL, (plumb_body){ e }, &(plumb_shape_desc){ 0 })));
    assert_true(plumb_is_null(plumb_material_create(NULL, &(plumb_material_desc){ 0 })));
    assert_true(plumb_is_null(plumb_entity_create(NULL)));
    assert_true(plumb_is_null(plumb_command_body_create(NULL, NULL)));
    assert_true(plumb_is_null(plumb_command_shape_create(NULL, (plumb_body){ e }, NULL)));
    assert_true(plumb_is_null(plumb_command_entity_create(NULL)));
    assert_int_equal(plumb_component_create(NULL, NULL).id, 0);
    assert_string_equal(plumb_world_error(NULL).message, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(bodies_refuse),
        API_TEST(motion_is_refused),
        API_TEST(masses_are_refused),
        API_TEST(shapes_refuse),
        API_TEST(shape_calls_are_refused),
        API_TEST(materials_refuse),
        API_TEST(entities_and_components_refuse),
        API_TEST(views_refuse),
        API_TEST(systems_and_capacities_refuse),
        API_TEST(commands_refuse),
        API_TEST(a_stepping_world_refuses_structural_changes),
        cmocka_unit_test(a_null_world_is_refused_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
