// swept_motion.c - ways of bodies through the step, from where they were and where they are.
//
// The rotation of the end is known to the last bit but not how often the body turned; the angle by
// which the solver turned it tells the whole turns. All in double, from an origin near the body.
//
// Reads: movers, poses, joints, piece geometry. Writes: nothing. Cost: O(joints of the body); O(corners)
// a piece.
#include "continuous/swept_motion.h"

#include "math/trig.h"
#include "world/joint_list.h"

#include <math.h>

#define TURN 6.283185307179586

// [rad] more than this is not counted in turns: the angle is taken as it is told.
#define MOST_ANGLE 1e12

// The angle from one rotation to another that is nearest to `about`.
static double angle_between(double c0, double s0, double c1, double s1, double about)
{
    if (c0 == c1 && s0 == s1 && fabs(about) < 1) {
        return 0; // most bodies that do not turn
    }
    double angle = pl_atan2(c0 * s1 - s0 * c1, c0 * c1 + s0 * s1);
    if (!(fabs(about) <= MOST_ANGLE)) {
        return angle;
    }
    return angle + TURN * floor((about - angle) / TURN + 0.5);
}

// Whether the other end of a joint is held by the world or by a body that dynamics does not move.
static bool is_held(const plumb_world *world, const pl_joint_end *other)
{
    return plumb_is_null(other->body) || pl_body_row(world, other->body) >= world->dynamic_count;
}

// The end of the body's first hinge to what dynamics does not move; NULL: there is none.
static const pl_joint_end *hinge_of(const plumb_world *world, uint32_t row)
{
    const pl_joint *items = pl_joint_items(&world->joints);
    plumb_body body = world->bodies.entity[row];
    for (uint32_t i = world->bodies.first_joint[row]; i != PL_NONE;
         i = pl_joint_next(&items[i], body)) {
        const pl_joint *j = &items[i];
        bool is_a = plumb_same(j->a.body, body);
        if (j->desc.kind == PLUMB_REVOLUTE && is_held(world, is_a ? &j->b : &j->a)) {
            return is_a ? &j->a : &j->b;
        }
    }
    return NULL;
}

bool pl_swept_motion_is_free(const plumb_world *world, uint32_t row)
{
    const pl_joint_plan *plan = &world->joints.plan;
    return (plan->made && plan->adrift) || hinge_of(world, row) == NULL;
}

// The pivot of a body in its frame: see pl_swept_motion_of_mover.
static plumb_vec2 pivot_of(const plumb_world *world, uint32_t row)
{
    const pl_joint_end *hinge = hinge_of(world, row);
    return hinge != NULL ? hinge->local
                         : plumb_v2(world->bodies.local_x[row], world->bodies.local_y[row]);
}

static pl_place place_now(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    return (pl_place){ (double)b->center_x[row], (double)b->center_y[row], (double)b->c[row],
                       (double)b->s[row] };
}

static pl_swept_motion motion_between(const plumb_world *world, uint32_t row, plumb_vec2 pivot,
                                      pl_place from, pl_place to, double angle)
{
    pl_swept_motion motion = {
        .lx = (double)pivot.x, .ly = (double)pivot.y, .c = from.c, .s = from.s, .angle = angle
    };
    double rx = motion.lx - (double)world->bodies.local_x[row];
    double ry = motion.ly - (double)world->bodies.local_y[row];
    double x1 = to.x + to.c * rx - to.s * ry;
    double y1 = to.y + to.s * rx + to.c * ry;
    motion.px = from.x + from.c * rx - from.s * ry;
    motion.py = from.y + from.s * rx + from.c * ry;
    motion.dx = x1 - motion.px;
    motion.dy = y1 - motion.py;
    return motion;
}

// Coordinates from another origin.
static pl_swept_motion from_origin(pl_swept_motion motion, double ox, double oy)
{
    motion.px -= ox - motion.ox;
    motion.py -= oy - motion.oy;
    motion.ox = ox;
    motion.oy = oy;
    return motion;
}

pl_swept_motion pl_swept_motion_between(const plumb_world *world, uint32_t row, pl_place from,
                                        pl_place to, double angle)
{
    plumb_vec2 center = { world->bodies.local_x[row], world->bodies.local_y[row] };
    pl_swept_motion motion = motion_between(world, row, center, from, to, angle);
    return from_origin(motion, from.x, from.y);
}

pl_swept_motion pl_swept_motion_of_mover(const plumb_world *world, const pl_mover *mover, double ox,
                                         double oy)
{
    uint32_t row = mover->row;
    pl_place from = { (double)mover->x, (double)mover->y, (double)mover->c, (double)mover->s };
    pl_place to = place_now(world, row);
    double angle = angle_between(from.c, from.s, to.c, to.s, (double)mover->angle);
    return from_origin(motion_between(world, row, pivot_of(world, row), from, to, angle), ox, oy);
}

// How far a step of dt moved a body that was not noted: as the solver has it, or as it flies.
static void motion_of(const plumb_world *world, uint32_t row, real dt, double *dx, double *dy,
                      double *angle)
{
    const pl_bodies *b = &world->bodies;
    *dx = *dy = *angle = 0;
    if (row >= world->dynamic_count + world->kinematic_count) {
        return;
    }
    const uint32_t *slots = world->solver.slots.data;
    if (row < world->dynamic_count && world->solver.slot_count > 0 && slots[row] != PL_NONE) {
        const pl_solver_body *body = &pl_solver_bodies(&world->solver)[slots[row]];
        *dx = (double)body->dx, *dy = (double)body->dy, *angle = (double)body->da;
        return;
    }
    *dx = (double)(b->vx[row] * dt), *dy = (double)(b->vy[row] * dt);
    *angle = (double)(b->w[row] * dt);
}

pl_swept_motion pl_swept_motion_of_row(const plumb_world *world, uint32_t row, real dt, double ox,
                                       double oy)
{
    double dx, dy, angle, c = 1, s = 0;
    motion_of(world, row, dt, &dx, &dy, &angle);
    pl_place to = place_now(world, row), from = { to.x - dx, to.y - dy, to.c, to.s };
    if (angle != 0) {
        pl_sincos(-angle, &s, &c);
        from.c = to.c * c - to.s * s;
        from.s = to.s * c + to.c * s;
    }
    return from_origin(pl_swept_motion_between(world, row, from, to, angle), ox, oy);
}

pl_place pl_swept_motion_place(const plumb_world *world, uint32_t row,
                               const pl_swept_motion *motion, double time)
{
    double c, s;
    pl_sincos(motion->angle * time, &s, &c);
    pl_place at = { .c = motion->c * c - motion->s * s, .s = motion->s * c + motion->c * s };
    double rx = motion->lx - (double)world->bodies.local_x[row];
    double ry = motion->ly - (double)world->bodies.local_y[row];
    at.x = motion->ox + (motion->px + motion->dx * time) - (at.c * rx - at.s * ry);
    at.y = motion->oy + (motion->py + motion->dy * time) - (at.s * rx + at.c * ry);
    return at;
}

pl_swept_motion pl_swept_motion_stopped(const pl_swept_motion *motion, double time)
{
    double c, s;
    pl_sincos(motion->angle * time, &s, &c);
    pl_swept_motion at = *motion;
    at.px += motion->dx * time;
    at.py += motion->dy * time;
    at.c = motion->c * c - motion->s * s;
    at.s = motion->s * c + motion->c * s;
    at.dx = at.dy = at.angle = 0;
    return at;
}

// Corner i, given in the body's frame.
static void put_corner(pl_swept *out, int i, const pl_swept_motion *motion, double x, double y)
{
    x -= motion->lx;
    y -= motion->ly;
    out->x[i] = motion->c * x - motion->s * y;
    out->y[i] = motion->s * x + motion->c * y;
}

pl_swept pl_swept_motion_piece(const plumb_world *world, uint32_t piece,
                               const pl_swept_motion *motion)
{
    pl_swept out = { .radius = (double)world->pieces.core[piece].radius,
                     .px = motion->px,
                     .py = motion->py,
                     .dx = motion->dx,
                     .dy = motion->dy,
                     .angle = motion->angle };
    const pl_core *core = &world->pieces.core[piece];
    if (world->pieces.vertex_count[piece] == 0) {
        out.count = 1;
        put_corner(&out, 0, motion, (double)core->x, (double)core->y);
        return out;
    }
    out.count = world->pieces.vertex_count[piece];
    const pl_vertex *v = world->vertices.items + world->pieces.vertices[piece];
    for (int i = 0; i < out.count; ++i) {
        put_corner(&out, i, motion, (double)v[i].x, (double)v[i].y);
    }
    return out;
}

pl_shift pl_swept_motion_image(const plumb_world *world, const pl_swept_motion *motion,
                               uint32_t piece, double x, double y)
{
    if (!pl_is_wrapped(world)) {
        return (pl_shift){ 0, 0 };
    }
    const pl_core *core = &world->pieces.core[piece];
    double lx = (double)core->x - motion->lx, ly = (double)core->y - motion->ly;
    double at_x = motion->ox + motion->px + (motion->c * lx - motion->s * ly);
    double at_y = motion->oy + motion->py + (motion->s * lx + motion->c * ly);
    return pl_wrap_shift(world, at_x - x, at_y - y);
}

typedef struct bounds {
    double min_x, min_y, max_x, max_y;
} bounds;

static void include(bounds *b, double x, double y)
{
    b->min_x = x < b->min_x ? x : b->min_x;
    b->max_x = x > b->max_x ? x : b->max_x;
    b->min_y = y < b->min_y ? y : b->min_y;
    b->max_y = y > b->max_y ? y : b->max_y;
}

pl_box pl_swept_motion_box(const pl_swept_motion *motion, const pl_swept *piece)
{
    bounds b = { HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL };
    double reach_sq = 0, margin = piece->radius;
    double c = 1, s = 0;
    // The arc of a corner bulges beyond its chord by less than r a^2 / 8, up to a half turn.
    bool arc = fabs(piece->angle) < TURN / 2;
    if (arc && piece->angle != 0) {
        pl_sincos(piece->angle, &s, &c);
    }
    for (int i = 0; i < piece->count; ++i) {
        double x = piece->x[i], y = piece->y[i];
        reach_sq = x * x + y * y > reach_sq ? x * x + y * y : reach_sq;
        if (arc) {
            include(&b, x, y);
            include(&b, piece->dx + c * x - s * y, piece->dy + s * x + c * y);
        }
    }
    double reach = sqrt(reach_sq);
    if (arc) {
        margin += reach * piece->angle * piece->angle / 8;
    } else {
        include(&b, 0, 0);
        include(&b, piece->dx, piece->dy);
        margin += reach;
    }
    double x = motion->ox + piece->px, y = motion->oy + piece->py;
    // Rounded outwards: the sum above and the step to the reals of the grid.
    margin += 4 * (double)PLUMB_REAL_EPSILON *
              (fabs(x) + fabs(y) + fabs(piece->dx) + fabs(piece->dy) + reach);
    return (pl_box){ (real)(x + b.min_x - margin), (real)(y + b.min_y - margin),
                     (real)(x + b.max_x + margin), (real)(y + b.max_y + margin) };
}
