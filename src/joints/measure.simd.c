// measure.simd.c - what the impulses of joints in lanes do, while a world measures itself (step/measure.c). Scalar, in
// double, lane by lane.
//
// Reads: records. Writes: what is measured. Cost: 20 flops a row, on one thread.
#include "joints/lanes.h"

#include "joints/measure.h"
#include "world/measured.h"

static void push_row(const pl_measuring *m, const parts *at, const row *r, int i, double impulse,
                     plumb_work work)
{
    const double x = (double)r->nx[i] * impulse, y = (double)r->ny[i] * impulse;
    pl_measure_push(m, at->a[i], -x, -y, (double)r->wa[i] * impulse, work);
    pl_measure_push(m, at->b[i], x, y, (double)r->wb[i] * impulse, work);
}

static void push_momentum(const pl_measuring *m, const parts *at, const momentum *of, int i,
                          double share_a, double share_b, plumb_work work)
{
    pl_measure_push(m, at->a[i], share_a * (double)of->ax[i], share_a * (double)of->ay[i],
                    share_a * (double)of->aw[i], work);
    pl_measure_push(m, at->b[i], share_b * (double)of->bx[i], share_b * (double)of->by[i],
                    share_b * (double)of->bw[i], work);
}

// As begin_half and move_on of joint.simd.c pay. `old`: before the sweep.
static void push_debt(const pl_measuring *m, const parts *at, const parts *old, int count, int i,
                      plumb_work work)
{
    const bundle *c = at->c;
    const double behind_a = (double)c->behind_a[i], behind_b = (double)c->behind_b[i];
    if (m->debt == PL_DEBT_OPEN) {
        push_momentum(m, at, &c->owed, i, -1, -1, work);
    } else if (m->debt == PL_DEBT_PAID) {
        push_momentum(m, at, &c->owed, i, 1 - behind_a, 1 - behind_b, work);
    } else if (m->debt == PL_DEBT_PAID_BEHIND) {
        momentum due = { .ax = splat(0) };
        push_momentum(m, at, &old->c->owed, i, behind_a, behind_b, work);
        for (int n = 0; n < count; ++n) {
            const row *r = &at->rows[n];
            add_turning(&due, r, &old->rows[n], c->lag * r->start);
        }
        push_momentum(m, at, &due, i, 1, 1, work);
    }
}

void PL_WIDE_NAME(pl_joint_measure)(const pl_joint_call *call, const pl_measuring *m)
{
    pl_joint_call before = *call;
    before.records = (unsigned char *)(uintptr_t)m->kept;
    for (uint32_t k = call->first; k < call->end; ++k) {
        const pl_joint_pattern *p = &call->patterns[call->bundles[k].pattern];
        const pl_joint_lane *lanes = &call->lanes[(size_t)k * PL_WIDTH];
        const parts at = open(call, k, p);
        const parts old = m->kept != NULL ? open(&before, k, p) : at;
        for (int i = 0; i < PL_WIDTH; ++i) {
            if (lanes[i].joint == PL_NONE) {
                continue;
            }
            const plumb_joint_kind kind = call->joints[lanes[i].joint].desc.kind;
            for (int n = 0; n < p->count; ++n) {
                const double was = m->kept != NULL ? (double)old.rows[n].impulse[i] : 0;
                push_row(m, &at, &at.rows[n], i, (double)at.rows[n].impulse[i] - was,
                         pl_joint_work(kind, p->row[n].type, p->row[n].spring != PL_SPRING_NONE));
            }
            push_debt(m, &at, &old, p->count, i,
                      pl_joint_work(kind, p->row[0].type, p->row[0].spring != PL_SPRING_NONE));
        }
    }
}
