// struck.c - whom impacts of this step throw at what has no contact with it.
//
// Boxes and manifolds go by the velocities with which a step begins. A ball at rest that is struck at 10 m/s flies on for
// 16 cm in that step, and the kernels made no manifold with what is farther from it than PL_SPECULATIVE. So the ways
// that impacts turn (turns.c) are followed: every piece that lies in one is asked whether they meet. Pairs that do and have no
// manifold are noted; the pass is run once more with these (step/passes.c), whatever their distance, and so on
// until no way leads to anything new. Whoever sleeps there wakes.
//
// Of what is thrown back (pl_is_elastic) alone: where things are pressed together the first impact of a body tells little
// of where it goes, and to ask for all of them cost a stirred bowl eight times its step.
//
// Reads: ways, grids, pairs. Writes: the list of pairs that are sought. Cost: O(ways); for each body that an impact takes farther
// than half of PL_SPECULATIVE from where it would have flown a query of the grids, and a sweep for each piece there.
#include "broad/images.h"
#include "broad/pairs.h"
#include "core/sort.h"
#include "narrow/looking.h"

#include <math.h>

// [m] a body that strays less from its flight meets nobody whom its contacts do not know of.
#define STRAY ((double)PL_SPECULATIVE / 2)

// [m] how far a body strays from where it would have flown, at the most.
static double stray_of(const pl_looking *l, const pl_way *way)
{
    const pl_path *p = &way->path;
    const double extent = (double)l->world->bodies.extent[way->row];
    double most = 0;
    for (int i = 0; i < p->turns && way->bounces; ++i) {
        const pl_motion *c = &p->change[i];
        most += (fabs(c->x) + fabs(c->y) + fabs(c->turn) * extent) * (1 - p->time[i]);
    }
    return most;
}

// One that strays, and what it passes over from its first impact on.
typedef struct stray {
    pl_box box;
    uint32_t row;
} stray;

static stray *strays(const pl_lookahead *ahead)
{
    return (stray *)ahead->strays.data;
}

static pl_box hull(pl_box a, pl_box b)
{
    return (pl_box){ plumb_min(a.min_x, b.min_x), plumb_min(a.min_y, b.min_y),
                     plumb_max(a.max_x, b.max_x), plumb_max(a.max_y, b.max_y) };
}

// Where a body is at a time of its way, however it is turned.
static pl_box box_at(const pl_looking *l, const pl_way *way, double time)
{
    const pl_pose *pose = &pl_poses(l->world)[way->row];
    const pl_motion m = pl_path_at(&way->path, time);
    const real reach = l->world->bodies.extent[way->row] + PL_TURNED;
    const real x = pose->x + pose->dx + (real)m.x, y = pose->y + pose->dy + (real)m.y;
    return (pl_box){ x - reach, y - reach, x + reach, y + reach };
}

static stray stray_at(const pl_looking *l, const pl_way *way)
{
    stray s = { .box = box_at(l, way, 1), .row = way->row };
    for (int i = 0; i < way->path.turns; ++i) {
        s.box = hull(s.box, box_at(l, way, way->path.time[i]));
    }
    return s;
}

//---- pairs ---------------------------------------------------------------------------------------------

static bool note(pl_looking *l, pl_found found)
{
    pl_lookahead *ahead = l->ahead;
    if (!pl_buffer_reserve(&l->world->memory, &ahead->sought,
                           ((size_t)ahead->sought_count + 1) * sizeof(pl_keyed))) {
        return false;
    }
    ((pl_keyed *)ahead->sought.data)[ahead->sought_count++] =
        (pl_keyed){ .key = pl_key(found.low, found.high) };
    ahead->again = true;
    return true;
}

static bool meet(pl_looking *l, const pl_pair *pair)
{
    const pl_paths paths =
        pl_paths_of(pl_looking_path(l, pair->body_a), pl_looking_path(l, pair->body_b));
    const pl_moving_pair e = pl_moving_pair_of(l->world, pair, &paths);
    return pl_moving_pair_approach(&e, 0, PL_TOI_TOLERANCE).kind == PL_APPROACH_MEETS;
}

// Notes two pieces if they meet and have no manifold.
static bool ask(pl_looking *l, uint32_t p, uint32_t q)
{
    plumb_world *world = l->world;
    if (!pl_pair_is_solid(world, p, q)) {
        return true;
    }
    const pl_pair *listed = pl_pairs_find_one(world, p, q);
    if (listed != NULL && (listed->manifold != PL_NONE || (listed->flags & PL_PAIR_SOUGHT) != 0)) {
        return true;
    }
    const pl_found found = p < q ? (pl_found){ p, q } : (pl_found){ q, p };
    const pl_pair pair = pl_pair_fresh(world, found);
    return !meet(l, &pair) || note(l, found);
}

// Asks all pieces of a body that strays about a piece.
static bool ask_all(pl_looking *l, uint32_t row, uint32_t q)
{
    const pl_pieces *pieces = &l->world->pieces;
    bool done = true;
    for (uint32_t p = l->world->bodies.first_piece[row]; p != PL_NONE && done;
         p = pieces->next_in_body[p]) {
        done = (pieces->flags[p] & PL_PIECE_SENSOR) != 0 || ask(l, p, q);
    }
    return done;
}

//---- who lies in the way -------------------------------------------------------------------------------

typedef struct search {
    pl_looking *l;
    uint32_t row;
    bool resting; // the grid of what sleeps may name others
} search;

static bool visit(void *context, const pl_grid_entry *entry)
{
    const search *s = context;
    const bool asleep = (s->l->world->pieces.flags[entry->piece] & PL_PIECE_ASLEEP) != 0;
    return (s->resting && !asleep) || ask_all(s->l, s->row, entry->piece);
}

static bool seek_in_grids(pl_looking *l, const stray *s)
{
    plumb_world *world = l->world;
    const pl_grid *grids[] = { &world->broad.moving, &world->broad.fixed, &world->broad.resting };
    bool done = true;
    for (int i = 0; i < 3 && done; ++i) {
        search k = { .l = l, .row = s->row, .resting = grids[i] == &world->broad.resting };
        done = pl_world_query(world, grids[i], s->box, visit, &k);
    }
    return done;
}

// Two that stray may meet far from the boxes that both are filed by. In a world that wraps around they do so within one of
// its images only.
static bool seek_among(pl_looking *l, const stray *s, const stray *others, uint32_t count)
{
    bool done = true;
    for (uint32_t i = 0; i < count && done && others[i].box.min_x <= s->box.max_x; ++i) {
        if (!pl_boxes_overlap(&s->box, &others[i].box)) {
            continue;
        }
        for (uint32_t q = l->world->bodies.first_piece[others[i].row]; q != PL_NONE && done;
             q = l->world->pieces.next_in_body[q]) {
            done = ask_all(l, s->row, q);
        }
    }
    return done;
}

// By their keys, each once: two that stray find one another twice, and the order of the grids is none to rely on.
static void sort_sought(pl_lookahead *ahead)
{
    pl_keyed *sought = ahead->sought.data;
    uint32_t kept = 0;
    pl_sort_keyed(sought, ahead->sought_count);
    for (uint32_t i = 0; i < ahead->sought_count; ++i) {
        if (i == 0 || sought[i].key != sought[kept - 1].key) {
            sought[kept++] = sought[i];
        } else {
            sought[kept - 1].value |= sought[i].value; // it was added in a round before
        }
    }
    ahead->sought_count = kept;
}

// From the left to the right.
static bool list_strays(pl_looking *l, uint32_t *count)
{
    pl_lookahead *ahead = l->ahead;
    pl_memory *memory = &l->world->memory;
    const uint32_t ways = l->way_count;
    *count = 0;
    for (uint32_t i = 0; i < ways; ++i) {
        *count += stray_of(l, &l->all[i]) > STRAY;
    }
    if (!pl_buffer_reserve(memory, &ahead->strays, 2 * (size_t)*count * sizeof(stray)) ||
        !pl_buffer_reserve(memory, &ahead->meetings, *count * sizeof(pl_keyed))) {
        return false;
    }
    stray *found = strays(ahead) + *count, *sorted = strays(ahead);
    pl_keyed *order = ahead->meetings.data;
    uint32_t n = 0;
    for (uint32_t i = 0; i < ways; ++i) {
        if (stray_of(l, &l->all[i]) > STRAY) {
            found[n] = stray_at(l, &l->all[i]);
            order[n] = (pl_keyed){ pl_key_of_number((double)found[n].box.min_x), l->all[i].row, n };
            ++n;
        }
    }
    pl_sort_keyed(order, n);
    for (uint32_t i = 0; i < n; ++i) {
        sorted[i] = found[order[i].value];
    }
    return true;
}

bool pl_looking_seek(pl_looking *l)
{
    if (!l->narrow->any_elastic) {
        return true;
    }
    uint32_t count;
    bool done = list_strays(l, &count);
    for (uint32_t i = 0; i < count && done; ++i) {
        const stray *s = &strays(l->ahead)[i];
        done = seek_in_grids(l, s) && seek_among(l, s, s + 1, count - i - 1);
    }
    if (done && l->ahead->again) {
        sort_sought(l->ahead);
    }
    return done;
}
