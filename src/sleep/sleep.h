// sleep.h - what a world keeps of bodies that sleep, and what the step and the API call.
#ifndef PL_SLEEP_H
#define PL_SLEEP_H

#include "narrow/manifold.h"
#include "plumb/sleep.h"

#define PL_NOT_RESTING                                                                             \
    ((real)-1) // pl_bodies.rest_time of a body that moves or was changed: it rests from anew

#define PL_EVEN ((real)0.02) // [-] of sleep_speed * sleep_time, by which ways may differ

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
    uint32_t body_count;    // 0: a free slot, whose first_body is the next one
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

    // Falling asleep (fall.c).
    uint64_t timed_step;   // step count + 1 when bodies were last timed: a step may be tried again
    uint64_t changed_step; // likewise: something immovable was changed
    uint64_t tested_step;  // likewise: pairs were made or looked up
    real since;            // [s] since islands were last looked for, or nobody was a candidate
    real passed;           // [s] the last step
    real candidate_in;     // [s] for so long, some body may have rested long enough
    pl_buffer parents;     // uint32_t a row
    pl_buffer held;        // uint8_t a row: something keeps its island awake
    pl_buffer places;      // uint32_t a pair: where in the list it is afterwards; PL_NONE: asleep

    // Forces on what sleeps (push.c): whether there is anything to look at.
    uint64_t lent_step; // step count + 1 when force columns were handed out last
    bool holds;         // some body may sleep under a force
    bool holds_new;     // some has fallen asleep so since the last step
    bool pushed;        // some sleeping row has a force to be cleared

    // Events of the last step.
    pl_buffer sleep_events, wake_events; // plumb_body
    int sleep_event_count, wake_event_count;
    bool events_told; // the step that made them is over
} pl_sleep;

static inline pl_island *pl_islands(const pl_sleep *sleep)
{
    return (pl_island *)sleep->islands.data;
}

static inline pl_sleeping_contact *pl_sleeping_contacts(const pl_sleep *sleep)
{
    return (pl_sleeping_contact *)sleep->contacts.data;
}

static inline uint32_t *pl_resting(const pl_sleep *sleep)
{
    return (uint32_t *)sleep->resting.data;
}

//---- the passes ----------------------------------------------------------------------------------

// Wakes what is due and what is touched (wake.c). False when out of memory: nobody has woken.
bool pl_sleep_wake(plumb_world *world, plumb_real dt);
// Puts to sleep what has rested long enough (fall.c). False when out of memory: nothing has
// changed.
bool pl_sleep_fall(plumb_world *world, plumb_real dt);
void pl_sleep_events_clear(plumb_world *world);
// Puts the island of an awake dynamic row to sleep at once. Errors: E_MEMORY, E_STATE (a body of it
// may not sleep).
plumb_result pl_sleep_put_to_sleep(plumb_world *world, const char *function, uint32_t row);
// Makes the new body of a row of the sleeping partition an island (room must be reserved).
void pl_sleep_make(plumb_world *world, uint32_t row);

//---- changes that wake (disturb.c) ---------------------------------------------------------------
//
// They only take down that an island is due: rows do not move before the next step. For bodies that
// are awake, the time of rest begins anew.

// The body of a row was changed in what it is or where: it wakes, or what touches it when it is
// immovable. A body made asleep sleeps on until a step has seen it.
void pl_sleep_disturb(plumb_world *world, uint32_t row);
// The same of a piece and its body.
void pl_sleep_disturb_piece(plumb_world *world, uint32_t piece);
// The body of a row was set in motion.
void pl_sleep_stir(plumb_world *world, uint32_t row);
// All bodies.
void pl_sleep_disturb_all(plumb_world *world);
// A static or kinematic piece is about to go, or its filter was changed.
void pl_sleep_void_contacts(plumb_world *world, uint32_t piece);
void pl_sleep_see_anew(plumb_world *world, uint32_t piece);
// A body is about to be destroyed.
void pl_sleep_forget(plumb_world *world, uint32_t row);

//---- forces (push.c) -----------------------------------------------------------------------------

// A call is about to push the awake or sleeping body of a row.
void pl_sleep_push(plumb_world *world, uint32_t row);
// Force columns are handed out: they may be written until the next step is over.
void pl_sleep_heed(plumb_world *world);
// They were written over, and what is asleep may be another.
void pl_sleep_heed_all(plumb_world *world);
// A system was switched: who is not told what pushes him asks.
void pl_sleep_wake_untold(plumb_world *world);
// Forces of sleeping rows were for the step that is over.
void pl_sleep_clear_forces(plumb_world *world);

// [m/s^2] by which accelerations of forces that count as the same may differ.
real pl_push_tolerance(const plumb_world *world);
// The force on a row is not the one that was taken down.
bool pl_push_differs(const plumb_world *world, uint32_t row, real tolerance);
bool pl_is_pushed(const plumb_world *world, uint32_t row);
// A body wakes; it is looked at in its rest: whether its pusher tells sleeping rows.
void pl_push_wake(plumb_world *world, uint32_t row);
void pl_push_sample(plumb_world *world, uint32_t row);
void pl_push_keep(pl_bodies *bodies, uint32_t row);
// A body falls asleep; `steps`: in a step, not by a call.
void pl_push_begin_sleep(plumb_world *world, uint32_t row, bool steps);
// Whether some sleeping row may be pushed otherwise than before; marks the islands of those that are; then, when
// nothing can fail any more, takes down the force on those that sleep on.
bool pl_push_matters(const plumb_world *world);
void pl_push_mark(plumb_world *world, void (*mark)(pl_sleep *, uint32_t));
void pl_push_settle(plumb_world *world);

//---- islands (island.c) --------------------------------------------------------------------------

// Room for so many more islands, contacts and events of falling asleep.
bool pl_islands_reserve(plumb_world *world, uint32_t islands, uint32_t contacts);
// A new island without bodies (room must be reserved).
uint32_t pl_island_open(plumb_world *world);
// Adds the body of a row to the end of its list.
void pl_island_add(plumb_world *world, uint32_t island, uint32_t row);
void pl_island_remove(plumb_world *world, uint32_t row);
// Keeps a pair as a contact of an island (room must be reserved); manifold NULL: it has none. `steps`: a
// step runs, and the manifold is its own; else that of the step before, which a restore forgets.
void pl_island_keep(plumb_world *world, uint32_t island, const pl_pair *pair,
                    const pl_manifold *manifold, bool steps);
// Gives contacts and slot back; its bodies have been taken out.
void pl_island_close(plumb_world *world, uint32_t island);
// It is not due any more, and nothing pushes its bodies.
void pl_island_calm(plumb_world *world, uint32_t island);
// Both pieces of a contact are those that it was made for.
bool pl_sleeping_contact_is_intact(const plumb_world *world, const pl_sleeping_contact *contact);

// Moves the body of a row between the partitions, and its pieces between lists. At most two other
// rows move. Returns the new row.
uint32_t pl_sleep_put_down(plumb_world *world, uint32_t row);
uint32_t pl_sleep_take_up(plumb_world *world, uint32_t row);

void pl_sleep_free(pl_memory *memory, pl_sleep *sleep);

#endif
