// filter_union.c - what the filters of many pieces have in common: debris that passes through debris, a net in
// one group need no box compared.
//
// Reads: filters, the grid of static pieces. Cost: O(pieces), less where the first few show that they meet.
#include "broad/pairs.h"
#include "world/state.h"

// What the filters of many pieces have in common.
typedef struct filter_union {
    uint64_t category, mask; // of any
    int32_t group;           // of all, where `one_group`
    bool one_group, forced;  // forced: a positive group, which no mask keeps apart
} filter_union;

static void add_filter(filter_union *c, const pl_pieces *pieces, uint32_t piece)
{
    bool first = c->category == 0;
    c->one_group = first || (c->one_group && c->group == pieces->group[piece]);
    c->group = pieces->group[piece];
    c->forced |= c->group > 0;
    c->category |= pieces->category[piece];
    c->mask |= pieces->mask[piece];
}

static bool may_meet(const filter_union *a, const filter_union *b)
{
    if (a->one_group && b->one_group && a->group == b->group && a->group < 0) {
        return false;
    }
    return (a->forced && b->forced) ||
           ((a->category & b->mask) != 0 && (b->category & a->mask) != 0);
}

// The union of the filters of moving pieces; stops where it may meet itself, whatever comes.
static bool filters_of_moving(const plumb_world *world, filter_union *c)
{
    const uint32_t *moving = pl_moving(world);
    *c = (filter_union){ .category = 0 };
    for (uint32_t i = 0; i < world->moving_count; ++i) {
        add_filter(c, &world->pieces, moving[i]);
        if (!(c->one_group && c->group < 0) && may_meet(c, c)) {
            return true;
        }
    }
    return may_meet(c, c);
}

static bool meets_fixed(const plumb_world *world, const filter_union *moving)
{
    const pl_grid *fixed = &world->broad.fixed;
    filter_union c = { .category = 0 };
    for (uint32_t i = 0; i < fixed->entry_count; ++i) {
        add_filter(&c, &world->pieces, pl_grid_entries(fixed)[i].piece);
    }
    return may_meet(moving, &c);
}

void pl_filters_may_meet(const plumb_world *world, bool *meet, bool *grounded)
{
    filter_union moving;
    *meet = world->filtered_pieces == 0 || filters_of_moving(world, &moving);
    *grounded = *meet || meets_fixed(world, &moving);
}
