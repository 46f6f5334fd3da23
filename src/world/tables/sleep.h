// sleep.h - islands asleep, their contacts, what is known of who rests.
#ifndef PL_TABLE_SLEEP_H
#define PL_TABLE_SLEEP_H

#include "plumb/sleep.h"
#include "world/tables/manifold.h"

#define PL_NOT_RESTING                                                                             \
    ((real)-1) // pl_bodies.rest_time of a body that moves or was changed: it rests from anew

// A contact of a sleeping body, kept for when it wakes and for those who ask meanwhile.
typedef struct pl_sleeping_contact {
    pl_pair pair;         // with impulses, features and flags; its rows mean nothing
    pl_manifold manifold; // as of when it fell asleep, if `whole`
    bool whole;           // it had a manifold; else only its end event is still due
    uint32_t island;
    uint32_t next;  // in the island's list, or the list of free ones
    uint32_t fixed; // the static or kinematic piece of the pair; PL_NONE: none, or gone
    uint32_t fixed_next, fixed_previous; // others of that piece
    // Put to sleep by a call: as of the step before, until the world is restored. Not saved.
    pl_manifold last;
    bool recalled;
} pl_sleeping_contact;

// Bodies that sleep together: whatever wakes one wakes all.
typedef struct pl_island {
    uint32_t first_body; // registry slot; the list runs through the body rows
    uint32_t last_body;
    uint32_t body_count;    // 0, and not due: a free slot, whose first_body is the next one
    uint32_t first_contact; // sleeping contacts
    uint32_t serial;        // newest piece when it fell asleep: contacts of younger ones are void
    bool due;               // it wakes in the next step
    uint32_t next_due;      // list of those
    bool marked;            // it is to wake in this step
    uint64_t made_step;     // step count + 1 when it was made asleep; 0: it fell asleep
    uint32_t contact_count;
    pl_overlaps overlaps; // of its manifolds
    pl_overlaps recalled; // of those that a call put to sleep; not saved
} pl_island;

// What a body had when it fell asleep, for a step that is refused later on (sleep/retry.c).
typedef struct pl_fallen {
    real vx, vy, w;
    real fx, fy, torque;
    bool lifted; // the body has it now
} pl_fallen;

typedef struct pl_sleep {
    // Islands asleep and their contacts, in slots.
    pl_buffer islands; // pl_island
    uint32_t island_slots, island_count, free_island;
    pl_buffer contacts; // pl_sleeping_contact
    uint32_t contact_slots, contact_count, free_contact;
    uint32_t first_due; // islands that are due; PL_NONE: none

    // Pieces of sleeping bodies.
    pl_buffer resting; // uint32_t
    uint32_t resting_count;
    bool boxes_stale;       // one of them was moved: fat boxes have to be looked at
    bool grid_stale;        // one has come: their grid has to be filed anew
    uint32_t gone;          // entries of the grid whose piece sleeps no more
    uint32_t placed_pieces; // static pieces that are new to what sleeps (PL_PIECE_PLACED)

    // What moves near what sleeps (wake.c).
    pl_pair_list near;
    bool near_stale;
    pl_pair_list probe; // pairs of the islands about to wake with others that sleep
    pl_buffer found;    // pl_found: pairs for either list as they come
    uint32_t found_count;
    pl_narrow touched; // manifolds of either list
    pl_buffer marked;  // uint32_t: islands that wake in this step
    uint32_t marked_count;
    pl_buffer woken; // pl_keyed: their contacts, by kinds

    // Falling asleep (fall.h).
    uint64_t timed_step;   // step count + 1 when bodies were last timed: a step may be tried again
    uint64_t changed_step; // likewise: something immovable was changed
    uint64_t tested_step;  // likewise: pairs were made or looked up
    real since;            // [s] since islands were last looked for, or nobody was a candidate
    real passed;           // [s] the last step
    real candidate_in;     // [s] for so long, some body may have rested long enough
    pl_buffer parents;     // uint32_t a row
    pl_buffer held;        // uint8_t a row: something keeps its island awake
    pl_buffer places;      // uint32_t a pair: where in the list it is afterwards; PL_NONE: asleep

    // Forces on what sleeps (world/push.c): whether there is anything to look at.
    uint64_t lent_step; // step count + 1 when force columns were handed out last
    bool holds;         // some body may sleep under a force
    bool holds_new;     // some has fallen asleep so since the last step
    bool pushed;        // some sleeping row has a force to be cleared

    // Events of the last step.
    pl_buffer sleep_events, wake_events; // plumb_body
    pl_buffer fallen;                    // pl_fallen: one beside each sleep event
    int sleep_event_count, wake_event_count;
    bool events_told; // the step that made them is over
} pl_sleep;

static inline pl_island *pl_islands(const pl_sleep *sleep)
{
    return (pl_island *)sleep->islands.data;
}

// Not a free slot. One without bodies has contacts whose ends the next step tells.
static inline bool pl_island_is_open(const pl_island *island)
{
    return island->body_count > 0 || island->due;
}

static inline pl_sleeping_contact *pl_sleeping_contacts(const pl_sleep *sleep)
{
    return (pl_sleeping_contact *)sleep->contacts.data;
}

static inline uint32_t *pl_resting(const pl_sleep *sleep)
{
    return (uint32_t *)sleep->resting.data;
}

#endif
