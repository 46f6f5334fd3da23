// near.c - which pieces are near which nodes, once a step: by boxes that what is fast sweeps.
//
// The grids of the broad phase tell what is near a soft body; before that phase, when the liquid asks, all pieces are gone through
// where something has moved since. The list is the same.
//
// Reads: points, rows, pieces, grids. Writes: bodies and obstacles of the step, what is near. Cost: O(bodies that move), and nodes
// times pieces in the box of their soft body.
#include "broad/images.h"
#include "broad/query_grids.h"
#include "core/sort.h"
#include "softbody/softbody.h"
#include "world/rows.h"

#include <math.h>

//---- bodies and obstacles ------------------------------------------------------------------------

static pl_soft_body body_of(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    const bool moves = row < world->dynamic_count + world->kinematic_count;
    const bool fixed = (b->flags[row] & PL_BODY_FIXED_ROTATION) != 0 || b->inv_inertia[row] == 0;
    return (pl_soft_body){
        .body = b->entity[row],
        .row = row,
        .slot = PL_NONE,
        .block = PL_NONE,
        .x0 = (double)b->center_x[row] + (double)b->residual_x[row],
        .y0 = (double)b->center_y[row] + (double)b->residual_y[row],
        .c0 = (double)b->c[row],
        .s0 = (double)b->s[row],
        .vx = moves ? (double)b->vx[row] : 0,
        .vy = moves ? (double)b->vy[row] : 0,
        .w = moves ? (double)b->w[row] : 0,
        .mass = (double)b->mass[row],
        .inertia = (double)b->inertia[row],
        .locked_x = (b->flags[row] & PL_BODY_LOCK_X) != 0 ? 0 : 1,
        .locked_y = (b->flags[row] & PL_BODY_LOCK_Y) != 0 ? 0 : 1,
        .locked_w = fixed ? 0 : 1,
        .asleep = pl_row_is_asleep(world, row),
    };
}

uint32_t pl_soft_body_of(plumb_world *world, uint32_t row)
{
    pl_soft_step *s = world->softbodies.step;
    pl_soft_body *bodies = s->bodies.data;
    for (uint32_t i = s->body_count; i-- > 0;) { // most often the last one
        if (bodies[i].row == row) {
            return i;
        }
    }
    if (!pl_buffer_reserve(&world->memory, &s->bodies,
                           (s->body_count + 1) * sizeof(pl_soft_body))) {
        return PL_NONE;
    }
    ((pl_soft_body *)s->bodies.data)[s->body_count] = body_of(world, row);
    return s->body_count++;
}

void pl_soft_see_piece(const plumb_world *world, uint32_t row, uint32_t piece,
                       pl_soft_obstacle *out)
{
    const pl_bodies *b = &world->bodies;
    plumb_convex shape;
    pl_piece_convex(world, piece, &shape);
    *out = (pl_soft_obstacle){ .piece = piece,
                               .body = PL_NONE,
                               .count = shape.count,
                               .friction = (double)world->pieces.friction[piece],
                               .radius = (double)shape.radius };
    for (int i = 0; i < shape.count; ++i) {
        out->x[i] = (double)shape.points[i].x - (double)b->local_x[row];
        out->y[i] = (double)shape.points[i].y - (double)b->local_y[row];
        const double r = sqrt(out->x[i] * out->x[i] + out->y[i] * out->y[i]);
        out->extent = r > out->extent ? r : out->extent;
    }
}

static bool add_obstacle(plumb_world *world, uint32_t row, uint32_t piece)
{
    pl_soft_step *s = world->softbodies.step;
    const uint32_t body = pl_soft_body_of(world, row);
    if (body == PL_NONE || !pl_buffer_reserve(&world->memory, &s->obstacles,
                                              (s->obstacle_count + 1) * sizeof(pl_soft_obstacle))) {
        return false;
    }
    pl_soft_obstacle *o = (pl_soft_obstacle *)s->obstacles.data + s->obstacle_count++;
    pl_soft_see_piece(world, row, piece, o);
    o->body = body;
    return true;
}

//---- who is near ---------------------------------------------------------------------------------

typedef struct region {
    double low_x, low_y, high_x, high_y; // [m]
} region;

static void widen(region *r, double x, double y, double by)
{
    r->low_x = x - by < r->low_x ? x - by : r->low_x;
    r->low_y = y - by < r->low_y ? y - by : r->low_y;
    r->high_x = x + by > r->high_x ? x + by : r->high_x;
    r->high_y = y + by > r->high_y ? y + by : r->high_y;
}

// [m] that a node may move in a step.
static double way_of(const plumb_world *world, const pl_soft_point *p, double dt)
{
    const double g = fabs((double)world->gravity.x) + fabs((double)world->gravity.y);
    return 2 * dt * (fabs(p->vx) + fabs(p->vy) + dt * g) + p->radius;
}

double pl_soft_way_of_row(const plumb_world *world, uint32_t row, double dt)
{
    const pl_bodies *b = &world->bodies;
    return row >= world->dynamic_count + world->kinematic_count
               ? 0
               : 2 * dt *
                     (fabs((double)b->vx[row]) + fabs((double)b->vy[row]) +
                      fabs((double)b->w[row]) * (double)b->extent[row]);
}

bool pl_soft_meets(const plumb_world *world, uint32_t piece, const pl_softbody *item)
{
    const pl_pieces *p = &world->pieces;
    plumb_filter own = { p->category[piece], p->mask[piece], p->group[piece], p->mask[piece] == 0 };
    return (p->flags[piece] & PL_PIECE_SENSOR) == 0 && plumb_filters_meet(own, item->filter);
}

static bool near_piece(plumb_world *world, const pl_softbody *item, uint32_t first, uint32_t row,
                       uint32_t piece, const region *r, double dt)
{
    pl_soft_step *s = world->softbodies.step;
    const double way = pl_soft_way_of_row(world, row, dt);
    const pl_box box = pl_piece_tight_box(world, piece);
    const region reach = { (double)box.min_x - way, (double)box.min_y - way,
                           (double)box.max_x + way, (double)box.max_y + way };
    if (reach.low_x > r->high_x || reach.high_x < r->low_x || reach.low_y > r->high_y ||
        reach.high_y < r->low_y || !pl_soft_meets(world, piece, item)) {
        return true;
    }
    uint32_t obstacle = PL_NONE;
    for (uint32_t i = first; i < first + item->nodes; ++i) {
        const pl_soft_point *p = pl_soft_points(s) + i;
        const double by = p->radius > 0 && !p->pinned ? way_of(world, p, dt) : -INFINITY;
        if (p->x + by < reach.low_x || p->x - by > reach.high_x || p->y + by < reach.low_y ||
            p->y - by > reach.high_y) {
            continue;
        }
        if (obstacle == PL_NONE) {
            obstacle = s->obstacle_count;
            if (!add_obstacle(world, row, piece)) {
                return false;
            }
        }
        if (!pl_buffer_reserve(&world->memory, &s->near_,
                               (s->near_count + 1) * sizeof(pl_soft_near))) {
            return false;
        }
        ((pl_soft_near *)s->near_.data)[s->near_count++] = (pl_soft_near){ i, obstacle };
    }
    return true;
}

// Where nodes may get to that touch something; empty: none of them do.
static region region_of(const plumb_world *world, const pl_softbody *item, uint32_t first,
                        double dt)
{
    region r = { INFINITY, INFINITY, -INFINITY, -INFINITY };
    for (uint32_t i = first; i < first + item->nodes; ++i) {
        const pl_soft_point *p = pl_soft_points(world->softbodies.step) + i;
        if (p->radius > 0 && !p->pinned) {
            widen(&r, p->x, p->y, way_of(world, p, dt));
        }
    }
    return r;
}

// Every piece, one by one.
static bool near_all(plumb_world *world, const pl_softbody *item, uint32_t first, const region *r,
                     double dt)
{
    const uint32_t rows = pl_partition_first(world, PL_PART_DISABLED);
    for (uint32_t row = 0; row < rows; ++row) {
        uint32_t piece = world->bodies.first_piece[row];
        for (; piece != PL_NONE; piece = world->pieces.next_in_body[piece]) {
            if (!near_piece(world, item, first, row, piece, r, dt)) {
                return false;
            }
        }
    }
    return true;
}

// Pieces that grids find: by rows, whatever order the grids have them in.
typedef struct finder {
    plumb_world *world;
    uint32_t count; // of keys
} finder;

static bool add_filed(void *context, const pl_grid_entry *entry)
{
    finder *f = context;
    pl_soft_step *s = f->world->softbodies.step;
    if (!pl_buffer_reserve(&f->world->memory, &s->keys, (f->count + 1) * sizeof(pl_keyed))) {
        return false;
    }
    const uint32_t row = f->world->pieces.body[entry->piece];
    ((pl_keyed *)s->keys.data)[f->count++] = (pl_keyed){ pl_key(row, entry->piece), 0, 0 };
    return true;
}

static bool add_asleep(void *context, const pl_grid_entry *entry)
{
    const finder *f = context;
    return (f->world->pieces.flags[entry->piece] & PL_PIECE_ASLEEP) == 0 ||
           add_filed(context, entry);
}

// `way` [m]: what any row may move at most.
static bool near_filed(plumb_world *world, const pl_softbody *item, uint32_t first, const region *r,
                       double way, double dt)
{
    finder f = { world, 0 };
    const pl_broad *broad = &world->broad;
    const pl_box at = { (real)r->low_x, (real)r->low_y, (real)r->high_x, (real)r->high_y };
    const pl_box from = { (real)(r->low_x - way), (real)(r->low_y - way), (real)(r->high_x + way),
                          (real)(r->high_y + way) };
    if (!pl_world_query(world, &broad->moving, from, add_filed, &f) ||
        !pl_world_query(world, &broad->resting, at, add_asleep, &f) ||
        !pl_world_query(world, &broad->fixed, at, add_filed, &f)) {
        return false;
    }
    const pl_keyed *found = world->softbodies.step->keys.data;
    if (f.count > 0) {
        pl_sort_keyed(world->softbodies.step->keys.data, f.count);
    }
    for (uint32_t i = 0; i < f.count; ++i) {
        const uint32_t row = (uint32_t)(found[i].key >> 32), piece = (uint32_t)found[i].key;
        if ((i == 0 || found[i].key != found[i - 1].key) &&
            !near_piece(world, item, first, row, piece, r, dt)) {
            return false;
        }
    }
    return true;
}

static double most_way(const plumb_world *world, double dt)
{
    double most = 0;
    for (uint32_t row = 0; row < world->dynamic_count + world->kinematic_count; ++row) {
        const double way = pl_soft_way_of_row(world, row, dt);
        most = way > most ? way : most;
    }
    return most;
}

bool pl_soft_find_near(plumb_world *world, double dt)
{
    pl_soft_step *s = world->softbodies.step;
    const bool filed = pl_step_grids_hold(world);
    const double way = filed ? most_way(world, dt) : 0;
    bool good = true;
    s->near_count = s->obstacle_count = 0;
    for (uint32_t i = 0; i < s->member_count && good; ++i) {
        pl_soft_member *m = &pl_soft_members(s)[i];
        const pl_softbody *item = &pl_softbody_items(&world->softbodies)[m->item];
        const region r = region_of(world, item, m->at.point, dt);
        m->first_near = s->near_count;
        if (r.low_x <= r.high_x) {
            good = filed ? near_filed(world, item, m->at.point, &r, way, dt)
                         : near_all(world, item, m->at.point, &r, dt);
        }
        m->end_near = s->near_count;
    }
    return good &&
           pl_buffer_reserve(&world->memory, &s->contacts, s->near_count * sizeof(pl_soft_contact));
}
