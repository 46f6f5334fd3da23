/// scene_steps.h - how many steps of a shipped scene the tests here take: fewer of those whose steps take long.
#ifndef DETERMINISM_SCENE_STEPS_H
#define DETERMINISM_SCENE_STEPS_H

#include "plumb/plumb.h"

#include "harness/trials.h"

/// `usual` of a light scene, a tenth of one with soft bodies or thousands of bodies, a quarter of one with many hundred cells
/// of air or liquid; TRIALS=10 of all of them. By what is in the world, not by a clock, so that hashes can be compared.
static inline int scene_steps(const plumb_world *w, int usual)
{
    const size_t image = plumb_world_snapshot_size(w);
    const plumb_stats stats = plumb_world_stats(w);
    const int part = stats.soft_count > 0 || stats.body_count > 1000 ? 10 : image > 90000 ? 4 : 1;
    const double steps = usual / part * trials_asked("TRIALS", 1);
    return steps > usual ? usual : steps < 1 ? 1 : (int)steps;
}

#endif
