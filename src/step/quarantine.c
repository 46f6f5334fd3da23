// quarantine.c - bodies that a step would leave without a finite state are taken out of it, and nobody else
// notices: the others have the bits of a step in which those were disabled before it began.
//
// NaN cannot get in by a call, but a system may write one through a span, and forces, masses and velocities
// that are finite each may overflow together. Three looks find it:
// - guard, at the head of the step and behind the user's systems: velocity, and what force and torque make of it
//   in a step. Who fails is disabled before anybody has seen it.
// - judge, behind the solver and before anything has moved: what the solver did. Impulses spread what is
//   not finite, so one body is taken out, of those that fail and what they touch the one that came with by far the
//   most speed, and the step is taken anew (step.c) as one that ran out of memory would be; after PATIENCE of
//   them, all that fail.
// - motion (solver/finish.c): a body in no contact, or one that leaves the world's 1e12 m. It is put back,
//   and disabled when the step is over; nothing that is not finite came of it.
//
// Reads: velocities, forces, solver bodies. Writes: rows of those taken out, events. Cost: a third of an
// instruction a number.
#include "step/quarantine.h"

#include "core/quad.h"
#include "joints/joint.h"
#include "world/marks.h"
#include "world/rows.h"
#include "world/state.h"

#include <string.h>

#define PATIENCE 4 // bodies that are taken out one by one in a step

typedef struct pl_kept_joint {
    real impulse[PL_JOINT_ROWS];
    real h;
    plumb_vec2 force;
    real torque;
    plumb_vec2 step_impulse, told_impulse;
    real step_turn, told_turn;
} pl_kept_joint;

void pl_quarantine_free(pl_memory *memory, pl_quarantine *q)
{
    pl_buffer_free(memory, &q->joints);
    pl_buffer_free(memory, &q->rolling);
}

void pl_quarantine_begin(plumb_world *world)
{
    pl_quarantine *q = &world->quarantine;
    q->event_count = 0;
    q->attempt = 0;
    q->again = q->lost = q->kept = false;
    q->since = -1;
}

//---- whom it takes out ---------------------------------------------------------------------------

// [m/s] what velocity and forces come to in a step at the most; not finite where they have no finite end.
static real haste(const plumb_world *world, uint32_t row, real dt)
{
    const pl_bodies *b = &world->bodies;
    return plumb_abs(b->vx[row]) + plumb_abs(b->vy[row]) + plumb_abs(b->w[row]) +
           dt * ((plumb_abs(b->fx[row]) + plumb_abs(b->fy[row])) * b->inv_mass[row] +
                 plumb_abs(b->torque[row]) * b->inv_inertia[row]);
}

// Absolute values.
#define SIZE(q)      ((pl_quad)((pl_quad_mask)(q) & ~(pl_quad_mask)(-(pl_quad){ 0 })))
#define NEAR_SIZE(q) ((pl_near_quad)((pl_near_mask)(q) & ~(pl_near_mask)(-(pl_near_quad){ 0 })))

// The same of four rows at once, whether any is too much. What lies behind the last row may say so, too.
static bool any_in_haste(const plumb_world *world, uint32_t count, real dt)
{
    const pl_bodies *b = &world->bodies;
    const pl_quad *vx = (const pl_quad *)b->vx, *vy = (const pl_quad *)b->vy,
                  *w = (const pl_quad *)b->w;
    const pl_quad *fx = (const pl_quad *)b->fx, *fy = (const pl_quad *)b->fy;
    const pl_quad *torque = (const pl_quad *)b->torque;
    const pl_quad *im = (const pl_quad *)b->inv_mass, *ii = (const pl_quad *)b->inv_inertia;
    const pl_quad most = (pl_quad){ 0 } + PL_LARGEST;
    pl_quad_mask sound = (pl_quad_mask){ 0 } - 1;
    for (uint32_t i = 0; i < (count + 3) / 4; ++i) {
        pl_quad sum = SIZE(vx[i]) + SIZE(vy[i]) + SIZE(w[i]) +
                      dt * ((SIZE(fx[i]) + SIZE(fy[i])) * im[i] + SIZE(torque[i]) * ii[i]);
        sound &= sum <= most;
    }
    return !(sound[0] && sound[1] && sound[2] && sound[3]);
}

// It goes now.
static void expel(plumb_world *world, uint32_t row, const char *pass)
{
    pl_quarantine_tell(world, row, pass);
    pl_body_take_out(world, row);
}

// It goes when the step is taken anew.
static void sentence(plumb_world *world, uint32_t row, const char *pass)
{
    pl_quarantine_tell(world, row, pass);
    world->bodies.flags[row] |= PL_BODY_LOST;
    world->quarantine.again = true;
}

// From the last row on: what fills a gap has been looked at.
static void guard(plumb_world *world, real dt, const char *pass,
                  void (*act)(plumb_world *, uint32_t, const char *))
{
    const uint32_t count = world->dynamic_count + world->kinematic_count;
    if (!any_in_haste(world, count, dt)) {
        return;
    }
    for (uint32_t row = count; row-- > 0;) {
        if (!(haste(world, row, dt) <= PL_LARGEST)) {
            act(world, row, pass);
        }
    }
}

void pl_quarantine_guard(plumb_world *world, real dt, const char *pass)
{
    guard(world, dt, pass, expel);
}

void pl_quarantine_guard_late(plumb_world *world, real dt, const char *pass)
{
    guard(world, dt, pass, sentence);
}

//---- what the solver did -------------------------------------------------------------------------

static bool keep_joints(plumb_world *world)
{
    pl_quarantine *q = &world->quarantine;
    const uint32_t count = pl_joints_awake(world);
    if (!pl_buffer_reserve(&world->memory, &q->joints, count * sizeof(pl_kept_joint))) {
        return false;
    }
    pl_kept_joint *kept = q->joints.data;
    for (uint32_t i = 0; i < count; ++i) {
        const pl_joint *j = pl_joint_awake(&world->joints, i);
        memcpy(kept[i].impulse, j->impulse, sizeof j->impulse);
        kept[i].h = j->h;
        kept[i].force = j->force;
        kept[i].torque = j->torque;
        if (world->joints.watched == 0) {
            continue; // a step leaves the rest as it is, and it lies on other cache lines
        }
        kept[i].step_impulse = j->step_impulse;
        kept[i].step_turn = j->step_turn;
        kept[i].told_impulse = j->told_impulse;
        kept[i].told_turn = j->told_turn;
    }
    return true;
}

static bool rolls(const plumb_world *world)
{
    return world->narrow.any_surface || world->desc.solver != PLUMB_SOLVER_SOFT;
}

static bool keep_rolling(plumb_world *world)
{
    pl_quarantine *q = &world->quarantine;
    const uint32_t count = world->narrow.manifold_count;
    if (!pl_buffer_reserve(&world->memory, &q->rolling, count * sizeof(near_real))) {
        return false;
    }
    near_real *kept = q->rolling.data;
    for (uint32_t i = 0; i < count; ++i) {
        kept[i] = pl_pairs(&world->broad.pairs)[pl_manifolds(&world->narrow)[i].pair].rolling;
    }
    return true;
}

bool pl_quarantine_keep(plumb_world *world)
{
    world->quarantine.kept =
        (world->joints.live == 0 || keep_joints(world)) && (!rolls(world) || keep_rolling(world));
    return world->quarantine.kept;
}

// Manifolds still have the impulses of the step before.
static void undo_impulses(plumb_world *world)
{
    const pl_manifold *m = pl_manifolds(&world->narrow);
    const near_real *rolling = world->quarantine.rolling.data;
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        pl_pair *pair = &pl_pairs(&world->broad.pairs)[m[i].pair];
        for (int k = 0; k < 2; ++k) {
            pair->normal[k] = m[i].point[k].normal;
            pair->tangent[k] = m[i].point[k].tangent;
        }
        pair->flags =
            (pair->flags & ~PL_PAIR_SLIDES) | ((m[i].met & PL_MET_SLID) != 0 ? PL_PAIR_SLIDES : 0);
        if (rolls(world)) {
            pair->rolling = rolling[i];
        }
    }
}

static void undo_joints(plumb_world *world)
{
    const pl_kept_joint *kept = world->quarantine.joints.data;
    const uint32_t count = world->joints.live == 0 ? 0 : pl_joints_awake(world);
    for (uint32_t i = 0; i < count; ++i) {
        pl_joint *j = pl_joint_awake(&world->joints, i);
        memcpy(j->impulse, kept[i].impulse, sizeof j->impulse);
        j->h = kept[i].h;
        j->force = kept[i].force;
        j->torque = kept[i].torque;
        if (world->joints.watched == 0) {
            continue;
        }
        j->step_impulse = kept[i].step_impulse;
        j->step_turn = kept[i].step_turn;
        j->told_impulse = kept[i].told_impulse;
        j->told_turn = kept[i].told_turn;
    }
}

// Whom a culprit came near in this step alone has lost nothing that it stood on when their pair goes.
static void forget_moving_pairs(plumb_world *world)
{
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    const uint16_t *flags = world->bodies.flags;
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        const pl_manifold *m = &pl_manifolds(&world->narrow)[i];
        const uint32_t ends = flags[m->body_a] | flags[m->body_b];
        if ((ends & PL_BODY_LOST) != 0 && m->before == PL_NONE) {
            pairs[m->pair].manifold = PL_NONE;
        }
    }
}

void pl_quarantine_undo(plumb_world *world)
{
    pl_quarantine *q = &world->quarantine;
    forget_moving_pairs(world);
    if (q->kept) {
        undo_impulses(world);
        undo_joints(world);
    }
    if (q->since >= 0) { // who had to stay awake for those that go now may sleep at this very look
        world->sleep.since = q->since;
    }
    q->kept = false;
    q->again = false;
    ++q->attempt;
}

// Speeds and ways of all slots are sound.
static bool all_sound(const pl_solver *s)
{
    const pl_near_quad *body = (const pl_near_quad *)(const void *)pl_solver_bodies(s);
    const pl_near_quad most = (pl_near_quad){ 0 } + (near_real)PL_LARGEST;
    pl_near_mask sound = (pl_near_mask){ 0 } - 1;
    for (uint32_t i = 0; i < s->dynamic_slots; ++i) {
        sound &= NEAR_SIZE(body[2 * i]) + NEAR_SIZE(body[2 * i + 1]) <= most;
    }
    return sound[0] && sound[1] && sound[2]; // the fourth: inverse mass and inertia
}

static bool is_sound(const pl_solver_body *b)
{
    const near_real most = (near_real)PL_LARGEST;
    const near_real all[6] = { b->vx, b->vy, b->w, b->dx, b->dy, b->da };
    bool sound = true;
    for (int i = 0; i < 6; ++i) {
        sound &= all[i] >= -most && all[i] <= most;
    }
    return sound;
}

// The solver left the row unsound.
static bool is_upset(const plumb_world *world, uint32_t row)
{
    const pl_solver *s = &world->solver;
    if (row >= world->dynamic_count) {
        return false;
    }
    const uint32_t slot = ((const uint32_t *)s->slots.data)[row];
    return slot != PL_NONE && !is_sound(&pl_solver_bodies(s)[slot]);
}

// Who came with the most speed.
typedef struct suspect {
    uint32_t row;
    real haste;
} suspect;

static void suspect_row(suspect *s, const plumb_world *world, uint32_t row, real dt)
{
    const real h = haste(world, row, dt);
    if (s->row == PL_NONE || h > s->haste || (h == s->haste && row < s->row)) {
        *s = (suspect){ row, h };
    }
}

// One of two that are in a contact or joint: whoever is upset has it from the other, if that was much faster.
static void suspect_end(suspect *s, const plumb_world *world, uint32_t row, uint32_t other, real dt)
{
    const uint32_t movable = world->dynamic_count + world->kinematic_count;
    if (row < movable && other < movable && is_upset(world, other) && !is_upset(world, row) &&
        haste(world, row, dt) > 1000 * haste(world, other, dt)) {
        suspect_row(s, world, row, dt);
    }
}

static uint32_t find_culprit(const plumb_world *world, real dt)
{
    suspect s = { PL_NONE, 0 };
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        if (is_upset(world, row)) {
            suspect_row(&s, world, row, dt);
        }
    }
    const pl_manifold *m = pl_manifolds(&world->narrow);
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        suspect_end(&s, world, m[i].body_a, m[i].body_b, dt);
        suspect_end(&s, world, m[i].body_b, m[i].body_a, dt);
    }
    const pl_joint_mark *marks = pl_joint_marks(&world->joints);
    for (uint32_t i = 0; world->joints.live > 0 && i < world->joints.count; ++i) {
        if (marks[i].what != 0) {
            suspect_end(&s, world, marks[i].row_a, marks[i].row_b, dt);
            suspect_end(&s, world, marks[i].row_b, marks[i].row_a, dt);
        }
    }
    return s.row;
}

void pl_quarantine_judge(plumb_world *world, real dt, const char *pass)
{
    if (all_sound(&world->solver)) {
        return;
    }
    if (world->quarantine.attempt < PATIENCE) {
        const uint32_t row = find_culprit(world, dt);
        if (row != PL_NONE) { // else it was inverse masses that were looked at
            sentence(world, row, pass);
        }
        return;
    }
    for (uint32_t row = world->dynamic_count; row-- > 0;) { // in the order in which they will go
        if (is_upset(world, row)) {
            sentence(world, row, pass);
        }
    }
}

//---- after motion --------------------------------------------------------------------------------

void pl_quarantine_finish(plumb_world *world)
{
    pl_bodies *b = &world->bodies;
    for (uint32_t row = world->dynamic_count + world->kinematic_count; row-- > 0;) {
        if ((b->flags[row] & PL_BODY_LOST) != 0) {
            b->flags[row] &= (uint16_t)~PL_BODY_LOST;
            pl_body_take_out(world, row);
        }
    }
    world->quarantine.lost = false;
}
