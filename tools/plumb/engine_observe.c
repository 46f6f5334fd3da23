/// engine_observe.c - what engine.h tells about a session: closed forms, expectations, passes, measures. Compiled once for each precision, as engine.c.
///
/// Reads the world and the scene, changes neither. The lists belong to the session and are reused:
/// no allocation once they have grown.
#include "engine_session.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool pl_session_reserve(void *list, size_t *room, int count, size_t size)
{
    void *items;
    size_t wanted = ((size_t)count + 1) * size;
    if (wanted <= *room) {
        return true;
    }
    wanted += wanted / 2; // bodies tend to come one by one
    memcpy(&items, list, sizeof items);
    items = realloc(items, wanted);
    if (items == NULL) {
        return false;
    }
    memcpy(list, &items, sizeof items);
    *room = wanted;
    return true;
}

int pl_session_exact(engine_session *session, double *distance, engine_error *error)
{
    *distance = -1;
    for (int i = 0; i < scene_exact_count(session->stage.scene); i++) {
        double d;
        scene_error from = { 0 };
        if (scene_exact_error(session->stage.scene, i, &d, &from) != SCENE_OK) {
            return pl_session_fail_scene(session, &from, error);
        }
        *distance = d > *distance || isnan(d) ? d : *distance;
    }
    return CLI_OK;
}

int pl_session_expectations(engine_session *session, const engine_expect **list)
{
    int count = scene_expect_count(session->stage.scene);
    if (!pl_session_reserve(&session->expects, &session->expect_room, count,
                            sizeof *session->expects)) {
        return -1;
    }
    for (int i = 0; i < count; i++) {
        scene_expect_result r = scene_expect_get(session->stage.scene, i);
        session->expects[i] = (engine_expect){
            .name = r.name,
            .passed = r.passed,
            .reached = r.status == SCENE_EXPECT_PASSED || r.status == SCENE_EXPECT_FAILED,
            .text = r.description,
            .quantity = r.quantity,
            .unit = r.unit,
            .measured = r.measured,
            .limit = r.limit,
            .time = r.time,
        };
    }
    *list = session->expects;
    return count;
}

int pl_session_passes(engine_session *session, const engine_pass **list)
{
    // From the first look at the passes on their times are taken.
    (void)plumb_world_watch(session->stage.world, PLUMB_WATCH_TIMES);
    int count = plumb_world_schedule(session->stage.world, NULL, 0);
    if (!pl_session_reserve(&session->pass_infos, &session->info_room, count,
                            sizeof *session->pass_infos) ||
        !pl_session_reserve(&session->passes, &session->pass_room, count,
                            sizeof *session->passes)) {
        return -1;
    }
    plumb_pass_info *infos = session->pass_infos;
    engine_pass *passes = session->passes;
    plumb_world_schedule(session->stage.world, infos, count);
    for (int i = 0; i < count; i++) {
        const plumb_pass_info *p = &infos[i];
        passes[i] = (engine_pass){
            .name = p->name,
            .phase = p->phase,
            .reads = p->reads != NULL ? p->reads : "",
            .writes = p->writes != NULL ? p->writes : "",
            .reason = p->reason != NULL ? p->reason : "",
            .scheduled = p->scheduled,
            .variant_count = p->variant_count,
            .is_user = p->is_user,
            .in_substeps = p->in_substeps,
            .total_ns = p->total_ns,
        };
        memcpy(passes[i].variants, p->variants, sizeof p->variants);
        passes[i].away_count = p->away_count;
        memcpy(passes[i].away, p->away, sizeof p->away);
    }
    *list = passes;
    return count;
}

static void raise_to(double *most, double value)
{
    *most = value > *most ? value : *most;
}

void pl_session_measure(engine_session *session, engine_measures *sum)
{
    plumb_world *world = session->stage.world;
    const plumb_measures *m = plumb_world_measures(world);
    (void)plumb_world_set_measure(world, true);
    sum->count = PLUMB_WORKS < ENGINE_WORKS ? PLUMB_WORKS : ENGINE_WORKS;
    for (int i = 0; i < sum->count; i++) {
        sum->works[i].name = plumb_work_name((plumb_work)i);
        sum->works[i].text = plumb_work_text((plumb_work)i);
        sum->works[i].kinetic += m->work[i].kinetic;
        sum->works[i].potential += m->work[i].potential;
    }
    if (m->step == 0) {
        return;
    }
    sum->before = sum->steps++ == 0 ? m->before : sum->before;
    sum->after = m->after;
    raise_to(&sum->gap, m->gap);
    raise_to(&sum->approach, m->approach);
    raise_to(&sum->complementarity, m->complementarity);
    raise_to(&sum->cone, m->cone);
    raise_to(&sum->momentum, m->momentum);
    raise_to(&sum->joint_length, m->joint_length);
    raise_to(&sum->joint_angle, m->joint_angle);
}
