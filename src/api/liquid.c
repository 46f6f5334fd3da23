// liquid.c - the world's liquid: made, filled, asked.
//
// Reads: arguments. Writes: the liquid's settings and particles. Cost: O(particles) that come or go.
#include "api/listed.h"
#include "plumb/liquid.h"
#include "liquid/liquid.h"
#include "plumb/geometry.h"
#include "world/check.h"
#include "world/wrap.h"

#include <string.h>

#define SPACING_LEAST ((real)1e-4)
#define SPACING_MOST  ((real)1e3)
#define DENSITY_LEAST ((real)1e-6)
#define MOST          ((real)1e9)
#define NEAREST       0.95 // [spacings] that particles leave between them where a source refills
#define SPEED_MOST    ((real)PL_LIQUID_SPEED)
#define SLOPE_MOST    ((real)PL_LIQUID_SLOPE)
#define SHEAR_MOST    ((real)PL_LIQUID_FORCE)

//---- settings ------------------------------------------------------------------------------------

static plumb_result check_desc(const plumb_world *world, const char *fn, const plumb_liquid_desc *d)
{
    if (d->spacing != 0) {
        PL_TRY(pl_check_range(world, fn, "spacing", d->spacing, SPACING_LEAST, SPACING_MOST));
    }
    if (d->density != 0) {
        PL_TRY(pl_check_range(world, fn, "density", d->density, DENSITY_LEAST, MOST));
    }
    PL_TRY(pl_check_range(world, fn, "viscosity", d->viscosity, 0, PL_LIQUID_MOST_VISCOSITY));
    PL_TRY(pl_check_range(world, fn, "tension", d->tension, 0, PL_LIQUID_MOST_TENSION));
    return pl_check_range(world, fn, "friction", d->friction, 0, PL_LIQUID_MOST_FRICTION);
}

static real density_of(real said)
{
    return said > 0 ? said : 1000;
}

static bool are_near(real density, real first)
{
    const double ratio = (double)density / (double)first;
    return ratio >= 1 / PL_LIQUID_RATIO && ratio <= PL_LIQUID_RATIO;
}

static plumb_result check_ratio(const plumb_world *world, const char *fn, real density, real first)
{
    if (!are_near(density, first)) {
        return pl_fail(world, PLUMB_E_RANGE, fn,
                       "density of a phase is %g; it must be within a thousandth to a thousand "
                       "times that of the first, %g",
                       (double)density, (double)first);
    }
    return PLUMB_OK;
}

static plumb_result check_phase(const plumb_world *world, const char *fn,
                                const plumb_liquid_phase *phase)
{
    if (phase->density != 0) {
        PL_TRY(
            pl_check_range(world, fn, "density", phase->density, 0, MOST * (real)PL_LIQUID_RATIO));
    }
    PL_TRY(pl_check_range(world, fn, "viscosity", phase->viscosity, 0, PL_LIQUID_MOST_VISCOSITY));
    PL_TRY(pl_check_range(world, fn, "friction", phase->friction, 0, PL_LIQUID_MOST_FRICTION));
    return check_ratio(world, fn, density_of(phase->density),
                       pl_liquid_desc(&world->liquid)->density);
}

bool pl_liquid_desc_is_sound(const plumb_liquid_desc *d)
{
    return d->spacing >= SPACING_LEAST && d->spacing <= SPACING_MOST &&
           d->density >= DENSITY_LEAST && d->density <= MOST && d->viscosity >= 0 &&
           d->viscosity <= PL_LIQUID_MOST_VISCOSITY && d->tension >= 0 &&
           d->tension <= PL_LIQUID_MOST_TENSION && d->friction >= 0 &&
           d->friction <= PL_LIQUID_MOST_FRICTION;
}

bool pl_liquid_phase_is_sound(const plumb_liquid_phase *phase, plumb_real first_density)
{
    return are_near(phase->density, first_density) && phase->viscosity >= 0 &&
           phase->viscosity <= PL_LIQUID_MOST_VISCOSITY && phase->friction >= 0 &&
           phase->friction <= PL_LIQUID_MOST_FRICTION;
}

bool pl_liquid_particle_is_sound(const plumb_particle *p, uint32_t phases)
{
    bool sound = p->position.x - p->position.x == 0 && p->position.y - p->position.y == 0 &&
                 p->velocity.x >= -SPEED_MOST && p->velocity.x <= SPEED_MOST &&
                 p->velocity.y >= -SPEED_MOST && p->velocity.y <= SPEED_MOST && p->phase <= phases;
    for (int k = 0; k < 4; ++k) {
        sound &= p->gradient[k] >= -SLOPE_MOST && p->gradient[k] <= SLOPE_MOST;
    }
    for (int k = 0; k < 2; ++k) {
        sound &= p->shear[k] >= -SHEAR_MOST && p->shear[k] <= SHEAR_MOST;
    }
    return sound;
}

static plumb_result check_liquid(const plumb_world *world, const char *fn)
{
    PL_TRY(pl_check_world(world));
    return world->liquid.settings_count > 0
               ? PLUMB_OK
               : pl_fail(world, PLUMB_E_STATE, fn,
                         "the world has no liquid; it must be made with plumb_liquid_create");
}

static void put_desc(pl_liquid *liquid, const plumb_liquid_desc *d)
{
    plumb_liquid_desc *to = liquid->settings.data;
    memset(to, 0, sizeof *to); // padding, too: it is saved
    to->spacing = d->spacing > 0 ? d->spacing : PLUMB_REAL(0.05);
    to->density = density_of(d->density);
    to->viscosity = d->viscosity;
    to->tension = d->tension;
    to->friction = d->friction;
}

plumb_result plumb_liquid_create(plumb_world *world, const plumb_liquid_desc *desc)
{
    const plumb_liquid_desc zero = { 0 };
    desc = desc == NULL ? &zero : desc;
    PL_TRY(pl_check_world(world));
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(PL_CHECK_HAS(world, __func__, "a liquid", LIQUID, "liquid"));
    if (world->liquid.settings_count > 0) {
        return pl_fail(world, PLUMB_E_STATE, __func__, "the world has a liquid; it must have none");
    }
    if (pl_is_wrapped(world)) {
        return pl_fail(world, PLUMB_E_STATE, __func__,
                       "the world wraps around; one with a liquid must not");
    }
    PL_TRY(check_desc(world, __func__, desc));
    if (!pl_buffer_reserve(&world->memory, &world->liquid.settings, sizeof *desc)) {
        return pl_fail_memory(world, __func__);
    }
    put_desc(&world->liquid, desc);
    world->liquid.settings_count = 1;
    return PLUMB_OK;
}

plumb_result plumb_liquid_destroy(plumb_world *world)
{
    PL_TRY(check_liquid(world, __func__));
    PL_TRY(pl_check_unlocked(world, __func__));
    pl_liquid_free(&world->memory, &world->liquid);
    world->schedule_dirty = true;
    return PLUMB_OK;
}

plumb_result plumb_liquid_settings(const plumb_world *world, plumb_liquid_desc *desc)
{
    PL_TRY(check_liquid(world, __func__));
    PL_TRY(pl_check_pointer(world, __func__, "desc", desc));
    *desc = *pl_liquid_desc(&world->liquid);
    return PLUMB_OK;
}

plumb_result plumb_liquid_set(plumb_world *world, const plumb_liquid_desc *desc)
{
    const plumb_liquid_desc zero = { 0 };
    desc = desc == NULL ? &zero : desc;
    PL_TRY(check_liquid(world, __func__));
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(check_desc(world, __func__, desc));
    plumb_liquid_desc d = *desc;
    const real spacing = pl_liquid_desc(&world->liquid)->spacing;
    if (d.spacing != 0 && d.spacing != spacing) {
        return pl_fail(world, PLUMB_E_STATE, __func__, "spacing is %g; it must be 0 or %g",
                       (double)d.spacing, (double)spacing);
    }
    d.spacing = spacing;
    for (uint32_t i = 0; i < world->liquid.phase_count; ++i) {
        PL_TRY(check_ratio(world, __func__, pl_liquid_phases(&world->liquid)[i].density,
                           density_of(d.density)));
    }
    put_desc(&world->liquid, &d);
    return PLUMB_OK;
}

//---- phases --------------------------------------------------------------------------------------

static plumb_result check_phases_left(const plumb_world *world, const char *fn, int count)
{
    const plumb_particle *p = pl_liquid_items(&world->liquid);
    for (uint32_t i = 0; i < world->liquid.count; ++i) {
        if (p[i].phase > (uint32_t)count) {
            return pl_fail(world, PLUMB_E_STATE, fn,
                           "count is %d, and particles are of phase %u; they must be removed first",
                           count, (unsigned)p[i].phase);
        }
    }
    return PLUMB_OK;
}

plumb_result plumb_liquid_set_phases(plumb_world *world, const plumb_liquid_phase *phases,
                                     int count)
{
    PL_TRY(check_liquid(world, __func__));
    PL_TRY(pl_check_unlocked(world, __func__));
    if (count < 0 || count > PLUMB_LIQUID_MAX_PHASES) {
        return pl_fail(world, PLUMB_E_RANGE, __func__, "count is %d; it must be 0 to %d", count,
                       PLUMB_LIQUID_MAX_PHASES);
    }
    if (count > 0) {
        PL_TRY(pl_check_pointer(world, __func__, "phases", phases));
    }
    for (int i = 0; i < count; ++i) {
        PL_TRY(check_phase(world, __func__, &phases[i]));
    }
    PL_TRY(check_phases_left(world, __func__, count));
    pl_liquid *liquid = &world->liquid;
    if (!pl_buffer_reserve(&world->memory, &liquid->phases, (size_t)count * sizeof *phases)) {
        return pl_fail_memory(world, __func__);
    }
    for (int i = 0; i < count; ++i) {
        pl_liquid_phases(liquid)[i] =
            (plumb_liquid_phase){ .density = density_of(phases[i].density),
                                  .viscosity = phases[i].viscosity,
                                  .friction = phases[i].friction };
    }
    liquid->phase_count = (uint32_t)count;
    return PLUMB_OK;
}

PL_LISTED(plumb_liquid_phase, plumb_liquid_phases, pl_liquid_phases(&world->liquid),
          world->liquid.phase_count)

//---- particles come ------------------------------------------------------------------------------

static plumb_result reserve(plumb_world *world, const char *fn, double extra)
{
    pl_liquid *liquid = &world->liquid;
    if ((double)liquid->count + extra > PLUMB_LIQUID_MAX) {
        return pl_fail(world, PLUMB_E_RANGE, fn,
                       "there would be %.0f particles; there must be at most %d",
                       (double)liquid->count + extra, PLUMB_LIQUID_MAX);
    }
    const size_t count = liquid->count + (size_t)extra;
    if (!pl_buffer_reserve(&world->memory, &liquid->particles, count * sizeof(plumb_particle))) {
        return pl_fail_memory(world, fn);
    }
    return PLUMB_OK;
}

static void put(plumb_world *world, plumb_vec2 position, const plumb_particle *like)
{
    pl_liquid *liquid = &world->liquid;
    world->schedule_dirty |= liquid->count == 0;
    liquid->index.fresh = false;
    plumb_particle *p = &pl_liquid_items(liquid)[liquid->count++];
    memcpy(p, like, sizeof *p);
    p->position = position;
}

// Within what the grid can count.
static real most_place(const plumb_world *world)
{
    const double cells = (double)PL_LIQUID_MOST_CELL;
    const double most = cells * 2 * (double)pl_liquid_desc(&world->liquid)->spacing;
    return most < (double)MOST ? (real)most : MOST;
}

// But for its place.
static plumb_result check_like(const plumb_world *world, const char *fn, const plumb_particle *p)
{
    PL_TRY(pl_check_within(world, fn, "velocity", p->velocity, SPEED_MOST));
    for (int k = 0; k < 4; ++k) {
        PL_TRY(pl_check_range(world, fn, "gradient", p->gradient[k], -SLOPE_MOST, SLOPE_MOST));
    }
    for (int k = 0; k < 2; ++k) {
        PL_TRY(pl_check_range(world, fn, "shear", p->shear[k], -SHEAR_MOST, SHEAR_MOST));
    }
    if (p->phase > world->liquid.phase_count) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "phase is %u; it must be 0 to %u",
                       (unsigned)p->phase, (unsigned)world->liquid.phase_count);
    }
    return PLUMB_OK;
}

static const plumb_particle water;

static const plumb_particle *like_of(const plumb_particle *like)
{
    return like != NULL ? like : &water;
}

plumb_result plumb_liquid_add(plumb_world *world, const plumb_particle *particles, int count)
{
    PL_TRY(check_liquid(world, __func__));
    PL_TRY(pl_check_unlocked(world, __func__));
    if (count < 0) {
        return pl_fail(world, PLUMB_E_RANGE, __func__, "count is %d; it must be at least 0", count);
    }
    if (count > 0) {
        PL_TRY(pl_check_pointer(world, __func__, "particles", particles));
    }
    for (int i = 0; i < count; ++i) {
        PL_TRY(
            pl_check_within(world, __func__, "position", particles[i].position, most_place(world)));
        PL_TRY(check_like(world, __func__, &particles[i]));
    }
    PL_TRY(reserve(world, __func__, count));
    for (int i = 0; i < count; ++i) {
        put(world, particles[i].position, &particles[i]);
    }
    return PLUMB_OK;
}

//---- lattices ------------------------------------------------------------------------------------

// Places (i + 1/2, j + 1/2) spacings within a box.
typedef struct lattice {
    double spacing, first_x, first_y;
    double columns, rows;
} lattice;

static double above(double v)
{
    const double whole = (double)(int64_t)v;
    return whole < v ? whole + 1 : whole;
}

// Rounding of a corner that is a multiple of the spacing decides nothing.
static double first_of(double low, double spacing)
{
    return above(low / spacing - 0.5 - 1e-3);
}

static double count_of(double low, double high, double spacing)
{
    const double count = first_of(high, spacing) - first_of(low, spacing);
    return count > 0 ? count : 0;
}

static lattice lattice_of(const plumb_world *world, plumb_vec2 low, plumb_vec2 high)
{
    const double s = (double)pl_liquid_desc(&world->liquid)->spacing;
    return (lattice){ s, first_of((double)low.x, s), first_of((double)low.y, s),
                      count_of((double)low.x, (double)high.x, s),
                      count_of((double)low.y, (double)high.y, s) };
}

static plumb_vec2 place_in(const lattice *l, double i, double j)
{
    return (plumb_vec2){ (real)((l->first_x + i + 0.5) * l->spacing),
                         (real)((l->first_y + j + 0.5) * l->spacing) };
}

static plumb_result check_box(const plumb_world *world, const char *fn, plumb_vec2 low,
                              plumb_vec2 high)
{
    const real most = most_place(world);
    PL_TRY(pl_check_within(world, fn, "low", low, most));
    PL_TRY(pl_check_within(world, fn, "high", high, most));
    if (!(low.x < high.x && low.y < high.y)) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "low is (%g, %g); it must be below high (%g, %g)",
                       (double)low.x, (double)low.y, (double)high.x, (double)high.y);
    }
    return PLUMB_OK;
}

plumb_result plumb_liquid_add_box(plumb_world *world, plumb_vec2 low, plumb_vec2 high,
                                  const plumb_particle *like)
{
    PL_TRY(check_liquid(world, __func__));
    PL_TRY(pl_check_unlocked(world, __func__));
    PL_TRY(check_box(world, __func__, low, high));
    PL_TRY(check_like(world, __func__, like_of(like)));
    const lattice l = lattice_of(world, low, high);
    PL_TRY(reserve(world, __func__, l.columns * l.rows));
    for (double j = 0; j < l.rows; ++j) {
        for (double i = 0; i < l.columns; ++i) {
            put(world, place_in(&l, i, j), like_of(like));
        }
    }
    return PLUMB_OK;
}

static void box_of(const plumb_vec2 *points, int count, plumb_vec2 *low, plumb_vec2 *high)
{
    *low = *high = points[0];
    for (int i = 1; i < count; ++i) {
        low->x = points[i].x < low->x ? points[i].x : low->x;
        low->y = points[i].y < low->y ? points[i].y : low->y;
        high->x = points[i].x > high->x ? points[i].x : high->x;
        high->y = points[i].y > high->y ? points[i].y : high->y;
    }
}

// Marks places of the lattice that have a particle nearer than a spacing along both axes.
static void mark_taken(const pl_liquid *liquid, const lattice *l, uint8_t *taken)
{
    const plumb_particle *p = pl_liquid_items(liquid);
    for (uint32_t k = 0; k < liquid->count; ++k) {
        const double x = (double)p[k].position.x / l->spacing - 0.5 - l->first_x;
        const double y = (double)p[k].position.y / l->spacing - 0.5 - l->first_y;
        if (!(x > -1 && x < l->columns && y > -1 && y < l->rows)) {
            continue;
        }
        for (double j = above(y - NEAREST); j <= y + NEAREST; ++j) {
            for (double i = above(x - NEAREST); i <= x + NEAREST; ++i) {
                if (i >= 0 && i < l->columns && j >= 0 && j < l->rows) {
                    taken[(size_t)(j * l->columns + i)] = 1;
                }
            }
        }
    }
}

// taken: a byte a place of the lattice, or null.
static void put_shape(plumb_world *world, const lattice *l, const uint8_t *taken,
                      const plumb_vec2 *points, int count, const plumb_particle *like)
{
    for (double j = 0; j < l->rows; ++j) {
        for (double i = 0; i < l->columns; ++i) {
            const plumb_vec2 at = place_in(l, i, j);
            if ((taken == NULL || taken[(size_t)(j * l->columns + i)] == 0) &&
                plumb_outline_contains(points, count, at)) {
                put(world, at, like);
            }
        }
    }
}

static plumb_result add_shape(plumb_world *world, const char *fn, const plumb_vec2 *points,
                              int count, const plumb_particle *like, bool refills)
{
    plumb_vec2 low, high;
    PL_TRY(check_liquid(world, fn));
    PL_TRY(pl_check_unlocked(world, fn));
    PL_TRY(pl_check_pointer(world, fn, "points", points));
    if (count < 3 || count > PLUMB_OUTLINE_MAX_VERTICES) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "count is %d; it must be 3 to %d", count,
                       PLUMB_OUTLINE_MAX_VERTICES);
    }
    for (int i = 0; i < count; ++i) {
        PL_TRY(pl_check_within(world, fn, "points", points[i], most_place(world)));
    }
    PL_TRY(check_like(world, fn, like_of(like)));
    box_of(points, count, &low, &high);
    const lattice l = lattice_of(world, low, high);
    PL_TRY(reserve(world, fn, l.columns * l.rows));
    pl_buffer taken = { NULL, 0 };
    if (refills) {
        const size_t bytes = (size_t)(l.columns * l.rows) + 1;
        if (!pl_buffer_reserve(&world->memory, &taken, bytes)) {
            return pl_fail_memory(world, fn);
        }
        memset(taken.data, 0, bytes);
        mark_taken(&world->liquid, &l, taken.data);
    }
    put_shape(world, &l, taken.data, points, count, like_of(like));
    pl_buffer_free(&world->memory, &taken);
    return PLUMB_OK;
}

plumb_result plumb_liquid_add_shape(plumb_world *world, const plumb_vec2 *points, int count,
                                    const plumb_particle *like)
{
    return add_shape(world, __func__, points, count, like, false);
}

plumb_result plumb_liquid_refill(plumb_world *world, const plumb_vec2 *points, int count,
                                 const plumb_particle *like)
{
    return add_shape(world, __func__, points, count, like, true);
}

//---- they go, are seen ---------------------------------------------------------------------------

static bool is_in(plumb_vec2 at, plumb_vec2 low, plumb_vec2 high)
{
    return at.x >= low.x && at.x <= high.x && at.y >= low.y && at.y <= high.y;
}

int plumb_liquid_remove(plumb_world *world, plumb_vec2 low, plumb_vec2 high)
{
    if (check_liquid(world, __func__) != PLUMB_OK ||
        pl_check_unlocked(world, __func__) != PLUMB_OK ||
        check_box(world, __func__, low, high) != PLUMB_OK) {
        return -1;
    }
    pl_liquid *liquid = &world->liquid;
    plumb_particle *items = pl_liquid_items(liquid);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < liquid->count; ++i) {
        if (!is_in(items[i].position, low, high)) {
            items[kept++] = items[i];
        }
    }
    const uint32_t removed = liquid->count - kept;
    liquid->count = kept;
    liquid->index.fresh &= removed == 0;
    world->schedule_dirty |= kept == 0 && removed > 0;
    return (int)removed;
}

int plumb_liquid_change_phase(plumb_world *world, plumb_vec2 low, plumb_vec2 high, int from, int to)
{
    if (check_liquid(world, __func__) != PLUMB_OK ||
        pl_check_unlocked(world, __func__) != PLUMB_OK ||
        check_box(world, __func__, low, high) != PLUMB_OK) {
        return -1;
    }
    pl_liquid *liquid = &world->liquid;
    const int most = (int)liquid->phase_count;
    if (from < 0 || to < 0 || from > most || to > most) {
        pl_fail(world, PLUMB_E_RANGE, __func__, "phases are %d and %d; they must be 0 to %d", from,
                to, most);
        return -1;
    }
    plumb_particle *items = pl_liquid_items(liquid);
    int changed = 0;
    for (uint32_t i = 0; i < liquid->count; ++i) {
        if (items[i].phase == (uint32_t)from && is_in(items[i].position, low, high)) {
            items[i].phase = (uint32_t)to;
            ++changed;
        }
    }
    return changed;
}

PL_LISTED(plumb_particle, plumb_liquid_particles, pl_liquid_items(&world->liquid),
          world->liquid.count)
