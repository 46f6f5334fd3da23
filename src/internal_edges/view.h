// view.h - a contact seen from its ground: faces, the strips in front of them, what of the other piece
// lies there.
#ifndef PL_EDGE_VIEW_H
#define PL_EDGE_VIEW_H

#include "internal_edges/side.h"
#include "world/state.h"

// A contact as seen from its ground: `own` is the piece whose internal edges count, everything lies in the
// frame of its body.
typedef struct pl_view {
    const plumb_world *world;
    const pl_manifold *m;
    uint32_t own, other;
    const pl_pose *own_pose, *other_pose;
    bool own_is_a;
    bool ahead; // at the moment of a contact that lies ahead
    pl_side side;
    double nx, ny; // outward normal of the ground
    int feature;   // what of the ground lies farthest that way: edge or corner
    bool is_edge;
    double vx, vy;         // [m] way of the other in this step
    double turn_a, turn_b; // [rad] of both bodies in it
    double radii;          // [m]
    int count;             // corners of the other
    double x[PLUMB_POLYGON_MAX_VERTICES], y[PLUMB_POLYGON_MAX_VERTICES];
} pl_view;

// An edge of the own piece as a frame: u in front of it, v along it from its start.
typedef struct pl_face {
    double x, y, nx, ny, length;
} pl_face;

// Where on a face the other piece may touch.
typedef struct pl_strip {
    pl_face f;
    int edge;
    double separation;    // [m] of the whole other piece from the face's line
    double low, high;     // [m] open part of the face
    double before, after; // [m] how much longer it is for points that move
    const real *walls[2]; // normals of what stands at its ends; NULL: nothing does
} pl_strip;

// A point of the other piece in the frame of the face.
typedef struct pl_face_point {
    double u, v;
} pl_face_point;

// Features that are given here, apart from those of the kernels.
#define PL_EDGE_FEATURE UINT32_C(0x40000000) // face of the ground, edge or corner of the other
#define PL_RUN_FEATURE  UINT32_C(0x20000000) // edge or corner of the other, on any piece of a run

// Looks at a manifold from A or from B; dt [s] is the step.
void pl_view_open(pl_view *v, const plumb_world *world, const pl_pair *pair, const pl_manifold *m,
                  bool own_is_a, double dt);
// Brings the corners of the other piece into the frame, for contacts that need a closer look.
void pl_view_bring_other(pl_view *v);

// True when the ground allows the normal where the other piece is, or comes within the step.
bool pl_view_is_allowed(pl_view *v);

// True when the deepest point of a manifold is at that end of edge k which lies farther along the normal.
bool pl_view_end_bears(const plumb_world *world, const pl_manifold *m, uint32_t own, bool own_is_a,
                       int k);

// True when a point of the manifold is at corner k of the own piece.
bool pl_view_is_at_corner(const pl_view *v, const pl_manifold_point *p, int k);

// The strip before edge k, open ends and way of the other piece included.
pl_strip pl_view_strip(const pl_view *v, int k);

// The points of the other piece over the strip: those of the edge that most faces the ground, or the
// deepest corner that is or gets there. Returns how many; *feature names edge or corner.
int pl_view_points(const pl_view *v, const pl_strip *s, pl_face_point out[2], int *feature);

// Puts the points on the manifold, with the face's normal; `feature` is that of the first, the second
// has one more. Those too far to matter in the step are left out. Returns how many it has then.
uint32_t pl_view_write(const pl_view *v, const pl_face *f, const pl_face_point *points, int count,
                       uint32_t feature, pl_manifold *m);

// Puts the manifold on the best open face of the ground. False when none has the other piece before it.
bool pl_view_rebuild(pl_view *v, pl_manifold *m);

#endif
