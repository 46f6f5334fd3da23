// assembly.c - bodies that joints tie together, and which of these assemblies are kicked whole.
//
// Kicks in halves (solver/halves.c) keep what swings swinging, and need joints that are solved well. Two are not (DECISIONS.md):
//   uneven   a body stands by a joint on one that is much lighter, and that on a contact: of two halves, sweeps leave more
//            undone than of one whole. A cart of 640 times the mass of its wheels bounces by 0.44 m instead of 0.13 m
//   looped   joints in a loop, all solved together (direct.c), may ask for what cannot be: nothing damps what comes of it
//
// Reads: marks, order, masses, colours of contacts. Writes: assemblies, shares of kicks. Cost: O(joints) where a plan is made,
// and, by the soft step, a step with contacts or direct joints.
#include "joints/joint.h"
#include "core/fill.h"
#include "core/union_find.h"
#include "world/state.h"

// Masses of two bodies that a joint ties, one over the other, from which on it is uneven.
#define UNEVEN 10

// What an assembly is.
#define IS_TOUCHED 1u // by a contact, in this step
#define IS_UNEVEN  2u
#define IS_DIRECT  4u // joints of it are solved together

bool pl_assemblies_reserve(plumb_world *world)
{
    pl_joint_plan *plan = &world->joints.plan;
    const size_t rows = world->dynamic_count;
    return pl_buffer_reserve(&world->memory, &plan->leaders, rows * sizeof(uint32_t)) &&
           pl_buffer_reserve(&world->memory, &plan->looped, rows * sizeof(uint8_t)) &&
           pl_buffer_reserve(&world->memory, &plan->states, rows * sizeof(uint8_t)) &&
           pl_buffer_reserve(&world->memory, &plan->hubs, rows * sizeof(pl_hub));
}

static bool ties_any(const plumb_world *world, const pl_joint_mark *m)
{
    return m->row_a < world->dynamic_count || m->row_b < world->dynamic_count;
}

static bool ties_two(const plumb_world *world, const pl_joint_mark *m)
{
    return m->row_a < world->dynamic_count && m->row_b < world->dynamic_count;
}

// Of these kinds alone loops are made that may ask for what cannot be: a gear leaves its wheels where they are.
static bool holds_in_place(const plumb_world *world, uint32_t joint)
{
    const plumb_joint_kind kind = pl_joint_items(&world->joints)[joint].desc.kind;
    return kind == PLUMB_REVOLUTE || kind == PLUMB_PRISMATIC || kind == PLUMB_DISTANCE ||
           kind == PLUMB_WELD || kind == PLUMB_WHEEL;
}

// An assembly has the number of its lowest row. A joint closes a loop if its bodies hang together without it; what dynamics
// does not move is one body.
void pl_assemblies_make(plumb_world *world)
{
    pl_joint_plan *plan = &world->joints.plan;
    const uint32_t count = world->joints.count, rows = world->dynamic_count;
    pl_joint_mark *marks = plan->marks.data;
    uint32_t *leaders = plan->leaders.data;
    uint8_t *looped = plan->looped.data, *held = plan->states.data;
    plan->assembly_count = rows;
    pl_union_reset(leaders, rows);
    pl_fill(looped, 0, rows);
    pl_fill(held, 0, rows);
    for (uint32_t i = 0; i < count; ++i) {
        const pl_joint_mark *m = &marks[i];
        if (m->what != 0 && ties_two(world, m) && !pl_union_join(leaders, m->row_a, m->row_b)) {
            looped[m->row_a] |= holds_in_place(world, i); // told of a row first
        }
    }
    for (uint32_t i = 0; i < count; ++i) {
        pl_joint_mark *m = &marks[i];
        m->assembly = PL_NONE;
        if (m->what == 0 || !ties_any(world, m)) {
            continue;
        }
        m->assembly = pl_union_leader(leaders, m->row_a < rows ? m->row_a : m->row_b);
        const bool two = ties_two(world, m), is_held = !two && holds_in_place(world, i);
        looped[m->assembly] |=
            (two && looped[m->row_a] != 0) || (is_held && held[m->assembly] != 0);
        held[m->assembly] |= is_held;
    }
}

static uint8_t state_of(const plumb_world *world, const pl_joint_mark *m)
{
    const uint64_t *contacts = world->solver.masks.data;
    const uint32_t *slots = world->solver.slots.data, rows = world->dynamic_count;
    const bool touched = (m->row_a < rows && contacts[slots[m->row_a]] != 0) ||
                         (m->row_b < rows && contacts[slots[m->row_b]] != 0);
    uint8_t state = (touched ? IS_TOUCHED : 0) | (m->direct ? IS_DIRECT : 0);
    if (ties_two(world, m)) {
        const real a = world->bodies.inv_mass[m->row_a], b = world->bodies.inv_mass[m->row_b];
        state |= a > UNEVEN * b || b > UNEVEN * a ? IS_UNEVEN : 0;
    }
    return state;
}

static void kick_whole(plumb_world *world, uint32_t row)
{
    if (row < world->dynamic_count) {
        const uint32_t slot = ((const uint32_t *)world->solver.slots.data)[row];
        ((near_real *)world->solver.kicked.data)[4 * (size_t)slot + 3] = 0;
    }
}

static bool is_whole(uint8_t state, uint8_t looped)
{
    const uint8_t uneven = IS_TOUCHED | IS_UNEVEN;
    return (state & uneven) == uneven || ((state & IS_DIRECT) != 0 && looped != 0);
}

void pl_assemblies_share(plumb_world *world)
{
    pl_joint_plan *plan = &world->joints.plan;
    const uint32_t *order = plan->order.data;
    const pl_joint_mark *marks = plan->marks.data;
    const uint8_t *looped = plan->looped.data;
    uint8_t *states = plan->states.data;
    const bool direct = pl_joints_direct(world);
    plan->any_whole = false;
    if (world->desc.solver != PLUMB_SOLVER_SOFT || world->joints.live == 0 ||
        (!direct && world->narrow.manifold_count == 0)) {
        return;
    }
    pl_fill(states, 0, plan->assembly_count);
    for (uint32_t i = 0; i < plan->order_count; ++i) {
        const pl_joint_mark *m = &marks[order[i]];
        if (m->assembly != PL_NONE) {
            states[m->assembly] |= state_of(world, m);
        }
    }
    for (uint32_t i = 0; i < plan->order_count; ++i) {
        const pl_joint_mark *m = &marks[order[i]];
        if (m->assembly != PL_NONE && is_whole(states[m->assembly], looped[m->assembly])) {
            kick_whole(world, m->row_a);
            kick_whole(world, m->row_b);
            plan->any_whole = true;
        }
    }
}
