// section_own.c - see section_own.h: what list.h calls OWN, and the components that users register.
//
// Reads and writes the world's registry, pool of corners, tombstones, switches of systems, components.
#include "snapshot/section_own.h"

#include <string.h>

// Systems are code and stay; whether one is switched off is state, told by its name.
typedef struct system_switch {
    uint64_t name; // digest
    uint64_t enabled;
} system_switch;

_Static_assert(PL_SYSTEM_MAX * sizeof(system_switch) <= PL_GATHERED_MOST, "raise PL_GATHERED_MOST");

void pl_own_write_switches(const plumb_world *world, char *to)
{
    for (uint32_t i = 0; i < world->systems.count; ++i) {
        const pl_system *system = &world->systems.items[i];
        const system_switch s = { pl_digest_of(system->name, strlen(system->name)),
                                  system->enabled };
        memcpy(to + i * sizeof s, &s, sizeof s);
    }
}

static void read_switches(plumb_world *world, const char *from, uint32_t count)
{
    for (uint32_t i = 0; i < world->systems.count; ++i) {
        pl_system *system = &world->systems.items[i];
        uint64_t name = pl_digest_of(system->name, strlen(system->name));
        for (uint32_t k = 0; k < count; ++k) {
            system_switch s;
            memcpy(&s, from + k * sizeof s, sizeof s);
            if (s.name == name) {
                system->enabled = s.enabled != 0;
            }
        }
    }
}

pl_section pl_own_section(const plumb_world *world, uint32_t which)
{
    switch (which) {
    case PL_OWN_REGISTRY:
        return (pl_section){ .table = "registry",
                             .name = "slots",
                             .data = (char *)world->registry.slots,
                             .count = world->registry.count,
                             .stride = sizeof(pl_slot),
                             .pitch = sizeof(pl_slot),
                             .passing = -1,
                             .hashed = sizeof(pl_slot) };
    case PL_OWN_CORNERS:
        return (pl_section){ .table = "vertices",
                             .name = "items",
                             .data = (char *)world->vertices.items,
                             .count = world->vertices.count,
                             .stride = sizeof(pl_vertex),
                             .pitch = sizeof(pl_vertex),
                             .passing = -1,
                             .hashed = sizeof(pl_vertex) };
    case PL_OWN_TOMBSTONES:
        return (pl_section){ .table = "world",
                             .name = "tombstones",
                             .data = world->tombstones.data,
                             .count = world->pieces.table.count,
                             .stride = sizeof(pl_tombstone),
                             .pitch = sizeof(pl_tombstone),
                             .passing = -1 };
    default:
        return (pl_section){ .table = "systems",
                             .name = "enabled",
                             .count = world->systems.count,
                             .stride = sizeof(system_switch),
                             .pitch = sizeof(system_switch),
                             .passing = -1 };
    }
}

bool pl_own_reserve(plumb_world *world, uint32_t which, uint32_t count)
{
    uint32_t slots = world->registry.count, corners = world->vertices.count;
    switch (which) {
    case PL_OWN_REGISTRY:
        return count <= slots ||
               pl_registry_reserve(&world->memory, &world->registry, count - slots);
    case PL_OWN_CORNERS:
        return count <= corners ||
               pl_pool_reserve(&world->memory, &world->vertices, count - corners);
    default: // tombstones: with the pieces
        return true;
    }
}

void pl_own_read(plumb_world *world, uint32_t which, const char *from, uint32_t count)
{
    void *to = NULL;
    size_t bytes = 0;
    switch (which) {
    case PL_OWN_REGISTRY:
        world->registry.count = count;
        ++world->registry.moves;
        to = world->registry.slots;
        bytes = count * sizeof(pl_slot);
        break;
    case PL_OWN_CORNERS:
        world->vertices.count = count;
        to = world->vertices.items;
        bytes = count * sizeof(pl_vertex);
        break;
    case PL_OWN_TOMBSTONES:
        to = world->tombstones.data;
        bytes = count * sizeof(pl_tombstone);
        if (to != NULL) {
            memset((char *)to + bytes, 0, world->tombstones.size - bytes);
        }
        break;
    default:
        read_switches(world, from, count);
        break;
    }
    if (bytes > 0) {
        memcpy(to, from, bytes);
    }
}

bool pl_own_lend(plumb_world *world, uint32_t which, void *data, uint32_t count)
{
    switch (which) {
    case PL_OWN_REGISTRY:
        world->registry.slots = data;
        world->registry.count = count;
        return true;
    case PL_OWN_CORNERS:
        world->vertices.items = data;
        world->vertices.count = count;
        return true;
    case PL_OWN_TOMBSTONES:
        world->tombstones.data = data;
        return count == world->pieces.table.count;
    default:
        return true; // switches of systems that are not there are passed over
    }
}

//---- components: two sections each ---------------------------------------------------------------

pl_section pl_own_component(const plumb_world *world, uint32_t which)
{
    const pl_component *c = &world->components.items[which / 2];
    bool owners = which % 2 == 1;
    const uint32_t size = owners ? (uint32_t)sizeof(plumb_entity) : (uint32_t)c->desc.size;
    return (pl_section){ .table = c->name,
                         .name = owners ? "owner" : "value",
                         .data = owners ? c->owners.data : c->values.data,
                         .count = c->count,
                         .stride = size,
                         .pitch = size,
                         .passing = -1 };
}

void pl_own_read_component(plumb_world *world, uint32_t which, const char *from, uint32_t count)
{
    pl_component *c = &world->components.items[which / 2];
    c->count = count;
    ++c->version;
    pl_section section = pl_own_component(world, which);
    if (count > 0) {
        memcpy(section.data, from, pl_section_bytes(&section));
    }
}

bool pl_own_reserve_component(plumb_world *world, uint32_t which, uint32_t count)
{
    pl_component *c = &world->components.items[which / 2];
    bool owners = which % 2 == 1;
    return pl_buffer_reserve(&world->memory, owners ? &c->owners : &c->values,
                             count * (owners ? sizeof(plumb_entity) : c->desc.size));
}
