// test_soft_bystanders.c - soft bodies move as they do in a world of their own, to the bit, whatever soft bodies hang, lie and fall
// 300 m away, whether they were made before or after them.
// PLUMB_LONG
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "harness/sim.h"
#include "harness/trials.h"

enum {
    STEPS = 120,
    ELSEWHERE = 300, // [m]
    MOST = 1000      // numbers that tell of a group
};

static double in(uint32_t *seed, double low, double high)
{
    return sim_uniform(seed, low, high);
}

//---- groups: soft bodies, and bodies that they touch and hold -------------------------------------------

typedef struct things {
    plumb_softbody soft[2];
    plumb_body body[4];
    int soft_count, body_count;
} things;

typedef void group(plumb_world *w, double x, uint32_t *seed, plumb_material m, things *out);

static void crate(plumb_world *w, double x, double y, uint32_t *seed, plumb_material m, things *out)
{
    const double half = in(seed, 0.15, 0.4);
    out->body[out->body_count++] = sim_crate(w, x, y, half, half, m);
}

static void loaded_rope(plumb_world *w, double x, uint32_t *seed, plumb_material m, things *out)
{
    const plumb_rope_desc desc = { .from = sim_vec(x - 3, 5),
                                   .to = sim_vec(x + 3, 5),
                                   .nodes = 20,
                                   .length = (plumb_real)in(seed, 6.1, 7),
                                   .mass = (plumb_real)in(seed, 5, 30),
                                   .hold_from = true,
                                   .hold_to = true };
    out->soft[out->soft_count++] = plumb_rope_create(w, &desc);
    crate(w, x - in(seed, 0, 1.5), 5.6, seed, m, out);
    crate(w, x + in(seed, 1, 1.5), 5.6, seed, m, out);
}

static void held_by_bodies(plumb_world *w, double x, uint32_t *seed, plumb_material m, things *out)
{
    crate(w, x - 2, 2, seed, m, out);
    crate(w, x + 2, 2, seed, m, out);
    const plumb_rope_desc desc = { .from = sim_vec(x - 2, 2),
                                   .to = sim_vec(x + 2, 2),
                                   .from_body = out->body[0],
                                   .to_body = out->body[1] };
    out->soft[out->soft_count++] = plumb_rope_create(w, &desc);
}

static void jelly(plumb_world *w, double x, uint32_t *seed, plumb_material m, things *out)
{
    const plumb_vec2 points[4] = { sim_vec(x - 0.5, 0.2), sim_vec(x + 0.5, 0.2),
                                   sim_vec(x + 0.5, 1.2), sim_vec(x - 0.5, 1.2) };
    const plumb_jelly_desc desc = { .points = points,
                                    .count = 4,
                                    .spacing = (plumb_real)0.25,
                                    .young = (plumb_real)in(seed, 5e3, 1e5) };
    out->soft[out->soft_count++] = plumb_jelly_create(w, &desc);
    crate(w, x, 2, seed, m, out);
}

static void balloon(plumb_world *w, double x, uint32_t *seed, plumb_material m, things *out)
{
    const plumb_skin_desc desc = { .center = sim_vec(x, 1.5),
                                   .nodes = 16,
                                   .pressure = (plumb_real)in(seed, 200, 2000) };
    out->soft[out->soft_count++] = plumb_skin_create(w, &desc);
    crate(w, x + 0.2, 2.5, seed, m, out);
}

static void two_cloths(plumb_world *w, double x, uint32_t *seed, plumb_material m, things *out)
{
    for (int i = 0; i < 2; ++i) {
        const plumb_cloth_desc desc = { .low = sim_vec(x - 2 + 2 * i, 2),
                                        .high = sim_vec(x - 0.5 + 2 * i, 4),
                                        .columns = 4,
                                        .rows = 6,
                                        .hold_top = i == 0 };
        out->soft[out->soft_count++] = plumb_cloth_create(w, &desc);
    }
    crate(w, x + 0.4, 5, seed, m, out);
}

static group *const groups[] = { loaded_rope, held_by_bodies, jelly, balloon, two_cloths };

enum { KINDS = sizeof groups / sizeof groups[0] };

static void make(plumb_world *w, double x, uint32_t seed, things *out)
{
    const plumb_material m = sim_material(w, in(&seed, 0, 1), 0);
    sim_add_box(w, sim_body(w, PLUMB_STATIC, x, -1, 0), 20, 1, m);
    *out = (things){ .soft_count = 0 };
    groups[sim_random(&seed) % KINDS](w, x, &seed, m, out);
    for (int i = 0; i < out->soft_count; ++i) {
        assert_false(plumb_is_null(out->soft[i]));
    }
}

//---- beside one another --------------------------------------------------------------------------------

// Places and velocities of all that there is of it.
static int tell(const plumb_world *w, const things *t, double out[MOST])
{
    int count = 0;
    for (int i = 0; i < t->soft_count; ++i) {
        plumb_softbody_desc now;
        assert_int_equal(plumb_softbody_settings(w, t->soft[i], &now), PLUMB_OK);
        for (int n = 0; n < now.node_count; ++n) {
            assert_true(count + 4 <= MOST);
            out[count++] = (double)now.nodes[n].position.x;
            out[count++] = (double)now.nodes[n].position.y;
            out[count++] = (double)now.nodes[n].velocity.x;
            out[count++] = (double)now.nodes[n].velocity.y;
        }
    }
    for (int i = 0; i < t->body_count; ++i) {
        out[count++] = sim_x(w, t->body[i]);
        out[count++] = sim_y(w, t->body[i]);
        out[count++] = sim_angle(w, t->body[i]);
    }
    return count;
}

static int motion(uint32_t seed, uint32_t beside, bool first, plumb_solver solver, double out[MOST])
{
    plumb_world *w = sim_world(&(plumb_world_desc){ .solver = solver });
    things own, other;
    if (beside != 0 && first) {
        make(w, ELSEWHERE, beside, &other);
    }
    make(w, 0, seed, &own);
    if (beside != 0 && !first) {
        make(w, ELSEWHERE, beside, &other);
    }
    for (int i = 0; i < STEPS; ++i) {
        sim_step(w, 1.0 / 60);
    }
    const int count = tell(w, &own, out);
    plumb_world_destroy(w);
    return count;
}

static void move_as_alone(uint32_t first, uint32_t end, plumb_solver solver)
{
    for (uint32_t n = first; n < end; ++n) {
        static double alone[MOST], beside[MOST];
        uint32_t random = 31 * n + 5;
        const uint32_t seed = sim_random(&random), other = sim_random(&random) | 1;
        const int count = motion(seed, 0, false, solver, alone);
        assert_int_equal(motion(seed, other, n % 2 == 0, solver, beside), count);
        for (int i = 0; i < count; ++i) {
            if (alone[i] != beside[i]) {
                fail_msg("case %u: number %d of %d is off by %g", (unsigned)n, i, count,
                         beside[i] - alone[i]);
            }
        }
    }
}

static void soft_bodies_move_as_alone(void **state)
{
    (void)state;
    const trials t = trials_from(0, 40);
    move_as_alone(t.first, t.end, PLUMB_SOLVER_SOFT);
}

static void soft_bodies_move_as_alone_with_the_classic_solver(void **state)
{
    (void)state;
    const trials t = trials_from(0, 20);
    move_as_alone(t.first, t.end, PLUMB_SOLVER_PGS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(soft_bodies_move_as_alone),
        cmocka_unit_test(soft_bodies_move_as_alone_with_the_classic_solver),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
