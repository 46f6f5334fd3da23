// links.c - the faces that moving bodies close in part, as terms of the system of pressures: what pressures do to bodies, and
// what bodies' motion does to the cells beside them.
//
// With c_b how a motion of body b fills cells, and K_b its inverse mass or inertia, a term is K_b c_b (c_b . P): of rank one,
// three a body, never stored as a matrix.
//
// Reads: links, pressures. Writes: bodies of the grid, speeds of what closes faces. Cost: O(bodies + links).
#include "liquid/liquid.h"

static pl_liquid_ends ends_of(const pl_liquid_grid *g, const pl_liquid_link *link)
{
    return pl_liquid_ends_of(g, link->cell, link->upright);
}

// What pressures P do to the sums of bodies: force over density h^2.
static void sum_links(pl_liquid_grid *g, const near_real *p)
{
    for (uint32_t b = 0; b < g->body_count; ++b) {
        g->bodies[b].sum[0] = g->bodies[b].sum[1] = g->bodies[b].sum[2] = 0;
    }
    for (uint32_t i = 0; i < g->link_count; ++i) {
        const pl_liquid_link *link = &g->links[i];
        const pl_liquid_ends at = ends_of(g, link);
        const double push = (double)(link->part * (p[at.before] - p[at.behind]));
        double *sum = g->bodies[link->body].sum;
        sum[link->upright ? 1 : 0] += push;
        sum[2] += push * (double)link->arm;
    }
}

// How fast a body's motion moves what closes a face, along its normal.
static near_real speed_of(const pl_liquid_link *link, const double motion[3])
{
    return (near_real)(motion[link->upright ? 1 : 0] + motion[2] * (double)link->arm);
}

double pl_liquid_add_links(pl_liquid_grid *g, const near_real *p, near_real *out, double push)
{
    double bend = push == 0 ? 0 : pl_liquid_add_soft_links(g, p, out, push);
    if (push == 0 || g->link_count == 0) {
        return bend;
    }
    sum_links(g, p);
    for (uint32_t i = 0; i < g->body_count; ++i) {
        const pl_liquid_body *b = &g->bodies[i];
        bend +=
            push * (b->inv_mass_x * b->sum[0] * b->sum[0] + b->inv_mass_y * b->sum[1] * b->sum[1] +
                    b->inv_inertia * b->sum[2] * b->sum[2]);
    }
    for (uint32_t i = 0; i < g->link_count; ++i) {
        const pl_liquid_link *link = &g->links[i];
        const pl_liquid_body *b = &g->bodies[link->body];
        const double motion[3] = { push * b->inv_mass_x * b->sum[0],
                                   push * b->inv_mass_y * b->sum[1],
                                   push * b->inv_inertia * b->sum[2] };
        const near_real flow = link->part * speed_of(link, motion);
        const pl_liquid_ends at = ends_of(g, link);
        out[at.before] += flow;
        out[at.behind] -= flow;
    }
    out[0] = 0;
    return bend;
}

//---- motion --------------------------------------------------------------------------------------

static void push_body(pl_liquid_body *b, double x, double y, double turn)
{
    b->impulse_x += x;
    b->impulse_y += y;
    b->turn += turn;
    b->vx += b->inv_mass_x * x;
    b->vy += b->inv_mass_y * y;
    b->w += b->inv_inertia * turn;
}

void pl_liquid_push_bodies(pl_liquid_grid *g, double push)
{
    sum_links(g, g->vectors[PL_LIQUID_P]);
    for (uint32_t i = 0; i < g->body_count; ++i) {
        const double *sum = g->bodies[i].sum;
        push_body(&g->bodies[i], push * sum[0], push * sum[1], push * sum[2]);
    }
    pl_liquid_push_nodes(g, push);
}

void pl_liquid_bear_rests(pl_liquid_grid *g, double push, double fall_x, double fall_y)
{
    for (uint32_t i = 0; i < g->link_count; ++i) {
        const pl_liquid_link *link = &g->links[i];
        const pl_liquid_ends at = ends_of(g, link);
        const bool wet = at.before != 0 || at.behind != 0;
        g->bodies[link->body].wet |= wet;
        if (link->rest > 0 && wet) {
            const double light = (double)pl_liquid_light_at(g, link->cell, link->upright);
            const double lift =
                -push * (double)link->rest * (link->upright ? fall_y : fall_x) / light;
            push_body(&g->bodies[link->body], link->upright ? 0 : lift, link->upright ? lift : 0,
                      lift * (double)link->arm);
        }
    }
    pl_liquid_bear_nodes(g, push, fall_x, fall_y);
    pl_liquid_follow_bodies(g);
}

void pl_liquid_follow_bodies(pl_liquid_grid *g)
{
    for (uint32_t i = 0; i < g->link_count; ++i) {
        const pl_liquid_link *link = &g->links[i];
        const pl_liquid_body *b = &g->bodies[link->body];
        const double change[3] = { b->vx - b->seen[0], b->vy - b->seen[1], b->w - b->seen[2] };
        pl_liquid_add_speed(g, link->cell, link->upright, link->part,
                            (double)speed_of(link, change));
    }
    pl_liquid_see_bodies(g);
    pl_liquid_follow_nodes(g);
}

void pl_liquid_see_bodies(pl_liquid_grid *g)
{
    for (uint32_t i = 0; i < g->body_count; ++i) {
        pl_liquid_body *b = &g->bodies[i];
        b->seen[0] = b->vx, b->seen[1] = b->vy, b->seen[2] = b->w;
    }
}
