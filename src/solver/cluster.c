// cluster.c - which bodies are solved together: islands, as many at a time as a cache holds.
//
// Islands do not know of one another: bodies joined by contacts, or by contacts with one kinematic body,
// are one. A cluster of them goes through all sweeps of a step before the next one begins, and its contacts
// stay in the cache meanwhile. In what order islands are solved changes no bit, so clusters may be too
// large for a while: labels are kept from step to step, a contact between two clusters makes one of them,
// and only now and then are the islands looked for anew (union-find with path halving, Tarjan 1983).
//
// What goes through the whole world in a substep (impacts, joints, damping) belongs to cluster 0: it has
// all bodies concerned, with their islands. A world of few contacts is one cluster.
//
// Reads: ends of manifolds, marks of rows. Writes: labels, leaders. Cost: two reads a contact; O(bodies +
// contacts) when islands are looked for.
#include "world/state.h"

#include <string.h>

// Bodies in a cluster at least, if there are as many: 600 bytes each with contacts and manifolds, so that
// a cluster takes a part of a second-level cache. README.md has the table.
#define BODIES 500
// Fewer manifolds than this are not worth dividing.
#define LEAST 1000
// Steps between two looks at most; and at least, while clusters grow together.
#define LOOK_AFTER       64
#define LOOK_AGAIN_AFTER 8

static bool is_divisible(const plumb_world *world)
{
    return world->desc.solver == PLUMB_SOLVER_SOFT && world->narrow.manifold_count >= LEAST;
}

static bool reserve(plumb_world *world, uint32_t movable)
{
    pl_solver *s = &world->solver;
    return pl_buffer_reserve(&world->memory, &s->labels, movable * sizeof(uint32_t)) &&
           pl_buffer_reserve(&world->memory, &s->leaders, movable * sizeof(uint32_t));
}

static uint32_t leader_of(uint32_t *leaders, uint32_t i)
{
    while (leaders[i] != i) {
        leaders[i] = leaders[leaders[i]];
        i = leaders[i];
    }
    return i;
}

// The lower of two leads both. True if they were apart.
static bool join(uint32_t *leaders, uint32_t a, uint32_t b)
{
    a = leader_of(leaders, a);
    b = leader_of(leaders, b);
    leaders[a < b ? b : a] = a < b ? a : b;
    return a != b;
}

//---- what has to be in cluster 0 -----------------------------------------------------------------

static bool has_special(const plumb_world *world)
{
    return world->narrow.any_bounce || world->joints.live > 0 || pl_effects_resist(world);
}

static bool is_special(const plumb_world *world, uint32_t row)
{
    const uint32_t mark = ((const uint32_t *)world->solver.slots.data)[row];
    const pl_bodies *b = &world->bodies;
    return mark != PL_NONE && (mark == PL_ELASTIC || b->first_joint[row] != PL_NONE ||
                               ((b->flags[row] & PL_BODY_TUNED) != 0 && pl_effects_resist(world)));
}

// Makes one island of all special bodies. Returns the first of them; PL_NONE: there is none.
static uint32_t join_special(plumb_world *world, uint32_t movable)
{
    uint32_t first = PL_NONE;
    for (uint32_t row = 0; has_special(world) && row < movable; ++row) {
        if (is_special(world, row)) {
            first = first == PL_NONE ? row : first;
            join(world->solver.leaders.data, first, row);
        }
    }
    return first;
}

// Special bodies that are in other clusters bring these into cluster 0. Returns how many.
static uint32_t fetch_special(plumb_world *world, uint32_t movable)
{
    uint32_t *labels = world->solver.labels.data, joined = 0;
    for (uint32_t row = 0; has_special(world) && row < movable; ++row) {
        if (is_special(world, row)) {
            labels[row] = labels[row] == PL_NONE ? 0 : labels[row];
            joined += join(world->solver.leaders.data, 0, labels[row]);
        }
    }
    return joined;
}

//---- islands -------------------------------------------------------------------------------------

// Islands in the order of their first rows, but for the special one, a new cluster where one is full.
static void label_islands(pl_solver *s, uint32_t movable, uint32_t special)
{
    const uint32_t *slots = s->slots.data;
    uint32_t *leaders = s->leaders.data, *labels = s->labels.data;
    memset(labels, 0, movable * sizeof *labels);
    for (uint32_t row = 0; row < movable; ++row) { // a leader is lower than whom it leads
        leaders[row] = leaders[leaders[row]];
        ++labels[leaders[row]];
    }
    const uint32_t first = special == PL_NONE ? PL_NONE : leaders[special];
    uint32_t label = first != PL_NONE, filled = 0;
    for (uint32_t row = 0; row < movable; ++row) {
        if (slots[row] == PL_NONE) {
            labels[row] = PL_NONE;
        } else if (leaders[row] != row) {
            labels[row] = labels[leaders[row]];
        } else if (row == first) {
            labels[row] = 0;
        } else {
            if (filled >= BODIES) {
                ++label;
                filled = 0;
            }
            filled += labels[row];
            labels[row] = label;
        }
    }
    s->cluster_count = label + (filled > 0);
}

static void look_for_islands(plumb_world *world, uint32_t movable)
{
    pl_solver *s = &world->solver;
    const pl_ends *ends = world->narrow.ends.data;
    uint32_t *leaders = s->leaders.data;
    for (uint32_t row = 0; row < movable; ++row) {
        leaders[row] = row;
    }
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        if (ends[i].a < movable && ends[i].b < movable) {
            join(leaders, ends[i].a, ends[i].b);
        }
    }
    label_islands(s, movable, join_special(world, movable));
    s->cluster_age = 0;
    s->labelled = movable;
}

//---- labels of the step before -------------------------------------------------------------------

// Rows without a label take that of what they touch, clusters that touch are joined. Returns how many
// were.
static uint32_t join_clusters(plumb_world *world, uint32_t movable)
{
    pl_solver *s = &world->solver;
    const pl_ends *ends = world->narrow.ends.data;
    uint32_t *leaders = s->leaders.data, *labels = s->labels.data;
    for (uint32_t i = 0; i < s->cluster_count; ++i) {
        leaders[i] = i;
    }
    for (uint32_t row = s->labelled; row < movable; ++row) {
        labels[row] = PL_NONE;
    }
    s->labelled = movable;
    uint32_t joined = fetch_special(world, movable);
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        const uint32_t row_a = ends[i].a, row_b = ends[i].b;
        if (row_a >= movable || row_b >= movable) {
            continue;
        }
        if (labels[row_a] == labels[row_b]) {
            if (labels[row_a] == PL_NONE) {
                labels[row_a] = labels[row_b] = 0;
            }
        } else if (labels[row_a] == PL_NONE) {
            labels[row_a] = labels[row_b];
        } else if (labels[row_b] == PL_NONE) {
            labels[row_b] = labels[row_a];
        } else {
            joined += join(leaders, labels[row_a], labels[row_b]);
        }
    }
    return joined;
}

// Numbers what is left of the clusters.
static void renumber(pl_solver *s, uint32_t movable)
{
    uint32_t *leaders = s->leaders.data, *labels = s->labels.data, count = 0;
    for (uint32_t i = 0; i < s->cluster_count; ++i) { // a leader is lower than whom it leads
        leaders[i] = leaders[i] == i ? count++ : leaders[leaders[i]];
    }
    for (uint32_t row = 0; row < movable; ++row) {
        labels[row] = labels[row] == PL_NONE ? PL_NONE : leaders[labels[row]];
    }
    s->cluster_count = count;
}

bool pl_solver_cluster(plumb_world *world)
{
    pl_solver *s = &world->solver;
    const uint32_t movable = world->dynamic_count + world->kinematic_count;
    if (!is_divisible(world)) {
        s->cluster_count = 1;
        s->labelled = 0;
    } else if (!reserve(world, movable)) {
        return false;
    } else if (s->labelled == 0 || ++s->cluster_age >= LOOK_AFTER) {
        look_for_islands(world, movable);
    } else if (s->cluster_count > 1 && join_clusters(world, movable) > 0) {
        if (s->cluster_age >= LOOK_AGAIN_AFTER) {
            look_for_islands(world, movable);
        } else {
            renumber(s, movable);
        }
    }
    return pl_buffer_reserve(&world->memory, &s->clusters, s->cluster_count * sizeof(pl_cluster)) &&
           pl_buffer_reserve(&world->memory, &s->cursors,
                             s->cluster_count * PL_COLOR_SLOTS * sizeof(uint32_t));
}
