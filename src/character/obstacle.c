// obstacle.c - what a kinematic character may meet in a step, as obstacles to a point.
//
// Static and dynamic bodies stand where they are; kinematic ones, and whatever the character stands
// on, where they will be at the end of the step. Other characters that have not moved yet stand
// still. A one-way piece holds if it does so where both are at the start of the step, or lies below.
//
// Reads: grids, pieces, poses, velocities. Writes: scratch of world->characters.
// Cost: cells near the character, O(corners) an obstacle.
#include "world/body_settings.h"
#include "broad/images.h"
#include "broad/pairs.h"
#include "character/walker.h"
#include "math/trig.h"
#include "narrow/one_way.h"
#include "query/query.h"
#include "world/check.h"
#include "world/filter.h"
#include "world/rows.h"

#include <math.h>
#include <string.h>

#define DEFAULT_SLOPE_COS 0.6427876096865393 // of 50 degrees
#define DEFAULT_MASS      70.0               // [kg]
#define DEFAULT_PUSH      10.0               // [m/s^2] times mass
#define SLOPE_BAND        1e-6               // ground just as steep as allowed is not too steep
#define SAME              1e-9               // [m]
#define SKIN_PART         0.02               // [-] of the half width

//---- the walker ---------------------------------------------------------------------------------

// The first piece of a body that is solid.
static uint32_t solid_piece(const plumb_world *world, uint32_t row)
{
    uint32_t found = PL_NONE;
    uint32_t p = world->bodies.first_piece[row];
    for (; p != PL_NONE; p = world->pieces.next_in_body[p]) {
        // Newest first in the list: the last is the first that was made.
        found = (world->pieces.flags[p] & PL_PIECE_SENSOR) == 0 ? p : found;
    }
    return found;
}

plumb_vec2 pl_character_up(const plumb_world *world, const pl_character *c, uint32_t row)
{
    plumb_vec2 up = c->desc.up;
    if (up.x == 0 && up.y == 0) {
        real scale = world->bodies.gravity_scale[row];
        up = plumb_vec2_scale(scale < 0 ? 1 : -1, world->gravity);
    }
    up = up.x == 0 && up.y == 0 ? pl_world_up(world) : up;
    return plumb_vec2_unit(up);
}

static double given_or(real given, double otherwise)
{
    return given > 0 ? (double)given : otherwise;
}

static void resolve(pl_walker *m)
{
    const plumb_character_desc *d = &m->c->desc;
    double top = -HUGE_VAL, left = HUGE_VAL, right = -HUGE_VAL;
    m->foot = HUGE_VAL;
    for (int i = 0; i < m->shape.count; ++i) {
        double h = pl_up(m, m->shape.x[i], m->shape.y[i]);
        double s = pl_right(m, m->shape.x[i], m->shape.y[i]);
        m->foot = pl_least(m->foot, h - m->shape.radius);
        top = pl_most(top, h + m->shape.radius);
        left = pl_least(left, s - m->shape.radius);
        right = pl_most(right, s + m->shape.radius);
    }
    m->half_width = (right - left) / 2;
    m->middle = (right + left) / 2;
    m->skin = given_or(d->skin, SKIN_PART * m->half_width);
    double step = given_or(d->step_height, (top - m->foot) / 4);
    m->step_height = d->no_steps ? 0 : step;
    m->step_width = given_or(d->step_width, m->half_width / 4);
    m->snap = d->no_snap ? 0 : given_or(d->snap_distance, step);
    double sine, cosine = DEFAULT_SLOPE_COS;
    if (d->max_slope > 0) {
        pl_sincos((double)d->max_slope, &sine, &cosine);
    }
    m->max_slope_cos = cosine - SLOPE_BAND;
    m->mass = given_or(d->mass, DEFAULT_MASS);
    m->push_force = d->no_push ? 0 : given_or(d->push_force, DEFAULT_PUSH * m->mass);
    m->acceleration = (double)d->acceleration;
    m->air_acceleration = given_or(d->air_acceleration, m->acceleration);
    m->max_fall = given_or(d->max_fall_speed, HUGE_VAL);
}

bool pl_walker_begin(plumb_world *world, pl_character *c, real dt, pl_walker *m)
{
    uint32_t row = pl_body_row(world, c->body);
    *m = (pl_walker){ .world = world, .c = c, .row = row, .step = (double)dt };
    m->scale = (double)pl_time_scale(world, row);
    m->dt = m->step * m->scale;
    m->ignored_row = PL_NONE;
    m->piece = solid_piece(world, m->row);
    plumb_vec2 up = pl_character_up(world, c, m->row);
    m->ux = (double)up.x, m->uy = (double)up.y;
    m->rx = m->uy, m->ry = -m->ux;
    double scale = (double)world->bodies.gravity_scale[m->row];
    m->gravity_x = scale * (double)world->gravity.x;
    m->gravity_y = scale * (double)world->gravity.y;
    m->nx = (double)c->ground.normal.x, m->ny = (double)c->ground.normal.y;
    const pl_pose *pose = &pl_poses(world)[m->row];
    m->start = plumb_v2(pose->x, pose->y);
    if (m->piece == PL_NONE || !(m->dt > 0)) {
        return false;
    }
    plumb_convex convex;
    pl_piece_convex(world, m->piece, &convex);
    pl_round_make(&convex, pl_query_frame(world, m->piece, m->start), m->start, &m->shape);
    resolve(m);
    return true;
}

//---- obstacles ----------------------------------------------------------------------------------

typedef struct search {
    pl_walker *m;
    uint32_t count;
    bool out_of_memory;
} search;

static bool list_piece(void *context, const pl_grid_entry *entry)
{
    search *s = context;
    plumb_world *world = s->m->world;
    const pl_pieces *p = &world->pieces;
    if (p->body[entry->piece] == s->m->row || (p->flags[entry->piece] & PL_PIECE_SENSOR) != 0 ||
        !pl_pieces_meet(world, s->m->piece, entry->piece)) {
        return true;
    }
    if (!pl_buffer_reserve(&world->memory, &world->characters.near,
                           ((size_t)s->count + 1) * sizeof(uint32_t))) {
        s->out_of_memory = true;
        return false;
    }
    // In order of slots, so that it does not matter how the grid is filed. Few: by insertion.
    uint32_t *near = world->characters.near.data;
    uint32_t at = s->count++;
    for (; at > 0 && near[at - 1] > entry->piece; --at) {
        near[at] = near[at - 1];
    }
    near[at] = entry->piece;
    return true;
}

// That grid may still name pieces that sleep no more.
static bool list_resting(void *context, const pl_grid_entry *entry)
{
    const search *s = context;
    return (s->m->world->pieces.flags[entry->piece] & PL_PIECE_ASLEEP) == 0 ||
           list_piece(context, entry);
}

plumb_transform pl_row_end_pose(const plumb_world *world, uint32_t row, double dt)
{
    const pl_bodies *b = &world->bodies;
    const pl_pose *pose = &pl_poses(world)[row];
    plumb_rot q = { pose->c, pose->s };
    dt *= (double)pl_time_scale(world, row);
    plumb_rot end = plumb_rot_integrate(q, (real)dt * b->w[row]);
    plumb_vec2 arm = plumb_v2(-pose->dx, -pose->dy); // from the centre to the origin
    arm = plumb_rot_apply(end, plumb_rot_inv_apply(q, arm));
    return (plumb_transform){
        { (real)((double)b->center_x[row] + dt * (double)b->vx[row] + (double)arm.x),
          (real)((double)b->center_y[row] + dt * (double)b->vy[row] + (double)arm.y) },
        end
    };
}

void pl_obstacle_velocity(const pl_obstacle *o, double x, double y, double *vx, double *vy)
{
    *vx = o->vx - o->w * (y - o->cy);
    *vy = o->vy + o->w * (x - o->cx);
}

// Of a dynamic one with a piece; who sleeps has taken his contacts along.
static const pl_pair *pair_with(const pl_walker *m, uint32_t piece)
{
    const plumb_world *world = m->world;
    const pl_sleep *s = &world->sleep;
    if (!pl_row_is_asleep(world, m->row)) {
        return pl_pairs_find_one(world, piece, m->piece);
    }
    uint32_t c = pl_islands(s)[world->bodies.island[m->row]].first_contact;
    while (c != PL_NONE) {
        const pl_sleeping_contact *contact = pl_sleeping_contacts(s) + c;
        const pl_pair *pair = &contact->pair;
        if ((pair->a == piece && pair->b == m->piece) ||
            (pair->b == piece && pair->a == m->piece)) {
            return pair;
        }
        c = contact->next;
    }
    return NULL;
}

// Of a dynamic one its contacts know.
static bool is_under_way(const pl_walker *m, uint32_t piece, bool *dropping)
{
    const pl_character *c = m->c;
    if (m->world->bodies.type[m->row] == PLUMB_DYNAMIC) {
        const pl_pair *pair = pair_with(m, piece);
        *dropping = pair != NULL && (pair->flags & PL_PAIR_DROPPING) != 0;
        return pair != NULL && pl_pair_passes(pair);
    }
    for (int i = 0; i < c->passing_count; ++i) {
        if (plumb_same(c->passing[i].shape, m->world->pieces.shape[piece])) {
            *dropping = c->passing[i].dropping != 0;
            return true;
        }
    }
    return false;
}

// [m] by how much all of the character lies beyond all of a piece, where both are at the start of the step, in the direction in
// which that lets pass.
static double height_above(const pl_walker *m, const pl_round *fixed, double dx, double dy)
{
    double top = -HUGE_VAL, foot = HUGE_VAL;
    for (int i = 0; i < fixed->count; ++i) {
        top = pl_most(top, dx * fixed->x[i] + dy * fixed->y[i]);
    }
    for (int i = 0; i < m->shape.count; ++i) {
        foot = pl_least(foot, dx * m->shape.x[i] + dy * m->shape.y[i]);
    }
    return foot - m->shape.radius - (top + fixed->radius);
}

static void judge_one_way(const pl_walker *m, pl_obstacle *o, const plumb_convex *convex,
                          plumb_transform now)
{
    const pl_pieces *p = &m->world->pieces;
    pl_round fixed;
    pl_sum sum;
    pl_round_make(convex, now, m->start, &fixed);
    pl_sum_make(&fixed, &m->shape, &sum);
    pl_sum_near near = pl_sum_nearest(&sum, 0, 0);
    plumb_vec2 normal = plumb_v2((real)near.nx, (real)near.ny);
    plumb_transform end = pl_row_end_pose(m->world, o->row, m->step);
    plumb_vec2 d = plumb_rot_apply(end.q, plumb_v2(p->one_way_x[o->piece], p->one_way_y[o->piece]));
    o->dx = (double)d.x, o->dy = (double)d.y;
    o->cosine = (double)p->one_way_cos[o->piece];
    d = plumb_rot_apply(now.q, plumb_v2(p->one_way_x[o->piece], p->one_way_y[o->piece]));
    const double height = height_above(m, &fixed, (double)d.x, (double)d.y);
    o->is_below = height >= 0;
    o->under_way = is_under_way(m, o->piece, &o->drops);
    // What it is beside now may be under it before the step is over.
    o->holds =
        !o->under_way && (height >= -(double)PL_ONE_WAY_FOUND ||
                          pl_one_way_blocks(m->world, o->piece, normal, (real)near.distance));
}

// One-way pieces that touch are one to what is under way through one of them: the next tile of a row does not hold what another
// lets pass, unless that lies beyond it. Who drops through one drops through all.
static void join_neighbours(const pl_walker *m)
{
    for (int i = 0; i < m->obstacle_count; ++i) {
        pl_obstacle *o = &m->obstacles[i];
        pl_round grown = o->fixed;
        grown.radius += PL_ONE_WAY_NEIGHBOURS;
        for (int k = 0; o->is_one_way && o->holds && k < m->obstacle_count; ++k) {
            const pl_obstacle *other = &m->obstacles[k];
            if (other->is_one_way && other->under_way && (other->drops || !o->is_below) &&
                pl_rounds_overlap(&grown, &other->fixed)) {
                o->holds = false;
                o->drops = other->drops;
            }
        }
    }
}

static void make_obstacle(const pl_walker *m, uint32_t piece, pl_obstacle *o)
{
    const plumb_world *world = m->world;
    const pl_bodies *b = &world->bodies;
    uint32_t row = world->pieces.body[piece];
    memset(o, 0, sizeof *o);
    o->piece = piece;
    o->row = row;
    o->is_dynamic = b->type[row] == PLUMB_DYNAMIC;
    o->is_ground = m->c->on_ground && plumb_same(b->entity[row], m->c->ground.body);
    if (b->type[row] == PLUMB_KINEMATIC || (o->is_dynamic && o->is_ground)) {
        double pace = (double)pl_time_scale(world, row) / m->scale; // in the character's own time
        o->vx = pace * (double)b->vx[row], o->vy = pace * (double)b->vy[row];
        o->w = pace * (double)b->w[row];
    }
    plumb_convex convex;
    plumb_transform now = pl_query_frame(world, piece, m->start), end = now;
    bool moves = o->vx != 0 || o->vy != 0 || o->w != 0;
    pl_query_convex(world, piece, &convex);
    if (moves) {
        end = pl_row_end_pose(world, row, m->step);
        end.p = pl_wrap_point(world, end.p, now.p);
    }
    pl_round_make(&convex, end, m->start, &o->fixed);
    pl_sum_make(&o->fixed, &m->shape, &o->sum);
    o->sum.radius += m->skin;
    if (moves) {
        plumb_vec2 center = { b->center_x[row], b->center_y[row] };
        center = pl_wrap_point(world, center, now.p);
        o->cx = (double)center.x + m->dt * o->vx - (double)m->start.x;
        o->cy = (double)center.y + m->dt * o->vy - (double)m->start.y;
        double arm = sqrt(o->cx * o->cx + o->cy * o->cy) + m->half_width + fabs(m->foot);
        o->travel = m->dt * (sqrt(o->vx * o->vx + o->vy * o->vy) + fabs(o->w) * arm);
    }
    o->is_one_way = (world->pieces.flags[piece] & PL_PIECE_ONE_WAY) != 0;
    if (o->is_one_way) {
        judge_one_way(m, o, &convex, now);
    }
}

// [m] how far a kinematic body that turns, or a character that has had its turn in this step, can reach
// beyond its fat box within the step.
static double reach_of_others(const plumb_world *world, double dt)
{
    double most = world->characters.farthest;
    for (uint32_t row = world->dynamic_count; row < world->dynamic_count + world->kinematic_count;
         ++row) {
        double w = fabs((double)(world->bodies.w[row] * pl_time_scale(world, row)));
        uint32_t p = w > 0 ? world->bodies.first_piece[row] : PL_NONE;
        for (; p != PL_NONE; p = world->pieces.next_in_body[p]) {
            most = pl_most(most, w * dt * (double)world->pieces.core[p].reach);
        }
    }
    return most;
}

bool pl_walker_look(pl_walker *m, double reach)
{
    plumb_world *world = m->world;
    search s = { .m = m };
    pl_box box = pl_piece_tight_box(world, m->piece);
    real wide =
        (real)pl_least(reach + reach_of_others(world, m->step) + m->skin, (double)PL_LARGEST);
    box.min_x -= wide, box.min_y -= wide, box.max_x += wide, box.max_y += wide;
    if (!pl_world_query(world, &world->broad.moving, box, list_piece, &s) ||
        !pl_world_query(world, &world->broad.resting, box, list_resting, &s) ||
        !pl_world_query(world, &world->broad.fixed, box, list_piece, &s) ||
        !pl_buffer_reserve(&world->memory, &world->characters.obstacles,
                           ((size_t)s.count + 1) * sizeof(pl_obstacle))) {
        return false;
    }
    m->obstacles = world->characters.obstacles.data;
    m->obstacle_count = (int)s.count;
    const uint32_t *near = world->characters.near.data;
    for (uint32_t i = 0; i < s.count; ++i) {
        make_obstacle(m, near[i], &m->obstacles[i]);
    }
    join_neighbours(m);
    return true;
}

//---- one-way shapes -----------------------------------------------------------------------------

// It goes on dropping until it is inside, or no longer above.
static bool still_drops(const pl_walker *m, const pl_obstacle *o, const pl_sum_near *near)
{
    return o->drops && near->distance < 3 * m->skin &&
           near->nx * o->dx + near->ny * o->dy >= o->cosine;
}

void pl_walker_note_passing(pl_walker *m)
{
    pl_passing now[PL_CHARACTER_PASSING];
    int count = 0;
    for (int i = 0; i < m->obstacle_count; ++i) {
        const pl_obstacle *o = &m->obstacles[i];
        if (!o->is_one_way || count == PL_CHARACTER_PASSING) {
            continue;
        }
        pl_sum_near near = pl_sum_nearest(&o->sum, m->x, m->y);
        // What held it and holds it no more has been pressed through; what it came through must have
        // left it skin and all, or it would be lifted by the skin.
        bool inside = near.distance + (o->holds ? m->skin : SAME) < 0;
        bool drops = !inside && still_drops(m, o, &near);
        plumb_shape shape = m->world->pieces.shape[o->piece];
        if ((inside || drops) && (count == 0 || !plumb_same(now[count - 1].shape, shape))) {
            now[count++] = (pl_passing){ shape, drops };
        }
    }
    memcpy(m->c->passing, now, (size_t)count * sizeof now[0]);
    m->c->passing_count = count;
}
