// many_worlds.c - thousands of cart-poles at once: a batch that is stepped, observed, acted on and reset,
// as a learner would. Prints steps a second for one thread and for two.
//
//     many_worlds [worlds [steps [crates]]]
//
// The cart slides on a rail, the pole is hinged to it. The cart is pushed at random, which is where a
// learner begins; a pole that leans beyond 0.3 rad ends its episode. Crates, if
// any are asked for, stand in stacks of eight below and only cost time: for a table of worlds by bodies.
#define _POSIX_C_SOURCE 199309L // clock_gettime
#include <plumb/plumb.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define DT ((plumb_real)(1.0 / 60))

enum { CART, POLE, BODIES };
enum { STACK = 8 };               // crates in a stack
static plumb_body bodies[BODIES]; // the same handles in every world

static plumb_result add_crates(plumb_world *world, long count)
{
    const plumb_body_desc floor = { .type = PLUMB_STATIC, .position = { 0, -21 } };
    const plumb_shape_desc slab = { .kind = PLUMB_BOX, .half = { 1000, 1 } };
    const plumb_shape_desc box = { .kind = PLUMB_BOX,
                                   .half = { (plumb_real)0.5, (plumb_real)0.5 } };
    if (count > 0) {
        plumb_shape_create(world, plumb_body_create(world, &floor), &slab);
    }
    for (long i = 0; i < count; ++i) {
        const plumb_vec2 at = { (plumb_real)(2 * (i / STACK)),
                                (plumb_real)(i % STACK) - (plumb_real)19.5 };
        plumb_body crate =
            plumb_body_create(world, &(plumb_body_desc){ .position = at, .no_sleep = true });
        if (plumb_is_null(plumb_shape_create(world, crate, &box))) {
            return plumb_world_error(world).code;
        }
    }
    return PLUMB_OK;
}

static plumb_result build(plumb_world *world, uint32_t index, plumb_random *random, void *context)
{
    (void)random;
    plumb_body cart = plumb_body_create(
        world, &(plumb_body_desc){ .lock_y = true, .fixed_rotation = true, .mass = 1 });
    plumb_body pole = plumb_body_create(
        world, &(plumb_body_desc){ .position = { 0, (plumb_real)0.5 }, .mass = (plumb_real)0.1 });
    const plumb_shape_desc box = { .kind = PLUMB_BOX,
                                   .half = { (plumb_real)0.25, (plumb_real)0.1 } };
    const plumb_shape_desc rod = { .kind = PLUMB_BOX,
                                   .half = { (plumb_real)0.02, (plumb_real)0.5 } };
    plumb_shape_create(world, cart, &box);
    plumb_shape_create(world, pole, &rod);
    const plumb_joint_desc hinge = { .kind = PLUMB_REVOLUTE, .body_a = cart, .body_b = pole };
    if (plumb_is_null(plumb_joint_create(world, &hinge))) {
        return plumb_world_error(world).code;
    }
    if (index == 0) {
        bodies[CART] = cart;
        bodies[POLE] = pole;
    }
    return add_crates(world, *(const long *)context);
}

static plumb_result randomise(plumb_world *world, uint32_t index, plumb_random *random,
                              void *context)
{
    (void)index, (void)context;
    plumb_real turn = plumb_random_range(random, (plumb_real)-1.5, (plumb_real)1.5);
    return plumb_body_set_angular_velocity(world, bodies[POLE], turn); // [rad/s]
}

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// Observes, pushes, steps, resets; returns the episodes that ended.
static long learn(plumb_batch *batch, uint32_t worlds, int steps, plumb_real *seen,
                  plumb_real *push, uint32_t *ended)
{
    const plumb_batch_field state[] = { PLUMB_FIELD_ANGLE, PLUMB_FIELD_W };
    const plumb_batch_field force[] = { PLUMB_FIELD_FORCE_X };
    const plumb_batch_view pole = { &bodies[POLE], 1, state, 2 };
    const plumb_batch_view cart = { &bodies[CART], 1, force, 1 };
    plumb_random dice = plumb_random_stream(2, 0);
    long episodes = 0;
    for (int step = 0; step < steps; ++step) {
        uint32_t count = 0;
        plumb_batch_observe(batch, &pole, seen, (size_t)worlds * 2);
        for (uint32_t i = 0; i < worlds; ++i) {
            plumb_real angle = seen[2 * i];
            push[i] = plumb_random_range(&dice, -10, 10); // [N]
            if (angle > (plumb_real)0.3 || angle < (plumb_real)-0.3) {
                ended[count++] = i;
            }
        }
        plumb_batch_act(batch, &cart, push, worlds);
        plumb_batch_step(batch, DT, 1);
        plumb_batch_reset(batch, ended, count);
        episodes += count;
    }
    return episodes;
}

static int run(uint32_t worlds, int steps, int workers, long crates, plumb_real *room,
               uint32_t *ended)
{
    plumb_batch *batch;
    const plumb_world_desc world = { .no_fine_islands = true }; // steps a second are what is wanted
    const plumb_batch_desc desc = { .world = &world,
                                    .count = worlds,
                                    .workers = workers,
                                    .build = build,
                                    .randomise = randomise,
                                    .context = &crates,
                                    .seed = 1 };
    if (plumb_batch_create(&desc, &batch) != PLUMB_OK) {
        return 1;
    }
    double bytes = (double)plumb_batch_bytes(batch) / worlds;
    learn(batch, worlds, 10, room, room + 2 * worlds, ended); // warm
    double start = seconds();
    long episodes = learn(batch, worlds, steps, room, room + 2 * worlds, ended);
    double took = seconds() - start;
    printf("%d %s: %.0f world steps a second, %ld episodes ended, %.0f bytes a world\n", workers,
           workers == 1 ? "worker " : "workers", (double)worlds * steps / took, episodes, bytes);
    plumb_batch_destroy(batch);
    return 0;
}

int main(int argc, char **argv)
{
    long worlds = argc > 1 ? strtol(argv[1], NULL, 10) : 512;
    long steps = argc > 2 ? strtol(argv[2], NULL, 10) : 100;
    long crates = argc > 3 ? strtol(argv[3], NULL, 10) : 0;
    if (crates < 0 || crates > 1000 || worlds < 1 || worlds > (long)PLUMB_BATCH_MAX || steps < 1 ||
        steps > 1000000) {
        fprintf(stderr, "usage: many_worlds [worlds [steps [crates]]]\n");
        return 2;
    }
    plumb_real *room = malloc((size_t)worlds * 3 * sizeof *room);
    uint32_t *ended = malloc((size_t)worlds * sizeof *ended);
    int failed = room == NULL || ended == NULL;
    for (int workers = 1; workers <= 2 && !failed; ++workers) {
        failed = run((uint32_t)worlds, (int)steps, workers, crates, room, ended);
    }
    free(ended);
    free(room);
    return failed;
}
