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

// Sixteen lanes win where units are 512 bits wide and the clock keeps its speed: AMD's from family 26 on, which VP2INTERSECT
// tells from those before. On Intel's they are within a few per cent of eight.
static int best_measured(void)
{
#if defined(__x86_64__)
    __builtin_cpu_init();
    return __builtin_cpu_is("amd") && __builtin_cpu_supports("avx512vp2intersect") ? 16 : 8;
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
