// scenes.c - the benchmark scenes, one function each, and the table of them.
// Reads: nothing. Writes: the scene it is given. Cost: paid once, before any engine runs.
//
// The sizes, places and speeds are those of the benchmark that Box2D 3.2 ships, so that figures
// published for it can be set beside ours; the materials are its defaults (friction 0.6, density 1)
// unless a scene says otherwise. Body 0 is what the others stand on or are hit by.
#include "scenes.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

// Boxes in rows of base, base - 1, ... 1, each standing on two of the row below.
static void pyramid(struct scene *scene, int base, double left, double bottom)
{
    for (int row = 0; row < base; ++row) {
        for (int column = 0; column < base - row; ++column) {
            double x = left + 0.5 * (row + 1) + column;
            int body = scene_body(scene, ENGINE_DYNAMIC, x, bottom + row + 0.5);
            scene_box(scene, body, engine_material_default, 0.5, 0.5, 0.0, 0.0);
        }
    }
}

static void build_large_pyramid(struct scene *scene)
{
    enum { base = 100 };
    int ground = scene_body(scene, ENGINE_STATIC, 0.0, -1.0);
    scene_box(scene, ground, engine_material_default, 100.0, 1.0, 0.0, 0.0);
    pyramid(scene, base, -0.5 * base, 0.0);
}

// Piles of 55 boxes each, on floors one above another.
static void pyramid_field(struct scene *scene, int rows, int columns)
{
    enum { base = 10 };
    const double pitch = base + 1.0; // one box of room between neighbours, both ways
    const double half_width = 0.5 * pitch * columns;
    int ground = scene_body(scene, ENGINE_STATIC, 0.0, 0.0);
    for (int row = 0; row < rows; ++row) {
        const double x[2] = { -half_width, half_width };
        const double y[2] = { pitch * row, pitch * row };
        scene_convex(scene, ground, engine_material_default, x, y, 2, 0.0);
    }
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            pyramid(scene, base, -half_width + pitch * column + 0.5, pitch * row);
        }
    }
}

static void build_many_pyramids(struct scene *scene)
{
    pyramid_field(scene, 20, 20);
}

// The same at four sizes: what a body costs should not depend on how many there are.
static void build_field_1e3(struct scene *scene)
{
    pyramid_field(scene, 3, 6); // 990 boxes
}

static void build_field_1e4(struct scene *scene)
{
    pyramid_field(scene, 13, 14); // 10,010
}

static void build_field_1e5(struct scene *scene)
{
    pyramid_field(scene, 40, 45); // 99,000
}

static void build_field_1e6(struct scene *scene)
{
    pyramid_field(scene, 130, 140); // 1,001,000
}

static void build_smash(struct scene *scene)
{
    enum { columns = 120, rows = 80 };
    const double side = 0.4;
    scene->gravity_y = 0.0;
    scene->sleeps = true;
    struct engine_material heavy = engine_material_default;
    heavy.density = 8.0;
    int hammer = scene_body(scene, ENGINE_DYNAMIC, -20.0, 0.0);
    scene->bodies[hammer].def.vx = 40.0;
    scene_box(scene, hammer, heavy, 4.0, 4.0, 0.0, 0.0);
    for (int i = 0; i < columns; ++i) {
        for (int j = 0; j < rows; ++j) {
            double y = (j - 0.5 * rows) * side;
            int body = scene_body(scene, ENGINE_DYNAMIC, 30.0 + i * side, y);
            scene->bodies[body].def.asleep = true;
            scene_box(scene, body, engine_material_default, 0.5 * side, 0.5 * side, 0.0, 0.0);
        }
    }
}

// A quadrilateral between two radii and two angles [rad].
static void ring_piece(struct scene *scene, int body, double r0, double r1, double from, double to)
{
    const double x[4] = { r0 * cos(from), r1 * cos(from), r1 * cos(to), r0 * cos(to) };
    const double y[4] = { r0 * sin(from), r1 * sin(from), r1 * sin(to), r0 * sin(to) };
    scene_convex(scene, body, engine_material_default, x, y, 4, 0.0);
}

static void build_washer(struct scene *scene)
{
    enum { pieces = 36, paddle_every = 9, grid = 90 };
    const double turn = 2.0 * pi / pieces;
    const double overlap = 0.1 * turn; // of neighbouring pieces, at either end
    const double half = 0.1;
    const double pitch = 0.21;
    scene->sleeps = true;
    int drum = scene_body(scene, ENGINE_KINEMATIC, 0.0, 10.0);
    scene->bodies[drum].def.w = 25.0 * pi / 180.0;
    scene->bodies[drum].def.vx = 0.001;
    scene->bodies[drum].def.vy = -0.002;
    for (int i = 0; i < pieces; ++i) {
        ring_piece(scene, drum, 16.0, 18.0, i * turn - overlap, (i + 1) * turn + overlap);
        if (i % paddle_every == 0) {
            ring_piece(scene, drum, 14.0, 16.0, i * turn, (i + 1) * turn);
        }
    }
    const double corner = -1.1 * half * grid;
    for (int i = 0; i < grid; ++i) {
        for (int j = 0; j < grid; ++j) {
            double y = corner + 10.0 + i * pitch;
            int body = scene_body(scene, ENGINE_DYNAMIC, corner + j * pitch, y);
            scene_box(scene, body, engine_material_default, half, half, 0.0, 0.0);
        }
    }
}

// A floor and two walls of one-metre boxes that overlap by a tenth: 2 * half + 1 boxes wide.
static void bin(struct scene *scene, int ground, int half, int height)
{
    for (int i = -half; i <= half; ++i) {
        scene_box(scene, ground, engine_material_default, 0.55, 0.5, i, 0.0);
    }
    for (int side = -1; side <= 1; side += 2) {
        for (int j = 1; j <= height; ++j) {
            scene_box(scene, ground, engine_material_default, 0.5, 0.55, side * half, j);
        }
    }
}

// Five points on a circle, each a golden turn after the one before, in counter-clockwise order.
static void pentagon(struct scene *scene, int body, double radius)
{
    const double step = pi * (sqrt(5.0) - 1.0);
    double angle[5];
    for (int i = 0; i < 5; ++i) {
        double a = fmod(step * i, 2.0 * pi);
        int k = i;
        for (; k > 0 && angle[k - 1] > a; --k) {
            angle[k] = angle[k - 1];
        }
        angle[k] = a;
    }
    double x[5];
    double y[5];
    for (int i = 0; i < 5; ++i) {
        x[i] = radius * cos(angle[i]);
        y[i] = radius * sin(angle[i]);
    }
    scene_convex(scene, body, engine_material_default, x, y, 5, 0.0);
}

static void build_junkyard(struct scene *scene)
{
    enum { columns = 200, rows = 40 };
    const double radius = 0.25;
    scene->sleeps = true;
    int ground = scene_body(scene, ENGINE_STATIC, 0.0, 0.0);
    bin(scene, ground, 80, 50);
    double side = -0.1;
    for (int i = 0; i < columns; ++i) {
        for (int j = 0; j < rows; ++j) {
            double x = 1.5 * (2.0 * i - columns) * radius + side;
            int body = scene_body(scene, ENGINE_DYNAMIC, x, 15.0 + 4.0 * j * radius);
            pentagon(scene, body, radius);
            side = -side;
        }
    }
    int pusher = scene_body(scene, ENGINE_KINEMATIC, 0.0, 0.0);
    scene_box(scene, pusher, engine_material_default, 2.0, 4.0, 0.0, 4.0);
}

// Drives the pusher, the last body, along x = 60 sin(0.2 t).
static void push_junk(const struct scene *scene, const struct engine *engine,
                      struct engine_world *world, int step, double dt)
{
    int pusher = scene->body_count - 1;
    double target = 60.0 * sin(0.2 * (step + 1) * dt);
    double x = engine->get_pose(world, pusher).x;
    engine->set_velocity(world, pusher, (target - x) / dt, 0.0, 0.0);
}

static void build_compounds(struct scene *scene)
{
    enum { columns = 20, rows = 150 };
    const double x[2][3] = { { -1.0, 0.5, 0.0 }, { 1.0, 0.0, -0.5 } };
    const double y[2][3] = { { 0.0, 1.0, 2.0 }, { 0.0, 2.0, 1.0 } };
    const double net_x[2] = { -800.0, 800.0 };
    const double net_y[2] = { -80.0, -80.0 };
    scene->sleeps = true;
    struct engine_material rough = engine_material_default;
    rough.friction = 0.5;
    int ground = scene_body(scene, ENGINE_STATIC, 0.0, 0.0);
    bin(scene, ground, 40, 100);
    scene_convex(scene, ground, engine_material_default, net_x, net_y, 2, 0.0);
    double side = 0.25;
    for (int i = 0; i < columns; ++i) {
        for (int j = 0; j < rows; ++j) {
            double left = 2.0 * i - (columns - 1.0) + side;
            int body = scene_body(scene, ENGINE_DYNAMIC, left, 5.575 + 2.25 * j);
            scene_convex(scene, body, rough, x[0], y[0], 3, 0.0);
            scene_convex(scene, body, rough, x[1], y[1], 3, 0.0);
            side = -side;
        }
    }
}

enum {
    NAMED = 13, // rows at the end that run only when they are named
    SETTLE =
        10 // steps of those that build what lasts: grids, the pair list, memory that is first touched
};

const struct scene_row scene_rows[] = {
    { "large_pyramid", 0, 500, build_large_pyramid, NULL, "one deep pile at rest" },
    { "many_pyramids", 0, 200, build_many_pyramids, NULL, "400 small piles at rest" },
    { "smash", 0, 300, build_smash, NULL, "a hammer into a wall, no gravity" },
    { "washer", 0, 500, build_washer, NULL, "boxes tumbled by a turning drum" },
    { "junkyard", 0, 800, build_junkyard, push_junk, "pentagons pushed to and fro" },
    { "compounds", 0, 500, build_compounds, NULL, "bodies of two triangles poured" },
    { "tumbler", 0, 750, build_tumbler, NULL, "boxes in a motor-driven box" },
    { "joint_grid", 0, 500, build_joint_grid, NULL, "a net of 19,800 hinges" },
    { "spinner", 0, 500, build_spinner, NULL, "a motor stirs a bowl" },
    { "rain", 0, 1000, build_rain, NULL, "ragdolls come and go" },
    { "field_1e3", SETTLE, 400, build_field_1e3, NULL, "18 small piles at rest" },
    { "field_1e4", SETTLE, 200, build_field_1e4, NULL, "182 small piles at rest" },
    { "field_1e5", SETTLE, 60, build_field_1e5, NULL, "1,800 small piles at rest" },
    { "field_1e6", SETTLE, 20, build_field_1e6, NULL, "18,200 small piles at rest" },
    { "odd_columns", 0, 150, build_odd_columns, NULL, "boxes in columns of 40 that come down" },
    { "odd_mixed", 0, 150, build_odd_mixed, NULL, "boxes, every fifth 50 times as heavy" },
    { "odd_bounce", 0, 150, build_odd_bounce, NULL, "boxes of e = 0.3 in a heap" },
    { "odd_balls", 0, 150, build_odd_balls, NULL, "discs of e = 0.8 in a heap" },
    { "odd_gas", 0, 150, build_odd_gas, NULL, "elastic discs in a room" },
    { "odd_tiles", SETTLE, 150, build_odd_tiles, NULL, "40,000 tiles of one body" },
    { "odd_hills", SETTLE, 150, build_odd_hills, NULL, "discs roll over a long chain" },
    { "odd_flails", 0, 150, build_odd_flails, NULL, "chains with heavy ends" },
    { "odd_sizes", 0, 150, build_odd_sizes, NULL, "discs from 4 cm to 4 m" },
};

const int scene_row_count = (int)(sizeof scene_rows / sizeof scene_rows[0]);
const int scene_default_count = (int)(sizeof scene_rows / sizeof scene_rows[0]) - NAMED;
