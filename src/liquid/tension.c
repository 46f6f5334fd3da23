// tension.c - surface tension: the pressure at the surface is tension times curvature, where it is 0 without.
//
// The surface is a polygon, the line on which the smoothed density is one half (marching squares). What one more bit of liquid in a
// cell does to the length L and to the area A of that polygon is known exactly, and its curvature there is dL / dA: the
// work against tension over the volume that comes, so what pressures do is what the length holds. Both slopes
// are averaged by the same sweeps of (1 2 1) / 4 along both axes, so that a cell sees some six cells of the line; what sweeps take
// from a wave is given back by what they take when they run once more. Means of angles between normals, or of the
// divergence of normals, are as right and far noisier: drops stirred themselves (DECISIONS.md).
//
// Liquid is weighed by the room for it that solids leave, and so averaged: the line meets walls at right angles. It ends at the
// last centres before them: what goes on in solids is flat there, and made waves between walls a sixth too slow.
//
// With kappa [1/cells] and P as in pressure.c a face between liquid and air gets u +- light tension dt kappa / (density h^2 gap),
// kappa where the surface crosses. What sticks out where the smoothed density is below a quarter has no line round it: there
// kappa grows outwards, or single particles would leave. Explicit: dt must be below half of
// sqrt(density h^3 / (2 pi tension)) (Brackbill, Kothe, Zemach 1992).
//
// Reads: densities, rows. Writes: velocities of faces. Cost: O(cells).
#include "liquid/liquid.h"

#include <math.h>

#define LEVEL      ((near_real)0.5)
#define OFF_LEVEL  ((near_real)1e-3) // at least: a line through a centre has no slope there
#define LEAST_ROOM ((near_real)0.45) // that is not solid
#define LEAST_AREA ((near_real)1e-5) // of the line that a cell sees
#define SMOOTHED   2                 // sweeps of the density
#define SWEEPS     4                 // of the slopes
#define GIVEN_BACK ((near_real)1.5)
#define SHARPEST   ((near_real)1) // [1/cells]
#define OUTSIDE    ((near_real)0.25)
#define COHESION   ((near_real)1) // [1/cells] of where nothing is full
#define UNKNOWN    ((near_real)9) // curvature far from the line; fullness of what is solid

// Two numbers that are swept alike: liquid and room for it, slopes of length and area.
typedef struct pair {
    near_real a, b;
} pair;

typedef struct tension {
    pl_liquid_grid *g;
    pair *from, *to;               // of a sweep
    near_real *full, *turn, *area; // of cells: smoothed density, curvature, slope of the area
    near_real pull;                // [m/s] of a curvature of one a cell
} tension;

static near_real sum_of_three(near_real low, near_real middle, near_real high)
{
    return (near_real)0.25 * (low + high) + (near_real)0.5 * middle;
}

static pair mean_along(const pl_liquid_grid *g, const pair *p, uint32_t c)
{
    const pair l = p[g->left[c]], m = p[c], r = p[g->right[c]];
    return (pair){ sum_of_three(l.a, m.a, r.a), sum_of_three(l.b, m.b, r.b) };
}

static void sweep_range(void *context, uint32_t first, uint32_t count)
{
    const tension *t = context;
    const pl_liquid_grid *g = t->g;
    for (uint32_t c = 1 + first; c < 1 + first + count; ++c) {
        const pair d = mean_along(g, t->from, g->down[c]), m = mean_along(g, t->from, c);
        const pair u = mean_along(g, t->from, g->up[c]);
        t->to[c] = (pair){ sum_of_three(d.a, m.a, u.a), sum_of_three(d.b, m.b, u.b) };
    }
}

// What is swept, and was, is in `from`.
static void sweep(tension *t, int count)
{
    for (int i = 0; i < count; ++i) {
        pl_tasks_ranges(t->g->tasks, t->g->cell_count - 1, 2048, sweep_range, t);
        pair *swept = t->to;
        t->to = t->from;
        t->from = swept;
    }
}

//---- the line ------------------------------------------------------------------------------------

static void weigh_range(void *context, uint32_t first, uint32_t count)
{
    const tension *t = context;
    const pl_liquid_grid *g = t->g;
    for (uint32_t c = 1 + first; c < 1 + first + count; ++c) {
        t->from[c] = (pair){ g->density[c] - g->solid[c], 1 - g->solid[c] };
    }
}

static void fill_range(void *context, uint32_t first, uint32_t count)
{
    const tension *t = context;
    for (uint32_t c = 1 + first; c < 1 + first + count; ++c) {
        const pair p = t->from[c];
        t->full[c] = p.b > LEAST_ROOM ? p.a / p.b : UNKNOWN;
    }
}

// Four centres of cells, from the lower left one counterclockwise.
static const near_real CORNER_X[4] = { 0, 1, 1, 0 }, CORNER_Y[4] = { 0, 0, 1, 1 };

// Where the line crosses the side from one corner to the next, and how far along it goes as these fill.
typedef struct crossing {
    int from, to;
    near_real x, y, along_x, along_y, slope_from, slope_to;
} crossing;

static near_real off_level(near_real full)
{
    const near_real off = full - LEVEL;
    return off > OFF_LEVEL || off < -OFF_LEVEL ? off : off > 0 ? OFF_LEVEL : -OFF_LEVEL;
}

static crossing cross(const near_real off[4], int from)
{
    const int to = (from + 1) & 3;
    const near_real a = off[from], b = off[to], s = a / (a - b), square = (a - b) * (a - b);
    const near_real x = CORNER_X[to] - CORNER_X[from], y = CORNER_Y[to] - CORNER_Y[from];
    return (crossing){ .from = from,
                       .to = to,
                       .x = CORNER_X[from] + s * x,
                       .y = CORNER_Y[from] + s * y,
                       .along_x = x,
                       .along_y = y,
                       .slope_from = -b / square,
                       .slope_to = a / square };
}

// What a corner does to length and area of a piece of the line. `out`: 1, the liquid is at its left from p to q; -1.
static void add_piece(const crossing *p, const crossing *q, near_real out, int corner, pair *sum)
{
    const near_real x = q->x - p->x, y = q->y - p->y;
    const near_real length = (near_real)sqrt((double)(x * x + y * y));
    const crossing *ends[2] = { p, q };
    for (int k = 0; k < 2 && length > 0; ++k) {
        const crossing *e = ends[k];
        const near_real slope = e->from == corner ? e->slope_from
                                : e->to == corner ? e->slope_to
                                                  : 0;
        const near_real along = (x * e->along_x + y * e->along_y) / length;
        sum->a += slope * (k == 0 ? -along : along);
        sum->b += slope * out / 2 * (y * e->along_x - x * e->along_y);
    }
}

// The pieces of the line between four centres, of which one is the corner.
static void add_square(const tension *t, const uint32_t cells[4], int corner, pair *sum)
{
    near_real off[4], total = 0;
    crossing all[4];
    int count = 0;
    for (int k = 0; k < 4; ++k) {
        if (cells[k] == 0 || t->full[cells[k]] == UNKNOWN) {
            return;
        }
        off[k] = off_level(t->full[cells[k]]);
        total += off[k];
    }
    for (int k = 0; k < 4; ++k) {
        if ((off[k] > 0) != (off[(k + 1) & 3] > 0)) {
            all[count++] = cross(off, k);
        }
    }
    // Of four crossings those are joined that leave the middle on the side that its mean is on.
    const int skip = count == 4 && (off[0] > 0) == (total > 0) ? 0 : count == 4 ? 1 : 0;
    for (int k = 0; k < count; k += 2) {
        const crossing *p = &all[(k + skip) % count], *q = &all[(k + skip + 1) % count];
        add_piece(p, q, off[p->from] > 0 ? 1 : -1, corner, sum);
    }
}

static void slope_range(void *context, uint32_t first, uint32_t count)
{
    const tension *t = context;
    const pl_liquid_grid *g = t->g;
    for (uint32_t c = 1 + first; c < 1 + first + count; ++c) {
        const uint32_t l = g->left[c], r = g->right[c], d = g->down[c], u = g->up[c];
        const bool in = t->full[c] > LEVEL;
        pair sum = { 0, 0 };
        if (t->full[c] != UNKNOWN && ((t->full[l] > LEVEL) != in || (t->full[r] > LEVEL) != in ||
                                      (t->full[d] > LEVEL) != in || (t->full[u] > LEVEL) != in)) {
            add_square(t, (uint32_t[4]){ c, r, g->up[r], u }, 0, &sum);
            add_square(t, (uint32_t[4]){ l, c, u, g->up[l] }, 1, &sum);
            add_square(t, (uint32_t[4]){ g->left[d], d, c, l }, 2, &sum);
            add_square(t, (uint32_t[4]){ d, g->right[d], r, c }, 3, &sum);
        }
        t->from[c] = sum;
        t->area[c] = sum.b;
    }
}

//---- curvature -----------------------------------------------------------------------------------

static void turn_range(void *context, uint32_t first, uint32_t count)
{
    const tension *t = context;
    for (uint32_t c = 1 + first; c < 1 + first + count; ++c) {
        const pair p = t->from[c];
        t->turn[c] = p.b > LEAST_AREA ? p.a / p.b : UNKNOWN;
    }
}

static void again_range(void *context, uint32_t first, uint32_t count)
{
    const tension *t = context;
    for (uint32_t c = 1 + first; c < 1 + first + count; ++c) {
        const near_real area = t->area[c];
        t->from[c] = (pair){ area > 0 && t->turn[c] != UNKNOWN ? area * t->turn[c] : 0, area };
    }
}

static void give_back_range(void *context, uint32_t first, uint32_t count)
{
    const tension *t = context;
    for (uint32_t c = 1 + first; c < 1 + first + count; ++c) {
        const pair p = t->from[c];
        near_real turn = t->turn[c];
        if (turn != UNKNOWN && p.b > LEAST_AREA) {
            turn += GIVEN_BACK * (turn - p.a / p.b);
            t->turn[c] = turn > SHARPEST ? SHARPEST : turn < -SHARPEST ? -SHARPEST : turn;
        }
    }
}

//---- faces ---------------------------------------------------------------------------------------

// What holds together what sticks out so far that the line passes it by.
static near_real cohesion(near_real full)
{
    return full < OUTSIDE ? COHESION * (OUTSIDE - full) : 0;
}

static near_real between(near_real in, near_real out, near_real gap)
{
    return out == UNKNOWN ? in : in + gap * (out - in);
}

// [m/s] P at the surface between two cells, if one has liquid and the other has not.
static near_real pressure_between(const tension *t, uint32_t a, uint32_t b, near_real *gap)
{
    const pl_liquid_grid *g = t->g;
    const bool wet_a = g->row[a] != 0;
    const uint32_t in = wet_a ? a : b, out = wet_a ? b : a;
    if (wet_a == (g->row[b] != 0)) {
        return 0;
    }
    *gap = pl_liquid_gap(g, a, b);
    const near_real turn = t->turn[in] == UNKNOWN ? 0 : between(t->turn[in], t->turn[out], *gap);
    const near_real full = between(t->full[in], t->full[out], *gap);
    return (wet_a ? -t->pull : t->pull) * (turn + cohesion(full));
}

static void pull_range(void *context, uint32_t first, uint32_t count)
{
    const tension *t = context;
    pl_liquid_grid *g = t->g;
    for (uint32_t c = 1 + first; c < 1 + first + count; ++c) {
        near_real gap = 1;
        if (g->open_u[c] > 0) {
            const near_real p = pressure_between(t, g->left[c], c, &gap);
            g->u[c] += pl_liquid_light_u(g, c) * p / gap;
        }
        gap = 1;
        if (g->open_v[c] > 0) {
            const near_real p = pressure_between(t, g->down[c], c, &gap);
            g->v[c] += pl_liquid_light_v(g, c) * p / gap;
        }
    }
}

static void carve(tension *t, void *memory, size_t cells)
{
    t->from = memory;
    t->to = t->from + cells;
    t->full = (near_real *)(t->to + cells);
    t->turn = t->full + cells;
    t->area = t->turn + cells;
    t->from[0] = t->to[0] = (pair){ 0, 0 };
    t->full[0] = t->area[0] = 0;
    t->turn[0] = UNKNOWN;
}

bool pl_liquid_tighten(pl_memory *memory, pl_liquid_scratch *scratch, double pull)
{
    pl_liquid_grid *g = &scratch->grid;
    const size_t cells = (size_t)g->cell_count + 1;
    if (!pl_buffer_reserve(memory, &scratch->tension,
                           cells * (2 * sizeof(pair) + 3 * sizeof(near_real)))) {
        return false;
    }
    tension t = { .g = g, .pull = (near_real)pl_liquid_held(pull, PL_LIQUID_SPEED) };
    carve(&t, scratch->tension.data, cells);
#define RUN(range) pl_tasks_ranges(g->tasks, g->cell_count - 1, 2048, range, &t)
    RUN(weigh_range);
    sweep(&t, SMOOTHED);
    RUN(fill_range);
    RUN(slope_range);
    sweep(&t, SWEEPS);
    RUN(turn_range);
    RUN(again_range);
    sweep(&t, SWEEPS);
    RUN(give_back_range);
    RUN(pull_range);
#undef RUN
    return true;
}

static void forget_range(void *context, uint32_t first, uint32_t count)
{
    pl_liquid_grid *g = context;
    for (uint32_t c = 1 + first; c < 1 + first + count; ++c) {
        if (g->row[c] == 0) {
            g->known_u[c] = g->row[g->left[c]] != 0 ? g->known_u[c] : 0;
            g->known_v[c] = g->row[g->down[c]] != 0 ? g->known_v[c] : 0;
        }
    }
}

void pl_liquid_forget_far(pl_liquid_grid *g)
{
    pl_liquid_cells(g, forget_range);
}
