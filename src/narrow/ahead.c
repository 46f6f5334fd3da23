// ahead.c - contacts that lie ahead act where and when the pieces meet, or not at all.
//
// The kernels make a manifold for every pair that may meet within the step, from the places at its start: a plane
// through the nearest features. That plane goes on beyond the feature. What flies past a corner would be thrown
// back by thin air, and what strikes it would leave in the direction of the start, not of the impact.
//
// So each contact whose plane the flight of its bodies reaches is looked at again:
// 1. Both pieces are swept as they fly, turning, to the first moment at which they meet (path.h, geometry/sweep.h).
//    Where they never do, the moment at which they are nearest counts.
// 2. If the plane is that of the features that meet, it stays. Else the kernel makes the manifold of that moment. What
//    only passes gets the plane that the flight touches, or all but touches: it cannot deflect what passes, and
//    holds what another impact of the step throws at it. Farther apart than PL_SPECULATIVE, there is no contact.
// 3. Separations are counted back to the start of the step: by what the points close until then. The solver adds that
//    motion again, so that the impact falls into the right substep, with the normal and arms of its moment.
//
// The first impact of a body turns it aside: what it would meet later is looked at once more, along the way that it
// takes from there. Friction, and what is third on its way, are left to the solver and the sweeps of continuous/.
//
// The ground's internal edges judge the manifold of that moment before it is counted back (internal_edges/correct.c).
//
// Reads: candidates, poses, velocities, forces, piece geometry. Writes: manifolds, pairs. Order: after the kernels.
// Cost: 60 flops a candidate; a sweep for each that is looked at.
#include "narrow/ahead.h"

#include "math/compare.h"
#include "narrow/surface.h"

#include <math.h>
#include <string.h>

// [m] an impact that moves a body by less until the horizon is none: it would meet what it would have met.
#define TURNED 2e-3
// Steps of Newton's method: of tumbling boxes nine of ten contacts that are found by it are found in two.
#define ROUNDS 3
// So many sweeps are worth a thread.
#define LEAST 16

// [s] from the start of the step within which a contact may act: the last relaxing sweep of the soft step keeps points
// from what they would do in one substep more.
static double horizon_of(const plumb_world *world, real dt)
{
    bool soft = world->desc.solver == PLUMB_SOLVER_SOFT;
    return (double)dt * (soft ? 1 + 1 / (double)world->desc.substeps : 1);
}

static pl_path free_path(pl_motion flight)
{
    return (pl_path){ .flight = flight, .impact = PL_SWEEP_NEVER };
}

// Whether a point reaches the plane of its manifold.
static bool reaches(const pl_manifold *m, pl_motion a, pl_motion b)
{
    const double nx = (double)m->nx, ny = (double)m->ny;
    return pl_motions_closed(a, b, &m->point[0], nx, ny) > (double)m->point[0].separation ||
           pl_motions_closed(a, b, &m->point[1], nx, ny) > (double)m->point[1].separation;
}

void pl_ahead_hold_back(const plumb_world *world, const pl_pair *pair, real dt, pl_manifold *m)
{
    if (!(plumb_min(m->point[0].separation, m->point[1].separation) > PL_AHEAD)) {
        return;
    }
    const double horizon = horizon_of(world, dt);
    pl_toi item = { .paths = pl_paths_of(free_path(pl_flight_of(world, m->body_a, horizon)),
                                         free_path(pl_flight_of(world, m->body_b, horizon))) };
    pl_toi_open(&item, m);
    if (item.verdict == PL_TOI_OPEN) {
        pl_toi_sweep(&item, world, m, pair);
    }
    if (item.verdict != PL_TOI_NEAR && item.verdict != PL_TOI_PASSES) {
        return;
    }
    pl_toi_hold_back(m, &item.paths);
}

//---- impacts -------------------------------------------------------------------------------------

// What the pass works on.
typedef struct looking {
    const plumb_world *world;
    const pl_narrow_input *in;
    pl_narrow *narrow;
    pl_lookahead *ahead;
    double horizon;
    uint32_t movable;
    uint32_t *map; // a movable row: 1 + its path; 0: it has no candidate
    pl_path *all;  // paths
    uint32_t path_count;
} looking;

static pl_toi *items_of(const pl_lookahead *ahead)
{
    return (pl_toi *)ahead->items.data;
}

static pl_path *path_of(const looking *l, uint32_t row)
{
    return row < l->movable && l->map[row] != 0 ? &l->all[l->map[row] - 1] : NULL;
}

static pl_motion flight_of(const looking *l, uint32_t row)
{
    const pl_path *path = path_of(l, row);
    return path != NULL ? path->flight : pl_flight_of(l->world, row, l->horizon);
}

static pl_paths paths_of(const looking *l, const pl_manifold *m)
{
    const pl_path *a = path_of(l, m->body_a), *b = path_of(l, m->body_b);
    const pl_path rests = { .impact = PL_SWEEP_NEVER };
    return pl_paths_of(a != NULL ? *a : rests, b != NULL ? *b : rests);
}

static void claim(looking *l, uint32_t row)
{
    if (row < l->movable && l->map[row] == 0) {
        l->all[l->path_count] = free_path(pl_flight_of(l->world, row, l->horizon));
        l->map[row] = ++l->path_count;
    }
}

static void note_change(const looking *l, uint32_t row, double time, pl_motion change)
{
    pl_path *path = path_of(l, row);
    const double moves =
        fabs(change.x) + fabs(change.y) + fabs(change.turn) * (double)l->world->bodies.extent[row];
    if (path != NULL && time < path->impact && moves * (1 - time) > TURNED) {
        path->impact = time;
        path->change = change;
    }
}

// What an impact at a point makes of both ways, without friction. Flat on two points: as if in their middle.
static void note_impact(const looking *l, const pl_manifold *m, const pl_manifold_point *p,
                        double nx, double ny, double time)
{
    const pl_bodies *b = &l->world->bodies;
    const double closing =
        pl_motions_closed(flight_of(l, m->body_a), flight_of(l, m->body_b), p, nx, ny);
    if (!(closing > TURNED)) {
        return;
    }
    const bool flat = m->count == 2;
    const double ran = flat ? 0 : (double)p->ax * ny - (double)p->ay * nx;
    const double rbn = flat ? 0 : (double)p->bx * ny - (double)p->by * nx;
    const double ima = (double)b->inv_mass[m->body_a], imb = (double)b->inv_mass[m->body_b];
    const double iia = (double)b->inv_inertia[m->body_a], iib = (double)b->inv_inertia[m->body_b];
    const double k = ima + imb + iia * ran * ran + iib * rbn * rbn;
    if (!(k > 0)) {
        return;
    }
    const double j = (1 + (double)m->restitution) * closing / k;
    note_change(l, m->body_a, time, (pl_motion){ -ima * nx * j, -ima * ny * j, -iia * ran * j });
    note_change(l, m->body_b, time, (pl_motion){ imb * nx * j, imb * ny * j, iib * rbn * j });
}

// The point of a manifold that reaches its plane first.
static const pl_manifold_point *first_point(const pl_manifold *m)
{
    return &m->point[m->point[1].separation < m->point[0].separation];
}

static void note_impacts(const looking *l)
{
    const pl_narrow *narrow = l->narrow;
    for (uint32_t i = 0; i < l->ahead->count; ++i) {
        const pl_toi *item = &items_of(l->ahead)[i];
        const pl_manifold *m = &pl_manifolds(narrow)[item->manifold];
        if (item->verdict == PL_TOI_HIT) {
            note_impact(l, m, &item->point, (double)item->nx, (double)item->ny, item->time);
        } else if (item->verdict == PL_TOI_KEEPS && item->time <= 1) {
            note_impact(l, m, first_point(m), (double)m->nx, (double)m->ny, item->time);
        }
    }
    const pl_ends *ends = narrow->ends.data;
    for (uint32_t i = 0; i < narrow->manifold_count; ++i) {
        if (path_of(l, ends[i].a) != NULL || path_of(l, ends[i].b) != NULL) {
            const pl_manifold *m = &pl_manifolds(narrow)[i];
            const pl_manifold_point *p = first_point(m);
            if (!(p->separation > PL_AHEAD)) { // it is there already
                note_impact(l, m, p, (double)m->nx, (double)m->ny, 0);
            }
        }
    }
}

//---- which contacts are looked at ----------------------------------------------------------------

// Makes the manifolds of listed contacts at their times; equal kinds are side by side, as in the pair list.
static void make_manifolds(const looking *l, uint32_t count)
{
    const pl_lookahead *ahead = l->ahead;
    const uint32_t *listed = ahead->list.data;
    pl_pose *poses = ahead->poses.data;
    pl_pair *copies = ahead->pairs.data;
    for (uint32_t i = 0; i < count; ++i) {
        pl_toi *item = &items_of(ahead)[listed[i]];
        copies[i] = l->in->pairs[item->pair];
        pl_toi_pose(item, l->world, &copies[i]);
        copies[i].body_a = 2 * i;
        copies[i].body_b = 2 * i + 1;
        copies[i].flags &= ~PL_PAIR_FACE_MASK;
        memcpy(&poses[2 * (size_t)i], item->poses, sizeof item->poses);
    }
    pl_narrow made = { .manifolds = ahead->made,
                       .ends = ahead->unread,
                       .fresh = ahead->unread,
                       .candidates = ahead->unread };
    pl_narrow_input then = *l->in;
    then.poses = (const real *)(const void *)poses;
    then.pairs = copies;
    then.wrapped = false;
    const uint8_t *kind = l->world->pieces.kind;
    for (uint32_t first = 0, end = 0; first < count; first = end) {
        const uint8_t a = kind[copies[first].a], b = kind[copies[first].b];
        while (end < count && kind[copies[end].a] == a && kind[copies[end].b] == b) {
            ++end;
        }
        pl_narrow_kernel_for(l->world, a, b)(&then, first, end - first, &made);
    }
    for (uint32_t i = 0; i < count; ++i) {
        pl_toi *item = &items_of(ahead)[listed[i]];
        item->then.count = 0;
        if (copies[i].manifold != PL_NONE) {
            item->then = pl_manifolds(&made)[copies[i].manifold];
        }
    }
}

static void sweep_some(void *context, uint32_t first, uint32_t count)
{
    const looking *l = context;
    const uint32_t *listed = l->ahead->list.data;
    for (uint32_t i = first; i < first + count; ++i) {
        pl_toi *item = &items_of(l->ahead)[listed[i]];
        pl_toi_sweep(item, l->world, &pl_manifolds(l->narrow)[item->manifold],
                     &l->in->pairs[item->pair]);
    }
}

// Takes from the list those that are not open any more, and those that Newton's method does not serve.
static uint32_t refine(const looking *l, uint32_t count)
{
    uint32_t *listed = l->ahead->list.data, kept = 0;
    for (uint32_t i = 0; i < count; ++i) {
        pl_toi *item = &items_of(l->ahead)[listed[i]];
        if (pl_toi_refine(item, &pl_manifolds(l->narrow)[item->manifold]) &&
            item->verdict == PL_TOI_OPEN) {
            listed[kept++] = listed[i];
        }
    }
    return kept;
}

// Lists items by verdict.
static uint32_t list_items(const looking *l, pl_toi_state verdict, bool without_manifold)
{
    uint32_t *listed = l->ahead->list.data, count = 0;
    for (uint32_t i = 0; i < l->ahead->count; ++i) {
        const pl_toi *item = &items_of(l->ahead)[i];
        if (item->verdict == verdict && !(without_manifold && item->then.count > 0)) {
            listed[count++] = i;
        }
    }
    return count;
}

// Judges all that are open.
static void look_at_open(looking *l)
{
    for (uint32_t i = 0; i < l->ahead->count; ++i) {
        pl_toi *item = &items_of(l->ahead)[i];
        if (item->verdict == PL_TOI_OPEN) {
            item->then.count = 0;
            pl_toi_open(item, &pl_manifolds(l->narrow)[item->manifold]);
        }
    }
    uint32_t count = list_items(l, PL_TOI_OPEN, false);
    for (int round = 0; round < ROUNDS && count > 0; ++round) {
        make_manifolds(l, count);
        count = refine(l, count);
    }
    count = list_items(l, PL_TOI_OPEN, false);
    for (uint32_t i = 0; i < count; ++i) {
        items_of(l->ahead)[((uint32_t *)l->ahead->list.data)[i]].then.count = 0;
    }
    pl_tasks_ranges(l->world->tasks, count, LEAST, sweep_some, l);
    count = list_items(l, PL_TOI_HIT, true);
    if (count > 0) {
        make_manifolds(l, count);
    }
}

static void list(looking *l, uint32_t manifold, const pl_paths *paths)
{
    items_of(l->ahead)[l->ahead->count++] = (pl_toi){
        .pair = pl_manifolds(l->narrow)[manifold].pair, .manifold = manifold, .paths = *paths
    };
}

// Bodies whose impacts are looked for: those of contacts that act. What bounces off may meet anything then.
static void claim_bodies(looking *l, const pl_manifold *m)
{
    claim(l, m->body_a);
    claim(l, m->body_b);
}

// Lists the candidates whose planes act while their bodies fly on.
static void list_acting(looking *l)
{
    const uint32_t *candidates = l->narrow->candidates.data;
    for (uint32_t i = 0; i < l->narrow->candidate_count; ++i) {
        const pl_manifold *m = &pl_manifolds(l->narrow)[candidates[i]];
        if (m->restitution > 0) {
            claim_bodies(l, m);
        }
        if (reaches(m, flight_of(l, m->body_a), flight_of(l, m->body_b))) {
            claim_bodies(l, m);
            const pl_paths paths = paths_of(l, m);
            list(l, candidates[i], &paths);
        }
    }
}

static bool is_upset(const looking *l, const pl_manifold *m, double before)
{
    const pl_path *a = path_of(l, m->body_a), *b = path_of(l, m->body_b);
    return (a != NULL && a->impact < before) || (b != NULL && b->impact < before);
}

// What comes after the first impact of a body is due again, by the way that the body takes from there.
static void look_again(looking *l)
{
    const uint32_t *candidates = l->narrow->candidates.data;
    pl_toi *items = items_of(l->ahead);
    const uint32_t listed = l->ahead->count;
    uint32_t next = 0; // of those that are listed: they are candidates, in order
    for (uint32_t i = 0; i < l->narrow->candidate_count; ++i) {
        const pl_manifold *m = &pl_manifolds(l->narrow)[candidates[i]];
        if (next < listed && items[next].manifold == candidates[i]) {
            pl_toi *item = &items[next++];
            double time = item->verdict == PL_TOI_HIT || item->verdict == PL_TOI_KEEPS
                              ? item->time
                              : PL_SWEEP_NEVER;
            if (is_upset(l, m, time)) {
                item->paths = paths_of(l, m);
                item->verdict = PL_TOI_OPEN;
            }
        } else if (is_upset(l, m, PL_SWEEP_NEVER)) {
            const pl_paths paths = paths_of(l, m);
            bool acts = false;
            for (int leg = 1; leg <= paths.legs; ++leg) {
                acts = acts || reaches(m, pl_path_at(&paths.of[0], paths.breaks[leg]),
                                       pl_path_at(&paths.of[1], paths.breaks[leg]));
            }
            if (acts) {
                list(l, candidates[i], &paths);
            }
        }
    }
    look_at_open(l);
}

//---- the manifold of that moment -----------------------------------------------------------------

static void take_out(pl_pair *pair, pl_manifold *m)
{
    m->count = 0;
    pair->manifold = PL_NONE;
    pl_pair_forget(pair);
}

// Takes out the contacts of pieces that pass; the records of those that meet or pass nearby close up. True: some are out.
static bool sort_out(const looking *l)
{
    pl_manifold *m = pl_manifolds(l->narrow);
    pl_toi *items = items_of(l->ahead);
    uint32_t kept = 0;
    bool out = false;
    for (uint32_t i = 0; i < l->ahead->count; ++i) {
        const pl_toi_state verdict = items[i].verdict;
        if (verdict == PL_TOI_PASSES) {
            take_out(&l->in->pairs[items[i].pair], &m[items[i].manifold]);
            out = true;
        } else if (verdict == PL_TOI_HELD) {
            pl_toi_hold_back(&m[items[i].manifold], &items[i].paths);
        } else if (verdict == PL_TOI_HIT || verdict == PL_TOI_NEAR) {
            items[kept++] = items[i];
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

static void replace_all(const looking *l)
{
    for (uint32_t i = 0; i < l->ahead->count; ++i) {
        pl_toi *item = &items_of(l->ahead)[i];
        pl_pair *pair = &l->in->pairs[item->pair];
        pl_manifold *m = &pl_manifolds(l->narrow)[item->manifold];
        if (item->verdict == PL_TOI_HIT && was_apart(item, &item->then)) {
            replace(m, pair, &item->then);
        } else {
            pl_toi_pose(item, l->world, pair);
            replace_by_nearest(m, pair, item);
        }
        item->before = m->before;
        m->ahead = i;
        pair->flags |= PL_PAIR_AHEAD;
    }
}

// Closes the gaps that contacts leave which were taken out.
static void close_gaps(pl_narrow *narrow, pl_pair *pairs)
{
    pl_manifold *m = pl_manifolds(narrow);
    pl_ends *ends = narrow->ends.data;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < narrow->manifold_count; ++i) {
        if (m[i].count == 0) {
            continue;
        }
        if (kept != i) {
            m[kept] = m[i];
            ends[kept] = ends[i];
            pairs[m[i].pair].manifold = kept;
        }
        ++kept;
    }
    narrow->manifold_count = kept;
}

//---- the pass ------------------------------------------------------------------------------------

static bool reserve(plumb_world *world, pl_lookahead *ahead, uint32_t count)
{
    pl_memory *memory = &world->memory;
    const size_t movable = (size_t)world->dynamic_count + world->kinematic_count;
    return pl_buffer_reserve(memory, &ahead->items, count * sizeof(pl_toi)) &&
           pl_buffer_reserve(memory, &ahead->poses, 2 * (size_t)count * sizeof(pl_pose)) &&
           pl_buffer_reserve(memory, &ahead->pairs, count * sizeof(pl_pair)) &&
           pl_buffer_reserve(memory, &ahead->made, count * sizeof(pl_manifold)) &&
           pl_buffer_reserve(memory, &ahead->unread, count * sizeof(pl_ends)) &&
           pl_buffer_reserve(memory, &ahead->list, count * sizeof(uint32_t)) &&
           pl_buffer_reserve(memory, &ahead->map, movable * sizeof(uint32_t)) &&
           pl_buffer_reserve(memory, &ahead->paths, 2 * (size_t)count * sizeof(pl_path));
}

static looking open_look(plumb_world *world, const pl_narrow_input *in, real dt, pl_narrow *narrow)
{
    pl_lookahead *ahead = &world->lookahead;
    looking l = { .world = world,
                  .in = in,
                  .narrow = narrow,
                  .ahead = ahead,
                  .horizon = horizon_of(world, dt),
                  .movable = world->dynamic_count + world->kinematic_count,
                  .map = ahead->map.data,
                  .all = ahead->paths.data };
    memset(l.map, 0, l.movable * sizeof(uint32_t));
    return l;
}

bool pl_ahead_look(plumb_world *world, const pl_narrow_input *in, real dt, pl_narrow *narrow)
{
    world->lookahead.count = 0;
    if (narrow->candidate_count == 0) {
        return true;
    }
    if (!reserve(world, &world->lookahead, narrow->candidate_count)) {
        return false;
    }
    looking l = open_look(world, in, dt, narrow);
    list_acting(&l);
    if (l.path_count == 0) {
        return true;
    }
    look_at_open(&l);
    note_impacts(&l);
    look_again(&l);
    const bool gaps = sort_out(&l);
    replace_all(&l);
    if (gaps) {
        close_gaps(narrow, in->pairs);
    }
    if (gaps || l.ahead->count > 0) {
        pl_narrow_summarise(narrow);
    }
    return true;
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

void pl_ahead_settle(plumb_world *world)
{
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    for (uint32_t i = 0; i < world->lookahead.count; ++i) {
        const pl_toi *item = &items_of(&world->lookahead)[i];
        const uint32_t at = pairs[item->pair].manifold;
        pairs[item->pair].flags &= ~PL_PAIR_AHEAD;
        if (at == PL_NONE) {
            continue; // the ground has taken it out
        }
        pl_manifold *m = &pl_manifolds(&world->narrow)[at];
        const double nx = (double)m->nx, ny = (double)m->ny;
        for (uint32_t k = 0; k < m->count; ++k) {
            pl_manifold_point *p = &m->point[k];
            double s = counted_back(item, p, nx, ny);
            // A plane does not reach what passes it; nor one of the ground's faces what was behind that before.
            if (item->verdict == PL_TOI_NEAR || is_reached_before(item, p, nx, ny, s)) {
                s = pl_greater(pl_toi_beyond(&item->paths, p, nx, ny),
                               pl_greater(s, PL_TOI_TOLERANCE));
            }
            p->separation = (near_real)s;
        }
        m->before = item->before;
        m->met |= PL_MET_ASIDE; // the pieces were apart, wherever the plane of that moment lies
    }
}

void pl_ahead_free(pl_memory *memory, pl_lookahead *ahead)
{
    pl_buffer_free(memory, &ahead->items);
    pl_buffer_free(memory, &ahead->poses);
    pl_buffer_free(memory, &ahead->pairs);
    pl_buffer_free(memory, &ahead->made);
    pl_buffer_free(memory, &ahead->unread);
    pl_buffer_free(memory, &ahead->list);
    pl_buffer_free(memory, &ahead->map);
    pl_buffer_free(memory, &ahead->paths);
    *ahead = (pl_lookahead){ 0 };
}
