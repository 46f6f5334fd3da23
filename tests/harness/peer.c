// peer.c - a scene of Plumb's loader, moved by another engine (peer.h).
// Brings over what handlers do, writes the motion back into the scene's world. Compiled in double and
// linked with a loader and a libplumb of its own (tools/make/test.mk), as the variants of tools/plumb are.
#include "peer.h"

#include "peer_world.h"

#include <math.h>
#include <stdlib.h>

// ------------------------------------------------------------------------------------- stepping

// What handlers have done to a body since the last step.
static void bring_body(struct peer *p, plumb_world *world, struct pair *pair)
{
    if (!plumb_body_valid(world, pair->body)) {
        p->engine->destroy_body(p->world, pair->other);
        pair->other = -1;
        return;
    }
    plumb_vec2 v = plumb_body_velocity(world, pair->body);
    double w = (double)plumb_body_angular_velocity(world, pair->body);
    bool same = (double)v.x == pair->v[0] && (double)v.y == pair->v[1] && w == pair->v[2];
    if (!same || p->stirred) {
        p->engine->set_velocity(p->world, pair->other, (double)v.x, (double)v.y, w);
        pair->v[0] = (double)v.x;
        pair->v[1] = (double)v.y;
        pair->v[2] = w;
    }
    plumb_vec2 f = plumb_body_force(world, pair->body);
    double torque = (double)plumb_body_torque(world, pair->body);
    if (pair->dynamic && (f.x != 0 || f.y != 0 || torque != 0)) {
        p->engine->apply_force(p->world, pair->other, (double)f.x, (double)f.y, torque);
        (void)plumb_body_clear_forces(world, pair->body);
    }
}

static void bring_motor(struct peer *p, const plumb_world *world, struct tie *tie)
{
    plumb_joint_desc d = { 0 };
    if (!plumb_joint_valid(world, tie->joint) ||
        plumb_joint_settings(world, tie->joint, &d) != PLUMB_OK ||
        (d.enable_motor == tie->motor && (double)d.motor_speed == tie->speed &&
         (double)d.max_motor == tie->max)) {
        return;
    }
    tie->motor = d.enable_motor;
    tie->speed = (double)d.motor_speed;
    tie->max = (double)d.max_motor;
    if (p->engine->set_motor(p->world, tie->other, tie->motor, tie->speed, tie->max) != ENGINE_OK) {
        (void)pl_peer_refuse(p, "motors of slides that handlers switch");
    }
}

// What handlers have done since the last step. Another step wakes everybody, as scenes that ask for one do.
static void bring_over(struct peer *p, plumb_world *world, double dt)
{
    p->stirred = p->last > 0 && dt != p->last;
    p->last = dt;
    for (int i = 0; i < p->count; i++) {
        struct pair *pair = &p->pairs[i];
        if (pair->other >= 0 && pair->moves) {
            if (plumb_body_has_target(world, pair->body)) {
                (void)pl_peer_refuse(p, "targets of kinematic bodies");
            }
            bring_body(p, world, pair);
        }
    }
    for (int i = 0; i < p->tie_count; i++) {
        bring_motor(p, world, &p->ties[i]);
    }
}

static void write_back(struct peer *p, plumb_world *world)
{
    for (int i = 0; i < p->count; i++) {
        struct pair *pair = &p->pairs[i];
        if (pair->other < 0 || !pair->moves) {
            continue;
        }
        struct engine_pose at = p->engine->get_pose(p->world, pair->other);
        struct engine_velocity v = p->engine->get_velocity(p->world, pair->other);
        plumb_vec2 place = { (plumb_real)at.x, (plumb_real)at.y };
        plumb_vec2 velocity = { (plumb_real)v.x, (plumb_real)v.y };
        if (plumb_body_teleport(world, pair->body, place, (plumb_real)at.angle) != PLUMB_OK ||
            plumb_body_set_velocity(world, pair->body, velocity) != PLUMB_OK ||
            plumb_body_set_angular_velocity(world, pair->body, (plumb_real)v.w) != PLUMB_OK) {
            p->diverged = true;
            return;
        }
        // As the world has rounded them.
        velocity = plumb_body_velocity(world, pair->body);
        pair->v[0] = (double)velocity.x;
        pair->v[1] = (double)velocity.y;
        pair->v[2] = (double)plumb_body_angular_velocity(world, pair->body);
    }
}

static void move(void *context, plumb_world *world, double dt)
{
    struct peer *p = context;
    bring_over(p, world, dt);
    if (p->reason[0] != '\0') {
        return; // told by peer_step
    }
    p->engine->step(p->world, dt);
    write_back(p, world);
}

static void joint_force(void *context, plumb_joint joint, double force[2], double *torque)
{
    const struct peer *p = context;
    for (int i = 0; i < p->tie_count; i++) {
        if (p->ties[i].joint.entity.index == joint.entity.index) {
            p->engine->joint_force(p->world, p->ties[i].other, force, torque);
        }
    }
}

// ----------------------------------------------------------------------------- the engine's table

static void peer_close(engine_session *session)
{
    struct peer *p = session != NULL ? session->mover : NULL;
    engine_double.close(session);
    if (p != NULL) {
        if (p->world != NULL) {
            p->engine->destroy(p->world);
        }
        free(p->pairs);
        free(p);
    }
}

static engine_session *peer_open(const struct engine *engine, const engine_settings *settings,
                                 engine_error *error)
{
    struct peer *p = calloc(1, sizeof *p);
    engine_settings of_scene = *settings;
    of_scene.solver = -1; // `solver` is the peer's own
    if (p == NULL) {
        pl_session_fail(error, CLI_FAILED, "out of memory");
        return NULL;
    }
    p->engine = engine;
    p->mover = (engine_mover){ move, joint_force, p };
    of_scene.mover = &p->mover;
    engine_session *session = engine_double.open(&of_scene, error);
    if (session == NULL) {
        free(p);
        return NULL;
    }
    session->mover = p;
    if (!pl_peer_build(p, settings, session->stage.scene)) {
        pl_session_fail(error, CLI_FAILED, "%s", p->reason);
        peer_close(session);
        return NULL;
    }
    return session;
}

static int peer_step(engine_session *session, engine_error *error)
{
    struct peer *p = session->mover;
    if (p->bare) {
        p->engine->step(p->world, p->dt);
        return CLI_OK;
    }
    int code = engine_double.step(session, error);
    if (p->reason[0] != '\0') {
        return pl_session_fail(error, CLI_FAILED, "%s", p->reason);
    }
    return code;
}

static int peer_check(engine_session *session, engine_error *error)
{
    const struct peer *p = session->mover;
    if (p->diverged) {
        return pl_session_fail(error, CLI_DIVERGED, "diverged");
    }
    return CLI_OK;
}

static engine_stage *peer_stage(engine_session *session)
{
    return engine_double.stage(session);
}

static int peer_finish(engine_session *session, engine_error *error)
{
    return engine_double.finish(session, error);
}

static bool peer_ended(const engine_session *session)
{
    const struct peer *p = session->mover;
    return !p->bare && engine_double.ended(session);
}

#define PEER(name)                                                                                 \
    static engine_session *open_##name(const engine_settings *settings, engine_error *error)       \
    {                                                                                              \
        return peer_open(&engine_##name, settings, error);                                         \
    }                                                                                              \
    const engine_api peer_##name = { .precision = "double",                                        \
                                     .open = open_##name,                                          \
                                     .close = peer_close,                                          \
                                     .stage = peer_stage,                                          \
                                     .step = peer_step,                                            \
                                     .check = peer_check,                                          \
                                     .ended = peer_ended,                                          \
                                     .finish = peer_finish,                                        \
                                     .expectations = pl_session_expectations,                      \
                                     .form_error = pl_session_form_error,                          \
                                     .form = pl_session_form,                                      \
                                     .info = pl_stage_info,                                        \
                                     .time = pl_stage_time,                                        \
                                     .stats = pl_stage_stats,                                      \
                                     .rows = pl_stage_rows,                                        \
                                     .totals = pl_stage_totals,                                    \
                                     .bounds = pl_stage_bounds }

PEER(box2d2);
PEER(chipmunk);
#ifdef PEER_BOX2D3
PEER(box2d3);
#endif
