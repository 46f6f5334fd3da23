// pressure.c - what keeps the liquid's volume: one symmetric system for the pressures of cells and the velocities of
// bodies.
//
// With P = p dt / (density h) [m/s], the row of a cell is
//
//     sum a (P - P_beside) + sum_b K_b c_b (c_b . P) = -(what flows out of it),
//
// a the openness of its faces, P = 0 in air, c_b how a motion of body b fills the cell: three columns a body, for x, y
// and its turn, K = density h^2 times inverse mass or inertia (Batty, Bertails, Bridson 2007, with faces as Ng, Min, Gibou
// 2009 open them). The terms of a body have rank one each: they are added by its links, matrix-free. Conjugate
// gradients, preconditioned by an incomplete factor without the bodies (MIC(0), Bridson 2008).
//
// Sums run in a fixed order in eight parts, so that no width of lanes changes a bit.
//
// Reads: openness, velocities, links. Writes: rows, vectors, velocities of faces and bodies. Cost: O(rows x iterations).
#include "liquid/liquid.h"

#include <math.h>
#include <string.h>

#define MOST_ITERATIONS 200
#define COVERED         ((near_real)0.3)
#define TUNING          ((near_real)0.97) // of the modified factor
#define SAFETY          ((near_real)0.25)
#define LEVEL           ((near_real)0.5)
#define LEAST_GAP       ((near_real)0.25) // [cells] nearer surfaces would make the system stiff
#define LEAST_ROOM      ((near_real)0.1)  // of a cell's surroundings that is not solid
#define PARTS           8

//---- which cells have liquid ----------------------------------------------------------------------

static void faces_of(const pl_liquid_grid *g, uint32_t c, near_real open[4])
{
    open[0] = g->open_u[c];
    open[1] = g->right[c] != 0 ? g->open_u[g->right[c]] : 1;
    open[2] = g->open_v[c];
    open[3] = g->up[c] != 0 ? g->open_v[g->up[c]] : 1;
}

static bool has_points(const pl_liquid_grid *g, uint32_t c)
{
    return c != 0 && g->first[c + 1] > g->first[c];
}

// A cell with particles; or one that a body covers in part and that an open face joins to such a one: pressure would
// leak out under hulls.
static bool is_liquid(const pl_liquid_grid *g, uint32_t c)
{
    const uint32_t near[4] = { g->left[c], g->right[c], g->down[c], g->up[c] };
    near_real open[4];
    faces_of(g, c, open);
    bool any = false, joined = false;
    for (int k = 0; k < 4; ++k) {
        any |= open[k] > 0;
        joined |= open[k] > 0 && has_points(g, near[k]);
    }
    return any && (has_points(g, c) || (joined && g->cover[c] > COVERED));
}

// Where the density falls to one half on the way from a's centre to b's: exact for level surfaces at both centres and
// half way. Pressure is 0 there, not at the centre of the air's cell (ghost fluid; Enright et al. 2003).
near_real pl_liquid_gap(const pl_liquid_grid *g, uint32_t a, uint32_t b)
{
    const bool wet_a = g->row[a] != PL_LIQUID_NONE, wet_b = g->row[b] != PL_LIQUID_NONE;
    if (wet_a == wet_b) {
        return 1;
    }
    const uint32_t water = wet_a ? a : b, air = wet_a ? b : a;
    const near_real room = 1 - g->solid[water], air_room = 1 - g->solid[air];
    if (room < LEAST_ROOM || air_room < LEAST_ROOM) {
        return 1;
    }
    const near_real in = (g->density[water] - g->solid[water]) / room;
    const near_real out = (g->density[air] - g->solid[air]) / air_room;
    const near_real gap = in > out ? (in - LEVEL) / (in - out) : 0;
    return gap > 1 ? 1 : gap > LEAST_GAP ? gap : LEAST_GAP;
}

static void fill_row(pl_liquid_grid *g, pl_liquid_row *row)
{
    const uint32_t c = row->cell;
    const uint32_t near[4] = { g->left[c], g->right[c], g->down[c], g->up[c] };
    faces_of(g, c, row->open);
    row->diagonal = 0;
    for (int k = 0; k < 4; ++k) {
        row->next[k] = near[k] == 0 || row->open[k] == 0 ? PL_LIQUID_NONE : g->row[near[k]];
        row->next[k] = row->next[k] == PL_LIQUID_NONE ? g->row_count : row->next[k];
        const bool air = row->next[k] == g->row_count && row->open[k] > 0;
        row->diagonal += air ? row->open[k] / pl_liquid_gap(g, c, near[k]) : row->open[k];
    }
}

// The inverse square roots of the pivots; rows at the left and below come first.
static void factor(pl_liquid_grid *g)
{
    near_real *e = g->vectors[PL_LIQUID_E];
    for (uint32_t i = 0; i < g->row_count; ++i) {
        const pl_liquid_row *row = &g->rows[i];
        near_real pivot = row->diagonal;
        for (int k = 0; k < 4; k += 2) {
            const uint32_t j = row->next[k];
            if (j < i) {
                const pl_liquid_row *before = &g->rows[j];
                // What of its row lies on the other side of it, and fills in.
                const int other = k == 0 ? 3 : 1;
                const near_real a = row->open[k] * e[j];
                const near_real b = before->next[other] < g->row_count ? before->open[other] : 0;
                pivot -= a * a + TUNING * a * b * e[j];
            }
        }
        pivot = pivot < SAFETY * row->diagonal ? row->diagonal : pivot;
        e[i] = pivot > 0 ? 1 / (near_real)sqrt((double)pivot) : 0;
    }
}

bool pl_liquid_plan(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_liquid_grid *g = &scratch->grid;
    g->row_count = 0;
    for (uint32_t c = 0; c < g->cell_count; ++c) {
        g->row[c] = c != 0 && is_liquid(g, c) ? g->row_count++ : PL_LIQUID_NONE;
    }
    const size_t room = ((size_t)g->row_count + 1 + PARTS) / PARTS * PARTS;
    if (!pl_buffer_reserve(memory, &scratch->rows, (g->row_count + 1) * sizeof(pl_liquid_row)) ||
        !pl_buffer_reserve(memory, &scratch->vectors,
                           PL_LIQUID_VECTORS * room * sizeof(near_real))) {
        return false;
    }
    g->rows = scratch->rows.data;
    memset(scratch->vectors.data, 0, PL_LIQUID_VECTORS * room * sizeof(near_real));
    for (int k = 0; k < PL_LIQUID_VECTORS; ++k) {
        g->vectors[k] = (near_real *)scratch->vectors.data + (size_t)k * room;
    }
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        if (g->row[c] != PL_LIQUID_NONE) {
            g->rows[g->row[c]].cell = c;
            fill_row(g, &g->rows[g->row[c]]);
        }
    }
    factor(g);
    return true;
}

//---- sums ----------------------------------------------------------------------------------------

// Padded to whole parts with zeros.
static double dot(const pl_liquid_grid *g, const near_real *a, const near_real *b)
{
    near_real parts[PARTS] = { 0 };
    for (uint32_t i = 0; i < g->row_count; i += PARTS) {
        for (uint32_t k = 0; k < PARTS; ++k) {
            parts[k] += a[i + k] * b[i + k];
        }
    }
    double total = 0;
    for (int k = 0; k < PARTS; ++k) {
        total += (double)parts[k];
    }
    return total;
}

static near_real largest(const pl_liquid_grid *g, const near_real *a)
{
    near_real most = 0;
    for (uint32_t i = 0; i < g->row_count; ++i) {
        const near_real size = a[i] < 0 ? -a[i] : a[i];
        most = size > most ? size : most;
    }
    return most;
}

//---- the matrix ----------------------------------------------------------------------------------

typedef struct ends {
    uint32_t before, behind; // rows on both sides of a face; that of air: row_count
} ends;

static ends ends_of(const pl_liquid_grid *g, const pl_liquid_link *link)
{
    const uint32_t other = link->upright ? g->down[link->cell] : g->left[link->cell];
    const uint32_t a = g->row[other], b = g->row[link->cell];
    return (ends){ other == 0 || a == PL_LIQUID_NONE ? g->row_count : a,
                   b == PL_LIQUID_NONE ? g->row_count : b };
}

// What pressures P do to the sums of bodies: force over density h^2.
static void sum_links(pl_liquid_grid *g, const near_real *p)
{
    for (uint32_t b = 0; b < g->body_count; ++b) {
        g->bodies[b].sum[0] = g->bodies[b].sum[1] = g->bodies[b].sum[2] = 0;
    }
    for (uint32_t i = 0; i < g->link_count; ++i) {
        const pl_liquid_link *link = &g->links[i];
        const ends at = ends_of(g, link);
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

static void add_bodies(pl_liquid_grid *g, const near_real *p, near_real *out, double push)
{
    sum_links(g, p);
    for (uint32_t i = 0; i < g->link_count; ++i) {
        const pl_liquid_link *link = &g->links[i];
        const pl_liquid_body *b = &g->bodies[link->body];
        const double motion[3] = { push * b->inv_mass_x * b->sum[0],
                                   push * b->inv_mass_y * b->sum[1],
                                   push * b->inv_inertia * b->sum[2] };
        const near_real flow = link->part * speed_of(link, motion);
        const ends at = ends_of(g, link);
        out[at.before] += flow;
        out[at.behind] -= flow;
    }
    out[g->row_count] = 0;
}

static void multiply(pl_liquid_grid *g, const near_real *p, near_real *out, double push)
{
    for (uint32_t i = 0; i < g->row_count; ++i) {
        const pl_liquid_row *row = &g->rows[i];
        out[i] = row->diagonal * p[i] - row->open[0] * p[row->next[0]] -
                 row->open[1] * p[row->next[1]] - row->open[2] * p[row->next[2]] -
                 row->open[3] * p[row->next[3]];
    }
    if (push > 0 && g->link_count > 0) {
        add_bodies(g, p, out, push);
    }
}

// Forward and back through the factor.
static void precondition(const pl_liquid_grid *g, const near_real *r, near_real *q, near_real *z)
{
    const near_real *e = g->vectors[PL_LIQUID_E];
    const uint32_t n = g->row_count;
    for (uint32_t i = 0; i < n; ++i) {
        const pl_liquid_row *row = &g->rows[i];
        const uint32_t a = row->next[0], b = row->next[2];
        q[i] = (r[i] + row->open[0] * e[a] * q[a] + row->open[2] * e[b] * q[b]) * e[i];
    }
    for (uint32_t i = n; i-- > 0;) {
        const pl_liquid_row *row = &g->rows[i];
        const uint32_t a = row->next[1], b = row->next[3];
        z[i] = (q[i] + e[i] * (row->open[1] * z[a] + row->open[3] * z[b])) * e[i];
    }
}

//---- conjugate gradients -------------------------------------------------------------------------

void pl_liquid_solve(pl_liquid_grid *g, double push, double tolerance)
{
    near_real *p = g->vectors[PL_LIQUID_P], *r = g->vectors[PL_LIQUID_R];
    near_real *s = g->vectors[PL_LIQUID_S], *q = g->vectors[PL_LIQUID_Q],
              *z = g->vectors[PL_LIQUID_Z];
    const uint32_t n = g->row_count;
    memset(p, 0, (n + 1) * sizeof *p);
    memset(z, 0, (n + 1) * sizeof *z);
    memset(q, 0, (n + 1) * sizeof *q);
    const near_real enough = (near_real)tolerance * largest(g, r);
    precondition(g, r, q, z);
    memcpy(s, z, (n + 1) * sizeof *s);
    double sigma = dot(g, z, r);
    for (int k = 0; k < MOST_ITERATIONS && sigma > 0; ++k) {
        multiply(g, s, z, push);
        const double bend = dot(g, s, z);
        if (!(bend > 0)) {
            return;
        }
        const near_real alpha = (near_real)(sigma / bend);
        for (uint32_t i = 0; i < n; ++i) {
            p[i] += alpha * s[i];
            r[i] -= alpha * z[i];
        }
        if (!(largest(g, r) > enough)) {
            return;
        }
        precondition(g, r, q, z);
        const double next = dot(g, z, r);
        const near_real beta = (near_real)(next / sigma);
        sigma = next;
        for (uint32_t i = 0; i < n; ++i) {
            s[i] = z[i] + beta * s[i];
        }
    }
}

//---- velocities ----------------------------------------------------------------------------------

// The right side: what flows into a cell.
static void inflow(pl_liquid_grid *g, near_real *r)
{
    for (uint32_t i = 0; i < g->row_count; ++i) {
        const uint32_t c = g->rows[i].cell, right = g->right[c], up = g->up[c];
        const near_real *open = g->rows[i].open;
        r[i] = open[0] * g->u[c] + g->solid_u[c] - open[1] * g->u[right] - g->solid_u[right] +
               open[2] * g->v[c] + g->solid_v[c] - open[3] * g->v[up] - g->solid_v[up];
    }
}

static near_real pressure_at(const pl_liquid_grid *g, uint32_t c)
{
    return c == 0 || g->row[c] == PL_LIQUID_NONE ? 0 : g->vectors[PL_LIQUID_P][g->row[c]];
}

// Faces between a cell with liquid and anything get the pressure's slope; closed ones are found anew (pl_liquid_bound).
static void add_slopes(pl_liquid_grid *g)
{
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const uint32_t left = g->left[c], down = g->down[c];
        const bool here = g->row[c] != PL_LIQUID_NONE;
        if (here || g->row[left] != PL_LIQUID_NONE) {
            g->u[c] -= (pressure_at(g, c) - pressure_at(g, left)) / pl_liquid_gap(g, left, c);
            g->known_u[c] = 1;
        }
        if (here || g->row[down] != PL_LIQUID_NONE) {
            g->v[c] -= (pressure_at(g, c) - pressure_at(g, down)) / pl_liquid_gap(g, down, c);
            g->known_v[c] = 1;
        }
        g->known_u[c] = g->open_u[c] > 0 ? g->known_u[c] : 0;
        g->known_v[c] = g->open_v[c] > 0 ? g->known_v[c] : 0;
    }
}

static void push_bodies(pl_liquid_grid *g, double push)
{
    sum_links(g, g->vectors[PL_LIQUID_P]);
    for (uint32_t i = 0; i < g->body_count; ++i) {
        pl_liquid_body *b = &g->bodies[i];
        b->impulse_x += push * b->sum[0];
        b->impulse_y += push * b->sum[1];
        b->turn += push * b->sum[2];
        b->vx += push * b->inv_mass_x * b->sum[0];
        b->vy += push * b->inv_mass_y * b->sum[1];
        b->w += push * b->inv_inertia * b->sum[2];
    }
}

void pl_liquid_project(pl_liquid_grid *g, double push)
{
    inflow(g, g->vectors[PL_LIQUID_R]);
    pl_liquid_solve(g, push, 1e-5);
    add_slopes(g);
    push_bodies(g, push);
}

static bool has_room(const pl_liquid_grid *g, uint32_t c)
{
    return g->cover[c] < (near_real)0.999;
}

// Closed faces of cells that are not all solid go as what closes them, whether there is liquid now or not: else drops
// would feel a way into walls. Those deeper in solids go on as the liquid beside them: walls are smooth.
void pl_liquid_bound(pl_liquid_grid *g)
{
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const bool here = has_room(g, c);
        if (g->open_u[c] == 0 && (here || has_room(g, g->left[c]))) {
            g->u[c] = g->solid_u[c];
            g->known_u[c] = 1;
        }
        if (g->open_v[c] == 0 && (here || has_room(g, g->down[c]))) {
            g->v[c] = g->solid_v[c];
            g->known_v[c] = 1;
        }
    }
}
