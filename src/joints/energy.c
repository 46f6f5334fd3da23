// energy.c - what springs of joints have stored.
//
// A spring of frequency w acts on its row with the force w^2 m C, where m = 1 / (J M^-1 J^T) is the mass that it meets
// (one.c): w^2 m C^2 / 2 is stored, k C^2 / 2 of one in newtons. Of a block of two rows it is w^2 C K^-1 C / 2, K = J M^-1 J^T. From where a bound
// holds the force, force times way is added.
//
// Reads: joints, bodies. Writes: nothing. Cost: O(1) a joint.
#include "joints/energy.h"

#include "world/joint_list.h"
#include "world/rows.h"
#include "world/state.h"

#include <math.h>

#define TAU 6.2831853071795864769

typedef struct ease {
    double mass, inertia; // inverse ones, of what does not move 0
} ease;

static ease ease_of(const plumb_world *world, const pl_joint_end *end)
{
    const uint32_t row = pl_joint_row(world, end);
    if (row == PL_NONE) {
        return (ease){ 0, 0 };
    }
    return (ease){ (double)world->bodies.inv_mass[row], (double)world->bodies.inv_inertia[row] };
}

// J M^-1 Q^T.
static double coupling(const pl_row *r, const pl_row *q, ease a, ease b)
{
    return a.mass * ((double)r->ax * (double)q->ax + (double)r->ay * (double)q->ay) +
           a.inertia * (double)r->aw * (double)q->aw +
           b.mass * ((double)r->bx * (double)q->bx + (double)r->by * (double)q->by) +
           b.inertia * (double)r->bw * (double)q->bw;
}

// Of a force of `force` that is w^2 m times the way, `twice` the energy without a bound.
static double bounded(double twice, double force, double most)
{
    const double share = force > most ? most / force : 1;
    return twice * share * (1 - share / 2);
}

static double of_row(const pl_row *r, ease a, ease b)
{
    const double k = coupling(r, r, a, b);
    if (!pl_row_is_spring(r) || !(k > 0)) {
        return 0;
    }
    const double w = TAU * (double)r->stiff, error = fabs((double)r->error);
    const double stiff = r->spring == PL_SPRING_NEWTONS ? (double)r->stiff : w * w / k;
    const double force = stiff * error;
    return bounded(force * error, force, (double)r->most);
}

// Of two rows; one that has no direction of its own has no spring (one.c: invert).
static double of_block(const pl_rows *rows, ease a, ease b)
{
    const pl_row *r = rows->row;
    const double k00 = coupling(&r[0], &r[0], a, b), k01 = coupling(&r[0], &r[1], a, b),
                 k11 = coupling(&r[1], &r[1], a, b), det = k00 * k11 - k01 * k01;
    if (rows->block != 2 || !pl_row_is_spring(&r[0]) || !(det > (double)PL_PIVOT * k00 * k11)) {
        return 0;
    }
    const double w = TAU * (double)r[0].stiff, x = (double)r[0].error, y = (double)r[1].error;
    const bool newtons = r[0].spring == PL_SPRING_NEWTONS;
    const double stiff = (double)r[0].stiff;
    const double fx = newtons ? stiff * x : w * w * (k11 * x - k01 * y) / det;
    const double fy = newtons ? stiff * y : w * w * (k00 * y - k01 * x) / det;
    return bounded(fx * x + fy * y, sqrt(fx * fx + fy * fy), (double)rows->block_most);
}

// Out of the simulation with its body.
static bool is_gone(const plumb_world *world, const pl_joint_end *end)
{
    const uint32_t row = pl_joint_row(world, end);
    return row != PL_NONE && row >= pl_partition_first(world, PL_PART_DISABLED);
}

double pl_joint_stored(const plumb_world *world, const pl_joint *joint)
{
    if (joint->desc.disabled || !pl_joint_has_spring(&joint->desc) || is_gone(world, &joint->a) ||
        is_gone(world, &joint->b)) {
        return 0;
    }
    pl_joint now = *joint;
    pl_joint_begin(world, &now);
    pl_joint_classes[now.desc.kind]->rows(&now, &now.pose_a, &now.pose_b, &now.rows);
    if (world->locked_bodies > 0) {
        pl_joint_lock_rows(world, &now);
    }
    const ease a = ease_of(world, &now.a), b = ease_of(world, &now.b);
    double sum = of_block(&now.rows, a, b);
    for (int i = now.rows.block; i < now.rows.count; ++i) {
        sum += of_row(&now.rows.row[i], a, b);
    }
    return sum;
}

double pl_joints_stored(const plumb_world *world)
{
    double sum = 0;
    for (uint32_t i = 0; i < world->joints.count; ++i) {
        const pl_joint *j = &pl_joint_items(&world->joints)[i];
        sum += plumb_is_null(j->entity) ? 0 : pl_joint_stored(world, j);
    }
    return sum;
}
