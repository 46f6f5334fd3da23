/// trail.h - where bodies have been: the lines that `--trail` draws behind them.
#ifndef PLUMB_TRAIL_H
#define PLUMB_TRAIL_H

#include "../render/render.h"
#include "engine.h"

/// Trails of all moving bodies. {0} with `seconds` set is empty; trail_free.
typedef struct trail_set {
    double seconds; ///< [s] how far back; 0: keep nothing
    struct trail *items;
    int count, room;
    double wrap_x, wrap_y; ///< [m] see engine_info
} trail_set;

/// Remembers where all moving bodies are now. False: out of memory.
bool trail_record(trail_set *set, const engine_scenery *of);
/// Adds the trails as they are now to the frame.
void trail_draw(const trail_set *set, render_frame *frame);
/// Forgets them all.
void trail_free(trail_set *set);

#endif
