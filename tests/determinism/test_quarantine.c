// test_quarantine.c - bodies that a step would leave without a finite state: each is taken out, an event names the
// pass, and all others go on as in a twin world in which it was disabled before that step, to the last bit.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/heap.h"
#include "harness/recording.h"
#include "harness/sim.h"

#define HZ60 (1 / 60.0)
#define R(x) ((plumb_real)(x))

enum {
    CRATES = 12,
    BALLS = 6,
    LINKS = 5,
    BODIES = CRATES + BALLS + LINKS + 2,
    BEFORE = 20,
    AFTER = 40
};

// What goes wrong, and who tells of it.
typedef enum trouble {
    WRITTEN_FORCE,    // NaN through a span, by a system of FORCES
    WRITTEN_VELOCITY, // infinity, by one of BEGIN
    WRITTEN_LATE,     // by one of CONTACTS
    PUSHED,           // two forces that are finite and whose sum is not
    HURLED,           // a velocity beyond all bounds
    WOKEN,            // one that sleeps is given it
    STRUCK,           // a heavy elastic ball as fast as can be
    DRIVEN,           // a joint with a motor beyond all bounds
    TROUBLES
} trouble;

static const char *const passes[TROUBLES][2] = {
    { "force systems", "force systems" },
    { "begin systems", "begin systems" },
    { "contact systems", "contact systems" },
    { "calls", "calls" },
    { "calls", "calls" },
    { "calls", "calls" },
    { "soft step", "classic solver" },
    { "soft step", "classic solver" },
};

typedef struct stage {
    plumb_world *w;
    trouble trouble;
    bool armed; // in this step
    plumb_body body[BODIES], floor, sleeper;
    plumb_material bouncy, rough;
    int edits;
} stage;

static void spoil(const plumb_system_call *call, trouble which)
{
    stage *s = call->context;
    plumb_body_span b = plumb_world_bodies(s->w);
    for (int i = 0; s->armed && s->trouble == which && i < b.dynamic_count; ++i) {
        if (plumb_same(b.body[i], s->body[CRATES / 2])) {
            *(which == WRITTEN_FORCE      ? &b.fx[i]
              : which == WRITTEN_VELOCITY ? &b.w[i]
                                          : &b.vy[i]) =
                which == WRITTEN_VELOCITY ? R(INFINITY) : R(NAN);
        }
    }
}

static void in_begin(const plumb_system_call *call)
{
    spoil(call, WRITTEN_VELOCITY);
}

static void in_forces(const plumb_system_call *call)
{
    spoil(call, WRITTEN_FORCE);
}

static void in_contacts(const plumb_system_call *call)
{
    stage *s = call->context;
    for (int i = 0; i < plumb_contact_edit_count(s->w); ++i) {
        plumb_contact_edit e;
        assert_int_equal(plumb_contact_edit_get(s->w, i, &e), PLUMB_OK);
        e.friction = e.shape_a.entity.index % 3 == 0 ? R(0.2) : e.friction;
        e.surface_speed = e.shape_b.entity.index % 4 == 0 ? R(0.5) : 0;
        assert_int_equal(plumb_contact_edit_set(s->w, i, &e), PLUMB_OK);
        ++s->edits;
    }
    spoil(call, WRITTEN_LATE);
}

// A pile of crates, balls beside it, a chain over it, somebody who stands on it, something that sleeps.
static void set_up(stage *s, const plumb_world_desc *desc, trouble which)
{
    *s = (stage){ .trouble = which };
    assert_int_equal(plumb_world_create(desc, &s->w), PLUMB_OK);
    plumb_world *w = s->w;
    s->rough = plumb_material_create(
        w, &(plumb_material_desc){ .friction = R(0.6), .rolling_resistance = R(0.01) });
    s->bouncy =
        plumb_material_create(w, &(plumb_material_desc){ .friction = R(0.3), .restitution = 1 });
    s->floor = sim_floor(w, s->rough);
    int n = 0;
    for (int i = 0; i < CRATES; ++i) {
        s->body[n++] = sim_crate(w, 1.02 * (i % 4), 0.5 + i / 4, 0.5, 0.5, s->rough);
    }
    for (int i = 0; i < BALLS; ++i) {
        s->body[n++] = sim_ball(w, 6 + i, 0.5, 0.49, s->bouncy);
    }
    for (int i = 0; i < LINKS; ++i) {
        s->body[n] = sim_crate(w, -4.5 - i, 6, 0.4, 0.1, s->rough);
        plumb_joint_create(
            w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                    .body_a = i == 0 ? (plumb_body)PLUMB_NULL_INIT : s->body[n - 1],
                                    .body_b = s->body[n],
                                    .anchor = sim_vec(-4 - i, 6) });
        ++n;
    }
    s->body[n] = sim_body(w, PLUMB_KINEMATIC, 1.5, 3.8, 0);
    plumb_vec2 ends[2] = { sim_vec(0, -0.3), sim_vec(0, 0.3) };
    plumb_shape_create(
        w, s->body[n],
        &(plumb_shape_desc){ .kind = PLUMB_CAPSULE, .points = ends, .count = 2, .radius = R(0.3) });
    assert_int_equal(plumb_character_create(w, s->body[n++], NULL), PLUMB_OK);
    s->body[n] = s->sleeper =
        plumb_body_create(w, &(plumb_body_desc){ .position = sim_vec(30, 0.5), .asleep = true });
    sim_add_box(w, s->body[n++], 0.5, 0.5, s->rough);
    plumb_system_create(
        w, &(plumb_system_desc){
               .name = "b", .phase = PLUMB_PHASE_BEGIN, .run = in_begin, .context = s });
    plumb_system_create(
        w, &(plumb_system_desc){
               .name = "f", .phase = PLUMB_PHASE_FORCES, .run = in_forces, .context = s });
    plumb_system_create(
        w, &(plumb_system_desc){
               .name = "c", .phase = PLUMB_PHASE_CONTACTS, .run = in_contacts, .context = s });
}

static plumb_body victim(const stage *s)
{
    return s->trouble == WOKEN    ? s->sleeper
           : s->trouble == STRUCK ? s->body[CRATES]
           : s->trouble == DRIVEN ? s->body[CRATES + BALLS + LINKS - 1]
                                  : s->body[CRATES / 2];
}

static void drive(const stage *s)
{
    plumb_joint joint;
    assert_true(plumb_body_joints(s->w, victim(s), &joint, 1) > 0);
    assert_int_equal(plumb_joint_set_motor(s->w, joint, true, R(1e30), R(1e37)), PLUMB_OK);
}

static void make_trouble(stage *s)
{
    const plumb_body v = victim(s);
    const plumb_vec2 most = { PLUMB_IS_FAR ? R(3e38) : PLUMB_REAL_MAX, 0 };
    s->armed = true;
    switch (s->trouble) {
    case PUSHED:
        plumb_body_apply_force_center(s->w, v, most);
        plumb_body_apply_force_center(s->w, v, most);
        break;
    case HURLED:
    case WOKEN:
        assert_int_equal(plumb_body_set_velocity(s->w, v, sim_vec(1e30, 0)), PLUMB_OK);
        break;
    case STRUCK:
        assert_int_equal(plumb_body_set_mass(s->w, v, R(1e20)), PLUMB_OK);
        assert_int_equal(plumb_body_set_velocity(s->w, v, sim_vec(9e11, 0)), PLUMB_OK);
        break;
    case DRIVEN:
        drive(s);
        break;
    default:
        break;
    }
}

// The same mass and motor, and who was told to be out of the simulation is.
static void make_none(const stage *s, const plumb_quarantine *out, int count)
{
    if (s->trouble == STRUCK) {
        plumb_body_set_mass(s->w, victim(s), R(1e20));
    } else if (s->trouble == DRIVEN) {
        drive(s);
    }
    for (int i = 0; i < count; ++i) {
        plumb_body_set_velocity(s->w, out[i].body, sim_vec(0, 0));
        plumb_body_set_angular_velocity(s->w, out[i].body, 0);
        assert_int_equal(plumb_body_set_enabled(s->w, out[i].body, false), PLUMB_OK);
    }
}

static void assert_alike(const stage *a, const stage *b, int step)
{
    for (int i = 0; i < BODIES; ++i) {
        plumb_transform p = plumb_body_transform(a->w, a->body[i]),
                        q = plumb_body_transform(b->w, b->body[i]);
        plumb_vec2 v = plumb_body_velocity(a->w, a->body[i]),
                   u = plumb_body_velocity(b->w, b->body[i]);
        if (memcmp(&p, &q, sizeof p) != 0 || memcmp(&v, &u, sizeof v) != 0) {
            fail_msg(
                "trouble %d, step %d: body %d is at (%.17g, %.17g), its twin at (%.17g, %.17g)",
                a->trouble, step, i, (double)p.p.x, (double)p.p.y, (double)q.p.x, (double)q.p.y);
        }
    }
    plumb_contact c[64], d[64];
    int count = plumb_world_contacts(a->w, c, 64);
    assert_int_equal(count, plumb_world_contacts(b->w, d, 64));
    for (int i = 0; i < count; ++i) {
        assert_true(plumb_same(c[i].shape_a, d[i].shape_a) &&
                    plumb_same(c[i].shape_b, d[i].shape_b));
        for (int k = 0; k < c[i].point_count; ++k) {
            assert_true(c[i].points[k].normal_impulse == d[i].points[k].normal_impulse);
            assert_true(c[i].points[k].tangent_impulse == d[i].points[k].tangent_impulse);
        }
    }
    // Of those that were taken out one after the other, their times of rest may differ: they mean nothing. So may those of
    // who lay against one that was taken out: its twin rests anew from the step's beginning.
    if (a->trouble != DRIVEN && plumb_world_hash(a->w) != plumb_world_hash(b->w)) {
        plumb_difference rows[64];
        int n = 0, others = 0;
        plumb_world_compare(a->w, b->w, rows, 64, &n);
        for (int i = 0; i < n && i < 64; ++i) {
            others += strncmp(rows[i].component, "rest_", 5) != 0;
        }
        if (n <= 64 && others == 0) {
            return;
        }
        for (int i = 0; i < n && i < 64; ++i) {
            print_message("%u: %s %s %s | %s\n", rows[i].entity.index, rows[i].table,
                          rows[i].component, rows[i].a, rows[i].b);
        }
        fail_msg("trouble %d, step %d: the hash is another than the twin's", a->trouble, step);
    }
}

// Which of two links a motor between them tears out is anybody's guess: it may take some.
static int assert_told(const stage *s, const plumb_quarantine *out, int count, const char *pass)
{
    if (count < 1 || count > (s->trouble == DRIVEN ? LINKS + 1 : 1)) {
        fail_msg("trouble %d, solver %d: %d bodies were told", s->trouble,
                 plumb_world_settings(s->w).solver, count);
    }
    for (int i = 0; i < count; ++i) {
        assert_true(s->trouble == DRIVEN || plumb_same(out[i].body, victim(s)));
        assert_string_equal(out[i].pass, pass);
        assert_false(plumb_body_is_enabled(s->w, out[i].body));
        assert_true(plumb_body_velocity(s->w, out[i].body).x == 0);
    }
    assert_int_equal(plumb_world_stats(s->w).arrested_count, count);
    assert_int_equal(plumb_world_stats(s->w).disabled_count, count);
    return count;
}

static void go_through(const plumb_world_desc *desc, trouble which)
{
    stage bad, twin;
    set_up(&bad, desc, which);
    set_up(&twin, desc, which);
    sim_run(bad.w, BEFORE, HZ60);
    sim_run(twin.w, BEFORE, HZ60);
    assert_true(plumb_world_hash(bad.w) == plumb_world_hash(twin.w));
    make_trouble(&bad);
    for (int i = 0; i < AFTER; ++i) {
        assert_int_equal(plumb_world_step(bad.w, R(HZ60)), PLUMB_OK);
        if (i == 0) {
            int count;
            const plumb_quarantine *out = plumb_world_quarantine_events(bad.w, &count);
            make_none(&twin, out, assert_told(&bad, out, count, passes[which][desc->solver]));
            bad.armed = false;
        }
        assert_int_equal(plumb_world_step(twin.w, R(HZ60)), PLUMB_OK);
        assert_alike(&bad, &twin, i);
    }
    assert_null(plumb_world_quarantine_events(bad.w, NULL));
    plumb_world_destroy(bad.w);
    plumb_world_destroy(twin.w);
}

static void others_do_not_notice(void **state)
{
    (void)state;
    for (int which = 0; which < TROUBLES; ++which) {
        for (int solver = 0; solver < 2; ++solver) {
            const plumb_world_desc d = { .solver = (plumb_solver)solver,
                                         .simd_width = 4 << (which + solver) % 3,
                                         .workers = 1 + which % 2 };
            go_through(&d, (trouble)which);
        }
    }
}

// Such a step is recorded and replayed like any other; an image taken before it gives it again.
static void it_is_replayed(void **state)
{
    (void)state;
    for (int which = 0; which < TROUBLES; ++which) {
        stage s;
        recording r = { 0 };
        set_up(&s, &(plumb_world_desc){ 0 }, (trouble)which);
        sim_run(s.w, BEFORE, HZ60);
        assert_int_equal(plumb_recorder_start(
                             s.w, &(plumb_recorder_desc){ .write = to_recording, .context = &r }),
                         PLUMB_OK);
        make_trouble(&s);
        for (int i = 0; i < 5; ++i) {
            assert_int_equal(plumb_world_step(s.w, R(HZ60)), PLUMB_OK);
            s.armed = false;
        }
        const uint64_t hash = plumb_world_hash(s.w);
        assert_int_equal(plumb_recorder_stop(s.w), PLUMB_OK);
        plumb_replay *replay;
        assert_int_equal(plumb_replay_open(r.bytes, r.size, NULL, &replay), PLUMB_OK);
        for (int i = 0; i < 5; ++i) {
            if (plumb_replay_step(replay) != PLUMB_OK) {
                fail_msg("trouble %d, step %d: %s", which, i, plumb_replay_error(replay));
            }
        }
        assert_true(plumb_world_hash(plumb_replay_world(replay)) == hash);
        plumb_replay_close(replay);
        recording_free(&r);
        plumb_world_destroy(s.w);
    }
}

// Its place is kept, and it can be brought back.
static void it_comes_back(void **state)
{
    (void)state;
    stage s;
    set_up(&s, &(plumb_world_desc){ .no_exact_islands = true }, HURLED);
    sim_run(s.w, BEFORE, HZ60);
    const plumb_vec2 at = plumb_body_position(s.w, victim(&s));
    make_trouble(&s);
    sim_run(s.w, 1, HZ60);
    const plumb_vec2 now = plumb_body_position(s.w, victim(&s));
    assert_true(at.x == now.x && at.y == now.y);
    assert_int_equal(plumb_body_set_enabled(s.w, victim(&s), true), PLUMB_OK);
    sim_run(s.w, 60, HZ60);
    assert_int_equal(plumb_world_stats(s.w).arrested_count, 1);
    assert_near(sim_y(s.w, victim(&s)), (double)at.y, 0.05);
    plumb_world_destroy(s.w);
}

// Of those that fly beyond the bounds the first ones are told, all are counted and out.
static void many_at_once(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    enum { MANY = PLUMB_QUARANTINE_MAX + 9 };
    for (int i = 0; i < MANY; ++i) {
        plumb_body b = sim_body(w, i % 3 == 0 ? PLUMB_KINEMATIC : PLUMB_DYNAMIC, 1e9, i, 0);
        plumb_body_set_velocity(w, b, sim_vec(9.995e11, 0));
    }
    plumb_body calm = sim_body(w, PLUMB_DYNAMIC, 0, 0, 0);
    int count;
    sim_run(w, 1, 1);
    const plumb_quarantine *q = plumb_world_quarantine_events(w, &count);
    assert_int_equal(count, PLUMB_QUARANTINE_MAX);
    assert_string_equal(q[0].pass, "motion");
    assert_int_equal(plumb_world_stats(w).arrested_count, MANY);
    assert_int_equal(plumb_world_stats(w).disabled_count, MANY);
    assert_true(plumb_body_is_enabled(w, calm));
    sim_run(w, 1, HZ60);
    assert_null(plumb_world_quarantine_events(w, &count));
    assert_int_equal(count, 0);
    assert_null(plumb_world_quarantine_events(NULL, NULL));
    plumb_world_destroy(w);
}

// A step that runs out of memory while it is taken anew is refused; it can be tried again.
static void out_of_memory(void **state)
{
    (void)state;
    for (long at = 0, refused = 1; refused; ++at) {
        heap h = HEAP_INIT;
        stage s;
        set_up(&s, &(plumb_world_desc){ .allocator = heap_allocator(&h) }, STRUCK);
        sim_run(s.w, BEFORE, HZ60);
        make_trouble(&s);
        heap_fail(&h, at);
        plumb_result r = plumb_world_step(s.w, R(HZ60));
        refused = atomic_load(&h.refused);
        assert_int_equal(r, refused ? PLUMB_E_MEMORY : PLUMB_OK);
        heap_fail(&h, -1);
        assert_int_equal(plumb_world_step(s.w, R(HZ60)), PLUMB_OK);
        assert_int_equal(plumb_world_stats(s.w).arrested_count, 1);
        plumb_world_destroy(s.w);
        assert_int_equal(atomic_load(&h.blocks), 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(others_do_not_notice), cmocka_unit_test(it_is_replayed),
        cmocka_unit_test(it_comes_back),        cmocka_unit_test(many_at_once),
        cmocka_unit_test(out_of_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
