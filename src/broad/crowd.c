// crowd.c - what the filters of many pieces have in common: debris that passes through debris, a net in
// one group need no box compared.
//
// Reads: filters, the grid of static pieces. Cost: O(pieces), less where the first few show that they meet.
#include "broad/pairs.h"
#include "world/state.h"

// What the filters of many pieces have in common.
typedef struct crowd {
    uint64_t category, mask; // of any
    int32_t group;           // of all, where `one_group`
    bool one_group, forced;  // forced: a positive group, which no mask keeps apart
} crowd;

static void join_crowd(crowd *c, const pl_pieces *pieces, uint32_t piece)
{
    bool first = c->category == 0;
    c->one_group = first || (c->one_group && c->group == pieces->group[piece]);
    c->group = pieces->group[piece];
    c->forced |= c->group > 0;
    c->category |= pieces->category[piece];
    c->mask |= pieces->mask[piece];
}

static bool may_meet(const crowd *a, const crowd *b)
{
    if (a->one_group && b->one_group && a->group == b->group && a->group < 0) {
        return false;
    }
    return (a->forced && b->forced) ||
           ((a->category & b->mask) != 0 && (b->category & a->mask) != 0);
}

// The crowd of moving pieces; stops where it may meet itself, whatever comes.
static bool moving_crowd(const plumb_world *world, crowd *c)
{
    const uint32_t *moving = pl_moving(world);
    *c = (crowd){ .category = 0 };
    for (uint32_t i = 0; i < world->moving_count; ++i) {
        join_crowd(c, &world->pieces, moving[i]);
        if (!(c->one_group && c->group < 0) && may_meet(c, c)) {
            return true;
        }
    }
    return may_meet(c, c);
}

static bool meets_fixed(const plumb_world *world, const crowd *moving)
{
    const pl_grid *fixed = &world->broad.fixed;
    crowd c = { .category = 0 };
    for (uint32_t i = 0; i < fixed->entry_count; ++i) {
        join_crowd(&c, &world->pieces, pl_grid_entries(fixed)[i].piece);
    }
    return may_meet(moving, &c);
}

void pl_crowds_judge(const plumb_world *world, bool *meet, bool *grounded)
{
    crowd moving;
    *meet = world->filtered_pieces == 0 || moving_crowd(world, &moving);
    *grounded = *meet || meets_fixed(world, &moving);
}
