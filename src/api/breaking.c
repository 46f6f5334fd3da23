// breaking.c - bodies that broke in a step shatter when the next one begins, and tell it; commands that divide bodies tell it here, too.
//
// Reads: world->fracture.pending. Writes: bodies, as divide.c does; events of breaking. Order: after the commands, in the order in which they
// broke. Cost: that of plumb_body_shatter each.
#include "api/fracture.h"
#include "api/listed.h"

#include "world/body_settings.h"
#include "world/check.h"
#include "world/observer.h"
#include "world/rows.h"

#include <string.h>

static pl_pending_break *pending(const plumb_world *world)
{
    return (pl_pending_break *)world->fracture.pending.data;
}

bool pl_break_reserve(plumb_world *world)
{
    pl_fracture *f = &world->fracture;
    return pl_buffer_reserve(&world->memory, &f->breaks,
                             ((size_t)f->break_count + 1) * sizeof(plumb_body_break));
}

// There is room for its parts since it was divided (divide.c).
void pl_break_tell(plumb_world *world, plumb_body_break event)
{
    pl_fracture *f = &world->fracture;
    event.first_part = (int)f->piece_count;
    event.part_count = (int)f->child_count - 1;
    for (uint32_t i = 0; i < f->child_count; ++i) {
        if (!plumb_same(pl_children(world)[i].body, event.body)) {
            ((plumb_body *)f->pieces.data)[f->piece_count++] = pl_children(world)[i].body;
        }
    }
    ((plumb_body_break *)f->breaks.data)[f->break_count++] = event;
}

static plumb_result run(plumb_world *world, const char *fn, const pl_pending_break *b)
{
    const uint32_t row = pl_body_row(world, b->body);
    if (row == PL_NONE || world->bodies.type[row] != PLUMB_DYNAMIC) {
        return PLUMB_OK; // it is gone, or another by now
    }
    if (!pl_break_reserve(world)) {
        return pl_fail_memory(world, fn);
    }
    const pl_body_settings t = pl_body_settings_get(world, row);
    int cells = (int)t.break_cells;
    cells = cells < 2 ? (cells == 0 ? 0 : 2) : cells;
    const plumb_shatter_desc desc = { .point = b->point,
                                      .cells = cells,
                                      .seed = world->step_count << 32 | b->body.entity.index };
    int count;
    const plumb_result r = pl_shatter(world, fn, b->body, &desc, true, &count);
    if (r != PLUMB_OK || count == 0) {
        return r == PLUMB_E_MEMORY ? r : PLUMB_OK; // a part would have had no mass
    }
    pl_body_settings whole = pl_body_settings_get(world, pl_body_row(world, b->body));
    whole.break_force = whole.break_impulse = whole.break_energy = whole.break_cells = 0;
    pl_body_settings_set(world, pl_body_row(world, b->body), &whole);
    pl_break_tell(world, (plumb_body_break){ .body = b->body,
                                             .other = b->other,
                                             .point = b->point,
                                             .normal = b->normal,
                                             .impulse = b->impulse,
                                             .energy = b->energy });
    return PLUMB_OK;
}

plumb_result pl_breaks_run(plumb_world *world, const char *function, bool waits)
{
    pl_fracture *f = &world->fracture;
    if (waits || (world->observer != NULL && world->observer->replays)) {
        return PLUMB_OK;
    }
    uint32_t done = 0;
    plumb_result result = PLUMB_OK;
    while (done < f->pending_count && result == PLUMB_OK) {
        const pl_pending_break b = pending(world)[done];
        result = run(world, function, &b);
        done += result == PLUMB_OK;
    }
    f->pending_count -= done;
    if (f->pending_count > 0) {
        memmove(pending(world), pending(world) + done, f->pending_count * sizeof(pl_pending_break));
    }
    return result;
}

PL_LISTED(plumb_body_break, plumb_world_body_break_events, world->fracture.breaks.data,
          world->fracture.break_count)

PL_LISTED(plumb_body, plumb_world_body_break_parts, world->fracture.pieces.data,
          world->fracture.piece_count)
