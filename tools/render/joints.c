// joints.c - joints, each kind with a sign of its own, as engineers sketch them: pins, rails,
// zigzag springs, ropes that sag when slack, toothed rings, pulley wheels; arcs for limits, a round
// arrow for a motor. Signs shrink where bodies are small in the picture, and have a light rim that
// keeps them apart from what they lie on. Cost: O(joints), some 50 vertices each.
#include "internal.h"

#include <math.h>

static const render_rgba ink = { 0x3d, 0x43, 0x55, 0xff };
static const render_rgba limit_color = { 0x2b, 0x74, 0x8c, 0xff };
static const render_rgba motor_color = { 0xc4, 0x5f, 0x10, 0xff };

// Sizes in pixels at ui_scale 1 of a sign at its full size, chosen by eye.
static const double line_width = 2.0;
static const double rim_width = 1.3;    // on each side
static const double full_reach = 16.0;  // half of a body that has room for the full size
static const double least_size = 0.35;  // share of the full size that is still legible
static const double least_width = 0.6;  // the same of a line
static const double rail_length = 20.0; // of a rail without limits, to each side

/// A joint in pixels; y downwards, as the picture's.
typedef struct sketch {
    render_joint_kind kind;
    render_vec a, b, via_a, via_b;
    render_vec axis;     // unit
    double lower, upper; // along the axis [px], or of the arc [rad]
    bool has_limit, has_spring;
    double value; // [rad] in the arc
    double drive; // sign of the motor; turning as the picture's y does
    double slack; // [px]
    double u;     // one pixel of the sign's full size
} sketch;

static render_vec along(render_vec from, render_vec way, double distance)
{
    return (render_vec){ from.x + way.x * distance, from.y + way.y * distance };
}

static render_vec turned(double angle)
{
    return (render_vec){ cos(angle), sin(angle) };
}

static double apart(render_vec a, render_vec b)
{
    return hypot(b.x - a.x, b.y - a.y);
}

// A line with its rim.
static void stroke(plr_painter *painter, const sketch *s, const render_vec *points, size_t count,
                   bool closed, double width, render_rgba color)
{
    const render_rgba rim = plr_fade(painter->options.background, 0.75);
    const double u = fmax(s->u, least_width * painter->ui);
    plr_stroke(painter, points, count, closed, (width + 2.0 * rim_width) * u, rim, rim);
    plr_stroke(painter, points, count, closed, width * u, color, color);
}

static void line(plr_painter *painter, const sketch *s, render_vec a, render_vec b)
{
    stroke(painter, s, (render_vec[2]){ a, b }, 2, false, line_width, ink);
}

static void dashed(plr_painter *painter, const sketch *s, render_vec a, render_vec b)
{
    const render_vec ends[2] = { a, b };
    const render_rgba rim = plr_fade(painter->options.background, 0.6);
    plr_line(painter, a, b, (line_width + 1.6) * s->u, rim);
    plr_dashes(painter, ends, 2, false, 0.8 * line_width * s->u, 5.0 * s->u, 4.0 * s->u, ink);
}

static void knob(plr_painter *painter, const sketch *s, render_vec at, double radius)
{
    plr_dot(painter, at, (radius + rim_width) * s->u, plr_fade(painter->options.background, 0.75));
    plr_dot(painter, at, radius * s->u, ink);
    plr_dot(painter, at, (radius - 1.5) * s->u, painter->options.background);
}

// ---- parts

static void zigzag(plr_painter *painter, const sketch *s, render_vec a, render_vec b)
{
    enum { bends = 12 };
    render_vec points[bends + 4];
    const double length = apart(a, b), amplitude = 4.5 * s->u;
    if (length < 2.0 * amplitude) {
        line(painter, s, a, b);
        return;
    }
    const render_vec d = { (b.x - a.x) / length, (b.y - a.y) / length }, n = { -d.y, d.x };
    const double lead = fmin(0.14 * length, 3.0 * amplitude);
    size_t count = 0;
    points[count++] = a;
    points[count++] = along(a, d, lead);
    for (int i = 0; i < bends; i++) {
        const render_vec p = along(a, d, lead + (length - 2.0 * lead) * (i + 0.5) / bends);
        points[count++] = along(p, n, i % 2 == 0 ? amplitude : -amplitude);
    }
    points[count++] = along(b, d, -lead);
    points[count++] = b;
    stroke(painter, s, points, count, false, 0.75 * line_width, ink);
}

// A slack rope hangs: a parabola of about the rope's length, L^2 = d^2 + (16/3) sag^2 for small sag.
static void rope(plr_painter *painter, const sketch *s, render_vec a, render_vec b)
{
    enum { pieces = 20 };
    render_vec points[pieces + 1];
    const double d = apart(a, b), length = d + fmax(s->slack, 0.0);
    const double sag = sqrt(fmax(length * length - d * d, 0.0) * (3.0 / 16.0));
    for (int i = 0; i <= pieces; i++) {
        const double t = (double)i / pieces;
        points[i] = (render_vec){ a.x + t * (b.x - a.x),
                                  a.y + t * (b.y - a.y) + 4.0 * sag * t * (1.0 - t) };
    }
    stroke(painter, s, points, pieces + 1, false, 0.8 * line_width, ink);
}

// Around a point from `from` to `to` [rad].
static void arc(plr_painter *painter, const sketch *s, render_vec at, double radius, double from,
                double to, double width, render_rgba color)
{
    enum { pieces = 28 };
    render_vec points[pieces + 1];
    for (int i = 0; i <= pieces; i++) {
        points[i] = along(at, turned(from + (to - from) * i / pieces), radius);
    }
    stroke(painter, s, points, pieces + 1, false, width, color);
}

// A limit of a hinge: how far it may turn, and where it is.
static void swing(plr_painter *painter, const sketch *s)
{
    const double radius = 13.0 * s->u, tick = 3.0 * s->u;
    if (s->upper - s->lower > 2.0 * PLR_PI) {
        return;
    }
    arc(painter, s, s->b, radius, s->lower, s->upper, 1.3, limit_color);
    const double ends[2] = { s->lower, s->upper };
    for (int i = 0; i < 2; i++) {
        const render_vec way = turned(ends[i]);
        plr_line(painter, along(s->b, way, radius - tick), along(s->b, way, radius + tick),
                 1.3 * s->u, limit_color);
    }
    const render_vec way = turned(s->value);
    plr_line(painter, s->b, along(s->b, way, radius - 1.5 * s->u), 1.1 * s->u, limit_color);
}

static void round_arrow(plr_painter *painter, const sketch *s, render_vec at)
{
    const double radius = 9.0 * s->u, way = s->drive > 0.0 ? 1.0 : -1.0;
    const double from = -0.5 * PLR_PI - 2.2 * way, to = -0.5 * PLR_PI + 1.7 * way;
    arc(painter, s, at, radius, from, to, 1.7, motor_color);
    const render_vec end = along(at, turned(to), radius);
    const render_vec forward = turned(to + 0.5 * PLR_PI * way), out = turned(to);
    const render_vec tip[3] = { along(end, forward, 5.0 * s->u), along(end, out, 3.2 * s->u),
                                along(end, out, -3.2 * s->u) };
    plr_fill(painter, tip, 3, motor_color);
}

static void toothed(plr_painter *painter, const sketch *s, render_vec at, double slant)
{
    enum { teeth = 9 };
    render_vec points[4 * teeth];
    const double low = 5.4 * s->u, high = 8.2 * s->u, pitch = 2.0 * PLR_PI / teeth;
    for (int i = 0; i < teeth; i++) {
        const double angle = pitch * i;
        points[4 * i] = along(at, turned(angle - 0.30 * pitch), low);
        points[4 * i + 1] = along(at, turned(angle - (0.16 - slant) * pitch), high);
        points[4 * i + 2] = along(at, turned(angle + (0.16 + slant) * pitch), high);
        points[4 * i + 3] = along(at, turned(angle + 0.30 * pitch), low);
    }
    stroke(painter, s, points, 4 * teeth, true, 1.3, ink);
    plr_dot(painter, at, 1.6 * s->u, ink);
}

// A bar across a rail.
static void stop(plr_painter *painter, const sketch *s, render_vec at)
{
    const render_vec n = { -s->axis.y, s->axis.x };
    line(painter, s, along(at, n, -4.0 * s->u), along(at, n, 4.0 * s->u));
}

static void rail(plr_painter *painter, const sketch *s, render_vec *low, render_vec *high)
{
    const double most = rail_length * s->u;
    // A limit far beyond the picture is none that could be seen.
    const double far = 4.0 * (painter->width + painter->height);
    const bool bounded = s->has_limit && s->upper < far && s->lower > -far;
    const double here = (s->b.x - s->a.x) * s->axis.x + (s->b.y - s->a.y) * s->axis.y;
    *low = along(s->a, s->axis, bounded ? s->lower : fmin(0.0, here) - most);
    *high = along(s->a, s->axis, bounded ? s->upper : fmax(0.0, here) + most);
    if (bounded) {
        line(painter, s, *low, *high);
        stop(painter, s, *low);
        stop(painter, s, *high);
    } else {
        dashed(painter, s, *low, *high);
    }
}

// ---- kinds

static void draw_hinge(plr_painter *painter, const sketch *s)
{
    if (apart(s->a, s->b) > 1.0) { // it has come apart
        line(painter, s, s->a, s->b);
    }
    if (s->has_limit) {
        swing(painter, s);
    }
    knob(painter, s, s->b, 4.0);
    if (s->has_spring) {
        arc(painter, s, s->b, 6.6 * s->u, 0.4, 2.4 * PLR_PI, 1.1, ink);
    }
}

static void draw_slider(plr_painter *painter, const sketch *s)
{
    render_vec low, high;
    const render_vec n = { -s->axis.y, s->axis.x };
    const double w = 6.0 * s->u, h = 3.6 * s->u;
    rail(painter, s, &low, &high);
    if (s->has_spring) {
        zigzag(painter, s, s->a, s->b);
    }
    const render_vec left = along(s->b, s->axis, -w), right = along(s->b, s->axis, w);
    const render_vec corners[4] = { along(left, n, h), along(right, n, h), along(right, n, -h),
                                    along(left, n, -h) };
    plr_fill(painter, corners, 4, painter->options.background);
    stroke(painter, s, corners, 4, true, 1.6, ink);
    if (s->drive != 0.0) {
        const double way = s->drive > 0.0 ? 1.0 : -1.0;
        const render_vec from = along(s->b, n, 8.0 * s->u);
        plr_arrow(painter, along(from, s->axis, -8.0 * s->u * way),
                  along(from, s->axis, 10.0 * s->u * way), 1.7 * s->u, motor_color);
    }
}

static void draw_wheel(plr_painter *painter, const sketch *s)
{
    render_vec low, high;
    const double top = fmax(s->has_limit ? s->upper : 0.0, 18.0 * s->u);
    if (s->has_spring) { // the strut, as far as the mount above the wheel
        const render_vec mount = along(s->a, s->axis, top);
        zigzag(painter, s, s->b, mount);
        stop(painter, s, mount);
    } else {
        rail(painter, s, &low, &high);
    }
    knob(painter, s, s->b, 4.0);
}

static void draw_weld(plr_painter *painter, const sketch *s)
{
    const double r = 4.4 * s->u;
    line(painter, s, s->a, s->b);
    const render_vec corners[4] = { { s->b.x - r, s->b.y },
                                    { s->b.x, s->b.y - r },
                                    { s->b.x + r, s->b.y },
                                    { s->b.x, s->b.y + r } };
    stroke(painter, s, corners, 4, true, 1.6, ink);
    plr_fill(painter, corners, 4, s->has_spring ? painter->options.background : ink);
}

static void draw_pulley(plr_painter *painter, const sketch *s)
{
    const render_vec path[4] = { s->a, s->via_a, s->via_b, s->b };
    stroke(painter, s, path, 4, false, 0.8 * line_width, ink);
    for (int i = 1; i <= 2; i++) {
        plr_dot(painter, path[i], 6.5 * s->u, painter->options.background);
        plr_ring(painter, path[i], 6.5 * s->u, 1.8 * s->u, ink);
        plr_dot(painter, path[i], 1.6 * s->u, ink);
    }
    knob(painter, s, s->a, 3.0);
    knob(painter, s, s->b, 3.0);
}

// What is wound on a rim is a ring; a rope that is tied to a point ends in a knob.
static void draw_cable(plr_painter *painter, const sketch *s)
{
    const render_vec middles[2] = { s->a, s->b }, ends[2] = { s->via_a, s->via_b };
    rope(painter, s, s->via_a, s->via_b);
    for (int i = 0; i < 2; i++) {
        const double radius = apart(middles[i], ends[i]);
        if (radius > 3.0 * s->u) {
            arc(painter, s, middles[i], radius, 0.0, 2.0 * PLR_PI, 0.8 * line_width, ink);
        } else {
            knob(painter, s, ends[i], 3.0);
        }
    }
}

static void draw_pads(plr_painter *painter, const sketch *s)
{
    const double w = 6.0 * s->u, h = 2.6 * s->u;
    for (int side = -1; side <= 1; side += 2) {
        const render_vec a = { s->b.x - w, s->b.y + side * h }, b = { s->b.x + w, a.y };
        line(painter, s, a, b);
        for (int i = -1; i <= 1; i++) {
            const render_vec p = { s->b.x + i * 4.0 * s->u, a.y };
            plr_line(painter, p, (render_vec){ p.x + 2.4 * s->u, p.y + side * 3.4 * s->u },
                     1.1 * s->u, ink);
        }
    }
}

static void draw(plr_painter *painter, const sketch *s)
{
    switch (s->kind) {
    case RENDER_JOINT_HINGE:
        draw_hinge(painter, s);
        break;
    case RENDER_JOINT_SLIDER:
        draw_slider(painter, s);
        return; // its motor is an arrow along the rail
    case RENDER_JOINT_WELD:
        draw_weld(painter, s);
        break;
    case RENDER_JOINT_WHEEL:
        draw_wheel(painter, s);
        break;
    case RENDER_JOINT_ROD:
    case RENDER_JOINT_SPRING:
    case RENDER_JOINT_ROPE:
        if (s->kind == RENDER_JOINT_SPRING) {
            zigzag(painter, s, s->a, s->b);
        } else if (s->kind == RENDER_JOINT_ROPE) {
            rope(painter, s, s->a, s->b);
        } else {
            line(painter, s, s->a, s->b);
        }
        knob(painter, s, s->a, 3.0);
        knob(painter, s, s->b, 3.0);
        break;
    case RENDER_JOINT_POINTER:
        dashed(painter, s, s->b, s->a);
        knob(painter, s, s->b, 3.0);
        plr_ring(painter, s->a, 5.0 * s->u, 1.4 * s->u, ink);
        line(painter, s, (render_vec){ s->a.x - 8.0 * s->u, s->a.y },
             (render_vec){ s->a.x + 8.0 * s->u, s->a.y });
        line(painter, s, (render_vec){ s->a.x, s->a.y - 8.0 * s->u },
             (render_vec){ s->a.x, s->a.y + 8.0 * s->u });
        break;
    case RENDER_JOINT_DRIVE:
        dashed(painter, s, s->a, s->b);
        knob(painter, s, s->b, 3.4);
        break;
    case RENDER_JOINT_GEAR:
        dashed(painter, s, s->a, s->b);
        toothed(painter, s, s->a, 0.0);
        toothed(painter, s, s->b, 0.0);
        break;
    case RENDER_JOINT_PULLEY:
        draw_pulley(painter, s);
        break;
    case RENDER_JOINT_RATCHET:
        toothed(painter, s, s->b, s->drive > 0.0 ? 0.3 : -0.3);
        return; // its direction is that of the teeth
    case RENDER_JOINT_PADS:
        draw_pads(painter, s);
        break;
    case RENDER_JOINT_CABLE:
        draw_cable(painter, s);
        break;
    case RENDER_JOINT_KINDS:
        return;
    }
    if (s->drive != 0.0) {
        round_arrow(painter, s, s->b);
    }
}

// ---- from the frame, and for the legend

static sketch make_sketch(const plr_painter *painter, const render_joint *j)
{
    const double up = painter->camera->y_down ? 1.0 : -1.0, scale = painter->scale;
    const double room = j->reach > 0.0 ? j->reach * scale / (full_reach * painter->ui) : 1.0;
    sketch s = { .kind = j->kind,
                 .a = plr_pixel(painter, j->a),
                 .b = plr_pixel(painter, j->b),
                 .via_a = plr_pixel(painter, j->via_a),
                 .via_b = plr_pixel(painter, j->via_b),
                 .axis = { j->axis.x, j->axis.y * up },
                 .has_limit = j->has_limit,
                 .has_spring = j->has_spring,
                 .drive = j->drive * up,
                 .slack = j->slack * scale,
                 .u = painter->ui * fmin(fmax(room, least_size), 1.0) };
    if (j->kind == RENDER_JOINT_HINGE) {
        const double zero = atan2(s.axis.y, s.axis.x);
        const double low = zero + up * j->lower, high = zero + up * j->upper;
        s.lower = fmin(low, high);
        s.upper = fmax(low, high);
        s.value = zero + up * j->value;
    } else {
        s.lower = j->lower * scale;
        s.upper = j->upper * scale;
    }
    if (j->kind == RENDER_JOINT_SLIDER) {
        s.drive = j->drive; // along the axis, which is turned already
    }
    return s;
}

void plr_draw_joints(plr_painter *painter)
{
    const render_frame *frame = painter->frame;
    if (!plr_shows(painter, RENDER_SHOW_JOINTS)) {
        return;
    }
    for (size_t i = 0; i < frame->joint_count; i++) {
        const sketch s = make_sketch(painter, &frame->joints[i]);
        draw(painter, &s);
    }
}

const char *plr_joint_name(render_joint_kind kind)
{
    static const char *const names[RENDER_JOINT_KINDS] = {
        [RENDER_JOINT_ROD] = "rod",
        [RENDER_JOINT_ROPE] = "rope",
        [RENDER_JOINT_SPRING] = "spring",
        [RENDER_JOINT_HINGE] = "hinge",
        [RENDER_JOINT_SLIDER] = "slider",
        [RENDER_JOINT_WELD] = "weld",
        [RENDER_JOINT_WHEEL] = "wheel",
        [RENDER_JOINT_POINTER] = "mouse",
        [RENDER_JOINT_DRIVE] = "motor to a pose",
        [RENDER_JOINT_GEAR] = "gear",
        [RENDER_JOINT_PULLEY] = "pulley",
        [RENDER_JOINT_RATCHET] = "ratchet",
        [RENDER_JOINT_PADS] = "friction",
        [RENDER_JOINT_CABLE] = "cable",
    };
    return names[kind];
}

void plr_joint_sample(plr_painter *painter, const render_joint *like, render_vec middle,
                      double size)
{
    const double half = 0.36 * size;
    const render_vec left = { middle.x - half, middle.y }, right = { middle.x + half, middle.y };
    sketch s = { .kind = like->kind,
                 .a = middle,
                 .b = middle,
                 .axis = { 1.0, 0.0 },
                 .has_spring = like->has_spring,
                 .drive = like->drive,
                 .u = 0.9 * painter->ui };
    switch (like->kind) {
    case RENDER_JOINT_WHEEL:
        s.axis = (render_vec){ 0.0, -1.0 };
        s.u = 0.62 * painter->ui;
        s.a = s.b = (render_vec){ middle.x, middle.y + 0.22 * size };
        break;
    case RENDER_JOINT_SLIDER:
        s.has_spring = false;
        s.has_limit = true;
        s.lower = -0.5 * size;
        s.upper = 0.5 * size;
        s.u = 0.7 * painter->ui;
        break;
    case RENDER_JOINT_PULLEY:
        s.u = 0.6 * painter->ui;
        s.via_a = (render_vec){ left.x, left.y - 0.15 * size };
        s.via_b = (render_vec){ right.x, left.y - 0.15 * size };
        s.a = (render_vec){ left.x, left.y + 0.35 * size };
        s.b = (render_vec){ right.x, left.y + 0.35 * size };
        break;
    case RENDER_JOINT_GEAR:
        s.u = 0.6 * painter->ui;
        s.a = left;
        s.b = right;
        break;
    case RENDER_JOINT_CABLE:
        s.u = 0.75 * painter->ui;
        s.a = left;
        s.b = s.via_b = right;
        s.via_a = (render_vec){ left.x, left.y - 0.22 * size };
        break;
    case RENDER_JOINT_HINGE:
    case RENDER_JOINT_WELD:
    case RENDER_JOINT_RATCHET:
    case RENDER_JOINT_PADS:
        break;
    default:
        s.a = left;
        s.b = right;
        s.u = 0.75 * painter->ui;
        break;
    }
    draw(painter, &s);
}
