// source_pos.c - where in the Lua text a message points: Lua itself only knows lines.
// A small tokenizer of Lua (comments, strings, long brackets, names, numbers, signs); then the
// construct is looked up on the line of its call, and the key or element within its braces. Only
// the way to an error comes here. Cost: O(text). Columns count bytes from 1.
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"

typedef enum token_kind { TOKEN_NAME, TOKEN_NUMBER, TOKEN_STRING, TOKEN_SIGN } token_kind;

typedef struct token {
    token_kind kind;
    size_t start, length; ///< [B] in the text
    int line, column;
} token;

typedef struct tokens {
    const char *text;
    size_t size;
    token *items;
    int count, capacity;
} tokens;

/// The place of the scanner.
typedef struct cursor {
    const char *text;
    size_t size, at, line_start;
    int line;
} cursor;

static int peek(const cursor *c, size_t ahead)
{
    return c->at + ahead < c->size ? (unsigned char)c->text[c->at + ahead] : 0;
}

static void advance(cursor *c)
{
    if (c->text[c->at] == '\n') {
        c->line++;
        c->line_start = c->at + 1;
    }
    c->at++;
}

// Skips a long bracket [[...]] or [=[...]=]; false if none stands here.
static bool skip_long(cursor *c)
{
    size_t level = 0;
    while (peek(c, 1 + level) == '=') {
        level++;
    }
    if (peek(c, 0) != '[' || peek(c, 1 + level) != '[') {
        return false;
    }
    while (c->at < c->size) {
        if (c->text[c->at] == ']') {
            size_t n = 0;
            while (peek(c, 1 + n) == '=') {
                n++;
            }
            if (n == level && peek(c, 1 + n) == ']') {
                c->at += level + 2;
                return true;
            }
        }
        advance(c);
    }
    return true;
}

static void skip_blank(cursor *c)
{
    for (;;) {
        if (c->at < c->size && isspace((unsigned char)c->text[c->at])) {
            advance(c);
        } else if (peek(c, 0) == '-' && peek(c, 1) == '-') {
            c->at += 2;
            if (!(peek(c, 0) == '[' && skip_long(c))) {
                while (c->at < c->size && c->text[c->at] != '\n') {
                    advance(c);
                }
            }
        } else {
            return;
        }
    }
}

static void skip_string(cursor *c)
{
    int quote = peek(c, 0);
    advance(c);
    while (c->at < c->size && peek(c, 0) != quote && peek(c, 0) != '\n') {
        if (peek(c, 0) == '\\' && c->at + 1 < c->size) {
            advance(c);
        }
        advance(c);
    }
    if (peek(c, 0) == quote) {
        advance(c);
    }
}

static bool next_token(cursor *c, token *t)
{
    skip_blank(c);
    if (c->at >= c->size) {
        return false;
    }
    *t = (token){ .start = c->at, .line = c->line, .column = (int)(c->at - c->line_start) + 1 };
    int ch = peek(c, 0);
    if (isalpha(ch) || ch == '_') {
        t->kind = TOKEN_NAME;
        while (isalnum(peek(c, 0)) || peek(c, 0) == '_') {
            c->at++;
        }
    } else if (isdigit(ch) || (ch == '.' && isdigit(peek(c, 1)))) {
        t->kind = TOKEN_NUMBER;
        int last = 0;
        while (isalnum(peek(c, 0)) || peek(c, 0) == '.' ||
               ((peek(c, 0) == '-' || peek(c, 0) == '+') && (last == 'e' || last == 'E'))) {
            last = peek(c, 0);
            c->at++;
        }
    } else if (ch == '"' || ch == '\'') {
        t->kind = TOKEN_STRING;
        skip_string(c);
    } else if (ch == '[' && skip_long(c)) {
        t->kind = TOKEN_STRING;
    } else {
        static const char *const longer[] = { "...", "..", "==", "~=", "<=",
                                              ">=",  "//", "::", "<<", ">>" };
        t->kind = TOKEN_SIGN;
        size_t length = 1;
        for (size_t i = 0; i < sizeof longer / sizeof *longer && length == 1; i++) {
            size_t n = strlen(longer[i]);
            if (c->size - c->at >= n && memcmp(c->text + c->at, longer[i], n) == 0) {
                length = n;
            }
        }
        c->at += length;
    }
    t->length = c->at - t->start;
    return true;
}

// All tokens; without memory as many as there was room for.
static tokens tokenize(const char *text, size_t size)
{
    tokens list = { .text = text, .size = size };
    cursor c = { .text = text, .size = size, .line = 1 };
    token t;
    while (next_token(&c, &t)) {
        if (list.count == list.capacity) {
            int capacity = list.capacity == 0 ? 256 : 2 * list.capacity;
            token *items = realloc(list.items, (size_t)capacity * sizeof *items);
            if (items == NULL) {
                break;
            }
            list.items = items;
            list.capacity = capacity;
        }
        list.items[list.count++] = t;
    }
    return list;
}

static bool is_text(const tokens *list, int i, const char *text)
{
    return i >= 0 && i < list->count && list->items[i].length == strlen(text) &&
           memcmp(list->text + list->items[i].start, text, list->items[i].length) == 0;
}

static bool opens(const tokens *list, int i)
{
    return is_text(list, i, "{") || is_text(list, i, "(") || is_text(list, i, "[");
}

static bool closes(const tokens *list, int i)
{
    return is_text(list, i, "}") || is_text(list, i, ")") || is_text(list, i, "]");
}

// First token of element `index` or of `key =` directly inside the bracket that opens at token
// `open`; -1 if it is not there.
static int find_member(const tokens *list, int open, const char *key, int index)
{
    int depth = 0;
    int element = 0;
    int blocks = 0; // function ... end inside: their commas and '=' are not the table's
    for (int i = open; i < list->count; i++) {
        bool at_start = depth == 1 && blocks == 0 && i > open &&
                        (i == open + 1 || is_text(list, i - 1, ",") || is_text(list, i - 1, ";"));
        if (at_start && !closes(list, i)) {
            bool named = list->items[i].kind == TOKEN_NAME && is_text(list, i + 1, "=");
            bool quoted = is_text(list, i, "[") && i + 3 < list->count && is_text(list, i + 3, "=");
            element += !named && !quoted;
            if (key != NULL && named && is_text(list, i, key)) {
                return i;
            }
            if (key != NULL && quoted && list->items[i + 1].length == strlen(key) + 2 &&
                memcmp(list->text + list->items[i + 1].start + 1, key, strlen(key)) == 0) {
                return i + 1;
            }
            if (index > 0 && !named && !quoted && element == index) {
                return i;
            }
        }
        if (opens(list, i)) {
            depth++;
        } else if (closes(list, i) && --depth <= 0) {
            return -1;
        }
        static const char *const openers[] = { "function", "do", "then", "repeat" };
        for (size_t k = 0; k < sizeof openers / sizeof *openers; k++) {
            blocks += is_text(list, i, openers[k]);
        }
        blocks -=
            is_text(list, i, "end") || is_text(list, i, "until") || is_text(list, i, "elseif");
    }
    return -1;
}

// The token that starts the construct on its line and, if the call holds it, the wanted member; else the word, where it is no call.
void sc_lua_position(const char *text, size_t size, const sc_site *site, const char *key, int index,
                     int *line, int *column)
{
    tokens list = tokenize(text, size);
    int found = -1;
    bool exact = false;
    int first = -1, word = -1;
    for (int i = 0; i < list.count && list.items[i].line <= site->line && !exact; i++) {
        if (list.items[i].line < site->line) {
            continue;
        }
        first = first < 0 ? i : first;
        const char *name = site->outer != NULL ? site->outer : site->construct;
        if (!is_text(&list, i, name)) {
            continue;
        }
        word = word < 0 ? i : word;
        if (i + 1 >= list.count ||
            !(opens(&list, i + 1) || list.items[i + 1].kind == TOKEN_STRING)) {
            continue;
        }
        int open = is_text(&list, i + 1, "(") && is_text(&list, i + 2, "{") ? i + 2 : i + 1;
        if (site->outer != NULL) { // the table is itself a member: its own members are within it
            int inner = find_member(&list, open, site->construct, 0);
            bool is_table = inner >= 0 && is_text(&list, inner + 1, "=") && opens(&list, inner + 2);
            found = inner >= 0 ? inner : found;
            open = is_table ? inner + 2 : list.count;
        }
        int member = key != NULL || index > 0 ? find_member(&list, open, key, index) : -1;
        if (member >= 0) {
            found = member;
            exact = true;
        } else if (found < 0) {
            found = i;
        }
    }
    found = found >= 0 ? found : word >= 0 ? word : first;
    *line = site->line;
    *column = 1;
    if (found >= 0) {
        *line = list.items[found].line;
        *column = list.items[found].column;
    }
    free(list.items);
}

int sc_lua_column(const char *text, size_t size, int line, const char *word)
{
    tokens list = tokenize(text, size);
    int column = 0;
    bool exact = false;
    for (int i = 0; i < list.count && list.items[i].line <= line && !exact; i++) {
        if (list.items[i].line == line) {
            exact = word != NULL && is_text(&list, i, word);
            if (column == 0 || exact) {
                column = list.items[i].column;
            }
        }
    }
    free(list.items);
    return column == 0 ? 1 : column;
}

// The offending token is the last one of that spelling whose prefix Lua still accepts as the
// beginning of a program, that is, where cutting the text makes Lua complain about its end.
int sc_lua_syntax_column(lua_State *L, const char *text, size_t size, int line, const char *near)
{
    enum { TRIES = 32 }; // a line with more equal tokens gets the column of one of the first 32
    tokens list = tokenize(text, size);
    int column = 0;
    int tries = 0;
    for (int i = 0; i < list.count && list.items[i].line <= line && tries < TRIES; i++) {
        if (list.items[i].line < line || !is_text(&list, i, near)) {
            continue;
        }
        tries++;
        int status = luaL_loadbufferx(L, text, list.items[i].start, "=" SC_CHUNK, "t");
        const char *message = status == LUA_OK ? "" : lua_tostring(L, -1);
        size_t length = strlen(message);
        bool viable =
            status == LUA_OK || (length >= 5 && strcmp(message + length - 5, "<eof>") == 0);
        lua_pop(L, 1);
        if (viable || column == 0) {
            column = list.items[i].column;
        }
    }
    free(list.items);
    return column != 0 ? column : sc_lua_column(text, size, line, NULL);
}

bool sc_lua_find_power(const char *text, size_t size, int *line, int *column)
{
    cursor c = { .text = text, .size = size, .line = 1 };
    token t;
    token power = { 0 };
    while (next_token(&c, &t)) {
        bool two = t.kind == TOKEN_NUMBER && t.length == 1 && text[t.start] == '2';
        if (power.line != 0 && !two) {
            break;
        }
        bool is_power = t.kind == TOKEN_SIGN && t.length == 1 && text[t.start] == '^';
        power = is_power ? t : (token){ 0 };
    }
    *line = power.line;
    *column = power.column;
    return power.line != 0;
}
