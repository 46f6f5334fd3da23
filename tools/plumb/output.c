/// output.c - what leaves the program: messages, files that appear only when complete, numbers.
///
/// Writes stdout, stderr and files. Every write error is found at the latest when the file is
/// closed: a full disk never looks like success.
#define _XOPEN_SOURCE 700 // realpath, fdopen, poll, strdup

#include "cli.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

void cli_message(const char *format, ...)
{
    va_list list;
    fflush(stdout); // keep the order when both go to one terminal or file
    fputs("plumb: ", stderr);
    va_start(list, format);
    vfprintf(stderr, format, list);
    va_end(list);
    fputc('\n', stderr);
}

/// True when `file` is a pipe whose reader has left (`| head`): that is no failure of ours.
static bool reader_gone(FILE *file)
{
    struct pollfd end = { .fd = fileno(file), .events = POLLOUT };
    return poll(&end, 1, 0) > 0 && (end.revents & (POLLERR | POLLHUP)) != 0;
}

/// Why writing to `file` has failed before: what is still in its buffer fails again. 0: it does not.
static int reason_of(FILE *file)
{
    clearerr(file);
    errno = 0;
    return fflush(file) != 0 ? errno : 0;
}

int cli_finish(int code)
{
    errno = 0;
    bool failed = fflush(stdout) != 0 || ferror(stdout) != 0;
    int reason = errno != 0 || !failed ? errno : reason_of(stdout);
    if (failed && !reader_gone(stdout)) {
        cli_message("cannot write to standard output: %s",
                    reason != 0 ? strerror(reason) : "an earlier write failed");
        return code == CLI_OK ? CLI_FAILED : code;
    }
    return code;
}

/// A new file beside `path`, with the rights a new file has.
static int open_beside(cli_output *out)
{
    size_t size = strlen(out->path) + 32;
    out->temp = malloc(size);
    if (out->temp == NULL) {
        errno = ENOMEM;
        return -1;
    }
    int file = -1;
    // A few names, in case a killed run of the same process id has left one behind.
    for (int attempt = 0; attempt < 10 && file < 0; attempt++) {
        snprintf(out->temp, size, "%s.%ld-%d.tmp", out->path, (long)getpid(), attempt);
        file = open(out->temp, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file < 0 && errno != EEXIST) {
            break;
        }
    }
    return file;
}

// Read by the handler of a signal, hence volatile; `temp` is written last and cleared first.
static struct {
    const char *volatile temp;
    const char *volatile path;
} guarded[8];
enum { GUARDED_MAX = (int)(sizeof guarded / sizeof guarded[0]) };

int cli_output_guard(const char *temp, const char *path)
{
    for (int i = 0; i < GUARDED_MAX; i++) {
        if (guarded[i].temp == NULL) {
            guarded[i].path = path;
            guarded[i].temp = temp;
            return i;
        }
    }
    return -1;
}

void cli_output_unguard(int guard)
{
    if (guard >= 0) {
        guarded[guard].temp = NULL;
    }
}

void cli_output_keep_beginning(cli_output *out)
{
    if (out->temp != NULL && out->guard >= 0) {
        guarded[out->guard].path = out->path;
    }
}

void cli_output_abandon(void)
{
    for (int i = 0; i < GUARDED_MAX; i++) {
        const char *temp = guarded[i].temp, *path = guarded[i].path;
        if (temp != NULL && path != NULL) {
            (void)rename(temp, path);
        } else if (temp != NULL) {
            (void)unlink(temp);
        }
    }
}

static void forget(cli_output *out)
{
    free(out->path);
    free(out->temp);
    *out = (cli_output){ 0 };
}

int cli_output_open(cli_output *out, const char *path)
{
    *out = (cli_output){ .file = stdout, .guard = -1 };
    if (path == NULL || strcmp(path, "-") == 0) {
        return CLI_OK;
    }
    // Through a link to its file, so that the link stays one.
    struct stat info;
    bool exists = stat(path, &info) == 0;
    out->path = cli_resolve(path);
    int file = -1;
    if (out->path != NULL) {
        bool is_plain = !exists || S_ISREG(info.st_mode);
        file = is_plain ? open_beside(out) : open(out->path, O_WRONLY | O_CLOEXEC);
    }
    if (file >= 0) {
        if (exists && out->temp != NULL) {
            (void)fchmod(file, info.st_mode & 07777); // keeps the rights of the file replaced
        }
        out->file = fdopen(file, "w");
    }
    if (file < 0 || out->file == NULL) {
        cli_message("cannot write '%s': %s", path, strerror(errno));
        if (file >= 0) {
            close(file);
            if (out->temp != NULL) {
                unlink(out->temp);
            }
        }
        forget(out);
        return CLI_FAILED;
    }
    out->guard = out->temp != NULL ? cli_output_guard(out->temp, NULL) : -1;
    return CLI_OK;
}

bool cli_output_good(const cli_output *out)
{
    return ferror(out->file) == 0;
}

int cli_output_close(cli_output *out, bool keep)
{
    if (out->path == NULL) {
        return CLI_OK; // stdout: cli_finish looks at it
    }
    errno = 0;
    bool failed = fflush(out->file) != 0 || ferror(out->file) != 0;
    int reason = errno != 0 || !failed ? errno : reason_of(out->file);
    reason = reason != 0 ? reason : out->reason;
    bool gone = failed && reader_gone(out->file);
    if (fclose(out->file) != 0 && !failed) {
        failed = true;
        reason = errno;
    }
    cli_output_unguard(out->guard);
    if (out->temp != NULL) {
        if (failed || !keep) {
            unlink(out->temp);
        } else if (rename(out->temp, out->path) != 0) {
            failed = true;
            reason = errno;
            unlink(out->temp);
        }
    }
    if (failed && !gone) {
        cli_message("cannot write '%s': %s", out->path,
                    reason != 0 ? strerror(reason) : "an earlier write failed");
    }
    forget(out);
    return failed && !gone ? CLI_FAILED : CLI_OK;
}

void cli_print_number(FILE *file, double value, bool is_float)
{
    char text[40];
    // FLT_DIG = 6 and DBL_DIG = 15 digits survive the way into a binary number and back, 9 and
    // 17 tell all binary numbers apart (C17 5.2.4.2.2), so the shortest lies between.
    int digits = is_float ? 6 : 15, most = is_float ? 9 : 17;
    for (;; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (digits == most ||
            (is_float ? strtof(text, NULL) == (float)value : strtod(text, NULL) == value)) {
            break;
        }
    }
    fputs(text, file);
}

void cli_print_csv(FILE *file, const char *text)
{
    if (text[strcspn(text, ",\"\r\n")] == '\0') {
        fputs(text, file);
        return;
    }
    fputc('"', file);
    for (; *text != '\0'; text++) {
        if (*text == '"') {
            fputc('"', file);
        }
        fputc(*text, file);
    }
    fputc('"', file);
}

void cli_print_json(FILE *file, const char *text)
{
    fputc('"', file);
    for (; *text != '\0'; text++) {
        unsigned char c = (unsigned char)*text;
        if (c == '"' || c == '\\') {
            fputc('\\', file);
            fputc(c, file);
        } else if (c < 0x20 || c == 0x7f) {
            fprintf(file, "\\u%04x", (unsigned)c);
        } else {
            fputc(c, file);
        }
    }
    fputc('"', file);
}
