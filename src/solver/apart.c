// apart.c - islands of a world of the soft step that are solved apart from the others: hard ones exactly, fine ones in finer substeps.
//
// Hard are small islands that sweeps cannot hold, as seeds among their contacts tell (exact/hard.c).
//
// Fine are those of small worlds, of SMALL contacts and joints at the most: there a substep costs nothing to speak of, and
// 16 of them, stiffer contacts and five more relaxing sweeps hold what four do not: books, cards, arches, what was pushed together
// (DECISIONS.md). So that a game which asks for nothing gets that, each substep of an island in which two dynamic bodies touch
// is PL_FINER shorter ones, of 16 a step at the most, whatever else there is: a world that becomes large is swept as it says.
// Not what is followed as events, or acted on alone (cluster 0), nor while systems of the user's run in substeps: these count them.
// Nor hard or fine is what a kinematic body crushes: nothing solves that, and the more is done about it, the more impulse there is.
// Contacts become stiffer in their own time, as where steps become shorter (soft.c): the pair keeps a level, which a clock of the
// world's raises, and between two levels goes by its hand. One that bore nothing has nothing stored, and is as stiff at once.
// Joints stay as stiff as the world's: what touches and lets go again each few steps would wind a bridge of joints up (DECISIONS.md).
//
// An island is all that hangs together by contacts and joints, through kinematic bodies too, as in cluster.c, but found anew
// in each step: it depends on the past by a few flags a pair. Hard ones have PL_HARD_MOST contacts and joints at the most, none of
// which bounces or is driven. All of a step together have UNEVEN_MOST that are near: a direct solution takes a hundred times as long
// as sweeps, and no frame is to be missed for what nobody asked for. Those whose seeds are but pressed, between masses that sweeps can
// hold, have PRESSED_MOST. Where there are more, those go on that were hard in the last step, then small ones come first.
//
// Reads: manifolds, ends, joints, flags of pairs. Writes: labels of rows, hard contacts, flags of pairs, impulses of manifolds. Order:
// behind clusters and seeds, before the graph; pl_fine_note behind the substeps. Cost: O(contacts + bodies) where there are seeds or
// the world is small.
#include "core/union_find.h"
#include "effects/effects.h"
#include "joints/joint.h"
#include "solver/solver.h"
#include "world/joint_list.h"
#include "world/state.h"

#include <math.h>
#include <string.h>

#define SMALL        512 // contacts and joints of a world with fine islands
#define UNEVEN_MOST  48 // contacts that are near, and joints, of all hard islands with uneven seeds
#define PRESSED_MOST 32 // likewise, with seeds of even masses alone
#define FINEST       16 // substeps of a fine island

// [m] of a contact with what moves by itself: whoever bears that is crushed. What a lift carries or a plough pushes sinks in by less.
#define CRUSHED ((near_real)5e-3)

// [m] of a contact that counts; what is farther off takes no time of the direct method.
#define NEAR ((near_real)1e-3)

// [s] in which stiffness rises by one of PL_STIFF_LEVELS: by e in half a second, as in soft.c.
#define LEVEL_TIME 0.0533190138892265 // 0.5 ln 4 / 13

typedef struct pl_apart_tally {
    uint32_t contacts; // and joints
    uint32_t near;     // likewise, but contacts of surfaces that are near alone
    bool seeded;       // some contact is a seed of a hard island
    bool uneven;       // likewise, and one body of the contact is much heavier
    bool before;       // some contact was of a hard island in the last step
    bool hard;         // solved exactly
    bool barred;       // not to be solved exactly
    bool crushed;      // a kinematic body presses into it
    bool stirred;      // two dynamic bodies touch
    bool bound;        // to cluster 0
} pl_apart_tally;

typedef struct search {
    plumb_world *world;
    const pl_ends *ends, *ties;
    uint32_t contacts, joints, movable, dynamic;
    uint32_t *leaders;
    pl_apart_tally *tallies; // of leaders
    bool fine;               // the world may have fine islands
} search;

bool pl_are_uneven(const plumb_world *world, uint32_t row_a, uint32_t row_b)
{
    const uint32_t dynamic = world->dynamic_count;
    const double a = row_a < dynamic ? (double)world->bodies.inv_mass[row_a] : 0;
    const double b = row_b < dynamic ? (double)world->bodies.inv_mass[row_b] : 0;
    return (a > PL_UNEVEN * b && b > 0) || (b > PL_UNEVEN * a && a > 0);
}

static bool is_seed(const search *s, uint32_t i)
{
    return (pl_pair_of(s->world, &pl_manifolds(&s->world->narrow)[i])->flags & PL_PAIR_PRESSED) !=
           0;
}

static bool any_seed(const search *s)
{
    bool any = false;
    for (uint32_t i = 0; !any && i < s->contacts; ++i) {
        any = is_seed(s, i);
    }
    return any;
}

int pl_fine_times(const plumb_world *world)
{
    const int n = FINEST / world->desc.substeps;
    return n < 2 ? 1 : n < PL_FINER ? 2 : PL_FINER;
}

uint32_t pl_fine_substeps(const plumb_world *world)
{
    const int n = world->desc.substeps * pl_fine_times(world);
    return world->solver.fine_islands > 0 ? (uint32_t)n : 0;
}

static bool may_be_fine(const plumb_world *world, uint32_t constraints)
{
    return !world->desc.no_fine_islands && constraints <= SMALL && world->systems.in_substeps == 0;
}

//---- islands -------------------------------------------------------------------------------------------

static uint32_t leader_of(const search *s, const pl_ends *e)
{
    const uint32_t row = e->a < s->movable ? e->a : e->b;
    return row < s->movable ? pl_union_leader(s->leaders, row) : PL_NONE;
}

static void join(const search *s, const pl_ends *ends, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        if (ends[i].a < s->movable && ends[i].b < s->movable) {
            pl_union_join(s->leaders, ends[i].a, ends[i].b);
        }
    }
}

// Driven by a bounded force: what it moves is never at rest for long, and the car of car_bridge.lua throws an exact bridge about.
static bool is_driven(const plumb_joint_desc *d)
{
    return d->enable_motor || d->kind == PLUMB_MOUSE || d->kind == PLUMB_MOTOR ||
           d->kind == PLUMB_FRICTION;
}

static void tally_joints(const search *s)
{
    const uint32_t *awake = s->world->joints.awake.data;
    for (uint32_t i = 0; i < s->joints; ++i) {
        const uint32_t leader = leader_of(s, &s->ties[i]);
        if (leader != PL_NONE) {
            pl_apart_tally *t = &s->tallies[leader];
            ++t->contacts;
            ++t->near;
            const plumb_joint_desc *d = &pl_joint_items(&s->world->joints)[awake[i]].desc;
            t->barred |= pl_joint_bounces(d) || is_driven(d);
        }
    }
}

// A kinematic body of that row comes along a normal, at a point beside its centre.
static bool comes(const search *s, uint32_t row, double rx, double ry, double nx, double ny)
{
    const pl_bodies *b = &s->world->bodies;
    const double w = (double)b->w[row];
    return row >= s->dynamic && row < s->movable &&
           ((double)b->vx[row] - w * ry) * nx + ((double)b->vy[row] + w * rx) * ny > 0;
}

static bool is_crushing(const search *s, uint32_t i)
{
    const pl_manifold *m = &pl_manifolds(&s->world->narrow)[i];
    const pl_manifold_point *p = &m->point[0];
    const double nx = (double)m->nx, ny = (double)m->ny;
    return pl_is_near(m, -CRUSHED) &&
           (comes(s, s->ends[i].a, (double)p->ax, (double)p->ay, nx, ny) ||
            comes(s, s->ends[i].b, (double)p->bx, (double)p->by, -nx, -ny));
}

static void tally_contacts(const search *s)
{
    const pl_manifold *m = pl_manifolds(&s->world->narrow);
    for (uint32_t i = 0; i < s->contacts; ++i) {
        pl_apart_tally *t = &s->tallies[leader_of(s, &s->ends[i])];
        ++t->contacts;
        t->near += pl_is_near(&m[i], NEAR);
        t->seeded |= is_seed(s, i);
        t->uneven |= is_seed(s, i) && pl_are_uneven(s->world, s->ends[i].a, s->ends[i].b);
        t->before |= (pl_pair_of(s->world, &m[i])->flags & PL_PAIR_EXACT) != 0;
        t->barred |= m[i].restitution > 0;
        t->crushed |= is_crushing(s, i);
        t->stirred |= s->ends[i].a < s->dynamic && s->ends[i].b < s->dynamic;
    }
}

// What has to be in cluster 0 (cluster.c).
static void tally_bound(const search *s)
{
    const uint8_t *called = s->world->effects.called.data;
    const uint32_t *marks = s->world->solver.slots.data;
    for (uint32_t row = 0; s->world->effects.any_alone && row < s->dynamic; ++row) {
        if ((called[row] & PL_CALLED_ALONE) != 0) {
            pl_apart_tally *t = &s->tallies[pl_union_leader(s->leaders, row)];
            t->barred = t->bound = true;
        }
    }
    for (uint32_t row = 0; s->fine && s->world->solver.follows_impacts && row < s->movable; ++row) {
        if (marks[row] == PL_ELASTIC) {
            s->tallies[pl_union_leader(s->leaders, row)].bound = true;
        }
    }
}

static void tally(const search *s)
{
    pl_union_reset(s->leaders, s->movable);
    memset(s->tallies, 0, s->movable * sizeof *s->tallies);
    join(s, s->ends, s->contacts);
    join(s, s->ties, s->joints);
    tally_contacts(s);
    tally_joints(s);
    tally_bound(s);
}

// Islands that may be hard, of one kind of seeds: how many there are of each size, those that were hard before first.
typedef struct ranks {
    uint32_t islands[2][PL_HARD_MOST + 1]; // by contacts that are near, and joints
} ranks;

static uint32_t *rank_of(const search *s, uint32_t leader, bool uneven, ranks *r)
{
    const pl_apart_tally *t = &s->tallies[leader];
    const bool may = t->seeded && !t->barred && !t->crushed && t->uneven == uneven;
    return may && t->contacts <= PL_HARD_MOST ? &r->islands[!t->before][t->near] : NULL;
}

// Islands of the kind, in the order of their ranks and then of their rows, while there is room for that many contacts and joints.
static void choose_hard(const search *s, bool uneven, uint32_t room)
{
    ranks r = { 0 };
    for (uint32_t row = 0; row < s->movable; ++row) {
        uint32_t *rank = rank_of(s, row, uneven, &r);
        if (rank != NULL) {
            ++*rank;
        }
    }
    for (uint32_t i = 0; i < 2; ++i) {
        for (uint32_t size = 0; size <= PL_HARD_MOST; ++size) {
            uint32_t *islands = &r.islands[i][size];
            *islands = size * *islands <= room ? *islands : room / size;
            room -= *islands * size;
        }
    }
    for (uint32_t row = 0; row < s->movable; ++row) {
        uint32_t *rank = rank_of(s, row, uneven, &r);
        if (rank != NULL && *rank > 0) {
            --*rank;
            s->tallies[row].hard = true;
        }
    }
}

static bool is_hard(const search *s, uint32_t leader)
{
    return s->tallies[leader].hard;
}

static bool is_fine(const search *s, uint32_t leader)
{
    const pl_apart_tally *t = &s->tallies[leader];
    return s->fine && t->stirred && !t->bound && !t->crushed && !is_hard(s, leader);
}

typedef bool is_apart(const search *s, uint32_t leader);

// All of a kind are one more cluster. Returns it; PL_NONE: there are none.
static uint32_t label(const search *s, is_apart *kind, uint32_t *islands)
{
    pl_solver *solver = &s->world->solver;
    const uint32_t *slots = solver->slots.data;
    uint32_t *labels = solver->labels.data;
    for (uint32_t row = 0; row < s->movable; ++row) {
        *islands += slots[row] != PL_NONE && s->leaders[row] == row && kind(s, row);
    }
    if (*islands == 0) {
        return PL_NONE;
    }
    if (solver->cluster_count == 1) {
        memset(labels, 0, s->movable * sizeof *labels);
    }
    const uint32_t cluster = solver->cluster_count++;
    for (uint32_t row = 0; row < s->movable; ++row) {
        if (slots[row] != PL_NONE && kind(s, pl_union_leader(s->leaders, row))) {
            labels[row] = cluster;
        }
    }
    return cluster;
}

static void list_hard_contacts(const search *s)
{
    pl_solver *solver = &s->world->solver;
    uint32_t *contacts = solver->hard_contacts.data;
    for (uint32_t i = 0; solver->hard_islands > 0 && i < s->contacts; ++i) {
        if (is_hard(s, leader_of(s, &s->ends[i]))) {
            contacts[solver->hard_count++] = i;
        }
    }
}

// What is too large to be solved exactly, or finds no room, is not asked about until the next look.
static void forget_large(const search *s)
{
    bool kept = false;
    for (uint32_t i = 0; i < s->contacts; ++i) {
        pl_pair *pair = pl_pair_of(s->world, &pl_manifolds(&s->world->narrow)[i]);
        if ((pair->flags & PL_PAIR_PRESSED) == 0) {
            continue;
        }
        if (is_hard(s, leader_of(s, &s->ends[i]))) {
            kept = true;
        } else {
            pair->flags = (pair->flags & ~PL_PAIR_PRESSED) | PL_PAIR_LARGE;
        }
    }
    s->world->solver.hard_pressed = kept;
}

static bool reserve(plumb_world *world, search *s)
{
    pl_solver *solver = &world->solver;
    if (!pl_buffer_reserve(&world->memory, &solver->apart_leaders, s->movable * sizeof(uint32_t)) ||
        !pl_buffer_reserve(&world->memory, &solver->apart_tallies,
                           s->movable * sizeof(pl_apart_tally)) ||
        !pl_buffer_reserve(&world->memory, &solver->hard_contacts,
                           (world->solver.hard_pressed ? s->contacts : 0) * sizeof(uint32_t)) ||
        !pl_buffer_reserve(&world->memory, &solver->labels, s->movable * sizeof(uint32_t))) {
        return false;
    }
    s->leaders = solver->apart_leaders.data;
    s->tallies = solver->apart_tallies.data;
    return true;
}

static bool find(plumb_world *world)
{
    const uint32_t dynamic = world->dynamic_count;
    search s = { .world = world,
                 .ends = world->narrow.ends.data,
                 .ties = world->joints.plan.ends.data,
                 .contacts = world->narrow.manifold_count,
                 .joints = pl_joints_tied(world),
                 .movable = dynamic + world->kinematic_count,
                 .dynamic = dynamic };
    if (s.contacts == 0) {
        return true;
    }
    s.fine = may_be_fine(world, s.contacts + s.joints);
    const bool seeded = world->solver.hard_pressed && any_seed(&s);
    if (!s.fine && !seeded) {
        return true;
    }
    if (!reserve(world, &s)) {
        return false;
    }
    tally(&s);
    if (seeded) {
        choose_hard(&s, true, UNEVEN_MOST);
        choose_hard(&s, false, PRESSED_MOST);
    }
    pl_solver *solver = &world->solver;
    if (s.fine) {
        solver->fine_cluster = label(&s, is_fine, &solver->fine_islands);
    }
    if (seeded) {
        solver->hard_cluster = label(&s, is_hard, &solver->hard_islands);
        list_hard_contacts(&s);
        forget_large(&s);
    }
    return true;
}

// What was solved exactly and is swept again begins without impulses: those of the direct method share a load out among rows that
// say the same as they like, and a sweep that starts from them throws. Who it was is told behind the substeps (pl_hard_note): a
// step that runs out of memory before is taken again as it was.
static void hand_over(const plumb_world *world)
{
    const pl_solver *solver = &world->solver;
    const uint32_t *hard = solver->hard_contacts.data;
    for (uint32_t i = 0, at = 0; solver->hard_before && i < world->narrow.manifold_count; ++i) {
        pl_manifold *m = &pl_manifolds(&world->narrow)[i];
        const bool is_hard = at < solver->hard_count && hard[at] == i;
        const uint32_t flags = pl_pair_of(world, m)->flags;
        for (uint32_t k = 0; k < m->count && !is_hard && (flags & PL_PAIR_EXACT) != 0; ++k) {
            m->point[k].normal = m->point[k].tangent = 0;
        }
        at += is_hard;
    }
}

bool pl_apart_find(plumb_world *world)
{
    if (!find(world)) {
        return false;
    }
    hand_over(world);
    return true;
}

//---- how stiff contacts of fine islands are ------------------------------------------------------------

pl_fine_clock pl_fine_clock_of(const plumb_world *world, real dt)
{
    const double before = floor(world->time / LEVEL_TIME),
                 at = (world->time + (double)dt) / LEVEL_TIME;
    const double rise = floor(at) - before;
    return (pl_fine_clock){ .rise = rise < PL_STIFF_LEVELS ? (uint32_t)rise : PL_STIFF_LEVELS,
                            .top = pl_fine_top(pl_fine_times(world)),
                            .phase = (near_real)(at - floor(at)) };
}

void pl_fine_note(plumb_world *world, real dt)
{
    pl_solver *solver = &world->solver;
    if (world->quarantine.again || // a step that is taken anew begins as it did
        (!solver->fine_before && solver->fine_cluster == PL_NONE)) {
        return;
    }
    const uint32_t *labels = solver->labels.data;
    const pl_fine_clock clock = pl_fine_clock_of(world, dt);
    const pl_ends *ends = world->narrow.ends.data;
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        const pl_manifold *m = &pl_manifolds(&world->narrow)[i];
        pl_pair *pair = pl_pair_of(world, m);
        const uint32_t row = ends[i].a < world->dynamic_count ? ends[i].a : ends[i].b;
        const bool fine = solver->fine_cluster != PL_NONE && labels[row] == solver->fine_cluster;
        const uint32_t level = fine ? pl_fine_level(pair->flags, m, &clock) : 0;
        pair->flags = (pair->flags & ~PL_PAIR_STIFF_MASK) | level << PL_PAIR_STIFF_SHIFT;
    }
    solver->fine_before = solver->fine_cluster != PL_NONE;
}
