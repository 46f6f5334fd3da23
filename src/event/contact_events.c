// contact_events.c - who began and who ceased to touch in this step.
//
// A pair touches when its surfaces met at the start of the step, when its contact carried an
// impulse in the last substep, or when an impact was resolved. Reads: pairs, manifolds. Writes:
// event arrays, the pairs' touching flag. Order: last of the built-in passes. Cost: O(pairs).
#include "event/event.h"
#include "world/state.h"

void pl_events_clear(plumb_world *world)
{
    world->begin_count = world->end_count = 0;
}

bool pl_events_reserve_ends(plumb_world *world, uint32_t count)
{
    size_t room = ((size_t)world->end_count + count) * sizeof(plumb_contact_end);
    return pl_buffer_reserve(&world->memory, &world->end_events, room);
}

static void append_end(plumb_world *world, const pl_pair *pair)
{
    const pl_pieces *pieces = &world->pieces;
    ((plumb_contact_end *)world->end_events.data)[world->end_count++] =
        (plumb_contact_end){ .shape_a = pieces->shape[pair->a],
                             .shape_b = pieces->shape[pair->b],
                             .body_a = world->bodies.entity[pieces->body[pair->a]],
                             .body_b = world->bodies.entity[pieces->body[pair->b]] };
}

void pl_pair_lost(plumb_world *world, const pl_pair *pair)
{
    const pl_pieces *pieces = &world->pieces;
    bool reborn = pieces->serial[pair->a] > world->broad.serial ||
                  pieces->serial[pair->b] > world->broad.serial;
    bool gone = pieces->kind[pair->a] == PL_PIECE_FREE || pieces->kind[pair->b] == PL_PIECE_FREE;
    if ((pair->flags & PL_PAIR_TOUCHING) != 0 && !reborn && !gone) {
        append_end(world, pair);
    }
}

// Fastest approach of a manifold's points, from the velocities before the step. [m/s]
static real approach_speed(const plumb_world *world, const pl_manifold *m)
{
    const pl_bodies *b = &world->bodies;
    real dvx = b->vx[m->body_b] - b->vx[m->body_a];
    real dvy = b->vy[m->body_b] - b->vy[m->body_a];
    real wa = b->w[m->body_a], wb = b->w[m->body_b];
    real fastest = 0;
    for (uint32_t j = 0; j < m->count; ++j) {
        const pl_manifold_point *p = &m->point[j];
        real vx = dvx - wb * p->by + wa * p->ay;
        real vy = dvy + wb * p->bx - wa * p->ax;
        real speed = -(m->nx * vx + m->ny * vy);
        fastest = speed > fastest ? speed : fastest;
    }
    return fastest;
}

bool pl_events_prepare(plumb_world *world)
{
    uint32_t begins = world->narrow.manifold_count;
    if (!pl_buffer_reserve(&world->memory, &world->begin_events,
                           begins * sizeof(plumb_contact_begin)) ||
        !pl_events_reserve_ends(world, world->broad.pairs.count)) {
        return false;
    }
    pl_manifold *m = pl_manifolds(&world->narrow);
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        if ((pairs[m[i].pair].flags & PL_PAIR_TOUCHING) == 0) {
            m[i].approach = approach_speed(world, &m[i]);
        }
    }
    return true;
}

static bool touches(const pl_pair *pair, const pl_manifold *m)
{
    return (pair->flags & PL_PAIR_HIT) != 0 || pair->normal[0] > 0 || pair->normal[1] > 0 ||
           m->point[0].separation <= 0 || m->point[1].separation <= 0;
}

static void append_begin(plumb_world *world, const pl_pair *pair, const pl_manifold *m)
{
    const pl_bodies *b = &world->bodies;
    const pl_manifold_point *p = &m->point[0];
    ((plumb_contact_begin *)world->begin_events.data)[world->begin_count++] =
        (plumb_contact_begin){ .shape_a = world->pieces.shape[pair->a],
                               .shape_b = world->pieces.shape[pair->b],
                               .body_a = b->entity[m->body_a],
                               .body_b = b->entity[m->body_b],
                               .point = { b->center_x[m->body_a] + p->ax,
                                          b->center_y[m->body_a] + p->ay },
                               .normal = { m->nx, m->ny },
                               .approach_speed = m->approach };
}

void pl_events_publish(plumb_world *world)
{
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    const pl_manifold *manifolds = pl_manifolds(&world->narrow);
    for (uint32_t i = 0; i < world->broad.pairs.count; ++i) {
        pl_pair *pair = &pairs[i];
        bool was = (pair->flags & PL_PAIR_TOUCHING) != 0;
        bool is = pair->manifold != PL_NONE && touches(pair, &manifolds[pair->manifold]);
        if (is && !was) {
            append_begin(world, pair, &manifolds[pair->manifold]);
            pair->flags |= PL_PAIR_TOUCHING;
        } else if (was && !is) {
            append_end(world, pair);
            pair->flags &= ~PL_PAIR_TOUCHING;
        }
    }
}
