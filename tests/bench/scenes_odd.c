// scenes_odd.c - what the benchmark scenes of others do not ask for, and users build: where an engine may be slow without
// anybody having looked. They run when they are named.
// Reads: nothing. Writes: the scene it is given. Cost: paid once, before any engine runs.
#include "scenes.h"

#include "../harness/random.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

// Walls of a bin as wide as two `half` and a floor, of boxes a metre thick.
static void box_in(struct scene *scene, double half)
{
    const int ground = scene_body(scene, ENGINE_STATIC, 0.0, 0.0);
    scene_box(scene, ground, engine_material_default, half + 2.0, 1.0, 0.0, -1.0);
    scene_box(scene, ground, engine_material_default, 1.0, 60.0, -half - 1.0, 60.0);
    scene_box(scene, ground, engine_material_default, 1.0, 60.0, half + 1.0, 60.0);
}

static void add_disc(struct scene *scene, int body, struct engine_material material, double radius)
{
    const double zero = 0.0;
    scene_convex(scene, body, material, &zero, &zero, 1, radius);
}

// Boxes or discs, as wide as high, in columns `pitch` apart that do not quite stand straight; every fifth of density `heavy`.
static void columns(struct scene *scene, int count, double half, double pitch, bool discs,
                    struct engine_material material, double heavy)
{
    uint32_t seed = 7;
    const int across = (int)(2.0 * half / pitch);
    box_in(scene, half);
    for (int i = 0; i < count; ++i) {
        const double x = -half + pitch * (0.5 + i % across) + sim_uniform(&seed, -0.04, 0.04);
        const int body = scene_body(scene, ENGINE_DYNAMIC, x, pitch * (0.5 + i / across));
        struct engine_material own = material;
        own.density = i % 5 == 0 ? heavy : material.density;
        if (discs) {
            add_disc(scene, body, own, 0.25);
        } else {
            scene_box(scene, body, own, 0.25, 0.25, 0.0, 0.0);
        }
    }
}

static struct engine_material bouncing(double restitution)
{
    return (struct engine_material){ .density = 1.0, .friction = 0.6, .restitution = restitution };
}

void build_odd_columns(struct scene *scene)
{
    columns(scene, 4000, 30.0, 0.6, false, engine_material_default, 1.0);
}

void build_odd_mixed(struct scene *scene)
{
    columns(scene, 1500, 15.0, 0.62, false, engine_material_default, 50.0);
}

void build_odd_bounce(struct scene *scene)
{
    columns(scene, 1500, 15.0, 0.62, false, bouncing(0.3), 1.0);
}

void build_odd_balls(struct scene *scene)
{
    columns(scene, 1500, 15.0, 0.62, true, bouncing(0.8), 1.0);
}

// Elastic discs that fly about in a square room.
void build_odd_gas(struct scene *scene)
{
    enum { across = 70 };
    uint32_t seed = 7;
    const struct engine_material elastic = { 1.0, 0.0, 1.0 };
    const int room = scene_body(scene, ENGINE_STATIC, 0.0, 0.0);
    scene->gravity_y = 0.0;
    for (int side = -1; side <= 1; side += 2) {
        scene_box(scene, room, elastic, 52.0, 1.0, 0.0, 51.0 * side);
        scene_box(scene, room, elastic, 1.0, 52.0, 51.0 * side, 0.0);
    }
    for (int i = 0; i < across * across; ++i) {
        const double turn = sim_uniform(&seed, 0.0, 2.0 * pi);
        const int body = scene_body(scene, ENGINE_DYNAMIC, -49.0 + 1.4 * (i % across),
                                    -49.0 + 1.4 * (i / across));
        scene->bodies[body].def.vx = 5.0 * cos(turn);
        scene->bodies[body].def.vy = 5.0 * sin(turn);
        add_disc(scene, body, elastic, 0.25);
    }
}

// A level of tiles, all of them shapes of one body, and boxes that slide over it.
void build_odd_tiles(struct scene *scene)
{
    enum { wide = 200, deep = 200, boxes = 500 };
    const int level = scene_body(scene, ENGINE_STATIC, 0.0, 0.0);
    for (int i = 0; i < wide * deep; ++i) {
        scene_box(scene, level, engine_material_default, 0.5, 0.5, i % wide, -(i / wide));
    }
    for (int i = 0; i < boxes; ++i) {
        const int body = scene_body(scene, ENGINE_DYNAMIC, 0.39 * i, 1.0);
        scene->bodies[body].def.vx = 1.0;
        scene_box(scene, body, engine_material_default, 0.15, 0.15, 0.0, 0.0);
    }
}

// Discs that roll over hills, a chain of 10,000 segments.
void build_odd_hills(struct scene *scene)
{
    enum { points = 10001, discs = 1000 };
    static double x[points], y[points];
    for (int i = 0; i < points; ++i) {
        x[i] = 500.0 - 0.1 * i; // free space is on the right of the way
        y[i] = 3.0 * sin(0.02 * i) + 0.05 * sin(1.7 * i);
    }
    const int hills = scene_body(scene, ENGINE_STATIC, 0.0, 0.0);
    scene_add_chain(scene, hills, engine_material_default, x, y, points, false);
    for (int i = 0; i < discs; ++i) {
        const int body = scene_body(scene, ENGINE_DYNAMIC, -490.0 + 0.98 * i, 6.0);
        scene->bodies[body].def.vx = 3.0;
        add_disc(scene, body, engine_material_default, 0.25);
    }
}

// Chains that fall into the vertical, each with a weight of 500 links at its end.
void build_odd_flails(struct scene *scene)
{
    enum { flails = 100, links = 20 };
    for (int k = 0; k < flails; ++k) {
        const double left = 16.0 * k, pitch = 0.3;
        int last = scene_body(scene, ENGINE_STATIC, left, 0.0);
        for (int i = 0; i <= links; ++i) {
            const bool weight = i == links;
            const int body = scene_body(scene, ENGINE_DYNAMIC,
                                        left + pitch * i + (weight ? 0.5 : 0.5 * pitch), 0.0);
            struct engine_material heavy = engine_material_default;
            heavy.density = 20.0;
            if (weight) {
                add_disc(scene, body, heavy, 0.5);
            } else {
                scene_box(scene, body, engine_material_default, 0.5 * pitch, 0.05, 0.0, 0.0);
            }
            scene->bodies[body].def.group = k + 1;
            scene_hinge(scene, (struct engine_hinge_def){
                                   .body_a = last, .body_b = body, .x = left + pitch * i });
            last = body;
        }
    }
}

// Discs from 4 cm to 4 m, evenly in the logarithm.
void build_odd_sizes(struct scene *scene)
{
    enum { discs = 4000 };
    uint32_t seed = 7;
    box_in(scene, 40.0);
    double x = -38.0, y = 2.0, row = 0.0;
    for (int i = 0; i < discs; ++i) {
        const double radius = 0.02 * pow(100.0, sim_uniform(&seed, 0.0, 1.0));
        if (x + 2.0 * radius > 38.0) {
            x = -38.0, y += 2.0 * row + 0.02, row = 0.0;
        }
        const int body = scene_body(scene, ENGINE_DYNAMIC, x + radius, y + radius);
        add_disc(scene, body, engine_material_default, radius);
        x += 2.0 * radius + 0.02;
        row = radius > row ? radius : row;
    }
}
