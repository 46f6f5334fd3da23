// test_threads.c - worlds large enough for every pass to be shared out end in the same bits, step for
// step, with one thread, several, more than there are cores, and with the user's own threads whatever
// order they take. Events come in the same order, numbers of the stats are the same.
#include "plumb/plumb.h"

#include "harness/trials.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#define R(x) ((plumb_real)(x))

#define BODIES 1100
#define STEPS  45
#define OTHERS 0 // as a number of workers

enum {
    CHAINS = 1,    // every few bodies hang together
    BOUNCY = 2,    // some bounce
    SENSORS = 4,   // some see
    BULLETS = 8,   // some are fast, and some of these are swept against moving ones
    SURFACES = 16, // belts, what rolls hard and what sticks
    EFFECTS = 32,  // locked axes, damping, a time of their own
    TOWERS = 64 // boxes stand on boxes, in islands of twenty; what else there is is among the first
};

// With towers: bodies that may be special.
#define FIRST_ONES 60

typedef struct setting {
    const char *name;
    plumb_world_desc desc;
    unsigned what;
} setting;

static const setting settings[] = {
    { "heap", { .simd_width = 4 }, 0 },
    { "chains", { .substeps = 4 }, CHAINS },
    { "bouncy", { .simd_width = 8 }, BOUNCY | BULLETS },
    { "everything", { .hit_speed = 2 }, CHAINS | BOUNCY | SENSORS | BULLETS | SURFACES | EFFECTS },
    { "wrapped", { .wrap_x = 60 }, CHAINS | BULLETS },
    { "classic", { .solver = PLUMB_SOLVER_PGS }, CHAINS | BULLETS },
    { "wide", { .simd_width = 16, .no_sleep = true }, CHAINS | SURFACES },
    { "towers", { .no_sleep = true }, TOWERS },
    { "towers and all", { .no_sleep = true }, TOWERS | CHAINS | BOUNCY | SURFACES | EFFECTS },
};

static uint32_t next(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 16;
}

static void add_bin(plumb_world *w, plumb_material belt)
{
    const plumb_vec2 at[] = { { 0, -1 }, { -25, 10 }, { 25, 10 }, { 3, 4 } };
    const plumb_vec2 half[] = { { 40, 1 }, { 1, 12 }, { 1, 12 }, { 4, R(0.3) } };
    for (int i = 0; i < 4; ++i) {
        plumb_body b =
            plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = at[i] });
        plumb_shape_create(
            w, b, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = half[i], .material = belt });
    }
    plumb_body arm = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC,
                                                              .position = { -8, 6 },
                                                              .angular_velocity = 3 });
    plumb_shape_create(w, arm, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 4, R(0.2) } });
}

static void add_shape(plumb_world *w, plumb_body b, uint32_t kind, plumb_material material,
                      bool sensor)
{
    static const plumb_vec2 kite[] = {
        { R(-0.3), 0 }, { 0, R(-0.25) }, { R(0.35), 0 }, { 0, R(0.4) }
    };
    static const plumb_vec2 ends[] = { { R(-0.2), 0 }, { R(0.2), 0 } };
    plumb_shape_desc shapes[] = {
        { .kind = PLUMB_BOX, .half = { R(0.35), R(0.3) } },
        { .kind = PLUMB_CIRCLE, .radius = R(0.3) },
        { .kind = PLUMB_CAPSULE, .points = ends, .count = 2, .radius = R(0.2) },
        { .kind = PLUMB_POLYGON, .points = kite, .count = 4, .radius = R(0.05) },
    };
    plumb_shape_desc *shape = &shapes[kind % 4];
    shape->material = material;
    shape->sensor = sensor;
    plumb_shape_create(w, b, shape);
}

static void tune(plumb_world *w, plumb_body b, int i)
{
    if (i % 9 == 0) {
        plumb_body_set_damping(w, b, R(0.5), R(0.5));
    } else if (i % 9 == 3) {
        plumb_body_set_locks(w, b, (plumb_axis_locks){ .x = true });
    } else if (i % 9 == 6) {
        plumb_body_set_time_scale(w, b, R(0.5));
    }
}

static plumb_world *make(const setting *s, int workers,
                         void (*hook)(void *, plumb_task_fn *, void *, uint32_t))
{
    plumb_world_desc desc = s->desc;
    desc.workers = workers;
    desc.tasks.run = hook;
    plumb_world *w = NULL;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    const bool surfaces = (s->what & SURFACES) != 0;
    plumb_material belt = plumb_material_create(
        w, &(plumb_material_desc){ .friction = R(0.7), .surface_speed = surfaces ? 2 : 0 });
    const plumb_material materials[] = {
        plumb_material_create(
            w, &(plumb_material_desc){ .friction = R(0.5),
                                       .restitution = (s->what & BOUNCY) != 0 ? R(0.1) : 0 }),
        plumb_material_create(
            w, &(plumb_material_desc){ .friction = R(0.3),
                                       .restitution = (s->what & BOUNCY) != 0 ? R(0.6) : 0,
                                       .rolling_resistance = surfaces ? R(0.02) : 0,
                                       .kinetic_friction = surfaces ? R(0.2) : 0,
                                       .adhesion = surfaces ? 5 : 0 }),
    };
    add_bin(w, belt);
    uint32_t seed = 7;
    plumb_body before = PLUMB_NULL_INIT;
    for (int i = 0; i < BODIES; ++i) {
        const bool towers = (s->what & TOWERS) != 0;
        const unsigned what = towers && i >= FIRST_ONES ? 0 : s->what;
        plumb_vec2 at = { R(i % 60) * R(0.75) - 22 + R(next(&seed) % 100) / 1000,
                          R(0.4) + R(i / 60) * R(0.7) };
        if (towers) {
            at = (plumb_vec2){ R(i / 20) * R(1.4) - 38, R(0.3) + R(i % 20) * R(0.6) };
        }
        bool bullet = (what & BULLETS) != 0 && i % 16 == 5;
        plumb_body b = plumb_body_create(
            w, &(plumb_body_desc){ .position = at,
                                   .angle = towers ? 0 : R(next(&seed) % 628) / 100,
                                   .velocity = { bullet ? 80 : 0, bullet ? -30 : 0 },
                                   .continuous = i % 32 == 5 });
        bool sensor = (what & SENSORS) != 0 && i % 50 == 7;
        add_shape(w, b, towers ? 0 : next(&seed), materials[i % 8 == 0 && what != 0], sensor);
        if (sensor) {
            add_shape(w, b, next(&seed), materials[0], false);
        }
        if ((what & EFFECTS) != 0) {
            tune(w, b, i);
        }
        if ((what & CHAINS) != 0 && i % 5 != 0 && i % 60 != 0) {
            plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                       .body_a = before,
                                                       .body_b = b,
                                                       .anchor = { at.x - R(0.4), at.y },
                                                       .enable_limit = i % 3 == 0,
                                                       .lower = R(-0.5),
                                                       .upper = R(0.5) });
        }
        before = b;
    }
    return w;
}

// What a step leaves behind that can be told from outside.
typedef struct trace {
    uint64_t hash;
    uint64_t events;
    plumb_stats stats;
} trace;

static uint64_t digest(uint64_t sum, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; ++i) {
        sum = (sum ^ bytes[i]) * UINT64_C(1099511628211);
    }
    return sum;
}

static trace look(const plumb_world *w)
{
    _Static_assert(sizeof(plumb_stats) == 3 * sizeof(double) + 30 * sizeof(uint32_t) +
                                              2 * sizeof(plumb_real) + 2 * sizeof(size_t),
                   "stats are compared byte by byte: without padding");
    trace t = { .hash = plumb_world_hash(w), .stats = plumb_world_stats(w) };
    t.stats.bytes = t.stats.peak_bytes = 0; // threads need memory of their own
    int begins, ends, hits, seen;
    const plumb_contact_begin *begin = plumb_world_begin_events(w, &begins);
    const plumb_contact_end *end = plumb_world_end_events(w, &ends);
    const plumb_contact_hit *hit = plumb_world_hit_events(w, &hits);
    const plumb_sensor_event *sensor = plumb_world_sensor_begin_events(w, &seen);
    for (int i = 0; i < begins; ++i) {
        t.events = digest(t.events, &begin[i].shape_a, sizeof begin[i].shape_a);
        t.events = digest(t.events, &begin[i].shape_b, sizeof begin[i].shape_b);
        t.events = digest(t.events, &begin[i].approach_speed, sizeof(plumb_real));
    }
    for (int i = 0; i < ends; ++i) {
        t.events = digest(t.events, &end[i].shape_a, sizeof end[i].shape_a);
        t.events = digest(t.events, &end[i].shape_b, sizeof end[i].shape_b);
    }
    for (int i = 0; i < hits; ++i) {
        t.events = digest(t.events, &hit[i].impulse, sizeof(plumb_real));
    }
    for (int i = 0; i < seen; ++i) {
        t.events = digest(t.events, &sensor[i].sensor, sizeof sensor[i].sensor);
    }
    return t;
}

static void run(const setting *s, int workers,
                void (*hook)(void *, plumb_task_fn *, void *, uint32_t), trace out[STEPS])
{
    plumb_world *w = make(s, workers > 0 ? workers : 1, hook);
    for (int i = 0; i < STEPS; ++i) {
        if (workers == OTHERS) { // others from step to step
            assert_int_equal(plumb_world_set_workers(w, 1 + i % 3), PLUMB_OK);
        }
        assert_int_equal(plumb_world_step(w, R(1) / 60), PLUMB_OK);
        out[i] = look(w);
    }
    plumb_world_destroy(w);
}

// The user's threads may take chunks in any order: here, backwards.
static uint32_t largest_job;

static void run_backwards(void *hook_context, plumb_task_fn *task, void *context, uint32_t chunks)
{
    (void)hook_context;
    largest_job = chunks > largest_job ? chunks : largest_job;
    while (chunks-- > 0) {
        task(context, chunks);
    }
}

static void expect_same(const setting *s, int workers, const trace *one, const trace *several)
{
    for (int i = 0; i < STEPS; ++i) {
        if (one[i].hash != several[i].hash || one[i].events != several[i].events ||
            memcmp(&one[i].stats, &several[i].stats, sizeof one[i].stats) != 0) {
            fail_msg("%s: step %d with %d workers differs in %s", s->name, i, workers,
                     one[i].hash != several[i].hash       ? "its hash"
                     : one[i].events != several[i].events ? "its events"
                                                          : "its stats");
        }
    }
}

static unsigned most_contacts(const trace *t)
{
    unsigned most = 0;
    for (int i = 0; i < STEPS; ++i) {
        most = t[i].stats.contact_count > most ? (unsigned)t[i].stats.contact_count : most;
    }
    return most;
}

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    (void)state;
    static trace one[STEPS], several[STEPS];
    const int workers[] = { 2, 3, 8 };
    for (size_t k = 0; k < sizeof settings / sizeof settings[0]; ++k) {
        if (!trials_takes((uint32_t)k, 3)) {
            continue;
        }
        run(&settings[k], 1, NULL, one);
        if (most_contacts(one) < 400) {
            fail_msg("%s: %u contacts", settings[k].name, most_contacts(one));
        }
        for (size_t i = 0; i < sizeof workers / sizeof workers[0]; ++i) {
            run(&settings[k], workers[i], NULL, several);
            expect_same(&settings[k], workers[i], one, several);
        }
        if ((settings[k].what & EFFECTS) != 0) {
            run(&settings[k], OTHERS, NULL, several);
            expect_same(&settings[k], OTHERS, one, several);
        }
        largest_job = 0;
        run(&settings[k], 4, run_backwards, several);
        assert_int_equal(largest_job, 4); // passes were shared out at all
        expect_same(&settings[k], 4, one, several);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
    };
    return cmocka_run_group_tests_name("threads", tests, NULL, NULL);
}
