// shape_make.c - from a descriptor to convex pieces: checked, made and measured, before anything of
// the world changes. The pieces lie in world->made until piece.c stores them.
//
// Reads: the descriptor. Writes: world->made, world->outline (scratch of the decomposition).
// Cost: O(points); outlines as plumb_outline_decompose, and O(corners of pieces x points) for the
// cuts.
#include "narrow/one_way.h"
#include "world/filter.h"
#include "world/check.h"
#include "world/rows.h"
#include "world/wrap.h"

#include <stdio.h>
#include <string.h>

#define POLYGON_POINTS 64 // see plumb_shape_kind

// What a step of the making works on.
typedef struct maker {
    plumb_world *world;
    const char *fn;
    const plumb_shape_desc *desc;
    pl_made *made;
} maker;

//---- the fields of each kind ---------------------------------------------------------------------

enum {
    HAS_CENTER = 1,
    HAS_RADIUS = 2,
    HAS_HALF = 4,
    HAS_ANGLE = 8,
    HAS_POINTS = 16,
    HAS_CLOSED = 32
};

typedef struct kind_fields {
    const char *name;
    unsigned has;
    int count_low, count_high; // of points
    plumb_real radius_low;
} kind_fields;

static const kind_fields kinds[PLUMB_SHAPE_KINDS] = {
    [PLUMB_CIRCLE] = { "a circle", HAS_CENTER | HAS_RADIUS, 0, 0, PLUMB_LENGTH_MIN },
    [PLUMB_CAPSULE] = { "a capsule", HAS_POINTS | HAS_RADIUS, 2, 2, PLUMB_LENGTH_MIN },
    [PLUMB_BOX] = { "a box", HAS_CENTER | HAS_RADIUS | HAS_HALF | HAS_ANGLE, 0, 0, 0 },
    [PLUMB_POLYGON] = { "a polygon", HAS_POINTS | HAS_RADIUS, 3, POLYGON_POINTS, 0 },
    [PLUMB_OUTLINE] = { "an outline", HAS_POINTS, 3, PLUMB_OUTLINE_MAX_VERTICES, 0 },
    [PLUMB_SEGMENT] = { "a segment", HAS_POINTS, 2, 2, 0 },
    [PLUMB_CHAIN] = { "a chain", HAS_POINTS | HAS_CLOSED, 2, INT32_MAX, 0 },
};

// A field that the kind does not name must be zero: a value there is a misunderstanding.
static plumb_result check_unused(const maker *m, const kind_fields *kind)
{
    const plumb_shape_desc *d = m->desc;
    const struct {
        unsigned bit;
        bool given;
        const char *name;
    } fields[] = {
        { HAS_CENTER, d->center.x != 0 || d->center.y != 0, "center" },
        { HAS_RADIUS, d->radius != 0, "radius" },
        { HAS_HALF, d->half.x != 0 || d->half.y != 0, "half" },
        { HAS_ANGLE, d->angle != 0, "angle" },
        { HAS_POINTS, d->points != NULL, "points" },
        { HAS_POINTS, d->count != 0, "count" },
        { HAS_CLOSED, d->closed, "closed" },
    };
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i) {
        if (fields[i].given && !(kind->has & fields[i].bit)) {
            return pl_fail(m->world, PLUMB_E_RANGE, m->fn, "%s is given; it must be 0 for %s",
                           fields[i].name, kind->name);
        }
    }
    return PLUMB_OK;
}

static plumb_result check_points(const maker *m, const kind_fields *kind)
{
    const plumb_shape_desc *d = m->desc;
    int low = d->closed ? 3 : kind->count_low;
    PL_TRY(pl_check_pointer(m->world, m->fn, "points", d->points));
    if (kind->count_high == INT32_MAX && d->count < low) {
        return pl_fail(m->world, PLUMB_E_RANGE, m->fn, "count is %d; it must be at least %d for %s",
                       d->count, low, d->closed ? "a closed chain" : kind->name);
    }
    if (low == kind->count_high && d->count != low) {
        return pl_fail(m->world, PLUMB_E_RANGE, m->fn, "count is %d; it must be %d for %s",
                       d->count, low, kind->name);
    }
    if (d->count < low || d->count > kind->count_high) {
        return pl_fail(m->world, PLUMB_E_RANGE, m->fn, "count is %d; it must be %d to %d for %s",
                       d->count, low, kind->count_high, kind->name);
    }
    for (int i = 0; i < d->count; ++i) {
        plumb_vec2 p = d->points[i];
        if (!(plumb_abs(p.x) <= PLUMB_LENGTH_MAX && plumb_abs(p.y) <= PLUMB_LENGTH_MAX)) {
            char field[32];
            snprintf(field, sizeof field, "points[%d]", i);
            return pl_check_within(m->world, m->fn, field, p, PLUMB_LENGTH_MAX);
        }
    }
    return PLUMB_OK;
}

static plumb_result check_numbers(const maker *m, const kind_fields *kind)
{
    const plumb_shape_desc *d = m->desc;
    const real least = PLUMB_LENGTH_MIN, most = PLUMB_LENGTH_MAX;
    PL_TRY(pl_check_within(m->world, m->fn, "center", d->center, most));
    if (kind->has & HAS_RADIUS) {
        PL_TRY(pl_check_range(m->world, m->fn, "radius", d->radius, kind->radius_low, most));
    }
    if (kind->has & HAS_HALF) {
        PL_TRY(pl_check_range(m->world, m->fn, "half.x", d->half.x, least, most));
        PL_TRY(pl_check_range(m->world, m->fn, "half.y", d->half.y, least, most));
    }
    PL_TRY(pl_check_finite(m->world, m->fn, "angle", d->angle));
    return pl_check_range(m->world, m->fn, "density", d->density, 0, PLUMB_REAL_MAX);
}

static plumb_result check_desc(const maker *m)
{
    PL_TRY(pl_check_pointer(m->world, m->fn, "desc", m->desc));
    if ((unsigned)m->desc->kind >= PLUMB_SHAPE_KINDS) {
        return pl_fail(m->world, PLUMB_E_RANGE, m->fn, "kind is %d; it must be a plumb_shape_kind",
                       (int)m->desc->kind);
    }
    const kind_fields *kind = &kinds[m->desc->kind];
    PL_TRY(check_unused(m, kind));
    PL_TRY(check_numbers(m, kind));
    if (kind->has & HAS_POINTS) {
        PL_TRY(check_points(m, kind));
    }
    uint32_t row;
    return pl_check_material(m->world, m->fn, m->desc->material, &row);
}

// The values were in range one by one; what is left is what they make together.
static plumb_result refuse_geometry(const maker *m, plumb_result code)
{
    const char *name = kinds[m->desc->kind].name;
    if (code == PLUMB_E_MEMORY) {
        return pl_fail_memory(m->world, m->fn);
    }
    if (code == PLUMB_E_CAPACITY) {
        return pl_fail(m->world, code, m->fn,
                       "points have more than %d corners; %s must have fewer",
                       PLUMB_POLYGON_MAX_VERTICES, name);
    }
    switch (m->desc->kind) {
    case PLUMB_CAPSULE:
    case PLUMB_SEGMENT:
    case PLUMB_CHAIN:
        return pl_fail(m->world, code, m->fn,
                       "points are too near each other; neighbours must be %g apart",
                       (double)PLUMB_LENGTH_MIN);
    case PLUMB_POLYGON:
        return pl_fail(m->world, code, m->fn,
                       "points enclose no area; their hull must have 3 corners");
    case PLUMB_OUTLINE:
        return pl_fail(m->world, code, m->fn,
                       "points cross, touch or enclose no area; the outline must be simple");
    default:
        return pl_fail(m->world, code, m->fn,
                       "half is too small for its distance from the origin; it must be larger");
    }
}

//---- pieces --------------------------------------------------------------------------------------

static bool reserve_pieces(const maker *m, uint32_t count)
{
    return pl_buffer_reserve(&m->world->memory, &m->world->made, count * sizeof(pl_made_piece));
}

static pl_made_piece *add_piece(const maker *m)
{
    pl_made_piece *piece = (pl_made_piece *)m->world->made.data + m->made->count++;
    memset(piece, 0, sizeof *piece);
    return piece;
}

static real reach_of(const plumb_convex *convex)
{
    real farthest = 0;
    for (int i = 0; i < convex->count; ++i) {
        farthest = plumb_max(farthest, plumb_vec2_magnitude(convex->points[i]));
    }
    return farthest + convex->radius;
}

static void count_corners(const maker *m, const pl_made_piece *piece)
{
    if (piece->convex.count > 1) {
        m->made->corners += pl_pool_run(pl_pool_class(piece->convex.count));
    }
}

static void finish_circle(const maker *m, pl_made_piece *piece)
{
    const plumb_convex *c = &piece->convex;
    piece->kind = PL_PIECE_CIRCLE;
    piece->core = (pl_core){ c->points[0].x, c->points[0].y, 1, 0, 0, 0, c->radius, reach_of(c) };
    count_corners(m, piece);
}

static void finish_capsule(const maker *m, pl_made_piece *piece)
{
    const plumb_convex *c = &piece->convex;
    plumb_vec2 middle = plumb_vec2_lerp(c->points[0], c->points[1], (plumb_real)0.5);
    // The first normal lies on the right of the direction: turned left it is the direction.
    plumb_vec2 along = plumb_vec2_left(c->normals[0]);
    real half = plumb_vec2_distance(c->points[0], c->points[1]) / 2;
    piece->kind = PL_PIECE_CAPSULE;
    piece->core =
        (pl_core){ middle.x, middle.y, along.x, along.y, half, 0, c->radius, reach_of(c) };
    count_corners(m, piece);
}

static void finish_box(const maker *m, pl_made_piece *piece, plumb_vec2 center, plumb_rot q,
                       plumb_vec2 half)
{
    piece->kind = PL_PIECE_BOX;
    piece->core =
        (pl_core){ center.x, center.y, q.c, q.s, half.x, half.y, 0, reach_of(&piece->convex) };
    count_corners(m, piece);
}

// A quadrilateral whose corners are those of a box to within the rounding of its coordinates is
// stored as a box, whose kernel is cheaper.
static bool try_box(const maker *m, pl_made_piece *piece)
{
    const plumb_convex *c = &piece->convex;
    if (c->count != 4) {
        return false;
    }
    plumb_vec2 center = plumb_vec2_scale(
        (plumb_real)0.25, plumb_vec2_add(plumb_vec2_add(c->points[0], c->points[1]),
                                         plumb_vec2_add(c->points[2], c->points[3])));
    plumb_vec2 along = plumb_vec2_left(c->normals[0]);
    plumb_rot q = { along.x, along.y };
    plumb_vec2 half = { plumb_vec2_distance(c->points[0], c->points[1]) / 2,
                        plumb_vec2_distance(c->points[1], c->points[2]) / 2 };
    // 4 roundings: two of the sums above, one of the corner, one of the coordinate itself.
    real allowed = 4 * PLUMB_REAL_EPSILON * reach_of(c);
    for (int i = 0; i < 4; ++i) {
        plumb_vec2 corner = { i == 1 || i == 2 ? half.x : -half.x, i >= 2 ? half.y : -half.y };
        plumb_vec2 at = plumb_vec2_add(center, plumb_rot_apply(q, corner));
        if (plumb_abs(at.x - c->points[i].x) > allowed ||
            plumb_abs(at.y - c->points[i].y) > allowed) {
            return false;
        }
    }
    finish_box(m, piece, center, q, half);
    return true;
}

static void finish_polygon(const maker *m, pl_made_piece *piece)
{
    // Cuts and round corners are the polygon kernel's: a piece that has them stays a polygon.
    if (piece->cuts == 0 && piece->convex.radius <= 0 && try_box(m, piece)) {
        return;
    }
    const plumb_convex *c = &piece->convex;
    plumb_aabb box = plumb_aabb_empty();
    for (int i = 0; i < c->count; ++i) {
        box = plumb_aabb_add_point(box, c->points[i]);
    }
    plumb_vec2 center = plumb_aabb_center(box);
    piece->kind = PL_PIECE_POLYGON;
    piece->core = (pl_core){
        center.x,  center.y,   1, 0, (box.max.x - box.min.x) / 2, (box.max.y - box.min.y) / 2,
        c->radius, reach_of(c)
    };
    count_corners(m, piece);
}

//---- kinds of one piece --------------------------------------------------------------------------

static plumb_result make_convex(const plumb_shape_desc *d, plumb_convex *convex)
{
    switch (d->kind) {
    case PLUMB_CIRCLE:
        return plumb_convex_circle(d->center, d->radius, convex);
    case PLUMB_CAPSULE:
        return plumb_convex_capsule(d->points[0], d->points[1], d->radius, convex);
    case PLUMB_BOX:
        return plumb_convex_box(d->half, d->center, d->angle, d->radius, convex);
    default:
        return plumb_convex_polygon(d->points, d->count, d->radius, convex);
    }
}

// Points that lie in the hull, by more than what rounding and welding may do to those of a straight edge: an
// outline that was drawn concave.
static void warn_of_inner_points(const maker *m, const plumb_convex *hull)
{
    const plumb_shape_desc *d = m->desc;
    real most = 0;
    for (int i = 0; i < hull->count; ++i) {
        most = plumb_max(most, plumb_vec2_distance(hull->points[0], hull->points[i]));
    }
    int inner = 0;
    for (int i = 0; i < d->count; ++i) {
        real depth = PLUMB_REAL_MAX;
        for (int k = 0; k < hull->count; ++k) {
            plumb_vec2 way = plumb_vec2_sub(hull->points[k], d->points[i]);
            depth = plumb_min(depth, plumb_vec2_dot(hull->normals[k], way));
        }
        inner += depth > plumb_max(2 * PLUMB_WELD_DISTANCE, (real)1e-3 * most);
    }
    if (inner > 0) {
        pl_warn(m->world,
                "%s: %d of %d points lie within the convex hull and are left out; "
                "PLUMB_OUTLINE may be concave",
                m->fn, inner, d->count);
    }
}

static plumb_result make_single(const maker *m)
{
    const plumb_shape_desc *d = m->desc;
    if (!reserve_pieces(m, 1)) {
        return PLUMB_E_MEMORY;
    }
    pl_made_piece *piece = add_piece(m);
    PL_TRY(make_convex(d, &piece->convex));
    switch (d->kind) {
    case PLUMB_CIRCLE:
        finish_circle(m, piece);
        break;
    case PLUMB_CAPSULE:
        finish_capsule(m, piece);
        break;
    case PLUMB_BOX:
        if (piece->convex.radius > 0) {
            finish_polygon(m, piece);
        } else {
            finish_box(m, piece, d->center, plumb_rot_make(d->angle), d->half);
        }
        break;
    default:
        warn_of_inner_points(m, &piece->convex);
        finish_polygon(m, piece);
        break;
    }
    m->made->area = plumb_convex_mass(&piece->convex, 1);
    return PLUMB_OK;
}

//---- lines ---------------------------------------------------------------------------------------

static plumb_result make_lines(const maker *m)
{
    const plumb_shape_desc *d = m->desc;
    int links = d->closed ? d->count : d->count - 1;
    if (!reserve_pieces(m, (uint32_t)links)) {
        return PLUMB_E_MEMORY;
    }
    for (int i = 0; i < links; ++i) {
        pl_made_piece *piece = add_piece(m);
        plumb_vec2 to = d->points[i + 1 == d->count ? 0 : i + 1];
        plumb_result r = plumb_convex_segment(d->points[i], to, &piece->convex);
        if (r != PLUMB_OK) {
            return r;
        }
        finish_capsule(m, piece);
    }
    return PLUMB_OK;
}

//---- outlines ------------------------------------------------------------------------------------

// True when the edge from p to q runs along some edge of the outline for more than a point.
static bool on_outline(const plumb_shape_desc *d, plumb_vec2 p, plumb_vec2 q, real tolerance)
{
    real length;
    plumb_vec2 along = plumb_vec2_unit_and_magnitude(plumb_vec2_sub(q, p), &length);
    for (int i = 0; i < d->count; ++i) {
        plumb_vec2 u = plumb_vec2_sub(d->points[i], p);
        plumb_vec2 v = plumb_vec2_sub(d->points[i + 1 == d->count ? 0 : i + 1], p);
        if (plumb_abs(plumb_vec2_cross(along, u)) > tolerance ||
            plumb_abs(plumb_vec2_cross(along, v)) > tolerance) {
            continue;
        }
        real a = plumb_vec2_dot(along, u);
        real b = plumb_vec2_dot(along, v);
        real overlap = plumb_min(plumb_max(a, b), length) - plumb_max(plumb_min(a, b), 0);
        if (overlap > tolerance) {
            return true;
        }
    }
    return false;
}

// Pieces use the outline's own corners, so a cut is an edge that no edge of the outline runs
// along.
static uint32_t cuts_of(const plumb_shape_desc *d, const plumb_convex *convex, real tolerance)
{
    uint32_t cuts = 0;
    for (int k = 0; k < convex->count; ++k) {
        plumb_vec2 q = convex->points[k + 1 == convex->count ? 0 : k + 1];
        if (!on_outline(d, convex->points[k], q, tolerance)) {
            cuts |= 1u << k;
        }
    }
    return cuts;
}

static void copy_polygon(const plumb_convex_piece *piece, plumb_convex *convex)
{
    convex->count = piece->count;
    for (int k = 0; k < piece->count; ++k) {
        plumb_vec2 p = piece->vertices[k];
        plumb_vec2 q = piece->vertices[k + 1 == piece->count ? 0 : k + 1];
        convex->points[k] = p;
        convex->normals[k] = plumb_vec2_right(plumb_vec2_unit(plumb_vec2_sub(q, p)));
    }
}

static plumb_result make_outline(const maker *m)
{
    const plumb_shape_desc *d = m->desc;
    int most = d->count - 2; // a triangulation has no more
    pl_buffer *scratch = &m->world->outline;
    if (!pl_buffer_reserve(&m->world->memory, scratch, (size_t)most * sizeof(plumb_convex_piece)) ||
        !reserve_pieces(m, (uint32_t)most)) {
        return PLUMB_E_MEMORY;
    }
    plumb_convex_piece *parts = scratch->data;
    int count;
    PL_TRY(plumb_outline_decompose(d->points, d->count, parts, most, &count));
    real size = 0;
    for (int i = 0; i < d->count; ++i) {
        size = plumb_max(size, plumb_vec2_distance(d->points[i], d->points[0]));
        size = plumb_max(size, plumb_vec2_magnitude(d->points[i]));
    }
    // The decomposition leaves out corners within 8 roundings of a line; 4 times that tells an edge
    // that was straightened from one that is an inner cut.
    real tolerance = 32 * PLUMB_REAL_EPSILON * size;
    for (int i = 0; i < count; ++i) {
        pl_made_piece *piece = add_piece(m);
        copy_polygon(&parts[i], &piece->convex);
        piece->cuts = cuts_of(d, &piece->convex, tolerance);
        finish_polygon(m, piece);
    }
    m->made->area = plumb_outline_mass(d->points, d->count, 1);
    return PLUMB_OK;
}

//---- pieces that come from elsewhere --------------------------------------------------------------

void pl_made_add(plumb_world *world, pl_made *made, const pl_made_piece *piece)
{
    const maker m = { world, "", NULL, made };
    pl_made_piece *to = add_piece(&m);
    *to = *piece;
    count_corners(&m, to);
}

void pl_made_add_polygon(plumb_world *world, pl_made *made, const plumb_convex *convex,
                         uint32_t cuts)
{
    const maker m = { world, "", NULL, made };
    pl_made_piece *piece = add_piece(&m);
    piece->convex = *convex;
    piece->cuts = cuts;
    finish_polygon(&m, piece);
}

//---- all of it -----------------------------------------------------------------------------------

plumb_result pl_shape_make(plumb_world *world, const char *function, const plumb_shape_desc *desc,
                           pl_made *made)
{
    maker m = { world, function, desc, made };
    *made = (pl_made){ 0 };
    PL_TRY(check_desc(&m));
    PL_TRY(pl_filter_check(world, function, &desc->filter));
    PL_TRY(pl_one_way_check(world, function, &desc->one_way));
    const bool lines = desc->kind == PLUMB_SEGMENT || desc->kind == PLUMB_CHAIN;
    const plumb_result r = desc->kind == PLUMB_OUTLINE ? make_outline(&m)
                           : lines                     ? make_lines(&m)
                                                       : make_single(&m);
    if (r != PLUMB_OK) {
        return refuse_geometry(&m, r);
    }
    const pl_made_piece *pieces = world->made.data;
    for (uint32_t i = 0; i < made->count; ++i) {
        PL_TRY(pl_wrap_check_piece(world, function, &pieces[i].core));
    }
    return PLUMB_OK;
}
