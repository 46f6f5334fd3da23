// ray.c - what a ray meets: the first shape, any, or all of them; many rays in one call.
//
// Every piece whose fat box the ray crosses is asked with the ray in the frame of the piece's body.
// The first hit so far ends the walk through the grid where it lies.
//
// Reads: grids, pieces, poses. Writes: the answer. Cost: cells along the ray + O(corners) a box
// met.
#include "query/seek.h"
#include "world/check.h"

#include <math.h>
#include <stdio.h>

typedef struct raycast {
    pl_seek seek; // comes first
    plumb_vec2 from, to;
} raycast;

// The ray against one piece, in world coordinates.
static bool meets_piece(const pl_seek *seek, const pl_grid_entry *entry, pl_query_hit *hit)
{
    const raycast *c = (const raycast *)(const void *)seek;
    const uint32_t piece = entry->piece;
    plumb_convex convex;
    plumb_convex_hit local;
    plumb_transform frame = pl_query_frame_of(c->seek.q.world, entry);
    plumb_vec2 along = plumb_rot_inv_apply(frame.q, plumb_vec2_sub(c->to, c->from));
    pl_query_convex(c->seek.q.world, piece, &convex);
    if (!plumb_convex_ray(&convex, plumb_transform_inv_apply(frame, c->from), along, &local)) {
        return false;
    }
    *hit = pl_query_hit_of(c->seek.q.world, piece);
    hit->fraction = local.fraction;
    bool inside = local.normal.x == 0 && local.normal.y == 0;
    hit->point = inside ? c->from : plumb_transform_apply(frame, local.point);
    hit->normal = plumb_rot_apply(frame.q, local.normal);
    return !pl_query_passes(&c->seek.q, piece, hit->normal);
}

static plumb_result check_length(const plumb_world *world, const char *function, const char *what,
                                 plumb_vec2 from, plumb_vec2 to)
{
    return pl_query_check_reach(world, function, what, fabs((double)to.x - (double)from.x),
                                fabs((double)to.y - (double)from.y));
}

static plumb_result check_ray(const plumb_world *world, const char *function, plumb_vec2 from,
                              plumb_vec2 to)
{
    PL_TRY(pl_check_within(world, function, "from", from, PL_QUERY_LIMIT));
    PL_TRY(pl_check_within(world, function, "to", to, PL_QUERY_LIMIT));
    return check_length(world, function, "the ray", from, to);
}

static void aim(raycast *c, plumb_vec2 from, plumb_vec2 to)
{
    c->from = from;
    c->to = to;
    c->seek.meets = meets_piece;
    c->seek.walk = pl_walk_make(from, to);
}

static plumb_result begin(raycast *c, plumb_world *world, const char *function, plumb_vec2 from,
                          plumb_vec2 to, const plumb_query_filter *filter)
{
    PL_TRY(check_ray(world, function, from, to));
    PL_TRY(pl_query_begin(&c->seek.q, world, function, filter));
    aim(c, from, to);
    return PLUMB_OK;
}

static plumb_ray_hit public_hit(const pl_query_hit *hit)
{
    return (plumb_ray_hit){ hit->shape, hit->body, hit->point, hit->normal, hit->fraction };
}

bool plumb_world_ray(plumb_world *world, plumb_vec2 from, plumb_vec2 to,
                     const plumb_query_filter *filter, plumb_ray_hit *hit)
{
    raycast c;
    if (world == NULL || pl_check_pointer(world, __func__, "hit", hit) != PLUMB_OK ||
        begin(&c, world, __func__, from, to, filter) != PLUMB_OK) {
        return false;
    }
    if (!pl_seek_first(&c.seek)) {
        return false;
    }
    *hit = public_hit(&c.seek.first);
    return true;
}

int plumb_world_ray_all(plumb_world *world, plumb_vec2 from, plumb_vec2 to,
                        const plumb_query_filter *filter, plumb_ray_hit *hits, int capacity)
{
    raycast c;
    if (world == NULL ||
        pl_query_check_output(world, __func__, "hits", hits, capacity) != PLUMB_OK ||
        begin(&c, world, __func__, from, to, filter) != PLUMB_OK) {
        return -1;
    }
    pl_seek_all(&c.seek);
    int count = (int)c.seek.q.count;
    for (int i = 0; i < count && i < capacity; ++i) {
        hits[i] = public_hit(&c.seek.q.hits[i]);
    }
    return pl_query_end(&c.seek.q) == PLUMB_OK ? count : -1;
}

bool plumb_world_ray_any(plumb_world *world, plumb_vec2 from, plumb_vec2 to,
                         const plumb_query_filter *filter)
{
    raycast c;
    if (world == NULL || begin(&c, world, __func__, from, to, filter) != PLUMB_OK) {
        return false;
    }
    return pl_seek_any(&c.seek);
}

//---- many in one call ----------------------------------------------------------------------------

static plumb_result check_rays(const plumb_world *world, const char *function,
                               const plumb_ray *rays, int count, const plumb_ray_hit *hits)
{
    PL_TRY(pl_query_check_lists(world, function, count, "rays", rays, hits));
    for (int i = 0; i < count; ++i) {
        if (!pl_query_is_near(rays[i].from) || !pl_query_is_near(rays[i].to)) {
            char from[32], to[32];
            snprintf(from, sizeof from, "rays[%d].from", i);
            snprintf(to, sizeof to, "rays[%d].to", i);
            PL_TRY(pl_check_within(world, function, from, rays[i].from, PL_QUERY_LIMIT));
            PL_TRY(pl_check_within(world, function, to, rays[i].to, PL_QUERY_LIMIT));
        }
        if (pl_is_wrapped(world)) {
            char ray[32];
            snprintf(ray, sizeof ray, "rays[%d]", i);
            PL_TRY(check_length(world, function, ray, rays[i].from, rays[i].to));
        }
    }
    return PLUMB_OK;
}

int plumb_world_ray_batch(plumb_world *world, const plumb_ray *rays, int count,
                          const plumb_query_filter *filter, plumb_ray_hit *hits)
{
    raycast c;
    if (world == NULL || check_rays(world, __func__, rays, count, hits) != PLUMB_OK ||
        pl_query_begin(&c.seek.q, world, __func__, filter) != PLUMB_OK) {
        return -1;
    }
    int met = 0;
    for (int i = 0; i < count; ++i) {
        aim(&c, rays[i].from, rays[i].to);
        bool meets = pl_seek_first(&c.seek);
        hits[i] = meets ? public_hit(&c.seek.first) : (plumb_ray_hit){ .fraction = 1 };
        met += meets;
    }
    return met;
}
