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
// The first impact of a body turns it aside: by those that are there as the step begins its way is known, and what it
// would meet after one that lies ahead is looked at once more, along the way that it takes from there; of what bounces so on,
// one behind the other (IMPACTS, PL_TURNS). Planes that a later impact takes their pieces from end there (expire.c); whom
// such a way leads to without there being a contact is sought (struck.c). The rest is left to the solver and the sweeps of
// continuous/.
//
// The ground's internal edges judge the manifold of that moment before it is counted back (internal_edges/correct.c).
//
// turns.c has the ways, toi.c one contact, settle.c what becomes of the manifolds.
//
// Reads: candidates, poses, velocities, forces, piece geometry. Writes: manifolds, pairs. Order: after the kernels.
// Cost: 60 flops for each candidate that acts as far as its kernel can tell; a lane or three for each that does; a sweep
// for those which that leads nowhere.
#include "narrow/ahead.h"

#include "narrow/looking.h"
#include "narrow/surface.h"

#include <math.h>
#include <string.h>

// Steps of Newton's method: of tumbling boxes nine of ten contacts that are found by it are found in two. A sweep costs
// as much as six.
#define ROUNDS 8
// Impacts one behind the other of which each turns another body.
#define IMPACTS 16
// So many sweeps are worth a thread.
#define LEAST 16
// Looks a step: a candidate, and how many that have few may take as if they had more.
#define LOOKS       4
#define LOOKS_LEAST 256

// The last relaxing sweep of the soft step keeps points from what they would do in one substep more.
double pl_ahead_horizon(const plumb_world *world, real dt)
{
    bool relaxes = world->desc.solver != PLUMB_SOLVER_PGS;
    return (double)dt * (relaxes ? 1 + 1 / (double)world->desc.substeps : 1);
}

uint8_t pl_ahead_moment(const plumb_world *world, double time)
{
    const double moment = PL_WINDOW_UNIT * pl_lesser(time * pl_ahead_horizon(world, 1), 1);
    return moment > 1 ? (uint8_t)moment : 1;
}

static pl_path free_path(pl_motion flight)
{
    return (pl_path){ .flight = flight };
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
    const double horizon = pl_ahead_horizon(world, dt);
    const pl_path a = free_path(pl_flight_of(world, m->body_a, horizon));
    const pl_path b = free_path(pl_flight_of(world, m->body_b, horizon));
    pl_toi item = { .paths = pl_paths_of(&a, &b) };
    pl_toi_open(&item, m);
    if (item.verdict == PL_TOI_OPEN) {
        pl_toi_sweep(&item, world, m, pair);
    }
    if (item.verdict != PL_TOI_NEAR && item.verdict != PL_TOI_PASSES) {
        return;
    }
    pl_toi_hold_back(m, &item.paths);
}

//---- judging ---------------------------------------------------------------------------------------

// Makes the manifolds of listed contacts at their times; equal kinds are side by side, as in the pair list.
static void make_manifolds(const pl_looking *l, uint32_t count)
{
    const pl_lookahead *ahead = l->ahead;
    const uint32_t *listed = ahead->list.data;
    pl_pose *poses = ahead->poses.data;
    pl_pair *copies = ahead->pairs.data;
    for (uint32_t i = 0; i < count; ++i) {
        pl_toi *item = &pl_looking_items(ahead)[listed[i]];
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
    then.wrapped = then.plain = false;
    then.w = NULL; // bodies are poses, which stand still
    const uint8_t *kind = l->world->pieces.kind;
    for (uint32_t first = 0, end = 0; first < count; first = end) {
        const uint8_t a = kind[copies[first].a], b = kind[copies[first].b];
        while (end < count && kind[copies[end].a] == a && kind[copies[end].b] == b) {
            ++end;
        }
        pl_narrow_kernel_for(l->world->desc.simd_width, a, b)(&then, first, end - first, b, &made);
    }
}

// What was made of place i of the list; NULL: nothing.
static const pl_manifold *made_of(const pl_lookahead *ahead, uint32_t i)
{
    const uint32_t place = ((const pl_pair *)ahead->pairs.data)[i].manifold;
    return place != PL_NONE ? &((const pl_manifold *)ahead->made.data)[place] : NULL;
}

static void sweep_some(void *context, uint32_t first, uint32_t count)
{
    const pl_looking *l = context;
    const uint32_t *listed = l->ahead->list.data;
    for (uint32_t i = first; i < first + count; ++i) {
        pl_toi *item = &pl_looking_items(l->ahead)[listed[i]];
        pl_toi_sweep(item, l->world, &pl_manifolds(l->narrow)[item->manifold],
                     &l->in->pairs[item->pair]);
    }
}

// Leaves in the list those that are still open, and that Newton's method serves.
static uint32_t refine(const pl_looking *l, uint32_t count)
{
    uint32_t *listed = l->ahead->list.data, kept = 0;
    for (uint32_t i = 0; i < count; ++i) {
        pl_toi *item = &pl_looking_items(l->ahead)[listed[i]];
        const pl_manifold *then = made_of(l->ahead, i);
        const pl_manifold *m = &pl_manifolds(l->narrow)[item->manifold];
        if (!pl_toi_ends_apart(item, m, then) && then != NULL && pl_toi_refine(item, m, then) &&
            item->verdict == PL_TOI_OPEN) {
            listed[kept++] = listed[i];
        }
    }
    return kept;
}

// Lists items by verdict.
static uint32_t list_items(const pl_looking *l, pl_toi_state verdict, bool without_manifold)
{
    uint32_t *listed = l->ahead->list.data, count = 0;
    for (uint32_t i = 0; i < l->ahead->count; ++i) {
        const pl_toi *item = &pl_looking_items(l->ahead)[i];
        if (item->verdict == verdict && !(without_manifold && item->then.count > 0)) {
            listed[count++] = i;
        }
    }
    return count;
}

// Judges all that are open.
static void look_at_open(pl_looking *l)
{
    for (uint32_t i = 0; i < l->ahead->count; ++i) {
        pl_toi *item = &pl_looking_items(l->ahead)[i];
        if (item->verdict == PL_TOI_OPEN) {
            item->then.count = 0;
            pl_toi_open(item, &pl_manifolds(l->narrow)[item->manifold]);
        }
    }
    uint32_t count = list_items(l, PL_TOI_OPEN, false);
    l->ahead->looks += count;
    for (int round = 0; round < ROUNDS && count > 0; ++round) {
        make_manifolds(l, count);
        count = refine(l, count);
    }
    count = list_items(l, PL_TOI_OPEN, false);
    pl_tasks_ranges(l->world->tasks, count, LEAST, sweep_some, l);
    count = list_items(l, PL_TOI_HIT, true);
    if (count > 0) {
        make_manifolds(l, count);
    }
    for (uint32_t i = 0; i < count; ++i) {
        const pl_manifold *then = made_of(l->ahead, i);
        if (then != NULL) {
            pl_looking_items(l->ahead)[((uint32_t *)l->ahead->list.data)[i]].then = *then;
        }
    }
}

//---- which contacts are looked at ----------------------------------------------------------------

// [rad] by which pieces turn in a step that bring other corners forward than those of their manifold.
#define TURNING 0.02

static bool is_turning(const pl_path *p)
{
    double turn = p->flight.turn;
    bool far = fabs(turn) > TURNING;
    for (int i = 0; i < p->turns; ++i) {
        turn += p->change[i].turn;
        far = far || fabs(turn) > TURNING;
    }
    return far;
}

// Whether points may meet that are not of the manifold: of pieces that bounce and turn, but for two round ones.
static bool turns(pl_looking *l, const pl_manifold *m)
{
    return pl_is_elastic(m->restitution) && (m->met & PL_MET_TURNS) != PL_MET_TURNS_MID &&
           (is_turning(pl_looking_path(l, m->body_a)) || is_turning(pl_looking_path(l, m->body_b)));
}

// Lists candidate i.
static bool list(pl_looking *l, uint32_t i)
{
    pl_lookahead *ahead = l->ahead;
    if (!pl_buffer_reserve(&l->world->memory, &ahead->items,
                           ((size_t)ahead->count + 1) * sizeof(pl_toi))) {
        return false;
    }
    const uint32_t candidate = ((const uint32_t *)l->narrow->candidates.data)[i];
    const uint32_t manifold = candidate & PL_CANDIDATE_PLACE;
    const pl_manifold *m = &pl_manifolds(l->narrow)[manifold];
    pl_toi *item = &pl_looking_items(ahead)[ahead->count++]; // the rest comes as it is known
    item->verdict = PL_TOI_OPEN;
    item->pair = m->pair;
    item->manifold = manifold;
    item->sought = (candidate & PL_CANDIDATE_SOUGHT) != 0;
    item->paths = pl_looking_paths(l, m);
    item->turns = turns(l, m);
    ((uint32_t *)ahead->listed.data)[i] = ahead->count;
    return true;
}

// Leaves the mark of those that act to the candidates whose planes do while their bodies fly on. Bodies whose impacts are
// looked for are those of contacts that act, and of those that bounce: what comes back may meet anything.
static bool claim_bodies(pl_looking *l)
{
    uint32_t *candidates = l->narrow->candidates.data;
    const pl_ends *ends = l->narrow->ends.data;
    bool any = false;
    for (uint32_t i = 0; i < l->narrow->candidate_count; ++i) {
        const uint32_t place = candidates[i] & PL_CANDIDATE_PLACE;
        if ((candidates[i] & PL_CANDIDATE_STRIKES) != 0) {
            continue;
        }
        if ((candidates[i] & PL_CANDIDATE_ACTS) != 0) {
            const pl_manifold *m = &pl_manifolds(l->narrow)[place];
            if (!reaches(m, pl_looking_path(l, m->body_a)->flight,
                         pl_looking_path(l, m->body_b)->flight)) {
                candidates[i] &= ~PL_CANDIDATE_ACTS;
            }
        }
        if ((candidates[i] & (PL_CANDIDATE_ACTS | PL_CANDIDATE_BOUNCES | PL_CANDIDATE_SOUGHT)) !=
            0) {
            pl_looking_claim(l, ends[place].a);
            pl_looking_claim(l, ends[place].b);
            any = true;
        }
    }
    return any;
}

// Bodies of contacts whose impacts the solver follows one by one.
static void note_lively(pl_looking *l)
{
    const uint32_t *candidates = l->narrow->candidates.data;
    for (uint32_t i = 0; i < l->narrow->candidate_count; ++i) {
        const pl_manifold *m = &pl_manifolds(l->narrow)[candidates[i] & PL_CANDIDATE_PLACE];
        for (int side = 0; side < 2 && pl_is_elastic(m->restitution); ++side) {
            pl_way *way = pl_looking_known(l, side == 0 ? m->body_a : m->body_b);
            if (way != NULL) {
                way->lively = true;
            }
        }
    }
}

// Whether a point reaches the plane at a time, on the ways that impacts turn.
static bool reaches_at(const pl_manifold *m, const pl_path *a, const pl_path *b, double time)
{
    return time > 0 && time <= 1 && reaches(m, pl_path_at(a, time), pl_path_at(b, time));
}

static bool reaches_turned(pl_looking *l, const pl_manifold *m)
{
    const pl_path *a = pl_looking_path(l, m->body_a), *b = pl_looking_path(l, m->body_b);
    bool acts = reaches_at(m, a, b, 1);
    for (int i = 0; i < PL_TURNS && !acts; ++i) {
        acts = (i < a->turns && reaches_at(m, a, b, a->time[i])) ||
               (i < b->turns && reaches_at(m, a, b, b->time[i]));
    }
    return acts;
}

// Lists the candidates whose planes act, in free flight or where a strike turns it, what turns, and what is sought.
static bool list_acting(pl_looking *l)
{
    const uint32_t *candidates = l->narrow->candidates.data;
    const pl_ends *ends = l->narrow->ends.data;
    for (uint32_t i = 0; i < l->narrow->candidate_count; ++i) {
        const uint32_t place = candidates[i] & PL_CANDIDATE_PLACE;
        if ((candidates[i] & PL_CANDIDATE_STRIKES) != 0) {
            continue;
        }
        const pl_manifold *m = &pl_manifolds(l->narrow)[place];
        const bool struck =
            pl_looking_is_struck(l, ends[place].a) || pl_looking_is_struck(l, ends[place].b);
        if (((candidates[i] & (PL_CANDIDATE_ACTS | PL_CANDIDATE_SOUGHT)) != 0 ||
             (struck && reaches_turned(l, m)) || turns(l, m)) &&
            !list(l, i)) {
            return false;
        }
    }
    return true;
}

// What comes after an impact of a body is due again, by the way that the body takes from there. Sets whether anything is.
static bool list_again(pl_looking *l, bool *any)
{
    const uint32_t *candidates = l->narrow->candidates.data;
    const uint32_t *listed = l->ahead->listed.data;
    const pl_ends *ends = l->narrow->ends.data;
    *any = false;
    for (uint32_t i = 0; i < l->narrow->candidate_count; ++i) {
        const uint32_t place = candidates[i] & PL_CANDIDATE_PLACE;
        if ((candidates[i] & PL_CANDIDATE_STRIKES) != 0) {
            continue;
        }
        if (!pl_looking_is_changed(l, ends[place].a) && !pl_looking_is_changed(l, ends[place].b)) {
            continue;
        }
        const pl_manifold *m = &pl_manifolds(l->narrow)[place];
        if (listed[i] == 0) {
            if (reaches_turned(l, m) || turns(l, m)) {
                *any = true;
                if (!list(l, i)) {
                    return false;
                }
            }
            continue;
        }
        pl_toi *item = &pl_looking_items(l->ahead)[listed[i] - 1];
        const bool meets = item->verdict == PL_TOI_HIT || item->verdict == PL_TOI_KEEPS;
        const double before = meets ? item->meets : PL_SWEEP_NEVER;
        if (!pl_looking_is_same_way(&item->paths.of[0], pl_looking_path(l, ends[place].a),
                                    before) ||
            !pl_looking_is_same_way(&item->paths.of[1], pl_looking_path(l, ends[place].b),
                                    before)) {
            item->paths = pl_looking_paths(l, m);
            item->turns = turns(l, m);
            item->verdict = PL_TOI_OPEN;
            *any = true;
        }
    }
    return true;
}

//---- the pass ------------------------------------------------------------------------------------

// Room for the bodies of all candidates, and for whatever kernels are asked.
static bool reserve(plumb_world *world, pl_lookahead *ahead, uint32_t candidates)
{
    pl_memory *memory = &world->memory;
    const size_t movable = (size_t)world->dynamic_count + world->kinematic_count;
    return pl_buffer_reserve(memory, &ahead->map, movable * sizeof(uint32_t)) &&
           pl_buffer_reserve(memory, &ahead->paths, movable * sizeof(pl_way)) &&
           pl_buffer_reserve(memory, &ahead->listed, candidates * sizeof(uint32_t));
}

static bool reserve_lists(plumb_world *world, pl_lookahead *ahead)
{
    pl_memory *memory = &world->memory;
    const size_t count = ahead->count;
    return pl_buffer_reserve(memory, &ahead->poses, 2 * count * sizeof(pl_pose)) &&
           pl_buffer_reserve(memory, &ahead->pairs, count * sizeof(pl_pair)) &&
           pl_buffer_reserve(memory, &ahead->made, count * sizeof(pl_manifold)) &&
           pl_buffer_reserve(memory, &ahead->unread, count * sizeof(pl_ends)) &&
           pl_buffer_reserve(memory, &ahead->list, count * sizeof(uint32_t)) &&
           pl_ahead_reserve_kept(memory, ahead);
}

static pl_looking open_look(plumb_world *world, const pl_narrow_input *in, real dt,
                            pl_narrow *narrow)
{
    pl_lookahead *ahead = &world->lookahead;
    pl_looking l = { .world = world,
                     .in = in,
                     .narrow = narrow,
                     .ahead = ahead,
                     .horizon = pl_ahead_horizon(world, dt),
                     .movable = world->dynamic_count + world->kinematic_count,
                     .map = ahead->map.data,
                     .all = ahead->paths.data };
    memset(l.map, 0, l.movable * sizeof(uint32_t));
    memset(ahead->listed.data, 0, narrow->candidate_count * sizeof(uint32_t));
    return l;
}

// Whether so much was looked at in this step that the rest of it is left to the solver and the sweeps of continuous/: where
// something goes at a million metres a second everything is struck, by everything, again and again. The wildest scene of ours takes
// 0.4 looks a candidate.
static bool is_enough(const pl_looking *l)
{
    return l->ahead->looks > LOOKS * (l->narrow->candidate_count + LOOKS_LEAST);
}

bool pl_ahead_look(plumb_world *world, const pl_narrow_input *in, real dt, pl_narrow *narrow)
{
    pl_lookahead *ahead = &world->lookahead;
    ahead->count = ahead->kept_count = 0;
    if (narrow->candidate_count == 0) {
        return true;
    }
    if (!reserve(world, ahead, narrow->candidate_count)) {
        return false;
    }
    pl_looking l = open_look(world, in, dt, narrow);
    if (!claim_bodies(&l)) {
        return true;
    }
    if (narrow->any_elastic) {
        note_lively(&l);
    }
    pl_looking_note_strikes(&l);
    if (!list_acting(&l) || !reserve_lists(world, ahead)) {
        return false;
    }
    const int impacts = narrow->any_elastic ? IMPACTS : 1;
    bool any = true;
    for (int i = 0; any && i < impacts; ++i) {
        look_at_open(&l);
        if (!pl_looking_note_meetings(&l, i > 0) || !list_again(&l, &any) ||
            !reserve_lists(world, ahead)) {
            return false;
        }
        if (is_enough(&l)) {
            break;
        }
    }
    if (any) { // the last word is that of the ways as they are now
        look_at_open(&l);
    }
    if (narrow->any_elastic) {
        pl_looking_expire(&l);
    }
    if (narrow == &world->narrow && !is_enough(&l) && !pl_looking_seek(&l)) {
        return false;
    }
    pl_looking_settle(&l);
    return true;
}

void pl_ahead_free(pl_memory *memory, pl_lookahead *ahead)
{
    pl_buffer_free(memory, &ahead->items);
    pl_buffer_free(memory, &ahead->poses);
    pl_buffer_free(memory, &ahead->pairs);
    pl_buffer_free(memory, &ahead->made);
    pl_buffer_free(memory, &ahead->unread);
    pl_buffer_free(memory, &ahead->list);
    pl_buffer_free(memory, &ahead->kept);
    pl_buffer_free(memory, &ahead->map);
    pl_buffer_free(memory, &ahead->paths);
    pl_buffer_free(memory, &ahead->listed);
    pl_buffer_free(memory, &ahead->meetings);
    pl_buffer_free(memory, &ahead->sought);
    pl_buffer_free(memory, &ahead->strays);
    *ahead = (pl_lookahead){ 0 };
}
