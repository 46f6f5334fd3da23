// passages.c - bodies that have passed through others within a step.
//
// Who moved by more than its slack is looked at: the middle of each of its pieces, on a straight way in the frame of
// another body's, from where both were to where both are. It has passed where the way goes in at one side and out at the
// opposite one, and the pieces overlap at neither end. Nothing is said of what turns by more than half a radian in the step: ways
// are no straight lines there.
//
// Reads: bodies as the step began and as it ended, pieces, grids. Writes: nothing. Cost: O(bodies); for each fast one a
// search of the grids, and two rays for each piece near its way.
#include "watchdog/watchdog.h"

#include "broad/images.h"
#include "broad/pairs.h"
#include "narrow/one_way.h"
#include "plumb/geometry.h"
#include "plumb/math.h"
#include "world/filter.h"
#include "world/joint_list.h"
#include "world/rows.h"

#define TURN   0.5  // [rad] of either in the step
#define FACING -0.7 // [-] of the normals where it went in and out
#define SUNK                                                                                       \
    0.25 // [-] of the thinner half width: who is deeper at either end has not passed, but is pushed apart

// Where the origin of a row was and is, relative to `about`.
typedef struct way {
    plumb_transform from, to;
    bool turns; // too much
} way;

typedef struct passage {
    plumb_world *world;
    uint32_t row, piece;
    double farthest; // [m] that any body moved in this step
    real dt;
    uint32_t passed; // row; PL_NONE: none
    double went;     // [-] its way, in half widths of the thinner of the two
} passage;

static bool is_movable(const plumb_world *world, uint32_t row)
{
    return row < world->dynamic_count + world->kinematic_count;
}

static plumb_transform place_of(const plumb_world *world, uint32_t row, double x, double y,
                                plumb_rot q)
{
    const pl_bodies *b = &world->bodies;
    const bool dynamic = row < world->dynamic_count;
    const plumb_vec2 arm =
        dynamic ? plumb_rot_apply(q, plumb_v2(b->local_x[row], b->local_y[row])) : plumb_v2(0, 0);
    return (plumb_transform){ plumb_v2((real)(x - (double)arm.x), (real)(y - (double)arm.y)), q };
}

static way way_of(const plumb_world *world, uint32_t row, real dt)
{
    const pl_bodies *b = &world->bodies;
    const plumb_transform to = { plumb_v2(b->x[row], b->y[row]), { b->c[row], b->s[row] } };
    if (!is_movable(world, row)) {
        return (way){ to, to, false };
    }
    const pl_watched *w = pl_watched_row(world, row);
    const plumb_rot q = { (real)w->from_c, (real)w->from_s };
    const double spin = pl_more(fabs(w->from_w), fabs((double)b->w[row]));
    return (way){ place_of(world, row, w->from_x, w->from_y, q), to, spin * (double)dt > TURN };
}

static double moved_by(const plumb_world *world, uint32_t row)
{
    const pl_watched *w = pl_watched_row(world, row);
    return pl_length((double)world->bodies.center_x[row] - w->from_x,
                     (double)world->bodies.center_y[row] - w->from_y);
}

static bool may_collide(const plumb_world *world, uint32_t p, uint32_t q)
{
    const uint8_t *flags = world->pieces.flags;
    const uint32_t a = world->pieces.body[p], b = world->pieces.body[q];
    if (a == b || ((flags[p] | flags[q]) & (PL_PIECE_SENSOR | PL_PIECE_ONE_WAY)) != 0 ||
        (pl_world_is_selective(world) && !pl_pieces_meet(world, p, q))) {
        return false;
    }
    const uint32_t *first = world->bodies.first_joint;
    if (first[a] != PL_NONE && first[b] != PL_NONE && pl_joints_forbid(world, a, b)) {
        return false;
    }
    const pl_pair *pair = world->edited ? pl_pairs_find_one(world, p, q) : NULL;
    return pair == NULL || (pair->flags & PL_PAIR_WAIVED) == 0;
}

// Brings the way of `b` to its image nearest to that of `a`.
static void take_image(const plumb_world *world, const way *a, way *b)
{
    const pl_shift s = pl_wrap_shift(world, (double)b->to.p.x - (double)a->to.p.x,
                                     (double)b->to.p.y - (double)a->to.p.y);
    b->from.p = plumb_v2((real)((double)b->from.p.x + s.x), (real)((double)b->from.p.y + s.y));
    b->to.p = plumb_v2((real)((double)b->to.p.x + s.x), (real)((double)b->to.p.y + s.y));
}

static plumb_vec2 seen_from(plumb_transform frame, plumb_transform body, plumb_vec2 point)
{
    const plumb_vec2 at = plumb_rot_apply(body.q, point);
    const plumb_vec2 away = plumb_vec2_sub(body.p, frame.p);
    return plumb_rot_inv_apply(frame.q, plumb_vec2_add(away, at));
}

// Whether the middle of piece p goes through piece q.
static bool goes_through(const plumb_world *world, uint32_t p, const way *of_p, uint32_t q,
                         const way *of_q)
{
    const pl_core *core = &world->pieces.core[p];
    const plumb_vec2 middle = plumb_v2(core->x, core->y);
    const plumb_vec2 from = seen_from(of_q->from, of_p->from, middle);
    const plumb_vec2 to = seen_from(of_q->to, of_p->to, middle);
    plumb_convex shape;
    plumb_convex_hit in, out;
    pl_piece_convex(world, q, &shape);
    return plumb_convex_ray(&shape, from, plumb_vec2_sub(to, from), &in) &&
           plumb_convex_ray(&shape, to, plumb_vec2_sub(from, to), &out) &&
           (double)plumb_vec2_dot(in.normal, out.normal) < FACING;
}

// [m] the lesser of two half widths; lines have none.
static double thin_of(const plumb_world *world, uint32_t p, uint32_t q)
{
    const double of_p = (double)pl_piece_half_width(world, p, false);
    const double of_q = (double)pl_piece_half_width(world, q, false);
    return pl_less(of_p > 0 ? of_p : of_q, of_q > 0 ? of_q : of_p);
}

static bool is_apart(const plumb_world *world, uint32_t p, const way *of_p, uint32_t q,
                     const way *of_q)
{
    plumb_convex a, b;
    pl_piece_convex(world, p, &a);
    pl_piece_convex(world, q, &b);
    const double before = (double)plumb_convex_distance(&a, of_p->from, &b, of_q->from).distance;
    const double after = (double)plumb_convex_distance(&a, of_p->to, &b, of_q->to).distance;
    return pl_less(before, after) > -SUNK * thin_of(world, p, q);
}

// [m] farther than this no point of one body went, seen from another.
static double relative_way(const plumb_world *world, uint32_t row, uint32_t other, double dt)
{
    const pl_bodies *b = &world->bodies;
    const pl_watched *w = pl_watched_row(world, row);
    const bool moves = is_movable(world, other);
    const pl_watched *o = moves ? pl_watched_row(world, other) : NULL;
    const double x =
        (double)b->center_x[row] - w->from_x - (moves ? (double)b->center_x[other] - o->from_x : 0);
    const double y =
        (double)b->center_y[row] - w->from_y - (moves ? (double)b->center_y[other] - o->from_y : 0);
    const double went = pl_length(x, y), reach = (double)b->extent[row];
    const double spin = pl_more(fabs(w->from_w), fabs((double)b->w[row]));
    const double turned = moves ? pl_more(fabs(o->from_w), fabs((double)b->w[other])) *
                                      (went + reach + (double)b->extent[other])
                                : 0;
    return went + (spin * reach + turned) * dt;
}

static bool look_at_pair(void *context, const pl_grid_entry *entry)
{
    passage *s = context;
    const plumb_world *world = s->world;
    const uint32_t p = s->piece, q = entry->piece, other = world->pieces.body[q];
    // To be on either side of it, it must go as far as it is thick.
    if (relative_way(world, s->row, other, (double)s->dt) <
            2 * (double)world->bodies.slack[s->row] ||
        !may_collide(world, p, q) ||
        (s->row >= world->dynamic_count && other >= world->dynamic_count)) {
        return true;
    }
    const way of_p = way_of(world, s->row, s->dt);
    way of_q = way_of(world, other, s->dt);
    take_image(world, &of_p, &of_q);
    if (of_p.turns || of_q.turns ||
        !(goes_through(world, p, &of_p, q, &of_q) || goes_through(world, q, &of_q, p, &of_p))) {
        return true;
    }
    const double thin = thin_of(world, p, q);
    s->went = thin > 0 ? moved_by(world, s->row) / thin : HUGE_VAL;
    if (s->went > pl_watchdog_bound(PLUMB_ALARM_TUNNELLING) &&
        is_apart(world, p, &of_p, q, &of_q)) {
        s->passed = other;
    }
    return s->passed == PL_NONE;
}

static pl_box box_of_way(const passage *s)
{
    const plumb_world *world = s->world;
    const pl_watched *w = pl_watched_row(world, s->row);
    const pl_box to = pl_piece_tight_box(world, s->piece);
    const double x = w->from_x - (double)world->bodies.center_x[s->row];
    const double y = w->from_y - (double)world->bodies.center_y[s->row];
    const double wide = s->farthest + (double)world->bodies.extent[s->row];
    return (pl_box){ (real)((double)to.min_x + pl_less(x, 0) - wide),
                     (real)((double)to.min_y + pl_less(y, 0) - wide),
                     (real)((double)to.max_x + pl_more(x, 0) + wide),
                     (real)((double)to.max_y + pl_more(y, 0) + wide) };
}

static void look_at_row(passage *s)
{
    plumb_world *world = s->world;
    const pl_grid *const grids[] = { &world->broad.fixed, &world->broad.moving,
                                     &world->broad.resting };
    s->passed = PL_NONE;
    for (uint32_t p = world->bodies.first_piece[s->row]; p != PL_NONE && s->passed == PL_NONE;
         p = world->pieces.next_in_body[p]) {
        if ((world->pieces.flags[p] & PL_PIECE_SENSOR) != 0) {
            continue;
        }
        s->piece = p;
        const pl_box box = box_of_way(s);
        for (int i = 0; i < 3 && s->passed == PL_NONE; ++i) {
            pl_world_query(world, grids[i], box, look_at_pair, s);
        }
    }
    if (s->passed != PL_NONE) {
        const bool moves = s->row < world->dynamic_count;
        const uint32_t who = moves ? s->row : s->passed;
        const char *pass = pl_watched_row(world, s->row)->moved;
        pl_watchdog_tell(world, &(pl_finding){ .kind = PLUMB_ALARM_TUNNELLING,
                                               .row = who,
                                               .other = moves ? s->passed : s->row,
                                               .value = s->went,
                                               .pass = pass });
    }
}

void pl_watch_passages(plumb_world *world, real dt)
{
    passage s = { .world = world, .dt = dt };
    const uint32_t count = world->dynamic_count + world->kinematic_count;
    if (!world->watchdog.filed) {
        return; // grids may be of another time
    }
    for (uint32_t row = 0; row < count; ++row) {
        const double moved = moved_by(world, row);
        s.farthest = moved > s.farthest ? moved : s.farthest;
    }
    if (!(s.farthest > (double)world->continuous.least_slack)) {
        return;
    }
    for (s.row = 0; s.row < count; ++s.row) {
        if (moved_by(world, s.row) > (double)world->bodies.slack[s.row]) {
            look_at_row(&s);
        }
    }
}
