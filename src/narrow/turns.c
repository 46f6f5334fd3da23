// turns.c - the ways of bodies until the horizon: they fly on, and their first impact turns them aside.
//
// Impacts are those of contacts that lie ahead and were found to meet, and of contacts that are there already and
// close (PL_CANDIDATE_STRIKES). Friction, and what is second on the way of a body, are left to the solver.
//
// Reads: poses, velocities, forces, candidates, verdicts. Writes: paths of claimed bodies. Cost: O(candidates).
#include "narrow/looking.h"

#include <math.h>

const pl_path pl_looking_still = { .impact = PL_SWEEP_NEVER };

pl_way *pl_looking_new_way(pl_looking *l, uint32_t row)
{
    l->all[l->way_count++] = (pl_way){ .path = { .flight = pl_flight_of(l->world, row, l->horizon),
                                                 .impact = PL_SWEEP_NEVER } };
    l->map[row] = l->way_count;
    return &l->all[l->way_count - 1];
}

pl_paths pl_looking_paths(pl_looking *l, const pl_manifold *m)
{
    return pl_paths_of(pl_looking_path(l, m->body_a), pl_looking_path(l, m->body_b));
}

static void note_change(pl_looking *l, uint32_t row, double time, pl_motion change)
{
    if (!pl_looking_may_turn(l, row, time)) {
        return;
    }
    const double moves =
        fabs(change.x) + fabs(change.y) + fabs(change.turn) * (double)l->world->bodies.extent[row];
    if (moves * (1 - time) > (double)PL_TURNED) {
        pl_way *way = pl_looking_way(l, row);
        way->path.impact = time;
        way->path.change = change;
        way->struck = !l->strikes_noted;
        l->any_turned = l->any_turned || l->strikes_noted;
    }
}

// What an impact at a point makes of both ways, without friction. Flat on two points: as if in their middle.
static void note_impact(pl_looking *l, const pl_manifold *m, const pl_manifold_point *p, double nx,
                        double ny, double time)
{
    if (!pl_looking_may_turn(l, m->body_a, time) && !pl_looking_may_turn(l, m->body_b, time)) {
        return;
    }
    const pl_bodies *b = &l->world->bodies;
    const double closing = pl_motions_closed(pl_looking_path(l, m->body_a)->flight,
                                             pl_looking_path(l, m->body_b)->flight, p, nx, ny);
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
            (pl_looking_may_turn(l, ends[place].a, 0) ||
             pl_looking_may_turn(l, ends[place].b, 0))) {
            const pl_manifold *m = &pl_manifolds(l->narrow)[place];
            note_impact(l, m, first_point(m), (double)m->nx, (double)m->ny, 0);
        }
    }
    l->strikes_noted = true;
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
