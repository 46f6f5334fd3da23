// select.c - which vector width to use on this machine.
//
// Every width gives the same bits, so this is about speed alone; src/solver/DECISIONS.md has the
// numbers.
#include "solver/solver.h"

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
    return true; // the compiler splits wide vectors into what there is
#endif
}

// AMD's processors do not slow their clock down for wide registers; on Intel's 16 lanes are within a few per cent of 8.
static int best_measured(void)
{
#if defined(__x86_64__)
    __builtin_cpu_init();
    return machine_has(16) && __builtin_cpu_is("amd") ? 16 : 8;
#else
    return 8;
#endif
}

int pl_solver_best_width(int asked)
{
    int width = asked == 0 ? best_measured() : asked;
    while (width > 4 && !machine_has(width)) {
        width /= 2;
    }
    return width;
}
