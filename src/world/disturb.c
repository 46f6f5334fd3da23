// disturb.c - changes between steps, and by systems: what they make wake in the next one.
//
// Every setter that changes something calls one of these with the body or piece concerned. Nothing
// moves here: an island is taken down as due, and the waking pass does the rest, so that setters
// neither invalidate spans nor need memory. Bodies that are awake begin to rest anew, and so do,
// at the next step, those that touch an immovable body that was changed (rest.c).
//
// Reads: rows, contacts at pieces. Writes: islands, times of rest. Cost: O(1) for dynamic bodies,
// O(sleeping contacts of the body, or of the shape) for others; pl_sleep_disturb_all O(bodies).
#include "core/sort.h"
#include "world/island.h"
#include "world/rows.h"
#include "world/stale_edges.h"
#include "world/softbody_list.h"

static void wake_contacts(plumb_world *world, uint32_t piece)
{
    const pl_sleeping_contact *all = pl_sleeping_contacts(&world->sleep);
    for (uint32_t c = world->pieces.first_sleeping[piece]; c != PL_NONE; c = all[c].fixed_next) {
        pl_island_make_due(world, all[c].island);
    }
}

// What sleeps in a volume of a fluid, as sensors saw it last.
static void wake_seen(plumb_world *world, const pl_buffer *overlaps, uint32_t count,
                      plumb_shape sensor)
{
    bool found;
    const pl_overlap *all = overlaps->data;
    for (uint32_t i = pl_find_key(all, count, sizeof *all, pl_key(sensor.entity.index, 0), &found);
         i < count && (uint32_t)(all[i].key >> 32) == sensor.entity.index; ++i) {
        const uint32_t row = pl_body_row(world, all[i].who.body);
        if (row != PL_NONE && world->bodies.type[row] == PLUMB_DYNAMIC) {
            pl_sleep_disturb(world, row);
        }
    }
}

void pl_sleep_wake_swimmers(plumb_world *world, uint32_t piece)
{
    const pl_sensing *s = &world->sensing;
    if ((world->pieces.flags[piece] & PL_PIECE_SENSOR) != 0 &&
        world->materials.fluid[world->pieces.material[piece]]) {
        wake_seen(world, &s->overlaps, s->count, world->pieces.shape[piece]);
        wake_seen(world, &s->rest_overlaps, s->rest_count, world->pieces.shape[piece]);
        pl_softbodies_stir_near(world, piece);
    }
}

static void note_immovable(plumb_world *world, uint32_t row)
{
    world->sleep.changed_step = world->step_count + 1;
    world->bodies.changed_step[row] = (uint32_t)(world->step_count + 1);
}

void pl_sleep_stir(plumb_world *world, uint32_t row)
{
    pl_bodies *b = &world->bodies;
    b->rest_time[row] = PL_NOT_RESTING;
    if (b->island[row] != PL_NONE) {
        pl_island_make_due(world, b->island[row]);
    }
    if (b->type[row] != PLUMB_DYNAMIC || b->island[row] != PL_NONE) {
        pl_softbodies_stir_by(world, row); // what is awake finds them in the waking pass
    }
    if (b->type[row] != PLUMB_DYNAMIC) {
        note_immovable(world, row);
        for (uint32_t p = b->first_piece[row]; p != PL_NONE; p = world->pieces.next_in_body[p]) {
            wake_contacts(world, p);
            pl_sleep_wake_swimmers(world, p);
        }
    }
}

bool pl_row_is_furnished(const plumb_world *world, uint32_t row)
{
    uint32_t island = world->bodies.island[row];
    return island != PL_NONE &&
           pl_islands(&world->sleep)[island].made_step == world->step_count + 1;
}

void pl_sleep_disturb(plumb_world *world, uint32_t row)
{
    if (!pl_row_is_furnished(world, row)) {
        pl_sleep_stir(world, row);
    }
}

void pl_sleep_disturb_piece(plumb_world *world, uint32_t piece)
{
    uint32_t row = world->pieces.body[piece];
    if (world->bodies.type[row] == PLUMB_DYNAMIC) {
        pl_sleep_disturb(world, row);
    } else {
        if (world->bodies.type[row] == PLUMB_STATIC) { // the others of its body are as they were
            world->pieces.flags[piece] |= PL_PIECE_CHANGED;
            world->sleep.changed_step = world->step_count + 1;
        } else {
            note_immovable(world, row);
        }
        wake_contacts(world, piece);
        pl_sleep_wake_swimmers(world, piece);
        pl_softbodies_stir_near(world, piece);
    }
}

void pl_sleep_disturb_all(plumb_world *world)
{
    for (uint32_t i = 0; i < world->sleep.island_slots; ++i) {
        if (pl_islands(&world->sleep)[i].body_count > 0) {
            pl_island_make_due(world, i);
        }
    }
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        world->bodies.rest_time[row] = PL_NOT_RESTING;
    }
    pl_softbodies_stir_all(world);
}

void pl_sleep_void_contacts(plumb_world *world, uint32_t piece)
{
    wake_contacts(world, piece);
    pl_sleep_wake_swimmers(world, piece);
    pl_softbodies_stir_near(world, piece);
    pl_sleeping_contact *all = pl_sleeping_contacts(&world->sleep);
    for (uint32_t c = world->pieces.first_sleeping[piece]; c != PL_NONE; c = all[c].fixed_next) {
        all[c].fixed = PL_NONE;
    }
    world->pieces.first_sleeping[piece] = PL_NONE;
}

// Its fat box is emptied: whoever files it will find that it was moved.
void pl_sleep_see_anew(plumb_world *world, uint32_t piece)
{
    pl_pieces *pieces = &world->pieces;
    uint32_t row = pieces->body[piece];
    pl_sleep_disturb_piece(world, piece);
    if (world->asleep_count == 0 || world->bodies.type[row] == PLUMB_DYNAMIC) {
        return;
    }
    if (world->bodies.type[row] == PLUMB_STATIC) {
        pl_internal_edges_leave(world, piece);
        pl_piece_lose_box(world, piece);
        world->static_dirty = true;
    }
}

void pl_sleep_forget(plumb_world *world, uint32_t row)
{
    uint32_t island = world->bodies.island[row];
    if (island == PL_NONE) {
        return;
    }
    pl_island_make_due(world, island);
    pl_island_remove(world, row);
    const pl_island *i = &pl_islands(&world->sleep)[island];
    if (i->body_count == 0 && i->first_contact == PL_NONE) {
        pl_island_close(world, island);
    }
}

void pl_sleep_disturb_shape(plumb_world *world, uint32_t first)
{
    const uint32_t row = world->pieces.body[first];
    if (world->bodies.type[row] != PLUMB_STATIC) {
        pl_sleep_disturb(world, row);
        return;
    }
    for (uint32_t p = first; p != PL_NONE; p = world->pieces.next_in_shape[p]) {
        pl_sleep_disturb_piece(world, p);
    }
}
