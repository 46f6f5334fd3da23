// frozen.c - what errors come from contacts that a step makes once: the angle by which they turn while it lasts, and the places
// of blows between round bodies.
//
// Reads: manifolds, pairs, pieces, solver bodies, velocities at the start of the step. Cost: O(contacts), times the hits.
#include "accuracy/dial.h"
#include "solver/solver.h"

#include <math.h>

typedef struct motion {
    double vx, vy, w;
} motion;

static motion motion_of(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    return (motion){ (double)b->vx[row], (double)b->vy[row], (double)b->w[row] };
}

// As the step has left it.
static motion motion_after(const plumb_world *world, uint32_t row)
{
    const uint32_t slot =
        pl_solver_slot(&world->solver, row, world->dynamic_count + world->kinematic_count);
    if (slot == PL_NONE || row >= world->dynamic_count) {
        return motion_of(world, row);
    }
    const pl_solver_body *b = &pl_solver_bodies(&world->solver)[slot];
    return (motion){ (double)b->vx, (double)b->vy, (double)b->w };
}

static bool is_round(const plumb_world *world, uint32_t piece)
{
    return world->pieces.kind[piece] == PL_PIECE_CIRCLE;
}

static bool is_dynamic(const plumb_world *world, uint32_t row)
{
    return row < world->dynamic_count;
}

// [rad] by which the way of a body turns in a step.
static double turn_of_way(const plumb_world *world, uint32_t row, double least)
{
    if (!is_dynamic(world, row)) {
        return 0;
    }
    const motion m = motion_of(world, row);
    const uint32_t slot =
        pl_solver_slot(&world->solver, row, world->dynamic_count + world->kinematic_count);
    if (slot == PL_NONE) {
        return 0;
    }
    const pl_solver_body *body = &pl_solver_bodies(&world->solver)[slot];
    const double dx = (double)body->vx - m.vx, dy = (double)body->vy - m.vy;
    const double square = m.vx * m.vx + m.vy * m.vy;
    return fabs(m.vx * dy - m.vy * dx) / (square > least * least ? square : least * least);
}

// Of a contact that bears: its bodies' ways turn, and what is not round turns about the place where it touches.
static double turn_of(const plumb_world *world, const pl_manifold *m, const pl_pair *pair,
                      double dt, double least)
{
    const double a = turn_of_way(world, m->body_a, least), b = turn_of_way(world, m->body_b, least);
    double turn = a > b ? a : b;
    const double wa = is_round(world, pair->a) ? 0 : fabs(motion_of(world, m->body_a).w);
    const double wb = is_round(world, pair->b) ? 0 : fabs(motion_of(world, m->body_b).w);
    const double w = dt * (wa > wb ? wa : wb);
    return turn > w ? turn : w;
}

// The soft step and the exact solver follow some contacts (solver/moment.simd.c, exact/moment.c).
static bool follows(const plumb_world *world, const pl_manifold *m, const pl_pair *pair)
{
    return world->desc.solver != PLUMB_SOLVER_PGS &&
           pl_can_turn(m, world->pieces.kind[pair->a] <= PL_PIECE_CAPSULE,
                       world->pieces.kind[pair->b] <= PL_PIECE_CAPSULE);
}

static bool was_hit(const plumb_world *world, const pl_manifold *m)
{
    return (pl_pair_of(world, m)->flags & PL_PAIR_HIT) != 0;
}

// Whether a body of a manifold was struck elsewhere, too, in the step.
static bool is_struck_twice(const plumb_world *world, const pl_manifold *m)
{
    const pl_manifold *other = pl_manifolds(&world->narrow);
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i, ++other) {
        if (other == m || !was_hit(world, other)) {
            continue;
        }
        const uint32_t a = other->body_a, b = other->body_b;
        if ((is_dynamic(world, m->body_a) && (a == m->body_a || b == m->body_a)) ||
            (is_dynamic(world, m->body_b) && (a == m->body_b || b == m->body_b))) {
            return true;
        }
    }
    return false;
}

// [rad] by which the direction of a blow between round bodies is off. Those that bounce are struck at the moment at which they
// meet (narrow/toi.c), and once more along the way that they take from there; what is third in a step is not.
static double graze_of(const plumb_world *world, const pl_manifold *m, const pl_pair *pair)
{
    if (!is_round(world, pair->a) || !is_round(world, pair->b) ||
        (m->restitution > 0 && !is_struck_twice(world, m))) {
        return 0;
    }
    motion a = motion_of(world, m->body_a), b = motion_of(world, m->body_b);
    // What they had when the second blow came is not known: as it left them.
    if (m->restitution > 0) {
        a = motion_after(world, m->body_a), b = motion_after(world, m->body_b);
    }
    const double nx = (double)m->nx, ny = (double)m->ny, x = b.vx - a.vx, y = b.vy - a.vy;
    const double along = fabs(x * nx + y * ny), across = fabs(y * nx - x * ny);
    const double reach =
        (double)world->bodies.extent[m->body_a] + (double)world->bodies.extent[m->body_b];
    // Of what was slow, the other one has come to it in this step: it is in the next one's error.
    const double part = along > across ? across / along : 1;
    const double share = sqrt(x * x + y * y) / (world->dial.speed > 0 ? world->dial.speed : 1);
    return reach > 0 ? pl_dial_constants.graze * part / reach * (share < 1 ? share : 1) : 0;
}

double pl_dial_frozen(const plumb_world *world, double dt)
{
    const pl_manifold *m = pl_manifolds(&world->narrow);
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    const double slow = world->dial.speed / 10, start = 4 * world->dial.push * dt;
    const double least = slow > start ? slow : start; // [m/s] slower ways count little
    double most = 0, grazed = 0;
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i, ++m) {
        const pl_pair *pair = &pairs[m->pair];
        const bool bears = pair->normal[0] > 0 || pair->normal[1] > 0;
        if (was_hit(world, m)) {
            const double graze = graze_of(world, m, pair);
            grazed = graze > grazed ? graze : grazed;
        } else if (bears && !follows(world, m, pair)) {
            const double turn = turn_of(world, m, pair, dt, least);
            most = turn > most ? turn : most;
        }
    }
    return pl_dial_constants.frozen * most * most + grazed;
}
