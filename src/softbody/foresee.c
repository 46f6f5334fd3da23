// foresee.c - how soft bodies yield to what pushes them, asked for before the step's own passes: the liquid solves for its pressures
// with them.
//
// The step is taken as one substep, with bodies as they go now. What is left of its matrix, inertia with the stiffness and the
// contacts of a whole step, is how nodes answer to impulses: what is stiff yields as one, whatever the mass of its skin, and
// a gas does not yield to what it bears. The passes of the step then begin anew, with the pushes.
//
// Reads: as the passes of step.c. Writes: their scratch, pushes. Cost: a substep; a solution is O(factors).
#include "softbody/softbody.h"

#define PASSES                                                                                     \
    6 // of Newton's iteration: 34 without a bound, for what the liquid presses together springs open without it

bool pl_soft_foresee(plumb_world *world, real dt)
{
    if (!pl_softbodies_find(world, dt)) {
        return false;
    }
    world->softbodies.step->coupled = 0; // bodies are no unknowns
    if (!pl_softbodies_plan(world)) {
        return false;
    }
    pl_soft_newton(world, (double)dt, PASSES);
    return true;
}

void pl_soft_answer(const pl_soft_step *s)
{
    double *x = s->matrix.right;
    pl_soft_solve(&s->matrix, 0, s->matrix.blocks);
    for (size_t i = 0; i < 3 * (size_t)s->matrix.blocks; ++i) {
        x[i] = x[i] - x[i] == 0 ? x[i] : 0; // what is no number would be everywhere
    }
}
