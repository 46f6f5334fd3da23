// softbody_make.c - ropes, cloth, jelly, skins: descriptors of soft bodies, made from a few numbers.
//
// Reads: arguments, checked first. Writes: the list of soft bodies (softbody.c). Cost: O(nodes); jelly O(nodes^2), its
// triangles are found one node after the other.
#include "core/memory.h"
#include "geometry/mesh.h"
#include "math/trig.h"
#include "plumb/softbody.h"
#include "world/check.h"
#include "world/state.h"

#include <math.h>
#include <string.h>

#define FAR  ((real)1e9)
#define MOST ((real)1e15)
#define PI   3.14159265358979323846

static plumb_softbody none(void)
{
    return (plumb_softbody)PLUMB_NULL_INIT;
}

static real or_else(real value, double otherwise)
{
    return value == 0 ? (real)otherwise : value < 0 ? 0 : value;
}

// Room for what is made, in one piece.
typedef struct draft {
    pl_buffer room;
    plumb_softbody_node *nodes;
    plumb_softbody_edge *edges;
    plumb_softbody_bend *bends;
    plumb_softbody_triangle *triangles;
    uint32_t *ring;
    plumb_softbody_pin *pins;
    plumb_softbody_desc desc;
} draft;

static bool reserve(plumb_world *world, const char *fn, draft *d, size_t nodes, size_t edges,
                    size_t bends, size_t triangles, size_t pins)
{
    memset(d, 0, sizeof *d);
    const size_t bytes = nodes * (sizeof *d->nodes + sizeof *d->ring) + edges * sizeof *d->edges +
                         bends * sizeof *d->bends + triangles * sizeof *d->triangles +
                         pins * sizeof *d->pins + 64;
    if (!pl_buffer_reserve(&world->memory, &d->room, bytes)) {
        pl_fail_memory(world, fn);
        return false;
    }
    memset(d->room.data, 0, bytes);
    d->nodes = d->room.data;
    d->edges = (plumb_softbody_edge *)(void *)(d->nodes + nodes);
    d->bends = (plumb_softbody_bend *)(void *)(d->edges + edges);
    d->triangles = (plumb_softbody_triangle *)(void *)(d->bends + bends);
    d->pins = (plumb_softbody_pin *)(void *)(d->triangles + triangles);
    d->ring = (uint32_t *)(void *)(d->pins + pins);
    return true;
}

static plumb_softbody finish(plumb_world *world, draft *d)
{
    d->desc.nodes = d->nodes, d->desc.edges = d->edges, d->desc.bends = d->bends;
    d->desc.triangles = d->triangles, d->desc.ring = d->ring, d->desc.pins = d->pins;
    const plumb_softbody made = plumb_softbody_create(world, &d->desc);
    pl_buffer_free(&world->memory, &d->room);
    return made;
}

typedef struct number {
    const char *name;
    real value, low, high;
} number;

static plumb_result check_numbers(const plumb_world *world, const char *fn, const number *n,
                                  size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        PL_TRY(pl_check_range(world, fn, n[i].name, n[i].value, n[i].low, n[i].high));
    }
    return PLUMB_OK;
}

static plumb_result check_count(const plumb_world *world, const char *fn, const char *what,
                                int count, int least, int most)
{
    return count >= least && count <= most
               ? PLUMB_OK
               : pl_fail(world, PLUMB_E_RANGE, fn, "%s is %d; it must be %d to %d", what, count,
                         least, most);
}

#define COUNT(list) (sizeof(list) / sizeof *(list))

//---- ropes ---------------------------------------------------------------------------------------

#define ROPE_NODES 24

static plumb_result check_rope(const plumb_world *world, const char *fn, const plumb_rope_desc *d)
{
    const number n[] = { { "length", d->length, 0, (real)1e6 },
                         { "mass", d->mass, 0, FAR },
                         { "stiffness", d->stiffness, 0, MOST },
                         { "damping", d->damping, 0, MOST },
                         { "bending", d->bending, 0, MOST },
                         { "radius", d->radius, 0, (real)1e6 },
                         { "drag", d->drag, 0, (real)1e6 },
                         { "friction", d->friction, -1, 1000 },
                         { "break_strain", d->break_strain, 0, (real)1e6 },
                         { "yield_strain", d->yield_strain, 0, (real)1e6 } };
    PL_TRY(pl_check_within(world, fn, "from", d->from, FAR));
    PL_TRY(pl_check_within(world, fn, "to", d->to, FAR));
    PL_TRY(check_count(world, fn, "nodes", d->nodes == 0 ? ROPE_NODES : d->nodes, 2, 10000));
    PL_TRY(check_numbers(world, fn, n, COUNT(n)));
    if (d->from.x == d->to.x && d->from.y == d->to.y) {
        return pl_fail(world, PLUMB_E_RANGE, fn, "from and to are the same place; they must not");
    }
    uint32_t row;
    if (!plumb_is_null(d->from_body)) {
        PL_TRY(pl_check_body(world, fn, d->from_body, &row));
    }
    return plumb_is_null(d->to_body) ? PLUMB_OK : pl_check_body(world, fn, d->to_body, &row);
}

// Half the angle of the arc of which a chord is `part`, 0..1, of the length: sin(x) / x = part. By bisection.
static double half_arc(double part)
{
    double low = 0, high = PI;
    for (int i = 0; i < 60; ++i) {
        const double x = (low + high) / 2;
        double s, c;
        pl_sincos(x, &s, &c);
        if (s > part * x) {
            low = x;
        } else {
            high = x;
        }
    }
    return (low + high) / 2;
}

// Evenly along a straight line, or along an arc of the right length that hangs down.
static void lay_rope(const plumb_world *world, const plumb_rope_desc *d, draft *to, int nodes,
                     double length)
{
    const double x = (double)d->to.x - (double)d->from.x, y = (double)d->to.y - (double)d->from.y;
    const double chord = sqrt(x * x + y * y), part = chord / length;
    const double half = part < 1 - 1e-9 ? half_arc(part) : 0;
    const double g = (double)world->gravity.x * -y + (double)world->gravity.y * x;
    const double side = g >= 0 ? 1 : -1; // to the left of the way, or the right
    double s0, c0;
    pl_sincos(half, &s0, &c0);
    const double radius = half > 0 ? chord / 2 / s0 : 0;
    for (int i = 0; i < nodes; ++i) {
        const double t = (double)i / (nodes - 1);
        double along = t, out = 0, s, c;
        if (half > 0) {
            pl_sincos(half * (2 * t - 1), &s, &c);
            along = 0.5 + radius * s / chord;
            out = side * radius * (c - c0) / chord;
        }
        to->nodes[i].position = (plumb_vec2){ (real)((double)d->from.x + along * x - out * y),
                                              (real)((double)d->from.y + along * y + out * x) };
    }
    to->nodes[0].position = d->from;
    to->nodes[nodes - 1].position = d->to;
}

static void pin_end(const plumb_world *world, draft *to, uint32_t node, plumb_body body, bool holds)
{
    const bool is_null = plumb_is_null(body);
    if (is_null && !holds) {
        return;
    }
    const plumb_vec2 at = to->nodes[node].position;
    plumb_softbody_pin *pin = &to->pins[to->desc.pin_count++];
    pin->node = node;
    pin->body = body;
    pin->point = at;
    const uint32_t row = is_null ? PL_NONE : pl_body_row(world, body);
    if (row != PL_NONE) {
        const pl_bodies *b = &world->bodies;
        const double x = (double)at.x - (double)b->x[row], y = (double)at.y - (double)b->y[row];
        const double c = (double)b->c[row], s = (double)b->s[row];
        pin->point = (plumb_vec2){ (real)(c * x + s * y), (real)(c * y - s * x) };
    }
}

plumb_softbody plumb_rope_create(plumb_world *world, const plumb_rope_desc *desc)
{
    draft to;
    if (world == NULL || pl_check_unlocked(world, __func__) != PLUMB_OK ||
        pl_check_pointer(world, __func__, "desc", desc) != PLUMB_OK ||
        check_rope(world, __func__, desc) != PLUMB_OK) {
        return none();
    }
    const int nodes = desc->nodes == 0 ? ROPE_NODES : desc->nodes, edges = nodes - 1;
    const double x = (double)desc->to.x - (double)desc->from.x;
    const double y = (double)desc->to.y - (double)desc->from.y, chord = sqrt(x * x + y * y);
    const double length = desc->length > 0 ? (double)desc->length : chord;
    const double mass = (double)or_else(desc->mass, length);
    const double stiff = (double)or_else(desc->stiffness, 1e4 * 9.81 * mass);
    if (!reserve(world, __func__, &to, (size_t)nodes, (size_t)edges, (size_t)nodes, 0, 2)) {
        return none();
    }
    lay_rope(world, desc, &to, nodes, length > chord ? length : chord);
    const double piece = length / edges;
    for (int i = 0; i < nodes; ++i) {
        const bool end = i == 0 || i == edges;
        to.nodes[i].mass = (real)(mass / edges * (end ? 0.5 : 1));
        to.nodes[i].radius = desc->radius > 0 ? desc->radius : (real)(piece / 2);
    }
    for (int i = 0; i < edges; ++i) {
        to.edges[i] = (plumb_softbody_edge){ .a = (uint32_t)i,
                                             .b = (uint32_t)i + 1,
                                             .flags = desc->pushes ? 0 : PLUMB_EDGE_PULLS,
                                             .length = (real)piece,
                                             .stiffness = (real)(stiff / piece),
                                             .damping = (real)((double)desc->damping / piece),
                                             .break_strain = desc->break_strain,
                                             .yield_strain = desc->yield_strain };
    }
    for (int i = 0; i + 2 < nodes && desc->bending > 0; ++i) {
        const uint32_t a = (uint32_t)i;
        to.bends[to.desc.bend_count++] = (plumb_softbody_bend){
            .a = a, .b = a + 1, .c = a + 2, .stiffness = desc->bending, .length = (real)piece
        };
    }
    pin_end(world, &to, 0, desc->from_body, desc->hold_from);
    pin_end(world, &to, (uint32_t)edges, desc->to_body, desc->hold_to);
    to.desc.node_count = nodes, to.desc.edge_count = edges;
    to.desc.friction = or_else(desc->friction, 0.5);
    to.desc.damping = desc->drag;
    to.desc.filter = desc->filter, to.desc.no_sleep = desc->no_sleep;
    return finish(world, &to);
}

//---- cloth ---------------------------------------------------------------------------------------

static plumb_result check_cloth(const plumb_world *world, const char *fn, const plumb_cloth_desc *d)
{
    const number n[] = {
        { "mass", d->mass, 0, FAR },           { "stiffness", d->stiffness, 0, MOST },
        { "shear", d->shear, -1, MOST },       { "damping", d->damping, 0, MOST },
        { "radius", d->radius, 0, (real)1e6 }, { "drag", d->drag, 0, (real)1e6 },
        { "friction", d->friction, -1, 1000 }, { "break_strain", d->break_strain, 0, (real)1e6 }
    };
    PL_TRY(pl_check_within(world, fn, "low", d->low, FAR));
    PL_TRY(pl_check_within(world, fn, "high", d->high, FAR));
    PL_TRY(check_count(world, fn, "columns", d->columns, 0, 300));
    PL_TRY(check_count(world, fn, "rows", d->rows, 0, 300));
    PL_TRY(check_numbers(world, fn, n, COUNT(n)));
    return d->low.x < d->high.x && d->low.y < d->high.y
               ? PLUMB_OK
               : pl_fail(world, PLUMB_E_RANGE, fn,
                         "low is (%g, %g); it must be below high (%g, %g)", (double)d->low.x,
                         (double)d->low.y, (double)d->high.x, (double)d->high.y);
}

// A lattice of meshes, of (columns + 1) (rows + 1) nodes by rows.
typedef struct lattice {
    int columns, rows;
    double width, height; // [m] of a mesh
} lattice;

static lattice lattice_of(const plumb_cloth_desc *d)
{
    const double w = (double)d->high.x - (double)d->low.x;
    const double h = (double)d->high.y - (double)d->low.y, side = (w > h ? w : h) / 16;
    const double across = w / side + 0.5, up = h / side + 0.5;
    const int columns = d->columns > 0 ? d->columns : across > 1 ? (int)across : 1;
    const int rows = d->rows > 0 ? d->rows : up > 1 ? (int)up : 1;
    return (lattice){ columns, rows, w / columns, h / rows };
}

static void add_thread(draft *to, const plumb_cloth_desc *d, int a, int b, double stiffness)
{
    if (stiffness > 0) {
        to->edges[to->desc.edge_count++] = (plumb_softbody_edge){ .a = (uint32_t)a,
                                                                  .b = (uint32_t)b,
                                                                  .flags = PLUMB_EDGE_PULLS,
                                                                  .stiffness = (real)stiffness,
                                                                  .damping = d->damping,
                                                                  .break_strain = d->break_strain };
    }
}

static void weave(draft *to, const plumb_cloth_desc *d, const lattice *l, double stiff,
                  double shear)
{
    const int across = l->columns + 1;
    const double x = l->width, y = l->height, square = x * x + y * y;
    for (int j = 0; j <= l->rows; ++j) {
        for (int i = 0; i <= l->columns; ++i) {
            const int at = j * across + i;
            // Of a thread: the width of sheet that it stands for; half of that along an edge.
            if (i < l->columns) {
                const double part = j == 0 || j == l->rows ? 0.5 : 1;
                add_thread(to, d, at, at + 1, stiff * y * part / x);
            }
            if (j < l->rows) {
                const double part = i == 0 || i == l->columns ? 0.5 : 1;
                add_thread(to, d, at, at + across, stiff * x * part / y);
            }
            if (i < l->columns && j < l->rows) {
                const double k = shear * square / (4 * x * y);
                add_thread(to, d, at, at + across + 1, k);
                add_thread(to, d, at + 1, at + across, k);
            }
        }
    }
}

plumb_softbody plumb_cloth_create(plumb_world *world, const plumb_cloth_desc *desc)
{
    draft to;
    if (world == NULL || pl_check_unlocked(world, __func__) != PLUMB_OK ||
        pl_check_pointer(world, __func__, "desc", desc) != PLUMB_OK ||
        check_cloth(world, __func__, desc) != PLUMB_OK) {
        return none();
    }
    const lattice l = lattice_of(desc);
    const int across = l.columns + 1, nodes = across * (l.rows + 1);
    const double width = l.width * l.columns, height = l.height * l.rows;
    const double mass = (double)or_else(desc->mass, width * height);
    const double stiff = (double)or_else(desc->stiffness, 1000 * 9.81 * mass / width);
    const double shear = (double)or_else(desc->shear, stiff / 10);
    if (!reserve(world, __func__, &to, (size_t)nodes, 4 * (size_t)nodes, 0, 0, (size_t)across)) {
        return none();
    }
    for (int k = 0; k < nodes; ++k) {
        const int i = k % across, j = k / across;
        const double part =
            (i == 0 || i == l.columns ? 0.5 : 1) * (j == 0 || j == l.rows ? 0.5 : 1);
        to.nodes[k].position = (plumb_vec2){ (real)((double)desc->low.x + i * l.width),
                                             (real)((double)desc->low.y + j * l.height) };
        to.nodes[k].mass = (real)(mass / (l.columns * l.rows) * part);
        to.nodes[k].radius =
            desc->radius > 0 ? desc->radius : (real)((l.width < l.height ? l.width : l.height) / 2);
    }
    weave(&to, desc, &l, stiff, shear);
    const int top = world->desc.y_axis == PLUMB_Y_DOWN ? 0 : l.rows * across;
    for (int i = 0; i < across && (desc->hold_top || desc->hold_corners); ++i) {
        if (desc->hold_top || i == 0 || i == l.columns) {
            pin_end(world, &to, (uint32_t)(top + i), (plumb_body)PLUMB_NULL_INIT, true);
        }
    }
    to.desc.node_count = nodes;
    to.desc.friction = or_else(desc->friction, 0.5);
    to.desc.damping = desc->drag;
    to.desc.filter = desc->filter, to.desc.no_sleep = desc->no_sleep;
    return finish(world, &to);
}

//---- skins ---------------------------------------------------------------------------------------

static plumb_result check_skin(const plumb_world *world, const char *fn, const plumb_skin_desc *d)
{
    const real gas = (real)1e12;
    const number n[] = {
        { "radius", d->radius, 0, (real)1e5 },  { "mass", d->mass, 0, FAR },
        { "stiffness", d->stiffness, 0, MOST }, { "damping", d->damping, 0, MOST },
        { "bending", d->bending, 0, MOST },     { "pressure", d->pressure, 0, gas },
        { "ambient", d->ambient, 0, gas },      { "drag", d->drag, 0, (real)1e6 },
        { "friction", d->friction, -1, 1000 },  { "break_strain", d->break_strain, 0, (real)1e6 }
    };
    PL_TRY(pl_check_within(world, fn, "center", d->center, FAR));
    PL_TRY(pl_check_within(world, fn, "velocity", d->velocity, (real)1e6));
    PL_TRY(check_count(world, fn, "nodes", d->nodes == 0 ? 32 : d->nodes, 6, 10000));
    return check_numbers(world, fn, n, COUNT(n));
}

plumb_softbody plumb_skin_create(plumb_world *world, const plumb_skin_desc *desc)
{
    draft to;
    if (world == NULL || pl_check_unlocked(world, __func__) != PLUMB_OK ||
        pl_check_pointer(world, __func__, "desc", desc) != PLUMB_OK ||
        check_skin(world, __func__, desc) != PLUMB_OK) {
        return none();
    }
    const int n = desc->nodes == 0 ? 32 : desc->nodes;
    const double radius = (double)or_else(desc->radius, 0.5), mass = (double)or_else(desc->mass, 1);
    const double stiff = (double)or_else(desc->stiffness, 1e4);
    if (!reserve(world, __func__, &to, (size_t)n, (size_t)n, (size_t)n, 0, 0)) {
        return none();
    }
    double s, c;
    pl_sincos(PI / n, &s, &c);
    const double side = 2 * radius * s;
    for (int i = 0; i < n; ++i) {
        pl_sincos(2 * PI * i / n, &s, &c);
        to.nodes[i] =
            (plumb_softbody_node){ .position = { (real)((double)desc->center.x + radius * c),
                                                 (real)((double)desc->center.y + radius * s) },
                                   .velocity = desc->velocity,
                                   .mass = (real)(mass / n),
                                   .radius = (real)(side / 2) };
        const uint32_t a = (uint32_t)i, b = (uint32_t)((i + 1) % n), next = (uint32_t)((i + 2) % n);
        to.ring[i] = a;
        to.edges[i] = (plumb_softbody_edge){ .a = a,
                                             .b = b,
                                             .length = (real)side,
                                             .stiffness = (real)(stiff / side),
                                             .damping = (real)((double)desc->damping / side),
                                             .break_strain = desc->break_strain };
        if (desc->bending > 0) {
            to.bends[to.desc.bend_count++] = (plumb_softbody_bend){ .a = a,
                                                                    .b = b,
                                                                    .c = next,
                                                                    .stiffness = desc->bending,
                                                                    .length = (real)side,
                                                                    .angle = (real)(2 * PI / n) };
        }
    }
    to.desc.node_count = to.desc.edge_count = to.desc.ring_count = n;
    to.desc.friction = or_else(desc->friction, 0.5);
    to.desc.damping = desc->drag;
    to.desc.pressure = or_else(desc->pressure, 500);
    to.desc.ambient = desc->ambient;
    to.desc.filter = desc->filter, to.desc.no_sleep = desc->no_sleep;
    return finish(world, &to);
}

//---- jelly ---------------------------------------------------------------------------------------

static plumb_result check_jelly(const plumb_world *world, const char *fn, const plumb_jelly_desc *d)
{
    const number n[] = {
        { "spacing", d->spacing, 0, (real)1e6 }, { "density", d->density, 0, FAR },
        { "young", d->young, 0, MOST },          { "poisson", d->poisson, -1, (real)0.95 },
        { "damping", d->damping, -1, 1000 },     { "friction", d->friction, -1, 1000 },
        { "drag", d->drag, 0, (real)1e6 }
    };
    PL_TRY(pl_check_pointer(world, fn, "points", d->points));
    PL_TRY(check_count(world, fn, "count", d->count, 3, PLUMB_OUTLINE_MAX_VERTICES));
    PL_TRY(check_numbers(world, fn, n, COUNT(n)));
    double area = 0;
    for (int i = 0; i < d->count; ++i) {
        PL_TRY(pl_check_within(world, fn, "points", d->points[i], FAR));
        const plumb_vec2 p = d->points[i], q = d->points[(i + 1) % d->count];
        area += ((double)p.x * (double)q.y - (double)p.y * (double)q.x) / 2;
    }
    if (!(area > 0)) {
        return pl_fail(world, PLUMB_E_RANGE, fn,
                       "points enclose %g m^2; they must go round counter-clockwise", area);
    }
    return pl_check_within(world, fn, "velocity", d->velocity, (real)1e6);
}

static plumb_softbody make_jelly(plumb_world *world, const char *fn, const plumb_jelly_desc *d,
                                 const pl_mesh *m)
{
    draft to;
    if (!reserve(world, fn, &to, (size_t)m->nodes, 0, 0, (size_t)m->triangles, 0)) {
        return none();
    }
    const double density = (double)or_else(d->density, 100);
    for (int i = 0; i < m->nodes; ++i) {
        to.nodes[i].position = (plumb_vec2){ (real)(m->x[i] + (double)d->points[0].x),
                                             (real)(m->y[i] + (double)d->points[0].y) };
        to.nodes[i].velocity = d->velocity;
        to.nodes[i].radius = i < m->rim ? (real)(m->spacing / 2) : 0;
    }
    for (int t = 0; t < m->triangles; ++t) {
        const int *c = m->corner[t];
        const double area = ((m->x[c[1]] - m->x[c[0]]) * (m->y[c[2]] - m->y[c[0]]) -
                             (m->y[c[1]] - m->y[c[0]]) * (m->x[c[2]] - m->x[c[0]])) /
                            2;
        to.triangles[t] = (plumb_softbody_triangle){ .a = (uint32_t)c[0],
                                                     .b = (uint32_t)c[1],
                                                     .c = (uint32_t)c[2],
                                                     .young = or_else(d->young, 2e4),
                                                     .poisson = or_else(d->poisson, 0.4),
                                                     .damping = or_else(d->damping, 0.005) };
        for (int k = 0; k < 3; ++k) {
            to.nodes[c[k]].mass += (real)(density * area / 3);
        }
    }
    to.desc.node_count = m->nodes, to.desc.triangle_count = m->triangles;
    to.desc.friction = or_else(d->friction, 0.5);
    to.desc.damping = d->drag;
    to.desc.filter = d->filter, to.desc.no_sleep = d->no_sleep;
    return finish(world, &to);
}

plumb_softbody plumb_jelly_create(plumb_world *world, const plumb_jelly_desc *desc)
{
    plumb_softbody made = none();
    if (world == NULL || pl_check_unlocked(world, __func__) != PLUMB_OK ||
        pl_check_pointer(world, __func__, "desc", desc) != PLUMB_OK ||
        check_jelly(world, __func__, desc) != PLUMB_OK) {
        return made;
    }
    pl_mesh *m = pl_resize(&world->memory, NULL, 0, sizeof *m);
    if (m == NULL) {
        pl_fail_memory(world, __func__);
        return made;
    }
    if (pl_mesh_fill(m, desc->points, desc->count, (double)desc->spacing)) {
        made = make_jelly(world, __func__, desc, m);
    } else {
        pl_fail(world, PLUMB_E_RANGE, __func__,
                "spacing is %g; there must be between 3 and %d nodes and a triangle of them",
                m->spacing, PL_MESH_MOST);
    }
    pl_resize(&world->memory, m, sizeof *m, 0);
    return made;
}
