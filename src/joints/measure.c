// measure.c - joints while a world measures itself (step/measure.c): copies of impulses, what those solved one by one do,
// errors of rigid rows.
//
// Reads: joints, records. Writes: what is measured. Cost: O(joints) a call, on one thread.
#include "joints/measure.h"

#include "joints/one.h"
#include "world/measured.h"
#include "world/state.h"

#include <math.h>
#include <string.h>

bool pl_joints_measure_reserve(plumb_world *world)
{
    const pl_joint_plan *plan = &world->joints.plan;
    pl_measure *m = &world->measure;
    return pl_buffer_reserve(&world->memory, &m->records, plan->records.size) &&
           pl_buffer_reserve(&world->memory, &m->impulses,
                             (size_t)plan->order_count * PL_JOINT_ROWS * sizeof(real));
}

void pl_joints_keep(const pl_joint_context *c, uint32_t thread)
{
    const pl_joint_plan *plan = &c->world->joints.plan;
    const pl_measure *m = &c->world->measure;
    if (c->records != NULL) {
        memcpy((unsigned char *)m->records.data + thread * plan->room, c->records, plan->room);
    }
    real *impulses = m->impulses.data;
    for (uint32_t i = c->group->alone; i < c->group->end; ++i) {
        memcpy(impulses + (size_t)i * PL_JOINT_ROWS,
               pl_joint_grouped(&c->world->joints, i)->impulse, PL_JOINT_ROWS * sizeof(real));
    }
}

static void push_row(const pl_measuring *m, const pl_joint *j, const pl_row *r, double impulse,
                     plumb_work work)
{
    pl_measure_push(m, j->slot_a, (double)r->ax * impulse, (double)r->ay * impulse,
                    (double)r->aw * impulse, work);
    pl_measure_push(m, j->slot_b, (double)r->bx * impulse, (double)r->by * impulse,
                    (double)r->bw * impulse, work);
}

static void measure_lone(const pl_joint *j, const real *kept, const pl_measuring *m)
{
    for (int i = 0; i < j->rows.count; ++i) {
        const pl_row *r = &j->rows.row[i];
        const double impulse = (double)j->impulse[i] - (kept != NULL ? (double)kept[i] : 0);
        if (r->type != PL_ROW_OFF && impulse != 0) {
            push_row(m, j, r, impulse,
                     pl_joint_work(j->desc.kind, r->type, r->spring != PL_SPRING_NONE));
        }
    }
    if (m->debt == PL_DEBT_NONE) {
        return;
    }
    const bool open = m->debt == PL_DEBT_OPEN;
    const real *t = open ? j->turn : j->paid;
    const pl_row owed = { t[0], t[1], t[2], t[3], t[4], t[5], .type = PL_ROW_EQUAL };
    const pl_row *first = &j->rows.row[0];
    push_row(m, j, &owed, open ? -1 : 1,
             pl_joint_work(j->desc.kind, first->type, first->spring != PL_SPRING_NONE));
}

void pl_joints_measure(const pl_joint_context *c, pl_measuring *m)
{
    pl_joints_measure_lanes(c, m);
    const real *impulses = m->kept_impulses;
    for (uint32_t i = c->group->alone; i < c->group->end; ++i) {
        measure_lone(pl_joint_grouped(&c->world->joints, i),
                     impulses != NULL ? impulses + (size_t)i * PL_JOINT_ROWS : NULL, m);
    }
}

//---- errors --------------------------------------------------------------------------------------

static bool turns_alone(const pl_row *r)
{
    return r->ax == 0 && r->ay == 0 && r->bx == 0 && r->by == 0;
}

void pl_joints_errors(const plumb_world *world, plumb_measures *m)
{
    for (uint32_t i = 0; i < world->joints.awake_count; ++i) {
        pl_joint now = *pl_joint_awake(&world->joints, i);
        if (plumb_is_null(now.entity) || now.desc.disabled) {
            continue; // it broke in this step
        }
        pl_joint_begin(world, &now);
        pl_joint_classes[now.desc.kind]->rows(&now, &now.pose_a, &now.pose_b, &now.rows);
        for (int k = 0; k < now.rows.count; ++k) {
            const pl_row *r = &now.rows.row[k];
            if (pl_row_is_rigid(r)) {
                pl_measure_most(turns_alone(r) ? &m->joint_angle : &m->joint_length,
                                fabs((double)r->error));
            }
        }
    }
}

real pl_joint_off(const plumb_world *world, const pl_joint *j)
{
    pl_joint now = *j;
    pl_rows rows = { .count = 0 };
    pl_joint_begin(world, &now);
    pl_joint_classes[j->desc.kind]->rows(&now, &now.pose_a, &now.pose_b, &rows);
    double most = 0, sum = 0;
    for (int i = 0; i < rows.count; ++i) {
        if (pl_row_is_rigid(&rows.row[i])) {
            const double error = fabs((double)pl_held((double)rows.row[i].error));
            most = error > most ? error : most;
            sum += error * error;
        }
    }
    return pl_held(sum - sum == 0 ? sqrt(sum) : most); // squares beyond all doubles: beyond 1e154
}
