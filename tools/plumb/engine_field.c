/// engine_field.c - the overlay of fields: arrows of the acceleration that gravity and laws give, on a grid. Compiled once for
/// each precision.
///
/// Fields of attractors go over many powers of ten, so length and colour go by the logarithm of the strength, from DECADES
/// below the strongest on; the strongest is that of which the few that lie nearest to an attractor are left out. Of a body
/// without charge; where nothing but gravity acts on such a one, of a charge, without gravity: the field of charges and
/// magnets. Cost: O(arrows laws).
#include "engine_session.h"
#include "render/render.h"

#include <math.h>
#include <stdlib.h>

/// Arrows in the height of a picture, and what is far too many in its width.
#define ROWS 15
#define MOST 4000
/// Powers of ten from the weakest arrow to the strongest.
#define DECADES 2.0
/// Share of arrows that may be stronger than the strongest.
#define LEFT_OUT 0.02

typedef struct arrow {
    double x, y, ax, ay, strength;
} arrow;

static int by_strength(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// The strength that all but a few do not exceed; 0: nothing acts.
static double strongest_of(const arrow *list, int count, double *room)
{
    int used = 0;
    for (int i = 0; i < count; i++) {
        if (list[i].strength > 0) {
            room[used++] = list[i].strength;
        }
    }
    qsort(room, (size_t)used, sizeof *room, by_strength);
    return used == 0 ? 0 : room[used - 1 - (int)(LEFT_OUT * used)];
}

/// Of a body without charge; `charged`: what a charge of 1 C/kg gets besides.
static int probe(const plumb_world *world, const engine_box *view, double spacing, bool charged,
                 arrow *list)
{
    // At multiples of the spacing: they stay where they are while the camera moves.
    const double left = ceil(view->min_x / spacing), low = ceil(view->min_y / spacing);
    int count = 0;
    for (double j = low; j * spacing <= view->max_y; j++) {
        for (double i = left; i * spacing <= view->max_x && count < MOST; i++) {
            const double x = i * spacing, y = j * spacing;
            const plumb_vec2 at = { (plumb_real)x, (plumb_real)y }, none = { 0, 0 };
            const plumb_vec2 a = plumb_world_law_at(world, at, none, 0);
            const plumb_vec2 c = charged ? plumb_world_law_at(world, at, none, 1) : none;
            const double ax = charged ? (double)c.x - (double)a.x : (double)a.x;
            const double ay = charged ? (double)c.y - (double)a.y : (double)a.y;
            list[count++] = (arrow){ x, y, ax, ay, hypot(ax, ay) };
        }
    }
    return count;
}

/// All arrows are the same: gravity, or nothing.
static bool is_even(const arrow *list, int count)
{
    for (int i = 1; i < count; i++) {
        if (list[i].ax != list[0].ax || list[i].ay != list[0].ay) {
            return false;
        }
    }
    return true;
}

static int probe_what_there_is(const plumb_world *world, const engine_box *view, double spacing,
                               arrow *list, double *room)
{
    int count = probe(world, view, spacing, false, list);
    if (is_even(list, count)) {
        count = probe(world, view, spacing, true, list);
        if (!(strongest_of(list, count, room) > 0)) {
            count = probe(world, view, spacing, false, list);
        }
    }
    return count;
}

int pl_stage_draw_field(engine_stage *stage, struct render_frame *frame, const engine_box *view)
{
    const double spacing = (view->max_y - view->min_y) / ROWS;
    arrow *list = malloc(MOST * sizeof *list);
    double *room = malloc(MOST * sizeof *room);
    const int count = list == NULL || room == NULL || !(spacing > 0)
                          ? 0
                          : probe_what_there_is(stage->world, view, spacing, list, room);
    const double most = count == 0 ? 0 : strongest_of(list, count, room);
    for (int i = 0; i < count && most > 0; i++) {
        const arrow *a = &list[i];
        const double t = 1 + log10(fmin(1, a->strength / most)) / DECADES;
        if (!(t > 0)) {
            continue; // nothing acts there, or next to nothing
        }
        const double length = spacing * (0.25 + 0.55 * t) / a->strength;
        render_add_field(frame, a->x, a->y, length * a->ax, length * a->ay, fmin(a->strength, most),
                         t);
    }
    const bool good = list != NULL && room != NULL;
    free(room);
    free(list);
    return good && render_frame_status(frame) != RENDER_E_MEMORY ? CLI_OK : CLI_FAILED;
}
