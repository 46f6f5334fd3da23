// table.c - the count of shots that get through thin walls, engine beside engine: `make shots`.
// Reads: how many shots, a seed. Writes: the table to stdout. Exit status 1 when Plumb misses one.
#include <stdio.h>
#include <stdlib.h>

#include "harness/shots.h"

struct contender {
    const char *name;
    const struct engine *engine;
    const char *solver;
    bool swept;
    double thinnest; // [m] its boxes: Box2D welds corners nearer than half its slop of 5 mm
};

static const struct contender contenders[] = {
    { "plumb soft", &engine_plumb, "soft", true, 0 },
    { "plumb pgs", &engine_plumb, "baseline", true, 0 },
    { "Box2D 2.4.1", &engine_box2d2, NULL, true, 0.0025 },
    { "no sweeps", &engine_plumb, "soft", false, 0 },
};

// The first so many must stop every shot.
enum { CONTENDERS = sizeof contenders / sizeof contenders[0], MUST_STOP = 2 };

struct target {
    enum shot_wall wall;
    double thickness; // [m]
    const char *text;
};

static const struct target targets[] = {
    { SHOT_BOXES, 0.001, "boxes, 1 mm" },
    { SHOT_BOXES, 0.003, "boxes, 3 mm" },
    { SHOT_BOXES, 0.010, "boxes, 10 mm" },
    { SHOT_BOXES, 0.030, "boxes, 30 mm" },
    { SHOT_BOXES, 0.100, "boxes, 100 mm" },
    { SHOT_SEGMENTS, 0, "segments" },
    { SHOT_CHAIN, 0, "chain" },
};

enum { TARGETS = sizeof targets / sizeof targets[0] };

static bool can_build(const struct contender *c, const struct target *t)
{
    return t->wall != SHOT_BOXES || t->thickness > c->thinnest;
}

static void print_shot(const struct contender *c, const struct shot *s, double deepest)
{
    fprintf(stderr,
            "%s: %s at %s %g m: turned %.9g size %.9g angle %.9g clear %.9g speed %.9g "
            "incidence %.9g spin %.9g: %.3g m deep\n",
            c->name, shot_body_names[s->body], shot_wall_names[s->wall], s->thickness, s->turned,
            s->size, s->angle, s->clear, s->speed, s->incidence, s->spin, deepest);
}

int main(int argc, char **argv)
{
    long total = argc > 1 ? strtol(argv[1], NULL, 10) : 100000;
    unsigned seed = argc > 2 ? (unsigned)strtoul(argv[2], NULL, 10) : 1;
    long each = total / (TARGETS * SHOT_BODIES) + 1, missed[CONTENDERS] = { 0 };
    double deepest[CONTENDERS] = { 0 };
    printf("%-14s %-9s %7s", "wall", "body", "shots");
    for (int k = 0; k < CONTENDERS; ++k) {
        printf("  %12s", contenders[k].name);
    }
    puts("   missed");
    for (int t = 0; t < TARGETS; ++t) {
        for (int b = 0; b < SHOT_BODIES; ++b) {
            long here[CONTENDERS] = { 0 };
            for (long i = 0; i < each; ++i) {
                struct shot shot = shot_random(&seed, targets[t].wall, targets[t].thickness,
                                               (enum shot_body)b, 2000);
                for (int k = 0; k < CONTENDERS; ++k) {
                    if (!can_build(&contenders[k], &targets[t])) {
                        continue;
                    }
                    struct engine_options o = engine_options_default();
                    o.continuous = contenders[k].swept;
                    o.solver = contenders[k].solver;
                    struct shot_result r = shot_fire(contenders[k].engine, &o, &shot);
                    here[k] += r.missed;
                    deepest[k] = r.deepest > deepest[k] ? r.deepest : deepest[k];
                    if (r.missed && k < MUST_STOP) {
                        print_shot(&contenders[k], &shot, r.deepest);
                    }
                }
            }
            printf("%-14s %-9s %7ld", targets[t].text, shot_body_names[b], each);
            for (int k = 0; k < CONTENDERS; ++k) {
                if (can_build(&contenders[k], &targets[t])) {
                    printf("  %12ld", here[k]);
                } else {
                    printf("  %12s", "-");
                }
                missed[k] += here[k];
            }
            putchar('\n');
            fflush(stdout);
        }
    }
    printf("%-24s %7ld", "all", each * TARGETS * SHOT_BODIES);
    for (int k = 0; k < CONTENDERS; ++k) {
        printf("  %12ld", missed[k]);
    }
    printf("\n%-32s", "deepest part [m]");
    for (int k = 0; k < CONTENDERS; ++k) {
        printf("  %12.3g", deepest[k]);
    }
    putchar('\n');
    return missed[0] + missed[1] > 0;
}
