// internal_edges.c - keeps up what neighbours cover and what corners allow while pieces come, go and move.
//
// Static pieces have the static pieces of all bodies as neighbours, others those of their own body.
// A change is local: a new piece and what lies around it, what lay around one that went, all of
// a body that moves. Nothing is done in steps without a change but to note what pairs keep.
//
// Reads: pieces, poses, grids, pairs. Writes: internal edge columns, corners, intervals, list of pairs. Order:
// after the broad phase. Cost: O(changed pieces x their neighbours), and O(piece slots) for looking;
// O(pairs) when pairs were made anew, O(pairs with internal edges) a step; nothing in worlds without internal edges.
#include "internal_edges/internal_edges.h"

#include "world/stale_edges.h"
#include "broad/images.h"
#include "internal_edges/cover.h"
#include "internal_edges/run.h"
#include "world/interval.h"
#include "world/state.h"

#include <string.h>

bool pl_internal_edges_wanted(const plumb_world *world, const char **reason)
{
    bool wanted = world->internal_edges.count > 0 || world->internal_edges.dirty;
    *reason = wanted ? "pieces of ground lie side by side, or some have come or gone"
                     : "no two pieces of ground lie side by side";
    return wanted;
}

void pl_internal_edges_free(pl_memory *memory, pl_internal_edges *edges)
{
    pl_buffer *buffers[] = { &edges->corners, &edges->intervals, &edges->regions, &edges->chosen,
                             &edges->around,  &edges->scratch,   &edges->pairs,   &edges->contacts,
                             &edges->runs,    &edges->order,     &edges->loads,   &edges->old_loads,
                             &edges->slots,   &edges->borne };
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; ++i) {
        pl_buffer_free(memory, buffers[i]);
    }
    *edges = (pl_internal_edges){ 0 };
}

//---- changes -------------------------------------------------------------------------------------

//---- which pieces are looked at ------------------------------------------------------------------

static bool choose(plumb_world *world, uint32_t piece)
{
    pl_internal_edges *s = &world->internal_edges;
    uint32_t *bits = &world->pieces.internal_corners[piece];
    if (*bits & PL_EDGE_CHOSEN) {
        return true;
    }
    if (!pl_buffer_reserve(&world->memory, &s->chosen,
                           ((size_t)s->chosen_count + 1) * sizeof(uint32_t))) {
        return false;
    }
    ((uint32_t *)s->chosen.data)[s->chosen_count++] = piece;
    *bits |= PL_EDGE_CHOSEN;
    return true;
}

static bool choose_visited(void *context, const pl_grid_entry *entry)
{
    return choose(context, entry->piece);
}

static bool choose_around(plumb_world *world, pl_box box)
{
    return pl_world_query(world, &world->broad.fixed, box, choose_visited, world);
}

static bool choose_body(plumb_world *world, uint32_t row)
{
    uint32_t p = world->bodies.first_piece[row];
    bool ok = true;
    for (; p != PL_NONE && ok; p = world->pieces.next_in_body[p]) {
        ok = choose(world, p);
    }
    return ok;
}

static bool choose_stale(plumb_world *world)
{
    const pl_pieces *pieces = &world->pieces;
    pl_internal_edges *s = &world->internal_edges;
    bool ok = true;
    for (uint32_t p = 0; p < pieces->table.count && ok; ++p) {
        if (pieces->kind[p] == PL_PIECE_FREE || pieces->moving[p] == PL_OUT ||
            !(s->all || (pieces->internal_corners[p] & PL_EDGE_STALE))) {
            continue;
        }
        if (s->all) {
            ok = choose(world, p);
        } else if (!pl_piece_is_static(world, p)) {
            ok = choose_body(world, pieces->body[p]);
        } else {
            ok = choose(world, p) && choose_around(world, pieces->fat[p]);
        }
    }
    const pl_box *regions = s->regions.data;
    for (uint32_t i = 0; i < s->region_count && ok && !s->all; ++i) {
        ok = choose_around(world, regions[i]);
    }
    return ok;
}

//---- the passes ----------------------------------------------------------------------------------

static bool look_at_chosen(plumb_world *world)
{
    pl_internal_edges *s = &world->internal_edges;
    const uint32_t *chosen = s->chosen.data;
    for (uint32_t i = 0; i < s->chosen_count; ++i) {
        if (!pl_internal_edges_find(world, chosen[i])) {
            return false;
        }
    }
    return true;
}

// Marks of what was chosen go; those of stale pieces too, if all went well.
static void unmark(plumb_world *world, bool done)
{
    pl_internal_edges *s = &world->internal_edges;
    const uint32_t *chosen = s->chosen.data;
    for (uint32_t i = 0; i < s->chosen_count; ++i) {
        world->pieces.internal_corners[chosen[i]] &=
            done ? ~(PL_EDGE_CHOSEN | PL_EDGE_STALE) : ~PL_EDGE_CHOSEN;
    }
    s->updated += s->chosen_count;
    s->chosen_count = 0;
}

// As many as the pool has; images hold those without internal edges, too.
static bool make_corners(plumb_world *world)
{
    pl_internal_edges *s = &world->internal_edges;
    const uint32_t needed = world->vertices.count;
    if (!pl_buffer_reserve(&world->memory, &s->corners, needed * sizeof(pl_edge))) {
        return false;
    }
    if (needed > s->corner_count) {
        memset(pl_edge_items(s) + s->corner_count, 0, (needed - s->corner_count) * sizeof(pl_edge));
        s->corner_count = needed;
    }
    return true;
}

static bool refresh(plumb_world *world)
{
    pl_internal_edges *s = &world->internal_edges;
    bool done = make_corners(world) && choose_stale(world) && look_at_chosen(world);
    unmark(world, done);
    if (done) {
        s->dirty = s->all = false;
        s->region_count = 0;
        s->relist = true;
        s->corner_count = s->count > 0 ? s->corner_count : 0;
        world->schedule_dirty |= s->count == 0;
    }
    return done;
}

// The kernels carry impulses over by features of their own; these are for contacts set right.
static void note(pl_edge_pair *kept, const pl_pair *pair)
{
    for (int k = 0; k < 2; ++k) {
        kept->feature[k] = pair->feature[k];
        kept->normal[k] = pair->normal[k];
        kept->tangent[k] = pair->tangent[k];
    }
    kept->rolling = pair->rolling;
    kept->borne = pair->flags & PL_PAIR_BORNE;
    kept->manifold = pair->manifold != PL_NONE ? 0 : PL_NONE; // of a step that is over
}

static bool list_pairs(plumb_world *world)
{
    pl_internal_edges *s = &world->internal_edges;
    const pl_pair_list *list = &world->broad.pairs;
    pl_pair *pairs = pl_pairs(list);
    s->pair_count = 0;
    for (uint32_t i = 0; i < list->count; ++i) {
        if (!pl_piece_has_internal_edges(&world->pieces, pairs[i].a) &&
            !pl_piece_has_internal_edges(&world->pieces, pairs[i].b)) {
            pairs[i].flags &=
                ~PL_PAIR_BORNE; // what bore it was at an internal edge that is no more
            continue;
        }
        if (!pl_buffer_reserve(&world->memory, &s->pairs,
                               ((size_t)s->pair_count + 1) * sizeof(pl_edge_pair))) {
            return false;
        }
        pl_edge_pair *made = (pl_edge_pair *)s->pairs.data + s->pair_count++;
        memset(made, 0, sizeof *made); // padding, too: images of equal worlds have equal bytes
        made->pair = i;
        made->a = pairs[i].a;
        made->b = pairs[i].b;
        note(made, &pairs[i]);
    }
    if (s->pair_count == 0) {
        s->load_count = 0; // nobody is left to tell of
    }
    s->relist = false;
    s->listed = world->broad.rebuilds;
    return true;
}

static void note_pairs(plumb_world *world)
{
    const pl_internal_edges *s = &world->internal_edges;
    const pl_pair *pairs = pl_pairs(&world->broad.pairs);
    pl_edge_pair *kept = s->pairs.data;
    for (uint32_t i = 0; i < s->pair_count; ++i) {
        const pl_pair *pair = &pairs[kept[i].pair];
        // Else it is apart, as it was.
        if (pair->manifold != PL_NONE || kept[i].manifold != PL_NONE) {
            note(&kept[i], pair);
        }
    }
}

bool pl_internal_edges_update(plumb_world *world)
{
    pl_internal_edges *s = &world->internal_edges;
    if (s->dirty && !refresh(world)) {
        return false;
    }
    if (!s->relist && s->listed == world->broad.rebuilds) {
        note_pairs(world);
    } else if (!list_pairs(world)) {
        return false;
    }
    s->noted = true;
    return true;
}

static void give_back(pl_pair *pair, const pl_edge_pair *kept)
{
    for (int k = 0; k < 2; ++k) {
        pair->feature[k] = kept->feature[k];
        pair->normal[k] = kept->normal[k];
        pair->tangent[k] = kept->tangent[k];
    }
    pair->rolling = kept->rolling;
    pair->flags = (pair->flags & ~(PL_PAIR_BORNE | PL_PAIR_COVERED)) | kept->borne;
    pair->manifold =
        kept->manifold; // pairs that part forget the above, those that are apart do not
}

// Setting contacts right twice would round twice what runs bear.
void pl_internal_edges_give_back(plumb_world *world)
{
    pl_internal_edges *s = &world->internal_edges;
    const pl_edge_pair *kept = s->pairs.data;
    for (uint32_t i = 0; s->noted && i < s->pair_count; ++i) {
        pl_pair *pair = &pl_pairs(&world->broad.pairs)[kept[i].pair];
        const uint32_t manifold = pair->manifold;
        if (manifold != PL_NONE) {
            give_back(pair, &kept[i]);
            pair->manifold = manifold;
        }
    }
    s->noted = false;
    pl_runs_undo(s);
}

void pl_internal_edges_undo(plumb_world *world)
{
    pl_internal_edges *s = &world->internal_edges;
    pl_pair *pairs = pl_pairs(&world->broad.pairs);
    const pl_edge_pair *kept = s->pairs.data;
    uint32_t at = 0;
    for (uint32_t i = 0; s->noted && i < s->pair_count; ++i) {
        // Those of bodies that fell asleep have left the list; the others moved up in it.
        for (uint32_t k = at; k < world->broad.pairs.count && k <= kept[i].pair; ++k) {
            if (pairs[k].a == kept[i].a && pairs[k].b == kept[i].b) {
                give_back(&pairs[k], &kept[i]);
                at = k + 1;
                break;
            }
        }
    }
    s->noted = false;
    pl_runs_undo(s);
}
