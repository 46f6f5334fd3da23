// test_api_fracture_commands.c - bodies that systems cut, shatter, merge and scale by commands: refused calls, the same as direct calls
// between steps, events, what is dropped, images and recordings with pending commands, threads, out of memory.
#include "harness/heap.h"
#include "harness/recording.h"
#include "snapshot_fixture.h"

#define DT R(1.0 / 60)

#define NAN_ ((plumb_real)NAN)

static plumb_body add_box(plumb_world *w, plumb_vec2 at, plumb_real half)
{
    const plumb_body b =
        plumb_body_create(w, &(plumb_body_desc){ .position = at, .velocity = { 1, 2 } });
    plumb_shape_create(w, b, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { half, half } });
    return b;
}

static void bad_commands_are_refused(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_body b = f->dynamic, gone = f->stale;
    const plumb_vec2 at = { 0, 5 }, along = { 0, 1 }, nowhere = { NAN_, 0 }, none = { 0, 0 };
    assert_int_equal(plumb_command_body_cut(NULL, b, at, along), PLUMB_E_NULL);
    assert_int_equal(plumb_command_body_shatter(NULL, b, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_command_body_merge(NULL, b, f->fixed), PLUMB_E_NULL);
    assert_int_equal(plumb_command_body_scale(NULL, b, 2), PLUMB_E_NULL);
    const uint64_t before = plumb_world_hash(w);
    REFUSED(E_HANDLE,
            "plumb_command_body_cut: body is stale (0:1); it must be a body or one that a command "
            "makes",
            plumb_command_body_cut(w, gone, at, along));
    REFUSED(E_NOT_FINITE, "plumb_command_body_cut: point is (nan, 0); it must be finite",
            plumb_command_body_cut(w, b, nowhere, along));
    REFUSED(E_RANGE,
            "plumb_command_body_cut: point is (0, 2e+09); each component must be -1e+09 to 1e+09",
            plumb_command_body_cut(w, b, plumb_v2(0, R(2e9)), along));
    REFUSED(E_NOT_FINITE, "plumb_command_body_cut: along is (nan, 0); it must be finite",
            plumb_command_body_cut(w, b, at, nowhere));
    REFUSED(E_RANGE, "plumb_command_body_cut: along is (0, 0); it must not be 0",
            plumb_command_body_cut(w, b, at, none));
    REFUSED(E_HANDLE,
            "plumb_command_body_shatter: body is a shape; it must be a body or one that a command "
            "makes",
            plumb_command_body_shatter(w, (plumb_body){ f->box.entity }, NULL));
    plumb_shatter_desc d = { .cells = 65 };
    REFUSED(E_RANGE, "plumb_command_body_shatter: cells is 65; it must be 0, or 2 to 64",
            plumb_command_body_shatter(w, b, &d));
    d = (plumb_shatter_desc){ .even = -1 };
    REFUSED(E_RANGE, "plumb_command_body_shatter: even is -1; it must be 0 to 1",
            plumb_command_body_shatter(w, b, &d));
    d = (plumb_shatter_desc){ .min_share = NAN_ };
    REFUSED(E_NOT_FINITE, "plumb_command_body_shatter: min_share is nan; it must be finite",
            plumb_command_body_shatter(w, b, &d));
    REFUSED(E_HANDLE, "plumb_command_body_merge: other is body; it must be another",
            plumb_command_body_merge(w, b, b));
    REFUSED(
        E_HANDLE,
        "plumb_command_body_merge: other is null; it must be a body or one that a command makes",
        plumb_command_body_merge(w, b, NO_BODY));
    REFUSED(E_HANDLE,
            "plumb_command_body_merge: body is null; it must be a body or one that a command makes",
            plumb_command_body_merge(w, NO_BODY, b));
    REFUSED(E_HANDLE,
            "plumb_command_body_scale: body is stale (0:1); it must be a body or one that a "
            "command makes",
            plumb_command_body_scale(w, gone, 2));
    REFUSED(E_RANGE, "plumb_command_body_scale: factor is 2000; it must be 0.001 to 1000",
            plumb_command_body_scale(w, b, 2000));
    assert_true(plumb_world_hash(w) == before); // nothing is pending
}

//---- the same as direct calls --------------------------------------------------------------------

typedef struct orders {
    plumb_body box, large, other, third;
    plumb_body parts[64]; // of direct calls
    int cut, shattered;
    bool within; // by commands of a system, once
} orders;

static const plumb_vec2 cut_at = { R(0.25), 8 }, cut_along = { R(0.3), R(-2) };
static const plumb_shatter_desc cells = {
    .point = { 6, 8 }, .cells = 9, .even = R(0.5), .min_share = R(0.01), .seed = 77
};

static void order_all(const plumb_system_call *call)
{
    orders *o = call->context;
    plumb_world *w = call->world;
    if (plumb_world_stats(w).step_count != 2 || !o->within) {
        return;
    }
    o->within = false;
    assert_int_equal(plumb_command_body_cut(w, o->box, cut_at, cut_along), PLUMB_OK);
    assert_int_equal(plumb_command_body_shatter(w, o->large, &cells), PLUMB_OK);
    assert_int_equal(plumb_command_body_merge(w, o->other, o->third), PLUMB_OK);
    assert_int_equal(plumb_command_body_scale(w, o->other, R(1.5)), PLUMB_OK);
    assert_true(plumb_body_valid(w, o->third)); // not yet
}

static void do_all(plumb_world *w, orders *o)
{
    o->cut = plumb_body_cut(w, o->box, cut_at, cut_along, o->parts, 64);
    o->shattered = plumb_body_shatter(w, o->large, &cells, o->parts + o->cut, 64 - o->cut);
    assert_int_equal(plumb_body_merge(w, o->other, o->third, NULL), PLUMB_OK);
    assert_int_equal(plumb_body_scale(w, o->other, R(1.5)), PLUMB_OK);
}

static plumb_world *make_boxes(orders *o, plumb_phase phase, plumb_world_desc desc)
{
    plumb_world *w;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    o->box = add_box(w, plumb_v2(0, 8), 1);
    o->large = add_box(w, plumb_v2(6, 8), R(1.5));
    o->other = add_box(w, plumb_v2(12, 8), 1);
    o->third = add_box(w, plumb_v2(15, 8), R(0.5));
    const plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(w, ground, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 30, 1 } });
    plumb_system_create(w, &(plumb_system_desc){
                               .name = "orders", .phase = phase, .run = order_all, .context = o });
    return w;
}

static void check_events(plumb_world *w, const orders *o)
{
    int count, all;
    const plumb_body_break *e = plumb_world_body_break_events(w, &count);
    const plumb_body *parts = plumb_world_body_break_parts(w, &all);
    assert_int_equal(count, 2);
    assert_int_equal(all, o->cut + o->shattered);
    assert_memory_equal(parts, o->parts, (size_t)all * sizeof *parts);
    assert_true(plumb_same(e[0].body, o->box) && plumb_same(e[1].body, o->large));
    assert_true(e[0].first_part == 0 && e[0].part_count == o->cut);
    assert_true(e[1].first_part == o->cut && e[1].part_count == o->shattered);
    assert_vec_near(e[0].point, 0.25, 8, 0);
    assert_vec_near(e[1].point, 6, 8, 0);
    const double length = sqrt(0.3 * 0.3 + 2 * 2); // to the left of the line
    assert_vec_near(e[0].normal, 2 / length, 0.3 / length, 1e-6);
    assert_vec_near(e[1].normal, 0, 0, 0);
    for (int i = 0; i < 2; ++i) {
        assert_true(plumb_is_null(e[i].other) && e[i].impulse == 0 && e[i].energy == 0);
    }
}

// At whatever phase they are given, step after step.
static void commands_do_what_direct_calls_do(void **state)
{
    (void)state;
    const plumb_phase phases[] = { PLUMB_PHASE_BEGIN, PLUMB_PHASE_FORCES, PLUMB_PHASE_CONTACTS,
                                   PLUMB_PHASE_SUBSTEP, PLUMB_PHASE_END };
    for (int k = 0; k < 5; ++k) {
        orders by_command = { .within = true }, direct = { .within = false };
        plumb_world *a = make_boxes(&by_command, phases[k], (plumb_world_desc){ 0 });
        plumb_world *b = make_boxes(&direct, phases[k], (plumb_world_desc){ 0 });
        for (int i = 0; i < 200; ++i) {
            const bool turn = i == 2 + (phases[k] != PLUMB_PHASE_END);
            if (turn) {
                do_all(b, &direct);
            }
            step(a, 1), step(b, 1);
            assert_int_equal(plumb_world_stats(a).body_count, plumb_world_stats(b).body_count);
            assert_true(digest_world(a) == digest_world(b));
            if (turn) {
                assert_true(direct.cut == 1 && direct.shattered > 4);
                check_events(a, &direct);
            } else {
                assert_null(plumb_world_body_break_events(a, NULL));
            }
            assert_null(plumb_world_body_break_events(b, NULL));
        }
        assert_false(plumb_body_valid(a, by_command.third));
        plumb_world_destroy(a), plumb_world_destroy(b);
    }
}

// A body, its shape and what becomes of it, all in one go.
static void what_commands_make_they_can_cut(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_body b = plumb_command_body_create(w, &(plumb_body_desc){ .position = { 40, 40 } });
    plumb_command_shape_create(w, b, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 2, 1 } });
    const plumb_body c = plumb_command_body_create(w, &(plumb_body_desc){ .position = { 40, 43 } });
    plumb_command_shape_create(w, c, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 2, 2 } });
    plumb_command_body_merge(w, b, c);
    plumb_command_body_scale(w, b, 2);
    // Its centre is at 42, 5/3 of it above that of the lower box before it grew about it.
    plumb_command_body_cut(w, b, plumb_v2(40, 42), plumb_v2(0, 1));
    plumb_command_body_shatter(w, b, NULL);
    assert_int_equal(f->errors + f->warnings, 0);
    assert_int_equal(plumb_commands_apply(w), PLUMB_OK);
    assert_int_equal(f->errors + f->warnings, 0);
    int count, all;
    const plumb_body_break *e = plumb_world_body_break_events(w, &count);
    const plumb_body *parts = plumb_world_body_break_parts(w, &all);
    assert_true(count == 2 && all > 4 && plumb_same(e[0].body, b) && plumb_same(e[1].body, b));
    double mass = (double)plumb_body_mass(w, b);
    for (int i = 0; i < all; ++i) {
        mass += (double)plumb_body_mass(w, parts[i]);
    }
    assert_near(mass, 4 * (8 + 16), 1e-4);
    assert_false(plumb_body_valid(w, c));
}

//---- events --------------------------------------------------------------------------------------

static int count_events(const plumb_world *w)
{
    int count;
    plumb_world_body_break_events(w, &count);
    return count;
}

static void events_are_told_with_their_step(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_command_body_cut(w, f->dynamic, plumb_v2(0, 5), plumb_v2(1, 0));
    assert_int_equal(count_events(w), 0);
    step(w, 1);
    assert_int_equal(count_events(w), 1);
    step(w, 1);
    assert_int_equal(count_events(w), 0);
    // A line that misses, and one that only touches, leave all as it is.
    const uint64_t before = digest_world(w);
    plumb_command_body_cut(w, f->fixed, plumb_v2(1, 0), plumb_v2(0, 1));
    plumb_command_body_cut(w, f->fixed, plumb_v2(3, 0), plumb_v2(0, 1));
    assert_int_equal(plumb_commands_apply(w), PLUMB_OK);
    assert_true(digest_world(w) == before && count_events(w) == 0 && f->warnings == 0);
    // A step in which no time passes is one.
    plumb_command_body_cut(w, f->fixed, plumb_v2(0, 0), plumb_v2(0, 1));
    assert_int_equal(plumb_world_step(w, 0), PLUMB_OK);
    assert_int_equal(count_events(w), 1);
    assert_int_equal(plumb_world_step(w, 0), PLUMB_OK);
    assert_int_equal(count_events(w), 0);
    // Of what is applied between two steps, and the step after it.
    plumb_command_body_cut(w, f->fixed, plumb_v2(0, R(0.3)), plumb_v2(1, 0));
    assert_int_equal(plumb_commands_apply(w), PLUMB_OK);
    assert_int_equal(count_events(w), 1);
    plumb_command_body_cut(w, f->kinematic, plumb_v2(10, 0), plumb_v2(0, 1));
    assert_int_equal(plumb_commands_apply(w), PLUMB_OK);
    assert_int_equal(count_events(w), 2);
    step(w, 1);
    assert_int_equal(count_events(w), 2);
    assert_int_equal(plumb_commands_apply(w), PLUMB_OK);
    assert_int_equal(count_events(w), 0);
}

static void loops_tell_them_too(void **state)
{
    fixture *f = *state;
    plumb_loop *loop;
    assert_int_equal(plumb_loop_create(f->world, NULL, &loop), PLUMB_OK);
    plumb_command_body_cut(f->world, f->dynamic, plumb_v2(0, 5), plumb_v2(1, 0));
    assert_int_equal(plumb_loop_step(loop), PLUMB_OK);
    assert_int_equal(count_events(f->world), 1);
    assert_int_equal(plumb_loop_step(loop), PLUMB_OK);
    assert_int_equal(count_events(f->world), 0);
    plumb_loop_destroy(loop);
}

// Events stay where they are while their parts are cut by direct calls.
static void parts_may_be_cut_while_events_are_read(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_command_body_shatter(w, f->dynamic,
                               &(plumb_shatter_desc){ .point = { 0, 5 }, .cells = 40, .even = 1 });
    step(w, 1);
    int all;
    const plumb_body *parts = plumb_world_body_break_parts(w, &all);
    assert_in_range(all, 10, 39);
    int count = 0;
    for (int i = 0; i < all; ++i) {
        const plumb_vec2 center = plumb_body_center(w, parts[i]);
        assert_true(plumb_body_cut(w, parts[i], center, plumb_v2(1, 0), NULL, 0) > 0);
        ++count;
    }
    assert_true(plumb_world_body_break_parts(w, NULL) == parts && count == all);
}

//---- dropped -------------------------------------------------------------------------------------

static void what_time_undoes_is_dropped(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_body empty = plumb_body_create(w, &(plumb_body_desc){ .position = { 40, 40 } });
    const plumb_body far = add_box(w, plumb_v2(R(9e7), 40), 1);
    const plumb_body small = add_box(w, plumb_v2(50, 50), R(0.01));
    const plumb_body light = add_box(w, plumb_v2(60, 50), 1);
    plumb_shape_create(
        w, light,
        &(plumb_shape_desc){
            .kind = PLUMB_BOX,
            .half = { 1, 1 },
            .center = { 2, 0 },
            .material = plumb_material_create(w, &(plumb_material_desc){ .density = R(1e-30) }) });
    const uint64_t before = digest_world(w);
    plumb_command_body_cut(w, empty, plumb_v2(0, 5), plumb_v2(1, 0));
    plumb_command_body_shatter(w, empty, NULL);
    plumb_command_body_merge(w, small, far);
    plumb_command_body_scale(w, small, R(0.001));
    plumb_command_body_cut(w, light, plumb_v2(61, 50), plumb_v2(0, 1));
    assert_int_equal(f->warnings, 0);
    assert_int_equal(plumb_commands_apply(w), PLUMB_OK);
    assert_int_equal(f->warnings, 5);
    assert_true(digest_world(w) == before && count_events(w) == 0);
    plumb_command_body_cut(w, f->dynamic, plumb_v2(0, 5), plumb_v2(1, 0));
    plumb_command_body_shatter(w, f->dynamic, NULL);
    plumb_command_body_scale(w, f->dynamic, 2);
    plumb_command_body_merge(w, f->dynamic, small);
    plumb_command_body_merge(w, small, f->dynamic);
    plumb_body_destroy(w, f->dynamic);
    const int errors = f->errors;
    assert_int_equal(plumb_commands_apply(w), PLUMB_OK);
    assert_int_equal(f->warnings, 10);
    assert_int_equal(f->errors, errors);
    char wanted[128];
    snprintf(wanted, sizeof wanted,
             "plumb_command_body_merge: dropped for entity %u:1; the other is gone",
             (unsigned)small.entity.index);
    assert_string_equal(f->logged, wanted);
    assert_true(plumb_body_valid(w, small));
}

//---- within steps --------------------------------------------------------------------------------

typedef struct remedy {
    plumb_body body, other;
    char text[4][256];
} remedy;

static void call_directly(const plumb_system_call *call)
{
    remedy *r = call->context;
    plumb_world *w = call->world;
    for (int k = 0; k < 4; ++k) {
        if (k == 0) {
            assert_int_equal(plumb_body_cut(w, r->body, cut_at, cut_along, NULL, 0), -1);
        } else if (k == 1) {
            assert_int_equal(plumb_body_shatter(w, r->body, NULL, NULL, 0), -1);
        } else {
            assert_int_equal(k == 2 ? plumb_body_merge(w, r->body, r->other, NULL)
                                    : plumb_body_scale(w, r->body, 2),
                             PLUMB_E_LOCKED);
        }
        assert_int_equal(plumb_world_error(w).code, PLUMB_E_LOCKED);
        snprintf(r->text[k], sizeof r->text[k], "%s", plumb_world_error(w).message);
    }
}

static void direct_calls_name_the_command(void **state)
{
    fixture *f = *state;
    static const char *const names[] = { "cut", "shatter", "merge", "scale" };
    remedy r = { .body = f->dynamic, .other = f->kinematic };
    plumb_system_create(
        f->world, &(plumb_system_desc){ .name = "direct", .run = call_directly, .context = &r });
    step(f->world, 1);
    for (int k = 0; k < 4; ++k) {
        char wanted[256];
        snprintf(wanted, sizeof wanted,
                 "plumb_body_%s: the world is stepping (system 'direct'); "
                 "use plumb_command_body_%s",
                 names[k], names[k]);
        assert_string_equal(r.text[k], wanted);
    }
}

// Who loses its mark is cut, in the middle of another command: the buffer grows while it is read.
static void cut_marked(plumb_world *w, plumb_entity entity, void *value, void *context)
{
    (void)value;
    const fixture *f = context;
    for (int i = 0; i < 40; ++i) {
        plumb_command_body_cut(w, f->dynamic, plumb_v2(R(i) / 50 - R(0.4), 5), plumb_v2(0, 1));
    }
    plumb_command_body_shatter(w, (plumb_body){ entity }, NULL); // that is on its way out: dropped
}

static void hooks_may_give_them(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    const plumb_component mark = plumb_component_create(
        w, &(plumb_component_desc){
               .name = "mark", .size = 1, .on_remove = cut_marked, .context = f });
    const plumb_body other = add_box(w, plumb_v2(3, 5), 1);
    plumb_component_set(w, other.entity, mark, NULL);
    plumb_command_body_merge(w, f->kinematic, other);
    plumb_command_body_scale(w, f->kinematic, 2);
    step(w, 1);
    assert_false(plumb_body_valid(w, other));
    assert_int_equal(count_events(w), 0);
    step(w, 1);
    assert_int_equal(count_events(w), 40);
    assert_int_equal(f->warnings, 1);
}

//---- saved ---------------------------------------------------------------------------------------

// A system that gives one command a step, each kind in turn, to whoever has the row.
static void give_in_turn(const plumb_system_call *call)
{
    plumb_world *w = call->world;
    const uint32_t turn = (uint32_t)plumb_world_stats(w).step_count;
    const plumb_body_span b = plumb_world_bodies(w);
    const plumb_body who = b.body[turn * 7 % (uint32_t)b.dynamic_count];
    const plumb_body other = b.body[turn * 5 % (uint32_t)b.dynamic_count];
    const plumb_vec2 center = plumb_body_center(w, who);
    plumb_shatter_desc desc;
    memset(&desc, turn % 2 == 0 ? 0 : 0xa5, sizeof desc); // padding is nobody's
    desc.point = center;
    desc.cells = 3;
    desc.even = 1;
    desc.min_share = 0;
    desc.seed = turn;
    switch (turn % 5) {
    case 0:
        plumb_command_body_cut(w, who, center, plumb_v2(R(turn % 7) - 3, 1));
        break;
    case 1:
        plumb_command_body_shatter(w, who, &desc);
        break;
    case 2:
        plumb_command_body_scale(w, who, turn % 2 == 0 ? R(1.25) : R(0.8));
        break;
    default:
        if (!plumb_same(who, other)) {
            plumb_command_body_merge(w, who, other);
        }
        break;
    }
}

static plumb_world *make_heap(plumb_world_desc desc)
{
    plumb_world *w;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    const plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(w, ground, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 30, 1 } });
    for (int i = 0; i < 24; ++i) {
        add_box(w, plumb_v2(R(i % 6) * R(1.3), R(2 + i / 6)), R(0.45));
    }
    plumb_system_create(
        w, &(plumb_system_desc){ .name = "turns", .phase = PLUMB_PHASE_END, .run = give_in_turn });
    return w;
}

// Saved and restored with pending commands after each of 80 steps, elsewhere and in place.
static void images_hold_pending_commands(void **state)
{
    (void)state;
    plumb_world *w = make_heap((plumb_world_desc){ 0 }),
                *other = make_heap((plumb_world_desc){ 0 });
    int told = 0;
    for (int i = 0; i < 80; ++i) {
        step(w, 1);
        told += count_events(w);
        image now = save(w);
        assert_int_equal(plumb_world_restore(other, now.bytes, now.size), PLUMB_OK);
        assert_true(plumb_world_hash(other) == plumb_world_hash(w));
        assert_int_equal(count_events(other), 0); // of another step
        image again = save(other);
        assert_int_equal(again.size, now.size);
        assert_memory_equal(again.bytes, now.bytes, now.size);
        step(w, 2), step(other, 2);
        assert_true(plumb_world_hash(other) == plumb_world_hash(w));
        assert_int_equal(count_events(other), count_events(w));
        assert_int_equal(plumb_world_restore_trusted(w, now.bytes, now.size), PLUMB_OK);
        assert_int_equal(count_events(w), 0);
        free(now.bytes), free(again.bytes);
    }
    assert_true(told > 20);
    plumb_world_destroy(w), plumb_world_destroy(other);
}

// What is pending is part of the hash: each value of each command.
static void pending_commands_are_hashed(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    image start = save(w);
    uint64_t hashes[12];
    for (int k = 0; k < 12; ++k) {
        plumb_shatter_desc d = { .point = { 1, 2 } };
        d.seed = k == 4, d.cells = k == 5 ? 4 : 0, d.even = k == 6,
        d.min_share = k == 7 ? R(0.1) : 0;
        if (k < 3) {
            plumb_command_body_cut(w, f->dynamic, plumb_v2(0, k == 1 ? 1 : 5),
                                   plumb_v2(1, k == 2 ? 1 : 0));
        } else if (k < 8) {
            plumb_command_body_shatter(w, f->dynamic, &d);
        } else if (k < 10) {
            plumb_command_body_merge(w, f->dynamic, k == 8 ? f->fixed : f->kinematic);
        } else {
            plumb_command_body_scale(w, f->dynamic, k == 10 ? 2 : 3);
        }
        hashes[k] = plumb_world_hash(w);
        for (int j = 0; j < k; ++j) {
            assert_true(hashes[j] != hashes[k]);
        }
        assert_int_equal(plumb_world_restore(w, start.bytes, start.size), PLUMB_OK);
    }
    free(start.bytes);
}

static void recordings_hold_what_they_did(void **state)
{
    (void)state;
    plumb_world *w = make_heap((plumb_world_desc){ 0 });
    recording tape = { 0 };
    uint64_t hashes[61];
    assert_int_equal(
        plumb_recorder_start(w, &(plumb_recorder_desc){ .write = to_recording, .context = &tape }),
        PLUMB_OK);
    for (int i = 1; i <= 60; ++i) {
        step(w, 1);
        hashes[i] = plumb_world_hash(w);
    }
    plumb_recorder_stop(w);
    plumb_replay *replay;
    assert_int_equal(plumb_replay_open(tape.bytes, tape.size, NULL, &replay), PLUMB_OK);
    for (int i = 1; i <= 60; ++i) {
        assert_int_equal(plumb_replay_step(replay), PLUMB_OK);
        assert_true(plumb_world_hash(plumb_replay_world(replay)) == hashes[i]);
    }
    plumb_replay_close(replay);
    recording_free(&tape);
    plumb_world_destroy(w);
}

static void threads_and_widths_change_no_bit(void **state)
{
    (void)state;
    uint64_t hash = 0;
    for (int k = 0; k < 5; ++k) {
        plumb_world *w = make_heap(
            (plumb_world_desc){ .workers = k < 3 ? k : 0, .simd_width = k < 3 ? 0 : 4 * (k - 2) });
        step(w, 120);
        hash = k == 0 ? plumb_world_hash(w) : hash;
        assert_true(plumb_world_hash(w) == hash);
        plumb_world_destroy(w);
    }
}

//---- out of memory -------------------------------------------------------------------------------

// Each allocation fails once: the step is refused, and taken again does all that is left, and tells all of it.
static uint64_t play(heap *h, long fail_at, long *asked, int *refused)
{
    *h = (heap)HEAP_INIT;
    orders o = { .within = true };
    plumb_world *w =
        make_boxes(&o, PLUMB_PHASE_END, (plumb_world_desc){ .allocator = heap_allocator(h) });
    step(w, 2);
    const long before = h->calls;
    h->fail_at = fail_at < 0 ? -1 : before + fail_at;
    plumb_result r;
    int told = 0;
    while ((r = plumb_command_body_cut(w, o.other, plumb_v2(R(12.5), 8), plumb_v2(0, 1))) ==
           PLUMB_E_MEMORY) {
        ++*refused;
    }
    while ((r = plumb_command_body_shatter(w, o.other, NULL)) == PLUMB_E_MEMORY) {
        ++*refused;
    }
    for (int i = 0; i < 3; ++i) {
        while ((r = plumb_world_step(w, DT)) == PLUMB_E_MEMORY) {
            ++*refused;
        }
        assert_int_equal(r, PLUMB_OK);
        told += count_events(w);
    }
    assert_int_equal(told, 4);
    *asked = h->calls - before;
    const uint64_t hash = plumb_world_hash(w);
    plumb_world_destroy(w);
    assert_int_equal(h->bytes, 0);
    return hash;
}

static void any_allocation_may_fail(void **state)
{
    (void)state;
    heap_fail_each(play, 8, 1000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(bad_commands_are_refused),
        API_TEST(what_commands_make_they_can_cut),
        API_TEST(events_are_told_with_their_step),
        API_TEST(loops_tell_them_too),
        API_TEST(parts_may_be_cut_while_events_are_read),
        API_TEST(what_time_undoes_is_dropped),
        API_TEST(direct_calls_name_the_command),
        API_TEST(hooks_may_give_them),
        API_TEST(pending_commands_are_hashed),
        cmocka_unit_test(commands_do_what_direct_calls_do),
        cmocka_unit_test(images_hold_pending_commands),
        cmocka_unit_test(recordings_hold_what_they_did),
        cmocka_unit_test(threads_and_widths_change_no_bit),
        cmocka_unit_test(any_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
