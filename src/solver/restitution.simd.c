// restitution.simd.c - impacts of contacts of low restitution, W at a time: as bounce.c has them (formulas there), but
// in the solver's own numbers, with the rows of the contact kernels.
//
// So little is left of the energy of such a contact (PL_IMPACT_KEPT) that it strikes once in a substep: what an
// impact does never comes back to it. So the order does not matter within a colour, and impacts need no queue.
//
// Reads: solver bodies, motions, bundles. Writes: those bodies and motions, the separations that the sweep goes by, the
// records of bounces; pairs and manifolds at the end. Order: in every substep, behind the impacts that are followed
// as events (impact.c), before the sweeps. Cost: four gathers of W rows and 100 flops a bundle, 300 and four
// scatters where something strikes; nothing but a test where nothing bounces.
#include "solver/bundle.h"

// A body of each lane as rows of velocities, so that push() serves all of them.
typedef struct side {
    body now;
    body start; // before contacts pushed in this substep
    body place; // [m], [rad] moved since the start of the step
    body force; // [m/s^2], [rad/s^2]
} side;

typedef struct approach {
    vm due;   // an impact falls into this substep and bounces
    vm clear; // the point stays apart in this substep
    vf speed; // [m/s] at which the surfaces meet, > 0; 0 where none is due
    vf time;  // [s] since the start of the substep
} approach;

WIDE_PART void gather_side(side *s, const pl_contact_call *call, const uint32_t *places)
{
    const near_real *row[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        row[i] = &call->motions[slot_at(places[i])].ax;
    }
    vf r[8];
    gather8(r, row);
    gather_body(&s->now, call, places);
    const body *now = &s->now;
    s->force = (body){ .vx = r[0], .vy = r[1], .w = r[2] };
    s->start = (body){
        .vx = r[4], .vy = r[5], .w = r[6], .inv_mass = r[7], .inv_inertia = now->inv_inertia
    };
    s->place = (body){ .vx = now->dx,
                       .vy = now->dy,
                       .w = now->da,
                       .inv_mass = now->inv_mass,
                       .inv_inertia = now->inv_inertia };
}

// Lanes of immovable bodies write to a sink.
WIDE_PART void scatter_side(const side *s, const pl_contact_call *call, const uint32_t *places)
{
    near_real sink[8] __attribute__((aligned(32)));
    near_real *bodies[PL_WIDTH], *motions[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        const uint32_t slot = slot_at(places[i]);
        const bool moves = slot < call->dynamic_slots;
        bodies[i] = moves ? &call->bodies[slot].vx : sink;
        motions[i] = moves ? &call->motions[slot].ax : sink;
    }
    const body *now = &s->now, *place = &s->place, *start = &s->start;
    scatter8(bodies, (vf[8]){ now->vx, now->vy, now->w, now->inv_mass, place->vx, place->vy,
                              place->w, now->inv_inertia });
    scatter4(motions, 4, (vf[4]){ start->vx, start->vy, start->w, start->inv_mass });
}

WIDE_INLINE vf along_normal(const bundle *c, int j, const body *a, const body *b)
{
    return c->nx * (b->vx - a->vx) + c->ny * (b->vy - a->vy) + c->p[j].rbn * b->w -
           c->p[j].ran * a->w;
}

// The larger component would let some impacts of a slanting force by.
WIDE_INLINE vf length(const body *v)
{
    return vsqrt(v->vx * v->vx + v->vy * v->vy);
}

// What happens to point j in the substep if nothing else does.
WIDE_PART void foresee(approach *out, const bundle *c, const bounce *r, int j, const side *a,
                       const side *b, const pl_contact_call *call)
{
    const vf zero = splat(0), two = splat(2), h = splat(call->h);
    const vf separation = r->separation[j] + along_normal(c, j, &a->place, &b->place);
    const vf v = along_normal(c, j, &a->now, &b->now);
    const vf acceleration = along_normal(c, j, &a->force, &b->force) +
                            (v - along_normal(c, j, &a->start, &b->start)) * splat(call->inv_h);
    const vf u = v - h * acceleration;
    out->clear = separation + h * (u + v) / two >= zero;
    vf square = u * u - two * acceleration * separation;
    vf speed = vsqrt(vmax(square, zero));
    vf time = two * separation / (speed - u);
    const vf fastest = vmax(-v, -u);
    const vm old = (square <= zero) | (time < -h) | (speed > fastest), overlaps = separation < zero;
    speed = sel(old, sel(overlaps, -u, fastest), speed);
    time = sel(old, sel(overlaps, zero, separation / fastest), time);
    const vf calm = splat(4) * (length(&a->force) + length(&b->force)) * h;
    const vm gentle =
        (speed <= splat(call->restitution_speed)) | ((c->p[j].ln > zero) & (speed <= calm));
    const vm returns = r->restitution * speed + acceleration * (h - time) / two > zero;
    out->due = (r->restitution > zero) & (u < zero) & returns & ~out->clear & ~gentle;
    out->speed = sel(out->due, speed, zero);
    out->time = sel(out->due, time, zero);
}

WIDE_INLINE void foresee_both(approach at[2], const bundle *c, const bounce *r, const side *a,
                              const side *b, const pl_contact_call *call)
{
    foresee(&at[0], c, r, 0, a, b, call);
    foresee(&at[1], c, r, 1, a, b, call);
}

// Of both points [N s]; 0 where nothing is due.
WIDE_INLINE void find_impulses(vf impulse[2], const bundle *c, const bounce *r,
                               const approach at[2])
{
    const vf zero = splat(0), one = splat(1), gain = one + r->restitution;
    const vf k00 = c->p[0].kn, k11 = c->p[1].kn, k01 = c->k01;
    const vf r0 = gain * at[0].speed, r1 = gain * at[1].speed;
    const vf det = k00 * k11 - k01 * k01;
    const vm regular = det > splat((near_real)1e-3) * k00 * k11; // else one at a time
    const vf inv = one / sel(regular, det, one);
    const vf i0 = (k11 * r0 - k01 * r1) * inv, i1 = (k00 * r1 - k01 * r0) * inv;
    const vm both = regular & at[0].due & at[1].due & (i0 > zero) & (i1 > zero);
    const vm first = at[0].speed >= at[1].speed;
    impulse[0] = sel(both, i0, sel(first, r0 * inverse_or_zero(k00), zero));
    impulse[1] = sel(both, i1, sel(first, zero, r1 * inverse_or_zero(k11)));
}

// An impulse at point j as of `time` into the substep: what integrates positions will count all of it.
WIDE_INLINE void strike(const bundle *c, const special *s, int j, side *a, side *b, vf along_n,
                        vf along_t, vf time)
{
    const point *p = &c->p[j];
    push(c, s, p, &a->now, &b->now, along_n, along_t, true);
    push(c, s, p, &a->start, &b->start, along_n, along_t, true);
    push(c, s, p, &a->place, &b->place, -time * along_n, -time * along_t, true);
}

// For what follows impacts as events: when a body was struck last.
WIDE_INLINE void note_times(const pl_contact_call *call, const uint32_t *places, vm struck, vf time)
{
    for (int i = 0; i < PL_WIDTH; ++i) {
        const uint32_t slot = slot_at(places[i]);
        if (struck[i] && slot < call->dynamic_slots) {
            call->struck[slot] = time[i];
        }
    }
}

WIDE_PART void resolve(const bundle *c, const special *s, extra *e, bounce *r, side *a, side *b,
                       const approach at[2], const pl_contact_call *call)
{
    const vf zero = splat(0);
    vf impulse[2];
    find_impulses(impulse, c, r, at);
    for (int j = 0; j < 2; ++j) {
        strike(c, s, j, a, b, impulse[j], zero, at[j].time);
        const vm fastest = (impulse[j] > zero) & (at[j].speed > r->speed);
        r->speed = sel(fastest, at[j].speed, r->speed);
        r->time = sel(fastest, splat(call->since) + at[j].time, r->time);
    }
    const friction_row both = friction_row_of(c->p, impulse[0], impulse[1]);
    const vf bound = c->friction * (impulse[0] + impulse[1]);
    const vf total = vclamp(-both.mt * slip_at(c, e, &both, &a->now, &b->now, true), -bound, bound);
    for (int j = 0; j < 2; ++j) {
        const vf along_t = (j == 0 ? (vf)(splat(1) - both.share) : both.share) * total;
        strike(c, s, j, a, b, zero, along_t, at[j].time);
        if (e != NULL) {
            e->total[j] += impulse[j];
            e->rubbed[j] += along_t;
        }
        if (call->struck != NULL) {
            note_times(call, c->a, impulse[j] > zero, at[j].time);
            note_times(call, c->b, impulse[j] > zero, at[j].time);
        }
    }
    r->impacts += sel((impulse[0] > zero) | (impulse[1] > zero), splat(1), zero);
}

// Points that stay clear of their own accord are none of the sweep's business.
WIDE_INLINE void tell_sweep(bundle *c, const bounce *r, const approach at[2])
{
    for (int j = 0; j < 2; ++j) {
        const vm off = at[j].clear & (c->p[j].ln <= splat(0));
        const vf told = r->separation[j] + sel(off, splat(PL_APART), splat(0));
        c->p[j].separation = sel(r->restitution > splat(0), told, c->p[j].separation);
    }
}

WIDE_INLINE void bounce_all(const pl_contact_call *call, uint32_t first, uint32_t count,
                            bool special_ones)
{
    for (uint32_t k = first; k < first + count; ++k) {
        bundle *c = (bundle *)call->bundles + k;
        bounce *r = (bounce *)call->bounces + k;
        if (!any(r->restitution > splat(0))) {
            continue;
        }
        const special *s = special_ones ? (const special *)call->specials + k : NULL;
        side a, b;
        gather_side(&a, call, c->a);
        gather_side(&b, call, c->b);
        approach at[2];
        foresee_both(at, c, r, &a, &b, call);
        if (any(at[0].due | at[1].due)) {
            extra *e = call->extras != NULL ? (extra *)call->extras + k : NULL;
            resolve(c, s, e, r, &a, &b, at, call);
            scatter_side(&a, call, c->a);
            scatter_side(&b, call, c->b);
            foresee_both(at, c, r, &a, &b, call);
        }
        tell_sweep(c, r, at);
    }
}

void PL_WIDE_NAME(pl_contact_bounce)(const pl_contact_call *call, uint32_t first, uint32_t count)
{
    bounce_all(call, first, count, false);
}

void PL_WIDE_NAME(pl_contact_bounce_special)(const pl_contact_call *call, uint32_t first,
                                             uint32_t count)
{
    bounce_all(call, first, count, true);
}

void PL_WIDE_NAME(pl_contact_prepare_bounces)(const pl_contact_call *call, uint32_t first,
                                              uint32_t count)
{
    for (uint32_t k = first; k < first + count; ++k) {
        const bundle *c = (const bundle *)call->bundles + k;
        bounce *r = (bounce *)call->bounces + k;
        *r = (bounce){ .separation = { c->p[0].separation, c->p[1].separation } };
        for (int i = 0; i < PL_WIDTH; ++i) {
            const uint32_t at = call->lanes[(size_t)k * PL_WIDTH + (size_t)i];
            if (at != PL_NONE && pl_bounces(&call->manifolds[at]) &&
                !pl_is_elastic(call->manifolds[at].restitution)) {
                r->restitution[i] = call->manifolds[at].restitution;
            }
        }
    }
}

void PL_WIDE_NAME(pl_contact_store_bounces)(const pl_contact_call *call, uint32_t first,
                                            uint32_t count)
{
    uint32_t impacts = 0;
    for (uint32_t k = first; k < first + count; ++k) {
        const bounce *r = (const bounce *)call->bounces + k;
        for (int i = 0; i < PL_WIDTH && any(r->impacts > splat(0)); ++i) {
            if (r->impacts[i] > 0) {
                pl_manifold *m = &call->manifolds[call->lanes[(size_t)k * PL_WIDTH + (size_t)i]];
                pl_manifold_strike(m, r->speed[i], r->time[i]);
                call->pairs[m->pair].flags |= PL_PAIR_HIT;
                impacts += (uint32_t)r->impacts[i];
            }
        }
    }
    __atomic_fetch_add(call->bounce_count, impacts, __ATOMIC_RELAXED); // threads share a cluster
}
