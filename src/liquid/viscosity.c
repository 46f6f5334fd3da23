// viscosity.c - viscosity of any size: the stresses at the end of the step, not at its beginning.
//
// The velocities u that end a step of dt make
//
//     1/2 |u - u_before|^2 + k sum w |D|^2,   k = viscosity dt / (density h^2),
//
// least (Batty, Bridson 2008), D the rates of strain: du/dx and dv/dy at centres of cells, half of du/dy + dv/dx at their
// corners, which is 0 for whatever turns as a whole: a drop of honey spins on. Stresses are those of cells with
// liquid; corners at which a face is air's have none, so surfaces are free. Faces that solids close move as they do; their
// lines are half a cell from the faces beside them, so slopes there count twice. The system is symmetric: conjugate
// gradients with its diagonal, which lose energy in each iteration: cut short it is stable all the same.
//
// Reads: openness, rows, speeds of what closes. Writes: velocities of faces. Cost: O(cells with liquid x iterations),
// and iterations grow as the square root of k.
#include "liquid/liquid.h"

#include <string.h>

#define MOST_ITERATIONS 200
#define SOLVE_TO        1e-4
#define QUARTER         ((near_real)0.25)

// Columns of cells, 0 where nothing flows.
enum {
    U, // the velocities; of faces that are closed those of the solids
    V,
    FREE_U, // 1: unknown
    FREE_V,
    WEIGHT,  // of a cell
    CORNER,  // of the one at the lower left
    TWICE_U, // 2: the slope to the face below ends at a wall, half a cell away
    TWICE_V,
    LEFT_U, // what is left
    LEFT_V,
    WAY_U, // where conjugate gradients go
    WAY_V,
    OUT_U, // the matrix times that
    OUT_V,
    DIAGONAL_U,
    DIAGONAL_V,
    XX, // stresses
    YY,
    XY,
    COLUMNS
};

typedef struct system {
    pl_liquid_grid *g;
    near_real k;
    near_real *col[COLUMNS];
    uint32_t *cells; // in which something is not 0
    uint32_t count;
} system;

//---- what is unknown -----------------------------------------------------------------------------

static void find_faces(system *s)
{
    const pl_liquid_grid *g = s->g;
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const bool wet = g->row[c] != 0;
        const bool u = wet || g->row[g->left[c]] != 0, v = wet || g->row[g->down[c]] != 0;
        s->col[FREE_U][c] = u && g->open_u[c] > 0;
        s->col[FREE_V][c] = v && g->open_v[c] > 0;
        s->col[U][c] = g->open_u[c] > 0 ? g->u[c] : g->solid_u[c];
        s->col[V][c] = g->open_v[c] > 0 ? g->v[c] : g->solid_v[c];
        s->col[WEIGHT][c] = wet;
    }
}

// How much the slope from a face to the one before it counts; 0: one of them is air's.
static near_real slope_of(const near_real *is_free, const near_real *open, uint32_t a, uint32_t b)
{
    const bool shut_a = open[a] == 0, shut_b = open[b] == 0;
    if ((is_free[a] == 0 && !shut_a) || (is_free[b] == 0 && !shut_b)) {
        return 0;
    }
    return shut_a != shut_b ? 2 : 1;
}

static void find_corners(system *s)
{
    const pl_liquid_grid *g = s->g;
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const uint32_t left = g->left[c], down = g->down[c], both = g->left[down];
        const near_real wet =
            s->col[WEIGHT][c] + s->col[WEIGHT][left] + s->col[WEIGHT][down] + s->col[WEIGHT][both];
        const near_real u = slope_of(s->col[FREE_U], g->open_u, c, down);
        const near_real v = slope_of(s->col[FREE_V], g->open_v, c, left);
        const bool counts = wet > 0 && u > 0 && v > 0;
        s->col[CORNER][c] = counts ? QUARTER * wet : 0;
        s->col[TWICE_U][c] = counts ? u : 0;
        s->col[TWICE_V][c] = counts ? v : 0;
        if (counts || s->col[WEIGHT][c] + s->col[FREE_U][c] + s->col[FREE_V][c] > 0) {
            s->cells[s->count++] = c;
        }
    }
}

static void find_diagonal(system *s)
{
    const pl_liquid_grid *g = s->g;
    const near_real *w = s->col[WEIGHT], *corner = s->col[CORNER];
    const near_real *u = s->col[TWICE_U], *v = s->col[TWICE_V];
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t c = s->cells[i], up = g->up[c], right = g->right[c];
        const near_real corner_u = u[c] * u[c] * corner[c] + u[up] * u[up] * corner[up];
        const near_real corner_v = v[c] * v[c] * corner[c] + v[right] * v[right] * corner[right];
        s->col[DIAGONAL_U][c] = 1 + s->k * (2 * (w[c] + w[g->left[c]]) + corner_u);
        s->col[DIAGONAL_V][c] = 1 + s->k * (2 * (w[c] + w[g->down[c]]) + corner_v);
    }
}

//---- the matrix ----------------------------------------------------------------------------------

static void find_stresses(system *s, const near_real *u, const near_real *v)
{
    const pl_liquid_grid *g = s->g;
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t c = s->cells[i];
        const near_real w = 2 * s->col[WEIGHT][c];
        s->col[XX][c] = w * (u[g->right[c]] - u[c]);
        s->col[YY][c] = w * (v[g->up[c]] - v[c]);
        s->col[XY][c] = s->col[CORNER][c] * (s->col[TWICE_U][c] * (u[c] - u[g->down[c]]) +
                                             s->col[TWICE_V][c] * (v[c] - v[g->left[c]]));
    }
}

// out = mass (u, v) - k (what stresses do to them), of faces that are unknown.
static void apply(system *s, const near_real *u, const near_real *v, near_real mass,
                  near_real *out_u, near_real *out_v)
{
    const pl_liquid_grid *g = s->g;
    const near_real *xx = s->col[XX], *yy = s->col[YY], *xy = s->col[XY];
    const near_real *twice_u = s->col[TWICE_U], *twice_v = s->col[TWICE_V];
    find_stresses(s, u, v);
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t c = s->cells[i], up = g->up[c], right = g->right[c];
        const near_real x = xx[c] - xx[g->left[c]] + twice_u[up] * xy[up] - twice_u[c] * xy[c];
        const near_real y =
            yy[c] - yy[g->down[c]] + twice_v[right] * xy[right] - twice_v[c] * xy[c];
        out_u[c] = s->col[FREE_U][c] * (mass * u[c] - s->k * x);
        out_v[c] = s->col[FREE_V][c] * (mass * v[c] - s->k * y);
    }
}

//---- conjugate gradients -------------------------------------------------------------------------

// Of two columns beside one another; `over`: divided by the diagonal.
static double dot(const system *s, int a, int b, bool over)
{
    double total = 0;
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t c = s->cells[i];
        const double u = (double)s->col[a][c] * (double)s->col[b][c];
        const double v = (double)s->col[a + 1][c] * (double)s->col[b + 1][c];
        total +=
            over ? u / (double)s->col[DIAGONAL_U][c] + v / (double)s->col[DIAGONAL_V][c] : u + v;
    }
    return total;
}

// to = to factor_to + from factor_from, over the diagonal if `over`.
static void add(system *s, int to, near_real keep, int from, near_real factor, bool over)
{
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t c = s->cells[i];
        const near_real u = over ? s->col[from][c] / s->col[DIAGONAL_U][c] : s->col[from][c];
        const near_real v =
            over ? s->col[from + 1][c] / s->col[DIAGONAL_V][c] : s->col[from + 1][c];
        s->col[to][c] = keep * s->col[to][c] + factor * u;
        s->col[to + 1][c] = keep * s->col[to + 1][c] + factor * v;
    }
}

static void solve(system *s)
{
    apply(s, s->col[U], s->col[V], 0, s->col[LEFT_U], s->col[LEFT_V]);
    add(s, LEFT_U, -1, LEFT_U, 0, false);
    add(s, WAY_U, 0, LEFT_U, 1, true);
    double sigma = dot(s, LEFT_U, LEFT_U, true);
    const double enough = SOLVE_TO * SOLVE_TO * sigma;
    for (int n = 0; n < MOST_ITERATIONS && sigma > enough; ++n) {
        apply(s, s->col[WAY_U], s->col[WAY_V], 1, s->col[OUT_U], s->col[OUT_V]);
        const double bend = dot(s, WAY_U, OUT_U, false);
        if (!(bend > 0)) {
            return;
        }
        const near_real alpha = (near_real)(sigma / bend);
        add(s, U, 1, WAY_U, alpha, false);
        add(s, LEFT_U, 1, OUT_U, -alpha, false);
        const double next = dot(s, LEFT_U, LEFT_U, true);
        add(s, WAY_U, (near_real)(next / sigma), LEFT_U, 1, true);
        sigma = next;
    }
}

bool pl_liquid_diffuse(pl_memory *memory, pl_liquid_scratch *scratch, double amount)
{
    pl_liquid_grid *g = &scratch->grid;
    const size_t room = (g->cell_count + 1) * sizeof(near_real);
    if (!pl_buffer_reserve(memory, &scratch->viscous, COLUMNS * room) ||
        !pl_buffer_reserve(memory, &scratch->keys, (g->cell_count + 1) * sizeof(uint32_t))) {
        return false;
    }
    const double most = PL_LIQUID_THICK;
    system s = { .g = g,
                 .k = (near_real)(amount < most ? amount : most),
                 .cells = scratch->keys.data };
    memset(scratch->viscous.data, 0, COLUMNS * room);
    for (int i = 0; i < COLUMNS; ++i) {
        s.col[i] = (near_real *)scratch->viscous.data + (size_t)i * (g->cell_count + 1);
    }
    find_faces(&s);
    find_corners(&s);
    find_diagonal(&s);
    solve(&s);
    for (uint32_t i = 0; i < s.count; ++i) {
        const uint32_t c = s.cells[i];
        g->u[c] = s.col[FREE_U][c] > 0 ? s.col[U][c] : g->u[c];
        g->v[c] = s.col[FREE_V][c] > 0 ? s.col[V][c] : g->v[c];
    }
    return true;
}
