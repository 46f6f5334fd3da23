/// engine_session.h - what the files engine*.c know of a session, of a stage and of a replay.
#ifndef PLUMB_ENGINE_SESSION_H
#define PLUMB_ENGINE_SESSION_H

#include "engine.h"

#include "../scene/scene.h"

/// What can be seen of a world: of a scene that runs, or of a recording, which has no scene but what was noted.
struct engine_stage {
    plumb_world *world;
    scene *scene; ///< null: of a recording
    scene_info info;
    scene_camera camera;
    // Of a recording only: its bodies and joints by handle, and their colours; see engine_stage.c.
    plumb_replay *replay;
    scene_body *bodies;
    scene_joint *joints;
    int body_count, joint_count;
    void *handles; ///< those of bodies, then those of joints
    char (*names)[64];
    struct stage_hue {
        uint32_t generation;
        int palette;
    } * hues; ///< by index of the entity
    uint32_t hue_count;
    int next_palette;
    // Lists handed out or drawn from; grown when too small, never shrunk.
    engine_row *rows;
    plumb_contact *contacts;
    plumb_shape *shapes;
    plumb_aabb *cells;
    plumb_shape *seen;    ///< by one sensor
    plumb_body *immersed; ///< in fluids, one for each of its shapes in each
    size_t body_room, joint_room, handle_room, name_room, row_room, contact_room, shape_room,
        cell_room, seen_room, immersed_room; ///< [B]
};

/// Another engine that takes the scene's steps: see scene_options.
typedef struct engine_mover {
    void (*step)(void *context, plumb_world *world, double dt);
    void (*joint_force)(void *context, plumb_joint joint, double force[2], double *torque);
    void *context;
} engine_mover;

struct engine_session {
    engine_stage stage;
    bool is_bare; ///< a step is one of the world and nothing else
    void *mover;  ///< of who has opened it, for its own use
    engine_expect *expects;
    engine_pass *passes;
    plumb_pass_info *pass_infos;
    engine_overlap *overlaps;
    engine_finding *findings, *idle;
    struct session_use *uses; ///< by index of the entity: engine_unused.c
    uint32_t use_count;
    engine_alarm *alarms;
    size_t expect_room, pass_room, info_room, overlap_room, finding_room, alarm_room,
        idle_room; ///< [B]
    // While it is recorded: what was last said of the looks of each entity, by its index; and the text.
    bool recording;
    FILE *record_file;
    int record_reason; ///< errno of a write that failed
    struct session_kept *kept;
    uint32_t kept_count;
    char text[512];
};

/// Gives the list at `list`, a pointer to a pointer, room for `count` elements of `size` bytes; it is not null
/// even for none. False: out of memory, all is as it was.
bool pl_session_reserve(void *list, size_t *room, int count, size_t size);

/// Fills `error`; answers `code`.
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
int pl_session_fail(engine_error *error, int code, const char *format, ...);
/// The same from an error of the loader. `session` null: nothing is open yet.
int pl_session_fail_scene(const engine_session *session, const scene_error *from,
                          engine_error *error);

/// Stages, by the names that the functions have in engine_api.
engine_info pl_stage_info(const engine_stage *stage);
double pl_stage_time(const engine_stage *stage);
engine_stats pl_stage_stats(const engine_stage *stage);
engine_accuracy pl_stage_accuracy(const engine_stage *stage);
const char *pl_stage_text(const engine_stage *stage);
int pl_stage_rows(engine_stage *stage, const engine_row **rows);
void pl_stage_bounds(const engine_stage *stage, double reach, engine_box *moving,
                     engine_box *fixed);
int pl_stage_draw(engine_stage *stage, struct render_frame *frame, unsigned show);
int pl_stage_draw_flow(engine_stage *stage, struct render_frame *frame, const engine_box *view);
int pl_stage_draw_field(engine_stage *stage, struct render_frame *frame, const engine_box *view);
/// Bodies and joints as scene.h tells them.
int pl_stage_body_count(const engine_stage *stage);
scene_body pl_stage_body(const engine_stage *stage, int i);
int pl_stage_joint_count(const engine_stage *stage);
scene_joint pl_stage_joint(const engine_stage *stage, int i);
/// The colour number of body `i`: the author's, else by order of making.
int pl_stage_palette(const scene_body *body, int i);
/// Parts of pl_stage_draw: joints that are not hidden; of `shapes` those that run.
void pl_stage_add_joints(const engine_stage *stage, struct render_frame *frame);
plumb_aabb pl_stage_softbody_box(const engine_stage *stage, plumb_softbody body); ///< of its nodes
/// A point of a body's frame, in the world.
struct render_vec pl_to_world(plumb_transform frame, plumb_vec2 p);
/// Lines along those sides of a fluid that face up.
void pl_stage_add_water_line(const plumb_world *world, plumb_shape shape, plumb_transform where,
                             struct render_frame *frame);
/// Of a one-way platform: arrow heads on the side from which things come through; else nothing.
void pl_stage_add_one_way(const plumb_world *world, plumb_shape shape, plumb_transform where,
                          struct render_frame *frame);
/// Water whose surface has waves; false: the shape has none.
bool pl_stage_add_waves(const engine_stage *stage, plumb_shape shape, plumb_transform where,
                        struct render_frame *frame);
/// Beams of the lamps of a scene. False when out of memory.
/// The needle of a body with a dipole, within the `count` shapes of the stage's list.
void pl_stage_add_dipole(const engine_stage *stage, plumb_body body, int count,
                         struct render_frame *frame);
bool pl_stage_add_light(const engine_stage *stage, struct render_frame *frame);
/// Adds all soft bodies to a draw list. False when out of memory.
/// All of them, for the caller to free; null when out of memory, but not for none.
plumb_softbody *pl_stage_softbodies(const engine_stage *stage, int *count);
bool pl_stage_add_softbodies(const engine_stage *stage, struct render_frame *frame);
void pl_stage_add_surfaces(const engine_stage *stage, const plumb_shape *shapes, int count,
                           struct render_frame *frame);
/// Of a recording: `path` names it where it has no title.
void pl_stage_open_replay(engine_stage *stage, plumb_replay *replay, const char *path);
/// Sees the replay's world as it is now. False: out of memory.
bool pl_stage_look(engine_stage *stage);
void pl_stage_close(engine_stage *stage);

/// The functions of engine_api that are not in engine.c, by the names they have there.
int pl_session_exact(engine_session *session, double *distance, engine_error *error);
int pl_session_form_error(engine_session *session, int i, double *distance, engine_error *error);
int pl_session_form(engine_session *session, int i, engine_form *form, engine_error *error);
void pl_session_nudge(engine_session *session, double distance, unsigned seed);
engine_totals pl_stage_totals(const engine_stage *stage);
int pl_session_expectations(engine_session *session, const engine_expect **list);
int pl_session_overlaps(engine_session *session, const engine_overlap **list);
int pl_session_lint(engine_session *session, const engine_finding **list);
int pl_session_alarms(engine_session *session, const engine_alarm **list);
/// The stage's world again, all awake and with its contacts; null: it cannot be had.
plumb_world *pl_stage_refreshed(const engine_stage *stage);
int pl_session_passes(engine_session *session, const engine_pass **list);
void pl_session_because(engine_session *session, const engine_pass *pass, engine_because *because);
/// What the shapes of a body are.
typedef struct engine_shapes_are {
    bool solid, sensor, fluid, elastic;
} engine_shapes_are;
/// They are in the stage's `shapes` then.
engine_shapes_are pl_stage_look_at_shapes(engine_stage *stage, plumb_body body);
/// Shapes that overlap a sensor, in the stage's `seen`; how many, -1 when out of memory.
int pl_stage_seen(engine_stage *stage, plumb_shape sensor);
bool pl_session_note_use(engine_session *session);
int pl_session_unused(engine_session *session, const engine_finding **list);
const char *pl_session_lacks(int index);
void pl_session_measure(engine_session *session, engine_measures *sum);
bool pl_session_word(int constructor, int key, engine_word *word);
int pl_session_record(engine_session *session, FILE *file, int keyframes, engine_error *error);
int pl_session_record_end(engine_session *session, engine_error *error);
/// Into the recording: names of what is new, looks that have changed. CLI_FAILED: out of memory.
int pl_session_note_looks(engine_session *session, engine_error *error);
void pl_session_note_camera(engine_session *session);
void pl_session_note_clock(engine_session *session);
/// Out of the recording, as it is where the replay stands; what it says nothing of stays as it was.
void pl_stage_read_body(const plumb_replay *replay, scene_body *body);
void pl_stage_read_joint(const plumb_replay *replay, scene_joint *joint);
void pl_stage_read_camera(const plumb_replay *replay, scene_camera *camera);
/// [s] of the scene after so many recorded steps, if the recording is a scene's; else `otherwise`, the world's.
double pl_stage_read_time(const plumb_replay *replay, uint64_t steps, double otherwise);
const char *pl_stage_read_text(const plumb_replay *replay); ///< "" if none

engine_replay *pl_replay_session_open(const char *path, const void *bytes, size_t size, int width,
                                      bool edits, engine_error *error);
void pl_replay_session_close(engine_replay *replay);
engine_replay_info pl_replay_session_info(const engine_replay *replay);
int pl_replay_session_seek(engine_replay *replay, unsigned long long step, engine_error *error);
unsigned long long pl_replay_session_find(const engine_replay *replay, double time);
engine_stage *pl_replay_session_stage(engine_replay *replay);
int pl_replay_session_edits(engine_replay *replay, const engine_change **list);
int pl_replay_session_settings(engine_replay *a, engine_replay *b, const engine_change **list);
int pl_replay_session_compare(engine_replay *a, engine_replay *b, engine_difference *difference,
                              engine_error *error);

#endif
