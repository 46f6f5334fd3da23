// heat.h - heat as it is stored: a record of each body that has any of it, what the world owes and has told.
#ifndef PL_TABLE_HEAT_H
#define PL_TABLE_HEAT_H

#include "core/memory.h"
#include "plumb/heat.h"
#include "plumb/liquid.h"
#include "world/columns.h"

// In double: a step warms a body by less than a float can tell.
#define PL_HEAT_MEMBER(name, initial) double name;

typedef struct pl_heat {
    plumb_body body;
    PL_BODY_ROWS(PL_ROW_HEAT, PL_HEAT_MEMBER)
    double molten; // [kg] that melted and is with the body
    double burnt;  // [kg] that the body's mass counts and that is gone; the rest of a rounding, of either sign
    double grown;  // [-] logarithm of what its size is to grow by
} pl_heat;

// Beyond this its size is changed: it never is when a step begins.
#define PL_HEAT_MOST_GROWN 200.0

// What a world has of it once it had a body with heat.
typedef struct pl_heat_state {
    plumb_heat_sums sums;                         // but content, burnt and owed
    double owed[1 + PLUMB_LIQUID_MAX_PHASES];     // [kg] of each phase
    uint64_t drops;                               // particles made so far: where on outlines the next ones are
} pl_heat_state;

// A body in a step.
typedef struct pl_heat_body {
    double temperature; // [K]
    double yield;       // [K/J] 1 / (m c); 0: it holds its temperature, or melts at it
    double gain;        // [J] that it got while it held it
    double power;       // [W]
    double glow;        // [W/K^4] emissivity sigma P
    double ambient;     // [K]
    bool melts;         // it holds its temperature because it melts
} pl_heat_body;

// Contacts of two of them.
typedef struct pl_heat_link {
    uint64_t key;       // places in the list, the lower one leading
    double conductance; // [W/K]
} pl_heat_link;

// Scratch, and events: made with the first record, as most worlds have none.
typedef struct pl_heat_step {
    pl_buffer bodies;      // pl_heat_body
    pl_buffer links, keys; // pl_heat_link, pl_keyed
    pl_buffer gone;        // plumb_body_gone
    uint32_t link_count;
    uint32_t room; // contacts that there is room for; 0: a system gave the first body heat in the middle of the step
} pl_heat_step;

typedef struct pl_heats {
    pl_buffer items; // pl_heat, by rising index of the body's handle
    uint32_t count;
    uint32_t state_count;
    pl_buffer state; // pl_heat_state: one, or none
    pl_buffer step;  // pl_heat_step: one, or none
    uint32_t gone_count;
} pl_heats;

static inline pl_heat *pl_heat_items(const pl_heats *heats)
{
    return (pl_heat *)heats->items.data;
}

static inline pl_heat_state *pl_heat_state_of(const pl_heats *heats)
{
    return (pl_heat_state *)heats->state.data;
}

static inline pl_heat_step *pl_heat_step_of(const pl_heats *heats)
{
    return (pl_heat_step *)heats->step.data;
}

#endif
