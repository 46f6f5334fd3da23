// moment.c - contacts whose geometry is that of the moment, for the exact solver: one at a time, in double.
//
// What they are, and why: solver/moment.simd.c, whose symbols and limits these are. There a substep asks for the second
// derivative of the separation; here, as of joints, for the separation itself where the bodies are going to be. What such a
// contact gave in the sweep that pulls stays, and the one that relaxes adds what is missing along the normal of then: bounds
// hold for the sum of both, so what was too much is taken back.
//
// Reads: manifolds, pairs, cores, solver bodies. Writes: turnings, contacts. Cost: 150 flops a contact that turns and sweep.
#include "exact/exact.h"
#include "math/trig.h"

#include <math.h>

// As in solver/moment.simd.c: [rad] in a step on two points, where less is left as it is, and on any, where more is; [m]
// centres that are closer give no direction. Of what is round and touches at one point, all that turns is followed (with
// the bounds of there a disc that sets off on another one is off by 2e-5 rad, however small the substeps).
#define LEAST_ON_TWO 2e-3
#define MOST         0.25
#define LEAST_GAP    1e-3

typedef struct vec {
    double x, y;
} vec;

static double dot(vec a, vec b)
{
    return a.x * b.x + a.y * b.y;
}

static double cross(vec a, vec b)
{
    return a.x * b.y - a.y * b.x;
}

static vec along(vec from, double way, vec direction)
{
    return (vec){ from.x + way * direction.x, from.y + way * direction.y };
}

// Cosine and sine.
static vec rotation(double angle)
{
    vec r;
    pl_sincos(angle, &r.y, &r.x);
    return r;
}

static vec turned(vec v, vec by)
{
    return (vec){ by.x * v.x - by.y * v.y, by.y * v.x + by.x * v.y };
}

static bool is_round(const plumb_world *world, const pl_manifold *m)
{
    const pl_pair *pair = pl_pair_of(world, m);
    return world->pieces.kind[pair->a] <= PL_PIECE_CAPSULE &&
           world->pieces.kind[pair->b] <= PL_PIECE_CAPSULE;
}

bool pl_exact_may_turn(const plumb_world *world, const pl_manifold *m)
{
    const pl_pair *pair = pl_pair_of(world, m);
    return pl_can_turn(m, world->pieces.kind[pair->a] <= PL_PIECE_CAPSULE,
                       world->pieces.kind[pair->b] <= PL_PIECE_CAPSULE);
}

//---- when the step begins -------------------------------------------------------------------------------

static void find_cores(const plumb_world *world, const pl_manifold *m, pl_exact_turning *t)
{
    const pl_pair *pair = pl_pair_of(world, m);
    const pl_core *cores = world->pieces.core;
    const uint32_t turns = m->met & PL_MET_TURNS;
    const bool on_a = turns == PL_MET_TURNS_A, on_b = turns == PL_MET_TURNS_B;
    const double bend = m->count == 1 ? (double)m->point[1].bend : 0;
    *t = (pl_exact_turning){ .nx = (double)m->nx, .ny = (double)m->ny };
    t->face = bend != 0 ? -1 : on_a ? 0 : on_b ? 1 : -1;
    t->radius[0] = t->face == 0 ? 0 : (double)cores[pair->a].radius;
    t->radius[1] = t->face == 1 ? 0 : (double)cores[pair->b].radius;
    t->radius[0] += on_a && bend != 0 ? 1 / bend : 0;
    t->radius[1] += on_b && bend != 0 ? 1 / bend : 0;
    for (uint32_t k = 0; k < m->count; ++k) {
        const pl_manifold_point *p = &m->point[k];
        t->core[k][0] = (double)p->ax - t->nx * t->radius[0];
        t->core[k][1] = (double)p->ay - t->ny * t->radius[0];
        t->core[k][2] = (double)p->bx + t->nx * t->radius[1];
        t->core[k][3] = (double)p->by + t->ny * t->radius[1];
        t->start[k] = (double)p->separation;
    }
}

// [rad/s] at which the normal turns, or an arm that is none of a body which is round about its centre of mass; 0: not to be
// followed.
static double rate_of(const pl_exact_turning *t, const pl_solver_body *a, const pl_solver_body *b,
                      double most)
{
    const vec n = { t->nx, t->ny }, arm_a = { t->core[0][0], t->core[0][1] };
    const vec arm_b = { t->core[0][2], t->core[0][3] };
    const double wa = fabs((double)a->w), wb = fabs((double)b->w);
    const vec v = { (double)b->vx - (double)b->w * arm_b.y - (double)a->vx + (double)a->w * arm_a.y,
                    (double)b->vy + (double)b->w * arm_b.x - (double)a->vy -
                        (double)a->w * arm_a.x };
    const double gap = fabs(t->start[0] + t->radius[0] + t->radius[1]);
    if (t->face < 0 && gap <= LEAST_GAP) {
        return 0;
    }
    double rate = t->face == 0 ? wa : t->face == 1 ? wb : fabs(cross(n, v)) / gap;
    if (!(wa < most && wb < most && rate < most)) {
        return 0;
    }
    const double small = 1e-4;
    const bool swings_a = dot(arm_a, arm_a) > small * t->radius[0] * t->radius[0];
    const bool swings_b = dot(arm_b, arm_b) > small * t->radius[1] * t->radius[1];
    rate = swings_a && wa > rate ? wa : rate;
    return swings_b && wb > rate ? wb : rate;
}

static bool touches(const pl_manifold *m)
{
    const bool one = m->count == 1;
    return m->point[0].separation <= PL_AHEAD || (!one && m->point[1].separation <= PL_AHEAD) ||
           m->point[0].normal > 0 || (!one && m->point[1].normal > 0);
}

void pl_exact_find_turning(const pl_exact_system *s, const pl_exact_item *item)
{
    const plumb_world *world = s->world;
    const pl_classic_contact *c = pl_exact_contact(s, item);
    const pl_manifold *m = &pl_manifolds(&world->narrow)[c->manifold];
    const pl_solver_body *a = &pl_solver_bodies(&world->solver)[item->slot[0]];
    const pl_solver_body *b = &pl_solver_bodies(&world->solver)[item->slot[1]];
    pl_exact_turning *t = &s->turnings[item->turning];
    find_cores(world, m, t);
    const double rate = rate_of(t, a, b, MOST * s->inv_dt);
    const bool round = t->face < 0 || is_round(world, m);
    const double least = m->count == 2 ? LEAST_ON_TWO : round ? 0 : (double)PL_LEAST_TURN;
    t->turns = rate > least * s->inv_dt && touches(m);
}

//---- now ----------------------------------------------------------------------------------------------------

// A contact as it is where bodies have gone by `pose`: dx, dy, angle since the step began.
typedef struct look {
    vec n;
    double apart[2]; // [m]
    vec arm[2][2];   // [m] of a point, from either body's centre of mass
} look;

static look look_at(const pl_exact_turning *t, double pose[2][3])
{
    look out;
    const vec start = { t->nx, t->ny }, turn[2] = { rotation(pose[0][2]), rotation(pose[1][2]) };
    const vec went = { pose[1][0] - pose[0][0], pose[1][1] - pose[0][1] };
    vec arm[2][2], grown[2], x[2];
    for (int k = 0; k < 2; ++k) {
        const vec a = { t->core[k][0], t->core[k][1] }, b = { t->core[k][2], t->core[k][3] };
        arm[k][0] = turned(a, turn[0]);
        arm[k][1] = turned(b, turn[1]);
        grown[k] = (vec){ went.x + (arm[k][1].x - b.x) - (arm[k][0].x - a.x),
                          went.y + (arm[k][1].y - b.y) - (arm[k][0].y - a.y) };
        x[k] = along(grown[k], t->start[k] + t->radius[0] + t->radius[1], start);
    }
    const double gap = t->start[0] + t->radius[0] + t->radius[1];
    const double length = gap < 0 ? -sqrt(dot(x[0], x[0])) : sqrt(dot(x[0], x[0]));
    out.n = t->face >= 0 ? turned(start, turn[t->face]) : (vec){ x[0].x / length, x[0].y / length };
    for (int k = 0; k < 2; ++k) {
        const double far = dot(x[k], out.n);
        // Between centres by what has changed, lest a large radius rounds it off.
        const double closer = dot(grown[k], along(x[0], gap, start)) / (length + gap);
        out.apart[k] = t->face >= 0 ? far - t->radius[0] - t->radius[1] : t->start[k] + closer;
        const vec aside = along(x[k], -far, out.n);
        for (int end = 0; end < 2; ++end) {
            const double side = end == 0 ? 1 : -1;
            out.arm[k][end] = along(arm[k][end], side * t->radius[end], out.n);
            if (t->face == end) {
                out.arm[k][end] = along(out.arm[k][end], side, aside);
            }
        }
    }
    return out;
}

static void pose_of(const pl_exact_system *s, const pl_exact_item *item, double pose[2][3])
{
    for (int end = 0; end < 2; ++end) {
        const pl_solver_body *b = &pl_solver_bodies(&s->world->solver)[item->slot[end]];
        pose[end][0] = (double)b->dx;
        pose[end][1] = (double)b->dy;
        pose[end][2] = (double)b->da;
    }
}

// What the classic solver's rows are made of, and events read (effective masses are not: no sweep of its goes over them).
void pl_exact_turn(const pl_exact_system *s, const pl_exact_item *item, pl_classic_contact *m)
{
    pl_exact_turning *t = &s->turnings[item->turning];
    double pose[2][3];
    pose_of(s, item, pose);
    const look now = look_at(t, pose);
    m->nx = (near_real)now.n.x, m->ny = (near_real)now.n.y;
    for (uint32_t k = 0; k < 2 && k < m->count; ++k) {
        pl_classic_point *p = &m->point[k];
        const vec a = now.arm[k][0], b = now.arm[k][1];
        p->ran = (near_real)cross(a, now.n), p->rat = (near_real)dot(a, now.n);
        p->rbn = (near_real)cross(b, now.n), p->rbt = (near_real)dot(b, now.n);
        t->apart[k] = now.apart[k];
        // As places of the step's beginning have it, from where the separation of the moment is told.
        const double went = now.n.x * (pose[1][0] - pose[0][0]) +
                            now.n.y * (pose[1][1] - pose[0][1]) + (double)p->rbn * pose[1][2] -
                            (double)p->ran * pose[0][2];
        p->separation =
            p->separation < PL_APART / 2 ? (near_real)(now.apart[k] - went) : p->separation;
    }
}

void pl_exact_part(const pl_exact_system *s, const pl_exact_item *item, double velocity[2][3],
                   double parted[2])
{
    const pl_exact_turning *t = &s->turnings[item->turning];
    const pl_classic_contact *m = pl_exact_contact(s, item);
    double pose[2][3];
    pose_of(s, item, pose);
    for (int end = 0; end < 2; ++end) {
        for (int c = 0; c < 3; ++c) {
            pose[end][c] += (double)s->h * velocity[end][c];
        }
    }
    const look then = look_at(t, pose);
    for (uint32_t k = 0; k < m->count; ++k) {
        parted[k] = then.apart[k] - t->apart[k];
    }
}

// A face that is pressed turns back or over, a disc in a bowl swings.
bool pl_exact_is_pressed(const pl_exact_system *s, const pl_exact_item *item)
{
    const pl_exact_turning *t = &s->turnings[item->turning];
    const pl_classic_contact *m = pl_exact_contact(s, item);
    const pl_solver_body *body[2] = { &pl_solver_bodies(&s->world->solver)[item->slot[0]],
                                      &pl_solver_bodies(&s->world->solver)[item->slot[1]] };
    double push = 0;
    for (uint32_t k = 0; k < m->count; ++k) {
        push += 2 * s->rows[item->first_row + k].next; // as much again behind the drift
    }
    const double h = (double)s->h, gap = t->start[0] + t->radius[0] + t->radius[1];
    if (t->face < 0) {
        const double mass = (double)body[0]->inv_mass + (double)body[1]->inv_mass;
        return gap < 0 && h * push * mass > -gap;
    }
    const double *core = t->core[0] + 2 * t->face;
    const double arm = fabs(core[0] * t->nx + core[1] * t->ny);
    return h * push * arm * (double)body[t->face]->inv_inertia > 1;
}
