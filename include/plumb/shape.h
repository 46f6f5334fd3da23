/// shape.h - shapes of bodies. A shape is one or more convex pieces: a chain has one a link, a
/// concave outline is split exactly into convex ones.
///
/// Static pieces that touch (within 1 mm, or a hundredth of the thinner one) are one ground to what slides
/// over them, whichever bodies and shapes they belong to, if they have the same filter and rounding; so are
/// the pieces of one body that moves. Steps lower than that, and bends of less than 1e-3 rad, are none.
///
///     plumb_shape_create(world, body, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 1, 0.5f } });
#ifndef PLUMB_SHAPE_H
#define PLUMB_SHAPE_H

#include "plumb/geometry.h"
#include "plumb/world.h"

PLUMB_BEGIN

typedef enum plumb_shape_kind {
    PLUMB_CIRCLE,  ///< center, radius
    PLUMB_CAPSULE, ///< points[2], radius
    PLUMB_BOX,     ///< half, center, angle, radius (rounding added outside, default 0)
    PLUMB_POLYGON, ///< points[3..64]: their convex hull, at most 16 corners; radius rounds it. Points within
    ///< the hull do nothing, and are a warning in the log: PLUMB_OUTLINE may be concave
    PLUMB_OUTLINE, ///< points[3..256]: a simple closed outline, concave or not, either orientation
    PLUMB_SEGMENT, ///< points[2]: a line without mass that collides on both sides
    PLUMB_CHAIN    ///< points[2..]: joined segments, `closed` joins last to first; two-sided, no mass
} plumb_shape_kind;

/// How many kinds there are.
#define PLUMB_SHAPE_KINDS (PLUMB_CHAIN + 1)

/// Which shapes may meet. {0} is category 1 that meets everything. Two shapes whose groups are equal and
/// not 0 go by the group alone: they meet when it is positive and do not when it is negative. All others
/// meet when each one's category has a bit of the other's mask. Shapes of one body never meet.
typedef struct plumb_filter {
    uint64_t category; ///< bits: what the shape is; 0 means 1
    uint64_t mask;     ///< bits: categories that it meets; 0 means all of them
    int32_t group;     ///< 0: none
    bool nothing;      ///< it meets no category (a mask of 0 would mean all); `mask` must then be 0
} plumb_filter;

/// A shape that things pass through in one direction and that holds them against it: a platform to be
/// jumped on from below. {0}: solid from all sides. What comes from the side that lets pass goes through
/// and, once it is out, can stand on it; nothing is pushed out while it is inside. That is of bodies as a whole: while a part of
/// one is on its way through, the others are not caught either, nor by one-way shapes or pieces that touch (within
/// 1 mm) what it is in: links of a chain, tiles of a row. What that part is on top of holds, as treads of stairs do.
typedef struct plumb_one_way {
    plumb_vec2 direction; ///< in the body's frame, of any length, in which things pass: {0, 1} is upwards
    plumb_real angle;     ///< [rad] 0..pi/2: surfaces whose outward normal is within it of `direction` hold,
                          ///< others let pass; 0 means 60 degrees. Must be 0 without `direction`
} plumb_one_way;

/// {0} is not a shape (a circle needs a radius); fields not named by the kind must be zero, else E_RANGE.
typedef struct plumb_shape_desc {
    plumb_shape_kind kind;
    plumb_vec2 center;        ///< [m] circle, box: in the body's frame
    plumb_real radius;        ///< [m] circle, capsule: > 0; box, polygon: rounding >= 0
    plumb_vec2 half;          ///< [m] box: half width and height, > 0
    plumb_real angle;         ///< [rad] box
    const plumb_vec2 *points; ///< [m] in the body's frame, copied
    int count;                ///< number of points
    bool closed;              ///< chain: join the last point to the first
    plumb_real density;       ///< [kg/m^2] >= 0; 0: the material's
    plumb_material material;  ///< null: the world's default material
    plumb_filter filter;      ///< {0}: category 1, meets everything
    plumb_one_way one_way;    ///< {0}: solid from all sides
    bool sensor;              ///< sees what overlaps it and exerts no force; has no mass, whatever its density
    void *user_data;
} plumb_shape_desc;

/// Adds a shape to a body and revises its mass. Null handle on error: E_NULL, E_HANDLE (body, material),
/// E_RANGE, E_NOT_FINITE, E_GEOMETRY, E_CAPACITY (too many corners), E_MEMORY, E_LOCKED.
PLUMB_API plumb_shape plumb_shape_create(plumb_world *world, plumb_body body, const plumb_shape_desc *desc);

/// Removes a shape; its body's mass is revised. Errors: E_HANDLE, E_LOCKED.
PLUMB_API plumb_result plumb_shape_destroy(plumb_world *world, plumb_shape shape);

/// True for a live handle of a shape.
PLUMB_API bool plumb_shape_valid(const plumb_world *world, plumb_shape shape);
PLUMB_API plumb_shape_kind plumb_shape_get_kind(const plumb_world *world, plumb_shape shape);
/// The body that owns the shape.
PLUMB_API plumb_body plumb_shape_body(const plumb_world *world, plumb_shape shape);
PLUMB_API plumb_material plumb_shape_material(const plumb_world *world, plumb_shape shape);
/// Null sets the default material. Density, and so mass, is not revised. Errors: E_HANDLE.
PLUMB_API plumb_result plumb_shape_set_material(plumb_world *world, plumb_shape shape,
                                                plumb_material material);
/// [kg/m^2] in force: the shape's own or its material's; 0 for lines and sensors.
PLUMB_API plumb_real plumb_shape_density(const plumb_world *world, plumb_shape shape);
/// Sets the shape's own density [kg/m^2] >= 0 and revises the mass of its body; 0: the material's.
/// Errors: E_HANDLE, E_RANGE (also: mass or inertia of the body), E_NOT_FINITE.
PLUMB_API plumb_result plumb_shape_set_density(plumb_world *world, plumb_shape shape, plumb_real density);
/// Mass, centre in the body's frame and inertia about that centre, at the density in force.
PLUMB_API plumb_mass_properties plumb_shape_mass(const plumb_world *world, plumb_shape shape);
/// Gives the shape another form: kind, points and measures of `desc`. Its handle, body, material, density,
/// filter, one-way property, being a sensor and user data stay, whatever `desc` says of them, and so does its place among the
/// shapes of the body, whose mass is revised.
/// What it touched is found anew: touches that go on end and begin. A shape that has that form already stays as it is, and so do
/// its touches. Errors: as of plumb_shape_create.
PLUMB_API plumb_result plumb_shape_set_geometry(plumb_world *world, plumb_shape shape,
                                                const plumb_shape_desc *desc);
PLUMB_API plumb_result plumb_shape_set_user_data(plumb_world *world, plumb_shape shape, void *user_data);
PLUMB_API void *plumb_shape_user_data(const plumb_world *world, plumb_shape shape);

/// The filter in force, with category and mask resolved; {0} for a dead handle.
PLUMB_API plumb_filter plumb_shape_filter(const plumb_world *world, plumb_shape shape);
/// Changes the filter; holds from the next step, in which touches that it forbids end. The next step
/// finds its pairs anew. Errors: E_HANDLE, E_RANGE (a mask together with `nothing`).
PLUMB_API plumb_result plumb_shape_set_filter(plumb_world *world, plumb_shape shape, plumb_filter filter);
/// True when the two filters let their shapes meet: the rule told at plumb_filter. O(1).
PLUMB_API bool plumb_filters_meet(plumb_filter a, plumb_filter b);

/// The one-way property in force, its direction a unit vector; {0} if it has none, or for a dead handle.
PLUMB_API plumb_one_way plumb_shape_one_way(const plumb_world *world, plumb_shape shape);
/// Changes it; what overlaps the shape at the next step by more than 2 cm, and more than it came in the last, passes. Errors: E_HANDLE, E_RANGE,
/// E_NOT_FINITE.
PLUMB_API plumb_result plumb_shape_set_one_way(plumb_world *world, plumb_shape shape,
                                               plumb_one_way one_way);
/// Lets a dynamic body drop through the one-way shapes that hold it in the next step, until it has left
/// them; holds for that step's contacts alone. Errors: E_HANDLE, E_STATE (not dynamic).
PLUMB_API plumb_result plumb_body_drop_through(plumb_world *world, plumb_body body);

/// Keeps all shapes of two bodies apart from one another (true) or ends that (false). Sensors do not
/// see excluded bodies either. Forgotten when one of them is destroyed. O(log excluded pairs), to add or
/// remove O(excluded pairs). Errors: E_HANDLE, E_RANGE (one body twice), E_MEMORY.
PLUMB_API plumb_result plumb_world_exclude_pair(plumb_world *world, plumb_body a, plumb_body b,
                                                bool exclude);
/// True when plumb_world_exclude_pair keeps the two apart. O(log excluded pairs).
PLUMB_API bool plumb_world_is_excluded(const plumb_world *world, plumb_body a, plumb_body b);

/// A sensor sees every shape of another body that overlaps it and that its filter lets it meet: shapes
/// of dynamic and kinematic bodies, those of static bodies unless its own body is static too, and other
/// sensors. Nothing needs to be switched on in the shapes that are seen. It exerts no force, has no
/// mass, and queries pass through it unless asked (plumb_query_filter).
PLUMB_API bool plumb_shape_is_sensor(const plumb_world *world, plumb_shape shape);
/// Turns a shape into a sensor or back; its body's mass is revised. Errors: E_HANDLE, E_LOCKED.
PLUMB_API plumb_result plumb_shape_set_sensor(plumb_world *world, plumb_shape shape, bool sensor);
/// Shapes that overlap a sensor where they were after the last step, in slot order: writes up to
/// `capacity`, returns how many; -1 on error. The test is exact, shape against shape. What something
/// struck so hard within the step that it left the box predicted for it is seen one step later; what
/// flies through a sensor within one step is not seen. O(log overlaps of the world + answer).
/// Errors: E_HANDLE, E_STATE (no sensor), E_RANGE (capacity), E_NULL.
PLUMB_API int plumb_shape_overlaps(const plumb_world *world, plumb_shape sensor, plumb_shape *shapes,
                                   int capacity);

/// Number of convex pieces.
PLUMB_API int plumb_shape_piece_count(const plumb_world *world, plumb_shape shape);
/// Piece i in the frame of the body's origin. *cuts (may be null) gets a bit per edge (bit k: the edge
/// from corner k to k+1) that is an inner cut and not part of the outline.
/// Errors: E_HANDLE, E_NULL, E_RANGE (i).
PLUMB_API plumb_result plumb_shape_piece(const plumb_world *world, plumb_shape shape, int i,
                                         plumb_convex *piece, uint32_t *cuts);
/// Tight box [m] around the shape where it is now.
PLUMB_API plumb_aabb plumb_shape_aabb(const plumb_world *world, plumb_shape shape);
/// True when the world point [m] lies in the shape.
PLUMB_API bool plumb_shape_contains(const plumb_world *world, plumb_shape shape, plumb_vec2 point);

/// All shapes in storage order, for drawing and inspection: writes up to `capacity`, returns how many
/// there are. O(shapes).
PLUMB_API int plumb_world_shapes(const plumb_world *world, plumb_shape *shapes, int capacity);

PLUMB_END

#endif
