// liquid.h - the kernels of the liquid, and what the step calls.
#ifndef PL_LIQUID_H
#define PL_LIQUID_H

#include "core/tasks.h"
#include "world/state.h"

#define PL_LIQUID_REACH     3 // cells around particles that tiles cover
#define PL_LIQUID_FULL      4 // particles in a cell at rest
#define PL_LIQUID_MOST_CELL (INT32_C(1) << 29)

#define PL_LIQUID_NONE UINT32_MAX

#define PL_LIQUID_SPEED 1e6  // [m/s] of particles, and of what pushes them, at most
#define PL_LIQUID_SLOPE 1e9  // [1/s] of their gradients
#define PL_LIQUID_FORCE 1e30 // [N] on bodies and nodes, that float can still multiply by
#define PL_LIQUID_RATIO 1e3  // of densities of phases, at most

#define PL_LIQUID_MOST_VISCOSITY ((plumb_real)1e9)

// Within bounds; what is no number is 0. Numbers that float cannot hold come with bodies that fly to infinity.
static inline double pl_liquid_held(double value, double most)
{
    return value > most ? most : value < -most ? -most : value == value ? value : 0;
}

// Of an image: defaults are resolved in it.
bool pl_liquid_desc_is_sound(const plumb_liquid_desc *desc);
bool pl_liquid_phase_is_sound(const plumb_liquid_phase *phase, plumb_real first_density);
bool pl_liquid_particle_is_sound(const plumb_particle *particle, uint32_t phases);
// Does not write to the scratch: of a copy of the liquid it tells what would be freed (api/memory_rows.c).
void pl_liquid_free(pl_memory *memory, pl_liquid *liquid);
// The arrays of the scratch, not itself.
void pl_liquid_free_arrays(pl_memory *memory, pl_liquid_scratch *scratch);

//---- tiles.c -------------------------------------------------------------------------------------

static inline int32_t pl_liquid_tile_of(int32_t cell)
{
    return cell >> 4;
}

// The home of each spot but strays'. False when out of memory.
bool pl_liquid_find_homes(pl_memory *memory, pl_liquid_scratch *scratch, uint32_t count);
// Tiles round all that is lively, sorted. False when out of memory.
bool pl_liquid_find_tiles(pl_memory *memory, pl_liquid_scratch *scratch);
bool pl_liquid_sort_tiles(pl_memory *memory, pl_liquid_scratch *scratch);
// The first cell of the tile (x, y); 0: there is no such tile.
uint32_t pl_liquid_tile_first(const pl_liquid_grid *grid, int32_t x, int32_t y);
// A table of tiles by itself: none; one more, unless it is there; the place of one, or PL_LIQUID_NONE.
bool pl_liquid_clear_tiles(pl_memory *memory, pl_liquid_scratch *scratch);
bool pl_liquid_add_tile(pl_memory *memory, pl_liquid_scratch *scratch, int32_t x, int32_t y);
uint32_t pl_liquid_tile_at(const pl_liquid_scratch *scratch, int32_t x, int32_t y);

//---- strays.c ------------------------------------------------------------------------------------

// Marks particles that are on their own. Solids must be placed. False when out of memory.
bool pl_liquid_find_strays(pl_memory *memory, pl_liquid_scratch *scratch,
                           const plumb_particle *particles, uint32_t count);
// They fly for dt, and are kept out of solids.
void pl_liquid_fly(const pl_liquid_grid *grid, plumb_vec2 gravity, double dt,
                   plumb_particle *particles, uint32_t count);

//---- grid.c --------------------------------------------------------------------------------------

// In which cell each particle is, and its home; the grid's `h` must be set. False when out of memory.
bool pl_liquid_find_spots(pl_memory *memory, pl_liquid_scratch *scratch,
                          const plumb_particle *particles, uint32_t count);
// Of particles in these: tiles round them, points sorted by cell, and by their order within one. False when out of memory.
bool pl_liquid_grid_build(pl_memory *memory, pl_liquid_scratch *scratch,
                          const plumb_particle *particles, uint32_t count);
// The cells of its sorted tiles, without any point. False when out of memory.
bool pl_liquid_make_cells(pl_memory *memory, pl_liquid_scratch *scratch);
// The cell at (i, j); 0: in no tile.
uint32_t pl_liquid_cell_at(const pl_liquid_grid *grid, int32_t i, int32_t j);
// Runs over all cells but cell 0, shared out among threads: range counts them from 0.
void pl_liquid_cells(pl_liquid_grid *grid, pl_range_fn *range);
// Cell coordinate of a place, and what is left of it.
int32_t pl_liquid_floor(double cells, near_real *fraction);

//---- films.c -------------------------------------------------------------------------------------

// Whether a solid's motion is an unknown, and it is so wide that it takes areas of faces.
static inline bool pl_liquid_yields(const pl_liquid_grid *grid, const pl_liquid_solid *solid)
{
    return grid->films && !solid->thin && solid->body != PL_LIQUID_NONE &&
           grid->bodies[solid->body].moves;
}

// Finds the sides of pieces that lie on others of their body: when they were placed for the first time in a step.
void pl_liquid_find_inner(pl_liquid_grid *grid);
// The corners of a solid that yields, drawn in by a film.
void pl_liquid_draw_in(pl_liquid_solid *solid);

//---- solids.c ------------------------------------------------------------------------------------

// Closes faces by the grid's solids, as they are now. False when out of memory.
bool pl_liquid_close_faces(pl_memory *memory, pl_liquid_scratch *scratch);

//---- transfer.c ----------------------------------------------------------------------------------

// Sums the points of each cell up. False when out of memory.
bool pl_liquid_sum_cells(pl_memory *memory, pl_liquid_scratch *scratch);
// Velocities of faces; densities at centres of cells.
void pl_liquid_to_grid(pl_liquid_grid *grid);
// Fills faces that are not known from those beside them, two cells far and more.
void pl_liquid_extrapolate(pl_liquid_grid *grid, near_real *u, near_real *v, int cells);
void pl_liquid_accelerate(pl_liquid_grid *grid, near_real du, near_real dv);
// What flows along faces that solids close goes with them.
void pl_liquid_bound(pl_liquid_grid *grid);

//---- tension.c -----------------------------------------------------------------------------------

#define PL_LIQUID_MOST_TENSION ((plumb_real)1e9)

// Faces at the surface get the pressure that its tension makes. pull: [m/s] of a curvature of one a cell, tension dt / (density h^2).
// False when out of memory.
bool pl_liquid_tighten(pl_memory *memory, pl_liquid_scratch *scratch, double pull);
// Faces that no cell with liquid is beside are not known any more: they have felt no pressure.
void pl_liquid_forget_far(pl_liquid_grid *grid);

// drops.c: drops that touch nothing gain no more than gravity's fall_x, fall_y [m/s]. Behind pl_liquid_tighten.
void pl_liquid_keep_momentum(pl_liquid_grid *grid, pl_liquid_scratch *scratch, double fall_x,
                             double fall_y);

//---- viscosity.c ---------------------------------------------------------------------------------

#define PL_LIQUID_THICK 1e6 // [-] beyond it float cannot tell a liquid from a solid

// What viscosity does to faces; amount: kinematic viscosity times the step, in squares of a cell. False when out of memory.
bool pl_liquid_diffuse(pl_memory *memory, pl_liquid_scratch *scratch, double amount);
// What grains bear acts on faces and bodies, before pressures are found. False when out of memory.
bool pl_liquid_push_shear(pl_memory *memory, pl_liquid_scratch *scratch);
// What they would bear more by the velocities that end the part. False when out of memory.
bool pl_liquid_strain(pl_memory *memory, pl_liquid_scratch *scratch);

//---- grains.c ------------------------------------------------------------------------------------

// [-] shear modulus dt^2 / (density h^2): elastic waves cross its root of cells in a part.
#define PL_LIQUID_STIFF         50
#define PL_LIQUID_MOST_FRICTION ((plumb_real)10)

// [-] of a phase's grains; 0: a liquid's.
static inline double pl_liquid_friction(const pl_liquid_grid *grid, uint32_t phase)
{
    return grid->grains != NULL ? grid->grains->friction[phase] : 0;
}

// [m/s] what presses grains of a cell together.
static inline double pl_liquid_bearing(const pl_liquid_grains *grains, uint32_t cell)
{
    const double pressure = (double)grains->pressure[cell];
    return grains->least + (pressure > 0 ? pressure : 0);
}

// The grid's `grains`: none if neither the liquid nor a phase of it is granular.
void pl_liquid_find_grains(pl_liquid *liquid);
// What they bear in cells of the grid. unit: [Pa] of 1 m/s; fall: [m/s] by gravity in a part. False when out of memory.
bool pl_liquid_gather_grains(pl_memory *memory, pl_liquid_scratch *scratch, double unit,
                             double fall);
// Adds the last pressures to theirs.
void pl_liquid_press_grains(pl_liquid_grid *grid);
// What each bears as the part ends. way: [cells per m/s].
void pl_liquid_bear_shear(pl_liquid_grid *grid, double way);

//---- multigrid.c ---------------------------------------------------------------------------------

// Strips of the finest grid are added from below, and from left to right; strip 0 stands for all that there are not.
// False when out of memory.
bool pl_liquid_first_strip(pl_memory *memory, pl_liquid_scratch *scratch);
bool pl_liquid_add_strip(pl_memory *memory, pl_liquid_scratch *scratch, int32_t x, int32_t y,
                         uint32_t cell);
bool pl_liquid_make_grids(pl_memory *memory, pl_liquid_scratch *scratch);
// The matrices of the coarser grids.
void pl_liquid_fold_grids(pl_liquid_grid *grid);
// Q: about the inverse of the matrix times R, but for the last sweep on the finest grid. Z must be I R.
void pl_liquid_cycle(pl_liquid_grid *grid);

// strips.simd.c: loops over the strips from first to end, compiled once for each size of vector register.
struct pl_liquid_kernels {
    // out: the matrix times v. The answer is v . out.
    double (*multiply)(const pl_liquid_grid *grid, uint32_t first, uint32_t end, const near_real *v,
                       near_real *out);
    // to = from + I (R - A from). The answer is to . R.
    double (*sweep)(const pl_liquid_grid *grid, uint32_t first, uint32_t end, const near_real *from,
                    near_real *to);
    // What the finer grid leaves goes to R of these, with Z, the first sweep there; what they answer, Q, is added to Z of
    // the finer one.
    void (*go_down)(const pl_liquid_grid *grid, uint32_t first, uint32_t end);
    void (*come_up)(const pl_liquid_grid *grid, uint32_t first, uint32_t end);
    // P += factor S, R -= factor Z, Z = I R. The answer is the largest of R.
    double (*descend)(const pl_liquid_grid *grid, uint32_t first, uint32_t end, near_real factor);
    // S = Q + factor S
    void (*turn)(const pl_liquid_grid *grid, uint32_t first, uint32_t end, near_real factor);
    // What pressures p do to the sums of bodies: force over density h^2.
    void (*sum_rims)(pl_liquid_grid *grid, const near_real *p);
    // The same, and what bodies make of them is added to out, a product with the matrix. The answer is what this adds to p . A p.
    double (*add_rims)(pl_liquid_grid *grid, const near_real *p, near_real *out, double push);
};

extern const pl_liquid_kernels pl_liquid_kernels_w4;
extern const pl_liquid_kernels pl_liquid_kernels_w8;
extern const pl_liquid_kernels pl_liquid_kernels_w16;

static inline const pl_liquid_kernels *pl_liquid_kernels_for(int width)
{
    return width == 16  ? &pl_liquid_kernels_w16
           : width == 8 ? &pl_liquid_kernels_w8
                        : &pl_liquid_kernels_w4;
}

static inline uint32_t pl_liquid_cell_of(const pl_liquid_grid *grid, uint32_t row)
{
    return grid->strips[row / PL_LIQUID_SIDE].cell + row % PL_LIQUID_SIDE;
}

// How open a cell's left, right, lower and upper faces are. Cell 0 is open.
static inline void pl_liquid_faces_of(const pl_liquid_grid *grid, uint32_t cell, near_real open[4])
{
    open[0] = grid->open_u[cell];
    open[1] = grid->open_u[grid->right[cell]];
    open[2] = grid->open_v[cell];
    open[3] = grid->open_v[grid->up[cell]];
}

// 0..1 of a cell's surroundings that is not solid: with less it is not asked how full that is.
#define PL_LIQUID_LEAST_ROOM ((near_real)0.1)

static inline near_real pl_liquid_space(const pl_liquid_grid *grid, uint32_t cell)
{
    return 1 - grid->solid[cell];
}

// How full of liquid that space is.
static inline near_real pl_liquid_fullness(const pl_liquid_grid *grid, uint32_t cell)
{
    return (grid->density[cell] - grid->solid[cell]) / pl_liquid_space(grid, cell);
}

//---- wet.c ---------------------------------------------------------------------------------------

// Marks cells that have liquid. False when out of memory.
bool pl_liquid_find_wet(pl_memory *memory, pl_liquid_scratch *scratch);
// How far it is [cells] from the centre of the one of two cells that has liquid to the surface between them; 1 where both
// have.
near_real pl_liquid_gap(const pl_liquid_grid *grid, uint32_t a, uint32_t b);

//---- links.c -------------------------------------------------------------------------------------

// Rows on both sides of a cell's lower face (upright) or left one; that of air is 0.
typedef struct pl_liquid_ends {
    uint32_t before, behind;
} pl_liquid_ends;

static inline pl_liquid_ends pl_liquid_ends_of(const pl_liquid_grid *grid, uint32_t cell,
                                               bool upright)
{
    const uint32_t other = upright ? grid->down[cell] : grid->left[cell];
    return (pl_liquid_ends){ grid->row[other], grid->row[cell] };
}

// What lies beside bodies, once cells have rows. False when out of memory.
bool pl_liquid_find_rims(pl_memory *memory, pl_liquid_scratch *scratch);

// What adds to the speed of what closes a face.
static inline void pl_liquid_add_speed(pl_liquid_grid *grid, uint32_t cell, bool upright,
                                       near_real part, double speed)
{
    near_real *to = upright ? &grid->solid_v[cell] : &grid->solid_u[cell];
    *to += part * (near_real)pl_liquid_held(speed, PL_LIQUID_SPEED);
}

// Adds what bodies make of pressures p to out, a product with the matrix; the answer is what this adds to p . A p. `push`: [kg] density times
// the square of a cell's side.
double pl_liquid_add_links(pl_liquid_grid *grid, const near_real *p, near_real *out, double push);
// [N s], [N m s]
void pl_liquid_push_body(pl_liquid_body *body, double x, double y, double turn);
// The pressures of the answer push bodies.
void pl_liquid_push_bodies(pl_liquid_grid *grid, double push);
// What of a body has no pressures on both sides, as it lies on the ground, is borne as by water at rest. fall_x, fall_y: [m/s] by
// gravity.
void pl_liquid_bear_rests(pl_liquid_grid *grid, double push, double fall_x, double fall_y);
// Faces that moving bodies close go as these do now: between two of what changes their velocities.
void pl_liquid_follow_bodies(pl_liquid_grid *grid);
void pl_liquid_see_bodies(pl_liquid_grid *grid);

//---- pressure.c, density.c -----------------------------------------------------------------------

// Which cells have liquid, the matrix, its factors. False when out of memory.
bool pl_liquid_plan(pl_memory *memory, pl_liquid_scratch *scratch);
// Its parts: what flows into cells, into vectors[PL_LIQUID_R]; what pressures do to faces and bodies.
void pl_liquid_find_inflow(pl_liquid_grid *grid);
void pl_liquid_take_pressure(pl_liquid_grid *grid, double push);
// Makes velocities free of divergence. `push`: [kg] density times the square of a cell's side. False when out of memory.
bool pl_liquid_project(pl_memory *memory, pl_liquid_scratch *scratch, double push);
// Solves the system for what lies in vectors[PL_LIQUID_R], with bodies if push is not 0; the answer is in P. Ends when
// the largest of what is left is below `floor`, or `tolerance` of what it was.
void pl_liquid_solve(pl_liquid_grid *grid, double push, double tolerance, double floor);
// Displacements [cells] that even the density out, into new_u and new_v. False when out of memory.
bool pl_liquid_even_out(pl_memory *memory, pl_liquid_scratch *scratch);

//---- rooms.c -------------------------------------------------------------------------------------

// Which cells open faces join, once they have rows. False when out of memory.
bool pl_liquid_find_rooms(pl_memory *memory, pl_liquid_scratch *scratch);
// Takes out of vectors[PL_LIQUID_R] what has no answer, before it is solved for. False when out of memory.
bool pl_liquid_balance(pl_memory *memory, pl_liquid_scratch *scratch, bool bodies_move);
// The same where bodies reach into walls and close pockets off, which leak: the solution that follows evens such rooms out. False when out of
// memory.
bool pl_liquid_balance_rooms(pl_memory *memory, pl_liquid_scratch *scratch);
// Takes the mean of such rooms out of a vector. O(their cells).
void pl_liquid_even_rooms(const pl_liquid_grid *grid, near_real *vector);

//---- phases.c ------------------------------------------------------------------------------------

// [Pa s] the largest viscosity of all phases.
double pl_liquid_thickest(const pl_liquid *liquid);
// Whether a step has several phases, and what they are: the grid's `mixture`.
void pl_liquid_find_mixture(const pl_liquid *liquid, plumb_vec2 gravity);
// Its columns, when there are cells. False when out of memory.
bool pl_liquid_make_mixture(pl_memory *memory, pl_liquid_scratch *scratch);
// Densities of faces that no particle is near.
void pl_liquid_lighten(pl_liquid_grid *grid);

// Density of the first phase over that of a face.
static inline near_real pl_liquid_light_u(const pl_liquid_grid *grid, uint32_t cell)
{
    return grid->mixture != NULL ? grid->mixture->light_u[cell] : 1;
}

static inline near_real pl_liquid_light_v(const pl_liquid_grid *grid, uint32_t cell)
{
    return grid->mixture != NULL ? grid->mixture->light_v[cell] : 1;
}

static inline near_real pl_liquid_light_at(const pl_liquid_grid *grid, uint32_t cell, bool upright)
{
    return upright ? pl_liquid_light_v(grid, cell) : pl_liquid_light_u(grid, cell);
}

typedef struct pl_liquid_place {
    double x, y; // [cells]
} pl_liquid_place;

// How far a sorted point drifts as a drop among other phases, in a way of [cells a m/s].
pl_liquid_place pl_liquid_drift(const pl_liquid_grid *grid, uint32_t point, double way);

//---- move.c --------------------------------------------------------------------------------------

// Particles get the velocities of faces, move by them times `way` [cells a m/s] and by the displacements, out of solids.
void pl_liquid_move(pl_liquid_grid *grid, double way, plumb_particle *particles);

// Keeps a place out of all solids, on its way from another; what is left of a way goes on along them. The normals of the
// last that is met, and of the last of those that stand; 0: none is.
pl_liquid_place pl_liquid_slide_all(const pl_liquid_grid *grid, pl_liquid_place from,
                                    pl_liquid_place to, pl_liquid_place *normal,
                                    pl_liquid_place *standing);

//---- bodies.c ------------------------------------------------------------------------------------

typedef struct pl_liquid_region {
    double low_x, low_y, high_x, high_y; // [m]
} pl_liquid_region;

// The liquid's, with what is near it.
pl_liquid_region pl_liquid_region_of(const pl_liquid *liquid);
// Shapes near a region as solids, those of bodies that are not static with their motion, behind what there is. False
// when out of memory.
bool pl_liquid_find_solids(plumb_world *world, pl_liquid_scratch *scratch, pl_liquid_region region,
                           real dt);
// Gravity and forces on bodies in dt.
void pl_liquid_pull_bodies(const plumb_world *world, pl_liquid_grid *grid, real dt);
// Behind pl_liquid_recall_supports: whoever was not there before is expected to be held against these, as what lies on the ground is.
void pl_liquid_hold_newcomers(const plumb_world *world, pl_liquid_grid *grid);
// The box of a solid and the normals of its sides, from its corners.
void pl_liquid_find_reach(pl_liquid_solid *solid);
// Bodies go on by their velocities for dt, and solids with them.
void pl_liquid_place_solids(plumb_world *world, pl_liquid_scratch *scratch, double dt);
// Impulses of the step become forces on bodies, and back. Room was made by pl_liquid_find_solids.
void pl_liquid_push_rows(plumb_world *world, pl_liquid_scratch *scratch, real dt);
void pl_liquid_unpush_rows(plumb_world *world, pl_liquid_scratch *scratch);

//---- soft.c --------------------------------------------------------------------------------------

// Soft bodies near a region that have an area, as solids, a triangle each, behind what there is. False when out of memory.
bool pl_liquid_find_soft(plumb_world *world, pl_liquid_scratch *scratch, pl_liquid_region region,
                         real dt);
// What the step does to them anyway, and how they answer. False when out of memory.
bool pl_liquid_foresee_soft(plumb_world *world, pl_liquid_grid *grid, real dt);
// [m/s], [rad/s] of one as a whole, as the liquid has it or as it is by now.
void pl_liquid_soft_motion(const pl_liquid_grid *grid, const pl_liquid_softbody *body, bool by_now,
                           double out[3]);
// Adds a part of what the step does to them anyway.
void pl_liquid_pull_nodes(pl_liquid_grid *grid, double part);
void pl_liquid_place_nodes(pl_liquid_grid *grid, double dt);
void pl_liquid_place_triangle(const pl_liquid_grid *grid, pl_liquid_solid *solid);
// Impulses of the step become forces on nodes.
void pl_liquid_push_soft(plumb_world *world, const pl_liquid_grid *grid, double dt);

// The middles of rings are, and move, as their nodes do in the mean.
void pl_liquid_see_middles(pl_liquid_grid *grid);

static inline pl_liquid_node *pl_liquid_ring_node(const pl_liquid_grid *grid,
                                                  const pl_liquid_ring *ring, uint32_t k)
{
    return &grid->nodes[ring->node + pl_softbody_rings(&grid->world->softbodies)[ring->first + k]];
}

// [kg] of a node, and of what it takes along.
static inline double pl_liquid_soft_mass(const pl_liquid_grid *grid, uint32_t node)
{
    const pl_softbodies *all = &grid->world->softbodies;
    const pl_soft_step *step = all->step;
    const double mass = (double)pl_softbody_nodes(all)[node].mass;
    return step != NULL && step->pushed
               ? mass + ((const pl_soft_shove *)step->pushes.data)[node].mass
               : mass;
}

//---- soft_links.c --------------------------------------------------------------------------------

// A link closes its part of a face by a triangle, with its middle at (x, y) [cells]: nodes and shares of it are told.
void pl_liquid_close_softly(pl_liquid_grid *grid, const pl_liquid_solid *solid,
                            pl_liquid_soft_link *link, double x, double y);
// As their namesakes for bodies.
double pl_liquid_add_soft_links(pl_liquid_grid *grid, const near_real *p, near_real *out,
                                double push);
void pl_liquid_push_nodes(pl_liquid_grid *grid, double push);
void pl_liquid_bear_nodes(pl_liquid_grid *grid, double push, double fall_x, double fall_y);
void pl_liquid_follow_nodes(pl_liquid_grid *grid);
void pl_liquid_see_nodes(pl_liquid_grid *grid);

//---- support.c -----------------------------------------------------------------------------------

// What held a body until now, by the key of its entity; NULL: the liquid did not know it.
const pl_liquid_support *pl_liquid_support_of(const pl_liquid_supports *supports, uint64_t key);
// Gives the grid's bodies what held them in the last steps, and makes room for what will in this one. False when out of memory.
bool pl_liquid_recall_supports(pl_memory *memory, pl_liquid_supports *supports,
                               pl_liquid_scratch *scratch);
// Bodies have got their velocities: what the grid did not know of, in the scratch's `supports` in the order of its `order`; how many.
uint32_t pl_liquid_note_supports(const plumb_world *world, const pl_liquid_supports *supports,
                                 pl_liquid_scratch *scratch, real dt);
// They take the place of those of the step before.
void pl_liquid_take_supports(pl_liquid_supports *supports, const pl_liquid_scratch *scratch,
                             uint32_t count);

//---- touch.c -------------------------------------------------------------------------------------

// Room for what bodies and soft bodies of the grid will have to tell. False when out of memory.
bool pl_liquid_reserve_touches(pl_memory *memory, pl_liquid *liquid);
bool pl_liquid_softbody_is_wet(const pl_liquid_grid *grid, const pl_liquid_softbody *body);
// Contacts and ends of the step by what was noted of it, before that takes the place of what was of the one before.
void pl_liquid_tell_touches(plumb_world *world, double dt);

//---- step.c --------------------------------------------------------------------------------------

// The step was refused: forces on bodies as before it.
void pl_liquid_undo(plumb_world *world);

#endif
