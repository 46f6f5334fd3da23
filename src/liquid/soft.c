// soft.c - soft bodies near the liquid: their triangles as solids of the grid, what their nodes do in a step without it, what they get.
//
// What has an area keeps the liquid out: the triangles of a sheet, the inside of a ring with gas, as triangles about the mean of its
// nodes. Threads have none: ropes, nets and cloth let it through. How nodes answer to pressures is in soft_links.c.
//
// Reads: soft bodies, links, supports. Writes: solids and nodes of the grid, pushes of soft bodies. Cost: a substep of all soft bodies,
// once a step; only where one is near the liquid.
#include "core/sort.h"
#include "liquid/liquid.h"
#include "softbody/softbody.h"
#include "world/softbody_list.h"

#include <math.h>
#include <string.h>

#define LOAD   0.25 // of a layer of cells
#define FOLLOW 1.0  // of the step: dampers towards what the liquid has found (softbody/pushes.c)

static double least(double a, double b)
{
    return a < b ? a : b;
}

//---- what is near --------------------------------------------------------------------------------

static bool has_gas(const pl_softbody *item)
{
    return item->ring > 0 && item->pressure + item->ambient > 0;
}

static bool may_be_near(const pl_softbody *item, const pl_liquid_region *r)
{
    return !item->asleep || ((double)item->high.x > r->low_x && (double)item->low.x < r->high_x &&
                             (double)item->high.y > r->low_y && (double)item->low.y < r->high_y);
}

static bool is_near(const pl_softbodies *all, const pl_softbody *item, uint32_t first,
                    const pl_liquid_region *r, double dt)
{
    bool near = false;
    if ((item->triangles == 0 && !has_gas(item)) || !may_be_near(item, r)) {
        return false;
    }
    for (uint32_t i = first; i < first + item->nodes && !near; ++i) {
        const plumb_softbody_node *n = &pl_softbody_nodes(all)[i];
        const double x = (double)n->position.x, y = (double)n->position.y;
        const double way = dt * (fabs((double)n->velocity.x) + fabs((double)n->velocity.y));
        near =
            x + way > r->low_x && x - way < r->high_x && y + way > r->low_y && y - way < r->high_y;
    }
    return near;
}

static bool add_triangle(pl_memory *memory, pl_liquid_scratch *scratch, uint32_t a, uint32_t b,
                         uint32_t c, uint32_t exits)
{
    pl_liquid_grid *g = &scratch->grid;
    if (!pl_buffer_reserve(memory, &scratch->solids,
                           (g->solid_count + 1) * sizeof(pl_liquid_solid))) {
        return false;
    }
    g->solids = scratch->solids.data;
    pl_liquid_solid *s = &g->solids[g->solid_count++];
    memset(s, 0, sizeof *s);
    s->piece = s->body = PL_LIQUID_NONE;
    s->soft = true;
    s->nodes[0] = a, s->nodes[1] = b, s->nodes[2] = c;
    s->exits = exits;
    return true;
}

// Particles in a sheet leave it over the sides of its outline, and in its middle over those that lead there the shortest way.
static bool find_exits(pl_memory *memory, pl_liquid_scratch *scratch, uint32_t first)
{
    pl_liquid_grid *g = &scratch->grid;
    const uint32_t count = g->solid_count - first;
    if (!pl_buffer_reserve(memory, &scratch->sides,
                           3 * (size_t)count * (sizeof(pl_keyed) + sizeof(uint32_t)) +
                               2 * (size_t)count * sizeof(uint32_t))) {
        return false;
    }
    pl_keyed *sides = scratch->sides.data;
    uint32_t *beside = (uint32_t *)(void *)(sides + 3 * (size_t)count);
    uint32_t *depth = beside + 3 * (size_t)count, *queue = depth + count, tail = 0;
    for (uint32_t i = 0; i < 3 * count; ++i) {
        const uint32_t *n = g->solids[first + i / 3].nodes, a = n[i % 3], b = n[(i + 1) % 3];
        sides[i] = (pl_keyed){ a < b ? pl_key(a, b) : pl_key(b, a), i, 0 };
        beside[i] = PL_LIQUID_NONE;
    }
    pl_sort_keyed(sides, 3 * count);
    for (uint32_t i = 0; i + 1 < 3 * count; ++i) {
        if (sides[i].key == sides[i + 1].key) {
            beside[sides[i].value] = sides[i + 1].value / 3;
            beside[sides[i + 1].value] = sides[i].value / 3;
        }
    }
    for (uint32_t t = 0; t < count; ++t) {
        depth[t] = PL_LIQUID_NONE;
        for (uint32_t k = 0; k < 3; ++k) {
            if (beside[3 * t + k] == PL_LIQUID_NONE) {
                g->solids[first + t].exits |= UINT32_C(1) << k;
                depth[t] = 0;
            }
        }
        if (depth[t] == 0) {
            queue[tail++] = t;
        }
    }
    for (uint32_t at = 0; at < tail; ++at) {
        for (uint32_t k = 0; k < 3; ++k) {
            const uint32_t next = beside[3 * queue[at] + k];
            if (next != PL_LIQUID_NONE && depth[next] == PL_LIQUID_NONE) {
                depth[next] = depth[queue[at]] + 1;
                queue[tail++] = next;
            }
        }
    }
    for (uint32_t i = 0; i < 3 * count; ++i) {
        if (beside[i] != PL_LIQUID_NONE && depth[beside[i]] < depth[i / 3]) {
            g->solids[first + i / 3].exits |= UINT32_C(1) << i % 3;
        }
    }
    return true;
}

static bool add_sheet(plumb_world *world, pl_liquid_scratch *scratch, const pl_softbody *item,
                      pl_softbody_place at)
{
    const uint32_t first = scratch->grid.solid_count;
    for (uint32_t k = 0; k < item->triangles; ++k) {
        const plumb_softbody_triangle *t =
            &pl_softbody_triangles(&world->softbodies)[at.triangle + k];
        if (!add_triangle(&world->memory, scratch, at.node + t->a, at.node + t->b, at.node + t->c,
                          0)) {
            return false;
        }
    }
    return item->triangles == 0 || find_exits(&world->memory, scratch, first);
}

static bool add_ring(plumb_world *world, pl_liquid_scratch *scratch, const pl_softbody *item,
                     pl_softbody_place at)
{
    pl_liquid_grid *g = &scratch->grid;
    const uint32_t *ring = pl_softbody_rings(&world->softbodies) + at.ring;
    const uint32_t middle = world->softbodies.node_count + g->ring_count;
    if (!pl_buffer_reserve(&world->memory, &scratch->rings,
                           (g->ring_count + 1) * sizeof(pl_liquid_ring))) {
        return false;
    }
    g->rings = scratch->rings.data;
    g->rings[g->ring_count++] = (pl_liquid_ring){ middle, at.ring, item->ring, at.node };
    for (uint32_t k = 0; k < item->ring; ++k) {
        const uint32_t next = k + 1 < item->ring ? k + 1 : 0;
        if (!add_triangle(&world->memory, scratch, at.node + ring[k], at.node + ring[next], middle,
                          1)) {
            return false;
        }
    }
    return true;
}

static bool add_softbody(plumb_world *world, pl_liquid_scratch *scratch, const pl_softbody *item,
                         pl_softbody_place at)
{
    pl_liquid_grid *g = &scratch->grid;
    if (!pl_buffer_reserve(&world->memory, &scratch->softbodies,
                           (g->softbody_count + 1) * sizeof(pl_liquid_softbody))) {
        return false;
    }
    g->softbodies = scratch->softbodies.data;
    g->softbodies[g->softbody_count++] = (pl_liquid_softbody){ .entity = item->entity,
                                                               .first = at.node,
                                                               .count = item->nodes,
                                                               .point = at.point,
                                                               .turns = item->pins == 0 };
    return true;
}

static bool add_solids(plumb_world *world, pl_liquid_scratch *scratch,
                       const pl_liquid_region *region, double dt)
{
    const pl_softbodies *all = &world->softbodies;
    pl_softbody_place at = { 0 };
    for (uint32_t i = 0; i < all->count; ++i) {
        const pl_softbody *item = &pl_softbody_items(all)[i];
        if (is_near(all, item, at.node, region, dt)) {
            pl_softbody_rise(world, i); // what the liquid presses does not sleep
            if (!add_sheet(world, scratch, item, at) ||
                (has_gas(item) && !add_ring(world, scratch, item, at)) ||
                !add_softbody(world, scratch, item, at)) {
                return false;
            }
        }
        at = pl_softbody_behind(at, item);
    }
    return true;
}

//---- nodes ---------------------------------------------------------------------------------------

// The middle of a ring is, and moves, as its nodes do in the mean.
void pl_liquid_see_middles(pl_liquid_grid *g)
{
    for (uint32_t r = 0; r < g->ring_count; ++r) {
        const pl_liquid_ring *ring = &g->rings[r];
        pl_liquid_node sum = g->nodes[ring->middle];
        sum.x = sum.y = sum.vx = sum.vy = 0;
        for (uint32_t k = 0; k < ring->count; ++k) {
            const pl_liquid_node *n = pl_liquid_ring_node(g, ring, k);
            sum.x += n->x, sum.y += n->y, sum.vx += n->vx, sum.vy += n->vy;
        }
        const double share = 1.0 / ring->count;
        sum.x *= share, sum.y *= share, sum.vx *= share, sum.vy *= share;
        g->nodes[ring->middle] = sum;
    }
}

// Where soft bodies are, and how hard they are to turn.
static void see_softbodies(pl_liquid_grid *g)
{
    for (uint32_t k = 0; k < g->softbody_count; ++k) {
        pl_liquid_softbody *b = &g->softbodies[k];
        double x = 0, y = 0;
        b->mass = b->inertia = 0;
        for (uint32_t i = b->first; i < b->first + b->count; ++i) {
            const double m = pl_liquid_soft_mass(g, i);
            b->mass += m;
            x += m * g->nodes[i].x, y += m * g->nodes[i].y;
        }
        b->x = x / b->mass, b->y = y / b->mass;
        for (uint32_t i = b->first; i < b->first + b->count; ++i) {
            const double rx = g->nodes[i].x - b->x, ry = g->nodes[i].y - b->y;
            b->inertia += pl_liquid_soft_mass(g, i) * (rx * rx + ry * ry);
        }
    }
}

bool pl_liquid_find_soft(plumb_world *world, pl_liquid_scratch *scratch, pl_liquid_region region,
                         real dt)
{
    pl_liquid_grid *g = &scratch->grid;
    const pl_softbodies *all = &world->softbodies;
    g->node_count = g->ring_count = g->softbody_count = 0;
    if (all->count == 0 || !add_solids(world, scratch, &region, (double)dt)) {
        return all->count == 0;
    }
    const size_t count = (size_t)all->node_count + g->ring_count;
    if (g->softbody_count == 0) {
        return true;
    }
    if (!pl_buffer_reserve(&world->memory, &scratch->nodes, count * sizeof(pl_liquid_node))) {
        return false;
    }
    g->world = world;
    g->nodes = scratch->nodes.data;
    g->node_count = (uint32_t)count;
    memset(g->nodes, 0, count * sizeof *g->nodes);
    for (uint32_t i = 0; i < all->node_count; ++i) {
        const plumb_softbody_node *n = &pl_softbody_nodes(all)[i];
        pl_liquid_node *to = &g->nodes[i];
        double place[2], velocity[2];
        pl_soft_node_place(n, place);
        pl_soft_node_velocity(n, velocity);
        to->x = place[0], to->y = place[1];
        to->vx = velocity[0], to->vy = velocity[1];
    }
    pl_liquid_see_middles(g);
    see_softbodies(g);
    return true;
}

//---- what they do anyway -------------------------------------------------------------------------

// What held one in the last steps holds it again. Contacts of a soft body in the liquid bear what that presses it with: they are
// stiff for the liquid that it takes the place of, as well.
static void hold(const pl_liquid_grid *g, const pl_liquid_softbody *b, double density,
                 pl_soft_shove *pushes)
{
    const double turns = b->inertia > 0 ? b->held[2] / b->inertia : 0;
    double low_x = INFINITY, low_y = INFINITY, high_x = -INFINITY, high_y = -INFINITY;
    for (uint32_t i = b->first; i < b->first + b->count; ++i) {
        const double x = g->nodes[i].x, y = g->nodes[i].y;
        const double m = pl_liquid_soft_mass(g, i);
        pushes[i].x = m * (b->held[0] / b->mass - turns * (y - b->y));
        pushes[i].y = m * (b->held[1] / b->mass + turns * (x - b->x));
        low_x = least(low_x, x), high_x = -least(-high_x, -x);
        low_y = least(low_y, y), high_y = -least(-high_y, -y);
    }
    pushes[b->first].heavy = density * (high_x - low_x) * (high_y - low_y);
}

// What touches something does not turn freely.
static bool touches(const pl_soft_step *s, const pl_liquid_softbody *b)
{
    const pl_soft_contact *contacts = s->contacts.data;
    bool any = false;
    for (uint32_t i = 0; i < s->contact_count; ++i) {
        any |= contacts[i].point - b->point < b->count && contacts[i].force > 0;
    }
    return any;
}

// What is far lighter than the liquid beside it takes some of that along.
static void load(const pl_liquid_grid *g, double density, pl_soft_shove *pushes)
{
    const double layer = LOAD * density * (double)g->h * (double)g->h;
    for (uint32_t i = 0; i < g->soft_link_count; ++i) {
        const pl_liquid_soft_link *link = &g->soft_links[i];
        const pl_liquid_ends at = pl_liquid_ends_of(g, link->cell, link->upright);
        for (int k = 0; k < 3 && (at.before != 0 || at.behind != 0); ++k) {
            if (link->nodes[k] < g->world->softbodies.node_count) {
                pushes[link->nodes[k]].mass += layer * (double)(link->part * link->shares[k]);
            }
        }
    }
}

bool pl_liquid_foresee_soft(plumb_world *world, pl_liquid_grid *g, real dt)
{
    if (g->softbody_count == 0) {
        return true;
    }
    const double density = (double)pl_liquid_desc(&world->liquid)->density;
    pl_soft_shove *pushes = pl_soft_make_pushes(world);
    if (pushes == NULL) {
        return false;
    }
    load(g, density, pushes);
    see_softbodies(g);
    for (uint32_t k = 0; k < g->softbody_count; ++k) {
        hold(g, &g->softbodies[k], density, pushes);
    }
    if (!pl_soft_foresee(world, dt)) {
        return false;
    }
    const pl_soft_step *s = world->softbodies.step;
    for (uint32_t k = 0; k < g->softbody_count; ++k) {
        pl_liquid_softbody *b = &g->softbodies[k];
        for (uint32_t i = 0; i < b->count; ++i) {
            const pl_soft_point *end = pl_soft_point_at(s, b->point + i);
            pl_liquid_node *n = &g->nodes[b->first + i];
            n->gain[0] = pl_liquid_held(end->vx - n->vx, PL_LIQUID_SPEED);
            n->gain[1] = pl_liquid_held(end->vy - n->vy, PL_LIQUID_SPEED);
        }
        b->turns = b->turns && !touches(s, b);
    }
    return true;
}

void pl_liquid_soft_motion(const pl_liquid_grid *g, const pl_liquid_softbody *b, bool by_now,
                           double out[3])
{
    const plumb_softbody_node *nodes = pl_softbody_nodes(&g->world->softbodies);
    out[0] = out[1] = out[2] = 0;
    for (uint32_t i = b->first; i < b->first + b->count; ++i) {
        const double m = pl_liquid_soft_mass(g, i);
        const double vx = by_now ? (double)nodes[i].velocity.x : g->nodes[i].vx;
        const double vy = by_now ? (double)nodes[i].velocity.y : g->nodes[i].vy;
        out[0] += m * vx / b->mass;
        out[1] += m * vy / b->mass;
        out[2] += m * ((g->nodes[i].x - b->x) * vy - (g->nodes[i].y - b->y) * vx);
    }
    out[2] = b->inertia > 0 ? out[2] / b->inertia : 0;
}

void pl_liquid_pull_nodes(pl_liquid_grid *g, double part)
{
    for (uint32_t i = 0; i < g->node_count; ++i) {
        g->nodes[i].vx += part * g->nodes[i].gain[0];
        g->nodes[i].vy += part * g->nodes[i].gain[1];
    }
    pl_liquid_see_middles(g);
    see_softbodies(g);
    pl_liquid_follow_nodes(g);
}

void pl_liquid_place_nodes(pl_liquid_grid *g, double dt)
{
    for (uint32_t i = 0; i < g->node_count; ++i) {
        g->nodes[i].x += dt * g->nodes[i].vx;
        g->nodes[i].y += dt * g->nodes[i].vy;
    }
}

// One that is turned inside out is none.
void pl_liquid_place_triangle(const pl_liquid_grid *g, pl_liquid_solid *s)
{
    const double scale = 1 / (double)g->h;
    for (int i = 0; i < 3; ++i) {
        s->x[i] = g->nodes[s->nodes[i]].x * scale;
        s->y[i] = g->nodes[s->nodes[i]].y * scale;
    }
    const double area =
        (s->x[1] - s->x[0]) * (s->y[2] - s->y[0]) - (s->y[1] - s->y[0]) * (s->x[2] - s->x[0]);
    s->count = area > 0 ? 3 : 0;
    pl_liquid_find_reach(s);
}

//---- what they get -------------------------------------------------------------------------------

void pl_liquid_push_soft(plumb_world *world, const pl_liquid_grid *g, double dt)
{
    pl_soft_shove *pushes = g->softbody_count > 0 ? world->softbodies.step->pushes.data : NULL;
    for (uint32_t k = 0; k < g->softbody_count; ++k) {
        const pl_liquid_softbody *b = &g->softbodies[k];
        for (uint32_t i = b->first; i < b->first + b->count; ++i) {
            const pl_liquid_node *n = &g->nodes[i];
            double before[2];
            pl_soft_node_velocity(&pl_softbody_nodes(&world->softbodies)[i], before);
            pushes[i].x = pl_liquid_held(n->impulse[0] / dt, PL_LIQUID_FORCE);
            pushes[i].y = pl_liquid_held(n->impulse[1] / dt, PL_LIQUID_FORCE);
            pushes[i].ax = pl_liquid_held((n->vx - before[0]) / dt, PL_LIQUID_FORCE);
            pushes[i].ay = pl_liquid_held((n->vy - before[1]) / dt, PL_LIQUID_FORCE);
            pushes[i].follow = FOLLOW * dt;
        }
    }
}
