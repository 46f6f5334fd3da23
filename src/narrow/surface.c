// surface.c - friction, static and kinetic, restitution, rolling resistance, surface speed and adhesion of pairs, where
// some material asks for more than the default mix that the kernels make in their lanes (lanes.h).
//
// Surface speed: material on the outline runs along the outward normal turned clockwise. With n
// from A to B and t = (-n_y, n_x), the surface of A moves by -s_A t and that of B, whose outward
// normal is -n, by +s_B t: the slip of the surfaces is that of the bodies plus s_A + s_B.
//
// Kinetic friction: the state of a contact, whether it slides, outlives a step in its pair; within the step the solver keeps
// it. A manifold's friction is that of the state in which the step begins.
//
// Reads: pairs, materials, velocities, the pair table. Writes: manifolds, summary. Order: after the narrow
// phase. Cost: O(manifolds) in worlds that ask for it, O(materials) in others.
#include "narrow/surface.h"

#include "world/material_pair.h"

#include <math.h>

bool pl_surfaces_wanted(const plumb_world *world, const char **reason)
{
    const pl_materials *m = &world->materials;
    bool wanted = world->material_pair_count > 0;
    for (uint32_t row = 0; row < m->table.count && !wanted; ++row) {
        wanted =
            m->users[row] > 0 &&
            (m->rolling_resistance[row] > 0 || m->surface_speed[row] != 0 || m->adhesion[row] > 0 ||
             m->kinetic_friction[row] > 0 || m->friction_mix[row] != PLUMB_MIX_DEFAULT ||
             m->restitution_mix[row] != PLUMB_MIX_DEFAULT);
    }
    *reason = wanted
                  ? "some material rolls hard, runs like a belt, sticks, has a kinetic friction or "
                    "a mix of its own"
                  : "all materials in use are mixed by default";
    return wanted;
}

bool pl_restitution_is_mixed(const plumb_world *world)
{
    bool mixed = world->material_pair_count > 0;
    for (uint32_t row = 0; row < world->materials.table.count && !mixed; ++row) {
        mixed = world->materials.restitution_mix[row] != PLUMB_MIX_DEFAULT;
    }
    return mixed;
}

static real mixed(uint8_t rule, real a, real b)
{
    switch (rule) {
    case PLUMB_MIX_AVERAGE:
        return (a + b) / 2;
    case PLUMB_MIX_GEOMETRIC:
        return (real)sqrt((double)a * (double)b);
    case PLUMB_MIX_MULTIPLY:
        return a * b;
    case PLUMB_MIX_MIN:
        return a < b ? a : b;
    default:
        return a > b ? a : b;
    }
}

static uint8_t later(uint8_t a, uint8_t b)
{
    return a > b ? a : b;
}

// A point that is out of reach keeps no pull for the warm start.
static void stick(pl_manifold *m, const pl_pair *pair, real adhesion)
{
    near_real reach = adhesion > 0 ? pl_adhesion_reach(pair->flags) : -PL_APART;
    m->adhesion = (near_real)adhesion;
    for (uint32_t k = 0; k < m->count; ++k) {
        bool pulls = m->point[k].normal < 0;
        m->point[k].normal = pulls && m->point[k].separation >= reach ? 0 : m->point[k].normal;
    }
}

//---- friction of what sticks and of what slides ----------------------------------------------------

// As the kernels do it in lanes, to the bit.
static near_real mixed_friction(uint8_t rule, real a, real b)
{
    return rule == PLUMB_MIX_DEFAULT ? (near_real)sqrt((double)((near_real)a * (near_real)b))
                                     : (near_real)mixed(rule, a, b);
}

static real kinetic_of(const pl_materials *s, uint32_t row)
{
    return s->kinetic_friction[row] > 0 ? s->kinetic_friction[row] : s->friction[row];
}

static pl_grip grip_of(const plumb_world *world, uint32_t a, uint32_t b)
{
    const pl_materials *s = &world->materials;
    const plumb_material_pair *set = pl_material_pair_of(world, a, b);
    pl_grip g;
    if (set != NULL) {
        g.sticks = (near_real)set->friction;
        g.slides = set->kinetic_friction > 0 ? (near_real)set->kinetic_friction : g.sticks;
    } else {
        const uint8_t rule = later(s->friction_mix[a], s->friction_mix[b]);
        g.sticks = mixed_friction(rule, s->friction[a], s->friction[b]);
        g.slides = s->kinetic_friction[a] > 0 || s->kinetic_friction[b] > 0
                       ? mixed_friction(rule, kinetic_of(s, a), kinetic_of(s, b))
                       : g.sticks;
    }
    g.slides = g.slides < g.sticks ? g.slides : g.sticks;
    return g;
}

pl_grip pl_surface_grip(const plumb_world *world, const pl_manifold *m)
{
    if ((m->met & PL_MET_KINETIC) != 0) {
        const pl_pair *pair = pl_pair_of(world, m);
        const uint32_t *material = world->pieces.material;
        const pl_grip g = grip_of(world, material[pair->a], material[pair->b]);
        if (m->friction == g.sticks || m->friction == g.slides) {
            return g;
        }
    }
    return (pl_grip){ m->friction, m->friction }; // a system set it, or there is one only
}

// [m/s] at which the surfaces slide as the step begins, at the first point.
static real slip_of(const plumb_world *world, const pl_manifold *m)
{
    const pl_bodies *s = &world->bodies;
    const pl_manifold_point *p = &m->point[0];
    const uint32_t a = m->body_a, b = m->body_b;
    const real x = (s->vx[b] - s->w[b] * (real)p->by) - (s->vx[a] - s->w[a] * (real)p->ay);
    const real y = (s->vy[b] + s->w[b] * (real)p->bx) - (s->vy[a] + s->w[a] * (real)p->ax);
    return (real)m->nx * y - (real)m->ny * x + (real)m->surface_speed;
}

// What was pushed aside since the last step slides, and what touches anew and fast.
static void choose_grip(const plumb_world *world, pl_manifold *m, const pl_pair *pair, uint32_t a,
                        uint32_t b)
{
    const pl_grip g = grip_of(world, a, b);
    if (!(g.slides < g.sticks)) {
        return;
    }
    const bool slid = (pair->flags & PL_PAIR_SLIDES) != 0;
    const bool loaded = m->point[0].normal != 0 || m->point[1].normal != 0;
    const real slip = slip_of(world, m);
    const bool fast = slip > (real)PL_SLIDES_FROM || slip < -(real)PL_SLIDES_FROM;
    m->met |= (uint16_t)(PL_MET_KINETIC | (slid ? PL_MET_SLID : 0));
    m->friction = (loaded && slid) || fast ? g.slides : g.sticks;
}

//---- all -------------------------------------------------------------------------------------------

static void mix_all(const plumb_world *world, pl_manifold *m, const pl_pair *pair, uint32_t a,
                    uint32_t b)
{
    const pl_materials *s = &world->materials;
    m->surface_speed = (near_real)pl_rightward(world, s->surface_speed[a] + s->surface_speed[b]);
    const plumb_material_pair *set = pl_material_pair_of(world, a, b);
    if (set != NULL) {
        m->friction = (near_real)set->friction;
        m->restitution = (near_real)set->restitution;
        m->rolling = (near_real)set->rolling_resistance;
        stick(m, pair, set->adhesion);
        return;
    }
    stick(m, pair,
          mixed(later(s->adhesion_mix[a], s->adhesion_mix[b]), s->adhesion[a], s->adhesion[b]));
    uint8_t friction_rule = later(s->friction_mix[a], s->friction_mix[b]);
    uint8_t restitution_rule = later(s->restitution_mix[a], s->restitution_mix[b]);
    if (friction_rule != PLUMB_MIX_DEFAULT) {
        m->friction = (near_real)mixed(friction_rule, s->friction[a], s->friction[b]);
    }
    if (restitution_rule != PLUMB_MIX_DEFAULT) {
        m->restitution = (near_real)mixed(restitution_rule, s->restitution[a], s->restitution[b]);
    }
    m->rolling =
        (near_real)(s->rolling_resistance[a] > s->rolling_resistance[b] ? s->rolling_resistance[a]
                                                                        : s->rolling_resistance[b]);
}

static void mix(const plumb_world *world, pl_manifold *m, const pl_pair *pair, uint32_t a,
                uint32_t b)
{
    mix_all(world, m, pair, a, b);
    choose_grip(world, m, pair, a, b);
}

void pl_surfaces_mix(plumb_world *world)
{
    pl_narrow *narrow = &world->narrow;
    pl_manifold *m = pl_manifolds(narrow);
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    const uint32_t *material = world->pieces.material;
    for (uint32_t i = 0; i < narrow->manifold_count; ++i) {
        const pl_pair *pair = &pairs[m[i].pair];
        mix(world, &m[i], pair, material[pair->a], material[pair->b]);
    }
    pl_narrow_summarise(narrow);
}

// In order of pairs, as the kernels do it.
void pl_narrow_summarise(pl_narrow *narrow)
{
    const pl_manifold *m = pl_manifolds(narrow);
    pl_narrow_forget_summary(narrow);
    for (uint32_t i = 0; i < narrow->manifold_count; ++i) {
        pl_narrow_sum_up(narrow, &m[i]);
    }
}
