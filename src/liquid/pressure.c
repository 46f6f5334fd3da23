// pressure.c - what keeps the liquid's volume: one symmetric system for the pressures of cells and the velocities of
// bodies.
//
// With P = p dt / (density h) [m/s], the row of a cell is
//
//     sum a (P - P_beside) + sum_b K_b c_b (c_b . P) = -(what flows out of it),
//
// a the openness of its faces (times how light what is there is, see phases.c), P = 0 in air, c_b how a motion of body b fills the cell: three columns a body, for x, y
// and its turn, K = density h^2 times inverse mass or inertia (Batty, Bertails, Bridson 2007, with faces as Ng, Min, Gibou
// 2009 open them). The terms of a body have rank one each: they are added by its links, matrix-free. Conjugate
// gradients, preconditioned by a cycle of coarser grids without the bodies (multigrid.c).
//
// Sums run in fixed parts, so that neither lanes nor threads change a bit.
//
// Reads: openness, velocities, links. Writes: strips, vectors, velocities of faces and bodies. Cost: O(rows x iterations).
#include "liquid/liquid.h"

#include <math.h>
#include <string.h>

#define MOST_ITERATIONS 100
#define LINE            PL_LIQUID_SIDE
#define CHUNK                                                                                      \
    8 // strips of a sum that is one part of a total: fixed, so that nothing decides its bits
#define LEAST 64 // strips that are worth a thread
// Of a face. Through a gap of a hundredth bodies press out water at 50 m/s: a particle that took that would have a hundred times the momentum
// of what flows there.
#define THIN ((near_real)0.05)

//---- the matrix ----------------------------------------------------------------------------------

static near_real weight_of(const pl_liquid_grid *g, near_real open, uint32_t c, uint32_t near)
{
    return open == 0 || g->row[near] != 0 ? open : open / pl_liquid_gap(g, c, near);
}

static void fill_strip(pl_liquid_grid *g, uint32_t s)
{
    for (uint32_t i = 0; i < PL_LIQUID_SIDE; ++i) {
        const uint32_t c = g->strips[s].cell + i, row = g->row[c];
        if (row == 0) {
            continue;
        }
        const uint32_t left = g->left[c], right = g->right[c], down = g->down[c], up = g->up[c];
        near_real open[4];
        pl_liquid_faces_of(g, c, open);
        open[0] *= pl_liquid_light_u(g, c);
        open[1] *= pl_liquid_light_u(g, right);
        open[2] *= pl_liquid_light_v(g, c);
        open[3] *= pl_liquid_light_v(g, up);
        // What is not beside it in memory, or below its strip, lies across a wrap.
        const bool below = g->row[down] >= LINE && g->row[down] / LINE == g->strips[s].down;
        g->vectors[PL_LIQUID_L][row] = g->row[left] == row - 1 ? open[0] : 0;
        g->vectors[PL_LIQUID_B][row] = below ? open[2] : 0;
        g->vectors[PL_LIQUID_D][row] =
            weight_of(g, open[0], c, left) + weight_of(g, open[1], c, right) +
            weight_of(g, open[2], c, down) + weight_of(g, open[3], c, up);
    }
}

static void fill_range(void *context, uint32_t first, uint32_t count)
{
    for (uint32_t s = 1 + first; s < 1 + first + count; ++s) {
        fill_strip(context, s);
    }
}

static bool add_line(pl_memory *memory, pl_liquid_scratch *scratch, uint32_t tile, uint32_t line)
{
    pl_liquid_grid *g = &scratch->grid;
    const uint32_t c = 1 + tile * PL_LIQUID_TILE + line * PL_LIQUID_SIDE;
    const uint32_t row = g->strip_count * PL_LIQUID_SIDE;
    bool any = false;
    for (uint32_t i = 0; i < PL_LIQUID_SIDE; ++i) {
        const bool wet = g->wet[c + i];
        g->row[c + i] = wet ? row + i : 0;
        any |= wet;
    }
    return !any || pl_liquid_add_strip(memory, scratch, g->tiles[tile].x,
                                       g->tiles[tile].y * PL_LIQUID_SIDE + (int32_t)line, c);
}

// Strips by their height, then from left to right.
static bool add_strips(pl_memory *memory, pl_liquid_scratch *scratch)
{
    const pl_liquid_grid *g = &scratch->grid;
    for (uint32_t first = 0, end; first < g->tile_count; first = end) {
        for (end = first; end < g->tile_count && g->tiles[end].y == g->tiles[first].y;) {
            ++end;
        }
        for (uint32_t line = 0; line < PL_LIQUID_SIDE; ++line) {
            for (uint32_t t = first; t < end; ++t) {
                if (!add_line(memory, scratch, t, line)) {
                    return false;
                }
            }
        }
    }
    return true;
}

bool pl_liquid_plan(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_liquid_grid *g = &scratch->grid;
    if (!pl_liquid_find_wet(memory, scratch) || !pl_liquid_first_strip(memory, scratch) ||
        !add_strips(memory, scratch) || !pl_liquid_make_grids(memory, scratch) ||
        !pl_liquid_find_rims(memory, scratch) || !pl_liquid_find_rooms(memory, scratch)) {
        return false;
    }
    const size_t room =
        ((size_t)g->strip_count + 1) * PL_LIQUID_SIDE; // one more: lines look beside
    const size_t parts = (g->levels[0].end + CHUNK) / CHUNK + 1;
    if (!pl_buffer_reserve(memory, &scratch->vectors,
                           PL_LIQUID_VECTORS * room * sizeof(near_real)) ||
        !pl_buffer_reserve(memory, &scratch->sums, parts * sizeof *g->sums)) {
        return false;
    }
    g->sums = scratch->sums.data;
    memset(scratch->vectors.data, 0, PL_LIQUID_VECTORS * room * sizeof(near_real));
    for (int k = 0; k < PL_LIQUID_VECTORS; ++k) {
        g->vectors[k] = (near_real *)scratch->vectors.data + (size_t)k * room;
    }
    pl_tasks_ranges(g->tasks, g->levels[0].end - 1, LEAST, fill_range, g);
    pl_liquid_fold_grids(g);
    return true;
}

// The same of what lies across wraps, where a grid goes on at its other side.
static double add_wraps(const pl_liquid_grid *g, const near_real *p, near_real *out)
{
    double bend = 0;
    for (uint32_t i = 0; i < g->wrap_count; ++i) {
        const pl_liquid_wrap *s = &g->wraps[i];
        bend -= 2 * (double)(s->open * p[s->a] * p[s->b]);
        out[s->a] -= s->open * p[s->b];
        out[s->b] -= s->open * p[s->a];
    }
    return bend;
}

//---- conjugate gradients -------------------------------------------------------------------------

typedef struct work {
    pl_liquid_grid *g;
    near_real factor;
} work;

typedef struct interval {
    uint32_t first, end; // strips
} interval;

static interval interval_of(const pl_liquid_grid *g, uint32_t chunk)
{
    const uint32_t first = 1 + chunk * CHUNK, end = first + CHUNK, all = g->levels[0].end;
    return (interval){ first, end < all ? end : all };
}

// Z = A S, and S . Z
static void multiply_chunks(void *context, uint32_t first, uint32_t count)
{
    pl_liquid_grid *g = ((work *)context)->g;
    for (uint32_t c = first; c < first + count; ++c) {
        const interval at = interval_of(g, c);
        g->sums[c] = g->kernels->multiply(g, at.first, at.end, g->vectors[PL_LIQUID_S],
                                          g->vectors[PL_LIQUID_Z]);
    }
}

static void descend_chunks(void *context, uint32_t first, uint32_t count)
{
    const work *w = context;
    for (uint32_t c = first; c < first + count; ++c) {
        const interval at = interval_of(w->g, c);
        w->g->sums[c] = w->g->kernels->descend(w->g, at.first, at.end, w->factor);
    }
}

// The last sweep of a cycle, and Q . R. Without a coarser grid it repeats the last of those that the cycle made.
static void sweep_chunks(void *context, uint32_t first, uint32_t count)
{
    pl_liquid_grid *g = ((work *)context)->g;
    for (uint32_t c = first; c < first + count; ++c) {
        const interval at = interval_of(g, c);
        g->sums[c] = g->kernels->sweep(g, at.first, at.end, g->vectors[PL_LIQUID_Z],
                                       g->vectors[PL_LIQUID_Q]);
    }
}

static void turn_chunks(void *context, uint32_t first, uint32_t count)
{
    const work *w = context;
    for (uint32_t c = first; c < first + count; ++c) {
        const interval at = interval_of(w->g, c);
        w->g->kernels->turn(w->g, at.first, at.end, w->factor);
    }
}

static uint32_t chunk_count(const pl_liquid_grid *g)
{
    return (g->levels[0].end - 1 + CHUNK - 1) / CHUNK;
}

static void run(pl_liquid_grid *g, pl_range_fn *range, double factor)
{
    work w = { g, (near_real)factor };
    pl_tasks_ranges(g->tasks, chunk_count(g), LEAST / CHUNK, range, &w);
}

// In their order, whoever made them.
static double sum_of(const pl_liquid_grid *g)
{
    double total = 0;
    for (uint32_t c = 0; c < chunk_count(g); ++c) {
        total += g->sums[c];
    }
    return total;
}

static double most_of(const pl_liquid_grid *g)
{
    double most = 0;
    for (uint32_t c = 0; c < chunk_count(g); ++c) {
        most = g->sums[c] > most ? g->sums[c] : most;
    }
    return most;
}

// Of rooms that are evened out: the cycle would make much of a mean, as it does not know bodies.
static void even_residual(pl_liquid_grid *g)
{
    const near_real *inverse = g->vectors[PL_LIQUID_I];
    near_real *r = g->vectors[PL_LIQUID_R], *z = g->vectors[PL_LIQUID_Z];
    pl_liquid_even_rooms(g, r);
    for (uint32_t i = 0; i < g->room_cell_count; ++i) {
        const uint32_t row = g->room_cells[i].row;
        z[row] = inverse[row] * r[row];
    }
}

void pl_liquid_solve(pl_liquid_grid *g, double push, double tolerance, double floor)
{
    const size_t bytes = (size_t)g->levels[0].end * LINE * sizeof(near_real);
    memset(g->vectors[PL_LIQUID_P], 0, bytes);
    memset(g->vectors[PL_LIQUID_S], 0, bytes);
    memset(g->vectors[PL_LIQUID_Z], 0, bytes);
    run(g, descend_chunks, 0);
    even_residual(g);
    const double wanted = tolerance * most_of(g), enough = wanted > floor ? wanted : floor;
    double sigma = 0;
    g->iterations = 0;
    for (int k = 0; k < MOST_ITERATIONS && most_of(g) > enough; ++k) {
        pl_liquid_cycle(g);
        run(g, sweep_chunks, 0);
        const double next = sum_of(g);
        if (!(next > 0)) {
            return;
        }
        near_real *way = g->vectors[PL_LIQUID_S], *product = g->vectors[PL_LIQUID_Z];
        run(g, turn_chunks, k > 0 ? next / sigma : 0);
        sigma = next;
        pl_liquid_even_rooms(g, way);
        run(g, multiply_chunks, 0);
        const double bend =
            sum_of(g) + pl_liquid_add_links(g, way, product, push) + add_wraps(g, way, product);
        if (!(bend > 0)) {
            return;
        }
        run(g, descend_chunks, sigma / bend);
        even_residual(g);
        ++g->iterations;
    }
}

//---- velocities ----------------------------------------------------------------------------------

// The right side: what flows into a cell.
static void inflow_range(void *context, uint32_t first, uint32_t count)
{
    pl_liquid_grid *g = context;
    for (uint32_t s = 1 + first; s < 1 + first + count; ++s) {
        for (uint32_t i = 0; i < LINE; ++i) {
            const uint32_t c = g->strips[s].cell + i, right = g->right[c], up = g->up[c];
            if (g->row[c] != 0) {
                g->vectors[PL_LIQUID_R][g->row[c]] =
                    g->open_u[c] * g->u[c] + g->solid_u[c] - g->open_u[right] * g->u[right] -
                    g->solid_u[right] + g->open_v[c] * g->v[c] + g->solid_v[c] -
                    g->open_v[up] * g->v[up] - g->solid_v[up] + g->swell[c];
            }
        }
    }
}

// What is less open is, to particles, as if it were shut.
static near_real thin_of(const pl_liquid_grid *g)
{
    return g->films ? THIN : 0;
}

// Faces between a cell with liquid and anything get the pressure's slope, but those that are shut: in a room that bodies close
// pressures are what they may, up to 100 m/s from cell to cell. Thin ones are found anew (pl_liquid_extrapolate, pl_liquid_bound).
static void slope_cells(void *context, uint32_t first, uint32_t count)
{
    pl_liquid_grid *g = context;
    const near_real *p = g->vectors[PL_LIQUID_P], thin = thin_of(g);
    for (uint32_t c = 1 + first; c < 1 + first + count; ++c) {
        const uint32_t left = g->left[c], down = g->down[c], here = g->row[c];
        if (g->open_u[c] > 0 && (here != 0 || g->row[left] != 0)) {
            g->u[c] -=
                pl_liquid_light_u(g, c) * (p[here] - p[g->row[left]]) / pl_liquid_gap(g, left, c);
            g->known_u[c] = 1;
        }
        if (g->open_v[c] > 0 && (here != 0 || g->row[down] != 0)) {
            g->v[c] -=
                pl_liquid_light_v(g, c) * (p[here] - p[g->row[down]]) / pl_liquid_gap(g, down, c);
            g->known_v[c] = 1;
        }
        g->known_u[c] = g->open_u[c] > thin ? g->known_u[c] : 0;
        g->known_v[c] = g->open_v[c] > thin ? g->known_v[c] : 0;
    }
}

void pl_liquid_find_inflow(pl_liquid_grid *g)
{
    pl_tasks_ranges(g->tasks, g->levels[0].end - 1, LEAST, inflow_range, g);
}

void pl_liquid_take_pressure(pl_liquid_grid *g, double push)
{
    pl_liquid_cells(g, slope_cells);
    pl_liquid_push_bodies(g, push);
}

bool pl_liquid_project(pl_memory *memory, pl_liquid_scratch *scratch, double push)
{
    pl_liquid_grid *g = &scratch->grid;
    pl_liquid_find_inflow(g);
    if (!pl_liquid_balance(memory, scratch, true)) {
        return false;
    }
    pl_liquid_solve(g, push, 1e-5, 0);
    pl_liquid_take_pressure(g, push);
    return true;
}

static bool has_room(const pl_liquid_grid *g, uint32_t c)
{
    return g->cover[c] < (near_real)0.999;
}

static void bound_face(near_real *speed, uint8_t *known, near_real solid, near_real open,
                       near_real thin, bool room)
{
    if (open == 0 ? room : open <= thin && *known == 0) {
        *speed = solid / (1 - open);
        *known = 1;
    }
}

static void bound_cells(void *context, uint32_t first, uint32_t count)
{
    pl_liquid_grid *g = context;
    const near_real thin = thin_of(g);
    for (uint32_t c = 1 + first; c < 1 + first + count; ++c) {
        const bool here = has_room(g, c);
        bound_face(&g->u[c], &g->known_u[c], g->solid_u[c], g->open_u[c], thin,
                   here || has_room(g, g->left[c]));
        bound_face(&g->v[c], &g->known_v[c], g->solid_v[c], g->open_v[c], thin,
                   here || has_room(g, g->down[c]));
    }
}

// Closed faces of cells that are not all solid go as what closes them, whether there is liquid now or not: else drops
// would feel a way into walls. Those deeper in solids go on as the liquid beside them: walls are smooth. So do thin ones, if there is any.
void pl_liquid_bound(pl_liquid_grid *g)
{
    pl_liquid_cells(g, bound_cells);
}
