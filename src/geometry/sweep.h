// sweep.h - two convex pieces that move and turn: how far apart they are, and when they first come
// too near. Plain geometry in double; no world.
#ifndef PL_GEOMETRY_SWEEP_H
#define PL_GEOMETRY_SWEEP_H

#include <stdbool.h>

#include "plumb/geometry.h"

// A rounded convex piece on its way through the step: its pivot moves in a straight line while the
// piece turns about it, both at a constant rate over time 0..1.
typedef struct pl_swept {
    int count;                            // core points, 1..16, counter-clockwise
    double radius;                        // [m] around the core
    double x[PLUMB_POLYGON_MAX_VERTICES]; // [m] core points from the pivot, in world axes at time 0
    double y[PLUMB_POLYGON_MAX_VERTICES];
    double px, py; // [m] pivot at time 0; both pieces from the same origin
    double dx, dy; // [m] way of the pivot from 0 to 1
    double angle;  // [rad] turned from 0 to 1, whole turns included
} pl_swept;

// [m] how far from its pivot a piece reaches, however it is turned.
double pl_swept_reach(const pl_swept *piece);

// The distance of two pieces at one time; negative: the least translation that parts them. It
// holds along a unit normal from B to A.
typedef struct pl_gap {
    double distance; // [m]
    double nx, ny;
} pl_gap;

pl_gap pl_sweep_gap(const pl_swept *a, const pl_swept *b, double time);

// A core at one time, from the common origin, and its points from the pivot.
typedef struct pl_swept_core {
    int count;
    double x[PLUMB_POLYGON_MAX_VERTICES], y[PLUMB_POLYGON_MAX_VERTICES];
    double rx[PLUMB_POLYGON_MAX_VERTICES], ry[PLUMB_POLYGON_MAX_VERTICES];
    double ex[PLUMB_POLYGON_MAX_VERTICES], ey[PLUMB_POLYGON_MAX_VERTICES]; // [-] edges
} pl_swept_core;

typedef struct pl_swept_axis {
    double distance; // [m] of the cores along it
    double nx, ny;   // from B to A
} pl_swept_axis;

// Two pieces about which several questions are asked: what is known of the last time is not computed again.
typedef struct pl_sweep {
    const pl_swept *piece[2];
    double time, axis_time; // of `at`, of `axis`
    bool placed, has_axis, has_edges[2];
    pl_swept_core at[2];
    pl_swept_axis axis;
} pl_sweep;

// The pieces must stay where they are. Fills in no more than it needs to: a pl_sweep is large.
void pl_sweep_open(pl_sweep *s, const pl_swept *a, const pl_swept *b);
pl_gap pl_sweep_gap_at(pl_sweep *s, double time);

// The point of a piece's surface farthest along a unit vector.
void pl_sweep_point(const pl_swept *piece, double time, double nx, double ny, double *x, double *y);

// Where two pieces are nearest at one time. (x, y) is the middle between the nearest points; of edges side by side, that
// of what lies before one another.
typedef struct pl_nearest {
    pl_gap gap;
    double x, y;  // [m] from the common origin
    double opens; // [m] a whole step by which the gap grows there
} pl_nearest;

pl_nearest pl_sweep_nearest_at(pl_sweep *s, double time);

// The first time in [from, to] at which the pieces are nearer than `target` [m], found at a moment
// at which they are at most `tolerance` [m] > 0 farther apart than that and not yet nearer; above
// 1 when there is none. They must be farther apart than target + tolerance at `from`. Early, but
// never late: where the search takes too long, the time up to which it knows that all is well.
double pl_sweep_first(const pl_swept *a, const pl_swept *b, double from, double to, double target,
                      double tolerance);
double pl_sweep_first_of(pl_sweep *s, double from, double to, double target, double tolerance);

// What pl_sweep_first returns for never.
#define PL_SWEEP_NEVER 2.0

// Rounds of pl_sweep_first at the most; a rod of 4 m that turns eight times about in a step and
// passes a post by a millimetre takes 144.
#define PL_SWEEP_ROUNDS 1000

#endif
