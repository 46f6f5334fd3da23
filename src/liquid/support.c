// support.c - what holds bodies in the liquid: the ground under them, ropes, other bodies.
//
// The liquid moves its copies of bodies before contacts and joints are known. What these did is what the step made of a body's velocity
// beyond what the liquid had expected; the next step expects it again. Without it a crate on the ground falls by g dt in the liquid's
// part of each step, and stirs the water. An impact lasts a step and is no support: only what two steps have in common is.
//
// With the force F of the liquid and the added mass M of a body of mass m the error falls by M / (m + M) a step, whatever both are.
//
// Reads: velocities, masses. Writes: supports. Cost: O(n log n) bodies near the liquid.
#include "core/sort.h"
#include "liquid/liquid.h"
#include "world/rows.h"

#include <string.h>

static uint64_t key_of(plumb_entity entity)
{
    return pl_key(entity.index, entity.generation);
}

static double shorter(double a, double b)
{
    return a * b <= 0 ? 0 : a * a < b * b ? a : b;
}

// What two forces have in common: the shorter one, unless they part.
static void find_common(const pl_liquid_support *s, double held[3])
{
    const double *a = s->last, *b = s->before;
    const double both = a[0] * b[0] + a[1] * b[1];
    const double *least = a[0] * a[0] + a[1] * a[1] < b[0] * b[0] + b[1] * b[1] ? a : b;
    held[0] = both > 0 ? least[0] : 0;
    held[1] = both > 0 ? least[1] : 0;
    held[2] = shorter(a[2], b[2]);
}

const pl_liquid_support *pl_liquid_support_of(const pl_liquid_supports *supports, uint64_t key)
{
    const pl_liquid_support *all = supports->items.data;
    bool found = false;
    const uint32_t at = pl_find_key(all, supports->count, sizeof *all, key, &found);
    return found ? &all[at] : NULL;
}

static bool recall(const pl_liquid_supports *supports, plumb_entity entity, double held[3])
{
    const pl_liquid_support *s =
        supports->count > 0 ? pl_liquid_support_of(supports, key_of(entity)) : NULL;
    if (s != NULL) {
        find_common(s, held);
    }
    return s != NULL;
}

bool pl_liquid_recall_supports(pl_memory *memory, pl_liquid_supports *supports,
                               pl_liquid_scratch *scratch)
{
    const pl_liquid_grid *g = &scratch->grid;
    const size_t count = (size_t)g->body_count + g->softbody_count;
    if (!pl_buffer_reserve(memory, &scratch->order, count * sizeof(pl_keyed)) ||
        !pl_buffer_reserve(memory, &scratch->supports, count * sizeof(pl_liquid_support)) ||
        !pl_buffer_reserve(memory, &supports->items, count * sizeof(pl_liquid_support))) {
        return false;
    }
    for (uint32_t i = 0; i < g->body_count; ++i) {
        pl_liquid_body *b = &g->bodies[i];
        b->known = recall(supports, b->body.entity, b->held);
    }
    for (uint32_t i = 0; i < g->softbody_count; ++i) {
        recall(supports, g->softbodies[i].entity.entity, g->softbodies[i].held);
    }
    return true;
}

// [N] from how much faster it is than expected.
static double force_of(double held, double more, double inverse, double dt)
{
    return inverse > 0 ? pl_liquid_held(held + more / (inverse * dt), PL_LIQUID_FORCE) : 0;
}

// Of a newcomer what was expected is all that is known of before.
static pl_liquid_support note(const pl_liquid_supports *supports, plumb_entity entity,
                              const double held[3])
{
    const pl_liquid_support *old = pl_liquid_support_of(supports, key_of(entity));
    pl_liquid_support s = { .key = key_of(entity) };
    memcpy(s.before, old != NULL ? old->last : held, sizeof s.before);
    return s;
}

static pl_liquid_support note_body(const plumb_world *world, const pl_liquid_supports *supports,
                                   const pl_liquid_body *body, double dt)
{
    const pl_bodies *b = &world->bodies;
    const uint32_t row = pl_body_row(world, body->body);
    pl_liquid_support s = note(supports, body->body.entity, body->held);
    s.last[0] = force_of(body->held[0], (double)b->vx[row] - body->vx, body->inv_mass_x, dt);
    s.last[1] = force_of(body->held[1], (double)b->vy[row] - body->vy, body->inv_mass_y, dt);
    s.last[2] = force_of(body->held[2], (double)b->w[row] - body->w, body->inv_inertia, dt);
    s.wet = body->wet ? PL_LIQUID_WET_BODY : PL_LIQUID_DRY;
    return s;
}

static pl_liquid_support note_softbody(const pl_liquid_supports *supports, const pl_liquid_grid *g,
                                       const pl_liquid_softbody *body, double dt)
{
    const double turns = body->inertia > 0 ? 1 / body->inertia : 0;
    pl_liquid_support s = note(supports, body->entity.entity, body->held);
    double found[3], now[3];
    pl_liquid_soft_motion(g, body, false, found);
    pl_liquid_soft_motion(g, body, true, now);
    for (int k = 0; k < 3; ++k) {
        s.last[k] = force_of(body->held[k], now[k] - found[k], k < 2 ? 1 / body->mass : turns, dt);
    }
    s.wet = pl_liquid_softbody_is_wet(g, body) ? PL_LIQUID_WET_SOFTBODY : PL_LIQUID_DRY;
    return s;
}

uint32_t pl_liquid_note_supports(const plumb_world *world, const pl_liquid_supports *supports,
                                 pl_liquid_scratch *scratch, real dt)
{
    const pl_liquid_grid *g = &scratch->grid;
    pl_liquid_support *notes = scratch->supports.data;
    pl_keyed *order = scratch->order.data;
    uint32_t count = 0;
    for (uint32_t i = 0; i < g->body_count; ++i) {
        if (g->bodies[i].moves) {
            notes[count++] = note_body(world, supports, &g->bodies[i], (double)dt);
        }
    }
    for (uint32_t i = 0; i < g->softbody_count; ++i) {
        notes[count++] = note_softbody(supports, g, &g->softbodies[i], (double)dt);
    }
    for (uint32_t i = 0; i < count; ++i) {
        order[i] = (pl_keyed){ .key = notes[i].key, .value = i };
    }
    pl_sort_keyed(order, count);
    return count;
}

void pl_liquid_take_supports(pl_liquid_supports *supports, const pl_liquid_scratch *scratch,
                             uint32_t count)
{
    const pl_liquid_support *notes = scratch->supports.data;
    const pl_keyed *order = scratch->order.data;
    pl_liquid_support *to = supports->items.data;
    for (uint32_t i = 0; i < count; ++i) {
        to[i] = notes[order[i].value];
    }
    supports->count = count;
}
