// tank.c - tanks of liquid for tests. Reads, writes: the worlds that it is given.
#include "harness/tank.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void need(plumb_result result, const char *what)
{
    if (result != PLUMB_OK) {
        fprintf(stderr, "tank: %s was refused\n", what);
        abort();
    }
}

void tank_wall(plumb_world *w, double x, double y, double hx, double hy)
{
    const plumb_material none = PLUMB_NULL_INIT;
    sim_add_box(w, sim_body(w, PLUMB_STATIC, x, y, 0), hx, hy, none);
}

plumb_world *tank_make(double width, double height, double spacing)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
    tank_wall(w, width / 2, -0.5, width / 2 + 1, 0.5);
    tank_wall(w, -0.5, height / 2, 0.5, height / 2 + 1);
    tank_wall(w, width + 0.5, height / 2, 0.5, height / 2 + 1);
    need(plumb_liquid_create(w, &(plumb_liquid_desc){ .spacing = (plumb_real)spacing }),
         "the liquid");
    return w;
}

void tank_fill(plumb_world *w, double x0, double y0, double x1, double y1)
{
    need(plumb_liquid_add_box(w, sim_vec(x0, y0), sim_vec(x1, y1), NULL), "the water");
}

tank_state tank_look(const plumb_world *w)
{
    tank_state a = { 0, 0, 0, 0, -INFINITY, 0 };
    const plumb_particle *p = plumb_liquid_particles(w, &a.count);
    for (int i = 0; i < a.count; ++i) {
        const double u = (double)p[i].velocity.x, v = (double)p[i].velocity.y;
        a.mean_x += (double)p[i].position.x / a.count;
        a.mean_y += (double)p[i].position.y / a.count;
        a.kinetic += (u * u + v * v) / 2 / a.count;
        a.front = fmax(a.front, (double)p[i].position.x);
    }
    a.rms = sqrt(2 * a.kinetic);
    return a;
}
