/// shots.h - bodies shot at thin walls, through any engine of engine.h: did anything get through?
///
///     struct shot shot = shot_random(&seed, SHOT_BOX, 0.01, SHOT_ROD, 500);
///     struct shot_result r = shot_fire(&engine_plumb, &options, &shot);
///     if (r.missed) ...
///
/// A wall is 1000 m long, made of pieces end to end, turned by any angle. The body starts clear of
/// it on one side and is shot at it, spinning. The referee looks at poses alone, after every step:
/// a shot is missed when the body's centre lies beyond the middle of the wall at any time, or when any
/// part of it is farther than 1 cm beyond the wall's far side at the end, or when it gets to within 2 m of
/// the wall's ends: from there on nobody looks.
#ifndef HARNESS_SHOTS_H
#define HARNESS_SHOTS_H

#include "harness/engine.h"

enum shot_wall { SHOT_BOXES, SHOT_SEGMENTS, SHOT_CHAIN, SHOT_WALLS };
enum shot_body { SHOT_CIRCLE, SHOT_BOX, SHOT_CAPSULE, SHOT_ROD, SHOT_COMPOUND, SHOT_BODIES };

extern const char *const shot_wall_names[SHOT_WALLS];
extern const char *const shot_body_names[SHOT_BODIES];

struct shot {
    enum shot_wall wall;
    enum shot_body body;
    double thickness; ///< [m] of a wall of boxes
    double turned;    ///< [rad] of the wall
    double size;      ///< [m] of the body; a rod is 4 m by 2 cm
    double angle;     ///< [rad] of the body
    double clear;     ///< [m] from its nearest point to the wall
    double speed;     ///< [m/s]
    double incidence; ///< [rad] between its way and the wall's normal
    double spin;      ///< [rad/s]
    double dt;        ///< [s]
    int steps;
};

struct shot_result {
    bool missed;
    double deepest; ///< [m] farthest part of the body beyond the near side of the wall, at any time
};

/// xorshift32: a shot at a wall of this kind and thickness, the rest at random: speeds from 10 to
/// `fastest` [m/s] and spins from 1 to 1000 rad/s evenly on a logarithmic scale (one in five
/// does not spin), incidence from head-on to 89 degrees.
struct shot shot_random(unsigned *seed, enum shot_wall wall, double thickness, enum shot_body body,
                        double fastest);

struct shot_result shot_fire(const struct engine *engine, const struct engine_options *options,
                             const struct shot *shot);

#endif
