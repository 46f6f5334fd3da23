/// engine_measure.c - what `plumb cost` asks of a session: closed forms one by one, sums over all bodies, a start that is a
/// little elsewhere. Compiled once for each precision, as engine.c.
///
/// Reads the world and the scene; nudge alone changes the world.
#include "engine_session.h"

#include <math.h>
#include <string.h>

int pl_session_form_error(engine_session *session, int i, double *distance, engine_error *error)
{
    scene_error from = { 0 };
    if (scene_exact_error(session->stage.scene, i, distance, &from) != SCENE_OK) {
        return pl_session_fail_scene(session, &from, error);
    }
    return CLI_OK;
}

int pl_session_form(engine_session *session, int i, engine_form *form, engine_error *error)
{
    scene_error from = { 0 };
    scene_exact exact = scene_exact_get(session->stage.scene, i);
    unsigned place = 1u << SCENE_EXACT_X | 1u << SCENE_EXACT_Y | 1u << SCENE_EXACT_ANGLE;
    *form = (engine_form){ .name = exact.name,
                           .unit = exact.unit,
                           .is_motion = exact.given != 0,
                           .is_place = (exact.given & place) != 0 };
    if (scene_exact_truth(session->stage.scene, i, form->value, &form->is_scaled, &from) !=
        SCENE_OK) {
        return pl_session_fail_scene(session, &from, error);
    }
    return CLI_OK;
}

/// Evenly spread over the circle, another one for each body and seed: Weyl's sequence of the golden section.
static double direction_of(int body, unsigned seed)
{
    double turns = 0.6180339887498949 * (body + 1.0) + 0.7548776662466927 * (seed + 1.0);
    return 6.283185307179586 * (turns - floor(turns));
}

void pl_session_nudge(engine_session *session, double distance, unsigned seed)
{
    plumb_world *world = session->stage.world;
    for (int i = 0; i < pl_stage_body_count(&session->stage); i++) {
        plumb_body body = pl_stage_body(&session->stage, i).entity;
        if (plumb_body_get_type(world, body) != PLUMB_DYNAMIC ||
            !plumb_body_is_enabled(world, body) || !plumb_body_is_awake(world, body)) {
            continue;
        }
        double angle = direction_of(i, seed);
        plumb_vec2 at = plumb_body_position(world, body);
        at.x += (plumb_real)(distance * cos(angle));
        at.y += (plumb_real)(distance * sin(angle));
        (void)plumb_body_set_position(world, body, at);
    }
}

engine_totals pl_stage_totals(const engine_stage *stage)
{
    plumb_energy energy = plumb_world_energy(stage->world);
    double mass = 0, x = 0, y = 0, square = 0;
    for (int i = 0; i < pl_stage_body_count(stage); i++) {
        plumb_body body = pl_stage_body(stage, i).entity;
        double m = (double)plumb_body_mass(stage->world, body);
        plumb_vec2 at = plumb_body_center(stage->world, body);
        mass += m;
        x += m * (double)at.x;
        y += m * (double)at.y;
        square += m * ((double)at.x * (double)at.x + (double)at.y * (double)at.y);
    }
    mass = mass > 0 ? mass : 1;
    x /= mass;
    y /= mass;
    return (engine_totals){ .x = x,
                            .y = y,
                            .spread = sqrt(fmax(square / mass - x * x - y * y, 0)),
                            .energy = (double)energy.kinetic + (double)energy.potential };
}
