// cone.h - sets of outward normals that a corner allows, and their intersections. Pure functions.
#ifndef PL_CONE_H
#define PL_CONE_H

#include <stdbool.h>

#include "math/compare.h"

typedef enum pl_cone_form {
    PL_CONE_NONE, // no normal
    PL_CONE_ARC,  // from lo counter-clockwise to hi, at most half a turn; lo = hi: one normal
    PL_CONE_ENDS  // lo and hi, nothing between: the two sides of a line
} pl_cone_form;

// lo and hi are unit vectors. {0} allows nothing.
typedef struct pl_cone {
    double lo_x, lo_y, hi_x, hi_y;
    pl_cone_form form;
} pl_cone;

// True when the angle between two unit vectors is at most `angle` [rad], which is small.
static inline bool pl_directions_agree(double ax, double ay, double bx, double by, double angle)
{
    double across = ax * by - ay * bx;
    return ax * bx + ay * by > 0 && across <= angle && across >= -angle;
}

// True when the cone has a normal within `angle` [rad] of the unit vector (x, y).
bool pl_cone_contains(const pl_cone *cone, double x, double y, double angle);

// What both allow. Ends of `other` within `angle` of an end of `own` count as that end.
pl_cone pl_cone_meet(const pl_cone *own, const pl_cone *other, double angle);

// True when the cone is one normal, or the two sides of a line: no corner stands out there.
static inline bool pl_cone_is_flat(const pl_cone *cone)
{
    return cone->form == PL_CONE_ENDS ||
           (cone->form == PL_CONE_ARC && cone->lo_x == cone->hi_x && cone->lo_y == cone->hi_y);
}

#endif
