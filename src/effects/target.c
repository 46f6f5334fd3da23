// target.c - kinematic bodies on their way to a target.
//
// The velocity is what leads straight to the target in the time that is left; after each step it is
// aimed anew, for the next step if less than that is left. On arrival the pose is set to the target,
// bit for bit, and the body stands still. All of it happens after motion: a step that runs out of
// memory must find velocities as they were. Reads: targets, poses. Writes: velocities and poses of
// their bodies. Cost: O(targets).
#include "effects/effects.h"
#include "world/body_settings.h"
#include "world/told.h"
#include "plumb/math.h"
#include "world/check.h"
#include "world/rows.h"
#include "world/wrap.h"

// [-] of the step: a rest below this is rounding.
#define REST ((real)1e-4)

static pl_target *items(const plumb_world *world)
{
    return (pl_target *)world->targets.items.data;
}

// Heads for the target, to be there after `time` [s].
static void aim(plumb_world *world, uint32_t row, const pl_target *target, real time)
{
    pl_bodies *b = &world->bodies;
    real scale = pl_time_scale(world, row);
    real rate = scale > 0 ? 1 / (time * scale) : 1 / time; // it waits, ready to go
    plumb_rot turn = plumb_rot_inv_mul((plumb_rot){ b->c[row], b->s[row] }, target->turn);
    plumb_vec2 here = { b->x[row], b->y[row] };
    plumb_vec2 way = plumb_world_way(world, here, plumb_v2(target->x, target->y));
    b->vx[row] = pl_poses(world)[row].vx = way.x * rate;
    b->vy[row] = pl_poses(world)[row].vy = way.y * rate;
    b->w[row] = plumb_rot_angle(turn) * rate;
}

void pl_target_reaim(plumb_world *world, uint32_t row)
{
    bool has = (world->bodies.flags[row] & PL_BODY_TARGETED) != 0;
    if (has) {
        pl_tracks_reaim(world, row);
    }
    for (uint32_t i = 0; has && i < world->targets.count; ++i) {
        const pl_target *target = &items(world)[i];
        if (plumb_same(target->body, world->bodies.entity[row])) {
            aim(world, row, target, target->left);
        }
    }
}

plumb_result pl_target_check(const plumb_world *world, const char *function, uint32_t row, real dt)
{
    PL_TRY(pl_check_finite(world, function, "dt", dt));
    if (!(dt > 0)) {
        return pl_fail(world, PLUMB_E_RANGE, function, "dt is %g; it must be above 0", (double)dt);
    }
    if (world->bodies.type[row] != PLUMB_KINEMATIC) {
        return pl_fail(world, PLUMB_E_STATE, function, "body is %s; it must be kinematic",
                       world->bodies.type[row] == PLUMB_STATIC ? "static" : "dynamic");
    }
    return PLUMB_OK;
}

plumb_result plumb_body_set_target(plumb_world *world, plumb_body body, plumb_vec2 position,
                                   plumb_real angle, plumb_real dt)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    PL_TRY(pl_place_check(world, __func__, position, angle));
    PL_TRY(pl_target_check(world, __func__, row, dt));
    pl_targets *targets = &world->targets;
    if (!pl_buffer_reserve(&world->memory, &targets->items,
                           ((size_t)targets->count + 1) * sizeof(pl_target))) {
        return pl_fail_memory(world, __func__);
    }
    pl_target_forget(world, row);
    pl_target *target = &items(world)[targets->count++];
    *target = (pl_target){ body, position.x, position.y, plumb_rot_make(angle), dt };
    world->bodies.flags[row] |= PL_BODY_TARGETED;
    world->schedule_dirty = true;
    aim(world, row, target, dt);
    pl_told(world, body.entity, __func__);
    return PLUMB_OK;
}

void pl_targets_arrive(plumb_world *world, real dt)
{
    pl_bodies *b = &world->bodies;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < world->targets.count; ++i) {
        pl_target target = items(world)[i];
        uint32_t row = pl_body_row(world, target.body);
        bool waits = (b->flags[row] & PL_BODY_DISABLED) != 0 || pl_time_scale(world, row) == 0;
        target.left -= waits ? 0 : dt;
        if (target.left > REST * dt) {
            items(world)[kept++] = target;
            aim(world, row, &target, target.left > dt ? target.left : dt);
            continue;
        }
        b->x[row] = target.x, b->y[row] = target.y;
        b->c[row] = target.turn.c, b->s[row] = target.turn.s;
        b->vx[row] = b->vy[row] = b->w[row] = 0;
        pl_body_update_center(world, row);
        b->flags[row] &= (uint16_t)~PL_BODY_TARGETED;
    }
    world->schedule_dirty |= kept == 0;
    world->targets.count = kept;
}
