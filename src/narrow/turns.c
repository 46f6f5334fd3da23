// turns.c - the ways of bodies until the horizon: they fly on, and impacts turn them aside.
//
// Impacts are those of contacts that are there already and close (PL_CANDIDATE_STRIKES), as the step begins, and of contacts
// that lie ahead and were found to meet. Of the latter one counts only if the ways on which it was found are still those
// of its bodies: in order of time, each turns both, and what was to come behind it on their old ways is looked at again.
// So after some rounds all is in order from impact to impact (ahead.c).
//
// Reads: poses, velocities, forces, candidates, verdicts. Writes: paths of claimed bodies. Cost: O(candidates); those that meet are sorted.
#include "core/sort.h"
#include "narrow/looking.h"

#include <math.h>
#include <string.h>

const pl_path pl_looking_still = { .turns = 0 };

pl_way *pl_looking_new_way(pl_looking *l, uint32_t row)
{
    l->all[l->way_count++] =
        (pl_way){ .path = { .flight = pl_flight_of(l->world, row, l->horizon) },
                  .joined =
                      row < l->world->dynamic_count && l->world->bodies.first_joint[row] != PL_NONE,
                  .row = row };
    l->map[row] = l->way_count;
    return &l->all[l->way_count - 1];
}

pl_paths pl_looking_paths(pl_looking *l, const pl_manifold *m)
{
    return pl_paths_of(pl_looking_path(l, m->body_a), pl_looking_path(l, m->body_b));
}

// What a body does over the horizon at the pace that it has just before a time.
static pl_motion pace_at(const pl_path *p, double time)
{
    pl_motion pace = p->flight;
    for (int i = 0; i < p->turns && p->time[i] < time; ++i) {
        pace.x += p->change[i].x;
        pace.y += p->change[i].y;
        pace.turn += p->change[i].turn;
    }
    return pace;
}

// What slides over ground of several pieces strikes edges within that, which are none (internal_edges/).
static bool is_inside_ground(const pl_looking *l, const pl_manifold *m)
{
    const pl_pair *pair = &l->in->pairs[m->pair];
    return pl_piece_has_internal_edges(&l->world->pieces, pair->a) ||
           pl_piece_has_internal_edges(&l->world->pieces, pair->b);
}

static void note_change(pl_looking *l, const pl_manifold *m, uint32_t row, double time,
                        pl_motion change)
{
    const bool elastic = pl_is_elastic(m->restitution);
    if (!pl_looking_may_turn(l, row, time, elastic)) {
        return;
    }
    pl_way *way = pl_looking_way(l, row);
    const double moves =
        fabs(change.x) + fabs(change.y) + fabs(change.turn) * (double)l->world->bodies.extent[row];
    if (moves * (1 - time) > (double)PL_TURNED &&
        !(way->path.turns > 0 && is_inside_ground(l, m))) {
        way->path.time[way->path.turns] = time;
        way->path.change[way->path.turns++] = change;
        way->struck = way->struck || !l->strikes_noted;
        way->bounces = way->bounces || elastic;
    }
}

// What an impact at a point makes of both ways. Flat on two points: as if in their middle.
static void note_impact(pl_looking *l, const pl_manifold *m, const pl_manifold_point *p, double nx,
                        double ny, double time)
{
    const bool elastic = pl_is_elastic(m->restitution);
    if (!pl_looking_may_turn(l, m->body_a, time, elastic) &&
        !pl_looking_may_turn(l, m->body_b, time, elastic)) {
        return;
    }
    const pl_bodies *bodies = &l->world->bodies;
    const pl_motion a = pace_at(pl_looking_path(l, m->body_a), time);
    const pl_motion b = pace_at(pl_looking_path(l, m->body_b), time);
    const double closing = pl_motions_closed(a, b, p, nx, ny);
    if (!(closing > (double)PL_TURNED)) {
        return;
    }
    const bool flat = m->count == 2;
    const double ran = flat ? 0 : (double)p->ax * ny - (double)p->ay * nx;
    const double rbn = flat ? 0 : (double)p->bx * ny - (double)p->by * nx;
    const double ima = (double)bodies->inv_mass[m->body_a];
    const double imb = (double)bodies->inv_mass[m->body_b];
    const double iia = (double)bodies->inv_inertia[m->body_a];
    const double iib = (double)bodies->inv_inertia[m->body_b];
    const double k = ima + imb + iia * ran * ran + iib * rbn * rbn;
    if (!(k > 0)) {
        return;
    }
    const double j = (1 + (double)m->restitution) * closing / k;
    // Friction stops the slip, or is as much as it can be (solver/bounce.c). The tangent is (-ny, nx).
    const double rat = (double)p->ax * nx + (double)p->ay * ny;
    const double rbt = (double)p->bx * nx + (double)p->by * ny;
    const double slip = nx * (b.y - a.y) - ny * (b.x - a.x) + rbt * b.turn - rat * a.turn;
    const double most = (double)m->friction * j;
    const double kt = ima + imb + iia * rat * rat + iib * rbt * rbt;
    const double jt = pl_greater(-most, pl_lesser(most, -slip / kt));
    const double x = nx * j - ny * jt, y = ny * j + nx * jt;
    note_change(l, m, m->body_a, time,
                (pl_motion){ -ima * x, -ima * y, -iia * (ran * j + rat * jt) });
    note_change(l, m, m->body_b, time, (pl_motion){ imb * x, imb * y, iib * (rbn * j + rbt * jt) });
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
            (pl_looking_may_turn(l, ends[place].a, 0, false) ||
             pl_looking_may_turn(l, ends[place].b, 0, false))) {
            const pl_manifold *m = &pl_manifolds(l->narrow)[place];
            note_impact(l, m, first_point(m), (double)m->nx, (double)m->ny, 0);
        }
    }
    l->strikes_noted = true;
}

bool pl_looking_is_same_way(const pl_path *p, const pl_path *q, double time)
{
    for (int i = 0; i < PL_TURNS; ++i) {
        const bool of_p = i < p->turns && p->time[i] < time;
        const bool of_q = i < q->turns && q->time[i] < time;
        if (of_p != of_q ||
            (of_p && (p->time[i] != q->time[i] ||
                      memcmp(&p->change[i], &q->change[i], sizeof p->change[i]) != 0))) {
            return false;
        }
    }
    return true;
}

// Tells ways with other turns apart; 0 of one without. Knuth's multiplicative step, over the bits of all turns.
static uint64_t digest_of(const pl_path *p)
{
    uint64_t sum = 0;
    for (int i = 0; i < p->turns; ++i) {
        const double all[] = { p->time[i], p->change[i].x, p->change[i].y, p->change[i].turn };
        for (size_t k = 0; k < sizeof all / sizeof all[0]; ++k) {
            uint64_t bits;
            memcpy(&bits, &all[k], sizeof bits);
            sum = (sum ^ bits) * 6364136223846793005u + 1;
            sum ^= sum >> 32;
        }
    }
    return sum;
}

// Whether a contact that was found to meet does so on the ways that its bodies take.
static bool is_right(pl_looking *l, const pl_toi *item)
{
    const pl_manifold *m = pl_looking_manifold(l, item);
    return pl_looking_is_same_way(&item->paths.of[0], pl_looking_path(l, m->body_a), item->meets) &&
           pl_looking_is_same_way(&item->paths.of[1], pl_looking_path(l, m->body_b), item->meets);
}

static void note_hit(pl_looking *l, const pl_toi *item)
{
    const pl_manifold *m = pl_looking_manifold(l, item);
    if (item->verdict == PL_TOI_HIT) {
        note_impact(l, m, &item->point, (double)item->nx, (double)item->ny, item->meets);
    } else {
        note_impact(l, m, first_point(m), (double)m->nx, (double)m->ny, item->meets);
    }
}

// The items that meet, by time. False when out of memory.
static bool list_meetings(pl_looking *l, uint32_t *count)
{
    pl_lookahead *ahead = l->ahead;
    if (!pl_buffer_reserve(&l->world->memory, &ahead->meetings, ahead->count * sizeof(pl_keyed))) {
        return false;
    }
    pl_keyed *meetings = ahead->meetings.data;
    *count = 0;
    for (uint32_t i = 0; i < ahead->count; ++i) {
        const pl_toi *item = &pl_looking_items(ahead)[i];
        if (item->verdict == PL_TOI_HIT || (item->verdict == PL_TOI_KEEPS && item->meets <= 1)) {
            const double time = pl_greater(item->meets, 0);
            meetings[(*count)++] = (pl_keyed){ pl_key_of_number(time), item->pair, i };
        }
    }
    pl_sort_keyed(meetings, *count);
    return true;
}

static bool is_lively(const pl_looking *l, uint32_t row)
{
    const pl_way *way = pl_looking_known(l, row);
    return way != NULL && way->lively;
}

bool pl_looking_note_meetings(pl_looking *l, bool again)
{
    uint32_t count;
    if (!list_meetings(l, &count)) {
        return false;
    }
    for (uint32_t i = 0; i < l->way_count; ++i) {
        pl_way *way = &l->all[i];
        if (way->claimed && (way->lively || !again)) {
            way->path.turns = way->struck ? 1 : 0;
        }
    }
    for (uint32_t i = 0; i < count; ++i) {
        const pl_keyed *at = (const pl_keyed *)l->ahead->meetings.data + i;
        const pl_toi *item = &pl_looking_items(l->ahead)[at->value];
        const pl_manifold *m = pl_looking_manifold(l, item);
        if ((!again || is_lively(l, m->body_a) || is_lively(l, m->body_b)) && is_right(l, item)) {
            note_hit(l, item);
        }
    }
    for (uint32_t i = 0; i < l->way_count; ++i) {
        pl_way *way = &l->all[i];
        const uint64_t digest = way->claimed ? digest_of(&way->path) : way->before;
        way->changed = digest != way->before;
        way->before = digest;
    }
    return true;
}
