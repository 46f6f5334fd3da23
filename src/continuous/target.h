// target.h - how deep two pieces may be in one another at the end of a sweep.
//
// Resting and sliding bodies sink a little into what carries them, so the surfaces as such may be
// passed; what must not be passed is the middle of either piece. The sum of the half widths, `thick`,
// is about the depth at which a contact would part them to the wrong side:
//
//     0        LEAST                thick / 2            0.9 thick
//     |----------|----------------------|--------------------|------
//       always     where the body already    only what it      lost: no side can be told,
//       allowed    lies deep: so deep and    began with, and   the pair is left to the contact
//                  LEAST more                ever less more
//
// LEAST is 5 mm, for thin pairs a quarter of `thick`. Lines against lines (thick 0) may not touch.
#ifndef PL_TARGET_H
#define PL_TARGET_H

#include <stdbool.h>

#define PL_TARGET_LEAST 0.005 // [m]

typedef struct pl_sweep_target {
    double distance;  // [m] not to be undercut; negative: depth
    double tolerance; // [m] of the search for it
} pl_sweep_target;

static inline bool pl_target_is_lost(double thick, double depth)
{
    return depth >= 0.9 * thick;
}

// For pieces that begin `depth` [m] deep (negative: apart), of a body that lies `sunk` [m] deep
// somewhere. They must not be lost.
static inline pl_sweep_target pl_target_of(double thick, double depth, double sunk)
{
    double least = thick / 4 < PL_TARGET_LEAST ? thick / 4 : PL_TARGET_LEAST;
    double deep = depth > sunk ? depth : sunk;
    double allowed = deep > 0 ? deep + least : least;
    allowed = allowed < thick / 2 ? allowed : thick / 2;
    if (allowed < depth + least / 2) {
        double rest = (0.9 * thick - depth) / 8;
        allowed = depth + (rest < least / 2 ? rest : least / 2);
    }
    double room = (allowed - depth) / 4;
    double fine = least > 0 ? least / 4 : 1e-5;
    return (pl_sweep_target){ -allowed, room < fine ? room : fine };
}

#endif
