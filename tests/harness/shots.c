// shots.c - see shots.h. Reads: a shot. Writes: a world of its own. An engine that refuses a shape
// ends the program: a shot that is not fired must not count as one that was stopped.
#include "harness/random.h"
#include "harness/shots.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

enum { WALL_PIECES = 50, MOST_POINTS = 12 };

#define WALL_HALF  500.0 // [m]
#define BEYOND     0.01  // [m]
#define ROD_HALF   2.0   // [m]
#define ROD_HALF_W 0.01  // [m]

const char *const shot_wall_names[SHOT_WALLS] = { "boxes", "segments", "chain" };
const char *const shot_body_names[SHOT_BODIES] = { "circle", "box", "capsule", "rod", "compound" };

// The body's points in its own frame, and a radius around them: what the referee looks at.
struct outline {
    double x[MOST_POINTS], y[MOST_POINTS];
    double radius;
    int count;
};

static double log_uniform(unsigned *seed, double low, double high)
{
    return low * pow(high / low, sim_uniform(seed, 0, 1));
}

struct shot shot_random(unsigned *seed, enum shot_wall wall, double thickness, enum shot_body body,
                        double fastest)
{
    struct shot s = { .wall = wall, .body = body, .dt = 1 / 60.0, .steps = 20 };
    s.thickness = wall == SHOT_BOXES ? thickness : 0;
    s.turned = sim_uniform(seed, -PI, PI);
    s.size = log_uniform(seed, 0.05, 0.5);
    s.angle = sim_uniform(seed, -PI, PI);
    s.clear = log_uniform(seed, 0.001, 10);
    s.speed = log_uniform(seed, 10, fastest);
    s.incidence = sim_uniform(seed, -89, 89) * PI / 180;
    s.spin = sim_uniform(seed, 0, 5) < 1 ? 0 : log_uniform(seed, 1, 1000);
    s.spin *= sim_uniform(seed, -1, 1) < 0 ? -1 : 1;
    return s;
}

static void need(int status, const char *what)
{
    if (status < 0) {
        fprintf(stderr, "shots: the engine has no %s\n", what);
        abort();
    }
}

// Pieces along x, turned; free space is on the side of +y.
static void add_wall(const struct engine *e, struct engine_world *w, const struct shot *s)
{
    double c = cos(s->turned), sine = sin(s->turned);
    double x[WALL_PIECES + 1], y[WALL_PIECES + 1];
    for (int i = 0; i <= WALL_PIECES; ++i) {
        double at = WALL_HALF - 2 * WALL_HALF * i / WALL_PIECES;
        x[i] = c * at, y[i] = sine * at;
    }
    struct engine_body_def def = { .type = ENGINE_STATIC };
    int body = e->add_body(w, &def);
    const struct engine_material *m = &engine_material_default;
    if (s->wall == SHOT_CHAIN) {
        need(e->add_chain(w, body, m, x, y, WALL_PIECES + 1, false), "chain");
        return;
    }
    double nx = -sine * s->thickness / 2, ny = c * s->thickness / 2;
    for (int i = 0; i < WALL_PIECES; ++i) {
        if (s->wall == SHOT_SEGMENTS) {
            need(e->add_segment(w, body, m, x[i], y[i], x[i + 1], y[i + 1]), "segment");
        } else {
            double bx[4] = { x[i] - nx, x[i] + nx, x[i + 1] + nx, x[i + 1] - nx };
            double by[4] = { y[i] - ny, y[i] + ny, y[i + 1] + ny, y[i + 1] - ny };
            need(e->add_polygon(w, body, m, bx, by, 4, 0), "polygon");
        }
    }
}

static void add_rectangle(const struct engine *e, struct engine_world *w, int body, double hx,
                          double hy)
{
    double x[4] = { -hx, hx, hx, -hx }, y[4] = { -hy, -hy, hy, hy };
    need(e->add_polygon(w, body, &engine_material_default, x, y, 4, 0), "polygon");
}

static struct outline rectangle_outline(double hx, double hy)
{
    return (struct outline){ { -hx, hx, hx, -hx }, { -hy, -hy, hy, hy }, 0, 4 };
}

// Ends and middle of a capsule; an engine without capsules gets the same outline in three parts.
static void add_capsule(const struct engine *e, struct engine_world *w, int body, double half,
                        double r)
{
    const struct engine_material *m = &engine_material_default;
    if (e->add_capsule(w, body, m, -half, 0, half, 0, r) == ENGINE_UNSUPPORTED) {
        add_rectangle(e, w, body, half, r);
        need(e->add_circle(w, body, m, -half, 0, r), "circle");
        need(e->add_circle(w, body, m, half, 0, r), "circle");
    }
}

static struct outline add_shapes(const struct engine *e, struct engine_world *w, int body,
                                 const struct shot *s)
{
    const struct engine_material *m = &engine_material_default;
    double r = s->size / 2;
    switch (s->body) {
    case SHOT_CIRCLE:
        need(e->add_circle(w, body, m, 0, 0, r), "circle");
        return (struct outline){ { 0 }, { 0 }, r, 1 };
    case SHOT_BOX:
        add_rectangle(e, w, body, r, 0.6 * r);
        return rectangle_outline(r, 0.6 * r);
    case SHOT_CAPSULE:
        add_capsule(e, w, body, r, 0.3 * r);
        return (struct outline){ { -r, r }, { 0, 0 }, 0.3 * r, 2 };
    case SHOT_ROD:
        add_rectangle(e, w, body, ROD_HALF, ROD_HALF_W);
        return rectangle_outline(ROD_HALF, ROD_HALF_W);
    default: // a cross
        add_rectangle(e, w, body, r, 0.2 * r);
        add_rectangle(e, w, body, 0.2 * r, r);
        return (struct outline){ { -r, r, r, -r, -0.2 * r, 0.2 * r, 0.2 * r, -0.2 * r },
                                 { -0.2 * r, -0.2 * r, 0.2 * r, 0.2 * r, -r, -r, r, r },
                                 0,
                                 8 };
    }
}

// Least height of the outline over the wall's middle line.
static double height_of(const struct outline *o, const struct shot *s, double x, double y,
                        double angle)
{
    double nx = -sin(s->turned), ny = cos(s->turned);
    double c = cos(angle), sine = sin(angle), least = INFINITY;
    for (int i = 0; i < o->count; ++i) {
        double px = x + c * o->x[i] - sine * o->y[i], py = y + sine * o->x[i] + c * o->y[i];
        least = fmin(least, nx * px + ny * py);
    }
    return least - o->radius;
}

struct shot_result shot_fire(const struct engine *engine, const struct engine_options *options,
                             const struct shot *s)
{
    struct engine_options o = *options;
    o.gravity_x = o.gravity_y = 0;
    struct engine_world *w = engine->create(&o);
    add_wall(engine, w, s);
    double nx = -sin(s->turned), ny = cos(s->turned);
    double way = s->turned - PI / 2 + s->incidence;
    struct engine_body_def def = { .type = ENGINE_DYNAMIC,
                                   .angle = s->angle,
                                   .vx = s->speed * cos(way),
                                   .vy = s->speed * sin(way),
                                   .w = s->spin };
    // Placed by trial at the middle of the wall, then lifted clear of it.
    struct engine_world *trial = engine->create(&o);
    struct outline outline = add_shapes(engine, trial, engine->add_body(trial, &def), s);
    engine->destroy(trial);
    double lift = s->clear + s->thickness / 2 - height_of(&outline, s, 0, 0, s->angle);
    def.x = nx * lift, def.y = ny * lift;
    int body = engine->add_body(w, &def);
    add_shapes(engine, w, body, s);

    struct shot_result r = { false, 0 };
    double height = 0;
    for (int i = 0; i < s->steps; ++i) {
        engine->step(w, s->dt);
        struct engine_pose at = engine->get_pose(w, body);
        if (fabs(ny * at.x - nx * at.y) > WALL_HALF - ROD_HALF) {
            break; // it has slid along to where the wall ends
        }
        height = height_of(&outline, s, at.x, at.y, at.angle);
        r.deepest = fmax(r.deepest, s->thickness / 2 - height);
        r.missed |= !(nx * at.x + ny * at.y > 0);
    }
    r.missed |= !(height > -s->thickness / 2 - BEYOND);
    engine->destroy(w);
    return r;
}
