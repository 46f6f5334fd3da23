// lock.c - joints of bodies with locked axes.
//
// A body that cannot move along an axis has infinite mass that way: no impulse changes its
// velocity, which is 0. A row without its components along that axis says just that, for velocity,
// impulse and effective mass alike. Reactions are told from rows that still have them (finish.c).
//
// Reads: flags of bodies. Writes: rows. Cost: O(rows), in worlds that have a locked body.
#include "world/body_settings.h"
#include "world/joint_list.h"
#include "joints/joint.h"
#include "world/state.h"

uint32_t pl_joint_locks(const plumb_world *world, uint32_t row)
{
    return row < world->dynamic_count ? world->bodies.flags[row] & PL_BODY_LOCKED : 0;
}

void pl_joint_lock_rows(const plumb_world *world, pl_joint *joint)
{
    const uint32_t a = pl_joint_locks(world, pl_joint_row(world, &joint->a));
    const uint32_t b = pl_joint_locks(world, pl_joint_row(world, &joint->b));
    for (int i = 0; (a | b) != 0 && i < joint->rows.count; ++i) {
        pl_row *r = &joint->rows.row[i];
        r->ax = pl_unlocked(a, PL_BODY_LOCK_X, r->ax);
        r->ay = pl_unlocked(a, PL_BODY_LOCK_Y, r->ay);
        r->bx = pl_unlocked(b, PL_BODY_LOCK_X, r->bx);
        r->by = pl_unlocked(b, PL_BODY_LOCK_Y, r->by);
    }
}
