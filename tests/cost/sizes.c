// sizes.c - how the cost of a step of the exact solver grows with the bodies of an island, beside the soft step's.
//
// Three families at 60 Hz with 4 substeps, sleeping off, float: a chain that swings from one nail; a pyramid of crates;
// a net of discs that hangs from its upper row by a bar between neighbours. A row is a size: the median time of a step of
// each solver, the power of the number of bodies by which the exact one's grew since the row above, the matrices that it factored a
// step, and its time for each matrix and body. Prints markdown. Main program; run it alone on the machine.
#define _POSIX_C_SOURCE 200809L

#include "harness/sim.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { WARM = 30, STEPS = 31, SIZES_MAX = 6 };

static const double dt = 1.0 / 60;

typedef struct cost {
    double milliseconds; // the median step's
    double factored;     // matrices a step
    double residual;     // the largest of all steps
    unsigned missed;     // solutions that missed the tolerance, of all steps
} cost;

// n links of 0.4 m with a hinge at each end, out to the right of the nail.
static unsigned chain(plumb_world *w, int n)
{
    plumb_body last = sim_body(w, PLUMB_STATIC, 0, 0, 0);
    for (int i = 0; i < n; ++i) {
        plumb_body link = sim_crate(w, 0.4 * i + 0.2, 0, 0.2, 0.05, sim_material(w, 0.5, 0));
        sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                         .body_a = last,
                                         .body_b = link,
                                         .anchor = sim_vec(0.4 * i, 0) });
        last = link;
    }
    return (unsigned)n;
}

// n rows of crates of a metre, each crate over the gap between two.
static unsigned pile(plumb_world *w, int n)
{
    plumb_material wood = sim_material(w, 0.6, 0);
    sim_floor(w, wood);
    for (int row = 0; row < n; ++row) {
        for (int i = 0; i < n - row; ++i) {
            sim_crate(w, 1.05 * (i + 0.5 * row), row + 0.5, 0.5, 0.5, wood);
        }
    }
    return (unsigned)(n * (n + 1) / 2);
}

// n x n discs a metre apart, a bar from each to the right and down; the upper row is nailed to the wall.
static unsigned net(plumb_world *w, int n)
{
    plumb_material steel = sim_material(w, 0.5, 0);
    plumb_body *above = calloc((size_t)n, sizeof *above);
    for (int row = 0; row < n; ++row) {
        plumb_body left = { 0 };
        for (int i = 0; i < n; ++i) {
            plumb_body disc =
                row == 0 ? sim_body(w, PLUMB_STATIC, i, 0, 0) : sim_ball(w, i, -row, 0.2, steel);
            for (int k = 0; row > 0 && k < 2; ++k) {
                if (k == 0 || i > 0) {
                    sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_DISTANCE,
                                                     .body_a = k == 0 ? above[i] : left,
                                                     .body_b = disc,
                                                     .anchor = k == 0 ? sim_vec(i, 1 - row)
                                                                      : sim_vec(i - 1, -row),
                                                     .anchor_b = sim_vec(i, -row) });
                }
            }
            above[i] = left = disc;
        }
    }
    free(above);
    return (unsigned)(n * (n - 1));
}

typedef struct family {
    const char *name;
    unsigned (*build)(plumb_world *w, int n); // returns the number of bodies that move
    int sizes[SIZES_MAX];                     // 0: no more
} family;

static const family families[] = { { "chain", chain, { 30, 100, 300, 1000, 3000, 10000 } },
                                   { "pyramid", pile, { 4, 8, 14, 24, 45, 77 } },
                                   { "net", net, { 4, 6, 10, 17, 25 } } };

static int larger(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static cost measure(const family *f, int size, plumb_solver solver, unsigned *bodies)
{
    plumb_world *w = sim_world(
        &(plumb_world_desc){ .solver = solver, .no_sleep = true, .no_exact_islands = true });
    *bodies = f->build(w, f->sizes[size]);
    sim_run(w, WARM, dt);

    cost c = { 0 };
    double times[STEPS];
    for (int i = 0; i < STEPS; ++i) {
        double start = now_ms();
        sim_step(w, dt);
        times[i] = now_ms() - start;
        plumb_stats stats = plumb_world_stats(w);
        c.factored += stats.exact_factored / (double)STEPS;
        c.residual = fmax(c.residual, stats.exact_residual);
        c.missed += stats.exact_missed;
    }
    plumb_world_destroy(w);
    qsort(times, STEPS, sizeof *times, larger);
    c.milliseconds = times[STEPS / 2];
    return c;
}

static const char *const heads = "| family | bodies | soft ms | exact ms | ratio | grows by | "
                                 "matrices | us a matrix and body | residual | missed |\n"
                                 "|---|---|---|---|---|---|---|---|---|---|\n";

// cost-sizes [N]: islands of up to N bodies; without it, all.
int main(int argc, char **argv)
{
    const double most = argc > 1 ? strtod(argv[1], NULL) : INFINITY;
    if (argc > 2 || !(most > 0)) {
        fprintf(stderr, "usage: cost-sizes [MOST_BODIES]\n");
        return 2;
    }
    fputs(heads, stdout);
    for (size_t f = 0; f < sizeof families / sizeof *families; ++f) {
        double last_ms = 0, last_bodies = 0;
        for (int k = 0; k < SIZES_MAX && families[f].sizes[k] > 0; ++k) {
            unsigned bodies;
            cost soft = measure(&families[f], k, PLUMB_SOLVER_SOFT, &bodies);
            if (bodies > most) {
                break;
            }
            cost exact = measure(&families[f], k, PLUMB_SOLVER_EXACT, &bodies);
            printf("| %s | %u | %.3g | %.3g | %.1f | ", families[f].name, bodies, soft.milliseconds,
                   exact.milliseconds, exact.milliseconds / soft.milliseconds);
            if (k > 0) {
                printf("%.2f", log(exact.milliseconds / last_ms) / log(bodies / last_bodies));
            }
            printf(" | %.0f | %.2f | %.1e | %u |\n", exact.factored,
                   1e3 * exact.milliseconds / (exact.factored * bodies), exact.residual,
                   exact.missed);
            fflush(stdout);
            last_ms = exact.milliseconds;
            last_bodies = bodies;
        }
    }
    return 0;
}
