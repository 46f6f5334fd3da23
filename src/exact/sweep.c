// sweep.c - sweeps over the rows of an island, there and back: they bring Newton's rounds near a solution of friction against friction
// (newton.c), and take the place of one that has gained energy.
//
// A row takes the impulse that undoes what it lacks at the velocities of the moment, within its bounds; friction those that the load
// of the moment allows (Gauss-Seidel with projection). A pass costs a fifth of a factor, follows the law of friction itself, and is soon
// right about what lies near; what goes through many contacts it is slow to learn, and that is what Newton's steps are quick at.
//
// Velocities that obey the rows are, of all that do, the nearest to those of the start, by kinetic energy: impulses add no more of it
// than what rows strive for, and what is driven, asks. From no impulses at all, what is to come to rest loses energy in each row, so
// such sweeps throw nothing, however far from a solution.
//
// Reads: rows, velocities. Writes: velocities, impulses. Cost: O(rows) a sweep.
#include "exact/exact.h"
#include "math/compare.h"

#include <math.h>

#define SPARE 1e-3 // of the energy, of rounding

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
        sum += r->item->node[end] == PL_NONE ? fabs(pl_exact_driven(s, r, end)) : 0;
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

// What the ends that move have of the row; `at`: where their velocities begin.
static void gather_end(const pl_exact_system *s, const pl_exact_row *r, int end,
                       pl_exact_swept_row *out)
{
    const uint32_t node = r->item->node[end];
    if (node == PL_NONE) {
        out->target -= pl_exact_driven(s, r, end);
        return;
    }
    const double *j = r->j + 3 * end;
    out->at[end] = 3 * node;
    for (int c = 0; c < 3; ++c) {
        out->j[3 * end + c] = j[c];
        out->push[3 * end + c] = s->nodes[node].inv_mass[c] * j[c];
    }
}

// A row that is not in force loads nothing and takes nothing.
static pl_exact_swept_row gather(const pl_exact_system *s, const pl_exact_row *r)
{
    const uint32_t anywhere = 3 * s->island->first_node; // where an end that is driven gets nothing
    pl_exact_swept_row out = { .at = { anywhere, anywhere } };
    if (r->in_force) {
        out.target = r->target;
        out.give = r->give;
        out.gain = r->mass / (1 + r->give * r->mass);
        out.low = r->low, out.high = r->high;
        out.factor = r->factor;
        out.impulse = r->impulse;
        out.lead = r->lead - s->island->first_row;
        out.leads = r->leads;
        gather_end(s, r, 0, &out);
        gather_end(s, r, 1, &out);
    }
    return out;
}

static double load_of(const pl_exact_swept_row *rows, const pl_exact_swept_row *r)
{
    double load = 0;
    for (uint32_t l = r->lead; l < r->lead + r->leads; ++l) {
        load += rows[l].impulse - rows[l].low;
    }
    return pl_greater(load, 0);
}

// The impulse nearest to what undoes all that the row lacks, of those that it may have.
static void sweep_row(const pl_exact_swept_row *rows, pl_exact_swept_row *r, double *velocity)
{
    double *a = velocity + r->at[0], *b = velocity + r->at[1];
    const double *j = r->j, *push = r->push;
    const double rate =
        j[0] * a[0] + j[1] * a[1] + j[2] * a[2] + j[3] * b[0] + j[4] * b[1] + j[5] * b[2];
    const double wish = r->impulse + (r->target - rate - r->give * r->impulse) * r->gain;
    const double most = r->leads > 0 ? r->factor * load_of(rows, r) : 0;
    const double low = r->leads > 0 ? r->low - most : r->low;
    const double high = r->leads > 0 ? r->low + most : r->high;
    const double next = pl_lesser(pl_greater(wish, low), high), change = next - r->impulse;
    a[0] += push[0] * change, a[1] += push[1] * change, a[2] += push[2] * change;
    b[0] += push[3] * change, b[1] += push[4] * change, b[2] += push[5] * change;
    r->impulse = next;
}

void pl_exact_sweep(const pl_exact_system *s, int count)
{
    const uint32_t first_row = s->island->first_row, rows = s->island->end_row - first_row;
    pl_exact_swept_row *swept = s->exact->swept.data;
    pl_exact_follow(s);
    for (uint32_t k = 0; k < rows; ++k) {
        swept[k] = gather(s, &s->rows[first_row + k]);
    }
    for (int i = 0; i < count; i += 2) {
        for (uint32_t k = 0; k < rows; ++k) {
            sweep_row(swept, &swept[k], s->velocity);
        }
        for (uint32_t k = rows; k-- > 0;) {
            sweep_row(swept, &swept[k], s->velocity);
        }
    }
    for (uint32_t k = 0; k < rows; ++k) {
        s->rows[first_row + k].impulse = s->rows[first_row + k].next = swept[k].impulse;
    }
}
