// joint_list.c - joints as lists through the bodies.
//
// Reads: the registry, bodies. Writes: joints, first_joint of bodies. Cost: O(1), O(joints of a body) to ask and
// to remove.
#include "world/joint_list.h"

#include "world/check.h"
#include "world/island.h"
#include "world/rows.h"
#include "world/stale_edges.h"

#include <string.h>

uint32_t pl_joint_slot(const plumb_world *world, plumb_joint joint)
{
    if (world == NULL) {
        return PL_NONE;
    }
    const pl_slot *slot = pl_registry_find(&world->registry, joint.entity);
    return slot != NULL && slot->kind == PLUMB_KIND_JOINT ? slot->row : PL_NONE;
}

plumb_result pl_check_joint(const plumb_world *world, const char *function, plumb_joint joint,
                            pl_joint **out)
{
    const uint32_t slot = pl_joint_slot(world, joint);
    *out = slot != PL_NONE ? &pl_joint_items(&world->joints)[slot] : NULL;
    return *out != NULL ? PLUMB_OK
                        : pl_fail_handle(world, function, "joint", joint.entity, "a live joint");
}

const pl_joint *pl_ask_joint(const plumb_world *world, const char *function, plumb_joint joint)
{
    pl_joint *found;
    pl_check_joint(world, function, joint, &found);
    return found;
}

uint32_t pl_joint_next(const pl_joint *joint, plumb_body body)
{
    return plumb_same(joint->a.body, body) ? joint->a.next : joint->b.next;
}

bool pl_joints_forbid(const plumb_world *world, uint32_t row, uint32_t other)
{
    const pl_joint *items = pl_joint_items(&world->joints);
    if (world->bodies.first_joint[other] == PL_NONE) {
        return false;
    }
    plumb_body body = world->bodies.entity[row], partner = world->bodies.entity[other];
    for (uint32_t i = world->bodies.first_joint[row]; i != PL_NONE;
         i = pl_joint_next(&items[i], body)) {
        if (!items[i].desc.collide_connected && !items[i].desc.disabled &&
            (plumb_same(items[i].a.body, partner) || plumb_same(items[i].b.body, partner))) {
            return true;
        }
    }
    return false;
}

bool pl_joints_part(const plumb_world *world, uint32_t row)
{
    const pl_joint *items = pl_joint_items(&world->joints);
    plumb_body body = world->bodies.entity[row];
    for (uint32_t i = world->bodies.first_joint[row]; i != PL_NONE;
         i = pl_joint_next(&items[i], body)) {
        if (!items[i].desc.collide_connected && !plumb_is_null(items[i].a.body) &&
            !plumb_is_null(items[i].b.body)) {
            return true;
        }
    }
    return false;
}

uint32_t pl_joint_row(const plumb_world *world, const pl_joint_end *end)
{
    return plumb_is_null(end->body) ? PL_NONE : pl_body_row(world, end->body);
}

// A joint made awake between a body that is and one that sleeps wakes it, even a furnished one.
void pl_joint_disturb(plumb_world *world, const pl_joint *joint)
{
    uint32_t a = pl_joint_row(world, &joint->a), b = pl_joint_row(world, &joint->b);
    bool mixed =
        a != PL_NONE && b != PL_NONE && (a < world->dynamic_count) != (b < world->dynamic_count);
    const uint32_t rows[2] = { a, b };
    for (int i = 0; i < 2; ++i) {
        if (rows[i] != PL_NONE && mixed && pl_row_is_asleep(world, rows[i])) {
            pl_sleep_stir(world, rows[i]);
        } else if (rows[i] != PL_NONE) {
            pl_sleep_disturb(world, rows[i]);
        }
    }
}

// Pairs of the two bodies come or go with the joint.
void pl_joint_revise(plumb_world *world, const pl_joint *joint)
{
    if (!joint->desc.collide_connected && !plumb_is_null(joint->a.body) &&
        !plumb_is_null(joint->b.body)) {
        pl_rearranged(world);
        pl_internal_edges_touch_static(world, pl_body_row(world, joint->a.body));
        pl_internal_edges_touch_static(world, pl_body_row(world, joint->b.body));
    }
    world->joints.awake_stale = true;
    world->schedule_dirty = true;
    pl_joints_replan(&world->joints);
}

static void detach(plumb_world *world, uint32_t slot, const pl_joint_end *end)
{
    if (plumb_is_null(end->body)) {
        return;
    }
    pl_joint *items = pl_joint_items(&world->joints);
    uint32_t *link = &world->bodies.first_joint[pl_body_row(world, end->body)];
    while (*link != slot) {
        pl_joint *j = &items[*link];
        link = plumb_same(j->a.body, end->body) ? &j->a.next : &j->b.next;
    }
    *link = end->next;
}

void pl_joint_rehang(plumb_world *world, uint32_t slot, pl_joint_end *end, plumb_body body)
{
    pl_joint *j = &pl_joint_items(&world->joints)[slot];
    pl_joint_disturb(world, j);
    pl_joint_revise(world, j);
    detach(world, slot, end);
    uint32_t *first = &world->bodies.first_joint[pl_body_row(world, body)];
    *(end == &j->a ? &j->desc.body_a : &j->desc.body_b) = end->body = body;
    end->next = *first;
    *first = slot;
    pl_joint_disturb(world, j);
    pl_joint_revise(world, j);
}

void pl_joint_remove(plumb_world *world, uint32_t slot)
{
    pl_joint *j = &pl_joint_items(&world->joints)[slot];
    detach(world, slot, &j->a);
    detach(world, slot, &j->b);
    pl_joint_disturb(world, j);
    pl_joint_revise(world, j);
    pl_registry_release(&world->registry, j->entity.entity);
    world->joints.watched -= pl_joint_is_watched(&j->desc);
    world->joints.bouncing -= pl_joint_bounces(&j->desc);
    memset(j, 0, sizeof *j);
    j->a.next = world->joints.free_head;
    world->joints.free_head = slot;
    --world->joints.live;
}
