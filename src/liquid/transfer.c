// transfer.c - velocities from particles to faces: affine particle in cell (Jiang et al. 2015); the way back is back.h.
//
// A particle carries its velocity and how that changes around it, so angular momentum survives the way to the grid
// and back. Weights are bilinear. The sorted points of a cell are summed up once, for the faces and centres that they
// reach: a block. Faces gather from the blocks of six cells, densities from those of nine; nothing is scattered, so any
// thread may take any cell. Where there are several phases, weights are masses, so that momentum survives, and a blend
// beside the block has the areas (phases.c).
//
// Reads: points. Writes: faces, densities. Cost: O(cells + points).
#include "liquid/liquid.h"
#include "core/quad.h"

#include <string.h>

#define LEAST_WEIGHT ((near_real)1e-4)
#define HALF         ((near_real)0.5)
#define OWN_SHARE    ((near_real)0.75) // of a hat over cells: its own, those beside it
#define BESIDE_SHARE ((near_real)0.125)
#define FEWEST       256 // cells that are worth a thread

typedef pl_near_quad quad;

// What the points of a cell are to what is around it. The last of each four is not used.
struct pl_liquid_block {
    quad weight_u[2],
        value_u[2]; // faces at its left side, at its right: in the line below, its own, above
    quad weight_v[2],
        value_v[2]; // faces below it, above: in the column at its left, its own, at its right
    quad full[3];   // centres in the line below, its own, above: from left to right
};

// What phases add to a block.
struct pl_liquid_blend {
    quad area_u[2], area_v[2]; // as its weights, which are masses
    quad mass[3], thick[3];    // as `full`, times what the phase is to the first
};

//---- sums of a cell ------------------------------------------------------------------------------

static near_real positive(near_real x)
{
    return x > 0 ? x : 0;
}

static near_real peak(near_real x)
{
    return 1 - (x < HALF ? HALF - x : x - HALF);
}

// Hats of the places -1/2, 1/2, 3/2 at x.
#define HATS(x) ((quad){ positive(HALF - (x)), peak(x), positive((x)-HALF), 0 })
#define PLACES  ((quad){ -HALF, HALF, 1 + HALF, 0 })

// blend: null, or where what phases add to it goes.
static inline void sum_points(const pl_liquid_grid *g, uint32_t c, pl_liquid_block *out,
                              pl_liquid_blend *blend)
{
    pl_liquid_block sum = { 0 };
    pl_liquid_blend more = { 0 };
    for (uint32_t k = g->first[c]; k < g->first[c + 1]; ++k) {
        const pl_liquid_point *p = &g->points[k];
        const quad x = HATS(p->fx), y = HATS(p->fy);
        const quad u = p->u + p->slope[1] * (PLACES - p->fy),
                   v = p->v + p->slope[2] * (PLACES - p->fx);
        quad left = y * (1 - p->fx), right = y * p->fx;
        quad low = x * (1 - p->fy), high = x * p->fy;
        if (blend != NULL) {
            const pl_liquid_kind *kind = &g->mixture->kinds[g->mixture->phases[k]];
            const quad areas[] = { left, right, low, high };
            for (int i = 0; i < 2; ++i) {
                more.area_u[i] += areas[i];
                more.area_v[i] += areas[2 + i];
            }
            for (int i = 0; i < 3; ++i) {
                more.mass[i] += kind->mass * y[i] * x;
                more.thick[i] += kind->thick * y[i] * x;
            }
            left *= kind->mass, right *= kind->mass, low *= kind->mass, high *= kind->mass;
        }
        sum.weight_u[0] += left;
        sum.weight_u[1] += right;
        sum.value_u[0] += left * (u - p->slope[0] * p->fx);
        sum.value_u[1] += right * (u + p->slope[0] * (1 - p->fx));
        sum.weight_v[0] += low;
        sum.weight_v[1] += high;
        sum.value_v[0] += low * (v - p->slope[3] * p->fy);
        sum.value_v[1] += high * (v + p->slope[3] * (1 - p->fy));
        sum.full[0] += x * y[0];
        sum.full[1] += x * y[1];
        sum.full[2] += x * y[2];
    }
    *out = sum;
    if (blend != NULL) {
        *blend = more;
    }
}

static void sum_range(void *context, uint32_t first, uint32_t count)
{
    const pl_liquid_grid *g = context;
    for (uint32_t i = first; i < first + count; ++i) {
        sum_points(g, g->occupied[i], &g->blocks[1 + i], NULL);
    }
}

static void blend_range(void *context, uint32_t first, uint32_t count)
{
    const pl_liquid_grid *g = context;
    for (uint32_t i = first; i < first + count; ++i) {
        sum_points(g, g->occupied[i], &g->blocks[1 + i], &g->mixture->blends[1 + i]);
    }
}

static bool make_blends(pl_memory *memory, pl_liquid_scratch *scratch, uint32_t count)
{
    if (!pl_buffer_reserve(memory, &scratch->blends, (count + 1) * sizeof(pl_liquid_blend))) {
        return false;
    }
    scratch->mixture.blends = scratch->blends.data;
    scratch->mixture.blends[0] = (pl_liquid_blend){ 0 };
    return true;
}

bool pl_liquid_sum_cells(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_liquid_grid *g = &scratch->grid;
    uint32_t count = 0;
    if (!pl_buffer_reserve(memory, &scratch->occupied, (g->point_count + 1) * sizeof(uint32_t))) {
        return false;
    }
    g->occupied = scratch->occupied.data;
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const bool any = g->first[c + 1] > g->first[c];
        g->occupied[count] = c;
        count += any;
        g->block[c] = any ? count : 0;
    }
    if (!pl_buffer_reserve(memory, &scratch->blocks, (count + 1) * sizeof(pl_liquid_block)) ||
        (g->mixture != NULL && !make_blends(memory, scratch, count))) {
        return false;
    }
    g->blocks = scratch->blocks.data;
    g->blocks[0] = (pl_liquid_block){ 0 };
    pl_tasks_ranges(g->tasks, count, FEWEST, g->mixture != NULL ? blend_range : sum_range, g);
    return true;
}

//---- to the grid ---------------------------------------------------------------------------------

static near_real solid_hat(const pl_liquid_grid *g, uint32_t c)
{
    const uint32_t l = g->left[c], r = g->right[c], d = g->down[c], u = g->up[c];
    const near_real *s = g->cover;
    const near_real sides = s[l] + s[r] + s[d] + s[u];
    const near_real corners = s[g->left[d]] + s[g->right[d]] + s[g->left[u]] + s[g->right[u]];
    return OWN_SHARE * OWN_SHARE * s[c] + OWN_SHARE * BESIDE_SHARE * sides +
           BESIDE_SHARE * BESIDE_SHARE * corners;
}

// Sums over b: blocks of the cells around one and of itself, line by line from below.
#define AT_U(of)                                                                                   \
    (b[0]->of[1][2] + b[1]->of[0][2] + b[3]->of[1][1] + b[4]->of[0][1] + b[6]->of[1][0] +          \
     b[7]->of[0][0])
#define AT_V(of)                                                                                   \
    (b[0]->of[1][2] + b[1]->of[1][1] + b[2]->of[1][0] + b[3]->of[0][2] + b[4]->of[0][1] +          \
     b[5]->of[0][0])
#define AT_CENTRE(of)                                                                              \
    (b[0]->of[2][2] + b[1]->of[2][1] + b[2]->of[2][0] + b[3]->of[1][2] + b[4]->of[1][1] +          \
     b[5]->of[1][0] + b[6]->of[0][2] + b[7]->of[0][1] + b[8]->of[0][0])

// The sums of a cell's centre, its left face and its lower face.
typedef struct sums {
    near_real u, v, area_u, area_v, full;
} sums;

static sums gather_cell(pl_liquid_grid *g, uint32_t c, const pl_liquid_block *const b[9])
{
    const near_real u = AT_U(weight_u), v = AT_V(weight_v), full = AT_CENTRE(full);
    g->u[c] = AT_U(value_u);
    g->v[c] = AT_V(value_v);
    g->density[c] = full / PL_LIQUID_FULL + g->solid[c];
    return (sums){ u, v, u, v, full };
}

static void blend_cell(const pl_liquid_mixture *m, uint32_t c, const pl_liquid_blend *const b[9],
                       sums *sum)
{
    const bool any = sum->full > LEAST_WEIGHT;
    sum->area_u = AT_U(area_u);
    sum->area_v = AT_V(area_v);
    m->light_u[c] = sum->area_u > LEAST_WEIGHT ? sum->area_u / sum->u : 0;
    m->light_v[c] = sum->area_v > LEAST_WEIGHT ? sum->area_v / sum->v : 0;
    m->mass[c] = any ? AT_CENTRE(mass) / sum->full : 0;
    m->thick[c] = any ? AT_CENTRE(thick) / sum->full : 0;
}

static void empty_cell(pl_liquid_grid *g, uint32_t c)
{
    const pl_liquid_mixture *m = g->mixture;
    g->known_u[c] = g->known_v[c] = 0;
    g->u[c] = g->v[c] = 0;
    g->density[c] = g->solid[c];
    if (m != NULL) {
        m->light_u[c] = m->light_v[c] = m->mass[c] = m->thick[c] = 0;
    }
}

static void gather_range(void *context, uint32_t first, uint32_t count)
{
    pl_liquid_grid *g = context;
    for (uint32_t c = 1 + first; c < 1 + first + count; ++c) {
        const uint32_t d = g->down[c], u = g->up[c];
        const uint32_t near[9] = { g->left[d],  d,          g->right[d], g->left[c], c,
                                   g->right[c], g->left[u], u,           g->right[u] };
        const pl_liquid_block *b[9];
        const pl_liquid_blend *blends[9];
        uint32_t any = 0;
        for (int i = 0; i < 9; ++i) {
            any |= g->block[near[i]];
            b[i] = &g->blocks[g->block[near[i]]];
        }
        g->solid[c] = solid_hat(g, c);
        if (any == 0) {
            empty_cell(g, c);
            continue;
        }
        sums sum = gather_cell(g, c, b);
        if (g->mixture != NULL) {
            for (int i = 0; i < 9; ++i) {
                blends[i] = &g->mixture->blends[g->block[near[i]]];
            }
            blend_cell(g->mixture, c, blends, &sum);
        }
        g->known_u[c] = sum.area_u > LEAST_WEIGHT;
        g->known_v[c] = sum.area_v > LEAST_WEIGHT;
        g->u[c] = g->known_u[c] ? g->u[c] / sum.u : 0;
        g->v[c] = g->known_v[c] ? g->v[c] / sum.v : 0;
    }
}

void pl_liquid_to_grid(pl_liquid_grid *g)
{
    pl_liquid_cells(g, gather_range);
    if (g->mixture != NULL) {
        pl_liquid_lighten(g);
    }
}

//---- where nothing is known ----------------------------------------------------------------------

// The mean of the known faces beside it, of which there are some. What becomes known in this sweep is fresh: order decides nothing.
static void spread(const pl_liquid_grid *g, near_real *value, const uint8_t *known, uint32_t c)
{
    const uint32_t near[4] = { g->left[c], g->right[c], g->down[c], g->up[c] };
    near_real total = 0;
    int count = 0;
    for (int k = 0; k < 4; ++k) {
        if (known[near[k]] != 0) {
            total += value[near[k]];
            ++count;
        }
    }
    value[c] = total / (near_real)count;
}

// A line of them at once.
typedef uint8_t marks __attribute__((vector_size(PL_LIQUID_SIDE)));

static inline bool any_of(const marks *m)
{
    uint64_t halves[2];
    memcpy(halves, m, sizeof halves);
    return (halves[0] | halves[1]) != 0;
}

// Which of a line are not known, and beside one that is. False: none.
static inline bool find_fresh(const pl_liquid_grid *g, const uint8_t *known, uint8_t *fresh,
                              uint32_t c)
{
    const uint32_t down = g->down[c], up = g->up[c];
    marks here, before, behind, low = { 0 }, high = { 0 };
    memcpy(&here, known + c, sizeof here);
    memcpy(&before, known + c - 1, sizeof here);
    memcpy(&behind, known + c + 1, sizeof here);
    before[0] = known[g->left[c]];
    behind[PL_LIQUID_SIDE - 1] = known[g->right[c + PL_LIQUID_SIDE - 1]];
    if (down != 0) {
        memcpy(&low, known + down, sizeof low);
    }
    if (up != 0) {
        memcpy(&high, known + up, sizeof high);
    }
    const marks all = (before | behind | low | high) & (here ^ 1);
    memcpy(fresh + c, &all, sizeof all);
    return any_of(&all);
}

static void spread_line(const pl_liquid_grid *g, near_real *value, const uint8_t *known,
                        uint8_t *fresh, uint32_t c)
{
    if (find_fresh(g, known, fresh, c)) {
        for (uint32_t i = c; i < c + PL_LIQUID_SIDE; ++i) {
            if (fresh[i] != 0) {
                spread(g, value, known, i);
            }
        }
    }
}

typedef struct field {
    pl_liquid_grid *g;
    near_real *u, *v;
} field;

static void spread_range(void *context, uint32_t first, uint32_t count)
{
    const field *f = context;
    for (uint32_t k = first; k < first + count; ++k) {
        const uint32_t c = 1 + k * PL_LIQUID_SIDE;
        spread_line(f->g, f->u, f->g->known_u, f->g->fresh_u, c);
        spread_line(f->g, f->v, f->g->known_v, f->g->fresh_v, c);
    }
}

static void take_range(void *context, uint32_t first, uint32_t count)
{
    pl_liquid_grid *g = ((field *)context)->g;
    uint8_t *restrict u = g->known_u, *restrict v = g->known_v;
    const uint8_t *restrict fresh_u = g->fresh_u, *restrict fresh_v = g->fresh_v;
    const uint32_t from = 1 + first * PL_LIQUID_SIDE, end = from + count * PL_LIQUID_SIDE;
    for (uint32_t c = from; c < end; ++c) {
        u[c] |= fresh_u[c];
        v[c] |= fresh_v[c];
    }
}

void pl_liquid_extrapolate(pl_liquid_grid *g, near_real *u, near_real *v, int cells)
{
    field f = { g, u, v };
    const uint32_t lines = g->tile_count * PL_LIQUID_SIDE;
    for (int sweep = 0; sweep < cells; ++sweep) {
        pl_tasks_ranges(g->tasks, lines, 128, spread_range, &f);
        pl_tasks_ranges(g->tasks, lines, 1024, take_range, &f);
    }
}

typedef struct kick {
    pl_liquid_grid *g;
    near_real u, v;
} kick;

static void kick_range(void *context, uint32_t first, uint32_t count)
{
    const kick *k = context;
    near_real *restrict u = k->g->u, *restrict v = k->g->v;
    const near_real du = k->u, dv = k->v;
    for (uint32_t c = 1 + first; c < 1 + first + count; ++c) {
        u[c] += du;
        v[c] += dv;
    }
}

void pl_liquid_accelerate(pl_liquid_grid *g, near_real du, near_real dv)
{
    kick k = { g, du, dv };
    pl_tasks_ranges(g->tasks, g->cell_count - 1, 16384, kick_range, &k);
}
