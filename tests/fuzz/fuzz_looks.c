// fuzz_looks.c - hostile notes of looks and camera in a recording: what the command line reads of them is what a scene
// could have said, never harm.
//
// The first byte says whose note it is, the second how: as it stands, or as the fields of a note of ours behind its
// tag. The rest is the note.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz/tape.h"
#include "plumb/engine_looks.c" // its notes are nobody else's business

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

//---- what of the session the file needs ----------------------------------------------------------

int pl_session_fail(engine_error *error, int code, const char *format, ...)
{
    (void)error, (void)format;
    return code;
}

int pl_stage_palette(const scene_body *body, int i)
{
    (void)body;
    return i;
}

const char *pl_stage_text(const engine_stage *stage)
{
    (void)stage;
    return "";
}

//---- a recording with one note -------------------------------------------------------------------

static size_t put_note(unsigned how, uint32_t tag, size_t bytes, const uint8_t *data, size_t size,
                       unsigned char *note)
{
    if (how % 2 == 0) {
        memcpy(note, data, size);
        return size;
    }
    memset(note, 0, bytes);
    memcpy(note, &tag, sizeof tag);
    memcpy(note + sizeof tag, data, size < bytes - sizeof tag ? size : bytes - sizeof tag);
    return bytes;
}

static bool record(tape *t, plumb_body *body, const uint8_t *data, size_t size)
{
    static const size_t sizes[] = { sizeof(look), sizeof(camera_note), 64 };
    unsigned char note[512];
    plumb_world *w;
    const unsigned who = data[0] % 3;
    t->size = 0;
    if (plumb_world_create(NULL, &w) != PLUMB_OK) {
        return false;
    }
    *body = plumb_body_create(w, &(plumb_body_desc){ 0 });
    plumb_recorder_start(w, &(plumb_recorder_desc){ .write = to_tape, .context = t });
    const size_t bytes =
        put_note(data[1], who == 0 ? LOOK_TAG : CAMERA_TAG, sizes[who], data + 2, size - 2, note);
    const uint64_t keys[] = { key_of(body->entity.index, body->entity.generation),
                              key_of(CAMERA, 0), key_of(TEXT, 0) };
    plumb_recorder_note(w, keys[who], note, bytes);
    plumb_world_step(w, (plumb_real)(1.0 / 60));
    const bool good = plumb_recorder_stop(w) == PLUMB_OK;
    plumb_world_destroy(w);
    return good;
}

//---- what is read of it --------------------------------------------------------------------------

static void must(bool holds)
{
    if (!holds) {
        abort();
    }
}

static void look_at_all(const plumb_replay *replay, plumb_body entity)
{
    scene_camera camera;
    scene_body body = { .entity = entity, .label = "" };
    scene_joint joint = { .entity = { entity.entity } };
    pl_stage_read_body(replay, &body);
    pl_stage_read_joint(replay, &joint);
    must(strlen(body.label) < 64 && body.palette >= 0);
    pl_stage_read_camera(replay, &camera);
    must(strlen(camera.follow) < 64 && isfinite(camera.at) && camera.trail >= 0);
    must(!camera.has_view || (camera.height > 0 && isfinite(camera.center[0] + camera.height)));
    must(!camera.has_fit || (camera.box[0] < camera.box[2] && camera.box[1] < camera.box[3]));
    must(strlen(pl_stage_read_text(replay)) <= ROOM);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    tape *t = malloc(sizeof *t);
    plumb_replay *replay;
    plumb_body body;
    if (t == NULL || size < 2 || size > 400) {
        free(t);
        return 0;
    }
    must(record(t, &body, data, size));
    must(plumb_replay_open(t->bytes, t->size, NULL, &replay) == PLUMB_OK);
    look_at_all(replay, body);
    must(plumb_replay_step(replay) == PLUMB_OK);
    look_at_all(replay, body);
    plumb_replay_close(replay);
    free(t);
    return 0;
}
