// value.c - numbers of the state as text, with as many digits as give the same number when read.
//
// Reads: two elements. Cost: O(1).
#include "record/value.h"

#include <stdio.h>
#include <string.h>

static void write_real(char to[64], const char *from)
{
    real v;
    memcpy(&v, from, sizeof v);
    snprintf(to, 64, "%.*g", sizeof v == sizeof(float) ? 9 : 17, (double)v);
}

static void write_vec2(char to[64], const char *from)
{
    char x[64], y[64];
    write_real(x, from);
    write_real(y, from + sizeof(real));
    snprintf(to, 64, "(%.29s, %.29s)", x, y);
}

static uint64_t number_at(const char *from, uint32_t size)
{
    uint64_t wide = 0; // little-endian or of full size: a smaller number keeps its value
    uint8_t n8;
    uint16_t n16;
    uint32_t n32;
    switch (size) {
    case 1:
        memcpy(&n8, from, sizeof n8);
        return n8;
    case 2:
        memcpy(&n16, from, sizeof n16);
        return n16;
    case 4:
        memcpy(&n32, from, sizeof n32);
        return n32;
    default:
        memcpy(&wide, from, size < sizeof wide ? size : sizeof wide);
        return wide;
    }
}

static void write_value(char to[64], const char *from, pl_type type, uint32_t size)
{
    float f;
    double d;
    switch (type) {
    case PL_TYPE_FLOAT:
        memcpy(&f, from, sizeof f);
        snprintf(to, 64, "%.9g", (double)f);
        break;
    case PL_TYPE_DOUBLE:
        memcpy(&d, from, sizeof d);
        snprintf(to, 64, "%.17g", d);
        break;
    case PL_TYPE_BOOL:
        snprintf(to, 64, "%s", *from != 0 ? "true" : "false");
        break;
    case PL_TYPE_I32:
        snprintf(to, 64, "%d", (int)(int32_t)number_at(from, size));
        break;
    case PL_TYPE_VEC2:
        write_vec2(to, from);
        break;
    case PL_TYPE_ENTITY:
        snprintf(to, 64, "%u:%u", (unsigned)number_at(from, 4), (unsigned)number_at(from + 4, 4));
        break;
    default:
        snprintf(to, 64, "%llu", (unsigned long long)number_at(from, size));
        break;
    }
}

void pl_value_texts(plumb_difference *row, const char *a, const char *b, const pl_member *m)
{
    const bool is_list = m->type == PL_TYPE_OTHER || m->type == PL_TYPE_FLOATS ||
                         m->type == PL_TYPE_DOUBLES; // other: a few reals
    const bool is_float =
        m->type == PL_TYPE_FLOATS || (m->type == PL_TYPE_OTHER && sizeof(real) == sizeof(float));
    const uint32_t one = is_float ? sizeof(float) : sizeof(double);
    if (m->type == PL_TYPE_POINTER || (is_list && m->size % one != 0)) {
        return;
    }
    size_t at = 0;
    while (is_list && memcmp(a + at, b + at, one) == 0) { // the first that differ
        at += one;
    }
    const pl_type type = !is_list ? m->type : is_float ? PL_TYPE_FLOAT : PL_TYPE_DOUBLE;
    write_value(row->a, a + at, type, m->size);
    write_value(row->b, b + at, type, m->size);
}
