// effect.c - an effect of your own, as a row of the substeps: planets fall round a star, by a force of the moment.
// It is what a built-in effect is: a component, a kernel over those who have it, a place in the step.
#include <plumb/plumb.h>
#include <stdio.h>

typedef struct charge {
    float pull; // [m^3/s^2] towards the origin
} charge;

// One call has some of the bodies: with several threads each has its own.
static void attract(const plumb_system_call *call)
{
    const plumb_substep *s = call->substep;
    const plumb_body_span b = plumb_world_bodies(call->world);
    const charge *charges = s->values[0];
    for (int i = 0; i < s->count; ++i) {
        const plumb_substep_body *body = &s->bodies[s->slot[i]];
        plumb_substep_motion *motion = &s->motions[s->slot[i]];
        // Where it is now: columns are those of the start of the step.
        const plumb_vec2 r = { b.center_x[s->row[i]] + body->dx, b.center_y[s->row[i]] + body->dy };
        const plumb_real d = plumb_vec2_magnitude(r);
        const plumb_real a = (plumb_real)charges[s->at[0][i]].pull / (d * d * d);
        motion->ax -= (plumb_near)(a * r.x);
        motion->ay -= (plumb_near)(a * r.y);
    }
}

int main(void)
{
    plumb_world *world;
    if (plumb_world_create(&(plumb_world_desc){ .zero_gravity = true }, &world) != PLUMB_OK) {
        return 1;
    }
    const plumb_component charged = plumb_component_create(
        world, &(plumb_component_desc){ .name = "charge", .size = sizeof(charge) });
    const plumb_body planet =
        plumb_body_create(world, &(plumb_body_desc){ .position = { 4, 0 }, .velocity = { 0, 2 } });
    plumb_component_set(world, planet.entity, charged, &(charge){ 16 });
    plumb_system_create(world, &(plumb_system_desc){ .name = "attract",
                                                     .phase = PLUMB_PHASE_SUBSTEP,
                                                     .run = attract,
                                                     .needs = { charged },
                                                     .reads = "poses, solver bodies, charge",
                                                     .writes = "accelerations",
                                                     .parallel = true });
    for (int i = 1; i <= 754; ++i) { // a circle takes 2 pi 4 m / (2 m/s) = 12.57 s
        plumb_world_step(world, (plumb_real)(1.0 / 60));
        const plumb_vec2 at = plumb_body_position(world, planet);
        if (i % 58 == 0) {
            printf("%6.3f s  (%6.3f, %6.3f) m  %.4f m from the star\n", i / 60.0, (double)at.x,
                   (double)at.y, (double)plumb_vec2_magnitude(at));
        }
    }
    plumb_world_destroy(world);
}
