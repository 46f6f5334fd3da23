// settle.c - what a step leaves in edges: tension, what tears, what yields.
//
// Reads: what edges pulled with. Writes: edges, bends over torn ones, gas of a skin that tears. Order: when the step is over.
// Cost: O(edges), and O(bends) for one that tears.
#include "softbody/softbody.h"

static void settle(plumb_softbody_edge *e, const pl_soft_pull *now)
{
    const double strain = now->strain, yield = (double)e->yield_strain;
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

// Nothing bends any more over an edge that is torn.
static void limp(const pl_softbodies *all, const pl_softbody *item, pl_softbody_place at,
                 const plumb_softbody_edge *torn)
{
    for (uint32_t k = 0; k < item->bends; ++k) {
        plumb_softbody_bend *b = &pl_softbody_bends(all)[at.bend + k];
        const bool first =
            (b->a == torn->a && b->b == torn->b) || (b->a == torn->b && b->b == torn->a);
        const bool second =
            (b->b == torn->a && b->c == torn->b) || (b->b == torn->b && b->c == torn->a);
        b->stiffness = first || second ? 0 : b->stiffness;
    }
}

void pl_soft_settle_edges(plumb_world *world)
{
    const pl_softbodies *all = &world->softbodies;
    pl_softbody_place at = { 0 };
    for (uint32_t i = 0; i < all->count; ++i) {
        pl_softbody *item = &pl_softbody_items(all)[i];
        bool tears = false;
        for (uint32_t k = 0; k < item->edges && !item->asleep; ++k) {
            plumb_softbody_edge *e = &pl_softbody_edges(all)[at.edge + k];
            settle(e, (const pl_soft_pull *)all->step->pulls.data + at.edge + k);
            if ((e->flags & PLUMB_EDGE_TORN_NOW) != 0) {
                tears = true;
                limp(all, item, at, e);
            }
        }
        if (tears && item->ring > 0) { // its gas is out
            item->pressure = item->ambient = 0;
        }
        at = pl_softbody_behind(at, item);
    }
}
