// amalgamate.c - writes the library as one header and one source file.
//
//     amalgamate OUT-FOLDER LICENSE include/plumb/plumb.h src/.../*.c src/.../*.simd.c
//
// plumb.h: the public headers, each where it is first included. plumb.c: the internal headers likewise,
// then the sources one after another. Their file-static names may clash there: a name that several files
// declare is given the file's name in front. Macros of a source end with it.
//
// Sources X.simd.c, and the headers that only they include (those that say PL_WIDTH), come once for
// each width, with all their names changed by macros, so that what the preprocessor puts together
// changes too; names that are members somewhere are changed in the text instead. What the build asks for
// by flags is asked for by pragmas.
//
// It knows as much of C as the sources use; what it gets wrong does not compile, and
// tests/api/test_amalgamation.sh compiles it.
#include "amalgamate/tokens.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SOURCES_MOST 1024

static source sources[SOURCES_MOST]; // headers too, in order of reading
static int source_count;
static names members, calls, taken; // of all files: members of structs, macros, all names
static names emitted;               // headers that were written, system headers too

//---- files ---------------------------------------------------------------------------------------

static bool ends_with(const char *text, const char *end)
{
    size_t a = strlen(text), b = strlen(end);
    return a >= b && strcmp(text + a - b, end) == 0;
}

static bool exists(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (file != NULL) {
        fclose(file);
    }
    return file != NULL;
}

static source *known(const char *path)
{
    for (int i = 0; i < source_count; ++i) {
        if (strcmp(sources[i].path, path) == 0) {
            return &sources[i];
        }
    }
    return NULL;
}

// What a directive at token i includes; "" for none. <x> keeps its brackets.
static void included(const source *s, size_t i, char *path, size_t size)
{
    path[0] = '\0';
    const token *word = token_behind(s, i);
    if (!s->tokens[i].directive || !token_is(&s->tokens[i], "#") || !token_is(word, "include")) {
        return;
    }
    const char *from = word->text + word->length + strspn(word->text + word->length, " \t");
    size_t length = strcspn(from, "\n");
    while (length > 0 && (from[length - 1] == ' ' || from[length - 1] == '\r')) {
        --length;
    }
    const char *note = memchr(from, '/', length) == NULL ? NULL : strstr(from, " //");
    length = note != NULL && note < from + length ? (size_t)(note - from) : length;
    if (from[0] == '<') {
        snprintf(path, size, "%.*s", (int)length, from);
        return;
    }
    const char *const roots[] = { "include/", "src/" };
    for (int k = 0; k < 2; ++k) {
        snprintf(path, size, "%s%.*s", roots[k], (int)length - 2, from + 1);
        if (exists(path)) {
            return;
        }
    }
    give_up("%s: %.*s is not to be found", s->path, (int)length, from);
}

// Reads a file and all that it includes, headers first.
static source *read_all(const char *path)
{
    source *s = known(path);
    if (s != NULL) {
        return s;
    }
    if (source_count == SOURCES_MOST) {
        give_up("more than %d files", SOURCES_MOST);
    }
    s = &sources[source_count++];
    source_read(s, path);
    for (size_t i = 0; i < s->count; ++i) {
        char header[256];
        included(s, i, header, sizeof header);
        if (header[0] != '\0' && header[0] != '<') {
            read_all(header);
        }
        const token *t = &s->tokens[i];
        if (t->kind == TOKEN_NAME) {
            names_add(&taken, t->text, t->length);
            if (t->member) {
                names_add(&members, t->text, t->length);
                names_add(&s->members, t->text, t->length);
            }
        }
    }
    for (size_t i = 0; i < s->macros.count; ++i) {
        names_add(&calls, s->macros.items[i], strlen(s->macros.items[i]));
    }
    return s;
}

// The first macro of a header is its include guard: of two headers with one guard, only one would count.
static void check_guards(void)
{
    for (int i = 0; i < source_count; ++i) {
        for (int k = 0; k < i; ++k) {
            const source *a = &sources[k], *b = &sources[i];
            if (ends_with(a->path, ".h") && ends_with(b->path, ".h") && a->macros.count > 0 &&
                b->macros.count > 0 && strcmp(a->macros.items[0], b->macros.items[0]) == 0) {
                give_up("%s and %s have one include guard, %s", a->path, b->path,
                        a->macros.items[0]);
            }
        }
    }
}

// A header that is compiled once for each width.
static bool is_wide(const source *s)
{
    for (size_t i = 0; i < s->count; ++i) {
        char header[256];
        included(s, i, header, sizeof header);
        if (token_is(&s->tokens[i], "PL_WIDTH") ||
            (ends_with(header, ".h") && is_wide(read_all(header)))) {
            return true;
        }
    }
    return false;
}

//---- names ---------------------------------------------------------------------------------------

// The name of a file as part of a name: src/world/rows.c gives world_rows.
static void stem_of(const char *path, char *stem, size_t size)
{
    const char *name = strrchr(path, '/') == NULL ? path : strrchr(path, '/') + 1;
    const char *folder = name;
    while (folder > path && (folder == name || folder[-1] != '/')) {
        --folder;
    }
    int length = name > folder ? (int)(name - folder - 1) : 0;
    snprintf(stem, size, "%.*s%s%.*s", length, folder, length > 0 ? "_" : "",
             (int)strcspn(name, "."), name);
}

static bool is_public(const char *name)
{
    return strncmp(name, "pl_", 3) == 0 || strncmp(name, "plumb_", 6) == 0 ||
           strncmp(name, "PL_", 3) == 0 || strncmp(name, "PLUMB_", 6) == 0 || name[0] == '_';
}

// Some other file declares the name, or defines it as a macro.
static bool clashes(const source *s, const char *name)
{
    for (int i = 0; i < source_count; ++i) {
        if (&sources[i] != s && (names_have(&sources[i].declared, name, strlen(name)) ||
                                 names_have(&sources[i].macros, name, strlen(name)))) {
            return true;
        }
    }
    return false;
}

typedef struct change {
    const char *from;
    char to[128];
    bool in_text; // else by a macro
} change;

typedef struct changes {
    change items[512];
    size_t count;
} changes;

static void change_name(changes *c, const source *s, const char *name, int width)
{
    char stem[64], ending[16] = "";
    change *item = &c->items[c->count++];
    if (c->count == sizeof c->items / sizeof c->items[0]) {
        give_up("%s declares too many names", s->path);
    }
    stem_of(s->path, stem, sizeof stem);
    if (width > 0) {
        snprintf(ending, sizeof ending, "_w%d", width);
    }
    item->from = name;
    if (clashes(s, name)) {
        snprintf(item->to, sizeof item->to, "%s_%s%s", stem, name, ending);
    } else {
        snprintf(item->to, sizeof item->to, "%s%s", name, ending);
    }
    if (names_have(&taken, item->to, strlen(item->to))) {
        give_up("%s: '%s' would become '%s', which is taken: choose another name", s->path, name,
                item->to);
    }
}

// Names of a file that cannot stay as they are. A macro would also change members of that name: of a
// source per width, where the macros end with it, those that it names; of a header, all there are.
static void find_changes(changes *c, const source *s, int width)
{
    const names *others = ends_with(s->path, ".c") ? &s->members : &members;
    c->count = 0;
    for (size_t i = 0; i < s->declared.count; ++i) {
        const char *name = s->declared.items[i];
        if (!is_public(name) && (width > 0 || clashes(s, name))) {
            change_name(c, s, name, width);
            c->items[c->count - 1].in_text = width == 0 || names_have(others, name, strlen(name));
        }
    }
}

// Headers per width that the present source includes, and their changes: macros end with the source.
static names active;
static changes wide;

static const change *change_of(const changes *c, const token *t)
{
    for (size_t i = 0; i < c->count; ++i) {
        if (token_is(t, c->items[i].from)) {
            return &c->items[i];
        }
    }
    return c == &wide ? NULL : change_of(&wide, t);
}

//---- writing -------------------------------------------------------------------------------------

static void emit(FILE *out, const source *s, const changes *c, int width);

static void emit_macros(FILE *out, const changes *c, bool define)
{
    for (size_t i = 0; i < c->count; ++i) {
        if (!c->items[i].in_text) {
            fprintf(out, define ? "#define %s %s\n" : "#undef %s\n", c->items[i].from,
                    c->items[i].to);
        }
    }
}

static void emit_undefs(FILE *out, const source *s)
{
    for (size_t i = 0; i < s->macros.count; ++i) {
        fprintf(out, "#undef %s\n", s->macros.items[i]);
    }
}

static void emit_header(FILE *out, const char *path, int width);

// What a header includes, where its own text is written already.
static void activate_included(FILE *out, const source *s, int width)
{
    for (size_t i = 0; i < s->count; ++i) {
        char header[256];
        included(s, i, header, sizeof header);
        if (ends_with(header, ".h")) {
            emit_header(out, header, width);
        }
    }
}

// A header per width: its text once a width, its names for each source that includes it.
static void emit_wide_header(FILE *out, source *header, int width)
{
    const char *path = header->path;
    if (names_have(&active, path, strlen(path))) {
        return;
    }
    names_add(&active, path, strlen(path));
    bool written = names_have(&emitted, path, strlen(path));
    names_add(&emitted, path, strlen(path));
    changes *c = grow(NULL, sizeof *c);
    find_changes(c, header, width);
    emit_macros(out, c, true);
    if (written) {
        activate_included(out, header, width);
    } else {
        emit(out, header, c, width);
    }
    for (size_t i = 0; i < c->count; ++i) {
        wide.items[wide.count++] = c->items[i];
    }
    free(c);
}

// A header that was not yet written, or nothing.
static void emit_header(FILE *out, const char *path, int width)
{
    source *header = path[0] == '<' ? NULL : read_all(path);
    if (header != NULL && is_wide(header)) {
        emit_wide_header(out, header, width);
        return;
    }
    if (names_have(&emitted, path, strlen(path))) {
        return;
    }
    names_add(&emitted, path, strlen(path));
    if (header == NULL) {
        fprintf(out, "#include %s\n", path);
        return;
    }
    changes *c = grow(NULL, sizeof *c);
    find_changes(c, header, 0);
    if (c->count > 0) {
        give_up("%s: '%s' is also declared elsewhere", path, c->items[0].from);
    }
    emit(out, header, c, width);
    free(c);
}

static void emit(FILE *out, const source *s, const changes *c, int width)
{
    for (size_t i = 0; i < s->count; ++i) {
        const token *t = &s->tokens[i];
        char header[256];
        included(s, i, header, sizeof header);
        if (header[0] != '\0') {
            emit_header(out, header, width);
            while (i + 1 < s->count && s->tokens[i + 1].text[0] != '\n') {
                ++i;
            }
            continue;
        }
        const change *to = t->kind == TOKEN_NAME && !t->member ? change_of(c, t) : NULL;
        if (to != NULL && to->in_text) {
            fputs(to->to, out);
        } else {
            fwrite(t->text, 1, t->length, out);
        }
    }
}

static void emit_source(FILE *out, const char *path, int width)
{
    source *s = read_all(path);
    changes *c = grow(NULL, sizeof *c);
    find_changes(c, s, width);
    fprintf(out, "\n//================ %s ================\n", path);
    if (width > 0) {
        emit_macros(out, c, true);
    }
    emit(out, s, c, width);
    emit_undefs(out, s);
    if (width > 0) {
        emit_macros(out, c, false);
        emit_macros(out, &wide, false);
        wide.count = active.count = 0;
    }
    free(c);
}

static void emit_license(FILE *out, const char *path)
{
    source license;
    source_read(&license, path);
    fputs("/*\n", out);
    fputs(license.text, out);
    fputs("*/\n", out);
}

// Pragmas come before the first header, whose inline functions need them as well.
static const char prologue[] =
    "// Plumb as one file: `make amalgamation` wrote it. Compile it as C17 (-std=c17 or gnu17) "
    "together\n"
    "// with plumb.h; link -lm -lpthread. -O3 -fno-math-errno -fno-trapping-math make it faster "
    "and\n"
    "// change no result; -ffast-math does and is refused. -march is of no use: the number of "
    "lanes is\n"
    "// chosen when a world is made.\n"
    "#if defined(__FAST_MATH__)\n"
    "#error \"Plumb needs IEEE arithmetic: compile this file without -ffast-math\"\n"
    "#endif\n"
    "#if defined(__clang__)\n"
    "#pragma STDC FP_CONTRACT OFF\n"
    "#pragma clang diagnostic ignored \"-Wunused-function\"\n"
    "#if __has_warning(\"-Wpsabi\")\n"
    "#pragma clang diagnostic ignored \"-Wpsabi\"\n"
    "#endif\n"
    "#elif defined(__GNUC__)\n"
    "#pragma GCC optimize(\"fp-contract=off\", \"no-math-errno\", \"no-trapping-math\")\n"
    "#pragma GCC diagnostic ignored \"-Wpsabi\"\n"
    "#pragma GCC diagnostic ignored \"-Wunused-function\"\n"
    "#if defined(__x86_64__)\n"
    "#pragma GCC target(\"arch=x86-64\", \"no-fma\") // or else GCC 12 makes fused instructions "
    "all the same\n"
    "#endif\n"
    "#else\n"
    "#error \"Plumb needs GCC or Clang (vector extensions)\"\n"
    "#endif\n"
    "#define _POSIX_C_SOURCE 200809L\n"
    "#define PL_AMALGAMATED\n"
    "#if defined(_WIN32)\n"
    "#define __USE_MINGW_ANSI_STDIO 1 // %zu\n"
    "#endif\n"
    "#include \"plumb.h\"\n";

// The flags that the Makefile gives to files of a width.
static void emit_target(FILE *out, int width)
{
    const char *const target = width == 8 ? "avx2" : "avx512f,avx512vl,avx512dq,avx512bw";
    fprintf(out,
            "#if defined(__x86_64__)\n"
            "#if defined(__clang__)\n"
            "#pragma clang attribute push(__attribute__((target(\"%s\"))), apply_to = function)\n"
            "#else\n"
            "#pragma GCC push_options\n"
            "#pragma GCC target(\"%s\")\n"
            "#endif\n"
            "#endif\n",
            target, target);
}

static void emit_target_end(FILE *out)
{
    fputs("#if defined(__x86_64__)\n"
          "#if defined(__clang__)\n"
          "#pragma clang attribute pop\n"
          "#else\n"
          "#pragma GCC pop_options\n"
          "#endif\n"
          "#endif\n",
          out);
}

// All sources of a width with the headers that go with them.
static void emit_width(FILE *out, char **paths, int count, int width)
{
    names before = emitted;
    fprintf(out,
            "\n//================ registers of %d floats ================\n#define PL_SIMD %d\n",
            width, width);
    if (width > 4) {
        emit_target(out, width);
    }
    for (int i = 0; i < count; ++i) {
        if (ends_with(paths[i], ".simd.c")) {
            emit_source(out, paths[i], width);
        }
    }
    if (width > 4) {
        emit_target_end(out);
    }
    for (size_t k = before.count; k < emitted.count; ++k) {
        source *header = known(emitted.items[k]);
        if (header == NULL || !is_wide(header)) {
            give_up("%s: include it in a source that is not compiled per width, too",
                    emitted.items[k]);
        }
        emit_undefs(out, header);
    }
    emitted.count = before.count; // the next width has them again
    fputs("#undef PL_SIMD\n", out);
}

static FILE *open_output(const char *folder, const char *name)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    if (file == NULL) {
        give_up("%s cannot be written", path);
    }
    return file;
}

static void close_output(FILE *file, const char *name)
{
    bool failed = ferror(file) != 0;
    if (fclose(file) != 0 || failed) {
        give_up("%s could not be written", name);
    }
}

int main(int argc, char **argv)
{
    if (argc < 5) {
        give_up("usage: amalgamate OUT-FOLDER LICENSE PUBLIC-HEADER SOURCES...");
    }
    char **paths = argv + 4;
    int count = argc - 4;
    read_all(argv[3]);
    for (int i = 0; i < count; ++i) {
        read_all(paths[i]);
    }
    check_guards();
    for (int i = 0; i < source_count; ++i) {
        source_declare(&sources[i], &calls);
    }

    FILE *out = open_output(argv[1], "plumb.h");
    emit_license(out, argv[2]);
    emit_header(out, argv[3], 0);
    close_output(out, "plumb.h");

    out = open_output(argv[1], "plumb.c");
    emit_license(out, argv[2]);
    fputs(prologue, out);
    for (int i = 0; i < count; ++i) {
        if (!ends_with(paths[i], ".simd.c")) {
            emit_source(out, paths[i], 0);
        }
    }
    for (int width = 4; width <= 16; width *= 2) {
        emit_width(out, paths, count, width);
    }
    close_output(out, "plumb.c");
    return 0;
}
