// narrow.c - which kernel serves which kinds, and the narrow phase as a whole.
//
// Reads: pairs, poses, geometry, materials. Writes: manifolds, the pairs' features and flags.
// Order: after the broad phase, before the solver. Cost: O(pairs).
#include "narrow/narrow.h"

#include "core/quad.h"
#include "narrow/ahead.h"
#include "narrow/surface.h"
#include "world/wrap.h"

#include <string.h>

// The matrix: rows kind of A, columns kind of B >= kind of A (pairs are stored so).
pl_narrow_kernel *pl_narrow_kernel_for(int width, int a, int b)
{
    const pl_narrow_kernels *k = width == 16  ? &pl_narrow_kernels_w16
                                 : width == 8 ? &pl_narrow_kernels_w8
                                              : &pl_narrow_kernels_w4;
    // clang-format off
    pl_narrow_kernel *const matrix[PL_PIECE_KIND_COUNT][PL_PIECE_KIND_COUNT] = {
        //                    free  circle     capsule           box               polygon
        [PL_PIECE_CIRCLE]  = { NULL, k->circle, k->circle,        k->circle,        k->circle_convex },
        [PL_PIECE_CAPSULE] = { NULL, NULL,      k->convex_convex, k->convex_convex, k->convex_convex },
        [PL_PIECE_BOX]     = { NULL, NULL,      NULL,             k->box_box,       k->convex_convex },
        [PL_PIECE_POLYGON] = { NULL, NULL,      NULL,             NULL,             k->convex_convex },
    };
    // clang-format on
    return matrix[a][b];
}

bool pl_narrow_reserve(plumb_world *world, const pl_pair_list *list, pl_narrow *narrow)
{
    const size_t count = (size_t)list->count + 1, size = count * sizeof(pl_manifold);
    return pl_buffer_reserve(&world->memory, &narrow->manifolds, size) &&
           pl_buffer_reserve(&world->memory, &narrow->ends, count * sizeof(pl_ends)) &&
           pl_buffer_reserve(&world->memory, &narrow->fresh, count * sizeof(uint32_t)) &&
           pl_buffer_reserve(&world->memory, &narrow->candidates, count * sizeof(uint32_t)) &&
           pl_buffer_reserve(&world->memory, &narrow->chains,
                             (count + 2 * (size_t)world->dynamic_count) * sizeof(uint32_t)) &&
           (pl_tasks_workers(world->tasks) == 1 ||
            pl_buffer_reserve(&world->memory, &narrow->staged, size));
}

//---- shares --------------------------------------------------------------------------------------

// Fewer pairs than this are not worth a thread.
#define LEAST 128

// A thread's part of the list: pairs in order, so that manifolds put together share after share are
// those of one thread.
typedef struct share {
    pl_share pairs;
    uint32_t at; // where its manifolds come in the end
    pl_narrow made;
} share;

typedef struct job {
    int width; // of the kernels
    const pl_narrow_input *in;
    const pl_pair_list *list;
    pl_manifold *manifolds;
    pl_ends *ends;
    uint32_t count;
    share *shares;
} job;

// Kind by kind, as the list has them. The counts are kept apart from those of other threads meanwhile:
// in one cache line they would cost each thread as much again.
static void make_share(void *context, uint32_t i)
{
    job *j = context;
    share *s = &j->shares[i];
    pl_narrow made = s->made;
    for (int a = PL_PIECE_CIRCLE; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = a; b < PL_PIECE_KIND_COUNT; ++b) {
            uint32_t first = j->list->first[a][b], end = first + j->list->size[a][b];
            first = first > s->pairs.first ? first : s->pairs.first;
            end = end < s->pairs.end ? end : s->pairs.end;
            if (first < end) {
                pl_narrow_kernel_for(j->width, a, b)(j->in, first, end - first, b, &made);
            }
        }
    }
    s->made = made;
}

// Manifolds of these places, counted from the end of the first share, to where they belong, and their ends;
// the pairs are told.
static void place(void *context, uint32_t first, uint32_t count)
{
    const job *j = context;
    first += j->shares[0].made.manifold_count;
    for (uint32_t i = 1; i < j->count; ++i) {
        const share *s = &j->shares[i];
        uint32_t from = s->at > first ? s->at : first;
        uint32_t end = s->at + s->made.manifold_count;
        end = end < first + count ? end : first + count;
        for (uint32_t k = from; k < end; ++k) {
            j->manifolds[k] = pl_manifolds(&s->made)[k - s->at];
            j->ends[k] = (pl_ends){ j->manifolds[k].body_a, j->manifolds[k].body_b };
            j->in->pairs[j->manifolds[k].pair].manifold = k;
        }
    }
}

static void add_share(pl_narrow *all, const pl_narrow *made)
{
    for (uint32_t i = 0; i < made->candidate_count; ++i) {
        ((uint32_t *)all->candidates.data)[all->candidate_count + i] =
            ((const uint32_t *)made->candidates.data)[i] + all->manifold_count;
    }
    all->candidate_count += made->candidate_count;
    memmove((uint32_t *)all->fresh.data + all->fresh_count, made->fresh.data,
            made->fresh_count * sizeof(uint32_t));
    all->fresh_count += made->fresh_count;
    all->manifold_count += made->manifold_count;
    all->any_friction |= made->any_friction;
    all->any_elastic |= made->any_elastic;
    all->any_low |= made->any_low;
    pl_overlaps_add(&all->overlaps, &made->overlaps);
}

// The first share is made where it stays. Room for shares is not cleared: that would cost a small world more than
// its pairs do.
static void make_manifolds(plumb_world *world, const pl_narrow_input *in, const pl_pair_list *list,
                           pl_narrow *narrow)
{
    share shares[PLUMB_WORKERS_MAX];
    job j = { .width = world->desc.simd_width,
              .in = in,
              .list = list,
              .manifolds = pl_manifolds(narrow),
              .ends = narrow->ends.data,
              .count = pl_tasks_share_count(world->tasks, list->count, LEAST),
              .shares = shares };
    for (uint32_t i = 0; i < j.count; ++i) {
        share *s = &shares[i];
        *s = (share){ .pairs = pl_share_of(list->count, j.count, i) };
        s->made.manifolds.data =
            i == 0 ? j.manifolds : (pl_manifold *)narrow->staged.data + s->pairs.first;
        s->made.ends.data = j.ends + s->pairs.first;
        s->made.fresh.data = (uint32_t *)narrow->fresh.data + s->pairs.first;
        s->made.candidates.data = (uint32_t *)narrow->candidates.data + s->pairs.first;
    }
    pl_tasks_run(world->tasks, make_share, &j, j.count);
    for (uint32_t i = 0; i < j.count; ++i) {
        shares[i].at = narrow->manifold_count;
        add_share(narrow, &shares[i].made);
    }
    uint32_t staged = narrow->manifold_count - shares[0].made.manifold_count;
    if (staged > 0) {
        pl_tasks_ranges(world->tasks, staged, LEAST, place, &j);
    }
}

// Whether gravity, the same for all, is all that acts on the bodies.
static bool flies_plainly(const plumb_world *world)
{
    const pl_bodies *b = &world->bodies;
    const pl_quad *fx = (const pl_quad *)b->fx, *fy = (const pl_quad *)b->fy;
    const pl_quad *torque = (const pl_quad *)b->torque;
    const pl_quad *gravity = (const pl_quad *)b->gravity_scale;
    const pl_quad zero = { 0 }, one = zero + 1;
    pl_quad_mask plain = (pl_quad_mask){ 0 } - 1;
    const uint32_t count = world->dynamic_count;
    for (uint32_t i = 0; i < count / 4; ++i) {
        plain &= (fx[i] == zero) & (fy[i] == zero) & (torque[i] == zero) & (gravity[i] == one);
    }
    bool all = world->settings.scaled == 0 && plain[0] && plain[1] && plain[2] && plain[3];
    for (uint32_t row = count - count % 4; row < count; ++row) {
        all = all && b->fx[row] == 0 && b->fy[row] == 0 && b->torque[row] == 0 &&
              b->gravity_scale[row] == 1;
    }
    return all;
}

bool pl_narrow_run(plumb_world *world, const pl_pair_list *list, real dt, pl_narrow *narrow)
{
    const double horizon = pl_ahead_horizon(world, dt), half = horizon * horizon / 2;
    const pl_narrow_input in = { .poses = (const real *)world->poses.data,
                                 .cores = world->pieces.core,
                                 .vertices = world->vertices.items,
                                 .vertex_first = world->pieces.vertices,
                                 .vertex_count = world->pieces.vertex_count,
                                 .friction = world->pieces.friction,
                                 .restitution = world->pieces.restitution,
                                 .dt = (near_real)dt,
                                 .elastic_above = pl_restitution_is_mixed(world) ? -1 : 0,
                                 .pairs = pl_pairs(list),
                                 .seeks = world->lookahead.sought_count > 0,
                                 .wrapped = pl_is_wrapped(world),
                                 .wrap_x = world->desc.wrap_x,
                                 .wrap_y = world->desc.wrap_y,
                                 .plain = flies_plainly(world),
                                 .dynamic_count = world->dynamic_count,
                                 .w = world->bodies.w,
                                 .extent = world->bodies.extent,
                                 .horizon = (near_real)horizon,
                                 .fall_x = (near_real)(half * (double)world->gravity.x),
                                 .fall_y = (near_real)(half * (double)world->gravity.y) };
    pl_narrow_clear(narrow);
    make_manifolds(world, &in, list, narrow);
    return pl_ahead_look(world, &in, dt, narrow);
}

void pl_narrow_take_out_disabled(plumb_world *world, uint32_t flag)
{
    pl_narrow *narrow = &world->narrow;
    pl_manifold *m = pl_manifolds(narrow);
    pl_ends *ends = narrow->ends.data;
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    uint32_t kept = 0, count = narrow->manifold_count;
    for (uint32_t i = 0; i < count; ++i) {
        if (m[i].disabled) {
            pl_pair *pair = &pairs[m[i].pair];
            pair->manifold = PL_NONE;
            pair->flags |= flag;
            pl_pair_forget(pair);
            continue;
        }
        pairs[m[i].pair].manifold = kept;
        if (kept != i) {
            m[kept] = m[i];
            ends[kept] = ends[i];
        }
        ++kept;
    }
    narrow->manifold_count = kept;
    for (uint32_t i = 0; i < narrow->borne_count && kept != count; ++i) { // those behind close up
        m[kept + i] = m[count + i];
        pairs[m[kept + i].pair].manifold = kept + i;
    }
    pl_narrow_summarise(narrow);
}

void pl_narrow_clear(pl_narrow *narrow)
{
    *narrow = (pl_narrow){ .manifolds = narrow->manifolds,
                           .staged = narrow->staged,
                           .ends = narrow->ends,
                           .fresh = narrow->fresh,
                           .candidates = narrow->candidates,
                           .chains = narrow->chains };
}

void pl_narrow_free(pl_memory *memory, pl_narrow *narrow)
{
    pl_buffer_free(memory, &narrow->manifolds);
    pl_buffer_free(memory, &narrow->staged);
    pl_buffer_free(memory, &narrow->ends);
    pl_buffer_free(memory, &narrow->chains);
    pl_buffer_free(memory, &narrow->fresh);
    pl_buffer_free(memory, &narrow->candidates);
    *narrow = (pl_narrow){ 0 };
}
