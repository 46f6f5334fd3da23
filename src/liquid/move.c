// move.c - particles go where the liquid takes them, and not into solids.
//
// Velocity half way along the step is known from a particle's own slopes, so turning water does not spiral outwards.
// A step is cut where it crosses an edge of a thin piece; what ends inside of a piece is moved to its nearest face.
//
// Reads: points, displacements, solids at tiles. Writes: particles. Cost: O(points x solids near their tile).
#include "liquid/back.h"

#include <math.h>

#define LEAST_WIDTH 1.0  // [cells] of what is not thin
#define MOST_WAY    2.0  // cells that the solids listed at a tile are good for
#define SKIN        0.01 // cells that are kept from solids

typedef pl_liquid_place place;

// [cells] the corner of a tile; where a point of the tile lies.
static place corner_of(const pl_liquid_tile *tile)
{
    return (place){ (double)(tile->x * PL_LIQUID_SIDE), (double)(tile->y * PL_LIQUID_SIDE) };
}

static place place_of(place corner, const pl_liquid_point *p)
{
    const int32_t k = (int32_t)((p->cell - 1) % PL_LIQUID_TILE);
    return (place){ corner.x + (double)(k % PL_LIQUID_SIDE) + (double)p->fx,
                    corner.y + (double)(k / PL_LIQUID_SIDE) + (double)p->fy };
}

// Which way it goes in this part of a step, as its velocity is half way along it.
static inline place way_of(const pl_liquid_flow *flow, double way)
{
    const near_real half = (near_real)(way / 2), u = flow->value[0], v = flow->value[1];
    const pl_near_quad middle = flow->value + half * (u * flow->along_x + v * flow->along_y);
    return (place){ way * (double)middle[0] + (double)flow->value[2],
                    way * (double)middle[1] + (double)flow->value[3] };
}

static place end_of(place from, place way)
{
    return (place){ from.x + pl_liquid_held(way.x, PL_LIQUID_MOST_CELL),
                    from.y + pl_liquid_held(way.y, PL_LIQUID_MOST_CELL) };
}

//---- out of solids -------------------------------------------------------------------------------

// How far outside of a piece, and the way out.
typedef struct gap {
    double distance, nx, ny;
} gap;

static gap gap_to_segment(const pl_liquid_solid *s, int i, int k, place at)
{
    const double dx = s->x[k] - s->x[i], dy = s->y[k] - s->y[i], square = dx * dx + dy * dy;
    double t = square > 0 ? ((at.x - s->x[i]) * dx + (at.y - s->y[i]) * dy) / square : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    const double x = at.x - s->x[i] - t * dx, y = at.y - s->y[i] - t * dy;
    const double d = sqrt(x * x + y * y);
    return d > 0 ? (gap){ d, x / d, y / d } : (gap){ 0, 0, 1 };
}

static gap gap_to(const pl_liquid_solid *s, place at)
{
    gap inside = { -INFINITY, 0, 1 }, outside = { INFINITY, 0, 1 };
    bool is_in = s->count > 2;
    for (int i = 0; i < s->count; ++i) {
        const int k = i + 1 < s->count ? i + 1 : 0;
        const gap edge = gap_to_segment(s, i, k, at);
        outside = edge.distance < outside.distance ? edge : outside;
        if (s->nx[i] != 0 || s->ny[i] != 0) {
            const double d = (at.x - s->x[i]) * s->nx[i] + (at.y - s->y[i]) * s->ny[i];
            is_in &= d < 0;
            inside = d > inside.distance && (s->exits >> i & 1) != 0
                         ? (gap){ d, s->nx[i], s->ny[i] }
                         : inside;
        }
    }
    gap out = is_in ? inside : outside;
    out.distance -= s->radius;
    return out;
}

// Whether it is a skin off one side's line, and so off the piece.
static bool is_clear(const pl_liquid_solid *s, place at)
{
    bool clear = false;
    for (int i = 0; i < s->count; ++i) {
        clear |= (at.x - s->x[i]) * s->nx[i] + (at.y - s->y[i]) * s->ny[i] >= s->radius + SKIN;
    }
    return clear;
}

// Where the way meets an edge of a piece: it ends a skin before it, or goes on along it if it slides.
static place cut(const pl_liquid_solid *s, bool slides, place from, place to, place *normal)
{
    const double wx = to.x - from.x, wy = to.y - from.y;
    double least = 1;
    place end = to;
    for (int i = 0; i < s->count; ++i) {
        const int k = i + 1 < s->count ? i + 1 : 0;
        const double dx = s->x[k] - s->x[i], dy = s->y[k] - s->y[i];
        const double ax = s->x[i] - from.x, ay = s->y[i] - from.y;
        const double det = wx * dy - wy * dx, length = sqrt(dx * dx + dy * dy);
        if (!(fabs(det) > 1e-12)) {
            continue;
        }
        const double t = (ax * dy - ay * dx) / det, along = (ax * wy - ay * wx) / det;
        if (t >= 0 && t <= least && along >= 0 && along <= 1) {
            // The side that it comes from.
            const double side = (ax * dy - ay * dx > 0 ? -1 : 1) / length;
            const place n = { side * dy, -side * dx };
            const double rest = slides ? 1 - t : 0, into = n.x * wx + n.y * wy;
            const double x = rest * (wx - into * n.x), y = rest * (wy - into * n.y);
            least = t;
            *normal = n;
            end = (place){ from.x + t * wx + x + (s->radius + SKIN) * n.x,
                           from.y + t * wy + y + (s->radius + SKIN) * n.y };
        }
    }
    return end;
}

static place out_of(const pl_liquid_solid *s, place to, place *normal)
{
    const gap out = is_clear(s, to) ? (gap){ INFINITY, 0, 0 } : gap_to(s, to);
    if (out.distance < SKIN) {
        *normal = (place){ out.nx, out.ny };
        to.x += (SKIN - out.distance) * out.nx;
        to.y += (SKIN - out.distance) * out.ny;
    }
    return to;
}

static place slide(const pl_liquid_solid *s, place from, place to, place *normal)
{
    place unused; // from within, its far side would be the first that the way meets
    return cut(s, true, s->count > 2 ? out_of(s, from, &unused) : from, to, normal);
}

static bool is_firm(const pl_liquid_solid *s)
{
    return s->count > 2 && !s->soft;
}

static bool stands(const pl_liquid_grid *g, const pl_liquid_solid *s)
{
    return is_firm(s) && (s->body == PL_LIQUID_NONE || !g->bodies[s->body].moves);
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

static double smaller(double a, double b)
{
    return a < b ? a : b;
}

place pl_liquid_slide_all(const pl_liquid_grid *g, place from, place to, place *normal,
                          place *standing)
{
    *normal = *standing = (place){ 0, 0 };
    // What stands, the first of them, has the last word.
    for (uint32_t i = g->solid_count; i-- > 0;) {
        const pl_liquid_solid *s = &g->solids[i];
        if (larger(from.x, to.x) < s->low_x - 1 || smaller(from.x, to.x) > s->high_x + 1 ||
            larger(from.y, to.y) < s->low_y - 1 || smaller(from.y, to.y) > s->high_y + 1) {
            continue;
        }
        place met = { 0, 0 };
        to = out_of(s, slide(s, from, to, &met), &met);
        if (met.x != 0 || met.y != 0) {
            *normal = met;
            *standing = stands(g, s) ? met : *standing;
        }
    }
    return to;
}

static bool is_within(const pl_liquid_grid *g, const pl_liquid_tile *tile, place at)
{
    bool within = false;
    for (uint32_t k = 0; k < tile->solid_count && !within; ++k) {
        const pl_liquid_solid *s = &g->solids[g->tile_solids[tile->first_solid + k]];
        within = is_firm(s) && at.x >= s->low_x && at.x <= s->high_x && at.y >= s->low_y &&
                 at.y <= s->high_y && gap_to(s, at).distance < 0;
    }
    return within;
}

// How near a place must be to a solid's box to be kept out of it. Only what may be crossed matters before a way ends in it.
static double room_at(const pl_liquid_solid *s, bool fast)
{
    return s->thin || fast ? SKIN + MOST_WAY : 2 * SKIN;
}

#define MARGIN 2 // cells around a tile where ways from it end
#define ACROSS (PL_LIQUID_SIDE + 2 * MARGIN)
#define SLOW   0.499 // [cells] a way; beyond it a particle is fast, and seen to by itself
#define LISTED 64    // solids at a tile that bits are kept of

// Which of a tile's solids slow ways that end in a column and in a row of cells meet: a bit each.
typedef struct fence {
    const pl_liquid_tile *tile;
    uint64_t columns[ACROSS], rows[ACROSS];
} fence;

static int across_of(double at, int32_t tile)
{
    const double cell = at - (double)tile * PL_LIQUID_SIDE + MARGIN;
    return cell <= 0 ? 0 : cell >= ACROSS - 1 ? ACROSS - 1 : (int)cell;
}

static void see_solids(fence *f, const pl_liquid_grid *g, const pl_liquid_tile *tile)
{
    *f = (fence){ .tile = tile };
    for (uint32_t k = 0; k < tile->solid_count && k < LISTED; ++k) {
        const pl_liquid_solid *s = &g->solids[g->tile_solids[tile->first_solid + k]];
        const double room = room_at(s, false);
        const int right = across_of(s->high_x + room, tile->x);
        const int top = across_of(s->high_y + room, tile->y);
        for (int i = across_of(s->low_x - room, tile->x); i <= right; ++i) {
            f->columns[i] |= UINT64_C(1) << k;
        }
        for (int j = across_of(s->low_y - room, tile->y); j <= top; ++j) {
            f->rows[j] |= UINT64_C(1) << k;
        }
    }
}

static uint64_t near_of(const fence *f, place at, bool fast)
{
    return fast ? UINT64_MAX
                : f->columns[across_of(at.x, f->tile->x)] & f->rows[across_of(at.y, f->tile->y)];
}

// Whether a way is slow and leads to none of a tile's solids.
static inline bool is_free(const fence *f, place corner, place way, place to)
{
    if (!(fabs(way.x) < SLOW && fabs(way.y) < SLOW)) { // or no number
        return false;
    }
    const int i = (int)(to.x - corner.x + MARGIN), j = (int)(to.y - corner.y + MARGIN);
    return (f->columns[i] & f->rows[j]) == 0 && f->tile->solid_count <= LISTED;
}

// The last of a tile's solids before k that may be near.
static uint32_t near_below(uint64_t near, uint32_t k)
{
    if (k > LISTED) {
        return k - 1;
    }
    near &= k < LISTED ? (UINT64_C(1) << k) - 1 : UINT64_MAX;
    return near != 0 ? 63 - (uint32_t)__builtin_clzll(near) : PL_LIQUID_NONE;
}

// `normal` of what stands and has stopped one that is fast; else none.
static place keep_out(const pl_liquid_grid *g, const fence *f, place from, place to, place *normal)
{
    const pl_liquid_tile *tile = f->tile;
    const double way = larger(fabs(to.x - from.x), fabs(to.y - from.y));
    const bool fast = way > LEAST_WIDTH / 2;
    place unused;
    bool held = false;
    *normal = (place){ 0, 0 };
    if (way > MOST_WAY) {
        return pl_liquid_slide_all(g, from, to, &unused, normal);
    }
    uint64_t near = near_of(f, to, fast);
    for (uint32_t k = near_below(near, tile->solid_count); k != PL_LIQUID_NONE; // as above
         k = near_below(near, k)) {
        const pl_liquid_solid *s = &g->solids[g->tile_solids[tile->first_solid + k]];
        const double room = room_at(s, fast);
        if (to.x >= s->low_x - room && to.x <= s->high_x + room && to.y >= s->low_y - room &&
            to.y <= s->high_y + room) {
            place met = { 0, 0 };
            to = s->thin ? cut(s, false, from, to, &met) : fast ? slide(s, from, to, &met) : to;
            const place out = out_of(s, to, &met);
            *normal = fast && stands(g, s) && (met.x != 0 || met.y != 0) ? met : *normal;
            held |= is_firm(s) && (out.x != to.x || out.y != to.y);
            to = out;
            near = near_of(f, to, fast);
        }
    }
    // Where two lie flush, each would push it into the other, and it into the seam.
    const bool enters_wall = held && is_within(g, tile, to) && !is_within(g, tile, from);
    return enters_wall ? from : to;
}

//---- all of them ---------------------------------------------------------------------------------

typedef pl_near_quad quad;

static plumb_real within(near_real value, near_real most)
{
    return (plumb_real)(value > most ? most : value < -most ? -most : value == value ? value : 0);
}

typedef struct motion {
    pl_liquid_grid *g;
    double way;
    plumb_particle *particles;
} motion;

// What is out of bounds is put within, what is no number is 0.
static inline void store(plumb_particle *out, const pl_liquid_flow *f, place to, near_real h)
{
    const near_real fastest = (near_real)PL_LIQUID_SPEED, steepest = (near_real)PL_LIQUID_SLOPE;
    const quad by_cell = { f->along_x[0], f->along_y[0], f->along_x[1], f->along_y[1] };
    const quad v = f->value, slopes = by_cell * (1 / h);
    const pl_near_mask in =
        (v <= fastest) & (v >= -fastest) & (slopes <= steepest) & (slopes >= -steepest);
    const bool all = (in[0] & in[1] & in[2] & in[3]) != 0;
    for (int k = 0; k < 4; ++k) {
        out->gradient[k] = all ? (plumb_real)slopes[k] : within(slopes[k], steepest);
    }
    out->velocity.x = all ? (plumb_real)v[0] : within(v[0], fastest);
    out->velocity.y = all ? (plumb_real)v[1] : within(v[1], fastest);
    out->position = (plumb_vec2){ (plumb_real)(to.x * (double)h), (plumb_real)(to.y * (double)h) };
}

// In a cell whose faces are all shut. No pressure answers to slopes there: kept, two particles that took each other's were twice as
// fast in each step: 159 m/s.
static bool is_shut_in(const pl_liquid_grid *g, uint32_t point)
{
    return g->row[g->points[point].cell] == 0;
}

// As far as solids and other phases let it.
static place go(const motion *m, const fence *f, uint32_t k, place from, place way,
                pl_liquid_flow *flow)
{
    place end = end_of(from, way), normal;
    if (m->g->mixture != NULL) {
        const place drift = pl_liquid_drift(m->g, k, m->way);
        end.x += drift.x, end.y += drift.y;
    }
    const place to = keep_out(m->g, f, from, end, &normal);
    if (is_shut_in(m->g, k)) {
        flow->along_x = flow->along_y = (quad){ 0 };
    }
    // Kept, a film under a crate made more of it in every step: 70 m/s into the ground.
    const double into = normal.x * (double)flow->value[0] + normal.y * (double)flow->value[1];
    if (into < 0) {
        flow->value[0] -= (near_real)(into * normal.x);
        flow->value[1] -= (near_real)(into * normal.y);
    }
    return to;
}

static void move_range(void *context, uint32_t first, uint32_t count)
{
    const motion *m = context;
    const pl_liquid_grid *g = m->g;
    fence f = { .tile = NULL };
    place corner = { 0, 0 };
    for (uint32_t k = first; k < first + count; ++k) {
        const pl_liquid_point *p = &g->points[k];
        const pl_liquid_tile *tile = &g->tiles[(p->cell - 1) / PL_LIQUID_TILE];
        if (tile != f.tile) {
            see_solids(&f, g, tile);
            corner = corner_of(tile);
        }
        pl_liquid_flow flow;
        pl_liquid_find_flow(g, p, &flow);
        const place from = place_of(corner, p), way = way_of(&flow, m->way);
        place to = { from.x + way.x, from.y + way.y };
        if (!is_free(&f, corner, way, to) || g->mixture != NULL || is_shut_in(g, k)) {
            to = go(m, &f, k, from, way, &flow);
        }
        store(&m->particles[p->index], &flow, to, g->h);
    }
}

void pl_liquid_move(pl_liquid_grid *g, double way, plumb_particle *particles)
{
    motion m = { g, way, particles };
    pl_tasks_ranges(g->tasks, g->point_count, 512, move_range, &m);
}
