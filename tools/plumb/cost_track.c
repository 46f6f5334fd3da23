/// cost_track.c - where bodies were at some moments of a run, and how far two runs are apart.
///
/// Reads a session; owns its lists. Cost: O(bodies) a moment as long as both runs have the same bodies.
#include "cost.h"

#include <math.h>
#include <stdlib.h>

/// A body at a moment, found again by its name.
struct point {
    unsigned long long name; ///< hash
    double x, y;             ///< [m]
};

struct cost_track {
    struct point *points; ///< all moments one after another
    size_t count, room;   ///< of points
    size_t *ends;         ///< of each moment in `points`
    int moments, moment_room;
};

/// FNV-1a, 64 bits: http://www.isthe.com/chongo/tech/comp/fnv/
static unsigned long long hash_name(const char *name)
{
    unsigned long long hash = 14695981039346656037ull;
    for (; *name != '\0'; name++) {
        hash = (hash ^ (unsigned char)*name) * 1099511628211ull;
    }
    return hash;
}

cost_track *cost_track_new(void)
{
    return calloc(1, sizeof(cost_track));
}

void cost_track_free(cost_track *track)
{
    if (track != NULL) {
        free(track->points);
        free(track->ends);
        free(track);
    }
}

int cost_track_moments(const cost_track *track)
{
    return track->moments;
}

static bool reserve(cost_track *track, size_t count)
{
    if (track->count + count > track->room) {
        size_t room = 2 * (track->count + count);
        struct point *grown = realloc(track->points, room * sizeof *grown);
        if (grown == NULL) {
            return false;
        }
        track->points = grown;
        track->room = room;
    }
    if (track->moments == track->moment_room) {
        int room = 2 * track->moment_room + 64;
        size_t *grown = realloc(track->ends, (size_t)room * sizeof *grown);
        if (grown == NULL) {
            return false;
        }
        track->ends = grown;
        track->moment_room = room;
    }
    return true;
}

bool cost_track_add(cost_track *track, const scene_run *run)
{
    const engine_row *rows = NULL;
    int count = run != NULL ? run->engine->rows(run->stage, &rows) : 0;
    if (count < 0 || !reserve(track, (size_t)count)) {
        return false;
    }
    for (int i = 0; i < count; i++) {
        if (rows[i].moves) {
            track->points[track->count++] =
                (struct point){ hash_name(rows[i].name), rows[i].x, rows[i].y };
        }
    }
    track->ends[track->moments++] = track->count;
    return true;
}

/// Distance of two moments of two tracks; see cost.h.
static double distance_of(const cost_track *a, int moment_a, const cost_track *b, int moment_b)
{
    double worst = -1;
    if (moment_a >= a->moments || moment_b >= b->moments) {
        return worst;
    }
    size_t a_begin = moment_a > 0 ? a->ends[moment_a - 1] : 0;
    size_t b_begin = moment_b > 0 ? b->ends[moment_b - 1] : 0;
    size_t b_count = b->ends[moment_b] - b_begin;
    for (size_t i = a_begin; i < a->ends[moment_a]; i++) {
        // Bodies come in the same order; the search goes far only after one has vanished.
        for (size_t k = 0; k < b_count; k++) {
            const struct point *p = &a->points[i];
            const struct point *q = &b->points[b_begin + (i - a_begin + k) % b_count];
            if (p->name == q->name) {
                worst = fmax(worst, hypot(p->x - q->x, p->y - q->y));
                break;
            }
        }
    }
    return worst;
}

double cost_track_distance(const cost_track *a, const cost_track *b, int moment)
{
    return distance_of(a, moment, b, moment);
}

double cost_track_way(const cost_track *track)
{
    double way = 0;
    for (int m = 1; m < track->moments; m++) {
        way = fmax(way, distance_of(track, m, track, 0));
    }
    return way;
}
