/// internal.h - what the renderer's own files share. Names: plr_.
///
/// Flow of one draw: target.c asks the painters (hud.c, bodies.c, overlay.c) to turn the frame
/// into triangles in pixel coordinates (batch.c), in painter's order; text comes as textured
/// quads from a glyph atlas (text.c); a backend (osmesa.c) submits the batch to OpenGL.
///
/// Anti-aliasing is part of the geometry: every edge carries a ramp one pixel wide, half inside,
/// half outside the true edge, from opaque to transparent.
#ifndef RENDER_INTERNAL_H
#define RENDER_INTERNAL_H

#include "render.h"

#define PLR_PI 3.14159265358979323846

// --------------------------------------------------------------------------------------- memory

/// The allocator to use: *given if it has a hook, else realloc and free.
render_allocator plr_allocator(const render_allocator *given);
/// Makes room for `need` elements of `size` bytes in *data, at least doubling. False when out of
/// memory or the size overflows; *data and *capacity are unchanged then.
bool plr_reserve(const render_allocator *allocator, void **data, size_t *capacity, size_t need,
                 size_t size);
/// Frees an array made by plr_reserve.
void plr_release(const render_allocator *allocator, void *data, size_t capacity, size_t size);

/// Writes a message (printf style) and returns `result`. `error` may be NULL.
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
render_result
plr_fail(render_error *error, render_result result, const char *format, ...);

// ---------------------------------------------------------------------------------------- frame

typedef enum plr_shape_kind { PLR_CIRCLE, PLR_CAPSULE, PLR_POLYGON, PLR_POLYLINE } plr_shape_kind;

/// One shape; its points are frame->points[first_point ...].
typedef struct plr_shape {
    plr_shape_kind kind;
    unsigned flags;
    size_t first_point;
    size_t point_count;
    double radius;
    double angle;
} plr_shape;

#define PLR_NO_TEXT SIZE_MAX

typedef struct plr_body {
    render_class kind;
    int palette;
    render_rgba color;
    size_t label; ///< offset into frame->text or PLR_NO_TEXT
    size_t first_shape;
    size_t shape_count;
} plr_body;

typedef enum plr_mark_kind {
    PLR_CONTACT,
    PLR_IMPULSE,
    PLR_VELOCITY,
    PLR_AABB,
    PLR_CELL,
    PLR_TRAIL,
    PLR_LIQUID,
    PLR_SMOKE,
    PLR_FIELD,
    PLR_FLOW,
    PLR_SURFACE,
    PLR_DIPOLE,
    PLR_BEAM,
    PLR_TEXT,
    PLR_MARK_KINDS
} plr_mark_kind;

/// One overlay mark: two points or vectors, or a run of points (trail), or a text.
typedef struct plr_mark {
    plr_mark_kind kind;
    int variant; ///< anchor, palette index, share of 255 of a field or flow, columns of smoke, or whether a surface is
                 ///< closed
    render_vec a;
    render_vec b;
    double bright_a, bright_b; ///< of a beam
    double
        value; ///< depth of a contact; travel of a surface; spacing of a liquid; strength of a field, of a
               ///< flow; side of a cell of smoke; half the width of a dipole's needle
    render_rgba color;  ///< liquid, smoke, beam
    size_t first_point; ///< trail, surface
    size_t point_count; ///< trail, surface
    size_t text;        ///< offset into frame->text
} plr_mark;

struct render_frame {
    render_allocator allocator;
    plr_body *bodies;
    size_t body_count, body_capacity;
    plr_shape *shapes;
    size_t shape_count, shape_capacity;
    render_vec *points;
    size_t point_count, point_capacity;
    plr_mark *marks;
    size_t mark_count, mark_capacity;
    render_joint *joints;
    size_t joint_count, joint_capacity;
    char *text;
    size_t text_count, text_capacity;
    size_t mark_kind_count[PLR_MARK_KINDS];
    size_t title, caption; ///< offsets or PLR_NO_TEXT
    render_vec period;     ///< 0: it does not wrap along that axis
    bool body_open;
    render_result status;
};

// ---------------------------------------------------------------------------------------- batch

/// A vertex as OpenGL reads it; u and v are used by textured runs.
typedef struct plr_vertex {
    float x, y, u, v;
    render_rgba color;
} plr_vertex;

/// Consecutive indices drawn with or without the glyph atlas.
typedef struct plr_run {
    bool textured;
    size_t first;
    size_t count;
} plr_run;

/// Triangles in pixel coordinates, (0, 0) upper left, in painter's order.
typedef struct plr_batch {
    render_allocator allocator;
    plr_vertex *vertices;
    size_t vertex_count, vertex_capacity;
    uint32_t *indices;
    size_t index_count, index_capacity;
    plr_run *runs;
    size_t run_count, run_capacity;
    bool failed; ///< out of memory; nothing more is added
    render_rgba background;
    const uint8_t *atlas; ///< coverage, atlas_size x atlas_size bytes
    int atlas_size;
    unsigned atlas_version; ///< changes when the atlas's content does
} plr_batch;

void plr_batch_clear(plr_batch *batch);
void plr_batch_free(plr_batch *batch);
/// Adds a vertex and returns its index (0 and `failed` when out of memory).
uint32_t plr_batch_vertex(plr_batch *batch, double x, double y, render_rgba color);
void plr_batch_triangle(plr_batch *batch, uint32_t a, uint32_t b, uint32_t c);
void plr_batch_quad(plr_batch *batch, uint32_t a, uint32_t b, uint32_t c, uint32_t d);
/// Adds an axis-aligned quad that shows a part of the atlas.
void plr_batch_glyph(plr_batch *batch, const double rect[4], const double uv[4], render_rgba color);

// -------------------------------------------------------------------------------------- contour

/// A closed convex outline in pixels that can be grown or shrunk. The point at offset d is
/// base + normal * (radius + d) while radius + d >= 0, else base + mitre * (radius + d).
typedef struct plr_contour {
    size_t count;
    double radius;
    double inradius; ///< a distance by which it can be shrunk before it vanishes
    render_vec center;
    render_vec *base;
    render_vec *normal;
    render_vec *mitre;
} plr_contour;

/// Most points of a contour: 2048 keep a disc of radius 100,000 px within 0.12 px of a circle.
#define PLR_CONTOUR_MAX (2048 + 4 * RENDER_POLYGON_MAX)

/// Most points of a polygon clipped to a rectangle: every side may add one.
#define PLR_CLIPPED_MAX (RENDER_POLYGON_MAX + 4)

/// The contour of `count` convex points grown by radius, all in pixels, count >= 1. The arrays of
/// `contour` have room for PLR_CONTOUR_MAX. False for degenerate input (nothing to fill).
bool plr_contour_make(plr_contour *contour, const render_vec *points, size_t count, double radius);
render_vec plr_contour_at(const plr_contour *contour, size_t index, double offset);

// -------------------------------------------------------------------------------------- painter

typedef struct plr_text plr_text;

/// Everything a painter needs for one draw.
typedef struct plr_painter {
    plr_batch *batch;
    plr_text *text;
    const render_frame *frame;
    const render_camera *camera;
    render_options options;  ///< with the defaults filled in
    double width, height;    ///< of the picture [px]
    double ui;               ///< ui_scale
    double scale;            ///< pixels per world unit
    plr_contour contour;     ///< scratch
    struct plr_group *group; ///< scratch of group.c
} plr_painter;

render_vec plr_pixel(const plr_painter *painter, render_vec world);
bool plr_shows(const plr_painter *painter, unsigned flag);
/// Text of the frame by its offset.
const char *plr_frame_text(const render_frame *frame, size_t offset);

// --------------------------------------------------------------------------------------- colour

render_rgba plr_mix(render_rgba a, render_rgba b, double t);
render_rgba plr_fade(render_rgba color, double alpha);
/// Fill and outline of a body, stripes for hatching (a == 0: none).
typedef struct plr_paint {
    render_rgba fill;
    render_rgba outline;
    render_rgba hatch;
    bool dashed;
    bool plain; // no outline
} plr_paint;
plr_paint plr_body_paint(const plr_body *body, render_rgba background);

extern const render_rgba plr_ink;        ///< text
extern const render_rgba plr_background; ///< default background

// --------------------------------------------------------------------------------------- strokes

/// A line through points, `width` px, colour from `first` to `last` along its points, butt ends
/// with a feather; round joins.
void plr_stroke(plr_painter *painter, const render_vec *points, size_t count, bool closed,
                double width, render_rgba first, render_rgba last);
void plr_line(plr_painter *painter, render_vec a, render_vec b, double width, render_rgba color);
void plr_dashes(plr_painter *painter, const render_vec *points, size_t count, bool closed,
                double width, double dash, double gap, render_rgba color);
/// A filled disc, feathered.
void plr_dot(plr_painter *painter, render_vec center, double radius, render_rgba color);
/// A ring, feathered.
void plr_ring(plr_painter *painter, render_vec center, double radius, double width,
              render_rgba color);
/// A filled convex polygon, feathered.
void plr_fill(plr_painter *painter, const render_vec *points, size_t count, render_rgba color);
/// An arrow from a to b; shorter than its head it shrinks.
void plr_arrow(plr_painter *painter, render_vec a, render_vec b, double width, render_rgba color);
/// A box with rounded corners, feathered, with an outline if outline.a > 0.
void plr_panel(plr_painter *painter, render_vec min, render_vec max, double radius,
               render_rgba fill, render_rgba outline);
/// A filled and outlined contour; outline_width 0 = none.
void plr_paint_contour(plr_painter *painter, const plr_contour *contour, double outline_width,
                       render_rgba fill, render_rgba outline);
/// How far [px] the inside pass of a body of several shapes stays off the outline's ramp.
#define PLR_INSIDE_SHIFT 0.4
/// Only the inside of plr_paint_contour's outline.
void plr_paint_inside(plr_painter *painter, const plr_contour *contour, double outline_width,
                      render_rgba fill);

// ---------------------------------------------------------------------------------------- bodies

/// Draws all bodies (bodies.c).
void plr_draw_bodies(plr_painter *painter);
/// Names of bodies, as far as there is room.
void plr_draw_labels(plr_painter *painter);
/// A half plane {p : dot(p, normal) <= offset}, pixels.
typedef struct plr_half_plane {
    render_vec normal;
    double offset;
} plr_half_plane;
/// Hatches the convex region that `count` half planes leave of the box min..max.
void plr_hatch(plr_painter *painter, const plr_half_plane *planes, size_t count, render_vec min,
               render_vec max, const plr_body *body, render_rgba color);
/// Outline width of bodies [px], 0 = none.
double plr_outline_width(const plr_painter *painter);

/// What a pass over the pieces of a body draws.
typedef enum plr_group_pass {
    PLR_GROUP_ALL,    ///< outline and inside
    PLR_GROUP_INSIDE, ///< inside only
    PLR_GROUP_HATCH   ///< hatching, if the paint has one
} plr_group_pass;

typedef struct plr_group plr_group;

/// True if the shape is one that plr_group_draw takes care of: a polygon without radius.
bool plr_group_takes(const plr_shape *shape);
/// Finds out which edges the sharp polygons of a body share. False when there are none.
bool plr_group_make(plr_painter *painter, const plr_body *body);
void plr_group_draw(plr_painter *painter, const plr_body *body, const plr_paint *paint,
                    plr_group_pass pass);
plr_group *plr_group_create(const render_allocator *allocator);
void plr_group_destroy(plr_group *group);

/// Liquids, which lie under everything but the grid (liquid.c).
void plr_draw_liquids(plr_painter *painter);
/// Smoke and heat, above these (smoke.c).
void plr_draw_smoke(plr_painter *painter);
/// Beams of light, above the bodies (beams.c).
void plr_draw_beams(plr_painter *painter);
/// Trails, which lie under the bodies; cells and boxes (overlay.c).
void plr_draw_underlay(plr_painter *painter);
/// Surfaces, boxes, contacts, arrows.
void plr_draw_overlay(plr_painter *painter);
/// Joints, and the name and a sample of one for the legend (joints.c).
void plr_draw_joints(plr_painter *painter);
const char *plr_joint_name(render_joint_kind kind);
void plr_joint_sample(plr_painter *painter, const render_joint *like, render_vec middle,
                      double size);
/// Texts of the caller.
void plr_draw_texts(plr_painter *painter);
/// Arrow scale in use [world units per unit of the quantity] for PLR_IMPULSE or PLR_VELOCITY.
double plr_arrow_scale(const plr_painter *painter, plr_mark_kind kind);
/// A short sample of an overlay for the legend, inside the box of that middle and size.
void plr_overlay_sample(plr_painter *painter, plr_mark_kind kind, render_vec middle, double size);

/// Calls `draw` for every image of the frame in view, the camera aimed at it (period.c).
typedef void plr_draw_fn(plr_painter *painter);
void plr_for_images(plr_painter *painter, plr_draw_fn *draw);
/// Fades what lies outside the period, marks its edges.
void plr_draw_period(plr_painter *painter);

/// Background grid; scale bar, title, legend (hud.c).
void plr_draw_grid(plr_painter *painter);
void plr_draw_hud(plr_painter *painter);
/// The largest of 1, 2, 5 times a power of ten that is not above x > 0.
double plr_round_step(double x);

// ------------------------------------------------------------------------------------------ text

typedef enum plr_font { PLR_FONT_REGULAR, PLR_FONT_BOLD, PLR_FONT_COUNT } plr_font;

/// Opens the fonts and an empty glyph atlas.
render_result plr_text_create(plr_text **text, const render_target_desc *desc,
                              const render_allocator *allocator, render_error *error);
void plr_text_destroy(plr_text *text);
/// Called before a frame: empties the atlas if the last frame overfilled it.
void plr_text_begin(plr_text *text);
/// Hands the atlas over to the batch.
void plr_text_end(plr_text *text, plr_batch *batch);
/// Width of a text [px].
double plr_text_width(plr_text *text, plr_font font, int size, const char *string);
/// Draws a text with its baseline's left end at `at`; halo.a > 0 surrounds the letters.
void plr_text_draw(plr_painter *painter, plr_font font, int size, render_vec at, const char *string,
                   render_rgba color, render_rgba halo);

// --------------------------------------------------------------------------------------- backend

/// A way to turn batches into pixels.
typedef struct plr_backend {
    const char *name;
    render_result (*create)(void **state, int width, int height, const render_allocator *allocator,
                            render_error *error);
    render_result (*submit)(void *state, const plr_batch *batch, render_error *error);
    const uint8_t *(*pixels)(const void *state);
    void (*destroy)(void *state);
} plr_backend;

extern const plr_backend plr_backend_osmesa;

#endif
