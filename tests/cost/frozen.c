// frozen.c - contact problems frozen out of scenes, and how far each solver is from their exact answer after k sweeps.
//
// A problem is the state of a scene before one of its steps: bodies that touch, and their joints, without the impulses of the
// step before, which are those of one solver. Each solver takes that one step from the same image; what it makes of all
// velocities is compared with what the exact solver does:
//
//     error = |v - v_exact| / |v_exact - v_free|,    |v|^2 = sum m (vx^2 + vy^2) + I w^2
//
// v_free is the flight of a step without contacts: an error of 1 is to have done nothing. Three ladders: sweeps of the
// classic solver; sweeps of the soft step, in one substep; substeps of one sweep, against the exact solver with as many.
// Reads scenes in double; writes frozen.md, .csv, .svg, .png below a folder. Main program.
#define _POSIX_C_SOURCE 200809L

#include "harness/interrupt.h"
#include "plumb/cost.h"
#include "scene/scene.h"
#include "world/state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PROBLEMS_MAX = 100, RUNGS = 7, LADDERS = 3, BODIES_MAX = 1024, POINTS_MAX = 1000 };

static const struct {
    const char *name, *hue;
    plumb_solver solver;
    bool by_substeps;
} ladders[LADDERS] = { { "classic, k sweeps", "#d9741a", PLUMB_SOLVER_PGS, false },
                       { "soft, k sweeps", "#8a5bb5", PLUMB_SOLVER_SOFT, false },
                       { "soft, k substeps", "#1f6fb4", PLUMB_SOLVER_SOFT, true } };

typedef struct problem {
    char name[64];
    unsigned bodies, points;
    double error[LADDERS][RUNGS];
} problem;

typedef struct study {
    problem problems[PROBLEMS_MAX];
    int count, skipped; // those that the exact solver has no answer to, or that touch nothing
    bool broken;        // a scene could not be run
    const char *folder;
} study;

typedef struct motion {
    double x, y, w;
} motion;

// A scene that stands before a step.
typedef struct frozen {
    scene *scene;
    plumb_world *world;
    void *image;
    size_t size;
    plumb_body bodies[BODIES_MAX]; // that move
    double mass[BODIES_MAX], inertia[BODIES_MAX];
    motion flight[BODIES_MAX]; // after a step in which nothing touches
    int count;
    double dt;
} frozen;

// ------------------------------------------------------------------------------------------- states

static void look_at(const frozen *f, motion *out)
{
    for (int i = 0; i < f->count; i++) {
        const plumb_vec2 v = plumb_body_velocity(f->world, f->bodies[i]);
        out[i] = (motion){ (double)v.x, (double)v.y,
                           (double)plumb_body_angular_velocity(f->world, f->bodies[i]) };
    }
}

static double distance(const frozen *f, const motion *a, const motion *b)
{
    double sum = 0;
    for (int i = 0; i < f->count; i++) {
        const double x = a[i].x - b[i].x, y = a[i].y - b[i].y, w = a[i].w - b[i].w;
        sum += f->mass[i] * (x * x + y * y) + f->inertia[i] * w * w;
    }
    return sqrt(sum);
}

// One step from the image by a solver. False: the world refused.
static bool step_from(frozen *f, plumb_solver solver, int substeps, int iterations, motion *out)
{
    if (plumb_world_restore_trusted(f->world, f->image, f->size) != PLUMB_OK) {
        return false;
    }
    // A world keeps its solver for life: only a study changes it in between.
    f->world->desc.solver = solver;
    f->world->desc.substeps = substeps;
    f->world->desc.iterations = iterations;
    f->world->desc.no_fine_islands = true; // as many sweeps as are said
    f->world->schedule_dirty = true;
    const bool done = plumb_world_step(f->world, (plumb_real)f->dt) == PLUMB_OK;
    look_at(f, out);
    return done;
}

static void list_bodies(frozen *f)
{
    f->count = 0;
    for (int i = 0; i < scene_body_count(f->scene) && f->count < BODIES_MAX; i++) {
        const plumb_body body = scene_body_get(f->scene, i).entity;
        if (plumb_body_get_type(f->world, body) == PLUMB_DYNAMIC &&
            plumb_body_is_enabled(f->world, body) && plumb_body_is_awake(f->world, body)) {
            f->mass[f->count] = (double)plumb_body_mass(f->world, body);
            f->inertia[f->count] = (double)plumb_body_inertia(f->world, body);
            f->bodies[f->count++] = body;
        }
    }
}

static void foresee_flight(frozen *f)
{
    const plumb_vec2 gravity = plumb_world_gravity(f->world);
    look_at(f, f->flight);
    for (int i = 0; i < f->count; i++) {
        const double scale = (double)plumb_body_gravity_scale(f->world, f->bodies[i]);
        f->flight[i].x += f->dt * scale * (double)gravity.x;
        f->flight[i].y += f->dt * scale * (double)gravity.y;
    }
}

// Solvers begin with nothing.
static void forget_impulses(plumb_world *world)
{
    for (uint32_t i = 0; i < world->broad.pairs.count; i++) {
        pl_pair_forget(pl_pairs(&world->broad.pairs) + i);
    }
    for (uint32_t i = 0; i < world->joints.count; i++) {
        pl_joint *joint = pl_joint_items(&world->joints) + i;
        memset(joint->impulse, 0, sizeof joint->impulse);
    }
}

// Runs the scene for a share of its first three seconds. False: nothing to study.
static bool freeze(frozen *f, const char *path, double share, bool *broken)
{
    scene_error error;
    if (scene_load(&(scene_options){ .path = path, .no_expect = true }, &f->scene, &error) !=
        SCENE_OK) {
        cli_message("%s", error.text);
        *broken = true;
        return false;
    }
    const scene_info info = scene_get_info(f->scene);
    f->world = scene_world(f->scene);
    f->world->desc.no_sleep = true; // what sleeps would be no problem
    const double until = share * fmin((double)info.duration, 3);
    while (!scene_done(f->scene) && scene_time(f->scene) < until) {
        if (scene_step(f->scene, &error) != SCENE_OK) {
            cli_message("%s", error.text);
            *broken = true;
            return false;
        }
    }
    f->dt = (double)info.dt;
    list_bodies(f);
    foresee_flight(f);
    forget_impulses(f->world);
    const plumb_stats stats = plumb_world_stats(f->world);
    f->size = plumb_world_snapshot_size(f->world);
    f->image = malloc(f->size);
    return f->image != NULL && f->count > 0 && f->count < BODIES_MAX && stats.point_count > 0 &&
           stats.point_count < POINTS_MAX &&
           plumb_world_save(f->world, f->image, f->size) == PLUMB_OK;
}

static void thaw(frozen *f)
{
    scene_destroy(f->scene);
    free(f->image);
    free(f);
}

// ------------------------------------------------------------------------------------------- study

// The exact answer, and how much of the motion contacts and joints made. False: it missed its tolerance.
static bool answer(frozen *f, int substeps, motion *exact, double *done)
{
    if (!step_from(f, PLUMB_SOLVER_EXACT, substeps, 1, exact) ||
        plumb_world_stats(f->world).exact_missed > 0) {
        return false;
    }
    *done = distance(f, exact, f->flight);
    return *done > 0;
}

static bool climb(frozen *f, problem *p)
{
    static motion exact[BODIES_MAX], here[BODIES_MAX];
    for (int l = 0; l < LADDERS; l++) {
        double done = 0;
        for (int r = 0; r < RUNGS; r++) {
            const int k = 1 << r, substeps = ladders[l].by_substeps ? k : 1;
            if (((r == 0 || ladders[l].by_substeps) && !answer(f, substeps, exact, &done)) ||
                !step_from(f, ladders[l].solver, substeps, ladders[l].by_substeps ? 1 : k, here)) {
                return false;
            }
            p->error[l][r] = distance(f, here, exact) / done;
        }
    }
    return true;
}

static void study_scene(study *s, const char *path, double share)
{
    frozen *f = calloc(1, sizeof *f);
    if (f == NULL || s->count == PROBLEMS_MAX) {
        free(f);
        return;
    }
    problem *p = &s->problems[s->count];
    const char *base = strrchr(path, '/');
    snprintf(p->name, sizeof p->name, "%s", base != NULL ? base + 1 : path);
    p->name[strcspn(p->name, ".")] = '\0';
    if (freeze(f, path, share, &s->broken)) {
        p->bodies = (unsigned)f->count;
        p->points = plumb_world_stats(f->world).point_count;
        const bool known = climb(f, p);
        s->count += known;
        s->skipped += !known;
    } else {
        s->skipped++;
    }
    thaw(f);
}

// ------------------------------------------------------------------------------------------- told

static int by_value(const void *a, const void *b)
{
    const double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

// The error below which a share of the problems is.
static double quantile(const study *s, int l, int r, double share)
{
    double errors[PROBLEMS_MAX];
    for (int i = 0; i < s->count; i++) {
        errors[i] = s->problems[i].error[l][r];
    }
    qsort(errors, (size_t)s->count, sizeof errors[0], by_value);
    return errors[(int)(share * (s->count - 1) + 0.5)];
}

static void put_table(FILE *file, const study *s)
{
    fprintf(file, "| median / nine in ten, k = |");
    for (int r = 0; r < RUNGS; r++) {
        fprintf(file, " %d |", 1 << r);
    }
    fprintf(file, "\n|---|");
    for (int r = 0; r < RUNGS; r++) {
        fprintf(file, "---|");
    }
    for (int l = 0; l < LADDERS; l++) {
        fprintf(file, "\n| %s |", ladders[l].name);
        for (int r = 0; r < RUNGS; r++) {
            fprintf(file, " %.1e / %.1e |", quantile(s, l, r, 0.5), quantile(s, l, r, 0.9));
        }
    }
    fprintf(file,
            "\n\n%d problems (%d moments left out: nothing touches, more than %d points do, or the "
            "exact solver has no answer); error of all "
            "velocities after one step, as a share of what contacts and joints do in it.\n",
            s->count, s->skipped, POINTS_MAX);
}

static void put_csv(FILE *file, const study *s)
{
    fprintf(file, "problem,bodies,points,ladder,k,error\n");
    for (int i = 0; i < s->count; i++) {
        const problem *p = &s->problems[i];
        for (int c = 0; c < LADDERS * RUNGS; c++) {
            fprintf(file, "%s,%u,%u,\"%s\",%d,%.6g\n", p->name, p->bodies, p->points,
                    ladders[c / RUNGS].name, 1 << c % RUNGS, p->error[c / RUNGS][c % RUNGS]);
        }
    }
}

static void put_chart(FILE *script, const char *path, const void *context)
{
    const study *s = context;
    cost_put_terminal(script, path, 900, 440);
    fprintf(script,
            "set title '{/:Bold Frozen contact problems}   one step of %d states of scenes, "
            "against the exact solver'\n"
            "set logscale x 2\nset logscale y\nset xrange [0.9:%g]\nset yrange [5e-4:1.5]\n"
            "set format y '10^{%%T}'\nset xlabel 'k'\nset ylabel 'error of all velocities'\n",
            s->count, 1.1 * (1 << (RUNGS - 1)));
    for (int l = 0; l < LADDERS; l++) {
        fprintf(script, "$d%d << EOD\n", l);
        for (int r = 0; r < RUNGS; r++) {
            fprintf(script, "%d %.6g %.6g\n", 1 << r, quantile(s, l, r, 0.5),
                    quantile(s, l, r, 0.9));
        }
        fprintf(script, "EOD\n");
    }
    fprintf(script, "plot ");
    for (int l = 0; l < LADDERS; l++) {
        fprintf(script,
                "%s$d%d using 1:2 with linespoints lw 2.5 pt 7 lc rgb '%s' title '%s: median', "
                "$d%d using 1:3 with lines lw 1.5 dt 2 lc rgb '%s' title 'nine in ten'",
                l > 0 ? ", " : "", l, ladders[l].hue, ladders[l].name, l, ladders[l].hue);
    }
    fprintf(script, "\n");
}

static int write_file(const study *s, const char *name, void (*put)(FILE *file, const study *s))
{
    char path[512];
    cli_output out;
    snprintf(path, sizeof path, "%s/%s", s->folder, name);
    const int code = cli_output_open(&out, path);
    if (code != CLI_OK) {
        return code;
    }
    put(out.file, s);
    return cli_output_close(&out, true);
}

int main(int argc, char **argv)
{
    static study s = { .folder = "build/cost" };
    catch_interrupts();
    int first = 1;
    if (argc > 2 && strcmp(argv[1], "--folder") == 0) {
        s.folder = argv[2];
        first = 3;
    }
    if (first >= argc) {
        fprintf(stderr, "usage: cost-frozen [--folder DIR] SCENE...\n");
        return CLI_USAGE;
    }
    static const double shares[] = { 0.5, 0.15, 0.85 };
    for (int k = 0; k < 3; k++) {
        for (int i = first; i < argc && !s.broken && !cli_interrupted(); i++) {
            study_scene(&s, argv[i], shares[k]);
        }
    }
    if (s.broken || cli_interrupted()) {
        return s.broken ? CLI_SCENE : CLI_FAILED;
    }
    if (s.count == 0) {
        cli_message("none of the scenes holds a contact problem with an exact answer");
        return CLI_FAILED;
    }
    put_table(stdout, &s);
    char path[512];
    int code = write_file(&s, "frozen.md", put_table);
    code = code == CLI_OK ? write_file(&s, "frozen.csv", put_csv) : code;
    snprintf(path, sizeof path, "%s/frozen.svg", s.folder);
    code = code == CLI_OK ? cost_draw(path, put_chart, &s) : code;
    snprintf(path, sizeof path, "%s/frozen.png", s.folder);
    code = code == CLI_OK ? cost_draw(path, put_chart, &s) : code;
    return cli_finish(code);
}
