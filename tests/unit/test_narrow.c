// test_narrow.c - each narrow-phase kernel on pairs whose contact is known exactly: normal,
// separation, points; features that stay when the pair moves a little; impulses that follow their
// feature; equal bits at every width.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "harness/near.h"
#include "harness/pairs.h"
#include "harness/sim.h"
#include "world/state.h"

#define QUARTER (SIM_PI / 4)
#define ROOT2   1.41421356237309505

typedef enum kind { CIRCLE, CAPSULE, BOX, TRIANGLE, HEXAGON } kind;

typedef struct side {
    kind kind;
    double u, v, r; // radius, half length, half extents; rounding
    double x, y, angle;
} side;

typedef struct known {
    const char *name;
    side p, q;
    int count;         // of points; 0: apart
    double nx, ny;     // from P to Q
    double separation; // of all points
    double x[2], y[2]; // in any order
} known;

// clang-format off
static const known cases[] = {
    { "circles overlap", { CIRCLE, 1, 0, 0, 0, 0, 0 }, { CIRCLE, 1, 0, 0, 1.5, 0, 0 },
      1, 1, 0, -0.5, { 0.75 }, { 0 } },
    { "circles touch, diagonal", { CIRCLE, 1, 0, 0, 0, 0, 0 }, { CIRCLE, 0.25, 0, 0, 0.75, 1, 0 },
      1, 0.6, 0.8, 0, { 0.6 }, { 0.8 } },
    { "circles nearly touch", { CIRCLE, 0.5, 0, 0, 0, 0, 0 }, { CIRCLE, 0.5, 0, 0, 0, -1.01, 0 },
      1, 0, -1, 0.01, { 0 }, { -0.505 } },
    { "circles apart", { CIRCLE, 0.5, 0, 0, 0, 0, 0 }, { CIRCLE, 0.5, 0, 0, 0, -1.5, 0 },
      0, 0, 0, 0, { 0 }, { 0 } },
    { "circle in a circle", { CIRCLE, 2, 0, 0, 0, 0, 0 }, { CIRCLE, 0.5, 0, 0, 1, 0, 0 },
      1, 1, 0, -1.5, { 1.25 }, { 0 } },

    { "circle on a capsule's side", { CIRCLE, 0.5, 0, 0, 0.3, 0.9, 0 }, { CAPSULE, 1, 0, 0.5, 0, 0, 0 },
      1, 0, -1, -0.1, { 0.3 }, { 0.45 } },
    { "circle at a capsule's end", { CIRCLE, 0.5, 0, 0, 1.9, 0, 0 }, { CAPSULE, 1, 0, 0.5, 0, 0, 0 },
      1, -1, 0, -0.1, { 1.45 }, { 0 } },
    { "circle past a capsule's end", { CIRCLE, 0.5, 0, 0, 1.6, 0.8, 0 }, { CAPSULE, 1, 0, 0.6, 0, 0, 0 },
      1, -0.6, -0.8, -0.1, { 1.33 }, { 0.44 } },
    { "circle on a turned segment", { CIRCLE, 0.5, 0, 0, 0.4, 0, 0 }, { CAPSULE, 1, 0, 0, 0, 0, SIM_PI / 2 },
      1, -1, 0, -0.1, { -0.05 }, { 0 } },

    { "circle on a box's face", { CIRCLE, 0.5, 0, 0, 0.25, 1.4, 0 }, { BOX, 1, 1, 0, 0, 0, 0 },
      1, 0, -1, -0.1, { 0.25 }, { 0.95 } },
    { "circle at a box's corner", { CIRCLE, 0.5, 0, 0, 1.24, 1.32, 0 }, { BOX, 1, 1, 0, 0, 0, 0 },
      1, -0.6, -0.8, -0.1, { 0.97 }, { 0.96 } },
    { "circle's centre in a box", { CIRCLE, 0.5, 0, 0, 0.75, 0.125, 0 }, { BOX, 1, 1, 0, 0, 0, 0 },
      1, -1, 0, -0.75, { 0.625 }, { 0.125 } },
    { "circle's centre on a face", { CIRCLE, 0.5, 0, 0, 0.25, -1, 0 }, { BOX, 1, 1, 0, 0, 0, 0 },
      1, 0, 1, -0.5, { 0.25 }, { -0.75 } },
    { "circle on a rounded box", { CIRCLE, 0.5, 0, 0, 0, 1.4, 0 }, { BOX, 1, 0.75, 0.25, 0, 0, 0 },
      1, 0, -1, -0.1, { 0 }, { 0.95 } },
    { "circle on a turned box", { CIRCLE, 0.5, 0, 0, 0, ROOT2 + 0.4, 0 }, { BOX, 1, 1, 0, 0, 0, QUARTER },
      1, 0, -1, -0.1, { 0 }, { ROOT2 - 0.05 } },

    { "circle on a triangle's face", { CIRCLE, 0.5, 0, 0, 0.25, -0.4, 0 }, { TRIANGLE, 1, 2, 0, 0, 0, 0 },
      1, 0, 1, -0.1, { 0.25 }, { 0.05 } },
    { "circle at a triangle's top", { CIRCLE, 0.5, 0, 0, 0, 2.4, 0 }, { TRIANGLE, 1, 2, 0, 0, 0, 0 },
      1, 0, -1, -0.1, { 0 }, { 1.95 } },
    { "circle's centre in a triangle", { CIRCLE, 0.25, 0, 0, 0, 0.1, 0 }, { TRIANGLE, 1, 2, 0, 0, 0, 0 },
      1, 0, 1, -0.35, { 0 }, { 0.175 } },

    { "box on a box", { BOX, 2, 1, 0, 0, 0, 0 }, { BOX, 1, 1, 0, 0.5, 1.9, 0 },
      2, 0, 1, -0.1, { -0.5, 1.5 }, { 0.95, 0.95 } },
    { "boxes touch exactly", { BOX, 1, 1, 0, 0, 0, 0 }, { BOX, 1, 1, 0, 2, 0, 0 },
      2, 1, 0, 0, { 1, 1 }, { -1, 1 } },
    { "boxes touch, shifted", { BOX, 1, 1, 0, 0, 0, 0 }, { BOX, 1, 1, 0, -2, 1.5, 0 },
      2, -1, 0, 0, { -1, -1 }, { 0.5, 1 } },
    { "box on its corner", { BOX, 2, 1, 0, 0, 0, 0 }, { BOX, 1, 1, 0, 0.5, 0.9 + ROOT2, QUARTER },
      2, 0, 1, -0.1, { 0.5, 0 }, { 0.95, 0 } },
    { "box turned by a right angle", { BOX, 2, 1, 0, 0, 0, 0 }, { BOX, 1, 0.5, 0, 0, 1.9, SIM_PI / 2 },
      2, 0, 1, -0.1, { -0.5, 0.5 }, { 0.95, 0.95 } },
    { "boxes apart", { BOX, 1, 1, 0, 0, 0, 0 }, { BOX, 1, 1, 0, 2.5, 0, 0 },
      0, 0, 0, 0, { 0 }, { 0 } },
    { "rounded box on a box", { BOX, 2, 1, 0, 0, 0, 0 }, { BOX, 1, 0.75, 0.25, 0, 1.9, 0 },
      2, 0, 1, -0.1, { -1, 1 }, { 0.95, 0.95 } },
    { "rounded box on a rounded box", { BOX, 2, 0.5, 0.5, 0, 0, 0 }, { BOX, 1, 0.75, 0.25, 0, 1.9, 0 },
      2, 0, 1, -0.1, { -1, 1 }, { 0.95, 0.95 } },

    { "capsules side by side", { CAPSULE, 1, 0, 0.5, 0, 0, 0 }, { CAPSULE, 1, 0, 0.5, 0.5, 0.9, 0 },
      2, 0, 1, -0.1, { -0.5, 1 }, { 0.45, 0.45 } },
    { "capsules end to end", { CAPSULE, 1, 0, 0.5, 0, 0, 0 }, { CAPSULE, 1, 0, 0.5, 2.9, 0, 0 },
      1, 1, 0, -0.1, { 1.45 }, { 0 } },
    { "capsules end to end, apart", { CAPSULE, 1, 0, 0.5, 0, 0, 0 }, { CAPSULE, 1, 0, 0.5, 4, 0, 0 },
      0, 0, 0, 0, { 0 }, { 0 } },
    { "segments in line, apart", { CAPSULE, 1, 0, 0, 0, 0, 0 }, { CAPSULE, 1, 0, 0, 2.5, 0, 0 },
      0, 0, 0, 0, { 0 }, { 0 } },
    { "capsule upright on another", { CAPSULE, 1, 0, 0.5, 0, 0, 0 }, { CAPSULE, 1, 0, 0.25, 0.5, 1.65, SIM_PI / 2 },
      1, 0, 1, -0.1, { 0.5 }, { 0.45 } },
    { "capsule ends meet diagonally", { CAPSULE, 1, 0, 0.5, 0, 0, 0 }, { CAPSULE, 1, 0, 0.5, 2.54, 0.72, 0 },
      1, 0.6, 0.8, -0.1, { 1.27 }, { 0.36 } },

    { "capsule lies on a box", { CAPSULE, 0.5, 0, 0.25, 0, 1.2, 0 }, { BOX, 1, 1, 0, 0, 0, 0 },
      2, 0, -1, -0.05, { -0.5, 0.5 }, { 0.975, 0.975 } },
    { "segment under a box", { CAPSULE, 5, 0, 0, 0, 0, 0 }, { BOX, 1, 1, 0, 0.5, 0.95, 0 },
      2, 0, 1, -0.05, { -0.5, 1.5 }, { -0.025, -0.025 } },
    { "triangle stands on a box", { BOX, 4, 1, 0, 0, -1, 0 }, { TRIANGLE, 1, 2, 0, 0.5, -0.1, 0 },
      2, 0, 1, -0.1, { -0.5, 1.5 }, { -0.05, -0.05 } },
    { "hexagon on a hexagon", { HEXAGON, 1, 0, 0, 0, 0, 0 }, { HEXAGON, 1, 0, 0, 0, 1.632051, 0 },
      2, 0, 1, -0.1, { -0.5, 0.5 }, { 0.816025, 0.816025 } },
    { "rounded hexagon on a box", { BOX, 4, 1, 0, 0, -1, 0 }, { HEXAGON, 1, 0, 0.25, 0, 1.016025, 0 },
      2, 0, 1, -0.1, { -0.5, 0.5 }, { -0.05, -0.05 } },
};
// clang-format on

static pair_shape shape_of(const side *s)
{
    plumb_vec2 p[6];
    switch (s->kind) {
    case CIRCLE:
        return pair_circle(s->u);
    case CAPSULE:
        return pair_capsule(s->u, s->r);
    case BOX:
        return pair_box(s->u, s->v, s->r);
    case TRIANGLE:
        p[0] = sim_vec(-s->u, 0), p[1] = sim_vec(s->u, 0), p[2] = sim_vec(0, s->v);
        return pair_polygon(p, 3, s->r);
    default:
        for (int i = 0; i < 6; ++i) {
            p[i] = sim_vec(s->u * cos(i * SIM_PI / 3), s->u * sin(i * SIM_PI / 3));
        }
        return pair_polygon(p, 6, s->r);
    }
}

// [m] results may be off by: coordinates of up to 5 m go through a dozen roundings.
static double slack(void)
{
    return SIM_TOLERANCE(4e-6, 2e-6); // expected values are written to six digits
}

static void add_known(pair_batch *batch, const known *k)
{
    pair_shape p = shape_of(&k->p), q = shape_of(&k->q);
    pairs_add(batch, &p, (pair_pose){ k->p.x, k->p.y, k->p.angle }, &q,
              (pair_pose){ k->q.x, k->q.y, k->q.angle });
}

// The anchors lie on the two surfaces; the table has the point midway.
static void middle_of(const pair_batch *batch, const pl_manifold *m, uint32_t i, double *x,
                      double *y)
{
    const pl_pose *a = &pairs_a(batch, 0)->pose, *b = &pairs_b(batch, 0)->pose;
    *x = ((double)(a->x + m->point[i].ax) + (double)(b->x + m->point[i].bx)) / 2;
    *y = ((double)(a->y + m->point[i].ay) + (double)(b->y + m->point[i].by)) / 2;
}

static plumb_transform transform_of(const pair_side *s)
{
    return (plumb_transform){ plumb_v2((plumb_real)s->pose.x, (plumb_real)s->pose.y),
                              { (plumb_real)s->pose.c, (plumb_real)s->pose.s } };
}

// One case; prints what differs. Points that the table gives twice may be one.
static bool as_known(const pair_batch *batch, const known *k)
{
    pl_manifold m = { .count = 0 };
    bool met = pairs_manifold(batch, 0, &m);
    if (!met || k->count == 0) {
        if (met != (k->count > 0)) {
            print_message("%s: %s\n", k->name, met ? "a contact" : "no contact");
        }
        return met == (k->count > 0);
    }
    bool ok = fabs((double)m.nx - k->nx) <= slack() && fabs((double)m.ny - k->ny) <= slack();
    double deepest = INFINITY;
    int found = 0;
    for (uint32_t i = 0; i < m.count; ++i) {
        double separation = (double)m.point[i].separation, x, y;
        middle_of(batch, &m, i, &x, &y);
        deepest = fmin(deepest, separation);
        for (int j = 0; j < k->count; ++j) {
            found += fabs(x - k->x[j]) <= slack() && fabs(y - k->y[j]) <= slack() &&
                     fabs(separation - k->separation) <= slack();
        }
    }
    // A box on its corner: the corner, and what else the clip finds higher up.
    bool corner = k->p.kind == BOX && k->q.kind == BOX && k->q.angle == QUARTER;
    ok = ok && fabs(deepest - k->separation) <= slack();
    ok = ok && (corner ? found >= 1 : found == k->count && (int)m.count == k->count);
    if (!ok) {
        print_message("%s: normal %g, %g", k->name, (double)m.nx, (double)m.ny);
        for (uint32_t i = 0; i < m.count; ++i) {
            double x, y;
            middle_of(batch, &m, i, &x, &y);
            print_message("; at %g, %g: %g", x, y, (double)m.point[i].separation);
        }
        print_message("\n");
    }
    return ok;
}

static void kernels_find_known_contacts(void **state)
{
    (void)state;
    pair_batch *batch = pairs_create(1);
    int wrong = 0;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const known *k = &cases[i];
        pairs_clear(batch);
        add_known(batch, k);
        pairs_run(batch, 4);
        wrong += !as_known(batch, k);
    }
    pairs_destroy(batch);
    assert_int_equal(wrong, 0);
}

// Exactly in one place: no direction is right, but it must be a unit vector and the depth finite.
static void coincident_shapes_get_some_contact(void **state)
{
    (void)state;
    const side same[] = { { CIRCLE, 1, 0, 0, 0, 0, 0 },   { CAPSULE, 1, 0, 0.5, 0, 0, 0 },
                          { CAPSULE, 1, 0, 0, 0, 0, 0 },  { BOX, 1, 1, 0, 0, 0, 0 },
                          { BOX, 1, 1, 0, 3, -2, 0.3 },   { TRIANGLE, 1, 2, 0, 0, 0, 0 },
                          { HEXAGON, 1, 0, 0.5, 0, 0, 1 } };
    pair_batch *batch = pairs_create(1);
    for (size_t i = 0; i < sizeof same / sizeof same[0]; ++i) {
        const known k = { .name = "coincident", .p = same[i], .q = same[i] };
        pairs_clear(batch);
        add_known(batch, &k);
        pairs_run(batch, 4);
        pl_manifold m;
        assert_true(pairs_manifold(batch, 0, &m));
        assert_near(hypot((double)m.nx, (double)m.ny), 1, slack());
        for (uint32_t j = 0; j < m.count; ++j) {
            double s = (double)m.point[j].separation;
            assert_true(s <= slack() && s >= -8);
            assert_true(isfinite((double)m.point[j].ax) && isfinite((double)m.point[j].ay));
            assert_true(isfinite((double)m.point[j].bx) && isfinite((double)m.point[j].by));
        }
    }
    pairs_destroy(batch);
}

// A resting contact jitters; its features must not, or warm starting would be lost. The impulses of
// the step before arrive with the feature.
static void features_stay_and_carry_impulses(void **state)
{
    (void)state;
    const known resting[] = {
        { .name = "box on box",
          .p = { BOX, 2, 1, 0, 0, 0, 0 },
          .q = { BOX, 1, 1, 0, 0.5, 1.995, 0 } },
        { .name = "equal boxes",
          .p = { BOX, 1, 1, 0, 0, 0, 0 },
          .q = { BOX, 1, 1, 0, 0, 1.995, 0 } },
        { .name = "capsules",
          .p = { CAPSULE, 1, 0, 0.5, 0, 0, 0 },
          .q = { CAPSULE, 1, 0, 0.5, 0.5, 0.995, 0 } },
        { .name = "hexagon on box",
          .p = { BOX, 4, 1, 0, 0, -1, 0 },
          .q = { HEXAGON, 1, 0, 0, 0, 0.863, 0 } },
        { .name = "triangle on box",
          .p = { BOX, 4, 1, 0, 0, -1, 0 },
          .q = { TRIANGLE, 1, 2, 0, 0, -0.004, 0 } },
    };
    pair_batch *batch = pairs_create(1);
    unsigned seed = 99;
    for (size_t i = 0; i < sizeof resting / sizeof resting[0]; ++i) {
        const known *k = &resting[i];
        pairs_clear(batch);
        add_known(batch, k);
        pairs_run(batch, 4);
        pl_manifold first, m;
        assert_true(pairs_manifold(batch, 0, &first));
        assert_int_equal(first.count, 2);
        assert_true(first.feature[0] != first.feature[1]);
        pairs_set_impulses(batch, 0, 3, 4);
        for (int j = 0; j < 200; ++j) {
            pairs_move_b(batch, 0,
                         (pair_pose){ k->q.x + sim_uniform(&seed, -1e-3, 1e-3),
                                      k->q.y + sim_uniform(&seed, -2e-4, 2e-4),
                                      k->q.angle + sim_uniform(&seed, -1e-4, 1e-4) });
            pairs_run(batch, 4);
            assert_true(pairs_manifold(batch, 0, &m));
            if (m.count != 2 || m.feature[0] != first.feature[0] ||
                m.feature[1] != first.feature[1]) {
                print_message("%s: features %#x %#x became %#x %#x\n", k->name, first.feature[0],
                              first.feature[1], m.feature[0], m.feature[1]);
                fail();
            }
            assert_near((double)m.point[0].normal, 3, 0);
            assert_near((double)m.point[1].normal, 4, 0);
        }
    }
    pairs_destroy(batch);
}

// All pairs of two kinds in one batch of a length that fills no vector: each width gives the bits
// that one pair alone gives.
static void widths_agree_bit_for_bit(void **state)
{
    (void)state;
    const known *of_kind[3] = { &cases[0], &cases[9], &cases[18] };
    const int widths[] = { 4, 8, 16 };
    for (int group = 0; group < 3; ++group) {
        const known *k = of_kind[group];
        pair_batch *batch = pairs_create(37), *single = pairs_create(1);
        unsigned seed = 4711;
        for (int i = 0; i < 37; ++i) {
            known moved = *k;
            moved.q.x += sim_uniform(&seed, -0.1, 0.1);
            moved.q.y += sim_uniform(&seed, -0.1, 0.1);
            moved.q.angle += sim_uniform(&seed, -0.5, 0.5);
            add_known(batch, &moved);
        }
        for (int w = 0; w < 3; ++w) {
            if (!pairs_width_runs(widths[w])) {
                continue;
            }
            pairs_run(batch, widths[w]);
            for (int i = 0; i < 37; ++i) {
                pl_manifold m, alone;
                const pair_side *a = pairs_a(batch, i), *b = pairs_b(batch, i);
                pairs_clear(single);
                pairs_add_sides(single, a, b);
                pairs_run(single, 4);
                bool met = pairs_manifold(batch, i, &m);
                assert_int_equal(met, pairs_manifold(single, 0, &alone));
                if (met) {
                    assert_memory_equal(&m.nx, &alone.nx, offsetof(pl_manifold, body_a));
                    assert_memory_equal(m.feature, alone.feature, sizeof m.feature);
                }
            }
        }
        pairs_destroy(batch);
        pairs_destroy(single);
    }
}

// Long things end to end, turned and shifted by less than a reference face changes sides for: what the faces say of
// each other then differs. No contact is deeper than the pieces are.
static void nothing_in_line_is_struck_in_thin_air(void **state)
{
    (void)state;
    const side kinds[] = { { CAPSULE, 0.15, 0, 0.15, 0, 0, 0 },
                           { CAPSULE, 1, 0, 0, 0, 0, 0 },
                           { CAPSULE, 0.5, 0, 0.4, 0, 0, 0 },
                           { BOX, 0.4, 0.001, 0.2, 0, 0, 0 },
                           { HEXAGON, 0.5, 0, 0.1, 0, 0, 0 } };
    enum { KINDS = sizeof kinds / sizeof kinds[0] };
    pair_batch *batch = pairs_create(1);
    unsigned seed = 5;
    int wrong = 0, met = 0;
    for (int i = 0; i < 20000; ++i) {
        known k = { .p = kinds[i % KINDS], .q = kinds[i / KINDS % KINDS] };
        const double turn = sim_uniform(&seed, -3, 3), gap = sim_uniform(&seed, 1e-4, 0.6);
        const double along = k.p.u + k.q.u + gap, aside = sim_uniform(&seed, -6e-4, 6e-4);
        k.p.angle = turn + sim_uniform(&seed, -1e-3, 1e-3);
        k.q.angle = turn + sim_uniform(&seed, -1e-3, 1e-3);
        k.q.x = along * cos(turn) - aside * sin(turn);
        k.q.y = along * sin(turn) + aside * cos(turn);
        pairs_clear(batch);
        add_known(batch, &k);
        pairs_run(batch, 4);
        const pair_side *a = pairs_a(batch, 0), *b = pairs_b(batch, 0);
        const double distance = (double)plumb_convex_distance(&a->shape.convex, transform_of(a),
                                                              &b->shape.convex, transform_of(b))
                                    .distance;
        pl_manifold m = { .count = 0 };
        if (!pairs_manifold(batch, 0, &m)) {
            continue;
        }
        double deepest = INFINITY;
        for (uint32_t j = 0; j < m.count; ++j) {
            deepest = fmin(deepest, (double)m.point[j].separation);
        }
        ++met;
        wrong += deepest < distance - 5e-4 - slack();
    }
    pairs_destroy(batch);
    assert_true(met > 5000);
    assert_int_equal(wrong, 0);
}

// A heap of polygons, capsules and circles thrown together, one shape a body.
static plumb_world *heap_of_shapes(void)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    plumb_material m = sim_material(w, 0.5, 0);
    sim_floor(w, m);
    unsigned seed = 77;
    for (int i = 0; i < 120; ++i) {
        plumb_body b = sim_body(w, PLUMB_DYNAMIC, sim_uniform(&seed, -4, 4),
                                1 + sim_uniform(&seed, 0, 12), sim_uniform(&seed, -3, 3));
        plumb_vec2 corners[7];
        int count = 3 + i % 5;
        for (int k = 0; k < count; ++k) {
            double angle = 2 * SIM_PI * k / count, r = sim_uniform(&seed, 0.3, 0.4);
            corners[k] = sim_vec(r * cos(angle), r * sin(angle));
        }
        plumb_shape_desc desc = { .kind = i % 7 == 0 ? PLUMB_CAPSULE : PLUMB_POLYGON,
                                  .points = corners,
                                  .count = i % 7 == 0 ? 2 : count,
                                  .radius = (plumb_real)(i % 7 == 0 ? 0.2 : i % 3 * 0.05),
                                  .material = m };
        plumb_shape s = plumb_shape_create(w, b, &desc);
        assert_true(plumb_shape_valid(w, s));
    }
    return w;
}

static void remembered_face_changes_nothing(void **state)
{
    (void)state;
    plumb_world *with = heap_of_shapes(), *without = heap_of_shapes();
    uint32_t dismissed = 0;
    for (int step = 0; step < 300; ++step) {
        sim_step(with, 1 / 60.0);
        pl_pair *pairs = pl_pairs(&without->broad.pairs);
        for (uint32_t i = 0; i < without->broad.pairs.count; ++i) {
            dismissed += (pairs[i].flags & PL_PAIR_FACE_MASK) != 0 ? 1 : 0;
            pairs[i].flags &= ~PL_PAIR_FACE_MASK;
        }
        sim_step(without, 1 / 60.0);
        plumb_body_span p = plumb_world_bodies(with), q = plumb_world_bodies(without);
        size_t bytes = (size_t)p.dynamic_count * sizeof(plumb_real);
        assert_memory_equal(p.center_x, q.center_x, bytes);
        assert_memory_equal(p.center_y, q.center_y, bytes);
        assert_memory_equal(p.w, q.w, bytes);
    }
    assert_true(dismissed > 1000); // pairs that were apart
    plumb_world_destroy(with);
    plumb_world_destroy(without);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kernels_find_known_contacts),
        cmocka_unit_test(coincident_shapes_get_some_contact),
        cmocka_unit_test(features_stay_and_carry_impulses),
        cmocka_unit_test(widths_agree_bit_for_bit),
        cmocka_unit_test(nothing_in_line_is_struck_in_thin_air),
        cmocka_unit_test(remembered_face_changes_nothing),
    };
    return cmocka_run_group_tests_name("narrow", tests, NULL, NULL);
}
