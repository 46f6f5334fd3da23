// check_rows.c - see check.h: handles and rows name one another, partitions and lists are what they say, numbers
// that derive from others agree with them.
//
// Reads: the image. Writes: marks. Cost: O(rows), each list walked once: a walk that takes more steps than
// there are elements is a circle.
#include "snapshot/check.h"
#include "world/check.h"
#include "world/material_pair.h"
#include "world/rows.h"

#include <math.h>
#include <string.h>

//---- registry ------------------------------------------------------------------------------------

static bool names_row(const plumb_world *w, const pl_suspect *s, uint32_t index,
                      const pl_slot *slot)
{
    const plumb_entity e = { index, slot->generation };
    switch (slot->kind) {
    case PLUMB_KIND_BARE:
        return true;
    case PLUMB_KIND_BODY:
        return slot->row < w->bodies.table.count &&
               plumb_same(w->bodies.entity[slot->row].entity, e);
    case PLUMB_KIND_SHAPE:
        return slot->row < w->pieces.table.count &&
               plumb_same(w->pieces.shape[slot->row].entity, e) &&
               w->pieces.kind[slot->row] != PL_PIECE_FREE;
    case PLUMB_KIND_MATERIAL:
        return slot->row > 0 && slot->row < w->materials.table.count &&
               plumb_same(w->materials.entity[slot->row].entity, e);
    case PLUMB_KIND_LAW:
        return slot->row < w->laws.count &&
               plumb_same(pl_law_items(&w->laws)[slot->row].entity.entity, e);
    case PLUMB_KIND_SOFTBODY:
        return slot->row < w->softbodies.count &&
               plumb_same(pl_softbody_items(&w->softbodies)[slot->row].entity.entity, e);
    case PLUMB_KIND_JOINT:
        return slot->row < w->joints.count &&
               plumb_same(pl_suspect_joint(s, slot->row)->entity.entity, e);
    default:
        return false;
    }
}

// The list of free slots holds all that are free and not used up, and ends at the tail.
static bool check_free_slots(const pl_registry *r, uint32_t expected)
{
    uint32_t last = PL_NONE, steps = 0;
    for (uint32_t i = r->free_head; i != PL_NONE; i = r->slots[i].row) {
        if (i >= r->count || r->slots[i].state != PL_SLOT_FREE || r->slots[i].generation == 0 ||
            steps++ == expected) {
            return false;
        }
        last = i;
    }
    return steps == expected && r->free_tail == last;
}

bool pl_check_registry(pl_suspect *s)
{
    const plumb_world *w = &s->world;
    const pl_registry *r = &w->registry;
    uint32_t live[PLUMB_KIND_SOFTBODY + 1] = { 0 }, taken = 0, open = 0;
    for (uint32_t i = 0; i < r->count; ++i) {
        const pl_slot *slot = &r->slots[i];
        const bool is_live = slot->state == PL_SLOT_LIVE, pending = slot->state == PL_SLOT_PENDING;
        if (slot->state > PL_SLOT_PENDING || slot->kind > PLUMB_KIND_SOFTBODY ||
            (slot->state == PL_SLOT_FREE) != (slot->kind == PLUMB_KIND_NONE) ||
            (slot->generation == 0 && slot->state != PL_SLOT_FREE) ||
            (is_live && !names_row(w, s, i, slot)) || (pending && slot->kind > PLUMB_KIND_SHAPE)) {
            return false;
        }
        taken += is_live || pending;
        open += slot->state == PL_SLOT_FREE && slot->generation != 0;
        live[slot->kind] += is_live;
    }
    return taken == r->live && check_free_slots(r, open) &&
           live[PLUMB_KIND_BODY] == w->bodies.table.count &&
           live[PLUMB_KIND_SHAPE] == w->shape_count &&
           live[PLUMB_KIND_MATERIAL] + 1 == w->materials.table.count &&
           live[PLUMB_KIND_JOINT] == w->joints.live && live[PLUMB_KIND_LAW] == w->laws.count &&
           live[PLUMB_KIND_SOFTBODY] == w->softbodies.count;
}

//---- bodies --------------------------------------------------------------------------------------

static bool is_unit(real c, real s)
{
    const double length = (double)c * (double)c + (double)s * (double)s;
    return length > 0.99 && length < 1.01;
}

static bool is_within(real v, double most)
{
    return v <= (real)most && v >= (real)-most;
}

// Where it is and how fast: as far as a step lets bodies get. How fast an awake dynamic body is judges the guard of the
// next step: a system may have written anything.
static bool check_motion(const pl_bodies *b, uint32_t i, bool guarded)
{
    const real places[] = { b->x[i], b->y[i], b->center_x[i], b->center_y[i] };
    const real rates[] = { b->vx[i], b->vy[i], b->w[i], b->fx[i], b->fy[i], b->torque[i] };
    for (size_t k = 0; k < sizeof places / sizeof places[0]; ++k) {
        if (!is_within(places[k], 2 * (double)PL_LARGEST)) {
            return false;
        }
    }
    for (size_t k = 0; k < sizeof rates / sizeof rates[0] && !guarded; ++k) {
        if (!is_within(rates[k], k < 3 ? 2 * (double)PL_LARGEST : (double)PLUMB_REAL_MAX)) {
            return false;
        }
    }
    return is_unit(b->c[i], b->s[i]);
}

static bool check_partition(const plumb_world *w, uint32_t i)
{
    const pl_bodies *b = &w->bodies;
    const pl_partition p = pl_row_partition(w, i);
    const bool disabled = (b->flags[i] & PL_BODY_DISABLED) != 0;
    const bool asleep = p == PL_PART_ASLEEP;
    const bool type_fits = p == PL_PART_DISABLED || pl_partition_of((plumb_body_type)b->type[i]) ==
                                                        (asleep ? PL_PART_AWAKE : p);
    return type_fits && disabled == (p == PL_PART_DISABLED) &&
           asleep == (b->island[i] != PL_NONE) &&
           (b->type[i] == PLUMB_DYNAMIC || (b->inv_mass[i] == 0 && b->inv_inertia[i] == 0));
}

// What is of a step alone is as the world has it, which is in the midst of one where a recording is played.
static bool check_passing(const pl_suspect *s, uint32_t i)
{
    const pl_bodies *like = &s->like->bodies;
    const uint16_t flags = s->world.bodies.flags[i];
    const uint16_t most = i < like->table.count ? like->flags[i] : 0;
    return (flags & ~most & PL_BODY_WITHIN_STEP) == 0;
}

bool pl_check_bodies(pl_suspect *s)
{
    const plumb_world *w = &s->world;
    const pl_bodies *b = &w->bodies;
    const uint64_t moving = (uint64_t)w->dynamic_count + w->kinematic_count + w->asleep_count;
    uint32_t turning = 0, continuous = 0, locked = 0;
    if (moving + w->disabled_count > b->table.count || !pl_are_bools(b->stirring, b->table.count)) {
        return false;
    }
    for (uint32_t i = 0; i < b->table.count; ++i) {
        if (pl_suspect_row(s, b->entity[i]) != i || !check_motion(b, i, i < w->dynamic_count) ||
            !check_partition(w, i) || !check_passing(s, i)) {
            return false;
        }
        turning += b->inv_inertia[i] > 0;
        continuous += (b->flags[i] & PL_BODY_CONTINUOUS) != 0;
        locked += (b->flags[i] & PL_BODY_LOCKED) != 0;
    }
    return turning == w->turning_bodies && continuous == w->continuous_bodies &&
           locked == w->locked_bodies && w->dropping_bodies <= INT32_MAX;
}

//---- pieces --------------------------------------------------------------------------------------

// [m] by how much corners are off at the most because their places are rounded: what a merger brings from afar, or what is
// made far from the origin of its body.
static double rounding_of(const pl_vertex *v, uint32_t count)
{
    double most = 0;
    for (uint32_t k = 0; k < count; ++k) {
        const double far = fabs((double)v[k].x) + fabs((double)v[k].y);
        most = far > most ? far : most;
    }
    return 4 * (double)PLUMB_REAL_EPSILON * most;
}

// By how much something lies out is within a tenth of how far it is, and rounding.
static bool is_slight(double out, double way2, double rounding)
{
    const double rest = out - rounding;
    return rest <= 0 || rest * rest <= 0.01 * way2;
}

// Corners in order around the outline, with the normals of its edges.
static bool check_corners(const pl_vertex *v, uint32_t count)
{
    if (!pl_are_reals(v, (size_t)count * 4)) {
        return false;
    }
    const double rounding = rounding_of(v, count);
    for (uint32_t k = 0; k < count; ++k) {
        const pl_vertex *next = &v[(k + 1) % count];
        const double nx = (double)v[k].nx, ny = (double)v[k].ny;
        const double dx = (double)next->x - (double)v[k].x, dy = (double)next->y - (double)v[k].y;
        const double length = dx * dx + dy * dy, along = dx * nx + dy * ny;
        if (!is_unit(v[k].nx, v[k].ny) || !is_within(v[k].x, 1e9) || !is_within(v[k].y, 1e9) ||
            !is_slight(fabs(along), length, rounding)) {
            return false;
        }
        for (uint32_t i = 0; i < count; ++i) { // convex: all lies behind each edge
            const double ex = (double)v[i].x - (double)v[k].x;
            const double ey = (double)v[i].y - (double)v[k].y;
            if (!is_slight(ex * nx + ey * ny, ex * ex + ey * ey, rounding)) {
                return false;
            }
        }
    }
    return true;
}

// It reaches as far as it is large, but for rounding.
static bool check_core(const pl_core *c)
{
    const double most = 1.001 * (double)c->reach;
    return c->hx >= 0 && c->hy >= 0 && c->radius >= 0 && c->reach >= 0 && is_unit(c->c, c->s) &&
           is_within(c->x, 1e9) && is_within(c->y, 1e9) && c->reach <= (real)4e9 &&
           (double)c->hx <= most && (double)c->hy <= most && (double)c->radius <= most;
}

// As far as bodies get; or empty, of a piece that was not boxed yet.
static bool check_box(const pl_box *b)
{
    const double most = 8 * (double)PL_LARGEST;
    const bool empty = b->min_x == PLUMB_REAL_MAX && b->min_y == PLUMB_REAL_MAX &&
                       b->max_x == -PLUMB_REAL_MAX && b->max_y == -PLUMB_REAL_MAX;
    return empty ||
           (b->min_x <= b->max_x && b->min_y <= b->max_y && is_within(b->min_x, most) &&
            is_within(b->min_y, most) && is_within(b->max_x, most) && is_within(b->max_y, most));
}

static bool check_geometry(const plumb_world *w, uint32_t p)
{
    static const uint8_t least[] = { 0, 0, 2, 4, 3 }, most[] = { 0, 0, 2, 4, 16 };
    const pl_pieces *pieces = &w->pieces;
    const uint32_t kind = pieces->kind[p], count = pieces->vertex_count[p];
    const uint8_t class = pieces->vertex_class[p];
    const uint32_t edges = (UINT32_C(1) << count) - 1;
    if (count < least[kind] || count > most[kind] || (pieces->cuts[p] & ~edges) != 0 ||
        !check_core(&pieces->core[p])) {
        return false;
    }
    if (count == 0) {
        return true;
    }
    return class == pl_pool_class((int)count) && pieces->vertices[p] <= w->vertices.count &&
           pl_pool_run(class) <= w->vertices.count - pieces->vertices[p] &&
           check_corners(w->vertices.items + pieces->vertices[p], count);
}

// Filed where its body and its flags say; the place in a list is its own.
static bool check_place(const plumb_world *w, uint32_t p)
{
    const pl_pieces *pieces = &w->pieces;
    const uint32_t row = pieces->body[p], place = pieces->moving[p];
    const bool rests = (pieces->flags[p] & PL_PIECE_ASLEEP) != 0;
    switch (pl_row_partition(w, row)) {
    case PL_PART_DISABLED:
        return place == PL_OUT && !rests;
    case PL_PART_STATIC:
        return place == PL_NONE && !rests;
    case PL_PART_ASLEEP:
        return rests && place < w->sleep.resting_count && pl_resting(&w->sleep)[place] == p;
    default:
        return !rests && place < w->moving_count && pl_moving(w)[place] == p;
    }
}

static bool check_piece(const pl_suspect *s, uint32_t p)
{
    const plumb_world *w = &s->world;
    const pl_pieces *pieces = &w->pieces;
    const pl_slot *slot = pl_registry_find(&w->registry, pieces->shape[p].entity);
    return pieces->body[p] < w->bodies.table.count &&
           pieces->material[p] < w->materials.table.count && pieces->serial[p] <= w->serial &&
           slot != NULL && slot->kind == PLUMB_KIND_SHAPE && check_geometry(w, p) &&
           check_place(w, p) &&
           pl_are_reals(&pieces->area[p], sizeof pieces->area[p] / sizeof(real)) &&
           check_box(&pieces->fat[p]) && pl_are_reals(&pieces->core[p], 8);
}

// Each live piece is in the list of its body once, behind the piece of its shape that comes before it.
static bool check_lists(const pl_suspect *s)
{
    const plumb_world *w = &s->world;
    const pl_pieces *pieces = &w->pieces;
    uint32_t seen = 0, shapes = 0;
    for (uint32_t row = 0; row < w->bodies.table.count; ++row) {
        uint32_t before = PL_NONE;
        for (uint32_t p = w->bodies.first_piece[row]; p != PL_NONE; p = pieces->next_in_body[p]) {
            const bool goes_on = before != PL_NONE && pieces->next_in_shape[before] != PL_NONE;
            const pl_slot *slot = &w->registry.slots[pieces->shape[p].entity.index];
            if (pieces->kind[p] == PL_PIECE_FREE || pieces->body[p] != row ||
                seen++ == pieces->live || (goes_on && pieces->next_in_shape[before] != p) ||
                (goes_on ? !plumb_same(pieces->shape[p], pieces->shape[before]) : slot->row != p)) {
                return false;
            }
            shapes += !goes_on;
            before = p;
        }
        if (before != PL_NONE && pieces->next_in_shape[before] != PL_NONE) {
            return false;
        }
    }
    return seen == pieces->live && shapes == w->shape_count;
}

static bool check_free_pieces(const plumb_world *w, uint32_t expected)
{
    const pl_pieces *pieces = &w->pieces;
    uint32_t steps = 0;
    for (uint32_t p = pieces->free_head; p != PL_NONE; p = pieces->next_in_shape[p]) {
        if (p >= pieces->table.count || pieces->kind[p] != PL_PIECE_FREE || steps++ == expected) {
            return false;
        }
    }
    return steps == expected;
}

// Free runs of corners; the link to the next lies in the bytes of the first corner.
static bool check_pool(const pl_suspect *s)
{
    const pl_vertex_pool *pool = &s->world.vertices;
    for (uint8_t c = 0; c < PL_VERTEX_CLASSES; ++c) {
        uint32_t steps = 0;
        for (uint32_t i = pool->free_head[c]; i != PL_NONE;) {
            if (i >= pool->count || pl_pool_run(c) > pool->count - i || steps++ == pool->count) {
                return false;
            }
            memcpy(&i, &pool->items[i], sizeof i);
        }
    }
    return true;
}

static bool check_flag_counts(const plumb_world *w)
{
    const struct {
        uint8_t flag;
        uint32_t count;
    } flags[] = { { PL_PIECE_SENSOR, w->sensor_pieces },
                  { PL_PIECE_FILTERED, w->filtered_pieces },
                  { PL_PIECE_PART, w->part_pieces },
                  { PL_PIECE_ONE_WAY, w->one_way_pieces },
                  { PL_PIECE_PLACED, w->sleep.placed_pieces } };
    uint32_t kinds[PL_PIECE_KIND_COUNT] = { 0 };
    for (size_t k = 0; k < sizeof flags / sizeof flags[0]; ++k) {
        uint32_t count = 0;
        for (uint32_t p = 0; p < w->pieces.table.count; ++p) {
            count +=
                w->pieces.kind[p] != PL_PIECE_FREE && (w->pieces.flags[p] & flags[k].flag) != 0;
        }
        if (count != flags[k].count) {
            return false;
        }
    }
    for (uint32_t p = 0; p < w->pieces.table.count; ++p) {
        ++kinds[w->pieces.kind[p]];
    }
    return memcmp(kinds + 1, w->piece_kinds + 1, sizeof kinds - sizeof kinds[0]) == 0;
}

bool pl_check_pieces(pl_suspect *s)
{
    const plumb_world *w = &s->world;
    const pl_pieces *pieces = &w->pieces;
    uint32_t live = 0, listed = 0;
    for (uint32_t p = 0; p < pieces->table.count; ++p) {
        if (pieces->kind[p] == PL_PIECE_FREE) {
            if (pieces->vertex_count[p] != 0) {
                return false;
            }
            continue;
        }
        if (!check_piece(s, p)) {
            return false;
        }
        ++live;
        listed += pieces->moving[p] < PL_OUT;
    }
    return live == pieces->live && (uint64_t)w->moving_count + w->sleep.resting_count == listed &&
           check_lists(s) && check_free_pieces(w, pieces->table.count - live) && check_pool(s) &&
           check_flag_counts(w);
}

//---- materials -----------------------------------------------------------------------------------

static bool names_material(const plumb_world *w, uint32_t slot_and_one)
{
    return slot_and_one == 0 || (slot_and_one - 1 < w->registry.count &&
                                 w->registry.slots[slot_and_one - 1].state == PL_SLOT_LIVE &&
                                 w->registry.slots[slot_and_one - 1].kind == PLUMB_KIND_MATERIAL);
}

static bool check_material_pairs(const plumb_world *w)
{
    const pl_material_pair *items = w->material_pairs.data;
    for (uint32_t i = 0; i < w->material_pair_count; ++i) {
        const uint32_t a = (uint32_t)(items[i].key >> 32), b = (uint32_t)items[i].key;
        const plumb_material_pair *v = &items[i].value;
        if ((i > 0 && items[i - 1].key >= items[i].key) || a > b || !names_material(w, a) ||
            !names_material(w, b) || !pl_desc_is_sound(PLUMB_TABLE_MATERIAL_PAIR, v)) {
            return false;
        }
    }
    return true;
}

static uint32_t row_of_key(const plumb_world *w, uint32_t slot_and_one)
{
    return slot_and_one == 0 ? 0 : w->registry.slots[slot_and_one - 1].row;
}

// How many pieces, and how many entries of the table, name each material.
static bool check_users(pl_suspect *s)
{
    const plumb_world *w = &s->world;
    const pl_material_pair *items = w->material_pairs.data;
    const size_t bytes = w->materials.table.count * sizeof(uint32_t);
    for (uint32_t p = 0; p < w->pieces.table.count; ++p) {
        if (w->pieces.kind[p] != PL_PIECE_FREE) {
            ++s->marks[w->pieces.material[p]];
        }
    }
    bool sound = memcmp(s->marks, w->materials.users, bytes) == 0;
    memset(s->marks, 0, bytes);
    for (uint32_t i = 0; i < w->material_pair_count; ++i) {
        ++s->marks[row_of_key(w, (uint32_t)(items[i].key >> 32))];
        ++s->marks[row_of_key(w, (uint32_t)items[i].key)];
    }
    sound &= memcmp(s->marks, w->materials.pairs, bytes) == 0;
    memset(s->marks, 0, bytes);
    return sound;
}

bool pl_check_materials(pl_suspect *s)
{
    const plumb_world *w = &s->world;
    if (w->materials.table.count == 0 || !check_material_pairs(w)) {
        return false;
    }
    for (uint32_t m = 0; m < w->materials.table.count; ++m) {
        const pl_slot *slot = pl_registry_find(&w->registry, w->materials.entity[m].entity);
        const bool named = slot != NULL && slot->kind == PLUMB_KIND_MATERIAL && slot->row == m;
        if ((m > 0) != named || (m == 0 && !plumb_is_null(w->materials.entity[m]))) {
            return false;
        }
    }
    return check_users(s);
}
