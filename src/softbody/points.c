// points.c - points and the unknowns that they follow: a node its own, what a body holds the body's three.
//
// Reads: points, bodies, u. Writes: the matrix and its right side; what u adds to points. Cost: O(1) an element.
#include "softbody/softbody.h"

static const pl_soft_body *holder_of(const pl_soft_step *s, const pl_soft_point *p)
{
    return p->body == PL_NONE ? NULL : pl_soft_bodies(s) + p->body;
}

void pl_soft_follow(const pl_soft_step *s, const pl_soft_point *p, double j[6])
{
    const pl_soft_body *b = holder_of(s, p);
    j[0] = b == NULL ? 1 : b->locked_x, j[1] = 0, j[2] = b == NULL ? 0 : -p->ry * b->locked_w;
    j[3] = 0, j[4] = b == NULL ? 1 : b->locked_y, j[5] = b == NULL ? 0 : p->rx * b->locked_w;
}

// to += scale ja' k jb.
static void add_block(double *to, const double ja[6], const double jb[6], const double k[4])
{
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            to[3 * r + c] += ja[r] * (k[0] * jb[c] + k[1] * jb[3 + c]) +
                             ja[3 + r] * (k[2] * jb[c] + k[3] * jb[3 + c]);
        }
    }
}

static void add_plain(double *to, const double k[4])
{
    to[0] += k[0], to[1] += k[1], to[3] += k[2], to[4] += k[3];
}

void pl_soft_add(const pl_soft_step *s, uint32_t a, uint32_t b, const double k[4])
{
    const pl_soft_matrix *m = &s->matrix;
    const pl_soft_point *pa = pl_soft_point_at(s, a), *pb = pl_soft_point_at(s, b);
    if (pa->block == PL_NONE || pb->block == PL_NONE) {
        return;
    }
    const double turned[4] = { k[0], k[2], k[1], k[3] };
    double ja[6], jb[6];
    if (pa->body == PL_NONE && pb->body == PL_NONE) {
        add_plain(a == b                  ? m->diagonal + 9 * (size_t)pa->block
                  : pa->block > pb->block ? pl_soft_entry(m, pa->block, pb->block)
                                          : pl_soft_entry(m, pb->block, pa->block),
                  pa->block >= pb->block ? k : turned);
        return;
    }
    pl_soft_follow(s, pa, ja);
    pl_soft_follow(s, pb, jb);
    if (pa->block == pb->block) {
        double *to = m->diagonal + 9 * (size_t)pa->block;
        add_block(to, ja, jb, k);
        if (a != b) {
            add_block(to, jb, ja, turned);
        }
    } else if (pa->block > pb->block) {
        add_block(pl_soft_entry(m, pa->block, pb->block), ja, jb, k);
    } else {
        add_block(pl_soft_entry(m, pb->block, pa->block), jb, ja, turned);
    }
}

void pl_soft_push(const pl_soft_step *s, uint32_t point, double x, double y)
{
    const pl_soft_point *p = pl_soft_point_at(s, point);
    if (p->block == PL_NONE) {
        return;
    }
    double *to = s->matrix.right + 3 * (size_t)p->block;
    const pl_soft_body *b = holder_of(s, p);
    to[0] += b == NULL ? x : x * b->locked_x;
    to[1] += b == NULL ? y : y * b->locked_y;
    to[2] += b == NULL ? 0 : (p->rx * y - p->ry * x) * b->locked_w;
}

void pl_soft_change(const pl_soft_step *s, uint32_t first, uint32_t count)
{
    pl_soft_point *points = pl_soft_points(s);
    for (uint32_t i = first; i < first + count; ++i) {
        pl_soft_point *p = &points[i];
        const double *u = s->matrix.u + (p->block == PL_NONE ? 0 : 3 * (size_t)p->block);
        if (p->block == PL_NONE) {
            p->cx = p->cy = 0;
        } else if (p->body == PL_NONE) {
            p->cx = u[0], p->cy = u[1];
        } else {
            const pl_soft_body *b = holder_of(s, p);
            p->cx = u[0] * b->locked_x - u[2] * b->locked_w * p->ry;
            p->cy = u[1] * b->locked_y + u[2] * b->locked_w * p->rx;
        }
    }
}
