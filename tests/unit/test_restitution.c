// test_restitution.c - impacts in lanes (restitution.simd.c) are those of bounce.c: which contacts strike, how hard, and
// what the sweep is told. Stirred heaps of every kind of contact, at every width, bundle by bundle from the state in
// which a step has left them.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "solver/impact.c"  // impact_of: static there
#include "solver/substep.c" // open_step: static there

#include "plumb/plumb.h"

#include <math.h>
#include <string.h>

#define R(x) ((plumb_real)(x))
#define OFF  (PL_NEAR_IS_DOUBLE ? 1e-12 : 2e-5)

// A plank under more bodies than there are colours.
static void add_plank(plumb_world *w, plumb_material low)
{
    const plumb_shape_desc box = { .kind = PLUMB_BOX, .half = { R(40), R(0.3) }, .material = low };
    for (int i = 0; i < 2; ++i) {
        plumb_body b =
            plumb_body_create(w, &(plumb_body_desc){ .type = i == 0 ? PLUMB_STATIC : PLUMB_DYNAMIC,
                                                     .position = { R(100), R(0.7) * R(i) } });
        plumb_shape_create(w, b, &box);
    }
    for (int i = 0; i < 90; ++i) {
        plumb_body b = plumb_body_create(
            w, &(plumb_body_desc){ .position = { R(61) + R(0.85) * R(i), R(1.6) } });
        plumb_shape_create(
            w, b, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.4), .material = low });
    }
}

// `belt` [m/s]: the floor runs. `locked`: some bodies do not move along an axis.
static plumb_world *make_heap(int width, double belt, bool locked)
{
    plumb_world *w = NULL;
    const plumb_world_desc desc = { .no_fine_islands = true, // their lanes are not the world's
                                    .simd_width = width,
                                    .no_sleep = true,
                                    .contact_impulses = true };
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    plumb_material low = plumb_material_create(
        w, &(plumb_material_desc){ .friction = R(0.4), .restitution = R(0.1) });
    plumb_material dead = plumb_material_create(w, &(plumb_material_desc){ .friction = R(0.4) });
    plumb_material floor = plumb_material_create(
        w, &(plumb_material_desc){ .friction = R(0.4), .surface_speed = R(belt) });
    const plumb_vec2 at[] = { { 0, -1 }, { -9, 6 }, { 9, 6 } };
    const plumb_vec2 half[] = { { 12, 1 }, { 1, 8 }, { 1, 8 } };
    for (int i = 0; i < 3; ++i) {
        plumb_body b =
            plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = at[i] });
        plumb_shape_create(w, b,
                           &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                .half = half[i],
                                                .material = i == 0 ? floor : dead });
    }
    plumb_body arm = plumb_body_create(
        w,
        &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .position = { 0, 3 }, .angular_velocity = 3 });
    plumb_shape_create(w, arm, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 4, R(0.3) } });
    for (int i = 0; i < 240; ++i) {
        plumb_body b = plumb_body_create(
            w, &(plumb_body_desc){ .position = { R(i % 16) - R(7.5), R(0.6) + R(i / 16) },
                                   .angle = R(i),
                                   .lock_x = locked && i % 7 == 0,
                                   .lock_y = locked && i % 11 == 0 });
        plumb_shape_create(w, b,
                           &(plumb_shape_desc){ .kind = i % 3 == 0 ? PLUMB_CIRCLE : PLUMB_BOX,
                                                .radius = i % 3 == 0 ? R(0.4) : 0,
                                                .half = { R(0.4), R(0.3) },
                                                .material = i % 5 == 0 ? dead : low });
    }
    add_plank(w, low);
    return w;
}

typedef struct tally {
    uint32_t contacts, impacts, told, flips;
    double off; // relative to 1 m/s and the speed
} tally;

// Rows of one body.
typedef struct rows {
    pl_solver_body body;
    pl_solver_motion motion;
} rows;

typedef struct contact {
    pl_impact impact;
    rows before[2], after[2];
    near_real told[2];
} contact;

static rows rows_of(const pl_solver *s, uint32_t slot)
{
    return (rows){ pl_solver_bodies(s)[slot], pl_solver_motions(s)[slot] };
}

static void put_rows(const pl_solver *s, uint32_t slot, const rows *r)
{
    pl_solver_bodies(s)[slot] = r->body;
    pl_solver_motions(s)[slot] = r->motion;
}

// As prepared: behind a step, manifolds tell in its place when they were struck.
static near_real surface_speed_of(const plumb_world *w, const pl_contact_kernels *kernels,
                                  size_t lane)
{
    const size_t width = (size_t)kernels->width;
    const char *extras = w->solver.extras.data;
    return w->narrow.any_surface
               ? ((const near_real *)(const void *)(extras + lane / width *
                                                                 kernels->extra_size))[lane % width]
               : 0;
}

static contact contact_of(plumb_world *w, const pl_manifold *m, size_t lane)
{
    const pl_contact_kernels *kernels = pl_solver_kernels(w);
    contact c = { .impact = impact_of(w, m, 1) };
    c.impact.surface_speed = surface_speed_of(w, kernels, lane);
    c.before[0] = rows_of(&w->solver, c.impact.a);
    c.before[1] = rows_of(&w->solver, c.impact.b);
    for (uint32_t j = 0; j < m->count; ++j) {
        pl_impact_point *p = &c.impact.point[j];
        p->lane_separation = lane_value(&w->solver, kernels, lane, kernels->separation_offset[j]);
        p->lane_impulse = lane_value(&w->solver, kernels, lane, kernels->impulse_offset[j]);
    }
    return c;
}

// The rule: bounce.c, from the rows before. False: nothing strikes.
static bool strike_alone(plumb_world *w, contact *c, near_real h, bool clear[2])
{
    pl_approach at[2] = { { 0 }, { 0 } };
    near_real *struck = w->solver.struck.data;
    struck[c->impact.a] = struck[c->impact.b] = -h;
    c->impact.left = 1;
    pl_bounce_foresee(w, &c->impact, (double)h, at);
    const bool struck_now = c->impact.due && pl_bounce_resolve(w, &c->impact, at);
    if (struck_now) {
        struck[c->impact.a] = struck[c->impact.b] = -h;
        pl_bounce_foresee(w, &c->impact, (double)h, at);
    }
    clear[0] = c->impact.clear[0];
    clear[1] = c->impact.clear[1];
    return struck_now;
}

static double off_by(near_real a, near_real b)
{
    return fabs((double)(a - b)) / (1 + fabs((double)b));
}

static double rows_off(const rows *a, const rows *b)
{
    const pl_solver_body *p = &a->body, *q = &b->body;
    const pl_solver_motion *m = &a->motion, *n = &b->motion;
    double off = fmax(off_by(p->vx, q->vx), fmax(off_by(p->vy, q->vy), off_by(p->w, q->w)));
    off = fmax(off, fmax(off_by(p->dx, q->dx), fmax(off_by(p->dy, q->dy), off_by(p->da, q->da))));
    return fmax(off, fmax(off_by(m->ux, n->ux), fmax(off_by(m->uy, n->uy), off_by(m->uw, n->uw))));
}

static void check_contact(plumb_world *w, contact *c, near_real h, tally *t)
{
    const pl_solver *s = &w->solver;
    const uint32_t slot[2] = { c->impact.a, c->impact.b };
    bool clear[2], struck = false, moved = false;
    for (int k = 0; k < 2; ++k) {
        c->after[k] = rows_of(s, slot[k]);
        moved |= rows_off(&c->after[k], &c->before[k]) > 0;
        put_rows(s, slot[k], &c->before[k]);
    }
    struck = strike_alone(w, c, h, clear);
    ++t->contacts;
    t->impacts += struck;
    if (struck != moved) { // a close decision
        ++t->flips;
    } else {
        for (int k = 0; k < 2; ++k) {
            const rows alone = rows_of(s, slot[k]);
            const double off = rows_off(&c->after[k], &alone);
            t->flips += off > OFF; // one at a time or both: likewise
            t->off = off > OFF ? t->off : fmax(t->off, off);
        }
        for (uint32_t j = 0; j < c->impact.count; ++j) {
            const pl_impact_point *p = &c->impact.point[j];
            const bool off = *p->lane_impulse <= 0 && clear[j];
            const bool told = *p->lane_separation >= PL_APART / 2;
            t->told += told;
            t->flips += told != off;
            assert_true(told || *p->lane_separation == p->separation);
        }
    }
    for (int k = 0; k < 2; ++k) {
        put_rows(s, slot[k], &c->after[k]);
    }
}

// Contacts of one bundle have no body in common.
static void check_bundle(plumb_world *w, const pl_solving_step *step, uint32_t k, tally *t)
{
    const uint32_t width = (uint32_t)step->kernels->width, *lanes = step->call.lanes;
    contact contacts[16];
    uint32_t count = 0;
    for (uint32_t lane = k * width; lane < (k + 1) * width; ++lane) {
        const pl_manifold *m = lanes[lane] == PL_NONE ? NULL : &step->call.manifolds[lanes[lane]];
        if (m != NULL && m->restitution > 0) {
            contacts[count++] = contact_of(w, m, lane);
        }
    }
    const bool special = step->surface == PL_SPECIAL;
    (special ? step->kernels->bounce_special : step->kernels->bounce)(&step->call, k, 1);
    for (uint32_t i = 0; i < count; ++i) {
        check_contact(w, &contacts[i], step->call.h, t);
    }
}

// What bounce.c wants beside the rows: nothing is kept of rounding, nothing was struck.
static void make_room(plumb_world *w)
{
    pl_solver *s = &w->solver;
    assert_true(
        pl_buffer_reserve(&w->memory, &s->residuals, s->slot_count * 4 * sizeof(near_real)));
    assert_true(pl_buffer_reserve(&w->memory, &s->struck, s->slot_count * sizeof(near_real)));
}

static void check_heap(int width, double belt, bool locked)
{
    plumb_world *w = make_heap(width, belt, locked);
    tally t = { 0 };
    for (int i = 0; i < 200; ++i) {
        assert_int_equal(plumb_world_step(w, R(1) / 60), PLUMB_OK);
        make_room(w);
        pl_solving_step step = open_step(w, NULL, R(1) / 60);
        pl_soft_open(w, &step);
        for (uint32_t k = 0; k < w->solver.bundle_count; ++k) {
            memset(w->solver.residuals.data, 0, w->solver.slot_count * 4 * sizeof(near_real));
            check_bundle(w, &step, k, &t);
        }
    }
    print_message(
        "width %2d%s: %u contacts, %u struck, %u told to stay apart; %u decided otherwise, "
        "the others off by %.1g\n",
        width, locked ? ", locked axes" : "", t.contacts, t.impacts, t.told, t.flips, t.off);
    assert_true(t.contacts > 10000 && t.impacts > 1000 && t.told > 1000);
    assert_true(t.flips <= t.contacts / 1000);
    plumb_world_destroy(w);
}

static void lanes_strike_as_one_by_one(void **state)
{
    (void)state;
    for (int width = 4; width <= 16; width *= 2) {
        check_heap(width, 0, false);
        check_heap(width, 2, false);
        check_heap(width, 0, true);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lanes_strike_as_one_by_one),
    };
    return cmocka_run_group_tests_name("restitution", tests, NULL, NULL);
}
