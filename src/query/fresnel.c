// fresnel.c - see fresnel.h: the equations of Fresnel for what does not conduct (Born and Wolf, 1.5.2).
//
// Reads: arguments. Writes: the answer. Cost: a root.
#include "query/fresnel.h"

#include <math.h>

static double square(double x)
{
    return x * x;
}

pl_fresnel pl_fresnel_at(double n1, double n2, double cosine)
{
    pl_fresnel f = { { 1, 1 }, n1 / n2, 0 };
    const double sine_sq = (1 - cosine) * (1 + cosine);
    const double rest = 1 - square(f.ratio) * sine_sq;
    // At the critical angle itself, and at a grazing ray, nothing goes through.
    if (!(rest > 0 && cosine > 0)) {
        return f;
    }
    f.cosine = sqrt(rest);
    // By the ratio alone: an index of any size has no square that is lost.
    const double s = (f.ratio * cosine - f.cosine) / (f.ratio * cosine + f.cosine);
    const double p = (cosine - f.ratio * f.cosine) / (cosine + f.ratio * f.cosine);
    f.reflected[0] = square(s);
    f.reflected[1] = square(p);
    return f;
}
