// expire.c - planes of contacts that cease to act: the pieces have met, or begin side by side, and a later impact sends
// one of them back past the other.
//
// A plane goes on beyond the features that met. Two balls part; one is struck by a third and comes back beside the
// other: it would be thrown back once more, by thin air. So where a later impact turns a body, the pieces are swept from
// there on; if they do not meet again, the plane acts until that impact only (solver/bounce.c). If they do, it stays: with the normal
// of the first time, for a pair has one contact a step. Of contacts whose impacts the solver follows (pl_is_elastic).
//
// Reads: candidates, verdicts, ways. Writes: pl_manifold.ends. Cost: O(candidates); a sweep for each with such a body.
#include "narrow/looking.h"

// [-] of the horizon: impacts of one moment.
#define MOMENT 1e-6

// When the pieces meet; PL_SWEEP_NEVER: they do not.
static double toi_of(const pl_looking *l, uint32_t candidate)
{
    const uint32_t place = ((const uint32_t *)l->ahead->listed.data)[candidate];
    if ((((const uint32_t *)l->narrow->candidates.data)[candidate] & PL_CANDIDATE_STRIKES) != 0) {
        return 0;
    }
    const pl_toi *item = place != 0 ? &pl_looking_items(l->ahead)[place - 1] : NULL;
    const bool meets =
        item != NULL && (item->verdict == PL_TOI_HIT || item->verdict == PL_TOI_KEEPS);
    return meets ? item->meets : PL_SWEEP_NEVER;
}

// Tells of a contact that has met whether its pieces do once more; if not, its plane ends with the impact that parts them.
static void expire(pl_looking *l, uint32_t place, double toi)
{
    pl_manifold *m = &pl_manifolds(l->narrow)[place];
    const pl_paths paths = pl_looking_paths(l, m);
    int leg = 1;
    while (leg < paths.legs && !(paths.breaks[leg] > toi + MOMENT)) {
        ++leg;
    }
    if (leg == paths.legs) {
        return; // nothing turns them afterwards
    }
    const pl_moving_pair e = pl_moving_pair_of(l->world, &l->in->pairs[m->pair], &paths);
    if (pl_moving_pair_approach(&e, leg, PL_TOI_TOLERANCE).kind == PL_APPROACH_MEETS) {
        pl_looking_doubt(l, m->body_a);
        pl_looking_doubt(l, m->body_b);
    } else {
        const int ends = pl_ahead_moment(l->world, paths.breaks[leg]);
        m->ends = (uint8_t)(ends | (toi > 0 ? PL_ENDS_STRUCK : 0));
    }
}

// A second impact of two bodies, and what is behind the last turn of a way, is not known: nothing ends by the way of such a
// body, nor by that of one that may meet it, and so on. (A cradle with a millisecond between its impacts: 6 % of the speed off.)
static void doubt(pl_looking *l)
{
    const uint32_t *candidates = l->narrow->candidates.data;
    for (uint32_t i = 0; i < l->way_count; ++i) {
        if (l->all[i].path.turns == PL_TURNS) {
            pl_looking_doubt(l, l->all[i].row);
        }
    }
    bool any = true;
    while (any) {
        any = false;
        for (uint32_t i = 0; i < l->narrow->candidate_count; ++i) {
            const pl_ends e =
                ((const pl_ends *)l->narrow->ends.data)[candidates[i] & PL_CANDIDATE_PLACE];
            const bool a = pl_looking_is_doubted(l, e.a), b = pl_looking_is_doubted(l, e.b);
            any = (a && pl_looking_doubt(l, e.b)) || any;
            any = (b && pl_looking_doubt(l, e.a)) || any;
        }
    }
}

void pl_looking_expire(pl_looking *l)
{
    const uint32_t *candidates = l->narrow->candidates.data;
    const pl_ends *ends = l->narrow->ends.data;
    bool any = false;
    for (uint32_t i = 0; i < l->narrow->candidate_count; ++i) {
        const uint32_t place = candidates[i] & PL_CANDIDATE_PLACE;
        if ((candidates[i] & PL_CANDIDATE_BOUNCES) == 0 ||
            (!pl_looking_bounces(l, ends[place].a) && !pl_looking_bounces(l, ends[place].b))) {
            continue;
        }
        const double toi = toi_of(l, i);
        if (pl_is_elastic(pl_manifolds(l->narrow)[place].restitution) && toi < 1) {
            expire(l, place, toi);
            any = true;
        }
    }
    if (!any) {
        return;
    }
    doubt(l);
    for (uint32_t i = 0; i < l->narrow->candidate_count; ++i) {
        const uint32_t place = candidates[i] & PL_CANDIDATE_PLACE;
        if (pl_looking_is_doubted(l, ends[place].a) || pl_looking_is_doubted(l, ends[place].b)) {
            pl_manifolds(l->narrow)[place].ends = 0;
        }
    }
}
