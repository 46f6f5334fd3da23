/// engine_draw.c - a stage's bodies and overlays as a draw list. Compiled once for each
/// precision, as engine.c.
///
/// Reads the world and the looks that a scene gave, writes a render_frame. A shape is drawn by
/// its convex pieces: one point is a disc, two are a capsule or a line, more a polygon; the
/// renderer takes the seams between pieces of one body out.
/// Cost: O(shapes), for overlays O(contacts).
#include "engine_session.h"

#include <math.h>
#include <stdlib.h>

#include "../render/render.h"

enum {
    LINE_MAX =
        256, ///< points of one line drawn; a longer chain is drawn as several that share an end
    NAMES_MAX = 12 ///< bodies that are named in the picture unasked; more would hide what they name
};

/// A disc, capsule or polygon.
static void add_piece(render_frame *frame, const plumb_convex *piece, plumb_transform where)
{
    render_vec points[PLUMB_POLYGON_MAX_VERTICES];
    double radius = (double)piece->radius;
    for (int i = 0; i < piece->count; i++) {
        points[i] = pl_to_world(where, piece->points[i]);
    }
    if (piece->count == 1) {
        double angle = atan2((double)where.q.s, (double)where.q.c);
        render_add_circle(frame, points[0].x, points[0].y, radius, angle);
    } else if (piece->count == 2) {
        render_add_capsule(frame, points[0].x, points[0].y, points[1].x, points[1].y, radius);
    } else {
        render_add_polygon(frame, points, (size_t)piece->count, radius);
    }
}

/// A segment or chain: its pieces are links, each beginning where the last one ended.
static void add_line(const plumb_world *world, plumb_shape shape, int pieces, plumb_transform where,
                     render_frame *frame, bool is_ground)
{
    render_vec points[LINE_MAX];
    size_t count = 0;
    plumb_convex piece;

    for (int i = 0; i < pieces; i++) {
        if (plumb_shape_piece(world, shape, i, &piece, NULL) != PLUMB_OK || piece.count != 2) {
            continue;
        }
        if (count == LINE_MAX) {
            render_add_polyline(frame, points, count, 0, 0);
            points[0] = points[count - 1];
            count = 1;
        }
        if (count == 0) {
            points[count++] = pl_to_world(where, piece.points[0]);
        }
        points[count++] = pl_to_world(where, piece.points[1]);
    }
    if (count < 2) {
        return;
    }
    bool is_closed = points[0].x == points[count - 1].x && points[0].y == points[count - 1].y;
    // Hatching belongs below the ground: to the right of a line that runs to +x where y is up.
    bool is_y_up = plumb_world_up(world).y > 0;
    bool runs_well = (points[count - 1].x > points[0].x) == is_y_up;
    unsigned flags = 0;
    if (is_closed && count > 3) {
        count--;
        flags = RENDER_LINE_CLOSED;
    } else if (is_ground && pieces < LINE_MAX) {
        flags = RENDER_LINE_TICKS;
    }
    for (size_t i = 0; flags == RENDER_LINE_TICKS && !runs_well && i < count / 2; i++) {
        render_vec swap = points[i];
        points[i] = points[count - 1 - i];
        points[count - 1 - i] = swap;
    }
    render_add_polyline(frame, points, count, 0, flags);
}

static void add_shape(const plumb_world *world, plumb_shape shape, plumb_transform where,
                      render_frame *frame, bool is_static)
{
    plumb_shape_kind kind = plumb_shape_get_kind(world, shape);
    int pieces = plumb_shape_piece_count(world, shape);
    if (kind == PLUMB_SEGMENT || kind == PLUMB_CHAIN) {
        add_line(world, shape, pieces, where, frame, is_static);
        return;
    }
    for (int i = 0; i < pieces; i++) {
        plumb_convex piece;
        if (plumb_shape_piece(world, shape, i, &piece, NULL) == PLUMB_OK) {
            add_piece(frame, &piece, where);
        }
    }
}

/// Shapes of a body, in the stage's list; how many, -1 out of memory.
static int body_shapes(engine_stage *stage, plumb_body body)
{
    int count = plumb_body_shapes(stage->world, body, NULL, 0);
    if (!pl_session_reserve(&stage->shapes, &stage->shape_room, count, sizeof *stage->shapes)) {
        return -1;
    }
    return plumb_body_shapes(stage->world, body, stage->shapes, count);
}

static render_class class_of(plumb_body_type type)
{
    switch (type) {
    case PLUMB_STATIC:
        return RENDER_STATIC;
    case PLUMB_KINEMATIC:
        return RENDER_KINEMATIC;
    case PLUMB_DYNAMIC:
        break;
    }
    return RENDER_DYNAMIC;
}

/// True when the bodies' names are to be written: on demand, or when there are few.
static bool wants_names(const engine_stage *stage, unsigned show)
{
    int count = pl_stage_body_count(stage), named = 0;
    for (int i = 0; i < count; i++) {
        scene_body body = pl_stage_body(stage, i);
        bool is_static = plumb_body_get_type(stage->world, body.entity) == PLUMB_STATIC;
        named += body.is_named && !body.hidden && !is_static;
    }
    return (show & ENGINE_SHOW_NAMES) != 0 || named <= NAMES_MAX;
}

/// What is drawn apart of a body.
typedef enum shape_role { ROLE_SOLID, ROLE_SENSOR, ROLE_FLUID, ROLE_GLASS } shape_role;

/// Air is not to be seen.
static shape_role role_of(const plumb_world *world, plumb_shape shape)
{
    plumb_material_desc material = { 0 };
    plumb_material_settings(world, plumb_shape_material(world, shape), &material);
    if (!plumb_shape_is_sensor(world, shape)) {
        return (double)material.refractive_index > 0 ? ROLE_GLASS : ROLE_SOLID;
    }
    return material.fluid && !material.weightless ? ROLE_FLUID : ROLE_SENSOR;
}

/// The shapes of a body that are of a role; true when there was something.
static bool add_shapes(const engine_stage *stage, int count, shape_role role, plumb_transform where,
                       bool is_static, const render_style *style, render_frame *frame)
{
    int added = 0;
    for (int i = 0; i < count; i++) {
        if (role_of(stage->world, stage->shapes[i]) == role) {
            if (added++ == 0) {
                render_body_begin(frame, style);
            }
            if (role == ROLE_FLUID && pl_stage_add_waves(stage, stage->shapes[i], where, frame)) {
                continue;
            }
            add_shape(stage->world, stage->shapes[i], where, frame,
                      is_static && role == ROLE_SOLID);
            pl_stage_add_one_way(stage->world, stage->shapes[i], where, frame);
            if (role == ROLE_FLUID) {
                pl_stage_add_water_line(stage->world, stage->shapes[i], where, frame);
            }
        }
    }
    if (added > 0) {
        render_body_end(frame);
    }
    return added > 0;
}

/// What glows at a temperature [K]: the eye's sequence of colours of a black body, red first seen at about 800 K.
static const struct glow {
    double temperature;
    double r, g, b;
} glows[] = {
    { 600, 0.30, 0.05, 0.04 },  { 800, 0.55, 0.07, 0.03 },  { 1000, 0.85, 0.18, 0.04 },
    { 1300, 1.00, 0.45, 0.08 }, { 1700, 1.00, 0.72, 0.28 }, { 2300, 1.00, 0.90, 0.62 },
    { 3500, 1.00, 0.98, 0.92 },
};

#define GLOW_FROM 600.0  ///< [K] where it begins to hide what colour a body has
#define GLOW_ALL  1000.0 ///< [K] where nothing is left of that

static unsigned char toned(unsigned char own, double glow, double share)
{
    const double value = (1 - share) * own + share * 255 * glow;
    return (unsigned char)(value + 0.5);
}

/// The colour of a body as hot as that.
static render_rgba glowing(render_rgba own, double temperature)
{
    const size_t last = sizeof glows / sizeof *glows - 1;
    size_t i = 0;
    while (i + 1 < last && glows[i + 1].temperature < temperature) {
        i++;
    }
    const struct glow *a = &glows[i], *b = &glows[i + 1];
    double t = (temperature - a->temperature) / (b->temperature - a->temperature);
    double share = (temperature - GLOW_FROM) / (GLOW_ALL - GLOW_FROM);
    t = t < 1 ? t : 1;
    share = share < 1 ? share : 1;
    return (render_rgba){ toned(own.r, a->r + t * (b->r - a->r), share),
                          toned(own.g, a->g + t * (b->g - a->g), share),
                          toned(own.b, a->b + t * (b->b - a->b), share), own.a };
}

static void glow_by(const plumb_world *world, const scene_body *body, render_style *style)
{
    const double temperature = (double)plumb_body_temperature(world, body->entity);
    const render_rgba grey = { 120, 124, 130, 255 }; // about what static bodies have
    if (temperature > GLOW_FROM) {
        const bool is_static = plumb_body_get_type(world, body->entity) == PLUMB_STATIC;
        const render_rgba own = style->color.a > 0 ? style->color
                                : is_static        ? grey
                                                   : render_palette(style->palette);
        style->color = glowing(own, temperature);
    }
}

static bool add_body(engine_stage *stage, const scene_body *body, int index, bool names,
                     unsigned show, render_frame *frame)
{
    const plumb_world *world = stage->world;
    plumb_body_type type = plumb_body_get_type(world, body->entity);
    plumb_transform where = plumb_body_transform(world, body->entity);
    int count = body_shapes(stage, body->entity);
    if (count < 0) {
        return false;
    }
    const char *label = body->label[0] != '\0' ? body->label : NULL;
    const bool wanted = names && (type != PLUMB_STATIC || (show & ENGINE_SHOW_NAMES) != 0);
    if (label == NULL && wanted && body->is_named) {
        label = body->name;
    }
    bool asleep = !plumb_body_is_awake(world, body->entity);
    render_style style = { .kind = asleep ? RENDER_ASLEEP : class_of(type),
                           .palette = pl_stage_palette(body, index),
                           .color = { body->color.r, body->color.g, body->color.b, body->color.a },
                           .label = label };
    bool is_static = type == PLUMB_STATIC;
    glow_by(world, body, &style);
    if (add_shapes(stage, count, ROLE_SOLID, where, is_static, &style, frame)) {
        style.label = NULL;
    }
    style.kind = RENDER_GLASS;
    if (add_shapes(stage, count, ROLE_GLASS, where, false, &style, frame)) {
        style.label = NULL;
    }
    style.kind = RENDER_SENSOR;
    add_shapes(stage, count, ROLE_SENSOR, where, is_static, &style, frame);
    style.kind = RENDER_FLUID;
    add_shapes(stage, count, ROLE_FLUID, where, is_static, &style, frame);
    if ((show & RENDER_SHOW_SURFACES) != 0) {
        pl_stage_add_surfaces(stage, stage->shapes, count, frame);
    }
    if ((show & RENDER_SHOW_DIPOLES) != 0) {
        pl_stage_add_dipole(stage, body->entity, count, frame);
    }
    return true;
}

static void add_velocities(const engine_stage *stage, render_frame *frame)
{
    int count = pl_stage_body_count(stage);
    for (int i = 0; i < count; i++) {
        scene_body body = pl_stage_body(stage, i);
        plumb_vec2 v = plumb_body_velocity(stage->world, body.entity);
        plumb_vec2 p = plumb_body_center(stage->world, body.entity);
        if (!body.hidden && (v.x != 0 || v.y != 0)) {
            render_add_velocity(frame, (double)p.x, (double)p.y, (double)v.x, (double)v.y);
        }
    }
}

static bool add_boxes(engine_stage *stage, render_frame *frame)
{
    int bodies = pl_stage_body_count(stage);
    for (int i = 0; i < bodies; i++) {
        scene_body body = pl_stage_body(stage, i);
        int count = body.hidden ? 0 : body_shapes(stage, body.entity);
        if (count < 0) {
            return false;
        }
        for (int k = 0; k < count; k++) {
            plumb_aabb b = plumb_shape_aabb(stage->world, stage->shapes[k]);
            render_add_aabb(frame, (render_box){ { (double)b.min.x, (double)b.min.y },
                                                 { (double)b.max.x, (double)b.max.y } });
        }
    }
    return true;
}

static bool add_cells(engine_stage *stage, render_frame *frame)
{
    int count = plumb_world_cells(stage->world, NULL, 0);
    if (!pl_session_reserve(&stage->cells, &stage->cell_room, count, sizeof *stage->cells)) {
        return false;
    }
    plumb_aabb *list = stage->cells;
    count = plumb_world_cells(stage->world, list, count);
    for (int i = 0; i < count; i++) {
        render_add_cell(frame, (render_box){ { (double)list[i].min.x, (double)list[i].min.y },
                                             { (double)list[i].max.x, (double)list[i].max.y } });
    }
    return true;
}

/// An impulse has two ends. Drawn is the one that acts on the body that moves, of two such bodies
/// the one that points up: what carries a weight.
static void add_impulse(const plumb_world *world, const plumb_contact *contact,
                        const plumb_contact_point *at, double jx, double jy, render_frame *frame)
{
    bool a_moves = plumb_body_get_type(world, contact->body_a) == PLUMB_DYNAMIC;
    bool b_moves = plumb_body_get_type(world, contact->body_b) == PLUMB_DYNAMIC;
    plumb_vec2 up = plumb_world_up(world);
    bool points_down = jx * (double)up.x + jy * (double)up.y < 0;
    double sign = !b_moves || (a_moves && points_down) ? -1 : 1;
    render_add_impulse(frame, (double)at->point.x, (double)at->point.y, sign * jx, sign * jy);
}

static bool add_contacts(engine_stage *stage, render_frame *frame, unsigned show)
{
    int count = plumb_world_contacts(stage->world, NULL, 0);
    if (!pl_session_reserve(&stage->contacts, &stage->contact_room, count,
                            sizeof *stage->contacts)) {
        return false;
    }
    plumb_contact *list = stage->contacts;
    plumb_world_contacts(stage->world, list, count);
    for (int i = 0; i < count; i++) {
        double nx = (double)list[i].normal.x, ny = (double)list[i].normal.y;
        for (int k = 0; k < list[i].point_count; k++) {
            const plumb_contact_point *p = &list[i].points[k];
            double x = (double)p->point.x, y = (double)p->point.y;
            double j = (double)p->normal_impulse, t = (double)p->tangent_impulse;
            if ((show & RENDER_SHOW_CONTACTS) != 0) {
                render_add_contact(frame, x, y, nx, ny, -(double)p->separation);
            }
            if ((show & RENDER_SHOW_IMPULSES) != 0) {
                // The tangent is the normal turned by a quarter counter-clockwise.
                add_impulse(stage->world, &list[i], p, j * nx - t * ny, j * ny + t * nx, frame);
            }
        }
    }
    return true;
}

/// A colour as a scene said it; a == 0: it said none.
static render_rgba color_said(int palette, scene_rgba c)
{
    return palette >= 0 ? render_palette(palette) : (render_rgba){ c.r, c.g, c.b, c.a };
}

/// How a phase is drawn; a dye has a colour of its own.
static render_rgba liquid_color(const engine_stage *stage, uint32_t phase, uint32_t dye)
{
    if (dye >> 24 != 0) {
        return (render_rgba){ (unsigned char)(dye >> 16), (unsigned char)(dye >> 8),
                              (unsigned char)dye, 0xff };
    }
    if (dye != 0) {
        return render_palette((int)dye - 1);
    }
    const scene_liquid f = stage->scene != NULL ? scene_get_liquid(stage->scene, (int)phase)
                                                : (scene_liquid){ .palette = -1 };
    const render_rgba said = color_said(f.palette, f.color);
    return said.a > 0 || phase == 0 ? said : render_palette((int)phase);
}

/// Colours of liquid in a picture; particles of more have that of the last.
enum { LIQUIDS_MOST = 64 };

/// Particles of one colour.
typedef struct liquid_group {
    uint32_t phase, dye;
} liquid_group;

static int group_of(liquid_group *groups, int *count, const plumb_particle *p)
{
    for (int i = *count - 1; i >= 0; i--) {
        if (groups[i].phase == p->phase && groups[i].dye == p->tag) {
            return i;
        }
    }
    if (*count < LIQUIDS_MOST) {
        groups[(*count)++] = (liquid_group){ p->phase, p->tag };
    }
    return *count - 1;
}

static bool add_liquid(engine_stage *stage, render_frame *frame)
{
    int count, group_count = 0;
    plumb_liquid_desc d;
    liquid_group groups[LIQUIDS_MOST];
    const plumb_particle *p = plumb_liquid_particles(stage->world, &count);
    if (p == NULL || plumb_liquid_settings(stage->world, &d) != PLUMB_OK) {
        return true;
    }
    render_vec *points = malloc((size_t)count * sizeof *points);
    unsigned char *group = malloc((size_t)count);
    for (int i = 0; i < count && group != NULL; i++) {
        group[i] = (unsigned char)group_of(groups, &group_count, &p[i]);
    }
    for (int k = 0; k < group_count && points != NULL; k++) {
        size_t n = 0;
        for (int i = 0; i < count; i++) {
            if (group[i] == k) {
                points[n++] = (render_vec){ (double)p[i].position.x, (double)p[i].position.y };
            }
        }
        render_add_liquid(frame, points, n, (double)d.spacing,
                          liquid_color(stage, groups[k].phase, groups[k].dye));
    }
    const bool good = points != NULL && group != NULL;
    free(points);
    free(group);
    return good;
}

/// Into solids, as far as a cell and a half: so that smoke goes on under bodies, not ends before them.
static void spread_smoke(const plumb_air_box *box, render_vec *points, bool *known)
{
    const int nx = box->columns, ny = box->rows;
    for (int sweep = 0; sweep < 2; sweep++) {
        for (int k = 0; k < nx * ny; k++) {
            const int i = k % nx, j = k / nx;
            render_vec sum = { 0, 0 };
            int count = 0;
            for (int n = 0; n < 4 && !known[k]; n++) {
                const int x = i + (n == 0) - (n == 1), y = j + (n == 2) - (n == 3);
                if (x >= 0 && y >= 0 && x < nx && y < ny && known[y * nx + x]) {
                    sum.x += points[y * nx + x].x;
                    sum.y += points[y * nx + x].y;
                    count++;
                }
            }
            if (count > 0) {
                points[k] = (render_vec){ sum.x / count, sum.y / count };
            }
        }
        for (int k = 0; k < nx * ny; k++) {
            known[k] = known[k] || points[k].x > 0 || points[k].y > 0;
        }
    }
}

enum { GLOW = 400 }; ///< [K] at which air glows

static bool add_air(engine_stage *stage, render_frame *frame)
{
    plumb_air_box box;
    const scene_air looks =
        stage->scene != NULL ? scene_get_air(stage->scene) : (scene_air){ .palette = -1 };
    if (plumb_air_cells(stage->world, &box) != PLUMB_OK || looks.hidden) {
        return true;
    }
    const size_t count = (size_t)box.columns * (size_t)box.rows;
    render_vec *points = malloc(count * sizeof *points);
    bool *known = malloc(count * sizeof *known);
    bool any = false;
    for (size_t k = 0; k < count && points != NULL && known != NULL; k++) {
        const size_t i = k % (size_t)box.columns, j = k / (size_t)box.columns;
        const plumb_air_cell *c = &box.at[j * (size_t)(box.columns + 1) + i];
        known[k] = (double)c->room > 0.3;
        const double heat = (double)c->heat / GLOW;
        points[k] =
            known[k] ? (render_vec){ (double)c->smoke, heat > 0 ? heat : 0 } : (render_vec){ 0, 0 };
        any = any || points[k].x > 0 || points[k].y > 0;
    }
    const bool good = points != NULL && known != NULL;
    if (good && any) {
        const render_vec low = { (double)box.low.x, (double)box.low.y };
        const render_rgba color = color_said(looks.palette, looks.color);
        spread_smoke(&box, points, known);
        render_add_smoke(frame, low, (double)box.cell, box.columns, points, count, color);
    }
    free(known);
    free(points);
    return good;
}

int pl_stage_draw(engine_stage *stage, struct render_frame *frame, unsigned show)
{
    int count = pl_stage_body_count(stage);
    bool good = true, names = wants_names(stage, show);
    plumb_world_desc world = plumb_world_settings(stage->world);
    render_frame_set_period(frame, (double)world.wrap_x, (double)world.wrap_y);
    good = add_liquid(stage, frame) && add_air(stage, frame);
    // What does not move lies behind what does.
    for (int layer = 0; layer < 2; layer++) {
        for (int i = 0; i < count && good; i++) {
            scene_body body = pl_stage_body(stage, i);
            bool is_static = plumb_body_get_type(stage->world, body.entity) == PLUMB_STATIC;
            if (!body.hidden && is_static == (layer == 0)) {
                good = add_body(stage, &body, i, names, show, frame);
            }
        }
        if (layer == 0) {
            good = good && pl_stage_add_softbodies(stage, frame);
        }
    }
    good = good && pl_stage_add_light(stage, frame);
    if ((show & RENDER_SHOW_JOINTS) != 0) {
        pl_stage_add_joints(stage, frame);
    }
    if (good && (show & RENDER_SHOW_CELLS) != 0) {
        good = add_cells(stage, frame);
    }
    if (good && (show & (RENDER_SHOW_CONTACTS | RENDER_SHOW_IMPULSES)) != 0) {
        good = add_contacts(stage, frame, show);
    }
    if (good && (show & RENDER_SHOW_VELOCITIES) != 0) {
        add_velocities(stage, frame);
    }
    if (good && (show & RENDER_SHOW_AABBS) != 0) {
        good = add_boxes(stage, frame);
    }
    return good && render_frame_status(frame) != RENDER_E_MEMORY ? CLI_OK : CLI_FAILED;
}
