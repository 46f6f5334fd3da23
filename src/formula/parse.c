// parse.c - text to nodes, by recursive descent.
//
//     choice  = sum [ ( "<" | "<=" | ">" | ">=" ) sum ]
//     sum     = product { ( "+" | "-" ) product }
//     product = signed { ( "*" | "/" ) signed }
//     signed  = { "+" | "-" } power
//     power   = atom [ "^" signed ]                         2^-x^2 is 2^(-(x^2)), -x^2 is -(x^2)
//     atom    = number | name | name "(" choice { "," choice } ")" | "(" choice ")"
//
// The first fault is told, with its place counted from 1, and what would have been right there. Nothing is read behind it.
//
// Reads: text. Writes: the graph, the fault. Cost: O(characters); a stack of at most DEPTH parentheses and signs.
#include "formula/graph.h"

#include <stdarg.h>
#include <stdio.h>

enum { DEPTH = 48, WORD = 24, MOST_ARGUMENTS = 8 };

typedef struct word {
    const char *name;
    pl_formula_op op; // r: HYPOT
    double value;     // of NUMBER
} word;

static const word words[] = {
    { "x", PL_OP_PLACE_X, 0 },
    { "y", PL_OP_PLACE_Y, 0 },
    { "r", PL_OP_HYPOT, 0 },
    { "t", PL_OP_TIME, 0 },
    { "vx", PL_OP_SPEED_X, 0 },
    { "vy", PL_OP_SPEED_Y, 0 },
    { "pi", PL_OP_NUMBER, 3.141592653589793 },
    { "e", PL_OP_NUMBER, 2.718281828459045 },
};

// Ways that functions are made of nodes.
typedef enum form { PLAIN, FOLD, STEP, CLAMP, ASIN, ACOS, ATAN } form;

typedef struct function {
    const char *name;
    pl_formula_op op;
    form form;
    int least, most; // arguments
} function;

static const function functions[] = {
    { "abs", PL_OP_ABS, PLAIN, 1, 1 },
    { "acos", PL_OP_ATAN2, ACOS, 1, 1 },
    { "asin", PL_OP_ATAN2, ASIN, 1, 1 },
    { "atan", PL_OP_ATAN2, ATAN, 1, 1 },
    { "atan2", PL_OP_ATAN2, PLAIN, 2, 2 },
    { "clamp", PL_OP_MIN, CLAMP, 3, 3 },
    { "cos", PL_OP_COS, PLAIN, 1, 1 },
    { "exp", PL_OP_EXP, PLAIN, 1, 1 },
    { "floor", PL_OP_FLOOR, PLAIN, 1, 1 },
    { "hypot", PL_OP_HYPOT, PLAIN, 2, 2 },
    { "if", PL_OP_CHOOSE, PLAIN, 3, 3 },
    { "log", PL_OP_LOG, PLAIN, 1, 1 },
    { "max", PL_OP_MAX, FOLD, 2, MOST_ARGUMENTS },
    { "min", PL_OP_MIN, FOLD, 2, MOST_ARGUMENTS },
    { "sign", PL_OP_SIGN, PLAIN, 1, 1 },
    { "sin", PL_OP_SIN, PLAIN, 1, 1 },
    { "sqrt", PL_OP_SQRT, PLAIN, 1, 1 },
    { "step", PL_OP_AT_MOST, STEP, 1, 1 },
    { "tan", PL_OP_TAN, PLAIN, 1, 1 },
    { "tanh", PL_OP_TANH, PLAIN, 1, 1 },
};

#define COUNT(list) ((int)(sizeof(list) / sizeof *(list)))

//---- faults --------------------------------------------------------------------------------------

// The first one stays; a node to go on with.
static uint16_t fail(pl_parse *p, const char *format, ...)
{
    if (!p->failed) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(p->fault->says, sizeof p->fault->says, format, arguments);
        va_end(arguments);
        p->failed = true;
    }
    return pl_graph_number(p->graph, 0);
}

// What stands there, for a message: a character, or which byte.
static const char *found(const pl_parse *p, char room[16])
{
    const unsigned char c = (unsigned char)p->text[p->at];
    if (c == 0) {
        return "the end";
    }
    if (c >= 32 && c < 127) {
        snprintf(room, 16, "'%c'", c);
    } else {
        snprintf(room, 16, "byte 0x%02X", (unsigned)c);
    }
    return room;
}

static uint16_t expected(pl_parse *p, const char *what)
{
    char room[16];
    return fail(p, "expected %s at %d, not %s", what, p->at + 1, found(p, room));
}

static bool is_of_motion(const word *w)
{
    return w->op == PL_OP_SPEED_X || w->op == PL_OP_SPEED_Y;
}

// "x, y, r": names of a list, in room for them.
static const char *list_names(char *room, size_t size, bool is_potential, bool of_functions)
{
    size_t used = 0;
    const int count = of_functions ? COUNT(functions) : COUNT(words);
    for (int i = 0; i < count; ++i) {
        if (!of_functions && is_potential && is_of_motion(&words[i])) {
            continue;
        }
        const char *name = of_functions ? functions[i].name : words[i].name;
        const int more = snprintf(room + used, size - used, "%s%s", used > 0 ? ", " : "", name);
        used += (size_t)more < size - used ? (size_t)more : size - used - 1;
    }
    return room;
}

//---- text ----------------------------------------------------------------------------------------

static void skip_spaces(pl_parse *p)
{
    while (p->text[p->at] == ' ' || (p->text[p->at] >= '\t' && p->text[p->at] <= '\r')) {
        ++p->at;
    }
}

// Takes a character if it is next.
static bool take(pl_parse *p, char c)
{
    skip_spaces(p);
    if (p->failed || p->text[p->at] != c) {
        return false;
    }
    ++p->at;
    return true;
}

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static bool is_of_name(char c)
{
    return is_letter(c) || (c >= '0' && c <= '9');
}

// A name as long as WORD; a longer one is cut, and is none of ours.
static void read_name(pl_parse *p, char name[WORD])
{
    int length = 0;
    for (; is_of_name(p->text[p->at]); ++p->at) {
        if (length < WORD - 1) {
            name[length++] = p->text[p->at];
        }
    }
    name[length] = 0;
}

//---- atoms ---------------------------------------------------------------------------------------

static uint16_t read_choice(pl_parse *p);

// A node that was asked for, if the graph took it.
static uint16_t checked(pl_parse *p, uint16_t made)
{
    return !p->graph->is_full ? made
                              : fail(p, "too long: more than %d operations or %d numbers", PL_NODES,
                                     PL_GRAPH_NUMBERS);
}

static uint16_t node(pl_parse *p, pl_formula_op op, uint16_t a, uint16_t b, uint16_t c)
{
    return checked(p, pl_graph_node(p->graph, op, a, b, c));
}

static uint16_t number(pl_parse *p, double value)
{
    return checked(p, pl_graph_number(p->graph, value));
}

static uint16_t leaf(pl_parse *p, pl_formula_op op)
{
    return checked(p, pl_graph_leaf(p->graph, op));
}

static const function *function_named(const char *name)
{
    for (int i = 0; i < COUNT(functions); ++i) {
        if (strcmp(functions[i].name, name) == 0) {
            return &functions[i];
        }
    }
    return NULL;
}

static uint16_t word_node(pl_parse *p, const char *name, int at)
{
    char list[128];
    const word *w = words;
    while (w < words + COUNT(words) && strcmp(w->name, name) != 0) {
        ++w;
    }
    if (w == words + COUNT(words)) {
        return function_named(name) != NULL
                   ? expected(p, "'('")
                   : fail(p, "unknown name '%s' at %d; known are %s", name, at,
                          list_names(list, sizeof list, p->is_potential, false));
    }
    if (p->is_potential && is_of_motion(w)) {
        return fail(p, "'%s' at %d is a velocity; a potential knows %s", name, at,
                    list_names(list, sizeof list, true, false));
    }
    if (w->op == PL_OP_HYPOT) {
        const uint16_t x = leaf(p, PL_OP_PLACE_X), y = leaf(p, PL_OP_PLACE_Y);
        return node(p, PL_OP_HYPOT, x, y, 0);
    }
    return w->op == PL_OP_NUMBER ? number(p, w->value) : leaf(p, w->op);
}

// sqrt(1 - u^2)
static uint16_t opposite(pl_parse *p, uint16_t u)
{
    const uint16_t square = node(p, PL_OP_MULTIPLY, u, u, 0), one = number(p, 1);
    return node(p, PL_OP_SQRT, node(p, PL_OP_SUBTRACT, one, square, 0), 0, 0);
}

static uint16_t call(pl_parse *p, const function *f, const uint16_t *a, int count)
{
    uint16_t of = a[0];
    switch (f->form) {
    case FOLD:
        for (int i = 1; i < count; ++i) {
            of = node(p, f->op, of, a[i], 0);
        }
        return of;
    case STEP:
        return node(p, f->op, number(p, 0), of, 0);
    case CLAMP:
        return node(p, f->op, node(p, PL_OP_MAX, of, a[1], 0), a[2], 0);
    case ASIN:
        return node(p, f->op, of, opposite(p, of), 0);
    case ACOS:
        return node(p, f->op, opposite(p, of), of, 0);
    case ATAN:
        return node(p, f->op, of, number(p, 1), 0);
    default:
        return node(p, f->op, of, count > 1 ? a[1] : 0, count > 2 ? a[2] : 0);
    }
}

static uint16_t read_call(pl_parse *p, const char *name, int at)
{
    uint16_t arguments[MOST_ARGUMENTS];
    int count = 0;
    const function *f = function_named(name);
    if (f == NULL) {
        char list[192];
        return fail(p, "unknown function '%s' at %d; known are %s", name, at,
                    list_names(list, sizeof list, false, true));
    }
    do {
        const uint16_t value = read_choice(p);
        if (count < MOST_ARGUMENTS) {
            arguments[count] = value;
        }
        ++count;
    } while (take(p, ','));
    if (!p->failed && !take(p, ')')) {
        return expected(p, "an operator, ',' or ')'");
    }
    if (!p->failed && (count < f->least || count > f->most)) {
        return f->least == f->most ? fail(p, "%s() at %d takes %d value%s, not %d", name, at,
                                          f->least, f->least == 1 ? "" : "s", count)
                                   : fail(p, "%s() at %d takes %d to %d values, not %d", name, at,
                                          f->least, f->most, count);
    }
    return p->failed ? arguments[0] : call(p, f, arguments, count);
}

static uint16_t read_number(pl_parse *p)
{
    double value;
    const int length = pl_formula_number(p->text + p->at, &value);
    if (length == 0) {
        return expected(p, "a number, a name or '('");
    }
    if (!(value - value == 0)) {
        return fail(p, "the number at %d is too large", p->at + 1);
    }
    p->at += length;
    return number(p, value);
}

static uint16_t read_atom(pl_parse *p)
{
    char name[WORD];
    skip_spaces(p);
    const int at = p->at + 1;
    if (is_letter(p->text[p->at])) {
        read_name(p, name);
        return take(p, '(') ? read_call(p, name, at) : word_node(p, name, at);
    }
    if (!take(p, '(')) {
        return read_number(p);
    }
    const uint16_t inside = read_choice(p);
    return p->failed || take(p, ')') ? inside : expected(p, "an operator or ')'");
}

//---- operators -----------------------------------------------------------------------------------

static uint16_t read_signed(pl_parse *p)
{
    bool minus = false;
    if (p->failed) {
        return 0;
    }
    for (;;) {
        if (take(p, '-')) {
            minus = !minus;
        } else if (!take(p, '+')) {
            break;
        }
    }
    if (p->depth == DEPTH) {
        return fail(p, "nested more than %d deep at %d", DEPTH, p->at + 1);
    }
    ++p->depth;
    uint16_t value = read_atom(p);
    if (take(p, '^')) {
        const uint16_t exponent = read_signed(p);
        value = checked(p, pl_graph_power(p->graph, value, exponent));
    }
    --p->depth;
    return minus ? node(p, PL_OP_NEGATE, value, 0, 0) : value;
}

static uint16_t read_product(pl_parse *p)
{
    uint16_t value = read_signed(p);
    for (;;) {
        if (take(p, '*')) {
            value = node(p, PL_OP_MULTIPLY, value, read_signed(p), 0);
        } else if (take(p, '/')) {
            value = node(p, PL_OP_DIVIDE, value, read_signed(p), 0);
        } else {
            return value;
        }
    }
}

static uint16_t read_sum(pl_parse *p)
{
    uint16_t value = read_product(p);
    for (;;) {
        if (take(p, '+')) {
            value = node(p, PL_OP_ADD, value, read_product(p), 0);
        } else if (take(p, '-')) {
            value = node(p, PL_OP_SUBTRACT, value, read_product(p), 0);
        } else {
            return value;
        }
    }
}

static uint16_t read_choice(pl_parse *p)
{
    const uint16_t value = read_sum(p);
    const bool less = take(p, '<'), greater = !less && take(p, '>');
    if (!less && !greater) {
        return value;
    }
    const bool or_equal = p->text[p->at] == '=';
    p->at += or_equal;
    const uint16_t other = read_sum(p);
    return node(p, or_equal ? PL_OP_AT_MOST : PL_OP_LESS, less ? value : other,
                less ? other : value, 0);
}

bool pl_formula_parse(pl_graph *g, const char *text, bool is_potential, pl_formula_fault *fault,
                      uint16_t *out)
{
    pl_parse p = { .text = text, .is_potential = is_potential, .graph = g, .fault = fault };
    skip_spaces(&p);
    if (memchr(text, 0, PL_FORMULA_TEXT) == NULL) {
        fail(&p, "more than %d characters", PL_FORMULA_TEXT - 1);
    } else if (text[p.at] == 0) {
        fail(&p, "empty");
    } else {
        *out = read_choice(&p);
        skip_spaces(&p);
        if (!p.failed && text[p.at] != 0) {
            expected(&p, "an operator or the end");
        }
    }
    return !p.failed;
}
