// softbody.h - what a call may say of soft bodies, and what it leaves out (softbody_check.c).
#ifndef PL_API_SOFTBODY_H
#define PL_API_SOFTBODY_H

#include "plumb/softbody.h"
#include "world/state.h"

// [m] between two nodes.
plumb_real pl_softbody_way(const plumb_softbody_node *a, const plumb_softbody_node *b);
// Elements with what they have at rest resolved.
plumb_softbody_edge pl_softbody_edge_of(const plumb_softbody_desc *d, int i);
plumb_softbody_bend pl_softbody_bend_of(const plumb_softbody_desc *d, int i);
plumb_softbody_triangle pl_softbody_triangle_of(const plumb_softbody_desc *d, int i);

plumb_result pl_softbody_check_node(const plumb_world *world, const char *fn,
                                    const plumb_softbody_node *node);
plumb_result pl_softbody_check_edge(const plumb_world *world, const char *fn,
                                    const plumb_softbody_edge *e);
plumb_result pl_softbody_check_pin(const plumb_world *world, const char *fn,
                                   const plumb_softbody_pin *pin);
plumb_result pl_softbody_check_gas(const plumb_world *world, const char *fn,
                                   const pl_softbody *item);
// All of it, and its record but for entity and pins, which are yet to be put.
plumb_result pl_softbody_check_desc(const plumb_world *world, const char *fn,
                                    const plumb_softbody_desc *d, pl_softbody *item);

#endif
