// cast.c - what a convex shape meets on its way along a translation: the first shape, any, or all of
// them; many casts in one call.
//
// Every piece whose fat box the moving box crosses is asked with a ray against the sum of both
// shapes (sweep.h), in double, relative to where the moved shape starts: exact to rounding, however
// far from the origin. The first hit so far ends the walk through the grid where it lies.
//
// Reads: grids, pieces, poses. Writes: the answer. Cost: cells under the way + O(corners) a box met.
#include "query/seek.h"
#include "query/sweep.h"
#include "world/check.h"

#include <math.h>
#include <stdio.h>

typedef struct caster {
    pl_seek seek;      // comes first
    pl_round mover;    // relative to `origin`
    plumb_vec2 origin; // [m]
    double dx, dy;     // [m] the way
    double touch;      // [m] overlaps up to this are touches
} caster;

// `hit`: fraction, normal, depth.
static bool meets_piece(const pl_seek *seek, const pl_grid_entry *entry, pl_query_hit *hit)
{
    const caster *c = (const caster *)(const void *)seek;
    const uint32_t piece = entry->piece;
    plumb_convex convex;
    pl_round fixed;
    pl_sum sum;
    pl_sum_hit met;
    pl_query_convex(c->seek.q.world, piece, &convex);
    pl_round_make(&convex, pl_query_frame_of(c->seek.q.world, entry), c->origin, &fixed);
    pl_sum_make(&fixed, &c->mover, &sum);
    if (!pl_sum_cast(&sum, 0, 0, c->dx, c->dy, c->touch, &met)) {
        return false;
    }
    *hit = pl_query_hit_of(c->seek.q.world, piece);
    hit->fraction = (plumb_real)met.fraction;
    hit->normal = plumb_v2((plumb_real)met.nx, (plumb_real)met.ny);
    hit->depth = (plumb_real)met.depth;
    double x, y;
    pl_round_touch(&fixed, &c->mover, met.fraction * c->dx, met.fraction * c->dy, met.nx, met.ny,
                   &x, &y);
    hit->point =
        plumb_v2((plumb_real)((double)c->origin.x + x), (plumb_real)((double)c->origin.y + y));
    return !pl_query_passes(&c->seek.q, piece, met.depth > 0 ? plumb_v2(0, 0) : hit->normal);
}

// `prefix`: see pl_query_check_convex.
static plumb_result check_cast(const plumb_world *world, const char *function, const char *prefix,
                               const plumb_cast *cast)
{
    char buffer[PL_QUERY_FIELD];
    PL_TRY(pl_query_check_convex(world, function, prefix, cast->convex));
    PL_TRY(pl_query_check_transform(world, function, prefix, cast->transform));
    const char *name = pl_query_field(buffer, prefix, "translation");
    return pl_check_within(world, function, name, cast->translation, PL_QUERY_LIMIT);
}

static plumb_result check_reach(const plumb_world *world, const char *function, const char *prefix,
                                const plumb_cast *cast)
{
    char buffer[PL_QUERY_FIELD];
    plumb_aabb box = plumb_convex_aabb(cast->convex, cast->transform);
    return pl_query_check_reach(
        world, function, pl_query_field(buffer, prefix, "translation with the shape"),
        fabs((double)cast->translation.x) + (double)box.max.x - (double)box.min.x,
        fabs((double)cast->translation.y) + (double)box.max.y - (double)box.min.y);
}

static void aim(caster *c, const plumb_cast *cast)
{
    plumb_aabb box = plumb_convex_aabb(cast->convex, cast->transform);
    c->origin = cast->transform.p;
    c->dx = (double)cast->translation.x;
    c->dy = (double)cast->translation.y;
    c->seek.meets = meets_piece;
    c->seek.walk = pl_walk_make_box(box, cast->translation);
    c->touch = PL_QUERY_TOUCH * (fabs(c->seek.walk.ox) + fabs(c->seek.walk.oy) +
                                 c->seek.walk.half_x + c->seek.walk.half_y);
    pl_round_make(cast->convex, cast->transform, c->origin, &c->mover);
}

static plumb_result begin(caster *c, plumb_world *world, const char *function,
                          const plumb_cast *cast, const plumb_query_filter *filter)
{
    PL_TRY(pl_check_pointer(world, function, "cast", cast));
    PL_TRY(check_cast(world, function, "", cast));
    PL_TRY(pl_is_wrapped(world) ? check_reach(world, function, "", cast) : PLUMB_OK);
    PL_TRY(pl_query_begin(&c->seek.q, world, function, filter));
    aim(c, cast);
    return PLUMB_OK;
}

static plumb_cast_hit public_hit(const pl_query_hit *hit)
{
    return (plumb_cast_hit){ hit->shape,  hit->body,     hit->point,
                             hit->normal, hit->fraction, hit->depth };
}

bool plumb_world_cast(plumb_world *world, const plumb_cast *cast, const plumb_query_filter *filter,
                      plumb_cast_hit *hit)
{
    caster c;
    if (world == NULL || pl_check_pointer(world, __func__, "hit", hit) != PLUMB_OK ||
        begin(&c, world, __func__, cast, filter) != PLUMB_OK) {
        return false;
    }
    if (!pl_seek_first(&c.seek)) {
        return false;
    }
    *hit = public_hit(&c.seek.first);
    return true;
}

bool plumb_world_cast_any(plumb_world *world, const plumb_cast *cast,
                          const plumb_query_filter *filter)
{
    caster c;
    if (world == NULL || begin(&c, world, __func__, cast, filter) != PLUMB_OK) {
        return false;
    }
    return pl_seek_any(&c.seek);
}

int plumb_world_cast_all(plumb_world *world, const plumb_cast *cast,
                         const plumb_query_filter *filter, plumb_cast_hit *hits, int capacity)
{
    caster c;
    if (world == NULL ||
        pl_query_check_output(world, __func__, "hits", hits, capacity) != PLUMB_OK ||
        begin(&c, world, __func__, cast, filter) != PLUMB_OK) {
        return -1;
    }
    pl_seek_all(&c.seek);
    int count = (int)c.seek.q.count;
    for (int i = 0; i < count && i < capacity; ++i) {
        hits[i] = public_hit(&c.seek.q.hits[i]);
    }
    return pl_query_end(&c.seek.q) == PLUMB_OK ? count : -1;
}

//---- many in one call ----------------------------------------------------------------------------

static plumb_result check_casts(const plumb_world *world, const char *function,
                                const plumb_cast *casts, int count, const plumb_cast_hit *hits)
{
    PL_TRY(pl_query_check_lists(world, function, count, "casts", casts, hits));
    for (int i = 0; i < count; ++i) {
        bool refused = check_cast(NULL, function, "", &casts[i]) != PLUMB_OK;
        if (refused || pl_is_wrapped(world)) {
            char prefix[24];
            snprintf(prefix, sizeof prefix, "casts[%d].", i);
            PL_TRY(refused ? check_cast(world, function, prefix, &casts[i])
                           : check_reach(world, function, prefix, &casts[i]));
        }
    }
    return PLUMB_OK;
}

int plumb_world_cast_batch(plumb_world *world, const plumb_cast *casts, int count,
                           const plumb_query_filter *filter, plumb_cast_hit *hits)
{
    caster c;
    if (world == NULL || check_casts(world, __func__, casts, count, hits) != PLUMB_OK ||
        pl_query_begin(&c.seek.q, world, __func__, filter) != PLUMB_OK) {
        return -1;
    }
    int met = 0;
    for (int i = 0; i < count; ++i) {
        aim(&c, &casts[i]);
        bool meets = pl_seek_first(&c.seek);
        hits[i] = meets ? public_hit(&c.seek.first) : (plumb_cast_hit){ .fraction = 1 };
        met += meets;
    }
    return met;
}
