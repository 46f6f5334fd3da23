// cost.c - a pile of 60 bodies, with one effect in it or none, for callgrind: `cost NAME` takes 60 steps, and 60 more in
// measured_steps(), which run.sh counts. Exit 3: the library is built without the effect.
#include "plumb/plumb.h"

#include <stdio.h>
#include <string.h>

enum { BODIES = 60, STEPS = 60 };
#define R(x) ((plumb_real)(x))

static const char *effect;

static int is(const char *name)
{
    return strcmp(effect, name) == 0;
}

static void must(const plumb_world *world, int good)
{
    if (!good) {
        const plumb_error error = plumb_world_error(world);
        fprintf(stderr, "cost: %s\n", error.message);
    }
}

static plumb_body body_at(plumb_world *world, plumb_body_desc desc, double x, double y)
{
    desc.position = (plumb_vec2){ R(x), R(y) };
    return plumb_body_create(world, &desc);
}

// Something is added, but for what is said of the bodies of the pile.
static void add(plumb_world *world)
{
    if (is("targets")) {
        plumb_body lift = body_at(world, (plumb_body_desc){ .type = PLUMB_KINEMATIC }, 30, 5);
        must(world, plumb_body_set_target(world, lift, (plumb_vec2){ 30, 9 }, 0, 10) == PLUMB_OK);
    } else if (is("sensors") || is("fluids") || is("waves")) {
        plumb_material water = PLUMB_NULL_INIT;
        if (!is("sensors")) {
            water = plumb_material_create(
                world, &(plumb_material_desc){ .fluid = true, .density = R(0.5) });
        }
        const plumb_shape pool = plumb_shape_create(
            world, body_at(world, (plumb_body_desc){ .type = PLUMB_STATIC }, 0, 1),
            &(plumb_shape_desc){
                .kind = PLUMB_BOX, .half = { 2, 1 }, .sensor = true, .material = water });
        if (is("waves")) {
            must(world, plumb_waves_create(world, pool, &(plumb_waves_desc){ 0 }) == PLUMB_OK);
        }
    } else if (is("laws")) {
        must(world,
             !plumb_is_null(plumb_law_create(world, &(plumb_law_desc){ .kind = PLUMB_LAW_ATTRACTOR,
                                                                       .position = { 0, -50 },
                                                                       .strength = 1 })));
    } else if (is("formulas")) {
        must(world,
             !plumb_is_null(plumb_law_create(world, &(plumb_law_desc){ .kind = PLUMB_LAW_FORMULA,
                                                                       .position = { 0, -50 },
                                                                       .formula_x = "-x / r^3",
                                                                       .formula_y = "-y / r^3" })));
    } else if (is("liquid")) {
        must(world,
             plumb_liquid_create(world, &(plumb_liquid_desc){ .spacing = R(0.1) }) == PLUMB_OK);
        must(world, plumb_liquid_add_box(world, (plumb_vec2){ 30, 0 }, (plumb_vec2){ 31, 1 },
                                         NULL) == PLUMB_OK);
    } else if (is("air")) {
        must(world, plumb_air_create(world, &(plumb_air_desc){ .position = { 31, 1 },
                                                               .half = { 1, 1 },
                                                               .cell = R(0.125) }) == PLUMB_OK);
        must(world,
             plumb_air_set_sources(
                 world, &(plumb_air_source){ .position = { 31, 1 }, .radius = R(0.3), .heat = 50 },
                 1) == PLUMB_OK);
    } else if (is("softbodies")) {
        must(world,
             !plumb_is_null(plumb_rope_create(world, &(plumb_rope_desc){ .from = { 30, 9 },
                                                                         .to = { 32, 9 },
                                                                         .nodes = 17,
                                                                         .hold_from = true,
                                                                         .hold_to = true })));
    } else if (is("light")) { // materials alone: light is a question
        const plumb_material_desc glass = { .refractive_index = R(1.5), .reflectance = R(0.1) };
        plumb_shape_create(world, body_at(world, (plumb_body_desc){ .type = PLUMB_STATIC }, 30, 5),
                           &(plumb_shape_desc){ .kind = PLUMB_CIRCLE,
                                                .radius = 1,
                                                .material = plumb_material_create(world, &glass) });
    } else if (is("characters")) {
        plumb_body hero = body_at(world, (plumb_body_desc){ .type = PLUMB_KINEMATIC }, 30, 1);
        plumb_shape_create(world, hero,
                           &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.5) });
        must(world, plumb_character_create(world, hero, NULL) == PLUMB_OK);
    } else if (is("joints")) {
        plumb_body a = body_at(world, (plumb_body_desc){ .type = PLUMB_STATIC }, 30, 9);
        plumb_body b = body_at(world, (plumb_body_desc){ 0 }, 31, 9);
        plumb_shape_create(world, b, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.4) });
        must(world,
             !plumb_is_null(plumb_joint_create(world, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                                           .body_a = a,
                                                                           .body_b = b,
                                                                           .anchor = { 30, 9 } })));
    }
}

static plumb_world *make(void)
{
    plumb_world_desc desc = { .simd_width = 8,
                              .no_sleep = true,
                              .no_continuous = !is("continuous"),
                              .no_exact_islands = true,
                              .zero_gravity = is("nothing"),
                              .measure = is("measures"),
                              .watchdog = is("watchdog"),
                              .tolerance = is("tolerance") ? R(0.01) : 0,
                              .solver = is("pgs")     ? PLUMB_SOLVER_PGS
                                        : is("exact") ? PLUMB_SOLVER_EXACT
                                                      : PLUMB_SOLVER_SOFT };
    plumb_world *world = NULL;
    if (plumb_world_create(&desc, &world) != PLUMB_OK) {
        return NULL;
    }
    plumb_material_desc said = { .frictionless = !is("friction"),
                                 .restitution = is("restitution") ? R(0.5) : 0 };
    said.friction = is("friction") ? R(0.6) : 0;
    const plumb_material material = plumb_material_create(world, &said);
    plumb_shape_create(
        world, body_at(world, (plumb_body_desc){ .type = PLUMB_STATIC }, 0, 0),
        &(plumb_shape_desc){
            .kind = PLUMB_BOX, .half = { 40, 1 }, .center = { 0, -1 }, .material = material });
    for (int i = 0; i < BODIES; ++i) {
        plumb_body_desc d = { .no_gravity = false };
        d.damping = is("damping") && i == 0 ? R(0.1) : 0;
        d.drag = is("drag") && i == 0 ? R(0.1) : 0;
        d.thrust = is("engines") && i == 0 ? R(0.1) : 0;
        d.break_force = is("fracture") && i == 0 ? R(1e6) : 0;
        d.temperature = is("heat") && i == 0 ? 300 : 0;
        d.max_speed = is("speed_caps") && i == 0 ? 50 : 0;
        d.time_scale = is("time_scales") && i == 0 ? R(0.5) : 0;
        plumb_body body = body_at(world, d, i % 6 * 1.05, 0.31 + i / 6 * 0.62);
        plumb_shape_create(world, body,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                .half = { R(0.5), R(0.3) },
                                                .material = material });
    }
    add(world);
    return world;
}

__attribute__((noinline)) static void measured_steps(plumb_world *world)
{
    for (int i = 0; i < STEPS; ++i) {
        plumb_world_step(world, R(1.0 / 60));
    }
}

int main(int argc, char **argv)
{
    effect = argc == 2 ? argv[1] : "";
    plumb_world *world = make();
    if (world == NULL || plumb_world_error(world).code == PLUMB_E_UNSUPPORTED) {
        return 3;
    }
    if (plumb_world_error(world).code != PLUMB_OK) {
        fprintf(stderr, "cost: %s\n", plumb_world_error(world).message);
        return 1;
    }
    for (int i = 0; i < STEPS; ++i) {
        plumb_world_step(world, R(1.0 / 60));
    }
    measured_steps(world);
    plumb_world_destroy(world);
    return 0;
}
