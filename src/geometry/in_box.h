// in_box.h - what a triangle has of an upright box.
#ifndef PL_IN_BOX_H
#define PL_IN_BOX_H

typedef struct pl_in_box {
    double area, x, y; // its centroid; where the area is 0, no place
} pl_in_box;

// Of a triangle, counter-clockwise, and the box from (low_x, low_y) to (high_x, high_y). Triangles that share sides add up to what
// they cover together, to rounding.
pl_in_box pl_triangle_in_box(const double x[3], const double y[3], double low_x, double low_y,
                             double high_x, double high_y);

#endif
