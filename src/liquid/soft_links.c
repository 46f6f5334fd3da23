// soft_links.c - the faces that soft bodies close in part, as terms of the system of pressures, as links.c has those of bodies.
//
// A triangle closes areas of faces, as a body does that yields; what it closes moves with its nodes by their shares in the middle of
// that, and the pressure there pushes these by the same shares. What a triangle swells by within a cell is no flow of the liquid: so the
// cell before a face has the motion half a cell before that middle, the cell behind it half a cell behind. How nodes answer
// is the matrix of a whole step of the soft bodies (softbody/foresee.c), stiffness and contacts with it: so neither a light
// skin nor a stiff one limits the step.
//
// Reads: nodes, links, pressures. Writes: nodes, speeds of what closes faces, swell of cells. Cost: a product O(links) and a
// solution of the matrix.
#include "liquid/liquid.h"
#include "softbody/softbody.h"

#include <string.h>

// Changes how fast what closes a face goes, and by how much it swells across: half of that in either cell.
static void add_motion(pl_liquid_grid *g, const pl_liquid_soft_link *link, double speed,
                       double swell)
{
    const uint32_t other = link->upright ? g->down[link->cell] : g->left[link->cell];
    const near_real more = link->part * (near_real)pl_liquid_held(swell, PL_LIQUID_SPEED);
    pl_liquid_add_speed(g, link->cell, link->upright, link->part, speed);
    g->swell[link->cell] += more;
    g->swell[other] += more;
}

void pl_liquid_close_softly(pl_liquid_grid *g, const pl_liquid_solid *s, pl_liquid_soft_link *link,
                            double x, double y)
{
    const double ux = s->x[1] - s->x[0], uy = s->y[1] - s->y[0];
    const double vx = s->x[2] - s->x[0], vy = s->y[2] - s->y[0];
    const double px = x - s->x[0], py = y - s->y[0], scale = 1 / (ux * vy - uy * vx);
    const double b = (px * vy - py * vx) * scale, c = (ux * py - uy * px) * scale;
    const double half_b = (link->upright ? -vx : vy) * scale / 2;
    const double half_c = (link->upright ? ux : -uy) * scale / 2;
    const double shares[3] = { 1 - b - c, b, c }, slopes[3] = { -half_b - half_c, half_b, half_c };
    double speed = 0, swell = 0;
    for (int i = 0; i < 3; ++i) {
        const pl_liquid_node *n = &g->nodes[s->nodes[i]];
        speed += shares[i] * (link->upright ? n->vy : n->vx);
        swell += slopes[i] * (link->upright ? n->vy : n->vx);
        link->nodes[i] = s->nodes[i];
        link->shares[i] = (near_real)shares[i];
        link->slopes[i] = (near_real)slopes[i];
    }
    add_motion(g, link, speed, swell);
}

static pl_liquid_ends ends_of(const pl_liquid_grid *g, const pl_liquid_soft_link *link)
{
    return pl_liquid_ends_of(g, link->cell, link->upright);
}

// What velocities of its nodes make of a link.
typedef struct motion {
    double speed, swell;
} motion;

static motion motion_of(const pl_liquid_soft_link *link, const double v[3])
{
    motion m = { 0, 0 };
    for (int k = 0; k < 3; ++k) {
        m.speed += (double)link->shares[k] * v[k];
        m.swell += (double)link->slopes[k] * v[k];
    }
    return m;
}

static void clear_sums(pl_liquid_grid *g)
{
    for (uint32_t i = 0; i < g->node_count; ++i) {
        g->nodes[i].sum[0] = g->nodes[i].sum[1] = 0;
    }
}

// The pushes of both sides of a face.
static void add_to_sums(pl_liquid_grid *g, const pl_liquid_soft_link *link, double before,
                        double behind)
{
    for (int k = 0; k < 3; ++k) {
        g->nodes[link->nodes[k]].sum[link->upright ? 1 : 0] +=
            (before - behind) * (double)link->shares[k] -
            (before + behind) * (double)link->slopes[k];
    }
}

// What pressures do to the sums of nodes: force over density h^2.
static void sum_links(pl_liquid_grid *g, const near_real *p)
{
    clear_sums(g);
    for (uint32_t i = 0; i < g->soft_link_count; ++i) {
        const pl_liquid_soft_link *link = &g->soft_links[i];
        const pl_liquid_ends at = ends_of(g, link);
        add_to_sums(g, link, (double)(link->part * p[at.before]),
                    (double)(link->part * p[at.behind]));
    }
}

// The middles of rings hand what they got to the nodes.
static void share_sums(pl_liquid_grid *g)
{
    for (uint32_t r = 0; r < g->ring_count; ++r) {
        const pl_liquid_ring *ring = &g->rings[r];
        pl_liquid_node *middle = &g->nodes[ring->middle];
        for (uint32_t k = 0; k < ring->count; ++k) {
            pl_liquid_node *n = pl_liquid_ring_node(g, ring, k);
            n->sum[0] += middle->sum[0] / ring->count;
            n->sum[1] += middle->sum[1] / ring->count;
        }
        middle->sum[0] = middle->sum[1] = 0;
    }
}

// The spin in the sums of one: velocities, or with `weighs` impulses.
static double spin_of(const pl_liquid_grid *g, const pl_liquid_softbody *t, bool weighs)
{
    double sum = 0;
    for (uint32_t i = t->first; i < t->first + t->count; ++i) {
        const double x = g->nodes[i].x - t->x, y = g->nodes[i].y - t->y;
        const double moment = x * g->nodes[i].sum[1] - y * g->nodes[i].sum[0];
        sum += weighs ? moment : moment * pl_liquid_soft_mass(g, i);
    }
    return t->inertia > 0 ? sum / t->inertia : 0;
}

static void add_spin(pl_liquid_grid *g, const pl_liquid_softbody *t, bool weighs, double spin)
{
    for (uint32_t i = t->first; i < t->first + t->count; ++i) {
        const double by = spin * (weighs ? pl_liquid_soft_mass(g, i) : 1);
        g->nodes[i].sum[0] -= by * (g->nodes[i].y - t->y);
        g->nodes[i].sum[1] += by * (g->nodes[i].x - t->x);
    }
}

// What impulses of `push` times the sums add to velocities, by the matrix. Returns the product of both over push.
static double answer_by_matrix(pl_liquid_grid *g, double push)
{
    const pl_soft_step *s = g->world->softbodies.step;
    double *right = s->matrix.right, bend = 0;
    memset(right, 0, 3 * (size_t)s->matrix.blocks * sizeof *right);
    for (uint32_t k = 0; k < g->softbody_count; ++k) {
        const pl_liquid_softbody *b = &g->softbodies[k];
        const pl_liquid_node *nodes = &g->nodes[b->first];
        for (uint32_t i = 0; i < b->count; ++i) {
            pl_soft_push(s, b->point + i, push * nodes[i].sum[0], push * nodes[i].sum[1]);
        }
    }
    pl_soft_answer(s);
    for (uint32_t k = 0; k < g->softbody_count; ++k) {
        const pl_liquid_softbody *b = &g->softbodies[k];
        for (uint32_t i = 0; i < b->count; ++i) {
            const uint32_t block = pl_soft_point_at(s, b->point + i)->block;
            double *sum = g->nodes[b->first + i].sum;
            const double x = block == PL_NONE ? 0 : right[3 * (size_t)block];
            const double y = block == PL_NONE ? 0 : right[3 * (size_t)block + 1];
            bend += sum[0] * x + sum[1] * y;
            sum[0] = x;
            sum[1] = y;
        }
    }
    return bend;
}

// Sums times `push` as impulses; sums become what these add to velocities. Returns the product of both over push. What nothing holds turns
// as a rigid body does: the matrix is that of nodes under stress which go straight on.
static double answer(pl_liquid_grid *g, double push)
{
    share_sums(g);
    for (uint32_t k = 0; k < g->softbody_count; ++k) {
        pl_liquid_softbody *b = &g->softbodies[k];
        b->spin = b->turns ? spin_of(g, b, true) : 0;
        add_spin(g, b, true, -b->spin);
    }
    double bend = answer_by_matrix(g, push);
    for (uint32_t k = 0; k < g->softbody_count; ++k) {
        const pl_liquid_softbody *b = &g->softbodies[k];
        add_spin(g, b, false, b->turns ? push * b->spin - spin_of(g, b, false) : 0);
        bend += push * b->spin * b->spin * b->inertia;
    }
    for (uint32_t r = 0; r < g->ring_count; ++r) {
        const pl_liquid_ring *ring = &g->rings[r];
        double *sum = g->nodes[ring->middle].sum;
        for (uint32_t k = 0; k < ring->count; ++k) {
            sum[0] += pl_liquid_ring_node(g, ring, k)->sum[0] / ring->count;
            sum[1] += pl_liquid_ring_node(g, ring, k)->sum[1] / ring->count;
        }
    }
    return bend;
}

double pl_liquid_add_soft_links(pl_liquid_grid *g, const near_real *p, near_real *out, double push)
{
    if (g->soft_link_count == 0) {
        return 0;
    }
    sum_links(g, p);
    const double bend = answer(g, push);
    for (uint32_t i = 0; i < g->soft_link_count; ++i) {
        const pl_liquid_soft_link *link = &g->soft_links[i];
        const pl_liquid_ends at = ends_of(g, link);
        double v[3];
        for (int k = 0; k < 3; ++k) {
            v[k] = g->nodes[link->nodes[k]].sum[link->upright ? 1 : 0];
        }
        const motion m = motion_of(link, v);
        out[at.before] += link->part * (near_real)(m.speed - m.swell);
        out[at.behind] -= link->part * (near_real)(m.speed + m.swell);
    }
    out[0] = 0;
    return bend;
}

//---- motion --------------------------------------------------------------------------------------

// The sums of nodes, times `push`, as impulses.
static void push_sums(pl_liquid_grid *g, double push)
{
    share_sums(g);
    for (uint32_t i = 0; i < g->node_count; ++i) {
        pl_liquid_node *n = &g->nodes[i];
        n->impulse[0] += push * n->sum[0];
        n->impulse[1] += push * n->sum[1];
    }
    answer(g, push);
    for (uint32_t i = 0; i < g->node_count; ++i) {
        pl_liquid_node *n = &g->nodes[i];
        n->vx += n->sum[0];
        n->vy += n->sum[1];
    }
    pl_liquid_see_middles(g);
}

void pl_liquid_push_nodes(pl_liquid_grid *g, double push)
{
    if (g->soft_link_count > 0) {
        sum_links(g, g->vectors[PL_LIQUID_P]);
        push_sums(g, push);
    }
}

void pl_liquid_bear_nodes(pl_liquid_grid *g, double push, double fall_x, double fall_y)
{
    if (g->soft_link_count == 0) {
        return;
    }
    clear_sums(g);
    for (uint32_t i = 0; i < g->soft_link_count; ++i) {
        const pl_liquid_soft_link *link = &g->soft_links[i];
        const pl_liquid_ends at = ends_of(g, link);
        const bool wet = at.before != 0 || at.behind != 0;
        for (int k = 0; k < 3; ++k) {
            g->nodes[link->nodes[k]].wet |= wet;
        }
        if (link->rest > 0 && wet) {
            const double light = (double)pl_liquid_light_at(g, link->cell, link->upright);
            const double half = -(double)link->rest * (link->upright ? fall_y : fall_x) / light / 2;
            add_to_sums(g, link, half, -half);
        }
    }
    push_sums(g, push);
}

void pl_liquid_follow_nodes(pl_liquid_grid *g)
{
    for (uint32_t i = 0; i < g->soft_link_count; ++i) {
        const pl_liquid_soft_link *link = &g->soft_links[i];
        double v[3];
        for (int k = 0; k < 3; ++k) {
            const pl_liquid_node *n = &g->nodes[link->nodes[k]];
            v[k] = link->upright ? n->vy - n->seen[1] : n->vx - n->seen[0];
        }
        const motion m = motion_of(link, v);
        add_motion(g, link, m.speed, m.swell);
    }
    pl_liquid_see_nodes(g);
}

void pl_liquid_see_nodes(pl_liquid_grid *g)
{
    for (uint32_t i = 0; i < g->node_count; ++i) {
        g->nodes[i].seen[0] = g->nodes[i].vx;
        g->nodes[i].seen[1] = g->nodes[i].vy;
    }
}
