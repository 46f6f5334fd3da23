// test_fracture_soak.c - a box full of bodies that break, are cut, merge and tumble for long: mass stays, all stays finite and in the box,
// nothing is thrown, memory stays flat, and twice the same bits.
// PLUMB_LONG
#include "harness/heap.h"
#include "harness/near.h"
#include "harness/trials.h"

#include <stdio.h>

#define R(x)  ((plumb_real)(x))
#define STEPS 1500

static uint64_t seed;

static double between(double low, double high)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * ((double)(seed >> 11) * 0x1p-53);
}

static plumb_body add(plumb_world *w, double x, double y)
{
    const plumb_body b = plumb_body_create(
        w, &(plumb_body_desc){ .position = { R(x), R(y) }, .angle = R(between(-3, 3)) });
    plumb_shape_desc d = { .kind = PLUMB_BOX, .half = { R(0.7), R(0.5) } };
    if (between(0, 1) < 0.3) {
        d = (plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.6) };
    }
    plumb_shape_create(w, b, &d);
    return b;
}

static plumb_world *make(heap *h)
{
    plumb_world *w;
    const plumb_world_desc desc = { .allocator = heap_allocator(h) };
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    const plumb_body walls = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    const double half[4][4] = {
        { 0, -6, 11, 1 }, { 0, 14, 11, 1 }, { -11, 4, 1, 11 }, { 11, 4, 1, 11 }
    };
    for (int i = 0; i < 4; ++i) {
        plumb_shape_create(w, walls,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                .center = { R(half[i][0]), R(half[i][1]) },
                                                .half = { R(half[i][2]), R(half[i][3]) } });
    }
    for (int i = 0; i < 30; ++i) {
        add(w, -8 + 3 * (i % 6), -3 + 2.2 * (i / 6));
    }
    return w;
}

static double mass_of(plumb_world *w)
{
    const plumb_body_span s = plumb_world_bodies(w);
    double mass = 0;
    for (int i = 0; i < s.count; ++i) {
        mass += (double)plumb_body_mass(w, s.body[i]);
    }
    return mass;
}

static plumb_body any(plumb_world *w)
{
    const plumb_body_span s = plumb_world_bodies(w);
    const int movable = s.count - s.static_count;
    return s.body[(int)between(0, movable)];
}

static int pieces_of(const plumb_world *w, plumb_body b)
{
    plumb_shape shapes[64];
    const int count = plumb_body_shapes(w, b, shapes, 64);
    int pieces = 0;
    for (int i = 0; i < count && i < 64; ++i) {
        pieces += plumb_shape_piece_count(w, shapes[i]);
    }
    return pieces;
}

typedef struct deeds {
    int cuts, shatters, merges, breaks;
} deeds;

// Gravity turns, so that all tumbles; of few bodies one is divided, of many two that touch become one.
static void act(plumb_world *w, int step, deeds *d)
{
    const double turn = 0.01 * step;
    plumb_world_set_gravity(w, plumb_v2(R(9 * sin(turn)), R(-9 * cos(turn))));
    const plumb_body b = any(w);
    const int count = plumb_world_bodies(w).count;
    if (step % 7 == 0 && (double)plumb_body_mass(w, b) > 0.5) {
        plumb_body_set_break_impulse(w, b, R(2));
        plumb_body_set_break_cells(w, b, 5);
    }
    if (count < 70 && step % 5 == 0 && (double)plumb_body_mass(w, b) > 0.15) {
        const plumb_vec2 c = plumb_body_center(w, b);
        const double a = between(-3, 3);
        if (step % 2 == 0) {
            d->cuts += plumb_body_cut(w, b, c, plumb_v2(R(cos(a)), R(sin(a))), NULL, 0) > 0;
        } else {
            const plumb_shatter_desc s = { .point = c, .cells = 6, .seed = seed };
            d->shatters += plumb_body_shatter(w, b, &s, NULL, 0) > 0;
        }
    }
    plumb_contact contacts[8];
    int touching = plumb_body_contacts(w, b, contacts, 8);
    touching = touching < 8 ? touching : 8;
    for (int i = 0; i < touching && plumb_world_bodies(w).count > 50; ++i) {
        const plumb_body other =
            plumb_same(contacts[i].body_a, b) ? contacts[i].body_b : contacts[i].body_a;
        // Pieces of those that merge add up.
        if (plumb_body_get_type(w, other) == PLUMB_DYNAMIC &&
            pieces_of(w, b) + pieces_of(w, other) <= 8 &&
            (double)(plumb_body_mass(w, b) + plumb_body_mass(w, other)) < 3) {
            assert_int_equal(plumb_body_merge(w, b, other, NULL), PLUMB_OK);
            ++d->merges;
            break;
        }
    }
}

static uint64_t soak(int steps, uint64_t first, bool tells)
{
    static heap h;
    h = (heap){ .fail_at = -1 };
    seed = first;
    plumb_world *w = make(&h);
    const double mass = mass_of(w);
    deeds d = { 0 };
    long middle = 0;
    for (int i = 0; i < steps; ++i) {
        act(w, i, &d);
        const double before = plumb_world_energy(w).kinetic;
        assert_int_equal(plumb_world_step(w, R(1.0 / 60)), PLUMB_OK);
        // What falls and turns over gains by weight: 27 kg at 9 m/s^2.
        assert_true(plumb_world_energy(w).kinetic < 1.1 * before + 100);
        int count;
        plumb_world_body_break_events(w, &count);
        d.breaks += count;
        middle = i == steps / 2 ? (long)h.bytes : middle;
    }
    const plumb_body_span s = plumb_world_bodies(w);
    for (int i = 0; i < s.count; ++i) {
        assert_true(fabs((double)s.center_x[i]) < 12 && fabs((double)s.center_y[i] - 4) < 12);
    }
    assert_near(mass_of(w) / mass, 1, ROUNDED(1e-6 * (d.cuts + d.shatters + d.merges + d.breaks)));
    if (tells) {
        printf("%d steps: %d cuts, %d shattered, %d merged, %d broke; %d bodies, mass off by %.1e, "
               "%ld then %ld bytes\n",
               steps, d.cuts, d.shatters, d.merges, d.breaks, s.count, mass_of(w) / mass - 1,
               middle, (long)h.bytes);
        assert_true(d.cuts > 10 && d.shatters > 10 && d.merges > 100 && d.breaks > 5);
    }
    assert_true((double)h.bytes < 1.6 * (double)middle);
    const uint64_t hash = plumb_world_hash(w);
    plumb_world_destroy(w);
    assert_int_equal(h.bytes, 0);
    return hash;
}

static void test_long_tumbling(void **state)
{
    (void)state;
    assert_true(soak(STEPS, 11, true) == soak(STEPS, 11, false));
    const trials t = trials_from(12, 2);
    for (uint32_t first = t.first; first < t.end; ++first) {
        soak(STEPS, first, true);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_long_tumbling) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
