// beam.c - see beam.h.
//
// A line lies in a convex piece along one transit; its ends are what a beam meets. Which medium is behind an end is asked at a point a
// gap's width beyond it, so that nothing is remembered of shapes but the medium that the beam runs in: shapes may overlap,
// touch and lie in one another in any way.
//
// Reads: grids, pieces, poses, materials. Writes: the answer. Cost: cells along the way + O(corners) a box met; of a
// look O(corners) a box about the point.
#include "query/beam.h"

#include "query/transit.h"
#include "query/walk.h"

#include <math.h>

// Roundings of a coordinate that the end of a transit may be off.
#define ROUNDINGS (64 * 2.3e-16)

typedef struct search {
    pl_query *q;
    const pl_beam *beam;
    pl_beam_event last, best;
    pl_walk walk;
} search;

// Sensors are seen as fluids and the like only: what has no index there would be a shadow of nothing.
static bool sees(const pl_query *q, uint32_t piece)
{
    return pl_query_sees(q, piece) && ((q->world->pieces.flags[piece] & PL_PIECE_SENSOR) == 0 ||
                                       pl_beam_passes(q->world, piece));
}

// By place; what lies in one place by kind, then by shape, so that no order of a grid shows.
static bool is_before(const pl_beam_event *a, const pl_beam_event *b)
{
    if (a->at != b->at) {
        return a->at < b->at;
    }
    if (a->kind != b->kind) {
        return a->kind < b->kind;
    }
    return a->slot != b->slot ? a->slot < b->slot : a->piece < b->piece;
}

static void offer(search *s, uint32_t piece, pl_beam_event_kind kind, double at, double nx,
                  double ny)
{
    const plumb_shape shape = s->q->world->pieces.shape[piece];
    const pl_beam_event event = { at, nx, ny, kind, shape.entity.index, piece };
    if (at <= s->beam->length && is_before(&s->last, &event) &&
        (s->best.piece == PL_NONE || is_before(&event, &s->best)) &&
        pl_query_accepts(s->q, shape)) {
        s->best = event;
        s->walk.limit = at / s->beam->length;
    }
}

static bool lets_pass(const search *s, uint32_t piece, double nx, double ny)
{
    return pl_query_passes(s->q, piece, (plumb_vec2){ (plumb_real)nx, (plumb_real)ny });
}

static void meet_opaque(search *s, uint32_t piece, const pl_transit *transit, bool starts_in)
{
    if (transit->enter > 0 || !starts_in) {
        if (!lets_pass(s, piece, transit->enter_x, transit->enter_y)) {
            offer(s, piece, PL_BEAM_OPAQUE, pl_most(transit->enter, 0), transit->enter_x,
                  transit->enter_y);
        }
    } else if (!lets_pass(s, piece, 0, 0)) {
        offer(s, piece, PL_BEAM_OPAQUE, 0, 0, 0);
    }
}

static bool visit_way(void *context, const pl_grid_entry *entry)
{
    search *s = context;
    const pl_beam *b = s->beam;
    const plumb_world *world = s->q->world;
    const uint32_t piece = entry->piece;
    if (!sees(s->q, piece)) {
        return true;
    }
    plumb_convex convex;
    pl_round round;
    pl_transit transit;
    pl_piece_convex(world, piece, &convex);
    pl_transit_round(&convex, pl_query_frame_of(world, entry), b->x, b->y, &round);
    if (!pl_transit_of(&round, b->dx, b->dy, &transit)) {
        return true;
    }
    // In a world that wraps around another image of the piece may lie ahead.
    const bool same =
        piece == b->piece && !(pl_is_wrapped(world) && transit.enter > (double)PLUMB_WELD_DISTANCE);
    if (same && b->side == PL_BEAM_OUTWARD) {
        return true;
    }
    if (round.count == 2 && round.radius == 0) {
        if (transit.enter > 0 && !lets_pass(s, piece, transit.enter_x, transit.enter_y)) {
            offer(s, piece, PL_BEAM_LINE, transit.enter, transit.enter_x, transit.enter_y);
        }
        return true;
    }
    const bool inward = same && b->side == PL_BEAM_INWARD;
    // How deep the start lies below the surface at which the beam would leave: what stands on a face that it goes away from is not in.
    const double depth = transit.leave * (b->dx * transit.leave_x + b->dy * transit.leave_y);
    const double slack = ROUNDINGS * (fabs(b->x) + fabs(b->y) + fabs(transit.leave));
    if (!inward && transit.enter <= 0 && depth <= slack) {
        return true;
    }
    if (!pl_beam_passes(world, piece)) {
        meet_opaque(s, piece, &transit, transit.enter < -slack);
        return true;
    }
    if (!inward && transit.enter > 0) {
        offer(s, piece, PL_BEAM_ENTERS, transit.enter, transit.enter_x, transit.enter_y);
    }
    offer(s, piece, PL_BEAM_LEAVES, pl_most(transit.leave, 0), -transit.leave_x, -transit.leave_y);
    return true;
}

// Goes through all grids that the filter sees.
static void walk_grids(const pl_query *q, pl_walk *walk, pl_grid_visit *visit, void *context)
{
    const pl_grid *grids[PL_QUERY_GRIDS];
    const int count = pl_query_grids(q, grids);
    for (int i = 0; i < count; ++i) {
        pl_query_walk(q, grids[i], walk, visit, context);
    }
}

pl_beam_event pl_beam_next(pl_query *q, const pl_beam *beam, const pl_beam_event *last)
{
    const double ex = beam->x + beam->length * beam->dx, ey = beam->y + beam->length * beam->dy;
    search s = { .q = q, .beam = beam, .last = *last, .best = { .piece = PL_NONE } };
    s.walk = pl_walk_make((plumb_vec2){ (plumb_real)beam->x, (plumb_real)beam->y },
                          (plumb_vec2){ (plumb_real)ex, (plumb_real)ey });
    walk_grids(q, &s.walk, visit_way, &s);
    return s.best;
}

//---- what is at a place ---------------------------------------------------------------------------

typedef struct place {
    pl_query *q;
    double x, y;
    uint32_t without; // a piece that is left out
    pl_beam_place found;
    uint32_t best; // the piece whose medium it is
} place;

static double area_of(const plumb_world *world, uint32_t piece)
{
    const uint32_t first = pl_shape_piece(world, world->pieces.shape[piece]);
    return (double)world->pieces.area[first].mass;
}

// Whether the medium of piece a counts where it overlaps b.
static bool counts_before(const plumb_world *world, uint32_t a, uint32_t b)
{
    const pl_materials *m = &world->materials;
    const uint32_t i = world->pieces.material[a], k = world->pieces.material[b];
    const double area_a = area_of(world, a), area_b = area_of(world, b);
    if (area_a != area_b) {
        return area_a < area_b;
    }
    if (m->refractive_index[i] != m->refractive_index[k]) {
        return m->refractive_index[i] > m->refractive_index[k];
    }
    if (m->absorption[i] != m->absorption[k]) {
        return m->absorption[i] > m->absorption[k];
    }
    return m->reflectance[i] != m->reflectance[k] ? m->reflectance[i] > m->reflectance[k] : i < k;
}

static void take(place *p, uint32_t piece)
{
    const plumb_world *world = p->q->world;
    if (!pl_beam_passes(world, piece)) {
        p->found.opaque = p->found.opaque < piece ? p->found.opaque : piece;
    } else if (p->best == PL_NONE || counts_before(world, piece, p->best)) {
        p->best = piece;
        p->found.medium = world->pieces.material[piece];
    }
}

static bool visit_point(void *context, const pl_grid_entry *entry)
{
    place *p = context;
    const uint32_t piece = entry->piece;
    if (piece == p->without || !sees(p->q, piece)) {
        return true;
    }
    plumb_convex convex;
    pl_round round;
    pl_piece_convex(p->q->world, piece, &convex);
    pl_transit_round(&convex, pl_query_frame_of(p->q->world, entry), p->x, p->y, &round);
    if (pl_transit_holds(&round) && pl_query_accepts(p->q, p->q->world->pieces.shape[piece])) {
        take(p, piece);
    }
    return true;
}

pl_beam_place pl_beam_look(pl_query *q, double x, double y, const pl_beam_event *event)
{
    place p = { q, x, y, event != NULL ? event->piece : PL_NONE, { PL_NONE, PL_NONE }, PL_NONE };
    if (event != NULL && event->kind == PL_BEAM_ENTERS) {
        take(&p, event->piece);
    }
    const plumb_vec2 at = { (plumb_real)x, (plumb_real)y };
    pl_walk walk = pl_walk_make(at, at);
    walk_grids(q, &walk, visit_point, &p);
    return p.found;
}

double pl_beam_gap(double x, double y)
{
    return pl_most((double)PLUMB_WELD_DISTANCE,
                   8 * (double)PLUMB_REAL_EPSILON * pl_most(fabs(x), fabs(y)));
}
