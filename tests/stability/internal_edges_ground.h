// internal_edges_ground.h - ground of many pieces in a dozen kinds, and the bodies that slide over it.
#ifndef INTERNAL_EDGES_GROUND_H
#define INTERNAL_EDGES_GROUND_H

#include "harness/sim.h"

#define HZ60  (1 / 60.0)
#define TILE  0.5 // [m]
#define TILES 700
#define TILT  0.3 // [rad] of the rotated rows
#define FAR   1e4 // [m]

typedef enum body_kind { BOX, DISC, CAPSULE, ROUNDED, TRIANGLE, BODY_KINDS } body_kind;
typedef enum ground_kind {
    ONE_PIECE,
    TILE_ROW,
    ONE_BODY,
    ROTATED,
    OFFSET,
    OVERLAPPING,
    GAPS,
    FAR_AWAY,
    CHAIN,
    SEGMENTS,
    CONCAVE,
    KINEMATIC,
    WALL,
    GROUND_KINDS
} ground_kind;

static const char *const body_names[] = { "box", "disc", "capsule", "rounded", "triangle" };
static const char *const ground_names[] = { "one piece",    "tile row",        "tiles, one body",
                                            "rotated row",  "offset rows",     "overlapping 5 cm",
                                            "gaps 0.5 mm",  "row at 1e4 m",    "chain",
                                            "segments",     "concave outline", "kinematic row",
                                            "wall of tiles" };

static inline plumb_real r(double v)
{
    return (plumb_real)v;
}

// [rad] by which ground and gravity are turned.
static inline double tilt_of(ground_kind ground)
{
    return ground == ROTATED ? TILT : ground == WALL ? SIM_PI / 2 : 0;
}

static inline double start_of(ground_kind ground)
{
    return ground == FAR_AWAY ? FAR : 0;
}

//---- ground: its surface is the line through the origin, turned by the tilt ------------------------

static inline plumb_vec2 turned(double x, double y, double tilt)
{
    return sim_vec(x * cos(tilt) - y * sin(tilt), x * sin(tilt) + y * cos(tilt));
}

static inline void add_box_at(plumb_world *w, plumb_body b, double x, double y, double hx,
                              double hy, plumb_material m)
{
    plumb_shape_desc desc = {
        .kind = PLUMB_BOX, .half = sim_vec(hx, hy), .center = sim_vec(x, y), .material = m
    };
    assert_true(plumb_shape_valid(w, plumb_shape_create(w, b, &desc)));
}

static inline void tile(plumb_world *w, double x, double y, double hx, double hy, double tilt,
                        plumb_material m)
{
    plumb_vec2 at = turned(x, y, tilt);
    plumb_body b = sim_body(w, PLUMB_STATIC, (double)at.x, (double)at.y, tilt);
    sim_add_box(w, b, hx, hy, m);
}

// Teeth that hang from a straight top: the decomposition cuts it into many pieces.
static inline void comb(plumb_world *w, plumb_body b, double x, double width, plumb_material m)
{
    plumb_vec2 p[42];
    int n = 0;
    p[n++] = sim_vec(x + width, 0);
    p[n++] = sim_vec(x, 0);
    for (int i = 0; i < 40; ++i) {
        p[n++] = sim_vec(x + width * i / 39, i % 2 == 0 ? -1 : -0.4);
    }
    plumb_shape_desc desc = { .kind = PLUMB_OUTLINE, .points = p, .count = n, .material = m };
    plumb_shape shape = plumb_shape_create(w, b, &desc);
    assert_true(plumb_shape_piece_count(w, shape) > 10);
}

static inline void make_ground(plumb_world *w, ground_kind kind, plumb_material m)
{
    plumb_vec2 points[TILES + 1];
    double x0 = start_of(kind) - 10, tilt = tilt_of(kind);
    plumb_body_type type = kind == KINEMATIC ? PLUMB_KINEMATIC : PLUMB_STATIC;
    bool one_body = kind == ONE_PIECE || kind == ONE_BODY || kind >= CHAIN;
    plumb_body b = PLUMB_NULL_INIT;
    if (one_body && kind != WALL) {
        b = sim_body(w, type, 0, 0, 0);
    }
    for (int i = 0; i <= TILES; ++i) {
        double x = x0 + TILE * i, half = TILE / 2;
        points[i] = sim_vec(x, 0);
        switch (kind) {
        case ONE_PIECE:
            if (i == 0) {
                add_box_at(w, b, x0 + TILE * TILES / 2, -half, TILE * TILES / 2, half, m);
            }
            break;
        case ONE_BODY:
        case KINEMATIC:
            add_box_at(w, b, x, -half, half, half, m);
            break;
        case OFFSET: // two rows; tiles of the upper one are of two sizes
            tile(w, x, -0.15, half, 0.15, 0, m);
            tile(w, x + 0.2, -0.3 - half, half, half, 0, m);
            break;
        case OVERLAPPING:
            tile(w, x, -half, half + 0.025, half, 0, m);
            break;
        case GAPS:
            tile(w, x, -half, half - 2.5e-4, half, 0, m);
            break;
        case SEGMENTS:
            sim_add_segment(w, b, sim_vec(x, 0), sim_vec(x + TILE, 0), m);
            break;
        case CONCAVE:
            if (i % 40 == 0) {
                comb(w, b, x, 40 * TILE, m);
            }
            break;
        case CHAIN:
            break;
        default:
            tile(w, x, -half, half, half, tilt, m);
        }
    }
    if (kind == CHAIN) {
        plumb_shape_desc desc = {
            .kind = PLUMB_CHAIN, .points = points, .count = TILES + 1, .material = m
        };
        assert_true(plumb_shape_valid(w, plumb_shape_create(w, b, &desc)));
    }
}

//---- bodies: lowest points at height 0, 1 m wide or less -------------------------------------------

static inline double height_of(body_kind kind)
{
    return kind == CAPSULE ? 0.25 : 0.5;
}

static inline plumb_body make_body(plumb_world *w, body_kind kind, double x, double tilt,
                                   plumb_material m)
{
    plumb_vec2 at = turned(x, height_of(kind), tilt);
    plumb_body b = sim_body(w, PLUMB_DYNAMIC, (double)at.x, (double)at.y, tilt);
    plumb_vec2 hexagon[6],
        triangle[3] = { sim_vec(-0.5, -0.5), sim_vec(0.5, -0.5), sim_vec(0, 0.5) },
        ends[2] = { sim_vec(-0.3, 0), sim_vec(0.3, 0) };
    for (int i = 0; i < 6; ++i) {
        double across = 0.4 / cos(SIM_PI / 6); // flat side down
        hexagon[i] = sim_vec(across * cos(i * SIM_PI / 3), across * sin(i * SIM_PI / 3));
    }
    plumb_shape_desc desc = { .material = m };
    switch (kind) {
    case BOX:
        desc.kind = PLUMB_BOX;
        desc.half = sim_vec(0.5, 0.5);
        break;
    case DISC:
        desc.kind = PLUMB_CIRCLE;
        desc.radius = r(0.5);
        break;
    case CAPSULE:
        desc.kind = PLUMB_CAPSULE;
        desc.points = ends;
        desc.count = 2;
        desc.radius = r(0.25);
        break;
    case ROUNDED:
        desc.kind = PLUMB_POLYGON;
        desc.points = hexagon;
        desc.count = 6;
        desc.radius = r(0.1);
        break;
    default:
        desc.kind = PLUMB_POLYGON;
        desc.points = triangle;
        desc.count = 3;
    }
    assert_true(plumb_shape_valid(w, plumb_shape_create(w, b, &desc)));
    return b;
}

#endif
