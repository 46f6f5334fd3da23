// immersed.h - what of a convex shape lies within half planes, and what a fluid there does to it: area, centroid, and the
// matrix of drag, in closed form.
//
// The outline of a shape is a closed row of edges and arcs. Cut by a half plane it is one again, with an edge more where
// it was cut. All coordinates are relative to the point that torques are about.
#ifndef PL_IMMERSED_H
#define PL_IMMERSED_H

#include "plumb/geometry.h"

#include <stdint.h>

// The points with n . x <= d.
typedef struct pl_half_plane {
    double nx, ny, d; // unit, [m]
} pl_half_plane;

// A round shape has 2 elements a corner, a circle 4; each half plane adds at most 2.
#define PL_HALF_PLANES_MOST 26
#define PL_ELEMENTS_MOST    (2 * PLUMB_POLYGON_MAX_VERTICES + 2 * PL_HALF_PLANES_MOST + 4)

// From its start to that of the next one, counter-clockwise.
typedef struct pl_element {
    double x, y;      // [m] start
    double cx, cy, r; // [m] of an arc, which turns by less than pi; r 0: it is an edge
    bool cut;         // a half plane made it: nothing of the shape's surface
    bool inner;       // likewise: a cut between pieces of one shape
} pl_element;

typedef struct pl_contour {
    pl_element at[PL_ELEMENTS_MOST];
    int count; // 0: nothing is left
} pl_contour;

// The outline of a shape in `frame`, relative to (x, y) [m]; bit k of `inner`: edge k is an inner cut. Segments, which
// have no area, are edges on both sides.
void pl_contour_of(const plumb_convex *shape, uint32_t inner, plumb_transform frame, double x,
                   double y, pl_contour *out);
// What of it lies in the half plane.
void pl_contour_cut(pl_contour *outline, pl_half_plane by);

// Area [m^2] and its first moments [m^3].
typedef struct pl_area {
    double area, x, y;
} pl_area;

pl_area pl_contour_area(const pl_contour *outline);

// The half planes of which a shape is made, with its corners sharp; of circles and capsules 24 and their sides. Returns
// how many.
int pl_half_planes_of(const plumb_convex *shape, plumb_transform frame, double x, double y,
                      pl_half_plane out[PL_HALF_PLANES_MOST]);

// A symmetric matrix over (vx, vy, w).
typedef struct pl_drag {
    double xx, xy, yy, xw, yw, ww;
} pl_drag;

// Velocity of a rigid motion: of the point that coordinates are relative to [m/s], [rad/s].
typedef struct pl_spin {
    double vx, vy, w;
} pl_spin;

// The drag of a fluid on all elements that are no cuts, at velocities v of the shape relative to it. Surfaces that go
// ahead feel pressure / 2 (v . n)^2 against their normal, all feel skin / 2 |v . t| v . t along their tangent, both
// [kg/m^2], the density times a coefficient. With N the force of n on (vx, vy, w), and T that of t, v . n = N . v, so
//     D = integral (pressure max(0, v . n) N N' + skin |v . t| T T') ds,
// the force is -D v / 2, and its derivative -D.
void pl_contour_drag(const pl_contour *outline, pl_spin v, double pressure, double skin,
                     pl_drag *drag);
// Of one element, up to where the next one starts.
void pl_element_drag(const pl_element *e, const pl_element *next, pl_spin v, double pressure,
                     double skin, pl_drag *drag);

// Adds the force -D v / 2 to a force and a torque.
void pl_drag_force(const pl_drag *drag, pl_spin v, double force[3]);

// [m], [m^3] the width of all cuts across the unit vector (x, y), towards which they face, and its second moment: how
// a surface there pushes back.
typedef struct pl_waterline {
    double width, second;
} pl_waterline;

pl_waterline pl_contour_waterline(const pl_contour *outline, double x, double y);

#endif
