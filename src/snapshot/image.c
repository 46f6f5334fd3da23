// image.c - see image.h. Reads: the image. Writes: nothing. Cost: O(sections), with the checksum
// O(bytes).
#include "snapshot/image.h"

#include <string.h>

uint64_t pl_image_checksum(const char *bytes, const pl_image_header *header)
{
    return pl_digest_sealed(header, sizeof *header, offsetof(pl_image_header, checksum),
                            bytes + sizeof *header, header->bytes - sizeof *header);
}

// The directory agrees with the size.
static bool is_laid_out(const pl_image *image)
{
    size_t left = image->header.bytes - sizeof(pl_image_header);
    if (image->header.section_count > left / sizeof(pl_image_entry)) {
        return false;
    }
    left -= image->header.section_count * sizeof(pl_image_entry);
    for (uint64_t i = 0; i < image->header.section_count; ++i) {
        pl_image_entry entry;
        memcpy(&entry, image->bytes + sizeof(pl_image_header) + i * sizeof entry, sizeof entry);
        size_t bytes = pl_image_padded((size_t)entry.count * entry.stride);
        if (bytes > left || (entry.stride == 0 && image->header.base == 0)) {
            return false;
        }
        left -= bytes;
    }
    return left == 0;
}

bool pl_image_view(const void *buffer, size_t size, pl_image *image)
{
    if (size < sizeof image->header) {
        return false;
    }
    image->bytes = buffer;
    memcpy(&image->header, buffer, sizeof image->header);
    return image->header.bytes >= sizeof image->header && image->header.bytes <= size &&
           is_laid_out(image);
}

const char *pl_image_open(const void *buffer, size_t size, bool strict, pl_image *image)
{
    pl_image_header *h = &image->header;
    image->bytes = buffer;
    if (size < sizeof *h) {
        return "is truncated";
    }
    memcpy(h, buffer, sizeof *h);
    if (h->magic == pl_reversed(PL_IMAGE_MAGIC)) {
        return "was made on a machine of another byte order";
    }
    if (h->magic != PL_IMAGE_MAGIC) {
        return "is no image of a world";
    }
    if (h->version != PL_IMAGE_VERSION) {
        return "is of another version of the format";
    }
    if (h->precision != PL_PRECISION) {
        return "is of a world of another precision";
    }
    if (h->schema != pl_section_schema()) {
        return "was made by a build that stores other columns";
    }
    if (size < h->bytes) {
        return "is truncated";
    }
    if (h->bytes < sizeof *h || !is_laid_out(image) ||
        (strict && pl_image_checksum(image->bytes, h) != h->checksum)) {
        return "is damaged";
    }
    return NULL;
}

void pl_image_strip(const pl_image *image)
{
    pl_image_cursor at = pl_image_begin(image);
    for (uint64_t i = 0; i < image->header.section_count; ++i) {
        pl_image_next(image, &at);
        if (at.entry.stride != 0) {
            pl_section_strip((uint32_t)i, (char *)at.data, at.entry.count);
        }
    }
}

pl_image_cursor pl_image_begin(const pl_image *image)
{
    return (pl_image_cursor){ .index = UINT64_MAX,
                              .offset = sizeof(pl_image_header) +
                                        image->header.section_count * sizeof(pl_image_entry) };
}

void pl_image_next(const pl_image *image, pl_image_cursor *cursor)
{
    uint64_t i = ++cursor->index;
    memcpy(&cursor->entry, image->bytes + sizeof(pl_image_header) + i * sizeof(pl_image_entry),
           sizeof(pl_image_entry));
    cursor->data = image->bytes + cursor->offset;
    cursor->offset += pl_image_padded((size_t)cursor->entry.count * cursor->entry.stride);
}
