// told.c - see told.h. Reads, writes: events of bodies that broke or are gone. Cost: O(events).
#include "record/told.h"

#include "plumb/fracture.h"
#include "plumb/heat.h"

#include "world/heat_list.h"

#include <string.h>

typedef struct told_head {
    uint64_t gone, breaks, parts; // so many plumb_body_gone, plumb_body_break, plumb_body behind
} told_head;

static told_head head_of(const plumb_world *world)
{
    return (told_head){ world->heats.gone_count, world->fracture.break_count,
                        world->fracture.piece_count };
}

static size_t bytes_of(told_head h)
{
    return sizeof h + (size_t)h.gone * sizeof(plumb_body_gone) +
           (size_t)h.breaks * sizeof(plumb_body_break) + (size_t)h.parts * sizeof(plumb_body);
}

size_t pl_told_bytes(const plumb_world *world)
{
    const told_head h = head_of(world);
    return (h.gone | h.breaks) == 0 ? 0 : bytes_of(h);
}

// Member by member: padding is not to be in a file.
static void write_gone(const plumb_world *world, char *to)
{
    const plumb_body_gone *gone = pl_heat_step_of(&world->heats)->gone.data;
    for (uint32_t i = 0; i < world->heats.gone_count; ++i, to += sizeof *gone) {
        plumb_body_gone event;
        memset(&event, 0, sizeof event);
        event.body = gone[i].body;
        event.position = gone[i].position;
        event.mass = gone[i].mass;
        event.end = gone[i].end;
        memcpy(to, &event, sizeof event);
    }
}

static void write_breaks(const plumb_world *world, char *to)
{
    const plumb_body_break *breaks = world->fracture.breaks.data;
    for (uint32_t i = 0; i < world->fracture.break_count; ++i, to += sizeof *breaks) {
        plumb_body_break event;
        memset(&event, 0, sizeof event);
        event.body = breaks[i].body;
        event.other = breaks[i].other;
        event.point = breaks[i].point;
        event.normal = breaks[i].normal;
        event.impulse = breaks[i].impulse;
        event.energy = breaks[i].energy;
        event.first_part = breaks[i].first_part;
        event.part_count = breaks[i].part_count;
        memcpy(to, &event, sizeof event);
    }
}

void pl_told_write(const plumb_world *world, char *to)
{
    const told_head h = head_of(world);
    memcpy(to, &h, sizeof h);
    to += sizeof h;
    if (h.gone > 0) {
        write_gone(world, to);
        to += (size_t)h.gone * sizeof(plumb_body_gone);
    }
    if (h.breaks > 0) {
        write_breaks(world, to);
        to += (size_t)h.breaks * sizeof(plumb_body_break);
    }
    if (h.parts > 0) {
        memcpy(to, world->fracture.pieces.data, (size_t)h.parts * sizeof(plumb_body));
    }
}

// Parts lie in the list; an end is one that there is.
static bool are_sound(const plumb_world *world, uint64_t parts)
{
    const plumb_body_break *breaks = world->fracture.breaks.data;
    for (uint32_t i = 0; i < world->fracture.break_count; ++i) {
        if (breaks[i].first_part < 0 || breaks[i].part_count < 0 ||
            (uint64_t)breaks[i].first_part + (uint64_t)breaks[i].part_count > parts) {
            return false;
        }
    }
    for (uint32_t i = 0; i < world->heats.gone_count; ++i) {
        const plumb_body_gone *gone = pl_heat_step_of(&world->heats)->gone.data;
        if ((uint32_t)gone[i].end > (uint32_t)PLUMB_END_SHRUNK) {
            return false;
        }
    }
    return true;
}

static const char *read_list(pl_buffer *list, uint64_t count, size_t size, const char *from)
{
    if (count > 0) {
        memcpy(list->data, from, (size_t)count * size);
    }
    return from + (size_t)count * size;
}

plumb_result pl_told_play(plumb_world *world, const char *from, size_t bytes)
{
    pl_fracture *f = &world->fracture;
    pl_heats *heats = &world->heats;
    pl_memory *memory = &world->memory;
    told_head h;
    if (bytes < sizeof h) {
        return PLUMB_E_IMAGE;
    }
    memcpy(&h, from, sizeof h);
    if (h.gone > bytes || h.breaks > bytes || h.parts > bytes || bytes_of(h) != bytes) {
        return PLUMB_E_IMAGE;
    }
    if ((h.gone > 0 && !pl_heat_reserve(world, 0)) ||
        (h.gone > 0 && !pl_buffer_reserve(memory, &pl_heat_step_of(heats)->gone,
                                          (size_t)h.gone * sizeof(plumb_body_gone))) ||
        !pl_buffer_reserve(memory, &f->breaks, (size_t)h.breaks * sizeof(plumb_body_break)) ||
        !pl_buffer_reserve(memory, &f->pieces, (size_t)h.parts * sizeof(plumb_body))) {
        return PLUMB_E_MEMORY;
    }
    from += sizeof h;
    if (h.gone > 0) {
        from = read_list(&pl_heat_step_of(heats)->gone, h.gone, sizeof(plumb_body_gone), from);
    }
    from = read_list(&f->breaks, h.breaks, sizeof(plumb_body_break), from);
    read_list(&f->pieces, h.parts, sizeof(plumb_body), from);
    heats->gone_count = (uint32_t)h.gone;
    f->break_count = (uint32_t)h.breaks;
    f->piece_count = (uint32_t)h.parts;
    if (!are_sound(world, h.parts)) {
        heats->gone_count = f->break_count = f->piece_count = 0;
        return PLUMB_E_IMAGE;
    }
    return PLUMB_OK;
}
