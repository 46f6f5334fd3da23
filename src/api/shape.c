// shape.c - shapes are added to bodies, removed and asked. A shape's entity names its first piece.
//
// Reads: arguments, pieces. Writes: piece rows through piece.c, mass through mass.c.
// Cost: to add to a static body O(pieces of the shape), to another and to remove O(pieces of the body); O(pieces of the shape) to ask.
#include "world/destroy.h"
#include "world/island.h"
#include "narrow/one_way.h"
#include "query/query.h"
#include "world/check.h"
#include "world/filter.h"
#include "world/rows.h"
#include "world/told.h"
#include "world/waves_list.h"

//---- create, destroy -----------------------------------------------------------------------------

static bool is_line(const plumb_shape_desc *desc)
{
    return desc->kind == PLUMB_SEGMENT || desc->kind == PLUMB_CHAIN;
}

static plumb_result check_mass(const plumb_world *world, const char *fn, uint32_t row,
                               const pl_made *made, real density)
{
    const pl_bodies *b = &world->bodies;
    if (b->type[row] != PLUMB_DYNAMIC) {
        return PLUMB_OK;
    }
    pl_mass_sum sum = pl_mass_of_shapes(world, row);
    pl_mass_add(&sum, made->area, density);
    pl_body_mass mass;
    if (pl_mass_resolve(&sum, b->set_mass[row], b->set_inertia[row], &mass)) {
        return PLUMB_OK;
    }
    return pl_fail(world, PLUMB_E_RANGE, fn,
                   "density is %g; mass and inertia of the body must be %g to %g", (double)density,
                   (double)PL_MASS_LEAST, (double)PL_MASS_MOST);
}

static void set_material(plumb_world *world, uint32_t first, uint32_t row)
{
    pl_pieces *pieces = &world->pieces;
    for (uint32_t p = first; p != PL_NONE; p = pieces->next_in_shape[p]) {
        pieces->material[p] = row;
        pieces->friction[p] = world->materials.friction[row];
        pieces->restitution[p] = world->materials.restitution[row];
        ++world->materials.users[row];
    }
}

plumb_result pl_shape_insert(plumb_world *world, const char *fn, uint32_t row,
                             const plumb_shape_desc *desc, const pl_made *made, plumb_shape *shape)
{
    uint32_t material = plumb_is_null(desc->material) ? 0 : pl_material_row(world, desc->material);
    real density = desc->density > 0 ? desc->density : world->materials.density[material];
    density = is_line(desc) || desc->sensor ? 0 : density;
    if (desc->sensor) {
        PL_TRY(PL_CHECK_HAS(world, fn, "a sensor", SENSORS, "sensors"));
    }
    PL_TRY(check_mass(world, fn, row, made, density));
    if (!pl_registry_reserve(&world->memory, &world->registry, 1) ||
        !pl_pieces_reserve(world, made->count) ||
        !pl_pool_reserve(&world->memory, &world->vertices, made->corners)) {
        return pl_fail_memory(world, fn);
    }
    shape->entity = pl_entity_claim(world, shape->entity, PLUMB_KIND_SHAPE, PL_NONE);
    uint32_t first = pl_pieces_add(world, row, *shape, made);
    world->registry.slots[shape->entity.index].row = first;
    set_material(world, first, material);
    for (uint32_t p = first; p != PL_NONE; p = world->pieces.next_in_shape[p]) {
        world->pieces.shape_kind[p] = (uint8_t)desc->kind;
        world->pieces.density[p] = density;
        world->pieces.own_density[p] = desc->density;
        world->pieces.user_data[p] = desc->user_data;
    }
    pl_filter_apply(world, first, &desc->filter);
    if (desc->sensor) {
        pl_sensor_apply(world, first, true);
    }
    if (desc->one_way.direction.x != 0 || desc->one_way.direction.y != 0) {
        pl_one_way_apply(world, first, &desc->one_way);
    }
    if (world->waves.count > 0 && pl_waves_of(world, *shape) != NULL) {
        pl_waves_refile(world, *shape, true); // of a handle that was taken over
    }
    pl_mass_revise(world, row);
    return PLUMB_OK;
}

plumb_shape plumb_shape_create(plumb_world *world, plumb_body body, const plumb_shape_desc *desc)
{
    plumb_shape shape = PLUMB_NULL_INIT;
    uint32_t row;
    pl_made made;
    if (pl_check_body(world, __func__, body, &row) == PLUMB_OK &&
        pl_check_unlocked(world, __func__) == PLUMB_OK &&
        pl_shape_make(world, __func__, desc, &made) == PLUMB_OK) {
        pl_shape_insert(world, __func__, row, desc, &made, &shape);
        pl_told(world, body.entity, __func__);
    }
    return shape;
}

plumb_result plumb_shape_destroy(plumb_world *world, plumb_shape shape)
{
    uint32_t first;
    PL_TRY(pl_check_shape(world, __func__, shape, &first));
    PL_TRY(pl_check_unlocked(world, __func__));
    pl_destroy_entity(world, shape.entity);
    return PLUMB_OK;
}

//---- setters -------------------------------------------------------------------------------------

plumb_result plumb_shape_set_material(plumb_world *world, plumb_shape shape,
                                      plumb_material material)
{
    uint32_t first;
    uint32_t row;
    PL_TRY(pl_check_shape(world, __func__, shape, &first));
    PL_TRY(pl_check_material(world, __func__, material, &row));
    if (world->pieces.material[first] == row) {
        return PLUMB_OK; // nothing wakes
    }
    for (uint32_t p = first; p != PL_NONE; p = world->pieces.next_in_shape[p]) {
        --world->materials.users[world->pieces.material[p]];
        pl_sleep_disturb_piece(world, p);
    }
    set_material(world, first, row);
    for (uint32_t p = first; p != PL_NONE && world->materials.fluid[row];
         p = world->pieces.next_in_shape[p]) {
        pl_sleep_disturb_piece(world, p); // what lies in it floats
    }
    world->schedule_dirty = true;
    return PLUMB_OK;
}

plumb_result plumb_shape_set_density(plumb_world *world, plumb_shape shape, plumb_real density)
{
    uint32_t first;
    PL_TRY(pl_check_shape(world, __func__, shape, &first));
    PL_TRY(pl_check_range(world, __func__, "density", density, 0, PLUMB_REAL_MAX));
    pl_pieces *pieces = &world->pieces;
    uint32_t row = pieces->body[first];
    real own = pieces->own_density[first], old = pieces->density[first];
    if (density == own && old == pl_density_of(world, first)) {
        return PLUMB_OK;
    }
    for (uint32_t p = first; p != PL_NONE; p = pieces->next_in_shape[p]) {
        pieces->own_density[p] = density;
        pieces->density[p] = pl_density_of(world, p);
    }
    const plumb_result r = check_mass(world, __func__, row, &(pl_made){ 0 }, density);
    for (uint32_t p = first; r != PLUMB_OK && p != PL_NONE; p = pieces->next_in_shape[p]) {
        pieces->own_density[p] = own;
        pieces->density[p] = old;
    }
    if (r == PLUMB_OK) {
        pl_mass_revise(world, row);
        pl_sleep_disturb(world, row);
    }
    return r;
}

// Whether what was made is, piece by piece, what the shape is made of.
static bool has_form(const plumb_world *world, uint32_t first, plumb_shape_kind kind,
                     const pl_made *made)
{
    const pl_pieces *pieces = &world->pieces;
    const pl_made_piece *source = world->made.data;
    uint32_t i = 0, p = first;
    for (; p != PL_NONE && i < made->count; p = pieces->next_in_shape[p], ++i) {
        const plumb_convex *wanted = &source[i].convex;
        plumb_convex now;
        pl_piece_convex(world, p, &now);
        if (pieces->shape_kind[p] != (uint8_t)kind || pieces->kind[p] != source[i].kind ||
            pieces->cuts[p] != source[i].cuts || now.count != wanted->count ||
            now.radius != wanted->radius) {
            return false;
        }
        for (int k = 0; k < now.count; ++k) {
            if (now.points[k].x != wanted->points[k].x || now.points[k].y != wanted->points[k].y) {
                return false;
            }
        }
    }
    return p == PL_NONE && i == made->count;
}

plumb_result plumb_shape_set_geometry(plumb_world *world, plumb_shape shape,
                                      const plumb_shape_desc *desc)
{
    uint32_t first;
    PL_TRY(pl_check_shape(world, __func__, shape, &first));
    PL_TRY(pl_check_pointer(world, __func__, "desc", desc));
    PL_TRY(pl_check_unlocked(world, __func__));
    const pl_pieces *pieces = &world->pieces;
    uint32_t row = pieces->body[first];
    plumb_shape_desc wanted = *desc;
    wanted.material = plumb_shape_material(world, shape);
    wanted.density = pieces->own_density[first];
    wanted.filter = plumb_shape_filter(world, shape);
    wanted.filter.mask = wanted.filter.nothing ? 0 : wanted.filter.mask;
    wanted.one_way = plumb_shape_one_way(world, shape);
    wanted.sensor = plumb_shape_is_sensor(world, shape);
    wanted.user_data = pieces->user_data[first];
    pl_made made;
    PL_TRY(pl_shape_make(world, __func__, &wanted, &made));
    if (has_form(world, first, wanted.kind, &made)) {
        return PLUMB_OK;
    }
    // The new pieces take the handle over while the old ones are there: only then can nothing fail.
    PL_TRY(pl_shape_insert(world, __func__, row, &wanted, &made, &shape));
    pl_pieces_move_behind(world, pl_shape_piece(world, shape), first);
    pl_pieces_remove(world, first);
    pl_mass_revise(world, row);
    pl_sleep_disturb_shape(world, pl_shape_piece(world, shape));
    return PLUMB_OK;
}

plumb_result plumb_shape_set_user_data(plumb_world *world, plumb_shape shape, void *user_data)
{
    uint32_t first;
    PL_TRY(pl_check_shape(world, __func__, shape, &first));
    world->pieces.user_data[first] = user_data;
    return PLUMB_OK;
}

//---- getters -------------------------------------------------------------------------------------

bool plumb_shape_valid(const plumb_world *world, plumb_shape shape)
{
    return pl_shape_piece(world, shape) != PL_NONE;
}

// plumb_shape_<name>: what is told of the shape's first piece; zeros for a bad handle.
#define GETTER(type, name, value)                                                                  \
    type plumb_shape_##name(const plumb_world *world, plumb_shape shape)                           \
    {                                                                                              \
        const uint32_t p = pl_ask_shape(world, __func__, shape);                                   \
        return p == PL_NONE ? (type){ 0 } : (value);                                               \
    }

GETTER(plumb_shape_kind, get_kind, (plumb_shape_kind)world->pieces.shape_kind[p])
GETTER(plumb_body, body, world->bodies.entity[world->pieces.body[p]])
// The default material has no handle: null.
GETTER(plumb_material, material, world->materials.entity[world->pieces.material[p]])
GETTER(plumb_real, density, world->pieces.density[p])
GETTER(void *, user_data, world->pieces.user_data[p])

plumb_mass_properties plumb_shape_mass(const plumb_world *world, plumb_shape shape)
{
    uint32_t first = pl_ask_shape(world, __func__, shape);
    if (first == PL_NONE) {
        return (plumb_mass_properties){ 0 };
    }
    plumb_mass_properties m = world->pieces.area[first];
    m.mass *= world->pieces.density[first];
    m.inertia *= world->pieces.density[first];
    return m;
}

//---- geometry ------------------------------------------------------------------------------------

int plumb_shape_piece_count(const plumb_world *world, plumb_shape shape)
{
    int count = 0;
    uint32_t p = pl_ask_shape(world, __func__, shape);
    for (; p != PL_NONE; p = world->pieces.next_in_shape[p]) {
        ++count;
    }
    return count;
}

plumb_result plumb_shape_piece(const plumb_world *world, plumb_shape shape, int i,
                               plumb_convex *piece, uint32_t *cuts)
{
    uint32_t p;
    PL_TRY(pl_check_shape(world, __func__, shape, &p));
    PL_TRY(pl_check_pointer(world, __func__, "piece", piece));
    int count = plumb_shape_piece_count(world, shape);
    if (i < 0 || i >= count) {
        return pl_fail(world, PLUMB_E_RANGE, __func__, "i is %d; it must be 0 to %d", i, count - 1);
    }
    for (int k = 0; k < i; ++k) {
        p = world->pieces.next_in_shape[p];
    }
    pl_piece_convex(world, p, piece);
    if (cuts != NULL) {
        *cuts = world->pieces.cuts[p];
    }
    return PLUMB_OK;
}

plumb_aabb plumb_shape_aabb(const plumb_world *world, plumb_shape shape)
{
    plumb_aabb box = plumb_aabb_empty();
    uint32_t p = pl_ask_shape(world, __func__, shape);
    for (; p != PL_NONE; p = world->pieces.next_in_shape[p]) {
        pl_box t = pl_piece_tight_box(world, p);
        box = plumb_aabb_union(box, (plumb_aabb){ { t.min_x, t.min_y }, { t.max_x, t.max_y } });
    }
    return box;
}

bool plumb_shape_contains(const plumb_world *world, plumb_shape shape, plumb_vec2 point)
{
    uint32_t p = pl_ask_shape(world, __func__, shape);
    if (p == PL_NONE) {
        return false;
    }
    for (; p != PL_NONE; p = world->pieces.next_in_shape[p]) {
        plumb_convex convex;
        pl_query_convex(world, p, &convex); // no point slips between two pieces
        plumb_transform frame = pl_query_frame(world, p, point);
        if (plumb_convex_contains(&convex, plumb_transform_inv_apply(frame, point))) {
            return true;
        }
    }
    return false;
}

int plumb_world_shapes(const plumb_world *world, plumb_shape *shapes, int capacity)
{
    if (world == NULL) {
        return 0;
    }
    const pl_pieces *pieces = &world->pieces;
    int count = 0;
    for (uint32_t p = 0; p < pieces->table.count; ++p) {
        // Only the first piece of a shape is the one that its entity names.
        if (pieces->kind[p] == PL_PIECE_FREE ||
            world->registry.slots[pieces->shape[p].entity.index].row != p) {
            continue;
        }
        if (shapes != NULL && count < capacity) {
            shapes[count] = pieces->shape[p];
        }
        ++count;
    }
    return count;
}
