// impact.c - restitution by events: an impact is put at its moment inside the substep.
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
// what gravity makes of the substep. Impacts are resolved one after the other until none is left,
// so that a row of touching balls passes momentum on (Newton's cradle); the two points of one
// manifold are resolved together, so that a flat landing does not turn.
//
// Reads, writes: solver bodies. Order: after velocities are integrated, before contacts are solved.
// Cost: O(elastic contacts) a substep, and O(log) for each impact and each contact of the bodies struck.
#include "solver/impact_queue.h"
#include "world/state.h"

#include <math.h>
#include <string.h>

// Impacts of one substep that are followed, of each elastic contact; what is left then is solved
// without bounce. A light ball between two heavy ones strikes many times within a substep; but little of
// the energy is left then (PL_IMPACT_KEPT): a stirred heap of e = 0.1 strikes ten times a contact.
#define CHAIN 64

// So many bundles are worth a thread.
#define LEAST 12

typedef struct approach {
    bool due;     // an impact falls into this substep and bounces
    bool clear;   // the point stays apart in this substep
    double speed; // [m/s] at which the surfaces meet, > 0
    double time;  // [s] since the start of the substep
} approach;

static near_real *lane_value(pl_solver *s, const pl_contact_kernels *kernels, size_t lane,
                             size_t offset)
{
    size_t width = (size_t)kernels->width;
    char *bundle = (char *)s->bundles.data + lane / width * kernels->bundle_size;
    return (near_real *)(void *)(bundle + offset) + lane % width;
}

// Apart, for few worlds have a locked body and impact_of is worth inlining.
static __attribute__((noinline)) void note_locks(const plumb_world *world, const pl_manifold *m,
                                                 pl_impact *impact)
{
    const uint16_t *flags = world->bodies.flags;
    near_real ima = pl_solver_bodies(&world->solver)[impact->a].inv_mass;
    near_real imb = pl_solver_bodies(&world->solver)[impact->b].inv_mass;
    impact->locked = true;
    impact->aix = (near_real)pl_unlocked(flags[m->body_a], PL_BODY_LOCK_X, ima);
    impact->aiy = (near_real)pl_unlocked(flags[m->body_a], PL_BODY_LOCK_Y, ima);
    impact->bix = (near_real)pl_unlocked(flags[m->body_b], PL_BODY_LOCK_X, imb);
    impact->biy = (near_real)pl_unlocked(flags[m->body_b], PL_BODY_LOCK_Y, imb);
}

static uint32_t chain_of(near_real restitution)
{
    double square = (double)restitution * (double)restitution, left = square;
    uint32_t count = 1;
    for (; count < CHAIN && left > PL_IMPACT_KEPT; ++count) {
        left *= square;
    }
    return count;
}

// What a manifold's impact needs; where its contact reads separations and keeps impulses is the caller's.
static pl_impact impact_of(const plumb_world *world, const pl_manifold *m)
{
    const pl_solver *s = &world->solver;
    uint32_t movable = world->dynamic_count + world->kinematic_count;
    pl_impact impact = { .a = pl_solver_slot(s, m->body_a, movable),
                         .b = pl_solver_slot(s, m->body_b, movable),
                         .pair = m->pair,
                         .count = m->count,
                         .nx = m->nx,
                         .ny = m->ny,
                         .friction = m->friction,
                         .restitution = m->restitution,
                         .chain = chain_of(m->restitution),
                         .surface_speed = m->surface_speed };
    if (world->locked_bodies > 0) {
        note_locks(world, m, &impact);
    }
    for (uint32_t j = 0; j < m->count; ++j) {
        const pl_manifold_point *p = &m->point[j];
        impact.point[j] = (pl_impact_point){ .ran = p->ax * m->ny - p->ay * m->nx,
                                             .rbn = p->bx * m->ny - p->by * m->nx,
                                             .rat = p->ax * m->nx + p->ay * m->ny,
                                             .rbt = p->bx * m->nx + p->by * m->ny,
                                             .separation = p->separation };
    }
    return impact;
}

static pl_dull_call dull_call(const plumb_world *world, near_real h)
{
    const pl_solver *s = &world->solver;
    return (pl_dull_call){ .bodies = pl_solver_bodies(s),
                           .motions = pl_solver_motions(s),
                           .lows = s->lows.data,
                           .struck = s->struck.data,
                           .dynamic_slots = s->dynamic_slots,
                           .bundles = s->bundles.data,
                           .color_first = pl_clusters(s)->color_first,
                           .lanes = s->lanes.data,
                           .manifolds = pl_manifolds(&world->narrow),
                           .pairs = pl_pairs(&world->broad.pairs),
                           .fields = s->outlook_fields.data,
                           .marks = s->outlook_open.data,
                           .looks_up = world->narrow.any_surface || pl_solver_tallies(world),
                           .h = h,
                           .restitution_speed = (near_real)world->desc.restitution_speed };
}

typedef struct dull_job {
    const pl_contact_kernels *kernels;
    pl_dull_call call;
} dull_job;

static uint32_t prepare_dull(void *context, uint32_t first, uint32_t count)
{
    const dull_job *j = context;
    return j->kernels->dull_prepare(&j->call, first, count);
}

static void look_ahead(void *context, uint32_t first, uint32_t count)
{
    const dull_job *j = context;
    j->kernels->dull_look(&j->call, first, count);
}

static void strike_dull(void *context, uint32_t first, uint32_t count)
{
    const dull_job *j = context;
    j->kernels->dull_strike(&j->call, first, count);
}

// Records of all that bounce.
static void record_impacts(plumb_world *world)
{
    pl_solver *s = &world->solver;
    const pl_contact_kernels *kernels = pl_solver_kernels(world);
    const uint32_t *lanes = s->lanes.data;
    pl_outlook_ends *ends = s->outlook_ends.data;
    for (size_t lane = 0; lane < s->outlook_lanes; ++lane) {
        const pl_manifold *m =
            lanes[lane] != PL_NONE ? &pl_manifolds(&world->narrow)[lanes[lane]] : NULL;
        ends[lane].impact = PL_NONE;
        if (m == NULL || !pl_bounces(m)) {
            continue;
        }
        pl_impact *impact = (pl_impact *)s->impacts.data + s->impact_count;
        *impact = impact_of(world, m);
        for (uint32_t j = 0; j < m->count; ++j) {
            pl_impact_point *p = &impact->point[j];
            p->lane_separation = lane_value(s, kernels, lane, kernels->separation_offset[j]);
            p->lane_impulse = lane_value(s, kernels, lane, kernels->impulse_offset[j]);
        }
        if (pl_is_dull(m->restitution)) {
            ends[lane] = (pl_outlook_ends){ impact->a, impact->b, s->impact_count };
        }
        ++s->impact_count;
    }
    pl_impact_queue_link(s);
}

// Where all impacts are dull, and no axis is locked, the kernels need no record of them.
void pl_impacts_prepare(plumb_world *world)
{
    pl_solver *s = &world->solver;
    dull_job job = { pl_solver_kernels(world), dull_call(world, 0) };
    s->impact_count = s->bounce_count = s->lively_count = 0;
    s->outlook_lanes = s->bundle_count * (uint32_t)job.kernels->width;
    if (pl_tasks_count(world->tasks, s->bundle_count, LEAST, prepare_dull, &job) > 0 ||
        world->locked_bodies > 0) {
        record_impacts(world);
    }
}

void pl_impacts_prepare_classic(plumb_world *world)
{
    pl_solver *s = &world->solver;
    pl_impact *impacts = s->impacts.data;
    pl_classic_contact *contacts = s->classic.data;
    s->impact_count = s->bounce_count = s->outlook_lanes = 0;
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        const pl_manifold *m = &pl_manifolds(&world->narrow)[i];
        if (!pl_bounces(m)) {
            continue;
        }
        pl_impact *impact = &impacts[s->impact_count++];
        *impact = impact_of(world, m);
        for (uint32_t j = 0; j < m->count; ++j) {
            impact->point[j].lane_separation = &contacts[i].point[j].separation;
            impact->point[j].lane_impulse = &contacts[i].point[j].ln;
        }
    }
    pl_impact_queue_link(s);
}

static const near_real *low_of(const pl_solver *s, uint32_t slot)
{
    return (const near_real *)s->lows.data + (size_t)slot * 4;
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

// Of both bodies of a manifold: what is common to its points.
typedef struct relative {
    double along; // relative, along the normal
    double a, b;  // the angular ones
} relative;

typedef struct outlook {
    relative place, velocity; // [m], [m/s], [rad], [rad/s]
    relative force, push;     // [m/s^2] from forces; [m/s] by contacts in this substep so far
    double after;             // [s] when either body was struck last
} outlook;

static relative relative_of(const pl_impact *m, double ax, double ay, double aw, double bx,
                            double by, double bw)
{
    return (relative){ (double)m->nx * (bx - ax) + (double)m->ny * (by - ay), aw, bw };
}

static double at_point(const pl_impact_point *p, relative r)
{
    return r.along + (double)p->rbn * r.b - (double)p->ran * r.a;
}

static outlook look_out(const plumb_world *world, const pl_impact *m)
{
    const pl_solver *s = &world->solver;
    const pl_solver_body *a = &pl_solver_bodies(s)[m->a], *b = &pl_solver_bodies(s)[m->b];
    const pl_solver_motion *ma = &pl_solver_motions(s)[m->a], *mb = &pl_solver_motions(s)[m->b];
    const near_real *la = low_of(s, m->a), *lb = low_of(s, m->b);
    double after_a = struck_at(s, m->a), after_b = struck_at(s, m->b);
    return (outlook){ .place = relative_of(m, (double)a->dx, (double)a->dy, (double)a->da,
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
static approach foresee(const plumb_world *world, const pl_impact *m, const outlook *o, uint32_t j,
                        double h)
{
    const pl_impact_point *p = &m->point[j];
    double sep = (double)p->separation + at_point(p, o->place);
    double v = at_point(p, o->velocity);
    // What the substep's forces and resting contacts added: a, and (v - u) / h from the contacts.
    double acceleration = at_point(p, o->force) + at_point(p, o->push) / h;
    double u = v - h * acceleration;
    approach out = { 0 };
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
    // What forces alone make of a substep is not a blow to a contact that carries load.
    bool loaded = *p->lane_impulse > 0;
    if (out.speed <= (double)world->desc.restitution_speed ||
        (loaded && out.speed <= 4 * weight_on(world, m) * h)) {
        return out;
    }
    double rest = h - out.time;
    out.due = (double)m->restitution * out.speed + acceleration * rest / 2 > 0;
    return out;
}

// Changes a velocity that has not been pushed by a contact (u = v) or has, and keeps the rounding.
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
        near_real *low = (near_real *)s->lows.data + (size_t)slot * 4;
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

// Friction of an impact: what stops the slip, at most mu times the normal impulse.
static void strike_tangent(const plumb_world *world, const pl_impact *m, uint32_t j, double normal,
                           double time)
{
    const pl_solver_body *a = &pl_solver_bodies(&world->solver)[m->a];
    const pl_solver_body *b = &pl_solver_bodies(&world->solver)[m->b];
    const pl_impact_point *p = &m->point[j];
    double rat = (double)p->rat, rbt = (double)p->rbt;
    double slip = (double)m->nx * (double)(b->vy - a->vy) -
                  (double)m->ny * (double)(b->vx - a->vx) + rbt * (double)b->w -
                  rat * (double)a->w + (double)m->surface_speed;
    double mass = m->locked ? inverse_mass(world, m, (double)m->ny, (double)m->nx)
                            : (double)a->inv_mass + (double)b->inv_mass;
    double k = mass + (double)a->inv_inertia * rat * rat + (double)b->inv_inertia * rbt * rbt;
    double bound = (double)m->friction * normal;
    double impulse = k > 0 ? -slip / k : 0;
    impulse = impulse > bound ? bound : impulse < -bound ? -bound : impulse;
    strike(world, m, j, 0, impulse, time);
}

// Resolves a manifold's impacts; true when there was one.
static bool resolve(plumb_world *world, const pl_impact *m, const approach at[2])
{
    const double gain = 1 + (double)m->restitution;
    double impulse[2] = { 0, 0 };
    pl_manifold *manifold =
        &pl_manifolds(&world->narrow)[pl_pairs(&world->broad.pairs)[m->pair].manifold];
    if (at[0].due && at[1].due) {
        double k00 = coupling(world, m, 0, 0), k11 = coupling(world, m, 1, 1),
               k01 = coupling(world, m, 0, 1);
        double det = k00 * k11 - k01 * k01;
        double r0 = gain * at[0].speed, r1 = gain * at[1].speed;
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
        impulse[j] = k > 0 ? gain * at[j].speed / k : 0;
    }
    bool struck = false;
    for (uint32_t j = 0; j < m->count; ++j) {
        if (impulse[j] > 0) {
            strike(world, m, j, impulse[j], 0, at[j].time);
            manifold->point[j].total += (near_real)impulse[j];
            struck = true;
        }
    }
    for (uint32_t j = 0; j < m->count && m->friction > 0; ++j) {
        if (impulse[j] > 0) {
            strike_tangent(world, m, j, impulse[j], at[j].time);
        }
    }
    return struck;
}

// Foresees all points of a manifold; where in the queue it stands is the time of its first impact.
static void foresee_all(const plumb_world *world, pl_impact *m, double h, approach at[2])
{
    outlook o = look_out(world, m);
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

// Foresees anew what a struck body meets.
static void queue_neighbours(plumb_world *world, uint32_t slot, double h)
{
    pl_solver *s = &world->solver;
    approach unused[2];
    if (slot >= s->dynamic_slots) {
        return;
    }
    uint32_t i = pl_impact_of_slot(s, slot);
    for (; i != PL_NONE; i = pl_impact_after(s, slot, i)) {
        foresee_all(world, (pl_impact *)s->impacts.data + i, h, unused);
        pl_impact_queue_put(s, i);
    }
}

// Resolves an impact that is due, and foresees anew what its bodies meet.
static void happen(plumb_world *world, pl_impact *m, const approach at[2], double h)
{
    --m->left;
    if (resolve(world, m, at)) {
        pl_pairs(&world->broad.pairs)[m->pair].flags |= PL_PAIR_HIT;
        ++world->solver.bounce_count;
        queue_neighbours(world, m->a, h);
        queue_neighbours(world, m->b, h);
    }
}

static void empty_queue(plumb_world *world, double h)
{
    pl_solver *s = &world->solver;
    for (pl_impact *m; (m = pl_impact_queue_first(s)) != NULL;) {
        approach at[2] = { { 0 }, { 0 } };
        foresee_all(world, m, h, at);
        m->due = false;
        pl_impact_queue_put(s, (uint32_t)(m - (pl_impact *)s->impacts.data));
        happen(world, m, at, h);
    }
}

// A body of it has been struck in this substep.
static bool is_upset(const pl_solver *s, const pl_impact *m, near_real h)
{
    const near_real *struck = s->struck.data;
    return struck[m->a] > -h || struck[m->b] > -h;
}

// Points that stay clear of their own accord are none of the contact kernel's business.
static void tell_kernel(const pl_impact *m)
{
    for (uint32_t j = 0; j < m->count; ++j) {
        const pl_impact_point *p = &m->point[j];
        bool off = *p->lane_impulse <= 0 && m->clear[j];
        *p->lane_separation = p->separation + (off ? PL_APART : 0);
    }
}

static void run_lively(plumb_world *world, near_real h)
{
    pl_solver *s = &world->solver;
    pl_impact *impacts = s->impacts.data;
    approach at[2];
    for (uint32_t i = 0; i < s->impact_count; ++i) {
        if (impacts[i].chain > 1) {
            impacts[i].left = impacts[i].chain;
            foresee_all(world, &impacts[i], (double)h, at);
            pl_impact_queue_put(s, i);
        }
    }
    empty_queue(world, (double)h);
}

// Dull ones strike once, one after the other as they stand.
static void take_turn(plumb_world *world, pl_impact *m, near_real h)
{
    approach at[2] = { { 0 }, { 0 } };
    m->left = 1;
    foresee_all(world, m, (double)h, at);
    tell_kernel(m);
    if (m->due) {
        happen(world, m, at, (double)h);
        empty_queue(world, (double)h);
        foresee_all(world, m, (double)h, at);
        tell_kernel(m);
    }
}

static void run_all_dull(plumb_world *world, near_real h)
{
    pl_impact *impacts = world->solver.impacts.data;
    for (uint32_t i = 0; i < world->solver.impact_count; ++i) {
        if (impacts[i].chain == 1) {
            take_turn(world, &impacts[i], h);
        }
    }
}

// Those that the outlook leaves open, and those of which a body has been struck since.
static void run_open(plumb_world *world, near_real h)
{
    pl_solver *s = &world->solver;
    pl_impact *impacts = s->impacts.data;
    const pl_outlook_ends *ends = s->outlook_ends.data;
    const uint8_t *open = s->outlook_open.data;
    const near_real *struck = s->struck.data;
    dull_job job = { pl_solver_kernels(world), dull_call(world, h) };
    pl_tasks_ranges(world->tasks, s->bundle_count, LEAST, look_ahead, &job);
    for (uint32_t lane = 0; lane < s->outlook_lanes; ++lane) {
        if (ends[lane].impact != PL_NONE &&
            (open[lane] != 0 || struck[ends[lane].a] > -h || struck[ends[lane].b] > -h)) {
            take_turn(world, &impacts[ends[lane].impact], h);
        }
    }
}

// Where nothing else bounces: colour by colour, as contacts are solved.
static void run_in_lanes(plumb_world *world, near_real h)
{
    pl_solver *s = &world->solver;
    const uint8_t *marks = s->outlook_open.data;
    dull_job job = { pl_solver_kernels(world), dull_call(world, h) };
    const uint32_t shared = job.call.color_first[PL_OVERFLOW_COLOR];
    pl_tasks_phases(world->tasks, job.call.color_first, PL_COLORS, LEAST, strike_dull, &job);
    strike_dull(&job, shared, s->bundle_count - shared);
    for (uint32_t lane = 0; lane < s->outlook_lanes; ++lane) {
        s->bounce_count += marks[lane] & PL_DULL_STRUCK;
    }
}

static void run_recorded(plumb_world *world, near_real h)
{
    pl_solver *s = &world->solver;
    pl_impact *impacts = s->impacts.data;
    if (s->lively_count > 0) {
        run_lively(world, h);
    }
    if (s->lively_count < s->impact_count) {
        (s->outlook_lanes > 0 ? run_open : run_all_dull)(world, h);
    }
    for (uint32_t i = 0; i < s->impact_count && s->lively_count > 0; ++i) {
        approach at[2];
        if (impacts[i].chain > 1) {
            if (is_upset(s, &impacts[i], h)) {
                foresee_all(world, &impacts[i], (double)h, at);
            }
            tell_kernel(&impacts[i]);
        }
    }
}

void pl_impacts_run(plumb_world *world, near_real h)
{
    pl_solver *s = &world->solver;
    near_real *struck = s->struck.data;
    for (uint32_t slot = 0; slot < s->slot_count; ++slot) {
        struck[slot] = -h; // none yet; an impact may lie one substep in the past
    }
    (s->impact_count == 0 && s->outlook_lanes > 0 ? run_in_lanes : run_recorded)(world, h);
}
