// moment.simd.c - contacts whose geometry is that of the moment: made anew behind every motion of the bodies, W at a time.
//
// A manifold is made once a step. Where a body turns or goes round a curve, its normal and anchors soon are those of
// the past: forces lag by half a step, whatever the substeps. What goes on is told by the features: a normal turns with
// the body whose face it is, or it connects the centres of two round features, and the anchors lie on the surfaces along
// it. Core points: on a face the anchor, else the centre of the rounding, R before the surface (a face that bends has
// its centre, too: manifold.h). With X from core to core, each turned by the rotation of its body since the step began,
//     n = X / |X| or the face's,    s = n . X - R_A - R_B.
//
// The substep is that of RATTLE (Andersen 1983): its impulses act half along the normal of its beginning, half along
// that of its end, and relaxing goes by the latter. What the surfaces part in a substep because they bend, h^2 / 2 times
// the second derivative of s, is asked for by the sweep with springs. So a normal that turns takes no energy; made anew and
// no more, it takes the share (turn)^2 / 2 of it in each substep.
//
// Reads: manifolds, pairs, cores, solver bodies. Writes: bundles, velocities, motions. Order: before the sweep with
// springs, and behind the motion. Cost: two gathers a bundle and step; where something turns, two gathers and 80 flops, then
// four, 200 flops and four scatters a substep.
#include "solver/bundle.h"

// [rad] in a step: what turns by less is left as it is. Two points hold a body, and a pile that settles shakes
// by a little; on one point it rolls and tips.
#define LEAST_ON_ONE PL_LEAST_TURN
#define LEAST_ON_TWO ((near_real)2e-3)

// [rad] in a step: what turns by more is left alone, too.
#define MOST ((near_real)0.25)

// [m] centres that are closer give no direction.
#define LEAST_GAP ((near_real)1e-3)

typedef struct vec {
    vf x, y;
} vec;

WIDE_INLINE vf dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y;
}

WIDE_INLINE vec turned(vec v, vec by)
{
    return (vec){ by.x * v.x - by.y * v.y, by.y * v.x + by.x * v.y };
}

WIDE_INLINE vec sel2(vm mask, vec a, vec b)
{
    return (vec){ sel(mask, a.x, b.x), sel(mask, a.y, b.y) };
}

// Cosine and sine of a [rad], of a few terms, set right to a unit vector.
WIDE_INLINE vec rotation_of(vf a)
{
    const vf one = splat(1), q = a * a;
    const near_real of[] = { (near_real)(1.0 / 30), (near_real)(1.0 / 12), (near_real)(1.0 / 2),
                             (near_real)(1.0 / 42), (near_real)(1.0 / 20), (near_real)(1.0 / 6) };
    vf c = one, s = one;
    for (int i = 0; i < 3; ++i) {
        c = one - q * splat(of[i]) * c;
        s = one - q * splat(of[3 + i]) * s;
    }
    s *= a;
    const vf length = vsqrt(c * c + s * s);
    return (vec){ c / length, s / length };
}

// [m/s] of B's core point against A's; arms as they are now.
WIDE_INLINE vec core_velocity(const body *a, const body *b, vec arm_a, vec arm_b)
{
    return (vec){ (b->vx - b->w * arm_b.y) - (a->vx - a->w * arm_a.y),
                  (b->vy + b->w * arm_b.x) - (a->vy + a->w * arm_a.x) };
}

//---- which contacts --------------------------------------------------------------------------------

// What moves fast enough for a closer look, and touches: of pieces that will strike, other features may meet than those of
// the step's beginning.
WIDE_INLINE vm find_fast(const pl_contact_call *call, const bundle *c, const body *a, const body *b)
{
    const vm one = c->p[1].separation > splat(PL_APART / 2);
    const vf least =
        sel(one, splat(LEAST_ON_ONE * call->inv_dt), splat(LEAST_ON_TWO * call->inv_dt));
    const vf way = splat(PL_LEAST_WAY * call->inv_dt);
    const vf vx = b->vx - a->vx, vy = b->vy - a->vy;
    const vm fast =
        (vmax(vabs(a->w), vabs(b->w)) > least) | (one & (vx * vx + vy * vy > way * way));
    const vm touches = vmin(c->p[0].separation, c->p[1].separation) <= splat(PL_AHEAD);
    return fast & (touches | (c->p[0].ln + c->p[1].ln > splat(0)));
}

// How the lanes' contacts go on; returns those of which that is known.
WIDE_INLINE vm find_features(turning *t, const pl_contact_call *call, const uint32_t *lanes,
                             vm fast)
{
    vm known = { 0 };
    near_real radius[2][PL_WIDTH] = { { 0 } };
    t->with_a = t->with_b = (vm){ 0 };
    for (int i = 0; i < PL_WIDTH; ++i) {
        const pl_manifold *m = lanes[i] == PL_NONE ? &no_manifold : &call->manifolds[lanes[i]];
        const uint32_t turns = m->met & PL_MET_TURNS;
        if (!fast[i] || turns == 0) {
            continue;
        }
        const pl_pair *pair = &call->pairs[m->pair];
        if (!pl_can_turn(m, call->kinds[pair->a] <= PL_PIECE_CAPSULE,
                         call->kinds[pair->b] <= PL_PIECE_CAPSULE)) {
            continue;
        }
        const near_real bend = m->count == 1 ? m->point[1].bend : 0;
        const bool on_a = turns == PL_MET_TURNS_A, on_b = turns == PL_MET_TURNS_B;
        known[i] = -1;
        t->with_a[i] = -(pl_lane)(on_a && bend == 0);
        t->with_b[i] = -(pl_lane)(on_b && bend == 0);
        radius[0][i] = t->with_a[i] ? 0 : (near_real)call->cores[pair->a].radius;
        radius[1][i] = t->with_b[i] ? 0 : (near_real)call->cores[pair->b].radius;
        radius[0][i] += on_a && bend != 0 ? 1 / bend : 0;
        radius[1][i] += on_b && bend != 0 ? 1 / bend : 0;
    }
    t->ra = load(radius[0]), t->rb = load(radius[1]);
    return known;
}

WIDE_INLINE void find_cores(turning *t, const pl_contact_call *call, const bundle *c,
                            const uint32_t *lanes)
{
    const near_real *row[2][PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        const pl_manifold *m = lanes[i] == PL_NONE ? &no_manifold : &call->manifolds[lanes[i]];
        row[0][i] = &m->point[0].ax;
        row[1][i] = &m->point[1].ax;
    }
    for (int j = 0; j < 2; ++j) {
        vf r[8];
        gather8(r, row[j]);
        t->ax[j] = r[0] - c->nx * t->ra, t->ay[j] = r[1] - c->ny * t->ra;
        t->bx[j] = r[2] + c->nx * t->rb, t->by[j] = r[3] + c->ny * t->rb;
        t->start[j] = t->separation[j] = r[4];
    }
    t->nx = c->nx, t->ny = c->ny;
}

// Of those, what turns: the normal, or an arm that is none of a body which is round about its centre of mass.
WIDE_INLINE vm find_turning(const turning *t, const pl_contact_call *call, const bundle *c,
                            const body *a, const body *b)
{
    const vf zero = splat(0), tiny = splat((near_real)1e-4), most = splat(MOST * call->inv_dt);
    const vec arm_a = { t->ax[0], t->ay[0] }, arm_b = { t->bx[0], t->by[0] };
    const vec v = core_velocity(a, b, arm_a, arm_b);
    const vf wa = vabs(a->w), wb = vabs(b->w);
    const vf gap = vabs(t->start[0] + t->ra + t->rb), across = vabs(c->nx * v.y - c->ny * v.x);
    const vm round = ~(t->with_a | t->with_b), far = gap > splat(LEAST_GAP);
    vf rate = sel(t->with_a, wa, sel(t->with_b, wb, across / sel(far, gap, splat(1))));
    const vm calm = (wa < most) & (wb < most) & (rate < most);
    rate = vmax(rate, sel(dot(arm_a, arm_a) > tiny * t->ra * t->ra, wa, zero));
    rate = vmax(rate, sel(dot(arm_b, arm_b) > tiny * t->rb * t->rb, wb, zero));
    return calm & (rate > splat(LEAST_ON_ONE * call->inv_dt)) & (far | ~round);
}

void PL_WIDE_NAME(pl_contact_prepare_moment)(const pl_contact_call *call, uint32_t first,
                                             uint32_t count)
{
    const bundle *bundles = call->bundles;
    turning *turnings = call->turnings;
    for (uint32_t k = first; k < first + count; ++k) {
        const bundle *c = &bundles[k];
        const uint32_t *lanes = &call->lanes[(size_t)k * PL_WIDTH];
        turning *t = &turnings[k];
        t->any = false;
        body a, b;
        gather_body(&a, call, c->a);
        gather_body(&b, call, c->b);
        const vm fast = find_fast(call, c, &a, &b);
        if (!any(fast)) {
            continue;
        }
        const vm known = find_features(t, call, lanes, fast);
        if (!any(known)) {
            continue;
        }
        find_cores(t, call, c, lanes);
        t->turns = known & find_turning(t, call, c, &a, &b);
        t->any = any(t->turns);
    }
}

//---- before the sweep with springs -----------------------------------------------------------------

// [m] by which point j closed since the step began, as shortfall() has it.
WIDE_INLINE vf closed(const bundle *c, int j, const body *a, const body *b)
{
    return c->nx * (b->dx - a->dx) + c->ny * (b->dy - a->dy) + c->p[j].rbn * b->da -
           c->p[j].ran * a->da;
}

// [m/s^2] the second derivative of s where nothing acts. The normal turns at `rate`; core points go round the centres of
// mass.
WIDE_INLINE vf parting(const turning *t, const bundle *c, int j, const body *a, const body *b,
                       vec turn_a, vec turn_b)
{
    const vec n = { c->nx, c->ny };
    const vec arm_a = turned((vec){ t->ax[j], t->ay[j] }, turn_a);
    const vec arm_b = turned((vec){ t->bx[j], t->by[j] }, turn_b);
    const vec v = core_velocity(a, b, arm_a, arm_b);
    const vf across = c->nx * v.y - c->ny * v.x, gap = t->separation[j] + t->ra + t->rb;
    const vf of_centres = across / sel(vabs(gap) > splat(0), gap, splat(1));
    const vf rate = sel(t->with_a, a->w, sel(t->with_b, b->w, of_centres));
    return rate * (splat(2) * across - rate * gap) + dot(n, arm_a) * a->w * a->w -
           dot(n, arm_b) * b->w * b->w;
}

// The sweep goes by separations: they become those for which it asks for the speed that is wanted.
void PL_WIDE_NAME(pl_contact_open_moment)(const pl_contact_call *call, uint32_t first,
                                          uint32_t count)
{
    bundle *bundles = call->bundles;
    const turning *turnings = call->turnings;
    const vf zero = splat(0), h = splat(call->h);
    for (uint32_t k = first; k < first + count; ++k) {
        const turning *t = &turnings[k];
        if (!t->any) {
            continue;
        }
        bundle *c = &bundles[k];
        body a, b;
        gather_body(&a, call, c->a);
        gather_body(&b, call, c->b);
        const vec turn_a = rotation_of(a.da), turn_b = rotation_of(b.da);
        for (int j = 0; j < 2; ++j) {
            const vf s = t->separation[j];
            const vf speed = sel(s > zero, s * splat(call->inv_h), s * c->bias_rate) +
                             splat(call->h / 2) * parting(t, c, j, &a, &b, turn_a, turn_b);
            const vf told = sel(speed > zero, speed * h, speed / c->bias_rate);
            const vm here = t->turns & (s < splat(PL_APART / 2));
            c->p[j].separation = sel(here, told - closed(c, j, &a, &b), c->p[j].separation);
        }
    }
}

//---- behind the motion -----------------------------------------------------------------------------

// What both points' impulses do: along x and y, turning A, turning B.
typedef struct given {
    vf x, y, a, b;
} given;

WIDE_INLINE given sum_impulses(const bundle *c)
{
    const point *p = c->p;
    const vf ln = p[0].ln + p[1].ln, lt = p[0].lt + p[1].lt;
    return (given){
        c->nx * ln - c->ny * lt, c->ny * ln + c->nx * lt,
        (p[0].ran * p[0].ln + p[0].rat * p[0].lt) + (p[1].ran * p[1].ln + p[1].rat * p[1].lt),
        (p[0].rbn * p[0].ln + p[0].rbt * p[0].lt) + (p[1].rbn * p[1].ln + p[1].rbt * p[1].lt)
    };
}

// From core to core at point j; `grown`: by how much that has changed since the step began.
WIDE_INLINE vec reach_of(const turning *t, int j, const body *a, const body *b, vec arm_a,
                         vec arm_b, vec *grown)
{
    const vf gap = t->start[j] + t->ra + t->rb;
    *grown = (vec){ (b->dx - a->dx) + ((arm_b.x - t->bx[j]) - (arm_a.x - t->ax[j])),
                    (b->dy - a->dy) + ((arm_b.y - t->by[j]) - (arm_a.y - t->ay[j])) };
    return (vec){ t->nx * gap + grown->x, t->ny * gap + grown->y };
}

// [1/kg] inverse masses of both along a normal (x, y); `s` null: no axis is locked.
WIDE_INLINE vf mass_along(const special *s, const body *a, const body *b, vf x, vf y)
{
    const vf free = a->inv_mass + b->inv_mass;
    return s != NULL ? sel(locked_lanes(s, a, b),
                           (s->aix + s->bix) * x * x + (s->aiy + s->biy) * y * y, free)
                     : free;
}

WIDE_INLINE void set_point(bundle *c, const special *s, int j, vm turns, const body *a,
                           const body *b, vec ra, vec rb)
{
    point *p = &c->p[j];
    const vf mass_n = mass_along(s, a, b, c->nx, c->ny), mass_t = mass_along(s, a, b, c->ny, c->nx);
    p->ran = sel(turns, ra.x * c->ny - ra.y * c->nx, p->ran);
    p->rbn = sel(turns, rb.x * c->ny - rb.y * c->nx, p->rbn);
    p->rat = sel(turns, ra.x * c->nx + ra.y * c->ny, p->rat);
    p->rbt = sel(turns, rb.x * c->nx + rb.y * c->ny, p->rbt);
    const vf kn = mass_n + a->inv_inertia * p->ran * p->ran + b->inv_inertia * p->rbn * p->rbn;
    const vf kt = mass_t + a->inv_inertia * p->rat * p->rat + b->inv_inertia * p->rbt * p->rbt;
    const vm heavy = p->kn > splat(0);
    p->give = sel(turns & heavy, p->give * kn / sel(heavy, p->kn, splat(1)), p->give);
    p->kn = sel(turns, kn, p->kn);
    p->mt = sel(turns, inverse_or_zero(kt), p->mt);
}

// Normal, anchors and separations of now.
WIDE_INLINE void follow(turning *t, bundle *c, const special *s, const body *a, const body *b)
{
    const vf zero = splat(0), one = splat(1);
    const vm turns = t->turns, round = ~(t->with_a | t->with_b);
    const vec turn_a = rotation_of(a->da), turn_b = rotation_of(b->da), start = { t->nx, t->ny };
    vec arm_a[2], arm_b[2], x[2], grown[2];
    for (int j = 0; j < 2; ++j) {
        arm_a[j] = turned((vec){ t->ax[j], t->ay[j] }, turn_a);
        arm_b[j] = turned((vec){ t->bx[j], t->by[j] }, turn_b);
        x[j] = reach_of(t, j, a, b, arm_a[j], arm_b[j], &grown[j]);
    }
    const vf gap = t->start[0] + t->ra + t->rb, length = vsqrt(dot(x[0], x[0]));
    const vf divisor = sel(length > zero, sel(gap < zero, -length, length), one);
    vec n = sel2(t->with_a, turned(start, turn_a), turned(start, turn_b));
    n = sel2(round, (vec){ x[0].x / divisor, x[0].y / divisor }, n);
    n = sel2(turns, n, (vec){ c->nx, c->ny });
    c->nx = n.x, c->ny = n.y;
    for (int j = 0; j < 2; ++j) {
        const vf along = dot(x[j], n);
        // Between centres by what has changed, lest a large radius rounds it off.
        const vf more = dot(grown[j], (vec){ x[0].x + start.x * gap, x[0].y + start.y * gap }) /
                        sel(round, divisor + gap, one);
        const vf apart = sel(round, t->start[j] + more, along - t->ra - t->rb);
        const vec aside = { x[j].x - along * n.x, x[j].y - along * n.y };
        const vec slid_a = sel2(t->with_a, aside, (vec){ zero, zero });
        const vec slid_b = sel2(t->with_b, aside, (vec){ zero, zero });
        // A point that is absent, so far away, would get an arm as long as that, and strike what spins.
        const vm here = turns & (t->start[j] < splat(PL_APART / 2));
        set_point(
            c, s, j, here, a, b,
            (vec){ arm_a[j].x + t->ra * n.x + slid_a.x, arm_a[j].y + t->ra * n.y + slid_a.y },
            (vec){ arm_b[j].x - t->rb * n.x - slid_b.x, arm_b[j].y - t->rb * n.y - slid_b.y });
        t->separation[j] = sel(here, apart, t->separation[j]);
        c->p[j].separation = sel(here, apart - closed(c, j, a, b), c->p[j].separation);
    }
    c->k01 = sel(turns, coupling(c, mass_along(s, a, b, c->nx, c->ny), a, b), c->k01);
}

// The share of kicks that comes behind the drift (halves.c): of two bodies the smaller one, lest momentum be lost where
// the rest is owed at the end of the step.
WIDE_INLINE vf share_of(const pl_contact_call *call, const bundle *c)
{
    near_real share[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        const uint32_t slot[2] = { slot_at(c->a[i]), slot_at(c->b[i]) };
        share[i] = 1;
        for (int k = 0; k < 2; ++k) {
            if (slot[k] < call->dynamic_slots) {
                const near_real behind = pl_kick_behind(call->kicked, slot[k]);
                share[i] = behind < share[i] ? behind : share[i];
            }
        }
    }
    return load(share);
}

// Turns the impulses of a side's body, `ease` [1/kg] along x and y: a share now; all of it in the next substep, whose impulses are the difference of the
// velocity to the one that was integrated.
WIDE_INLINE void turn_side(const pl_contact_call *call, const uint32_t *places, const body *of,
                           vec ease, vf now, vf x, vf y, vf w)
{
    const near_real *from[PL_WIDTH];
    near_real sink[4] __attribute__((aligned(32)));
    near_real *to[PL_WIDTH];
    for (int i = 0; i < PL_WIDTH; ++i) {
        const uint32_t slot = slot_at(places[i]);
        from[i] = &call->motions[slot].ux;
        to[i] = slot < call->dynamic_slots ? &call->motions[slot].ux : sink;
    }
    x *= ease.x, y *= ease.y, w *= of->inv_inertia;
    vf u[4];
    gather4(u, from, 0);
    const vf then = splat(1) - now;
    scatter4(to, 0, (vf[4]){ u[0] - then * x, u[1] - then * y, u[2] - then * w, u[3] });
    body v = *of;
    v.vx += now * x, v.vy += now * y, v.w += now * w;
    scatter_velocity(&v, call, places);
}

void PL_WIDE_NAME(pl_contact_follow_moment)(const pl_contact_call *call, uint32_t first,
                                            uint32_t count)
{
    bundle *bundles = call->bundles;
    turning *turnings = call->turnings;
    const special *specials = call->specials;
    for (uint32_t k = first; k < first + count; ++k) {
        turning *t = &turnings[k];
        if (!t->any) {
            continue;
        }
        bundle *c = &bundles[k];
        body a, b;
        gather_body(&a, call, c->a);
        gather_body(&b, call, c->b);
        const special *s = specials != NULL ? &specials[k] : NULL;
        const given was = sum_impulses(c);
        follow(t, c, s, &a, &b);
        const given is = sum_impulses(c);
        const vf share = share_of(call, c);
        const vec ease_a = s != NULL ? (vec){ s->aix, s->aiy } : (vec){ a.inv_mass, a.inv_mass };
        const vec ease_b = s != NULL ? (vec){ s->bix, s->biy } : (vec){ b.inv_mass, b.inv_mass };
        turn_side(call, c->a, &a, ease_a, share, was.x - is.x, was.y - is.y, was.a - is.a);
        turn_side(call, c->b, &b, ease_b, share, is.x - was.x, is.y - was.y, is.b - was.b);
    }
}
