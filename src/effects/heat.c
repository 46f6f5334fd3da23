// heat.c - temperatures of bodies: heat through contacts, from surfaces, into melt and fire.
//
// A step is half a step of each body by itself, of all contacts one after another for half a step and back in the
// other order, and again half a step of bodies (G. Strang 1968): second order, and the same to and fro. Two bodies of heat capacities
// C in contact of conductance g have the exact solution
//     Q = (Ta - Tb) (1 - exp(-r h)) / (1 / Ca + 1 / Cb),    r = g (1 / Ca + 1 / Cb):
// what one loses the other gets, neither passes the other, and their energy is kept whatever h. A body that holds its temperature has 1 / C =
// 0. So has one that melts, for the time of a step: what it gets melts it, and a melting body is at its melting point
// exactly. Contacts are summed by pairs of bodies and sorted by their handles, so who sleeps and in which order
// contacts are found decides nothing.
//
// A surface: C dT/dt = P - k (T^4 - A^4), by SDIRK2 (R. Alexander 1977): second order, stable at any step, and
// at rest where P balances what it glows; its equations x + a x^4 = r have one root. Where bodies cool or conduct fast, steps are
// divided in up to eight parts, for accuracy alone.
//
// Fire: rho P rate of mass a second with the perimeter P of what is left, so that its root falls evenly: exact for any step.
//
// Reads: records, pairs, sleeping contacts, pieces, masses. Writes: records, the world's sums. Order: at the end of a step. Cost: O(pairs +
// bodies with heat (1 + log of them) + corners of those that glow or burn).
#include "effects/heat.h"

#include "core/sort.h"
#include "math/decay.h"
#include "schema/passes.h"
#include "world/heat_list.h"
#include "world/perimeter.h"
#include "world/rows.h"

#include <math.h>

#define SIGMA   5.670374419e-8     // [W/(m^2 K^4)] Stefan and Boltzmann's (CODATA 2018)
#define COLDEST 1e-3               // [K] where cooling ends
#define PART    0.25               // of a time of decay that a part of a step takes
#define PARTS   8                  // at most
#define GAMMA   0.2928932188134524 // 1 - 1 / sqrt(2)
#define NEWTON  16

bool pl_want_heat(const plumb_world *world, const char **reason)
{
    const bool wanted = world->heats.count > 0;
    *reason =
        wanted ? "some body has a temperature, or grows" : "no body has a temperature or grows";
    return wanted;
}

bool pl_heat_reserve_flow(plumb_world *world)
{
    const size_t contacts = (size_t)world->broad.pairs.count + world->sleep.contact_count;
    if (!pl_heat_reserve(world, 0)) {
        return false;
    }
    pl_heat_step *s = pl_heat_step_of(&world->heats);
    const bool has =
        pl_buffer_reserve(&world->memory, &s->links, contacts * sizeof(pl_heat_link)) &&
        pl_buffer_reserve(&world->memory, &s->keys, contacts * sizeof(pl_keyed));
    s->room = has ? (uint32_t)contacts : 0;
    return has;
}

static pl_heat_body *bodies_of(const pl_heats *heats)
{
    return (pl_heat_body *)pl_heat_step_of(heats)->bodies.data;
}

static pl_heat_link *links_of(const pl_heats *heats)
{
    return (pl_heat_link *)pl_heat_step_of(heats)->links.data;
}

// Into how many parts a step is divided in which something decays by e^-ratio.
static int parts_of(double ratio)
{
    return ratio <= PART ? 1 : ratio < PART * PARTS ? (int)(ratio / PART) + 1 : PARTS;
}

//---- contacts ------------------------------------------------------------------------------------

// The place of a body that conducts; PL_NONE.
static uint32_t conductor(const plumb_world *world, uint32_t piece)
{
    if ((world->pieces.flags[piece] & PL_PIECE_SENSOR) != 0) {
        return PL_NONE;
    }
    const pl_heat *heat = pl_heat_find(world, world->bodies.entity[world->pieces.body[piece]]);
    const bool conducts = heat != NULL && heat->conductance > 0 && heat->temperature > 0;
    return conducts ? (uint32_t)(heat - pl_heat_items(&world->heats)) : PL_NONE;
}

static void add_link(plumb_world *world, const pl_pair *pair)
{
    if ((pair->flags & PL_PAIR_TOUCHING) == 0) {
        return;
    }
    const uint32_t a = conductor(world, pair->a), b = conductor(world, pair->b);
    pl_heat_step *s = pl_heat_step_of(&world->heats);
    if (a != PL_NONE && b != PL_NONE && s->link_count < s->room) {
        ((pl_keyed *)s->keys.data)[s->link_count++] = (pl_keyed){ .key = pl_pair_key(a, b) };
    }
}

// Contacts of what is awake, and of what sleeps. Those of islands whose pieces are others by now are void.
static void find_contacts(plumb_world *world)
{
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    const pl_sleep *s = &world->sleep;
    for (uint32_t i = 0; i < world->broad.pairs.count; ++i) {
        add_link(world, &pairs[i]);
    }
    for (uint32_t i = 0; i < s->island_slots; ++i) {
        const pl_island *island = &pl_islands(s)[i];
        uint32_t c = island->body_count > 0 ? island->first_contact : PL_NONE;
        for (; c != PL_NONE; c = pl_sleeping_contacts(s)[c].next) {
            const pl_pair *pair = &pl_sleeping_contacts(s)[c].pair;
            if (world->pieces.kind[pair->a] != PL_PIECE_FREE &&
                world->pieces.kind[pair->b] != PL_PIECE_FREE &&
                world->pieces.serial[pair->a] <= island->serial &&
                world->pieces.serial[pair->b] <= island->serial) {
                add_link(world, pair);
            }
        }
    }
}

// Contacts of the same two bodies are one link.
static void find_links(plumb_world *world)
{
    pl_heat_step *s = pl_heat_step_of(&world->heats);
    s->link_count = 0;
    find_contacts(world);
    pl_keyed *keys = s->keys.data;
    pl_heat_link *links = s->links.data;
    const pl_heat *items = pl_heat_items(&world->heats);
    const uint32_t contacts = s->link_count;
    pl_sort_keyed(keys, contacts);
    s->link_count = 0;
    for (uint32_t i = 0; i < contacts; ++i) {
        const uint64_t key = keys[i].key;
        const double a = items[key >> 32].conductance, b = items[(uint32_t)key].conductance;
        if (s->link_count == 0 || links[s->link_count - 1].key != key) {
            links[s->link_count++] = (pl_heat_link){ .key = key };
        }
        links[s->link_count - 1].conductance += a * b / (a + b);
    }
}

static void conduct(pl_heats *heats, uint32_t link, double h)
{
    const pl_heat_link *l = &links_of(heats)[link];
    pl_heat_body *a = &bodies_of(heats)[l->key >> 32], *b = &bodies_of(heats)[(uint32_t)l->key];
    const double rate = l->conductance * (a->yield + b->yield);
    const double flow =
        l->conductance * h * pl_decay_of(rate * h).mean * (a->temperature - b->temperature);
    a->temperature -= flow * a->yield;
    b->temperature += flow * b->yield;
    a->gain -= flow;
    b->gain += flow;
}

static void conduct_all(pl_heats *heats, double dt)
{
    const uint32_t links = pl_heat_step_of(heats)->link_count;
    double most = 0;
    for (uint32_t i = 0; i < links; ++i) {
        const pl_heat_link *l = &links_of(heats)[i];
        const double rate = l->conductance * (bodies_of(heats)[l->key >> 32].yield +
                                              bodies_of(heats)[(uint32_t)l->key].yield);
        most = rate > most ? rate : most;
    }
    const int count = parts_of(most * dt);
    const double half = dt / (2 * count);
    for (int k = 0; k < count; ++k) {
        for (uint32_t i = 0; i < links; ++i) {
            conduct(heats, i, half);
        }
        for (uint32_t i = links; i-- > 0;) {
            conduct(heats, i, half);
        }
    }
}

//---- one body ------------------------------------------------------------------------------------

// Mass that is there: what has burnt is only not taken off yet.
static double mass_of(const plumb_world *world, const pl_heat *heat, uint32_t row)
{
    const double mass = world->bodies.type[row] == PLUMB_DYNAMIC
                            ? (double)world->bodies.mass[row] - heat->burnt
                            : 0;
    return mass > 0 ? mass : 0;
}

static pl_heat_body open_body(const plumb_world *world, const pl_heat *heat, uint32_t row)
{
    const double mass = mass_of(world, heat, row);
    const bool disabled = (world->bodies.flags[row] & PL_BODY_DISABLED) != 0;
    pl_heat_body b = { .temperature = heat->temperature, .ambient = heat->ambient };
    if (!(mass > 0) || disabled) {
        return b;
    }
    b.melts = heat->melting_point > 0 && heat->temperature == heat->melting_point;
    b.yield = b.melts ? 0 : 1 / (mass * heat->heat_capacity);
    b.power = heat->heating;
    const double part = sqrt(mass / (mass + heat->burnt));
    b.glow = heat->emissivity > 0 ? heat->emissivity * SIGMA * part * pl_perimeter(world, row) : 0;
    return b;
}

// x of x + a x^4 = r, a >= 0 and r > 0: by Newton's method from above, where it only falls.
static double root_of(double a, double r)
{
    double x = a * r * r * r > 1 ? sqrt(sqrt(r / a)) : r;
    for (int i = 0; i < NEWTON; ++i) {
        const double cube = x * x * x;
        const double next = x - (x + a * cube * x - r) / (1 + 4 * a * cube);
        if (!(next < x)) {
            break;
        }
        x = next;
    }
    return x;
}

// The temperature T with T = from + h rate(T).
static double implicit(const pl_heat_body *b, double from, double h)
{
    const double square = b->ambient * b->ambient;
    const double r = from + h * b->yield * (b->power + b->glow * square * square);
    return r > 0 ? root_of(h * b->yield * b->glow, r) : COLDEST;
}

// The two stages of SDIRK2, of which the second is the answer. Where they would pass below nothing: one stage.
static double warmed(const pl_heat_body *b, double h)
{
    const double t = b->temperature, first = implicit(b, t, GAMMA * h);
    const double from = t + (1 - GAMMA) / GAMMA * (first - t);
    const double second = from > COLDEST ? implicit(b, from, GAMMA * h) : implicit(b, t, h);
    return second > COLDEST ? second : COLDEST;
}

// Half a step by itself.
static void glow(pl_heat_body *b, double h, plumb_heat_sums *sums)
{
    if (b->power == 0 && b->glow == 0) {
        return;
    }
    if (b->yield == 0) { // it melts
        const double square = b->temperature * b->temperature, around = b->ambient * b->ambient;
        const double lost = b->glow * (square * square - around * around) * h;
        sums->heating += b->power * h;
        sums->radiated += lost;
        b->gain += b->power * h - lost;
        return;
    }
    const double hotter = b->temperature > b->ambient ? b->temperature : b->ambient;
    const double before = b->temperature;
    const int count = parts_of(4 * b->glow * hotter * hotter * hotter * b->yield * h);
    for (int i = 0; i < count; ++i) {
        b->temperature = warmed(b, h / count);
    }
    const double gained = (b->temperature - before) / b->yield;
    if (b->glow > 0) {
        sums->heating += b->power * h;
        sums->radiated += b->power * h - gained;
    } else {
        sums->heating += gained; // that of the coldest body too
    }
}

//---- fire, melt, growth --------------------------------------------------------------------------

// What burns in a step: its heat is part of the power.
static void burn(plumb_world *world, pl_heat *heat, uint32_t row, pl_heat_body *b, double dt)
{
    const double mass = mass_of(world, heat, row);
    if (heat->ignition <= 0 || heat->burn_rate <= 0 || heat->temperature < heat->ignition ||
        !(mass > 0) || (world->bodies.flags[row] & PL_BODY_DISABLED) != 0) {
        return;
    }
    const double area = pl_body_area(world, row), all = mass + heat->burnt;
    // d/dt sqrt(m) = -rho P rate / (2 sqrt(M)), rho = M / A: M and A, P are of the shapes as they are.
    const double root = sqrt(mass) - sqrt(all) * pl_perimeter(world, row) * heat->burn_rate * dt /
                                         (2 * (area > 0 ? area : 1));
    const double left = root > 0 ? root * root : 0, burnt = mass - left;
    plumb_heat_sums *sums = &pl_heat_state_of(&world->heats)->sums;
    heat->burnt += burnt;
    sums->gone += burnt;
    sums->carried += burnt * heat->heat_capacity * heat->temperature;
    sums->burning += burnt * heat->burn_heat;
    b->power += dt > 0 ? burnt * heat->burn_heat / dt : 0;
    b->yield = left > 0 && !b->melts ? 1 / (left * heat->heat_capacity) : 0;
}

// What a body has got at its melting point, or above it, becomes melt; what it lost there, of melt.
static void melt(const plumb_world *world, pl_heat *heat, uint32_t row, const pl_heat_body *b,
                 plumb_heat_sums *sums)
{
    const double mass = mass_of(world, heat, row), warm = mass * heat->heat_capacity;
    double heat_left = b->melts ? b->gain : (b->temperature - heat->melting_point) * warm;
    heat->temperature = heat->melting_point;
    if (heat->latent_heat > 0) {
        double melted = heat_left / heat->latent_heat;
        melted = melted < -heat->molten ? -heat->molten : melted;
        melted = melted > mass - heat->molten ? mass - heat->molten : melted;
        heat->molten += melted;
        heat_left -= melted * heat->latent_heat;
    } else if (heat_left >= 0) {
        heat->molten = mass;
    }
    if (heat_left < 0) {
        heat->temperature += heat_left / warm;
        if (heat->temperature < COLDEST) {
            sums->heating += (COLDEST - heat->temperature) * warm;
            heat->temperature = COLDEST;
        }
    } else {
        sums->carried += heat_left; // of melt that is hotter: it goes with it
    }
}

static void close_body(plumb_world *world, pl_heat *heat, const pl_heat_body *b, double dt)
{
    plumb_heat_sums *sums = &pl_heat_state_of(&world->heats)->sums;
    const uint32_t row = pl_body_row(world, heat->body);
    heat->grown += heat->growth * dt;
    if (heat->temperature <= 0) {
        return;
    }
    if (b->yield == 0 && !b->melts) {
        sums->held -= b->gain;
    } else if (b->melts || (heat->melting_point > 0 &&
                            (b->temperature > heat->melting_point || heat->molten > 0))) {
        melt(world, heat, row, b, sums);
    } else {
        heat->temperature = b->temperature;
    }
}

//---- a step --------------------------------------------------------------------------------------

static void glow_all(plumb_world *world, double h)
{
    const pl_heats *heats = &world->heats;
    for (uint32_t i = 0; i < heats->count; ++i) {
        if (pl_heat_items(heats)[i].temperature > 0) {
            pl_heat_body *b = &bodies_of(heats)[i];
            if (b->yield > 0 || b->melts) {
                glow(b, h, &pl_heat_state_of(heats)->sums);
            }
        }
    }
}

void pl_heat_flow(plumb_world *world, double dt)
{
    pl_heats *heats = &world->heats;
    pl_heat *items = pl_heat_items(heats);
    find_links(world);
    for (uint32_t i = 0; i < heats->count; ++i) {
        const uint32_t row = pl_body_row(world, items[i].body);
        bodies_of(heats)[i] = open_body(world, &items[i], row);
        burn(world, &items[i], row, &bodies_of(heats)[i], dt);
    }
    glow_all(world, dt / 2);
    conduct_all(heats, dt);
    glow_all(world, dt / 2);
    for (uint32_t i = 0; i < heats->count; ++i) {
        close_body(world, &items[i], &bodies_of(heats)[i], dt);
    }
    pl_heat_step_of(heats)->room = 0;
}
