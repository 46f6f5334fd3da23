// grid.c - filing fat boxes by counting sort, and going through the cells that a box can touch.
//
// Cost of a build: four linear passes, O(pieces); 8,100 boxes take about 0.1 ms on one 2.6 GHz
// core.
#include "broad/grid.h"

#include "core/bits.h"
#include "plumb/math.h"

#include <string.h>

#define LOWEST_EXPONENT (-16)
#define CELL_LIMIT                                                                                 \
    1073741824.0 // cells are clamped to +-2^30: monotone, so neighbours stay neighbours

static int32_t cell_of(double coordinate, double inv_cell)
{
    double v = coordinate * inv_cell;
    if (v < -CELL_LIMIT) {
        v = -CELL_LIMIT;
    }
    if (v > CELL_LIMIT) {
        v = CELL_LIMIT;
    }
    int32_t i = (int32_t)v;
    return i - (v < (double)i);
}

static real extent_of(const pl_box *box)
{
    real w = box->max_x - box->min_x;
    real h = box->max_y - box->min_y;
    return w > h ? w : h;
}

// The octave of a size: level k holds extents in [2^(k-17), 2^(k-16)). The exponent is read from the bits:
// frexp was a tenth of a build.
static uint32_t octave_of(real extent)
{
    float size = (float)extent;
    uint32_t bits;
    memcpy(&bits, &size, sizeof bits);
    int exponent = (int)(bits >> 23 & 0xff) - 126 - LOWEST_EXPONENT;
    if (exponent < 0) {
        return 0;
    }
    return exponent < PL_GRID_LEVELS ? (uint32_t)exponent : PL_GRID_LEVELS - 1;
}

typedef struct survey {
    uint32_t count;
    real extent;                     // largest
    real min_x, min_y, max_x, max_y; // of the lower corners
    real top_x, top_y;               // of the upper ones
} survey;

// Of a level that has no box yet.
static const survey NONE = { 0,
                             -PLUMB_REAL_MAX,
                             PLUMB_REAL_MAX,
                             PLUMB_REAL_MAX,
                             -PLUMB_REAL_MAX,
                             -PLUMB_REAL_MAX,
                             -PLUMB_REAL_MAX,
                             -PLUMB_REAL_MAX };

// Of two sets of boxes.
static inline survey joined(survey a, survey b)
{
    return (survey){ .count = a.count + b.count,
                     .extent = plumb_max(b.extent, a.extent),
                     .min_x = plumb_min(b.min_x, a.min_x),
                     .min_y = plumb_min(b.min_y, a.min_y),
                     .max_x = plumb_max(b.max_x, a.max_x),
                     .max_y = plumb_max(b.max_y, a.max_y),
                     .top_x = plumb_max(b.top_x, a.top_x),
                     .top_y = plumb_max(b.top_y, a.top_y) };
}

// So many boxes are worth a thread.
#define LEAST 1024

typedef struct filing {
    pl_grid *grid;
    const uint32_t *pieces;
    const pl_box *fat;
    uint32_t count, shares;
    uint8_t level_of_octave[PL_GRID_LEVELS];
    survey *octaves; // PL_GRID_LEVELS for each share: those that have boxes
    uint32_t *used;  // a share: bits of these
} filing;

// Of neighbours in the list most are of one size: its survey is at hand until another comes.
static void survey_share(void *context, uint32_t i)
{
    filing *f = context;
    const pl_share mine = pl_share_of(f->count, f->shares, i);
    survey *octaves = f->octaves + (size_t)i * PL_GRID_LEVELS;
    uint32_t at = 0, used = 0;
    survey here = NONE;
    for (uint32_t k = mine.first; k < mine.end; ++k) {
        const pl_box box = f->fat[f->pieces[k]];
        const real extent = extent_of(&box);
        const uint32_t octave = octave_of(extent);
        if (octave != at) {
            octaves[at] = here;
            here = (used >> octave & 1) != 0 ? octaves[octave] : NONE;
            at = octave;
        }
        used |= UINT32_C(1) << octave;
        here = joined(here, (survey){ 1, extent, box.min_x, box.min_y, box.min_x, box.min_y,
                                      box.max_x, box.max_y });
    }
    octaves[at] = here;
    f->used[i] = used;
}

static uint32_t power_of_two_from(uint64_t least)
{
    uint32_t power = 16;
    while (power < least && power < (1u << 30)) {
        power *= 2;
    }
    return power;
}

// Chooses cell size and bucket mapping of one level.
static void lay_out_level(pl_grid_level *level, const survey *o)
{
    // A hair more than the largest box, so that rounding cannot put a neighbour two cells away.
    level->cell = (double)o->extent * (1.0 + 1e-5) + 1e-9;
    level->inv_cell = 1.0 / level->cell;
    level->count = o->count;
    level->bounds = (pl_box){ o->min_x, o->min_y, o->top_x, o->top_y };
    level->origin_x = cell_of((double)o->min_x, level->inv_cell) - 1;
    level->origin_y = cell_of((double)o->min_y, level->inv_cell) - 1;
    int64_t columns = (int64_t)cell_of((double)o->max_x, level->inv_cell) - level->origin_x + 2;
    int64_t rows = (int64_t)cell_of((double)o->max_y, level->inv_cell) - level->origin_y + 2;
    int64_t roomy = 4 * (int64_t)o->count + 16;
    if (columns <= roomy && rows <= roomy && columns * rows <= roomy) {
        level->mask = power_of_two_from((uint64_t)(columns * rows)) - 1;
        level->stride = (uint32_t)columns;
    } else {
        level->mask = power_of_two_from(2 * (uint64_t)o->count) - 1;
        level->stride =
            2654435769u; // golden ratio times 2^32, odd: rows scatter (Knuth, vol. 3, 6.4)
    }
}

// The cell of a box, and its bucket; then its place among the entries.
typedef struct place {
    int32_t cell_x, cell_y;
    uint32_t at;
} place;

static void find_places(void *context, uint32_t first, uint32_t count)
{
    const filing *f = context;
    place *places = f->grid->places.data;
    for (uint32_t i = first; i < first + count; ++i) {
        const pl_box *box = &f->fat[f->pieces[i]];
        const pl_grid_level *level =
            &f->grid->levels[f->level_of_octave[octave_of(extent_of(box))]];
        int32_t x = cell_of((double)box->min_x, level->inv_cell);
        int32_t y = cell_of((double)box->min_y, level->inv_cell);
        places[i] = (place){ x, y, level->starts + pl_grid_bucket(level, x, y) };
    }
}

static void file_boxes(void *context, uint32_t first, uint32_t count)
{
    const filing *f = context;
    const place *places = f->grid->places.data;
    pl_grid_entry *entries = f->grid->entries.data;
    for (uint32_t i = first; i < first + count; ++i) {
        uint32_t piece = f->pieces[i];
        entries[places[i].at] =
            (pl_grid_entry){ places[i].cell_x, places[i].cell_y, piece, f->fat[piece] };
    }
}

// Counting sort of the places by bucket.
static void order_places(pl_grid *grid, uint32_t count, size_t start_count)
{
    uint32_t *starts = grid->starts.data;
    place *places = grid->places.data;
    memset(starts, 0, start_count * sizeof *starts);
    for (uint32_t i = 0; i < count; ++i) {
        ++starts[places[i].at];
    }
    // Each bucket's start becomes its end, and from the back, which makes the sort stable, its start again.
    for (uint32_t k = 0; k < grid->level_count; ++k) {
        const pl_grid_level *level = &grid->levels[k];
        uint32_t sum = level->first;
        for (uint32_t b = 0; b <= level->mask + 1; ++b) {
            sum += starts[level->starts + b];
            starts[level->starts + b] = sum;
        }
    }
    for (uint32_t i = count; i-- > 0;) {
        places[i].at = --starts[places[i].at];
    }
}

// The octaves of all shares, in the place of the first.
static void join_shares(filing *f)
{
    for (uint32_t i = 1; i < f->shares; ++i) {
        const survey *octaves = f->octaves + (size_t)i * PL_GRID_LEVELS;
        for (uint32_t bits = f->used[i]; bits != 0; bits &= bits - 1) {
            const uint32_t k = (uint32_t)__builtin_ctz(bits);
            f->octaves[k] =
                (f->used[0] >> k & 1) != 0 ? joined(f->octaves[k], octaves[k]) : octaves[k];
        }
        f->used[0] |= f->used[i];
    }
}

// Room for a level an octave of these bits, and for a few that may come while things move.
static bool reserve_levels(pl_memory *memory, pl_grid *grid, uint32_t octaves)
{
    const uint32_t least = 4, used = pl_count_bits(octaves), count = used > least ? used : least;
    if (!pl_buffer_reserve(memory, &grid->level_room, count * sizeof(pl_grid_level))) {
        return false;
    }
    grid->levels = grid->level_room.data;
    return true;
}

// The levels of the octaves that have boxes; returns how many bucket starts they need.
static size_t lay_out(filing *f)
{
    pl_grid *grid = f->grid;
    size_t start_count = 0;
    uint32_t first = 0, used = 0;
    for (uint32_t bits = f->used[0]; bits != 0; bits &= bits - 1) {
        const uint32_t k = (uint32_t)__builtin_ctz(bits);
        pl_grid_level *level = &grid->levels[used];
        f->level_of_octave[k] = (uint8_t)used++;
        lay_out_level(level, &f->octaves[k]);
        level->first = first;
        level->starts = (uint32_t)start_count;
        first += level->count;
        start_count += (size_t)level->mask + 2;
    }
    grid->level_count = used;
    return start_count;
}

bool pl_grid_build(pl_memory *memory, pl_tasks *tasks, pl_grid *grid, const uint32_t *pieces,
                   uint32_t count, const pl_box *fat)
{
    survey alone[PL_GRID_LEVELS]; // of one share; those of several lie where the places come to lie
    uint32_t used[PLUMB_WORKERS_MAX];
    filing f;
    f.grid = grid;
    f.pieces = pieces;
    f.fat = fat;
    f.count = count;
    f.shares = pl_tasks_share_count(tasks, count, LEAST);
    grid->entry_count = grid->level_count = 0;
    grid->mapped = false;
    _Static_assert(LEAST * sizeof(place) >= sizeof alone, "the places of a share hold its survey");
    if (!pl_buffer_reserve(memory, &grid->entries, (count + 1) * sizeof(pl_grid_entry)) ||
        !pl_buffer_reserve(memory, &grid->places, (count + 1) * sizeof(place))) {
        return false;
    }
    f.octaves = f.shares > 1 ? grid->places.data : alone;
    f.used = used;
    pl_tasks_run(tasks, survey_share, &f, f.shares);
    join_shares(&f);
    if (!reserve_levels(memory, grid, used[0])) {
        return false;
    }
    const size_t start_count = lay_out(&f);
    if (!pl_buffer_reserve(memory, &grid->starts, (start_count + 1) * sizeof(uint32_t))) {
        grid->level_count = 0;
        return false;
    }
    pl_tasks_ranges(tasks, count, LEAST, find_places, &f);
    order_places(grid, count, start_count);
    pl_tasks_ranges(tasks, count, LEAST, file_boxes, &f);
    grid->entry_count = count;
    return true;
}

// Room for one side of every box.
static size_t lane_room(const pl_grid *grid)
{
    return (size_t)grid->entry_count + PL_GRID_SPARE;
}

static void fill_lanes(void *context, uint32_t first, uint32_t count)
{
    const pl_grid *grid = context;
    const pl_grid_entry *entries = pl_grid_entries(grid);
    const size_t room = lane_room(grid);
    real *min_x = grid->sides.data, *min_y = min_x + room, *max_x = min_y + room;
    real *max_y = max_x + room;
    for (uint32_t i = first; i < first + count; ++i) {
        const pl_box box = entries[i].box;
        min_x[i] = box.min_x;
        min_y[i] = box.min_y;
        max_x[i] = box.max_x;
        max_y[i] = box.max_y;
    }
}

bool pl_grid_make_lanes(pl_memory *memory, pl_tasks *tasks, pl_grid *grid)
{
    const size_t room = lane_room(grid);
    if (!pl_buffer_reserve(memory, &grid->sides, 4 * room * sizeof(real))) {
        return false;
    }
    pl_tasks_ranges(tasks, grid->entry_count, LEAST, fill_lanes, grid);
    real *sides = grid->sides.data;
    for (uint32_t side = 1; side <= 4; ++side) {
        memset(sides + side * room - PL_GRID_SPARE, 0, PL_GRID_SPARE * sizeof(real));
    }
    return true;
}

pl_grid_lanes pl_grid_lanes_of(const pl_grid *grid)
{
    const size_t room = lane_room(grid);
    const real *sides = grid->sides.data;
    return (pl_grid_lanes){ sides, sides + room, sides + 2 * room, sides + 3 * room };
}

static double squares_per_metre(double length)
{
    return length > 0 ? PL_GRID_MAP / length : 0;
}

// A square of a map along x or y; what lies beyond it counts to its ends.
static inline uint32_t square_of(double from_low, double per_metre)
{
    double square = from_low * per_metre;
    square = square > 0 ? square : 0;
    return (uint32_t)(int32_t)(square < PL_GRID_MAP - 1 ? square : PL_GRID_MAP - 1);
}

static uint64_t *map_of(const pl_grid *grid, uint32_t level)
{
    return (uint64_t *)grid->maps.data + (size_t)level * PL_GRID_MAP;
}

// So few boxes are looked at sooner than a map of them.
#define MAPPED_LEAST 8

bool pl_grid_make_maps(pl_memory *memory, pl_grid *grid)
{
    if (grid->entry_count < MAPPED_LEAST) {
        return true;
    }
    size_t size = (size_t)grid->level_count * PL_GRID_MAP * sizeof(uint64_t);
    if (!pl_buffer_reserve(memory, &grid->maps, size + 1)) {
        return false;
    }
    memset(grid->maps.data, 0, size);
    for (uint32_t k = 0; k < grid->level_count; ++k) {
        pl_grid_level *level = &grid->levels[k];
        const pl_grid_entry *entries = pl_grid_entries(grid) + level->first;
        uint64_t *map = map_of(grid, k);
        double low_x = (double)level->bounds.min_x, low_y = (double)level->bounds.min_y;
        level->map_per_x = squares_per_metre((double)level->bounds.max_x - low_x);
        level->map_per_y = squares_per_metre((double)level->bounds.max_y - low_y);
        for (uint32_t i = 0; i < level->count; ++i) {
            uint32_t x = square_of((double)entries[i].box.min_x - low_x, level->map_per_x);
            uint32_t y = square_of((double)entries[i].box.min_y - low_y, level->map_per_y);
            map[y] |= UINT64_C(1) << x;
        }
    }
    grid->mapped = true;
    return true;
}

void pl_grid_free(pl_memory *memory, pl_grid *grid)
{
    pl_buffer_free(memory, &grid->level_room);
    pl_buffer_free(memory, &grid->entries);
    pl_buffer_free(memory, &grid->starts);
    pl_buffer_free(memory, &grid->places);
    pl_buffer_free(memory, &grid->maps);
    pl_buffer_free(memory, &grid->sides);
    *grid = (pl_grid){ 0 };
}

pl_cell_range pl_grid_range(const pl_grid_level *level, pl_box box)
{
    pl_cell_range range;
    range.x0 = cell_of((double)box.min_x - level->cell, level->inv_cell);
    range.y0 = cell_of((double)box.min_y - level->cell, level->inv_cell);
    range.x1 = cell_of((double)box.max_x, level->inv_cell);
    range.y1 = cell_of((double)box.max_y, level->inv_cell);
    return range;
}

bool pl_grid_range_is_wide(const pl_grid_level *level, pl_cell_range range)
{
    uint64_t columns = (uint64_t)((int64_t)range.x1 - range.x0) + 1;
    uint64_t rows = (uint64_t)((int64_t)range.y1 - range.y0) + 1;
    return columns > level->mask || rows * columns > (uint64_t)level->count + 16;
}

// False: by the map, nothing of the level overlaps the box. Lower corners of what does are at most a cell
// before it.
static inline bool is_on_map(const pl_grid *grid, uint32_t k, const pl_box *box)
{
    const pl_grid_level *level = &grid->levels[k];
    const uint64_t *map = map_of(grid, k);
    double low_x = (double)level->bounds.min_x, low_y = (double)level->bounds.min_y;
    uint32_t x0 = square_of((double)box->min_x - level->cell - low_x, level->map_per_x);
    uint32_t x1 = square_of((double)box->max_x - low_x, level->map_per_x);
    uint32_t y0 = square_of((double)box->min_y - level->cell - low_y, level->map_per_y);
    uint32_t y1 = square_of((double)box->max_y - low_y, level->map_per_y);
    uint64_t columns = UINT64_MAX >> (PL_GRID_MAP - 1 - (x1 - x0)) << x0, some = 0;
    for (uint32_t y = y0; y <= y1; ++y) {
        some |= map[y] & columns;
    }
    return some != 0;
}

static bool visit_run(const pl_grid_entry *entries, pl_grid_run run, const pl_box *box,
                      pl_grid_visit *visit, void *context)
{
    for (uint32_t i = run.begin; i < run.end; ++i) {
        if (pl_boxes_overlap(&entries[i].box, box) && !visit(context, &entries[i])) {
            return false;
        }
    }
    return true;
}

static bool visit_row(const pl_grid_entry *entries, pl_grid_run run, pl_cell_range range, int32_t y,
                      const pl_box *box, pl_grid_visit *visit, void *context)
{
    uint32_t width = (uint32_t)(range.x1 - range.x0);
    for (uint32_t i = run.begin; i < run.end; ++i) {
        const pl_grid_entry *e = &entries[i];
        if (e->cell_y == y && (uint32_t)e->cell_x - (uint32_t)range.x0 <= width &&
            pl_boxes_overlap(&e->box, box) && !visit(context, e)) {
            return false;
        }
    }
    return true;
}

bool pl_grid_query(const pl_grid *grid, pl_box box, pl_grid_visit *visit, void *context)
{
    const pl_grid_entry *entries = pl_grid_entries(grid);
    for (uint32_t k = 0; k < grid->level_count; ++k) {
        const pl_grid_level *level = &grid->levels[k];
        if (!pl_boxes_overlap(&level->bounds, &box) ||
            (grid->mapped && !is_on_map(grid, k, &box))) {
            continue;
        }
        pl_cell_range range = pl_grid_range(level, box);
        if (pl_grid_range_is_wide(level, range)) {
            pl_grid_run all = { level->first, level->first + level->count };
            if (!visit_run(entries, all, &box, visit, context)) {
                return false;
            }
            continue;
        }
        for (int32_t y = range.y0; y <= range.y1; ++y) {
            pl_grid_run runs[2];
            int run_count = pl_grid_row(grid, level, range.x0, range.x1, y, runs);
            for (int r = 0; r < run_count; ++r) {
                if (!visit_row(entries, runs[r], range, y, &box, visit, context)) {
                    return false;
                }
            }
        }
    }
    return true;
}
