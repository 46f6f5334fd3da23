// wet.c - which cells have liquid, and how far it is to the surface between them.
//
// Reads: points, openness, covers, densities, rows. Writes: wet. Cost: O(cells).
#include "liquid/liquid.h"

#define COVERED   ((near_real)0.3)
#define GAP       ((near_real)0.5) // all that is open of a cell
#define LEVEL     ((near_real)0.5)
#define LEAST_GAP ((near_real)0.25) // [cells] nearer surfaces would make the system stiff

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
    pl_liquid_faces_of(g, c, open);
    bool any = false, joined = false;
    for (int k = 0; k < 4; ++k) {
        any |= open[k] > 0;
        joined |= open[k] > 0 && has_points(g, near[k]);
    }
    return any && (has_points(g, c) || (joined && g->cover[c] > COVERED));
}

static void wet_cells(void *context, uint32_t first, uint32_t count)
{
    pl_liquid_grid *g = context;
    for (uint32_t c = 1 + first; c < 1 + first + count; ++c) {
        g->wet[c] = is_liquid(g, c);
    }
}

// A gap between two solids, without a wide side.
static bool is_gap(const pl_liquid_grid *g, uint32_t c)
{
    near_real open[4];
    pl_liquid_faces_of(g, c, open);
    return g->cover[c] > COVERED && open[0] + open[1] + open[2] + open[3] < GAP;
}

// Gaps are full of liquid as far as they lead: else what lies on the ground would be held down by an empty one.
static bool fill_gaps(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_liquid_grid *g = &scratch->grid;
    if (!pl_buffer_reserve(memory, &scratch->joined, g->cell_count * sizeof(uint32_t))) {
        return false;
    }
    uint32_t *list = scratch->joined.data, count = 0;
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        if (g->wet[c] && g->cover[c] > 0) {
            list[count++] = c;
        }
    }
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t c = list[i], near[4] = { g->left[c], g->right[c], g->down[c], g->up[c] };
        near_real open[4];
        pl_liquid_faces_of(g, c, open);
        for (int k = 0; k < 4; ++k) {
            if (open[k] > 0 && near[k] != 0 && !g->wet[near[k]] && is_gap(g, near[k])) {
                g->wet[near[k]] = 1;
                list[count++] = near[k];
            }
        }
    }
    return true;
}

bool pl_liquid_find_wet(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_liquid_cells(&scratch->grid, wet_cells);
    return scratch->grid.body_count == 0 || fill_gaps(memory, scratch);
}

// Where the density falls to one half on the way from a's centre to b's: exact for level surfaces at both centres and
// half way. Pressure is 0 there, not at the centre of the air's cell (ghost fluid; Enright et al. 2003).
near_real pl_liquid_gap(const pl_liquid_grid *g, uint32_t a, uint32_t b)
{
    const bool wet_a = g->row[a] != 0, wet_b = g->row[b] != 0;
    if (wet_a == wet_b) {
        return 1;
    }
    const uint32_t water = wet_a ? a : b, air = wet_a ? b : a;
    if (pl_liquid_space(g, water) < PL_LIQUID_LEAST_ROOM ||
        pl_liquid_space(g, air) < PL_LIQUID_LEAST_ROOM) {
        return 1;
    }
    const near_real in = pl_liquid_fullness(g, water), out = pl_liquid_fullness(g, air);
    const near_real gap = in > out ? (in - LEVEL) / (in - out) : 0;
    return gap > 1 ? 1 : gap > LEAST_GAP ? gap : LEAST_GAP;
}
