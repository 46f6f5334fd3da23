// bundle.h - the constraints of W contacts, as the kernels keep them over a step (symbols in contact.simd.c), and
// the bodies of such a bundle. Included by *.simd.c only.
#ifndef PL_BUNDLE_H
#define PL_BUNDLE_H

#include "core/wide.h"
#include "solver/solver.h"

typedef struct point {
    vf ran, rbn, rat, rbt; // [m]
    vf separation;         // [m] at the start of the step
    vf kn;                 // [1/kg] inverse effective mass along the normal
    vf give;               // [1/kg] softness: how much an impulse gives way
    vf mt;                 // [kg] effective mass along the tangent
    vf ln, lt;             // [N s]
} point;

typedef struct bundle {
    uint32_t a[PL_WIDTH], b[PL_WIDTH]; // [B] where the solver bodies are, from the first: place_of
    vf nx, ny;
    vf friction;
    vf bias_rate; // [1/s] softness: the push for each metre of overlap
    vf k01;       // [1/kg] what an impulse at one point does to the other
    vf pushed;    // [N s] most of a point after any substep so far
    point p[2];
} bundle;

// What only running surfaces and counted impulses need, apart from the bundle, so that others do
// not read it. Rolling resistance: a torque between the bodies that opposes their relative turning,
// at most f times the normal impulse of the contact; like friction it acts in the relaxing sweeps.
typedef struct extra {
    vf surface_speed; // [m/s]
    vf rolling;       // [m]
    vf mr;            // [kg m^2] effective inertia
    vf lr;            // [N m s]
    vf total[2];      // [N s] normal impulses of the substeps so far
    vf rubbed[2];     // [N s] likewise along the tangent
    vf struck;        // [m/s] fastest at which a point was struck in this step
    vf struck_at;     // [s] when, since the step began
} extra;

// What only locked axes, bodies whose time stands still and surfaces that stick need. A body locked along an axis has infinite mass
// that way. A point that sticks may pull while it is nearer than its reach: its impulse is at least
// -pull, and so l + pull is what is never negative, what friction goes by, and what the springs carry.
typedef struct special {
    vf aix, aiy, bix, biy; // [1/kg] inverse masses along the axes
    vf pull[2];            // [N s]
    vf reach;              // [m]
} special;

// What only surfaces need that slide more easily than they hold. The bundle has the friction of the moment.
typedef struct grip {
    vf sticks, slides; // [-] the same where there is one
} grip;

// What only contacts of low restitution need (restitution.simd.c).
typedef struct bounce {
    vf restitution; // 0: none here, or an impact that is followed as an event (impact.c)
    vf separation
        [2]; // [m] at the start of the step; the point's own may say that the point is out of reach
    vf speed;   // [m/s] of the fastest impact in this step
    vf time;    // [s] of it, since the step began
    vf impacts; // in this step
} bounce;

// What only contacts need that turn within the step (moment.simd.c). Lanes that do not turn, and all where `any` is
// false, are left as they are.
typedef struct turning {
    bool any;
    vm turns;                   // lanes
    vm with_a, with_b;          // whose face the normal is; neither: it connects centres
    vf nx, ny;                  // when the step began
    vf ra, rb;                  // [m] from the core points to the surfaces
    vf ax[2], ay[2];            // [m] core points of A then, from its centre of mass
    vf bx[2], by[2];            // [m] of B
    vf start[2], separation[2]; // [m] then, and now
} turning;

//---- bodies of the lanes ------------------------------------------------------------------------

typedef struct body {
    vf vx, vy, w, inv_mass, dx, dy, da, inv_inertia;
} body;

// Bytes, for a sweep asks for 64 places of every 16 contacts: to multiply slots took a tenth of its instructions.
WIDE_INLINE uint32_t place_of(uint32_t slot)
{
    return slot * (uint32_t)sizeof(pl_solver_body);
}

WIDE_INLINE uint32_t slot_at(uint32_t place)
{
    return place / (uint32_t)sizeof(pl_solver_body);
}

WIDE_INLINE near_real *body_at(const pl_contact_call *call, uint32_t place)
{
    return (near_real *)(void *)((char *)call->bodies + place);
}

WIDE_INLINE void gather_body(body *out, const pl_contact_call *call, const uint32_t *places)
{
    const near_real *row[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        row[i] = body_at(call, places[i]);
    }
    vf r[8];
    gather8(r, row);
    *out = (body){ r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7] };
}

// Writes velocities back; lanes of immovable bodies write to a sink, for others share those rows. Most bundles have none.
WIDE_INLINE void scatter_velocity(const body *in, const pl_contact_call *call,
                                  const uint32_t *places)
{
    const vf out[4] = { in->vx, in->vy, in->w, in->inv_mass };
    const uint32_t end = place_of(call->dynamic_slots);
    near_real *row[PL_WIDTH];
    __asm__(
        ""
        : "+r"(
            places)); // read again: kept since they were gathered, 32 of them are moved to and fro
    if (all_below(places, end)) {
        for (int i = 0; i < PL_WIDTH; ++i) {
            row[i] = body_at(call, places[i]);
        }
        scatter4(row, 0, out);
        return;
    }
    near_real sink[4] __attribute__((aligned(32)));
    for (int i = 0; i < PL_WIDTH; ++i) {
        row[i] = places[i] < end ? body_at(call, places[i]) : sink;
    }
    scatter4(row, 0, out);
}

WIDE_INLINE vf inverse_or_zero(vf k)
{
    vm positive = k > splat(0);
    return sel(positive, splat(1) / sel(positive, k, splat(1)), splat(0));
}

// Lanes with a body that has a locked axis. What is reckoned otherwise for these is left to the others as it is, to the bit: who is
// locked elsewhere is nobody's business.
WIDE_INLINE vm locked_lanes(const special *s, const body *a, const body *b)
{
    return (s->aix != a->inv_mass) | (s->aiy != a->inv_mass) | (s->bix != b->inv_mass) |
           (s->biy != b->inv_mass);
}

// Adds an impulse (px, py) to B and takes it from A; `s` null: no axis is locked.
WIDE_INLINE void shove(body *a, body *b, const special *s, vf px, vf py)
{
    a->vx -= (s != NULL ? s->aix : a->inv_mass) * px;
    a->vy -= (s != NULL ? s->aiy : a->inv_mass) * py;
    b->vx += (s != NULL ? s->bix : b->inv_mass) * px;
    b->vy += (s != NULL ? s->biy : b->inv_mass) * py;
}

WIDE_INLINE void push_turn(body *a, body *b, vf impulse)
{
    a->w -= a->inv_inertia * impulse;
    b->w += b->inv_inertia * impulse;
}

// Adds the impulses (along n and t) of a point to both bodies.
WIDE_INLINE void push(const bundle *c, const special *s, const point *p, body *a, body *b,
                      vf along_n, vf along_t, bool rotation)
{
    vf px = c->nx * along_n - c->ny * along_t;
    vf py = c->ny * along_n + c->nx * along_t;
    shove(a, b, s, px, py);
    if (rotation) {
        a->w -= a->inv_inertia * (p->ran * along_n + p->rat * along_t);
        b->w += b->inv_inertia * (p->rbn * along_n + p->rbt * along_t);
    }
}

// Friction of a contact: one row for both points, for these slide alike. It acts where their loads do as one. Two rows, one after the
// other, gave the first of them what both could bear: a box that landed flat and slid tipped by the order of its corners.
typedef struct friction_row {
    vf share;    // [-] of the second point
    vf rat, rbt; // [m]
    vf mt;       // [kg]
} friction_row;

// What points that bear load0 and load1 >= 0 have together.
WIDE_INLINE friction_row friction_row_of(const point p[2], vf load0, vf load1)
{
    const vf load = load0 + load1;
    const vf share = load1 / sel(load > splat(0), load, splat(1));
    return (friction_row){ .share = share,
                           .rat = p[0].rat + share * (p[1].rat - p[0].rat),
                           .rbt = p[0].rbt + share * (p[1].rbt - p[0].rbt),
                           .mt = p[0].mt + share * (p[1].mt - p[0].mt) };
}

// [m/s] at which the surfaces slide; `e` null: they move with their bodies.
WIDE_INLINE vf slip_at(const bundle *c, const extra *e, const friction_row *r, const body *a,
                       const body *b, bool rotation)
{
    vf slip = c->nx * (b->vy - a->vy) - c->ny * (b->vx - a->vx);
    if (e != NULL) {
        slip += e->surface_speed;
    }
    if (rotation) {
        slip += r->rbt * b->w - r->rat * a->w;
    }
    return slip;
}

//---- rows ----------------------------------------------------------------------------------------

// What an impulse at one point does to the other, little enough for the points' block to have one answer: where neither
// body can turn both rows are the same, and each sweep could move all load to one point and leave the other's friction
// without any. The share is twice what solve_normals needs to call the block regular.
WIDE_INLINE vf coupling(const bundle *c, vf mass, const body *a, const body *b)
{
    vf k01 = mass + a->inv_inertia * c->p[0].ran * c->p[1].ran +
             b->inv_inertia * c->p[0].rbn * c->p[1].rbn;
    vm same = (k01 == c->p[0].kn) & (k01 == c->p[1].kn);
    return sel(same, k01 * splat((near_real)(1 - 1.0 / 1024)), k01);
}

// An empty lane: no mass, no impulse, out of reach.
static const pl_manifold no_manifold __attribute__((
    aligned(64))) = { .point = { { .separation = PL_APART }, { .separation = PL_APART } } };

//---- kernels that contact.simd.c puts into the table of its width ---------------------------------

pl_contact_kernel PL_WIDE_NAME(pl_contact_prepare), PL_WIDE_NAME(pl_contact_prepare_extras),
    PL_WIDE_NAME(pl_contact_prepare_specials), PL_WIDE_NAME(pl_contact_prepare_bounces);
pl_contact_kernel PL_WIDE_NAME(pl_contact_prepare_fine), PL_WIDE_NAME(pl_contact_close_fine);
pl_contact_kernel PL_WIDE_NAME(pl_contact_prepare_grips), PL_WIDE_NAME(pl_contact_store_grips);
pl_contact_kernel PL_WIDE_NAME(pl_contact_bounce), PL_WIDE_NAME(pl_contact_bounce_special);
pl_contact_kernel PL_WIDE_NAME(pl_contact_tally), PL_WIDE_NAME(pl_contact_store),
    PL_WIDE_NAME(pl_contact_store_extras), PL_WIDE_NAME(pl_contact_store_bounces);
pl_contact_kernel PL_WIDE_NAME(pl_contact_prepare_moment), PL_WIDE_NAME(pl_contact_open_moment),
    PL_WIDE_NAME(pl_contact_follow_moment);
pl_range_fn PL_WIDE_NAME(pl_bodies_halve), PL_WIDE_NAME(pl_bodies_drift); // halves.simd.c
pl_place_kernel PL_WIDE_NAME(pl_bodies_place);                            // finish.simd.c
void PL_WIDE_NAME(pl_contact_measure)(const pl_contact_call *call, uint32_t first, uint32_t count,
                                      struct pl_measuring *m);
void PL_WIDE_NAME(pl_contact_residual)(const pl_contact_call *call, uint32_t first, uint32_t count,
                                       struct pl_measuring *m);

#endif
