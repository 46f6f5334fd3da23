// number.c - decimal numbers as the nearest doubles, whatever the C library's locale says of points.
//
// Digits are one large whole number; it is multiplied by 10^e, or shifted up and divided by 10^-e, exactly, with a note of
// whether anything is left; then rounded once, to even (what Clinger 1990 calls AlgorithmM). Of more than DIGITS digits the
// rest only say that there is more.
//
// Reads: text. Cost: O(digits + |e|) passes over some 50 words.
#include "formula/graph.h"

enum { DIGITS = 40, WORDS = 56, FAR_UP = 400, FAR_DOWN = -400 };

// Words of 32 bits, the lowest first.
typedef struct large {
    uint32_t word[WORDS];
    int count;
} large;

static void multiply_add(large *n, uint32_t by, uint32_t more)
{
    uint64_t carry = more;
    for (int i = 0; i < n->count; ++i) {
        carry += (uint64_t)n->word[i] * by;
        n->word[i] = (uint32_t)carry;
        carry >>= 32;
    }
    if (carry != 0 && n->count < WORDS) {
        n->word[n->count++] = (uint32_t)carry;
    }
}

// The remainder.
static uint32_t divide(large *n, uint32_t by)
{
    uint64_t rest = 0;
    for (int i = n->count - 1; i >= 0; --i) {
        rest = rest << 32 | n->word[i];
        n->word[i] = (uint32_t)(rest / by);
        rest %= by;
    }
    while (n->count > 0 && n->word[n->count - 1] == 0) {
        --n->count;
    }
    return (uint32_t)rest;
}

static int bits_of(const large *n)
{
    int bits = 0;
    for (uint32_t top = n->count > 0 ? n->word[n->count - 1] : 0; top != 0; top /= 2) {
        ++bits;
    }
    return bits + 32 * (n->count - 1);
}

static bool bit_at(const large *n, int i)
{
    return i >= 0 && i < 32 * n->count && (n->word[i / 32] >> (i % 32) & 1) != 0;
}

// Some bit below the i-th is set.
static bool any_below(const large *n, int i)
{
    bool any = false;
    for (int k = 0; k < n->count && 32 * k < i; ++k) {
        const int left = i - 32 * k;
        any |= (left >= 32 ? n->word[k] : n->word[k] & ((1u << left) - 1)) != 0;
    }
    return any;
}

// n 2^shift, and more where `rest`, as a double.
static double rounded(const large *n, int shift, bool rest)
{
    const int bits = bits_of(n);
    // So many of them a double takes: fewer of the smallest.
    const int lowest = bits + shift - 53 < -1074 ? -1074 - shift : bits - 53;
    const int drop = lowest > 0 ? lowest : 0;
    uint64_t kept = 0;
    for (int i = bits - 1; i >= drop; --i) {
        kept = kept << 1 | bit_at(n, i);
    }
    kept += bit_at(n, drop - 1) && (rest || any_below(n, drop - 1) || (kept & 1) != 0);
    return ldexp((double)kept, drop + shift);
}

static double value_of(large *n, int exponent, bool rest)
{
    int shift = 0;
    if (n->count == 0 || exponent < FAR_DOWN) {
        return 0;
    }
    if (exponent > FAR_UP) {
        return (double)INFINITY;
    }
    for (; exponent >= 9; exponent -= 9) {
        multiply_add(n, 1000000000, 0);
    }
    for (; exponent > 0; --exponent) {
        multiply_add(n, 10, 0);
    }
    // 2^30 for 10^9, and 90 bits more, so that more than 64 are left.
    for (int k = exponent < 0 ? exponent - 27 : 0; k < 0; k += 9) {
        multiply_add(n, 1u << 30, 0);
        shift -= 30;
    }
    for (; exponent <= -9; exponent += 9) {
        rest |= divide(n, 1000000000) != 0;
    }
    for (; exponent < 0; ++exponent) {
        rest |= divide(n, 10) != 0;
    }
    return rounded(n, shift, rest);
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

// "e-3" behind a number; 0 characters: there is none.
static int read_exponent(const char *text, int *exponent)
{
    int at = 1, value = 0;
    *exponent = 0;
    if (text[0] != 'e' && text[0] != 'E') {
        return 0;
    }
    const bool down = text[at] == '-';
    at += down || text[at] == '+';
    if (!is_digit(text[at])) {
        return 0;
    }
    for (; is_digit(text[at]); ++at) {
        value = value < 10000 ? 10 * value + (text[at] - '0') : value;
    }
    *exponent = down ? -value : value;
    return at;
}

int pl_formula_number(const char *text, double *value)
{
    large n = { .count = 0 };
    int at = 0, digits = 0, exponent = 0, given, read = 0;
    bool behind = false, rest = false;
    for (; is_digit(text[at]) || (text[at] == '.' && !behind); ++at) {
        if (text[at] == '.') {
            behind = true;
            continue;
        }
        ++read;
        const uint32_t digit = (uint32_t)(text[at] - '0');
        if (digits < DIGITS) {
            digits += n.count > 0 || digit > 0;
            if (n.count == 0 && digit > 0) {
                n.word[n.count++] = digit;
            } else {
                multiply_add(&n, 10, digit);
            }
            exponent -= behind;
        } else {
            rest |= digit > 0;
            exponent += !behind;
        }
    }
    if (read == 0) {
        return 0;
    }
    at += read_exponent(text + at, &given);
    *value = value_of(&n, exponent + given, rest);
    return at;
}
