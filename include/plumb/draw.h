/// draw.h - a world shown by whatever draws lines: shapes, joints, contacts and more are handed to a table of
/// callbacks, for games that want to see what they simulate.
///
///     static void line(void *window, plumb_vec2 a, plumb_vec2 b, plumb_color c) { ... }
///     ...
///     const plumb_draw_calls calls = { .line = line, .context = window };
///     plumb_draw(world, &calls, &(plumb_draw_desc){ .view = camera_box, .pixel = metres_a_pixel });
///
/// tools/examples/sdl2/show.c is a window of SDL2 that does so. Points are in the world [m]; what turns them into pixels
/// is the caller's. Nothing of the world changes.
#ifndef PLUMB_DRAW_H
#define PLUMB_DRAW_H

#include "plumb/loop.h"
#include "plumb/shape.h"

PLUMB_BEGIN

/// Red, green, blue, opacity, 0..255 each.
typedef struct plumb_color {
    uint8_t r, g, b, a;
} plumb_color;

/// What to draw: bits for plumb_draw_desc.parts.
typedef enum plumb_draw_part {
    PLUMB_DRAW_SHAPES = 1,      ///< filled, with their outlines
    PLUMB_DRAW_JOINTS = 2,      ///< from centres over anchors to centres; axes, ropes
    PLUMB_DRAW_CONTACTS = 4,    ///< points that touch, with their normals
    PLUMB_DRAW_FORCES = 8,      ///< what contacts and joints bear, mean of the last substep: force_scale
    PLUMB_DRAW_BOXES = 16,      ///< boxes around convex pieces
    PLUMB_DRAW_CENTERS = 32,    ///< centres of mass with the axes of the body
    PLUMB_DRAW_VELOCITIES = 64, ///< of centres of mass: velocity_scale
    PLUMB_DRAW_NAMES = 128,     ///< what plumb_draw_desc.name tells of bodies
    PLUMB_DRAW_ALL = 255
} plumb_draw_part;

/// Every colour: X(NAME, r, g, b, a, meaning). The one list.
// clang-format off
#define PLUMB_PAINT_LIST(X)                                                                        \
    X(STATIC,    120, 128, 138, 255, "bodies that never move")                                     \
    X(KINEMATIC,  86, 164, 142, 255, "bodies moved by the user")                                   \
    X(DYNAMIC,    92, 140, 205, 255, "awake dynamic bodies")                                       \
    X(ASLEEP,     82,  98, 126, 255, "sleeping bodies")                                            \
    X(SENSOR,    222, 184,  76, 110, "sensors, whatever their body")                               \
    X(JOINT,     190, 160, 230, 255, "joints")                                                     \
    X(STRAINED,  235, 120, 160, 255, "joints that are switched off, or beyond a bound for events") \
    X(CONTACT,   240, 208,  96, 255, "points that touch, and normals")                             \
    X(FORCE,     236, 106,  92, 255, "forces")                                                     \
    X(BOX,       110, 110, 120, 160, "boxes")                                                      \
    X(CENTER,    240, 240, 240, 255, "centres and axes")                                           \
    X(VELOCITY,  120, 214, 130, 255, "velocities")                                                 \
    X(NAME,      230, 232, 236, 255, "names")
// clang-format on

/// Places of the colours in a palette.
typedef enum plumb_paint {
#define PLUMB_PAINT_ENUM(NAME, r, g, b, a, text) PLUMB_PAINT_##NAME,
    PLUMB_PAINT_LIST(PLUMB_PAINT_ENUM)
#undef PLUMB_PAINT_ENUM
        PLUMB_PAINT_COUNT
} plumb_paint;

/// The table of callbacks. Only `line` must be given: without the others, shapes are outlines and points are crosses of
/// lines, and names are left out. Called in this order: static, sleeping, moving shapes, then the parts in the order of
/// their bits.
typedef struct plumb_draw_calls {
    /// A straight line.
    void (*line)(void *context, plumb_vec2 a, plumb_vec2 b, plumb_color color);
    /// A convex polygon of 3..64 corners, counter-clockwise in a y-up world, to be filled. Rounded ones come as corners.
    void (*fill)(void *context, const plumb_vec2 *points, int count, plumb_color color);
    /// A dot of a few pixels.
    void (*point)(void *context, plumb_vec2 at, plumb_color color);
    /// A word beside a point.
    void (*text)(void *context, plumb_vec2 at, const char *text, plumb_color color);
    void *context;
} plumb_draw_calls;

/// What to draw and how. {0} is valid: every zero means the default told beside the field.
typedef struct plumb_draw_desc {
    unsigned parts; ///< bits of plumb_draw_part; default shapes and joints
    /// [m] what lies outside is left out, by the grid; default {0}: all there is. A world that
    /// wraps around is drawn by every image that is in view, up to 17 along an axis; default one
    plumb_aabb view;
    /// [m] > 0 of a pixel: sizes of dots, smoothness of curves; default: a thousandth of the view's
    /// width, or 0.02
    plumb_real pixel;
    plumb_real force_scale;     ///< [m/N] >= 0 length of forces; default 0.02
    plumb_real velocity_scale;  ///< [s] >= 0 length of velocities; default 0.1
    const plumb_color *palette; ///< PLUMB_PAINT_COUNT colours; default: plumb_draw_palette
    /// Of this world: bodies are where it shows them; default: where they are.
    const plumb_loop *loop;
    /// Colour of a shape instead of `by_state`. Null: that one.
    plumb_color (*color)(void *context, plumb_shape shape, plumb_color by_state);
    /// Name of a body, null for none. Null: no names.
    const char *(*name)(void *context, plumb_body body);
} plumb_draw_desc;

/// The colours of PLUMB_PAINT_LIST, to begin one's own with: PLUMB_PAINT_COUNT of them.
PLUMB_API const plumb_color *plumb_draw_palette(void);

/// Draws what there is between two steps; disabled bodies are left out. Callbacks (those of `desc` get calls->context,
/// too) must not change the world. `desc` may be null (= {0}). O(what is in view, and joints and contacts
/// where they are asked for).
/// Errors: E_NULL, E_RANGE, E_NOT_FINITE, E_LOCKED, E_MEMORY.
PLUMB_API plumb_result plumb_draw(plumb_world *world, const plumb_draw_calls *calls,
                                  const plumb_draw_desc *desc);

PLUMB_END

#endif
