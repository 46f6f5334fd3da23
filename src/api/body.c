// body.c - bodies are made, destroyed and set.
//
// Reads: arguments, checked before anything changes. Writes: one body row.
// Cost: O(1); mass functions and teleport O(pieces of the body).
#include "world/body_settings.h"
#include "world/heat_list.h"
#include "world/destroy.h"
#include "world/stale_edges.h"
#include "world/island.h"
#include "world/told.h"
#include "effects/effects.h"
#include "world/check.h"
#include "world/rows.h"

//---- create, destroy -----------------------------------------------------------------------------

static plumb_result check_motion(const plumb_world *world, const char *fn,
                                 const plumb_body_desc *desc)
{
    bool is_static = desc->type == PLUMB_STATIC;
    if (is_static && (desc->velocity.x != 0 || desc->velocity.y != 0)) {
        return pl_fail(world, PLUMB_E_RANGE, fn,
                       "velocity is (%g, %g); it must be (0, 0) for a static body",
                       (double)desc->velocity.x, (double)desc->velocity.y);
    }
    if ((is_static || desc->fixed_rotation) && desc->angular_velocity != 0) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "angular_velocity is %g; it must be 0 %s",
                       (double)desc->angular_velocity,
                       is_static ? "for a static body" : "with fixed_rotation");
    }
    const char *along = desc->lock_x && desc->velocity.x != 0   ? "x"
                        : desc->lock_y && desc->velocity.y != 0 ? "y"
                                                                : NULL;
    return along == NULL
               ? PLUMB_OK
               : pl_fail(world, PLUMB_E_RANGE, fn,
                         "velocity is (%g, %g); its %s must be 0 with lock_%s",
                         (double)desc->velocity.x, (double)desc->velocity.y, along, along);
}

static plumb_result check_sleep(const plumb_world *world, const char *fn,
                                const plumb_body_desc *desc)
{
    const char *why =
        desc->type == PLUMB_KINEMATIC ? "for a kinematic body"
        : desc->type == PLUMB_STATIC  ? "for a static body"
        : desc->no_sleep              ? "with no_sleep"
        : desc->velocity.x != 0 || desc->velocity.y != 0 || desc->angular_velocity != 0
            ? "for a body that moves"
            : NULL;
    return !desc->asleep || why == NULL
               ? PLUMB_OK
               : pl_fail(world, PLUMB_E_RANGE, fn, "asleep is true; it must be false %s", why);
}

plumb_result pl_body_check(const plumb_world *world, const char *fn, const plumb_body_desc *desc)
{
    PL_TRY(pl_check_pointer(world, fn, "desc", desc));
    PL_TRY(pl_check_desc(world, fn, "", PLUMB_TABLE_BODY, desc));
    PL_TRY(check_motion(world, fn, desc));
    PL_TRY(check_sleep(world, fn, desc));
    if (desc->continuous && desc->type != PLUMB_DYNAMIC) {
        return pl_fail(world, PLUMB_E_RANGE, fn,
                       "continuous is true; it must be false for a %s body",
                       desc->type == PLUMB_STATIC ? "static" : "kinematic");
    }
    return PLUMB_OK;
}

static void set_continuous(plumb_world *world, uint32_t row, bool continuous)
{
    uint16_t *flags = &world->bodies.flags[row];
    uint32_t was = (*flags & PL_BODY_CONTINUOUS) != 0;
    *flags = (uint16_t)(continuous ? *flags | PL_BODY_CONTINUOUS
                                   : *flags & (uint16_t)~PL_BODY_CONTINUOUS);
    world->continuous_bodies += (continuous ? 1u : 0u) - was;
    world->schedule_dirty = true;
}

static void fill_row(plumb_world *world, uint32_t row, const plumb_body_desc *desc)
{
    pl_bodies *b = &world->bodies;
    b->type[row] = (uint8_t)desc->type;
    b->flags[row] =
        (uint16_t)((desc->fixed_rotation ? PL_BODY_FIXED_ROTATION : 0) |
                   (desc->lock_x ? PL_BODY_LOCK_X : 0) | (desc->lock_y ? PL_BODY_LOCK_Y : 0) |
                   (desc->disabled ? PL_BODY_DISABLED : 0) |
                   (desc->no_sleep ? PL_BODY_NO_SLEEP : 0));
    set_continuous(world, row, desc->continuous);
    world->locked_bodies += desc->lock_x || desc->lock_y;
#define MEANT(name, initial) .name = desc->name != 0 ? desc->name : (real)(initial),
    pl_body_settings_set(world, row, &(pl_body_settings){ PL_BODY_ROWS(PL_ROW_RECORD, MEANT) });
#undef MEANT
    PL_BODY_ROWS(PL_ROW_FILL, b)
    pl_heat heat = pl_heat_of_desc(desc);
    if (pl_heat_is_any(&heat)) {
        heat.body = b->entity[row];
        pl_heat_set(world, &heat);
    }
    b->vx[row] = desc->velocity.x;
    b->vy[row] = desc->velocity.y;
    b->w[row] = desc->angular_velocity;
    b->set_mass[row] = desc->mass;
    b->set_inertia[row] = desc->inertia;
    b->user_data[row] = desc->user_data;
    pl_mass_revise(world, row);
    pl_body_place(world, row, desc->position, desc->angle);
}

static bool reserve_heat(plumb_world *world, const plumb_body_desc *desc)
{
    const pl_heat heat = pl_heat_of_desc(desc);
    return !pl_heat_is_any(&heat) || pl_heat_reserve(world, 1);
}

plumb_result pl_body_insert(plumb_world *world, const char *fn, const plumb_body_desc *desc,
                            plumb_body *body)
{
    if (!pl_registry_reserve(&world->memory, &world->registry, 1) || !pl_rows_reserve(world, 1) ||
        !pl_body_settings_reserve(world) || !reserve_heat(world, desc)) {
        return pl_fail_memory(world, fn);
    }
    const bool asleep = desc->asleep && !desc->disabled && !world->desc.no_sleep;
    if (asleep && !pl_islands_reserve(world, 1, 0)) {
        return pl_fail_memory(world, fn);
    }
    uint32_t row = pl_row_open(world, desc->disabled ? PL_PART_DISABLED
                                      : asleep       ? PL_PART_ASLEEP
                                                     : pl_partition_of(desc->type));
    body->entity = pl_entity_claim(world, body->entity, PLUMB_KIND_BODY, row);
    world->bodies.entity[row] = *body;
    fill_row(world, row, desc);
    if (asleep) {
        pl_sleep_make(world, row);
    }
    pl_told(world, body->entity, fn);
    return PLUMB_OK;
}

plumb_body plumb_body_create(plumb_world *world, const plumb_body_desc *desc)
{
    plumb_body body = PLUMB_NULL_INIT;
    if (world == NULL || pl_check_unlocked(world, __func__) != PLUMB_OK ||
        pl_body_check(world, __func__, desc) != PLUMB_OK) {
        return body;
    }
    pl_body_insert(world, __func__, desc, &body);
    return body;
}

plumb_result plumb_body_destroy(plumb_world *world, plumb_body body)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    PL_TRY(pl_check_unlocked(world, __func__));
    pl_destroy_entity(world, body.entity);
    return PLUMB_OK;
}

//---- place and velocity --------------------------------------------------------------------------

void pl_body_place(plumb_world *world, uint32_t row, plumb_vec2 position, plumb_real angle)
{
    pl_body_place_at(world, row, position, plumb_rot_make(angle));
}

static void lose_boxes(plumb_world *world, uint32_t row)
{
    uint32_t p = world->bodies.first_piece[row];
    for (; p != PL_NONE; p = world->pieces.next_in_body[p]) {
        pl_piece_lose_box(world, p);
    }
}

void pl_body_place_at(plumb_world *world, uint32_t row, plumb_vec2 position, plumb_rot q)
{
    pl_bodies *b = &world->bodies;
    b->x[row] = position.x;
    b->y[row] = position.y;
    b->c[row] = q.c;
    b->s[row] = q.s;
    pl_body_update_center(world, row);
    pl_sleep_disturb(world, row);
    pl_target_forget(world, row);
    if (b->first_piece[row] != PL_NONE) {
        pl_rearranged(world);
        world->sleep.boxes_stale |= b->island[row] != PL_NONE;
        pl_internal_edges_move_static(world, row); // by the boxes of where it was
        if (b->type[row] == PLUMB_STATIC) {
            world->static_dirty = true;
            lose_boxes(world, row);
        }
    }
}

void pl_body_move_to(plumb_world *world, const char *fn, uint32_t row, plumb_vec2 position,
                     plumb_real angle)
{
    const pl_bodies *b = &world->bodies;
    const plumb_rot now = { b->c[row], b->s[row] };
    const bool turns = angle != plumb_rot_angle(now);
    if (turns || position.x != b->x[row] || position.y != b->y[row]) {
        pl_body_place_at(world, row, position, turns ? plumb_rot_make(angle) : now);
    }
    pl_target_forget(world, row);
    pl_told(world, b->entity[row].entity, fn);
}

plumb_result plumb_body_teleport(plumb_world *world, plumb_body body, plumb_vec2 position,
                                 plumb_real angle)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    PL_TRY(pl_place_check(world, __func__, position, angle));
    PL_TRY(pl_check_unlocked(world, __func__));
    pl_body_move_to(world, __func__, row, position, angle);
    return PLUMB_OK;
}

static plumb_result check_movable(const plumb_world *world, const char *fn, uint32_t row)
{
    if (world->bodies.type[row] != PLUMB_STATIC) {
        return PLUMB_OK;
    }
    return pl_fail(world, PLUMB_E_STATE, fn, "body is static; it must be dynamic or kinematic");
}

static plumb_result check_locks(const plumb_world *world, const char *fn, uint32_t row,
                                plumb_vec2 velocity)
{
    uint32_t flags = world->bodies.type[row] == PLUMB_DYNAMIC ? world->bodies.flags[row] : 0;
    const char *along = (flags & PL_BODY_LOCK_X) != 0 && velocity.x != 0   ? "x"
                        : (flags & PL_BODY_LOCK_Y) != 0 && velocity.y != 0 ? "y"
                                                                           : NULL;
    return along == NULL ? PLUMB_OK
                         : pl_fail(world, PLUMB_E_STATE, fn,
                                   "velocity is (%g, %g); its %s must be 0 for a body locked in %s",
                                   (double)velocity.x, (double)velocity.y, along, along);
}

plumb_result plumb_body_set_velocity(plumb_world *world, plumb_body body, plumb_vec2 velocity)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    PL_TRY(pl_check_finite_vec(world, __func__, "velocity", velocity));
    PL_TRY(check_movable(world, __func__, row));
    PL_TRY(check_locks(world, __func__, row, velocity));
    pl_bodies *b = &world->bodies;
    const bool other_x = velocity.x != b->vx[row], other_y = velocity.y != b->vy[row];
    if (other_x || other_y) {
        pl_sleep_stir(world, row);
        pl_told(world, body.entity, __func__);
    }
    pl_target_forget(world, row);
    b->vx[row] = pl_poses(world)[row].vx = velocity.x;
    b->vy[row] = pl_poses(world)[row].vy = velocity.y;
    b->residual_vx[row] =
        other_x ? 0 : b->residual_vx[row]; // what stays as it is keeps its last digits
    b->residual_vy[row] = other_y ? 0 : b->residual_vy[row];
    return PLUMB_OK;
}

plumb_result plumb_body_set_angular_velocity(plumb_world *world, plumb_body body, plumb_real w)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    PL_TRY(pl_check_finite(world, __func__, "w", w));
    PL_TRY(check_movable(world, __func__, row));
    if (w != 0 && (world->bodies.flags[row] & PL_BODY_FIXED_ROTATION)) {
        return pl_fail(world, PLUMB_E_STATE, __func__,
                       "w is %g; it must be 0 for a body of fixed rotation", (double)w);
    }
    if (w != world->bodies.w[row]) {
        pl_sleep_stir(world, row);
        pl_told(world, body.entity, __func__);
    }
    pl_target_forget(world, row);
    world->bodies.w[row] = w;
    return PLUMB_OK;
}

//---- mass ----------------------------------------------------------------------------------------

plumb_result pl_check_dynamic(const plumb_world *world, const char *fn, plumb_body body,
                              uint32_t *row)
{
    PL_TRY(pl_check_body(world, fn, body, row));
    const uint8_t type = world->bodies.type[*row];
    return type == PLUMB_DYNAMIC
               ? PLUMB_OK
               : pl_fail(world, PLUMB_E_STATE, fn, "body is %s; it must be dynamic",
                         type == PLUMB_STATIC ? "static" : "kinematic");
}

plumb_result plumb_body_set_mass(plumb_world *world, plumb_body body, plumb_real mass)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    PL_TRY(pl_check_range(world, __func__, "mass", mass, PL_MASS_LEAST, PL_MASS_MOST));
    PL_TRY(pl_check_dynamic(world, __func__, body, &row));
    pl_bodies *b = &world->bodies;
    if (mass == b->set_mass[row]) {
        return PLUMB_OK;
    }
    double ratio = (double)mass / (double)b->mass[row];
    double inertia = (double)b->set_inertia[row] * ratio;
    pl_mass_sum sum = pl_mass_of_shapes(world, row);
    pl_body_mass made;
    bool given = b->set_inertia[row] > 0;
    real set_inertia = (real)plumb_min((real)inertia, PLUMB_REAL_MAX);
    if (!pl_mass_resolve(&sum, mass, given ? set_inertia : 0, &made) ||
        (given && inertia < (double)PL_MASS_LEAST)) {
        return pl_fail(world, PLUMB_E_RANGE, __func__,
                       "mass is %g; the inertia that follows must be %g to %g", (double)mass,
                       (double)PL_MASS_LEAST, (double)PL_MASS_MOST);
    }
    pl_sleep_disturb(world, row);
    b->set_mass[row] = mass;
    b->set_inertia[row] = given ? made.inertia : 0;
    pl_mass_apply(world, row, &made);
    pl_told(world, body.entity, __func__);
    return PLUMB_OK;
}

plumb_result plumb_body_reset_mass(plumb_world *world, plumb_body body)
{
    uint32_t row;
    PL_TRY(pl_check_dynamic(world, __func__, body, &row));
    pl_bodies *b = &world->bodies;
    pl_pieces *pieces = &world->pieces;
    bool as_it_was = b->set_mass[row] == 0 && b->set_inertia[row] == 0 &&
                     (b->flags[row] & PL_BODY_OWN_CENTER) == 0;
    for (uint32_t p = b->first_piece[row]; p != PL_NONE; p = pieces->next_in_body[p]) {
        const real density = pl_density_of(world, p);
        as_it_was &= pieces->density[p] == density;
        pieces->density[p] = density;
    }
    if (as_it_was) {
        return PLUMB_OK;
    }
    pl_sleep_disturb(world, row);
    b->set_mass[row] = 0;
    b->set_inertia[row] = 0;
    b->flags[row] &= (uint16_t)~PL_BODY_OWN_CENTER;
    pl_mass_revise(world, row);
    pl_told(world, body.entity, __func__);
    return PLUMB_OK;
}

plumb_result plumb_body_set_fixed_rotation(plumb_world *world, plumb_body body, bool fixed)
{
    uint32_t row;
    PL_TRY(pl_check_dynamic(world, __func__, body, &row));
    pl_bodies *b = &world->bodies;
    if (fixed != ((b->flags[row] & PL_BODY_FIXED_ROTATION) != 0)) {
        pl_sleep_disturb(world, row);
    }
    b->flags[row] = fixed ? b->flags[row] | PL_BODY_FIXED_ROTATION
                          : b->flags[row] & (uint16_t)~PL_BODY_FIXED_ROTATION;
    if (fixed) {
        b->w[row] = 0;
    }
    pl_mass_revise(world, row);
    pl_told(world, body.entity, __func__);
    return PLUMB_OK;
}

plumb_result plumb_body_set_continuous(plumb_world *world, plumb_body body, bool continuous)
{
    uint32_t row;
    PL_TRY(pl_check_dynamic(world, __func__, body, &row));
    set_continuous(world, row, continuous);
    pl_told(world, body.entity, __func__);
    return PLUMB_OK;
}

//---- the rest ------------------------------------------------------------------------------------

plumb_result plumb_body_set_user_data(plumb_world *world, plumb_body body, void *user_data)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, __func__, body, &row));
    world->bodies.user_data[row] = user_data;
    return PLUMB_OK;
}
