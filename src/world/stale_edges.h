// stale_edges.h - changes of pieces after which internal edges have to be found anew.
#ifndef PL_STALE_EDGES_H
#define PL_STALE_EDGES_H

#include "world/state.h"

// The piece is new, has moved, or meets others than before.
void pl_internal_edges_touch(plumb_world *world, uint32_t piece);
// The same of every piece of a shape, and of a body if it is static.
void pl_internal_edges_touch_shape(plumb_world *world, uint32_t first);
void pl_internal_edges_touch_static(plumb_world *world, uint32_t row);
// The same of every piece of a body that has been moved, if it is static; its boxes still tell where
// it lay.
void pl_internal_edges_move_static(plumb_world *world, uint32_t row);
// What was near a static piece, by the box that it is filed by, is looked at again: before it loses that box.
void pl_internal_edges_leave(plumb_world *world, uint32_t piece);
// The piece's slot is about to be freed.
void pl_internal_edges_forget(plumb_world *world, uint32_t piece);
bool pl_piece_is_static(const plumb_world *world, uint32_t piece);
// Takes the internal edges of a piece away.
void pl_internal_edges_clear(plumb_world *world, uint32_t piece);

#endif
