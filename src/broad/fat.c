// fat.c - fat boxes of pieces, and whether the pair list still covers all that may touch.
//
// Reads: poses, piece geometry, velocities. Writes: fat boxes, which pieces left theirs. Order: first of the broad phase.
// Cost: O(moving pieces); O(all pieces) when static ones changed.
#include "broad/fat.h"

#include "broad/pairs.h"
#include "world/body_settings.h"
#include "world/rows.h"
#include "world/waves_list.h"
#include "world/wrap.h"

// When more than one in so many moving pieces has left its box, the pair list is made from nothing.
#define MANY 2

pl_box pl_piece_filed_box(const plumb_world *world, uint32_t piece)
{
    pl_box box = pl_piece_tight_box(world, piece);
    return pl_is_wrapped(world) ? pl_wrap_box(world, box) : box;
}

static pl_box widened(pl_box box, real margin)
{
    return (pl_box){ box.min_x - margin, box.min_y - margin, box.max_x + margin,
                     box.max_y + margin };
}

// Stretches a box along a displacement.
static pl_box swept(pl_box box, real dx, real dy)
{
    box.min_x += dx < 0 ? dx : 0;
    box.max_x += dx > 0 ? dx : 0;
    box.min_y += dy < 0 ? dy : 0;
    box.max_y += dy > 0 ? dy : 0;
    return box;
}

// A speed that no step will accept must not make a box infinite either (see solver/finish.c).
static real bounded(real v)
{
    return v > PL_LARGEST ? PL_LARGEST : v < -PL_LARGEST ? -PL_LARGEST : v;
}

// Velocities may have been set, or written through a span, since the poses were made.
static void refresh_pose_velocities(plumb_world *world)
{
    const pl_bodies *b = &world->bodies;
    pl_pose *poses = pl_poses(world);
    for (uint32_t row = 0; row < world->dynamic_count + world->kinematic_count; ++row) {
        poses[row].vx = bounded(b->vx[row]);
        poses[row].vy = bounded(b->vy[row]);
    }
    if (world->settings.scaled > 0) {
        pl_settings_of_poses(world);
    }
}

// `way` [m]: how far it goes in a step.
static pl_box fattened(pl_box needed, const pl_box *tight, real way)
{
    real w = tight->max_x - tight->min_x;
    real h = tight->max_y - tight->min_y;
    real margin = PL_FAT_FRACTION * (w > h ? w : h);
    margin = margin < PL_FAT_LIMIT ? margin : PL_FAT_LIMIT;
    return widened(needed, way > margin ? margin / PL_FAT_FAST_SHARE : margin);
}

void pl_broad_forget_left(pl_broad *broad)
{
    const uint32_t *left = broad->left.data;
    uint8_t *marks = broad->left_marks.data;
    for (uint32_t i = 0; i < broad->left_count; ++i) {
        marks[left[i]] = 0;
    }
    broad->left_count = 0;
}

void pl_broad_mark_left(pl_broad *broad)
{
    const uint32_t *left = broad->left.data;
    uint8_t *marks = broad->left_marks.data;
    for (uint32_t i = 0; i < broad->left_count; ++i) {
        marks[left[i]] = PL_IN_LIST;
    }
}

static void list_left(plumb_world *world)
{
    pl_broad *broad = &world->broad;
    uint8_t *marks = broad->left_marks.data;
    const uint32_t *moving = pl_moving(world);
    for (uint32_t i = 0; i < world->moving_count; ++i) {
        if (marks[moving[i]] == PL_JUST_LEFT) {
            ((uint32_t *)broad->left.data)[broad->left_count++] = moving[i];
            marks[moving[i]] = PL_IN_LIST;
        }
    }
}

// A piece must meet its partner within the step in which they touch.
static pl_box needed_box(const plumb_world *world, uint32_t piece, const pl_box *tight, real dt)
{
    const pl_pose *pose = &pl_poses(world)[world->pieces.body[piece]];
    return swept(widened(*tight, PL_SPECULATIVE / 2), pose->vx * dt, pose->vy * dt);
}

// Fewer pieces than this are not worth a thread.
#define LEAST 256

typedef struct refreshment {
    plumb_world *world;
    real dt;
} refreshment;

// NULL where places are wider than lanes, or boxes have images.
static pl_fat_kernel *kernel_of(const plumb_world *world)
{
#if PLUMB_IS_FAR
    (void)world;
    return NULL;
#else
    return pl_is_wrapped(world)           ? NULL
           : world->desc.simd_width == 16 ? pl_fat_refresh_w16
           : world->desc.simd_width == 8  ? pl_fat_refresh_w8
                                          : pl_fat_refresh_w4;
#endif
}

// Returns how many of these have left their boxes.
static uint32_t refresh_some(void *context, uint32_t first, uint32_t count)
{
    const refreshment *r = context;
    const plumb_world *world = r->world;
    pl_fat_kernel *kernel = kernel_of(world);
    if (kernel != NULL) {
        return kernel(world, first, count, r->dt);
    }
    pl_box *fat = world->pieces.fat;
    uint8_t *marks = world->broad.left_marks.data;
    uint32_t left = 0;
    for (uint32_t i = first; i < first + count; ++i) {
        uint32_t piece = pl_moving(world)[i];
        pl_box tight = pl_piece_filed_box(world, piece);
        pl_box needed = needed_box(world, piece, &tight, r->dt);
        if (!pl_box_contains(&fat[piece], &needed)) {
            const pl_pose *pose = &pl_poses(world)[world->pieces.body[piece]];
            real way = (plumb_abs(pose->vx) + plumb_abs(pose->vy)) * r->dt;
            fat[piece] = fattened(needed, &tight, way);
            marks[piece] = marks[piece] == 0 ? PL_JUST_LEFT : marks[piece];
            ++left;
        }
    }
    return left;
}

void pl_broad_refresh_moving(plumb_world *world, real dt)
{
    refresh_pose_velocities(world);
    uint32_t left = pl_tasks_count(world->tasks, world->moving_count, LEAST, refresh_some,
                                   &(refreshment){ world, dt });
    if (left > 0) {
        list_left(world);
    }
    // Over an edge of a world that wraps around pairs are sought all at once.
    world->broad.emptied |= left > (pl_is_wrapped(world) ? 0 : world->moving_count / MANY);
    world->broad.unfiled |= left > 0;
}

void pl_broad_refresh_resting(plumb_world *world)
{
    for (uint32_t i = 0; i < world->sleep.resting_count; ++i) {
        uint32_t piece = pl_resting(&world->sleep)[i];
        pl_box tight = pl_piece_filed_box(world, piece);
        pl_box needed = widened(tight, PL_SPECULATIVE / 2);
        if (!pl_box_contains(&world->pieces.fat[piece], &needed)) {
            world->pieces.fat[piece] = fattened(needed, &tight, 0);
        }
    }
}

// Static pieces that were not here before may touch what sleeps.
static void note_placed(plumb_world *world, uint32_t piece)
{
    uint8_t *flags = &world->pieces.flags[piece];
    world->sleep.placed_pieces += (*flags & PL_PIECE_PLACED) == 0;
    *flags |= PL_PIECE_PLACED;
}

// Those that came or were moved (pl_piece_lose_box): the others are where they were.
void pl_broad_refresh_fixed(plumb_world *world)
{
    pl_pieces *pieces = &world->pieces;
    const bool asleep = world->asleep_count > 0;
    for (uint32_t piece = 0; piece < pieces->table.count; ++piece) {
        if (pieces->moving[piece] == PL_NONE && pieces->kind[piece] != PL_PIECE_FREE &&
            pl_piece_has_lost_box(pieces, piece)) {
            pl_box box = widened(pl_piece_filed_box(world, piece), PL_SPECULATIVE / 2);
            if ((pieces->flags[piece] & PL_PIECE_WAVES) != 0) {
                box = widened(box, pl_waves_reach(world, piece));
            }
            if (asleep) {
                note_placed(world, piece);
            }
            pieces->fat[piece] = box;
        }
    }
}
