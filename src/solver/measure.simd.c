// measure.simd.c - what the impulses of contacts do, and what they leave of the law of contacts: while a world measures
// itself (step/measure.c). Scalar, in double, lane by lane: for numbers, not for speed.
//
// Reads: bundles, solver bodies. Writes: what is measured. Cost: 50 flops a contact, on one thread.
#include "solver/bundle.h"
#include "world/measured.h"

// Impulses of a point along n and t, and of rolling.
static void push_point(const pl_measuring *m, const bundle *c, const point *p, int i, double ln,
                       double lt)
{
    const double nx = (double)c->nx[i], ny = (double)c->ny[i];
    pl_measure_push(m, slot_at(c->a[i]), -nx * ln, -ny * ln, -(double)p->ran[i] * ln,
                    PLUMB_WORK_NORMAL);
    pl_measure_push(m, slot_at(c->b[i]), nx * ln, ny * ln, (double)p->rbn[i] * ln,
                    PLUMB_WORK_NORMAL);
    pl_measure_push(m, slot_at(c->a[i]), ny * lt, -nx * lt, -(double)p->rat[i] * lt,
                    PLUMB_WORK_FRICTION);
    pl_measure_push(m, slot_at(c->b[i]), -ny * lt, nx * lt, (double)p->rbt[i] * lt,
                    PLUMB_WORK_FRICTION);
}

void PL_WIDE_NAME(pl_contact_measure)(const pl_contact_call *call, uint32_t first, uint32_t count,
                                      pl_measuring *m)
{
    const bundle *bundles = call->bundles, *kept = m->kept;
    const extra *extras = call->extras, *kept_extras = m->kept_extras;
    for (uint32_t k = first; k < first + count; ++k) {
        const bundle *c = &bundles[k], *old = kept != NULL ? &kept[k] : NULL;
        for (int i = 0; i < PL_WIDTH; ++i) {
            for (int j = 0; j < 2; ++j) {
                const double ln = old != NULL ? (double)old->p[j].ln[i] : 0;
                const double lt = old != NULL ? (double)old->p[j].lt[i] : 0;
                push_point(m, c, &c->p[j], i, (double)c->p[j].ln[i] - ln,
                           (double)c->p[j].lt[i] - lt);
            }
            if (extras != NULL) {
                const double lr = (double)extras[k].lr[i] -
                                  (kept_extras != NULL ? (double)kept_extras[k].lr[i] : 0);
                pl_measure_push(m, slot_at(c->a[i]), 0, 0, -lr, PLUMB_WORK_FRICTION);
                pl_measure_push(m, slot_at(c->b[i]), 0, 0, lr, PLUMB_WORK_FRICTION);
            }
        }
    }
}

static void look_at_point(pl_measuring *m, const pl_contact_call *call, const bundle *c,
                          const special *s, int i, int j)
{
    const point *p = &c->p[j];
    const pl_solver_body *a = &call->bodies[slot_at(c->a[i])], *b = &call->bodies[slot_at(c->b[i])];
    const double nx = (double)c->nx[i], ny = (double)c->ny[i];
    const double ran = (double)p->ran[i], rbn = (double)p->rbn[i];
    const double apart = (double)p->separation[i] + nx * (double)(b->dx - a->dx) +
                         ny * (double)(b->dy - a->dy) + rbn * (double)b->da - ran * (double)a->da;
    const double speed = nx * (double)(b->vx - a->vx) + ny * (double)(b->vy - a->vy) +
                         rbn * (double)b->w - ran * (double)a->w;
    const bool sticks = s != NULL && apart < (double)s->reach[i];
    const double ln = (double)p->ln[i] + (sticks ? (double)s->pull[j][i] : 0);
    pl_measure_most(&m->gap, -apart);
    if (apart <= 0 || ln > 0) {
        pl_measure_most(&m->approach, -speed);
    }
    pl_measure_most(&m->complementarity, apart > 0 && !sticks ? ln * apart : 0);
    const double slid = (double)p->lt[i];
    pl_measure_most(&m->cone, (slid < 0 ? -slid : slid) - (double)c->friction[i] * ln);
}

void PL_WIDE_NAME(pl_contact_residual)(const pl_contact_call *call, uint32_t first, uint32_t count,
                                       pl_measuring *m)
{
    const bundle *bundles = call->bundles;
    const special *specials = call->specials;
    for (uint32_t k = first; k < first + count; ++k) {
        for (int i = 0; i < PL_WIDTH; ++i) {
            if (call->lanes[(size_t)k * PL_WIDTH + (size_t)i] == PL_NONE) {
                continue;
            }
            look_at_point(m, call, &bundles[k], specials != NULL ? &specials[k] : NULL, i, 0);
            look_at_point(m, call, &bundles[k], specials != NULL ? &specials[k] : NULL, i, 1);
        }
    }
}
