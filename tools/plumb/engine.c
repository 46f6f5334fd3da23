/// engine.c - engine.h over libplumb and the scene loader. Compiled once for each
/// precision; see README.md for how both get into one program.
///
/// Reads scene files through the loader; writes nothing but what it is asked for. A session's
/// lists are kept from call to call: no allocation once they have grown.
#include "engine_session.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

int pl_session_fail(engine_error *error, int code, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(error->text, sizeof error->text, format, list);
    va_end(list);
    error->code = code;
    return code;
}

/// The loader's error as an exit code: what is wrong with the command line, the scene, the run.
int pl_session_fail_scene(const engine_session *session, const scene_error *from,
                          engine_error *error)
{
    int code = CLI_SCENE;
    // A value that scene{} refuses is the command line's fault, too, when --set gave it.
    if (from->code == SCENE_E_SET || strcmp(from->file, "--set") == 0) {
        code = CLI_USAGE;
    } else if (from->code == SCENE_E_STOPPED || from->code == SCENE_E_IO) {
        code = CLI_FAILED;
    } else if (from->code == SCENE_E_WORLD && session != NULL) {
        plumb_result why = plumb_world_error(session->stage.world).code;
        code = why == PLUMB_E_NOT_FINITE ? CLI_DIVERGED : why == PLUMB_E_MEMORY ? CLI_FAILED : code;
    }
    return pl_session_fail(error, code, "%s", from->text);
}

// ------------------------------------------------------------------------------- open and close

/// Settings of the command line become overrides of scene{}, after the user's own: a later one
/// wins.
enum { OVERRIDE_COUNT = 9, OVERRIDE_SIZE = 48 };

static int write_overrides(const engine_settings *settings, char texts[][OVERRIDE_SIZE])
{
    int count = 0;
    char solver[16];
    if (settings->dt > 0) {
        snprintf(texts[count++], OVERRIDE_SIZE, "dt=%.17g", settings->dt);
    }
    if (settings->substeps > 0) {
        snprintf(texts[count++], OVERRIDE_SIZE, "substeps=%d", settings->substeps);
    }
    if (settings->iterations > 0) {
        snprintf(texts[count++], OVERRIDE_SIZE, "iterations=%d", settings->iterations);
    }
    if (cli_member(ENGINE_SOLVERS, settings->solver, solver, sizeof solver)) {
        snprintf(texts[count++], OVERRIDE_SIZE, "solver=%s", solver);
    }
    if (settings->accuracy != NULL) {
        snprintf(texts[count++], OVERRIDE_SIZE, "accuracy=%s", settings->accuracy);
    }
    if (settings->width > 0) {
        snprintf(texts[count++], OVERRIDE_SIZE, "simd_width=%d", settings->width);
    }
    if (settings->workers > 0) {
        snprintf(texts[count++], OVERRIDE_SIZE, "workers=%d", settings->workers);
    }
    if (settings->watchdog) {
        snprintf(texts[count++], OVERRIDE_SIZE, "watchdog=true");
        snprintf(texts[count++], OVERRIDE_SIZE, "measure=true");
    }
    return count;
}

static bool is_stopped(void *unused)
{
    (void)unused;
    return cli_interrupted();
}

static scene_code load(const engine_settings *settings, scene **out, scene_error *error)
{
    char texts[OVERRIDE_COUNT][OVERRIDE_SIZE];
    int extra = write_overrides(settings, texts);
    int count = settings->set_count + extra;
    const char **sets = calloc((size_t)count + 1, sizeof *sets);
    if (sets == NULL) {
        error->code = SCENE_E_LIMIT;
        snprintf(error->text, sizeof error->text, "%s: out of memory", settings->path);
        return error->code;
    }
    for (int i = 0; i < settings->set_count; i++) {
        sets[i] = settings->sets[i];
    }
    for (int i = 0; i < extra; i++) {
        sets[settings->set_count + i] = texts[i];
    }
    scene_options options = { .path = settings->path,
                              .text = settings->text,
                              .text_size = settings->text != NULL ? strlen(settings->text) : 0,
                              .sets = sets,
                              .set_count = count,
                              .no_expect = settings->no_expect,
                              .worst = settings->worst,
                              .stop = is_stopped };
    if (settings->mover != NULL) {
        options.step = settings->mover->step;
        options.joint_force = settings->mover->joint_force;
        options.step_context = settings->mover->context;
    }
    scene_code code = scene_load(&options, out, error);
    free(sets);
    return code;
}

static engine_session *session_open(const engine_settings *settings, engine_error *error)
{
    scene_error from = { 0 };
    engine_session *session = calloc(1, sizeof *session);
    if (session == NULL) {
        pl_session_fail(error, CLI_FAILED, "out of memory");
        return NULL;
    }
    if (load(settings, &session->stage.scene, &from) != SCENE_OK) {
        pl_session_fail_scene(NULL, &from, error);
        free(session);
        return NULL;
    }
    engine_stage *stage = &session->stage;
    stage->world = scene_world(stage->scene);
    session->is_bare =
        settings->unseen && settings->mover == NULL && scene_activity(stage->scene) == 0;
    stage->info = scene_get_info(stage->scene);
    stage->camera = scene_get_camera(stage->scene);
    return session;
}

static void session_close(engine_session *session)
{
    if (session == NULL) {
        return;
    }
    scene_destroy(session->stage.scene);
    pl_stage_close(&session->stage);
    free(session->expects);
    free(session->overlaps);
    free(session->findings);
    free(session->idle);
    free(session->uses);
    free(session->alarms);
    free(session->passes);
    free(session->pass_infos);
    free(session->kept);
    free(session);
}

static engine_stage *session_stage(engine_session *session)
{
    return &session->stage;
}

// ------------------------------------------------------------------------------------- stepping

static int session_step(engine_session *session, engine_error *error)
{
    scene_error from = { 0 };
    if (session->is_bare) {
        plumb_result result =
            plumb_world_step(session->stage.world, (plumb_real)session->stage.info.dt);
        return result == PLUMB_OK
                   ? CLI_OK
                   : pl_session_fail(error, CLI_FAILED, "%s: a step failed: %s",
                                     session->stage.info.title,
                                     plumb_world_error(session->stage.world).message);
    }
    if (scene_step(session->stage.scene, &from) != SCENE_OK) {
        return pl_session_fail_scene(session, &from, error);
    }
    return session->recording ? pl_session_note_looks(session, error) : CLI_OK;
}

static int session_check(engine_session *session, engine_error *error)
{
    uint32_t stopped = plumb_world_stats(session->stage.world).arrested_count;
    if (stopped > 0) {
        return pl_session_fail(
            error, CLI_DIVERGED,
            "%s: diverged at %.6g s: %u %s taken out, for the step would have left "
            "%s without a finite state",
            session->stage.info.title, scene_time(session->stage.scene), stopped,
            stopped == 1 ? "body was" : "bodies were", stopped == 1 ? "it" : "them");
    }
    return CLI_OK;
}

static bool session_ended(const engine_session *session)
{
    // scene_done is also true once the duration is over; a run may go on after that.
    return scene_done(session->stage.scene) &&
           scene_time(session->stage.scene) <
               session->stage.info.duration - session->stage.info.dt / 2;
}

static int session_finish(engine_session *session, engine_error *error)
{
    scene_error from = { 0 };
    if (scene_finish(session->stage.scene, &from) != SCENE_OK) {
        return pl_session_fail_scene(session, &from, error);
    }
    return CLI_OK;
}

static const char *session_json_lacks(engine_session *session)
{
    (void)scene_json_lacks(session->stage.scene, session->text, sizeof session->text);
    return session->text;
}

static bool session_to_json(const engine_session *session, FILE *file)
{
    return scene_to_json(session->stage.scene, file);
}

#if PLUMB_IS_FAR
#define ENGINE_NAME engine_far
#elif PLUMB_REAL_IS_DOUBLE
#define ENGINE_NAME engine_double
#else
#define ENGINE_NAME engine_float
#endif

const engine_api ENGINE_NAME = {
    .precision = PLUMB_IS_FAR                          ? "far"
                 : sizeof(plumb_real) == sizeof(float) ? "float"
                                                       : "double",
    .is_float = sizeof(plumb_real) == sizeof(float),
    .open = session_open,
    .close = session_close,
    .stage = session_stage,
    .step = session_step,
    .check = session_check,
    .overlaps = pl_session_overlaps,
    .lint = pl_session_lint,
    .alarms = pl_session_alarms,
    .ended = session_ended,
    .finish = session_finish,
    .exact = pl_session_exact,
    .form_error = pl_session_form_error,
    .form = pl_session_form,
    .nudge = pl_session_nudge,
    .expectations = pl_session_expectations,
    .passes = pl_session_passes,
    .because = pl_session_because,
    .note_use = pl_session_note_use,
    .unused = pl_session_unused,
    .lacks = pl_session_lacks,
    .measure = pl_session_measure,
    .word = pl_session_word,
    .json_lacks = session_json_lacks,
    .to_json = session_to_json,
    .record = pl_session_record,
    .record_end = pl_session_record_end,
    .info = pl_stage_info,
    .time = pl_stage_time,
    .stats = pl_stage_stats,
    .accuracy = pl_stage_accuracy,
    .totals = pl_stage_totals,
    .text = pl_stage_text,
    .rows = pl_stage_rows,
    .bounds = pl_stage_bounds,
    .draw = pl_stage_draw,
    .draw_field = pl_stage_draw_field,
    .draw_flow = pl_stage_draw_flow,
    .replay_open = pl_replay_session_open,
    .replay_close = pl_replay_session_close,
    .replay_info = pl_replay_session_info,
    .replay_seek = pl_replay_session_seek,
    .replay_find = pl_replay_session_find,
    .replay_stage = pl_replay_session_stage,
    .replay_edits = pl_replay_session_edits,
    .replay_settings = pl_replay_session_settings,
    .replay_compare = pl_replay_session_compare,
};
