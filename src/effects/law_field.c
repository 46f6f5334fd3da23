// law_field.c - laws as a field: what they give at a place, the energy that bodies have in them.
//
// Potentials are those of the pulls in law_forces.c: -q^(-1/2), log(q) / 2, -1 / (2 q), q^(1/2), q / 2 times k; of a law
// that ends at a distance, 0 there. Zones, formulas but potentials without end, and what replaces have none.
//
// Reads: laws, bodies. Writes: nothing. Cost: O(bodies laws), mutual laws O(those that attract x all).
#include "effects/laws.h"

#include "math/lanes.h"
#include "world/push.h"
#include "world/rows.h"

#include <math.h>

static double potential(plumb_falloff kind, double q)
{
    switch (kind) {
    case PLUMB_FALLOFF_INVERSE:
        return q > 0 ? pl_lane_log(q) / 2 : 0;
    case PLUMB_FALLOFF_CUBE:
        return q > 0 ? -1 / (2 * q) : 0;
    case PLUMB_FALLOFF_NONE:
        return sqrt(q);
    case PLUMB_FALLOFF_SPRING:
        return q / 2;
    default:
        return q > 0 ? -1 / sqrt(q) : 0;
    }
}

// Of a law of strength 1 at the square of a distance.
static double potential_of(const pl_law_now *law, double square)
{
    if (law->reach == INFINITY) {
        return potential(law->desc->falloff, square + law->square);
    }
    const double end = law->reach * law->reach;
    return square > end ? 0
                        : potential(law->desc->falloff, square + law->square) -
                              potential(law->desc->falloff, end + law->square);
}

static double of_one(const plumb_world *world, const pl_law_now *law, const pl_law_body *body,
                     double x, double y)
{
    const pl_law_data *d = law->desc;
    const double hold = pl_law_hold_of(d, body), dx = x - law->x, dy = y - law->y;
    if (d->combine == PLUMB_LAW_REPLACE || law->carrier == body->row) {
        return 0;
    }
    if (d->kind == PLUMB_LAW_ATTRACTOR) {
        return hold * (double)d->strength * potential_of(law, dx * dx + dy * dy);
    }
    if (law->formula != NULL) {
        const bool ends = d->radius > 0 || d->half.x > 0;
        return ends || !law->formula->is_potential || hold == 0
                   ? 0
                   : hold * pl_formula_potential(world, law, x, y);
    }
    const bool endless = d->kind == PLUMB_LAW_UNIFORM && pl_law_is_endless(d);
    return endless ? -hold * ((double)d->vector.x * x + (double)d->vector.y * y) : 0;
}

static double of_pair(const pl_law_now *law, const pl_law_body *a, const pl_law_body *b,
                      double square)
{
    return pl_law_pair(law, a, b) * potential_of(law, square);
}

// The i-th of the dynamic bodies, asleep or not.
static uint32_t row_of(const plumb_world *world, uint32_t i)
{
    return i < world->dynamic_count
               ? i
               : pl_partition_first(world, PL_PART_ASLEEP) + (i - world->dynamic_count);
}

pl_law_state pl_law_state_of(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    return (pl_law_state){ (double)b->center_x[row] + (double)b->residual_x[row],
                           (double)b->center_y[row] + (double)b->residual_y[row],
                           (double)b->vx[row] + (double)b->residual_vx[row],
                           (double)b->vy[row] + (double)b->residual_vy[row] };
}

static double of_body(const plumb_world *world, const pl_law_now *law, uint32_t i, uint32_t count)
{
    const pl_law_body body = pl_law_body_of(world, row_of(world, i));
    const pl_law_state at = pl_law_state_of(world, body.row);
    const pl_pole pole = pl_pole_of(world, &body);
    double sum = 0;
    if (law->desc->kind != PLUMB_LAW_MUTUAL) {
        return of_one(world, law, &body, at.x, at.y) + pl_dipole_energy_in(world, law, &pole);
    }
    for (uint32_t k = i + 1; k < count; ++k) {
        const pl_law_body other = pl_law_body_of(world, row_of(world, k));
        const pl_law_state there = pl_law_state_of(world, other.row);
        const pl_pole far = pl_pole_of(world, &other);
        const double dx = there.x - at.x, dy = there.y - at.y;
        sum += of_pair(law, &body, &other, dx * dx + dy * dy) + pl_dipole_energy(law, &pole, &far);
    }
    return sum;
}

double pl_laws_potential(const plumb_world *world)
{
    const uint32_t count = world->dynamic_count + world->asleep_count;
    double sum = 0;
    for (uint32_t k = 0; k < world->laws.count; ++k) {
        pl_law_now law;
        if (pl_law_place(world, &pl_law_items(&world->laws)[k], &law)) {
            for (uint32_t i = 0; i < count; ++i) {
                sum += of_body(world, &law, i, count);
            }
        }
    }
    return sum;
}

void pl_laws_at(const pl_law_system *of, const pl_law_state *state, double out[2])
{
    const plumb_world *world = of->world;
    const uint32_t count = world->dynamic_count + world->asleep_count;
    pl_laws_pull(of, state, 0, out, NULL);
    for (uint32_t k = 0; k < of->law_count; ++k) {
        const pl_law_now *law = &of->laws[k];
        for (uint32_t i = 0; i < count && law->desc->kind == PLUMB_LAW_MUTUAL; ++i) {
            const uint32_t row = row_of(world, i);
            if (row == of->bodies->row) {
                continue;
            }
            const pl_law_body body = pl_law_body_of(world, row);
            const pl_law_state at = pl_law_state_of(world, row);
            const double dx = at.x - state->x, dy = at.y - state->y, r = dx * dx + dy * dy;
            const double f = pl_law_pair(law, of->bodies, &body) * pl_law_falloff(law, r);
            const pl_pole from = pl_pole_of(world, &body);
            const pl_dipole_push more =
                pl_dipole_pair(law, &from, &(pl_pole){ of->bodies, state->x, state->y, 0, 0 });
            out[0] += f / of->bodies->mass * dx + more.fx / of->bodies->mass;
            out[1] += f / of->bodies->mass * dy + more.fy / of->bodies->mass;
        }
    }
}

// A law by itself, and one body.
static pl_law_system system_of(const plumb_world *world, const pl_law_now *law, pl_law_body *body)
{
    return (pl_law_system){ .world = world,
                            .laws = law,
                            .law_count = 1,
                            .bodies = body,
                            .count = 1,
                            .replaces = true,
                            .formulas = law->formula != NULL,
                            .others = true };
}

// The highest priority of those that replace others there; INT32_MIN: nothing is replaced.
static int floor_at(const plumb_world *world, plumb_law_hold hold, const pl_law_state *state)
{
    int floor = INT32_MIN;
    for (uint32_t k = 0; k < world->laws.count; ++k) {
        const pl_law_data *d = &pl_law_items(&world->laws)[k].desc;
        pl_law_now law;
        if (d->combine == PLUMB_LAW_REPLACE && d->hold == hold && d->priority > floor &&
            pl_law_place(world, &pl_law_items(&world->laws)[k], &law) &&
            (pl_law_is_endless(d) || pl_law_reaches(&law, state->x - law.x, state->y - law.y))) {
            floor = d->priority;
        }
    }
    return floor;
}

void pl_laws_probe(const plumb_world *world, const pl_law_state *state, double charge,
                   double out[2])
{
    const plumb_vec2 g = world->gravity;
    pl_law_body body = {
        .row = PL_NONE, .mass = 1, .weight = 1, .charge = charge, .categories = UINT64_MAX
    };
    const int floor[] = { floor_at(world, PLUMB_LAW_ON_MASS, state),
                          floor_at(world, PLUMB_LAW_ON_CHARGE, state) };
    out[0] = floor[0] == INT32_MIN ? (double)g.x : 0;
    out[1] = floor[0] == INT32_MIN ? (double)g.y : 0;
    for (uint32_t k = 0; k < world->laws.count; ++k) {
        pl_law_now law;
        double a[2];
        const pl_law_data *d = &pl_law_items(&world->laws)[k].desc;
        const bool placed = pl_law_place(world, &pl_law_items(&world->laws)[k], &law);
        const bool others = d->kind == PLUMB_LAW_MAGNETIC || d->kind == PLUMB_LAW_MUTUAL;
        if (!placed || (!others && d->priority < floor[d->hold])) {
            continue;
        }
        const pl_law_system one = system_of(world, &law, &body);
        pl_laws_at(&one, state, a);
        const double spin = pl_laws_spin(&one, &body, state, 0);
        out[0] += a[0] + spin * state->vy;
        out[1] += a[1] - spin * state->vx;
    }
}

// [m/s^2] that a law that moved gives a body's dipole; [2]: its farthest point, by the turn.
static void add_dipole(const plumb_world *world, const pl_law_now *law, const pl_law_body *body,
                       double out[3])
{
    const pl_bodies *b = &world->bodies;
    const pl_pole pole = pl_pole_of(world, body);
    if (pl_law_is_endless(law->desc) || pl_law_reaches(law, pole.x - law->x, pole.y - law->y)) {
        const pl_law_state at = pl_law_state_of(world, body->row);
        const pl_dipole_push push = law->formula != NULL
                                        ? pl_dipole_in_formula(world, law, &pole, &at, 0)
                                        : pl_dipole_in(law, &pole, law->x, law->y);
        out[0] += push.fx / body->mass, out[1] += push.fy / body->mass;
        out[2] += push.torque * (double)(b->inv_inertia[body->row] * b->extent[body->row]);
    }
}

static bool is_source(const pl_law_step *s, const pl_law_now *laws, const pl_law_body *body)
{
    bool any = false;
    for (uint32_t i = 0; i < s->law_count; ++i) {
        any |= pl_law_is_source(laws[i].desc, body);
    }
    return any;
}

bool pl_laws_stir(const plumb_world *world, uint32_t row)
{
    const pl_law_step *s = &world->laws.step;
    pl_law_body body = pl_law_body_of(world, row);
    const pl_law_state state = pl_law_state_of(world, row);
    const double least = (double)pl_push_tolerance(world);
    const bool source = is_source(s, pl_laws_now(world), &body); // laws.c asks for its rest
    for (uint32_t i = 0; i < s->law_count; ++i) {
        pl_law_now law = pl_laws_now(world)[i];
        double a[3] = { 0, 0, 0 };
        const bool mutual = law.desc->kind == PLUMB_LAW_MUTUAL && s->source_count > 0 && !source;
        const bool changes = law.formula != NULL && law.formula->uses_time != 0 &&
                             pl_law_has_dipole(&body); // of others law_formula.c asks
        if ((!law.moved && !mutual && !changes) || law.carrier == row) {
            continue;
        }
        law.member = PL_NONE;
        const pl_law_system one = system_of(world, &law, &body);
        pl_laws_at(&one, &state, a);
        add_dipole(world, &law, &body, a);
        if (a[0] * a[0] + a[1] * a[1] + a[2] * a[2] > least * least) {
            return true;
        }
    }
    return false;
}
