// test_libccd.c - the narrow phase against libccd and a brute-force arbiter, over random and
// degenerate pairs of every combination of kinds, at every width.
//
// Three opinions on each pair: Plumb's manifold; libccd, in double, on prisms much longer than the
// shapes are wide; the arbiter (arbiter.h). Whether the two overlap is voted on by all three. For
// the depth libccd gives a bracket: EPA measures a polytope inside the difference of the shapes, so
// its depth is at most the true one, and MPR's is a way out that need not be the shortest, so at
// least that.
//
// Plumb must side with the arbiter. libccd may be outvoted by both: it is known to give NaN or
// depth 0 on exactly aligned faces and to run in circles, so its iterations are limited and its
// failures counted.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <ccd/ccd.h>
#include <cmocka.h>

#include "crossval/arbiter.h"
#include "harness/sim.h"

enum { PAIRS_A_KIND = 12000, LISTED = 3 };

// [m] Plumb changes the reference face only for a gain of this much (see the kernels), so that its
// normal may be that much worse than the best.
#define FLICKER 5e-4

// [m] float: a few roundings of coordinates of up to 8 m.
#define ROUNDING 4e-6

//---- shapes --------------------------------------------------------------------------------------

typedef enum shape_class {
    CIRCLE,
    CAPSULE,
    SEGMENT,
    BOX,
    ROUNDED_BOX,
    POLYGON,
    ROUNDED,
    CLASSES
} shape_class;

static const char *const class_names[CLASSES] = { "circle",      "capsule", "segment",        "box",
                                                  "rounded box", "polygon", "rounded polygon" };

static pair_shape random_polygon(unsigned *seed, double r)
{
    plumb_vec2 p[PLUMB_POLYGON_MAX_VERTICES];
    int count = 3 + (int)(sim_random(seed) % 14);
    double flat = sim_random(seed) % 3 == 0 ? 0.15 : sim_uniform(seed, 0.5, 1);
    double size = sim_uniform(seed, 0.2, 1.5);
    for (int i = 0; i < count; ++i) {
        // One corner in each sector of an ellipse, so that the hull keeps most of them.
        double at = (i + sim_uniform(seed, 0.2, 0.8)) * 2 * SIM_PI / count;
        p[i] = sim_vec(size * cos(at), size * flat * sin(at));
    }
    return pair_polygon(p, count, r);
}

// Regular, with exactly repeated extents and parallel sides.
static pair_shape regular_polygon(unsigned *seed, double r)
{
    plumb_vec2 p[PLUMB_POLYGON_MAX_VERTICES];
    int count = 3 + (int)(sim_random(seed) % 14);
    for (int i = 0; i < count; ++i) {
        p[i] = sim_vec(cos(i * 2 * SIM_PI / count), sin(i * 2 * SIM_PI / count));
    }
    return pair_polygon(p, count, r);
}

// A polygon that is a box would be stored as one, and go to another kernel.
static pair_shape some_polygon(unsigned *seed, bool tidy, double r)
{
    pair_shape s;
    do {
        s = tidy ? regular_polygon(seed, r) : random_polygon(seed, r);
    } while (s.kind != PL_PIECE_POLYGON);
    return s;
}

static pair_shape random_shape(unsigned *seed, shape_class kind, bool tidy)
{
    // Tidy ones have sizes of quarters, which meet exactly.
    double u = tidy ? 0.25 * (1 + sim_random(seed) % 4) : sim_uniform(seed, 0.05, 1.5);
    double v = tidy ? 0.25 * (1 + sim_random(seed) % 4) : sim_uniform(seed, 0.05, 1.5);
    double r = tidy ? 0.125 : sim_uniform(seed, 0.01, 0.3);
    switch (kind) {
    case CIRCLE:
        return pair_circle(u);
    case CAPSULE:
        return pair_capsule(u, r);
    case SEGMENT:
        return pair_capsule(u, 0);
    case BOX:
        return pair_box(u, v, 0);
    case ROUNDED_BOX:
        return pair_box(u, v, r);
    case POLYGON:
        return some_polygon(seed, tidy, 0);
    default:
        return some_polygon(seed, tidy, r);
    }
}

static double size_of(const pair_shape *s)
{
    return (double)s->core.reach;
}

// Poses: mostly at random within reach; every fourth pair on a lattice of quarters with right
// angles: aligned, touching exactly, inside one another, identical, concentric.
static void add_random(pair_batch *batch, unsigned *seed, shape_class p, shape_class q)
{
    bool tidy = sim_random(seed) % 4 == 0;
    pair_shape a = random_shape(seed, p, tidy), b = random_shape(seed, q, tidy);
    if (tidy && p == q && sim_random(seed) % 4 == 0) {
        b = a;
    }
    pair_pose at_a = { 0 }, at_b = { 0 };
    if (tidy) {
        at_a.angle = sim_random(seed) % 4 * SIM_PI / 2;
        at_b.angle = sim_random(seed) % 4 * SIM_PI / 2;
        at_b.x = 0.25 * (int)(sim_random(seed) % 9) - 1;
        at_b.y = 0.25 * (int)(sim_random(seed) % 9) - 1;
        // Whole metres far away are exact in float.
        at_a.x += 64, at_b.x += 64;
    } else {
        double far = (size_of(&a) + size_of(&b)) * sqrt(sim_uniform(seed, 0, 1.1));
        double to = sim_uniform(seed, 0, 2 * SIM_PI);
        at_a.angle = sim_uniform(seed, -4, 4), at_b.angle = sim_uniform(seed, -4, 4);
        at_a.x = sim_uniform(seed, -4, 4), at_a.y = sim_uniform(seed, -4, 4);
        at_b.x = at_a.x + far * cos(to), at_b.y = at_a.y + far * sin(to);
    }
    pairs_add(batch, &a, at_a, &b, at_b);
}

//---- libccd --------------------------------------------------------------------------------------

// [m] half length of the prisms: no way out along z is ever the shortest.
#define PRISM 16.0

static void prism_support(const void *object, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const placed *p = object;
    double x = ccdVec3X(dir), y = ccdVec3Y(dir), best = -INFINITY;
    int at = 0;
    for (int i = 0; i < p->count; ++i) {
        double along = x * p->x[i] + y * p->y[i];
        if (along > best) {
            best = along;
            at = i;
        }
    }
    double length = hypot(x, y), grow = length > 1e-12 ? p->radius / length : 0;
    ccdVec3Set(out, p->x[at] + grow * x, p->y[at] + grow * y, ccdVec3Z(dir) < 0 ? -PRISM : PRISM);
}

typedef struct ccd_verdict {
    bool hit;
    bool measured;    // both depths came out, finite
    double low, high; // [m] of depth
} ccd_verdict;

static void prism_center(const void *object, ccd_vec3_t *out)
{
    const placed *p = object;
    ccdVec3Set(out, p->cx, p->cy, 0);
}

static ccd_verdict ask_ccd(const placed *a, const placed *b)
{
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = prism_support;
    ccd.center1 = ccd.center2 = prism_center;
    ccd.max_iterations = 100;
    ccd.epa_tolerance = ccd.mpr_tolerance = 1e-6;
    ccd_verdict v = { .hit = ccdGJKIntersect(a, b, &ccd) != 0 };
    ccd_vec3_t dir, pos;
    if (v.hit && ccdGJKPenetration(a, b, &ccd, &v.low, &dir, &pos) == 0 &&
        ccdMPRPenetration(a, b, &ccd, &v.high, &dir, &pos) == 0) {
        v.measured = isfinite(v.low) && isfinite(v.high) && v.low > 0 && v.high > 0;
    }
    return v;
}

//---- the vote ------------------------------------------------------------------------------------

typedef struct tally {
    int pairs, hits, apart, unclear; // of the arbiter
    int wrong_hit;                   // Plumb overlaps or is apart against the arbiter
    int wrong_near;                  // no manifold though within reach, or the reverse
    int wrong_depth;                 // its separation is not that of the arbiter along its normal
    int wrong_normal;                // another one shows less overlap, or it is no unit vector
    int wrong_point;                 // a point is not on both surfaces
    int ccd_hit, ccd_depth, ccd_unmeasured;        // libccd against both
    int bracketed;                                 // libccd's depths within 0.1 % of one another
    int both_against_arbiter;                      // Plumb and libccd agree, the arbiter does not
    double worst_depth, worst_normal, worst_point; // [-] over the band
} tally;

static void list(int *counter, const char *what, const char *p, const char *q, int i, double got,
                 double expected)
{
    if (++*counter <= LISTED) {
        print_message("  %s: %s / %s, pair %d: %.9g, the arbiter has %.9g\n", what, p, q, i, got,
                      expected);
    }
}

static double deepest(const pl_manifold *m)
{
    double s = (double)m->point[0].separation;
    return m->count > 1 ? fmin(s, (double)m->point[1].separation) : s;
}

// [m] How much a normal that float can tell may miss: two cores that nearly touch, d apart, define
// their direction by numbers of the size of the rounding, and the shapes reach `size` to its sides.
static double blur(double core_gap, double size)
{
    double d = fmax(fabs(core_gap), 1e-6);
    return ROUNDING + 0.1 * ROUNDING * size / d;
}

// Normal, separation and points of one manifold against the arbiter's shapes.
static void judge_manifold(tally *t, const pair_batch *batch, int i, const pl_manifold *m,
                           const placed *a, const placed *b, double separation, const char *p,
                           const char *q)
{
    double nx = (double)m->nx, ny = (double)m->ny, length = hypot(nx, ny);
    double depth = deepest(m);
    double beyond = arbiter_beyond(a, b, nx / length, ny / length);
    // The deepest point tells how far B reaches into A along the normal, and no other normal
    // shows much less overlap.
    double off = fabs(depth - beyond);
    double size = size_of(&pairs_a(batch, i)->shape) + size_of(&pairs_b(batch, i)->shape);
    bool parted = separation + a->radius + b->radius > 0; // the cores are
    double band = FLICKER + (parted ? blur(separation + a->radius + b->radius, size) : ROUNDING);
    t->worst_depth = fmax(t->worst_depth, off / band);
    if (!(off <= band)) {
        list(&t->wrong_depth, "separation along the normal", p, q, i, depth, beyond);
    }
    double worse = separation - beyond;
    t->worst_normal = fmax(t->worst_normal, worse / band);
    if (!(fabs(length - 1) <= 1e-5) || !(worse <= band)) {
        list(&t->wrong_normal, "normal, by its separation", p, q, i, beyond, separation);
    }
    for (uint32_t k = 0; k < m->count; ++k) {
        const pl_manifold_point *at = &m->point[k];
        const pl_pose *pa = &pairs_a(batch, i)->pose, *pb = &pairs_b(batch, i)->pose;
        double gap = (double)at->separation;
        double ax = (double)pa->x + (double)at->ax, ay = (double)pa->y + (double)at->ay;
        double bx = (double)pb->x + (double)at->bx, by = (double)pb->y + (double)at->by;
        // On rounded shapes that meet at an angle, the less deep point lies below the surface: the
        // rounding is counted along the normal. Never above, and the deepest one is on both.
        double above_a = arbiter_distance(a, ax, ay), above_b = arbiter_distance(b, bx, by);
        if (gap > depth && a->radius + b->radius > 0) {
            above_a = fmax(above_a, 0), above_b = fmax(above_b, 0);
        }
        double across = hypot(bx - ax - gap * nx, by - ay - gap * ny);
        double apart = fmax(fmax(fabs(above_a), fabs(above_b)), across);
        t->worst_point = fmax(t->worst_point, apart / band);
        if (!(apart <= band)) {
            list(&t->wrong_point, "point off a surface by", p, q, i, apart, 0);
        }
    }
}

static void judge(tally *t, const pair_batch *batch, int i, const char *p, const char *q)
{
    placed a = arbiter_place(pairs_a(batch, i)), b = arbiter_place(pairs_b(batch, i));
    double nx, ny;
    double separation = arbiter_separation(&a, &b, &nx, &ny);
    pl_manifold m;
    bool met = pairs_manifold(batch, i, &m);
    ccd_verdict ccd = ask_ccd(&a, &b);
    bool overlap = met && deepest(&m) < 0, arbiter = separation < 0;
    bool clear = fabs(separation) > ROUNDING;

    ++t->pairs;
    t->hits += arbiter && clear, t->apart += !arbiter && clear, t->unclear += !clear;
    if (clear && overlap != arbiter) {
        list(&t->wrong_hit, "overlap", p, q, i, met ? deepest(&m) : INFINITY, separation);
        t->both_against_arbiter += ccd.hit == overlap;
    }
    double reach = (double)PL_SPECULATIVE;
    if (met != (separation < reach) && fabs(separation - reach) > FLICKER) {
        list(&t->wrong_near, "nearness", p, q, i, met ? deepest(&m) : INFINITY, separation);
    }
    if (met) {
        judge_manifold(t, batch, i, &m, &a, &b, separation, p, q);
    }
    t->ccd_hit += clear && ccd.hit != arbiter;
    if (clear && arbiter && ccd.hit) {
        double slack = 1e-4 * (1 - separation);
        bool inside = ccd.low <= slack - separation && ccd.high >= -separation - slack;
        t->ccd_unmeasured += !ccd.measured;
        t->ccd_depth += ccd.measured && !inside;
        t->bracketed += ccd.measured && inside && ccd.high - ccd.low <= 1e-3 * ccd.high;
    }
}

// All widths must write the same bits.
static void run_all_widths(pair_batch *batch)
{
    static unsigned char reference[(PAIRS_A_KIND + 1) * sizeof(pl_manifold)];
    size_t reference_size = 0;
    const int widths[] = { 16, 8, 4 };
    bool first = true;
    for (int k = 0; k < 3; ++k) {
        if (!pairs_width_runs(widths[k])) {
            continue;
        }
        pairs_run(batch, widths[k]);
        size_t size;
        const void *output = pairs_output(batch, &size);
        if (first) {
            assert_true(size <= sizeof reference);
            memcpy(reference, output, reference_size = size);
            first = false;
        }
        assert_int_equal(size, reference_size);
        assert_memory_equal(output, reference, size);
    }
}

static void add_up(tally *sum, const tally *t)
{
    sum->pairs += t->pairs, sum->hits += t->hits;
    sum->wrong_hit += t->wrong_hit, sum->wrong_near += t->wrong_near;
    sum->wrong_depth += t->wrong_depth, sum->wrong_normal += t->wrong_normal;
    sum->wrong_point += t->wrong_point, sum->ccd_hit += t->ccd_hit;
    sum->ccd_depth += t->ccd_depth, sum->ccd_unmeasured += t->ccd_unmeasured;
    sum->bracketed += t->bracketed, sum->both_against_arbiter += t->both_against_arbiter;
}

static void three_opinions(void **state)
{
    (void)state;
    pair_batch *batch = pairs_create(PAIRS_A_KIND);
    unsigned seed = 20240607;
    tally sum = { 0 };
    for (int p = 0; p < CLASSES; ++p) {
        for (int q = p; q < CLASSES; ++q) {
            tally t = { 0 };
            pairs_clear(batch);
            for (int i = 0; i < PAIRS_A_KIND / 2; ++i) {
                add_random(batch, &seed, (shape_class)p, (shape_class)q);
            }
            run_all_widths(batch);
            for (int i = 0; i < pairs_count(batch); ++i) {
                judge(&t, batch, i, class_names[p], class_names[q]);
            }
            print_message(
                "%-15s / %-15s %4d in, %4d out, %3d on the line; wrong: %d hits, %d near, "
                "%d depths (%.2g), %d normals (%.2g), %d points (%.2g); libccd: %d hits, "
                "%d depths, %d none, %d tight\n",
                class_names[p], class_names[q], t.hits, t.apart, t.unclear, t.wrong_hit,
                t.wrong_near, t.wrong_depth, t.worst_depth, t.wrong_normal, t.worst_normal,
                t.wrong_point, t.worst_point, t.ccd_hit, t.ccd_depth, t.ccd_unmeasured,
                t.bracketed);
            add_up(&sum, &t);
        }
    }
    pairs_destroy(batch);
    print_message(
        "%d pairs, %d overlapping: Plumb wrong in %d hits, %d near, %d depths, %d normals, "
        "%d points; libccd wrong in %d hits and %d depths, none for %d, confirms %d; "
        "Plumb and libccd against the arbiter: %d\n",
        sum.pairs, sum.hits, sum.wrong_hit, sum.wrong_near, sum.wrong_depth, sum.wrong_normal,
        sum.wrong_point, sum.ccd_hit, sum.ccd_depth, sum.ccd_unmeasured, sum.bracketed,
        sum.both_against_arbiter);
    assert_true(sum.pairs >= 100000);
    assert_int_equal(sum.wrong_hit, 0);
    assert_int_equal(sum.both_against_arbiter, 0);
    // Rounded shapes near the change from two flat faces to two corners may be a millimetre off.
    int rare = sum.pairs / 20000;
    assert_true(sum.wrong_near <= rare && sum.wrong_depth <= rare);
    assert_true(sum.wrong_normal <= rare && sum.wrong_point <= rare);
    // The vote is worth something only where libccd mostly agrees.
    assert_true(sum.ccd_hit <= sum.pairs / 1000);
    assert_true(sum.ccd_depth <= sum.hits / 100);
    assert_true(sum.bracketed >= sum.hits / 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(three_opinions),
    };
    return cmocka_run_group_tests_name("libccd", tests, NULL, NULL);
}
