// command_fracture.c - commands that cut, shatter, merge and scale bodies.
//
// The body may come to life, move, or get its shapes after the command was given: what depends on these is found when it is
// carried out, and it is dropped then. The parts are told as an event: how many there are nobody knows before.
//
// Reads, writes: the buffer; then what fracture.c and merge.c do. Cost: O(1) to give, as the direct call to carry out.
#include "api/command.h"

#include "api/fracture.h"
#include "world/check.h"
#include "world/rows.h"

#include <math.h>
#include <string.h>

// What lies behind the headers, without padding.
typedef struct cut {
    double along_x, along_y;
} cut;

typedef struct shatter {
    double even, min_share;
    uint64_t seed;
    int64_t cells;
} shatter;

//---- giving --------------------------------------------------------------------------------------

plumb_result plumb_command_body_cut(plumb_world *world, plumb_body body, plumb_vec2 point,
                                    plumb_vec2 along)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(pl_command_check_body(world, __func__, "body", body));
    PL_TRY(pl_cut_check(world, __func__, point, along));
    const pl_command r = {
        .kind = PL_COMMAND_CUT, .target = body.entity, .x = (double)point.x, .y = (double)point.y
    };
    const cut more = { (double)along.x, (double)along.y };
    return pl_command_give(world, __func__, r, &more, sizeof more);
}

plumb_result plumb_command_body_shatter(plumb_world *world, plumb_body body,
                                        const plumb_shatter_desc *desc)
{
    const plumb_shatter_desc none = { 0 };
    desc = desc != NULL ? desc : &none;
    PL_TRY(pl_check_world(world));
    PL_TRY(pl_command_check_body(world, __func__, "body", body));
    PL_TRY(pl_shatter_check(world, __func__, desc));
    const pl_command r = { .kind = PL_COMMAND_SHATTER,
                           .target = body.entity,
                           .x = (double)desc->point.x,
                           .y = (double)desc->point.y };
    const shatter more = { (double)desc->even, (double)desc->min_share, desc->seed, desc->cells };
    return pl_command_give(world, __func__, r, &more, sizeof more);
}

plumb_result plumb_command_body_merge(plumb_world *world, plumb_body body, plumb_body other)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(pl_command_check_body(world, __func__, "body", body));
    PL_TRY(pl_command_check_body(world, __func__, "other", other));
    if (plumb_same(body, other)) {
        return pl_fail(world, PLUMB_E_HANDLE, __func__, "other is body; it must be another");
    }
    const pl_command r = { .kind = PL_COMMAND_MERGE, .target = body.entity, .body = other };
    return pl_command_give(world, __func__, r, NULL, 0);
}

plumb_result plumb_command_body_scale(plumb_world *world, plumb_body body, plumb_real factor)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(pl_command_check_body(world, __func__, "body", body));
    PL_TRY(pl_scale_check(world, __func__, factor));
    const pl_command r = { .kind = PL_COMMAND_SCALE, .target = body.entity, .x = (double)factor };
    return pl_command_give(world, __func__, r, NULL, 0);
}

//---- carrying out --------------------------------------------------------------------------------

static plumb_vec2 point_of(const pl_command *r)
{
    return plumb_v2((plumb_real)r->x, (plumb_real)r->y);
}

static plumb_vec2 along_of(const char *payload)
{
    cut more;
    memcpy(&more, payload, sizeof more);
    return plumb_v2((plumb_real)more.along_x, (plumb_real)more.along_y);
}

static plumb_shatter_desc shatter_of(const pl_command *r, const char *payload)
{
    shatter more;
    memcpy(&more, payload, sizeof more);
    return (plumb_shatter_desc){ .point = point_of(r),
                                 .cells = (int)more.cells,
                                 .even = (plumb_real)more.even,
                                 .min_share = (plumb_real)more.min_share,
                                 .seed = more.seed };
}

// Refused for what time has made of it: no error, the world went on.
static plumb_result dropped(plumb_world *world, const pl_command *r, plumb_result result,
                            const char *why)
{
    if (result == PLUMB_OK || result == PLUMB_E_MEMORY) {
        return result;
    }
    pl_command_drop(world, r, why);
    return PLUMB_OK;
}

// The left side of the line of a cut: events have a unit normal.
static plumb_vec2 normal_of(plumb_vec2 along)
{
    double way[2];
    const double length = pl_cut_way(along, way);
    return plumb_v2((plumb_real)(-way[1] / length), (plumb_real)(way[0] / length));
}

static plumb_result run_division(plumb_world *world, const pl_command *r, const char *payload)
{
    const char *fn = pl_command_name(r);
    const plumb_body body = { r->target };
    if (!pl_is_divisible(world, pl_body_row(world, body))) {
        pl_command_drop(world, r, "it has no shape with an area");
        return PLUMB_OK;
    }
    if (!pl_break_reserve(world)) {
        return pl_fail_memory(world, fn);
    }
    plumb_body_break event = { .body = body, .point = point_of(r) };
    plumb_result result;
    int count;
    if (r->kind == PL_COMMAND_CUT) {
        const plumb_vec2 along = along_of(payload);
        event.normal = normal_of(along);
        result = pl_cut(world, fn, body, event.point, along, true, &count);
    } else {
        const plumb_shatter_desc desc = shatter_of(r, payload);
        result = pl_shatter(world, fn, body, &desc, true, &count);
    }
    if (count > 0) {
        pl_break_tell(world, event);
    }
    return dropped(world, r, result, "a part of it would have no mass");
}

static plumb_result run_merge(plumb_world *world, const pl_command *r)
{
    if (pl_body_row(world, r->body) == PL_NONE) {
        pl_command_drop(world, r, "the other is gone");
        return PLUMB_OK;
    }
    return dropped(world, r,
                   pl_merge(world, pl_command_name(r), (plumb_body){ r->target }, r->body, NULL),
                   "the other is too far away, or both too heavy");
}

plumb_result pl_command_fracture_run(plumb_world *world, const pl_command *r, const char *payload)
{
    const plumb_body body = { r->target };
    if (r->kind == PL_COMMAND_MERGE) {
        return run_merge(world, r);
    }
    if (r->kind == PL_COMMAND_SCALE) {
        return dropped(world, r, pl_scale(world, pl_command_name(r), body, (plumb_real)r->x),
                       "a length or mass of it would leave its range");
    }
    return run_division(world, r, payload);
}

//---- saved ---------------------------------------------------------------------------------------

size_t pl_command_fracture_payload(const pl_command *r)
{
    return r->kind == PL_COMMAND_CUT       ? sizeof(cut)
           : r->kind == PL_COMMAND_SHATTER ? sizeof(shatter)
                                           : 0;
}

static bool is_real(double value)
{
    return fabs(value) <= (double)PLUMB_REAL_MAX;
}

bool pl_command_fracture_is_sound(const pl_command *r, const char *payload)
{
    if (!is_real(r->x) || !is_real(r->y)) {
        return false;
    }
    if (r->kind == PL_COMMAND_MERGE) {
        return !plumb_same((plumb_body){ r->target }, r->body);
    }
    if (r->kind == PL_COMMAND_SCALE) {
        return pl_scale_check(NULL, "", (plumb_real)r->x) == PLUMB_OK;
    }
    if (r->kind == PL_COMMAND_CUT) {
        cut more;
        memcpy(&more, payload, sizeof more);
        return is_real(more.along_x) && is_real(more.along_y) &&
               pl_cut_check(NULL, "", point_of(r), along_of(payload)) == PLUMB_OK;
    }
    shatter more;
    memcpy(&more, payload, sizeof more);
    if (!is_real(more.even) || !is_real(more.min_share) || more.cells != (int)more.cells) {
        return false;
    }
    const plumb_shatter_desc desc = shatter_of(r, payload);
    return pl_shatter_check(NULL, "", &desc) == PLUMB_OK;
}
