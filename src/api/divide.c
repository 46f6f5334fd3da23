// divide.c - the parts of a body become bodies: rows, shapes, joints, masses, velocities.
//
// Velocities: the parts have masses m, inertias I and centres c, together M, C and I' (parallel axes). They move as one rigid
// body about C that has momentum and angular momentum of what they are of: w' = (I w + M (c0 - C) x v) / I', then
// v + w' x (c - C). Where the shapes of the parts cover that of the whole, C = c0 and I' = I to rounding, and so energy stays; a
// centre, an inertia or chords in place of arcs that were not so leave the difference to the spin.
//
// All that can fail comes first. Reads: world->fracture. Writes: rows, pieces, joints. Order: shapes as they were, oldest
// first. Cost: O(fragments x children), inner edges O(pieces^2) of a shape.
#include "api/fracture.h"

#include "plumb/math.h"
#include "world/body_settings.h"
#include "world/heat_list.h"
#include "world/check.h"
#include "world/destroy.h"
#include "world/filter.h"
#include "world/island.h"
#include "world/joint_list.h"
#include "world/rows.h"
#include "world/told.h"

#include <math.h>

// [kg] masses of parts: well within what a mass may be, for inertias to be as well.
#define LEAST_MASS 1e-24

typedef struct division {
    plumb_world *world;
    const char *fn;
    plumb_body body;
    uint32_t keeper;      // child that the body becomes
    double mass, inertia; // [kg], [kg m^2] before
    double x, y;          // [m] centre
    double vx, vy, w;
    double weight; // of all children
    pl_heat heat;  // of all of it
    bool given;    // masses are shares of the mass that there was, not of shapes
} division;

//---- what may fail -------------------------------------------------------------------------------

static double share_of(const division *d, const pl_child *child)
{
    return child->weight / d->weight;
}

static plumb_result open_division(division *d)
{
    plumb_world *world = d->world;
    const pl_bodies *b = &world->bodies;
    const uint32_t row = pl_body_row(world, d->body);
    pl_child *all = pl_children(world);
    const uint32_t count = world->fracture.child_count;
    for (uint32_t i = 0; i < count; ++i) {
        d->weight += all[i].weight;
    }
    d->given = b->set_mass[row] > 0 || d->weight <= 0;
    for (uint32_t i = 0; i < count && d->weight <= 0; ++i) { // no shape has a density
        all[i].weight = all[i].area;
    }
    d->weight = 0;
    for (uint32_t i = 0; i < count; ++i) {
        d->weight += all[i].weight;
        d->keeper = all[i].weight > all[d->keeper].weight ? i : d->keeper;
    }
    d->heat = pl_heat_get(world, d->body);
    d->mass = (double)b->mass[row];
    d->inertia = (double)b->inertia[row];
    d->x = (double)b->center_x[row];
    d->y = (double)b->center_y[row];
    d->vx = (double)b->vx[row];
    d->vy = (double)b->vy[row];
    d->w = (double)b->w[row];
    for (uint32_t i = 0; i < count && b->type[row] == PLUMB_DYNAMIC; ++i) {
        const double mass = d->given ? d->mass * share_of(d, &all[i]) : all[i].weight;
        if (!(mass >= LEAST_MASS)) {
            return pl_fail(world, PLUMB_E_RANGE, d->fn,
                           "body has a part of mass %g; it must be at least %g", mass, LEAST_MASS);
        }
    }
    return PLUMB_OK;
}

static bool reserve(const division *d, bool tells)
{
    plumb_world *world = d->world;
    pl_memory *memory = &world->memory;
    pl_fracture *f = &world->fracture;
    size_t pieces = 0, shapes = 0;
    uint32_t corners = 0;
    for (uint32_t i = 0; i < f->fragment_count; ++i) {
        const pl_fragment *g = &pl_fragments(world)[i];
        pieces += g->parts > 0 ? g->parts : 1;
        for (uint32_t k = 0; k < g->parts; ++k) {
            corners +=
                pl_pool_run(pl_pool_class(pl_fragment_parts(world)[g->part + k].convex.count));
        }
        corners += g->parts == 0 && world->pieces.vertex_count[g->piece] > 0
                       ? pl_pool_run(world->pieces.vertex_class[g->piece])
                       : 0;
    }
    const uint32_t row = pl_body_row(world, d->body);
    for (uint32_t p = world->bodies.first_piece[row]; p != PL_NONE;
         p = world->pieces.next_in_body[p]) {
        ++shapes;
    }
    const uint32_t bodies = f->child_count - 1;
    return pl_registry_reserve(memory, &world->registry, bodies + f->fragment_count) &&
           pl_rows_reserve(world, bodies) &&
           pl_buffer_reserve(memory, &world->settings.items,
                             ((size_t)world->settings.count + bodies + 1) *
                                 sizeof(pl_body_settings)) &&
           (pl_heat_find(world, d->body) == NULL || pl_heat_reserve(world, bodies)) &&
           pl_pieces_reserve(world, (uint32_t)pieces) &&
           pl_pool_reserve(memory, &world->vertices, corners) &&
           pl_buffer_reserve(memory, &world->made, pieces * sizeof(pl_made_piece)) &&
           pl_buffer_reserve(memory, &f->shapes, shapes * sizeof(uint32_t)) &&
           (!tells || // breaking.c
            pl_buffer_reserve(memory, &f->pieces,
                              ((size_t)f->piece_count + f->child_count) * sizeof(plumb_body)));
}

//---- rows ----------------------------------------------------------------------------------------

static void share_settings(const division *d, uint32_t row, double share, bool keeps)
{
    plumb_world *world = d->world;
    pl_body_settings t = pl_body_settings_get(world, pl_body_row(world, d->body));
    t.charge = (real)((double)t.charge * share);
    t.dipole = (real)((double)t.dipole * share);
    t.drag = (real)((double)t.drag * share);
    t.fuel = (real)((double)t.fuel * share);
    t.fuel_low = t.mass_low = 0;
    t.pull_x = t.pull_y = t.pull_tip = 0;
    if (!keeps) {
        t.thrust = t.exhaust = t.fuel = 0;
        t.break_force = t.break_impulse = t.break_energy = 0;
        t.break_cells = 0;
    }
    pl_body_settings_set(world, row, &t);
    pl_heat_share(world, world->bodies.entity[row], &d->heat, share);
}

static void make_row(const division *d, pl_child *child)
{
    plumb_world *world = d->world;
    plumb_body_desc desc;
    plumb_body_settings(world, d->body, &desc);
    desc.asleep = false;
    desc.velocity = plumb_v2(0, 0);
    desc.angular_velocity = 0;
    desc.inertia = 0;
    desc.mass = d->given && desc.type == PLUMB_DYNAMIC ? (real)(d->mass * share_of(d, child)) : 0;
    child->body = (plumb_body)PLUMB_NULL_INIT;
    pl_body_insert(world, d->fn, &desc, &child->body); // room is reserved
    const uint32_t row = pl_body_row(world, child->body), from = pl_body_row(world, d->body);
    const pl_bodies *b = &world->bodies;
    pl_body_place_at(world, row, plumb_v2(b->x[from], b->y[from]),
                     (plumb_rot){ b->c[from], b->s[from] });
    share_settings(d, row, share_of(d, child), false);
}

static void make_rows(const division *d)
{
    plumb_world *world = d->world;
    for (uint32_t i = 0; i < world->fracture.child_count; ++i) {
        if (i != d->keeper) {
            make_row(d, &pl_children(world)[i]);
        }
    }
    pl_child *keeper = &pl_children(world)[d->keeper];
    keeper->body = d->body;
    const uint32_t row = pl_body_row(world, d->body);
    pl_bodies *b = &world->bodies;
    share_settings(d, row, share_of(d, keeper), true);
    b->set_mass[row] =
        d->given && b->type[row] == PLUMB_DYNAMIC ? (real)(d->mass * share_of(d, keeper)) : 0;
    b->set_inertia[row] = 0;
    b->flags[row] &= (uint16_t)~PL_BODY_OWN_CENTER;
}

//---- joints --------------------------------------------------------------------------------------

static double distance_to(const plumb_world *world, const pl_fragment *g, plumb_vec2 point)
{
    double least = HUGE_VAL;
    for (uint32_t k = 0; k < (g->parts > 0 ? g->parts : 1); ++k) {
        plumb_convex convex;
        if (g->parts > 0) {
            convex = pl_fragment_parts(world)[g->part + k].convex;
        } else {
            pl_piece_convex(world, g->piece, &convex);
        }
        least = pl_smaller(least, (double)plumb_convex_nearest(&convex, point).distance);
    }
    return least;
}

// The child that a point is deepest in, or nearest to.
static uint32_t child_at(const plumb_world *world, plumb_vec2 point)
{
    double least = HUGE_VAL;
    uint32_t child = 0;
    for (uint32_t i = 0; i < world->fracture.fragment_count; ++i) {
        const pl_fragment *g = &pl_fragments(world)[i];
        const double distance = distance_to(world, g, point);
        if (distance < least) {
            least = distance;
            child = g->child;
        }
    }
    return child;
}

static void share_joints(const division *d)
{
    plumb_world *world = d->world;
    uint32_t slot = world->bodies.first_joint[pl_body_row(world, d->body)];
    while (slot != PL_NONE) {
        pl_joint *j = &pl_joint_items(&world->joints)[slot];
        const uint32_t next = pl_joint_next(j, d->body);
        pl_joint_end *end = plumb_same(j->a.body, d->body) ? &j->a : &j->b;
        const uint32_t child = child_at(world, end->local);
        if (child != d->keeper) {
            pl_joint_rehang(world, slot, end, pl_children(world)[child].body);
        }
        slot = next;
    }
}

//---- shapes --------------------------------------------------------------------------------------

// Fragments [first, end) are those of the shape of piece `piece`.
typedef struct shape_run {
    uint32_t piece, first, end;
    bool stays; // as it is, with the body
} shape_run;

static void add_whole(plumb_world *world, pl_made *made, uint32_t p)
{
    pl_made_piece piece = { .core = world->pieces.core[p],
                            .cuts = world->pieces.cuts[p],
                            .kind = world->pieces.kind[p] };
    pl_piece_convex(world, p, &piece.convex);
    pl_made_add(world, made, &piece);
}

// Edges that no other piece of the shape lies at are not inner ones any more.
static void open_edges(const plumb_world *world, const pl_made *made)
{
    pl_made_piece *all = world->made.data;
    for (uint32_t i = 0; i < made->count; ++i) {
        const plumb_convex *c = &all[i].convex;
        for (int k = 0; k < c->count; ++k) {
            const plumb_vec2 middle = plumb_vec2_lerp(
                c->points[k], c->points[k + 1 == c->count ? 0 : k + 1], (plumb_real)0.5);
            bool inner = false;
            for (uint32_t j = 0; j < made->count && !inner && (all[i].cuts >> k & 1u) != 0; ++j) {
                inner = j != i &&
                        plumb_convex_nearest(&all[j].convex, middle).distance <= PLUMB_LENGTH_MIN;
            }
            all[i].cuts &= inner ? UINT32_MAX : ~(1u << k);
        }
    }
}

// What a child has of a shape, in world->made. Returns the area that its fragments stand for over that of the pieces.
static double make_part(plumb_world *world, const shape_run *run, uint32_t child, pl_made *made)
{
    double area = 0;
    plumb_mass_properties sum[2] = { { 0, { 0, 0 }, 0 }, { 0, { 0, 0 }, 0 } };
    *made = (pl_made){ 0 };
    for (uint32_t i = run->first; i < run->end; ++i) {
        const pl_fragment *g = &pl_fragments(world)[i];
        if (g->child != child) {
            continue;
        }
        area += g->area;
        if (g->parts == 0) {
            add_whole(world, made, g->piece);
        }
        for (uint32_t k = 0; k < g->parts; ++k) {
            const pl_fragment_part *part = &pl_fragment_parts(world)[g->part + k];
            pl_made_add_polygon(world, made, &part->convex, part->inner);
        }
    }
    for (uint32_t i = 0; i < made->count; ++i) {
        sum[1] = plumb_convex_mass(&((pl_made_piece *)world->made.data)[i].convex, 1);
        sum[0] = plumb_mass_combine(sum, 2);
    }
    made->area = sum[0];
    open_edges(world, made);
    return area / (double)sum[0].mass;
}

static bool is_whole(const plumb_world *world, const shape_run *run, uint32_t child)
{
    for (uint32_t i = run->first; i < run->end; ++i) {
        const pl_fragment *g = &pl_fragments(world)[i];
        if (g->child != child || g->parts > 0) {
            return false;
        }
    }
    return true;
}

static bool is_round(const plumb_world *world, uint32_t piece)
{
    return world->pieces.core[piece].radius > 0;
}

static void insert(const division *d, const shape_run *run, uint32_t child)
{
    plumb_world *world = d->world;
    const pl_pieces *pieces = &world->pieces;
    plumb_shape shape = pieces->shape[run->piece];
    plumb_shape_desc desc = { .material = plumb_shape_material(world, shape),
                              .density = pieces->own_density[run->piece],
                              .filter = plumb_shape_filter(world, shape),
                              .one_way = plumb_shape_one_way(world, shape),
                              .user_data = pieces->user_data[run->piece] };
    desc.filter.mask = desc.filter.nothing ? 0 : desc.filter.mask;
    const bool whole = is_whole(world, run, child);
    pl_made made;
    const double ratio = make_part(world, run, child, &made);
    if (whole) {
        made.area = pieces->area[run->piece];
        desc.kind = (plumb_shape_kind)pieces->shape_kind[run->piece];
    } else {
        desc.kind = made.count > 1 ? PLUMB_OUTLINE : PLUMB_POLYGON;
        if (is_round(world, run->piece) && pieces->density[run->piece] > 0) {
            desc.density = (real)((double)pieces->density[run->piece] * ratio);
        }
    }
    if (child != d->keeper) {
        shape = (plumb_shape)PLUMB_NULL_INIT;
    }
    const uint32_t row = pl_body_row(world, pl_children(world)[child].body);
    pl_shape_insert(world, d->fn, row, &desc, &made, &shape); // room is reserved
}

static bool child_has(const plumb_world *world, const shape_run *run, uint32_t child)
{
    bool has = false;
    for (uint32_t i = run->first; i < run->end; ++i) {
        has |= pl_fragments(world)[i].child == child;
    }
    return has;
}

static void divide_shape(const division *d, const shape_run *run)
{
    plumb_world *world = d->world;
    if (run->first == run->end || is_whole(world, run, d->keeper)) {
        return;
    }
    const plumb_shape shape = world->pieces.shape[run->piece];
    for (uint32_t c = 0; c < world->fracture.child_count; ++c) {
        if (child_has(world, run, c)) {
            insert(d, run, c);
        }
    }
    if (child_has(world, run, d->keeper)) {
        pl_pieces_move_behind(world, pl_shape_piece(world, shape), run->piece);
        pl_pieces_remove(world, run->piece); // the new pieces have the handle
    } else {
        pl_destroy_entity(world, shape.entity);
    }
}

// Fragments are in the order of the pieces of the body, and so in runs of shapes, newest first.
static shape_run run_of(const plumb_world *world, uint32_t piece, uint32_t end)
{
    shape_run run = { .piece = piece, .first = end, .end = end };
    while (run.first > 0 &&
           plumb_same(world->pieces.shape[pl_fragments(world)[run.first - 1].piece],
                      world->pieces.shape[piece])) {
        --run.first;
    }
    return run;
}

static void divide_shapes(const division *d)
{
    plumb_world *world = d->world;
    pl_fracture *f = &world->fracture;
    uint32_t *shapes = f->shapes.data;
    f->shape_count = 0;
    uint32_t p = world->bodies.first_piece[pl_body_row(world, d->body)];
    for (; p != PL_NONE; p = world->pieces.next_in_body[p]) {
        if (f->shape_count == 0 ||
            !plumb_same(world->pieces.shape[p], world->pieces.shape[shapes[f->shape_count - 1]])) {
            shapes[f->shape_count++] = p;
        }
    }
    // Pieces that go are asked for the shape that they are of: of fragments, only those before have been.
    uint32_t end = f->fragment_count;
    for (uint32_t i = f->shape_count; i-- > 0;) {
        const shape_run run = run_of(world, shapes[i], end);
        end = run.first;
        divide_shape(d, &run);
    }
}

//---- motion --------------------------------------------------------------------------------------

static void set_motion(plumb_world *world, uint32_t row, double vx, double vy, double w)
{
    pl_bodies *b = &world->bodies;
    const uint32_t flags = b->type[row] == PLUMB_DYNAMIC ? b->flags[row] : 0;
    b->vx[row] = pl_poses(world)[row].vx = (flags & PL_BODY_LOCK_X) != 0 ? 0 : (real)vx;
    b->vy[row] = pl_poses(world)[row].vy = (flags & PL_BODY_LOCK_Y) != 0 ? 0 : (real)vy;
    b->w[row] = (flags & PL_BODY_FIXED_ROTATION) != 0 ? 0 : (real)w;
    b->residual_vx[row] = b->residual_vy[row] = 0;
    pl_sleep_stir(world, row);
}

static void move_dynamic(const division *d)
{
    plumb_world *world = d->world;
    const pl_bodies *b = &world->bodies;
    const pl_child *all = pl_children(world);
    const uint32_t count = world->fracture.child_count;
    double mass = 0, x = 0, y = 0, inertia = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t row = pl_body_row(world, all[i].body);
        const double m = (double)b->mass[row];
        mass += m;
        x += m * ((double)b->center_x[row] - d->x);
        y += m * ((double)b->center_y[row] - d->y);
    }
    x /= mass; // from the centre that was
    y /= mass;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t row = pl_body_row(world, all[i].body);
        const double dx = (double)b->center_x[row] - d->x - x;
        const double dy = (double)b->center_y[row] - d->y - y;
        inertia += (double)b->inertia[row] + (double)b->mass[row] * (dx * dx + dy * dy);
    }
    const uint32_t flags = b->flags[pl_body_row(world, d->body)];
    const bool turns = (flags & (PL_BODY_FIXED_ROTATION | PL_BODY_LOCKED)) == 0 && inertia > 0;
    const double w =
        turns ? (d->inertia * d->w - d->mass * (x * d->vy - y * d->vx)) / inertia : d->w;
    const double vx = d->vx * (d->mass / mass), vy = d->vy * (d->mass / mass);
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t row = pl_body_row(world, all[i].body);
        const double dx = (double)b->center_x[row] - d->x - x;
        const double dy = (double)b->center_y[row] - d->y - y;
        set_motion(world, row, vx - w * dy, vy + w * dx, w);
    }
}

static void move(const division *d)
{
    plumb_world *world = d->world;
    const pl_bodies *b = &world->bodies;
    const uint8_t type = b->type[pl_body_row(world, d->body)];
    if (type == PLUMB_DYNAMIC) {
        move_dynamic(d);
    }
    for (uint32_t i = 0; i < world->fracture.child_count && type == PLUMB_KINEMATIC; ++i) {
        const uint32_t row = pl_body_row(world, pl_children(world)[i].body);
        set_motion(world, row, d->vx - d->w * ((double)b->center_y[row] - d->y),
                   d->vy + d->w * ((double)b->center_x[row] - d->x), d->w);
    }
}

plumb_result pl_divide(plumb_world *world, const char *function, plumb_body body, bool tells)
{
    division d = { .world = world, .fn = function, .body = body };
    PL_TRY(open_division(&d));
    if (!reserve(&d, tells)) {
        return pl_fail_memory(world, function);
    }
    make_rows(&d);
    share_joints(&d);
    divide_shapes(&d);
    const pl_child *all = pl_children(world);
    for (uint32_t i = 0; i < world->fracture.child_count; ++i) {
        const uint32_t row = pl_body_row(world, all[i].body);
        pl_mass_revise(world, row);
        pl_told(world, all[i].body.entity, function);
    }
    move(&d);
    return PLUMB_OK;
}
