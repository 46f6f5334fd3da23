// character.h - characters as they are stored.
#ifndef PL_TABLE_CHARACTER_H
#define PL_TABLE_CHARACTER_H

#include "core/memory.h"
#include "plumb/character.h"
#include "world/columns.h"

#define PL_CHARACTER_PASSING 8 // one-way shapes that it can be under way through at once

// A one-way shape that does not hold it.
typedef struct pl_passing {
    plumb_shape shape;
    uint32_t dropping; // it was asked to: until it is inside, or far
} pl_passing;

// What it stands on.
typedef struct pl_ground {
    plumb_body body; // null: nothing
    plumb_shape shape;
    plumb_vec2 point;  // [m]
    plumb_vec2 local;  // [m] the same in the frame of the body
    plumb_vec2 normal; // unit
    plumb_vec2 velocity;
    real spin;
} pl_ground;

typedef struct pl_character {
    plumb_body body;
    plumb_character_desc desc; // as given
    // What is asked of it.
    bool flies;
    real walk;      // [m/s]
    plumb_vec2 fly; // [m/s]
    real jump;      // [m/s] in the next step; 0: none
    bool thrown;    // `velocity` was set
    // What it does.
    plumb_vec2 velocity; // [m/s] in the world
    real speed;          // [m/s] along the ground, relative to it
    real left;           // [m/s] to the right: of the ground that it left last, which it keeps in the air
    double rise;         // [m] upwards since it last stood on ground that is not too steep
    double step_top;     // [m] likewise: where the step that it climbs has its top
    bool on_ground, climbs, on_slope, at_wall, at_ceiling, crushed;
    int slope_side; // of the last step, on a slope that is too steep: 1 it goes down to the right, -1 left
    real air_time; // [s]
    pl_ground ground;
    pl_passing passing[PL_CHARACTER_PASSING];
    int passing_count;
    // The dynamic body that it pushes: what stood against the push in the last step (push.c).
    plumb_body pushed;
    real push, push_speed; // [N], [m/s]
    // The dynamic body that it weighs on, likewise.
    plumb_body trod;
    real weight, weight_speed; // [N], [m/s]
    plumb_character_hit hits[PLUMB_CHARACTER_HITS];
    int hit_count;
    // Before the step, in case it is refused.
    plumb_vec2 body_velocity;
    uint32_t turn; // step of the last move, so that each moves once: counts world->characters.turn
} pl_character;

// A force that was added to a body: what it had before.
typedef struct pl_shove {
    plumb_body body;
    real fx, fy, torque;
} pl_shove;

typedef struct pl_characters {
    pl_buffer items; // pl_character, unordered
    pl_buffer saved; // the same, as before the step
    uint32_t count;
    uint32_t turn;
    bool moved;      // in this step: it can be undone
    bool walks;      // some dynamic one was driven in this step
    bool treads;     // some kinematic one stands on a dynamic body
    double farthest; // [m] that a kinematic one moves in this step, of those that had their turn
    pl_buffer obstacles; // pl_obstacle, scratch of one character
    pl_buffer near;      // uint32_t, pieces near it
    pl_buffer pushes;    // pl_shove of this step
    uint32_t push_count;
} pl_characters;

static inline pl_character *pl_character_items(const pl_characters *characters)
{
    return (pl_character *)characters->items.data;
}

#endif
