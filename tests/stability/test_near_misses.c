// test_near_misses.c - nothing pushes what does not touch it: bodies of all kinds fly by one another, clear by
// millimetres to decimetres, at any angle and speed, and go on as if they were alone. All solvers; float,
// double, far.
//
// A pass is clear by construction: seen along the line of flight, the mover's outline (or, if it spins, the
// circle that it sweeps) stays on one side of the target's. No sweep of the library is needed to know it.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/sim.h"
#include "harness/trials.h"

enum { MOST_POINTS = 12 };

typedef enum kind {
    CIRCLE,
    CAPSULE,
    BOX,
    POLYGON,
    ROUNDED,
    CROSS,   // two boxes of one body
    OUTLINE, // an L, decomposed
    MASSIVE, // so far bodies of any type, from here on static or kinematic ones
    SEGMENT = MASSIVE,
    CHAIN,
    KINDS
} kind;

static const char *const kind_names[KINDS] = { "circle", "capsule", "box",     "polygon", "rounded",
                                               "cross",  "outline", "segment", "chain" };

// A body's hull in its own frame: points and a radius around them.
typedef struct outline {
    int count;
    double x[MOST_POINTS], y[MOST_POINTS];
    double radius;
} outline;

static void add_point(outline *o, double x, double y)
{
    o->x[o->count] = x;
    o->y[o->count++] = y;
}

static void add_rectangle(outline *o, double hx, double hy)
{
    add_point(o, hx, hy);
    add_point(o, -hx, hy);
    add_point(o, -hx, -hy);
    add_point(o, hx, -hy);
}

static void add(plumb_world *w, plumb_body b, plumb_shape_desc desc)
{
    assert_true(plumb_shape_valid(w, plumb_shape_create(w, b, &desc)));
}

static void add_points(plumb_world *w, plumb_body b, const outline *o, plumb_shape_kind shape,
                       plumb_material m)
{
    plumb_vec2 points[MOST_POINTS];
    for (int i = 0; i < o->count; ++i) {
        points[i] = sim_vec(o->x[i], o->y[i]);
    }
    add(w, b,
        (plumb_shape_desc){ .kind = shape,
                            .points = points,
                            .count = o->count,
                            .radius = (plumb_real)o->radius,
                            .density = shape == PLUMB_SEGMENT || shape == PLUMB_CHAIN ? 0 : 1,
                            .material = m });
}

// Corners at rising angles on a circle: convex.
static void add_hull(outline *o, uint32_t *seed, double size)
{
    int corners = 3 + (int)(sim_random(seed) % 6);
    for (int i = 0; i < corners; ++i) {
        double at = 2 * SIM_PI * (i + sim_uniform(seed, 0, 0.7)) / corners;
        add_point(o, size * cos(at), size * sin(at));
    }
}

static outline add_shapes(plumb_world *w, plumb_body b, kind k, uint32_t *seed, plumb_material m)
{
    double size = 0.05 * pow(40, sim_uniform(seed, 0, 1)), aspect = sim_uniform(seed, 0.1, 1);
    outline o = { 0 };
    switch (k) {
    case CIRCLE:
        sim_add_circle(w, b, size, m);
        add_point(&o, 0, 0);
        o.radius = size;
        break;
    case CAPSULE:
        add_point(&o, -size, 0);
        add_point(&o, size, 0);
        o.radius = size * aspect;
        add_points(w, b, &o, PLUMB_CAPSULE, m);
        break;
    case BOX:
        add_rectangle(&o, size, size * aspect);
        sim_add_box(w, b, size, size * aspect, m);
        break;
    case ROUNDED:
    case POLYGON:
        add_hull(&o, seed, size);
        o.radius = k == ROUNDED ? size * aspect / 2 : 0;
        add_points(w, b, &o, PLUMB_POLYGON, m);
        break;
    case CROSS:
        add_rectangle(&o, size, size * aspect / 2);
        add_rectangle(&o, size * aspect / 2, size);
        sim_add_box(w, b, size, size * aspect / 2, m);
        sim_add_box(w, b, size * aspect / 2, size, m);
        break;
    case OUTLINE:
        for (int i = 0; i < 6; ++i) {
            static const double corner[6][2] = { { -1, -1 },  { 1, -1 }, { 1, -0.4 },
                                                 { 0, -0.4 }, { 0, 1 },  { -1, 1 } };
            add_point(&o, size * corner[i][0], size * corner[i][1]);
        }
        add_points(w, b, &o, PLUMB_OUTLINE, m);
        break;
    case SEGMENT:
        add_point(&o, -size, size * (aspect - 0.5));
        add_point(&o, size, 0);
        add_points(w, b, &o, PLUMB_SEGMENT, m);
        break;
    default:
        for (int i = 0; i < 6; ++i) {
            add_point(&o, size * (5 - 2 * i) / 2, size * aspect * sim_uniform(seed, 0, 1));
        }
        add_points(w, b, &o, PLUMB_CHAIN, m);
    }
    return o;
}

// How far the outline, turned, reaches along a unit vector.
static double reach_along(const outline *o, double angle, double x, double y)
{
    double c = cos(angle), s = sin(angle), most = -INFINITY;
    for (int i = 0; i < o->count; ++i) {
        most = fmax(most, x * (c * o->x[i] - s * o->y[i]) + y * (s * o->x[i] + c * o->y[i]));
    }
    return most + o->radius;
}

// Of a body, how far any point is from its centre of mass, and where that lies.
static double reach_of(const plumb_world *w, plumb_body b, const outline *o)
{
    plumb_vec2 center = plumb_body_local_center(w, b);
    double most = 0;
    for (int i = 0; i < o->count; ++i) {
        most = fmax(most, hypot(o->x[i] - (double)center.x, o->y[i] - (double)center.y));
    }
    return most + o->radius;
}

typedef struct miss {
    kind mover, target;
    plumb_body_type type;         // of the target
    double clear, speed, spin;    // [m], [m/s], [rad/s]
    double flight, turned, angle; // [rad] line of flight, angles of target and mover
    double restitution, dt;
    plumb_vec2 common; // [m/s] of both
    plumb_world_desc desc;
} miss;

static double log_uniform(uint32_t *seed, double low, double high)
{
    return low * pow(high / low, sim_uniform(seed, 0, 1));
}

static miss random_miss(uint32_t *seed)
{
    static const double restitutions[] = { 0, 0, 0.1, 0.5, 1 };
    static const int substeps[] = { 1, 4, 4, 8 };
    miss m = { .mover = (kind)(sim_random(seed) % MASSIVE),
               .target = (kind)(sim_random(seed) % KINDS) };
    m.type = m.target >= MASSIVE || sim_random(seed) % 2 == 0
                 ? (sim_random(seed) % 4 == 0 ? PLUMB_KINEMATIC : PLUMB_STATIC)
                 : PLUMB_DYNAMIC;
    m.clear = log_uniform(seed, 0.001, 0.3);
    m.speed = log_uniform(seed, 0.5, 200);
    m.spin = sim_random(seed) % 3 > 0 ? 0 : log_uniform(seed, 0.1, 100);
    m.turned = sim_random(seed) % 4 == 0 ? 0 : sim_uniform(seed, -SIM_PI, SIM_PI);
    m.angle = sim_random(seed) % 4 == 0 ? 0 : sim_uniform(seed, -SIM_PI, SIM_PI);
    m.flight = sim_random(seed) % 4 == 0 ? m.turned : sim_uniform(seed, -SIM_PI, SIM_PI);
    m.restitution = restitutions[sim_random(seed) % 5];
    m.dt = log_uniform(seed, 1.0 / 240, 1.0 / 30);
    m.desc = (plumb_world_desc){ .substeps = substeps[sim_random(seed) % 4],
                                 .solver = (plumb_solver)(sim_random(seed) % 3) };
    // Two that fall do so side by side; what stands still is passed in weightlessness.
    bool falls = m.type == PLUMB_DYNAMIC && sim_random(seed) % 2 == 0;
    m.desc.zero_gravity = !falls;
    if (m.type != PLUMB_STATIC && sim_random(seed) % 2 == 0) {
        m.common = sim_vec(sim_uniform(seed, -20, 20), sim_uniform(seed, -20, 20));
    }
    return m;
}

typedef struct pass {
    plumb_world *w;
    plumb_body mover, target;
    double way; // [m] until the two are apart again
} pass;

static pass set_up(const miss *m, uint32_t *seed)
{
    pass p = { .w = sim_world(&m->desc) };
    plumb_material material = sim_material(p.w, 0.6, m->restitution);
    p.target = sim_body(p.w, m->type, 0, 0, m->turned);
    outline target = add_shapes(p.w, p.target, m->target, seed, material);
    p.mover = sim_body(p.w, PLUMB_DYNAMIC, 0, 0, m->angle);
    outline mover = add_shapes(p.w, p.mover, m->mover, seed, material);
    double ux = cos(m->flight), uy = sin(m->flight), reach = reach_of(p.w, p.mover, &mover);
    // Aside is to the left of the flight. The mover's centre of mass flies straight.
    double c = cos(m->angle), s = sin(m->angle);
    plumb_vec2 local = plumb_body_local_center(p.w, p.mover);
    double lx = c * (double)local.x - s * (double)local.y,
           ly = s * (double)local.x + c * (double)local.y;
    double low =
        m->spin != 0 ? reach : reach_along(&mover, m->angle, uy, -ux) + (-uy * lx + ux * ly);
    double aside = reach_along(&target, m->turned, -uy, ux) + m->clear + low;
    double before = reach_along(&target, m->turned, -ux, -uy) + reach + 0.05 +
                    sim_uniform(seed, 0, 2) * m->speed * m->dt;
    p.way = before + reach_along(&target, m->turned, ux, uy) + reach + 0.05;
    double x = -before * ux - aside * uy, y = -before * uy + aside * ux;
    assert_int_equal(
        plumb_body_teleport(p.w, p.mover, sim_vec(x - lx, y - ly), (plumb_real)m->angle), PLUMB_OK);
    sim_launch(p.w, p.mover, m->speed * ux + (double)m->common.x,
               m->speed * uy + (double)m->common.y, m->spin);
    if (m->type != PLUMB_STATIC) {
        sim_launch(p.w, p.target, (double)m->common.x, (double)m->common.y, 0);
    }
    return p;
}

// [m/s] by how much the relative velocity has changed, spin times a metre included.
static double deflection(const pass *p, const miss *m)
{
    double ux = cos(m->flight), uy = sin(m->flight);
    double vx = sim_vx(p->w, p->mover) - sim_vx(p->w, p->target);
    double vy = sim_vy(p->w, p->mover) - sim_vy(p->w, p->target);
    return hypot(vx - m->speed * ux, vy - m->speed * uy) + fabs(sim_w(p->w, p->mover) - m->spin) +
           fabs(sim_w(p->w, p->target));
}

static int events_of(const plumb_world *w)
{
    int begins, hits;
    plumb_world_begin_events(w, &begins);
    plumb_world_hit_events(w, &hits);
    return begins + hits;
}

static bool is_deflected(uint32_t *seed, int number)
{
    miss m = random_miss(seed);
    pass p = set_up(&m, seed);
    int told = 0;
    for (double way = 0; way < p.way; way += m.speed * m.dt) {
        sim_step(p.w, m.dt);
        told += events_of(p.w);
    }
    double by = deflection(&p, &m);
    bool bad = told > 0 || !(by < 1e-4 * (1 + m.speed + fabs(m.spin)));
    if (bad) {
        print_message("pass %d: %s by %s (type %d), clear %.4f m, %.3g m/s, spin %.3g, e %.2g, "
                      "solver %d x%d, dt %.4f: changed by %.3g, %d events\n",
                      number, kind_names[m.mover], kind_names[m.target], (int)m.type, m.clear,
                      m.speed, m.spin, m.restitution, (int)m.desc.solver, m.desc.substeps, m.dt, by,
                      told);
    }
    plumb_world_destroy(p.w);
    return bad;
}

static void what_misses_is_not_touched(void **state)
{
    (void)state;
    const int count = (int)trials_count(5000);
    int bad = 0;
    uint32_t seed = 20261;
    for (int i = 0; i < count; ++i) {
        bad += is_deflected(&seed, i);
    }
    print_message("%d of %d passes deflected\n", bad, count);
    assert_int_equal(bad, 0);
}

//---- beside a wall ---------------------------------------------------------------------------------

// A disc strikes a wall of no friction, and leaves by e; something stands beside both ways, clear of them.
static bool is_deflected_behind_a_wall(uint32_t *seed, int number)
{
    miss m = random_miss(seed);
    const double r = log_uniform(seed, 0.05, 0.5), tilt = sim_uniform(seed, -1.4, 1.4);
    m.desc.zero_gravity = true;
    plumb_world *w = sim_world(&m.desc);
    plumb_material material = sim_material(w, 0, m.restitution);
    // The wall is the line through the origin along the flight; free space is to the left.
    const double ux = cos(m.flight), uy = sin(m.flight), nx = -uy, ny = ux;
    plumb_body wall = sim_body(w, PLUMB_STATIC, -5 * nx, -5 * ny, m.flight);
    sim_add_box(w, wall, 500, 5, material);
    // It strikes the wall at the origin; it comes along (sin tilt, -cos tilt), and leaves along (sin tilt, e cos tilt).
    const double e = m.restitution, in_x = sin(tilt), in_y = -cos(tilt), out_y = e * cos(tilt);
    plumb_body target = sim_body(w, PLUMB_STATIC, 0, 0, m.turned);
    outline o = add_shapes(w, target, m.target, seed, material);
    // Beside the way out: the side to which the disc does not come in.
    const double out = hypot(in_x, out_y), ox = in_x / out, oy = out_y / out;
    const double sx = ox * ux + oy * nx, sy = ox * uy + oy * ny; // the way out in the world
    double side_x = in_x >= 0 ? sy : -sy, side_y = in_x >= 0 ? -sx : sx;
    if (e == 0) { // it slides along the wall: above it is the only side
        side_x = nx, side_y = ny;
    }
    // What hardly bounces is stopped as of the beginning of the substep in which it strikes: it comes down on a straight
    // line to where it is at its end.
    const double h = m.dt / (double)(m.desc.substeps > 0 ? m.desc.substeps : 1);
    m.clear += e < 0.2 ? m.speed * cos(tilt) * h : 0;
    // The middle of the target beside a point of the way out, within some steps of the wall.
    const double far = sim_uniform(seed, 0, 2) * m.speed * m.dt;
    const double low = reach_along(&o, m.turned, -side_x, -side_y);
    const double aside = r + m.clear + low;
    const double x = r * nx + far * sx + aside * side_x, y = r * ny + far * sy + aside * side_y;
    // Clear of the way in, too, or this is another experiment.
    const double ix = in_x * ux + in_y * nx, iy = in_x * uy + in_y * ny;
    const double in_side = -iy * x + ix * y - (-iy * r * nx + ix * r * ny);
    const double sign = in_side < 0 ? -1 : 1;
    const double in_clear = fabs(in_side) - reach_along(&o, m.turned, sign * iy, -sign * ix) - r;
    bool bad = false;
    if (in_clear > 0.001) {
        assert_int_equal(plumb_body_teleport(w, target, sim_vec(x, y), (plumb_real)m.turned),
                         PLUMB_OK);
        plumb_body ball = sim_ball(w, 0, 0, r, material);
        const double before = sim_uniform(seed, 0.01, 3) * m.speed * m.dt;
        assert_int_equal(
            plumb_body_teleport(w, ball, sim_vec(r * nx - before * ix, r * ny - before * iy), 0),
            PLUMB_OK);
        sim_launch(w, ball, m.speed * ix, m.speed * iy, 0);
        for (int i = 0; i < 12; ++i) {
            sim_step(w, m.dt);
        }
        // What the wall makes of it, by the law.
        const double vx = m.speed * (in_x * ux + out_y * nx),
                     vy = m.speed * (in_x * uy + out_y * ny);
        const double by = hypot(sim_vx(w, ball) - vx, sim_vy(w, ball) - vy);
        bad = !(by < 1e-3 * (1 + m.speed));
        if (bad) {
            print_message("bounce %d: by %s, clear %.4f m, %.3g m/s, tilt %.2f, e %.2g, r %.3f, "
                          "solver %d x%d, "
                          "dt %.4f: changed by %.3g\n",
                          number, kind_names[m.target], m.clear, m.speed, tilt, e, r,
                          (int)m.desc.solver, m.desc.substeps, m.dt, by);
        }
    }
    plumb_world_destroy(w);
    return bad;
}

static void what_bounces_by_is_not_touched(void **state)
{
    (void)state;
    const int count = (int)trials_count(5000);
    int bad = 0;
    uint32_t seed = 471;
    for (int i = 0; i < count; ++i) {
        bad += is_deflected_behind_a_wall(&seed, i);
    }
    print_message("%d of %d bounces deflected\n", bad, count);
    // A sweep takes the straight line between the ends of a step, which may cut a corner that the disc went round
    // (src/continuous/README.md, what is promised). Before contacts ahead were looked at again, 952 of 5000 were deflected.
    assert_true(bad <= count / 200);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_misses_is_not_touched),
        cmocka_unit_test(what_bounces_by_is_not_touched),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
