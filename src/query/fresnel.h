// fresnel.h - what becomes of light at a surface between two media.
#ifndef PL_FRESNEL_H
#define PL_FRESNEL_H

// Shares of the power, by polarisation: 0 is across the plane of the world (s), 1 within it (p).
typedef struct pl_fresnel {
    double reflected[2]; // 0..1; the rest goes through
    double ratio;        // index before the surface over the one behind it
    double cosine;       // of the angle behind the surface; 0 where all is reflected
} pl_fresnel;

// From a medium of index n1 into one of n2, both above 0, at an angle of that cosine, 0..1, to the normal.
pl_fresnel pl_fresnel_at(double n1, double n2, double cosine);

#endif
