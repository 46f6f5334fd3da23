// graph.c - which bodies take part, and in what order their contacts are solved.
//
// Bodies in a contact get a slot in the solver's own array: packed rows, in row order. Contacts get
// colours so that no body has two contacts of one colour: each body keeps a mask of the colours it
// has, and a contact takes the first that is free in both. Contacts of one colour fill the lanes of
// bundles; their order does not matter, so the vector width cannot change a result. What finds no
// colour goes one after another, several to a bundle only where no body is shared.
//
// Reads: manifolds, velocities, masses, forces. Writes: solver bodies, lanes. Cost: O(bodies +
// contacts).
#include "world/state.h"

#include <string.h>

#define OVERFLOW_COLOR PL_COLORS

#define DYNAMIC_MASK ((UINT64_C(1) << PL_DYNAMIC_COLORS) - 1)

static const pl_contact_kernels *kernels_of(int width)
{
    switch (width) {
    case 16:
        return &pl_contact_kernels_w16;
    case 8:
        return &pl_contact_kernels_w8;
    default:
        return &pl_contact_kernels_w4;
    }
}

const pl_contact_kernels *pl_solver_kernels(const plumb_world *world)
{
    return kernels_of(world->desc.simd_width);
}

bool pl_solver_tallies(const plumb_world *world)
{
    return world->desc.contact_impulses || world->desc.hit_speed > 0;
}

bool pl_solver_specials(const plumb_world *world)
{
    return world->locked_bodies > 0 || world->tunings.frozen > 0 || world->narrow.any_adhesion;
}

static bool reserve_bodies(plumb_world *world)
{
    pl_solver *s = &world->solver;
    pl_memory *memory = &world->memory;
    size_t rows = (size_t)world->dynamic_count + world->kinematic_count + 1;
    size_t elastic_rows = world->narrow.any_bounce ? rows : 0;
    return pl_buffer_reserve(memory, &s->bodies, rows * sizeof(pl_solver_body)) &&
           pl_buffer_reserve(memory, &s->motions, rows * sizeof(pl_solver_motion)) &&
           pl_buffer_reserve(memory, &s->lows, elastic_rows * 4 * sizeof(near_real)) &&
           pl_buffer_reserve(memory, &s->struck, elastic_rows * sizeof(near_real)) &&
           pl_buffer_reserve(memory, &s->rows, rows * sizeof(uint32_t)) &&
           pl_buffer_reserve(memory, &s->slots, rows * sizeof(uint32_t)) &&
           pl_buffer_reserve(memory, &s->ends,
                             ((size_t)world->narrow.manifold_count + 1) * sizeof(pl_ends)) &&
           pl_buffer_reserve(memory, &s->masks, rows * sizeof(uint64_t)) &&
           pl_buffer_reserve(memory, &s->colors, (size_t)world->narrow.manifold_count + 1);
}

// Every colour can end in a partly filled bundle, and every overflow contact can be alone in one.
static bool reserve_lanes(plumb_world *world, const uint32_t counts[PL_COLORS + 1])
{
    pl_solver *s = &world->solver;
    pl_memory *memory = &world->memory;
    const pl_contact_kernels *k = pl_solver_kernels(world);
    size_t width = (size_t)k->width;
    size_t bundles = counts[OVERFLOW_COLOR];
    for (int c = 0; c < PL_COLORS; ++c) {
        bundles += (counts[c] + width - 1) / width;
    }
    size_t contacts = world->narrow.manifold_count;
    size_t impacts = world->narrow.any_bounce ? contacts : 0;
    size_t specials = pl_solver_specials(world) ? bundles : 0;
    size_t extras =
        world->narrow.any_surface || specials > 0 || pl_solver_tallies(world) ? bundles : 0;
    size_t looked = impacts > 0 && world->desc.solver == PLUMB_SOLVER_SOFT ? bundles * width : 0;
    size_t classic = world->desc.solver == PLUMB_SOLVER_PGS ? contacts : 0;
    return pl_buffer_reserve(memory, &s->lanes, bundles * width * sizeof(uint32_t)) &&
           pl_buffer_reserve(memory, &s->bundles, bundles * k->bundle_size) &&
           pl_buffer_reserve(memory, &s->extras, extras * k->extra_size) &&
           pl_buffer_reserve(memory, &s->specials, specials * k->special_size) &&
           pl_buffer_reserve(memory, &s->impacts, impacts * sizeof(pl_impact)) &&
           pl_buffer_reserve(memory, &s->outlook_fields,
                             looked * PL_OUTLOOK_FIELDS * sizeof(near_real)) &&
           pl_buffer_reserve(memory, &s->outlook_ends, looked * sizeof(pl_outlook_ends)) &&
           pl_buffer_reserve(memory, &s->outlook_open, looked) &&
           pl_buffer_reserve(memory, &s->impact_heap, impacts * sizeof(uint32_t)) &&
           pl_buffer_reserve(memory, &s->impact_heads,
                             (impacts > 0 ? s->dynamic_slots : 0) * sizeof(uint32_t)) &&
           pl_buffer_reserve(memory, &s->classic, classic * sizeof(pl_classic_contact));
}

// What a row is marked with in `slots` before it gets its slot. An elastic body, one in a contact with
// restitution, keeps what rounding takes from its velocity; the others must not, or what one
// island asks for would change the bits of the rest.
enum { ENGAGED, ELASTIC };

// So many manifolds are worth a thread.
#define LEAST 512

static void note_ends(void *context, uint32_t first, uint32_t count)
{
    const plumb_world *world = context;
    const pl_manifold *m = pl_manifolds(&world->narrow);
    pl_ends *ends = world->solver.ends.data;
    for (uint32_t i = first; i < first + count; ++i) {
        ends[i] = (pl_ends){ m[i].body_a, m[i].body_b };
    }
}

// Marks the rows that have a contact or a joint.
static void mark_rows(plumb_world *world, uint32_t movable)
{
    const pl_manifold *m = pl_manifolds(&world->narrow);
    const pl_ends *ends = world->solver.ends.data;
    const uint32_t *first_joint = world->bodies.first_joint;
    uint32_t *slots = world->solver.slots.data;
    memset(slots, 0xff, movable * sizeof(uint32_t));
    for (uint32_t row = 0; world->joints.live > 0 && row < movable; ++row) {
        if (first_joint[row] != PL_NONE) {
            slots[row] = ENGAGED;
        }
    }
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        if (ends[i].a < movable) {
            slots[ends[i].a] = ENGAGED;
        }
        if (ends[i].b < movable) {
            slots[ends[i].b] = ENGAGED;
        }
    }
    for (uint32_t i = 0; world->narrow.any_bounce && i < world->narrow.manifold_count; ++i) {
        if (m[i].restitution > 0) {
            slots[m[i].body_a < movable ? m[i].body_a : m[i].body_b] = ELASTIC;
            slots[m[i].body_b < movable ? m[i].body_b : m[i].body_a] = ELASTIC;
        }
    }
}

// A quad: what rounding took from the velocity so far, and 1 where that is kept, 0 where it is not.
static void start_low(near_real *low, const pl_bodies *b, uint32_t row, bool elastic)
{
    real vx = b->low_vx[row], vy = b->low_vy[row];
    if (PLUMB_IS_FAR) { // the solver's velocity is rounded, too
        vx += b->vx[row] - (near_real)b->vx[row];
        vy += b->vy[row] - (near_real)b->vy[row];
    }
    low[0] = elastic ? (near_real)vx : 0;
    low[1] = elastic ? (near_real)vy : 0;
    low[2] = 0;
    low[3] = elastic;
}

// The slot of a row: its state, packed.
static void engage_row(plumb_world *world, uint32_t row, uint32_t slot)
{
    pl_solver *s = &world->solver;
    const pl_bodies *b = &world->bodies;
    uint32_t *slots = s->slots.data;
    near_real im = (near_real)b->inv_mass[row], ii = (near_real)b->inv_inertia[row];
    real gravity = row < world->dynamic_count ? b->gravity_scale[row] : 0;
    pl_solver_bodies(s)[slot] = (pl_solver_body){ .vx = (near_real)b->vx[row],
                                                  .vy = (near_real)b->vy[row],
                                                  .w = (near_real)b->w[row],
                                                  .inv_mass = im,
                                                  .inv_inertia = ii };
    pl_solver_motions(s)[slot] =
        (pl_solver_motion){ .ax = (near_real)(world->gravity.x * gravity + b->fx[row] * im),
                            .ay = (near_real)(world->gravity.y * gravity + b->fy[row] * im),
                            .aw = (near_real)(b->torque[row] * ii),
                            .ux = (near_real)b->vx[row],
                            .uy = (near_real)b->vy[row],
                            .uw = (near_real)b->w[row],
                            .inv_mass = im };
    if (world->narrow.any_bounce) {
        start_low((near_real *)s->lows.data + (size_t)slot * 4, b, row, slots[row] == ELASTIC);
    }
    if ((b->flags[row] & PL_BODY_ODD) != 0) {
        pl_effects_engage(world, row, slot);
    }
    slots[row] = slot;
    ((uint32_t *)s->rows.data)[slot] = row;
}

typedef struct engagement {
    plumb_world *world;
    uint32_t movable, shares;
    uint32_t first[PLUMB_WORKERS_MAX + 1]; // slot of a share of the rows
} engagement;

static void count_share(void *context, uint32_t i)
{
    engagement *e = context;
    const uint32_t *slots = e->world->solver.slots.data;
    const pl_share rows = pl_share_of(e->movable, e->shares, i);
    uint32_t count = 0;
    for (uint32_t row = rows.first; row < rows.end; ++row) {
        count += slots[row] != PL_NONE;
    }
    e->first[i + 1] = count;
}

static void engage_share(void *context, uint32_t i)
{
    const engagement *e = context;
    const uint32_t *slots = e->world->solver.slots.data;
    const pl_share rows = pl_share_of(e->movable, e->shares, i);
    uint32_t slot = e->first[i];
    for (uint32_t row = rows.first; row < rows.end; ++row) {
        if (slots[row] != PL_NONE) {
            engage_row(e->world, row, slot++);
        }
    }
}

// Gives every dynamic and kinematic row that is in a contact or has a joint its slot and packs its state.
static void engage(plumb_world *world)
{
    pl_solver *s = &world->solver;
    engagement e = { .world = world, .movable = world->dynamic_count + world->kinematic_count };
    e.shares = pl_tasks_share_count(world->tasks, e.movable, PL_BODIES_SHARED);
    pl_tasks_ranges(world->tasks, world->narrow.manifold_count, LEAST, note_ends, world);
    mark_rows(world, e.movable);
    pl_tasks_run(world->tasks, count_share, &e, e.shares);
    for (uint32_t i = 0; i < e.shares; ++i) {
        e.first[i + 1] += e.first[i];
    }
    const uint32_t count = e.first[e.shares];
    pl_tasks_run(world->tasks, engage_share, &e, e.shares);
    uint32_t kinematic = 0; // rows of those are the last
    while (kinematic < count &&
           ((const uint32_t *)s->rows.data)[count - 1 - kinematic] >= world->dynamic_count) {
        ++kinematic;
    }
    s->dynamic_slots = count - kinematic;
    if (world->narrow.any_bounce) {
        memset((near_real *)s->lows.data + (size_t)count * 4, 0, 4 * sizeof(near_real));
    }
    pl_solver_bodies(s)[count] = (pl_solver_body){ 0 };
    pl_solver_motions(s)[count] = (pl_solver_motion){ 0 };
    s->slot_count = count + 1;
}

// The first colour that neither body has; a contact with an immovable body takes one of the last.
static uint32_t color_of(uint64_t taken, bool against_immovable)
{
    uint64_t free = ~taken & (against_immovable ? ~DYNAMIC_MASK : DYNAMIC_MASK);
    return free != 0 ? (uint32_t)__builtin_ctzll(free) : OVERFLOW_COLOR;
}

static void color_contacts(plumb_world *world, uint32_t counts[PL_COLORS + 1])
{
    pl_solver *s = &world->solver;
    const pl_ends *ends = s->ends.data;
    const uint32_t *slots = s->slots.data;
    uint64_t *masks = s->masks.data;
    uint8_t *colors = s->colors.data;
    memset(masks, 0, s->slot_count * sizeof(uint64_t));
    memset(counts, 0, (PL_COLORS + 1) * sizeof(uint32_t));
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        bool a_moves = ends[i].a < world->dynamic_count;
        bool b_moves = ends[i].b < world->dynamic_count;
        uint64_t *mask_a = a_moves ? &masks[slots[ends[i].a]] : NULL;
        uint64_t *mask_b = b_moves ? &masks[slots[ends[i].b]] : NULL;
        uint32_t color =
            color_of((a_moves ? *mask_a : 0) | (b_moves ? *mask_b : 0), !(a_moves && b_moves));
        if (color < OVERFLOW_COLOR) {
            uint64_t bit = UINT64_C(1) << color;
            if (a_moves) {
                *mask_a |= bit;
            }
            if (b_moves) {
                *mask_b |= bit;
            }
        }
        colors[i] = (uint8_t)color;
        ++counts[color];
    }
    s->overflow_count = counts[OVERFLOW_COLOR];
}

// Puts the overflow contacts into bundles in order; a bundle ends where a body would be shared.
static uint32_t place_overflow(plumb_world *world, uint32_t *lanes, uint32_t at, uint32_t width)
{
    pl_solver *s = &world->solver;
    const pl_ends *ends = s->ends.data;
    const uint8_t *colors = s->colors.data;
    uint32_t members[32]; // body rows of the open bundle, at most two a lane
    uint32_t member_count = 0, filled = 0;
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        if (colors[i] != OVERFLOW_COLOR) {
            continue;
        }
        bool shared = false;
        for (uint32_t k = 0; k < member_count; ++k) {
            shared |= members[k] == ends[i].a || members[k] == ends[i].b;
        }
        if (shared || filled == width) {
            at += width;
            member_count = filled = 0;
        }
        lanes[at + filled++] = i;
        if (ends[i].a < world->dynamic_count) {
            members[member_count++] = ends[i].a;
        }
        if (ends[i].b < world->dynamic_count) {
            members[member_count++] = ends[i].b;
        }
    }
    return filled > 0 ? at + width : at;
}

static void place_lanes(plumb_world *world, const uint32_t counts[PL_COLORS + 1])
{
    pl_solver *s = &world->solver;
    uint32_t width = (uint32_t)pl_solver_kernels(world)->width;
    uint32_t at[PL_COLORS];
    uint32_t lane_count = 0;
    s->color_count = 0;
    for (uint32_t c = 0; c < PL_COLORS; ++c) {
        at[c] = lane_count;
        s->color_first[c] = lane_count / width;
        lane_count += (counts[c] + width - 1) / width * width;
        s->color_count += counts[c] > 0;
    }
    s->color_first[OVERFLOW_COLOR] = lane_count / width;
    uint32_t *lanes = s->lanes.data;
    if (lanes == NULL) {
        s->bundle_count = 0; // no contact has ever been made
        return;
    }
    memset(lanes, 0xff,
           ((size_t)lane_count + (size_t)counts[OVERFLOW_COLOR] * width) * sizeof(uint32_t));
    const uint8_t *colors = s->colors.data;
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        if (colors[i] != OVERFLOW_COLOR) {
            lanes[at[colors[i]]++] = i;
        }
    }
    lane_count = place_overflow(world, lanes, lane_count, width);
    s->bundle_count = lane_count / width;
}

bool pl_solver_graph(plumb_world *world)
{
    uint32_t counts[PL_COLORS + 1];
    if (!reserve_bodies(world)) {
        return false;
    }
    engage(world);
    if (world->joints.live > 0 && !pl_joints_plan(world)) {
        return false;
    }
    color_contacts(world, counts);
    if (!reserve_lanes(world, counts)) {
        return false;
    }
    place_lanes(world, counts);
    return true;
}

void pl_solver_free(pl_memory *memory, pl_solver *s)
{
    pl_buffer *buffers[] = {
        &s->bodies,      &s->motions,      &s->rows,           &s->slots,        &s->ends,
        &s->masks,       &s->colors,       &s->lanes,          &s->bundles,      &s->impacts,
        &s->classic,     &s->lows,         &s->struck,         &s->extras,       &s->specials,
        &s->impact_heap, &s->impact_heads, &s->outlook_fields, &s->outlook_ends, &s->outlook_open
    };
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; ++i) {
        pl_buffer_free(memory, buffers[i]);
    }
    *s = (pl_solver){ 0 };
}
