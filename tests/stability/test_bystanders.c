// test_bystanders.c - what goes on elsewhere in a world is nobody's business: random heaps move as they do in a world
// of their own, to the bit, whatever stands, bounces, flows or hangs 300 m away, whenever it comes, and goes.
//
// The worlds are small enough for fine islands (plumb_world_desc.no_fine_islands), which go by the size of the world. Impacts of
// the very same moment would be solved as one system; of random heaps there are none.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "harness/pile.h"
#include "harness/trials.h"

enum {
    STEPS = 150,
    ELSEWHERE = 300 // [m]
};

static plumb_material plain(plumb_world *w)
{
    return sim_material(w, 0.5, 0);
}

static plumb_material made_of(plumb_world *w, plumb_material_desc desc)
{
    plumb_material m = plumb_material_create(w, &desc);
    assert_false(plumb_is_null(m));
    return m;
}

static void ground(plumb_world *w, double x, double half)
{
    sim_add_box(w, sim_body(w, PLUMB_STATIC, x, -1, 0), half, 1, plain(w));
}

//---- bystanders ----------------------------------------------------------------------------------------

typedef void bystander(plumb_world *w, double x);

static void bouncing_ball(plumb_world *w, double x)
{
    sim_ball(w, x, 3, 0.5, sim_material(w, 0.5, 1));
}

static void dull_ball(plumb_world *w, double x)
{
    sim_ball(w, x, 3, 0.5, sim_material(w, 0.5, 0.1));
}

static void elastic_pile(plumb_world *w, double x)
{
    const plumb_material m = sim_material(w, 0.5, 0.9);
    for (int i = 0; i < 4; ++i) {
        sim_crate(w, x, 0.5 + 1.05 * i, 0.5, 0.5, m);
    }
}

static void slider(plumb_world *w, double x)
{
    const plumb_material m =
        made_of(w, (plumb_material_desc){ .friction = (plumb_real)0.5,
                                          .kinetic_friction = (plumb_real)0.3 });
    sim_launch(w, sim_crate(w, x, 0.5, 0.5, 0.5, m), 3, 0, 0);
}

static void heavy_on_light(plumb_world *w, double x)
{
    sim_crate(w, x, 0.5, 0.5, 0.5, plain(w));
    sim_crate(w, x, 1.5, 0.5, 0.5, made_of(w, (plumb_material_desc){ .density = 200 }));
}

static void belt(plumb_world *w, double x)
{
    const plumb_material m = made_of(w, (plumb_material_desc){ .surface_speed = 2 });
    sim_add_box(w, sim_body(w, PLUMB_STATIC, x, 0.5, 0), 5, 0.5, m);
    sim_crate(w, x, 1.5, 0.5, 0.5, plain(w));
}

static void sticky_roller(plumb_world *w, double x)
{
    const plumb_material m =
        made_of(w, (plumb_material_desc){ .adhesion = 10, .rolling_resistance = (plumb_real)0.1 });
    sim_launch(w, sim_ball(w, x, 0.5, 0.5, m), 3, 0, 0);
}

static void tiles(plumb_world *w, double x)
{
    const plumb_material m = plain(w);
    for (int i = 0; i < 10; ++i) {
        sim_add_box(w, sim_body(w, PLUMB_STATIC, x + i, 0.5, 0), 0.5, 0.5, m);
    }
    sim_launch(w, sim_crate(w, x + 1, 1.5, 0.5, 0.5, m), 3, 0, 0);
}

static void lift(plumb_world *w, double x)
{
    plumb_body b = sim_body(w, PLUMB_KINEMATIC, x, 1, 0);
    sim_add_box(w, b, 1, 0.2, plain(w));
    sim_launch(w, b, 1, 0.5, 0);
    sim_crate(w, x, 1.7, 0.5, 0.5, plain(w));
}

static void bullet(plumb_world *w, double x)
{
    sim_launch(w, sim_ball(w, x, 5, 0.2, plain(w)), 200, 0, 0);
    sim_add_box(w, sim_body(w, PLUMB_STATIC, x + 20, 5, 0), 0.05, 4, plain(w));
}

static void heavy_chain(plumb_world *w, double x)
{
    plumb_body before = sim_body(w, PLUMB_STATIC, x, 20, 0);
    for (int i = 0; i < 10; ++i) {
        const plumb_material m = made_of(w, (plumb_material_desc){ .density = i == 9 ? 500 : 1 });
        plumb_body b = sim_crate(w, x + i + 0.5, 20, 0.5, 0.1, m);
        sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                         .body_a = before,
                                         .body_b = b,
                                         .anchor = sim_vec(x + i, 20) });
        before = b;
    }
}

static void pool(plumb_world *w, double x)
{
    const plumb_material water = made_of(w, (plumb_material_desc){ .fluid = true, .flow_x = 2 });
    plumb_shape_create(
        w, sim_body(w, PLUMB_STATIC, x, 2, 0),
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = sim_vec(10, 2), .material = water });
    sim_crate(w, x, 2, 0.5, 0.5, plain(w));
}

static void peculiar(plumb_world *w, double x)
{
    plumb_body slow = sim_crate(w, x, 2, 0.5, 0.5, plain(w));
    plumb_body straight = sim_crate(w, x + 3, 2, 0.5, 0.5, plain(w));
    plumb_body tired = sim_crate(w, x + 6, 2, 0.5, 0.5, plain(w));
    assert_int_equal(plumb_body_set_time_scale(w, slow, (plumb_real)0.5), PLUMB_OK);
    assert_int_equal(plumb_body_set_fixed_rotation(w, straight, true), PLUMB_OK);
    assert_int_equal(plumb_body_set_damping(w, tired, (plumb_real)0.5, 1), PLUMB_OK);
}

static void sensor(plumb_world *w, double x)
{
    plumb_shape_create(w, sim_body(w, PLUMB_STATIC, x, 1, 0),
                       &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 3, .sensor = true });
    sim_ball(w, x, 1, 0.5, plain(w));
}

static void rope(plumb_world *w, double x)
{
    const plumb_rope_desc desc = { .from = sim_vec(x, 6), .to = sim_vec(x + 5, 6), .nodes = 11 };
    assert_false(plumb_is_null(plumb_rope_create(w, &desc)));
}

static void water(plumb_world *w, double x)
{
    assert_int_equal(plumb_liquid_create(w, &(plumb_liquid_desc){ .spacing = (plumb_real)0.25 }),
                     PLUMB_OK);
    assert_int_equal(plumb_liquid_add_box(w, sim_vec(x - 2, 0), sim_vec(x + 2, 2), NULL), PLUMB_OK);
}

static void hero(plumb_world *w, double x)
{
    plumb_body b = sim_body(w, PLUMB_KINEMATIC, x, 2, 0);
    sim_add_box(w, b, 0.3, 0.8, plain(w));
    assert_int_equal(plumb_character_create(w, b, &(plumb_character_desc){ 0 }), PLUMB_OK);
}

static bystander *const bystanders[] = {
    bouncing_ball, dull_ball, elastic_pile, slider,      heavy_on_light, belt,     sticky_roller,
    tiles,         lift,      bullet,       heavy_chain, pool,           peculiar, sensor,
    rope,          water,     hero
};

enum { KINDS = sizeof bystanders / sizeof bystanders[0] };

static void place(plumb_world *w, uint32_t which)
{
    ground(w, ELSEWHERE + 30 * KINDS / 2, 30 * KINDS);
    for (uint32_t i = 0; i < KINDS; ++i) {
        if ((which >> i & 1) != 0) {
            bystanders[i](w, ELSEWHERE + 30.0 * i);
        }
    }
}

//---- beside them ---------------------------------------------------------------------------------------

// When bystanders come, and whether those that can go leave in the middle of it.
typedef enum coming { FIRST, LAST, ON_THE_WAY, COMINGS } coming;

static void remove_bystanders(plumb_world *w)
{
    plumb_body gone[256];
    int count = 0;
    const plumb_body_span span = plumb_world_bodies(w);
    for (int i = 0; i < span.count; ++i) {
        if (span.x[i] > (plumb_real)ELSEWHERE / 2 && count < 256) {
            gone[count++] = span.body[i];
        }
    }
    for (int i = 0; i < count; ++i) {
        assert_int_equal(plumb_body_destroy(w, gone[i]), PLUMB_OK);
    }
}

static pile_poses motion(uint32_t seed, uint32_t which, coming when, bool leave,
                         plumb_solver solver)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ .solver = solver });
    plumb_body bodies[PILE_MOST];
    if (which != 0 && when == FIRST) {
        place(w, which);
    }
    const int count = pile_make(w, seed, bodies);
    if (which != 0 && when == LAST) {
        place(w, which);
    }
    for (int step = 0; step < STEPS; ++step) {
        if (which != 0 && when == ON_THE_WAY && step == STEPS / 5) {
            place(w, which);
        }
        if (leave && step == STEPS / 2) {
            remove_bystanders(w);
        }
        sim_step(w, 1.0 / 60);
    }
    const pile_poses p = pile_poses_of(w, bodies, count);
    plumb_world_destroy(w);
    return p;
}

static void moves_as_alone(uint32_t number, plumb_solver solver)
{
    uint32_t random = 977 * number + 13;
    const uint32_t seed = sim_random(&random);
    uint32_t which = sim_random(&random) & sim_random(&random) & ((1u << KINDS) - 1);
    which |= 1u << number % KINDS;
    const coming when = (coming)(number % COMINGS);
    const bool leave = sim_random(&random) % 2 == 0;
    const pile_poses alone = motion(seed, 0, LAST, false, solver);
    const pile_poses beside = motion(seed, which, when, leave, solver);
    const int i = pile_first_apart(&alone, &beside);
    if (i >= 0) {
        fail_msg("case %u: beside %#x, body %d of %d is off by %g, %g m", (unsigned)number,
                 (unsigned)which, i, alone.count, beside.x[i] - alone.x[i],
                 beside.y[i] - alone.y[i]);
    }
}

static void heaps_move_as_alone(void **state)
{
    (void)state;
    const trials t = trials_from(0, 100);
    for (uint32_t n = t.first; n < t.end; ++n) {
        moves_as_alone(n, PLUMB_SOLVER_SOFT);
    }
}

static void heaps_move_as_alone_with_the_classic_solver(void **state)
{
    (void)state;
    const trials t = trials_from(0, 40);
    for (uint32_t n = t.first; n < t.end; ++n) {
        moves_as_alone(n, PLUMB_SOLVER_PGS);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(heaps_move_as_alone),
        cmocka_unit_test(heaps_move_as_alone_with_the_classic_solver),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
