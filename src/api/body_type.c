// body_type.c - what a body is to the simulation: its type, whether it takes part, its locked axes,
// and masses that are given.
//
// A body that changes moves to the partition where it belongs, its pieces to the grid where they
// belong, and the pair list is made anew; what outlives a step of its contacts stays with the pairs
// that stay. Reads: arguments. Writes: one row, its pieces. Cost: O(pieces of the body).
#include "world/body_settings.h"
#include "world/stale_edges.h"
#include "world/joint_list.h"
#include "world/island.h"
#include "world/check.h"
#include "world/rows.h"
#include "world/told.h"

#define CENTER_MOST ((real)1e7) // [m] as points of shapes: PLUMB_LENGTH_MAX

//---- type, enabled -------------------------------------------------------------------------------

// What only dynamic bodies have. The centre of the others is their origin.
static void lose_mass(plumb_world *world, uint32_t row)
{
    pl_bodies *b = &world->bodies;
    b->flags[row] &= (uint16_t)~PL_BODY_OWN_CENTER;
    pl_mass_apply(world, row, &(pl_body_mass){ .mass = 1 });
    b->mass[row] = b->inv_mass[row] = 0;
    b->fx[row] = b->fy[row] = b->torque[row] = 0;
    b->residual_vx[row] = b->residual_vy[row] = 0;
}

// Velocity along locked axes is 0.
static void hold(plumb_world *world, uint32_t row)
{
    pl_bodies *b = &world->bodies;
    const uint32_t flags = b->flags[row];
    b->vx[row] = pl_poses(world)[row].vx = pl_unlocked(flags, PL_BODY_LOCK_X, b->vx[row]);
    b->vy[row] = pl_poses(world)[row].vy = pl_unlocked(flags, PL_BODY_LOCK_Y, b->vy[row]);
    b->w[row] = pl_unlocked(flags, PL_BODY_FIXED_ROTATION, b->w[row]);
}

// The mass that a body which becomes dynamic will have must be one.
static plumb_result check_masses(const plumb_world *world, const char *fn, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    pl_mass_sum sum = pl_mass_of_shapes(world, row);
    pl_body_mass mass;
    if (pl_mass_resolve(&sum, b->set_mass[row], b->set_inertia[row], &mass)) {
        return PLUMB_OK;
    }
    return pl_fail(world, PLUMB_E_RANGE, fn,
                   "mass is %g; mass and inertia of the body must be %g to %g", sum.mass,
                   (double)PL_MASS_LEAST, (double)PL_MASS_MOST);
}

plumb_result plumb_body_set_type(plumb_world *world, plumb_body body, plumb_body_type type)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    if ((unsigned)type > PLUMB_STATIC) {
        return pl_fail(world, PLUMB_E_RANGE, __func__, "type is %d; it must be a plumb_body_type",
                       (int)type);
    }
    PL_TRY(type == PLUMB_DYNAMIC ? check_masses(world, __func__, row) : PLUMB_OK);
    PL_TRY(pl_check_unlocked(world, __func__));
    if ((plumb_body_type)world->bodies.type[row] == type) {
        return PLUMB_OK;
    }
    pl_bodies *b = &world->bodies;
    pl_target_forget(world, row);
    if (b->type[row] == PLUMB_DYNAMIC) {
        lose_mass(world, row);
    }
    b->type[row] = (uint8_t)type;
    if (type == PLUMB_STATIC) {
        pl_body_stand_still(world, row);
    } else if (type == PLUMB_DYNAMIC) {
        pl_mass_revise(world, row);
        hold(world, row);
    }
    pl_body_relocate(world, row);
    pl_told(world, body.entity, __func__);
    return PLUMB_OK;
}

plumb_result plumb_body_set_enabled(plumb_world *world, plumb_body body, bool enabled)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    PL_TRY(pl_check_unlocked(world, __func__));
    if (plumb_body_is_enabled(world, body) != enabled) {
        world->bodies.flags[row] ^= PL_BODY_DISABLED;
        world->bodies.fx[row] = world->bodies.fy[row] = world->bodies.torque[row] = 0;
        pl_body_relocate(world, row);
    }
    pl_told(world, body.entity, __func__);
    return PLUMB_OK;
}

//---- locked axes ---------------------------------------------------------------------------------

plumb_result plumb_body_set_locks(plumb_world *world, plumb_body body, plumb_axis_locks locks)
{
    uint32_t row;
    PL_TRY(pl_check_dynamic(world, __func__, body, &row));
    uint16_t *flags = &world->bodies.flags[row];
    const uint16_t wanted =
        (uint16_t)((*flags & ~(PL_BODY_LOCKED | PL_BODY_FIXED_ROTATION)) |
                   (locks.x ? PL_BODY_LOCK_X : 0) | (locks.y ? PL_BODY_LOCK_Y : 0) |
                   (locks.rotation ? PL_BODY_FIXED_ROTATION : 0));
    if (wanted == *flags) {
        return PLUMB_OK;
    }
    const bool was = (*flags & PL_BODY_LOCKED) != 0;
    *flags = wanted;
    world->locked_bodies += (locks.x || locks.y ? 1u : 0u) - (was ? 1u : 0u);
    pl_joints_replan(&world->joints);
    world->bodies.residual_vx[row] = world->bodies.residual_vy[row] = 0;
    hold(world, row);
    pl_mass_revise(world, row);
    pl_sleep_disturb(world, row);
    world->schedule_dirty = true;
    pl_told(world, body.entity, __func__);
    return PLUMB_OK;
}

//---- masses that are given -----------------------------------------------------------------------

plumb_result plumb_body_set_inertia(plumb_world *world, plumb_body body, plumb_real inertia)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    PL_TRY(pl_check_range(world, __func__, "inertia", inertia, PL_MASS_LEAST, PL_MASS_MOST));
    PL_TRY(pl_check_dynamic(world, __func__, body, &row));
    if (inertia == world->bodies.set_inertia[row]) {
        return PLUMB_OK;
    }
    world->bodies.set_inertia[row] = inertia;
    pl_mass_revise(world, row);
    pl_sleep_disturb(world, row);
    pl_told(world, body.entity, __func__);
    return PLUMB_OK;
}

plumb_result plumb_body_set_local_center(plumb_world *world, plumb_body body, plumb_vec2 center)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    PL_TRY(pl_check_within(world, __func__, "center", center, CENTER_MOST));
    PL_TRY(pl_check_dynamic(world, __func__, body, &row));
    pl_bodies *b = &world->bodies;
    if ((b->flags[row] & PL_BODY_OWN_CENTER) != 0 && center.x == b->local_x[row] &&
        center.y == b->local_y[row]) {
        return PLUMB_OK;
    }
    pl_mass_sum sum = pl_mass_of_shapes(world, row);
    pl_body_mass mass;
    pl_mass_recenter(&sum, center.x, center.y);
    if (!pl_mass_resolve(&sum, b->set_mass[row], b->set_inertia[row], &mass)) {
        return pl_fail(world, PLUMB_E_RANGE, __func__,
                       "center is (%g, %g); the inertia that follows must be %g to %g",
                       (double)center.x, (double)center.y, (double)PL_MASS_LEAST,
                       (double)PL_MASS_MOST);
    }
    pl_mass_apply(world, row, &mass);
    b->flags[row] |= PL_BODY_OWN_CENTER;
    pl_sleep_disturb(world, row);
    pl_told(world, body.entity, __func__);
    return PLUMB_OK;
}

//---- place, one half of it -----------------------------------------------------------------------

plumb_result plumb_body_set_position(plumb_world *world, plumb_body body, plumb_vec2 position)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    PL_TRY(pl_place_check(world, __func__, position, 0));
    PL_TRY(pl_check_unlocked(world, __func__));
    const plumb_rot q = { world->bodies.c[row], world->bodies.s[row] };
    pl_body_move_to(world, __func__, row, position, plumb_rot_angle(q));
    return PLUMB_OK;
}

plumb_result plumb_body_set_angle(plumb_world *world, plumb_body body, plumb_real angle)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    PL_TRY(pl_check_finite(world, __func__, "angle", angle));
    PL_TRY(pl_check_unlocked(world, __func__));
    pl_body_move_to(world, __func__, row, plumb_v2(world->bodies.x[row], world->bodies.y[row]),
                    angle);
    return PLUMB_OK;
}
