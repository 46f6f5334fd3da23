/// engine_explain.c - because of whom a pass runs, what it visits, and what of a scene was of no use. Compiled once for each
/// precision, as engine.c.
///
/// Reads a scene's world by the public interface. Cost: O(bodies + shapes + joints) a pass or step.
#include "engine_session.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

//---- because of whom -------------------------------------------------------------------------------

/// Who can be the reason of a pass.
typedef enum cause {
    NOBODY,
    MOVING, ///< dynamic bodies that are awake
    SOLID,  ///< those of them with a shape that is no sensor
    GROUND, ///< bodies that are not dynamic, with such a shape
    ASLEEP,
    TARGETED,
    CHARACTERS,
    SENSORS, ///< bodies with one
    FLUIDS,
    DAMPED,
    DRAGGED,
    DIPOLES,
    THRUSTING,
    HEATED, ///< with a temperature, or that grow
    CAPPED,
    ELASTIC, ///< of a material with restitution
    FAST,    ///< that ask for sweeps
    JOINTS,
    WATCHED, ///< joints that break or tell
    BOUNCING ///< joints whose limits bounce
} cause;

/// What a pass visits.
typedef enum visit {
    NO_ROWS,
    SAME,
    BODIES,
    IMMERSED,
    PIECES,
    PAIRS,
    CONTACTS,
    PARTICLES,
    AIR_CELLS,
    NODES
} visit;

static const struct reason {
    const char *pass;
    cause who;
    visit visits;
} reasons[] = {
    { "measure", NOBODY, BODIES },
    { "watch", NOBODY, BODIES },
    { "guard", NOBODY, BODIES },
    { "tracks", TARGETED, SAME },
    { "characters", CHARACTERS, SAME },
    { "liquid", NOBODY, PARTICLES },
    { "air", NOBODY, AIR_CELLS },
    { "soft bodies", NOBODY, NODES },
    { "soft slots", NOBODY, NODES },
    { "soft forces", NOBODY, NODES },
    { "waking", ASLEEP, SAME },
    { "broad phase", SOLID, PIECES },
    { "internal edges", GROUND, PIECES },
    { "narrow phase", SOLID, PAIRS },
    { "surfaces", SOLID, CONTACTS },
    { "feet", CHARACTERS, SAME },
    { "sleep", MOVING, SAME },
    { "sensor pairs", SENSORS, PAIRS },
    { "gravity", MOVING, SAME },
    { "fluids", FLUIDS, IMMERSED },
    { "laws", MOVING, SAME },
    { "law slots", MOVING, SAME },
    { "law forces", MOVING, SAME },
    { "dipoles", DIPOLES, SAME },
    { "orbits", MOVING, SAME },
    { "called", NOBODY, BODIES },
    { "graph", SOLID, BODIES },
    { "waves", FLUIDS, NO_ROWS },
    { "wave motion", FLUIDS, IMMERSED },
    { "immersion", FLUIDS, IMMERSED },
    { "engines", THRUSTING, SAME },
    { "burning", THRUSTING, SAME },
    { "heat contacts", HEATED, SAME },
    { "heat flow", HEATED, SAME },
    { "acting", NOBODY, BODIES },
    { "measure bodies", NOBODY, BODIES },
    { "clusters", NOBODY, BODIES },
    { "islands apart", SOLID, CONTACTS },
    { "elimination", SOLID, CONTACTS },
    { "soft step", NOBODY, BODIES },
    { "classic solver", NOBODY, BODIES },
    { "exact solver", NOBODY, BODIES },
    { "prepare joints", JOINTS, SAME },
    { "prepare contacts", SOLID, CONTACTS },
    { "prepare impacts", ELASTIC, CONTACTS },
    { "forces of now", NOBODY, BODIES },
    { "fluid forces", FLUIDS, IMMERSED },
    { "damping", DAMPED, SAME },
    { "thrust", THRUSTING, SAME },
    { "drag", DRAGGED, SAME },
    { "speed caps", CAPPED, SAME },
    { "integrate", MOVING, SAME },
    { "warm start joints", JOINTS, SAME },
    { "warm start", SOLID, CONTACTS },
    { "impacts", ELASTIC, CONTACTS },
    { "limits", BOUNCING, SAME },
    { "half kick", MOVING, SAME },
    { "open moment", SOLID, CONTACTS },
    { "joints", JOINTS, SAME },
    { "contacts", SOLID, CONTACTS },
    { "exact pull", SOLID, CONTACTS },
    { "positions", MOVING, SAME },
    { "follow moment", SOLID, CONTACTS },
    { "relax joints", JOINTS, SAME },
    { "relax contacts", SOLID, CONTACTS },
    { "exact relax", SOLID, CONTACTS },
    { "sum reactions", WATCHED, SAME },
    { "sum impulses", SOLID, CONTACTS },
    { "measure contacts", NOBODY, CONTACTS },
    { "store joints", JOINTS, SAME },
    { "store contacts", SOLID, CONTACTS },
    { "motion", MOVING, SAME },
    { "continuous", FAST, BODIES },
    { "targets", TARGETED, SAME },
    { "edges", NOBODY, BODIES },
    { "liquid motion", NOBODY, PARTICLES },
    { "air motion", NOBODY, AIR_CELLS },
    { "soft motion", NOBODY, NODES },
    { "reactions", JOINTS, SAME },
    { "events", SOLID, PAIRS },
    { "sensors", SENSORS, SAME },
    { "measure sums", NOBODY, BODIES },
    { "watchdog", NOBODY, BODIES },
};

static const struct reason *reason_of(const char *pass)
{
    for (size_t i = 0; i < sizeof reasons / sizeof reasons[0]; i++) {
        if (strcmp(reasons[i].pass, pass) == 0) {
            return &reasons[i];
        }
    }
    return NULL;
}

/// What the shapes of a body are.
typedef struct shapes_are {
    bool solid, sensor, fluid, elastic;
} shapes_are;

static shapes_are look_at_shapes(engine_stage *stage, plumb_body body)
{
    shapes_are are = { .solid = false };
    const int count = plumb_body_shapes(stage->world, body, NULL, 0);
    if (!pl_session_reserve(&stage->shapes, &stage->shape_room, count, sizeof *stage->shapes)) {
        return are;
    }
    plumb_body_shapes(stage->world, body, stage->shapes, count);
    for (int i = 0; i < count; i++) {
        plumb_material_desc m = { .fluid = false };
        const bool sensor = plumb_shape_is_sensor(stage->world, stage->shapes[i]);
        (void)plumb_material_settings(stage->world,
                                      plumb_shape_material(stage->world, stage->shapes[i]), &m);
        are.solid |= !sensor;
        are.sensor |= sensor;
        are.fluid |= sensor && m.fluid;
        are.elastic |= !sensor && m.restitution > 0;
    }
    return are;
}

static bool is_moving(const plumb_world *w, plumb_body b)
{
    return plumb_body_get_type(w, b) == PLUMB_DYNAMIC && plumb_body_is_awake(w, b);
}

static bool is_one(engine_stage *stage, plumb_body b, cause who)
{
    const plumb_world *w = stage->world;
    switch (who) {
    case MOVING:
        return is_moving(w, b);
    case SOLID:
        return is_moving(w, b) && look_at_shapes(stage, b).solid;
    case GROUND:
        return plumb_body_get_type(w, b) != PLUMB_DYNAMIC && look_at_shapes(stage, b).solid;
    case ASLEEP:
        return !plumb_body_is_awake(w, b);
    case TARGETED:
        return plumb_body_has_target(w, b);
    case CHARACTERS:
        return plumb_body_is_character(w, b);
    case SENSORS:
        return look_at_shapes(stage, b).sensor;
    case FLUIDS:
        return look_at_shapes(stage, b).fluid;
    case DAMPED:
        return plumb_body_damping(w, b) > 0 || plumb_body_angular_damping(w, b) > 0;
    case DRAGGED:
        return plumb_body_drag(w, b) > 0;
    case DIPOLES:
        return plumb_body_dipole(w, b) != 0;
    case THRUSTING:
        return plumb_body_thrust(w, b) > 0;
    case HEATED:
        return plumb_body_temperature(w, b) > 0 || plumb_body_growth(w, b) != 0;
    case CAPPED:
        return plumb_body_max_speed(w, b) > 0 || plumb_body_max_spin(w, b) > 0;
    case ELASTIC:
        return look_at_shapes(stage, b).elastic;
    case FAST:
        return plumb_body_is_continuous(w, b);
    default:
        return false;
    }
}

static bool is_joint(const plumb_world *w, plumb_joint joint, cause who)
{
    plumb_joint_desc d;
    if (plumb_joint_settings(w, joint, &d) != PLUMB_OK || d.disabled) {
        return false;
    }
    return who == JOINTS || (who == BOUNCING && d.restitution > 0) ||
           (who == WATCHED && (d.break_force > 0 || d.break_torque > 0 || d.break_impulse > 0 ||
                               d.event_force > 0 || d.event_torque > 0));
}

static void count_one(engine_because *because, const char *name)
{
    if (because->count++ == 0) {
        snprintf(because->first, sizeof because->first, "%s", name);
    }
}

static void find_whom(engine_stage *stage, cause who, engine_because *because)
{
    for (int i = 0; who < JOINTS && who != NOBODY && i < scene_body_count(stage->scene); i++) {
        const scene_body b = scene_body_get(stage->scene, i);
        if (plumb_body_is_enabled(stage->world, b.entity) && is_one(stage, b.entity, who)) {
            count_one(because, b.name);
        }
    }
    for (int i = 0; who >= JOINTS && i < scene_joint_count(stage->scene); i++) {
        const scene_joint j = scene_joint_get(stage->scene, i);
        if (is_joint(stage->world, j.entity, who)) {
            count_one(because, j.name);
        }
    }
}

/// Dynamic bodies in any fluid.
static long immersed(engine_stage *stage)
{
    long sum = 0;
    plumb_shape in[256];
    for (int i = 0; i < scene_body_count(stage->scene); i++) {
        const plumb_body b = scene_body_get(stage->scene, i).entity;
        if (!look_at_shapes(stage, b).fluid) {
            continue;
        }
        const int count = plumb_body_shapes(stage->world, b, NULL, 0);
        for (int k = 0; k < count; k++) {
            const int near = plumb_shape_overlaps(stage->world, stage->shapes[k], in, 256);
            for (int n = 0; n < near && n < 256; n++) {
                sum += plumb_body_get_type(stage->world, plumb_shape_body(stage->world, in[n])) ==
                       PLUMB_DYNAMIC;
            }
        }
    }
    return sum;
}

/// [B] of the data of a list of names; a name twice counts once.
static double bytes_of(const plumb_world *world, const char *reads, const char *writes)
{
    double sum = 0;
    for (int i = 0; plumb_data_name(i) != NULL; i++) {
        const char *name = plumb_data_name(i);
        const size_t length = strlen(name);
        bool named = false;
        for (int side = 0; side < 2; side++) {
            const char *list = side == 0 ? reads : writes;
            for (const char *at = list; *at != '\0';
                 at += strcspn(at, ","), at += strspn(at, ", ")) {
                named |= strcspn(at, ",") == length && memcmp(at, name, length) == 0;
            }
        }
        sum += named ? (double)plumb_data_bytes(world, i) : 0;
    }
    return sum;
}

static bool is_once(const engine_pass *pass)
{
    return !pass->in_substeps || strcmp(pass->phase, "prepare") == 0 ||
           strcmp(pass->phase, "store") == 0;
}

/// Of all soft bodies that are awake.
static int soft_nodes(const plumb_world *world)
{
    plumb_softbody some[64];
    plumb_softbody_desc d;
    int nodes = 0;
    const int count = plumb_world_softbodies(world, some, 64);
    for (int i = 0; i < count && i < 64; i++) {
        nodes +=
            plumb_softbody_settings(world, some[i], &d) == PLUMB_OK && !d.asleep ? d.node_count : 0;
    }
    return nodes;
}

void pl_session_because(engine_session *session, const engine_pass *pass, engine_because *because)
{
    engine_stage *stage = &session->stage;
    const struct reason *reason = reason_of(pass->name);
    const plumb_stats s = plumb_world_stats(stage->world);
    const int substeps = is_once(pass) ? 1 : plumb_world_settings(stage->world).substeps;
    static const char *const words[] = { "",      "",         "bodies",    "bodies", "pieces",
                                         "pairs", "contacts", "particles", "cells",  "nodes" };
    *because = (engine_because){ .rows = -1, .what = "" };
    because->bytes = substeps * bytes_of(stage->world, pass->reads, pass->writes);
    if (reason == NULL) {
        return;
    }
    find_whom(stage, reason->who, because);
    int particles = 0;
    plumb_air_box box;
    because->what = reason->visits == SAME ? (reason->who >= JOINTS ? "joints" : "bodies")
                                           : words[reason->visits];
    switch (reason->visits) {
    case SAME:
        because->rows = because->count;
        break;
    case BODIES:
        because->rows = s.dynamic_count;
        break;
    case IMMERSED:
        because->rows = immersed(stage);
        break;
    case PIECES:
        because->rows = s.piece_count;
        break;
    case PAIRS:
        because->rows = s.pair_count;
        break;
    case CONTACTS:
        because->rows = s.contact_count;
        break;
    case AIR_CELLS:
        because->rows =
            plumb_air_cells(stage->world, &box) == PLUMB_OK ? box.columns * box.rows : 0;
        break;
    case NODES:
        because->rows = soft_nodes(stage->world);
        break;
    case PARTICLES:
        (void)plumb_liquid_particles(stage->world, &particles);
        because->rows = particles;
        break;
    default:
        break;
    }
}

//---- what was of no use ----------------------------------------------------------------------------

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

static void note_visitors(engine_stage *stage, plumb_body body, session_use *use)
{
    const int count = plumb_body_shapes(stage->world, body, NULL, 0);
    for (int k = 0; k < count; k++) {
        plumb_shape in[64];
        const int near = plumb_shape_is_sensor(stage->world, stage->shapes[k])
                             ? plumb_shape_overlaps(stage->world, stage->shapes[k], in, 64)
                             : 0;
        use->visited |= near > 0;
        for (int n = 0; n < near && n < 64; n++) {
            use->immersed |=
                plumb_body_get_type(stage->world, plumb_shape_body(stage->world, in[n])) ==
                PLUMB_DYNAMIC;
        }
    }
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
        if (!(use->visited && use->immersed) && look_at_shapes(stage, body).sensor) {
            note_visitors(stage, body, use);
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
    if (still && is_one(&t->session->stage, b->entity, DAMPED)) {
        tell(t, "damping-at-rest", "take damping away, or let it move",
             "'%s' is damped and never moved", b->name);
    }
    if (still && is_one(&t->session->stage, b->entity, DRAGGED)) {
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
    const shapes_are are = look_at_shapes(stage, b->entity);
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
        t.bounced |= use != NULL && use->touched && look_at_shapes(stage, body).elastic;
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
