// wanted.c - which passes a world wants, and why.
//
// Asked only when something structural changed (world->schedule_dirty). Reads: counters that structural changes keep
// up. Writes: nothing. Cost: O(materials) a pass at most.
#include "character/character.h"
#include "continuous/continuous.h"
#include "internal_edges/internal_edges.h"
#include "joints/joint.h"
#include "narrow/one_way.h"
#include "narrow/surface.h"
#include "solver/solver.h"
#include "step/acting.h"
#include "step/pass.h"
#include "step/system.h"
#include "world/wrap.h"

typedef bool want_fn(const plumb_world *world, const char **reason);

static bool say(bool wanted, const char **reason, const char *because, const char *because_not)
{
    *reason = wanted ? because : because_not;
    return wanted;
}

bool pl_want_targets(const plumb_world *world, const char **reason)
{
    return say(world->targets.count + world->tracks.count > 0, reason,
               "kinematic bodies are on their way to a target", "no kinematic body has a target");
}

bool pl_want_tracks(const plumb_world *world, const char **reason)
{
    return say(world->tracks.count > 0, reason, "kinematic bodies will arrive with a velocity",
               "no kinematic body will arrive with a velocity");
}

bool pl_want_damping(const plumb_world *world, const char **reason)
{
    return say(world->settings.damped > 0, reason, "some body is damped", "no body is damped");
}

bool pl_want_caps(const plumb_world *world, const char **reason)
{
    return say(world->settings.capped > 0, reason, "some body has a speed cap",
               "no body has a speed cap");
}

static bool want_own_time(const plumb_world *world, const char **reason)
{
    return say(world->settings.scaled > 0, reason, "some body has a time scale of its own",
               "all bodies move in the world's time");
}

static bool want_locks(const plumb_world *world, const char **reason)
{
    return say(world->locked_bodies > 0, reason, "some body has a locked axis",
               "no body has a locked axis");
}

// Something dynamic has a shape, and there is something to meet; or pairs are left that have to end.
bool pl_want_collision(const plumb_world *world, const char **reason)
{
    bool wanted = world->dynamic_count > 0 && world->moving_count > 0 && world->pieces.live > 1;
    wanted |= world->broad.pairs.count > 0 || world->parts.count > 0;
    return say(wanted, reason, "dynamic bodies have shapes that can meet others",
               "no awake dynamic body has a shape that could meet another");
}

// A sensor that something could meet, or what it saw has to be forgotten.
bool pl_want_sensing(const plumb_world *world, const char **reason)
{
    bool wanted = world->sensor_pieces > 0 && world->moving_count > 0 && world->pieces.live > 1;
    return say(wanted || world->sensing.count > 0 || world->sensing.rest_stale, reason,
               "there are sensors", "no shape is a sensor that could meet another");
}

// One of the two: with the reason of the one that is wanted, else of the first.
static bool either(const plumb_world *world, const char **reason, want_fn *first, want_fn *second)
{
    const char *other;
    if (first(world, reason)) {
        return true;
    }
    const bool wanted = second(world, &other);
    *reason = wanted ? other : *reason;
    return wanted;
}

static bool want_pairs(const plumb_world *world, const char **reason)
{
    return either(world, reason, pl_want_collision, pl_want_sensing);
}

// Soft bodies look for what is near them in its grids.
bool pl_want_broad(const plumb_world *world, const char **reason)
{
    return either(world, reason, want_pairs, pl_want_softbodies);
}

bool pl_want_surfaces(const plumb_world *world, const char **reason)
{
    return pl_want_collision(world, reason) && pl_surfaces_wanted(world, reason);
}

static bool want_one_way(const plumb_world *world, const char **reason)
{
    return pl_want_collision(world, reason) && pl_one_way_wanted(world, reason);
}

bool pl_want_feet(const plumb_world *world, const char **reason)
{
    return pl_want_collision(world, reason) && pl_characters_wanted(world, reason);
}

bool pl_want_internal_edges(const plumb_world *world, const char **reason)
{
    return pl_want_collision(world, reason) && pl_internal_edges_wanted(world, reason);
}

bool pl_want_joints(const plumb_world *world, const char **reason)
{
    if (world->joints.live > 0 && !pl_joints_any_awake(world)) {
        return say(false, reason, "", "all that is joined sleeps");
    }
    return say(world->joints.live > 0, reason, "there are joints", "there are no joints");
}

bool pl_want_waking(const plumb_world *world, const char **reason)
{
    // Contacts of one that was destroyed in its sleep have to end.
    return say(world->asleep_count > 0 || world->softbodies.asleep_count > 0 ||
                   world->sleep.first_due != PL_NONE,
               reason, "some bodies sleep: what touches them wakes them", "no body sleeps");
}

bool pl_want_sleep(const plumb_world *world, const char **reason)
{
    if (world->desc.no_sleep) {
        return say(false, reason, "", "the world does not let bodies sleep");
    }
    const bool soft = world->softbodies.count > world->softbodies.asleep_count;
    return say(world->dynamic_count > 0 || soft, reason, "what rests long enough falls asleep",
               "no dynamic body is awake");
}

bool pl_want_edges(const plumb_world *world, const char **reason)
{
    return say(pl_is_wrapped(world), reason, "the world wraps around", "the world does not wrap");
}

// Contacts, joints, or what acts on bodies in the substeps.
bool pl_want_solver(const plumb_world *world, const char **reason)
{
    return pl_want_joints(world, reason) ||
           either(world, reason, pl_want_collision, pl_want_called);
}

static bool asks_for(const plumb_world *world, plumb_solver solver, const char **reason)
{
    static const char *const asked[] = { "the world asks for the soft step",
                                         "the world asks for the classic solver",
                                         "the world asks for the exact solver" };
    *reason = asked[world->desc.solver];
    return world->desc.solver == solver;
}

bool pl_want_soft(const plumb_world *world, const char **reason)
{
    return pl_want_solver(world, reason) && asks_for(world, PLUMB_SOLVER_SOFT, reason);
}

bool pl_want_classic(const plumb_world *world, const char **reason)
{
    return pl_want_solver(world, reason) && asks_for(world, PLUMB_SOLVER_PGS, reason);
}

bool pl_want_exact(const plumb_world *world, const char **reason)
{
    return pl_want_solver(world, reason) && asks_for(world, PLUMB_SOLVER_EXACT, reason);
}

static bool wants_hard_islands(const plumb_world *world, const char **reason)
{
    return pl_want_soft(world, reason) &&
           say(PL_HAS(EXACT) && !world->desc.no_exact_islands, reason,
               "small islands that sweeps cannot hold are solved exactly",
               "the world wants no island to be solved exactly");
}

bool pl_want_apart(const plumb_world *world, const char **reason)
{
    return wants_hard_islands(world, reason) ||
           (pl_want_soft(world, reason) && say(!world->desc.no_fine_islands, reason,
                                               "islands of a small world take finer substeps",
                                               "the world wants no island to be solved apart"));
}

bool pl_want_direct(const plumb_world *world, const char **reason)
{
    return world->desc.solver == PLUMB_SOLVER_SOFT ? wants_hard_islands(world, reason)
                                                   : pl_want_exact(world, reason);
}

bool pl_want_continuous(const plumb_world *world, const char **reason)
{
    return pl_want_collision(world, reason) && pl_continuous_wanted(world, reason);
}

// A material that some shape is made of.
static bool any_material(const plumb_world *world, const real *column)
{
    for (uint32_t row = 0; row < world->materials.table.count; ++row) {
        if (world->materials.users[row] > 0 && column[row] != 0) {
            return true;
        }
    }
    return false;
}

static bool want_adhesion(const plumb_world *world, const char **reason)
{
    return say(any_material(world, world->materials.adhesion) || world->material_pair_count > 0,
               reason, "some shape's material may stick", "no shape's material sticks");
}

static bool want_friction(const plumb_world *world, const char **reason)
{
    return say(any_material(world, world->materials.friction), reason,
               "some shape's material has friction", "no shape's material has friction");
}

// Systems that edit contacts, and pairs of materials, may ask for it as well.
bool pl_want_impacts(const plumb_world *world, const char **reason)
{
    if (!pl_want_collision(world, reason)) {
        return false;
    }
    return say(any_material(world, world->materials.restitution) ||
                   world->material_pair_count > 0 || pl_system_sees_contacts(world),
               reason, "some shape's material has restitution",
               "no shape's material has restitution");
}

bool pl_want_moment(const plumb_world *world, const char **reason)
{
    if (!pl_want_collision(world, reason)) {
        return false;
    }
    return say(world->desc.solver == PLUMB_SOLVER_SOFT, reason,
               "the soft step makes contacts that turn anew within the step",
               "the soft step alone makes contacts anew within the step");
}

bool pl_want_gravity(const plumb_world *world, const char **reason)
{
    return say(world->gravity.x != 0 || world->gravity.y != 0, reason, "the world has gravity",
               "the world has no gravity");
}

bool pl_want_reactions(const plumb_world *world, const char **reason)
{
    if (!pl_want_joints(world, reason)) {
        return false;
    }
    return say(world->joints.watched > 0, reason,
               "some joint breaks, or tells of its strain or impulse",
               "no joint breaks, or tells of its strain or impulse");
}

bool pl_want_strikes(const plumb_world *world, const char **reason)
{
    if (!pl_want_joints(world, reason)) {
        return false;
    }
    return say(world->joints.bouncing > 0, reason, "some joint's limit bounces",
               "no joint's limit bounces");
}

bool pl_want_sums(const plumb_world *world, const char **reason)
{
    if (!pl_want_collision(world, reason)) {
        return false;
    }
    return say(pl_solver_tallies(world) || world->desc.solver != PLUMB_SOLVER_SOFT, reason,
               "impulses are added up over the step",
               "nobody asked for impulses of contacts or for hits");
}

//---- variants -----------------------------------------------------------------------------------

static void add_variant(pl_variants *v, bool is, const char *name)
{
    if (is && v->count < PL_VARIANTS_MAX) {
        v->names[v->count++] = name;
    } else if (!is && v->away_count < PL_VARIANTS_MAX) {
        v->away[v->away_count++] = name;
    }
}

void pl_contact_variants(const plumb_world *world, pl_variants *v)
{
    const char *unused;
    const bool soft = world->desc.solver == PLUMB_SOLVER_SOFT;
    const pl_materials *m = &world->materials;
    add_variant(v, want_friction(world, &unused), "friction");
    add_variant(v, world->turning_bodies > 0 || !soft, "rotation");
    add_variant(v, world->narrow.any_kinetic, "kinetic friction");
    add_variant(v, any_material(world, m->rolling_resistance), "rolling resistance");
    add_variant(v, any_material(world, m->surface_speed), "surface speed");
    add_variant(v, want_adhesion(world, &unused), "adhesion");
    add_variant(v, want_locks(world, &unused), "locked axes");
    add_variant(v, soft && world->desc.hit_speed > 0, "speeds of hits");
}

void pl_narrow_variants(const plumb_world *world, pl_variants *v)
{
    const uint32_t *kinds = world->piece_kinds;
    const char *unused;
    add_variant(v, kinds[PL_PIECE_CIRCLE] > 0, "circles");
    add_variant(v, kinds[PL_PIECE_CAPSULE] > 0, "capsules");
    add_variant(v, kinds[PL_PIECE_BOX] > 0, "boxes");
    add_variant(v, kinds[PL_PIECE_POLYGON] > 0, "polygons");
    add_variant(v, want_one_way(world, &unused), "one-way");
}

void pl_gather_variants(const plumb_world *world, pl_variants *v)
{
    const char *unused;
    add_variant(v, want_locks(world, &unused), "locked axes");
    add_variant(v, want_own_time(world, &unused), "own time");
}

void pl_motion_variants(const plumb_world *world, pl_variants *v)
{
    const char *unused;
    pl_gather_variants(world, v);
    add_variant(v, pl_want_damping(world, &unused), "damping");
    add_variant(v, pl_want_caps(world, &unused), "speed caps");
}

void pl_law_variants(const plumb_world *world, pl_variants *v)
{
    const pl_law_formula *all = pl_law_formulas(&world->laws);
    bool of_velocity = false, of_time = false;
    for (uint32_t i = 0; i < world->laws.formula_count; ++i) {
        of_velocity |= all[i].program.uses_velocity != 0;
        of_time |= all[i].program.uses_time != 0;
    }
    add_variant(v, world->laws.formula_count > 0, "formulas");
    add_variant(v, of_velocity, "formulas of velocities");
    add_variant(v, of_time, "formulas of time");
}
