// measure.c - contacts of the classic solver, while a world measures itself: as measure.simd.c.
//
// Reads: contacts, solver bodies. Writes: what is measured. Cost: 50 flops a contact.
#include "solver/measure.h"

#include "world/measured.h"
#include "world/state.h"

#include <math.h>

static void push_point(const pl_measuring *m, const pl_classic_contact *c,
                       const pl_classic_point *p, double ln, double lt)
{
    const double nx = (double)c->nx, ny = (double)c->ny;
    pl_measure_push(m, c->a, -nx * ln, -ny * ln, -(double)p->ran * ln, PLUMB_WORK_NORMAL);
    pl_measure_push(m, c->b, nx * ln, ny * ln, (double)p->rbn * ln, PLUMB_WORK_NORMAL);
    pl_measure_push(m, c->a, ny * lt, -nx * lt, -(double)p->rat * lt, PLUMB_WORK_FRICTION);
    pl_measure_push(m, c->b, -ny * lt, nx * lt, (double)p->rbt * lt, PLUMB_WORK_FRICTION);
}

void pl_classic_measure(const plumb_world *world, const pl_classic_contact *kept, pl_measuring *m)
{
    const pl_classic_contact *contacts = world->solver.classic.data;
    for (uint32_t i = 0; i < pl_classic_count(&world->solver, world->narrow.manifold_count); ++i) {
        const pl_classic_contact *c = &contacts[i];
        for (uint32_t j = 0; j < c->count; ++j) {
            const pl_classic_point *p = &c->point[j];
            push_point(m, c, p, (double)p->ln - (kept ? (double)kept[i].point[j].ln : 0),
                       (double)p->lt - (kept ? (double)kept[i].point[j].lt : 0));
        }
        const double lr = (double)c->lr - (kept ? (double)kept[i].lr : 0);
        pl_measure_push(m, c->a, 0, 0, -lr, PLUMB_WORK_FRICTION);
        pl_measure_push(m, c->b, 0, 0, lr, PLUMB_WORK_FRICTION);
    }
}

void pl_classic_residual(const plumb_world *world, pl_measuring *m)
{
    const pl_classic_contact *contacts = world->solver.classic.data;
    const pl_solver_body *bodies = pl_solver_bodies(&world->solver);
    for (uint32_t i = 0; i < pl_classic_count(&world->solver, world->narrow.manifold_count); ++i) {
        const pl_classic_contact *c = &contacts[i];
        const pl_solver_body *a = &bodies[c->a], *b = &bodies[c->b];
        const double nx = (double)c->nx, ny = (double)c->ny;
        for (uint32_t j = 0; j < c->count; ++j) {
            const pl_classic_point *p = &c->point[j];
            const double apart = (double)p->separation + nx * (double)(b->dx - a->dx) +
                                 ny * (double)(b->dy - a->dy) + (double)(p->rbn * b->da) -
                                 (double)(p->ran * a->da);
            const double speed = nx * (double)(b->vx - a->vx) + ny * (double)(b->vy - a->vy) +
                                 (double)(p->rbn * b->w) - (double)(p->ran * a->w);
            const bool sticks = apart < (double)c->reach;
            const double ln = (double)p->ln + (sticks ? (double)c->pull : 0);
            pl_measure_most(&m->gap, -apart);
            pl_measure_most(&m->approach, apart <= 0 || ln > 0 ? -speed : 0);
            pl_measure_most(&m->complementarity, apart > 0 && !sticks ? ln * apart : 0);
            pl_measure_most(&m->cone, fabs((double)p->lt) - (double)c->bore * ln);
        }
    }
}
