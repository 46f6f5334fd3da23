// settle.c - what a step leaves in edges: tension, what tears, what yields.
//
// Reads: what edges pulled with. Writes: edges, bends and gas of what tears. Order: when the step is over.
// Cost: O(edges), and O(bends and ring) for one that tears.
#include "softbody/softbody.h"
#include "world/softbody_list.h"

static void settle(plumb_softbody_edge *e, const pl_soft_pull *now)
{
    const double strain = now->stretch / (double)e->length, yield = (double)e->yield_strain;
    const double length = (1 + strain) * (double)e->length;
    const bool torn = (e->flags & PLUMB_EDGE_TORN) != 0;
    e->flags &= ~PLUMB_EDGE_TORN_NOW;
    e->tension = torn ? 0 : (real)now->tension;
    if (torn) {
        return;
    }
    if (e->break_strain > 0 && strain > (double)e->break_strain) {
        e->flags |= PLUMB_EDGE_TORN | PLUMB_EDGE_TORN_NOW;
        e->tension = 0;
    } else if (yield > 0 && strain > yield) {
        e->length = (real)(length / (1 + yield));
    } else if (yield > 0 && strain < -yield && (e->flags & PLUMB_EDGE_PULLS) == 0) {
        e->length = (real)(length / (1 - yield));
    }
}

void pl_soft_settle_edges(plumb_world *world)
{
    const pl_softbodies *all = &world->softbodies;
    pl_softbody_place at = { 0 };
    for (uint32_t i = 0; i < all->count; ++i) {
        pl_softbody *item = &pl_softbody_items(all)[i];
        for (uint32_t k = 0; k < item->edges && !item->asleep; ++k) {
            plumb_softbody_edge *e = &pl_softbody_edges(all)[at.edge + k];
            settle(e, (const pl_soft_pull *)all->step->pulls.data + at.edge + k);
            if ((e->flags & PLUMB_EDGE_TORN_NOW) != 0) {
                pl_softbody_tear(all, item, at, e);
            }
        }
        at = pl_softbody_behind(at, item);
    }
}
