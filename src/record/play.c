// play.c - edits of a recording, onto the world of a replay.
//
// Edits made before a step are played as a restored image; those made within one leave what the passes of
// the step have found out as it is.
//
// Reads: the recording. Writes: the world. Cost: O(state) an edit.
#include "record/compare.h"
#include "record/replay.h"
#include "record/told.h"
#include "schema/material.h"
#include "world/check.h"

#include <string.h>

//---- registrations -------------------------------------------------------------------------------

// Systems of a replay are never run.
static void rest(const plumb_system_call *call)
{
    (void)call;
}

static plumb_result register_component(plumb_replay *replay, const char **from, bool known)
{
    pl_code_component c;
    plumb_field fields[64];
    pl_code_field texts[64];
    memcpy(&c, *from, sizeof c);
    *from += sizeof c;
    for (uint64_t k = 0; k < c.fields; ++k) {
        memcpy(&texts[k], *from, sizeof texts[k]);
        *from += sizeof texts[k];
        texts[k].name[PL_NAME_MAX - 1] = texts[k].unit[PL_NAME_MAX - 1] = '\0';
        fields[k] = (plumb_field){ texts[k].name, (plumb_field_type)texts[k].type,
                                   (size_t)texts[k].offset, texts[k].unit };
    }
    const plumb_component_desc desc = { .name = c.name,
                                        .size = (size_t)c.size,
                                        .fields = c.fields > 0 ? fields : NULL,
                                        .field_count = (int)c.fields };
    if (known || plumb_component_create(replay->world, &desc).id != 0) {
        return PLUMB_OK;
    }
    return plumb_world_error(replay->world).code;
}

static plumb_result register_system(plumb_replay *replay, const char **from)
{
    pl_code_system s;
    memcpy(&s, *from, sizeof s);
    *from += sizeof s;
    s.name[PL_NAME_MAX - 1] = '\0';
    for (uint32_t i = 0; i < replay->world->systems.count; ++i) {
        if (strcmp(replay->world->systems.items[i].name, s.name) == 0) {
            return PLUMB_OK;
        }
    }
    const plumb_system_desc desc = {
        .name = s.name, .phase = (plumb_phase)s.phase, .run = rest, .needs = { { s.needs } }
    };
    return plumb_system_create(replay->world, &desc);
}

plumb_result pl_replay_register(plumb_replay *replay, uint32_t code)
{
    const pl_code_place *place = (const pl_code_place *)replay->index.codes.data + code;
    const char *from = place->data;
    pl_code_head head;
    plumb_result r = PLUMB_OK;
    memcpy(&head, from, sizeof head);
    from += sizeof head;
    for (uint32_t i = 0; r == PLUMB_OK && i < head.components; ++i) {
        r = register_component(replay, &from, i < replay->world->components.count);
    }
    for (uint32_t i = 0; r == PLUMB_OK && i < head.systems; ++i) {
        r = register_system(replay, &from);
    }
    replay->code = code;
    return r;
}

//---- edits ---------------------------------------------------------------------------------------

// What is new in a world has bytes that are not 0: a delta gives at most so many for each of its own.
#define DELTA_YIELD 4096u

static bool reserve(plumb_replay *replay, pl_buffer *buffer, size_t bytes)
{
    if (!pl_buffer_reserve(&replay->memory, buffer, bytes)) {
        replay->failed = PLUMB_E_MEMORY;
        return false;
    }
    return true;
}

bool pl_replay_keep(plumb_replay *replay, pl_played_image *kept)
{
    size_t size = plumb_world_snapshot_size(replay->world);
    return reserve(replay, &kept->buffer, size) &&
           pl_image_write(replay->world, kept->buffer.data, size) &&
           pl_image_view(kept->buffer.data, size, &kept->image);
}

static void play_state(plumb_replay *replay, uint32_t phase, const char *delta, size_t size)
{
    plumb_world *world = replay->world;
    pl_played_image *before = &replay->before, *now = &replay->now;
    size_t bytes = pl_delta_result_bytes(delta, size);
    if (!pl_replay_keep(replay, before)) {
        return;
    }
    if (bytes > before->image.header.bytes + size * DELTA_YIELD) {
        replay->failed = PLUMB_E_IMAGE;
        return;
    }
    if (!reserve(replay, &now->buffer, bytes)) {
        return;
    }
    pl_image_strip(&before->image);
    bool starved = false;
    bool sound = pl_delta_apply(&before->image, delta, size, now->buffer.data, &now->image) &&
                 pl_image_has_sections_of(world, &now->image) &&
                 pl_image_is_sound(world, &now->image, NULL, &starved) &&
                 (phase == 0 || pl_image_may_play(world, &before->image, &now->image));
    if (!sound) {
        replay->failed = starved ? PLUMB_E_MEMORY : PLUMB_E_IMAGE;
        return;
    }
    bool done =
        phase == 0 ? pl_image_restore(world, &now->image) : pl_image_reserve(world, &now->image);
    if (!done) {
        replay->failed = PLUMB_E_MEMORY;
        return;
    }
    if (phase > 0) {
        pl_image_play(world, &before->image, &now->image);
    }
    if (replay->desc.list_edits) {
        pl_replay_list(replay, pl_edit_phase(phase), &before->image, &now->image);
    }
}

void pl_replay_list(plumb_replay *replay, int phase, const pl_image *a, const pl_image *b)
{
    int known = replay->edit_count;
    int count = pl_compare_images(replay->world, a, b, true, NULL, 0);
    pl_buffer found = { 0 };
    if (!reserve(replay, &found, (size_t)count * sizeof(plumb_difference)) ||
        !reserve(replay, &replay->edits, (size_t)(known + count) * sizeof(plumb_replay_edit))) {
        pl_buffer_free(&replay->memory, &found);
        return;
    }
    pl_compare_images(replay->world, a, b, true, found.data, count);
    plumb_replay_edit *rows = replay->edits.data;
    for (int i = 0; i < count; ++i) {
        rows[known + i] = (plumb_replay_edit){ phase, ((plumb_difference *)found.data)[i] };
    }
    replay->edit_count += count;
    pl_buffer_free(&replay->memory, &found);
}

// As plumb_contact_edit_set takes it.
static bool is_contact(const pl_contact_note *n)
{
    const double most = (double)PLUMB_REAL_MAX;
    return n->disabled <= 1 && n->friction >= 0 && n->friction <= most && n->restitution >= 0 &&
           n->restitution <= PL_RESTITUTION_MOST && n->rolling >= 0 && n->rolling <= most &&
           n->adhesion >= 0 && n->adhesion <= most && n->surface_speed >= -most &&
           n->surface_speed <= most;
}

static void play_contacts(plumb_replay *replay, const char *from, size_t bytes)
{
    plumb_world *world = replay->world;
    for (size_t at = 0; at + sizeof(pl_contact_note) <= bytes; at += sizeof(pl_contact_note)) {
        pl_contact_note note;
        memcpy(&note, from + at, sizeof note);
        if (note.manifold >= world->narrow.manifold_count) {
            replay->failed = PLUMB_E_IMAGE;
            return;
        }
        if (!is_contact(&note)) {
            replay->failed = PLUMB_E_IMAGE;
            return;
        }
        pl_manifold *m = &pl_manifolds(&world->narrow)[note.manifold];
        m->friction = (near_real)note.friction;
        m->restitution = (near_real)note.restitution;
        m->rolling = (near_real)note.rolling;
        m->adhesion = (near_real)note.adhesion;
        m->surface_speed = (near_real)note.surface_speed;
        m->disabled = note.disabled != 0;
    }
}

// What to do with an edit of the step under way.
typedef void play_fn(plumb_replay *replay, const pl_edit_head *edit, const char *data,
                     int64_t hook);

static void each_edit(plumb_replay *replay, uint32_t phase, int64_t hook, play_fn *play)
{
    const pl_chunk *chunk = replay->playing;
    if (chunk == NULL) { // a step of the user's own
        return;
    }
    pl_step_head head;
    memcpy(&head, chunk->data, sizeof head);
    size_t at = sizeof head;
    for (uint64_t i = 0; i < head.edits && replay->failed == PLUMB_OK; ++i) {
        pl_edit_head edit;
        memcpy(&edit, chunk->data + at, sizeof edit);
        at += sizeof edit;
        if (edit.phase == phase) {
            play(replay, &edit, chunk->data + at, hook);
        }
        at += pl_image_padded((size_t)edit.bytes);
    }
}

static void play_edit(plumb_replay *replay, const pl_edit_head *edit, const char *data,
                      int64_t hook)
{
    const bool is_hooks = edit->kind % PL_EDIT_KINDS == PL_EDIT_HOOK;
    const bool due = is_hooks ? edit->kind / PL_EDIT_KINDS == hook : hook < 0;
    if (!due || edit->kind == PL_EDIT_TOLD) {
        return;
    }
    if (edit->kind == PL_EDIT_CONTACTS) {
        play_contacts(replay, data, (size_t)edit->bytes);
    } else {
        play_state(replay, edit->phase, data, (size_t)edit->bytes);
    }
}

void pl_replay_play(plumb_replay *replay, uint32_t phase, int64_t hook)
{
    each_edit(replay, phase, hook, play_edit);
}

static void play_told(plumb_replay *replay, const pl_edit_head *edit, const char *data,
                      int64_t hook)
{
    (void)hook;
    if (edit->kind == PL_EDIT_TOLD) {
        replay->failed = pl_told_play(replay->world, data, (size_t)edit->bytes);
    }
}

void pl_replay_play_told(plumb_replay *replay)
{
    each_edit(replay, 0, -1, play_told);
}
