// pile.c - see pile.h.
#include "harness/pile.h"

#include <stdlib.h>

static plumb_body piece_of_heap(plumb_world *w, uint32_t *random, double x, double y,
                                plumb_material m)
{
    const double size = sim_uniform(random, 0.2, 0.6);
    const uint32_t kind = sim_random(random) % 4;
    plumb_body b = sim_body(w, PLUMB_DYNAMIC, x, y, sim_uniform(random, -1, 1));
    if (kind == 0) {
        sim_add_circle(w, b, size, m);
    } else if (kind == 1) {
        sim_add_box(w, b, size, sim_uniform(random, 0.1, 0.6), m);
    } else if (kind == 2) {
        sim_add_box(w, b, size, 0.1, m);
        sim_add_box(w, b, 0.1, size, m);
    } else {
        const plumb_vec2 points[3] = { sim_vec(-size, -size), sim_vec(size, -size / 2),
                                       sim_vec(0, size) };
        const plumb_shape_desc triangle = {
            .kind = PLUMB_POLYGON, .points = points, .count = 3, .material = m
        };
        if (plumb_is_null(plumb_shape_create(w, b, &triangle))) {
            abort();
        }
    }
    sim_launch(w, b, sim_uniform(random, -5, 5), sim_uniform(random, -5, 5),
               sim_uniform(random, -5, 5));
    return b;
}

int pile_make(plumb_world *w, uint32_t seed, plumb_body *bodies)
{
    uint32_t random = seed;
    sim_add_box(w, sim_body(w, PLUMB_STATIC, 0, -1, 0), 40, 1, sim_material(w, 0.5, 0));
    const double restitutions[4] = { 0, 0.1, 0.5, 1 };
    const plumb_material m = sim_material(w, 0.5, restitutions[sim_random(&random) % 4]);
    const int count = 2 + (int)(sim_random(&random) % (PILE_MOST - 1));
    for (int i = 0; i < count; ++i) {
        const double x = 1.3 * (i % 4) + sim_uniform(&random, -0.2, 0.2);
        bodies[i] = piece_of_heap(w, &random, x, 1 + 1.4 * (double)(i / 4), m);
        if (i > 0 && sim_random(&random) % 3 == 0) {
            sim_joint(w, (plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                             .body_a = bodies[i - 1],
                                             .body_b = bodies[i],
                                             .anchor = sim_vec(x - 0.6, 1.5) });
        }
    }
    return count;
}

pile_poses pile_poses_of(const plumb_world *w, const plumb_body *bodies, int count)
{
    pile_poses p = { .count = count };
    for (int i = 0; i < count; ++i) {
        p.x[i] = sim_x(w, bodies[i]), p.y[i] = sim_y(w, bodies[i]);
        p.angle[i] = sim_angle(w, bodies[i]), p.vx[i] = sim_vx(w, bodies[i]);
    }
    return p;
}

int pile_first_apart(const pile_poses *a, const pile_poses *b)
{
    for (int i = 0; i < a->count; ++i) {
        if (a->x[i] != b->x[i] || a->y[i] != b->y[i] || a->angle[i] != b->angle[i] ||
            a->vx[i] != b->vx[i]) {
            return i;
        }
    }
    return -1;
}
