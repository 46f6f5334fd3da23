/// engine_explain.c - because of whom a pass runs, and what it visits. Compiled once for each precision, as engine.c.
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

engine_shapes_are pl_stage_look_at_shapes(engine_stage *stage, plumb_body body)
{
    engine_shapes_are are = { .solid = false };
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
        return is_moving(w, b) && pl_stage_look_at_shapes(stage, b).solid;
    case GROUND:
        return plumb_body_get_type(w, b) != PLUMB_DYNAMIC &&
               pl_stage_look_at_shapes(stage, b).solid;
    case ASLEEP:
        return !plumb_body_is_awake(w, b);
    case TARGETED:
        return plumb_body_has_target(w, b);
    case CHARACTERS:
        return plumb_body_is_character(w, b);
    case SENSORS:
        return pl_stage_look_at_shapes(stage, b).sensor;
    case FLUIDS:
        return pl_stage_look_at_shapes(stage, b).fluid;
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
        return pl_stage_look_at_shapes(stage, b).elastic;
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

int pl_stage_seen(engine_stage *stage, plumb_shape sensor)
{
    int count = plumb_shape_overlaps(stage->world, sensor, NULL, 0);
    count = count > 0 ? count : 0;
    if (!pl_session_reserve(&stage->seen, &stage->seen_room, count, sizeof *stage->seen)) {
        return -1;
    }
    (void)plumb_shape_overlaps(stage->world, sensor, stage->seen, count);
    return count;
}

static int by_entity(const void *a, const void *b)
{
    const plumb_entity x = ((const plumb_body *)a)->entity, y = ((const plumb_body *)b)->entity;
    return x.index != y.index ? (x.index > y.index) - (x.index < y.index)
                              : (x.generation > y.generation) - (x.generation < y.generation);
}

/// Adds the dynamic bodies that a sensor sees to `immersed`, behind `count`. How many there are then; -1: out of memory.
static int add_seen(engine_stage *stage, plumb_shape sensor, int count)
{
    const int seen = pl_stage_seen(stage, sensor);
    if (seen < 0 || !pl_session_reserve(&stage->immersed, &stage->immersed_room, count + seen,
                                        sizeof *stage->immersed)) {
        return -1;
    }
    for (int i = 0; i < seen; i++) {
        const plumb_body body = plumb_shape_body(stage->world, stage->seen[i]);
        if (plumb_body_get_type(stage->world, body) == PLUMB_DYNAMIC) {
            stage->immersed[count++] = body;
        }
    }
    return count;
}

/// Dynamic bodies in any fluid; -1: out of memory.
static long immersed(engine_stage *stage)
{
    int count = 0;
    for (int i = 0; i < scene_body_count(stage->scene) && count >= 0; i++) {
        const plumb_body b = scene_body_get(stage->scene, i).entity;
        if (!pl_stage_look_at_shapes(stage, b).fluid) {
            continue;
        }
        const int shapes = plumb_body_shapes(stage->world, b, NULL, 0);
        for (int k = 0; k < shapes && count >= 0; k++) {
            count = add_seen(stage, stage->shapes[k], count);
        }
    }
    long sum = count < 0 ? -1 : 0;
    if (count > 0) {
        qsort(stage->immersed, (size_t)count, sizeof *stage->immersed, by_entity);
    }
    for (int i = 0; i < count; i++) {
        sum += i == 0 || by_entity(&stage->immersed[i - 1], &stage->immersed[i]) != 0;
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

/// Of all soft bodies that are awake; -1 when out of memory.
static int soft_nodes(const engine_stage *stage)
{
    int count;
    plumb_softbody *all = pl_stage_softbodies(stage, &count);
    plumb_softbody_desc d;
    int nodes = all != NULL ? 0 : -1;
    for (int i = 0; all != NULL && i < count; i++) {
        nodes += plumb_softbody_settings(stage->world, all[i], &d) == PLUMB_OK && !d.asleep
                     ? d.node_count
                     : 0;
    }
    free(all);
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
        because->rows = soft_nodes(stage);
        break;
    case PARTICLES:
        (void)plumb_liquid_particles(stage->world, &particles);
        because->rows = particles;
        break;
    default:
        break;
    }
}
