/// engine_record.c - recording a session and replaying a recording, behind the plain types of engine.h.
/// Compiled once for each precision, as engine.c.
///
/// Writes the file it is given; reads the bytes of a recording. The lists belong to session and replay
/// and are reused.
#include "engine_session.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

// ------------------------------------------------------------------------------------- recording

static bool to_file(void *context, const void *bytes, size_t size)
{
    engine_session *session = context;
    errno = 0;
    bool written = fwrite(bytes, 1, size, session->record_file) == size;
    session->record_reason = written ? session->record_reason : errno;
    return written;
}

int pl_session_record(engine_session *session, FILE *file, int keyframes, engine_error *error)
{
    char title[256];
    snprintf(title, sizeof title, "%.255s", session->stage.info.title);
    const plumb_recorder_desc desc = {
        .write = to_file, .context = session, .keyframe_every = keyframes, .title = title
    };
    session->record_file = file;
    if (plumb_recorder_start(session->stage.world, &desc) != PLUMB_OK) {
        error->reason = session->record_reason;
        return pl_session_fail(error, CLI_FAILED, "--record: %s",
                               plumb_world_error(session->stage.world).message);
    }
    session->recording = true;
    pl_session_note_camera(session);
    pl_session_note_clock(session);
    return pl_session_note_looks(session, error);
}

int pl_session_record_end(engine_session *session, engine_error *error)
{
    session->recording = false;
    error->reason = session->record_reason;
    if (plumb_recorder_stop(session->stage.world) != PLUMB_OK) {
        return pl_session_fail(error, CLI_FAILED, "--record: %s",
                               plumb_world_error(session->stage.world).message);
    }
    return CLI_OK;
}

// -------------------------------------------------------------------------------------- replaying

struct engine_replay {
    plumb_replay *replay;
    const char *path;
    char message[512]; ///< the last one of the library
    engine_stage stage;
    engine_change *changes;
    plumb_replay_edit *edits;
    plumb_difference *differences;
    size_t change_room, edit_room, difference_room; ///< [B]
};

static void keep_message(void *context, plumb_log_level level, const char *message)
{
    engine_replay *replay = context;
    if (level == PLUMB_LOG_ERROR) {
        // What it says begins with the name of the function.
        const char *text = strstr(message, ": ");
        snprintf(replay->message, sizeof replay->message, "%s", text != NULL ? text + 2 : message);
    }
}

static int fail_replay(const engine_replay *replay, plumb_result result, engine_error *error)
{
    plumb_replay_info info = { 0 };
    if (plumb_replay_get_info(replay->replay, &info) == PLUMB_OK && info.differs) {
        return pl_session_fail(error, CLI_DIFFERS, "%s: %s", replay->path, replay->message);
    }
    return pl_session_fail(error, CLI_FAILED, "%s: %s", replay->path,
                           result == PLUMB_E_MEMORY ? "out of memory" : replay->message);
}

engine_replay *pl_replay_session_open(const char *path, const void *bytes, size_t size, int width,
                                      bool edits, engine_error *error)
{
    engine_replay *replay = calloc(1, sizeof *replay);
    if (replay == NULL) {
        pl_session_fail(error, CLI_FAILED, "out of memory");
        return NULL;
    }
    replay->path = path;
    const plumb_replay_desc desc = {
        .simd_width = width, .list_edits = edits, .log = keep_message, .hook_context = replay
    };
    plumb_result r = plumb_replay_open(bytes, size, &desc, &replay->replay);
    if (r == PLUMB_OK) {
        pl_stage_open_replay(&replay->stage, replay->replay, path);
        return replay;
    }
    // "bytes is damaged; it must be as it was recorded": the file is what the user knows of.
    const char *text = replay->message;
    text += strncmp(text, "bytes ", 6) == 0 ? 6 : 0;
    pl_session_fail(error, CLI_FAILED, "'%s' %.*s", path, (int)strcspn(text, ";"), text);
    free(replay);
    return NULL;
}

void pl_replay_session_close(engine_replay *replay)
{
    if (replay == NULL) {
        return;
    }
    plumb_replay_close(replay->replay);
    pl_stage_close(&replay->stage);
    free(replay->changes);
    free(replay->edits);
    free(replay->differences);
    free(replay);
}

engine_replay_info pl_replay_session_info(const engine_replay *replay)
{
    plumb_replay_info from = { 0 };
    plumb_replay_get_info(replay->replay, &from);
    return (engine_replay_info){ .title = from.title,
                                 .steps = from.steps,
                                 .step = from.step,
                                 .keyframes = from.keyframes,
                                 .edited = from.edited,
                                 .bytes = from.bytes,
                                 .first = from.step_count,
                                 .start = pl_stage_read_time(replay->replay, 0, from.start),
                                 .end = pl_stage_read_time(replay->replay, from.steps, from.end),
                                 .time = pl_stage_read_time(replay->replay, from.step, from.time),
                                 .dt = from.dt,
                                 .hash = from.hash,
                                 .complete = from.complete };
}

int pl_replay_session_seek(engine_replay *replay, unsigned long long step, engine_error *error)
{
    plumb_result r = plumb_replay_seek(replay->replay, step);
    return r == PLUMB_OK ? CLI_OK : fail_replay(replay, r, error);
}

engine_stage *pl_replay_session_stage(engine_replay *replay)
{
    return pl_stage_look(&replay->stage) ? &replay->stage : NULL;
}

unsigned long long pl_replay_session_find(const engine_replay *replay, double time)
{
    return plumb_replay_find(replay->replay, time);
}

// ---------------------------------------------------------------------------------------- in words

/// "body 'ball'", or "body 7:1" where it has no name. `table`: where it is, or was, stored.
static void write_entity(const engine_replay *replay, plumb_entity entity, const char *table,
                         char *to, size_t size)
{
    plumb_entity_kind kind = plumb_entity_get_kind(plumb_replay_world(replay->replay), entity);
    const char *name = plumb_replay_name(replay->replay, entity);
    if (name != NULL) {
        // Only bodies and joints are given names; what is gone by now has no kind any more.
        bool joint =
            kind == PLUMB_KIND_JOINT || (kind == PLUMB_KIND_NONE && strcmp(table, "joints") == 0);
        snprintf(to, size, "%s '%s'", joint ? "joint" : "body", name);
    } else {
        const bool bare = kind == PLUMB_KIND_NONE || kind == PLUMB_KIND_BARE;
        snprintf(to, size, "%s %u:%u", bare ? "entity" : plumb_entity_kind_name(kind),
                 (unsigned)entity.index, (unsigned)entity.generation);
    }
}

/// Of a shape; null of anything else.
static plumb_body body_of(const plumb_world *world, plumb_entity entity)
{
    return plumb_entity_get_kind(world, entity) == PLUMB_KIND_SHAPE
               ? plumb_shape_body(world, (plumb_shape){ entity })
               : (plumb_body)PLUMB_NULL_INIT;
}

static void write_who(const engine_replay *replay, const plumb_difference *d, char *to, size_t size)
{
    plumb_world *world = plumb_replay_world(replay->replay);
    char first[80] = "", second[80] = "";
    if (plumb_is_null(d->entity)) {
        snprintf(to, size, "%s", d->table);
        return;
    }
    plumb_body body = body_of(world, d->entity), other = body_of(world, d->other);
    write_entity(replay, plumb_is_null(body) ? d->entity : body.entity, d->table, first,
                 sizeof first);
    if (!plumb_is_null(d->other)) {
        write_entity(replay, plumb_is_null(other) ? d->other : other.entity, d->table, second,
                     sizeof second);
        snprintf(to, size, "contact of %s and %s", first, second);
    } else if (!plumb_is_null(body)) {
        snprintf(to, size, "shape %u:%u of %s", (unsigned)d->entity.index,
                 (unsigned)d->entity.generation, first);
    } else {
        snprintf(to, size, "%s", first);
    }
}

/// Choices by their names.
static void name_choice(engine_change *change)
{
    const char *names = strcmp(change->what, "solver") == 0   ? ENGINE_SOLVERS
                        : strcmp(change->what, "y_axis") == 0 ? "up,down"
                                                              : "";
    (void)cli_member(names, change->from[0] - '0', change->from, sizeof change->from);
    (void)cli_member(names, change->to[0] - '0', change->to, sizeof change->to);
}

/// `only`: what a thing is called that only B, or only A, has.
static void write_change(const engine_replay *replay, const plumb_difference *d,
                         const char *const only[2], engine_change *to)
{
    *to = (engine_change){ .when = "" };
    write_who(replay, d, to->who, sizeof to->who);
    if (d->kind == PLUMB_DIFFERS) {
        snprintf(to->what, sizeof to->what, "%s", d->component);
        snprintf(to->from, sizeof to->from, "%s", d->a);
        snprintf(to->to, sizeof to->to, "%s", d->b);
        if (plumb_is_null(d->entity)) {
            name_choice(to);
        }
    } else {
        snprintf(to->what, sizeof to->what, "%s%s%s", d->component,
                 d->component[0] != '\0' ? " " : "", only[d->kind == PLUMB_ONLY_B]);
    }
}

int pl_replay_session_edits(engine_replay *replay, const engine_change **list)
{
    static const char *const phases[] = { "before the step", "begin systems", "force systems",
                                          "contact systems", "end systems" };
    static const char *const only[2] = { "destroyed", "created" };
    int count = plumb_replay_edits(replay->replay, NULL, 0);
    if (!pl_session_reserve(&replay->edits, &replay->edit_room, count, sizeof *replay->edits) ||
        !pl_session_reserve(&replay->changes, &replay->change_room, count,
                            sizeof *replay->changes)) {
        return -1;
    }
    plumb_replay_edit *edits = replay->edits;
    engine_change *changes = replay->changes;
    plumb_replay_edits(replay->replay, edits, count);
    for (int i = 0; i < count; i++) {
        write_change(replay, &edits[i].change, only, &changes[i]);
        snprintf(changes[i].when, sizeof changes[i].when, "%s", phases[edits[i].phase + 1]);
    }
    *list = changes;
    return count;
}

// ----------------------------------------------------------------------------------------- compare

int pl_replay_session_settings(engine_replay *a, engine_replay *b, const engine_change **list)
{
    static const char *const only[2] = { "only in the first", "only in the second" };
    int count = 0, kept = 0;
    plumb_world *wa = plumb_replay_world(a->replay), *wb = plumb_replay_world(b->replay);
    if (plumb_world_compare(wa, wb, NULL, 0, &count) != PLUMB_OK) {
        count = 0;
    }
    if (!pl_session_reserve(&a->differences, &a->difference_room, count, sizeof *a->differences) ||
        !pl_session_reserve(&a->changes, &a->change_room, count, sizeof *a->changes)) {
        return -1;
    }
    plumb_difference *found = a->differences;
    engine_change *changes = a->changes;
    if (count > 0) {
        plumb_world_compare(wa, wb, found, count, &count);
    }
    for (int i = 0; i < count; i++) {
        if (strcmp(found[i].table, "world") == 0) {
            write_change(a, &found[i], only, &changes[kept++]);
        }
    }
    *list = changes;
    return kept;
}

int pl_replay_session_compare(engine_replay *a, engine_replay *b, engine_difference *difference,
                              engine_error *error)
{
    static const char *const only[2] = { "only in the first", "only in the second" };
    plumb_replay_difference found;
    plumb_result r = plumb_replay_compare(a->replay, b->replay, &found);
    if (r != PLUMB_OK) {
        plumb_replay_info info = { 0 };
        plumb_replay_get_info(b->replay, &info);
        return fail_replay(info.differs ? b : a, r, error);
    }
    *difference = (engine_difference){ .found = found.found,
                                       .step = found.step,
                                       .seen = found.seen,
                                       .time = { found.time[0], found.time[1] } };
    snprintf(difference->pass, sizeof difference->pass, "%s", found.pass);
    if (found.found && found.first.table[0] != '\0') {
        write_change(found.first.kind == PLUMB_ONLY_B ? b : a, &found.first, only,
                     &difference->first);
    }
    return CLI_OK;
}
