// character.c - characters are made, told what to do, and asked.
//
// They lie in one array without order; a column of the bodies says where. Reads: arguments.
// Writes: the array, the column. Cost: O(1).
#include "character/character.h"
#include "narrow/surface.h"
#include "plumb/math.h"
#include "query/query.h"
#include "world/check.h"
#include "world/desc_list.h"
#include "world/destroy.h"
#include "world/told.h"

#include <string.h>

#define SLOPE_MOST ((real)1.5) // [rad]
#define SPEED_MOST ((real)1e6) // [m/s]
#define LIMIT      PLUMB_LENGTH_MAX

//---- lookup --------------------------------------------------------------------------------------

static plumb_result find(const plumb_world *world, const char *function, plumb_body body,
                         pl_character **c)
{
    uint32_t row;
    *c = NULL;
    PL_TRY(pl_check_body(world, function, body, &row));
    *c = pl_character_of(world, row);
    return *c != NULL
               ? PLUMB_OK
               : pl_fail(world, PLUMB_E_HANDLE, function,
                         "body is no character; it must be made one with plumb_character_create");
}

bool plumb_body_is_character(const plumb_world *world, plumb_body body)
{
    uint32_t row = pl_ask_body(world, __func__, body);
    return row != PL_NONE && world->bodies.character[row] != 0;
}

//---- settings ------------------------------------------------------------------------------------

static plumb_result check_numbers(const plumb_world *world, const char *fn,
                                  const plumb_character_desc *d)
{
    const struct {
        const char *name;
        real value, high;
    } fields[] = {
        { "max_slope", d->max_slope, SLOPE_MOST },
        { "skin", d->skin, LIMIT },
        { "step_height", d->step_height, LIMIT },
        { "step_width", d->step_width, LIMIT },
        { "snap_distance", d->snap_distance, LIMIT },
        { "acceleration", d->acceleration, PLUMB_REAL_MAX },
        { "air_acceleration", d->air_acceleration, PLUMB_REAL_MAX },
        { "max_fall_speed", d->max_fall_speed, PLUMB_REAL_MAX },
        { "mass", d->mass, PLUMB_REAL_MAX },
        { "push_force", d->push_force, PLUMB_REAL_MAX },
    };
    PL_TRY(pl_check_finite_vec(world, fn, "up", d->up));
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i) {
        PL_TRY(pl_check_range(world, fn, fields[i].name, fields[i].value, 0, fields[i].high));
    }
    return PLUMB_OK;
}

// What has no effect is refused, so that nobody waits for it.
static plumb_result check_unused(const plumb_world *world, const char *fn, bool is_dynamic,
                                 const plumb_character_desc *d)
{
    const struct {
        const char *name, *why;
        bool given;
    } fields[] = {
        { "skin", "for a dynamic character", is_dynamic && d->skin != 0 },
        { "step_height", "for a dynamic character", is_dynamic && d->step_height != 0 },
        { "step_width", "for a dynamic character", is_dynamic && d->step_width != 0 },
        { "snap_distance", "for a dynamic character", is_dynamic && d->snap_distance != 0 },
        { "max_fall_speed", "for a dynamic character", is_dynamic && d->max_fall_speed != 0 },
        { "mass", "for a dynamic character", is_dynamic && d->mass != 0 },
        { "push_force", "for a dynamic character", is_dynamic && d->push_force != 0 },
        { "no_steps", "for a dynamic character", is_dynamic && d->no_steps },
        { "no_snap", "for a dynamic character", is_dynamic && d->no_snap },
        { "no_push", "for a dynamic character", is_dynamic && d->no_push },
        { "step_height", "with no_steps", d->no_steps && d->step_height != 0 },
        { "step_width", "with no_steps", d->no_steps && d->step_width != 0 },
        { "snap_distance", "with no_snap", d->no_snap && d->snap_distance != 0 },
        { "push_force", "with no_push", d->no_push && d->push_force != 0 },
        { "air_acceleration", "with no_air_control",
          d->no_air_control && d->air_acceleration != 0 },
    };
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i) {
        if (fields[i].given) {
            return pl_fail(world, PLUMB_E_RANGE, fn, "%s is set; it must be 0 %s", fields[i].name,
                           fields[i].why);
        }
    }
    return PLUMB_OK;
}

static plumb_result check_desc(const plumb_world *world, const char *fn, uint32_t row,
                               const plumb_character_desc *d)
{
    PL_TRY(PL_CHECK_HAS(world, fn, "a character", CHARACTERS, "characters"));
    PL_TRY(check_numbers(world, fn, d));
    bool is_dynamic = world->bodies.type[row] == PLUMB_DYNAMIC;
    return check_unused(world, fn, is_dynamic, d);
}

//---- create, destroy -----------------------------------------------------------------------------

static plumb_result check_body(const plumb_world *world, const char *fn, plumb_body body,
                               uint32_t *row)
{
    PL_TRY(pl_check_body(world, fn, body, row));
    PL_TRY(pl_check_unlocked(world, fn));
    if (world->bodies.type[*row] == PLUMB_STATIC) {
        return pl_fail(world, PLUMB_E_STATE, fn, "body is static; it must be kinematic or dynamic");
    }
    if (world->bodies.character[*row] != 0) {
        return pl_fail(world, PLUMB_E_STATE, fn, "body is a character; it must not be one already");
    }
    return PLUMB_OK;
}

static void copy_desc(plumb_character_desc *to,
                      const plumb_character_desc *from){ PL_CHARACTER_DESC(PL_COPY_MEMBER) }

plumb_result
    plumb_character_create(plumb_world *world, plumb_body body, const plumb_character_desc *desc)
{
    const plumb_character_desc zero = { 0 };
    uint32_t row;
    desc = desc == NULL ? &zero : desc;
    PL_TRY(check_body(world, __func__, body, &row));
    PL_TRY(check_desc(world, __func__, row, desc));
    pl_characters *all = &world->characters;
    if (!pl_buffer_reserve(&world->memory, &all->items,
                           ((size_t)all->count + 1) * sizeof(pl_character))) {
        return pl_fail_memory(world, __func__);
    }
    const pl_bodies *b = &world->bodies;
    pl_character *made = &pl_character_items(all)[all->count];
    memset(made, 0, sizeof *made); // padding, too: it is saved
    made->body = body;
    copy_desc(&made->desc, desc);
    made->velocity = plumb_v2(b->vx[row], b->vy[row]);
    world->bodies.character[row] = ++all->count;
    if (b->type[row] == PLUMB_DYNAMIC) {
        plumb_body_set_fixed_rotation(world, body, true);
    }
    world->schedule_dirty = true;
    return PLUMB_OK;
}

plumb_result plumb_character_destroy(plumb_world *world, plumb_body body)
{
    pl_character *c;
    PL_TRY(find(world, __func__, body, &c));
    PL_TRY(pl_check_unlocked(world, __func__));
    pl_character_forget(world, pl_body_row(world, body));
    return PLUMB_OK;
}

void pl_characters_free(pl_memory *memory, pl_characters *all)
{
    pl_buffer_free(memory, &all->items);
    pl_buffer_free(memory, &all->saved);
    pl_buffer_free(memory, &all->obstacles);
    pl_buffer_free(memory, &all->near);
    pl_buffer_free(memory, &all->pushes);
}

plumb_result plumb_character_settings(const plumb_world *world, plumb_body body,
                                      plumb_character_desc *desc)
{
    pl_character *c;
    PL_TRY(find(world, __func__, body, &c));
    PL_TRY(pl_check_pointer(world, __func__, "desc", desc));
    *desc = c->desc;
    return PLUMB_OK;
}

plumb_result plumb_character_set(plumb_world *world, plumb_body body,
                                 const plumb_character_desc *desc)
{
    const plumb_character_desc zero = { 0 };
    pl_character *c;
    PL_TRY(find(world, __func__, body, &c));
    desc = desc == NULL ? &zero : desc;
    PL_TRY(check_desc(world, __func__, pl_body_row(world, body), desc));
    copy_desc(&c->desc, desc);
    return PLUMB_OK;
}

//---- orders --------------------------------------------------------------------------------------

plumb_result plumb_character_walk(plumb_world *world, plumb_body body, plumb_real speed)
{
    pl_character *c;
    PL_TRY(find(world, __func__, body, &c));
    PL_TRY(pl_check_range(world, __func__, "speed", speed, -SPEED_MOST, SPEED_MOST));
    c->walk = pl_rightward(world, speed);
    c->flies = false;
    pl_told(world, body.entity, __func__);
    return PLUMB_OK;
}

plumb_result plumb_character_fly(plumb_world *world, plumb_body body, plumb_vec2 velocity)
{
    pl_character *c;
    PL_TRY(find(world, __func__, body, &c));
    PL_TRY(pl_check_within(world, __func__, "velocity", velocity, SPEED_MOST));
    c->fly = velocity;
    c->flies = true;
    pl_told(world, body.entity, __func__);
    return PLUMB_OK;
}

bool plumb_character_jump(plumb_world *world, plumb_body body, plumb_real speed)
{
    pl_character *c;
    plumb_result r = find(world, __func__, body, &c);
    r = r != PLUMB_OK ? r : pl_check_range(world, __func__, "speed", speed, 0, SPEED_MOST);
    if (r == PLUMB_OK && !(speed > 0)) {
        r = pl_fail(world, PLUMB_E_RANGE, __func__, "speed is %g; it must be above 0",
                    (double)speed);
    }
    if (r != PLUMB_OK || !c->on_ground || c->flies) {
        return false;
    }
    c->jump = speed;
    pl_told(world, body.entity, __func__);
    return true;
}

plumb_result plumb_character_set_velocity(plumb_world *world, plumb_body body, plumb_vec2 velocity)
{
    pl_character *c;
    PL_TRY(find(world, __func__, body, &c));
    PL_TRY(pl_check_within(world, __func__, "velocity", velocity, SPEED_MOST));
    if (world->bodies.type[pl_body_row(world, body)] == PLUMB_DYNAMIC) {
        return plumb_body_set_velocity(world, body, velocity);
    }
    c->velocity = velocity;
    c->thrown = true;
    pl_told(world, body.entity, __func__);
    return PLUMB_OK;
}

bool plumb_character_drop(plumb_world *world, plumb_body body)
{
    pl_character *c;
    if (find(world, __func__, body, &c) != PLUMB_OK || !c->on_ground) {
        return false;
    }
    uint32_t piece = pl_shape_piece(world, c->ground.shape);
    if (piece == PL_NONE || (world->pieces.flags[piece] & PL_PIECE_ONE_WAY) == 0) {
        return false;
    }
    if (world->bodies.type[pl_body_row(world, body)] == PLUMB_DYNAMIC) {
        return plumb_body_drop_through(world, body) == PLUMB_OK;
    }
    if (c->passing_count == PL_CHARACTER_PASSING) {
        return false;
    }
    c->passing[c->passing_count++] = (pl_passing){ c->ground.shape, true };
    c->on_ground = c->climbs = false;
    c->ground = (pl_ground){ 0 };
    return true;
}

//---- getters -------------------------------------------------------------------------------------

plumb_result plumb_character_get(const plumb_world *world, plumb_body body,
                                 plumb_character_state *state)
{
    pl_character *c;
    PL_TRY(find(world, __func__, body, &c));
    PL_TRY(pl_check_pointer(world, __func__, "state", state));
    uint32_t row = pl_body_row(world, body);
    bool is_dynamic = world->bodies.type[row] == PLUMB_DYNAMIC;
    const pl_ground *g = &c->ground;
    *state = (plumb_character_state){
        .velocity = is_dynamic ? plumb_body_velocity(world, body) : c->velocity,
        .up = pl_character_up(world, c, row),
        .on_ground = c->on_ground,
        .on_slope = c->on_slope,
        .at_wall = c->at_wall,
        .at_ceiling = c->at_ceiling,
        .crushed = c->crushed,
        .air_time = c->air_time,
        .ground_body = g->body,
        .ground_shape = g->shape,
        .ground_point = g->point,
        .ground_normal = g->normal,
        .ground_velocity = g->velocity,
        .ground_spin = g->spin,
    };
    return PLUMB_OK;
}

int plumb_character_hits(const plumb_world *world, plumb_body body, plumb_character_hit *hits,
                         int capacity)
{
    pl_character *c;
    if (find(world, __func__, body, &c) != PLUMB_OK ||
        pl_query_check_output(world, __func__, "hits", hits, capacity) != PLUMB_OK) {
        return -1;
    }
    for (int i = 0; i < c->hit_count && i < capacity; ++i) {
        hits[i] = c->hits[i];
    }
    return c->hit_count;
}
