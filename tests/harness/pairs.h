/// pairs.h - pairs of convex shapes handed straight to the narrow-phase kernels, without a world:
/// for tests that need hundreds of thousands of pairs, or one pair exactly. Internal headers.
///
///     pair_batch *batch = pairs_create(100);
///     pair_shape disc = pair_circle(0.5), crate = pair_box(1, 1, 0);
///     pairs_add(batch, &disc, (pair_pose){ 0, 1.4, 0 }, &crate, (pair_pose){ 0 });
///     pairs_run(batch, 8);
///     pl_manifold m;
///     if (pairs_manifold(batch, 0, &m)) ...
///
/// Bodies' centres of mass are their origins, so a manifold's anchors are relative to the poses. A
/// batch holds pairs of one combination of kinds at a time. The kernel for a pair of kinds
/// is chosen as src/narrow/narrow.c does.
#ifndef HARNESS_PAIRS_H
#define HARNESS_PAIRS_H

#include "narrow/narrow.h"
#include "world/state.h"

typedef struct pair_shape {
    pl_piece_kind kind;
    pl_core core;
    plumb_convex convex;
} pair_shape;

typedef struct pair_pose {
    double x, y, angle;
} pair_pose;

/// One side as the kernel has it: the pose in the reals of this build.
typedef struct pair_side {
    pair_shape shape;
    pl_pose pose;
} pair_side;

typedef struct pair_batch pair_batch;

pair_shape pair_circle(double r);
/// Along x, from -half to half; a segment when r is 0.
pair_shape pair_capsule(double half, double r);
pair_shape pair_box(double hx, double hy, double r);
/// Convex hull of the points, rounded by r.
pair_shape pair_polygon(const plumb_vec2 *points, int count, double r);

pair_batch *pairs_create(int capacity);
void pairs_destroy(pair_batch *batch);
void pairs_clear(pair_batch *batch);

/// Adds a pair; the one of the smaller kind becomes A. Returns its index.
int pairs_add(pair_batch *batch, const pair_shape *p, pair_pose at_p, const pair_shape *q,
              pair_pose at_q);
/// Adds the very sides of another batch's pair.
int pairs_add_sides(pair_batch *batch, const pair_side *a, const pair_side *b);
/// Normal impulses that the solver would have left on the two points of a pair.
void pairs_set_impulses(pair_batch *batch, int i, double first, double second);
int pairs_count(const pair_batch *batch);
/// Moves B of a pair, keeping features and impulses: the next step of a simulation.
void pairs_move_b(pair_batch *batch, int i, pair_pose at);

/// True when this machine has the instructions for `width` lanes.
bool pairs_width_runs(int width);
void pairs_run(pair_batch *batch, int width);

/// The two sides of pair i as the kernel sees them.
const pair_side *pairs_a(const pair_batch *batch, int i);
const pair_side *pairs_b(const pair_batch *batch, int i);
/// The manifold that the last run made; false when the pair is apart.
bool pairs_manifold(const pair_batch *batch, int i, pl_manifold *out);
/// All that the last run wrote, to compare runs bit by bit.
const void *pairs_output(const pair_batch *batch, size_t *size);

#endif
