/// engine_lint_settings.c - lint: settings that act on nothing or give energy, and numbers that look like those of other units.
#include "engine_lint.h"

#include <math.h>

/// [m] thicknesses that are measured: assets/scenes/hard/size_*.lua, 1 cm sinks, 2 cm and 100 m stand.
static const double THINNEST = 0.02, THICKEST = 100;
/// [-] of a body's thickness that its place may be rounded by.
static const double ROUNDED = 0.01;

/// Settings of a body that does not move by itself.
static void look_at_still(lint_job *job, plumb_body body)
{
    const plumb_world *w = job->world;
    const char *what =
        plumb_body_damping(w, body) > 0 || plumb_body_angular_damping(w, body) > 0 ? "damping"
        : plumb_body_max_speed(w, body) > 0 || plumb_body_max_spin(w, body) > 0    ? "a speed cap"
        : plumb_body_drag(w, body) > 0                                             ? "drag"
        : plumb_body_thrust(w, body) > 0                                           ? "thrust"
        : plumb_body_heating(w, body) != 0                                         ? "heating"
        : plumb_body_melting_point(w, body) > 0  ? "a melting point"
        : plumb_body_ignition(w, body) > 0       ? "an ignition temperature"
        : plumb_body_gravity_scale(w, body) != 1 ? "a gravity scale"
                                                 : NULL;
    if (what != NULL) {
        pl_lint_tell(job, "'%s' has %s and is not dynamic", pl_lint_name_of(job, body), what);
    }
}

/// A surface that runs draws by its friction alone.
static void look_at_running(lint_job *job, plumb_body body)
{
    plumb_shape *list;
    bool idle = false;
    const int count = pl_lint_shapes_of(job, body, &list);
    for (int i = 0; i < count && !idle; i++) {
        plumb_material_desc m;
        idle = plumb_material_settings(job->world, plumb_shape_material(job->world, list[i]), &m) ==
                   PLUMB_OK &&
               m.surface_speed != 0 && m.frictionless;
    }
    if (idle) {
        pl_lint_tell(job, "a surface of '%s' runs and has no friction", pl_lint_name_of(job, body));
    }
}

/// What is above the friction of what sticks counts as that.
static void look_at_sliding(lint_job *job, plumb_body body)
{
    plumb_shape *list;
    const int count = pl_lint_shapes_of(job, body, &list);
    for (int i = 0; i < count; i++) {
        plumb_material_desc m;
        if (plumb_material_settings(job->world, plumb_shape_material(job->world, list[i]), &m) ==
                PLUMB_OK &&
            m.kinetic_friction > m.friction) {
            pl_lint_tell(
                job, "a surface of '%s' has a kinetic friction of %g, above its friction of %g",
                pl_lint_name_of(job, body), (double)m.kinetic_friction, (double)m.friction);
            return;
        }
    }
}

/// Whether some law turns dipoles.
static bool has_law_on_charge(const plumb_world *world)
{
    plumb_law laws[64];
    plumb_law_desc d;
    const int count = plumb_world_laws(world, laws, 64);
    bool any = count > 64;
    for (int i = 0; i < count && !any; i++) {
        any = plumb_law_settings(world, laws[i], &d) == PLUMB_OK && d.hold == PLUMB_LAW_ON_CHARGE &&
              d.kind != PLUMB_LAW_MAGNETIC;
    }
    return any;
}

void pl_lint_effects(lint_job *job)
{
    const bool turns = has_law_on_charge(job->world);
    for (int i = 0; i < pl_lint_body_count(job); i++) {
        const plumb_body body = pl_lint_body_at(job, i);
        look_at_running(job, body);
        look_at_sliding(job, body);
        if (plumb_body_dipole(job->world, body) != 0 && !turns) {
            pl_lint_tell(job, "'%s' has a dipole, and no law on charge acts on it",
                         pl_lint_name_of(job, body));
        }
        if (plumb_body_get_type(job->world, body) != PLUMB_DYNAMIC) {
            look_at_still(job, body);
        }
    }
    for (int i = 0; i < scene_joint_count(job->scene); i++) {
        const scene_joint j = scene_joint_get(job->scene, i);
        plumb_joint_desc d;
        if (plumb_joint_settings(job->world, j.entity, &d) != PLUMB_OK || d.disabled) {
            continue;
        }
        const bool enabled =
            (plumb_is_null(d.body_a) || plumb_body_is_enabled(job->world, d.body_a)) &&
            (plumb_is_null(d.body_b) || plumb_body_is_enabled(job->world, d.body_b));
        if (enabled && !pl_lint_is_dynamic(job, d.body_a) && !pl_lint_is_dynamic(job, d.body_b)) {
            pl_lint_tell(job, "'%s' joins '%s' and '%s', neither of which is dynamic", j.name,
                         pl_lint_name_of(job, d.body_a), pl_lint_name_of(job, d.body_b));
        }
        if (d.enable_motor && !(d.max_motor > 0)) {
            pl_lint_tell(job, "the motor of '%s' has no force", j.name);
        }
    }
}

void pl_lint_gains(lint_job *job)
{
    for (int i = 0; i < pl_lint_body_count(job); i++) {
        const plumb_body body = pl_lint_body_at(job, i);
        plumb_shape *list = NULL;
        const int count = pl_lint_shapes_of(job, body, &list);
        for (int k = 0; k < count; k++) {
            plumb_material_desc m;
            if (plumb_material_settings(job->world, plumb_shape_material(job->world, list[k]),
                                        &m) == PLUMB_OK &&
                m.restitution > 1) {
                pl_lint_tell(job, "'%s' has a restitution of %.3g", pl_lint_name_of(job, body),
                             (double)m.restitution);
                break;
            }
        }
    }
}

void pl_lint_sizes(lint_job *job)
{
    for (int i = 0; i < pl_lint_body_count(job); i++) {
        const plumb_body body = pl_lint_body_at(job, i);
        const double thick = pl_lint_is_dynamic(job, body) ? pl_lint_thickness(job, body) : -1;
        const plumb_vec2 at = plumb_body_center(job->world, body);
        const double rounding =
            (double)PLUMB_REAL_EPSILON * fmax(fabs((double)at.x), fabs((double)at.y));
        if (thick <= 0) {
            continue;
        }
        if (thick < THINNEST * (1 - LINT_SLACK) || thick > THICKEST * (1 + LINT_SLACK)) {
            pl_lint_tell(job, "'%s' is %.3g m thick; %g m to %g m is what is measured",
                         pl_lint_name_of(job, body), thick, THINNEST, THICKEST);
        }
        if (rounding > ROUNDED * thick) {
            pl_lint_tell(
                job,
                "'%s', %.3g m thick, is so far from the origin that places are rounded to %.3g m",
                pl_lint_name_of(job, body), thick, rounding);
        }
    }
}
