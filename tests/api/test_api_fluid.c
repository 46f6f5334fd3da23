// test_api_fluid.c - fluids as a user meets them: what asks for them, what wakes who floats, bad input.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

#define HZ60 (1 / 60.0)

static const plumb_material_desc water_desc = { .density = 1000, .fluid = true };

static plumb_shape pool(plumb_world *w, plumb_body ground, plumb_material water)
{
    return plumb_shape_create(w, ground,
                              &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                   .center = sim_vec(0, -5),
                                                   .half = sim_vec(20, 5),
                                                   .sensor = true,
                                                   .material = water });
}

static bool is_scheduled(const plumb_world *w, const char *name)
{
    plumb_pass_info rows[128];
    const int count = plumb_world_schedule(w, rows, 128);
    for (int i = 0; i < count && i < 128; ++i) {
        if (strcmp(rows[i].name, name) == 0) {
            return rows[i].scheduled;
        }
    }
    fail_msg("no pass %s", name);
    return false;
}

// Neither a fluid that nothing is made of, nor one that solid shapes are made of, asks for anything.
static void only_volumes_ask_for_passes(void **state)
{
    (void)state;
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_material water = plumb_material_create(w, &water_desc);
    plumb_body ball = sim_ball(w, 0, 3, 0.5, water), ground = sim_body(w, PLUMB_STATIC, 0, 0, 0);
    const char *const passes[] = { "fluids", "immersion", "fluid forces" };
    sim_step(w, HZ60);
    for (int i = 0; i < 3; ++i) {
        assert_false(is_scheduled(w, passes[i]));
    }
    plumb_shape surface = pool(w, ground, water);
    sim_step(w, HZ60);
    for (int i = 0; i < 3; ++i) {
        assert_true(is_scheduled(w, passes[i]));
    }
    assert_int_equal(plumb_shape_destroy(w, surface), PLUMB_OK);
    sim_step(w, HZ60);
    for (int i = 0; i < 3; ++i) {
        assert_false(is_scheduled(w, passes[i]));
    }
    assert_true(plumb_body_valid(w, ball));
    plumb_world_destroy(w);
}

typedef struct sea {
    plumb_world *w;
    plumb_material water;
    plumb_body ground, box;
    plumb_shape surface;
} sea;

// A box of half the density that floats, and sleeps.
static sea calm_sea(void)
{
    sea s;
    s.w = sim_world(&(plumb_world_desc){ 0 });
    s.water = plumb_material_create(s.w, &water_desc);
    s.ground = sim_body(s.w, PLUMB_STATIC, 0, 0, 0);
    s.surface = pool(s.w, s.ground, s.water);
    plumb_material wood = plumb_material_create(s.w, &(plumb_material_desc){ .density = 500 });
    s.box = sim_crate(s.w, 0, 0.2, 1, 0.3, wood);
    sim_run(s.w, 1200, HZ60);
    assert_false(plumb_body_is_awake(s.w, s.box));
    assert_true(fabs(sim_y(s.w, s.box)) < 1e-3);
    return s;
}

static void set(sea *s, plumb_material_desc desc)
{
    assert_int_equal(plumb_material_set(s->w, s->water, &desc), PLUMB_OK);
}

static void change_density(sea *s)
{
    plumb_material_desc salty = water_desc;
    salty.density = 1500;
    set(s, salty);
}

static void change_flow(sea *s)
{
    plumb_material_desc river = water_desc;
    river.flow_x = 1;
    set(s, river);
}

static void dry_up(sea *s)
{
    set(s, (plumb_material_desc){ .density = 1000 });
}

static void rise(sea *s)
{
    plumb_body_set_position(s->w, s->ground, sim_vec(0, 0.5));
}

static void drain(sea *s)
{
    assert_int_equal(plumb_shape_destroy(s->w, s->surface), PLUMB_OK);
}

static void drain_all(sea *s)
{
    assert_int_equal(plumb_body_destroy(s->w, s->ground), PLUMB_OK);
}

static void become_solid_air(sea *s)
{
    plumb_filter nobody = { .nothing = true };
    assert_int_equal(plumb_shape_set_filter(s->w, s->surface, nobody), PLUMB_OK);
}

static void change_material(sea *s)
{
    plumb_material oil =
        plumb_material_create(s->w, &(plumb_material_desc){ .density = 800, .fluid = true });
    assert_int_equal(plumb_shape_set_material(s->w, s->surface, oil), PLUMB_OK);
}

static void begin_to_move(sea *s)
{
    assert_int_equal(plumb_body_set_type(s->w, s->ground, PLUMB_KINEMATIC), PLUMB_OK);
    sim_step(s->w, HZ60);
    plumb_body_set_velocity(s->w, s->ground, sim_vec(0, 0.3));
}

static void second_sea(sea *s)
{
    pool(s->w, s->ground, plumb_material_create(s->w, &water_desc));
}

// Whatever is done to the fluid, who floats wakes within two steps and moves.
static void changes_wake_who_floats(void **state)
{
    (void)state;
    void (*const changes[])(
        sea *) = { change_density, change_flow,      dry_up,          rise,          drain,
                   drain_all,      become_solid_air, change_material, begin_to_move, second_sea };
    for (size_t i = 0; i < sizeof changes / sizeof *changes; ++i) {
        sea s = calm_sea();
        changes[i](&s);
        const double x = sim_x(s.w, s.box), y = sim_y(s.w, s.box);
        sim_run(s.w, 3, HZ60);
        if (!plumb_body_is_awake(s.w, s.box)) {
            fail_msg("change %zu does not wake", i);
        }
        sim_run(s.w, 60, HZ60);
        assert_true(hypot(sim_x(s.w, s.box) - x, sim_y(s.w, s.box) - y) > 0.01);
        plumb_world_destroy(s.w);
    }
}

// What does not concern it does not.
static void others_sleep_on(void **state)
{
    (void)state;
    sea s = calm_sea();
    plumb_material other = plumb_material_create(s.w, &water_desc);
    assert_int_equal(plumb_material_set(s.w, other, &(plumb_material_desc){ .fluid = true }),
                     PLUMB_OK);
    sim_run(s.w, 120, HZ60);
    assert_false(plumb_body_is_awake(s.w, s.box));
    plumb_world_destroy(s.w);
}

// Gravity that points elsewhere: what is up follows, and so does the side that is the surface.
static void any_direction_is_up(void **state)
{
    (void)state;
    const double g[3][2] = { { 0, 9.81 }, { 9.81, 0 }, { -9.81, 0 } };
    for (int i = 0; i < 3; ++i) {
        plumb_world *w = sim_world(&(plumb_world_desc){ .gravity = sim_vec(g[i][0], g[i][1]) });
        plumb_material water = plumb_material_create(w, &water_desc);
        plumb_body ground = sim_body(w, PLUMB_STATIC, 0, 0, 0);
        const double ux = -g[i][0] / 9.81, uy = -g[i][1] / 9.81;
        plumb_shape_create(w, ground,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                .center = sim_vec(-20 * ux, -20 * uy),
                                                .half = sim_vec(20, 20),
                                                .sensor = true,
                                                .material = water });
        plumb_material wood = plumb_material_create(w, &(plumb_material_desc){ .density = 250 });
        plumb_body ball = sim_crate(w, ux, uy, 0.5, 0.5, wood);
        plumb_body_set_fixed_rotation(w, ball, true);
        sim_run(w, 1200, HZ60);
        const double up = ux * sim_x(w, ball) + uy * sim_y(w, ball);
        assert_true(fabs(up - 0.25) < 1e-3);
        plumb_world_destroy(w);
    }
}

static void bad_numbers_are_refused(void **state)
{
    (void)state;
    plumb_world *w;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ 0 }, &w), PLUMB_OK);
    const plumb_real nan = (plumb_real)NAN, inf = (plumb_real)INFINITY;
    const plumb_material_desc bad[] = {
        { .fluid = true, .drag = -1 },
        { .fluid = true, .drag = nan },
        { .fluid = true, .skin_drag = -1 },
        { .fluid = true, .added_mass = 101 },
        { .fluid = true, .wave_drag = inf },
        { .fluid = true, .flow_x = nan },
        { .fluid = true, .flow_y = inf },
        { .fluid = true, .gust = 11 },
        { .fluid = true, .gust_length = -1 },
        { .fluid = true, .shear_height = -1 },
        { .fluid = true, .swirl = inf },
        { .fluid = true, .outflow = nan },
        { .fluid = true, .core_radius = -1 },
        { .fluid = true, .core_radius = (plumb_real)1e-4 },
        { .fluid = true, .jet = nan },
        { .fluid = true, .jet_width = -1 },
        { .fluid = true, .eddies = -1 },
        { .fluid = true, .eddy_length = nan },
        { .drag = 1, .no_drag = true },
        { .skin_drag = 1, .no_skin_drag = true },
        { .added_mass = 1, .no_added_mass = true },
        { .wave_drag = 1, .no_wave_drag = true },
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        assert_true(plumb_is_null(plumb_material_create(w, &bad[i])));
    }
    plumb_world_destroy(w);
}

// In none, in one, in two: the densest; as it moves with its body, at any edge of a world that wraps.
static void fluids_tell_what_flows(void **state)
{
    (void)state;
    sea s = calm_sea();
    plumb_fluid_sample f = plumb_fluid_at(s.w, sim_vec(0, 5));
    assert_true(plumb_is_null(f.shape) && f.density == 0 && f.velocity.x == 0);
    change_flow(&s);
    plumb_material air = plumb_material_create(
        s.w, &(plumb_material_desc){ .density = 1, .fluid = true, .flow_y = 7 });
    plumb_body cart = sim_body(s.w, PLUMB_KINEMATIC, 0, 0, 0);
    plumb_shape gust = pool(s.w, cart, air);
    plumb_body_set_velocity(s.w, cart, sim_vec(2, 0));
    plumb_body_set_angular_velocity(s.w, cart, 1);
    f = plumb_fluid_at(s.w, sim_vec(1, -1));
    assert_true(plumb_same(f.shape, s.surface) && f.density == 1000 && f.velocity.x == 1);
    assert_int_equal(plumb_shape_destroy(s.w, s.surface), PLUMB_OK);
    f = plumb_fluid_at(s.w, sim_vec(1, -1));
    assert_true(plumb_same(f.shape, gust) && f.density == 1);
    assert_near((double)f.velocity.x, 2 + 1, 1e-6); // -w y
    assert_near((double)f.velocity.y, 7 + 1, 1e-6);
    f = plumb_fluid_at(s.w, sim_vec(NAN, 0));
    assert_true(plumb_is_null(f.shape));
    assert_int_equal(plumb_world_error(s.w).code, PLUMB_E_NOT_FINITE);
    f = plumb_fluid_at(NULL, sim_vec(0, 0));
    assert_true(plumb_is_null(f.shape));
    plumb_world_destroy(s.w);

    plumb_world *w = sim_world(&(plumb_world_desc){ .wrap_x = 20, .zero_gravity = true });
    plumb_material swirl = plumb_material_create(
        w, &(plumb_material_desc){ .fluid = true, .swirl = 4, .core_radius = (plumb_real)0.1 });
    plumb_body holder = sim_body(w, PLUMB_STATIC, 9.5, 0, 0);
    plumb_shape_create(
        w, holder,
        &(plumb_shape_desc){
            .kind = PLUMB_BOX, .half = sim_vec(3, 3), .sensor = true, .material = swirl });
    f = plumb_fluid_at(w, sim_vec(-9.5, 0));
    assert_near((double)f.velocity.y, 4 / (2 * SIM_PI), 1e-5); // 1 m beyond the edge
    plumb_world_destroy(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_volumes_ask_for_passes),
        cmocka_unit_test(changes_wake_who_floats),
        cmocka_unit_test(others_sleep_on),
        cmocka_unit_test(any_direction_is_up),
        cmocka_unit_test(bad_numbers_are_refused),
        cmocka_unit_test(fluids_tell_what_flows),
    };
    return cmocka_run_group_tests_name("fluids of the API", tests, NULL, NULL);
}
