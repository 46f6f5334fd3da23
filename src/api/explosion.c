// explosion.c - a radial impulse on all that a point can see.
//
// The blast's front carries an impulse p per metre. Seen from its centre, a surface that covers the
// angle dt at the distance r stops r dt of the front and gets the impulse p(r) r dt along the ray,
// at the point of the ray. The angle that a convex piece covers is known exactly; it is integrated
// over with RAYS rays at t = m + h sin(u), u even over -pi/2..pi/2, for what is round ends
// tangentially to the outermost ray: with even angles the error would fall as RAYS^-3/2 only.
//
// All impulses are summed up in double before any body is pushed; the order is that of the slots of
// shapes. Reads: grids, pieces, poses. Writes: velocities. Cost: O(pieces near x RAYS), times the
// cost of a ray where something shields.
#include "world/island.h"
#include "broad/query_grids.h"
#include "broad/images.h"
#include "math/trig.h"
#include "plumb/effect.h"
#include "plumb/math.h"
#include "query/query.h"
#include "world/check.h"
#include "world/rows.h"

#include <math.h>

#define RAYS          32
#define POSITION_MOST ((real)1e9)
#define REACH_MOST    ((real)1e7)
#define SHIELDED      ((real)0.999) // [-] of the way: what a ray meets before here shields
#define PI            3.14159265358979323846

typedef struct impact {
    double x, y, w;        // [N s], [N m s] about the centre of mass
    double seen, possible; // shares of rays, weighted by the front that they carry
    double strength;       // sum of seen x strength
} impact;

typedef struct pushed {
    plumb_body body;
    pl_push push;
} pushed;

typedef struct blast {
    plumb_world *world;
    const plumb_explosion_desc *desc;
    double reach;                    // [m]
    double sine[RAYS], weight[RAYS]; // of the middle of a piece's angle, in halves of it
    uint32_t row;                    // of the body that is asked about
} blast;

//---- checks --------------------------------------------------------------------------------------

static plumb_result check(const plumb_world *world, const char *fn,
                          const plumb_explosion_desc *desc)
{
    PL_TRY(pl_check_pointer(world, fn, "desc", desc));
    PL_TRY(pl_check_within(world, fn, "position", desc->position, POSITION_MOST));
    PL_TRY(pl_check_range(world, fn, "radius", desc->radius, 0, REACH_MOST));
    PL_TRY(pl_check_range(world, fn, "falloff", desc->falloff, 0, REACH_MOST));
    PL_TRY(pl_check_finite(world, fn, "impulse", desc->impulse));
    real reach = desc->radius + desc->falloff;
    if (!(reach > 0 && reach <= REACH_MOST)) {
        return pl_fail(world, PLUMB_E_RANGE, fn,
                       "radius + falloff is %g; it must be above 0 and at most %g", (double)reach,
                       (double)REACH_MOST);
    }
    PL_TRY(pl_query_check_reach(world, fn, "the blast", 2 * (double)reach, 2 * (double)reach));
    return (unsigned)desc->occlusion <= PLUMB_OCCLUDE_ALL
               ? PLUMB_OK
               : pl_fail(world, PLUMB_E_RANGE, fn, "occlusion is %d; it must be a plumb_occlusion",
                         (int)desc->occlusion);
}

//---- rays ----------------------------------------------------------------------------------------

static void place_rays(blast *b)
{
    for (int k = 0; k < RAYS; ++k) {
        double cosine;
        pl_sincos(PI * ((k + 0.5) / RAYS - 0.5), &b->sine[k], &cosine);
        b->weight[k] = cosine * (PI / RAYS);
    }
}

// Share of the strength at a distance.
static double strength(const blast *b, double distance)
{
    double beyond = distance - (double)b->desc->radius;
    double falloff = (double)b->desc->falloff;
    return beyond <= 0 ? 1 : beyond >= falloff ? 0 : 1 - beyond / falloff;
}

// Where a ray meets a piece, as a fraction of `way`.
static bool meets(const plumb_world *world, uint32_t piece, plumb_vec2 from, plumb_vec2 way,
                  real *fraction)
{
    plumb_convex convex;
    plumb_convex_hit hit;
    plumb_transform frame = pl_query_frame(world, piece, from);
    pl_piece_convex(world, piece, &convex);
    bool met = plumb_convex_ray(&convex, plumb_transform_inv_apply(frame, from),
                                plumb_rot_inv_apply(frame.q, way), &hit);
    *fraction = met ? hit.fraction : 1;
    return met;
}

// Another piece of the same body is nearer along the ray.
static bool is_behind_own(const blast *b, uint32_t piece, plumb_vec2 way, real fraction)
{
    const plumb_world *world = b->world;
    uint32_t q = world->bodies.first_piece[b->row];
    for (; q != PL_NONE; q = world->pieces.next_in_body[q]) {
        real other;
        if (q != piece && (world->pieces.flags[q] & PL_PIECE_SENSOR) == 0 &&
            meets(world, q, b->desc->position, way, &other) &&
            (other < fraction || (other == fraction && q < piece))) {
            return true;
        }
    }
    return false;
}

static bool shields(void *context, plumb_shape shape)
{
    const blast *b = context;
    uint32_t row = b->world->pieces.body[pl_shape_piece(b->world, shape)];
    return row != b->row &&
           (b->desc->occlusion == PLUMB_OCCLUDE_ALL || b->world->bodies.type[row] != PLUMB_DYNAMIC);
}

static bool is_shielded(blast *b, plumb_vec2 way, real fraction)
{
    if (b->desc->occlusion == PLUMB_OCCLUDE_NOTHING) {
        return false;
    }
    plumb_query_filter filter = { .accept = shields, .context = b };
    plumb_ray_hit hit;
    plumb_vec2 to = plumb_vec2_add_scaled(b->desc->position, fraction * SHIELDED, way);
    return plumb_world_ray(b->world, b->desc->position, to, &filter, &hit);
}

//---- one piece -----------------------------------------------------------------------------------

// The angle that a piece covers, seen from the blast: middle and half of it. False: it contains it.
static bool covers(const blast *b, uint32_t piece, double *middle, double *half)
{
    plumb_convex convex;
    plumb_transform frame = pl_query_frame(b->world, piece, b->desc->position);
    pl_piece_convex(b->world, piece, &convex);
    plumb_vec2 from = plumb_transform_inv_apply(frame, b->desc->position);
    if (plumb_convex_contains(&convex, from)) {
        return false;
    }
    double radius = (double)convex.radius, low = 0, high = 0, ax = 0, ay = 0;
    for (int i = 0; i < convex.count; ++i) {
        plumb_vec2 arm = plumb_rot_apply(frame.q, plumb_vec2_sub(convex.points[i], from));
        double x = (double)arm.x, y = (double)arm.y, square = x * x + y * y - radius * radius;
        if (i == 0) {
            ax = x, ay = y;
        }
        double angle = pl_atan2(ax * y - ay * x, ax * x + ay * y);
        double wide = pl_atan2(radius, sqrt(square > 0 ? square : 0));
        low = i == 0 || angle - wide < low ? angle - wide : low;
        high = i == 0 || angle + wide > high ? angle + wide : high;
    }
    *middle = pl_atan2(ay, ax) + (low + high) / 2;
    *half = (high - low) / 2;
    return true;
}

// Centre of mass of the body that is asked about, by the image nearest to the blast.
static plumb_vec2 center_of(const blast *b)
{
    const pl_bodies *bodies = &b->world->bodies;
    return pl_wrap_point(b->world, plumb_v2(bodies->center_x[b->row], bodies->center_y[b->row]),
                         b->desc->position);
}

// A blast inside a piece: see plumb_world_explode.
static void hit_from_inside(const blast *b, uint32_t piece, impact *sum)
{
    plumb_vec2 center = center_of(b);
    plumb_vec2 way = plumb_vec2_unit(plumb_vec2_sub(center, b->desc->position));
    plumb_convex convex;
    plumb_rot turn = pl_query_frame(b->world, piece, b->desc->position).q;
    pl_piece_convex(b->world, piece, &convex);
    plumb_vec2 across = plumb_rot_inv_apply(turn, plumb_vec2_left(way));
    plumb_vec2 left = plumb_convex_support(&convex, across);
    plumb_vec2 right = plumb_convex_support(&convex, plumb_vec2_neg(across));
    double front = (double)plumb_vec2_dot(across, plumb_vec2_sub(left, right));
    sum->x += (double)way.x * front;
    sum->y += (double)way.y * front;
    sum->seen += 1;
    sum->possible += 1;
    sum->strength += 1;
}

static void hit_piece(blast *b, uint32_t piece, impact *sum)
{
    double middle, half;
    if (!covers(b, piece, &middle, &half)) {
        hit_from_inside(b, piece, sum);
        return;
    }
    const plumb_vec2 at = b->desc->position, center = center_of(b);
    double arm_x = (double)at.x - (double)center.x;
    double arm_y = (double)at.y - (double)center.y;
    for (int k = 0; k < RAYS; ++k) {
        double s, c;
        pl_sincos(middle + half * b->sine[k], &s, &c);
        plumb_vec2 way = { (real)(c * b->reach), (real)(s * b->reach) };
        real fraction;
        if (!meets(b->world, piece, at, way, &fraction) || is_behind_own(b, piece, way, fraction)) {
            continue;
        }
        double distance = (double)fraction * b->reach;
        double front = distance * half * b->weight[k];
        sum->possible += front;
        if (is_shielded(b, way, fraction)) {
            continue;
        }
        double share = strength(b, distance);
        sum->seen += front;
        sum->strength += front * share;
        double px = c * front * share, py = s * front * share;
        sum->x += px;
        sum->y += py;
        sum->w += (arm_x + c * distance) * py - (arm_y + s * distance) * px;
    }
}

//---- all of it -----------------------------------------------------------------------------------

static bool collect(void *context, const pl_grid_entry *entry)
{
    pl_query *q = context;
    if (!pl_query_sees(q, entry->piece) ||
        q->world->bodies.type[q->world->pieces.body[entry->piece]] != PLUMB_DYNAMIC) {
        return true;
    }
    pl_query_hit hit = pl_query_hit_of(q->world, entry->piece);
    return pl_query_add(q, &hit);
}

// Whether a shape is among the hits, which are sorted by slots.
static bool is_hit(const pl_query *q, uint32_t slot)
{
    uint32_t low = 0, high = q->count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (q->hits[middle].shape.entity.index < slot) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < q->count && q->hits[low].shape.entity.index == slot;
}

static pl_push push_of(const blast *b, const impact *sum)
{
    double p = (double)b->desc->impulse;
    if (!b->desc->per_body) {
        return (pl_push){ { (real)(sum->x * p), (real)(sum->y * p) }, (real)(sum->w * p) };
    }
    plumb_vec2 center = center_of(b);
    plumb_vec2 way = plumb_vec2_unit(plumb_vec2_sub(center, b->desc->position));
    real share = sum->possible > 0 ? (real)(sum->strength / sum->possible * p) : 0;
    return (pl_push){ plumb_vec2_scale(share, way), 0 };
}

static bool is_nothing(const pl_push *push)
{
    return push->linear.x == 0 && push->linear.y == 0 && push->angular == 0;
}

// The impulses on all bodies that get one, by slots of their shapes. Hits are one a shape that may be near:
// a body of several has the sum of all at the first that the front meets.
static uint32_t sum_up(blast *b, const pl_query *q, pushed *out)
{
    const pl_pieces *pieces = &b->world->pieces;
    uint32_t count = 0;
    for (uint32_t i = 0; i < q->count; ++i) {
        b->row = pl_body_row(b->world, q->hits[i].body);
        impact sum = { .x = 0 };
        uint32_t first = PL_NONE; // slot of the body's first shape that the front meets
        uint32_t p = b->world->bodies.first_piece[b->row];
        for (; p != PL_NONE; p = pieces->next_in_body[p]) {
            uint32_t slot = pieces->shape[p].entity.index;
            double before = sum.possible;
            if (is_hit(q, slot)) {
                hit_piece(b, p, &sum);
                first = sum.possible > before && slot < first ? slot : first;
            }
        }
        pl_push push = push_of(b, &sum);
        if (first == q->hits[i].shape.entity.index && !is_nothing(&push)) {
            out[count++] = (pushed){ q->hits[i].body, push };
        }
    }
    return count;
}

static plumb_result push_all(blast *b, const char *fn, const pushed *list, uint32_t count)
{
    for (int pass = 0; pass < 2; ++pass) {
        for (uint32_t i = 0; i < count; ++i) {
            uint32_t row = pl_body_row(b->world, list[i].body);
            plumb_result r = pass == 0 ? pl_impulse_check(b->world, fn, row, list[i].push)
                                       : pl_impulse_add(b->world, fn, row, list[i].push);
            if (r != PLUMB_OK) {
                return r;
            }
        }
    }
    // Waking moves rows: each is looked up when its turn comes.
    for (uint32_t i = 0; i < count; ++i) {
        pl_sleep_stir(b->world, pl_body_row(b->world, list[i].body));
    }
    return PLUMB_OK;
}

plumb_result plumb_world_explode(plumb_world *world, const plumb_explosion_desc *desc)
{
    PL_TRY(pl_check_world(world));
    pl_query q;
    PL_TRY(check(world, __func__, desc));
    PL_TRY(pl_query_begin(&q, world, __func__, &desc->filter));
    blast b = { .world = world,
                .desc = desc,
                .reach = (double)desc->radius + (double)desc->falloff };
    place_rays(&b);
    const pl_box near = pl_query_box_at(desc->position, b.reach);
    const pl_grid *grids[PL_QUERY_GRIDS];
    q.filter.ignore_static = true;
    const int count = pl_query_grids(&q, grids);
    for (int i = 0; i < count; ++i) {
        pl_world_query(world, grids[i], near, collect, &q);
    }
    pl_query_one_per_shape(&q);
    pl_buffer list = { 0 };
    plumb_result r = PLUMB_OK;
    if (!pl_buffer_reserve(&world->memory, &list, q.count * sizeof(pushed))) {
        q.out_of_memory = true;
    } else if (!q.out_of_memory && q.count > 0) {
        r = push_all(&b, __func__, list.data, sum_up(&b, &q, list.data));
    }
    pl_buffer_free(&world->memory, &list);
    plumb_result ended = pl_query_end(&q);
    return r != PLUMB_OK ? r : ended;
}
