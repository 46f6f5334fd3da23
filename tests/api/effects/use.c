// use.c - what test_effects.sh asks of a library: `use bits` prints how a pile falls, which asks for gravity and
// friction alone; `use refusals` asks for all that a library of those two lacks, and says what was not refused.
#include "plumb/plumb.h"
#include "scene/scene.h"

#include <stdio.h>
#include <string.h>

static int bad;

static plumb_world *make(plumb_world_desc desc)
{
    plumb_world *world = NULL;
    return plumb_world_create(&desc, &world) == PLUMB_OK ? world : NULL;
}

static void bits(void)
{
    // `continuous` is on by default where it is in the library.
    plumb_world *world = make((plumb_world_desc){ .no_continuous = true });
    plumb_body ground = plumb_body_create(world, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(
        world, ground,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 20, 1 }, .center = { 0, -1 } });
    plumb_body bodies[30];
    for (int i = 0; i < 30; ++i) {
        const plumb_real x = (plumb_real)(i % 6) * (plumb_real)1.1,
                         y = 1 + (plumb_real)i * (plumb_real)0.4;
        plumb_body body = bodies[i] = plumb_body_create(
            world, &(plumb_body_desc){ .position = { x, y }, .velocity = { i % 3, 0 } });
        plumb_shape_create(world, body,
                           &(plumb_shape_desc){ .kind = i % 2 == 0 ? PLUMB_BOX : PLUMB_CIRCLE,
                                                .half = { (plumb_real)0.4, (plumb_real)0.3 },
                                                .radius = i % 2 == 0 ? 0 : (plumb_real)0.4 });
    }
    for (int step = 1; step <= 300; ++step) {
        plumb_world_step(world, (plumb_real)1 / 60);
        for (int i = 0; i < 30 && step % 20 == 0; ++i) {
            const plumb_transform at = plumb_body_transform(world, bodies[i]);
            const plumb_vec2 v = plumb_body_velocity(world, bodies[i]);
            printf("%d %d %a %a %a %a %a %a\n", step, i, (double)at.p.x, (double)at.p.y,
                   (double)at.q.s, (double)v.x, (double)v.y,
                   (double)plumb_body_angular_velocity(world, bodies[i]));
        }
    }
    plumb_world_destroy(world);
}

// Refused with the code and the name of the effect, and nothing was done.
static void refused(const plumb_world *world, const char *effect, int done)
{
    const plumb_error error = plumb_world_error(world);
    const int good =
        !done && error.code == PLUMB_E_UNSUPPORTED && strstr(error.message, effect) != NULL;
    printf("%s: %s%s\n", effect, error.message, good ? "" : " <- NOT REFUSED");
    bad += !good;
    plumb_world_clear_error((plumb_world *)world);
}

static void refused_world(const char *effect, plumb_world_desc desc)
{
    plumb_world *world = NULL;
    const plumb_result result = plumb_world_create(&desc, &world);
    printf("%s: %s\n", effect, plumb_result_text(result));
    bad += result != PLUMB_E_UNSUPPORTED || world != NULL;
}

static void refusals(void)
{
    plumb_world *w = make((plumb_world_desc){ 0 });
    const plumb_body body = plumb_body_create(w, &(plumb_body_desc){ 0 });
    const plumb_body lift = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC });
    const plumb_shape shape =
        plumb_shape_create(w, body, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1 });
#define MADE(make, ...) !plumb_is_null(make(w, &(__VA_ARGS__)))
    refused(w, "damping", MADE(plumb_body_create, (plumb_body_desc){ .damping = 1 }));
    refused(w, "damping", plumb_body_set_damping(w, body, 0, 1) == PLUMB_OK);
    refused(w, "drag", MADE(plumb_body_create, (plumb_body_desc){ .drag = 1 }));
    refused(w, "drag", plumb_body_set_drag(w, body, 1) == PLUMB_OK);
    refused(w, "engines", MADE(plumb_body_create, (plumb_body_desc){ .thrust = 1 }));
    refused(w, "engines", plumb_body_set_fuel(w, body, 1) == PLUMB_OK);
    refused(w, "speed_caps", MADE(plumb_body_create, (plumb_body_desc){ .max_spin = 1 }));
    refused(w, "time_scales", plumb_body_set_time_scale(w, body, 0) == PLUMB_OK);
    refused(w, "continuous", MADE(plumb_body_create, (plumb_body_desc){ .continuous = true }));
    refused(w, "targets", plumb_body_set_target(w, lift, (plumb_vec2){ 1, 0 }, 0, 1) == PLUMB_OK);
    refused(w, "targets",
            plumb_body_set_target_moving(w, lift, (plumb_vec2){ 1, 0 }, 0, (plumb_vec2){ 1, 0 }, 0,
                                         1) == PLUMB_OK);
    refused(w, "restitution",
            MADE(plumb_material_create, (plumb_material_desc){ .restitution = 1 }));
    refused(w, "fluids", MADE(plumb_material_create, (plumb_material_desc){ .fluid = true }));
    refused(w, "waves", plumb_waves_create(w, shape, &(plumb_waves_desc){ 0 }) == PLUMB_OK);
    refused(w, "sensors", plumb_shape_set_sensor(w, shape, true) == PLUMB_OK);
    refused(w, "laws", MADE(plumb_law_create, (plumb_law_desc){ .vector = { 1, 0 } }));
    refused(w, "laws", MADE(plumb_body_create, (plumb_body_desc){ .charge = 1 }));
    refused(w, "laws", plumb_body_set_attraction(w, body, 1) == PLUMB_OK);
    refused(w, "laws", plumb_body_set_dipole(w, body, 1) == PLUMB_OK);
    refused(w, "laws", plumb_body_set_dipole_angle(w, body, 1) == PLUMB_OK);
    refused(w, "laws", plumb_world_set_orbits(w, &(plumb_orbit_desc){ .order = 4 }) == PLUMB_OK);
    const plumb_vec2 g = plumb_world_law_at(w, (plumb_vec2){ 1, 2 }, (plumb_vec2){ 3, 4 }, 5);
    bad += g.x != 0 || g.y != plumb_world_gravity(w).y; // no law, so that is all
    refused(w, "fracture", MADE(plumb_body_create, (plumb_body_desc){ .break_force = 1 }));
    refused(w, "fracture", plumb_body_cut(w, body, (plumb_vec2){ 0, 0 }, (plumb_vec2){ 1, 0 }, NULL, 0) >= 0);
    refused(w, "fracture", plumb_body_shatter(w, body, NULL, NULL, 0) >= 0);
    refused(w, "fracture", plumb_body_merge(w, body, lift, NULL) == PLUMB_OK);
    refused(w, "fracture", plumb_body_scale(w, body, 2) == PLUMB_OK);
    refused(w, "fracture", plumb_command_body_cut(w, body, (plumb_vec2){ 0, 0 }, (plumb_vec2){ 1, 0 }) == PLUMB_OK);
    refused(w, "fracture", plumb_command_body_shatter(w, body, NULL) == PLUMB_OK);
    refused(w, "fracture", plumb_command_body_merge(w, body, lift) == PLUMB_OK);
    refused(w, "fracture", plumb_command_body_scale(w, body, 2) == PLUMB_OK);
    refused(w, "heat", MADE(plumb_body_create, (plumb_body_desc){ .temperature = 300 }));
    refused(w, "heat", plumb_body_set_growth(w, body, 1) == PLUMB_OK);
    refused(w, "liquid", plumb_liquid_create(w, NULL) == PLUMB_OK);
    refused(w, "air", plumb_air_create(w, &(plumb_air_desc){ .half = { 1, 1 } }) == PLUMB_OK);
    refused(w, "softbodies", MADE(plumb_rope_create, (plumb_rope_desc){ .to = { 1, 0 } }));
    refused(w, "light", MADE(plumb_material_create, (plumb_material_desc){ .refractive_index = 1 }));
    refused(w, "light", MADE(plumb_material_create, (plumb_material_desc){ .reflectance = 1 }));
    refused(w, "light", plumb_world_light(w, &(plumb_light_desc){ .direction = { 1, 0 } }, NULL, NULL, 0, NULL) >= 0);
    refused(w, "characters", plumb_character_create(w, body, NULL) == PLUMB_OK);
    refused(w, "joints",
            MADE(plumb_joint_create,
                 (plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .body_a = body, .body_b = lift }));
    refused(w, "measures", plumb_world_set_measure(w, true) == PLUMB_OK);
    refused(w, "watchdog", plumb_world_set_watchdog(w, true) == PLUMB_OK);
    refused(w, "tolerance", plumb_world_set_tolerance(w, (plumb_real)0.01) == PLUMB_OK);
    plumb_world_destroy(w);
    refused_world("pgs", (plumb_world_desc){ .solver = PLUMB_SOLVER_PGS });
    refused_world("exact", (plumb_world_desc){ .solver = PLUMB_SOLVER_EXACT });
    refused_world("joints", (plumb_world_desc){ .direct_joints = true });

    static const char text[] = "body{ at={0, 1}, circle{ r=1 } }\nliquid{ spacing=0.1 }\n";
    const scene_options options = { .path = "a.lua", .text = text, .text_size = sizeof text - 1 };
    scene *s = NULL;
    scene_error error = { .text = "" };
    (void)scene_load(&options, &s, &error);
    printf("scene: %s\n", error.text);
    bad += s != NULL || strstr(error.text, "built without 'liquid'") == NULL;

    int count;
    const plumb_effect *effects = plumb_effects(&count);
    for (int i = 0; i < count; ++i) {
        const int wanted =
            strcmp(effects[i].name, "gravity") == 0 || strcmp(effects[i].name, "friction") == 0;
        bad += effects[i].present != wanted;
    }
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "bits") == 0) {
        bits();
    } else {
        refusals();
    }
    return bad != 0;
}
