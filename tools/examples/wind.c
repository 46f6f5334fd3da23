// wind.c - a component of your own and a system that walks it beside the bodies' columns: leaves of
// different sails in a steady wind. Build: cc wind.c $(pkg-config --cflags --libs plumb)
#include <plumb/plumb.h>
#include <stdio.h>

static void blow(const plumb_system_call *call)
{
    const plumb_real speed = 3; // [m/s]
    const plumb_component sail = *(const plumb_component *)call->context;
    plumb_body_span bodies = plumb_world_bodies(call->world);
    plumb_body_view view;
    plumb_body_view_open(call->world, &(plumb_body_view_desc){ .with = { sail } }, &view);
    while (plumb_body_view_next(&view)) {
        const plumb_real *k = view.values[0];        // [kg/s] of the bodies of this range
        const plumb_real *vx = bodies.vx + view.row; // their columns
        const plumb_real *vy = bodies.vy + view.row;
        plumb_real *fx = bodies.fx + view.row, *fy = bodies.fy + view.row;
        for (int i = 0; i < view.count; ++i) {
            fx[i] += k[i] * (speed - vx[i]);
            fy[i] -= k[i] * vy[i];
        }
    }
}

int main(void)
{
    plumb_world *world;
    if (plumb_world_create(NULL, &world) != PLUMB_OK) {
        return 1;
    }
    plumb_component sail = plumb_component_create(
        world, &(plumb_component_desc){ .name = "sail", .size = sizeof(plumb_real) });
    plumb_system_create(world, &(plumb_system_desc){ .name = "wind",
                                                     .phase = PLUMB_PHASE_FORCES,
                                                     .run = blow,
                                                     .needs = { sail },
                                                     .writes = "forces",
                                                     .context = &sail });
    plumb_body leaf[4];
    for (int i = 0; i < 4; ++i) {
        const plumb_real k = (plumb_real)i;
        leaf[i] = plumb_body_create(world, &(plumb_body_desc){ .position = { 0, 100 } });
        if (i > 0) { // the first one is a stone
            plumb_component_set(world, leaf[i].entity, sail, &k);
        }
    }
    for (int i = 0; i < 120; ++i) {
        plumb_world_step(world, (plumb_real)(1.0 / 60));
    }
    for (int i = 0; i < 4; ++i) {
        const plumb_vec2 p = plumb_body_position(world, leaf[i]);
        printf("sail of %d kg/s: %6.3f m along, %7.3f m up\n", i, (double)p.x, (double)p.y);
    }
    plumb_world_destroy(world);
}
