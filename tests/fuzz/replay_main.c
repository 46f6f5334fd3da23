// replay_main.c - a main for the fuzz harnesses without libFuzzer: runs every file named on the
// command line, and every file of the folders named there, in sorted order. A crash is the failure.
#define _POSIX_C_SOURCE 200809L // scandir
#include <dirent.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int run_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    long size = -1;
    if (file != NULL && fseek(file, 0, SEEK_END) == 0) {
        size = ftell(file);
    }
    uint8_t *data = size >= 0 ? malloc((size_t)size + 1) : NULL;
    bool read = data != NULL && fseek(file, 0, SEEK_SET) == 0 &&
                fread(data, 1, (size_t)size, file) == (size_t)size;
    if (read) {
        printf("%s\n", path);
        fflush(stdout); // the last line names the culprit of a crash
        LLVMFuzzerTestOneInput(data, (size_t)size);
    } else {
        fprintf(stderr, "%s: cannot be read\n", path);
    }
    free(data);
    if (file != NULL) {
        fclose(file);
    }
    return read ? 0 : 1;
}

static int run_folder(const char *path, struct dirent **entries, int count)
{
    int failures = 0;
    for (int i = 0; i < count; i++) {
        char name[4096];
        if (entries[i]->d_name[0] != '.') {
            snprintf(name, sizeof name, "%s/%s", path, entries[i]->d_name);
            failures += run_file(name);
        }
        free(entries[i]);
    }
    free(entries);
    return failures;
}

int main(int count, char **arguments)
{
    int failures = 0;
    for (int i = 1; i < count; i++) {
        struct dirent **entries;
        int found = scandir(arguments[i], &entries, NULL, alphasort);
        failures += found >= 0 ? run_folder(arguments[i], entries, found) : run_file(arguments[i]);
    }
    return failures == 0 ? 0 : 1;
}
