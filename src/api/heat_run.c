// heat_run.c - bodies that melted, burnt or grew in a step have another size when the next one begins.
//
// Melt leaves a body by whole particles, so a body and its particles have together the mass that it had, and what is no particle yet is with the
// body. Particles are on the outline as it was, at parts of it that follow one another by the golden section, so that
// they are even however many there are; where another solid shape is, the next place is tried. They have the velocity of the body there, and
// the body what is left of momentum and angular momentum.
//
// What rounding takes from a mass goes on as `burnt` of the record.
//
// Reads: records. Writes: bodies, as merge.c scales them; particles; events. Order: after the commands, by handles. Cost: O(bodies with
// heat) + that of plumb_body_scale for each that changes, + a query a particle.
#include "api/heat_run.h"

#include "math/decay.h"
#include "plumb/fracture.h"
#include "plumb/math.h"
#include "plumb/query.h"
#include "world/check.h"
#include "world/destroy.h"
#include "world/heat_list.h"
#include "world/observer.h"
#include "world/perimeter.h"
#include "world/rows.h"

#include <math.h>

#define LEAST  (1.0 / 256)        // share of the mass, or of the size, that is worth another shape
#define GOLDEN 0.6180339887498949 // of the outline between places of two particles
#define TRIES  16                 // places for one

// A body that changes.
typedef struct change {
    plumb_world *world;
    const char *fn;
    plumb_body body;
    double mass;    // [kg] as its row says
    double factor;  // of its size, by growth
    double lost;    // [kg] that goes
    uint32_t drops; // particles, part of that
    uint32_t phase;
    double drop; // [kg] of one; 0: melt has nowhere to go
} change;

static double kinetic_and_height(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    const double m = (double)b->mass[row], vx = (double)b->vx[row], vy = (double)b->vy[row];
    const double w = (double)b->w[row],
                 inertia = b->inv_inertia[row] > 0 ? (double)b->inertia[row] : 0;
    if (b->type[row] != PLUMB_DYNAMIC) {
        return 0;
    }
    return (m * (vx * vx + vy * vy) + inertia * w * w) / 2 -
           m * (double)b->gravity_scale[row] *
               ((double)world->gravity.x * (double)b->center_x[row] +
                (double)world->gravity.y * (double)b->center_y[row]);
}

// [kg] of a particle of the phase that a body melts into.
static double drop_of(const plumb_world *world, uint32_t phase)
{
    const pl_liquid *liquid = &world->liquid;
    if (liquid->settings_count == 0 || phase > liquid->phase_count) {
        return 0;
    }
    const double spacing = (double)pl_liquid_desc(liquid)->spacing;
    const double density = phase == 0 ? (double)pl_liquid_desc(liquid)->density
                                      : (double)pl_liquid_phases(liquid)[phase - 1].density;
    return density * spacing * spacing;
}

// Melt that has nowhere to go counts as burnt.
static void forget_melt(const plumb_world *world, pl_heat *heat)
{
    plumb_heat_sums *sums = &pl_heat_state_of(&world->heats)->sums;
    sums->gone += heat->molten;
    sums->carried += heat->molten * (heat->latent_heat + heat->heat_capacity * heat->temperature);
    heat->burnt += heat->molten;
    heat->molten = 0;
}

// How many whole particles so much melt is. False: there is no liquid for it, or no room in it.
static bool count_drops(change *c, double melt)
{
    const double room = (double)(PLUMB_LIQUID_MAX - c->world->liquid.count);
    const double drops = c->drop > 0 ? melt / c->drop : room + 1;
    c->drops = drops <= room ? (uint32_t)drops : 0;
    return drops <= room;
}

//---- particles -----------------------------------------------------------------------------------

// The first of some places where no other solid shape is, or the first of all. E_MEMORY.
static plumb_result find_place(const change *c, uint32_t row, double length, plumb_vec2 *place)
{
    const plumb_query_filter filter = { .ignore_body = c->body };
    uint64_t *drops = &pl_heat_state_of(&c->world->heats)->drops;
    for (int i = 0; i < TRIES; ++i) {
        const double turns = GOLDEN * (double)((*drops)++ & 0xffffff);
        const plumb_vec2 at =
            pl_perimeter_place(c->world, row, length * (turns - (double)(int64_t)turns));
        const int found = plumb_world_overlap_point(c->world, at, &filter, NULL, 0);
        if (found < 0 && plumb_world_error(c->world).code == PLUMB_E_MEMORY) {
            return PLUMB_E_MEMORY;
        }
        *place = i == 0 || found <= 0 ? at : *place;
        if (found <= 0) {
            break;
        }
    }
    return PLUMB_OK;
}

// What particles take away, about the centre of the body.
typedef struct taken {
    double x, y, turn; // [kg m/s], [kg m^2/s]
} taken;

static plumb_result drip_one(const change *c, double length, taken *t)
{
    const uint32_t row = pl_body_row(c->world, c->body);
    const pl_bodies *b = &c->world->bodies;
    plumb_particle p = { .phase = c->phase };
    PL_TRY(find_place(c, row, length, &p.position));
    const double rx = (double)p.position.x - (double)b->center_x[row];
    const double ry = (double)p.position.y - (double)b->center_y[row], w = (double)b->w[row];
    p.velocity = plumb_v2((real)((double)b->vx[row] - w * ry), (real)((double)b->vy[row] + w * rx));
    PL_TRY(plumb_liquid_add(c->world, &p, 1));
    const double px = c->drop * (double)p.velocity.x, py = c->drop * (double)p.velocity.y;
    t->x += px;
    t->y += py;
    t->turn += rx * py - ry * px;
    return PLUMB_OK;
}

// Makes the particles of a body, all or none. Where they would be too far off for a liquid, its melt has nowhere to go.
static plumb_result drip(change *c, taken *t)
{
    plumb_world *world = c->world;
    const double length = c->drops > 0 ? pl_perimeter(world, pl_body_row(world, c->body)) : 0;
    const uint32_t before = world->liquid.count;
    const uint64_t drops = pl_heat_state_of(&world->heats)->drops;
    plumb_result r = PLUMB_OK;
    for (uint32_t i = 0; i < c->drops && r == PLUMB_OK; ++i) {
        r = drip_one(c, length, t);
    }
    if (r != PLUMB_OK) {
        world->liquid.count = before;
        pl_heat_state_of(&world->heats)->drops = drops;
        *t = (taken){ 0, 0, 0 };
        c->drops = r == PLUMB_E_MEMORY ? c->drops : 0;
    }
    if (r != PLUMB_OK && r != PLUMB_E_MEMORY) {
        forget_melt(world, pl_heat_find(world, c->body));
    }
    return r;
}

// The body moves on with what is left. What burnt, and what grew, moves as it does.
static void recoil(const change *c, const double momentum[3], const taken *t)
{
    pl_bodies *b = &c->world->bodies;
    const uint32_t row = pl_body_row(c->world, c->body), flags = b->flags[row];
    const double rest = c->mass - c->drops * c->drop, square = c->factor * c->factor;
    const double inertia = (double)b->inertia[row] * rest / ((double)b->mass[row] * square);
    if ((flags & PL_BODY_LOCK_X) == 0) {
        b->vx[row] = pl_poses(c->world)[row].vx = (real)((momentum[0] - t->x) / rest);
    }
    if ((flags & PL_BODY_LOCK_Y) == 0) {
        b->vy[row] = pl_poses(c->world)[row].vy = (real)((momentum[1] - t->y) / rest);
    }
    if (b->inv_inertia[row] > 0) {
        b->w[row] = (real)((momentum[2] - t->turn) / inertia);
    }
}

//---- another size --------------------------------------------------------------------------------

static void note_difference(change *c, double energy, double content)
{
    plumb_heat_sums *sums = &pl_heat_state_of(&c->world->heats)->sums;
    const uint32_t row = pl_body_row(c->world, c->body);
    const pl_heat *heat = pl_heat_find(c->world, c->body);
    sums->mechanical += energy - kinetic_and_height(c->world, row);
    sums->carried += content - pl_heat_content(heat, c->world->bodies.type[row] == PLUMB_DYNAMIC
                                                         ? (double)c->world->bodies.mass[row]
                                                         : 0);
}

// E_RANGE: it is too small, or too large, for that.
static plumb_result resize(change *c)
{
    plumb_world *world = c->world;
    uint32_t row = pl_body_row(world, c->body);
    pl_bodies *b = &world->bodies;
    const pl_heat before = pl_heat_get(world, c->body);
    const double energy = kinetic_and_height(world, row);
    const double content = pl_heat_content(&before, c->mass);
    double momentum[3] = { c->mass * (double)b->vx[row], c->mass * (double)b->vy[row],
                           b->inv_inertia[row] > 0 ? (double)b->inertia[row] * (double)b->w[row]
                                                   : 0 };
    const double factor = c->factor * (c->lost > 0 ? sqrt((c->mass - c->lost) / c->mass) : 1);
    taken t = { 0, 0, 0 };
    const uint32_t particles = world->liquid.count;
    const uint64_t drops = pl_heat_state_of(&world->heats)->drops;
    if (drip(c, &t) == PLUMB_E_MEMORY) {
        return PLUMB_E_MEMORY;
    }
    const plumb_result r = plumb_body_scale(world, c->body, (real)factor);
    if (r != PLUMB_OK) {
        world->liquid.count = particles;
        pl_heat_state_of(&world->heats)->drops = drops;
        return r;
    }
    row = pl_body_row(world, c->body);
    pl_heat *heat = pl_heat_find(world, c->body);
    plumb_heat_sums *sums = &pl_heat_state_of(&world->heats)->sums;
    const double grown = c->factor * c->factor;
    if (c->drops > 0) {
        recoil(c, momentum, &t);
    }
    if (c->mass > 0) {
        const double melted = c->drops * c->drop, burnt = c->lost - melted;
        const double due = (c->mass - c->lost) * grown; // what the row should say
        heat->molten -= melted;
        heat->burnt += (double)b->mass[row] - due - burnt;
        sums->melted += melted;
    }
    heat->grown = c->factor != 1 ? 0 : heat->grown;
    note_difference(c, energy, content);
    return PLUMB_OK;
}

//---- the end -------------------------------------------------------------------------------------

static plumb_body_end end_of(const pl_heat *heat)
{
    const bool melts = heat->melting_point > 0 && heat->temperature >= heat->melting_point;
    return melts || heat->molten > 0 ? PLUMB_END_MELTED
           : heat->growth < 0        ? PLUMB_END_SHRUNK
                                     : PLUMB_END_BURNT;
}

// All that is left of a body that melted becomes particles, of one that burnt nothing.
static plumb_result finish(change *c)
{
    plumb_world *world = c->world;
    pl_heats *heats = &world->heats;
    pl_buffer *gone = &pl_heat_step_of(heats)->gone;
    if (!pl_buffer_reserve(&world->memory, gone,
                           ((size_t)heats->gone_count + 1) * sizeof(plumb_body_gone))) {
        return pl_fail_memory(world, c->fn);
    }
    pl_heat heat = pl_heat_get(world, c->body);
    const uint32_t row = pl_body_row(world, c->body);
    const pl_bodies *b = &world->bodies;
    pl_heat_state *state = pl_heat_state_of(heats);
    const double rest = c->mass > heat.burnt ? c->mass - heat.burnt : 0;
    const plumb_body_gone event = { .body = c->body,
                                    .user_data = b->user_data[row],
                                    .position = { b->center_x[row], b->center_y[row] },
                                    .mass = (real)rest,
                                    .end = end_of(&heat) };
    c->drops = 0;
    const double all = rest + state->owed[c->phase];
    if (event.end == PLUMB_END_MELTED && count_drops(c, all)) {
        taken t = { 0, 0, 0 };
        const plumb_result r = drip(c, &t);
        if (r == PLUMB_E_MEMORY) {
            return r;
        }
        state->owed[c->phase] = r == PLUMB_OK ? all - c->drops * c->drop : state->owed[c->phase];
        state->sums.melted += c->drops * c->drop;
        state->sums.gone += r == PLUMB_OK ? 0 : rest;
    } else {
        state->sums.gone += rest;
    }
    state->sums.carried += pl_heat_content(&heat, c->mass);
    state->sums.mechanical += kinetic_and_height(world, row);
    pl_destroy_entity(world, c->body.entity);
    ((plumb_body_gone *)gone->data)[heats->gone_count++] = event;
    return PLUMB_OK;
}

//---- all -----------------------------------------------------------------------------------------

static void plan(change *c, pl_heat *heat)
{
    const double least = LEAST * c->mass;
    c->factor = fabs(heat->grown) < LEAST ? 1
                : heat->grown < 0         ? pl_decay_of(-heat->grown).left
                                          : 1 / pl_decay_of(heat->grown).left;
    if (!(c->mass > 0)) { // dynamic no more
        return;
    }
    if (heat->molten > 0 && heat->molten >= least && heat->molten >= c->drop &&
        !count_drops(c, heat->molten)) {
        forget_melt(c->world, heat);
    }
    c->lost = c->drops * c->drop;
    if (c->lost > 0 || heat->burnt >= least) {
        c->lost += heat->burnt;
    }
}

// Whether what is left is too little. Burnt mass is in the shapes as they are.
static bool is_over(const change *c, const pl_heat *heat)
{
    const bool loses = c->mass > 0 && (heat->molten > 0 || heat->burnt > 0);
    const bool changes = loses || heat->grown < 0;
    const double solid = c->mass > 0 ? 1 - (heat->molten + heat->burnt) / c->mass : 1;
    const double grown = heat->grown < 0 ? pl_decay_of(-heat->grown).left : 1;
    const uint32_t row = pl_body_row(c->world, c->body);
    return changes &&
           !(solid > 0 && sqrt(pl_body_area(c->world, row) * solid) * grown > heat->smallest);
}

static plumb_result change_body(plumb_world *world, const char *fn, pl_heat *heat)
{
    const uint32_t row = pl_body_row(world, heat->body);
    const bool is_dynamic = world->bodies.type[row] == PLUMB_DYNAMIC;
    change c = { .world = world,
                 .fn = fn,
                 .body = heat->body,
                 .mass = is_dynamic ? (double)world->bodies.mass[row] : 0,
                 .phase = (uint32_t)heat->melt_phase };
    if (heat->molten == 0 && heat->burnt == 0 && heat->grown == 0) {
        return PLUMB_OK;
    }
    c.drop = drop_of(world, c.phase);
    plan(&c, heat);
    if (is_over(&c, heat)) {
        return finish(&c);
    }
    if (c.factor == 1 && !(c.lost > 0)) {
        return PLUMB_OK;
    }
    const plumb_result r = resize(&c);
    if (r == PLUMB_E_RANGE && c.factor <= 1) {
        return finish(&c);
    }
    if (r == PLUMB_E_RANGE) {
        pl_heat_find(world, c.body)->grown = 0; // that was all
    }
    return r == PLUMB_E_MEMORY ? r : PLUMB_OK;
}

plumb_result pl_heat_run(plumb_world *world, const char *function, bool waits)
{
    pl_heats *heats = &world->heats;
    heats->gone_count = 0;
    if (!pl_heat_reserve(world, 0)) {
        return pl_fail_memory(world, function);
    }
    if (waits || (world->observer != NULL && world->observer->replays)) {
        return PLUMB_OK;
    }
    for (uint32_t i = 0; i < heats->count;) {
        const plumb_body body = pl_heat_items(heats)[i].body;
        PL_TRY(change_body(world, function, &pl_heat_items(heats)[i]));
        i += i < heats->count && plumb_same(pl_heat_items(heats)[i].body, body);
    }
    return PLUMB_OK;
}
