// cluster.c - which bodies are solved together: islands, as many at a time as a cache holds.
//
// Islands do not know of one another: bodies tied by contacts or joints, or to one kinematic body, are one.
// A cluster of them goes through all sweeps of a step before the next one begins, and its contacts and
// joints stay in the cache meanwhile. In what order islands are solved changes no bit, so islands may be
// too large for a while: they are kept from step to step, a tie between two makes them one, and only now
// and then are they looked for anew (union-find with path halving, Tarjan 1983). An island stays in the
// cluster it was put into: a few that meet do not make one cluster of many.
//
// What goes through the whole world in a substep (impacts, damping) belongs to cluster 0: it has all
// bodies concerned, with their islands. A world of few contacts and joints is one cluster.
//
// Reads: ends of manifolds and joints, marks of rows. Writes: islands, their homes, labels of rows. Cost:
// two reads a contact or joint, one a body; O(bodies + contacts + joints) when islands are looked for.
#include "solver/solver.h"
#include "core/union_find.h"
#include "effects/effects.h"
#include "joints/joint.h"
#include "world/state.h"

#include <string.h>

// Bodies in a cluster at least, if there are as many: 600 bytes each with contacts and manifolds, so that
// a cluster takes a part of a second-level cache. DECISIONS.md has the table.
#define BODIES 500
// Fewer manifolds than this are not worth dividing; a joint, swept twice as often, counts as two.
#define LEAST 1000
// Steps between two looks at most; and at least, while islands grow together or joints change.
#define LOOK_AFTER       64
#define LOOK_AGAIN_AFTER 8

static bool is_divisible(const plumb_world *world)
{
    return world->desc.solver == PLUMB_SOLVER_SOFT &&
           world->narrow.manifold_count + 2 * pl_joints_tied(world) >= LEAST;
}

static bool reserve(plumb_world *world, uint32_t movable)
{
    pl_solver *s = &world->solver;
    return pl_buffer_reserve(&world->memory, &s->labels, movable * sizeof(uint32_t)) &&
           pl_buffer_reserve(&world->memory, &s->islands, movable * sizeof(uint32_t)) &&
           pl_buffer_reserve(&world->memory, &s->homes, movable * sizeof(uint32_t)) &&
           pl_buffer_reserve(&world->memory, &s->leaders, movable * sizeof(uint32_t));
}

//---- what has to be in cluster 0 -----------------------------------------------------------------

// Tells which rows have to be: of elastic bodies, and of those that a system acts on alone (step/acting.c).
typedef struct special_rows {
    const uint32_t *marks;
    const uint8_t *called; // NULL: no system acts alone
    uint32_t dynamic;
    bool any;
} special_rows;

static special_rows specials_of(const plumb_world *world)
{
    const bool alone = world->effects.any_alone;
    return (special_rows){ world->solver.slots.data, alone ? world->effects.called.data : NULL,
                           world->dynamic_count, world->solver.follows_impacts || alone };
}

static inline bool is_special(const special_rows *s, uint32_t row)
{
    return s->marks[row] != PL_NONE &&
           (s->marks[row] == PL_ELASTIC ||
            (s->called != NULL && row < s->dynamic && (s->called[row] & PL_CALLED_ALONE) != 0));
}

//---- looking for islands -------------------------------------------------------------------------

static void join_rows(uint32_t *leaders, const pl_ends *ends, uint32_t count, uint32_t movable)
{
    for (uint32_t i = 0; i < count; ++i) {
        if (ends[i].a < movable && ends[i].b < movable) {
            pl_union_join(leaders, ends[i].a, ends[i].b);
        }
    }
}

// Numbers islands in the order of their first rows; `homes` counts their bodies meanwhile.
static void number_islands(pl_solver *s, uint32_t movable)
{
    const uint32_t *slots = s->slots.data;
    uint32_t *leaders = s->leaders.data, *islands = s->islands.data, *homes = s->homes.data;
    s->island_count = 0;
    for (uint32_t row = 0; row < movable; ++row) { // a leader is lower than whom it leads
        const uint32_t leader = leaders[row] = leaders[leaders[row]];
        if (slots[row] == PL_NONE) {
            islands[row] = PL_NONE;
        } else if (leader != row) {
            ++homes[islands[row] = islands[leader]];
        } else {
            homes[islands[row] = s->island_count++] = 1;
        }
    }
}

// Islands in order, but for those with special bodies, a new cluster where one is full.
static void give_homes(const plumb_world *world, pl_solver *s, uint32_t movable)
{
    const special_rows specials = specials_of(world);
    const uint32_t *islands = s->islands.data;
    uint32_t *homes = s->homes.data, home = 0, filled = 0;
    for (uint32_t row = 0; specials.any && row < movable; ++row) {
        if (is_special(&specials, row)) {
            homes[islands[row]] = PL_NONE;
            home = 1;
        }
    }
    for (uint32_t i = 0; i < s->island_count; ++i) {
        const uint32_t bodies = homes[i];
        if (bodies == PL_NONE) {
            homes[i] = 0;
            continue;
        }
        if (filled >= BODIES) {
            ++home;
            filled = 0;
        }
        homes[i] = home;
        filled += bodies;
    }
    s->cluster_count = home + (filled > 0 || home == 0);
}

static void look_for_islands(plumb_world *world, uint32_t movable)
{
    pl_solver *s = &world->solver;
    pl_union_reset(s->leaders.data, movable);
    join_rows(s->leaders.data, world->narrow.ends.data, world->narrow.manifold_count, movable);
    join_rows(s->leaders.data, world->joints.plan.ends.data, pl_joints_tied(world), movable);
    number_islands(s, movable);
    give_homes(world, s, movable);
    s->cluster_age = 0;
    s->labelled = movable;
}

//---- islands of the step before ------------------------------------------------------------------

// Rows without an island take that of what they are tied to, two of them the first one; islands that are
// tied are joined. Returns how often either happened to two rows or islands.
static uint32_t join_islands(pl_solver *s, const pl_ends *ends, uint32_t count, uint32_t movable)
{
    uint32_t *leaders = s->leaders.data, *islands = s->islands.data, joined = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t row_a = ends[i].a, row_b = ends[i].b;
        if (row_a >= movable || row_b >= movable) {
            continue;
        }
        if (islands[row_a] == islands[row_b]) {
            if (islands[row_a] == PL_NONE) {
                islands[row_a] = islands[row_b] = 0;
                ++joined;
            }
        } else if (islands[row_a] == PL_NONE) {
            islands[row_a] = islands[row_b];
        } else if (islands[row_b] == PL_NONE) {
            islands[row_b] = islands[row_a];
        } else {
            joined += pl_union_join(leaders, islands[row_a], islands[row_b]);
        }
    }
    return joined;
}

// Islands with special bodies move into cluster 0.
static void fetch_specials(const plumb_world *world, pl_solver *s, uint32_t movable)
{
    const special_rows specials = specials_of(world);
    const uint32_t *islands = s->islands.data;
    uint32_t *homes = s->homes.data;
    for (uint32_t row = 0; specials.any && row < movable; ++row) {
        if (is_special(&specials, row) && islands[row] != PL_NONE) {
            homes[pl_union_leader(s->leaders.data, islands[row])] = 0;
        }
    }
}

// Returns how much has changed.
static uint32_t follow_islands(plumb_world *world, uint32_t movable)
{
    pl_solver *s = &world->solver;
    uint32_t *leaders = s->leaders.data, *islands = s->islands.data;
    for (uint32_t row = s->labelled; row < movable; ++row) {
        islands[row] = PL_NONE;
    }
    s->labelled = movable;
    pl_union_reset(leaders, s->island_count);
    const uint32_t joined =
        join_islands(s, world->narrow.ends.data, world->narrow.manifold_count, movable) +
        join_islands(s, world->joints.plan.ends.data, pl_joints_tied(world), movable);
    fetch_specials(world, s, movable);
    for (uint32_t row = 0; joined > 0 && row < movable; ++row) {
        islands[row] = islands[row] == PL_NONE ? PL_NONE : pl_union_leader(leaders, islands[row]);
    }
    return joined;
}

//---- labels --------------------------------------------------------------------------------------

// Bodies that are tied to nothing that moves may be anywhere.
static void label_rows(pl_solver *s, uint32_t movable)
{
    const uint32_t *islands = s->islands.data, *homes = s->homes.data;
    uint32_t *labels = s->labels.data;
    for (uint32_t row = 0; row < movable; ++row) {
        labels[row] = islands[row] == PL_NONE ? 0 : homes[islands[row]];
    }
}

static void find_clusters(plumb_world *world, uint32_t movable)
{
    pl_solver *s = &world->solver;
    if (s->labelled == 0 || ++s->cluster_age >= LOOK_AFTER) {
        look_for_islands(world, movable);
    } else {
        const bool grown = s->cluster_count > 1 && follow_islands(world, movable) > 0;
        if ((grown || pl_joints_changed(world)) && s->cluster_age >= LOOK_AGAIN_AFTER) {
            look_for_islands(world, movable);
        }
    }
    if (s->cluster_count > 1) {
        label_rows(s, movable);
    }
}

bool pl_solver_cluster(plumb_world *world)
{
    pl_solver *s = &world->solver;
    const uint32_t movable = world->dynamic_count + world->kinematic_count;
    const uint32_t apart =
        (s->fine_cluster != PL_NONE ? 1u : 0) + (s->hard_cluster != PL_NONE ? 1u : 0);
    s->cluster_count = s->cluster_count > apart ? s->cluster_count - apart : s->cluster_count;
    s->fine_cluster = s->hard_cluster = PL_NONE;
    s->fine_islands = s->hard_count = s->hard_islands = 0;
    if (!is_divisible(world)) {
        s->cluster_count = 1;
        s->labelled = 0;
    } else if (!reserve(world, movable)) {
        return false;
    } else {
        find_clusters(world, movable);
    }
    return true;
}
