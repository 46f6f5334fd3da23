// narrow.c - which kernel serves which kinds, and the narrow phase as a whole.
//
// Reads: pairs, poses, geometry, materials. Writes: manifolds, the pairs' features and flags.
// Order: after the broad phase, before the solver. Cost: O(pairs).
#include "narrow/narrow.h"
#include "narrow/surface.h"
#include "world/wrap.h"

static const pl_narrow_kernels *kernels_of(int width)
{
    switch (width) {
    case 16:
        return &pl_narrow_kernels_w16;
    case 8:
        return &pl_narrow_kernels_w8;
    default:
        return &pl_narrow_kernels_w4;
    }
}

// The matrix: rows kind of A, columns kind of B >= kind of A (pairs are stored so).
static pl_narrow_kernel *kernel_for(const pl_narrow_kernels *k, int a, int b)
{
    // clang-format off
    pl_narrow_kernel *const matrix[PL_PIECE_KIND_COUNT][PL_PIECE_KIND_COUNT] = {
        //                    free  circle            capsule            box               polygon
        [PL_PIECE_CIRCLE]  = { NULL, k->circle_circle, k->circle_capsule, k->circle_box,    k->circle_convex },
        [PL_PIECE_CAPSULE] = { NULL, NULL,             k->convex_convex,  k->convex_convex, k->convex_convex },
        [PL_PIECE_BOX]     = { NULL, NULL,             NULL,              k->box_box,       k->convex_convex },
        [PL_PIECE_POLYGON] = { NULL, NULL,             NULL,              NULL,             k->convex_convex },
    };
    // clang-format on
    return matrix[a][b];
}

bool pl_narrow_reserve(plumb_world *world, const pl_pair_list *list, pl_narrow *narrow)
{
    return pl_buffer_reserve(&world->memory, &narrow->manifolds,
                             ((size_t)list->count + 1) * sizeof(pl_manifold));
}

void pl_narrow_run(plumb_world *world, const pl_pair_list *list, real dt, pl_narrow *narrow)
{
    const pl_narrow_kernels *kernels = kernels_of(world->desc.simd_width);
    pl_narrow_input in = { .poses = (const real *)world->poses.data,
                           .cores = world->pieces.core,
                           .vertices = world->vertices.items,
                           .vertex_first = world->pieces.vertices,
                           .vertex_count = world->pieces.vertex_count,
                           .friction = world->pieces.friction,
                           .restitution = world->pieces.restitution,
                           .dt = dt,
                           .elastic_above = pl_restitution_is_mixed(world) ? -1 : 0,
                           .pairs = pl_pairs(list),
                           .wrapped = pl_is_wrapped(world),
                           .wrap_x = world->desc.wrap_x,
                           .wrap_y = world->desc.wrap_y };
    *narrow = (pl_narrow){ .manifolds = narrow->manifolds };
    for (int a = PL_PIECE_CIRCLE; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = a; b < PL_PIECE_KIND_COUNT; ++b) {
            if (list->size[a][b] > 0) {
                kernel_for(kernels, a, b)(&in, list->first[a][b], list->size[a][b], narrow);
            }
        }
    }
}

static void take_out(pl_pair *pair, uint32_t flag)
{
    pair->manifold = PL_NONE;
    pair->flags |= flag;
    pair->rolling = 0;
    for (int k = 0; k < 2; ++k) {
        pair->feature[k] = PL_NONE;
        pair->normal[k] = pair->tangent[k] = 0;
    }
}

void pl_narrow_take_out_disabled(plumb_world *world, uint32_t flag)
{
    pl_narrow *narrow = &world->narrow;
    pl_manifold *m = pl_manifolds(narrow);
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    uint32_t kept = 0, count = narrow->manifold_count;
    for (uint32_t i = 0; i < count; ++i) {
        if (m[i].disabled) {
            take_out(&pairs[m[i].pair], flag);
            continue;
        }
        pairs[m[i].pair].manifold = kept;
        if (kept != i) {
            m[kept] = m[i];
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

void pl_narrow_free(pl_memory *memory, pl_narrow *narrow)
{
    pl_buffer_free(memory, &narrow->manifolds);
    *narrow = (pl_narrow){ 0 };
}
