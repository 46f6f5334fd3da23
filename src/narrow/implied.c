// implied.c - points that two others of the same bodies imply.
//
// Along a normal the speed at which points of two rigid bodies close is linear in where they lie along the tangent. So a point
// between two others, no nearer than what they say there, cannot close before one of them has: nothing is lost without it. With
// it a sweep, which takes contacts one by one, stops both bodies at the point in the middle, and an end of what lands flat on
// several pieces is thrown up (DECISIONS.md). Bodies that nothing moves are one.
//
// Only points are left out that leave another one to their manifold: pairs keep their contacts, and events their touches.
//
// Reads: manifolds, pieces. Writes: manifolds. Order: behind all that makes and judges them. Cost: O(manifolds), where bodies have
// several pieces or pieces that nothing moves are several; where two have several manifolds, for each of these what the one of its
// bodies has that has fewer.
#include "narrow/narrow.h"

#include "world/state.h"

#include <string.h>

#define SAME_NORMAL 0.999999 // cosine
#define BETWEEN     1e-3     // [m] from the outer points
#define LEVEL       1e-4     // [m] by which a point may be nearer than these say

// The manifolds of a body, those whose other body has more: a list.
typedef struct search {
    plumb_world *world;
    pl_manifold *manifolds;
    const pl_ends *ends;  // a manifold: its bodies
    const uint32_t *next; // a manifold: the one before it of that body
    uint32_t row, last;
    uint32_t movable; // rows
} search;

// What lies outermost along the tangent.
typedef struct outer {
    double low, high;         // [m]
    double low_gap, high_gap; // [m]
} outer;

// The other body of manifold i; immovable ones are one.
static uint32_t other_of(const search *s, uint32_t i)
{
    const uint32_t other = s->ends[i].a == s->row ? s->ends[i].b : s->ends[i].a;
    return other < s->movable ? other : PL_NONE;
}

// [m] along the tangent of m's normal, from the centre of the body.
static double place_of(const search *s, const pl_manifold *m, const pl_manifold *of, uint32_t k)
{
    const pl_manifold_point *p = &of->point[k];
    const bool is_a = of->body_a == s->row;
    const double x = is_a ? (double)p->ax : (double)p->bx, y = is_a ? (double)p->ay : (double)p->by;
    return (double)m->nx * y - (double)m->ny * x;
}

// Its plane is that of the start, for the whole step.
static bool is_plain(const search *s, const pl_manifold *m)
{
    return m->waits == 0 && m->ends == 0 && (pl_pair_of(s->world, m)->flags & PL_PAIR_AHEAD) == 0;
}

static bool is_along(const search *s, const pl_manifold *m, const pl_manifold *other)
{
    const double dot = (double)(m->nx * other->nx + m->ny * other->ny);
    const bool turned = (m->body_a == s->row) != (other->body_a == s->row);
    return (turned ? -dot : dot) > SAME_NORMAL && is_plain(s, other);
}

static outer outer_of(const search *s, const pl_manifold *m, uint32_t body)
{
    outer o = { (double)NEAR_MAX, -(double)NEAR_MAX, 0, 0 };
    for (uint32_t i = s->last; i != PL_NONE; i = s->next[i]) {
        const pl_manifold *other = &s->manifolds[i];
        if (other_of(s, i) != body || !is_along(s, m, other)) {
            continue;
        }
        for (uint32_t k = 0; k < other->count; ++k) {
            const double at = place_of(s, m, other, k), gap = (double)other->point[k].separation;
            if (at < o.low) {
                o.low = at, o.low_gap = gap;
            }
            if (at > o.high) {
                o.high = at, o.high_gap = gap;
            }
        }
    }
    return o;
}

static bool is_implied(const search *s, const pl_manifold *m, uint32_t k, const outer *o)
{
    const double at = place_of(s, m, m, k);
    if (!(at > o->low + BETWEEN && at < o->high - BETWEEN)) {
        return false;
    }
    const double share = (at - o->low) / (o->high - o->low);
    return (double)m->point[k].separation > o->low_gap + share * (o->high_gap - o->low_gap) - LEVEL;
}

static void leave_out(plumb_world *world, pl_manifold *m, uint32_t k)
{
    pl_pair *pair = &pl_pairs(&world->broad.pairs)[m->pair];
    if (k == 0) {
        m->point[0] = m->point[1];
        m->feature[0] = m->feature[1];
        pair->feature[0] = pair->feature[1];
        pair->normal[0] = pair->normal[1], pair->tangent[0] = pair->tangent[1];
    }
    m->point[1] = (pl_manifold_point){ .separation = PL_APART };
    m->feature[1] = pair->feature[1] = PL_NONE;
    pair->normal[1] = pair->tangent[1] = 0;
    m->count = 1;
}

// A point by which the pair touches, whatever the other does.
static bool tells_touch(const pl_manifold *m, uint32_t k)
{
    return m->point[k].separation <= PL_TOUCH_HOLD;
}

// Whether two manifolds of the list are of the same bodies, of which i is one.
static bool has_company(const search *s, uint32_t i)
{
    const uint32_t body = other_of(s, i);
    for (uint32_t j = s->last; j != PL_NONE; j = s->next[j]) {
        if (j != i && other_of(s, j) == body) {
            return true;
        }
    }
    return false;
}

static void look_at(const search *s, uint32_t i)
{
    pl_manifold *m = &s->manifolds[i];
    if (m->count < 2 || !is_plain(s, m)) {
        return;
    }
    const outer o = outer_of(s, m, other_of(s, i));
    const bool first = is_implied(s, m, 0, &o), second = is_implied(s, m, 1, &o);
    if (first != second && (tells_touch(m, first ? 1 : 0) || !tells_touch(m, first ? 0 : 1))) {
        leave_out(s->world, m, first ? 0 : 1);
    }
}

static bool has_parts(const plumb_world *world, uint32_t row)
{
    const uint32_t piece = world->bodies.first_piece[row];
    return piece != PL_NONE && world->pieces.next_in_body[piece] != PL_NONE;
}

// Whether two bodies may have several manifolds. `parts`: some that move freely have several pieces.
static bool may_have_several(const plumb_world *world, pl_ends of, bool parts)
{
    const uint32_t low = of.a < of.b ? of.a : of.b, high = of.a < of.b ? of.b : of.a;
    return low < world->dynamic_count &&
           (high >= world->dynamic_count ||
            (parts && (has_parts(world, low) || has_parts(world, high))));
}

// The same for all manifolds of two bodies, whichever is A.
static bool has_fewer(const uint32_t *many, uint32_t a, uint32_t b)
{
    return many[a] < many[b] || (many[a] == many[b] && a < b);
}

// Lists manifolds by that of their bodies which has fewer. `many`: how many each has.
static void chain(const plumb_world *world, bool parts, uint32_t *next, uint32_t *last,
                  uint32_t *many)
{
    const pl_ends *ends = world->narrow.ends.data;
    const uint32_t count = world->narrow.manifold_count, rows = world->dynamic_count;
    memset(last, 0xff, rows * sizeof *last);
    memset(many, 0, rows * sizeof *many);
    for (uint32_t i = 0; i < count; ++i) {
        const pl_ends of = ends[i];
        const bool may = may_have_several(world, of, parts);
        next[i] = may ? 0 : PL_NONE;
        if (may && of.a < rows) {
            ++many[of.a];
        }
        if (may && of.b < rows) {
            ++many[of.b];
        }
    }
    for (uint32_t i = 0; i < count; ++i) {
        if (next[i] != PL_NONE) {
            const pl_ends of = ends[i];
            const uint32_t row =
                of.b >= rows || (of.a < rows && has_fewer(many, of.a, of.b)) ? of.a : of.b;
            next[i] = last[row];
            last[row] = i;
        }
    }
}

// Pieces of awake dynamic bodies, and those of nothing that moves.
static void count_pieces(const plumb_world *world, uint32_t *dynamic, uint32_t *immovable)
{
    uint32_t all = 0, kinematic = 0;
    for (int kind = 0; kind < PL_PIECE_KIND_COUNT; ++kind) {
        all += world->piece_kinds[kind];
    }
    for (uint32_t row = world->dynamic_count; row < world->dynamic_count + world->kinematic_count;
         ++row) {
        uint32_t piece = world->bodies.first_piece[row];
        for (; piece != PL_NONE; piece = world->pieces.next_in_body[piece]) {
            ++kinematic;
        }
    }
    *dynamic = world->moving_count - kinematic;
    *immovable = all - *dynamic - world->sleep.resting_count;
}

void pl_narrow_leave_out_implied(plumb_world *world)
{
    const pl_narrow *narrow = &world->narrow;
    const uint32_t rows = world->dynamic_count;
    uint32_t dynamic, immovable;
    count_pieces(world, &dynamic, &immovable);
    if (dynamic <= rows && immovable < 2) {
        return; // two bodies have one manifold at the most
    }
    uint32_t *next = narrow->chains.data, *last = next + narrow->manifold_count;
    chain(world, dynamic > rows, next, last, last + rows);
    search s = { .world = world,
                 .manifolds = pl_manifolds(narrow),
                 .ends = narrow->ends.data,
                 .next = next,
                 .movable = rows + world->kinematic_count };
    for (s.row = 0; s.row < rows; ++s.row) {
        s.last = last[s.row];
        for (uint32_t i = s.last; i != PL_NONE && next[s.last] != PL_NONE; i = next[i]) {
            if (has_company(&s, i)) {
                look_at(&s, i);
            }
        }
    }
}
