// check_links.c - see check.h: what ties rows together: joints, islands asleep, contacts, internal edges, and the lists of
// what few bodies have.
//
// Reads: the image. Writes: marks. Cost: O(state), each list walked once.
#include "joints/joint.h"
#include "world/joint_list.h"
#include "snapshot/check.h"
#include "world/check.h"
#include "broad/pairs.h"
#include "core/sort.h"
#include "internal_edges/cone.h"
#include "world/rows.h"

#include <string.h>

#define TURNS_MOST 1000000000 // of a joint's body: a step adds one

// Members that must be finite, or 0 and 1.
#define CHECK_REALS(path) pl_are_reals(&(path), sizeof(path) / (sizeof(real)))
#define CHECK_NEAR(path)  pl_are_near_reals(&(path), sizeof(path) / (sizeof(near_real)))
#define CHECK_BOOL(path)  pl_are_bools(&(path), 1)

//---- joints --------------------------------------------------------------------------------------

static bool is_end(const pl_suspect *s, const pl_joint_end *e)
{
    const bool world = plumb_is_null(e->body);
    return (world || pl_suspect_row(s, e->body) != PL_NONE) && CHECK_REALS(e->local) &&
           e->start - e->start == 0 && e->turns <= TURNS_MOST && e->turns >= -TURNS_MOST &&
           e->eighth < 8 && (e->next == PL_NONE || e->next < s->world.joints.count);
}

static bool check_joint_desc(const plumb_joint_desc *d)
{
    return pl_desc_is_sound(PLUMB_TABLE_JOINT, d) && (!d->enable_limit || d->lower <= d->upper) &&
           (d->kind != PLUMB_RATCHET || d->pitch != 0) && (d->kind != PLUMB_PULLEY || d->ratio > 0);
}

static bool check_joint(const pl_suspect *s, const pl_joint *j)
{
    return CHECK_BOOL(j->desc.enable_limit) && CHECK_BOOL(j->desc.enable_motor) &&
           CHECK_BOOL(j->desc.disabled) && CHECK_BOOL(j->desc.tell_impulse) &&
           CHECK_BOOL(j->desc.collide_connected) && (int)j->desc.kind >= 0 &&
           (int)j->desc.kind < pl_joint_class_count && check_joint_desc(&j->desc) &&
           is_end(s, &j->a) && is_end(s, &j->b) && !plumb_same(j->a.body, j->b.body) &&
           CHECK_REALS(j->impulse) && CHECK_REALS(j->h) && j->h >= 0 && CHECK_REALS(j->force) &&
           j->strained <= 1 && CHECK_REALS(j->torque) && CHECK_REALS(j->told_impulse) &&
           CHECK_REALS(j->told_turn) && CHECK_REALS(j->axis) && CHECK_REALS(j->target) &&
           CHECK_REALS(j->sum) && plumb_same(j->desc.body_a, j->a.body) &&
           plumb_same(j->desc.body_b, j->b.body);
}

// Each end of a joint is in the list of its body once.
static bool check_joint_lists(const pl_suspect *s, uint32_t ends)
{
    const plumb_world *w = &s->world;
    uint32_t steps = 0;
    for (uint32_t row = 0; row < w->bodies.table.count; ++row) {
        const plumb_body body = w->bodies.entity[row];
        for (uint32_t i = w->bodies.first_joint[row]; i != PL_NONE;) {
            const pl_joint *j = pl_suspect_joint(s, i);
            const bool at_a = plumb_same(j->a.body, body), at_b = plumb_same(j->b.body, body);
            if (plumb_is_null(j->entity) || at_a == at_b || steps++ == ends) {
                return false;
            }
            i = at_a ? j->a.next : j->b.next;
        }
    }
    return steps == ends;
}

bool pl_check_joints(pl_suspect *s)
{
    const pl_joints *joints = &s->world.joints;
    uint32_t live = 0, ends = 0, watched = 0, bouncing = 0, steps = 0;
    for (uint32_t i = 0; i < joints->count; ++i) {
        const pl_joint *j = pl_suspect_joint(s, i);
        if (plumb_is_null(j->entity)) {
            continue;
        }
        const pl_slot *slot = pl_registry_find(&s->world.registry, j->entity.entity);
        if (slot == NULL || slot->kind != PLUMB_KIND_JOINT || slot->row != i ||
            !check_joint(s, j)) {
            return false;
        }
        ++live;
        ends += (plumb_is_null(j->a.body) ? 0u : 1u) + (plumb_is_null(j->b.body) ? 0u : 1u);
        watched += pl_joint_is_watched(&j->desc);
        bouncing += pl_joint_bounces(&j->desc);
    }
    for (uint32_t i = joints->free_head; i != PL_NONE; i = pl_suspect_joint(s, i)->a.next) {
        if (i >= joints->count || !plumb_is_null(pl_suspect_joint(s, i)->entity) ||
            steps++ == joints->count - live) {
            return false;
        }
    }
    return live == joints->live && steps == joints->count - live && watched == joints->watched &&
           bouncing == joints->bouncing && check_joint_lists(s, ends);
}

//---- sleep ---------------------------------------------------------------------------------------

// The bodies of an island: a list through registry slots, there and back.
static bool check_sleepers(const pl_suspect *s, uint32_t island, uint32_t *seen)
{
    const plumb_world *w = &s->world;
    const pl_island *i = pl_suspect_island(s, island);
    uint32_t before = PL_NONE, count = 0;
    for (uint32_t slot = i->first_body; slot != PL_NONE;) {
        if (slot >= w->registry.count || w->registry.slots[slot].state != PL_SLOT_LIVE ||
            w->registry.slots[slot].kind != PLUMB_KIND_BODY || count++ == i->body_count) {
            return false;
        }
        const uint32_t row = w->registry.slots[slot].row;
        if (w->bodies.island[row] != island || w->bodies.previous_asleep[row] != before) {
            return false;
        }
        before = slot;
        slot = w->bodies.next_asleep[row];
    }
    *seen += count;
    return count == i->body_count && i->last_body == before;
}

static bool check_manifold(const pl_manifold *m)
{
    return CHECK_NEAR(m->nx) && CHECK_NEAR(m->ny) && CHECK_NEAR(m->friction) &&
           CHECK_NEAR(m->restitution) && CHECK_NEAR(m->approach) && CHECK_NEAR(m->surface_speed) &&
           CHECK_NEAR(m->rolling) && CHECK_NEAR(m->adhesion) && CHECK_NEAR(m->point) &&
           m->count >= 1 && m->count <= 2;
}

static bool check_pair_numbers(const plumb_world *w, const pl_pair *p)
{
    return p->a < w->pieces.table.count && p->b < w->pieces.table.count && p->a != p->b &&
           CHECK_NEAR(p->normal) && CHECK_NEAR(p->tangent) && CHECK_NEAR(p->rolling) &&
           (p->manifold == 0 || p->manifold == PL_NONE);
}

static bool check_sleeping(const pl_suspect *s, const pl_sleeping_contact *c, uint32_t island)
{
    const plumb_world *w = &s->world;
    const uint32_t most = w->sleep.contact_slots;
    return CHECK_BOOL(c->whole) && c->island == island && check_pair_numbers(w, &c->pair) &&
           (!c->whole || check_manifold(&c->manifold)) &&
           (c->fixed == PL_NONE || c->fixed == c->pair.a || c->fixed == c->pair.b) &&
           (c->next == PL_NONE || c->next < most) &&
           (c->fixed_next == PL_NONE || c->fixed_next < most) &&
           (c->fixed_previous == PL_NONE || c->fixed_previous < most);
}

static bool check_all_sleeping(const pl_suspect *s, uint32_t island, uint32_t *seen)
{
    const pl_island *i = pl_suspect_island(s, island);
    uint32_t count = 0;
    for (uint32_t c = i->first_contact; c != PL_NONE; c = pl_suspect_sleeping(s, c)->next) {
        if (c >= s->world.sleep.contact_slots || count++ == i->contact_count ||
            !check_sleeping(s, pl_suspect_sleeping(s, c), island)) {
            return false;
        }
    }
    *seen += count;
    return count == i->contact_count;
}

// Contacts with a piece that stays where it is: a list there and back, which has all that name the piece.
static bool check_fixed_lists(const pl_suspect *s)
{
    const plumb_world *w = &s->world;
    uint32_t expected = 0, seen = 0;
    for (uint32_t i = 0; i < w->sleep.island_slots; ++i) {
        const pl_island *island = pl_suspect_island(s, i);
        for (uint32_t c = pl_island_is_open(island) ? island->first_contact : PL_NONE; c != PL_NONE;
             c = pl_suspect_sleeping(s, c)->next) {
            expected += pl_suspect_sleeping(s, c)->fixed != PL_NONE;
        }
    }
    for (uint32_t p = 0; p < w->pieces.table.count; ++p) {
        uint32_t before = PL_NONE;
        uint32_t c = w->pieces.kind[p] == PL_PIECE_FREE ? PL_NONE : w->pieces.first_sleeping[p];
        for (; c != PL_NONE; c = pl_suspect_sleeping(s, c)->fixed_next) {
            const pl_sleeping_contact *d = pl_suspect_sleeping(s, c);
            const uint32_t island = d->island;
            if (island >= w->sleep.island_slots ||
                !pl_island_is_open(pl_suspect_island(s, island)) || d->fixed != p ||
                d->fixed_previous != before || d->fixed_next == c ||
                (d->fixed_next != PL_NONE && d->fixed_next >= w->sleep.contact_slots) ||
                seen++ == expected) {
                return false;
            }
            before = c;
        }
    }
    return seen == expected;
}

static bool check_free_islands(const pl_suspect *s)
{
    const pl_sleep *sleep = &s->world.sleep;
    uint32_t left = sleep->island_slots - sleep->island_count, due = 0, steps = 0;
    for (uint32_t i = sleep->free_island; left > 0; --left) {
        if (i >= sleep->island_slots || pl_island_is_open(pl_suspect_island(s, i)) ||
            s->marks[i]++ != 0) {
            return false;
        }
        i = pl_suspect_island(s, i)->first_body;
    }
    memset(s->marks, 0, sleep->island_slots * sizeof *s->marks);
    left = sleep->contact_slots - sleep->contact_count;
    for (uint32_t i = sleep->free_contact; left > 0; --left) {
        if (i >= sleep->contact_slots || s->marks[i]++ != 0) {
            return false;
        }
        i = pl_suspect_sleeping(s, i)->next;
    }
    for (uint32_t i = 0; i < sleep->island_slots; ++i) {
        due += pl_suspect_island(s, i)->due;
    }
    for (uint32_t i = sleep->first_due; i != PL_NONE; i = pl_suspect_island(s, i)->next_due) {
        if (i >= sleep->island_slots || !pl_suspect_island(s, i)->due || steps++ == due) {
            return false;
        }
    }
    return steps == due;
}

bool pl_check_sleep(pl_suspect *s)
{
    const pl_sleep *sleep = &s->world.sleep;
    uint32_t islands = 0, bodies = 0, contacts = 0;
    if (sleep->island_count > sleep->island_slots || sleep->contact_count > sleep->contact_slots) {
        return false;
    }
    for (uint32_t i = 0; i < sleep->island_slots; ++i) {
        const pl_island *island = pl_suspect_island(s, i);
        if (!CHECK_BOOL(island->due) || !CHECK_BOOL(island->marked)) {
            return false;
        }
        if (!pl_island_is_open(island)) {
            continue;
        }
        ++islands;
        if (island->marked || !CHECK_NEAR(island->overlaps.max_penetration) ||
            !check_sleepers(s, i, &bodies) || !check_all_sleeping(s, i, &contacts)) {
            return false;
        }
    }
    bool sound = islands == sleep->island_count && bodies == s->world.asleep_count &&
                 contacts == sleep->contact_count && check_fixed_lists(s) && check_free_islands(s);
    memset(s->marks, 0, sleep->contact_slots * sizeof *s->marks);
    for (uint32_t i = 0; sound && i < sleep->resting_count; ++i) {
        sound = pl_resting(sleep)[i] < s->world.pieces.table.count;
    }
    return sound;
}

//---- contacts ------------------------------------------------------------------------------------

// Ranges by kinds, one behind the other.
static bool check_ranges(const pl_pair_list *list)
{
    uint64_t sum = 0;
    for (int a = 0; a < PL_PIECE_KIND_COUNT; ++a) {
        for (int b = 0; b < PL_PIECE_KIND_COUNT; ++b) {
            if (list->first[a][b] != sum || (list->size[a][b] > 0 && (a == 0 || a > b))) {
                return false;
            }
            sum += list->size[a][b];
        }
    }
    return sum == list->count || (sum == 0 && list->count == 0);
}

// Slots may have changed hands since the list was made; it is then made anew before anyone reads the rest.
static bool check_pair(const plumb_world *w, const pl_pair *p, uint32_t a, uint32_t b)
{
    const pl_pieces *pieces = &w->pieces;
    if (w->pairs_dirty || w->broad.stale) {
        return true;
    }
    const bool rows = pieces->body[p->a] == p->body_a && pieces->body[p->b] == p->body_b;
    return pieces->kind[p->a] == a && pieces->kind[p->b] == b && (rows || w->rows_moved);
}

static bool check_pairs(const plumb_world *w)
{
    const pl_pair_list *list = &w->broad.pairs;
    const pl_pair *pairs = pl_pairs(list);
    if (!check_ranges(list)) {
        return false;
    }
    for (uint32_t a = 0; a < PL_PIECE_KIND_COUNT; ++a) {
        for (uint32_t b = 0; b < PL_PIECE_KIND_COUNT; ++b) {
            const uint32_t first = list->first[a][b], end = first + list->size[a][b];
            for (uint32_t i = first; i < end; ++i) {
                const bool sorted = i == first || pl_pair_key(pairs[i - 1].a, pairs[i - 1].b) <
                                                      pl_pair_key(pairs[i].a, pairs[i].b);
                if (!sorted || !check_pair_numbers(w, &pairs[i]) ||
                    !check_pair(w, &pairs[i], a, b)) {
                    return false;
                }
            }
        }
    }
    return true;
}

static bool check_keyed(const plumb_world *w, const pl_keyed *items, uint32_t count)
{
    for (uint32_t i = 0; i < count; ++i) {
        if (items[i].order >= w->pieces.table.count || items[i].value >= w->pieces.table.count) {
            return false;
        }
    }
    return true;
}

static bool check_overlaps(const pl_overlap *items, uint32_t count)
{
    for (uint32_t i = 1; i < count; ++i) {
        if (items[i - 1].key >= items[i].key) {
            return false;
        }
    }
    return true;
}

static bool check_sensed(const plumb_world *w)
{
    const pl_found *found = w->broad.sensed.data;
    const uint32_t count = w->pieces.table.count;
    for (uint32_t i = 0; i < w->broad.sensed_count; ++i) {
        if (found[i].low >= count || found[i].high >= count) {
            return false;
        }
    }
    const pl_pending_hit *hit = w->pending_hits.items.data;
    for (uint32_t i = 0; i < w->pending_hits.count; ++i) {
        if (!CHECK_NEAR(hit[i].approach) || !CHECK_NEAR(hit[i].impulse) || !CHECK_NEAR(hit[i].nx) ||
            !CHECK_NEAR(hit[i].ny) || !CHECK_REALS(hit[i].at) ||
            !(hit[i].moment >= -2 && hit[i].moment <= 2)) {
            return false;
        }
    }
    return true;
}

// Pieces that left their boxes: moving ones, each once.
static bool check_left(pl_suspect *s)
{
    const plumb_world *w = &s->world;
    const uint32_t *left = w->broad.left.data;
    bool sound = w->broad.left_count <= w->pieces.table.count;
    for (uint32_t i = 0; sound && i < w->broad.left_count; ++i) {
        sound = left[i] < w->pieces.table.count && s->marks[left[i]]++ == 0;
    }
    memset(s->marks, 0, w->pieces.table.count * sizeof *s->marks);
    return sound;
}

bool pl_check_contacts(pl_suspect *s)
{
    const plumb_world *w = &s->world;
    const pl_sensing *n = &w->sensing;
    return check_pairs(w) && check_left(s) && check_sensed(w) &&
           check_keyed(w, n->candidates.data, n->candidate_count) &&
           check_keyed(w, n->rest_candidates.data, n->rest_candidate_count) &&
           check_overlaps(n->overlaps.data, n->count) &&
           check_overlaps(n->rest_overlaps.data, n->rest_count);
}
