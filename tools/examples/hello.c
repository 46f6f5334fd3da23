// hello.c - a ball falls on the ground. Build: cc hello.c $(pkg-config --cflags --libs plumb)
#include <plumb/plumb.h>
#include <stdio.h>

int main(void)
{
    plumb_world *world;
    if (plumb_world_create(NULL, &world) != PLUMB_OK) {
        return 1;
    }
    plumb_body ground = plumb_body_create(world, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_body ball = plumb_body_create(world, &(plumb_body_desc){ .position = { 0, 6 } });
    plumb_shape_create(world, ground, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 9, 1 } });
    plumb_shape_create(world, ball, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1 });
    for (int i = 1; i <= 120; ++i) {
        plumb_world_step(world, (plumb_real)(1.0 / 60));
        printf("%.3f s  %.3f m\n", i / 60.0, (double)plumb_body_position(world, ball).y);
    }
    plumb_world_destroy(world);
}
