// graph.c - which bodies take part, and in what order their contacts are solved.
//
// Bodies in a contact get a slot in the solver's own array: packed rows, cluster by cluster (cluster.c)
// and in row order. Contacts get colours so that no body has two contacts of one colour: each body
// keeps a mask of the colours it has, and a contact takes the first that is free in both. Contacts of
// one cluster and colour fill the lanes of bundles; their order does not matter, so the vector width
// cannot change a result. What finds no colour goes one after another, several to a bundle only where
// no body is shared.
//
// Reads: manifolds, velocities, masses, forces. Writes: solver bodies, lanes. Cost: O(bodies +
// contacts).
#include "effects/effects.h"
#include "joints/joint.h"
#include "solver/solver.h"
#include "world/state.h"

#include <string.h>

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
    return world->desc.contact_impulses || world->desc.hit_speed > 0 ||
           world->settings.breakable > 0;
}

bool pl_solver_specials(const plumb_world *world)
{
    return world->locked_bodies > 0 || world->settings.frozen > 0 || world->narrow.any_adhesion ||
           world->narrow.any_kinetic;
}

static bool reserve_bodies(plumb_world *world)
{
    pl_solver *s = &world->solver;
    pl_memory *memory = &world->memory;
    size_t rows = (size_t)world->dynamic_count + world->kinematic_count + 1;
    size_t elastic_rows = s->follows_impacts ? rows : 0;
    return pl_buffer_reserve(memory, &s->bodies, rows * sizeof(pl_solver_body)) &&
           pl_buffer_reserve(memory, &s->motions, rows * sizeof(pl_solver_motion)) &&
           pl_buffer_reserve(memory, &s->kicked, rows * 4 * sizeof(near_real)) &&
           pl_buffer_reserve(memory, &s->residuals, elastic_rows * 4 * sizeof(near_real)) &&
           pl_buffer_reserve(memory, &s->struck, elastic_rows * sizeof(near_real)) &&
           pl_buffer_reserve(memory, &s->rows, rows * sizeof(uint32_t)) &&
           pl_buffer_reserve(memory, &s->slots, rows * sizeof(uint32_t)) &&
           pl_buffer_reserve(memory, &s->masks, rows * sizeof(uint64_t)) &&
           pl_buffer_reserve(memory, &s->colors, (size_t)world->narrow.manifold_count + 1);
}

typedef struct needs {
    size_t lanes, bundles; // of all clusters; that the threads need
} needs;

// Every colour of a cluster can end in a partly filled bundle, and every overflow contact can be alone in
// one.
static needs needs_of(plumb_world *world, uint32_t width)
{
    pl_solver *s = &world->solver;
    const uint32_t *counts = s->cursors.data;
    size_t sum = 0, most = 0;
    for (uint32_t i = 0; i < s->cluster_count; ++i, counts += PL_COLOR_SLOTS) {
        size_t bundles = counts[PL_OVERFLOW_COLOR];
        for (uint64_t colors = s->colors_used; colors != 0; colors &= colors - 1) {
            bundles += (counts[__builtin_ctzll(colors)] + width - 1) / width;
        }
        sum += bundles;
        most = bundles > most ? bundles : most;
    }
    s->bundle_room = (uint32_t)most;
    const uint32_t threads = pl_tasks_share_count(world->tasks, s->cluster_count, 1);
    return (needs){ sum * width, most * threads };
}

static bool reserve_lanes(plumb_world *world)
{
    pl_solver *s = &world->solver;
    pl_memory *memory = &world->memory;
    const pl_contact_kernels *k = pl_solver_kernels(world);
    const needs need = needs_of(world, (uint32_t)k->width);
    size_t contacts = world->narrow.manifold_count;
    size_t impacts = s->follows_impacts ? contacts : 0;
    size_t rubbed = pl_solver_tallies(world) ? 2 * (contacts + world->narrow.borne_count) : 0;
    size_t bounces = world->narrow.any_low ? need.bundles : 0;
    size_t turnings = world->desc.solver == PLUMB_SOLVER_SOFT && s->turning ? need.bundles : 0;
    size_t specials = pl_solver_specials(world) ? need.bundles : 0;
    size_t grips = world->narrow.any_kinetic ? need.bundles : 0;
    size_t extras =
        world->narrow.any_surface || specials > 0 || pl_solver_tallies(world) ? need.bundles : 0;
    size_t classic = world->desc.solver != PLUMB_SOLVER_SOFT ? contacts : s->hard_count;
    return pl_buffer_reserve(memory, &s->lanes, need.lanes * sizeof(uint32_t)) &&
           pl_buffer_reserve(memory, &s->bundles, need.bundles * k->bundle_size) &&
           pl_buffer_reserve(memory, &s->extras, extras * k->extra_size) &&
           pl_buffer_reserve(memory, &s->specials, specials * k->special_size) &&
           pl_buffer_reserve(memory, &s->grips, grips * k->grip_size) &&
           pl_buffer_reserve(memory, &s->turnings, turnings * k->turning_size) &&
           pl_buffer_reserve(memory, &s->impacts, impacts * sizeof(pl_impact)) &&
           pl_buffer_reserve(memory, &s->bounces, bounces * k->bounce_size) &&
           pl_buffer_reserve(memory, &s->rubbed, rubbed * sizeof(near_real)) &&
           pl_buffer_reserve(memory, &s->impact_heap, impacts * sizeof(uint32_t)) &&
           pl_buffer_reserve(memory, &s->impact_heads,
                             (impacts > 0 ? s->dynamic_slots : 0) * sizeof(uint32_t)) &&
           pl_buffer_reserve(memory, &s->classic, classic * sizeof(pl_classic_contact));
}

// So many manifolds are worth a thread.
#define LEAST 512

static void note_ends(void *context, uint32_t first, uint32_t count)
{
    const plumb_world *world = context;
    const pl_manifold *m = pl_manifolds(&world->narrow);
    pl_ends *ends = world->narrow.ends.data;
    for (uint32_t i = first; i < first + count; ++i) {
        ends[i] = (pl_ends){ m[i].body_a, m[i].body_b };
    }
}

// Whether impacts of a contact are followed as events. The classic solver has no lanes in which the others strike.
static bool is_followed(const plumb_world *world, near_real restitution)
{
    return pl_is_elastic(restitution) ||
           (restitution > 0 && world->desc.solver != PLUMB_SOLVER_SOFT);
}

// Marks the rows that have a contact or a joint.
static void mark_rows(plumb_world *world, uint32_t movable)
{
    const pl_manifold *m = pl_manifolds(&world->narrow);
    const pl_ends *ends = world->narrow.ends.data;
    const uint32_t *first_joint = world->bodies.first_joint;
    const pl_solver *s = &world->solver;
    uint32_t *slots = s->slots.data;
    memset(slots, 0xff, movable * sizeof(uint32_t));
    for (uint32_t row = 0; world->joints.live > 0 && row < movable; ++row) {
        if (first_joint[row] != PL_NONE) {
            slots[row] = PL_ACTIVE;
        }
    }
    const uint8_t *called = world->effects.called.data;
    for (uint32_t row = 0; world->effects.any_called && row < world->dynamic_count; ++row) {
        if (called[row] != 0) {
            slots[row] = PL_ACTIVE;
        }
    }
    for (uint32_t i = 0; i < world->narrow.manifold_count; ++i) {
        if (ends[i].a < movable) {
            slots[ends[i].a] = PL_ACTIVE;
        }
        if (ends[i].b < movable) {
            slots[ends[i].b] = PL_ACTIVE;
        }
    }
    for (uint32_t i = 0; s->follows_impacts && i < world->narrow.manifold_count; ++i) {
        if (is_followed(world, m[i].restitution)) {
            slots[m[i].body_a < movable ? m[i].body_a : m[i].body_b] = PL_ELASTIC;
            slots[m[i].body_b < movable ? m[i].body_b : m[i].body_a] = PL_ELASTIC;
        }
    }
}

static inline uint32_t cluster_of(const uint32_t *labels, uint32_t row)
{
    return labels == NULL ? 0 : labels[row];
}

// Slots from `at` on for those rows that are active, cluster by cluster and in order; `kind` 0: they are
// dynamic, 1: kinematic. Returns the slot behind the last.
static uint32_t give_slots(plumb_world *world, pl_share rows, int kind, uint32_t at)
{
    pl_solver *s = &world->solver;
    pl_cluster *clusters = pl_clusters(s);
    const uint32_t *labels = pl_solver_labels(s);
    uint32_t *slots = s->slots.data, *row_of = s->rows.data;
    near_real *residuals = s->follows_impacts ? s->residuals.data : NULL;
    for (uint32_t row = rows.first; labels != NULL && row < rows.end; ++row) {
        if (slots[row] != PL_NONE) {
            ++clusters[cluster_of(labels, row)].slots[kind].count;
        }
    }
    for (uint32_t i = 0; i < s->cluster_count; ++i) {
        pl_slots *mine = &clusters[i].slots[kind];
        mine->first = at;
        at += mine->count;
        mine->count = 0;
    }
    for (uint32_t row = rows.first; row < rows.end; ++row) {
        if (slots[row] != PL_NONE) {
            pl_slots *mine = &clusters[cluster_of(labels, row)].slots[kind];
            const uint32_t slot = mine->first + mine->count++;
            if (residuals != NULL) {
                residuals[(size_t)slot * 4 + 3] = slots[row] == PL_ELASTIC;
            }
            slots[row] = slot;
            row_of[slot] = row;
        }
    }
    const pl_slots last = clusters[s->cluster_count - 1].slots[kind];
    return last.first + last.count;
}

// What a near_real does not hold of a number. Not inlined: of two of these side by side GCC 12 makes a vector, and in it
// takes the conversion there and back for none.
static __attribute__((noinline, unused)) real rounded_off(real v)
{
    return v - (near_real)v;
}

// A quad: what rounding took from the velocity so far, and 1 where that is kept, 0 where it is not.
static void start_low(near_real *low, const pl_bodies *b, uint32_t row)
{
    real vx = b->residual_vx[row], vy = b->residual_vy[row];
    if (PLUMB_IS_FAR) { // the solver's velocity is rounded, too
        vx += rounded_off(b->vx[row]);
        vy += rounded_off(b->vy[row]);
    }
    low[0] = low[3] != 0 ? (near_real)vx : 0;
    low[1] = low[3] != 0 ? (near_real)vy : 0;
    low[2] = 0;
}

// The state of the row of a slot, packed.
static void fill_slot(plumb_world *world, uint32_t slot)
{
    pl_solver *s = &world->solver;
    const pl_bodies *b = &world->bodies;
    const uint32_t row = ((const uint32_t *)s->rows.data)[slot];
    near_real im = (near_real)b->inv_mass[row], ii = (near_real)b->inv_inertia[row];
    real gravity = row < world->dynamic_count ? b->gravity_scale[row] : 0;
    pl_solver_bodies(s)[slot] = (pl_solver_body){ .vx = (near_real)b->vx[row],
                                                  .vy = (near_real)b->vy[row],
                                                  .w = (near_real)b->w[row],
                                                  .inv_mass = im,
                                                  .inv_inertia = ii };
    pl_solver_motions(s)[slot] =
        (pl_solver_motion){ .ax = (near_real)(world->effects.gravity.x * gravity + b->fx[row] * im),
                            .ay = (near_real)(world->effects.gravity.y * gravity + b->fy[row] * im),
                            .aw = (near_real)(b->torque[row] * ii),
                            .ux = (near_real)b->vx[row],
                            .uy = (near_real)b->vy[row],
                            .uw = (near_real)b->w[row],
                            .inv_mass = im };
    pl_soft_share(world, row, slot);
    if (s->follows_impacts) {
        start_low((near_real *)s->residuals.data + (size_t)slot * 4, b, row);
    }
    if ((b->flags[row] & world->effects.gathered) != 0) {
        pl_effects_gather(world, row, slot);
    }
}

static void fill_slots(void *context, uint32_t first, uint32_t count)
{
    for (uint32_t slot = first; slot < first + count; ++slot) {
        fill_slot(context, slot);
    }
}

// Gives every dynamic and kinematic row that is in a contact or has a joint its slot and packs its state.
static void fill_bodies(plumb_world *world)
{
    pl_effects_open(world);
    pl_solver *s = &world->solver;
    const uint32_t dynamic = world->dynamic_count, movable = dynamic + world->kinematic_count;
    memset(s->clusters.data, 0, s->cluster_count * sizeof(pl_cluster));
    s->dynamic_slots = give_slots(world, (pl_share){ 0, dynamic }, 0, 0);
    const uint32_t count = give_slots(world, (pl_share){ dynamic, movable }, 1, s->dynamic_slots);
    pl_tasks_ranges(world->tasks, count, PL_BODIES_SHARED, fill_slots, world);
    if (s->follows_impacts) {
        memset((near_real *)s->residuals.data + (size_t)count * 4, 0, 4 * sizeof(near_real));
    }
    pl_solver_bodies(s)[count] = (pl_solver_body){ 0 };
    pl_solver_motions(s)[count] = (pl_solver_motion){ 0 };
    s->slot_count = count + 1;
}

// The first colour that neither body has; a contact with an immovable body takes one of the last.
static uint32_t color_of(uint64_t taken, bool against_immovable)
{
    uint64_t free = ~taken & (against_immovable ? ~DYNAMIC_MASK : DYNAMIC_MASK);
    return free != 0 ? (uint32_t)__builtin_ctzll(free) : PL_OVERFLOW_COLOR;
}

// What contacts are sorted by.
typedef struct sorter {
    uint32_t dynamic; // rows
    const uint32_t *labels;
    uint32_t *cursors;
} sorter;

static sorter sorter_of(const plumb_world *world)
{
    const pl_solver *s = &world->solver;
    return (sorter){ world->dynamic_count, pl_solver_labels(s), s->cursors.data };
}

static inline uint32_t *cursor_of(sorter by, pl_ends ends, uint32_t color)
{
    const uint32_t cluster = cluster_of(by.labels, ends.a < by.dynamic ? ends.a : ends.b);
    return &by.cursors[(size_t)cluster * PL_COLOR_SLOTS + color];
}

static void color_contacts(plumb_world *world)
{
    pl_solver *s = &world->solver;
    const sorter by = sorter_of(world);
    const pl_ends *ends = world->narrow.ends.data;
    const uint32_t *slots = s->slots.data, count = world->narrow.manifold_count;
    uint64_t *masks = s->masks.data;
    uint8_t *colors = s->colors.data;
    memset(masks, 0, s->slot_count * sizeof(uint64_t));
    memset(by.cursors, 0, s->cluster_count * PL_COLOR_SLOTS * sizeof(uint32_t));
    uint64_t used = 0;
    for (uint32_t i = 0; i < count; ++i) {
        bool a_moves = ends[i].a < by.dynamic;
        bool b_moves = ends[i].b < by.dynamic;
        uint64_t *mask_a = a_moves ? &masks[slots[ends[i].a]] : NULL;
        uint64_t *mask_b = b_moves ? &masks[slots[ends[i].b]] : NULL;
        uint32_t color =
            color_of((a_moves ? *mask_a : 0) | (b_moves ? *mask_b : 0), !(a_moves && b_moves));
        if (color < PL_OVERFLOW_COLOR) {
            uint64_t bit = UINT64_C(1) << color;
            used |= bit;
            if (a_moves) {
                *mask_a |= bit;
            }
            if (b_moves) {
                *mask_b |= bit;
            }
        }
        colors[i] = (uint8_t)color;
        ++*cursor_of(by, ends[i], color);
    }
    s->colors_used = used;
}

// Where the bundles of each cluster and colour begin; counts of contacts become places of their lanes.
// Overflow contacts get a bundle each: they are put at the end of those first. Returns the bundles.
static uint32_t divide_lanes(plumb_world *world, uint32_t width)
{
    pl_solver *s = &world->solver;
    uint32_t *cursors = s->cursors.data, all = 0;
    s->overflow_count = 0;
    for (uint32_t i = 0; i < s->cluster_count; ++i, cursors += PL_COLOR_SLOTS) {
        pl_cluster *cluster = &pl_clusters(s)[i];
        uint32_t *first = cluster->color_first, bundles = 0;
        cluster->first_lane = (size_t)all * width;
        for (uint32_t c = 0; c < PL_COLORS; ++c) {
            first[c] = bundles;
            if ((s->colors_used >> c & 1) != 0) {
                bundles += (cursors[c] + width - 1) / width;
                cursors[c] = (all + first[c]) * width;
            }
        }
        const uint32_t overflow = cursors[PL_OVERFLOW_COLOR];
        first[PL_OVERFLOW_COLOR] = bundles;
        first[PL_COLOR_SLOTS] = bundles += overflow;
        all += bundles;
        cursors[PL_OVERFLOW_COLOR] = all * width - overflow;
        s->overflow_count += overflow;
    }
    return all;
}

// Puts the overflow contacts of a cluster, which are at the end of its lanes, into bundles in order; a
// bundle ends where a body would be shared. None reaches the contacts that are still to be read.
static void pack_overflow(plumb_world *world, pl_cluster *cluster, uint32_t count, uint32_t width)
{
    const pl_ends *ends = world->narrow.ends.data;
    uint32_t *lanes = (uint32_t *)world->solver.lanes.data + cluster->first_lane;
    uint32_t *end = &cluster->color_first[PL_COLOR_SLOTS];
    const uint32_t *from = &lanes[(size_t)*end * width - count];
    uint32_t members[32]; // body rows of the open bundle, at most two a lane
    uint32_t member_count = 0, filled = width;
    *end = cluster->color_first[PL_OVERFLOW_COLOR];
    for (uint32_t k = 0; k < count; ++k) {
        const uint32_t contact = from[k];
        const pl_ends e = ends[contact];
        bool shared = false;
        for (uint32_t m = 0; m < member_count; ++m) {
            shared |= members[m] == e.a || members[m] == e.b;
        }
        if (shared || filled == width) {
            memset(&lanes[(size_t)(*end)++ * width], 0xff, width * sizeof(uint32_t));
            member_count = filled = 0;
        }
        lanes[(size_t)(*end - 1) * width + filled++] = contact;
        if (e.a < world->dynamic_count) {
            members[member_count++] = e.a;
        }
        if (e.b < world->dynamic_count) {
            members[member_count++] = e.b;
        }
    }
}

static void place_lanes(plumb_world *world)
{
    pl_solver *s = &world->solver;
    const uint32_t width = (uint32_t)pl_solver_kernels(world)->width;
    const uint32_t bundles = divide_lanes(world, width);
    const pl_ends *ends = world->narrow.ends.data;
    const uint8_t *colors = s->colors.data;
    uint32_t *lanes = s->lanes.data;
    s->bundle_count = s->bounce_count = s->chain_count = 0;
    if (bundles == 0) {
        return; // there may be no lanes
    }
    memset(lanes, 0xff, (size_t)bundles * width * sizeof(uint32_t));
    const sorter by = sorter_of(world);
    const uint32_t count = world->narrow.manifold_count;
    for (uint32_t i = 0; i < count; ++i) {
        lanes[(*cursor_of(by, ends[i], colors[i]))++] = i;
    }
    for (uint32_t i = 0; i < s->cluster_count && s->overflow_count > 0; ++i) {
        pl_cluster *cluster = &pl_clusters(s)[i];
        const uint32_t *first = cluster->color_first;
        pack_overflow(world, cluster, first[PL_COLOR_SLOTS] - first[PL_OVERFLOW_COLOR], width);
    }
    s->bundle_count = pl_clusters(s)->color_first[PL_COLOR_SLOTS];
}

static bool find_turning(const plumb_world *world, real dt)
{
    const pl_solver *s = &world->solver;
    const pl_solver_body *b = pl_solver_bodies(s);
    const near_real turn = PL_LEAST_TURN / (near_real)dt, way = PL_LEAST_WAY / (near_real)dt;
    for (uint32_t i = 0; i + 1 < s->slot_count; ++i) {
        if (b[i].w > turn || b[i].w < -turn || b[i].vx * b[i].vx + b[i].vy * b[i].vy > way * way) {
            return true;
        }
    }
    return false;
}

bool pl_solver_open(plumb_world *world)
{
    const pl_narrow *narrow = &world->narrow;
    world->solver.follows_impacts =
        narrow->any_elastic || (narrow->any_low && world->desc.solver != PLUMB_SOLVER_SOFT);
    if (!reserve_bodies(world)) {
        return false;
    }
    if (world->narrow.ends_stale) {
        pl_tasks_ranges(world->tasks, world->narrow.manifold_count, LEAST, note_ends, world);
    }
    mark_rows(world, world->dynamic_count + world->kinematic_count);
    return pl_joints_look(world) && pl_solver_cluster(world);
}

static bool reserve_clusters(plumb_world *world)
{
    pl_solver *s = &world->solver;
    // A small world has one, and may have fine and hard islands at any time: it is not to allocate then.
    const uint32_t least = world->desc.no_fine_islands ? 1 : 3;
    const size_t count = s->cluster_count > least ? s->cluster_count : least;
    return pl_buffer_reserve(&world->memory, &s->clusters, count * sizeof(pl_cluster)) &&
           pl_buffer_reserve(&world->memory, &s->cursors,
                             count * PL_COLOR_SLOTS * sizeof(uint32_t));
}

bool pl_solver_graph(plumb_world *world, real dt)
{
    if (!reserve_clusters(world)) {
        return false;
    }
    fill_bodies(world);
    if (!pl_joints_plan(world)) {
        return false;
    }
    color_contacts(world);
    pl_assemblies_share(world);
    world->solver.turning = world->desc.solver == PLUMB_SOLVER_SOFT && find_turning(world, dt);
    if (!reserve_lanes(world)) {
        return false;
    }
    if (world->solver.rubbed.size > 0 && pl_solver_tallies(world)) {
        memset(world->solver.rubbed.data, 0, world->solver.rubbed.size);
    }
    place_lanes(world);
    return true;
}

void pl_solver_free(pl_memory *memory, pl_solver *s)
{
    pl_buffer *buffers[] = {
        &s->bodies,       &s->motions, &s->rows,          &s->slots,         &s->masks,
        &s->colors,       &s->lanes,   &s->bundles,       &s->impacts,       &s->classic,
        &s->residuals,    &s->struck,  &s->extras,        &s->specials,      &s->impact_heap,
        &s->impact_heads, &s->bounces, &s->clusters,      &s->labels,        &s->islands,
        &s->homes,        &s->leaders, &s->cursors,       &s->rubbed,        &s->turnings,
        &s->kicked,       &s->grips,   &s->hard_contacts, &s->apart_leaders, &s->apart_tallies
    };
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; ++i) {
        pl_buffer_free(memory, buffers[i]);
    }
    *s = (pl_solver){ 0 };
}
