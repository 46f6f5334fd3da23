// test_query.c - every query against brute force over all pieces, bit for bit: the grid may leave
// out only what cannot answer. The test of two convex shapes against an independent distance.

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/random.h"
#include "plumb/plumb.h"
#include "query/overlap.h"
#include "query/query.h"

#define DT       ((plumb_real)(1.0 / 60))
#define MOST     400
#define R(x)     ((plumb_real)(x))
#define V(x, y)  plumb_v2(R(x), R(y))
#define NO_SHAPE ((plumb_shape)PLUMB_NULL_INIT)

static void near_at(double a, double b, double tolerance, int line)
{
    if (!(fabs(a - b) <= tolerance)) {
        fail_msg("line %d: %.17g is not %.17g within %g", line, a, b, tolerance);
    }
}
#define NEAR(a, b, tolerance) near_at((double)(a), (double)(b), tolerance, __LINE__)

static uint32_t random_state;

static double uniform(double low, double high)
{
    return sim_uniform(&random_state, low, high);
}

static double spread(double low, double high)
{
    return exp(uniform(log(low), log(high)));
}

static plumb_vec2 place(double reach)
{
    return V(uniform(-reach, reach), uniform(-reach, reach));
}

//---- worlds --------------------------------------------------------------------------------------

static plumb_world *make_world(uint32_t seed)
{
    random_state = seed * 2654435761u + 1;
    plumb_world *world = NULL;
    assert_int_equal(plumb_world_create(&(plumb_world_desc){ .zero_gravity = true }, &world),
                     PLUMB_OK);
    return world;
}

static plumb_shape add_shape(plumb_world *world, plumb_body body, int kind, double size)
{
    const double star[][2] = {
        { -1, -1 }, { 0, -0.4 }, { 1, -1 }, { 0.9, 1 }, { 0, 0.3 }, { -1, 1 }
    };
    plumb_vec2 points[6];
    for (int i = 0; i < 6; ++i) {
        points[i] = V(size * star[i][0], size * star[i][1]);
    }
    plumb_shape_desc desc = { .kind = (plumb_shape_kind)kind };
    if (kind == PLUMB_CIRCLE || kind == PLUMB_CAPSULE) {
        desc.radius = R(size);
    }
    if (kind == PLUMB_BOX) {
        desc.half = V(size, size / 3);
        desc.angle = R(uniform(-3, 3));
    }
    if ((kind == PLUMB_BOX || kind == PLUMB_POLYGON) && uniform(0, 1) < 0.5) {
        desc.radius = R(size / 5);
    }
    if (kind == PLUMB_POLYGON || kind == PLUMB_OUTLINE || kind == PLUMB_CHAIN) {
        desc.points = points;
        desc.count = 6;
        desc.closed = kind == PLUMB_CHAIN && uniform(0, 1) < 0.5;
    }
    if (kind == PLUMB_CAPSULE || kind == PLUMB_SEGMENT) {
        desc.points = points;
        desc.count = 2;
    }
    plumb_shape shape = plumb_shape_create(world, body, &desc);
    assert_true(plumb_shape_valid(world, shape));
    return shape;
}

static plumb_body add_body(plumb_world *world, plumb_body_type type, plumb_vec2 at, double angle)
{
    plumb_body_desc desc = { .type = type, .position = at, .angle = R(angle) };
    if (type != PLUMB_STATIC) {
        desc.velocity = place(3);
    }
    plumb_body body = plumb_body_create(world, &desc);
    assert_true(plumb_body_valid(world, body));
    return body;
}

static plumb_body add_random(plumb_world *world, double reach, double least, double most)
{
    const plumb_body_type types[] = { PLUMB_DYNAMIC, PLUMB_DYNAMIC, PLUMB_KINEMATIC, PLUMB_STATIC };
    plumb_body body = add_body(world, types[(int)uniform(0, 3.999)], place(reach), uniform(-4, 4));
    int shapes = uniform(0, 1) < 0.8 ? 1 : (int)uniform(0, 3.999);
    for (int i = 0; i < shapes; ++i) {
        add_shape(world, body, (int)uniform(0, 6.999), spread(least, most));
    }
    return body;
}

static plumb_world *random_world(uint32_t seed, int count, double reach, double least, double most)
{
    plumb_world *world = make_world(seed);
    for (int i = 0; i < count; ++i) {
        add_random(world, reach, least, most);
    }
    return world;
}

//---- brute force ---------------------------------------------------------------------------------

static plumb_transform frame_of(const plumb_world *world, uint32_t piece)
{
    return plumb_body_transform(world, plumb_shape_body(world, world->pieces.shape[piece]));
}

static bool seen(const plumb_world *world, uint32_t piece, const plumb_query_filter *f)
{
    if (world->pieces.kind[piece] == PL_PIECE_FREE) {
        return false;
    }
    if (f == NULL) {
        return true;
    }
    plumb_shape shape = world->pieces.shape[piece];
    plumb_body body = plumb_shape_body(world, shape);
    bool is_static = plumb_body_get_type(world, body) == PLUMB_STATIC;
    return !plumb_same(body, f->ignore_body) && !(f->ignore_static && is_static) &&
           !(f->ignore_dynamic && !is_static) &&
           (f->accept == NULL || f->accept(f->context, shape));
}

static bool ray_piece(const plumb_world *world, uint32_t piece, plumb_vec2 from, plumb_vec2 to,
                      plumb_ray_hit *hit)
{
    plumb_convex convex;
    plumb_convex_hit local;
    plumb_transform t = frame_of(world, piece);
    pl_query_convex(world, piece, &convex);
    if (!plumb_convex_ray(&convex, plumb_transform_inv_apply(t, from),
                          plumb_rot_inv_apply(t.q, plumb_vec2_sub(to, from)), &local)) {
        return false;
    }
    bool inside = local.normal.x == 0 && local.normal.y == 0;
    hit->shape = world->pieces.shape[piece];
    hit->body = plumb_shape_body(world, hit->shape);
    hit->fraction = local.fraction;
    hit->point = inside ? from : plumb_transform_apply(t, local.point);
    hit->normal = plumb_rot_apply(t.q, local.normal);
    return true;
}

static int compare_hits(const void *a, const void *b)
{
    const plumb_ray_hit *p = a, *q = b;
    if (p->fraction != q->fraction) {
        return p->fraction < q->fraction ? -1 : 1;
    }
    return p->shape.index < q->shape.index ? -1 : p->shape.index > q->shape.index;
}

// All hits in order, one for each shape.
static int brute_ray(const plumb_world *world, plumb_vec2 from, plumb_vec2 to,
                     const plumb_query_filter *f, plumb_ray_hit *hits)
{
    int count = 0;
    for (uint32_t p = 0; p < world->pieces.table.count; ++p) {
        plumb_ray_hit hit;
        if (!seen(world, p, f) || !ray_piece(world, p, from, to, &hit)) {
            continue;
        }
        int k = 0;
        while (k < count && !plumb_same(hits[k].shape, hit.shape)) {
            ++k;
        }
        if (k == count || hit.fraction < hits[k].fraction) {
            hits[k] = hit;
            count += k == count;
        }
    }
    qsort(hits, (size_t)count, sizeof *hits, compare_hits);
    return count;
}

typedef struct shape_set {
    plumb_shape items[8 * MOST];
    int count;
} shape_set;

static int compare_shapes(const void *a, const void *b)
{
    const plumb_shape *p = a, *q = b;
    return p->index < q->index ? -1 : p->index > q->index;
}

static void include(shape_set *set, plumb_shape shape)
{
    for (int i = 0; i < set->count; ++i) {
        if (plumb_same(set->items[i], shape)) {
            return;
        }
    }
    set->items[set->count++] = shape;
}

static void check_set(shape_set *expected, const plumb_shape *shapes, int count)
{
    qsort(expected->items, (size_t)expected->count, sizeof *expected->items, compare_shapes);
    assert_int_equal(count, expected->count);
    assert_memory_equal(shapes, expected->items, (size_t)count * sizeof *shapes);
}

// Hits of a shape's pieces may tie: any of its normals is right then.
static void check_hit(const plumb_ray_hit *hit, const plumb_ray_hit *expected)
{
    assert_true(hit->fraction == expected->fraction);
    assert_true(plumb_same(hit->shape, expected->shape));
    assert_true(plumb_same(hit->body, expected->body));
    plumb_real size = plumb_abs(hit->point.x) + plumb_abs(hit->point.y) + 1;
    assert_true(plumb_vec2_distance(hit->point, expected->point) <=
                1000 * PLUMB_REAL_EPSILON * size);
}

static int check_ray(plumb_world *world, plumb_vec2 from, plumb_vec2 to,
                     const plumb_query_filter *f)
{
    static plumb_ray_hit expected[8 * MOST], hits[8 * MOST];
    int count = brute_ray(world, from, to, f, expected);
    plumb_ray_hit hit;
    memset(&hit, 77, sizeof hit);
    plumb_ray_hit untouched = hit;
    bool met = plumb_world_ray(world, from, to, f, &hit);
    if (met != (count > 0)) {
        fail_msg("ray (%.9g %.9g) to (%.9g %.9g): met %d, expected %d", (double)from.x,
                 (double)from.y, (double)to.x, (double)to.y, met, count);
    }
    if (met) {
        check_hit(&hit, &expected[0]);
    } else {
        assert_memory_equal(&hit, &untouched, sizeof hit);
    }
    assert_int_equal(plumb_world_ray_all(world, from, to, f, hits, 8 * MOST), count);
    for (int i = 0; i < count; ++i) {
        check_hit(&hits[i], &expected[i]);
    }
    return count;
}

static void check_point(plumb_world *world, plumb_vec2 point, const plumb_query_filter *f)
{
    static shape_set expected;
    plumb_shape shapes[8 * MOST];
    expected.count = 0;
    for (uint32_t p = 0; p < world->pieces.table.count; ++p) {
        plumb_convex convex;
        if (seen(world, p, f)) {
            pl_query_convex(world, p, &convex);
            plumb_vec2 local = plumb_transform_inv_apply(frame_of(world, p), point);
            if (plumb_convex_contains(&convex, local)) {
                include(&expected, world->pieces.shape[p]);
            }
        }
    }
    int count = plumb_world_overlap_point(world, point, f, shapes, 8 * MOST);
    check_set(&expected, shapes, count);
}

static int check_aabb(plumb_world *world, plumb_aabb box, const plumb_query_filter *f)
{
    static shape_set expected;
    plumb_shape shapes[8 * MOST];
    expected.count = 0;
    for (uint32_t p = 0; p < world->pieces.table.count; ++p) {
        if (seen(world, p, f)) {
            plumb_convex convex;
            pl_piece_convex(world, p, &convex);
            pl_box t = pl_piece_tight_box(world, p);
            plumb_aabb tight = { { t.min_x, t.min_y }, { t.max_x, t.max_y } };
            if (plumb_aabb_overlap(tight, box)) {
                include(&expected, world->pieces.shape[p]);
            }
        }
    }
    int count = plumb_world_overlap_aabb(world, box, f, shapes, 8 * MOST);
    check_set(&expected, shapes, count);
    return count;
}

//---- distance of two cores, by another way -------------------------------------------------------

typedef struct spot {
    double x, y;
} spot;

#define BAND 1e-11 // [m] nearer than this nothing is claimed

// How far c lies to the left of the line from a to b.
static double left_of(spot a, spot b, spot c)
{
    double length = hypot(b.x - a.x, b.y - a.y);
    double turn = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    return length > 0 ? turn / length : 0;
}

static bool surely_crosses(spot a, spot b, spot c, spot d)
{
    double u = left_of(a, b, c), v = left_of(a, b, d), w = left_of(c, d, a), z = left_of(c, d, b);
    return u * v < 0 && w * z < 0 && fmin(fmin(fabs(u), fabs(v)), fmin(fabs(w), fabs(z))) > BAND;
}

static bool surely_contains(const plumb_convex *c, const spot *at, spot p)
{
    for (int i = 0; i < c->count; ++i) {
        if (left_of(at[i], at[(i + 1) % c->count], p) <= BAND) {
            return false;
        }
    }
    return c->count > 2;
}

static double to_edge(spot a, spot b, spot p)
{
    double dx = b.x - a.x, dy = b.y - a.y;
    double length_sq = dx * dx + dy * dy;
    double t = length_sq > 0 ? ((p.x - a.x) * dx + (p.y - a.y) * dy) / length_sq : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

// Distance from ends to edges; -1 when edges cross or one core is in the other.
static double core_distance(const plumb_convex *a, plumb_transform ta, const plumb_convex *b,
                            plumb_transform tb)
{
    spot at[2][PLUMB_POLYGON_MAX_VERTICES];
    const plumb_convex *shapes[2] = { a, b };
    plumb_transform t[2] = { ta, tb };
    for (int k = 0; k < 2; ++k) {
        for (int i = 0; i < shapes[k]->count; ++i) {
            double x = (double)shapes[k]->points[i].x, y = (double)shapes[k]->points[i].y;
            double c = (double)t[k].q.c, s = (double)t[k].q.s;
            at[k][i] = (spot){ c * x - s * y + ((double)t[k].p.x - (double)ta.p.x),
                               s * x + c * y + ((double)t[k].p.y - (double)ta.p.y) };
        }
    }
    if (surely_contains(a, at[0], at[1][0]) || surely_contains(b, at[1], at[0][0])) {
        return -1;
    }
    double nearest = HUGE_VAL;
    for (int i = 0; i < a->count; ++i) {
        spot p = at[0][i], q = at[0][(i + 1) % a->count];
        for (int k = 0; k < b->count; ++k) {
            spot u = at[1][k], v = at[1][(k + 1) % b->count];
            if (surely_crosses(p, q, u, v)) {
                return -1;
            }
            nearest = fmin(nearest, fmin(to_edge(p, q, u), to_edge(u, v, p)));
        }
    }
    return nearest;
}

// 1: overlap, -1: apart, 0: too close to tell.
static int expect_overlap(const plumb_convex *a, plumb_transform ta, const plumb_convex *b,
                          plumb_transform tb)
{
    double reach = (double)a->radius + (double)b->radius;
    double distance = core_distance(a, ta, b, tb);
    return distance < reach - BAND ? 1 : distance > reach + BAND ? -1 : 0;
}

static plumb_convex random_convex(double size)
{
    plumb_convex c;
    plumb_vec2 points[12];
    int corners = (int)uniform(3, 12.999);
    for (int i = 0; i < 12; ++i) {
        points[i] = place(size);
    }
    plumb_real round = uniform(0, 1) < 0.5 ? 0 : R(size * uniform(0.01, 1));
    plumb_result r = PLUMB_E_GEOMETRY;
    switch ((int)uniform(0, 4.999)) {
    case 0:
        r = plumb_convex_circle(points[0], R(size), &c);
        break;
    case 1:
        r = plumb_convex_segment(points[0], points[1], &c);
        break;
    case 2:
        r = plumb_convex_capsule(points[0], points[1], R(size / 3), &c);
        break;
    case 3:
        r = plumb_convex_box(V(size, size / 4), points[0], R(uniform(-4, 4)), round, &c);
        break;
    default:
        r = plumb_convex_polygon(points, corners, round, &c);
        break;
    }
    if (r != PLUMB_OK) {
        assert_int_equal(plumb_convex_circle(points[0], R(size), &c), PLUMB_OK);
    }
    return c;
}

static int check_convex(plumb_world *world, const plumb_convex *convex, plumb_transform t,
                        const plumb_query_filter *f)
{
    plumb_shape shapes[8 * MOST];
    int count = plumb_world_overlap_convex(world, convex, t, f, shapes, 8 * MOST);
    for (int i = 1; i < count; ++i) {
        assert_true(shapes[i - 1].index < shapes[i].index);
    }
    static shape_set surely, maybe;
    surely.count = maybe.count = 0;
    for (uint32_t p = 0; p < world->pieces.table.count; ++p) {
        if (seen(world, p, f)) {
            plumb_convex piece;
            pl_query_convex(world, p, &piece);
            int expected = expect_overlap(convex, t, &piece, frame_of(world, p));
            if (expected == 1) {
                include(&surely, world->pieces.shape[p]);
            }
            if (expected >= 0) {
                include(&maybe, world->pieces.shape[p]);
            }
        }
    }
    for (int i = 0; i < count; ++i) {
        int before = maybe.count;
        include(&maybe, shapes[i]);
        assert_int_equal(maybe.count, before);
        include(&surely, shapes[i]);
    }
    assert_int_equal(surely.count, count); // all that should be were there
    return count;
}

//---- nearest -------------------------------------------------------------------------------------

// Outlines apart (see test_outline), the nearest piece is the nearest shape.
static bool brute_nearest(const plumb_world *world, plumb_vec2 point, plumb_real most,
                          const plumb_query_filter *f, plumb_nearest_hit *hit)
{
    bool met = false;
    for (uint32_t p = 0; p < world->pieces.table.count; ++p) {
        if (!seen(world, p, f)) {
            continue;
        }
        plumb_convex convex;
        plumb_transform t = frame_of(world, p);
        pl_query_convex(world, p, &convex);
        plumb_convex_near near = plumb_convex_nearest(&convex, plumb_transform_inv_apply(t, point));
        plumb_shape shape = world->pieces.shape[p];
        bool nearer = !met || near.distance < hit->distance ||
                      (near.distance == hit->distance && shape.index < hit->shape.index);
        if (near.distance <= most && nearer) {
            met = true;
            *hit = (plumb_nearest_hit){ shape, plumb_shape_body(world, shape),
                                        plumb_transform_apply(t, near.point), near.distance };
        }
    }
    return met;
}

static bool check_nearest(plumb_world *world, plumb_vec2 point, plumb_real most,
                          const plumb_query_filter *f)
{
    plumb_nearest_hit expected = { 0 }, hit;
    memset(&hit, 77, sizeof hit);
    plumb_nearest_hit untouched = hit;
    bool should = brute_nearest(world, point, most, f, &expected);
    bool met = plumb_world_nearest(world, point, most, f, &hit);
    assert_int_equal(met, should);
    if (!met) {
        assert_memory_equal(&hit, &untouched, sizeof hit);
        return false;
    }
    assert_true(hit.distance <= most);
    if (expected.distance < 0 || hit.distance < 0) {
        // In an outline the surface is nearer to the outside than the inner cuts say.
        assert_true(hit.distance <= 0 && expected.distance <= 0);
        bool outline = plumb_shape_get_kind(world, hit.shape) == PLUMB_OUTLINE;
        if (outline) {
            assert_true(hit.distance <= expected.distance + R(1e-4) * plumb_abs(hit.distance));
            return true;
        }
    }
    assert_true(hit.distance == expected.distance);
    assert_true(plumb_same(hit.shape, expected.shape) && plumb_same(hit.body, expected.body));
    plumb_real size = plumb_abs(hit.point.x) + plumb_abs(hit.point.y) + 1;
    assert_true(plumb_vec2_distance(hit.point, expected.point) <= 1000 * PLUMB_REAL_EPSILON * size);
    return true;
}

//---- rays ----------------------------------------------------------------------------------------

static int rays_of_all_kinds(plumb_world *world, int count, double reach,
                             const plumb_query_filter *f)
{
    int met = 0;
    for (int i = 0; i < count; ++i) {
        plumb_vec2 from = place(reach), to = place(reach);
        if (i % 7 == 0) {
            to.y = from.y;
        } else if (i % 7 == 1) {
            to.x = from.x;
        } else if (i % 7 == 2) {
            to = from;
        } else if (i % 7 == 3) {
            to = plumb_vec2_add(from, place(0.1 * reach));
        }
        const pl_grid *grid = i % 2 ? &world->broad.moving : &world->broad.fixed;
        if (i % 5 == 0 && grid->level_count > 0) { // along a border of cells
            const pl_grid_level *level = &grid->levels[(uint32_t)i % grid->level_count];
            from.x = R(rint((double)from.x / level->cell) * level->cell);
            to.x = i % 2 ? from.x : to.x;
        }
        met += check_ray(world, from, to, f) > 0;
    }
    return met;
}

static void test_rays(void **state)
{
    (void)state;
    int met = 0;
    for (uint32_t seed = 1; seed <= 8; ++seed) {
        plumb_world *world = random_world(seed, 50 * (int)seed, 3 * sqrt(50.0 * seed), 0.1, 1);
        met += rays_of_all_kinds(world, 600, 4 * sqrt(50.0 * seed), NULL);
        plumb_world_destroy(world);
    }
    assert_true(met > 1000 && met < 8 * 600 - 500);
}

static void test_rays_mixed_sizes(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 5; ++seed) {
        plumb_world *world = make_world(seed + 20);
        for (int i = 0; i < 200; ++i) {
            add_random(world, spread(0.1, 2000), 0.01, 300);
        }
        rays_of_all_kinds(world, 200, 3000, NULL);
        rays_of_all_kinds(world, 200, 1, NULL);
        plumb_world_destroy(world);
    }
}

// What is met is on the surface, and the normal shows out of it.
static void test_ray_hit(void **state)
{
    (void)state;
    plumb_world *world = make_world(1);
    plumb_body ball = add_body(world, PLUMB_DYNAMIC, V(10, 2), 1);
    plumb_shape circle = add_shape(world, ball, PLUMB_CIRCLE, 2);
    plumb_body ground = add_body(world, PLUMB_STATIC, V(0, -5), 0);
    plumb_shape_desc slab = { .kind = PLUMB_BOX, .half = { 50, 1 } };
    plumb_shape floor = plumb_shape_create(world, ground, &slab);
    plumb_ray_hit hit;
    assert_true(plumb_world_ray(world, V(0, 2), V(20, 2), NULL, &hit));
    assert_true(plumb_same(hit.shape, circle) && plumb_same(hit.body, ball));
    NEAR(hit.fraction, 0.4, 1e-6);
    NEAR(hit.point.x, 8, 1e-5);
    NEAR(hit.point.y, 2, 1e-5);
    NEAR(hit.normal.x, -1, 1e-6);
    assert_true(plumb_world_ray(world, V(3, 6), V(3, -14), NULL, &hit));
    assert_true(plumb_same(hit.shape, floor) && plumb_same(hit.body, ground));
    NEAR(hit.fraction, 0.5, 1e-6);
    NEAR(hit.normal.y, 1, 1e-6);
    assert_true(plumb_world_ray(world, V(10.5, 2), V(40, 2), NULL, &hit)); // from inside
    assert_true(plumb_same(hit.shape, circle));
    assert_true(hit.fraction == 0 && hit.normal.x == 0 && hit.normal.y == 0);
    assert_true(hit.point.x == R(10.5) && hit.point.y == 2);
    assert_false(plumb_world_ray(world, V(0, 2), V(7.9, 2), NULL, &hit)); // ends before
    assert_false(plumb_world_ray(world, V(0, 2), V(-20, 2), NULL, &hit)); // shows away
    assert_false(plumb_world_ray(world, V(0, 2), V(0, 2), NULL, &hit));   // goes nowhere
    assert_true(plumb_world_ray(world, V(10, 3), V(10, 3), NULL, &hit));  // inside
    plumb_world_destroy(world);
}

// Equal fractions: the lower slot, whatever the grid and the order of creation in it.
static void test_ray_ties(void **state)
{
    (void)state;
    for (int order = 0; order < 6; ++order) {
        plumb_world *world = make_world(1);
        plumb_shape shapes[3];
        for (int i = 0; i < 3; ++i) {
            plumb_body_type type = (plumb_body_type)((i + order) % 3);
            plumb_body body = add_body(world, type, V(3, 0), 0);
            shapes[i] = add_shape(world, body, PLUMB_CIRCLE, 1);
        }
        plumb_ray_hit hits[3], hit;
        assert_true(plumb_world_ray(world, V(0, 0), V(9, 0), NULL, &hit));
        assert_true(plumb_same(hit.shape, shapes[0]));
        assert_int_equal(plumb_world_ray_all(world, V(0, 0), V(9, 0), NULL, hits, 3), 3);
        for (int i = 0; i < 3; ++i) {
            assert_true(plumb_same(hits[i].shape, shapes[i]));
        }
        plumb_world_destroy(world);
    }
}

// More hits than the caller has room for: the first ones, and how many there are.
static void test_capacity(void **state)
{
    (void)state;
    plumb_world *world = make_world(2);
    plumb_shape made[100];
    for (int i = 0; i < 100; ++i) {
        plumb_body body = add_body(world, (plumb_body_type)(i % 3), V(100 - i, 0), 0);
        made[i] = add_shape(world, body, PLUMB_CIRCLE, 0.25);
    }
    size_t bytes = world->memory.bytes;
    plumb_ray_hit hits[101];
    plumb_shape shapes[101];
    plumb_aabb all = { { -1, -1 }, { 101, 1 } };
    for (int room = 0; room <= 101; room += room < 3 ? 1 : 49) {
        memset(hits, 77, sizeof hits);
        memset(shapes, 77, sizeof shapes);
        assert_int_equal(plumb_world_ray_all(world, V(0, 0), V(200, 0), NULL, hits, room), 100);
        assert_int_equal(plumb_world_overlap_aabb(world, all, NULL, shapes, room), 100);
        for (int i = 0; i < room && i < 100; ++i) {
            assert_true(plumb_same(hits[i].shape, made[99 - i]));
            assert_true(plumb_same(shapes[i], made[i]));
        }
        if (room < 101) {
            assert_int_equal(hits[room].shape.index, 0x4d4d4d4d);
            assert_int_equal(shapes[room].index, 0x4d4d4d4d);
        }
    }
    assert_int_equal(plumb_world_ray_all(world, V(0, 0), V(200, 0), NULL, NULL, 0), 100);
    assert_true(world->memory.bytes < bytes + 64 * 1024); // the lists are gone; the grids were made
    plumb_world_destroy(world);
}

//---- overlaps, nearest ---------------------------------------------------------------------------

static void overlaps_of_all_kinds(plumb_world *world, int count, double reach, double size,
                                  const plumb_query_filter *f)
{
    for (int i = 0; i < count; ++i) {
        plumb_vec2 at = place(reach);
        plumb_real w = i % 4 == 0 ? 0 : R(size * uniform(0, 2));
        plumb_aabb box = { at, { at.x + w, at.y + R(size * uniform(0, 2)) } };
        check_aabb(world, box, f);
        check_point(world, at, f);
        plumb_convex convex = random_convex(i % 3 == 0 ? 3 * size : size);
        check_convex(world, &convex, plumb_transform_make(at, R(uniform(-4, 4))), f);
        check_nearest(world, at, i % 2 == 0 ? PLUMB_REAL_MAX : R(spread(1e-3, reach)), f);
    }
}

static void test_overlaps(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 6; ++seed) {
        double reach = sqrt(60.0 * seed) * spread(0.5, 4);
        plumb_world *world = random_world(seed + 40, 60 * (int)seed, reach, 0.1, 1);
        overlaps_of_all_kinds(world, 300, 1.2 * reach, 0.5, NULL);
        plumb_aabb all = { { -PLUMB_REAL_MAX, -PLUMB_REAL_MAX },
                           { PLUMB_REAL_MAX, PLUMB_REAL_MAX } };
        assert_int_equal(check_aabb(world, all, NULL), (int)world->shape_count);
        plumb_aabb none = { { 1, 1 }, { -1, -1 } };
        assert_int_equal(plumb_world_overlap_aabb(world, none, NULL, NULL, 0), 0);
        plumb_world_destroy(world);
    }
}

static void test_overlaps_mixed_sizes(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 5; ++seed) {
        plumb_world *world = make_world(seed + 60);
        for (int i = 0; i < 150; ++i) {
            add_random(world, spread(0.1, 2000), 0.01, 300);
        }
        overlaps_of_all_kinds(world, 60, 2500, 100, NULL);
        overlaps_of_all_kinds(world, 60, 2, 0.1, NULL);
        plumb_world_destroy(world);
    }
}

static void test_nearest(void **state)
{
    (void)state;
    plumb_world *world = make_world(3);
    plumb_nearest_hit hit;
    assert_false(plumb_world_nearest(world, V(0, 0), PLUMB_REAL_MAX, NULL, &hit)); // empty
    plumb_body ball = add_body(world, PLUMB_DYNAMIC, V(10, 0), 2);
    plumb_shape circle = add_shape(world, ball, PLUMB_CIRCLE, 2);
    assert_true(plumb_world_nearest(world, V(0, 0), PLUMB_REAL_MAX, NULL, &hit));
    assert_true(plumb_same(hit.shape, circle) && plumb_same(hit.body, ball));
    NEAR(hit.distance, 8, 1e-5);
    NEAR(hit.point.x, 8, 1e-5);
    assert_false(plumb_world_nearest(world, V(0, 0), R(7.99), NULL, &hit));
    assert_true(plumb_world_nearest(world, V(0, 0), R(8.01), NULL, &hit));
    assert_true(plumb_world_nearest(world, V(10, 0.5), R(0.001), NULL, &hit)); // inside
    NEAR(hit.distance, -1.5, 1e-5);
    NEAR(hit.point.y, 2, 1e-5);
    assert_true(plumb_world_nearest(world, V(1e8, 1e8), PLUMB_REAL_MAX, NULL, &hit));
    NEAR((double)hit.distance / 1.414e8, 1, 1e-3);
    // Far more boxes than cells are looked at, and the nearest is in the last.
    for (int i = 0; i < 300; ++i) {
        add_random(world, 3, 0.05, 0.2);
    }
    for (int i = 0; i < 200; ++i) {
        check_nearest(world, place(spread(1, 1e4)), PLUMB_REAL_MAX, NULL);
    }
    plumb_world_destroy(world);
}

// The test of two convex shapes alone, with sizes and distances of all orders.
static void test_rounds(void **state)
{
    (void)state;
    random_state = 99;
    int told[3] = { 0, 0, 0 };
    for (int i = 0; i < 60000; ++i) {
        plumb_convex a = random_convex(spread(1e-2, 10));
        plumb_convex b = random_convex(spread(1e-2, 10));
        double reach = spread(0.1, 10);
        plumb_transform ta = plumb_transform_make(place(reach), R(uniform(-4, 4)));
        plumb_transform tb = plumb_transform_make(place(reach), R(uniform(-4, 4)));
        pl_round ra, rb;
        pl_round_make(&a, ta, ta.p, &ra);
        pl_round_make(&b, tb, ta.p, &rb);
        int expected = expect_overlap(&a, ta, &b, tb);
        bool overlap = pl_rounds_overlap(&ra, &rb);
        assert_true(overlap == pl_rounds_overlap(&rb, &ra));
        if (expected != 0 && overlap != (expected == 1)) {
            fail_msg("case %d: %d corners and %d corners, overlap %d", i, a.count, b.count,
                     overlap);
        }
        ++told[expected + 1];
    }
    assert_true(told[0] > 10000 && told[2] > 10000 && told[1] < 10);
}

// Cases whose answer is exact: touching counts, segments in line, crosses, points on points.
static void test_rounds_exact(void **state)
{
    (void)state;
    const struct {
        double a[5], b[5]; // x, y of both ends (equal: circle), radius
        bool overlap;
    } cases[] = {
        { { 0, 0, 0, 0, 1 }, { 3, 0, 3, 0, 2 }, true },       // circles touch
        { { 0, 0, 0, 0, 1 }, { 3, 0, 3, 0, 1.9375 }, false }, //
        { { 0, 0, 0, 0, 1 }, { 0, 0, 0, 0, 1 }, true },       // the same
        { { 0, 0, 2, 0, 0 }, { 2, 0, 4, 0, 0 }, true },       // end to end
        { { 0, 0, 2, 0, 0 }, { 3, 0, 4, 0, 0 }, false },      // in line
        { { 0, 0, 2, 0, 0 }, { 3, 0, 4, 0, 1 }, true },       //
        { { 0, 0, 2, 0, 0 }, { 1, 0, 4, 0, 0 }, true },       // in line, overlapping
        { { 0, 0, 2, 2, 0 }, { 0, 2, 2, 0, 0 }, true },       // cross
        { { 0, 0, 2, 2, 0 }, { 3, 0, 2, 1, 0 }, false },      // would cross if longer
        { { 0, 0, 4, 0, 0 }, { 2, 0, 2, 3, 0 }, true },       // T
        { { 0, 0, 4, 0, 0 }, { 2, 0.0625, 2, 3, 0 }, false }, //
        { { 0, 0, 4, 0, 1 }, { 1, 3, 3, 3, 2 }, true },       // parallel capsules touch
        { { 0, 0, 4, 0, 1 }, { 1, 3, 3, 3, 1.9375 }, false }, //
        { { 0, 0, 4, 0, 0 }, { 4, 0, 4, 0, 1 }, true },       // circle about an end
        { { 0, 0, 4, 0, 0 }, { 7, 4, 7, 4, 5 }, true },       // 3, 4, 5
        { { 0, 0, 4, 0, 0 }, { 7, 4, 7, 4, 4.9375 }, false }, //
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        pl_round rounds[2];
        for (int k = 0; k < 2; ++k) {
            const double *c = k == 0 ? cases[i].a : cases[i].b;
            plumb_convex convex = { .points = { V(c[0], c[1]), V(c[2], c[3]) }, .radius = R(c[4]) };
            convex.count = c[0] == c[2] && c[1] == c[3] ? 1 : 2;
            pl_round_make(&convex, plumb_transform_identity(), V(0, 0), &rounds[k]);
        }
        if (pl_rounds_overlap(&rounds[0], &rounds[1]) != cases[i].overlap ||
            pl_rounds_overlap(&rounds[1], &rounds[0]) != cases[i].overlap) {
            fail_msg("case %d", (int)i);
        }
    }
}

//---- filters -------------------------------------------------------------------------------------

static bool accept_third(void *context, plumb_shape shape)
{
    int *calls = context;
    ++*calls;
    return shape.index % 3 == 0;
}

static void test_filters(void **state)
{
    (void)state;
    plumb_world *world = random_world(5, 200, 15, 0.2, 1.5);
    plumb_entity bodies[512];
    int calls = 0, count = 0;
    plumb_body_span span = plumb_world_bodies(world);
    for (; count < span.count && count < 512; ++count) {
        bodies[count] = span.entity[count];
    }
    for (int i = 0; i < 64; ++i) {
        plumb_query_filter f = { .ignore_static = i & 1, .ignore_dynamic = (i >> 1) & 1 };
        if (i & 4) {
            f.ignore_body = bodies[(int)uniform(0, count - 0.001)];
        }
        if (i & 8) {
            f.accept = accept_third;
            f.context = &calls;
        }
        rays_of_all_kinds(world, 30, 15, &f);
        overlaps_of_all_kinds(world, 15, 15, 1, &f);
    }
    assert_true(calls > 1000);
    plumb_query_filter neither = { .ignore_static = true, .ignore_dynamic = true };
    plumb_aabb all = { { -99, -99 }, { 99, 99 } };
    assert_int_equal(plumb_world_overlap_aabb(world, all, &neither, NULL, 0), 0);
    plumb_world_destroy(world);
}

typedef struct inner {
    plumb_world *world;
    int asked;
} inner;

// A filter that asks another query, with more hits than fit on the stack.
static bool accept_crowded(void *context, plumb_shape shape)
{
    inner *in = context;
    plumb_shape shapes[64];
    plumb_aabb box = plumb_shape_aabb(in->world, shape);
    ++in->asked;
    return plumb_world_overlap_aabb(in->world, plumb_aabb_expand(box, 9), NULL, shapes, 64) > 40;
}

static void test_nested(void **state)
{
    (void)state;
    plumb_world *world = random_world(6, 250, 12, 0.2, 1);
    inner in = { world, 0 };
    plumb_query_filter f = { .accept = accept_crowded, .context = &in };
    rays_of_all_kinds(world, 50, 12, &f);
    overlaps_of_all_kinds(world, 20, 12, 8, &f);
    assert_true(in.asked > 500);
    plumb_world_destroy(world);
}

//---- changes -------------------------------------------------------------------------------------

static void check_a_few(plumb_world *world, double reach)
{
    rays_of_all_kinds(world, 14, reach, NULL);
    overlaps_of_all_kinds(world, 7, reach, 0.5, NULL);
}

// Queries see shapes where they are now: made, moved and destroyed since the last step or query.
static void test_changes(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 4; ++seed) {
        plumb_world *world = make_world(seed + 80);
        plumb_body bodies[MOST];
        int count = 0;
        for (int round = 0; round < 150; ++round) {
            double dice = uniform(0, 1);
            int chosen = (int)uniform(0, count - 0.001);
            if (count < 20 || dice < 0.3) {
                bodies[count++] = add_random(world, 6, 0.1, 1);
            } else if (dice < 0.45) {
                assert_int_equal(plumb_body_destroy(world, bodies[chosen]), PLUMB_OK);
                bodies[chosen] = bodies[--count];
            } else if (dice < 0.7) {
                plumb_body_teleport(world, bodies[chosen], place(6), R(uniform(-4, 4)));
            } else if (dice < 0.8) {
                add_shape(world, bodies[chosen], (int)uniform(0, 6.999), spread(0.1, 1));
            } else {
                assert_int_equal(plumb_world_step(world, DT), PLUMB_OK);
            }
            check_a_few(world, 7);
        }
        plumb_world_destroy(world);
    }
}

static void test_fast_bodies(void **state)
{
    (void)state;
    plumb_world *world = random_world(7, 150, 20, 0.2, 1);
    plumb_body_span span = plumb_world_bodies(world);
    for (int i = 0; i < span.dynamic_count; ++i) {
        plumb_body_set_velocity(world, span.entity[i], place(500));
    }
    for (int step = 0; step < 30; ++step) {
        assert_int_equal(plumb_world_step(world, DT), PLUMB_OK);
        check_a_few(world, 20 + 10 * step);
    }
    plumb_world_destroy(world);
}

// Looking does not disturb: a world that is asked moves as one that is not, to the last bit.
static void test_motion_is_not_disturbed(void **state)
{
    (void)state;
    plumb_world *worlds[2];
    for (int w = 0; w < 2; ++w) {
        worlds[w] = random_world(8, 150, 7, 0.2, 0.8);
        for (int step = 0; step < 120; ++step) {
            assert_int_equal(plumb_world_step(worlds[w], DT), PLUMB_OK);
            plumb_ray_hit hit;
            plumb_nearest_hit near;
            if (w == 1) {
                plumb_world_ray(worlds[w], V(-9, -9), V(9, 9), NULL, &hit);
                plumb_world_nearest(worlds[w], V(0, 0), 1, NULL, &near);
            }
        }
    }
    plumb_body_span a = plumb_world_bodies(worlds[0]), b = plumb_world_bodies(worlds[1]);
    size_t bytes = (size_t)a.count * sizeof(plumb_real);
    assert_int_equal(a.count, b.count);
    assert_memory_equal(a.x, b.x, bytes);
    assert_memory_equal(a.y, b.y, bytes);
    assert_memory_equal(a.c, b.c, bytes);
    assert_memory_equal(a.vx, b.vx, bytes);
    assert_memory_equal(a.w, b.w, bytes);
    plumb_world_destroy(worlds[0]);
    plumb_world_destroy(worlds[1]);
}

//---- shapes of several pieces --------------------------------------------------------------------

static const plumb_vec2 bowl[] = { { -3, 0 }, { 3, 0 },  { 3, 4 },  { 2, 4 },
                                   { 2, 1 },  { -2, 1 }, { -2, 4 }, { -3, 4 } };

static plumb_real distance_to_bowl(plumb_vec2 local)
{
    plumb_real best = PLUMB_REAL_MAX;
    for (int i = 0; i < 8; ++i) {
        plumb_vec2 a = bowl[i], d = plumb_vec2_sub(bowl[(i + 1) % 8], a);
        plumb_real t = plumb_vec2_dot(plumb_vec2_sub(local, a), d) / plumb_vec2_magnitude_sq(d);
        plumb_vec2 at = plumb_vec2_add_scaled(a, plumb_clamp(t, 0, 1), d);
        best = plumb_min(best, plumb_vec2_distance(at, local));
    }
    return plumb_outline_contains(bowl, 8, local) ? -best : best;
}

// A concave outline behaves as one shape: inner cuts are neither surface nor gap.
static void test_outline(void **state)
{
    (void)state;
    plumb_world *world = make_world(9);
    for (int turned = 0; turned < 20; ++turned) {
        plumb_body body = add_body(world, (plumb_body_type)(turned % 3), place(50), uniform(-4, 4));
        plumb_shape_desc desc = { .kind = PLUMB_OUTLINE, .points = bowl, .count = 8 };
        plumb_shape shape = plumb_shape_create(world, body, &desc);
        assert_true(plumb_shape_piece_count(world, shape) > 1);
        plumb_transform t = plumb_body_transform(world, body);
        for (int i = 0; i < 500; ++i) {
            plumb_vec2 local = V(uniform(-4, 4), uniform(-1, 5));
            plumb_vec2 at = plumb_transform_apply(t, local);
            plumb_nearest_hit near;
            assert_true(plumb_world_nearest(world, at, 99, NULL, &near));
            plumb_real expected = distance_to_bowl(local);
            NEAR(near.distance, expected, 2e-4);
            NEAR(plumb_vec2_distance(near.point, at), plumb_abs(expected), 2e-4);
            plumb_ray_hit hit;
            plumb_vec2 to = plumb_transform_apply(t, V(0, 0.5));
            assert_true(plumb_world_ray(world, at, to, NULL, &hit));
            if (expected > R(0.001)) { // from outside: the surface, facing the ray
                plumb_vec2 met = plumb_transform_inv_apply(t, hit.point);
                NEAR(distance_to_bowl(met), 0, 2e-4);
                assert_true(plumb_vec2_dot(hit.normal, plumb_vec2_sub(to, at)) < 0);
            } else if (expected < R(-0.001)) {
                assert_true(hit.fraction == 0);
            }
        }
        assert_int_equal(plumb_body_destroy(world, body), PLUMB_OK);
    }
    plumb_world_destroy(world);
}

// Points and rays on the inner cuts themselves, where rounding decides which piece they are in.
static void test_inner_cuts(void **state)
{
    (void)state;
    plumb_world *world = make_world(10);
    for (int turned = 0; turned < 50; ++turned) {
        plumb_body body = add_body(world, PLUMB_STATIC, place(30), uniform(-4, 4));
        plumb_shape_desc desc = { .kind = PLUMB_OUTLINE, .points = bowl, .count = 8 };
        plumb_shape shape = plumb_shape_create(world, body, &desc);
        plumb_transform t = plumb_body_transform(world, body);
        for (int piece = 0; piece < plumb_shape_piece_count(world, shape); ++piece) {
            plumb_convex convex;
            uint32_t seams;
            assert_int_equal(plumb_shape_piece(world, shape, piece, &convex, &seams), PLUMB_OK);
            for (int k = 0; k < convex.count; ++k) {
                plumb_vec2 a = convex.points[k], b = convex.points[(k + 1) % convex.count];
                for (int i = 1; i < 40 && (seams >> k & 1u); ++i) {
                    plumb_vec2 local = plumb_vec2_lerp(a, b, R(i / 40.0));
                    plumb_vec2 at = plumb_transform_apply(t, local);
                    plumb_ray_hit hit;
                    plumb_nearest_hit near;
                    assert_int_equal(plumb_world_overlap_point(world, at, NULL, NULL, 0), 1);
                    assert_true(plumb_world_ray(world, at, V(99, 99), NULL, &hit));
                    assert_true(hit.fraction == 0);
                    assert_true(plumb_world_nearest(world, at, 1, NULL, &near));
                    NEAR(near.distance, distance_to_bowl(local), 2e-4);
                }
                if (seams >> k & 1u) { // along the cut, from outside
                    plumb_vec2 from = plumb_vec2_lerp(a, b, -20), to = plumb_vec2_lerp(a, b, 20);
                    plumb_ray_hit hit;
                    assert_true(plumb_world_ray(world, plumb_transform_apply(t, from),
                                                plumb_transform_apply(t, to), NULL, &hit));
                }
            }
        }
        assert_int_equal(plumb_body_destroy(world, body), PLUMB_OK);
    }
    plumb_world_destroy(world);
}

static void test_chain(void **state)
{
    (void)state;
    plumb_world *world = make_world(11);
    plumb_body ground = add_body(world, PLUMB_STATIC, V(0, 0), 0);
    plumb_vec2 points[200];
    for (int i = 0; i < 200; ++i) {
        points[i] = V(i, i % 2);
    }
    plumb_shape_desc desc = { .kind = PLUMB_CHAIN, .points = points, .count = 200 };
    plumb_shape chain = plumb_shape_create(world, ground, &desc);
    plumb_shape shapes[4] = { NO_SHAPE };
    plumb_ray_hit hits[4];
    assert_int_equal(
        plumb_world_overlap_aabb(world, (plumb_aabb){ { -9, -9 }, { 999, 9 } }, NULL, shapes, 4),
        1);
    assert_true(plumb_same(shapes[0], chain));
    assert_int_equal(plumb_world_ray_all(world, V(-1, 0.5), V(300, 0.5), NULL, hits, 4), 1);
    NEAR(hits[0].point.x, 0.5, 1e-3);
    // Through every corner from above and below: nothing slips through.
    for (int i = 0; i < 200; ++i) {
        assert_int_equal(plumb_world_ray_all(world, V(i, 5), V(i, -5), NULL, hits, 4), 1);
        assert_int_equal(plumb_world_ray_all(world, V(i, -5), V(i, 5), NULL, hits, 4), 1);
        assert_true(hits[0].normal.y < 0 || hits[0].normal.x != 0);
    }
    check_a_few(world, 20);
    plumb_world_destroy(world);
}

static void test_far_away(void **state)
{
    (void)state;
    double far = (double)PLUMB_REAL_EPSILON < 1e-10 ? 9e8 : 1e5;
    plumb_world *world = make_world(12);
    for (int i = 0; i < 150; ++i) {
        plumb_body body = add_random(world, 10, 0.2, 1);
        plumb_vec2 at = plumb_vec2_add(V(-far, far), place(10));
        assert_int_equal(plumb_body_teleport(world, body, at, 1), PLUMB_OK);
    }
    int met = 0;
    for (int i = 0; i < 500; ++i) {
        plumb_vec2 from = plumb_vec2_add(V(-far, far), place(14));
        plumb_vec2 to = plumb_vec2_add(V(-far, far), place(14));
        met += check_ray(world, from, to, NULL) > 0;
        check_point(world, to, NULL);
        check_nearest(world, from, PLUMB_REAL_MAX, NULL);
        check_ray(world, i % 2 ? V(0, 0) : V(far, far), to, NULL); // long
    }
    assert_true(met > 100);
    plumb_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rays),
        cmocka_unit_test(test_rays_mixed_sizes),
        cmocka_unit_test(test_ray_hit),
        cmocka_unit_test(test_ray_ties),
        cmocka_unit_test(test_capacity),
        cmocka_unit_test(test_overlaps),
        cmocka_unit_test(test_overlaps_mixed_sizes),
        cmocka_unit_test(test_nearest),
        cmocka_unit_test(test_rounds),
        cmocka_unit_test(test_rounds_exact),
        cmocka_unit_test(test_filters),
        cmocka_unit_test(test_nested),
        cmocka_unit_test(test_changes),
        cmocka_unit_test(test_fast_bodies),
        cmocka_unit_test(test_motion_is_not_disturbed),
        cmocka_unit_test(test_outline),
        cmocka_unit_test(test_inner_cuts),
        cmocka_unit_test(test_chain),
        cmocka_unit_test(test_far_away),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
