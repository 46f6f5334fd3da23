// component.c - the public functions of components and views, and the hooks that run as values come and
// go.
//
// Hooks run with the world locked. Reads, writes: the sets of src/ecs. Cost: O(1) a value; O(components) to
// drop all of an entity.
#include "world/component.h"

#include "ecs/view.h"
#include "world/observer.h"
#include "world/check.h"
#include "world/rows.h"

#include <string.h>

#define SIZE_MOST   65536u // [B] of a value, see plumb_component_desc
#define FIELDS_MOST 64

static pl_component *find(const plumb_world *world, plumb_component component)
{
    return pl_component_find(&world->components, component);
}

static plumb_result check_component(const plumb_world *world, const char *fn,
                                    plumb_component component)
{
    if (find(world, component) != NULL) {
        return PLUMB_OK;
    }
    return pl_fail(world, PLUMB_E_HANDLE, fn, "component is %u; it must be a registered component",
                   (unsigned)component.id);
}

bool pl_component_in_use(const plumb_world *world, plumb_component component)
{
    const pl_component *c = find(world, component);
    return c != NULL && c->count > 0;
}

//---- registration --------------------------------------------------------------------------------

static plumb_result check_fields(const plumb_world *world, const char *fn,
                                 const plumb_component_desc *desc)
{
    static const size_t sizes[] = { 4, 8, 4, 8, 4, 8, sizeof(bool) };
    if (desc->field_count < 0 || desc->field_count > FIELDS_MOST) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "field_count is %d; it must be 0 to %d",
                       desc->field_count, FIELDS_MOST);
    }
    if (desc->field_count > 0 && desc->fields == NULL) {
        return pl_check_pointer(world, fn, "fields", NULL);
    }
    for (int i = 0; i < desc->field_count; ++i) {
        const plumb_field *f = &desc->fields[i];
        plumb_result r = pl_check_name(world, fn, "field name", f->name);
        if (r != PLUMB_OK) {
            return r;
        }
        if ((unsigned)f->type > PLUMB_FIELD_BOOL) {
            return pl_fail(world, PLUMB_E_RANGE, fn,
                           "type of field '%s' is %d; it must be a plumb_field_type", f->name,
                           (int)f->type);
        }
        if (f->offset > desc->size || desc->size - f->offset < sizes[f->type]) {
            return pl_fail(
                world, PLUMB_E_RANGE, fn,
                "offset of field '%s' is %zu; the field must lie in the %zu bytes of a value",
                f->name, f->offset, desc->size);
        }
    }
    return PLUMB_OK;
}

static plumb_result check_desc(const plumb_world *world, const char *fn,
                               const plumb_component_desc *desc)
{
    PL_TRY(pl_check_pointer(world, fn, "desc", desc));
    PL_TRY(pl_check_name(world, fn, "name", desc->name));
    if ((desc->size == 0 || desc->size > SIZE_MOST)) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "size is %zu; it must be 1 to %u", desc->size,
                       SIZE_MOST);
    }
    PL_TRY(check_fields(world, fn, desc));
    if (plumb_component_find(world, desc->name).id != 0) {
        return pl_fail(world, PLUMB_E_DUPLICATE, fn, "name is '%s'; it must be new", desc->name);
    }
    if (world->components.count == PL_COMPONENT_MAX) {
        return pl_fail(world, PLUMB_E_CAPACITY, fn,
                       "component is the %dth; there must be at most %d", PL_COMPONENT_MAX + 1,
                       PL_COMPONENT_MAX);
    }
    return PLUMB_OK;
}

plumb_component plumb_component_create(plumb_world *world, const plumb_component_desc *desc)
{
    plumb_component made = { 0 };
    if (world == NULL || pl_check_unlocked(world, __func__) != PLUMB_OK ||
        check_desc(world, __func__, desc) != PLUMB_OK) {
        return made;
    }
    made = pl_component_register(&world->memory, &world->components, desc);
    if (made.id == 0) {
        pl_fail_memory(world, __func__);
    }
    return made;
}

plumb_component plumb_component_find(const plumb_world *world, const char *name)
{
    if (world != NULL && name != NULL) {
        for (uint32_t i = 0; i < world->components.count; ++i) {
            if (strcmp(world->components.items[i].name, name) == 0) {
                return (plumb_component){ i + 1 };
            }
        }
    }
    return (plumb_component){ 0 };
}

plumb_result plumb_component_info(const plumb_world *world, plumb_component component,
                                  plumb_component_desc *desc)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(check_component(world, __func__, component));
    PL_TRY(pl_check_pointer(world, __func__, "desc", desc));
    *desc = find(world, component)->desc;
    return PLUMB_OK;
}

//---- values --------------------------------------------------------------------------------------

static void run_hook(plumb_world *world, const pl_component *c, plumb_component_hook *hook,
                     uint32_t place)
{
    if (hook == NULL) {
        return;
    }
    const char *locked_by = world->locked_by;
    bool in_hook = world->in_hook;
    world->locked_by = c->name;
    world->in_hook = true;
    hook(world, pl_component_owners(c)[place], pl_component_value(c, place), c->desc.context);
    world->locked_by = locked_by;
    world->in_hook = in_hook;
}

bool pl_component_put(plumb_world *world, plumb_entity entity, plumb_component component,
                      const void *value)
{
    pl_component *c = find(world, component);
    uint32_t place = pl_component_place(c, entity.index);
    if (place != PL_ABSENT) {
        pl_component_write(c, place, value);
        return true;
    }
    place = pl_component_append(&world->memory, c, entity, value);
    if (place == PL_ABSENT) {
        return false;
    }
    world->schedule_dirty = true;
    run_hook(world, c, c->desc.on_add, place);
    return true;
}

// What it does within a step is recorded there, and replayed without it: see world/observer.h.
static void run_drop_hook(plumb_world *world, const pl_component *c, uint32_t place)
{
    pl_step_observer *observer = world->observer;
    bool told = observer != NULL && observer->steps;
    if (told && observer->dropping != NULL) {
        observer->dropping(observer, world);
    }
    run_hook(world, c, c->desc.on_remove, place);
    if (told && observer->dropped != NULL) {
        observer->dropped(observer, world);
    }
}

bool pl_component_drop(plumb_world *world, plumb_entity entity, plumb_component component)
{
    pl_component *c = find(world, component);
    const uint32_t place = pl_component_place(c, entity.index);
    if (place == PL_ABSENT) {
        return false;
    }
    run_drop_hook(world, c, place);
    pl_component_erase(c, place);
    world->schedule_dirty = true;
    return true;
}

void pl_components_drop_all(plumb_world *world, plumb_entity entity)
{
    for (uint32_t id = 1; id <= world->components.count; ++id) {
        pl_component_drop(world, entity, (plumb_component){ id });
    }
}

void pl_components_bury(plumb_world *world)
{
    for (uint32_t i = 0; i < world->components.count; ++i) {
        pl_component *c = &world->components.items[i];
        for (uint32_t place = 0; place < c->count; ++place) {
            run_hook(world, c, c->desc.on_remove, place);
        }
    }
}

plumb_result plumb_component_set(plumb_world *world, plumb_entity entity, plumb_component component,
                                 const void *value)
{
    PL_TRY(pl_check_entity(world, __func__, entity));
    PL_TRY(check_component(world, __func__, component));
    if (pl_component_place(find(world, component), entity.index) == PL_ABSENT) {
        PL_TRY(
            pl_check_unlocked(world, __func__)); // adding a row is structural, overwriting is not
    }
    return pl_component_put(world, entity, component, value) ? PLUMB_OK
                                                             : pl_fail_memory(world, __func__);
}

void *plumb_component_get(plumb_world *world, plumb_entity entity, plumb_component component)
{
    if (world == NULL || pl_check_entity(world, __func__, entity) != PLUMB_OK) {
        return NULL;
    }
    const pl_component *c = find(world, component);
    const uint32_t place = c == NULL ? PL_ABSENT : pl_component_place(c, entity.index);
    return place == PL_ABSENT ? NULL : pl_component_value(c, place);
}

plumb_result plumb_component_remove(plumb_world *world, plumb_entity entity,
                                    plumb_component component)
{
    PL_TRY(pl_check_entity(world, __func__, entity));
    PL_TRY(check_component(world, __func__, component));
    PL_TRY(pl_check_unlocked(world, __func__));
    if (!pl_component_drop(world, entity, component)) {
        return pl_fail(world, PLUMB_E_MISSING, __func__, "entity has no '%s'; it must have it",
                       find(world, component)->name);
    }
    return PLUMB_OK;
}

plumb_component_span plumb_world_column(plumb_world *world, plumb_component component)
{
    const pl_component *c = world == NULL ? NULL : find(world, component);
    if (c == NULL) {
        return (plumb_component_span){ 0 };
    }
    return (plumb_component_span){ (int)c->count, c->desc.size, c->owners.data, c->values.data };
}

//---- views ---------------------------------------------------------------------------------------

static int components_of(const plumb_body_view_desc *desc)
{
    int count = 0;
    while (count < PLUMB_VIEW_MOST && desc->with[count].id != 0) {
        ++count;
    }
    return count;
}

static plumb_result check_view(const plumb_world *world, const char *fn,
                               const plumb_body_view_desc *desc)
{
    PL_TRY(pl_check_pointer(world, fn, "desc", desc));
    if ((unsigned)desc->rows > PLUMB_VIEW_ALL) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "rows is %d; it must be a plumb_view_rows",
                       (int)desc->rows);
    }
    const int count = components_of(desc);
    for (int k = 0; k < count || k == 0; ++k) {
        if (find(world, desc->with[k]) == NULL) {
            return pl_fail(world, PLUMB_E_HANDLE, fn,
                           "with[%d] is %u; it must be a registered component", k,
                           (unsigned)desc->with[k].id);
        }
    }
    return PLUMB_OK;
}

static void set_rows(const plumb_world *world, plumb_view_rows rows, plumb_body_view *view)
{
    const uint32_t dynamic = world->dynamic_count, kinematic = world->kinematic_count;
    view->last = rows == PLUMB_VIEW_ALL      ? world->bodies.table.count
                 : rows == PLUMB_VIEW_MOVING ? dynamic + kinematic
                                             : dynamic;
    if (rows == PLUMB_VIEW_DYNAMIC) {
        view->more_first = dynamic + kinematic;
        view->more_last = dynamic + kinematic + world->asleep_count;
    }
}

plumb_result plumb_body_view_open(plumb_world *world, const plumb_body_view_desc *desc,
                                  plumb_body_view *view)
{
    plumb_body_view opened = { 0 };
    if (view != NULL) {
        *view = opened;
    }
    PL_TRY(world == NULL ? PLUMB_E_NULL : pl_check_pointer(world, __func__, "view", view));
    PL_TRY(check_view(world, __func__, desc));
    const int count = components_of(desc);
    for (int k = 0; k < count; ++k) {
        pl_component *c = find(world, desc->with[k]);
        if (!pl_view_prepare(&world->memory, c, &world->registry, PLUMB_KIND_BODY)) {
            return pl_fail_memory(world, __func__);
        }
        pl_view_add(&opened, c);
    }
    set_rows(world, desc->rows, &opened);
    *view = opened;
    return PLUMB_OK;
}
