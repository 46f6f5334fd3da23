// impact_throw.c - see impact_throw.h.
#include "impact_throw.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "harness/sim.h"
#include "impact_gap.h"

#define MOST_SHAPES 3
#define SETTLE      12 // steps after the way to the target

typedef enum form {
    CIRCLE,
    CAPSULE,
    BOX,
    POLYGON,
    ROUNDED,
    OUTLINE,  // one shape of several pieces
    COMPOUND, // two shapes
    SOLIDS,   // as many may be thrown
    SEGMENT = SOLIDS,
    CHAIN,
    TILES, // three shapes, one ground
    FORMS
} form;

typedef enum role { STATIC, KINEMATIC, AWAKE, ASLEEP, ROLES } role;

typedef struct throw
{
    uint32_t seed, random;
    plumb_world *w;
    void (*told)(const char *line);
    impact_tally *tally;
    form thrown_form, target_form;
    role role;
    int solver, substeps;
    double dt, speed, size, target_size, hit_speed, restitution, gx, gy;
    bool rough, wrapped, quick_spin;
    plumb_material material;
    plumb_body thrown, target;
    plumb_shape shapes[MOST_SHAPES], others[MOST_SHAPES];
    int shape_count, other_count;
    struct {
        bool begun, fresh;  // touches; since this step
        int since;          // step in which it began
        int hits, hit_step; // since it began; the last
        double gap, before; // [m] after this step, and before it
        double approach;    // [m/s] when it began, as the observer sees it; < 0: unknown
        double told;        // [m/s]
    } pair[MOST_SHAPES][MOST_SHAPES];
}
throw;

static double uniform(throw *t, double low, double high)
{
    return sim_uniform(&t->random, low, high);
}

static int pick(throw *t, int count)
{
    return (int)uniform(t, 0, count);
}

static double log_uniform(throw *t, double low, double high)
{
    return low * pow(high / low, uniform(t, 0, 1));
}

static bool chance(throw *t, double p)
{
    return uniform(t, 0, 1) < p;
}

static void tell(throw *t, long *count, int step, const char *format, ...)
{
    static const char *const solvers[] = { "soft", "pgs", "exact" };
    char text[200], line[400];
    va_list arguments;
    ++*count;
    if (t->told == NULL) {
        return;
    }
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    snprintf(line, sizeof line,
             "seed %u step %d: %s (form %d at %d of role %d, %s %d substeps, dt 1/%.0f, %.3g m/s, "
             "e %.2g, hit %.2g%s%s)",
             t->seed, step, text, t->thrown_form, t->target_form, t->role, solvers[t->solver],
             t->substeps, 1 / t->dt, t->speed, t->restitution, t->hit_speed,
             t->rough ? ", rough" : "", t->wrapped ? ", wrapped" : "");
    t->told(line);
}

//---- what is thrown at what ----------------------------------------------------------------------

static plumb_shape add(throw *t, plumb_body body, plumb_shape_desc d)
{
    d.material = t->material;
    plumb_shape shape = plumb_shape_create(t->w, body, &d);
    if (plumb_is_null(shape)) {
        fprintf(stderr, "impact_throw: %s\n", plumb_world_error(t->w).message);
        abort();
    }
    return shape;
}

static plumb_shape add_hull(throw *t, plumb_body body, double size, double radius)
{
    plumb_vec2 points[8];
    const int count = 3 + pick(t, 6);
    for (int i = 0; i < count; ++i) {
        const double angle = (i + uniform(t, -0.3, 0.3)) * 2 * SIM_PI / count;
        points[i] = sim_vec(size * cos(angle), size * sin(angle));
    }
    return add(t, body,
               (plumb_shape_desc){ .kind = PLUMB_POLYGON,
                                   .points = points,
                                   .count = count,
                                   .radius = (plumb_real)radius });
}

// An arrow head: two pieces or more.
static plumb_shape add_outline(throw *t, plumb_body body, double size)
{
    const plumb_vec2 points[] = { sim_vec(-size, -size), sim_vec(0, -0.3 * size),
                                  sim_vec(size, -size), sim_vec(0, size) };
    return add(t, body, (plumb_shape_desc){ .kind = PLUMB_OUTLINE, .points = points, .count = 4 });
}

static int add_form(throw *t, plumb_body body, form f, double size, plumb_shape *shapes)
{
    const plumb_real r = (plumb_real)size;
    const plumb_vec2 ends[2] = { sim_vec(-size, 0), sim_vec(size, 0) };
    plumb_vec2 line[7];
    switch (f) {
    case CIRCLE:
        shapes[0] = add(t, body, (plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = r });
        return 1;
    case CAPSULE:
        shapes[0] = add(t, body,
                        (plumb_shape_desc){
                            .kind = PLUMB_CAPSULE, .points = ends, .count = 2, .radius = r / 3 });
        return 1;
    case BOX:
        shapes[0] = add(t, body,
                        (plumb_shape_desc){ .kind = PLUMB_BOX,
                                            .half = { r, r * (plumb_real)uniform(t, 0.2, 1) } });
        return 1;
    case POLYGON:
        shapes[0] = add_hull(t, body, size, 0);
        return 1;
    case ROUNDED:
        shapes[0] = add_hull(t, body, size, 0.2 * size);
        return 1;
    case OUTLINE:
        shapes[0] = add_outline(t, body, size);
        return 1;
    case COMPOUND:
        shapes[0] = add(t, body, (plumb_shape_desc){ .kind = PLUMB_BOX, .half = { r, r / 5 } });
        shapes[1] =
            add(t, body,
                (plumb_shape_desc){ .kind = PLUMB_CIRCLE, .center = { r, 0 }, .radius = r / 3 });
        return 2;
    case SEGMENT:
        shapes[0] =
            add(t, body, (plumb_shape_desc){ .kind = PLUMB_SEGMENT, .points = ends, .count = 2 });
        return 1;
    case CHAIN:
        for (int i = 0; i < 7; ++i) {
            line[i] =
                sim_vec(size * (i - 3) / 3, chance(t, 0.5) ? 0 : uniform(t, -0.1, 0.1) * size);
        }
        shapes[0] =
            add(t, body, (plumb_shape_desc){ .kind = PLUMB_CHAIN, .points = line, .count = 7 });
        return 1;
    default: // flush tiles
        for (int i = 0; i < 3; ++i) {
            shapes[i] = add(t, body,
                            (plumb_shape_desc){ .kind = PLUMB_BOX,
                                                .center = { r * (plumb_real)(i - 1), 0 },
                                                .half = { r / 2, r / 4 } });
        }
        return 3;
    }
}

static double gap_now(const throw *t)
{
    double least = INFINITY;
    for (int i = 0; i < t->shape_count; ++i) {
        for (int j = 0; j < t->other_count; ++j) {
            least = fmin(least, impact_gap(t->w, t->shapes[i], t->others[j]));
        }
    }
    return least;
}

static void make_world(throw *t)
{
    static const int rates[] = { 30, 60, 60, 60, 90, 120, 240 };
    const double u = uniform(t, 0, 1);
    t->solver = u < 0.5 ? PLUMB_SOLVER_SOFT : u < 0.7 ? PLUMB_SOLVER_EXACT : PLUMB_SOLVER_PGS;
    t->substeps = chance(t, 0.5) ? (t->solver == PLUMB_SOLVER_PGS ? 1 : 4) : 1 + pick(t, 8);
    t->dt = 1.0 / rates[pick(t, 7)];
    t->hit_speed = chance(t, 0.6) ? log_uniform(t, 0.5, 20) : 0;
    t->restitution = chance(t, 0.5) ? 0 : chance(t, 0.2) ? 1 : uniform(t, 0.01, 1);
    t->rough = chance(t, 0.5);
    t->wrapped = chance(t, 0.1);
    plumb_world_desc d = { .solver = (plumb_solver)t->solver,
                           .substeps = t->substeps,
                           .hit_speed = (plumb_real)t->hit_speed };
    if (chance(t, 0.5)) {
        const double turn = uniform(t, -SIM_PI, SIM_PI);
        t->gx = SIM_G * cos(turn), t->gy = SIM_G * sin(turn);
        d.gravity = sim_vec(t->gx, t->gy);
        t->gx = (double)d.gravity.x, t->gy = (double)d.gravity.y;
    } else {
        d.zero_gravity = true;
    }
    if (t->wrapped) {
        d.wrap_x = d.wrap_y = 100;
    }
    t->w = sim_world(&d);
    t->material = sim_material(t->w, t->rough ? 0.6 : 0, t->restitution);
}

static void make_target(throw *t, double x, double y)
{
    const plumb_real angle = (plumb_real)uniform(t, -SIM_PI, SIM_PI);
    t->target_form = (form)pick(t, FORMS);
    t->role = (role)pick(t, t->target_form >= SEGMENT ? KINEMATIC + 1 : ROLES);
    t->target_size = log_uniform(t, 0.2, 3);
    plumb_body_desc d = { .position = sim_vec(x, y), .angle = angle };
    d.type = t->role == STATIC      ? PLUMB_STATIC
             : t->role == KINEMATIC ? PLUMB_KINEMATIC
                                    : PLUMB_DYNAMIC;
    d.asleep = t->role == ASLEEP;
    d.no_gravity = t->role == ASLEEP;
    t->target = plumb_body_create(t->w, &d);
    t->other_count = add_form(t, t->target, t->target_form, t->target_size, t->others);
}

// Clear of the target, on its way to it; far enough for a few steps.
static int make_thrown(throw *t)
{
    const plumb_vec2 at = plumb_body_position(t->w, t->target);
    const double way = uniform(t, -SIM_PI, SIM_PI), dx = cos(way), dy = sin(way);
    t->thrown_form = (form)pick(t, SOLIDS);
    t->size = log_uniform(t, 0.05, 1);
    t->speed = log_uniform(t, 0.5, 300);
    t->quick_spin = chance(t, 0.3);
    const double aside = uniform(t, -1, 1) * t->target_size * 0.8,
                 far = 2 * (t->size + t->target_size);
    plumb_body_desc d = { .position = sim_vec((double)at.x - far * dx - aside * dy,
                                              (double)at.y - far * dy + aside * dx),
                          .angle = (plumb_real)uniform(t, -SIM_PI, SIM_PI),
                          .velocity = sim_vec(t->speed * dx, t->speed * dy),
                          .continuous = chance(t, 0.5) };
    d.angular_velocity = (plumb_real)(chance(t, 0.3)  ? 0
                                      : t->quick_spin ? uniform(t, -0.5, 0.5) / t->dt
                                                      : uniform(t, -0.02, 0.02) / t->dt);
    t->thrown = plumb_body_create(t->w, &d);
    t->shape_count = add_form(t, t->thrown, t->thrown_form, t->size, t->shapes);
    if (t->role == KINEMATIC) {
        const double toward = uniform(t, 0, 0.5) * t->speed;
        plumb_body_set_velocity(t->w, t->target, sim_vec(-toward * dx, -toward * dy));
        plumb_body_set_angular_velocity(t->w, t->target,
                                        (plumb_real)(uniform(t, -0.01, 0.01) / t->dt));
    }
    // Nearer, until so many steps are left.
    const double wanted = fmax(t->speed * t->dt * uniform(t, 0.02, 3.5), 2e-3);
    double gap = gap_now(t);
    for (int i = 0; i < 30 && fabs(gap - wanted) > 1e-3 * wanted; ++i) {
        const plumb_vec2 p = plumb_body_position(t->w, t->thrown);
        plumb_body_teleport(
            t->w, t->thrown,
            sim_vec((double)p.x + (gap - wanted) * dx, (double)p.y + (gap - wanted) * dy), d.angle);
        const double nearer = gap_now(t);
        if (nearer < 1e-6 || nearer >= gap) { // too near, or it flies past
            plumb_body_teleport(t->w, t->thrown, p, d.angle);
            break;
        }
        gap = nearer;
    }
    const double steps = ceil(gap / (t->speed * t->dt)) + SETTLE;
    return (int)fmin(steps, 60);
}

//---- the observer --------------------------------------------------------------------------------

typedef struct motion {
    plumb_vec2 v, c;
    double w;
} motion;

static motion motion_of(const throw *t, plumb_body body)
{
    return (motion){ plumb_body_velocity(t->w, body), plumb_body_center(t->w, body),
                     (double)plumb_body_angular_velocity(t->w, body) };
}

static void measure_gaps(throw *t)
{
    for (int i = 0; i < t->shape_count; ++i) {
        for (int j = 0; j < t->other_count; ++j) {
            t->pair[i][j].before = t->pair[i][j].gap;
            t->pair[i][j].gap = impact_gap(t->w, t->shapes[i], t->others[j]);
            t->pair[i][j].fresh = false;
        }
    }
}

// [m] between a shape and the target's, before this step or after it; of flush tiles, which are one ground, the
// nearest.
static double clearance(const throw *t, int i, int j, bool after)
{
    double least = after ? t->pair[i][j].gap : t->pair[i][j].before;
    for (int k = 0; t->target_form == TILES && k < t->other_count; ++k) {
        least = fmin(least, after ? t->pair[i][k].gap : t->pair[i][k].before);
    }
    return least;
}

// Indices of the pair of an event; `flipped` when the thrown one is B. False: of neither.
static bool find(const throw *t, plumb_shape a, plumb_shape b, int *i, int *j, bool *flipped)
{
    for (*i = 0; *i < t->shape_count; ++*i) {
        for (*j = 0; *j < t->other_count; ++*j) {
            *flipped = plumb_same(b, t->shapes[*i]);
            if ((*flipped && plumb_same(a, t->others[*j])) ||
                (plumb_same(a, t->shapes[*i]) && plumb_same(b, t->others[*j]))) {
                return true;
            }
        }
    }
    return false;
}

// [m/s] at which the bodies approached along the normal (from A to B) at the point, by the velocities before the
// step; < 0: they did not, or turn too much in a step for that to mean anything.
static double approach(const throw *t, const motion *a, const motion *b, plumb_vec2 point,
                       plumb_vec2 normal, bool flipped, double gap)
{
    const double s = flipped ? 1 : -1, nx = (double)normal.x, ny = (double)normal.y;
    // Arms are those of the moment at which they meet; the surface of a circle turns along itself.
    const double straight = -s * (nx * (double)(a->v.x - b->v.x) + ny * (double)(a->v.y - b->v.y));
    const double time = straight > 0 ? fmin(gap / straight, t->dt) : 0;
    const double spin = t->thrown_form == CIRCLE ? 0 : a->w;
    const plumb_vec2 at =
        sim_vec((double)a->c.x + time * (double)a->v.x, (double)a->c.y + time * (double)a->v.y);
    const plumb_vec2 bt =
        sim_vec((double)b->c.x + time * (double)b->v.x, (double)b->c.y + time * (double)b->v.y);
    const plumb_vec2 ra = plumb_world_way(t->w, at, point), rb = plumb_world_way(t->w, bt, point);
    const double vx = (double)a->v.x - spin * (double)ra.y - (double)b->v.x + b->w * (double)rb.y;
    const double vy = (double)a->v.y + spin * (double)ra.x - (double)b->v.y - b->w * (double)rb.x;
    if ((fabs(a->w) * t->dt > 0.03 && t->thrown_form != CIRCLE) || fabs(b->w) * t->dt > 0.03) {
        return -1;
    }
    return -s * (nx * vx + ny * vy);
}

// Of one convex piece each: what happens to them is the one thing that a step tells.
static bool is_plain(const throw *t)
{
    return t->thrown_form < OUTLINE && (t->target_form < OUTLINE || t->target_form == SEGMENT);
}

static double slack(const throw *t, double speed)
{
    return 0.12 * speed + 0.02 * t->speed + 1.1 * SIM_G * t->dt + 0.02;
}

static void read_begins(throw *t, int step, const motion *a, const motion *b, bool struck)
{
    int count;
    const plumb_contact_begin *e = plumb_world_begin_events(t->w, &count);
    for (int k = 0; k < count; ++k) {
        int i, j;
        bool flipped;
        if (!find(t, e[k].shape_a, e[k].shape_b, &i, &j, &flipped)) {
            tell(t, &t->tally->phantom, step, "begin of strangers");
            continue;
        }
        if (t->pair[i][j].begun) {
            tell(t, &t->tally->doubled, step, "begun twice");
        }
        const double before = clearance(t, i, j, false), after = clearance(t, i, j, true);
        if (!struck && before > 1e-3 && after > 1e-3) {
            tell(t, &t->tally->phantom, step, "begun %.3g and %.3g m apart", before, after);
        }
        ++t->tally->touches;
        t->pair[i][j].begun = t->pair[i][j].fresh = true;
        t->pair[i][j].since = step;
        t->pair[i][j].hits = 0;
        t->pair[i][j].told = (double)e[k].approach_speed;
        const double speed =
            approach(t, a, b, e[k].point, e[k].normal, flipped, t->pair[i][j].before);
        t->pair[i][j].approach = speed;
        // What turns may be struck again within the step, by a faster corner.
        const double more = t->thrown_form == CIRCLE && t->role <= KINEMATIC ? 0 : 3 * t->speed;
        const double excess = t->pair[i][j].told - speed;
        if (is_plain(t) && struck && speed > 0 &&
            (excess < -slack(t, speed) || excess > slack(t, speed) + more)) {
            tell(t, &t->tally->askew, step, "begun at %.4g m/s instead of %.4g", t->pair[i][j].told,
                 speed);
        }
    }
}

static void read_ends(throw *t, int step, bool struck)
{
    int count;
    const plumb_contact_end *e = plumb_world_end_events(t->w, &count);
    for (int k = 0; k < count; ++k) {
        int i, j;
        bool flipped;
        if (!find(t, e[k].shape_a, e[k].shape_b, &i, &j, &flipped) || !t->pair[i][j].begun) {
            tell(t, &t->tally->doubled, step, "ended without having begun");
            continue;
        }
        const bool lone = t->shape_count == 1 && t->other_count == 1;
        // At the joint of flush tiles it follows from the ground as a whole which of them a body touches.
        if ((struck && lone) || (t->target_form != TILES && t->pair[i][j].before < 4e-4)) {
            tell(t, &t->tally->doubled, step, "ended while they met, %.3g m apart%s",
                 t->pair[i][j].before, struck ? ", struck" : "");
        }
        t->pair[i][j].begun = false;
    }
}

static void read_hits(throw *t, int step)
{
    int count;
    const plumb_contact_hit *e = plumb_world_hit_events(t->w, &count);
    t->tally->hits += count;
    for (int k = 0; k < count; ++k) {
        int i, j;
        bool flipped;
        if (!find(t, e[k].shape_a, e[k].shape_b, &i, &j, &flipped)) {
            tell(t, &t->tally->false_hits, step, "hit of strangers");
            continue;
        }
        if ((double)e[k].approach_speed <= t->hit_speed || !(e[k].impulse > 0)) {
            tell(t, &t->tally->false_hits, step, "hit at %.3g m/s, %.3g N s",
                 (double)e[k].approach_speed, (double)e[k].impulse);
        }
        if (t->pair[i][j].hits > 0 && t->pair[i][j].hit_step == step - 1 &&
            t->thrown_form == CIRCLE && is_plain(t) && t->role <= KINEMATIC &&
            t->pair[i][j].before < 4e-4) {
            tell(t, &t->tally->false_hits, step, "hit told twice");
        }
        ++t->pair[i][j].hits;
        t->pair[i][j].hit_step = step;
    }
}

// What is known two steps after a touch began, the second for blows that take that long.
static void judge_hits(throw *t, int step)
{
    for (int i = 0; i < t->shape_count && t->hit_speed > 0; ++i) {
        for (int j = 0; j < t->other_count; ++j) {
            const double speed = t->pair[i][j].approach;
            if (t->pair[i][j].since != step - 1 || !is_plain(t) || speed <= 0) {
                continue;
            }
            if (speed - slack(t, speed) > t->hit_speed && t->pair[i][j].hits == 0) {
                tell(t, &t->tally->mute, step, "no hit at %.3g m/s", speed);
            }
            if (speed + slack(t, speed) < t->hit_speed && t->pair[i][j].hits > 0 &&
                t->thrown_form == CIRCLE && t->role <= KINEMATIC) {
                tell(t, &t->tally->false_hits, step, "hit at %.3g m/s", speed);
            }
        }
    }
}

static void judge_touches(throw *t, int step, bool struck)
{
    bool any = false;
    for (int i = 0; i < t->shape_count; ++i) {
        for (int j = 0; j < t->other_count; ++j) {
            any |= t->pair[i][j].begun;
            const double before = clearance(t, i, j, false);
            if (t->pair[i][j].begun && !t->pair[i][j].fresh && !struck && before > 2e-3) {
                tell(t, &t->tally->lingering, step, "touching %.3g m apart", before);
            }
        }
    }
    if (struck && !any) {
        tell(t, &t->tally->missed, step, "struck without an event, %.3g m apart",
             t->pair[0][0].gap);
    }
}

void impact_throw(uint32_t seed, impact_tally *tally, void (*told)(const char *line))
{
    throw t = { .seed = seed, .random = seed * 2654435761u | 1, .tally = tally, .told = told };
    for (int i = 0; i < 8; ++i) {
        sim_random(&t.random);
    }
    make_world(&t);
    make_target(&t, t.wrapped ? 49.9 : uniform(&t, -20, 20), uniform(&t, -20, 20));
    const int steps = make_thrown(&t);
    ++tally->thrown;
    measure_gaps(&t);
    double fastest = 0; // [m/s]
    for (int step = 0; step < steps; ++step) {
        const motion a = motion_of(&t, t.thrown), b = motion_of(&t, t.target);
        sim_step(t.w, t.dt);
        measure_gaps(&t);
        const motion now = motion_of(&t, t.thrown);
        const double dx = (double)now.v.x - (double)a.v.x - t.gx * t.dt,
                     dy = (double)now.v.y - (double)a.v.y - t.gy * t.dt;
        // What rounding takes from the speed of one step may come with the next.
        fastest = fmax(fastest, hypot((double)a.v.x, (double)a.v.y) + fabs(a.w) * t.size);
        const double noise = SIM_EPSILON * (fastest + 1);
        const double change = fmax(hypot(dx, dy), fabs(now.w - a.w) * t.size);
        const bool struck = change > 16 * noise; // beyond doubt
        read_ends(&t, step, struck);
        read_begins(&t, step, &a, &b, change > noise);
        read_hits(&t, step);
        judge_touches(&t, step, struck);
        judge_hits(&t, step);
    }
    plumb_world_destroy(t.w);
}

long impact_wrong(const impact_tally *t)
{
    return t->missed + t->phantom + t->doubled + t->lingering + t->mute + t->false_hits + t->askew;
}
