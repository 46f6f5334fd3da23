// fuzz_forged.c - forged recordings, with checksums that are right, of chunks, keyframes and edits: refused, or a
// prefix that plays forward and back; never harm.
//
// An input is a byte that says which world is recorded, then changes: a chunk, a place in it, what comes there
// (forge.h).
#include "fuzz/forge.h"
#include "fuzz/tape.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { STEPS = 3, CHUNKS = 64 };

static plumb_component mark;

static void act(const plumb_system_call *call)
{
    plumb_body_span b = plumb_world_bodies(call->world);
    for (int i = 0; i < plumb_contact_edit_count(call->world); ++i) {
        plumb_contact_edit e;
        plumb_contact_edit_get(call->world, i, &e);
        e.friction = R(0.1);
        plumb_contact_edit_set(call->world, i, &e);
    }
    if (b.dynamic_count > 0) {
        plumb_body_apply_force_center(call->world, b.body[0], (plumb_vec2){ 1, 2 });
        plumb_command_component_set(call->world, b.body[0].entity, mark, NULL);
    }
}

static const tape *record(int which)
{
    static tape all[WORLDS];
    tape *t = &all[which];
    if (t->size > 0) {
        return t;
    }
    plumb_world *w = make_world(which, which == 1 ? 8 : 2);
    mark = plumb_component_find(w, "mark");
    plumb_system_create(
        w, &(plumb_system_desc){ .name = "act", .phase = PLUMB_PHASE_CONTACTS, .run = act });
    need(plumb_recorder_start(
             w, &(plumb_recorder_desc){ .write = to_tape, .context = t, .keyframe_every = 2 }) ==
         PLUMB_OK);
    for (int i = 0; i < STEPS; ++i) {
        plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .position = { R(i), 3 } });
        plumb_shape_create(w, b, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.2) });
        plumb_world_step(w, R(1.0 / 60));
    }
    need(plumb_recorder_stop(w) == PLUMB_OK);
    plumb_world_destroy(w);
    return t;
}

// Where the chunks of a good recording lie.
static int list_chunks(const tape *t, size_t offsets[CHUNKS])
{
    int count = 0;
    for (size_t at = sizeof(pl_record_header);
         at + sizeof(pl_chunk_header) <= t->size && count < CHUNKS;) {
        pl_chunk_header h;
        memcpy(&h, t->bytes + at, sizeof h);
        offsets[count++] = at;
        at += sizeof h + (size_t)h.bytes;
    }
    return count;
}

static void mend_delta(char *bytes, size_t size)
{
    uint64_t h[7];
    if (size < sizeof h) {
        return;
    }
    memcpy(h, bytes, sizeof h);
    if (h[2] >= sizeof h && h[2] <= size) {
        h[3] = pl_digest_sealed(h, sizeof h, 24, bytes + sizeof h, (size_t)h[2] - sizeof h);
        memcpy(bytes, h, sizeof h);
    }
}

static void mend_edits(char *data, size_t bytes)
{
    for (size_t at = sizeof(pl_step_head); at + sizeof(pl_edit_head) <= bytes;) {
        pl_edit_head edit;
        memcpy(&edit, data + at, sizeof edit);
        at += sizeof edit;
        if (edit.bytes > bytes - at) {
            return;
        }
        mend_delta(data + at, (size_t)edit.bytes);
        at += pl_image_padded((size_t)edit.bytes);
    }
}

static void mend_chunk(char *chunk, uint32_t number)
{
    pl_chunk_header h;
    memcpy(&h, chunk, sizeof h);
    char *data = chunk + sizeof h;
    if (h.kind == PL_CHUNK_KEY) {
        mend_image(data + sizeof(pl_key_head), (size_t)h.bytes - sizeof(pl_key_head));
    } else if (h.kind == PL_CHUNK_STEP) {
        mend_edits(data, (size_t)h.bytes);
    }
    h = pl_chunk_seal((pl_chunk_kind)h.kind, number, data, (size_t)h.bytes);
    memcpy(chunk, &h, sizeof h);
}

// `often`: what costs as much as all the rest is done too.
static void play(const unsigned char *bytes, size_t size, bool often)
{
    plumb_replay *replay;
    plumb_replay_info info;
    if (plumb_replay_open(bytes, size, &(plumb_replay_desc){ .list_edits = often }, &replay) !=
        PLUMB_OK) {
        return;
    }
    for (int i = 0; i < STEPS + 1 && plumb_replay_step(replay) == PLUMB_OK; ++i) {
    }
    if (often) {
        plumb_replay_get_info(replay, &info);
        plumb_replay_step_back(replay);
        plumb_replay_seek(replay, info.steps / 2);
        live(plumb_replay_world(replay));
    }
    plumb_replay_close(replay);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    script s = { data, data + (size < 256 ? size : 256) };
    const uint32_t first = byte_of(&s);
    const tape *good = record((int)(first % WORLDS));
    size_t offsets[CHUNKS];
    const int count = list_chunks(good, offsets);
    tape *t = malloc(sizeof *t);
    need(t != NULL);
    memcpy(t->bytes, good->bytes, good->size);
    t->size = good->size;
    uint64_t changed = 0; // chunks
    while (s.at < s.end) {
        const uint32_t number = byte_of(&s) % (uint32_t)count;
        char *chunk = (char *)t->bytes + offsets[number];
        changed |= UINT64_C(1) << number;
        pl_chunk_header h;
        memcpy(&h, chunk, sizeof h);
        uint32_t place = word_of(&s);
        change(&s, chunk + sizeof h, (size_t)h.bytes, place);
    }
    for (int i = 0; i < count; ++i) {
        if ((changed >> i & 1) != 0) {
            mend_chunk((char *)t->bytes + offsets[i], (uint32_t)i);
        }
    }
    play(t->bytes, t->size, first >= 192);
    free(t);
    return 0;
}
