// law.h - laws as they are stored, and what a step makes of them.
#ifndef PL_TABLE_LAW_H
#define PL_TABLE_LAW_H

#include "core/memory.h"
#include "core/near.h"
#include "formula/formula.h"
#include "plumb/law.h"
#include "world/desc_list.h"

// A descriptor without its texts.
#define PL_LAW_MEMBER(path) __typeof__(((plumb_law_desc *)0)->path) path;
typedef struct pl_law_data {
    PL_LAW_DESC(PL_LAW_MEMBER)
} pl_law_data;

typedef struct pl_law {
    plumb_law entity;
    pl_law_data desc;
    double x, y; // [m] where the last step had it: who is carried or teleported wakes those it reaches
    bool placed; // a step has seen it
    uint32_t formula; // which formula it has, from 1 on; 0: none
} pl_law;

_Static_assert(PLUMB_LAW_FORMULA_MOST == PL_FORMULA_TEXT - 1, "a text and its 0");

// What a law of the kind formula has besides. They stand in the order of their laws.
typedef struct pl_law_formula {
    plumb_law law;
    char texts[2][PL_FORMULA_TEXT]; // of x and y, or of the potential; none: empty
    uint64_t is_potential;          // 0 or 1
    pl_formula program;             // follows from them: not hashed
} pl_law_formula;

// A law in a step: by falling priority, then in the order in which they were made.
typedef struct pl_law_now {
    const pl_law_data *desc;
    const pl_formula *formula; // NULL
    double x, y;          // [m] of an attractor or a zone as the step begins
    double vx, vy;        // [m/s] of who carries it, if kinematic
    double w;             // [rad/s] of the same
    double c, s;          // of a box zone or a formula, turned about its middle
    double square;        // [m^2] of the softening
    double reach;         // [m] from (x, y), beyond which it does not act; infinite
    uint32_t carrier;     // row of an awake dynamic body; PL_NONE
    uint32_t member;      // the same among those that fly or are pushed together; PL_NONE
    bool moved;           // it is not where the last step had it
    bool drags;           // a formula that asks for velocities
} pl_law_now;

// How a body gets what the laws give it in this step.
typedef enum pl_law_way {
    PL_LAW_NONE,  // nothing acts on it
    PL_LAW_FLIES,  // by itself (orbits.c)
    PL_LAW_PUSHED, // in the substeps
    PL_LAW_HELD,   // likewise, by a joint or a lock: it may come to rest
    PL_LAW_TOUCHES // likewise, by a contact
} pl_law_way;

// A body that laws act on, in a step.
typedef struct pl_law_body {
    uint32_t row, slot;  // slot: of the solver; PL_NONE
    double mass;         // [kg] 0: it does not move
    double weight;       // [kg] mass times gravity scale
    double charge;       // [C]
    double attraction;   // [-]
    double mx, my;       // [C m] of its dipole, along the world's axes as the step begins
    double time;         // [-] its time scale
    uint64_t categories; // of its shapes
    double ax, ay;       // [m/s^2] of forces; of gravity and of uniform laws without end, where nothing replaces them
    double spin;         // [rad/s] by which magnetic laws turn its velocity (of the last place that was asked)
    bool coupled;        // it attracts or is attracted by a dynamic body
    bool dragged;        // a formula that asks for its velocity may act on it
} pl_law_body;

// Place and velocity of a body in the middle of whatever.
typedef struct pl_law_state {
    double x, y, vx, vy; // [m], [m/s]
} pl_law_state;

// What a step makes, and forgets.
typedef struct pl_law_step {
    pl_buffer laws;   // pl_law_now
    pl_buffer ways;   // uint8_t a dynamic row: pl_law_way
    pl_buffer bodies; // pl_law_body: coupled ones, those that attract before the others; then the rest, by rows
    pl_buffer order;  // pl_keyed: slot and place among the bodies that are pushed
    pl_buffer states, forces, table; // pl_law_state; plumb doubles; rows of extrapolations
    pl_buffer flights;               // pl_flight a dynamic row, of those that fly
    pl_buffer poles;                 // pl_pole, pl_dipole_push a coupled body (effects/dipoles.c)
    pl_buffer pulled;                // a record a coupled body (effects/law_rest.c)
    uint32_t law_count, body_count, coupled_count, source_count, pushed_count;
    bool replaces; // some law does
    bool formulas; // some law is one
    bool others;   // some law is none, or replaces
    bool flies;    // some body does
    bool couples;  // coupled bodies are pushed
    bool dipoles;  // some coupled body has a dipole
} pl_law_step;

typedef struct pl_laws {
    pl_buffer items;    // pl_law
    pl_buffer formulas; // pl_law_formula
    uint32_t count, formula_count;
    uint32_t orbit_count;
    pl_buffer orbits; // plumb_orbit_desc: one, or none for the default
    pl_law_step step;
} pl_laws;

static inline pl_law_formula *pl_law_formulas(const pl_laws *laws)
{
    return (pl_law_formula *)laws->formulas.data;
}

static inline pl_law *pl_law_items(const pl_laws *laws)
{
    return (pl_law *)laws->items.data;
}

// Of a law; NULL: it has none.
static inline pl_law_formula *pl_law_formula_of(const pl_laws *laws, const pl_law *law)
{
    return law->formula > 0 ? pl_law_formulas(laws) + (law->formula - 1) : NULL;
}

#endif
