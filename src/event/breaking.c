// breaking.c - who breaks by the contacts of a step, and what of a blow it gives back.
//
// A contact gave the impulse J along its normal n in this step. With k = 1/m + 1/m' + (r x n)^2/I + (r' x n)^2/I', its points approached
// at u = k J - (what they part at now), and J took u J - k J^2 / 2 out of the relative motion. A body that breaks
// bears j <= J of it alone: the j that takes its energy E, (u - sqrt(u^2 - 2 k E)) / k, and at least the impulse that is
// its bound. The rest, J - j, is given back to both, so momentum stays, and so does angular momentum. Other contacts of the two and
// friction are left as they are.
//
// Reads: manifolds (totals), body settings, masses. Writes: velocities, world->fracture.pending. Order: behind the contact
// events; manifolds as they lie, the strongest one of a body. Cost: O(manifolds), and O(bodies that break) for each that does.
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

bool pl_breaking_reserve(plumb_world *world)
{
    pl_fracture *f = &world->fracture;
    return pl_buffer_reserve(&world->memory, &f->pending,
                             ((size_t)f->pending_count + world->settings.breakable) *
                                 sizeof(pl_pending_break));
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
} hit;

static double yield_of(const plumb_world *world, uint32_t row, double arm)
{
    return (double)world->bodies.inv_mass[row] + arm * arm * (double)world->bodies.inv_inertia[row];
}

static hit hit_of(const plumb_world *world, const pl_manifold *m)
{
    const pl_bodies *b = &world->bodies;
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
    const double vx = (double)b->vx[s.b] - (double)b->w[s.b] * s.by - (double)b->vx[s.a] +
                      (double)b->w[s.a] * s.ay;
    const double vy = (double)b->vy[s.b] + (double)b->w[s.b] * s.bx - (double)b->vy[s.a] -
                      (double)b->w[s.a] * s.ax;
    s.approach = s.yield * all - (vx * s.nx + vy * s.ny);
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

// Both get back what exceeds `borne`.
static void give_back(plumb_world *world, const hit *s, double borne)
{
    const double x = (s->impulse - borne) * s->nx, y = (s->impulse - borne) * s->ny;
    push(world, s->a, x, y, s->ax * y - s->ay * x);
    push(world, s->b, -x, -y, -(s->bx * y - s->by * x));
}

// What the body bears of it; < 0: the blow has not the energy that breaking takes.
static double borne_of(const pl_body_settings *t, const hit *s, double dt)
{
    const double u = s->approach, k = s->yield, energy = (double)t->break_energy;
    const bool struck = u > 0 && k > 0 && u * u >= 2 * k * energy;
    const bool loaded = t->break_force > 0 && s->impulse > (double)t->break_force * dt;
    if (!struck) {
        return loaded ? s->impulse : -1;
    }
    const double least =
        t->break_impulse > 0 ? (double)t->break_impulse : (double)t->break_force * dt;
    const double borne = pl_larger(least, (u - sqrt(u * u - 2 * k * energy)) / k);
    return pl_smaller(borne, s->impulse);
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
        const pl_manifold *m = manifold_of(world, &b);
        const uint32_t row = pl_body_row(world, b.body);
        const hit s = hit_of(world, m);
        const bool shared = is_shared(all + first, kept - first, &b);
        const double borne = shared ? s.impulse : borne_of(bounds_of(world, row), &s, dt);
        if (borne < 0) {
            continue;
        }
        const double energy = s.approach * borne - s.yield * borne * borne / 2;
        b.energy = shared || !(energy > 0) ? 0 : (real)energy;
        give_back(world, &s, borne);
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
