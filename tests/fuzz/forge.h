// forge.h - what the harnesses of forged images and recordings share: a small world with something of everything,
// changes at any place, and checksums set right behind them, so that only the content can be refused.
#ifndef FUZZ_FORGE_H
#define FUZZ_FORGE_H

#include "plumb/plumb.h"
#include "record/format.h"
#include "snapshot/image.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define R(x) ((plumb_real)(x))

enum { WORLDS = 4 };

typedef struct script {
    const uint8_t *at, *end;
} script;

static inline uint32_t byte_of(script *s)
{
    return s->at < s->end ? *s->at++ : 0;
}

static inline uint32_t word_of(script *s)
{
    uint32_t high = byte_of(s);
    return high << 8 | byte_of(s);
}

static inline void need(bool holds)
{
    if (!holds) {
        abort();
    }
}

//---- worlds --------------------------------------------------------------------------------------

static inline void do_nothing(const plumb_system_call *call)
{
    (void)call;
}

// What an image does not bring along.
static inline plumb_world *make_empty(void)
{
    static const plumb_field fields[] = { { "on", PLUMB_FIELD_BOOL, 0, "1" } };
    plumb_world *w;
    need(plumb_world_create(NULL, &w) == PLUMB_OK);
    plumb_component_create(w, &(plumb_component_desc){
                                  .name = "mark", .size = 8, .fields = fields, .field_count = 1 });
    plumb_system_create(
        w, &(plumb_system_desc){ .name = "idle", .phase = PLUMB_PHASE_END, .run = do_nothing });
    return w;
}

static inline plumb_body add(plumb_world *w, plumb_body_type type, double x, double y,
                             const plumb_shape_desc *shape)
{
    plumb_body b =
        plumb_body_create(w, &(plumb_body_desc){ .type = type, .position = { R(x), R(y) } });
    plumb_shape_create(w, b, shape);
    return b;
}

static inline void add_joints(plumb_world *w, plumb_body a, plumb_body b, int first)
{
    for (int kind = first; kind < first + 7 && kind < 12; ++kind) {
        plumb_joint_create(w, &(plumb_joint_desc){ .kind = (plumb_joint_kind)kind,
                                                   .body_a = a,
                                                   .body_b = b,
                                                   .ground_a = { 0, kind == PLUMB_PULLEY ? 9 : 0 },
                                                   .ground_b = { kind == PLUMB_PULLEY ? 1 : 0,
                                                                 kind == PLUMB_PULLEY ? 9 : 0 },
                                                   .anchor_b = { 0, kind == PLUMB_CABLE ? 3 : 0 },
                                                   .radius_a = kind == PLUMB_CABLE ? R(0.2) : 0,
                                                   .pitch = kind == PLUMB_RATCHET ? R(0.3) : 0,
                                                   .break_force = 1000,
                                                   .break_impulse = kind % 2 ? 100 : 0 });
    }
}

// World 0: bodies in contact, joints. 1: ground of many pieces, sleepers, sensors, laws. 2: a character, targets, settings of bodies,
// commands, materials, a liquid. 3: a world that wraps around, solved the classic way.
static inline void fill(plumb_world *w, int which)
{
    static const plumb_vec2 ell[] = { { 0, 0 },           { 1, 0 },      { 1, R(0.5) },
                                      { R(0.5), R(0.5) }, { R(0.5), 1 }, { 0, 1 } };
    const plumb_shape_desc box = { .kind = PLUMB_BOX, .half = { R(0.5), R(0.25) } };
    const plumb_shape_desc ball = { .kind = PLUMB_CIRCLE, .radius = R(0.3) };
    const plumb_shape_desc outline = { .kind = PLUMB_OUTLINE, .points = ell, .count = 6 };
    const plumb_shape_desc capsule = {
        .kind = PLUMB_CAPSULE, .points = ell, .count = 2, .radius = R(0.2)
    };
    plumb_shape_desc eye = ball, ledge = box;
    eye.sensor = true;
    ledge.one_way.direction.y = 1;
    plumb_body ground = add(w, PLUMB_STATIC, 0, -0.25, &box);
    for (int i = 1; i < (which == 1 ? 4 : 2); ++i) {
        plumb_shape_desc tile = box;
        tile.center.x = R(i);
        plumb_shape_create(w, ground, &tile);
    }
    plumb_body a = add(w, PLUMB_DYNAMIC, 0, 0.25, &box), b = add(w, PLUMB_DYNAMIC, 1, 0.31, &ball);
    plumb_body c = add(w, PLUMB_KINEMATIC, 2.5, 1, &capsule);
    if (which == 0 || which == 3) {
        add_joints(w, a, b, which == 0 ? 0 : 5);
        add(w, PLUMB_DYNAMIC, 0.2, 1, &outline);
    } else if (which == 1) {
        add(w, PLUMB_STATIC, 0.5, 0.3, &eye);
        add(w, PLUMB_STATIC, 2, 0.8, &ledge);
        add(w, PLUMB_DYNAMIC, 2, 0.26, &box);
        plumb_world_set_sleep(w, true, 1, R(0.02));
        plumb_law_create(w, &(plumb_law_desc){ .kind = PLUMB_LAW_ATTRACTOR, .strength = R(0.01) });
        plumb_law_create(w, &(plumb_law_desc){ .kind = PLUMB_LAW_FORMULA,
                                               .formula_x = "-0.1 * vx",
                                               .radius = 2,
                                               .position = { 2, 0 } });
    } else {
        plumb_material m = plumb_material_create(w, &(plumb_material_desc){ .friction = R(0.3) });
        plumb_material_pair_set(
            w, m, (plumb_material)PLUMB_NULL_INIT,
            &(plumb_material_pair){ .friction = 1, .kinetic_friction = R(0.5) });
        plumb_character_create(w, c, NULL);
        plumb_character_walk(w, c, 1);
        plumb_body d = add(w, PLUMB_KINEMATIC, -2, 1, &ball);
        plumb_body_set_target(w, d, (plumb_vec2){ -1, 2 }, 1, 1);
        d = add(w, PLUMB_KINEMATIC, -4, 1, &ball);
        plumb_body_set_target_moving(w, d, (plumb_vec2){ -3, 2 }, 1, (plumb_vec2){ 1, 0 }, 2, 1);
        plumb_body_set_damping(w, a, R(0.1), 0);
        plumb_body_set_temperature(w, a, 400), plumb_body_set_conductance(w, a, 1);
        plumb_body_set_ignition(w, a, 300), plumb_body_set_burn_rate(w, a, R(0.001));
        plumb_body_set_temperature(w, b, 273), plumb_body_set_conductance(w, b, 1);
        plumb_body_set_melting_point(w, b, 273), plumb_body_set_latent_heat(w, b, 1000);
        plumb_body_set_heating(w, b, 100), plumb_body_set_growth(w, b, R(-0.01));
        plumb_world_exclude_pair(w, a, b, true);
        plumb_liquid_create(w, &(plumb_liquid_desc){ .spacing = R(0.1), .viscosity = 1 });
        plumb_liquid_set_phases(w, &(plumb_liquid_phase){ .density = 800, .friction = 1 }, 1);
        plumb_liquid_add_box(w, (plumb_vec2){ R(-0.6), R(0.6) }, (plumb_vec2){ R(0.2), R(0.7) },
                             NULL);
        plumb_liquid_add_box(w, (plumb_vec2){ R(-0.6), R(0.7) }, (plumb_vec2){ R(0.2), R(0.8) },
                             &(plumb_particle){ .phase = 1 });
        plumb_air_create(
            w, &(plumb_air_desc){ .half = { 1, 1 }, .cell = R(0.25), .left = PLUMB_AIR_CLOSED });
        plumb_air_set_sources(w, &(plumb_air_source){ .body = b, .radius = 1, .heat = 9 }, 1);
        plumb_rope_create(w, &(plumb_rope_desc){ .from = { 0, 2 },
                                                 .to = { 1, 2 },
                                                 .nodes = 4,
                                                 .bending = 1,
                                                 .hold_from = true,
                                                 .to_body = b });
        plumb_skin_create(w, &(plumb_skin_desc){ .center = { 2, 1 }, .nodes = 8 });
    }
    plumb_component_set(w, a.entity, plumb_component_find(w, "mark"), NULL);
}

// So that some are pending in what is saved.
static inline void give_commands(plumb_world *w, int which)
{
    static const plumb_vec2 points[] = { { 0, 0 }, { 1, 0 }, { 0, 1 } };
    if (which == 2) {
        plumb_body body = plumb_command_body_create(w, &(plumb_body_desc){ .position = { 0, 4 } });
        plumb_command_shape_create(
            w, body, &(plumb_shape_desc){ .kind = PLUMB_POLYGON, .points = points, .count = 3 });
        plumb_command_component_set(w, body.entity, plumb_component_find(w, "mark"), NULL);
        plumb_command_teleport(w, body, (plumb_vec2){ 1, 5 }, 1);
        const plumb_body first = plumb_world_bodies(w).body[0];
        plumb_command_body_cut(w, body, (plumb_vec2){ R(1.2), 5 }, (plumb_vec2){ 1, 1 });
        plumb_command_body_shatter(w, first,
                                   &(plumb_shatter_desc){ .cells = 3, .even = R(0.5), .seed = 1 });
        plumb_command_body_scale(w, first, R(1.5));
        plumb_command_body_merge(w, first, body);
        plumb_command_destroy(w, first.entity);
        plumb_command_destroy(w, body.entity);
    }
}

static inline plumb_world *make_world(int which, int steps)
{
    plumb_world *w = make_empty();
    if (which == 3) {
        plumb_world_destroy(w);
        need(plumb_world_create(&(plumb_world_desc){ .solver = PLUMB_SOLVER_PGS, .wrap_x = 10 },
                                &w) == PLUMB_OK);
        plumb_component_create(w, &(plumb_component_desc){ .name = "mark", .size = 8 });
    }
    fill(w, which);
    for (int i = 0; i < steps; ++i) {
        plumb_world_step(w, R(1.0 / 60));
    }
    give_commands(w, which);
    return w;
}

//---- changes -------------------------------------------------------------------------------------

// One change of some bytes: a place, then what comes there.
static inline void change(script *s, char *bytes, size_t size, uint32_t place)
{
    static const uint32_t words[] = {
        0,          1,          2,          UINT32_MAX, UINT32_MAX - 1,
        0x7fc00000, 0x7f800000, 0xff800000, 0x7f7fffff, 0x80000000,
        0x3f800000, 0xbf800000, 0x5368d4a5, 0x00000001, 0x7fffffff
    };
    const uint32_t how = byte_of(s);
    if (size == 0) {
        return;
    }
    size_t at = place % size;
    if (how < 96) {
        bytes[at] = (char)(bytes[at] ^ (char)(1u << how % 8));
    } else if (how < 128) {
        bytes[at] = (char)byte_of(s);
    } else if (size >= 4) { // a number or an index at the place of one
        at = at / 4 * 4 > size - 4 ? size - 4 : at / 4 * 4;
        uint32_t word = how < 240 ? words[how % 15] : byte_of(s);
        memcpy(bytes + at, &word, sizeof word);
    }
}

//---- after an image was taken --------------------------------------------------------------------

// Whatever it is, it is a world: it steps, answers, and can be saved.
static inline void live(plumb_world *w)
{
    plumb_shape shapes[4];
    plumb_contact contacts[4];
    plumb_ray_hit hit;
    plumb_nearest_hit near;
    plumb_joint joints[4];
    for (int i = 0; i < 2; ++i) {
        plumb_world_ray(w, (plumb_vec2){ -3, 1 }, (plumb_vec2){ 3, R(0.2) }, NULL, &hit);
        plumb_world_nearest(w, (plumb_vec2){ 0, 1 }, 3, NULL, &near);
        plumb_world_overlap_aabb(w, (plumb_aabb){ { -1, -1 }, { 1, 1 } }, NULL, shapes, 4);
        plumb_world_contacts(w, contacts, 4);
        plumb_world_stats(w);
        plumb_world_energy(w);
        int count = plumb_world_joints(w, joints, 4);
        for (int k = 0; k < count && k < 4; ++k) {
            plumb_joint_value(w, joints[k]);
            plumb_joint_error(w, joints[k]);
        }
        plumb_world_step(w, R(1.0 / 60));
    }
    plumb_body_span b = plumb_world_bodies(w);
    for (int i = 0; i < b.count && i < 2; ++i) { // and is taken apart again
        plumb_body_sleep(w, b.body[0]);
        plumb_body_destroy(w, plumb_world_bodies(w).body[0]);
    }
    size_t size = plumb_world_snapshot_size(w);
    char *bytes = malloc(size);
    need(bytes != NULL);
    plumb_world_save(w, bytes, size);
    plumb_world_step(w, R(1.0 / 60));
    free(bytes);
}

static inline void mend_image(char *bytes, size_t size)
{
    pl_image_header h;
    if (size < sizeof h) {
        return;
    }
    memcpy(&h, bytes, sizeof h);
    if (h.bytes >= sizeof h && h.bytes <= size) {
        h.checksum = pl_image_checksum(bytes, &h);
        memcpy(bytes, &h, sizeof h);
    }
}

#endif
