// json_wrong.c - what is wrong with a text that cJSON does not take as JSON, and where: cJSON tells
// neither what it expected nor, within strings and numbers, the place. Only the way to an error comes
// here. Cost: O(text), no memory of its own.
#include <string.h>

#include "internal.h"

enum { DEEPEST = 1000 }; // as cJSON, which recurses

typedef struct reader {
    const char *at, *end;
    char open[DEEPEST]; // '{' or '[', outermost first
    int depth;
} reader;

static void skip_space(reader *r)
{
    while (r->at < r->end && (unsigned char)*r->at <= ' ') {
        r->at++;
    }
}

static bool is_digit(const reader *r)
{
    return r->at < r->end && *r->at >= '0' && *r->at <= '9';
}

// Where so many hexadecimal digits stand: their number, else -1.
static int hexadecimal(const char *p, const char *end)
{
    int value = 0;
    for (int i = 0; i < 4; i++) {
        const char *digits = "0123456789abcdef0123456789ABCDEF";
        const char *digit = p + i < end && p[i] != '\0' ? strchr(digits, p[i]) : NULL;
        if (digit == NULL) {
            return -1;
        }
        value = value << 4 | (int)((digit - digits) & 15);
    }
    return value;
}

// The escape at `at`, a backslash. NULL: good, and `at` is behind it.
static const char *read_escape(reader *r)
{
    char kind = r->at + 1 < r->end ? r->at[1] : '\0';
    if (kind != 'u') {
        bool known = kind != '\0' && strchr("\"\\/bfnrt", kind) != NULL;
        r->at += known ? 2 : 0;
        return known ? NULL : "a backslash must be followed by one of \"\\/bfnrtu";
    }
    int unit = hexadecimal(r->at + 2, r->end);
    if (unit < 0) { // cJSON takes it for character 0
        r->at += 2;
        return NULL;
    }
    bool first = unit >= 0xd800 && unit < 0xdc00, second = unit >= 0xdc00 && unit < 0xe000;
    if (first && r->end - r->at >= 12 && r->at[6] == '\\' && r->at[7] == 'u') {
        int low = hexadecimal(r->at + 8, r->end);
        if (low >= 0xdc00 && low < 0xe000) {
            r->at += 12;
            return NULL;
        }
    }
    r->at += first || second ? 0 : 6;
    return first || second ? "half of a surrogate pair stands alone" : NULL;
}

static const char *read_string(reader *r)
{
    const char *start = r->at++;
    while (r->at < r->end && *r->at != '"') {
        const char *wrong = NULL;
        if (*r->at == '\\') {
            wrong = read_escape(r);
        } else {
            r->at++;
        }
        if (wrong != NULL) {
            return wrong;
        }
    }
    if (r->at >= r->end) {
        r->at = start;
        return "this text has no end: a quotation mark is missing";
    }
    r->at++;
    return NULL;
}

static void skip_digits(reader *r)
{
    while (is_digit(r)) {
        r->at++;
    }
}

// A number, or true, false, null.
static const char *read_word(reader *r)
{
    static const char *const words[] = { "true", "false", "null" };
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        size_t length = strlen(words[i]);
        if ((size_t)(r->end - r->at) >= length && memcmp(r->at, words[i], length) == 0) {
            r->at += length;
            return NULL;
        }
    }
    const char *start = r->at;
    r->at += r->at < r->end && *r->at == '-';
    bool good = is_digit(r);
    skip_digits(r);
    if (good && r->at < r->end && *r->at == '.') {
        r->at++;
        skip_digits(r);
    }
    if (good && r->at < r->end && (*r->at == 'e' || *r->at == 'E')) {
        r->at++;
        r->at += r->at < r->end && (*r->at == '+' || *r->at == '-');
        good = is_digit(r);
        skip_digits(r);
    }
    r->at = good ? r->at : start;
    return good ? NULL : "expected a value: a number, \"text\", true, false, [...] or {...}";
}

// The key and the colon that come first in an object.
static const char *read_key(reader *r)
{
    skip_space(r);
    if (r->at >= r->end || *r->at != '"') {
        return "expected a key in quotation marks";
    }
    const char *wrong = read_string(r);
    skip_space(r);
    if (wrong == NULL && (r->at >= r->end || *r->at != ':')) {
        return "expected ':' behind the key";
    }
    r->at += wrong == NULL;
    return wrong;
}

// What follows a value: closes what is complete. *done: that was all.
static const char *read_behind(reader *r, bool *done)
{
    while (r->depth > 0) {
        bool object = r->open[r->depth - 1] == '{';
        skip_space(r);
        if (r->at < r->end && *r->at == ',') {
            r->at++;
            return object ? read_key(r) : NULL;
        }
        if (r->at >= r->end || *r->at != (object ? '}' : ']')) {
            return object ? "expected ',' or '}'" : "expected ',' or ']'";
        }
        r->at++;
        r->depth--;
    }
    *done = true;
    return NULL;
}

// Opens an object or array and goes to its first value; *empty: it has none.
static const char *read_open(reader *r, bool *empty)
{
    if (r->depth == DEEPEST) {
        return "values are nested more than 1000 deep";
    }
    bool object = *r->at == '{';
    r->open[r->depth++] = *r->at++;
    skip_space(r);
    *empty = r->at < r->end && *r->at == (object ? '}' : ']');
    return object && !*empty ? read_key(r) : NULL;
}

const char *sc_json_wrong(const char *text, size_t size, const char **where)
{
    reader r = { .at = text, .end = text + size };
    bool marked = size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0; // byte order mark
    r.at += marked ? 3 : 0;
    const char *wrong = NULL;
    bool done = false;
    while (wrong == NULL && !done) {
        bool empty = false, opened = false;
        skip_space(&r);
        if (r.at < r.end && (*r.at == '{' || *r.at == '[')) {
            opened = true;
            wrong = read_open(&r, &empty);
        } else if (r.at < r.end && *r.at == '"') {
            wrong = read_string(&r);
        } else {
            wrong = read_word(&r);
        }
        if (wrong == NULL && (!opened || empty)) {
            wrong = read_behind(&r, &done);
        }
    }
    *where = r.at;
    bool ends = r.at >= r.end; // nothing at all, or less than was begun
    return wrong == NULL  ? NULL
           : !ends        ? wrong
           : r.depth == 0 ? "the file is empty"
                          : "the file ends here, within an object or array";
}
