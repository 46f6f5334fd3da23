// direct_plan.c - in which order the joints of a group are eliminated, where they are solved together, and what
// that fills in.
//
// Two joints are neighbours that have a body in common that moves. Eliminating a joint makes neighbours of all that were
// its neighbours. The order is that of a breadth-first search from a far end, reversed (Cuthill and McKee 1969): chains
// and trees fill in nothing, nets a band. The columns of the factor follow without computing it: the bodies of the
// joint that goes become one, and its column is what hangs on that one (George and Liu 1981, chapter 5).
//
// Joints that hang together are a system, whose columns follow one another; the last one has no entries. A system knows nothing
// of what else is in its group: so where clusters begin and end changes no bit.
//
// Reads: groups, marks. Writes: plan.direct. Cost: O(joints + entries), when joints or clusters change.
#include "joints/direct.h"
#include "core/union_find.h"
#include "world/state.h"

#include <string.h>

#define MOST_ENTRIES 200000u // of a system: 58 MB; a larger one is swept

bool pl_joints_direct(const plumb_world *world)
{
    return world->joints.plan.any_direct;
}

// Scratch of a group: joints are told by their place in it.
typedef struct search {
    plumb_world *world;
    const pl_joint_group *group;
    uint32_t count;  // joints
    uint32_t *queue; // joints in the order of the search
    uint32_t *seen;  // a joint: number of the search that has seen it
    uint32_t *place; // a joint: in the order of elimination
    uint32_t *next;  // two a joint: the next joint end of the body
    uint32_t *head;  // a dynamic row: its first joint end, 2 * joint + (0: A, 1: B)
    uint32_t *same;  // a dynamic row: the row that it became one with, itself if none
    uint32_t *first,
        *hung; // of such a row: its joints in `entries`, how many; PL_NONE: those of `head`
} search;

static const pl_joint_mark *mark_of(const search *s, uint32_t joint)
{
    const uint32_t *grouped = s->world->joints.plan.grouped.data;
    return &pl_joint_marks(&s->world->joints)[grouped[s->group->alone + joint]];
}

// Row of a body that moves, PL_NONE of another.
static uint32_t row_of(const search *s, uint32_t joint, int end)
{
    const pl_joint_mark *mark = mark_of(s, joint);
    const uint32_t row = end == 0 ? mark->row_a : mark->row_b;
    return row < s->world->dynamic_count ? row : PL_NONE;
}

static bool is_swept(const search *s, uint32_t joint)
{
    return ((const bool *)s->world->joints.plan.direct.swept.data)[s->group->alone + joint];
}

// Whether a joint's block is rigid and unbounded.
static bool can_be_direct(const plumb_world *world, pl_joint *j)
{
    pl_joint_begin(world, j);
    pl_joint_classes[j->desc.kind]->rows(j, &j->pose_a, &j->pose_b, &j->rows);
    const pl_row *r = &j->rows.row[0];
    return j->rows.block == 0 || (r->type == PL_ROW_EQUAL && r->spring == PL_SPRING_NONE &&
                                  !(j->rows.block_most < PL_UNBOUNDED));
}

static void hang(search *s, uint32_t joint)
{
    for (int end = 0; end < 2; ++end) {
        const uint32_t row = row_of(s, joint, end);
        if (row != PL_NONE) {
            s->next[2 * joint + (uint32_t)end] = s->head[row];
            s->head[row] = 2 * joint + (uint32_t)end;
        }
    }
}

// Breadth first from a joint: appends to the queue. Returns where it ends.
static uint32_t walk(search *s, uint32_t from, uint32_t at, uint32_t number)
{
    uint32_t end = at;
    s->queue[end++] = from;
    s->seen[from] = number;
    for (; at < end; ++at) {
        for (int side = 0; side < 2; ++side) {
            const uint32_t row = row_of(s, s->queue[at], side);
            for (uint32_t e = row == PL_NONE ? PL_NONE : s->head[row]; e != PL_NONE;
                 e = s->next[e]) {
                if (s->seen[e / 2] != number) {
                    s->seen[e / 2] = number;
                    s->queue[end++] = e / 2;
                }
            }
        }
    }
    return end;
}

// Fills the queue with all joints that are not swept; returns how many they are.
static uint32_t search_all(search *s)
{
    uint32_t end = 0;
    for (uint32_t i = 0; i < s->count; ++i) {
        if (s->seen[i] == 0 && !is_swept(s, i)) {
            const uint32_t far = s->queue[walk(s, i, end, 1) - 1];
            end = walk(s, far, end, 2);
        }
    }
    return end;
}

static bool add_entry(search *s, uint32_t joint, uint32_t at, uint32_t number)
{
    pl_direct *direct = &s->world->joints.plan.direct;
    if (s->place[joint] <= at || s->seen[joint] == number) {
        return true;
    }
    s->seen[joint] = number;
    if (!pl_buffer_reserve(&s->world->memory, &direct->entries,
                           (direct->entry_count + 1) * sizeof(uint32_t))) {
        return false;
    }
    ((uint32_t *)direct->entries.data)[direct->entry_count++] = joint;
    return true;
}

// What hangs on a body of the joint that goes, into its column.
static bool add_hanging(search *s, uint32_t root, uint32_t at, uint32_t number)
{
    const uint32_t first = s->first[root];
    bool ok = true;
    if (first == PL_NONE) {
        for (uint32_t e = s->head[root]; ok && e != PL_NONE; e = s->next[e]) {
            ok = add_entry(s, e / 2, at, number);
        }
    }
    for (uint32_t k = 0; ok && first != PL_NONE && k < s->hung[root]; ++k) {
        const uint32_t *entries = s->world->joints.plan.direct.entries.data;
        ok = add_entry(s, entries[first + k], at, number);
    }
    return ok;
}

// Column of the joint at place `at`; its bodies become one. False when out of memory.
static bool eliminate(search *s, uint32_t at, pl_direct_column *column)
{
    pl_direct *direct = &s->world->joints.plan.direct;
    const uint32_t joint = s->queue[s->count - 1 - at], number = 3 + at;
    const uint32_t first = direct->entry_count;
    uint32_t into = PL_NONE;
    for (int end = 0; end < 2; ++end) {
        const uint32_t row = row_of(s, joint, end);
        if (row == PL_NONE) {
            continue;
        }
        const uint32_t root = pl_union_leader(s->same, row);
        if (!add_hanging(s, root, at, number)) {
            return false;
        }
        into = into == PL_NONE ? root : into;
        s->same[root] = into;
    }
    if (into != PL_NONE) {
        s->first[into] = first;
        s->hung[into] = direct->entry_count - first;
    }
    *column = (pl_direct_column){ s->group->alone + joint, first, direct->entry_count - first };
    return true;
}

// Joints of the group's entries to columns.
static void number_entries(search *s, uint32_t first_entry, uint32_t first_column)
{
    pl_direct *direct = &s->world->joints.plan.direct;
    uint32_t *entries = direct->entries.data;
    for (uint32_t k = first_entry; k < direct->entry_count; ++k) {
        entries[k] = first_column + s->place[entries[k]];
    }
}

// Whom the group solves together.
static void choose(plumb_world *world, const pl_joint_group *group)
{
    const uint32_t *grouped = world->joints.plan.grouped.data;
    bool *swept = world->joints.plan.direct.swept.data;
    for (uint32_t i = group->alone; i < group->end; ++i) {
        swept[i] = !pl_joint_marks(&world->joints)[grouped[i]].direct ||
                   !can_be_direct(world, pl_joint_grouped(&world->joints, i));
    }
}

// Gives up what hangs together with a joint. The queue is lost.
static void sweep_system(search *s, uint32_t joint)
{
    bool *swept = (bool *)s->world->joints.plan.direct.swept.data + s->group->alone;
    const uint32_t count = walk(s, joint, 0, PL_NONE);
    for (uint32_t k = 0; k < count; ++k) {
        swept[s->queue[k]] = true;
    }
    if (s->world->desc.direct_joints) {
        pl_warn(s->world, "%u joints make too dense a net to be solved directly: they are swept",
                count);
    }
}

typedef enum outcome { PLANNED, TOO_DENSE, NO_MEMORY } outcome;

static outcome eliminate_all(search *s, pl_direct_column *columns)
{
    const pl_direct *direct = &s->world->joints.plan.direct;
    uint32_t first_entry = direct->entry_count; // of the system
    for (uint32_t at = 0; at < s->count; ++at) {
        if (!eliminate(s, at, &columns[at])) {
            return NO_MEMORY;
        }
        if (direct->entry_count - first_entry > MOST_ENTRIES) {
            sweep_system(s, s->queue[s->count - 1 - at]);
            return TOO_DENSE;
        }
        first_entry = columns[at].count == 0 ? direct->entry_count : first_entry;
    }
    return PLANNED;
}

static outcome plan_group(search *s, pl_joint_group *group)
{
    pl_direct *direct = &s->world->joints.plan.direct;
    const uint32_t first_entry = direct->entry_count;
    for (uint32_t i = 0; i < s->count; ++i) {
        if (!is_swept(s, i)) {
            hang(s, i);
        }
    }
    s->count = search_all(s);
    for (uint32_t at = 0; at < s->count; ++at) {
        s->place[s->queue[s->count - 1 - at]] = at;
    }
    const outcome result =
        eliminate_all(s, (pl_direct_column *)direct->columns.data + direct->column_count);
    if (result != PLANNED) {
        direct->entry_count = first_entry;
        return result;
    }
    number_entries(s, first_entry, direct->column_count);
    group->direct_first = direct->column_count;
    group->direct_end = direct->column_count += s->count;
    return PLANNED;
}

// Room for the search of a group of so many joints.
static bool open_search(plumb_world *world, pl_joint_group *group, search *out)
{
    pl_buffer *scratch = &world->joints.plan.direct.scratch;
    const uint32_t count = group->end - group->alone, rows = world->dynamic_count;
    if (!pl_buffer_reserve(&world->memory, scratch,
                           (5 * (size_t)count + 4 * (size_t)rows) * sizeof(uint32_t))) {
        return false;
    }
    uint32_t *at = scratch->data;
    *out = (search){ .world = world, .group = group, .count = count };
    out->queue = at, out->seen = at + count, out->place = at + 2 * (size_t)count;
    out->next = at + 3 * (size_t)count;
    at += 5 * (size_t)count;
    out->head = at, out->first = at + rows, out->hung = at + 2 * (size_t)rows;
    out->same = at + 3 * (size_t)rows;
    memset(out->seen, 0, count * sizeof(uint32_t));
    memset(out->head, 0xff, 2 * (size_t)rows * sizeof(uint32_t)); // and `first`
    for (uint32_t row = 0; row < rows; ++row) {
        out->same[row] = row;
    }
    return true;
}

bool pl_direct_plan(plumb_world *world)
{
    pl_joint_plan *plan = &world->joints.plan;
    pl_direct *direct = &plan->direct;
    direct->column_count = direct->entry_count = 0;
    if (!pl_buffer_reserve(&world->memory, &direct->columns,
                           plan->order_count * sizeof(pl_direct_column)) ||
        !pl_buffer_reserve(&world->memory, &direct->swept, plan->order_count * sizeof(bool))) {
        return false;
    }
    for (uint32_t g = 0; g < plan->group_count; ++g) {
        pl_joint_group *group = &pl_joint_groups(&world->joints)[g];
        group->direct_first = group->direct_end = direct->column_count;
        if (group->end > group->alone && g != plan->exact_group) {
            choose(world, group);
            outcome result = TOO_DENSE;
            for (search s; result == TOO_DENSE;) {
                result = open_search(world, group, &s) ? plan_group(&s, group) : NO_MEMORY;
            }
            if (result == NO_MEMORY) {
                return false;
            }
        }
    }
    const size_t blocks = (size_t)direct->column_count + direct->entry_count;
    return pl_buffer_reserve(&world->memory, &direct->parts,
                             direct->column_count * sizeof(pl_direct_part)) &&
           pl_buffer_reserve(&world->memory, &direct->blocks,
                             blocks * PL_DIRECT_BLOCK * sizeof(double));
}
