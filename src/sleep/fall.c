// fall.c - falling asleep: which islands rest as a whole.
//
// Islands are looked for eight times in sleep_time, by the world's clock, so that none falls
// asleep sooner or later for what others do, and only when some body has rested for sleep_time (rest.c):
// union-find with path halving (Tarjan 1983) over the bodies that are candidates, by the contacts of
// this step and the joints. A contact or joint of a candidate with one that is not, or with a
// kinematic one that moves, holds its island awake; so does what drives it (driven.c). An island that
// touches nothing fixed and is joined to nothing fixed floats: nothing would stop it, so it is at rest only if it
// stands still.
//
// Reads: times of rest, pairs, joints. Writes: what lying down does (lie.c). Order: after the narrow phase, before
// anything has moved. Cost: O(pairs + joints) when islands are looked for.
#include "sleep/fall.h"
#include "core/union_find.h"
#include "world/push.h"
#include "world/marks.h"
#include "joints/joint.h"
#include "softbody/softbody.h"
#include "world/check.h"
#include "world/rows.h"

#define LOOKS 8 // [-] for islands, in sleep_time

//---- islands -------------------------------------------------------------------------------------

static bool moves(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    return b->vx[row] != 0 || b->vy[row] != 0 || b->w[row] != 0;
}

bool pl_is_calm(const plumb_world *world, uint32_t row)
{
    return row >= world->dynamic_count + world->kinematic_count ||
           (row >= world->dynamic_count && !moves(world, row));
}

// A contact or joint of two rows; PL_NONE: the world. Only members have a parent.
static void link_rows(plumb_world *world, uint32_t a, uint32_t b)
{
    uint32_t *parents = world->sleep.parents.data;
    uint8_t *held = world->sleep.held.data;
    bool member_a = a < world->dynamic_count && parents[a] != PL_NONE;
    bool member_b = b < world->dynamic_count && parents[b] != PL_NONE;
    if (member_a && member_b) {
        pl_union_join(parents, a, b);
    } else if (member_a && !pl_is_calm(world, b)) {
        held[a] |= PL_HELD;
    } else if (member_b && !pl_is_calm(world, a)) {
        held[b] |= PL_HELD;
    }
}

static void hold_rows(plumb_world *world, uint32_t a, uint32_t b)
{
    const uint32_t *parents = world->sleep.parents.data, members = world->dynamic_count;
    uint8_t *held = world->sleep.held.data;
    if (a < members && parents[a] != PL_NONE) {
        held[a] |= PL_HELD;
    }
    if (b < members && parents[b] != PL_NONE) {
        held[b] |= PL_HELD;
    }
}

// What is fixed bears or ties a member.
static void anchor_rows(plumb_world *world, uint32_t a, uint32_t b)
{
    const uint32_t *parents = world->sleep.parents.data, members = world->dynamic_count;
    uint8_t *held = world->sleep.held.data;
    if (a < members && b >= members && parents[a] != PL_NONE) {
        held[a] |= PL_ANCHORED;
    } else if (b < members && a >= members && parents[b] != PL_NONE) {
        held[b] |= PL_ANCHORED;
    }
}

static uint32_t row_of(const plumb_world *world, plumb_body body)
{
    return plumb_is_null(body) ? PL_NONE : pl_body_row(world, body);
}

// Unites the members that are linked; afterwards the parent of each is its root.
static void link_members(plumb_world *world, uint32_t pair_count, real dt)
{
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    const pl_manifold *m = pl_manifolds(&world->narrow);
    uint32_t a, b;
    for (uint32_t i = 0; i < pair_count; ++i) {
        if (pl_is_linked(&pairs[i]) && pl_linked_rows(world, &pairs[i], &a, &b)) {
            link_rows(world, a, b);
            if ((pairs[i].flags & PL_PAIR_TOUCHING) != 0) {
                anchor_rows(world, a, b);
            }
            if (pairs[i].manifold < world->narrow.manifold_count &&
                pl_sleep_is_carried(world, &m[pairs[i].manifold])) {
                hold_rows(world, a, b);
            }
        }
    }
    uint32_t joint_count = pl_joints_awake(world);
    for (uint32_t i = 0; i < joint_count; ++i) {
        const pl_joint *j = pl_joint_awake(&world->joints, i);
        a = row_of(world, j->a.body), b = row_of(world, j->b.body);
        link_rows(world, a, b);
        anchor_rows(world, a, b);
        if (pl_sleep_is_driven(world, j)) {
            hold_rows(world, a, b);
        }
    }
    pl_sleep_soft_link(world, dt);
    uint32_t *parents = world->sleep.parents.data;
    for (uint32_t i = 0; i < pl_sleep_members(world); ++i) {
        if (parents[i] != PL_NONE) {
            parents[i] = parents[parents[i]];
        }
    }
}

static bool reserve_members(plumb_world *world)
{
    pl_sleep *s = &world->sleep;
    return pl_buffer_reserve(&world->memory, &s->parents,
                             pl_sleep_members(world) * sizeof(uint32_t)) &&
           pl_buffer_reserve(&world->memory, &s->held, pl_sleep_members(world));
}

// Whom a character pushes or weighs on is up with it. Returns how many members that were.
static uint32_t leave_out_pushed_by_characters(plumb_world *world)
{
    uint32_t *parents = world->sleep.parents.data, count = 0;
    const pl_shove *pushes = world->characters.pushes.data;
    for (uint32_t i = 0; world->characters.moved && i < world->characters.push_count; ++i) {
        const uint32_t row = pl_body_row(world, pushes[i].body);
        if (row < world->dynamic_count && parents[row] != PL_NONE && pl_is_pushed(world, row)) {
            parents[row] = PL_NONE;
            ++count;
        }
    }
    return count;
}

// What keeps a member awake keeps its island; what floats is kept by its own motion.
static void hold_islands(plumb_world *world)
{
    const uint32_t *parents = world->sleep.parents.data;
    uint8_t *held = world->sleep.held.data;
    for (uint32_t i = 0; i < pl_sleep_members(world); ++i) {
        if (parents[i] != PL_NONE) {
            held[parents[i]] |= held[i];
        }
    }
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        if (parents[row] != PL_NONE && !(held[parents[row]] & PL_ANCHORED) &&
            !pl_stands_still(world, row)) {
            held[parents[row]] |= PL_HELD;
        }
    }
    pl_sleep_soft_hold(world);
}

// Leaves parents only to those who fall asleep.
static void find_sleepers(plumb_world *world, uint32_t pair_count, real dt)
{
    uint32_t *parents = world->sleep.parents.data, count = 0;
    uint8_t *held = world->sleep.held.data;
    const real tolerance = pl_push_tolerance(world);
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        // Of a force that has come since nothing is to be seen yet.
        const bool rests = pl_is_rested(world, row) && !pl_push_differs(world, row, tolerance);
        parents[row] = rests ? row : PL_NONE;
        held[row] = 0;
        count += rests;
    }
    count -= leave_out_pushed_by_characters(world);
    count += pl_sleep_soft_candidates(world);
    if (count == 0) {
        return;
    }
    link_members(world, pair_count, dt);
    hold_islands(world);
    for (uint32_t i = 0; i < pl_sleep_members(world); ++i) {
        if (parents[i] != PL_NONE) {
            parents[i] = held[parents[i]] & PL_HELD ? PL_NONE : parents[i];
        }
    }
}

// Puts all members to sleep that have a parent; `steps`: in a step, not by a call. False: out of memory, and nothing has changed.
static bool lay_members(plumb_world *world, uint32_t pair_count, bool steps)
{
    const uint32_t *parents = world->sleep.parents.data;
    uint32_t bodies = 0;
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        bodies += parents[row] != PL_NONE;
    }
    if (bodies > 0 && !pl_lie_reserve(world, pair_count, bodies)) {
        return false;
    }
    pl_sleep_soft_lie(world);
    if (bodies > 0) {
        if (steps) {
            pl_lie_tell(world);
        }
        pl_lie_down(world, pair_count, steps);
        world->rows_moved = steps ? false : world->rows_moved; // pairs and manifolds know
    }
    return true;
}

//---- the pass ------------------------------------------------------------------------------------

bool pl_sleep_fall(plumb_world *world, real dt)
{
    pl_sleep *s = &world->sleep;
    const uint64_t step = world->step_count + 1;
    const uint32_t pair_count = s->tested_step == step ? world->broad.pairs.count : 0;
    if (s->timed_step != step) {
        s->timed_step = step;
        s->since += s->passed;
        s->candidate_in -= s->passed;
        pl_rest_pass(world, s->passed);
        pl_soft_rest_pass(world, s->passed);
        s->passed = dt;
        world->quarantine.since = s->since;
    } else if (world->quarantine.attempt > 0) {
        pl_rest_again(world);
    }
    pl_rest_around_changed(world, pair_count);
    if (s->since * LOOKS < world->desc.sleep_time) {
        return true;
    }
    if (s->candidate_in <= 0) {
        s->since = 0;
        return true;
    }
    if (!reserve_members(world)) {
        return false;
    }
    find_sleepers(world, pair_count, dt);
    if (!lay_members(world, pair_count, true)) {
        return false;
    }
    s->since = 0;
    return true;
}

//---- by command ----------------------------------------------------------------------------------

// Whether nobody of the island may not sleep.
static plumb_result check_members(const plumb_world *world, const char *function, uint32_t root)
{
    const uint32_t *parents = world->sleep.parents.data;
    for (uint32_t r = 0; r < world->dynamic_count; ++r) {
        if (parents[r] == root && (world->bodies.flags[r] & PL_BODY_NO_SLEEP) != 0) {
            return pl_fail(world, PLUMB_E_STATE, function,
                           "body is in an island with one that may not sleep (%u:%u)",
                           (unsigned)world->bodies.entity[r].entity.index,
                           (unsigned)world->bodies.entity[r].entity.generation);
        }
    }
    for (uint32_t i = 0; i < world->softbodies.count; ++i) {
        const pl_softbody *item = &pl_softbody_items(&world->softbodies)[i];
        if (parents[world->dynamic_count + i] == root && item->no_sleep) {
            return pl_fail(world, PLUMB_E_STATE, function,
                           "it is in an island with a soft body that may not sleep (%u:%u)",
                           (unsigned)item->entity.entity.index,
                           (unsigned)item->entity.entity.generation);
        }
    }
    return PLUMB_OK;
}

plumb_result pl_sleep_put_to_sleep(plumb_world *world, const char *function, uint32_t member)
{
    // Contacts are those of the last step, if it had any.
    const uint32_t pair_count =
        world->sleep.tested_step == world->step_count ? world->broad.pairs.count : 0;
    if (!reserve_members(world)) {
        return pl_fail_memory(world, function);
    }
    uint32_t *parents = world->sleep.parents.data;
    uint8_t *held = world->sleep.held.data;
    for (uint32_t i = 0; i < pl_sleep_members(world); ++i) {
        const bool sleeps = i >= world->dynamic_count &&
                            pl_softbody_items(&world->softbodies)[i - world->dynamic_count].asleep;
        parents[i] = sleeps ? PL_NONE : i;
        held[i] = 0;
    }
    link_members(world, pair_count, 0);
    const uint32_t root = parents[member];
    PL_TRY(check_members(world, function, root));
    for (uint32_t i = 0; i < pl_sleep_members(world); ++i) {
        parents[i] = parents[i] == root ? root : PL_NONE;
    }
    return lay_members(world, pair_count, false) ? PLUMB_OK : pl_fail_memory(world, function);
}
