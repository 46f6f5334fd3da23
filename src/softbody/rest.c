// rest.c - for how long each soft body has rested, and what is near one: what the passes of sleep (sleep/soft.c) ask.
//
// A soft body rests as bodies do (sleep/rest.c), by each of its nodes: all are slower than sleep_speed, and from one half of
// sleep_time to the next the way of none changes by more than a fiftieth of what sleep_speed makes in sleep_time.
//
// Reads: nodes, pieces. Writes: times and places of rest. Cost: O(nodes) a step of what is awake.
#include "effects/fluid.h"
#include "softbody/softbody.h"
#include "world/push.h"
#include "world/rows.h"
#include "world/softbody_list.h"

#include <math.h>

static real square(real v)
{
    return v * v;
}

bool pl_soft_is_rested(const pl_softbody *item)
{
    return !item->asleep && !item->no_sleep && item->rest_samples >= 2 && item->rest_time >= 0;
}

double pl_soft_square_speed(const plumb_world *world, const pl_softbody *item, pl_softbody_place at)
{
    const plumb_softbody_node *nodes = pl_softbody_nodes(&world->softbodies) + at.node;
    double most = 0;
    for (uint32_t i = 0; i < item->nodes; ++i) {
        const double x = (double)nodes[i].velocity.x, y = (double)nodes[i].velocity.y;
        most = x * x + y * y > most ? x * x + y * y : most;
    }
    return most;
}

//---- samples ---------------------------------------------------------------------------------------

// A sample begins where the nodes are; their ways since the last one are those to the next one to be compared with.
static bool go_on(const plumb_world *world, const pl_softbody *item, pl_softbody_place at)
{
    const real even = PL_EVEN * world->desc.sleep_speed * world->desc.sleep_time;
    const real slow = world->desc.sleep_speed * item->rest_time;
    const plumb_softbody_node *nodes = pl_softbody_nodes(&world->softbodies) + at.node;
    pl_soft_rest *rests = pl_softbody_rests(&world->softbodies) + at.node;
    bool goes_on = true;
    for (uint32_t i = 0; i < item->nodes; ++i) {
        pl_soft_rest *r = &rests[i];
        const real x = nodes[i].position.x - r->x, y = nodes[i].position.y - r->y;
        goes_on &= square(x - r->dx) + square(y - r->dy) <= square(even) &&
                   square(x) + square(y) <= square(slow);
        *r = (pl_soft_rest){ nodes[i].position.x, nodes[i].position.y, x, y };
    }
    return goes_on;
}

static void begin(const plumb_world *world, pl_softbody *item, pl_softbody_place at)
{
    go_on(world, item, at);
    item->rest_samples = 0;
    item->rest_time = 0;
}

static void rest(plumb_world *world, pl_softbody *item, pl_softbody_place at, real passed)
{
    const double slow = (double)world->desc.sleep_speed;
    if (pl_soft_square_speed(world, item, at) > slow * slow) {
        item->rest_time = PL_NOT_RESTING;
    } else if (item->rest_time < 0) {
        begin(world, item, at);
    } else {
        item->rest_time += passed;
        if (item->rest_time >= world->desc.sleep_time / 2) {
            const bool goes_on = go_on(world, item, at);
            item->rest_samples = goes_on && item->rest_samples > 0 ? 2 : 1;
            item->rest_time = 0;
            if (pl_soft_is_rested(item)) { // until it has been looked at again, and more
                world->sleep.candidate_in = world->desc.sleep_time;
            }
        }
    }
}

void pl_soft_rest_pass(plumb_world *world, real passed)
{
    const pl_softbodies *all = &world->softbodies;
    pl_softbody_place at = { 0 };
    for (uint32_t i = 0; i < all->count; ++i) {
        pl_softbody *item = &pl_softbody_items(all)[i];
        if (!item->asleep) {
            rest(world, item, at, passed);
        }
        at = pl_softbody_behind(at, item);
    }
}

//---- what is near ------------------------------------------------------------------------------------

bool pl_soft_is_blown(const plumb_world *world, const pl_softbody *item)
{
    const pl_pieces *p = &world->pieces;
    const pl_bodies *b = &world->bodies;
    bool blown = false;
    for (uint32_t i = 0; i < p->table.count && item->damping > 0 && world->sensor_pieces > 0; ++i) {
        if (p->kind[i] == PL_PIECE_FREE || (p->flags[i] & PL_PIECE_SENSOR) == 0 ||
            p->moving[i] == PL_OUT || !world->materials.fluid[p->material[i]]) {
            continue;
        }
        const pl_box box = pl_piece_tight_box(world, i);
        const uint32_t row = p->body[i];
        const bool moves = row < world->dynamic_count + world->kinematic_count &&
                           (b->vx[row] != 0 || b->vy[row] != 0 || b->w[row] != 0);
        const plumb_filter own = { p->category[i], p->mask[i], p->group[i], p->mask[i] == 0 };
        blown |= (moves || pl_fluid_is_restless(world, i)) && pl_softbody_overlaps(item, &box, 0) &&
                 plumb_filters_meet(own, item->filter);
    }
    return blown;
}

// In the frame of the piece.
static double gap_of(const plumb_world *world, const pl_soft_obstacle *o, uint32_t row,
                     const plumb_softbody_node *node)
{
    const pl_bodies *b = &world->bodies;
    double at[2], n[2];
    pl_soft_node_place(node, at);
    const double x = at[0] - ((double)b->center_x[row] + (double)b->residual_x[row]);
    const double y = at[1] - ((double)b->center_y[row] + (double)b->residual_y[row]);
    const double c = (double)b->c[row], s = (double)b->s[row];
    return pl_soft_distance(o, c * x + s * y, c * y - s * x, n) - (double)node->radius;
}

double pl_soft_gap(const plumb_world *world, const pl_softbody *item, pl_softbody_place at,
                   uint32_t row, uint32_t piece, double dt)
{
    const double most = (double)PL_SPECULATIVE, moved = pl_soft_way_of_row(world, row, dt);
    const pl_box box = pl_piece_tight_box(world, piece);
    const plumb_softbody_pin *pins = pl_softbody_pins(&world->softbodies);
    pl_soft_obstacle o;
    uint32_t pin = 0;
    double least = INFINITY;
    bool seen = false;
    if (!pl_soft_meets(world, piece, item)) {
        return INFINITY;
    }
    for (uint32_t i = 0; i < item->nodes; ++i) {
        const plumb_softbody_node *n = &pl_softbody_nodes(&world->softbodies)[at.node + i];
        const bool pinned = pin < item->pins && pins[at.pin + pin].node == i;
        const double way =
            moved + 2 * dt * (fabs((double)n->velocity.x) + fabs((double)n->velocity.y));
        const double by = most + way + (double)n->radius;
        const double x = (double)n->position.x, y = (double)n->position.y;
        pin += pinned;
        if (pinned || n->radius <= 0 || x + by < (double)box.min_x || x - by > (double)box.max_x ||
            y + by < (double)box.min_y || y - by > (double)box.max_y) {
            continue;
        }
        if (!seen) {
            pl_soft_see_piece(world, row, piece, &o);
            seen = true;
        }
        const double gap = gap_of(world, &o, row, n) - way;
        least = gap < least ? gap : least;
    }
    return least <= most ? least : INFINITY;
}
