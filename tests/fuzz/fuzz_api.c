// fuzz_api.c - libFuzzer harness of the public API: every input is a script of calls with raw numbers, NaN
// and stale handles included. Nothing may crash, no step may leave a non-finite body, nothing may leak.
#include "plumb/plumb.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define HANDLES 16

typedef struct script {
    const uint8_t *at, *end;
} script;

static unsigned byte_of(script *s)
{
    return s->at < s->end ? *s->at++ : 0;
}

// Mostly tame numbers, sometimes any bit pattern.
static plumb_real real_of(script *s)
{
    unsigned b = byte_of(s);
    if (b < 250) {
        return ((plumb_real)b - 125) / 16;
    }
    uint32_t bits = byte_of(s) | byte_of(s) << 8 | byte_of(s) << 16 | (uint32_t)byte_of(s) << 24;
    float any;
    memcpy(&any, &bits, sizeof any);
    return (plumb_real)any;
}

static plumb_vec2 vec_of(script *s)
{
    plumb_real x = real_of(s);
    return (plumb_vec2){ x, real_of(s) };
}

static plumb_shape shape_of(plumb_world *w, script *s, plumb_body body)
{
    plumb_vec2 points[8];
    for (int i = 0; i < 8; ++i) {
        points[i] = vec_of(s);
    }
    unsigned kind = byte_of(s);
    plumb_shape_desc d = { .kind = (plumb_shape_kind)(kind % 8), .density = real_of(s) };
    bool has_points = d.kind != PLUMB_CIRCLE && d.kind != PLUMB_BOX;
    d.radius = d.kind <= PLUMB_POLYGON ? real_of(s) : 0;
    d.half = d.kind == PLUMB_BOX ? vec_of(s) : (plumb_vec2){ 0, 0 };
    d.points = has_points ? points : NULL;
    d.count = !has_points                                          ? 0
              : d.kind == PLUMB_CAPSULE || d.kind == PLUMB_SEGMENT ? 2
                                                                   : 3 + (int)byte_of(s) % 6;
    d.closed = d.kind == PLUMB_CHAIN && byte_of(s) % 2;
    if (kind >= 224) {
        d.one_way = (plumb_one_way){ d.density > 0 ? points[0] : (plumb_vec2){ 0, 1 }, 0 };
    }
    return plumb_shape_create(w, body, &d);
}

// A shape of few corners, mostly sound.
static plumb_convex convex_of(script *s)
{
    plumb_convex c = { .count = (int)byte_of(s) % 6, .radius = real_of(s) };
    for (int i = 0; i < 4; ++i) {
        c.points[i] = vec_of(s);
    }
    return c;
}

static void ask(plumb_world *w, script *s)
{
    plumb_cast_hit hits[4];
    plumb_nearest_hit near[4];
    plumb_convex convex = convex_of(s);
    plumb_cast cast = { &convex, { vec_of(s), { 1, 0 } }, vec_of(s) };
    plumb_query_filter filter = { .one_way = byte_of(s) % 2 != 0 };
    if (plumb_world_cast(w, &cast, &filter, hits) &&
        !(hits[0].fraction >= 0 && hits[0].fraction <= 1 && hits[0].depth >= 0)) {
        abort();
    }
    bool any = plumb_world_cast_any(w, &cast, &filter);
    int all = plumb_world_cast_all(w, &cast, &filter, hits, 4);
    if (all >= 0 && any != (all > 0)) {
        abort();
    }
    plumb_world_nearest_all(w, cast.transform.p, real_of(s), &filter, near, 4);
}

static void order(plumb_world *w, script *s, plumb_entity body)
{
    plumb_character_state state;
    plumb_character_desc d = { .max_slope = real_of(s), .acceleration = real_of(s) };
    d.up = byte_of(s) % 4 == 0 ? vec_of(s) : (plumb_vec2){ 0, 0 };
    switch (byte_of(s) % 6) {
    case 0:
        plumb_character_create(w, (plumb_body){ body }, byte_of(s) % 2 ? &d : NULL);
        break;
    case 1:
        plumb_character_walk(w, (plumb_body){ body }, real_of(s));
        break;
    case 2:
        plumb_character_jump(w, (plumb_body){ body }, real_of(s));
        break;
    case 3:
        plumb_character_fly(w, (plumb_body){ body }, vec_of(s));
        break;
    case 4:
        plumb_character_drop(w, (plumb_body){ body });
        plumb_body_drop_through(w, (plumb_body){ body });
        break;
    default:
        plumb_character_set_velocity(w, (plumb_body){ body }, vec_of(s));
        break;
    }
    if (plumb_character_get(w, (plumb_body){ body }, &state) == PLUMB_OK &&
        !(isfinite(state.velocity.x) && isfinite(state.velocity.y))) {
        abort();
    }
}

// `calls`: of how many kinds the script may choose.
static void call(plumb_world *w, script *s, plumb_entity e[HANDLES], unsigned calls)
{
    plumb_entity *slot = &e[byte_of(s) % HANDLES], other = e[byte_of(s) % HANDLES];
    plumb_ray_hit hit;
    plumb_material_desc m = { .friction = real_of(s), .restitution = real_of(s) };
    switch (byte_of(s) % calls) {
    case 12:
        *slot = plumb_body_create(w, &(plumb_body_desc){ .position = vec_of(s), .asleep = true })
                    .entity;
        break;
    case 13:
        plumb_body_sleep(w, (plumb_body){ other });
        break;
    case 14:
        plumb_body_wake(w, (plumb_body){ other });
        break;
    case 15:
        *slot =
            plumb_joint_create(w, &(plumb_joint_desc){ .kind = (plumb_joint_kind)(byte_of(s) % 12),
                                                       .body_a = { other },
                                                       .body_b = { e[byte_of(s) % HANDLES] },
                                                       .anchor = vec_of(s) })
                .entity;
        break;
    case 0:
        *slot = plumb_body_create(w, &(plumb_body_desc){ .type = (plumb_body_type)(byte_of(s) % 4),
                                                         .position = vec_of(s) })
                    .entity;
        break;
    case 1:
        *slot = shape_of(w, s, (plumb_body){ other }).entity;
        break;
    case 2:
        plumb_entity_destroy(w, other);
        break;
    case 3:
        plumb_body_set_velocity(w, (plumb_body){ other }, vec_of(s));
        break;
    case 4:
        plumb_body_teleport(w, (plumb_body){ other }, vec_of(s), real_of(s));
        break;
    case 5:
        plumb_body_apply_force(w, (plumb_body){ other }, vec_of(s), vec_of(s));
        break;
    case 6:
        plumb_body_set_mass(w, (plumb_body){ other }, real_of(s));
        break;
    case 7:
        plumb_world_ray(w, vec_of(s), vec_of(s), NULL, &hit);
        break;
    case 8:
        *slot = plumb_command_body_create(w, &(plumb_body_desc){ .position = vec_of(s) }).entity;
        break;
    case 9:
        plumb_command_destroy(w, other);
        break;
    case 10:
        *slot = plumb_material_create(w, &m).entity;
        break;
    case 16:
        plumb_body_set_type(w, (plumb_body){ other }, (plumb_body_type)(byte_of(s) % 4));
        break;
    case 17:
        plumb_body_set_enabled(w, (plumb_body){ other }, byte_of(s) % 2 == 0);
        break;
    case 18:
        plumb_body_set_locks(
            w, (plumb_body){ other },
            (plumb_axis_locks){ .x = byte_of(s) % 2 == 0, .y = byte_of(s) % 3 == 0 });
        break;
    case 19:
        plumb_body_set_damping(w, (plumb_body){ other }, real_of(s), real_of(s));
        break;
    case 20:
        plumb_body_set_speed_cap(w, (plumb_body){ other }, real_of(s), real_of(s));
        break;
    case 21:
        plumb_body_set_time_scale(w, (plumb_body){ other }, real_of(s));
        break;
    case 22:
        plumb_body_set_target(w, (plumb_body){ other }, vec_of(s), real_of(s), real_of(s));
        break;
    case 23:
        plumb_world_explode(
            w, &(plumb_explosion_desc){ .position = vec_of(s),
                                        .radius = real_of(s),
                                        .impulse = real_of(s),
                                        .occlusion = (plumb_occlusion)(byte_of(s) % 3) });
        break;
    case 26:
        ask(w, s);
        break;
    case 27:
    case 28:
    case 29:
        order(w, s, other);
        break;
    default:
        plumb_world_step(w, real_of(s) / 64);
        break;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    script s = { data, data + (size < 4096 ? size : 4096) };
    plumb_entity e[HANDLES] = { { 0, 0 } };
    plumb_world *w = NULL;
    // Seeds from before there were sleep and joints begin with less than 128, those from before there
    // were characters with less than 192.
    unsigned first = byte_of(&s);
    plumb_world_desc d = { .solver = (plumb_solver)(first % 3), .simd_width = 4 };
    const unsigned calls = first < 128 ? 12 : first < 192 ? 25 : 36;
    d.sleep_time = first < 128 ? 0 : (plumb_real)0.1;
    if (plumb_world_create(&d, &w) != PLUMB_OK) {
        abort();
    }
    while (s.at < s.end) {
        call(w, &s, e, calls);
    }
    plumb_world_destroy(w);
    return 0;
}
