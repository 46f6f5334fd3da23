/// files.c - which names of a command line are one file.
#define _XOPEN_SOURCE 700 // realpath, readlink, strdup

#include "cli.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LINKS_MAX = 40, NAME_MAX_SIZE = 4096 }; // links: as many as Linux follows

/// `name` as seen from the folder that holds `link`; new memory.
static char *beside(const char *link, const char *name)
{
    const char *slash = strrchr(link, '/');
    size_t folder = name[0] == '/' || slash == NULL ? 0 : (size_t)(slash - link) + 1;
    char *full = malloc(folder + strlen(name) + 1);
    if (full != NULL) {
        memcpy(full, link, folder);
        memcpy(full + folder, name, strlen(name) + 1);
    }
    return full;
}

/// The name in its real folder, which must be there; new memory.
static char *place(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *base = slash != NULL ? slash + 1 : path;
    char *folder = strdup(slash != NULL ? path : "./");
    if (folder == NULL) {
        return NULL;
    }
    folder[slash != NULL ? slash - path + 1 : 2] = '\0';
    char *real = realpath(folder, NULL);
    free(folder);
    char *full = real != NULL ? malloc(strlen(real) + strlen(base) + 2) : NULL;
    if (full != NULL) {
        snprintf(full, strlen(real) + strlen(base) + 2, "%s/%s", real, base);
    }
    free(real);
    return full;
}

bool cli_is_link(const char *path)
{
    char target[1];
    return readlink(path, target, sizeof target) > 0;
}

char *cli_resolve(const char *path)
{
    char *real = realpath(path, NULL);
    if (real != NULL || errno != ENOENT) {
        return real;
    }
    // The file is not there. Its folder may be, or a link that leads to where it would be.
    char *name = strdup(path), target[NAME_MAX_SIZE];
    for (int i = 0; name != NULL && i < LINKS_MAX; i++) {
        ssize_t length = readlink(name, target, sizeof target - 1);
        if (length <= 0) {
            break;
        }
        target[length] = '\0';
        char *next = beside(name, target);
        free(name);
        name = next;
    }
    real = name != NULL ? place(name) : NULL;
    free(name);
    return real;
}

/// True when both are one plain file, there or not there yet.
static bool is_same_file(const cli_file *a, const cli_file *b)
{
    struct stat first, second;
    bool has_first = strcmp(a->path, "-") == 0 ? fstat(1, &first) == 0 : stat(a->path, &first) == 0;
    bool has_second =
        strcmp(b->path, "-") == 0 ? fstat(1, &second) == 0 : stat(b->path, &second) == 0;
    if (has_first && has_second) {
        return S_ISREG(first.st_mode) && first.st_dev == second.st_dev &&
               first.st_ino == second.st_ino;
    }
    if (has_first || has_second) {
        return false;
    }
    char *one = cli_resolve(a->path), *other = cli_resolve(b->path);
    bool same = one != NULL && other != NULL && strcmp(one, other) == 0;
    free(one);
    free(other);
    return same;
}

int cli_files_check(const cli_command *command, const cli_file *files, int count)
{
    for (int i = 0; i < count; i++) {
        if (files[i].path != NULL && files[i].path[0] == '\0') {
            cli_message("%s: %s: the name of the file is empty", command->name, files[i].what);
            return CLI_USAGE;
        }
        for (int k = 0; k < i; k++) {
            const cli_file *a = &files[k], *b = &files[i];
            if (a->path != NULL && b->path != NULL && (a->is_written || b->is_written) &&
                is_same_file(a, b)) {
                cli_message("%s: %s and %s are one file, '%.200s'", command->name, a->what, b->what,
                            strcmp(b->path, "-") == 0 ? a->path : b->path);
                return CLI_USAGE;
            }
        }
    }
    return CLI_OK;
}
