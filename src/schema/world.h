// world.h - the settings of a world. See row.h. Capacities, hooks and the like are no properties.
#ifndef PL_SCHEMA_WORLD_H
#define PL_SCHEMA_WORLD_H

#include "plumb/world.h"
#include "schema/row.h"

// clang-format off
#define PL_WORLD_ROWS(R, X)                                                                         \
    R(X, STATE, VEC2, gravity, SAID(gravity), "m/s^2", ANY, 0, ZERO(zero_gravity),                  \
      "without it 9.81 downwards")                                                                  \
    R(X, STATE, Y_AXIS, y_axis, SAID(y), PL_Y_AXIS_CHOICES, CHOICES(PLUMB_Y_DOWN), PLUMB_Y_UP,      \
      NO_ZERO, "where +y points to: turns the default gravity, pictures, and what is up")           \
    R(X, STATE, SOLVER, solver, SAID(solver), PL_SOLVER_CHOICES, CHOICES(PLUMB_SOLVER_EXACT),       \
      PLUMB_SOLVER_SOFT, NO_ZERO, "soft step, the classic projected Gauss-Seidel, or a direct one") \
    R(X, STATE, INT, substeps, SAID(substeps), "1", FROM(1, 64), 4, NO_ZERO,                        \
      "of a step; default of pgs: 1")                                                               \
    R(X, STATE, INT, iterations, SAID(iterations), "1", FROM(1, 1000), 1, NO_ZERO,                  \
      "sweeps a substep; default of pgs: 10 a step")                                                \
    R(X, STATE, BOOL, direct_joints, SAID(direct_joints), "1", CHOICES(1), 0, NO_ZERO,              \
      "joints are solved together, exactly, by a direct method: long chains, heavy ends, trusses")  \
    R(X, STATE, REAL, exact_tolerance, SAID(exact_tolerance), "1", FROM(0, 0.5), 1e-9, NO_ZERO, \
      "of the exact solver: what may be left of a speed that it has to undo")                       \
    R(X, STATE, REAL, tolerance, SAID(tolerance), "1", FROM(0, 0.5), 0, NO_ZERO,                    \
      "error that the world keeps to by choosing solver and substeps itself; 0: it does not")       \
    R(X, STATE, REAL, contact_hertz, SAID(contact_hertz), "1/s", FROM(0, NO_END), 0, NO_ZERO,       \
      "stiffness of contacts; 0: a sixth of the substep rate, which is also the most")              \
    R(X, STATE, REAL, contact_damping, SAID(contact_damping), "1", ABOVE(0, NO_END), 3, NO_ZERO,    \
      "damping ratio of contacts")                                                                  \
    R(X, STATE, REAL, push_speed, SAID(push_speed), "m/s", ABOVE(0, NO_END), 6, NO_ZERO,            \
      "fastest recovery from overlap")                                                              \
    R(X, STATE, REAL, restitution_speed, SAID(restitution_speed), "m/s", FROM(0, NO_END), 0, NO_ZERO, \
      "approach slower than this does not bounce")                                                  \
    R(X, STATE, REAL, hit_speed, UNSAID, "m/s", FROM(0, NO_END), 0, NO_ZERO,                        \
      "contacts that approach faster make hit events; 0: none do")                                  \
    R(X, STATE, BOOL, contact_impulses, SAID(contact_impulses), "1", CHOICES(1), 0, NO_ZERO,        \
      "impulses of contacts are added up over the step")                                            \
    R(X, STATE, BOOL, no_sleep, NOT(sleep), "1", CHOICES(1), 0, NO_ZERO,                            \
      "whether bodies at rest fall asleep")                                                         \
    R(X, STATE, REAL, sleep_speed, SAID(sleep_speed), "m/s", ABOVE(0, NO_END), 0.05, NO_ZERO,       \
      "bodies slower than this rest")                                                               \
    R(X, STATE, REAL, sleep_time, SAID(sleep_time), "s", ABOVE(0, NO_END), 0.5, NO_ZERO,            \
      "how long bodies must have rested to fall asleep")                                            \
    R(X, STATE, BOOL, no_continuous, NOT(continuous), "1", CHOICES(1), 0, NO_ZERO,                  \
      "whether what moves fast passes through nothing")                                             \
    R(X, STATE, REAL, wrap_x, SAID(wrap_x), "m", FROM(0.1, 2e9), 0, NO_ZERO,                        \
      "the world is so long along x and closes in on itself")                                       \
    R(X, STATE, REAL, wrap_y, SAID(wrap_y), "m", FROM(0.1, 2e9), 0, NO_ZERO,                        \
      "the world is so long along y and closes in on itself")                                       \
    R(X, HERE, BOOL, no_exact_islands, NOT(exact_islands), "1", CHOICES(1), 0, NO_ZERO,             \
      "whether the soft step solves small islands exactly that sweeps cannot hold")                 \
    R(X, HERE, BOOL, no_fine_islands, NOT(fine_islands), "1", CHOICES(1), 0, NO_ZERO,               \
      "whether in a small world bodies that touch one another take finer substeps")                 \
    R(X, HERE, INT, simd_width, SAID(simd_width), "1", FROM(0, 16), 0, NO_ZERO,                     \
      "floats of a vector register: 4, 8, 16; 0: the best measured; every width gives the same bits") \
    R(X, HERE, BOOL, measure, SAID(measure), "1", CHOICES(1), 0, NO_ZERO,                           \
      "the world measures its error: residuals, and energy by what changed it")                     \
    R(X, HERE, BOOL, watchdog, SAID(watchdog), "1", CHOICES(1), 0, NO_ZERO,                         \
      "the world tells alarms: energy jumps, tunnelling, torn joints and the like, with what was called last") \
    R(X, HERE, INT, workers, SAID(workers), "1", FROM(0, PLUMB_WORKERS_MAX), 1, NO_ZERO,            \
      "threads that share the work of a step; any number gives the same bits")                      \
    R(X, STATE, REAL, restitution_cap, SAID(restitution_cap), "m/s", ABOVE(0, NO_END), 20, NO_ZERO, \
      "what restitution above 1 gives ends at this speed")
// clang-format on

#endif
