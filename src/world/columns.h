// columns.h - the built-in tables of a world: one X-macro list a table, from which the struct, the
// column descriptors, growth, row moves and clearing follow, snapshots, and what their images are checked for.
//
//     X(type, name, rule)    rule: what numbers an image may have there, see snapshot/rules.h
//
// What users set are rows of src/schema. Adding a column is one row, here or there.
#ifndef PL_COLUMNS_H
#define PL_COLUMNS_H

#include "core/near.h"
#include "core/table.h"
#include "plumb/body.h"
#include "plumb/material.h"
#include "plumb/shape.h"

#include "schema/body.h"
#include "schema/material.h"

typedef plumb_real real;

// What saves looking anew and decides nothing: not part of a world's hash.
typedef struct pl_hint {
    bool is;
} pl_hint;

// Body rows. Rows are dense and partitioned: [awake dynamic | kinematic | asleep | static].
// clang-format off
#define PL_BODY_COLUMNS(X)                                                                          \
    X(plumb_body, entity, ANY) /* owner */                                                          \
    X(real, x, ANY) X(real, y, ANY) /* [m] origin of the body's frame, derived from the centre */   \
    X(real, center_x, ANY) X(real, center_y, ANY) /* [m] centre of mass: what the solver integrates */ \
    X(real, c, ANY) X(real, s, ANY) /* rotation */                                                  \
    X(real, vx, GUARDED) X(real, vy, GUARDED) /* [m/s] */                                           \
    X(real, w, GUARDED) /* [rad/s] */                                                               \
    X(real, residual_x, ANY) X(real, residual_y, ANY) /* [m] what rounding took from the centre: carried to the next step */ \
    X(real, residual_vx, ANY) X(real, residual_vy, ANY) /* [m/s] the same of the velocity, in free flight */ \
    X(real, fx, GUARDED) X(real, fy, GUARDED) /* [N] for the next step */                           \
    X(real, torque, GUARDED) /* [N m] for the next step */                                          \
    X(real, inv_mass, POSITIVE) /* [1/kg] 0: immovable */                                           \
    X(real, inv_inertia, POSITIVE) /* [1/(kg m^2)] 0: does not turn */                              \
    X(real, local_x, ANY) X(real, local_y, ANY) /* [m] centre of mass in the body's frame */        \
    PL_BODY_ROWS(PL_ROW_COLUMN, X)                                                                 \
    X(real, mass, POSITIVE) X(real, inertia, POSITIVE) /* [kg], [kg m^2]; kept also where the inverses are 0 */ \
    X(real, set_mass, POSITIVE) X(real, set_inertia, POSITIVE) /* given by the user; 0: from the shapes */ \
    X(real, extent, POSITIVE) /* [m] farthest point of a solid shape from the centre of mass; at least the radius of gyration */ \
    X(real, slack, ANY) /* [m] motion in a step that lets it pass nothing: see extent.c */          \
    X(void *, user_data, ANY)                                                                       \
    X(uint32_t, first_piece, OR_NONE(PIECES)) /* pieces of the body, newest shape first; PL_NONE ends */ \
    X(uint32_t, first_joint, OR_NONE(JOINTS)) /* joints of the body, newest first; PL_NONE ends */  \
    X(uint32_t, character, ONE_MORE(CHARACTERS)) /* 1 + its place among the characters; 0: none */  \
    X(real, rest_time, ANY) /* [s] of rest since the last sample of its pose (src/sleep) */         \
    X(real, rest_x, ANY) X(real, rest_y, ANY) /* [m] its centre in that sample */                   \
    X(real, rest_c, ANY) X(real, rest_s, ANY) /* its rotation then */                               \
    X(real, rest_dx, ANY) X(real, rest_dy, ANY) /* [m] between the last two samples */              \
    X(real, rest_turn, ANY) /* [rad] the same */                                                    \
    X(real, rest_fx, ANY) X(real, rest_fy, ANY) /* [N] on it at the last one; what it sleeps under */ \
    X(real, rest_torque, ANY) /* [N m] the same */                                                  \
    X(uint8_t, rest_samples, UP_TO(2)) /* in this rest, up to 2 */                                  \
    X(uint32_t, island, OR_NONE(ISLANDS)) /* of a sleeping body; PL_NONE: awake */                  \
    X(uint32_t, next_asleep, ANY) X(uint32_t, previous_asleep, ANY) /* registry slots: bodies of the island */ \
    X(uint32_t, changed_step, ANY) /* step count + 1 when an immovable body was last changed */     \
    X(uint32_t, settings, ONE_MORE(SETTINGS)) /* 1 + its record in world->settings; 0: none */      \
    X(pl_hint, stirring, ANY) /* kinematic: it moves, or was changed, and wakes what it touches */  \
    X(uint8_t, type, UP_TO(PLUMB_STATIC)) /* plumb_body_type */                                     \
    X(uint16_t, flags, ANY) /* PL_BODY_...; of images see check_rows.c */

#define PL_BODY_FIXED_ROTATION 1u
#define PL_BODY_DROPPING       2u // it asks to drop through one-way shapes in the next step
#define PL_BODY_UNTOLD         4u   // who pushes it leaves sleeping rows alone (world/push.c)
#define PL_BODY_NEW_SLEEPER    64u  // pushed as it fell asleep, in the step before
#define PL_BODY_NO_SLEEP       32u  // it never falls asleep
#define PL_BODY_RECRUITED      8u   // on its way into the list of movers; only within the continuous pass
#define PL_BODY_CONTINUOUS     16u  // never passes through moving bodies either
#define PL_BODY_LOCK_X         0x100u // never moves along x: infinite mass that way
#define PL_BODY_LOCK_Y         0x200u
#define PL_BODY_HAS_SETTINGS   0x400u // has a record in world->settings
#define PL_BODY_DISABLED       0x800u // out of the simulation
#define PL_BODY_TARGETED       0x1000u // has a record in world->targets
#define PL_BODY_OWN_CENTER     0x2000u // its centre of mass was given, not taken from the shapes
#define PL_BODY_LOST           0x4000u // the step has no finite end for it; only within the step
#define PL_BODY_TURNED         0x8000u // it slept when the step was first tried and is awake now, or the other way; only within the step
#define PL_BODY_WITHIN_STEP    (PL_BODY_LOST | PL_BODY_TURNED)
#define PL_BODY_LOCKED         (PL_BODY_LOCK_X | PL_BODY_LOCK_Y)
#define PL_BODY_HAS_EFFECTS    (PL_BODY_LOCKED | PL_BODY_HAS_SETTINGS) // does not move as the rest do
#define PL_BODY_EXCLUDING      128u // it is in the table of excluded pairs, or was once

// Pieces: the convex parts of shapes, what the broad and narrow phase see. Slots are stable for the
// life of the shape (contacts and grids name them); free slots have kind PL_PIECE_FREE.
#define PL_PIECE_COLUMNS(X)                                                                         \
    X(plumb_shape, shape, ANY) /* the shape it belongs to */                                        \
    X(uint8_t, kind, UP_TO(PL_PIECE_KIND_COUNT - 1)) /* pl_piece_kind: which narrow-phase kernel */ \
    X(uint8_t, shape_kind, UP_TO(PLUMB_SHAPE_KINDS - 1)) /* plumb_shape_kind */                     \
    X(uint8_t, vertex_count, UP_TO(16)) /* corners in the vertex pool; 0 for circles */             \
    X(uint8_t, vertex_class, UP_TO(PL_VERTEX_CLASSES - 1)) /* size class of its run in the pool */  \
    X(uint32_t, vertices, ANY) /* first corner in the vertex pool */                                \
    X(uint32_t, cuts, ANY) /* bit k: edge k is an inner cut */                                      \
    X(uint32_t, internal_corners, ANY) /* PL_EDGE_...: corners that neighbours narrow (internal_edges/internal_edges.h) */ \
    X(uint32_t, internal_edges, ANY) /* PL_EDGE_...: edges that neighbours cover */                 \
    X(uint32_t, body, ANY) /* body row; follows the row when it moves */                            \
    X(uint32_t, next_in_body, OR_NONE(PIECES)) /* next piece of the body, PL_NONE ends */           \
    X(uint32_t, next_in_shape, OR_NONE(PIECES)) /* next piece of the shape, PL_NONE ends; also the free list */ \
    X(uint32_t, material, ANY) /* material row */                                                   \
    X(uint64_t, category, ANY) X(uint64_t, mask, ANY) /* filter, resolved: mask 0 meets nothing */  \
    X(int32_t, group, ANY)                                                                          \
    X(uint8_t, flags, ANY) /* PL_PIECE_... */                                                        \
    X(real, friction, POSITIVE) X(real, restitution, POSITIVE) /* copied from the material */       \
    X(real, one_way_x, ANY) X(real, one_way_y, ANY) /* unit, in the body's frame; 0: solid from all sides */ \
    X(real, one_way_cos, ANY) X(real, one_way_angle, ANY) /* of normals that hold, about the direction */ \
    X(real, density, POSITIVE) /* [kg/m^2] in force; 0 for lines */                                 \
    X(real, own_density, POSITIVE) /* [kg/m^2] given with the shape; 0: the material's */           \
    X(plumb_mass_properties, area, ANY) /* the whole shape at density 1, on its first piece; else 0 */ \
    X(uint32_t, serial, ANY) /* world->serial when the slot was taken: tells reused slots */        \
    X(void *, user_data, ANY)                                                                       \
    X(pl_core, core, ANY) /* geometry in the body's frame, one gatherable record */                 \
    X(pl_box, fat, ANY) /* [m] fat box in the grid */                                               \
    X(uint32_t, moving, ANY) /* place in the list of moving or resting pieces; PL_NONE: static; PL_OUT */ \
    X(uint32_t, first_sleeping, OR_NONE(SLEEPING)) /* sleeping contacts with this static or kinematic piece */

#define PL_MATERIAL_COLUMNS(X)                                                                      \
    X(plumb_material, entity, ANY)                                                                  \
    PL_MATERIAL_ROWS(PL_ROW_COLUMN, X)                                                              \
    X(uint32_t, pairs, ANY) /* entries of the pair table that name it */                            \
    X(uint32_t, users, ANY) /* pieces that name it */
// clang-format on

#define PL_PIECE_SENSOR   1u   // of a sensor
#define PL_PIECE_PART     2u   // of a shape of several pieces
#define PL_PIECE_FILTERED 4u   // its filter is not {0}
#define PL_PIECE_ONE_WAY  32u  // it holds on one side only
#define PL_PIECE_ASLEEP   8u   // of a sleeping body: it is in the list and grid of resting pieces
#define PL_PIECE_PLACED   16u  // static, and new to what sleeps here
#define PL_PIECE_WAVES    64u  // of water whose surface has waves
#define PL_PIECE_CHANGED  128u // static, and changed in itself since the last step that looked

#define PL_NONE UINT32_MAX
#define PL_OUT  (UINT32_MAX - 1) // pieces.moving: of a disabled body, in no grid

// [m], [m/s], [rad/s] beyond this a body counts as lost: squares still fit a float.
#define PL_LARGEST ((real)1e12)

typedef enum pl_piece_kind {
    PL_PIECE_FREE,
    PL_PIECE_CIRCLE, // core: centre, radius
    PL_PIECE_CAPSULE, // core: centre, direction (c, s), half length hx, radius; segments have radius 0
    PL_PIECE_BOX,     // core: centre, rotation, half extents; no rounding; also in the vertex pool
    PL_PIECE_POLYGON, // corners in the vertex pool; core: centre of the box around it, radius
    PL_PIECE_KIND_COUNT
} pl_piece_kind;

// Geometry of a piece in the frame of the body's origin: eight reals, gathered by the kernels as one
// row. hx, hy are half extents (box), half length and 0 (capsule), half box (polygon).
typedef struct pl_core {
    real x, y;   // [m] centre
    real c, s;   // rotation of the piece's own frame
    real hx, hy; // [m]
    real radius; // [m] rounding, or the radius of a circle
    real reach;  // [m] farthest point from the body's origin
} pl_core;

typedef struct pl_box {
    real min_x, min_y, max_x, max_y; // [m]
} pl_box;

// A corner and the outward normal of the edge that starts there.
typedef struct pl_vertex {
    real x, y;   // [m] in the body's frame
    real nx, ny; // unit
} pl_vertex;

#define PL_DECLARE_COLUMN(type, name, ...) type *name;

typedef struct pl_bodies {
    pl_table table;
    PL_BODY_COLUMNS(PL_DECLARE_COLUMN)
} pl_bodies;

typedef struct pl_pieces {
    pl_table table; // count: slots ever used (high water), free ones included
    PL_PIECE_COLUMNS(PL_DECLARE_COLUMN)
    uint32_t free_head; // PL_NONE: none
    uint32_t live;      // pieces in use
} pl_pieces;

typedef struct pl_materials {
    pl_table table; // row 0 is the default material
    PL_MATERIAL_COLUMNS(PL_DECLARE_COLUMN)
} pl_materials;

#undef PL_DECLARE_COLUMN

// Descriptors made from the lists (columns.c).
extern const pl_column pl_body_columns[];
extern const size_t pl_body_column_count;
extern const pl_column pl_piece_columns[];
extern const size_t pl_piece_column_count;
extern const pl_column pl_material_columns[];
extern const size_t pl_material_column_count;

#endif
