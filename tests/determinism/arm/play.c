// play.c - for test_arm.sh: replays recordings step by step. Each step says whether it gave the bits that were recorded.
#include "plumb.h"

#include <stdio.h>
#include <stdlib.h>

static char *content(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL || fseek(file, 0, SEEK_END) != 0) {
        return NULL;
    }
    const long length = ftell(file);
    char *bytes = length > 0 ? malloc((size_t)length) : NULL;
    rewind(file);
    *size = bytes != NULL ? fread(bytes, 1, (size_t)length, file) : 0;
    fclose(file);
    return bytes;
}

// Steps that gave the recorded bits; -1: no recording, or one did not.
static long play(const char *path)
{
    size_t size = 0;
    char *bytes = content(path, &size);
    plumb_replay *replay = NULL;
    if (bytes == NULL || plumb_replay_open(bytes, size, NULL, &replay) != PLUMB_OK) {
        free(bytes);
        return -1;
    }
    plumb_result result = PLUMB_OK;
    long steps = 0;
    while ((result = plumb_replay_step(replay)) == PLUMB_OK) {
        ++steps;
    }
    if (result != PLUMB_E_MISSING) { // the end
        printf("%s: step %ld: %s\n", path, steps + 1, plumb_replay_error(replay));
        steps = -1;
    }
    plumb_replay_close(replay);
    free(bytes);
    return steps;
}

int main(int argc, char **argv)
{
    int bad = 0;
    for (int i = 1; i < argc; ++i) {
        const long steps = play(argv[i]);
        printf("%s: %ld steps\n", argv[i], steps);
        bad += steps <= 0;
    }
    return bad > 0 || argc < 2;
}
