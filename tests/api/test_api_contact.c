// test_api_contact.c - contacts edited before the solver, hits, events once a pair of shapes.
#include "contact_fixture.h"
#include "harness/random.h"

//---- edits ---------------------------------------------------------------------------------------

typedef struct editor {
    plumb_contact_edit change; // what is set
    int seen;
} editor;

static void edit_all(const plumb_system_call *call)
{
    editor *e = call->context;
    int count = plumb_contact_edit_count(call->world);
    e->seen += count;
    for (int i = 0; i < count; ++i) {
        plumb_contact_edit c;
        assert_int_equal(plumb_contact_edit_get(call->world, i, &c), PLUMB_OK);
        assert_true(c.enabled && c.point_count >= 1 && plumb_shape_valid(call->world, c.shape_a));
        assert_near(c.points[0].x, 0, 20);
        c.friction = e->change.friction;
        c.restitution = e->change.restitution;
        c.surface_speed = e->change.surface_speed;
        c.rolling_resistance = e->change.rolling_resistance;
        c.enabled = e->change.enabled;
        assert_int_equal(plumb_contact_edit_set(call->world, i, &c), PLUMB_OK);
    }
}

static plumb_world *edited_world(editor *e)
{
    plumb_world *w = flat_world((plumb_world_desc){ 0 });
    plumb_system_create(
        w, &(plumb_system_desc){
               .name = "edit", .phase = PLUMB_PHASE_CONTACTS, .run = edit_all, .context = e });
    add_floor(w, NO_MATERIAL);
    return w;
}

static void edits_hold_for_the_step(void **state)
{
    (void)state;
    editor e = { .change = { .friction = 1, .surface_speed = -1, .enabled = true } };
    plumb_world *w = edited_world(&e);
    plumb_body box = plumb_body_create(w, &(plumb_body_desc){ .position = { 0, R(0.5) } });
    plumb_shape_create(w, box,
                       &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } });
    steps(w, 64);
    assert_int_equal(e.seen, 64);
    assert_near(plumb_body_velocity(w, box).x, -1, ROUNDED(1e-3));
    e.change.surface_speed = 0;
    e.change.friction = 0;
    steps(w, 64);
    assert_near(plumb_body_velocity(w, box).x, -1, 1e-3); // nothing brakes it
    plumb_system_enable(w, "edit", false);
    steps(w, 64);
    assert_near(plumb_body_velocity(w, box).x, 0, 1e-3); // as mixed again
    plumb_system_enable(w, "edit", true);
    e.change.enabled = false;
    steps(w, 1);
    int ends;
    plumb_world_end_events(w, &ends);
    assert_int_equal(ends, 1);
    assert_int_equal(plumb_world_contacts(w, NULL, 0), 0);
    assert_int_equal(plumb_world_stats(w).contact_count, 0);
    steps(w, 63);
    assert_near(plumb_body_position(w, box).y, 0.5 - 9.81 / 2, 0.05); // fell freely for a second
    plumb_world_destroy(w);
}

// Takes out the contacts of the body that is its context.
static void disable_one(const plumb_system_call *call)
{
    const plumb_body *body = call->context;
    for (int i = 0; i < plumb_contact_edit_count(call->world); ++i) {
        plumb_contact_edit c;
        plumb_contact_edit_get(call->world, i, &c);
        if (plumb_same(c.body_a, *body) || plumb_same(c.body_b, *body)) {
            c.enabled = false;
            assert_int_equal(plumb_contact_edit_set(call->world, i, &c), PLUMB_OK);
        }
    }
}

static void one_contact_of_many_is_taken_out(void **state)
{
    (void)state;
    plumb_world *w = flat_world((plumb_world_desc){ 0 });
    add_floor(w, NO_MATERIAL);
    plumb_body discs[3];
    for (int i = 0; i < 3; ++i) {
        discs[i] = add_disc(w, 2 * i, 0.5, (plumb_shape_desc){ 0 }, NULL);
    }
    plumb_system_create(w, &(plumb_system_desc){ .name = "one",
                                                 .phase = PLUMB_PHASE_CONTACTS,
                                                 .run = disable_one,
                                                 .context = &discs[0] });
    steps(w, 30);
    assert_true(plumb_body_position(w, discs[0]).y < 0);
    plumb_contact c[3];
    assert_int_equal(plumb_world_contacts(w, c, 3), 2);
    for (int i = 0; i < 2; ++i) {
        double x = plumb_body_position(w, discs[i + 1]).x;
        assert_near(plumb_body_position(w, discs[i + 1]).y, 0.5, 1e-3);
        assert_near(c[i].points[0].point.x, x, ROUNDED(1e-3));
        assert_true(c[i].points[0].normal_impulse > 0);
    }
    plumb_world_destroy(w);
}

static void refuse_edits(const plumb_system_call *call)
{
    fixture *f = call->context;
    plumb_contact_edit c = { .friction = 1 };
    assert_int_equal(plumb_contact_edit_count(W), 1);
    REFUSED(E_RANGE, "plumb_contact_edit_get: i is 1; it must be 0 to 0",
            plumb_contact_edit_get(W, 1, &c));
    REFUSED(E_NULL, "plumb_contact_edit_get: edit is null; it must be given",
            plumb_contact_edit_get(W, 0, NULL));
    REFUSED(E_RANGE, "plumb_contact_edit_set: i is -1; it must be 0 to 0",
            plumb_contact_edit_set(W, -1, &c));
    c.friction = 11;
    REFUSED(E_RANGE, "plumb_contact_edit_set: friction is 11; it must be 0 to 10",
            plumb_contact_edit_set(W, 0, &c));
    c = (plumb_contact_edit){ .restitution = 11 };
    REFUSED(E_RANGE, "plumb_contact_edit_set: restitution is 11; it must be 0 to 10",
            plumb_contact_edit_set(W, 0, &c));
    c = (plumb_contact_edit){ .rolling_resistance = -1 };
    REFUSED(E_RANGE, "plumb_contact_edit_set: rolling_resistance is -1; it must be at least 0",
            plumb_contact_edit_set(W, 0, &c));
    c = (plumb_contact_edit){ .surface_speed = R(NAN) };
    REFUSED(E_NOT_FINITE, "plumb_contact_edit_set: surface_speed is nan; it must be finite",
            plumb_contact_edit_set(W, 0, &c));
}

static void edits_are_refused_out_of_their_phase(void **state)
{
    fixture *f = *state;
    plumb_contact_edit c;
    REFUSED(E_STATE,
            "plumb_contact_edit_count: no system of PLUMB_PHASE_CONTACTS runs; call it from one",
            plumb_contact_edit_count(W) == -1 ? PLUMB_E_STATE : PLUMB_OK);
    REFUSED(E_STATE,
            "plumb_contact_edit_get: no system of PLUMB_PHASE_CONTACTS runs; call it from one",
            plumb_contact_edit_get(W, 0, &c));
    REFUSED(E_STATE,
            "plumb_contact_edit_set: no system of PLUMB_PHASE_CONTACTS runs; call it from one",
            plumb_contact_edit_set(W, 0, &c));
    plumb_body_teleport(W, f->dynamic, plumb_v2(0, R(1.99)), 0);
    plumb_system_create(W, &(plumb_system_desc){ .name = "refused",
                                                 .phase = PLUMB_PHASE_CONTACTS,
                                                 .run = refuse_edits,
                                                 .context = f });
    steps(W, 1);
}

//---- events --------------------------------------------------------------------------------------

static void a_hit_tells_speed_point_and_impulse(void **state)
{
    (void)state;
    for (int solver = 0; solver < 3; ++solver) {
        plumb_world *w =
            flat_world((plumb_world_desc){ .hit_speed = 3, .solver = (plumb_solver)solver });
        plumb_shape floor = add_floor(w, NO_MATERIAL), ball;
        plumb_body body = add_disc(w, 2, 2.5, (plumb_shape_desc){ 0 }, &ball);
        int hits = 0;
        for (int i = 0; i < 128; ++i) {
            steps(w, 1);
            int count;
            const plumb_contact_hit *hit = plumb_world_hit_events(w, &count);
            hits += count;
            if (count > 0) {
                double v = sqrt(2 * 9.81 * 2), m = plumb_body_mass(w, body);
                assert_true(plumb_same(hit->shape_a, floor) || plumb_same(hit->shape_b, floor));
                assert_true(plumb_same(hit->body_a, body) || plumb_same(hit->body_b, body));
                assert_near(hit->approach_speed, v, 0.2);
                assert_near(hit->impulse, m * v, 0.1 * m * v);
                assert_vec_near(hit->point, 2, 0, ROUNDED(0.1));
            }
        }
        assert_int_equal(hits, 1);
        // At rest, the step's impulse is the weight's.
        plumb_contact c;
        assert_int_equal(plumb_world_contacts(w, &c, 1), 1);
        double weight = 9.81 * (double)plumb_body_mass(w, body);
        assert_near(c.points[0].step_impulse, weight / 64, 0.01 * weight / 64);
        assert_int_equal(plumb_world_set_hit_speed(w, 7), PLUMB_OK);
        plumb_body_teleport(w, body, plumb_v2(2, R(2.5)), 0);
        for (int i = 0; i < 64; ++i) {
            steps(w, 1);
            assert_null(plumb_world_hit_events(w, NULL));
        }
        plumb_world_destroy(w);
    }
}

// Told from the next step on, or no more, in a world in which nothing else changes: as in one that was made so.
static void a_hit_speed_holds_from_the_next_step_on(void **state)
{
    (void)state;
    for (int k = 0; k < 40; ++k) {
        const bool off = k >= 20;
        plumb_contact_hit told[2] = { { .impulse = 0 }, { .impulse = 0 } };
        int hits[2] = { 0, 0 };
        for (int set = 0; set < 2; ++set) {
            const bool now = set == 1 ? off : !off; // before it is set
            plumb_world *w = flat_world((plumb_world_desc){ .hit_speed = now ? 1 : 0 });
            add_floor(w, NO_MATERIAL);
            plumb_body lower = add_disc(w, 2, 0.5, (plumb_shape_desc){ 0 }, NULL);
            plumb_body_set_no_sleep(w, lower, true);
            add_disc(w, 2, 3, (plumb_shape_desc){ 0 }, NULL);
            for (int i = 0; i < 64; ++i) {
                if (set == 1 && i == k % 20) {
                    assert_int_equal(plumb_world_set_hit_speed(w, off ? 0 : 1), PLUMB_OK);
                }
                steps(w, 1);
                int count;
                const plumb_contact_hit *hit = plumb_world_hit_events(w, &count);
                told[set] = count > 0 && hits[set] == 0 ? *hit : told[set];
                hits[set] += count;
            }
            plumb_world_destroy(w);
        }
        assert_true((hits[0] > 0) == !off);
        assert_int_equal(hits[0], hits[1]);
        assert_near(told[0].approach_speed, told[1].approach_speed, 1e-6);
        assert_near(told[0].impulse, told[1].impulse, 1e-6);
    }
}

// An elastic ball: the impulse of the impact, (1 + e) m v, is part of the step's.
static void impacts_count_as_impulses(void **state)
{
    (void)state;
    plumb_world *w = flat_world((plumb_world_desc){ .hit_speed = 1, .zero_gravity = true });
    plumb_material ivory =
        plumb_material_create(w, &(plumb_material_desc){ .frictionless = true, .restitution = 1 });
    plumb_body a = add_disc(w, 0, 0, (plumb_shape_desc){ .material = ivory }, NULL);
    add_disc(w, 3, 0, (plumb_shape_desc){ .material = ivory }, NULL);
    plumb_body_set_velocity(w, a, plumb_v2(5, 0));
    int hits = 0;
    for (int i = 0; i < 64; ++i) {
        steps(w, 1);
        int count;
        const plumb_contact_hit *hit = plumb_world_hit_events(w, &count);
        hits += count;
        if (count > 0) {
            double m = plumb_body_mass(w, a);
            assert_near(hit->impulse, m * 5, 1e-3 * m); // 2 x reduced mass m / 2 x 5
            assert_near(hit->approach_speed, 5, ROUNDED(1e-3));
        }
    }
    assert_int_equal(hits, 1);
    plumb_world_destroy(w);
}

static plumb_world *chain_world(plumb_body *disc)
{
    plumb_world *w = flat_world((plumb_world_desc){ .hit_speed = R(0.5) });
    plumb_vec2 line[11];
    for (int i = 0; i < 11; ++i) {
        line[i] = plumb_v2(R(i), 0);
    }
    plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(w, ground,
                       &(plumb_shape_desc){ .kind = PLUMB_CHAIN, .points = line, .count = 11 });
    *disc = add_disc(w, 1, 0.7, (plumb_shape_desc){ 0 }, NULL);
    return w;
}

typedef struct tally {
    int begins, ends, hits, most_contacts;
} tally;

static void count_events(plumb_world *w, tally *t)
{
    int count;
    plumb_world_begin_events(w, &count);
    t->begins += count;
    plumb_world_end_events(w, &count);
    t->ends += count;
    plumb_world_hit_events(w, &count);
    t->hits += count;
    count = plumb_world_contacts(w, NULL, 0);
    t->most_contacts = count > t->most_contacts ? count : t->most_contacts;
}

// Led over ten links, pressed into them by a tenth of a millimetre, and away at the end.
static void a_chain_is_touched_once(void **state)
{
    (void)state;
    plumb_body disc;
    plumb_world *w = chain_world(&disc);
    tally t = { 0 };
    for (int i = 0; i < 220; ++i) {
        plumb_body_set_velocity(w, disc, plumb_v2(0, 0));
        plumb_body_teleport(w, disc, plumb_v2(R(0.5 + 0.05 * i), R(0.4999)), 0);
        steps(w, 1);
        count_events(w, &t);
        assert_int_equal(t.begins, 1);
    }
    assert_true(t.most_contacts == 2); // at the joints
    assert_int_equal(t.ends, 1);
    assert_int_equal(t.hits, 0);
    plumb_world_destroy(w);
}

// It falls on a joint of two links: one begin, one hit, with the impulses of both.
static void a_joint_of_a_chain_is_hit_once(void **state)
{
    (void)state;
    plumb_body disc;
    plumb_world *w = chain_world(&disc);
    double m = plumb_body_mass(w, disc), v = sqrt(2 * 9.81 * 0.2);
    tally t = { 0 };
    for (int i = 0; i < 64; ++i) {
        steps(w, 1);
        count_events(w, &t);
        const plumb_contact_hit *hit = plumb_world_hit_events(w, NULL);
        assert_true(hit == NULL || fabs((double)hit->impulse - m * v) < 0.15 * m * v);
    }
    assert_int_equal(t.begins, 1);
    assert_int_equal(t.ends, 0);
    assert_int_equal(t.hits, 1);
    assert_int_equal(t.most_contacts, 2);
    plumb_world_destroy(w);
}

//---- refusals ------------------------------------------------------------------------------------

static void lock_check(const plumb_system_call *call)
{
    fixture *f = call->context;
    REFUSED(
        E_LOCKED,
        "plumb_shape_set_sensor: the world is stepping (system 'locked'); call it between steps",
        plumb_shape_set_sensor(W, f->box, true));
    REFUSED(E_LOCKED,
            "plumb_world_set_hit_speed: the world is stepping (system 'locked'); call it between "
            "steps",
            plumb_world_set_hit_speed(W, 1));
}

static void what_is_locked_in_a_step(void **state)
{
    fixture *f = *state;
    plumb_system_create(
        W, &(plumb_system_desc){
               .name = "locked", .phase = PLUMB_PHASE_BEGIN, .run = lock_check, .context = f });
    steps(W, 1);
}

//---- lists ---------------------------------------------------------------------------------------

enum { LISTED = 400 };

static bool is_listed(const plumb_contact *c, const plumb_contact *list, int count)
{
    bool any = false;
    for (int i = 0; i < count && !any; ++i) {
        any = plumb_same(c->shape_a, list[i].shape_a) && plumb_same(c->shape_b, list[i].shape_b);
    }
    return any;
}

// What the list of all has of a body is what its own list has.
static void assert_lists_agree(plumb_world *w)
{
    static plumb_contact all[LISTED], own[LISTED];
    const int count = plumb_world_contacts(w, all, LISTED);
    assert_true(count <= LISTED);
    const plumb_body_span span = plumb_world_bodies(w);
    for (int b = 0; b < span.count; ++b) {
        const int of_body = plumb_body_contacts(w, span.body[b], own, LISTED);
        int expected = 0;
        for (int i = 0; i < count; ++i) {
            if (plumb_same(all[i].body_a, span.body[b]) ||
                plumb_same(all[i].body_b, span.body[b])) {
                ++expected;
                assert_true(is_listed(&all[i], own, of_body));
            }
        }
        assert_int_equal(of_body, expected);
    }
}

static void change_something(plumb_world *w, uint32_t *seed)
{
    const plumb_body_span span = plumb_world_bodies(w);
    const plumb_body body = span.body[sim_random(seed) % (uint32_t)span.count];
    switch (sim_random(seed) % 6) {
    case 0:
        plumb_body_sleep(w, body);
        break;
    case 1:
        plumb_body_wake(w, body);
        break;
    case 2:
        plumb_body_set_type(w, body, (plumb_body_type)(sim_random(seed) % 3));
        break;
    case 3:
        plumb_body_teleport(w, body, plumb_v2(0, 9), 0);
        break;
    case 4:
        plumb_body_set_enabled(w, body, sim_random(seed) % 2 == 0);
        break;
    default:
        plumb_body_destroy(w, body);
        break;
    }
}

static void lists_of_bodies_are_those_of_the_world(void **state)
{
    (void)state;
    for (uint32_t n = 0; n < 20; ++n) {
        uint32_t seed = 101 * n + 1;
        plumb_world *w = flat_world((plumb_world_desc){ .sleep_time = R(0.2) });
        add_floor(w, NO_MATERIAL);
        for (int i = 0; i < 30; ++i) {
            add_disc(w, sim_uniform(&seed, -4, 4), 0.5 + i % 5, (plumb_shape_desc){ 0 }, NULL);
        }
        for (int step = 0; step < 120; ++step) {
            steps(w, 1);
            assert_lists_agree(w);
            if (step % 10 == 9) {
                change_something(w, &seed);
                assert_lists_agree(w);
            }
        }
        plumb_world_destroy(w);
    }
}

static void nothing_is_known_of_no_world(void **state)
{
    (void)state;
    int count = 7;
    assert_null(plumb_world_hit_events(NULL, &count));
    assert_int_equal(count, 0);
    assert_null(plumb_world_sensor_begin_events(NULL, &count));
    assert_null(plumb_world_sensor_end_events(NULL, NULL));
    assert_int_equal(plumb_shape_overlaps(NULL, NO_SHAPE, NULL, 0), -1);
    assert_int_equal(plumb_contact_edit_count(NULL), -1);
    assert_int_equal(plumb_contact_edit_get(NULL, 0, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_contact_edit_set(NULL, 0, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_world_exclude_pair(NULL, NO_BODY, NO_BODY, true), PLUMB_E_NULL);
    assert_int_equal(plumb_material_pair_set(NULL, NO_MATERIAL, NO_MATERIAL, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_material_pair_get(NULL, NO_MATERIAL, NO_MATERIAL, NULL), PLUMB_E_NULL);
    assert_int_equal(plumb_world_set_hit_speed(NULL, 0), PLUMB_E_NULL);
    assert_int_equal(plumb_shape_set_sensor(NULL, NO_SHAPE, true), PLUMB_E_NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edits_hold_for_the_step),
        cmocka_unit_test(one_contact_of_many_is_taken_out),
        API_TEST(edits_are_refused_out_of_their_phase),
        cmocka_unit_test(a_hit_tells_speed_point_and_impulse),
        cmocka_unit_test(a_hit_speed_holds_from_the_next_step_on),
        cmocka_unit_test(impacts_count_as_impulses),
        cmocka_unit_test(a_chain_is_touched_once),
        cmocka_unit_test(a_joint_of_a_chain_is_hit_once),
        API_TEST(what_is_locked_in_a_step),
        cmocka_unit_test(lists_of_bodies_are_those_of_the_world),
        cmocka_unit_test(nothing_is_known_of_no_world),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
