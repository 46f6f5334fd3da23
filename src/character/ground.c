// ground.c - a character walks: along the ground, over steps, off edges.
//
// Grown by the character's shape, the ground is a smooth line of edges and arcs; walking goes along
// it by its length, so the way does not depend on the step. A piece of the way goes along the
// tangent, then back onto the line against the normal: third order in the length of a piece.
//
// - Ahead, ground that is not too steep becomes the new ground; a steep face is climbed like ground if
//   it is that of a step: a tread that is wide enough, no higher than step_height above the last
//   floor, and room to stand there. Everything else is a wall.
// - Where the line bends down, it is followed if a probe finds floor within snap_distance below the
//   middle of the foot. Over an edge it is followed only as far as weight holds it on the arc,
//   v^2 <= g R cos a, as on any hump; faster, it flies off at the tangent.
//
// Reads: obstacles. Writes: place, ground. Cost: O(obstacles) a piece of an eighth of the half width.
#include "world/island.h"
#include "query/query.h"
#include "narrow/surface.h"
#include "character/walker.h"

#include <math.h>

#define PIECES    256
#define SAME      1e-9 // [m]
#define EDGE      1e-3 // [-] of the half width: how exactly the end of the ground is found
#define TURNED    1e-8 // [-] of a cosine: normals nearer than this are one
#define OVERSHOOT 1.5 // [-] how far a piece looks for the line beside it: tangents up to 56 degrees
#define TOUCHING  1e-6 // [m] what counts as contact where the ground is not followed

static void move_by(pl_walker *m, double dx, double dy)
{
    m->x += dx;
    m->y += dy;
    m->c->rise += pl_up(m, dx, dy);
}

// The touch becomes the ground.
static void set_ground(pl_walker *m, const pl_touch *t)
{
    pl_character *c = m->c;
    const pl_obstacle *o = t->obstacle;
    double x, y, vx, vy;
    m->nx = t->nx, m->ny = t->ny;
    if (pl_is_floor(m, t->nx, t->ny)) {
        c->rise = 0;
        c->climbs = false;
    }
    pl_walker_touch_point(m, t, &x, &y);
    pl_obstacle_velocity(o, x, y, &vx, &vy);
    const double belt = (double)pl_belt_speed(m->world, o->piece);
    vx += belt * t->ny, vy -= belt * t->nx;
    c->on_ground = true;
    c->ground = (pl_ground){
        .body = m->world->bodies.entity[o->row],
        .shape = m->world->pieces.shape[o->piece],
        .point = { (real)((double)m->start.x + x), (real)((double)m->start.y + y) },
        .normal = { (real)t->nx, (real)t->ny },
        .velocity = { (real)vx, (real)vy },
        .spin = (real)o->w,
    };
}

void pl_walker_stand(pl_walker *m, const pl_touch *t)
{
    pl_character *c = m->c;
    c->climbs = false;
    c->rise = 0;
    m->landed = true;
    set_ground(m, t);
    c->speed = (real)pl_right(m, (double)(c->velocity.x - c->ground.velocity.x),
                              (double)(c->velocity.y - c->ground.velocity.y));
    if (!pl_is_floor(m, t->nx, t->ny)) { // wedged between two slopes
        m->nx = m->ux, m->ny = m->uy;
    }
}

void pl_walker_take_along(pl_walker *m, plumb_vec2 ground)
{
    m->c->left = (real)pl_right(m, (double)ground.x, (double)ground.y);
}

void pl_walker_leave_ground(pl_walker *m)
{
    pl_character *c = m->c;
    uint32_t row = pl_body_row(m->world, c->ground.body);
    if (row != PL_NONE) {
        pl_walker_rouse(m->world, row); // it bears him no more
    }
    pl_walker_take_along(m, c->ground.velocity);
    c->velocity.x = (real)((double)c->ground.velocity.x + (double)c->speed * m->ny);
    c->velocity.y = (real)((double)c->ground.velocity.y - (double)c->speed * m->nx);
    c->on_ground = c->climbs = false;
    c->rise = 0;
    c->ground = (pl_ground){ 0 };
}

bool pl_walker_settle(pl_walker *m, double reach)
{
    pl_touch t;
    if (m->c->climbs) { // a face that is upright is not below
        double dx = -m->skin * m->nx, dy = -m->skin * m->ny;
        if (pl_walker_sweep(m, dx, dy, &t)) {
            move_by(m, t.fraction * dx, t.fraction * dy);
            set_ground(m, &t);
            return true;
        }
    }
    if (!pl_walker_sweep(m, -reach * m->ux, -reach * m->uy, &t) || !pl_is_floor(m, t.nx, t.ny)) {
        return false;
    }
    move_by(m, -reach * t.fraction * m->ux, -reach * t.fraction * m->uy);
    set_ground(m, &t);
    return true;
}

//---- steps ---------------------------------------------------------------------------------------

// [m] height of the floor that was last stood on, along up.
static double base_height(const pl_walker *m)
{
    return pl_up(m, m->x, m->y) + m->foot - m->skin - m->c->rise;
}

// Height of the tread behind a face that is met at t. False: it has none, or not at this height.
static bool find_tread(const pl_walker *m, const pl_touch *t, double side, double *height)
{
    double x, y;
    pl_walker_touch_point(m, t, &x, &y);
    double base = base_height(m), top = base + m->step_height + m->skin / 2;
    double along = pl_right(m, x, y) + side * m->step_width;
    double drop = m->step_height + m->skin / 2 - SAME;
    pl_touch tread;
    bool inside;
    if (!pl_walker_probe(m, along * m->rx + top * m->ux, along * m->ry + top * m->uy, -drop * m->ux,
                         -drop * m->uy, &tread, &inside) ||
        inside || !pl_is_floor(m, tread.nx, tread.ny)) {
        return false;
    }
    *height = top - tread.fraction * drop;
    return *height <= base + m->step_height + SAME && *height >= pl_up(m, x, y) - m->skin;
}

static bool is_step(pl_walker *m, const pl_touch *t, double side)
{
    double height;
    if (!(m->step_height > 0) || !find_tread(m, t, side, &height)) {
        return false;
    }
    // Room to stand up there, and to come there.
    pl_walker up = *m;
    pl_touch blocked;
    double lift = height - (pl_up(m, m->x, m->y) + m->foot - m->skin) + SAME;
    if (lift > 0 && pl_walker_sweep(&up, lift * m->ux, lift * m->uy, &blocked)) {
        return false;
    }
    up.x += lift * m->ux;
    up.y += lift * m->uy;
    double forth = side * m->step_width;
    if (pl_walker_sweep(&up, forth * m->rx, forth * m->ry, &blocked) &&
        !pl_is_floor(m, blocked.nx, blocked.ny)) {
        return false;
    }
    m->c->climbs = true;
    m->c->step_top = m->c->rise + lift;
    return true;
}

//---- edges ---------------------------------------------------------------------------------------

// Floor below the middle of the foot, no farther down than the ground is followed.
static bool has_floor_below(const pl_walker *m)
{
    double from = pl_up(m, m->x, m->y) + m->foot + m->half_width;
    double depth = from - (base_height(m) - m->snap);
    double along = pl_right(m, m->x, m->y) + m->middle;
    pl_touch t;
    bool inside;
    return pl_walker_probe(m, along * m->rx + from * m->ux, along * m->ry + from * m->uy,
                           -depth * m->ux, -depth * m->uy, &t, &inside) &&
           pl_is_floor(m, t.nx, t.ny);
}

// Whether weight holds it on the arc where the normal is (nx, ny).
static bool is_held(const pl_walker *m, double nx, double ny)
{
    double pull = -(m->gravity_x * nx + m->gravity_y * ny);
    double v = (double)m->c->speed;
    return v * v <= pull * (m->shape.radius + m->skin);
}

static bool may_follow(const pl_walker *m, const pl_touch *t)
{
    double up = pl_up(m, t->nx, t->ny), was = pl_up(m, m->nx, m->ny);
    if (m->c->climbs && up >= was - TURNED) {
        return up > 0 || was <= TURNED; // up the step
    }
    bool is_floor = pl_is_floor(m, t->nx, t->ny);
    if (t->nx * m->nx + t->ny * m->ny > 1 - TURNED || up > was) {
        return is_floor;
    }
    return has_floor_below(m) ? up > 0 : is_floor && is_held(m, t->nx, t->ny);
}

// Back onto the ground after a piece of the way. False: it has left it.
static bool follow(pl_walker *m, double piece)
{
    pl_touch t;
    double reach = m->snap > 0 ? OVERSHOOT * piece : TOUCHING;
    double dx = -reach * m->nx, dy = -reach * m->ny;
    if (pl_walker_sweep(m, dx, dy, &t) && may_follow(m, &t)) {
        move_by(m, t.fraction * dx, t.fraction * dy);
        m->c->climbs |= !pl_is_floor(m, t.nx, t.ny);
        set_ground(m, &t);
        return true;
    }
    return m->snap > 0 && has_floor_below(m) && pl_walker_settle(m, m->snap);
}

//---- walking -------------------------------------------------------------------------------------

// [m] how far to go in one piece; over the top of an upright step, no farther than that.
static double next_piece(pl_walker *m, double left, double longest, double side)
{
    double piece = pl_least(left, longest);
    if (!m->c->climbs) {
        return piece;
    }
    double climb = side * pl_up(m, m->ny, -m->nx); // of the tangent
    double rest = m->c->step_top - m->c->rise;
    if (climb > 0 && rest <= SAME) { // at the top: on, across it
        m->nx = m->ux, m->ny = m->uy;
        return piece;
    }
    return climb > 0 ? pl_least(piece, rest / climb) : piece;
}

// A wall: the way ends here.
static void stop_at(pl_walker *m, const pl_touch *t, double side)
{
    pl_character *c = m->c;
    double tx = side * m->ny, ty = -side * m->nx;
    double into = -(tx * t->nx + ty * t->ny);
    double approach = fabs((double)c->speed) * into;
    pl_walker_tell(m, t, approach);
    c->at_wall = true;
    if (t->obstacle->is_dynamic && m->push_force > 0) {
        pl_walker_push(m, t, fabs((double)c->walk) * into);
    } else {
        c->speed = 0;
    }
}

// It leans against what is just ahead: a body that keeps pace with it is still pushed.
static void lean(pl_walker *m, double side)
{
    pl_touch t;
    double dx = 2 * m->skin * side * m->ny, dy = -2 * m->skin * side * m->nx;
    if (!m->pushed && m->push_force > 0 && pl_walker_sweep(m, dx, dy, &t) &&
        !pl_is_floor(m, t.nx, t.ny) && t.obstacle->is_dynamic) {
        double into = -(side * m->ny * t.nx - side * m->nx * t.ny);
        m->c->at_wall = true;
        pl_walker_push(m, &t, fabs((double)m->c->walk) * into);
    }
}

double pl_walker_walk(pl_walker *m, double way, double time)
{
    double side = way < 0 ? -1 : 1, left = fabs(way), longest = m->half_width / 8;
    for (int i = 0; i < PIECES && left > SAME; ++i) {
        double piece = next_piece(m, left, longest, side);
        double dx = piece * side * m->ny, dy = -piece * side * m->nx;
        pl_touch t;
        if (!pl_walker_sweep(m, dx, dy, &t)) {
            pl_walker before = *m;
            double rise = m->c->rise;
            move_by(m, dx, dy);
            if (follow(m, piece)) {
                left -= piece;
            } else if (piece > EDGE * m->half_width) { // to where the ground ends, by halves
                *m = before;
                m->c->rise = rise;
                longest = piece / 2;
            } else {
                pl_walker_leave_ground(m);
                return time * (left - piece) / fabs(way);
            }
            continue;
        }
        move_by(m, t.fraction * dx, t.fraction * dy);
        left -= t.fraction * piece;
        if (!pl_is_floor(m, t.nx, t.ny) &&
            !(pl_up(m, t.nx, t.ny) > -SAME && is_step(m, &t, side))) {
            stop_at(m, &t, side);
            return 0;
        }
        set_ground(m, &t);
    }
    if (way != 0) {
        lean(m, side);
    }
    return 0;
}
