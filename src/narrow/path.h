// path.h - where bodies will be within the step, as far as its start can tell: they fly on, and impacts turn them aside.
#ifndef PL_NARROW_PATH_H
#define PL_NARROW_PATH_H

#include "geometry/sweep.h"
#include "math/compare.h"
#include "world/state.h"

// [m] that a sweep may end before the pieces meet: less than PL_AHEAD.
#define PL_TOI_TOLERANCE 1e-4

// A way of the centre of mass [m] and a turn [rad].
typedef struct pl_motion {
    double x, y, turn;
} pl_motion;

// Impacts within a step that are known of a body, at the most. What turns it after these is left to the solver.
#define PL_TURNS 4

// A body's way; times are shares of the horizon, the span that is looked ahead.
typedef struct pl_path {
    pl_motion flight; // over the horizon, if nothing is in the way
    int turns;
    double time[PL_TURNS];      // of its impacts, in order
    pl_motion change[PL_TURNS]; // what each of them adds to the flight, over a horizon
} pl_path;

// Free flight over `horizon` [s]: v t + a t^2 / 2 by gravity and forces, no damping.
pl_motion pl_flight_of(const plumb_world *world, uint32_t row, double horizon);

static inline pl_motion pl_path_at(const pl_path *p, double time)
{
    pl_motion m = { p->flight.x * time, p->flight.y * time, p->flight.turn * time };
    for (int i = 0; i < p->turns && p->time[i] < time; ++i) {
        const double after = time - p->time[i];
        m.x += p->change[i].x * after;
        m.y += p->change[i].y * after;
        m.turn += p->change[i].turn * after;
    }
    return m;
}

// The ways of A and B, and what happens when.
typedef struct pl_paths {
    pl_path of[2];
    double breaks[2 * PL_TURNS + 2]; // 0, the impacts of both in order, 1
    int legs;                        // spans between these; breaks[legs] is 1
} pl_paths;

static inline pl_paths pl_paths_of(const pl_path *a, const pl_path *b)
{
    pl_paths p = { .of = { *a, *b } };
    for (int i = 0, k = 0; i < a->turns || k < b->turns;) {
        const bool of_a = k == b->turns || (i < a->turns && a->time[i] < b->time[k]);
        const double next = of_a ? a->time[i++] : b->time[k++];
        if (next > p.breaks[p.legs] && next < 1) {
            p.breaks[++p.legs] = next;
        }
    }
    p.breaks[++p.legs] = 1;
    return p;
}

// [m] that a contact point with these anchors closes along (nx, ny) until a time, with arms that stay as they are:
// as the solver counts it.
double pl_paths_closed(const pl_paths *p, const pl_manifold_point *point, double nx, double ny,
                       double time);
static inline double pl_motions_closed(pl_motion a, pl_motion b, const pl_manifold_point *point,
                                       double nx, double ny)
{
    const double ran = (double)point->ax * ny - (double)point->ay * nx;
    const double rbn = (double)point->bx * ny - (double)point->by * nx;
    return nx * (a.x - b.x) + ny * (a.y - b.y) + ran * a.turn - rbn * b.turn;
}

// Two pieces of bodies that move, seen from A's centre of mass at the start of the step.
typedef struct pl_moving_pair {
    const plumb_world *world;
    const pl_paths *paths;
    uint32_t piece[2];
    double px[2], py[2]; // [m] centres of mass at the start
} pl_moving_pair;

pl_moving_pair pl_moving_pair_of(const plumb_world *world, const pl_pair *pair,
                                 const pl_paths *paths);

// How near two pieces come.
typedef struct pl_pair_approach {
    enum {
        PL_APPROACH_NONE, // never within the distance that is asked for
        PL_APPROACH_NEAR, // about so near, at this time
        PL_APPROACH_MEETS // this is the first time at which they are PL_TOI_TOLERANCE apart or less
    } kind;
    double time;
    pl_nearest nearest; // of then
} pl_pair_approach;

// Sweeps the pieces from the beginning of a leg on; what stays farther apart than `near` [m] is let go.
pl_pair_approach pl_moving_pair_approach(const pl_moving_pair *e, int leg, double near);
// The pose of the body of side 0 (A) or 1 (B) at a time.
pl_pose pl_moving_pair_pose(const pl_moving_pair *e, int side, double time);

#endif
