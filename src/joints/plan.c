// plan.c - which joints are solved several at a time, and in what order.
//
// Joints get colours so that no body that moves has two of one colour, and within a colour those of
// one pattern fill the lanes of bundles (group.c). Kinds with rows of their own form (gear, pulley, cable), and
// what finds no colour, are solved one by one. Both follow from the joints there are, in the order of
// their slots, and from which of their bodies move: never from the width, so that widths give the
// same bits, nor from the past, so that a plan can be kept until one of these changes. The colours of
// an island's joints do not depend on other islands: nor does anything on which are solved together.
//
// Reads: joints, slots of bodies. Writes: marks, ends, order. Cost: O(joints).
#include "world/joint_list.h"
#include "core/bits.h"
#include "core/sort.h"
#include "joints/joint.h"
#include "world/state.h"

#include <string.h>

// pl_joint_mark.what
#define SOLVED  1u
#define MOVES_A 2u
#define MOVES_B 4u
#define WIDE    8u // by the soft step

#define IN_NEWTONS                                                                                 \
    0x2000u // bit of a variant: its springs are, as told or as their mass changes (pl_joint_spring_mass)

const pl_joint_kernels *pl_joint_kernels_of(const plumb_world *world)
{
    switch (world->desc.simd_width) {
    case 16:
        return &pl_joint_kernels_w16;
    case 8:
        return &pl_joint_kernels_w8;
    default:
        return &pl_joint_kernels_w4;
    }
}

//---- who takes part ------------------------------------------------------------------------------

static bool is_enabled(const plumb_world *world, plumb_body body)
{
    return plumb_is_null(body) ||
           (world->bodies.flags[pl_body_row(world, body)] & PL_BODY_DISABLED) == 0;
}

static bool is_active(const plumb_world *world, const pl_joint *j)
{
    return !j->desc.disabled && (world->disabled_count == 0 ||
                                 (is_enabled(world, j->a.body) && is_enabled(world, j->b.body)));
}

// Rows without what lies along locked axes, impulses to be added up and limits that bounce are made one by one.
static bool is_plain(const plumb_world *world, const pl_joint *j, const pl_joint_mark *mark)
{
    return !(j->desc.break_impulse > 0) && !pl_joint_bounces(&j->desc) &&
           (world->locked_bodies == 0 ||
            (pl_joint_locks(world, mark->row_a) | pl_joint_locks(world, mark->row_b)) == 0);
}

//---- what has changed ----------------------------------------------------------------------------

uint32_t pl_joint_variant(const plumb_joint_desc *d)
{
    return (uint32_t)d->kind | (d->enable_limit ? 0x100u : 0) | (d->enable_motor ? 0x200u : 0) |
           (pl_joint_has_spring(d) ? 0x400u : 0) | (d->max_force > 0 ? 0x800u : 0) |
           (pl_joint_is_watched(d) ? PL_JOINT_WATCHED : 0) |
           (pl_spring_is_in_newtons(d) ? IN_NEWTONS : 0);
}

static uint32_t row_of(const plumb_world *world, plumb_body body, uint32_t before)
{
    if (plumb_is_null(body)) {
        return PL_NONE;
    }
    bool same =
        before < world->bodies.table.count && plumb_same(world->bodies.entity[before], body);
    return same ? before : pl_body_row(world, body);
}

// Rows of a joint's bodies, into the mark and the ends, and which of them move.
static uint8_t look(const plumb_world *world, pl_joint_mark *mark, pl_ends *ends)
{
    const uint32_t a = row_of(world, mark->a, mark->row_a);
    const uint32_t b = row_of(world, mark->b, mark->row_b);
    mark->row_a = ends->a = a;
    mark->row_b = ends->b = b;
    const plumb_world_desc *d = &world->desc;
    return (uint8_t)(SOLVED | (d->direct_joints || d->solver != PLUMB_SOLVER_SOFT ? 0 : WIDE) |
                     (a < world->dynamic_count ? MOVES_A : 0) |
                     (b < world->dynamic_count ? MOVES_B : 0));
}

// True: all marks are as they were when the plan was made.
static bool still_holds(plumb_world *world)
{
    const pl_joints *joints = &world->joints;
    pl_joint_mark *marks = joints->plan.marks.data;
    pl_ends *ends = joints->plan.ends.data;
    const uint32_t *awake = joints->awake.data;
    bool same = joints->plan.made && !joints->awake_stale;
    for (uint32_t i = 0; same && i < joints->awake_count; ++i) {
        pl_joint_mark *mark = &marks[awake[i]];
        same = mark->what == 0 || mark->what == look(world, mark, &ends[i]);
    }
    return same;
}

static void mark_all(plumb_world *world)
{
    pl_joint_mark *marks = world->joints.plan.marks.data;
    pl_ends *ends = world->joints.plan.ends.data;
    const uint32_t *awake = world->joints.awake.data;
    memset(marks, 0, world->joints.count * sizeof *marks);
    world->joints.plan.adrift = pl_joints_awake(world) == world->joints.live;
    for (uint32_t i = 0; i < pl_joints_awake(world); ++i) {
        const pl_joint *j = &pl_joint_items(&world->joints)[awake[i]];
        pl_joint_mark *mark = &marks[awake[i]];
        *mark =
            (pl_joint_mark){ .a = j->a.body, .b = j->b.body, .row_a = PL_NONE, .row_b = PL_NONE };
        ends[i] = (pl_ends){ PL_NONE, PL_NONE };
        mark->what = is_active(world, j) ? look(world, mark, &ends[i]) : 0;
        world->joints.plan.adrift &= (mark->what & MOVES_A) != 0 && (mark->what & MOVES_B) != 0;
    }
}

//---- patterns ------------------------------------------------------------------------------------

// False for rows that only their kind knows how to make, and blocks that are springs in newtons (one.c).
static bool describe(const plumb_world *world, pl_joint *j, uint32_t variant, pl_joint_pattern *out)
{
    pl_rows *rows = &j->rows;
    pl_joint_begin(world, j);
    pl_joint_classes[j->desc.kind]->rows(j, &j->pose_a, &j->pose_b, rows);
    *out = (pl_joint_pattern){ .variant = variant,
                               .rows_of_all = (uint32_t)rows->count,
                               .block = (uint8_t)rows->block };
    bool known = true;
    for (int i = 0; i < rows->count; ++i) {
        const pl_row *r = &rows->row[i];
        if (r->type != PL_ROW_OFF) {
            known &= r->form != PL_FORM_OWN && !(i < rows->block && r->spring == PL_SPRING_NEWTONS);
            out->newtons |= r->spring == PL_SPRING_NEWTONS;
            out->row[out->count++] = (pl_pattern_row){ .index = (uint8_t)i,
                                                       .form = (uint8_t)r->form,
                                                       .type = (uint8_t)r->type,
                                                       .spring = (uint8_t)r->spring };
        }
    }
    out->tempered = out->block > 0 && (out->row[0].spring || out->row[0].type == PL_ROW_DRIVE ||
                                       rows->block_most < PL_UNBOUNDED);
    out->bare = j->desc.kind == PLUMB_REVOLUTE && out->count == 2 && !out->tempered;
    return known && out->count > 0;
}

// PL_NONE: to be solved one by one.
static uint32_t pattern_of(plumb_world *world, pl_joint *j, const pl_joint_mark *mark)
{
    pl_joint_plan *plan = &world->joints.plan;
    const bool in_newtons = pl_joint_spring_mass(world, j, mark->row_a, mark->row_b) > 0;
    const uint32_t variant = pl_joint_variant(&j->desc) | (in_newtons ? IN_NEWTONS : 0);
    for (uint32_t i = 0; i < plan->pattern_count; ++i) {
        if (plan->patterns[i].variant == variant) {
            return i;
        }
    }
    pl_joint_pattern pattern;
    if (plan->pattern_count == PL_JOINT_PATTERNS || !describe(world, j, variant, &pattern)) {
        return PL_NONE;
    }
    plan->patterns[plan->pattern_count] = pattern;
    return plan->pattern_count++;
}

//---- order ---------------------------------------------------------------------------------------

// The first colour that neither body has.
static uint32_t color_of(plumb_world *world, const pl_joint_mark *mark)
{
    const uint32_t movable = world->dynamic_count + world->kinematic_count, what = mark->what;
    uint64_t *masks = world->solver.masks.data;
    uint64_t *a = &masks[pl_solver_slot(&world->solver, mark->row_a, movable)];
    uint64_t *b = &masks[pl_solver_slot(&world->solver, mark->row_b, movable)];
    uint64_t taken = ((what & MOVES_A) != 0 ? *a : 0) | ((what & MOVES_B) != 0 ? *b : 0);
    if (taken == UINT64_MAX) {
        return PL_JOINT_COLORS;
    }
    uint32_t color = (uint32_t)__builtin_ctzll(~taken);
    uint64_t bit = UINT64_C(1) << color;
    if ((what & MOVES_A) != 0) {
        *a |= bit;
    }
    if ((what & MOVES_B) != 0) {
        *b |= bit;
    }
    return color;
}

// A joint that is quiet can stay out of the cache after the step.
static bool is_quiet(const pl_joint *j, const pl_joint_mark *mark)
{
    return pl_joint_is_wide(mark) && !pl_joint_is_watched(&j->desc) &&
           pl_joint_classes[j->desc.kind]->advance == NULL;
}

// How many joints are at that of its bodies which has more; those without a colour do not count.
static uint8_t degree_of(const plumb_world *world, const pl_joint_mark *mark)
{
    const uint32_t movable = world->dynamic_count + world->kinematic_count, what = mark->what;
    const uint64_t *masks = world->solver.masks.data;
    const uint64_t a = masks[pl_solver_slot(&world->solver, mark->row_a, movable)];
    const uint64_t b = masks[pl_solver_slot(&world->solver, mark->row_b, movable)];
    const int of_a = (what & MOVES_A) != 0 ? (int)pl_count_bits(a) : 1;
    const int of_b = (what & MOVES_B) != 0 ? (int)pl_count_bits(b) : 1;
    return (uint8_t)(of_a > of_b ? of_a : of_b > 1 ? of_b : 1);
}

// Colours and patterns of all joints that are solved.
static void sort_out(plumb_world *world)
{
    pl_joints *joints = &world->joints;
    pl_joint_plan *plan = &joints->plan;
    pl_joint_mark *marks = plan->marks.data;
    plan->pattern_count = 0;
    pl_assemblies_make(world);
    pl_joints_find_hubs(world);
    memset(world->solver.masks.data, 0, world->solver.slot_count * sizeof(uint64_t));
    for (uint32_t i = 0; i < joints->count; ++i) {
        pl_joint_mark *mark = &marks[i];
        if (mark->what == 0) {
            continue;
        }
        pl_joint *j = &pl_joint_items(joints)[i];
        bool wide = (mark->what & WIDE) != 0 && !mark->direct && is_plain(world, j, mark);
        uint32_t pattern = wide ? pattern_of(world, j, mark) : PL_NONE;
        mark->color = (uint8_t)(pattern != PL_NONE ? color_of(world, mark) : PL_JOINT_COLORS);
        mark->pattern = (uint8_t)(pl_joint_is_wide(mark) ? pattern : 0);
        mark->quiet = is_quiet(j, mark);
    }
    for (uint32_t i = 0; i < joints->count; ++i) {
        marks[i].degree = marks[i].what != 0 ? degree_of(world, &marks[i]) : 1;
    }
}

static inline uint32_t bin_of(const pl_joint_mark *mark)
{
    return (uint32_t)mark->color * PL_JOINT_PATTERNS + mark->pattern;
}

// Joints that are solved, by colour, pattern and slot. Those that are solved one by one come last.
static void put_in_order(pl_joints *joints)
{
    uint32_t ends[(PL_JOINT_COLORS + 1) * PL_JOINT_PATTERNS] = { 0 }; // of bins
    const uint32_t bins = sizeof ends / sizeof *ends;
    const pl_joint_mark *marks = pl_joint_marks(joints);
    uint32_t *order = joints->plan.order.data;
    for (uint32_t i = 0; i < joints->count; ++i) {
        ends[bin_of(&marks[i])] += marks[i].what != 0;
    }
    joints->plan.order_count = pl_counts_to_places(ends, bins, 0);
    for (uint32_t i = 0; i < joints->count; ++i) {
        if (marks[i].what != 0) {
            order[ends[bin_of(&marks[i])]++] = i;
        }
    }
}

bool pl_joints_look(plumb_world *world)
{
    pl_joint_plan *plan = &world->joints.plan;
    const size_t count = world->joints.count;
    plan->changed = false;
    if (world->joints.live == 0 || still_holds(world)) {
        return true;
    }
    plan->made = false;
    if (!pl_buffer_reserve(&world->memory, &plan->marks, count * sizeof(pl_joint_mark)) ||
        !pl_buffer_reserve(&world->memory, &plan->ends, count * sizeof(pl_ends)) ||
        !pl_buffer_reserve(&world->memory, &plan->order, count * sizeof(uint32_t)) ||
        !pl_assemblies_reserve(world)) {
        return false;
    }
    mark_all(world);
    plan->changed = true;
    return true;
}

bool pl_joints_plan(plumb_world *world)
{
    pl_joint_plan *plan = &world->joints.plan;
    if (world->joints.live == 0) {
        return true;
    }
    if (!plan->made) {
        sort_out(world);
        put_in_order(&world->joints);
        plan->group_count = 0;
    }
    plan->made = pl_joints_group(world);
    return plan->made;
}

uint32_t pl_joints_tied(const plumb_world *world)
{
    return world->joints.live > 0 ? world->joints.awake_count : 0;
}

bool pl_joints_changed(const plumb_world *world)
{
    return world->joints.plan.changed;
}

void pl_joints_plan_free(pl_memory *memory, pl_joint_plan *plan)
{
    pl_buffer *buffers[] = { &plan->marks,         &plan->ends,           &plan->order,
                             &plan->groups,        &plan->grouped,        &plan->bundles,
                             &plan->lanes,         &plan->slots,          &plan->records,
                             &plan->leaders,       &plan->looped,         &plan->states,
                             &plan->hubs,          &plan->direct.columns, &plan->direct.entries,
                             &plan->direct.swept,  &plan->direct.parts,   &plan->direct.blocks,
                             &plan->direct.scratch };
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; ++i) {
        pl_buffer_free(memory, buffers[i]);
    }
}
