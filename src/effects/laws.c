// laws.c - whom laws act on in a step, and how: bodies that fly by themselves, bodies that are pushed in the substeps.
//
// Who has a contact, a joint, damping, a cap, a lock or a time of its own, who walks, and all where a system of the substep
// runs, are pushed; the others fly (orbits.c). Bodies that attract one another, or that a law carried by a dynamic
// body pulls, are coupled: they fly together or are pushed together, so that each force has its reaction in the same
// moment.
//
// Reads: laws, bodies, manifolds, joints. Writes: lists of the step, times of rest. Order: before "called"; behind the
// graph. Cost: O(bodies laws + contacts); where laws move, O(bodies asleep).
#include "effects/laws.h"

#include "core/fill.h"
#include "core/sort.h"
#include "schema/passes.h"
#include "world/body_settings.h"
#include "world/island.h"
#include "world/law_list.h"
#include "world/rows.h"
#include "math/trig.h"

#include <math.h>

bool pl_want_laws(const plumb_world *world, const char **reason)
{
    bool wanted = world->laws.count > 0 && world->dynamic_count > 0;
    for (uint32_t i = 0; i < world->laws.count && world->asleep_count > 0; ++i) {
        wanted |= pl_law_is_restless(&world->laws, &pl_law_items(&world->laws)[i]);
    }
    *reason = wanted                  ? "the world has laws"
              : world->laws.count > 0 ? "no body is awake for laws to act on"
                                      : "the world has no law";
    return wanted;
}

bool pl_law_acts_on(const plumb_world *world, uint32_t row)
{
    return pl_law_way_of(world, row) >= PL_LAW_PUSHED;
}

plumb_orbit_desc pl_orbits_of(const plumb_world *world)
{
    plumb_orbit_desc d = { 0 };
    if (world->laws.orbit_count > 0) {
        d = *(const plumb_orbit_desc *)world->laws.orbits.data;
    }
    d.order = d.order == 0 ? 2 : d.order;
    return d;
}

void pl_laws_free(pl_memory *memory, pl_laws *laws)
{
    pl_law_step *s = &laws->step;
    pl_buffer *buffers[] = { &laws->items, &laws->formulas, &laws->orbits, &s->laws,   &s->ways,
                             &s->bodies,   &s->order,       &s->states,    &s->forces, &s->table,
                             &s->flights,  &s->poles,       &s->pulled };
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; ++i) {
        pl_buffer_free(memory, buffers[i]);
    }
}

//---- where laws are ------------------------------------------------------------------------------

// Place, motion and direction of a law that a body carries; false: the body is out of the simulation.
static bool carry(const plumb_world *world, pl_law_now *law)
{
    const pl_bodies *b = &world->bodies;
    const uint32_t row = pl_body_row(world, law->desc->body);
    if (row == PL_NONE || (b->flags[row] & PL_BODY_DISABLED) != 0) {
        return false;
    }
    const double c = (double)b->c[row], s = (double)b->s[row], w = (double)b->w[row];
    const double px = law->x - (double)b->local_x[row], py = law->y - (double)b->local_y[row];
    const bool dynamic = b->type[row] == PLUMB_DYNAMIC;
    const bool central = dynamic && law->desc->kind == PLUMB_LAW_ATTRACTOR;
    const double rx = central ? 0 : c * px - s * py, ry = central ? 0 : s * px + c * py;
    law->x = (double)b->center_x[row] + (double)b->residual_x[row] + rx;
    law->y = (double)b->center_y[row] + (double)b->residual_y[row] + ry;
    if (row < world->dynamic_count + world->kinematic_count) {
        const double time = (double)pl_time_scale(world, row);
        law->vx = time * ((double)b->vx[row] - w * ry);
        law->vy = time * ((double)b->vy[row] + w * rx);
        law->w = time * w;
    }
    law->carrier = central && row < world->dynamic_count ? row : PL_NONE;
    const double lc = law->c;
    law->c = lc * c - law->s * s;
    law->s = law->s * c + lc * s;
    return true;
}

bool pl_law_place(const plumb_world *world, const pl_law *item, pl_law_now *law)
{
    const pl_law_data *d = &item->desc;
    const double hx = (double)d->half.x, hy = (double)d->half.y, radius = (double)d->radius;
    const pl_law_formula *formula = pl_law_formula_of(&world->laws, item);
    *law = (pl_law_now){ .desc = d,
                         .formula = formula != NULL ? &formula->program : NULL,
                         .drags = formula != NULL && formula->program.uses_velocity != 0,
                         .x = (double)d->position.x,
                         .y = (double)d->position.y,
                         .square = (double)d->softening * (double)d->softening,
                         .reach = hx > 0       ? sqrt(hx * hx + hy * hy)
                                  : radius > 0 ? radius
                                               : INFINITY,
                         .carrier = PL_NONE,
                         .member = PL_NONE };
    pl_sincos((double)d->angle, &law->s, &law->c);
    if (!plumb_is_null(d->body) && !carry(world, law)) {
        return false;
    }
    law->moved = item->placed &&
                 (law->x != item->x || law->y != item->y || (law->formula != NULL && law->w != 0));
    return true;
}

uint32_t pl_laws_place(const plumb_world *world, pl_law_now *out)
{
    const pl_law *items = pl_law_items(&world->laws);
    uint32_t count = 0;
    for (uint32_t i = 0; i < world->laws.count; ++i) {
        pl_law_now law;
        if (!pl_law_place(world, &items[i], &law)) {
            continue;
        }
        uint32_t at = count++;
        for (; at > 0 && out[at - 1].desc->priority < law.desc->priority; --at) {
            out[at] = out[at - 1];
        }
        out[at] = law;
    }
    return count;
}

//---- bodies --------------------------------------------------------------------------------------

static uint64_t categories_of(const plumb_world *world, uint32_t row)
{
    uint64_t all = 0;
    uint32_t p = world->bodies.first_piece[row];
    for (; p != PL_NONE; p = world->pieces.next_in_body[p]) {
        all |= world->pieces.category[p];
    }
    return all;
}

pl_law_body pl_law_body_of(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    const pl_body_settings t = pl_body_settings_get(world, row);
    const double mass = (double)b->mass[row];
    double moment[2] = { 0, 0 };
    if (t.dipole != 0) {
        pl_dipole_moment(b, row, &t, moment);
    }
    return (pl_law_body){ .row = row,
                          .slot = PL_NONE,
                          .mass = mass,
                          .weight = mass * (double)b->gravity_scale[row],
                          .charge = (double)t.charge,
                          .attraction = (double)t.attraction,
                          .mx = moment[0],
                          .my = moment[1],
                          .time = (double)t.time_scale,
                          .categories = categories_of(world, row) };
}

// What the laws of a step have to do with a body.
typedef struct role {
    bool acted_on, coupled, source, dragged;
} role;

// One of those that attract is in reach, or nearly.
static bool is_attracted(const plumb_world *world, const pl_law_now *law, const pl_law_body *body,
                         double dt)
{
    const pl_law_step *s = &world->laws.step;
    const pl_bodies *b = &world->bodies;
    const uint32_t row = body->row;
    for (uint32_t i = 0; i < s->source_count; ++i) {
        const pl_law_body *other = &pl_law_bodies(world)[i];
        const uint32_t at = other->row;
        const double dx = (double)b->center_x[at] - (double)b->center_x[row];
        const double dy = (double)b->center_y[at] - (double)b->center_y[row];
        const double rx = (double)b->vx[at] - (double)b->vx[row];
        const double ry = (double)b->vy[at] - (double)b->vy[row];
        const double near = law->reach + 2 * dt * sqrt(rx * rx + ry * ry);
        if (pl_law_pair(law, body, other) != 0 && dx * dx + dy * dy <= near * near) {
            return true;
        }
    }
    return false;
}

static role role_of(const plumb_world *world, const pl_law_body *body, double dt)
{
    const pl_law_step *s = &world->laws.step;
    const pl_bodies *b = &world->bodies;
    const double x = (double)b->center_x[body->row], y = (double)b->center_y[body->row];
    const double vx = (double)b->vx[body->row], vy = (double)b->vy[body->row];
    role r = { false, false, false, false };
    for (uint32_t i = 0; i < s->law_count; ++i) {
        const pl_law_now *law = &pl_laws_now(world)[i];
        if (law->carrier == body->row) {
            r.acted_on = r.coupled = true;
            continue;
        }
        if (!pl_law_holds(law->desc, body)) {
            continue;
        }
        if (law->desc->kind == PLUMB_LAW_MUTUAL) {
            r.source |= pl_law_is_source(law->desc, body);
            r.coupled |= r.source || is_attracted(world, law, body, dt);
            r.acted_on |= r.coupled;
            continue;
        }
        const double dx = x - law->x, dy = y - law->y, rx = vx - law->vx, ry = vy - law->vy;
        // Twice the way of a step: nobody gets in by surprise.
        const double near = law->reach + 2 * dt * sqrt(rx * rx + ry * ry);
        const bool is_near = dx * dx + dy * dy <= near * near;
        r.acted_on |= is_near;
        r.coupled |= is_near && law->carrier != PL_NONE;
        r.dragged |= is_near && law->drags;
    }
    return r;
}

static pl_law_way way_of(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    const uint32_t flags = b->flags[row];
    if (b->first_joint[row] != PL_NONE || b->character[row] != 0 || (flags & PL_BODY_LOCKED) != 0) {
        return PL_LAW_HELD;
    }
    if ((flags & PL_BODY_HAS_SETTINGS) == 0) {
        return PL_LAW_FLIES;
    }
    const pl_body_settings t = pl_body_settings_get(world, row);
    const bool busy = t.damping > 0 || t.angular_damping > 0 || t.max_speed > 0 || t.max_spin > 0 ||
                      t.time_scale != 1 || t.drag > 0 || t.thrust > 0 || t.dipole != 0;
    return busy ? PL_LAW_PUSHED : PL_LAW_FLIES;
}

// Uniform laws without end, where nothing replaces them.
static void add_endless(const pl_law_step *s, const pl_law_now *laws, pl_law_body *body)
{
    for (uint32_t i = 0; i < s->law_count && !s->replaces && body->mass > 0; ++i) {
        const pl_law_data *d = laws[i].desc;
        if (d->kind == PLUMB_LAW_UNIFORM && pl_law_is_endless(d)) {
            const double share = pl_law_hold_of(d, body) / body->mass;
            body->ax += share * (double)d->vector.x;
            body->ay += share * (double)d->vector.y;
        }
    }
}

// Coupled bodies that attract come first, other coupled ones behind, then the rest: which of them is put down.
enum { SOURCES, COUPLED, SINGLE, ROUNDS };

static void put_bodies(plumb_world *world, double dt, int round)
{
    pl_law_step *s = &world->laws.step;
    uint8_t *ways = s->ways.data;
    const uint32_t sleeping = pl_partition_first(world, PL_PART_ASLEEP);
    const uint32_t asleep = round == SOURCES ? world->asleep_count : 0;
    for (uint32_t i = 0; i < world->dynamic_count + asleep; ++i) {
        const bool sleeps = i >= world->dynamic_count;
        const uint32_t row = sleeps ? sleeping + (i - world->dynamic_count) : i;
        pl_law_body body = pl_law_body_of(world, row);
        const role r = role_of(world, &body, dt);
        const int mine = !r.coupled ? SINGLE : r.source ? SOURCES : COUPLED;
        if (!r.acted_on || mine != round) {
            continue;
        }
        if (sleeps) { // it attracts as it lies, and wakes
            body.mass = 0;
        } else {
            ways[row] = (uint8_t)way_of(world, row);
        }
        body.coupled = r.coupled;
        body.dragged = r.dragged;
        add_endless(s, pl_laws_now(world), &body);
        pl_law_bodies(world)[s->body_count++] = body;
    }
}

static void push_touching(plumb_world *world)
{
    const pl_manifold *m = pl_manifolds(&world->narrow);
    pl_law_step *s = &world->laws.step;
    uint8_t *ways = s->ways.data;
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        const uint32_t ends[] = { m[i].body_a, m[i].body_b };
        for (int k = 0; k < 2; ++k) {
            if (ends[k] < world->dynamic_count && ways[ends[k]] != PL_LAW_NONE) {
                ways[ends[k]] = PL_LAW_TOUCHES;
            }
        }
    }
    for (uint32_t row = 0; row < world->dynamic_count && world->systems.in_substeps > 0; ++row) {
        ways[row] = ways[row] == PL_LAW_FLIES ? PL_LAW_PUSHED : ways[row];
    }
}

static void settle_coupled(plumb_world *world)
{
    pl_law_step *s = &world->laws.step;
    const pl_law_body *bodies = pl_law_bodies(world);
    uint8_t *ways = s->ways.data;
    s->couples = s->dipoles = false;
    for (uint32_t i = 0; i < s->coupled_count; ++i) {
        s->dipoles |= pl_law_has_dipole(&bodies[i]);
        s->couples |= bodies[i].mass > 0 && ways[bodies[i].row] >= PL_LAW_PUSHED;
    }
    s->couples |= s->dipoles; // one that sleeps, too, acts in the substeps
    for (uint32_t i = 0; i < s->coupled_count && s->couples; ++i) {
        if (bodies[i].mass > 0 && ways[bodies[i].row] == PL_LAW_FLIES) {
            ways[bodies[i].row] = PL_LAW_PUSHED;
        }
    }
    s->flies = false;
    for (uint32_t i = 0; i < s->body_count; ++i) {
        s->flies |= bodies[i].mass > 0 && ways[bodies[i].row] == PL_LAW_FLIES;
    }
}

static void name_members(plumb_world *world)
{
    const pl_law_step *s = &world->laws.step;
    for (uint32_t i = 0; i < s->law_count; ++i) {
        pl_law_now *law = &pl_laws_now(world)[i];
        for (uint32_t k = 0; k < s->coupled_count && law->carrier != PL_NONE; ++k) {
            if (pl_law_bodies(world)[k].row == law->carrier) {
                law->member = k;
            }
        }
    }
}

//---- who wakes, who does not fall asleep ---------------------------------------------------------

// Bodies that carry an attractor have its reaction.
static void heed_carriers(plumb_world *world)
{
    const pl_law_step *s = &world->laws.step;
    for (uint32_t i = 0; i < s->law_count; ++i) {
        const uint32_t carrier = pl_laws_now(world)[i].carrier;
        if (carrier != PL_NONE && s->coupled_count > 1) {
            world->bodies.rest_time[carrier] = PL_NOT_RESTING;
        }
    }
}

static void heed(plumb_world *world, real dt)
{
    const pl_law_step *s = &world->laws.step;
    const uint32_t sleeping = pl_partition_first(world, PL_PART_ASLEEP);
    bool moved = s->source_count > 0, changes = false;
    for (uint32_t i = 0; i < s->law_count; ++i) {
        const pl_law_now *law = &pl_laws_now(world)[i];
        moved |= law->moved;
        changes |= law->formula != NULL && law->formula->uses_time != 0;
    }
    moved |= changes && world->settings.dipoles > 0;
    if (changes && !world->desc.no_sleep) {
        pl_formulas_heed(world, (double)dt);
    }
    for (uint32_t row = 0; row < world->dynamic_count && moved; ++row) {
        if (pl_laws_stir(world, row)) {
            world->bodies.rest_time[row] = PL_NOT_RESTING;
        }
    }
    for (uint32_t i = 0; i < world->asleep_count && moved; ++i) {
        if (pl_laws_stir(world, sleeping + i)) {
            pl_sleep_disturb(world, sleeping + i);
        }
    }
    heed_carriers(world);
    pl_law_rest(world);
}

//---- the step ------------------------------------------------------------------------------------

static bool reserve(plumb_world *world)
{
    pl_law_step *s = &world->laws.step;
    pl_memory *memory = &world->memory;
    const size_t rows = (size_t)world->dynamic_count + world->asleep_count;
    return pl_buffer_reserve(memory, &s->laws, world->laws.count * sizeof(pl_law_now)) &&
           pl_buffer_reserve(memory, &s->ways, world->dynamic_count) &&
           pl_buffer_reserve(memory, &s->bodies, rows * sizeof(pl_law_body));
}

static void note_places(plumb_world *world)
{
    const pl_law_step *s = &world->laws.step;
    for (uint32_t i = 0; i < s->law_count; ++i) {
        const pl_law_now *law = &pl_laws_now(world)[i];
        pl_law *item = (pl_law *)((char *)(uintptr_t)law->desc - offsetof(pl_law, desc));
        item->x = law->x, item->y = law->y;
        item->placed = true;
    }
}

bool pl_laws_find(plumb_world *world, real dt)
{
    pl_law_step *s = &world->laws.step;
    if (!reserve(world)) {
        return false;
    }
    pl_fill(s->ways.data, PL_LAW_NONE, world->dynamic_count);
    s->law_count = pl_laws_place(world, s->laws.data);
    s->replaces = s->formulas = s->others = false;
    bool couple = false; // else nobody is a source or coupled
    for (uint32_t i = 0; i < s->law_count; ++i) {
        const pl_law_now *law = &pl_laws_now(world)[i];
        s->replaces |= law->desc->combine == PLUMB_LAW_REPLACE;
        s->formulas |= law->formula != NULL;
        s->others |= law->formula == NULL || law->desc->combine == PLUMB_LAW_REPLACE;
        couple |= law->desc->kind == PLUMB_LAW_MUTUAL || law->carrier != PL_NONE;
    }
    s->body_count = s->source_count = s->coupled_count = s->pushed_count = 0;
    if (couple) {
        put_bodies(world, (double)dt, SOURCES);
        s->source_count = s->body_count;
        put_bodies(world, (double)dt, COUPLED);
        s->coupled_count = s->body_count;
    }
    put_bodies(world, (double)dt, SINGLE);
    name_members(world);
    push_touching(world);
    settle_coupled(world);
    return pl_orbits_reserve(world) && pl_dipoles_reserve(world) && pl_law_rest_reserve(world);
}

void pl_laws_settle(plumb_world *world, real dt)
{
    heed(world, dt);
    note_places(world);
}

bool pl_laws_couple(const plumb_world *world, uint8_t *called)
{
    const pl_law_step *s = &world->laws.step;
    for (uint32_t i = 0; i < s->coupled_count && s->couples; ++i) {
        if (pl_law_bodies(world)[i].mass > 0) {
            called[pl_law_bodies(world)[i].row] |= PL_CALLED_ALONE;
        }
    }
    return s->couples;
}

// Places of the records of the single ones that are pushed, by slot; those of coupled ones stand in the records.
bool pl_laws_take_slots(plumb_world *world)
{
    pl_law_step *s = &world->laws.step;
    const uint32_t *slots = world->solver.slots.data;
    if (!pl_buffer_reserve(&world->memory, &s->order, s->body_count * sizeof(pl_keyed))) {
        return false;
    }
    for (uint32_t i = 0; i < s->body_count; ++i) {
        pl_law_body *body = &pl_law_bodies(world)[i];
        if (body->mass == 0 || pl_law_way_of(world, body->row) < PL_LAW_PUSHED) {
            continue;
        }
        body->slot = slots[body->row];
        if (i >= s->coupled_count) {
            ((pl_keyed *)s->order.data)[s->pushed_count++] =
                (pl_keyed){ pl_key(body->slot, 0), body->slot, i };
        }
    }
    pl_sort_keyed(s->order.data, s->pushed_count);
    return true;
}
