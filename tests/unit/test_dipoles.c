// test_dipoles.c - forces, torques and energies of dipoles against sums over two charges that are close together, for every falloff,
// with softening and without, and against one another: slopes of the energy, action and reaction, no torque on the whole.
#include "harness/near.h"
#include "harness/random.h"
#include "effects/laws.h"

#include <stdbool.h>
#include <string.h>

#define R(x) ((plumb_real)(x))

// What a body is to laws.
typedef struct thing {
    double x, y, charge, mx, my;
} thing;

// Force on the second, torques on second and first, energy: what the library says, or what charges add up to.
typedef struct answer {
    double fx, fy, torque, back, energy;
} answer;

static pl_law_now law_of(const pl_law_data *d, double reach)
{
    return (pl_law_now){ .desc = d,
                         .c = 1,
                         .square = (double)d->softening * (double)d->softening,
                         .reach = reach,
                         .carrier = PL_NONE,
                         .member = PL_NONE };
}

static pl_law_body body_of(const thing *t)
{
    return (pl_law_body){
        .row = 7, .slot = PL_NONE, .charge = t->charge, .mx = t->mx, .my = t->my, .categories = 1
    };
}

static answer of_pair(const pl_law_now *law, const thing *a, const thing *b)
{
    const pl_law_body one = body_of(a), two = body_of(b);
    const pl_pole from = { &one, a->x, a->y, a->mx, a->my };
    const pl_pole to = { &two, b->x, b->y, b->mx, b->my };
    const pl_dipole_push p = pl_dipole_pair(law, &from, &to);
    return (answer){ p.fx, p.fy, p.torque, p.answer, pl_dipole_energy(law, &from, &to) };
}

static answer of_one(pl_law_now *law, const thing *a, const thing *b)
{
    const pl_law_body body = body_of(b);
    const pl_pole to = { &body, b->x, b->y, b->mx, b->my };
    law->x = a->x, law->y = a->y;
    const pl_dipole_push p = pl_dipole_in(law, &to, a->x, a->y);
    return (answer){ p.fx, p.fy, p.torque, p.answer, pl_dipole_energy_in(NULL, law, &to) };
}

//---- sums over charges ---------------------------------------------------------------------------

static double falloff_at(plumb_falloff kind, double s)
{
    const double powers[] = { -1.5, -1, -2, -0.5, 0 };
    return pow(s, powers[kind]);
}

// Of which the falloff is twice the derivative.
static double potential_at(plumb_falloff kind, double s)
{
    switch (kind) {
    case PLUMB_FALLOFF_INVERSE:
        return log(s) / 2;
    case PLUMB_FALLOFF_CUBE:
        return -1 / (2 * s);
    case PLUMB_FALLOFF_NONE:
        return sqrt(s);
    case PLUMB_FALLOFF_SPRING:
        return s / 2;
    default:
        return -1 / sqrt(s);
    }
}

typedef struct point_charge {
    double x, y, q; // from the body's centre
} point_charge;

// The body's own charge in the middle, and two ends that are 2 apart [m].
static void split(const thing *t, double apart, point_charge out[3])
{
    const double size = sqrt(t->mx * t->mx + t->my * t->my), q = size / (2 * apart);
    const double ux = size > 0 ? t->mx / size : 0, uy = size > 0 ? t->my / size : 0;
    out[0] = (point_charge){ 0, 0, t->charge };
    out[1] = (point_charge){ apart * ux, apart * uy, q };
    out[2] = (point_charge){ -apart * ux, -apart * uy, -q };
}

// c: what two charges have for energy is c q1 q2 g. Without what the two middles do to each other.
static answer of_charges(const pl_law_data *d, double c, const thing *a, const thing *b,
                         double apart)
{
    const double soft = (double)d->softening * (double)d->softening;
    point_charge from[3], to[3];
    answer sum = { 0 };
    split(a, apart, from), split(b, apart, to);
    for (int i = 0; i < 9; ++i) {
        const point_charge *p = &from[i / 3], *q = &to[i % 3];
        const double dx = b->x + q->x - a->x - p->x, dy = b->y + q->y - a->y - p->y;
        const double s = dx * dx + dy * dy + soft, k = c * p->q * q->q;
        if (i == 0 || k == 0) {
            continue;
        }
        const double f = -k * falloff_at(d->falloff, s), fx = f * dx, fy = f * dy;
        sum.fx += fx, sum.fy += fy;
        sum.torque += q->x * fy - q->y * fx;
        sum.back += p->y * fx - p->x * fy;
        sum.energy += k * potential_at(d->falloff, s);
    }
    return sum;
}

static double largest(const answer *a)
{
    const double v[] = { fabs(a->fx), fabs(a->fy), fabs(a->torque), fabs(a->back),
                         fabs(a->energy) };
    double most = 0;
    for (int i = 0; i < 5; ++i) {
        most = v[i] > most ? v[i] : most;
    }
    return most;
}

static answer less(const answer *a, const answer *b)
{
    return (answer){ a->fx - b->fx, a->fy - b->fy, a->torque - b->torque, a->back - b->back,
                     a->energy - b->energy };
}

// Ends come closer by half each time: what the sums are off by falls to a quarter.
static void assert_limit(const pl_law_data *d, double c, const thing *a, const thing *b,
                         answer have)
{
    answer sums[3], off[3];
    for (int i = 0; i < 3; ++i) {
        sums[i] = of_charges(d, c, a, b, 0.02 / (1 << i));
        off[i] = less(&sums[i], &have);
    }
    const double size = largest(&have) + 1e-30;
    for (int i = 0; i < 2; ++i) {
        const double ratio = largest(&off[i]) / (largest(&off[i + 1]) + 1e-11 * size);
        const bool rounded = largest(&off[i]) < 1e-10 * size;
        assert_true(rounded || fabs(ratio - 4) < 0.2);
    }
    // What is left when the error of second order is taken out is of fourth.
    answer fine = { 0 };
    fine.fx = (4 * sums[2].fx - sums[1].fx) / 3, fine.fy = (4 * sums[2].fy - sums[1].fy) / 3;
    fine.torque = (4 * sums[2].torque - sums[1].torque) / 3;
    fine.back = (4 * sums[2].back - sums[1].back) / 3;
    fine.energy = (4 * sums[2].energy - sums[1].energy) / 3;
    const answer left = less(&fine, &have);
    assert_true(largest(&left) < 1e-5 * size);
}

//---- cases ---------------------------------------------------------------------------------------

static thing anything(uint32_t *seed, double x)
{
    return (thing){ x + sim_uniform(seed, -0.5, 0.5), sim_uniform(seed, -1, 1),
                    sim_uniform(seed, -2, 2), sim_uniform(seed, -1, 1), sim_uniform(seed, -1, 1) };
}

static pl_law_data any_law(uint32_t *seed, int i, plumb_law_kind kind)
{
    return (pl_law_data){ .kind = kind,
                          .hold = PLUMB_LAW_ON_CHARGE,
                          .falloff = (plumb_falloff)(i % 5),
                          .strength = R(sim_uniform(seed, -3, 3)),
                          .softening = i / 5 % 2 == 0 ? 0 : R(0.4) };
}

static void pairs_are_the_limit_of_charges(void **state)
{
    (void)state;
    uint32_t seed = 11;
    for (int i = 0; i < 200; ++i) {
        const pl_law_data d = any_law(&seed, i, PLUMB_LAW_MUTUAL);
        const pl_law_now law = law_of(&d, INFINITY);
        thing a = anything(&seed, 0), b = anything(&seed, 1.7);
        if (i / 10 % 3 == 0) {
            a.mx = a.my = 0; // a charge and a dipole
        } else if (i / 10 % 3 == 1) {
            a.charge = b.charge = 0;
        }
        assert_limit(&d, -(double)d.strength, &a, &b, of_pair(&law, &a, &b));
    }
}

static void attractors_are_charges_of_one(void **state)
{
    (void)state;
    uint32_t seed = 12;
    for (int i = 0; i < 100; ++i) {
        const pl_law_data d = any_law(&seed, i, PLUMB_LAW_ATTRACTOR);
        pl_law_now law = law_of(&d, INFINITY);
        thing a = anything(&seed, 0), b = anything(&seed, 1.7);
        a.charge = 1, a.mx = a.my = 0;
        assert_limit(&d, (double)d.strength, &a, &b, of_one(&law, &a, &b));
    }
}

static double energy_at(const pl_law_now *law, const thing *a, thing b, double x, double y,
                        double turn)
{
    const double c = cos(turn), s = sin(turn), mx = b.mx, my = b.my;
    b.x += x, b.y += y;
    b.mx = c * mx - s * my, b.my = s * mx + c * my;
    return of_pair(law, a, &b).energy;
}

// The slope of the energy by differences of fourth order.
static double slope(const pl_law_now *law, const thing *a, const thing *b, double x, double y,
                    double turn)
{
    const double h = 1e-3;
    const double near = energy_at(law, a, *b, h * x, h * y, h * turn) -
                        energy_at(law, a, *b, -h * x, -h * y, -h * turn);
    const double far = energy_at(law, a, *b, 2 * h * x, 2 * h * y, 2 * h * turn) -
                       energy_at(law, a, *b, -2 * h * x, -2 * h * y, -2 * h * turn);
    return (8 * near - far) / (12 * h);
}

// Force and torque are slopes of the energy, and a pair neither pulls nor turns itself.
static void pairs_follow_from_one_energy(void **state)
{
    (void)state;
    uint32_t seed = 13;
    for (int i = 0; i < 200; ++i) {
        const pl_law_data d = any_law(&seed, i, PLUMB_LAW_MUTUAL);
        const pl_law_now law = law_of(&d, INFINITY);
        const thing a = anything(&seed, 0), b = anything(&seed, 1.7);
        const answer have = of_pair(&law, &a, &b), back = of_pair(&law, &b, &a);
        const double size = largest(&have);
        assert_near(have.fx, -slope(&law, &a, &b, 1, 0, 0), 1e-7 * size);
        assert_near(have.fy, -slope(&law, &a, &b, 0, 1, 0), 1e-7 * size);
        assert_near(have.torque, -slope(&law, &a, &b, 0, 0, 1), 1e-7 * size);
        const double dx = b.x - a.x, dy = b.y - a.y;
        const double whole = have.torque + have.back + dx * have.fy - dy * have.fx;
        assert_true(fabs(whole) < 1e-14 * size);
        assert_true(fabs(have.fx + back.fx) < 1e-14 * size);
        assert_true(fabs(have.torque - back.back) < 1e-14 * size);
        assert_true(fabs(have.energy - back.energy) < 1e-14 * size);
    }
}

// Of textbooks, where charges have 1/r^2: Jackson 4.1, in units of k.
static void close_cases_are_those_of_textbooks(void **state)
{
    (void)state;
    const double r = 2, k = 3, p = 0.5, q = 0.7;
    const pl_law_data d = { .kind = PLUMB_LAW_MUTUAL,
                            .hold = PLUMB_LAW_ON_CHARGE,
                            .strength = R(3) };
    const pl_law_now law = law_of(&d, INFINITY);
    const thing single = { 0, 0, q, 0, 0 }, along = { 0, 0, 0, p, 0 }, across = { 0, 0, 0, 0, p };
    thing far = { r, 0, 0, p, 0 };
    answer got = of_pair(&law, &single, &far);
    assert_near(got.fx, -2 * k * q * p / (r * r * r), 1e-15); // its nearer end is the negative one
    assert_near(got.torque, 0, 1e-15);
    got = of_pair(&law, &along, &far);
    assert_near(got.fx, -6 * k * p * p / (r * r * r * r), 1e-15);
    far.mx = 0, far.my = p;
    got = of_pair(&law, &single, &far);
    assert_near(got.torque, -k * q * p / (r * r), 1e-15);
    assert_near(got.fx, 0, 1e-15);
    got = of_pair(&law, &across, &far);
    assert_near(got.fx, 3 * k * p * p / (r * r * r * r), 1e-15);
    assert_near(got.energy, k * p * p / (r * r * r), 1e-15);
}

static void what_does_not_act_is_nothing(void **state)
{
    (void)state;
    const thing a = { 0, 0, 1, 1, 2 }, b = { 1, 2, 1, 2, 1 };
    pl_law_data d = { .kind = PLUMB_LAW_MUTUAL, .hold = PLUMB_LAW_ON_CHARGE, .strength = 1 };
    const pl_law_now far = law_of(&d, INFINITY), near = law_of(&d, 2);
    answer none = of_pair(&near, &a, &b);
    assert_true(largest(&none) == 0);
    d.categories = 2; // not theirs
    none = of_pair(&far, &a, &b);
    assert_true(largest(&none) == 0);
    d.categories = 3;
    none = of_pair(&far, &a, &b);
    assert_true(largest(&none) > 0);
    pl_law_body named = body_of(&a), other_one = body_of(&b);
    other_one.categories = 4; // both have to be
    const pl_pole one = { &named, 0, 0, 1, 2 }, two = { &other_one, 1, 2, 2, 1 };
    assert_true(pl_dipole_pair(&far, &one, &two).fx == 0);
    assert_true(pl_dipole_pair(&far, &two, &one).fx == 0);
    assert_true(pl_dipole_energy(&far, &one, &two) == 0);
    d.hold = PLUMB_LAW_ON_MASS;
    none = of_pair(&far, &a, &b);
    assert_true(largest(&none) == 0);
    d.hold = PLUMB_LAW_ON_CHARGE, d.kind = PLUMB_LAW_MAGNETIC;
    pl_law_now other = law_of(&d, INFINITY);
    none = of_one(&other, &a, &b);
    assert_true(largest(&none) == 0);
    d.kind = PLUMB_LAW_UNIFORM, d.vector = plumb_v2(3, 4);
    other = law_of(&d, INFINITY);
    none = of_one(&other, &a, &b);
    assert_near(none.torque, 2 * 4 - 1 * 3, 0);
    assert_near(none.energy, -(2 * 3 + 1 * 4), 0);
    assert_near(none.fx, 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pairs_are_the_limit_of_charges),
        cmocka_unit_test(attractors_are_charges_of_one),
        cmocka_unit_test(pairs_follow_from_one_energy),
        cmocka_unit_test(close_cases_are_those_of_textbooks),
        cmocka_unit_test(what_does_not_act_is_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
