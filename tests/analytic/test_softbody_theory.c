// test_softbody_theory.c - soft bodies against the strength of materials: a cantilever's tip and its first mode, a bar that is
// stretched, the modes of a string, a rope round a post that holds by friction (Euler, Eytelwein), two weights on a cable
// (Atwood). Static answers are the same at any step.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/sim.h"

#define NODES_MOST 200

// A soft body under construction: nodes in a row.
typedef struct row {
    plumb_softbody_node nodes[NODES_MOST];
    plumb_softbody_edge edges[NODES_MOST];
    plumb_softbody_bend bends[NODES_MOST];
    plumb_softbody_pin pins[4];
    plumb_softbody_desc desc;
} row;

static void add_node(row *r, double x, double y, double mass, double radius)
{
    r->nodes[r->desc.node_count++] = (plumb_softbody_node){ .position = sim_vec(x, y),
                                                            .mass = (plumb_real)mass,
                                                            .radius = (plumb_real)radius };
}

// Edges from each node to the next.
static void tie(row *r, double stiffness, double length, uint32_t flags)
{
    for (int i = 0; i + 1 < r->desc.node_count; ++i) {
        r->edges[r->desc.edge_count++] = (plumb_softbody_edge){ .a = (uint32_t)i,
                                                                .b = (uint32_t)i + 1,
                                                                .flags = flags,
                                                                .stiffness = (plumb_real)stiffness,
                                                                .length = (plumb_real)length };
    }
}

static void pin(row *r, int node)
{
    r->pins[r->desc.pin_count++] =
        (plumb_softbody_pin){ .node = (uint32_t)node, .point = r->nodes[node].position };
}

static plumb_softbody make(plumb_world *w, row *r)
{
    r->desc.nodes = r->nodes;
    r->desc.edges = r->edges;
    r->desc.bends = r->bends;
    r->desc.pins = r->pins;
    const plumb_softbody s = plumb_softbody_create(w, &r->desc);
    assert_false(plumb_is_null(s));
    return s;
}

static plumb_softbody_node node_of(const plumb_world *w, plumb_softbody s, int i)
{
    plumb_softbody_desc d;
    assert_int_equal(plumb_softbody_settings(w, s, &d), PLUMB_OK);
    return d.nodes[i];
}

static double node_y(const plumb_world *w, plumb_softbody s, int i)
{
    const plumb_softbody_node n = node_of(w, s, i);
    return (double)n.position.y + (double)n.position_rest.y;
}

// A rod of length 1 in `pieces`, clamped: a node before its root is held, too, and half a piece bends there.
static void clamp_rod(row *r, int pieces, double stiffness, double mass)
{
    const double l = 1.0 / pieces;
    *r = (row){ .desc = { 0 } };
    for (int i = -1; i <= pieces; ++i) {
        add_node(r, l * i, 0, i == pieces ? mass * l / 2 : mass * l, 0);
    }
    tie(r, 1e5 * pieces, l, 0);
    for (uint32_t i = 0; i < (uint32_t)pieces; ++i) {
        r->bends[r->desc.bend_count++] =
            (plumb_softbody_bend){ .a = i,
                                   .b = i + 1,
                                   .c = i + 2,
                                   .stiffness = (plumb_real)stiffness,
                                   .length = (plumb_real)(i == 0 ? l / 2 : l) };
    }
    pin(r, 0);
    pin(r, 1);
}

//---- beams ---------------------------------------------------------------------------------------

// F L^3 / 3 E I for 0.3 N and 100 N m^2: 1 mm. Answers how far off it is, over that.
static double tip_error(int pieces, double hz)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true });
    static row r;
    clamp_rod(&r, pieces, 100, 1e-6);
    r.nodes[pieces + 1].mass = (plumb_real)(0.3 / SIM_G);
    r.desc.damping = 30;
    const plumb_softbody s = make(w, &r);
    sim_run(w, (int)(3 * hz), 1 / hz);
    const double tip = -node_y(w, s, pieces + 1);
    plumb_world_destroy(w);
    return tip / 1e-3 - 1;
}

static void a_cantilever_bends_as_theory_says(void **state)
{
    (void)state;
    const double error[] = { tip_error(5, 60), tip_error(10, 60), tip_error(20, 60) };
    print_message("tip of a cantilever of 5, 10, 20 pieces: off by %.3g, %.3g, %.3g, order %.2f\n",
                  error[0], error[1], error[2], sim_order(error, 3));
    assert_true(fabs(error[2]) < 2e-3 && fabs(sim_order(error, 3) - 2) < 0.1);
    const double rates[] = { 30, 120, 240 };
    for (int i = 0; i < 3; ++i) {
        assert_near(tip_error(10, rates[i]), error[1], 1e-5);
    }
}

// Period of what is a cosine to begin with: by its zeros.
typedef struct period {
    double before, first, last;
    int zeros;
} period;

static void note(period *p, double time, double value, double dt)
{
    if (p->before * value < 0) {
        p->last = time - dt * value / (value - p->before);
        p->first = p->zeros == 0 ? p->last : p->first;
        ++p->zeros;
    }
    p->before = value;
}

static double frequency(const period *p)
{
    assert_true(p->zeros > 4);
    return SIM_PI * (p->zeros - 1) / (p->last - p->first);
}

// 1.8751041^2 sqrt(E I / m L^4) = 3.5160 rad/s.
static double mode_error(int pieces)
{
    const double beta = 1.8751040687, sigma = 0.7340955138, dt = 1 / 120.0;
    plumb_world *w =
        sim_world(&(plumb_world_desc){ .zero_gravity = true, .substeps = 8, .no_sleep = true });
    static row r;
    clamp_rod(&r, pieces, 1, 1);
    for (int i = 2; i <= pieces + 1; ++i) {
        const double x = beta * (i - 1) / pieces;
        r.nodes[i].position.y =
            (plumb_real)(1e-3 * (cosh(x) - cos(x) - sigma * (sinh(x) - sin(x))));
    }
    const plumb_softbody s = make(w, &r);
    period p = { .before = node_y(w, s, pieces + 1) };
    for (int i = 1; i <= 1200; ++i) {
        sim_step(w, dt);
        note(&p, i * dt, node_y(w, s, pieces + 1), dt);
    }
    plumb_world_destroy(w);
    return frequency(&p) / (beta * beta) - 1;
}

static void a_cantilever_swings_in_its_first_mode(void **state)
{
    (void)state;
    const double error[] = { -mode_error(4), -mode_error(8), -mode_error(16) };
    print_message(
        "first mode of a cantilever of 4, 8, 16 pieces: slower by %.3g, %.3g, %.3g, order %.2f\n",
        error[0], error[1], error[2], sim_order(error, 3));
    assert_true(error[2] < 4e-3 && fabs(sim_order(error, 3) - 2) < 0.1);
}

// A strip 2 m long and 0.4 m wide of triangles, of Young's modulus times thickness 1000 N/m, that a weight of 0.2 N pulls at all
// of its lower end: longer by F L / (E t w) = 1 mm, for small strains; narrower in its middle by Poisson's share of that.
static void a_bar_stretches_as_theory_says(void **state)
{
    (void)state;
    const double rates[] = { 30, 60, 240 }, load = 0.2;
    for (int k = 0; k < 3; ++k) {
        plumb_world *w = sim_world(&(plumb_world_desc){ .no_sleep = true });
        plumb_softbody_node nodes[5 * 21];
        plumb_softbody_triangle triangles[4 * 20 * 2];
        plumb_softbody_pin pins[5];
        int count = 0;
        for (int j = 0; j <= 20; ++j) {
            for (int i = 0; i <= 4; ++i) {
                const double share = i == 0 || i == 4 ? 0.125 : 0.25;
                nodes[5 * j + i] = (plumb_softbody_node){
                    .position = sim_vec(0.1 * i - 0.2, -0.1 * j),
                    .mass = (plumb_real)(j == 20 ? share * load / SIM_G : 1e-8),
                };
                if (i < 4 && j < 20) {
                    const uint32_t a = (uint32_t)(5 * j + i), b = a + 1, c = a + 5, d = a + 6;
                    const bool way = (i + j) % 2 == 0;
                    const uint32_t t[2][3] = { { a, c, way ? d : b }, { way ? a : c, d, b } };
                    for (int n = 0; n < 2; ++n) {
                        triangles[count++] =
                            (plumb_softbody_triangle){ .a = t[n][0],
                                                       .b = t[n][1],
                                                       .c = t[n][2],
                                                       .young = 1000,
                                                       .poisson = (plumb_real)0.3,
                                                       .damping = (plumb_real)0.02 };
                    }
                }
            }
        }
        for (int i = 0; i < 5; ++i) {
            pins[i] = (plumb_softbody_pin){ .node = (uint32_t)i, .point = nodes[i].position };
        }
        const plumb_softbody s =
            plumb_softbody_create(w, &(plumb_softbody_desc){ .nodes = nodes,
                                                             .node_count = 105,
                                                             .triangles = triangles,
                                                             .triangle_count = count,
                                                             .pins = pins,
                                                             .pin_count = 5,
                                                             .damping = 5 });
        assert_false(plumb_is_null(s));
        sim_run(w, (int)(8 * rates[k]), 1 / rates[k]);
        // Between rows 5 and 15 nothing is felt of the clamp.
        const double stretch = (node_y(w, s, 5 * 5 + 2) - node_y(w, s, 5 * 15 + 2) - 1) / 5e-4 - 1;
        const plumb_softbody_node left = node_of(w, s, 50), right = node_of(w, s, 54);
        const double narrow = (double)(left.position.x - right.position.x) +
                              (double)(left.position_rest.x - right.position_rest.x) + 0.4;
        print_message("bar at %.0f Hz: longer by %.3g too much of it, narrower by %.4f of 0.3\n",
                      rates[k], stretch, narrow / 0.4 / 5e-4);
        assert_near(stretch, 0, 2e-3);
        assert_near(narrow / 0.4 / 5e-4, 0.3, 3e-3);
        plumb_world_destroy(w);
    }
}

//---- strings and ropes ---------------------------------------------------------------------------

// 1 m, 1 kg, 100 N: mode n swings at 10 n pi rad/s, less as pieces are coarse: 2 / l sin(n pi l / 2) 10.
static void a_string_has_its_modes(void **state)
{
    (void)state;
    const int pieces = 32;
    const double l = 1.0 / pieces, dt = 1 / 480.0;
    for (int n = 1; n <= 4; ++n) {
        plumb_world *w =
            sim_world(&(plumb_world_desc){ .zero_gravity = true, .substeps = 8, .no_sleep = true });
        static row r;
        r = (row){ .desc = { 0 } };
        for (int i = 0; i <= pieces; ++i) {
            add_node(&r, l * i, 1e-4 * sin(n * SIM_PI * l * i), l, 0);
        }
        tie(&r, 1e4 / (l / 1.01), l / 1.01, PLUMB_EDGE_PULLS); // E A 1e4 N, stretched by 1 %
        pin(&r, 0);
        pin(&r, pieces);
        const plumb_softbody s = make(w, &r);
        const int peak = pieces / (2 * n);
        period p = { .before = node_y(w, s, peak) };
        for (int i = 1; i <= 1440; ++i) {
            sim_step(w, dt);
            note(&p, i * dt, node_y(w, s, peak), dt);
        }
        const double lattice = 2 / l * sin(n * SIM_PI * l / 2) * 10;
        print_message(
            "mode %d: %.4f rad/s, %.4f of the string of %d pieces, %.4f of a smooth one\n", n,
            frequency(&p), lattice, pieces, 10 * n * SIM_PI);
        assert_near(frequency(&p) / lattice, 1, 5e-4);
        plumb_world_destroy(w);
    }
}

// A rope over a post of radius 0.5 m, half round it, with weights at its ends.
typedef struct hoist {
    plumb_world *w;
    plumb_softbody rope;
    int last;
} hoist;

static hoist hang(double friction, double left, double right)
{
    hoist h;
    h.w = sim_world(&(plumb_world_desc){ .no_sleep = true });
    plumb_material m =
        plumb_material_create(h.w, &(plumb_material_desc){ .friction = (plumb_real)friction,
                                                           .frictionless = friction == 0 });
    const plumb_body post = sim_body(h.w, PLUMB_STATIC, 0, 0, 0);
    sim_add_circle(h.w, post, 0.5, m);
    static row r;
    r = (row){ .desc = { .friction = (plumb_real)friction } };
    const double radius = 0.01, reach = 0.5 + radius;
    const int round = 48, down = 30;
    const double turn = SIM_PI / round, l = 2 * reach * sin(turn / 2);
    for (int i = down; i > 0; --i) {
        add_node(&r, -reach, -l * i, 1e-4, radius);
    }
    for (int i = 0; i <= round; ++i) {
        add_node(&r, -reach * cos(turn * i), reach * sin(turn * i), 1e-4, radius);
    }
    for (int i = 1; i <= down; ++i) {
        add_node(&r, reach, -l * i, 1e-4, radius);
    }
    h.last = r.desc.node_count - 1;
    r.nodes[0].mass = (plumb_real)left;
    r.nodes[h.last].mass = (plumb_real)right;
    tie(&r, 1e5 / l, l, PLUMB_EDGE_PULLS);
    for (int i = 0; i < h.last; ++i) {
        r.edges[i].damping = 200;
    }
    h.rope = make(h.w, &r);
    return h;
}

// It holds up to exp(mu pi) = 2.566 for 0.3, at any step, and slides beyond, at first by
// (share - 1) / (share + 1) g, from a run-up in which the rope gets tight.
static void a_rope_round_a_post_holds_by_friction(void **state)
{
    (void)state;
    const double rates[] = { 30, 60, 240 }, holds = exp(0.3 * SIM_PI);
    for (int k = 0; k < 6; ++k) {
        const double hz = rates[k / 2], share = k % 2 == 0 ? 0.96 : 1.04;
        hoist h = hang(0.3, 1, share * holds);
        sim_run(h.w, (int)(0.2 * hz), 1 / hz);
        const double before = node_y(h.w, h.rope, h.last);
        sim_run(h.w, (int)(0.5 * hz), 1 / hz);
        const double way = before - node_y(h.w, h.rope, h.last);
        const double theory = (share - 1) / (share + 1) * SIM_G * (0.7 * 0.7 - 0.2 * 0.2) / 2;
        print_message("%.0f Hz, %.2f of what holds: slid %.4f m, of %.4f\n", hz, share, way,
                      share > 1 ? theory : 0);
        assert_true(share < 1 ? fabs(way) < 2e-3 : way > 0.6 * theory && way < 2.6 * theory);
        plumb_world_destroy(h.w);
    }
}

// Without friction 1 kg and 2 kg fall at g / 3, less for the corners that a rope of pieces has on a post.
static void two_weights_fall_as_atwood_says(void **state)
{
    (void)state;
    hoist h = hang(0, 1, 2);
    sim_run(h.w, 6, 1 / 60.0);
    const double before = node_y(h.w, h.rope, h.last);
    const double speed = (double)node_of(h.w, h.rope, h.last).velocity.y;
    sim_run(h.w, 24, 1 / 60.0);
    const double way = node_y(h.w, h.rope, h.last) - before - speed * 0.4;
    print_message("falls at %.4f of what it should\n", -way / (0.08 * SIM_G / 3));
    assert_near(-way / (0.08 * SIM_G / 3), 1, 0.04);
    plumb_world_destroy(h.w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cantilever_bends_as_theory_says),
        cmocka_unit_test(a_cantilever_swings_in_its_first_mode),
        cmocka_unit_test(a_bar_stretches_as_theory_says),
        cmocka_unit_test(a_string_has_its_modes),
        cmocka_unit_test(a_rope_round_a_post_holds_by_friction),
        cmocka_unit_test(two_weights_fall_as_atwood_says),
    };
    return cmocka_run_group_tests_name("soft bodies and the strength of materials", tests, NULL,
                                       NULL);
}
