// prediction.h - which dull impacts (dull.h) can be passed over in a substep, W contacts at a time. Included by
// dull.simd.c only.
//
// In a stirred heap most contacts either stay apart, or lean without being struck. Where that is beyond
// doubt, within the rounding of a real, this tells the contact kernel what doubles would tell it; the
// others are left open. So the answers are those of the doubles, which decide every close case.
//
// With u the velocity before the forces and pushes of the substep and v the present one, a point at
// separation s ends the substep at s + h (u + v) / 2; a contact that carries load is struck only above
// what the forces make of a substep.
//
// Cost: 250 instructions a bundle of 8.
#ifndef PL_PREDICTION_H
#define PL_PREDICTION_H

#include "solver/bundle.h"
#include "solver/dull.h"

// A sum of products of reals is wrong by no more than this share of the sum of their magnitudes.
#define DOUBT (16 * NEAR_EPSILON)

// Of both bodies of each lane: along the normal, its magnitude, and the turns.
typedef struct relative {
    vf along, size, a, b;
} relative;

typedef struct prediction {
    relative place, velocity, before, force;
    vf calm; // [m/s]
} prediction;

// `at`: the first of three rows x, y, turn.
WIDE_INLINE relative relative_of(vf nx, vf ny, const vf *a, const vf *b)
{
    vf x = nx * (b[0] - a[0]), y = ny * (b[1] - a[1]);
    return (relative){ x + y, vabs(x) + vabs(y), a[2], b[2] };
}

// A sum, and by how much it may be wrong.
typedef struct estimate {
    vf value, doubt;
} estimate;

WIDE_INLINE estimate at_point(vf ran, vf rbn, const relative *r)
{
    vf a = ran * r->a, b = rbn * r->b;
    return (estimate){ r->along + b - a, (r->size + vabs(a) + vabs(b)) * splat(DOUBT) };
}

WIDE_INLINE vf larger(vf x, vf y)
{
    return vmax(vabs(x), vabs(y));
}

WIDE_INLINE void look_out(prediction *o, const pl_dull_call *call, const bundle *c)
{
    const vf nx = c->nx, ny = c->ny;
    const near_real *body[2][PL_WIDTH], *motion[2][PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        body[0][i] = &call->bodies[c->a[i]].vx, body[1][i] = &call->bodies[c->b[i]].vx;
        motion[0][i] = &call->motions[c->a[i]].ax, motion[1][i] = &call->motions[c->b[i]].ax;
    }
    vf now[2][8],
        moved[2][8]; // vx vy w inv_mass dx dy da inv_inertia; ax ay aw none ux uy uw inv_mass
    for (int k = 0; k < 2; ++k) {
        gather8(now[k], body[k]);
        gather8(moved[k], motion[k]);
    }
    o->velocity = relative_of(nx, ny, now[0], now[1]);
    o->place = relative_of(nx, ny, now[0] + 4, now[1] + 4);
    o->force = relative_of(nx, ny, moved[0], moved[1]);
    o->before = relative_of(nx, ny, moved[0] + 4, moved[1] + 4);
    // The larger component is no more than the length.
    vf weight = larger(moved[0][0], moved[0][1]) + larger(moved[1][0], moved[1][1]);
    o->calm = splat(4 * call->h * (1 - DOUBT)) * weight;
}

// Whether a point is settled; then the contact kernel is told.
WIDE_INLINE vm look_at_point(const prediction *o, const pl_dull_call *call, vf separation, point *p)
{
    const vf h = splat(call->h), zero = splat(0), ran = p->ran, rbn = p->rbn;
    estimate place = at_point(ran, rbn, &o->place), v = at_point(ran, rbn, &o->velocity);
    estimate u = at_point(ran, rbn, &o->before), force = at_point(ran, rbn, &o->force);
    u.value -= h * force.value;
    u.doubt += h * force.doubt + vabs(u.value) * splat(DOUBT);
    vf way = h * (u.value + v.value) * splat((near_real)0.5);
    vf end = separation + place.value + way;
    vf doubt = place.doubt + h * (u.doubt + v.doubt) +
               (vabs(separation) + vabs(place.value) + vabs(way)) * splat(DOUBT);
    vm clear = end > doubt, crosses = end < -doubt;
    vf fastest = vmax(-v.value, -u.value) + (u.doubt + v.doubt);
    vm leans = crosses & (p->ln > zero) & (fastest <= o->calm);
    vm parts = crosses & (u.value > u.doubt);
    vm present = separation < splat(PL_APART / 2);
    vm off = (p->ln <= zero) & clear;
    vm settled = ~present | clear | leans | parts;
    p->separation =
        sel(present & settled, separation + sel(off, splat(PL_APART), zero), p->separation);
    return settled;
}

// The lanes of a bundle in which nothing is left open.
WIDE_INLINE vm look_at_bundle(const pl_dull_call *call, const near_real *fields, bundle *c)
{
    prediction o;
    look_out(&o, call, c);
    vm settled =
        look_at_point(&o, call, load(fields + PL_PREDICTED_SEPARATION(0) * PL_WIDTH), &c->p[0]);
    return settled &
           look_at_point(&o, call, load(fields + PL_PREDICTED_SEPARATION(1) * PL_WIDTH), &c->p[1]);
}

#endif
