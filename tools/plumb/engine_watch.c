/// engine_watch.c - alarms of the watchdog in words, with the names that the scene gave. Compiled once for each precision, as
/// engine.c.
///
/// Reads the last step's alarms by the public interface. Cost: O(alarms); O(bodies) for each where there is one.
#include "engine_session.h"

#include <string.h>

static const char *body_name(const engine_session *session, plumb_body body)
{
    return plumb_is_null(body) ? "the world" : scene_body_of(session->stage.scene, body).name;
}

static const char *joint_name(const engine_session *session, plumb_joint joint)
{
    const scene *s = session->stage.scene;
    for (int i = 0; i < scene_joint_count(s); i++) {
        if (plumb_same(scene_joint_get(s, i).entity, joint)) {
            return scene_joint_get(s, i).name;
        }
    }
    return "?";
}

/// Who, and what it has to do with: "'crate' and 'ground'".
static void write_who(const engine_session *session, const plumb_alarm *a, char *text, size_t size)
{
    if (!plumb_is_null(a->joint)) {
        snprintf(text, size, "'%.60s' of '%.60s'", joint_name(session, a->joint),
                 body_name(session, a->body));
    } else if (!plumb_is_null(a->other)) {
        snprintf(text, size, "'%.60s' and '%.60s'", body_name(session, a->body),
                 body_name(session, a->other));
    } else {
        snprintf(text, size, "'%.60s'", body_name(session, a->body));
    }
}

static void write_alarm(const engine_session *session, const plumb_alarm *a, engine_alarm *out)
{
    char who[160], unit[8] = "", called[112] = "nothing was called";
    const char *of = plumb_alarm_unit(a->kind);
    write_who(session, a, who, sizeof who);
    if (strcmp(of, "1") != 0) {
        snprintf(unit, sizeof unit, " %s", of);
    }
    if (a->command[0] != '\0') {
        snprintf(called, sizeof called, "last call %.80s at step %llu", a->command,
                 (unsigned long long)a->command_step);
    }
    out->number = (int)a->kind;
    out->kind = plumb_alarm_name(a->kind);
    out->advice = plumb_alarm_advice(a->kind);
    snprintf(out->text, sizeof out->text,
             "%s: %.3g%s (bound %.3g%s) in step %llu, %.6g s, '%s'%s%s; %s", who, (double)a->value,
             unit, (double)a->bound, unit, (unsigned long long)a->step, a->time, a->pass,
             a->work[0] != '\0' ? " by " : "", a->work, called);
}

int pl_session_alarms(engine_session *session, const engine_alarm **list)
{
    int count;
    const plumb_alarm *alarms = plumb_world_alarms(session->stage.world, &count);
    if (!pl_session_reserve(&session->alarms, &session->alarm_room, count,
                            sizeof *session->alarms)) {
        return -1;
    }
    for (int i = 0; i < count; i++) {
        write_alarm(session, &alarms[i], &session->alarms[i]);
    }
    *list = session->alarms;
    return count;
}
