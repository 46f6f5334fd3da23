// plan.c - which joints are solved several at a time, and in what order.
//
// Joints get colours so that no body that moves has two of one colour, and within a colour those of
// one pattern fill the lanes of bundles. Kinds with rows of their own form (gear, pulley), and what
// finds no colour, are solved one by one. Both follow from the joints there are, in the order of
// their slots, and from which of their bodies move: never from the width, so that widths give the
// same bits, nor from the past, so that a plan can be kept until one of these changes.
//
// Reads: joints, slots of bodies. Writes: the plan, solver slots of joints. Cost: O(joints); a new
// plan O(n log n).
#include "core/sort.h"
#include "joints/joint.h"
#include "world/state.h"

#include <string.h>

// pl_joint_mark.what: pl_joint_pattern.variant and
#define SOLVED  0x80000000u
#define MOVES_A 0x40000000u
#define MOVES_B 0x20000000u
#define WIDE    0x10000000u // by the soft step
#define VARIANT 0x0fffffffu

#define NO_COLOR 64u

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

//---- what has changed ----------------------------------------------------------------------------

static uint32_t variant_of(const plumb_joint_desc *d)
{
    return (uint32_t)d->kind | (d->enable_limit ? 0x100u : 0) | (d->enable_motor ? 0x200u : 0) |
           (d->hertz > 0 ? 0x400u : 0) | (d->max_force > 0 ? 0x800u : 0);
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

static uint32_t slot_of(const plumb_world *world, uint32_t row)
{
    uint32_t movable = world->dynamic_count + world->kinematic_count;
    return pl_solver_slot(&world->solver, row < movable ? row : movable, movable);
}

static pl_joint_mark mark_of(const plumb_world *world, const pl_joint *j, const pl_joint_mark *old)
{
    if (plumb_is_null(j->entity)) {
        return (pl_joint_mark){ .what = 0 };
    }
    pl_joint_mark mark = { .a = j->a.body, .b = j->b.body };
    mark.row_a = row_of(world, mark.a, old->row_a);
    mark.row_b = row_of(world, mark.b, old->row_b);
    mark.what = SOLVED | variant_of(&j->desc) |
                (world->desc.solver == PLUMB_SOLVER_SOFT ? WIDE : 0) |
                (mark.row_a < world->dynamic_count ? MOVES_A : 0) |
                (mark.row_b < world->dynamic_count ? MOVES_B : 0);
    return mark;
}

// Brings marks and solver slots up to date. True: the plan no longer holds.
static bool revise_marks(plumb_world *world)
{
    pl_joints *joints = &world->joints;
    pl_joint_mark *marks = joints->plan.marks.data;
    bool changed = joints->count != joints->plan.marked;
    for (uint32_t i = joints->plan.marked; i < joints->count; ++i) {
        marks[i] = (pl_joint_mark){ .what = 0 };
    }
    for (uint32_t i = 0; i < joints->count; ++i) {
        pl_joint *j = &pl_joint_items(joints)[i];
        pl_joint_mark now = mark_of(world, j, &marks[i]);
        changed |= now.what != marks[i].what || !plumb_same(now.a, marks[i].a) ||
                   !plumb_same(now.b, marks[i].b);
        marks[i] = now;
        if (now.what != 0) {
            j->a.slot = slot_of(world, now.row_a);
            j->b.slot = slot_of(world, now.row_b);
        }
    }
    joints->plan.marked = joints->count;
    return changed;
}

//---- patterns ------------------------------------------------------------------------------------

// False for rows that only their kind knows how to make.
static bool describe(const plumb_world *world, pl_joint *j, pl_joint_pattern *out)
{
    pl_rows *rows = &j->rows;
    pl_joint_begin(world, j);
    pl_joint_classes[j->desc.kind]->rows(j, &j->a.pose, &j->b.pose, rows);
    *out = (pl_joint_pattern){ .variant = variant_of(&j->desc),
                               .rows_of_all = (uint32_t)rows->count,
                               .block = (uint8_t)rows->block };
    bool known = true;
    for (int i = 0; i < rows->count; ++i) {
        const pl_row *r = &rows->row[i];
        if (r->type != PL_ROW_OFF) {
            known &= r->form != PL_FORM_OWN;
            out->row[out->count++] = (pl_pattern_row){ .index = (uint8_t)i,
                                                       .form = (uint8_t)r->form,
                                                       .type = (uint8_t)r->type,
                                                       .spring = r->hertz > 0 };
        }
    }
    out->tempered = out->block > 0 && (out->row[0].spring || out->row[0].type == PL_ROW_DRIVE ||
                                       rows->block_most < PL_UNBOUNDED);
    return known && out->count > 0;
}

// PL_NONE: to be solved one by one.
static uint32_t pattern_of(plumb_world *world, pl_joint *j)
{
    pl_joint_plan *plan = &world->joints.plan;
    uint32_t variant = variant_of(&j->desc);
    for (uint32_t i = 0; i < plan->pattern_count; ++i) {
        if (plan->patterns[i].variant == variant) {
            return i;
        }
    }
    pl_joint_pattern pattern;
    if (plan->pattern_count == PL_JOINT_PATTERNS || !describe(world, j, &pattern)) {
        return PL_NONE;
    }
    plan->patterns[plan->pattern_count] = pattern;
    return plan->pattern_count++;
}

//---- order ---------------------------------------------------------------------------------------

// The first colour that neither body has.
static uint32_t color_of(plumb_world *world, const pl_joint *j, uint32_t what)
{
    uint64_t *masks = world->solver.masks.data;
    uint64_t taken = ((what & MOVES_A) != 0 ? masks[j->a.slot] : 0) |
                     ((what & MOVES_B) != 0 ? masks[j->b.slot] : 0);
    if (taken == UINT64_MAX) {
        return NO_COLOR;
    }
    uint32_t color = (uint32_t)__builtin_ctzll(~taken);
    uint64_t bit = UINT64_C(1) << color;
    if ((what & MOVES_A) != 0) {
        masks[j->a.slot] |= bit;
    }
    if ((what & MOVES_B) != 0) {
        masks[j->b.slot] |= bit;
    }
    return color;
}

// Colours of all joints; those that are solved one by one into their list. Returns how many are not.
static uint32_t sort_out(plumb_world *world)
{
    pl_joints *joints = &world->joints;
    pl_joint_plan *plan = &joints->plan;
    pl_keyed *order = plan->order.data;
    uint32_t *alone = plan->alone.data, count = 0;
    plan->alone_count = plan->pattern_count = 0;
    memset(world->solver.masks.data, 0, world->solver.slot_count * sizeof(uint64_t));
    for (uint32_t i = 0; i < joints->count; ++i) {
        uint32_t what = pl_joint_marks(joints)[i].what;
        pl_joint *j = &pl_joint_items(joints)[i];
        if (what == 0) {
            continue;
        }
        uint32_t pattern = (what & WIDE) != 0 ? pattern_of(world, j) : PL_NONE;
        uint32_t color = pattern != PL_NONE ? color_of(world, j, what) : NO_COLOR;
        if (pattern == PL_NONE || color == NO_COLOR) {
            alone[plan->alone_count++] = i;
        } else {
            order[count++] = (pl_keyed){ .key = pl_key(color, pattern), .order = i, .value = i };
        }
    }
    pl_sort_keyed(order, count);
    return count;
}

// Every lane may end up alone in its bundle.
static bool reserve_lanes(plumb_world *world, uint32_t count)
{
    pl_joint_plan *plan = &world->joints.plan;
    const pl_keyed *order = plan->order.data;
    size_t width = (size_t)pl_joint_kernels_of(world)->width, bundles = 0, filled = 0;
    for (uint32_t i = 0; i < count; ++i) {
        bool opens = i == 0 || order[i].key != order[i - 1].key || filled == width;
        bundles += opens;
        filled = opens ? 1 : filled + 1;
    }
    return pl_buffer_reserve(&world->memory, &plan->bundles, bundles * sizeof(pl_joint_bundle)) &&
           pl_buffer_reserve(&world->memory, &plan->lanes, bundles * width * sizeof(uint32_t));
}

// Fills lanes; returns the bytes of all records.
static size_t place_lanes(plumb_world *world, uint32_t count)
{
    pl_joint_plan *plan = &world->joints.plan;
    const pl_joint_kernels *kernels = pl_joint_kernels_of(world);
    const pl_keyed *order = plan->order.data;
    pl_joint_bundle *bundles = plan->bundles.data;
    uint32_t *lanes = plan->lanes.data, width = (uint32_t)kernels->width, filled = 0;
    size_t bytes = 0;
    plan->bundle_count = 0;
    for (uint32_t i = 0; i < count; ++i) {
        if (i == 0 || order[i].key != order[i - 1].key || filled == width) {
            uint32_t pattern = (uint32_t)order[i].key;
            memset(&lanes[(size_t)plan->bundle_count * width], 0xff, width * sizeof *lanes);
            bundles[plan->bundle_count++] = (pl_joint_bundle){ .at = bytes, .pattern = pattern };
            bytes += kernels->record_size(&plan->patterns[pattern]);
            filled = 0;
        }
        lanes[(size_t)(plan->bundle_count - 1) * width + filled++] = order[i].value;
    }
    return bytes;
}

bool pl_joints_plan(plumb_world *world)
{
    pl_joint_plan *plan = &world->joints.plan;
    size_t count = world->joints.count;
    if (!pl_buffer_reserve(&world->memory, &plan->marks, count * sizeof(pl_joint_mark))) {
        return false;
    }
    if (!revise_marks(world) && plan->made) {
        return true;
    }
    plan->made = false;
    if (!pl_buffer_reserve(&world->memory, &plan->order, count * sizeof(pl_keyed)) ||
        !pl_buffer_reserve(&world->memory, &plan->alone, count * sizeof(uint32_t))) {
        return false;
    }
    uint32_t wide = sort_out(world);
    if (!reserve_lanes(world, wide) ||
        !pl_buffer_reserve(&world->memory, &plan->records, place_lanes(world, wide))) {
        return false;
    }
    plan->made = true;
    return true;
}

void pl_joints_plan_free(pl_memory *memory, pl_joint_plan *plan)
{
    pl_buffer *buffers[] = { &plan->marks, &plan->order,   &plan->bundles,
                             &plan->lanes, &plan->records, &plan->alone };
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; ++i) {
        pl_buffer_free(memory, buffers[i]);
    }
}
