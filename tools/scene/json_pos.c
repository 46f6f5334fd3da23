// json_pos.c - where in a JSON text a value stands: cJSON does not keep positions, so the path of
// the value ("bodies[3].shapes[0]") is walked again. Only the way to an error comes here. Cost:
// O(text). The text has been accepted by cJSON before, so the walk need not check it.
#include <stdlib.h>
#include <string.h>

#include "internal.h"

static const char *skip_space(const char *p, const char *end)
{
    while (p < end && (unsigned char)*p <= ' ') {
        p++;
    }
    return p;
}

static const char *skip_string(const char *p, const char *end)
{
    for (p++; p < end && *p != '"'; p++) {
        p += *p == '\\' && p + 1 < end;
    }
    return p < end ? p + 1 : end;
}

static const char *skip_value(const char *p, const char *end)
{
    int depth = 0;
    do {
        p = skip_space(p, end);
        if (p >= end) {
            return end;
        }
        if (*p == '"') {
            p = skip_string(p, end);
        } else if (*p == '{' || *p == '[') {
            depth++;
            p++;
        } else if (*p == '}' || *p == ']') {
            depth--;
            p++;
        } else if (*p == ',' || *p == ':') {
            p++;
        } else {
            while (p < end && strchr(",:{}[]\" \t\r\n", *p) == NULL) {
                p++;
            }
        }
    } while (depth > 0);
    return p;
}

// The key (or, for arrays, the value) of member `name` or element `index` of the value at p; null
// if none.
static const char *find_member(const char *p, const char *end, const char *name, size_t length,
                               int index)
{
    p = skip_space(p, end);
    if (p >= end || (*p != '{' && *p != '[')) {
        return NULL;
    }
    bool is_object = *p == '{';
    p = skip_space(p + 1, end);
    for (int i = 0; p < end && *p != '}' && *p != ']'; i++) {
        const char *start = p;
        if (is_object) {
            p = skip_string(p, end);
            if (name != NULL && (size_t)(p - start) == length + 2 &&
                memcmp(start + 1, name, length) == 0) {
                return start;
            }
            p = skip_space(p, end);
            p += p < end && *p == ':';
        } else if (name == NULL && i == index) {
            return start;
        }
        p = skip_space(skip_value(p, end), end);
        p = skip_space(p + (p < end && *p == ','), end);
    }
    return NULL;
}

// From a key to its value; elements of arrays are values already.
static const char *value_of(const char *p, const char *end, bool is_key)
{
    if (!is_key) {
        return p;
    }
    p = skip_space(skip_string(p, end), end);
    return skip_space(p + (p < end && *p == ':'), end);
}

void sc_json_position(const char *text, size_t size, const char *path, const char *key, int index,
                      int *line, int *column)
{
    const char *end = text + size;
    const char *p = skip_space(text, end);
    while (*path != 0) {
        const char *next;
        if (*path == '[') {
            char *rest;
            next = find_member(p, end, NULL, 0, (int)strtol(path + 1, &rest, 10));
            path = rest + 1;
        } else {
            path += *path == '.';
            size_t length = strcspn(path, ".[");
            next = find_member(p, end, path, length, 0);
            next = next == NULL ? NULL : value_of(next, end, true);
            path += length;
        }
        if (next == NULL) {
            break;
        }
        p = next;
    }
    const char *member = key != NULL ? find_member(p, end, key, strlen(key), 0) : NULL;
    if (index > 0) { // elements by position are those of the member "points" or "shapes"
        const char *list = find_member(p, end, "points", 6, 0);
        list = list != NULL ? list : find_member(p, end, "shapes", 6, 0);
        member =
            list != NULL ? find_member(value_of(list, end, true), end, NULL, 0, index - 1) : member;
    }
    p = member != NULL ? member : p;
    *line = 1;
    *column = 1;
    for (const char *q = text; q < p; q++) {
        *column = *q == '\n' ? 1 : *column + 1;
        *line += *q == '\n';
    }
}
