/// trail.c - keeps the last seconds of every moving body's way.
///
/// Reads the rows of a stage, fills a frame. Cost: a point a body and step; points too old are
/// dropped when they are as many as those in use.
#include "trail.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct trail {
    char name[128];
    render_rgba color;
    bool seen; ///< at the last recording: a body that is gone has no trail
    render_vec *points;
    double *times; ///< [s] of the points
    size_t first, count, room;
};

static struct trail *find_trail(trail_set *set, const engine_row *row, int hint)
{
    // Rows come in the same order; the search goes on only after a body has vanished.
    for (int k = 0; k < set->count; k++) {
        struct trail *t = &set->items[(hint + k) % set->count];
        if (strncmp(t->name, row->name, sizeof t->name - 1) == 0) {
            return t;
        }
    }
    if (set->count == set->room) {
        int room = 2 * set->room + 16;
        struct trail *grown = realloc(set->items, (size_t)room * sizeof *grown);
        if (grown == NULL) {
            return NULL;
        }
        set->items = grown;
        set->room = room;
    }
    struct trail *t = &set->items[set->count++];
    *t = (struct trail){ .color = { row->color[0], row->color[1], row->color[2], row->color[3] } };
    snprintf(t->name, sizeof t->name, "%s", row->name);
    return t;
}

static bool add_point(struct trail *t, double time, double oldest, render_vec point)
{
    while (t->first < t->count && t->times[t->first] < oldest) {
        t->first++;
    }
    if (t->first > t->count / 2) {
        t->count -= t->first;
        memmove(t->points, t->points + t->first, t->count * sizeof *t->points);
        memmove(t->times, t->times + t->first, t->count * sizeof *t->times);
        t->first = 0;
    }
    if (t->count == t->room) {
        size_t room = 2 * t->room + 64;
        render_vec *points = realloc(t->points, room * sizeof *points);
        t->points = points != NULL ? points : t->points;
        double *times = points != NULL ? realloc(t->times, room * sizeof *times) : NULL;
        if (times == NULL) {
            return false;
        }
        t->times = times;
        t->room = room;
    }
    t->points[t->count] = point;
    t->times[t->count++] = time;
    return true;
}

bool trail_record(trail_set *set, const engine_scenery *of)
{
    const engine_row *rows;
    if (set->seconds <= 0) {
        return true;
    }
    set->wrap_x = of->info.wrap_x;
    set->wrap_y = of->info.wrap_y;
    int count = of->engine->rows(of->stage, &rows), moving = 0;
    double time = of->engine->time(of->stage);
    // A tenth of a step of slack: times are sums of steps.
    double oldest = time - set->seconds - of->info.dt / 10;
    for (int i = 0; i < set->count; i++) {
        set->items[i].seen = false;
    }
    for (int i = 0; i < count; i++) {
        if (!rows[i].moves) {
            continue;
        }
        struct trail *t = find_trail(set, &rows[i], moving++);
        if (t == NULL || !add_point(t, time, oldest, (render_vec){ rows[i].x, rows[i].y })) {
            return false;
        }
        t->seen = true;
    }
    return count >= 0;
}

/// Where a trail that goes on at the other edge of the world is cut.
static size_t end_of_part(const trail_set *set, const struct trail *t, size_t from)
{
    size_t k = from + 1;
    for (; k < t->count; k++) {
        double dx = fabs(t->points[k].x - t->points[k - 1].x);
        double dy = fabs(t->points[k].y - t->points[k - 1].y);
        if ((set->wrap_x > 0 && dx > set->wrap_x / 2) ||
            (set->wrap_y > 0 && dy > set->wrap_y / 2)) {
            break;
        }
    }
    return k;
}

void trail_draw(const trail_set *set, render_frame *frame)
{
    for (int i = 0; i < set->count; i++) {
        const struct trail *t = &set->items[i];
        for (size_t from = t->first, to; t->seen && from < t->count; from = to) {
            to = end_of_part(set, t, from);
            if (to - from >= 2) {
                render_add_trail(frame, t->points + from, to - from, t->color);
            }
        }
    }
}

void trail_free(trail_set *set)
{
    for (int i = 0; i < set->count; i++) {
        free(set->items[i].points);
        free(set->items[i].times);
    }
    free(set->items);
    *set = (trail_set){ .seconds = set->seconds };
}
