// settle.c - what becomes of the manifolds of contacts ahead, by the verdicts of the pass (ahead.c).
//
// Contacts of pieces that pass are taken out. Those that meet or pass nearby get the geometry of that moment, for the
// ground's internal edges to judge (internal_edges/correct.c); then separations are counted back to the start of the step: by what the
// points close until then. The solver adds that motion again.
//
// A step that is refused gives the pairs back what the kernels made of them.
//
// Reads: verdicts, ways. Writes: manifolds, pairs. Cost: O(verdicts), and the manifolds behind what is taken out move up.
#include "math/compare.h"
#include "narrow/looking.h"
#include "narrow/surface.h"

//---- a step that is refused -----------------------------------------------------------------------

// What the kernels made of a pair whose manifold becomes another. A kernel that runs once more on that makes the same of it again;
// of features of a later moment it does not.
typedef struct kept_pair {
    uint32_t place, a, b; // in the list; piece slots
    uint32_t feature[2];
    near_real normal[2], tangent[2], rolling;
    uint32_t slides; // PL_PAIR_SLIDES or 0
} kept_pair;

bool pl_ahead_reserve_kept(pl_memory *memory, pl_lookahead *ahead)
{
    return pl_buffer_reserve(memory, &ahead->kept, ahead->count * sizeof(kept_pair));
}

static void keep(pl_lookahead *ahead, const pl_pair *pair, uint32_t place)
{
    kept_pair *k = (kept_pair *)ahead->kept.data + ahead->kept_count++;
    *k = (kept_pair){ .place = place,
                      .a = pair->a,
                      .b = pair->b,
                      .feature = { pair->feature[0], pair->feature[1] },
                      .normal = { pair->normal[0], pair->normal[1] },
                      .tangent = { pair->tangent[0], pair->tangent[1] },
                      .rolling = pair->rolling,
                      .slides = pair->flags & PL_PAIR_SLIDES };
}

static void give_back(pl_pair *pair, const kept_pair *kept)
{
    for (int k = 0; k < 2; ++k) {
        pair->feature[k] = kept->feature[k];
        pair->normal[k] = kept->normal[k];
        pair->tangent[k] = kept->tangent[k];
    }
    pair->rolling = kept->rolling;
    pair->flags |= kept->slides;
}

// Pairs of what fell asleep in that step have left the list, and keep what it made of them; the others moved up in it.
static pl_pair *find_kept(const pl_pair_list *list, const kept_pair *kept)
{
    pl_pair *pairs = pl_pairs(list);
    for (uint32_t end = kept->place < list->count ? kept->place + 1 : list->count; end > 0; --end) {
        if (pairs[end - 1].a == kept->a && pairs[end - 1].b == kept->b) {
            return &pairs[end - 1];
        }
    }
    return NULL;
}

void pl_ahead_undo(plumb_world *world)
{
    pl_lookahead *ahead = &world->lookahead;
    const kept_pair *kept = ahead->kept.data;
    for (uint32_t i = 0; i < ahead->kept_count; ++i) {
        pl_pair *pair = find_kept(&world->broad.pairs, &kept[i]);
        if (pair != NULL) {
            give_back(pair, &kept[i]);
        }
    }
    ahead->kept_count = 0;
}

//---- verdicts ------------------------------------------------------------------------------------

static void take_out(pl_pair *pair, pl_manifold *m)
{
    m->count = 0;
    pair->manifold = PL_NONE;
    pl_pair_forget(pair);
}

// A contact that was sought is one only where the pieces meet or come near one another.
static bool is_out(const pl_toi *item)
{
    const bool acts = item->verdict == PL_TOI_HIT || item->verdict == PL_TOI_NEAR ||
                      (item->verdict == PL_TOI_KEEPS && item->time <= 1);
    return item->verdict == PL_TOI_PASSES || (item->sought && !acts);
}

// Takes out the contacts of pieces that pass; the records of those that meet or pass nearby close up. Returns how many
// are out, and the place of the first of these.
static uint32_t sort_out(const pl_looking *l, uint32_t *first)
{
    pl_manifold *m = pl_manifolds(l->narrow);
    pl_toi *items = pl_looking_items(l->ahead);
    uint32_t kept = 0, out = 0;
    for (uint32_t i = 0; i < l->ahead->count; ++i) {
        const pl_toi_state verdict = items[i].verdict;
        if (is_out(&items[i])) {
            l->narrow->overlaps.point_count -= m[items[i].manifold].count;
            keep(l->ahead, &l->in->pairs[items[i].pair], items[i].pair);
            take_out(&l->in->pairs[items[i].pair], &m[items[i].manifold]);
            *first = items[i].manifold < *first ? items[i].manifold : *first;
            ++out;
        } else if (verdict == PL_TOI_HELD) {
            pl_toi_hold_back(&m[items[i].manifold], &items[i].paths);
        } else if (verdict == PL_TOI_HIT || verdict == PL_TOI_NEAR) {
            if (kept != i) {
                items[kept] = items[i];
            }
            ++kept;
        }
    }
    l->ahead->count = kept;
    return out;
}

// [m] the separation of a point at the start of the step, from that of its moment.
static double counted_back(const pl_toi *item, const pl_manifold_point *p, double nx, double ny)
{
    return (double)p->separation + pl_paths_closed(&item->paths, p, nx, ny, item->time);
}

// Whether all points of it were apart when the step began: a face that the other piece comes to lie behind as it
// passes is none that it strikes.
static bool was_apart(const pl_toi *item, const pl_manifold *m)
{
    bool apart = m->count > 0;
    for (uint32_t k = 0; k < m->count; ++k) {
        const pl_manifold_point *p = &m->point[k];
        apart = apart && counted_back(item, p, (double)m->nx, (double)m->ny) > 0;
    }
    return apart;
}

// Puts the geometry of that moment into the manifold of the step.
static void replace(pl_manifold *m, pl_pair *pair, const pl_manifold *then)
{
    m->nx = then->nx, m->ny = then->ny;
    m->count = then->count;
    for (int k = 0; k < 2; ++k) {
        m->point[k] = then->point[k];
        m->feature[k] = pair->feature[k] = then->feature[k];
        pair->normal[k] = then->point[k].normal;
        pair->tangent[k] = then->point[k].tangent;
    }
}

// The nearest points instead: corners that meet have no face, and none of a kernel's normals.
static void replace_by_nearest(pl_manifold *m, pl_pair *pair, const pl_toi *item)
{
    pl_pair_forget(pair);
    m->nx = item->nx, m->ny = item->ny;
    m->count = 1;
    m->point[0] = item->point;
    m->point[1] = (pl_manifold_point){ .separation = PL_APART };
    m->feature[0] = pair->feature[0] = PL_AHEAD_FEATURE;
    m->feature[1] = PL_NONE;
}

static void replace_all(const pl_looking *l)
{
    for (uint32_t i = 0; i < l->ahead->count; ++i) {
        pl_toi *item = &pl_looking_items(l->ahead)[i];
        pl_pair *pair = &l->in->pairs[item->pair];
        pl_manifold *m = pl_looking_manifold(l, item);
        const uint32_t before = m->count;
        keep(l->ahead, pair, item->pair);
        if (item->verdict == PL_TOI_HIT && was_apart(item, &item->then)) {
            replace(m, pair, &item->then);
        } else {
            pl_toi_pose(item, l->world, pair);
            replace_by_nearest(m, pair, item);
        }
        l->narrow->overlaps.point_count += m->count - before;
        item->before = m->before;
        m->ahead = i;
        pair->flags |= PL_PAIR_AHEAD;
    }
}

// Closes the gaps that contacts leave which were taken out (count 0), from the first one on. The others move up one by
// one, and tell their pairs as they do.
static void close_gaps(pl_narrow *narrow, pl_pair *pairs, uint32_t first)
{
    pl_manifold *m = pl_manifolds(narrow);
    pl_ends *ends = narrow->ends.data;
    uint32_t to = first;
    for (uint32_t i = first; i < narrow->manifold_count; ++i) {
        if (m[i].count > 0) {
            m[to] = m[i];
            ends[to] = ends[i];
            pairs[m[to].pair].manifold = to;
            ++to;
        }
    }
    narrow->manifold_count = to;
}

// What the solver prepares for must still be there. The search ends with the first that is.
static void recheck_summary(pl_narrow *narrow)
{
    const pl_manifold *m = pl_manifolds(narrow);
    const bool friction = narrow->any_friction, elastic = narrow->any_elastic,
               low = narrow->any_low;
    narrow->any_friction = narrow->any_elastic = narrow->any_low = false;
    for (uint32_t i = 0;
         i < narrow->manifold_count && (narrow->any_friction != friction ||
                                        narrow->any_elastic != elastic || narrow->any_low != low);
         ++i) {
        narrow->any_friction |= m[i].friction > 0;
        pl_narrow_note_restitution(narrow, m[i].restitution);
    }
}

void pl_looking_settle(const pl_looking *l)
{
    uint32_t first = PL_NONE;
    const uint32_t count = sort_out(l, &first);
    replace_all(l);
    if (count > 0) {
        close_gaps(l->narrow, l->in->pairs, first);
        recheck_summary(l->narrow);
    }
}

// Whether the way reaches the plane of a point before the pieces meet.
static bool is_reached_before(const pl_toi *item, const pl_manifold_point *p, double nx, double ny,
                              double separation)
{
    const pl_paths *paths = &item->paths;
    bool reached = !(separation > 0);
    for (int i = 1; i < paths->legs && paths->breaks[i] < item->time; ++i) {
        reached = reached || pl_paths_closed(paths, p, nx, ny, paths->breaks[i]) > separation;
    }
    return reached;
}

// A plane that is reached before, of pieces that bounce: it waits for the last impact before they meet, which has them fly
// straight to it (solver/bounce.c). 0: there is none such, or the solver does not follow impacts.
static uint8_t wait_of(const plumb_world *world, const pl_toi *item, const pl_manifold *m)
{
    double last = 0;
    for (int i = 1; i < item->paths.legs && item->paths.breaks[i] < item->time; ++i) {
        last = item->paths.breaks[i];
    }
    const bool follows = pl_is_elastic(m->restitution) && !(m->adhesion > 0) &&
                         world->desc.solver != PLUMB_SOLVER_EXACT && item->verdict == PL_TOI_HIT;
    return follows ? pl_ahead_moment(world, last) : 0;
}

// Counts the separations of a manifold back to the start of the step.
static void count_back(const plumb_world *world, const pl_toi *item, pl_manifold *m)
{
    const double nx = (double)m->nx, ny = (double)m->ny;
    double s[2];
    bool reached[2]; // before, or never: a plane does not reach what passes it
    for (uint32_t k = 0; k < m->count; ++k) {
        const pl_manifold_point *p = &m->point[k];
        s[k] = counted_back(item, p, nx, ny);
        reached[k] = item->verdict == PL_TOI_NEAR || is_reached_before(item, p, nx, ny, s[k]);
    }
    m->waits = m->count == 1 && reached[0] ? wait_of(world, item, m) : 0;
    for (uint32_t k = 0; k < m->count; ++k) {
        pl_manifold_point *p = &m->point[k];
        // Nor does one of the ground's faces reach what was behind that before.
        if (m->waits == 0 && reached[k]) {
            s[k] = pl_greater(pl_toi_beyond(&item->paths, p, nx, ny),
                              pl_greater(s[k], PL_TOI_TOLERANCE));
        }
        p->separation = (near_real)s[k];
    }
}

void pl_ahead_settle(plumb_world *world)
{
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    for (uint32_t i = 0; i < world->lookahead.count; ++i) {
        const pl_toi *item = &pl_looking_items(&world->lookahead)[i];
        const uint32_t at = pairs[item->pair].manifold;
        pairs[item->pair].flags &= ~PL_PAIR_AHEAD;
        if (at == PL_NONE) {
            continue; // the ground has taken it out
        }
        pl_manifold *m = &pl_manifolds(&world->narrow)[at];
        count_back(world, item, m);
        m->before = item->before;
        m->met |= PL_MET_ASIDE; // the pieces were apart, wherever the plane of that moment lies
    }
}
