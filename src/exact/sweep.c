// sweep.c - a solution that missed and has gained energy is none: sweeps over the rows in its place, there and back.
//
// Velocities that obey the rows are, of all that do, the nearest to those of the start, by kinetic energy: impulses add no more of it
// than what rows strive for, and what is driven, asks. In sweeps a row takes the impulse that undoes what it lacks at the velocities of the moment, within its bounds; friction those that the load
// of the moment allows (Gauss-Seidel with projection). What is to come to rest loses energy in each row, so a sweep throws
// nothing, however far it is from a solution.
//
// Reads: rows, velocities. Writes: velocities, impulses. Cost: O(rows) a sweep.
#include "exact/exact.h"
#include "math/compare.h"

#include <string.h>

#define SWEEPS 30
#define SPARE  1e-3 // of the energy, of rounding

//---- energy --------------------------------------------------------------------------------------------

static double kinetic_energy(const pl_exact_system *s, const double *velocity)
{
    double sum = 0;
    for (uint32_t i = s->island->first_node; i < s->island->end_node; ++i) {
        for (uint32_t c = 0; c < 3; ++c) {
            const double m = s->nodes[i].inv_mass[c], v = velocity[3 * i + c];
            sum += m > 0 ? v * v / (2 * m) : 0;
        }
    }
    return sum;
}

// [m/s] along the row, of its ends that move as they like.
static double drive_of(const pl_exact_system *s, const pl_exact_row *r)
{
    double sum = 0;
    for (int end = 0; end < 2; ++end) {
        const pl_solver_body *b = &pl_solver_bodies(&s->world->solver)[r->item->slot[end]];
        const double *j = r->j + 3 * end;
        if (r->item->node[end] == PL_NONE) {
            sum += fabs(j[0] * (double)b->vx + j[1] * (double)b->vy + j[2] * (double)b->w);
        }
    }
    return sum;
}

bool pl_exact_has_gained(const pl_exact_system *s)
{
    double given = 0;
    for (uint32_t k = s->island->first_row; k < s->island->end_row; ++k) {
        const pl_exact_row *r = &s->rows[k];
        if (r->in_force) {
            const double work = r->next * r->target;
            given += pl_greater(work, 0) + fabs(r->next) * drive_of(s, r);
        }
    }
    const double before = kinetic_energy(s, s->base);
    return kinetic_energy(s, s->velocity) > (1 + SPARE) * (before + given);
}

//---- sweeps --------------------------------------------------------------------------------------------

static double load_of(const pl_exact_system *s, const pl_exact_row *r)
{
    double load = 0;
    for (uint32_t l = r->lead; l < r->lead + r->leads; ++l) {
        load += s->rows[l].next - s->rows[l].low;
    }
    return pl_greater(load, 0);
}

// Impulse that the row may have, nearest to `wish`.
static double bounded(const pl_exact_system *s, const pl_exact_row *r, double wish)
{
    const double most = r->leads > 0 ? r->factor * load_of(s, r) : 0;
    const double low = r->leads > 0 ? r->low - most : r->low;
    const double high = r->leads > 0 ? r->low + most : r->high;
    return pl_lesser(pl_greater(wish, low), high);
}

static void sweep_row(const pl_exact_system *s, pl_exact_row *r)
{
    if (!r->in_force) {
        return;
    }
    const double lack = r->target - pl_exact_rate(s, r, s->velocity) - r->give * r->next;
    const double next = bounded(s, r, r->next + lack * r->mass / (1 + r->give * r->mass));
    pl_exact_push(s, r, s->velocity, next - r->next);
    r->next = next;
}

void pl_exact_sweep(const pl_exact_system *s)
{
    const pl_exact_island *island = s->island;
    const size_t first = 3 * (size_t)island->first_node, end = 3 * (size_t)island->end_node;
    memcpy(s->velocity + first, s->base + first, (end - first) * sizeof(double));
    for (uint32_t k = island->first_row; k < island->end_row; ++k) {
        s->rows[k].next = 0;
    }
    for (int i = 0; i < SWEEPS; i += 2) {
        for (uint32_t k = island->first_row; k < island->end_row; ++k) {
            sweep_row(s, &s->rows[k]);
        }
        for (uint32_t k = island->end_row; k-- > island->first_row;) {
            sweep_row(s, &s->rows[k]);
        }
    }
    for (uint32_t k = island->first_row; k < island->end_row; ++k) {
        s->rows[k].impulse = s->rows[k].next;
    }
}
