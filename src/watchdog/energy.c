// energy.c - islands that gain more energy in a step than what they have to do with gives them.
//
// Of each body: kinetic energy and height against the gravity that acts, before motion and behind it. Of each island,
// bodies that contacts and joints tie together: the sum, and what springs stored. Known is the work of forces: force
// times way, or what the world has measured of it. What motors, moving bodies, surfaces and bumpers give is bounded from above:
// they bring an island to their own speed, and lift it by that in a step. Overlaps are lifted out of one another by
// push_speed.
//
// Where substeps have systems, fluids or laws, forces are known only to a world that measures: else its energy is not watched.
// Reads: bodies, manifolds, joints. Writes: nothing but its own. Order: around motion. Cost: O(bodies + contacts + joints).
#include "watchdog/watchdog.h"

#include "core/union_find.h"
#include "effects/laws.h"
#include "joints/energy.h"
#include "world/body_settings.h"
#include "world/joint_list.h"
#include "world/measured.h"

static pl_watched_flight *flights(const plumb_world *world)
{
    return world->watchdog.flights.data;
}

static double kinetic(const pl_bodies *b, uint32_t row)
{
    const double vx = (double)b->vx[row], vy = (double)b->vy[row], w = (double)b->w[row];
    const double inertia = b->inv_inertia[row] > 0 ? (double)b->inertia[row] : 0;
    return ((double)b->mass[row] * (vx * vx + vy * vy) + inertia * w * w) / 2;
}

// [J] in springs of all joints that are awake; of each, into `out`, if it is one.
static double note_stored(const plumb_world *world, double *out)
{
    double sum = 0;
    for (uint32_t i = 0; world->joints.live > 0 && i < world->joints.awake_count; ++i) {
        const uint32_t slot = ((const uint32_t *)world->joints.awake.data)[i];
        out[slot] = pl_joint_stored(world, &pl_joint_items(&world->joints)[slot]);
        sum += out[slot];
    }
    return sum;
}

void pl_watch_energy_before(plumb_world *world)
{
    const pl_bodies *b = &world->bodies;
    pl_watchdog *dog = &world->watchdog;
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        flights(world)[row] =
            (pl_watched_flight){ kinetic(b, row),          (double)b->center_x[row],
                                 (double)b->center_y[row], (double)b->w[row],
                                 (double)b->fx[row],       (double)b->fy[row],
                                 (double)b->torque[row] };
    }
    dog->stored_most = pl_more(dog->stored_most, note_stored(world, dog->stored.data));
}

// What measuring has found of a row's forces and motors; false: nobody measures, or it was not solved.
static bool measured(const plumb_world *world, uint32_t row, double *joules)
{
    const uint32_t *slots = world->solver.slots.data;
    if (!world->desc.measure || world->solver.slot_count == 0 || slots[row] == PL_NONE) {
        return false;
    }
    const pl_measured_body *m = (const pl_measured_body *)world->measure.bodies.data + slots[row];
    *joules = pl_measure_driven(m);
    return true;
}

double pl_watch_work(const plumb_world *world, uint32_t row, real dt)
{
    const pl_bodies *b = &world->bodies;
    const pl_watched_flight *f = &flights(world)[row];
    double joules;
    if (measured(world, row, &joules)) {
        return joules;
    }
    if (world->laws.step.flies && pl_law_way_of(world, row) == PL_LAW_FLIES) {
        // What laws did is all that gravity did not.
        const plumb_vec2 g = world->effects.gravity;
        const double weight = (double)b->mass[row] * (double)b->gravity_scale[row];
        return kinetic(b, row) - f->kinetic -
               weight * ((double)g.x * ((double)b->center_x[row] - f->x) +
                         (double)g.y * ((double)b->center_y[row] - f->y));
    }
    return f->force_x * ((double)b->center_x[row] - f->x) +
           f->force_y * ((double)b->center_y[row] - f->y) +
           f->torque * (f->w + (double)b->w[row]) / 2 * (double)dt;
}

//---- islands -------------------------------------------------------------------------------------

static pl_watched_island *islands(const plumb_world *world)
{
    return world->watchdog.islands.data;
}

static pl_watched_island *island_of(const plumb_world *world, uint32_t row)
{
    return &islands(world)[pl_union_leader(world->watchdog.leaders.data, row)];
}

static bool is_dynamic(const plumb_world *world, uint32_t row)
{
    return row < world->dynamic_count; // PL_NONE is none
}

static void tie(const plumb_world *world, uint32_t a, uint32_t b)
{
    if (is_dynamic(world, a) && is_dynamic(world, b)) {
        pl_union_join(world->watchdog.leaders.data, a, b);
    }
}

static void find_islands(const plumb_world *world)
{
    const uint32_t count = world->dynamic_count;
    pl_union_reset(world->watchdog.leaders.data, count);
    for (uint32_t row = 0; row < count; ++row) {
        islands(world)[row] = (pl_watched_island){ .worst = row };
    }
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        const pl_manifold *m = &pl_manifolds(&world->narrow)[i];
        tie(world, m->body_a, m->body_b);
    }
    for (uint32_t i = 0; world->joints.live > 0 && i < world->joints.awake_count; ++i) {
        const pl_joint *j = pl_joint_awake(&world->joints, i);
        tie(world, pl_joint_row(world, &j->a), pl_joint_row(world, &j->b));
    }
}

static void add_row(plumb_world *world, uint32_t row, real dt)
{
    const pl_bodies *b = &world->bodies;
    const pl_watched_flight *f = &flights(world)[row];
    const uint32_t *slots = world->solver.slots.data;
    const plumb_vec2 g = world->effects.gravity;
    const double m = (double)b->mass[row], weight = m * (double)b->gravity_scale[row];
    const double known = pl_watch_work(world, row, dt);
    const double gained = kinetic(b, row) - f->kinetic -
                          weight * ((double)g.x * ((double)b->center_x[row] - f->x) +
                                    (double)g.y * ((double)b->center_y[row] - f->y));
    pl_watched *w = pl_watched_row(world, row);
    w->worked += known > 0 && m > 0 ? known / m : 0;
    world->watchdog.worked_most = pl_more(world->watchdog.worked_most, w->worked);
    if (slots[row] == PL_NONE) {
        return; // it flies
    }
    pl_watched_island *island = island_of(world, row);
    island->gained += gained;
    island->known += known;
    island->kinetic += f->kinetic;
    island->mass += m;
    island->fastest = pl_more(island->fastest, m > 0 ? sqrt(2 * f->kinetic / m) : 0);
    if (gained - known > island->most) {
        island->most = gained - known;
        island->worst = row;
    }
    if (pl_time_scale(world, row) != 1) {
        island->driven = HUGE_VAL;
    }
}

//---- what drives them ----------------------------------------------------------------------------

static void drive(const plumb_world *world, uint32_t row, double speed)
{
    if (is_dynamic(world, row)) {
        pl_watched_island *island = island_of(world, row);
        island->driven = pl_more(island->driven, speed);
    }
}

// [m/s] of a row that is kinematic, at its farthest point.
static double carried(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    const uint32_t first = world->dynamic_count;
    return row >= first && row < first + world->kinematic_count
               ? pl_length((double)b->vx[row], (double)b->vy[row]) +
                     fabs((double)b->w[row]) * (double)b->extent[row]
               : 0;
}

static double runs(const plumb_world *world, uint32_t piece)
{
    return fabs((double)world->materials.surface_speed[world->pieces.material[piece]]);
}

static void drive_by_contacts(const plumb_world *world)
{
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        const pl_manifold *m = &pl_manifolds(&world->narrow)[i];
        const pl_pair *pair = pl_pair_of(world, m);
        const double speed = runs(world, pair->a) + runs(world, pair->b) +
                             carried(world, m->body_a) + carried(world, m->body_b) +
                             (m->restitution > 1 ? (double)world->desc.restitution_cap : 0);
        const uint32_t row = is_dynamic(world, m->body_a) ? m->body_a : m->body_b;
        const double deep =
            m->waits > 0 ? 0
                         : -pl_less((double)m->point[0].separation, (double)m->point[1].separation);
        drive(world, row, speed);
        if (is_dynamic(world, row)) {
            pl_watched_island *island = island_of(world, row);
            island->deepest = pl_more(island->deepest, deep);
        }
    }
}

// [m/s] at which a joint's motor moves what it drives; measured ones are known.
static double motor_of(const plumb_world *world, const pl_joint *j)
{
    const plumb_joint_desc *d = &j->desc;
    const uint32_t rows[] = { pl_joint_row(world, &j->a), pl_joint_row(world, &j->b) };
    double reach = 0;
    if (world->desc.measure || d->disabled) {
        return 0;
    }
    if (d->kind == PLUMB_MOTOR) {
        return HUGE_VAL; // it goes wherever it is told
    }
    for (int i = 0; i < 2; ++i) {
        reach += rows[i] == PL_NONE ? 0 : (double)world->bodies.extent[rows[i]];
    }
    return d->enable_motor ? fabs((double)d->motor_speed) * (d->kind == PLUMB_PRISMATIC ? 1 : reach)
                           : 0;
}

static void drive_by_joints(plumb_world *world)
{
    const double *stored = world->watchdog.stored.data;
    for (uint32_t i = 0; world->joints.live > 0 && i < world->joints.awake_count; ++i) {
        const uint32_t slot = ((const uint32_t *)world->joints.awake.data)[i];
        const pl_joint *j = &pl_joint_items(&world->joints)[slot];
        const uint32_t a = pl_joint_row(world, &j->a), b = pl_joint_row(world, &j->b);
        const uint32_t row = is_dynamic(world, a) ? a : b;
        const double motor = motor_of(world, j);
        drive(world, row, motor + carried(world, a) + carried(world, b));
        if (motor < HUGE_VAL) {
            world->watchdog.given = pl_more(world->watchdog.given, motor);
        }
        if (is_dynamic(world, row)) {
            island_of(world, row)->gained += pl_joint_stored(world, j) - stored[slot];
        }
    }
}

//---- the verdict ---------------------------------------------------------------------------------

// The work that brought a row most; "" in a world that does not measure.
static const char *work_of(const plumb_world *world, uint32_t row)
{
    const uint32_t *slots = world->solver.slots.data;
    if (!world->desc.measure || slots[row] == PL_NONE) {
        return "";
    }
    static const char *const names[] = {
#define NAME_OF(NAME, name, text) #name,
        PLUMB_WORK_LIST(NAME_OF)
#undef NAME_OF
    };
    const pl_measured_body *m = (const pl_measured_body *)world->measure.bodies.data + slots[row];
    int most = 0;
    for (int i = 1; i < PLUMB_WORKS; ++i) {
        most = m->work[i].kinetic > m->work[most].kinetic ? i : most;
    }
    return names[most];
}

// [J] more that what drives an island, and its overlaps, may have given.
static double lent(const plumb_world *world, const pl_watched_island *i, double dt)
{
    const double g = pl_length((double)world->gravity.x, (double)world->gravity.y);
    const double lifted = pl_less(pl_more(i->deepest, 0), (double)world->desc.push_speed * dt);
    return i->mass * (2 * i->driven * (i->driven + i->fastest + g * dt) + g * lifted);
}

void pl_watch_energy_after(plumb_world *world, real dt)
{
    const char *unused;
    const bool known =
        world->desc.measure || (world->systems.in_substeps == 0 && world->laws.count == 0 &&
                                world->settings.engines == 0 && !pl_want_fluids(world, &unused));
    if (world->solver.slot_count == 0) {
        return;
    }
    find_islands(world);
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        add_row(world, row, dt);
    }
    drive_by_contacts(world);
    drive_by_joints(world);
    const uint32_t *leaders = world->watchdog.leaders.data;
    for (uint32_t row = 0; known && row < world->dynamic_count; ++row) {
        const pl_watched_island *i = &islands(world)[row];
        if (leaders[row] != row || !(i->mass > 0) || !(i->driven < HUGE_VAL)) {
            continue;
        }
        const double share =
            (i->gained - i->known - lent(world, i, (double)dt)) / (i->kinetic + i->mass / 2);
        if (share > pl_watchdog_bound(PLUMB_ALARM_ENERGY_JUMP)) {
            pl_watchdog_tell(world, &(pl_finding){ .kind = PLUMB_ALARM_ENERGY_JUMP,
                                                   .row = i->worst,
                                                   .other = PL_NONE,
                                                   .value = share,
                                                   .pass = pl_watchdog_solver(world),
                                                   .work = work_of(world, i->worst) });
        }
    }
}
