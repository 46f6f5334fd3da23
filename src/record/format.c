// format.c - see format.h. Reads: the recording. Writes: nothing. Cost: O(bytes) digested.
#include "record/format.h"

#include <string.h>

void pl_record_seal(pl_record_header *header)
{
    header->checksum = pl_digest_of(header, offsetof(pl_record_header, checksum));
}

pl_chunk_header pl_chunk_seal(pl_chunk_kind kind, uint32_t number, const void *data, size_t bytes)
{
    pl_chunk_header h = {
        .kind = kind, .number = number, .bytes = bytes, .checksum = pl_digest_of(data, bytes)
    };
    h.check = pl_digest_of(&h, offsetof(pl_chunk_header, check));
    return h;
}

const char *pl_record_open(const void *bytes, size_t size, pl_record_header *header)
{
    if (size < sizeof header->magic) {
        return "is no recording";
    }
    memcpy(&header->magic, bytes, sizeof header->magic);
    if (header->magic == pl_reversed(PL_RECORD_MAGIC)) {
        return "was made on a machine of another byte order";
    }
    if (header->magic != PL_RECORD_MAGIC) {
        return "is no recording";
    }
    if (size < sizeof *header) {
        return "is truncated before its first step";
    }
    memcpy(header, bytes, sizeof *header);
    if (header->checksum != pl_digest_of(header, offsetof(pl_record_header, checksum)) ||
        memchr(header->title, '\0', sizeof header->title) == NULL) {
        return "is damaged";
    }
    if (header->version == 0 || header->version > PL_RECORD_VERSION) {
        return "is of another version of the format";
    }
    if (header->precision != PL_PRECISION) {
        return header->precision == 4   ? "was recorded in float precision"
               : header->precision == 8 ? "was recorded in double precision"
                                        : "was recorded in far precision";
    }
    if (header->schema != pl_section_schema()) {
        return "was recorded by a build that stores other columns";
    }
    return NULL;
}

pl_chunk_state pl_chunk_read(const char *bytes, size_t size, size_t *offset, uint32_t number,
                             pl_chunk *chunk)
{
    pl_chunk_header h;
    size_t left = size - *offset;
    if (left < sizeof h) {
        return PL_CHUNK_CUT;
    }
    memcpy(&h, bytes + *offset, sizeof h);
    if (h.check != pl_digest_of(&h, offsetof(pl_chunk_header, check)) || h.number != number ||
        h.bytes % 8 != 0) {
        return PL_CHUNK_DAMAGED;
    }
    if (h.bytes > left - sizeof h) {
        return PL_CHUNK_CUT;
    }
    *chunk = (pl_chunk){ (pl_chunk_kind)h.kind, bytes + *offset + sizeof h, (size_t)h.bytes };
    if (pl_digest_of(chunk->data, chunk->bytes) != h.checksum) {
        return PL_CHUNK_DAMAGED;
    }
    *offset += sizeof h + (size_t)h.bytes;
    return PL_CHUNK_WHOLE;
}
