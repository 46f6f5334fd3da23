// pushes.c - forces on nodes from outside, for a step: those of the liquid.
//
// What presses a soft body together turns with it, as a pressure does. Forces that keep their directions would tip it over: with the
// mass of a skin in water the spin grew thirteenfold a step. So of the forces on a soft body the mean, mass by mass, stays as it is, and
// the rest turns as its nodes have turned in the mean since the step began, to the middle of each substep.
//
// Reads: nodes, points. Writes: pushes of points; the matrix's right side. Cost: O(nodes) a substep, where something pushes.
#include "softbody/softbody.h"

#include <math.h>
#include <string.h>

pl_soft_shove *pl_soft_make_pushes(plumb_world *world)
{
    pl_softbodies *all = &world->softbodies;
    const size_t bytes = all->node_count * sizeof(pl_soft_shove);
    if (!pl_soft_make_step(world) ||
        !pl_buffer_reserve(&world->memory, &all->step->pushes, bytes)) {
        return NULL;
    }
    all->step->pushed = true;
    return memset(all->step->pushes.data, 0, bytes);
}

void pl_soft_drop_pushes(plumb_world *world)
{
    if (world->softbodies.step != NULL) {
        world->softbodies.step->pushed = false;
    }
}

// Sums over the nodes of a soft body: where they were as the step began, where they will be; forces.
typedef struct means {
    double mass, x0, y0, x, y, fx, fy;
} means;

static void middle_of(const pl_soft_point *p, double h, double out[2])
{
    out[0] = p->x + h * p->vx / 2;
    out[1] = p->y + h * p->vy / 2;
}

static means means_of(const plumb_softbody_node *nodes, const pl_soft_point *points,
                      const pl_soft_shove *pushes, uint32_t count, double h)
{
    means sum = { .mass = 0 };
    for (uint32_t i = 0; i < count; ++i) {
        double from[2], to[2];
        pl_soft_node_place(&nodes[i], from);
        middle_of(&points[i], h, to);
        const double m = points[i].mass;
        sum.mass += m;
        sum.x0 += m * from[0], sum.y0 += m * from[1];
        sum.x += m * to[0], sum.y += m * to[1];
        sum.fx += pushes[i].x, sum.fy += pushes[i].y;
    }
    const double share = 1 / sum.mass;
    return (means){ sum.mass,      sum.x0 * share, sum.y0 * share, sum.x * share,
                    sum.y * share, sum.fx * share, sum.fy * share };
}

static void turn_one(const plumb_softbody_node *nodes, pl_soft_point *points,
                     const pl_soft_shove *pushes, uint32_t count, double h)
{
    const means at = means_of(nodes, points, pushes, count, h);
    double along = 0, across = 0;
    for (uint32_t i = 0; i < count; ++i) {
        double from[2], to[2];
        pl_soft_node_place(&nodes[i], from);
        middle_of(&points[i], h, to);
        const double ax = from[0] - at.x0, ay = from[1] - at.y0;
        const double bx = to[0] - at.x, by = to[1] - at.y, m = points[i].mass;
        along += m * (ax * bx + ay * by);
        across += m * (ax * by - ay * bx);
    }
    const double length = sqrt(along * along + across * across);
    const double c = length > 0 ? along / length : 1, s = length > 0 ? across / length : 0;
    for (uint32_t i = 0; i < count; ++i) {
        const double m = points[i].mass;
        const double x = pushes[i].x - m * at.fx, y = pushes[i].y - m * at.fy;
        points[i].push_x = m * at.fx + c * x - s * y;
        points[i].push_y = m * at.fy + s * x + c * y;
    }
}

// `since` [s] after the step began.
static void see_ways(const plumb_softbody_node *nodes, pl_soft_point *points,
                     const pl_soft_shove *pushes, uint32_t count, double since)
{
    for (uint32_t i = 0; i < count; ++i) {
        double velocity[2];
        pl_soft_node_velocity(&nodes[i], velocity);
        points[i].follow = pushes[i].follow;
        points[i].carried = pushes[i].mass;
        points[i].way_x = velocity[0] + since * pushes[i].ax;
        points[i].way_y = velocity[1] + since * pushes[i].ay;
    }
}

void pl_soft_turn_pushes(plumb_world *world, double h)
{
    const pl_softbodies *all = &world->softbodies;
    pl_soft_point *points = all->step->points.data;
    const pl_soft_shove *pushes = all->step->pushes.data;
    pl_softbody_place at = { 0 };
    for (uint32_t i = 0; i < all->count && all->step->pushed; ++i) {
        const pl_softbody *item = &pl_softbody_items(all)[i];
        const plumb_softbody_node *nodes = pl_softbody_nodes(all) + at.node;
        if (!item->asleep) {
            turn_one(nodes, points + at.point, pushes + at.node, item->nodes, h);
            see_ways(nodes, points + at.point, pushes + at.node, item->nodes,
                     h * (all->step->done + PL_SOFT_LATE));
        }
        at = pl_softbody_behind(at, item);
    }
}

static double add_push(const pl_soft_step *s, uint32_t i, double h, pl_soft_fill fill)
{
    const pl_soft_point *p = pl_soft_point_at(s, i);
    const double m = p->carried, x = h * p->push_x, y = h * p->push_y;
    if (fill != PL_SOFT_VALUE && (m > 0 || x != 0 || y != 0)) {
        const double own[4] = { m, 0, 0, m };
        pl_soft_push(s, i, x - m * p->cx, y - m * p->cy);
        if (fill == PL_SOFT_ALL) {
            pl_soft_add(s, i, i, own);
        }
    }
    return m * (p->cx * p->cx + p->cy * p->cy) / 2 - (x * p->cx + y * p->cy);
}

double pl_soft_add_pushes(const pl_soft_step *s, const pl_soft_group *g, double h,
                          pl_soft_fill fill)
{
    double energy = 0;
    for (uint32_t k = g->first_member; k < g->end_member && s->pushed; ++k) {
        const pl_soft_member *m = &pl_soft_members(s)[k];
        for (uint32_t n = 0; n < m->nodes; ++n) {
            energy += add_push(s, m->at.point + n, h, fill);
        }
    }
    return energy;
}
