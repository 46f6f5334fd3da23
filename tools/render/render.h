/// render.h - off-screen pictures of 2D bodies: a draw list, a camera, a target.
///
/// The renderer knows nothing of physics. The caller fills a draw list (render_frame) with plain
/// numbers in world units, aims a camera and draws the list into a target:
///
///     render_error error;
///     render_frame *frame = render_frame_create(NULL);
///     render_target *target;
///     if (render_target_create(&target, 960, 540, NULL, &error) != RENDER_OK) { puts(error.text);
///     } render_body_begin(frame, &(render_style){ .palette = 1, .label = "ball" });
///     render_add_circle(frame, 0.0, 1.0, 0.5, 0.3);
///     render_body_end(frame);
///     render_camera camera = render_camera_fit(render_frame_bounds(frame), 960, 540, 0.08, false);
///     if (render_target_draw(target, frame, &camera, NULL, &error) != RENDER_OK) { ... }
///     render_write_png("ball.png", render_target_pixels(target), 960, 540, &error);   // write.h
///
/// Adders return a result that may be ignored: memory trouble is remembered by the frame and
/// makes render_target_draw fail; a shape refused for its numbers is left out of the picture.
/// Threads: a frame or a target is used by one thread at a time; different ones are independent.
#ifndef RENDER_H
#define RENDER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/// What a function of the renderer answers.
typedef enum render_result {
    RENDER_OK = 0,
    RENDER_E_ARGUMENT,   ///< null pointer, size or option out of range, call out of order
    RENDER_E_NOT_FINITE, ///< a coordinate is NaN or infinite (beyond 1e30)
    RENDER_E_MEMORY,     ///< an allocation failed
    RENDER_E_BACKEND,    ///< the OpenGL context could not be made or used
    RENDER_E_FONT,       ///< no font file found, or it cannot be read
    RENDER_E_PATTERN,    ///< a sequence pattern without exactly one %d
    RENDER_E_FORMAT,     ///< file name extension not known
    RENDER_E_IO,         ///< a file could not be written
    RENDER_E_FFMPEG      ///< ffmpeg is absent or failed
} render_result;

/// A message for the user, one line, empty after success. Callers may pass NULL for it.
typedef struct render_error {
    char text[512];
} render_error;

/// Memory hook: block == NULL allocates, new_size == 0 frees (and returns NULL), else resizes.
/// Returns NULL on failure, with the old block untouched.
typedef struct render_allocator {
    void *(*resize)(void *user, void *block, size_t old_size, size_t new_size);
    void *user;
} render_allocator;

/// A point or vector, world units (metres) unless said otherwise.
typedef struct render_vec {
    double x;
    double y;
} render_vec;

/// An axis-aligned box; empty when min > max.
typedef struct render_box {
    render_vec min;
    render_vec max;
} render_box;

/// A colour, sRGB, not premultiplied. a == 0 in a style means "not given".
typedef struct render_rgba {
    uint8_t r, g, b, a;
} render_rgba;

/// What a body is; decides fill, outline and hatching.
typedef enum render_class {
    RENDER_DYNAMIC = 0, ///< palette colour
    RENDER_STATIC,      ///< neutral grey, hatched
    RENDER_KINEMATIC,   ///< palette colour with light stripes
    RENDER_ASLEEP,      ///< palette colour, faded
    RENDER_SENSOR,      ///< transparent, dashed outline
    RENDER_GLASS,       ///< translucent, with an outline; light goes through it
    RENDER_FLUID,       ///< translucent, over all that is in it; lines are its surface
    RENDER_CLASS_COUNT
} render_class;

/// How one body looks. {0} is a dynamic body in the first palette colour, without a label.
typedef struct render_style {
    render_class kind;
    int palette;       ///< any integer; wraps around at RENDER_PALETTE_COUNT
    render_rgba color; ///< replaces the palette colour (and a static body's grey) when a > 0
    const char *label; ///< UTF-8, copied; NULL = none
} render_style;

/// How many hues render_palette knows.
#define RENDER_PALETTE_COUNT 10

/// The fill colour of palette entry `index` (wraps around, negative too).
render_rgba render_palette(int index);

// ---------------------------------------------------------------------------------------- frame

/// The draw list. Opaque; grows as needed, keeps its capacity from frame to frame.
typedef struct render_frame render_frame;

/// Most vertices of one polygon.
#define RENDER_POLYGON_MAX 64

/// A new, empty frame; NULL when out of memory. `allocator` NULL = realloc and free; copied.
render_frame *render_frame_create(const render_allocator *allocator);
/// Frees the frame. NULL is allowed.
void render_frame_destroy(render_frame *frame);
/// Empties the list, title and captions and forgets the status; keeps the memory.
void render_frame_clear(render_frame *frame);
/// The first trouble since the last clear, RENDER_OK if none.
render_result render_frame_status(const render_frame *frame);
/// The box of all bodies and trails (not of arrows and texts); empty when there are none.
/// Cost O(points).
render_box render_frame_bounds(const render_frame *frame);

/// Starts a body. Everything added up to render_body_end is one body: edges shared by two of its
/// polygons (also in part) are not outlined, so a concave body made of convex pieces shows no
/// seams, and overlapping pieces show the outline of their union only.
render_result render_body_begin(render_frame *frame, const render_style *style);
/// Ends the body. A body without shapes is dropped.
render_result render_body_end(render_frame *frame);
/// A disc with a spoke at `angle` [rad] that shows its rotation.
render_result render_add_circle(render_frame *frame, double x, double y, double radius,
                                double angle);
/// A capsule around the segment a-b.
render_result render_add_capsule(render_frame *frame, double ax, double ay, double bx, double by,
                                 double radius);
/// A convex polygon, either orientation, 3..RENDER_POLYGON_MAX points, grown by `radius` >= 0.
render_result render_add_polygon(render_frame *frame, const render_vec *points, size_t count,
                                 double radius);
/// A box of half sizes hx, hy turned by `angle` [rad], grown by `radius` >= 0.
render_result render_add_box(render_frame *frame, double x, double y, double hx, double hy,
                             double angle, double radius);

/// Options of a polyline, or-ed together.
enum {
    RENDER_LINE_CLOSED = 1, ///< the last point joins the first
    RENDER_LINE_TICKS = 2   ///< hatch ticks on the right-hand side, as drawn for solid ground
};
/// A segment (2 points) or chain, `radius` >= 0 thick on each side (at least a visible line).
render_result render_add_polyline(render_frame *frame, const render_vec *points, size_t count,
                                  double radius, unsigned flags);

// ------------------------------------------------------------- overlays (see render_options.show)

/// A contact point with its unit normal and depth (> 0 overlapping; only the mark's colour).
render_result render_add_contact(render_frame *frame, double x, double y, double nx, double ny,
                                 double depth);
/// An impulse [N s] acting at a point.
render_result render_add_impulse(render_frame *frame, double x, double y, double jx, double jy);
/// A velocity [m/s] of a point.
render_result render_add_velocity(render_frame *frame, double x, double y, double vx, double vy);
/// What a field does at a place: an arrow (length_x, length_y) long in the world about it, coloured by `share`, 0 (weak) to 1, of
/// a strength in units of the caller, for the legend.
render_result render_add_field(render_frame *frame, double x, double y, double length_x,
                               double length_y, double strength, double share);
/// A dipole or magnet about a point: a needle whose positive (north) end, in red, is (half_x, half_y) away, `across` >= 0 of it to
/// either side of the middle.
render_result render_add_dipole(render_frame *frame, double x, double y, double half_x,
                                double half_y, double across);
/// A bounding box.
render_result render_add_aabb(render_frame *frame, render_box box);
/// A grid cell that is in use.
render_result render_add_cell(render_frame *frame, render_box box);
/// A liquid of particles, `spacing` > 0 apart at rest: drawn as one body with a surface. Of a colour; a == 0: water.
render_result render_add_liquid(render_frame *frame, const render_vec *points, size_t count,
                                double spacing, render_rgba color);
/// Smoke and heat in cells, `columns` a line from the lower left one on, whose corner is `low`; `cell` > 0 is their side. A
/// point is smoke (1: half of what is behind it is seen) and heat (1: it glows). Smoke of a colour; a == 0: grey.
render_result render_add_smoke(render_frame *frame, render_vec low, double cell, int columns,
                               const render_vec *points, size_t count, render_rgba color);
/// A piece of a streamline, from where what flows was; coloured by `share`, 0 (slow) to 1, of a speed for the legend.
render_result render_add_flow(render_frame *frame, const render_vec *points, size_t count,
                              double speed, double share);
/// A beam of light from a to b, whose brightness, 0 to 1, goes from `bright_a` to `bright_b`. Of a colour; a == 0: red.
render_result render_add_beam(render_frame *frame, render_vec a, render_vec b, double bright_a,
                              double bright_b, render_rgba color);
/// A trail, oldest point first: it fades towards that end.
render_result render_add_trail(render_frame *frame, const render_vec *points, size_t count,
                               render_rgba color);

/// The sign of a joint.
typedef enum render_joint_kind {
    RENDER_JOINT_ROD = 0, ///< a line
    RENDER_JOINT_ROPE,    ///< a line that sags when it is slack
    RENDER_JOINT_SPRING,  ///< a zigzag
    RENDER_JOINT_HINGE,   ///< a pin; a line if the anchors drifted apart
    RENDER_JOINT_SLIDER,  ///< a rail and a carriage
    RENDER_JOINT_WELD,    ///< a diamond
    RENDER_JOINT_WHEEL,   ///< a hub and its strut
    RENDER_JOINT_POINTER, ///< a cross at the target, a dashed line to the body
    RENDER_JOINT_DRIVE,   ///< a dashed line: B is driven to a pose
    RENDER_JOINT_GEAR,    ///< toothed rings
    RENDER_JOINT_PULLEY,  ///< a rope over two wheels
    RENDER_JOINT_RATCHET, ///< a ring of slanted teeth
    RENDER_JOINT_PADS,    ///< two pads that rub
    RENDER_JOINT_CABLE,   ///< rims about the anchors, and the rope between them
    RENDER_JOINT_KINDS
} render_joint_kind;

/// A joint between two anchors. {0} but for the anchors is a rod.
typedef struct render_joint {
    render_joint_kind kind;
    render_vec a, b;         ///< anchors on the two bodies; a pointer's target is `a`
    render_vec via_a, via_b; ///< pulley: the wheels; cable: where the rope leaves the rims
    render_vec axis;         ///< unit; slider, wheel: the way; hinge: where B points at value 0
    bool has_limit;
    double lower, upper; ///< slider, wheel: along the axis from `a`; hinge: [rad] of the value
    double value;        ///< hinge: [rad] from the axis
    double drive;        ///< motor: its sign (counter-clockwise, or along the axis), 0: none;
                         ///< ratchet: the way it turns
    bool has_spring;
    double slack; ///< rope, cable: by how much it is longer than the straight way
    double reach; ///< half the size of the smaller body: signs shrink to fit; 0: full size
} render_joint;
/// A joint. RENDER_E_ARGUMENT: no such kind, or an axis that is needed and {0}.
render_result render_add_joint(render_frame *frame, const render_joint *joint);
/// The running surface of a conveyor: a path (closed: the last point joins the first) along which
/// chevrons show the way. `travel`: how far the surface has run, its sign is the direction along the
/// path; 0 is forwards.
render_result render_add_surface(render_frame *frame, const render_vec *points, size_t count,
                                 bool closed, double travel);

/// Where the text lies relative to its point.
typedef enum render_anchor {
    RENDER_ANCHOR_CENTER = 0,
    RENDER_ANCHOR_LEFT,  ///< the text starts at the point
    RENDER_ANCHOR_RIGHT, ///< the text ends at the point
    RENDER_ANCHOR_ABOVE,
    RENDER_ANCHOR_BELOW
} render_anchor;
/// A text at a world point.
render_result render_add_text(render_frame *frame, double x, double y, render_anchor anchor,
                              const char *text);
/// The world wraps around every x, y units (0: not along that axis): all that was added, but for texts, is
/// drawn at each of its images in view. With RENDER_SHOW_GRID the edges, half a period to either side of the
/// origin, are marked, and where the whole period is in view, what lies outside is faded.
/// RENDER_E_ARGUMENT: a negative one.
render_result render_frame_set_period(render_frame *frame, double x, double y);
/// Bold line in the upper left corner (scene name); NULL or "" = none. Copied.
render_result render_frame_set_title(render_frame *frame, const char *text);
/// Small line below the title (time, step, counts); NULL or "" = none. Copied.
render_result render_frame_set_caption(render_frame *frame, const char *text);

// --------------------------------------------------------------------------------------- camera

/// Maps the world onto the picture; no rotation.
typedef struct render_camera {
    render_vec center;  ///< world point in the middle of the picture
    double view_height; ///< world units from the lower to the upper edge, > 0
    bool y_down;        ///< screen convention: world y grows downwards in the picture
} render_camera;

/// The camera that shows all of `box` in a picture of that many pixels, leaving `margin`
/// (share of the picture's width and height on each side, 0..0.45) free. An empty box gives a
/// view 10 units high around the origin, a single point one around that point.
render_camera render_camera_fit(render_box box, int width, int height, double margin, bool y_down);
/// World to pixel coordinates: (0, 0) is the upper left corner of the upper left pixel.
render_vec render_camera_to_pixel(const render_camera *camera, int width, int height,
                                  render_vec world);
/// Pixel to world coordinates.
render_vec render_camera_to_world(const render_camera *camera, int width, int height,
                                  render_vec pixel);

// --------------------------------------------------------------------------------------- target

/// What to draw besides the bodies, or-ed together.
enum {
    RENDER_SHOW_CONTACTS = 1 << 0,
    RENDER_SHOW_IMPULSES = 1 << 1,
    RENDER_SHOW_VELOCITIES = 1 << 2,
    RENDER_SHOW_AABBS = 1 << 3,
    RENDER_SHOW_CELLS = 1 << 4,
    RENDER_SHOW_TRAILS = 1 << 5,
    RENDER_SHOW_JOINTS = 1 << 6,
    RENDER_SHOW_LABELS = 1 << 7,    ///< names of bodies; left out where there is no room
    RENDER_SHOW_TEXTS = 1 << 8,     ///< texts of the caller
    RENDER_SHOW_LEGEND = 1 << 9,    ///< explains the overlays that are on and present
    RENDER_SHOW_GRID = 1 << 10,     ///< background lines at round distances
    RENDER_SHOW_SCALE = 1 << 11,    ///< scale bar with its length
    RENDER_SHOW_TITLE = 1 << 12,    ///< title and caption
    RENDER_SHOW_SPOKES = 1 << 13,   ///< rotation marks of discs
    RENDER_SHOW_NOTHING = 1 << 14,  ///< bodies only (0 means the default)
    RENDER_SHOW_SURFACES = 1 << 15, ///< chevrons on surfaces that run
    RENDER_SHOW_FIELD = 1 << 16,    ///< arrows of a field, below the bodies
    RENDER_SHOW_FLOW = 1 << 17,     ///< pieces of streamlines, below the bodies
    RENDER_SHOW_DIPOLES = 1 << 18   ///< needles of dipoles
};
/// What a `show` of 0 means.
#define RENDER_SHOW_DEFAULT                                                                        \
    (RENDER_SHOW_TRAILS | RENDER_SHOW_JOINTS | RENDER_SHOW_LABELS | RENDER_SHOW_TEXTS |            \
     RENDER_SHOW_SURFACES | RENDER_SHOW_GRID | RENDER_SHOW_SCALE | RENDER_SHOW_TITLE |             \
     RENDER_SHOW_SPOKES | RENDER_SHOW_DIPOLES)

/// Where the legend goes, always at the right edge.
typedef enum render_legend_at {
    RENDER_LEGEND_UPPER = 0,
    RENDER_LEGEND_LOWER,
    RENDER_LEGEND_AUTO ///< where fewer shapes are; decided per picture, so not for animations
} render_legend_at;

/// {0} is the default style.
typedef struct render_options {
    unsigned show;          ///< RENDER_SHOW_*; 0 = RENDER_SHOW_DEFAULT
    double ui_scale;        ///< size of lines and text; 0 = picture height / 540, at least 0.6
    double outline_px;      ///< outline width at ui_scale 1; 0 = 1.6, negative = no outline
    double impulse_scale;   ///< metres per N s; 0 = round number that suits the frame
    double velocity_scale;  ///< metres per m/s; 0 = round number that suits the frame
    render_rgba background; ///< a == 0: warm white
    render_legend_at legend_at;
    const char *unit; ///< unit of length at the scale bar; NULL = "m"
} render_options;

/// Creation parameters; {0} or NULL is the default.
typedef struct render_target_desc {
    const char *font_path;      ///< TrueType file; NULL = $PLUMB_FONT, else the usual places
    const char *bold_font_path; ///< for titles; NULL = bold file beside the regular one, if any
    render_allocator allocator; ///< resize == NULL: realloc and free
} render_target_desc;

/// A picture in memory and the OpenGL context that draws it.
typedef struct render_target render_target;

/// Largest width and height of a target [px].
#define RENDER_SIZE_MAX 8192

/// Makes a target. On failure *target is NULL and `error` says why.
/// Cost: the first draw compiles Mesa's rasteriser, up to 0.1 s.
render_result render_target_create(render_target **target, int width, int height,
                                   const render_target_desc *desc, render_error *error);
/// Draws the frame over a fresh background. `options` NULL = default style.
render_result render_target_draw(render_target *target, const render_frame *frame,
                                 const render_camera *camera, const render_options *options,
                                 render_error *error);
/// RGBA, 8 bits each, top row first, width * 4 bytes a row; valid until the next draw.
const uint8_t *render_target_pixels(const render_target *target);
int render_target_width(const render_target *target);
int render_target_height(const render_target *target);
/// Frees the target. NULL is allowed.
void render_target_destroy(render_target *target);

#ifdef __cplusplus
}
#endif

#endif
