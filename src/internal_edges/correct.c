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
#include "narrow/surface.h"
#include "internal_edges/run.h"
#include "internal_edges/view.h"

typedef enum verdict { RIGHT, SET_RIGHT, FALSE_CONTACT } verdict;

// Piles press free bodies into one another. What is deeper than this is let out by the shortest way: to
// ask for an open face would hold it longer (compounds of tests/bench: 27 against 31 mm mean overlap).
#define DEEP PL_SPECULATIVE

static bool is_deep_in_free_body(const plumb_world *world, const pl_manifold *m, uint32_t row)
{
    return row < world->dynamic_count &&
           plumb_min(m->point[0].separation, m->point[1].separation) < -DEEP;
}

// Either piece may be ground; the ground of one must allow what the other's makes of the contact. Opens
// the views of pieces with internal edges.
static verdict judge(const plumb_world *world, const pl_pair *pair, pl_manifold *m, double dt,
                     pl_view views[2])
{
    bool allowed[2];
    for (int i = 0; i < 2; ++i) {
        bool has = pl_piece_has_internal_edges(&world->pieces, i == 0 ? pair->a : pair->b);
        if (has) {
            pl_view_open(&views[i], world, pair, m, i == 0, dt);
        }
        allowed[i] = !has || is_deep_in_free_body(world, m, i == 0 ? m->body_a : m->body_b) ||
                     pl_view_is_allowed(&views[i]);
    }
    if (allowed[0] && allowed[1]) {
        return RIGHT;
    }
    for (int i = 0; i < 2; ++i) {
        if (allowed[i] || !pl_view_rebuild(&views[i], m)) {
            continue;
        }
        pl_view_open(&views[0], world, pair, m, true, dt);
        pl_view_open(&views[1], world, pair, m, false, dt);
        if (pl_view_is_allowed(&views[1 - i])) {
            return SET_RIGHT;
        }
    }
    return FALSE_CONTACT;
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
// stand behind the rest, where the solver does not look.
static void close_gaps(plumb_world *world)
{
    pl_narrow *narrow = &world->narrow;
    pl_manifold *m = pl_manifolds(narrow), *borne = world->internal_edges.borne.data;
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    uint32_t kept = 0, borne_count = 0;
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
            pairs[m[kept].pair].manifold = kept;
        }
        ++kept;
    }
    narrow->ends_stale |= kept != narrow->manifold_count;
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

bool pl_internal_edges_correct(plumb_world *world, real dt)
{
    pl_internal_edges *s = &world->internal_edges;
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    const pl_edge_pair *list = s->pairs.data;
    const bool parts = world->part_pieces > 0;
    bool changed = false;
    uint32_t contacts = 0;
    const uint32_t *bits = world->pieces.internal_corners;
    for (uint32_t i = 0; i < s->pair_count; ++i) {
        const pl_pair *pair = &pairs[list[i].pair];
        contacts += pair->manifold != PL_NONE && ((bits[pair->a] | bits[pair->b]) & PL_EDGE_FLAT);
    }
    if (!pl_runs_open(world, contacts)) {
        return false;
    }
    for (uint32_t i = 0; i < s->pair_count; ++i) {
        pl_pair *pair = &pairs[list[i].pair];
        pair->flags &= ~(PL_PAIR_BORNE | PL_PAIR_COVERED);
        if (pair->manifold == PL_NONE) {
            continue;
        }
        pl_manifold *m = &pl_manifolds(&world->narrow)[pair->manifold];
        pl_view views[2];
        const near_real gap = nearest(m);
        verdict v = judge(world, pair, m, (double)dt, views);
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
        if (v != FALSE_CONTACT && (pair->flags & PL_PAIR_AHEAD) == 0) {
            pl_runs_add(world, i, views);
        }
        changed |= v != RIGHT;
    }
    if (!pl_runs_join(world, (double)dt)) {
        return false;
    }
    if (changed || s->contact_count > 0) {
        close_gaps(world);
        pl_narrow_summarise(&world->narrow);
    }
    return true;
}
