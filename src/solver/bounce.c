// bounce.c - restitution of one contact: an impact is put at its moment inside the substep.
//
// Seen along the normal of a contact point, a substep begins at separation s with speed u
// (negative: approaching) under constant acceleration a. The surfaces meet at speed
//     c = sqrt(u^2 - 2 a s)            after the time          t = 2 s / (c - u),
// and part at e c. The impulse m (1 + e) c that does this acts from t to the end of the substep, so
// it moves the bodies by (h - t) times the change of velocity; the sweep that integrates positions
// will count h times, hence t times is taken off here. Speed, height and time of the bounce are
// those of the parabola: no threshold, and no energy lost or won. An overlap at the start of the
// substep (s < 0) is an impact that lies in the past (t < 0): the same formulas set it right.
//
// A bounce whose own parabola would end within the substep is not resolved: such a contact rests,
// and the soft constraint holds it. Contacts that carry load rest too, unless struck at more than
// what gravity makes of the substep. The two points of one manifold are resolved together, so that a
// flat landing does not turn.
//
// Restitution above 1 gives energy, as bumpers do: what would leave faster than restitution_cap leaves at that speed, or
// at the one that it came with.
//
// Which contacts, and in what order: impact.c. The same in lanes, for those of low restitution: restitution.simd.c.
// Reads, writes: the two solver bodies, the manifold's totals of impulses. Cost: O(1) a contact.
#include "solver/bounce.h"

#include "world/state.h"

#include <math.h>

static const near_real *low_of(const pl_solver *s, uint32_t slot)
{
    return (const near_real *)s->residuals.data + (size_t)slot * 4;
}

static double length(double x, double y)
{
    return sqrt(x * x + y * y);
}

// When in this substep a body was struck last. [s]
static double struck_at(const pl_solver *s, uint32_t slot)
{
    return (double)((const near_real *)s->struck.data)[slot];
}

// [m/s] at which parts what met at a speed.
static double returned(const plumb_world *world, const pl_impact *m, double speed)
{
    const double back = (double)m->restitution * speed, cap = (double)world->desc.restitution_cap;
    return m->restitution > 1 && back > cap ? (speed > cap ? speed : cap) : back;
}

// Of both bodies of a manifold: what is common to its points.
typedef struct relative {
    double along; // relative, along the normal
    double a, b;  // the angular ones
} relative;

typedef struct prediction {
    relative place, velocity; // [m], [m/s], [rad], [rad/s]
    relative force, push;     // [m/s^2] from forces; [m/s] by contacts in this substep so far
    double after;             // [s] when either body was struck last
} prediction;

static relative relative_of(const pl_impact *m, double ax, double ay, double aw, double bx,
                            double by, double bw)
{
    return (relative){ (double)m->nx * (bx - ax) + (double)m->ny * (by - ay), aw, bw };
}

static double at_point(const pl_impact_point *p, relative r)
{
    return r.along + (double)p->rbn * r.b - (double)p->ran * r.a;
}

static prediction look_out(const plumb_world *world, const pl_impact *m)
{
    const pl_solver *s = &world->solver;
    const pl_solver_body *a = &pl_solver_bodies(s)[m->a], *b = &pl_solver_bodies(s)[m->b];
    const pl_solver_motion *ma = &pl_solver_motions(s)[m->a], *mb = &pl_solver_motions(s)[m->b];
    const near_real *la = low_of(s, m->a), *lb = low_of(s, m->b);
    double after_a = struck_at(s, m->a), after_b = struck_at(s, m->b);
    return (prediction){ .place = relative_of(m, (double)a->dx, (double)a->dy, (double)a->da,
                                              (double)b->dx, (double)b->dy, (double)b->da),
                         .velocity = relative_of(
                             m, (double)a->vx + (double)la[0], (double)a->vy + (double)la[1],
                             (double)a->w + (double)la[2], (double)b->vx + (double)lb[0],
                             (double)b->vy + (double)lb[1], (double)b->w + (double)lb[2]),
                         .force = relative_of(m, (double)ma->ax, (double)ma->ay, (double)ma->aw,
                                              (double)mb->ax, (double)mb->ay, (double)mb->aw),
                         .push = relative_of(m, (double)(a->vx - ma->ux), (double)(a->vy - ma->uy),
                                             (double)(a->w - ma->uw), (double)(b->vx - mb->ux),
                                             (double)(b->vy - mb->uy), (double)(b->w - mb->uw)),
                         .after = after_a > after_b ? after_a : after_b };
}

// [m/s^2] of the forces on both bodies.
static double weight_on(const plumb_world *world, const pl_impact *m)
{
    const pl_solver_motion *ma = &pl_solver_motions(&world->solver)[m->a];
    const pl_solver_motion *mb = &pl_solver_motions(&world->solver)[m->b];
    return length((double)ma->ax, (double)ma->ay) + length((double)mb->ax, (double)mb->ay);
}

// What happens to point j in the substep if nothing else does.
static pl_approach foresee(const plumb_world *world, const pl_impact *m, const prediction *o,
                           uint32_t j, double h)
{
    const pl_impact_point *p = &m->point[j];
    double sep = (double)p->separation + at_point(p, o->place);
    double v = at_point(p, o->velocity);
    // What the substep's forces and resting contacts added: a, and (v - u) / h from the contacts.
    double acceleration = at_point(p, o->force) + at_point(p, o->push) / h;
    double u = v - h * acceleration;
    pl_approach out = { 0 };
    if (sep + h * (u + v) / 2 >= 0) {
        out.clear = true;
        return out;
    }
    if (!(u < 0)) {
        return out;
    }
    double square = u * u - 2 * acceleration * sep;
    out.speed = square > 0 ? sqrt(square) : 0;
    out.time = 2 * sep / (out.speed - u);
    // The parabola holds for this substep and the one before, in which an impact may have been
    // missed. An overlap that it cannot explain is an old one: struck now, at the speed of now.
    double fastest = v < u ? -v : -u;
    if (!(square > 0) || out.time < -h || out.speed > fastest) {
        out.speed = sep < 0 ? -u : fastest;
        out.time = sep < 0 ? 0 : sep / fastest;
    }
    // Neither body's present path reaches back before the impact that put it there.
    out.time = out.time < o->after ? o->after : out.time;
    // What forces alone make of a substep is not a hit to a contact that carries load.
    bool loaded = *p->lane_impulse > 0;
    if (out.speed <= (double)world->desc.restitution_speed ||
        (loaded && out.speed <= 4 * weight_on(world, m) * h)) {
        return out;
    }
    double rest = h - out.time;
    out.due = returned(world, m, out.speed) + acceleration * rest / 2 > 0;
    return out;
}

// How well the narrow phase knows when an impact comes, as a share of a substep.
#define KNOWN 0.05

// Keeps up whether the impacts have come that put the pieces before its plane, and that take them from there.
static void note_window(const plumb_world *world, pl_impact *m, double h)
{
    const double a = struck_at(&world->solver, m->a), b = struck_at(&world->solver, m->b);
    const double last = a > b ? a : b, now = (double)world->solver.since + last + KNOWN * h;
    if (last >= 0) {
        m->waits = m->waits && now < (double)m->after;
        m->over = m->over || (m->until > 0 && m->met && now >= (double)m->until);
    }
}

void pl_bounce_foresee(const plumb_world *world, pl_impact *m, double h, pl_approach at[2])
{
    if (m->waits || m->until > 0) {
        note_window(world, m, h);
        if (m->waits || m->over) {
            at[0] = at[1] = (pl_approach){ .clear = true };
            m->due = false;
            m->clear[0] = m->clear[1] = true;
            return;
        }
    }
    prediction o = look_out(world, m);
    m->due = false;
    for (uint32_t j = 0; j < m->count; ++j) {
        at[j] = foresee(world, m, &o, j, h);
        m->clear[j] = at[j].clear;
        if (at[j].due && m->left > 0 && (!m->due || at[j].time < m->time)) {
            m->due = true;
            m->time = at[j].time;
        }
    }
}

// Changes a velocity that has not been pushed by a contact (u = v) or has, and keeps the rounding; where v is
// double itself there is none to keep, and keeping that of the sum did not change the drift.
static void kick(near_real *v, near_real *u, near_real *low, double change)
{
    bool free = *u == *v;
    double sum = (double)*v + (double)*low + change;
    *v = (near_real)sum;
    *low = (near_real)(sum - (double)*v);
    *u = free ? *v : *u + (near_real)change;
}

// Applies impulse (along n, along t) at a point, as of `time` into the substep.
static void strike(const plumb_world *world, const pl_impact *m, uint32_t j, double along_n,
                   double along_t, double time)
{
    const pl_solver *s = &world->solver;
    const pl_impact_point *p = &m->point[j];
    double px = (double)m->nx * along_n - (double)m->ny * along_t;
    double py = (double)m->ny * along_n + (double)m->nx * along_t;
    for (int side = 0; side < 2; ++side) {
        uint32_t slot = side == 0 ? m->a : m->b;
        if (slot >= s->dynamic_slots) {
            continue;
        }
        pl_solver_body *body = &pl_solver_bodies(s)[slot];
        pl_solver_motion *motion = &pl_solver_motions(s)[slot];
        near_real *low = (near_real *)s->residuals.data + (size_t)slot * 4;
        double sign = side == 0 ? -1 : 1;
        double turn = side == 0 ? (double)p->ran * along_n + (double)p->rat * along_t
                                : (double)p->rbn * along_n + (double)p->rbt * along_t;
        near_real ix = side == 0 ? m->aix : m->bix, iy = side == 0 ? m->aiy : m->biy;
        double dvx = sign * (double)(m->locked ? ix : body->inv_mass) * px;
        double dvy = sign * (double)(m->locked ? iy : body->inv_mass) * py;
        double dw = sign * (double)body->inv_inertia * turn;
        kick(&body->vx, &motion->ux, &low[0], dvx);
        kick(&body->vy, &motion->uy, &low[1], dvy);
        kick(&body->w, &motion->uw, &low[2], dw);
        ((near_real *)s->struck.data)[slot] = (near_real)time;
        body->dx -= (near_real)(time * dvx);
        body->dy -= (near_real)(time * dvy);
        body->da -= (near_real)(time * dw);
    }
}

// What the two bodies have against a push along (x, y) of any length, turning aside. [1/kg]
static double inverse_mass(const plumb_world *world, const pl_impact *m, double x, double y)
{
    if (m->locked) {
        return ((double)m->aix + (double)m->bix) * x * x +
               ((double)m->aiy + (double)m->biy) * y * y;
    }
    const pl_solver_body *bodies = pl_solver_bodies(&world->solver);
    return ((double)bodies[m->a].inv_mass + (double)bodies[m->b].inv_mass) * (x * x + y * y);
}

// Entry (i, j) of the inverse effective mass of a manifold's normal rows. The normal is a unit
// vector but for rounding; its true length counts here, or every bounce would lose a rounding of
// energy.
static double coupling(const plumb_world *world, const pl_impact *m, uint32_t i, uint32_t j)
{
    const pl_solver_body *a = &pl_solver_bodies(&world->solver)[m->a];
    const pl_solver_body *b = &pl_solver_bodies(&world->solver)[m->b];
    return inverse_mass(world, m, (double)m->nx, (double)m->ny) +
           (double)a->inv_inertia * (double)m->point[i].ran * (double)m->point[j].ran +
           (double)b->inv_inertia * (double)m->point[i].rbn * (double)m->point[j].rbn;
}

// Friction of an impact: what stops the slip, at most mu times the normal impulses; one row for both points, as in the sweeps
// (friction_row in bundle.h).
static void strike_tangents(const plumb_world *world, const pl_impact *m, const double normal[2],
                            const pl_approach at[2])
{
    const double load = normal[0] + normal[1];
    if (!(load > 0 && m->friction > 0)) {
        return;
    }
    const pl_solver_body *a = &pl_solver_bodies(&world->solver)[m->a];
    const pl_solver_body *b = &pl_solver_bodies(&world->solver)[m->b];
    const pl_impact_point *p = m->point;
    const double share[2] = { normal[0] / load, normal[1] / load };
    const double rat = share[0] * (double)p[0].rat + share[1] * (double)p[1].rat;
    const double rbt = share[0] * (double)p[0].rbt + share[1] * (double)p[1].rbt;
    double slip = (double)m->nx * (double)(b->vy - a->vy) -
                  (double)m->ny * (double)(b->vx - a->vx) + rbt * (double)b->w -
                  rat * (double)a->w + (double)m->surface_speed;
    double mass = m->locked ? inverse_mass(world, m, (double)m->ny, (double)m->nx)
                            : (double)a->inv_mass + (double)b->inv_mass;
    double row_mass = 0; // between those of the points, as in the rows
    for (uint32_t j = 0; j < m->count; ++j) {
        const double at_a = (double)p[j].rat, at_b = (double)p[j].rbt;
        const double k =
            mass + (double)a->inv_inertia * at_a * at_a + (double)b->inv_inertia * at_b * at_b;
        row_mass += k > 0 ? share[j] / k : 0;
    }
    double bound = (double)m->friction * load;
    double total = -slip * row_mass;
    total = total > bound ? bound : total < -bound ? -bound : total;
    for (uint32_t j = 0; j < m->count; ++j) {
        if (normal[j] > 0) {
            strike(world, m, j, 0, share[j] * total, at[j].time);
            if (pl_solver_tallies(world)) {
                const pl_pair *pair = &pl_pairs(&world->broad.pairs)[m->pair];
                ((near_real *)world->solver.rubbed.data)[2 * (size_t)pair->manifold + j] +=
                    (near_real)(share[j] * total);
            }
        }
    }
}

static void note_strike(plumb_world *world, const pl_impact *m, uint32_t j, const pl_approach *at,
                        double impulse)
{
    pl_manifold *manifold =
        &pl_manifolds(&world->narrow)[pl_pairs(&world->broad.pairs)[m->pair].manifold];
    manifold->point[j].total += (near_real)impulse;
    pl_manifold_strike(manifold, (near_real)at->speed, world->solver.since + (near_real)at->time);
}

bool pl_bounce_resolve(plumb_world *world, const pl_impact *m, const pl_approach at[2])
{
    double impulse[2] = { 0, 0 };
    if (at[0].due && at[1].due) {
        double k00 = coupling(world, m, 0, 0), k11 = coupling(world, m, 1, 1),
               k01 = coupling(world, m, 0, 1);
        double det = k00 * k11 - k01 * k01;
        double r0 = at[0].speed + returned(world, m, at[0].speed);
        double r1 = at[1].speed + returned(world, m, at[1].speed);
        // Nearly dependent rows (points close together) are resolved one at a time.
        if (det > 1e-4 * k00 * k11) {
            impulse[0] = (k11 * r0 - k01 * r1) / det;
            impulse[1] = (k00 * r1 - k01 * r0) / det;
        }
        if (!(impulse[0] > 0 && impulse[1] > 0)) {
            int first = at[0].speed >= at[1].speed ? 0 : 1;
            double k = first == 0 ? k00 : k11;
            impulse[first] = k > 0 ? (first == 0 ? r0 : r1) / k : 0;
            impulse[1 - first] = 0;
        }
    } else if (at[0].due || at[1].due) {
        uint32_t j = at[0].due ? 0 : 1;
        double k = coupling(world, m, j, j);
        impulse[j] = k > 0 ? (at[j].speed + returned(world, m, at[j].speed)) / k : 0;
    }
    bool struck = false;
    for (uint32_t j = 0; j < m->count; ++j) {
        if (impulse[j] > 0) {
            strike(world, m, j, impulse[j], 0, at[j].time);
            note_strike(world, m, j, &at[j], impulse[j]);
            struck = true;
        }
    }
    strike_tangents(world, m, impulse, at);
    return struck;
}

// Sweeps over impacts of one moment, and what is left of the velocity then.
#define SWEEPS  64
#define SETTLED 1e-13

static double speed_at(const plumb_world *world, const pl_impact *m, uint32_t j)
{
    return at_point(&m->point[j], look_out(world, m).velocity);
}

// Solved as one system, by sweeps there and back: none comes first, so a symmetric arrangement stays one.
void pl_bounce_resolve_together(plumb_world *world, pl_bounce *all, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        for (uint32_t j = 0; j < all[i].impact->count; ++j) {
            const pl_approach *at = &all[i].at[j];
            all[i].wanted[j] = speed_at(world, all[i].impact, j) + at->speed +
                               returned(world, all[i].impact, at->speed);
            all[i].impulse[j] = 0;
        }
    }
    double left = 1;
    for (uint32_t sweep = 0; sweep < SWEEPS && left > SETTLED; ++sweep) {
        left = 0;
        for (uint32_t n = 0; n < count; ++n) {
            pl_bounce *b = &all[sweep % 2 == 0 ? n : count - 1 - n];
            for (uint32_t j = 0; j < b->impact->count; ++j) {
                const double k = coupling(world, b->impact, j, j);
                if (!b->at[j].due || !(k > 0)) {
                    continue;
                }
                const double lack = b->wanted[j] - speed_at(world, b->impact, j);
                double change = lack / k;
                change = change < -b->impulse[j] ? -b->impulse[j] : change;
                b->impulse[j] += change;
                strike(world, b->impact, j, change, 0, b->at[j].time);
                const double share = k * (change < 0 ? -change : change) / b->at[j].speed;
                left = share > left ? share : left;
            }
        }
    }
    for (uint32_t i = 0; i < count; ++i) {
        for (uint32_t j = 0; j < all[i].impact->count; ++j) {
            if (all[i].impulse[j] > 0) {
                note_strike(world, all[i].impact, j, &all[i].at[j], all[i].impulse[j]);
            }
        }
        strike_tangents(world, all[i].impact, all[i].impulse, all[i].at);
    }
}
