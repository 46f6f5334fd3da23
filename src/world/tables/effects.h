// effects.h - settings and targets of the few bodies that have them; what a step needs of effects.
#ifndef PL_TABLE_EFFECTS_H
#define PL_TABLE_EFFECTS_H

#include "core/memory.h"
#include "world/columns.h"

// Damping, caps and time scale of a body, and whatever else a row of src/schema stores here. All defaults: it has no
// record.
#define PL_SETTINGS_MEMBER(name, initial) real name;

typedef struct pl_body_settings {
    plumb_body body;
    PL_BODY_ROWS(PL_ROW_RECORD, PL_SETTINGS_MEMBER)
    real fuel_low, mass_low; // [kg] what rounding took from what is left, of an engine that burns
#define PL_SETTINGS_LOW offsetof(pl_body_settings, fuel_low)
    real pull_x, pull_y, pull_tip; // [m/s^2] of mutual laws, under which it rests (effects/law_rest.c)
#define PL_SETTINGS_PULL offsetof(pl_body_settings, pull_x)
} pl_body_settings;

#define PL_SETTINGS_SAVED sizeof(pl_body_settings)
// The rest few of those few have: hash.c adds it where it is not 0.
#define PL_SETTINGS_HASHED offsetof(pl_body_settings, charge)
#define PL_SETTINGS_DRAG   offsetof(pl_body_settings, drag)
#define PL_SETTINGS_ENGINE offsetof(pl_body_settings, thrust)
#define PL_SETTINGS_BREAK  offsetof(pl_body_settings, break_force)
#define PL_SETTINGS_DIPOLE offsetof(pl_body_settings, dipole)

typedef struct pl_body_settings_list {
    pl_buffer items; // pl_body_settings, no order
    uint32_t count;
    uint32_t damped, dragged, engines, breakable, dipoles, capped, scaled, frozen; // records that ask for it; frozen: time scale 0
} pl_body_settings_list;

// Where a kinematic body is to be in a while.
typedef struct pl_target {
    plumb_body body;
    real x, y;      // [m] origin
    plumb_rot turn; // rotation
    real left;      // [s] until then
} pl_target;

typedef struct pl_targets {
    pl_buffer items; // pl_target, in the order in which they were set
    uint32_t count;
} pl_targets;

// A cubic of time: velocity and acceleration at its beginning, and jerk; of x and y [m], or of the angle [rad].
typedef struct pl_track_axis {
    double speed, rate, jerk;
} pl_track_axis;

// A kinematic body that arrives at a velocity: effects/track.c.
typedef struct pl_track {
    plumb_body body;
    pl_track_axis axis[3]; // of the centre of mass along x and y, of the angle; in the world's time
    double end[3];        // [m/s], [rad/s] on arrival
    double time, left;    // [s] from the beginning; until then
    real x, y;            // [m] origin then
    plumb_rot turn;       // rotation then
} pl_track;

typedef struct pl_tracks {
    pl_buffer items; // pl_track, in the order in which they were set
    uint32_t count;
} pl_tracks;

// What stands behind what in fluids that flow: made when the first of them shelters.
typedef struct pl_shelter {
    pl_buffer shades, shadows; // pl_shade; pl_shadow of each immersion
    pl_buffer blockers, casts; // scratch of shelter.c
    uint32_t shade_count;
    bool any; // some volume shelters in this step: there are shadows
} pl_shelter;

// What a step needs of effects, and forgets.
typedef struct pl_effects {
    plumb_vec2 gravity; // [m/s^2] that acts in this step: 0 where the row of gravity does not run
    uint32_t gathered;  // flags of bodies that pl_effects_gather has to look at
    bool taken;         // pl_effects_take_over changes what some bodies take over
    // uint8_t a dynamic row: PL_CALLED_... if systems of the substep act on it, else 0
    pl_buffer called;
    bool any_called, any_alone;
    pl_buffer bases; // a quad a solver slot: its acceleration before effects of the substep
    pl_buffer decays, factors;  // pl_damping_decay, pl_damping_factors a record
    pl_buffer dampers, cappers; // pl_damper, pl_capper, by rising slot
    uint32_t decay_count, damper_count, capper_count;
    pl_buffer swims;                     // uint8_t a dynamic row: whether a fluid may act on it
    pl_buffer volumes, immersions;       // pl_volume; pl_keyed: row and piece, volume
    pl_buffer swimmers;                  // pl_swimmer, by rising slot
    struct pl_shelter *shelter;          // NULL: no volume has sheltered yet
    pl_buffer draggers;                  // pl_dragger, by rising slot
    pl_buffer engines;                   // pl_engine, by rising slot
    uint32_t dragger_count, engine_count;
    uint32_t volume_count, immersion_count, swimmer_count;
    bool decays_stale; // records may have changed: set where the schedule is revised
    bool resets;       // accelerations are those of the step again as a substep begins
    bool damps, caps;  // their rows are in the schedule: nothing runs in place of them
} pl_effects;

#endif
