// liquid.h - the liquid as it is stored: particles are its state, the grid is scratch of a step.
#ifndef PL_TABLE_LIQUID_H
#define PL_TABLE_LIQUID_H

#include "core/memory.h"
#include "core/near.h"
#include "core/sort.h"
#include "plumb/liquid.h"

#define PL_LIQUID_SIDE 16                                // cells along a tile
#define PL_LIQUID_TILE (PL_LIQUID_SIDE * PL_LIQUID_SIDE) // cells of a tile

#define PL_LIQUID_LEVELS 16

// Of rows, 16 to a strip: see pressure.c, multigrid.c.
enum {
    PL_LIQUID_P, // the answer
    PL_LIQUID_R, // what is left
    PL_LIQUID_S, // where conjugate gradients go
    PL_LIQUID_Q,
    PL_LIQUID_Z,
    PL_LIQUID_D, // the matrix: diagonal, to the left, below, and the damped inverse of the diagonal
    PL_LIQUID_L,
    PL_LIQUID_B,
    PL_LIQUID_I,
    PL_LIQUID_VECTORS
};

// A particle as kernels have it, sorted by cells. Lengths in cells.
typedef struct pl_liquid_point {
    near_real fx, fy;         // 0..1, place in its cell
    near_real u, v;           // [m/s]
    near_real slope[4];         // [m/s] a cell, of u along x and y, of v
    uint32_t cell, index;     // index: among the particles
} pl_liquid_point;

// Columns of cells; of faces that of a cell's left side (u) and lower side (v). Cell 0 lies outside of all tiles: its
// neighbours are itself. Those of the first list begin as 0, the others are written before they are read.
// clang-format off
#define PL_LIQUID_ZEROED(X)                                                                          \
    X(uint32_t, first) /* of its points */                                                           \
    X(uint32_t, row) /* of the system of pressures; 0: air or solid */                               \
    X(uint32_t, room) /* that it is in (rooms.c) */                                                  \
    X(near_real, solid_u) X(near_real, solid_v) /* [m/s] closed part times the speed of what closes it */ \
    X(near_real, swell) /* [m/s] what soft bodies in it grow by, which is no flow */                \
    X(near_real, cover) /* 0..1 of it is solid */
#define PL_LIQUID_WRITTEN(X)                                                                         \
    X(uint32_t, left) X(uint32_t, right) X(uint32_t, down) X(uint32_t, up) /* neighbours */          \
    X(uint32_t, block) /* sums of its points; 0: it has none */                                      \
    X(near_real, u) X(near_real, v) /* [m/s] */                                                      \
    X(near_real, new_u) X(near_real, new_v) /* of a sweep; displacements [cells] */                  \
    X(near_real, open_u) X(near_real, open_v) /* 0..1 */                                             \
    X(near_real, density) /* of liquid round its centre, over that of rest; solid counts as full */  \
    X(near_real, solid) /* the solid's part in that */                                               \
    X(uint8_t, known_u) X(uint8_t, known_v) X(uint8_t, fresh_u) X(uint8_t, fresh_v) X(uint8_t, wet)
#define PL_LIQUID_COLUMNS(X) PL_LIQUID_ZEROED(X) PL_LIQUID_WRITTEN(X)
// clang-format on

// Where a particle is, in its own order.
typedef struct pl_liquid_spot {
    int32_t i, j;         // cell
    near_real fx, fy;     // 0..1 in it
    uint32_t cell, place; // place: among the sorted points. Until tiles are sorted, cell is the home
} pl_liquid_spot;

typedef struct pl_liquid_block pl_liquid_block; // transfer.c
typedef struct pl_liquid_blend pl_liquid_blend;

// What a phase is to the first; lengths in cells.
typedef struct pl_liquid_kind {
    near_real mass;   // density over that of the first
    near_real thick;  // viscosity over the largest
} pl_liquid_kind;

// Phases in a part of a step, if there are several. Columns of cells, as below.
typedef struct pl_liquid_mixture {
    pl_liquid_kind kinds[1 + PLUMB_LIQUID_MAX_PHASES];
    uint8_t *phases;              // of the sorted points
    pl_liquid_blend *blends;      // what blocks are to it
    near_real *light_u, *light_v; // density of the first over that of a face
    near_real *mass, *thick;      // round a cell's centre; mass 0: nothing is near
    double other;                 // densities that are less apart are one phase
    double drag;                  // [m^2/s] of what is as thick as the thickest, and as dense as the first
    double fall_x, fall_y;        // [m/s^2] gravity
} pl_liquid_mixture;

// Granular phases in a part of a step, if there are any (grains.c). Columns of cells, [m/s] as pressures are.
typedef struct pl_liquid_grains {
    double friction[1 + PLUMB_LIQUID_MAX_PHASES]; // of the phases
    plumb_particle *particles;                    // in their own order
    double unit;                                  // [Pa] of 1 m/s
    double least;                                 // [m/s] pressure that grains have at the surface: of half a cell
    near_real *normal, *tangent;                  // mean of what particles bear
    near_real *bound, *share;                     // mean friction; how many of them are grains
    near_real *pressure;
    near_real *trial; // shear stress that an elastic solid would bear
    near_real *yield; // 0..1, what of that grains bear
    near_real *kept; // 0..1, of what they bear more beside light bodies
    near_real *gain_normal, *gain_tangent; // what an elastic solid would bear more at the end of the part
} pl_liquid_grains;

typedef struct pl_liquid_tile {
    uint64_t key;
    int32_t x, y;         // in tiles
    uint32_t first_solid; // in the list of solids at tiles
    uint32_t solid_count;
} pl_liquid_tile;

// A tile with particles. Of a table of homes pl_liquid_tile is the place alone.
typedef struct pl_liquid_home {
    int32_t x, y;    // in tiles
    uint32_t points; // particles in it
    uint32_t around; // bits of the tiles that their surroundings reach into, from the lower left one to the upper right one
    uint32_t tile;   // of the grid
    bool lively;     // its particles are no strays
} pl_liquid_home;

// A body that the liquid pushes: its velocity is an unknown.
typedef struct pl_liquid_body {
    plumb_body body;
    double x, y, c, s;                 // [m] centre, rotation, at this time of the step
    double vx, vy, w;                  // [m/s], [rad/s]
    double seen[3];                    // that motion, as the faces that it closes have it
    double held[3];                    // [N], [N m] what held it in the last step, as far as it goes on
    bool known;                        // in the last step it was there
    double inv_mass_x, inv_mass_y;     // [1/kg] 0: it is locked
    double inv_inertia;                // [1/(kg m^2)]
    double impulse_x, impulse_y, turn; // [N s], [N m s] since the step began
    double sum[3];                     // of pressures, in one product with the matrix
    uint32_t first_rim, rim_count;     // rows beside it, in the grid's list (links.c)
    bool moves;                        // its velocity is unknown: else it is driven
    bool wet;                          // some cells beside it were full in this step
} pl_liquid_body;

// What held a body in the last two steps beside gravity, forces and the liquid: contacts, joints, whatever else moved it.
typedef struct pl_liquid_support {
    uint64_t key;              // of its entity
    double last[3], before[3]; // [N], [N m]
    uint64_t wet;              // PL_LIQUID_...: whether the liquid touched it in the last step
} pl_liquid_support;

enum { PL_LIQUID_DRY, PL_LIQUID_WET_BODY, PL_LIQUID_WET_SOFTBODY };

// Of all bodies that it knew in the last step.
typedef struct pl_liquid_supports {
    pl_buffer items; // pl_liquid_support, by key
    uint32_t count;
} pl_liquid_supports;

// A part of a face that a moving body closes.
typedef struct pl_liquid_link {
    uint32_t cell;  // whose left or lower face
    uint32_t body;  // place in the grid's list
    bool upright;   // the lower one
    near_real part; // 0..1
    near_real rest; // 0..1 that something else closes
    near_real arm;  // [m] about the body's centre: a turn of 1 rad/s moves it so fast along the normal
} pl_liquid_link;

// How a motion of a body fills a cell beside it: by 1 m/s to the right, up, by 1 rad/s; and 0.
typedef struct pl_liquid_rim {
    near_real by[4];
} pl_liquid_rim;

// A node of a soft body that the liquid pushes.
typedef struct pl_liquid_node {
    double x, y, vx, vy; // [m], [m/s] at this time of the step
    double gain[2];      // [m/s] that the step adds without the liquid
    double seen[2];      // that velocity, as the faces that it closes have it
    double impulse[2];   // [N s] since the step began
    double sum[2];       // of pressures, in one product with the matrix
    bool wet;            // as that of pl_liquid_body
} pl_liquid_node;

// Nodes of a ring, whose mean is the node behind them that its triangles meet in.
typedef struct pl_liquid_ring {
    uint32_t middle, first, count; // first: in the world's list of rings
    uint32_t node;                 // that its numbers are counted from
} pl_liquid_ring;

// A soft body near the liquid.
typedef struct pl_liquid_softbody {
    plumb_softbody entity;
    uint32_t first, count; // nodes
    uint32_t point;        // of the step of soft bodies, where its nodes begin
    double held[3];        // as that of pl_liquid_body
    double mass;           // [kg]
    double x, y, inertia;  // [m] centre of mass, [kg m^2]
    double spin;           // in the sums of its nodes
    bool turns;            // nothing holds it: it turns as one
} pl_liquid_softbody;

// A part of a face that a triangle of a soft body closes: it moves as its nodes do, by their shares.
typedef struct pl_liquid_soft_link {
    uint32_t cell;
    uint32_t nodes[3];
    bool upright;
    near_real part, rest; // as those of pl_liquid_link
    near_real shares[3], slopes[3]; // slopes: what these gain in half a cell across the face
} pl_liquid_soft_link;

// A face across which a grid goes on at its other side.
typedef struct pl_liquid_wrap {
    uint32_t a, b;  // rows
    near_real open; // 0..1
} pl_liquid_wrap;

// Cells that open faces join, and what is summed up of them.
typedef struct pl_liquid_room {
    double sum, gain; // gain: of those above 0
    uint32_t count;
    bool even; // its mean is taken out of pressures
} pl_liquid_room;

// A cell of such a room.
typedef struct pl_liquid_room_cell {
    uint32_t row, room;
} pl_liquid_room_cell;

// A convex piece near the liquid, in cells from the origin of the world.
typedef struct pl_liquid_solid {
    uint32_t piece, body; // body: of the list above; PL_NONE: static. piece: PL_NONE, it stays where it is
    int count;            // corners
    bool thin;            // so narrow that nothing says where in a cell it lies
    double width;         // [cells] across, at the narrowest
    bool soft;            // a triangle of a soft body
    uint32_t nodes[3];    // of that, at its corners
    uint32_t exits;       // bits of sides over which particles in it leave
    double radius;        // cells
    double x[16], y[16];  // cells, at this time of the step
    double nx[16], ny[16]; // outwards from the side behind each corner; 0: it has no length
    // The same drawn in by a film, but where it lies on its body's other pieces; of bodies that yield.
    double film_radius, film_x[16], film_y[16];
    uint32_t inner; // bits of sides that lie so
    double low_x, low_y, high_x, high_y;
} pl_liquid_solid;

// A line of 16 cells of a tile that has liquid; or of a coarser grid.
typedef struct pl_liquid_strip {
    int32_t x, y;      // [strips], [cells] of its grid
    uint32_t down, up; // strips below and above; 0: none
    uint32_t cell;     // its first, on the finest grid
    uint32_t finer[4]; // below at the left, at the right, above; 0: none
} pl_liquid_strip;

// A grid: strips from first to end.
typedef struct pl_liquid_level {
    uint32_t first, end;
} pl_liquid_level;

typedef struct pl_liquid_kernels pl_liquid_kernels; // liquid/liquid.h

// Scratch: cells, points and rows of one part of a step.
typedef struct pl_liquid_grid {
    near_real h; // [m] side of a cell
    void *hash;  // which tile lies where
    uint32_t slots;
    uint32_t tile_count, cell_count, point_count, body_count, solid_count, link_count;
    int32_t low_x, low_y, high_x, high_y; // tiles from low to high
    pl_liquid_tile *tiles;                // sorted by key
    pl_liquid_point *points;              // sorted by cell
    uint8_t *strays;                      // whether a particle is one; null: none is
    uint32_t *occupied;                   // cells with points
    pl_liquid_block *blocks;              // their sums, behind one of zeros
    struct pl_tasks *tasks;               // NULL: one thread
    const pl_liquid_kernels *kernels;     // of the world's width
    pl_liquid_strip *strips;              // those of the coarser grids behind; 0 stands for none
    pl_liquid_level levels[PL_LIQUID_LEVELS];
    uint32_t strip_count, level_count;
    uint32_t iterations;                   // of the last solution
    near_real *vectors[PL_LIQUID_VECTORS]; // 16 zeros of strip 0 in front
    double *sums;                          // parts of totals
    pl_liquid_body *bodies;
    pl_liquid_link *links;
    uint32_t *rim_rows; // beside bodies that move, those of one in one range, each once
    pl_liquid_rim *rim_fills;
    pl_liquid_wrap *wraps;
    uint32_t wrap_count;
    uint32_t room_count;      // with the outside
    uint32_t room_cell_count; // 0: no room is evened out
    pl_liquid_room_cell *room_cells;
    pl_liquid_room *rooms; // of the last that were found
    uint32_t node_count, ring_count, softbody_count, soft_link_count;
    pl_liquid_node *nodes; // of soft bodies, in their order, with the middles of rings behind
    pl_liquid_ring *rings;
    pl_liquid_softbody *softbodies;
    pl_liquid_soft_link *soft_links;
    const struct plumb_world *world; // whose soft bodies these are
    bool films;  // between bodies and what they touch
    double drag; // [kg] above 0: viscosity drags bodies, density times the square of a cell's side
    const pl_liquid_mixture *mixture; // null: all is one phase
    const pl_liquid_grains *grains;   // null: nothing is granular
    pl_liquid_solid *solids;
    uint32_t *tile_solids;
#define PL_LIQUID_DECLARE(type, name) type *name;
    PL_LIQUID_COLUMNS(PL_LIQUID_DECLARE)
#undef PL_LIQUID_DECLARE
} pl_liquid_grid;

// What was on a body before, or what was expected of it.
typedef struct pl_liquid_push {
    plumb_body body;
    plumb_real fx, fy, torque;
} pl_liquid_push;

// What a step of the liquid needs besides the particles: made when it first flows, as most worlds have none.
typedef struct pl_liquid_scratch {
    pl_buffer moved;  // plumb_particle: where they are after the step
    pl_buffer pushes; // pl_liquid_push
    uint32_t push_count; // of this step, until nothing can fail any more: they can be undone
    pl_liquid_grid grid;
    pl_liquid_mixture mixture;
    pl_liquid_grains grains;
    uint32_t slots; // of the table of tiles, a power of 2
    uint32_t home_count;
    pl_buffer cells, tiles, hash, keys, points, spots, homes, strays, occupied, viscous, blocks, strips, vectors, sums, bodies, links, rims, solids, tile_solids, phases, blends, mixed, rooms, room_cells, order, supports, joined, tension, nodes, rings, softbodies, soft_links, sides, touches, granular;
} pl_liquid_scratch;

// Particles by the bins that they lie in, for questions (sample.c): made when the first one is asked after they moved.
typedef struct pl_liquid_index {
    pl_buffer heads; // uint32_t: first particle of each slot of a table of bins; PL_NONE: none
    pl_buffer next;  // uint32_t: behind each particle
    uint32_t mask;   // slots less one
    bool fresh;
    double low_x, low_y, high_x, high_y; // [m] box round all particles
} pl_liquid_index;

typedef struct pl_liquid {
    pl_buffer settings; // plumb_liquid_desc: one, or none
    uint32_t settings_count;
    uint32_t count;
    pl_buffer particles; // plumb_particle
    pl_buffer phases;    // plumb_liquid_phase, beside the first
    uint32_t phase_count;
    pl_liquid_supports supports;
    pl_liquid_scratch *scratch; // NULL: no step has needed it yet
    pl_buffer contacts, ends;   // plumb_liquid_contact, plumb_liquid_end: of the last step
    uint32_t contact_count, end_count;
    pl_liquid_index index;
} pl_liquid;

static inline plumb_particle *pl_liquid_items(const pl_liquid *liquid)
{
    return (plumb_particle *)liquid->particles.data;
}

static inline const plumb_liquid_desc *pl_liquid_desc(const pl_liquid *liquid)
{
    return (const plumb_liquid_desc *)liquid->settings.data;
}

static inline plumb_liquid_phase *pl_liquid_phases(const pl_liquid *liquid)
{
    return (plumb_liquid_phase *)liquid->phases.data;
}

#endif
