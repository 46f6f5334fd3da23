// push.c - forces on bodies at rest. To rest is to be slow and even under the same force; to sleep is to
// have it still.
//
// At each sample of rest a body's force is taken down beside its place. Forces are the same while the acceleration that their
// difference would give is below the one that samples of its way just do not see: from one half of sleep_time
// T to the next, the way changes by a (T / 2)^2, and EVEN * sleep_speed * T is even, so
//
//     a = 4 EVEN sleep_speed / T,    |dF| / m and |dM| extent / I taken together as speeds are (rest.c).
//
// By default that is 8 mm/s^2. What a body falls asleep under stays what its force is compared with, so
// forces that creep wake it as those that jump do, and one that ends wakes it.
//
// In the first step of its sleep a body finds out what kind of pusher it has. It was set still, so a force that
// depends on velocity is another now: what it finds is what it sleeps under, if that is the same by the rule above.
// Nothing at all means that the force has ended, or that who pushes leaves sleeping rows alone, as systems do that
// walk the awake ones. So the body wakes, and if it is pushed as it was, it knows: when it falls asleep the
// next time, it sleeps under no force (PL_BODY_UNTOLD).
//
// Reads: forces, rows. Writes: marks, forces of sleeping rows. Cost: nothing while no sleeping body is pushed and
// no force column was handed out; else four instructions a sleeping row, and six for those whose force is not the
// same to the bit.
#include "world/push.h"

#include "world/island.h"
#include "core/quad.h"
#include "world/rows.h"

#include <string.h>

real pl_push_tolerance(const plumb_world *world)
{
    return 4 * PL_EVEN * world->desc.sleep_speed / world->desc.sleep_time;
}

// Of a force that is not finite: true.
bool pl_push_differs(const plumb_world *world, uint32_t row, real tolerance)
{
    const pl_bodies *b = &world->bodies;
    const real x = (b->fx[row] - b->rest_fx[row]) * b->inv_mass[row];
    const real y = (b->fy[row] - b->rest_fy[row]) * b->inv_mass[row];
    const real tip = (b->torque[row] - b->rest_torque[row]) * b->inv_inertia[row] * b->extent[row];
    return !(x * x + y * y + tip * tip <= tolerance * tolerance);
}

void pl_push_keep(pl_bodies *b, uint32_t row)
{
    b->rest_fx[row] = b->fx[row];
    b->rest_fy[row] = b->fy[row];
    b->rest_torque[row] = b->torque[row];
}

bool pl_is_pushed(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    return b->fx[row] != 0 || b->fy[row] != 0 || b->torque[row] != 0;
}

static bool sleeps_under_force(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    return b->rest_fx[row] != 0 || b->rest_fy[row] != 0 || b->rest_torque[row] != 0;
}

void pl_push_begin_sleep(plumb_world *world, uint32_t row, bool steps)
{
    pl_bodies *b = &world->bodies;
    b->flags[row] &= (uint16_t)~PL_BODY_NEW_SLEEPER;
    if (!steps) { // by a call: at rest or not, and whatever pushes it
        b->rest_fx[row] = b->rest_fy[row] = b->rest_torque[row] = 0;
        return;
    }
    pl_push_keep(b, row);
    if (pl_is_pushed(world, row)) {
        b->flags[row] |= PL_BODY_NEW_SLEEPER;
        world->sleep.holds = world->sleep.holds_new = true;
    }
}

// Of a body that sleeps under a force it is known only when all of a step's are added up.
void pl_sleep_push(plumb_world *world, uint32_t row)
{
    if (pl_row_is_asleep(world, row) && pl_row_slept(world, row)) {
        if (sleeps_under_force(world, row)) {
            pl_sleep_heed(world);
        } else {
            pl_sleep_stir(world, row);
        }
    }
}

void pl_push_wake(plumb_world *world, uint32_t row)
{
    uint16_t *flags = &world->bodies.flags[row];
    if ((*flags & PL_BODY_NEW_SLEEPER) != 0 && !pl_is_pushed(world, row)) {
        *flags |= PL_BODY_UNTOLD;
    }
    *flags &= (uint16_t)~PL_BODY_NEW_SLEEPER;
}

void pl_push_sample(plumb_world *world, uint32_t row)
{
    if (!pl_is_pushed(world, row)) {
        world->bodies.flags[row] &= (uint16_t)~PL_BODY_UNTOLD;
    }
}

void pl_sleep_wake_untold(plumb_world *world)
{
    const uint32_t first = world->dynamic_count + world->kinematic_count;
    for (uint32_t row = first; row < first + world->asleep_count; ++row) {
        if ((world->bodies.flags[row] & PL_BODY_UNTOLD) != 0) {
            pl_sleep_stir(world, row);
        }
    }
}

void pl_sleep_heed(plumb_world *world)
{
    // Only where it is news: systems that run on several threads ask for columns too, and before these do, pl_system_run
    // or pl_acting_find has said it for them.
    if (world->sleep.lent_step != world->step_count + 1) {
        world->sleep.lent_step = world->step_count + 1;
    }
}

void pl_sleep_heed_all(plumb_world *world)
{
    pl_sleep_heed(world);
    world->sleep.holds = world->sleep.holds_new = true;
}

//---- in the waking pass --------------------------------------------------------------------------

// Its force is another than the one that it sleeps under.
static bool is_woken(const plumb_world *world, uint32_t row, real tolerance)
{
    const uint32_t flags = world->bodies.flags[row];
    if ((flags & PL_BODY_TURNED) !=
        0) { // it fell asleep in this step, which was refused: the next one asks
        return false;
    }
    const bool told = (flags & PL_BODY_NEW_SLEEPER) == 0 || pl_is_pushed(world, row);
    return pl_push_differs(world, row, tolerance) && (told || (flags & PL_BODY_UNTOLD) == 0);
}

typedef struct forces {
    const pl_quad_mask *now[3], *rest[3];
} forces;

static forces forces_of(const pl_bodies *b)
{
    return (forces){ { (const pl_quad_mask *)(const void *)b->fx,
                       (const pl_quad_mask *)(const void *)b->fy,
                       (const pl_quad_mask *)(const void *)b->torque },
                     { (const pl_quad_mask *)(const void *)b->rest_fx,
                       (const pl_quad_mask *)(const void *)b->rest_fy,
                       (const pl_quad_mask *)(const void *)b->rest_torque } };
}

#define ANY_LANE(mask) (((mask)[0] | (mask)[1] | (mask)[2] | (mask)[3]) != 0)

// Whether a row from quad i on, up to `end`, has a force.
static bool any_pushed(const forces *f, uint32_t i, uint32_t end)
{
    pl_quad_mask pushed = { 0 };
    for (; i < (end + 3) / 4; ++i) {
        pushed |= f->now[0][i] | f->now[1][i] | f->now[2][i];
    }
    return ANY_LANE(pushed);
}

void pl_push_mark(plumb_world *world, void (*mark)(pl_sleep *, uint32_t))
{
    pl_sleep *s = &world->sleep;
    const uint32_t first = world->dynamic_count + world->kinematic_count;
    const uint32_t end = first + world->asleep_count;
    const real tolerance = pl_push_tolerance(world);
    const forces f = forces_of(&world->bodies);
    pl_quad_mask pushed = { 0 }, holds = { 0 };
    if (!s->holds && !any_pushed(&f, first / 4, end)) {
        return;
    }
    // What lies beside the sleeping rows may look as if it were of them: then there is work for nothing.
    for (uint32_t i = first / 4; i < (end + 3) / 4; ++i) {
        const pl_quad_mask now = f.now[0][i] | f.now[1][i] | f.now[2][i];
        const pl_quad_mask other = (f.now[0][i] ^ f.rest[0][i]) | (f.now[1][i] ^ f.rest[1][i]) |
                                   (f.now[2][i] ^ f.rest[2][i]);
        pushed |= now;
        holds |= now | other;
        if (!ANY_LANE(other)) {
            continue;
        }
        const uint32_t last = 4 * i + 4 < end ? 4 * i + 4 : end;
        for (uint32_t row = 4 * i > first ? 4 * i : first; row < last; ++row) {
            if (is_woken(world, row, tolerance)) {
                mark(s, world->bodies.island[row]);
            }
        }
    }
    s->pushed = ANY_LANE(pushed);
    s->holds = ANY_LANE(holds);
}

bool pl_push_matters(const plumb_world *world)
{
    const pl_sleep *s = &world->sleep;
    return s->holds || s->lent_step + 1 > world->step_count;
}

// Those that fell asleep in the step before and sleep on.
void pl_push_settle(plumb_world *world)
{
    pl_bodies *b = &world->bodies;
    const uint32_t first = world->dynamic_count + world->kinematic_count;
    if (!world->sleep.holds_new) {
        return;
    }
    world->sleep.holds_new = false;
    for (uint32_t row = first; row < first + world->asleep_count; ++row) {
        const bool fell = (b->flags[row] & PL_BODY_TURNED) != 0; // in this step, which was refused
        if ((b->flags[row] & PL_BODY_NEW_SLEEPER) != 0 && fell) {
            world->sleep.holds = world->sleep.holds_new = true;
        } else if ((b->flags[row] & PL_BODY_NEW_SLEEPER) != 0) {
            const uint32_t known = pl_is_pushed(world, row) ? PL_BODY_UNTOLD : 0;
            b->flags[row] &= (uint16_t) ~(PL_BODY_NEW_SLEEPER | known);
            pl_push_keep(b, row);
        }
    }
}

void pl_sleep_clear_forces(plumb_world *world)
{
    pl_bodies *b = &world->bodies;
    const uint32_t first = world->dynamic_count + world->kinematic_count;
    const size_t bytes = world->asleep_count * sizeof(real);
    if (world->sleep.pushed && bytes > 0) {
        memset(b->fx + first, 0, bytes);
        memset(b->fy + first, 0, bytes);
        memset(b->torque + first, 0, bytes);
    }
    world->sleep.pushed = false;
}
