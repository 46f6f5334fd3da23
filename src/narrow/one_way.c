// one_way.c - one-way shapes: which contacts hold and which let pass.
//
// A contact holds when the outward normal of the one-way piece lies within an angle of its
// direction d: what comes from the other side, or at a flank, passes. A normal alone would push a
// body that is half way through to whichever side is nearer, so each pair remembers what it does
// while the two are near:
//
//     (near)   -- normal within the angle, no deeper than it has come  --> HELD
//                 in the last step and a little
//     (near)   -- else, unless the body is on top of the piece         --> PASSING
//     HELD     -- the normal has left the angle (over an edge)         --> (near)
//     PASSING  -- apart                                                --> (near)
//     HELD     -- its body asks to drop through                        --> DROPPING
//     DROPPING -- the normal has left the angle: it is inside          --> PASSING
//     any      -- no longer near                                       --> (forgotten)
//
// A body is under way as a whole: while one of its pieces overlaps what lets it pass, none of the others is caught there, nor
// by what touches that, the next link of a chain or tile of a row: HELD becomes PASSING, or DROPPING as the other pair is,
// unless the piece that is under way is on top of it. So one passes through stairs by their risers and stands on their treads.
//
// On top: beyond one of the faces that hold, or just below. A box that slides from tile to tile meets
// the next one by its side, for a step, with next to no overlap; that must not be taken for passing.
// HELD does not ask how deep the overlap is: a stack that presses a body into a platform stays on it
// exactly as on a solid one.
//
// Reads: manifolds, pieces, rotations, velocities, grids. Writes: manifolds, the pairs' flags. Order: after the kernels,
// before internal edges, which see only what holds. Cost: O(pairs) in worlds that have one-way shapes, nothing in others; while
// something is under way, cells about the body for each contact that is new or may be swept into.
// Running it twice on the same manifolds changes nothing the second time (a step may be refused).
#include "narrow/one_way.h"

#include "broad/images.h"
#include "broad/pairs.h"
#include "narrow/narrow.h"
#include "narrow/path.h"
#include "narrow/surface.h"
#include "plumb/math.h"
#include "query/query.h"
#include "world/filter.h"
#include "world/wrap.h"

#include <math.h>

// Of a manifold's `disabled`, until the run is over: it holds, and did not in the last step.
#define JUST_HELD 2u

static real deepest(const pl_manifold *m)
{
    real s0 = m->point[0].separation, s1 = m->point[1].separation;
    return s0 < s1 ? s0 : s1;
}

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

// A piece that is one-way, and another: where both are, and how they came there in a time [s]; 0: as if they had stood still.
typedef struct standing {
    const plumb_world *world;
    uint32_t piece, other;
    pl_motion came, other_came;
} standing;

static standing standing_of(const plumb_world *world, uint32_t piece, uint32_t other, double time)
{
    const uint32_t *body = world->pieces.body;
    return (standing){ world, piece, other, pl_flight_of(world, body[piece], time),
                       pl_flight_of(world, body[other], time) };
}

// By how much a point, told from the centre of mass, has been moved in a direction: to second order of the turn. [m]
static double moved_along(pl_motion by, double x, double y, plumb_vec2 n)
{
    const double half = by.turn * by.turn / 2;
    return (double)n.x * (by.x - by.turn * y + half * x) +
           (double)n.y * (by.y + by.turn * x + half * y);
}

// How far the other piece reached against a direction, from a point that is told from the origin of the body of the one-way
// piece, before they came to where they are. [m]
static double reach_against(const standing *s, plumb_vec2 n, plumb_vec2 from)
{
    const plumb_world *world = s->world;
    const pl_shift way = pl_wrap_between(world, s->piece, s->other);
    const pl_pose *pose = &pl_poses(world)[world->pieces.body[s->other]];
    const pl_pose *base = &pl_poses(world)[world->pieces.body[s->piece]];
    plumb_rot q = { pose->c, pose->s };
    plumb_convex convex;
    double least = (double)PLUMB_REAL_MAX;
    pl_piece_convex(world, s->other, &convex);
    for (int i = 0; i < convex.count; ++i) {
        plumb_vec2 p = plumb_rot_apply(q, convex.points[i]);
        const double x = (double)p.x + way.x, y = (double)p.y + way.y;
        double h = (double)n.x * (x - (double)from.x) + (double)n.y * (y - (double)from.y);
        h -= moved_along(s->other_came, (double)p.x - (double)pose->dx,
                         (double)p.y - (double)pose->dy, n);
        h += moved_along(s->came, x - (double)base->dx, y - (double)base->dy, n);
        least = h < least ? h : least;
    }
    return least - (double)convex.radius;
}

// The other piece lay beyond a face of the one-way piece that holds, or no deeper than a little.
static bool is_on_top(const standing *s)
{
    const plumb_world *world = s->world;
    const uint32_t piece = s->piece;
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
        const bool inside = (world->pieces.cuts[piece] >> i & 1u) != 0; // of an outline
        if (inside || !pl_one_way_blocks(world, piece, n, 0)) {
            continue;
        }
        if (reach_against(s, n, at) - (double)convex.radius >= -(double)PL_ONE_WAY_FOUND) {
            return true;
        }
    }
    return false;
}

static bool is_on_top_of(const plumb_world *world, uint32_t piece, uint32_t other, double time)
{
    const standing s = standing_of(world, piece, other, time);
    return is_on_top(&s);
}

static bool pair_is_on_top(const plumb_world *world, const pl_pair *pair, double time)
{
    return (!is_one_way(world, pair->a) || is_on_top_of(world, pair->a, pair->b, time)) &&
           (!is_one_way(world, pair->b) || is_on_top_of(world, pair->b, pair->a, time));
}

// In the last step: what turns may be deep in a face that it had not come near.
static bool pair_was_on_top(const plumb_world *world, const pl_pair *pair)
{
    return pair_is_on_top(world, pair, (double)world->last_dt);
}

// Of a pair that is near and does nothing yet.
static uint32_t first_state(const plumb_world *world, const pl_pair *pair, bool faces, bool shallow)
{
    if (faces && shallow) {
        return asks_to_drop(world, pair) ? PL_PAIR_DROPPING : PL_PAIR_HELD;
    }
    return !faces && (pair_is_on_top(world, pair, 0) || pair_was_on_top(world, pair))
               ? 0
               : PL_PAIR_PASSING;
}

// Whether the points of a manifold were no deeper than a little before the last step brought them here.
static bool was_shallow(const plumb_world *world, const pl_manifold *m)
{
    const double dt = (double)world->last_dt;
    const pl_motion a = pl_flight_of(world, m->body_a, dt), b = pl_flight_of(world, m->body_b, dt);
    for (int i = 0; i < 2; ++i) {
        const pl_manifold_point *point = &m->point[i];
        const double closed = pl_motions_closed(a, b, point, (double)m->nx, (double)m->ny);
        if ((double)point->separation + (closed > 0 ? closed : 0) < -(double)PL_ONE_WAY_FOUND) {
            return false;
        }
    }
    return true;
}

static uint32_t next_state(const plumb_world *world, const pl_pair *pair, const pl_manifold *m)
{
    bool faces = faces_hold(world, pair, m);
    switch (pair->flags & PL_PAIR_ONE_WAY) {
    case PL_PAIR_DROPPING:
        return faces ? PL_PAIR_DROPPING : PL_PAIR_PASSING;
    case PL_PAIR_PASSING:
        return deepest(m) > 0 ? first_state(world, pair, faces, true) : PL_PAIR_PASSING;
    case PL_PAIR_HELD:
        return first_state(world, pair, faces, true);
    default:
        return first_state(world, pair, faces,
                           was_shallow(world, m) || pair_was_on_top(world, pair));
    }
}

//---- bodies under way ------------------------------------------------------------------------------

typedef struct company {
    plumb_world *world;
    uint32_t one;   // the one-way piece that is asked about
    uint32_t mate;  // a piece of the body that it would hold
    uint32_t found; // PL_PAIR_PASSING or PL_PAIR_DROPPING; 0: none
} company;

static bool touch(const plumb_world *world, uint32_t p, uint32_t q)
{
    const pl_box *box = &world->pieces.fat[p];
    const plumb_vec2 about = { box->min_x + (box->max_x - box->min_x) / 2,
                               box->min_y + (box->max_y - box->min_y) / 2 };
    plumb_convex a, b;
    pl_piece_convex(world, p, &a);
    pl_piece_convex(world, q, &b);
    return plumb_convex_distance(&a, pl_query_frame(world, p, about), &b,
                                 pl_query_frame(world, q, about))
               .distance <= PL_ONE_WAY_NEIGHBOURS;
}

static bool visit_neighbour(void *context, const pl_grid_entry *entry)
{
    company *c = context;
    plumb_world *world = c->world;
    const uint32_t piece = entry->piece;
    if (!is_one_way(world, piece)) {
        return true;
    }
    const pl_pair *pair = pl_pairs_find_one(world, piece, c->mate);
    if (pair == NULL || !pl_pair_passes(pair) || pair->manifold == PL_NONE) {
        return true;
    }
    const bool drops = (pair->flags & PL_PAIR_DROPPING) != 0;
    const pl_manifold *m = &pl_manifolds(&world->narrow)[pair->manifold];
    if ((!drops && !(deepest(m) < 0)) || (piece != c->one && !touch(world, piece, c->one))) {
        return true;
    }
    if (!drops && is_on_top_of(world, c->one, c->mate, 0)) {
        return true;
    }
    c->found = drops ? PL_PAIR_DROPPING : PL_PAIR_PASSING;
    return false;
}

// What the body of `other` does at the one-way piece, or at what touches that, with any of its pieces.
static uint32_t under_way(plumb_world *world, uint32_t one, uint32_t other)
{
    company c = { .world = world, .one = one };
    for (uint32_t p = world->bodies.first_piece[world->pieces.body[other]];
         p != PL_NONE && c.found == 0; p = world->pieces.next_in_body[p]) {
        c.mate = p;
        const pl_box box = world->pieces.fat[p];
        if (pl_world_query(world, &world->broad.fixed, box, visit_neighbour, &c)) {
            pl_world_query(world, &world->broad.moving, box, visit_neighbour, &c);
        }
    }
    return c.found;
}

// What the bodies of a pair are doing with others of their pieces.
static uint32_t state_of_bodies(plumb_world *world, const pl_pair *pair)
{
    uint32_t state = is_one_way(world, pair->a) ? under_way(world, pair->a, pair->b) : 0;
    if (state == 0 && is_one_way(world, pair->b)) {
        state = under_way(world, pair->b, pair->a);
    }
    return state;
}

// Pairs that were found to hold just now go along with what their bodies are doing already. One leads to another: until there
// is no more, so that their order does not matter.
static void keep_together(plumb_world *world)
{
    pl_manifold *m = pl_manifolds(&world->narrow);
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    for (bool again = true; again;) {
        again = false;
        for (uint32_t i = 0; i < world->broad.pairs.count; ++i) {
            pl_pair *pair = &pairs[i];
            if (pair->manifold == PL_NONE || m[pair->manifold].disabled != JUST_HELD) {
                continue;
            }
            const uint32_t state = state_of_bodies(world, pair);
            if (state != 0) {
                pair->flags = (pair->flags & ~PL_PAIR_ONE_WAY) | state;
                m[pair->manifold].disabled = 1;
                again = true;
            }
        }
    }
}

static bool may_be_swept(const plumb_world *world, uint32_t row, real dt)
{
    const pl_motion f = pl_flight_of(world, row, (double)dt);
    return fabs(f.x) + fabs(f.y) + fabs(f.turn) * (double)world->bodies.extent[row] >
           (double)PL_SPECULATIVE;
}

// What is not near now, but may be passed into before the step is over, is met by the sweeps of continuous/: they look at the
// flags alone.
static void tell_sweeps(plumb_world *world, real dt)
{
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    for (uint32_t i = 0; i < world->broad.pairs.count; ++i) {
        pl_pair *pair = &pairs[i];
        if (pair->manifold == PL_NONE &&
            (is_one_way(world, pair->a) || is_one_way(world, pair->b)) &&
            (may_be_swept(world, pair->body_a, dt) || may_be_swept(world, pair->body_b, dt))) {
            pair->flags |= state_of_bodies(world, pair);
        }
    }
}

void pl_one_way_forget(plumb_world *world)
{
    for (uint32_t row = 0; world->dropping_bodies > 0 && row < world->dynamic_count; ++row) {
        world->bodies.flags[row] &= (uint16_t)~PL_BODY_DROPPING;
    }
    world->dropping_bodies = 0;
}

static uint32_t noted(uint32_t flags)
{
    return ((flags & PL_PAIR_HELD) != 0 ? PL_PAIR_WAS_HELD : 0) |
           ((flags & PL_PAIR_PASSING) != 0 ? PL_PAIR_WAS_PASSING : 0) |
           ((flags & PL_PAIR_DROPPING) != 0 ? PL_PAIR_WAS_DROPPING : 0);
}

void pl_one_way_undo(plumb_world *world)
{
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    for (uint32_t i = 0; world->one_way_noted && i < world->broad.pairs.count; ++i) {
        const uint32_t flags = pairs[i].flags;
        pairs[i].flags = (flags & ~PL_PAIR_ONE_WAY) |
                         ((flags & PL_PAIR_WAS_HELD) != 0 ? PL_PAIR_HELD : 0) |
                         ((flags & PL_PAIR_WAS_PASSING) != 0 ? PL_PAIR_PASSING : 0) |
                         ((flags & PL_PAIR_WAS_DROPPING) != 0 ? PL_PAIR_DROPPING : 0);
    }
    world->one_way_noted = false;
}

void pl_one_way_run(plumb_world *world, plumb_real dt)
{
    pl_manifold *m = pl_manifolds(&world->narrow);
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    bool any = false, just_held = false, passing = false;
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        m[i].disabled = 0;
    }
    for (uint32_t i = 0; i < world->broad.pairs.count; ++i) {
        pl_pair *pair = &pairs[i];
        if (!is_one_way(world, pair->a) && !is_one_way(world, pair->b)) {
            continue;
        }
        const bool held = (pair->flags & PL_PAIR_HELD) != 0;
        uint32_t state =
            pair->manifold == PL_NONE ? 0 : next_state(world, pair, &m[pair->manifold]);
        pair->flags =
            (pair->flags & ~(PL_PAIR_ONE_WAY | PL_PAIR_WAS_ONE_WAY)) | state | noted(pair->flags);
        if (pair->manifold == PL_NONE) {
            continue;
        }
        if (state != PL_PAIR_HELD) {
            m[pair->manifold].disabled = 1;
            any = true;
            passing |= state == PL_PAIR_DROPPING || deepest(&m[pair->manifold]) < 0;
        } else if (!held) {
            m[pair->manifold].disabled = JUST_HELD;
            just_held = true;
        }
    }
    if (passing && just_held) {
        keep_together(world);
    }
    if (passing && !world->desc.no_continuous) {
        tell_sweeps(world, dt);
    }
    for (uint32_t i = 0; just_held && i < world->narrow.manifold_count; ++i) {
        m[i].disabled &= 1u;
    }
    world->one_way_noted = true;
    if (any) {
        pl_narrow_take_out_disabled(world, 0);
    }
}
