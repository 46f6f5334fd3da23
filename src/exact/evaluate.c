// evaluate.c - which impulses follow from velocities, row by row, and what is left of the law of momentum.
//
// A row by itself is clamped, friction to what the load before it allows (Alart and Curnier 1991); or, convex, points with
// friction are projected onto their cones (De Saxce and Feng 1998). newton.c says when which.
//
// Reads: rows, velocities. Writes: rows, `change`. Cost: O(rows).
#include "exact/exact.h"

#include <math.h>

#define EPSILON 1e-15 // of J v, in rounding

// What J v adds up: its rounding is a share of that.
double pl_exact_sum(const pl_exact_system *s, const pl_exact_row *r)
{
    double sum = 0;
    for (int end = 0; end < 2; ++end) {
        const uint32_t node = r->item->node[end];
        for (int c = 0; node != PL_NONE && c < 3; ++c) {
            sum += fabs(r->j[3 * end + c] * s->velocity[3 * (size_t)node + (size_t)c]);
        }
    }
    return sum;
}

void pl_exact_push(const pl_exact_system *s, const pl_exact_row *r, double *velocity,
                   double impulse)
{
    for (int end = 0; end < 2; ++end) {
        const uint32_t node = r->item->node[end];
        for (int c = 0; node != PL_NONE && c < 3; ++c) {
            velocity[3 * node + (uint32_t)c] +=
                s->nodes[node].inv_mass[c] * r->j[3 * end + c] * impulse;
        }
    }
}

void pl_exact_push_all(const pl_exact_system *s, double share)
{
    for (uint32_t k = s->island->first_row; k < s->island->end_row; ++k) {
        const pl_exact_row *r = &s->rows[k];
        if (r->in_force) {
            pl_exact_push(s, r, s->velocity, share * r->impulse);
        }
    }
}

void pl_exact_follow(const pl_exact_system *s)
{
    pl_exact_copy(s, s->velocity, s->base);
    pl_exact_push_all(s, 1);
}

double pl_exact_driven(const pl_exact_system *s, const pl_exact_row *r, int end)
{
    const pl_solver_body *b = &pl_solver_bodies(&s->world->solver)[r->item->slot[end]];
    const double *j = r->j + 3 * end;
    return j[0] * (double)b->vx + j[1] * (double)b->vy + j[2] * (double)b->w;
}

double pl_exact_rate(const pl_exact_system *s, const pl_exact_row *r, const double *velocity)
{
    double sum = 0;
    for (int end = 0; end < 2; ++end) {
        const uint32_t node = r->item->node[end];
        if (node != PL_NONE) {
            const double *v = velocity + 3 * (size_t)node, *j = r->j + 3 * end;
            sum += j[0] * v[0] + j[1] * v[1] + j[2] * v[2];
        } else {
            sum += pl_exact_driven(s, r, end);
        }
    }
    return sum;
}

// Impulse that the row would have without bounds.
static double wish_of(const pl_exact_newton *n, const pl_exact_row *r, double stiffness)
{
    const double trace = 1 / stiffness;
    return (r->impulse * trace + r->target - pl_exact_rate(n->s, r, n->s->velocity)) /
           (r->give + trace);
}

static void bound(pl_exact_row *r, double wish, double low, double high, double weight)
{
    r->weight = wish > low && wish < high ? weight : 0;
    r->next = wish < low ? low : wish > high ? high : wish;
}

// [N s] that bounds friction or rolling resistance.
static double load_of(const pl_exact_newton *n, const pl_exact_row *r)
{
    double load = 0;
    for (uint32_t l = r->lead; l < r->lead + r->leads; ++l) {
        const pl_exact_row *lead = &n->s->rows[l];
        load += (n->convex ? lead->impulse : lead->next) - lead->low;
    }
    return load > 0 ? load : 0;
}

// A row as it is by itself, or with the loads before it.
static void evaluate_row(const pl_exact_newton *n, pl_exact_row *r)
{
    const double stiffness = n->stiffness * r->mass;
    const double weight = 1 / (r->give + 1 / stiffness), wish = wish_of(n, r, stiffness);
    const double most = r->leads > 0 ? r->factor * load_of(n, r) : 0;
    bound(r, wish, r->leads > 0 ? r->low - most : r->low, r->leads > 0 ? r->low + most : r->high,
          weight);
    r->slope = 0;
    if (r->leads > 0 && r->weight == 0 && !n->convex) {
        r->slope = wish > 0 ? r->factor : -r->factor;
    }
}

// A point with friction as a cone: impulses are projected onto it, along both rows. What slides would be lifted by
// factor x slip; the slip of the start of the round is taken from what the normal is to do.
static void evaluate_cone(const pl_exact_newton *n, pl_exact_row *normal, pl_exact_row *tangent)
{
    const double stiffness = n->stiffness * normal->mass, mu = tangent->factor;
    const double wish = wish_of(n, normal, stiffness) - stiffness * tangent->shift - normal->low;
    const double aside = wish_of(n, tangent, stiffness) - tangent->low, side = aside < 0 ? -1 : 1;
    normal->slope = tangent->slope = 0;
    normal->weight = tangent->weight = stiffness;
    if (side * aside <= mu * wish) {
        normal->next = wish + normal->low;
        tangent->next = aside + tangent->low;
    } else if (wish <= -mu * side * aside) {
        normal->next = normal->low;
        tangent->next = tangent->low;
        normal->weight = tangent->weight = 0;
    } else {
        const double load = (wish + mu * side * aside) / (1 + mu * mu);
        normal->next = load + normal->low;
        tangent->next = side * mu * load + tangent->low;
        normal->weight = 0;
        tangent->weight = stiffness / (1 + mu * mu);
        tangent->slope = side * mu;
    }
}

static void evaluate(const pl_exact_newton *n, pl_exact_row *r)
{
    if (n->convex && r->cone) {
        evaluate_cone(n, &n->s->rows[r->lead], r);
    } else {
        evaluate_row(n, r);
    }
}

// F into `change`; its size, by momentum.
double pl_exact_evaluate(pl_exact_newton *n)
{
    n->noise = 0;
    const pl_exact_system *s = n->s;
    const pl_exact_island *island = s->island;
    for (uint32_t k = island->first_row; k < island->end_row; ++k) {
        if (s->rows[k].in_force) {
            evaluate(n, &s->rows[k]);
        }
    }
    for (uint32_t k = 3 * island->first_node; k < 3 * island->end_node; ++k) {
        s->change[k] = s->velocity[k] - s->base[k];
    }
    for (uint32_t k = island->first_row; k < island->end_row; ++k) {
        const pl_exact_row *r = &s->rows[k];
        if (r->in_force) {
            const double blur = EPSILON * r->weight * pl_exact_sum(s, r);
            n->noise += blur * blur / r->mass;
            pl_exact_push(s, r, s->change, -r->next);
        }
    }
    double size = 0;
    for (uint32_t i = island->first_node; i < island->end_node; ++i) {
        for (uint32_t c = 0; c < 3; ++c) {
            const double x = s->change[3 * i + c], m = s->nodes[i].inv_mass[c];
            size += m > 0 ? x * x / m : 0;
        }
    }
    return size;
}
