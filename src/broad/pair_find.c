// pair_find.c - every overlapping pair of fat boxes, once.
//
// Equal levels: a pair is found from the box whose cell comes first, which looks at its own cell,
// the next one in its row and the three neighbours in the next row. Different levels: from the
// finer box. Static pieces: from the moving box. Cost: O(moving pieces + pairs) for sizes within an
// octave.
//
// Around the pieces that left their boxes: from each of those, all about it. Two of them find each
// other twice; the find of the lower one counts.
//
// Threads share the boxes from which is looked; each has a part of `found`, and when one of these is too
// small all is done again with more room. What is found is sorted later: its order does not matter here.
#include "world/joint_list.h"
#include "broad/images.h"
#include "broad/pairs.h"
#include "broad/box_overlap.h"
#include "world/filter.h"

#include <string.h>

typedef struct finder {
    plumb_world *world;
    const uint32_t *body;        // of a piece slot
    const uint32_t *first_joint; // of a body row
    uint32_t dynamic_count;
    pl_grid_lanes lanes; // of the moving grid
    pl_found *found;
    uint32_t count, capacity;
    const uint8_t *left; // marks of the pieces around which is looked; NULL: everywhere
    bool selective;      // filters, excluded pairs or sensors are there
    bool alone;          // no other thread looks: it may grow its list
    bool out_of_room, out_of_memory;
    uint32_t piece; // whose partners are being collected
} finder;

static bool grow(finder *f)
{
    pl_broad *broad = &f->world->broad;
    if (!f->alone) {
        f->out_of_room = true;
        return false;
    }
    size_t wanted = ((size_t)f->capacity + 1024) * sizeof(pl_found);
    if (!pl_buffer_reserve(&f->world->memory, &broad->found, wanted)) {
        f->out_of_memory = true;
        return false;
    }
    f->found = broad->found.data;
    f->capacity = (uint32_t)(broad->found.size / sizeof(pl_found));
    return true;
}

// A pair with a sensor, which may do without a dynamic body.
static bool add_sensed(finder *f, uint32_t sensor, uint32_t other)
{
    pl_broad *broad = &f->world->broad;
    size_t wanted = ((size_t)broad->sensed_count + 1) * sizeof(pl_found);
    if (!pl_buffer_reserve(&f->world->memory, &broad->sensed, wanted)) {
        f->out_of_memory = true;
        return false;
    }
    ((pl_found *)broad->sensed.data)[broad->sensed_count++] = (pl_found){ sensor, other };
    return true;
}

// Asks the filters; pairs with sensors go to their own list, once for each sensor. True: go on.
static __attribute__((noinline)) bool select_pair(finder *f, uint32_t p, uint32_t q, bool *solid)
{
    const uint8_t *flags = f->world->pieces.flags;
    bool p_senses = (flags[p] & PL_PIECE_SENSOR) != 0, q_senses = (flags[q] & PL_PIECE_SENSOR) != 0;
    bool meet = f->body[p] != f->body[q] && pl_pieces_meet(f->world, p, q);
    *solid = meet && !p_senses && !q_senses;
    return !meet || ((!p_senses || add_sensed(f, p, q)) && (!q_senses || add_sensed(f, q, p)));
}

// Whether the pieces meet is plain to see: 1: they do, as no rule is about them; -1: not, being of one body
// or of one group that does not meet itself. 0: select_pair must tell.
static inline int see_pair(const finder *f, uint32_t p, uint32_t q)
{
    const pl_pieces *s = &f->world->pieces;
    if (f->body[p] == f->body[q] || (s->group[p] == s->group[q] && s->group[p] < 0)) {
        return -1;
    }
    return ((s->flags[p] | s->flags[q]) & (PL_PIECE_FILTERED | PL_PIECE_SENSOR)) == 0 &&
           f->world->excluded_count == 0;
}

// Adds the pair unless nothing could come of it: one body, no dynamic body, or a joint
// that keeps them apart.
static inline bool add_pair(finder *f, uint32_t p, uint32_t q)
{
    bool solid = true;
    if (f->left != NULL && q < p && f->left[q] != 0) {
        return true;
    }
    if (f->selective) {
        int seen = see_pair(f, p, q);
        if (seen < 0 || (seen == 0 && (!select_pair(f, p, q, &solid) || !solid))) {
            return !f->out_of_memory;
        }
    }
    uint32_t body_p = f->body[p];
    uint32_t body_q = f->body[q];
    if (body_p == body_q || (body_p >= f->dynamic_count && body_q >= f->dynamic_count)) {
        return true;
    }
    if (f->first_joint[body_p] != PL_NONE && f->first_joint[body_q] != PL_NONE &&
        pl_joints_forbid(f->world, body_p, body_q)) {
        return true;
    }
    if (f->count == f->capacity && !grow(f)) {
        return false;
    }
    f->found[f->count++] = p < q ? (pl_found){ p, q } : (pl_found){ q, p };
    return true;
}

static bool add_visited(void *context, const pl_grid_entry *entry)
{
    finder *f = context;
    return add_pair(f, f->piece, entry->piece);
}

// Entries of a run that lie in the cells x0..x0 + width of row y and overlap the box of `piece`.
static inline bool scan_run(finder *f, const pl_grid *grid, pl_grid_run run, int32_t x0,
                            uint32_t width, int32_t y, uint32_t piece, const pl_box_wide *wide)
{
    const pl_grid_entry *entries = pl_grid_entries(grid);
    for (uint32_t first = run.begin; first < run.end; first += PL_BOX_LANES) {
        for (uint32_t bits = pl_box_overlaps(&f->lanes, first, run.end, wide); bits != 0;
             bits &= bits - 1) {
            const pl_grid_entry *other = &entries[first + (uint32_t)__builtin_ctz(bits)];
            if (other->cell_y == y && (uint32_t)other->cell_x - (uint32_t)x0 <= width &&
                !add_pair(f, piece, other->piece)) {
                return false;
            }
        }
    }
    return true;
}

static bool scan_row(finder *f, const pl_grid *grid, const pl_grid_level *level, int32_t x0,
                     int32_t x1, int32_t y, uint32_t piece, const pl_box_wide *wide)
{
    pl_grid_run runs[2];
    int run_count = pl_grid_row(grid, level, x0, x1, y, runs);
    for (int r = 0; r < run_count; ++r) {
        if (!scan_run(f, grid, runs[r], x0, (uint32_t)(x1 - x0), y, piece, wide)) {
            return false;
        }
    }
    return true;
}

// Entries of a level from which a thread looks.
static pl_share part_of(const pl_grid_level *level, pl_share share)
{
    uint32_t end = level->first + level->count;
    return (pl_share){ level->first > share.first ? level->first : share.first,
                       end < share.end ? end : share.end };
}

static bool find_in_level(finder *f, const pl_grid *grid, const pl_grid_level *level,
                          pl_share share)
{
    const pl_grid_entry *entries = pl_grid_entries(grid);
    const pl_share part = part_of(level, share);
    for (uint32_t i = part.first; i < part.end; ++i) {
        const pl_grid_entry *e = &entries[i];
        const pl_box_wide wide = pl_box_wide_of(&e->box);
        // Own cell: the entries filed behind this one, then those of the next. In hashed levels those of
        // other cells may lie between.
        pl_grid_run runs[2];
        int run_count = pl_grid_row(grid, level, e->cell_x, e->cell_x + 1, e->cell_y, runs);
        runs[0].begin = i + 1;
        if (!scan_run(f, grid, runs[0], e->cell_x, 1, e->cell_y, e->piece, &wide) ||
            (run_count > 1 &&
             !scan_run(f, grid, runs[1], e->cell_x, 1, e->cell_y, e->piece, &wide)) ||
            !scan_row(f, grid, level, e->cell_x - 1, e->cell_x + 1, e->cell_y + 1, e->piece,
                      &wide)) {
            return false;
        }
    }
    return true;
}

// So few boxes of a level are gone through sooner than its cells are found.
#define FEW 64

// Partners of a box in a level of the grid, all about it.
static bool find_about(finder *f, const pl_grid *grid, const pl_grid_level *level,
                       const pl_grid_entry *e)
{
    const pl_grid_entry *entries = pl_grid_entries(grid);
    if (!pl_boxes_overlap(&level->bounds, &e->box)) {
        return true;
    }
    const pl_box_wide wide = pl_box_wide_of(&e->box);
    pl_cell_range range = { 0 };
    bool all = level->count <= FEW;
    if (!all) {
        range = pl_grid_range(level, e->box);
        all = pl_grid_range_is_wide(level, range);
    }
    if (all) {
        const uint32_t end = level->first + level->count;
        for (uint32_t j = level->first; j < end; j += PL_BOX_LANES) {
            for (uint32_t bits = pl_box_overlaps(&f->lanes, j, end, &wide); bits != 0;
                 bits &= bits - 1) {
                if (!add_pair(f, e->piece, entries[j + (uint32_t)__builtin_ctz(bits)].piece)) {
                    return false;
                }
            }
        }
        return true;
    }
    for (int32_t y = range.y0; y <= range.y1; ++y) {
        if (!scan_row(f, grid, level, range.x0, range.x1, y, e->piece, &wide)) {
            return false;
        }
    }
    return true;
}

// Partners of every box of level k among the coarser levels of the moving grid.
static bool find_across_levels(finder *f, const pl_grid *grid, uint32_t k, pl_share share)
{
    const pl_grid_entry *entries = pl_grid_entries(grid);
    const pl_share part = part_of(&grid->levels[k], share);
    for (uint32_t m = k + 1; m < grid->level_count; ++m) {
        for (uint32_t i = part.first; i < part.end; ++i) {
            if (!find_about(f, grid, &grid->levels[m], &entries[i])) {
                return false;
            }
        }
    }
    return true;
}

static bool find_against_fixed(finder *f, const pl_grid *moving, const pl_grid *fixed,
                               pl_share share)
{
    const pl_grid_entry *entries = pl_grid_entries(moving);
    if (fixed->entry_count == 0) {
        return true;
    }
    for (uint32_t i = share.first; i < share.end; ++i) {
        f->piece = entries[i].piece;
        if (!pl_grid_query(fixed, entries[i].box, add_visited, f)) {
            return false;
        }
    }
    return true;
}

bool pl_pair_is_solid(plumb_world *world, uint32_t p, uint32_t q)
{
    const pl_pieces *s = &world->pieces;
    const uint32_t *first_joint = world->bodies.first_joint;
    uint32_t body_p = s->body[p], body_q = s->body[q];
    return body_p != body_q && ((s->flags[p] | s->flags[q]) & PL_PIECE_SENSOR) == 0 &&
           (!pl_world_is_selective(world) || pl_pieces_meet(world, p, q)) &&
           (first_joint[body_p] == PL_NONE || first_joint[body_q] == PL_NONE ||
            !pl_joints_forbid(world, body_p, body_q));
}

// What sleeps is no partner, but sensors see it, and its sensors see others.
static bool add_resting(void *context, const pl_grid_entry *entry)
{
    finder *f = context;
    const uint8_t *flags = f->world->pieces.flags;
    bool solid;
    return (flags[entry->piece] & PL_PIECE_ASLEEP) == 0 ||
           ((flags[f->piece] | flags[entry->piece]) & PL_PIECE_SENSOR) == 0 ||
           select_pair(f, f->piece, entry->piece, &solid);
}

static bool find_sensed_resting(finder *f, const pl_grid *moving, const pl_grid *resting)
{
    const pl_grid_entry *entries = pl_grid_entries(moving);
    if (resting->entry_count == 0 || f->world->sensor_pieces == 0) {
        return true;
    }
    for (uint32_t i = 0; i < moving->entry_count; ++i) {
        f->piece = entries[i].piece;
        if (!pl_grid_query(resting, entries[i].box, add_resting, f)) {
            return false;
        }
    }
    return true;
}

//---- over the edges of a world that wraps around --------------------------------------------------

static bool add_image(void *context, uint32_t piece, uint32_t other)
{
    return add_pair(context, piece, other);
}

static bool add_resting_image(void *context, uint32_t piece, uint32_t other)
{
    finder *f = context;
    f->piece = piece;
    return add_resting(f, &(pl_grid_entry){ .piece = other });
}

// Of one piece that left its box.
static bool find_over_edges_about(finder *f, const pl_grid_entry *e, bool meet, bool grounded)
{
    const plumb_world *world = f->world;
    const pl_broad *b = &world->broad;
    return (!meet || pl_images_partners(world, e, &b->moving, add_image, f)) &&
           (!grounded || pl_images_partners(world, e, &b->fixed, add_image, f)) &&
           (world->sensor_pieces == 0 ||
            pl_images_partners(world, e, &b->resting, add_resting_image, f));
}

static bool find_over_edges(finder *f, bool meet, bool grounded)
{
    const plumb_world *world = f->world;
    const pl_broad *b = &world->broad;
    return (!meet || pl_images_pairs(world, &b->moving, &b->moving, add_image, f)) &&
           (!grounded || pl_images_pairs(world, &b->moving, &b->fixed, add_image, f)) &&
           (world->sensor_pieces == 0 ||
            pl_images_pairs(world, &b->moving, &b->resting, add_resting_image, f));
}

//---- all -----------------------------------------------------------------------------------------

// Fewer boxes than this are not worth a thread.
#define LEAST 64

struct hunt;
typedef bool look_fn(const struct hunt *hunt, finder *f, pl_share share);

typedef struct hunt {
    plumb_world *world;
    bool meet, grounded; // moving pieces may meet one another; static ones
    bool senses;         // sensors may see what sleeps
    uint32_t count;      // boxes from which is looked: of the moving grid, or those that were left
    uint32_t shares;
    look_fn *look;
    finder finders[PLUMB_WORKERS_MAX];
} hunt;

// From every box of the moving grid.
static bool look_everywhere(const hunt *h, finder *f, pl_share share)
{
    const plumb_world *world = h->world;
    const pl_broad *b = &world->broad;
    for (uint32_t k = 0; h->meet && k < b->moving.level_count; ++k) {
        if (!find_in_level(f, &b->moving, &b->moving.levels[k], share) ||
            !find_across_levels(f, &b->moving, k, share)) {
            return false;
        }
    }
    return (!h->grounded || find_against_fixed(f, &b->moving, &b->fixed, share)) &&
           (!h->senses || find_sensed_resting(f, &b->moving, &b->resting)) &&
           (!pl_is_wrapped(world) || find_over_edges(f, h->meet, h->grounded));
}

// About every piece that left its box.
static bool look_about(const hunt *h, finder *f, pl_share share)
{
    const plumb_world *world = h->world;
    const pl_broad *b = &world->broad;
    for (uint32_t i = share.first; i < share.end; ++i) {
        uint32_t piece = ((const uint32_t *)b->left.data)[i];
        pl_grid_entry e = { .piece = piece, .box = world->pieces.fat[piece] };
        f->piece = piece;
        for (uint32_t k = 0; h->meet && k < b->moving.level_count; ++k) {
            if (!find_about(f, &b->moving, &b->moving.levels[k], &e)) {
                return false;
            }
        }
        if ((h->grounded && !pl_grid_query(&b->fixed, e.box, add_visited, f)) ||
            (h->senses && !pl_grid_query(&b->resting, e.box, add_resting, f)) ||
            (pl_is_wrapped(world) && !find_over_edges_about(f, &e, h->meet, h->grounded))) {
            return false;
        }
    }
    return true;
}

// The finder is kept apart from those of other threads meanwhile, in a cache line of its own.
static void look_share(void *context, uint32_t i)
{
    hunt *h = context;
    finder f = h->finders[i];
    h->look(h, &f, pl_share_of(h->count, h->shares, i));
    h->finders[i] = f;
}

// Every thread with its part of the room for what is found.
static void set_out(hunt *h, const uint8_t *left)
{
    const pl_broad *broad = &h->world->broad;
    const uint32_t room = (uint32_t)(broad->found.size / sizeof(pl_found)) / h->shares;
    for (uint32_t i = 0; i < h->shares; ++i) {
        h->finders[i] = (finder){ .world = h->world,
                                  .body = h->world->pieces.body,
                                  .first_joint = h->world->bodies.first_joint,
                                  .dynamic_count = h->world->dynamic_count,
                                  .lanes = pl_grid_lanes_of(&broad->moving),
                                  .selective = pl_world_is_selective(h->world),
                                  .left = left,
                                  .alone = h->shares == 1,
                                  .found = (pl_found *)broad->found.data + (size_t)i * room,
                                  .capacity = room };
    }
}

// Puts what all found together. False: some of them had not room enough.
static bool bring_in(hunt *h)
{
    pl_broad *broad = &h->world->broad;
    broad->found_count = 0;
    bool whole = true;
    for (uint32_t i = 0; i < h->shares; ++i) {
        const finder *f = &h->finders[i];
        if (i > 0 && f->count > 0) {
            memmove((pl_found *)broad->found.data + broad->found_count, f->found,
                    f->count * sizeof(pl_found));
        }
        broad->found_count += f->count;
        whole &= !f->out_of_room;
    }
    return whole;
}

static bool look(plumb_world *world, look_fn *from, uint32_t count, const uint8_t *left)
{
    hunt all, *h = &all; // most of it is for threads, and written where there are some
    h->world = world;
    h->look = from;
    h->count = count;
    pl_filters_may_meet(world, &h->meet, &h->grounded);
    h->senses = world->sensor_pieces > 0 && world->broad.resting.entry_count > 0;
    const bool together = world->sensor_pieces == 0 && !pl_is_wrapped(world);
    h->shares = together ? pl_tasks_share_count(world->tasks, h->count, LEAST) : 1;
    // Never null, even where nothing comes to lie: parts of it are pointed to, also while pairs are merged.
    if (!pl_buffer_reserve(&world->memory, &world->broad.found, sizeof(pl_found))) {
        return false;
    }
    for (;;) {
        set_out(h, left);
        pl_tasks_run(world->tasks, look_share, h, h->shares);
        if (bring_in(h)) {
            return !h->finders[0].out_of_memory;
        }
        if (!pl_buffer_reserve(&world->memory, &world->broad.found,
                               2 * world->broad.found.size + 1024 * sizeof(pl_found))) {
            return false;
        }
    }
}

bool pl_pairs_find(plumb_world *world)
{
    world->broad.sensed_count = 0;
    return look(world, look_everywhere, world->broad.moving.entry_count, NULL);
}

// Takes out what the pieces that left their boxes had to do with sensors.
static void forget_sensed(pl_broad *broad)
{
    const uint8_t *left = broad->left_marks.data;
    pl_found *sensed = broad->sensed.data;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < broad->sensed_count; ++i) {
        sensed[kept] = sensed[i];
        kept += left[sensed[i].low] == 0 && left[sensed[i].high] == 0;
    }
    broad->sensed_count = kept;
}

bool pl_pairs_find_left(plumb_world *world)
{
    forget_sensed(&world->broad);
    return look(world, look_about, world->broad.left_count, world->broad.left_marks.data);
}
