// path.c - see path.h. All in double, from A's centre of mass, so that distance from the origin costs no precision.
//
// Reads: poses, velocities, forces, piece geometry. Writes: the answer. Cost: a sweep a leg.
#include "narrow/path.h"

#include "math/compare.h"
#include "math/trig.h"
#include "world/body_settings.h"
#include "world/wrap.h"

#include <math.h>

// Steps of the search for the time at which two pieces are nearest, at the most.
#define SECANTS 8

pl_motion pl_flight_of(const plumb_world *world, uint32_t row, double horizon)
{
    const pl_bodies *b = &world->bodies;
    if (row >= world->dynamic_count + world->kinematic_count) {
        return (pl_motion){ 0, 0, 0 };
    }
    const pl_pose *pose = &pl_poses(world)[row];
    const double own =
        (b->flags[row] & PL_BODY_HAS_SETTINGS) != 0 ? (double)pl_time_scale(world, row) : 1;
    pl_motion f = { (double)pose->vx * horizon, (double)pose->vy * horizon,
                    (double)b->w[row] * own * horizon };
    if (row < world->dynamic_count) {
        const double half = own * own * horizon * horizon / 2;
        const double scale = (double)b->gravity_scale[row], im = (double)b->inv_mass[row];
        f.x += half * ((double)world->gravity.x * scale + (double)b->fx[row] * im);
        f.y += half * ((double)world->gravity.y * scale + (double)b->fy[row] * im);
        f.turn += half * (double)b->torque[row] * (double)b->inv_inertia[row];
    }
    return f;
}

double pl_paths_closed(const pl_paths *p, const pl_manifold_point *point, double nx, double ny,
                       double time)
{
    return pl_motions_closed(pl_path_at(&p->of[0], time), pl_path_at(&p->of[1], time), point, nx,
                             ny);
}

pl_moving_pair pl_moving_pair_of(const plumb_world *world, const pl_pair *pair,
                                 const pl_paths *paths)
{
    const pl_pose *a = &pl_poses(world)[world->pieces.body[pair->a]];
    const pl_pose *b = &pl_poses(world)[world->pieces.body[pair->b]];
    const pl_shift between = pl_wrap_between(world, pair->a, pair->b);
    return (pl_moving_pair){ .world = world,
                             .paths = paths,
                             .piece = { pair->a, pair->b },
                             .px = { 0, between.x + ((double)b->dx - (double)a->dx) },
                             .py = { 0, between.y + ((double)b->dy - (double)a->dy) } };
}

// A side's piece where it is at `from`, on its way until `to`. Filled in place: a pl_swept is large.
static void put_leg(pl_swept *out, const pl_moving_pair *e, int side, double from, double to)
{
    const uint32_t piece = e->piece[side];
    const pl_pieces *pieces = &e->world->pieces;
    const pl_pose *pose = &pl_poses(e->world)[pieces->body[piece]];
    const pl_core *core = &pieces->core[piece];
    const pl_vertex *corner = e->world->vertices.items + pieces->vertices[piece];
    const pl_motion start = pl_path_at(&e->paths->of[side], from);
    const pl_motion end = pl_path_at(&e->paths->of[side], to);
    double c = 1, s = 0;
    if (start.turn != 0) {
        pl_sincos(start.turn, &s, &c);
    }
    // Turned about the centre of mass, after the pose.
    const double tc = c * (double)pose->c - s * (double)pose->s;
    const double ts = s * (double)pose->c + c * (double)pose->s;
    const double dx = c * (double)pose->dx - s * (double)pose->dy;
    const double dy = s * (double)pose->dx + c * (double)pose->dy;
    const bool round = pieces->vertex_count[piece] == 0;
    out->count = round ? 1 : pieces->vertex_count[piece];
    out->radius = (double)core->radius;
    out->px = e->px[side] + start.x, out->py = e->py[side] + start.y;
    out->dx = end.x - start.x, out->dy = end.y - start.y;
    out->angle = end.turn - start.turn;
    for (int i = 0; i < out->count; ++i) {
        const double x = (double)(round ? core->x : corner[i].x);
        const double y = (double)(round ? core->y : corner[i].y);
        out->x[i] = tc * x - ts * y - dx;
        out->y[i] = ts * x + tc * y - dy;
    }
}

// The time in [from, 1] of a leg at which the pieces are nearest, where they close at `from`: the gap of convex pieces
// that do not turn is a convex function of it, for others this is a good guess. By secants of the rate, which changes its
// sign there.
static double nearest_on_leg(pl_sweep *s, double from, pl_nearest *out)
{
    double low = from, high = 1;
    *out = pl_sweep_nearest_at(s, low);
    double closes = -out->opens;
    if (!(closes > 0)) {
        return low;
    }
    *out = pl_sweep_nearest_at(s, high);
    double opens = out->opens, at = high;
    int side = 0; // of the last secants: one that stays is worth half
    for (int i = 0; i < SECANTS && opens > 0; ++i) {
        at = low + (high - low) * closes / (closes + opens);
        *out = pl_sweep_nearest_at(s, at);
        if (fabs(out->opens) * (high - low) < PL_TOI_TOLERANCE) {
            break;
        }
        if (out->opens > 0) {
            high = at, opens = out->opens;
            closes = side == 1 ? closes / 2 : closes;
            side = 1;
        } else {
            low = at, closes = -out->opens;
            opens = side == -1 ? opens / 2 : opens;
            side = -1;
        }
    }
    return at;
}

// [m] how far about its centre of mass the body of a side reaches; HUGE_VAL: nobody keeps count, it stands still.
static double reach_of(const pl_moving_pair *e, int side)
{
    const uint32_t row = e->world->pieces.body[e->piece[side]];
    return row < e->world->dynamic_count + e->world->kinematic_count
               ? (double)e->world->bodies.extent[row]
               : HUGE_VAL;
}

// [-] reach is kept in float, and rounded.
#define REACH_ROUNDED 1e-6

// Whether bodies that reach so far pass by one another on a leg: told by their centres alone, which costs a hundredth of a
// sweep.
static bool passes_by(const pl_moving_pair *e, double from, double to, double reach)
{
    const pl_motion a0 = pl_path_at(&e->paths->of[0], from), a1 = pl_path_at(&e->paths->of[0], to);
    const pl_motion b0 = pl_path_at(&e->paths->of[1], from), b1 = pl_path_at(&e->paths->of[1], to);
    const double x = e->px[1] + b0.x - a0.x, y = e->py[1] + b0.y - a0.y; // of B from A
    const double dx = b1.x - b0.x - (a1.x - a0.x), dy = b1.y - b0.y - (a1.y - a0.y);
    const double way = dx * dx + dy * dy;
    const double t = way > 0 ? pl_lesser(pl_greater(-(x * dx + y * dy) / way, 0), 1) : 0;
    const double nx = x + t * dx, ny = y + t * dy;
    return nx * nx + ny * ny > reach * reach;
}

// First to the contact: most that get here meet, or pass far to one side, which is told at once.
pl_pair_approach pl_moving_pair_approach(const pl_moving_pair *e, int leg, double near)
{
    pl_pair_approach best = { .kind = PL_APPROACH_NONE, .time = PL_SWEEP_NEVER };
    const double reach = (reach_of(e, 0) + reach_of(e, 1)) * (1 + REACH_ROUNDED) +
                         pl_greater(near, PL_TOI_TOLERANCE);
    for (int i = leg; i < e->paths->legs; ++i) {
        const double from = e->paths->breaks[i], to = e->paths->breaks[i + 1];
        if (passes_by(e, from, to, reach)) {
            continue;
        }
        pl_swept a, b;
        put_leg(&a, e, 0, from, to);
        put_leg(&b, e, 1, from, to);
        pl_sweep s;
        pl_sweep_open(&s, &a, &b);
        const double time = pl_sweep_first_of(&s, 0, 1, 0, PL_TOI_TOLERANCE);
        if (time <= 1) {
            return (pl_pair_approach){ PL_APPROACH_MEETS, from + time * (to - from),
                                       pl_sweep_nearest_at(&s, time) };
        }
        const double first = pl_sweep_first_of(&s, 0, 1, near, near / 4);
        if (first > 1) {
            continue;
        }
        pl_nearest nearest;
        const double at = nearest_on_leg(&s, first, &nearest);
        if (nearest.gap.distance < near &&
            (best.kind == PL_APPROACH_NONE || nearest.gap.distance < best.nearest.gap.distance)) {
            best = (pl_pair_approach){ PL_APPROACH_NEAR, from + at * (to - from), nearest };
        }
    }
    return best;
}

pl_pose pl_moving_pair_pose(const pl_moving_pair *e, int side, double time)
{
    const pl_pose *now = &pl_poses(e->world)[e->world->pieces.body[e->piece[side]]];
    const pl_motion m = pl_path_at(&e->paths->of[side], time);
    double c = 1, s = 0;
    if (m.turn != 0) {
        pl_sincos(m.turn, &s, &c);
    }
    const double dx = c * (double)now->dx - s * (double)now->dy;
    const double dy = s * (double)now->dx + c * (double)now->dy;
    return (pl_pose){ .x = (real)(e->px[side] + m.x - dx),
                      .y = (real)(e->py[side] + m.y - dy),
                      .c = (real)((double)now->c * c - (double)now->s * s),
                      .s = (real)((double)now->s * c + (double)now->c * s),
                      .dx = (real)dx,
                      .dy = (real)dy,
                      .vx = now->vx,
                      .vy = now->vy };
}
