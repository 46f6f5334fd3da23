// fracture.h - what a body that is divided is made into, and what broke by itself since the last step.
#ifndef PL_TABLE_FRACTURE_H
#define PL_TABLE_FRACTURE_H

#include "core/memory.h"
#include "geometry/region.h"
#include "plumb/fracture.h"

// A convex piece of a body, or what one cell has of it.
typedef struct pl_fragment {
    uint32_t piece;       // slot of the piece that it is of
    uint32_t cell;        // in which it lies
    uint32_t child;       // fragments of one child touch; numbered from 0
    uint32_t part, parts; // first of its convex parts, how many. None: the piece as it is
    double area;          // [m^2] arcs included
    double x, y;          // [m] a point within
    double min_x, min_y, max_x, max_y; // [m] its box, in the body's frame
} pl_fragment;

typedef struct pl_fragment_part {
    plumb_convex convex;
    uint32_t inner; // bit k: edge k is an inner one
} pl_fragment_part;

// What becomes one body.
typedef struct pl_child {
    plumb_body body;
    double weight; // [kg], or [m^2] of a body without mass: density times area
    double area;   // [m^2]
    double min_x, min_y, max_x, max_y;
} pl_child;

// A body that breaks when the next step begins.
typedef struct pl_pending_break {
    plumb_body body, other;
    plumb_vec2 point;    // [m]
    plumb_vec2 normal;   // unit, from the body to the other
    plumb_real impulse;  // [N s]
    plumb_real energy;   // [J] that it took
} pl_pending_break;

typedef struct pl_row_velocity {
    plumb_real vx, vy; // [m/s]
    plumb_real w;      // [rad/s]
} pl_row_velocity;

typedef struct pl_fracture {
    pl_buffer fragments, parts, children, shapes; // scratch; shapes: uint32_t, first pieces of the body's shapes
    uint32_t fragment_count, part_count, child_count, shape_count;
    pl_buffer breaks;   // plumb_body_break since the last step
    pl_buffer pieces;   // plumb_body: what they broke into
    uint32_t break_count, piece_count;
    bool events_told;   // the step that made them is over
    pl_buffer pending;  // pl_pending_break, in the order of contacts
    uint32_t pending_count;
    pl_buffer before;   // pl_row_velocity of each body when the step began; scratch
} pl_fracture;

#endif
