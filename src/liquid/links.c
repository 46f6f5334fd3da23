// links.c - the faces that moving bodies close in part, as terms of the system of pressures: what pressures do to bodies, and
// what bodies' motion does to the cells beside them.
//
// With c_b how a motion of body b fills cells, and K_b its inverse mass or inertia, a term is K_b c_b (c_b . P): of rank one,
// three a body, never stored as a matrix. Of c_b stands what is not 0: its rim, the rows beside it (strips.simd.c).
//
// Reads: links, rows, pressures. Writes: rims, bodies of the grid, speeds of what closes faces. Cost: O(bodies + links).
#include "liquid/liquid.h"

#include <string.h>

static pl_liquid_ends ends_of(const pl_liquid_grid *g, const pl_liquid_link *link)
{
    return pl_liquid_ends_of(g, link->cell, link->upright);
}

static bool is_wet(pl_liquid_ends at)
{
    return at.before != 0 || at.behind != 0;
}

//---- rims ----------------------------------------------------------------------------------------

// Room for what lies beside bodies: lists of the grid, links in the order of bodies, and where a row is in the list.
typedef struct rims {
    uint32_t *order, *seats;
    uint32_t count;
} rims;

static bool make_rims(pl_memory *memory, pl_liquid_scratch *scratch, rims *r)
{
    pl_liquid_grid *g = &scratch->grid;
    const size_t most = 2 * (size_t)g->link_count, rows = (size_t)g->levels[0].end * PL_LIQUID_SIDE;
    const size_t numbers = (most + g->link_count + rows) * sizeof(uint32_t);
    if (!pl_buffer_reserve(memory, &scratch->rims, most * sizeof(pl_liquid_rim) + numbers)) {
        return false;
    }
    g->rim_fills = scratch->rims.data;
    g->rim_rows = (uint32_t *)(void *)(g->rim_fills + most);
    *r = (rims){ .order = g->rim_rows + most };
    r->seats = r->order + g->link_count;
    memset(r->seats, 0, rows * sizeof(uint32_t));
    return true;
}

// By counting, as points are sorted by cell: `first_rim` runs through a body's places, to where the next one's begin.
static void sort_links(pl_liquid_grid *g, const rims *r)
{
    for (uint32_t i = 0; i < g->link_count; ++i) {
        ++g->bodies[g->links[i].body].rim_count;
    }
    for (uint32_t b = 0, next = 0; b < g->body_count; ++b) {
        g->bodies[b].first_rim = next;
        next += g->bodies[b].rim_count;
    }
    for (uint32_t i = 0; i < g->link_count; ++i) {
        r->order[g->bodies[g->links[i].body].first_rim++] = i;
    }
}

static void add_to_rim(pl_liquid_grid *g, rims *r, uint32_t first, uint32_t row,
                       const pl_liquid_link *link, near_real part)
{
    uint32_t at = r->seats[row];
    if (row == 0) {
        return;
    }
    if (at < first || at >= r->count || g->rim_rows[at] != row) {
        at = r->seats[row] = r->count++;
        g->rim_rows[at] = row;
        g->rim_fills[at] = (pl_liquid_rim){ { 0 } };
    }
    g->rim_fills[at].by[link->upright ? 1 : 0] += part;
    g->rim_fills[at].by[2] += part * link->arm;
}

bool pl_liquid_find_rims(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_liquid_grid *g = &scratch->grid;
    rims r;
    for (uint32_t b = 0; b < g->body_count; ++b) {
        g->bodies[b].first_rim = g->bodies[b].rim_count = 0;
    }
    if (g->link_count == 0) {
        return true;
    }
    if (!make_rims(memory, scratch, &r)) {
        return false;
    }
    sort_links(g, &r);
    for (uint32_t b = 0; b < g->body_count; ++b) {
        pl_liquid_body *body = &g->bodies[b];
        const uint32_t end = body->first_rim, first = r.count;
        for (uint32_t k = end - body->rim_count; k < end; ++k) {
            const pl_liquid_link *link = &g->links[r.order[k]];
            const pl_liquid_ends at = ends_of(g, link);
            add_to_rim(g, &r, first, at.before, link, link->part);
            add_to_rim(g, &r, first, at.behind, link, -link->part);
        }
        body->first_rim = first;
        body->rim_count = r.count - first;
    }
    return true;
}

double pl_liquid_add_links(pl_liquid_grid *g, const near_real *p, near_real *out, double push)
{
    return push == 0
               ? 0
               : pl_liquid_add_soft_links(g, p, out, push) + g->kernels->add_rims(g, p, out, push);
}

//---- motion --------------------------------------------------------------------------------------

// How fast a body's motion moves what closes a face, along its normal.
static double speed_of(const pl_liquid_link *link, const double motion[3])
{
    return motion[link->upright ? 1 : 0] + motion[2] * (double)link->arm;
}

void pl_liquid_push_body(pl_liquid_body *b, double x, double y, double turn)
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
    g->kernels->sum_rims(g, g->vectors[PL_LIQUID_P]);
    for (uint32_t i = 0; i < g->body_count; ++i) {
        const double *sum = g->bodies[i].sum;
        pl_liquid_push_body(&g->bodies[i], push * sum[0], push * sum[1], push * sum[2]);
    }
    pl_liquid_push_nodes(g, push);
}

void pl_liquid_bear_rests(pl_liquid_grid *g, double push, double fall_x, double fall_y)
{
    for (uint32_t i = 0; i < g->link_count; ++i) {
        const pl_liquid_link *link = &g->links[i];
        const pl_liquid_ends at = ends_of(g, link);
        g->bodies[link->body].wet |= is_wet(at);
        if (link->rest > 0 && is_wet(at)) {
            const double light = (double)pl_liquid_light_at(g, link->cell, link->upright);
            const double lift =
                -push * (double)link->rest * (link->upright ? fall_y : fall_x) / light;
            pl_liquid_push_body(&g->bodies[link->body], link->upright ? 0 : lift,
                                link->upright ? lift : 0, lift * (double)link->arm);
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
        pl_liquid_add_speed(g, link->cell, link->upright, link->part, speed_of(link, change));
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
