/// engine_lint.h - what the rules of `plumb check --lint` have in common: the scene that they look at, and where they tell what they
/// find. Compiled once for each precision, as engine.c.
#ifndef PLUMB_ENGINE_LINT_H
#define PLUMB_ENGINE_LINT_H

#include "engine_session.h"
#include "lint.h"

/// [-] what is rounded in the bounds of rules.
#define LINT_SLACK 1e-3

typedef struct lint_job {
    engine_session *session;
    const scene *scene;
    plumb_world *world; ///< a copy with its contacts
    plumb_world_desc desc;
    const char *rule;
    double dt, rate; ///< [s] step, [1/s] substeps
    int found;
    bool failed; ///< out of memory
} lint_job;

/// One finding of the rule that is looking.
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void pl_lint_tell(lint_job *job, const char *format, ...);

int pl_lint_body_count(const lint_job *job);
plumb_body pl_lint_body_at(const lint_job *job, int i);
/// "the world" of a null body.
const char *pl_lint_name_of(const lint_job *job, plumb_body body);
bool pl_lint_is_dynamic(const lint_job *job, plumb_body body);
/// The shapes of a body, until the next call; their number.
int pl_lint_shapes_of(const lint_job *job, plumb_body body, plumb_shape **list);
/// [m] of the thickest piece of a body that is solid; -1: none is.
double pl_lint_thickness(const lint_job *job, plumb_body body);

#define LINT_LOOKS(name, look, text, advice) void pl_lint_##look(lint_job *job);
LINT_RULES(LINT_LOOKS)
#undef LINT_LOOKS

#endif
