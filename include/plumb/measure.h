/// measure.h - the error of a step, as the world itself sees it: what is left of the laws that it solved, and where its
/// energy went.
///
///     plumb_world_set_measure(world, true);
///     plumb_world_step(world, dt);
///     const plumb_measures *m = plumb_world_measures(world);
///     printf("%g m deep, friction took %g J\n", m->gap, -m->work[PLUMB_WORK_FRICTION].kinetic);
///
/// Measuring changes no bit of what the world does. Off, it costs nothing; on, a step takes several times as long.
#ifndef PLUMB_MEASURE_H
#define PLUMB_MEASURE_H

#include "plumb/world.h"

PLUMB_BEGIN

/// What changes the energy of a world: X(NAME, name, text).
// clang-format off
#define PLUMB_WORK_LIST(X)                                                                              \
    X(GRAVITY,  gravity,  "work of gravity, and what bodies gave for it in height")                      \
    X(FORCES,   forces,   "forces and torques of the user's; systems of the substep")                    \
    X(FLUIDS,   fluids,   "volumes of water and wind: what lifts, drags and carries, and the mass they lend") \
    X(LIQUID,   liquid,   "liquid and air that flow")                                                    \
    X(LAWS,     laws,     "forces at a distance, zones, magnetic fields, formulas; orbits")                        \
    X(THRUST,   thrust,   "engines, and the fuel that they burn")                                        \
    X(SOFT,     soft,     "ropes, cloth, jelly and skins that touch or hold bodies")                     \
    X(NORMAL,   normal,   "contacts along their normals: blows that do not bounce, platforms that lift") \
    X(FRICTION, friction, "contacts along their surfaces, rolling resistance, friction joints")          \
    X(IMPACTS,  impacts,  "blows that bounce, friction in them too")                                     \
    X(RECOVERY, recovery, "overlaps pushed apart: what that lifted")                                     \
    X(JOINTS,   joints,   "joints where they are rigid, limits, ropes")                                  \
    X(SPRINGS,  springs,  "springs of joints, and what is stored in them")                               \
    X(MOTORS,   motors,   "motors of joints")                                                            \
    X(DAMPING,  damping,  "damping and caps of speed")                                                   \
    X(SLEEP,    sleep,    "falling asleep and waking")                                                   \
    X(STOPS,    stops,    "bodies put back to where they would have passed into something")              \
    X(SYSTEMS,  systems,  "systems that set places or velocities; characters; worlds that wrap")         \
    X(REST,     rest,     "unexplained: rounding, and what no row above has")
// clang-format on

typedef enum plumb_work {
#define PLUMB_WORK_ENUM(NAME, name, text) PLUMB_WORK_##NAME,
    PLUMB_WORK_LIST(PLUMB_WORK_ENUM)
#undef PLUMB_WORK_ENUM
        PLUMB_WORKS
} plumb_work;

/// What one of them did to the energy of the world in a step. The sum of both is 0 where it exchanges energy without
/// error, as gravity and undamped springs should.
typedef struct plumb_balance {
    double kinetic;   ///< [J] change of kinetic energy
    double potential; ///< [J] change of potential and stored energy
} plumb_balance;

/// Of one step.
typedef struct plumb_measures {
    uint64_t step; ///< stats' step_count behind it; 0: none has been measured
    /// What is left of the law of contacts where the last substep ended.
    double gap;             ///< [m] deepest overlap
    double approach;        ///< [m/s] fastest approach at a point that touches or bears
    double complementarity; ///< [N s m] largest impulse of a point times how far it is apart
    double cone;            ///< [N s] most by which friction exceeds its bound
    double momentum;        ///< [N s] most that a body's change of momentum differs from its impulses; soft step
    double joint_length;    ///< [m] most that a rigid row of a joint is off
    double joint_angle;     ///< [rad] likewise, of rows that turn alone
    double before, after;   ///< [J] kinetic + potential + stored: as the step began, as it ended; of bodies and joints, not
                            ///< of laws and soft bodies, which plumb_world_energy has
    /// By what: both columns of all rows add up to `after` - `before`.
    plumb_balance work[PLUMB_WORKS];
} plumb_measures;

/// Switches measuring, as `measure` in the descriptor does. Errors: E_NULL, E_LOCKED.
PLUMB_API plumb_result plumb_world_set_measure(plumb_world *world, bool measure);
/// Of the last step that was measured; valid until the next one. Null for null.
PLUMB_API const plumb_measures *plumb_world_measures(const plumb_world *world);
/// "gravity", ... and what it covers; null for what is none.
PLUMB_API const char *plumb_work_name(plumb_work work);
PLUMB_API const char *plumb_work_text(plumb_work work);

PLUMB_END

#endif
