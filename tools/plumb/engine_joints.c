/// engine_joints.c - a stage's joints, and the surfaces that run, as parts of a draw list. Compiled
/// once for each precision, as engine.c.
///
/// Reads the world and what the scene hides, writes a render_frame. Cost: O(joints), for surfaces
/// O(shapes).
#include "engine_session.h"

#include <math.h>

#include "../render/render.h"

static render_vec to_render(plumb_vec2 v)
{
    return (render_vec){ (double)v.x, (double)v.y };
}

// ---- joints

static bool has_spring(const plumb_joint_desc *d)
{
    return d->hertz > 0 || d->stiffness > 0 || d->damper > 0;
}

static render_joint_kind sign_of(const plumb_joint_desc *d)
{
    switch (d->kind) {
    case PLUMB_REVOLUTE:
        return RENDER_JOINT_HINGE;
    case PLUMB_PRISMATIC:
        return RENDER_JOINT_SLIDER;
    case PLUMB_WELD:
        return RENDER_JOINT_WELD;
    case PLUMB_WHEEL:
        return RENDER_JOINT_WHEEL;
    case PLUMB_DISTANCE:
        return has_spring(d)     ? RENDER_JOINT_SPRING
               : d->enable_limit ? RENDER_JOINT_ROPE
                                 : RENDER_JOINT_ROD;
    case PLUMB_MOUSE:
        return RENDER_JOINT_POINTER;
    case PLUMB_MOTOR:
        return RENDER_JOINT_DRIVE;
    case PLUMB_GEAR:
        return RENDER_JOINT_GEAR;
    case PLUMB_PULLEY:
        return RENDER_JOINT_PULLEY;
    case PLUMB_RATCHET:
        return RENDER_JOINT_RATCHET;
    case PLUMB_FRICTION:
        return RENDER_JOINT_PADS;
    case PLUMB_CABLE:
        return RENDER_JOINT_CABLE;
    default:
        return RENDER_JOINT_ROD; // a kind without a sign of its own: its anchors
    }
}

/// Half the size of the smaller of two bodies, as their mass is spread: the same however they turn.
static double reach_of(const plumb_world *world, plumb_body a, plumb_body b)
{
    const plumb_body ends[2] = { a, b };
    double least = 0;
    for (int i = 0; i < 2; i++) {
        double mass = (double)plumb_body_mass(world, ends[i]);
        double inertia = (double)plumb_body_inertia(world, ends[i]);
        double reach = mass > 0 && inertia > 0 ? sqrt(inertia / mass) : 0;
        least = reach > 0 && (least == 0 || reach < least) ? reach : least;
    }
    return least;
}

/// The joint's axis now; of a hinge, where B's centre would be at value 0. False when a hinge has none.
static bool axis_of(const plumb_world *world, plumb_joint joint, render_joint *out)
{
    plumb_body a = plumb_joint_body_a(world, joint), b = plumb_joint_body_b(world, joint);
    if (out->kind == RENDER_JOINT_HINGE) {
        plumb_vec2 center = plumb_body_center(world, b);
        plumb_vec2 arm = plumb_world_way(world, plumb_joint_anchor_b(world, joint), center);
        double x = (double)arm.x, y = (double)arm.y;
        double angle = atan2(y, x) - out->value;
        out->axis = (render_vec){ cos(angle), sin(angle) };
        return !plumb_is_null(b) && hypot(x, y) > 0.1 * out->reach;
    }
    plumb_joint_memory memory;
    if (plumb_joint_get_memory(world, joint, &memory) == PLUMB_OK) {
        plumb_vec2 axis = memory.axis;
        out->axis = to_render(plumb_is_null(a) ? axis : plumb_body_world_vector(world, a, axis));
    }
    return true;
}

/// The image of a point that is nearest to another.
static render_vec nearest(const plumb_world *world, plumb_vec2 point, plumb_vec2 to)
{
    plumb_vec2 way = plumb_world_way(world, to, point);
    return (render_vec){ (double)to.x + (double)way.x, (double)to.y + (double)way.y };
}

/// Where a cable leaves its rims, if a line touches both; else it goes from centre to centre.
static void unwind(const plumb_joint_desc *d, render_joint *out)
{
    const double x = out->b.x - out->a.x, y = out->b.y - out->a.y, square = x * x + y * y;
    const double ra = (double)d->radius_a, rb = (double)d->radius_b, e = ra - rb;
    out->via_a = out->a;
    out->via_b = out->b;
    out->slack = fmax((double)d->length - out->value, 0);
    out->reach = 0; // however small its wheels are, it is one rope
    if (square > e * e) {
        const double span = sqrt(square - e * e);
        const render_vec n = { (span * x + e * y) / square, (span * y - e * x) / square };
        out->via_a = (render_vec){ out->a.x - ra * n.y, out->a.y + ra * n.x };
        out->via_b = (render_vec){ out->b.x - rb * n.y, out->b.y + rb * n.x };
    }
}

static void add_joint(const plumb_world *world, plumb_joint joint, render_frame *frame)
{
    plumb_joint_desc d = { .kind = PLUMB_REVOLUTE };
    plumb_joint_settings(world, joint, &d);
    plumb_body a = plumb_joint_body_a(world, joint), b = plumb_joint_body_b(world, joint);
    plumb_vec2 at = plumb_joint_anchor_a(world, joint);
    render_joint out = { .kind = sign_of(&d),
                         .a = to_render(at),
                         .b = nearest(world, plumb_joint_anchor_b(world, joint), at),
                         .via_a = nearest(world, d.ground_a, at),
                         .via_b = nearest(world, d.ground_b, at),
                         .has_limit = d.enable_limit,
                         .lower = (double)d.lower,
                         .upper = (double)d.upper,
                         .value = (double)plumb_joint_value(world, joint),
                         .has_spring = has_spring(&d),
                         .reach = reach_of(world, a, b) };
    if (d.enable_motor && d.motor_speed != 0) {
        out.drive = d.motor_speed > 0 ? 1 : -1;
    }
    if (d.kind == PLUMB_RATCHET) {
        out.drive = d.pitch > 0 ? 1 : -1;
    }
    if (out.kind == RENDER_JOINT_ROPE) {
        out.slack = fmax(out.upper - out.value, 0);
    }
    if (d.kind == PLUMB_CABLE) {
        unwind(&d, &out);
    }
    if (d.kind == PLUMB_GEAR) { // it has no anchors: it ties how bodies turn
        out.a = to_render(plumb_body_center(world, plumb_is_null(a) ? b : a));
        out.b = nearest(world, plumb_body_center(world, plumb_is_null(b) ? a : b),
                        plumb_body_center(world, plumb_is_null(a) ? b : a));
    }
    if (!axis_of(world, joint, &out)) {
        out.has_limit = false;
    }
    render_add_joint(frame, &out);
}

void pl_stage_add_joints(const engine_stage *stage, struct render_frame *frame)
{
    int count = pl_stage_joint_count(stage);
    for (int i = 0; i < count; i++) {
        scene_joint joint = pl_stage_joint(stage, i);
        if (!joint.hidden) {
            add_joint(stage->world, joint.entity, frame);
        }
    }
}

// ---- surfaces

enum {
    CORNER_POINTS = 8, ///< of a round corner of half a turn
    PATH_MAX = PLUMB_POLYGON_MAX_VERTICES * (CORNER_POINTS + 1)
};

/// The outline of a piece grown by its radius, counter-clockwise.
static size_t outline_of(const plumb_convex *piece, plumb_transform where, render_vec *points)
{
    const double turn = 6.283185307179586, radius = (double)piece->radius;
    size_t count = 0;
    double base = atan2((double)where.q.s, (double)where.q.c);
    for (int i = 0; i < piece->count; i++) {
        plumb_vec2 p = piece->points[i];
        plumb_vec2 before = piece->points[(i + piece->count - 1) % piece->count];
        plumb_vec2 after = piece->points[(i + 1) % piece->count];
        double x =
            (double)where.p.x + (double)where.q.c * (double)p.x - (double)where.q.s * (double)p.y;
        double y =
            (double)where.p.y + (double)where.q.s * (double)p.x + (double)where.q.c * (double)p.y;
        // Outward normals of the edges before and after lie a quarter clockwise of them.
        double from = atan2((double)(p.y - before.y), (double)(p.x - before.x)) - turn / 4;
        double to = atan2((double)(after.y - p.y), (double)(after.x - p.x)) - turn / 4;
        if (piece->count == 1) {
            from = 0;
            to = turn * (2 * CORNER_POINTS - 1) / (2 * CORNER_POINTS);
        }
        to += to < from ? turn : 0;
        int steps = radius > 0 ? (piece->count == 1 ? 2 : 1) * CORNER_POINTS : 0;
        for (int k = 0; k <= steps && count < PATH_MAX; k++) {
            double angle = base + (steps > 0 ? from + (to - from) * k / steps : 0);
            points[count++] = (render_vec){ x + radius * cos(angle), y + radius * sin(angle) };
        }
    }
    return count;
}

/// Edges that are the outline's, one by one: of a piece of a concave shape.
static void add_edges(const render_vec *points, size_t count, uint32_t cuts, double travel,
                      render_frame *frame)
{
    for (size_t i = 0; i < count; i++) {
        if ((cuts >> i & 1) == 0) {
            const render_vec edge[2] = { points[i], points[(i + 1) % count] };
            render_add_surface(frame, edge, 2, false, travel);
        }
    }
}

static void add_surface(const plumb_world *world, plumb_shape shape, double run,
                        render_frame *frame)
{
    plumb_transform where = plumb_body_transform(world, plumb_shape_body(world, shape));
    plumb_shape_kind kind = plumb_shape_get_kind(world, shape);
    bool is_line = kind == PLUMB_SEGMENT || kind == PLUMB_CHAIN;
    plumb_vec2 up = plumb_world_up(world);
    for (int i = 0; i < plumb_shape_piece_count(world, shape); i++) {
        plumb_convex piece;
        uint32_t cuts = 0;
        render_vec points[PATH_MAX];
        if (plumb_shape_piece(world, shape, i, &piece, &cuts) != PLUMB_OK) {
            continue;
        }
        // Positive speed runs clockwise, the outline counter-clockwise.
        size_t count = outline_of(&piece, where, points);
        if (is_line && count >= 2) { // what lies on top of it is carried to the right
            double way = (points[1].x - points[0].x) * (double)up.y -
                         (points[1].y - points[0].y) * (double)up.x;
            render_add_surface(frame, points, 2, false, way > 0 ? run : -run);
        } else if (kind == PLUMB_OUTLINE) {
            add_edges(points, count, cuts, -run, frame);
        } else {
            render_add_surface(frame, points, count, true, -run);
        }
    }
}

void pl_stage_add_surfaces(const engine_stage *stage, const plumb_shape *shapes, int count,
                           struct render_frame *frame)
{
    const double moment = 1e-9; // [s] the sign of how far it has run tells the way even at time 0
    for (int i = 0; i < count; i++) {
        plumb_material_desc m;
        plumb_material material = plumb_shape_material(stage->world, shapes[i]);
        if (!plumb_shape_is_sensor(stage->world, shapes[i]) &&
            plumb_material_settings(stage->world, material, &m) == PLUMB_OK &&
            m.surface_speed != 0) {
            double run = (double)m.surface_speed * (pl_stage_time(stage) + moment);
            add_surface(stage->world, shapes[i], run, frame);
        }
    }
}
