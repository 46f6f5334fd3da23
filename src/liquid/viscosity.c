// viscosity.c - viscosity of any size: the stresses at the end of the step, not at its beginning.
//
// The velocities u that end a step of dt make
//
//     1/2 m |u - u_before|^2 + k sum w |D|^2,   k = viscosity dt / (density h^2),
//
// least (Batty, Bridson 2008), with the density of the first phase, m that of a face over it, the largest viscosity, w that
// of a cell over it: both are 1 where there is one phase. D are the rates of strain: du/dx and dv/dy at centres of cells,
// half of du/dy + dv/dx at their corners, which is 0 for whatever turns as a whole: a drop of honey spins on. Stresses are
// those of cells with liquid; corners at which a face is air's have none, so surfaces are free. Faces that solids close
// move as they do; their lines are half a cell from the faces beside them, so slopes there count twice. The system is
// symmetric: conjugate gradients with its diagonal, which lose energy in each iteration: cut short it is stable all the
// same.
//
// Where the grid says so (`drag`), velocities of moving bodies are unknown too: three columns a body, which its links
// add to the faces that it closes, as in pressure.c. What walls take from the flow is then what bodies get.
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
    MASS_U,
    MASS_V,
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

// A body's part of the vectors; those of faces and of bodies have one mass, density h^2.
typedef struct dragged {
    double mass[3];     // over density h^2; 0: this axis does not move
    double diagonal[3]; // likewise
    double now[3], left[3], way[3], out[3];
} dragged;

typedef struct equations {
    pl_liquid_grid *g;
    near_real k;
    near_real *col[COLUMNS];
    uint32_t *cells; // in which something is not 0
    uint32_t count;
    dragged *bodies; // NULL: all are driven
} equations;

//---- what is unknown -----------------------------------------------------------------------------

static void find_faces(equations *s)
{
    const pl_liquid_grid *g = s->g;
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const bool wet = g->row[c] != 0;
        const bool u = wet || g->row[g->left[c]] != 0, v = wet || g->row[g->down[c]] != 0;
        s->col[FREE_U][c] = u && g->open_u[c] > 0;
        s->col[FREE_V][c] = v && g->open_v[c] > 0;
        s->col[U][c] = g->open_u[c] > 0 ? g->u[c] : g->solid_u[c];
        s->col[V][c] = g->open_v[c] > 0 ? g->v[c] : g->solid_v[c];
        s->col[MASS_U][c] = 1 / pl_liquid_light_u(g, c);
        s->col[MASS_V][c] = 1 / pl_liquid_light_v(g, c);
        s->col[WEIGHT][c] = !wet ? 0 : g->mixture != NULL ? g->mixture->thick[c] : 1;
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

static void find_corners(equations *s)
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

static void find_diagonal(equations *s)
{
    const pl_liquid_grid *g = s->g;
    const near_real *w = s->col[WEIGHT], *corner = s->col[CORNER];
    const near_real *u = s->col[TWICE_U], *v = s->col[TWICE_V];
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t c = s->cells[i], up = g->up[c], right = g->right[c];
        const near_real corner_u = u[c] * u[c] * corner[c] + u[up] * u[up] * corner[up];
        const near_real corner_v = v[c] * v[c] * corner[c] + v[right] * v[right] * corner[right];
        s->col[DIAGONAL_U][c] = s->col[MASS_U][c] + s->k * (2 * (w[c] + w[g->left[c]]) + corner_u);
        s->col[DIAGONAL_V][c] = s->col[MASS_V][c] + s->k * (2 * (w[c] + w[g->down[c]]) + corner_v);
    }
}

//---- the matrix ----------------------------------------------------------------------------------

static void find_stresses(equations *s, const near_real *u, const near_real *v)
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

// What stresses do to a face.
static near_real pull_u(const equations *s, uint32_t c)
{
    const uint32_t up = s->g->up[c];
    const near_real *xx = s->col[XX], *xy = s->col[XY], *twice = s->col[TWICE_U];
    return xx[c] - xx[s->g->left[c]] + twice[up] * xy[up] - twice[c] * xy[c];
}

static near_real pull_v(const equations *s, uint32_t c)
{
    const uint32_t right = s->g->right[c];
    const near_real *yy = s->col[YY], *xy = s->col[XY], *twice = s->col[TWICE_V];
    return yy[c] - yy[s->g->down[c]] + twice[right] * xy[right] - twice[c] * xy[c];
}

// out = inertia m (u, v) - k (what stresses do to them), of faces that are unknown.
static void apply(equations *s, const near_real *u, const near_real *v, near_real inertia,
                  near_real *out_u, near_real *out_v)
{
    find_stresses(s, u, v);
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t c = s->cells[i];
        out_u[c] = s->col[FREE_U][c] * (inertia * s->col[MASS_U][c] * u[c] - s->k * pull_u(s, c));
        out_v[c] = s->col[FREE_V][c] * (inertia * s->col[MASS_V][c] * v[c] - s->k * pull_v(s, c));
    }
}

//---- bodies --------------------------------------------------------------------------------------

// Links of faces that are all closed: open ones are unknown themselves.
static bool is_shut(const pl_liquid_grid *g, const pl_liquid_link *link)
{
    return link->upright ? g->open_v[link->cell] == 0 : g->open_u[link->cell] == 0;
}

static double mass_of(double inverse, const pl_liquid_grid *g)
{
    return inverse > 0 ? 1 / (inverse * g->drag) : 0;
}

static void find_bodies(equations *s)
{
    const pl_liquid_grid *g = s->g;
    for (uint32_t i = 0; i < g->body_count; ++i) {
        const pl_liquid_body *b = &g->bodies[i];
        dragged *d = &s->bodies[i];
        *d = (dragged){ .mass = { mass_of(b->inv_mass_x, g), mass_of(b->inv_mass_y, g),
                                  mass_of(b->inv_inertia, g) },
                        .now = { b->vx, b->vy, b->w } };
        memcpy(d->diagonal, d->mass, sizeof d->mass);
    }
    for (uint32_t i = 0; i < g->link_count; ++i) {
        const pl_liquid_link *link = &g->links[i];
        double *to = s->bodies[link->body].diagonal;
        if (is_shut(g, link)) {
            const int at = link->upright ? DIAGONAL_V : DIAGONAL_U;
            const int mass = link->upright ? MASS_V : MASS_U;
            const double part = (double)link->part, arm = (double)link->arm;
            const double more =
                part * part * (double)(s->col[at][link->cell] - s->col[mass][link->cell]);
            to[link->upright ? 1 : 0] += more > 0 ? more : 0;
            to[2] += more > 0 ? more * arm * arm : 0;
        }
    }
}

// Faces that bodies close go as these do: of a part of the vectors.
static void carry(equations *s, near_real *u, near_real *v)
{
    const pl_liquid_grid *g = s->g;
    for (uint32_t i = 0; i < g->link_count && s->bodies != NULL; ++i) {
        const pl_liquid_link *link = &g->links[i];
        if (is_shut(g, link)) {
            (link->upright ? v : u)[link->cell] = 0;
        }
    }
    for (uint32_t i = 0; i < g->link_count && s->bodies != NULL; ++i) {
        const pl_liquid_link *link = &g->links[i];
        if (is_shut(g, link)) {
            const double *way = s->bodies[link->body].way;
            (link->upright ? v : u)[link->cell] +=
                link->part * (near_real)(way[link->upright ? 1 : 0] + way[2] * (double)link->arm);
        }
    }
}

// What stresses of the last product do to bodies; with their mass times `of`, if that is not null.
static void drag_bodies(equations *s, bool inert)
{
    const pl_liquid_grid *g = s->g;
    for (uint32_t i = 0; i < g->body_count && s->bodies != NULL; ++i) {
        dragged *d = &s->bodies[i];
        for (int k = 0; k < 3; ++k) {
            d->out[k] = inert ? d->mass[k] * d->way[k] : 0;
        }
    }
    for (uint32_t i = 0; i < g->link_count && s->bodies != NULL; ++i) {
        const pl_liquid_link *link = &g->links[i];
        if (is_shut(g, link)) {
            const double pull =
                (double)(link->upright ? pull_v(s, link->cell) : pull_u(s, link->cell));
            const double got = -(double)s->k * (double)link->part * pull;
            double *out = s->bodies[link->body].out;
            out[link->upright ? 1 : 0] += got;
            out[2] += got * (double)link->arm;
        }
    }
    for (uint32_t i = 0; i < g->body_count && s->bodies != NULL; ++i) {
        for (int k = 0; k < 3; ++k) {
            s->bodies[i].out[k] = s->bodies[i].mass[k] > 0 ? s->bodies[i].out[k] : 0;
        }
    }
}

static double dot_bodies(const equations *s, bool bend)
{
    double total = 0;
    for (uint32_t i = 0; i < s->g->body_count && s->bodies != NULL; ++i) {
        const dragged *d = &s->bodies[i];
        for (int k = 0; k < 3; ++k) {
            total += bend             ? d->way[k] * d->out[k]
                     : d->mass[k] > 0 ? d->left[k] * d->left[k] / d->diagonal[k]
                                      : 0;
        }
    }
    return total;
}

// left = keep left + factor out; way = turn way + left over the diagonal.
static void go_bodies(equations *s, double alpha)
{
    for (uint32_t i = 0; i < s->g->body_count && s->bodies != NULL; ++i) {
        dragged *d = &s->bodies[i];
        for (int k = 0; k < 3; ++k) {
            d->now[k] += alpha * d->way[k];
            d->left[k] -= alpha * d->out[k];
        }
    }
}

static void turn_bodies(equations *s, double beta)
{
    for (uint32_t i = 0; i < s->g->body_count && s->bodies != NULL; ++i) {
        dragged *d = &s->bodies[i];
        for (int k = 0; k < 3; ++k) {
            d->way[k] = beta * d->way[k] + (d->mass[k] > 0 ? d->left[k] / d->diagonal[k] : 0);
        }
    }
}

// Bodies have what they got.
static void keep_bodies(equations *s)
{
    for (uint32_t i = 0; i < s->g->body_count && s->bodies != NULL; ++i) {
        pl_liquid_body *b = &s->g->bodies[i];
        const dragged *d = &s->bodies[i];
        const double push = s->g->drag;
        b->impulse_x += push * d->mass[0] * (d->now[0] - b->vx);
        b->impulse_y += push * d->mass[1] * (d->now[1] - b->vy);
        b->turn += push * d->mass[2] * (d->now[2] - b->w);
        b->vx = d->now[0], b->vy = d->now[1], b->w = d->now[2];
    }
}

//---- conjugate gradients -------------------------------------------------------------------------

// Of two columns beside one another; `over`: divided by the diagonal.
static double dot(const equations *s, int a, int b, bool over)
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
static void add(equations *s, int to, near_real keep, int from, near_real factor, bool over)
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

static void solve(equations *s)
{
    apply(s, s->col[U], s->col[V], 0, s->col[LEFT_U], s->col[LEFT_V]);
    drag_bodies(s, false);
    for (uint32_t i = 0; i < s->g->body_count && s->bodies != NULL; ++i) {
        for (int k = 0; k < 3; ++k) {
            s->bodies[i].left[k] = -s->bodies[i].out[k];
        }
    }
    add(s, LEFT_U, -1, LEFT_U, 0, false);
    add(s, WAY_U, 0, LEFT_U, 1, true);
    turn_bodies(s, 0);
    double sigma = dot(s, LEFT_U, LEFT_U, true) + dot_bodies(s, false);
    const double enough = SOLVE_TO * SOLVE_TO * sigma;
    for (int n = 0; n < MOST_ITERATIONS && sigma > enough; ++n) {
        carry(s, s->col[WAY_U], s->col[WAY_V]);
        apply(s, s->col[WAY_U], s->col[WAY_V], 1, s->col[OUT_U], s->col[OUT_V]);
        drag_bodies(s, true);
        const double bend = dot(s, WAY_U, OUT_U, false) + dot_bodies(s, true);
        if (!(bend > 0)) {
            return;
        }
        const near_real alpha = (near_real)(sigma / bend);
        add(s, U, 1, WAY_U, alpha, false);
        add(s, LEFT_U, 1, OUT_U, -alpha, false);
        go_bodies(s, (double)alpha);
        const double next = dot(s, LEFT_U, LEFT_U, true) + dot_bodies(s, false);
        add(s, WAY_U, (near_real)(next / sigma), LEFT_U, 1, true);
        turn_bodies(s, next / sigma);
        sigma = next;
    }
}

bool pl_liquid_diffuse(pl_memory *memory, pl_liquid_scratch *scratch, double amount)
{
    pl_liquid_grid *g = &scratch->grid;
    const size_t room = (g->cell_count + 1) * sizeof(near_real);
    const size_t columns = (COLUMNS * room + PL_ALIGN - 1) / PL_ALIGN * PL_ALIGN;
    if (!pl_buffer_reserve(memory, &scratch->viscous,
                           columns + (g->body_count + 1) * sizeof(dragged)) ||
        !pl_buffer_reserve(memory, &scratch->keys, (g->cell_count + 1) * sizeof(uint32_t))) {
        return false;
    }
    const double most = PL_LIQUID_THICK;
    equations s = { .g = g,
                    .k = (near_real)(amount < most ? amount : most),
                    .cells = scratch->keys.data };
    memset(scratch->viscous.data, 0, columns);
    for (int i = 0; i < COLUMNS; ++i) {
        s.col[i] = (near_real *)scratch->viscous.data + (size_t)i * (g->cell_count + 1);
    }
    find_faces(&s);
    find_corners(&s);
    find_diagonal(&s);
    if (g->drag > 0) {
        s.bodies = (dragged *)(void *)((char *)scratch->viscous.data + columns);
        find_bodies(&s);
    }
    solve(&s);
    keep_bodies(&s);
    for (uint32_t i = 0; i < s.count; ++i) {
        const uint32_t c = s.cells[i];
        g->u[c] = s.col[FREE_U][c] > 0 ? s.col[U][c] : g->u[c];
        g->v[c] = s.col[FREE_V][c] > 0 ? s.col[V][c] : g->v[c];
    }
    return true;
}
