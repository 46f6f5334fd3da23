// relocate.c - a body that has changed moves to the partition and its pieces to the grid where they belong.
//
// Reads, writes: one row, its pieces, joints and sleeping contacts. Cost: O(pieces and joints of the body).
#include "world/island.h"
#include "world/joint_list.h"
#include "world/law_list.h"
#include "world/rows.h"
#include "world/stale_edges.h"

// Row and pieces where type and flags of the body want them. What it touched or held in its sleep wakes.
void pl_body_relocate(plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    b->flags[row] &= (uint16_t)~PL_BODY_DROPPING; // who does not move has nothing to drop through
    pl_sleep_stir(world, row);
    pl_sleep_forget(world, row);
    if (world->laws.count > 0) {
        pl_laws_miss(world, row);
    }
    for (uint32_t p = b->first_piece[row]; p != PL_NONE; p = world->pieces.next_in_body[p]) {
        pl_sleep_void_contacts(world, p);
        pl_internal_edges_forget(world, p);
    }
    plumb_body body = b->entity[row];
    for (uint32_t k = b->first_joint[row]; k != PL_NONE;) {
        const pl_joint *joint = &pl_joint_items(&world->joints)[k];
        pl_joint_disturb(world, joint);
        k = pl_joint_next(joint, body);
    }
    bool disabled = (b->flags[row] & PL_BODY_DISABLED) != 0;
    pl_partition home =
        disabled ? PL_PART_DISABLED : pl_partition_of((plumb_body_type)b->type[row]);
    row = pl_row_transfer(world, row, home);
    world->joints.awake_stale = true; // it may have slept
    pl_joints_replan(&world->joints);
    pl_pieces_refile(world, row);
    for (uint32_t p = b->first_piece[row]; p != PL_NONE && !disabled;
         p = world->pieces.next_in_body[p]) {
        pl_internal_edges_touch(world, p);
    }
    world->schedule_dirty = true;
}

void pl_body_stand_still(plumb_world *world, uint32_t row)
{
    pl_bodies *b = &world->bodies;
    b->vx[row] = b->vy[row] = b->w[row] = 0;
    pl_poses(world)[row].vx = pl_poses(world)[row].vy = 0;
}

void pl_body_take_out(plumb_world *world, uint32_t row)
{
    pl_bodies *b = &world->bodies;
    pl_body_stand_still(world, row);
    b->residual_vx[row] = b->residual_vy[row] = 0;
    b->fx[row] = b->fy[row] = b->torque[row] = 0;
    b->flags[row] |= PL_BODY_DISABLED;
    pl_body_relocate(world, row);
}
