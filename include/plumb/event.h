/// event.h - what happened in the last step: arrays, valid until the next step or structural change.
/// There are no callbacks inside the solver.
#ifndef PLUMB_EVENT_H
#define PLUMB_EVENT_H

#include "plumb/world.h"

PLUMB_BEGIN

/// Two shapes began to touch. Order: by shape slots; the same on every run.
typedef struct plumb_contact_begin {
    plumb_shape shape_a, shape_b;
    plumb_body body_a, body_b;
    plumb_vec2 point;          ///< [m] world
    plumb_vec2 normal;         ///< unit, from A to B
    plumb_real approach_speed; ///< [m/s] along the normal just before, >= 0
} plumb_contact_begin;

/// Two shapes ceased to touch, or one of them was removed (its handle is then stale).
typedef struct plumb_contact_end {
    plumb_shape shape_a, shape_b;
    plumb_body body_a, body_b;
} plumb_contact_end;

/// Begin events of the last step; *count is set. Null when there are none.
PLUMB_API const plumb_contact_begin *plumb_world_begin_events(const plumb_world *world, int *count);
/// End events of the last step; *count is set. Null when there are none.
PLUMB_API const plumb_contact_end *plumb_world_end_events(const plumb_world *world, int *count);

/// A point of a manifold after the step.
typedef struct plumb_contact_point {
    plumb_vec2 point;           ///< [m] world, midway between the surfaces
    plumb_real separation;      ///< [m] negative when overlapping
    plumb_real normal_impulse;  ///< [N s] over the last substep, >= 0
    plumb_real tangent_impulse; ///< [N s] over the last substep
    uint32_t feature;           ///< which corner or edge made it: stable from step to step
} plumb_contact_point;

/// A touching pair.
typedef struct plumb_contact {
    plumb_shape shape_a, shape_b;
    plumb_body body_a, body_b;
    plumb_vec2 normal; ///< unit, from A to B
    plumb_real friction;
    plumb_real restitution;
    int point_count; ///< 1 or 2
    plumb_contact_point points[2];
} plumb_contact;

/// Touching contacts after the last step: writes up to `capacity`, returns how many there are.
/// Separations are those of the narrow phase at the beginning of the step moved along with the bodies.
PLUMB_API int plumb_world_contacts(const plumb_world *world, plumb_contact *contacts, int capacity);
/// The same for one body. O(contacts of the world).
PLUMB_API int plumb_body_contacts(const plumb_world *world, plumb_entity body, plumb_contact *contacts,
                                  int capacity);

PLUMB_END

#endif
