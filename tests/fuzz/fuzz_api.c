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

// A body that can be divided: of shapes with any numbers few are.
static plumb_body solid_of(plumb_world *w, script *s)
{
    const plumb_body b =
        plumb_body_create(w, &(plumb_body_desc){ .position = vec_of(s), .velocity = vec_of(s) });
    const plumb_real size = (plumb_real)(1 + byte_of(s) % 8) / 4;
    plumb_shape_desc d = { .kind = byte_of(s) % 2 == 0 ? PLUMB_BOX : PLUMB_CIRCLE };
    d.radius = d.kind == PLUMB_CIRCLE ? size : 0;
    d.half = d.kind == PLUMB_BOX ? (plumb_vec2){ size, size / 2 } : (plumb_vec2){ 0, 0 };
    plumb_shape_create(w, b, &d);
    return b;
}

static int small_of(script *s, int most)
{
    return (int)byte_of(s) % (most + 1);
}

// Bodies are cut, shatter, become one, grow and may break: at once, or by commands.
static void divide(plumb_world *w, script *s, plumb_body body, plumb_body other)
{
    plumb_body parts[4];
    const plumb_vec2 near = plumb_body_center(w, body), aside = vec_of(s), along = vec_of(s);
    const plumb_vec2 point = { near.x + aside.x / 8, near.y + aside.y / 8 };
    plumb_shatter_desc d = { .point = point, .cells = small_of(s, 20), .seed = byte_of(s) };
    d.even = byte_of(s) % 2 == 0 ? 1 : real_of(s);
    switch (byte_of(s) % 10) {
    case 0:
        plumb_body_cut(w, body, point, along, parts, 4);
        break;
    case 1:
        plumb_body_shatter(w, body, byte_of(s) % 8 == 0 ? NULL : &d, parts, 4);
        break;
    case 2:
        plumb_body_merge(w, body, other, NULL);
        break;
    case 3:
        plumb_body_scale(w, body, 1 + along.x / 16);
        break;
    case 4:
        plumb_command_body_cut(w, body, point, along);
        break;
    case 5:
        plumb_command_body_shatter(w, body, byte_of(s) % 8 == 0 ? NULL : &d);
        break;
    case 6:
        plumb_command_body_merge(w, body, other);
        break;
    case 7:
        plumb_command_body_scale(w, body, along.y);
        break;
    case 8:
        plumb_body_set_break_impulse(w, body, along.x);
        plumb_body_set_break_force(w, body, along.y);
        break;
    default:
        plumb_commands_apply(w);
        break;
    }
}

static plumb_softbody soft_of(plumb_world *w, script *s, plumb_body body)
{
    const plumb_vec2 at = vec_of(s);
    const plumb_vec2 corners[] = {
        { at.x, at.y }, { at.x + 1, at.y }, { at.x + 1, at.y + 1 }, { at.x, at.y + 1 }
    };
    switch (byte_of(s) % 4) {
    case 0:
        return plumb_rope_create(w, &(plumb_rope_desc){ .from = at,
                                                        .to = vec_of(s),
                                                        .nodes = small_of(s, 12),
                                                        .bending = real_of(s),
                                                        .drag = real_of(s),
                                                        .hold_from = byte_of(s) % 2 == 0,
                                                        .to_body = body });
    case 1:
        return plumb_cloth_create(w, &(plumb_cloth_desc){ .low = at,
                                                          .high = corners[2],
                                                          .columns = 1 + small_of(s, 3),
                                                          .rows = 1 + small_of(s, 3),
                                                          .break_strain = real_of(s) / 8,
                                                          .hold_corners = byte_of(s) % 2 == 0 });
    case 2:
        return plumb_jelly_create(w,
                                  &(plumb_jelly_desc){ .points = corners,
                                                       .count = 4,
                                                       .spacing = (plumb_real)0.4 + real_of(s) / 64,
                                                       .velocity = vec_of(s) });
    default:
        return plumb_skin_create(w, &(plumb_skin_desc){ .center = at,
                                                        .radius = real_of(s) / 4,
                                                        .nodes = 6 + small_of(s, 10),
                                                        .pressure = 100 * real_of(s) });
    }
}

static void settle(plumb_world *w, script *s, plumb_softbody soft, plumb_body body)
{
    switch (byte_of(s) % 8) {
    case 0:
    case 1:
    case 2:
        plumb_softbody_sleep(w, soft);
        break;
    case 3:
        plumb_softbody_wake(w, soft);
        break;
    case 4:
        plumb_softbody_set_no_sleep(w, soft, byte_of(s) % 2 == 0);
        break;
    case 5:
        plumb_softbody_hold(w, soft, small_of(s, 8), body, vec_of(s));
        break;
    case 6:
        plumb_softbody_release(w, soft, small_of(s, 8));
        break;
    default:
        plumb_softbody_destroy(w, soft);
        break;
    }
}

// Any world has an image, which it takes.
static void go_back(plumb_world *w)
{
    const size_t size = plumb_world_snapshot_size(w);
    const uint64_t hash = plumb_world_hash(w);
    char *image = malloc(size);
    if (image == NULL || plumb_world_save(w, image, size) != PLUMB_OK ||
        plumb_world_restore(w, image, size) != PLUMB_OK || plumb_world_hash(w) != hash) {
        abort();
    }
    free(image);
}

static void look(plumb_world *w)
{
    const plumb_body_span b = plumb_world_bodies(w);
    for (int i = 0; i < b.count; ++i) {
        if (!isfinite(b.x[i] + b.y[i] + b.vx[i] + b.vy[i] + b.w[i] + b.c[i] + b.s[i])) {
            abort();
        }
    }
    int count, all;
    const plumb_body_break *e = plumb_world_body_break_events(w, &count);
    const plumb_body *parts = plumb_world_body_break_parts(w, &all);
    for (int i = 0; i < count; ++i) {
        if (e[i].first_part < 0 || e[i].part_count < 1 || e[i].first_part + e[i].part_count > all ||
            plumb_is_null(parts[e[i].first_part])) {
            abort();
        }
    }
    const plumb_liquid_contact *wet = plumb_liquid_contacts(w, &count);
    for (int i = 0; i < count; ++i) {
        if (plumb_is_null(wet[i].body) == plumb_is_null(wet[i].softbody) ||
            !isfinite(wet[i].force.x + wet[i].force.y + wet[i].torque)) {
            abort();
        }
    }
}

// Water, a few hundred particles of it, and what is asked of it.
static void flow(plumb_world *w, script *s)
{
    const plumb_vec2 at = vec_of(s), other = vec_of(s);
    const plumb_particle like = { .velocity = other };
    const plumb_real size = real_of(s);
    plumb_liquid_hit hit;
    plumb_liquid_sample here;
    int count;
    plumb_liquid_particles(w, &count);
    switch (byte_of(s) % 8) {
    case 0:
        plumb_liquid_create(w, &(plumb_liquid_desc){ .spacing = size >= 0.06f ? size : 0.1f,
                                                     .density = real_of(s),
                                                     .viscosity = real_of(s),
                                                     .friction = real_of(s) });
        break;
    case 1:
        plumb_liquid_destroy(w);
        break;
    case 2:
    case 3:
    case 4:
        if (count < 400) {
            plumb_liquid_add_box(w, at, plumb_v2(at.x + 1, at.y + 0.5f), &like);
        }
        break;
    case 5:
        plumb_liquid_remove(w, at, other);
        break;
    default:
        here = plumb_liquid_at(w, at);
        if (!(here.fill >= 0) || !isfinite(here.velocity.x + here.velocity.y) ||
            (plumb_liquid_ray(w, at, other, &hit) && !(hit.fraction >= 0 && hit.fraction <= 1))) {
            abort();
        }
        break;
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
    case 36:
    case 37:
    case 38:
    case 39:
    case 40:
    case 41:
        divide(w, s, (plumb_body){ other }, (plumb_body){ *slot });
        break;
    case 42:
    case 43:
        *slot = soft_of(w, s, (plumb_body){ other }).entity;
        break;
    case 44:
    case 45:
    case 46:
        settle(w, s, (plumb_softbody){ *slot }, (plumb_body){ other });
        break;
    case 47:
        go_back(w);
        break;
    case 48:
    case 49:
        *slot = solid_of(w, s).entity;
        break;
    case 50:
    case 51:
        flow(w, s);
        break;
    default:
        plumb_world_step(w, real_of(s) / 64);
        look(w);
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
    // were characters with less than 192, those from before bodies were divided with less than 224 or with 255.
    unsigned first = byte_of(&s);
    plumb_world_desc d = { .solver = (plumb_solver)(first % 3), .simd_width = 4 };
    const unsigned calls = first < 128                   ? 12
                           : first < 192                 ? 25
                           : first < 224 || first == 255 ? 36
                                                         : 60;
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
