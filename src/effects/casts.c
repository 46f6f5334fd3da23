// casts.c - who stands in front of whom in a fluid that flows, and what shade that casts.
//
// Seen along the flow each convex piece is an interval of the axis across it. Bins of that axis have lists of pieces in the order
// in which the flow comes by; of two convex pieces that are apart one is in front of the other along all of their common
// interval, so one chord of each, in the middle of it, tells which, and how far. The one behind gets a shade there:
// shelter (r / (r + wake x))^2 (Jensen 1983, as if all of the flow were taken). Who stands in front of a piece is gone through from the
// nearest on, until nothing that is farther could cast a deeper shade on any part of it.
//
// Reads: volumes, immersions, pieces, poses. Writes: casts. Cost: O(pieces), for those in a volume O(n log n), and O(1) for each
// that is gone through.
#include "effects/casts.h"

#include "geometry/chord.h"
#include "math/compare.h"
#include "world/filter.h"
#include "world/rows.h"

#include <math.h>
#include <string.h>

// A piece in a volume, in coordinates along the flow (y) and across it (x), about the volume's body.
typedef struct blocker {
    double x[PLUMB_POLYGON_MAX_VERTICES], y[PLUMB_POLYGON_MAX_VERTICES], radius;
    double low, high;   // across
    double front, back; // along
    int count;
    uint32_t immersion; // PL_NONE: nobody asks what it is sheltered from
} blocker;

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
    b->low = b->front = INFINITY;
    b->high = b->back = -INFINITY;
    for (int i = 0; i < shape.count; ++i) {
        const double px = (double)shape.points[i].x - (double)bodies->local_x[row];
        const double py = (double)shape.points[i].y - (double)bodies->local_y[row];
        const double x = (double)bodies->center_x[row] - s->at_x + c * px - sine * py;
        const double y = (double)bodies->center_y[row] - s->at_y + sine * px + c * py;
        b->x[i] = -s->ey * x + s->ex * y;
        b->y[i] = s->ex * x + s->ey * y;
        b->low = pl_lesser(b->low, b->x[i] - b->radius);
        b->high = pl_greater(b->high, b->x[i] + b->radius);
        b->front = pl_lesser(b->front, b->y[i] - b->radius);
        b->back = pl_greater(b->back, b->y[i] + b->radius);
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

// Of a piece of half the width r, at a distance along the flow.
static double share_of(const sweep *s, double r, double gap)
{
    const double left = r / (r + s->wake * (gap > 0 ? gap : 0));
    return s->shelter * left * left;
}

static bool add_cast(sweep *s, const blocker *front, const blocker *behind, double low, double high,
                     double gap)
{
    pl_shelter *e = s->world->effects.shelter;
    const double share = share_of(s, (front->high - front->low) / 2, gap);
    if (!(share > 0)) {
        return true;
    }
    if (!pl_buffer_reserve(&s->world->memory, &e->casts, (s->cast_count + 1) * sizeof(pl_cast))) {
        return false;
    }
    // Shares as 32 bits: what is nearer than that is the same.
    const uint32_t depth = (uint32_t)(share * 4294967295.0);
    const double origin = -s->ey * s->at_x + s->ex * s->at_y;
    ((pl_cast *)e->casts.data)[s->cast_count++] =
        (pl_cast){ pl_key(behind->immersion, UINT32_MAX - depth), low + origin, high + origin,
                   share };
    return true;
}

// What `front` casts on `behind`, if it is.
static bool compare(sweep *s, const blocker *front, const blocker *behind)
{
    const double low = front->low > behind->low ? front->low : behind->low;
    const double high = front->high < behind->high ? front->high : behind->high;
    double a_front, a_back, b_front, b_back;
    if (!(low < high) || !chord_of(front, (low + high) / 2, &a_front, &a_back) ||
        !chord_of(behind, (low + high) / 2, &b_front, &b_back)) {
        return true;
    }
    // Those that overlap: by their middles.
    const double a = a_front + a_back, b = b_front + b_back;
    return !(a < b || (a == b && front < behind)) ||
           add_cast(s, front, behind, low, high, b_front - a_back);
}

// Whether casts from `first` on, none less deep than `share`, cover all of a piece.
static bool is_covered(const sweep *s, uint32_t first, const blocker *b, double share)
{
    const pl_cast *all = s->world->effects.shelter->casts.data;
    const double origin = -s->ey * s->at_x + s->ex * s->at_y, end = b->high + origin;
    double at = b->low + origin;
    for (bool on = true; on && at < end;) {
        const double from = at;
        for (uint32_t i = first; i < s->cast_count; ++i) {
            const bool reaches = all[i].share >= share && all[i].low <= from && all[i].high > at;
            at = reaches ? all[i].high : at;
        }
        on = at > from;
    }
    return at >= end;
}

//---- bins ----------------------------------------------------------------------------------------

// Of the axis across the flow: blockers, in the order of their middles along it.
typedef struct bins {
    double low, width;
    double widest, tallest; // half of the largest across, and along
    uint32_t count;         // of bins
    uint32_t *first, *entries, *met,
        *at; // of a bin; its blockers; of a blocker who met it last; of a bin where it is read
} bins;

static uint32_t bin_of(const bins *b, double x)
{
    const double at = (x - b->low) / b->width;
    return at < b->count - 1 ? (uint32_t)at : b->count - 1;
}

static bins bins_of(const blocker *all, uint32_t n)
{
    bins b = { .low = INFINITY };
    double high = -INFINITY, sum = 0;
    for (uint32_t i = 0; i < n; ++i) {
        const double wide = (all[i].high - all[i].low) / 2, tall = (all[i].back - all[i].front) / 2;
        b.low = pl_lesser(b.low, all[i].low), high = pl_greater(high, all[i].high);
        b.widest = pl_greater(b.widest, wide), b.tallest = pl_greater(b.tallest, tall);
        sum += 2 * wide;
    }
    b.width = pl_greater(sum / n, (high - b.low) / (2.0 * n));
    b.count = b.width > 0 ? (uint32_t)((high - b.low) / b.width) + 1 : 1;
    b.width = b.width > 0 ? b.width : 1;
    return b;
}

// False when out of memory.
static bool fill_bins(sweep *s, bins *b)
{
    pl_shelter *e = s->world->effects.shelter;
    const uint32_t n = s->blocker_count;
    const blocker *all = e->blockers.data;
    size_t entries = 0;
    for (uint32_t i = 0; i < n; ++i) {
        entries += bin_of(b, all[i].high) - bin_of(b, all[i].low) + 1;
    }
    const size_t words = 2 * (size_t)b->count + 1 + entries + n;
    if (!pl_buffer_reserve(&s->world->memory, &e->shades, // its own use comes later
                           n * sizeof(pl_keyed) + words * sizeof(uint32_t))) {
        return false;
    }
    pl_keyed *order = e->shades.data;
    b->first = (uint32_t *)(void *)(order + n);
    b->at = b->first + b->count + 1, b->met = b->at + b->count, b->entries = b->met + n;
    for (uint32_t i = 0; i < n; ++i) {
        order[i] = (pl_keyed){ pl_key_of_number(all[i].front + all[i].back), i, i };
        b->met[i] = n;
    }
    pl_sort_keyed(order, n);
    memset(b->first, 0, (b->count + 1) * sizeof *b->first);
    for (uint32_t i = 0; i < n; ++i) {
        for (uint32_t k = bin_of(b, all[i].low); k <= bin_of(b, all[i].high); ++k) {
            ++b->first[k];
        }
    }
    b->first[b->count] = pl_counts_to_places(b->first, b->count, 0);
    memcpy(b->at, b->first, b->count * sizeof *b->at);
    for (uint32_t i = 0; i < n; ++i) {
        const blocker *at = &all[order[i].value];
        for (uint32_t k = bin_of(b, at->low); k <= bin_of(b, at->high); ++k) {
            b->entries[b->at[k]++] = order[i].value;
        }
    }
    return true;
}

// The last of the bins' blockers that are left, and takes it out; PL_NONE: none is.
static uint32_t take_last(const bins *b, const blocker *all, uint32_t from, uint32_t to)
{
    uint32_t best = PL_NONE, bin = 0;
    double most = -INFINITY;
    for (uint32_t k = from; k <= to; ++k) {
        const uint32_t i = b->at[k] > b->first[k] ? b->entries[b->at[k] - 1] : PL_NONE;
        if (i != PL_NONE && all[i].front + all[i].back > most) {
            most = all[i].front + all[i].back;
            best = i, bin = k;
        }
    }
    b->at[bin] -= best != PL_NONE;
    return best;
}

// Of the blockers of a bin, how many may have a part in front of `back`: places in `entries`.
static uint32_t last_before(const bins *b, const blocker *all, uint32_t bin, double back)
{
    uint32_t low = b->first[bin], high = b->first[bin + 1];
    while (low < high) {
        const uint32_t middle = (low + high) / 2, i = b->entries[middle];
        if ((all[i].front + all[i].back) / 2 - b->tallest <= back) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

// All that stand in front of blocker i, the nearest first, until none could cast a deeper shade.
static bool shade(sweep *s, const bins *b, uint32_t i)
{
    const blocker *all = s->world->effects.shelter->blockers.data, *own = &all[i];
    const uint32_t from = bin_of(b, own->low), to = bin_of(b, own->high), first = s->cast_count;
    uint32_t tried = 0, other;
    for (uint32_t k = from; k <= to; ++k) {
        b->at[k] = last_before(b, all, k, own->back);
    }
    while ((other = take_last(b, all, from, to)) != PL_NONE) {
        const blocker *front = &all[other];
        if (other == i || b->met[other] == i) {
            continue;
        }
        b->met[other] = i;
        const double gap = own->front - (front->front + front->back) / 2 - b->tallest;
        // Asked each time that as many again were tried, for the answer takes more than another one.
        if ((tried & (tried - 1)) == 0 && is_covered(s, first, own, share_of(s, b->widest, gap))) {
            break;
        }
        ++tried;
        if (!compare(s, front, own)) {
            return false;
        }
    }
    return true;
}

static bool cast_shades(sweep *s)
{
    const blocker *all = s->world->effects.shelter->blockers.data;
    if (s->blocker_count == 0) {
        return true;
    }
    bins b = bins_of(all, s->blocker_count);
    bool good = fill_bins(s, &b);
    for (uint32_t i = 0; i < s->blocker_count && good; ++i) {
        good = all[i].immersion == PL_NONE || shade(s, &b, i);
    }
    return good;
}

//---- a volume ------------------------------------------------------------------------------------

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

bool pl_cast_shades(plumb_world *world, uint32_t at, uint32_t *cast_count)
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
