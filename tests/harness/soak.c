// soak.c - see soak.h.
#include "harness/soak.h"

#include "harness/random.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef __linux__
#include <unistd.h>
#endif

#define R(x)    ((plumb_real)(x))
#define SETTLED 10000 // steps after which tables have had their largest sizes, or nearly
#define OUT     30.0  // [m] what is farther from the middle is destroyed

enum { STONE, RUBBER, BELT, WATER, AIR, MATERIALS };

// One of the two worlds; with an image, all that going back takes.
typedef struct soak {
    plumb_world *world;
    uint32_t seed;
    uint64_t made, destroyed, fell_asleep, woke, broken;
    plumb_material material[MATERIALS];
    plumb_body body[SOAK_BODIES];
    plumb_body lift, walker;
    plumb_law law;
    bool has_law;
} soak;

static uint32_t pick(soak *s, uint32_t count)
{
    return sim_random(&s->seed) % count;
}

static plumb_real number(soak *s, double low, double high)
{
    return R(sim_uniform(&s->seed, low, high));
}

static plumb_vec2 at(double x, double y)
{
    return (plumb_vec2){ R(x), R(y) };
}

// x before y, whatever the compiler evaluates first.
static plumb_vec2 place(soak *s, double left, double right, double low, double high)
{
    const plumb_real x = number(s, left, right);
    return (plumb_vec2){ x, number(s, low, high) };
}

//---- what stays ----------------------------------------------------------------------------------

static plumb_shape add_box(soak *s, plumb_body b, plumb_vec2 half, plumb_vec2 center, int material)
{
    return plumb_shape_create(s->world, b,
                              &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                   .half = half,
                                                   .center = center,
                                                   .sensor = material == WATER || material == AIR,
                                                   .material = s->material[material] });
}

static void make_materials(soak *s)
{
    const plumb_material_desc all[MATERIALS] = {
        [STONE] = { .friction = R(0.6) },
        [RUBBER] = { .friction = R(0.9), .restitution = R(0.6) },
        [BELT] = { .friction = R(0.8), .surface_speed = R(1.5) },
        [WATER] = { .density = 2,
                    .fluid = true,
                    .flow_x = R(0.3),
                    .swirl = R(0.5),
                    .outflow = R(-0.2),
                    .core_radius = R(0.5) },
        [AIR] = { .density = R(0.05),
                  .fluid = true,
                  .weightless = true,
                  .flow_x = 6,
                  .gust = R(0.3),
                  .gust_length = 8,
                  .jet = 3,
                  .eddies = R(0.5),
                  .eddy_length = 4 },
    };
    for (int i = 0; i < MATERIALS; ++i) {
        s->material[i] = plumb_material_create(s->world, &all[i]);
    }
}

// A basin of tiles 24 m wide: hills of a chain on the left, a pool in the middle, a belt on the right, wind above.
static void make_ground(soak *s)
{
    static const plumb_vec2 hills[] = {
        { -6, R(-0.5) }, { R(-7.5), 1 }, { -9, R(0.2) }, { -12, 2 }
    };
    const plumb_body ground =
        plumb_body_create(s->world, &(plumb_body_desc){ .type = PLUMB_STATIC });
    for (int i = -12; i <= 12; ++i) {
        const double low = i >= -2 && i <= 2 ? -2 : -0.5;
        add_box(s, ground, at(0.5, 0.5), at(i, low), i >= 6 && i <= 9 ? BELT : STONE);
    }
    add_box(s, ground, at(0.5, 1), at(-3, -1), STONE);
    add_box(s, ground, at(0.5, 1), at(3, -1), STONE);
    add_box(s, ground, at(0.5, 5), at(-12.5, 4), STONE);
    add_box(s, ground, at(0.5, 5), at(12.5, 4), STONE);
    add_box(s, ground, at(2.5, 0.75), at(0, -0.75), WATER);
    add_box(s, ground, at(4, 1.5), at(5, 5), AIR);
    plumb_shape_create(
        s->world, ground,
        &(plumb_shape_desc){
            .kind = PLUMB_CHAIN, .points = hills, .count = 4, .material = s->material[STONE] });
    plumb_shape_create(s->world, ground,
                       &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                            .half = at(1.5, 0.1),
                                            .center = at(-5, 2),
                                            .one_way = { { 0, 1 }, 0 },
                                            .material = s->material[STONE] });
    plumb_shape_create(s->world, ground,
                       &(plumb_shape_desc){ .kind = PLUMB_CIRCLE,
                                            .radius = 2,
                                            .center = at(-9, 2),
                                            .sensor = true,
                                            .material = s->material[STONE] });
}

static plumb_body make_walker(soak *s, double x, bool dynamic)
{
    const plumb_vec2 spine[] = { { 0, R(-0.3) }, { 0, R(0.3) } };
    const plumb_body b = plumb_body_create(
        s->world, &(plumb_body_desc){ .type = dynamic ? PLUMB_DYNAMIC : PLUMB_KINEMATIC,
                                      .fixed_rotation = dynamic,
                                      .position = at(x, 3) });
    plumb_shape_create(s->world, b,
                       &(plumb_shape_desc){ .kind = PLUMB_CAPSULE,
                                            .points = spine,
                                            .count = 2,
                                            .radius = R(0.25),
                                            .material = s->material[STONE] });
    plumb_character_create(s->world, b, NULL);
    return b;
}

static bool begin(soak *s, uint32_t seed, int width)
{
    *s = (soak){ .seed = seed * 2654435761u | 1 };
    const plumb_world_desc d = { .sleep_time = R(0.3), .hit_speed = 1, .simd_width = width };
    if (plumb_world_create(&d, &s->world) != PLUMB_OK) {
        return false;
    }
    make_materials(s);
    make_ground(s);
    s->lift = plumb_body_create(
        s->world, &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .position = at(10.5, 0.5) });
    add_box(s, s->lift, at(1, 0.1), at(0, 0), STONE);
    s->walker = make_walker(s, -4, false);
    s->body[0] = make_walker(s, 4, true);
    return true;
}

//---- what comes and goes -------------------------------------------------------------------------

static void add_shape(soak *s, plumb_body b)
{
    static const plumb_vec2 ell[] = { { 0, 0 },           { R(0.8), 0 },      { R(0.8), R(0.4) },
                                      { R(0.4), R(0.4) }, { R(0.4), R(0.8) }, { 0, R(0.8) } };
    static const plumb_vec2 gem[] = {
        { R(-0.4), 0 }, { R(-0.1), R(-0.3) }, { R(0.3), R(-0.2) }, { R(0.4), R(0.2) }, { 0, R(0.4) }
    };
    plumb_shape_desc d = { .material = s->material[pick(s, 2)] };
    switch (pick(s, 6)) {
    case 0:
        d.kind = PLUMB_CIRCLE;
        d.radius = number(s, 0.1, 0.4);
        break;
    case 1:
        d.kind = PLUMB_CAPSULE;
        d.points = ell;
        d.count = 2;
        d.radius = R(0.15);
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
        break;
    default:
        d.kind = PLUMB_BOX;
        d.half.x = number(s, 0.15, 0.5);
        d.half.y = number(s, 0.15, 0.4);
        break;
    }
    plumb_shape_create(s->world, b, &d);
}

static void make_body(soak *s, int i, plumb_vec2 position)
{
    s->body[i] = plumb_body_create(s->world, &(plumb_body_desc){ .position = position,
                                                                 .angle = number(s, -3, 3),
                                                                 .continuous = pick(s, 8) == 0,
                                                                 .damping = number(s, 0, 0.2) });
    add_shape(s, s->body[i]);
    if (pick(s, 4) == 0) {
        add_shape(s, s->body[i]);
    }
    ++s->made;
}

static void destroy_body(soak *s, int i)
{
    if (plumb_body_destroy(s->world, s->body[i]) == PLUMB_OK) {
        ++s->destroyed;
    }
    s->body[i] = (plumb_body)PLUMB_NULL_INIT;
}

// Bodies i and the next free ones, tied to one another; some ties break.
static void make_chain(soak *s, int i)
{
    static const plumb_joint_kind kinds[] = { PLUMB_REVOLUTE, PLUMB_WELD, PLUMB_DISTANCE,
                                              PLUMB_WHEEL };
    const plumb_vec2 from = place(s, -10, 8, 3, 6);
    const int count = 2 + (int)pick(s, 4);
    for (int k = 0; k < count && i + k < SOAK_BODIES; ++k) {
        if (plumb_body_valid(s->world, s->body[i + k])) {
            return;
        }
        make_body(s, i + k, at((double)from.x + 0.8 * k, (double)from.y));
        const plumb_vec2 middle = at((double)from.x + 0.8 * k - 0.4, (double)from.y);
        plumb_joint_desc d = { .kind = kinds[pick(s, 4)],
                               .body_a = k == 0 ? s->body[i] : s->body[i + k - 1],
                               .body_b = s->body[i + k],
                               .anchor = middle };
        d.anchor_b =
            d.kind == PLUMB_DISTANCE ? at((double)middle.x + 0.4, (double)middle.y) : at(0, 0);
        d.break_force = pick(s, 3) == 0 ? number(s, 5, 50) : 0;
        if (k > 0) {
            plumb_joint_create(s->world, &d);
        }
    }
}

static void change_law(soak *s)
{
    if (s->has_law) {
        plumb_law_destroy(s->world, s->law);
    } else {
        s->law = plumb_law_create(s->world, &(plumb_law_desc){ .kind = PLUMB_LAW_ATTRACTOR,
                                                               .falloff = PLUMB_FALLOFF_INVERSE,
                                                               .position = place(s, -8, 8, 1, 5),
                                                               .strength = number(s, -12, 12),
                                                               .softening = R(0.5),
                                                               .radius = 6 });
    }
    s->has_law = !s->has_law;
}

// A little of it, for a short time: it takes most of a step.
static void change_liquid(soak *s)
{
    plumb_liquid_desc d;
    if (plumb_liquid_settings(s->world, &d) == PLUMB_OK) {
        plumb_liquid_destroy(s->world);
        return;
    }
    if (pick(s, 8) == 0) {
        const plumb_vec2 low = place(s, -2, 1, 0, 1);
        plumb_liquid_create(s->world, &(plumb_liquid_desc){ .spacing = R(0.15) });
        plumb_liquid_add_box(s->world, low, at((double)low.x + 1.2, (double)low.y + 0.6), NULL);
    }
}

// Likewise.
static void change_air(soak *s)
{
    if (plumb_air_destroy(s->world) == PLUMB_OK || pick(s, 4) != 0) {
        return;
    }
    const plumb_air_source source = {
        .position = place(s, -1, 1, 0, 1), .radius = R(0.4), .smoke = 3, .heat = 60
    };
    plumb_air_create(s->world, &(plumb_air_desc){ .position = { 0, 1 },
                                                  .half = { 3, 1 },
                                                  .cell = R(0.25),
                                                  .bottom = PLUMB_AIR_CLOSED });
    plumb_air_set_sources(s->world, &source, 1);
}

// Ropes between bodies and places, jelly, skins; three at most.
static void change_softbodies(soak *s)
{
    plumb_world *w = s->world;
    plumb_softbody all[4];
    const int count = plumb_world_softbodies(w, all, 4);
    if (count > 2) {
        plumb_softbody_destroy(w, all[pick(s, (uint32_t)count)]);
        return;
    }
    const plumb_vec2 low = place(s, -2, 2, 1, 2);
    if (pick(s, 3) == 0) {
        plumb_skin_create(w, &(plumb_skin_desc){ .center = low, .radius = R(0.4), .nodes = 12 });
    } else if (pick(s, 2) == 0) {
        plumb_cloth_create(w,
                           &(plumb_cloth_desc){ .low = low,
                                                .high = at((double)low.x + 1, (double)low.y + 0.6),
                                                .columns = 4,
                                                .rows = 3,
                                                .break_strain = R(0.1) });
    } else {
        plumb_rope_create(w, &(plumb_rope_desc){ .from = low,
                                                 .to = place(s, -3, 3, 2, 3),
                                                 .nodes = 8,
                                                 .hold_from = pick(s, 2) == 0,
                                                 .to_body = s->body[pick(s, 4)] });
    }
}

static void change_body(soak *s, int i)
{
    plumb_world *w = s->world;
    const plumb_body b = s->body[i];
    switch (pick(s, 11)) {
    case 0:
        plumb_body_apply_impulse_center(w, b, place(s, -1, 1, 0, 2));
        break;
    case 1:
        plumb_body_teleport(w, b, place(s, -10, 10, 2, 6), number(s, -3, 3));
        break;
    case 2:
        plumb_body_set_enabled(w, b, !plumb_body_is_enabled(w, b));
        break;
    case 3:
        plumb_body_sleep(w, b);
        break;
    case 4:
        plumb_body_wake(w, b);
        break;
    case 5:
        plumb_body_set_time_scale(w, b, pick(s, 2) == 0 ? 1 : number(s, 0.3, 1.5));
        break;
    case 6:
        plumb_world_explode(w, &(plumb_explosion_desc){ .position = place(s, -10, 10, 0, 2),
                                                        .radius = 2,
                                                        .impulse = number(s, 0, 2) });
        break;
    default:
        destroy_body(s, i);
        break;
    }
}

static void steer(soak *s)
{
    plumb_world *w = s->world;
    const plumb_real speed = number(s, -3, 3), up = number(s, 2, 5);
    const plumb_body who = pick(s, 2) == 0 ? s->walker : s->body[0];
    plumb_character_walk(w, who, pick(s, 3) == 0 ? 0 : speed);
    if (pick(s, 3) == 0) {
        plumb_character_jump(w, who, up);
    }
    const double y = (double)plumb_body_position(w, s->lift).y;
    plumb_body_set_velocity(w, s->lift, at(0, pick(s, 3) == 0 ? 0 : y > 2 ? -1 : 1));
}

// Calms down now and then, for some hundred steps, so that what lies there falls asleep.
static void act(soak *s)
{
    const uint64_t step = plumb_world_stats(s->world).step_count;
    const int i = 1 + (int)pick(s, SOAK_BODIES - 1);
    const bool calm = step / 256 % 3 == 2;
    if (pick(s, calm ? 100 : 4) == 0) {
        if (!plumb_body_valid(s->world, s->body[i])) {
            if (pick(s, 2) == 0) {
                make_chain(s, i);
            } else {
                make_body(s, i, place(s, -10, 10, 3, 8));
            }
        } else {
            change_body(s, i);
        }
    }
    if (!calm && pick(s, 25) == 0) {
        steer(s);
    }
    if (pick(s, 400) == 0) {
        change_law(s);
    }
    if (pick(s, 150) == 0) {
        change_liquid(s);
    }
    if (pick(s, 150) == 0) {
        change_air(s);
    }
    if (pick(s, 200) == 0) {
        change_softbodies(s);
    }
    if (pick(s, 1000) == 0) {
        plumb_world_set_substeps(s->world, 1 + (int)pick(s, 6), 1);
    }
}

//---- steps ---------------------------------------------------------------------------------------

// What went out of the basin is destroyed, or put back; what is not finite is told.
static const char *look_around(soak *s)
{
    if (plumb_world_stats(s->world).arrested_count > 0) {
        return "a body was taken out: its state would not have been finite";
    }
    for (int i = 0; i < SOAK_BODIES; ++i) {
        if (!plumb_body_valid(s->world, s->body[i])) {
            continue;
        }
        const plumb_vec2 p = plumb_body_position(s->world, s->body[i]);
        const plumb_vec2 v = plumb_body_velocity(s->world, s->body[i]);
        if (!isfinite((double)(p.x + p.y + v.x + v.y))) {
            return "a body's state is not finite";
        }
        if (fabs((double)p.x) > OUT || fabs((double)p.y) > OUT) {
            if (i == 0) {
                plumb_body_teleport(s->world, s->body[0], at(4, 3), 0);
            } else {
                destroy_body(s, i);
            }
        }
    }
    const plumb_vec2 p = plumb_body_position(s->world, s->walker);
    if (fabs((double)p.x) > OUT || fabs((double)p.y) > OUT) {
        plumb_body_teleport(s->world, s->walker, at(-4, 3), 0);
    }
    return isfinite(plumb_world_energy(s->world).kinetic) ? NULL : "the energy is not finite";
}

static plumb_real dt_of(soak *s)
{
    return pick(s, 5) == 0 ? number(s, 0.002, 0.03) : R(1.0 / 60);
}

static const char *step(soak *s)
{
    int slept, woken, broken;
    act(s);
    if (plumb_world_step(s->world, dt_of(s)) != PLUMB_OK) {
        return "a step was refused";
    }
    plumb_world_sleep_events(s->world, &slept);
    plumb_world_wake_events(s->world, &woken);
    plumb_world_joint_break_events(s->world, &broken);
    s->fell_asleep += (uint64_t)slept;
    s->woke += (uint64_t)woken;
    s->broken += (uint64_t)broken;
    return look_around(s);
}

typedef struct past {
    soak then;
    void *image;
    size_t room, bytes;
} past;

static bool keep(const soak *s, past *p)
{
    p->then = *s;
    p->bytes = plumb_world_snapshot_size(s->world);
    if (p->bytes > p->room) {
        free(p->image);
        p->room = 2 * p->bytes;
        p->image = malloc(p->room);
    }
    return p->image != NULL && plumb_world_save(s->world, p->image, p->bytes) == PLUMB_OK;
}

// Goes some steps ahead and comes back; what the steps will lead to is in `hashes`.
static const char *go_ahead(soak *s, past *p, uint64_t *hashes)
{
    const char *fault = keep(s, p) ? NULL : "a snapshot could not be taken";
    for (int i = 0; i < SOAK_AHEAD && fault == NULL; ++i) {
        fault = step(s);
        hashes[i] = plumb_world_hash(s->world);
    }
    if (fault == NULL && plumb_world_restore(s->world, p->image, p->bytes) != PLUMB_OK) {
        fault = "a snapshot was refused";
    }
    *s = p->then;
    return fault;
}

//---- the run -------------------------------------------------------------------------------------

static size_t resident_bytes(void)
{
    unsigned long long pages = 0;
#ifdef __linux__
    FILE *f = fopen("/proc/self/statm", "r");
    if (f != NULL) {
        if (fscanf(f, "%*u %llu", &pages) != 1) {
            pages = 0;
        }
        fclose(f);
    }
    return (size_t)pages * (size_t)sysconf(_SC_PAGESIZE);
#else
    return (size_t)pages;
#endif
}

static soak_row row_of(const soak *s)
{
    const plumb_stats stats = plumb_world_stats(s->world);
    return (soak_row){ .step = stats.step_count,
                       .bodies = stats.body_count,
                       .asleep = stats.asleep_count,
                       .contacts = stats.contact_count,
                       .joints = (uint32_t)plumb_world_joints(s->world, NULL, 0),
                       .image_bytes = plumb_world_snapshot_size(s->world),
                       .resident_bytes = resident_bytes(),
                       .hash = plumb_world_hash(s->world) };
}

// [B] the most that a world held. It comes and goes, with the liquid above all.
typedef struct held {
    size_t early; // in the first tenth of the steps, of SETTLED at least
    size_t late;  // in the last tenth
    size_t since; // since the last row told
} held;

static void look(held *h, const soak_plan *plan, uint64_t step, size_t bytes)
{
    const uint64_t tenth = plan->steps / 10;
    if (step <= tenth || step <= SETTLED) {
        h->early = bytes > h->early ? bytes : h->early;
    }
    if (step > plan->steps - tenth) {
        h->late = bytes > h->late ? bytes : h->late;
    }
    h->since = bytes > h->since ? bytes : h->since;
}

// Both worlds go on by a step; the first one has been ahead since step `kept`.
static const char *both(soak *back, soak *straight, const uint64_t *hashes, uint64_t since)
{
    if (plumb_world_stats(straight->world).step_count % 500 == 0) {
        const int workers = 1 + (int)(plumb_world_stats(straight->world).step_count / 500 % 3);
        plumb_world_set_workers(straight->world, workers);
    }
    const char *fault = step(back);
    fault = fault == NULL ? step(straight) : fault;
    const uint64_t hash = plumb_world_hash(back->world);
    if (fault == NULL && since < SOAK_AHEAD && hash != hashes[since]) {
        return "the steps taken again have other bits";
    }
    if (fault == NULL && hash != plumb_world_hash(straight->world)) {
        return "the two worlds differ";
    }
    return fault;
}

bool soak_run(const soak_plan *plan, soak_report *report)
{
    soak back, straight;
    past p = { 0 };
    uint64_t hashes[SOAK_AHEAD], power = 10;
    held memory = { 0 };
    *report = (soak_report){ .fault = NULL };
    if (!begin(&back, plan->seed, 4) || !begin(&straight, plan->seed, 8)) {
        report->fault = "no world could be made";
    }
    for (uint64_t i = 0; i < plan->steps && report->fault == NULL; ++i) {
        if (i % SOAK_BACK == 0) {
            report->fault = go_ahead(&back, &p, hashes);
            ++report->rollbacks;
        }
        if (report->fault == NULL) {
            report->fault = both(&back, &straight, hashes, i % SOAK_BACK);
        }
        report->fault_step = i + 1;
        look(&memory, plan, i + 1, plumb_world_stats(straight.world).bytes);
        if (i + 1 == power || i + 1 == plan->steps) {
            report->last = row_of(&straight);
            report->last.bytes = memory.since;
            memory.since = 0;
            if (plan->tell != NULL) {
                plan->tell(&report->last);
            }
            power *= i + 1 == power ? 10 : 1;
        }
    }
    if (report->fault == NULL && (double)memory.late > SOAK_GROWTH * (double)memory.early) {
        report->fault = "memory has grown";
    }
    report->made = straight.made;
    report->destroyed = straight.destroyed;
    report->fell_asleep = straight.fell_asleep;
    report->woke = straight.woke;
    report->broken = straight.broken;
    plumb_world_destroy(back.world);
    plumb_world_destroy(straight.world);
    free(p.image);
    return report->fault == NULL;
}
