// rest.c - for how long each body has rested.
//
// A body rests while it is slower than sleep_speed and goes evenly: from one half of sleep_time to
// the next, its way must not change by more than a fiftieth of what sleep_speed makes in
// sleep_time. A block that begins to slide, or a large slow pendulum at its turning point, is slow
// and not at rest; a heap that creeps is. In the defaults, what accelerates by 8 mm/s^2 stays
// awake. Turning counts by the farthest point: sqrt(v^2 + (w r)^2), and the way likewise.
//
// Reads: velocities, places, pairs. Writes: times of rest. Cost: a dozen instructions an awake body and step.
#include "sleep/fall.h"
#include "world/push.h"
#include "core/quad.h"

static real square(real v)
{
    return v * v;
}

bool pl_is_rested(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    return b->rest_samples[row] >= 2 && b->rest_time[row] >= 0 &&
           (b->flags[row] & PL_BODY_NO_SLEEP) == 0;
}

static void begin_sample(pl_bodies *b, uint32_t row)
{
    b->rest_time[row] = 0;
    b->rest_x[row] = b->center_x[row];
    b->rest_y[row] = b->center_y[row];
    b->rest_c[row] = b->c[row];
    b->rest_s[row] = b->s[row];
    pl_push_keep(b, row);
}

// Half of sleep_time after the last sample: compares the way since with the one before.
static void take_sample(plumb_world *world, uint32_t row)
{
    pl_bodies *b = &world->bodies;
    real x = b->center_x[row] - b->rest_x[row], y = b->center_y[row] - b->rest_y[row];
    real turn = b->s[row] * b->rest_c[row] - b->c[row] * b->rest_s[row];
    real change = square(x - b->rest_dx[row]) + square(y - b->rest_dy[row]) +
                  square((turn - b->rest_turn[row]) * b->extent[row]);
    real way = square(x) + square(y) + square(turn * b->extent[row]);
    real even = PL_EVEN * world->desc.sleep_speed * world->desc.sleep_time;
    real slow = world->desc.sleep_speed * b->rest_time[row];
    pl_push_sample(world, row);
    bool goes_on =
        b->rest_samples[row] > 0 && !pl_push_differs(world, row, pl_push_tolerance(world));
    b->rest_samples[row] = goes_on && change <= square(even) && way <= square(slow) ? 2 : 1;
    b->rest_dx[row] = x;
    b->rest_dy[row] = y;
    b->rest_turn[row] = turn;
    begin_sample(b, row);
    if (pl_is_rested(world, row)) {
        // Until it has been looked at again, and more.
        world->sleep.candidate_in = world->desc.sleep_time;
    }
}

// Four rows at once: this is all that sleeping costs who is awake. What lies behind the last row is
// in columns that are longer than that, and means nothing.
// `a` where the mask is set, else `b`.
#define EITHER(mask, a, b) ((pl_quad)(((mask) & (pl_quad_mask)(a)) | (~(mask) & (pl_quad_mask)(b))))

// The time of each row goes on, begins (0) or is void. True when one begins, or a sample is due.
static bool go_on(const pl_bodies *b, uint32_t count, real slow, real half, real passed)
{
    const pl_quad *vx = (const pl_quad *)b->vx, *vy = (const pl_quad *)b->vy,
                  *w = (const pl_quad *)b->w;
    const pl_quad *extent = (const pl_quad *)b->extent;
    pl_quad *rest_time = (pl_quad *)b->rest_time;
    const pl_quad zero = { 0 }, not_resting = zero + PL_NOT_RESTING;
    pl_quad_mask due = { 0 };
    for (uint32_t i = 0; i < (count + 3) / 4; ++i) {
        pl_quad tip = w[i] * extent[i];
        pl_quad speed = vx[i] * vx[i] + vy[i] * vy[i] + tip * tip;
        pl_quad time = EITHER(rest_time[i] < zero, zero, rest_time[i] + passed);
        time = EITHER(speed <= zero + slow, time, not_resting);
        rest_time[i] = time;
        due |= (time == zero) | (time >= zero + half);
    }
    return (due[0] | due[1] | due[2] | due[3]) != 0;
}

void pl_rest_pass(plumb_world *world, real passed)
{
    pl_bodies *b = &world->bodies;
    const real half = world->desc.sleep_time / 2;
    if (!go_on(b, world->dynamic_count, square(world->desc.sleep_speed), half, passed)) {
        return;
    }
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        if (b->rest_time[row] >= half) {
            take_sample(world, row);
        } else if (b->rest_time[row] == 0) {
            begin_sample(b, row);
            b->rest_samples[row] = 0;
        }
    }
}

void pl_rest_again(plumb_world *world)
{
    pl_bodies *b = &world->bodies;
    const real slow = square(world->desc.sleep_speed);
    for (uint32_t row = 0; row < (world->dynamic_count + 3) / 4 * 4; ++row) { // as go_on does
        if (b->rest_time[row] < 0 && pl_square_speed(b, row) <= slow) {
            b->rest_time[row] = 0;
            if (row < world->dynamic_count) {
                begin_sample(b, row);
                b->rest_samples[row] = 0;
            }
        }
    }
}

void pl_rest_around_changed(plumb_world *world, uint32_t pair_count)
{
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    pl_bodies *b = &world->bodies;
    const uint32_t now = (uint32_t)(world->step_count + 1);
    if (world->sleep.changed_step != world->step_count + 1) {
        return;
    }
    uint8_t *flags = world->pieces.flags;
    for (uint32_t i = 0; i < pair_count; ++i) {
        uint32_t r = pairs[i].body_a, q = pairs[i].body_b;
        if (pl_is_linked(&pairs[i]) &&
            (b->changed_step[r] == now || b->changed_step[q] == now ||
             ((flags[pairs[i].a] | flags[pairs[i].b]) & PL_PIECE_CHANGED) != 0)) {
            b->rest_time[r] = b->rest_time[q] = PL_NOT_RESTING;
        }
    }
    for (uint32_t p = 0; p < world->pieces.table.count; ++p) {
        flags[p] &= (uint8_t)~PL_PIECE_CHANGED;
    }
}
