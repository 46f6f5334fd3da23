/// engine_lint_motion.c - lint: what moves too fast for the step, and springs that are too stiff for the substep.
#include "engine_lint.h"

#include <math.h>

/// [-] of the substep rate: springs up to there move as the oscillator does (plumb/joint.h).
static const double SPRING = 0.09;
/// [rad] of a small swing of a dipole in a substep: from 2 on it gains energy.
static const double NEEDLE = 1;

/// Whether some shape of one may meet some of the other.
static bool may_meet(const lint_job *job, plumb_body a, plumb_body b)
{
    plumb_shape *list;
    plumb_filter filters[16];
    const int of_a = pl_lint_shapes_of(job, a, &list), kept = of_a < 16 ? of_a : 16;
    for (int i = 0; i < kept; i++) {
        filters[i] = plumb_shape_filter(job->world, list[i]);
    }
    const int of_b = pl_lint_shapes_of(job, b, &list);
    bool meet = of_a > kept;
    for (int k = 0; k < of_b && !meet; k++) {
        for (int i = 0; i < kept && !meet; i++) {
            meet = plumb_filters_meet(filters[i], plumb_shape_filter(job->world, list[k]));
        }
    }
    return meet && !plumb_world_is_excluded(job->world, a, b);
}

/// [m/s]
static double speed_of(const lint_job *job, plumb_body body)
{
    const plumb_vec2 v = plumb_body_velocity(job->world, body);
    return hypot((double)v.x, (double)v.y);
}

/// [m] that a body moves in a step, as seen from another one.
static double way_past(const lint_job *job, plumb_body body, plumb_body other)
{
    const plumb_vec2 v = plumb_body_velocity(job->world, body);
    const plumb_vec2 u = plumb_body_velocity(job->world, other);
    return hypot((double)v.x - (double)u.x, (double)v.y - (double)u.y) * job->dt;
}

/// The thinnest solid body that this one, `own` thick, passes by farther in a step than both are thick, is dynamic or not as
/// told, and does not ask for sweeps; null: none. Of two that are dynamic the faster one passes, or the first.
static plumb_body thinnest(const lint_job *job, int self, bool dynamic, double own, double *thick)
{
    const plumb_body body = pl_lint_body_at(job, self);
    const double speed = speed_of(job, body);
    plumb_body found = { 0 };
    *thick = HUGE_VAL;
    for (int i = 0; i < pl_lint_body_count(job); i++) {
        const plumb_body other = pl_lint_body_at(job, i);
        const double way = way_past(job, body, other);
        if (i == self || !(way > own) || pl_lint_is_dynamic(job, other) != dynamic ||
            !plumb_body_is_enabled(job->world, other) ||
            plumb_body_is_continuous(job->world, other)) {
            continue;
        }
        const double theirs = speed_of(job, other);
        const bool passes = !dynamic || speed > theirs || (speed >= theirs && self < i);
        const double t = passes ? pl_lint_thickness(job, other) : -1;
        if (t >= 0 && t < fmin(way - own, *thick) && may_meet(job, body, other)) {
            found = other;
            *thick = t;
        }
    }
    return found;
}

/// [m/s] of the fastest body that is not dynamic.
static double fastest_driven(const lint_job *job)
{
    double most = 0;
    for (int i = 0; i < pl_lint_body_count(job); i++) {
        const plumb_body body = pl_lint_body_at(job, i);
        most = pl_lint_is_dynamic(job, body) ? most : fmax(most, speed_of(job, body));
    }
    return most;
}

void pl_lint_speeds(lint_job *job)
{
    const double driven = job->desc.no_continuous ? fastest_driven(job) : 0;
    for (int i = 0; i < pl_lint_body_count(job); i++) {
        const plumb_body body = pl_lint_body_at(job, i);
        if (!pl_lint_is_dynamic(job, body) || plumb_body_is_continuous(job->world, body)) {
            continue;
        }
        const double speed = speed_of(job, body);
        double thick = 0;
        const double own = speed + driven > 0 ? pl_lint_thickness(job, body) : -1;
        if (own < 0 || (speed + fmax(speed, driven)) * job->dt <= own) {
            continue;
        }
        plumb_body other = thinnest(job, i, true, own, &thick);
        if (plumb_is_null(other) && job->desc.no_continuous) {
            other = thinnest(job, i, false, own, &thick);
        }
        if (!plumb_is_null(other)) {
            pl_lint_tell(
                job, "'%s' goes %.3g m in a step, seen from '%s'; they are %.3g m thick together",
                pl_lint_name_of(job, body), way_past(job, body, other), pl_lint_name_of(job, other),
                own + thick);
        }
    }
}

/// [1/s] of the spring of a joint by what it moves; 0: it has none.
static double frequency(const lint_job *job, const plumb_joint_desc *d)
{
    if (d->hertz > 0 || !(d->stiffness > 0)) {
        return (double)d->hertz;
    }
    const bool turns = d->kind == PLUMB_REVOLUTE || d->kind == PLUMB_WELD;
    const plumb_body ends[2] = { d->body_a, d->body_b };
    double inverse = 0;
    for (int i = 0; i < 2; i++) {
        const double m = !pl_lint_is_dynamic(job, ends[i]) ? 0
                         : turns ? (double)plumb_body_inertia(job->world, ends[i])
                                 : (double)plumb_body_mass(job->world, ends[i]);
        inverse += m > 0 ? 1 / m : 0;
    }
    return sqrt((double)d->stiffness * inverse) / (2 * 3.14159265358979323846);
}

/// [rad/s] by which a small swing of a dipole goes where it is, in the field of all others; the world is a copy.
static double swing(const lint_job *job, plumb_body body)
{
    const plumb_real moment = plumb_body_dipole(job->world, body);
    const double inertia = (double)plumb_body_inertia(job->world, body);
    const plumb_vec2 at = plumb_body_center(job->world, body), none = { 0, 0 };
    plumb_body_set_dipole(job->world, body, 0);
    const plumb_vec2 with = plumb_world_law_at(job->world, at, none, 1);
    const plumb_vec2 without = plumb_world_law_at(job->world, at, none, 0);
    plumb_body_set_dipole(job->world, body, moment);
    const double field =
        hypot((double)with.x - (double)without.x, (double)with.y - (double)without.y);
    return inertia > 0 ? sqrt(fabs((double)moment) * field / inertia) : 0;
}

/// What of a dipole is a spring: the field that it points along.
static void look_at_dipoles(lint_job *job)
{
    for (int i = 0; i < pl_lint_body_count(job); i++) {
        const plumb_body body = pl_lint_body_at(job, i);
        if (!pl_lint_is_dynamic(job, body) || plumb_body_dipole(job->world, body) == 0) {
            continue;
        }
        const double w = swing(job, body);
        if (w > NEEDLE * job->rate * (1 + LINT_SLACK)) {
            pl_lint_tell(
                job,
                "the dipole of '%s' swings at %.3g rad/s; %.3g substeps a second follow up "
                "to %.3g rad/s",
                pl_lint_name_of(job, body), w, job->rate, NEEDLE * job->rate);
        }
    }
}

void pl_lint_springs(lint_job *job)
{
    look_at_dipoles(job);
    for (int i = 0; i < scene_joint_count(job->scene); i++) {
        const scene_joint j = scene_joint_get(job->scene, i);
        plumb_joint_desc d;
        if (plumb_joint_settings(job->world, j.entity, &d) != PLUMB_OK || d.disabled) {
            continue;
        }
        const double hertz = frequency(job, &d);
        if (hertz > SPRING * job->rate * (1 + LINT_SLACK)) {
            pl_lint_tell(
                job,
                "the spring of '%s' is of %.3g Hz; %.3g substeps a second follow up to %.3g Hz",
                j.name, hertz, job->rate, SPRING * job->rate);
        }
    }
}
