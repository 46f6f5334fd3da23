// trig.h - sine, cosine and arc tangent in double, the same bits on every compiler and machine.
// What plumb_sincos and plumb_atan2 round to plumb_real; geometry uses them for its own doubles.
#ifndef PL_TRIG_H
#define PL_TRIG_H

/// Sine and cosine of an angle [rad]; NaN for NaN and infinity. See plumb_sincos.
void pl_sincos(double angle, double *sine, double *cosine);

/// Angle of (x, y) [rad], -pi..pi; NaN when either is not finite. See plumb_atan2.
double pl_atan2(double y, double x);

#endif
