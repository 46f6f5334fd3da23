// joints.c - joints that have come apart.
//
// Each joint is looked at in every fourth step: its rows are made once more for that, which costs as much as all else of the
// watchdog. Reads: joints, poses as the step ended. Writes: nothing but its own. Cost: O(joints).
#include "watchdog/watchdog.h"

#include "joints/measure.h"
#include "plumb/math.h"
#include "world/joint_list.h"

#define EVERY   4    // [steps] from one look at a joint to the next
#define STEPS   3    // looks in a row at which it must have been apart and not come together
#define NEARING 0.01 // [-] of the gap, by which it comes together

// [m] of the smaller body: as far as it or its anchor reaches.
static double size_of(const plumb_world *world, const pl_joint *j)
{
    const pl_bodies *b = &world->bodies;
    const pl_joint_end *ends[] = { &j->a, &j->b };
    double least = HUGE_VAL;
    for (int i = 0; i < 2; ++i) {
        const uint32_t row = pl_joint_row(world, ends[i]);
        if (row < world->dynamic_count) {
            const plumb_vec2 arm =
                plumb_vec2_sub(ends[i]->local, plumb_v2(b->local_x[row], b->local_y[row]));
            least =
                pl_less(least, pl_more((double)b->extent[row], (double)plumb_vec2_magnitude(arm)));
        }
    }
    return pl_more(least, (double)j->desc.length);
}

// Whether it drives by a bounded force or torque: then it lags behind its target as it is meant to.
static bool may_lag(const plumb_joint_desc *d)
{
    return (d->kind == PLUMB_MOTOR || d->kind == PLUMB_MOUSE) &&
           (d->max_force > 0 || d->max_torque > 0);
}

static void look_at(plumb_world *world, const pl_joint *j)
{
    pl_watched *w = pl_watched_find(world, j->entity.entity);
    const double gap = pl_joint_off(world, j), size = size_of(world, j);
    const double share = size > 0 && size < HUGE_VAL ? gap / size : 0;
    const bool apart =
        share > pl_watchdog_bound(PLUMB_ALARM_TORN_JOINT) && gap > w->depth * (1 - NEARING);
    w->deepening = apart ? w->deepening + 1 : 0;
    w->depth = gap;
    if (w->deepening >= STEPS) {
        const uint32_t a = pl_joint_row(world, &j->a), b = pl_joint_row(world, &j->b);
        pl_watchdog_tell(world, &(pl_finding){ .kind = PLUMB_ALARM_TORN_JOINT,
                                               .row = b != PL_NONE ? b : a,
                                               .other = b != PL_NONE ? a : PL_NONE,
                                               .joint = j,
                                               .value = share,
                                               .pass = pl_watchdog_solver(world) });
    }
}

void pl_watch_joints(plumb_world *world, real dt)
{
    (void)dt;
    for (uint32_t i = 0; world->joints.live > 0 && i < world->joints.awake_count; ++i) {
        const pl_joint *j = pl_joint_awake(&world->joints, i);
        if ((world->step_count + j->entity.entity.index) % EVERY != 0) {
            continue;
        }
        if (!plumb_is_null(j->entity) && !j->desc.disabled &&
            !may_lag(&j->desc)) { // else it broke in this step
            look_at(world, j);
        }
    }
}
