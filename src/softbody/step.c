// step.c - soft bodies in a step: gathered before the graph, taken through the substeps with the bodies that they pull or
// touch as unknowns of one implicit system each group (plan.c), stored when nothing can fail any more.
//
// In each substep Newton's iteration finds what it adds to velocities, u: M u = h f(u). All bodies that are near are of
// cluster 0, which one thread solves; they get u / h as their acceleration, and the rigid solver moves them by
// x + h v + h^2 a / 2 just as the system does. Where there are none, all substeps run behind the solver.
//
// Reads: soft bodies, rows, pieces, solver bodies. Writes: accelerations; nodes and edges; times of rest. Order: before
// "called", behind the graph, with the forces of the moment, behind "motion". Cost: see DECISIONS.md.
#include "effects/effects.h"
#include "schema/passes.h"
#include "softbody/softbody.h"
#include "world/island.h"
#include "world/substep.h"
#include "world/rows.h"
#include "world/softbody_list.h"

#include <math.h>
#include <string.h>

bool pl_want_softbodies(const plumb_world *world, const char **reason)
{
    const pl_softbodies *all = &world->softbodies;
    const bool wanted = all->count > all->asleep_count;
    *reason = wanted           ? "there are soft bodies"
              : all->count > 0 ? "all soft bodies sleep"
                               : "there is no soft body";
    return wanted;
}

void pl_softbodies_free(pl_memory *memory, pl_softbodies *s)
{
    pl_buffer *buffers[] = { &s->items,     &s->nodes, &s->edges, &s->bends,
                             &s->triangles, &s->rings, &s->pins,  &s->rests };
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; ++i) {
        pl_buffer_free(memory, buffers[i]);
    }
    if (s->step != NULL) {
        pl_soft_step *t = s->step;
        pl_buffer *scratch[] = { &t->points,  &t->bodies, &t->obstacles, &t->near_,   &t->contacts,
                                 &t->keys,    &t->index,  &t->numbers,   &t->shapes,  &t->rows,
                                 &t->pulls,   &t->winds,  &t->pushes,    &t->members, &t->groups,
                                 &t->grouped, &t->fronts, &t->kept };
        for (size_t i = 0; i < sizeof scratch / sizeof scratch[0]; ++i) {
            pl_buffer copy = *scratch[i];
            pl_buffer_free(memory, &copy);
        }
        pl_elimination order = t->elimination;
        pl_elimination_free(memory, &order);
        pl_resize(memory, t, sizeof *t, 0);
    }
}

//---- gathered ------------------------------------------------------------------------------------

static double mass_of(const pl_softbodies *all, const pl_softbody *item, uint32_t first)
{
    double sum = 0;
    for (uint32_t i = first; i < first + item->nodes; ++i) {
        sum += (double)pl_softbody_nodes(all)[i].mass;
    }
    return sum;
}

static bool is_moored(const plumb_world *world, const pl_softbody *item, uint32_t first)
{
    const plumb_softbody_pin *pins = pl_softbody_pins(&world->softbodies) + first;
    bool moored = false;
    for (uint32_t k = 0; k < item->pins && !moored; ++k) { // PL_NONE is above all rows
        moored = pl_body_row(world, pins[k].body) >= world->dynamic_count;
    }
    return moored;
}

static void gather_nodes(const plumb_world *world, const pl_softbody *item, const pl_soft_member *m)
{
    const pl_softbodies *all = &world->softbodies;
    const pl_softbody_place at = m->at;
    const bool moored = is_moored(world, item, at.pin);
    const pl_soft_shove *pushes = all->step->pushed ? all->step->pushes.data : NULL;
    const double heavy = (pushes != NULL ? pushes[at.node].heavy : 0) + m->mass;
    for (uint32_t i = 0; i < item->nodes; ++i) {
        const plumb_softbody_node *n = &pl_softbody_nodes(all)[at.node + i];
        pl_soft_points(all->step)[at.point + i] =
            (pl_soft_point){ .x = pl_soft_exact(n->position.x, n->position_rest.x),
                             .y = pl_soft_exact(n->position.y, n->position_rest.y),
                             .vx = pl_soft_exact(n->velocity.x, n->velocity_rest.x),
                             .vy = pl_soft_exact(n->velocity.y, n->velocity_rest.y),
                             .mass = (double)n->mass,
                             .radius = (double)n->radius,
                             .damping = (double)item->damping,
                             .friction = (double)item->friction,
                             .heavy = heavy,
                             .block = PL_NONE,
                             .body = PL_NONE,
                             .moored = moored };
    }
}

static bool gather_pins(plumb_world *world, const pl_softbody *item, pl_softbody_place at)
{
    const pl_softbodies *all = &world->softbodies;
    for (uint32_t k = 0; k < item->pins; ++k) {
        const plumb_softbody_pin *pin = &pl_softbody_pins(all)[at.pin + k];
        const uint32_t row = pl_body_row(world, pin->body);
        pl_soft_point *p = &pl_soft_points(all->step)[at.point + pin->node];
        p->pinned = true;
        p->px = (double)pin->point.x;
        p->py = (double)pin->point.y;
        if (row == PL_NONE) {
            p->x = p->px, p->y = p->py;
            p->vx = p->vy = 0;
            continue;
        }
        p->px -= (double)world->bodies.local_x[row];
        p->py -= (double)world->bodies.local_y[row];
        p->body = pl_soft_body_of(world, row);
        if (p->body == PL_NONE) {
            return false;
        }
        pl_soft_bodies(all->step)[p->body].touched = true;
    }
    return true;
}

static bool gather(plumb_world *world)
{
    const pl_softbodies *all = &world->softbodies;
    pl_soft_step *s = all->step;
    pl_softbody_place at = { 0 };
    s->body_count = s->member_count = 0;
    for (uint32_t i = 0; i < all->count; ++i) {
        const pl_softbody *item = &pl_softbody_items(all)[i];
        if (!item->asleep) {
            pl_soft_member *m = &pl_soft_members(s)[s->member_count++];
            *m = (pl_soft_member){
                .item = i, .nodes = item->nodes, .mass = mass_of(all, item, at.node), .at = at
            };
            gather_nodes(world, item, m);
            if (!gather_pins(world, item, at)) {
                return false;
            }
        }
        at = pl_softbody_behind(at, item);
    }
    s->point_count = at.point;
    return true;
}

bool pl_soft_make_step(plumb_world *world)
{
    pl_softbodies *all = &world->softbodies;
    if (all->step == NULL) {
        all->step = pl_resize(&world->memory, NULL, 0, sizeof *all->step);
        if (all->step != NULL) {
            *all->step = (pl_soft_step){ .point_count = 0 };
        }
    }
    return all->step != NULL;
}

static bool reserve(plumb_world *world)
{
    const pl_softbodies *all = &world->softbodies;
    return pl_soft_make_step(world) &&
           pl_buffer_reserve(&world->memory, &all->step->points,
                             all->node_count * sizeof(pl_soft_point)) &&
           pl_buffer_reserve(&world->memory, &all->step->pulls,
                             all->edge_count * sizeof(pl_soft_pull)) &&
           pl_buffer_reserve(&world->memory, &all->step->members,
                             2 * (size_t)all->count * sizeof(pl_soft_member)) &&
           pl_buffer_reserve(&world->memory, &all->step->rows, (size_t)world->dynamic_count + 1);
}

bool pl_softbodies_find(plumb_world *world, real dt)
{
    if (!reserve(world) || !gather(world) || !pl_soft_find_near(world, (double)dt) ||
        !pl_soft_find_winds(world)) {
        return false;
    }
    pl_soft_step *s = world->softbodies.step;
    s->coupled = 0;
    s->done = 0;
    s->missed = 0;
    memset(s->rows.data, 0, world->dynamic_count);
    for (uint32_t i = 0; i < s->body_count; ++i) {
        if (pl_soft_bodies(s)[i].row < world->dynamic_count) {
            ((uint8_t *)s->rows.data)[pl_soft_bodies(s)[i].row] = 1;
            ++s->coupled;
        }
    }
    return true;
}

plumb_result pl_run_softbodies(plumb_world *world, plumb_real dt)
{
    return pl_softbodies_find(world, dt) ? PLUMB_OK : PLUMB_E_MEMORY;
}

bool pl_softbodies_act_on(const plumb_world *world, uint32_t row)
{
    return ((const uint8_t *)world->softbodies.step->rows.data)[row] != 0;
}

bool pl_softbodies_couple(const plumb_world *world, uint8_t *called)
{
    const pl_soft_step *s = world->softbodies.step;
    for (uint32_t i = 0; i < s->body_count && s->coupled > 0; ++i) {
        if (pl_soft_bodies(s)[i].row < world->dynamic_count) {
            called[pl_soft_bodies(s)[i].row] |= PL_CALLED_ALONE;
        }
    }
    return s->coupled > 0;
}

//---- substeps ------------------------------------------------------------------------------------

plumb_result pl_run_soft_slots(plumb_world *world, plumb_real dt)
{
    (void)dt;
    return pl_softbodies_plan(world) ? PLUMB_OK : PLUMB_E_MEMORY;
}

void pl_softbodies_row(pl_substep *sub)
{
    if (sub->world->softbodies.step->coupled > 0 &&
        sub->cluster == pl_clusters(&sub->world->solver)) {
        pl_soft_newton(sub->world, (double)sub->h, PL_SOFT_PASSES);
    }
}

//---- when nothing can fail any more --------------------------------------------------------------

static double held(double v, double most)
{
    return v > most ? most : v < -most ? -most : v == v ? v : 0;
}

static void put(double value, real *to, real *rest)
{
    *to = (real)value;
    *rest = (real)(value - (double)*to);
}

// What a body holds is where the body is.
static void follow_body(const plumb_world *world, pl_soft_point *p)
{
    const pl_bodies *b = &world->bodies;
    const uint32_t row = pl_body_row(world, pl_soft_bodies(world->softbodies.step)[p->body].body);
    if (row == PL_NONE) {
        return;
    }
    const bool moves = row < world->dynamic_count + world->kinematic_count;
    const double c = (double)b->c[row], s = (double)b->s[row], w = moves ? (double)b->w[row] : 0;
    const double rx = c * p->px - s * p->py, ry = s * p->px + c * p->py;
    p->x = (double)b->center_x[row] + (double)b->residual_x[row] + rx;
    p->y = (double)b->center_y[row] + (double)b->residual_y[row] + ry;
    p->vx = (moves ? (double)b->vx[row] : 0) - w * ry;
    p->vy = (moves ? (double)b->vy[row] : 0) + w * rx;
}

static void store_nodes_of(plumb_world *world, uint32_t count, pl_softbody_place at)
{
    const pl_softbodies *all = &world->softbodies;
    for (uint32_t i = 0; i < count; ++i) {
        pl_soft_point *p = &pl_soft_points(all->step)[at.point + i];
        plumb_softbody_node *n = &pl_softbody_nodes(all)[at.node + i];
        if (p->body != PL_NONE) {
            follow_body(world, p);
        }
        put(held(p->x, 1e12), &n->position.x, &n->position_rest.x);
        put(held(p->y, 1e12), &n->position.y, &n->position_rest.y);
        put(held(p->vx, PL_SOFT_SPEED), &n->velocity.x, &n->velocity_rest.x);
        put(held(p->vy, PL_SOFT_SPEED), &n->velocity.y, &n->velocity_rest.y);
    }
}

static void store_nodes(plumb_world *world)
{
    const pl_softbodies *all = &world->softbodies;
    pl_softbody_place at = { 0 };
    for (uint32_t i = 0; i < all->count; ++i) {
        const pl_softbody *item = &pl_softbody_items(all)[i];
        if (!item->asleep) {
            store_nodes_of(world, item->nodes, at);
            pl_softbody_see_box(world, i, at);
        }
        at = pl_softbody_behind(at, item);
    }
}

// What sleeps and is pressed or pulled after all, as it was not near when the step began, wakes.
static void stir(plumb_world *world)
{
    const pl_soft_step *s = world->softbodies.step;
    for (uint32_t i = 0; i < s->body_count; ++i) {
        const pl_soft_body *b = &pl_soft_bodies(s)[i];
        const uint32_t row = b->touched ? pl_body_row(world, b->body) : PL_NONE;
        if (row != PL_NONE && pl_row_is_asleep(world, row)) {
            pl_sleep_disturb(world, row);
        }
    }
}

static void tell_missed(plumb_world *world)
{
    pl_softbodies *all = &world->softbodies;
    if (all->step->missed > 0 && all->missed_count == 0) {
        pl_warn(world,
                "soft bodies did not settle within %d passes in a substep at %g s: what they do "
                "there is less exact; more "
                "substeps, or softer ones, help",
                PL_SOFT_PASSES, world->time);
    }
    all->missed_count += all->step->missed;
}

plumb_result pl_run_softbodies_motion(plumb_world *world, plumb_real dt)
{
    const pl_soft_step *s = world->softbodies.step;
    const near_real h = (near_real)(dt / (real)world->desc.substeps);
    while (s->done < (int)world->desc.substeps) {
        pl_soft_newton(world, (double)h, PL_SOFT_PASSES);
    }
    store_nodes(world);
    pl_soft_settle_edges(world);
    stir(world);
    tell_missed(world);
    return PLUMB_OK;
}
