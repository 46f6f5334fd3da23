// continuous.c - the pass: how far each fast body may go along its way, and putting it there.
//
// 1. What fast kinematic bodies may have swept over joins the fast bodies.
// 2. Each dynamic one is swept against static pieces; then, in rounds until nothing changes, bodies
//    that ask for it against one another, and jointed bodies stop together.
// 3. What a kinematic body would pass is carried along by it, as far as static pieces let it.
// 4. Bodies that were stopped are put where they stop. Their velocity stays: the contact that is
//    then there resolves it in the next step, with all that belongs to a contact.
//
// Reads: movers, end poses, pieces, grids, filters, joints. Writes: transforms of stopped bodies.
// Order: after motion, before whatever looks at the new poses. Cost: for each fast body a search of
// the grid and a few rounds of sweep.c for each piece on its way; nothing else.
#include "continuous/continuous.h"

#include <math.h>

#include "continuous/course.h"
#include "continuous/target.h"
#include "world/filter.h"
#include "world/rows.h"

// Rounds among moving bodies; a pile-up that takes longer stays where it was for one step.
#define MOST_ROUNDS 64
// A body deeper than this share of its slack is swept even if it moves slowly.
#define PRESSED_SHARE ((real)0.5)
// [-] of a step: stopping earlier by less is no change.
#define TINY_TIME 1e-9

//---- what is wanted, what there is room for ------------------------------------------------------

bool pl_continuous_wanted(const plumb_world *world, const char **reason)
{
    if (world->desc.no_continuous) {
        *reason = "the world asks for no continuous collision";
        return false;
    }
    if (world->pieces.live > world->moving_count) {
        *reason = "bodies that move fast might pass through static shapes";
        return true;
    }
    if (world->kinematic_count > 0) {
        *reason = "bodies that move fast might pass through kinematic ones";
        return true;
    }
    *reason = world->continuous_bodies > 0 ? "some body asks not to pass through moving ones"
                                           : "nothing is there that must not be passed through";
    return world->continuous_bodies > 0;
}

bool pl_continuous_reserve(plumb_world *world)
{
    size_t rows = (size_t)world->dynamic_count + world->kinematic_count;
    world->continuous.noting =
        pl_buffer_reserve(&world->memory, &world->continuous.movers, rows * sizeof(pl_mover));
    return world->continuous.noting;
}

void pl_continuous_free(pl_memory *memory, pl_continuous *continuous)
{
    pl_buffer_free(memory, &continuous->movers);
    *continuous = (pl_continuous){ 0 };
}

bool pl_pieces_collide(const plumb_world *world, uint32_t piece, uint32_t other)
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

bool pl_impact_stops(const plumb_world *world, const pl_impact_place *place)
{
    (void)world;
    (void)place;
    return true;
}

//---- movers --------------------------------------------------------------------------------------

static bool is_dynamic(const plumb_world *world, uint32_t row)
{
    return world->bodies.type[row] == PLUMB_DYNAMIC;
}

static bool is_solid(const plumb_world *world, uint32_t piece)
{
    return (world->pieces.flags[piece] & PL_PIECE_SENSOR) == 0;
}

static bool asks(const plumb_world *world, uint32_t row)
{
    return (world->bodies.flags[row] & PL_BODY_CONTINUOUS) != 0;
}

// The mover of a body row, NULL if it did not move fast. Movers are sorted by row.
static pl_mover *find_mover(const plumb_world *world, uint32_t row)
{
    pl_mover *movers = pl_movers(&world->continuous);
    uint32_t low = 0, high = world->continuous.count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (movers[middle].row < row) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < world->continuous.count && movers[low].row == row ? &movers[low] : NULL;
}

static pl_course course_of(const plumb_world *world, uint32_t row, real dt, double ox, double oy)
{
    const pl_mover *mover = find_mover(world, row);
    return mover != NULL ? pl_course_of_mover(world, mover, ox, oy)
                         : pl_course_of_row(world, row, dt, ox, oy);
}

static bool contains(const pl_box *outer, const pl_box *inner)
{
    return outer->min_x <= inner->min_x && outer->min_y <= inner->min_y &&
           outer->max_x >= inner->max_x && outer->max_y >= inner->max_y;
}

// Tells the movers whose way leaves the boxes in which the grid has them: no search of the grid
// finds those.
static void find_strays(plumb_world *world)
{
    pl_mover *movers = pl_movers(&world->continuous);
    const pl_pieces *pieces = &world->pieces;
    for (uint32_t i = 0; i < world->continuous.count; ++i) {
        pl_mover *m = &movers[i];
        pl_course course = pl_course_of_mover(world, m, (double)m->x, (double)m->y);
        for (uint32_t p = world->bodies.first_piece[m->row]; p != PL_NONE && !m->stray;
             p = pieces->next_in_body[p]) {
            pl_swept swept = pl_course_piece(world, p, &course);
            pl_box box = pl_course_box(&course, &swept);
            m->stray = !contains(&pieces->fat[p], &box);
        }
    }
}

// Marks the slow dynamic bodies over which a fast kinematic one may have swept.
typedef struct recruiting {
    plumb_world *world;
    const pl_mover *kinematic;
    uint32_t count;
} recruiting;

static bool visit_recruit(void *context, const pl_grid_entry *entry)
{
    recruiting *r = context;
    const plumb_world *world = r->world;
    uint32_t row = world->pieces.body[entry->piece];
    uint8_t *flags = &world->bodies.flags[row];
    if (row < world->dynamic_count && (*flags & PL_BODY_RECRUITED) == 0 &&
        r->kinematic->moved > world->bodies.slack[r->kinematic->row] + world->bodies.slack[row] &&
        find_mover(world, row) == NULL) {
        *flags |= PL_BODY_RECRUITED;
        ++r->count;
    }
    return true;
}

static uint32_t mark_recruits(plumb_world *world)
{
    const pl_mover *movers = pl_movers(&world->continuous);
    recruiting r = { .world = world };
    for (uint32_t i = world->continuous.count; i-- > 0 && movers[i].row >= world->dynamic_count;) {
        r.kinematic = &movers[i];
        double ox = (double)movers[i].x, oy = (double)movers[i].y;
        pl_course course = pl_course_of_mover(world, r.kinematic, ox, oy);
        for (uint32_t p = world->bodies.first_piece[movers[i].row]; p != PL_NONE;
             p = world->pieces.next_in_body[p]) {
            pl_swept swept = pl_course_piece(world, p, &course);
            pl_grid_query(&world->broad.moving, pl_course_box(&course, &swept), visit_recruit, &r);
        }
    }
    return r.count;
}

// Slow bodies that are pressed deep into what dynamics does not move might be through it in a step or
// two: they are held as fast ones are.
static uint32_t mark_pressed(plumb_world *world)
{
    uint32_t count = 0;
    const pl_bodies *b = &world->bodies;
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        const pl_manifold *m = &pl_manifolds(&world->narrow)[i];
        bool a_moves = m->body_a < world->dynamic_count, b_moves = m->body_b < world->dynamic_count;
        uint32_t row = a_moves ? m->body_a : m->body_b;
        real s0 = m->point[0].separation, s1 = m->point[1].separation;
        real depth = s0 < s1 ? -s0 : -s1;
        if (a_moves != b_moves && depth > b->slack[row] * PRESSED_SHARE &&
            (b->flags[row] & PL_BODY_RECRUITED) == 0 && find_mover(world, row) == NULL) {
            b->flags[row] |= PL_BODY_RECRUITED;
            ++count;
        }
    }
    return count;
}

static pl_mover recruit(plumb_world *world, uint32_t row, real dt)
{
    pl_course course = pl_course_of_row(world, row, dt, 0, 0);
    pl_place start = pl_course_place(world, row, &course, 0);
    world->bodies.flags[row] &= (uint8_t)~PL_BODY_RECRUITED;
    return (pl_mover){ .row = row,
                       .x = (real)start.x,
                       .y = (real)start.y,
                       .c = (real)start.c,
                       .s = (real)start.s,
                       .angle = (real)course.angle,
                       .stop = 1 };
}

// Merges the marked bodies into the list, from the back.
static void join_recruits(plumb_world *world, real dt, uint32_t count)
{
    pl_mover *movers = pl_movers(&world->continuous);
    uint32_t from = world->continuous.count;
    world->continuous.count += count;
    uint32_t row = world->dynamic_count;
    for (uint32_t to = world->continuous.count; to > from;) {
        if (from > 0 && movers[from - 1].row >= row) {
            movers[--to] = movers[--from];
        } else if ((world->bodies.flags[--row] & PL_BODY_RECRUITED) != 0) {
            movers[--to] = recruit(world, row, dt);
        }
    }
}

//---- one body against what stands still ----------------------------------------------------------

// A mover that is swept.
typedef struct search {
    const plumb_world *world;
    const pl_mover *mover;
    pl_course course;
    uint32_t piece; // the one whose turn it is
    pl_swept swept;
    pl_box box;      // of its way
    double reach;    // [m] of it from the pivot
    real half_width; // [m] of it
    double sunk;     // [m] how deep the body lies in static pieces at the start; < 0: not known
    double first;    // the first hit so far; only what comes before it matters
    // Among moving bodies:
    real dt;
    bool
        among_kinematic; // looks for kinematic bodies; otherwise for dynamic ones where either asks
    uint32_t partner;    // row of the body that is hit first
} search;

static search search_of(const plumb_world *world, const pl_mover *mover)
{
    search s = { .world = world, .mover = mover, .sunk = -1, .first = 1 };
    s.course = pl_course_of_mover(world, mover, (double)mover->x, (double)mover->y);
    return s;
}

static void take_piece(search *s, uint32_t piece)
{
    s->piece = piece;
    s->swept = pl_course_piece(s->world, piece, &s->course);
    s->box = pl_course_box(&s->course, &s->swept);
    s->half_width = pl_piece_half_width(s->world, piece, false);
    double reach_sq = 0;
    for (int i = 0; i < s->swept.count; ++i) {
        double x = s->swept.x[i], y = s->swept.y[i];
        reach_sq = x * x + y * y > reach_sq ? x * x + y * y : reach_sq;
    }
    s->reach = sqrt(reach_sq) + s->swept.radius;
}

// Whether the piece, wherever it has turned, stays clear of a box to one side of its way.
static bool goes_by(const search *s, const pl_box *box)
{
    double dx = s->swept.dx, dy = s->swept.dy;
    double hx = ((double)box->max_x - (double)box->min_x) / 2;
    double hy = ((double)box->max_y - (double)box->min_y) / 2;
    double x = (double)box->min_x + hx - s->course.ox - s->swept.px;
    double y = (double)box->min_y + hy - s->course.oy - s->swept.py;
    double aside = fabs(dx * y - dy * x) - fabs(dx) * hy - fabs(dy) * hx;
    return aside > 0 && aside * aside > s->reach * s->reach * (dx * dx + dy * dy);
}

static pl_swept still_piece(const search *s, uint32_t piece)
{
    pl_course course =
        pl_course_of_row(s->world, s->world->pieces.body[piece], 0, s->course.ox, s->course.oy);
    return pl_course_piece(s->world, piece, &course);
}

static double thickness(const search *s, uint32_t other)
{
    return (double)s->half_width + (double)pl_piece_half_width(s->world, other, false);
}

static bool visit_depth(void *context, const pl_grid_entry *entry)
{
    search *s = context;
    if (pl_pieces_collide(s->world, s->piece, entry->piece)) {
        pl_swept other = still_piece(s, entry->piece);
        double depth = -pl_sweep_gap(&s->swept, &other, 0).distance;
        if (depth > s->sunk && !pl_target_is_lost(thickness(s, entry->piece), depth)) {
            s->sunk = depth;
        }
    }
    return true;
}

// How deep the body lies in static pieces at the start.
static double depth_at_start(const search *s)
{
    search at = *s;
    at.course = pl_course_stopped(&s->course, 0);
    at.sunk = 0;
    for (uint32_t p = s->world->bodies.first_piece[s->mover->row]; p != PL_NONE;
         p = s->world->pieces.next_in_body[p]) {
        take_piece(&at, p);
        pl_grid_query(&s->world->broad.fixed, at.box, visit_depth, &at);
    }
    return at.sunk;
}

// When `a` goes too deep into `b`; `sunk` lets it go so much deeper.
static double time_of_hit(const pl_swept *a, const pl_swept *b, double from, double to,
                          double thick, double sunk)
{
    double depth = -pl_sweep_gap(a, b, from).distance;
    if (pl_target_is_lost(thick, depth)) {
        return PL_SWEEP_NEVER; // it has no side that could be told
    }
    pl_target target = pl_target_of(thick, depth, sunk);
    return pl_sweep_first(a, b, from, to, target.distance, target.tolerance);
}

static bool stops(const search *s, uint32_t other, const pl_swept *other_swept, double time)
{
    pl_gap gap = pl_sweep_gap(&s->swept, other_swept, time);
    double x, y;
    pl_sweep_point(&s->swept, time, -gap.nx, -gap.ny, &x, &y);
    return pl_impact_stops(s->world, &(pl_impact_place){ .piece = s->piece,
                                                         .other = other,
                                                         .x = s->course.ox + x,
                                                         .y = s->course.oy + y,
                                                         .nx = gap.nx,
                                                         .ny = gap.ny });
}

static bool visit_still(void *context, const pl_grid_entry *entry)
{
    search *s = context;
    if (goes_by(s, &entry->box) || !pl_pieces_collide(s->world, s->piece, entry->piece)) {
        return true;
    }
    pl_swept other = still_piece(s, entry->piece);
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

// The first time at which the mover would go too deep into a static piece; 1: never.
static double first_still(search *s)
{
    const plumb_world *world = s->world;
    for (uint32_t p = world->bodies.first_piece[s->mover->row]; p != PL_NONE;
         p = world->pieces.next_in_body[p]) {
        if (is_solid(world, p)) {
            take_piece(s, p);
            pl_grid_query(&world->broad.fixed, s->box, visit_still, s);
        }
    }
    return s->first;
}

//---- one body against what moves -----------------------------------------------------------------

// When the piece at hand goes too deep into one of another moving body, each on its way until it
// stops. First while both move, then while one does.
static double time_among(const search *s, uint32_t piece, const pl_course *course, double stop)
{
    double thick = thickness(s, piece);
    double low = stop < s->mover->stop ? stop : s->mover->stop;
    double high = stop > s->mover->stop ? stop : s->mover->stop;
    pl_swept other = pl_course_piece(s->world, piece, course);
    double time = time_of_hit(&s->swept, &other, 0, low, thick, 0);
    if (time < low - TINY_TIME) {
        return time;
    }
    if (high <= low) {
        return PL_SWEEP_NEVER;
    }
    pl_course stopped = pl_course_stopped(stop < high ? course : &s->course, low);
    pl_swept still = pl_course_piece(s->world, stop < high ? piece : s->piece, &stopped);
    time = stop < high ? time_of_hit(&s->swept, &still, low, high, thick, 0)
                       : time_of_hit(&still, &other, low, high, thick, 0);
    return time < high - TINY_TIME ? time : PL_SWEEP_NEVER;
}

static bool is_partner(const search *s, uint32_t row)
{
    if (row == s->mover->row || is_dynamic(s->world, row) == s->among_kinematic) {
        return false;
    }
    return s->among_kinematic || asks(s->world, row) || asks(s->world, s->mover->row);
}

static void meet(search *s, uint32_t piece)
{
    uint32_t row = s->world->pieces.body[piece];
    if (!pl_pieces_collide(s->world, s->piece, piece)) {
        return;
    }
    const pl_mover *other = find_mover(s->world, row);
    pl_course course = course_of(s->world, row, s->dt, s->course.ox, s->course.oy);
    double time = time_among(s, piece, &course, other != NULL ? other->stop : 1);
    pl_swept swept = pl_course_piece(s->world, piece, &course);
    if (time < s->first && stops(s, piece, &swept, time)) {
        s->first = time;
        s->partner = row;
    }
}

static bool visit_moving(void *context, const pl_grid_entry *entry)
{
    search *s = context;
    uint32_t row = s->world->pieces.body[entry->piece];
    if (is_partner(s, row)) {
        const pl_mover *other = find_mover(s->world, row);
        if (other == NULL || !other->stray) {
            meet(s, entry->piece);
        }
    }
    return true;
}

// Strays are where no grid has them.
static void meet_stray(search *s, const pl_mover *stray)
{
    const pl_bodies *b = &s->world->bodies;
    double dx = (double)stray->x - (double)s->mover->x, dy = (double)stray->y - (double)s->mover->y;
    double near = (double)stray->moved + (double)s->mover->moved + (double)b->extent[stray->row] +
                  (double)b->extent[s->mover->row];
    if (!is_partner(s, stray->row) || dx * dx + dy * dy > near * near) {
        return;
    }
    pl_course course = pl_course_of_mover(s->world, stray, s->course.ox, s->course.oy);
    for (uint32_t p = b->first_piece[stray->row]; p != PL_NONE;
         p = s->world->pieces.next_in_body[p]) {
        pl_swept swept = pl_course_piece(s->world, p, &course);
        pl_box box = pl_course_box(&course, &swept);
        if (pl_boxes_overlap(&box, &s->box)) {
            meet(s, p);
        }
    }
}

// The first time at which the mover goes too deep into a moving partner; 1: never.
static double first_among(search *s)
{
    const plumb_world *world = s->world;
    for (uint32_t p = world->bodies.first_piece[s->mover->row]; p != PL_NONE;
         p = world->pieces.next_in_body[p]) {
        if (!is_solid(world, p)) {
            continue;
        }
        take_piece(s, p);
        pl_grid_query(&world->broad.moving, s->box, visit_moving, s);
        for (uint32_t i = 0; i < world->continuous.count; ++i) {
            if (pl_movers(&world->continuous)[i].stray) {
                meet_stray(s, &pl_movers(&world->continuous)[i]);
            }
        }
    }
    return s->first;
}

//---- all bodies ----------------------------------------------------------------------------------

static void sweep_still(plumb_world *world)
{
    pl_mover *movers = pl_movers(&world->continuous);
    for (uint32_t i = 0; i < world->continuous.count && is_dynamic(world, movers[i].row); ++i) {
        search s = search_of(world, &movers[i]);
        movers[i].stop = first_still(&s);
    }
}

// Which of two bodies that hit each other stops: the one that still moves; of two, the lighter;
// of equals, the faster. The other one stops only if it then is found to run into it.
static pl_mover *who_stops(const plumb_world *world, pl_mover *a, pl_mover *b, double time)
{
    if (b == NULL || b->stop <= time) {
        return a;
    }
    if (a->stop <= time) {
        return b;
    }
    real mass_a = world->bodies.inv_mass[a->row], mass_b = world->bodies.inv_mass[b->row];
    if (mass_a < mass_b || mass_a > mass_b) {
        return mass_a > mass_b ? a : b;
    }
    return a->moved >= b->moved ? a : b;
}

// One round over all pairs in which either body asks; true when some body now stops earlier.
static bool sweep_among(plumb_world *world, real dt)
{
    bool changed = false;
    pl_mover *movers = pl_movers(&world->continuous);
    for (uint32_t i = 0; i < world->continuous.count && is_dynamic(world, movers[i].row); ++i) {
        search s = search_of(world, &movers[i]);
        s.dt = dt;
        double time = first_among(&s);
        if (time < 1) {
            pl_mover *other = find_mover(world, s.partner);
            pl_mover *stopped = who_stops(world, &movers[i], other, time);
            changed |= stopped->stop > time;
            stopped->stop = stopped->stop > time ? time : stopped->stop;
        }
    }
    return changed;
}

// Bodies with a joint between them stop together, so that it is not torn. True when one changed.
static bool share_stops(plumb_world *world)
{
    bool changed = false;
    for (uint32_t i = 0; i < world->joints.count; ++i) {
        const pl_joint *j = &pl_joint_items(&world->joints)[i];
        if (plumb_is_null(j->entity) || plumb_is_null(j->a.body) || plumb_is_null(j->b.body)) {
            continue;
        }
        pl_mover *a = find_mover(world, pl_body_row(world, j->a.body));
        pl_mover *b = find_mover(world, pl_body_row(world, j->b.body));
        if (a == NULL || b == NULL || !is_dynamic(world, a->row) || !is_dynamic(world, b->row)) {
            continue;
        }
        changed |= a->stop < b->stop || b->stop < a->stop;
        a->stop = b->stop = a->stop < b->stop ? a->stop : b->stop;
    }
    return changed;
}

// Until no body stops earlier for another. Each round stops some body earlier; where they do not
// come to an end, all fast bodies stay where the step began.
static void settle_stops(plumb_world *world, real dt)
{
    const bool asked = world->continuous_bodies > 0;
    for (int round = 0; round < MOST_ROUNDS; ++round) {
        bool changed = asked && sweep_among(world, dt);
        while (world->joints.live > 0 && share_stops(world)) {
            changed = true;
        }
        if (!changed || !asked) {
            return;
        }
    }
    for (uint32_t i = 0; i < world->continuous.count; ++i) {
        pl_movers(&world->continuous)[i].stop = 0;
    }
}

static void put(plumb_world *world, uint32_t row, pl_place at)
{
    pl_bodies *b = &world->bodies;
    b->center_x[row] = (real)at.x;
    b->center_y[row] = (real)at.y;
    b->low_x[row] = (real)(at.x - (double)b->center_x[row]);
    b->low_y[row] = (real)(at.y - (double)b->center_y[row]);
    b->c[row] = (real)at.c;
    b->s[row] = (real)at.s;
    pl_body_update_origin(world, row);
    ++world->continuous.stopped_count;
}

// From `time` on the mover keeps its place on a kinematic body, as far as static pieces let it.
static void carry(plumb_world *world, const search *s, double time)
{
    uint32_t row = s->mover->row;
    pl_course by = course_of(world, s->partner, s->dt, s->course.ox, s->course.oy);
    double stop = time < s->mover->stop ? time : s->mover->stop;
    pl_place from = pl_course_place(world, row, &s->course, stop);
    pl_place by_from = pl_course_place(world, s->partner, &by, time);
    pl_place by_to = pl_course_place(world, s->partner, &by, 1);
    double angle = by.angle * (1 - time), c = by_from.c * by_to.c + by_from.s * by_to.s,
           sine = by_from.c * by_to.s - by_from.s * by_to.c;
    double rx = from.x - by_from.x, ry = from.y - by_from.y;
    pl_place to = { by_to.x + c * rx - sine * ry, by_to.y + sine * rx + c * ry,
                    c * from.c - sine * from.s, c * from.s + sine * from.c };
    search leg = search_of(world, s->mover);
    leg.course = pl_course_between(world, row, from, to, angle);
    put(world, row, pl_course_place(world, row, &leg.course, first_still(&leg)));
}

static void finish(plumb_world *world, real dt)
{
    const pl_mover *movers = pl_movers(&world->continuous);
    for (uint32_t i = 0; i < world->continuous.count && is_dynamic(world, movers[i].row); ++i) {
        search s = search_of(world, &movers[i]);
        s.dt = dt;
        s.among_kinematic = true;
        double time = world->kinematic_count > 0 ? first_among(&s) : 1;
        if (time < 1) {
            carry(world, &s, time);
        } else if (movers[i].stop < 1) {
            put(world, movers[i].row,
                pl_course_place(world, movers[i].row, &s.course, movers[i].stop));
        }
    }
}

void pl_continuous_run(plumb_world *world, real dt)
{
    const pl_continuous *c = &world->continuous;
    uint32_t recruits = world->kinematic_count > 0 ? mark_recruits(world) : 0;
    if (world->narrow.max_penetration > c->least_slack * PRESSED_SHARE) {
        recruits += mark_pressed(world);
    }
    if (c->count + recruits == 0) {
        return;
    }
    join_recruits(world, dt, recruits);
    if (world->kinematic_count > 0 || world->continuous_bodies > 0) {
        find_strays(world);
    }
    sweep_still(world);
    if (world->joints.live > 0 || world->continuous_bodies > 0) {
        settle_stops(world, dt);
    }
    finish(world, dt);
}
