// exact.h - contacts and joints of an island solved together, to a residual.
#ifndef PL_EXACT_SOLVER_H
#define PL_EXACT_SOLVER_H

#include "joints/joint.h"
#include "solver/substep.h"
#include "world/state.h"

#include <string.h>

#define PL_EXACT_VECTORS 8 // of a system

// A scalar row J v + give impulse = target whose impulse has bounds. Those of friction and rolling resistance are
// `factor` times the load, the impulses of the `leads` rows that lie before it in the contact.
typedef struct pl_exact_row {
    const pl_exact_item *item; // the contact or joint that it is of
    double j[6];               // of A's vx, vy, w, then of B's
    double target;             // [m/s], [rad/s]
    double undone;             // of the target: what undoes an error
    double give;               // [1/kg] of a spring
    double low,
        high;      // [N s]; of friction and rolling resistance, low is the middle of what it may be
    double factor; // [-] or [m]
    double mass;   // [kg] effective
    double impulse; // [N s] as known
    double next;    // [N s] what follows from the velocities of the moment
    double best;    // [N s] the same in the best round so far
    double brisk;   // [N s] of velocities that undo errors too fast
    double weight;  // [kg] -d next / d (J v) of its own
    double slope;   // the same of each lead's J v, as a share of the lead's weight
    double kept;    // [N s] given to the velocities by the sweep that pulled, and stays
    double before;  // [N s] as known before the sweep that pulls
    double shift;   // [m/s] of friction as a cone: see newton.c
    uint32_t lead;  // first of the rows that load it
    uint8_t leads;  // how many; 0: low and high hold
    bool cone;      // friction of a point: a cone with the load, where friction is cones
    bool in_force;
    bool stays; // of a joint or a contact that turns: what it gave in the sweep that pulled
} pl_exact_row;

// A row as sweeps go over it, what driven ends do to it in its target.
typedef struct pl_exact_swept_row {
    double j[6], push[6]; // of A, of B; push: times the inverse masses
    double target, give;
    double gain; // [kg] impulse for a speed that lacks
    double low, high, factor, impulse;
    uint32_t at[2];       // in the velocities, of A and B
    uint32_t lead, leads; // in the island
} pl_exact_swept_row;

// A contact that may turn within the step, and how: moment.c.
typedef struct pl_exact_turning {
    bool turns;    // it does in this step
    int face;      // the body whose face the normal is of, 0 or 1; -1: it connects centres
    double nx, ny; // when the step began
    double radius
        [2]; // [m] of each body, from core points to the surface, against and along the normal
    double
        core[2]
            [4]; // [m] of each point, when the step began: of A x, y from its centre of mass, of B
    double start[2]; // [m] separations then
    double apart[2]; // [m] when the sweep began
} pl_exact_turning;

// An island with all that its solution reads and writes.
typedef struct pl_exact_system {
    plumb_world *world;
    const pl_joint_context *joints;
    pl_exact_solver *exact;
    pl_exact_island *island;
    pl_exact_node *nodes; // of all islands, as everything below
    const uint32_t *entries;
    const pl_exact_item *items;
    pl_exact_row *rows;
    pl_exact_turning *turnings;
    // Of an entry: what the later node's velocity does to the earlier one, and the reverse.
    double *above, *below;
    double *diagonal;
    // Three a node: velocities of the moment, without any impulse of the rows; F; Newton's step; half of what forces do in the
    // substep; the velocities that the sweep that relaxes begins with; those of the best round; those that undo errors too fast.
    double *velocity, *base, *change, *step, *kick, *full, *best, *brisk;
    near_real h, since; // [s] the substep; from the start of the step to its own
    double inv_dt;      // [1/s] of the step
    bool first;         // substep of it
    pl_joint_sweep sweep;
    double recovery; // share of what errors ask for: 1
    bool missed;     // the tolerance
    double left;     // [-] of the speeds that rows had to undo
} pl_exact_system;

// Of an item that is a contact.
static inline pl_classic_contact *pl_exact_contact(const pl_exact_system *s,
                                                   const pl_exact_item *item)
{
    return (pl_classic_contact *)s->world->solver.classic.data + item->contact;
}

// Which contacts of a world of the soft step are seeds of islands that sweeps cannot hold (hard.c).
void pl_hard_look(plumb_world *world);
// Behind the substeps: which contacts were solved so.
void pl_hard_note(plumb_world *world);
// A world of the soft step, whose hard islands are solved so though nobody asked.
static inline bool pl_exact_is_unasked(const plumb_world *world)
{
    return world->solver.hard_cluster != PL_NONE;
}
// Whether something is solved exactly in this step.
static inline bool pl_exact_wanted(const plumb_world *world)
{
    return world->desc.solver == PLUMB_SOLVER_EXACT || pl_exact_is_unasked(world);
}
// Who is eliminated when (plan.c). False when out of memory.
bool pl_exact_plan(plumb_world *world);
// After the substeps: the first miss of a world is told in the log.
void pl_exact_tell(plumb_world *world);
void pl_exact_free(pl_memory *memory, pl_exact_solver *exact);

// Rows as the bodies are now; what the arcs of anchors make of a substep; impulses back, and what the events want to
// know (rows.c).
void pl_exact_fill(const pl_exact_system *s);
void pl_exact_bend(const pl_exact_system *s, int round);
void pl_exact_keep(const pl_exact_system *s);
// Contacts that turn within the step (moment.c): which may; whether one does in this step; its geometry of now; by how much
// its points part [m] while its bodies go by such velocities.
bool pl_exact_may_turn(const plumb_world *world, const pl_manifold *m);
void pl_exact_find_turning(const pl_exact_system *s, const pl_exact_item *item);
void pl_exact_turn(const pl_exact_system *s, const pl_exact_item *item, pl_classic_contact *m);
void pl_exact_part(const pl_exact_system *s, const pl_exact_item *item, double velocity[2][3],
                   double parted[2]);
// A body of the contact swings faster about it, for what presses it, than the substep can follow.
bool pl_exact_is_pressed(const pl_exact_system *s, const pl_exact_item *item);
// What springs ask for in the sweep, their ends moving at such velocities, forces of the sweep included (spring.c).
void pl_exact_spring(const pl_exact_system *s, const double *velocity);

// Vectors of the island.
static inline void pl_exact_copy(const pl_exact_system *s, double *to, const double *from)
{
    const size_t first = 3 * (size_t)s->island->first_node, end = 3 * (size_t)s->island->end_node;
    memcpy(to + first, from + first, (end - first) * sizeof(double));
}

// The factor of what `rows` weigh; its inverse times x, into x (factor.c).
void pl_exact_factor(const pl_exact_system *s);
void pl_exact_substitute(const pl_exact_system *s, double *x);

// A solution while it is found (newton.c).
typedef struct pl_exact_newton {
    pl_exact_system *s;
    double stiffness; // times the mass of a row
    double due;       // the same, of what is as uneven
    double ratio;     // [-] of the heaviest body to the lightest
    double scale;     // [m/s] the largest speed that a row has to undo
    double fastest;   // [m/s] that anything may slip
    double tolerance; // [-] of the scale
    double enough;    // of F, by momentum
    double noise;     // of the same, of rounding
    double slope;     // of the potential, where the step begins
    int rounds;       // that missed
    double merit;     // [m/s] of the best of them, the less the better
    double left;      // [-] of the scale, likewise
    double loads;     // [-] the same of the last round, but of rows without friction
    double last;      // [-] what the round before left of the scale
    bool unasked;     // a world of the soft step: time is short
    bool cones;       // some point has friction
    bool swept;       // friction rubs against friction: rows are, before each round
    bool spoilt;      // by sweeps, the round before
    bool convex;      // see evaluate_cone
} pl_exact_newton;

// Of a row: what an end that is driven, or at rest, has of J v; J v at such velocities; what it adds up at those of the moment, of which its rounding is a share;
// velocity += M^-1 J^T impulse; a share of the impulses of all rows to the velocities of the moment (evaluate.c).
double pl_exact_driven(const pl_exact_system *s, const pl_exact_row *r, int end);
double pl_exact_rate(const pl_exact_system *s, const pl_exact_row *r, const double *velocity);
double pl_exact_sum(const pl_exact_system *s, const pl_exact_row *r);
void pl_exact_push(const pl_exact_system *s, const pl_exact_row *r, double *velocity,
                   double impulse);
void pl_exact_push_all(const pl_exact_system *s, double share);
// Velocities that follow from the impulses.
void pl_exact_follow(const pl_exact_system *s);
// F into `change`: returns its size, by momentum (evaluate.c).
double pl_exact_evaluate(pl_exact_newton *n);

// Whether velocities have more energy than the start and what drove the rows; velocities and impulses by sweeps from the impulses of
// the moment (sweep.c).
bool pl_exact_has_gained(const pl_exact_system *s);
void pl_exact_sweep(const pl_exact_system *s, int count);

// Velocities and impulses that obey all rows (newton.c).
void pl_exact_solve(pl_exact_system *s);

#endif
