/// tokens.h - C source as tokens, and the names that it declares at file scope. As much of C as
/// Plumb's own sources use.
#ifndef AMALGAMATE_TOKENS_H
#define AMALGAMATE_TOKENS_H

#include <stdbool.h>
#include <stddef.h>

typedef enum token_kind {
    TOKEN_SPACE, ///< blanks, newlines, comments
    TOKEN_NAME,  ///< identifiers and keywords
    TOKEN_VALUE, ///< numbers, strings, characters
    TOKEN_MARK   ///< punctuation
} token_kind;

typedef struct token {
    const char *text;
    size_t length;
    token_kind kind;
    bool directive; ///< on a line that begins with #
    bool member;    ///< a name after . or ->, or declared in a struct: no name of the file
} token;

/// A growing list of names, each once.
typedef struct names {
    char **items;
    size_t count, room;
} names;

bool names_have(const names *list, const char *text, size_t length);
void names_add(names *list, const char *text, size_t length);

typedef struct source {
    char *path; ///< as given
    char *text;
    token *tokens;
    size_t count, room;
    names declared; ///< functions, variables, types, enumerators of file scope
    names macros;   ///< #defined in it
    names members;  ///< named in it as members of structs
} source;

/// Reads and splits a file; declared names are found by source_declare. Ends the program when the
/// file cannot be read.
void source_read(source *s, const char *path);
/// Fills s->declared. `calls` are macros that look like functions.
void source_declare(source *s, const names *calls);

bool token_is(const token *t, const char *text);
/// The nearest token before or behind i that is no space; NULL: there is none.
const token *token_before(const source *s, size_t i);
const token *token_behind(const source *s, size_t i);

/// Prints a message and ends the program.
_Noreturn void give_up(const char *format, ...) __attribute__((format(printf, 1, 2)));
/// Memory that is kept until the end.
void *grow(void *p, size_t bytes);

#endif
