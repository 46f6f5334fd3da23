// check.h - whether an image may become a world: all that later code relies on. For images that somebody else
// may have made; the checksum guards against accidents alone.
#ifndef PL_CHECK_IMAGE_H
#define PL_CHECK_IMAGE_H

#include "snapshot/section.h"

// An image as a world that cannot step: columns and lists lie in the image.
typedef struct pl_suspect {
    plumb_world world;
    const plumb_world *like; // the world that it is for
    uint32_t *marks;         // one for each row, slot, piece or corner; 0 between checks
} pl_suspect;

// Joints, islands and sleeping contacts lie closer in images than in worlds: see PL_SAVED_BYTES.
static inline const pl_joint *pl_suspect_joint(const pl_suspect *s, uint32_t i)
{
    return (const pl_joint *)(const void *)((const char *)s->world.joints.items.data +
                                            i * PL_SAVED_BYTES(pl_joint));
}

static inline const pl_island *pl_suspect_island(const pl_suspect *s, uint32_t i)
{
    return (const pl_island *)(const void *)((const char *)s->world.sleep.islands.data +
                                             i * PL_SAVED_BYTES(pl_island));
}

static inline const pl_sleeping_contact *pl_suspect_sleeping(const pl_suspect *s, uint32_t i)
{
    return (const pl_sleeping_contact *)(const void *)((const char *)s->world.sleep.contacts.data +
                                                       i * PL_SAVED_BYTES(pl_sleeping_contact));
}

// The body row of a live handle, PL_NONE: it is none.
static inline uint32_t pl_suspect_row(const pl_suspect *s, plumb_body body)
{
    const pl_slot *slot = pl_registry_find(&s->world.registry, body.entity);
    return slot != NULL && slot->kind == PLUMB_KIND_BODY ? slot->row : PL_NONE;
}

// Every number is finite, and not beyond what the step accepts.
bool pl_are_reals(const void *data, size_t count);
bool pl_are_near_reals(const void *data, size_t count);
// Bytes that are read as bool.
bool pl_are_bools(const void *data, size_t count);

// Each of these takes for granted what those before it have found sound.
bool pl_check_registry(pl_suspect *s);
bool pl_check_bodies(pl_suspect *s);
bool pl_check_pieces(pl_suspect *s);
bool pl_check_materials(pl_suspect *s);
bool pl_check_joints(pl_suspect *s);
bool pl_check_sleep(pl_suspect *s);
bool pl_check_contacts(pl_suspect *s);
bool pl_check_internal_edges(pl_suspect *s);
bool pl_check_extras(pl_suspect *s); // characters, settings, targets, tables, counters

#endif
