// air.c - the world's air: made, filled, fed, asked.
//
// Reads: arguments. Writes: the air's settings, sources, cells. Cost: O(cells) to make, fill and sum it.
#include "api/listed.h"
#include "plumb/air.h"
#include "air/air.h"
#include "world/check.h"
#include "world/wrap.h"

#include <string.h>

#define FAR           ((real)1e6)
#define CELL_LEAST    ((real)1e-4)
#define CELL_MOST     ((real)1e4)
#define DENSITY_LEAST ((real)1e-9)
#define WARMTH_LEAST  ((real)1e-3)
#define MOST          ((real)1e9)
#define MOST_AMOUNT   ((real)PL_AIR_MOST)
#define SPEED_MOST    ((real)PL_AIR_SPEED)
#define CELLS_ALONG   64 // the longer side, by default

//---- settings ------------------------------------------------------------------------------------

// A number of the descriptor, and between what it lies; 0 is allowed of those that have a default.
typedef struct number {
    const char *name;
    real value, low, high;
    bool defaults;
} number;

enum { NUMBERS = 12 };

static void list_numbers(const plumb_air_desc *d, number out[NUMBERS])
{
    const number all[NUMBERS] = {
        { "position.x", d->position.x, -FAR, FAR, false },
        { "position.y", d->position.y, -FAR, FAR, false },
        { "half.x", d->half.x, CELL_LEAST, FAR, false },
        { "half.y", d->half.y, CELL_LEAST, FAR, false },
        { "cell", d->cell, CELL_LEAST, CELL_MOST, true },
        { "density", d->density, DENSITY_LEAST, MOST, true },
        { "viscosity", d->viscosity, 0, MOST, false },
        { "temperature", d->temperature, WARMTH_LEAST, MOST_AMOUNT, true },
        { "fading", d->fading, 0, MOST_AMOUNT, false },
        { "cooling", d->cooling, 0, MOST_AMOUNT, false },
        { "flow.x", d->flow.x, -SPEED_MOST, SPEED_MOST, false },
        { "flow.y", d->flow.y, -SPEED_MOST, SPEED_MOST, false },
    };
    memcpy(out, all, sizeof all);
}

static bool is_side(plumb_air_side side)
{
    return (int)side >= 0 && side <= PLUMB_AIR_FLOW;
}

static bool are_paired(plumb_air_side a, plumb_air_side b)
{
    return (a == PLUMB_AIR_PERIODIC) == (b == PLUMB_AIR_PERIODIC);
}

// Of cells that are not 0.
static double cells_of(const plumb_air_desc *d)
{
    const double x = 2 * (double)d->half.x / (double)d->cell;
    const double y = 2 * (double)d->half.y / (double)d->cell;
    return (x + 2) * (y + 2);
}

bool pl_air_desc_is_sound(const plumb_air_desc *d)
{
    number numbers[NUMBERS];
    list_numbers(d, numbers);
    bool sound = is_side(d->left) && is_side(d->right) && is_side(d->bottom) && is_side(d->top) &&
                 are_paired(d->left, d->right) && are_paired(d->bottom, d->top);
    for (int i = 0; i < NUMBERS; ++i) {
        sound &= numbers[i].value >= numbers[i].low && numbers[i].value <= numbers[i].high;
    }
    return sound && cells_of(d) <= PLUMB_AIR_MAX;
}

static plumb_air_desc resolved(const plumb_air_desc *d)
{
    plumb_air_desc out;
    memset(&out, 0, sizeof out); // padding, too: it is saved
    const real longer = d->half.x > d->half.y ? d->half.x : d->half.y;
    out.position = d->position;
    out.half = d->half;
    out.cell = d->cell > 0 ? d->cell : 2 * longer / CELLS_ALONG;
    out.density = d->density > 0 ? d->density : PLUMB_REAL(1.2);
    out.viscosity = d->viscosity;
    out.temperature = d->temperature > 0 ? d->temperature : 293;
    out.fading = d->fading;
    out.cooling = d->cooling;
    out.flow = d->flow;
    out.left = d->left;
    out.right = d->right;
    out.bottom = d->bottom;
    out.top = d->top;
    return out;
}

static plumb_result check_sides(const plumb_world *world, const char *fn, const plumb_air_desc *d)
{
    const struct {
        const char *name;
        plumb_air_side side;
    } all[] = {
        { "left", d->left }, { "right", d->right }, { "bottom", d->bottom }, { "top", d->top }
    };
    for (int i = 0; i < 4; ++i) {
        if (!is_side(all[i].side)) {
            return pl_fail(world, PLUMB_E_RANGE, fn, "%s is %d; it must be 0 to %d", all[i].name,
                           (int)all[i].side, (int)PLUMB_AIR_FLOW);
        }
    }
    for (int i = 0; i < 4; i += 2) {
        if (!are_paired(all[i].side, all[i + 1].side)) {
            return pl_fail(world, PLUMB_E_RANGE, fn,
                           "%s is %d and %s is %d; both must be periodic, or none", all[i].name,
                           (int)all[i].side, all[i + 1].name, (int)all[i + 1].side);
        }
    }
    return PLUMB_OK;
}

static plumb_result check_desc(const plumb_world *world, const char *fn, const plumb_air_desc *d)
{
    number numbers[NUMBERS];
    list_numbers(d, numbers);
    for (int i = 0; i < NUMBERS; ++i) {
        const number *n = &numbers[i];
        if (!n->defaults || n->value != 0) {
            PL_TRY(pl_check_range(world, fn, n->name, n->value, n->low, n->high));
        }
    }
    PL_TRY(check_sides(world, fn, d));
    const plumb_air_desc full = resolved(d);
    PL_TRY(pl_check_range(world, fn, "cell", full.cell, CELL_LEAST, CELL_MOST));
    if (cells_of(&full) > PLUMB_AIR_MAX) {
        return pl_fail(world, PLUMB_E_RANGE, fn,
                       "there would be %.0f cells; there must be at most %d", cells_of(&full),
                       PLUMB_AIR_MAX);
    }
    return PLUMB_OK;
}

static plumb_result check_air(const plumb_world *world, const char *fn)
{
    PL_TRY(pl_check_world(world));
    return world->air.settings_count > 0
               ? PLUMB_OK
               : pl_fail(world, PLUMB_E_STATE, fn,
                         "the world has no air; it must be made with plumb_air_create");
}

// All cells are free, where none is said to be.
static void give_room(pl_air *air)
{
    plumb_air_cell *cells = pl_air_items(air);
    const pl_air_extent box = pl_air_extent_of(pl_air_desc(air));
    for (uint32_t i = 0; i < air->cell_count; ++i) {
        if (cells[i].room > 0) {
            return;
        }
    }
    for (int32_t j = 0; j < box.rows; ++j) {
        for (int32_t i = 0; i < box.columns; ++i) {
            cells[j * (box.columns + 1) + i].room = 1;
        }
    }
}

plumb_result plumb_air_create(plumb_world *world, const plumb_air_desc *desc)
{
    PL_TRY(pl_check_world(world));
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(PL_CHECK_HAS(world, __func__, "air", AIR, "air"));
    PL_TRY(pl_check_pointer(world, __func__, "desc", desc));
    pl_air *air = &world->air;
    if (air->settings_count > 0) {
        return pl_fail(world, PLUMB_E_STATE, __func__, "the world has air; it must have none");
    }
    if (pl_is_wrapped(world)) {
        return pl_fail(world, PLUMB_E_STATE, __func__,
                       "the world wraps around; one with air must not");
    }
    PL_TRY(check_desc(world, __func__, desc));
    const plumb_air_desc d = resolved(desc);
    const pl_air_extent box = pl_air_extent_of(&d);
    const uint32_t count = (uint32_t)((box.columns + 1) * (box.rows + 1));
    if (!pl_buffer_reserve(&world->memory, &air->settings, sizeof d) ||
        !pl_buffer_reserve(&world->memory, &air->cells, count * sizeof(plumb_air_cell))) {
        return pl_fail_memory(world, __func__);
    }
    memcpy(air->settings.data, &d, sizeof d);
    memset(air->cells.data, 0, count * sizeof(plumb_air_cell));
    air->settings_count = 1;
    air->cell_count = count;
    give_room(air);
    world->schedule_dirty = true;
    return PLUMB_OK;
}

plumb_result plumb_air_destroy(plumb_world *world)
{
    PL_TRY(check_air(world, __func__));
    PL_TRY(pl_check_unlocked(world, __func__));
    pl_air_free(&world->memory, &world->air);
    world->schedule_dirty = true;
    return PLUMB_OK;
}

plumb_result plumb_air_settings(const plumb_world *world, plumb_air_desc *desc)
{
    PL_TRY(check_air(world, __func__));
    PL_TRY(pl_check_pointer(world, __func__, "desc", desc));
    *desc = *pl_air_desc(&world->air);
    return PLUMB_OK;
}

plumb_result plumb_air_set(plumb_world *world, const plumb_air_desc *desc)
{
    PL_TRY(check_air(world, __func__));
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(pl_check_pointer(world, __func__, "desc", desc));
    PL_TRY(check_desc(world, __func__, desc));
    const plumb_air_desc d = resolved(desc), *is = pl_air_desc(&world->air);
    if (d.position.x != is->position.x || d.position.y != is->position.y ||
        d.half.x != is->half.x || d.half.y != is->half.y || d.cell != is->cell) {
        return pl_fail(world, PLUMB_E_STATE, __func__,
                       "the box is another; position, half and cell must be what they are");
    }
    memcpy(world->air.settings.data, &d, sizeof d);
    return PLUMB_OK;
}

//---- sources -------------------------------------------------------------------------------------

bool pl_air_source_is_sound(const plumb_air_source *s)
{
    return s->position.x >= -FAR && s->position.x <= FAR && s->position.y >= -FAR &&
           s->position.y <= FAR && s->radius > 0 && s->radius <= FAR && s->smoke >= -MOST_AMOUNT &&
           s->smoke <= MOST_AMOUNT && s->heat >= -MOST_AMOUNT && s->heat <= MOST_AMOUNT &&
           s->push.x >= -MOST_AMOUNT && s->push.x <= MOST_AMOUNT && s->push.y >= -MOST_AMOUNT &&
           s->push.y <= MOST_AMOUNT;
}

static plumb_result check_source(const plumb_world *world, const char *fn,
                                 const plumb_air_source *s)
{
    uint32_t row;
    PL_TRY(pl_check_within(world, fn, "position", s->position, FAR));
    PL_TRY(pl_check_finite(world, fn, "radius", s->radius));
    if (!(s->radius > 0) || s->radius > FAR) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "radius is %g; it must be above 0, at most %g",
                       (double)s->radius, (double)FAR);
    }
    PL_TRY(pl_check_range(world, fn, "smoke", s->smoke, -MOST_AMOUNT, MOST_AMOUNT));
    PL_TRY(pl_check_range(world, fn, "heat", s->heat, -MOST_AMOUNT, MOST_AMOUNT));
    PL_TRY(pl_check_within(world, fn, "push", s->push, MOST_AMOUNT));
    return plumb_is_null(s->body) ? PLUMB_OK : pl_check_body(world, fn, s->body, &row);
}

plumb_result plumb_air_set_sources(plumb_world *world, const plumb_air_source *sources, int count)
{
    PL_TRY(check_air(world, __func__));
    PL_TRY(pl_check_unlocked(world, __func__));
    if (count < 0 || count > PLUMB_AIR_MAX_SOURCES) {
        return pl_fail(world, PLUMB_E_RANGE, __func__, "count is %d; it must be 0 to %d", count,
                       PLUMB_AIR_MAX_SOURCES);
    }
    if (count > 0) {
        PL_TRY(pl_check_pointer(world, __func__, "sources", sources));
    }
    for (int i = 0; i < count; ++i) {
        PL_TRY(check_source(world, __func__, &sources[i]));
    }
    pl_air *air = &world->air;
    if (!pl_buffer_reserve(&world->memory, &air->sources,
                           (size_t)count * sizeof(plumb_air_source))) {
        return pl_fail_memory(world, __func__);
    }
    plumb_air_source *to = air->sources.data;
    for (int i = 0; i < count; ++i) {
        const plumb_air_source s = sources[i]; // it may be one of those
        memset(&to[i], 0, sizeof to[i]);       // padding, too: it is saved
        to[i].body = s.body;
        to[i].position = s.position;
        to[i].radius = s.radius;
        to[i].smoke = s.smoke;
        to[i].heat = s.heat;
        to[i].push = s.push;
    }
    air->source_count = (uint32_t)count;
    return PLUMB_OK;
}

PL_LISTED(plumb_air_source, plumb_air_sources, pl_air_sources(&world->air), world->air.source_count)

//---- cells ---------------------------------------------------------------------------------------

bool pl_air_cell_is_sound(const plumb_air_cell *c)
{
    return c->u >= -SPEED_MOST && c->u <= SPEED_MOST && c->v >= -SPEED_MOST && c->v <= SPEED_MOST &&
           c->smoke >= 0 && c->smoke <= MOST_AMOUNT && c->heat >= -MOST_AMOUNT &&
           c->heat <= MOST_AMOUNT && c->room >= 0 && c->room <= 1;
}

typedef struct filling {
    plumb_air_fill_fn *fill;
    void *context;
    double h;
    pl_air_extent box;
} filling;

// At (x, y) in cells of the box.
static plumb_air_sample filled_at(const filling *f, double x, double y, const plumb_air_cell *cell)
{
    plumb_air_sample sample = { { cell->u, cell->v }, cell->smoke, cell->heat };
    const plumb_vec2 at = { (real)((f->box.low_x + x) * f->h), (real)((f->box.low_y + y) * f->h) };
    f->fill(f->context, at, &sample);
    return sample;
}

plumb_result plumb_air_fill(plumb_world *world, plumb_air_fill_fn *fill, void *context)
{
    PL_TRY(check_air(world, __func__));
    PL_TRY(pl_check_unlocked(world, __func__));
    if (fill == NULL) {
        return pl_fail(world, PLUMB_E_NULL, __func__, "fill is NULL; it must be a function");
    }
    const plumb_air_desc *d = pl_air_desc(&world->air);
    const filling f = { fill, context, (double)d->cell, pl_air_extent_of(d) };
    plumb_air_cell *cell = pl_air_items(&world->air);
    for (int32_t j = 0; j <= f.box.rows; ++j) {
        for (int32_t i = 0; i <= f.box.columns; ++i, ++cell) {
            const plumb_air_cell was = *cell;
            const bool has_u = j < f.box.rows, has_v = i < f.box.columns;
            if (has_u) {
                const real u = filled_at(&f, i, j + 0.5, &was).velocity.x;
                cell->u = (real)pl_liquid_held((double)u, PL_AIR_SPEED);
            }
            if (has_v) {
                const real v = filled_at(&f, i + 0.5, j, &was).velocity.y;
                cell->v = (real)pl_liquid_held((double)v, PL_AIR_SPEED);
            }
            if (has_u && has_v) {
                const plumb_air_sample s = filled_at(&f, i + 0.5, j + 0.5, &was);
                const double smoke = pl_liquid_held((double)s.smoke, PL_AIR_MOST);
                cell->smoke = smoke > 0 ? (real)smoke : 0;
                cell->heat = (real)pl_liquid_held((double)s.heat, PL_AIR_MOST);
            }
        }
    }
    return PLUMB_OK;
}

static plumb_result check_cell(const plumb_world *world, const char *fn, const plumb_air_cell *c)
{
    PL_TRY(pl_check_range(world, fn, "u", c->u, -SPEED_MOST, SPEED_MOST));
    PL_TRY(pl_check_range(world, fn, "v", c->v, -SPEED_MOST, SPEED_MOST));
    PL_TRY(pl_check_range(world, fn, "smoke", c->smoke, 0, MOST_AMOUNT));
    PL_TRY(pl_check_range(world, fn, "heat", c->heat, -MOST_AMOUNT, MOST_AMOUNT));
    return pl_check_range(world, fn, "room", c->room, 0, 1);
}

plumb_result plumb_air_set_cells(plumb_world *world, const plumb_air_cell *cells, int count)
{
    PL_TRY(check_air(world, __func__));
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(pl_check_pointer(world, __func__, "cells", cells));
    pl_air *air = &world->air;
    if (count < 0 || (uint32_t)count != air->cell_count) {
        return pl_fail(world, PLUMB_E_RANGE, __func__, "count is %d; it must be %u", count,
                       (unsigned)air->cell_count);
    }
    for (int i = 0; i < count; ++i) {
        PL_TRY(check_cell(world, __func__, &cells[i]));
    }
    memmove(air->cells.data, cells, air->cell_count * sizeof *cells);
    give_room(air);
    return PLUMB_OK;
}

static plumb_air_box box_of(const plumb_world *world)
{
    const plumb_air_desc *d = pl_air_desc(&world->air);
    const pl_air_extent box = pl_air_extent_of(d);
    const double h = (double)d->cell;
    return (plumb_air_box){
        .low = { (real)(box.low_x * h), (real)(box.low_y * h) },
        .high = { (real)((box.low_x + box.columns) * h), (real)((box.low_y + box.rows) * h) },
        .cell = d->cell,
        .columns = box.columns,
        .rows = box.rows,
        .at = pl_air_items(&world->air),
    };
}

plumb_result plumb_air_cells(const plumb_world *world, plumb_air_box *box)
{
    PL_TRY(check_air(world, __func__));
    PL_TRY(pl_check_pointer(world, __func__, "box", box));
    *box = box_of(world);
    return PLUMB_OK;
}

// Between the four of a lattice round (x, y), of which columns and rows there are so many; `member` is the offset of a
// number of a cell.
static double between(const plumb_air_box *b, size_t member, double x, double y, int columns,
                      int rows)
{
    x = x < 0 ? 0 : x > columns - 1 ? columns - 1 : x;
    y = y < 0 ? 0 : y > rows - 1 ? rows - 1 : y;
    const int i = (int)x, j = (int)y;
    const int right = i + 1 < columns ? i + 1 : i, above = j + 1 < rows ? j + 1 : j;
    const double fx = x - i, fy = y - j;
#define VALUE(i, j)                                                                                \
    (double)*(                                                                                     \
        const real *)(const void *)((const char *)&b->at[(size_t)(j) * (size_t)(b->columns + 1) +  \
                                                         (size_t)(i)] +                            \
                                    member)
    const double low = VALUE(i, j) + fx * (VALUE(right, j) - VALUE(i, j));
    const double high = VALUE(i, above) + fx * (VALUE(right, above) - VALUE(i, above));
#undef VALUE
    return low + fy * (high - low);
}

plumb_air_sample plumb_air_at(const plumb_world *world, plumb_vec2 position)
{
    plumb_air_sample out = { { 0, 0 }, 0, 0 };
    if (check_air(world, __func__) != PLUMB_OK ||
        pl_check_finite_vec(world, __func__, "position", position) != PLUMB_OK) {
        return out;
    }
    const plumb_air_box b = box_of(world);
    const double x = ((double)position.x - (double)b.low.x) / (double)b.cell;
    const double y = ((double)position.y - (double)b.low.y) / (double)b.cell;
    if (!(x >= 0 && y >= 0 && x <= b.columns && y <= b.rows)) {
        return out;
    }
#define AT(name, dx, dy, columns, rows)                                                            \
    (real) between(&b, offsetof(plumb_air_cell, name), x - (dx), y - (dy), columns, rows)
    out.velocity.x = AT(u, 0, 0.5, b.columns + 1, b.rows);
    out.velocity.y = AT(v, 0.5, 0, b.columns, b.rows + 1);
    out.smoke = AT(smoke, 0.5, 0.5, b.columns, b.rows);
    out.heat = AT(heat, 0.5, 0.5, b.columns, b.rows);
#undef AT
    return out;
}

//---- sums ----------------------------------------------------------------------------------------

// How much of a face's cell is there, between two cells: what the emptier of them has; at a side that is open half of
// one, and one of the two that are the same of periodic ones.
static double face_room(const plumb_air_cell *before, const plumb_air_cell *behind, bool first,
                        bool last, bool periodic)
{
    if (first || last) {
        const double room = (double)(first ? behind : before)->room;
        return periodic ? (first ? room : 0) : room / 2;
    }
    return (double)(before->room < behind->room ? before->room : behind->room);
}

plumb_result plumb_air_sum(const plumb_world *world, plumb_air_sums *sums)
{
    PL_TRY(check_air(world, __func__));
    PL_TRY(pl_check_pointer(world, __func__, "sums", sums));
    const plumb_air_desc *d = pl_air_desc(&world->air);
    const plumb_air_box b = box_of(world);
    const double area = (double)b.cell * (double)b.cell, mass = area * (double)d->density;
    const plumb_air_cell *c = b.at;
    *sums = (plumb_air_sums){ 0 };
    for (int j = 0; j <= b.rows; ++j) {
        for (int i = 0; i <= b.columns; ++i, ++c) {
            const double u = (double)c->u, v = (double)c->v;
            const double here_u = j == b.rows ? 0
                                              : face_room(c - (i > 0), c, i == 0, i == b.columns,
                                                          d->left == PLUMB_AIR_PERIODIC);
            const double here_v = i == b.columns
                                      ? 0
                                      : face_room(c - (j > 0 ? b.columns + 1 : 0), c, j == 0,
                                                  j == b.rows, d->bottom == PLUMB_AIR_PERIODIC);
            sums->smoke += area * (double)(c->smoke * c->room);
            sums->heat += area * (double)(c->heat * c->room);
            sums->momentum_x += mass * here_u * u;
            sums->momentum_y += mass * here_v * v;
            sums->energy += mass / 2 * (here_u * u * u + here_v * v * v);
        }
    }
    return PLUMB_OK;
}
