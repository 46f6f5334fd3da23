/// fracture.h - bodies that are cut, shatter, break, become one, grow and shrink.
///
/// Mass, momentum and angular momentum stay what they were, to rounding; energy as told at each function. What is left of a
/// body after a cut is one body for each part that hangs together, so a U that is cut across is three. Convex pieces and
/// outlines are divided exactly; of what is round and is cut, arcs become chords of at most fifteen degrees, whose corners
/// lie on the arc (at most 0.9 % of the radius is left out), and densities make up for the mass. What no cut meets
/// stays as it is.
///
/// The part of the largest mass stays the body that it was, with handle, joints held there, components and what else the world
/// knows by it; its shapes keep their handles. The others are new bodies, whose frame is that of the
/// body that they are of: a point of the material keeps its local coordinates. They have its type, material, filters, user data and
/// settings, but its engine (the largest part keeps it) and its bounds of breaking; charge, dipole, drag and fuel are shared by mass.
/// Joints go to the part in which their anchor lies, or to which it is nearest. Segments, chains and
/// sensors stay with the largest part. Velocities are those of the rigid motion.
///
///     plumb_body halves[8];
///     int count = plumb_body_cut(world, plank, plumb_v2(0, 1), plumb_v2(0, 1), halves, 8);
#ifndef PLUMB_FRACTURE_H
#define PLUMB_FRACTURE_H

#include "plumb/body.h"

PLUMB_BEGIN

/// Most cells that a body shatters into.
#define PLUMB_SHATTER_MAX 64

/// {0} is valid: twelve cells about the origin of the world.
typedef struct plumb_shatter_desc {
    plumb_vec2 point;     ///< [m] in the world, about which cells are denser; |x|, |y| <= 1e9
    int cells;            ///< 2..64: at most so many; 0 means 12
    plumb_real even;      ///< [-] 0..1: 0: cells are the denser the nearer to the point; 1: the same everywhere
    plumb_real min_share; ///< [-] 0..0.5 of the body's area: smaller parts are none; 0 means 0.005
    uint64_t seed;        ///< of where the cells are: the same seed gives the same parts
} plumb_shatter_desc;

/// Cuts a body along the line through `point` [m] in the direction `along` (of any length, not 0). Where the line leaves
/// less than 0.1 mm of a piece on one side it does not cut that piece.
/// Writes up to `capacity` of the new bodies to `parts` and returns how many there are, the one that stays not
/// counted; 0: the line misses the body; -1 on error. O(pieces^2) at worst, O(pieces) of what lies apart.
/// Errors: E_HANDLE, E_RANGE (capacity, along), E_NOT_FINITE, E_STATE (no shape with an area), E_MEMORY, E_LOCKED.
PLUMB_API int plumb_body_cut(plumb_world *world, plumb_body body, plumb_vec2 point, plumb_vec2 along,
                             plumb_body *parts, int capacity);

/// Divides a body along the borders of Voronoi cells about places in it (G. Voronoi 1908), most of them near the point. A cell
/// of which a part would be smaller than `min_share`, or more than ten times as long as wide, gives its room to its neighbours
/// (what is more than 0.6 times as wide as the body may be as long as it is). Answers and errors as of plumb_body_cut; null `desc`: {0}.
/// O(cells^2 pieces) each time a cell is given up.
PLUMB_API int plumb_body_shatter(plumb_world *world, plumb_body body, const plumb_shatter_desc *desc,
                                 plumb_body *parts, int capacity);

//---- bodies that become one, that grow and shrink -------------------------------------------------

/// Makes another body part of a body, where both are now, however far apart: the body keeps its handle, frame, type and settings; the other
/// one's shapes become shapes of it, with their handles, joints to others hold on to it, and the rest of the other
/// goes: joints between the two, its components, laws that it carried. Momentum and angular momentum are those of both.
/// *lost (may be null) gets the kinetic energy [J] that becomes heat: that of a blow without restitution. A body that is not dynamic
/// stays as it is, and takes the motion of the other. A mass, inertia or centre that was given to either is given to both
/// together. O(pieces and joints). Errors: E_HANDLE (also: one body twice), E_RANGE (mass, distance), E_MEMORY, E_LOCKED.
PLUMB_API plumb_result plumb_body_merge(plumb_world *world, plumb_body body, plumb_body other,
                                        double *lost);

/// Makes all shapes of a body larger or smaller by a factor 0.001..1000, about its centre of mass; anchors of joints go along. Its mass
/// goes with the square, at the densities that there are, a mass or inertia that was given with square and fourth power.
/// Velocity and spin stay: what is added moves along with it, what is taken away goes at the velocity that it has, and momentum with
/// it. Shapes keep their handles; what it touches wakes, and what it grows into is pushed out, as of any
/// overlap. To grow over time, or to melt or burn away, call it in every step.
/// O(pieces and joints). Errors: E_HANDLE, E_RANGE (factor; a length or mass of its shapes), E_NOT_FINITE, E_MEMORY, E_LOCKED.
PLUMB_API plumb_result plumb_body_scale(plumb_world *world, plumb_body body, plumb_real factor);

//---- the same within a step -----------------------------------------------------------------------

/// For systems and hooks, which may not call the above: carried out with the other commands (see plumb/ecs.h), in the order in
/// which they were given, when the next step begins. The body may be one that a command is to make. Values are checked when the
/// command is given. What only time can tell drops it with a warning: a body that is gone, or has no shape with an
/// area, a part without mass, a range that a mass or length would leave. Points and lines are in the world, and meet the body where
/// it is by then. What a cut or shattered body has become is told by plumb_world_body_break_events; one that the line misses stays
/// as it is, without an event. What a merger loses nobody tells.
///
///     plumb_command_body_cut(call->world, plank, point, plumb_v2(0, 1));
///
/// Errors: those of the direct calls in E_NULL, E_HANDLE, E_RANGE, E_NOT_FINITE, E_MEMORY; E_UNSUPPORTED (a library without it). O(1).
PLUMB_API plumb_result plumb_command_body_cut(plumb_world *world, plumb_body body, plumb_vec2 point,
                                              plumb_vec2 along);
/// Null `desc`: {0}.
PLUMB_API plumb_result plumb_command_body_shatter(plumb_world *world, plumb_body body,
                                                  const plumb_shatter_desc *desc);
PLUMB_API plumb_result plumb_command_body_merge(plumb_world *world, plumb_body body,
                                                plumb_body other);
PLUMB_API plumb_result plumb_command_body_scale(plumb_world *world, plumb_body body,
                                                plumb_real factor);

//---- bodies that break by themselves -------------------------------------------------------------

/// Bounds above which a dynamic body breaks by itself: the mean force [N] of one contact over a step, its impulse [N s] in a step; 0, the
/// default: never. It shatters about the place of the contact when the next step begins. Of a blow it bears the larger of
/// what takes `break_energy` [J] out of the relative motion of the two and of `break_impulse`: the rest of the impulse is
/// given back as the step ends, so that a stone goes on through the pane. A blow of less energy than
/// `break_energy` does not break it; a load that does not strike (of `break_force`) breaks it whatever its
/// energy. It breaks into up to `break_cells` parts (0: twelve), which have no such bounds of their own. Where two of its contacts exceed
/// a bound, the stronger counts. Worlds without such bodies pay nothing; others add up impulses as with
/// contact_impulses.
/// Errors: E_HANDLE, E_RANGE, E_NOT_FINITE, E_MEMORY, E_UNSUPPORTED (a library without it).
PLUMB_API plumb_result plumb_body_set_break_force(plumb_world *world, plumb_body body,
                                                  plumb_real break_force);
PLUMB_API plumb_real plumb_body_break_force(const plumb_world *world, plumb_body body);
PLUMB_API plumb_result plumb_body_set_break_impulse(plumb_world *world, plumb_body body,
                                                    plumb_real break_impulse);
PLUMB_API plumb_real plumb_body_break_impulse(const plumb_world *world, plumb_body body);
PLUMB_API plumb_result plumb_body_set_break_energy(plumb_world *world, plumb_body body,
                                                   plumb_real break_energy);
PLUMB_API plumb_real plumb_body_break_energy(const plumb_world *world, plumb_body body);
PLUMB_API plumb_result plumb_body_set_break_cells(plumb_world *world, plumb_body body,
                                                  plumb_real break_cells);
PLUMB_API plumb_real plumb_body_break_cells(const plumb_world *world, plumb_body body);

/// A body that broke by itself, or that a command has cut or shattered: then without other, impulse and energy.
typedef struct plumb_body_break {
    plumb_body body;    ///< the largest part, which has its handle
    plumb_body other;   ///< what struck it or lay on it; stale if it is gone by now; null of a command
    plumb_vec2 point;   ///< [m] where; that of the command
    plumb_vec2 normal;  ///< unit, from the body to the other; of a cut, to the left of its line; 0 of a command that shatters
    plumb_real impulse; ///< [N s] that broke it, of the whole step
    plumb_real energy;  ///< [J] taken out of the relative motion of the two, by what it bore
    int first_part;     ///< of plumb_world_body_break_parts
    int part_count;     ///< new bodies
} plumb_body_break;

/// Bodies that broke as the last step began: by commands, in their order, then by themselves, in the order of their contacts in
/// the step before. What plumb_commands_apply has carried out since is told at once, and after the next step with what
/// breaks then. Valid until the next step or plumb_commands_apply. Saved worlds have none. Null and 0 where there are none.
PLUMB_API const plumb_body_break *plumb_world_body_break_events(const plumb_world *world, int *count);
/// The new bodies that all of them broke into.
PLUMB_API const plumb_body *plumb_world_body_break_parts(const plumb_world *world, int *count);

PLUMB_END

#endif
