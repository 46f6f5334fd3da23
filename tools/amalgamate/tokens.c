// tokens.c - see tokens.h.
#include "amalgamate/tokens.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void give_up(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("amalgamate: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    exit(1);
}

void *grow(void *p, size_t bytes)
{
    void *fresh = realloc(p, bytes);
    if (fresh == NULL) {
        give_up("out of memory");
    }
    return fresh;
}

//---- names ---------------------------------------------------------------------------------------

bool names_have(const names *list, const char *text, size_t length)
{
    for (size_t i = 0; i < list->count; ++i) {
        if (strlen(list->items[i]) == length && memcmp(list->items[i], text, length) == 0) {
            return true;
        }
    }
    return false;
}

void names_add(names *list, const char *text, size_t length)
{
    if (names_have(list, text, length)) {
        return;
    }
    if (list->count == list->room) {
        list->room = list->room == 0 ? 16 : 2 * list->room;
        list->items = grow(list->items, list->room * sizeof *list->items);
    }
    char *copy = grow(NULL, length + 1);
    memcpy(copy, text, length);
    copy[length] = '\0';
    list->items[list->count++] = copy;
}

//---- tokens --------------------------------------------------------------------------------------

bool token_is(const token *t, const char *text)
{
    return t != NULL && strlen(text) == t->length && memcmp(t->text, text, t->length) == 0;
}

const token *token_before(const source *s, size_t i)
{
    while (i-- > 0) {
        if (s->tokens[i].kind != TOKEN_SPACE) {
            return &s->tokens[i];
        }
    }
    return NULL;
}

const token *token_behind(const source *s, size_t i)
{
    for (++i; i < s->count; ++i) {
        if (s->tokens[i].kind != TOKEN_SPACE) {
            return &s->tokens[i];
        }
    }
    return NULL;
}

static size_t quoted(const char *p)
{
    size_t n = 1;
    while (p[n] != p[0] && p[n] != '\0') {
        n += p[n] == '\\' ? 2 : 1;
    }
    return n + 1;
}

static size_t space(const char *p)
{
    if (p[0] == '/' && p[1] == '/') {
        return strcspn(p, "\n");
    }
    if (p[0] == '/' && p[1] == '*') {
        return (size_t)(strstr(p + 2, "*/") - p) + 2;
    }
    return p[0] == '\\' && p[1] == '\n' ? 2 : 1;
}

static token next_token(const char *p)
{
    token t = { .text = p, .length = 1, .kind = TOKEN_MARK };
    if (isspace((unsigned char)p[0]) || (p[0] == '/' && (p[1] == '/' || p[1] == '*')) ||
        (p[0] == '\\' && p[1] == '\n')) {
        t.kind = TOKEN_SPACE;
        t.length = space(p);
    } else if (isalpha((unsigned char)p[0]) || p[0] == '_') {
        t.kind = TOKEN_NAME;
        while (isalnum((unsigned char)p[t.length]) || p[t.length] == '_') {
            ++t.length;
        }
    } else if (isdigit((unsigned char)p[0]) || (p[0] == '.' && isdigit((unsigned char)p[1]))) {
        t.kind = TOKEN_VALUE;
        while (isalnum((unsigned char)p[t.length]) || p[t.length] == '.' ||
               ((p[t.length] == '+' || p[t.length] == '-') &&
                strchr("eEpP", p[t.length - 1]) != NULL)) {
            ++t.length;
        }
    } else if (p[0] == '"' || p[0] == '\'') {
        t.kind = TOKEN_VALUE;
        t.length = quoted(p);
    } else if (strncmp(p, "...", 3) == 0) {
        t.length = 3;
    } else if (strncmp(p, "->", 2) == 0 || strncmp(p, "##", 2) == 0) {
        t.length = 2;
    }
    return t;
}

static void split(source *s)
{
    bool directive = false, line_start = true;
    for (const char *p = s->text; *p != '\0';) {
        token t = next_token(p);
        bool ends_line = t.kind == TOKEN_SPACE && p[0] == '\n';
        if (t.kind != TOKEN_SPACE) {
            directive = directive || (line_start && p[0] == '#');
            line_start = false;
        }
        t.directive = directive;
        if (s->count == s->room) {
            s->room = s->room == 0 ? 4096 : 2 * s->room;
            s->tokens = grow(s->tokens, s->room * sizeof *s->tokens);
        }
        s->tokens[s->count++] = t;
        if (ends_line) {
            directive = false;
            line_start = true;
        }
        p += t.length;
    }
}

static void find_macros(source *s)
{
    for (size_t i = 0; i < s->count; ++i) {
        const token *name = token_behind(s, i);
        if (s->tokens[i].directive && token_is(&s->tokens[i], "define") && name != NULL) {
            names_add(&s->macros, name->text, name->length);
        }
    }
}

// Marks names that belong to a struct and not to the file.
static void find_members(source *s)
{
    bool in_struct[64] = { false };
    int depth = 0;
    bool opens_struct = false; // struct or union was read, its brace was not
    for (size_t i = 0; i < s->count; ++i) {
        token *t = &s->tokens[i];
        const token *before = token_before(s, i), *behind = token_behind(s, i);
        if (t->kind == TOKEN_NAME) {
            bool declarator = in_struct[depth] && behind != NULL && behind->kind == TOKEN_MARK &&
                              strchr(";,[:)", behind->text[0]) != NULL;
            t->member = token_is(before, ".") || token_is(before, "->") || declarator;
            opens_struct = opens_struct || token_is(t, "struct") || token_is(t, "union");
        } else if (t->kind == TOKEN_MARK && t->text[0] == '{') {
            if (++depth == 64) {
                give_up("%s: braces are nested too deep", s->path);
            }
            in_struct[depth] = opens_struct;
            opens_struct = false;
        } else if (t->kind == TOKEN_MARK && t->text[0] == '}' && depth > 0) {
            --depth;
        } else if (t->kind == TOKEN_MARK && strchr(";(),=*", t->text[0]) != NULL) {
            opens_struct = false;
        }
    }
}

void source_read(source *s, const char *path)
{
    *s = (source){ .path = grow(NULL, strlen(path) + 1) };
    memcpy(s->path, path, strlen(path) + 1);
    FILE *file = fopen(path, "rb");
    if (file == NULL || fseek(file, 0, SEEK_END) != 0) {
        give_up("%s cannot be read", path);
    }
    long size = ftell(file);
    rewind(file);
    s->text = grow(NULL, (size_t)size + 1);
    if (size < 0 || fread(s->text, 1, (size_t)size, file) != (size_t)size) {
        give_up("%s cannot be read", path);
    }
    fclose(file);
    s->text[size] = '\0';
    split(s);
    find_macros(s);
    find_members(s);
}

//---- what a file declares ------------------------------------------------------------------------

// The index behind the group that opens at i.
static size_t behind_group(const source *s, size_t i)
{
    int depth = 0;
    for (; i < s->count; ++i) {
        if (s->tokens[i].kind == TOKEN_MARK && !s->tokens[i].directive) {
            depth += strchr("({[", s->tokens[i].text[0]) != NULL;
            depth -= strchr(")}]", s->tokens[i].text[0]) != NULL;
            if (depth == 0) {
                return i + 1;
            }
        }
    }
    return i;
}

static void add_enumerators(source *s, size_t i, size_t end)
{
    for (; i < end; ++i) {
        const token *t = &s->tokens[i], *before = token_before(s, i);
        bool first = token_is(before, "{") || token_is(before, ",") || before->directive;
        bool is_call = token_is(token_behind(s, i), "("); // of a macro that lists enumerators
        if (t->kind == TOKEN_NAME && !t->directive && first && !is_call) {
            names_add(&s->declared, t->text, t->length);
        }
    }
}

// A type with a body that opens at i; `keyword` and `tag` stand before it.
static void add_type(source *s, size_t i, size_t end, const token *keyword, const token *tag)
{
    if (tag != NULL) {
        names_add(&s->declared, tag->text, tag->length);
    }
    if (token_is(keyword, "enum")) {
        add_enumerators(s, i, end);
    }
}

static bool is_type_word(const token *t)
{
    return token_is(t, "struct") || token_is(t, "union") || token_is(t, "enum");
}

// A declaration that begins at i; returns the index behind it.
static size_t declaration(source *s, size_t i, const names *calls)
{
    const token *last = NULL, *word = NULL; // the newest name; struct, union, enum
    const token *tag = NULL;
    bool done = false; // the declared name is known
    while (i < s->count) {
        const token *t = &s->tokens[i];
        if (t->kind == TOKEN_SPACE || t->directive) {
            ++i;
        } else if (t->kind == TOKEN_NAME && token_is(t, "__attribute__")) {
            while (!token_is(&s->tokens[i], "(")) {
                ++i;
            }
            i = behind_group(s, i);
        } else if (t->kind == TOKEN_NAME) {
            if (is_type_word(t)) {
                word = t;
                tag = NULL;
            } else if (word != NULL && tag == NULL) {
                tag = t;
            }
            last = is_type_word(t) ? last : t;
            ++i;
        } else if (t->text[0] == '{' && word != NULL && (last == tag || tag == NULL) && !done) {
            size_t end = behind_group(s, i);
            add_type(s, i, end, word, tag);
            word = NULL;
            i = end;
        } else if (strchr("([={;", t->text[0]) != NULL) {
            if (!done && last != NULL && t->text[0] == '(' &&
                names_have(calls, last->text, last->length)) {
                return behind_group(s, i); // a macro that declares something
            }
            if (!done && last != NULL && t->text[0] != '{') {
                names_add(&s->declared, last->text, last->length);
                done = true;
            }
            if (t->text[0] == ';') {
                return i + 1;
            }
            bool body = t->text[0] == '{' && !token_is(token_before(s, i), "=");
            i = t->text[0] == '=' ? i + 1 : behind_group(s, i);
            if (body) {
                return i;
            }
        } else {
            ++i;
        }
    }
    return i;
}

void source_declare(source *s, const names *calls)
{
    for (size_t i = 0; i < s->count;) {
        i = declaration(s, i, calls);
    }
}
