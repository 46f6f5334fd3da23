/// engine_stage.c - what is to be seen of a world: bodies and joints with their names and looks, be it
/// of a scene that runs or of a recording. Compiled once for each precision, as engine.c.
///
/// Reads the world, the scene or the replay, changes none of them. Where a recording says nothing of a body's
/// looks (a program made it), colours go round in the order in which bodies are met, and a body keeps its
/// own as long as the stage is open. Cost: O(bodies), of a recording once sorted for each step that is looked at.
#include "engine_session.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "../render/render.h"

// ------------------------------------------------------------------------------- of a recording

static int by_index(const void *a, const void *b)
{
    uint32_t x = ((const plumb_body *)a)->entity.index, y = ((const plumb_body *)b)->entity.index;
    return x < y ? -1 : x > y;
}

/// `base` and a number: what the loader calls things that their author gave no name.
static bool is_counted(const char *name, const char *base)
{
    size_t length = strlen(base);
    if (strncmp(name, base, length) != 0 || name[length] == '\0') {
        return false;
    }
    const char *digit = name + length;
    while (isdigit((unsigned char)*digit)) {
        digit++;
    }
    return *digit == '\0';
}

/// The name in the recording, or "7:1" written to `text`.
static const char *name_of(const engine_stage *stage, plumb_entity entity, char text[64])
{
    const char *name = plumb_replay_name(stage->replay, entity);
    snprintf(text, 64, "%u:%u", (unsigned)entity.index, (unsigned)entity.generation);
    if (name != NULL) {
        snprintf(text, 64, "%s", name);
    }
    return text;
}

/// The colour number of a body: the next one when it is met first. -1: out of memory.
static int hue_of(engine_stage *stage, plumb_body body)
{
    if (body.entity.index >= stage->hue_count) {
        uint32_t count = body.entity.index + body.entity.index / 2 + 64;
        struct stage_hue *grown = realloc(stage->hues, count * sizeof *grown);
        if (grown == NULL) {
            return -1;
        }
        memset(grown + stage->hue_count, 0, (count - stage->hue_count) * sizeof *grown);
        stage->hues = grown;
        stage->hue_count = count;
    }
    struct stage_hue *hue = &stage->hues[body.entity.index];
    if (hue->generation != body.entity.generation) {
        *hue = (struct stage_hue){ body.entity.generation, stage->next_palette++ };
    }
    return hue->palette;
}

/// Room for so many handles, names, bodies, joints.
static bool make_room(engine_stage *stage, int bodies, int joints)
{
    int handles = bodies > joints ? bodies : joints;
    return pl_session_reserve(&stage->handles, &stage->handle_room, handles,
                              sizeof(plumb_entity)) &&
           pl_session_reserve(&stage->names, &stage->name_room, bodies + joints,
                              sizeof *stage->names) &&
           pl_session_reserve(&stage->bodies, &stage->body_room, bodies, sizeof *stage->bodies) &&
           pl_session_reserve(&stage->joints, &stage->joint_room, joints, sizeof *stage->joints);
}

bool pl_stage_look(engine_stage *stage)
{
    stage->world = plumb_replay_world(stage->replay);
    plumb_body_span span = plumb_world_bodies(stage->world);
    int joints = plumb_world_joints(stage->world, NULL, 0);
    if (!make_room(stage, span.count, joints)) {
        return false;
    }
    stage->body_count = span.count;
    stage->joint_count = joints;
    plumb_body *bodies = stage->handles;
    if (span.count > 0) {
        memcpy(bodies, span.body, (size_t)span.count * sizeof *bodies);
        qsort(bodies, (size_t)span.count, sizeof *bodies, by_index);
    }
    for (int i = 0; i < span.count; i++) {
        plumb_body body = bodies[i];
        const char *name = plumb_replay_name(stage->replay, body.entity);
        int hue = hue_of(stage, body);
        if (hue < 0) {
            return false;
        }
        stage->bodies[i] = (scene_body){ .entity = body,
                                         .name = name_of(stage, body.entity, stage->names[i]),
                                         .is_named = name != NULL && !is_counted(name, "body"),
                                         .label = "",
                                         .palette = hue,
                                         .hidden = !plumb_body_is_enabled(stage->world, body) };
        pl_stage_read_body(stage->replay, &stage->bodies[i]);
    }
    pl_stage_read_camera(stage->replay, &stage->camera);
    plumb_joint *handles = stage->handles;
    plumb_world_joints(stage->world, handles, joints);
    for (int i = 0; i < joints; i++) {
        plumb_joint joint = handles[i];
        stage->joints[i] =
            (scene_joint){ .entity = joint,
                           .name = name_of(stage, joint.entity, stage->names[span.count + i]) };
        pl_stage_read_joint(stage->replay, &stage->joints[i]);
    }
    return true;
}

void pl_stage_open_replay(engine_stage *stage, plumb_replay *replay, const char *path)
{
    plumb_replay_info from = { 0 };
    plumb_replay_get_info(replay, &from);
    const char *base = strrchr(path, '/');
    base = base != NULL ? base + 1 : path;
    *stage = (engine_stage){ .replay = replay, .world = plumb_replay_world(replay) };
    plumb_world_desc world = plumb_world_settings(stage->world);
    stage->info = (scene_info){
        .title = from.title[0] != '\0' ? from.title : base,
        .duration = from.end - from.start,
        .dt = from.steps > 0 ? (from.end - from.start) / (double)from.steps : 0,
        .y_axis = world.y_axis,
        .solver = world.solver,
        .substeps = world.substeps,
        .iterations = world.iterations,
    };
}

void pl_stage_close(engine_stage *stage)
{
    free(stage->bodies);
    free(stage->joints);
    free(stage->handles);
    free(stage->names);
    free(stage->hues);
    free(stage->rows);
    free(stage->contacts);
    free(stage->seen);
    free(stage->immersed);
    free(stage->shapes);
    free(stage->cells);
}

// --------------------------------------------------------------------------------------- of both

int pl_stage_body_count(const engine_stage *stage)
{
    return stage->scene != NULL ? scene_body_count(stage->scene) : stage->body_count;
}

scene_body pl_stage_body(const engine_stage *stage, int i)
{
    return stage->scene != NULL ? scene_body_get(stage->scene, i) : stage->bodies[i];
}

int pl_stage_joint_count(const engine_stage *stage)
{
    return stage->scene != NULL ? scene_joint_count(stage->scene) : stage->joint_count;
}

scene_joint pl_stage_joint(const engine_stage *stage, int i)
{
    return stage->scene != NULL ? scene_joint_get(stage->scene, i) : stage->joints[i];
}

double pl_stage_time(const engine_stage *stage)
{
    if (stage->scene != NULL) {
        return scene_time(stage->scene);
    }
    plumb_replay_info info = { 0 };
    plumb_replay_get_info(stage->replay, &info);
    return pl_stage_read_time(stage->replay, info.step, info.time);
}

const char *pl_stage_text(const engine_stage *stage)
{
    return stage->scene != NULL ? scene_get_text(stage->scene) : pl_stage_read_text(stage->replay);
}

/// The unit that the errors of all closed forms have, "" when they have several.
static const char *exact_unit(const scene *of)
{
    int count = of != NULL ? scene_exact_count(of) : 0;
    const char *unit = count > 0 ? scene_exact_get(of, 0).unit : "";
    for (int i = 1; i < count; i++) {
        unit = strcmp(unit, scene_exact_get(of, i).unit) == 0 ? unit : "";
    }
    return unit;
}

engine_info pl_stage_info(const engine_stage *stage)
{
    const scene_info *info = &stage->info;
    const scene_camera *camera = &stage->camera;
    plumb_world_desc world = plumb_world_settings(stage->world);
    return (engine_info){
        .name = info->title,
        .duration = info->duration,
        .dt = info->dt,
        .substeps = info->substeps,
        .iterations = info->iterations,
        .solver = (int)info->solver,
        .width = plumb_world_stats(stage->world).simd_width,
        .y_down = info->y_axis == PLUMB_Y_DOWN,
        .wrap_x = (double)world.wrap_x,
        .wrap_y = (double)world.wrap_y,
        .joint_count = pl_stage_joint_count(stage),
        .exact_count = stage->scene != NULL ? scene_exact_count(stage->scene) : 0,
        .exact_unit = exact_unit(stage->scene),
        .camera = { .has_view = camera->has_view,
                    .x = camera->center[0],
                    .y = camera->center[1],
                    .height = camera->height,
                    .has_fit = camera->has_fit,
                    .box = { camera->box[0], camera->box[1], camera->box[2], camera->box[3] },
                    .follow = camera->follow != NULL ? camera->follow : "",
                    .at = camera->has_at ? camera->at : -1,
                    .trail = camera->trail },
    };
}

int pl_stage_palette(const scene_body *body, int i)
{
    return body->palette >= 0 ? body->palette : i;
}

int pl_stage_rows(engine_stage *stage, const engine_row **rows)
{
    int count = pl_stage_body_count(stage);
    if (!pl_session_reserve(&stage->rows, &stage->row_room, count, sizeof *stage->rows)) {
        return -1;
    }
    engine_row *list = stage->rows;
    for (int i = 0; i < count; i++) {
        scene_body body = pl_stage_body(stage, i);
        plumb_vec2 p = plumb_body_position(stage->world, body.entity);
        plumb_vec2 v = plumb_body_velocity(stage->world, body.entity);
        const render_rgba of_palette = render_palette(pl_stage_palette(&body, i));
        const bool said = body.color.a > 0;
        list[i] = (engine_row){
            .name = body.name,
            .x = (double)p.x,
            .y = (double)p.y,
            .angle = (double)plumb_body_angle(stage->world, body.entity),
            .vx = (double)v.x,
            .vy = (double)v.y,
            .w = (double)plumb_body_angular_velocity(stage->world, body.entity),
            .moves = plumb_body_get_type(stage->world, body.entity) != PLUMB_STATIC,
            .color = { said ? body.color.r : of_palette.r, said ? body.color.g : of_palette.g,
                       said ? body.color.b : of_palette.b, 255 },
        };
    }
    *rows = list;
    return count;
}

engine_accuracy pl_stage_accuracy(const engine_stage *stage)
{
    const plumb_accuracy a = plumb_world_accuracy(stage->world);
    const double steps = a.steps > 0 ? (double)a.steps : 1;
    return (engine_accuracy){ .tolerance = a.tolerance,
                              .motion = a.motion,
                              .frozen = a.frozen,
                              .rest = a.rest,
                              .worst = a.worst,
                              .solver = (int)a.solver,
                              .substeps = a.substeps,
                              .direct_joints = a.direct_joints,
                              .met = a.met,
                              .reason = a.reason,
                              .solved = (double)a.solved / steps };
}

engine_stats pl_stage_stats(const engine_stage *stage)
{
    plumb_stats s = plumb_world_stats(stage->world);
    return (engine_stats){
        .soft_missed = s.soft_missed,
        .soft_asleep = s.soft_asleep,
        .cut_chains = s.cut_chain_count,
        .step_count = s.step_count,
        .time = s.time,
        .bodies = s.body_count,
        .moving = s.dynamic_count + s.kinematic_count,
        .asleep = s.asleep_count,
        .islands = s.island_count,
        .statics = s.static_count,
        .shapes = s.shape_count,
        .pieces = s.piece_count,
        .pairs = s.pair_count,
        .contacts = s.contact_count,
        .points = s.point_count,
        .colors = s.color_count,
        .overflow = s.overflow_count,
        .pair_rebuilds = s.pair_rebuilds,
        .max_penetration = (double)s.max_penetration,
        .mean_penetration = (double)s.mean_penetration,
        .bytes = s.bytes,
        .peak_bytes = s.peak_bytes,
    };
}
