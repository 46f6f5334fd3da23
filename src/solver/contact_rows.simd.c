// contact_rows.simd.c - manifolds to bundles of W contacts, and impulses back to pairs and manifolds.
//
// The formulas of what is prepared: contact.simd.c. What bounces: restitution.simd.c.
//
// Reads: manifolds, pairs, solver bodies. Writes: bundles and the records beside them; pairs, manifolds. Order:
// before the first and behind the last substep. Cost: two gathers of W manifolds and bodies a bundle; a row
// written for each contact.
#include "narrow/surface.h"
#include "solver/bundle.h"

WIDE_INLINE void prepare_point(point *p, const vf row[8], const bundle *c, const body *a,
                               const body *b)
{
    vf ax = row[0], ay = row[1], bx = row[2], by = row[3];
    p->ran = ax * c->ny - ay * c->nx;
    p->rbn = bx * c->ny - by * c->nx;
    p->rat = ax * c->nx + ay * c->ny; // r x t with t = (-ny, nx)
    p->rbt = bx * c->nx + by * c->ny;
    p->separation = row[4];
    vf mass = a->inv_mass + b->inv_mass;
    p->kn = mass + a->inv_inertia * p->ran * p->ran + b->inv_inertia * p->rbn * p->rbn;
    p->mt =
        inverse_or_zero(mass + a->inv_inertia * p->rat * p->rat + b->inv_inertia * p->rbt * p->rbt);
    p->ln = row[5];
    p->lt = row[6];
}

// Contacts with immovable bodies are so many times stiffer: what carries a pile yields last, and no
// mass ratio can make them unstable.
#define STATIC_STIFFNESS ((near_real)2)

typedef struct softness {
    vf bias_rate, give;
} softness;

// Numbers of a soft contact of `factor` times the call's frequency; formulas on top.
WIDE_INLINE softness soften(const pl_contact_call *call, near_real factor)
{
    near_real omega = (near_real)6.283185307179586 * call->hertz * factor;
    near_real a1 = 2 * call->damping + call->h * omega;
    near_real a2 = call->h * omega * a1;
    return (softness){ splat(omega / a1), splat(1 / a2) };
}

// A point deeper than the push may undo in a second is pushed less than its spring would. It gives
// way less by the same share, or the spring would bear no more than the push speed stands for: a
// point below a heavy pile would sink for ever.
WIDE_INLINE vf held_back(const bundle *c, const point *p, const pl_contact_call *call)
{
    vf limit = splat(call->push_speed);
    return limit / vmax(-p->separation * c->bias_rate, limit);
}

// A point whose bodies part faster than any push has parted them bears nothing any more. What it bore, of which a body that
// was crushed has plenty, would only pull it along, sweep after sweep: that much of it may be taken back.
#define LEAVES ((near_real)6) // [m/s] the push speed of a world that says nothing

WIDE_INLINE void let_go(const bundle *c, point *p, const body *a, const body *b, vm fixed, vf limit)
{
    const vf vn = c->nx * (b->vx - a->vx) + c->ny * (b->vy - a->vy) + p->rbn * b->w - p->ran * a->w;
    const vm leaves = fixed & (vn > limit);
    p->ln = sel(leaves, splat(0), p->ln);
    p->lt = sel(leaves, splat(0), p->lt);
}

void PL_WIDE_NAME(pl_contact_prepare)(const pl_contact_call *call, uint32_t first, uint32_t count)
{
    bundle *bundles = call->bundles;
    const softness pair = soften(call, 1), ground = soften(call, STATIC_STIFFNESS);
    const vf leaves = splat(call->push_speed > LEAVES ? call->push_speed : LEAVES);
    for (uint32_t k = first; k < first + count; ++k) {
        bundle *c = &bundles[k];
        const near_real *row[3][PL_WIDTH];
        for (int i = 0; i < PL_WIDTH && k + 2 < first + count; ++i) {
            uint32_t at = call->lanes[(size_t)(k + 2) * PL_WIDTH + (size_t)i];
            if (at != PL_NONE) {
                __builtin_prefetch(&call->manifolds[at]);
                __builtin_prefetch(&call->manifolds[at].point[1]);
            }
        }
        for (int i = 0; i < PL_WIDTH; ++i) {
            uint32_t at = call->lanes[(size_t)k * PL_WIDTH + (size_t)i];
            const pl_manifold *m = at == PL_NONE ? &no_manifold : &call->manifolds[at];
            c->a[i] = c->b[i] = place_of(call->immovable_slot);
            if (at != PL_NONE && m->body_a < call->movable_rows) {
                c->a[i] = place_of(call->slots[m->body_a]);
            }
            if (at != PL_NONE && m->body_b < call->movable_rows) {
                c->b[i] = place_of(call->slots[m->body_b]);
            }
            row[0][i] = &m->nx;
            row[1][i] = &m->point[0].ax;
            row[2][i] = &m->point[1].ax;
        }
        body a, b;
        gather_body(&a, call, c->a);
        gather_body(&b, call, c->b);
        vf r[8];
        gather4(r, row[0], 0);
        c->pushed = splat(0);
        c->nx = r[0], c->ny = r[1], c->friction = r[2];
        vm fixed = (a.inv_mass == splat(0)) | (b.inv_mass == splat(0));
        c->bias_rate = sel(fixed, ground.bias_rate, pair.bias_rate);
        vf give = sel(fixed, ground.give, pair.give);
        for (int j = 0; j < 2; ++j) {
            gather8(r, row[1 + j]);
            prepare_point(&c->p[j], r, c, &a, &b);
            let_go(c, &c->p[j], &a, &b, fixed, leaves);
            c->p[j].give = c->p[j].kn * give * held_back(c, &c->p[j], call);
        }
        c->k01 = coupling(c, a.inv_mass + b.inv_mass, &a, &b);
    }
}

void PL_WIDE_NAME(pl_contact_prepare_extras)(const pl_contact_call *call, uint32_t first,
                                             uint32_t count)
{
    const bundle *bundles = call->bundles;
    extra *extras = call->extras;
    for (uint32_t k = first; k < first + count; ++k) {
        const bundle *c = &bundles[k];
        extra *e = &extras[k];
        *e = (extra){ .surface_speed = splat(0) };
        body a, b;
        gather_body(&a, call, c->a);
        gather_body(&b, call, c->b);
        e->mr = inverse_or_zero(a.inv_inertia + b.inv_inertia);
        for (int i = 0; i < PL_WIDTH; ++i) {
            uint32_t at = call->lanes[(size_t)k * PL_WIDTH + (size_t)i];
            if (at != PL_NONE) {
                e->surface_speed[i] = call->manifolds[at].surface_speed;
                e->rolling[i] = call->manifolds[at].rolling;
                e->lr[i] = call->pairs[call->manifolds[at].pair].rolling;
            }
        }
        vf bound = e->rolling * (c->p[0].ln + c->p[1].ln);
        e->lr = vclamp(e->lr, -bound, bound);
    }
}

// Rows of the lanes with a body that has a locked axis.
WIDE_PART void lock_rows(bundle *c, const special *s, const body *a, const body *b,
                         const pl_contact_call *call)
{
    const vm locked = locked_lanes(s, a, b);
    if (!any(locked)) {
        return;
    }
    const softness pair = soften(call, 1), ground = soften(call, STATIC_STIFFNESS);
    const vf nxx = c->nx * c->nx, nyy = c->ny * c->ny;
    const vf mass_a = s->aix * nxx + s->aiy * nyy, mass_b = s->bix * nxx + s->biy * nyy;
    const vf mass_n = mass_a + mass_b;
    const vf mass_t = (s->aix + s->bix) * nyy + (s->aiy + s->biy) * nxx;
    for (int j = 0; j < 2; ++j) {
        point *p = &c->p[j];
        const vf kn = mass_n + a->inv_inertia * p->ran * p->ran + b->inv_inertia * p->rbn * p->rbn;
        const vf mt = inverse_or_zero(mass_t + a->inv_inertia * p->rat * p->rat +
                                      b->inv_inertia * p->rbt * p->rbt);
        p->kn = sel(locked, kn, p->kn);
        p->mt = sel(locked, mt, p->mt);
    }
    c->k01 = sel(locked, coupling(c, mass_n, a, b), c->k01);
    const vm fixed = ((mass_a == splat(0)) & (a->inv_inertia == splat(0))) |
                     ((mass_b == splat(0)) & (b->inv_inertia == splat(0)));
    c->bias_rate = sel(locked, sel(fixed, ground.bias_rate, pair.bias_rate), c->bias_rate);
    const vf give = sel(fixed, ground.give, pair.give);
    for (int j = 0; j < 2; ++j) {
        const vf own = c->p[j].kn * give * held_back(c, &c->p[j], call);
        c->p[j].give = sel(locked, own, c->p[j].give);
    }
}

void PL_WIDE_NAME(pl_contact_prepare_specials)(const pl_contact_call *call, uint32_t first,
                                               uint32_t count)
{
    bundle *bundles = call->bundles;
    special *specials = call->specials;
    for (uint32_t k = first; k < first + count; ++k) {
        bundle *c = &bundles[k];
        special *s = &specials[k];
        body a, b;
        gather_body(&a, call, c->a);
        gather_body(&b, call, c->b);
        *s =
            (special){ .aix = a.inv_mass, .aiy = a.inv_mass, .bix = b.inv_mass, .biy = b.inv_mass };
        s->pull[0] = s->pull[1] = s->reach = splat(0);
        for (int i = 0; i < PL_WIDTH; ++i) {
            uint32_t at = call->lanes[(size_t)k * PL_WIDTH + (size_t)i];
            if (at == PL_NONE) {
                continue;
            }
            const pl_manifold *m = &call->manifolds[at];
            uint32_t fa = call->flags[m->body_a], fb = call->flags[m->body_b];
            s->aix[i] = (fa & PL_BODY_LOCK_X) != 0 ? 0 : s->aix[i];
            s->aiy[i] = (fa & PL_BODY_LOCK_Y) != 0 ? 0 : s->aiy[i];
            s->bix[i] = (fb & PL_BODY_LOCK_X) != 0 ? 0 : s->bix[i];
            s->biy[i] = (fb & PL_BODY_LOCK_Y) != 0 ? 0 : s->biy[i];
            s->reach[i] = pl_adhesion_reach(call->pairs[m->pair].flags);
            for (uint32_t j = 0; j < m->count; ++j) {
                s->pull[j][i] = m->adhesion * call->h / (near_real)m->count;
            }
        }
        lock_rows(c, s, &a, &b, call);
    }
}

//---- fine islands (apart.c): contacts of their own stiffness; impulses of pairs are those of the world's substep ----

// 4 to the power of k / 13, and the last again.
static const near_real stiffer[PL_STIFF_LEVELS] = {
    (near_real)1,         (near_real)1.1125315, (near_real)1.2377263, (near_real)1.3770095,
    (near_real)1.5319664, (near_real)1.7043608, (near_real)1.8961550, (near_real)2.1095322,
    (near_real)2.3469209, (near_real)2.6110234, (near_real)2.9048457, (near_real)3.2317323,
    (near_real)3.5954039, (near_real)4,         (near_real)4
};

// [-] by which a contact of a level is stiffer: of the first and the highest so much, of those between on the way from the one below.
static near_real factor_of(uint32_t level, const pl_fine_clock *clock)
{
    const uint32_t k = level > 2 ? level - 2 : 0;
    const bool rises = level > 1 && level < clock->top;
    return stiffer[k] + (rises ? clock->phase * (stiffer[k + 1] - stiffer[k]) : 0);
}

// [1/s] of the contacts of a bundle.
WIDE_INLINE vf hertz_of(const pl_contact_call *call, const uint32_t *lanes)
{
    vf hertz = splat(call->stiffest);
    for (int i = 0; i < PL_WIDTH; ++i) {
        if (lanes[i] != PL_NONE) {
            const pl_manifold *m = &call->manifolds[lanes[i]];
            const uint32_t level = pl_fine_level(call->pairs[m->pair].flags, m, &call->clock);
            hertz[i] *= factor_of(level, &call->clock);
        }
    }
    return vmin(hertz, splat(call->most));
}

WIDE_INLINE void scale(bundle *c, extra *e, vf factor)
{
    for (int j = 0; j < 2; ++j) {
        c->p[j].ln *= factor;
        c->p[j].lt *= factor;
    }
    if (e != NULL) {
        e->lr *= factor;
    }
}

void PL_WIDE_NAME(pl_contact_prepare_fine)(const pl_contact_call *call, uint32_t first,
                                           uint32_t count)
{
    bundle *bundles = call->bundles;
    extra *extras = call->extras;
    const vf h = splat(call->h), damped = splat(2 * call->damping);
    for (uint32_t k = first; k < first + count; ++k) {
        bundle *c = &bundles[k];
        body a, b;
        gather_body(&a, call, c->a);
        gather_body(&b, call, c->b);
        const vm fixed = (a.inv_mass == splat(0)) | (b.inv_mass == splat(0));
        const vf omega = splat((near_real)6.283185307179586) *
                         hertz_of(call, &call->lanes[(size_t)k * PL_WIDTH]) *
                         sel(fixed, splat(STATIC_STIFFNESS), splat(1));
        const vf a1 = damped + h * omega, give = splat(1) / (h * omega * a1);
        c->bias_rate = omega / a1;
        for (int j = 0; j < 2; ++j) {
            c->p[j].give = c->p[j].kn * give * held_back(c, &c->p[j], call);
        }
        scale(c, extras != NULL ? &extras[k] : NULL, splat(1 / call->finer));
    }
}

void PL_WIDE_NAME(pl_contact_close_fine)(const pl_contact_call *call, uint32_t first,
                                         uint32_t count)
{
    bundle *bundles = call->bundles;
    extra *extras = call->extras;
    for (uint32_t k = first; k < first + count; ++k) {
        scale(&bundles[k], extras != NULL ? &extras[k] : NULL, splat(call->finer));
    }
}

//---- static and kinetic friction ---------------------------------------------------------------------

void PL_WIDE_NAME(pl_contact_prepare_grips)(const pl_contact_call *call, uint32_t first,
                                            uint32_t count)
{
    const bundle *bundles = call->bundles;
    grip *grips = call->grips;
    for (uint32_t k = first; k < first + count; ++k) {
        grip *g = &grips[k];
        g->sticks = g->slides = bundles[k].friction;
        for (int i = 0; i < PL_WIDTH; ++i) {
            const uint32_t at = call->lanes[(size_t)k * PL_WIDTH + (size_t)i];
            if (at != PL_NONE) {
                const pl_grip of = pl_surface_grip(call->world, &call->manifolds[at]);
                g->sticks[i] = of.sticks, g->slides[i] = of.slides;
            }
        }
    }
}

void PL_WIDE_NAME(pl_contact_store_grips)(const pl_contact_call *call, uint32_t first,
                                          uint32_t count)
{
    const bundle *bundles = call->bundles;
    const grip *grips = call->grips;
    for (uint32_t k = first; k < first + count; ++k) {
        const bundle *c = &bundles[k];
        for (int i = 0; i < PL_WIDTH; ++i) {
            const uint32_t at = call->lanes[(size_t)k * PL_WIDTH + (size_t)i];
            if (at != PL_NONE) {
                pl_pair *pair = &call->pairs[call->manifolds[at].pair];
                const bool slides = c->friction[i] < grips[k].sticks[i] &&
                                    (c->p[0].ln[i] != 0 || c->p[1].ln[i] != 0);
                pair->flags = (pair->flags & ~PL_PAIR_SLIDES) | (slides ? PL_PAIR_SLIDES : 0);
            }
        }
    }
}

// Events have to know of what pushed in an earlier substep alone; the others are told by their impulses.
WIDE_INLINE void note_early(const pl_contact_call *call, const bundle *c, const uint32_t *lanes)
{
    const vf zero = splat(0);
    vm early = (c->pushed > zero) & (c->p[0].ln <= zero) & (c->p[1].ln <= zero);
    for (int i = 0; i < PL_WIDTH && any(early); ++i) {
        if (early[i] && lanes[i] != PL_NONE) {
            call->manifolds[lanes[i]].met |= PL_MET_ACTED;
        }
    }
}

void PL_WIDE_NAME(pl_contact_store)(const pl_contact_call *call, uint32_t first, uint32_t count)
{
    const bundle *bundles = call->bundles;
    for (uint32_t k = first; k < first + count; ++k) {
        const bundle *c = &bundles[k];
        note_early(call, c, &call->lanes[(size_t)k * PL_WIDTH]);
        for (int i = 0; i < PL_WIDTH && k + 1 < first + count; ++i) {
            uint32_t at = call->lanes[(size_t)(k + 1) * PL_WIDTH + (size_t)i];
            if (at != PL_NONE) {
                __builtin_prefetch(&call->pairs[call->manifolds[at].pair], 1);
            }
        }
        for (int i = 0; i < PL_WIDTH; ++i) {
            uint32_t at = call->lanes[(size_t)k * PL_WIDTH + (size_t)i];
            if (at != PL_NONE) {
                pl_pair *pair = &call->pairs[call->manifolds[at].pair];
                for (int j = 0; j < 2; ++j) {
                    pair->normal[j] = c->p[j].ln[i];
                    pair->tangent[j] = c->p[j].lt[i];
                }
            }
        }
    }
}

void PL_WIDE_NAME(pl_contact_tally)(const pl_contact_call *call, uint32_t first, uint32_t count)
{
    const bundle *bundles = call->bundles;
    extra *extras = call->extras;
    for (uint32_t k = first; k < first + count; ++k) {
        extras[k].total[0] += bundles[k].p[0].ln;
        extras[k].total[1] += bundles[k].p[1].ln;
        extras[k].rubbed[0] += bundles[k].p[0].lt;
        extras[k].rubbed[1] += bundles[k].p[1].lt;
    }
}

void PL_WIDE_NAME(pl_contact_store_extras)(const pl_contact_call *call, uint32_t first,
                                           uint32_t count)
{
    const extra *extras = call->extras;
    for (uint32_t k = first; k < first + count; ++k) {
        for (int i = 0; i < PL_WIDTH; ++i) {
            uint32_t at = call->lanes[(size_t)k * PL_WIDTH + (size_t)i];
            if (at != PL_NONE) {
                pl_manifold *m = &call->manifolds[at];
                call->pairs[m->pair].rolling = extras[k].lr[i];
                m->point[0].total += extras[k].total[0][i];
                m->point[1].total += extras[k].total[1][i];
                if (call->rubbed != NULL) {
                    call->rubbed[2 * (size_t)at] += extras[k].rubbed[0][i];
                    call->rubbed[2 * (size_t)at + 1] += extras[k].rubbed[1][i];
                }
                if (extras[k].struck[i] > 0) {
                    pl_manifold_strike(m, extras[k].struck[i], extras[k].struck_at[i]);
                }
            }
        }
    }
}
