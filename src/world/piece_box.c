// piece_box.c - the box that a piece fills, as it lies.
//
// Reads: poses, piece geometry. Cost: O(1); O(corners) of polygons.
#include "world/state.h"

static pl_box box_around(real x, real y, real ex, real ey)
{
    return (pl_box){ x - ex, y - ey, x + ex, y + ey };
}

static pl_box polygon_box(const plumb_world *world, uint32_t piece, const pl_pose *pose)
{
    const pl_vertex *v = world->vertices.items + world->pieces.vertices[piece];
    pl_box box = { PLUMB_REAL_MAX, PLUMB_REAL_MAX, -PLUMB_REAL_MAX, -PLUMB_REAL_MAX };
    for (int i = 0; i < world->pieces.vertex_count[piece]; ++i) {
        real x = pose->c * v[i].x - pose->s * v[i].y;
        real y = pose->s * v[i].x + pose->c * v[i].y;
        box.min_x = x < box.min_x ? x : box.min_x;
        box.min_y = y < box.min_y ? y : box.min_y;
        box.max_x = x > box.max_x ? x : box.max_x;
        box.max_y = y > box.max_y ? y : box.max_y;
    }
    real r = world->pieces.core[piece].radius;
    return (pl_box){ pose->x + box.min_x - r, pose->y + box.min_y - r, pose->x + box.max_x + r,
                     pose->y + box.max_y + r };
}

pl_box pl_piece_tight_box(const plumb_world *world, uint32_t piece)
{
    const pl_core *core = &world->pieces.core[piece];
    const pl_pose *pose = &pl_poses(world)[world->pieces.body[piece]];
    real x = pose->x + pose->c * core->x - pose->s * core->y;
    real y = pose->y + pose->s * core->x + pose->c * core->y;
    real c = plumb_abs(pose->c * core->c - pose->s * core->s);
    real s = plumb_abs(pose->s * core->c + pose->c * core->s);
    real r = core->radius;
    switch (world->pieces.kind[piece]) {
    case PL_PIECE_CIRCLE:
        return box_around(x, y, r, r);
    case PL_PIECE_CAPSULE:
        return box_around(x, y, c * core->hx + r, s * core->hx + r);
    case PL_PIECE_BOX:
        return box_around(x, y, c * core->hx + s * core->hy + r, s * core->hx + c * core->hy + r);
    default:
        return polygon_box(world, piece, pose);
    }
}
