// hash.c - plumb_world_hash: all that decides later steps, as 64 bits.
//
// Reads: the sections of section.h as far as they count; by hand, because only part of them decides
// motion or padding and addresses lie in them: contacts, awake or asleep, joints, characters, pending commands, user
// components. Writes: nothing.
// Cost: O(state), about 8 bytes a cycle.
#include "api/command.h"
#include "plumb/snapshot.h"
#include "snapshot/section.h"

#include <string.h>

// What few worlds have, and none had once: where it is nowhere, hashes are what they were.
static bool is_absent(const pl_section *section)
{
    static const char *const names[] = { "kinetic_friction", "shelter",     "wake",
                                         "refractive_index", "reflectance", "absorption" };
    bool rare = false;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        rare |= strcmp(section->name, names[i]) == 0;
    }
    for (size_t i = 0; rare && i < pl_section_bytes(section); ++i) {
        rare = section->data[i] == 0;
    }
    return rare;
}

static void add_section(pl_digest *digest, const plumb_world *world, uint32_t i)
{
    pl_section section = pl_section_at(world, i);
    if (section.hashed == 0 || section.count == 0 || is_absent(&section)) {
        return;
    }
    if (section.data == NULL) {
        char gathered[PL_GATHERED_MOST];
        pl_section_write(world, i, &section, gathered);
        pl_digest_add(digest, gathered, pl_section_bytes(&section));
    } else if (section.hashed == section.stride) {
        pl_digest_add(digest, section.data, pl_section_bytes(&section));
    } else {
        for (uint32_t k = 0; k < section.count; ++k) {
            pl_digest_add(digest, section.data + (size_t)k * section.stride, section.hashed);
        }
    }
}

#define KEPT_FLAGS (~PL_PAIR_FACE_MASK) // where to look first changes nothing

// What a contact hands on to the next step.
static void add_pair(pl_digest *digest, const pl_pair *p)
{
    struct {
        uint32_t a, b, feature[2];
        uint64_t flags;
        real impulse[6];
    } kept = { p->a,
               p->b,
               { p->feature[0], p->feature[1] },
               p->flags & KEPT_FLAGS,
               { p->normal[0], p->normal[1], p->tangent[0], p->tangent[1], p->rolling, 0 } };
    pl_digest_add(digest, &kept, sizeof kept);
}

// Contacts that have something to hand on to the next step. Which others are in the list, and where,
// depends on when the grids were filed last.
static void add_pairs(pl_digest *digest, const plumb_world *world)
{
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    for (uint32_t i = 0; i < world->broad.pairs.count; ++i) {
        const pl_pair *p = &pairs[i];
        if ((p->flags & KEPT_FLAGS) != 0 || p->normal[0] != 0 || p->normal[1] != 0 ||
            p->rolling != 0) {
            add_pair(digest, p);
        }
    }
}

// Contacts of what sleeps, by islands.
static void add_sleepers(pl_digest *digest, const plumb_world *world)
{
    const pl_sleep *s = &world->sleep;
    for (uint32_t i = 0; i < s->island_slots; ++i) {
        const pl_island *island = &pl_islands(s)[i];
        if (!pl_island_is_open(island)) {
            continue;
        }
        const uint32_t kept[] = { i, island->first_body, island->body_count, island->due };
        pl_digest_add(digest, kept, sizeof kept);
        for (uint32_t c = island->first_contact; c != PL_NONE;
             c = pl_sleeping_contacts(s)[c].next) {
            add_pair(digest, &pl_sleeping_contacts(s)[c].pair);
        }
    }
}

// What the owners of runs of flush faces bore.
static void add_loads(pl_digest *digest, const plumb_world *world)
{
    const pl_run_load *loads = world->internal_edges.loads.data;
    for (uint32_t i = 0; i < world->internal_edges.load_count; ++i) {
        const pl_run_load *l = &loads[i];
        struct {
            uint32_t mover, serial;
            plumb_entity ground;
            uint32_t feature[2];
            real values[8];
        } kept = { l->mover,
                   l->serial,
                   l->ground,
                   { l->feature[0], l->feature[1] },
                   { l->normal[0], l->normal[1], l->tangent[0], l->tangent[1], l->rolling, l->nx,
                     l->ny, 0 } };
        pl_digest_add(digest, &kept, sizeof kept);
    }
}

#define JOINT_SIZE(path)     +sizeof(((pl_joint *)0)->path)
#define CHARACTER_SIZE(path) +sizeof(((pl_character *)0)->path)
#define COPY(path)                                                                                 \
    memcpy(at, &item->path, sizeof item->path);                                                    \
    at += sizeof item->path;

static void add_joints(pl_digest *digest, const plumb_world *world)
{
    for (uint32_t i = 0; i < world->joints.count; ++i) {
        const pl_joint *item = &pl_joint_items(&world->joints)[i];
        char members[0 PL_STATE_JOINT(JOINT_SIZE)];
        char *at = members;
        PL_STATE_JOINT(COPY)
        pl_digest_add(digest, members, sizeof members);
        if (item->desc.kind == PLUMB_CABLE) {
            at = members;
            PL_STATE_CABLE(COPY)
            pl_digest_add(digest, members, (size_t)(at - members));
        }
    }
}

// What few of the few that have settings have: charge and attraction, drag, engines, breaking, dipoles and what bodies rest under. Where
// one is nowhere, hashes are what they were before it was known.
static void add_holds(pl_digest *digest, const plumb_world *world)
{
    static const char none[sizeof(pl_body_settings)] = { 0 };
    const pl_body_settings *items = world->settings.items.data;
    const size_t charge = PL_SETTINGS_HASHED, drag = PL_SETTINGS_DRAG, engine = PL_SETTINGS_ENGINE,
                 breaks = PL_SETTINGS_BREAK, dipole = PL_SETTINGS_DIPOLE, low = PL_SETTINGS_LOW,
                 pull = PL_SETTINGS_PULL, end = sizeof *items;
    for (uint32_t i = 0; i < world->settings.count; ++i) {
        const char *from = (const char *)&items[i];
        if (memcmp(from + charge, none, end - charge) == 0) {
            continue;
        }
        pl_digest_add(digest, &items[i].body, sizeof items[i].body);
        pl_digest_add(digest, from + charge, drag - charge);
        const bool burns = memcmp(from + engine, none, breaks - engine) != 0 ||
                           memcmp(from + low, none, pull - low) != 0;
        if (burns || memcmp(from + drag, none, engine - drag) != 0) {
            pl_digest_add(digest, from + drag, engine - drag);
        }
        if (burns) {
            char all[sizeof *items]; // as one, as they once lay
            memcpy(all, from + engine, breaks - engine);
            memcpy(all + (breaks - engine), from + low, pull - low);
            pl_digest_add(digest, all, breaks - engine + (pull - low));
        }
        if (memcmp(from + breaks, none, dipole - breaks) != 0) {
            pl_digest_add(digest, from + breaks, dipole - breaks);
        }
        if (memcmp(from + dipole, none, low - dipole) != 0) {
            pl_digest_add(digest, from + dipole, low - dipole);
        }
        if (memcmp(from + pull, none, end - pull) != 0) {
            pl_digest_add(digest, from + pull, end - pull);
        }
    }
}

static void add_characters(pl_digest *digest, const plumb_world *world)
{
    for (uint32_t i = 0; i < world->characters.count; ++i) {
        const pl_character *item = &pl_character_items(&world->characters)[i];
        char members[0 PL_STATE_CHARACTER(CHARACTER_SIZE)];
        char *at = members;
        PL_STATE_CHARACTER(COPY)
        pl_digest_add(digest, members, sizeof members);
    }
}

// A component that tells its fields counts by them, any other by its bytes.
static void add_component(pl_digest *digest, const pl_component *c)
{
    pl_digest_add(digest, c->name, strlen(c->name));
    if (c->count == 0) {
        return;
    }
    pl_digest_add(digest, c->owners.data, c->count * sizeof(plumb_entity));
    if (c->desc.field_count == 0) {
        pl_digest_add(digest, c->values.data, c->count * c->desc.size);
        return;
    }
    for (uint32_t row = 0; row < c->count; ++row) {
        pl_component_digest(c, (const char *)c->values.data + row * c->desc.size, digest);
    }
}

uint64_t plumb_world_hash(const plumb_world *world)
{
    return world == NULL ? 0 : pl_world_digest(world, true);
}

uint64_t pl_world_digest(const plumb_world *world, bool values)
{
    pl_digest digest;
    pl_digest_begin(&digest);
    for (uint32_t i = values ? 0 : 1; i < pl_section_fixed_count(); ++i) {
        add_section(&digest, world, i);
    }
    add_pairs(&digest, world);
    add_sleepers(&digest, world);
    add_loads(&digest, world);
    add_joints(&digest, world);
    add_characters(&digest, world);
    add_holds(&digest, world);
    pl_commands_digest(world, &digest);
    if (world->one_way_pieces >
        0) { // where bodies came from decides what holds them (narrow/one_way.c)
        pl_digest_add(&digest, &world->last_dt, sizeof world->last_dt);
    }
    for (uint32_t i = 0; i < world->components.count; ++i) {
        add_component(&digest, &world->components.items[i]);
    }
    return pl_digest_end(&digest);
}
