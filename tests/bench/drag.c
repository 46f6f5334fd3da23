// drag.c - what linear drag costs, by each way to have it: what an effect of a user's costs beside a built-in one.
//
// All worlds live in one process and take turns, some steps each; the median over the turns is what counts.
#define _GNU_SOURCE // sched_setaffinity
#include "drag.h"

#include "plumb/plumb.h"

#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { turns = 31, steps_a_turn = 8, free_bodies = 20000, pile_count = 180, pile_rows = 10 };

static const plumb_real rate = (plumb_real)0.2; // [1/s]

enum way { NO_DRAG, OWN_ARRAY, VIEW, SUBSTEP, BUILT_IN, WAYS };

static const char *const names[] = { "none", "own array", "view", "substep", "damping" };

struct entrant {
    plumb_world *world;
    plumb_component drag;
    plumb_real *rates;  ///< a body row: the user's own array
    double turn[turns]; ///< [ns] a step
};

static void by_array(const plumb_system_call *call)
{
    const struct entrant *e = call->context;
    const plumb_body_span b = plumb_world_bodies(call->world);
    for (int i = 0; i < b.dynamic_count; ++i) {
        b.fx[i] -= e->rates[i] * b.vx[i];
        b.fy[i] -= e->rates[i] * b.vy[i];
    }
}

static void by_view(const plumb_system_call *call)
{
    const struct entrant *e = call->context;
    const plumb_body_span b = plumb_world_bodies(call->world);
    plumb_body_view view;
    plumb_body_view_open(call->world, &(plumb_body_view_desc){ .with = { e->drag } }, &view);
    while (plumb_body_view_next(&view)) {
        const plumb_real *k = view.values[0];
        const plumb_real *vx = b.vx + view.row, *vy = b.vy + view.row;
        plumb_real *fx = b.fx + view.row, *fy = b.fy + view.row;
        for (int i = 0; i < view.count; ++i) {
            fx[i] -= k[i] * vx[i];
            fy[i] -= k[i] * vy[i];
        }
    }
}

static void by_substep(const plumb_system_call *call)
{
    const plumb_substep *s = call->substep;
    const plumb_real *k = s->values[0];
    for (int i = 0; i < s->count; ++i) {
        const plumb_substep_body *b = &s->bodies[s->slot[i]];
        plumb_substep_motion *m = &s->motions[s->slot[i]];
        const plumb_near share = (plumb_near)k[s->at[0][i]] * b->inv_mass;
        m->ax -= share * b->vx;
        m->ay -= share * b->vy;
    }
}

static bool add_box(struct entrant *e, enum way way, plumb_vec2 at, plumb_vec2 velocity)
{
    plumb_body body =
        plumb_body_create(e->world, &(plumb_body_desc){ .position = at,
                                                        .velocity = velocity,
                                                        .damping = way == BUILT_IN ? rate : 0 });
    plumb_shape_create(
        e->world, body,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { (plumb_real)0.5, (plumb_real)0.5 } });
    const plumb_real k = rate; // of 1 kg
    return !(way == VIEW || way == SUBSTEP) ||
           plumb_component_set(e->world, body.entity, e->drag, &k) == PLUMB_OK;
}

static bool add_free(struct entrant *e, enum way way)
{
    bool made = true;
    for (int i = 0; i < free_bodies && made; ++i) {
        const plumb_vec2 at = { (plumb_real)(3 * (i % 200)), (plumb_real)(3 * (i / 200)) };
        made = add_box(e, way, at, (plumb_vec2){ 1, 0 });
    }
    return made;
}

static bool add_piles(struct entrant *e, enum way way)
{
    plumb_body ground = plumb_body_create(e->world, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(e->world, ground,
                       &(plumb_shape_desc){ .kind = PLUMB_BOX,
                                            .half = { 3000, (plumb_real)0.5 },
                                            .center = { 0, (plumb_real)-0.5 } });
    bool made = true;
    for (int p = 0; p < pile_count && made; ++p) {
        for (int row = 0; row < pile_rows && made; ++row) {
            for (int i = 0; i < pile_rows - row && made; ++i) {
                const plumb_vec2 at = { (plumb_real)(12 * p - 1000 + i + 0.5 * row),
                                        (plumb_real)(0.5 + row) };
                made = add_box(e, way, at, (plumb_vec2){ 0, 0 });
            }
        }
    }
    return made;
}

static bool open_entrant(struct entrant *e, enum way way, bool piles)
{
    static const plumb_phase phases[] = { [OWN_ARRAY] = PLUMB_PHASE_FORCES,
                                          [VIEW] = PLUMB_PHASE_FORCES,
                                          [SUBSTEP] = PLUMB_PHASE_SUBSTEP };
    void (*const run[WAYS])(const plumb_system_call *) = {
        [OWN_ARRAY] = by_array, [VIEW] = by_view, [SUBSTEP] = by_substep
    };
    if (plumb_world_create(&(plumb_world_desc){ .no_sleep = true }, &e->world) != PLUMB_OK) {
        return false;
    }
    e->drag = plumb_component_create(
        e->world, &(plumb_component_desc){ .name = "drag", .size = sizeof(plumb_real) });
    e->rates = malloc(sizeof *e->rates * free_bodies);
    for (int i = 0; i < free_bodies && e->rates != NULL; ++i) {
        e->rates[i] = rate;
    }
    if (e->rates == NULL || !(piles ? add_piles(e, way) : add_free(e, way))) {
        return false;
    }
    return run[way] == NULL ||
           plumb_system_create(e->world,
                               &(plumb_system_desc){
                                   .name = names[way],
                                   .phase = phases[way],
                                   .run = run[way],
                                   .needs = { way == OWN_ARRAY ? (plumb_component){ 0 } : e->drag },
                                   .context = e,
                                   .parallel = way == SUBSTEP }) == PLUMB_OK;
}

static double now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

static double take_turn(struct entrant *e)
{
    plumb_world_step(e->world, (plumb_real)(1.0 / 60)); // brings the world back into the cache
    const double from = now_ns();
    for (int i = 0; i < steps_a_turn; ++i) {
        plumb_world_step(e->world, (plumb_real)(1.0 / 60));
    }
    return (now_ns() - from) / steps_a_turn;
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static bool report(const char *title, bool piles)
{
    struct entrant of[WAYS] = { 0 };
    bool made = true;
    for (int w = 0; w < WAYS && made; ++w) {
        made = open_entrant(&of[w], (enum way)w, piles);
    }
    for (int t = 0; t < turns && made; ++t) {
        for (int w = 0; w < WAYS; ++w) {
            of[w].turn[t] = take_turn(&of[w]);
        }
    }
    const double bodies = piles ? pile_count * pile_rows * (pile_rows + 1) / 2 : free_bodies;
    double first = 0;
    for (int w = 0; w < WAYS && made; ++w) {
        qsort(of[w].turn, turns, sizeof *of[w].turn, by_value);
        const double ns = of[w].turn[turns / 2] / bodies;
        first = w == 0 ? ns : first;
        printf("%-14s %-10s %8.1f ns a body and step %+8.1f ns %+7.1f %%\n", title, names[w], ns,
               ns - first, 100 * (ns / first - 1));
    }
    for (int w = 0; w < WAYS; ++w) {
        plumb_world_destroy(of[w].world);
        free(of[w].rates);
    }
    return made;
}

int drag_report(int core)
{
    if (core >= 0) {
        cpu_set_t set;
        CPU_ZERO(&set);
        CPU_SET((size_t)core, &set);
        sched_setaffinity(0, sizeof set, &set);
    }
    return report("free", false) && report("stacked", true) ? 0 : 1;
}
