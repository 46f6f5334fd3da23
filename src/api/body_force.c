// body_force.c - forces for the next step, and impulses at once.
//
// A force F at the point p adds F and the torque r x F, r = p - centre; an impulse P changes the
// velocity by P / m and the angular velocity by (r x P) / I. A sum that would no longer be finite
// is refused.
//
// Reads: centre, inverse masses. Writes: force and velocity columns of one row. Cost: O(1).
#include "world/push.h"
#include "world/body_settings.h"
#include "world/island.h"
#include "world/check.h"
#include "world/rows.h"
#include "world/told.h"
#include "world/wrap.h"

static pl_push push_at(const plumb_world *world, uint32_t row, plumb_vec2 linear, plumb_vec2 point)
{
    const pl_bodies *b = &world->bodies;
    plumb_vec2 arm = plumb_world_way(world, plumb_v2(b->center_x[row], b->center_y[row]), point);
    return (pl_push){ linear, plumb_vec2_cross(arm, linear) };
}

static plumb_result refuse_sum(const plumb_world *world, const char *fn, const char *field)
{
    return pl_fail(world, PLUMB_E_NOT_FINITE, fn,
                   "%s is too large; the sum over the body must be finite", field);
}

static plumb_result add_force(plumb_world *world, const char *fn, const char *field, uint32_t row,
                              pl_push p)
{
    pl_bodies *b = &world->bodies;
    plumb_vec2 force = plumb_v2(b->fx[row] + p.linear.x, b->fy[row] + p.linear.y);
    real torque = b->torque[row] + p.angular;
    if (!plumb_vec2_is_finite(force) || !plumb_is_finite(torque)) {
        return refuse_sum(world, fn, field);
    }
    if (p.linear.x != 0 || p.linear.y != 0 || p.angular != 0) {
        pl_sleep_push(world, row);
    }
    b->fx[row] = force.x;
    b->fy[row] = force.y;
    b->torque[row] = torque;
    pl_told(world, b->entity[row].entity, fn);
    return PLUMB_OK;
}

// The velocities that a body would have; false when they would not be finite.
static bool after_impulse(const plumb_world *world, uint32_t row, pl_push p, plumb_vec2 *v, real *w)
{
    const pl_bodies *b = &world->bodies;
    const uint32_t flags = b->flags[row];
    real ix = pl_unlocked(flags, PL_BODY_LOCK_X, b->inv_mass[row]);
    real iy = pl_unlocked(flags, PL_BODY_LOCK_Y, b->inv_mass[row]);
    *v = plumb_v2(b->vx[row] + p.linear.x * ix, b->vy[row] + p.linear.y * iy);
    // Not at all, rather than by 0 times an angular impulse that may have overflowed.
    *w = b->inv_inertia[row] > 0 ? b->w[row] + p.angular * b->inv_inertia[row] : b->w[row];
    return plumb_vec2_is_finite(*v) && plumb_is_finite(*w);
}

plumb_result pl_impulse_check(const plumb_world *world, const char *fn, uint32_t row, pl_push p)
{
    plumb_vec2 v;
    real w;
    return after_impulse(world, row, p, &v, &w) ? PLUMB_OK : refuse_sum(world, fn, "impulse");
}

plumb_result pl_impulse_add(plumb_world *world, const char *fn, uint32_t row, pl_push p)
{
    pl_bodies *b = &world->bodies;
    plumb_vec2 v;
    real w;
    if (!after_impulse(world, row, p, &v, &w)) {
        return refuse_sum(world, fn, "impulse");
    }
    if (v.x != b->vx[row] || v.y != b->vy[row] || w != b->w[row]) {
        pl_sleep_stir(world, row);
    }
    b->vx[row] = pl_poses(world)[row].vx = v.x;
    b->vy[row] = pl_poses(world)[row].vy = v.y;
    b->w[row] = w;
    pl_told(world, b->entity[row].entity, fn);
    return PLUMB_OK;
}

static plumb_result check_pushable(const plumb_world *world, const char *fn, plumb_body body,
                                   uint32_t *row)
{
    PL_TRY(pl_check_dynamic(world, fn, body, row));
    return (world->bodies.flags[*row] & PL_BODY_DISABLED) == 0
               ? PLUMB_OK
               : pl_fail(world, PLUMB_E_STATE, fn, "body is disabled; it must be enabled");
}

// Checks a vector, then that the body may be pushed.
static plumb_result check_push(const plumb_world *world, const char *fn, plumb_body body,
                               const char *field, plumb_vec2 value, uint32_t *row)
{
    PL_TRY(pl_check_body(world, fn, body, row));
    PL_TRY(pl_check_finite_vec(world, fn, field, value));
    return check_pushable(world, fn, body, row);
}

static plumb_result check_turn(const plumb_world *world, const char *fn, plumb_body body,
                               const char *field, real value, uint32_t *row)
{
    PL_TRY(pl_check_body(world, fn, body, row));
    PL_TRY(pl_check_finite(world, fn, field, value));
    return check_pushable(world, fn, body, row);
}

plumb_result plumb_body_apply_force(plumb_world *world, plumb_body body, plumb_vec2 force,
                                    plumb_vec2 point)
{
    uint32_t row;
    PL_TRY(check_push(world, __func__, body, "force", force, &row));
    PL_TRY(pl_check_finite_vec(world, __func__, "point", point));
    return add_force(world, __func__, "force", row, push_at(world, row, force, point));
}

plumb_result plumb_body_apply_force_center(plumb_world *world, plumb_body body, plumb_vec2 force)
{
    uint32_t row;
    PL_TRY(check_push(world, __func__, body, "force", force, &row));
    return add_force(world, __func__, "force", row, (pl_push){ force, 0 });
}

plumb_result plumb_body_apply_torque(plumb_world *world, plumb_body body, plumb_real torque)
{
    uint32_t row;
    PL_TRY(check_turn(world, __func__, body, "torque", torque, &row));
    return add_force(world, __func__, "torque", row, (pl_push){ { 0, 0 }, torque });
}

plumb_result plumb_body_apply_impulse(plumb_world *world, plumb_body body, plumb_vec2 impulse,
                                      plumb_vec2 point)
{
    uint32_t row;
    PL_TRY(check_push(world, __func__, body, "impulse", impulse, &row));
    PL_TRY(pl_check_finite_vec(world, __func__, "point", point));
    return pl_impulse_add(world, __func__, row, push_at(world, row, impulse, point));
}

plumb_result plumb_body_apply_impulse_center(plumb_world *world, plumb_body body,
                                             plumb_vec2 impulse)
{
    uint32_t row;
    PL_TRY(check_push(world, __func__, body, "impulse", impulse, &row));
    return pl_impulse_add(world, __func__, row, (pl_push){ impulse, 0 });
}

plumb_result plumb_body_apply_angular_impulse(plumb_world *world, plumb_body body,
                                              plumb_real impulse)
{
    uint32_t row;
    PL_TRY(check_turn(world, __func__, body, "impulse", impulse, &row));
    return pl_impulse_add(world, __func__, row, (pl_push){ { 0, 0 }, impulse });
}

plumb_result plumb_body_clear_forces(plumb_world *world, plumb_body body)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    world->bodies.fx[row] = world->bodies.fy[row] = world->bodies.torque[row] = 0;
    pl_told(world, body.entity, __func__);
    return PLUMB_OK;
}
