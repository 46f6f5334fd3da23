/// cost_chart.c - what `plumb cost` has measured, drawn by the program gnuplot as SVG or PNG.
///
/// Writes a script with its data to gnuplot's standard input and takes the picture from its standard output: no shell,
/// no name of a file in the script. Log-log: error over microseconds of processor time for a simulated second, the
/// front as a stair, noise as bars, diverged settings on the upper edge, errors of nothing on the lower one; below, the
/// error of the front's settings over simulated time.
#define _POSIX_C_SOURCE 200809L // posix_spawnp, fileno

#include "cost.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { PANELS_MAX = 4, TIMED_MAX = 6, SIDES = 8 };

// Hues that stay apart in print and for most of those who see fewer; by side and solver.
static const char *const hues[] = {
    "#1f6fb4", "#d9741a", "#2d9d63", "#8a5bb5", "#c23b4b", "#5d6a75"
};
enum { HUES = (int)(sizeof hues / sizeof hues[0]) };
// Filled and open circles, triangles: float, double, far.
static const int marks[] = { 7, 6, 9 };

static bool is_png(const char *path)
{
    size_t length = strlen(path);
    return length > 4 && strcmp(path + length - 4, ".png") == 0;
}

int cost_chart_check(const char *path)
{
    size_t length = strlen(path);
    if (is_png(path) || (length > 4 && strcmp(path + length - 4, ".svg") == 0)) {
        return CLI_OK;
    }
    cli_message("cost: option --chart: '%s' does not end in .svg or .png", path);
    return CLI_USAGE;
}

// ---------------------------------------------------------------------------------------- script

/// Text between single quotes; what enhanced text would take as a sign is escaped.
static void put_text(FILE *file, const char *text)
{
    for (; *text != '\0'; text++) {
        if (*text == '\'') {
            fputc('\'', file);
        }
        if (strchr("_^@&~{}\\", *text) != NULL) {
            fputc('\\', file);
        }
        fputc((unsigned char)*text < 32 ? ' ' : *text, file);
    }
}

/// Error on the chart, in the unit shown.
static double height_of(const cost_quantity *quantity, double error, bool relative)
{
    return relative ? cost_relative(quantity, error) : error;
}

/// What a setting would have cost that diverged before its end: by the work of one of its kind. < 0: unknown.
static double expected_cpu(const cost_plan *plan, const cost_row *row)
{
    double cpu = -1;
    for (int i = 0; i < plan->row_count; i++) {
        const cost_row *other = &plan->rows[i];
        const cost_setting *a = &row->set, *b = &other->set;
        if (!other->diverged && a->side == b->side && a->solver == b->solver) {
            double work = (a->substeps * a->iterations + 2) / a->dt;
            double its = (b->substeps * b->iterations + 2) / b->dt;
            cpu = other->cpu * work / its;
        }
    }
    return cpu;
}

/// The least and the largest error that is shown of a quantity; false: there is none.
static bool find_range(const cost_plan *plan, int q, bool relative, double *low, double *high)
{
    *low = DBL_MAX;
    *high = 0;
    for (int i = 0; i < plan->row_count; i++) {
        const cost_row *row = &plan->rows[i];
        double error = height_of(&plan->quantities[q], row->error[q], relative);
        if (!row->diverged && row->error[q] > 0) {
            *low = fmin(*low, error);
            *high = fmax(*high, error);
        }
    }
    if (!(*high > 0)) { // all are exact, or none says anything
        *low = *high = 1e-16;
    }
    *low = pow(10, floor(log10(*low) - 0.3));
    *high = pow(10, ceil(log10(*high) + 0.3));
    return *low < *high;
}

static bool in_series(const cost_row *row, int side, int solver, int precision)
{
    return row->set.side == side && row->set.solver == solver && row->set.precision == precision;
}

/// The points of one engine, solver and precision; false: it has none.
static bool put_points(FILE *file, const cost_plan *plan, int q, const int series[3], bool relative,
                       double low)
{
    bool any = false;
    for (int i = 0; i < plan->row_count; i++) {
        const cost_row *row = &plan->rows[plan->order[i]];
        if (!row->diverged && row->error[q] >= 0 &&
            in_series(row, series[0], series[1], series[2])) {
            if (!any) {
                fprintf(file, "$p%d_%d_%d_%d << EOD\n", q, series[0], series[1], series[2]);
            }
            double error = height_of(&plan->quantities[q], row->error[q], relative);
            fprintf(file, "%.6g %.6g %.6g\n", 1e6 * row->cpu, fmax(error, low),
                    1e6 * (row->cpu + row->jitter));
            any = true;
        }
    }
    if (any) {
        fprintf(file, "EOD\n");
    }
    return any;
}

/// Rows that are marked apart: on the front (0), the scene's own (1), diverged (2).
static bool put_marked(FILE *file, const cost_plan *plan, int q, int kind, bool relative,
                       double low, double high)
{
    static const char *const names[] = { "front", "own", "lost" };
    bool any = false;
    for (int i = 0; i < plan->row_count; i++) {
        const cost_row *row = &plan->rows[plan->order[i]];
        bool there = !row->diverged && row->error[q] >= 0;
        bool wanted = kind == 0   ? there && row->front[q]
                      : kind == 1 ? there && row->own
                                  : row->diverged;
        double cpu = row->diverged ? expected_cpu(plan, row) : row->cpu;
        if (!wanted || cpu < 0) {
            continue;
        }
        if (!any) {
            fprintf(file, "$%s%d << EOD\n", names[kind], q);
        }
        double error = fmax(height_of(&plan->quantities[q], row->error[q], relative), low);
        fprintf(file, "%.6g %.6g\n", 1e6 * cpu, row->diverged ? high : error);
        any = true;
    }
    if (any) {
        fprintf(file, "EOD\n");
    }
    return any;
}

static void put_series_title(FILE *file, const cost_plan *plan, const int series[3])
{
    char solver[32], precision[16];
    if (!cli_member(plan->sides[series[0]].solvers, series[1], solver, sizeof solver) ||
        !cli_member(SCENE_PRECISIONS, series[2], precision, sizeof precision)) {
        return;
    }
    if (plan->sides[series[0]].engine != NULL) {
        put_text(file, plan->sides[series[0]].name);
        fputc(' ', file);
    }
    put_text(file, solver);
    // Other engines have one precision: nothing is told of it.
    if (plan->sides[series[0]].engine == NULL) {
        fprintf(file, ", %s", precision);
    }
}

/// [us] from the cheapest to the dearest setting; without one, gnuplot would find no range of its own.
static void find_times(const cost_plan *plan, double *low, double *high)
{
    *low = DBL_MAX;
    *high = 0;
    for (int i = 0; i < plan->row_count; i++) {
        const cost_row *row = &plan->rows[i];
        double cpu = 1e6 * (row->diverged ? expected_cpu(plan, row) : row->cpu);
        if (cpu > 0) {
            *low = fmin(*low, cpu / 1.5);
            *high = fmax(*high, cpu * 1.5);
        }
    }
    if (!(*high > 0)) {
        *low = 1;
        *high = 10;
    }
}

/// Where times are within a decade or so, a number at each power of ten would be one or none: at 1, 2 and 5 times them.
static void put_ticks(FILE *file, double first, double last)
{
    static const int digits[] = { 1, 2, 5 };
    if (last > 100 * first) {
        fprintf(file, "set xtics autofreq\n");
        return;
    }
    const char *glue = "set xtics (";
    for (double power = pow(10, floor(log10(first))); power <= last; power *= 10) {
        for (int i = 0; i < 3; i++) {
            if (power * digits[i] >= first && power * digits[i] <= last) {
                fprintf(file, "%s%g", glue, power * digits[i]);
                glue = ", ";
            }
        }
    }
    fprintf(file, "%s\n", *glue == ',' ? ")" : "set xtics autofreq");
}

static void put_axes(FILE *file, const cost_plan *plan, int q, bool relative, double low,
                     double high)
{
    const cost_quantity *quantity = &plan->quantities[q];
    double first, last;
    find_times(plan, &first, &last);
    fprintf(file, "set title '{/:Bold ");
    put_text(file, quantity->name);
    fprintf(file, "}'\nset ylabel 'error [");
    put_text(file, relative && quantity->extent > 0 ? "1" : quantity->unit);
    fprintf(file,
            "]'\nset xlabel 'processor time for a simulated second [us]'\n"
            "set logscale xy\nset xrange [%g:%g]\nset yrange [%g:%g]\n"
            "set format y '10^{%%T}'\nset format x '%%g'\n",
            first, last, low, high);
    put_ticks(file, first, last);
}

/// One panel: error over processor time.
static void put_panel(FILE *file, const cost_plan *plan, int q, bool relative)
{
    double low, high;
    const char *glue = "plot ";
    (void)find_range(plan, q, relative, &low, &high);
    bool front = put_marked(file, plan, q, 0, relative, low, high);
    bool own = put_marked(file, plan, q, 1, relative, low, high);
    bool lost = put_marked(file, plan, q, 2, relative, low, high);
    bool there[SIDES][8][3] = { { { false } } };
    for (int k = 0; k < SIDES * 8 * 3; k++) {
        const int series[3] = { k / 24, k / 3 % 8, k % 3 };
        there[k / 24][k / 3 % 8][k % 3] = put_points(file, plan, q, series, relative, low);
    }
    put_axes(file, plan, q, relative, low, high);
    if (front) {
        fprintf(file, "%s$front%d with steps lw 2 lc rgb '#30363c' title 'front'", glue, q);
        glue = ", ";
    }
    for (int k = 0, hue = -1, last = -1; k < SIDES * 8 * 3; k++) {
        const int series[3] = { k / 24, k / 3 % 8, k % 3 };
        if (!there[series[0]][series[1]][series[2]]) {
            continue;
        }
        hue += k / 3 != last;
        last = k / 3;
        fprintf(file,
                "%s$p%d_%d_%d_%d using 1:2:1:3 with xerrorbars pt %d ps 0.9 lw 1 lc rgb '%s' "
                "title '",
                glue, q, series[0], series[1], series[2], marks[series[2]], hues[hue % HUES]);
        put_series_title(file, plan, series);
        fprintf(file, "'");
        glue = ", ";
    }
    if (own) {
        fprintf(file, "%s$own%d with points pt 6 ps 1.9 lw 2 lc rgb 'black' title 'scene''s own'",
                glue, q);
        glue = ", ";
    }
    if (lost) {
        fprintf(file, "%s$lost%d with points pt 2 ps 1.3 lw 2 lc rgb '#c23b4b' title 'diverged'",
                glue, q);
        glue = ", ";
    }
    fprintf(file, glue[0] == ',' ? "\n" : "plot NaN title 'nothing to compare'\n");
}

/// Settings on the front, of a long one every so manieth from both ends on. Their number; 0 when the error of the
/// quantity is told at too few moments to draw it.
static int choose_timed(const cost_plan *plan, int q, const cost_row *chosen[TIMED_MAX])
{
    int count = 0, parts = 0, front = 0, seen = 0;
    for (int i = 0; i < plan->row_count; i++) {
        front += plan->rows[i].front[q];
    }
    for (int i = 0; i < plan->row_count && count < TIMED_MAX; i++) {
        const cost_row *row = &plan->rows[plan->order[i]];
        if (row->front[q] &&
            (front <= TIMED_MAX || seen * (TIMED_MAX - 1) / (front - 1) >= count)) {
            chosen[count++] = row;
        }
        seen += row->front[q];
    }
    for (int k = 0; k < COST_PARTS && count > 0; k++) {
        parts += chosen[0]->part[q][k] > 0;
    }
    return parts < 3 ? 0 : count;
}

/// The error of a quantity over simulated time.
static void put_times(FILE *file, const cost_plan *plan, int q, bool relative)
{
    const cost_row *chosen[TIMED_MAX];
    int count = choose_timed(plan, q, chosen);
    for (int i = 0; i < count; i++) {
        fprintf(file, "$t%d << EOD\n", i);
        for (int k = 0; k < COST_PARTS; k++) {
            if (chosen[i]->part[q][k] > 0) {
                fprintf(file, "%.6g %.6g\n", plan->time * (k + 0.5) / COST_PARTS,
                        height_of(&plan->quantities[q], chosen[i]->part[q][k], relative));
            }
        }
        fprintf(file, "EOD\n");
    }
    put_axes(file, plan, q, relative, 1, 10);
    fprintf(file,
            "unset logscale x\nset xtics autofreq\nset format x '%%g'\n"
            "set xrange [0:%g]\nset yrange [*:*]\n"
            "set xlabel 'simulated time [s]'\nset title '{/:Bold ",
            plan->time);
    put_text(file, plan->quantities[q].name);
    fprintf(file, "} over time, settings on the front'\nplot ");
    for (int i = 0; i < count; i++) {
        const cost_setting *set = &chosen[i]->set;
        fprintf(file, "%s$t%d with linespoints pt 7 ps 0.5 lw 2 lc rgb '%s' title '",
                i > 0 ? ", " : "", i, hues[i % HUES]);
        put_series_title(file, plan, (const int[]){ set->side, set->solver, set->precision });
        fprintf(file, ", 1/%.4g s x %d'", 1 / set->dt, set->substeps);
    }
    fprintf(file, "\n");
}

void cost_put_terminal(FILE *script, const char *path, int width, int height)
{
    fprintf(script,
            "set terminal %s size %d,%d font 'DejaVu Sans,11' enhanced background rgb 'white'\n"
            "set encoding utf8\n"
            "set border 3 lc rgb '#8a9299'\nset tics nomirror textcolor rgb '#30363c'\n"
            "set grid lc rgb '#dfe3e6' lt 1 lw 0.7\nset bars small\n"
            "set key outside below horizontal maxcols 3 height 1 samplen 1.2 spacing 1.1\n",
            is_png(path) ? "pngcairo" : "svg", width, height);
}

/// What the script of a plan is made from.
typedef struct drawing {
    const cost_plan *plan;
    bool relative;
} drawing;

static void put_script(FILE *file, const char *path, const void *context)
{
    const cost_plan *plan = ((const drawing *)context)->plan;
    bool relative = ((const drawing *)context)->relative;
    int panels = plan->quantity_count < PANELS_MAX ? plan->quantity_count : PANELS_MAX;
    const cost_row *timed[TIMED_MAX];
    bool over_time = panels > 0 && choose_timed(plan, 0, timed) > 0;
    int cells = panels + over_time, columns = cells > 1 ? 2 : 1,
        rows = (cells + columns - 1) / columns;
    cost_put_terminal(file, path, 640 * columns, 480 * rows + 50);
    fprintf(file, "set multiplot layout %d,%d title '{/:Bold=14 ", rows, columns);
    put_text(file, plan->title);
    fprintf(file, "}{/=11    what accuracy costs, %.4g s simulated}'\n", plan->time);
    for (int q = 0; q < panels; q++) {
        put_panel(file, plan, q, relative);
    }
    if (over_time) {
        put_times(file, plan, 0, relative);
    }
    fprintf(file, "unset multiplot\n");
}

// ------------------------------------------------------------------------------------- gnuplot

/// Runs gnuplot on `script`, its picture into `out`, what it says into `said`. 0, an errno, or -1: it failed.
static int run_gnuplot(FILE *script, FILE *out, FILE *said)
{
    char *const arguments[] = { "gnuplot", "-d", "-", NULL };
    posix_spawn_file_actions_t actions;
    pid_t child;
    int status = 0;
    fflush(script);
    rewind(script);
    fflush(out);
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, fileno(script), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(out), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(said), STDERR_FILENO);
    int code = posix_spawnp(&child, "gnuplot", &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (code != 0) {
        return code;
    }
    while (waitpid(child, &status, 0) < 0) {
        if (errno != EINTR) {
            return errno;
        }
    }
    return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? 0 : -1;
}

/// Tells why there is no chart. CLI_FAILED.
static int tell_failure(const char *path, int code, FILE *said)
{
    char line[256], last[256] = "";
    rewind(said);
    while (fgets(line, sizeof line, said) != NULL) {
        line[strcspn(line, "\n")] = '\0';
        if (line[0] != '\0' && strspn(line, " ^") != strlen(line)) {
            snprintf(last, sizeof last, "%s", line);
        }
    }
    if (code == ENOENT) {
        cli_message("cannot draw '%s': the program gnuplot is not on PATH; install the package "
                    "gnuplot-nox",
                    path);
    } else {
        cli_message("cannot draw '%s': gnuplot: %s", path, code > 0 ? strerror(code) : last);
    }
    return CLI_FAILED;
}

int cost_chart(const cost_plan *plan, const char *path, bool relative)
{
    const drawing what = { plan, relative };
    return cost_draw(path, put_script, &what);
}

int cost_draw(const char *path, void (*put)(FILE *script, const char *path, const void *context),
              const void *context)
{
    cli_output out;
    int code = cli_output_open(&out, path);
    if (code != CLI_OK) {
        return code;
    }
    FILE *script = tmpfile(), *said = tmpfile();
    if (script == NULL || said == NULL) {
        cli_message("cannot draw '%s': %s", path, strerror(errno));
        code = CLI_FAILED;
    } else {
        put(script, path, context);
        int drawn = run_gnuplot(script, out.file, said);
        code = drawn != 0 ? tell_failure(path, drawn, said) : CLI_OK;
    }
    if (script != NULL) {
        fclose(script);
    }
    if (said != NULL) {
        fclose(said);
    }
    int closed = cli_output_close(&out, code == CLI_OK);
    return code != CLI_OK ? code : closed;
}
