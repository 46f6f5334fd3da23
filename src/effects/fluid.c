// fluid.c - who is in which volume of fluid, and the mass that it lends them.
//
// A volume is a sensor of a fluid material: the broad phase finds what is near it, with all other sensors
// (event/sensor_events.c). A fluid that is pushed aside moves along: the solver has a body with so much more mass, in
// contacts too. It is taken as the step begins, the same along all axes, and turns nothing. So what floats is no lighter than
// what it displaces, whatever it weighs.
//
// Reads: candidates of sensors, pieces, materials, poses. Writes: lists, masses of solver bodies. Order: behind the sensors'
// candidates; behind the graph. Cost: O(candidates), O(edges) a piece in a volume.
#include "effects/fluid.h"
#include "effects/waves.h"

#include "core/fill.h"
#include "core/sort.h"
#include "schema/passes.h"
#include "world/island.h"
#include "world/rows.h"
#include "world/wrap.h"
#include "math/trig.h"

#include <math.h>

bool pl_want_fluids(const plumb_world *world, const char **reason)
{
    const pl_materials *m = &world->materials;
    bool wanted = false;
    for (uint32_t row = 0; row < m->table.count && world->sensor_pieces > 0; ++row) {
        wanted |= m->fluid[row] && m->users[row] > 0;
    }
    wanted &= world->dynamic_count > 0 || world->waves.count > 0;
    *reason = wanted ? "some sensor is of a fluid" : "no sensor is of a fluid that could act";
    return wanted;
}

bool pl_fluid_acts_on(const plumb_world *world, uint32_t row)
{
    return ((const uint8_t *)world->effects.swims.data)[row] != 0;
}

//---- who is near ---------------------------------------------------------------------------------

// What sleeps in a volume that moves wakes.
static void heed(plumb_world *world, uint32_t sensor, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    const uint32_t holder = world->pieces.body[sensor];
    const bool moves = b->vx[holder] != 0 || b->vy[holder] != 0 || b->w[holder] != 0;
    if (moves && pl_row_is_asleep(world, row)) {
        pl_sleep_disturb(world, row);
    }
}

bool pl_fluid_is_restless(const plumb_world *world, uint32_t piece)
{
    const uint32_t of = world->pieces.material[piece];
    return world->materials.gust[of] > 0 || world->materials.eddies[of] > 0 ||
           ((world->pieces.flags[piece] & PL_PIECE_WAVES) != 0 &&
            pl_waves_are_lively(world, piece));
}

static bool is_volume(const plumb_world *world, uint32_t piece)
{
    return world->materials.fluid[world->pieces.material[piece]];
}

void pl_fluid_volume(const plumb_world *world, uint32_t piece, pl_volume *v)
{
    plumb_convex shape;
    const pl_bodies *b = &world->bodies;
    const uint32_t row = world->pieces.body[piece];
    const plumb_vec2 g = world->gravity, up = pl_world_up(world);
    const double pull = sqrt((double)g.x * (double)g.x + (double)g.y * (double)g.y);
    pl_piece_convex(world, piece, &shape);
    const plumb_transform frame = { { -(b->c[row] * b->local_x[row] - b->s[row] * b->local_y[row]),
                                      -(b->s[row] * b->local_x[row] +
                                        b->c[row] * b->local_y[row]) },
                                    { b->c[row], b->s[row] } };
    v->piece = piece;
    v->material = world->pieces.material[piece];
    v->origin_x = (double)frame.p.x;
    v->origin_y = (double)frame.p.y;
    v->grain = pl_local_grain(world, v->material);
    v->plane_count = pl_half_planes_of(&shape, frame, 0, 0, v->planes);
    v->up_x = pull > 0 ? -(double)g.x / pull : (double)up.x;
    v->up_y = pull > 0 ? -(double)g.y / pull : (double)up.y;
    v->top = -1;
    for (int i = 0; i < v->plane_count; ++i) {
        const double rise = v->up_x * v->planes[i].nx + v->up_y * v->planes[i].ny;
        v->top = rise > 1 - 1e-6 ? i : v->top;
    }
    v->bottom = INFINITY;
    for (int i = 0; i < shape.count; ++i) {
        const plumb_vec2 p = plumb_transform_apply(frame, shape.points[i]);
        const double height = v->up_x * (double)p.x + v->up_y * (double)p.y - (double)shape.radius;
        v->bottom = height < v->bottom ? height : v->bottom;
    }
}

bool pl_fluids_find(plumb_world *world)
{
    pl_effects *e = &world->effects;
    const pl_pieces *pieces = &world->pieces;
    const pl_sensing *sensing = &world->sensing;
    const pl_keyed *c = sensing->candidates.data;
    pl_buffer *stirrers = &world->waves.step.stirrers;
    e->volume_count = e->immersion_count = e->swimmer_count = 0;
    world->waves.step.stirrer_count = 0;
    if (!pl_buffer_reserve(&world->memory, &e->swims, world->dynamic_count) ||
        !pl_buffer_reserve(&world->memory, &e->volumes,
                           sensing->candidate_count * sizeof(pl_volume)) ||
        !pl_buffer_reserve(&world->memory, &e->immersions,
                           sensing->candidate_count * sizeof(pl_keyed)) ||
        (world->waves.count > 0 &&
         !pl_buffer_reserve(&world->memory, stirrers,
                            sensing->candidate_count * sizeof(pl_keyed)))) {
        return false;
    }
    pl_fill(e->swims.data, 0, world->dynamic_count);
    for (uint32_t i = 0, first = 0; i < sensing->candidate_count; ++i) {
        const uint32_t sensor = c[i].order, other = c[i].value, row = pieces->body[other];
        if (!is_volume(world, sensor) || (pieces->flags[other] & PL_PIECE_SENSOR) != 0) {
            continue;
        }
        heed(world, sensor, row);
        const bool floats = row < world->dynamic_count && world->bodies.inv_mass[row] != 0;
        const bool stirs = (pieces->flags[sensor] & PL_PIECE_WAVES) != 0 &&
                           world->bodies.type[row] == PLUMB_KINEMATIC;
        if (!floats && !stirs) {
            continue;
        }
        // Candidates are sorted by shapes: volumes of the shape are the last ones.
        const pl_volume *volumes = e->volumes.data;
        if (e->volume_count > 0 &&
            !plumb_same(pieces->shape[volumes[first].piece], pieces->shape[sensor])) {
            first = e->volume_count;
        }
        uint32_t at = first;
        while (at < e->volume_count && volumes[at].piece != sensor) {
            ++at;
        }
        if (at == e->volume_count) {
            pl_volume *made = (pl_volume *)e->volumes.data + e->volume_count++;
            pl_fluid_volume(world, sensor, made);
            made->restless = pl_fluid_is_restless(world, sensor);
        }
        if (stirs) {
            ((pl_keyed *)stirrers->data)[world->waves.step.stirrer_count++] =
                (pl_keyed){ other, at, other };
            continue;
        }
        ((uint8_t *)e->swims.data)[row] = 1;
        ((pl_keyed *)e->immersions.data)[e->immersion_count++] =
            (pl_keyed){ pl_key(row, other), at, other };
    }
    return true;
}

//---- where they are ------------------------------------------------------------------------------

// A half plane of a volume, whose body has moved and turned for a time, about a point that is `away` from it.
static pl_half_plane plane_now(pl_half_plane p, double w, double time, const double away[2])
{
    const double angle = w * time;
    if (angle != 0) {
        double s, c;
        pl_sincos(angle, &s, &c);
        p = (pl_half_plane){ c * p.nx - s * p.ny, s * p.nx + c * p.ny, p.d };
    }
    p.d += p.nx * away[0] + p.ny * away[1];
    return p;
}

// The surface near a body, as waves have it.
static pl_half_plane surface_now(const pl_volume *v, const pl_tide *t, double level, double time)
{
    const double by = 1 / sqrt(1 + t->slope * t->slope);
    const double height = level + t->height + t->rate * time - t->slope * t->at;
    return (pl_half_plane){ -by * t->slope, by * v->up_y, by * height };
}

void pl_fluid_contour(const plumb_world *world, const pl_volume *volume, const pl_tide *tide,
                      uint32_t piece, const double moved[3], double time, pl_contour *out,
                      double away[2])
{
    const pl_bodies *b = &world->bodies;
    const uint32_t row = world->pieces.body[piece], holder = world->pieces.body[volume->piece];
    const pl_pose *pose = &pl_poses(world)[row], *held = &pl_poses(world)[holder];
    const pl_shift between = pl_wrap_between(world, piece, volume->piece);
    plumb_convex shape;
    double s, c;
    pl_sincos(moved[2], &s, &c);
    plumb_transform frame = { .q = { (real)(c * (double)b->c[row] - s * (double)b->s[row]),
                                     (real)(s * (double)b->c[row] + c * (double)b->s[row]) } };
    const plumb_vec2 local = { b->local_x[row], b->local_y[row] };
    const plumb_vec2 arm = plumb_rot_apply(frame.q, local);
    frame.p = (plumb_vec2){ -arm.x, -arm.y };
    away[0] =
        between.x + (double)held->dx - (double)pose->dx + (double)b->vx[holder] * time - moved[0];
    away[1] =
        between.y + (double)held->dy - (double)pose->dy + (double)b->vy[holder] * time - moved[1];
    pl_piece_convex(world, piece, &shape);
    pl_contour_of(&shape, world->pieces.cuts[piece], frame, 0, 0, out);
    for (int i = 0; i < volume->plane_count && out->count > 0; ++i) {
        pl_half_plane p = volume->planes[i];
        if (tide != NULL && i == volume->top) {
            p = surface_now(volume, tide, p.d, time - world->waves.step.dt / 2);
        }
        pl_contour_cut(out, plane_now(p, (double)b->w[holder], time, away));
    }
}

// Mass that the fluids lend a body as the step begins.
static double lent_mass(const plumb_world *world, const pl_swimmer *s)
{
    static const double still[3] = { 0, 0, 0 };
    const pl_keyed *all = world->effects.immersions.data;
    const pl_volume *volumes = world->effects.volumes.data;
    const pl_materials *m = &world->materials;
    double sum = 0;
    for (uint32_t i = s->first; i < s->first + s->count; ++i) {
        const pl_volume *volume = &volumes[all[i].order];
        const uint32_t row = volume->material;
        if (m->weightless[row] || m->added_mass[row] == 0) {
            continue;
        }
        pl_contour contour;
        double away[2];
        pl_fluid_contour(world, volume, pl_tide_of(world, i), all[i].value, still, 0, &contour,
                         away);
        const double area = pl_contour_area(&contour).area;
        sum += area > 0 ? (double)m->added_mass[row] * (double)m->density[row] * area : 0;
    }
    return sum;
}

static void lend(plumb_world *world, pl_swimmer *s)
{
    const pl_keyed *all = world->effects.immersions.data;
    for (uint32_t i = s->first; i < s->first + s->count; ++i) {
        s->restless |= ((const pl_volume *)world->effects.volumes.data)[all[i].order].restless;
    }
    pl_solver_body *body = &pl_solver_bodies(&world->solver)[s->slot];
    pl_solver_motion *motion = &pl_solver_motions(&world->solver)[s->slot];
    s->mass = 1 / (double)body->inv_mass;
    s->inertia = body->inv_inertia > 0 ? 1 / (double)body->inv_inertia : 0;
    s->lent = lent_mass(world, s);
    if (s->lent > 0) {
        body->inv_mass = motion->inv_mass = (near_real)(1 / (s->mass + s->lent));
    }
}

bool pl_fluids_immerse(plumb_world *world)
{
    pl_effects *e = &world->effects;
    const uint32_t *slots = world->solver.slots.data;
    pl_keyed *all = e->immersions.data;
    if (!pl_buffer_reserve(&world->memory, &e->swimmers, e->immersion_count * sizeof(pl_swimmer))) {
        return false;
    }
    for (uint32_t i = 0; i < e->immersion_count; ++i) {
        all[i].key = pl_key(slots[all[i].key >> 32], (uint32_t)all[i].key);
    }
    pl_sort_keyed(all, e->immersion_count);
    if (!pl_shelter_find(world) || !pl_waves_feel(world)) {
        return false;
    }
    pl_swimmer *swimmers = e->swimmers.data;
    for (uint32_t i = 0; i < e->immersion_count;) {
        const uint32_t slot = (uint32_t)(all[i].key >> 32), first = i;
        while (i < e->immersion_count && all[i].key >> 32 == slot) {
            ++i;
        }
        if (pl_solver_bodies(&world->solver)[slot].inv_mass > 0) { // else its time stands still
            swimmers[e->swimmer_count] =
                (pl_swimmer){ .slot = slot, .first = first, .count = i - first };
            lend(world, &swimmers[e->swimmer_count++]);
        }
    }
    return true;
}
