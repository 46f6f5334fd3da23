// draw.c - a world handed to callbacks that draw: see plumb/draw.h.
//
// Shapes are found by the grids that queries see by, so that what is out of view costs nothing and every image of a
// world that wraps around is where it belongs. Joints, centres and contacts are drawn by the image that is nearest to
// the middle of the view.
//
// Reads: the world. Writes: nothing of it but grids of queries. Cost: O(in view), O(joints), O(contacts).
#include "game/draw.h"

#include "broad/images.h"
#include "broad/query_grids.h"
#include "plumb/draw.h"
#include "plumb/event.h"
#include "query/query.h"
#include "world/check.h"
#include "world/rows.h"

#define CURVE_MOST 64 // corners of a rounded shape

static const plumb_color own_palette[] = {
#define PAINT_ROW(NAME, r, g, b, a, text) { r, g, b, a },
    PLUMB_PAINT_LIST(PAINT_ROW)
#undef PAINT_ROW
};

const plumb_color *plumb_draw_palette(void)
{
    return own_palette;
}

//---- strokes -------------------------------------------------------------------------------------

void pl_draw_line(const pl_drawing *d, plumb_vec2 a, plumb_vec2 b, plumb_paint paint)
{
    d->calls.line(d->calls.context, a, b, d->palette[paint]);
}

void pl_draw_point(const pl_drawing *d, plumb_vec2 at, plumb_paint paint)
{
    if (d->calls.point != NULL) {
        d->calls.point(d->calls.context, at, d->palette[paint]);
        return;
    }
    const real arm = 2 * d->desc.pixel;
    pl_draw_line(d, plumb_v2(at.x - arm, at.y), plumb_v2(at.x + arm, at.y), paint);
    pl_draw_line(d, plumb_v2(at.x, at.y - arm), plumb_v2(at.x, at.y + arm), paint);
}

bool pl_draw_sees(const pl_drawing *d, plumb_vec2 a, plumb_vec2 b)
{
    const pl_box *v = &d->view;
    return plumb_min(a.x, b.x) <= v->max_x && plumb_max(a.x, b.x) >= v->min_x &&
           plumb_min(a.y, b.y) <= v->max_y && plumb_max(a.y, b.y) >= v->min_y;
}

//---- shapes --------------------------------------------------------------------------------------

static plumb_paint paint_of(const plumb_world *world, uint32_t piece)
{
    if ((world->pieces.flags[piece] & PL_PIECE_SENSOR) != 0) {
        return PLUMB_PAINT_SENSOR;
    }
    const uint32_t row = world->pieces.body[piece];
    switch (world->bodies.type[row]) {
    case PLUMB_STATIC:
        return PLUMB_PAINT_STATIC;
    case PLUMB_KINEMATIC:
        return PLUMB_PAINT_KINEMATIC;
    default:
        return pl_row_is_asleep(world, row) ? PLUMB_PAINT_ASLEEP : PLUMB_PAINT_DYNAMIC;
    }
}

static plumb_color darker(plumb_color c)
{
    return (plumb_color){ (uint8_t)(c.r * 5 / 8), (uint8_t)(c.g * 5 / 8), (uint8_t)(c.b * 5 / 8),
                          c.a };
}

// Corners of an arc so that it is nowhere a quarter of a pixel off: the sagitta of a chord is r (1 - cos(half)).
static int arc_steps(const pl_drawing *d, real radius, real angle)
{
    const real half = plumb_sqrt(d->desc.pixel / 2 / plumb_max(radius, d->desc.pixel));
    const real steps = angle / (2 * half) + 1;
    return steps < CURVE_MOST ? (int)steps : CURVE_MOST;
}

// The outline of a rounded core; *edge tells of each corner which edge of the core begins there, or -1 within an arc.
static int outline_of(const pl_drawing *d, const plumb_convex *s, plumb_vec2 *out, int *edge)
{
    const real full = PLUMB_REAL(6.283185307179586);
    if (s->radius == 0) {
        for (int i = 0; i < s->count; ++i) {
            out[i] = s->points[i];
            edge[i] = i;
        }
        return s->count;
    }
    int count = 0, budget = CURVE_MOST;
    for (int i = 0; i < s->count; ++i) {
        const plumb_vec2 to = s->count == 1 ? plumb_v2(1, 0) : s->normals[i];
        const plumb_vec2 from = s->count == 1 ? to : s->normals[i > 0 ? i - 1 : s->count - 1];
        real turn = s->count == 1
                        ? full
                        : plumb_atan2(plumb_vec2_cross(from, to), plumb_vec2_dot(from, to));
        turn = turn < 0 ? turn + full : turn;
        int steps = arc_steps(d, s->radius, turn);
        const int room = budget / (s->count - i) - 1; // of what is left, its share
        steps = steps < room ? steps : room > 1 ? room : 1;
        for (int k = 0; k <= steps - (s->count == 1 ? 1 : 0); ++k) {
            const plumb_rot q = plumb_rot_make(turn * (real)k / (real)steps);
            out[count] = plumb_vec2_add_scaled(s->points[i], s->radius, plumb_rot_apply(q, from));
            edge[count++] = k == steps ? i : -1;
        }
        budget = CURVE_MOST - count;
    }
    return count;
}

static void draw_convex(const pl_drawing *d, const plumb_convex *s, plumb_transform at,
                        uint32_t cuts, plumb_color color)
{
    plumb_vec2 points[CURVE_MOST];
    int edge[CURVE_MOST];
    const int count = outline_of(d, s, points, edge);
    for (int i = 0; i < count; ++i) {
        points[i] = plumb_transform_apply(at, points[i]);
    }
    const bool filled = d->calls.fill != NULL && count > 2;
    if (filled) {
        d->calls.fill(d->calls.context, points, count, color);
    }
    const plumb_color line = filled ? darker(color) : color;
    for (int i = 0; i < (count > 2 ? count : 1); ++i) {
        if (edge[i] < 0 || (cuts >> edge[i] & 1u) == 0) {
            d->calls.line(d->calls.context, points[i], points[i + 1 < count ? i + 1 : 0], line);
        }
    }
    if (s->count == 1) { // a spoke, so that it is seen to turn
        d->calls.line(d->calls.context, plumb_transform_apply(at, s->points[0]), points[0], line);
    }
}

// Where the body of a piece is drawn, by the image of which an entry is the box.
static plumb_transform shown(const pl_drawing *d, const pl_grid_entry *entry)
{
    const plumb_world *world = d->world;
    plumb_transform t = pl_query_frame_of(world, entry);
    if (d->desc.loop != NULL) {
        const uint32_t row = world->pieces.body[entry->piece];
        const plumb_transform blended =
            plumb_loop_transform(d->desc.loop, world->bodies.entity[row]);
        t.p.x += blended.p.x - world->bodies.x[row];
        t.p.y += blended.p.y - world->bodies.y[row];
        t.q = blended.q;
    }
    return t;
}

static bool draw_piece(void *context, const pl_grid_entry *entry)
{
    const pl_drawing *d = context;
    const plumb_world *world = d->world;
    const uint32_t piece = entry->piece;
    plumb_color color = d->palette[paint_of(world, piece)];
    if (d->desc.color != NULL) {
        color = d->desc.color(d->calls.context, world->pieces.shape[piece], color);
    }
    plumb_convex convex;
    pl_piece_convex(world, piece, &convex);
    draw_convex(d, &convex, shown(d, entry), world->pieces.cuts[piece], color);
    return true;
}

static bool draw_box(void *context, const pl_grid_entry *entry)
{
    const pl_drawing *d = context;
    plumb_convex convex;
    pl_piece_convex(d->world, entry->piece, &convex);
    const plumb_aabb box = plumb_convex_aabb(&convex, shown(d, entry));
    const plumb_vec2 c[] = { box.min, { box.max.x, box.min.y }, box.max, { box.min.x, box.max.y } };
    for (int i = 0; i < 4; ++i) {
        pl_draw_line(d, c[i], c[(i + 1) % 4], PLUMB_PAINT_BOX);
    }
    return true;
}

typedef struct pl_asleep {
    pl_drawing *drawing;
    pl_grid_visit *visit;
} pl_asleep;

// The grid of what sleeps may name pieces that sleep no more: another grid has them, or none.
static bool visit_asleep(void *context, const pl_grid_entry *entry)
{
    const pl_asleep *a = context;
    return (a->drawing->world->pieces.flags[entry->piece] & PL_PIECE_ASLEEP) == 0 ||
           a->visit(a->drawing, entry);
}

static void each_piece(pl_drawing *d, pl_grid_visit *visit)
{
    pl_asleep asleep = { d, visit };
    pl_world_query(d->world, pl_query_grid_of(d->world, PL_QUERY_FIXED), d->view, visit, d);
    pl_world_query(d->world, pl_query_grid_of(d->world, PL_QUERY_RESTING), d->view, visit_asleep,
                   &asleep);
    pl_world_query(d->world, pl_query_grid_of(d->world, PL_QUERY_MOVING), d->view, visit, d);
}

//---- bodies --------------------------------------------------------------------------------------

plumb_vec2 pl_draw_near(const pl_drawing *d, plumb_vec2 point)
{
    return plumb_vec2_add(d->middle, plumb_world_way(d->world, d->middle, point));
}

plumb_transform pl_draw_frame(const pl_drawing *d, plumb_body body)
{
    plumb_transform t = d->desc.loop != NULL ? plumb_loop_transform(d->desc.loop, body)
                                             : plumb_body_transform(d->world, body);
    t.p = pl_draw_near(d, t.p);
    return t;
}

static void draw_axes(const pl_drawing *d, plumb_vec2 center, plumb_rot q)
{
    const real arm = 8 * d->desc.pixel;
    const plumb_vec2 x = plumb_rot_apply(q, plumb_v2(arm, 0));
    pl_draw_line(d, center, plumb_vec2_add(center, x), PLUMB_PAINT_CENTER);
    pl_draw_line(d, center, plumb_vec2_add(center, plumb_vec2_left(x)), PLUMB_PAINT_CENTER);
}

static void draw_name(const pl_drawing *d, plumb_body body, plumb_vec2 center)
{
    const char *name =
        d->calls.text == NULL || d->desc.name == NULL ? NULL : d->desc.name(d->calls.context, body);
    if (name != NULL) {
        d->calls.text(d->calls.context, center, name, d->palette[PLUMB_PAINT_NAME]);
    }
}

static void draw_bodies(const pl_drawing *d, unsigned part)
{
    const plumb_world *world = d->world;
    const pl_bodies *b = &world->bodies;
    for (uint32_t row = 0; row < b->table.count; ++row) {
        if ((b->flags[row] & PL_BODY_DISABLED) != 0) {
            continue;
        }
        const plumb_transform t = pl_draw_frame(d, b->entity[row]);
        const plumb_vec2 center =
            plumb_transform_apply(t, plumb_v2(b->local_x[row], b->local_y[row]));
        const plumb_vec2 tip =
            plumb_vec2_add_scaled(center, d->desc.velocity_scale, plumb_v2(b->vx[row], b->vy[row]));
        if (!pl_draw_sees(d, center, tip)) {
            continue;
        }
        if (part == PLUMB_DRAW_CENTERS) {
            draw_axes(d, center, t.q);
        } else if (part == PLUMB_DRAW_NAMES) {
            draw_name(d, b->entity[row], center);
        } else if (b->vx[row] != 0 || b->vy[row] != 0) {
            pl_draw_line(d, center, tip, PLUMB_PAINT_VELOCITY);
        }
    }
}

//---- all -----------------------------------------------------------------------------------------

static plumb_result check(const plumb_world *world, const char *fn, const plumb_draw_desc *d)
{
    PL_TRY(pl_check_within(world, fn, "view.min", d->view.min, PL_QUERY_LIMIT));
    PL_TRY(pl_check_within(world, fn, "view.max", d->view.max, PL_QUERY_LIMIT));
    PL_TRY(pl_check_range(world, fn, "pixel", d->pixel, 0, PLUMB_REAL_MAX));
    PL_TRY(pl_check_range(world, fn, "force_scale", d->force_scale, 0, PLUMB_REAL_MAX));
    PL_TRY(pl_check_range(world, fn, "velocity_scale", d->velocity_scale, 0, PLUMB_REAL_MAX));
    if ((d->parts & ~(unsigned)PLUMB_DRAW_ALL) != 0) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "parts is %#x; it must be bits of plumb_draw_part",
                       d->parts);
    }
    if ((d->view.min.x > d->view.max.x || d->view.min.y > d->view.max.y)) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "view is empty; min must be at most max");
    }
    return PLUMB_OK;
}

// All there is: the whole plane, or the period of a world that wraps around.
static pl_box whole(const plumb_world *world)
{
    const real x = world->desc.wrap_x > 0 ? world->desc.wrap_x / 2 : PL_QUERY_LIMIT;
    const real y = world->desc.wrap_y > 0 ? world->desc.wrap_y / 2 : PL_QUERY_LIMIT;
    return (pl_box){ -x, -y, x, y };
}

static void resolve(pl_drawing *d)
{
    plumb_draw_desc *desc = &d->desc;
    const plumb_aabb v = desc->view;
    const bool given = v.min.x != v.max.x || v.min.y != v.max.y;
    d->view = given ? (pl_box){ v.min.x, v.min.y, v.max.x, v.max.y } : whole(d->world);
    d->middle =
        plumb_v2(d->view.min_x / 2 + d->view.max_x / 2, d->view.min_y / 2 + d->view.max_y / 2);
    desc->parts = desc->parts != 0 ? desc->parts : PLUMB_DRAW_SHAPES | PLUMB_DRAW_JOINTS;
    const real width = given && v.max.x > v.min.x ? v.max.x - v.min.x : 20;
    desc->pixel = desc->pixel > 0 ? desc->pixel : width / 1000;
    desc->force_scale = desc->force_scale > 0 ? desc->force_scale : PLUMB_REAL(0.02);
    desc->velocity_scale = desc->velocity_scale > 0 ? desc->velocity_scale : PLUMB_REAL(0.1);
    d->palette = desc->palette != NULL ? desc->palette : own_palette;
}

static plumb_result draw_all(pl_drawing *d)
{
    for (unsigned part = 1; part <= PLUMB_DRAW_ALL; part <<= 1) {
        switch (d->desc.parts & part) {
        case PLUMB_DRAW_SHAPES:
            each_piece(d, draw_piece);
            break;
        case PLUMB_DRAW_JOINTS:
            pl_draw_joints(d);
            break;
        case PLUMB_DRAW_CONTACTS:
            PL_TRY(pl_draw_contacts(d, false));
            break;
        case PLUMB_DRAW_FORCES:
            PL_TRY(pl_draw_contacts(d, true));
            pl_draw_joint_forces(d);
            break;
        case PLUMB_DRAW_BOXES:
            each_piece(d, draw_box);
            break;
        case 0:
            break;
        default:
            draw_bodies(d, part);
        }
    }
    return PLUMB_OK;
}

plumb_result plumb_draw(plumb_world *world, const plumb_draw_calls *calls,
                        const plumb_draw_desc *desc)
{
    const plumb_draw_desc none = { 0 };
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(pl_check_pointer(world, __func__, "calls", calls));
    if (calls->line == NULL) {
        return pl_fail(world, PLUMB_E_NULL, __func__, "calls.line is null; it must be given");
    }
    desc = desc == NULL ? &none : desc;
    PL_TRY(check(world, __func__, desc));
    pl_drawing d = { .world = world, .calls = *calls, .desc = *desc };
    resolve(&d);
    if (!pl_query_grids_file_all(world)) {
        return pl_fail_memory(world, __func__);
    }
    const plumb_result r = draw_all(&d);
    return r == PLUMB_E_MEMORY ? pl_fail_memory(world, __func__) : r;
}
