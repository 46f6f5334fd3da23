// effects.h - what can be left out of the library: `make EFFECTS="gravity friction joints"`, or "all -liquid". The one list: the
// Makefile reads it, too.
//
//     X(name, word, needs, files, properties, text)
//
//   word        what make and users call it
//   needs       effects that must be in as well
//   files       left out of the library with it, as make's patterns; api/absent.c stands in for what others call of them
//   properties  of worlds, bodies and materials that then must be at their defaults: E_UNSUPPORTED
//
// What is on by default is off in a library without it: gravity, friction, continuous.
#ifndef PL_EFFECT_LIST_H
#define PL_EFFECT_LIST_H

// clang-format off
#define PL_EFFECTS(X)                                                                                                          \
    X(GRAVITY, "gravity", "", "", "gravity gravity_scale", "the same acceleration of all bodies")                              \
    X(FRICTION, "friction", "", "",                                                                                            \
      "friction kinetic_friction rolling_resistance surface_speed friction_mix", "of contacts, and surfaces that run")         \
    X(RESTITUTION, "restitution", "",                                                                                          \
      "src/solver/impact.c src/solver/impact_queue.c src/solver/bounce.c src/solver/restitution.simd.c",                       \
      "restitution restitution_mix", "contacts that bounce")                                                                   \
    X(DAMPING, "damping", "", "src/effects/damping.c", "damping angular_damping", "velocities of bodies that decay")           \
    X(DRAG, "drag", "", "src/effects/drag.c", "drag", "still air that slows bodies by the square of their speed")              \
    X(ENGINES, "engines", "", "src/effects/engine.c", "thrust exhaust fuel thrust_x thrust_y thrust_angle",                    \
      "thrust that burns fuel")                                                                                                \
    X(SPEED_CAPS, "speed_caps", "", "src/effects/speed_cap.c", "max_speed max_spin", "speeds that bodies never exceed")        \
    X(TIME_SCALES, "time_scales", "", "src/effects/time_scale.c", "time_scale", "bodies with a time of their own")             \
    X(TARGETS, "targets", "", "src/effects/target.c src/effects/track.c", "", "kinematic bodies on their way to a target")     \
    X(CONTINUOUS, "continuous", "", "src/continuous/continuous.c src/continuous/impact.c src/continuous/movers.c "             \
      "src/continuous/search.c", "continuous", "what moves fast passes through nothing")                                       \
    X(SENSORS, "sensors", "", "src/event/sensor_events.c", "", "shapes that tell what they overlap")                           \
    X(FLUIDS, "fluids", "sensors", "src/effects/fluid.c src/effects/fluid_forces.c src/effects/flow.c "              \
      "src/effects/local_flow.c src/effects/shelter.c src/geometry/immersed.c",                                                \
      "fluid", "volumes that lift and drag: water, wind")                                                                      \
    X(WAVES, "waves", "fluids", "src/effects/waves.c src/effects/tides.c src/geometry/harmonics.c", "",                        \
      "surfaces of water that bodies stir")                                                                                    \
    X(LAWS, "laws", "", "src/effects/laws.c src/effects/law_field.c src/effects/law_forces.c src/effects/orbits.c "            \
      "src/effects/dipoles.c src/effects/law_rest.c",                                                                          \
      "charge attraction dipole dipole_angle",                                                                                 \
      "forces at a distance: attractors, gravitation, zones, magnetic fields, dipoles")                                        \
    X(FORMULAS, "formulas", "laws", "src/formula/% src/effects/law_formula.c", "", "forces at a distance that texts give")     \
    X(FRACTURE, "fracture", "", "src/api/breaking.c src/api/command_fracture.c src/api/divide.c src/api/fracture.c "           \
      "src/api/fragments.c src/api/merge.c src/event/breaking.c src/geometry/region.c",                                        \
      "break_force break_impulse break_energy break_cells",                                                                    \
      "bodies that are cut, break, merge, grow and shrink")                                                                    \
    X(HEAT, "heat", "fracture", "src/effects/heat.c src/api/heat_run.c",                                                       \
      "temperature heat_capacity conductance emissivity ambient heating melting_point latent_heat melt_phase ignition "        \
      "burn_rate burn_heat growth smallest",                                                                                   \
      "bodies that warm, melt, burn and grow")                                                                                 \
    X(LIQUID, "liquid", "", "src/liquid/%", "", "particles that flow")                                                         \
    X(AIR, "air", "liquid", "src/air/%", "", "air that flows round shapes, with smoke and heat")                               \
    X(SOFTBODIES, "softbodies", "", "src/softbody/%", "", "ropes, nets and cloth, jelly, skins with gas")                      \
    X(LIGHT, "light", "", "src/query/light.c src/query/beam.c src/query/fresnel.c src/query/transit.c",                        \
      "refractive_index reflectance absorption", "rays that mirrors send back and glass bends")                                \
    X(CHARACTERS, "characters", "", "src/character/%", "", "bodies that walk")                                                 \
    X(JOINTS, "joints", "", "src/joints/%", "direct_joints", "of all kinds")                                                   \
    X(PGS, "pgs", "", "src/solver/pgs.c", "", "the classic solver")                                                            \
    X(EXACT, "exact", "joints pgs", "src/exact/%", "", "the exact solver")                                                     \
    X(MEASURES, "measures", "", "src/step/measure.c src/step/measure_rows.c src/solver/measure.c src/solver/measure.simd.c "   \
      "src/joints/measure.simd.c", "measure", "a world that measures its error")                                               \
    X(TOLERANCE, "tolerance", "exact", "src/accuracy/%", "tolerance", "a world that chooses solver and substeps")              \
    X(WATCHDOG, "watchdog", "", "src/watchdog/%", "watchdog", "a world that tells alarms")
// clang-format on

// PL_HAS(NAME): 1, or 0 where the library is compiled with -DPL_WITHOUT_NAME; in #if as well.
#define PL_HAS(NAME)             PL_IS_EMPTY_OF(PL_WITHOUT_##NAME)
#define PL_IS_EMPTY_OF(flag)     PL_IS_EMPTY_OF_(flag)
#define PL_IS_EMPTY_OF_(value)   PL_SECOND_OF(PL_COMMA_BEHIND_##value 0, 1, 0)
#define PL_SECOND_OF(...)        PL_SECOND_OF_(__VA_ARGS__)
#define PL_SECOND_OF_(a, b, ...) b
#define PL_COMMA_BEHIND_1        ~,

// Whether all are in.
#define PL_AND_HAS(NAME, ...) &&PL_HAS(NAME)
#define PL_HAS_ALL            (true PL_EFFECTS(PL_AND_HAS))

#endif
