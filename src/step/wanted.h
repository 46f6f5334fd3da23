// wanted.h - which passes a world wants, and why: *reason (a static string) says so. Which variants of their
// kernels run.
#ifndef PL_WANTED_H
#define PL_WANTED_H

#include "step/pass.h"

typedef bool pl_want_fn(const plumb_world *world, const char **reason);
pl_want_fn pl_want_broad, pl_want_caps, pl_want_classic, pl_want_collision, pl_want_continuous,
    pl_want_damping, pl_want_edges, pl_want_feet, pl_want_gravity, pl_want_impacts, pl_want_joints,
    pl_want_reactions, pl_want_internal_edges, pl_want_sensing, pl_want_sleep, pl_want_soft,
    pl_want_solver, pl_want_sums, pl_want_surfaces, pl_want_targets, pl_want_waking;

typedef int pl_variants_fn(const plumb_world *world, const char *out[PL_VARIANTS_MAX]);
pl_variants_fn pl_contact_variants, pl_gather_variants, pl_motion_variants, pl_narrow_variants;

#endif
