/// penetration.h - how deep the shapes of a scene overlap, from their poses alone.
///
/// Independent of every engine: no manifold, no broad phase and no geometry code of theirs.
#ifndef BENCH_PENETRATION_H
#define BENCH_PENETRATION_H

#include "scene.h"

/// A convex shape in world coordinates: points as in struct scene_shape.
struct convex {
    int count;
    double x[SCENE_MAX_POINTS], y[SCENE_MAX_POINTS]; ///< [m]
    double radius;                                   ///< [m]
};

/// Overlaps at one moment. A pair of shapes counts when its depth is greater than zero.
struct penetration {
    double sum;  ///< [m] of the depths
    double max;  ///< [m]
    double p99;  ///< [m] 99th percentile of the depths
    long pairs;  ///< overlapping
    long astray; ///< bodies with a pose that is not finite or farther than 1 km from the origin
};

/// Measures all pairs of shapes of different bodies of which one at least is dynamic and that are not of
/// one group, of the bodies that are there in `step`. A chain counts by its segments, two-sided. `skin`
/// [m] is added round shapes of two or more points (struct engine, skin). Bodies astray are left out.
/// Returns false when memory runs out. Cost: O(n log n) and the pairs that overlap in x.
bool penetration_measure(const struct scene *scene, const struct engine_pose *poses, int step,
                         double skin, struct penetration *result);

#endif
