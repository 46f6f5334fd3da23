// test_soft_sleep.c - soft bodies fall asleep with what they hold and touch, lie still, wake by all that concerns them, and end
// where they would have without sleep. Scenes and disturbances are drawn by a seed.
// PLUMB_LONG
#include "harness/sim.h"
#include "harness/trials.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define R(x)  ((plumb_real)(x))
#define DISCS 4

static const double dt = 1.0 / 60;

typedef enum kind { LYING, HUNG, JELLY, SKIN, CLOTH, BRIDGE, SWING, KINDS } kind;

// A soft body over a floor, discs on it or held by it.
typedef struct place {
    plumb_world *w;
    plumb_body floor, ledge, disc[DISCS];
    plumb_shape ground, wind;
    plumb_material stone, breeze;
    plumb_softbody soft;
    int discs;
    kind kind;
} place;

static double among(uint32_t *seed, double low, double high)
{
    return low + (high - low) * (double)(sim_random(seed) % 10001) / 10000;
}

static plumb_body disc(plumb_world *w, double x, double y, double r, double density)
{
    const plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .position = { R(x), R(y) } });
    plumb_shape_create(
        w, b, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(r), .density = R(density) });
    return b;
}

static plumb_softbody hung(plumb_world *w, double y, double mass, double damping, double drag)
{
    return plumb_rope_create(w, &(plumb_rope_desc){ .from = { -2, R(y) },
                                                    .to = { 2, R(y) },
                                                    .length = R(4.3),
                                                    .mass = R(mass),
                                                    .damping = R(damping),
                                                    .drag = R(drag),
                                                    .hold_from = true,
                                                    .hold_to = true });
}

static void make_soft(place *p, uint32_t *seed)
{
    const double drag = among(seed, 1, 3), mass = among(seed, 2, 6), y = among(seed, 0.7, 1.2);
    const plumb_vec2 box[4] = {
        { -R(0.5), R(y) }, { R(0.5), R(y) }, { R(0.5), R(y + 0.8) }, { -R(0.5), R(y + 0.8) }
    };
    switch (p->kind) {
    case LYING:
        p->soft = plumb_rope_create(p->w, &(plumb_rope_desc){ .from = { -1, R(y) },
                                                              .to = { 1, R(y + 0.3) },
                                                              .mass = R(mass),
                                                              .drag = R(drag) });
        break;
    case JELLY:
        p->soft = plumb_jelly_create(
            p->w,
            &(plumb_jelly_desc){ .points = box, .count = 4, .spacing = R(0.2), .drag = R(drag) });
        break;
    case SKIN:
        p->soft = plumb_skin_create(
            p->w, &(plumb_skin_desc){
                      .center = { 0, R(y) }, .damping = 5, .drag = R(drag), .nodes = 24 });
        break;
    case CLOTH:
        p->soft = plumb_cloth_create(p->w, &(plumb_cloth_desc){ .low = { -1, 2 },
                                                                .high = { 1, 3 },
                                                                .columns = 8,
                                                                .drag = R(drag),
                                                                .hold_corners = true });
        break;
    case SWING: // a disc on a rope
        p->disc[p->discs++] = disc(p->w, 0.3, 1.5, 0.2, 30);
        p->soft = plumb_rope_create(p->w, &(plumb_rope_desc){ .from = { 0, 3 },
                                                              .to = { R(0.3), R(1.7) },
                                                              .nodes = 8,
                                                              .drag = R(drag),
                                                              .damping = 30,
                                                              .mass = 1,
                                                              .hold_from = true,
                                                              .to_body = p->disc[0] });
        plumb_body_set_damping(p->w, p->disc[0], R(drag), R(drag));
        break;
    default:
        p->soft = hung(p->w, 2.5, mass, 40, drag);
        break;
    }
    if (p->kind == BRIDGE) {
        for (int i = 0; i < 3; ++i) {
            p->disc[p->discs] = disc(p->w, 0.5 * i - 0.5, 2.9, 0.2, 30);
            plumb_body_set_damping(p->w, p->disc[p->discs++], 1, 1);
        }
    }
}

static place make_place(kind k, uint32_t seed, bool no_sleep)
{
    place p = { .kind = k };
    p.w = sim_world(&(plumb_world_desc){ .no_sleep = no_sleep });
    p.stone = sim_material(p.w, 0.6, 0);
    p.floor =
        plumb_body_create(p.w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { 0, -1 } });
    p.ground = plumb_shape_create(
        p.w, p.floor,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 20, 1 }, .material = p.stone });
    p.ledge = plumb_body_create(
        p.w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .position = { 30, 2 } });
    plumb_shape_create(p.w, p.ledge, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 1, 1 } });
    p.breeze = plumb_material_create(
        p.w, &(plumb_material_desc){ .density = R(1.2), .fluid = true, .flow_x = R(0.01) });
    p.wind = plumb_shape_create(p.w, p.floor,
                                &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                                     .center = { 0, 3 },
                                                     .half = { 5, 2 },
                                                     .sensor = true,
                                                     .material = p.breeze });
    make_soft(&p, &seed);
    return p;
}

static bool is_asleep(const place *p)
{
    return !plumb_softbody_is_awake(p->w, p->soft);
}

// [s] until it sleeps; -1: it does not.
static double until_asleep(const place *p, double most)
{
    for (int i = 1; i * dt < most; ++i) {
        sim_step(p->w, dt);
        if (is_asleep(p)) {
            return i * dt;
        }
    }
    return -1;
}

static plumb_softbody_desc look(const place *p)
{
    plumb_softbody_desc d;
    assert_int_equal(plumb_softbody_settings(p->w, p->soft, &d), PLUMB_OK);
    return d;
}

// Its state; to be given back.
//---- they sleep, and lie still -------------------------------------------------------------------

// Every kind, with what it holds and carries: asleep in time, in no pass, and not a bit moves.
static void what_sleeps_does_not_move(void **state)
{
    (void)state;
    double latest = 0;
    for (uint32_t k = 0; k < 5 * KINDS; ++k) {
        place p = make_place((kind)(k % KINDS), 17 + k, false);
        const double when = until_asleep(&p, 40);
        assert_true(when > 0.5);
        latest = when > latest ? when : latest;
        assert_int_equal(plumb_world_stats(p.w).soft_asleep, 1);
        for (int i = 0; i < p.discs; ++i) { // they are of its island
            assert_false(plumb_body_is_awake(p.w, p.disc[i]));
        }
        const plumb_softbody_desc d = look(&p);
        plumb_softbody_node before[512];
        assert_true(d.node_count <= 512 && d.asleep);
        memcpy(before, d.nodes, (size_t)d.node_count * sizeof before[0]);
        plumb_body far = disc(p.w, 15, 0.5, 0.5, 1); // something moves elsewhere
        sim_launch(p.w, far, -1, 0, 0);
        sim_run(p.w, 60, dt);
        assert_true(is_asleep(&p));
        assert_memory_equal(before, look(&p).nodes, (size_t)d.node_count * sizeof before[0]);
        for (int i = 0; i < d.node_count; ++i) {
            assert_true(before[i].velocity.x == 0 && before[i].velocity.y == 0);
        }
        plumb_world_destroy(p.w);
    }
    print_message("asleep within %.1f s\n", latest);
}

static void who_may_not_sleep_keeps_awake(void **state)
{
    (void)state;
    for (uint32_t k = 0; k < 6; ++k) {
        place p = make_place(k % 2 == 0 ? BRIDGE : SWING, 90 + k, false);
        if (k < 2) {
            plumb_softbody_set_no_sleep(p.w, p.soft, true);
            assert_true(plumb_softbody_no_sleep(p.w, p.soft));
        } else if (k < 4) {
            plumb_body_set_no_sleep(p.w, p.disc[0], true);
        } else {
            plumb_world_set_sleep(p.w, false, 0, 0);
        }
        assert_true(until_asleep(&p, 20) < 0);
        for (int i = 0; i < p.discs; ++i) {
            assert_true(plumb_body_is_awake(p.w, p.disc[i]));
        }
        plumb_softbody_set_no_sleep(p.w, p.soft, false);
        plumb_body_set_no_sleep(p.w, p.disc[0], false);
        plumb_world_set_sleep(p.w, true, 0, 0);
        assert_true(until_asleep(&p, 20) > 0);
        plumb_world_destroy(p.w);
    }
}

// In gusts and on what moves nobody sleeps; a steady wind lets sleep.
static void what_is_never_the_same_keeps_awake(void **state)
{
    (void)state;
    place p = make_place(HUNG, 3, false);
    plumb_material_desc m;
    plumb_material_settings(p.w, p.breeze, &m);
    m.flow_x = 1, m.gust = R(0.5);
    plumb_material_set(p.w, p.breeze, &m);
    assert_true(until_asleep(&p, 20) < 0);
    m.gust = 0;
    plumb_material_set(p.w, p.breeze, &m);
    assert_true(until_asleep(&p, 20) > 0);
    plumb_world_destroy(p.w);

    p = make_place(LYING, 3, false);
    const plumb_body belt = plumb_body_create(
        p.w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .velocity = { R(0.01), 0 } });
    plumb_shape_create(p.w, belt, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 3, R(0.5) } });
    assert_true(until_asleep(&p, 20) < 0);
    plumb_body_set_velocity(p.w, belt, plumb_v2(0, 0));
    assert_true(until_asleep(&p, 20) > 0);
    plumb_world_destroy(p.w);

    // Nothing bears it, and nothing holds it: it drifts on, below sleep_speed.
    plumb_world *w = sim_space();
    const plumb_softbody adrift =
        plumb_skin_create(w, &(plumb_skin_desc){ .velocity = { R(0.02), 0 } });
    sim_run(w, 600, dt);
    assert_true(plumb_softbody_is_awake(w, adrift));
    plumb_world_destroy(w);
}

//---- they wake -----------------------------------------------------------------------------------

static void thrown(place *p)
{
    const plumb_softbody_desc d = look(p);
    const plumb_vec2 at = d.nodes[d.node_count / 2].position;
    sim_launch(p->w, disc(p->w, (double)at.x, (double)at.y + 0.9, 0.3, 10), 0, -40, 0);
}

static void lowered(place *p) // a kinematic body comes
{
    const plumb_softbody_desc d = look(p);
    const plumb_vec2 at = d.nodes[d.node_count / 2].position;
    plumb_body_set_position(p->w, p->ledge, plumb_v2(at.x, at.y + R(1.25)));
    plumb_body_set_velocity(p->w, p->ledge, plumb_v2(0, -20));
}

static void placed(place *p) // a static one
{
    const plumb_softbody_desc d = look(p);
    const plumb_body b = plumb_body_create(
        p->w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = d.nodes[3].position });
    plumb_shape_create(p->w, b, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.1) });
}

static void pulled_away(place *p)
{
    plumb_body_set_position(p->w, p->floor, plumb_v2(0, -3));
}

static void gone(place *p)
{
    plumb_body_destroy(p->w, p->floor);
}

static void set_material(place *p, plumb_material which, plumb_real friction, plumb_real flow)
{
    plumb_material_desc m;
    assert_int_equal(plumb_material_settings(p->w, which, &m), PLUMB_OK);
    m.friction = friction, m.flow_x = flow;
    assert_int_equal(plumb_material_set(p->w, which, &m), PLUMB_OK);
}

static void slippery(place *p)
{
    set_material(p, p->stone, R(0.1), 0);
}

static void heavier(place *p)
{
    plumb_world_set_gravity(p->w, plumb_v2(0, R(-9.9)));
}

static void windy(place *p)
{
    set_material(p, p->breeze, R(0.1), 2);
}

static void called(place *p)
{
    plumb_softbody_wake(p->w, p->soft);
}

static void forbidden(place *p)
{
    plumb_softbody_set_no_sleep(p->w, p->soft, true);
}

static void forbidden_all(place *p)
{
    plumb_world_set_sleep(p->w, false, 0, 0);
}

static void node_changed(place *p)
{
    plumb_softbody_node n = look(p).nodes[2];
    n.mass *= 2;
    plumb_softbody_set_node(p->w, p->soft, 2, &n);
}

static void edge_changed(place *p)
{
    plumb_softbody_edge e = look(p).edges[2];
    e.length *= R(1.01);
    plumb_softbody_set_edge(p->w, p->soft, 2, &e);
}

static void gas_changed(place *p)
{
    plumb_softbody_set_gas(p->w, p->soft, 600, 0);
}

static void held(place *p)
{
    plumb_softbody_hold(p->w, p->soft, 2, (plumb_body)PLUMB_NULL_INIT, look(p).nodes[2].position);
}

static void freed(place *p)
{
    plumb_softbody_release(p->w, p->soft, 0);
}

static void pushed(place *p)
{
    plumb_body_apply_force_center(p->w, p->disc[0], plumb_v2(3, 0));
}

static void struck(place *p)
{
    plumb_body_apply_impulse_center(p->w, p->disc[0], plumb_v2(R(0.5), 0));
}

static void taken(place *p)
{
    plumb_body_destroy(p->w, p->disc[0]);
    p->disc[0] = p->disc[--p->discs];
}

static void moved(place *p)
{
    plumb_body_set_position(p->w, p->disc[0], plumb_v2(8, 4));
}

#define OF(kind) (1u << (kind))
#define ON_FLOOR (OF(LYING) | OF(JELLY) | OF(SKIN))
#define ROPES    (OF(LYING) | OF(HUNG) | OF(BRIDGE) | OF(SWING))
#define ALL      (OF(KINDS) - 1)
#define LADEN    (OF(BRIDGE) | OF(SWING))

static const struct {
    const char *name;
    void (*does)(place *);
    unsigned kinds;
} wakers[] = {
    { "thrown", thrown, ALL },
    { "lowered", lowered, ALL },
    { "placed", placed, ALL },
    { "pulled away", pulled_away, ON_FLOOR },
    { "gone", gone, ON_FLOOR },
    { "slippery", slippery, ON_FLOOR },
    { "heavier", heavier, ALL },
    { "windy", windy, OF(HUNG) | OF(CLOTH) | OF(BRIDGE) | OF(SWING) },
    { "called", called, ALL },
    { "forbidden", forbidden, ALL },
    { "forbidden to all", forbidden_all, ALL },
    { "node changed", node_changed, ALL },
    { "edge changed", edge_changed, ROPES | OF(SKIN) | OF(CLOTH) },
    { "gas changed", gas_changed, OF(SKIN) },
    { "held", held, ALL },
    { "freed", freed, OF(HUNG) | OF(BRIDGE) | OF(SWING) },
    { "pushed", pushed, LADEN },
    { "struck", struck, LADEN },
    { "taken", taken, LADEN },
    { "moved", moved, LADEN },
};

// Each of these, in the very step; what it holds and touches wakes with it, and nothing jumps.
static void what_concerns_it_wakes_it(void **state)
{
    (void)state;
    double jump = 0;
    for (uint32_t k = 0; k < 3 * KINDS; ++k) {
        place p = make_place((kind)(k % KINDS), 400 + k, false);
        assert_true(until_asleep(&p, 40) > 0);
        size_t size;
        void *still = sim_save(p.w, &size);
        const place asleep = p;
        for (size_t i = 0; i < sizeof wakers / sizeof wakers[0]; ++i) {
            if ((wakers[i].kinds & OF(p.kind)) == 0) {
                continue;
            }
            p = asleep;
            assert_int_equal(plumb_world_restore(p.w, still, size), PLUMB_OK);
            assert_true(is_asleep(&p));
            plumb_softbody_node before[512];
            const int count = look(&p).node_count;
            memcpy(before, look(&p).nodes, (size_t)count * sizeof before[0]);
            wakers[i].does(&p);
            sim_step(p.w, dt);
            if (is_asleep(&p)) {
                fail_msg("kind %d sleeps on: %s", (int)p.kind, wakers[i].name);
            }
            for (int b = 0; b < p.discs; ++b) {
                if (!plumb_body_is_awake(p.w, p.disc[b])) {
                    fail_msg("kind %d, disc %d sleeps on: %s", (int)p.kind, b, wakers[i].name);
                }
            }
            const bool calm = wakers[i].does == called || wakers[i].does == forbidden ||
                              wakers[i].does == forbidden_all;
            for (int n = 0; n < count && calm; ++n) {
                const plumb_vec2 now = look(&p).nodes[n].position;
                const double way = sqrt(pow((double)(now.x - before[n].position.x), 2) +
                                        pow((double)(now.y - before[n].position.y), 2));
                jump = way > jump ? way : jump;
            }
        }
        free(still);
        plumb_world_destroy(p.w);
    }
    print_message("the farthest way in the step in which it wakes: %.2g m\n", jump);
    assert_true(jump < 2e-3);
}

// What passes, or reaches others, does not wake.
static void what_does_not_concern_it_lets_it_sleep(void **state)
{
    (void)state;
    for (uint32_t k = 0; k < KINDS; ++k) {
        place p = make_place((kind)k, 700 + k, false);
        assert_true(until_asleep(&p, 40) > 0);
        const plumb_softbody_desc d = look(&p);
        // What is there already.
        plumb_softbody_set_node(p.w, p.soft, 2, &d.nodes[2]);
        if (d.edge_count > 2) {
            plumb_softbody_set_edge(p.w, p.soft, 2, &d.edges[2]);
        }
        if (d.pressure > 0) {
            plumb_softbody_set_gas(p.w, p.soft, d.pressure, d.ambient);
        }
        // The arrays are those of the world, and may be others after a change.
        for (int i = 0; i < d.pin_count; ++i) {
            const plumb_softbody_pin pin = look(&p).pins[i];
            plumb_softbody_hold(p.w, p.soft, (int)pin.node, pin.body, pin.point);
        }
        sim_step(p.w, dt);
        assert_true(is_asleep(&p));
        plumb_real right = -100, top = -100;
        const plumb_softbody_desc now = look(&p);
        for (int i = 0; i < now.node_count; ++i) {
            right = now.nodes[i].position.x > right ? now.nodes[i].position.x : right;
            top = now.nodes[i].position.y > top ? now.nodes[i].position.y : top;
        }
        // 6 cm beside it: a disc in no gravity that turns on its place, a ledge that moves away, a sensor all over it.
        const plumb_body beside = disc(p.w, (double)right + 0.8, (double)top, 0.5, 1);
        plumb_body_set_gravity_scale(p.w, beside, 0);
        plumb_body_set_angular_velocity(p.w, beside, 3);
        const plumb_body ghost = plumb_body_create(
            p.w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .velocity = { R(0.1), 0 } });
        plumb_shape_create(
            p.w, ghost, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 5, 5 }, .sensor = true });
        plumb_body_set_velocity(p.w, p.ledge, plumb_v2(1, 0));
        const plumb_body apart = plumb_body_create(
            p.w, &(plumb_body_desc){ .type = PLUMB_STATIC, .position = { -18, 5 } });
        plumb_shape_create(p.w, apart,
                           &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.5) });
        sim_run(p.w, 120, dt);
        assert_true(is_asleep(&p));
        plumb_world_destroy(p.w);
    }
}

//---- asleep or not -------------------------------------------------------------------------------

// [m] the farthest of nodes and discs from where the other world has them.
static double apart(const place *p, const place *q)
{
    const plumb_softbody_desc a = look(p), b = look(q);
    double most = 0;
    for (int i = 0; i < a.node_count; ++i) {
        const double x = (double)(a.nodes[i].position.x - b.nodes[i].position.x);
        const double y = (double)(a.nodes[i].position.y - b.nodes[i].position.y);
        most = fmax(most, sqrt(x * x + y * y));
    }
    for (int i = 0; i < p->discs; ++i) {
        const double x = sim_x(p->w, p->disc[i]) - sim_x(q->w, q->disc[i]);
        const double y = sim_y(p->w, p->disc[i]) - sim_y(q->w, q->disc[i]);
        most = fmax(most, sqrt(x * x + y * y));
    }
    return most;
}

// It falls asleep when what it still has before it is small: a / w^2 for what swings, a t^2 for what creeps, a being the 8
// mm/s^2 that the rule of even motion does not see.
static void it_ends_where_it_would_without_sleep(void **state)
{
    (void)state;
    double worst[KINDS] = { 0 };
    const trials t = trials_from(0, 2 * KINDS);
    for (uint32_t k = t.first; k < t.end; ++k) {
        place p = make_place((kind)(k % KINDS), 1000 + k, false);
        place q = make_place((kind)(k % KINDS), 1000 + k, true);
        sim_run(p.w, 900, dt);
        sim_run(q.w, 900, dt);
        assert_true(is_asleep(&p) && !is_asleep(&q));
        worst[k % KINDS] = fmax(worst[k % KINDS], apart(&p, &q));
        plumb_world_destroy(p.w);
        plumb_world_destroy(q.w);
    }
    for (int k = 0; k < KINDS; ++k) {
        print_message("kind %d: %.2g m\n", k, worst[k]);
        assert_true(worst[k] < (k == BRIDGE ? 0.015 : 0.003)); // discs roll on it
    }
}

//---- always --------------------------------------------------------------------------------------

// [m] between a disc of radius 0.2 and the nearest node that may touch it.
static double gap_to(const place *p, int i)
{
    const plumb_softbody_desc d = look(p);
    const double x = sim_x(p->w, p->disc[i]), y = sim_y(p->w, p->disc[i]);
    double least = INFINITY;
    for (int n = 0; n < d.node_count; ++n) {
        bool pinned = false;
        for (int k = 0; k < d.pin_count; ++k) {
            pinned |= d.pins[k].node == (uint32_t)n;
        }
        const double dx = (double)d.nodes[n].position.x - x, dy = (double)d.nodes[n].position.y - y;
        const double gap = sqrt(dx * dx + dy * dy) - 0.2 - (double)d.nodes[n].radius;
        least = gap < least && !pinned ? gap : least;
    }
    return least;
}

static void disturb(place *p, uint32_t *seed)
{
    const int which = (int)(sim_random(seed) % (uint32_t)p->discs);
    const uint32_t what = sim_random(seed) % 6;
    const plumb_vec2 v = plumb_v2(R(among(seed, -1, 1)), R(among(seed, 0, 2)));
    if (what == 0) {
        plumb_body_set_velocity(p->w, p->disc[which], v);
    } else if (what == 1) {
        plumb_body_set_position(p->w, p->disc[which],
                                plumb_v2(R(among(seed, -1.5, 1.5)), R(among(seed, 2.5, 4))));
    } else if (what == 2) {
        plumb_softbody_wake(p->w, p->soft);
    } else if (what == 3) {
        plumb_softbody_sleep(p->w, p->soft);
    } else if (what == 4) {
        plumb_body_sleep(p->w, p->disc[which]);
    } else {
        plumb_body_wake(p->w, p->disc[which]);
    }
}

// What touches sleeps together or not at all, in every step; images in between change no bit.
static void what_touches_sleeps_together(void **state)
{
    (void)state;
    int slept = 0, together = 0;
    for (uint32_t k = 0; k < 6; ++k) {
        uint32_t seed = 5000 + k;
        place p = make_place(k % 3 == 0 ? JELLY : BRIDGE, seed, false);
        while (p.discs < DISCS) {
            p.disc[p.discs] = disc(p.w, 0.5 * p.discs - 1, 3.2 + p.discs, 0.2, 30);
            plumb_body_set_damping(p.w, p.disc[p.discs++], 1, 1);
        }
        place q = make_place(p.kind, 5000 + k, false); // of other slots, until it is restored
        for (int i = 0; i < 1500; ++i) {
            if (sim_random(&seed) % 150 == 0) {
                disturb(&p, &seed);
            }
            if (i % 100 == 50) {
                size_t size;
                void *now = sim_save(p.w, &size);
                assert_int_equal(plumb_world_restore(q.w, now, size), PLUMB_OK);
                free(now);
                sim_step(q.w, dt);
                sim_step(p.w, dt);
                assert_true(plumb_world_hash(p.w) == plumb_world_hash(q.w));
            } else {
                sim_step(p.w, dt);
            }
            const bool asleep = is_asleep(&p);
            slept += asleep;
            for (int b = 0; b < p.discs; ++b) {
                const bool touches = gap_to(&p, b) < 0.015;
                together += touches && asleep;
                if (touches && asleep == plumb_body_is_awake(p.w, p.disc[b])) {
                    fail_msg("case %u, step %d: disc %d touches and is %s", (unsigned)k, i, b,
                             asleep ? "awake" : "asleep");
                }
            }
        }
        plumb_world_destroy(p.w);
        plumb_world_destroy(q.w);
    }
    print_message("asleep in %d of 9000 steps, %d times a disc on it\n", slept, together);
    assert_true(slept > 500 && together > 500);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_sleeps_does_not_move),
        cmocka_unit_test(who_may_not_sleep_keeps_awake),
        cmocka_unit_test(what_is_never_the_same_keeps_awake),
        cmocka_unit_test(what_concerns_it_wakes_it),
        cmocka_unit_test(what_does_not_concern_it_lets_it_sleep),
        cmocka_unit_test(it_ends_where_it_would_without_sleep),
        cmocka_unit_test(what_touches_sleeps_together),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
