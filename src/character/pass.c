// pass.c - all characters of a step: kinematic ones are moved, dynamic ones driven.
//
// The pass comes before the broad phase, since contacts look ahead along velocities. What can still
// run out of memory comes after it, so it keeps what everything was and can be undone.
//
// A kinematic character's move becomes the velocity of its body: the step then moves it there, and
// everything else meets it as a kinematic body. Characters move one after the other, what they stand
// on first: those that are still to move stand still for the others.
//
// Reads: grids, poses, velocities. Writes: velocities of characters, forces on dynamic bodies.
// Order: first of the built-in passes. Cost: see walker.h, a character.
#include "world/destroy.h"
#include "broad/broad.h"
#include "query/query.h"
#include "character/walker.h"
#include "narrow/narrow.h"
#include "narrow/surface.h"
#include "schema/passes.h"
#include "world/rows.h"
#include "world/wrap.h"

#include <math.h>
#include <string.h>

#define PUSHES_EACH 4 // most forces that one character adds
#define PHASES      6 // walks and flights within a step
#define ALL_DONE    1e-9

bool pl_characters_wanted(const plumb_world *world, const char **reason)
{
    bool wanted = world->characters.count > 0;
    *reason = wanted ? "there are characters" : "no body is a character";
    return wanted;
}

//---- one kinematic character --------------------------------------------------------------------

static bool is_on(const pl_character *c, const plumb_world *world)
{
    return c->on_ground && pl_body_row(world, c->ground.body) != PL_NONE;
}

static bool is_asleep_below(const pl_character *c, const plumb_world *world)
{
    return is_on(c, world) && pl_row_slept(world, pl_body_row(world, c->ground.body));
}

// [m] by which the surface that it stands on runs in this step.
static plumb_vec2 run_of_belt(const pl_walker *m)
{
    const pl_ground *g = &m->c->ground;
    const uint32_t piece = pl_shape_piece(m->world, g->shape);
    if (piece == PL_NONE || m->c->climbs) {
        return plumb_v2(0, 0);
    }
    const real way = pl_belt_speed(m->world, piece) * (real)m->step;
    return plumb_v2(way * g->normal.y, -way * g->normal.x);
}

// [rad/s] a loose body that turns faster rolls away under a character and carries nobody: at no cost to itself it would make any speed.
#define MOST_TURN 3.0

// [m] by which what it stands on carries it in this step.
static plumb_vec2 carry_of(const pl_walker *m)
{
    const pl_character *c = m->c;
    if (!is_on(c, m->world)) {
        return plumb_v2(0, 0);
    }
    uint32_t row = pl_body_row(m->world, c->ground.body);
    const pl_bodies *b = &m->world->bodies;
    const bool rolls = b->type[row] == PLUMB_DYNAMIC && fabs((double)b->w[row]) > MOST_TURN;
    if ((b->vx[row] == 0 && b->vy[row] == 0 && b->w[row] == 0) || rolls) {
        return run_of_belt(m);
    }
    const pl_pose *pose = &pl_poses(m->world)[row];
    plumb_transform now = { { pose->x, pose->y }, { pose->c, pose->s } };
    plumb_transform end = pl_row_end_pose(m->world, row, m->step);
    return plumb_vec2_add(run_of_belt(m),
                          plumb_vec2_sub(plumb_transform_apply(end, c->ground.local),
                                         plumb_transform_apply(now, c->ground.local)));
}

static double length_of(plumb_vec2 v)
{
    return sqrt((double)v.x * (double)v.x + (double)v.y * (double)v.y);
}

// [m] farthest that it may come in this step.
static double reach_of(const pl_walker *m, plumb_vec2 carry)
{
    const pl_character *c = m->c;
    double speed = length_of(c->velocity) + fabs((double)c->walk) + fabs((double)c->jump) +
                   fabs((double)c->speed) + length_of(c->ground.velocity);
    speed += c->flies ? length_of(c->fly) : 0;
    double g = sqrt(m->gravity_x * m->gravity_x + m->gravity_y * m->gravity_y);
    return speed * m->dt + g * m->dt * m->dt + length_of(carry) + m->step_height + m->step_width +
           m->snap + 4 * m->skin + (double)m->world->desc.push_speed * m->dt;
}

static void be_carried(pl_walker *m, plumb_vec2 carry)
{
    double dx = (double)carry.x, dy = (double)carry.y;
    pl_touch t;
    if (dx == 0 && dy == 0) {
        return;
    }
    m->ignored_row = pl_body_row(m->world, m->c->ground.body);
    double share = pl_walker_sweep(m, dx, dy, &t) ? t.fraction : 1;
    m->ignored_row = PL_NONE;
    m->x += share * dx;
    m->y += share * dy;
    m->carried_x += share * dx;
    m->carried_y += share * dy;
}

// What the user has asked for since the last step.
static void take_orders(pl_walker *m)
{
    pl_character *c = m->c;
    if (c->thrown && c->on_ground) {
        plumb_vec2 v = plumb_vec2_sub(c->velocity, c->ground.velocity);
        if ((double)v.x * m->nx + (double)v.y * m->ny > 0) {
            plumb_vec2 thrown = c->velocity;
            pl_walker_leave_ground(m);
            c->velocity = thrown;
        } else {
            c->speed = (real)pl_right(m, (double)v.x, (double)v.y);
        }
    }
    if (c->jump > 0 && c->on_ground) {
        plumb_vec2 ground = c->ground.velocity;
        double side = (double)c->speed, up = (double)c->jump;
        pl_walker_leave_ground(m);
        c->velocity.x = (real)((double)ground.x + side * m->rx + up * m->ux);
        c->velocity.y = (real)((double)ground.y + side * m->ry + up * m->uy);
    }
    c->jump = 0;
    c->thrown = false;
}

// The ground it has landed on is where it will be at the end of the step; what it does sideways in the
// rest of the step carries the character still.
static void drift_along(pl_walker *m, double time)
{
    const pl_ground *g = &m->c->ground;
    double along = ((double)g->velocity.x * m->ny - (double)g->velocity.y * m->nx) * time;
    if (m->c->on_ground && along != 0) {
        be_carried(m, plumb_v2((real)(along * m->ny), (real)(-along * m->nx)));
    }
}

static void move_on_foot(pl_walker *m)
{
    pl_character *c = m->c;
    take_orders(m);
    if (c->on_ground && !pl_walker_settle(m, m->snap > 0 ? m->snap : m->skin / 2)) {
        pl_walker_leave_ground(m);
    }
    double left = m->dt;
    for (int i = 0; i < PHASES && left > ALL_DONE * m->dt; ++i) {
        if (c->on_ground) {
            double speed = (double)c->speed;
            double way = pl_ramp(&speed, (double)c->walk, m->acceleration, left);
            c->speed = (real)speed;
            left = pl_walker_walk(m, way, left);
        } else {
            left = pl_walker_fall(m, left);
            drift_along(m, left);
        }
    }
}

// [m/s] over the ground. Its own pace goes on where it pushes, for when that gives way: it is told what it came along by.
static double pace_of(const pl_walker *m)
{
    const double pace = (double)m->c->speed, side = pace < 0 ? -1 : 1;
    if (!m->pushed) {
        return pace;
    }
    const double way = (m->x - m->carried_x) * m->ny - (m->y - m->carried_y) * m->nx;
    return side * pl_most(pl_least(side * way / m->dt, side * pace), 0);
}

// What is known of the ground where everything is when the step is over.
static void finish_ground(pl_walker *m)
{
    pl_character *c = m->c;
    uint32_t row = c->on_ground ? pl_body_row(m->world, c->ground.body) : PL_NONE;
    if (row == PL_NONE) {
        return;
    }
    plumb_transform end = pl_row_end_pose(m->world, row, m->step);
    c->ground.local =
        plumb_transform_inv_apply(end, pl_wrap_point(m->world, c->ground.point, end.p));
    const double pace = pace_of(m);
    c->velocity.x = c->ground.velocity.x + (real)(pace * m->ny);
    c->velocity.y = c->ground.velocity.y - (real)(pace * m->nx);
    c->on_slope = false;
}

static bool move_one(plumb_world *world, pl_character *c, real dt)
{
    pl_walker m;
    pl_bodies *b = &world->bodies;
    c->hit_count = 0;
    c->on_slope = c->at_wall = c->at_ceiling = c->crushed = false;
    if (!pl_walker_begin(world, c, dt, &m)) {
        c->on_ground = false; // nothing to stand with: it stays where it is
        return true;
    }
    if (c->on_ground && !is_on(c, world)) { // what it stood on was destroyed
        pl_walker_leave_ground(&m);
    }
    plumb_vec2 carry = carry_of(&m);
    if (!pl_walker_look(&m, reach_of(&m, carry))) {
        return false;
    }
    m.slope_side = c->slope_side;
    m.stood = c->on_ground ? c->ground.shape : (plumb_shape)PLUMB_NULL_INIT;
    c->slope_side = 0;
    be_carried(&m, carry);
    pl_walker_recover(&m);
    if (c->flies) {
        if (c->on_ground) {
            pl_walker_leave_ground(&m);
        }
        c->jump = c->left = 0;
        c->thrown = false;
        pl_walker_fly(&m, m.dt);
    } else {
        move_on_foot(&m);
    }
    pl_walker_note_passing(&m);
    finish_ground(&m);
    pl_walker_weigh(&m);
    c->pushed = m.pushed ? c->pushed : (plumb_body)PLUMB_NULL_INIT;
    c->air_time = c->on_ground ? 0 : c->air_time + (real)m.dt;
    // Coming to rest again where it stood, off by a rounding, it has not moved.
    double rounding = 4 * (double)PLUMB_REAL_EPSILON *
                      (fabs((double)m.start.x) + fabs((double)m.start.y) + m.half_width);
    if (is_asleep_below(
            c,
            world)) { // it fell asleep in a creep of the solver's rounding, larger in the far build
        rounding += 4 * (double)NEAR_EPSILON * m.half_width;
    }
    bool moved = fabs(m.x) + fabs(m.y) > rounding;
    b->vx[m.row] = moved ? (real)(m.x / m.dt) : 0;
    b->vy[m.row] = moved ? (real)(m.y / m.dt) : 0;
    double way = sqrt(m.x * m.x + m.y * m.y);
    world->characters.farthest =
        way > world->characters.farthest ? way : world->characters.farthest;
    return true;
}

//---- all of them --------------------------------------------------------------------------------

static bool reserve(plumb_world *world)
{
    pl_characters *all = &world->characters;
    return pl_buffer_reserve(&world->memory, &all->saved, all->count * sizeof(pl_character)) &&
           pl_buffer_reserve(&world->memory, &all->pushes,
                             (size_t)all->count * PUSHES_EACH * sizeof(pl_shove));
}

// Kinematic ones that are yet to move stand still for the others.
static void save(plumb_world *world)
{
    pl_characters *all = &world->characters;
    pl_character *items = pl_character_items(all);
    pl_bodies *b = &world->bodies;
    for (uint32_t i = 0; i < all->count; ++i) {
        uint32_t row = pl_body_row(world, items[i].body);
        items[i].body_velocity = plumb_v2(b->vx[row], b->vy[row]);
        if (b->type[row] == PLUMB_KINEMATIC) {
            b->vx[row] = b->vy[row] = 0;
        }
    }
    memcpy(all->saved.data, items, all->count * sizeof *items);
    all->push_count = 0;
    all->treads = all->walks = false;
    all->farthest = 0;
    all->moved = true;
    ++all->turn;
}

// A character after the ones that it stands on.
static bool move_in_order(plumb_world *world, pl_character *c, real dt)
{
    pl_character *chain[16];
    int count = 0;
    while (c != NULL && c->turn != world->characters.turn) {
        c->turn = world->characters.turn;
        chain[count++] = c;
        uint32_t row = c->on_ground ? pl_body_row(world, c->ground.body) : PL_NONE;
        c = row == PL_NONE || count == 16 ? NULL : pl_character_of(world, row);
    }
    while (count > 0) {
        pl_character *next = chain[--count];
        uint32_t row = pl_body_row(world, next->body);
        uint8_t type = world->bodies.type[row];
        if ((world->bodies.flags[row] & PL_BODY_DISABLED) != 0 || type == PLUMB_STATIC) {
            continue;
        }
        bool is_dynamic = type == PLUMB_DYNAMIC;
        world->characters.walks |= is_dynamic;
        if (!(is_dynamic ? pl_character_drive(world, next, dt) : move_one(world, next, dt))) {
            return false;
        }
    }
    return true;
}

bool pl_characters_move(plumb_world *world, real dt)
{
    bool stale;
    if (!reserve(world)) {
        return false;
    }
    save(world);
    if (!pl_broad_update_grids(world, dt, &stale)) {
        return false;
    }
    pl_character *items = pl_character_items(&world->characters);
    for (uint32_t i = 0; i < world->characters.count; ++i) {
        if (!move_in_order(world, &items[i], dt)) {
            return false;
        }
    }
    return true;
}

void pl_characters_undo(plumb_world *world)
{
    pl_characters *all = &world->characters;
    pl_bodies *b = &world->bodies;
    if (!all->moved) {
        return;
    }
    const pl_shove *pushes = all->pushes.data;
    while (all->push_count > 0) {
        const pl_shove *p = &pushes[--all->push_count];
        uint32_t row = pl_body_row(world, p->body); // it may have moved: bodies woke
        b->fx[row] = p->fx, b->fy[row] = p->fy, b->torque[row] = p->torque;
    }
    memcpy(all->items.data, all->saved.data, all->count * sizeof(pl_character));
    const pl_character *items = pl_character_items(all);
    for (uint32_t i = 0; i < all->count; ++i) {
        uint32_t row = pl_body_row(world, items[i].body);
        if (!pl_row_is_asleep(world, row)) { // what fell asleep in the refused step sleeps on
            b->vx[row] = items[i].body_velocity.x;
            b->vy[row] = items[i].body_velocity.y;
        }
    }
    --all->turn;
    all->moved = false;
}

// Whether the body of a row stands on that of another as a kinematic character on a dynamic body.
static bool treads_on(const plumb_world *world, uint32_t row, uint32_t other)
{
    const pl_bodies *b = &world->bodies;
    const pl_character *c = pl_character_of(world, row);
    return c != NULL && b->type[row] == PLUMB_KINEMATIC && b->type[other] == PLUMB_DYNAMIC &&
           c->on_ground && plumb_same(c->ground.body, b->entity[other]);
}

void pl_characters_feet(plumb_world *world)
{
    pl_manifold *m = pl_manifolds(&world->narrow);
    const pl_bodies *b = &world->bodies;
    bool any = false;
    if (!world->characters.treads && !world->characters.walks) {
        return;
    }
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        uint32_t row_a = m[i].body_a, row_b = m[i].body_b;
        bool walks_a = b->character[row_a] != 0 && b->type[row_a] == PLUMB_DYNAMIC;
        bool walks_b = b->character[row_b] != 0 && b->type[row_b] == PLUMB_DYNAMIC;
        m[i].friction = walks_a || walks_b ? 0 : m[i].friction;
        m[i].disabled = treads_on(world, row_a, row_b) || treads_on(world, row_b, row_a);
        any |= m[i].disabled != 0;
    }
    if (any) {
        pl_narrow_take_out_disabled(world, 0);
    } else {
        pl_narrow_summarise(&world->narrow);
    }
}
