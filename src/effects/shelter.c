// shelter.c - what stands behind what in a fluid that flows.
//
// Seen along the flow each convex piece is an interval of the axis across it. Intervals are sorted by their lower ends, so
// those that overlap are found in a sweep; of two convex pieces that are apart one is in front of the other along all
// of their common interval, so one chord of each, in the middle of it, tells which, and how far. The one behind
// gets a shade there: shelter (r / (r + wake x))^2 (Jensen 1983, as if all of the flow were taken). Shades of one piece are laid over
// one another, the deepest on top: a one-dimensional depth buffer.
//
// Reads: volumes, immersions, pieces, poses. Writes: shades. Order: behind immersions, before the substeps. Cost: O(pieces), for
// those in a volume O(n log n), and O(1) for two that stand behind one another.
#include "effects/fluid.h"

#include "core/sort.h"
#include "geometry/chord.h"
#include "math/compare.h"
#include "world/filter.h"
#include "world/rows.h"
#include "world/wrap.h"

#include <math.h>
#include <string.h>

// A piece in a volume, in coordinates along the flow (y) and across it (x), about the volume's body.
typedef struct blocker {
    double x[PLUMB_POLYGON_MAX_VERTICES], y[PLUMB_POLYGON_MAX_VERTICES], radius;
    double low, high; // across
    int count;
    uint32_t immersion; // PL_NONE: nobody asks what it is sheltered from
} blocker;

// A shade before shades of one piece are laid over one another.
typedef struct cast {
    uint64_t order; // immersion, then the deepest first
    double low, high, share;
} cast;

typedef struct sweep {
    plumb_world *world;
    const pl_volume *volume;
    uint32_t volume_at;
    double ex, ey;     // along the flow
    double at_x, at_y; // [m] the volume's body
    double shelter, wake;
    uint32_t blocker_count, cast_count;
} sweep;

//---- who is in the volume ------------------------------------------------------------------------

static bool is_in(const sweep *s, uint32_t piece, const pl_box *volume)
{
    const plumb_world *world = s->world;
    const pl_pieces *p = &world->pieces;
    const uint32_t row = p->body[piece];
    if ((p->flags[piece] & PL_PIECE_SENSOR) != 0 ||
        row >= pl_partition_first(world, PL_PART_DISABLED) ||
        !pl_pieces_meet(world, piece, s->volume->piece)) {
        return false;
    }
    const pl_box box = pl_piece_tight_box(world, piece);
    return box.min_x < volume->max_x && box.max_x > volume->min_x && box.min_y < volume->max_y &&
           box.max_y > volume->min_y;
}

static bool add_blocker(sweep *s, uint32_t piece, uint32_t immersion)
{
    plumb_world *world = s->world;
    pl_shelter *e = world->effects.shelter;
    const size_t bytes = (s->blocker_count + 1) * sizeof(blocker);
    if (!pl_buffer_reserve(&world->memory, &e->blockers, bytes)) {
        return false;
    }
    blocker *b = (blocker *)e->blockers.data + s->blocker_count++;
    const pl_bodies *bodies = &world->bodies;
    const uint32_t row = world->pieces.body[piece];
    const double c = (double)bodies->c[row], sine = (double)bodies->s[row];
    plumb_convex shape;
    pl_piece_convex(world, piece, &shape);
    b->count = shape.count;
    b->radius = (double)shape.radius;
    b->immersion = immersion;
    b->low = INFINITY;
    b->high = -INFINITY;
    for (int i = 0; i < shape.count; ++i) {
        const double px = (double)shape.points[i].x - (double)bodies->local_x[row];
        const double py = (double)shape.points[i].y - (double)bodies->local_y[row];
        const double x = (double)bodies->center_x[row] - s->at_x + c * px - sine * py;
        const double y = (double)bodies->center_y[row] - s->at_y + sine * px + c * py;
        b->x[i] = -s->ey * x + s->ex * y;
        b->y[i] = s->ex * x + s->ey * y;
        b->low = pl_lesser(b->low, b->x[i] - b->radius);
        b->high = pl_greater(b->high, b->x[i] + b->radius);
    }
    return true;
}

static bool find_blockers(sweep *s, const uint32_t *immersions)
{
    const plumb_world *world = s->world;
    const pl_box volume = pl_piece_tight_box(world, s->volume->piece);
    s->blocker_count = 0;
    for (uint32_t row = 0; row < pl_partition_first(world, PL_PART_DISABLED); ++row) {
        const pl_pieces *pieces = &world->pieces;
        for (uint32_t p = world->bodies.first_piece[row]; p != PL_NONE;
             p = pieces->next_in_body[p]) {
            if (is_in(s, p, &volume) && !add_blocker(s, p, immersions[p])) {
                return false;
            }
        }
    }
    return true;
}

//---- who is behind whom --------------------------------------------------------------------------

// From the windward end of the chord at `at` to its end behind.
static bool chord_of(const blocker *b, double at, double *front, double *back)
{
    return pl_chord(b->x, b->y, b->count, b->radius, at, front, back);
}

static bool add_cast(sweep *s, const blocker *front, const blocker *behind, double low, double high,
                     double gap)
{
    pl_shelter *e = s->world->effects.shelter;
    const double r = (front->high - front->low) / 2, x = gap > 0 ? gap : 0;
    const double left = r / (r + s->wake * x), share = s->shelter * left * left;
    if (behind->immersion == PL_NONE || !(share > 0)) {
        return true;
    }
    if (!pl_buffer_reserve(&s->world->memory, &e->casts, (s->cast_count + 1) * sizeof(cast))) {
        return false;
    }
    // Shares as 32 bits: what is nearer than that is the same.
    const uint32_t depth = (uint32_t)(share * 4294967295.0);
    const double origin = -s->ey * s->at_x + s->ex * s->at_y;
    ((cast *)e->casts.data)[s->cast_count++] =
        (cast){ pl_key(behind->immersion, UINT32_MAX - depth), low + origin, high + origin, share };
    return true;
}

static bool compare(sweep *s, const blocker *a, const blocker *b)
{
    const double low = a->low > b->low ? a->low : b->low;
    const double high = a->high < b->high ? a->high : b->high;
    double a_front, a_back, b_front, b_back;
    if (!(low < high) || (a->immersion == PL_NONE && b->immersion == PL_NONE) ||
        !chord_of(a, (low + high) / 2, &a_front, &a_back) ||
        !chord_of(b, (low + high) / 2, &b_front, &b_back)) {
        return true;
    }
    // Those that overlap: by their middles.
    return a_front + a_back < b_front + b_back ? add_cast(s, a, b, low, high, b_front - a_back)
                                               : add_cast(s, b, a, low, high, a_front - b_back);
}

static bool cast_shades(sweep *s)
{
    pl_shelter *e = s->world->effects.shelter;
    const uint32_t n = s->blocker_count;
    if (!pl_buffer_reserve(&s->world->memory, &e->shades, (n + 1) * sizeof(pl_keyed))) {
        return false;
    }
    const blocker *b = e->blockers.data;
    pl_keyed *order = e->shades.data; // its own use comes later
    for (uint32_t i = 0; i < n; ++i) {
        order[i] = (pl_keyed){ pl_key_of_number(b[i].low), i, i };
    }
    pl_sort_keyed(order, n);
    for (uint32_t i = 0; i < n; ++i) {
        const blocker *a = &b[order[i].value];
        for (uint32_t k = i + 1; k < n && b[order[k].value].low < a->high; ++k) {
            if (!compare(s, a, &b[order[k].value])) {
                return false;
            }
        }
    }
    return true;
}

//---- shades over one another ---------------------------------------------------------------------

// Places between the ends of all shades of a piece: taken ones lead to the next that is free.
static uint32_t next_free(uint32_t *next, uint32_t at)
{
    while (next[at] != at) {
        next[at] = next[next[at]];
        at = next[at];
    }
    return at;
}

static uint32_t place_of(const pl_keyed *ends, uint32_t count, double at)
{
    bool found;
    return pl_find_key(ends, count, sizeof *ends, pl_key_of_number(at), &found);
}

// Room for the ends, places and shares of n shades.
static size_t room_of(uint32_t n)
{
    return (size_t)(2 * n + 1) * (sizeof(pl_keyed) + 2 * sizeof(double) + sizeof(uint32_t));
}

static bool overlay(plumb_world *world, const cast *casts, uint32_t n, pl_shadow *out)
{
    pl_shelter *e = world->effects.shelter;
    const uint32_t most = 2 * n;
    if (!pl_buffer_reserve(&world->memory, &e->blockers, room_of(n)) ||
        !pl_buffer_reserve(&world->memory, &e->shades,
                           (e->shade_count + most) * sizeof(pl_shade))) {
        return false;
    }
    pl_keyed *ends = e->blockers.data;
    double *share = (double *)(void *)(ends + most + 1), *place = share + most + 1;
    uint32_t *next = (uint32_t *)(void *)(place + most + 1);
    uint32_t count = 0;
    for (uint32_t i = 0; i < n; ++i) {
        ends[2 * i] = (pl_keyed){ pl_key_of_number(casts[i].low), 2 * i, 2 * i };
        ends[2 * i + 1] = (pl_keyed){ pl_key_of_number(casts[i].high), 2 * i + 1, 2 * i + 1 };
    }
    pl_sort_keyed(ends, most);
    for (uint32_t i = 0; i < most; ++i) {
        const cast *of = &casts[ends[i].value / 2];
        if (count == 0 || ends[count - 1].key != ends[i].key) {
            place[count] = ends[i].value % 2 == 0 ? of->low : of->high;
            ends[count++] = ends[i];
        }
    }
    for (uint32_t i = 0; i <= count; ++i) {
        next[i] = i;
        share[i] = 0;
    }
    for (uint32_t i = 0; i < n; ++i) {
        const uint32_t last = place_of(ends, count, casts[i].high);
        uint32_t at = next_free(next, place_of(ends, count, casts[i].low));
        for (; at < last; at = next_free(next, at)) {
            share[at] = casts[i].share;
            next[at] = at + 1;
        }
    }
    pl_shade *shades = e->shades.data;
    out->first = e->shade_count;
    for (uint32_t i = 0; i + 1 < count; ++i) {
        pl_shade *before = e->shade_count > out->first ? &shades[e->shade_count - 1] : NULL;
        if (share[i] > 0 && before != NULL && before->high == place[i] &&
            before->share == share[i]) {
            before->high = place[i + 1];
        } else if (share[i] > 0) {
            shades[e->shade_count++] = (pl_shade){ place[i], place[i + 1], share[i] };
        }
    }
    out->count = e->shade_count - out->first;
    return true;
}

static bool overlay_all(plumb_world *world, uint32_t cast_count)
{
    pl_shelter *e = world->effects.shelter;
    const cast *all = e->casts.data;
    pl_shadow *shadows = e->shadows.data;
    e->shade_count = 0;
    for (uint32_t first = 0, end; first < cast_count; first = end) {
        const uint32_t immersion = (uint32_t)(all[first].order >> 32);
        for (end = first; end < cast_count && all[end].order >> 32 == immersion;) {
            ++end;
        }
        if (!overlay(world, all + first, end - first, &shadows[immersion])) {
            return false;
        }
    }
    return true;
}

// Casts by immersion, the deepest first. False when out of memory.
static bool sort_casts(plumb_world *world, uint32_t count)
{
    pl_shelter *e = world->effects.shelter;
    if (!pl_buffer_reserve(&world->memory, &e->blockers,
                           count * (sizeof(pl_keyed) + sizeof(cast)))) {
        return false;
    }
    cast *copy = e->blockers.data, *all = e->casts.data;
    pl_keyed *order = (pl_keyed *)(void *)(copy + count);
    memcpy(copy, all, count * sizeof *copy);
    for (uint32_t i = 0; i < count; ++i) {
        order[i] = (pl_keyed){ copy[i].order, i, i };
    }
    pl_sort_keyed(order, count);
    for (uint32_t i = 0; i < count; ++i) {
        all[i] = copy[order[i].value];
    }
    return true;
}

//---- all volumes ---------------------------------------------------------------------------------

// Which immersion in a volume a piece has, by piece. False when out of memory.
static bool name_immersions(plumb_world *world, uint32_t volume)
{
    const pl_effects *e = &world->effects;
    const uint32_t pieces = world->pieces.table.count;
    if (!pl_buffer_reserve(&world->memory, &e->shelter->shades, pieces * sizeof(uint32_t))) {
        return false;
    }
    uint32_t *of = e->shelter->shades.data;
    memset(of, 0xff, pieces * sizeof *of);
    const pl_keyed *all = e->immersions.data;
    for (uint32_t i = 0; i < e->immersion_count; ++i) {
        if (all[i].order == volume) {
            of[all[i].value] = i;
        }
    }
    return true;
}

static bool shelters(const plumb_world *world, const pl_volume *volume)
{
    const pl_materials *m = &world->materials;
    const uint32_t row = volume->material;
    return m->shelter[row] > 0 && (m->flow_x[row] != 0 || m->flow_y[row] != 0) &&
           !pl_is_wrapped(world);
}

static bool look_at_volume(plumb_world *world, uint32_t at, uint32_t *cast_count)
{
    const pl_volume *volume = (const pl_volume *)world->effects.volumes.data + at;
    const pl_materials *m = &world->materials;
    const uint32_t holder = world->pieces.body[volume->piece];
    const double fx = (double)m->flow_x[volume->material], fy = (double)m->flow_y[volume->material];
    const double speed = sqrt(fx * fx + fy * fy);
    sweep s = { .world = world,
                .volume = volume,
                .volume_at = at,
                .ex = fx / speed,
                .ey = fy / speed,
                .at_x = (double)world->bodies.center_x[holder],
                .at_y = (double)world->bodies.center_y[holder],
                .shelter = (double)m->shelter[volume->material],
                .wake = (double)m->wake[volume->material],
                .cast_count = *cast_count };
    const bool good = name_immersions(world, at) &&
                      find_blockers(&s, world->effects.shelter->shades.data) && cast_shades(&s);
    *cast_count = s.cast_count;
    return good;
}

// Whether any does; makes what that takes. False when out of memory.
static bool open_shelter(plumb_world *world)
{
    pl_effects *e = &world->effects;
    const pl_volume *volumes = e->volumes.data;
    bool any = false;
    for (uint32_t i = 0; i < e->volume_count; ++i) {
        any |= shelters(world, &volumes[i]);
    }
    if (any && e->shelter == NULL) {
        e->shelter = pl_resize(&world->memory, NULL, 0, sizeof *e->shelter);
        if (e->shelter == NULL) {
            return false;
        }
        *e->shelter = (pl_shelter){ .shade_count = 0 };
    }
    if (e->shelter != NULL) {
        e->shelter->any = any;
    }
    return true;
}

bool pl_shelter_find(plumb_world *world)
{
    pl_effects *e = &world->effects;
    const pl_volume *volumes = e->volumes.data;
    uint32_t cast_count = 0;
    if (!open_shelter(world)) {
        return false;
    }
    if (e->shelter == NULL || !e->shelter->any) {
        return true;
    }
    const size_t bytes = e->immersion_count * sizeof(pl_shadow);
    if (!pl_buffer_reserve(&world->memory, &e->shelter->shadows, bytes)) {
        return false;
    }
    memset(e->shelter->shadows.data, 0, bytes);
    for (uint32_t i = 0; i < e->volume_count; ++i) {
        if (shelters(world, &volumes[i]) && !look_at_volume(world, i, &cast_count)) {
            return false;
        }
    }
    return cast_count == 0 || (sort_casts(world, cast_count) && overlay_all(world, cast_count));
}
