/// engine_lint_joints.c - lint: joints that were given no anchor, or one in other coordinates.
#include "engine_lint.h"

#include <math.h>

/// [-] of a body's diagonal. An anchor that far outside of both bodies is a lever that none of ours has, and a sway of a
/// hundredth of a radian moves the joint by a twentieth of the body.
static const double FAR = 5;

static bool has_one_anchor(plumb_joint_kind kind)
{
    return kind == PLUMB_REVOLUTE || kind == PLUMB_PRISMATIC || kind == PLUMB_WELD ||
           kind == PLUMB_WHEEL || kind == PLUMB_FRICTION;
}

/// [-] of the body's diagonal by which a point lies outside of its box.
static double diagonals_off(const lint_job *job, plumb_body body, plumb_vec2 p)
{
    const plumb_aabb box = plumb_body_aabb(job->world, body);
    const double size =
        hypot((double)box.max.x - (double)box.min.x, (double)box.max.y - (double)box.min.y);
    const double x =
        fmax(fmax((double)box.min.x - (double)p.x, (double)p.x - (double)box.max.x), 0);
    const double y =
        fmax(fmax((double)box.min.y - (double)p.y, (double)p.y - (double)box.max.y), 0);
    return size > 0 ? hypot(x, y) / size : 0;
}

void pl_lint_anchors(lint_job *job)
{
    for (int i = 0; i < scene_joint_count(job->scene); i++) {
        const scene_joint j = scene_joint_get(job->scene, i);
        plumb_joint_desc d;
        if (plumb_joint_settings(job->world, j.entity, &d) != PLUMB_OK || d.disabled ||
            !has_one_anchor(d.kind) || plumb_is_null(d.body_a) || plumb_is_null(d.body_b)) {
            continue; // a lever from the world is a pendulum
        }
        const plumb_vec2 at = plumb_joint_anchor_a(job->world, j.entity);
        const double least =
            fmin(diagonals_off(job, d.body_a, at), diagonals_off(job, d.body_b, at));
        if (least > FAR) {
            pl_lint_tell(job,
                         "'%s' holds '%s' and '%s' at {%.4g, %.4g}, %.3g times their size away",
                         j.name, pl_lint_name_of(job, d.body_a), pl_lint_name_of(job, d.body_b),
                         (double)at.x, (double)at.y, least);
        }
    }
}
