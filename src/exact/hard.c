// hard.c - which islands of a world of the soft step are solved exactly: small ones that sweeps cannot hold.
//
// A soft contact gives way to its load F by s = F (1/m_A + 1/m_B) / w^2, and a sweep a substep hands a load on by one
// contact: what bears much is pressed in, and what stands on it falls over. A contact is a seed of its island that is
// - uneven: one body is PL_UNEVEN times as heavy as the other, and lies on it; or gives way by more than DEEP of their size, and the
//   lighter one bears BORNE of its weight; or
// - pressed: at two looks, LOOK steps apart, it gave way by so much and bore BURDEN times the weight of the lighter body. A blow
//   does not last so long. A young world is looked at after 1, 2, 4 and 8 steps, too: it may begin with a stack.
// What is asked is the load that would press a soft contact in, not by how much it is pressed in: loads are the same however they
// are borne, so an island that has become exact stays so. What had sunk then is undone without velocity (rows.c); an island that is
// soft again sinks in by its springs. Impulses go over.
//
// Which islands these make is found in solver/apart.c; until the next look those stay swept that no substep of a step came near to solving.
//
// Reads: manifolds, masses, loads of the last step. Writes: flags of pairs. Order: before islands apart are found; behind the substeps.
// Cost: a read of the masses, where they are uneven one of the new contacts, every LOOK steps one of the manifolds.
#include "exact/exact.h"
#include "world/state.h"

#include <math.h>

#define DEEP   2e-2 // of the way from the contact to the centre of mass
#define BORNE  0.25
#define BURDEN 4.0
#define ABOVE  0.3               // cosine
#define NEAR   ((near_real)5e-3) // [m]
#define LOOK   8u                // steps

#define SOFTNESS 0.912 // (6 / (2 pi))^2: 1 / (w h)^2 of soft.c

// What contacts are looked at with.
typedef struct look_at {
    plumb_world *world;
    const pl_ends *ends;
    uint32_t contacts, dynamic;
    double h;      // [s] substep of the last step, by which loads are known
    double weight; // [m/s^2] of a kilogram
    bool uneven;   // masses are
} look_at;

static double inverse_mass(const look_at *s, uint32_t row)
{
    return row < s->dynamic ? (double)s->world->bodies.inv_mass[row] : 0;
}

//---- seeds ---------------------------------------------------------------------------------------------

// [m] from a contact to the nearer centre of mass of those that move, along the normal.
static double arm_of(const look_at *s, const pl_manifold *m)
{
    const bool a = inverse_mass(s, m->body_a) > 0, b = inverse_mass(s, m->body_b) > 0;
    double arm = (double)PL_APART;
    for (uint32_t k = 0; k < m->count; ++k) {
        const pl_manifold_point *p = &m->point[k];
        const double of_a = fabs((double)(p->ax * m->nx + p->ay * m->ny));
        const double of_b = fabs((double)(p->bx * m->nx + p->by * m->ny));
        arm = a && of_a < arm ? of_a : arm;
        arm = b && of_b < arm ? of_b : arm;
    }
    return arm;
}

typedef struct burden {
    bool deep;      // the contact gives way by more than it should
    double heavier; // it bears, of the weight of the heavier body, of those that move
} burden;

// False: it bears less than what makes it one that is pressed.
static bool burden_of(const look_at *s, const pl_manifold *m, burden *out)
{
    const double load = (double)m->point[0].normal + (double)m->point[1].normal;
    *out = (burden){ false, 0 };
    if (!(load > 0)) {
        return false;
    }
    const double a = inverse_mass(s, m->body_a), b = inverse_mass(s, m->body_b);
    const double lighter = a > b ? a : b, least = a > 0 && (b == 0 || a < b) ? a : b;
    const double stiffer = a > 0 && b > 0 ? 1 : 0.25, one = s->weight * s->h;
    const double way = load * (a + b) * stiffer * SOFTNESS * s->h;
    *out =
        (burden){ way > DEEP * arm_of(s, m), one > 0 ? load * least / one : (double)PL_UNBOUNDED };
    return out->deep && load * lighter > BURDEN * one;
}

// The heavier body is on the lighter one, and near it.
static bool is_above(const look_at *s, const pl_manifold *m)
{
    const plumb_vec2 g = s->world->gravity;
    const double down = (double)m->nx * (double)g.x + (double)m->ny * (double)g.y; // from A to B
    const bool b_heavier = inverse_mass(s, m->body_b) < inverse_mass(s, m->body_a);
    return (b_heavier ? -down : down) > ABOVE * s->weight;
}

// Uneven, whether the lighter body bears much already or not.
static bool is_uneven(const look_at *s, const pl_manifold *m, const burden *b)
{
    return pl_are_uneven(s->world, m->body_a, m->body_b) &&
           ((is_above(s, m) && pl_is_near(m, NEAR)) || (b->deep && b->heavier > BORNE));
}

static uint32_t contacts_of(const look_at *s, uint32_t row)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->contacts; ++i) {
        count += s->ends[i].a == row || s->ends[i].b == row;
    }
    return count;
}

// Contacts that have just come are looked at at once.
static void look_at_fresh(const look_at *s)
{
    const uint32_t *fresh = s->world->narrow.fresh.data;
    uint32_t asked =
        PL_NONE; // the first one that is heavier; a hub of a large island, more often than not
    bool large = false;
    for (uint32_t i = 0; i < s->world->narrow.fresh_count; ++i) {
        pl_pair *pair = &pl_pairs(&s->world->broad.pairs)[fresh[i]];
        if (pair->manifold >= s->contacts || !pl_are_uneven(s->world, pair->body_a, pair->body_b) ||
            (pair->flags & PL_PAIR_LARGE) != 0 ||
            !is_above(s, &pl_manifolds(&s->world->narrow)[pair->manifold])) {
            continue;
        }
        const bool a_heavier = inverse_mass(s, pair->body_a) < inverse_mass(s, pair->body_b);
        const uint32_t heavier = a_heavier ? pair->body_a : pair->body_b;
        if (asked == PL_NONE) {
            asked = heavier;
            large = contacts_of(s, heavier) > PL_HARD_MOST;
        }
        if (heavier == asked && large) {
            pair->flags |= PL_PAIR_LARGE;
        } else {
            pair->flags |= PL_PAIR_PRESSED;
            s->world->solver.hard_pressed = true;
        }
    }
}

static bool is_look_due(uint64_t step)
{
    return step % LOOK == 0 || (step < LOOK && (step & (step - 1)) == 0);
}

// Which contacts are loaded, and were so at the last look. A step that is taken anew looks anew: two flags take turns.
static void look(const look_at *s)
{
    const uint64_t n = s->world->step_count;
    const bool one = n < LOOK ? n == 2 || n == 8 : (n / LOOK & 1) == 0; // 1, 2, 4, 8, 16, 32, ...
    const uint32_t now = one ? PL_PAIR_LOADED_1 : PL_PAIR_LOADED_0;
    const uint32_t before = one ? PL_PAIR_LOADED_0 : PL_PAIR_LOADED_1;
    s->world->solver.hard_pressed = false;
    for (uint32_t i = 0; i < s->contacts; ++i) {
        const pl_manifold *m = &pl_manifolds(&s->world->narrow)[i];
        burden b;
        const bool loaded = burden_of(s, m, &b);
        pl_pair *pair = pl_pair_of(s->world, m);
        const uint32_t was = pair->flags;
        const bool pressed = (loaded && (was & before) != 0) || (s->uneven && is_uneven(s, m, &b));
        if (loaded || (was & (now | PL_PAIR_PRESSED | PL_PAIR_LARGE)) != 0) {
            pair->flags = (was & ~(now | PL_PAIR_PRESSED | PL_PAIR_LARGE)) | (loaded ? now : 0) |
                          (pressed ? PL_PAIR_PRESSED : 0);
        }
        s->world->solver.hard_pressed |= pressed;
    }
}

static bool masses_are_uneven(const plumb_world *world)
{
    const real *inverse = world->bodies.inv_mass;
    real least = inverse[0], most = inverse[0];
    for (uint32_t row = 1; row < world->dynamic_count; ++row) {
        least = inverse[row] < least ? inverse[row] : least;
        most = inverse[row] > most ? inverse[row] : most;
    }
    return (double)most > PL_UNEVEN * (double)least;
}

void pl_hard_look(plumb_world *world)
{
    look_at s = { .world = world,
                  .ends = world->narrow.ends.data,
                  .contacts = world->narrow.manifold_count,
                  .dynamic = world->dynamic_count,
                  .h = (double)world->soft_substep,
                  .weight = sqrt((double)world->gravity.x * (double)world->gravity.x +
                                 (double)world->gravity.y * (double)world->gravity.y) };
    if (s.contacts == 0) {
        return;
    }
    s.uneven = masses_are_uneven(world);
    if (s.h > 0 && is_look_due(world->step_count)) { // else no load is known
        look(&s);
    }
    if (s.uneven && s.weight > 0) {
        look_at_fresh(&s);
    }
}

//---- behind the substeps -------------------------------------------------------------------------------

// Islands that no substep came near to solving: sweeps may have them until the next look.
static void give_up(const plumb_world *world)
{
    const pl_exact_solver *e = &world->exact;
    const pl_exact_island *islands = e->islands.data;
    const pl_exact_item *items = e->items.data;
    for (uint32_t i = 0; i < e->island_count; ++i) {
        for (uint32_t k = islands[i].first_item; !islands[i].solved && k < islands[i].end_item;
             ++k) {
            if (items[k].joint == PL_NONE) {
                const uint32_t m = pl_classic_manifold(&world->solver, items[k].contact);
                pl_pair *pair =
                    &pl_pairs(&world->broad.pairs)[pl_manifolds(&world->narrow)[m].pair];
                pair->flags = (pair->flags & ~PL_PAIR_PRESSED) | PL_PAIR_LARGE;
            }
        }
    }
}

void pl_hard_note(plumb_world *world)
{
    if (world->quarantine.again) { // a step that is taken anew begins as it did
        return;
    }
    if (world->solver.hard_count > 0) {
        give_up(world);
    }
    pl_solver *solver = &world->solver;
    const uint32_t *hard = solver->hard_contacts.data;
    const bool any = solver->hard_before || solver->hard_count > 0;
    for (uint32_t i = 0, at = 0; any && i < world->narrow.manifold_count; ++i) {
        const uint32_t index = pl_manifolds(&world->narrow)[i].pair;
        pl_pair *pair = &pl_pairs(&world->broad.pairs)[index];
        const bool is_hard = at < solver->hard_count && hard[at] == i;
        at += is_hard;
        pair->flags = (pair->flags & ~PL_PAIR_EXACT) | (is_hard ? PL_PAIR_EXACT : 0);
    }
    solver->hard_before = solver->hard_count > 0;
}
