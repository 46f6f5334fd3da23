/// event.h - what happened in the last step: arrays, valid until the next step or structural change.
/// There are no callbacks inside the solver. Whom the liquid touches is told in plumb/liquid.h.
///
/// What outlives what. Events are told of what was there in the step; whatever is destroyed afterwards, they stay as
/// they are until the next step (ask for an array again after a structural change: it may have moved). A handle in an
/// event may be stale: plumb_same still tells which one it is, for slots that are used again have other handles,
/// and every call catches it. After a destruction the next step (of dt 0, too) tells
/// - the end of each contact that was touching, asleep or not: with the handles of before;
/// - the end of each overlap with a sensor, or of a sensor, asleep or not: likewise;
/// - nothing of joints: only what breaks by itself tells that it broke, its handle being stale by then.
/// Sleep, wake, begin and strain events and quarantines are of what was alive when they were told; so are hits, but
/// for that of a blow which went on beyond the step that has its begin event.
///
/// Two shapes touch in a step when an impulse passed between them in any of its substeps, or their surfaces
/// overlapped at its beginning. What touched goes on to touch while it is nearer than half a millimetre: what lies against a wall
/// without being pressed there neither ends nor begins. So an impact is told whatever the speed, restitution, solver
/// and number of substeps, and once: a ball that bounces within a step begins in it, and ends in the next one that
/// finds it away. Of one pair a step tells a begin or an end, not both; what parts and meets again between two
/// steps in a row touches on. But a shape whose form is another (plumb_shape_set_geometry, plumb_body_scale, cut, merged)
/// is met anew: touches that go on end and begin in one step, and the end is of the touch before.
///
/// A body that lies on several flush tiles of one material touches each of them, and events tell so; what
/// they bear together is told as impulses of one of those contacts, the others have none. Which of the tiles are
/// told follows from the ground as a whole: one beside which the body lies by a few centimetres may be among them.
#ifndef PLUMB_EVENT_H
#define PLUMB_EVENT_H

#include "plumb/world.h"

PLUMB_BEGIN

/// Two shapes began to touch. A pair of shapes tells it once, however many pieces they have. Order: by
/// kinds and slots of pieces, then shapes of several pieces; the same on every run.
typedef struct plumb_contact_begin {
    plumb_shape shape_a, shape_b;
    plumb_body body_a, body_b;
    plumb_vec2 point;          ///< [m] world: on the surface that no contact moves; of two dynamic bodies,
                               ///< midway between them at the start of the step
    plumb_vec2 normal;         ///< unit, from A to B
    plumb_real approach_speed; ///< [m/s] along the normal just before, >= 0: at the moment where there is
                               ///< restitution or hit_speed is set, else at the start of the step
} plumb_contact_begin;

/// Two shapes ceased to touch: they were apart at the beginning of the step and nothing passed between them in it.
/// Or one of them was removed (its handle and perhaps that of its body are
/// then stale), disabled with its body, made a sensor, of a body whose type meets the other no more, or is kept apart
/// from now on. Bodies that sleep are no exception. So whoever counts begins and ends is always right.
typedef struct plumb_contact_end {
    plumb_shape shape_a, shape_b;
    plumb_body body_a, body_b;
} plumb_contact_end;

/// Begin events of the last step. What a kinematic character meets is told by plumb_character_hits. *count is set. Null when there are none.
PLUMB_API const plumb_contact_begin *plumb_world_begin_events(const plumb_world *world, int *count);
/// End events of the last step; *count is set. Null when there are none.
PLUMB_API const plumb_contact_end *plumb_world_end_events(const plumb_world *world, int *count);

/// Two shapes struck each other faster than plumb_world_desc.hit_speed, touching before or not; not told
/// again while the blow lasts. One a pair of shapes and step, at their fastest point. A blow of which the last
/// substep of a step sees only the beginning is told a step after its begin event, as a whole. Order as of begin
/// events.
typedef struct plumb_contact_hit {
    plumb_shape shape_a, shape_b;
    plumb_body body_a, body_b;
    plumb_vec2 point;          ///< [m] world, as of plumb_contact_begin
    plumb_vec2 normal;         ///< unit, from A to B
    plumb_real approach_speed; ///< [m/s] along the normal just before the fastest blow of the step
    plumb_real moment;         ///< [s] 0..dt, of that blow since the step began: it was at `time` - dt + moment, within
                               ///< a substep. Negative, to -dt of the step before: a hit of that step, told now
    plumb_real impulse;        ///< [N s] of the whole contact along the normal over the step, or the two
} plumb_contact_hit;

/// Hit events of the last step; *count is set. Null when there are none.
PLUMB_API const plumb_contact_hit *plumb_world_hit_events(const plumb_world *world, int *count);
/// Changes the speed [m/s] above which hits are told; 0: none are.
/// Errors: E_RANGE, E_NOT_FINITE, E_LOCKED.
PLUMB_API plumb_result plumb_world_set_hit_speed(plumb_world *world, plumb_real speed);

/// A body that a step would have left without a finite state, or with one beyond 1e12 m, m/s or rad/s: it is
/// taken out of the simulation; where contacts or joints overflow, as many of those concerned as it takes, the
/// fastest first. It stays where it was before the step, at rest and disabled
/// (plumb_body_set_enabled brings it back); to every other body it is as if it had been disabled before the step,
/// bit for bit, unless `pass` is "motion" (it flew, or was carried, beyond the bounds: then what it touched in the
/// step counts). Systems of PLUMB_PHASE_CONTACTS may be called more than once in such a step; what they
/// did to contacts before does not count.
typedef struct plumb_quarantine {
    plumb_body body;
    const char *pass; ///< that left it so: "calls" (before the step: a velocity, a force), "begin systems", "force
                      ///< systems", "contact systems", "soft step", "classic solver", "motion"
} plumb_quarantine;

#define PLUMB_QUARANTINE_MAX 16 ///< most that are told of a step; plumb_stats.arrested_count counts all

/// Bodies taken out in the last step, in the order in which they were found; *count is set. Null when there
/// are none.
PLUMB_API const plumb_quarantine *plumb_world_quarantine_events(const plumb_world *world, int *count);

/// A shape began or ceased to overlap a sensor. Two sensors that meet tell it of each.
typedef struct plumb_sensor_event {
    plumb_shape sensor, shape; ///< of an end event, either may be stale
    plumb_body sensor_body, body;
} plumb_sensor_event;

/// Shapes that began to overlap a sensor in the last step, sorted by slot of sensor, then shape.
PLUMB_API const plumb_sensor_event *plumb_world_sensor_begin_events(const plumb_world *world,
                                                                    int *count);
/// Shapes that ceased to, or that are gone, or whose sensor is. Same order.
PLUMB_API const plumb_sensor_event *plumb_world_sensor_end_events(const plumb_world *world, int *count);

/// A contact of this step before the solver, as a system of PLUMB_PHASE_CONTACTS may change it. Fields
/// with a star are taken by plumb_contact_edit_set, the others are for reading.
typedef struct plumb_contact_edit {
    plumb_shape shape_a, shape_b;
    plumb_body body_a, body_b;
    plumb_vec2 normal;        ///< unit, from A to B
    int point_count;          ///< 1 or 2
    plumb_vec2 points[2];     ///< [m] world, midway between the surfaces
    plumb_real separation[2]; ///< [m] negative when overlapping
    bool touching;            ///< it touched in the step before
    bool enabled;             ///< * false: in this step the shapes pass through each other, untouched
    /// * [-] 0..10; of surfaces with a kinetic friction that of the state they are in, and what is set instead is both
    plumb_real friction;
    plumb_real restitution;        ///< * [-] 0..10
    plumb_real rolling_resistance; ///< * [m] >= 0
    plumb_real surface_speed;      ///< * [m/s] of both surfaces together: see plumb_material_desc
    plumb_real adhesion;           ///< * [N] >= 0 that the contact may pull once it touches
} plumb_contact_edit;

/// How many contacts this step has: touching ones and those that may touch within it, but not those of
/// sleeping bodies. -1 on error.
/// Errors: E_STATE (not called by a system of PLUMB_PHASE_CONTACTS).
PLUMB_API int plumb_contact_edit_count(const plumb_world *world);
/// Contact i; order: by kinds and slots of pieces. O(1). Errors: E_STATE, E_RANGE (i), E_NULL.
PLUMB_API plumb_result plumb_contact_edit_get(const plumb_world *world, int i, plumb_contact_edit *edit);
/// Changes contact i for this step; the next one makes it anew. O(1).
/// Errors: E_STATE, E_RANGE, E_NOT_FINITE, E_NULL.
PLUMB_API plumb_result plumb_contact_edit_set(plumb_world *world, int i, const plumb_contact_edit *edit);

/// A point of a manifold after the step.
typedef struct plumb_contact_point {
    plumb_vec2 point;                ///< [m] world, midway between the surfaces
    plumb_real separation;           ///< [m] negative when overlapping
    plumb_real normal_impulse;       ///< [N s] over the last substep, >= 0; negative: adhesion pulls
    plumb_real tangent_impulse;      ///< [N s] over the last substep, on B along (-normal.y, normal.x)
    plumb_real step_impulse;         ///< [N s] along the normal over the whole step, impacts included; 0 unless
                                     ///< plumb_world_desc.contact_impulses or hit_speed is set
    plumb_real step_tangent_impulse; ///< [N s] likewise along the tangent
    uint32_t feature;                ///< which corner or edge made it: stable from step to step
} plumb_contact_point;

/// A touching pair. Where two bodies touch by several shapes on one line, points between others of theirs may be left out: they bear
/// nothing that those do not.
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
/// The same for one body. Cost: its contacts, and those of its island where it sleeps; as long as no step has ended since bodies were
/// first asked, all that touch and are awake (2 ns each).
PLUMB_API int plumb_body_contacts(const plumb_world *world, plumb_body body,
                                  plumb_contact *contacts, int capacity);

PLUMB_END

#endif
