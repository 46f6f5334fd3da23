// move.c - particles go where the liquid takes them, and not into solids.
//
// Velocity half way along the step is known from a particle's own slopes, so turning water does not spiral outwards.
// A step is cut where it crosses an edge of a thin piece; what ends inside of a piece is moved to its nearest face.
//
// Reads: points, displacements, solids at tiles. Writes: particles. Cost: O(points x solids near their tile).
#include "liquid/liquid.h"
#include "core/quad.h"

#include <math.h>
#include <string.h>

#define LEAST_WIDTH 1.0  // [cells] of what is not thin
#define MOST_WAY    2.0  // cells that the solids listed at a tile are good for
#define SKIN        0.01 // cells that are kept from solids

typedef pl_liquid_place place;

static place place_of(const pl_liquid_grid *g, const pl_liquid_point *p)
{
    const pl_liquid_tile *tile = &g->tiles[(p->cell - 1) / PL_LIQUID_TILE];
    const uint32_t k = (p->cell - 1) % PL_LIQUID_TILE;
    return (place){
        (double)(tile->x * PL_LIQUID_SIDE + (int32_t)(k % PL_LIQUID_SIDE)) + (double)p->fx,
        (double)(tile->y * PL_LIQUID_SIDE + (int32_t)(k / PL_LIQUID_SIDE)) + (double)p->fy
    };
}

static place end_of(const pl_liquid_grid *g, pl_liquid_point *p, place from, double way)
{
    near_real dx, dy;
    pl_liquid_sample(g, p, &dx, &dy);
    const near_real half = (near_real)(way / 2);
    const near_real x = p->u + half * (p->u * p->slope[0] + p->v * p->slope[1]);
    const near_real y = p->v + half * (p->u * p->slope[2] + p->v * p->slope[3]);
    return (place){ from.x + pl_liquid_held(way * (double)x + (double)dx, PL_LIQUID_MOST_CELL),
                    from.y + pl_liquid_held(way * (double)y + (double)dy, PL_LIQUID_MOST_CELL) };
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
        const double dx = s->x[k] - s->x[i], dy = s->y[k] - s->y[i];
        const double length = sqrt(dx * dx + dy * dy);
        const gap edge = gap_to_segment(s, i, k, at);
        outside = edge.distance < outside.distance ? edge : outside;
        if (length > 0) {
            const double nx = dy / length, ny = -dx / length;
            const double d = (at.x - s->x[i]) * nx + (at.y - s->y[i]) * ny;
            is_in &= d < 0;
            inside = d > inside.distance && (s->exits >> i & 1) != 0 ? (gap){ d, nx, ny } : inside;
        }
    }
    gap out = is_in ? inside : outside;
    out.distance -= s->radius;
    return out;
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
    const gap out = gap_to(s, to);
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

static double larger(double a, double b)
{
    return a > b ? a : b;
}

static double smaller(double a, double b)
{
    return a < b ? a : b;
}

place pl_liquid_slide_all(const pl_liquid_grid *g, place from, place to, place *normal)
{
    *normal = (place){ 0, 0 };
    // What stands, the first of them, has the last word.
    for (uint32_t i = g->solid_count; i-- > 0;) {
        const pl_liquid_solid *s = &g->solids[i];
        if (larger(from.x, to.x) < s->low_x - 1 || smaller(from.x, to.x) > s->high_x + 1 ||
            larger(from.y, to.y) < s->low_y - 1 || smaller(from.y, to.y) > s->high_y + 1) {
            continue;
        }
        to = out_of(s, slide(s, from, to, normal), normal);
    }
    return to;
}

static bool stands(const pl_liquid_grid *g, const pl_liquid_solid *s)
{
    return s->count > 2 && !s->soft && (s->body == PL_LIQUID_NONE || !g->bodies[s->body].moves);
}

static bool is_within(const pl_liquid_grid *g, const pl_liquid_tile *tile, place at)
{
    bool within = false;
    for (uint32_t k = 0; k < tile->solid_count && !within; ++k) {
        const pl_liquid_solid *s = &g->solids[g->tile_solids[tile->first_solid + k]];
        within = stands(g, s) && at.x >= s->low_x && at.x <= s->high_x && at.y >= s->low_y &&
                 at.y <= s->high_y && gap_to(s, at).distance < 0;
    }
    return within;
}

// `normal` of what stands and has stopped one that is fast; else none.
static place keep_out(const pl_liquid_grid *g, const pl_liquid_tile *tile, place from, place to,
                      place *normal)
{
    const double room = SKIN + MOST_WAY;
    const double way = larger(fabs(to.x - from.x), fabs(to.y - from.y));
    const bool fast = way > LEAST_WIDTH / 2;
    place unused;
    bool held = false;
    *normal = (place){ 0, 0 };
    if (way > MOST_WAY) {
        return pl_liquid_slide_all(g, from, to, &unused);
    }
    for (uint32_t k = tile->solid_count; k-- > 0;) { // as above
        const pl_liquid_solid *s = &g->solids[g->tile_solids[tile->first_solid + k]];
        if (to.x >= s->low_x - room && to.x <= s->high_x + room && to.y >= s->low_y - room &&
            to.y <= s->high_y + room) {
            place met = { 0, 0 };
            to = s->thin ? cut(s, false, from, to, &met) : fast ? slide(s, from, to, &met) : to;
            const place out = out_of(s, to, &met);
            *normal = fast && stands(g, s) && (met.x != 0 || met.y != 0) ? met : *normal;
            held |= stands(g, s) && (out.x != to.x || out.y != to.y);
            to = out;
        }
    }
    // Where two that stand lie flush, each would push it into the other, and it into the seam.
    const bool enters_wall = held && is_within(g, tile, to) && !is_within(g, tile, from);
    return enters_wall ? from : to;
}

//---- all of them ---------------------------------------------------------------------------------

typedef pl_near_quad quad;

// Each of four within bounds; what is no number is 0.
static inline void put_within(plumb_real out[4], const near_real in[4], near_real scale,
                              near_real most)
{
    quad q;
    memcpy(&q, in, sizeof q);
    q *= scale;
    const quad top = (quad){ most, most, most, most }, low = -top;
    const pl_near_mask above = q > top, below = q < low, is_number = q == q;
    pl_near_mask bits = (above & (pl_near_mask)top) | (~above & (pl_near_mask)q);
    bits = (below & (pl_near_mask)low) | (~below & bits);
    q = (quad)(bits & is_number);
    for (int k = 0; k < 4; ++k) {
        out[k] = (plumb_real)q[k];
    }
}

static plumb_real within(near_real value, near_real most)
{
    return (plumb_real)(value > most ? most : value < -most ? -most : value == value ? value : 0);
}

typedef struct motion {
    pl_liquid_grid *g;
    double way;
    plumb_particle *particles;
} motion;

static void move_range(void *context, uint32_t first, uint32_t count)
{
    const motion *m = context;
    const pl_liquid_grid *g = m->g;
    const double h = (double)g->h;
    const near_real scale = 1 / g->h, fastest = (near_real)PL_LIQUID_SPEED;
    const near_real steepest = (near_real)PL_LIQUID_SLOPE;
    for (uint32_t k = first; k < first + count; ++k) {
        pl_liquid_point *p = &g->points[k];
        const pl_liquid_tile *tile = &g->tiles[(p->cell - 1) / PL_LIQUID_TILE];
        const place from = place_of(g, p);
        place end = end_of(g, p, from, m->way);
        if (g->mixture != NULL) {
            const place drift = pl_liquid_drift(g, k, m->way);
            end.x += drift.x, end.y += drift.y;
        }
        place normal;
        const place to = keep_out(g, tile, from, end, &normal);
        // Kept, a film under a crate made more of it in every step: 70 m/s into the ground.
        const double into = normal.x * (double)p->u + normal.y * (double)p->v;
        if (into < 0) {
            p->u -= (near_real)(into * normal.x), p->v -= (near_real)(into * normal.y);
        }
        plumb_particle *out = &m->particles[p->index];
        out->position = (plumb_vec2){ (plumb_real)(to.x * h), (plumb_real)(to.y * h) };
        out->velocity = (plumb_vec2){ within(p->u, fastest), within(p->v, fastest) };
        put_within(out->gradient, p->slope, scale, steepest);
    }
}

void pl_liquid_move(pl_liquid_grid *g, double way, plumb_particle *particles)
{
    motion m = { g, way, particles };
    pl_tasks_ranges(g->tasks, g->point_count, 512, move_range, &m);
}
