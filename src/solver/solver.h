// solver.h - what the solver keeps between the passes of a step, and the kernels compiled per
// width.
#ifndef PL_SOLVER_H
#define PL_SOLVER_H

#include "world/tables/solver.h"
#include "core/tasks.h"
#include "plumb/ecs.h"

_Static_assert(sizeof(plumb_near) == sizeof(near_real), "the user's scalar of the solver is ours");

// A point of an elastic contact: its impacts are events, outside the wide kernels (impact.c).
typedef struct pl_impact_point {
    near_real ran, rbn, rat, rbt;  // [m] lever arms
    near_real separation;          // [m] at the start of the step
    near_real *lane_separation;    // where the contact kernel reads it
    const near_real *lane_impulse; // the kernel's accumulated normal impulse
} pl_impact_point;

typedef struct pl_impact {
    uint32_t a, b; // solver slots
    uint32_t pair;
    uint32_t count;
    near_real nx, ny, friction, restitution;
    near_real surface_speed;      // [m/s]
    bool locked;                  // a body has a locked axis: then
    near_real aix, aiy, bix, biy; // [1/kg] inverse masses along the axes
    bool due;                     // an impact falls into the present substep
    bool clear[2];                // the point stays apart in it
    uint32_t chain;               // impacts of it that are followed in a substep
    uint32_t left;                // impacts that are still followed in the present substep
    bool cut;                     // no more, though there is energy for more
    // [s] since the step began: it acts from impacts of its bodies of about then to others; 0: from the start, to the end.
    near_real after, until;
    bool waits, over; // it does not act yet; it does no more
    bool met;         // it has struck, so it may be over
    double time;      // [s] of the first one, since the start of the substep
    uint32_t place;   // in the queue (impact_queue.h); PL_NONE: not in it
    uint32_t next[2]; // impact of a, and of b; PL_NONE: no more
    pl_impact_point point[2];
} pl_impact;

// Whether a manifold's surfaces part after an impact: what sticks does not.
static inline bool pl_bounces(const pl_manifold *m)
{
    return m->restitution > 0 && !(m->adhesion > 0);
}

// A contact of the classic solver (pgs.c).
typedef struct pl_classic_point {
    near_real ran, rbn, rat, rbt; // [m] lever arms
    near_real separation;         // [m] at the start of the step
    near_real mn, mt;             // [kg] effective masses
    near_real ln, lt;             // [N s]
    bool yields;                  // friction is not enough to hold it
} pl_classic_point;

typedef struct pl_classic_contact {
    uint32_t a, b; // solver slots
    uint32_t pair, manifold, count;
    near_real aix, aiy, bix, biy; // [1/kg] inverse masses along the axes
    near_real pull, reach;        // [N s] that a point may pull, [m] while it is nearer than this
    near_real nx, ny, friction, restitution;
    near_real sticks, slides; // [-] friction of either state
    near_real bore;           // [-] friction of the last substep
    near_real surface_speed;  // [m/s]
    near_real rolling;        // [m]
    near_real mr, lr;         // [kg m^2], [N m s] of rolling resistance
    near_real struck;         // [m/s] fastest at which a point was struck in this step
    near_real struck_at;      // [s] when, since the step began
    bool pushed;              // in some substep so far
    pl_classic_point point[2];
} pl_classic_contact;

// A point that was `apart` [m] is struck at `speed` [m/s] in the substep of h that begins `since` the step did.
static inline void pl_classic_strike(pl_classic_contact *m, near_real speed, near_real apart,
                                     near_real since, near_real h)
{
    if (speed > m->struck) {
        m->struck = speed;
        m->struck_at = since + (apart > 0 && apart < speed * h ? apart / speed : apart > 0 ? h : 0);
    }
}

// What a row is marked with in `slots` before it gets its slot. An elastic body, one in a contact whose impacts are
// events, keeps what rounding takes from its velocity; the others must not, or what one
// island asks for would change the bits of the rest.
enum { PL_ACTIVE, PL_ELASTIC };

// How stiffness rises in this step, in levels of PL_PAIR_STIFF_MASK (apart.c).
typedef struct pl_fine_clock {
    uint32_t rise;   // by so many
    uint32_t top;    // up to this one
    near_real phase; // [-] 0 to 1, of the way to the next
} pl_fine_clock;

// Numbers of a contact sweep; see contact.simd.c for the formulas.
typedef struct pl_contact_call {
    pl_solver_body *bodies;
    pl_solver_motion *motions;
    const near_real *kicked; // a quad a slot, as in pl_solver
    uint32_t dynamic_slots;  // slots from here on are read but never written
    void *bundles;
    const uint32_t *lanes;
    const uint32_t *slots; // slot of a body row
    uint32_t movable_rows; // rows from here on are static
    uint32_t immovable_slot;
    void *extras;   // NULL: none
    void *specials; // NULL: none
    void *bounces;  // NULL: none
    void *turnings; // NULL: none
    void *grips;    // NULL: none
    const plumb_world *world;
    const pl_core *cores;  // of a piece
    const uint8_t *kinds;  // pl_piece_kind of a piece
    near_real *rubbed;     // pl_solver.rubbed; NULL: impulses are not added up
    const uint16_t *flags; // PL_BODY_... of a body row
    pl_manifold *manifolds;
    pl_pair *pairs;
    near_real h, inv_h;       // [s] substep
    near_real inv_dt;         // [1/s] of the step
    near_real since;          // [s] from the start of the step to that of the substep
    near_real hertz, damping; // [1/s], [-] of soft contacts
    near_real push_speed;     // [m/s]
    near_real finer;          // substeps in place of one; in fine islands alone
    near_real stiffest, most; // [1/s] of their contacts: of level 0; that is asked for
    pl_fine_clock clock;
    near_real unloaded;          // [N s] a point that bears no more and pushes has been struck
    near_real restitution_speed; // [m/s] nothing slower bounces
    near_real *struck;           // [s] a slot, for impacts that are events; NULL: there are none
    uint32_t *bounce_count;
} pl_contact_call;

// [rad], [m] in a step: where all bodies move less, no contact turns.
#define PL_LEAST_TURN ((near_real)2e-4)
#define PL_LEAST_WAY  ((near_real)4e-5)

struct pl_measuring;
struct pl_finish;
struct pl_mover;

typedef void pl_contact_kernel(const pl_contact_call *call, uint32_t first, uint32_t count);
// Moves W dynamic rows at the end of a step, and notes movers behind the `count` that there are. False: it has done
// nothing, and each row is to be moved by itself (finish.simd.c).
typedef bool pl_place_kernel(const struct pl_finish *p, uint32_t row, struct pl_mover *movers,
                             uint32_t *count);

// Variants of the sweeps: what surfaces do, times motion. Scenes pay only for what they have.
typedef enum pl_surface_variant {
    PL_SMOOTH,  // no friction
    PL_ROUGH,   // friction
    PL_RUNNING, // friction, surface speed, rolling resistance: needs `extras`
    // the same, locked axes, adhesion, time scale 0, kinetic friction, with rotation: needs `specials` too
    PL_SPECIAL,
    PL_SURFACE_VARIANTS
} pl_surface_variant;

typedef enum pl_motion_variant {
    PL_STRAIGHT, // nothing turns
    PL_TURNING,
    PL_TELLING, // it does, or might, and the speeds of hits are noted: needs `extras`
    PL_MOTION_VARIANTS
} pl_motion_variant;

// Contacts and joints of a hard island, at the most (apart.c).
#define PL_HARD_MOST 96
// Masses are uneven from this ratio on (apart.c, exact/hard.c).
#define PL_UNEVEN 10.0
// Whether one of two bodies that move is so much heavier.
bool pl_are_uneven(const plumb_world *world, uint32_t row_a, uint32_t row_b);
// Substeps that take the place of one in fine islands (apart.c).
#define PL_FINER 4

// One set a width.
typedef struct pl_contact_kernels {
    int width;
    size_t bundle_size;
    size_t separation_offset[2]; // of the lanes' separations and impulses in a bundle
    size_t impulse_offset[2];
    pl_contact_kernel *prepare;
    pl_contact_kernel *prepare_fine,
        *close_fine; // of fine islands: after prepare_specials; before store
    pl_contact_kernel *warm_start[PL_SURFACE_VARIANTS][PL_MOTION_VARIANTS];
    pl_contact_kernel *solve[PL_SURFACE_VARIANTS][PL_MOTION_VARIANTS];
    pl_contact_kernel *relax[PL_SURFACE_VARIANTS][PL_MOTION_VARIANTS];
    size_t extra_size;
    pl_contact_kernel *prepare_extras;
    size_t special_size;
    pl_contact_kernel *prepare_specials; // after prepare_extras
    size_t bounce_size;
    pl_contact_kernel *prepare_bounces;
    pl_contact_kernel *bounce, *bounce_special; // without `specials` and with them
    pl_contact_kernel *store_bounces;           // impacts to pairs and manifolds
    size_t turning_size;
    size_t grip_size;
    pl_contact_kernel *prepare_grips, *store_grips;                  // after prepare, after store
    pl_contact_kernel *prepare_moment, *open_moment, *follow_moment; // moment.simd.c
    pl_range_fn *halve, *drift; // of a pl_passage (substep.h): halves.simd.c
    pl_place_kernel *place;     // of all bodies, at the end of the step
    pl_contact_kernel *tally;   // adds the substep's normal impulses to the totals
    // rolling impulses to the pairs; totals, speeds of hits to the manifolds
    pl_contact_kernel *store_extras;
    pl_contact_kernel *store; // impulses to the pairs
    // While the world measures itself: what impulses did, what they leave (measure.simd.c).
    void (*measure)(const pl_contact_call *call, uint32_t first, uint32_t count,
                    struct pl_measuring *m);
    void (*residual)(const pl_contact_call *call, uint32_t first, uint32_t count,
                     struct pl_measuring *m);
} pl_contact_kernels;

extern const pl_contact_kernels pl_contact_kernels_w4;
extern const pl_contact_kernels pl_contact_kernels_w8;
extern const pl_contact_kernels pl_contact_kernels_w16;

// The width to use: `asked` where the machine can, else the best measured one (0 asks for that).
int pl_solver_best_width(int asked);

void pl_solver_free(pl_memory *memory, pl_solver *solver);

// The kernels of the world's width.
const pl_contact_kernels *pl_solver_kernels(const plumb_world *world);

// Which bodies are active, and in which cluster; then colours, lanes (graph.c). False when out of memory; nothing has moved then.
bool pl_solver_open(plumb_world *world);
bool pl_solver_graph(plumb_world *world, plumb_real dt);
// Which bodies are solved together (cluster.c). False when out of memory.
bool pl_solver_cluster(plumb_world *world);
// Which islands are solved apart, exactly or in finer substeps (apart.c). False when out of memory. Then, behind the substeps, how
// stiff contacts of the latter have become.
bool pl_apart_find(plumb_world *world);
void pl_fine_note(plumb_world *world, real dt);
// Substeps of a fine island in place of one; of the last step, 0: no island was fine.
int pl_fine_times(const plumb_world *world);
uint32_t pl_fine_substeps(const plumb_world *world);
pl_fine_clock pl_fine_clock_of(const plumb_world *world, real dt);
// The stiffest level there, and that of a contact in this step: one that bore nothing in the last step has nothing stored.
static inline uint32_t pl_fine_top(int times)
{
    return times > 2 ? PL_STIFF_LEVELS : times > 1 ? PL_STIFF_LEVELS / 2 + 1 : 1;
}

static inline uint32_t pl_fine_level(uint32_t pair_flags, const pl_manifold *m,
                                     const pl_fine_clock *clock)
{
    const uint32_t level = (pair_flags & PL_PAIR_STIFF_MASK) >> PL_PAIR_STIFF_SHIFT;
    const bool fresh = level == 0 && m->point[0].normal == 0 && m->point[1].normal == 0;
    const uint32_t now = level + clock->rise > 1 ? level + clock->rise : 1;
    return now > clock->top || fresh ? clock->top : now;
}

// Whether the impulses of contacts are added up over the step.
bool pl_solver_tallies(const plumb_world *world);
// Whether locked axes, adhesion, kinetic friction or bodies whose time stands still are there to be solved.
bool pl_solver_specials(const plumb_world *world);
// [s] the substep that contacts and joints are as stiff for in a step of dt: at least that of dt (soft.c).
near_real pl_soft_substep(const plumb_world *world, real dt);
// What a contact of the classic or the exact solver bears from now on: whether its points yield decides (pgs.c).
void pl_classic_grip(const plumb_world *world, pl_classic_contact *m);
// Impacts as events (impact.c): collects them; resolves those of one substep of h [s];
// those that other impacts of the substep made; and tells the sweeps which points stay clear.
void pl_impacts_prepare(plumb_world *world, near_real dt);
void pl_impacts_prepare_classic(plumb_world *world, near_real dt);
void pl_impacts_run(plumb_world *world, near_real h);
void pl_impacts_run_on(plumb_world *world, near_real h);
void pl_impacts_tell(plumb_world *world, near_real h);

// Results into the columns, free flight of bodies in no contact, kinematic motion (finish.c).
void pl_solver_finish(plumb_world *world, real dt);

// A slot that is filled: what share of its kicks comes behind the drift (halves.c).
void pl_soft_share(const plumb_world *world, uint32_t row, uint32_t slot);

#endif
