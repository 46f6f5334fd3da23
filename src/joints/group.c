// group.c - the joints of each cluster of bodies: by colour and pattern in the lanes of bundles, then those
// that are solved one by one.
//
// A joint is in the cluster that has its bodies (solver/cluster.c). Where clusters begin and end changes no
// bit: of the joints of an island, some of one colour have no body in common that moves, and the others
// follow one another as the plan says.
//
// Reads: order, marks, labels of rows. Writes: groups, bundles, lanes. Cost: one read a joint and one of a
// label; O(joints) where one of them is in another cluster than in the step before.
#include "joints/joint.h"
#include "world/state.h"

#include <string.h>

#define LINE 64 // [B] of a cache; records of widest lanes are aligned to it

// Clusters of all joints that are solved. True: they are as they were.
static bool find_clusters(plumb_world *world)
{
    pl_joint_plan *plan = &world->joints.plan;
    pl_joint_mark *marks = plan->marks.data;
    const uint32_t *awake = world->joints.awake.data, *labels = pl_solver_labels(&world->solver);
    const uint32_t movable = world->dynamic_count + world->kinematic_count;
    bool same = plan->group_count == world->solver.cluster_count &&
                plan->exact_group == world->solver.hard_cluster;
    if (same && labels == NULL) {
        return true;
    }
    for (uint32_t i = 0; i < world->joints.awake_count; ++i) {
        pl_joint_mark *mark = &marks[awake[i]];
        const uint32_t row = mark->row_a < movable ? mark->row_a : mark->row_b;
        const uint32_t cluster = labels != NULL && row < movable ? labels[row] : 0;
        same &= mark->cluster == cluster || mark->what == 0;
        mark->cluster = cluster;
    }
    return same;
}

// Joints in the order of the plan, group by group.
static void sort_by_cluster(plumb_world *world)
{
    pl_joint_plan *plan = &world->joints.plan;
    pl_joint_group *groups = plan->groups.data;
    const pl_joint_mark *marks = plan->marks.data;
    const uint32_t *order = plan->order.data;
    uint32_t *grouped = plan->grouped.data, at = 0;
    memset(groups, 0, plan->group_count * sizeof *groups);
    for (uint32_t i = 0; i < plan->order_count; ++i) {
        ++groups[marks[order[i]].cluster].end;
    }
    for (uint32_t g = 0; g < plan->group_count; ++g) {
        const uint32_t count = groups[g].end;
        groups[g].first = groups[g].end = groups[g].alone = at;
        at += count;
    }
    for (uint32_t i = 0; i < plan->order_count; ++i) {
        const pl_joint_mark *mark = &marks[order[i]];
        pl_joint_group *group = &groups[mark->cluster];
        grouped[group->end++] = order[i];
        group->alone += pl_joint_is_wide(mark) && mark->cluster != plan->exact_group;
    }
}

// Whether a joint of a group, `filled` of whose lanes are taken in the last bundle, needs another.
static inline bool opens(const pl_joint_mark *mark, const pl_joint_mark *before, uint32_t filled,
                         uint32_t width)
{
    return before == NULL || filled == width || mark->color != before->color ||
           mark->pattern != before->pattern;
}

// Where the bundles of each colour of a group begin. Returns the bytes of their records.
static size_t divide(plumb_world *world, pl_joint_group *group)
{
    pl_joint_plan *plan = &world->joints.plan;
    const pl_joint_kernels *kernels = pl_joint_kernels_of(world);
    const uint32_t *grouped = plan->grouped.data;
    const pl_joint_mark *before = NULL;
    uint32_t filled = 0, colors = 0; // whose first bundle is known
    size_t bytes = 0;
    for (uint32_t i = group->first; i < group->alone; ++i) {
        const pl_joint_mark *mark = &pl_joint_marks(&world->joints)[grouped[i]];
        while (colors <= mark->color) {
            group->color_first[colors++] = plan->bundle_count;
        }
        if (opens(mark, before, filled, (uint32_t)kernels->width)) {
            bytes += kernels->record_size(&plan->patterns[mark->pattern]);
            ++plan->bundle_count;
            filled = 0;
        }
        ++filled;
        before = mark;
    }
    while (colors <= PL_JOINT_COLORS) {
        group->color_first[colors++] = plan->bundle_count;
    }
    return bytes;
}

static void divide_all(plumb_world *world)
{
    pl_joint_plan *plan = &world->joints.plan;
    plan->room = plan->bundle_count = 0;
    for (uint32_t g = 0; g < plan->group_count; ++g) {
        const size_t bytes = divide(world, &pl_joint_groups(&world->joints)[g]);
        const size_t room = (bytes + LINE - 1) / LINE * LINE;
        plan->room = room > plan->room ? room : plan->room;
    }
}

static pl_joint_lane lane_of(const plumb_world *world, uint32_t slot, bool bare)
{
    if (!bare) {
        return (pl_joint_lane){ .joint = slot };
    }
    const pl_joint *j = &pl_joint_items(&world->joints)[slot];
    return (pl_joint_lane){ .joint = slot,
                            .eighth_a = (uint8_t)j->a.eighth,
                            .eighth_b = (uint8_t)j->b.eighth,
                            .local_a = j->a.local,
                            .local_b = j->b.local };
}

static void place_lanes(plumb_world *world, const pl_joint_group *group)
{
    pl_joint_plan *plan = &world->joints.plan;
    const pl_joint_kernels *kernels = pl_joint_kernels_of(world);
    const uint32_t *grouped = plan->grouped.data, width = (uint32_t)kernels->width;
    const pl_joint_mark *before = NULL;
    pl_joint_bundle *bundles = plan->bundles.data;
    pl_joint_lane *lanes = plan->lanes.data;
    uint32_t end = group->color_first[0], filled = 0; // bundle behind the last
    size_t bytes = 0;
    for (uint32_t i = group->first; i < group->alone; ++i) {
        const pl_joint_mark *mark = &pl_joint_marks(&world->joints)[grouped[i]];
        const pl_joint_pattern *pattern = &plan->patterns[mark->pattern];
        if (opens(mark, before, filled, width)) {
            memset(&lanes[(size_t)end * width], 0xff, width * sizeof *lanes);
            bundles[end++] = (pl_joint_bundle){ .at = bytes, .pattern = mark->pattern };
            bytes += kernels->record_size(pattern);
            filled = 0;
        }
        lanes[(size_t)(end - 1) * width + filled++] = lane_of(world, grouped[i], pattern->bare);
        before = mark;
    }
}

static bool reserve_groups(plumb_world *world)
{
    pl_joint_plan *plan = &world->joints.plan;
    return pl_buffer_reserve(&world->memory, &plan->groups,
                             plan->group_count * sizeof(pl_joint_group)) &&
           pl_buffer_reserve(&world->memory, &plan->grouped, plan->order_count * sizeof(uint32_t));
}

static bool reserve_lanes(plumb_world *world)
{
    pl_joint_plan *plan = &world->joints.plan;
    const size_t bundles = plan->bundle_count;
    const size_t lanes = bundles * (size_t)pl_joint_kernels_of(world)->width;
    return pl_buffer_reserve(&world->memory, &plan->bundles, bundles * sizeof(pl_joint_bundle)) &&
           pl_buffer_reserve(&world->memory, &plan->lanes, lanes * sizeof(pl_joint_lane)) &&
           pl_buffer_reserve(&world->memory, &plan->slots, lanes * 2 * sizeof(uint32_t));
}

// Of as many threads as there are in this step.
static bool reserve_records(plumb_world *world)
{
    pl_joint_plan *plan = &world->joints.plan;
    const uint32_t threads = pl_tasks_share_count(world->tasks, plan->group_count, 1);
    return pl_buffer_reserve(&world->memory, &plan->records, plan->room * threads);
}

static bool regroup(plumb_world *world)
{
    pl_joint_plan *plan = &world->joints.plan;
    plan->group_count = world->solver.cluster_count;
    plan->exact_group = world->solver.hard_cluster;
    if (!reserve_groups(world)) {
        return false;
    }
    sort_by_cluster(world);
    divide_all(world);
    if (!reserve_lanes(world) || !reserve_records(world)) {
        return false;
    }
    for (uint32_t g = 0; g < plan->group_count; ++g) {
        place_lanes(world, &pl_joint_groups(&world->joints)[g]);
    }
    return !pl_joints_direct(world) || pl_direct_plan(world);
}

bool pl_joints_group(plumb_world *world)
{
    if (find_clusters(world)) {
        return reserve_records(world);
    }
    const bool done = regroup(world);
    if (!done) { // the step is taken again: they are not as they were
        world->joints.plan.group_count = 0;
    }
    return done;
}
