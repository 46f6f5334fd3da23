// absent.c - stands in for effects that the library is built without (schema/effects.h): nothing wants their passes, and what
// others call of them does nothing. Public functions that ask for them refuse.
//
// A library with all effects has nothing of this file. One without is linked with -z defs: what is missing here is an error.
#include "schema/effects.h"

#include "accuracy/dial.h"
#include "air/air.h"
#include "api/command.h"
#include "api/fracture.h"
#include "api/heat_run.h"
#include "character/character.h"
#include "continuous/continuous.h"
#include "effects/drag.h"
#include "effects/effects.h"
#include "effects/engine.h"
#include "effects/fluid.h"
#include "effects/gather.h"
#include "effects/heat.h"
#include "effects/laws.h"
#include "effects/waves.h"
#include "event/event.h"
#include "exact/exact.h"
#include "joints/energy.h"
#include "joints/measure.h"
#include "liquid/liquid.h"
#include "liquid/sample.h"
#include "plumb/light.h"
#include "softbody/softbody.h"
#include "solver/measure.h"
#include "step/measure.h"
#include "watchdog/watchdog.h"
#include "world/check.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"

// Kernels have no prototypes but where they are called from.
// clang-format off
#define VOID(fn, ...)       void fn(__VA_ARGS__); void fn(__VA_ARGS__) {}
#define GIVES(type, fn, value, ...)                                                                \
    type fn(__VA_ARGS__)                                                                           \
    {                                                                                              \
        return value;                                                                              \
    }
#define WANT(fn)                                                                                   \
    bool fn(const plumb_world *world, const char **reason)                                         \
    {                                                                                              \
        *reason = "this library was built without it";                                             \
        return false;                                                                              \
    }
#define PASS(fn)            GIVES(plumb_result, fn, PLUMB_OK, plumb_world *world, plumb_real dt)
#define ROW(fn)             VOID(fn, pl_substep *s)
#define WORLD(fn)           VOID(fn, plumb_world *world)
#define WORLD_DT(fn)        VOID(fn, plumb_world *world, real dt)
#define RESERVE(fn)         GIVES(bool, fn, true, plumb_world *world)
#define RESERVE_DT(fn)      GIVES(bool, fn, true, plumb_world *world, real dt)
#define FREE(fn, type)      VOID(fn, pl_memory *memory, type *part)
#define REFUSES(fn, what, effect, ...)                                                             \
    plumb_result fn(__VA_ARGS__)                                                                   \
    {                                                                                              \
        return pl_fail_absent(world, __func__, what, effect);                                      \
    }
#define KERNEL(fn)          VOID(fn, const pl_contact_call *call, uint32_t first, uint32_t count)
#define WIDTHS(K, fn)       K(fn##_w4) K(fn##_w8) K(fn##_w16)

#if !PL_HAS(RESTITUTION)
VOID(pl_impacts_prepare, plumb_world *world, near_real dt)
VOID(pl_impacts_prepare_classic, plumb_world *world, near_real dt)
VOID(pl_impacts_run, plumb_world *world, near_real h)
VOID(pl_impacts_run_on, plumb_world *world, near_real h)
VOID(pl_impacts_tell, plumb_world *world, near_real h)
WIDTHS(KERNEL, pl_contact_prepare_bounces)
WIDTHS(KERNEL, pl_contact_bounce)
WIDTHS(KERNEL, pl_contact_bounce_special)
WIDTHS(KERNEL, pl_contact_store_bounces)
#endif

#if !PL_HAS(DAMPING)
ROW(pl_damping_row)
RESERVE_DT(pl_damping_find)
GIVES(real, pl_damping_fly, 0, plumb_world *world, uint32_t row, const pl_damping_decay *decay)
#endif

#if !PL_HAS(DRAG)
WANT(pl_want_drag)
RESERVE(pl_drag_find)
ROW(pl_drag_row)
GIVES(bool, pl_drag_acts_on, false, const plumb_world *world, uint32_t row)
#endif

#if !PL_HAS(ENGINES)
WANT(pl_want_engines)
RESERVE_DT(pl_engines_find)
WORLD(pl_engines_burn)
ROW(pl_thrust_row)
GIVES(bool, pl_engine_acts_on, false, const plumb_world *world, uint32_t row)
#endif

#if !PL_HAS(SPEED_CAPS)
ROW(pl_caps_row)
RESERVE(pl_caps_find)
VOID(pl_caps_take_over, plumb_world *world, uint32_t row, const pl_body_settings *settings)
#endif

#if !PL_HAS(TIME_SCALES)
VOID(pl_time_scale_gather, plumb_world *world, uint32_t slot, near_real scale)
VOID(pl_time_scale_take_over, plumb_world *world, uint32_t row, real scale)
#endif

#if !PL_HAS(TARGETS)
WORLD_DT(pl_targets_arrive)
WORLD_DT(pl_tracks_open)
WORLD_DT(pl_tracks_arrive)
WORLD(pl_tracks_undo)
VOID(pl_target_reaim, plumb_world *world, uint32_t row)
VOID(pl_tracks_begin, const struct pl_substep *s)
VOID(pl_tracks_end, const struct pl_substep *s)
REFUSES(plumb_body_set_target, "a target", "targets", plumb_world *world, plumb_body body, plumb_vec2 position,
        plumb_real angle, plumb_real dt)
REFUSES(plumb_body_set_target_moving, "a target", "targets", plumb_world *world, plumb_body body, plumb_vec2 position,
        plumb_real angle, plumb_vec2 velocity, plumb_real angular_velocity, plumb_real dt)
#endif

#if !PL_HAS(CONTINUOUS)
WANT(pl_continuous_wanted)
RESERVE(pl_continuous_reserve)
WORLD_DT(pl_continuous_run)
FREE(pl_continuous_free, pl_continuous)
#endif

#if !PL_HAS(SENSORS)
RESERVE(pl_sensing_prepare)
WORLD(pl_sensing_run)
FREE(pl_sensing_free, pl_sensing)
GIVES(int, plumb_shape_overlaps, pl_fail_absent(world, __func__, "sensor", "sensors") == PLUMB_OK ? 0 : -1,
      const plumb_world *world, plumb_shape sensor, plumb_shape *shapes, int capacity)
#endif

#if !PL_HAS(FLUIDS)
WANT(pl_want_fluids)
RESERVE(pl_fluids_find)
RESERVE(pl_fluids_immerse)
ROW(pl_fluid_row)
VOID(pl_fluid_volume, const plumb_world *world, uint32_t piece, pl_volume *out)
GIVES(bool, pl_fluid_is_restless, false, const plumb_world *world, uint32_t piece)
VOID(pl_fluid_velocity, const plumb_world *world, const pl_volume *volume, double x, double y, const double from[2], double since, double out[2])
GIVES(bool, pl_fluid_acts_on, false, const plumb_world *world, uint32_t row)
#endif

#if !PL_HAS(WAVES)
WANT(pl_want_waves)
PASS(pl_run_wave_motion)
RESERVE_DT(pl_waves_open)
RESERVE(pl_waves_feel)
FREE(pl_waves_free, pl_waves)
GIVES(bool, pl_waves_are_lively, false, const plumb_world *world, uint32_t piece)
GIVES(pl_basin, pl_basin_of, (pl_basin){ .stands = false }, const plumb_world *world, const pl_wave_surface *surface)
VOID(pl_waves_sample, const pl_basin *basin, const pl_wave_surface *surface, const plumb_wave_mode *modes, double time, double x, double out[3])
VOID(pl_waves_flow, const pl_basin *basin, const pl_wave_surface *surface, const plumb_wave_mode *modes, double time, double x, double z, double out[2])
GIVES(double, pl_wave_omega, 1, const pl_basin *basin, double k)
#endif

#if !PL_HAS(FORMULAS)
GIVES(bool, pl_formula_compile, false, const char *const texts[2], bool is_potential, pl_formula *out, pl_formula_fault *fault)
GIVES(double, pl_formula_potential, 0, const plumb_world *world, const pl_law_now *law, double x, double y)
VOID(pl_formulas_pull, const pl_law_system *system, const pl_law_state *states, double time, double *out, double *slopes)
VOID(pl_formulas_heed, plumb_world *world, double dt)
#endif

#if !PL_HAS(LAWS)
WANT(pl_want_laws)
PASS(pl_run_orbits)
ROW(pl_law_row)
WANT(pl_want_dipoles)
ROW(pl_dipole_row)
RESERVE_DT(pl_laws_find)
RESERVE(pl_laws_take_slots)
WORLD_DT(pl_laws_settle)
FREE(pl_laws_free, pl_laws)
GIVES(bool, pl_law_acts_on, false, const plumb_world *world, uint32_t row)
GIVES(bool, pl_laws_couple, false, const plumb_world *world, uint8_t *called)
GIVES(double, pl_laws_potential, 0, const plumb_world *world)
GIVES(plumb_orbit_desc, pl_orbits_of, (plumb_orbit_desc){ .order = 2 }, const plumb_world *world)
void pl_laws_probe(const plumb_world *world, const pl_law_state *state, double charge, double out[2])
{
    out[0] = (double)world->desc.gravity.x;
    out[1] = (double)world->desc.gravity.y;
}
#endif

#if !PL_HAS(FRACTURE)
WANT(pl_want_breaking)
RESERVE(pl_breaking_prepare)
WORLD_DT(pl_breaking_find)
FREE(pl_fracture_free, pl_fracture)
GIVES(plumb_result, pl_breaks_run, PLUMB_OK, plumb_world *world, const char *function, bool waits)
#define REFUSES_PARTS(fn, ...)                                                                     \
    int fn(__VA_ARGS__)                                                                            \
    {                                                                                              \
        pl_fail_absent(world, __func__, "a body in parts", "fracture");                            \
        return -1;                                                                                 \
    }
REFUSES_PARTS(plumb_body_cut, plumb_world *world, plumb_body body, plumb_vec2 point, plumb_vec2 along,
              plumb_body *parts, int capacity)
REFUSES_PARTS(plumb_body_shatter, plumb_world *world, plumb_body body, const plumb_shatter_desc *desc,
              plumb_body *parts, int capacity)
REFUSES(plumb_body_merge, "a merged body", "fracture", plumb_world *world, plumb_body body, plumb_body other,
        double *lost)
REFUSES(plumb_body_scale, "a scaled body", "fracture", plumb_world *world, plumb_body body, plumb_real factor)
REFUSES(plumb_command_body_cut, "a body in parts", "fracture", plumb_world *world, plumb_body body, plumb_vec2 point,
        plumb_vec2 along)
REFUSES(plumb_command_body_shatter, "a body in parts", "fracture", plumb_world *world, plumb_body body,
        const plumb_shatter_desc *desc)
REFUSES(plumb_command_body_merge, "a merged body", "fracture", plumb_world *world, plumb_body body, plumb_body other)
REFUSES(plumb_command_body_scale, "a scaled body", "fracture", plumb_world *world, plumb_body body, plumb_real factor)
GIVES(plumb_result, pl_command_fracture_run, PLUMB_OK, plumb_world *world, const pl_command *r, const char *payload)
GIVES(size_t, pl_command_fracture_payload, 0, const pl_command *r)
GIVES(bool, pl_command_fracture_is_sound, false, const pl_command *r, const char *payload)
GIVES(const plumb_body_break *, plumb_world_body_break_events, (count != NULL ? (*count = 0) : 0, NULL),
      const plumb_world *world, int *count)
GIVES(const plumb_body *, plumb_world_body_break_parts, (count != NULL ? (*count = 0) : 0, NULL),
      const plumb_world *world, int *count)
#endif

#if !PL_HAS(HEAT)
WANT(pl_want_heat)
RESERVE(pl_heat_reserve_flow)
VOID(pl_heat_flow, plumb_world *world, double dt)
GIVES(plumb_result, pl_heat_run, PLUMB_OK, plumb_world *world, const char *function, bool waits)
#endif

#if !PL_HAS(LIQUID)
WANT(pl_want_liquid)
PASS(pl_run_liquid)
PASS(pl_run_liquid_motion)
WORLD(pl_liquid_undo)
GIVES(bool, pl_liquid_file, true, plumb_world *world)
GIVES(pl_liquid_fill, pl_liquid_fill_at, ((pl_liquid_fill){ 0 }), const pl_liquid *liquid, double x, double y)
GIVES(double, pl_liquid_ray_to_surface, -1, const pl_liquid *liquid, double x, double y, double dx, double dy, double length)
FREE(pl_liquid_free, pl_liquid)
#endif

#if !PL_HAS(AIR)
WANT(pl_want_air)
PASS(pl_run_air)
PASS(pl_run_air_motion)
WORLD(pl_air_undo)
FREE(pl_air_free, pl_air)
GIVES(pl_air_extent, pl_air_extent_of, (pl_air_extent){ 0 }, const plumb_air_desc *desc)
#endif

#if !PL_HAS(SOFTBODIES)
WANT(pl_want_softbodies)
PASS(pl_run_softbodies)
PASS(pl_run_soft_slots)
PASS(pl_run_softbodies_motion)
ROW(pl_softbodies_row)
GIVES(bool, pl_softbodies_act_on, false, const plumb_world *world, uint32_t row)
GIVES(bool, pl_softbodies_couple, false, const plumb_world *world, uint8_t *called)
FREE(pl_softbodies_free, pl_softbodies)
VOID(pl_soft_rest_pass, plumb_world *world, plumb_real passed)
GIVES(bool, pl_soft_is_rested, false, const pl_softbody *item)
GIVES(bool, pl_soft_is_blown, false, const plumb_world *world, const pl_softbody *item)
GIVES(double, pl_soft_square_speed, 0, const plumb_world *world, const pl_softbody *item, pl_softbody_place at)
GIVES(double, pl_soft_gap, 0, const plumb_world *world, const pl_softbody *item, pl_softbody_place at, uint32_t row, uint32_t piece, double dt)
GIVES(double, pl_soft_way_of_row, 0, const plumb_world *world, uint32_t row, double dt)
GIVES(double, pl_soft_elastic, 0, const plumb_world *world, uint32_t row, pl_softbody_place at)
GIVES(double, pl_soft_area, 0, const plumb_world *world, const pl_softbody *item, pl_softbody_place at)
GIVES(double, pl_soft_pressure, 0, const pl_softbody *item, double area)
GIVES(bool, pl_soft_foresee, true, plumb_world *world, plumb_real dt)
VOID(pl_soft_answer, const pl_soft_step *s)
VOID(pl_soft_push, const pl_soft_step *s, uint32_t point, double x, double y)
GIVES(pl_soft_shove *, pl_soft_make_pushes, NULL, plumb_world *world)
WORLD(pl_soft_drop_pushes)
#endif

#if !PL_HAS(LIGHT)
GIVES(int, plumb_world_light, pl_fail_absent(world, __func__, "a ray of light", "light") == PLUMB_OK ? 0 : -1,
      plumb_world *world, const plumb_light_desc *desc, const plumb_query_filter *filter, plumb_light_segment *segments,
      int capacity, plumb_light_sum *sum)
#endif

#if !PL_HAS(CHARACTERS)
WANT(pl_characters_wanted)
RESERVE_DT(pl_characters_move)
WORLD(pl_characters_feet)
WORLD(pl_characters_undo)
GIVES(plumb_vec2, pl_character_up, plumb_v2(0, 0), const plumb_world *world, const pl_character *c, uint32_t row)
#endif

#if !PL_HAS(JOINTS)
const int pl_joint_class_count = 0; // no kind is one
const pl_joint_class *const pl_joint_classes[1] = { NULL };
FREE(pl_joints_free, pl_joints)
RESERVE(pl_joints_look)
RESERVE(pl_joints_plan)
RESERVE(pl_joints_measure_reserve)
WORLD(pl_assemblies_share)
WORLD_DT(pl_joints_finish)
GIVES(uint32_t, pl_joints_awake, 0, plumb_world *world)
GIVES(uint32_t, pl_joints_tied, 0, const plumb_world *world)
GIVES(bool, pl_joints_any_awake, false, const plumb_world *world)
GIVES(bool, pl_joints_changed, false, const plumb_world *world)
GIVES(bool, pl_joints_direct, false, const plumb_world *world)
GIVES(double, pl_joints_stored, 0, const plumb_world *world)
GIVES(double, pl_joint_stored, 0, const plumb_world *world, const pl_joint *joint)
GIVES(plumb_real, pl_joint_off, 0, const plumb_world *world, const pl_joint *joint)
GIVES(plumb_real, pl_joint_motor_rate, 0, const plumb_world *world, const pl_joint *joint)
GIVES(plumb_real, plumb_joint_rate, (pl_fail_handle(world, __func__, "joint", joint.entity, "a live joint"), 0),
      const plumb_world *world, plumb_joint joint)
GIVES(plumb_vec2, pl_joint_anchor, plumb_v2(0, 0), const plumb_world *world, const pl_joint_end *end)
GIVES(uint32_t, pl_joint_eighth, 0, const plumb_world *world, uint32_t row)
GIVES(uint32_t, pl_joint_variant, 0, const plumb_joint_desc *desc)
GIVES(pl_joint_context, pl_joint_context_of, (pl_joint_context){ .world = world }, plumb_world *world,
      uint32_t cluster, pl_tasks *tasks, uint32_t thread, real h, real soft)
VOID(pl_joint_begin, const plumb_world *world, pl_joint *joint)
VOID(pl_joints_prepare, const pl_joint_context *context)
VOID(pl_joints_strike, const pl_joint_context *context)
VOID(pl_joints_warm_start, const pl_joint_context *context)
VOID(pl_joints_solve, const pl_joint_context *context, pl_joint_sweep sweep, bool first)
VOID(pl_joints_store, const pl_joint_context *context)
VOID(pl_joints_move, const pl_joint_context *context, real share)
VOID(pl_joints_tally, const pl_joint_context *context)
VOID(pl_joints_keep, const pl_joint_context *context, uint32_t thread)
VOID(pl_joints_measure, const pl_joint_context *context, pl_measuring *m)
VOID(pl_joints_errors, const plumb_world *world, plumb_measures *m)
#endif

#if !PL_HAS(PGS)
ROW(pl_classic_prepare)
ROW(pl_classic_integrate)
ROW(pl_classic_warm_start)
ROW(pl_classic_impacts)
ROW(pl_classic_contacts)
ROW(pl_classic_correct)
ROW(pl_joints_row_correct)
ROW(pl_classic_sum)
ROW(pl_classic_store)
#endif

#if !PL_HAS(EXACT)
ROW(pl_exact_warm_start_joints)
ROW(pl_exact_warm_start)
ROW(pl_exact_pull)
ROW(pl_exact_relax)
RESERVE(pl_exact_plan)
WORLD(pl_exact_tell)
WORLD(pl_hard_look)
WORLD(pl_hard_note)
FREE(pl_exact_free, pl_exact_solver)
#endif

#if !PL_HAS(MEASURES)
WANT(pl_want_measures)
WANT(pl_want_residuals)
PASS(pl_run_measure_open)
PASS(pl_run_measure_bodies)
PASS(pl_run_measure_close)
ROW(pl_measure_row)
ROW(pl_measure_before_row)
ROW(pl_measure_after_row)
VOID(pl_measure_before, plumb_world *world, pl_once_fn *run)
VOID(pl_measure_after, plumb_world *world, pl_once_fn *run, plumb_real dt)
FREE(pl_measure_free, pl_measure)
#define MEASURES_CONTACTS(fn)                                                                      \
    VOID(fn, const pl_contact_call *call, uint32_t first, uint32_t count, const struct pl_measuring *m)
#define MEASURES_JOINTS(fn) VOID(fn, const pl_joint_call *call, const struct pl_measuring *m)
WIDTHS(MEASURES_CONTACTS, pl_contact_measure)
WIDTHS(MEASURES_CONTACTS, pl_contact_residual)
WIDTHS(MEASURES_JOINTS, pl_joint_measure)
#endif

#if !PL_HAS(TOLERANCE)
WORLD(pl_dial_reset)
WORLD_DT(pl_dial_begin)
WORLD(pl_dial_apply)
GIVES(bool, pl_dial_look, false, plumb_world *world, plumb_real dt)
#endif

#if !PL_HAS(WATCHDOG)
WANT(pl_want_watchdog)
PASS(pl_run_watch)
PASS(pl_run_watchdog)
VOID(pl_watchdog_before, plumb_world *world, pl_doing doing)
VOID(pl_watchdog_after, plumb_world *world, pl_doing doing, const char *pass, uint32_t system, plumb_real dt)
VOID(pl_watchdog_forget, pl_watchdog *dog)
FREE(pl_watchdog_free, pl_watchdog)
#endif

// clang-format on

#pragma GCC diagnostic pop
