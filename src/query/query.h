// query.h - what the queries share: which pieces are seen, the list of what was found, checks.
#ifndef PL_QUERY_H
#define PL_QUERY_H

#include "broad/grid.h"
#include "plumb/math.h"
#include "world/wrap.h"

struct pl_walk;

// [m] points of rays, nearest queries and placed shapes: the world's bodies start within 1e9 m, and
// the squares that are taken of lengths beyond it still are numbers in the float build.
#define PL_QUERY_LIMIT ((plumb_real)1e12)

// [-] of the coordinates: a shape that was put where a cast ended is up to so much inside what it met.
#define PL_QUERY_TOUCH (4 * (double)PLUMB_REAL_EPSILON)

// A piece that answers a query. Overlaps use the shape alone.
typedef struct pl_query_hit {
    plumb_shape shape;
    plumb_body body;
    uint32_t piece;      // the shape's that was met
    plumb_real fraction; // [-] along the way; nearest: the distance [m]
    plumb_vec2 point;    // [m]
    plumb_vec2 normal;
    plumb_real depth; // [m] casts: of the overlap at the start
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
#define PL_QUERY_GRIDS 4
int pl_query_grids(const pl_query *q, const pl_grid *grids[static PL_QUERY_GRIDS]);

// False for the pieces of the ignored body, sensors, categories that are not asked for. All but
// filter.accept, which is asked last, about hits.
bool pl_query_sees(const pl_query *q, uint32_t piece);
bool pl_query_accepts(const pl_query *q, plumb_shape shape);

// filter.one_way: whether a piece that lets things pass in one direction lets pass what comes to it at
// a surface of this normal (zero: from inside).
bool pl_query_passes(const pl_query *q, uint32_t piece, plumb_vec2 normal);

// The piece as queries see it, in the frame of its body: inner cuts of an outline are moved out by
// a few roundings, so that no ray and no point slips between two pieces.
void pl_query_convex(const plumb_world *world, uint32_t piece, plumb_convex *out);

// Frame of the piece's body, by the image of the piece that is nearest to a point; of an entry: where that is.
plumb_transform pl_query_frame(const plumb_world *world, uint32_t piece, plumb_vec2 about);
plumb_transform pl_query_frame_of(const plumb_world *world, const pl_grid_entry *entry);
// pl_walk_grid by every image that the walk meets; entries as pl_world_query hands them out.
bool pl_query_walk(const pl_query *q, const pl_grid *grid, struct pl_walk *walk,
                   pl_grid_visit *visit, void *context);

// In a world that wraps around, a way or a box of this size [m] goes over an edge PL_QUERY_PERIODS times at
// most. E_RANGE.
#define PL_QUERY_PERIODS 8
plumb_result pl_query_check_reach(const plumb_world *world, const char *function, const char *what,
                                  double x, double y);

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

// Within PL_QUERY_LIMIT; false for NaN.
static inline bool pl_query_is_near(plumb_vec2 p)
{
    return plumb_abs(p.x) <= PL_QUERY_LIMIT && plumb_abs(p.y) <= PL_QUERY_LIMIT;
}

// A box around a point.
pl_box pl_query_box_at(plumb_vec2 point, double half);

// Checks of arguments; see world/check.h for the messages.
// Of `count` questions (`field` in the messages), which have room for as many hits.
plumb_result pl_query_check_lists(const plumb_world *world, const char *function, int count,
                                  const char *field, const void *asked, const void *hits);
// `prefix` stands before the names of fields: "", or "casts[3].". A null world: no message.
plumb_result pl_query_check_convex(const plumb_world *world, const char *function,
                                   const char *prefix, const plumb_convex *convex);
plumb_result pl_query_check_transform(const plumb_world *world, const char *function,
                                      const char *prefix, plumb_transform t);
#define PL_QUERY_FIELD 64 // characters of a field's name
const char *pl_query_field(char buffer[PL_QUERY_FIELD], const char *prefix, const char *name);
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
