/// engine_unused.c - what of a scene was of no use. Compiled once for each precision, as engine.c.
///
/// Reads a scene's world by the public interface. Cost: O(bodies + shapes + joints) a step.
#include "engine_session.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/// Of a body: the most in any step that was noted.
typedef struct session_use {
    double speed, spin;
    bool touched, visited,
        immersed; ///< it met something; somebody was in its sensor, a dynamic body in its fluid
} session_use;

static session_use *use_of(engine_session *session, plumb_body body)
{
    const uint32_t i = body.entity.index;
    if (i >= session->use_count) {
        const uint32_t count = 2 * i + 64;
        session_use *grown = realloc(session->uses, count * sizeof *grown);
        if (grown == NULL) {
            return NULL;
        }
        memset(grown + session->use_count, 0, (count - session->use_count) * sizeof *grown);
        session->uses = grown;
        session->use_count = count;
    }
    return &session->uses[i];
}

// False when out of memory.
static bool note_visitors(engine_stage *stage, plumb_body body, session_use *use)
{
    const int count = plumb_body_shapes(stage->world, body, NULL, 0);
    for (int k = 0; k < count; k++) {
        const bool sensor = plumb_shape_is_sensor(stage->world, stage->shapes[k]);
        const int seen = sensor ? pl_stage_seen(stage, stage->shapes[k]) : 0;
        if (seen < 0) {
            return false;
        }
        use->visited |= seen > 0;
        for (int n = 0; n < seen; n++) {
            const plumb_body visitor = plumb_shape_body(stage->world, stage->seen[n]);
            use->immersed |= plumb_body_get_type(stage->world, visitor) == PLUMB_DYNAMIC;
        }
    }
    return true;
}

bool pl_session_note_use(engine_session *session)
{
    engine_stage *stage = &session->stage;
    plumb_world *w = stage->world;
    for (int i = 0; i < scene_body_count(stage->scene); i++) {
        const plumb_body body = scene_body_get(stage->scene, i).entity;
        const plumb_vec2 v = plumb_body_velocity(w, body);
        session_use *use = use_of(session, body);
        if (use == NULL) {
            return false;
        }
        use->speed = fmax(use->speed, hypot((double)v.x, (double)v.y));
        use->spin = fmax(use->spin, fabs((double)plumb_body_angular_velocity(w, body)));
        if (!(use->visited && use->immersed) && pl_stage_look_at_shapes(stage, body).sensor &&
            !note_visitors(stage, body, use)) {
            return false;
        }
    }
    const int contacts = plumb_world_contacts(w, NULL, 0);
    if (!pl_session_reserve(&stage->contacts, &stage->contact_room, contacts,
                            sizeof *stage->contacts)) {
        return false;
    }
    plumb_world_contacts(w, stage->contacts, contacts);
    for (int i = 0; i < contacts; i++) {
        const plumb_body ends[2] = { stage->contacts[i].body_a, stage->contacts[i].body_b };
        for (int k = 0; k < 2; k++) {
            session_use *use = use_of(session, ends[k]);
            if (use == NULL) {
                return false;
            }
            use->touched = true;
        }
    }
    return true;
}

/// What is told, the first of each rule, and how many more.
typedef struct telling {
    engine_session *session;
    int count;
    bool failed, bounced; ///< out of memory; something that bounces met something
} telling;

#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
static void
tell(telling *t, const char *rule, const char *advice, const char *format, ...)
{
    engine_session *s = t->session;
    if (!pl_session_reserve(&s->idle, &s->idle_room, t->count + 1, sizeof *s->idle)) {
        t->failed = true;
        return;
    }
    for (int i = 0; i < t->count; i++) {
        if (strcmp(s->idle[i].rule, rule) == 0) {
            s->idle[i].more++;
            return;
        }
    }
    engine_finding *made = &s->idle[t->count++];
    *made = (engine_finding){ .rule = rule, .advice = advice };
    va_list list;
    va_start(list, format);
    vsnprintf(made->text, sizeof made->text, format, list);
    va_end(list);
}

/// [-] of its cap, from where on a speed has met it.
static const double MET = 0.999;

static void judge_motion(telling *t, const scene_body *b, const session_use *use)
{
    const plumb_world *w = t->session->stage.world;
    const double cap = (double)plumb_body_max_speed(w, b->entity),
                 spin = (double)plumb_body_max_spin(w, b->entity);
    const bool still = use->speed == 0 && use->spin == 0;
    if (cap > 0 && use->speed < MET * cap) {
        tell(t, "cap-never-met", "take max_speed away, or lower it",
             "'%s' went %.3g m/s at most; its cap is %.3g m/s", b->name, use->speed, cap);
    }
    if (spin > 0 && use->spin < MET * spin) {
        tell(t, "cap-never-met", "take max_spin away, or lower it",
             "'%s' turned at %.3g rad/s at most; its cap is %.3g rad/s", b->name, use->spin, spin);
    }
    if (still &&
        (plumb_body_damping(w, b->entity) > 0 || plumb_body_angular_damping(w, b->entity) > 0)) {
        tell(t, "damping-at-rest", "take damping away, or let it move",
             "'%s' is damped and never moved", b->name);
    }
    if (still && plumb_body_drag(w, b->entity) > 0) {
        tell(t, "drag-at-rest", "take drag away, or let it move", "'%s' has drag and never moved",
             b->name);
    }
    if (still && plumb_body_time_scale(w, b->entity) != 1 &&
        plumb_body_time_scale(w, b->entity) != 0) {
        tell(t, "time-at-rest", "take time_scale away, or let it move",
             "'%s' has a time of its own and never moved", b->name);
    }
}

static void judge_body(telling *t, const scene_body *b)
{
    engine_stage *stage = &t->session->stage;
    const session_use *use = use_of(t->session, b->entity);
    if (use == NULL) {
        t->failed = true;
        return;
    }
    if (plumb_body_get_type(stage->world, b->entity) == PLUMB_DYNAMIC) {
        judge_motion(t, b, use);
    }
    const engine_shapes_are are = pl_stage_look_at_shapes(stage, b->entity);
    const plumb_vec2 g = plumb_world_gravity(stage->world);
    if (are.fluid && !use->immersed) {
        tell(t, "fluid-without-body", "put it where bodies go, or take it away",
             "no dynamic body was in the fluid of '%s'", b->name);
    } else if (are.sensor && !are.fluid && !use->visited) {
        tell(t, "sensor-without-visitor", "put it where bodies go, or look at its filter",
             "nothing was in the sensor of '%s'", b->name);
    }
    if (are.elastic && !t->bounced) {
        tell(t, "restitution-without-contact", "take restitution away, or let it meet something",
             "'%s' bounces and met nothing", b->name);
    }
    if (g.x == 0 && g.y == 0 && plumb_body_gravity_scale(stage->world, b->entity) != 1) {
        tell(t, "gravity-scale-without-gravity",
             "take gravity_scale away, or give the world gravity",
             "'%s' has a gravity scale; the world has no gravity", b->name);
    }
}

static bool tells_of_use(const char *rule)
{
    return strcmp(rule, "filter-meets-none") == 0 || strcmp(rule, "effect-on-none") == 0;
}

int pl_session_unused(engine_session *session, const engine_finding **list)
{
    telling t = { .session = session };
    int particles = 0;
    engine_stage *stage = &session->stage;
    plumb_liquid_desc liquid;
    const engine_finding *found;
    const int count = pl_session_lint(session, &found);
    t.failed = count < 0;
    for (int i = 0; i < count; i++) {
        if (tells_of_use(found[i].rule)) {
            tell(&t, found[i].rule, found[i].advice, "%s", found[i].text);
        }
    }
    for (int i = 0; i < scene_body_count(stage->scene); i++) {
        const plumb_body body = scene_body_get(stage->scene, i).entity;
        const session_use *use = use_of(session, body);
        t.bounced |= use != NULL && use->touched && pl_stage_look_at_shapes(stage, body).elastic;
    }
    for (int i = 0; i < scene_body_count(stage->scene); i++) {
        const scene_body b = scene_body_get(stage->scene, i);
        if (plumb_body_is_enabled(stage->world, b.entity)) {
            judge_body(&t, &b);
        }
    }
    if (plumb_liquid_settings(stage->world, &liquid) == PLUMB_OK &&
        (plumb_liquid_particles(stage->world, &particles) == NULL || particles == 0)) {
        tell(&t, "liquid-without-particles", "fill it with a box or a shape",
             "the liquid has no particles");
    }
    plumb_air_sums air;
    if (plumb_air_sum(stage->world, &air) == PLUMB_OK && air.energy == 0 && air.smoke == 0) {
        tell(&t, "air-at-rest",
             "give it a source, a side with a flow, or something that moves in it",
             "the air never moved, and has no smoke");
    }
    *list = session->idle;
    return t.failed ? -1 : t.count;
}

const char *pl_session_lacks(int index)
{
    int count;
    const plumb_effect *effects = plumb_effects(&count);
    for (int i = 0; i < count; i++) {
        if (!effects[i].present && index-- == 0) {
            return effects[i].name;
        }
    }
    return NULL;
}
