// query.h - what the queries share: which pieces are seen, the list of what was found, checks.
#ifndef PL_QUERY_H
#define PL_QUERY_H

#include "world/state.h"

// [m] points of rays, nearest queries and placed shapes: the world's bodies start within 1e9 m, and
// the squares that are taken of lengths beyond it still are numbers in the float build.
#define PL_QUERY_LIMIT ((plumb_real)1e12)

// A piece that answers a query. Overlaps use the shape alone.
typedef struct pl_query_hit {
    plumb_shape shape;
    plumb_body body;
    plumb_real fraction; // [-] along the ray
    plumb_vec2 point;    // [m]
    plumb_vec2 normal;
} pl_query_hit;

// So many hits are held on the stack: queries that find fewer allocate nothing.
#define PL_QUERY_NEAR_HITS 32

// One query under way. Nothing of it lies in the world, so that a filter may ask another query.
typedef struct pl_query {
    plumb_world *world;
    const char *function; // public name, for messages
    plumb_query_filter filter;
    pl_query_hit *hits;
    uint32_t count, capacity;
    bool out_of_memory;
    pl_buffer buffer;
    pl_query_hit near_hits[PL_QUERY_NEAR_HITS];
} pl_query;

// Takes over the filter (null: all), checks it, and brings the grids up to date. No clean-up is
// needed before the first hit is added.
plumb_result pl_query_begin(pl_query *q, plumb_world *world, const char *function,
                            const plumb_query_filter *filter);

// The grids that a filter can see into, in the order in which they are to be asked; returns how many.
#define PL_QUERY_GRIDS 3
int pl_query_grids(const pl_query *q, const pl_grid *grids[static PL_QUERY_GRIDS]);

// False for the pieces of the ignored body, sensors, categories that are not asked for. All but
// filter.accept, which is asked last, about hits.
bool pl_query_sees(const pl_query *q, uint32_t piece);
bool pl_query_accepts(const pl_query *q, plumb_shape shape);

// The piece as queries see it, in the frame of its body: inner cuts of an outline are moved out by
// a few roundings, so that no ray and no point slips between two pieces.
void pl_query_convex(const plumb_world *world, uint32_t piece, plumb_convex *out);

// Frame of the piece's body.
plumb_transform pl_query_frame(const plumb_world *world, uint32_t piece);
// A hit that names the piece's shape and body.
pl_query_hit pl_query_hit_of(const plumb_world *world, uint32_t piece);

// Adds a hit; false when there is no memory for it, which *q remembers.
bool pl_query_add(pl_query *q, const pl_query_hit *hit);
// Leaves the first hit of every shape that the filter accepts, in slot order.
void pl_query_one_per_shape(pl_query *q);
// Sorts by fraction, then slot.
void pl_query_sort_along(pl_query *q);
// Frees the list. E_MEMORY when a hit was lost.
plumb_result pl_query_end(pl_query *q);

// [m] what rounding may do to coordinates of this size on their way through a query.
static inline double pl_query_slack(double largest)
{
    // Eight operations with a rounding each, as an upper bound, at either end.
    return 16 * (double)PLUMB_REAL_EPSILON * largest;
}

// A box around a point.
pl_box pl_query_box_at(plumb_vec2 point, double half);

// Checks of arguments; see world/check.h for the messages.
plumb_result pl_query_check_output(const plumb_world *world, const char *function,
                                   const char *field, const void *output, int capacity);

// Smaller and larger of two; unlike fmin and fmax the same for zeros of either sign everywhere.
static inline double pl_least(double a, double b)
{
    return a < b ? a : b;
}

static inline double pl_most(double a, double b)
{
    return a > b ? a : b;
}

#endif
