// track.c - kinematic bodies on their way to a pose at which they arrive with a velocity.
//
// The centre of mass and the angle go by cubics of time from pose and velocity now to pose and velocity then (Hermite): of the
// tracks that meet all four the one of least degree, as keyframes of animation are joined. Where a constant velocity or
// acceleration meets them, that is the cubic. With the way D, velocities u and v and the time T
//     x(t) = u t + a t^2 / 2 + j t^3 / 6,   a = 6 D / T^2 - (4 u + 2 v) / T,   j = 6 (u + v) / T^2 - 12 D / T^3.
//
// Between steps the body's velocity is that of the moment. During a step it is the mean over the step, so that all who ask where
// it goes know; within a substep the solver has the mean over that, by which it moves and contacts are solved, and
// where they are relaxed the velocity of its end: what stands on it bears m (g + x''), to second order.
//
// A body that arrives within a step goes on with the velocity for the rest of it: one keyframe after the other, whatever the steps,
// without a jerk. Where it arrives with the step, or at rest, the pose is the target's, bit for bit. A track that is shorter than the step
// is spread over it. Reads: tracks. Writes: velocities and poses of their bodies, solver bodies. Cost: O(tracks) a step, a substep
// and cluster.
#include "effects/effects.h"
#include "plumb/math.h"
#include "world/body_settings.h"
#include "world/check.h"
#include "world/rows.h"
#include "world/wrap.h"

#include <math.h>

// [-] of the step: a rest below this is rounding.
#define REST 1e-4

#define TURN 6.283185307179586476925

static pl_track *items(const plumb_world *world)
{
    return (pl_track *)world->tracks.items.data;
}

//---- the cubic -------------------------------------------------------------------------------------

static pl_track_axis axis_of(double way, double from, double to, double time)
{
    return (pl_track_axis){
        .speed = from,
        .rate = (6 * way / time - (4 * from + 2 * to)) / time,
        .jerk = (6 * (from + to) - 12 * way / time) / (time * time),
    };
}

static double speed_at(const pl_track_axis *x, double t)
{
    return x->speed + t * (x->rate + t * x->jerk / 2);
}

// Between the moments s and t, over t - s.
static double mean_of(const pl_track_axis *x, double s, double t)
{
    return x->speed + x->rate * (s + t) / 2 + x->jerk * (s * s + s * t + t * t) / 6;
}

// What a step follows: cubics, and behind them the velocity.
typedef struct leg {
    pl_track_axis axis[3]; // x, y, angle
    double since, until;   // [s] of the step's beginning, of the arrival
    double end[3];         // velocity
    bool arrives;
} leg;

static leg leg_of(const pl_track *track, double dt)
{
    leg l = { .since = track->time - track->left,
              .until = track->time,
              .arrives = track->left - dt <= REST * dt };
    const bool spread = dt - track->time > REST * dt;
    for (int k = 0; k < 3; ++k) {
        const pl_track_axis *x = &track->axis[k];
        l.end[k] = track->end[k];
        l.axis[k] =
            spread ? axis_of(track->time * mean_of(x, 0, track->time), x->speed, track->end[k], dt)
                   : *x;
    }
    l.since = spread ? 0 : l.since;
    l.until = spread || fabs(dt - track->left) <= REST * dt ? l.since + dt : l.until;
    return l;
}

static double leg_speed_at(const leg *l, int k, double t)
{
    return t <= l->until ? speed_at(&l->axis[k], t) : l->end[k];
}

static double leg_mean_of(const leg *l, int k, double s, double t)
{
    const double met = t < l->until ? t : l->until;
    if (s >= met) {
        return l->end[k];
    }
    return ((met - s) * mean_of(&l->axis[k], s, met) + (t - met) * l->end[k]) / (t - s);
}

static bool waits(const plumb_world *world, uint32_t row)
{
    return (world->bodies.flags[row] & PL_BODY_DISABLED) != 0 || pl_time_scale(world, row) == 0;
}

// An image may hold a cubic that nothing can follow.
static double bounded(double v)
{
    return fabs(v) <= (double)PL_LARGEST ? v : 0;
}

// In the body's own time, as columns have it; a body whose time stands still has what it will go on with.
static void set_velocity(plumb_world *world, uint32_t row, const double v[3])
{
    pl_bodies *b = &world->bodies;
    const double scale = (double)pl_time_scale(world, row), rate = scale > 0 ? 1 / scale : 1;
    b->vx[row] = pl_poses(world)[row].vx = (real)bounded(v[0] * rate);
    b->vy[row] = pl_poses(world)[row].vy = (real)bounded(v[1] * rate);
    b->w[row] = (real)bounded(v[2] * rate);
}

static void set_velocity_of(plumb_world *world, const pl_track *track)
{
    const double t = track->time - track->left;
    const double v[3] = { speed_at(&track->axis[0], t), speed_at(&track->axis[1], t),
                          speed_at(&track->axis[2], t) };
    set_velocity(world, pl_body_row(world, track->body), v);
}

//---- on the way ------------------------------------------------------------------------------------

// The shorter way, or with as many turns more as the angular velocities would make.
static double turn_of(double shorter, double from, double to, double time)
{
    return shorter + TURN * floor(((from + to) / 2 * time - shorter) / TURN + 0.5);
}

static pl_track track_of(const plumb_world *world, uint32_t row, plumb_transform to,
                         const double end[3], double time)
{
    const pl_bodies *b = &world->bodies;
    const real scale = pl_time_scale(world, row), pace = scale > 0 ? scale : 1;
    const plumb_vec2 local = { b->local_x[row], b->local_y[row] };
    const plumb_vec2 here = { b->center_x[row], b->center_y[row] };
    const plumb_vec2 way = plumb_world_way(world, here, plumb_transform_apply(to, local));
    const plumb_rot turn = plumb_rot_inv_mul((plumb_rot){ b->c[row], b->s[row] }, to.q);
    const double now[3] = { (double)(b->vx[row] * pace), (double)(b->vy[row] * pace),
                            (double)(b->w[row] * pace) };
    const double angle = turn_of((double)plumb_rot_angle(turn), now[2], end[2], time);
    const double ways[3] = { (double)way.x, (double)way.y, angle };
    pl_track track = {
        .body = b->entity[row], .x = to.p.x, .y = to.p.y, .turn = to.q, .time = time, .left = time
    };
    for (int k = 0; k < 3; ++k) {
        track.axis[k] = axis_of(ways[k], now[k], end[k], time);
        track.end[k] = end[k];
    }
    return track;
}

// No faster than that anything may be: at most 3 D / 2 T + u + v.
static bool is_sane(const pl_track *track)
{
    bool sane = true;
    for (int k = 0; k < 3; ++k) {
        const double most = 3 * fabs(mean_of(&track->axis[k], 0, track->time)) / 2 +
                            fabs(track->axis[k].speed) + fabs(track->end[k]);
        sane = sane && most <= (double)PL_LARGEST && isfinite(track->axis[k].rate) &&
               isfinite(track->axis[k].jerk);
    }
    return sane;
}

plumb_result plumb_body_set_target_moving(plumb_world *world, plumb_body body, plumb_vec2 position,
                                          plumb_real angle, plumb_vec2 velocity,
                                          plumb_real angular_velocity, plumb_real dt)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    PL_TRY(pl_place_check(world, __func__, position, angle));
    PL_TRY(pl_check_within(world, __func__, "velocity", velocity, PL_LARGEST));
    PL_TRY(pl_check_finite(world, __func__, "angular_velocity", angular_velocity));
    PL_TRY(pl_target_check(world, __func__, row, dt));
    const double end[3] = { (double)velocity.x, (double)velocity.y, (double)angular_velocity };
    const pl_track track =
        track_of(world, row, (plumb_transform){ position, plumb_rot_make(angle) }, end, (double)dt);
    if (!is_sane(&track)) {
        return pl_fail(world, PLUMB_E_RANGE, __func__,
                       "dt is %g; on its way the body would be faster than %g m/s or rad/s",
                       (double)dt, (double)PL_LARGEST);
    }
    pl_tracks *tracks = &world->tracks;
    if (!pl_buffer_reserve(&world->memory, &tracks->items,
                           ((size_t)tracks->count + 1) * sizeof(pl_track))) {
        return pl_fail_memory(world, __func__);
    }
    pl_target_forget(world, row);
    items(world)[tracks->count++] = track;
    world->bodies.flags[row] |= PL_BODY_TARGETED;
    world->schedule_dirty = true;
    set_velocity_of(world, &track);
    return PLUMB_OK;
}

void pl_tracks_reaim(plumb_world *world, uint32_t row)
{
    for (uint32_t i = 0; i < world->tracks.count; ++i) {
        if (plumb_same(items(world)[i].body, world->bodies.entity[row])) {
            set_velocity_of(world, &items(world)[i]);
        }
    }
}

//---- in a step -------------------------------------------------------------------------------------

void pl_tracks_open(plumb_world *world, real dt)
{
    for (uint32_t i = 0; i < world->tracks.count; ++i) {
        const pl_track *track = &items(world)[i];
        const uint32_t row = pl_body_row(world, track->body);
        if (waits(world, row)) {
            continue;
        }
        const leg l = leg_of(track, (double)dt);
        const double end = l.since + (double)dt;
        const double v[3] = { leg_mean_of(&l, 0, l.since, end), leg_mean_of(&l, 1, l.since, end),
                              leg_mean_of(&l, 2, l.since, end) };
        set_velocity(world, row, v);
    }
}

void pl_tracks_undo(plumb_world *world)
{
    for (uint32_t i = 0; i < world->tracks.count; ++i) {
        if (!waits(world, pl_body_row(world, items(world)[i].body))) {
            set_velocity_of(world, &items(world)[i]);
        }
    }
}

// The solver's bodies of the cluster get a velocity of the substep: its mean, or that of its end.
static void drive(const pl_substep *s, bool ends)
{
    plumb_world *world = s->world;
    const pl_solver *solver = &world->solver;
    const pl_slots slots = s->cluster->slots[1];
    const double h = (double)s->h, dt = h * s->count;
    const uint32_t movable = world->dynamic_count + world->kinematic_count;
    for (uint32_t i = 0; i < world->tracks.count; ++i) {
        const pl_track *track = &items(world)[i];
        const uint32_t row = pl_body_row(world, track->body);
        const uint32_t slot = waits(world, row) ? PL_NONE : pl_solver_slot(solver, row, movable);
        if (slot < slots.first || slot - slots.first >= slots.count) {
            continue;
        }
        const leg l = leg_of(track, dt);
        const double from = l.since + s->number * h, to = from + h;
        double v[3];
        for (int k = 0; k < 3; ++k) {
            v[k] = bounded(ends ? leg_speed_at(&l, k, to) : leg_mean_of(&l, k, from, to));
        }
        pl_solver_body *body = &pl_solver_bodies(solver)[slot];
        body->vx = (near_real)v[0], body->vy = (near_real)v[1], body->w = (near_real)v[2];
    }
}

void pl_tracks_begin(const pl_substep *s)
{
    drive(s, false);
}

void pl_tracks_end(const pl_substep *s)
{
    drive(s, true);
}

// Puts the body where it is `rest` [s] after its arrival: its centre goes straight on, about which it turns.
static void place_behind(plumb_world *world, uint32_t row, const pl_track *track, double rest)
{
    pl_bodies *b = &world->bodies;
    b->x[row] = track->x, b->y[row] = track->y;
    b->c[row] = track->turn.c, b->s[row] = track->turn.s;
    if (rest > 0) {
        const plumb_vec2 local = { b->local_x[row], b->local_y[row] };
        const plumb_rot on =
            plumb_rot_mul(track->turn, plumb_rot_make((real)(track->end[2] * rest)));
        const plumb_vec2 before = plumb_rot_apply(track->turn, local),
                         behind = plumb_rot_apply(on, local);
        b->x[row] += before.x - behind.x + (real)(track->end[0] * rest);
        b->y[row] += before.y - behind.y + (real)(track->end[1] * rest);
        b->c[row] = on.c, b->s[row] = on.s;
    }
    pl_body_update_center(world, row);
}

void pl_tracks_arrive(plumb_world *world, real dt)
{
    pl_bodies *b = &world->bodies;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < world->tracks.count; ++i) {
        pl_track track = items(world)[i];
        const uint32_t row = pl_body_row(world, track.body);
        if (waits(world, row)) {
            items(world)[kept++] = track;
            continue;
        }
        const leg l = leg_of(&track, (double)dt);
        const double rest =
            l.since + (double)dt - l.until; // 0 to the bit where it arrives with the step (leg_of)
        track.left -= (double)dt;
        if (!l.arrives) {
            items(world)[kept++] = track;
            set_velocity_of(world, &track);
            continue;
        }
        place_behind(world, row, &track, rest);
        set_velocity(world, row, track.end);
        b->flags[row] &= (uint16_t)~PL_BODY_TARGETED;
    }
    world->schedule_dirty |= kept == 0;
    world->tracks.count = kept;
}
