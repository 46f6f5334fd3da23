/// engine_session.h - what engine.c, engine_observe.c and engine_draw.c know of a session.
#ifndef PLUMB_ENGINE_SESSION_H
#define PLUMB_ENGINE_SESSION_H

#include "engine.h"

#include "../scene/scene.h"

struct engine_session {
    scene *scene;
    plumb_world *world;
    scene_info info;
    scene_camera camera;
    // Lists handed out; grown when too small, never shrunk.
    engine_row *rows;
    engine_expect *expects;
    engine_pass *passes;
    plumb_pass_info *pass_infos;
    plumb_contact *contacts;
    plumb_entity *shapes;
    plumb_aabb *cells;
    size_t row_room, expect_room, pass_room, info_room, contact_room, shape_room,
        cell_room; ///< [B]
    // While it is recorded: generation of the entities that were named, by their index.
    bool recording;
    uint32_t *named;
    uint32_t named_count;
};

/// `list` with room for `count` elements of `size` bytes, perhaps moved, not null even for none.
/// Null: out of memory, `list` as it was.
void *pl_session_reserve(void *list, size_t *room, int count, size_t size);

/// Fills `error`; answers `code`.
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
int pl_session_fail(engine_error *error, int code, const char *format, ...);
/// The same from an error of the loader. `session` null: nothing is open yet.
int pl_session_fail_scene(const engine_session *session, const scene_error *from,
                          engine_error *error);

/// The colour number of body `i`: the author's, else by order of making.
int pl_session_palette(const scene_body *body, int i);

/// The functions of engine_api that are not in engine.c, by the names they have there.
int pl_session_rows(engine_session *session, const engine_row **rows);
int pl_session_exact(engine_session *session, double *distance, engine_error *error);
int pl_session_expectations(engine_session *session, const engine_expect **list);
int pl_session_passes(engine_session *session, const engine_pass **list);
engine_stats pl_session_stats(const engine_session *session);
bool pl_session_word(int constructor, int key, engine_word *word);
/// Parts of pl_session_draw: joints that the scene does not hide; of `shapes` those that run.
void pl_session_add_joints(const engine_session *session, struct render_frame *frame);
void pl_session_add_surfaces(const engine_session *session, const plumb_entity *shapes, int count,
                             struct render_frame *frame);
int pl_session_draw(engine_session *session, struct render_frame *frame, unsigned show);
void pl_session_bounds(const engine_session *session, engine_box *moving, engine_box *fixed);
int pl_session_record(engine_session *session, FILE *file, int keyframes, engine_error *error);
int pl_session_record_end(engine_session *session, engine_error *error);
/// Names what is new to the recording. CLI_FAILED: out of memory.
int pl_session_name(engine_session *session, engine_error *error);

engine_replay *pl_replay_session_open(const char *path, const void *bytes, size_t size, int width,
                                      bool edits, engine_error *error);
void pl_replay_session_close(engine_replay *replay);
engine_replay_info pl_replay_session_info(const engine_replay *replay);
int pl_replay_session_seek(engine_replay *replay, unsigned long long step, engine_error *error);
unsigned long long pl_replay_session_find(const engine_replay *replay, double time);
int pl_replay_session_rows(engine_replay *replay, const engine_row **rows);
int pl_replay_session_edits(engine_replay *replay, const engine_change **list);
int pl_replay_session_settings(engine_replay *a, engine_replay *b, const engine_change **list);
int pl_replay_session_compare(engine_replay *a, engine_replay *b, engine_difference *difference,
                              engine_error *error);

#endif
