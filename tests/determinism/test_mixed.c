// test_mixed.c - random worlds of everything at once: tiles with internal edges, slabs and outlines, one-way
// platforms, sleeping bodies, characters, joints, sensors, filters, contacts edited by a system, bodies
// made, destroyed, disabled, retyped and teleported at any time. Nobody knows what such a world should
// do; but it must do the same, to the last bit, in steps that run out of memory anywhere and are tried
// again, in other SIMD widths, restored from an image, and asked about at any time. And what begins to touch ceases to, once.
// The sanitizers see the rest.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/heap.h"
#include "harness/sim.h"
#include "harness/trials.h"

#define HZ60 (1 / 60.0)

enum { BODIES = 60, STEPS = 220, PAIRS = 4096 };

typedef enum disturbance { NONE, FAILING, MOVED, WIDTH, RESTORED, QUERIED } disturbance;

//---- a world -------------------------------------------------------------------------------------

typedef struct touch {
    plumb_shape a, b;
} touch;

typedef struct run {
    heap heap;
    plumb_world *w;
    unsigned seed;
    plumb_material rough, slick;
    plumb_body body[BODIES];
    touch touching[PAIRS];
    int touch_count;
    uint64_t step;
    void *image;
    size_t image_size;
} run;

static double uniform(run *r, double low, double high)
{
    return sim_uniform(&r->seed, low, high);
}

static unsigned pick(run *r, unsigned count)
{
    return sim_random(&r->seed) % count;
}

// x before y, whatever the compiler evaluates first.
static plumb_vec2 place(run *r, double left, double right, double low, double high)
{
    double x = uniform(r, left, right);
    return sim_vec(x, uniform(r, low, high));
}

// What a system does must follow from the step: one that is refused runs it again.
static void edit(const plumb_system_call *call)
{
    const uint64_t step = plumb_world_stats(call->world).step_count;
    for (int i = 0; i < plumb_contact_edit_count(call->world); ++i) {
        plumb_contact_edit e;
        assert_int_equal(plumb_contact_edit_get(call->world, i, &e), PLUMB_OK);
        const uint64_t salt = e.shape_a.entity.index * 7u + e.shape_b.entity.index * 3u + step / 20;
        e.enabled = salt % 11 != 0;
        e.friction = salt % 3 == 0 ? (plumb_real)0.1 : e.friction;
        e.surface_speed = salt % 5 == 0 ? 1 : 0;
        assert_int_equal(plumb_contact_edit_set(call->world, i, &e), PLUMB_OK);
    }
}

static void add_shape(run *r, plumb_body b, bool ground)
{
    static const plumb_vec2 ell[] = { { 0, 0 },
                                      { 1, 0 },
                                      { 1, (plumb_real)0.5 },
                                      { (plumb_real)0.5, (plumb_real)0.5 },
                                      { (plumb_real)0.5, 1 },
                                      { 0, 1 } };
    plumb_shape_desc d = { .material = pick(r, 2) ? r->rough : r->slick };
    if (pick(r, 8) == 0) {
        d.filter = (plumb_filter){ .category = 2, .mask = pick(r, 2) ? 1 : 3 };
    }
    d.sensor = pick(r, 12) == 0;
    switch (pick(r, 6)) {
    case 0:
        d.kind = PLUMB_CIRCLE;
        d.radius = (plumb_real)uniform(r, 0.1, 0.5);
        break;
    case 1:
        d.kind = PLUMB_CAPSULE;
        d.points = ell;
        d.count = 2;
        d.radius = (plumb_real)0.2;
        break;
    case 2:
        d.kind = PLUMB_OUTLINE;
        d.points = ell;
        d.count = 6;
        break;
    default:
        d.kind = PLUMB_BOX;
        d.half = sim_vec(ground ? 0.5 : uniform(r, 0.2, 0.9), ground ? 0.25 : 0.3);
        break;
    }
    if (ground && !d.sensor && pick(r, 4) == 0) {
        d.one_way = (plumb_one_way){ { 0, 1 }, 0 };
    }
    plumb_shape_create(r->w, b, &d);
}

// One of the bodies anew: static ones lie in the raster of the tiles.
static void make_body(run *r, int i)
{
    const unsigned type = pick(r, 8);
    plumb_body_desc d = { .position = place(r, -6, 6, 0.5, 6) };
    d.angle = pick(r, 3) == 0 ? (plumb_real)uniform(r, -3, 3) : 0;
    if (type == 0) {
        d.type = PLUMB_STATIC;
        d.position.x = (plumb_real)((double)pick(r, 13) - 6);
        d.position.y = (plumb_real)(0.5 * pick(r, 8) - 0.25);
        d.angle = 0;
    } else if (type == 1) {
        d.type = PLUMB_KINEMATIC;
        d.velocity = sim_vec(uniform(r, -1, 1), 0);
    } else {
        d.asleep = pick(r, 6) == 0;
        d.continuous = pick(r, 4) == 0;
        d.disabled = pick(r, 12) == 0;
    }
    r->body[i] = plumb_body_create(r->w, &d);
    add_shape(r, r->body[i], type == 0);
    if (pick(r, 5) == 0) {
        add_shape(r, r->body[i], type == 0);
    }
    if (type > 0 && pick(r, 8) == 0) {
        plumb_character_create(r->w, r->body[i], NULL);
        plumb_character_walk(r->w, r->body[i], (plumb_real)uniform(r, -2, 2));
    }
}

// An empty world.
static void make_world(run *r, unsigned seed, disturbance how)
{
    const int widths[] = { 4, 8, 16 };
    const plumb_world_desc d = { .allocator = heap_allocator(&r->heap),
                                 .solver = seed % 4 == 3 ? PLUMB_SOLVER_PGS : PLUMB_SOLVER_SOFT,
                                 .sleep_time = (plumb_real)0.15,
                                 .hit_speed = (plumb_real)(seed % 2),
                                 .simd_width = how == WIDTH ? widths[1 + seed % 2] : 4 };
    assert_int_equal(plumb_world_create(&d, &r->w), PLUMB_OK);
    if (seed % 3 == 0) {
        plumb_system_create(r->w, &(plumb_system_desc){
                                      .name = "edit", .phase = PLUMB_PHASE_CONTACTS, .run = edit });
        plumb_system_enable(r->w, "edit", false);
    }
}

static void begin(run *r, unsigned seed, disturbance how)
{
    r->seed = seed;
    make_world(r, seed, how);
    r->rough = sim_material(r->w, 0.6, 0);
    r->slick = sim_material(r->w, 0.05, seed % 3 ? 0.5 : 0);
    for (int i = -16; i <= 16; ++i) {
        plumb_body tile = sim_body(r->w, PLUMB_STATIC, 0.5 * i, -0.75, 0);
        sim_add_box(r->w, tile, 0.25, 0.25, r->rough);
    }
    for (int i = 0; i < BODIES; ++i) {
        make_body(r, i);
    }
}

//---- what users do -------------------------------------------------------------------------------

static void join(run *r, plumb_body a, plumb_body b)
{
    if (plumb_same(a, b)) {
        return;
    }
    plumb_joint_desc d = { .kind = (plumb_joint_kind)pick(r, 12), .body_a = a, .body_b = b };
    d.anchor = plumb_body_position(r->w, a);
    d.anchor_b = plumb_body_position(r->w, b);
    d.ground_a = sim_vec(0, 12);
    d.ground_b = sim_vec(1, 12);
    d.pitch = d.kind == PLUMB_RATCHET ? (plumb_real)0.3 : 0;
    d.break_force = pick(r, 2) ? 500 : 0;
    d.radius_b = d.kind == PLUMB_CABLE ? (plumb_real)-0.2 : 0;
    if (d.kind != PLUMB_DISTANCE && d.kind != PLUMB_PULLEY && d.kind != PLUMB_CABLE) {
        d.anchor_b = sim_vec(0, 0);
    }
    if (d.kind != PLUMB_PULLEY) {
        d.ground_a = d.ground_b = sim_vec(0, 0);
    }
    plumb_joint_create(r->w, &d);
}

static void change(run *r)
{
    plumb_world *w = r->w;
    int i = (int)pick(r, BODIES);
    plumb_body b = r->body[i], other = r->body[pick(r, BODIES)];
    plumb_shape shape[4];
    plumb_joint joint;
    int shapes = plumb_body_shapes(w, b, shape, 4);
    switch (pick(r, 21)) {
    case 0:
    case 1:
        plumb_body_destroy(w, b);
        make_body(r, i);
        break;
    case 2:
        plumb_body_teleport(w, b, place(r, -6, 6, 0, 5), 0);
        break;
    case 3:
        plumb_body_set_enabled(w, b, !plumb_body_is_enabled(w, b));
        break;
    case 4:
        plumb_body_set_type(w, b, (plumb_body_type)pick(r, 3));
        break;
    case 5:
        plumb_body_sleep(w, b);
        break;
    case 6:
        plumb_body_wake(w, b);
        break;
    case 7:
        plumb_body_apply_impulse_center(w, b, place(r, -2, 2, 0, 3));
        break;
    case 8:
        add_shape(r, b, false);
        break;
    case 9:
        if (shapes > 0) {
            plumb_shape_destroy(w, shape[0]);
        }
        break;
    case 10:
        if (shapes > 0) {
            plumb_shape_set_filter(w, shape[0], (plumb_filter){ .group = pick(r, 2) ? -1 : 0 });
        }
        break;
    case 11:
        if (shapes > 0) {
            plumb_shape_set_sensor(w, shape[0], pick(r, 3) == 0);
        }
        break;
    case 12:
    case 13:
        join(r, b, other);
        break;
    case 14:
        if (plumb_body_joints(w, b, &joint, 1) > 0) {
            plumb_joint_destroy(w, joint);
        }
        break;
    case 15:
        plumb_world_exclude_pair(w, b, other, pick(r, 2) == 0);
        break;
    case 16:
        plumb_body_drop_through(w, b);
        plumb_character_drop(w, b);
        plumb_character_jump(w, b, 3);
        break;
    case 17:
        plumb_system_enable(w, "edit", pick(r, 2) == 0);
        break;
    case 18:
        if (plumb_body_get_type(w, b) == PLUMB_KINEMATIC) {
            plumb_body_set_target(w, b, place(r, -4, 4, 0, 4), 0, (plumb_real)0.3);
        }
        break;
    case 19:
        plumb_world_explode(
            w, &(plumb_explosion_desc){
                   .position = place(r, -6, 6, 0, 4), .radius = 1, .falloff = 1, .impulse = 2 });
        break;
    default:
        plumb_world_set_gravity(w, sim_vec(uniform(r, -1, 1), -9.81));
        break;
    }
}

// Questions, anywhere, at random: an answer, and nothing else.
static void ask(run *r, unsigned *chance)
{
    plumb_convex box;
    assert_int_equal(plumb_convex_box(sim_vec(0.5, 0.5), sim_vec(0, 0), 0, 0, &box), PLUMB_OK);
    for (unsigned count = sim_random(chance) % 3; count > 0; --count) {
        const double x = sim_uniform(chance, -7, 7), y = sim_uniform(chance, -1, 6);
        const plumb_vec2 at = sim_vec(x, y), to = sim_vec(y, -1);
        const plumb_query_filter all = { .sensors = true };
        plumb_shape shapes[8];
        switch (sim_random(chance) % 4) {
        case 0:
            plumb_world_ray(r->w, at, to, &all, &(plumb_ray_hit){ .fraction = 0 });
            break;
        case 1:
            plumb_world_cast(
                r->w,
                &(plumb_cast){ .convex = &box, .transform = { at, { 1, 0 } }, .translation = to },
                &all, &(plumb_cast_hit){ .fraction = 0 });
            break;
        case 2:
            plumb_world_nearest(r->w, at, 2, &all, &(plumb_nearest_hit){ .distance = 0 });
            break;
        default:
            plumb_world_overlap_point(r->w, at, &all, shapes, 8);
            break;
        }
    }
}

//---- steps ---------------------------------------------------------------------------------------

static bool is_touch(const touch *t, plumb_shape a, plumb_shape b)
{
    return (plumb_same(t->a, a) && plumb_same(t->b, b)) ||
           (plumb_same(t->a, b) && plumb_same(t->b, a));
}

static int find_touch(const run *r, plumb_shape a, plumb_shape b)
{
    int i = 0;
    while (i < r->touch_count && !is_touch(&r->touching[i], a, b)) {
        ++i;
    }
    return i;
}

static bool is_out(const run *r, plumb_shape shape)
{
    return !plumb_shape_valid(r->w, shape) ||
           !plumb_body_is_enabled(r->w, plumb_shape_body(r->w, shape));
}

// What begins was not there, what ends was.
static void count_touches(run *r)
{
    int begins, ends;
    const plumb_contact_begin *begun = plumb_world_begin_events(r->w, &begins);
    const plumb_contact_end *ended = plumb_world_end_events(r->w, &ends);
    for (int i = 0; i < ends; ++i) {
        int at = find_touch(r, ended[i].shape_a, ended[i].shape_b);
        assert_true(at < r->touch_count);
        r->touching[at] = r->touching[--r->touch_count];
    }
    for (int i = 0; i < begins; ++i) {
        assert_int_equal(find_touch(r, begun[i].shape_a, begun[i].shape_b), r->touch_count);
        assert_true(r->touch_count < PAIRS);
        r->touching[r->touch_count++] = (touch){ begun[i].shape_a, begun[i].shape_b };
    }
    for (int i = 0; i < r->touch_count; ++i) {
        assert_false(is_out(r, r->touching[i].a) || is_out(r, r->touching[i].b));
    }
    static plumb_contact contacts[PAIRS];
    int count = plumb_world_contacts(r->w, contacts, PAIRS);
    for (int i = 0; i < count; ++i) {
        assert_true(find_touch(r, contacts[i].shape_a, contacts[i].shape_b) < r->touch_count);
    }
}

static void save(run *r)
{
    r->image_size = plumb_world_snapshot_size(r->w);
    r->image = realloc(r->image, r->image_size);
    assert_int_equal(plumb_world_save(r->w, r->image, r->image_size), PLUMB_OK);
}

// Into a world that has no room yet for anything that a step needs: every part of it may be refused.
static void move(run *r, unsigned seed)
{
    save(r);
    plumb_world_destroy(r->w);
    make_world(r, seed, MOVED);
    assert_int_equal(plumb_world_restore(r->w, r->image, r->image_size), PLUMB_OK);
}

static void step(run *r, disturbance how, unsigned *chance)
{
    plumb_result result = PLUMB_E_MEMORY;
    const unsigned calls = how == MOVED ? 60 : 6;
    for (int tries = how == MOVED     ? 4
                     : how == FAILING ? 1
                                      : 0;
         tries > 0 && result == PLUMB_E_MEMORY; --tries) {
        heap_fail(&r->heap, (long)(sim_random(chance) % calls));
        result = plumb_world_step(r->w, (plumb_real)HZ60);
    }
    heap_fail(&r->heap, -1);
    if (result == PLUMB_E_MEMORY) {
        result = plumb_world_step(r->w, (plumb_real)HZ60);
    }
    assert_int_equal(result, PLUMB_OK);
    ++r->step;
    if (how == RESTORED && sim_random(chance) % 4 == 0) {
        save(r);
        sim_step(r->w, HZ60);
        sim_step(r->w, HZ60);
        assert_int_equal(plumb_world_restore(r->w, r->image, r->image_size), PLUMB_OK);
    } else if (how != RESTORED) {
        count_touches(r);
    }
}

// Hashes after every step into `hashes`, or compared with them: then, whether they are the same.
static bool play(unsigned seed, disturbance how, uint64_t *hashes, bool compare, long *refused)
{
    bool same = true;
    static run r;
    unsigned chance = seed * 2654435761u + 1;
    r = (run){ .heap = HEAP_INIT };
    begin(&r, seed, how);
    for (int i = 0; i < STEPS && same; ++i) {
        unsigned changes = pick(&r, 3);
        for (unsigned k = 0; k < changes; ++k) {
            change(&r);
            if (how == QUERIED) {
                ask(&r, &chance);
            }
        }
        if (how == QUERIED) {
            ask(&r, &chance);
        }
        if (how == MOVED && sim_random(&chance) % 3 == 0) {
            move(&r, seed);
        }
        step(&r, how, &chance);
        uint64_t hash = plumb_world_hash(r.w);
        if (compare && hash != hashes[i]) {
            print_error("seed %u, disturbance %d: another world after step %d\n", seed, (int)how,
                        i);
            same = false;
        }
        hashes[i] = hash;
    }
    plumb_world_destroy(r.w);
    free(r.image);
    *refused += r.heap.refused;
    return same;
}

enum { WORLDS = 10 };

// Worlds that a refused step once showed in. 17, double: a pair that will meet at some hundred m/s forgot its impulses
// (narrow/settle.c); 137, float: a fast body passed through one that had fallen asleep in that step (continuous/search.c). And where what was told of contacts
// was wrong: 274, double: a body was put to sleep with one that had been disabled, and kept its contact (sleep/fall.h).
// 32, float, and 128, 139, 150, double: characters saw awake what had slept when the step was first tried (sleep/retry.c).
// 137, float, once more, and 2, far: others were looked at than the new contacts, after some pairs had fallen asleep (sleep/lie.c). 30, double, and
// 6, far: a pair held, or passed, by what the refused step had found of a one-way shape (narrow/one_way.c). 63, float and double: a character that slept
// half way through one stood on it (character/obstacle.c). 193, double: a pair that an impact made meet was parted by a face that it remembered
// (broad/pairs.c); float: the refused step took out a pair that touched with those that it had sought (broad/pairs.c).
static const unsigned once[] = { 17, 137, 274, 32, 128, 139, 150, 63, 193 };
#define ONCE (sizeof once / sizeof once[0])

static void compare_with_undisturbed(disturbance how)
{
    static uint64_t hashes[STEPS];
    const trials t = trials_from(1, WORLDS);
    const unsigned count = t.end - t.first;
    long refused = 0, failures = 0;
    for (unsigned i = 0; i < ONCE + count; ++i) {
        const unsigned seed = i < ONCE ? once[i] : t.first + i - (unsigned)ONCE;
        play(seed, NONE, hashes, false, &refused);
        failures += !play(seed, how, hashes, true, &refused);
    }
    if (how == FAILING || how == MOVED) {
        print_message("%u worlds, %ld refused steps\n", count, refused);
        assert_true(refused > 5 * (long)count);
    }
    assert_int_equal(failures, 0);
}

static void refused_steps_leave_no_trace(void **state)
{
    (void)state;
    compare_with_undisturbed(FAILING);
}

static void refused_steps_of_restored_worlds_leave_no_trace(void **state)
{
    (void)state;
    compare_with_undisturbed(MOVED);
}

static void widths_agree(void **state)
{
    (void)state;
    compare_with_undisturbed(WIDTH);
}

static void restored_worlds_go_on_alike(void **state)
{
    (void)state;
    compare_with_undisturbed(RESTORED);
}

static void questions_change_nothing(void **state)
{
    (void)state;
    compare_with_undisturbed(QUERIED);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refused_steps_leave_no_trace),
        cmocka_unit_test(refused_steps_of_restored_worlds_leave_no_trace),
        cmocka_unit_test(widths_agree),
        cmocka_unit_test(restored_worlds_go_on_alike),
        cmocka_unit_test(questions_change_nothing),
    };
    return cmocka_run_group_tests_name("mixed", tests, NULL, NULL);
}
