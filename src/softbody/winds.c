// winds.c - the flow about nodes: what is dragged is dragged against it.
//
// A volume of fluid is a sensor of a fluid material (effects/fluid.h), be it wind or water. A node has the flow of the one that its place
// is in, of several that of the densest, and the velocity of the body that holds the volume. Within a step volumes move along, but do not
// turn; the flow is that of the middle of each substep, as gusts go by.
//
// Reads: pieces, materials, points. Writes: volumes of the step, winds of points. Cost: once a step O(pieces) where some soft body
// has drag; a substep nodes times volumes.
#include "effects/fluid.h"
#include "softbody/softbody.h"
#include "world/rows.h"

// A volume, and which soft bodies meet it is asked by its filter.
typedef struct wind {
    pl_volume volume;
    plumb_filter filter;
    double density;
    double x, y, vx, vy; // [m], [m/s] of the centre of the body that holds it, as the step begins
} wind;

static bool any_is_dragged(const pl_softbodies *all)
{
    bool any = false;
    for (uint32_t i = 0; i < all->count; ++i) {
        any |= pl_softbody_items(all)[i].damping > 0 && !pl_softbody_items(all)[i].asleep;
    }
    return any;
}

static void see_wind(const plumb_world *world, uint32_t row, uint32_t piece, wind *out)
{
    const pl_bodies *b = &world->bodies;
    const pl_pieces *p = &world->pieces;
    pl_fluid_volume(world, piece, &out->volume);
    out->filter =
        (plumb_filter){ p->category[piece], p->mask[piece], p->group[piece], p->mask[piece] == 0 };
    out->density = (double)world->materials.density[p->material[piece]];
    out->x = (double)b->center_x[row] + (double)b->residual_x[row];
    out->y = (double)b->center_y[row] + (double)b->residual_y[row];
    out->vx = (double)b->vx[row];
    out->vy = (double)b->vy[row];
}

bool pl_soft_find_winds(plumb_world *world)
{
    pl_soft_step *s = world->softbodies.step;
    const pl_pieces *p = &world->pieces;
    const uint32_t rows = pl_partition_first(world, PL_PART_DISABLED);
    s->wind_count = 0;
    if (world->sensor_pieces == 0 || !any_is_dragged(&world->softbodies)) {
        return true;
    }
    for (uint32_t row = 0; row < rows; ++row) {
        for (uint32_t i = world->bodies.first_piece[row]; i != PL_NONE; i = p->next_in_body[i]) {
            if ((p->flags[i] & PL_PIECE_SENSOR) == 0 || !world->materials.fluid[p->material[i]]) {
                continue;
            }
            if (!pl_buffer_reserve(&world->memory, &s->winds, (s->wind_count + 1) * sizeof(wind))) {
                return false;
            }
            see_wind(world, row, i, (wind *)s->winds.data + s->wind_count++);
        }
    }
    return true;
}

static bool is_in(const pl_volume *v, double x, double y)
{
    bool in = true;
    for (int i = 0; i < v->plane_count; ++i) {
        in &= v->planes[i].nx * x + v->planes[i].ny * y <= v->planes[i].d;
    }
    return in;
}

static void feel(const plumb_world *world, const plumb_filter *filter, pl_soft_point *p,
                 double since)
{
    const pl_soft_step *s = world->softbodies.step;
    const wind *winds = s->winds.data;
    double densest = 0;
    p->wind_x = p->wind_y = 0;
    for (uint32_t i = 0; i < s->wind_count; ++i) {
        const wind *w = &winds[i];
        const double x = p->x - (w->x + since * w->vx), y = p->y - (w->y + since * w->vy);
        if (w->density <= densest || !is_in(&w->volume, x, y) ||
            !plumb_filters_meet(w->filter, *filter)) {
            continue;
        }
        const double from[2] = { x, y };
        double flow[2];
        pl_fluid_velocity(world, &w->volume, p->x, p->y, from, since, flow);
        densest = w->density;
        p->wind_x = flow[0];
        p->wind_y = flow[1];
    }
}

void pl_soft_feel_winds(const plumb_world *world, double since)
{
    const pl_softbodies *all = &world->softbodies;
    uint32_t first = 0;
    for (uint32_t i = 0; i < all->count && all->step->wind_count > 0; ++i) {
        const pl_softbody *item = &pl_softbody_items(all)[i];
        const uint32_t count = item->asleep ? 0 : item->nodes;
        for (uint32_t k = first; k < first + count && item->damping > 0; ++k) {
            feel(world, &item->filter, (pl_soft_point *)all->step->points.data + k, since);
        }
        first += count;
    }
}
