// contacts.c - contacts that push without touch, bodies that sink into one another, more deep contacts than there can be.
//
// Convex pieces that do not overlap touch like countries on a map: the graph of who touches whom is planar, and has at most
// three edges a piece (Euler). Where more are deep, many lie in one place.
//
// Reads: manifolds as the step began, impulses of its last substep, poses as it ended. Writes: nothing but its own.
// Cost: O(contacts); a distance of two pieces for each contact that pushed last of all and moved on.
#include "watchdog/watchdog.h"

#include "plumb/geometry.h"
#include "plumb/math.h"
#include "solver/solver.h"
#include "world/rows.h"
#include "world/wrap.h"

#include <string.h>

#define DEEP    0.1  // [-] of the thinner half width: a deep contact
#define SHALLOW 1e-3 // [m] no contact that is less deep is looked at
#define PUSH    0.01 // [m/s] that an impulse must have given to count as one
#define PARTING                                                                                    \
    2 // [-] of the way that bodies go in a substep, by which shapes may have parted since they touched
#define STEPS  5    // in a row in which a body must have sunk
#define GROWTH 1e-3 // [-] of its depth, by which it sinks
#define LEAST  8    // deep contacts that may be an explosion

typedef struct contact {
    const pl_manifold *manifold;
    const pl_pair *pair;
    uint32_t a, b; // body rows
} contact;

static bool is_movable(const plumb_world *world, uint32_t row)
{
    return row < world->dynamic_count + world->kinematic_count;
}

//---- without touch -------------------------------------------------------------------------------

static double inverse_mass(const plumb_world *world, uint32_t row)
{
    return row < world->dynamic_count ? (double)world->bodies.inv_mass[row] : 0;
}

// [m/s] at which points of a row move at the most.
static double speed_of(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    return is_movable(world, row) ? pl_length((double)b->vx[row], (double)b->vy[row]) +
                                        fabs((double)b->w[row]) * (double)b->extent[row]
                                  : 0;
}

static plumb_transform place_of(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    return (plumb_transform){ plumb_v2(b->x[row], b->y[row]), { b->c[row], b->s[row] } };
}

// [m/s] between the centres of two rows, as the step began or as it ended, whatever is more.
static double speed_between(const plumb_world *world, uint32_t a, uint32_t b)
{
    double from[2] = { 0, 0 }, to[2] = { 0, 0 };
    for (int i = 0; i < 2; ++i) {
        const uint32_t row = i == 0 ? a : b;
        const double sign = i == 0 ? -1 : 1;
        if (is_movable(world, row)) {
            const pl_watched *w = pl_watched_row(world, row);
            from[0] += sign * w->from_vx, from[1] += sign * w->from_vy;
            to[0] += sign * w->vx, to[1] += sign * w->vy;
        }
    }
    return pl_more(pl_length(from[0], from[1]), pl_length(to[0], to[1]));
}

static double distance_of(const plumb_world *world, const contact *c)
{
    plumb_convex a, b;
    pl_piece_convex(world, c->pair->a, &a);
    pl_piece_convex(world, c->pair->b, &b);
    const plumb_transform at_a = place_of(world, c->a);
    plumb_transform at_b = place_of(world, c->b);
    const pl_shift s = pl_wrap_shift(world, (double)at_b.p.x - (double)at_a.p.x,
                                     (double)at_b.p.y - (double)at_a.p.y);
    at_b.p = plumb_v2((real)((double)at_b.p.x + s.x), (real)((double)at_b.p.y + s.y));
    return (double)plumb_convex_distance(&a, at_a, &b, at_b).distance;
}

// Put back by the continuous pass to before it would have passed into something: the contact has it in the next step.
static bool was_stopped(const plumb_world *world, uint32_t row)
{
    return row < world->dynamic_count && pl_watched_row(world, row)->stopped;
}

static void look_at_touch(plumb_world *world, const contact *c, double dt)
{
    const double bound = pl_watchdog_bound(PLUMB_ALARM_CONTACT_WITHOUT_TOUCH);
    const double ease = inverse_mass(world, c->a) + inverse_mass(world, c->b);
    const double push = pl_more((double)c->pair->normal[0], (double)c->pair->normal[1]);
    if (!(push * ease > PUSH) || was_stopped(world, c->a) || was_stopped(world, c->b) ||
        !((speed_of(world, c->a) + speed_of(world, c->b)) * dt > bound / 2)) {
        return;
    }
    const double h = dt / world->desc.substeps;
    const double gap = distance_of(world, c) - PARTING * h * speed_between(world, c->a, c->b);
    if (gap > bound) {
        const uint32_t row = c->a < world->dynamic_count ? c->a : c->b;
        pl_watchdog_tell(world, &(pl_finding){ .kind = PLUMB_ALARM_CONTACT_WITHOUT_TOUCH,
                                               .row = row,
                                               .other = row == c->a ? c->b : c->a,
                                               .value = gap,
                                               .pass = pl_watchdog_solver(world) });
    }
}

//---- depth ---------------------------------------------------------------------------------------

static void forget_depths(const plumb_world *world)
{
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        pl_watched_row(world, row)->depth_now = 0;
    }
}

static void sink(plumb_world *world, uint32_t row, uint32_t other, double share)
{
    if (row < world->dynamic_count) {
        pl_watched *w = pl_watched_row(world, row);
        if (share > w->depth_now) {
            w->depth_now = share;
            w->deep_with = other;
        }
    }
}

// [-] how deep a contact was as the step began, of the thinner half width.
static double share_of(const plumb_world *world, const contact *c)
{
    const pl_manifold *m = c->manifold;
    const double depth = -pl_less((double)m->point[0].separation, (double)m->point[1].separation);
    if (!(depth > SHALLOW)) {
        return 0;
    }
    const double of_a = (double)pl_piece_half_width(world, c->pair->a, false);
    const double of_b = (double)pl_piece_half_width(world, c->pair->b, false);
    const double thin = pl_less(of_a > 0 ? of_a : of_b, of_b > 0 ? of_b : of_a);
    return thin > 0 ? depth / thin : 0;
}

// Of two that are deepest in one another the first one tells.
static bool is_told_by_other(const plumb_world *world, uint32_t row)
{
    const uint32_t other = pl_watched_row(world, row)->deep_with;
    return other < row && pl_watched_row(world, other)->deep_with == row;
}

static void look_at_depth(plumb_world *world, uint32_t row)
{
    pl_watched *w = pl_watched_row(world, row);
    const bool sinks = w->depth_now > w->depth * (1 + GROWTH) &&
                       w->depth_now > pl_watchdog_bound(PLUMB_ALARM_SINKING);
    w->deepening = sinks ? w->deepening + 1 : 0;
    if (w->deepening >= STEPS && !is_told_by_other(world, row)) {
        pl_watchdog_tell(world, &(pl_finding){ .kind = PLUMB_ALARM_SINKING,
                                               .row = row,
                                               .other = w->deep_with,
                                               .value = w->depth_now,
                                               .pass = pl_watchdog_solver(world) });
    }
    w->depth = w->depth_now;
}

// Of so many deep contacts, the piece that has most tells.
static void look_at_explosion(plumb_world *world, uint32_t contacts)
{
    const uint32_t *deep = world->watchdog.deep.data;
    uint32_t pieces = 0, most = PL_NONE;
    for (uint32_t p = 0; contacts >= LEAST && p < world->pieces.table.count; ++p) {
        const bool moves = deep[p] > 0 && world->pieces.body[p] < world->dynamic_count;
        pieces += deep[p] > 0;
        most = moves && (most == PL_NONE || deep[p] > deep[most]) ? p : most;
    }
    const double share = pieces > 0 ? (double)contacts / pieces : 0;
    if (share > pl_watchdog_bound(PLUMB_ALARM_PAIR_EXPLOSION) && most != PL_NONE) {
        pl_watchdog_tell(world, &(pl_finding){ .kind = PLUMB_ALARM_PAIR_EXPLOSION,
                                               .row = world->pieces.body[most],
                                               .other = PL_NONE,
                                               .value = share,
                                               .pass = "narrow phase" });
    }
}

void pl_watch_contacts(plumb_world *world, real dt)
{
    uint32_t *deep = world->watchdog.deep.data;
    uint32_t contacts = 0;
    forget_depths(world);
    memset(deep, 0, world->pieces.table.count * sizeof(uint32_t));
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        const pl_manifold *m = &pl_manifolds(&world->narrow)[i];
        const pl_pair *pair = pl_pair_of(world, m);
        const contact c = { m, pair, world->pieces.body[pair->a], world->pieces.body[pair->b] };
        if ((pair->flags & (PL_PAIR_WAIVED | PL_PAIR_PASSING | PL_PAIR_DROPPING)) != 0) {
            continue;
        }
        look_at_touch(world, &c, (double)dt);
        const double share = share_of(world, &c);
        sink(world, c.a, c.b, share);
        sink(world, c.b, c.a, share);
        if (share > DEEP) {
            ++contacts;
            ++deep[pair->a];
            ++deep[pair->b];
        }
    }
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        look_at_depth(world, row);
    }
    look_at_explosion(world, contacts);
}
