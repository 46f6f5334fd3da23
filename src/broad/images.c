// images.c - what lies at the other side of an edge: boxes looked up at their images.
//
// Reads: grids. Writes: nothing. Cost: see images.h.
#include "broad/images.h"

#include <math.h>

// [m] boxes of the coarsest level and beyond may be larger than its cell.
#define CELL_MOST 16384.0

// How far [m] boxes of a grid reach from the origin along an axis of this period: half of the period, and the
// largest box.
static double bound_of(const pl_grid *grid, double period)
{
    double cell = grid->level_count > 0 ? grid->levels[grid->level_count - 1].cell : 0;
    return period / 2 + (cell < CELL_MOST && cell < period / 2 ? cell : period / 2);
}

// The k for which [low, high] - k period meets [-bound, bound]: the first of them, and how many.
static int range_of(double low, double high, double period, double bound, double *first)
{
    *first = 0;
    if (!(period > 0)) {
        return 1;
    }
    double from = ceil((low - bound) / period), to = floor((high + bound) / period);
    if (!(to >= from)) {
        return 0;
    }
    if (to - from < PL_IMAGES_MOST) {
        *first = from;
        return (int)(to - from) + 1;
    }
    const double half = PL_IMAGES_MOST / 2;
    *first = from > -half ? from : to < half ? to - (PL_IMAGES_MOST - 1) : -half;
    return PL_IMAGES_MOST;
}

pl_images pl_images_of(const plumb_world *world, const pl_grid *grid, pl_box box)
{
    pl_images i = { .period = { (double)world->desc.wrap_x, (double)world->desc.wrap_y } };
    i.columns = range_of((double)box.min_x, (double)box.max_x, i.period.x,
                         bound_of(grid, i.period.x), &i.x0);
    i.rows = range_of((double)box.min_y, (double)box.max_y, i.period.y, bound_of(grid, i.period.y),
                      &i.y0);
    return i;
}

static pl_box shifted(pl_box box, double x, double y)
{
    return (pl_box){ (real)((double)box.min_x + x), (real)((double)box.min_y + y),
                     (real)((double)box.max_x + x), (real)((double)box.max_y + y) };
}

//---- one box -------------------------------------------------------------------------------------

typedef struct image_visit {
    pl_grid_visit *visit;
    void *context;
    double x, y; // [m] from where it is filed to the image
} image_visit;

static bool visit_image(void *context, const pl_grid_entry *entry)
{
    const image_visit *v = context;
    pl_grid_entry image = *entry;
    image.box = shifted(entry->box, v->x, v->y);
    return v->visit(v->context, &image);
}

bool pl_world_query(const plumb_world *world, const pl_grid *grid, pl_box box, pl_grid_visit *visit,
                    void *context)
{
    if (!pl_is_wrapped(world)) {
        return pl_grid_query(grid, box, visit, context);
    }
    pl_images images = pl_images_of(world, grid, box);
    for (int k = 0; k < images.columns * images.rows; ++k) {
        pl_shift to = pl_images_shift(&images, k);
        image_visit v = { visit, context, to.x, to.y };
        pl_box at = v.x == 0 && v.y == 0 ? box : shifted(box, -v.x, -v.y);
        if (!pl_grid_query(grid, at, visit_image, &v)) {
            return false;
        }
    }
    return true;
}

//---- pairs ---------------------------------------------------------------------------------------

// The other images in a fixed order; the first half are the second with the signs turned.
#define SHIFTS 8
static const int shifts[SHIFTS][2] = { { 1, 0 },  { 0, 1 },  { 1, 1 },   { 1, -1 },
                                       { -1, 0 }, { 0, -1 }, { -1, -1 }, { -1, 1 } };

typedef struct seeker {
    const plumb_world *world;
    const pl_grid_entry *entry; // whose images are looked at
    int shift;
    pl_pair_found *found;
    void *context;
} seeker;

static bool turns_along(const plumb_world *world, int shift)
{
    return (shifts[shift][0] == 0 || world->desc.wrap_x > 0) &&
           (shifts[shift][1] == 0 || world->desc.wrap_y > 0);
}

static int opposite(int shift)
{
    return (shift + SHIFTS / 2) % SHIFTS;
}

static bool overlap_at(const seeker *s, const pl_box *a, const pl_box *b, int shift)
{
    pl_box at = shifted(*a, shifts[shift][0] * (double)s->world->desc.wrap_x,
                        shifts[shift][1] * (double)s->world->desc.wrap_y);
    return pl_boxes_overlap(&at, b);
}

// A pair that overlaps in several ways is taken in the first, as seen from the lower slot.
static bool is_first(const seeker *s, const pl_grid_entry *other)
{
    bool low = s->entry->piece < other->piece;
    const pl_box *a = low ? &s->entry->box : &other->box;
    const pl_box *b = low ? &other->box : &s->entry->box;
    int now = low ? s->shift : opposite(s->shift);
    if (pl_boxes_overlap(a, b)) {
        return false;
    }
    for (int k = 0; k < now; ++k) {
        const int *by = shifts[k];
        bool turns =
            (by[0] == 0 || s->world->desc.wrap_x > 0) && (by[1] == 0 || s->world->desc.wrap_y > 0);
        if (turns && overlap_at(s, a, b, k)) {
            return false;
        }
    }
    return true;
}

static bool visit_partner(void *context, const pl_grid_entry *other)
{
    const seeker *s = context;
    return s->entry->piece == other->piece || !is_first(s, other) ||
           s->found(s->context, s->entry->piece, other->piece);
}

static bool seek(seeker *s, const pl_grid *among, double bound_x, double bound_y)
{
    double x = shifts[s->shift][0] * (double)s->world->desc.wrap_x;
    double y = shifts[s->shift][1] * (double)s->world->desc.wrap_y;
    pl_box at = shifted(s->entry->box, x, y);
    if ((x != 0 && ((double)at.min_x > bound_x || (double)at.max_x < -bound_x)) ||
        (y != 0 && ((double)at.min_y > bound_y || (double)at.max_y < -bound_y))) {
        return true;
    }
    return pl_grid_query(among, at, visit_partner, s);
}

bool pl_images_partners(const plumb_world *world, const pl_grid_entry *entry, const pl_grid *among,
                        pl_pair_found *found, void *context)
{
    const double bound_x = bound_of(among, (double)world->desc.wrap_x);
    const double bound_y = bound_of(among, (double)world->desc.wrap_y);
    seeker s = { .world = world, .entry = entry, .found = found, .context = context };
    for (s.shift = 0; s.shift < SHIFTS && among->entry_count > 0; ++s.shift) {
        if (turns_along(world, s.shift) && !seek(&s, among, bound_x, bound_y)) {
            return false;
        }
    }
    return true;
}

bool pl_images_pairs(const plumb_world *world, const pl_grid *from, const pl_grid *among,
                     pl_pair_found *found, void *context)
{
    const double wrap_x = (double)world->desc.wrap_x, wrap_y = (double)world->desc.wrap_y;
    const double bound_x = bound_of(among, wrap_x), bound_y = bound_of(among, wrap_y);
    const pl_grid_entry *entries = pl_grid_entries(from);
    const int count = from == among ? SHIFTS / 2 : SHIFTS;
    for (int k = 0; k < count && among->entry_count > 0; ++k) {
        if (!turns_along(world, k)) {
            continue;
        }
        seeker s = { .world = world, .shift = k, .found = found, .context = context };
        for (uint32_t i = 0; i < from->entry_count; ++i) {
            s.entry = &entries[i];
            if (!seek(&s, among, bound_x, bound_y)) {
                return false;
            }
        }
    }
    return true;
}
