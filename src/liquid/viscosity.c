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
// Where the grid says so (`drag`), velocities of moving bodies are unknown too (dragged.c). Grains are a viscosity that depends on
// the answer, with a stress beside (yield.c): the system is solved some times.
//
// Reads: openness, rows, speeds of what closes. Writes: velocities of faces. Cost: O(cells with liquid x iterations),
// and iterations grow as the square root of k.
#include "liquid/viscous.h"

#include <string.h>

#define MOST_ITERATIONS 200
#define SOLVE_TO        1e-4
#define MOST_YIELDS     4    // solutions with grains
#define SETTLED         1e-2 // of what yields, then no more
#define QUARTER         ((near_real)0.25)
#define HALF            ((near_real)0.5)
#define LEAST_MASS      ((near_real)0.25) // less, and light bodies shake
#define MOSTLY          ((near_real)0.9)  // of a face

//---- what is unknown -----------------------------------------------------------------------------

// 0..1, how much of a cell is liquid.
static near_real fill_of(const pl_liquid_grid *g, uint32_t c)
{
    const near_real full =
        pl_liquid_space(g, c) > PL_LIQUID_LEAST_ROOM ? pl_liquid_fullness(g, c) : 0;
    return (full < 1 ? full : 1) * (1 - g->cover[c]);
}

// Of a face between two cells over that of one in the midst of the liquid. Air, which has no particles, fills all of its cells.
static near_real mass_of(const pl_liquid_grid *g, uint32_t a, uint32_t b)
{
    if (g->point_count == 0) {
        return 1;
    }
    const near_real fill = HALF * (fill_of(g, a) + fill_of(g, b));
    return fill > LEAST_MASS ? fill : LEAST_MASS;
}

// Of what bodies close by whole areas most counts as closed: they leave films open, which are no boundary (films.c).
static near_real shut_of(const pl_liquid_grid *g, near_real open, near_real closed)
{
    return open == 0 ? 1 : g->films && closed > MOSTLY ? closed : 0;
}

static void find_shut(pl_viscous *s)
{
    const pl_liquid_grid *g = s->g;
    if (g->films) {
        pl_viscous_add_closed(s);
    }
    for (uint32_t c = 0; c < g->cell_count; ++c) {
        s->shut.u[c] = shut_of(g, g->open_u[c], s->shut.u[c]);
        s->shut.v[c] = shut_of(g, g->open_v[c], s->shut.v[c]);
    }
}

static void find_faces(pl_viscous *s)
{
    const pl_liquid_grid *g = s->g;
    const near_real *shut_u = s->shut.u, *shut_v = s->shut.v;
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const bool wet = g->row[c] != 0;
        const bool u = wet || g->row[g->left[c]] != 0, v = wet || g->row[g->down[c]] != 0;
        s->is_free.u[c] = u && shut_u[c] == 0;
        s->is_free.v[c] = v && shut_v[c] == 0;
        s->speed.u[c] = shut_u[c] == 0 ? g->u[c] : g->solid_u[c] / shut_u[c];
        s->speed.v[c] = shut_v[c] == 0 ? g->v[c] : g->solid_v[c] / shut_v[c];
        s->mass.u[c] = mass_of(g, g->left[c], c) / pl_liquid_light_u(g, c);
        s->mass.v[c] = mass_of(g, g->down[c], c) / pl_liquid_light_v(g, c);
        const near_real thick = !wet ? 0 : g->mixture != NULL ? g->mixture->thick[c] : 1;
        s->thick[c] = (1 - s->elastic) * thick;
    }
}

static void find_weights(pl_viscous *s)
{
    const pl_liquid_grid *g = s->g;
    const pl_liquid_grains *grains = s->grains;
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const bool bears = grains != NULL && g->row[c] != 0;
        s->weight[c] = s->thick[c] + (bears ? s->elastic * grains->share[c] * grains->yield[c] : 0);
    }
}

// How much the slope from a face to the one before it counts; 0: one of them is air's.
static near_real slope_of(const near_real *is_free, const near_real *shut, uint32_t a, uint32_t b)
{
    const bool shut_a = shut[a] > 0, shut_b = shut[b] > 0;
    if ((is_free[a] == 0 && !shut_a) || (is_free[b] == 0 && !shut_b)) {
        return 0;
    }
    return shut_a != shut_b ? 2 : 1;
}

static void find_corners(pl_viscous *s)
{
    const pl_liquid_grid *g = s->g;
    const near_real *weight = s->weight;
    s->count = 0;
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const uint32_t left = g->left[c], down = g->down[c], both = g->left[down];
        const near_real sum = weight[c] + weight[left] + weight[down] + weight[both];
        const near_real u = slope_of(s->is_free.u, s->shut.u, c, down);
        const near_real v = slope_of(s->is_free.v, s->shut.v, c, left);
        const bool wet = (g->row[c] | g->row[left] | g->row[down] | g->row[both]) != 0;
        const bool counts = wet && u > 0 && v > 0;
        s->corner[c] = counts ? QUARTER * sum : 0;
        s->twice.u[c] = counts ? u : 0;
        s->twice.v[c] = counts ? v : 0;
        if (counts || weight[c] + s->is_free.u[c] + s->is_free.v[c] > 0) {
            s->cells[s->count++] = c;
        }
    }
}

static void find_diagonal(pl_viscous *s)
{
    const pl_liquid_grid *g = s->g;
    const near_real *w = s->weight, *corner = s->corner;
    const near_real *u = s->twice.u, *v = s->twice.v;
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t c = s->cells[i], up = g->up[c], right = g->right[c];
        const near_real corner_u = u[c] * u[c] * corner[c] + u[up] * u[up] * corner[up];
        const near_real corner_v = v[c] * v[c] * corner[c] + v[right] * v[right] * corner[right];
        s->diagonal.u[c] = s->mass.u[c] + s->k * (2 * (w[c] + w[g->left[c]]) + corner_u);
        s->diagonal.v[c] = s->mass.v[c] + s->k * (2 * (w[c] + w[g->down[c]]) + corner_v);
    }
}

static void lay_columns(pl_viscous *s, near_real *data)
{
    pl_viscous_faces *faces[] = { &s->speed, &s->is_free, &s->shut, &s->mass,    &s->twice,
                                  &s->left,  &s->way,     &s->out,  &s->diagonal };
    near_real **cells[] = { &s->thick, &s->weight, &s->corner, &s->xx, &s->yy, &s->xy };
    const size_t room = s->g->cell_count + 1;
    for (size_t i = 0; i < sizeof faces / sizeof faces[0]; ++i, data += 2 * room) {
        faces[i]->u = data;
        faces[i]->v = data + room;
    }
    for (size_t i = 0; i < sizeof cells / sizeof cells[0]; ++i, data += room) {
        *cells[i] = data;
    }
}

#define COLUMNS 24

bool pl_viscous_begin(pl_memory *memory, pl_liquid_scratch *scratch, double amount, pl_viscous *s)
{
    pl_liquid_grid *g = &scratch->grid;
    const size_t room = (g->cell_count + 1) * sizeof(near_real);
    const size_t columns = (COLUMNS * room + PL_ALIGN - 1) / PL_ALIGN * PL_ALIGN;
    if (!pl_buffer_reserve(memory, &scratch->viscous,
                           columns + (g->body_count + 1) * sizeof(pl_viscous_body)) ||
        !pl_buffer_reserve(memory, &scratch->keys, (g->cell_count + 1) * sizeof(uint32_t))) {
        return false;
    }
    const double stiff = g->grains != NULL ? PL_LIQUID_STIFF : 0;
    const double k = (amount < PL_LIQUID_THICK ? amount : PL_LIQUID_THICK) + stiff;
    *s = (pl_viscous){ .g = g,
                       .grains = g->grains,
                       .k = (near_real)k,
                       .elastic = (near_real)(stiff / k),
                       .cells = scratch->keys.data };
    memset(scratch->viscous.data, 0, columns);
    lay_columns(s, scratch->viscous.data);
    find_shut(s);
    find_faces(s);
    find_weights(s);
    find_corners(s);
    if (g->drag > 0) {
        s->bodies = (pl_viscous_body *)(void *)((char *)scratch->viscous.data + columns);
        pl_viscous_find_bodies(s);
    }
    return true;
}

//---- the matrix ----------------------------------------------------------------------------------

static void find_stresses(pl_viscous *s, const pl_viscous_faces *of)
{
    const pl_liquid_grid *g = s->g;
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t c = s->cells[i];
        const near_real w = 2 * s->weight[c];
        s->xx[c] = w * (of->u[g->right[c]] - of->u[c]);
        s->yy[c] = w * (of->v[g->up[c]] - of->v[c]);
        s->xy[c] = s->corner[c] * pl_viscous_slope(s, of, c);
    }
}

// out = m way - k (what its stresses do), of faces that are unknown.
static void multiply(pl_viscous *s)
{
    find_stresses(s, &s->way);
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t c = s->cells[i];
        s->out.u[c] =
            s->is_free.u[c] * (s->mass.u[c] * s->way.u[c] - s->k * pl_viscous_pull_u(s, c));
        s->out.v[c] =
            s->is_free.v[c] * (s->mass.v[c] * s->way.v[c] - s->k * pl_viscous_pull_v(s, c));
    }
}

// What is left at the velocities there are; the grid has those before.
static void find_left(pl_viscous *s)
{
    const pl_liquid_grid *g = s->g;
    find_stresses(s, &s->speed);
    if (s->grains != NULL) {
        pl_viscous_add_shear(s, true);
    }
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t c = s->cells[i];
        const near_real u = g->u[c] - s->speed.u[c], v = g->v[c] - s->speed.v[c];
        s->left.u[c] = s->is_free.u[c] * (s->mass.u[c] * u + s->k * pl_viscous_pull_u(s, c));
        s->left.v[c] = s->is_free.v[c] * (s->mass.v[c] * v + s->k * pl_viscous_pull_v(s, c));
    }
    pl_viscous_find_body_left(s);
}

//---- conjugate gradients -------------------------------------------------------------------------

// `over`: divided by the diagonal.
static double dot(const pl_viscous *s, const pl_viscous_faces *a, const pl_viscous_faces *b,
                  bool over)
{
    double total = 0;
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t c = s->cells[i];
        const double u = (double)a->u[c] * (double)b->u[c];
        const double v = (double)a->v[c] * (double)b->v[c];
        total += over ? u / (double)s->diagonal.u[c] + v / (double)s->diagonal.v[c] : u + v;
    }
    return total;
}

// to = keep to + factor from, over the diagonal if `over`.
static void add(const pl_viscous *s, const pl_viscous_faces *to, near_real keep,
                const pl_viscous_faces *from, near_real factor, bool over)
{
    for (uint32_t i = 0; i < s->count; ++i) {
        const uint32_t c = s->cells[i];
        const near_real u = over ? from->u[c] / s->diagonal.u[c] : from->u[c];
        const near_real v = over ? from->v[c] / s->diagonal.v[c] : from->v[c];
        to->u[c] = keep * to->u[c] + factor * u;
        to->v[c] = keep * to->v[c] + factor * v;
    }
}

static void solve(pl_viscous *s)
{
    find_diagonal(s);
    pl_viscous_find_body_diagonal(s);
    find_left(s);
    add(s, &s->way, 0, &s->left, 1, true);
    pl_viscous_turn_bodies(s, 0);
    double sigma = dot(s, &s->left, &s->left, true) + pl_viscous_dot_bodies(s, false);
    s->enough = s->enough > 0 ? s->enough : SOLVE_TO * SOLVE_TO * sigma;
    for (int n = 0; n < MOST_ITERATIONS && sigma > s->enough; ++n) {
        pl_viscous_carry(s, &s->way);
        multiply(s);
        pl_viscous_drag(s, true);
        const double bend = dot(s, &s->way, &s->out, false) + pl_viscous_dot_bodies(s, true);
        if (!(bend > 0)) {
            return;
        }
        const near_real alpha = (near_real)(sigma / bend);
        add(s, &s->speed, 1, &s->way, alpha, false);
        add(s, &s->left, 1, &s->out, -alpha, false);
        pl_viscous_go_bodies(s, (double)alpha);
        const double next = dot(s, &s->left, &s->left, true) + pl_viscous_dot_bodies(s, false);
        add(s, &s->way, (near_real)(next / sigma), &s->left, 1, true);
        pl_viscous_turn_bodies(s, next / sigma);
        sigma = next;
    }
}

bool pl_liquid_diffuse(pl_memory *memory, pl_liquid_scratch *scratch, double amount)
{
    pl_liquid_grid *g = &scratch->grid;
    pl_viscous s;
    if (g->grains != NULL) {
        pl_viscous_guess_yield(g);
    }
    if (!pl_viscous_begin(memory, scratch, amount, &s)) {
        return false;
    }
    solve(&s);
    for (int n = 1; s.grains != NULL && n < MOST_YIELDS && pl_viscous_find_yield(&s) > SETTLED;
         ++n) {
        find_weights(&s);
        find_corners(&s);
        solve(&s);
    }
    pl_viscous_keep_bodies(&s);
    for (uint32_t i = 0; i < s.count; ++i) {
        const uint32_t c = s.cells[i];
        g->u[c] = s.is_free.u[c] + s.shut.u[c] > 0 ? s.speed.u[c] : g->u[c];
        g->v[c] = s.is_free.v[c] + s.shut.v[c] > 0 ? s.speed.v[c] : g->v[c];
    }
    return true;
}
