// search.c - one mover against what stands still, then against what moves: pieces found by the grids,
// asked whether they may collide, swept, and asked once more where they would.
//
// Reads: movers, poses, pieces, grids, filters, joints. Writes: the search. Cost: entries of the grids
// in the box around the way; a gap and a few rounds of sweep.c for each that the way does not miss.
#include "continuous/search.h"

#include "broad/images.h"
#include "broad/pairs.h"
#include "continuous/continuous.h"
#include "continuous/target.h"
#include "narrow/one_way.h"
#include "plumb/math.h"
#include "world/filter.h"
#include "world/joint_list.h"
#include "world/rows.h"

#include <math.h>

// [-] of a step: stopping earlier by less is no change.
#define TINY_TIME 1e-9

static bool is_solid(const plumb_world *world, uint32_t piece)
{
    return (world->pieces.flags[piece] & PL_PIECE_SENSOR) == 0;
}

// Whether the pieces may be solid to one another: of different bodies, no sensors, kept apart by
// neither filter, excluded pair nor joint. Asked before any geometry.
static bool may_collide(const plumb_world *world, uint32_t piece, uint32_t other)
{
    const uint8_t *flags = world->pieces.flags;
    uint32_t row = world->pieces.body[piece], other_row = world->pieces.body[other];
    if (row == other_row || ((flags[piece] | flags[other]) & PL_PIECE_SENSOR) != 0) {
        return false;
    }
    if (pl_world_is_selective(world) && !pl_pieces_meet(world, piece, other)) {
        return false;
    }
    const uint32_t *first_joint = world->bodies.first_joint;
    return first_joint[row] == PL_NONE || first_joint[other_row] == PL_NONE ||
           !pl_joints_forbid(world, row, other_row);
}

// Each of the two that is one-way holds the other where they meet.
static bool one_way_holds(const plumb_world *world, const pl_impact_place *place)
{
    const uint8_t *flags = world->pieces.flags;
    plumb_vec2 n = { (real)place->nx, (real)place->ny };
    return ((flags[place->other] & PL_PIECE_ONE_WAY) == 0 ||
            pl_one_way_blocks(world, place->other, n, 0)) &&
           ((flags[place->piece] & PL_PIECE_ONE_WAY) == 0 ||
            pl_one_way_blocks(world, place->piece, plumb_vec2_neg(n), 0));
}

// Whether the body stops at this impact, or goes on as if `other` were not there: it does where a
// system disabled the contact in this step, and where a one-way shape lets it pass. The only question of
// its kind in the pass.
static bool stops_at(const plumb_world *world, const pl_impact_place *place)
{
    const uint8_t *flags = world->pieces.flags;
    uint8_t one_way = (flags[place->piece] | flags[place->other]) & PL_PIECE_ONE_WAY;
    if (!world->edited && one_way == 0) {
        return true;
    }
    const pl_pair *pair = pl_pairs_find_one(world, place->piece, place->other);
    if (pair != NULL && ((pair->flags & PL_PAIR_WAIVED) != 0 || pl_pair_passes(pair))) {
        return false;
    }
    return one_way == 0 || one_way_holds(world, place);
}

//---- one body against what stands still ----------------------------------------------------------

pl_search pl_search_of(const plumb_world *world, const pl_mover *mover)
{
    pl_search s = { .world = world, .mover = mover, .sunk = -1, .first = 1 };
    s.motion = pl_swept_motion_of_mover(world, mover, (double)mover->x, (double)mover->y);
    return s;
}

static void take_piece(pl_search *s, uint32_t piece)
{
    s->piece = piece;
    s->swept = pl_swept_motion_piece(s->world, piece, &s->motion);
    s->box = pl_swept_motion_box(&s->motion, &s->swept);
    s->half_width = pl_piece_half_width(s->world, piece, false);
    s->reach = pl_swept_reach(&s->swept);
}

// Whether the piece, wherever it has turned, stays clear of a box to one side of its way.
static bool goes_by(const pl_search *s, const pl_box *box)
{
    double dx = s->swept.dx, dy = s->swept.dy;
    double hx = ((double)box->max_x - (double)box->min_x) / 2;
    double hy = ((double)box->max_y - (double)box->min_y) / 2;
    double x = (double)box->min_x + hx - s->motion.ox - s->swept.px;
    double y = (double)box->min_y + hy - s->motion.oy - s->swept.py;
    double aside = fabs(dx * y - dy * x) - fabs(dx) * hy - fabs(dy) * hx;
    return aside > 0 && aside * aside > s->reach * s->reach * (dx * dx + dy * dy);
}

// Takes a motion by the image of the piece that is where the grid has found it.
static pl_shift take_image(const pl_search *s, pl_swept_motion *motion, uint32_t piece)
{
    pl_shift by = pl_swept_motion_image(s->world, motion, piece, s->at_x, s->at_y);
    motion->px += by.x;
    motion->py += by.y;
    return by;
}

static void look_at(pl_search *s, const pl_box *box)
{
    s->at_x = ((double)box->min_x + (double)box->max_x) / 2;
    s->at_y = ((double)box->min_y + (double)box->max_y) / 2;
}

static pl_swept still_piece(pl_search *s, const pl_grid_entry *entry)
{
    const uint32_t piece = entry->piece;
    pl_swept_motion motion = pl_swept_motion_of_row(s->world, s->world->pieces.body[piece], 0,
                                                    s->motion.ox, s->motion.oy);
    look_at(s, &entry->box);
    take_image(s, &motion, piece);
    return pl_swept_motion_piece(s->world, piece, &motion);
}

static double thickness(const pl_search *s, uint32_t other)
{
    return (double)s->half_width + (double)pl_piece_half_width(s->world, other, false);
}

static bool visit_depth(void *context, const pl_grid_entry *entry)
{
    pl_search *s = context;
    if (may_collide(s->world, s->piece, entry->piece)) {
        pl_swept other = still_piece(s, entry);
        double depth = -pl_sweep_gap(&s->swept, &other, 0).distance;
        if (depth > s->sunk && !pl_target_is_lost(thickness(s, entry->piece), depth)) {
            s->sunk = depth;
        }
    }
    return true;
}

// How deep the body lies in static pieces at the start.
static double depth_at_start(const pl_search *s)
{
    pl_search at = *s;
    at.motion = pl_swept_motion_stopped(&s->motion, 0);
    at.sunk = 0;
    for (uint32_t p = s->world->bodies.first_piece[s->mover->row]; p != PL_NONE;
         p = s->world->pieces.next_in_body[p]) {
        take_piece(&at, p);
        pl_world_query(s->world, &s->world->broad.fixed, at.box, visit_depth, &at);
    }
    return at.sunk;
}

// When `a` goes too deep into `b`; `sunk` lets it go so much deeper.
static double time_of_hit(const pl_swept *a, const pl_swept *b, double from, double to,
                          double thick, double sunk)
{
    pl_sweep s;
    pl_sweep_open(&s, a, b);
    double depth = -pl_sweep_gap_at(&s, from).distance;
    if (pl_target_is_lost(thick, depth)) {
        return PL_SWEEP_NEVER; // it has no side that could be told
    }
    pl_sweep_target target = pl_target_of(thick, depth, sunk);
    return pl_sweep_first_of(&s, from, to, target.distance, target.tolerance);
}

static bool stops(const pl_search *s, uint32_t other, const pl_swept *other_swept, double time)
{
    pl_gap gap = pl_sweep_gap(&s->swept, other_swept, time);
    double x, y;
    pl_sweep_point(&s->swept, time, -gap.nx, -gap.ny, &x, &y);
    return stops_at(s->world, &(pl_impact_place){ .piece = s->piece,
                                                  .other = other,
                                                  .x = s->motion.ox + x,
                                                  .y = s->motion.oy + y,
                                                  .nx = gap.nx,
                                                  .ny = gap.ny });
}

static bool visit_still(void *context, const pl_grid_entry *entry)
{
    pl_search *s = context;
    if (goes_by(s, &entry->box) || !may_collide(s->world, s->piece, entry->piece)) {
        return true;
    }
    pl_swept other = still_piece(s, entry);
    double until = s->first;
    double thick = thickness(s, entry->piece);
    double time = time_of_hit(&s->swept, &other, 0, until, thick, s->sunk > 0 ? s->sunk : 0);
    if (time < until && s->sunk < 0) {
        // It may only be as deep there as it is here.
        s->sunk = depth_at_start(s);
        time = s->sunk > 0 ? time_of_hit(&s->swept, &other, 0, until, thick, s->sunk) : time;
    }
    if (time < until && stops(s, entry->piece, &other, time)) {
        s->first = time;
    }
    return true;
}

static bool asks(const plumb_world *world, uint32_t row)
{
    return (world->bodies.flags[row] & PL_BODY_CONTINUOUS) != 0;
}

// What sleeps on the way was woken at the start of the step; this is for what a bounce led here.
static bool visit_asleep(void *context, const pl_grid_entry *entry)
{
    const pl_search *s = context;
    bool asleep = (s->world->pieces.flags[entry->piece] & PL_PIECE_ASLEEP) != 0;
    bool asked =
        asks(s->world, s->mover->row) || asks(s->world, s->world->pieces.body[entry->piece]);
    return !asleep || !asked || visit_still(context, entry);
}

// Who fell asleep in this step is where it was filed as one that moves; in one that is taken anew, among those that rest.
bool pl_search_sleepers(const plumb_world *world, pl_box box, pl_grid_visit *visit, void *context)
{
    if (world->continuous_bodies == 0 || world->asleep_count == 0) {
        return true;
    }
    return pl_world_query(world, &world->broad.resting, box, visit, context) &&
           (!world->sleep.grid_stale ||
            pl_world_query(world, &world->broad.moving, box, visit, context));
}

double pl_search_still(pl_search *s)
{
    const plumb_world *world = s->world;
    for (uint32_t p = world->bodies.first_piece[s->mover->row]; p != PL_NONE;
         p = world->pieces.next_in_body[p]) {
        if (is_solid(world, p)) {
            take_piece(s, p);
            pl_world_query(world, &world->broad.fixed, s->box, visit_still, s);
            pl_search_sleepers(world, s->box, visit_asleep, s);
        }
    }
    return s->first;
}

//---- one body against what moves -----------------------------------------------------------------

// When the piece at hand goes too deep into one of another moving body, each on its way until it
// stops. First while both move, then while one does.
static double time_among(const pl_search *s, uint32_t piece, const pl_swept_motion *motion,
                         double stop)
{
    double thick = thickness(s, piece);
    double low = stop < s->mover->stop ? stop : s->mover->stop;
    double high = stop > s->mover->stop ? stop : s->mover->stop;
    pl_swept other = pl_swept_motion_piece(s->world, piece, motion);
    double time = time_of_hit(&s->swept, &other, 0, low, thick, 0);
    if (time < low - TINY_TIME) {
        return time;
    }
    if (high <= low) {
        return PL_SWEEP_NEVER;
    }
    pl_swept_motion stopped = pl_swept_motion_stopped(stop < high ? motion : &s->motion, low);
    pl_swept still = pl_swept_motion_piece(s->world, stop < high ? piece : s->piece, &stopped);
    time = stop < high ? time_of_hit(&s->swept, &still, low, high, thick, 0)
                       : time_of_hit(&still, &other, low, high, thick, 0);
    return time < high - TINY_TIME ? time : PL_SWEEP_NEVER;
}

static bool is_partner(const pl_search *s, uint32_t row)
{
    if (row == s->mover->row || pl_row_is_dynamic(s->world, row) == s->among_kinematic) {
        return false;
    }
    return s->among_kinematic || asks(s->world, row) || asks(s->world, s->mover->row);
}

static void meet(pl_search *s, uint32_t piece)
{
    uint32_t row = s->world->pieces.body[piece];
    if (!may_collide(s->world, s->piece, piece)) {
        return;
    }
    const pl_mover *other = pl_mover_find(s->world, row);
    pl_swept_motion motion = pl_mover_motion(s->world, row, s->dt, s->motion.ox, s->motion.oy);
    pl_shift by = take_image(s, &motion, piece);
    double time = time_among(s, piece, &motion, other != NULL ? other->stop : 1);
    pl_swept swept = pl_swept_motion_piece(s->world, piece, &motion);
    if (time < s->first && stops(s, piece, &swept, time)) {
        s->first = time;
        s->partner = row;
        s->partner_shift = by;
    }
}

static bool visit_moving(void *context, const pl_grid_entry *entry)
{
    pl_search *s = context;
    uint32_t row = s->world->pieces.body[entry->piece];
    const bool asleep = (s->world->pieces.flags[entry->piece] & PL_PIECE_ASLEEP) != 0;
    if (!asleep && is_partner(s, row)) {
        const pl_mover *other = pl_mover_find(s->world, row);
        if (other == NULL || !other->stray) {
            look_at(s, &entry->box);
            meet(s, entry->piece);
        }
    }
    return true;
}

// Strays are where no grid has them.
static void meet_stray(pl_search *s, const pl_mover *stray)
{
    const pl_bodies *b = &s->world->bodies;
    double dx = (double)stray->x - (double)s->mover->x, dy = (double)stray->y - (double)s->mover->y;
    if (pl_is_wrapped(s->world)) {
        pl_shift by = pl_wrap_shift(s->world, dx, dy);
        dx += by.x, dy += by.y;
    }
    double near = (double)stray->moved + (double)s->mover->moved + (double)b->extent[stray->row] +
                  (double)b->extent[s->mover->row];
    if (!is_partner(s, stray->row) || dx * dx + dy * dy > near * near) {
        return;
    }
    pl_swept_motion motion = pl_swept_motion_of_mover(s->world, stray, s->motion.ox, s->motion.oy);
    s->at_x = (double)s->mover->x, s->at_y = (double)s->mover->y;
    for (uint32_t p = b->first_piece[stray->row]; p != PL_NONE;
         p = s->world->pieces.next_in_body[p]) {
        take_image(s, &motion, p);
        pl_swept swept = pl_swept_motion_piece(s->world, p, &motion);
        pl_box box = pl_swept_motion_box(&motion, &swept);
        if (pl_boxes_overlap(&box, &s->box)) {
            meet(s, p);
        }
    }
}

double pl_search_among(pl_search *s)
{
    const plumb_world *world = s->world;
    for (uint32_t p = world->bodies.first_piece[s->mover->row]; p != PL_NONE;
         p = world->pieces.next_in_body[p]) {
        if (!is_solid(world, p)) {
            continue;
        }
        take_piece(s, p);
        pl_world_query(world, &world->broad.moving, s->box, visit_moving, s);
        // Kinematic movers come last.
        for (uint32_t i = world->continuous.count; i-- > 0;) {
            const pl_mover *other = &pl_movers(&world->continuous)[i];
            if (s->among_kinematic && other->row < world->dynamic_count) {
                break;
            }
            if (other->stray) {
                meet_stray(s, other);
            }
        }
    }
    return s->first;
}
