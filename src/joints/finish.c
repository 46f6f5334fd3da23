// finish.c - after the step: reactions of joints, pawls that fall behind a tooth, joints that
// break or are strained.
//
// The reaction is the sum of J^T impulse on B over the last substep; its torque about B's anchor is
// what the arm does not explain. What breaks or strains a joint is that of the whole step: its mean, or its sum.
// Reads: impulses, bodies. Writes: reactions, break events; removes what broke. Cost: O(joints).
#include "world/destroy.h"
#include "joints/joint.h"
#include "plumb/math.h"
#include "world/state.h"

typedef struct momentum {
    plumb_vec2 linear; // [N s]
    real angular;      // [N m s]
} momentum;

// Sum of J^T impulse on B. Of a row that is off, nothing but that is written.
static momentum push_on_b(const pl_joint *j, const pl_rows *rows)
{
    momentum sum = { { 0, 0 }, 0 };
    for (int i = 0; i < rows->count; ++i) {
        const pl_row *r = &rows->row[i];
        if (r->type != PL_ROW_OFF) {
            sum.linear.x += r->bx * j->impulse[i];
            sum.linear.y += r->by * j->impulse[i];
            sum.angular += r->bw * j->impulse[i];
        }
    }
    return sum;
}

// The rows of a joint, with what lies along locked axes of B; `made` is room for them.
static const pl_rows *whole_rows(const plumb_world *world, const pl_joint *j, pl_rows *made)
{
    if (world->locked_bodies == 0 || plumb_is_null(j->b.body) ||
        (world->bodies.flags[pl_body_row(world, j->b.body)] & PL_BODY_LOCKED) == 0) {
        return &j->rows;
    }
    pl_joint now = *j;
    pl_joint_begin(world, &now);
    pl_joint_classes[j->desc.kind]->rows(&now, &now.pose_a, &now.pose_b, made);
    return made;
}

// The reaction in double, and no more than a real holds: impulses of which each is in the range of a real may have a sum
// that is not, and the difference of two such torques would be no number, at which no joint breaks.
static void react_beyond(pl_joint *j, const pl_rows *rows)
{
    double x = 0, y = 0, turn = 0;
    for (int i = 0; i < rows->count; ++i) {
        const pl_row *r = &rows->row[i];
        if (r->type != PL_ROW_OFF) {
            const double push = (double)pl_held((double)j->impulse[i]) / (double)j->h;
            x += (double)r->bx * push;
            y += (double)r->by * push;
            turn += (double)r->bw * push;
        }
    }
    j->force = plumb_v2(pl_held(x), pl_held(y));
    j->torque = pl_held(turn - ((double)j->arm_b.x * y - (double)j->arm_b.y * x));
}

static void react(const plumb_world *world, pl_joint *j)
{
    pl_rows made;
    const pl_rows *rows = whole_rows(world, j, &made);
    const momentum sum = push_on_b(j, rows);
    j->force = plumb_v2(sum.linear.x / j->h, sum.linear.y / j->h);
    j->torque = sum.angular / j->h - plumb_vec2_cross(j->arm_b, j->force);
    if (!plumb_vec2_is_finite(j->force) || !plumb_is_finite(j->torque)) {
        react_beyond(j, rows);
    }
}

// It did nothing in this step, and has nothing to start the next one with.
static void rest(pl_joint *j)
{
    for (int i = 0; i < PL_JOINT_ROWS; ++i) {
        j->impulse[i] = 0;
    }
    j->force = plumb_v2(0, 0);
    j->torque = 0;
    j->told_impulse = plumb_v2(0, 0);
    j->told_turn = 0;
    j->strained = 0;
}

void pl_joints_tally(const pl_joint_context *c)
{
    pl_joints_tally_lanes(c);
    for (uint32_t i = c->group->alone; i < c->group->end; ++i) {
        pl_joint *j = pl_joint_grouped(&c->world->joints, i);
        pl_rows made;
        momentum sum = push_on_b(j, whole_rows(c->world, j, &made));
        // What J's turning owes is not given yet: it is paid to what the next substep begins with.
        sum.linear = plumb_vec2_sub(sum.linear, plumb_v2(j->turn[3], j->turn[4]));
        sum.angular -= j->turn[5];
        j->step_impulse = plumb_vec2_add(j->step_impulse, sum.linear);
        j->step_turn += sum.angular - plumb_vec2_cross(j->arm_b, sum.linear);
    }
}

// Reactions of which each is in the range of a real may have a sum that is not: then that of the last substep counts,
// which is held within it.
static void hold_sums(pl_joint *j, real dt)
{
    if (!plumb_vec2_is_finite(j->step_impulse) || !plumb_is_finite(j->step_turn)) {
        j->step_impulse = plumb_vec2_scale(dt, j->force);
        j->step_turn = dt * j->torque;
    }
}

// A bound of 0 is none.
static bool exceeds(real value, real bound)
{
    return bound > 0 && value > bound;
}

static bool overloaded(const pl_joint *j, real dt)
{
    const plumb_joint_desc *d = &j->desc;
    const real impulse = plumb_vec2_magnitude(j->step_impulse);
    return exceeds(impulse, d->break_impulse) || exceeds(impulse, d->break_force * dt) ||
           exceeds(plumb_abs(j->step_turn), d->break_torque * dt);
}

static bool is_strained(const pl_joint *j, real dt)
{
    const plumb_joint_desc *d = &j->desc;
    return exceeds(plumb_vec2_magnitude(j->step_impulse), d->event_force * dt) ||
           exceeds(plumb_abs(j->step_turn), d->event_torque * dt);
}

static plumb_joint_break event_of(const plumb_world *world, const pl_joint *j, real dt)
{
    return (plumb_joint_break){ .joint = j->entity,
                                .kind = j->desc.kind,
                                .body_a = j->a.body,
                                .body_b = j->b.body,
                                .point = pl_joint_anchor(world, &j->b),
                                .force = plumb_v2(pl_held((double)j->step_impulse.x / (double)dt),
                                                  pl_held((double)j->step_impulse.y / (double)dt)),
                                .torque = pl_held((double)j->step_turn / (double)dt),
                                .impulse = j->step_impulse,
                                .user_data = j->desc.user_data };
}

// Room for an event of every joint was made with the joint: of breaks from the front, of strain from the back.
static void snap(plumb_world *world, const pl_joint *j, real dt)
{
    plumb_joint_break *events = world->joints.broken.data;
    events[world->joints.broken_count++] = event_of(world, j, dt);
    pl_destroy_entity(world, j->entity.entity);
}

static void note_strain(plumb_world *world, pl_joint *j, real dt)
{
    pl_joints *joints = &world->joints;
    const bool is = is_strained(j, dt);
    if (is && j->strained == 0) {
        plumb_joint_strain *events = joints->broken.data;
        events[--joints->strained_first] = event_of(world, j, dt);
        ++joints->strained_count;
    }
    j->strained = is;
}

// They were put down from the back; order of slots, please.
static void turn_round(pl_joints *joints)
{
    plumb_joint_strain *events = joints->broken.data;
    for (int i = 0, k = joints->strained_count - 1; i < k; ++i, --k) {
        const plumb_joint_strain kept = events[joints->strained_first + (uint32_t)i];
        events[joints->strained_first + (uint32_t)i] = events[joints->strained_first + (uint32_t)k];
        events[joints->strained_first + (uint32_t)k] = kept;
    }
}

void pl_joints_finish(plumb_world *world, real dt)
{
    world->joints.strained_first = world->joints.count;
    for (uint32_t i = 0; i < world->joints.awake_count; ++i) {
        uint32_t slot = ((const uint32_t *)world->joints.awake.data)[i];
        const pl_joint_mark *mark = &pl_joint_marks(&world->joints)[slot];
        const bool exactly =
            mark->cluster == world->joints.plan.exact_group; // one by one, sums and all
        if (mark->quiet && !exactly) {
            continue;
        }
        pl_joint *j = &pl_joint_items(&world->joints)[slot];
        if (mark->what == 0) {
            rest(j);
            continue;
        }
        if (!pl_joint_is_wide(mark) || exactly) {
            react(world, j);
        }
        const pl_joint_class *kind = pl_joint_classes[j->desc.kind];
        if (kind->advance != NULL) {
            pl_joint_begin(world, j);
            kind->advance(j, &j->pose_a, &j->pose_b);
        }
        hold_sums(j, dt);
        if (overloaded(j, dt)) {
            snap(world, j, dt);
        } else {
            note_strain(world, j, dt);
            j->told_impulse = j->step_impulse;
            j->told_turn = j->step_turn;
            j->step_impulse = plumb_v2(0, 0);
            j->step_turn = 0;
        }
    }
    turn_round(&world->joints);
}
