// swept_motion.h - the way of a body through the step just taken, and its pieces on that way.
#ifndef PL_SWEPT_MOTION_H
#define PL_SWEPT_MOTION_H

#include "geometry/sweep.h"
#include "world/wrap.h"

// A point of the body, its pivot, moves in a straight line at a constant rate while the body turns
// about it at a constant rate. Both ends are those of the step.
typedef struct pl_swept_motion {
    double ox, oy; // [m] origin of what follows
    double lx, ly; // [m] pivot in the body's frame
    double px, py; // [m] pivot at the start
    double dx, dy; // [m] its way
    double c, s;   // rotation at the start
    double angle;  // [rad] turned, whole turns included
} pl_swept_motion;

// Centre of mass [m] and rotation at a time of a motion.
typedef struct pl_place {
    double x, y, c, s;
} pl_place;

// Of a body that was noted. It turns about its centre of mass, but about a hinge that holds it to
// something which dynamics does not move.
pl_swept_motion pl_swept_motion_of_mover(const plumb_world *world, const pl_mover *mover, double ox,
                                         double oy);
// Whether it is one of those that turn about their centre, in a straight line. O(joints of the body).
bool pl_swept_motion_is_free(const plumb_world *world, uint32_t row);
// Of any other body: at rest, or moved by a step of dt [s] to where it is.
pl_swept_motion pl_swept_motion_of_row(const plumb_world *world, uint32_t row, real dt, double ox,
                                       double oy);
// Of a body that goes straight from one place to another while it turns by `angle`.
pl_swept_motion pl_swept_motion_between(const plumb_world *world, uint32_t row, pl_place from,
                                        pl_place to, double angle);

// Without the origin: world coordinates.
pl_place pl_swept_motion_place(const plumb_world *world, uint32_t row,
                               const pl_swept_motion *motion, double time);
// The body stays where it is from `time` on; the way after that and its turn are dropped.
pl_swept_motion pl_swept_motion_stopped(const pl_swept_motion *motion, double time);

pl_swept pl_swept_motion_piece(const plumb_world *world, uint32_t piece,
                               const pl_swept_motion *motion);
// In a world that wraps around: by what to shift a motion so that a piece of the body begins nearest to a place
// [m, world].
pl_shift pl_swept_motion_image(const plumb_world *world, const pl_swept_motion *motion,
                               uint32_t piece, double x, double y);
// A box around all places of a piece on its way, in world coordinates.
pl_box pl_swept_motion_box(const pl_swept_motion *motion, const pl_swept *piece);

#endif
