// toi.h - what becomes of a contact that lies ahead, by the ways that its bodies take.
#ifndef PL_TOI_H
#define PL_TOI_H

#include "narrow/path.h"

// [m] less to the side, or less of a turned corner's arc beside its tangent, makes no other contact.
#define PL_TOI_ASIDE 5e-4

typedef enum pl_toi_state {
    PL_TOI_OPEN,   // to be looked at
    PL_TOI_KEEPS,  // the manifold of the start of the step is right
    PL_TOI_HELD,   // so it is, but what would reach its plane is stopped or turned aside before
    PL_TOI_PASSES, // the pieces come nowhere near one another: there is no contact
    PL_TOI_NEAR,   // they pass within PL_SPECULATIVE: it is one point where they are nearest
    PL_TOI_HIT     // it is that of the moment at which they meet
} pl_toi_state;

// A contact that lies ahead and was looked at closely. While its pair is PL_PAIR_AHEAD, anchors and separations of
// the manifold are those of that moment.
typedef struct pl_toi {
    pl_toi_state verdict;
    uint32_t pair;     // place in the pair list
    uint32_t manifold; // place in the list of manifolds, before internal edges move it
    uint32_t before;   // pl_manifold.before
    double time; // that moment, as a share of the horizon; PL_SWEEP_NEVER: the contact does not act
    double
        meets; // KEEPS, HIT: when they touch: the manifold may be that of a moment somewhat before
    bool sought; // PL_PAIR_SOUGHT
    bool turns;  // the pieces turn: other corners may meet than those of the manifold of the start
    bool at_end; // which is asked at the end of the ways
    bool close;  // so near to it that one step more is the last
    pl_paths paths;
    pl_pose poses[2];        // of then; the origin is A's centre of mass at the start of the step
    pl_manifold then;        // HIT: what the kernel makes of these; count 0: none
    pl_manifold_point point; // the nearest points of then, where the pieces were swept
    near_real nx, ny;        // from A to B
} pl_toi;

// When the plane of the manifold acts, as `time`; where it does not, the verdict is KEEPS or HELD, but of what turns.
void pl_toi_open(pl_toi *item, const pl_manifold *m);
// Of an item that is asked at the end of the ways: whether the pieces are apart there, so that the verdict is KEEPS or HELD. then: what the
// kernel makes of that time; NULL: nothing.
bool pl_toi_ends_apart(pl_toi *item, const pl_manifold *m, const pl_manifold *then);
// Sets the poses of item->time.
void pl_toi_pose(pl_toi *item, const plumb_world *world, const pl_pair *pair);
// One step of Newton's method towards the moment of contact, from what the kernel makes of item->time. False: it does not lead there,
// and a sweep must tell. True with the verdict OPEN: there is a better time; else it is found.
bool pl_toi_refine(pl_toi *item, const pl_manifold *m, const pl_manifold *then);
// Sweeps the pieces: verdict, time, nearest points.
void pl_toi_sweep(pl_toi *item, const plumb_world *world, const pl_manifold *m,
                  const pl_pair *pair);

// [m] the least separation of a plane that a point does not reach, whatever is rounded off.
double pl_toi_beyond(const pl_paths *paths, const pl_manifold_point *p, double nx, double ny);
// Moves the points of a manifold back to there.
void pl_toi_hold_back(pl_manifold *m, const pl_paths *paths);

#endif
