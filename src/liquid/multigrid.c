// multigrid.c - the pressures' matrix in lines of 16 cells, on grids that are twice as coarse each: a cycle over them
// stands for the inverse of the matrix.
//
// A strip is a line of a tile that has liquid. Strips are sorted by place, so the one at the left of a strip, if there is
// any, is the one before it in memory: kernels run along lines without an index, in as many lanes as there are. A coarser
// grid has the sums of the faces of the finer one, halved, as its cells are twice as far apart (Braess 1995). A cycle
// is one damped Jacobi sweep down, one up: symmetric, so conjugate gradients may take it for the inverse (Tatebe 1993).
//
// Reads: vectors D, L, B of the finest grid. Writes: strips, vectors of all grids. Cost: O(cells with liquid).
#include "liquid/liquid.h"

#define DAMPING ((near_real)0.8)
#define SWEEPS  5  // on the coarsest grid; odd
#define FEW     2  // strips that are not worth another grid
#define LEAST   64 // strips that are worth a thread
#define HALF    ((near_real)0.5)
#define LINE    PL_LIQUID_SIDE

//---- grids ---------------------------------------------------------------------------------------

static pl_liquid_strip *push_strip(pl_memory *memory, pl_liquid_scratch *scratch, int32_t x,
                                   int32_t y)
{
    pl_liquid_grid *g = &scratch->grid;
    const size_t bytes = (g->strip_count + 1) * sizeof(pl_liquid_strip);
    if (!pl_buffer_reserve(memory, &scratch->strips, bytes)) {
        return NULL;
    }
    g->strips = scratch->strips.data;
    pl_liquid_strip *s = &g->strips[g->strip_count++];
    *s = (pl_liquid_strip){ .x = x, .y = y };
    return s;
}

bool pl_liquid_first_strip(pl_memory *memory, pl_liquid_scratch *scratch)
{
    scratch->grid.strip_count = 0;
    return push_strip(memory, scratch, 0, 0) != NULL;
}

bool pl_liquid_add_strip(pl_memory *memory, pl_liquid_scratch *scratch, int32_t x, int32_t y,
                         uint32_t cell)
{
    pl_liquid_strip *s = push_strip(memory, scratch, x, y);
    if (s != NULL) {
        s->cell = cell;
    }
    return s != NULL;
}

// Strips above one another. They are sorted, so what is looked for only ever goes up.
static void link_strips(pl_liquid_grid *g, uint32_t first, uint32_t end)
{
    uint32_t k = first;
    for (uint32_t i = first; i < end; ++i) {
        pl_liquid_strip *s = &g->strips[i], *above = &g->strips[k];
        while (k < end && (above->y <= s->y || (above->y == s->y + 1 && above->x < s->x))) {
            above = &g->strips[++k];
        }
        if (k < end && above->y == s->y + 1 && above->x == s->x) {
            s->up = k;
            above->down = i;
        }
    }
}

static uint32_t end_of_line(const pl_liquid_grid *g, uint32_t at, uint32_t end, int32_t y)
{
    while (at < end && g->strips[at].y == y) {
        ++at;
    }
    return at;
}

// Of two lines of strips one of coarse strips.
static bool halve_lines(pl_memory *memory, pl_liquid_scratch *scratch, uint32_t low,
                        uint32_t low_end, uint32_t high, uint32_t high_end, int32_t y)
{
    while (low < low_end || high < high_end) {
        const pl_liquid_strip *s = scratch->grid.strips;
        int32_t x = INT32_MAX;
        x = low < low_end ? s[low].x >> 1 : x;
        x = high < high_end && s[high].x >> 1 < x ? s[high].x >> 1 : x;
        pl_liquid_strip *coarse = push_strip(memory, scratch, x, y);
        if (coarse == NULL) {
            return false;
        }
        s = scratch->grid.strips;
        for (; low < low_end && s[low].x >> 1 == x; ++low) {
            coarse->finer[s[low].x & 1] = low;
        }
        for (; high < high_end && s[high].x >> 1 == x; ++high) {
            coarse->finer[2 + (s[high].x & 1)] = high;
        }
    }
    return true;
}

static bool coarsen(pl_memory *memory, pl_liquid_scratch *scratch, uint32_t first, uint32_t end)
{
    for (uint32_t at = first; at < end;) {
        const pl_liquid_grid *g = &scratch->grid;
        const int32_t y = g->strips[at].y >> 1;
        const uint32_t high = end_of_line(g, at, end, 2 * y);
        const uint32_t after = end_of_line(g, high, end, 2 * y + 1);
        if (!halve_lines(memory, scratch, at, high, high, after, y)) {
            return false;
        }
        at = after;
    }
    return true;
}

bool pl_liquid_make_grids(pl_memory *memory, pl_liquid_scratch *scratch)
{
    pl_liquid_grid *g = &scratch->grid;
    uint32_t first = 1, end = g->strip_count;
    g->level_count = 0;
    for (;;) {
        link_strips(g, first, end);
        g->levels[g->level_count++] = (pl_liquid_level){ first, end };
        if (g->level_count == PL_LIQUID_LEVELS || end - first <= FEW) {
            return true;
        }
        // Kernels look beside a line. Between grids stands a strip that nobody writes: one thread may write a grid while
        // another reads beside the end of the finer one.
        const uint32_t next = end + 1;
        if (push_strip(memory, scratch, 0, 0) == NULL || !coarsen(memory, scratch, first, end)) {
            return false;
        }
        if (4 * (g->strip_count - next) > 3 * (end - first)) { // strips far from one another
            g->strip_count = end;
            return true;
        }
        first = next;
        end = g->strip_count;
    }
}

//---- their matrices ------------------------------------------------------------------------------

// Of a coarse strip's half the sums over a pair of finer strips, `low` and `high`; 0: there is none.
static void fold(const pl_liquid_grid *g, const pl_liquid_strip *s, uint32_t to, int half)
{
    const near_real *d = g->vectors[PL_LIQUID_D], *l = g->vectors[PL_LIQUID_L];
    const near_real *b = g->vectors[PL_LIQUID_B];
    const size_t low = (size_t)s->finer[half] * LINE, high = (size_t)s->finer[2 + half] * LINE;
    for (uint32_t i = 0; i < LINE / 2; ++i) {
        const uint32_t k = 2 * i, out = to + (uint32_t)half * LINE / 2 + i;
        const near_real all = d[low + k] + d[low + k + 1] + d[high + k] + d[high + k + 1];
        const near_real within = l[low + k + 1] + l[high + k + 1] + b[high + k] + b[high + k + 1];
        g->vectors[PL_LIQUID_D][out] = HALF * (all - 2 * within);
        g->vectors[PL_LIQUID_L][out] = HALF * (l[low + k] + l[high + k]);
        g->vectors[PL_LIQUID_B][out] = HALF * (b[low + k] + b[low + k + 1]);
    }
}

static void invert(const pl_liquid_grid *g, size_t first, size_t end)
{
    const near_real *d = g->vectors[PL_LIQUID_D];
    near_real *inverse = g->vectors[PL_LIQUID_I];
    for (size_t i = first; i < end; ++i) {
        inverse[i] = d[i] > (near_real)1e-6 ? DAMPING / d[i] : 0;
    }
}

void pl_liquid_fold_grids(pl_liquid_grid *g)
{
    for (uint32_t level = 0; level < g->level_count; ++level) {
        const pl_liquid_level *at = &g->levels[level];
        for (uint32_t i = at->first; i < at->end && level > 0; ++i) {
            fold(g, &g->strips[i], i * LINE, 0);
            fold(g, &g->strips[i], i * LINE, 1);
        }
        invert(g, (size_t)at->first * LINE, (size_t)at->end * LINE);
    }
}

//---- the cycle -----------------------------------------------------------------------------------

typedef struct walk {
    pl_liquid_grid *g;
    uint32_t first; // strip
} walk;

static void go_down(void *context, uint32_t first, uint32_t count)
{
    const walk *w = context;
    w->g->kernels->go_down(w->g, w->first + first, w->first + first + count);
}

static void come_up(void *context, uint32_t first, uint32_t count)
{
    const walk *w = context;
    w->g->kernels->come_up(w->g, w->first + first, w->first + first + count);
}

static void sweep(void *context, uint32_t first, uint32_t count)
{
    const walk *w = context;
    w->g->kernels->sweep(w->g, w->first + first, w->first + first + count,
                         w->g->vectors[PL_LIQUID_Z], w->g->vectors[PL_LIQUID_Q]);
}

static void run_level(pl_liquid_grid *g, uint32_t level, pl_range_fn *range)
{
    const pl_liquid_level *at = &g->levels[level];
    walk w = { g, at->first };
    pl_tasks_ranges(g->tasks, at->end - at->first, LEAST, range, &w);
}

static void solve_coarsest(pl_liquid_grid *g)
{
    const pl_liquid_level *at = &g->levels[g->level_count - 1];
    near_real *from = g->vectors[PL_LIQUID_Z], *to = g->vectors[PL_LIQUID_Q];
    for (int k = 0; k < SWEEPS; ++k) {
        g->kernels->sweep(g, at->first, at->end, from, to);
        near_real *other = from;
        from = to;
        to = other;
    }
}

// Z of the finest grid is I R already.
void pl_liquid_cycle(pl_liquid_grid *g)
{
    for (uint32_t level = 1; level < g->level_count; ++level) {
        run_level(g, level, go_down);
    }
    solve_coarsest(g);
    for (uint32_t level = g->level_count - 1; level > 0; --level) {
        run_level(g, level, come_up);
        if (level > 1) {
            run_level(g, level - 1, sweep);
        }
    }
}
