// surface.h - what surfaces have beyond friction and restitution mixed by default.
#ifndef PL_SURFACE_H
#define PL_SURFACE_H

#include "world/state.h"

// Some material in use asks for more than the default mix; *reason says so or not.
bool pl_surfaces_wanted(const plumb_world *world, const char **reason);
// Some pair's restitution may differ from the larger of the two.
bool pl_restitution_is_mixed(const plumb_world *world);
// Mixes anew: rules, pair table, rolling resistance, surface speed; then sums up.
void pl_surfaces_mix(plumb_world *world);

// Users tell speeds along ground as they see them: positive is to +x on what is level, whichever way y points. Inside,
// positive is along the outward normal turned clockwise. Either into the other.
static inline real pl_rightward(const plumb_world *world, real speed)
{
    return world->desc.y_axis == PLUMB_Y_DOWN ? -speed : speed;
}

// [m/s] at which the surface of a piece runs along its normal turned clockwise; 0 where nothing grips it.
static inline real pl_belt_speed(const plumb_world *world, uint32_t piece)
{
    const uint32_t material = world->pieces.material[piece];
    const real speed = world->materials.surface_speed[material];
    return world->materials.friction[material] > 0 ? pl_rightward(world, speed) : 0;
}

// Friction of a contact while it sticks, and once it slides.
typedef struct pl_grip {
    near_real sticks, slides;
} pl_grip;

// [m/s] what is new, or bears nothing, slides if it is faster; so does what stuck and was given such a speed.
#define PL_SLIDES_FROM ((near_real)0.01)

pl_grip pl_surface_grip(const plumb_world *world, const pl_manifold *m);

// The summary of the manifolds as they are now.
void pl_narrow_summarise(pl_narrow *narrow);

#endif
