// pgs.c - the classic solver: projected Gauss-Seidel on velocities, then on positions.
//
// The control in every chart: sequential impulses with accumulated clamping and warm starting (Catto,
// Iterative Dynamics with Temporal Coherence, GDC 2005) and a non-linear position pass that leaves a slop;
// restitution by events (impact.c) and free flight (integrate.c) are those of the soft step. Scalar,
// contact by contact, in the order of manifolds. Sweeps needed for a digit grow with the square of a
// stack's height: 0.93 N^2 for N equal boxes.
//
// Reads, writes: solver bodies, impulses of pairs. Cost: (iterations + 5) sweeps a substep.
#include "effects/effects.h"
#include "joints/joint.h"
#include "narrow/surface.h"
#include "world/body_settings.h"
#include "solver/substep.h"
#include "world/state.h"

#define SLOP          ((near_real)0.005) // [m] overlap that is left, so that contacts persist
#define POSITION_RATE ((near_real)0.2)   // [-] share of the rest corrected a sweep
#define LARGEST_PUSH  ((near_real)0.2)   // [m] most corrected a sweep

typedef struct classic {
    const pl_solver *solver;
    pl_solver_body *bodies;
    pl_classic_contact *contacts;
    uint32_t count;
    near_real h;
    near_real since;      // [s] from the start of the step to that of the substep
    near_real unloaded;   // [N s] a point that bears no more and pushes has been struck
    near_real *residuals; // a quad a slot; NULL: nothing bounces
} classic;

static near_real normal_speed(const classic *c, const pl_classic_contact *m,
                              const pl_classic_point *p)
{
    const pl_solver_body *a = &c->bodies[m->a], *b = &c->bodies[m->b];
    return m->nx * (b->vx - a->vx) + m->ny * (b->vy - a->vy) + p->rbn * b->w - p->ran * a->w;
}

// Likewise of what the forces of the substep made of the velocities, before anything else pushed.
static near_real speed_before(const classic *c, const pl_classic_contact *m,
                              const pl_classic_point *p)
{
    const pl_solver_motion *a = &pl_solver_motions(c->solver)[m->a];
    const pl_solver_motion *b = &pl_solver_motions(c->solver)[m->b];
    return m->nx * (b->ux - a->ux) + m->ny * (b->uy - a->uy) + p->rbn * b->uw - p->ran * a->uw;
}

static near_real separation_now(const classic *c, const pl_classic_contact *m,
                                const pl_classic_point *p)
{
    const pl_solver_body *a = &c->bodies[m->a], *b = &c->bodies[m->b];
    return p->separation + m->nx * (b->dx - a->dx) + m->ny * (b->dy - a->dy) + p->rbn * b->da -
           p->ran * a->da;
}

// [N s] that a point at this separation may pull.
static near_real pull_of(const pl_classic_contact *m, near_real separation)
{
    return separation < m->reach ? m->pull : 0;
}

static void push(const classic *c, const pl_classic_contact *m, const pl_classic_point *p,
                 near_real along_n, near_real along_t)
{
    pl_solver_body *a = &c->bodies[m->a], *b = &c->bodies[m->b];
    near_real px = m->nx * along_n - m->ny * along_t;
    near_real py = m->ny * along_n + m->nx * along_t;
    a->vx -= m->aix * px;
    a->vy -= m->aiy * py;
    a->w -= a->inv_inertia * (p->ran * along_n + p->rat * along_t);
    b->vx += m->bix * px;
    b->vy += m->biy * py;
    b->w += b->inv_inertia * (p->rbn * along_n + p->rbt * along_t);
}

static near_real within(near_real value, near_real bound)
{
    return value > bound ? bound : value < -bound ? -bound : value;
}

// [N m s] most that rolling resistance can do.
static near_real rolling_bound(const classic *c, const pl_classic_contact *m)
{
    near_real load = 0;
    for (uint32_t j = 0; j < m->count; ++j) {
        load += m->point[j].ln + pull_of(m, separation_now(c, m, &m->point[j]));
    }
    return m->rolling * (load > 0 ? load : 0);
}

static void turn(const classic *c, const pl_classic_contact *m, near_real impulse)
{
    pl_solver_body *a = &c->bodies[m->a], *b = &c->bodies[m->b];
    a->w -= a->inv_inertia * impulse;
    b->w += b->inv_inertia * impulse;
}

static near_real inverse_or_zero(near_real k)
{
    return k > 0 ? 1 / k : 0;
}

// What two bodies have against a push along (x, y), turning aside. [1/kg]
static near_real inverse_mass(const plumb_world *world, const pl_classic_contact *m,
                              const pl_solver_body *a, const pl_solver_body *b, near_real x,
                              near_real y)
{
    return world->locked_bodies == 0 ? a->inv_mass + b->inv_mass
                                     : (m->aix + m->bix) * x * x + (m->aiy + m->biy) * y * y;
}

static void prepare(classic *c, const plumb_world *world)
{
    const pl_manifold *manifolds = pl_manifolds(&world->narrow);
    uint32_t movable = world->dynamic_count + world->kinematic_count;
    for (uint32_t i = 0; i < c->count; ++i) {
        const uint32_t at = pl_classic_manifold(c->solver, i);
        const pl_manifold *m = &manifolds[at];
        pl_classic_contact *out = &c->contacts[i];
        *out = (pl_classic_contact){ .a = pl_solver_slot(c->solver, m->body_a, movable),
                                     .b = pl_solver_slot(c->solver, m->body_b, movable),
                                     .pair = m->pair,
                                     .manifold = at,
                                     .count = m->count,
                                     .nx = m->nx,
                                     .ny = m->ny,
                                     .friction = m->friction,
                                     .bore = m->friction,
                                     .restitution = m->restitution,
                                     .surface_speed = m->surface_speed,
                                     .rolling = m->rolling };
        const pl_grip grip = pl_surface_grip(world, m);
        out->sticks = grip.sticks, out->slides = grip.slides;
        const pl_solver_body *a = &c->bodies[out->a], *b = &c->bodies[out->b];
        const uint16_t *flags = world->bodies.flags;
        out->aix = (near_real)pl_unlocked(flags[m->body_a], PL_BODY_LOCK_X, a->inv_mass);
        out->aiy = (near_real)pl_unlocked(flags[m->body_a], PL_BODY_LOCK_Y, a->inv_mass);
        out->bix = (near_real)pl_unlocked(flags[m->body_b], PL_BODY_LOCK_X, b->inv_mass);
        out->biy = (near_real)pl_unlocked(flags[m->body_b], PL_BODY_LOCK_Y, b->inv_mass);
        out->pull = m->adhesion * c->h / (near_real)m->count;
        out->reach = pl_adhesion_reach(pl_pair_of(world, m)->flags);
        near_real mass_n = inverse_mass(world, out, a, b, m->nx, m->ny);
        near_real mass_t = inverse_mass(world, out, a, b, m->ny, m->nx);
        for (uint32_t j = 0; j < m->count; ++j) {
            const pl_manifold_point *from = &m->point[j];
            pl_classic_point *p = &out->point[j];
            p->ran = from->ax * m->ny - from->ay * m->nx;
            p->rbn = from->bx * m->ny - from->by * m->nx;
            p->rat = from->ax * m->nx + from->ay * m->ny;
            p->rbt = from->bx * m->nx + from->by * m->ny;
            p->separation = from->separation + (m->waits > 0 ? PL_APART : 0); // until it is told
            p->mn = inverse_or_zero(mass_n + a->inv_inertia * p->ran * p->ran +
                                    b->inv_inertia * p->rbn * p->rbn);
            p->mt = inverse_or_zero(mass_t + a->inv_inertia * p->rat * p->rat +
                                    b->inv_inertia * p->rbt * p->rbt);
            p->ln = from->normal;
            p->lt = from->tangent;
        }
        near_real inertia = a->inv_inertia + b->inv_inertia;
        out->mr = inverse_or_zero(inertia);
        near_real carried = pl_pair_of(world, m)->rolling;
        out->lr = m->rolling > 0 ? within(carried, rolling_bound(c, out)) : 0;
    }
}

// v = u + h a; what rounding takes from elastic bodies is added in the next substep, as in soft.c.
static void add(near_real *v, near_real *u, near_real *low, near_real change)
{
    near_real wanted = change + (low != NULL ? *low : 0);
    *u = *v + wanted;
    if (low != NULL) {
        *low = wanted - (*u - *v);
    }
    *v = *u;
}

static void integrate_velocities(const classic *c, pl_slots slots)
{
    pl_solver_motion *motion = pl_solver_motions(c->solver);
    for (uint32_t i = slots.first; i < slots.first + slots.count; ++i) {
        pl_solver_body *body = &c->bodies[i];
        near_real *low = c->residuals != NULL && c->residuals[(size_t)i * 4 + 3] > 0
                             ? c->residuals + (size_t)i * 4
                             : NULL;
        add(&body->vx, &motion[i].ux, low, c->h * motion[i].ax);
        add(&body->vy, &motion[i].uy, low != NULL ? low + 1 : NULL, c->h * motion[i].ay);
        add(&body->w, &motion[i].uw, low != NULL ? low + 2 : NULL, c->h * motion[i].aw);
    }
}

static void warm_start(const classic *c)
{
    for (uint32_t i = 0; i < c->count; ++i) {
        for (uint32_t j = 0; j < c->contacts[i].count; ++j) {
            const pl_classic_point *p = &c->contacts[i].point[j];
            push(c, &c->contacts[i], p, p->ln, p->lt);
        }
        turn(c, &c->contacts[i], c->contacts[i].lr);
    }
}

static void solve_velocity(const classic *c, pl_classic_contact *m, pl_classic_point *p)
{
    const pl_solver_body *a = &c->bodies[m->a], *b = &c->bodies[m->b];
    near_real slip = m->nx * (b->vy - a->vy) - m->ny * (b->vx - a->vx) + p->rbt * b->w -
                     p->rat * a->w + m->surface_speed;
    near_real s = separation_now(c, m, p);
    near_real pull = pull_of(m, s), load = p->ln + pull;
    const near_real wish = p->lt - p->mt * slip;
    near_real total = within(wish, m->friction * (load > 0 ? load : 0));
    p->yields = total != wish;
    push(c, m, p, 0, total - p->lt);
    p->lt = total;

    near_real slack = s > 0 ? s / c->h : 0; // may still approach so fast
    near_real speed = normal_speed(c, m, p);
    total = p->ln - p->mn * (speed + slack);
    total = total > -pull ? total : -pull;
    if (total > p->ln && p->ln <= c->unloaded) {
        const near_real before = speed_before(c, m, p);
        pl_classic_strike(m, before < speed ? -before : -speed, s, c->since, c->h);
    }
    push(c, m, p, total - p->ln, 0);
    p->ln = total;
}

static void solve_position(const classic *c, const pl_classic_contact *m, const pl_classic_point *p)
{
    pl_solver_body *a = &c->bodies[m->a], *b = &c->bodies[m->b];
    near_real error = POSITION_RATE * (separation_now(c, m, p) + SLOP);
    error = error > 0 ? 0 : error < -LARGEST_PUSH ? -LARGEST_PUSH : error;
    near_real impulse = -p->mn * error;
    a->dx -= m->aix * m->nx * impulse;
    a->dy -= m->aiy * m->ny * impulse;
    a->da -= a->inv_inertia * p->ran * impulse;
    b->dx += m->bix * m->nx * impulse;
    b->dy += m->biy * m->ny * impulse;
    b->da += b->inv_inertia * p->rbn * impulse;
}

static void solve_rolling(const classic *c, pl_classic_contact *m)
{
    near_real total =
        within(m->lr - m->mr * (c->bodies[m->b].w - c->bodies[m->a].w), rolling_bound(c, m));
    turn(c, m, total - m->lr);
    m->lr = total;
}

static void sweep(const classic *c, bool positions)
{
    for (uint32_t i = 0; i < c->count; ++i) {
        pl_classic_contact *m = &c->contacts[i];
        if (!positions && m->rolling > 0) {
            solve_rolling(c, m);
        }
        for (uint32_t j = 0; j < m->count; ++j) {
            if (positions) {
                solve_position(c, m, &m->point[j]);
            } else {
                solve_velocity(c, m, &m->point[j]);
            }
        }
    }
}

// It slides where no loaded point holds; what bears nothing will stick if it is slow.
void pl_classic_grip(const plumb_world *world, pl_classic_contact *m)
{
    m->bore = m->friction;
    if (!(m->slides < m->sticks)) {
        return;
    }
    const pl_solver_body *a = &pl_solver_bodies(&world->solver)[m->a];
    const pl_solver_body *b = &pl_solver_bodies(&world->solver)[m->b];
    near_real load = 0, least = 0, most = 0;
    bool yields = true;
    for (uint32_t j = 0; j < m->count; ++j) {
        const pl_classic_point *p = &m->point[j];
        const near_real of = p->ln + m->pull;
        load += of > 0 ? of : 0;
        yields &= p->yields || !(of > 0);
        least = p->lt < least ? p->lt : least;
        most = p->lt > most ? p->lt : most;
    }
    const near_real slip = m->nx * (b->vy - a->vy) - m->ny * (b->vx - a->vx) +
                           m->point[0].rbt * b->w - m->point[0].rat * a->w + m->surface_speed;
    const bool fast = slip > PL_SLIDES_FROM || slip < -PL_SLIDES_FROM;
    const bool slides = load > 0 ? yields && !(least < 0 && most > 0) : fast;
    m->friction = slides ? m->slides : m->sticks;
}

// Adds the substep's impulses to what the step did.
static void tally(const classic *c, const plumb_world *world, pl_manifold *manifolds,
                  near_real *rubbed)
{
    for (uint32_t i = 0; i < c->count; ++i) {
        pl_classic_contact *m = &c->contacts[i];
        for (uint32_t j = 0; j < m->count; ++j) {
            manifolds[m->manifold].point[j].total += m->point[j].ln;
            if (rubbed != NULL) {
                rubbed[2 * (size_t)m->manifold + j] += m->point[j].lt;
            }
            m->pushed |= m->point[j].ln > 0;
        }
        pl_classic_grip(world, m);
    }
}

static void store(const classic *c, pl_manifold *manifolds, pl_pair *pairs)
{
    for (uint32_t i = 0; i < c->count; ++i) {
        pl_pair *pair = &pairs[c->contacts[i].pair];
        pl_manifold *m = &manifolds[c->contacts[i].manifold];
        m->met |= c->contacts[i].pushed ? PL_MET_ACTED : 0;
        if (c->contacts[i].struck > 0) {
            pl_manifold_strike(m, c->contacts[i].struck, c->contacts[i].struck_at);
        }
        pair->rolling = c->contacts[i].lr;
        const bool slides = c->contacts[i].friction < c->contacts[i].sticks &&
                            (c->contacts[i].point[0].ln != 0 || c->contacts[i].point[1].ln != 0);
        pair->flags = (pair->flags & ~PL_PAIR_SLIDES) | (slides ? PL_PAIR_SLIDES : 0);
        for (uint32_t j = 0; j < c->contacts[i].count; ++j) {
            pair->normal[j] = c->contacts[i].point[j].ln;
            pair->tangent[j] = c->contacts[i].point[j].lt;
        }
    }
}

//---- rows of the substep ----------------------------------------------------------------------------

static classic classic_of(const pl_substep *s)
{
    const plumb_world *world = s->world;
    const pl_solver *solver = &world->solver;
    return (classic){ .solver = solver,
                      .bodies = pl_solver_bodies(solver),
                      .contacts = solver->classic.data,
                      .count = pl_classic_count(solver, world->narrow.manifold_count),
                      .h = s->h,
                      .since = s->solving->call.since,
                      .residuals = s->solving->elastic ? solver->residuals.data : NULL };
}

void pl_classic_prepare(pl_substep *s)
{
    classic c = classic_of(s);
    prepare(&c, s->world);
}

void pl_classic_integrate(pl_substep *s)
{
    if (s->world->tracks.count > 0) {
        pl_tracks_begin(s);
    }
    const classic c = classic_of(s);
    integrate_velocities(&c, s->cluster->slots[0]);
}

void pl_classic_warm_start(pl_substep *s)
{
    const classic c = classic_of(s);
    warm_start(&c);
}

void pl_classic_impacts(pl_substep *s)
{
    if (s->solving->elastic) {
        s->world->solver.since = s->solving->call.since;
        pl_impacts_run(s->world, s->h);
        pl_impacts_tell(s->world, s->h);
    }
}

void pl_classic_contacts(pl_substep *s)
{
    classic c = classic_of(s);
    c.unloaded = s->first && s->first_sweep ? NEAR_MAX : 0;
    sweep(&c, false);
}

void pl_joints_row_correct(pl_substep *s)
{
    if (s->solving->any_joints) {
        pl_joints_move(s->solving->joints, POSITION_RATE);
    }
}

void pl_classic_correct(pl_substep *s)
{
    const classic c = classic_of(s);
    sweep(&c, true);
}

void pl_classic_sum(pl_substep *s)
{
    const classic c = classic_of(s);
    tally(&c, s->world, s->solving->call.manifolds, s->solving->call.rubbed);
}

void pl_classic_store(pl_substep *s)
{
    const classic c = classic_of(s);
    store(&c, s->solving->call.manifolds, s->solving->call.pairs);
}
