// test_api_schedule.c - the user's systems as rows of the step: where they stand, whom they act on, what they may
// replace; what a world notes of its own steps.
#include "world_fixture.h"

#include <math.h>
#include <string.h>

#define W           f->world
#define SYSTEM(...) plumb_system_create(W, &(plumb_system_desc){ __VA_ARGS__ })
#define ROWS        512

static void nothing(const plumb_system_call *call)
{
    (void)call;
}

// Line of a row in the schedule; -1: there is none.
static int line_of(const plumb_world *w, const char *name)
{
    static plumb_pass_info rows[ROWS];
    const int count = plumb_world_schedule(w, rows, ROWS);
    for (int i = 0; i < count; ++i) {
        if (strcmp(rows[i].name, name) == 0) {
            return i;
        }
    }
    return -1;
}

static plumb_pass_info row_of(const plumb_world *w, const char *name)
{
    static plumb_pass_info rows[ROWS];
    const int line = line_of(w, name);
    assert_true(line >= 0);
    plumb_world_schedule(w, rows, ROWS);
    return rows[line];
}

//---- where they stand ----------------------------------------------------------------------------

static void systems_stand_where_they_ask_to(void **state)
{
    fixture *f = *state;
    assert_int_equal(SYSTEM(.name = "a", .phase = PLUMB_PHASE_FORCES, .run = nothing), PLUMB_OK);
    assert_int_equal(
        SYSTEM(.name = "b", .phase = PLUMB_PHASE_FORCES, .run = nothing, .before = "a"), PLUMB_OK);
    assert_int_equal(
        SYSTEM(.name = "c", .phase = PLUMB_PHASE_BEGIN, .run = nothing, .after = "broad phase"),
        PLUMB_OK);
    assert_int_equal(
        SYSTEM(.name = "d", .phase = PLUMB_PHASE_BEGIN, .run = nothing, .after = "broad phase"),
        PLUMB_OK);
    assert_int_equal(SYSTEM(.name = "e", .phase = PLUMB_PHASE_BEGIN, .run = nothing, .after = "b",
                            .before = "broad phase"),
                     PLUMB_OK);
    assert_int_equal(SYSTEM(.name = "g", .phase = PLUMB_PHASE_SUBSTEP, .run = nothing), PLUMB_OK);
    assert_int_equal(
        SYSTEM(.name = "h", .phase = PLUMB_PHASE_SUBSTEP, .run = nothing, .after = "positions"),
        PLUMB_OK);
    assert_int_equal(
        SYSTEM(.name = "i", .phase = PLUMB_PHASE_END, .run = nothing, .before = "events"),
        PLUMB_OK);
    const char *const order[] = { "guard",          "b",           "e",         "a",
                                  "characters",     "broad phase", "c",         "d",
                                  "internal edges", "soft step",   "g",         "damping",
                                  "integrate",      "contacts",    "positions", "h",
                                  "motion",         "i",           "events" };
    for (size_t i = 1; i < sizeof order / sizeof order[0]; ++i) {
        assert_true(line_of(W, order[i - 1]) < line_of(W, order[i]));
    }
    assert_int_equal(line_of(W, "e"), line_of(W, "b") + 1);
    assert_int_equal(line_of(W, "d"), line_of(W, "broad phase") + 2);
    assert_int_equal(line_of(W, "i"), line_of(W, "events") - 1);
    assert_string_equal(row_of(W, "g").phase, "moment");
    assert_string_equal(row_of(W, "h").phase, "positions");
    assert_true(row_of(W, "h").in_substeps && row_of(W, "h").is_user);
    assert_false(row_of(W, "i").in_substeps);
}

static void systems_that_cannot_stand_there_are_refused(void **state)
{
    fixture *f = *state;
    REFUSED(
        E_MISSING,
        "plumb_system_create: before is 'brood phase'; it must be a row of the schedule: a pass "
        "or a system",
        SYSTEM(.name = "a", .run = nothing, .before = "brood phase"));
    REFUSED(E_MISSING,
            "plumb_system_create: after is 'x'; it must be a row of the schedule: a pass or a "
            "system",
            SYSTEM(.name = "a", .run = nothing, .after = "x"));
    REFUSED(E_STATE,
            "plumb_system_create: after is 'motion' in the stage finish; a system of this phase "
            "must stand in the stages begin to contacts",
            SYSTEM(.name = "a", .phase = PLUMB_PHASE_FORCES, .run = nothing, .after = "motion"));
    REFUSED(
        E_STATE,
        "plumb_system_create: before is 'contacts' in the stage constraints; a system of this "
        "phase must stand in the stage edits",
        SYSTEM(.name = "a", .phase = PLUMB_PHASE_CONTACTS, .run = nothing, .before = "contacts"));
    REFUSED(E_STATE,
            "plumb_system_create: after is 'graph' in the stage graph; a system of this phase must "
            "stand in the stages moment to sums",
            SYSTEM(.name = "a", .phase = PLUMB_PHASE_SUBSTEP, .run = nothing, .after = "graph"));
    REFUSED(E_STATE,
            "plumb_system_create: before is 'guard' in the stage commands; a system of this phase "
            "must stand in the stages finish to end",
            SYSTEM(.name = "a", .phase = PLUMB_PHASE_END, .run = nothing, .before = "guard"));
    REFUSED(E_STATE,
            "plumb_system_create: after is 'surfaces' and before is 'broad phase'; the first must "
            "stand before the second",
            SYSTEM(.name = "a", .run = nothing, .after = "surfaces", .before = "broad phase"));
    REFUSED(
        E_MISSING, "plumb_system_create: instead is 'dampings'; it must be a pass",
        SYSTEM(.name = "a", .phase = PLUMB_PHASE_SUBSTEP, .run = nothing, .instead = "dampings"));
    REFUSED(E_STATE,
            "plumb_system_create: instead is 'broad phase'; the rows behind it rely on what it "
            "leaves: it cannot be replaced",
            SYSTEM(.name = "a", .run = nothing, .instead = "broad phase"));
    assert_int_equal(
        SYSTEM(.name = "a", .phase = PLUMB_PHASE_SUBSTEP, .run = nothing, .instead = "damping"),
        PLUMB_OK);
    REFUSED(
        E_DUPLICATE, "plumb_system_create: instead is 'damping'; 'a' runs in its place already",
        SYSTEM(.name = "b", .phase = PLUMB_PHASE_SUBSTEP, .run = nothing, .instead = "damping"));
    REFUSED(E_DUPLICATE, "plumb_system_create: name is 'damping'; it must be new",
            SYSTEM(.name = "damping", .run = nothing));
    REFUSED(E_MISSING,
            "plumb_system_create: writes names 'velocity'; it must name data of plumb_data_name or "
            "components",
            SYSTEM(.name = "b", .run = nothing, .writes = "forces, velocity"));
    REFUSED(E_MISSING,
            "plumb_system_create: reads names 'wealth'; it must name data of plumb_data_name or "
            "components",
            SYSTEM(.name = "b", .run = nothing, .reads = "health,wealth"));
    char wide[80] = { 0 };
    memset(wide, 'x', sizeof wide - 1);
    REFUSED(E_RANGE,
            "plumb_system_create: instead is 'xxxxxxxxxxxxxxxx...'; it must have at most 63 "
            "characters",
            SYSTEM(.name = "b", .run = nothing, .instead = wide));
    assert_string_equal(plumb_data_name(0), "rows");
    assert_null(plumb_data_name(-1));
    assert_null(plumb_data_name(1000));
}

static void data_has_bytes(void **state)
{
    fixture *f = *state;
    const size_t bodies = plumb_world_stats(f->world).body_count;
    for (int i = 0; plumb_data_name(i) != NULL; ++i) {
        if (strcmp(plumb_data_name(i), "velocities") == 0) {
            assert_int_equal(plumb_data_bytes(f->world, i), bodies * 3 * sizeof(plumb_real));
        }
    }
    assert_int_equal(plumb_data_bytes(f->world, -1), 0);
    assert_int_equal(plumb_data_bytes(f->world, 1000), 0);
    assert_int_equal(plumb_data_bytes(NULL, 0), 0);
}

//---- in the substeps -----------------------------------------------------------------------------

// A spring to a place, and its drag.
typedef struct spring {
    double x, stiffness; // [m], [N/m]
} spring;

typedef struct pull {
    plumb_component spring, drag;
    int calls, bodies;
} pull;

// Acceleration of the moment towards the place, on those that have a drag besides.
static void attract(const plumb_system_call *call)
{
    const plumb_substep *s = call->substep;
    const plumb_body_span b = plumb_world_bodies(call->world);
    for (int i = 0; i < s->count; ++i) {
        const spring *k = (const spring *)s->values[0] + s->at[0][i];
        const double drag = ((const double *)s->values[1])[s->at[1][i]];
        const plumb_substep_body *body = &s->bodies[s->slot[i]];
        const double x = (double)b.center_x[s->row[i]] + (double)body->dx;
        const double force = k->stiffness * (k->x - x) - drag * (double)body->vx;
        s->motions[s->slot[i]].ax += (plumb_near)(force * (double)body->inv_mass);
    }
}

static void attract_and_count(const plumb_system_call *call)
{
    pull *p = call->context;
    attract(call);
    ++p->calls;
    p->bodies += call->substep->count;
}

// Worst error of a body that swings freely on its spring for 2 s, against the cosine.
static double swing(plumb_world_desc desc, bool parallel)
{
    plumb_world *w = NULL;
    desc.zero_gravity = true;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    pull p = { .spring = plumb_component_create(
                   w, &(plumb_component_desc){ .name = "spring", .size = sizeof(spring) }),
               .drag = plumb_component_create(
                   w, &(plumb_component_desc){ .name = "drag", .size = sizeof(double) }) };
    const plumb_body b =
        plumb_body_create(w, &(plumb_body_desc){ .position = { 1, 0 }, .mass = 2 });
    const plumb_body other = plumb_body_create(w, &(plumb_body_desc){ .position = { 5, 0 } });
    plumb_component_set(w, b.entity, p.spring, &(spring){ 0, 18 });
    plumb_component_set(w, other.entity, p.spring, &(spring){ 0, 18 });
    plumb_component_set(w, b.entity, p.drag, &(double){ 0 });
    const plumb_system_desc system = { .name = "attract",
                                       .phase = PLUMB_PHASE_SUBSTEP,
                                       .run = parallel ? attract : attract_and_count,
                                       .needs = { p.spring, p.drag },
                                       .reads = "solver bodies, spring, drag",
                                       .writes = "accelerations",
                                       .parallel = parallel,
                                       .context = &p };
    assert_int_equal(plumb_system_create(w, &system), PLUMB_OK);
    double worst = 0;
    for (int i = 1; i <= 120; ++i) {
        assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
        const double error = (double)plumb_body_position(w, b).x - cos(3.0 * i / 60);
        worst = fabs(error) > worst ? fabs(error) : worst;
    }
    assert_near(plumb_body_position(w, other).x, 5, 0); // it has no drag: it is none of theirs
    if (!parallel) {
        const int substeps = plumb_world_settings(w).substeps;
        assert_int_equal(p.calls, 120 * substeps);
        assert_int_equal(p.bodies, 120 * substeps);
    }
    plumb_world_destroy(w);
    return worst;
}

static void a_force_of_the_moment_follows_the_substeps(void **state)
{
    (void)state;
    for (int solver = 0; solver < 3; ++solver) {
        const plumb_solver which = (plumb_solver)solver;
        const double few = swing((plumb_world_desc){ .substeps = 4, .solver = which }, false);
        const double many = swing((plumb_world_desc){ .substeps = 32, .solver = which }, false);
        assert_true(few < 0.02 && many < few / 6);
        assert_true(swing((plumb_world_desc){ .substeps = 4, .solver = which }, true) == few);
    }
}

// Piles of boxes, all pulled sideways; the state after a second.
static uint64_t piles(plumb_world_desc desc, bool parallel, unsigned watched)
{
    plumb_world *w = NULL;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    pull p = { .spring = plumb_component_create(
                   w, &(plumb_component_desc){ .name = "spring", .size = sizeof(spring) }),
               .drag = plumb_component_create(
                   w, &(plumb_component_desc){ .name = "drag", .size = sizeof(double) }) };
    const plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    const plumb_shape_desc floor = { .kind = PLUMB_BOX, .half = { 5000, 1 }, .center = { 0, -1 } };
    assert_int_equal(made(w, plumb_shape_create(w, ground, &floor)), PLUMB_OK);
    for (int i = 0; i < 1500; ++i) {
        const plumb_real x = R(3 * (i / 5)) + R(0.1) * R(i % 3), y = R(0.5) + R(i % 5);
        const plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .position = { x, y } });
        plumb_shape_create(w, b,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) } });
        if (i % 7 != 0) {
            plumb_component_set(w, b.entity, p.spring, &(spring){ (double)x + 1, 2 });
        }
        if (i % 3 != 0) {
            plumb_component_set(w, b.entity, p.drag, &(double){ 0.5 });
        }
        if (i % 4 == 0) {
            plumb_body_set_damping(w, b, R(0.5), R(0.1));
            plumb_body_set_speed_cap(w, b, R(0.8), 1);
        }
    }
    const plumb_system_desc system = { .name = "attract",
                                       .phase = PLUMB_PHASE_SUBSTEP,
                                       .run = attract,
                                       .needs = { p.spring, p.drag },
                                       .writes = "accelerations",
                                       .parallel = parallel };
    assert_int_equal(plumb_system_create(w, &system), PLUMB_OK);
    assert_int_equal(plumb_world_watch(w, watched), PLUMB_OK);
    for (int i = 0; i < 30; ++i) {
        assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
    }
    assert_int_equal(plumb_world_error(w).code, PLUMB_OK);
    const uint64_t hash = plumb_world_hash(w);
    plumb_world_destroy(w);
    return hash;
}

static void threads_and_clusters_change_no_bit(void **state)
{
    (void)state;
    const plumb_world_desc one = { 0 }, three = { .workers = 3 };
    const uint64_t hash = piles(one, true, PLUMB_WATCH_NOTHING);
    assert_true(piles(three, true, PLUMB_WATCH_NOTHING) == hash);
    assert_true(piles(three, false, PLUMB_WATCH_NOTHING) == hash);
    assert_true(piles(one, false, PLUMB_WATCH_TIMES) == hash);
    assert_true(piles(three, true, PLUMB_WATCH_TIMES) == hash);
}

//---- ranges --------------------------------------------------------------------------------------

// Each row's force is its place, whoever writes it.
static void push_rows(const plumb_system_call *call)
{
    const plumb_body_span b = plumb_world_bodies(call->world);
    for (int i = call->first; i < call->end && i < b.dynamic_count; ++i) {
        b.fx[i] += R(i + 1);
    }
}

static void parallel_systems_share_the_rows(void **state)
{
    (void)state;
    for (int workers = 1; workers <= 3; workers += 2) {
        plumb_world *w = NULL;
        assert_int_equal(plumb_world_create(&(plumb_world_desc){ .workers = workers }, &w),
                         PLUMB_OK);
        for (int i = 0; i < 2000; ++i) {
            plumb_body_create(w, &(plumb_body_desc){ .position = { R(i), 0 }, .mass = 1 });
        }
        const plumb_system_desc system = {
            .name = "push", .phase = PLUMB_PHASE_FORCES, .run = push_rows, .parallel = true
        };
        assert_int_equal(plumb_system_create(w, &system), PLUMB_OK);
        assert_int_equal(plumb_world_step(w, R(0.5)), PLUMB_OK);
        const plumb_body_span b = plumb_world_bodies(w);
        for (int i = 0; i < 2000; ++i) {
            assert_true(b.vx[i] == R(0.5) * R(i + 1));
        }
        plumb_world_destroy(w);
    }
}

//---- in place of a pass --------------------------------------------------------------------------

static void brake(const plumb_system_call *call)
{
    const plumb_substep *s = call->substep;
    for (int i = 0; i < s->count; ++i) {
        s->motions[s->slot[i]].ax -= 2 * s->bodies[s->slot[i]].vx;
    }
}

static void a_system_runs_in_place_of_a_pass(void **state)
{
    fixture *f = *state;
    plumb_world_set_gravity(W, plumb_v2(0, 0));
    plumb_body_set_velocity(W, f->dynamic, plumb_v2(1, 0));
    plumb_body_set_damping(W, f->dynamic, 50, 0);
    const plumb_body other = plumb_body_create(
        W, &(plumb_body_desc){ .position = { 0, 90 }, .velocity = { 1, 0 }, .damping = 50 });
    plumb_component_set(W, f->dynamic.entity, f->health, NULL);
    assert_int_equal(SYSTEM(.name = "brake", .phase = PLUMB_PHASE_SUBSTEP, .run = brake,
                            .needs = { f->health }, .instead = "damping"),
                     PLUMB_OK);
    assert_false(row_of(W, "damping").scheduled);
    assert_string_equal(row_of(W, "damping").reason, "a system of the user's runs in its place");
    plumb_world_step(W, R(0.1)); // 4 substeps
    assert_near(plumb_body_velocity(W, f->dynamic).x, pow(1 - 2 * 0.1 / 4, 4), 1e-6);
    assert_near(plumb_body_velocity(W, other).x, 1, 0); // in free flight as well
    assert_int_equal(plumb_system_enable(W, "brake", false), PLUMB_OK);
    assert_true(row_of(W, "damping").scheduled);
    plumb_world_step(W, R(0.1));
    assert_near(plumb_body_velocity(W, other).x, exp(-5), 1e-6);
}

// Gravity towards the origin.
static void fall_in(const plumb_system_call *call)
{
    const plumb_body_span b = plumb_world_bodies(call->world);
    for (int i = 0; i < b.dynamic_count; ++i) {
        b.fy[i] -= b.y[i] > 0 ? 1 / b.inv_mass[i] : -1 / b.inv_mass[i];
    }
}

static void gravity_can_be_replaced(void **state)
{
    fixture *f = *state;
    plumb_world_set_gravity(W, plumb_v2(0, -10));
    const plumb_body low = plumb_body_create(W, &(plumb_body_desc){ .position = { 50, -9 } });
    assert_true(row_of(W, "gravity").scheduled);
    assert_int_equal(SYSTEM(.name = "fall in", .phase = PLUMB_PHASE_FORCES, .run = fall_in,
                            .instead = "gravity"),
                     PLUMB_OK);
    assert_true(line_of(W, "fall in") < line_of(W, "characters"));
    plumb_world_step(W, R(0.5));
    assert_near(plumb_body_velocity(W, f->dynamic).y, -0.5, 1e-6);
    assert_near(plumb_body_velocity(W, low).y, 0.5, 1e-6);
}

//---- watched -------------------------------------------------------------------------------------

static void times_are_noted_while_watched(void **state)
{
    fixture *f = *state;
    SYSTEM(.name = "push", .phase = PLUMB_PHASE_FORCES, .run = push_rows);
    SYSTEM(.name = "brake", .phase = PLUMB_PHASE_SUBSTEP, .run = brake);
    plumb_body_set_type(W, f->kinematic, PLUMB_DYNAMIC);
    plumb_body_teleport(W, f->kinematic, plumb_v2(0, 6), 0);
    static const char *const names[] = { "push",      "brake",    "broad phase", "narrow phase",
                                         "integrate", "contacts", "positions",   "relax contacts",
                                         "soft step", "motion" };
    for (int watched = 0; watched < 3; ++watched) {
        assert_int_equal(plumb_world_watch(W, watched == 1 ? PLUMB_WATCH_TIMES : 0), PLUMB_OK);
        for (int i = 0; i < 3; ++i) {
            plumb_world_step(W, R(0.01));
        }
        for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
            const plumb_pass_info row = row_of(W, names[i]);
            assert_true(row.scheduled);
            assert_int_equal(row.total_ns > 0, watched > 0);
            assert_true(watched != 1 || (row.last_ns > 0 && row.last_ns <= row.total_ns));
        }
        assert_true(row_of(W, "joints").total_ns == 0);
    }
    REFUSED(E_RANGE, "plumb_world_watch: what is 4; it must be a sum of plumb_watch",
            plumb_world_watch(W, 4));
    assert_int_equal(plumb_world_watch(NULL, 0), PLUMB_E_NULL);
}

static void watch_within(const plumb_system_call *call)
{
    fixture *f = call->context;
    REFUSED(E_LOCKED,
            "plumb_world_watch: the world is stepping (system 'a'); call it between steps",
            plumb_world_watch(W, 1));
}

static void is_not_to_be_changed_within_a_step(void **state)
{
    fixture *f = *state;
    SYSTEM(.name = "a", .run = watch_within, .context = f);
    plumb_world_step(W, R(0.01));
    assert_int_equal(f->errors, 1);
}

// Writes what it does not say.
static void cheat(const plumb_system_call *call)
{
    const plumb_body_span b = plumb_world_bodies(call->world);
    b.vx[0] += 1;
}

static void cheat_within(const plumb_system_call *call)
{
    call->substep->bodies[call->substep->slot[0]].vx += 1;
}

static void what_is_written_is_held_to_what_was_declared(void **state)
{
    fixture *f = *state;
    assert_int_equal(plumb_world_watch(W, PLUMB_WATCH_WRITES), PLUMB_OK);
    SYSTEM(.name = "cheat", .run = cheat, .writes = "forces, health");
    SYSTEM(.name = "silent", .run = cheat);
    SYSTEM(.name = "honest", .run = cheat, .writes = "velocities");
    plumb_world_step(W, R(0.01));
    assert_int_equal(f->errors, 1);
    assert_string_equal(f->logged,
                        "plumb_world_step: 'cheat' changed velocities, which it does not "
                        "declare to write");
    assert_int_equal(plumb_world_error(W).code, PLUMB_E_STATE);
    assert_int_equal(plumb_system_enable(W, "cheat", false), PLUMB_OK);
    SYSTEM(.name = "in", .phase = PLUMB_PHASE_SUBSTEP, .run = cheat_within,
           .writes = "accelerations");
    plumb_world_step(W, R(0.01));
    assert_int_equal(f->errors, 1 + 4); // a substep each
    assert_string_equal(f->logged,
                        "plumb_world_step: 'in' changed solver bodies, which it does not "
                        "declare to write");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(data_has_bytes),
        API_TEST(systems_stand_where_they_ask_to),
        API_TEST(systems_that_cannot_stand_there_are_refused),
        API_TEST(a_force_of_the_moment_follows_the_substeps),
        API_TEST(threads_and_clusters_change_no_bit),
        API_TEST(parallel_systems_share_the_rows),
        API_TEST(a_system_runs_in_place_of_a_pass),
        API_TEST(gravity_can_be_replaced),
        API_TEST(times_are_noted_while_watched),
        API_TEST(is_not_to_be_changed_within_a_step),
        API_TEST(what_is_written_is_held_to_what_was_declared),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
