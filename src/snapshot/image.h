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
#define PL_IMAGE_VERSION 1u

typedef struct pl_image_header {
    uint64_t magic;
    uint32_t version;
    uint32_t real_bytes; // 4 or 8
    uint64_t bytes;      // of the whole image
    uint64_t checksum;   // of the whole image with 0 here; names it, too
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
