// test_cluster.c - islands solved a cluster at a time: every contact is in one lane of the cluster that
// has both its bodies, what goes through the whole world is in cluster 0, and where clusters begin and
// end changes no bit.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "harness/sim.h"
#include "world/state.h"

#define DT     ((plumb_real)(1 / 60.0))
#define STACKS 140
#define HIGH   10
#define STEPS  90

enum { JOINTS = 1, BOUNCE = 2, DAMPING = 4 };

// A plate on more crates than there are colours: some of its contacts find none.
static void add_table(plumb_world *w, double x, plumb_material m)
{
    for (int i = 0; i < 60; ++i) {
        sim_crate(w, x + 0.5 * i, 0.2, 0.2, 0.2, m);
    }
    sim_crate(w, x + 14.75, 0.6, 15, 0.2, m);
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
    for (uint32_t row = 0; special && row < w->dynamic_count; ++row) {
        const bool jointed = w->bodies.first_joint[row] != PL_NONE;
        const bool damped = (w->bodies.flags[row] & PL_BODY_TUNED) != 0;
        if (jointed || damped) {
            assert_true(has(pl_clusters(s)->slots[0], ((const uint32_t *)s->slots.data)[row]));
        }
    }
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
        uint32_t most = 0;
        for (int i = 0; i < STEPS; ++i) {
            assert_int_equal(plumb_world_step(w, DT), PLUMB_OK);
            check_clusters(w, special != 0);
            most = w->solver.cluster_count > most ? w->solver.cluster_count : most;
        }
        assert_true(most > 2);
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
    w->solver.cluster_age = 0;
}

static void mix_up(plumb_world *w, uint32_t *seed)
{
    pl_solver *s = &w->solver;
    uint32_t *labels = s->labels.data;
    for (uint32_t row = 0; row < s->labelled; ++row) {
        if (sim_random(seed) % 20 == 0) {
            labels[row] = sim_random(seed) % (s->cluster_count + 1);
            labels[row] = labels[row] == s->cluster_count ? PL_NONE : labels[row];
        }
    }
}

// Nor do width and threads, whatever the clusters are.
static void clusters_change_no_bit(void **state)
{
    (void)state;
    disturbance *const disturbances[] = { forget, all_in_one, mix_up };
    for (unsigned special = 0; special < 8; special += 7) {
        static uint64_t hashes[STEPS];
        plumb_world *w = build(&(plumb_world_desc){ .no_sleep = true }, special);
        for (int i = 0; i < STEPS; ++i) {
            plumb_world_step(w, DT);
            hashes[i] = plumb_world_hash(w);
        }
        plumb_world_destroy(w);
        for (int k = 0; k < 3; ++k) {
            uint32_t seed = 9;
            w = build(&(plumb_world_desc){ .no_sleep = true, .workers = k, .simd_width = 4 << k },
                      special);
            for (int i = 0; i < STEPS; ++i) {
                plumb_world_step(w, DT);
                check_clusters(w, special != 0);
                if (plumb_world_hash(w) != hashes[i]) {
                    fail_msg("special %u, disturbance %d: step %d differs", special, k, i);
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
