// liquid_ask.c - the world's liquid, asked: what is at a place, what a ray meets, whom it touched.
//
// Reads: particles, contacts of the last step. Writes: the index of particles. Cost: src/liquid/sample.c.
#include "api/listed.h"
#include "liquid/sample.h"
#include "plumb/liquid.h"
#include "world/check.h"
#include "world/state.h"

#include <math.h>

// A world with a liquid whose particles are filed.
static plumb_result open_liquid(plumb_world *world, const char *fn)
{
    PL_TRY(pl_check_world(world));
    if (world->liquid.settings_count == 0) {
        return pl_fail(world, PLUMB_E_STATE, fn,
                       "the world has no liquid; it must be made with plumb_liquid_create");
    }
    return pl_liquid_file(world) ? PLUMB_OK : pl_fail_memory(world, fn);
}

static plumb_vec2 velocity_of(const pl_liquid_fill *f)
{
    return (plumb_vec2){ pl_held(f->vx), pl_held(f->vy) };
}

plumb_liquid_sample plumb_liquid_at(plumb_world *world, plumb_vec2 position)
{
    if (pl_check_world(world) != PLUMB_OK ||
        pl_check_finite_vec(world, __func__, "position", position) != PLUMB_OK ||
        open_liquid(world, __func__) != PLUMB_OK) {
        return (plumb_liquid_sample){ 0 };
    }
    const pl_liquid_fill f =
        pl_liquid_fill_at(&world->liquid, (double)position.x, (double)position.y);
    return (plumb_liquid_sample){ .fill = pl_held(f.fill),
                                  .velocity = velocity_of(&f),
                                  .phase = f.phase };
}

// Out of the liquid: to where fill falls.
static plumb_vec2 normal_of(const pl_liquid_fill *f)
{
    const double length = sqrt(f->rise_x * f->rise_x + f->rise_y * f->rise_y);
    return length > 0 ? (plumb_vec2){ (real)(-f->rise_x / length), (real)(-f->rise_y / length) }
                      : (plumb_vec2){ 0, 0 };
}

bool plumb_liquid_ray(plumb_world *world, plumb_vec2 from, plumb_vec2 to, plumb_liquid_hit *hit)
{
    if (pl_check_world(world) != PLUMB_OK ||
        pl_check_pointer(world, __func__, "hit", hit) != PLUMB_OK ||
        pl_check_finite_vec(world, __func__, "from", from) != PLUMB_OK ||
        pl_check_finite_vec(world, __func__, "to", to) != PLUMB_OK ||
        open_liquid(world, __func__) != PLUMB_OK) {
        return false;
    }
    const double x = (double)from.x, y = (double)from.y;
    const double way_x = (double)to.x - x, way_y = (double)to.y - y;
    const double length = sqrt(way_x * way_x + way_y * way_y);
    const double dx = length > 0 ? way_x / length : 0, dy = length > 0 ? way_y / length : 0;
    const double at = pl_liquid_ray_to_surface(&world->liquid, x, y, dx, dy, length);
    if (!(at >= 0 && at <= length)) {
        return false;
    }
    const pl_liquid_fill f = pl_liquid_fill_at(&world->liquid, x + dx * at, y + dy * at);
    *hit = (plumb_liquid_hit){
        .point = at > 0 ? (plumb_vec2){ (real)(x + dx * at), (real)(y + dy * at) } : from,
        .normal = at > 0 ? normal_of(&f) : (plumb_vec2){ 0, 0 },
        .fraction = length > 0 ? (real)(at / length) : 0,
        .velocity = velocity_of(&f),
        .phase = f.phase,
    };
    return true;
}

PL_LISTED(plumb_liquid_contact, plumb_liquid_contacts, world->liquid.contacts.data,
          world->liquid.contact_count)

PL_LISTED(plumb_liquid_end, plumb_liquid_ends, world->liquid.ends.data, world->liquid.end_count)
