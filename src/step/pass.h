// pass.h - a row of the step: a pass of ours or a system of the user's. The schedule: which rows this world wants, in
// what order.
#ifndef PL_PASS_H
#define PL_PASS_H

#include "world/tables/step.h"
#include "core/memory.h"
#include "plumb/world.h"
#include "schema/passes.h"
#include "step/data.h"
#include "world/substep.h"

#define PL_VARIANTS_MAX PLUMB_VARIANTS_MAX
#define PL_SOLVERS      (PLUMB_SOLVER_EXACT + 1)

// In order. Those from PREPARE to STORE are inside of the substeps: solver/substep.h.
typedef enum pl_stage {
    PL_STAGE_COMMANDS,
    PL_STAGE_BEGIN,
    PL_STAGE_FORCES,
    PL_STAGE_PAIRS,
    PL_STAGE_CONTACTS,
    PL_STAGE_EDITS,
    PL_STAGE_GRAPH,
    PL_STAGE_SOLVE,
    PL_STAGE_PREPARE,
    PL_STAGE_MOMENT,
    PL_STAGE_VELOCITIES,
    PL_STAGE_CONSTRAINTS,
    PL_STAGE_POSITIONS,
    PL_STAGE_RELAX,
    PL_STAGE_SUMS,
    PL_STAGE_STORE,
    PL_STAGE_FINISH,
    PL_STAGE_EVENTS,
    PL_STAGE_END,
    PL_STAGES
} pl_stage;

typedef enum pl_pass_kind {
    PL_ONCE = 0,       // a step
    PL_REFRESHES = 1,  // and in a step of dt 0: it moves nothing
    PL_REPLACEABLE = 2 // a system may take its place: nothing behind it relies on what it leaves
} pl_pass_kind;

// Of the kernels of a pass, static strings: what runs, and what is specialised away.
typedef struct pl_variants {
    int count, away_count;
    const char *names[PL_VARIANTS_MAX], *away[PL_VARIANTS_MAX];
} pl_variants;

typedef struct pl_pass {
    const char *name;
    pl_stage stage;
    const char *reads, *writes; // names of data.h
    // Whether this world needs the pass; *reason (a static string) says why or why not. NULL: always.
    bool (*wanted)(const plumb_world *world, const char **reason);
    // Does it, once a step; of the stages of the substep one for each solver, NULL where that has no such row.
    // All NULL: the place of the user's systems of a phase.
    plumb_result (*run)(plumb_world *world, plumb_real dt);
    pl_substep_fn *row[PL_SOLVERS];
    // Whether an effect acts on a dynamic body; NULL: it is none.
    bool (*acts_on)(const plumb_world *world, uint32_t row);
    unsigned kind; // pl_pass_kind
    // Says which variants of its kernels run, and which do not. NULL: there is but one.
    void (*variants)(const plumb_world *world, pl_variants *v);
} pl_pass;

extern const pl_pass pl_passes[];
extern const int pl_pass_count;

static inline bool pl_is_substep_stage(pl_stage stage)
{
    return stage >= PL_STAGE_PREPARE && stage <= PL_STAGE_STORE;
}

static inline bool pl_is_home(const pl_pass *pass)
{
    bool does = pass->run != NULL;
    for (int i = 0; i < PL_SOLVERS; ++i) {
        does |= pass->row[i] != NULL;
    }
    return !does;
}

void pl_schedule_free(pl_memory *memory, pl_schedule *schedule);

// How many lines there are; one of them (place.c).
uint32_t pl_schedule_count(const plumb_world *world);
pl_line pl_schedule_place(const plumb_world *world, uint32_t i);
// Place in pl_passes of a name; -1: none has it.
int pl_pass_find(const char *name);
// Whether the pass at place i is wanted by this world and nothing runs in its place; *reason says why (not).
bool pl_pass_wanted(const plumb_world *world, int i, const char **reason);

// Room for what a step keeps of the schedule. False when out of memory.
bool pl_schedule_reserve(plumb_world *world);
// Asks every pass whether it is wanted.
void pl_schedule_revise(plumb_world *world);
// A step begins: no row has taken any time.
void pl_schedule_begin(plumb_world *world);
// Adds to the time of a line.
void pl_schedule_note(plumb_world *world, pl_line place, double ns);
// Runs the rows of the substeps, with times and checks if somebody watches.
void pl_schedule_substeps(plumb_world *world, plumb_real dt);
// Behind the row of a line that was run after pl_check_before: whether it wrote what it declares.
void pl_schedule_check(plumb_world *world, uint32_t line);

// What rows write (check.c): digests of all data before a row, and behind it.
bool pl_check_reserve(plumb_world *world);
void pl_check_before(plumb_world *world);
void pl_check_after(plumb_world *world, const char *name, uint32_t writes);

#endif
