// replay.h - a replay, for the files of this folder.
#ifndef PL_RECORD_REPLAY_H
#define PL_RECORD_REPLAY_H

#include "plumb/record.h"
#include "plumb/snapshot.h"

#include "record/index.h"
#include "world/observer.h"

typedef struct pl_played_image {
    pl_buffer buffer;
    pl_image image;
} pl_played_image;

struct plumb_replay {
    pl_step_observer observer; // first: its world knows it by that
    plumb_replay_desc desc;
    pl_memory memory;
    pl_index index;
    plumb_world *world;
    uint32_t code;               // pl_index.codes that are registered in the world
    uint64_t step;               // steps taken
    pl_played_image before, now; // around an edit
    const pl_chunk *playing;     // the step under way; NULL: none
    plumb_result failed;         // an edit could not be played
    uint32_t hooks;              // components dropped within the step so far
    bool differs;                // the last step gave other bits than were recorded
    pl_buffer edits;             // plumb_replay_edit of the last step
    int edit_count;
    // differ.c: called behind each pass of a step, and with -1 before the first. NULL: nobody looks.
    void (*look)(void *context, plumb_world *world, int pass);
    void *look_context;
    char error[256];
};

// Keeps the message and sends it to the log; answers `code`.
plumb_result pl_replay_fail(plumb_replay *replay, plumb_result code, const char *function,
                            const char *format, ...) PL_PRINTF(4, 5);
// The image of the world now. False when out of memory.
bool pl_replay_keep(plumb_replay *replay, pl_played_image *kept);
// Plays the edits of one phase (0: before the step, else a pl_edit_mark) of the step under way: of its systems,
// or of the hook of that number in the step; -1: of no hook.
void pl_replay_play(plumb_replay *replay, uint32_t phase, int64_t hook);
// Plays what was told as the step under way began.
void pl_replay_play_told(plumb_replay *replay);
// Registers components and systems of pl_index.codes[code] that the world has not got.
plumb_result pl_replay_register(plumb_replay *replay, uint32_t code);
// Adds what is not alike in two images to the edits of the step.
void pl_replay_list(plumb_replay *replay, int phase, const pl_image *a, const pl_image *b);

#endif
