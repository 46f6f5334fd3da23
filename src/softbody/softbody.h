// softbody.h - soft bodies in a step: the kernels, and what the step calls.
#ifndef PL_SOFTBODY_H
#define PL_SOFTBODY_H

#include "world/state.h"

#define PL_SOFT_SPEED 1e6  // [m/s] of nodes at most
#define PL_SOFT_LATE  0.75 // of u, in the rate that a damper sees

// What is asked of the function that is to be least: its value; its slopes as well, into `right`; the matrix too.
typedef enum pl_soft_fill { PL_SOFT_VALUE, PL_SOFT_SLOPES, PL_SOFT_ALL } pl_soft_fill;

void pl_softbodies_free(pl_memory *memory, pl_softbodies *softbodies);
// Of an image: numbers in their ranges, nodes that there are. Bodies of pins are asked for elsewhere.
bool pl_softbodies_are_sound(const pl_softbodies *s);
// Adds their energy, momentum and mass.
void pl_softbodies_energy(const plumb_world *world, plumb_energy *energy);

// A number of a node with what rounding left of it.
static inline double pl_soft_exact(plumb_real value, plumb_real rest)
{
    return (double)value + (double)rest;
}

static inline void pl_soft_node_place(const plumb_softbody_node *n, double out[2])
{
    out[0] = pl_soft_exact(n->position.x, n->position_rest.x);
    out[1] = pl_soft_exact(n->position.y, n->position_rest.y);
}

static inline void pl_soft_node_velocity(const plumb_softbody_node *n, double out[2])
{
    out[0] = pl_soft_exact(n->velocity.x, n->velocity_rest.x);
    out[1] = pl_soft_exact(n->velocity.y, n->velocity_rest.y);
}

static inline pl_soft_point *pl_soft_points(const pl_soft_step *s)
{
    return (pl_soft_point *)s->points.data;
}

static inline pl_soft_body *pl_soft_bodies(const pl_soft_step *s)
{
    return (pl_soft_body *)s->bodies.data;
}

static inline pl_soft_member *pl_soft_members(const pl_soft_step *s)
{
    return (pl_soft_member *)s->members.data;
}

static inline pl_soft_group *pl_soft_groups(const pl_soft_step *s)
{
    return (pl_soft_group *)s->groups.data;
}

//---- step.c --------------------------------------------------------------------------------------

// Its scratch, if there is none. False when out of memory.
bool pl_soft_make_step(plumb_world *world);
// Before the graph: nodes and what is near them. False when out of memory.
bool pl_softbodies_find(plumb_world *world, plumb_real dt);
// Marks bodies that are solved with soft ones: they are of one cluster. True if there are any.
bool pl_softbodies_couple(const plumb_world *world, uint8_t *called);

//---- plan.c --------------------------------------------------------------------------------------

// Behind the graph: slots, groups, the structure of the system. False when out of memory.
bool pl_softbodies_plan(plumb_world *world);

//---- order.c -------------------------------------------------------------------------------------

// Places of unknowns, as `elimination` has their pairs; most_pairs: as it was opened. *same: pairs are those of the plan before, and
// places as well. False when out of memory.
bool pl_soft_order(pl_memory *memory, pl_soft_step *s, uint32_t most_pairs, bool *same);
// Of each unknown: 4 times its block, and its size; PL_NONE. Behind pl_soft_order; what stands there is of the plan before, if that is kept.
uint32_t *pl_soft_kept_blocks(const pl_soft_step *s);

//---- foresee.c -----------------------------------------------------------------------------------

// What soft bodies do in a step if nothing pushes them but what there is by now, and bodies go on as they do: points are
// then as they end it. False when out of memory.
bool pl_soft_foresee(plumb_world *world, plumb_real dt);
// Behind it: the right side of the matrix, impulses [N s], becomes what these add to velocities.
void pl_soft_answer(const pl_soft_step *s);

//---- pushes.c ------------------------------------------------------------------------------------

// Room for what pushes nodes in this step, all 0. Null when out of memory.
pl_soft_shove *pl_soft_make_pushes(plumb_world *world);
// None of them do, as the step is refused.
void pl_soft_drop_pushes(plumb_world *world);
// They go with the soft bodies as these turn: a substep begins.
void pl_soft_turn_pushes(plumb_world *world, double h);
// As pl_soft_elements.
double pl_soft_add_pushes(const pl_soft_step *s, const pl_soft_group *g, double h,
                          pl_soft_fill fill);

//---- newton.c ------------------------------------------------------------------------------------

#define PL_SOFT_PASSES 48 // of a substep's iteration at most

void pl_soft_newton(plumb_world *world, double h, int passes); // [s]; at most so many a round

//---- matrix.c ------------------------------------------------------------------------------------

// The structure of `pairs` of blocks (pl_keyed keys of pl_pair_key, sorted), which are in postorder of their elimination tree; sizes
// stand in step->shapes. `width`: the world's simd_width. False when out of memory.
bool pl_soft_structure(pl_memory *memory, pl_soft_step *step, uint32_t blocks, uint32_t pairs,
                       int width);
// Blocks of row k of L, in an order in which each comes before those that it changes: stack[top..blocks). Returns top.
uint32_t pl_soft_reach(const pl_soft_matrix *m, uint32_t k);
// What follows is about blocks [first, end): those of a group, or all.
void pl_soft_clear(pl_soft_matrix *m, uint32_t first, uint32_t end);
void pl_soft_clear_right(pl_soft_matrix *m, uint32_t first, uint32_t end); // its right side alone
// Place of an entry, row > column; both are neighbours.
double *pl_soft_entry(const pl_soft_matrix *m, uint32_t row, uint32_t column);

//---- fronts.c, fronts.simd.c ---------------------------------------------------------------------

const pl_soft_kernels *pl_soft_kernels_w4(void), *pl_soft_kernels_w8(void),
    *pl_soft_kernels_w16(void);

// How many fronts there are, of which blocks; then how large they are and where all of it lies. False when out of memory.
bool pl_soft_make_fronts(pl_memory *memory, pl_soft_step *step);
// Factors the matrix; solves for `right`, into itself.
void pl_soft_factor(pl_soft_matrix *m, uint32_t first, uint32_t end);
void pl_soft_solve(const pl_soft_matrix *m, uint32_t first, uint32_t end);

//---- points.c ------------------------------------------------------------------------------------

static inline const pl_soft_point *pl_soft_point_at(const pl_soft_step *s, uint32_t i)
{
    return (const pl_soft_point *)s->points.data + i;
}

// How a point follows the unknowns of its block: two rows of 3.
void pl_soft_follow(const pl_soft_step *s, const pl_soft_point *p, double j[6]);
// Adds k (2 x 2) between two points, and its transpose where they are different, as blocks have them.
void pl_soft_add(const pl_soft_step *s, uint32_t a, uint32_t b, const double k[4]);
// Adds an impulse at a point.
void pl_soft_push(const pl_soft_step *s, uint32_t point, double x, double y);
// What u adds to the velocities of points [first, first + count).
void pl_soft_change(const pl_soft_step *s, uint32_t first, uint32_t count);

//---- settle.c ------------------------------------------------------------------------------------

// Ready when the step is over: tension, what tears, what yields.
void pl_soft_settle_edges(plumb_world *world);

//---- elements.c ----------------------------------------------------------------------------------

// The function of a group that is to be least, of its triangles, and of all its other elements, at the velocities that u adds
// [kg m^2/s^2]. As `fill` says their impulses are added to `right` [N s], their stiffness to the matrix.
double pl_soft_triangles(plumb_world *world, const pl_soft_group *g, double h, pl_soft_fill fill);
double pl_soft_elements(plumb_world *world, const pl_soft_group *g, double h, pl_soft_fill fill);
// What of edges stays as it is while a substep is solved.
void pl_soft_see_edges(plumb_world *world, double h);
// [J] in all elements; [m^2], [N/m] of the gas of one.
double pl_soft_elastic(const plumb_world *world, uint32_t row, pl_softbody_place at);
double pl_soft_area(const plumb_world *world, const pl_softbody *item, pl_softbody_place at);
double pl_soft_pressure(const pl_softbody *item, double area);

//---- winds.c -------------------------------------------------------------------------------------

// Volumes of fluid that soft bodies may be in. False when out of memory.
bool pl_soft_find_winds(plumb_world *world);
// The flow about each node, `since` [s] after the step began.
void pl_soft_feel_winds(const plumb_world *world, double since);

//---- rest.c --------------------------------------------------------------------------------------

// Time goes on for all that are awake; `passed` [s]: the step before.
void pl_soft_rest_pass(plumb_world *world, plumb_real passed);
// Rested for two samples, half of sleep_time each, and may sleep.
bool pl_soft_is_rested(const pl_softbody *item);
// [m^2/s^2] of its fastest node.
double pl_soft_square_speed(const plumb_world *world, const pl_softbody *item,
                            pl_softbody_place at);
// It is dragged by a fluid that is never the same, or whose volume moves.
bool pl_soft_is_blown(const plumb_world *world, const pl_softbody *item);
// [m] between a piece and the nodes that may touch it, less what both may move in the step; INFINITY where that is more than 2 cm, or
// they do not meet.
double pl_soft_gap(const plumb_world *world, const pl_softbody *item, pl_softbody_place at,
                   uint32_t row, uint32_t piece, double dt);

//---- near.c --------------------------------------------------------------------------------------

// Pieces near nodes, with their bodies; which nodes. False when out of memory.
bool pl_soft_find_near(plumb_world *world, double dt);
uint32_t pl_soft_body_of(plumb_world *world,
                         uint32_t row); // place in the list; PL_NONE: out of memory
// The corners of a piece about its body's centre of mass.
void pl_soft_see_piece(const plumb_world *world, uint32_t row, uint32_t piece,
                       pl_soft_obstacle *out);
// [m] that the pieces of a row may move in a step.
double pl_soft_way_of_row(const plumb_world *world, uint32_t row, double dt);
// It is solid, and the filters of both let them touch.
bool pl_soft_meets(const plumb_world *world, uint32_t piece, const pl_softbody *item);

//---- contacts.c ----------------------------------------------------------------------------------

// Way out of a convex piece: distance of a point from its surface, below 0 inside, and the outward normal.
double pl_soft_distance(const pl_soft_obstacle *o, double x, double y, double n[2]);
// Contacts of a substep.
void pl_soft_find_contacts(plumb_world *world, double h);
// As pl_soft_elements. What holds by friction goes by the normal forces that bound it: pl_soft_bind, and the first passes.
double pl_soft_press(const pl_soft_step *s, const pl_soft_group *g, double h, pl_soft_fill fill);
// Bounds friction by the normal forces of now. Whether that changed the bounds by much.
bool pl_soft_bind(const pl_soft_step *s, pl_soft_group *g);

#endif
