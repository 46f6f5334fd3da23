// test_cluster.c - islands solved a cluster at a time: every contact is in one lane of the cluster that
// has both its bodies, every joint in its group, what goes through the whole world is in cluster 0, and
// where clusters begin and end changes no bit.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "solver/solver.h"
#include "joints/wide.h"
#include "joints/joint.h"
#include "harness/sim.h"
#include "world/state.h"

#define DT     ((plumb_real)(1 / 60.0))
#define STACKS 140
#define HIGH   10
#define STEPS  90
#define CHAINS 70
#define LINKS  8

enum { JOINTS = 1, BOUNCE = 2, DAMPING = 4 };

// A plate on more crates than there are colours: some of its contacts find none.
static void add_table(plumb_world *w, double x, plumb_material m)
{
    for (int i = 0; i < 60; ++i) {
        sim_crate(w, x + 0.5 * i, 0.2, 0.2, 0.2, m);
    }
    sim_crate(w, x + 14.75, 0.6, 15, 0.2, m);
}

// The i-th chain's joints: of every sort, some solved in lanes and some one by one, some of which break.
static plumb_joint_desc link_of(int i, double x, double y)
{
    plumb_joint_desc d = { .anchor = sim_vec(x, y) };
    switch (i % 10) {
    case 0:
        d.enable_limit = d.enable_motor = true; // as in ragdolls
        d.lower = (plumb_real)-0.5, d.upper = (plumb_real)0.5, d.max_motor = (plumb_real)0.1;
        break;
    case 1:
        d.kind = PLUMB_DISTANCE;
        d.anchor_b = sim_vec(x + 0.3, y);
        d.hertz = 4, d.damping = (plumb_real)0.2;
        break;
    case 2:
        d.break_force = 10;
        break;
    case 3:
        d.break_impulse = (plumb_real)0.3;
        break;
    case 4:
        d.kind = PLUMB_WELD;
        d.hertz = 3;
        break;
    case 5:
        d.kind = PLUMB_PRISMATIC;
        d.enable_motor = true, d.motor_speed = (plumb_real)0.2, d.max_motor = 3;
        break;
    case 6:
        d.kind = PLUMB_GEAR;
        break;
    case 7:
        d.kind = PLUMB_PULLEY;
        d.anchor_b = sim_vec(x + 0.3, y);
        d.ground_a = sim_vec(x, y + 2), d.ground_b = sim_vec(x + 0.3, y + 2);
        break;
    case 8:
        d.kind = PLUMB_WHEEL;
        d.hertz = 5, d.damping = (plumb_real)0.7;
        break;
    default:
        break;
    }
    return d;
}

// Chains that fall on the stacks and each other, some hung up in the world or on `moving`; bodies in some of
// them are damped or locked.
static void add_chain(plumb_world *w, int i, unsigned special, plumb_body moving)
{
    const double x = -112 + 3.1 * i, y = 6.5;
    plumb_body last = i % 14 == 5 ? moving : (plumb_body)PLUMB_NULL_INIT;
    for (int k = 0; k < LINKS; ++k) {
        plumb_body b = sim_crate(w, x + 0.3 * k, y + 0.1 * (i % 3), 0.12, 0.08,
                                 (plumb_material)PLUMB_NULL_INIT);
        plumb_joint_desc d = link_of(i, x + 0.3 * k - 0.15, y);
        d.kind = k == 0 ? PLUMB_REVOLUTE : d.kind;
        d = k == 0 ? (plumb_joint_desc){ .anchor = d.anchor } : d;
        d.body_a = last, d.body_b = b;
        if (k > 0 || i % 7 == 5) {
            assert_false(plumb_is_null(plumb_joint_create(w, &d)));
        }
        if ((special & DAMPING) != 0 && i % 30 == 11) {
            plumb_body_set_damping(w, b, 1, 1);
        }
        if ((special & DAMPING) != 0 && i % 20 == 12 && k == 4) {
            plumb_body_set_locks(w, b, (plumb_axis_locks){ .x = true });
        }
        last = b;
    }
}

// Stacks side by side, two tables, a platform that moves under some, and what falls on all of it; with
// `special` ones here and there.
static plumb_world *build(const plumb_world_desc *desc, unsigned special)
{
    plumb_world *w = sim_world(desc);
    plumb_material wood = sim_material(w, 0.5, 0);
    plumb_material rubber = sim_material(w, 0.5, (special & BOUNCE) != 0 ? 0.6 : 0);
    sim_floor(w, wood);
    plumb_body moving = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC,
                                                                 .position = sim_vec(-105, 0.1),
                                                                 .velocity = sim_vec(0.3, 0) });
    plumb_shape_create(
        w, moving,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = sim_vec(3.5, 0.1), .material = wood });
    add_table(w, -150, wood);
    plumb_body last = PLUMB_NULL_INIT;
    for (int i = 0; i < STACKS; ++i) {
        double x = -110 + 1.5 * i, floor_y = x > -108.5 && x < -101.5 ? 0.2 : 0;
        for (int k = 0; k < HIGH; ++k) {
            plumb_body b =
                sim_crate(w, x, floor_y + 0.25 + 0.5 * k, 0.25, 0.25, i % 9 == 0 ? rubber : wood);
            if ((special & DAMPING) != 0 && i == 77) {
                plumb_body_set_damping(w, b, 1, 1);
            }
            if ((special & JOINTS) != 0 && i % 40 == 3 && k > 0) {
                plumb_joint_create(w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                           .body_a = last,
                                                           .body_b = b,
                                                           .anchor = sim_vec(x, 0.5 * k) });
            }
            last = b;
        }
    }
    add_table(w, 110, wood);
    for (int i = 0; i < CHAINS && (special & JOINTS) != 0; ++i) {
        add_chain(w, i, special, moving);
    }
    uint32_t seed = 5;
    for (int i = 0; i < 60; ++i) {
        sim_crate(w, sim_uniform(&seed, -140, 130), 6 + 0.1 * i, 0.9, 0.1, wood);
    }
    return w;
}

static bool has(pl_slots slots, uint32_t slot)
{
    return slot >= slots.first && slot < slots.first + slots.count;
}

// The slot of a manifold's body is one of the cluster, or the body does not move.
static void check_end(const plumb_world *w, const pl_cluster *c, uint32_t row)
{
    if (row < w->dynamic_count) {
        assert_true(has(c->slots[0], ((const uint32_t *)w->solver.slots.data)[row]));
    } else if (row < w->dynamic_count + w->kinematic_count) {
        assert_true(has(c->slots[1], ((const uint32_t *)w->solver.slots.data)[row]));
    }
}

// Of a colour, no dynamic body has two contacts; `met` has the last colour of a row, unique in the world.
static void check_color(const plumb_world *w, const pl_manifold *m, uint32_t color, uint32_t *met)
{
    const uint32_t rows[] = { m->body_a, m->body_b };
    for (int k = 0; k < 2; ++k) {
        if (rows[k] < w->dynamic_count) {
            assert_true(met[rows[k]] != color);
            met[rows[k]] = color;
        }
    }
}

// How many manifolds the lanes of a cluster have.
static uint32_t check_lanes(const plumb_world *w, uint32_t i, uint32_t *met)
{
    const pl_solver *s = &w->solver;
    const pl_cluster *c = &pl_clusters(s)[i];
    const uint32_t width = (uint32_t)pl_solver_kernels(w)->width;
    const uint32_t *lanes = (const uint32_t *)s->lanes.data + c->first_lane;
    uint32_t count = 0;
    for (uint32_t color = 0; color < PL_COLOR_SLOTS; ++color) {
        for (uint32_t lane = c->color_first[color] * width;
             lane < c->color_first[color + 1] * width; ++lane) {
            if (lanes[lane] == PL_NONE) {
                continue;
            }
            const pl_manifold *m = &pl_manifolds(&w->narrow)[lanes[lane]];
            check_end(w, c, m->body_a);
            check_end(w, c, m->body_b);
            // Overflow contacts share no body within a bundle.
            uint32_t group = color < PL_COLORS ? color : PL_COLORS + lane / width;
            check_color(w, m, i * 100000 + group + 1, met);
            ++count;
        }
    }
    return count;
}

// Of a colour, no dynamic body has two joints; joints of one bundle have one pattern.
static void check_bundles(const plumb_world *w, uint32_t i, uint32_t *met)
{
    const pl_joint_plan *plan = &w->joints.plan;
    const pl_joint_group *g = &pl_joint_groups(&w->joints)[i];
    const pl_joint_bundle *bundles = plan->bundles.data;
    const uint32_t width = (uint32_t)pl_joint_kernels_of(w)->width;
    uint32_t count = 0;
    for (uint32_t color = 0; color < PL_JOINT_COLORS; ++color) {
        for (uint32_t k = g->color_first[color] * width; k < g->color_first[color + 1] * width;
             ++k) {
            const uint32_t joint = ((const pl_joint_lane *)plan->lanes.data)[k].joint;
            if (joint == PL_NONE) {
                continue;
            }
            const pl_joint_mark *mark = &pl_joint_marks(&w->joints)[joint];
            assert_int_equal(mark->color, color);
            assert_int_equal(mark->pattern, bundles[k / width].pattern);
            const uint32_t rows[] = { mark->row_a, mark->row_b };
            for (int end = 0; end < 2; ++end) {
                if (rows[end] < w->dynamic_count) {
                    assert_true(met[rows[end]] != i * 100 + color + 1);
                    met[rows[end]] = i * 100 + color + 1;
                }
            }
            ++count;
        }
    }
    assert_int_equal(count, g->alone - g->first);
}

// Every joint that is solved is in one group, with both its bodies. Returns how many groups have any.
static uint32_t check_joints(const plumb_world *w)
{
    static uint32_t met[4 * STACKS * HIGH];
    static bool seen[2 * CHAINS * LINKS];
    const pl_solver *s = &w->solver;
    uint32_t count = 0, peopled = 0;
    memset(met, 0, sizeof met);
    memset(seen, 0, sizeof seen);
    for (uint32_t i = 0; i < s->cluster_count; ++i) {
        const pl_joint_group *g = &pl_joint_groups(&w->joints)[i];
        for (uint32_t k = g->first; k < g->end; ++k) {
            const uint32_t joint = ((const uint32_t *)w->joints.plan.grouped.data)[k];
            const pl_joint_mark *mark = &pl_joint_marks(&w->joints)[joint];
            assert_false(seen[joint]);
            seen[joint] = true;
            assert_int_equal(pl_joint_is_wide(mark) && i != s->hard_cluster, k < g->alone);
            check_end(w, &pl_clusters(s)[i], mark->row_a);
            check_end(w, &pl_clusters(s)[i], mark->row_b);
            ++count;
        }
        peopled += g->end > g->first;
        check_bundles(w, i, met);
    }
    assert_int_equal(count, w->joints.plan.order_count);
    return peopled;
}

static void check_clusters(const plumb_world *w, bool special)
{
    static uint32_t met[4 * STACKS * HIGH];
    const pl_solver *s = &w->solver;
    uint32_t count = 0, slot[2] = { 0, s->dynamic_slots };
    memset(met, 0, sizeof met);
    for (uint32_t i = 0; i < s->cluster_count; ++i) {
        for (int kind = 0; kind < 2; ++kind) { // one behind the other
            assert_int_equal(pl_clusters(s)[i].slots[kind].first, slot[kind]);
            slot[kind] += pl_clusters(s)[i].slots[kind].count;
        }
        count += check_lanes(w, i, met);
    }
    assert_int_equal(slot[0], s->dynamic_slots);
    assert_int_equal(slot[1], s->slot_count - 1);
    assert_int_equal(count, w->narrow.manifold_count);
    for (uint32_t i = 0; special && i < w->narrow.manifold_count; ++i) {
        const pl_manifold *m = &pl_manifolds(&w->narrow)[i];
        if (m->restitution > 0) {
            check_end(w, pl_clusters(s), m->body_a);
            check_end(w, pl_clusters(s), m->body_b);
        }
    }
}

// Many clusters, and some of them with contacts that found no colour.
static void clusters_have_their_bodies_and_contacts(void **state)
{
    (void)state;
    for (unsigned special = 0; special < 8; ++special) {
        plumb_world *w = build(&(plumb_world_desc){ .no_sleep = true }, special);
        uint32_t most = 0, peopled = 0;
        for (int i = 0; i < STEPS; ++i) {
            assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
            check_clusters(w, special != 0);
            most = w->solver.cluster_count > most ? w->solver.cluster_count : most;
            const uint32_t groups = w->joints.live > 0 ? check_joints(w) : 0;
            peopled = groups > peopled ? groups : peopled;
        }
        assert_true(most > 2);
        assert_true((special & JOINTS) == 0 || peopled > 2);
        assert_true(w->solver.overflow_count > 0);
        plumb_world_destroy(w);
    }
}

// What becomes of the labels between two steps.
typedef void disturbance(plumb_world *w, uint32_t *seed);

static void forget(plumb_world *w, uint32_t *seed)
{
    (void)seed;
    w->solver.labelled = 0;
}

static void all_in_one(plumb_world *w, uint32_t *seed)
{
    (void)seed;
    w->solver.labelled = w->dynamic_count + w->kinematic_count;
    w->solver.cluster_count = 1;
    w->solver.hard_cluster = PL_NONE;
    w->solver.cluster_age = 0;
}

static void mix_up(plumb_world *w, uint32_t *seed)
{
    pl_solver *s = &w->solver;
    uint32_t *islands = s->islands.data, *homes = s->homes.data;
    const uint32_t clusters = s->cluster_count - (s->hard_cluster != PL_NONE);
    for (uint32_t row = 0; row < s->labelled; ++row) {
        if (sim_random(seed) % 20 == 0) {
            islands[row] = sim_random(seed) % (s->island_count + 1);
            islands[row] = islands[row] == s->island_count ? PL_NONE : islands[row];
        }
    }
    for (uint32_t i = 0; i < s->island_count; ++i) {
        homes[i] = sim_random(seed) % clusters;
    }
}

// Bodies go, so that rows move; joints go, break, get other rows; a body no longer moves.
static void meddle(plumb_world *w, int step)
{
    uint32_t seed = 7 + (uint32_t)step;
    if (step % 6 == 4) {
        plumb_body_destroy(w, w->bodies.entity[sim_random(&seed) % w->dynamic_count]);
    }
    const uint32_t slot = sim_random(&seed) % (w->joints.count + 1);
    if (step % 3 != 1 || slot == w->joints.count) {
        return;
    }
    const plumb_joint j = pl_joint_items(&w->joints)[slot].entity;
    if (plumb_is_null(j)) {
        return;
    }
    if (step % 4 == 0) {
        plumb_joint_destroy(w, j);
    } else if (step % 4 == 1) {
        plumb_joint_set_enabled(w, j, false);
    } else if (step % 4 == 2) {
        plumb_joint_set_break(w, j, (plumb_real)0.5, 0);
    } else {
        plumb_body_set_type(w, plumb_joint_body_b(w, j), PLUMB_KINEMATIC);
        plumb_body_set_velocity(w, plumb_joint_body_b(w, j), sim_vec(0, 0));
    }
}

// Nor do width and threads, whatever the clusters are: of contacts alone, with joints of all sorts, and with those solved together.
static void clusters_change_no_bit(void **state)
{
    (void)state;
    disturbance *const disturbances[] = { forget, all_in_one, mix_up };
    for (int round = 0; round < 3; ++round) {
        static uint64_t hashes[STEPS];
        const unsigned special = round > 0 ? JOINTS | BOUNCE | DAMPING : 0;
        plumb_world_desc desc = { .no_sleep = true, .direct_joints = round == 2 };
        plumb_world *w = build(&desc, special);
        for (int i = 0; i < STEPS; ++i) {
            meddle(w, i);
            plumb_world_step(w, DT);
            hashes[i] = plumb_world_hash(w);
        }
        plumb_world_destroy(w);
        for (int k = 0; k < 3; ++k) {
            uint32_t seed = 9;
            desc.workers = k, desc.simd_width = 4 << k;
            w = build(&desc, special);
            for (int i = 0; i < STEPS; ++i) {
                meddle(w, i);
                plumb_world_step(w, DT);
                check_clusters(w, special != 0);
                if (special != 0) {
                    check_joints(w);
                }
                if (plumb_world_hash(w) != hashes[i]) {
                    fail_msg("round %d, disturbance %d: step %d differs", round, k, i);
                }
                disturbances[k](w, &seed);
            }
            plumb_world_destroy(w);
        }
    }
}

// Bodies that come, go and fall asleep move rows under the labels.
static void labels_follow_when_rows_move(void **state)
{
    (void)state;
    plumb_world *w = build(&(plumb_world_desc){ .sleep_time = (plumb_real)0.3 }, DAMPING);
    uint32_t seed = 3;
    unsigned divided = 0;
    for (int i = 0; i < 2 * STEPS; ++i) {
        for (int k = 0; k < 2; ++k) {
            uint32_t row = sim_random(&seed) % w->dynamic_count;
            plumb_body_destroy(w, w->bodies.entity[row]);
        }
        sim_crate(w, sim_uniform(&seed, -100, 90), 9, 0.2, 0.2, (plumb_material)PLUMB_NULL_INIT);
        assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
        if (w->solver.slot_count > 0) {
            check_clusters(w, true);
            divided += w->solver.cluster_count > 1;
        }
    }
    assert_true(divided > 10);
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clusters_have_their_bodies_and_contacts),
        cmocka_unit_test(clusters_change_no_bit),
        cmocka_unit_test(labels_follow_when_rows_move),
    };
    return cmocka_run_group_tests_name("cluster", tests, NULL, NULL);
}
