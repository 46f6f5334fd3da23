// fat.simd.c - tight boxes of W moving pieces at a time, and which of them have left their fat boxes.
//
// The bits are those of fat.c, piece by piece: a circle is a box without extents, a capsule one without height. Corners of
// polygons are gathered; lanes with fewer repeat their last one, which changes no minimum.
//
// Reads: poses, piece geometry, velocities. Writes: fat boxes, marks. Cost: O(moving pieces).
#include "broad/fat.h"
#include "core/wide.h"

// In the far build places are wider than lanes.
#if !PLUMB_IS_FAR

// Sides of W boxes [m]: min_x, min_y, max_x, max_y.
typedef struct sides {
    vf side[4];
} sides;

typedef struct pieces {
    uint32_t slot[PL_WIDTH];
    vf pose[8]; // x y c s dx dy vx vy
    vf core[8]; // x y c s hx hy radius reach
    vm polygons;
    bool any_polygon, any_other;
} pieces;

WIDE_INLINE void pieces_gather(pieces *p, const plumb_world *world, uint32_t first, uint32_t count)
{
    const pl_pieces *columns = &world->pieces;
    const near_real *pose[PL_WIDTH], *core[PL_WIDTH];
    pl_lane polygons[PL_WIDTH];
    p->any_polygon = p->any_other = false;
    for (uint32_t i = 0; i < PL_WIDTH; ++i) {
        const uint32_t slot = pl_moving(world)[first + (i < count ? i : count - 1)];
        const bool polygon = columns->kind[slot] == PL_PIECE_POLYGON;
        p->slot[i] = slot;
        pose[i] = &pl_poses(world)[columns->body[slot]].x;
        core[i] = &columns->core[slot].x;
        polygons[i] = polygon ? -1 : 0;
        p->any_polygon |= polygon;
        p->any_other |= !polygon;
    }
    gather8(p->pose, pose);
    gather8(p->core, core);
    memcpy(&p->polygons, polygons, sizeof polygons);
}

WIDE_INLINE sides boxes_of(const pieces *p)
{
    const vf c = p->pose[2], s = p->pose[3], r = p->core[6];
    const vf x = p->pose[0] + c * p->core[0] - s * p->core[1];
    const vf y = p->pose[1] + s * p->core[0] + c * p->core[1];
    const vf along = vabs(c * p->core[2] - s * p->core[3]);
    const vf across = vabs(s * p->core[2] + c * p->core[3]);
    const vf ex = along * p->core[4] + across * p->core[5] + r;
    const vf ey = across * p->core[4] + along * p->core[5] + r;
    return (sides){ { x - ex, y - ey, x + ex, y + ey } };
}

WIDE_INLINE sides polygons_of(const pieces *p, const plumb_world *world)
{
    const pl_pieces *columns = &world->pieces;
    const vf c = p->pose[2], s = p->pose[3], r = p->core[6];
    const pl_vertex *corner[PL_WIDTH];
    uint32_t count[PL_WIDTH], most = 0;
    for (int i = 0; i < PL_WIDTH; ++i) {
        const uint32_t own = columns->vertex_count[p->slot[i]];
        corner[i] = world->vertices.items + (own > 0 ? columns->vertices[p->slot[i]] : 0);
        count[i] = own > 0 ? own : 1;
        most = count[i] > most ? count[i] : most;
    }
    vf low_x = splat(PLUMB_REAL_MAX), low_y = low_x, high_x = -low_x, high_y = -low_x;
    for (uint32_t k = 0; k < most; ++k) {
        const near_real *row[PL_WIDTH];
        for (int i = 0; i < PL_WIDTH; ++i) {
            row[i] = &corner[i][k < count[i] ? k : count[i] - 1].x;
        }
        vf v[4];
        gather4(v, row, 0);
        const vf x = c * v[0] - s * v[1], y = s * v[0] + c * v[1];
        low_x = vmin(x, low_x), low_y = vmin(y, low_y);
        high_x = vmax(x, high_x), high_y = vmax(y, high_y);
    }
    return (sides){ { p->pose[0] + low_x - r, p->pose[1] + low_y - r, p->pose[0] + high_x + r,
                      p->pose[1] + high_y + r } };
}

WIDE_INLINE sides tight_boxes(const pieces *p, const plumb_world *world)
{
    if (!p->any_polygon) {
        return boxes_of(p);
    }
    sides out = polygons_of(p, world);
    if (p->any_other) {
        const sides others = boxes_of(p);
        for (int k = 0; k < 4; ++k) {
            out.side[k] = sel(p->polygons, out.side[k], others.side[k]);
        }
    }
    return out;
}

// Boxes that go beyond others by a margin.
WIDE_INLINE sides widened(const sides *box, vf margin)
{
    return (sides){ { box->side[0] - margin, box->side[1] - margin, box->side[2] + margin,
                      box->side[3] + margin } };
}

// A piece must meet its partner within the step in which they touch.
WIDE_INLINE sides needed_boxes(const sides *tight, vf dx, vf dy)
{
    const vf zero = splat(0);
    sides out = widened(tight, splat(PL_SPECULATIVE / 2));
    out.side[0] += sel(dx < zero, dx, zero);
    out.side[1] += sel(dy < zero, dy, zero);
    out.side[2] += sel(dx > zero, dx, zero);
    out.side[3] += sel(dy > zero, dy, zero);
    return out;
}

WIDE_INLINE sides fattened(const sides *needed, const sides *tight, vf way)
{
    const vf w = tight->side[2] - tight->side[0], h = tight->side[3] - tight->side[1];
    const vf margin = vmin(splat(PL_FAT_FRACTION) * vmax(w, h), splat(PL_FAT_LIMIT));
    return widened(needed, sel(way > margin, margin / splat(PL_FAT_FAST_SHARE), margin));
}

uint32_t PL_WIDE_NAME(pl_fat_refresh)(const plumb_world *world, uint32_t first, uint32_t count,
                                      real dt)
{
    uint8_t *marks = world->broad.left_marks.data;
    uint32_t left = 0;
    for (uint32_t at = 0; at < count; at += PL_WIDTH) {
        const uint32_t n = count - at < PL_WIDTH ? count - at : PL_WIDTH;
        pieces p;
        near_real *fat[PL_WIDTH];
        const near_real *filed[PL_WIDTH];
        pieces_gather(&p, world, first + at, n);
        for (int i = 0; i < PL_WIDTH; ++i) {
            filed[i] = fat[i] = &world->pieces.fat[p.slot[i]].min_x;
        }
        vf held[4];
        gather4(held, filed, 0);
        const vf dx = p.pose[6] * splat(dt), dy = p.pose[7] * splat(dt);
        const sides tight = tight_boxes(&p, world), needed = needed_boxes(&tight, dx, dy);
        const vm holds = (held[0] <= needed.side[0]) & (held[1] <= needed.side[1]) &
                         (held[2] >= needed.side[2]) & (held[3] >= needed.side[3]);
        if (!any(~holds)) {
            continue;
        }
        const vf way = (vabs(p.pose[6]) + vabs(p.pose[7])) * splat(dt);
        sides out = fattened(&needed, &tight, way);
        for (int k = 0; k < 4; ++k) {
            out.side[k] = sel(holds, held[k], out.side[k]);
        }
        scatter4(fat, 0, out.side);
        for (uint32_t i = 0; i < n; ++i) {
            if (!holds[i]) {
                marks[p.slot[i]] = marks[p.slot[i]] == 0 ? PL_JUST_LEFT : marks[p.slot[i]];
                ++left;
            }
        }
    }
    return left;
}

#else
typedef int pl_no_lanes; // a file without anything is none to pedants
#endif
