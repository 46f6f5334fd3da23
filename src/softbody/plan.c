// plan.c - which soft bodies hang together, with the bodies that they pull or touch, and the structure of the matrix of each such
// group.
//
// Unknowns come in blocks: of a node, a body, or the gas of a ring. Blocks of a group lie together, in the order of
// core/elimination.h; what is far does not show, and a group that needs many passes costs the others nothing.
//
// Reads: soft bodies, points, what is near. Writes: members by their groups, groups, blocks. Order: behind the graph, which gives bodies
// their slots. Cost: O(fill).
#include "core/sort.h"
#include "core/union_find.h"
#include "softbody/softbody.h"

#include <string.h>

//---- unknowns ------------------------------------------------------------------------------------

// Gives a body what the solver has of it. False: its motion is known.
static bool take_slot(const plumb_world *world, pl_soft_body *b)
{
    const uint32_t *slots = world->solver.slots.data;
    if (b->row >= world->dynamic_count || world->softbodies.step->coupled == 0) {
        return false;
    }
    b->slot = slots[b->row];
    if (b->slot == PL_NONE) {
        return false;
    }
    const pl_solver_body *now = &pl_solver_bodies(&world->solver)[b->slot];
    b->mass = now->inv_mass > 0 ? 1 / (double)now->inv_mass : b->mass;
    b->inertia = now->inv_inertia > 0 ? 1 / (double)now->inv_inertia : b->inertia;
    b->locked_w = now->inv_inertia > 0 ? b->locked_w : 0;
    b->mass = b->mass > 0 ? b->mass : 1;
    b->inertia = b->inertia > 0 ? b->inertia : 1;
    return true;
}

// Numbers nodes that are free, bodies, gas, in this order; sizes of each. Returns how many.
static uint32_t number_unknowns(plumb_world *world)
{
    pl_soft_step *s = world->softbodies.step;
    uint8_t *size = s->shapes.data;
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->point_count; ++i) {
        pl_soft_point *p = &pl_soft_points(s)[i];
        p->block = PL_NONE;
        if (!p->pinned) {
            size[count] = 2;
            p->block = count++;
        }
    }
    for (uint32_t i = 0; i < s->body_count; ++i) {
        pl_soft_body *b = &pl_soft_bodies(s)[i];
        b->block = PL_NONE;
        if (take_slot(world, b)) {
            size[count] = 3;
            b->block = count++;
        }
    }
    for (uint32_t i = 0; i < s->point_count; ++i) {
        pl_soft_point *p = &pl_soft_points(s)[i];
        if (p->body != PL_NONE) {
            p->block = pl_soft_bodies(s)[p->body].block;
        }
    }
    for (uint32_t i = 0; i < s->member_count; ++i) {
        pl_soft_member *m = &pl_soft_members(s)[i];
        m->gas = PL_NONE;
        if (pl_softbody_items(&world->softbodies)[m->item].ring > 0) {
            size[count] = 1;
            m->gas = count++;
        }
    }
    return count;
}

//---- who has to do with whom ---------------------------------------------------------------------

static void pair(pl_soft_step *s, uint32_t a, uint32_t b)
{
    if (a != PL_NONE && b != PL_NONE && a != b) {
        uint32_t *to = s->elimination.pairs + 2 * (size_t)s->elimination.pair_count++;
        to[0] = a, to[1] = b;
    }
}

static void pair_three(pl_soft_step *s, const pl_soft_point *p, uint32_t a, uint32_t b, uint32_t c)
{
    pair(s, p[a].block, p[b].block);
    pair(s, p[b].block, p[c].block);
    pair(s, p[a].block, p[c].block);
}

static void pair_member(const pl_softbodies *all, const pl_soft_member *m)
{
    pl_soft_step *s = all->step;
    const pl_softbody *item = &pl_softbody_items(all)[m->item];
    const pl_soft_point *p = pl_soft_points(s) + m->at.point;
    for (uint32_t k = 0; k < item->edges; ++k) {
        const plumb_softbody_edge *e = &pl_softbody_edges(all)[m->at.edge + k];
        if ((e->flags & PLUMB_EDGE_TORN) == 0) {
            pair(s, p[e->a].block, p[e->b].block);
        }
    }
    for (uint32_t k = 0; k < item->bends; ++k) {
        const plumb_softbody_bend *e = &pl_softbody_bends(all)[m->at.bend + k];
        pair_three(s, p, e->a, e->b, e->c);
    }
    for (uint32_t k = 0; k < item->triangles; ++k) {
        const plumb_softbody_triangle *e = &pl_softbody_triangles(all)[m->at.triangle + k];
        pair_three(s, p, e->a, e->b, e->c);
    }
    for (uint32_t k = 0; k < item->ring; ++k) {
        pair(s, m->gas, p[pl_softbody_rings(all)[m->at.ring + k]].block);
    }
}

static void pair_all(const pl_softbodies *all)
{
    pl_soft_step *s = all->step;
    const pl_soft_near *near = s->near_.data;
    for (uint32_t i = 0; i < s->member_count; ++i) {
        pair_member(all, &pl_soft_members(s)[i]);
    }
    for (uint32_t i = 0; i < s->near_count; ++i) {
        const pl_soft_obstacle *o = (const pl_soft_obstacle *)s->obstacles.data + near[i].obstacle;
        pair(s, pl_soft_points(s)[near[i].point].block, pl_soft_bodies(s)[o->body].block);
    }
}

//---- groups --------------------------------------------------------------------------------------

// Of components of the matrix, and behind them of members: who leads the group of each.
static void find_leaders(const pl_soft_step *s, uint32_t *leaders)
{
    const pl_elimination *e = &s->elimination;
    pl_union_reset(leaders, e->component_count + s->member_count);
    for (uint32_t i = 0; i < s->member_count; ++i) {
        const pl_soft_member *m = &pl_soft_members(s)[i];
        const uint32_t own = e->component_count + i;
        for (uint32_t n = 0; n < m->nodes; ++n) {
            const uint32_t block = pl_soft_points(s)[m->at.point + n].block;
            if (block != PL_NONE) {
                pl_union_join(leaders, own, e->component[block]);
            }
        }
        if (m->gas != PL_NONE) {
            pl_union_join(leaders, own, e->component[m->gas]);
        }
    }
}

// Numbers groups by their first members, and sorts members by them. `group` of a leader: its group, PL_NONE for bodies without any
// soft body.
static void sort_members(pl_soft_step *s, uint32_t *leaders, uint32_t *group)
{
    pl_soft_member *members = pl_soft_members(s), *copy = members + s->member_count;
    pl_soft_group *groups = pl_soft_groups(s);
    const uint32_t components = s->elimination.component_count;
    memset(group, 0xff, (components + s->member_count) * sizeof *group);
    s->group_count = 0;
    for (uint32_t i = 0; i < s->member_count; ++i) {
        uint32_t *of = &group[pl_union_leader(leaders, components + i)];
        if (*of == PL_NONE) {
            groups[s->group_count] = (pl_soft_group){ .end_member = 0 };
            *of = s->group_count++;
        }
        ++groups[*of].end_member;
        copy[i] = members[i];
    }
    uint32_t at = 0;
    for (uint32_t k = 0; k < s->group_count; ++k) {
        pl_range_open(&groups[k].first_member, &groups[k].end_member, &at);
    }
    for (uint32_t i = 0; i < s->member_count; ++i) {
        members[groups[group[pl_union_leader(leaders, components + i)]].end_member++] = copy[i];
    }
}

// Where the blocks of each component begin, group by group. Returns how many blocks there are.
static uint32_t place_components(pl_soft_step *s, uint32_t *leaders, const uint32_t *group,
                                 uint32_t *place)
{
    const pl_elimination *e = &s->elimination;
    pl_soft_group *groups = pl_soft_groups(s);
    for (uint32_t c = 0; c < e->component_count; ++c) {
        const uint32_t k = group[pl_union_leader(leaders, c)];
        if (k != PL_NONE) {
            groups[k].end_block += e->start[c + 1] - e->start[c];
        }
    }
    uint32_t at = 0;
    for (uint32_t k = 0; k < s->group_count; ++k) {
        pl_range_open(&groups[k].first_block, &groups[k].end_block, &at);
    }
    for (uint32_t c = 0; c < e->component_count; ++c) {
        const uint32_t k = group[pl_union_leader(leaders, c)];
        place[c] = PL_NONE;
        if (k != PL_NONE) {
            place[c] = groups[k].end_block;
            groups[k].end_block += e->start[c + 1] - e->start[c];
        }
    }
    return at;
}

// PL_NONE: no unknown, or no soft body has to do with it.
static uint32_t group_of_body(const pl_soft_step *s, uint32_t body, uint32_t *leaders,
                              const uint32_t *group)
{
    const uint32_t unknown = pl_soft_bodies(s)[body].block;
    return unknown == PL_NONE ? PL_NONE
                              : group[pl_union_leader(leaders, s->elimination.component[unknown])];
}

// Bodies that are unknowns, by their groups.
static void sort_bodies(pl_soft_step *s, uint32_t *leaders, const uint32_t *group)
{
    pl_soft_group *groups = pl_soft_groups(s);
    for (uint32_t i = 0; i < s->body_count; ++i) {
        const uint32_t k = group_of_body(s, i, leaders, group);
        if (k != PL_NONE) {
            ++groups[k].end_body;
        }
    }
    uint32_t at = 0;
    for (uint32_t k = 0; k < s->group_count; ++k) {
        pl_range_open(&groups[k].first_body, &groups[k].end_body, &at);
    }
    for (uint32_t i = 0; i < s->body_count; ++i) {
        const uint32_t k = group_of_body(s, i, leaders, group);
        if (k != PL_NONE) {
            ((uint32_t *)s->grouped.data)[groups[k].end_body++] = i;
        }
    }
}

static void weigh_groups(const pl_softbodies *all)
{
    pl_soft_step *s = all->step;
    for (uint32_t k = 0; k < s->group_count; ++k) {
        pl_soft_group *g = &pl_soft_groups(s)[k];
        for (uint32_t i = g->first_member; i < g->end_member; ++i) {
            const pl_soft_member *m = &pl_soft_members(s)[i];
            g->triangles = g->triangles || pl_softbody_items(all)[m->item].triangles > 0;
            g->mass += m->mass;
        }
    }
}

//---- blocks --------------------------------------------------------------------------------------

static uint32_t block_of(const pl_elimination *e, const uint32_t *place, uint32_t unknown)
{
    const uint32_t c = unknown != PL_NONE ? e->component[unknown] : PL_NONE;
    return c == PL_NONE || place[c] == PL_NONE ? PL_NONE
                                               : place[c] + e->rank[unknown] - e->start[c];
}

// Unknowns become blocks. *same: they are those of the plan before.
static void rename_unknowns(pl_soft_step *s, const uint32_t *place, uint32_t unknowns, bool *same)
{
    const pl_elimination *e = &s->elimination;
    uint8_t *size = s->shapes.data, *of_unknown = size + unknowns;
    uint32_t *blocks = pl_soft_kept_blocks(s);
    memcpy(of_unknown, size, unknowns);
    for (uint32_t i = 0; i < unknowns; ++i) {
        const uint32_t block = block_of(e, place, i);
        const uint32_t told = block == PL_NONE ? PL_NONE : 4 * block + of_unknown[i];
        *same = *same && blocks[i] == told;
        blocks[i] = told;
        if (block != PL_NONE) {
            size[block] = of_unknown[i];
        }
    }
    for (uint32_t i = 0; i < s->point_count; ++i) {
        pl_soft_points(s)[i].block = block_of(e, place, pl_soft_points(s)[i].block);
    }
    for (uint32_t i = 0; i < s->body_count; ++i) {
        pl_soft_bodies(s)[i].block = block_of(e, place, pl_soft_bodies(s)[i].block);
    }
    for (uint32_t i = 0; i < s->member_count; ++i) {
        pl_soft_members(s)[i].gas = block_of(e, place, pl_soft_members(s)[i].gas);
    }
}

static void sort_pairs(pl_soft_step *s, const uint32_t *place)
{
    const pl_elimination *e = &s->elimination;
    pl_keyed *keys = s->keys.data;
    for (uint32_t i = 0; i < e->pair_count; ++i) {
        const uint32_t a = block_of(e, place, e->pairs[2 * i]);
        const uint32_t b = block_of(e, place, e->pairs[2 * i + 1]);
        keys[i] = (pl_keyed){ a > b ? pl_key(a, b) : pl_key(b, a), 0, 0 };
    }
    pl_sort_keyed(keys, e->pair_count);
}

static bool reserve(plumb_world *world, uint32_t *most_pairs)
{
    const pl_softbodies *all = &world->softbodies;
    pl_soft_step *s = all->step;
    const size_t unknowns = (size_t)s->point_count + s->body_count + s->member_count;
    *most_pairs = all->edge_count + 3 * all->bend_count + 3 * all->triangle_count + s->near_count +
                  all->ring_count;
    return pl_buffer_reserve(&world->memory, &s->keys,
                             ((size_t)*most_pairs + 1) * sizeof(pl_keyed)) &&
           pl_buffer_reserve(&world->memory, &s->shapes, 2 * unknowns + 1) &&
           pl_buffer_reserve(&world->memory, &s->groups, s->member_count * sizeof(pl_soft_group)) &&
           pl_buffer_reserve(&world->memory, &s->grouped,
                             (s->body_count + 3 * (unknowns + s->member_count)) * sizeof(uint32_t));
}

bool pl_softbodies_plan(plumb_world *world)
{
    const pl_softbodies *all = &world->softbodies;
    pl_soft_step *s = all->step;
    uint32_t most_pairs;
    if (!reserve(world, &most_pairs)) {
        return false;
    }
    const uint32_t unknowns = number_unknowns(world);
    if (!pl_elimination_open(&world->memory, &s->elimination, unknowns, most_pairs)) {
        return false;
    }
    pair_all(all);
    bool same;
    if (!pl_soft_order(&world->memory, s, most_pairs, &same)) {
        return false;
    }
    const uint32_t parts = s->elimination.component_count + s->member_count;
    uint32_t *leaders = (uint32_t *)s->grouped.data + s->body_count;
    uint32_t *group = leaders + parts, *place = group + parts;
    find_leaders(s, leaders);
    sort_members(s, leaders, group);
    sort_bodies(s, leaders, group);
    weigh_groups(all);
    const uint32_t blocks = place_components(s, leaders, group, place);
    rename_unknowns(s, place, unknowns, &same);
    s->matrix.size = s->shapes.data;
    if (same) {
        return true;
    }
    sort_pairs(s, place);
    return pl_soft_structure(&world->memory, s, blocks, s->elimination.pair_count,
                             world->desc.simd_width);
}
