// mesh.c - an outline filled with nodes and triangles: nodes along it and on a lattice within, Delaunay's triangulation of
// them, a node after the other.
//
// Cost: O(nodes^2).
#include "geometry/mesh.h"

#include "plumb/geometry.h"

#include <math.h>
#include <string.h>

typedef struct outline {
    const plumb_vec2 *points;
    int count;
} outline;

static bool add_node(pl_mesh *m, double x, double y)
{
    if (m->nodes == PL_MESH_MOST) {
        return false;
    }
    m->x[m->nodes] = x, m->y[m->nodes++] = y;
    return true;
}

static bool line_rim(pl_mesh *m, const outline *d)
{
    for (int i = 0; i < d->count; ++i) {
        const plumb_vec2 p = d->points[i], q = d->points[(i + 1) % d->count];
        const double x = (double)q.x - (double)p.x, y = (double)q.y - (double)p.y;
        const double parts = floor(sqrt(x * x + y * y) / m->spacing + 0.5);
        const int n = parts < 1 ? 1 : parts > PL_MESH_MOST ? PL_MESH_MOST : (int)parts;
        for (int k = 0; k < n; ++k) {
            if (!add_node(m, (double)p.x - (double)d->points[0].x + x * k / n,
                          (double)p.y - (double)d->points[0].y + y * k / n)) {
                return false;
            }
        }
    }
    m->rim = m->nodes;
    return true;
}

// [m] to the nearest node of the rim.
static bool is_clear(const pl_mesh *m, double x, double y)
{
    for (int i = 0; i < m->rim; ++i) {
        const double dx = m->x[i] - x, dy = m->y[i] - y;
        if (dx * dx + dy * dy < 0.45 * m->spacing * m->spacing) {
            return false;
        }
    }
    return true;
}

static bool fill(pl_mesh *m, const outline *d, const double box[4])
{
    const double up = m->spacing * 0.8660254037844386;
    const double columns = (box[2] - box[0]) / m->spacing, rows = (box[3] - box[1]) / up;
    if (columns * rows > 4.0 * PL_MESH_MOST) {
        return false;
    }
    for (int j = 1; j < rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            const double x = box[0] + (i + (j % 2 != 0 ? 0.5 : 0)) * m->spacing;
            const double y = box[1] + j * up;
            const plumb_vec2 at = { (plumb_real)(x + (double)d->points[0].x),
                                    (plumb_real)(y + (double)d->points[0].y) };
            if (plumb_outline_contains(d->points, d->count, at) && is_clear(m, x, y) &&
                !add_node(m, x, y)) {
                return false;
            }
        }
    }
    return true;
}

// Whether a node lies in the circle round a triangle. Places are shifted a little, each by its number, so that no four lie
// on one circle.
static void shifted(const pl_mesh *m, int i, double out[2])
{
    const uint32_t h = ((uint32_t)i + 1) * UINT32_C(2654435761);
    out[0] = m->x[i] + m->spacing * 1e-4 * ((double)(h >> 16) / 65536 - 0.5);
    out[1] = m->y[i] + m->spacing * 1e-4 * ((double)(h & 0xffff) / 65536 - 0.5);
}

static bool is_in_circle(const pl_mesh *m, const int corner[3], int node)
{
    double p[2], q[3][2], s[3];
    shifted(m, node, p);
    for (int i = 0; i < 3; ++i) {
        shifted(m, corner[i], q[i]);
        q[i][0] -= p[0], q[i][1] -= p[1];
        s[i] = q[i][0] * q[i][0] + q[i][1] * q[i][1];
    }
    return s[0] * (q[1][0] * q[2][1] - q[1][1] * q[2][0]) -
               s[1] * (q[0][0] * q[2][1] - q[0][1] * q[2][0]) +
               s[2] * (q[0][0] * q[1][1] - q[0][1] * q[1][0]) >
           0;
}

// Takes out the triangles whose circles have the node in them, and joins it to the edge of the hole (Bowyer 1981, Watson
// 1981).
static void insert(pl_mesh *m, int node)
{
    int edges = 0, kept = 0;
    for (int t = 0; t < m->triangles; ++t) {
        if (!is_in_circle(m, m->corner[t], node)) {
            memmove(m->corner[kept++], m->corner[t], sizeof m->corner[t]);
            continue;
        }
        for (int k = 0; k < 3; ++k) {
            const int a = m->corner[t][k], b = m->corner[t][(k + 1) % 3];
            int twin = -1;
            for (int e = 0; e < edges && twin < 0; ++e) {
                twin = m->edge[e][0] == b && m->edge[e][1] == a ? e : -1;
            }
            if (twin >= 0) {
                m->edge[twin][0] = m->edge[--edges][0], m->edge[twin][1] = m->edge[edges][1];
            } else {
                m->edge[edges][0] = a, m->edge[edges++][1] = b;
            }
        }
    }
    for (int e = 0; e < edges; ++e) {
        m->corner[kept][0] = m->edge[e][0], m->corner[kept][1] = m->edge[e][1];
        m->corner[kept++][2] = node;
    }
    m->triangles = kept;
}

// What lies outside of the outline goes, and what has no area.
static void trim(pl_mesh *m, const outline *d)
{
    int kept = 0;
    for (int t = 0; t < m->triangles; ++t) {
        const int *c = m->corner[t];
        if (c[0] >= m->nodes || c[1] >= m->nodes || c[2] >= m->nodes) {
            continue;
        }
        const double x = (m->x[c[0]] + m->x[c[1]] + m->x[c[2]]) / 3 + (double)d->points[0].x;
        const double y = (m->y[c[0]] + m->y[c[1]] + m->y[c[2]]) / 3 + (double)d->points[0].y;
        const double area = (m->x[c[1]] - m->x[c[0]]) * (m->y[c[2]] - m->y[c[0]]) -
                            (m->y[c[1]] - m->y[c[0]]) * (m->x[c[2]] - m->x[c[0]]);
        if (area > 1e-3 * m->spacing * m->spacing &&
            plumb_outline_contains(d->points, d->count,
                                   (plumb_vec2){ (plumb_real)x, (plumb_real)y })) {
            memmove(m->corner[kept++], m->corner[t], sizeof m->corner[t]);
        }
    }
    m->triangles = kept;
}

bool pl_mesh_fill(pl_mesh *m, const plumb_vec2 *points, int count, double spacing)
{
    const outline within = { points, count };
    double box[4] = { INFINITY, INFINITY, -INFINITY, -INFINITY };
    for (int i = 0; i < count; ++i) {
        const double x = (double)points[i].x - (double)points[0].x;
        const double y = (double)points[i].y - (double)points[0].y;
        box[0] = x < box[0] ? x : box[0], box[1] = y < box[1] ? y : box[1];
        box[2] = x > box[2] ? x : box[2], box[3] = y > box[3] ? y : box[3];
    }
    const double w = box[2] - box[0], h = box[3] - box[1], side = w > h ? w : h;
    m->spacing = spacing > 0 ? spacing : side / 10;
    m->nodes = m->rim = m->triangles = 0;
    if (!line_rim(m, &within) || !fill(m, &within, box)) {
        return false;
    }
    for (int k = 0; k < 3; ++k) { // around all of it
        static const double far[3][2] = { { -50, -30 }, { 50, -30 }, { 0, 60 } };
        m->x[m->nodes + k] = box[0] + w / 2 + side * far[k][0];
        m->y[m->nodes + k] = box[1] + h / 2 + side * far[k][1];
        m->corner[0][k] = m->nodes + k;
    }
    m->triangles = 1;
    for (int i = 0; i < m->nodes; ++i) {
        insert(m, i);
    }
    trim(m, &within);
    return m->triangles > 0;
}
