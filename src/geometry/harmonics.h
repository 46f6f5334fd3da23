// harmonics.h - integrals of exp(k z + i k x) over an outline, for k, 2k, 3k and so on, in closed form.
//
// By Green's theorem, integral E dA = 1/(ik) closed integral E dz; along a straight edge E = exp(ik(x - iz)) is the exponential of a linear function, so
//     integral E dA = -1/k^2 sum over corners v of d_v E_v,   d_v = c_(v-1) - c_v,   c_e = dz / (dx - i dz) of edge e,
// and, for the torque of a gradient of E about a point that x - iz is counted from, its derivative by k gives
//     integral (x - iz) E dA = -1/k^2 sum of d_v (x - iz)_v E_v - 2i/k^3 sum of d_v E_v.
// E_v of n k is the n-th power of that of k: three complex products a corner and harmonic. Arcs are chords, the area of all made right.
#ifndef PL_HARMONICS_H
#define PL_HARMONICS_H

#include "geometry/immersed.h"

#define PL_CHORDS_OF_TURN 16
// A chord of each arc may be a short one.
#define PL_HARMONICS_MOST (PL_ELEMENTS_MOST + PL_CHORDS_OF_TURN + 4)

typedef struct pl_complex {
    double re, im;
} pl_complex;

static inline pl_complex pl_times(pl_complex a, pl_complex b)
{
    return (pl_complex){ a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re };
}

typedef struct pl_harmonic_corner {
    pl_complex weight, moment; // d, d (x - iz) from the outline's origin
    pl_complex base, power;    // E of k, E of n k
} pl_harmonic_corner;

typedef struct pl_harmonic {
    pl_complex sum;    // [m^2] integral of E
    pl_complex moment; // [m^3] of (x - iz) E from the outline's origin
} pl_harmonic;

typedef struct pl_harmonics {
    pl_harmonic_corner at[PL_HARMONICS_MOST];
    int count, number; // number: n of the integral that was asked for last
    double k, scale;
} pl_harmonics;

// Where an outline lies in a fluid at rest: x = px + x of the outline, z = up (py + y) - slope x below its surface.
typedef struct pl_depths {
    double px, py, up, slope;
    double bottom; // [m] of the fluid below the surface
} pl_depths;

// Of exp(k z + i k x); of its mirror image in the bottom, exp(-k (z + 2 bottom) + i k x), if `mirrored`.
void pl_harmonics_open(const pl_contour *outline, const pl_depths *where, bool mirrored, double k,
                       pl_harmonics *out);
// The next ones: of k, 2 k, 3 k, ...
pl_harmonic pl_harmonics_next(pl_harmonics *h);

#endif
