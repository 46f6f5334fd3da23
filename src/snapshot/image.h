// image.h - how an image lies in memory, and how one is read without a world.
//
//     header | directory: an entry a section | sections, each padded to 8 bytes
//
// A frame leaves out sections that are what its base has. All numbers are the machine's own; the magic
// number tells a foreign byte order. Images may begin at any address.
#ifndef PL_IMAGE_H
#define PL_IMAGE_H

#include "snapshot/section.h"

#define PL_IMAGE_MAGIC   UINT64_C(0x474d49424d554c50) // "PLUMBIMG" in a little-endian file
#define PL_IMAGE_VERSION 3u

typedef struct pl_image_header {
    uint64_t magic;
    uint32_t version;
    uint32_t precision; // PL_PRECISION
    uint64_t bytes;     // of the whole image
    uint64_t checksum;  // of the whole image with 0 here; names it, too
    uint64_t schema, user_schema;
    uint64_t base; // checksum of the image that a frame belongs to; 0: complete
    uint64_t section_count;
    uint64_t step_count;
    double time; // [s]
} pl_image_header;

typedef struct pl_image_entry {
    uint32_t count;
    uint32_t stride; // [B]; 0: the section is that of the base
} pl_image_entry;

// An image that was checked.
typedef struct pl_image {
    const char *bytes;
    pl_image_header header;
} pl_image;

// What is wrong with an image; NULL: nothing, and *image is filled. `strict`: the checksum is verified.
const char *pl_image_open(const void *buffer, size_t size, bool strict, pl_image *image);

// The same, and that it fits the world; refuses it in the name of `field` (restore.c). E_IMAGE.
plumb_result pl_image_fit(const plumb_world *world, const char *function, const char *field,
                          const void *buffer, size_t size, bool strict, pl_image *image);

uint64_t pl_image_checksum(const char *bytes, const pl_image_header *header);

// A section of an image, or of a frame and its base.
typedef struct pl_image_part {
    const char *data; // 8-byte aligned
    uint32_t count;
} pl_image_part;

// Whether an image that fits the world (or a frame with its base) holds what a world can be; as below.
bool pl_image_is_sound(plumb_world *world, const pl_image *image, const pl_image *base,
                       bool *starved);
// Whether sections, as many as the world has, may become the world: see check.h. *starved: false, for lack of
// memory.
bool pl_parts_are_sound(plumb_world *world, const pl_image_part *parts, bool *starved);

// Images that do not leave the library need no schema and no checksum.
// The image of the world as it is, without; false when it does not fit.
bool pl_image_write(const plumb_world *world, void *buffer, size_t size);
// Gives them to an image of this world.
void pl_image_seal(const plumb_world *world, char *bytes);
// Reads an image written so; false when its directory does not agree with its size.
bool pl_image_view(const void *buffer, size_t size, pl_image *image);
// Every section of the world is as in a complete image.
bool pl_image_is_current(const plumb_world *world, const pl_image *image);
// Sets to 0 what means something in this process only.
void pl_image_strip(const pl_image *image);
// The world becomes the image, which fits it: as plumb_world_restore. False when out of memory.
bool pl_image_restore(plumb_world *world, const pl_image *image);
// Makes room for what the image holds. False when out of memory.
bool pl_image_reserve(plumb_world *world, const pl_image *image);
// A complete image whose sections have elements of this world's sizes.
bool pl_image_has_sections_of(const plumb_world *world, const pl_image *image);
// Whether one may become the other in the midst of a step: the passes hold on to what is alike in both.
bool pl_image_may_play(const plumb_world *world, const pl_image *before, const pl_image *after);
// In the midst of a step: takes over the sections of `after` that are not as in `before`; room is
// reserved. What the passes of this step have found out so far stays.
void pl_image_play(plumb_world *world, const pl_image *before, const pl_image *after);

// Writes what turns one into the other; returns the bytes needed, of which those beyond `size` were not
// written. delta.c.
size_t pl_delta_write(const pl_image *from, const pl_image *to, void *buffer, size_t size);
// [B] of the image that a delta leads to; 0: it is damaged.
size_t pl_delta_result_bytes(const void *delta, size_t size);
// Rebuilds that image in a buffer of so many bytes. False: it does not fit `from`.
bool pl_delta_apply(const pl_image *from, const void *delta, size_t size, void *buffer,
                    pl_image *to);

// Goes through the sections of an image in order.
typedef struct pl_image_cursor {
    uint64_t index;
    pl_image_entry entry;
    const char *data;
    size_t offset; // of the section behind this one
} pl_image_cursor;

static inline size_t pl_image_padded(size_t bytes)
{
    return (bytes + 7) & ~(size_t)7;
}

// Before the first section; then each call moves on by one. pl_image_open has seen that all lie inside.
pl_image_cursor pl_image_begin(const pl_image *image);
void pl_image_next(const pl_image *image, pl_image_cursor *cursor);

#endif
