/// separation.h - how far the hinges of a scene have come apart, from the poses alone.
#ifndef BENCH_SEPARATION_H
#define BENCH_SEPARATION_H

#include "scene.h"

/// Distances between the anchors of hinges at one moment.
struct separation {
    double sum;  ///< [m]
    double max;  ///< [m]
    long hinges; ///< counted
};

/// Measures the hinges of which both bodies are there in `step` and not astray. An anchor is the point of
/// the body that was at the hinge when it was made. Cost: O(hinges).
struct separation separation_measure(const struct scene *scene, const struct engine_pose *poses,
                                     int step);

#endif
