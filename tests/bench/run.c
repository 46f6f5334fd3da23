// run.c - runs an engine on a scene in a forked child: a crash ends the child only, and the growth
// of the child's resident set is the memory of that world.
// Reads: the scene. Writes: the result, through a pipe. Cost: the steps.
#define _GNU_SOURCE // sched_setaffinity
#include "run.h"

#include "penetration.h"
#include "separation.h"

#include <math.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static const double dt = 1.0 / 60.0; // [s] of every scene

// [s] processor time after which a child is ended: a hundred times the slowest scene known.
enum { cpu_limit = 3600 };

typedef void body_fn(const struct scene_row *row, const struct scene *scene,
                     const struct contender *contender, const struct run_settings *settings,
                     struct run_result *result);

static int run_steps(const struct scene_row *row, const struct run_settings *settings)
{
    double steps = round(row->steps * settings->steps_scale);
    return steps < 1.0 ? 1 : (int)steps;
}

static double now_ms(const struct run_settings *settings)
{
    struct timespec t;
    clock_gettime(settings->cpu_clock ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static long peak_resident(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss * 1024L; // Linux counts KiB
}

static struct engine_world *open_world(const struct scene *scene, const struct contender *contender,
                                       const struct run_settings *settings)
{
    struct engine_options options = engine_options_default();
    options.gravity_y = scene->gravity_y;
    options.substeps = settings->substeps;
    options.sleep = settings->sleep && scene->sleeps;
    options.width = contender->width;
    options.workers = contender->workers;
    options.solver = contender->solver;
    return contender->engine->create(&options);
}

// Everything that happens to the world before a step. False with the status set when it fails.
static bool before_step(const struct scene_row *row, const struct scene *scene,
                        const struct engine *engine, struct engine_world *world,
                        struct scene_cursor *cursor, int step, struct run_result *result)
{
    int status = scene_advance(scene, engine, world, cursor, step);
    if (status != ENGINE_OK) {
        result->status = status == ENGINE_UNSUPPORTED ? RUN_UNSUPPORTED : RUN_FAILED;
        return false;
    }
    if (row->before_step != NULL) {
        row->before_step(scene, engine, world, step, dt);
    }
    return true;
}

// Touches the engine's code and its fixed buffers, so that they are not taken for the scene's.
static void warm_up(const struct scene *scene, const struct contender *contender,
                    const struct run_settings *settings)
{
    const struct engine *engine = contender->engine;
    struct engine_world *world = open_world(scene, contender, settings);
    if (world == NULL) {
        return;
    }
    struct engine_body_def def = { .type = ENGINE_STATIC };
    int ground = engine->add_body(world, &def);
    engine->add_segment(world, ground, &engine_material_default, -1.0, 0.0, 1.0, 0.0);
    const double x[4] = { -0.5, 0.5, 0.5, -0.5 };
    const double y[4] = { 0.0, 0.0, 1.0, 1.0 };
    def.type = ENGINE_DYNAMIC;
    int box = engine->add_body(world, &def);
    engine->add_polygon(world, box, &engine_material_default, x, y, 4, 0.0);
    for (int i = 0; i < 10; ++i) {
        engine->step(world, dt);
    }
    engine->destroy(world);
}

static void timed_body(const struct scene_row *row, const struct scene *scene,
                       const struct contender *contender, const struct run_settings *settings,
                       struct run_result *result)
{
    const struct engine *engine = contender->engine;
    warm_up(scene, contender, settings);
    long before = peak_resident();
    struct engine_world *world = open_world(scene, contender, settings);
    if (world == NULL) {
        return;
    }
    struct scene_cursor cursor = { 0 };
    int steps = run_steps(row, settings);
    double total = 0.0;
    for (int i = 0; i < row->settle + steps; ++i) {
        if (!before_step(row, scene, engine, world, &cursor, i, result)) {
            return;
        }
        double from = now_ms(settings);
        engine->step(world, dt);
        double spent = now_ms(settings) - from;
        if (i >= row->settle) {
            total += spent;
            result->worst_ms = fmax(result->worst_ms, spent);
        }
    }
    result->mean_ms = total / steps;
    result->peak_bytes = peak_resident() - before;
    result->engine_bytes = engine->bytes(world);
    result->status = RUN_DONE;
}

// Adds one moment to a run. False when memory runs out.
static bool add_moment(const struct scene *scene, const struct engine_pose *poses, int step,
                       double skin, struct overlap *run, long *astray)
{
    struct penetration now;
    if (!penetration_measure(scene, poses, step, skin, &now)) {
        return false;
    }
    run->sum += now.sum;
    run->pairs += now.pairs;
    run->mean = run->pairs > 0 ? run->sum / (double)run->pairs : 0.0;
    run->max = fmax(run->max, now.max);
    run->end_mean = now.pairs > 0 ? now.sum / (double)now.pairs : 0.0;
    run->end_p99 = now.p99;
    run->end_pairs = now.pairs;
    *astray = now.astray;
    return true;
}

static void add_separation(struct separation now, struct apart *run)
{
    run->sum += now.sum;
    run->hinges += now.hinges;
    run->mean = run->hinges > 0 ? run->sum / (double)run->hinges : 0.0;
    run->max = fmax(run->max, now.max);
    run->end_mean = now.hinges > 0 ? now.sum / (double)now.hinges : 0.0;
    run->end_max = now.max;
}

static bool sample(const struct scene *scene, const struct engine *engine,
                   const struct engine_world *world, int step, struct engine_pose *poses,
                   struct run_result *result)
{
    for (int i = 0; i < scene->body_count; ++i) {
        if (scene_has(scene, i, step)) {
            poses[i] = engine->get_pose(world, i);
        }
    }
    add_separation(separation_measure(scene, poses, step), &result->apart);
    if (!add_moment(scene, poses, step, 0.0, &result->drawn, &result->astray)) {
        return false;
    }
    if (!(result->skin > 0.0)) {
        result->own = result->drawn;
        return true;
    }
    return add_moment(scene, poses, step, result->skin, &result->own, &result->astray);
}

static void quality_body(const struct scene_row *row, const struct scene *scene,
                         const struct contender *contender, const struct run_settings *settings,
                         struct run_result *result)
{
    const struct engine *engine = contender->engine;
    struct engine_pose *poses = calloc((size_t)scene->body_count, sizeof *poses);
    struct engine_world *world = open_world(scene, contender, settings);
    if (world == NULL || poses == NULL) {
        return;
    }
    struct scene_cursor cursor = { 0 };
    result->skin = engine->skin(world);
    int steps = run_steps(row, settings);
    bool measured = true;
    for (int i = 0; i < steps && measured; ++i) {
        if (!before_step(row, scene, engine, world, &cursor, i, result)) {
            return;
        }
        engine->step(world, dt);
        if ((i + 1) % settings->sample_every == 0 || i + 1 == steps) {
            measured = sample(scene, engine, world, i, poses, result);
        }
    }
    result->counts = engine->counts(world);
    result->status = measured ? RUN_DONE : RUN_FAILED;
}

static void be_child(body_fn *body, const struct scene_row *row, const struct scene *scene,
                     const struct contender *contender, const struct run_settings *settings,
                     int out)
{
    struct rlimit limit = { cpu_limit, cpu_limit };
    setrlimit(RLIMIT_CPU, &limit);
    if (settings->core >= 0) {
        cpu_set_t set;
        CPU_ZERO(&set);
        for (int i = 0; i == 0 || i < contender->workers; ++i) {
            CPU_SET((size_t)(settings->core + i), &set);
        }
        sched_setaffinity(0, sizeof set, &set);
    }
    struct run_result result;
    memset(&result, 0, sizeof result);
    result.status = RUN_FAILED;
    body(row, scene, contender, settings, &result);
    // Less than PIPE_BUF, so it goes as one piece or not at all.
    ssize_t written = write(out, &result, sizeof result);
    _exit(written == (ssize_t)sizeof result ? 0 : 1);
}

static struct run_result in_child(body_fn *body, const struct scene_row *row,
                                  const struct scene *scene, const struct contender *contender,
                                  const struct run_settings *settings)
{
    struct run_result result;
    memset(&result, 0, sizeof result);
    result.status = RUN_FAILED;
    int ends[2];
    if (pipe(ends) != 0) {
        return result;
    }
    pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
        be_child(body, row, scene, contender, settings, ends[1]);
    }
    close(ends[1]);
    struct run_result heard;
    bool whole = child > 0 && read(ends[0], &heard, sizeof heard) == (ssize_t)sizeof heard;
    close(ends[0]);
    int status = 0;
    if (child > 0) {
        waitpid(child, &status, 0);
    }
    if (whole) {
        return heard;
    }
    if (child > 0 && WIFSIGNALED(status)) {
        result.status = RUN_CRASHED;
        result.signal = WTERMSIG(status);
    }
    return result;
}

struct run_result run_timed(const struct scene_row *row, const struct scene *scene,
                            const struct contender *contender, const struct run_settings *settings)
{
    return in_child(timed_body, row, scene, contender, settings);
}

struct run_result run_quality(const struct scene_row *row, const struct scene *scene,
                              const struct contender *contender,
                              const struct run_settings *settings)
{
    return in_child(quality_body, row, scene, contender, settings);
}
