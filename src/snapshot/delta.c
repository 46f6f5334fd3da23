// delta.c - what turns one image into another, and back.
//
// Section by section, each element is compared with one of the image before: the one with the same
// index or, where elements have a key (contacts: their two pieces), the one with the same key. How
// their differences are coded: sparse.h.
//
//     delta:   header | coded header and directory of `to` | a bit a section: changed | changed sections
//     section: (skip, match, insert)* over the elements | coded differences
//
// skip: elements of `from` that are gone; match: elements compared; insert: elements that are new.
//
// Reads: two images, or image and delta. Writes: the buffer. Cost: O(bytes).
#include "plumb/snapshot.h"
#include "snapshot/image.h"
#include "snapshot/sparse.h"

#include <string.h>

#define DELTA_MAGIC   UINT64_C(0x544c44424d554c50) // "PLUMBDLT" in a little-endian file
#define DELTA_VERSION 1u
#define SEARCH_MOST   256u // elements of `from` that are searched for a key

typedef struct delta_header {
    uint64_t magic;
    uint64_t version;
    uint64_t bytes;
    uint64_t checksum; // of the delta with 0 here
    uint64_t from, to; // checksums of the images
    uint64_t to_bytes;
} delta_header;

static uint64_t checksum_of(const char *bytes, const delta_header *header)
{
    return pl_digest_sealed(header, sizeof *header, offsetof(delta_header, checksum),
                            bytes + sizeof *header, header->bytes - sizeof *header);
}

//---- which element is compared with which --------------------------------------------------------

typedef struct run {
    uint32_t skip, match, insert;
} run;

// A section in both images.
typedef struct sides {
    const char *from;
    char *to;
    uint32_t from_count, to_count, stride, key;
} sides;

static bool has_key_of(const sides *s, uint32_t to, uint32_t from)
{
    return s->key == 0 ? to == from
                       : memcmp(s->to + (size_t)to * s->stride, s->from + (size_t)from * s->stride,
                                s->key) == 0;
}

// How many elements of `from`, from `j` on, come before the one of to[i]; UINT32_MAX: it is not near.
static uint32_t way_to(const sides *s, uint32_t i, uint32_t j)
{
    for (uint32_t skip = 0; skip < SEARCH_MOST && j + skip < s->from_count; ++skip) {
        if (has_key_of(s, i, j + skip)) {
            return skip;
        }
    }
    return UINT32_MAX;
}

static run next_run(const sides *s, uint32_t i, uint32_t j)
{
    run r = { 0, 0, 0 };
    uint32_t skip = way_to(s, i, j);
    if (skip != UINT32_MAX) {
        r.skip = skip;
        j += skip;
        while (i < s->to_count && j < s->from_count && has_key_of(s, i, j)) {
            ++i, ++j, ++r.match;
        }
    }
    while (i < s->to_count && way_to(s, i, j) == UINT32_MAX) {
        ++i, ++r.insert;
    }
    return r;
}

//---- writing -------------------------------------------------------------------------------------

static void put_section(pl_sparse_coder *c, const sides *s)
{
    uint32_t i = 0, j = 0;
    while (i < s->to_count) {
        run r = next_run(s, i, j);
        pl_sparse_put_number(c, r.skip);
        pl_sparse_put_number(c, r.match);
        pl_sparse_put_number(c, r.insert);
        i += r.match + r.insert;
        j += r.skip + r.match;
    }
    for (i = j = 0; i < s->to_count;) {
        run r = next_run(s, i, j);
        size_t at = (size_t)i * s->stride, matched = (size_t)r.match * s->stride;
        pl_sparse_put(c, s->to + at, s->from + (size_t)(j + r.skip) * s->stride, matched);
        pl_sparse_put(c, s->to + at + matched, NULL, (size_t)r.insert * s->stride);
        i += r.match + r.insert;
        j += r.skip + r.match;
    }
    pl_sparse_end(c);
}

// The section that both cursors are at. One that `from` leaves to its base counts as empty.
static sides sides_at(const pl_image_cursor *from, const pl_image_cursor *to)
{
    return (sides){ .from = from->data,
                    .to = (char *)to->data,
                    .from_count = from->entry.stride == 0 ? 0 : from->entry.count,
                    .to_count = to->entry.stride == 0 ? 0 : to->entry.count,
                    .stride = to->entry.stride,
                    .key = pl_section_key((uint32_t)to->index) };
}

static bool is_changed(const sides *s)
{
    return s->to_count != s->from_count ||
           (s->to_count > 0 && memcmp(s->to, s->from, (size_t)s->to_count * s->stride) != 0);
}

static size_t directory_bytes(const pl_image *image)
{
    return sizeof(pl_image_header) + image->header.section_count * sizeof(pl_image_entry);
}

static void put_sections(pl_sparse_coder *c, const pl_image *from, const pl_image *to)
{
    uint64_t count = to->header.section_count;
    for (int pass = 0; pass < 2; ++pass) { // first the bits, then the sections
        pl_image_cursor at_from = pl_image_begin(from), at_to = pl_image_begin(to);
        unsigned bits = 0;
        for (uint64_t i = 0; i < count; ++i) {
            pl_image_next(from, &at_from);
            pl_image_next(to, &at_to);
            sides s = sides_at(&at_from, &at_to);
            bool changed = is_changed(&s);
            bits |= (unsigned)changed << i % 8;
            if (pass == 0 && (i % 8 == 7 || i + 1 == count)) {
                pl_sparse_put_byte(c, bits);
                bits = 0;
            } else if (pass == 1 && changed) {
                put_section(c, &s);
            }
        }
    }
}

// Both can be opened and are of one world.
static bool open_both(const void *from, size_t from_size, const void *to, size_t to_size,
                      pl_image *a, pl_image *b)
{
    return pl_image_open(from, from_size, true, a) == NULL &&
           pl_image_open(to, to_size, true, b) == NULL &&
           a->header.user_schema == b->header.user_schema &&
           a->header.section_count == b->header.section_count && a->header.base == b->header.base;
}

size_t pl_delta_write(const pl_image *from, const pl_image *to, void *buffer, size_t size)
{
    pl_sparse_coder c = { .to = buffer, .size = size, .used = sizeof(delta_header) };
    pl_sparse_put(&c, to->bytes, from->bytes, directory_bytes(to));
    pl_sparse_end(&c);
    put_sections(&c, from, to);
    if (c.used <= size) {
        delta_header h = { .magic = DELTA_MAGIC,
                           .version = DELTA_VERSION,
                           .bytes = c.used,
                           .from = from->header.checksum,
                           .to = to->header.checksum,
                           .to_bytes = to->header.bytes };
        h.checksum = checksum_of(buffer, &h);
        memcpy(buffer, &h, sizeof h);
    }
    return c.used;
}

// Coded differences take at most 9 bytes in 8 and a few a section, of which the directory has more bytes than that; a
// run is a keyed element of 8 bytes or more at the least, and its numbers 4 bytes (of long runs, more).
size_t plumb_snapshot_delta_bound(size_t image_size)
{
    return sizeof(delta_header) + 2 * image_size + 64;
}

plumb_result plumb_snapshot_delta(const void *from, size_t from_size, const void *to,
                                  size_t to_size, void *buffer, size_t size, size_t *bytes)
{
    pl_image a, b;
    if (from == NULL || to == NULL || buffer == NULL || bytes == NULL) {
        return PLUMB_E_NULL;
    }
    if (!open_both(from, from_size, to, to_size, &a, &b)) {
        return PLUMB_E_IMAGE;
    }
    *bytes = pl_delta_write(&a, &b, buffer, size);
    return *bytes > size ? PLUMB_E_RANGE : PLUMB_OK;
}

//---- reading -------------------------------------------------------------------------------------

// Goes through the runs twice: from the first to the last, to find where the differences begin, and
// again with them.
static void get_section(pl_sparse_decoder *d, const sides *s)
{
    pl_sparse_decoder runs = *d;
    uint32_t i = 0;
    while (i < s->to_count && !d->damaged) {
        pl_sparse_get_number(d);
        uint32_t match = pl_sparse_get_number(d), insert = pl_sparse_get_number(d),
                 left = s->to_count - i;
        if (match > left || insert > left - match || match + insert == 0) {
            d->damaged = true;
            return;
        }
        i += match + insert;
    }
    uint32_t j = 0;
    for (i = 0; i < s->to_count && !d->damaged;) {
        run r = { .skip = pl_sparse_get_number(&runs) };
        r.match = pl_sparse_get_number(&runs);
        r.insert = pl_sparse_get_number(&runs);
        uint32_t left = s->from_count - j;
        if (r.skip > left || r.match > left - r.skip) {
            d->damaged = true;
            return;
        }
        j += r.skip;
        size_t at = (size_t)i * s->stride, matched = (size_t)r.match * s->stride;
        pl_sparse_get(d, s->to + at, s->from + (size_t)j * s->stride, matched);
        pl_sparse_get(d, s->to + at + matched, NULL, (size_t)r.insert * s->stride);
        i += r.match + r.insert;
        j += r.match;
    }
    pl_sparse_drop(d);
}

static void get_sections(pl_sparse_decoder *d, const pl_image *from, const pl_image *to)
{
    uint64_t count = to->header.section_count;
    const unsigned char *bits = d->from + d->used;
    size_t bit_bytes = (size_t)(count + 7) / 8;
    if (bit_bytes > d->size - d->used) {
        d->damaged = true;
        return;
    }
    d->used += bit_bytes;
    pl_image_cursor at_from = pl_image_begin(from), at_to = pl_image_begin(to);
    for (uint64_t i = 0; i < count && !d->damaged; ++i) {
        pl_image_next(from, &at_from);
        pl_image_next(to, &at_to);
        sides s = sides_at(&at_from, &at_to);
        size_t bytes = (size_t)s.to_count * s.stride;
        if (s.from_count > 0 && at_from.entry.stride != s.stride) {
            d->damaged = true;
            return;
        }
        memset(s.to + bytes, 0, pl_image_padded(bytes) - bytes);
        if ((bits[i / 8] >> i % 8 & 1) != 0) {
            get_section(d, &s);
        } else if (s.from_count != s.to_count) {
            d->damaged = true;
        } else if (bytes > 0) {
            memcpy(s.to, s.from, bytes);
        }
    }
}

static bool open_delta(const void *delta, size_t size, delta_header *h)
{
    if (size < sizeof *h) {
        return false;
    }
    memcpy(h, delta, sizeof *h);
    return h->magic == DELTA_MAGIC && h->version == DELTA_VERSION && h->bytes >= sizeof *h &&
           h->bytes <= size && checksum_of(delta, h) == h->checksum;
}

size_t pl_delta_result_bytes(const void *delta, size_t size)
{
    delta_header h;
    return open_delta(delta, size, &h) ? h.to_bytes : 0;
}

bool pl_delta_apply(const pl_image *from, const void *delta, size_t size, void *buffer,
                    pl_image *to)
{
    delta_header h;
    if (!open_delta(delta, size, &h) || h.from != from->header.checksum ||
        h.to_bytes < directory_bytes(from)) {
        return false;
    }
    pl_sparse_decoder d = { .from = delta, .size = h.bytes, .used = sizeof h };
    pl_sparse_get(&d, buffer, from->bytes, directory_bytes(from));
    pl_sparse_drop(&d);
    // The sections are not there yet; that they fit is known once the directory is.
    if (d.damaged || !pl_image_view(buffer, h.to_bytes, to) || to->header.bytes != h.to_bytes ||
        to->header.section_count != from->header.section_count) {
        return false;
    }
    get_sections(&d, from, to);
    return !d.damaged;
}

plumb_result plumb_snapshot_apply(const void *from, size_t from_size, const void *delta,
                                  size_t delta_size, void *buffer, size_t size, size_t *bytes)
{
    pl_image a;
    delta_header h;
    if (from == NULL || delta == NULL || buffer == NULL || bytes == NULL) {
        return PLUMB_E_NULL;
    }
    if (pl_image_open(from, from_size, true, &a) != NULL || !open_delta(delta, delta_size, &h) ||
        h.from != a.header.checksum || h.to_bytes < directory_bytes(&a)) {
        return PLUMB_E_IMAGE;
    }
    if (h.to_bytes > size) {
        return PLUMB_E_RANGE;
    }
    pl_image b;
    if (!pl_delta_apply(&a, delta, delta_size, buffer, &b) ||
        pl_image_checksum(buffer, &b.header) != h.to) {
        return PLUMB_E_IMAGE;
    }
    *bytes = h.to_bytes;
    return PLUMB_OK;
}
