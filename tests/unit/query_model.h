// query_model.h - what the tests of queries share: random worlds, and the model that asks every piece.
#ifndef QUERY_MODEL_H
#define QUERY_MODEL_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "harness/near.h"
#include "plumb/plumb.h"
#include "query/overlap.h"
#include "query/query.h"
#include "random_world.h"

#define MOST    400
#define R(x)    ((plumb_real)(x))
#define V(x, y) plumb_v2(R(x), R(y))

//---- worlds --------------------------------------------------------------------------------------
static inline plumb_shape add_shape(plumb_world *world, plumb_body body, int kind, double size)
{
    return random_shape(world, body, kind, size, (plumb_material)PLUMB_NULL_INIT);
}

static inline plumb_body add_body(plumb_world *world, plumb_body_type type, plumb_vec2 at,
                                  double angle)
{
    plumb_body_desc desc = { .type = type, .position = at, .angle = R(angle) };
    if (type != PLUMB_STATIC) {
        desc.velocity = place(3);
    }
    plumb_body body = plumb_body_create(world, &desc);
    assert_true(plumb_body_valid(world, body));
    return body;
}

static inline plumb_body add_random(plumb_world *world, double reach, double least, double most)
{
    const plumb_body_type types[] = { PLUMB_DYNAMIC, PLUMB_DYNAMIC, PLUMB_KINEMATIC, PLUMB_STATIC };
    plumb_body body = add_body(world, types[(int)uniform(0, 3.999)], place(reach), uniform(-4, 4));
    int shapes = uniform(0, 1) < 0.8 ? 1 : (int)uniform(0, 3.999);
    for (int i = 0; i < shapes; ++i) {
        add_shape(world, body, (int)uniform(0, 6.999), spread(least, most));
    }
    return body;
}

static inline plumb_world *random_world(uint32_t seed, int count, double reach, double least,
                                        double most)
{
    plumb_world *world = make_world(seed);
    for (int i = 0; i < count; ++i) {
        add_random(world, reach, least, most);
    }
    return world;
}

//---- brute force ---------------------------------------------------------------------------------
static inline plumb_transform frame_of(const plumb_world *world, uint32_t piece)
{
    return plumb_body_transform(world, plumb_shape_body(world, world->pieces.shape[piece]));
}

static inline bool seen(const plumb_world *world, uint32_t piece, const plumb_query_filter *f)
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

static inline bool ray_piece(const plumb_world *world, uint32_t piece, plumb_vec2 from,
                             plumb_vec2 to, plumb_ray_hit *hit)
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

static inline int compare_hits(const void *a, const void *b)
{
    const plumb_ray_hit *p = a, *q = b;
    if (p->fraction != q->fraction) {
        return p->fraction < q->fraction ? -1 : 1;
    }
    return p->shape.entity.index < q->shape.entity.index
               ? -1
               : p->shape.entity.index > q->shape.entity.index;
}

// All hits in order, one for each shape.
static inline int brute_ray(const plumb_world *world, plumb_vec2 from, plumb_vec2 to,
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

static inline int compare_shapes(const void *a, const void *b)
{
    const plumb_shape *p = a, *q = b;
    return p->entity.index < q->entity.index ? -1 : p->entity.index > q->entity.index;
}

static inline void include(shape_set *set, plumb_shape shape)
{
    for (int i = 0; i < set->count; ++i) {
        if (plumb_same(set->items[i], shape)) {
            return;
        }
    }
    set->items[set->count++] = shape;
}

static inline void check_set(shape_set *expected, const plumb_shape *shapes, int count)
{
    qsort(expected->items, (size_t)expected->count, sizeof *expected->items, compare_shapes);
    assert_int_equal(count, expected->count);
    assert_memory_equal(shapes, expected->items, (size_t)count * sizeof *shapes);
}

// Hits of a shape's pieces may tie: any of its normals is right then.
static inline void check_hit(const plumb_ray_hit *hit, const plumb_ray_hit *expected)
{
    assert_true(hit->fraction == expected->fraction);
    assert_true(plumb_same(hit->shape, expected->shape));
    assert_true(plumb_same(hit->body, expected->body));
    plumb_real size = plumb_abs(hit->point.x) + plumb_abs(hit->point.y) + 1;
    assert_true(plumb_vec2_distance(hit->point, expected->point) <=
                1000 * PLUMB_REAL_EPSILON * size);
}

static inline int check_ray(plumb_world *world, plumb_vec2 from, plumb_vec2 to,
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

static inline void check_point(plumb_world *world, plumb_vec2 point, const plumb_query_filter *f)
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
    for (uint32_t p = 0; p < world->pieces.table.count; ++p) {
        if (seen(world, p, f)) { // a shape alone tells the same
            const plumb_shape shape = world->pieces.shape[p];
            const bool is_in = bsearch(&shape, expected.items, (size_t)expected.count, sizeof shape,
                                       compare_shapes) != NULL;
            assert_int_equal(plumb_shape_contains(world, shape, point), is_in);
        }
    }
}

static inline int check_aabb(plumb_world *world, plumb_aabb box, const plumb_query_filter *f)
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
static inline double left_of(spot a, spot b, spot c)
{
    double length = hypot(b.x - a.x, b.y - a.y);
    double turn = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    return length > 0 ? turn / length : 0;
}

static inline bool surely_crosses(spot a, spot b, spot c, spot d)
{
    double u = left_of(a, b, c), v = left_of(a, b, d), w = left_of(c, d, a), z = left_of(c, d, b);
    return u * v < 0 && w * z < 0 && fmin(fmin(fabs(u), fabs(v)), fmin(fabs(w), fabs(z))) > BAND;
}

static inline bool surely_contains(const plumb_convex *c, const spot *at, spot p)
{
    for (int i = 0; i < c->count; ++i) {
        if (left_of(at[i], at[(i + 1) % c->count], p) <= BAND) {
            return false;
        }
    }
    return c->count > 2;
}

static inline double to_edge(spot a, spot b, spot p)
{
    double dx = b.x - a.x, dy = b.y - a.y;
    double length_sq = dx * dx + dy * dy;
    double t = length_sq > 0 ? ((p.x - a.x) * dx + (p.y - a.y) * dy) / length_sq : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

// Distance from ends to edges; -1 when edges cross or one core is in the other.
static inline double core_distance(const plumb_convex *a, plumb_transform ta, const plumb_convex *b,
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
static inline int expect_overlap(const plumb_convex *a, plumb_transform ta, const plumb_convex *b,
                                 plumb_transform tb)
{
    double reach = (double)a->radius + (double)b->radius;
    double distance = core_distance(a, ta, b, tb);
    return distance < reach - BAND ? 1 : distance > reach + BAND ? -1 : 0;
}

static inline plumb_convex random_convex(double size)
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

static inline int check_convex(plumb_world *world, const plumb_convex *convex, plumb_transform t,
                               const plumb_query_filter *f)
{
    plumb_shape shapes[8 * MOST];
    int count = plumb_world_overlap_convex(world, convex, t, f, shapes, 8 * MOST);
    for (int i = 1; i < count; ++i) {
        assert_true(shapes[i - 1].entity.index < shapes[i].entity.index);
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
static inline bool brute_nearest(const plumb_world *world, plumb_vec2 point, plumb_real most,
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
        bool nearer =
            !met || near.distance < hit->distance ||
            (near.distance == hit->distance && shape.entity.index < hit->shape.entity.index);
        if (near.distance <= most && nearer) {
            met = true;
            *hit = (plumb_nearest_hit){ shape, plumb_shape_body(world, shape),
                                        plumb_transform_apply(t, near.point), near.distance };
        }
    }
    return met;
}

static inline bool check_nearest(plumb_world *world, plumb_vec2 point, plumb_real most,
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
static inline int rays_of_all_kinds(plumb_world *world, int count, double reach,
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

//---- overlaps, nearest ---------------------------------------------------------------------------
static inline void overlaps_of_all_kinds(plumb_world *world, int count, double reach, double size,
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

//---- changes -------------------------------------------------------------------------------------
static inline void check_a_few(plumb_world *world, double reach)
{
    rays_of_all_kinds(world, 14, reach, NULL);
    overlaps_of_all_kinds(world, 7, reach, 0.5, NULL);
}

#endif
