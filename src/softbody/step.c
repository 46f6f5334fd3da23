// step.c - soft bodies in a step: gathered before the graph, taken through the substeps with the bodies that they pull or
// touch as unknowns of one implicit system, stored when nothing can fail any more.
//
// In each substep Newton's iteration finds what it adds to velocities, u: M u = h f(u). All bodies that are near are of
// cluster 0, which one thread solves; they get u / h as their acceleration, and the rigid solver moves them by
// x + h v + h^2 a / 2 just as the system does. Where there are none, all substeps run behind the solver.
//
// Reads: soft bodies, rows, pieces, solver bodies. Writes: accelerations; nodes and edges; times of rest. Order: before
// "called", behind the graph, with the forces of the moment, behind "motion". Cost: see DECISIONS.md.
#include "core/sort.h"
#include "math/trig.h"
#include "effects/effects.h"
#include "schema/passes.h"
#include "softbody/softbody.h"
#include "world/island.h"
#include "world/substep.h"
#include "world/rows.h"

#include <math.h>
#include <string.h>

#define MOST_PASSES 48
#define SECTIONS    14 // of a way, by 0.618 each
#define CREEP                                                                                      \
    2.5e-3 // of what gravity adds to velocities: the slip at which friction is all that Coulomb's law gives
#define ENOUGH_OF_IT                                                                               \
    0.25 // of what is gained along the whole way, where a half is what Newton's step promises
#define SMALL 1e-3 // of what gravity adds to velocities: what the last pass may
#define TOLD  0.1  // likewise: what is told, where passes end before

bool pl_want_softbodies(const plumb_world *world, const char **reason)
{
    const bool wanted = world->softbodies.count > 0;
    *reason = wanted ? "there are soft bodies" : "there is no soft body";
    return wanted;
}

void pl_softbodies_free(pl_memory *memory, pl_softbodies *s)
{
    pl_buffer *buffers[] = { &s->items,     &s->nodes, &s->edges, &s->bends,
                             &s->triangles, &s->rings, &s->pins };
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; ++i) {
        pl_buffer_free(memory, buffers[i]);
    }
    if (s->step != NULL) {
        pl_soft_step *t = s->step;
        pl_buffer *scratch[] = { &t->points,   &t->bodies, &t->obstacles, &t->near_,
                                 &t->contacts, &t->keys,   &t->order,     &t->index,
                                 &t->numbers,  &t->shapes, &t->rows,      &t->pulls };
        for (size_t i = 0; i < sizeof scratch / sizeof scratch[0]; ++i) {
            pl_buffer copy = *scratch[i];
            pl_buffer_free(memory, &copy);
        }
        pl_resize(memory, t, sizeof *t, 0);
    }
}

static pl_soft_point *points_of(const pl_soft_step *s)
{
    return s->points.data;
}

static pl_soft_body *bodies_of(const pl_soft_step *s)
{
    return s->bodies.data;
}

//---- gathered ------------------------------------------------------------------------------------

static void gather_nodes(const pl_softbodies *all, const pl_softbody *item, uint32_t first)
{
    double heavy = 0;
    for (uint32_t i = first; i < first + item->nodes; ++i) {
        heavy += (double)pl_softbody_nodes(all)[i].mass;
    }
    for (uint32_t i = first; i < first + item->nodes; ++i) {
        const plumb_softbody_node *n = &pl_softbody_nodes(all)[i];
        points_of(all->step)[i] =
            (pl_soft_point){ .x = (double)n->position.x + (double)n->position_rest.x,
                             .y = (double)n->position.y + (double)n->position_rest.y,
                             .vx = (double)n->velocity.x + (double)n->velocity_rest.x,
                             .vy = (double)n->velocity.y + (double)n->velocity_rest.y,
                             .mass = (double)n->mass,
                             .radius = (double)n->radius,
                             .damping = (double)item->damping,
                             .friction = (double)item->friction,
                             .heavy = heavy,
                             .block = PL_NONE,
                             .body = PL_NONE };
    }
}

static bool gather_pins(plumb_world *world, const pl_softbody *item, pl_softbody_place at)
{
    const pl_softbodies *all = &world->softbodies;
    for (uint32_t k = 0; k < item->pins; ++k) {
        const plumb_softbody_pin *pin = &pl_softbody_pins(all)[at.pin + k];
        const uint32_t row = pl_body_row(world, pin->body);
        pl_soft_point *p = &points_of(all->step)[at.node + pin->node];
        p->pinned = true;
        p->px = (double)pin->point.x;
        p->py = (double)pin->point.y;
        if (row == PL_NONE) {
            p->x = p->px, p->y = p->py;
            p->vx = p->vy = 0;
            continue;
        }
        p->px -= (double)world->bodies.local_x[row];
        p->py -= (double)world->bodies.local_y[row];
        p->body = pl_soft_body_of(world, row);
        if (p->body == PL_NONE) {
            return false;
        }
        bodies_of(all->step)[p->body].touched = true;
    }
    return true;
}

static bool gather(plumb_world *world)
{
    const pl_softbodies *all = &world->softbodies;
    pl_soft_step *s = all->step;
    pl_softbody_place at = { 0, 0, 0, 0, 0, 0 };
    s->body_count = 0;
    s->mass = 0;
    for (uint32_t i = 0; i < all->count; ++i) {
        const pl_softbody *item = &pl_softbody_items(all)[i];
        gather_nodes(all, item, at.node);
        s->mass += points_of(s)[at.node].heavy;
        if (!gather_pins(world, item, at)) {
            return false;
        }
        at = pl_softbody_behind(at, item);
    }
    s->point_count = at.node;
    return true;
}

static bool reserve(plumb_world *world)
{
    pl_softbodies *all = &world->softbodies;
    if (all->step == NULL) {
        all->step = pl_resize(&world->memory, NULL, 0, sizeof *all->step);
        if (all->step == NULL) {
            return false;
        }
        *all->step = (pl_soft_step){ .point_count = 0 };
    }
    return pl_buffer_reserve(&world->memory, &all->step->points,
                             all->node_count * sizeof(pl_soft_point)) &&
           pl_buffer_reserve(&world->memory, &all->step->pulls,
                             all->edge_count * sizeof(pl_soft_pull)) &&
           pl_buffer_reserve(&world->memory, &all->step->rows, world->dynamic_count);
}

bool pl_softbodies_find(plumb_world *world, real dt)
{
    if (!reserve(world) || !gather(world) || !pl_soft_find_near(world, (double)dt)) {
        return false;
    }
    pl_soft_step *s = world->softbodies.step;
    s->coupled = 0;
    s->done = 0;
    s->missed = 0;
    memset(s->rows.data, 0, world->dynamic_count);
    for (uint32_t i = 0; i < s->body_count; ++i) {
        if (bodies_of(s)[i].row < world->dynamic_count) {
            ((uint8_t *)s->rows.data)[bodies_of(s)[i].row] = 1;
            ++s->coupled;
        }
    }
    return true;
}

plumb_result pl_run_softbodies(plumb_world *world, plumb_real dt)
{
    return pl_softbodies_find(world, dt) ? PLUMB_OK : PLUMB_E_MEMORY;
}

bool pl_softbodies_act_on(const plumb_world *world, uint32_t row)
{
    return ((const uint8_t *)world->softbodies.step->rows.data)[row] != 0;
}

bool pl_softbodies_couple(const plumb_world *world, uint8_t *called)
{
    const pl_soft_step *s = world->softbodies.step;
    for (uint32_t i = 0; i < s->body_count && s->coupled > 0; ++i) {
        if (bodies_of(s)[i].row < world->dynamic_count) {
            called[bodies_of(s)[i].row] |= PL_CALLED_ALONE;
        }
    }
    return s->coupled > 0;
}

//---- the structure -------------------------------------------------------------------------------

typedef struct pairs {
    pl_keyed *keys;
    const pl_soft_point *points;
    uint32_t count;
    bool by_block; // else by point, both ways, of nodes that are free
} pairs;

static void pair(pairs *to, uint32_t a, uint32_t b)
{
    const pl_soft_point *pa = &to->points[a], *pb = &to->points[b];
    const uint32_t ia = to->by_block ? pa->block : a, ib = to->by_block ? pb->block : b;
    if (pa->block == PL_NONE || pb->block == PL_NONE || ia == ib) {
        return;
    }
    if (to->by_block) {
        to->keys[to->count++] = (pl_keyed){ ia > ib ? pl_key(ia, ib) : pl_key(ib, ia), 0, 0 };
    } else if (pa->body == PL_NONE && pb->body == PL_NONE) {
        to->keys[to->count++] = (pl_keyed){ pl_key(ia, ib), 0, 0 };
        to->keys[to->count++] = (pl_keyed){ pl_key(ib, ia), 0, 0 };
    }
}

static void pair_three(pairs *to, uint32_t a, uint32_t b, uint32_t c)
{
    pair(to, a, b);
    pair(to, b, c);
    pair(to, a, c);
}

// Neighbours by elements.
static void pair_elements(const pl_softbodies *all, pairs *to)
{
    pl_softbody_place at = { 0, 0, 0, 0, 0, 0 };
    for (uint32_t i = 0; i < all->count; ++i) {
        const pl_softbody *item = &pl_softbody_items(all)[i];
        const uint32_t n = at.node;
        for (uint32_t k = 0; k < item->edges; ++k) {
            const plumb_softbody_edge *e = &pl_softbody_edges(all)[at.edge + k];
            if ((e->flags & PLUMB_EDGE_TORN) == 0) {
                pair(to, n + e->a, n + e->b);
            }
        }
        for (uint32_t k = 0; k < item->bends; ++k) {
            const plumb_softbody_bend *e = &pl_softbody_bends(all)[at.bend + k];
            pair_three(to, n + e->a, n + e->b, n + e->c);
        }
        for (uint32_t k = 0; k < item->triangles; ++k) {
            const plumb_softbody_triangle *e = &pl_softbody_triangles(all)[at.triangle + k];
            pair_three(to, n + e->a, n + e->b, n + e->c);
        }
        at = pl_softbody_behind(at, item);
    }
}

// The nodes that are free in breadth-first order, last ones first: a narrow band (reverse Cuthill-McKee 1969). `keys`:
// neighbours both ways. Gives them their blocks; returns how many.
static uint32_t order_nodes(pl_soft_step *s, const pl_keyed *keys, uint32_t count)
{
    pl_soft_point *points = points_of(s);
    uint32_t *first = s->order.data, *queue = first + s->point_count + 1;
    uint32_t head = 0, tail = 0, k = 0, free_count = 0;
    for (uint32_t i = 0; i <= s->point_count; ++i) {
        while (k < count && (uint32_t)(keys[k].key >> 32) < i) {
            ++k;
        }
        first[i] = k;
    }
    for (uint32_t i = 0; i < s->point_count; ++i) {
        free_count += points[i].block == 0;
    }
    // Blocks: 0 not reached, 1 in the first sweep, 2 in the second: that begins where the first one ended.
    for (uint32_t i = 0; i < s->point_count; ++i) {
        uint32_t start = i;
        for (uint32_t sweep = 1; sweep <= 2 && points[i].block + 1 == sweep; ++sweep) {
            tail = head;
            queue[tail++] = start;
            points[start].block = sweep;
            for (uint32_t at = head; at < tail; ++at) {
                const uint32_t node = queue[at];
                for (uint32_t p = first[node]; p < first[node + 1]; ++p) {
                    const uint32_t next = (uint32_t)keys[p].key;
                    if (points[next].block + 1 == sweep) {
                        points[next].block = sweep;
                        queue[tail++] = next;
                    }
                }
            }
            start = queue[tail - 1];
        }
        head = tail > head && points[i].block == 2 ? tail : head;
    }
    for (uint32_t i = 0; i < free_count; ++i) {
        points[queue[i]].block = free_count - 1 - i;
    }
    return free_count;
}

// Gives bodies what the solver has of them, and blocks behind those of nodes.
static uint32_t take_slots(plumb_world *world, uint32_t blocks)
{
    pl_soft_step *s = world->softbodies.step;
    const uint32_t *slots = world->solver.slots.data;
    for (uint32_t i = 0; i < s->body_count; ++i) {
        pl_soft_body *b = &bodies_of(s)[i];
        if (b->row >= world->dynamic_count || s->coupled == 0) {
            continue;
        }
        b->slot = slots[b->row];
        if (b->slot == PL_NONE) {
            continue;
        }
        const pl_solver_body *now = &pl_solver_bodies(&world->solver)[b->slot];
        b->block = blocks++;
        b->mass = now->inv_mass > 0 ? 1 / (double)now->inv_mass : b->mass;
        b->inertia = now->inv_inertia > 0 ? 1 / (double)now->inv_inertia : b->inertia;
        b->locked_w = now->inv_inertia > 0 ? b->locked_w : 0;
        b->mass = b->mass > 0 ? b->mass : 1;
        b->inertia = b->inertia > 0 ? b->inertia : 1;
    }
    return blocks;
}

static uint32_t pair_rest(const plumb_world *world, pairs *to, uint32_t blocks)
{
    const pl_softbodies *all = &world->softbodies;
    const pl_soft_step *s = all->step;
    const pl_soft_near *near = s->near_.data;
    for (uint32_t i = 0; i < s->near_count; ++i) {
        const pl_soft_obstacle *o = (const pl_soft_obstacle *)s->obstacles.data + near[i].obstacle;
        const uint32_t a = points_of(s)[near[i].point].block, b = bodies_of(s)[o->body].block;
        if (b != PL_NONE) {
            to->keys[to->count++] = (pl_keyed){ pl_key(b, a), 0, 0 };
        }
    }
    pl_softbody_place at = { 0, 0, 0, 0, 0, 0 };
    for (uint32_t i = 0; i < all->count; ++i) {
        const pl_softbody *item = &pl_softbody_items(all)[i];
        for (uint32_t k = 0; k < item->ring; ++k) {
            const uint32_t node = at.node + pl_softbody_rings(all)[at.ring + k];
            if (points_of(s)[node].block != PL_NONE) {
                to->keys[to->count++] =
                    (pl_keyed){ pl_key(blocks, points_of(s)[node].block), 0, 0 };
            }
        }
        blocks += item->ring > 0;
        at = pl_softbody_behind(at, item);
    }
    return blocks;
}

bool pl_softbodies_plan(plumb_world *world)
{
    const pl_softbodies *all = &world->softbodies;
    pl_soft_step *s = all->step;
    const size_t most = 2 * ((size_t)all->edge_count + 3 * (size_t)all->bend_count +
                             3 * (size_t)all->triangle_count) +
                        s->near_count + all->ring_count;
    const size_t blocks_most = (size_t)s->point_count + s->body_count + all->count;
    if (!pl_buffer_reserve(&world->memory, &s->keys, (most + 1) * sizeof(pl_keyed)) ||
        !pl_buffer_reserve(&world->memory, &s->order,
                           (2 * (size_t)s->point_count + 2) * sizeof(uint32_t)) ||
        !pl_buffer_reserve(&world->memory, &s->shapes, blocks_most + 1)) {
        return false;
    }
    for (uint32_t i = 0; i < s->point_count; ++i) {
        points_of(s)[i].block = points_of(s)[i].pinned ? PL_NONE : 0;
    }
    pairs to = { s->keys.data, points_of(s), 0, false };
    pair_elements(all, &to);
    pl_sort_keyed(to.keys, to.count);
    const uint32_t nodes = order_nodes(s, to.keys, to.count);
    const uint32_t rigid = take_slots(world, nodes);
    for (uint32_t i = 0; i < s->point_count; ++i) {
        pl_soft_point *p = &points_of(s)[i];
        if (p->body != PL_NONE) {
            p->block = bodies_of(s)[p->body].block;
        }
    }
    to = (pairs){ s->keys.data, points_of(s), 0, true };
    pair_elements(all, &to);
    const uint32_t blocks = pair_rest(world, &to, rigid);
    pl_sort_keyed(to.keys, to.count);
    uint8_t *size = s->shapes.data;
    for (uint32_t i = 0; i < blocks; ++i) {
        size[i] = i < nodes ? 2 : i < rigid ? 3 : 1;
    }
    return pl_soft_structure(&world->memory, s, blocks, to.count);
}

plumb_result pl_run_soft_slots(plumb_world *world, plumb_real dt)
{
    (void)dt;
    return pl_softbodies_plan(world) ? PLUMB_OK : PLUMB_E_MEMORY;
}

//---- a substep -----------------------------------------------------------------------------------

static void turn(pl_soft_body *b, double angle)
{
    double s, c;
    pl_sincos(angle, &s, &c);
    b->c = b->c0 * c - b->s0 * s;
    b->s = b->s0 * c + b->c0 * s;
}

// Bodies and what they hold, as the substep begins, `since` [s] after the step did.
static void see_bodies(const plumb_world *world, double since)
{
    const pl_soft_step *s = world->softbodies.step;
    for (uint32_t i = 0; i < s->body_count; ++i) {
        pl_soft_body *b = &bodies_of(s)[i];
        if (b->slot == PL_NONE) {
            b->x = b->x0 + since * b->vx, b->y = b->y0 + since * b->vy;
            turn(b, since * b->w);
            continue;
        }
        const pl_solver_body *now = &pl_solver_bodies(&world->solver)[b->slot];
        const pl_solver_motion *motion = &pl_solver_motions(&world->solver)[b->slot];
        b->x = b->x0 + (double)now->dx, b->y = b->y0 + (double)now->dy;
        b->vx = (double)now->vx, b->vy = (double)now->vy, b->w = (double)now->w;
        b->ax = (double)motion->ax, b->ay = (double)motion->ay, b->aw = (double)motion->aw;
        turn(b, (double)now->da);
    }
    for (uint32_t i = 0; i < s->point_count; ++i) {
        pl_soft_point *p = &points_of(s)[i];
        if (p->body == PL_NONE) {
            continue;
        }
        const pl_soft_body *b = &bodies_of(s)[p->body];
        p->rx = b->c * p->px - b->s * p->py, p->ry = b->s * p->px + b->c * p->py;
        p->x = b->x + p->rx, p->y = b->y + p->ry;
        p->vx = b->vx - b->w * p->ry, p->vy = b->vy + b->w * p->rx;
    }
}

// What velocities gain if nothing pulls.
static void guess(const plumb_world *world, double h)
{
    const pl_soft_step *s = world->softbodies.step;
    double *u = s->matrix.u;
    memset(u, 0, 3 * (size_t)s->matrix.blocks * sizeof(double));
    for (uint32_t i = 0; i < s->point_count; ++i) {
        const pl_soft_point *p = &points_of(s)[i];
        if (p->block != PL_NONE && p->body == PL_NONE) {
            u[3 * (size_t)p->block] = h * (double)world->gravity.x;
            u[3 * (size_t)p->block + 1] = h * (double)world->gravity.y;
        }
    }
    for (uint32_t i = 0; i < s->body_count; ++i) {
        const pl_soft_body *b = &bodies_of(s)[i];
        if (b->block != PL_NONE) {
            double *to = u + 3 * (size_t)b->block;
            to[0] = h * b->ax, to[1] = h * b->ay, to[2] = h * b->aw;
        }
    }
}

// Of a mass that would gain u0 and gains u, in a unit of u.
typedef struct inertia {
    double mass, free, damping, velocity;
} inertia;

static double add_inertia(const inertia *i, double u, double *diagonal, double *right, bool fills)
{
    const double c = i->damping, share = 0.5 + 0.5 * c / (c + 4);
    const double rate = i->velocity + share * u, off = u - i->free;
    if (fills) {
        *diagonal += i->mass * (1 + share * c);
        *right -= i->mass * (off + c * rate);
    }
    return i->mass * (off * off + c * rate * rate / share) / 2;
}

static double add_masses(const plumb_world *world, double h, bool fills)
{
    const pl_soft_step *s = world->softbodies.step;
    const pl_soft_matrix *m = &s->matrix;
    const double gx = h * (double)world->gravity.x, gy = h * (double)world->gravity.y;
    double energy = 0;
    for (uint32_t i = 0; i < s->point_count; ++i) {
        const pl_soft_point *p = &points_of(s)[i];
        if (p->block == PL_NONE || p->body != PL_NONE) {
            continue;
        }
        double *at = m->diagonal + 9 * (size_t)p->block, *to = m->right + 3 * (size_t)p->block;
        const inertia x = { p->mass, gx, h * p->damping, p->vx };
        const inertia y = { p->mass, gy, h * p->damping, p->vy };
        energy += add_inertia(&x, p->cx, at, to, fills);
        energy += add_inertia(&y, p->cy, at + 4, to + 1, fills);
    }
    for (uint32_t i = 0; i < s->body_count; ++i) {
        const pl_soft_body *b = &bodies_of(s)[i];
        if (b->block == PL_NONE) {
            continue;
        }
        double *at = m->diagonal + 9 * (size_t)b->block, *to = m->right + 3 * (size_t)b->block;
        const double *u = m->u + 3 * (size_t)b->block;
        const inertia own[3] = { { b->mass, h * b->ax, 0, 0 },
                                 { b->mass, h * b->ay, 0, 0 },
                                 { b->inertia, h * b->aw, 0, 0 } };
        for (int k = 0; k < 3; ++k) {
            energy += add_inertia(&own[k], u[k], at + 4 * (size_t)k, to + k, fills);
        }
    }
    return energy;
}

// The function that is to be least, where u is; with its slopes, if it fills.
static double evaluate(plumb_world *world, double h, bool fills)
{
    pl_soft_step *s = world->softbodies.step;
    pl_soft_change(s);
    if (fills) {
        pl_soft_clear(&s->matrix);
    }
    const double masses = add_masses(world, h, fills);
    return masses + pl_soft_elements(world, h, fills) + pl_soft_press(s, h, fills);
}

// u = tried + part d, d the answer of the system.
static void try_part(const pl_soft_step *s, double part)
{
    const pl_soft_matrix *m = &s->matrix;
    for (size_t i = 0; i < 3 * (size_t)m->blocks; ++i) {
        m->u[i] = m->tried[i] + part * m->right[i];
    }
}

static double product(const double *a, const double *b, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; ++i) {
        sum += a[i] * b[i];
    }
    return sum;
}

static double at_part(plumb_world *world, double h, double part)
{
    try_part(world->softbodies.step, part);
    return evaluate(world, h, false);
}

// The part of a way along which the function falls the most, by golden sections: it is convex but for what folds. Exact where
// steps are halved (Armijo 1966), for what friction holds lies in a fold of the function: a way to halve ends before
// or behind it, and the passes go to and fro over it.
static double best_part(plumb_world *world, double h, double before, double gain)
{
    const double share = 0.6180339887498949;
    double whole = at_part(world, h, 1);
    if (whole <= before - ENOUGH_OF_IT * gain) {
        return 1;
    }
    double low = 0, high = 1, a = 1 - share, b = share;
    double at_a = at_part(world, h, a), at_b = at_part(world, h, b);
    for (int i = 0; i < SECTIONS; ++i) {
        if (at_a < at_b) {
            high = b, b = a, at_b = at_a;
            a = high - share * (high - low), at_a = at_part(world, h, a);
        } else {
            low = a, a = b, at_a = at_b;
            b = low + share * (high - low), at_b = at_part(world, h, b);
        }
    }
    return at_a < at_b ? a : b;
}

// A pass of Newton's iteration. Twice what is to be gained by it: no number where there is none.
static double pass(plumb_world *world, double h, double enough)
{
    pl_soft_step *s = world->softbodies.step;
    pl_soft_matrix *m = &s->matrix;
    const size_t count = 3 * (size_t)m->blocks, bytes = count * sizeof(double);
    const double before = evaluate(world, h, true);
    memcpy(m->tried, m->u, bytes);
    memcpy(m->slope, m->right, bytes);
    pl_soft_factor(m);
    pl_soft_solve(m);
    const double gain = product(m->slope, m->right, count);
    const bool goes_on = gain > enough && gain < 1e300;
    try_part(s, goes_on ? best_part(world, h, before, gain) : 1);
    return gain;
}

static void store_substep(plumb_world *world, double h)
{
    const pl_soft_step *s = world->softbodies.step;
    for (uint32_t i = 0; i < s->point_count; ++i) {
        pl_soft_point *p = &points_of(s)[i];
        if (p->body == PL_NONE) {
            p->x += h * (p->vx + p->cx / 2), p->y += h * (p->vy + p->cy / 2);
            p->vx += p->cx, p->vy += p->cy;
        }
    }
    for (uint32_t i = 0; i < s->body_count; ++i) {
        const pl_soft_body *b = &bodies_of(s)[i];
        if (b->block != PL_NONE) {
            pl_solver_motion *motion = &pl_solver_motions(&world->solver)[b->slot];
            const double *u = s->matrix.u + 3 * (size_t)b->block;
            motion->ax = b->locked_x > 0 ? (near_real)(u[0] / h) : motion->ax;
            motion->ay = b->locked_y > 0 ? (near_real)(u[1] / h) : motion->ay;
            motion->aw = b->locked_w > 0 ? (near_real)(u[2] / h) : motion->aw;
        }
    }
    const pl_soft_contact *contacts = s->contacts.data;
    for (uint32_t i = 0; i < s->contact_count; ++i) {
        bodies_of(s)[contacts[i].body].touched |= contacts[i].force > 0;
    }
}

// [kg] of nodes and of bodies that are unknowns.
static double moved_mass(const pl_soft_step *s)
{
    double sum = s->mass;
    for (uint32_t i = 0; i < s->body_count; ++i) {
        sum += bodies_of(s)[i].block != PL_NONE ? bodies_of(s)[i].mass : 0;
    }
    return sum;
}

static void run_substep(plumb_world *world, double h)
{
    pl_soft_step *s = world->softbodies.step;
    see_bodies(world, h * s->done);
    guess(world, h);
    pl_soft_change(s); // where they are on their way to
    pl_soft_find_contacts(world, h);
    const double fall = h * (fabs((double)world->gravity.x) + fabs((double)world->gravity.y));
    const double small = SMALL * fall, told = TOLD * fall;
    const double enough = s->mass * (small * small + 1e-12);
    double gain = INFINITY;
    s->pass = 0;
    s->creep = CREEP * fall + 1e-9;
    while (s->pass < MOST_PASSES && (gain > enough || (s->pass < 3 && s->contact_count > 0))) {
        gain = pass(world, h, enough);
        if (!(gain < 1e300)) { // no number: as if nothing pulled
            guess(world, h);
            break;
        }
        ++s->pass;
    }
    s->missed += gain <= moved_mass(s) * (told * told + 1e-12) ? 0 : 1;
    evaluate(world, h, false);
    store_substep(world, h);
    ++s->done;
}

void pl_softbodies_row(pl_substep *sub)
{
    if (sub->world->softbodies.step->coupled > 0 &&
        sub->cluster == pl_clusters(&sub->world->solver)) {
        run_substep(sub->world, (double)sub->h);
    }
}

//---- when nothing can fail any more --------------------------------------------------------------

static double held(double v, double most)
{
    return v > most ? most : v < -most ? -most : v == v ? v : 0;
}

static void put(double value, real *to, real *rest)
{
    *to = (real)value;
    *rest = (real)(value - (double)*to);
}

// What a body holds is where the body is.
static void follow_body(const plumb_world *world, pl_soft_point *p)
{
    const pl_bodies *b = &world->bodies;
    const uint32_t row = pl_body_row(world, bodies_of(world->softbodies.step)[p->body].body);
    if (row == PL_NONE) {
        return;
    }
    const bool moves = row < world->dynamic_count + world->kinematic_count;
    const double c = (double)b->c[row], s = (double)b->s[row], w = moves ? (double)b->w[row] : 0;
    const double rx = c * p->px - s * p->py, ry = s * p->px + c * p->py;
    p->x = (double)b->center_x[row] + (double)b->residual_x[row] + rx;
    p->y = (double)b->center_y[row] + (double)b->residual_y[row] + ry;
    p->vx = (moves ? (double)b->vx[row] : 0) - w * ry;
    p->vy = (moves ? (double)b->vy[row] : 0) + w * rx;
}

static void store_nodes(plumb_world *world)
{
    const pl_softbodies *all = &world->softbodies;
    for (uint32_t i = 0; i < all->node_count; ++i) {
        pl_soft_point *p = &points_of(all->step)[i];
        plumb_softbody_node *n = &pl_softbody_nodes(all)[i];
        if (p->body != PL_NONE) {
            follow_body(world, p);
        }
        put(held(p->x, 1e12), &n->position.x, &n->position_rest.x);
        put(held(p->y, 1e12), &n->position.y, &n->position_rest.y);
        put(held(p->vx, PL_SOFT_SPEED), &n->velocity.x, &n->velocity_rest.x);
        put(held(p->vy, PL_SOFT_SPEED), &n->velocity.y, &n->velocity_rest.y);
    }
}

// What touches or holds does not fall asleep; what sleeps wakes.
static void stir(plumb_world *world)
{
    const pl_soft_step *s = world->softbodies.step;
    for (uint32_t i = 0; i < s->body_count; ++i) {
        const pl_soft_body *b = &bodies_of(s)[i];
        const uint32_t row = b->touched ? pl_body_row(world, b->body) : PL_NONE;
        if (row == PL_NONE || world->bodies.type[row] != PLUMB_DYNAMIC) {
            continue;
        }
        if (row < world->dynamic_count) {
            world->bodies.rest_time[row] = PL_NOT_RESTING;
        } else if (pl_row_is_asleep(world, row)) {
            pl_sleep_disturb(world, row);
        }
    }
}

static void tell_missed(plumb_world *world)
{
    pl_softbodies *all = &world->softbodies;
    if (all->step->missed > 0 && all->missed_count == 0) {
        pl_warn(world,
                "soft bodies did not settle within %d passes in a substep at %g s: what they do "
                "there is less exact; more "
                "substeps, or softer ones, help",
                MOST_PASSES, world->time);
    }
    all->missed_count += all->step->missed;
}

plumb_result pl_run_softbodies_motion(plumb_world *world, plumb_real dt)
{
    const pl_soft_step *s = world->softbodies.step;
    const near_real h = (near_real)(dt / (real)world->desc.substeps);
    while (s->done < (int)world->desc.substeps) {
        run_substep(world, (double)h);
    }
    store_nodes(world);
    pl_soft_settle_edges(world);
    stir(world);
    tell_missed(world);
    return PLUMB_OK;
}
