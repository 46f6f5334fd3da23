// view.h - component values beside rows of another table: ranges in which both go on one by one.
#ifndef PL_VIEW_H
#define PL_VIEW_H

#include "ecs/component.h"

// A run is a pl_keyed, so that runs can be sorted as they are: `key` its first row, `value` the place of
// its first value, `order` how many there are.

// Lists the runs of a component by rising row, for owners of one kind. False when out of memory. O(1) where
// nothing moved since the last time, else O(values), and O(runs log runs) where values are not in order.
bool pl_view_prepare(pl_memory *memory, pl_component *component, const pl_registry *registry,
                     uint32_t kind);

// Adds a prepared component to a view.
void pl_view_add(plumb_body_view *view, const pl_component *component);

#endif
