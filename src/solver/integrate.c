// integrate.c - positions from velocities, for the classic and the exact solver, and of kinematic bodies for all.
//
// Free flight is exact: a body that no contact pushed in the substep (its velocity is the one that was
// integrated, bit for bit) moves by h v - h^2 a / 2, the parabola. A pushed body moves by h v; the parabola
// would make resting bodies hop. Cost: O(bodies in contacts) a substep.
#include "effects/effects.h"
#include "solver/substep.h"
#include "world/state.h"

// Moves dynamic and kinematic bodies by the velocities with which the substep's contacts left them.
static void move(void *context, uint32_t first, uint32_t count)
{
    const pl_passage *p = context;
    const near_real h = p->h, half = h * h / 2;
    pl_solver_body *body = pl_solver_bodies(&p->world->solver) + p->first;
    const pl_solver_motion *motion = pl_solver_motions(&p->world->solver) + p->first;
    for (uint32_t i = first; i < first + count; ++i) {
        bool free =
            body[i].vx == motion[i].ux && body[i].vy == motion[i].uy && body[i].w == motion[i].uw;
        near_real back = free ? half : 0;
        body[i].dx += h * body[i].vx - back * motion[i].ax;
        body[i].dy += h * body[i].vy - back * motion[i].ay;
        body[i].da += h * body[i].w - back * motion[i].aw;
    }
}

void pl_pass_bodies(pl_substep *s, int kind, pl_range_fn *pass)
{
    const pl_slots slots = s->cluster->slots[kind];
    pl_tasks_ranges(s->tasks, slots.count, PL_BODIES_SHARED, pass,
                    &(pl_passage){ s->world, slots.first, s->h });
}

void pl_move_kinematic(pl_substep *s)
{
    pl_pass_bodies(s, 1, move);
    if (s->world->tracks.count > 0) {
        pl_tracks_end(s);
    }
}

void pl_move_bodies(pl_substep *s)
{
    pl_pass_bodies(s, 0, move);
    pl_move_kinematic(s);
}

// Rows that a joint's reaction is summed along turn when the classic solver moves it: summed before.
void pl_classic_move(pl_substep *s)
{
    pl_joints_row_sum(s);
    pl_move_bodies(s);
}
