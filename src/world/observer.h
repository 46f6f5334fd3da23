// observer.h - how a step tells whoever records or replays it (src/record) what it is about.
//
// A step of a world without an observer asks once a phase whether there is one. Within a step the order is:
// `begin` once commands were carried out, `before` and `after` around the systems of each phase that
// runs, `dropping` and `dropped` around each component that is taken from what the step destroys (joints that
// break): its hook runs in between; `passed` after each pass, `end` (not of a step that is refused). Where `replays` is set, neither commands nor systems run: what
// they did is put in their place by `begin` and `after`.
#ifndef PL_OBSERVER_H
#define PL_OBSERVER_H

#include "plumb/ecs.h"

typedef struct pl_step_observer {
    bool replays;
    bool steps; // between `begin` and the end of the step
    // Members may be NULL. `self` is the observer.
    void (*begin)(struct pl_step_observer *self, plumb_world *world);
    void (*before)(struct pl_step_observer *self, plumb_world *world, plumb_phase phase);
    void (*after)(struct pl_step_observer *self, plumb_world *world, plumb_phase phase);
    void (*dropping)(struct pl_step_observer *self, plumb_world *world);
    void (*dropped)(struct pl_step_observer *self, plumb_world *world);
    void (*passed)(struct pl_step_observer *self, plumb_world *world, int pass);
    void (*end)(struct pl_step_observer *self, plumb_world *world, plumb_real dt);
    // The world is about to be destroyed.
    void (*gone)(struct pl_step_observer *self, plumb_world *world);
} pl_step_observer;

#endif
