// kernels.simd.c - the table of this width's narrow-phase kernels.
#include "core/wide.h"
#include "narrow/narrow.h"

#define DECLARE(name)                                                                              \
    void PL_WIDE_NAME(pl_##name)(const pl_narrow_input *in, uint32_t first, uint32_t count,        \
                                 int kind_b, pl_narrow *out);

DECLARE(circle)
DECLARE(circle_convex)
DECLARE(box_box)
DECLARE(convex_convex)

const pl_narrow_kernels PL_WIDE_NAME(pl_narrow_kernels) = {
    .circle = PL_WIDE_NAME(pl_circle),
    .circle_convex = PL_WIDE_NAME(pl_circle_convex),
    .box_box = PL_WIDE_NAME(pl_box_box),
    .convex_convex = PL_WIDE_NAME(pl_convex_convex),
};
