// fluid.h - volumes of fluid as a step has them: sensors of a fluid material, and who is in them.
#ifndef PL_FLUID_H
#define PL_FLUID_H

#include "geometry/immersed.h"
#include "world/state.h"

struct pl_tide; // the surface of a volume near a body (waves.h)

// A piece of a sensor of a fluid that somebody is near.
typedef struct pl_volume {
    uint32_t piece, material;  // row of the material
    double up_x, up_y;         // against gravity
    double bottom;             // [m] lowest place of the shape, upwards from the centre of its body
    double origin_x, origin_y; // [m] of its body, from the centre of that, at the start of the step
    int top;                   // the plane against gravity, if there is one
    double grain;              // [m] over which its local flow changes; 0: it has none
    bool restless;             // nobody falls asleep in it
    int plane_count;
    pl_half_plane
        planes[PL_HALF_PLANES_MOST]; // about the centre of its body, at the start of the step
} pl_volume;

// A body of the solver that is near some of them.
typedef struct pl_swimmer {
    uint32_t slot, first, count; // its immersions
    double mass, inertia;        // [kg], [kg m^2] its own; 0: it does not turn
    double lent;                 // [kg] of the fluid
    bool restless;               // it does not fall asleep there
} pl_swimmer;

// In gusts, eddies and waves nobody falls asleep: whether the piece is of a volume with such.
bool pl_fluid_is_restless(const plumb_world *world, uint32_t piece);
// The volume that a piece of a sensor of a fluid is.
void pl_fluid_volume(const plumb_world *world, uint32_t piece, pl_volume *out);

// Who is near a volume, before the solver's slots are given out; where the immersed bodies are, behind it, and the mass that
// the fluid lends them. False when out of memory.
bool pl_fluids_find(plumb_world *world);
bool pl_fluids_immerse(plumb_world *world);

// The outline of what of a piece is in a volume, about its body's centre of mass, when that has moved by (dx, dy) and
// turned by da since the step began, `time` [s] ago; *away gets the way from there to the volume's body. tide: of the surface
// near it; NULL: it is still.
void pl_fluid_contour(const plumb_world *world, const pl_volume *volume, const struct pl_tide *tide,
                      uint32_t piece, const double moved[3], double time, pl_contour *out,
                      double away[2]);

// Across the flow, n . x from low to high [m] in the world, n the flow's direction turned by a quarter counter-clockwise: there
// `share` of the flow is kept off.
typedef struct pl_shade {
    double low, high, share;
} pl_shade;

// Shades that an immersion has: apart from one another, rising.
typedef struct pl_shadow {
    uint32_t first, count;
} pl_shadow;

// What stands behind what, as the step begins. False when out of memory.
bool pl_shelter_find(plumb_world *world);

// The flow [m/s] of a volume's fluid against its body that is the same everywhere, but for gusts and the layer at its
// bottom, at a place [m] in the world at a time [s].
void pl_fluid_flow(const plumb_world *world, const pl_volume *volume, double x, double y,
                   double height, double time, double out[2]);

// All of the flow [m/s], the motion of the volume's body included, at the place (x, y) [m] in the world that is `from` the centre of
// that body, `since` [s] after the step began.
void pl_fluid_velocity(const plumb_world *world, const pl_volume *volume, double x, double y,
                       const double from[2], double since, double out[2]);

//---- local_flow.c --------------------------------------------------------------------------------

// How far apart places are that a volume's local flow must be asked at; 0: it has none.
double pl_local_grain(const plumb_world *world, uint32_t material);
// The flow that is another at each place, on top of pl_fluid_flow, at a place relative to the centre of the volume's body, `since` [s]
// after the step began.
void pl_local_flow(const plumb_world *world, const pl_volume *volume, double x, double y,
                   double since, double out[2]);
// Acceleration [m/s^2] there of what flows at `flow` in all.
void pl_local_acceleration(const plumb_world *world, const pl_volume *volume, double x, double y,
                           double since, const double flow[2], double out[2]);

// What is in a volume.
typedef struct pl_immersed {
    const plumb_world *world;
    const pl_volume *volume;
    double away[2]; // [m] from its centre to the volume's body
    double since;   // [s] since the step began
} pl_immersed;

// Drag on an outline at velocities u against the even flow (pl_contour_drag): adds to the matrix, and to force and torque.
void pl_local_drag(const pl_immersed *in, const pl_contour *contour, pl_spin u, double pressure,
                   double skin, pl_drag *drag, double force[3]);

#endif
