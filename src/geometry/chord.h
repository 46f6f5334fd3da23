// chord.h - where a line meets a convex shape.
#ifndef PL_CHORD_H
#define PL_CHORD_H

#include <stdbool.h>

// Chord of the line x = at with a convex shape of n corners, counter-clockwise, and a radius; false: none. Corners y, x, the
// other way round, for y = at.
bool pl_chord(const double *x, const double *y, int n, double radius, double at, double *low,
              double *high);
// The chords of several such lines, in ascending order. Where there is none the low end is above the high one.
void pl_chords(const double *x, const double *y, int n, double radius, const double *at, int count,
               double *low, double *high);

#endif
