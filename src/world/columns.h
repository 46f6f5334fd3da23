// columns.h - the built-in tables of a world: one X-macro list a table, from which the struct, the
// column descriptors, growth, row moves and clearing follow. Adding a column is one row here.
#ifndef PL_COLUMNS_H
#define PL_COLUMNS_H

#include "core/near.h"
#include "core/table.h"
#include "plumb/body.h"
#include "plumb/material.h"
#include "plumb/shape.h"

typedef plumb_real real;

// What saves looking anew and decides nothing: not part of a world's hash.
typedef struct pl_hint {
    bool is;
} pl_hint;

// Body rows. Rows are dense and partitioned: [awake dynamic | kinematic | asleep | static].
// clang-format off
#define PL_BODY_COLUMNS(X)                                                                          \
    X(plumb_body, entity)          /* owner */                                                      \
    X(real, x) X(real, y)          /* [m] origin of the body's frame, derived from the centre */    \
    X(real, center_x) X(real, center_y) /* [m] centre of mass: what the solver integrates */        \
    X(real, c) X(real, s)          /* rotation */                                                   \
    X(real, vx) X(real, vy)        /* [m/s] */                                                      \
    X(real, w)                     /* [rad/s] */                                                    \
    X(real, low_x) X(real, low_y)  /* [m] what rounding took from the centre: carried to the next step */ \
    X(real, low_vx) X(real, low_vy) /* [m/s] the same of the velocity, in free flight */            \
    X(real, fx) X(real, fy)        /* [N] for the next step */                                      \
    X(real, torque)                /* [N m] for the next step */                                    \
    X(real, inv_mass)              /* [1/kg] 0: immovable */                                        \
    X(real, inv_inertia)           /* [1/(kg m^2)] 0: does not turn */                              \
    X(real, local_x) X(real, local_y) /* [m] centre of mass in the body's frame */                  \
    X(real, gravity_scale)         /* [-] */                                                        \
    X(real, mass) X(real, inertia) /* [kg], [kg m^2]; kept also where the inverses are 0 */         \
    X(real, set_mass) X(real, set_inertia) /* given by the user; 0: from the shapes */              \
    X(real, extent)                /* [m] farthest point of a solid shape from the centre of mass; at least the radius of gyration */ \
    X(real, slack)                 /* [m] motion in a step that lets it pass nothing: see extent.c */ \
    X(void *, user_data)                                                                            \
    X(uint32_t, first_piece)       /* pieces of the body, newest shape first; PL_NONE ends */       \
    X(uint32_t, first_joint)       /* joints of the body, newest first; PL_NONE ends */             \
    X(uint32_t, character)         /* 1 + its place among the characters; 0: none */                \
    X(real, looked)                /* [s] of rest since the last look at where it is (src/sleep) */ \
    X(real, look_x) X(real, look_y) /* [m] its centre at that look */                               \
    X(real, look_c) X(real, look_s) /* its rotation then */                                         \
    X(real, way_x) X(real, way_y)  /* [m] between the last two looks */                             \
    X(real, way_turn)              /* [rad] the same */                                             \
    X(uint8_t, looks)              /* in this rest, up to 2 */                                      \
    X(uint32_t, island)            /* of a sleeping body; PL_NONE: awake */                         \
    X(uint32_t, next_asleep) X(uint32_t, previous_asleep) /* registry slots: bodies of the island */ \
    X(uint32_t, changed_step)      /* step count + 1 when an immovable body was last changed */     \
    X(uint32_t, tuning)            /* 1 + its record in world->tunings; 0: none */                  \
    X(pl_hint, stirring)           /* kinematic: it moves, or was changed, and wakes what it touches */ \
    X(uint8_t, type)               /* plumb_body_type */                                            \
    X(uint16_t, flags)             /* PL_BODY_... */

#define PL_BODY_FIXED_ROTATION 1u
#define PL_BODY_DROPPING       2u // it asks to drop through one-way shapes in the next step
#define PL_BODY_NO_SLEEP       32u  // it never falls asleep
#define PL_BODY_RECRUITED      8u   // on its way into the list of movers; only within the continuous pass
#define PL_BODY_CONTINUOUS     16u  // never passes through moving bodies either
#define PL_BODY_LOCK_X         0x100u // never moves along x: infinite mass that way
#define PL_BODY_LOCK_Y         0x200u
#define PL_BODY_TUNED          0x400u // has a record in world->tunings
#define PL_BODY_DISABLED       0x800u // out of the simulation
#define PL_BODY_TARGETED       0x1000u // has a record in world->targets
#define PL_BODY_OWN_CENTER     0x2000u // its centre of mass was given, not taken from the shapes
#define PL_BODY_LOST           0x4000u // the step has no finite end for it; only within the step
#define PL_BODY_LOCKED         (PL_BODY_LOCK_X | PL_BODY_LOCK_Y)
#define PL_BODY_ODD            (PL_BODY_LOCKED | PL_BODY_TUNED) // does not move as the rest do
#define PL_BODY_EXCLUDING      128u // it is in the table of excluded pairs, or was once

// Pieces: the convex parts of shapes, what the broad and narrow phase see. Slots are stable for the
// life of the shape (contacts and grids name them); free slots have kind PL_PIECE_FREE.
#define PL_PIECE_COLUMNS(X)                                                                         \
    X(plumb_shape, shape)          /* the shape it belongs to */                                    \
    X(uint8_t, kind)               /* pl_piece_kind: which narrow-phase kernel */                   \
    X(uint8_t, shape_kind)         /* plumb_shape_kind */                                           \
    X(uint8_t, vertex_count)       /* corners in the vertex pool; 0 for circles */                  \
    X(uint8_t, vertex_class)       /* size class of its run in the pool */                          \
    X(uint32_t, vertices)          /* first corner in the vertex pool */                            \
    X(uint32_t, seams)             /* bit k: edge k is an inner cut */                              \
    X(uint32_t, seam_corners)      /* PL_SEAM_...: corners that neighbours narrow (seams/seams.h) */ \
    X(uint32_t, seam_edges)        /* PL_SEAM_...: edges that neighbours cover */                   \
    X(uint32_t, body)              /* body row; follows the row when it moves */                    \
    X(uint32_t, next_in_body)      /* next piece of the body, PL_NONE ends */                       \
    X(uint32_t, next_in_shape)     /* next piece of the shape, PL_NONE ends; also the free list */  \
    X(uint32_t, material)          /* material row */                                               \
    X(uint64_t, category) X(uint64_t, mask) /* filter, resolved: mask 0 meets nothing */            \
    X(int32_t, group)                                                                               \
    X(uint8_t, flags)              /* PL_PIECE_... */                                               \
    X(real, friction) X(real, restitution) /* copied from the material */                           \
    X(real, one_way_x) X(real, one_way_y) /* unit, in the body's frame; 0: solid from all sides */  \
    X(real, one_way_cos) X(real, one_way_angle) /* of normals that hold, about the direction */     \
    X(real, density)               /* [kg/m^2] in force; 0 for lines */                             \
    X(real, own_density)           /* [kg/m^2] given with the shape; 0: the material's */           \
    X(plumb_mass_properties, area) /* the whole shape at density 1, on its first piece; else 0 */   \
    X(uint32_t, serial)            /* world->serial when the slot was taken: tells reused slots */  \
    X(void *, user_data)                                                                            \
    X(pl_core, core)               /* geometry in the body's frame, one gatherable record */        \
    X(pl_box, fat)                 /* [m] fat box in the grid */                                    \
    X(uint32_t, moving)            /* place in the list of moving or resting pieces; PL_NONE: static; PL_OUT */ \
    X(uint32_t, first_dormant)     /* sleeping contacts with this static or kinematic piece */

#define PL_MATERIAL_COLUMNS(X)                                                                      \
    X(plumb_material, entity)                                                                       \
    X(real, density) X(real, friction) X(real, restitution)                                         \
    X(real, rolling)               /* [m] */                                                        \
    X(real, surface_speed)         /* [m/s] */                                                      \
    X(real, adhesion)              /* [N] */                                                        \
    X(uint8_t, friction_mix) X(uint8_t, restitution_mix) /* plumb_mix */                            \
    X(uint8_t, adhesion_mix)                                                                        \
    X(uint32_t, pairs)             /* entries of the pair table that name it */                     \
    X(uint32_t, users)             /* pieces that name it */
// clang-format on

#define PL_PIECE_SENSOR   1u  // of a sensor
#define PL_PIECE_PART     2u  // of a shape of several pieces
#define PL_PIECE_FILTERED 4u  // its filter is not {0}
#define PL_PIECE_ONE_WAY  32u // it holds on one side only
#define PL_PIECE_ASLEEP   8u  // of a sleeping body: it is in the list and grid of resting pieces
#define PL_PIECE_PLACED   16u // static, and new to what sleeps here

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

#define PL_DECLARE_COLUMN(type, name) type *name;

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
