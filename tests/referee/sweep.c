// sweep.c - one number of a scene over one of its parameters, engine by engine, as charts (referee.h).
#include "referee.h"

#include "plumb/cost.h"

#include <math.h>
#include <string.h>

enum { POINTS_MAX = 12, SWEEPS = 5 };

static const struct sweep {
    const char *scene, *key, *title, *along, *up;
    double values[POINTS_MAX]; // ends with 0
    double floor, top;         // of the picture: what is beyond is drawn there
    double bound;
    double mark; // where truth changes; 0: nowhere
    bool along_log;
} sweeps[SWEEPS] = {
    { "mass_ratio.lua",
      "ratio",
      "heavy on light",
      "mass ratio",
      "sinks, share of the lower crate",
      { 1, 10, 30, 100, 300, 1e3, 1e4, 1e5, 1e6 },
      1e-7,
      2,
      0.02,
      0,
      true },
    { "chain_length.lua",
      "links",
      "load on a chain, 100 : 1",
      "links",
      "stretches, share of its length",
      { 5, 10, 20, 40, 80, 160 },
      1e-7,
      10,
      0.01,
      0,
      true },
    { "tower.lua",
      "n",
      "tower",
      "boxes",
      "top is off, share of its height",
      { 2, 5, 10, 20, 30, 40, 60, 80 },
      1e-7,
      2,
      0.01,
      0,
      true },
    { "arch.lua",
      "share",
      "arch of 20 stones",
      "thickness / radius",
      "crown is down, share of the radius",
      { 0.095, 0.1, 0.105, 0.11, 0.115, 0.12, 0.13, 0.14, 0.16, 0.2 },
      1e-6,
      2,
      0,
      0.1075,
      false },
    { "overlap.lua",
      "share",
      "crates inside one another",
      "overlap, share of a crate",
      "fastest [m/s]",
      { 0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.75 },
      0.05,
      1000,
      6,
      0,
      false },
};

static int points_of(const struct sweep *s)
{
    int count = 0;
    while (count < POINTS_MAX && s->values[count] > 0) {
        count++;
    }
    return count;
}

int referee_sweep_points(void)
{
    int sum = 0;
    for (int i = 0; i < SWEEPS; i++) {
        sum += points_of(&sweeps[i]);
    }
    return sum;
}

void referee_sweep_tasks(struct task *tasks, const char *folder)
{
    static char paths[SWEEPS][512];
    for (int i = 0; i < SWEEPS; i++) {
        snprintf(paths[i], sizeof paths[i], "%.400s/%s", folder, sweeps[i].scene);
        for (int k = 0; k < points_of(&sweeps[i]); k++) {
            *tasks++ = (struct task){ paths[i], sweeps[i].key, sweeps[i].values[k], NULL };
        }
    }
}

// ---------------------------------------------------------------------------------- pictures

struct drawing {
    const struct referee *r;
    const struct task *tasks; // of the sweeps
};

// What an engine measured at a point, within the picture; NAN: nothing.
static double height_of(const struct sweep *s, const struct cell *cell)
{
    if (cell->status == CELL_LOST || cell->status == CELL_CRASHED) {
        return s->top;
    }
    if (cell->status != CELL_JUDGED || cell->count == 0) {
        return NAN;
    }
    double v = cell->lines[0].measured;
    return isfinite(v) ? fmin(fmax(v, s->floor), s->top) : s->top;
}

static void put_data(FILE *script, const struct drawing *d)
{
    const struct task *task = d->tasks;
    for (int i = 0; i < SWEEPS; i++) {
        int count = points_of(&sweeps[i]);
        for (int c = 0; c < d->r->contender_count; c++) {
            fprintf(script, "$s%d_%d << EOD\n", i, c);
            for (int k = 0; k < count; k++) {
                double v = height_of(&sweeps[i], &task[k].cells[c]);
                if (!isnan(v)) {
                    fprintf(script, "%.6g %.6g\n", sweeps[i].values[k], v);
                }
            }
            fprintf(script, "NaN NaN\nEOD\n");
        }
        task += count;
    }
}

// By engine; lighter as they come, darker and dashed at their best.
static const char *const hues[CONTENDERS_MAX] = { "#4fa3e3", "#1f6fb4", "#0b3d66", "#f0a860",
                                                  "#b85a10", "#c9a6e8", "#6f3fa0", "#8fd3ab",
                                                  "#1f7a47", "#808080" };

static bool is_usual(const struct contender *c)
{
    return strpbrk(c->key, "+") == NULL;
}

static void put_style(FILE *script, const struct drawing *d, int c)
{
    const struct contender *k = d->r->contenders[c];
    int hue = 0;
    while (&referee_contenders[hue] != k) {
        hue++;
    }
    fprintf(script, "with linespoints lw 2 pt %d ps 0.6 lc rgb '%s' dt %d title '%s, %s'",
            is_usual(k) ? 7 : 6, hues[hue], is_usual(k) ? 1 : 2, k->name, k->way);
}

static void put_panel(FILE *script, const struct drawing *d, int i)
{
    const struct sweep *s = &sweeps[i];
    int count = points_of(s);
    fprintf(script, "set title '{/:Bold %s}'\nset xlabel '%s'\nset ylabel '%s'\nunset arrow\n",
            s->title, s->along, s->up);
    fprintf(script, "%s logscale x\nset format x '%s'\nset xrange [%g:%g]\nset yrange [%g:%g]\n",
            s->along_log ? "set" : "unset",
            s->along_log && s->values[count - 1] > 1e3 ? "10^{%T}" : "%g", s->values[0],
            s->values[count - 1], s->floor, s->top);
    if (s->mark > 0) {
        fprintf(script, "set arrow from %g,%g to %g,%g nohead lc rgb '#808080' dt 3 lw 1.5\n",
                s->mark, s->floor, s->mark, s->top);
    }
    fprintf(script, "plot ");
    if (s->bound > 0) {
        fprintf(script, "%g with lines lc rgb '#808080' dt 3 lw 1.5 title 'bound', ", s->bound);
    }
    for (int c = 0; c < d->r->contender_count; c++) {
        fprintf(script, "%s$s%d_%d ", c > 0 ? ", " : "", i, c);
        put_style(script, d, c);
    }
    fprintf(script, "\n");
}

static void put_chart(FILE *script, const char *path, const void *context)
{
    const struct drawing *d = context;
    cost_put_terminal(script, path, 1200, 860);
    put_data(script, d);
    fprintf(script, "set multiplot layout 2,3 title '{/:Bold=14 Where engines fail}{/=11    60 Hz, "
                    "judged by poses}'\n"
                    "set logscale y\nset format y '10^{%%T}'\nunset key\n");
    for (int i = 0; i < SWEEPS; i++) {
        put_panel(script, d, i);
    }
    // The sixth panel is the key.
    fprintf(script, "unset logscale\nunset border\nunset tics\nunset xlabel\nunset ylabel\nunset "
                    "arrow\nset title ''\n"
                    "set key inside center Left reverse samplen 3 spacing 1.4\nset xrange "
                    "[0:1]\nset yrange [0:1]\nplot ");
    for (int c = 0; c < d->r->contender_count; c++) {
        fprintf(script, "%sNaN ", c > 0 ? ", " : "");
        put_style(script, d, c);
    }
    fprintf(script, ", NaN with lines lc rgb '#808080' dt 3 lw 1.5 title 'bound, and where truth "
                    "changes'\nunset multiplot\n");
}

static void put_csv(FILE *file, const struct drawing *d)
{
    const struct task *task = d->tasks;
    fprintf(file, "sweep,parameter,value,engine,settings,measured,bound,holds\n");
    for (int i = 0; i < SWEEPS; i++) {
        for (int k = 0; k < points_of(&sweeps[i]); k++, task++) {
            for (int c = 0; c < d->r->contender_count; c++) {
                const struct cell *cell = &task->cells[c];
                const struct contender *who = d->r->contenders[c];
                fprintf(file, "\"%s\",%s,%g,%s,\"%s\",", sweeps[i].title, sweeps[i].key,
                        task->value, who->name, who->way);
                if (cell->status == CELL_JUDGED && cell->count > 0) {
                    fprintf(file, "%.6g,%.6g,%s\n", cell->lines[0].measured, cell->lines[0].limit,
                            cell->lines[0].holds ? "yes" : "no");
                } else {
                    fprintf(file, ",,no\n");
                }
            }
        }
    }
}

int referee_sweep_draw(const struct referee *r, const struct task *tasks, const char *out)
{
    const struct drawing d = { r, tasks };
    char path[512];
    cli_output csv;
    snprintf(path, sizeof path, "%.400s/sweeps.csv", out);
    int code = cli_output_open(&csv, path);
    if (code == CLI_OK) {
        put_csv(csv.file, &d);
        code = cli_output_close(&csv, true);
    }
    static const char *const charts[] = { "sweeps.svg", "sweeps.png" };
    for (int i = 0; i < 2 && code == CLI_OK; i++) {
        snprintf(path, sizeof path, "%.400s/%s", out, charts[i]);
        code = cost_draw(path, put_chart, &d);
    }
    return code;
}
