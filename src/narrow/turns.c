// turns.c - the ways of bodies until the horizon: they fly on, and their first impact turns them aside.
//
// Impacts are those of contacts that lie ahead and were found to meet, and of contacts that are there already and
// close (PL_CANDIDATE_STRIKES). Friction, and what is second on the way of a body, are left to the solver.
//
// Reads: poses, velocities, forces, candidates, verdicts. Writes: paths of claimed bodies. Cost: O(candidates).
#include "narrow/looking.h"

#include <math.h>

static pl_path *path_of(const pl_looking *l, uint32_t row)
{
    return row < l->movable && l->map[row] > PL_CLAIMED ? &l->all[l->map[row] - PL_CLAIMED - 1]
                                                        : NULL;
}

static pl_path *make_path(pl_looking *l, uint32_t row)
{
    pl_path *path = path_of(l, row);
    if (path == NULL) {
        path = &l->all[l->path_count++];
        *path = (pl_path){ .flight = pl_flight_of(l->world, row, l->horizon),
                           .impact = PL_SWEEP_NEVER };
        l->map[row] = PL_CLAIMED + l->path_count;
    }
    return path;
}

pl_motion pl_looking_flight(const pl_looking *l, uint32_t row)
{
    const pl_path *path = path_of(l, row);
    return path != NULL ? path->flight : pl_flight_of(l->world, row, l->horizon);
}

static pl_path way_of(const pl_looking *l, uint32_t row)
{
    const pl_path *path = path_of(l, row);
    return path != NULL ? *path
                        : (pl_path){ .flight = pl_flight_of(l->world, row, l->horizon),
                                     .impact = PL_SWEEP_NEVER };
}

pl_paths pl_looking_paths(const pl_looking *l, const pl_manifold *m)
{
    return pl_paths_of(way_of(l, m->body_a), way_of(l, m->body_b));
}

static void note_change(pl_looking *l, uint32_t row, double time, pl_motion change)
{
    if (!pl_looking_is_claimed(l, row)) {
        return;
    }
    const double moves =
        fabs(change.x) + fabs(change.y) + fabs(change.turn) * (double)l->world->bodies.extent[row];
    if (moves * (1 - time) > (double)PL_TURNED) {
        pl_path *path = make_path(l, row);
        if (time < path->impact) {
            path->impact = time;
            path->change = change;
        }
    }
}

// What an impact at a point makes of both ways, without friction. Flat on two points: as if in their middle.
static void note_impact(pl_looking *l, const pl_manifold *m, const pl_manifold_point *p, double nx,
                        double ny, double time)
{
    const pl_bodies *b = &l->world->bodies;
    const double closing = pl_motions_closed(pl_looking_flight(l, m->body_a),
                                             pl_looking_flight(l, m->body_b), p, nx, ny);
    if (!(closing > (double)PL_TURNED)) {
        return;
    }
    const bool flat = m->count == 2;
    const double ran = flat ? 0 : (double)p->ax * ny - (double)p->ay * nx;
    const double rbn = flat ? 0 : (double)p->bx * ny - (double)p->by * nx;
    const double ima = (double)b->inv_mass[m->body_a], imb = (double)b->inv_mass[m->body_b];
    const double iia = (double)b->inv_inertia[m->body_a], iib = (double)b->inv_inertia[m->body_b];
    const double k = ima + imb + iia * ran * ran + iib * rbn * rbn;
    if (!(k > 0)) {
        return;
    }
    const double j = (1 + (double)m->restitution) * closing / k;
    note_change(l, m->body_a, time, (pl_motion){ -ima * nx * j, -ima * ny * j, -iia * ran * j });
    note_change(l, m->body_b, time, (pl_motion){ imb * nx * j, imb * ny * j, iib * rbn * j });
}

// The point of a manifold that reaches its plane first.
static const pl_manifold_point *first_point(const pl_manifold *m)
{
    return &m->point[m->point[1].separation < m->point[0].separation];
}

void pl_looking_note_strikes(pl_looking *l)
{
    const pl_ends *ends = l->narrow->ends.data;
    const uint32_t *candidates = l->narrow->candidates.data;
    for (uint32_t i = 0; i < l->narrow->candidate_count; ++i) {
        const uint32_t place = candidates[i] & PL_CANDIDATE_PLACE;
        if ((candidates[i] & PL_CANDIDATE_STRIKES) != 0 &&
            (pl_looking_is_claimed(l, ends[place].a) || pl_looking_is_claimed(l, ends[place].b))) {
            const pl_manifold *m = &pl_manifolds(l->narrow)[place];
            note_impact(l, m, first_point(m), (double)m->nx, (double)m->ny, 0);
        }
    }
    l->struck_count = l->path_count;
}

void pl_looking_note_meetings(pl_looking *l)
{
    for (uint32_t i = 0; i < l->ahead->count; ++i) {
        const pl_toi *item = &pl_looking_items(l->ahead)[i];
        const pl_manifold *m = pl_looking_manifold(l, item);
        if (item->verdict == PL_TOI_HIT) {
            note_impact(l, m, &item->point, (double)item->nx, (double)item->ny, item->time);
        } else if (item->verdict == PL_TOI_KEEPS && item->time <= 1) {
            note_impact(l, m, first_point(m), (double)m->nx, (double)m->ny, item->time);
        }
    }
}
