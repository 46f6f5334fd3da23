/// engine_lint.c - what of a scene, as it begins, is likely to go wrong, and what to do about it. Compiled once for each
/// precision, as engine.c.
///
/// Rules are rows of one table, lint.h, and functions of the files engine_lint_*.c. A rule reads a copy of the scene's
/// world by the public interface and changes nothing. Bounds are those up to which the engine was measured; the constants
/// say where. What a scene does on purpose it allows in a line of its own: `-- lint: allow RULE: why` (lint.c).
///
/// Cost: O(bodies + shapes + joints + contacts), O(contacts of unequal bodies x contacts), O(fast bodies x bodies), O(shapes x different filters).
#include "engine_lint.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

typedef struct lint_rule {
    const char *name, *advice;
    void (*look)(lint_job *job);
} lint_rule;

void pl_lint_tell(lint_job *job, const char *format, ...)
{
    engine_session *s = job->session;
    if (!pl_session_reserve(&s->findings, &s->finding_room, job->found + 1, sizeof *s->findings)) {
        job->failed = true;
        return;
    }
    engine_finding *made = &s->findings[job->found++];
    *made = (engine_finding){ .rule = job->rule };
    va_list list;
    va_start(list, format);
    vsnprintf(made->text, sizeof made->text, format, list);
    va_end(list);
}

//---- what is asked of bodies -----------------------------------------------------------------------

int pl_lint_body_count(const lint_job *job)
{
    return scene_body_count(job->scene);
}

plumb_body pl_lint_body_at(const lint_job *job, int i)
{
    return scene_body_get(job->scene, i).entity;
}

const char *pl_lint_name_of(const lint_job *job, plumb_body body)
{
    return plumb_is_null(body) ? "the world" : scene_body_of(job->scene, body).name;
}

bool pl_lint_is_dynamic(const lint_job *job, plumb_body body)
{
    return !plumb_is_null(body) && plumb_body_is_enabled(job->world, body) &&
           plumb_body_get_type(job->world, body) == PLUMB_DYNAMIC;
}

/// [m] across a convex piece where it is thinnest, its radius included. Lines have none.
static double width_of(const plumb_convex *c)
{
    double least = c->count > 2 ? HUGE_VAL : 0;
    for (int i = 0; i < c->count && c->count > 2; i++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int k = 0; k < c->count; k++) {
            const double d = (double)c->normals[i].x * (double)c->points[k].x +
                             (double)c->normals[i].y * (double)c->points[k].y;
            low = fmin(low, d);
            high = fmax(high, d);
        }
        least = fmin(least, high - low);
    }
    return least + 2 * (double)c->radius;
}

/// The shapes of a body; their number.
int pl_lint_shapes_of(const lint_job *job, plumb_body body, plumb_shape **list)
{
    engine_stage *stage = &job->session->stage;
    const int count = plumb_body_shapes(job->world, body, NULL, 0);
    if (!pl_session_reserve(&stage->shapes, &stage->shape_room, count, sizeof *stage->shapes)) {
        return 0;
    }
    *list = stage->shapes;
    return plumb_body_shapes(job->world, body, stage->shapes, count);
}

/// [m] of the thickest piece of a body that is solid; -1: none is.
double pl_lint_thickness(const lint_job *job, plumb_body body)
{
    plumb_shape *list;
    double most = -1;
    const int count = pl_lint_shapes_of(job, body, &list);
    for (int i = 0; i < count; i++) {
        const int pieces = plumb_shape_is_sensor(job->world, list[i])
                               ? 0
                               : plumb_shape_piece_count(job->world, list[i]);
        for (int p = 0; p < pieces; p++) {
            plumb_convex piece;
            if (plumb_shape_piece(job->world, list[i], p, &piece, NULL) == PLUMB_OK) {
                most = fmax(most, width_of(&piece));
            }
        }
    }
    return most;
}

//---- the table -------------------------------------------------------------------------------------

static const lint_rule rules[] = {
#define ROW(name, look, text, advice) { name, advice, pl_lint_##look },
    LINT_RULES(ROW)
#undef ROW
};

enum { RULES = sizeof rules / sizeof rules[0] };

int pl_session_lint(engine_session *session, const engine_finding **list)
{
    engine_stage *stage = &session->stage;
    lint_job job = { .session = session,
                     .scene = stage->scene,
                     .world = pl_stage_refreshed(stage),
                     .desc = plumb_world_settings(stage->world),
                     .dt = stage->info.dt };
    job.rate = job.desc.substeps / job.dt;
    const int contacts = job.world != NULL ? plumb_world_contacts(job.world, NULL, 0) : 0;
    job.failed = job.world == NULL || !pl_session_reserve(&stage->contacts, &stage->contact_room,
                                                          contacts, sizeof *stage->contacts);
    if (!job.failed) {
        plumb_world_contacts(job.world, stage->contacts, contacts);
    }
    for (int i = 0; i < RULES && !job.failed; i++) {
        const int before = job.found;
        job.rule = rules[i].name;
        rules[i].look(&job);
        for (int k = before; k < job.found; k++) {
            session->findings[k].advice = rules[i].advice;
        }
    }
    plumb_world_destroy(job.world);
    *list = session->findings;
    return job.failed ? -1 : job.found;
}
