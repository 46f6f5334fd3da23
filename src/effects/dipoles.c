// dipoles.c - dipoles in laws on charge: two opposite charges whose distance goes to nothing, their moment p = charge times
// distance, along the body. What a bar magnet or a compass needle is in a plane, with poles for charges.
//
// A law on charge gives charges Q and q at a distance d the energy c Q q g(s), s = d^2 + softening^2, g' = f / 2, where f(s) is
// the falloff of law_forces.c: c = -k of a mutual law, the strength of an attractor, whose own charge is 1. A body of charge q
// and moment p is q + p . grad of that (Jackson, Classical Electrodynamics, 4.1), so two of them have beyond charge and charge
//
//     U = c [ f (q1 p2.d - q2 p1.d - p1.p2) - 2 f' (p1.d)(p2.d) ],   d = x2 - x1,   f' = df/ds = n f / s
//
// with n = -3/2, -1, -2, -1/2, 0 of 1/r^2, 1/r, 1/r^3, constant, r. Forces are its gradient, torques p x E of the field
// E1 = -c (q1 f d - p1 f - 2 f' (p1.d) d) of the other, in closed form: no difference of near places is taken. Force and torques
// of a pair come from one U that does not change when all is moved or turned, so momentum and angular momentum stay to rounding:
// t1 + t2 + d x F2 = 0. A uniform law turns, p x E, and does not pull. In a formula a dipole is two charges, 0.2 mm apart. Magnetic laws are out of the plane: they have nothing to do
// with a dipole in it.
//
// In a substep places and angles are those of its middle, as in law_forces.c: the leapfrog, of second order and symplectic, with a
// needle that swings at w stable below h w = 2. Bodies with a dipole are pushed, never fly, and so are all that
// are coupled with one.
//
// Reads: laws and bodies of the step, solver bodies. Writes: accelerations. Order: before law forces, whose magnetic turn takes
// in all that accelerates. Cost: O(bodies with dipoles laws) a substep, coupled bodies O(those that attract x all).
#include "effects/laws.h"

#include "core/sort.h"
#include "math/trig.h"
#include "schema/passes.h"

#include <math.h>

bool pl_want_dipoles(const plumb_world *world, const char **reason)
{
    const bool wanted =
        world->settings.dipoles > 0 && world->laws.count > 0 && world->dynamic_count > 0;
    *reason = wanted                        ? "some body has a dipole, and the world has laws"
              : world->settings.dipoles > 0 ? "nothing acts on dipoles: no law, or nobody is awake"
                                            : "no body has a dipole";
    return wanted;
}

bool pl_dipoles_reserve(plumb_world *world)
{
    pl_law_step *s = &world->laws.step;
    const size_t count = s->dipoles ? s->coupled_count : 0;
    return pl_buffer_reserve(&world->memory, &s->poles,
                             count * (sizeof(pl_pole) + sizeof(pl_dipole_push)));
}

void pl_dipole_moment(const pl_bodies *b, uint32_t row, const pl_body_settings *record,
                      double out[2])
{
    double s, c;
    pl_sincos((double)record->dipole_angle, &s, &c);
    const double x = (double)record->dipole * c, y = (double)record->dipole * s;
    out[0] = (double)b->c[row] * x - (double)b->s[row] * y;
    out[1] = (double)b->s[row] * x + (double)b->c[row] * y;
}

pl_pole pl_pole_of(const plumb_world *world, const pl_law_body *body)
{
    const pl_bodies *b = &world->bodies;
    const uint32_t row = body->row;
    return (pl_pole){ body, (double)b->center_x[row] + (double)b->residual_x[row],
                      (double)b->center_y[row] + (double)b->residual_y[row], body->mx, body->my };
}

//---- what acts -----------------------------------------------------------------------------------

static bool has_dipole(const pl_pole *p)
{
    return p->mx != 0 || p->my != 0;
}

static double dot(const pl_pole *p, double x, double y)
{
    return p->mx * x + p->my * y;
}

// The falloff, and its derivatives by the square of the distance.
typedef struct falloff {
    double f, slope, bend;
} falloff;

static falloff falloff_of(const pl_law_now *law, double square)
{
    static const double powers[] = { [PLUMB_FALLOFF_SQUARE] = -1.5,
                                     [PLUMB_FALLOFF_INVERSE] = -1,
                                     [PLUMB_FALLOFF_CUBE] = -2,
                                     [PLUMB_FALLOFF_NONE] = -0.5,
                                     [PLUMB_FALLOFF_SPRING] = 0 };
    const double f = pl_law_falloff(law, square), s = square + law->square;
    const double n = powers[law->desc->falloff];
    return f > 0 ? (falloff){ f, n * f / s, n * (n - 1) * f / (s * s) } : (falloff){ 0, 0, 0 };
}

static double energy_of(double c, const falloff *by, const pl_pole *a, const pl_pole *b)
{
    const double dx = b->x - a->x, dy = b->y - a->y, ad = dot(a, dx, dy), bd = dot(b, dx, dy);
    return c * (by->f * (a->body->charge * bd - b->body->charge * ad - dot(a, b->mx, b->my)) -
                2 * by->slope * ad * bd);
}

static pl_dipole_push push_of(double c, const falloff *by, const pl_pole *a, const pl_pole *b)
{
    const double dx = b->x - a->x, dy = b->y - a->y, ad = dot(a, dx, dy), bd = dot(b, dx, dy);
    const double qa = a->body->charge, qb = b->body->charge, f = by->f, g = 2 * by->slope;
    const double along = g * (qa * bd - qb * ad - dot(a, b->mx, b->my)) - 4 * by->bend * ad * bd;
    const double of_a = -f * qb - g * bd, of_b = f * qa - g * ad;
    return (pl_dipole_push){
        .fx = -c * (along * dx + of_a * a->mx + of_b * b->mx),
        .fy = -c * (along * dy + of_a * a->my + of_b * b->my),
        .torque = -c * (b->mx * (of_b * dy - f * a->my) - b->my * (of_b * dx - f * a->mx)),
        .answer = -c * (a->mx * (of_a * dy - f * b->my) - a->my * (of_a * dx - f * b->mx))
    };
}

static bool acts_between(const pl_law_now *law, const pl_pole *a, const pl_pole *b)
{
    const pl_law_data *d = law->desc;
    return d->kind == PLUMB_LAW_MUTUAL && d->hold == PLUMB_LAW_ON_CHARGE &&
           (has_dipole(a) || has_dipole(b)) && pl_law_names(d, a->body) && pl_law_names(d, b->body);
}

static falloff falloff_between(const pl_law_now *law, const pl_pole *a, const pl_pole *b)
{
    const double dx = b->x - a->x, dy = b->y - a->y;
    return falloff_of(law, dx * dx + dy * dy);
}

pl_dipole_push pl_dipole_pair(const pl_law_now *law, const pl_pole *a, const pl_pole *b)
{
    if (!acts_between(law, a, b)) {
        return (pl_dipole_push){ 0 };
    }
    const falloff by = falloff_between(law, a, b);
    return push_of(-(double)law->desc->strength, &by, a, b);
}

double pl_dipole_energy(const pl_law_now *law, const pl_pole *a, const pl_pole *b)
{
    if (!acts_between(law, a, b)) {
        return 0;
    }
    const falloff by = falloff_between(law, a, b);
    return energy_of(-(double)law->desc->strength, &by, a, b);
}

static bool acts_on(const pl_law_now *law, const pl_pole *pole)
{
    const pl_law_data *d = law->desc;
    return (d->kind == PLUMB_LAW_UNIFORM || d->kind == PLUMB_LAW_ATTRACTOR ||
            d->kind == PLUMB_LAW_FORMULA) &&
           d->hold == PLUMB_LAW_ON_CHARGE && has_dipole(pole) && pl_law_names(d, pole->body);
}

//---- formulas ------------------------------------------------------------------------------------

// [m] from the centre to either end of a dipole in a formula, whose slopes by the place are not known: there it is two charges.
#define END 1e-4

// The way from the centre to the positive end, and its charge [C].
static double end_of(const pl_pole *pole, double way[2])
{
    const double size = sqrt(pole->mx * pole->mx + pole->my * pole->my);
    way[0] = END * pole->mx / size, way[1] = END * pole->my / size;
    return size / (2 * END);
}

// Of a charge, as if the law had no end: whether it reaches so far is asked for the body.
static void formula_at(const plumb_world *world, const pl_law_now *law, const pl_law_state *at,
                       double time, double out[2])
{
    pl_law_data endless = *law->desc;
    pl_law_now free = *law;
    pl_law_body charge = { .row = PL_NONE, .mass = 1, .charge = 1, .categories = UINT64_MAX };
    endless.radius = 0, endless.half = (plumb_vec2){ 0, 0 };
    free.desc = &endless, free.reach = INFINITY;
    const pl_law_system one = { .world = world,
                                .laws = &free,
                                .law_count = 1,
                                .bodies = &charge,
                                .count = 1,
                                .replaces = true,
                                .formulas = true };
    pl_laws_pull(&one, at, time, out, NULL);
}

pl_dipole_push pl_dipole_in_formula(const plumb_world *world, const pl_law_now *law,
                                    const pl_pole *pole, const pl_law_state *state, double time)
{
    double way[2], ahead[2], behind[2];
    if (!acts_on(law, pole)) {
        return (pl_dipole_push){ 0 };
    }
    const double q = end_of(pole, way);
    pl_law_state at = *state;
    at.x = pole->x + way[0], at.y = pole->y + way[1];
    formula_at(world, law, &at, time, ahead);
    at.x = pole->x - way[0], at.y = pole->y - way[1];
    formula_at(world, law, &at, time, behind);
    return (pl_dipole_push){ .fx = q * (ahead[0] - behind[0]),
                             .fy = q * (ahead[1] - behind[1]),
                             .torque = q * (way[0] * (ahead[1] + behind[1]) -
                                            way[1] * (ahead[0] + behind[0])) };
}

static double energy_in_formula(const plumb_world *world, const pl_law_now *law,
                                const pl_pole *pole)
{
    double way[2];
    const double q = end_of(pole, way);
    return q * (pl_formula_potential(world, law, pole->x + way[0], pole->y + way[1]) -
                pl_formula_potential(world, law, pole->x - way[0], pole->y - way[1]));
}

//---- places --------------------------------------------------------------------------------------

// The charge of an attractor; its strength counts apart.
static const pl_law_body unit = { .charge = 1 };

pl_dipole_push pl_dipole_in(const pl_law_now *law, const pl_pole *pole, double x, double y)
{
    const pl_law_data *d = law->desc;
    if (!acts_on(law, pole) || d->kind == PLUMB_LAW_FORMULA) {
        return (pl_dipole_push){ 0 };
    }
    if (d->kind == PLUMB_LAW_UNIFORM) {
        return (pl_dipole_push){ .torque = pole->mx * (double)d->vector.y -
                                           pole->my * (double)d->vector.x };
    }
    const pl_pole source = { &unit, x, y, 0, 0 };
    const falloff by = falloff_between(law, &source, pole);
    return push_of((double)d->strength, &by, &source, pole);
}

double pl_dipole_energy_in(const plumb_world *world, const pl_law_now *law, const pl_pole *pole)
{
    const pl_law_data *d = law->desc;
    const bool endless = pl_law_is_endless(d);
    if (d->kind == PLUMB_LAW_FORMULA) {
        const bool known = acts_on(law, pole) && d->combine == PLUMB_LAW_ADD && d->radius == 0 &&
                           d->half.x == 0 && law->formula->is_potential;
        return known ? energy_in_formula(world, law, pole) : 0;
    }
    if (!acts_on(law, pole) || d->combine == PLUMB_LAW_REPLACE || law->carrier == pole->body->row ||
        (d->kind == PLUMB_LAW_UNIFORM && !endless)) {
        return 0;
    }
    if (endless) {
        return -dot(pole, (double)d->vector.x, (double)d->vector.y);
    }
    const pl_pole source = { &unit, law->x, law->y, 0, 0 };
    const falloff by = falloff_between(law, &source, pole);
    return energy_of((double)d->strength, &by, &source, pole);
}

//---- the row -------------------------------------------------------------------------------------

typedef struct passage {
    plumb_world *world;
    const pl_keyed *pushed;
    pl_pole *poles; // of those that are pushed together
    pl_dipole_push *pushes;
    double h, time; // [s] the substep; since the step began, in its middle
} passage;

static void add(pl_dipole_push *to, double fx, double fy, double torque)
{
    to->fx += fx, to->fy += fy;
    to->torque += torque;
}

// In the middle of the substep.
static pl_pole pole_now(const passage *p, const pl_law_body *body)
{
    const pl_law_state at = pl_law_middle(p->world, body, p->h);
    pl_pole pole = { body, at.x, at.y, body->mx, body->my };
    if (body->slot != PL_NONE && pl_law_has_dipole(body)) {
        const pl_solver_body *now = &pl_solver_bodies(&p->world->solver)[body->slot];
        double s, c;
        pl_sincos((double)now->da + p->h / 2 * (double)now->w, &s, &c);
        pole.mx = c * body->mx - s * body->my;
        pole.my = s * body->mx + c * body->my;
    }
    return pole;
}

// A body by uniform laws and attractors, as charges have them from law_forces.c; `alone`: no carrier is in reach.
static void push_one(const passage *p, const pl_pole *pole, bool alone, pl_dipole_push *out)
{
    const pl_law_step *step = &p->world->laws.step;
    int floor = INT32_MIN;
    for (uint32_t k = 0; k < step->law_count; ++k) {
        const pl_law_now *law = &pl_laws_now(p->world)[k];
        const pl_law_data *d = law->desc;
        const bool led = law->member != PL_NONE;
        if (!acts_on(law, pole) || d->priority < floor || law->carrier == pole->body->row ||
            (alone && led)) {
            continue;
        }
        const double x = led ? p->poles[law->member].x : law->x + law->vx * p->time;
        const double y = led ? p->poles[law->member].y : law->y + law->vy * p->time;
        if (!pl_law_is_endless(d) && !pl_law_reaches(law, pole->x - x, pole->y - y)) {
            continue;
        }
        if (d->combine == PLUMB_LAW_REPLACE) {
            floor = d->priority;
        }
        const pl_law_state at = pl_law_middle(p->world, pole->body, p->h);
        const pl_dipole_push more = law->formula != NULL
                                        ? pl_dipole_in_formula(p->world, law, pole, &at, p->time)
                                        : pl_dipole_in(law, pole, x, y);
        add(out, more.fx, more.fy, more.torque);
        if (led) {
            add(&p->pushes[law->member], -more.fx, -more.fy, 0);
        }
    }
}

// A force and a torque become what the solver is to add to velocities in a second. It has what time scales and locks of rotation
// make of inertias.
static void give(const passage *p, const pl_law_body *body, const pl_dipole_push *push)
{
    const pl_solver_body *now = &pl_solver_bodies(&p->world->solver)[body->slot];
    pl_solver_motion *motion = &pl_solver_motions(&p->world->solver)[body->slot];
    const uint32_t flags = p->world->bodies.flags[body->row];
    const double ease = body->time * body->time / body->mass;
    motion->ax += (flags & PL_BODY_LOCK_X) != 0 ? 0 : (near_real)(ease * push->fx);
    motion->ay += (flags & PL_BODY_LOCK_Y) != 0 ? 0 : (near_real)(ease * push->fy);
    motion->aw += (near_real)(push->torque * (double)now->inv_inertia);
}

static void push_single(void *context, uint32_t first, uint32_t count)
{
    const passage *p = context;
    for (uint32_t i = first; i < first + count; ++i) {
        const pl_law_body *body = &pl_law_bodies(p->world)[p->pushed[i].value];
        if (pl_law_has_dipole(body)) {
            const pl_pole pole = pole_now(p, body);
            pl_dipole_push push = { 0 };
            push_one(p, &pole, true, &push);
            give(p, body, &push);
        }
    }
}

static void push_pairs(const passage *p, const pl_law_now *law)
{
    const pl_law_step *step = &p->world->laws.step;
    const pl_law_body *bodies = pl_law_bodies(p->world);
    const bool any = law->desc->kind == PLUMB_LAW_MUTUAL && law->desc->hold == PLUMB_LAW_ON_CHARGE;
    for (uint32_t i = 0; i < step->source_count && any; ++i) {
        for (uint32_t k = i + 1; k < step->coupled_count; ++k) {
            if (bodies[i].slot == PL_NONE && bodies[k].slot == PL_NONE) {
                continue; // both sleep
            }
            const pl_dipole_push more = pl_dipole_pair(law, &p->poles[i], &p->poles[k]);
            add(&p->pushes[k], more.fx, more.fy, more.torque);
            add(&p->pushes[i], -more.fx, -more.fy, more.answer);
        }
    }
}

static void push_coupled(const passage *p)
{
    const pl_law_step *step = &p->world->laws.step;
    const pl_law_body *bodies = pl_law_bodies(p->world);
    for (uint32_t i = 0; i < step->coupled_count; ++i) {
        p->poles[i] = pole_now(p, &bodies[i]);
        p->pushes[i] = (pl_dipole_push){ 0 };
    }
    for (uint32_t k = 0; k < step->law_count; ++k) {
        push_pairs(p, &pl_laws_now(p->world)[k]);
    }
    for (uint32_t i = 0; i < step->coupled_count; ++i) {
        push_one(p, &p->poles[i], false, &p->pushes[i]);
    }
    for (uint32_t i = 0; i < step->coupled_count; ++i) {
        if (bodies[i].slot != PL_NONE) {
            give(p, &bodies[i], &p->pushes[i]);
        }
    }
}

// So many bodies are worth a thread.
#define LEAST 64

void pl_dipole_row(pl_substep *sub)
{
    const pl_law_step *step = &sub->world->laws.step;
    const pl_keyed *all = step->order.data;
    const pl_share mine =
        pl_substep_share(all, sizeof *all, offsetof(pl_keyed, order), step->pushed_count, sub);
    passage p = { .world = sub->world,
                  .pushed = all + mine.first,
                  .h = (double)sub->h,
                  .time = (double)sub->h * (sub->number + 0.5) };
    pl_tasks_ranges(sub->tasks, mine.end - mine.first, LEAST, push_single, &p);
    if (step->dipoles && sub->cluster == pl_clusters(&sub->world->solver)) {
        p.poles = step->poles.data;
        p.pushes = (pl_dipole_push *)(void *)(p.poles + step->coupled_count);
        push_coupled(&p);
    }
}
