// query.c - what the queries share: the filter, the list of hits, its order.
//
// A query goes through the grids with a box or a ray, asks plumb_convex_* about every piece that it
// meets there, and keeps a hit for each piece that answers. Shapes of several pieces come out once.
//
// Reads: grids, pieces, poses, the filter. Writes: grids of the queries' own (broad/query_grids.h), the
// query's own list. Cost: sorting is O(hits log hits); no allocation for PL_QUERY_NEAR_HITS or
// fewer.
#include "query/query.h"

#include "world/filter.h"
#include "broad/query_grids.h"
#include "broad/images.h"
#include "query/walk.h"
#include "world/check.h"

#include <stdio.h>
#include <string.h>

//---- begin -------------------------------------------------------------------------------------

plumb_result pl_query_begin(pl_query *q, plumb_world *world, const char *function,
                            const plumb_query_filter *filter)
{
    q->world = world;
    q->function = function;
    q->filter = filter != NULL ? *filter : (plumb_query_filter){ 0 };
    q->hits = q->near_hits;
    q->count = 0;
    q->capacity = PL_QUERY_NEAR_HITS;
    q->out_of_memory = false;
    q->buffer = (pl_buffer){ 0 };
    plumb_body ignored = q->filter.ignore_body;
    if (!plumb_is_null(ignored) && pl_body_row(world, ignored) == PL_NONE) {
        return pl_fail_handle(world, function, "filter.ignore_body", ignored.entity,
                              "a live body or null");
    }
    return pl_query_grids_update(world) ? PLUMB_OK : pl_fail_memory(world, function);
}

plumb_result pl_query_check_output(const plumb_world *world, const char *function,
                                   const char *field, const void *output, int capacity)
{
    if (capacity < 0) {
        return pl_fail(world, PLUMB_E_RANGE, function, "capacity is %d; it must be at least 0",
                       capacity);
    }
    return capacity == 0 ? PLUMB_OK : pl_check_pointer(world, function, field, output);
}

plumb_result pl_query_check_lists(const plumb_world *world, const char *function, int count,
                                  const char *field, const void *asked, const void *hits)
{
    if (count <= 0) {
        return count == 0 ? PLUMB_OK
                          : pl_fail(world, PLUMB_E_RANGE, function,
                                    "count is %d; it must be at least 0", count);
    }
    PL_TRY(pl_check_pointer(world, function, field, asked));
    return pl_check_pointer(world, function, "hits", hits);
}

const char *pl_query_field(char buffer[PL_QUERY_FIELD], const char *prefix, const char *name)
{
    if (prefix[0] == '\0') {
        return name;
    }
    snprintf(buffer, PL_QUERY_FIELD, "%s%s", prefix, name);
    return buffer;
}

plumb_result pl_query_check_convex(const plumb_world *world, const char *function,
                                   const char *prefix, const plumb_convex *convex)
{
    char buffer[PL_QUERY_FIELD];
    const char *name = pl_query_field(buffer, prefix, "convex");
    PL_TRY(pl_check_pointer(world, function, name, convex));
    if (convex->count < 1 || convex->count > PLUMB_POLYGON_MAX_VERTICES) {
        return pl_fail(world, PLUMB_E_RANGE, function, "%s.count is %d; it must be 1 to %d", name,
                       convex->count, PLUMB_POLYGON_MAX_VERTICES);
    }
    for (int i = 0; i < convex->count; ++i) {
        plumb_vec2 p = convex->points[i];
        if (!(plumb_abs(p.x) <= PLUMB_LENGTH_MAX && plumb_abs(p.y) <= PLUMB_LENGTH_MAX)) {
            char field[PL_QUERY_FIELD + 24];
            snprintf(field, sizeof field, "%s.points[%d]", name, i);
            return pl_check_within(world, function, field, p, PLUMB_LENGTH_MAX);
        }
    }
    name = pl_query_field(buffer, prefix, "convex.radius");
    return pl_check_range(world, function, name, convex->radius, 0, PLUMB_LENGTH_MAX);
}

plumb_result pl_query_check_transform(const plumb_world *world, const char *function,
                                      const char *prefix, plumb_transform t)
{
    char buffer[PL_QUERY_FIELD];
    const char *name = pl_query_field(buffer, prefix, "transform.p");
    PL_TRY(pl_check_within(world, function, name, t.p, PL_QUERY_LIMIT));
    plumb_vec2 q = { t.q.c, t.q.s };
    name = pl_query_field(buffer, prefix, "transform.q");
    PL_TRY(pl_check_finite_vec(world, function, name, q));
    if (!plumb_rot_is_unit(t.q)) {
        return pl_fail(world, PLUMB_E_RANGE, function, "%s is (%g, %g); it must be a unit rotation",
                       name, (double)t.q.c, (double)t.q.s);
    }
    return PLUMB_OK;
}

pl_box pl_query_box_at(plumb_vec2 point, double half)
{
    plumb_real h = (plumb_real)half;
    return (pl_box){ point.x - h, point.y - h, point.x + h, point.y + h };
}

//---- filter ------------------------------------------------------------------------------------

int pl_query_grids(const pl_query *q, const pl_grid *grids[static PL_QUERY_GRIDS])
{
    int count = 0;
    if (!q->filter.ignore_dynamic) {
        grids[count++] = pl_query_grid_of(q->world, PL_QUERY_MOVING);
        const pl_grid *resting = pl_query_grid_of(q->world, PL_QUERY_RESTING);
        if (resting->entry_count > 0) {
            grids[count++] = resting;
        }
    }
    if (!q->filter.ignore_static) {
        grids[count++] = pl_query_grid_of(q->world, PL_QUERY_FIXED);
    }
    if (q->world->query_grids.stray_count > 0) {
        grids[count++] = pl_query_grid_of(q->world, PL_QUERY_STRAYS);
    }
    return count;
}

// The grid of sleeping pieces may name one that woke, which another grid has, and every grid one that is gone, out of the
// simulation or of another type by now; that of the strays has all types.
static bool is_there(const plumb_world *world, uint32_t piece, const plumb_query_filter *f)
{
    const uint32_t place = world->pieces.moving[piece];
    return world->pieces.kind[piece] != PL_PIECE_FREE && place != PL_OUT &&
           !(place == PL_NONE ? f->ignore_static : f->ignore_dynamic);
}

bool pl_query_sees(const pl_query *q, uint32_t piece)
{
    const plumb_world *world = q->world;
    const plumb_query_filter *f = &q->filter;
    const bool may_be_gone = world->sleep.gone > 0 || world->query_grids.stray_count > 0;
    if (may_be_gone && !is_there(world, piece, f)) {
        return false;
    }
    if (world->sensor_pieces + world->filtered_pieces > 0 || f->mask != 0) {
        const pl_pieces *pieces = &world->pieces;
        if ((!f->sensors && (pieces->flags[piece] & PL_PIECE_SENSOR) != 0) ||
            (f->mask != 0 && (f->mask & pieces->category[piece]) == 0) ||
            (f->category != 0 && (f->category & pieces->mask[piece]) == 0)) {
            return false;
        }
    }
    if (plumb_is_null(f->ignore_body)) {
        return true;
    }
    return !plumb_same(world->bodies.entity[world->pieces.body[piece]], q->filter.ignore_body);
}

bool pl_query_passes(const pl_query *q, uint32_t piece, plumb_vec2 normal)
{
    return q->filter.one_way && (q->world->pieces.flags[piece] & PL_PIECE_ONE_WAY) != 0 &&
           !pl_one_way_blocks(q->world, piece, normal, 0);
}

bool pl_query_accepts(const pl_query *q, plumb_shape shape)
{
    return q->filter.accept == NULL || q->filter.accept(q->filter.context, shape);
}

//---- pieces ------------------------------------------------------------------------------------

void pl_query_convex(const plumb_world *world, uint32_t piece, plumb_convex *out)
{
    pl_piece_convex(world, piece, out);
    uint32_t cuts = world->pieces.cuts[piece];
    // The pieces on both sides of a cut see a point in the same place; their distances from it
    // differ by the rounding of two dot products and of the normals.
    plumb_real margin = 4 * PLUMB_REAL_EPSILON * world->pieces.core[piece].reach;
    for (int k = 0; cuts != 0; ++k, cuts >>= 1) {
        if (cuts & 1u) {
            plumb_vec2 *a = &out->points[k];
            plumb_vec2 *b = &out->points[k + 1 == out->count ? 0 : k + 1];
            *a = plumb_vec2_add_scaled(*a, margin, out->normals[k]);
            *b = plumb_vec2_add_scaled(*b, margin, out->normals[k]);
        }
    }
}

plumb_transform pl_query_frame(const plumb_world *world, uint32_t piece, plumb_vec2 about)
{
    const pl_pose *pose = &pl_poses(world)[world->pieces.body[piece]];
    plumb_transform frame = { { pose->x, pose->y }, { pose->c, pose->s } };
    if (pl_is_wrapped(world)) {
        pl_shift s = pl_wrap_piece(world, piece, (double)about.x, (double)about.y);
        frame.p =
            plumb_v2((plumb_real)((double)pose->x + s.x), (plumb_real)((double)pose->y + s.y));
    }
    return frame;
}

plumb_transform pl_query_frame_of(const plumb_world *world, const pl_grid_entry *entry)
{
    const pl_box *box = &entry->box;
    plumb_vec2 middle = { box->min_x + (box->max_x - box->min_x) / 2,
                          box->min_y + (box->max_y - box->min_y) / 2 };
    return pl_query_frame(world, entry->piece, middle);
}

//---- grids ---------------------------------------------------------------------------------------

typedef struct image_walk {
    pl_grid_visit *visit;
    void *context;
    double x, y; // [m] from where an entry is filed to the image
    pl_walk *walk, *image;
} image_walk;

// The caller's walk is where it lowers the limit.
static bool visit_image(void *context, const pl_grid_entry *entry)
{
    const image_walk *w = context;
    pl_grid_entry at = *entry;
    at.box = (pl_box){ (plumb_real)((double)entry->box.min_x + w->x),
                       (plumb_real)((double)entry->box.min_y + w->y),
                       (plumb_real)((double)entry->box.max_x + w->x),
                       (plumb_real)((double)entry->box.max_y + w->y) };
    bool goes_on = w->visit(w->context, &at);
    w->image->limit = w->walk->limit;
    return goes_on;
}

bool pl_query_walk(const pl_query *q, const pl_grid *grid, pl_walk *walk, pl_grid_visit *visit,
                   void *context)
{
    if (!pl_is_wrapped(q->world)) {
        return pl_walk_grid(grid, walk, visit, context);
    }
    pl_images images = pl_images_of(q->world, grid, pl_walk_box(walk));
    for (int k = 0; k < images.columns * images.rows; ++k) {
        pl_shift to = pl_images_shift(&images, k);
        pl_walk image = *walk;
        image_walk w = { visit, context, to.x, to.y, walk, &image };
        image.ox -= w.x;
        image.oy -= w.y;
        if (!pl_walk_grid(grid, &image, visit_image, &w)) {
            return false;
        }
    }
    return true;
}

plumb_result pl_query_check_reach(const plumb_world *world, const char *function, const char *what,
                                  double x, double y)
{
    const double wrap_x = (double)world->desc.wrap_x, wrap_y = (double)world->desc.wrap_y;
    bool far_x = wrap_x > 0 && !(x <= PL_QUERY_PERIODS * wrap_x);
    bool far_y = wrap_y > 0 && !(y <= PL_QUERY_PERIODS * wrap_y);
    if (!far_x && !far_y) {
        return PLUMB_OK;
    }
    return pl_fail(world, PLUMB_E_RANGE, function,
                   "%s is %g m along %s; in a world that wraps every %g m it must be at most %g",
                   what, far_x ? x : y, far_x ? "x" : "y", far_x ? wrap_x : wrap_y,
                   PL_QUERY_PERIODS * (far_x ? wrap_x : wrap_y));
}

pl_query_hit pl_query_hit_of(const plumb_world *world, uint32_t piece)
{
    return (pl_query_hit){ .shape = world->pieces.shape[piece],
                           .body = world->bodies.entity[world->pieces.body[piece]],
                           .piece = piece };
}

//---- hits --------------------------------------------------------------------------------------

bool pl_query_add(pl_query *q, const pl_query_hit *hit)
{
    if (q->count == q->capacity) {
        size_t used = q->count * sizeof(pl_query_hit);
        if (!pl_buffer_reserve(&q->world->memory, &q->buffer, 2 * used)) {
            q->out_of_memory = true;
            return false;
        }
        if (q->hits == q->near_hits) {
            memcpy(q->buffer.data, q->near_hits, used);
        }
        q->hits = q->buffer.data;
        q->capacity *= 2;
    }
    q->hits[q->count++] = *hit;
    return true;
}

typedef bool before_fn(const pl_query_hit *a, const pl_query_hit *b);

// By slot; hits of one shape by fraction, then the deepest first, then by piece: in no case in the order of a grid,
// which is another one after an image was restored.
static bool before_by_slot(const pl_query_hit *a, const pl_query_hit *b)
{
    if (a->shape.entity.index != b->shape.entity.index) {
        return a->shape.entity.index < b->shape.entity.index;
    }
    if (a->fraction != b->fraction) {
        return a->fraction < b->fraction;
    }
    return a->depth != b->depth ? a->depth > b->depth : a->piece < b->piece;
}

static bool before_along(const pl_query_hit *a, const pl_query_hit *b)
{
    return a->fraction != b->fraction ? a->fraction < b->fraction
                                      : a->shape.entity.index < b->shape.entity.index;
}

// Lets the hit at `root` sink to its place in the heap of the first `count` hits.
static void sink(pl_query_hit *hits, uint32_t root, uint32_t count, before_fn *before)
{
    pl_query_hit sinking = hits[root];
    for (uint32_t child = 2 * root + 1; child < count; child = 2 * root + 1) {
        if (child + 1 < count && before(&hits[child], &hits[child + 1])) {
            ++child;
        }
        if (!before(&sinking, &hits[child])) {
            break;
        }
        hits[root] = hits[child];
        root = child;
    }
    hits[root] = sinking;
}

// Heap sort (Williams 1964): in place, and unlike qsort of the C library sure not to allocate.
static void sort_hits(pl_query *q, before_fn *before)
{
    pl_query_hit *hits = q->hits;
    for (uint32_t root = q->count / 2; root-- > 0;) {
        sink(hits, root, q->count, before);
    }
    for (uint32_t last = q->count; last-- > 1;) {
        pl_query_hit largest = hits[0];
        hits[0] = hits[last];
        hits[last] = largest;
        sink(hits, 0, last, before);
    }
}

void pl_query_one_per_shape(pl_query *q)
{
    sort_hits(q, before_by_slot);
    uint32_t kept = 0;
    uint32_t last = PL_NONE; // slot that was asked about last
    for (uint32_t i = 0; i < q->count; ++i) {
        uint32_t slot = q->hits[i].shape.entity.index;
        if (slot != last && pl_query_accepts(q, q->hits[i].shape)) {
            q->hits[kept++] = q->hits[i];
        }
        last = slot;
    }
    q->count = kept;
}

void pl_query_sort_along(pl_query *q)
{
    sort_hits(q, before_along);
}

plumb_result pl_query_end(pl_query *q)
{
    pl_buffer_free(&q->world->memory, &q->buffer);
    return q->out_of_memory ? pl_fail_memory(q->world, q->function) : PLUMB_OK;
}
