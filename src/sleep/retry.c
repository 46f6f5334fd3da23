// retry.c - a step that was refused is taken again. What woke or fell asleep in it stays so: rows have moved, and to
// move them back would take memory. But passes before the waking one (characters, liquid) ask who sleeps, how fast he is
// and what pushes him, and they must be told what they were told the first time.
//
// Events of sleep are kept over a refused step, so those that turned are known by them. In the tries that follow they
// are marked (PL_BODY_TURNED, pl_row_slept), and those that fell asleep have their velocity and their forces again, until
// the waking pass, behind which nobody looks at a sleeping row.
//
// Reads: events of sleep. Writes: flags, velocities and forces of what fell asleep. Cost: nothing but behind a refused step.
#include "sleep/fall.h"
#include "world/rows.h"

static const plumb_body *fallen_bodies(const plumb_world *world)
{
    return world->sleep.sleep_events.data;
}

// The row of what fell asleep as event i tells, and sleeps still; else PL_NONE.
static uint32_t fallen_row(const plumb_world *world, int i)
{
    const uint32_t row = pl_body_row(world, fallen_bodies(world)[i]);
    return row != PL_NONE && pl_row_is_asleep(world, row) ? row : PL_NONE;
}

static bool is_still(const pl_bodies *b, uint32_t row)
{
    return b->vx[row] == 0 && b->vy[row] == 0 && b->w[row] == 0 && b->fx[row] == 0 &&
           b->fy[row] == 0 && b->torque[row] == 0;
}

static void put(pl_bodies *b, uint32_t row, const pl_fallen *f)
{
    b->vx[row] = f->vx, b->vy[row] = f->vy, b->w[row] = f->w;
    b->fx[row] = f->fx, b->fy[row] = f->fy, b->torque[row] = f->torque;
}

void pl_sleep_note_fallen(plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    pl_fallen *all = world->sleep.fallen.data;
    all[world->sleep.sleep_event_count] = (pl_fallen){ .vx = b->vx[row],
                                                       .vy = b->vy[row],
                                                       .w = b->w[row],
                                                       .fx = b->fx[row],
                                                       .fy = b->fy[row],
                                                       .torque = b->torque[row] };
}

// What the user set in motion meanwhile keeps that.
static void lift(plumb_world *world)
{
    pl_fallen *all = world->sleep.fallen.data;
    for (int i = 0; i < world->sleep.sleep_event_count; ++i) {
        const uint32_t row = fallen_row(world, i);
        if (row != PL_NONE && !all[i].lifted && is_still(&world->bodies, row)) {
            put(&world->bodies, row, &all[i]);
            all[i].lifted = true;
        }
    }
}

void pl_sleep_lay(plumb_world *world)
{
    pl_fallen *all = world->sleep.fallen.data;
    for (int i = 0; i < world->sleep.sleep_event_count; ++i) {
        const uint32_t row = all[i].lifted ? fallen_row(world, i) : PL_NONE;
        if (row != PL_NONE) {
            put(&world->bodies, row, &(pl_fallen){ 0 });
        }
        all[i].lifted = false;
    }
}

void pl_sleep_undo_open(plumb_world *world)
{
    lift(world);
}

void pl_sleep_undo_close(plumb_world *world)
{
    const pl_bodies *b = &world->bodies;
    pl_fallen *all = world->sleep.fallen.data;
    for (int i = 0; i < world->sleep.sleep_event_count; ++i) {
        const uint32_t row = all[i].lifted ? fallen_row(world, i) : PL_NONE;
        if (row != PL_NONE) {
            all[i] = (pl_fallen){ b->vx[row], b->vy[row],     b->w[row], b->fx[row],
                                  b->fy[row], b->torque[row], true };
        }
    }
    pl_sleep_lay(world);
}

static void clear_marks(plumb_world *world, const pl_buffer *events, int count)
{
    const plumb_body *body = events->data;
    for (int i = 0; i < count; ++i) {
        const uint32_t row = pl_body_row(world, body[i]);
        if (row != PL_NONE) {
            world->bodies.flags[row] &= (uint16_t)~PL_BODY_TURNED;
        }
    }
}

// Who fell asleep and woke, in whatever order, is as he was; and so is who woke and was put to sleep by a call.
static void mark_turned(plumb_world *world)
{
    const pl_sleep *s = &world->sleep;
    const plumb_body *woken = s->wake_events.data;
    uint16_t *flags = world->bodies.flags;
    for (int i = 0; i < s->sleep_event_count; ++i) {
        const uint32_t row = pl_body_row(world, fallen_bodies(world)[i]);
        if (row != PL_NONE) {
            flags[row] |= PL_BODY_TURNED;
        }
    }
    for (int i = 0; i < s->wake_event_count; ++i) {
        const uint32_t row = pl_body_row(world, woken[i]);
        if (row == PL_NONE) {
            continue;
        }
        const bool fell = (flags[row] & PL_BODY_TURNED) != 0;
        flags[row] &= (uint16_t)~PL_BODY_TURNED;
        flags[row] |= !fell && !pl_row_is_asleep(world, row) ? PL_BODY_TURNED : 0;
    }
}

void pl_sleep_recall_end(plumb_world *world)
{
    const pl_sleep *s = &world->sleep;
    pl_sleep_lay(world);
    clear_marks(world, &s->sleep_events, s->sleep_event_count);
    clear_marks(world, &s->wake_events, s->wake_event_count);
}

void pl_sleep_recall(plumb_world *world)
{
    pl_sleep_recall_end(world);
    mark_turned(world);
    lift(world);
}
