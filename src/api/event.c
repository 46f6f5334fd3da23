// event.c - the last step's events and contacts, read.
//
// Contacts are kept as manifolds of the narrow phase, made before the bodies moved: their points
// and separations are carried along with the bodies here, when somebody asks. Pieces may have been
// destroyed since the step; pairs of such pieces, or of slots taken anew, are passed over.
//
// Reads: pairs, manifolds, centres, solver bodies (how far each turned in the step). Writes:
// nothing. Cost: events O(1); contacts O(pairs).
#include "api/listed.h"
#include "event/event.h"
#include "solver/solver.h"
#include "world/island.h"
#include "plumb/event.h"
#include "world/check.h"
#include "world/rows.h"
#include "world/wrap.h"

#define EVENTS(type, name, items, number)                                                          \
    PL_LISTED(type, plumb_world_##name##_events, items, number)

EVENTS(plumb_contact_begin, begin, world->begin_events.data, world->begin_count)
EVENTS(plumb_contact_end, end, world->end_events.data, world->end_count)
EVENTS(plumb_contact_hit, hit, world->hit_events.data, world->hit_count)
EVENTS(plumb_quarantine, quarantine, world->quarantine.events, world->quarantine.event_count)
EVENTS(plumb_sensor_event, sensor_begin, world->sensing.begins.data, world->sensing.begin_count)
EVENTS(plumb_sensor_event, sensor_end, world->sensing.ends.data, world->sensing.end_count)
EVENTS(plumb_body, sleep, world->sleep.sleep_events.data, world->sleep.sleep_event_count)
EVENTS(plumb_body, wake, world->sleep.wake_events.data, world->sleep.wake_event_count)
EVENTS(plumb_joint_strain, joint_strain,
       (const plumb_joint_strain *)world->joints.broken.data + world->joints.strained_first,
       world->joints.strained_count)
EVENTS(plumb_joint_break, joint_break, world->joints.broken.data, world->joints.broken_count)

plumb_result plumb_world_set_hit_speed(plumb_world *world, plumb_real speed)
{
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(pl_check_range(world, __func__, "speed", speed, 0, PLUMB_REAL_MAX));
    world->desc.hit_speed = speed;
    world->schedule_dirty = true; // impulses are added up for it
    world->pending_hits.count =
        speed > 0 ? world->pending_hits.count : 0; // nobody asks for them any more
    return PLUMB_OK;
}

// [rad] by which a row turned in the last step, as the solver left it.
static real turn_of(const plumb_world *world, uint32_t row)
{
    if (world->rows_moved || row >= world->dynamic_count || world->solver.slot_count == 0) {
        return 0;
    }
    uint32_t slot = ((const uint32_t *)world->solver.slots.data)[row];
    return slot == PL_NONE ? 0 : pl_solver_bodies(&world->solver)[slot].da;
}

// Where a body's side of a point is now, its lever arm having turned with the body.
static plumb_vec2 carried(const plumb_world *world, uint32_t row, real ax, real ay)
{
    plumb_vec2 arm = { ax, ay };
    real turn = turn_of(world, row);
    if (turn != 0) {
        arm = plumb_rot_apply(plumb_rot_make(turn), arm);
    }
    return plumb_v2(world->bodies.center_x[row] + arm.x, world->bodies.center_y[row] + arm.y);
}

// [N s] along the tangent over the step. At rest, all substeps are alike.
static plumb_real rubbed(const plumb_world *world, const pl_manifold *m, const pl_pair *pair,
                         uint32_t k)
{
    const pl_narrow *narrow = &world->narrow;
    const pl_manifold *first = pl_manifolds(narrow);
    const size_t at = (size_t)(m - first), size = world->solver.rubbed.size / sizeof(near_real);
    if (!pl_solver_tallies(world)) {
        return 0;
    }
    if (first == NULL || m < first || m >= first + narrow->manifold_count + narrow->borne_count) {
        return pair->tangent[k] * (near_real)world->desc.substeps;
    }
    return world->solver.slot_count > 0 && 2 * at + k < size
               ? ((const near_real *)world->solver.rubbed.data)[2 * at + k]
               : 0;
}

static plumb_contact_point view_point(const plumb_world *world, const pl_manifold *m,
                                      const pl_pair *pair, uint32_t k, uint32_t row_a,
                                      uint32_t row_b)
{
    const pl_manifold_point *p = &m->point[k];
    plumb_vec2 a = carried(world, row_a, p->ax, p->ay);
    plumb_vec2 b = pl_wrap_point(world, carried(world, row_b, p->bx, p->by), a);
    // Each lies on its surface: the way from one to the other, along the normal, is the separation.
    plumb_vec2 gap = plumb_vec2_sub(b, a);
    return (plumb_contact_point){
        .point = plumb_vec2_lerp(a, b, (plumb_real)0.5),
        .separation = m->nx * gap.x + m->ny * gap.y,
        .normal_impulse = pair->normal[k],
        .tangent_impulse = pair->tangent[k],
        .step_impulse = pl_solver_tallies(world) ? p->total : 0,
        .step_tangent_impulse = rubbed(world, m, pair, k),
        .feature = m->feature[k],
    };
}

// True while both pieces are those that the pair was made for, and enabled.
static bool is_intact(const plumb_world *world, const pl_pair *pair)
{
    const pl_pieces *p = &world->pieces;
    return p->kind[pair->a] != PL_PIECE_FREE && p->serial[pair->a] <= world->broad.serial &&
           p->kind[pair->b] != PL_PIECE_FREE && p->serial[pair->b] <= world->broad.serial &&
           p->moving[pair->a] != PL_OUT && p->moving[pair->b] != PL_OUT;
}

static plumb_contact view_contact(const plumb_world *world, const pl_pair *pair,
                                  const pl_manifold *m)
{
    const pl_pieces *pieces = &world->pieces;
    uint32_t row_a = pieces->body[pair->a];
    uint32_t row_b = pieces->body[pair->b];
    plumb_contact contact = {
        .shape_a = pieces->shape[pair->a],
        .shape_b = pieces->shape[pair->b],
        .body_a = world->bodies.entity[row_a],
        .body_b = world->bodies.entity[row_b],
        .normal = { m->nx, m->ny },
        .friction = m->friction,
        .restitution = m->restitution,
        .point_count = (int)m->count,
    };
    for (uint32_t k = 0; k < m->count; ++k) {
        contact.points[k] = view_point(world, m, pair, k, row_a, row_b);
    }
    return contact;
}

// What is listed: `count` of all, of which the first `capacity` are told.
typedef struct listing {
    const plumb_world *world;
    uint32_t row; // of whose contacts; PL_NONE: of all bodies
    plumb_contact *contacts;
    int capacity, count;
} listing;

static void list_one(listing *l, const pl_pair *pair, const pl_manifold *m)
{
    if (l->contacts != NULL && l->count < l->capacity) {
        l->contacts[l->count] = view_contact(l->world, pair, m);
    }
    ++l->count;
}

static bool is_of_row(const listing *l, const pl_pair *pair)
{
    const uint32_t *body = l->world->pieces.body;
    return l->row == PL_NONE || body[pair->a] == l->row || body[pair->b] == l->row;
}

static void list_sleeping(listing *l, const pl_sleeping_contact *c)
{
    if ((c->pair.flags & PL_PAIR_TOUCHING) && (c->whole || c->recalled) &&
        pl_sleeping_contact_is_intact(l->world, c) && is_of_row(l, &c->pair)) {
        list_one(l, &c->pair, c->whole ? &c->manifold : &c->last);
    }
}

// The contacts of an island that sleeps: nothing has moved since.
static void list_island(listing *l, uint32_t island)
{
    const pl_sleeping_contact *all = pl_sleeping_contacts(&l->world->sleep);
    const pl_island *at = &pl_islands(&l->world->sleep)[island];
    for (uint32_t i = at->body_count > 0 ? at->first_contact : PL_NONE; i != PL_NONE;
         i = all[i].next) {
        list_sleeping(l, &all[i]);
    }
}

// Of a body that is not asleep, with those that are. What is due to wake may have been asleep with it: until then it is not listed
// by the piece.
static void list_sleepers_at(listing *l)
{
    const pl_pieces *pieces = &l->world->pieces;
    const pl_sleeping_contact *all = pl_sleeping_contacts(&l->world->sleep);
    const pl_island *islands = pl_islands(&l->world->sleep);
    for (uint32_t p = l->world->bodies.first_piece[l->row]; p != PL_NONE;
         p = pieces->next_in_body[p]) {
        for (uint32_t i = pieces->first_sleeping[p]; i != PL_NONE; i = all[i].fixed_next) {
            if (islands[all[i].island].body_count > 0 && !islands[all[i].island].due) {
                list_sleeping(l, &all[i]);
            }
        }
    }
    for (uint32_t i = l->world->sleep.first_due; i != PL_NONE; i = islands[i].next_due) {
        list_island(l, i);
    }
}

static void list_awake(listing *l)
{
    const plumb_world *world = l->world;
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    const uint32_t made = world->narrow.manifold_count + world->narrow.borne_count;
    const uint32_t *places = NULL;
    uint32_t count = world->broad.pairs.count;
    if (l->row != PL_NONE) {
        (void)pl_contact_index_of(world, world->bodies.entity[l->row], &places, &count);
    }
    for (uint32_t i = 0; i < count; ++i) {
        const pl_pair *pair = &pairs[places != NULL ? places[i] : i];
        // Pairs of a step without collision still name manifolds that are gone.
        if (is_of_row(l, pair) && (pair->flags & PL_PAIR_TOUCHING) && pair->manifold < made &&
            is_intact(world, pair)) {
            list_one(l, pair, &pl_manifolds(&world->narrow)[pair->manifold]);
        }
    }
}

int plumb_world_contacts(const plumb_world *world, plumb_contact *contacts, int capacity)
{
    if (world == NULL) {
        return 0;
    }
    listing l = { world, PL_NONE, contacts, capacity, 0 };
    list_awake(&l);
    for (uint32_t i = 0; i < world->sleep.island_slots; ++i) {
        list_island(&l, i);
    }
    return l.count;
}

int plumb_body_contacts(const plumb_world *world, plumb_body body, plumb_contact *contacts,
                        int capacity)
{
    uint32_t row = pl_ask_body(world, __func__, body);
    if (row == PL_NONE) {
        return 0;
    }
    listing l = { world, row, contacts, capacity, 0 };
    const uint32_t island = world->bodies.island[row];
    list_awake(&l); // what was put to sleep since the last step has them there
    if (island != PL_NONE) {
        list_island(&l, island);
    } else {
        list_sleepers_at(&l);
    }
    return l.count;
}
