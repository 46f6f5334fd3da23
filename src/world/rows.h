// rows.h - the storage of bodies and shapes, below the API: rows, pieces, corners, mass. Nothing
// here checks handles; whatever can fail is reserved first and committed afterwards.
#ifndef PL_ROWS_H
#define PL_ROWS_H

#include "world/state.h"

//---- body rows (rows.c) --------------------------------------------------------------------------

// Partitions in the order in which they lie in the table.
typedef enum pl_partition {
    PL_PART_AWAKE,
    PL_PART_KINEMATIC,
    PL_PART_ASLEEP,
    PL_PART_STATIC,
    PL_PART_DISABLED, // of any type
    PL_PART_COUNT
} pl_partition;

static inline pl_partition pl_partition_of(plumb_body_type type)
{
    return type == PLUMB_DYNAMIC     ? PL_PART_AWAKE
           : type == PLUMB_KINEMATIC ? PL_PART_KINEMATIC
                                     : PL_PART_STATIC;
}

// First row of a partition; PL_PART_COUNT: one past the last row.
uint32_t pl_partition_first(const plumb_world *world, pl_partition partition);

bool pl_rows_reserve(plumb_world *world, uint32_t extra);
// Opens a zeroed row at the end of a partition (room must be reserved); at most one row of each
// later partition moves.
uint32_t pl_row_open(plumb_world *world, pl_partition partition);
// Moves a row to another partition; at most one row of each partition from one to the other moves
// along. Needs no memory. Returns the new row.
uint32_t pl_row_transfer(plumb_world *world, uint32_t row, pl_partition partition);
// The partition in which a row lies.
pl_partition pl_row_partition(const plumb_world *world, uint32_t row);

// Moves a row from the awake partition to the front of the sleeping one, and from there to the end of
// the awake one; at most one row of each partition between moves. Returns where it is now.
uint32_t pl_row_to_asleep(plumb_world *world, uint32_t row);
uint32_t pl_row_to_awake(plumb_world *world, uint32_t row);

static inline bool pl_row_is_asleep(const plumb_world *world, uint32_t row)
{
    return row - (world->dynamic_count + world->kinematic_count) < world->asleep_count;
}

// The same, as it was when the step was first tried: what passes before the waking one ask (sleep/retry.c).
static inline bool pl_row_slept(const plumb_world *world, uint32_t row)
{
    return pl_row_is_asleep(world, row) != ((world->bodies.flags[row] & PL_BODY_TURNED) != 0);
}

//---- vertex pool (pool.c) ------------------------------------------------------------------------

// Size class of a run of `count` corners, 1..16, and the corners that a class holds.
uint8_t pl_pool_class(int count);
uint32_t pl_pool_run(uint8_t vertex_class);
// Makes room for `corners` corners in runs.
bool pl_pool_reserve(pl_memory *memory, pl_vertex_pool *pool, uint32_t corners);
uint32_t pl_pool_take(pl_vertex_pool *pool, uint8_t vertex_class);
void pl_pool_give(pl_vertex_pool *pool, uint8_t vertex_class, uint32_t first);
void pl_pool_init(pl_vertex_pool *pool);
void pl_pool_free(pl_memory *memory, pl_vertex_pool *pool);

//---- pieces (piece.c) ----------------------------------------------------------------------------

// A piece as shape_make.c made it, in the frame of the body's origin.
typedef struct pl_made_piece {
    plumb_convex convex;
    pl_core core;
    uint32_t cuts;
    uint8_t kind; // pl_piece_kind
} pl_made_piece;

// All of a shape; the pieces lie in world->made.
typedef struct pl_made {
    uint32_t count;
    uint32_t corners;           // vertex pool corners that the pieces need
    plumb_mass_properties area; // at density 1
} pl_made;

bool pl_pieces_reserve(plumb_world *world, uint32_t extra);
// Stores the pieces in world->made as the newest shape of a body row (room must be reserved) and
// returns the first. Sets shape, kind, geometry, lists and flags; material and density are the
// caller's.
uint32_t pl_pieces_add(plumb_world *world, uint32_t row, plumb_shape shape, const pl_made *made);
// Takes the pieces of a body out of the grid they are in and files them where its type and its
// being enabled want them. Needs no memory.
void pl_pieces_refile(plumb_world *world, uint32_t row);
// Of a body that was moved between steps: queries look for its pieces where they are now.
void pl_pieces_stray(plumb_world *world, uint32_t row);
// Puts the pieces of a shape behind those of another in the list of their body: shapes are told in the order of that list.
void pl_pieces_move_behind(plumb_world *world, uint32_t first, uint32_t other);
// Removes the pieces of a shape, and its share of the material's users.
void pl_pieces_remove(plumb_world *world, uint32_t first);
// Moves a piece from the list of moving ones to that of resting ones, and back.
void pl_piece_rest(plumb_world *world, uint32_t piece);
// Empties its fat box: whatever its place is, it has left the box. Of static pieces only those get one anew.
void pl_piece_lose_box(plumb_world *world, uint32_t piece);
bool pl_piece_has_lost_box(const pl_pieces *pieces, uint32_t piece);
void pl_piece_move(plumb_world *world, uint32_t piece);

//---- mass (mass.c) -------------------------------------------------------------------------------

typedef struct pl_mass_sum {
    double mass, x, y; // [kg], [m] centre in the body's frame
    double inertia;    // [kg m^2] about the centre
} pl_mass_sum;

typedef struct pl_body_mass {
    real mass, inertia;
    real x, y; // [m] centre in the body's frame
} pl_body_mass;

// [kg/m^2] in force for a piece: its own or its material's; a sensor has none.
real pl_density_of(const plumb_world *world, uint32_t piece);
// The shapes of a body at the densities in force, and one more.
pl_mass_sum pl_mass_of_shapes(const plumb_world *world, uint32_t row);
void pl_mass_add(pl_mass_sum *sum, plumb_mass_properties area, real density);
// The same about another centre.
void pl_mass_recenter(pl_mass_sum *sum, real x, real y);
// What the body gets; false when mass or inertia leave their range (they are then clamped).
bool pl_mass_resolve(const pl_mass_sum *sum, real set_mass, real set_inertia, pl_body_mass *out);
// Gives a dynamic body its mass. The origin stays; the centre moves with it and keeps to the rigid
// motion: v' = v + w x (centre' - centre).
void pl_mass_apply(plumb_world *world, uint32_t row, const pl_body_mass *mass);
// All of that for a body whose shapes have changed; static and kinematic ones have no mass.
void pl_mass_revise(plumb_world *world, uint32_t row);

//---- size (extent.c) -----------------------------------------------------------------------------

// [m] half the least width of a piece, rounding included; 0 for segments. Inner cuts of an outline
// are no sides where `cuts` says so; without any side, PLUMB_REAL_MAX.
real pl_piece_half_width(const plumb_world *world, uint32_t piece, bool cuts);
// Extent and slack of a dynamic or kinematic body whose shapes or centre have changed.
void pl_extent_revise(plumb_world *world, uint32_t row);

//---- making shapes (shape_make.c) ----------------------------------------------------------------

// Checks a descriptor and makes its pieces in world->made. Errors: see plumb_shape_create.
plumb_result pl_shape_make(plumb_world *world, const char *function, const plumb_shape_desc *desc,
                           pl_made *made);

// Appends a piece, or a convex polygon with its inner edges, to a shape in world->made (room must be reserved).
void pl_made_add(plumb_world *world, pl_made *made, const pl_made_piece *piece);
void pl_made_add_polygon(plumb_world *world, pl_made *made, const plumb_convex *convex,
                         uint32_t cuts);

//---- API calls that commands share with the direct ones ------------------------------------------

// `reserved` null: a new handle; otherwise one that a command has reserved, which comes alive.
// Writes a checked descriptor to a row of materials, defaults resolved.
void pl_material_fill(plumb_world *world, uint32_t row, const plumb_material_desc *desc);

plumb_entity pl_entity_claim(plumb_world *world, plumb_entity reserved, plumb_entity_kind kind,
                             uint32_t row);

// The descriptor was checked (pl_body_check, pl_shape_make). Errors: E_MEMORY, E_RANGE (mass).
plumb_result pl_body_check(const plumb_world *world, const char *function,
                           const plumb_body_desc *desc);
// What is added to a row: force and torque, or impulse and angular impulse (body_force.c).
typedef struct pl_push {
    plumb_vec2 linear;
    real angular;
} pl_push;

// Changes the velocity of a dynamic row by an impulse. E_NOT_FINITE: it would overflow; the first
// only asks whether.
plumb_result pl_impulse_check(const plumb_world *world, const char *function, uint32_t row,
                              pl_push push);
plumb_result pl_impulse_add(plumb_world *world, const char *function, uint32_t row, pl_push push);
plumb_result pl_body_insert(plumb_world *world, const char *function, const plumb_body_desc *desc,
                            plumb_body *body);
plumb_result pl_shape_insert(plumb_world *world, const char *function, uint32_t row,
                             const plumb_shape_desc *desc, const pl_made *made, plumb_shape *shape);
void pl_body_place(plumb_world *world, uint32_t row, plumb_vec2 position, plumb_real angle);
void pl_body_place_at(plumb_world *world, uint32_t row, plumb_vec2 position, plumb_rot q);
// The same for a body that is somewhere, asked for by the function of that name: one that is there already keeps its contacts
// and goes on.
void pl_body_move_to(plumb_world *world, const char *fn, uint32_t row, plumb_vec2 position,
                     plumb_real angle);
// Disables a body, at rest, also within a step. Rows move.
void pl_body_take_out(plumb_world *world, uint32_t row);
// Row, pieces and joints of a body whose type or flags have changed, to where they belong (relocate.c).
void pl_body_relocate(plumb_world *world, uint32_t row);
void pl_body_stand_still(plumb_world *world, uint32_t row);

plumb_result pl_place_check(const plumb_world *world, const char *function, plumb_vec2 position,
                            plumb_real angle);

// Closes a row; at most one row of its own and of each later partition moves.
void pl_row_close(plumb_world *world, uint32_t row);

#endif
