// body_get.c - questions to bodies. On a bad handle: zeros, and a refusal in the log.
//
// Reads: one body row, or the columns as a whole. Writes: nothing. Cost: O(1) unless said
// otherwise.
#include "world/push.h"
#include "world/check.h"
#include "world/rows.h"
#include "world/wrap.h"

bool plumb_body_valid(const plumb_world *world, plumb_body body)
{
    return pl_body_row(world, body) != PL_NONE;
}

// All zeros, which is not a rotation, for a bad handle.
static plumb_transform frame_of(const plumb_world *world, const char *fn, plumb_body body)
{
    uint32_t row = pl_ask_body(world, fn, body);
    if (row == PL_NONE) {
        return (plumb_transform){ { 0, 0 }, { 0, 0 } };
    }
    const pl_bodies *b = &world->bodies;
    return (plumb_transform){ { b->x[row], b->y[row] }, { b->c[row], b->s[row] } };
}

// plumb_body_<name>: what is told of a row of the bodies.
#define GETTER(type, name, value)                                                                  \
    type plumb_body_##name(const plumb_world *world, plumb_body body)                              \
    {                                                                                              \
        const uint32_t row = pl_ask_body(world, __func__, body);                                   \
        const pl_bodies *b = row == PL_NONE ? NULL : &world->bodies;                               \
        return b == NULL ? (type){ 0 } : (value);                                                  \
    }

GETTER(plumb_body_type, get_type, (plumb_body_type)b->type[row])
GETTER(plumb_vec2, center, plumb_v2(b->center_x[row], b->center_y[row]))
GETTER(plumb_vec2, local_center, plumb_v2(b->local_x[row], b->local_y[row]))
GETTER(plumb_vec2, velocity, plumb_v2(b->vx[row], b->vy[row]))
GETTER(plumb_real, angular_velocity, b->w[row])
GETTER(plumb_vec2, force, plumb_v2(b->fx[row], b->fy[row]))
GETTER(plumb_real, torque, b->torque[row])
GETTER(plumb_real, mass, b->inv_mass[row] > 0 ? b->mass[row] : 0)
GETTER(plumb_real, inertia, b->inv_inertia[row] > 0 ? b->inertia[row] : 0)
GETTER(bool, is_continuous, (b->flags[row] & PL_BODY_CONTINUOUS) != 0)
GETTER(bool, is_enabled, (b->flags[row] & PL_BODY_DISABLED) == 0)
GETTER(bool, no_sleep, (b->flags[row] & PL_BODY_NO_SLEEP) != 0)
GETTER(bool, has_target, (b->flags[row] & PL_BODY_TARGETED) != 0)
GETTER(void *, user_data, b->user_data[row])

plumb_transform plumb_body_transform(const plumb_world *world, plumb_body body)
{
    return frame_of(world, __func__, body);
}

plumb_vec2 plumb_body_position(const plumb_world *world, plumb_body body)
{
    return frame_of(world, __func__, body).p;
}

plumb_real plumb_body_angle(const plumb_world *world, plumb_body body)
{
    return plumb_rot_angle(frame_of(world, __func__, body).q);
}

// v + w x r.
plumb_vec2 plumb_body_velocity_at(const plumb_world *world, plumb_body body, plumb_vec2 point)
{
    uint32_t row = pl_ask_body(world, __func__, body);
    if (row == PL_NONE) {
        return plumb_v2(0, 0);
    }
    const pl_bodies *b = &world->bodies;
    plumb_vec2 arm = plumb_vec2_sub(point, plumb_v2(b->center_x[row], b->center_y[row]));
    plumb_vec2 v =
        plumb_vec2_add_scaled(plumb_v2(b->vx[row], b->vy[row]), b->w[row], plumb_vec2_left(arm));
    return plumb_v2(pl_held((double)v.x), pl_held((double)v.y));
}

plumb_axis_locks plumb_body_locks(const plumb_world *world, plumb_body body)
{
    uint32_t row = pl_ask_body(world, __func__, body);
    uint32_t flags = row == PL_NONE ? 0 : world->bodies.flags[row];
    return (plumb_axis_locks){ .x = (flags & PL_BODY_LOCK_X) != 0,
                               .y = (flags & PL_BODY_LOCK_Y) != 0,
                               .rotation = (flags & PL_BODY_FIXED_ROTATION) != 0 };
}

plumb_real plumb_body_kinetic_energy(const plumb_world *world, plumb_body body)
{
    if (pl_ask_body(world, __func__, body) == PL_NONE) {
        return 0;
    }
    // In double: squares of speeds leave the range of a float long before the speeds do.
    plumb_vec2 v = plumb_body_velocity(world, body);
    double w = (double)plumb_body_angular_velocity(world, body);
    double energy = (double)plumb_body_mass(world, body) *
                        ((double)v.x * (double)v.x + (double)v.y * (double)v.y) +
                    (double)plumb_body_inertia(world, body) * w * w;
    return pl_held(energy / 2);
}

// The list has the newest shape first: it is counted, then written from the end.
int plumb_body_shapes(const plumb_world *world, plumb_body body, plumb_shape *shapes, int capacity)
{
    uint32_t row = pl_ask_body(world, __func__, body);
    if (row == PL_NONE) {
        return 0;
    }
    const pl_pieces *pieces = &world->pieces;
    int count = 0;
    for (int pass = 0; pass < 2; ++pass) {
        int at = count;
        uint32_t p = world->bodies.first_piece[row];
        for (; p != PL_NONE; p = pieces->next_in_body[p]) {
            if (world->registry.slots[pieces->shape[p].entity.index].row != p) {
                continue; // not the first piece of its shape
            }
            if (pass == 0) {
                ++count;
            } else if (--at < capacity && shapes != NULL) {
                shapes[at] = pieces->shape[p];
            }
        }
    }
    return count;
}

plumb_aabb plumb_body_aabb(const plumb_world *world, plumb_body body)
{
    plumb_aabb box = plumb_aabb_empty();
    uint32_t row = pl_ask_body(world, __func__, body);
    uint32_t p = row == PL_NONE ? PL_NONE : world->bodies.first_piece[row];
    for (; p != PL_NONE; p = world->pieces.next_in_body[p]) {
        pl_box t = pl_piece_tight_box(world, p);
        box = plumb_aabb_union(box, (plumb_aabb){ { t.min_x, t.min_y }, { t.max_x, t.max_y } });
    }
    return box;
}

//---- frames --------------------------------------------------------------------------------------

plumb_vec2 plumb_body_world_point(const plumb_world *world, plumb_body body, plumb_vec2 local)
{
    return plumb_transform_apply(frame_of(world, __func__, body), local);
}

plumb_vec2 plumb_body_local_point(const plumb_world *world, plumb_body body, plumb_vec2 point)
{
    plumb_transform at = frame_of(world, __func__, body);
    return plumb_transform_inv_apply(at, world == NULL ? point : pl_wrap_point(world, point, at.p));
}

plumb_vec2 plumb_body_world_vector(const plumb_world *world, plumb_body body, plumb_vec2 local)
{
    return plumb_rot_apply(frame_of(world, __func__, body).q, local);
}

plumb_vec2 plumb_body_local_vector(const plumb_world *world, plumb_body body, plumb_vec2 vector)
{
    return plumb_rot_inv_apply(frame_of(world, __func__, body).q, vector);
}

//---- columns -------------------------------------------------------------------------------------

plumb_body_span plumb_world_bodies(plumb_world *world)
{
    if (world == NULL) {
        return (plumb_body_span){ 0 };
    }
    const pl_bodies *b = &world->bodies;
    uint32_t first_static = pl_partition_first(world, PL_PART_STATIC);
    pl_sleep_heed(world);
    return (plumb_body_span){
        .count = (int)b->table.count,
        .dynamic_count = (int)world->dynamic_count,
        .kinematic_count = (int)world->kinematic_count,
        .asleep_count = (int)world->asleep_count,
        .static_count = (int)(b->table.count - world->disabled_count - first_static),
        .disabled_count = (int)world->disabled_count,
        .body = b->entity,
        .x = b->x,
        .y = b->y,
        .center_x = b->center_x,
        .center_y = b->center_y,
        .c = b->c,
        .s = b->s,
        .vx = b->vx,
        .vy = b->vy,
        .w = b->w,
        .fx = b->fx,
        .fy = b->fy,
        .torque = b->torque,
        .inv_mass = b->inv_mass,
        .inv_inertia = b->inv_inertia,
    };
}
