// bundle.h - the constraints of W contacts, as the kernels keep them over a step (contact.simd.c; symbols
// there). Included by *.simd.c only.
#ifndef PL_BUNDLE_H
#define PL_BUNDLE_H

#include "core/wide.h"
#include "solver/solver.h"

typedef struct point {
    vf ran, rbn, rat, rbt; // [m]
    vf separation;         // [m] at the start of the step
    vf kn;                 // [1/kg] inverse effective mass along the normal
    vf give;               // [1/kg] softness: how much an impulse gives way
    vf mt;                 // [kg] effective mass along the tangent
    vf ln, lt;             // [N s]
} point;

typedef struct bundle {
    uint32_t a[PL_WIDTH], b[PL_WIDTH]; // solver slots
    vf nx, ny;
    vf friction;
    vf bias_rate; // [1/s] softness: the push for each metre of overlap
    vf k01;       // [1/kg] what an impulse at one point does to the other
    vf pushed;    // [N s] most of a point after any substep so far
    point p[2];
} bundle;

#endif
