// decompose.c - splits a simple outline into convex pieces, with its own vertices only.
//
// 1. The outline is simplified and checked (outline.c). From here on it is strictly simple, and
//    every orientation sign is exact.
// 2. Ear clipping: a corner whose triangle holds no other vertex, not even on its edge, is cut
//    off. Every simple polygon has two (G. H. Meisters, "Polygons have ears", 1975), so this ends
//    after n - 2 triangles. Of the ears at hand the best-shaped goes first, to avoid slivers.
// 3. Merging: a diagonal is removed if what it separates is convex together (S. Hertel and
//    K. Mehlhorn, "Fast triangulation of simple polygons", 1983), longest first, since long
//    diagonals are the sides of slivers. At most four times the fewest pieces possible.
//
// Reads: the outline. Writes: the pieces. Cost: O(n^3) at worst; random outlines of 64 vertices
// take 0.13 ms, of 256 3.3 ms. 14 KiB of stack (16 in double).

#include "core/try.h"
#include "geometry/exact.h"

#include <string.h>

#define MAX_TRIANGLES (PLUMB_OUTLINE_MAX_VERTICES - 2)

// A convex part as indices of outline vertices, counter-clockwise; count 0 once merged away.
typedef struct part {
    uint8_t vertices[PLUMB_POLYGON_MAX_VERTICES];
    int count;
} part;

_Static_assert(PLUMB_OUTLINE_MAX_VERTICES <= UINT8_MAX + 1, "a vertex index must fit a byte");

// A diagonal that triangulation has made.
typedef struct diagonal {
    uint8_t a;
    uint8_t b;
    double length;
} diagonal;

// What is left of the outline while ears are cut off: a closed list.
typedef struct ring {
    const plumb_vec2 *points;
    uint8_t before[PLUMB_OUTLINE_MAX_VERTICES];
    uint8_t after[PLUMB_OUTLINE_MAX_VERTICES];
    int first;
    int count;
} ring;

// Shape of the triangle at a corner: area over squared edge lengths, the larger the fatter; not
// positive when the corner is straight or points inwards.
static double ear_shape(const ring *r, int i)
{
    plumb_vec2 a = r->points[r->before[i]];
    plumb_vec2 b = r->points[i];
    plumb_vec2 c = r->points[r->after[i]];
    double ab = pl_distance(a, b);
    double bc = pl_distance(b, c);
    double ca = pl_distance(c, a);
    return pl_orient(a, b, c) / (ab * ab + bc * bc + ca * ca);
}

// Whether no other vertex of the ring lies in the corner's triangle or on its edges.
static bool is_ear(const ring *r, int i)
{
    int before = r->before[i];
    int after = r->after[i];
    plumb_vec2 a = r->points[before];
    plumb_vec2 b = r->points[i];
    plumb_vec2 c = r->points[after];
    for (int k = r->after[after]; k != before; k = r->after[k]) {
        plumb_vec2 p = r->points[k];
        if (pl_orient(c, a, p) >= 0 && pl_orient(a, b, p) >= 0 && pl_orient(b, c, p) >= 0) {
            return false;
        }
    }
    return true;
}

// The best-shaped ear, or -1 when there is none (only if orientation signs were wrong).
static int best_ear(const ring *r, const double *shapes)
{
    int best = -1;
    double best_shape = 0;
    int i = r->first;
    for (int k = 0; k < r->count; k++, i = r->after[i]) {
        if (shapes[i] > best_shape && is_ear(r, i)) {
            best_shape = shapes[i];
            best = i;
        }
    }
    return best;
}

// Cuts the ring into triangles. False when it does not come out.
static bool triangulate(const plumb_vec2 *points, int count, part *parts, diagonal *diagonals)
{
    ring r;
    double shapes[PLUMB_OUTLINE_MAX_VERTICES];
    r.points = points;
    r.first = 0;
    r.count = count;
    for (int i = 0; i < count; i++) {
        r.before[i] = (uint8_t)(i == 0 ? count - 1 : i - 1);
        r.after[i] = (uint8_t)(i + 1 == count ? 0 : i + 1);
    }
    for (int i = 0; i < count; i++) {
        shapes[i] = ear_shape(&r, i);
    }
    for (int n = 0; n < count - 2; n++) {
        int ear = best_ear(&r, shapes);
        if (ear < 0) {
            return false;
        }
        uint8_t a = r.before[ear];
        uint8_t c = r.after[ear];
        parts[n].vertices[0] = a;
        parts[n].vertices[1] = (uint8_t)ear;
        parts[n].vertices[2] = c;
        parts[n].count = 3;
        if (n < count - 3) { // the last triangle is what is left, not cut off
            diagonals[n].a = a;
            diagonals[n].b = c;
            diagonals[n].length = pl_distance(points[a], points[c]);
        }
        r.after[a] = c;
        r.before[c] = a;
        r.first = a;
        r.count--;
        shapes[a] = ear_shape(&r, a);
        shapes[c] = ear_shape(&r, c);
    }
    return true;
}

// Longest first; equal ones in the order made, so that the result is the same everywhere.
static void sort_diagonals(diagonal *diagonals, int count)
{
    for (int i = 1; i < count; i++) {
        diagonal d = diagonals[i];
        int k = i;
        for (; k > 0 && diagonals[k - 1].length < d.length; k--) {
            diagonals[k] = diagonals[k - 1];
        }
        diagonals[k] = d;
    }
}

// The part with the edge from a to b, and where in it a is.
static part *find_edge(part *parts, int count, uint8_t a, uint8_t b, int *at)
{
    for (int i = 0; i < count; i++) {
        part *p = &parts[i];
        for (int k = 0; k < p->count; k++) {
            if (p->vertices[k] == a && p->vertices[k + 1 == p->count ? 0 : k + 1] == b) {
                *at = k;
                return p;
            }
        }
    }
    return NULL;
}

// Merges the parts on both sides of a diagonal if the result is convex and not too large.
static void merge_across(const plumb_vec2 *points, part *parts, int count, diagonal d)
{
    int at_p = 0;
    int at_q = 0;
    part *p = find_edge(parts, count, d.a, d.b, &at_p);
    part *q = find_edge(parts, count, d.b, d.a, &at_q);
    if (p == NULL || q == NULL || p->count + q->count - 2 > PLUMB_POLYGON_MAX_VERTICES) {
        return;
    }
    // Once around: b, the rest of p, a, the rest of q.
    part merged = { .count = 0 };
    for (int k = 1; k < p->count; k++) {
        merged.vertices[merged.count++] = p->vertices[(at_p + k) % p->count];
    }
    int a = merged.count;
    for (int k = 1; k < q->count; k++) {
        merged.vertices[merged.count++] = q->vertices[(at_q + k) % q->count];
    }
    const uint8_t *v = merged.vertices;
    int last = merged.count - 1;
    if (pl_orient(points[v[a - 1]], points[v[a]], points[v[a + 1]]) < 0 ||
        pl_orient(points[v[last]], points[v[0]], points[v[1]]) < 0) {
        return;
    }
    *p = merged;
    q->count = 0;
}

// A part as a piece, without vertices in line.
static plumb_convex_piece piece_of(const plumb_vec2 *points, const part *p)
{
    plumb_convex_piece piece;
    memset(&piece, 0, sizeof piece);
    for (int k = 0; k < p->count; k++) {
        plumb_vec2 a = points[p->vertices[k == 0 ? p->count - 1 : k - 1]];
        plumb_vec2 b = points[p->vertices[k]];
        plumb_vec2 c = points[p->vertices[k + 1 == p->count ? 0 : k + 1]];
        if (pl_orient(a, b, c) > 0) {
            piece.vertices[piece.count++] = b;
        }
    }
    return piece;
}

plumb_result plumb_outline_decompose(const plumb_vec2 *points, int count,
                                     plumb_convex_piece *pieces, int capacity, int *piece_count)
{
    if (pieces == NULL || piece_count == NULL) {
        return PLUMB_E_NULL;
    }
    PL_TRY(pl_points_check(points, count));
    plumb_vec2 simple[PLUMB_OUTLINE_MAX_VERTICES];
    part parts[MAX_TRIANGLES];
    diagonal diagonals[MAX_TRIANGLES];
    int n = pl_outline_simplify(points, count, simple);
    if (n < 3 || !triangulate(simple, n, parts, diagonals)) {
        return PLUMB_E_GEOMETRY;
    }
    sort_diagonals(diagonals, n - 3);
    for (int i = 0; i < n - 3; i++) {
        merge_across(simple, parts, n - 2, diagonals[i]);
    }
    int needed = 0;
    for (int i = 0; i < n - 2; i++) {
        needed += parts[i].count > 0;
    }
    *piece_count = needed;
    if (needed > capacity) {
        return PLUMB_E_CAPACITY;
    }
    int made = 0;
    for (int i = 0; i < n - 2; i++) {
        if (parts[i].count > 0) {
            pieces[made++] = piece_of(simple, &parts[i]);
        }
    }
    return PLUMB_OK;
}
