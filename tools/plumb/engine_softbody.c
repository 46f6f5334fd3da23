/// engine_softbody.c - soft bodies as parts of a draw list: sheets of triangles filled, gas within its skin, threads as thick
/// as their nodes are. Compiled once for each precision, as engine.c.
///
/// Reads the world and what the scene says of colours, writes a render_frame. Cost: O(nodes + elements), for rings O(n^2).
#include "engine_session.h"

#include <math.h>
#include <stdlib.h>

#include "../render/render.h"

#define THREAD 0.3 ///< how thick threads of a net are drawn, of the radius of its nodes

static render_vec place_of(const plumb_softbody_desc *d, uint32_t node)
{
    const plumb_softbody_node *n = &d->nodes[node];
    return (render_vec){ (double)n->position.x + (double)n->position_rest.x,
                         (double)n->position.y + (double)n->position_rest.y };
}

// ---- filled

/// Contacts are with circles at the nodes of the surface: it is as far out as they are.
static void add_side(const plumb_softbody_desc *d, uint32_t a, uint32_t b, render_frame *frame)
{
    const double r = (double)plumb_min(d->nodes[a].radius, d->nodes[b].radius);
    const render_vec from = place_of(d, a), to = place_of(d, b);
    if (r > 0) {
        render_add_capsule(frame, from.x, from.y, to.x, to.y, r);
    }
}

static void add_triangles(const plumb_softbody_desc *d, render_frame *frame, const render_style *s)
{
    render_body_begin(frame, s);
    for (int i = 0; i < d->triangle_count; i++) {
        const plumb_softbody_triangle *t = &d->triangles[i];
        const render_vec p[3] = { place_of(d, t->a), place_of(d, t->b), place_of(d, t->c) };
        render_add_polygon(frame, p, 3, 0);
        add_side(d, t->a, t->b, frame);
        add_side(d, t->b, t->c, frame);
        add_side(d, t->c, t->a, frame);
    }
    render_body_end(frame);
}

static double turn(render_vec a, render_vec b, render_vec c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static bool is_ear(const render_vec *p, int count, int i)
{
    const int before = (i + count - 1) % count, after = (i + 1) % count;
    const render_vec a = p[before], b = p[i], c = p[after];
    if (turn(a, b, c) <= 0) {
        return false;
    }
    for (int k = 0; k < count; k++) {
        if (k != before && k != i && k != after && turn(a, b, p[k]) >= 0 && turn(b, c, p[k]) >= 0 &&
            turn(c, a, p[k]) >= 0) {
            return false;
        }
    }
    return true;
}

/// What the ring is round, cut into triangles ear by ear (Meisters 1975); what crosses itself is left in part.
static bool add_gas(const plumb_softbody_desc *d, render_frame *frame, const render_style *s)
{
    int count = d->ring_count;
    render_vec *p = malloc((size_t)(count > 0 ? count : 1) * sizeof *p);
    if (p == NULL) {
        return false;
    }
    for (int i = 0; i < count; i++) {
        p[i] = place_of(d, d->ring[i]);
    }
    render_body_begin(frame, s);
    for (int i = 0, tried = 0; count >= 3 && tried < count;) {
        i = i % count;
        if (!is_ear(p, count, i)) {
            i++, tried++;
            continue;
        }
        const render_vec ear[3] = { p[(i + count - 1) % count], p[i], p[(i + 1) % count] };
        render_add_polygon(frame, ear, 3, 0);
        for (int k = i + 1; k < count; k++) {
            p[k - 1] = p[k];
        }
        count--, tried = 0;
    }
    render_body_end(frame);
    free(p);
    return true;
}

// ---- threads

typedef struct threads {
    const plumb_softbody_desc *d;
    const render_style *style;
    double least, share; ///< stiffness below which a thread is not drawn; of the radius
    render_vec *points;
} threads;

static bool is_drawn(const threads *t, const plumb_softbody_edge *e)
{
    return (e->flags & PLUMB_EDGE_TORN) == 0 && (double)e->stiffness >= t->least;
}

/// A run of edges each of which begins where the last one ended, as one line.
static int add_run(const threads *t, int first, render_frame *frame)
{
    const plumb_softbody_edge *e = t->d->edges;
    size_t count = 0;
    int i = first;
    t->points[count++] = place_of(t->d, e[first].a);
    do {
        t->points[count++] = place_of(t->d, e[i].b);
        i++;
    } while (i < t->d->edge_count && is_drawn(t, &e[i]) && e[i].a == e[i - 1].b);
    const double radius = t->share * (double)t->d->nodes[e[first].a].radius;
    const bool closed = count > 3 && e[i - 1].b == e[first].a;
    render_add_polyline(frame, t->points, closed ? count - 1 : count, radius,
                        closed ? RENDER_LINE_CLOSED : 0);
    return i;
}

static bool add_threads(threads *t, render_frame *frame)
{
    t->points = malloc((size_t)(t->d->edge_count + 1) * sizeof *t->points);
    if (t->points == NULL) {
        return false;
    }
    for (int i = 0; i < t->d->edge_count; i++) {
        const double k = (double)t->d->edges[i].stiffness;
        t->least = 0.3 * k > t->least ? 0.3 * k : t->least; // diagonals only hold the shape
    }
    render_body_begin(frame, t->style);
    for (int i = 0; i < t->d->edge_count;) {
        i = is_drawn(t, &t->d->edges[i]) ? add_run(t, i, frame) : i + 1;
    }
    render_body_end(frame);
    free(t->points);
    return true;
}

/// Whether nodes have more than two edges: a net, not a rope.
static bool is_net(const plumb_softbody_desc *d)
{
    return d->edge_count > d->node_count;
}

static render_style style_of(const engine_stage *stage, plumb_softbody body, int index)
{
    render_style s = { .palette = index + 3 };
    if (stage->scene != NULL) {
        const scene_softbody looks = scene_get_softbody(stage->scene, body);
        s.palette = looks.palette >= 0 ? looks.palette : s.palette;
        s.color = (render_rgba){ looks.color.r, looks.color.g, looks.color.b,
                                 looks.palette < 0 ? looks.color.a : 0 };
    }
    return s;
}

static bool add_one(const engine_stage *stage, plumb_softbody body, int index, render_frame *frame)
{
    plumb_softbody_desc d;
    if (plumb_softbody_settings(stage->world, body, &d) != PLUMB_OK) {
        return true;
    }
    render_style own = style_of(stage, body, index);
    own.kind = d.asleep ? RENDER_ASLEEP : own.kind;
    render_style gas = own;
    gas.color = own.color.a > 0 ? own.color : render_palette(own.palette);
    gas.color.a = 0x50;
    bool good = true;
    if (d.triangle_count > 0) {
        add_triangles(&d, frame, &own);
    }
    if (d.ring_count > 0 && d.pressure > 0) {
        good = add_gas(&d, frame, &gas);
    }
    if (d.edge_count > 0 && good) {
        good = add_threads(&(threads){ .d = &d, .style = &own, .share = is_net(&d) ? THREAD : 1 },
                           frame);
    }
    return good;
}

plumb_aabb pl_stage_softbody_box(const engine_stage *stage, plumb_softbody body)
{
    plumb_softbody_desc d = { 0 };
    plumb_aabb box = { { 0, 0 }, { 0, 0 } };
    plumb_softbody_settings(stage->world, body, &d);
    for (int i = 0; i < d.node_count; i++) {
        const plumb_vec2 p = d.nodes[i].position;
        const plumb_real r = d.nodes[i].radius;
        box.min.x = i == 0 || p.x - r < box.min.x ? p.x - r : box.min.x;
        box.min.y = i == 0 || p.y - r < box.min.y ? p.y - r : box.min.y;
        box.max.x = i == 0 || p.x + r > box.max.x ? p.x + r : box.max.x;
        box.max.y = i == 0 || p.y + r > box.max.y ? p.y + r : box.max.y;
    }
    return box;
}

plumb_softbody *pl_stage_softbodies(const engine_stage *stage, int *count)
{
    *count = plumb_world_softbodies(stage->world, NULL, 0);
    plumb_softbody *all = malloc(((size_t)*count + 1) * sizeof *all);
    if (all != NULL) {
        plumb_world_softbodies(stage->world, all, *count);
    }
    return all;
}

bool pl_stage_add_softbodies(const engine_stage *stage, struct render_frame *frame)
{
    int count;
    plumb_softbody *all = pl_stage_softbodies(stage, &count);
    bool good = all != NULL;
    for (int i = 0; i < count && good; i++) {
        good = add_one(stage, all[i], i, frame);
    }
    free(all);
    return good;
}
