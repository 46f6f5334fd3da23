/// engine_lint.c - what of a scene, as it begins, is likely to go wrong, and what to do about it. Compiled once for each
/// precision, as engine.c.
///
/// Rules are rows of one table, lint.h. A rule reads a copy of the scene's
/// world by the public interface and changes nothing. Bounds are those up to which the engine was measured; the constants
/// say where. What a scene does on purpose it allows in a line of its own: `-- lint: allow RULE: why` (lint.c).
///
/// Cost: O(bodies + shapes + joints + contacts), O(contacts of unequal bodies x contacts), O(fast bodies x bodies), O(shapes x different filters).
#include "engine_session.h"
#include "lint.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/// [-] a body that rests on, or hangs from, one so much lighter sinks in at 240 substeps a second; the bound grows with the square of
/// their rate. assets/scenes/hard/mass_pairs.lua: 10 : 1 stands at 240, 100 : 1 at 960, 10,000 : 1 at 3,840.
static const double RATIO = 30, RATIO_RATE = 240;
/// [-] moments of inertia of all that is welded to a body, or turned by motors on it, about it, over its own. A rotor of 3 to 6 arms
/// on a driven hub turns evenly at 17 : 1 and makes energy at 22 : 1, of 1 or 2 arms at 50 : 1 and 87 : 1; more substeps do not help.
static const double INERTIA = 20, INERTIA_FEW = 60;
enum { FEW_ARMS = 2, MOST_ARMS = 64 };
/// [-] of the substep rate: springs up to there move as the oscillator does (plumb/joint.h).
static const double SPRING = 0.09;
/// [m] thicknesses that are measured: assets/scenes/hard/size_*.lua, 1 cm sinks, 2 cm and 100 m stand.
static const double THINNEST = 0.02, THICKEST = 100;
/// [-] what is rounded in those bounds.
static const double SLACK = 1e-3;
/// [-] of a body's thickness that its place may be rounded by.
static const double ROUNDED = 0.01;

typedef struct lint_job {
    engine_session *session;
    const scene *scene;
    plumb_world *world; ///< a copy with its contacts
    plumb_world_desc desc;
    const char *rule;
    double dt, rate; ///< [s] step, [1/s] substeps
    int found;
    bool failed; ///< out of memory
} lint_job;

typedef struct lint_rule {
    const char *name, *advice;
    void (*look)(lint_job *job);
} lint_rule;

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void
tell(lint_job *job, const char *format, ...)
{
    engine_session *s = job->session;
    if (!pl_session_reserve(&s->findings, &s->finding_room, job->found + 1, sizeof *s->findings)) {
        job->failed = true;
        return;
    }
    engine_finding *made = &s->findings[job->found++];
    *made = (engine_finding){ .rule = job->rule };
    va_list list;
    va_start(list, format);
    vsnprintf(made->text, sizeof made->text, format, list);
    va_end(list);
}

//---- what is asked of bodies -----------------------------------------------------------------------

static int body_count(const lint_job *job)
{
    return scene_body_count(job->scene);
}

static plumb_body body_at(const lint_job *job, int i)
{
    return scene_body_get(job->scene, i).entity;
}

static const char *name_of(const lint_job *job, plumb_body body)
{
    return plumb_is_null(body) ? "the world" : scene_body_of(job->scene, body).name;
}

static bool is_dynamic(const lint_job *job, plumb_body body)
{
    return !plumb_is_null(body) && plumb_body_is_enabled(job->world, body) &&
           plumb_body_get_type(job->world, body) == PLUMB_DYNAMIC;
}

/// [m] across a convex piece where it is thinnest, its radius included. Lines have none.
static double width_of(const plumb_convex *c)
{
    double least = c->count > 2 ? HUGE_VAL : 0;
    for (int i = 0; i < c->count && c->count > 2; i++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int k = 0; k < c->count; k++) {
            const double d = (double)c->normals[i].x * (double)c->points[k].x +
                             (double)c->normals[i].y * (double)c->points[k].y;
            low = fmin(low, d);
            high = fmax(high, d);
        }
        least = fmin(least, high - low);
    }
    return least + 2 * (double)c->radius;
}

/// The shapes of a body; their number.
static int shapes_of(const lint_job *job, plumb_body body, plumb_shape **list)
{
    engine_stage *stage = &job->session->stage;
    const int count = plumb_body_shapes(job->world, body, NULL, 0);
    if (!pl_session_reserve(&stage->shapes, &stage->shape_room, count, sizeof *stage->shapes)) {
        return 0;
    }
    *list = stage->shapes;
    return plumb_body_shapes(job->world, body, stage->shapes, count);
}

/// [m] of the thickest piece of a body that is solid; -1: none is.
static double thickness(const lint_job *job, plumb_body body)
{
    plumb_shape *list;
    double most = -1;
    const int count = shapes_of(job, body, &list);
    for (int i = 0; i < count; i++) {
        const int pieces = plumb_shape_is_sensor(job->world, list[i])
                               ? 0
                               : plumb_shape_piece_count(job->world, list[i]);
        for (int p = 0; p < pieces; p++) {
            plumb_convex piece;
            if (plumb_shape_piece(job->world, list[i], p, &piece, NULL) == PLUMB_OK) {
                most = fmax(most, width_of(&piece));
            }
        }
    }
    return most;
}

/// Whether some shape of one may meet some of the other.
static bool may_meet(const lint_job *job, plumb_body a, plumb_body b)
{
    plumb_shape *list;
    plumb_filter filters[16];
    const int of_a = shapes_of(job, a, &list), kept = of_a < 16 ? of_a : 16;
    for (int i = 0; i < kept; i++) {
        filters[i] = plumb_shape_filter(job->world, list[i]);
    }
    const int of_b = shapes_of(job, b, &list);
    bool meet = of_a > kept;
    for (int k = 0; k < of_b && !meet; k++) {
        for (int i = 0; i < kept && !meet; i++) {
            meet = plumb_filters_meet(filters[i], plumb_shape_filter(job->world, list[k]));
        }
    }
    return meet && !plumb_world_is_excluded(job->world, a, b);
}

//---- the rules -------------------------------------------------------------------------------------

static double most_ratio(const lint_job *job)
{
    const double rate = job->rate / RATIO_RATE;
    return fmax(RATIO * rate * rate, 1);
}

/// The heavier of two dynamic bodies and the lighter; false: they are not two of too different masses, where the heavier has so
/// many that bear it.
static bool are_unequal(const lint_job *job, plumb_body a, plumb_body b, int shares,
                        plumb_body pair[2])
{
    if (!is_dynamic(job, a) || !is_dynamic(job, b)) {
        return false;
    }
    const double mass[2] = { (double)plumb_body_mass(job->world, a),
                             (double)plumb_body_mass(job->world, b) };
    pair[0] = mass[0] > mass[1] ? a : b;
    pair[1] = mass[0] > mass[1] ? b : a;
    return fmax(mass[0], mass[1]) > shares * most_ratio(job) * fmin(mass[0], mass[1]);
}

static void tell_masses(lint_job *job, const plumb_body pair[2], const char *how)
{
    const double heavy = (double)plumb_body_mass(job->world, pair[0]);
    const double light = (double)plumb_body_mass(job->world, pair[1]);
    tell(job, "'%s' (%.3g kg) %s '%s' (%.3g kg): %.3g : 1, holds up to %.3g : 1",
         name_of(job, pair[0]), heavy, how, name_of(job, pair[1]), light, heavy / light,
         most_ratio(job));
}

/// Whether `upper` lies above `lower` by more than to its side, as gravity goes.
static bool is_above(const lint_job *job, plumb_body upper, plumb_body lower)
{
    const plumb_vec2 g = plumb_world_gravity(job->world);
    const plumb_vec2 u = plumb_body_center(job->world, upper),
                     l = plumb_body_center(job->world, lower);
    const double x = (double)u.x - (double)l.x, y = (double)u.y - (double)l.y;
    const double up = -(x * (double)g.x + y * (double)g.y);
    return up > 0 &&
           2 * up * up > (x * x + y * y) * ((double)g.x * (double)g.x + (double)g.y * (double)g.y);
}

/// Whether a contact bears the body: by its normal, as gravity goes.
static bool bears(const lint_job *job, const plumb_contact *c, plumb_body body)
{
    const plumb_vec2 g = plumb_world_gravity(job->world);
    const double down = (double)c->normal.x * (double)g.x + (double)c->normal.y * (double)g.y;
    const double up = plumb_same(c->body_b, body) ? -down : plumb_same(c->body_a, body) ? down : 0;
    return up > 0.7 * hypot((double)g.x, (double)g.y);
}

static int supports_of(const lint_job *job, int contacts, plumb_body body)
{
    int count = 0;
    for (int i = 0; i < contacts; i++) {
        count += bears(job, &job->session->stage.contacts[i], body);
    }
    return count;
}

/// [kg m^2] of what a joint makes turn with a body, about it: across a weld about its centre, across a motor about the
/// anchor; 0: nothing.
static double turned_inertia(const lint_job *job, plumb_joint joint, const plumb_joint_desc *d,
                             plumb_body body)
{
    const bool welds = d->kind == PLUMB_WELD && !(d->hertz > 0) && !(d->stiffness > 0);
    const bool drives = d->kind == PLUMB_REVOLUTE && d->enable_motor && d->max_motor > 0;
    const plumb_body other = plumb_same(d->body_a, body) ? d->body_b : d->body_a;
    if (!(welds || drives) || !is_dynamic(job, other)) {
        return 0;
    }
    const plumb_vec2 about =
        welds ? plumb_body_center(job->world, body) : plumb_joint_anchor_b(job->world, joint);
    const plumb_vec2 at = plumb_body_center(job->world, other);
    const double x = (double)at.x - (double)about.x, y = (double)at.y - (double)about.y;
    return (double)plumb_body_inertia(job->world, other) +
           (double)plumb_body_mass(job->world, other) * (x * x + y * y);
}

/// A light hub between heavy arms, or between one and the world. Who is at the end of a chain is only carried.
static void look_at_hub(lint_job *job, plumb_body hub)
{
    plumb_joint joints[MOST_ARMS];
    const int all = plumb_body_joints(job->world, hub, joints, MOST_ARMS);
    const double own = (double)plumb_body_inertia(job->world, hub);
    double sum = 0;
    int ties = 0, arms = 0;
    for (int i = 0; i < all && i < MOST_ARMS && own > 0; i++) {
        plumb_joint_desc d;
        if (plumb_joint_settings(job->world, joints[i], &d) == PLUMB_OK && !d.disabled &&
            (d.kind == PLUMB_WELD || d.kind == PLUMB_REVOLUTE)) {
            const double inertia = turned_inertia(job, joints[i], &d, hub);
            sum += inertia;
            arms += inertia > 0;
            ties++;
        }
    }
    const double most = arms > FEW_ARMS ? INERTIA : INERTIA_FEW;
    if (ties > 1 && sum > most * own) {
        tell(
            job,
            "'%s' (%.3g kg m^2) turns %d %s of %.3g kg m^2 about it, by welds or motors: %.3g : 1, "
            "holds up to %.3g : 1",
            name_of(job, hub), own, arms, arms == 1 ? "body" : "bodies", sum, sum / own, most);
    }
}

static void look_at_masses(lint_job *job)
{
    const engine_stage *stage = &job->session->stage;
    if (job->desc.tolerance > 0 || job->desc.solver == PLUMB_SOLVER_EXACT) {
        return;
    }
    for (int i = 0; i < body_count(job) && !job->desc.direct_joints; i++) {
        if (is_dynamic(job, body_at(job, i))) {
            look_at_hub(job, body_at(job, i));
        }
    }
    const int contacts = plumb_world_contacts(job->world, NULL, 0);
    for (int i = 0; i < contacts; i++) {
        plumb_body pair[2];
        const plumb_contact *c = &stage->contacts[i];
        if (are_unequal(job, c->body_a, c->body_b, 1, pair) && bears(job, c, pair[0]) &&
            are_unequal(job, c->body_a, c->body_b, supports_of(job, contacts, pair[0]), pair)) {
            tell_masses(job, pair, "rests on");
        }
    }
    for (int i = 0; i < scene_joint_count(job->scene) && !job->desc.direct_joints; i++) {
        const scene_joint j = scene_joint_get(job->scene, i);
        plumb_joint_desc d;
        plumb_body pair[2];
        if (plumb_joint_settings(job->world, j.entity, &d) == PLUMB_OK && !d.disabled &&
            are_unequal(job, d.body_a, d.body_b, 1, pair) && !is_above(job, pair[0], pair[1])) {
            tell_masses(job, pair, "is joined to");
        }
    }
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
    const plumb_body body = body_at(job, self);
    const double speed = speed_of(job, body);
    plumb_body found = { 0 };
    *thick = HUGE_VAL;
    for (int i = 0; i < body_count(job); i++) {
        const plumb_body other = body_at(job, i);
        const double way = way_past(job, body, other);
        if (i == self || !(way > own) || is_dynamic(job, other) != dynamic ||
            !plumb_body_is_enabled(job->world, other) ||
            plumb_body_is_continuous(job->world, other)) {
            continue;
        }
        const double theirs = speed_of(job, other);
        const bool passes = !dynamic || speed > theirs || (speed >= theirs && self < i);
        const double t = passes ? thickness(job, other) : -1;
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
    for (int i = 0; i < body_count(job); i++) {
        const plumb_body body = body_at(job, i);
        most = is_dynamic(job, body) ? most : fmax(most, speed_of(job, body));
    }
    return most;
}

static void look_at_speeds(lint_job *job)
{
    const double driven = job->desc.no_continuous ? fastest_driven(job) : 0;
    for (int i = 0; i < body_count(job); i++) {
        const plumb_body body = body_at(job, i);
        if (!is_dynamic(job, body) || plumb_body_is_continuous(job->world, body)) {
            continue;
        }
        const double speed = speed_of(job, body);
        double thick = 0;
        const double own = speed + driven > 0 ? thickness(job, body) : -1;
        if (own < 0 || (speed + fmax(speed, driven)) * job->dt <= own) {
            continue;
        }
        plumb_body other = thinnest(job, i, true, own, &thick);
        if (plumb_is_null(other) && job->desc.no_continuous) {
            other = thinnest(job, i, false, own, &thick);
        }
        if (!plumb_is_null(other)) {
            tell(job, "'%s' goes %.3g m in a step, seen from '%s'; they are %.3g m thick together",
                 name_of(job, body), way_past(job, body, other), name_of(job, other), own + thick);
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
        const double m = !is_dynamic(job, ends[i]) ? 0
                         : turns                   ? (double)plumb_body_inertia(job->world, ends[i])
                                                   : (double)plumb_body_mass(job->world, ends[i]);
        inverse += m > 0 ? 1 / m : 0;
    }
    return sqrt((double)d->stiffness * inverse) / (2 * 3.14159265358979323846);
}

static void look_at_springs(lint_job *job)
{
    for (int i = 0; i < scene_joint_count(job->scene); i++) {
        const scene_joint j = scene_joint_get(job->scene, i);
        plumb_joint_desc d;
        if (plumb_joint_settings(job->world, j.entity, &d) != PLUMB_OK || d.disabled) {
            continue;
        }
        const double hertz = frequency(job, &d);
        if (hertz > SPRING * job->rate * (1 + SLACK)) {
            tell(job,
                 "the spring of '%s' is of %.3g Hz; %.3g substeps a second follow up to %.3g Hz",
                 j.name, hertz, job->rate, SPRING * job->rate);
        }
    }
}

/// Shapes of equal filters, on bodies that move or do not.
typedef struct filter_kind {
    plumb_filter filter;
    bool moves, several; ///< of several bodies
    plumb_body body;     ///< the first that has one
} filter_kind;

enum { FILTER_KINDS = 256 };

/// What meets everything, or nothing on purpose, says nothing of others.
static bool is_filtered(const plumb_filter *f)
{
    const bool meets_all =
        f->category <= 1 && (f->mask == 0 || f->mask == UINT64_MAX) && f->group == 0;
    return !meets_all && !f->nothing;
}

static bool are_equal(const plumb_filter *a, const plumb_filter *b)
{
    return a->category == b->category && a->mask == b->mask && a->group == b->group &&
           a->nothing == b->nothing;
}

/// Collects them; -1: there are too many to tell.
static int collect_filters(const lint_job *job, filter_kind *kinds)
{
    int count = 0;
    for (int i = 0; i < body_count(job); i++) {
        plumb_shape *list;
        const plumb_body body = body_at(job, i);
        const bool moves = plumb_body_get_type(job->world, body) != PLUMB_STATIC;
        const int shapes = shapes_of(job, body, &list);
        for (int s = 0; s < shapes; s++) {
            const plumb_filter f = plumb_shape_filter(job->world, list[s]);
            int k = 0;
            while (k < count && !(kinds[k].moves == moves && are_equal(&kinds[k].filter, &f))) {
                k++;
            }
            if (k == FILTER_KINDS) {
                return -1;
            }
            if (k == count) {
                kinds[count++] = (filter_kind){ .filter = f, .moves = moves, .body = body };
            }
            kinds[k].several |= !plumb_same(kinds[k].body, body);
        }
    }
    return count;
}

static bool meets_soft(const lint_job *job, const plumb_filter *filter)
{
    plumb_softbody all[256];
    const int count = plumb_world_softbodies(job->world, all, 256);
    bool meets = count > 256; // nobody looks through so many
    for (int i = 0; i < count && !meets; i++) {
        plumb_softbody_desc d;
        meets = plumb_softbody_get(job->world, all[i], &d) == PLUMB_OK &&
                plumb_filters_meet(*filter, d.filter);
    }
    return meets;
}

static void look_at_filters(lint_job *job)
{
    filter_kind kinds[FILTER_KINDS];
    const int count = collect_filters(job, kinds);
    for (int i = 0; i < count && body_count(job) > 1; i++) {
        // A group that is negative says that it is not to meet its own.
        bool meets = !is_filtered(&kinds[i].filter) || kinds[i].filter.group < 0;
        for (int k = 0; k < count && !meets; k++) {
            meets = (kinds[i].moves || kinds[k].moves) && (i != k || kinds[i].several) &&
                    plumb_filters_meet(kinds[i].filter, kinds[k].filter);
        }
        meets = meets || meets_soft(job, &kinds[i].filter);
        if (!meets) {
            tell(job,
                 "the filter of '%s' (category 0x%llx, mask 0x%llx) meets no shape of the scene",
                 name_of(job, kinds[i].body), (unsigned long long)kinds[i].filter.category,
                 (unsigned long long)kinds[i].filter.mask);
        }
    }
}

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
        tell(job, "'%s' has %s and is not dynamic", name_of(job, body), what);
    }
}

/// A surface that runs draws by its friction alone.
static void look_at_running(lint_job *job, plumb_body body)
{
    plumb_shape *list;
    bool idle = false;
    const int count = shapes_of(job, body, &list);
    for (int i = 0; i < count && !idle; i++) {
        plumb_material_desc m;
        idle = plumb_material_get(job->world, plumb_shape_material(job->world, list[i]), &m) ==
                   PLUMB_OK &&
               m.surface_speed != 0 && m.frictionless;
    }
    if (idle) {
        tell(job, "a surface of '%s' runs and has no friction", name_of(job, body));
    }
}

/// What is above the friction of what sticks counts as that.
static void look_at_sliding(lint_job *job, plumb_body body)
{
    plumb_shape *list;
    const int count = shapes_of(job, body, &list);
    for (int i = 0; i < count; i++) {
        plumb_material_desc m;
        if (plumb_material_get(job->world, plumb_shape_material(job->world, list[i]), &m) ==
                PLUMB_OK &&
            m.kinetic_friction > m.friction) {
            tell(job, "a surface of '%s' has a kinetic friction of %g, above its friction of %g",
                 name_of(job, body), (double)m.kinetic_friction, (double)m.friction);
            return;
        }
    }
}

static void look_at_effects(lint_job *job)
{
    for (int i = 0; i < body_count(job); i++) {
        const plumb_body body = body_at(job, i);
        look_at_running(job, body);
        look_at_sliding(job, body);
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
        if (enabled && !is_dynamic(job, d.body_a) && !is_dynamic(job, d.body_b)) {
            tell(job, "'%s' joins '%s' and '%s', neither of which is dynamic", j.name,
                 name_of(job, d.body_a), name_of(job, d.body_b));
        }
        if (d.enable_motor && !(d.max_motor > 0)) {
            tell(job, "the motor of '%s' has no force", j.name);
        }
    }
}

static void look_at_gains(lint_job *job)
{
    for (int i = 0; i < body_count(job); i++) {
        const plumb_body body = body_at(job, i);
        plumb_shape *list = NULL;
        const int count = shapes_of(job, body, &list);
        for (int k = 0; k < count; k++) {
            plumb_material_desc m;
            if (plumb_material_get(job->world, plumb_shape_material(job->world, list[k]), &m) ==
                    PLUMB_OK &&
                m.restitution > 1) {
                tell(job, "'%s' has a restitution of %.3g", name_of(job, body),
                     (double)m.restitution);
                break;
            }
        }
    }
}

static void look_at_overlaps(lint_job *job)
{
    const engine_overlap *list;
    const int count = pl_session_overlaps(job->session, &list);
    job->failed |= count < 0;
    for (int i = 0; i < count; i++) {
        tell(job, "'%s' and '%s' begin %.3g m inside one another", list[i].a, list[i].b,
             list[i].depth);
    }
}

static void look_at_sizes(lint_job *job)
{
    for (int i = 0; i < body_count(job); i++) {
        const plumb_body body = body_at(job, i);
        const double thick = is_dynamic(job, body) ? thickness(job, body) : -1;
        const plumb_vec2 at = plumb_body_center(job->world, body);
        const double rounding =
            (double)PLUMB_REAL_EPSILON * fmax(fabs((double)at.x), fabs((double)at.y));
        if (thick <= 0) {
            continue;
        }
        if (thick < THINNEST * (1 - SLACK) || thick > THICKEST * (1 + SLACK)) {
            tell(job, "'%s' is %.3g m thick; %g m to %g m is what is measured", name_of(job, body),
                 thick, THINNEST, THICKEST);
        }
        if (rounding > ROUNDED * thick) {
            tell(job,
                 "'%s', %.3g m thick, is so far from the origin that places are rounded to %.3g m",
                 name_of(job, body), thick, rounding);
        }
    }
}

//---- the table -------------------------------------------------------------------------------------

static const lint_rule rules[] = {
#define ROW(name, look, text, advice) { name, advice, look },
    LINT_RULES(ROW)
#undef ROW
};

enum { RULES = sizeof rules / sizeof rules[0] };

int pl_session_lint(engine_session *session, const engine_finding **list)
{
    engine_stage *stage = &session->stage;
    lint_job job = { .session = session,
                     .scene = stage->scene,
                     .world = pl_stage_refreshed(stage),
                     .desc = plumb_world_settings(stage->world),
                     .dt = stage->info.dt };
    job.rate = job.desc.substeps / job.dt;
    const int contacts = job.world != NULL ? plumb_world_contacts(job.world, NULL, 0) : 0;
    job.failed = job.world == NULL || !pl_session_reserve(&stage->contacts, &stage->contact_room,
                                                          contacts, sizeof *stage->contacts);
    if (!job.failed) {
        plumb_world_contacts(job.world, stage->contacts, contacts);
    }
    for (int i = 0; i < RULES && !job.failed; i++) {
        const int before = job.found;
        job.rule = rules[i].name;
        rules[i].look(&job);
        for (int k = before; k < job.found; k++) {
            session->findings[k].advice = rules[i].advice;
        }
    }
    plumb_world_destroy(job.world);
    *list = session->findings;
    return job.failed ? -1 : job.found;
}
