/// engine_flow.c - the overlay of flow: pieces of the streamlines of the air and of fluids, each as long as what flows there goes
/// in the same time. Compiled once for each precision.
///
/// Seeds lie on a lattice that stays where it is while the camera moves, every other line moved by half. Cost: O(pieces).
#include "engine_session.h"
#include "render/render.h"

#include <math.h>
#include <stdlib.h>

/// Lines of seeds in the height of a picture, and what is far too many in its width.
#define ROWS 26
#define MOST 4000
/// Points of a piece, half of them to either side of its seed.
#define POINTS 17
/// Of the lattice's spacing: how long the piece is of the fastest.
#define LONGEST 2.6
/// Of the fastest: what is slower is not drawn.
#define SLOWEST 0.02

/// What flows, and where.
typedef struct flow {
    plumb_world *world;
    bool has_air;
    plumb_air_box air;
} flow;

static bool is_in_air(const flow *f, render_vec at)
{
    return f->has_air && at.x >= (double)f->air.low.x && at.x <= (double)f->air.high.x &&
           at.y >= (double)f->air.low.y && at.y <= (double)f->air.high.y;
}

static plumb_vec2 velocity_at(const flow *f, render_vec at)
{
    const plumb_vec2 place = { (plumb_real)at.x, (plumb_real)at.y };
    return is_in_air(f, at) ? plumb_air_at(f->world, place).velocity
                            : plumb_fluid_at(f->world, place).velocity;
}

/// By the midpoint rule, a time that may be negative.
static render_vec move_on(const flow *f, render_vec at, double time)
{
    const plumb_vec2 a = velocity_at(f, at);
    const render_vec half = { at.x + time / 2 * (double)a.x, at.y + time / 2 * (double)a.y };
    const plumb_vec2 b = velocity_at(f, half);
    return (render_vec){ at.x + time * (double)b.x, at.y + time * (double)b.y };
}

static double speed_of(plumb_vec2 v)
{
    return hypot((double)v.x, (double)v.y);
}

static int by_speed(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// Seeds in the view, with their speeds.
static int find_seeds(const flow *f, const engine_box *view, double spacing, render_vec *seeds,
                      double *speeds)
{
    int count = 0;
    for (double j = ceil(view->min_y / spacing); j * spacing <= view->max_y; j++) {
        const double shift = fmod(fabs(j), 2) / 2;
        for (double i = ceil(view->min_x / spacing);
             (i + shift) * spacing <= view->max_x && count < MOST; i++) {
            seeds[count] = (render_vec){ (i + shift) * spacing, j * spacing };
            speeds[count] = speed_of(velocity_at(f, seeds[count]));
            count++;
        }
    }
    return count;
}

static void add_piece(const flow *f, struct render_frame *frame, render_vec seed, double time,
                      double speed, double share)
{
    render_vec points[POINTS];
    const int half = POINTS / 2;
    points[half] = seed;
    for (int k = 1; k <= half; k++) {
        points[half + k] = move_on(f, points[half + k - 1], time / (POINTS - 1));
        points[half - k] = move_on(f, points[half - k + 1], -time / (POINTS - 1));
    }
    render_add_flow(frame, points, POINTS, speed, share);
}

int pl_stage_draw_flow(engine_stage *stage, struct render_frame *frame, const engine_box *view)
{
    flow f = { .world = stage->world };
    const double spacing = (view->max_y - view->min_y) / ROWS;
    if (!(spacing > 0)) {
        return CLI_OK;
    }
    f.has_air = plumb_air_cells(stage->world, &f.air) == PLUMB_OK;
    render_vec *seeds = malloc(MOST * sizeof *seeds);
    double *speeds = malloc(2 * MOST * sizeof *speeds);
    const bool good = seeds != NULL && speeds != NULL;
    const int count = good ? find_seeds(&f, view, spacing, seeds, speeds) : 0;
    double most = 0;
    if (count > 0) { // but for the few that are faster than all others
        double *sorted = speeds + MOST;
        for (int i = 0; i < count; i++) {
            sorted[i] = speeds[i];
        }
        qsort(sorted, (size_t)count, sizeof *sorted, by_speed);
        most = sorted[count - 1 - count / 50];
    }
    for (int i = 0; i < count; i++) {
        const double share = fmin(speeds[i] / most, 1);
        if (most > 0 && share > SLOWEST) {
            add_piece(&f, frame, seeds[i], LONGEST * spacing / fmax(most, speeds[i]), speeds[i],
                      share);
        }
    }
    free(speeds);
    free(seeds);
    return good && render_frame_status(frame) != RENDER_E_MEMORY ? CLI_OK : CLI_FAILED;
}
