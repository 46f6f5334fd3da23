// overlay.c - what explains the motion: trails, boxes, cells, running surfaces, contacts, arrows,
// texts. Joints are in joints.c.
//
// Marks lie in one array; each kind is drawn in one sweep over it, in a fixed order. Arrows have
// a length in the world, scaled by a round number (1, 2 or 5 times a power of ten) that the legend
// states. Cost: O(marks) a kind that is switched on.
#include "internal.h"

#include <math.h>

static const render_rgba contact_color = { 0xc2, 0x2f, 0x3d, 0xff };
static const render_rgba impulse_color = { 0xd9, 0x5f, 0x0e, 0xff };
static const render_rgba velocity_color = { 0x1f, 0x6f, 0x9f, 0xff };
static const render_rgba aabb_color = { 0x7a, 0x5c, 0xa8, 0xff };
static const render_rgba cell_color = { 0x2f, 0x95, 0x7a, 0xff };
static const render_rgba field_weak = { 0xb9, 0xc9, 0xd6, 0xff };
static const render_rgba field_strong = { 0x8a, 0x2f, 0x73, 0xff };
static const render_rgba flow_slow = { 0x8f, 0xa8, 0xbc, 0xff };
static const render_rgba flow_fast = { 0x0d, 0x4f, 0x8b, 0xff };
static const render_rgba north_color = { 0xc8, 0x2a, 0x2f, 0xff };
static const render_rgba south_color = { 0x2b, 0x5c, 0xb0, 0xff };
static const render_rgba surface_color = { 0xf0, 0x9a, 0x3e, 0xff };

// The longest arrow is at most this share of the picture's height under automatic scale.
static const double arrow_share = 0.16;
// Speeds that would take 50 s to cross the picture's height are rest [1/s]: arrows are not scaled
// up further than makes this one as long as the longest, so the noise of bodies at rest shows none.
static const double rest_share = 0.02;
static const double surface_distance = 24.0; // between chevrons [px at ui_scale 1]
static const double surface_inset = 5.5;     // of chevrons of an outline [px at ui_scale 1]
static const double normal_length = 13.0;    // of a contact normal [px at ui_scale 1]
enum { text_size = 13 };                     // [px at ui_scale 1]

static bool visible(const plr_painter *painter, plr_mark_kind kind, unsigned flag)
{
    return plr_shows(painter, flag) && painter->frame->mark_kind_count[kind] > 0;
}

double plr_arrow_scale(const plr_painter *painter, plr_mark_kind kind)
{
    const double given =
        kind == PLR_IMPULSE ? painter->options.impulse_scale : painter->options.velocity_scale;
    if (given > 0.0) {
        return given;
    }
    double longest = 0.0;
    for (size_t i = 0; i < painter->frame->mark_count; i++) {
        const plr_mark *mark = &painter->frame->marks[i];
        if (mark->kind == kind) {
            longest = fmax(longest, hypot(mark->b.x, mark->b.y));
        }
    }
    // Impulses have no such bound: those that carry a body at rest are worth seeing.
    if (kind == PLR_VELOCITY) {
        longest = fmax(longest, rest_share * painter->camera->view_height);
    }
    const double fits = arrow_share * painter->camera->view_height / longest;
    return longest > 0.0 && isfinite(fits) ? plr_round_step(fits) : 1.0;
}

// ---- below the bodies

// From where it was, where it is nothing, to where it is.
static void draw_flow(plr_painter *painter, const plr_mark *mark)
{
    enum { most = 32 };
    render_vec points[most];
    const size_t n = mark->point_count < most ? mark->point_count : most;
    for (size_t i = 0; i < n; i++) {
        points[i] = plr_pixel(painter, painter->frame->points[mark->first_point + i]);
    }
    const double share = mark->variant / 255.0;
    const render_rgba color = plr_mix(flow_slow, flow_fast, share);
    plr_stroke(painter, points, n, false, 1.6 * painter->ui, plr_fade(color, 0.0),
               plr_fade(color, 0.45 + 0.5 * share));
}

static void draw_trail(plr_painter *painter, const plr_mark *mark)
{
    enum { chunk = 256 };
    render_vec points[chunk];
    const render_vec *world = painter->frame->points + mark->first_point;
    const render_rgba color = plr_mix(mark->color, plr_ink, 0.15);
    const double span = (double)(mark->point_count - 1);
    for (size_t start = 0; start + 1 < mark->point_count; start += chunk - 1) {
        size_t n = 0;
        for (; n < chunk && start + n < mark->point_count; n++) {
            points[n] = plr_pixel(painter, world[start + n]);
        }
        const double t0 = (double)start / span, t1 = (double)(start + n - 1) / span;
        plr_stroke(painter, points, n, false, 2.2 * painter->ui, plr_fade(color, 0.75 * t0),
                   plr_fade(color, 0.75 * t1));
    }
}

// The middle of the pixel a point lies in: thin axis-parallel lines there are not blurred.
static render_vec crisp(render_vec p)
{
    return (render_vec){ floor(p.x) + 0.5, floor(p.y) + 0.5 };
}

// A rectangle given by two corners in the world.
static void draw_box(plr_painter *painter, const plr_mark *mark, render_rgba color,
                     render_rgba fill)
{
    const render_vec a = crisp(plr_pixel(painter, mark->a));
    const render_vec b = crisp(plr_pixel(painter, mark->b));
    const render_vec corners[4] = { a, { b.x, a.y }, b, { a.x, b.y } };
    if (fill.a > 0) {
        plr_fill(painter, corners, 4, fill);
    }
    plr_stroke(painter, corners, 4, true, fmax(1.0, painter->ui), color, color);
}

// World vector to pixel vector.
static render_vec pixel_vector(const plr_painter *painter, render_vec v)
{
    const double up = painter->camera->y_down ? 1.0 : -1.0;
    return (render_vec){ v.x * painter->scale, v.y * painter->scale * up };
}

// The place is in the middle of its arrow.
static void draw_field(plr_painter *painter, const plr_mark *mark)
{
    const render_vec at = plr_pixel(painter, mark->a), v = pixel_vector(painter, mark->b);
    const render_vec tail = { at.x - v.x / 2.0, at.y - v.y / 2.0 };
    const render_vec tip = { at.x + v.x / 2.0, at.y + v.y / 2.0 };
    plr_arrow(painter, tail, tip, 1.5 * painter->ui,
              plr_mix(field_weak, field_strong, mark->variant / 255.0));
}

void plr_draw_underlay(plr_painter *painter)
{
    const bool field = visible(painter, PLR_FIELD, RENDER_SHOW_FIELD);
    const bool flow = visible(painter, PLR_FLOW, RENDER_SHOW_FLOW);
    const bool cells = visible(painter, PLR_CELL, RENDER_SHOW_CELLS);
    const bool trails = visible(painter, PLR_TRAIL, RENDER_SHOW_TRAILS);
    const render_frame *frame = painter->frame;
    for (size_t i = 0; cells && i < frame->mark_count; i++) {
        if (frame->marks[i].kind == PLR_CELL) {
            draw_box(painter, &frame->marks[i], plr_fade(cell_color, 0.35),
                     plr_fade(cell_color, 0.07));
        }
    }
    for (size_t i = 0; field && i < frame->mark_count; i++) {
        if (frame->marks[i].kind == PLR_FIELD) {
            draw_field(painter, &frame->marks[i]);
        }
    }
    for (size_t i = 0; flow && i < frame->mark_count; i++) {
        if (frame->marks[i].kind == PLR_FLOW) {
            draw_flow(painter, &frame->marks[i]);
        }
    }
    for (size_t i = 0; trails && i < frame->mark_count; i++) {
        if (frame->marks[i].kind == PLR_TRAIL) {
            draw_trail(painter, &frame->marks[i]);
        }
    }
}

// ---- above the bodies

static void chevron(plr_painter *painter, render_vec at, render_vec d, render_rgba color)
{
    const double w = 2.6 * painter->ui, h = 3.0 * painter->ui;
    const render_vec n = { -d.y, d.x };
    const render_vec points[3] = { { at.x - d.x * w + n.x * h, at.y - d.y * w + n.y * h },
                                   { at.x + d.x * w, at.y + d.y * w },
                                   { at.x - d.x * w - n.x * h, at.y - d.y * w - n.y * h } };
    plr_stroke(painter, points, 3, false, 1.6 * painter->ui, color, color);
}

// Chevrons at equal distances along the path, moved on by how far the surface has run.
static void draw_surface(plr_painter *painter, const render_vec *world, size_t count, bool closed,
                         double travel)
{
    const double distance = surface_distance * painter->ui;
    // Those of an outline lie within it: to the left of the path, on the right in a picture with y up.
    const double inset = closed ? surface_inset * painter->ui : 0.0;
    const double side = painter->camera->y_down ? -1.0 : 1.0;
    const double sign = travel < 0.0 ? -1.0 : 1.0;
    const double total = travel * painter->scale;
    double next = total - floor(total / distance) * distance; // along the path so far
    const size_t segments = closed ? count : count - 1;
    for (size_t i = 0; i < segments; i++) {
        const render_vec a = plr_pixel(painter, world[i]);
        const render_vec b = plr_pixel(painter, world[(i + 1) % count]);
        const double length = hypot(b.x - a.x, b.y - a.y);
        if (length > 1e5) {
            return; // far too near to be looked at
        }
        for (; next < length; next += distance) {
            const render_vec d = { (b.x - a.x) / length, (b.y - a.y) / length };
            const render_vec p = { a.x + d.x * next + side * d.y * inset,
                                   a.y + d.y * next - side * d.x * inset };
            chevron(painter, p, (render_vec){ sign * d.x, sign * d.y }, surface_color);
        }
        next -= length;
    }
}

// A rhombus, one half of each colour, with a light rim: it is seen on bodies of any colour.
static void draw_dipole(plr_painter *painter, render_vec at, render_vec half, double across)
{
    const double length = hypot(half.x, half.y);
    if (length < 1.0) {
        return;
    }
    const render_vec side = { -half.y / length * across, half.x / length * across };
    const render_vec tip = { at.x + half.x, at.y + half.y },
                     tail = { at.x - half.x, at.y - half.y };
    const render_vec left = { at.x + side.x, at.y + side.y };
    const render_vec right = { at.x - side.x, at.y - side.y };
    const render_vec rim[4] = { tip, left, tail, right };
    const render_rgba light = plr_fade(plr_background, 0.9);
    plr_stroke(painter, rim, 4, true, 2.0 * painter->ui, light, light);
    plr_fill(painter, (render_vec[3]){ left, right, tip }, 3, north_color);
    plr_fill(painter, (render_vec[3]){ left, right, tail }, 3, south_color);
}

static void draw_contact(plr_painter *painter, render_vec at, render_vec normal, double depth)
{
    const double ui = painter->ui;
    const double length = hypot(normal.x, normal.y);
    if (length > 0.0) {
        const double k = normal_length * ui / length;
        plr_line(painter, at, (render_vec){ at.x + normal.x * k, at.y + normal.y * k }, 1.5 * ui,
                 contact_color);
    }
    plr_dot(painter, at, 3.3 * ui, plr_background);
    if (depth > 0.0) {
        plr_dot(painter, at, 2.5 * ui, contact_color);
    } else {
        plr_ring(painter, at, 2.1 * ui, 1.2 * ui, contact_color); // a gap: speculative contact
    }
}

static void draw_arrow(plr_painter *painter, const plr_mark *mark, double scale, render_rgba color)
{
    const render_vec a = plr_pixel(painter, mark->a);
    const render_vec v = pixel_vector(painter, mark->b);
    const render_vec b = { a.x + v.x * scale, a.y + v.y * scale };
    plr_arrow(painter, a, b, 2.0 * painter->ui, color);
}

void plr_draw_overlay(plr_painter *painter)
{
    static const struct {
        plr_mark_kind kind;
        unsigned flag;
    } order[] = { { PLR_AABB, RENDER_SHOW_AABBS },       { PLR_SURFACE, RENDER_SHOW_SURFACES },
                  { PLR_DIPOLE, RENDER_SHOW_DIPOLES },   { PLR_VELOCITY, RENDER_SHOW_VELOCITIES },
                  { PLR_IMPULSE, RENDER_SHOW_IMPULSES }, { PLR_CONTACT, RENDER_SHOW_CONTACTS } };
    const render_frame *frame = painter->frame;
    plr_draw_joints(painter);
    for (size_t k = 0; k < sizeof order / sizeof order[0]; k++) {
        if (!visible(painter, order[k].kind, order[k].flag)) {
            continue;
        }
        const double scale = plr_arrow_scale(painter, order[k].kind);
        for (size_t i = 0; i < frame->mark_count; i++) {
            const plr_mark *mark = &frame->marks[i];
            if (mark->kind != order[k].kind) {
                continue;
            }
            if (mark->kind == PLR_AABB) {
                draw_box(painter, mark, plr_fade(aabb_color, 0.55), (render_rgba){ 0 });
            } else if (mark->kind == PLR_SURFACE) {
                draw_surface(painter, frame->points + mark->first_point, mark->point_count,
                             mark->variant != 0, mark->value);
            } else if (mark->kind == PLR_DIPOLE) {
                draw_dipole(painter, plr_pixel(painter, mark->a), pixel_vector(painter, mark->b),
                            mark->value * painter->scale);
            } else if (mark->kind == PLR_CONTACT) {
                draw_contact(painter, plr_pixel(painter, mark->a), pixel_vector(painter, mark->b),
                             mark->value);
            } else {
                draw_arrow(painter, mark, scale,
                           mark->kind == PLR_IMPULSE ? impulse_color : velocity_color);
            }
        }
    }
}

void plr_overlay_sample(plr_painter *painter, plr_mark_kind kind, render_vec middle, double size)
{
    const double half = 0.5 * size, line = fmax(1.0, painter->ui);
    const render_vec left = { middle.x - half, middle.y }, right = { middle.x + half, middle.y };
    const render_vec corners[4] = { { left.x, middle.y - 0.55 * half },
                                    { right.x, middle.y - 0.55 * half },
                                    { right.x, middle.y + 0.55 * half },
                                    { left.x, middle.y + 0.55 * half } };
    const render_rgba trail = render_palette(0);
    switch (kind) {
    case PLR_CONTACT:
        draw_contact(painter, (render_vec){ left.x + 0.5 * half, middle.y },
                     (render_vec){ 1.0, 0.0 }, 1.0);
        break;
    case PLR_IMPULSE:
        plr_arrow(painter, left, right, 2.0 * painter->ui, impulse_color);
        break;
    case PLR_VELOCITY:
        plr_arrow(painter, left, right, 2.0 * painter->ui, velocity_color);
        break;
    case PLR_AABB:
        plr_stroke(painter, corners, 4, true, line, plr_fade(aabb_color, 0.7),
                   plr_fade(aabb_color, 0.7));
        break;
    case PLR_CELL:
        plr_fill(painter, corners, 4, plr_fade(cell_color, 0.12));
        plr_stroke(painter, corners, 4, true, line, plr_fade(cell_color, 0.5),
                   plr_fade(cell_color, 0.5));
        break;
    case PLR_FIELD:
        plr_arrow(painter, left, (render_vec){ middle.x - 0.2 * half, middle.y }, 1.5 * painter->ui,
                  field_weak);
        plr_arrow(painter, middle, right, 1.5 * painter->ui, field_strong);
        break;
    case PLR_TRAIL:
        plr_stroke(painter, (render_vec[2]){ left, right }, 2, false, 2.2 * painter->ui,
                   plr_fade(trail, 0.0), trail);
        break;
    case PLR_SURFACE:
        chevron(painter, (render_vec){ middle.x - 0.4 * half, middle.y }, (render_vec){ 1.0, 0.0 },
                surface_color);
        chevron(painter, (render_vec){ middle.x + 0.4 * half, middle.y }, (render_vec){ 1.0, 0.0 },
                surface_color);
        break;
    case PLR_DIPOLE:
        draw_dipole(painter, middle, (render_vec){ half, 0.0 }, 0.3 * half);
        break;
    case PLR_FLOW:
        plr_stroke(painter, (render_vec[2]){ left, right }, 2, false, 2.0 * painter->ui,
                   plr_fade(flow_fast, 0.0), flow_fast);
        break;
    case PLR_LIQUID:
    case PLR_BEAM:
    case PLR_SMOKE:
    case PLR_TEXT:
    case PLR_MARK_KINDS:
        break;
    }
}

void plr_draw_texts(plr_painter *painter)
{
    if (!plr_shows(painter, RENDER_SHOW_TEXTS)) {
        return;
    }
    const render_frame *frame = painter->frame;
    const int size = (int)lround(text_size * painter->ui);
    const double gap = 6.0 * painter->ui, cap = 0.36 * size; // half the height of a capital
    const render_rgba halo = painter->options.background;
    for (size_t i = 0; i < frame->mark_count; i++) {
        const plr_mark *mark = &frame->marks[i];
        if (mark->kind != PLR_TEXT) {
            continue;
        }
        const char *string = plr_frame_text(frame, mark->text);
        render_vec at = plr_pixel(painter, mark->a);
        const double width = plr_text_width(painter->text, PLR_FONT_REGULAR, size, string);
        const render_anchor anchor = (render_anchor)mark->variant;
        at.x += anchor == RENDER_ANCHOR_LEFT    ? gap
                : anchor == RENDER_ANCHOR_RIGHT ? -gap - width
                                                : -0.5 * width;
        at.y += cap;
        at.y += anchor == RENDER_ANCHOR_ABOVE ? -gap - cap : 0.0;
        at.y += anchor == RENDER_ANCHOR_BELOW ? gap + cap : 0.0;
        plr_text_draw(painter, PLR_FONT_REGULAR, size, at, string, plr_ink, halo);
    }
}
