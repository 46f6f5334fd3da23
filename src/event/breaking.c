// breaking.c - who breaks by the contacts of a step, and what of a blow it gives back.
//
// A contact gave the impulse J along its normal n in this step, and its points part at v now. With k = 1/m + 1/m' + (r x n)^2/I +
// (r' x n)^2/I' they approached at u = k J - v, were there no other contact; held by others, a body takes any J without
// a blow: they approached no faster than when the step began and than what they weigh added since. A body that breaks bears
// j <= J of it alone: what leaves the approach u' = sqrt(u^2 - 2 k E) of what breaking takes, E, and at least the impulse
// that is its bound. The rest, J - j = (u' + v) / k, is given back to both, so momentum stays, and so does angular momentum; and no blow gives more
// than it brought. Other contacts of the two and friction are left as they are.
//
// Reads: manifolds (totals), body settings, masses. Writes: velocities, world->fracture.pending. Order: velocities are noted before
// the substeps, the rest is behind the contact events; manifolds as they lie, the strongest one of a body. Cost: O(manifolds),
// O(bodies), and O(bodies that break) for each that does.
#include "event/event.h"

#include "plumb/math.h"
#include "schema/passes.h"
#include "world/rows.h"

#include <math.h>

bool pl_want_breaking(const plumb_world *world, const char **reason)
{
    const bool wanted = world->settings.breakable > 0;
    *reason = wanted ? "some body has break_force or break_impulse" : "no body breaks";
    return wanted;
}

static pl_row_velocity velocity_of(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    return (pl_row_velocity){ b->vx[row], b->vy[row], b->w[row] };
}

bool pl_breaking_prepare(plumb_world *world)
{
    pl_fracture *f = &world->fracture;
    const uint32_t count = world->bodies.table.count;
    if (!pl_buffer_reserve(&world->memory, &f->pending,
                           ((size_t)f->pending_count + world->settings.breakable) *
                               sizeof(pl_pending_break)) ||
        !pl_buffer_reserve(&world->memory, &f->before, count * sizeof(pl_row_velocity))) {
        return false;
    }
    pl_row_velocity *before = f->before.data;
    for (uint32_t row = 0; row < count; ++row) {
        before[row] = velocity_of(world, row);
    }
    return true;
}

static const pl_body_settings *bounds_of(const plumb_world *world, uint32_t row)
{
    const uint32_t at = row < world->dynamic_count ? world->bodies.settings[row] : 0;
    const pl_body_settings *t =
        at == 0 ? NULL : (const pl_body_settings *)world->settings.items.data + at - 1;
    return t != NULL && (t->break_force > 0 || t->break_impulse > 0) ? t : NULL;
}

// [N s] along the normal over the step.
static double impulse_of(const pl_manifold *m)
{
    return (double)m->point[0].total + (m->count > 1 ? (double)m->point[1].total : 0);
}

static bool exceeds(const pl_body_settings *t, double impulse, double dt)
{
    return (t->break_impulse > 0 && impulse > (double)t->break_impulse) ||
           (t->break_force > 0 && impulse > (double)t->break_force * dt);
}

//---- a contact as a blow -------------------------------------------------------------------------

typedef struct hit {
    uint32_t a, b;         // rows
    double nx, ny;         // from a to b
    double ax, ay, bx, by; // [m] from the centres to where it acts
    double impulse;        // [N s]
    double yield;          // [1/kg] k above
    double approach;       // [m/s] u above
    double parts;          // [m/s] v above
} hit;

static double yield_of(const plumb_world *world, uint32_t row, double arm)
{
    return (double)world->bodies.inv_mass[row] + arm * arm * (double)world->bodies.inv_inertia[row];
}

// [m/s] at which the points of a hit part at such velocities.
static double parting(const hit *s, const pl_row_velocity *a, const pl_row_velocity *b)
{
    const double vx = (double)b->vx - (double)b->w * s->by - (double)a->vx + (double)a->w * s->ay;
    const double vy = (double)b->vy + (double)b->w * s->bx - (double)a->vy - (double)a->w * s->ax;
    return vx * s->nx + vy * s->ny;
}

static hit hit_of(const plumb_world *world, const pl_manifold *m, double dt)
{
    const double all = impulse_of(m);
    hit s = {
        .a = m->body_a, .b = m->body_b, .nx = (double)m->nx, .ny = (double)m->ny, .impulse = all
    };
    for (uint32_t k = 0; k < m->count; ++k) {
        const pl_manifold_point *p = &m->point[k];
        const double share = (double)p->total / all;
        s.ax += share * (double)p->ax;
        s.ay += share * (double)p->ay;
        s.bx += share * (double)p->bx;
        s.by += share * (double)p->by;
    }
    s.yield = yield_of(world, s.a, s.ax * s.ny - s.ay * s.nx) +
              yield_of(world, s.b, s.bx * s.ny - s.by * s.nx);
    const pl_row_velocity a = velocity_of(world, s.a), b = velocity_of(world, s.b);
    s.parts = parting(&s, &a, &b);
    const pl_row_velocity *before = world->fracture.before.data;
    const double weight =
        fabs((double)world->gravity.x * s.nx + (double)world->gravity.y * s.ny) * dt;
    s.approach =
        pl_smaller(s.yield * all - s.parts, weight - parting(&s, &before[s.a], &before[s.b]));
    return s;
}

static void push(plumb_world *world, uint32_t row, double x, double y, double turn)
{
    pl_bodies *b = &world->bodies;
    const double im = (double)b->inv_mass[row];
    const uint32_t flags = b->flags[row];
    b->vx[row] += (flags & PL_BODY_LOCK_X) != 0 ? 0 : (real)(im * x);
    b->vy[row] += (flags & PL_BODY_LOCK_Y) != 0 ? 0 : (real)(im * y);
    b->w[row] += (real)((double)b->inv_inertia[row] * turn);
    pl_poses(world)[row].vx = b->vx[row];
    pl_poses(world)[row].vy = b->vy[row];
}

static void give_back(plumb_world *world, const hit *s, double impulse)
{
    const double x = impulse * s->nx, y = impulse * s->ny;
    push(world, s->a, x, y, s->ax * y - s->ay * x);
    push(world, s->b, -x, -y, -(s->bx * y - s->by * x));
}

// Whether the blow or the load is one that breaks.
static bool breaks(const pl_body_settings *t, const hit *s, double dt)
{
    const double u = s->approach, energy = (double)t->break_energy;
    const bool struck = s->yield > 0 && (u > 0 ? u * u : 0) >= 2 * s->yield * energy;
    return struck || (t->break_force > 0 && s->impulse > (double)t->break_force * dt);
}

// What the body does not bear of it.
static double rest_of(const pl_body_settings *t, const hit *s, double dt)
{
    const double u = s->approach, left = u * u - 2 * s->yield * (double)t->break_energy;
    if (!(u > 0 && left >= 0 && s->yield > 0)) {
        return 0;
    }
    const double least =
        t->break_impulse > 0 ? (double)t->break_impulse : (double)t->break_force * dt;
    const double rest = (sqrt(left) + s->parts) / s->yield;
    return pl_larger(pl_smaller(rest, s->impulse - least), 0);
}

// [J] of the approach that breaking took.
static double taken_by(const hit *s, double rest)
{
    const double after = pl_larger(s->yield * rest - s->parts, 0);
    return s->approach > after ? (s->approach * s->approach - after * after) / (2 * s->yield) : 0;
}

//---- who breaks ----------------------------------------------------------------------------------

static plumb_vec2 place_of(const plumb_world *world, const pl_manifold *m)
{
    return pl_contact_place(world, m, m->count > 1 && m->point[1].total > m->point[0].total);
}

// Keeps the strongest contact of each body that exceeds a bound: `point` and so on are filled in when all are known.
static void note(plumb_world *world, uint32_t manifold, uint32_t row, double impulse,
                 uint32_t first)
{
    pl_fracture *f = &world->fracture;
    pl_pending_break *all = f->pending.data;
    uint32_t i = first;
    while (i < f->pending_count && !plumb_same(all[i].body, world->bodies.entity[row])) {
        ++i;
    }
    if (i == f->pending_count) {
        all[f->pending_count++] = (pl_pending_break){ .body = world->bodies.entity[row] };
    }
    if (impulse > (double)all[i].impulse) {
        const pl_manifold *m = &pl_manifolds(&world->narrow)[manifold];
        const bool is_a = m->body_a == row;
        all[i].impulse = (real)impulse;
        all[i].other = world->bodies.entity[is_a ? m->body_b : m->body_a];
        all[i].normal = is_a ? plumb_v2(m->nx, m->ny) : plumb_v2(-m->nx, -m->ny);
        all[i].point = place_of(world, m);
    }
}

// Whether a body that breaks is the other of one that did before, by the same contact: what was to be given back was.
static bool is_shared(const pl_pending_break *all, uint32_t count, const pl_pending_break *b)
{
    bool shared = false;
    for (uint32_t i = 0; i < count; ++i) {
        shared |= plumb_same(all[i].body, b->other) && plumb_same(all[i].other, b->body) &&
                  all[i].impulse == b->impulse;
    }
    return shared;
}

static const pl_manifold *manifold_of(const plumb_world *world, const pl_pending_break *b)
{
    const pl_manifold *all = pl_manifolds(&world->narrow);
    const uint32_t row = pl_body_row(world, b->body), other = pl_body_row(world, b->other);
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        const bool these = (all[i].body_a == row && all[i].body_b == other) ||
                           (all[i].body_b == row && all[i].body_a == other);
        if (these && (real)impulse_of(&all[i]) == b->impulse) {
            return &all[i];
        }
    }
    return NULL;
}

// Those of this step: what they bear, and whether they break at all.
static void settle(plumb_world *world, uint32_t first, double dt)
{
    pl_fracture *f = &world->fracture;
    pl_pending_break *all = f->pending.data;
    uint32_t kept = first;
    for (uint32_t i = first; i < f->pending_count; ++i) {
        pl_pending_break b = all[i];
        const pl_body_settings *t = bounds_of(world, pl_body_row(world, b.body));
        const hit s = hit_of(world, manifold_of(world, &b), dt);
        const bool shared = is_shared(all + first, kept - first, &b);
        if (!shared && !breaks(t, &s, dt)) {
            continue;
        }
        const double rest = shared ? 0 : rest_of(t, &s, dt);
        b.energy = shared ? 0 : (real)taken_by(&s, rest);
        give_back(world, &s, rest);
        all[kept++] = b;
    }
    f->pending_count = kept;
}

void pl_breaking_find(plumb_world *world, real dt)
{
    const uint32_t first = world->fracture.pending_count;
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        const pl_manifold *m = &pl_manifolds(&world->narrow)[i];
        const double impulse = impulse_of(m);
        const uint32_t rows[2] = { m->body_a, m->body_b };
        for (int k = 0; k < 2 && impulse > 0; ++k) {
            const pl_body_settings *t = bounds_of(world, rows[k]);
            if (t != NULL && exceeds(t, impulse, (double)dt)) {
                note(world, i, rows[k], impulse, first);
            }
        }
    }
    if (world->fracture.pending_count > first) {
        settle(world, first, (double)dt);
    }
}
