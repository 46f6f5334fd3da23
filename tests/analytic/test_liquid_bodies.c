// test_liquid_bodies.c - bodies in the liquid that flows: drafts, what water carries of a body that is held in it, bodies on the
// ground, which it lifts and which do not stir it, and what hangs in it. What was measured stands in src/liquid/DECISIONS.md.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/random.h"
#include "harness/sim.h"
#include "harness/tank.h"
#include "harness/trials.h"

#define HZ60 (1 / 60.0)

static plumb_body add_box(plumb_world *w, double x, double y, double angle, double hx, double hy,
                          double density)
{
    const plumb_shape_desc d = { .kind = PLUMB_BOX,
                                 .half = sim_vec(hx, hy),
                                 .density = (plumb_real)density };
    const plumb_body b = sim_body(w, PLUMB_DYNAMIC, x, y, angle);
    assert_false(plumb_is_null(plumb_shape_create(w, b, &d)));
    return b;
}

// Means over a second.
typedef struct means {
    double force, torque; // of the joint, if there is one: along y
    double rms;           // of the water
} means;

static means watch(plumb_world *w, const plumb_joint *j)
{
    means m = { 0, 0, 0 };
    for (int k = 0; k < 60; ++k) {
        sim_step(w, HZ60);
        m.force += j != NULL ? (double)plumb_joint_force(w, *j).y / 60 : 0;
        m.torque += j != NULL ? (double)plumb_joint_torque(w, *j) / 60 : 0;
        m.rms += tank_look(w).rms / 60;
    }
    return m;
}

//---- what floats ---------------------------------------------------------------------------------

// A box that does not turn floats as deep as its density says.
static double draft_of(double ratio, double *rest)
{
    const double side = 1.5, level = 1.5;
    plumb_world *w = tank_make(7.5, 6, 0.0625);
    const plumb_material m =
        plumb_material_create(w, &(plumb_material_desc){ .density = (plumb_real)(1000 * ratio) });
    const plumb_body box = sim_body(w, PLUMB_DYNAMIC, 3.75, level - 0.5 * side + 0.75, 0);
    sim_add_box(w, box, side / 2, side / 2, m);
    plumb_body_set_fixed_rotation(w, box, true);
    plumb_body_teleport(w, box, sim_vec(3.75, level + side * (0.5 - ratio)), 0);
    tank_fill(w, 0, 0, 7.5, level);
    plumb_liquid_remove(w, sim_vec(3, level - side * ratio), sim_vec(4.5, 4));
    int count;
    plumb_liquid_particles(w, &count);
    sim_run(w, 1200, HZ60);
    // Water and what is displaced fill the tank up to the level.
    const double bottom = sim_y(w, box) - side / 2, area = count * 0.0625 * 0.0625;
    const double surface = (area - side * fmax(bottom, 0)) / (7.5 - side);
    *rest = hypot(sim_vx(w, box), sim_vy(w, box));
    const double lies = (area / 7.5 < bottom ? area / 7.5 : surface) - bottom;
    plumb_world_destroy(w);
    return lies / side;
}

static void boxes_float_by_their_density(void **state)
{
    (void)state;
    const double ratios[] = { 0.9, 0.5, 0.1, 0.01, 0.001 };
    for (int i = 0; i < 5; ++i) {
        if (!trials_takes((uint32_t)i, 3)) {
            continue;
        }
        double speed;
        const double draft = draft_of(ratios[i], &speed);
        print_message("box of %.3f of the density: draft %.3f of its side, %.3f m/s\n", ratios[i],
                      draft, speed);
        assert_near(draft, ratios[i], 0.01);
        assert_true(speed < (ratios[i] < 0.05 ? 0.4 : 0.1)); // the light ones go on bobbing
    }
}

// Crates that fall into a pool enclose water between them that has no way out. Its sums once spoilt those of all water, which was
// pressed to a seventh of its height in five seconds. Once what holds them was not known to the liquid, and they boiled at 1 m/s.
static void crates_press_no_water_away(void **state)
{
    (void)state;
    plumb_world *w = tank_make(6, 9, 0.05);
    tank_fill(w, 0, 0, 6, 1.5);
    for (int i = 0; i < 60; ++i) {
        add_box(w, 0.3 + 0.45 * (i % 12), 1.8 + 0.45 * (i / 12), 0, 0.15, 0.15, 500);
    }
    double least = INFINITY;
    for (int second = 0; second < 10; ++second) {
        sim_run(w, 60, HZ60);
        least = fmin(least, tank_look(w).mean_y);
    }
    const double rms = tank_look(w).rms;
    print_message(
        "60 crates in 1.5 m of water, 10 s: mean height of the water at least %.3f m; %.3f m/s\n",
        least, rms);
    assert_true(least > 0.75);
    assert_true(rms < 0.45);
    plumb_world_destroy(w);
}

// A boat of three boxes: its seams lie under water, and let nothing in.
static void boats_of_pieces_stay_dry(void **state)
{
    (void)state;
    const double places[3][4] = { { 0, -0.3, 0.8, 0.15 },
                                  { -0.65, 0.3, 0.15, 0.45 },
                                  { 0.65, 0.3, 0.15, 0.45 } };
    plumb_world *w = tank_make(4, 4, 0.05);
    const plumb_body boat = sim_body(w, PLUMB_DYNAMIC, 2.01, 2.03, 0);
    for (int i = 0; i < 3; ++i) {
        const double *p = places[i];
        const plumb_shape_desc d = { .kind = PLUMB_BOX,
                                     .center = sim_vec(p[0], p[1]),
                                     .half = sim_vec(p[2], p[3]),
                                     .density = 700 };
        assert_false(plumb_is_null(plumb_shape_create(w, boat, &d)));
    }
    tank_fill(w, 0, 0, 4, 1.5);
    sim_run(w, 1200, HZ60);
    double bottom = 0, turned = 0;
    for (int i = 0; i < 600; ++i) {
        sim_step(w, HZ60);
        bottom += (sim_y(w, boat) - 0.45) / 600;
        turned += sim_angle(w, boat) / 600;
    }
    // 714 kg over a width of 1.6 m, in 6 m^2 of water.
    const double draft = (6 + 0.714) / 4 - bottom, wanted = 0.714 / 1.6;
    print_message("a boat: draft %.3f m, by its weight %.3f; turned by %.3f\n", draft, wanted,
                  turned);
    assert_near(draft, wanted, 0.03);
    assert_true(fabs(turned) < 0.05);
    int count;
    const plumb_particle *p = plumb_liquid_particles(w, &count);
    for (int i = 0; i < count; ++i) {
        const plumb_vec2 at = plumb_body_local_point(w, boat, p[i].position);
        assert_false(fabs((double)at.x) < 0.4 && (double)at.y > -0.1 && (double)at.y < 0.5);
    }
    plumb_world_destroy(w);
}

//---- what is held --------------------------------------------------------------------------------

// Archimedes: of a body that something holds in water at rest, water bears what it displaces, wherever it lies in the cells and
// however it is turned, and does not turn it about its middle. With faces closed by chords alone it was off by up to a cell's height.
static void water_bears_what_is_displaced(void **state)
{
    (void)state;
    uint32_t seed = 20;
    double worst = 0, worst_turn = 0;
    const int count = (int)trials_count(6);
    for (int i = 0; i < count; ++i) {
        plumb_world *w = tank_make(3, 3, 0.05);
        const double hx = sim_uniform(&seed, 0.12, 0.4), hy = sim_uniform(&seed, 0.12, 0.4);
        const double x = sim_uniform(&seed, 1.4, 1.6), y = sim_uniform(&seed, 0.9, 1.1);
        const double angle = i % 2 == 0 ? 0 : sim_uniform(&seed, 0, SIM_PI);
        const plumb_body b = add_box(w, x, y, angle, hx, hy, 500);
        const plumb_joint j = sim_joint(
            w, (plumb_joint_desc){ .kind = PLUMB_WELD, .body_b = b, .anchor = sim_vec(x, y) });
        tank_fill(w, 0, 0, 3, 2);
        sim_run(w, 240, HZ60);
        const means m = watch(w, &j);
        const double weight = 4 * hx * hy * 1000 * SIM_G;
        // On the body: it weighs half of what it displaces.
        const double off = (0.5 * weight - m.force) / weight - 1;
        worst = fmax(worst, fabs(off)), worst_turn = fmax(worst_turn, fabs(m.torque) / weight);
        plumb_world_destroy(w);
    }
    print_message("%d boxes held in water: lift off by at most %.2g, its arm %.2g m\n", count,
                  worst, worst_turn);
    assert_true(worst < 0.02);
    assert_true(worst_turn < 0.001);
}

// What hangs under water does not stir it, and pulls by what it weighs there.
static void what_hangs_stirs_nothing(void **state)
{
    (void)state;
    plumb_world *w = tank_make(2, 3, 0.05);
    const plumb_body b = add_box(w, 1.03, 1.02, 0, 0.2, 0.2, 3000);
    const plumb_joint j = sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                                           .body_b = b,
                                                           .anchor = sim_vec(1.03, 3),
                                                           .anchor_b = sim_vec(1.03, 1.22) });
    tank_fill(w, 0, 0, 2, 2);
    sim_run(w, 900, HZ60);
    const means m = watch(w, &j);
    const double wanted = 0.16 * 2000 * SIM_G;
    print_message("a box that hangs in water: pulls by %.4f of what it weighs; %.3f m/s\n",
                  m.force / wanted, m.rms);
    assert_near(m.force / wanted, 1, 0.02);
    assert_true(m.rms < 0.03);
    plumb_world_destroy(w);
}

//---- what lies on the ground ---------------------------------------------------------------------

// What is lighter than water rises from the ground, wherever the ground and the body lie in the cells: liquid gets between. It
// once lay there as if it were glued.
static void what_is_light_leaves_the_ground(void **state)
{
    (void)state;
    uint32_t seed = 3;
    const int count = (int)trials_count(5);
    for (int i = 0; i < count; ++i) {
        plumb_world *w = tank_make(3, 4, 0.05);
        const double ground = i % 3 == 0 ? 0 : sim_uniform(&seed, 0.01, 0.2);
        const double side = sim_uniform(&seed, 0.3, 0.6), x = sim_uniform(&seed, 1.2, 1.8);
        const double density = i % 4 == 0 ? 930 : sim_uniform(&seed, 100, 900);
        if (ground > 0) {
            tank_wall(w, 1.5, ground / 2, 3, ground / 2);
        }
        const plumb_body b = add_box(w, x, ground + side / 2, 0, side / 2, side / 2, density);
        tank_fill(w, 0, 0.1 * ceil(ground / 0.1 - 1e-6), 3, 2);
        sim_run(w, 480, HZ60);
        print_message("a box of %.0f kg/m^2, %.2f m: risen to %.2f of 2 m\n", density, side,
                      sim_y(w, b));
        assert_true(sim_y(w, b) > 1.4);
        plumb_world_destroy(w);
    }
}

// Three that lie on one another part.
static void stacks_part_in_water(void **state)
{
    (void)state;
    plumb_world *w = tank_make(3, 4, 0.05);
    plumb_body b[3];
    for (int i = 0; i < 3; ++i) {
        b[i] = add_box(w, 1.52, 0.2 + 0.4 * i, 0, 0.2, 0.2, 600);
    }
    tank_fill(w, 0, 0, 3, 2);
    sim_run(w, 480, HZ60);
    for (int i = 0; i < 3; ++i) {
        assert_true(sim_y(w, b[i]) > 1.5);
    }
    plumb_world_destroy(w);
}

// What is heavier stays; the water above is as calm as if it were ground. As bodies fall by g dt before contacts stop them, it once went
// round at 0.2 m/s.
static void what_is_heavy_lies_still(void **state)
{
    (void)state;
    const double densities[] = { 1100, 3000, 20000 };
    for (int i = 0; i < 3; ++i) {
        plumb_world *w = tank_make(3, 4, 0.05);
        const plumb_body low = add_box(w, 1.53, 0.25, 0, 0.25, 0.25, densities[i]);
        const plumb_body high = add_box(w, 1.5, 0.7, 0, 0.2, 0.2, densities[i]);
        tank_fill(w, 0, 0, 3, 2);
        sim_run(w, 900, HZ60);
        const double rms = watch(w, NULL).rms;
        print_message("two boxes of %.0f on the ground: at %.3f, %.3f m; water %.3f m/s\n",
                      densities[i], sim_y(w, low), sim_y(w, high), rms);
        assert_near(sim_y(w, low), 0.25, 0.01);
        assert_near(sim_y(w, high), 0.7, 0.02);
        assert_true(rms < 0.04);
        plumb_world_destroy(w);
    }
}

// What held bodies goes with an image.
static void images_know_what_held_them(void **state)
{
    (void)state;
    plumb_world *w = tank_make(3, 4, 0.05);
    plumb_world *other = sim_world(&(plumb_world_desc){ 0 });
    add_box(w, 1.53, 0.25, 0, 0.25, 0.25, 1500);
    add_box(w, 1.5, 0.7, 0, 0.2, 0.2, 2500);
    tank_fill(w, 0, 0, 3, 2);
    sim_run(w, 30, HZ60);
    const size_t size = plumb_world_snapshot_size(w);
    void *image = malloc(size);
    assert_non_null(image);
    assert_int_equal(plumb_world_save(w, image, size), PLUMB_OK);
    sim_run(w, 30, HZ60);
    assert_int_equal(plumb_world_restore(other, image, size), PLUMB_OK);
    sim_run(other, 30, HZ60);
    assert_true(plumb_world_hash(w) == plumb_world_hash(other));
    free(image);
    plumb_world_destroy(w);
    plumb_world_destroy(other);
}

//---- seams ---------------------------------------------------------------------------------------

// A closed tank whose walls stand on its floor and bear its lid, flush; turned, moved, its parts in any order.
typedef struct seam {
    double c, s, x, y;
    double fall; // speed that its water comes with [m/s]
    double dt;
    int first; // of its parts
} seam;

static plumb_vec2 seam_turned(const seam *m, double x, double y)
{
    return sim_vec(m->c * x - m->s * y, m->s * x + m->c * y);
}

static plumb_vec2 seam_place(const seam *m, double x, double y)
{
    const plumb_vec2 v = seam_turned(m, x, y);
    return sim_vec(m->x + (double)v.x, m->y + (double)v.y);
}

static plumb_world *seam_tank(const seam *m)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_world_set_gravity(w, seam_turned(m, 0, -9.81));
    const plumb_body tank =
        plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC,
                                                 .position = sim_vec(m->x, m->y),
                                                 .angle = (plumb_real)atan2(m->s, m->c) });
    for (int i = 0; i < 4; ++i) {
        const int k = (i + m->first) % 4;
        const double side = k % 2 == 0 ? -1 : 1;
        plumb_shape_create(
            w, tank,
            &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                 .center = k < 2 ? sim_vec(2.2 * side, 1.2)
                                                 : sim_vec(0, 1.2 + 1.4 * side),
                                 .half = k < 2 ? sim_vec(0.2, 1.2) : sim_vec(2.4, 0.2) });
    }
    assert_int_equal(plumb_liquid_create(w, &(plumb_liquid_desc){ .spacing = (plumb_real)0.1 }),
                     PLUMB_OK);
    for (double x = -1.95; x < 2; x += 0.1) {
        for (double y = 0.05; y < 0.8; y += 0.1) {
            const plumb_particle p = { .position = seam_place(m, x, y),
                                       .velocity = seam_turned(m, 0, -m->fall) };
            plumb_liquid_add(w, &p, 1);
        }
    }
    return w;
}

static int in_seams(const plumb_world *w, const seam *m)
{
    int count, found = 0;
    const plumb_particle *p = plumb_liquid_particles(w, &count);
    for (int i = 0; i < count; ++i) {
        const double dx = (double)p[i].position.x - m->x, dy = (double)p[i].position.y - m->y;
        const double x = fabs(m->c * dx + m->s * dy), y = m->c * dy - m->s * dx;
        found += x > 2.02 || fabs(y - 1.2) > 1.22;
    }
    return found;
}

static void add_stone(plumb_world *w, const seam *m, int side, uint32_t *seed)
{
    const double r = sim_uniform(seed, 0.2, 0.3);
    const plumb_vec2 at = seam_place(m, 1.5 * side, sim_uniform(seed, 1.3, 2));
    const plumb_vec2 corners[] = { sim_vec(r, 0), sim_vec(-0.3 * r, r),
                                   sim_vec(-0.5 * r, -0.9 * r) };
    const plumb_body stone =
        sim_body(w, PLUMB_DYNAMIC, (double)at.x, (double)at.y, sim_uniform(seed, -3, 3));
    plumb_shape_create(w, stone,
                       &(plumb_shape_desc){
                           .kind = PLUMB_POLYGON, .points = corners, .count = 3, .density = 1500 });
    plumb_body_set_velocity(w, stone, seam_turned(m, sim_uniform(seed, 0.5, 1.5) * side, 0));
}

// Heavy stones fall into the corners: nothing gets into the seams.
static void walls_on_a_floor_are_tight(void **state)
{
    (void)state;
    static const double steps[] = { 1.0 / 30, 1.0 / 60, 1.0 / 90 };
    uint32_t seed = 11;
    int found = 0;
    for (int i = 0; i < 36; ++i) {
        const double turn = i < 12 ? 0 : sim_uniform(&seed, -0.7, 0.7);
        const double far = i < 12 ? 0 : 30;
        const seam m = { cos(turn),
                         sin(turn),
                         sim_uniform(&seed, -far, far),
                         sim_uniform(&seed, -far, far),
                         i % 4 == 3 ? sim_uniform(&seed, 5, 40) : 0,
                         i < 6 ? steps[0] : steps[i % 3],
                         i };
        plumb_world *w = seam_tank(&m);
        add_stone(w, &m, -1, &seed);
        add_stone(w, &m, 1, &seed);
        sim_run(w, (int)(4 / m.dt), m.dt);
        found += in_seams(w, &m);
        plumb_world_destroy(w);
    }
    assert_int_equal(found, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_float_by_their_density),
        cmocka_unit_test(crates_press_no_water_away),
        cmocka_unit_test(boats_of_pieces_stay_dry),
        cmocka_unit_test(water_bears_what_is_displaced),
        cmocka_unit_test(what_hangs_stirs_nothing),
        cmocka_unit_test(what_is_light_leaves_the_ground),
        cmocka_unit_test(stacks_part_in_water),
        cmocka_unit_test(what_is_heavy_lies_still),
        cmocka_unit_test(images_know_what_held_them),
        cmocka_unit_test(walls_on_a_floor_are_tight),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
