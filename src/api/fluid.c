// fluid.c - what flows at a place.
#include "plumb/query.h"

#include "effects/fluid.h"
#include "query/query.h"
#include "world/check.h"
#include "world/rows.h"
#include "world/wrap.h"

// Volumes at one place that are looked at.
#define VOLUMES_MOST 64

static bool accept_fluid(void *context, plumb_shape shape)
{
    const plumb_world *world = context;
    const uint32_t piece = pl_shape_piece(world, shape);
    return piece != PL_NONE && (world->pieces.flags[piece] & PL_PIECE_SENSOR) != 0 &&
           world->materials.fluid[world->pieces.material[piece]];
}

static plumb_vec2 velocity_in(const plumb_world *world, uint32_t piece, plumb_vec2 position)
{
    pl_volume volume;
    pl_fluid_volume(world, piece, &volume);
    const uint32_t row = world->pieces.body[piece];
    const pl_shift arm = pl_wrap_arm(world, row, (double)position.x, (double)position.y);
    const double from[2] = { arm.x, arm.y };
    double out[2];
    pl_fluid_velocity(world, &volume, (double)position.x, (double)position.y, from, 0, out);
    return (plumb_vec2){ (real)out[0], (real)out[1] };
}

plumb_fluid_sample plumb_fluid_at(plumb_world *world, plumb_vec2 position)
{
    plumb_fluid_sample out = { .density = 0 };
    const plumb_query_filter filter = { .sensors = true, .accept = accept_fluid, .context = world };
    plumb_shape shapes[VOLUMES_MOST];
    if (world == NULL ||
        pl_check_within(world, __func__, "position", position, PL_QUERY_LIMIT) != PLUMB_OK) {
        return out;
    }
    int count = plumb_world_overlap_point(world, position, &filter, shapes, VOLUMES_MOST);
    count = count < VOLUMES_MOST ? count : VOLUMES_MOST;
    uint32_t densest = PL_NONE;
    for (int i = 0; i < count; ++i) {
        const uint32_t piece = pl_shape_piece(world, shapes[i]);
        const plumb_real density = world->materials.density[world->pieces.material[piece]];
        if (density > out.density) {
            out.density = density;
            out.shape = shapes[i];
            densest = piece;
        }
    }
    if (densest != PL_NONE) {
        out.velocity = velocity_in(world, densest, plumb_world_wrapped(world, position));
    }
    return out;
}
