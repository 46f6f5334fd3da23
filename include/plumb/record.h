/// record.h - a run as a stream of bytes, and the run again: record, replay, find where two differ.
///
///     plumb_recorder_start(world, &(plumb_recorder_desc){ .write = to_file, .context = file });
///     ... the game as ever: calls, steps, systems, hooks ...
///     plumb_recorder_stop(world);
///
///     plumb_replay *replay;
///     plumb_replay_open(bytes, size, NULL, &replay);
///     while (plumb_replay_step(replay) == PLUMB_OK) draw(plumb_replay_world(replay));
///     plumb_replay_close(replay);
///
/// A recording begins with an image of the world. Then it holds for each step: its dt, the hash of the
/// world after it, and what the user changed before and within it. That is found by comparing the state
/// of the world, not by noting calls: whatever changes the state is in it, be it an API call, a command,
/// a system, a hook, an edit of a contact or a value written through a pointer. So a replay runs none of
/// the user's code, and every step of it ends in the bits of the run, whatever the SIMD width and the
/// number of threads. Keyframes, whole images every so many steps, make it seek.
///
/// What is not in the world but belongs to the run (colours, a score, the inputs) can be noted beside it:
/// plumb_recorder_note.
///
/// Not in it: user data (null in the replay) and what pointers in components point to; where those are
/// kept, keep them by entity. Components and systems are registered in the replay's world by the names
/// they have in the recording; systems do nothing there.
///
/// A recording is of one build, as images are (snapshot.h): another build of the same columns may replay
/// it, and each step tells whether it gives the same bits. Each part has a checksum; what is damaged is
/// refused, and a recording that ends early (the program crashed) is read as far as it goes. Recordings may come
/// from strangers: keyframes and changes are checked as images are.
#ifndef PLUMB_RECORD_H
#define PLUMB_RECORD_H

#include "plumb/ecs.h"

PLUMB_BEGIN

// The symbol tells the precision: see plumb_real.
#define plumb_replay_open PLUMB_SYMBOL(plumb_replay_open)

/// Takes `size` bytes, which follow those of the call before. False: no more can be taken (disk full);
/// the recording ends there, the world goes on. Calls no function of the library's.
typedef bool plumb_write_fn(void *context, const void *bytes, size_t size);

typedef struct plumb_recorder_desc {
    plumb_write_fn *write; ///< required
    void *context;         ///< handed to `write`
    int keyframe_every;    ///< [steps] 1..1000000 between keyframes; 0: 120. Fewer: quicker to seek in,
                           ///< and larger by an image each (plumb_world_snapshot_size)
    const char *title;     ///< at most 255 characters, null: ""; told by plumb_replay_get_info
} plumb_recorder_desc;

/// Begins to record: writes the state of the world now. Until the recording is stopped each step is
/// written when it is over, in one call of `write`. While it runs, a step costs one copy, one comparison
/// and one digest of the state more, and the same again for each phase with systems; memory three times
/// the state, and as much again once the user has changed something. A world that is not recorded
/// pays nothing. A world that is destroyed stops recording first. When memory runs out or `write` refuses, the
/// recording ends with the step before, the world steps on; plumb_recorder_get_info tells.
/// A recording holds what systems do between passes: a world with systems in the substep, or before, after or
/// instead of a pass, is refused, and so are these while it runs.
/// Errors: E_NULL, E_RANGE, E_LOCKED, E_STATE (it is recording, is the world of a replay, or has such a system),
/// E_MEMORY, E_WRITE.
PLUMB_API plumb_result plumb_recorder_start(plumb_world *world, const plumb_recorder_desc *desc);

/// Ends the recording: it is complete. What was changed since the last step is not in it.
/// Errors: E_NULL, E_LOCKED, E_STATE (it is not recording); E_WRITE, E_MEMORY: the recording had ended
/// before, see plumb_recorder_start.
PLUMB_API plumb_result plumb_recorder_stop(plumb_world *world);

/// Gives an entity a name in the recording, from the head of which on it is known: for tools that print.
/// May be called at any time. Errors: E_NULL, E_RANGE (1..63 characters), E_HANDLE, E_STATE (it is not
/// recording), E_WRITE, E_MEMORY.
PLUMB_API plumb_result plumb_recorder_name(plumb_world *world, plumb_entity entity,
                                           const char *name);

/// Longest note of plumb_recorder_note [B].
#define PLUMB_NOTE_MAX ((size_t)1 << 20)

/// Puts bytes of your own into the recording, which plumb_replay_note gives back: what a replay is to show that
/// is not in the world (colours, a score, the camera), what it is to be checked by (inputs, the build). `key`
/// is a number of your choosing. The note holds from the state on after the last step taken, or from the
/// head on, until another one with its key takes its place; `size` 0 ends it. The bytes are copied; they do not
/// influence the world, its hash, or where two recordings differ. May be called at any time. O(size).
/// Errors: E_NULL, E_RANGE (size beyond PLUMB_NOTE_MAX), E_STATE (it is not recording), E_WRITE, E_MEMORY.
PLUMB_API plumb_result plumb_recorder_note(plumb_world *world, uint64_t key, const void *bytes,
                                           size_t size);

typedef struct plumb_recorder_info {
    bool recording;     ///< false: the rest is 0
    uint64_t steps;     ///< steps written
    uint64_t keyframes; ///< of those, with a keyframe behind them; the head counts
    uint64_t edited;    ///< steps in which the user changed something
    uint64_t bytes;     ///< [B] written
    uint64_t hash;      ///< plumb_world_hash after the last step written, or at the head
    plumb_result ended; ///< not OK: the recording has ended early (E_WRITE, E_MEMORY)
} plumb_recorder_info;

/// What the recorder of a world has written so far; all zero when there is none. O(1).
PLUMB_API plumb_recorder_info plumb_recorder_get_info(const plumb_world *world);

//---- replay --------------------------------------------------------------------------------------

typedef struct plumb_replay plumb_replay;

typedef struct plumb_replay_desc {
    int simd_width;            ///< as plumb_world_desc
    int workers;               ///< as plumb_world_desc
    bool list_edits;           ///< keep what was changed in each step for plumb_replay_edits: costs two images a step
                               ///< with edits
    plumb_allocator allocator; ///< null members: the C library
    plumb_log_fn *log;         ///< null: silent
    void *hook_context;        ///< handed to `log`
} plumb_replay_desc;

/// Opens a recording and stands at its head, before the first step. `bytes` are not copied: they must stay
/// as they are until the replay is closed. `desc` may be null (= {0}). O(bytes): every part is verified.
/// On error *replay is null and, when the descriptor has a log hook, the message has been sent there.
/// Errors: E_NULL, E_RANGE, E_MEMORY, E_IMAGE (no recording, damaged, of another build or precision).
PLUMB_API plumb_result plumb_replay_open(const void *bytes, size_t size,
                                         const plumb_replay_desc *desc, plumb_replay **replay);
/// Closes it and destroys its world. Null is ignored.
PLUMB_API void plumb_replay_close(plumb_replay *replay);

/// The world as it is at this step, to be looked at: columns, contacts, events, queries. Calls that change
/// it make the next step differ from what was recorded, and steps of one's own are refused nothing. The
/// same world as long as the replay is open, unless plumb_replay_seek or step_back goes to before a step at
/// which a component or system was registered: ask again after those.
PLUMB_API plumb_world *plumb_replay_world(plumb_replay *replay);

typedef struct plumb_replay_info {
    const char *title;   ///< as it was given
    uint64_t steps;      ///< in the recording
    uint64_t step;       ///< steps taken: where the replay stands, 0..steps
    uint64_t step_count; ///< that the world had taken when the recording began
    double start, end;   ///< [s] time of the world at the head and after the last step
    double time;         ///< [s] of the world now
    double dt;           ///< [s] of the step that led here; 0 at the head
    uint64_t hash;       ///< plumb_world_hash here, as recorded
    uint64_t keyframes;  ///< images in it, the head included
    uint64_t edited;     ///< steps in which the user changed something
    uint64_t bytes;      ///< [B] that were read; less than given where it ends early
    int keyframe_every;  ///< [steps]
    bool complete;       ///< it was stopped; false: it ends early
    bool differs;        ///< the step that led here gave other bits than were recorded
} plumb_replay_info;

/// Errors: E_NULL.
PLUMB_API plumb_result plumb_replay_get_info(const plumb_replay *replay, plumb_replay_info *info);

/// What went wrong last, "" if nothing has: one sentence. Never null.
PLUMB_API const char *plumb_replay_error(const plumb_replay *replay);

/// Takes the next step. Cost: the step, and one digest of the state.
/// Errors: E_NULL, E_MISSING (the recording is at its end: not logged), E_MEMORY, E_IMAGE: the step did not give the
/// bits that were recorded: the build is another, or the world was changed. The replay stands after that step;
/// going on is refused with the same error, going back is not.
PLUMB_API plumb_result plumb_replay_step(plumb_replay *replay);

/// Goes one step back. Cost: that of plumb_replay_seek. Errors: E_NULL, E_MISSING (it is at the head),
/// E_MEMORY, E_IMAGE.
PLUMB_API plumb_result plumb_replay_step_back(plumb_replay *replay);

/// Goes to where `step` steps have been taken; contacts and events are those of that step, unless it
/// is 0. Cost: a keyframe restored where that is shorter, and the steps from there.
/// Errors: E_NULL, E_RANGE (beyond the last step), E_MEMORY, E_IMAGE as plumb_replay_step.
PLUMB_API plumb_result plumb_replay_seek(plumb_replay *replay, uint64_t step);

/// The last step at which the world's time was at most `time` [s]; 0 when it was later at the head.
/// O(log steps).
PLUMB_API uint64_t plumb_replay_find(const plumb_replay *replay, double time);

/// The name that an entity was given, null if none.
PLUMB_API const char *plumb_replay_name(const plumb_replay *replay, plumb_entity entity);

/// The note of that key that holds where the replay stands, and its *size [B] (may be null); null and 0 if none.
/// Valid as long as the replay is open; as aligned as the bytes it was opened with, up to 8. O(log notes).
PLUMB_API const void *plumb_replay_note(const plumb_replay *replay, uint64_t key, size_t *size);

//---- differences ---------------------------------------------------------------------------------

typedef enum plumb_difference_kind {
    PLUMB_DIFFERS, ///< in both, with other values
    PLUMB_ONLY_A,  ///< destroyed, read as an edit
    PLUMB_ONLY_B   ///< created
} plumb_difference_kind;

/// One number, or one thing, that is not the same in A and B.
typedef struct plumb_difference {
    plumb_difference_kind kind;
    plumb_entity entity; ///< body, shape, material, joint, bare entity; null: the world itself
    plumb_entity other;  ///< of a contact: its second shape
    plumb_entity_kind entity_kind;
    char table[32];     ///< "bodies", "joints", "contacts", "components", "world", ...
    char component[64]; ///< column, member, name of a user component and its field: "x", "health.points"
    char a[64], b[64];  ///< values, with as many digits as give the same number when read; "" if none
} plumb_difference;

/// How two worlds differ: bodies first, each with its columns in their order, then shapes, joints,
/// characters, user components, contacts, materials, settings and time. Writes up to `capacity` rows, tells in *count how
/// many there are. 0 where the hashes agree. What follows from the rest (links, boxes of the grids, sleep
/// timers) is told only where nothing else is. O(state); the worlds must have the same components.
/// Errors: E_NULL, E_LOCKED, E_IMAGE (other components), E_MEMORY.
PLUMB_API plumb_result plumb_world_compare(const plumb_world *a, const plumb_world *b,
                                           plumb_difference *rows, int capacity, int *count);

/// A change that the user made, in the step that led here.
typedef struct plumb_replay_edit {
    int phase;               ///< -1: before the step (calls, commands); else the plumb_phase whose systems made it;
                             ///< PLUMB_PHASE_END also: a hook of a component, of a joint that broke in the step
    plumb_difference change; ///< A before, B after
} plumb_replay_edit;

/// What the user changed in the step that led here; needs `list_edits`. Writes up to `capacity` rows,
/// returns how many there are; 0 at the head and after an error. O(1) a row.
PLUMB_API int plumb_replay_edits(const plumb_replay *replay, plumb_replay_edit *rows, int capacity);

/// The first step of two recordings after which the worlds differ in more than their settings.
typedef struct plumb_replay_difference {
    bool found;             ///< false: all steps that both have are the same
    uint64_t step;          ///< after so many steps (of B) they differ; 0: at the head already
    double time[2];         ///< [s] then
    const char *pass;       ///< "head", "edits" (what the user did before the step), or the first pass of the
                            ///< schedule after which they differ; "" where that cannot be found out: see `seen`
    uint64_t seen;          ///< steps at which `first` was seen: `step`, but where one does not give its bits in this
                            ///< build, the next keyframe that both have; 0: there is none
    plumb_difference first; ///< what differs then
} plumb_replay_difference;

/// Replays both from where they stand, side by side, to the first step after which the worlds differ, and
/// that step again pass by pass. Afterwards both stand after that step, or at the end of the shorter.
/// Where a recording of another build does not replay in this one, the recorded hashes and keyframes are compared
/// instead; the replays then stand where that was found out.
/// Cost: both replays, two digests a step. Errors: E_NULL, E_IMAGE (other components; or a recording does not replay
/// and they have other settings, see plumb_replay_error of both), E_MEMORY.
PLUMB_API plumb_result plumb_replay_compare(plumb_replay *a, plumb_replay *b,
                                            plumb_replay_difference *difference);

PLUMB_END

#endif
