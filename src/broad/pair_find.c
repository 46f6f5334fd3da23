// pair_find.c - every overlapping pair of fat boxes, once.
//
// Equal levels: a pair is found from the box whose cell comes first, which looks at its own cell,
// the next one in its row and the three neighbours in the next row. Different levels: from the
// finer box. Static pieces: from the moving box. Cost: O(moving pieces + pairs) for sizes within an
// octave.
//
// Around the pieces that left their boxes: from each of those, all about it. Two of them find each
// other twice; the find of the lower one counts.
#include "broad/images.h"
#include "broad/pairs.h"
#include "world/filter.h"

typedef struct finder {
    plumb_world *world;
    const uint32_t *body;        // of a piece slot
    const uint32_t *first_joint; // of a body row
    uint32_t dynamic_count;
    pl_found *found;
    uint32_t count, capacity;
    const uint8_t *left; // marks of the pieces around which is looked; NULL: everywhere
    bool selective;      // filters, excluded pairs or sensors are there
    bool out_of_memory;
    uint32_t piece; // whose partners are being collected
} finder;

static bool grow(finder *f)
{
    pl_broad *broad = &f->world->broad;
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

// Entries of a run that lie in the cells x0..x1 of row y and overlap `e`.
static inline bool scan_run(finder *f, const pl_grid_entry *entries, pl_grid_run run, int32_t x0,
                            uint32_t width, int32_t y, const pl_grid_entry *e)
{
    for (uint32_t i = run.begin; i < run.end; ++i) {
        const pl_grid_entry *other = &entries[i];
        if (pl_boxes_overlap(&e->box, &other->box) && other->cell_y == y &&
            (uint32_t)other->cell_x - (uint32_t)x0 <= width &&
            !add_pair(f, e->piece, other->piece)) {
            return false;
        }
    }
    return true;
}

static bool scan_row(finder *f, const pl_grid *grid, const pl_grid_level *level, int32_t x0,
                     int32_t x1, int32_t y, const pl_grid_entry *e)
{
    const pl_grid_entry *entries = pl_grid_entries(grid);
    pl_grid_run runs[2];
    int run_count = pl_grid_row(grid, level, x0, x1, y, runs);
    for (int r = 0; r < run_count; ++r) {
        if (!scan_run(f, entries, runs[r], x0, (uint32_t)(x1 - x0), y, e)) {
            return false;
        }
    }
    return true;
}

static bool find_in_level(finder *f, const pl_grid *grid, const pl_grid_level *level)
{
    const pl_grid_entry *entries = pl_grid_entries(grid);
    for (uint32_t i = level->first; i < level->first + level->count; ++i) {
        const pl_grid_entry *e = &entries[i];
        // Own cell: the entries filed behind this one. They are followed by those of other cells,
        // in hashed levels perhaps of the same bucket, hence the comparison.
        pl_grid_run runs[2];
        pl_grid_row(grid, level, e->cell_x, e->cell_x, e->cell_y, runs);
        runs[0].begin = i + 1;
        if (!scan_run(f, entries, runs[0], e->cell_x, 0, e->cell_y, e) ||
            !scan_row(f, grid, level, e->cell_x + 1, e->cell_x + 1, e->cell_y, e) ||
            !scan_row(f, grid, level, e->cell_x - 1, e->cell_x + 1, e->cell_y + 1, e)) {
            return false;
        }
    }
    return true;
}

// Partners of a box in a level of the grid, all about it.
static bool find_about(finder *f, const pl_grid *grid, const pl_grid_level *level,
                       const pl_grid_entry *e)
{
    const pl_grid_entry *entries = pl_grid_entries(grid);
    if (!pl_boxes_overlap(&level->bounds, &e->box)) {
        return true;
    }
    pl_cell_range range = pl_grid_range(level, e->box);
    if (pl_grid_range_is_wide(level, range)) {
        for (uint32_t j = level->first; j < level->first + level->count; ++j) {
            if (pl_boxes_overlap(&e->box, &entries[j].box) &&
                !add_pair(f, e->piece, entries[j].piece)) {
                return false;
            }
        }
        return true;
    }
    for (int32_t y = range.y0; y <= range.y1; ++y) {
        if (!scan_row(f, grid, level, range.x0, range.x1, y, e)) {
            return false;
        }
    }
    return true;
}

// Partners of every box of level k among the coarser levels of the moving grid.
static bool find_across_levels(finder *f, const pl_grid *grid, uint32_t k)
{
    const pl_grid_entry *entries = pl_grid_entries(grid);
    const pl_grid_level *fine = &grid->levels[k];
    for (uint32_t m = k + 1; m < grid->level_count; ++m) {
        for (uint32_t i = fine->first; i < fine->first + fine->count; ++i) {
            if (!find_about(f, grid, &grid->levels[m], &entries[i])) {
                return false;
            }
        }
    }
    return true;
}

static bool find_against_fixed(finder *f, const pl_grid *moving, const pl_grid *fixed)
{
    const pl_grid_entry *entries = pl_grid_entries(moving);
    if (fixed->entry_count == 0) {
        return true;
    }
    for (uint32_t i = 0; i < moving->entry_count; ++i) {
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

//---- crowds that never meet ----------------------------------------------------------------------

// What the filters of many pieces have in common.
typedef struct crowd {
    uint64_t category, mask; // of any
    int32_t group;           // of all, where `one_group`
    bool one_group, forced;  // forced: a positive group, which no mask keeps apart
} crowd;

static void join_crowd(crowd *c, const pl_pieces *pieces, uint32_t piece)
{
    bool first = c->category == 0;
    c->one_group = first || (c->one_group && c->group == pieces->group[piece]);
    c->group = pieces->group[piece];
    c->forced |= c->group > 0;
    c->category |= pieces->category[piece];
    c->mask |= pieces->mask[piece];
}

static bool may_meet(const crowd *a, const crowd *b)
{
    if (a->one_group && b->one_group && a->group == b->group && a->group < 0) {
        return false;
    }
    return (a->forced && b->forced) ||
           ((a->category & b->mask) != 0 && (b->category & a->mask) != 0);
}

// The crowd of moving pieces; stops where it may meet itself, whatever comes.
static bool moving_crowd(const plumb_world *world, crowd *c)
{
    const uint32_t *moving = pl_moving(world);
    *c = (crowd){ .category = 0 };
    for (uint32_t i = 0; i < world->moving_count; ++i) {
        join_crowd(c, &world->pieces, moving[i]);
        if (!(c->one_group && c->group < 0) && may_meet(c, c)) {
            return true;
        }
    }
    return may_meet(c, c);
}

static bool meets_fixed(const plumb_world *world, const crowd *moving)
{
    const pl_grid *fixed = &world->broad.fixed;
    crowd c = { .category = 0 };
    for (uint32_t i = 0; i < fixed->entry_count; ++i) {
        join_crowd(&c, &world->pieces, pl_grid_entries(fixed)[i].piece);
    }
    return may_meet(moving, &c);
}

static finder make_finder(plumb_world *world)
{
    pl_broad *broad = &world->broad;
    return (finder){ .world = world,
                     .body = world->pieces.body,
                     .first_joint = world->bodies.first_joint,
                     .dynamic_count = world->dynamic_count,
                     .selective = pl_world_is_selective(world),
                     .found = broad->found.data,
                     .capacity = (uint32_t)(broad->found.size / sizeof(pl_found)) };
}

// Debris that passes through debris, a net in one group: no box need be compared.
static void judge_crowds(const plumb_world *world, bool *meet, bool *grounded)
{
    crowd moving;
    *meet = world->filtered_pieces == 0 || moving_crowd(world, &moving);
    *grounded = *meet || meets_fixed(world, &moving);
}

bool pl_pairs_find(plumb_world *world)
{
    pl_broad *broad = &world->broad;
    finder f = make_finder(world);
    bool meet, grounded;
    broad->sensed_count = 0;
    judge_crowds(world, &meet, &grounded);
    for (uint32_t k = 0; meet && k < broad->moving.level_count; ++k) {
        if (!find_in_level(&f, &broad->moving, &broad->moving.levels[k]) ||
            !find_across_levels(&f, &broad->moving, k)) {
            return false;
        }
    }
    if (grounded && !find_against_fixed(&f, &broad->moving, &broad->fixed)) {
        return false;
    }
    if (!find_sensed_resting(&f, &broad->moving, &broad->resting)) {
        return false;
    }
    if (pl_is_wrapped(world) && !find_over_edges(&f, meet, grounded)) {
        return false;
    }
    broad->found_count = f.count;
    return !f.out_of_memory;
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
    pl_broad *broad = &world->broad;
    const pl_grid *moving = &broad->moving;
    finder f = make_finder(world);
    bool meet, grounded;
    f.left = broad->left_marks.data;
    forget_sensed(broad);
    judge_crowds(world, &meet, &grounded);
    const bool senses = world->sensor_pieces > 0 && broad->resting.entry_count > 0;
    for (uint32_t i = 0; i < broad->left_count; ++i) {
        uint32_t piece = ((const uint32_t *)broad->left.data)[i];
        pl_grid_entry e = { .piece = piece, .box = world->pieces.fat[piece] };
        f.piece = piece;
        for (uint32_t k = 0; meet && k < moving->level_count; ++k) {
            if (!find_about(&f, moving, &moving->levels[k], &e)) {
                return false;
            }
        }
        if ((grounded && !pl_grid_query(&broad->fixed, e.box, add_visited, &f)) ||
            (senses && !pl_grid_query(&broad->resting, e.box, add_resting, &f))) {
            return false;
        }
        if (pl_is_wrapped(world) && !find_over_edges_about(&f, &e, meet, grounded)) {
            return false;
        }
    }
    broad->found_count = f.count;
    return !f.out_of_memory;
}
