// dial.c - which solver and how many substeps a world with a tolerance takes, by the error that it foresees and finds.
//
// Motion: swings are what substeps get wrong, by the square of the angle in a substep; how fast things swing follows from the
// accelerations and speeds of late. Rest: overlaps and gaps of joints, over the smallest body, fall as
// the square of the substep, too; where many would be needed, or masses differ much, joints are solved together, or all is, by
// the exact solver. What a step holds still while it turns (frozen.c) no substep mends: it is told.
//
// Reads: solver bodies, manifolds, joints. Writes: settings of the world, its dial. Order: begin at the head of the step; look
// behind the substeps. Cost: O(solver bodies + contacts + joints).
#include "accuracy/dial.h"

#include "joints/measure.h"
#include "math/decay.h"
#include "solver/solver.h"

#include <math.h>

const pl_dial_fit pl_dial_constants = {
    .safety = 0.5,
    .turn = 1.57,
    .swing = 1.0 / 24,
    .lag = 0.5,
    .lag_time = 1,
    .begun = 2.5,
    .speed_time = 2,
    .push_time = 1,
    .calm_time = 20,
    .least_way = 0.02,
    .rest_way = 0.1,
    .loose_share = 2,
    .loose_time = 0.1,
    .loose_most = 8,
    .heavy = 50,
    .frozen = 0.7,
    .graze = 5e-4,
    .struck = 2,
    .rounding = sizeof(near_real) == 4 ? 1.2e-7 : 2.2e-16,
    .few_most = 300,
    .least = 4,
    .most = sizeof(near_real) == 4 ? 32 : 64,
};

#define FIT          (&pl_dial_constants)
#define PL_DIAL_ANEW 2 // times that a step may be taken anew

//---- what was chosen -----------------------------------------------------------------------------

void pl_dial_reset(plumb_world *world)
{
    const plumb_world_desc *desc = &world->desc;
    world->dial = (pl_dial){ .need = desc->substeps,
                             .tier = desc->solver == PLUMB_SOLVER_EXACT ? PL_DIAL_EXACT
                                     : desc->direct_joints              ? PL_DIAL_DIRECT
                                                                        : PL_DIAL_SWEPT };
}

void pl_dial_apply(plumb_world *world)
{
    if (!pl_dial_is_on(world)) {
        return;
    }
    const pl_dial *d = &world->dial;
    plumb_world_desc *desc = &world->desc;
    const plumb_solver solver = d->tier == PL_DIAL_EXACT ? PLUMB_SOLVER_EXACT : PLUMB_SOLVER_SOFT;
    const bool direct = d->tier == PL_DIAL_DIRECT;
    if (desc->solver != solver || desc->direct_joints != direct) {
        desc->solver = solver;
        desc->direct_joints = direct;
        desc->iterations = 1;
        world->schedule_dirty = true;
    }
    const double wanted = ceil(d->need - 0.05);
    desc->substeps = wanted < FIT->least  ? FIT->least
                     : wanted > FIT->most ? FIT->most
                                          : (int)wanted;
}

void pl_dial_begin(plumb_world *world, real dt)
{
    if (pl_dial_is_on(world) && dt > 0) {
        world->dial.elapsed += (double)dt;
        ++world->dial.steps;
        pl_dial_apply(world);
    }
}

//---- how fast things are -------------------------------------------------------------------------

// Radius of the smallest body that the solver moves [m].
static double smallest(const plumb_world *world)
{
    const uint32_t *rows = world->solver.rows.data;
    double least = 0;
    for (uint32_t i = 0; i < world->solver.dynamic_slots; ++i) {
        const double r = (double)world->bodies.extent[rows[i]];
        least = r > 0 && (least == 0 || r < least) ? r : least;
    }
    return least;
}

// Fastest of all, of now and of late, and what is accelerated most, by contacts and joints, too.
static double look_at_motion(plumb_world *world, double dt)
{
    pl_dial *d = &world->dial;
    const pl_bodies *b = &world->bodies;
    const uint32_t *rows = world->solver.rows.data;
    double fastest = 0, pushed = 0;
    for (uint32_t i = 0; i < world->solver.dynamic_slots; ++i) {
        const pl_solver_body *body = &pl_solver_bodies(&world->solver)[i];
        const uint32_t row = rows[i];
        const double r = (double)b->extent[row];
        const double vx = (double)body->vx, vy = (double)body->vy, w = (double)body->w;
        const double dx = vx - (double)b->vx[row], dy = vy - (double)b->vy[row];
        const double speed = sqrt(vx * vx + vy * vy) + r * fabs(w);
        const double push = (sqrt(dx * dx + dy * dy) + r * fabs(w - (double)b->w[row])) / dt;
        fastest = speed > fastest ? speed : fastest;
        pushed = push > pushed ? push : pushed;
    }
    const double kept = d->speed * pl_decay_of(dt / FIT->speed_time).left;
    d->speed = fastest > kept ? fastest : kept;
    if (world->solver.bounce_count > 0) {
        return fastest; // blows are events of their own
    }
    // A mean over what has been so far, at first.
    const double time = d->elapsed < FIT->push_time ? d->elapsed : FIT->push_time;
    d->push += (pushed - d->push) * (dt < time ? dt / time : 1);
    return fastest;
}

// All are kicked in halves about the drift (solver/halves.c), but for some assemblies of joints (joints/assembly.c).
static double lag_of(const plumb_world *world)
{
    const bool whole = world->dial.tier != PL_DIAL_EXACT && world->joints.plan.any_whole;
    return whole ? FIT->lag : 0;
}

// [rad/s] at which things turn round, by accelerations and speeds of late.
static double turn_rate(const pl_dial *d)
{
    return d->speed > 0 ? FIT->turn * d->push / d->speed : 0;
}

// [rad/s] of what swings; 0: nothing has turned yet, or all rests. `now` [m/s]: the fastest.
static double swing_rate(const plumb_world *world, double now)
{
    const pl_dial *d = &world->dial;
    if (!(now > FIT->least_way * smallest(world)) || !(now > 0)) {
        return 0;
    }
    const double rate = turn_rate(d);
    const bool begun = rate * d->elapsed >= FIT->begun;
    const double least = lag_of(world) > 0 ? FIT->turn / FIT->lag_time : 0;
    return begun && rate > least ? rate : least;
}

//---- what bears on what --------------------------------------------------------------------------

static bool bears(const plumb_world *world, const pl_manifold *m)
{
    const pl_pair *pair = pl_pair_of(world, m);
    return (pair->normal[0] > 0 || pair->normal[1] > 0) && !pl_bounces(m);
}

static double ratio_of(const plumb_world *world, uint32_t a, uint32_t b)
{
    if (a >= world->dynamic_count || b >= world->dynamic_count) {
        return 1;
    }
    const double one = (double)world->bodies.mass[a], two = (double)world->bodies.mass[b];
    return one > two ? one / two : two / one;
}

static bool rests(const plumb_world *world, uint32_t row)
{
    if (row >= world->dynamic_count) {
        return false;
    }
    const uint32_t slot = ((const uint32_t *)world->solver.slots.data)[row];
    if (slot == PL_NONE) {
        return false;
    }
    const pl_solver_body *body = &pl_solver_bodies(&world->solver)[slot];
    const double r = (double)world->bodies.extent[row];
    const double vx = (double)body->vx, vy = (double)body->vy;
    return sqrt(vx * vx + vy * vy) + r * fabs((double)body->w) < FIT->rest_way * r;
}

// What asks for one tier or the other.
typedef struct finding {
    double ratio;           // [-] largest of masses that bear on one another
    bool resting;           // a body rests on two points
    bool touching;          // a contact bears
    uint32_t joints, links; // of these, between two bodies that move
    bool springs;           // better with the sweeps: exact/DECISIONS.md
    double deep;            // [m] deepest overlap of what bears, as the step began
} finding;

static finding find(const plumb_world *world)
{
    finding f = { .ratio = 1 };
    const pl_manifold *m = pl_manifolds(&world->narrow);
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        if (bears(world, &m[i])) {
            const double ratio = ratio_of(world, m[i].body_a, m[i].body_b);
            f.ratio = ratio > f.ratio ? ratio : f.ratio;
            const near_real first = m[i].point[0].separation, second = m[i].point[1].separation;
            const double deep = -(double)(first < second ? first : second);
            f.deep = deep > f.deep ? deep : f.deep;
            f.touching = true;
            f.resting = f.resting || (m[i].count == 2 &&
                                      (rests(world, m[i].body_a) || rests(world, m[i].body_b)));
        }
    }
    const pl_joint_mark *marks = pl_joint_marks(&world->joints);
    for (uint32_t i = 0; world->joints.live > 0 && i < world->joints.count; ++i) {
        if (marks[i].what != 0) {
            const plumb_joint_desc *j = &pl_joint_items(&world->joints)[i].desc;
            const double ratio = ratio_of(world, marks[i].row_a, marks[i].row_b);
            f.ratio = ratio > f.ratio ? ratio : f.ratio;
            f.springs = f.springs || pl_joint_has_spring(j);
            f.links +=
                marks[i].row_a < world->dynamic_count && marks[i].row_b < world->dynamic_count;
            ++f.joints;
        }
    }
    return f;
}

// Overlaps as the step began and gaps of joints, in sizes of the smallest body, mean of late.
static void look_at_rest(plumb_world *world, const finding *f, double dt)
{
    pl_dial *d = &world->dial;
    plumb_measures m = { .step = 0 };
    const double size = 2 * smallest(world);
    if (world->joints.live > 0) {
        pl_joints_errors(world, &m);
    }
    const double apart = m.joint_length * (f->links + 1); // along a chain they add up
    const double off = apart > f->deep ? apart : f->deep;
    const bool missed = d->tier == PL_DIAL_EXACT && world->exact.missed > 0;
    const double left = missed ? world->exact.residual : 0;
    const double lies = size > 0 ? off / size : 0, now = lies > left ? lies : left;
    d->loose += (now - d->loose) * (dt < FIT->loose_time ? dt / FIT->loose_time : 1);
    d->rest = d->loose / FIT->loose_share;
}

//---- choice --------------------------------------------------------------------------------------

// The tier that what was found asks for, and why.
static pl_dial_tier tier_for(const plumb_world *world, const finding *f, pl_dial_reason *why)
{
    const pl_dial *d = &world->dial;
    const bool heavy = f->ratio > FIT->heavy;
    const bool loose = d->rest > (double)world->desc.tolerance && d->tier != PL_DIAL_EXACT &&
                       world->desc.substeps >= FIT->loose_most;
    const bool few = world->narrow.manifold_count + f->joints <= FIT->few_most;
    *why = heavy         ? PL_DIAL_HEAVY
           : loose       ? PL_DIAL_LOOSE
           : f->touching ? PL_DIAL_RESTING
                         : PL_DIAL_TIED;
    if (f->springs) {
        return PL_DIAL_SWEPT;
    }
    if (f->touching) {
        const bool stays = d->tier == PL_DIAL_EXACT && (d->reason == PL_DIAL_LOOSE || heavy);
        return heavy || loose || stays || (f->resting && few) ? PL_DIAL_EXACT : PL_DIAL_SWEPT;
    }
    if (d->tier == PL_DIAL_EXACT && d->reason != PL_DIAL_RESTING) {
        return PL_DIAL_EXACT; // in the air for a while
    }
    if (!((f->joints >= 2 && f->links >= 1) || heavy || (loose && f->joints > 0))) {
        return PL_DIAL_SWEPT;
    }
    // Loops of joints that are solved directly lag by half a substep (joints/assembly.c); those of the exact solver do not.
    const bool lags = d->tier == PL_DIAL_DIRECT && world->joints.plan.any_whole;
    return lags && few ? PL_DIAL_EXACT : PL_DIAL_DIRECT;
}

static double substeps_for(const plumb_world *world, double dt, double rate)
{
    const double aim = FIT->safety * (double)world->desc.tolerance;
    const double lag = dt * lag_of(world) * rate / aim;
    const double turn = dt * sqrt(FIT->swing * rate * rate * rate * PLUMB_ACCURACY_HORIZON / aim);
    // A limit is struck with the speed of a parabola, under the pull of the substep before.
    const double struck =
        world->joints.bouncing > 0 ? dt * turn_rate(&world->dial) * sqrt(FIT->struck / aim) : 0;
    const double most = lag > turn ? lag : turn;
    return most > struck ? most : struck;
}

// True: the step is to be taken anew, by another tier.
static bool choose(plumb_world *world, const finding *f, double dt, double rate)
{
    pl_dial *d = &world->dial;
    pl_dial_reason why;
    const pl_dial_tier tier = tier_for(world, f, &why);
    if (tier != d->tier) {
        const bool better = tier > d->tier;
        d->tier = tier;
        d->reason = tier == PL_DIAL_SWEPT ? PL_DIAL_EASY : why;
        d->loose = 0; // what the other left is not this one's
        d->need = FIT->least;
        return better && world->quarantine.attempt < PL_DIAL_ANEW;
    }
    const double n = world->desc.substeps;
    const double moving = substeps_for(world, dt, rate);
    const double resting =
        d->tier == PL_DIAL_SWEPT ? n * sqrt(d->rest / (double)world->desc.tolerance) : 0;
    const double asked = moving > resting ? moving : resting;
    const double calmed = d->need * pl_decay_of(dt / FIT->calm_time).left;
    if (asked > calmed && d->tier == PL_DIAL_SWEPT) {
        d->reason = asked > FIT->most     ? PL_DIAL_MOST
                    : asked <= FIT->least ? PL_DIAL_EASY
                    : moving > resting    ? PL_DIAL_MOTION
                                          : PL_DIAL_REST;
    }
    d->need = asked > calmed ? asked : calmed;
    d->need = d->need < FIT->least ? FIT->least : d->need > 2 * FIT->most ? 2 * FIT->most : d->need;
    return false;
}

//---- errors --------------------------------------------------------------------------------------

static void add_errors(plumb_world *world, double dt, double rate)
{
    pl_dial *d = &world->dial;
    const double turn = rate * dt / world->desc.substeps;
    const double left = pl_decay_of(dt / PLUMB_ACCURACY_HORIZON).left;
    const double lag = lag_of(world) * turn;
    if (lag > 0) { // it does not add up: it is there as long as this goes on
        const double all = lag + FIT->swing * turn * turn * rate * PLUMB_ACCURACY_HORIZON;
        d->motion += (all - d->motion) * (dt < FIT->lag_time ? dt / FIT->lag_time : 1);
    } else {
        d->motion = d->motion * left + FIT->swing * turn * turn * rate * dt;
    }
    d->frozen =
        d->frozen * left + pl_dial_frozen(world, dt) + FIT->rounding * world->solver.chain_count;
}

static void tell(plumb_world *world)
{
    pl_dial *d = &world->dial;
    const double tolerance = (double)world->desc.tolerance;
    const double error = pl_dial_error(d);
    d->worst = error > d->worst ? error : d->worst;
    if (d->worst > tolerance && !d->told) {
        d->told = true;
        pl_warn(world,
                "plumb_world_step: the error is about %.2g by now, more than the tolerance of %g "
                "(told once; "
                "plumb_world_accuracy has more)",
                error, tolerance);
    }
}

bool pl_dial_look(plumb_world *world, real dt)
{
    if (!pl_dial_is_on(world)) {
        return false;
    }
    const pl_dial before = world->dial;
    world->dial.solved += (uint64_t)world->desc.substeps;
    const double now = look_at_motion(world, (double)dt);
    const finding f = find(world);
    const double rate = swing_rate(world, now);
    look_at_rest(world, &f, (double)dt);
    if (choose(world, &f, (double)dt, rate)) {
        const pl_dial chosen = world->dial;
        world->dial = before;
        world->dial.tier = chosen.tier;
        world->dial.reason = chosen.reason;
        world->dial.loose = 0;
        world->dial.solved = chosen.solved;
        return true;
    }
    add_errors(world, (double)dt, rate);
    tell(world);
    return false;
}
