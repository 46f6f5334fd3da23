#include "record/replay.h"
void pl_replay_list(plumb_replay *replay, int phase, const pl_image *a, const pl_image *b)
{
    (void)replay;
    (void)phase;
    (void)a;
    (void)b;
}
