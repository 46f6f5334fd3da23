// merge.c - two bodies become one, and bodies grow and shrink.
//
// Shapes of the one that goes are made anew in the frame of the other: their corners are turned and moved in double. Momentum, and angular
// momentum about the common centre, are what both had: v = (m v + m' v') / (m + m'), w = L / I. What is lost is the energy of
// a blow without restitution.
//
// Reads: arguments, checked first; pieces. Writes: rows, pieces, joints. Cost: O(pieces and joints of both).
#include "api/fracture.h"

#include "joints/joint.h"
#include "plumb/math.h"
#include "world/body_settings.h"
#include "world/check.h"
#include "world/destroy.h"
#include "world/filter.h"
#include "world/heat_list.h"
#include "world/island.h"
#include "world/joint_list.h"
#include "world/rows.h"
#include "world/told.h"

#include <math.h>

//---- pieces in another frame ---------------------------------------------------------------------

// A point p becomes scale R p + (x, y).
typedef struct mapping {
    double c, s, x, y, scale;
} mapping;

static plumb_vec2 map(const mapping *m, plumb_real x, plumb_real y)
{
    const double px = m->scale * (double)x, py = m->scale * (double)y;
    return plumb_v2((plumb_real)(m->c * px - m->s * py + m->x),
                    (plumb_real)(m->s * px + m->c * py + m->y));
}

static plumb_vec2 turned(const mapping *m, plumb_vec2 v)
{
    return plumb_v2((plumb_real)(m->c * (double)v.x - m->s * (double)v.y),
                    (plumb_real)(m->s * (double)v.x + m->c * (double)v.y));
}

static real reach_of(const plumb_convex *convex)
{
    real farthest = 0;
    for (int i = 0; i < convex->count; ++i) {
        farthest = plumb_max(farthest, plumb_vec2_magnitude(convex->points[i]));
    }
    return farthest + convex->radius;
}

static void map_piece(const plumb_world *world, const mapping *m, uint32_t p, pl_made_piece *out)
{
    const pl_core core = world->pieces.core[p];
    *out = (pl_made_piece){ .cuts = world->pieces.cuts[p], .kind = world->pieces.kind[p] };
    pl_piece_convex(world, p, &out->convex);
    plumb_convex *convex = &out->convex;
    convex->radius = (plumb_real)(m->scale * (double)convex->radius);
    plumb_aabb box = plumb_aabb_empty();
    for (int k = 0; k < convex->count; ++k) {
        convex->points[k] = map(m, convex->points[k].x, convex->points[k].y);
        convex->normals[k] = turned(m, convex->normals[k]);
        box = plumb_aabb_add_point(box, convex->points[k]);
    }
    const plumb_vec2 center = map(m, core.x, core.y);
    const plumb_vec2 way = turned(m, plumb_v2(core.c, core.s));
    const double half_x = m->scale * (double)core.hx, half_y = m->scale * (double)core.hy;
    const bool turns = out->kind == PL_PIECE_CAPSULE || out->kind == PL_PIECE_BOX;
    out->core = (pl_core){ center.x,     center.y,     turns ? way.x : 1, turns ? way.y : 0,
                           (real)half_x, (real)half_y, convex->radius,    reach_of(convex) };
    if (out->kind == PL_PIECE_POLYGON) {
        const plumb_vec2 middle = plumb_aabb_center(box);
        out->core.x = middle.x;
        out->core.y = middle.y;
        out->core.hx = (box.max.x - box.min.x) / 2;
        out->core.hy = (box.max.y - box.min.y) / 2;
    }
}

static plumb_mass_properties map_area(const mapping *m, plumb_mass_properties area)
{
    const double square = m->scale * m->scale;
    area.center = map(m, area.center.x, area.center.y);
    area.mass = (plumb_real)(square * (double)area.mass);
    area.inertia = (plumb_real)(square * square * (double)area.inertia);
    return area;
}

// The shape that begins with piece p, mapped, as one of the body of `row`; it keeps its handle. Room must be reserved.
static void move_shape(plumb_world *world, const char *fn, const mapping *m, uint32_t p,
                       uint32_t row)
{
    const pl_pieces *pieces = &world->pieces;
    plumb_shape shape = pieces->shape[p];
    const uint8_t flags = pieces->flags[p];
    plumb_one_way one_way = plumb_shape_one_way(world, shape);
    one_way.direction = turned(m, one_way.direction);
    plumb_shape_desc desc = { .kind = (plumb_shape_kind)pieces->shape_kind[p],
                              .material = plumb_shape_material(world, shape),
                              .density = pieces->own_density[p],
                              .filter = plumb_shape_filter(world, shape),
                              .one_way = one_way,
                              .sensor = (flags & PL_PIECE_SENSOR) != 0,
                              .user_data = pieces->user_data[p] };
    desc.filter.mask = desc.filter.nothing ? 0 : desc.filter.mask;
    pl_made made = { .area = map_area(m, pieces->area[p]) };
    uint32_t count = 0;
    for (uint32_t q = p; q != PL_NONE; q = pieces->next_in_shape[q]) {
        pl_made_piece piece;
        map_piece(world, m, q, &piece);
        pl_made_add(world, &made, &piece);
        ++count;
    }
    // The new pieces take the handle over while the old ones are there.
    pl_shape_insert(world, fn, row, &desc, &made, &shape);
    pl_pieces_remove(world, p);
}

// Room for all shapes of a body once more.
static bool reserve_shapes(plumb_world *world, uint32_t row)
{
    size_t pieces = 0;
    uint32_t corners = 0;
    uint32_t p = world->bodies.first_piece[row];
    for (; p != PL_NONE; p = world->pieces.next_in_body[p]) {
        ++pieces;
        corners +=
            world->pieces.vertex_count[p] > 0 ? pl_pool_run(world->pieces.vertex_class[p]) : 0;
    }
    return pl_registry_reserve(&world->memory, &world->registry, 1) &&
           pl_pieces_reserve(world, (uint32_t)pieces) &&
           pl_pool_reserve(&world->memory, &world->vertices, corners) &&
           pl_buffer_reserve(&world->memory, &world->made, pieces * sizeof(pl_made_piece)) &&
           pl_buffer_reserve(&world->memory, &world->fracture.shapes, pieces * sizeof(uint32_t));
}

// First pieces of the shapes of a body, newest first, in world->fracture.shapes; how many.
static uint32_t list_shapes(plumb_world *world, uint32_t row)
{
    uint32_t *shapes = world->fracture.shapes.data;
    uint32_t count = 0;
    uint32_t p = world->bodies.first_piece[row];
    for (; p != PL_NONE; p = world->pieces.next_in_body[p]) {
        if (count == 0 ||
            !plumb_same(world->pieces.shape[p], world->pieces.shape[shapes[count - 1]])) {
            shapes[count++] = p;
        }
    }
    return count;
}

static void move_shapes(plumb_world *world, const char *fn, const mapping *m, uint32_t from,
                        plumb_body to)
{
    for (uint32_t i = list_shapes(world, from); i-- > 0;) {
        move_shape(world, fn, m, ((const uint32_t *)world->fracture.shapes.data)[i],
                   pl_body_row(world, to));
    }
}

//---- two that become one -------------------------------------------------------------------------

typedef struct state {
    double mass, inertia, x, y, vx, vy, w;
} state;

static state state_of(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    return (state){ b->inv_mass[row] > 0 ? (double)b->mass[row] : 0,
                    b->inv_mass[row] > 0 ? (double)b->inertia[row] : 0,
                    (double)b->center_x[row],
                    (double)b->center_y[row],
                    (double)b->vx[row],
                    (double)b->vy[row],
                    (double)b->w[row] };
}

static double energy_of(const state *s)
{
    return (s->mass * (s->vx * s->vx + s->vy * s->vy) + s->inertia * s->w * s->w) / 2;
}

// What a body that moves as another says, and has no mass to answer with, takes from one that becomes part of it.
static double energy_against(const state *s, const state *frame)
{
    state r = *s;
    r.vx -= frame->vx - frame->w * (s->y - frame->y);
    r.vy -= frame->vy + frame->w * (s->x - frame->x);
    r.w -= frame->w;
    return energy_of(&r);
}

static void set_motion(plumb_world *world, uint32_t row, double vx, double vy, double w)
{
    pl_bodies *b = &world->bodies;
    const uint32_t flags = b->flags[row];
    b->vx[row] = pl_poses(world)[row].vx = (flags & PL_BODY_LOCK_X) != 0 ? 0 : (real)vx;
    b->vy[row] = pl_poses(world)[row].vy = (flags & PL_BODY_LOCK_Y) != 0 ? 0 : (real)vy;
    b->w[row] = (flags & PL_BODY_FIXED_ROTATION) != 0 ? 0 : (real)w;
    b->residual_vx[row] = b->residual_vy[row] = 0;
}

// Momentum and angular momentum of both, for the body of `row`, which has all shapes by now. Returns the energy lost.
static double join_motion(plumb_world *world, uint32_t row, const state *a, const state *b)
{
    state now = state_of(world, row);
    const state *both[2] = { a, b };
    const double mass = a->mass + b->mass;
    double l = 0;
    now.vx = (a->mass * a->vx + b->mass * b->vx) / mass;
    now.vy = (a->mass * a->vy + b->mass * b->vy) / mass;
    for (int k = 0; k < 2; ++k) {
        const state *s = both[k];
        l += s->inertia * s->w + s->mass * ((s->x - now.x) * s->vy - (s->y - now.y) * s->vx);
    }
    now.w = now.inertia > 0 ? l / now.inertia : 0;
    set_motion(world, row, now.vx, now.vy, now.w);
    now = state_of(world, row);
    return energy_of(a) + energy_of(b) - energy_of(&now);
}

// Mass, centre and inertia of two of which one was given its own: both together, whatever the shapes say.
static void join_mass(plumb_world *world, uint32_t row, const state *a, const state *b)
{
    pl_bodies *all = &world->bodies;
    const double mass = a->mass + b->mass;
    const double x = (a->mass * a->x + b->mass * b->x) / mass;
    const double y = (a->mass * a->y + b->mass * b->y) / mass;
    const state *both[2] = { a, b };
    double inertia = 0;
    for (int k = 0; k < 2; ++k) {
        const double dx = both[k]->x - x, dy = both[k]->y - y;
        inertia += both[k]->inertia + both[k]->mass * (dx * dx + dy * dy);
    }
    const double dx = x - (double)all->x[row], dy = y - (double)all->y[row];
    const double c = (double)all->c[row], s = (double)all->s[row];
    const pl_body_mass made = { (real)mass, (real)inertia, (real)(c * dx + s * dy),
                                (real)(c * dy - s * dx) };
    all->set_mass[row] = made.mass;
    all->set_inertia[row] = inertia > 0 ? made.inertia : 0;
    all->flags[row] |= PL_BODY_OWN_CENTER;
    pl_mass_apply(world, row, &made);
    pl_extent_revise(world, row);
}

static bool has_own_mass(const plumb_world *world, uint32_t row)
{
    const pl_bodies *b = &world->bodies;
    return b->set_mass[row] > 0 || b->set_inertia[row] > 0 ||
           (b->flags[row] & PL_BODY_OWN_CENTER) != 0 || pl_mass_of_shapes(world, row).mass <= 0;
}

static void hand_on_joints(plumb_world *world, const mapping *m, plumb_body from, plumb_body to)
{
    const double turn = (double)plumb_body_angle(world, to) - (double)plumb_body_angle(world, from);
    uint32_t slot = world->bodies.first_joint[pl_body_row(world, from)];
    while (slot != PL_NONE) {
        pl_joint *j = &pl_joint_items(&world->joints)[slot];
        const uint32_t next = pl_joint_next(j, from);
        pl_joint_end *end = plumb_same(j->a.body, from) ? &j->a : &j->b;
        const pl_joint_end *other = end == &j->a ? &j->b : &j->a;
        if (plumb_same(other->body, to)) {
            pl_destroy_entity(world, j->entity.entity); // its ends are one body
        } else {
            j->axis = end == &j->a ? turned(m, j->axis) : j->axis;
            end->local = map(m, end->local.x, end->local.y);
            end->start += turn; // what it has turned since stays
            pl_joint_rehang(world, slot, end, to);
            end->eighth = pl_joint_eighth(world, pl_body_row(world, to));
        }
        slot = next;
    }
}

static mapping frame_in(const plumb_world *world, uint32_t row, uint32_t other)
{
    const pl_bodies *b = &world->bodies;
    const double c = (double)b->c[row], s = (double)b->s[row];
    const double oc = (double)b->c[other], os = (double)b->s[other];
    const double dx = (double)b->x[other] - (double)b->x[row];
    const double dy = (double)b->y[other] - (double)b->y[row];
    return (mapping){ .c = c * oc + s * os,
                      .s = c * os - s * oc,
                      .x = c * dx + s * dy,
                      .y = c * dy - s * dx,
                      .scale = 1 };
}

static plumb_result check_merge(const plumb_world *world, const char *fn, plumb_body body,
                                plumb_body other)
{
    uint32_t a, b;
    PL_TRY(pl_check_body(world, fn, body, &a));
    PL_TRY(pl_check_body(world, fn, other, &b));
    PL_TRY(pl_check_unlocked(world, fn));
    if (a == b) {
        return pl_fail(world, PLUMB_E_HANDLE, fn, "other is body; it must be another");
    }
    const mapping m = frame_in(world, a, b);
    for (uint32_t p = world->bodies.first_piece[b]; p != PL_NONE;
         p = world->pieces.next_in_body[p]) {
        pl_made_piece piece;
        map_piece(world, &m, p, &piece);
        if (!(piece.core.reach <= PLUMB_LENGTH_MAX)) {
            return pl_fail(world, PLUMB_E_RANGE, fn,
                           "other is %g m from body; it must be at most %g",
                           (double)piece.core.reach, (double)PLUMB_LENGTH_MAX);
        }
    }
    return PLUMB_OK;
}

plumb_result pl_merge(plumb_world *world, const char *function, plumb_body body, plumb_body other,
                      double *lost)
{
    PL_TRY(check_merge(world, function, body, other));
    const uint32_t row = pl_body_row(world, body), gone = pl_body_row(world, other);
    pl_bodies *b = &world->bodies;
    const state first = state_of(world, row), second = state_of(world, gone);
    const bool given = has_own_mass(world, row) || has_own_mass(world, gone);
    const bool is_dynamic = b->type[row] == PLUMB_DYNAMIC;
    if (is_dynamic && second.mass > 0 && !(first.mass + second.mass <= (double)PL_MASS_MOST)) {
        return pl_fail(world, PLUMB_E_RANGE, function,
                       "other has mass %g; together they must have at most %g", second.mass,
                       (double)PL_MASS_MOST);
    }
    if (!reserve_shapes(world, gone)) {
        return pl_fail_memory(world, function);
    }
    const mapping m = frame_in(world, row, gone);
    pl_heat_merge(world, body, first.mass, other, second.mass);
    hand_on_joints(world, &m, other, body);
    move_shapes(world, function, &m, pl_body_row(world, other), body);
    pl_destroy_entity(world, other.entity);
    const uint32_t now = pl_body_row(world, body);
    double energy = energy_against(&second, &first);
    if (is_dynamic && second.mass > 0) {
        if (given) {
            join_mass(world, now, &first, &second);
        } else {
            pl_mass_revise(world, now);
        }
        energy = join_motion(world, now, &first, &second);
    } else {
        pl_mass_revise(world, now);
    }
    pl_sleep_stir(world, now);
    pl_told(world, body.entity, function);
    if (lost != NULL) {
        *lost = energy;
    }
    return PLUMB_OK;
}

plumb_result plumb_body_merge(plumb_world *world, plumb_body body, plumb_body other, double *lost)
{
    return pl_merge(world, __func__, body, other, lost);
}

//---- growing and shrinking -----------------------------------------------------------------------

static bool is_in_range(double length)
{
    return length >= (double)PLUMB_LENGTH_MIN && length <= (double)PLUMB_LENGTH_MAX;
}

// Every measure of a shape stays within what shapes may have.
static plumb_result check_scale(const plumb_world *world, const char *fn, uint32_t row,
                                const mapping *m)
{
    uint32_t p = world->bodies.first_piece[row];
    bool fits = true;
    for (; p != PL_NONE && fits; p = world->pieces.next_in_body[p]) {
        const pl_core core = world->pieces.core[p];
        pl_made_piece piece;
        map_piece(world, m, p, &piece);
        fits = (double)piece.core.reach <= (double)PLUMB_LENGTH_MAX &&
               (core.radius == 0 || is_in_range((double)piece.core.radius)) &&
               (core.hx == 0 || is_in_range((double)piece.core.hx)) &&
               (core.hy == 0 || is_in_range((double)piece.core.hy));
    }
    const pl_bodies *b = &world->bodies;
    const double square = m->scale * m->scale;
    fits &= b->type[row] != PLUMB_DYNAMIC ||
            ((double)b->inertia[row] * square * square <= (double)PL_MASS_MOST &&
             ((double)b->inertia[row] == 0 ||
              (double)b->inertia[row] * square * square >= (double)PL_MASS_LEAST) &&
             (double)b->mass[row] * square >= (double)PL_MASS_LEAST);
    return fits ? PLUMB_OK
                : pl_fail(world, PLUMB_E_RANGE, fn,
                          "factor is %g; lengths of its shapes must stay within %g to %g", m->scale,
                          (double)PLUMB_LENGTH_MIN, (double)PLUMB_LENGTH_MAX);
}

plumb_result pl_scale_check(const plumb_world *world, const char *function, plumb_real factor)
{
    return pl_check_range(world, function, "factor", factor, (plumb_real)1e-3, (plumb_real)1e3);
}

plumb_result pl_scale(plumb_world *world, const char *function, plumb_body body, plumb_real factor)
{
    uint32_t row;
    PL_TRY(pl_check_body(world, function, body, &row));
    PL_TRY(pl_scale_check(world, function, factor));
    PL_TRY(pl_check_unlocked(world, function));
    pl_bodies *b = &world->bodies;
    const double f = (double)factor, lx = (double)b->local_x[row], ly = (double)b->local_y[row];
    const mapping m = { .c = 1, .s = 0, .x = lx - f * lx, .y = ly - f * ly, .scale = f };
    PL_TRY(check_scale(world, function, row, &m));
    if (!reserve_shapes(world, row)) {
        return pl_fail_memory(world, function);
    }
    const state before = state_of(world, row);
    b->set_mass[row] = (real)((double)b->set_mass[row] * f * f);
    b->set_inertia[row] = (real)((double)b->set_inertia[row] * f * f * f * f);
    move_shapes(world, function, &m, row, body);
    pl_mass_revise(world, row);
    set_motion(world, row, before.vx, before.vy, before.w);
    for (uint32_t slot = b->first_joint[row]; slot != PL_NONE;) {
        pl_joint *j = &pl_joint_items(&world->joints)[slot];
        pl_joint_end *end = plumb_same(j->a.body, body) ? &j->a : &j->b;
        end->local = map(&m, end->local.x, end->local.y);
        pl_joint_disturb(world, j);
        pl_joints_replan(&world->joints); // lanes keep anchors, and its mass may be what it was
        slot = pl_joint_next(j, body);
    }
    pl_sleep_stir(world, row);
    pl_told(world, body.entity, function);
    return PLUMB_OK;
}

plumb_result plumb_body_scale(plumb_world *world, plumb_body body, plumb_real factor)
{
    return pl_scale(world, __func__, body, factor);
}
