// recorder.c - a world's run as a stream: see plumb/record.h, format.h.
//
// What the user does is found by comparing the world with the image of it that was kept: that of the
// end of the last step, where the next one begins; that from before the systems of a phase, behind them. So
// nothing has to be told to the recorder, and nothing can be forgotten. A step that is refused leaves the
// kept image as it is: what it did, or systems in it, is in the edits of the next one.
//
// Reads: the world. Writes: the stream. Order: between the passes, see world/observer.h. Cost: a step one
// comparison, one copy, one hash of the state (O(state)); the same for each phase with systems; where
// something was edited, what differs is coded. No allocation once all has been as large before.
#include "plumb/record.h"
#include "plumb/snapshot.h"
#include "record/format.h"
#include "record/told.h"
#include "step/place.h"
#include "world/check.h"
#include "world/observer.h"

#include <stdio.h>
#include <string.h>

#define KEYFRAME_EVERY      120
#define KEYFRAME_EVERY_MOST 1000000

typedef struct kept_image {
    pl_buffer buffer;
    pl_image image;
} kept_image;

typedef struct recorder {
    pl_step_observer observer; // first: the world knows the recorder by it
    plumb_write_fn *write;
    void *context;
    uint64_t keyframe_every;
    plumb_recorder_info info;
    uint32_t number;              // of the next chunk
    uint32_t components, systems; // told so far
    kept_image last;              // end of the last step
    kept_image before, now;       // around the systems of a phase
    pl_buffer manifolds;          // before contact systems
    pl_buffer step;               // pl_step_head, edits
    size_t step_bytes;
    // the edits before the step are in a keyframe; also of one that is refused, until one is not
    bool keyed;
    uint32_t hooks;  // components dropped within the step so far
    pl_buffer chunk; // others than steps
} recorder;

static void end_early(recorder *r, plumb_result why)
{
    if (r->info.ended == PLUMB_OK) {
        r->info.ended = why;
    }
}

//---- chunks --------------------------------------------------------------------------------------

static void put(recorder *r, const void *bytes, size_t size)
{
    if (r->info.ended == PLUMB_OK && size > 0 && !r->write(r->context, bytes, size)) {
        end_early(r, PLUMB_E_WRITE);
    }
    r->info.bytes += r->info.ended == PLUMB_OK ? size : 0;
}

static void put_chunk(recorder *r, pl_chunk_kind kind, const void *data, size_t bytes)
{
    if (r->info.ended == PLUMB_OK) {
        const pl_chunk_header h = pl_chunk_seal(kind, r->number, data, bytes);
        ++r->number;
        put(r, &h, sizeof h);
        put(r, data, bytes);
    }
}

static bool room(recorder *r, plumb_world *world, pl_buffer *buffer, size_t bytes)
{
    if (!pl_buffer_reserve(&world->memory, buffer, bytes)) {
        end_early(r, PLUMB_E_MEMORY);
        return false;
    }
    return true;
}

static void copy_name(char to[PL_NAME_MAX], const char *from)
{
    snprintf(to, PL_NAME_MAX, "%s", from == NULL ? "" : from);
}

static size_t code_bytes(const plumb_world *world)
{
    size_t bytes = sizeof(pl_code_head) + world->components.count * sizeof(pl_code_component) +
                   world->systems.count * sizeof(pl_code_system);
    for (uint32_t i = 0; i < world->components.count; ++i) {
        bytes += (size_t)world->components.items[i].desc.field_count * sizeof(pl_code_field);
    }
    return bytes;
}

static char *write_component(char *to, const pl_component *c)
{
    pl_code_component item = { .size = c->desc.size, .fields = (uint64_t)c->desc.field_count };
    copy_name(item.name, c->name);
    memcpy(to, &item, sizeof item);
    to += sizeof item;
    for (int k = 0; k < c->desc.field_count; ++k) {
        pl_code_field field = { .type = c->fields[k].type, .offset = c->fields[k].offset };
        copy_name(field.name, c->fields[k].name);
        copy_name(field.unit, c->fields[k].unit);
        memcpy(to, &field, sizeof field);
        to += sizeof field;
    }
    return to;
}

// Components and systems, so that a replay can register them.
static void put_code(recorder *r, plumb_world *world)
{
    const pl_code_head head = { world->components.count, world->systems.count };
    size_t bytes = code_bytes(world);
    if (!room(r, world, &r->chunk, bytes)) {
        return;
    }
    char *to = r->chunk.data;
    memcpy(to, &head, sizeof head);
    to += sizeof head;
    for (uint32_t i = 0; i < head.components; ++i) {
        to = write_component(to, &world->components.items[i]);
    }
    for (uint32_t i = 0; i < head.systems; ++i) {
        const pl_system *s = &world->systems.items[i];
        pl_code_system item = { .phase = s->desc.phase, .needs = s->desc.needs[0].id };
        copy_name(item.name, s->name);
        memcpy(to, &item, sizeof item);
        to += sizeof item;
    }
    put_chunk(r, PL_CHUNK_CODE, r->chunk.data, bytes);
    r->components = head.components;
    r->systems = head.systems;
}

// The world as it is now.
static void put_key(recorder *r, plumb_world *world, bool edits)
{
    const pl_key_head head = { r->info.steps, edits };
    size_t size = plumb_world_snapshot_size(world);
    if (!room(r, world, &r->chunk, sizeof head + size)) {
        return;
    }
    char *to = r->chunk.data;
    pl_image image;
    memcpy(to, &head, sizeof head);
    to += sizeof head;
    if (pl_image_write(world, to, size) && pl_image_view(to, size, &image)) {
        pl_image_strip(&image);
        pl_image_seal(world, to);
        put_chunk(r, PL_CHUNK_KEY, r->chunk.data, sizeof head + size);
        ++r->info.keyframes;
    }
}

//---- edits ---------------------------------------------------------------------------------------

static bool keep(recorder *r, plumb_world *world, kept_image *kept)
{
    size_t size = plumb_world_snapshot_size(world);
    return room(r, world, &kept->buffer, size) && pl_image_write(world, kept->buffer.data, size) &&
           pl_image_view(kept->buffer.data, size, &kept->image);
}

static bool are_same(const pl_image *a, const pl_image *b)
{
    return a->header.bytes == b->header.bytes && memcmp(a->bytes, b->bytes, a->header.bytes) == 0;
}

// Appends an edit to the step: `bytes` of it are written, or will be, behind the head.
static char *begin_edit(recorder *r, plumb_world *world, uint32_t phase, uint32_t kind,
                        size_t bytes)
{
    size_t padded = pl_image_padded(bytes);
    if (!room(r, world, &r->step, r->step_bytes + sizeof(pl_edit_head) + padded)) {
        return NULL;
    }
    const pl_edit_head head = { phase, kind, bytes };
    char *to = (char *)r->step.data + r->step_bytes;
    memcpy(to, &head, sizeof head);
    to += sizeof head;
    memset(to + bytes, 0, padded - bytes);
    return to;
}

static void end_edit(recorder *r, size_t bytes)
{
    pl_step_head head;
    r->step_bytes += sizeof(pl_edit_head) + pl_image_padded(bytes);
    memcpy(&head, r->step.data, sizeof head);
    ++head.edits;
    memcpy(r->step.data, &head, sizeof head);
}

// What the state has become since `base`, which loses its user data.
static void note_state(recorder *r, plumb_world *world, uint32_t phase, uint32_t kind,
                       kept_image *base)
{
    if (pl_image_is_current(world, &base->image) || !keep(r, world, &r->now)) {
        return;
    }
    pl_image_strip(&base->image);
    pl_image_strip(&r->now.image);
    if (are_same(&base->image, &r->now.image)) {
        return;
    }
    size_t used = r->step_bytes + sizeof(pl_edit_head);
    size_t spare = r->step.size > used ? r->step.size - used : 0;
    char *to = (char *)r->step.data + used;
    size_t needed = pl_delta_write(&base->image, &r->now.image, spare > 0 ? to : NULL, spare);
    bool fits = pl_image_padded(needed) <= spare;
    to = begin_edit(r, world, phase, kind, needed);
    if (to == NULL) {
        return;
    }
    if (!fits) {
        pl_delta_write(&base->image, &r->now.image, to, needed);
    }
    end_edit(r, needed);
}

static bool is_note(const pl_manifold *a, const pl_manifold *b)
{
    return a->friction != b->friction || a->restitution != b->restitution ||
           a->rolling != b->rolling || a->adhesion != b->adhesion ||
           a->surface_speed != b->surface_speed || a->disabled != b->disabled;
}

// What contact systems made of the manifolds.
static void note_contacts(recorder *r, plumb_world *world, uint32_t mark)
{
    const pl_manifold *now = pl_manifolds(&world->narrow), *then = r->manifolds.data;
    size_t bytes = 0;
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        bytes += is_note(&now[i], &then[i]) ? sizeof(pl_contact_note) : 0;
    }
    char *to = bytes == 0 ? NULL : begin_edit(r, world, mark, PL_EDIT_CONTACTS, bytes);
    for (uint32_t i = 0; to != NULL && i < world->narrow.manifold_count; ++i) {
        const pl_manifold *m = &now[i];
        if (is_note(m, &then[i])) {
            const pl_contact_note note = { i,
                                           m->disabled,
                                           (double)m->friction,
                                           (double)m->restitution,
                                           (double)m->rolling,
                                           (double)m->adhesion,
                                           (double)m->surface_speed };
            memcpy(to, &note, sizeof note);
            to += sizeof note;
        }
    }
    if (to != NULL) {
        end_edit(r, bytes);
    }
}

//---- in the step ---------------------------------------------------------------------------------

static void note_told(recorder *r, plumb_world *world)
{
    const size_t bytes = pl_told_bytes(world);
    char *to = bytes == 0 ? NULL : begin_edit(r, world, 0, PL_EDIT_TOLD, bytes);
    if (to != NULL) {
        pl_told_write(world, to);
        end_edit(r, bytes);
    }
}

static bool begin_step(recorder *r, plumb_world *world)
{
    const pl_step_head none = { 0 };
    if (!room(r, world, &r->step, sizeof none)) {
        return false;
    }
    memcpy(r->step.data, &none, sizeof none);
    r->step_bytes = sizeof none;
    r->hooks = 0;
    return true;
}

static void at_begin(pl_step_observer *self, plumb_world *world)
{
    recorder *r = (recorder *)self;
    if (r->info.ended != PLUMB_OK || !begin_step(r, world)) {
        return;
    }
    if (r->components != world->components.count || r->systems != world->systems.count) {
        put_code(r, world);
        r->keyed = true;
    }
    if (r->keyed) {
        put_key(r, world, true);
    } else {
        note_state(r, world, 0, PL_EDIT_STATE, &r->last);
    }
    note_told(r, world);
}

static void before_systems(pl_step_observer *self, plumb_world *world, plumb_phase phase)
{
    recorder *r = (recorder *)self;
    if (r->info.ended != PLUMB_OK || !keep(r, world, &r->before)) {
        return;
    }
    size_t bytes = world->narrow.manifold_count * sizeof(pl_manifold);
    if (phase == PLUMB_PHASE_CONTACTS && bytes > 0 && room(r, world, &r->manifolds, bytes)) {
        memcpy(r->manifolds.data, world->narrow.manifolds.data, bytes);
    }
}

static void after_systems(pl_step_observer *self, plumb_world *world, plumb_phase phase)
{
    recorder *r = (recorder *)self;
    if (r->info.ended != PLUMB_OK) {
        return;
    }
    const uint32_t mark = pl_edit_mark(phase, world->quarantine.attempt);
    note_state(r, world, mark, PL_EDIT_STATE, &r->before);
    if (phase == PLUMB_PHASE_CONTACTS && world->edited) {
        note_contacts(r, world, mark);
    }
}

static void before_hook(pl_step_observer *self, plumb_world *world)
{
    recorder *r = (recorder *)self;
    if (r->info.ended == PLUMB_OK) {
        keep(r, world, &r->before);
    }
}

static void after_hook(pl_step_observer *self, plumb_world *world)
{
    recorder *r = (recorder *)self;
    if (r->info.ended == PLUMB_OK) {
        const uint32_t mark = pl_edit_mark(PLUMB_PHASE_END, world->quarantine.attempt);
        note_state(r, world, mark, PL_EDIT_HOOK + PL_EDIT_KINDS * r->hooks, &r->before);
        r->hooks += r->hooks < PL_HOOKS_MOST;
    }
}

static void at_end(pl_step_observer *self, plumb_world *world, plumb_real dt)
{
    recorder *r = (recorder *)self;
    pl_step_head head;
    if (r->info.ended != PLUMB_OK || !keep(r, world, &r->last)) {
        return;
    }
    memcpy(&head, r->step.data, sizeof head);
    head.dt = (double)dt;
    head.time = world->time;
    head.hash = r->info.hash = plumb_world_hash(world);
    memcpy(r->step.data, &head, sizeof head);
    put_chunk(r, PL_CHUNK_STEP, r->step.data, r->step_bytes);
    r->keyed = false;
    if (r->info.ended == PLUMB_OK) {
        ++r->info.steps;
        r->info.edited += head.edits > 0;
        if (r->info.steps % r->keyframe_every == 0) {
            put_key(r, world, false);
        }
    }
}

//---- start and stop ------------------------------------------------------------------------------

static void free_recorder(plumb_world *world, recorder *r)
{
    pl_memory *memory = &world->memory;
    pl_buffer *const buffers[] = { &r->last.buffer, &r->before.buffer, &r->now.buffer,
                                   &r->manifolds,   &r->step,          &r->chunk };
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; ++i) {
        pl_buffer_free(memory, buffers[i]);
    }
    world->observer = NULL;
    pl_resize(memory, r, sizeof *r, 0);
}

static void at_gone(pl_step_observer *self, plumb_world *world)
{
    recorder *r = (recorder *)self;
    put_chunk(r, PL_CHUNK_END, NULL, 0);
    free_recorder(world, r);
}

static plumb_result check_desc(const plumb_world *world, const char *fn,
                               const plumb_recorder_desc *desc)
{
    PL_TRY(pl_check_unlocked(world, fn));
    PL_TRY(pl_check_pointer(world, fn, "desc", desc));
    if (desc->write == NULL) {
        return pl_fail(world, PLUMB_E_NULL, fn, "write is null; it must be given");
    }
    if (desc->keyframe_every < 0 || desc->keyframe_every > KEYFRAME_EVERY_MOST) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "keyframe_every is %d; it must be 0 to %d",
                       desc->keyframe_every, KEYFRAME_EVERY_MOST);
    }
    if (desc->title != NULL && memchr(desc->title, '\0', PL_TITLE_MAX) == NULL) {
        return pl_fail(world, PLUMB_E_RANGE, fn,
                       "title is '%.16s...'; it must have at most %d characters", desc->title,
                       PL_TITLE_MAX - 1);
    }
    if (world->observer != NULL) {
        return pl_fail(world, PLUMB_E_STATE, fn,
                       world->observer->replays ? "the world is that of a replay; it must not be"
                                                : "the world is recorded already; stop that first");
    }
    for (uint32_t i = 0; i < world->systems.count; ++i) {
        if (pl_system_is_placed(&world->systems.items[i].desc)) {
            return pl_fail(world, PLUMB_E_STATE, fn,
                           "the system '%s' runs in the substep or at a place of its own; a "
                           "recording does not hold what such a system does",
                           world->systems.items[i].name);
        }
    }
    return PLUMB_OK;
}

static void put_head(recorder *r, plumb_world *world, const plumb_recorder_desc *desc)
{
    pl_record_header header = { .magic = PL_RECORD_MAGIC,
                                .version = PL_RECORD_VERSION,
                                .precision = PL_PRECISION,
                                .schema = pl_section_schema(),
                                .keyframe_every = r->keyframe_every };
    snprintf(header.title, sizeof header.title, "%s", desc->title == NULL ? "" : desc->title);
    pl_record_seal(&header);
    put(r, &header, sizeof header);
    put_code(r, world);
    put_key(r, world, false);
}

plumb_result plumb_recorder_start(plumb_world *world, const plumb_recorder_desc *desc)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(check_desc(world, __func__, desc));
    recorder *r = pl_resize(&world->memory, NULL, 0, sizeof *r);
    if (r == NULL) {
        return pl_fail_memory(world, __func__);
    }
    int every = desc->keyframe_every > 0 ? desc->keyframe_every : KEYFRAME_EVERY;
    *r = (recorder){ .observer = { .begin = at_begin,
                                   .before = before_systems,
                                   .after = after_systems,
                                   .dropping = before_hook,
                                   .dropped = after_hook,
                                   .end = at_end,
                                   .gone = at_gone },
                     .write = desc->write,
                     .context = desc->context,
                     .keyframe_every = (uint64_t)every,
                     .info = { .recording = true, .hash = plumb_world_hash(world) } };
    // Room for the usual step before anything is written.
    if (keep(r, world, &r->last) && begin_step(r, world)) {
        put_head(r, world, desc);
    }
    const plumb_result result = r->info.ended;
    if (result != PLUMB_OK) {
        free_recorder(world, r);
        return result == PLUMB_E_MEMORY
                   ? pl_fail_memory(world, __func__)
                   : pl_fail(world, result, __func__, "the write function took no more");
    }
    world->observer = &r->observer;
    return PLUMB_OK;
}

static plumb_result check_recording(const plumb_world *world, const char *fn)
{
    return world->observer != NULL && !world->observer->replays
               ? PLUMB_OK
               : pl_fail(world, PLUMB_E_STATE, fn, "the world is not recorded; start that first");
}

static plumb_result fail_ended(const plumb_world *world, const char *fn, plumb_result ended)
{
    return pl_fail(world, ended, fn, "the recording ended early: %s", plumb_result_text(ended));
}

plumb_result plumb_recorder_stop(plumb_world *world)
{
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(check_recording(world, __func__));
    recorder *r = (recorder *)world->observer;
    put_chunk(r, PL_CHUNK_END, NULL, 0);
    const plumb_result result = r->info.ended;
    free_recorder(world, r);
    return result == PLUMB_OK ? PLUMB_OK : fail_ended(world, __func__, result);
}

plumb_result plumb_recorder_name(plumb_world *world, plumb_entity entity, const char *name)
{
    struct {
        plumb_entity entity;
        char text[PL_NAME_MAX];
    } note = { .entity = entity };
    PL_TRY(pl_check_world(world));
    PL_TRY(pl_check_name(world, __func__, "name", name));
    PL_TRY(pl_check_entity(world, __func__, entity));
    PL_TRY(check_recording(world, __func__));
    recorder *r = (recorder *)world->observer;
    copy_name(note.text, name);
    put_chunk(r, PL_CHUNK_NAME, &note, sizeof note);
    return r->info.ended == PLUMB_OK ? PLUMB_OK : fail_ended(world, __func__, r->info.ended);
}

plumb_result plumb_recorder_note(plumb_world *world, uint64_t key, const void *bytes, size_t size)
{
    PL_TRY(pl_check_world(world));
    if (size > PLUMB_NOTE_MAX) {
        return pl_fail(world, PLUMB_E_RANGE, __func__, "size is %zu; it must be 0 to %zu", size,
                       PLUMB_NOTE_MAX);
    }
    PL_TRY(size > 0 ? pl_check_pointer(world, __func__, "bytes", bytes) : PLUMB_OK);
    PL_TRY(check_recording(world, __func__));
    recorder *r = (recorder *)world->observer;
    const pl_note_head head = { key, size };
    size_t padded = pl_image_padded(size);
    if (r->info.ended == PLUMB_OK && room(r, world, &r->chunk, sizeof head + padded)) {
        char *to = r->chunk.data;
        memcpy(to, &head, sizeof head);
        memset(to + sizeof head, 0, padded);
        if (size > 0) {
            memcpy(to + sizeof head, bytes, size);
        }
        put_chunk(r, PL_CHUNK_NOTE, to, sizeof head + padded);
    }
    return r->info.ended == PLUMB_OK ? PLUMB_OK : fail_ended(world, __func__, r->info.ended);
}

plumb_recorder_info plumb_recorder_get_info(const plumb_world *world)
{
    if (world == NULL || world->observer == NULL || world->observer->replays) {
        return (plumb_recorder_info){ 0 };
    }
    return ((const recorder *)world->observer)->info;
}
