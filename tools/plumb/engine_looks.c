/// engine_looks.c - what of a scene's looks goes into its recording, and what a replay reads of it.
/// Compiled once for each precision, as engine.c.
///
/// A recording holds the world; colours, labels, what is hidden, the camera and the line of counters are the
/// scene's. They are notes (plumb_recorder_note), written when they are new or have changed, so that
/// the replay draws each step as it looked then. The note of a body or joint has its handle as key; no
/// handle has generation 0, so the keys of the camera and the text are free. Notes of others, which may have the
/// same keys, are told apart by tag and size. Cost: O(bodies and joints) a step.
#include "engine_session.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CAMERA = 1, TEXT = 2, CLOCK = 3 }; ///< keys: slots of generation 0

#define LOOK_TAG   UINT32_C(0x4b4f4f4c) // "LOOK"
#define CAMERA_TAG UINT32_C(0x454d4143) // "CAME"
#define CLOCK_TAG  UINT32_C(0x434f4c43) // "CLOC"

/// Of a body or joint. No padding: it is compared and written as bytes.
typedef struct look {
    uint32_t tag;
    int32_t palette;
    uint8_t color[4]; ///< sRGB and opacity; opacity 0: the palette's
    uint8_t named, hidden, unused[2];
    char label[64];
} look;

typedef struct camera_note {
    uint32_t tag;
    uint8_t has_view, has_fit, has_at, unused;
    double center[2], height, box[4], at, trail;
    char follow[64];
} camera_note;

/// The scene's time, start + steps * dt in double. The world's is a sum of steps in its own precision, and differs
/// from it in the ninth digit.
typedef struct clock_note {
    uint32_t tag, unused;
    double start, dt; ///< [s]
} clock_note;

struct session_kept {
    uint32_t generation; ///< 0: never met
    look look;
};

static uint64_t key_of(uint32_t index, uint32_t generation)
{
    return (uint64_t)index << 32 | generation;
}

// ------------------------------------------------------------------------------------- recording

/// What is kept of an entity; null: out of memory.
static struct session_kept *kept_of(engine_session *session, plumb_entity entity)
{
    if (entity.index >= session->kept_count) {
        uint32_t count = entity.index + entity.index / 2 + 64;
        struct session_kept *grown = realloc(session->kept, count * sizeof *grown);
        if (grown == NULL) {
            return NULL;
        }
        memset(grown + session->kept_count, 0, (count - session->kept_count) * sizeof *grown);
        session->kept = grown;
        session->kept_count = count;
    }
    return &session->kept[entity.index];
}

/// A file that takes no more is told of when the recording ends.
static plumb_result unless_ended(plumb_result result)
{
    return result == PLUMB_E_WRITE || result == PLUMB_E_MEMORY ? PLUMB_OK : result;
}

/// Names what is new, notes what looks otherwise than before.
static plumb_result keep(engine_session *session, plumb_entity entity, const char *name,
                         const look *now)
{
    plumb_world *world = session->stage.world;
    struct session_kept *kept = kept_of(session, entity);
    plumb_result r = PLUMB_OK;
    if (kept == NULL) {
        return PLUMB_E_MEMORY;
    }
    bool is_new = kept->generation != entity.generation;
    if (is_new) {
        char cut[64];
        snprintf(cut, sizeof cut, "%.63s", name);
        r = unless_ended(plumb_recorder_name(world, entity, cut));
    }
    if (r == PLUMB_OK && (is_new || memcmp(&kept->look, now, sizeof *now) != 0)) {
        r = unless_ended(
            plumb_recorder_note(world, key_of(entity.index, entity.generation), now, sizeof *now));
    }
    *kept = (struct session_kept){ entity.generation, *now };
    return r;
}

static plumb_result keep_body(engine_session *session, int i)
{
    scene_body body = scene_body_get(session->stage.scene, i);
    look now = { .tag = LOOK_TAG,
                 .palette = pl_stage_palette(&body, i),
                 .color = { body.color.r, body.color.g, body.color.b, body.color.a },
                 .named = body.is_named,
                 .hidden = body.hidden };
    snprintf(now.label, sizeof now.label, "%s", body.label);
    return keep(session, body.entity.entity, body.name, &now);
}

static plumb_result keep_joint(engine_session *session, int i)
{
    scene_joint joint = scene_joint_get(session->stage.scene, i);
    const look now = { .tag = LOOK_TAG, .named = joint.is_named, .hidden = joint.hidden };
    return keep(session, joint.entity.entity, joint.name, &now);
}

static plumb_result keep_text(engine_session *session)
{
    char now[sizeof session->text] = "";
    snprintf(now, sizeof now, "%s", pl_stage_text(&session->stage));
    if (strcmp(now, session->text) == 0) {
        return PLUMB_OK;
    }
    memcpy(session->text, now, sizeof now);
    return unless_ended(
        plumb_recorder_note(session->stage.world, key_of(TEXT, 0), now, strlen(now) + 1));
}

int pl_session_note_looks(engine_session *session, engine_error *error)
{
    plumb_result r = keep_text(session);
    for (int i = 0; r == PLUMB_OK && i < scene_body_count(session->stage.scene); i++) {
        r = keep_body(session, i);
    }
    for (int i = 0; r == PLUMB_OK && i < scene_joint_count(session->stage.scene); i++) {
        r = keep_joint(session, i);
    }
    return r == PLUMB_OK ? CLI_OK
                         : pl_session_fail(error, CLI_FAILED, "--record: %s",
                                           r == PLUMB_E_MEMORY
                                               ? "out of memory"
                                               : plumb_world_error(session->stage.world).message);
}

void pl_session_note_camera(engine_session *session)
{
    const scene_camera *from = &session->stage.camera;
    camera_note note = { .tag = CAMERA_TAG,
                         .has_view = from->has_view,
                         .has_fit = from->has_fit,
                         .has_at = from->has_at,
                         .center = { from->center[0], from->center[1] },
                         .height = from->height,
                         .box = { from->box[0], from->box[1], from->box[2], from->box[3] },
                         .at = from->at,
                         .trail = from->trail };
    snprintf(note.follow, sizeof note.follow, "%s", from->follow != NULL ? from->follow : "");
    // A file that takes no more is told of when the recording ends.
    (void)plumb_recorder_note(session->stage.world, key_of(CAMERA, 0), &note, sizeof note);
}

void pl_session_note_clock(engine_session *session)
{
    const clock_note note = { .tag = CLOCK_TAG,
                              .start = scene_time(session->stage.scene),
                              .dt = session->stage.info.dt };
    (void)plumb_recorder_note(session->stage.world, key_of(CLOCK, 0), &note, sizeof note);
}

// ------------------------------------------------------------------------------------- replaying

/// A note of our own, of that size; null: none.
static const void *find_note(const plumb_replay *replay, uint64_t key, uint32_t tag, size_t size)
{
    size_t got;
    uint32_t is;
    const void *note = plumb_replay_note(replay, key, &got);
    if (note == NULL || got != size) {
        return NULL;
    }
    memcpy(&is, note, sizeof is);
    return is == tag ? note : NULL;
}

static const look *find_look(const plumb_replay *replay, plumb_entity entity)
{
    const look *note =
        find_note(replay, key_of(entity.index, entity.generation), LOOK_TAG, sizeof *note);
    return note != NULL && memchr(note->label, '\0', sizeof note->label) != NULL ? note : NULL;
}

void pl_stage_read_body(const plumb_replay *replay, scene_body *body)
{
    const look *note = find_look(replay, body->entity.entity);
    if (note != NULL) {
        body->is_named = note->named != 0;
        body->label = note->label;
        body->palette = note->palette >= 0 ? note->palette : 0;
        body->color =
            (scene_rgba){ note->color[0], note->color[1], note->color[2], note->color[3] };
        body->hidden = note->hidden != 0;
    }
}

void pl_stage_read_joint(const plumb_replay *replay, scene_joint *joint)
{
    const look *note = find_look(replay, joint->entity.entity);
    if (note != NULL) {
        joint->is_named = note->named != 0;
        joint->hidden = note->hidden != 0;
    }
}

/// What camera{} would have taken, too.
static bool is_camera(const camera_note *note)
{
    const double *box = note->box;
    bool good = memchr(note->follow, '\0', sizeof note->follow) != NULL;
    good &= isfinite(note->at) && isfinite(note->trail) && note->trail >= 0;
    good &= !note->has_view || (isfinite(note->center[0]) && isfinite(note->center[1]) &&
                                isfinite(note->height) && note->height > 0);
    for (int i = 0; note->has_fit && i < 4; i++) {
        good &= isfinite(box[i]) != 0;
    }
    return good && (!note->has_fit || (box[0] < box[2] && box[1] < box[3]));
}

void pl_stage_read_camera(const plumb_replay *replay, scene_camera *camera)
{
    const camera_note *note = find_note(replay, key_of(CAMERA, 0), CAMERA_TAG, sizeof *note);
    *camera = (scene_camera){ .follow = "" };
    if (note != NULL && is_camera(note)) {
        *camera = (scene_camera){ .has_view = note->has_view != 0,
                                  .center = { note->center[0], note->center[1] },
                                  .height = note->height,
                                  .has_fit = note->has_fit != 0,
                                  .box = { note->box[0], note->box[1], note->box[2], note->box[3] },
                                  .follow = note->follow,
                                  .has_at = note->has_at != 0,
                                  .at = note->at,
                                  .trail = note->trail };
    }
}

double pl_stage_read_time(const plumb_replay *replay, uint64_t steps, double otherwise)
{
    const clock_note *note = find_note(replay, key_of(CLOCK, 0), CLOCK_TAG, sizeof *note);
    if (note == NULL) {
        return otherwise;
    }
    double time = note->start + (double)steps * note->dt;
    return fabs(time - otherwise) <= 1e-6 * fabs(otherwise) ? time : otherwise;
}

const char *pl_stage_read_text(const plumb_replay *replay)
{
    size_t size;
    const char *note = plumb_replay_note(replay, key_of(TEXT, 0), &size);
    return note != NULL && note[size - 1] == '\0' ? note : "";
}
