// films.c - bodies that yield as the liquid passes them: thinner by a film all round, so that some gets between what touches.
//
// What lies flush on the ground has no cell with a pressure under it, and would stay there whatever it weighed. Sides go inward
// by a film, and corners to where they meet then; but not where pieces of one body lie on one another.
//
// Reads, writes: solids. Cost: O(sides), and O(pieces) times that of bodies of several pieces, once a step.
#include "liquid/liquid.h"

#include <math.h>

#define FILM     0.1 // [cells]
#define SHARPEST 0.2 // sine between sides; corners that are sharper would go too far

typedef struct side {
    double x, y, nx, ny, length; // its middle; outward
} side;

static side side_of(const pl_liquid_solid *s, int i)
{
    const int next = (i + 1) % s->count;
    const double dx = s->x[next] - s->x[i], dy = s->y[next] - s->y[i];
    const double length = sqrt(dx * dx + dy * dy), scale = length > 0 ? 1 / length : 0;
    return (side){ (s->x[i] + s->x[next]) / 2, (s->y[i] + s->y[next]) / 2, dy * scale, -dx * scale,
                   length };
}

// How far a place is out of a piece, and over which side.
static double distance_to(const pl_liquid_solid *s, double x, double y, int *over)
{
    const double dx = x - s->x[0], dy = y - s->y[0];
    double most = s->count > 2 ? -INFINITY : sqrt(dx * dx + dy * dy) - s->radius;
    *over = 0;
    for (int i = 0; i < s->count && s->count > 2; ++i) {
        const side of = side_of(s, i);
        const double out = (x - of.x) * of.nx + (y - of.y) * of.ny - s->radius;
        *over = out > most ? i : *over;
        most = out > most ? out : most;
    }
    return most;
}

// Where a piece lies on another, both have a side that does: the smaller one tells which.
static void mark_sides(pl_liquid_solid *s, pl_liquid_solid *other)
{
    for (int i = 0; i < s->count && s->count > 2; ++i) {
        const side of = side_of(s, i);
        const double out = s->radius + FILM, half = 0.4 * of.length;
        for (int k = -1; k <= 1; ++k) {
            int over;
            const double x = of.x + out * of.nx - k * half * of.ny;
            const double y = of.y + out * of.ny + k * half * of.nx;
            if (distance_to(other, x, y, &over) < 0) {
                s->inner |= UINT32_C(1) << i;
                other->inner |= UINT32_C(1) << over;
            }
        }
    }
}

void pl_liquid_find_inner(pl_liquid_grid *g)
{
    for (uint32_t i = 0; i < g->solid_count; ++i) {
        g->solids[i].inner = 0;
    }
    for (uint32_t i = 0; i < g->solid_count; ++i) {
        const uint32_t body = g->solids[i].body;
        uint32_t k = i + 1; // those of a body are one range
        for (; body != PL_LIQUID_NONE && k < g->solid_count && g->solids[k].body == body; ++k) {
            mark_sides(&g->solids[i], &g->solids[k]);
            mark_sides(&g->solids[k], &g->solids[i]);
        }
    }
}

void pl_liquid_draw_in(pl_liquid_solid *s)
{
    s->film_radius = s->radius > 2 * FILM && s->inner == 0 ? s->radius - FILM : s->radius;
    const double film = s->film_radius < s->radius ? 0 : FILM;
    for (int i = 0; i < s->count; ++i) {
        s->film_x[i] = s->x[i];
        s->film_y[i] = s->y[i];
        if (s->count < 3) {
            continue;
        }
        const int last = (i + s->count - 1) % s->count;
        const side a = side_of(s, last), b = side_of(s, i);
        const double way_a = (s->inner >> last & 1) != 0 ? 0 : film;
        const double way_b = (s->inner >> i & 1) != 0 ? 0 : film;
        const double cross = a.nx * b.ny - a.ny * b.nx;
        if (cross > SHARPEST) {
            s->film_x[i] -= (way_a * b.ny - way_b * a.ny) / cross;
            s->film_y[i] -= (way_b * a.nx - way_a * b.nx) / cross;
        } else {
            s->film_x[i] -= (way_a * a.nx + way_b * b.nx) / 2;
            s->film_y[i] -= (way_a * a.ny + way_b * b.ny) / 2;
        }
    }
}
