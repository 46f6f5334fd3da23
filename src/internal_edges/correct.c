// correct.c - contacts whose normal the ground does not allow, set right or taken out; then runs.
//
// A kernel sees two convex pieces and takes the axis that separates them most. That may be a side
// that a neighbour covers, or lean on a corner where the ground goes on. Then the best face of the
// ground that is open there takes its place (view.c). Where nothing of the other piece lies before
// it, nor will within the step, the neighbour has the contact, and this one is taken out.
//
// Reads: pairs, poses, pieces, internal edges. Writes: manifolds, pairs, summary. Order: after the narrow
// phase, before anything else looks at manifolds. Cost: DECISIONS.md has the counts.
#include "narrow/ahead.h"
#include "narrow/narrow.h"
#include "narrow/surface.h"
#include "internal_edges/run.h"
#include "internal_edges/view.h"

// The two views of a contact; opened where somebody looks.
typedef struct prospect {
    pl_view view[2];
    bool open[2];
} prospect;

static pl_view *view_of(prospect *o, const plumb_world *world, const pl_pair *pair,
                        const pl_manifold *m, int i, double dt)
{
    if (!o->open[i]) {
        pl_view_open(&o->view[i], world, pair, m, i == 0, dt);
        o->open[i] = true;
    }
    return &o->view[i];
}

// What the general kernel has found of one side: its edge that is the contact's face, or lies before that of the other.
typedef struct found {
    int edge; // -1: nothing is known
    bool is_face;
    bool outer; // no neighbour narrows the corners of the edge: it goes on flat nowhere
} found;

static found find_edge(const plumb_world *world, const pl_pair *pair, const pl_manifold *m, int i)
{
    const pl_pieces *pieces = &world->pieces;
    const uint32_t own = i == 0 ? pair->a : pair->b, feature = m->feature[0];
    const int count = pieces->vertex_count[own];
    if (pieces->kind[pair->b] != PL_PIECE_POLYGON || pieces->kind[pair->a] == PL_PIECE_CIRCLE ||
        count < 3 || (feature & (PL_CONVEX_CORNERS | PL_EDGE_FEATURE)) != 0) {
        return (found){ .edge = -1 };
    }
    const bool is_face = ((feature & PL_CONVEX_OF_B) != 0) == (i == 1);
    const int k = (int)(is_face ? PL_CONVEX_FACE(feature) : PL_CONVEX_EDGE(feature));
    const uint32_t narrowed = pieces->internal_corners[own];
    return (found){ k, is_face,
                    ((narrowed >> k | narrowed >> (k + 1 < count ? k + 1 : 0)) & 1) == 0 };
}

// True when that tells without a view that the ground allows the contact: a face that nothing covers, or an edge that nothing
// covers between corners that nothing narrows, the deeper of which bears. Most contacts of compounds are such.
static bool is_clear(const plumb_world *world, const pl_pair *pair, const pl_manifold *m, int i)
{
    const uint32_t own = i == 0 ? pair->a : pair->b;
    const found f = find_edge(world, pair, m, i);
    return f.edge >= 0 && (pair->flags & PL_PAIR_AHEAD) == 0 &&
           (world->pieces.internal_edges[own] &
            (PL_EDGE_COVERED(f.edge) | PL_EDGE_PARTLY(f.edge))) == 0 &&
           (f.is_face || (f.outer && pl_view_end_bears(world, m, own, i == 0, f.edge)));
}

typedef enum verdict { RIGHT, SET_RIGHT, FALSE_CONTACT } verdict;

// Piles press free bodies into one another. What is deeper than this is let out by the shortest way: to
// ask for an open face would hold it longer (compounds of tests/bench: 27 against 31 mm mean overlap).
#define DEEP PL_SPECULATIVE

static bool is_deep_in_free_body(const plumb_world *world, const pl_manifold *m, uint32_t row)
{
    return row < world->dynamic_count &&
           plumb_min(m->point[0].separation, m->point[1].separation) < -DEEP;
}

// Its deepest point is at a corner where the ground goes on flat: the neighbour has it. The other, along the edge beside the
// corner, may meet within the step as the bodies turn, and stays alone, unless it is at such a corner, too. False: it is not so.
// Between two grounds either would keep what the other leaves to its neighbour.
static bool drop_inner_corner(const plumb_world *world, const pl_view *v, pl_manifold *m)
{
    const pl_pieces *pieces = &world->pieces;
    const int k = v->feature, before = k > 0 ? k - 1 : v->side.count - 1;
    if (m->count != 2 || v->is_edge || v->side.count < 3 ||
        pl_piece_has_internal_edges(pieces, v->other)) {
        return false;
    }
    const pl_vertex *corners = v->side.corners, *on = &corners[k], *back = &corners[before];
    const bool goes_on = (double)on->nx * v->nx + (double)on->ny * v->ny >
                         (double)back->nx * v->nx + (double)back->ny * v->ny;
    const int edge = goes_on ? k : before;
    const int end = goes_on ? (k + 1 < v->side.count ? k + 1 : 0) : before;
    const int outer = m->point[1].separation > m->point[0].separation ? 1 : 0;
    const uint32_t narrowed = pieces->internal_corners[v->own];
    if ((narrowed >> k & 1) == 0 ||
        ((narrowed >> end & 1) != 0 && pl_view_is_at_corner(v, &m->point[outer], end)) ||
        (pieces->internal_edges[v->own] & (PL_EDGE_COVERED(edge) | PL_EDGE_PARTLY(edge))) != 0) {
        return false;
    }
    m->point[0] = m->point[outer];
    m->feature[0] = m->feature[outer];
    m->point[1] = (pl_manifold_point){ .separation = PL_APART };
    m->feature[1] = PL_NONE;
    m->count = 1;
    return true;
}

// Either piece may be ground; the ground of one must allow what the other's makes of the contact.
static verdict judge(const plumb_world *world, const pl_pair *pair, pl_manifold *m, double dt,
                     prospect *o)
{
    bool allowed[2];
    for (int i = 0; i < 2; ++i) {
        allowed[i] = !pl_piece_has_internal_edges(&world->pieces, i == 0 ? pair->a : pair->b) ||
                     is_deep_in_free_body(world, m, i == 0 ? m->body_a : m->body_b) ||
                     is_clear(world, pair, m, i) ||
                     pl_view_is_allowed(view_of(o, world, pair, m, i, dt));
    }
    if (allowed[0] && allowed[1]) {
        return RIGHT;
    }
    const pl_manifold seen = *m;
    for (int i = 0; i < 2; ++i) {
        if (allowed[i] || !pl_view_rebuild(view_of(o, world, pair, m, i, dt), m)) {
            continue;
        }
        o->open[0] = o->open[1] = false;
        if (pl_view_is_allowed(view_of(o, world, pair, m, 1 - i, dt))) {
            return SET_RIGHT;
        }
    }
    *m = seen;
    o->open[0] = o->open[1] = false;
    for (int i = 0; i < 2; ++i) {
        if (!allowed[i] && allowed[1 - i] &&
            drop_inner_corner(world, view_of(o, world, pair, m, i, dt), m)) {
            return SET_RIGHT;
        }
    }
    return FALSE_CONTACT;
}

// Faces that go on flat are joined (run.c). False when out of memory.
static bool add_to_runs(plumb_world *world, uint32_t index, const pl_pair *pair,
                        const pl_manifold *m, prospect *o, double dt)
{
    const uint32_t *bits = world->pieces.internal_corners;
    if (world->internal_edges.apart || ((bits[pair->a] | bits[pair->b]) & PL_EDGE_FLAT) == 0) {
        return true;
    }
    if (!pl_runs_make_room(world)) {
        return false;
    }
    // Ground is the piece that does not move freely, if either may be it.
    const int first = pair->body_a >= world->dynamic_count ? 0 : 1;
    for (int k = 0; k < 2; ++k) {
        const int i = k == 0 ? first : 1 - first;
        if ((bits[i == 0 ? pair->a : pair->b] & PL_EDGE_FLAT) != 0 &&
            !find_edge(world, pair, m, i).outer &&
            pl_runs_add(world, index, view_of(o, world, pair, m, i, dt))) {
            break;
        }
    }
    return true;
}

// Impulses follow their features, as in narrow/lanes.h. A contact of one point keeps its own whichever
// way it was made.
static void carry_over(const pl_edge_pair *old, pl_pair *pair, pl_manifold *m)
{
    bool single = m->count == 1 && old->feature[0] != PL_NONE && old->feature[1] == PL_NONE;
    for (uint32_t k = 0; k < 2; ++k) {
        pair->feature[k] = m->feature[k];
        for (int j = 0; j < 2 && k < m->count; ++j) {
            if (old->feature[j] == m->feature[k] || (single && j == 0)) {
                m->point[k].normal = old->normal[j];
                m->point[k].tangent = old->tangent[j];
            }
        }
        pair->normal[k] = m->point[k].normal;
        pair->tangent[k] = m->point[k].tangent;
    }
}

static near_real nearest(const pl_manifold *m)
{
    const near_real s0 = m->point[0].separation, s1 = m->point[1].separation;
    return s0 < s1 ? s0 : s1;
}

// Closes the gaps that were left: manifolds without points go, those that another bears the load of
// stand behind the rest, where the solver does not look. What stays is summed up on the way.
static void close_gaps(plumb_world *world)
{
    pl_narrow *narrow = &world->narrow;
    pl_manifold *m = pl_manifolds(narrow), *borne = world->internal_edges.borne.data;
    pl_ends *ends = narrow->ends.data;
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    uint32_t kept = 0, borne_count = 0;
    pl_narrow_forget_summary(narrow);
    for (uint32_t i = 0; i < narrow->manifold_count; ++i) {
        if (m[i].count == 0) {
            continue;
        }
        if (pairs[m[i].pair].flags & PL_PAIR_BORNE) {
            borne[borne_count++] = m[i];
            continue;
        }
        if (kept != i) {
            m[kept] = m[i];
            ends[kept] = ends[i];
            pairs[m[kept].pair].manifold = kept;
        }
        pl_narrow_sum_up(narrow, &m[kept]);
        ++kept;
    }
    narrow->manifold_count = kept;
    narrow->borne_count = borne_count;
    for (uint32_t i = 0; i < borne_count; ++i) {
        m[kept + i] = borne[i];
        pairs[borne[i].pair].manifold = kept + i;
    }
}

// A contact and the one that bears its load are of the same two bodies: both stay, or neither.
void pl_internal_edges_follow(plumb_world *world, const uint32_t *places, uint32_t borne)
{
    pl_narrow *narrow = &world->narrow;
    pl_manifold *m = pl_manifolds(narrow);
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    uint32_t kept = narrow->manifold_count;
    for (uint32_t i = borne; i < borne + narrow->borne_count; ++i) {
        uint32_t place = places[m[i].pair];
        if (place != PL_NONE) {
            m[kept] = m[i];
            m[kept].pair = place;
            m[kept].bearer = places[m[i].bearer];
            pairs[place].manifold = kept++;
        }
    }
    narrow->borne_count = kept - narrow->manifold_count;
    pl_runs_follow(world, places);
}

#define SOON 6 // pairs ahead whose manifold is fetched: manifolds do not lie in the order of pairs

static void fetch_manifold(const plumb_world *world, const pl_pair *pair)
{
    if (pair->manifold != PL_NONE) {
        const pl_manifold *m = &pl_manifolds(&world->narrow)[pair->manifold];
        __builtin_prefetch(m, 1);
        __builtin_prefetch(&m->point[1], 1);
    }
}

bool pl_internal_edges_correct(plumb_world *world, real dt)
{
    pl_internal_edges *s = &world->internal_edges;
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    const pl_edge_pair *list = s->pairs.data;
    const bool parts = world->part_pieces > 0;
    bool changed = false;
    if (!pl_runs_open(world)) {
        return false;
    }
    for (uint32_t i = 0; i < s->pair_count; ++i) {
        pl_pair *pair = &pairs[list[i].pair];
        if (i + SOON < s->pair_count) {
            fetch_manifold(world, &pairs[list[i + SOON].pair]);
        }
        pair->flags &= ~(PL_PAIR_BORNE | PL_PAIR_COVERED);
        if (pair->manifold == PL_NONE) {
            continue;
        }
        pl_manifold *m = &pl_manifolds(&world->narrow)[pair->manifold];
        prospect o;
        o.open[0] = o.open[1] = false;
        const near_real gap = nearest(m);
        verdict v = judge(world, pair, m, (double)dt, &o);
        if (v == SET_RIGHT && (pair->flags & PL_PAIR_AHEAD) == 0) {
            pl_ahead_hold_back(world, pair, dt, m);
        }
        if (v == FALSE_CONTACT) {
            m->count = 0;
            pair->manifold = PL_NONE;
            const bool met = gap <= PL_TOUCH_HOLD && (pair->flags & PL_PAIR_AHEAD) == 0;
            pair->flags |= met && parts ? PL_PAIR_COVERED : 0;
            pl_pair_forget(pair);
        } else {
            carry_over(&list[i], pair, m);
            m->met |= gap > PL_TOUCH_HOLD && nearest(m) <= PL_TOUCH_HOLD ? PL_MET_ASIDE : 0;
        }
        if (v != FALSE_CONTACT && (pair->flags & PL_PAIR_AHEAD) == 0 &&
            !add_to_runs(world, i, pair, m, &o, (double)dt)) {
            return false;
        }
        changed |= v != RIGHT;
    }
    if (!pl_runs_join(world, (double)dt)) {
        return false;
    }
    if (changed || s->contact_count > 0) {
        close_gaps(world);
    }
    return true;
}
