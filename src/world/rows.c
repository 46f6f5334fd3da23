// rows.c - body rows: opened and closed in their partitions, looked up, brought in line with their
// pose.
//
// Rows lie as [awake dynamic | kinematic | asleep | static]. To open or close a row in one
// partition, each partition behind it gives its first row to its end, or its last to its beginning:
// no more than one row a boundary moves, and no gap ever exists. Where a row goes is told to the
// registry, to the `body` column of the body's pieces, and to the poses.
//
// Reads, writes: body table, registry rows, pieces.body, poses. Cost: O(1) + pieces of the rows
// moved.
#include "world/rows.h"

#include "world/body_settings.h"
#include "world/filter.h"
#include "world/material_pair.h"
#include "world/wrap.h"

//---- lookup --------------------------------------------------------------------------------------

static uint32_t row_of(const plumb_world *world, plumb_entity entity, plumb_entity_kind kind)
{
    if (world == NULL) {
        return PL_NONE;
    }
    const pl_slot *slot = pl_registry_find(&world->registry, entity);
    return slot != NULL && slot->kind == (uint32_t)kind ? slot->row : PL_NONE;
}

uint32_t pl_body_row(const plumb_world *world, plumb_body body)
{
    return row_of(world, body.entity, PLUMB_KIND_BODY);
}

uint32_t pl_shape_piece(const plumb_world *world, plumb_shape shape)
{
    return row_of(world, shape.entity, PLUMB_KIND_SHAPE);
}

uint32_t pl_material_row(const plumb_world *world, plumb_material material)
{
    return row_of(world, material.entity, PLUMB_KIND_MATERIAL);
}

//---- partitions ----------------------------------------------------------------------------------

uint32_t pl_partition_first(const plumb_world *world, pl_partition partition)
{
    const uint32_t sizes[] = { world->dynamic_count, world->kinematic_count, world->asleep_count };
    if (partition >= PL_PART_DISABLED) {
        return world->bodies.table.count -
               (partition == PL_PART_DISABLED ? world->disabled_count : 0);
    }
    uint32_t first = 0;
    for (int p = 0; p < (int)partition; ++p) {
        first += sizes[p];
    }
    return first;
}

// The count of a partition; static rows are what is left and need none.
static void count_row(plumb_world *world, pl_partition partition, bool opened)
{
    uint32_t *counts[] = { &world->dynamic_count, &world->kinematic_count, &world->asleep_count,
                           NULL, &world->disabled_count };
    world->bodies.table.count += opened ? 1u : UINT32_MAX;
    if (partition != PL_PART_STATIC) {
        *counts[partition] += opened ? 1u : UINT32_MAX;
    }
}

// Tells everyone where the body of a row is now.
static void announce_row(plumb_world *world, uint32_t row)
{
    const pl_bodies *bodies = &world->bodies;
    pl_registry_move(&world->registry, bodies->entity[row].entity.index, row);
    for (uint32_t p = bodies->first_piece[row]; p != PL_NONE; p = world->pieces.next_in_body[p]) {
        world->pieces.body[p] = row;
    }
}

static void move_row(plumb_world *world, uint32_t from, uint32_t to)
{
    if (from == to) {
        return;
    }
    pl_bodies *bodies = &world->bodies;
    pl_table_copy(&bodies->table, pl_body_columns, pl_body_column_count, from, to);
    pl_poses(world)[to] = pl_poses(world)[from];
    announce_row(world, to);
    world->rows_moved = true;
}

static void swap_rows(plumb_world *world, uint32_t a, uint32_t b)
{
    if (a == b) {
        return;
    }
    pl_table_swap(&world->bodies.table, pl_body_columns, pl_body_column_count, a, b);
    pl_pose *poses = pl_poses(world), kept = poses[a];
    poses[a] = poses[b];
    poses[b] = kept;
    announce_row(world, a);
    announce_row(world, b);
    world->rows_moved = true;
}

// Each partition on the way gives its last row for the first, or the reverse.
uint32_t pl_row_to_asleep(plumb_world *world, uint32_t row)
{
    swap_rows(world, row, world->dynamic_count - 1);
    uint32_t to = world->dynamic_count + world->kinematic_count - 1;
    swap_rows(world, world->dynamic_count - 1, to);
    --world->dynamic_count;
    ++world->asleep_count;
    world->schedule_dirty = true;
    return to;
}

uint32_t pl_row_to_awake(plumb_world *world, uint32_t row)
{
    uint32_t first = world->dynamic_count + world->kinematic_count;
    swap_rows(world, row, first);
    swap_rows(world, first, world->dynamic_count);
    --world->asleep_count;
    world->schedule_dirty = true;
    return world->dynamic_count++;
}

// One more than asked for: pl_row_transfer carries a row there.
bool pl_rows_reserve(plumb_world *world, uint32_t extra)
{
    uint32_t count = world->bodies.table.count + 1;
    return extra < PL_NONE - count &&
           pl_table_reserve(&world->memory, &world->bodies.table, pl_body_columns,
                            pl_body_column_count, count + extra) &&
           pl_buffer_reserve(&world->memory, &world->poses,
                             ((size_t)count + extra) * sizeof(pl_pose));
}

// Makes a hole at the end of a partition.
static uint32_t open_hole(plumb_world *world, pl_partition partition)
{
    uint32_t hole = world->bodies.table.count;
    for (int p = PL_PART_COUNT - 1; p > (int)partition; --p) {
        uint32_t first = pl_partition_first(world, (pl_partition)p);
        move_row(world, first, hole);
        hole = first;
    }
    count_row(world, partition, true);
    return hole;
}

uint32_t pl_row_open(plumb_world *world, pl_partition partition)
{
    uint32_t hole = open_hole(world, partition);
    pl_table_clear(&world->bodies.table, pl_body_columns, pl_body_column_count, hole);
    pl_poses(world)[hole] = (pl_pose){ 0 };
    world->bodies.first_piece[hole] = PL_NONE;
    world->bodies.first_joint[hole] = PL_NONE;
    world->bodies.island[hole] = PL_NONE;
    world->bodies.rest_time[hole] = PL_NOT_RESTING;
    world->schedule_dirty = true;
    return hole;
}

pl_partition pl_row_partition(const plumb_world *world, uint32_t row)
{
    int partition = PL_PART_AWAKE;
    while (row >= pl_partition_first(world, (pl_partition)(partition + 1))) {
        ++partition;
    }
    return (pl_partition)partition;
}

// Fills the hole that `row` is; its content must be elsewhere.
static void close_hole(plumb_world *world, uint32_t row)
{
    pl_partition partition = pl_row_partition(world, row);
    uint32_t hole = row;
    for (int p = (int)partition; p < PL_PART_COUNT; ++p) {
        uint32_t end = pl_partition_first(world, (pl_partition)(p + 1));
        if (end > pl_partition_first(world, (pl_partition)p)) {
            move_row(world, end - 1, hole);
            hole = end - 1;
        }
    }
    count_row(world, partition, false);
    world->schedule_dirty = true;
}

void pl_row_close(plumb_world *world, uint32_t row)
{
    if (world->bodies.inv_inertia[row] > 0) {
        --world->turning_bodies;
    }
    world->continuous_bodies -= (world->bodies.flags[row] & PL_BODY_CONTINUOUS) != 0;
    pl_body_forget(world, row);
    close_hole(world, row);
}

// The row waits behind the last one meanwhile, where pl_rows_reserve has left room.
uint32_t pl_row_transfer(plumb_world *world, uint32_t row, pl_partition partition)
{
    uint32_t aside = world->bodies.table.count;
    move_row(world, row, aside);
    close_hole(world, row);
    uint32_t to = open_hole(world, partition);
    move_row(world, aside, to);
    return to;
}

//---- poses ---------------------------------------------------------------------------------------

static void write_pose(plumb_world *world, uint32_t row, real dx, real dy)
{
    const pl_bodies *b = &world->bodies;
    pl_poses(world)[row] = (pl_pose)
    {
        b->x[row], b->y[row], b->c[row], b->s[row], dx, dy, b->vx[row], b->vy[row],
#if PLUMB_IS_FAR
            (b->center_x[row] - b->x[row] - dx) + b->residual_x[row],
            (b->center_y[row] - b->y[row] - dy) + b->residual_y[row]
#endif
    };
}

void pl_body_update_pose(plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    write_pose(world, row, b->c[row] * b->local_x[row] - b->s[row] * b->local_y[row],
               b->s[row] * b->local_x[row] + b->c[row] * b->local_y[row]);
}

void pl_body_update_origin(plumb_world *world, uint32_t row)
{
    pl_bodies *b = &world->bodies;
    real dx = b->c[row] * b->local_x[row] - b->s[row] * b->local_y[row];
    real dy = b->s[row] * b->local_x[row] + b->c[row] * b->local_y[row];
    b->x[row] = b->center_x[row] - dx;
    b->y[row] = b->center_y[row] - dy;
    write_pose(world, row, dx, dy);
}

void pl_body_update_center(plumb_world *world, uint32_t row)
{
    pl_bodies *b = &world->bodies;
    real dx = b->c[row] * b->local_x[row] - b->s[row] * b->local_y[row];
    real dy = b->s[row] * b->local_x[row] + b->c[row] * b->local_y[row];
    b->center_x[row] = b->x[row] + dx;
    b->center_y[row] = b->y[row] + dy;
    b->residual_x[row] = b->residual_y[row] = 0;
    write_pose(world, row, dx, dy);
    pl_pieces_stray(world, row);
    if (pl_is_wrapped(world)) {
        pl_wrap_row(world, row);
    }
}

plumb_entity pl_entity_claim(plumb_world *world, plumb_entity reserved, plumb_entity_kind kind,
                             uint32_t row)
{
    if (plumb_is_null(reserved)) {
        return pl_registry_acquire(&world->registry, (uint32_t)kind, row, PL_SLOT_LIVE);
    }
    pl_slot *slot = &world->registry.slots[reserved.index];
    slot->kind = (uint32_t)kind;
    slot->row = row;
    slot->state = PL_SLOT_LIVE;
    return reserved;
}
