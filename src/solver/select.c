// select.c - which vector width to use on this machine.
//
// Every width gives the same bits, so this is about speed alone; src/solver/DECISIONS.md has the
// numbers.
#include "solver/solver.h"

#if defined(__x86_64__)
#include <cpuid.h>
#endif

static bool machine_has(int width)
{
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (width == 16) {
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
               __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
    }
    if (width == 8) {
        return __builtin_cpu_supports("avx2");
    }
    return true;
#else
    return width == 4; // all kernels have four lanes (core/wide.h)
#endif
}

// AMD's processors do not slow their clock down for wide registers, nor do Intel's from Sapphire Rapids on, which are the
// first to know numbers of 16 bits (AVX512-FP16, a bit that no older compiler has a name for).
static bool is_quick_at_16(void)
{
#if defined(__x86_64__)
    unsigned a, b, c, d;
    __builtin_cpu_init();
    return machine_has(16) &&
           (__builtin_cpu_is("amd") ||
            (__get_cpuid_count(7, 0, &a, &b, &c, &d) != 0 && (d >> 23 & 1) != 0));
#else
    return false;
#endif
}

int pl_solver_best_width(int asked)
{
    int width = asked == 0 ? (is_quick_at_16() ? 16 : 8) : asked;
    while (width > 4 && !machine_has(width)) {
        width /= 2;
    }
    return width;
}
