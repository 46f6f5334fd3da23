// speeds.c - bodies that are faster than anything accounts for, and places and speeds that a real does not resolve.
//
// The energy that a body of mass m may have of all that is known: speeds that calls, systems and what drives gave, as far as anybody
// may have fallen, what forces did, each of a body as heavy as the heaviest one, and all that springs ever stored:
//
//     v^2 = (given^2 + push_speed^2 + 2 (highest - here) + 2 worked) heaviest / m + 2 stored / m
//
// Reads: bodies. Writes: nothing. Cost: O(bodies), some ten operations each.
#include "watchdog/watchdog.h"

#include "plumb/math.h"

// [J/kg] that a body of this gravity scale may have fallen.
static double fallen(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    const pl_watchdog *dog = &world->watchdog;
    const double scale = (double)b->gravity_scale[row];
    const double here = -((double)world->gravity.x * (double)b->center_x[row] +
                          (double)world->gravity.y * (double)b->center_y[row]);
    const double drop = scale >= 0 ? dog->highest - here : here - dog->lowest;
    return drop > 0 ? drop * fabs(scale) : 0;
}

static void look_at_speed(plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    const pl_watchdog *dog = &world->watchdog;
    const double vx = (double)b->vx[row], vy = (double)b->vy[row];
    const double push = (double)world->desc.push_speed, m = (double)b->mass[row];
    const double bound = pl_watchdog_bound(PLUMB_ALARM_RUNAWAY_SPEED);
    const double sure = dog->given * dog->given + push * push;
    if (!(vx * vx + vy * vy > bound * bound * sure) || !(m > 0)) {
        return;
    }
    const double of_mass = pl_more(dog->heaviest / m, 1);
    const double all =
        (sure + 2 * fallen(world, row) + 2 * dog->worked_most) * of_mass + 2 * dog->stored_most / m;
    const double times = sqrt((vx * vx + vy * vy) / all);
    if (times > bound) {
        pl_watchdog_tell(world, &(pl_finding){ .kind = PLUMB_ALARM_RUNAWAY_SPEED,
                                               .row = row,
                                               .other = PL_NONE,
                                               .value = times,
                                               .pass = pl_watched_row(world, row)->hastened });
    }
}

static void look_at_scale(plumb_world *world, uint32_t row, double dt)
{
    const pl_bodies *b = &world->bodies;
    const double away = pl_more(fabs((double)b->center_x[row]), fabs((double)b->center_y[row]));
    const double way = dt * (fabs((double)b->vx[row]) + fabs((double)b->vy[row]));
    const double rounded = (away + way) * (double)PLUMB_REAL_EPSILON;
    const double extent = (double)b->extent[row];
    if (extent > 0 && rounded > pl_watchdog_bound(PLUMB_ALARM_OUT_OF_SCALE) * extent) {
        const pl_watched *w = pl_watched_row(world, row);
        pl_watchdog_tell(world, &(pl_finding){ .kind = PLUMB_ALARM_OUT_OF_SCALE,
                                               .row = row,
                                               .other = PL_NONE,
                                               .value = rounded / extent,
                                               .pass = w->moved[0] != '\0' ? w->moved : "calls" });
    }
}

void pl_watch_speeds(plumb_world *world, real dt)
{
    const char *unused;
    const bool known =
        world->desc.measure || (world->systems.in_substeps == 0 && world->laws.count == 0 &&
                                world->settings.engines == 0 && !pl_want_fluids(world, &unused));
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        if (known) {
            look_at_speed(world, row);
        }
        look_at_scale(world, row, (double)dt);
    }
}
