// finish.c - after the step: reactions of joints, pawls that fall behind a tooth, joints that
// break.
//
// The reaction is the sum of J^T impulse on B over the last substep; its torque about B's anchor is
// what the arm does not explain. Reads: impulses, bodies. Writes: reactions, break events; removes
// what broke. Cost: O(joints).
#include "joints/joint.h"
#include "plumb/math.h"
#include "world/state.h"

static void react(pl_joint *j)
{
    real x = 0, y = 0, w = 0;
    for (int i = 0; i < j->rows.count; ++i) {
        const pl_row *r = &j->rows.row[i];
        x += r->bx * j->impulse[i];
        y += r->by * j->impulse[i];
        w += r->bw * j->impulse[i];
    }
    j->force = plumb_v2(x / j->h, y / j->h);
    j->torque = w / j->h - plumb_vec2_cross(j->arm_b, j->force);
}

static bool overloaded(const pl_joint *j)
{
    const plumb_joint_desc *d = &j->desc;
    return (d->break_force > 0 && plumb_vec2_magnitude(j->force) > d->break_force) ||
           (d->break_torque > 0 && plumb_abs(j->torque) > d->break_torque);
}

// Room for an event of every joint was made with the joint.
static void snap(plumb_world *world, const pl_joint *j)
{
    plumb_joint_break *events = world->joints.broken.data;
    events[world->joints.broken_count++] =
        (plumb_joint_break){ .joint = j->entity,
                             .kind = j->desc.kind,
                             .body_a = j->a.body,
                             .body_b = j->b.body,
                             .point = plumb_joint_anchor_b(world, j->entity),
                             .force = j->force,
                             .torque = j->torque,
                             .user_data = j->desc.user_data };
    pl_destroy_entity(world, j->entity);
}

void pl_joints_finish(plumb_world *world)
{
    for (uint32_t i = 0; i < world->joints.awake_count; ++i) {
        pl_joint *j = pl_joint_awake(&world->joints, i);
        react(j);
        const pl_joint_class *kind = pl_joint_classes[j->desc.kind];
        if (kind->advance != NULL) {
            pl_joint_begin(world, j);
            kind->advance(j, &j->a.pose, &j->b.pose);
        }
        if (overloaded(j)) {
            snap(world, j);
        }
    }
}
