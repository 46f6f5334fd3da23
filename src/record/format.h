// format.h - how a recording lies in a file.
//
//     header | chunk | chunk | ...
//     chunk: kind, number, bytes, two checksums | payload, a multiple of 8 bytes
//
// Chunks are written whole and numbered, and each is verified by itself: one that is missing, swapped or
// damaged is found; a file that ends within one ends before it. In order: CODE and KEY (the head), then
// STEPs, with a KEY behind every so many; CODE and KEY again where components or systems were
// registered meanwhile; NAMEs and NOTEs anywhere; END. All numbers are the machine's own.
#ifndef PL_RECORD_FORMAT_H
#define PL_RECORD_FORMAT_H

#include "snapshot/image.h"

#define PL_RECORD_MAGIC   UINT64_C(0x434552424d554c50) // "PLUMBREC" in a little-endian file
#define PL_RECORD_VERSION 3u // 1: without NOTEs; 2: without PL_EDIT_TOLD; both are read as well
#define PL_TITLE_MAX      256

typedef struct pl_record_header {
    uint64_t magic;
    uint32_t version;
    uint32_t precision; // PL_PRECISION
    uint64_t schema;    // of the columns: see pl_section_schema
    uint64_t keyframe_every;
    char title[PL_TITLE_MAX];
    uint64_t checksum; // of what is before
} pl_record_header;

typedef enum pl_chunk_kind {
    PL_CHUNK_CODE = 1, // pl_code_head, components with their fields, systems
    PL_CHUNK_KEY,      // pl_key_head, image
    PL_CHUNK_STEP,     // pl_step_head, edits
    PL_CHUNK_NAME,     // plumb_entity, text padded with zeros
    PL_CHUNK_END,      // nothing
    PL_CHUNK_NOTE      // pl_note_head, bytes of the user padded with zeros
} pl_chunk_kind;

typedef struct pl_chunk_header {
    uint32_t kind;
    uint32_t number;   // of the chunk, from 0
    uint64_t bytes;    // of the payload
    uint64_t checksum; // of the payload
    uint64_t check;    // of the four before
} pl_chunk_header;

typedef struct pl_code_head {
    uint32_t components, systems;
} pl_code_head;

typedef struct pl_code_component {
    char name[PL_NAME_MAX];
    uint64_t size;
    uint64_t fields; // pl_code_field behind
} pl_code_component;

typedef struct pl_code_field {
    char name[PL_NAME_MAX], unit[PL_NAME_MAX]; // cut where longer
    uint64_t type, offset;
} pl_code_field;

typedef struct pl_code_system {
    char name[PL_NAME_MAX];
    uint32_t phase, needs; // id of a component; 0: none
} pl_code_system;

typedef struct pl_key_head {
    uint64_t step;  // steps taken
    uint64_t edits; // 1: the user's edits before the next step are in it
} pl_key_head;

typedef struct pl_step_head {
    double dt;     // [s]
    double time;   // [s] after it
    uint64_t hash; // after it
    uint64_t edits;
} pl_step_head;

typedef struct pl_note_head {
    uint64_t key;
    uint64_t bytes; // before padding
} pl_note_head;

// An edit, padded to 8 bytes. What the state was and became, as a delta; or contacts, or events.
typedef struct pl_edit_head {
    uint32_t phase; // 0: before the step, else a pl_edit_mark
    uint32_t kind;  // pl_edit_kind; of PL_EDIT_HOOK: + 256 times which of the step, from 0
    uint64_t bytes;
} pl_edit_head;

// What systems of a phase did in a step, taken anew so many times (step/quarantine.c): each time has its own.
static inline uint32_t pl_edit_mark(plumb_phase phase, uint32_t attempt)
{
    return 1 + (uint32_t)phase + 16 * attempt;
}

// -1: before the step.
static inline int pl_edit_phase(uint32_t mark)
{
    return (int)(mark % 16) - 1;
}

typedef enum pl_edit_kind {
    PL_EDIT_STATE,
    PL_EDIT_CONTACTS,
    PL_EDIT_HOOK, // PL_EDIT_STATE by a hook of a component that the step took from something
    PL_EDIT_TOLD  // events that were made as the step began (told.h)
} pl_edit_kind;

#define PL_EDIT_KINDS 256u // a hook's number counts by it
#define PL_HOOKS_MOST (UINT32_MAX / PL_EDIT_KINDS)

// What a contact system made of a manifold.
typedef struct pl_contact_note {
    uint32_t manifold, disabled;
    double friction, restitution, rolling, adhesion, surface_speed;
} pl_contact_note;

typedef struct pl_chunk {
    pl_chunk_kind kind;
    const char *data;
    size_t bytes;
} pl_chunk;

void pl_record_seal(pl_record_header *header);
pl_chunk_header pl_chunk_seal(pl_chunk_kind kind, uint32_t number, const void *data, size_t bytes);

// What is wrong with the header of a recording; NULL: nothing.
const char *pl_record_open(const void *bytes, size_t size, pl_record_header *header);

typedef enum pl_chunk_state { PL_CHUNK_WHOLE, PL_CHUNK_CUT, PL_CHUNK_DAMAGED } pl_chunk_state;

// Verifies chunk `number` at *offset and moves behind it.
pl_chunk_state pl_chunk_read(const char *bytes, size_t size, size_t *offset, uint32_t number,
                             pl_chunk *chunk);

#endif
