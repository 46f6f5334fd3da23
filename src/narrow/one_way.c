// one_way.c - one-way shapes: which contacts hold and which let pass.
//
// A contact holds when the outward normal of the one-way piece lies within an angle of its
// direction d: what comes from the other side, or at a flank, passes. A normal alone would push a
// body that is half way through to whichever side is nearer, so each pair remembers what it does
// while the two are near:
//
//     (near)   -- normal within the angle, no deeper than a little     --> HELD
//     (near)   -- else, unless the body is on top of the piece         --> PASSING
//     HELD     -- the normal has left the angle (over an edge)         --> (near)
//     PASSING  -- apart                                                --> (near)
//     HELD     -- its body asks to drop through                        --> DROPPING
//     DROPPING -- the normal has left the angle: it is inside          --> PASSING
//     any      -- no longer near                                       --> (forgotten)
//
// On top: beyond one of the faces that hold, or just below. A box that slides from tile to tile meets
// the next one by its side, for a step, with next to no overlap; that must not be taken for passing.
// HELD does not ask how deep the overlap is: a stack that presses a body into a platform stays on it
// exactly as on a solid one.
//
// Reads: manifolds, pieces, rotations. Writes: manifolds, the pairs' flags. Order: after the kernels,
// before internal edges, which see only what holds. Cost: O(pairs) in worlds that have one-way shapes, nothing in others.
// Running it twice on the same manifolds changes nothing the second time (a step may be refused).
#include "narrow/one_way.h"

#include "narrow/narrow.h"
#include "narrow/surface.h"
#include "plumb/math.h"
#include "world/filter.h"
#include "world/wrap.h"

#define STATES (PL_PAIR_HELD | PL_PAIR_PASSING | PL_PAIR_DROPPING)

static bool is_one_way(const plumb_world *world, uint32_t piece)
{
    return (world->pieces.flags[piece] & PL_PIECE_ONE_WAY) != 0;
}

bool pl_one_way_wanted(const plumb_world *world, const char **reason)
{
    bool wanted = world->one_way_pieces > 0;
    *reason = wanted ? "there are one-way shapes" : "no shape is one-way";
    return wanted;
}

// The manifold lies on the side that holds, for each of the pieces that is one-way; depth aside.
static bool faces_hold(const plumb_world *world, const pl_pair *pair, const pl_manifold *m)
{
    plumb_vec2 n = { m->nx, m->ny };
    return (!is_one_way(world, pair->a) || pl_one_way_blocks(world, pair->a, n, 0)) &&
           (!is_one_way(world, pair->b) || pl_one_way_blocks(world, pair->b, plumb_vec2_neg(n), 0));
}

static bool asks_to_drop(const plumb_world *world, const pl_pair *pair)
{
    const uint16_t *flags = world->bodies.flags;
    return (is_one_way(world, pair->a) && (flags[pair->body_b] & PL_BODY_DROPPING) != 0) ||
           (is_one_way(world, pair->b) && (flags[pair->body_a] & PL_BODY_DROPPING) != 0);
}

// How far a piece reaches against a direction, from a point that is told from the origin of another's body. [m]
static double reach_against(const plumb_world *world, uint32_t piece, plumb_vec2 n, uint32_t other,
                            plumb_vec2 from)
{
    const pl_shift way = pl_wrap_between(world, other, piece);
    const pl_pose *pose = &pl_poses(world)[world->pieces.body[piece]];
    plumb_rot q = { pose->c, pose->s };
    plumb_convex convex;
    double least = (double)PLUMB_REAL_MAX;
    pl_piece_convex(world, piece, &convex);
    for (int i = 0; i < convex.count; ++i) {
        plumb_vec2 p = plumb_rot_apply(q, convex.points[i]);
        double x = (double)p.x + (way.x - (double)from.x);
        double y = (double)p.y + (way.y - (double)from.y);
        double h = (double)n.x * x + (double)n.y * y;
        least = h < least ? h : least;
    }
    return least - (double)convex.radius;
}

// The other piece lies beyond a face of the one-way piece that holds, or no deeper than a little.
static bool is_on_top(const plumb_world *world, uint32_t piece, uint32_t other)
{
    const pl_pose *pose = &pl_poses(world)[world->pieces.body[piece]];
    plumb_rot q = { pose->c, pose->s };
    plumb_convex convex;
    pl_piece_convex(world, piece, &convex);
    if (convex.count == 1) { // a circle holds with its top
        convex.normals[0] =
            plumb_v2(world->pieces.one_way_x[piece], world->pieces.one_way_y[piece]);
    }
    for (int i = 0; i < convex.count; ++i) {
        plumb_vec2 n = plumb_rot_apply(q, convex.normals[i]);
        plumb_vec2 at = plumb_rot_apply(q, convex.points[i]);
        if (!pl_one_way_blocks(world, piece, n, 0)) {
            continue;
        }
        if (reach_against(world, other, n, piece, at) - (double)convex.radius >=
            -(double)PL_ONE_WAY_FOUND) {
            return true;
        }
    }
    return false;
}

static bool pair_is_on_top(const plumb_world *world, const pl_pair *pair)
{
    return (!is_one_way(world, pair->a) || is_on_top(world, pair->a, pair->b)) &&
           (!is_one_way(world, pair->b) || is_on_top(world, pair->b, pair->a));
}

// Of a pair that is near and does nothing yet.
static uint32_t first_state(const plumb_world *world, const pl_pair *pair, bool faces, bool shallow)
{
    if (faces && shallow) {
        return asks_to_drop(world, pair) ? PL_PAIR_DROPPING : PL_PAIR_HELD;
    }
    return !faces && pair_is_on_top(world, pair) ? 0 : PL_PAIR_PASSING;
}

static uint32_t next_state(const plumb_world *world, const pl_pair *pair, const pl_manifold *m)
{
    bool faces = faces_hold(world, pair, m);
    real s0 = m->point[0].separation, s1 = m->point[1].separation;
    real separation = s0 < s1 ? s0 : s1;
    switch (pair->flags & STATES) {
    case PL_PAIR_DROPPING:
        return faces ? PL_PAIR_DROPPING : PL_PAIR_PASSING;
    case PL_PAIR_PASSING:
        return separation > 0 ? first_state(world, pair, faces, true) : PL_PAIR_PASSING;
    case PL_PAIR_HELD:
        return first_state(world, pair, faces, true);
    default:
        return first_state(world, pair, faces, separation >= -PL_ONE_WAY_FOUND);
    }
}

static void forget_requests(plumb_world *world)
{
    for (uint32_t row = 0; world->dropping_bodies > 0 && row < world->dynamic_count; ++row) {
        world->bodies.flags[row] &= (uint16_t)~PL_BODY_DROPPING;
    }
    world->dropping_bodies = 0;
}

void pl_one_way_run(plumb_world *world)
{
    pl_manifold *m = pl_manifolds(&world->narrow);
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    bool any = false;
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        m[i].disabled = 0;
    }
    for (uint32_t i = 0; i < world->broad.pairs.count; ++i) {
        pl_pair *pair = &pairs[i];
        if (!is_one_way(world, pair->a) && !is_one_way(world, pair->b)) {
            continue;
        }
        uint32_t state =
            pair->manifold == PL_NONE ? 0 : next_state(world, pair, &m[pair->manifold]);
        pair->flags = (pair->flags & ~STATES) | state;
        if (pair->manifold != PL_NONE && state != PL_PAIR_HELD) {
            m[pair->manifold].disabled = 1;
            any = true;
        }
    }
    forget_requests(world);
    if (any) {
        pl_narrow_take_out_disabled(world, 0);
    }
}
