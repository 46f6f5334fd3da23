// restore.c - a world becomes what its image says.
//
// In three stages: the image is checked whole; then room is made for all of it; then it is copied in
// and what follows from it is made anew. Only the second can run out of memory and only the third
// changes the state, so a refused image changes nothing.
//
// Made anew: poses (from origins, rotations and centres), rows of components (from their owners),
// the schedule, the plan of the joints, the lists of joints awake and of what moves near what sleeps. The grids follow from fat
// boxes and lists of pieces; they are kept where those are what they were, else filed again by whoever
// asks for them next. Events and contacts of the
// last step are gone.
//
// Reads: image, base. Writes: the world. Cost: O(state) digested and copied. No allocation where
// the world has held as much before.
#include "event/event.h"
#include "narrow/narrow.h"
#include "plumb/snapshot.h"
#include "snapshot/image.h"
#include "watchdog/watchdog.h"
#include "world/check.h"
#include "world/push.h"

#include <string.h>

plumb_result pl_image_fit(const plumb_world *world, const char *function, const char *field,
                          const void *buffer, size_t size, bool strict, pl_image *image)
{
    const char *wrong = pl_image_open(buffer, size, strict, image);
    if (wrong != NULL) {
        return pl_fail(world, PLUMB_E_IMAGE, function, "%s %s; it must be as it was saved", field,
                       wrong);
    }
    if (image->header.user_schema != pl_section_user_schema(world) ||
        image->header.section_count != pl_section_count(world)) {
        return pl_fail(world, PLUMB_E_IMAGE, function,
                       "%s has other components; register the same ones in the same order", field);
    }
    pl_image_cursor at = pl_image_begin(image);
    for (uint32_t i = 0; i < pl_section_count(world); ++i) {
        pl_image_next(image, &at);
        if (at.entry.stride != 0 && at.entry.stride != pl_section_at(world, i).stride) {
            return pl_fail(world, PLUMB_E_IMAGE, function,
                           "%s is damaged; it must be as it was saved", field);
        }
    }
    return PLUMB_OK;
}

//---- the sections of a frame and its base as one row ---------------------------------------------

typedef struct source {
    const pl_image *image, *base; // base NULL: the image is complete
    pl_image_cursor at, base_at;
    const char *data; // of the section that was reached
    uint32_t count;
} source;

static source source_begin(const pl_image *image, const pl_image *base)
{
    source s = { .image = image, .base = base, .at = pl_image_begin(image) };
    if (base != NULL) {
        s.base_at = pl_image_begin(base);
    }
    return s;
}

static void source_next(source *s)
{
    pl_image_next(s->image, &s->at);
    s->data = s->at.data;
    s->count = s->at.entry.count;
    if (s->base != NULL) {
        pl_image_next(s->base, &s->base_at);
        if (s->at.entry.stride == 0) {
            s->data = s->base_at.data;
            s->count = s->base_at.entry.count;
        }
    }
}

//---- room ----------------------------------------------------------------------------------------

// Rows of components lie by registry slot.
static bool reserve_component_rows(plumb_world *world, uint32_t slots)
{
    for (uint32_t i = 0; i < world->components.count; ++i) {
        pl_component *c = &world->components.items[i];
        size_t known = c->rows.size;
        if (c->owners.data != NULL &&
            !pl_buffer_reserve(&world->memory, &c->rows, slots * sizeof(uint32_t))) {
            return false;
        }
        if (c->rows.size > known) {
            memset((char *)c->rows.data + known, 0, c->rows.size - known);
        }
    }
    return true;
}

static bool reserve_all(plumb_world *world, source s)
{
    uint32_t slots = 0;
    for (uint32_t i = 0; i < pl_section_count(world); ++i) {
        source_next(&s);
        if (!pl_section_reserve(world, i, s.count)) {
            return false;
        }
        if (i == pl_section_registry()) {
            slots = s.count;
        }
    }
    return reserve_component_rows(world, slots);
}

//---- grids ---------------------------------------------------------------------------------------

// What the grids are filed from, in the image.
typedef struct filed {
    const char *kind, *moving, *fat, *list;
    uint32_t pieces, listed;
} filed;

static filed find_filed(const plumb_world *world, source s)
{
    filed f = { 0 };
    for (uint32_t i = 0; i < pl_section_fixed_count(); ++i) {
        source_next(&s);
        const char *now = pl_section_at(world, i).data;
        if (now == NULL) {
            continue;
        }
        if (now == (const char *)world->pieces.kind) {
            f.kind = s.data;
            f.pieces = s.count;
        } else if (now == (const char *)world->pieces.moving) {
            f.moving = s.data;
        } else if (now == (const char *)world->pieces.fat) {
            f.fat = s.data;
        } else if (now == (const char *)world->moving.data) {
            f.list = s.data;
            f.listed = s.count;
        }
    }
    return f;
}

static bool is_fixed_grid_kept(const plumb_world *world, const filed *f)
{
    const pl_pieces *p = &world->pieces;
    uint32_t count = p->table.count;
    if (world->broad.fixed_lost || world->static_dirty || count == 0 || f->pieces != count ||
        memcmp(f->kind, p->kind, count * sizeof *p->kind) != 0 ||
        memcmp(f->moving, p->moving, count * sizeof *p->moving) != 0) {
        return false;
    }
    for (uint32_t i = 0; i < count; ++i) {
        if (p->kind[i] != PL_PIECE_FREE && p->moving[i] == PL_NONE &&
            memcmp(f->fat + i * sizeof *p->fat, &p->fat[i], sizeof *p->fat) != 0) {
            return false;
        }
    }
    return true;
}

static bool is_moving_grid_kept(const plumb_world *world, const filed *f)
{
    const pl_pieces *p = &world->pieces;
    uint32_t count = p->table.count;
    return !world->broad.moving_lost && !world->broad.unfiled && !world->pairs_dirty && count > 0 &&
           f->pieces == count && world->moving_count > 0 && f->listed == world->moving_count &&
           memcmp(f->list, world->moving.data, f->listed * sizeof(uint32_t)) == 0 &&
           memcmp(f->fat, p->fat, count * sizeof *p->fat) == 0;
}

//---- the change ----------------------------------------------------------------------------------

// Where the rows of components are, by registry slot; or that there are none.
static void tell_rows(plumb_world *world, bool are_there)
{
    for (uint32_t i = 0; i < world->components.count; ++i) {
        const pl_component *c = &world->components.items[i];
        const plumb_entity *owner = c->owners.data;
        uint32_t *rows = c->rows.data;
        for (uint32_t row = 0; row < c->count; ++row) {
            rows[owner[row].index] = are_there ? row + 1 : 0;
        }
    }
}

static void forget_last_step(plumb_world *world)
{
    world->sleep.events_told = true; // those of a refused step too
    pl_events_clear(world);
    world->pending_hits.old_count = 0;
    world->sensing.old_count = world->sensing.rest_old_count = 0;
    world->internal_edges.old_load_count = world->internal_edges.contact_count = 0;
    world->sleep.sleep_event_count = world->sleep.wake_event_count = 0;
    world->sleep.events_told = false;
    world->joints.broken_count = world->joints.strained_count = 0;
    world->fracture.break_count = world->fracture.piece_count = 0;
    world->fracture.events_told = false;
    world->heats.gone_count = 0;
    world->liquid.contact_count = world->liquid.end_count = 0;
    world->liquid.index.fresh = false;
    world->quarantine.event_count = 0;
    pl_watchdog_forget(&world->watchdog);
    world->continuous.count = world->continuous.stopped_count = 0;
    pl_narrow_clear(&world->narrow);
    world->solver.slot_count = world->solver.dynamic_slots = 0;
    world->solver.bundle_count = world->solver.impact_count = 0;
    world->solver.colors_used = 0;
    world->solver.overflow_count = world->solver.bounce_count = world->solver.chain_count = 0;
}

static void take_over(plumb_world *world, source s)
{
    filed f = find_filed(world, s);
    bool keeps_fixed = is_fixed_grid_kept(world, &f);
    bool keeps_moving = is_moving_grid_kept(world, &f);
    pl_broad_forget_left(&world->broad);
    tell_rows(world, false);
    for (uint32_t i = 0; i < pl_section_count(world); ++i) {
        source_next(&s);
        pl_section_read(world, i, s.data, s.count);
    }
    tell_rows(world, true);
    pl_broad_mark_left(&world->broad);
    for (uint32_t row = 0; row < world->bodies.table.count; ++row) {
        pl_body_update_pose(world, row);
    }
    forget_last_step(world);
    world->broad.fixed_lost = !keeps_fixed;
    world->broad.moving_lost = !keeps_moving;
    world->broad.resting_lost =
        world->sleep.resting_count > 0 || world->broad.resting.entry_count > 0;
    world->broad.refreshed = world->broad.unfiled = world->query_grids.fresh = false;
    world->sleep.gone = 0;
    world->sleep.near.count = 0;
    world->sleep.near_stale = true;
    pl_sleep_heed_all(world);
    world->joints.awake_stale = true;
    pl_joints_replan(&world->joints);
    world->characters.moved = false;
    world->schedule_dirty = true;
}

bool pl_image_reserve(plumb_world *world, const pl_image *image)
{
    return reserve_all(world, source_begin(image, NULL));
}

bool pl_image_restore(plumb_world *world, const pl_image *image)
{
    if (!pl_image_reserve(world, image)) {
        return false;
    }
    take_over(world, source_begin(image, NULL));
    return true;
}

bool pl_image_has_sections_of(const plumb_world *world, const pl_image *image)
{
    pl_image_cursor at = pl_image_begin(image);
    bool fits = image->header.base == 0 && image->header.section_count == pl_section_count(world);
    for (uint32_t i = 0; fits && i < pl_section_count(world); ++i) {
        pl_image_next(image, &at);
        fits = at.entry.stride == pl_section_at(world, i).stride;
    }
    return fits;
}

// What systems and hooks cannot change.
static bool is_held(const pl_section *section)
{
    static const char *const held[][2] = {
        { "bodies", "entity" },
        { "bodies", "type" },
        { "bodies", "island" },
        { "bodies", "next_asleep" },
        { "bodies", "previous_asleep" },
        { "bodies", "first_piece" },
        { "bodies", "first_joint" },
        { "pieces", "shape" },
        { "pieces", "kind" },
        { "pieces", "vertex_count" },
        { "pieces", "vertex_class" },
        { "pieces", "vertices" },
        { "pieces", "body" },
        { "pieces", "next_in_body" },
        { "pieces", "next_in_shape" },
        { "pieces", "serial" },
        { "pieces", "core" },
        { "pieces", "moving" },
        { "pieces", "internal_edges" },
        { "materials", "entity" },
        { "vertices", "items" },
        { "world", "broad.pairs.items" },
        { "world", "broad.left" },
        { "world", "broad.sensed" },
        { "world", "moving" },
        { "world", "sleep.resting" },
        { "world", "internal_edges.corners" },
        { "world", "internal_edges.intervals" },
        { "world", "internal_edges.pairs" },
        { "world", "internal_edges.loads" },
        { "world", "pending_hits.items" },
        { "world", "sensing.candidates" },
        { "world", "sensing.overlaps" },
        { "world", "sensing.rest_candidates" },
        { "world", "sensing.rest_overlaps" },
    };
    for (size_t i = 0; i < sizeof held / sizeof held[0]; ++i) {
        if (strcmp(section->table, held[i][0]) == 0 && strcmp(section->name, held[i][1]) == 0) {
            return true;
        }
    }
    return false;
}

// Of these not even how many there are.
static bool is_counted(const pl_section *section)
{
    static const char *const counted[] = {
        "joints.items",         "sleep.islands",    "sleep.contacts",   "characters.items",
        "liquid.settings",      "liquid.particles", "liquid.phases",    "liquid.supports.items",
        "air.settings",         "air.cells",        "air.sources",      "air.supports.items",
        "laws.items",           "laws.formulas",    "laws.orbits",      "fracture.pending",
        "softbodies.items",     "softbodies.nodes", "softbodies.edges", "softbodies.bends",
        "softbodies.triangles", "softbodies.rings", "softbodies.pins",  "softbodies.rests",
        "waves.items",          "waves.modes",      "heats.items",      "heats.state"
    };
    for (size_t i = 0; i < sizeof counted / sizeof counted[0]; ++i) {
        if (strcmp(section->name, counted[i]) == 0) {
            return true;
        }
    }
    return false;
}

// Settings that decide which scratch the passes have.
static bool are_settings_held(const char *before, const char *after)
{
    pl_member m;
    bool same = true;
    for (uint32_t i = 0; pl_section_value(i, &m); ++i) {
        const bool held = strncmp(m.name, "desc.", 5) == 0 &&
                          strncmp(m.name, "desc.sleep", 10) != 0 &&
                          strcmp(m.name, "desc.no_sleep") != 0;
        same &= !held || memcmp(before + m.offset, after + m.offset, m.size) == 0;
    }
    return same;
}

bool pl_image_may_play(const plumb_world *world, const pl_image *before, const pl_image *after)
{
    pl_image_cursor a = pl_image_begin(before), b = pl_image_begin(after);
    for (uint32_t i = 0; i < pl_section_fixed_count(); ++i) {
        const pl_section section = pl_section_at(world, i);
        pl_image_next(before, &a);
        pl_image_next(after, &b);
        const size_t bytes = (size_t)b.entry.count * b.entry.stride;
        const bool alike = a.entry.count == b.entry.count;
        if ((is_held(&section) && (!alike || memcmp(a.data, b.data, bytes) != 0)) ||
            (is_counted(&section) && !alike)) {
            return false;
        }
        if (i == 0 && !are_settings_held(a.data, b.data)) {
            return false;
        }
    }
    return true;
}

void pl_image_play(plumb_world *world, const pl_image *before, const pl_image *after)
{
    source a = source_begin(before, NULL), b = source_begin(after, NULL);
    filed f = find_filed(world, b);
    bool keeps_fixed = is_fixed_grid_kept(world, &f);
    bool keeps_moving = is_moving_grid_kept(world, &f);
    tell_rows(world, false);
    for (uint32_t i = 0; i < pl_section_count(world); ++i) {
        source_next(&a);
        source_next(&b);
        if (a.count != b.count ||
            (b.count > 0 && memcmp(a.data, b.data, (size_t)b.count * b.at.entry.stride) != 0)) {
            pl_section_read(world, i, b.data, b.count);
        }
    }
    tell_rows(world, true);
    for (uint32_t row = 0; row < world->bodies.table.count; ++row) {
        pl_body_update_pose(world, row);
    }
    // No structural change happens within a step; what is due to be filed anew is marked as such.
    world->broad.fixed_lost |= !keeps_fixed && !world->static_dirty && f.pieces > 0;
    world->broad.moving_lost |= !keeps_moving && !world->pairs_dirty && f.listed > 0;
    world->query_grids.fresh = false;
    world->sleep.near_stale = true;
    pl_sleep_heed_all(world);
    world->joints.awake_stale = true;
    pl_joints_replan(&world->joints);
    world->schedule_dirty = true;
}

//---- images of others ----------------------------------------------------------------------------

// A buffer at an odd address is copied: what is checked is read as it stands.
static bool align(plumb_world *world, pl_buffer *room, pl_image *image)
{
    if ((uintptr_t)image->bytes % sizeof(uint64_t) == 0) {
        return true;
    }
    if (!pl_buffer_reserve(&world->memory, room, (size_t)image->header.bytes)) {
        return false;
    }
    memcpy(room->data, image->bytes, (size_t)image->header.bytes);
    image->bytes = room->data;
    return true;
}

bool pl_image_is_sound(plumb_world *world, const pl_image *image, const pl_image *base,
                       bool *starved)
{
    pl_buffer copies[2] = { { 0 }, { 0 } }, *list = &world->checked;
    pl_image aligned[2] = { *image, base == NULL ? *image : *base };
    const uint32_t count = pl_section_count(world);
    bool sound = false;
    *starved = !align(world, &copies[0], &aligned[0]) ||
               (base != NULL && !align(world, &copies[1], &aligned[1])) ||
               !pl_buffer_reserve(&world->memory, list, count * sizeof(pl_image_part));
    if (!*starved) {
        source s = source_begin(&aligned[0], base == NULL ? NULL : &aligned[1]);
        pl_image_part *parts = list->data;
        for (uint32_t i = 0; i < count; ++i) {
            source_next(&s);
            parts[i] = (pl_image_part){ s.data, s.count };
        }
        sound = pl_parts_are_sound(world, parts, starved);
    }
    pl_buffer_free(&world->memory, &copies[0]);
    pl_buffer_free(&world->memory, &copies[1]);
    return sound;
}

//---- public --------------------------------------------------------------------------------------

static plumb_result restore(plumb_world *world, const char *function, const pl_image *image,
                            const pl_image *base, bool trusted)
{
    bool starved = false;
    if (!trusted && !pl_image_is_sound(world, image, base, &starved) && !starved) {
        return pl_fail(world, PLUMB_E_IMAGE, function,
                       "the image holds what no world can be; it must be as it was saved");
    }
    source s = source_begin(image, base);
    if (starved || !reserve_all(world, s)) {
        return pl_fail_memory(world, function);
    }
    take_over(world, s);
    return PLUMB_OK;
}

static plumb_result restore_image(plumb_world *world, const char *function, const void *buffer,
                                  size_t size, bool trusted)
{
    PL_TRY(pl_check_world(world));
    pl_image image;
    PL_TRY(pl_check_unlocked(world, function));
    PL_TRY(pl_check_pointer(world, function, "buffer", buffer));
    PL_TRY(pl_image_fit(world, function, "buffer", buffer, size, true, &image));
    if (image.header.base != 0) {
        return pl_fail(world, PLUMB_E_IMAGE, function,
                       "buffer is a frame; plumb_world_restore_frame takes it with its base");
    }
    return restore(world, function, &image, NULL, trusted);
}

static plumb_result restore_frame(plumb_world *world, const char *function, const void *base,
                                  size_t base_size, const void *frame, size_t frame_size,
                                  bool trusted)
{
    PL_TRY(pl_check_world(world));
    pl_image image, base_image;
    PL_TRY(pl_check_unlocked(world, function));
    PL_TRY(pl_check_pointer(world, function, "base", base));
    PL_TRY(pl_check_pointer(world, function, "frame", frame));
    PL_TRY(pl_image_fit(world, function, "base", base, base_size, true, &base_image));
    PL_TRY(pl_image_fit(world, function, "frame", frame, frame_size, true, &image));
    if ((base_image.header.base != 0 || image.header.base != base_image.header.checksum)) {
        return pl_fail(world, PLUMB_E_IMAGE, function,
                       "base is not the one that the frame was made with");
    }
    return restore(world, function, &image, &base_image, trusted);
}

plumb_result plumb_world_restore(plumb_world *world, const void *buffer, size_t size)
{
    return restore_image(world, __func__, buffer, size, false);
}

plumb_result plumb_world_restore_trusted(plumb_world *world, const void *buffer, size_t size)
{
    return restore_image(world, __func__, buffer, size, true);
}

plumb_result plumb_world_restore_frame(plumb_world *world, const void *base, size_t base_size,
                                       const void *frame, size_t frame_size)
{
    return restore_frame(world, __func__, base, base_size, frame, frame_size, false);
}

plumb_result plumb_world_restore_frame_trusted(plumb_world *world, const void *base,
                                               size_t base_size, const void *frame,
                                               size_t frame_size)
{
    return restore_frame(world, __func__, base, base_size, frame, frame_size, true);
}
