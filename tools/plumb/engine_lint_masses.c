/// engine_lint_masses.c - lint: bodies that rest on, hang from or turn with much lighter ones.
#include "engine_lint.h"

#include <math.h>

/// [-] a body that rests on, or hangs from, one so much lighter sinks in at 240 substeps a second; the bound grows with the square of
/// their rate. assets/scenes/hard/mass_pairs.lua: 10 : 1 stands at 240, 100 : 1 at 960, 10,000 : 1 at 3,840.
static const double RATIO = 30, RATIO_RATE = 240;
/// [-] moments of inertia of all that is welded to a body, or turned by motors on it, about it, over its own. A rotor of 3 to 6 arms
/// on a driven hub turns evenly at 17 : 1 and makes energy at 22 : 1, of 1 or 2 arms at 50 : 1 and 87 : 1; more substeps do not help.
static const double INERTIA = 20, INERTIA_FEW = 60;
enum { FEW_ARMS = 2, MOST_ARMS = 64 };

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
    if (!pl_lint_is_dynamic(job, a) || !pl_lint_is_dynamic(job, b)) {
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
    pl_lint_tell(job, "'%s' (%.3g kg) %s '%s' (%.3g kg): %.3g : 1, holds up to %.3g : 1",
                 pl_lint_name_of(job, pair[0]), heavy, how, pl_lint_name_of(job, pair[1]), light,
                 heavy / light, most_ratio(job));
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
    if (!(welds || drives) || !pl_lint_is_dynamic(job, other)) {
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
        pl_lint_tell(
            job,
            "'%s' (%.3g kg m^2) turns %d %s of %.3g kg m^2 about it, by welds or motors: %.3g : 1, "
            "holds up to %.3g : 1",
            pl_lint_name_of(job, hub), own, arms, arms == 1 ? "body" : "bodies", sum, sum / own,
            most);
    }
}

void pl_lint_masses(lint_job *job)
{
    const engine_stage *stage = &job->session->stage;
    if (job->desc.tolerance > 0 || job->desc.solver == PLUMB_SOLVER_EXACT) {
        return;
    }
    for (int i = 0; i < pl_lint_body_count(job) && !job->desc.direct_joints; i++) {
        if (pl_lint_is_dynamic(job, pl_lint_body_at(job, i))) {
            look_at_hub(job, pl_lint_body_at(job, i));
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
