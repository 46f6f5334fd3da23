// save.c - the image of a world: all of it, or a frame of what is not as in a base.
//
// Which columns change in a step need not be declared: a section goes into a frame when its bytes
// differ from those of the base. In a world that only moves these are transforms, velocities, fat
// boxes, contacts; shapes, masses, materials, handles stay in the base until somebody changes them.
//
// Reads: the world, the base. Writes: the buffer. Cost: O(state) copied and digested; for a frame all
// of it is compared, and what differs copied and digested.
#include "plumb/snapshot.h"
#include "snapshot/image.h"
#include "world/check.h"

#include <string.h>

typedef struct writer {
    const plumb_world *world;
    char *to;
    size_t size;    // of the buffer
    size_t offset;  // where the next section goes
    bool overflown; // it did not fit; offset goes on counting
} writer;

static size_t directory_bytes(const plumb_world *world)
{
    return sizeof(pl_image_header) + pl_section_count(world) * sizeof(pl_image_entry);
}

size_t plumb_world_snapshot_size(const plumb_world *world)
{
    if (world == NULL) {
        return 0;
    }
    size_t bytes = directory_bytes(world);
    for (uint32_t i = 0; i < pl_section_count(world); ++i) {
        pl_section section = pl_section_at(world, i);
        bytes += pl_image_padded(pl_section_bytes(&section));
    }
    return bytes;
}

static bool is_same(const plumb_world *world, uint32_t i, const pl_section *section,
                    const pl_image_cursor *base)
{
    return base->entry.count == section->count && base->entry.stride == section->stride &&
           pl_section_equals(world, i, section, base->data);
}

static void write_section(writer *w, uint32_t i, const pl_section *section)
{
    size_t bytes = pl_section_bytes(section), padded = pl_image_padded(bytes);
    if (padded > w->size || w->offset > w->size - padded) {
        w->overflown = true;
    } else {
        pl_section_write(w->world, i, section, w->to + w->offset);
        memset(w->to + w->offset + bytes, 0, padded - bytes);
    }
    w->offset += padded;
}

// Writes the image but for what pl_image_seal writes, against a base if there is one; returns its size. The room for
// the directory is there.
static size_t write_image(writer *w, const pl_image *base)
{
    pl_image_cursor at = { 0 };
    uint32_t count = pl_section_count(w->world);
    if (base != NULL) {
        at = pl_image_begin(base);
    }
    w->offset = directory_bytes(w->world);
    for (uint32_t i = 0; i < count; ++i) {
        pl_section section = pl_section_at(w->world, i);
        pl_image_entry entry = { section.count, section.stride };
        if (base != NULL) {
            pl_image_next(base, &at);
        }
        if (base != NULL && is_same(w->world, i, &section, &at)) {
            entry.stride = 0;
        } else {
            write_section(w, i, &section);
        }
        memcpy(w->to + sizeof(pl_image_header) + i * sizeof entry, &entry, sizeof entry);
    }
    pl_image_header header = { .magic = PL_IMAGE_MAGIC,
                               .version = PL_IMAGE_VERSION,
                               .precision = PL_PRECISION,
                               .bytes = w->offset,
                               .base = base == NULL ? 0 : base->header.checksum,
                               .section_count = count,
                               .step_count = w->world->step_count,
                               .time = w->world->time };
    memcpy(w->to, &header, sizeof header);
    return w->offset;
}

void pl_image_seal(const plumb_world *world, char *bytes)
{
    pl_image_header header;
    memcpy(&header, bytes, sizeof header);
    header.schema = pl_section_schema();
    header.user_schema = pl_section_user_schema(world);
    header.checksum = pl_image_checksum(bytes, &header);
    memcpy(bytes, &header, sizeof header);
}

bool pl_image_write(const plumb_world *world, void *buffer, size_t size)
{
    writer w = { .world = world, .to = buffer, .size = size };
    return directory_bytes(world) <= size && write_image(&w, NULL) <= size;
}

bool pl_image_is_current(const plumb_world *world, const pl_image *image)
{
    pl_image_cursor at = pl_image_begin(image);
    if (image->header.section_count != pl_section_count(world)) {
        return false;
    }
    for (uint32_t i = 0; i < pl_section_count(world); ++i) {
        pl_section section = pl_section_at(world, i);
        pl_image_next(image, &at);
        if (!is_same(world, i, &section, &at)) {
            return false;
        }
    }
    return true;
}

static plumb_result save(const plumb_world *world, const char *function, const pl_image *base,
                         void *buffer, size_t size, size_t *bytes)
{
    writer w = { .world = world, .to = buffer, .size = size };
    size_t needed = directory_bytes(world);
    if (needed <= size) {
        needed = write_image(&w, base);
        if (!w.overflown) {
            pl_image_seal(world, buffer);
        }
    } else if (base == NULL) {
        needed = plumb_world_snapshot_size(world);
    }
    if (needed > size) {
        return pl_fail(world, PLUMB_E_RANGE, function,
                       "size is %zu; it must be at least %zu in this world now", size, needed);
    }
    *bytes = needed;
    return PLUMB_OK;
}

plumb_result plumb_world_save(const plumb_world *world, void *buffer, size_t size)
{
    PL_TRY(pl_check_world(world));
    size_t bytes;
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(pl_check_pointer(world, __func__, "buffer", buffer));
    return save(world, __func__, NULL, buffer, size, &bytes);
}

plumb_result plumb_world_save_frame(const plumb_world *world, const void *base, size_t base_size,
                                    void *buffer, size_t size, size_t *bytes)
{
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(pl_check_pointer(world, __func__, "base", base));
    PL_TRY(pl_check_pointer(world, __func__, "buffer", buffer));
    PL_TRY(pl_check_pointer(world, __func__, "bytes", bytes));
    pl_image image;
    PL_TRY(pl_image_fit(world, __func__, "base", base, base_size, false, &image));
    if (image.header.base != 0) {
        return pl_fail(world, PLUMB_E_IMAGE, __func__,
                       "base is a frame; it must come from plumb_world_save");
    }
    return save(world, __func__, &image, buffer, size, bytes);
}

plumb_result plumb_snapshot_read_info(const void *image, size_t size, plumb_snapshot_info *info)
{
    pl_image opened;
    if (image == NULL || info == NULL) {
        return PLUMB_E_NULL;
    }
    if (pl_image_open(image, size, true, &opened) != NULL) {
        return PLUMB_E_IMAGE;
    }
    *info = (plumb_snapshot_info){ .bytes = opened.header.bytes,
                                   .is_frame = opened.header.base != 0,
                                   .id = opened.header.checksum,
                                   .base_id = opened.header.base,
                                   .step_count = opened.header.step_count,
                                   .time = opened.header.time };
    return PLUMB_OK;
}
