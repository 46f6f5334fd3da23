// hub.c - which joints are solved together (direct.c) although nobody asked: those of assemblies that sweeps cannot hold.
//
// A round of sweeps leaves G e of an error e of the impulses. As each substep begins with the impulses of the one before, a mode of
// G of the eigenvalue g goes on by mu^2 - 2 g mu + g = 0. That dies away for any g from 0 to 1, if slowly near 1; but where three
// joints and more meet at one body g is complex, and from |g| = 1/3 on such a mode may grow. Six boxes welded to one flew apart; more
// substeps made it worse.
//
// What tells is how much of what gives way at a joint is one of its bodies. Let k be the most by which that body moves under a push
// between the two, over what the other one moves; it adds the square of k / (1 + k). Equal links of a chain have 1/2, discs of a
// net 1, ragdolls 0.9; a link between two of its mass that bears much more has 5/4, equal boxes in a row of welds 1.7. Beyond MOST
// an assembly is solved together, whole: in part, what is solved and what is swept feed one another (DECISIONS.md).
//
// A body that nothing moves has all of that: what is held there so that it does not turn, turns to a bound or by a spring, counts as 1. What
// may turn counts as HINGED, so that a light link between the world and what is 20 times as heavy counts, and a chain does not. And where what must not turn is held far beside its centre, its
// turn and its way are nearly one direction: it is solved as it stands, however few they are.
//
// Cables push at their rims, the others at their anchors.
//
// The rule asks for masses and for places on the bodies alone, never for poses, so that a plan can be kept.
//
// Reads: marks with assemblies, joints, masses. Writes: marks. Order: before joints get colours. Cost: O(joints) where a plan is made.
#include "joints/joint.h"
#include "core/fill.h"
#include "plumb/math.h"
#include "world/state.h"

#define MOST 1.1

// [-] lever_share up to which sweeps hold what must not turn: that of a crate of 1 m held at a point 1.8 m away, and, as springs are
// more exact where they are swept, of one with a spring 13 m away.
#define FAR        20
#define FAR_SPRUNG 1000

#define HINGED 0.2

// What is swept all the same, for the factor of it would take longer than all the rest: nets of more joints, and bodies of so many
// (the sum of cubes is three times the blocks that one elimination multiplies).
#define MOST_OF_NET 150u
#define MOST_CUBES  60000u

// A body of a joint: inverse mass and inertia, and where its anchor is from its centre.
typedef struct end {
    double inv_mass, inv_inertia;
    plumb_vec2 arm; // [m] in its own frame
    double rim;     // [m] of a cable: by how much its push passes the anchor
} end;

static end end_of(const plumb_world *world, const pl_joint_end *e, uint32_t row, plumb_real rim)
{
    const pl_bodies *b = &world->bodies;
    return (end){ (double)b->inv_mass[row], (double)b->inv_inertia[row],
                  plumb_v2(e->local.x - b->local_x[row], e->local.y - b->local_y[row]),
                  (double)rim };
}

static double square(plumb_vec2 v)
{
    return (double)v.x * (double)v.x + (double)v.y * (double)v.y;
}

// k / (1 + k) of what holds the other's place and turn. k is but for a hundredth the other's mass and inertia about the centre of
// this one, over its own. `apart` [m^2]: square of the way from centre to centre.
static double held_share(const end *self, const end *other, double apart)
{
    const double k = self->inv_mass / other->inv_mass +
                     (apart / other->inv_mass + 1 / other->inv_inertia) * self->inv_inertia;
    return k < 1e12 ? k / (1 + k) : 1;
}

// [m^2] twice the square of the lever, in the mean of all directions.
static double lever_of(const end *e)
{
    return square(e->arm) + 2 * e->rim * e->rim;
}

// The same of what holds a point: k in the mean of all directions, for the bodies turn.
static double hinged_share(const end *self, const end *other)
{
    const double of_self = 2 * self->inv_mass + lever_of(self) * self->inv_inertia;
    const double of_other = 2 * other->inv_mass + lever_of(other) * other->inv_inertia;
    return of_self > 0 ? of_self / (of_self + of_other) : 0;
}

typedef enum what_holds { NOTHING, PLACE, PLACE_AND_TURN } what_holds;

static what_holds held_by(const plumb_joint_desc *d)
{
    const bool sprung = pl_joint_has_spring(d);
    switch (d->kind) {
    case PLUMB_WELD:
        return sprung ? PLACE : PLACE_AND_TURN;
    case PLUMB_PRISMATIC:
        return PLACE_AND_TURN;
    case PLUMB_REVOLUTE:
    case PLUMB_WHEEL:
        return PLACE;
    case PLUMB_MOTOR: // rigid and without a bound it is a weld
        return sprung || d->max_force > 0 ? NOTHING : d->max_torque > 0 ? PLACE : PLACE_AND_TURN;
    case PLUMB_CABLE:
        return PLACE;
    case PLUMB_DISTANCE:
        return sprung ? NOTHING : PLACE;
    default:
        return NOTHING;
    }
}

// [m^2] from A's centre to B's, squared, as they were when the joint was made.
static double apart_of(const pl_joint *j, const end *a, const end *b)
{
    const plumb_rot turn = plumb_rot_make((real)(j->b.start - j->a.start));
    const plumb_vec2 back = plumb_rot_apply(turn, b->arm);
    return square(plumb_v2(a->arm.x - back.x, a->arm.y - back.y));
}

static bool slides_freely(const plumb_joint_desc *d)
{
    return d->kind == PLUMB_WHEEL && !d->enable_limit && !pl_joint_has_spring(d);
}

// Of a joint to what nothing moves.
static double share_of_world(const plumb_joint_desc *d, what_holds holds)
{
    if (holds == NOTHING) {
        return d->kind == PLUMB_RATCHET ? 1 : 0;
    }
    return holds == PLACE_AND_TURN || d->enable_limit || pl_joint_has_spring(d) ? 1 : HINGED;
}

// [-] by how much more a push at the anchor moves it through the turn of its body than through its way.
static double lever_share(const plumb_world *world, const pl_joint_end *e, uint32_t row)
{
    const end at = end_of(world, e, row, 0);
    return square(at.arm) * at.inv_inertia / at.inv_mass;
}

// What each body has of the joint whatever the other one is like: held far beside its centre, or at the world.
static void add_own_shares(const plumb_world *world, const pl_joint *j, const pl_joint_mark *m,
                           what_holds holds, pl_hub *hubs)
{
    const uint32_t movable = world->dynamic_count;
    const uint32_t rows[2] = { m->row_a, m->row_b };
    const pl_joint_end *ends[2] = { &j->a, &j->b };
    const double of_world = share_of_world(&j->desc, holds);
    const double far = pl_joint_has_spring(&j->desc) ? FAR_SPRUNG : FAR;
    for (int k = 0; k < 2; ++k) {
        if (rows[k] < movable) {
            const bool is_far =
                holds == PLACE_AND_TURN && lever_share(world, ends[k], rows[k]) > far;
            hubs[rows[k]].share += is_far ? 2 * MOST : rows[1 - k] >= movable ? of_world : 0;
        }
    }
}

static void add_shares(const plumb_world *world, const pl_joint *j, const pl_joint_mark *m,
                       pl_hub *hubs)
{
    const what_holds holds = held_by(&j->desc);
    add_own_shares(world, j, m, holds, hubs);
    if (holds == NOTHING || m->row_a >= world->dynamic_count || m->row_b >= world->dynamic_count) {
        return;
    }
    const end a = end_of(world, &j->a, m->row_a, j->desc.radius_a);
    const end b = end_of(world, &j->b, m->row_b, j->desc.radius_b);
    const double apart = holds == PLACE_AND_TURN ? apart_of(j, &a, &b) : 0;
    if (slides_freely(&j->desc)) { // its arms are as long as its way, which ends nowhere
        hubs[m->row_a].share += 2 * MOST;
        return;
    }
    const double of_a = holds == PLACE ? hinged_share(&a, &b) : held_share(&a, &b, apart);
    const double of_b = holds == PLACE ? hinged_share(&b, &a) : held_share(&b, &a, apart);
    hubs[m->row_a].share += of_a * of_a;
    hubs[m->row_b].share += of_b * of_b;
}

// Bodies: their shares and joints. Assemblies, which have the number of a body: their joints.
static void tally_joints(const plumb_world *world, pl_hub *hubs)
{
    const pl_joint_mark *marks = pl_joint_marks(&world->joints);
    for (uint32_t i = 0; i < world->joints.count; ++i) {
        const pl_joint_mark *m = &marks[i];
        if (m->what == 0 || m->assembly == PL_NONE) {
            continue;
        }
        add_shares(world, &pl_joint_items(&world->joints)[i], m, hubs);
        hubs[m->assembly].joints_of_all++;
        const uint32_t rows[2] = { m->row_a, m->row_b };
        for (int k = 0; k < 2; ++k) {
            if (rows[k] < world->dynamic_count) {
                hubs[rows[k]].assembly = m->assembly;
                hubs[rows[k]].joints++;
            }
        }
    }
}

// Assemblies: what their bodies add up to.
static void tally_bodies(const plumb_world *world, pl_hub *hubs)
{
    for (uint32_t row = 0; row < world->dynamic_count; ++row) {
        const pl_hub *body = &hubs[row];
        if (body->joints > 0) {
            pl_hub *all = &hubs[body->assembly];
            const double n = (double)body->joints;
            all->bodies++;
            all->most = body->share > all->most ? body->share : all->most;
            all->cubes += n * n * n;
        }
    }
}

static bool is_together(const pl_hub *all)
{
    const uint32_t loops = all->joints_of_all > all->bodies ? all->joints_of_all - all->bodies : 0;
    const bool net = loops > all->joints_of_all / 8 && all->joints_of_all > MOST_OF_NET;
    return all->most > MOST && !net && all->cubes < MOST_CUBES + 27.0 * all->joints_of_all;
}

void pl_joints_find_hubs(plumb_world *world)
{
    pl_joint_plan *plan = &world->joints.plan;
    pl_joint_mark *marks = plan->marks.data;
    pl_hub *hubs = plan->hubs.data;
    const bool soft = world->desc.solver == PLUMB_SOLVER_SOFT;
    pl_fill(hubs, 0, world->dynamic_count * sizeof *hubs);
    tally_joints(world, hubs);
    tally_bodies(world, hubs);
    plan->any_direct = false;
    for (uint32_t i = 0; i < world->joints.count; ++i) {
        pl_joint_mark *m = &marks[i];
        m->direct = soft && m->what != 0 &&
                    (world->desc.direct_joints ||
                     (m->assembly != PL_NONE && is_together(&hubs[m->assembly])));
        plan->any_direct |= m->direct;
    }
}
