// wrap.c - worlds that wrap around: where bodies lie in the period, and nearest images.
//
// Bodies are brought back by their centre of mass, by adding or taking away the period once: in floating point
// that is exact for whatever is at most half a period beyond the edge (Sterbenz 1974), so a body that
// crosses loses no bit. Reads: the descriptor, poses. Writes: centres, origins and poses of bodies beyond an
// edge. Order: after all motion. Cost: O(moving bodies), two comparisons each.
#include "world/wrap.h"

#include "world/check.h"

#include <math.h>

//---- checks --------------------------------------------------------------------------------------

plumb_result pl_wrap_check_piece(const plumb_world *world, const char *function,
                                 const pl_core *core)
{
    real x = world->desc.wrap_x, y = world->desc.wrap_y;
    if (!pl_is_wrapped(world)) {
        return PLUMB_OK;
    }
    real least = !(x > 0) || (y > 0 && y < x) ? y : x;
    double across =
        2 * (sqrt((double)core->hx * (double)core->hx + (double)core->hy * (double)core->hy) +
             (double)core->radius);
    return across < (double)least / 2
               ? PLUMB_OK
               : pl_fail(
                     world, PLUMB_E_RANGE, function,
                     "the shape is %g m across; in a world that wraps every %g m each convex piece "
                     "must be below %g",
                     across, (double)least, (double)least / 2);
}

//---- shifts --------------------------------------------------------------------------------------

static double shift_along(double d, real period)
{
    return period > 0 ? -floor(d / (double)period + 0.5) * (double)period : 0;
}

pl_shift pl_wrap_shift(const plumb_world *world, double dx, double dy)
{
    return (pl_shift){ shift_along(dx, world->desc.wrap_x), shift_along(dy, world->desc.wrap_y) };
}

plumb_vec2 pl_wrap_point(const plumb_world *world, plumb_vec2 point, plumb_vec2 about)
{
    if (!pl_is_wrapped(world)) {
        return point;
    }
    pl_shift s =
        pl_wrap_shift(world, (double)point.x - (double)about.x, (double)point.y - (double)about.y);
    return plumb_v2((real)((double)point.x + s.x), (real)((double)point.y + s.y));
}

// Middle of a piece's core.
static pl_shift middle_of(const plumb_world *world, uint32_t piece)
{
    const pl_pose *pose = &pl_poses(world)[world->pieces.body[piece]];
    const pl_core *core = &world->pieces.core[piece];
    return (pl_shift){
        (double)pose->x + ((double)pose->c * (double)core->x - (double)pose->s * (double)core->y),
        (double)pose->y + ((double)pose->s * (double)core->x + (double)pose->c * (double)core->y)
    };
}

pl_shift pl_wrap_piece(const plumb_world *world, uint32_t piece, double x, double y)
{
    if (!pl_is_wrapped(world)) {
        return (pl_shift){ 0, 0 };
    }
    pl_shift middle = middle_of(world, piece);
    return pl_wrap_shift(world, middle.x - x, middle.y - y);
}

pl_shift pl_wrap_arm(const plumb_world *world, uint32_t row, double x, double y)
{
    double rx = x - (double)world->bodies.center_x[row];
    double ry = y - (double)world->bodies.center_y[row];
    pl_shift s = pl_is_wrapped(world) ? pl_wrap_shift(world, rx, ry) : (pl_shift){ 0, 0 };
    return (pl_shift){ rx + s.x, ry + s.y };
}

// Half of the periods to either side: see nearest_image in narrow/lanes.h.
static double between(double from, double to, double shift)
{
    return (to + shift / 2) - (from - shift / 2);
}

pl_shift pl_wrap_between(const plumb_world *world, uint32_t p, uint32_t q)
{
    const pl_pose *a = &pl_poses(world)[world->pieces.body[p]];
    const pl_pose *b = &pl_poses(world)[world->pieces.body[q]];
    pl_shift s = { 0, 0 };
    if (pl_is_wrapped(world)) {
        pl_shift middle = middle_of(world, p);
        s = pl_wrap_piece(world, q, middle.x, middle.y);
    }
    return (pl_shift){ between((double)a->x, (double)b->x, s.x),
                       between((double)a->y, (double)b->y, s.y) };
}

pl_box pl_wrap_box(const plumb_world *world, pl_box box)
{
    pl_shift s = pl_wrap_shift(world, ((double)box.min_x + (double)box.max_x) / 2,
                               ((double)box.min_y + (double)box.max_y) / 2);
    return (pl_box){ box.min_x + (real)s.x, box.min_y + (real)s.y, box.max_x + (real)s.x,
                     box.max_y + (real)s.y };
}

//---- bodies --------------------------------------------------------------------------------------

// `v` in [-period/2, period/2). Exact: fmod is, and adding the period to what is beyond the edge.
static real brought_back(real v, real period)
{
    const real half = period / 2;
    if (v >= -half && v < half) {
        return v;
    }
    if (!(v >= -period - half && v < period + half)) {
        v = (real)fmod((double)v, (double)period);
    }
    return v >= half ? v - period : v < -half ? v + period : v;
}

// True when the centre was beyond an edge. Beyond it reals may lie twice as far apart as within: what rounding
// took there is given back. `look` is what sleep compares the centre with.
static bool bring_back(real *center, real *low, real *look, real period)
{
    real v = period > 0 ? brought_back(*center, period) : *center, by = v - *center;
    if (by == 0) {
        return false;
    }
    double exact = (double)v + (double)*low;
    *center = (real)exact;
    *low = (real)(exact - (double)*center);
    *look += by;
    return true;
}

void pl_wrap_row(plumb_world *world, uint32_t row)
{
    pl_bodies *b = &world->bodies;
    bool x =
        bring_back(&b->center_x[row], &b->residual_x[row], &b->rest_x[row], world->desc.wrap_x);
    bool y =
        bring_back(&b->center_y[row], &b->residual_y[row], &b->rest_y[row], world->desc.wrap_y);
    if (x || y) {
        pl_body_update_origin(world, row);
    }
}

void pl_wrap_bodies(plumb_world *world)
{
    for (uint32_t row = 0; row < world->dynamic_count + world->kinematic_count; ++row) {
        pl_wrap_row(world, row);
    }
}

//---- public --------------------------------------------------------------------------------------

plumb_vec2 plumb_world_wrapped(const plumb_world *world, plumb_vec2 point)
{
    if (world == NULL || !pl_is_wrapped(world)) {
        return point;
    }
    const real x = world->desc.wrap_x, y = world->desc.wrap_y;
    return plumb_v2(x > 0 ? brought_back(point.x, x) : point.x,
                    y > 0 ? brought_back(point.y, y) : point.y);
}

plumb_vec2 plumb_world_way(const plumb_world *world, plumb_vec2 from, plumb_vec2 to)
{
    double dx = (double)to.x - (double)from.x, dy = (double)to.y - (double)from.y;
    pl_shift s = { 0, 0 };
    if (world != NULL && pl_is_wrapped(world)) {
        s = pl_wrap_shift(world, dx, dy);
    }
    return plumb_v2((real)between((double)from.x, (double)to.x, s.x),
                    (real)between((double)from.y, (double)to.y, s.y));
}
