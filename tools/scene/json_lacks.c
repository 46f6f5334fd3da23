// json_lacks.c - what of a scene its canonical JSON leaves out, in words. Cost: O(handlers and bodies).
#include <stdio.h>

#include "internal.h"

static void append(char *text, size_t size, int *used, const char *before, const char *what)
{
    size_t at = (size_t)*used < size ? (size_t)*used : size;
    int more = snprintf(text + at, size - at, "%s%s", before, what);
    *used += more > 0 ? more : 0;
}

static void append_count(char *text, size_t size, int *used, int count, const char *what)
{
    char number[80];
    if (count > 0) {
        snprintf(number, sizeof number, "%d %s%s", count, what, count == 1 ? "" : "s");
        append(text, size, used, *used > 0 ? ", " : "", number);
    }
}

// The names of the kinds of handlers that can still be called, in parentheses.
static void append_handlers(const scene *s, char *text, size_t size, int *used)
{
    int count = 0, names = 0;
    unsigned told = 0;
    for (int i = 0; i < s->handlers.count; i++) {
        count += !s->handlers.items[i].spent;
    }
    append_count(text, size, used, count, "handler");
    for (int i = 0; i < s->handlers.count; i++) {
        const sc_handler *h = &s->handlers.items[i];
        if (!h->spent && (told >> h->kind & 1u) == 0) {
            told |= 1u << h->kind;
            append(text, size, used, names++ == 0 ? " (" : ", ", sc_handler_name(h->kind));
        }
    }
    append(text, size, used, names > 0 ? ")" : "", "");
}

int scene_json_lacks(const scene *s, char *text, size_t size)
{
    int used = 0, tests = 0, users = 0;
    append(text, size, &used, "", "");
    append_handlers(s, text, size, &used);
    append_count(text, size, &used, s->exact_count, "closed form");
    for (int i = 0; i < s->expects.count; i++) {
        tests += SC_GIVEN(&sc_list_expect, &s->expects.items[i].def, sc_expect_def, test);
    }
    append_count(text, size, &used, tests, "test function");
    for (int i = 0; i < s->bodies.count; i++) {
        users += s->bodies.items[i]->user != LUA_NOREF;
    }
    append_count(text, size, &used, users, "user table");
    append_count(text, size, &used, s->split > 1, "order to split steps");
    return used;
}
