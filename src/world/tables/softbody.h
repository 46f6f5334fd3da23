// softbody.h - soft bodies as they are stored, and what a step makes of them.
#ifndef PL_TABLE_SOFTBODY_H
#define PL_TABLE_SOFTBODY_H

#include "core/elimination.h"
#include "core/near.h"
#include "plumb/softbody.h"

// Nodes and elements of all of them lie one behind the other, in the order of the soft bodies; an element names nodes as
// the soft body counts them.
typedef struct pl_softbody {
    plumb_softbody entity;
    uint32_t nodes, edges, bends, triangles, ring, pins; // how many it has
    plumb_real friction, damping;
    plumb_real pressure, ambient, area; // area: at rest
    plumb_filter filter;
    bool asleep, due, no_sleep; // due: it sleeps, and wakes in the next step
    uint8_t rest_samples; // as of bodies: 2 if it rested for two, half of sleep_time each
    plumb_real rest_time; // [s] likewise; below 0: it moves or was changed
    plumb_vec2 low, high; // [m] corners of a box round its nodes, and 2 cm more
} pl_softbody;

// Where a node was at the last sample of its rest, and its way since the sample before.
typedef struct pl_soft_rest {
    plumb_real x, y, dx, dy; // [m]
} pl_soft_rest;

// Where those of a soft body begin; points: of a step, in which what sleeps has none.
typedef struct pl_softbody_place {
    uint32_t node, edge, bend, triangle, ring, pin, point;
} pl_softbody_place;

// A node in a step.
typedef struct pl_soft_point {
    double x, y, vx, vy; // [m], [m/s] as the substep begins
    double cx, cy;       // [m/s] that this substep adds to the velocity, as far as is known
    double mass, radius; // [kg], [m]
    double damping;      // [1/s]
    double wind_x, wind_y; // [m/s] against which
    double push_x, push_y; // [N] of the liquid
    double way_x, way_y;   // [m/s] as it goes by what the liquid has found
    double follow;         // [s] of dampers towards that, over stiffness; 0: none
    double carried;        // [kg] of liquid that goes along with it
    double friction;     // [-]
    double rx, ry;       // [m] of one that is pinned to a body: from its centre of mass, in the mean of the substep
    double px, py;       // [m] the same in the body's frame; in the world where no body holds it
    double heavy;        // [kg] all that its soft body moves: what contacts are stiff for
    uint32_t block;      // of unknowns; PL_NONE: its motion is known
    uint32_t body;       // of the list of bodies that holds it; PL_NONE
    bool pinned;
    bool moored;         // some node of its soft body is pinned to the world, or to what nothing pushes
} pl_soft_point;

// A body that is near, or holds a node.
typedef struct pl_soft_body {
    plumb_body body;
    uint32_t row, slot, block; // slot, block: PL_NONE where its motion is known
    double x0, y0, c0, s0;     // [m] centre of mass, rotation as the step begins
    double x, y, c, s;         // the same as the substep begins
    double vx, vy, w;          // [m/s], [rad/s]
    double ax, ay, aw;         // what moves it besides
    double mass, inertia;      // [kg], [kg m^2]
    double locked_x, locked_y, locked_w; // 1: free, 0: it does not move so
    bool asleep, touched;
} pl_soft_body;

// A convex piece that is near.
typedef struct pl_soft_obstacle {
    uint32_t piece, body; // of the list
    int count;
    double friction, radius, extent; // extent: [m] about the centre of mass
    double x[16], y[16];             // [m] about the body's centre of mass, in its frame
} pl_soft_obstacle;

typedef struct pl_soft_near {
    uint32_t point, obstacle;
} pl_soft_near;

// A node touches, or is about to.
typedef struct pl_soft_contact {
    uint32_t point, body;
    double nx, ny;   // from the body to the node
    double gap;      // [m] as the substep begins
    double rx, ry;   // [m] from the centre of mass to where friction acts
    double stiffness, friction;
    double force;    // [N] where it was asked last
    double most;     // [N] that friction holds
} pl_soft_contact;

// What the liquid does to a node in a step, and how the node goes by what the liquid has found.
typedef struct pl_soft_shove {
    double x, y;   // [N]
    double mass;   // [kg] of liquid that goes along with it
    double ax, ay; // [m/s^2]
    double follow; // [s] of dampers towards that, over stiffness
    double heavy;  // [kg] of liquid that its soft body takes the place of
} pl_soft_shove;

// What an edge was asked for last.
typedef struct pl_soft_pull {
    double tension, stretch;                // [N], [m]
    double damping, of, ahead, late, share; // of a substep (softbody/elements.c)
} pl_soft_pull;

// The inner loops of fronts (softbody/fronts.simd.c).
typedef struct pl_soft_kernels {
    void (*clear)(double *rest, size_t tall);
    void (*add)(double *to, const double *from, uint32_t j, uint32_t count, const uint32_t *local,
                const uint32_t *run, size_t shift);
    void (*factor)(double *panel, uint32_t width, uint32_t below, double *inverse, double *scaled,
                   double *rest);
    void (*push)(const double *panel, uint32_t width, uint32_t below, double *x);
    void (*pull)(const double *panel, uint32_t width, uint32_t below, double *x);
} pl_soft_kernels;

// Blocks that are eliminated together: columns of L with nearly the same rows.
typedef struct pl_soft_front {
    uint32_t first, end;    // blocks
    uint32_t width, below;  // how many unknowns these are; those behind them that they have to do with
    uint32_t parent;        // the front that takes over what this one leaves; PL_NONE
    uint32_t child, next;   // the first one that it takes over; the next of the same parent
    uint32_t at;            // in `places` and `local`: its own unknowns, then those below
    size_t panel, rest;     // numbers: columns of L; what it leaves
} pl_soft_front;

// Unknowns in blocks of up to 3, the symmetric matrix by rows: lower neighbours and diagonal; factors L D L^T.
typedef struct pl_soft_matrix {
    uint32_t blocks, entries, front_count;
    uint32_t *first, *column; // entries of a row of blocks, by rising column
    uint32_t *parent, *fill;  // elimination tree; entries of a column of L
    uint32_t *front_of;       // a block
    uint32_t *mark, *stack;
    uint8_t *size;            // unknowns of a block
    pl_soft_front *fronts;
    size_t *into;             // of an entry: its place in the panels
    uint32_t *places, *local; // of an unknown of a front: in vectors; what is below: in the parent's panel
    uint32_t *run;            // likewise: how many from it on lie there one behind the other
    const pl_soft_kernels *kernels; // of the world's width
    double *diagonal, *off;   // 9 a block
    double *panels, *rests, *scaled, *piece; // of fronts; of one front
    size_t panel_size;
    double *inverse;          // 1 / D
    double *right, *u, *tried, *slope, *way; // 3 a block
    double *sheets;           // likewise: what triangles add to `right`
} pl_soft_matrix;

// A soft body that is awake, in a step.
typedef struct pl_soft_member {
    uint32_t item, nodes, gas;             // of soft bodies; how many; its block, PL_NONE: no gas
    double mass;                           // [kg] of all nodes
    pl_softbody_place at;
    uint32_t first_near, end_near;         // what its nodes are near to
    uint32_t first_contact, end_contact;   // of a substep
} pl_soft_member;

// Soft bodies that hang together, with the bodies that they pull and touch: they are solved by themselves.
typedef struct pl_soft_group {
    uint32_t first_member, end_member;
    uint32_t first_body, end_body;   // of `grouped`: those that are unknowns
    uint32_t first_block, end_block;
    double mass;    // [kg] of its members
    bool triangles; // it has some
    bool touches;   // it has contacts
    bool known;     // the matrix and all else are those of where u is
    double value;   // of the function that is to be least, where it was asked last
    int pass;    // of this substep's iteration; friction acts from the second on
} pl_soft_group;

typedef struct pl_soft_step {
    pl_buffer points, bodies, obstacles, near_, contacts, keys, index, fronts, numbers, shapes, rows, pulls, winds, pushes;
    pl_buffer kept;      // what the plan was made of (softbody/order.c)
    bool planned;        // that plan stands
    pl_buffer members, groups, grouped; // pl_soft_member, by their groups; pl_soft_group; uint32_t: bodies
    pl_elimination elimination;
    uint32_t point_count, body_count, obstacle_count, near_count, contact_count, member_count, group_count;
    uint32_t wind_count; // volumes of fluid that nodes may be in
    bool pushed;         // in this step, by the liquid; pushes: pl_soft_shove, one a node
    uint32_t coupled; // bodies that are unknowns; rows: a byte a dynamic row, whether it is one
    int done;         // substeps
    uint32_t missed;  // substeps of this step that ended before they had settled
    double creep;     // [m/s] of slip, below which friction is a damper
    pl_soft_matrix matrix;
} pl_soft_step;

typedef struct pl_softbodies {
    pl_buffer items;                                       // pl_softbody
    pl_buffer nodes, edges, bends, triangles, rings, pins; // plumb_softbody_...; of rings uint32_t
    pl_buffer rests;                                       // pl_soft_rest, one a node
    uint32_t asleep_count;                                 // soft bodies
    uint32_t count, node_count, edge_count, bend_count, triangle_count, ring_count, pin_count,
        rest_count;
    uint32_t missed_count; // substeps in all that ended before they had settled
    pl_soft_step *step; // NULL: no step has needed it yet
} pl_softbodies;

static inline pl_softbody *pl_softbody_items(const pl_softbodies *s)
{
    return (pl_softbody *)s->items.data;
}

static inline plumb_softbody_node *pl_softbody_nodes(const pl_softbodies *s)
{
    return (plumb_softbody_node *)s->nodes.data;
}

static inline plumb_softbody_edge *pl_softbody_edges(const pl_softbodies *s)
{
    return (plumb_softbody_edge *)s->edges.data;
}

static inline plumb_softbody_bend *pl_softbody_bends(const pl_softbodies *s)
{
    return (plumb_softbody_bend *)s->bends.data;
}

static inline plumb_softbody_triangle *pl_softbody_triangles(const pl_softbodies *s)
{
    return (plumb_softbody_triangle *)s->triangles.data;
}

static inline uint32_t *pl_softbody_rings(const pl_softbodies *s)
{
    return (uint32_t *)s->rings.data;
}

static inline plumb_softbody_pin *pl_softbody_pins(const pl_softbodies *s)
{
    return (plumb_softbody_pin *)s->pins.data;
}

static inline pl_soft_rest *pl_softbody_rests(const pl_softbodies *s)
{
    return (pl_soft_rest *)s->rests.data;
}

// The places behind those of a soft body.
static inline pl_softbody_place pl_softbody_behind(pl_softbody_place at, const pl_softbody *s)
{
    return (pl_softbody_place){ at.node + s->nodes, at.edge + s->edges,
                                at.bend + s->bends, at.triangle + s->triangles,
                                at.ring + s->ring,  at.pin + s->pins,
                                at.point + (s->asleep ? 0 : s->nodes) };
}

static inline pl_softbody_place pl_softbody_place_of(const pl_softbodies *s, uint32_t row)
{
    pl_softbody_place at = { 0 };
    for (uint32_t i = 0; i < row; ++i) {
        at = pl_softbody_behind(at, &pl_softbody_items(s)[i]);
    }
    return at;
}

#endif
