// island.c - islands asleep: their bodies, their contacts, and the way of a body into sleep and
// out.
//
// Islands and contacts lie in slots with lists of free ones, so that sleeping and waking allocate
// nothing once there is room. The bodies of an island are a list through their rows, by registry
// slot, since rows move. Contacts with a static or kinematic piece are listed at that piece too:
// whoever changes it finds what rests on it.
//
// Reads, writes: islands, contacts, body rows. Cost: O(1) a body or contact.
#include "world/island.h"

#include "world/push.h"
#include "world/rows.h"

#include <string.h>

//---- room ----------------------------------------------------------------------------------------

static bool reserve_slots(pl_memory *memory, pl_buffer *buffer, size_t used, size_t live,
                          size_t extra, size_t size)
{
    size_t free_slots = used - live;
    size_t fresh = extra > free_slots ? extra - free_slots : 0;
    return used + fresh < PL_NONE && pl_buffer_reserve(memory, buffer, (used + fresh) * size);
}

bool pl_islands_reserve(plumb_world *world, uint32_t islands, uint32_t contacts)
{
    pl_sleep *s = &world->sleep;
    return reserve_slots(&world->memory, &s->islands, s->island_slots, s->island_count, islands,
                         sizeof(pl_island)) &&
           reserve_slots(&world->memory, &s->contacts, s->contact_slots, s->contact_count, contacts,
                         sizeof(pl_sleeping_contact));
}

//---- islands -------------------------------------------------------------------------------------

uint32_t pl_island_open(plumb_world *world)
{
    pl_sleep *s = &world->sleep;
    uint32_t slot = s->island_slots;
    if (s->island_count < s->island_slots) {
        slot = s->free_island;
        s->free_island = pl_islands(s)[slot].first_body;
    } else {
        ++s->island_slots;
    }
    ++s->island_count;
    pl_island *i = &pl_islands(s)[slot];
    memset(i, 0, sizeof *i); // padding, too
    i->first_body = i->last_body = i->first_contact = PL_NONE;
    i->serial = world->serial;
    return slot;
}

void pl_island_add(plumb_world *world, uint32_t island, uint32_t row)
{
    pl_bodies *b = &world->bodies;
    pl_island *i = &pl_islands(&world->sleep)[island];
    uint32_t slot = b->entity[row].entity.index;
    b->island[row] = island;
    b->next_asleep[row] = PL_NONE;
    b->previous_asleep[row] = i->last_body;
    if (i->last_body == PL_NONE) {
        i->first_body = slot;
    } else {
        b->next_asleep[world->registry.slots[i->last_body].row] = slot;
    }
    i->last_body = slot;
    ++i->body_count;
}

void pl_island_remove(plumb_world *world, uint32_t row)
{
    pl_bodies *b = &world->bodies;
    pl_island *i = &pl_islands(&world->sleep)[b->island[row]];
    const pl_slot *slots = world->registry.slots;
    uint32_t next = b->next_asleep[row], previous = b->previous_asleep[row];
    if (previous == PL_NONE) {
        i->first_body = next;
    } else {
        b->next_asleep[slots[previous].row] = next;
    }
    if (next == PL_NONE) {
        i->last_body = previous;
    } else {
        b->previous_asleep[slots[next].row] = previous;
    }
    --i->body_count;
    b->island[row] = PL_NONE;
}

//---- contacts ------------------------------------------------------------------------------------

bool pl_sleeping_contact_is_intact(const plumb_world *world, const pl_sleeping_contact *c)
{
    const pl_pieces *p = &world->pieces;
    uint32_t serial = pl_islands(&world->sleep)[c->island].serial;
    return p->kind[c->pair.a] != PL_PIECE_FREE && p->serial[c->pair.a] <= serial &&
           p->kind[c->pair.b] != PL_PIECE_FREE && p->serial[c->pair.b] <= serial;
}

// The piece of a pair whose body is not dynamic; PL_NONE: both are.
static uint32_t fixed_piece(const plumb_world *world, const pl_pair *pair)
{
    const uint8_t *type = world->bodies.type;
    const uint32_t *body = world->pieces.body;
    return type[body[pair->a]] != PLUMB_DYNAMIC   ? pair->a
           : type[body[pair->b]] != PLUMB_DYNAMIC ? pair->b
                                                  : PL_NONE;
}

static void link_to_piece(plumb_world *world, uint32_t slot)
{
    pl_sleeping_contact *all = pl_sleeping_contacts(&world->sleep), *c = &all[slot];
    if (c->fixed != PL_NONE) {
        uint32_t *first = &world->pieces.first_sleeping[c->fixed];
        c->fixed_previous = PL_NONE;
        c->fixed_next = *first;
        if (*first != PL_NONE) {
            all[*first].fixed_previous = slot;
        }
        *first = slot;
    }
}

static void unlink_from_piece(plumb_world *world, const pl_sleeping_contact *c)
{
    pl_sleeping_contact *all = pl_sleeping_contacts(&world->sleep);
    if (c->fixed == PL_NONE) {
        return;
    }
    if (c->fixed_previous == PL_NONE) {
        world->pieces.first_sleeping[c->fixed] = c->fixed_next;
    } else {
        all[c->fixed_previous].fixed_next = c->fixed_next;
    }
    if (c->fixed_next != PL_NONE) {
        all[c->fixed_next].fixed_previous = c->fixed_previous;
    }
}

void pl_island_keep(plumb_world *world, uint32_t island, const pl_pair *pair,
                    const pl_manifold *manifold, bool steps)
{
    pl_sleep *s = &world->sleep;
    pl_island *i = &pl_islands(s)[island];
    uint32_t slot = s->contact_slots;
    if (s->contact_count < s->contact_slots) {
        slot = s->free_contact;
        s->free_contact = pl_sleeping_contacts(s)[slot].next;
    } else {
        ++s->contact_slots;
    }
    ++s->contact_count;
    pl_sleeping_contact *c = &pl_sleeping_contacts(s)[slot];
    memset(c, 0, sizeof *c); // padding, too: images of equal worlds have equal bytes
    c->pair = *pair;
    c->pair.manifold = pair->manifold != PL_NONE ? 0 : PL_NONE; // of a step that is over
    c->whole = manifold != NULL && steps;
    c->recalled = manifold != NULL && !steps;
    c->island = island;
    c->next = i->first_contact;
    c->fixed = fixed_piece(world, pair);
    // A hit that lasted is over. What bore much still does: it is solved as it was when it wakes.
    c->pair.flags &= PL_PAIR_TOUCHING | PL_PAIR_LOADS | PL_PAIR_ONE_WAY;
    if (manifold != NULL) {
        pl_manifold *m = steps ? &c->manifold : &c->last;
        *m = *manifold;
        m->disabled = m->met = 0;
        m->bearer = 0;                // of the step, and not always written
        for (int k = 0; k < 2; ++k) { // at rest, all substeps are alike
            m->point[k].total = pair->normal[k] * (near_real)world->desc.substeps;
        }
        if ((pair->flags & PL_PAIR_BORNE) == 0) { // those are not among the manifolds of a step
            pl_overlaps_count(steps ? &i->overlaps : &i->recalled, manifold);
        }
    }
    i->first_contact = slot;
    ++i->contact_count;
    link_to_piece(world, slot);
}

static void still_row(plumb_world *world, uint32_t row)
{
    pl_bodies *b = &world->bodies;
    b->vx[row] = b->vy[row] = b->w[row] = 0;
    b->residual_vx[row] = b->residual_vy[row] = 0;
    b->fx[row] = b->fy[row] = b->torque[row] = 0;
    pl_poses(world)[row].vx = pl_poses(world)[row].vy = 0;
}

void pl_island_make_due(plumb_world *world, uint32_t island)
{
    pl_sleep *s = &world->sleep;
    pl_island *i = &pl_islands(s)[island];
    if (!i->due) {
        i->due = true;
        i->next_due = s->first_due;
        s->first_due = island;
    }
}

static void take_off_due(pl_sleep *s, uint32_t island)
{
    uint32_t *link = &s->first_due;
    while (*link != island) {
        link = &pl_islands(s)[*link].next_due;
    }
    *link = pl_islands(s)[island].next_due;
}

void pl_island_close(plumb_world *world, uint32_t island)
{
    pl_sleep *s = &world->sleep;
    pl_island *i = &pl_islands(s)[island];
    pl_sleeping_contact *all = pl_sleeping_contacts(s);
    for (uint32_t slot = i->first_contact; slot != PL_NONE;) {
        uint32_t next = all[slot].next;
        unlink_from_piece(world, &all[slot]);
        all[slot].next = s->free_contact;
        s->free_contact = slot;
        --s->contact_count;
        slot = next;
    }
    if (i->due) {
        take_off_due(s, island);
    }
    memset(i, 0, sizeof *i);
    i->first_body = s->free_island;
    s->free_island = island;
    --s->island_count;
}

// It still has that piece, or lies on it.
static bool has_piece(const plumb_world *world, const pl_sleeping_contact *c, uint32_t piece)
{
    return piece == c->fixed || world->bodies.island[world->pieces.body[piece]] == c->island;
}

static bool is_void(const plumb_world *world, const pl_sleeping_contact *c)
{
    return !pl_sleeping_contact_is_intact(world, c) || !has_piece(world, c, c->pair.a) ||
           !has_piece(world, c, c->pair.b);
}

// Contacts with what has gone since become those of an island of their own, without bodies: the next step tells their ends.
static bool shed_void(plumb_world *world, uint32_t island)
{
    pl_sleep *s = &world->sleep;
    if (!pl_islands_reserve(world, 1, 0)) {
        return false;
    }
    pl_sleeping_contact *all = pl_sleeping_contacts(s);
    uint32_t *link = &pl_islands(s)[island].first_contact, shed = PL_NONE;
    while (*link != PL_NONE) {
        pl_sleeping_contact *c = &all[*link];
        if (!is_void(world, c)) {
            link = &c->next;
            continue;
        }
        shed = shed == PL_NONE ? pl_island_open(world) : shed;
        pl_island *to = &pl_islands(s)[shed];
        const uint32_t slot = *link;
        *link = c->next;
        c->next = to->first_contact;
        c->island = shed;
        to->first_contact = slot;
        to->serial = pl_islands(s)[island].serial;
        ++to->contact_count;
        --pl_islands(s)[island].contact_count;
    }
    if (shed != PL_NONE) {
        pl_island_make_due(world, shed);
    }
    return true;
}

bool pl_island_calm(plumb_world *world, uint32_t island)
{
    if (!shed_void(world, island)) {
        return false;
    }
    pl_bodies *b = &world->bodies;
    pl_island *i = &pl_islands(&world->sleep)[island];
    if (i->due) {
        take_off_due(&world->sleep, island);
        i->due = false;
    }
    for (uint32_t slot = i->first_body; slot != PL_NONE;) {
        uint32_t row = world->registry.slots[slot].row;
        still_row(world, row);
        slot = b->next_asleep[row];
    }
    return true;
}

//---- bodies --------------------------------------------------------------------------------------

uint32_t pl_sleep_put_down(plumb_world *world, uint32_t row)
{
    still_row(world, row);
    for (uint32_t p = world->bodies.first_piece[row]; p != PL_NONE;
         p = world->pieces.next_in_body[p]) {
        pl_piece_rest(world, p);
    }
    return pl_row_to_asleep(world, row);
}

uint32_t pl_sleep_take_up(plumb_world *world, uint32_t row)
{
    pl_bodies *b = &world->bodies;
    b->rest_time[row] = PL_NOT_RESTING;
    pl_push_wake(world, row);
    for (uint32_t p = b->first_piece[row]; p != PL_NONE; p = world->pieces.next_in_body[p]) {
        pl_piece_move(world, p);
    }
    return pl_row_to_awake(world, row);
}

void pl_sleep_make(plumb_world *world, uint32_t row)
{
    uint32_t island = pl_island_open(world);
    pl_islands(&world->sleep)[island].made_step = world->step_count + 1;
    pl_island_add(world, island, row);
}
