// toi.c - see toi.h.
//
// The moment of contact is looked for by Newton's method: the kernel makes the manifold of the time at which the bodies
// reach the plane, its separation and closing speed tell a better time. That takes a round or two where the pieces do
// meet. Where it leads nowhere they are swept (path.h): to the first moment at which they meet, or, as they never do, to
// that at which they are nearest.
//
// A plane that no point of the manifold reaches may yet be passed by another corner, as the pieces turn. Of what bounces the end of
// the ways is asked, and where they overlap there, Newton's method goes back from that. What dips in and out again within a step is not
// seen so.
//
// Reads: the manifold, ways, piece geometry. Writes: the answer. Cost: a kernel's lane and two poses a round; a sweep of some
// thousand instructions, and a search of 16 gaps where it ends in nothing.
#include "narrow/toi.h"

#include "math/compare.h"

#include <math.h>

// [-] 1 - cosine of normals that are taken for one: 0.01 rad, what the ground turns by in a step of a fast carousel.
#define SAME_NORMAL 5e-5
// [-] more than what the solver may round off a way that it sums up in floats.
#define ROUNDING 1e-5
// [m] separation that is aimed at: at 0 a kernel might see corners side by side as a face and what lies behind it.
#define AIM (PL_TOI_ASIDE / 2)
// [m] round features that are thrown back touch when they are nearer: 3e-5 m before a hit that grazes at 19 m/s its
// direction is 0.006 rad off.
#define TOUCHES 2e-6

// The same without impacts.
static pl_paths free_paths(const pl_paths *paths)
{
    pl_path a = paths->of[0], b = paths->of[1];
    a.turns = b.turns = 0;
    return pl_paths_of(&a, &b);
}

// [m] what the points of a manifold close until the ends of the legs.
typedef struct closings {
    double at[2][2 * PL_TURNS + 2];
} closings;

static void find_closings(closings *c, const pl_paths *paths, const pl_manifold *m)
{
    c->at[0][0] = c->at[1][0] = 0;
    for (int i = 1; i <= paths->legs; ++i) {
        const pl_motion a = pl_path_at(&paths->of[0], paths->breaks[i]);
        const pl_motion b = pl_path_at(&paths->of[1], paths->breaks[i]);
        for (uint32_t k = 0; k < m->count; ++k) {
            c->at[k][i] = pl_motions_closed(a, b, &m->point[k], (double)m->nx, (double)m->ny);
        }
    }
}

// The time at which the first point of a manifold reaches its plane, or is so far before it; PL_SWEEP_NEVER: none does.
// Closing is linear on each leg.
static double first_time(const closings *c, const pl_paths *paths, const pl_manifold *m,
                         double left)
{
    double first = PL_SWEEP_NEVER;
    for (uint32_t k = 0; k < m->count; ++k) {
        const double way = (double)m->point[k].separation - left, *closed = c->at[k];
        int i = 1;
        while (i <= paths->legs && !(closed[i] > way)) {
            ++i;
        }
        if (i <= paths->legs) {
            const double from = paths->breaks[i - 1], to = paths->breaks[i];
            const double time = way > closed[i - 1] ? from + (to - from) * (way - closed[i - 1]) /
                                                                 (closed[i] - closed[i - 1])
                                                    : from;
            first = pl_lesser(first, time);
        }
    }
    return first;
}

// Whether a point would reach its plane without impacts.
static bool reaches_freely(const pl_paths *paths, const pl_manifold *m)
{
    bool reaches = false;
    for (uint32_t k = 0; k < m->count; ++k) {
        reaches = reaches ||
                  pl_motions_closed(paths->of[0].flight, paths->of[1].flight, &m->point[k],
                                    (double)m->nx, (double)m->ny) > (double)m->point[k].separation;
    }
    return reaches;
}

static pl_toi_state without_contact(const pl_toi *item, const pl_manifold *m)
{
    return reaches_freely(&item->paths, m) ? PL_TOI_HELD : PL_TOI_KEEPS;
}

void pl_toi_open(pl_toi *item, const pl_manifold *m)
{
    closings c;
    find_closings(&c, &item->paths, m);
    item->verdict = PL_TOI_OPEN;
    item->close = item->at_end = false;
    item->time = item->meets = first_time(&c, &item->paths, m, 0);
    if (item->time <= 1) {
        item->time = first_time(&c, &item->paths, m, AIM);
        return;
    }
    if (item->turns) {
        item->at_end = true;
        item->time = 1;
        return;
    }
    item->verdict = without_contact(item, m);
}

bool pl_toi_ends_apart(pl_toi *item, const pl_manifold *m, const pl_manifold *then)
{
    const bool asked = item->at_end;
    item->at_end = false;
    if (!asked ||
        (then != NULL && (then->point[0].separation < 0 || then->point[1].separation < 0))) {
        return false;
    }
    item->verdict = without_contact(item, m);
    item->time = item->meets; // never
    return true;
}

void pl_toi_pose(pl_toi *item, const plumb_world *world, const pl_pair *pair)
{
    const pl_moving_pair e = pl_moving_pair_of(world, pair, &item->paths);
    item->poses[0] = pl_moving_pair_pose(&e, 0, item->time);
    item->poses[1] = pl_moving_pair_pose(&e, 1, item->time);
}

static bool is_same_normal(const pl_manifold *m, near_real nx, near_real ny)
{
    return (double)m->nx * (double)nx + (double)m->ny * (double)ny > 1 - SAME_NORMAL;
}

// A hit that throws round features back: its direction is that of the line between their centres, and 2.5e-4 m before
// they meet that of discs of 0.03 m is 0.15 degrees off.
static bool is_round_hit(const pl_manifold *m, const pl_manifold *then)
{
    return m->restitution > 0 && (then->met & PL_MET_TURNS) == PL_MET_TURNS_MID;
}

// Whether the plane of the start is that of the features that meet at out->time.
static bool is_that_plane(const pl_toi *out, const pl_manifold *m)
{
    const double nx = (double)m->nx, ny = (double)m->ny;
    if (!is_same_normal(m, out->nx, out->ny)) {
        return false;
    }
    const pl_motion a = pl_path_at(&out->paths.of[0], out->time);
    const pl_motion b = pl_path_at(&out->paths.of[1], out->time);
    double least = HUGE_VAL;
    for (uint32_t k = 0; k < m->count; ++k) {
        const pl_manifold_point *p = &m->point[k];
        least = pl_lesser(least, (double)p->separation - pl_motions_closed(a, b, p, nx, ny));
    }
    return fabs(least) < PL_TOI_ASIDE;
}

// [m] a horizon by which a point closes at a time.
static double rate_of(const pl_paths *paths, const pl_manifold_point *p, double nx, double ny,
                      double time)
{
    if (paths->legs == 1) {
        return pl_paths_closed(paths, p, nx, ny, 1);
    }
    int leg = 1;
    while (leg < paths->legs && paths->breaks[leg] <= time) {
        ++leg;
    }
    const double from = paths->breaks[leg - 1], to = paths->breaks[leg];
    return (pl_paths_closed(paths, p, nx, ny, to) - pl_paths_closed(paths, p, nx, ny, from)) /
           (to - from);
}

// The manifold of the moment is found: the start's own, or another one.
static void settle(pl_toi *item, const pl_manifold *m, const pl_manifold *then,
                   const pl_manifold_point *p)
{
    item->nx = then->nx, item->ny = then->ny;
    item->point = *p;
    const bool keeps = !is_round_hit(m, then) && is_that_plane(item, m);
    item->verdict = keeps ? PL_TOI_KEEPS : PL_TOI_HIT;
    if (item->verdict == PL_TOI_HIT) {
        item->then = *then;
    }
}

bool pl_toi_refine(pl_toi *item, const pl_manifold *m, const pl_manifold *then)
{
    const pl_manifold_point *p =
        &then->point[then->point[1].separation < then->point[0].separation];
    const double s = (double)p->separation;
    const double rate = rate_of(&item->paths, p, (double)then->nx, (double)then->ny, item->time);
    if (!(rate > 0)) {
        return false;
    }
    double aim = AIM;
    if (s > (item->close ? -PL_TOI_ASIDE : 0) && s < PL_TOI_ASIDE) {
        const bool near =
            item->close ? fabs(s) < TOUCHES : !is_round_hit(m, then) || item->time + s / rate > 1;
        if (near) {
            settle(item, m, then, p);
            item->meets = item->time + s / rate;
            return true;
        }
        item->close = true;
        aim = 0;
    }
    item->time += (s - aim) / rate;
    return item->time >= 0 && item->time <= 1;
}

// The nearest points of an approach.
static void note_nearest(pl_toi *out, const pl_moving_pair *e, const pl_pair_approach *approach)
{
    const pl_nearest *at = &approach->nearest;
    const pl_gap gap = at->gap; // its normal points from B to A
    const double half_x = gap.nx * gap.distance / 2, half_y = gap.ny * gap.distance / 2;
    const pl_motion a = pl_path_at(&e->paths->of[0], approach->time);
    const pl_motion b = pl_path_at(&e->paths->of[1], approach->time);
    out->nx = (near_real)-gap.nx, out->ny = (near_real)-gap.ny;
    out->point = (pl_manifold_point){ .ax = (near_real)(at->x + half_x - (e->px[0] + a.x)),
                                      .ay = (near_real)(at->y + half_y - (e->py[0] + a.y)),
                                      .bx = (near_real)(at->x - half_x - (e->px[1] + b.x)),
                                      .by = (near_real)(at->y - half_y - (e->py[1] + b.y)),
                                      .separation = (near_real)gap.distance };
}

void pl_toi_sweep(pl_toi *item, const plumb_world *world, const pl_manifold *m, const pl_pair *pair)
{
    const pl_moving_pair e = pl_moving_pair_of(world, pair, &item->paths);
    const pl_pair_approach approach = pl_moving_pair_approach(&e, 0, (double)PL_SPECULATIVE);
    item->time = item->meets = approach.time;
    if (approach.kind == PL_APPROACH_NONE) {
        item->verdict = PL_TOI_PASSES;
        return;
    }
    note_nearest(item, &e, &approach);
    const bool meets = approach.kind == PL_APPROACH_MEETS;
    const double rate =
        rate_of(&item->paths, &item->point, (double)item->nx, (double)item->ny, item->time);
    item->meets += meets && rate > 0 ? (double)item->point.separation / rate : 0;
    item->verdict = meets && (item->time == 0 || is_that_plane(item, m)) ? PL_TOI_KEEPS
                    : meets                                              ? PL_TOI_HIT
                                                                         : PL_TOI_NEAR;
}

// [m] the least separation of a plane that the point does not reach, whatever is rounded off: on its way, nor on that
// which it would take without an impact, for a sweep of the solver may come to this contact first.
double pl_toi_beyond(const pl_paths *paths, const pl_manifold_point *p, double nx, double ny)
{
    const pl_paths free = free_paths(paths);
    double most = pl_paths_closed(&free, p, nx, ny, 1), way = 0;
    for (int i = 1; i <= paths->legs; ++i) {
        const pl_motion a = pl_path_at(&paths->of[0], paths->breaks[i]);
        const pl_motion b = pl_path_at(&paths->of[1], paths->breaks[i]);
        most = pl_greater(most, pl_paths_closed(paths, p, nx, ny, paths->breaks[i]));
        way += fabs(b.x - a.x) + fabs(b.y - a.y);
    }
    return most + ROUNDING * (way + fabs(most));
}

void pl_toi_hold_back(pl_manifold *m, const pl_paths *paths)
{
    for (uint32_t k = 0; k < m->count; ++k) {
        pl_manifold_point *p = &m->point[k];
        const double least = pl_toi_beyond(paths, p, (double)m->nx, (double)m->ny);
        p->separation = (near_real)pl_greater(least, (double)p->separation);
    }
}
