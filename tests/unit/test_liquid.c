// test_liquid.c - kernels of the liquid by themselves: chords, tiles, transfer there and back, openness of faces, the
// projection.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/near.h"

#include "geometry/chord.h"
#include "liquid/back.h"
#include "harness/random.h"
#include "harness/sim.h"

#define TOLERANCE (sizeof(near_real) == 4 ? 2e-5 : 1e-10)

typedef struct bench {
    pl_memory memory;
    pl_liquid_scratch scratch;
    plumb_particle *particles;
    uint32_t count;
} bench;

static void open_bench(bench *b)
{
    *b = (bench){ .count = 0 };
    pl_memory_init(&b->memory, &(plumb_allocator){ 0 });
}

static void close_bench(bench *b)
{
    pl_liquid_free_arrays(&b->memory, &b->scratch);
    assert_int_equal(b->memory.bytes, 0);
    free(b->particles);
}

// A lattice of n x m particles half a cell apart, from the corner (x, y) in cells; h is 1.
static void add_lattice(bench *b, int n, int m, double x, double y)
{
    b->particles = realloc(b->particles, (b->count + (size_t)(n * m)) * sizeof *b->particles);
    assert_non_null(b->particles);
    for (int i = 0; i < n * m; ++i) {
        b->particles[b->count++] =
            (plumb_particle){ .position = { (plumb_real)(x + 0.25 + 0.5 * (i % n)),
                                            (plumb_real)(y + 0.25 + 0.5 * (i / n)) } };
    }
}

static void build(bench *b)
{
    b->scratch.grid.h = 1;
    b->scratch.grid.kernels = pl_liquid_kernels_for(4);
    assert_true(pl_liquid_find_spots(&b->memory, &b->scratch, b->particles, b->count));
    assert_true(pl_liquid_grid_build(&b->memory, &b->scratch, b->particles, b->count));
}

// A box as a solid.
static pl_liquid_solid box(double x0, double y0, double x1, double y1)
{
    pl_liquid_solid s = { .body = PL_LIQUID_NONE, .count = 4 };
    const double x[] = { x0, x1, x1, x0 }, y[] = { y0, y0, y1, y1 };
    memcpy(s.x, x, sizeof x);
    memcpy(s.y, y, sizeof y);
    pl_liquid_find_reach(&s);
    s.thin = fmin(x1 - x0, y1 - y0) < 1;
    return s;
}

static void to_grid(bench *b)
{
    assert_true(pl_liquid_sum_cells(&b->memory, &b->scratch));
    pl_liquid_to_grid(&b->scratch.grid);
}

static void put_solids(bench *b, const pl_liquid_solid *solids, uint32_t count)
{
    assert_true(pl_buffer_reserve(&b->memory, &b->scratch.solids, (count + 1) * sizeof *solids));
    if (count > 0) {
        memcpy(b->scratch.solids.data, solids, count * sizeof *solids);
    }
    b->scratch.grid.solids = b->scratch.solids.data;
    b->scratch.grid.solid_count = count;
    assert_true(pl_liquid_close_faces(&b->memory, &b->scratch));
}

//---- chords --------------------------------------------------------------------------------------

static void chords_are_exact(void **state)
{
    (void)state;
    double low, high;
    const double cx[] = { 1 }, cy[] = { 2 };
    assert_true(pl_chord(cx, cy, 1, 0.5, 1.3, &low, &high));
    assert_near(high - low, 0.8, 1e-12); // 2 sqrt(0.25 - 0.09)
    assert_false(pl_chord(cx, cy, 1, 0.5, 1.6, &low, &high));
    const double tx[] = { 0, 4, 0 }, ty[] = { 0, 0, 2 };
    assert_true(pl_chord(tx, ty, 3, 0, 1, &low, &high));
    assert_near(low, 0, 1e-12);
    assert_near(high, 1.5, 1e-12);
    // A slanting capsule: the chord of its sides is 2 r / cos.
    const double ax[] = { -5, 5 }, ay[] = { -5, 5 };
    assert_true(pl_chord(ax, ay, 2, 0.5, 0.25, &low, &high));
    assert_near(high - low, sqrt(2), 1e-12);
    assert_near((low + high) / 2, 0.25, 1e-12);
}

// Chords of rounded polygons against many points that are inside or not.
static void chords_hold_what_is_inside(void **state)
{
    (void)state;
    uint32_t r = 7;
    for (int k = 0; k < 200; ++k) {
        const double x[] = { 0, 2 + sim_uniform(&r, 0, 1), sim_uniform(&r, 0, 1) };
        const double y[] = { sim_uniform(&r, 0, 1), 0.2, 2 };
        const double radius = k % 2 == 0 ? sim_uniform(&r, 0, 1) : 0;
        const double at = -1 + 5 * sim_uniform(&r, 0, 1);
        double low, high;
        const bool meets = pl_chord(x, y, 3, radius, at, &low, &high);
        const plumb_vec2 p[] = { { (plumb_real)x[0], (plumb_real)y[0] },
                                 { (plumb_real)x[1], (plumb_real)y[1] },
                                 { (plumb_real)x[2], (plumb_real)y[2] } };
        plumb_convex shape;
        assert_int_equal(plumb_convex_polygon(p, 3, (plumb_real)radius, &shape), PLUMB_OK);
        for (int i = 0; i < 40; ++i) {
            const double at_y = -2 + 6 * sim_uniform(&r, 0, 1);
            const bool inside =
                plumb_convex_contains(&shape, (plumb_vec2){ (plumb_real)at, (plumb_real)at_y });
            const bool near_end = meets && (fabs(at_y - low) < 1e-4 || fabs(at_y - high) < 1e-4);
            assert_true(near_end || inside == (meets && at_y > low && at_y < high));
        }
    }
}

// Many lines at once have the chords that each has: of boxes whose sides may lie on lines, of other polygons, of round ones.
static void chords_of_many_lines_are_those_of_each(void **state)
{
    (void)state;
    uint32_t r = 11;
    double met = 0, missed = 0;
    for (int k = 0; k < 300; ++k) {
        const int n = 1 + k % 8;
        const double turn = k % 2 == 0 ? SIM_PI / 4 : sim_uniform(&r, 0, 7);
        const double size = k % 2 == 0 ? sqrt(8) : sim_uniform(&r, 0.1, 6);
        const double radius = n < 3 || k % 3 == 0 ? sim_uniform(&r, 0.1, 2) : 0;
        double x[8], y[8], at[16], low[16], high[16];
        for (int i = 0; i < n; ++i) {
            x[i] = 5 + size * cos(turn + 2 * SIM_PI * i / n);
            y[i] = size * sin(turn + 2 * SIM_PI * i / n);
        }
        for (int i = 0; i < 16; ++i) {
            at[i] = k % 4 < 2 ? i : (i + sim_uniform(&r, 0, 1)) * 0.7;
        }
        pl_chords(x, y, n, radius, at, 16, low, high);
        for (int i = 0; i < 16; ++i) {
            double from, to;
            const bool meets = pl_chord(x, y, n, radius, at[i], &from, &to);
            assert_int_equal(low[i] <= high[i], meets);
            if (meets) {
                assert_near(low[i], from, 1e-12);
                assert_near(high[i], to, 1e-12);
            }
            met += meets, missed += !meets;
        }
    }
    assert_true(met > 500 && missed > 500);
}

//---- tiles ---------------------------------------------------------------------------------------

static void tiles_lie_where_particles_are(void **state)
{
    (void)state;
    bench b;
    open_bench(&b);
    add_lattice(&b, 8, 8, -2, -2);
    add_lattice(&b, 2, 2, 100000, -300000); // a world has no end
    build(&b);
    const pl_liquid_grid *g = &b.scratch.grid;
    assert_in_range(g->tile_count, 5, 8);
    assert_int_equal(g->first[g->cell_count], b.count);
    const uint32_t c = pl_liquid_cell_at(g, -1, 0);
    assert_true(c != 0);
    assert_int_equal(g->first[c + 1] - g->first[c], 4);
    assert_int_equal(g->right[c], pl_liquid_cell_at(g, 0, 0));
    assert_int_equal(g->down[c], pl_liquid_cell_at(g, -1, -1));
    assert_int_equal(g->left[g->right[c]], c);
    assert_int_equal(g->up[g->down[c]], c);
    assert_int_equal(pl_liquid_cell_at(g, 5000, 0), 0);
    const uint32_t far = pl_liquid_cell_at(g, 100000, -300000);
    assert_int_equal(g->first[far + 1] - g->first[far], 4);
    close_bench(&b);
}

// What kernels reach from any particle is there, and no tile is there without one that reaches it.
static void tiles_are_those_that_particles_reach(void **state)
{
    (void)state;
    uint32_t r = 5;
    for (int round = 0; round < 30; ++round) {
        bench b;
        open_bench(&b);
        const int n = 1 + round;
        for (int i = 0; i < n; ++i) {
            add_lattice(&b, 1, 1, sim_uniform(&r, -40, 40), sim_uniform(&r, -40, 40));
        }
        build(&b);
        const pl_liquid_grid *g = &b.scratch.grid;
        bool reached[16][16] = { { false } };
        for (int i = 0; i < n; ++i) {
            near_real unused;
            const int32_t x = pl_liquid_floor((double)b.particles[i].position.x, &unused);
            const int32_t y = pl_liquid_floor((double)b.particles[i].position.y, &unused);
            for (int32_t dx = -PL_LIQUID_REACH; dx <= PL_LIQUID_REACH; ++dx) {
                for (int32_t dy = -PL_LIQUID_REACH; dy <= PL_LIQUID_REACH; ++dy) {
                    assert_true(pl_liquid_cell_at(g, x + dx, y + dy) != 0);
                    reached[pl_liquid_tile_of(x + dx) + 8][pl_liquid_tile_of(y + dy) + 8] = true;
                }
            }
        }
        uint32_t count = 0;
        for (int i = 0; i < 256; ++i) {
            count += reached[i / 16][i % 16];
        }
        assert_int_equal(g->tile_count, count);
        close_bench(&b);
    }
}

//---- transfer ------------------------------------------------------------------------------------

// A linear field goes to faces and back unchanged.
static void linear_fields_survive_the_way(void **state)
{
    (void)state;
    bench b;
    open_bench(&b);
    add_lattice(&b, 24, 24, 0, 0);
    for (uint32_t i = 0; i < b.count; ++i) {
        plumb_particle *p = &b.particles[i];
        p->velocity = plumb_v2(1 + 2 * p->position.x - 3 * p->position.y,
                               2 - p->position.x + p->position.y / 2);
        const plumb_real gradient[] = { 2, -3, -1, PLUMB_REAL(0.5) };
        memcpy(p->gradient, gradient, sizeof gradient);
    }
    build(&b);
    pl_liquid_grid *g = &b.scratch.grid;
    put_solids(&b, NULL, 0);
    to_grid(&b);
    for (uint32_t c = 0; c < g->cell_count; ++c) { // displacements are any other field
        g->new_u[c] = 2 * g->u[c];
        g->new_v[c] = 3 * g->v[c];
    }
    int inner = 0;
    for (uint32_t k = 0; k < g->point_count; ++k) {
        const plumb_particle *p = &b.particles[g->points[k].index];
        pl_liquid_flow flow;
        pl_liquid_find_flow(g, &g->points[k], &flow);
        if (p->position.x > 1 && p->position.x < 11 && p->position.y > 1 && p->position.y < 11) {
            ++inner;
            const double u = (double)p->velocity.x, v = (double)p->velocity.y;
            const double value[] = { u, v, 2 * u, 3 * v };
            const double along_x[] = { 2, -1, 4, -3 }, along_y[] = { -3, 0.5, -6, 1.5 };
            for (int i = 0; i < 4; ++i) {
                assert_near((double)flow.value[i], value[i], 200 * TOLERANCE);
                assert_near((double)flow.along_x[i], along_x[i], 200 * TOLERANCE);
                assert_near((double)flow.along_y[i], along_y[i], 200 * TOLERANCE);
            }
        }
    }
    assert_int_equal(inner, 400);
    close_bench(&b);
}

//---- faces ---------------------------------------------------------------------------------------

static void faces_close_as_far_as_they_are_covered(void **state)
{
    (void)state;
    bench b;
    open_bench(&b);
    add_lattice(&b, 16, 16, 0, 0);
    build(&b);
    const pl_liquid_solid solids[] = { box(-3, -3, 20, 0.25), box(5.4, 1, 5.6, 4) };
    put_solids(&b, solids, 2);
    const pl_liquid_grid *g = &b.scratch.grid;
    const uint32_t c = pl_liquid_cell_at(g, 3, 0);
    assert_near((double)g->open_u[c], 0.75, TOLERANCE);
    assert_near((double)g->cover[c], 0.25, TOLERANCE);
    assert_near((double)g->open_v[c], 0, TOLERANCE);
    assert_near((double)g->open_v[g->up[c]], 1, TOLERANCE);
    // The thin wall crosses the way from the centre of cell 4 to that of 5, and the one of 5 to that of 6: here it
    // stands on the centre of 5.
    const uint32_t wall = pl_liquid_cell_at(g, 5, 2);
    assert_true(g->open_u[wall] == 0 && g->open_u[g->right[wall]] == 0);
    assert_true(g->open_u[g->left[wall]] == 1);
    close_bench(&b);
}

// The side of a cliff: on most lines it begins more cells above the tile than an int can count.
static void steep_solids_close_nothing_below_them(void **state)
{
    (void)state;
    bench b;
    open_bench(&b);
    add_lattice(&b, 16, 16, 0, 0);
    build(&b);
    pl_liquid_solid s = { .body = PL_LIQUID_NONE, .count = 3 };
    const double x[] = { -1, 20, -2 }, y[] = { -1, 4e12, 4e12 };
    memcpy(s.x, x, sizeof x);
    memcpy(s.y, y, sizeof y);
    pl_liquid_find_reach(&s);
    for (int k = 0; k < 2; ++k) {
        s.thin = k > 0;
        put_solids(&b, &s, 1);
        const uint32_t c = pl_liquid_cell_at(&b.scratch.grid, 5, 5);
        assert_true(b.scratch.grid.open_u[c] == 1 && b.scratch.grid.open_v[c] == 1);
    }
    close_bench(&b);
}

//---- projection ----------------------------------------------------------------------------------

static double worst_divergence(const pl_liquid_grid *g)
{
    double worst = 0;
    for (uint32_t c = 1; c < g->cell_count; ++c) {
        const uint32_t r = g->right[c], u = g->up[c];
        const double flow = (double)(g->open_u[r] * g->u[r] - g->open_u[c] * g->u[c] +
                                     g->open_v[u] * g->v[u] - g->open_v[c] * g->v[c]);
        worst = g->row[c] != 0 ? fmax(worst, fabs(flow)) : worst;
    }
    return worst;
}

static void projection_leaves_no_divergence(void **state)
{
    (void)state;
    bench b;
    open_bench(&b);
    add_lattice(&b, 40, 24, 0, 0);
    uint32_t r = 3;
    for (uint32_t i = 0; i < b.count; ++i) {
        b.particles[i].velocity =
            plumb_v2((plumb_real)sim_uniform(&r, 0, 1), (plumb_real)sim_uniform(&r, 0, 1));
    }
    build(&b);
    const pl_liquid_solid solids[] = { box(-3, -3, 30, 0), box(-3, 0, 0, 30), box(20, 0, 24, 30),
                                       box(7, 3, 9.5, 6.25) };
    put_solids(&b, solids, 4);
    pl_liquid_grid *g = &b.scratch.grid;
    to_grid(&b);
    assert_true(pl_liquid_plan(&b.memory, &b.scratch));
    const double before = worst_divergence(g);
    assert_true(pl_liquid_project(&b.memory, &b.scratch, 1000));
    print_message("divergence %.2g before, %.2g behind\n", before, worst_divergence(g));
    assert_true(before > 0.1 && worst_divergence(g) < 2e-5 * before + TOLERANCE);
    close_bench(&b);
}

// Under gravity the pressure is that of the depth, and nothing flows.
static void pressure_is_hydrostatic(void **state)
{
    (void)state;
    bench b;
    open_bench(&b);
    add_lattice(&b, 16, 20, 0, 0);
    build(&b);
    const pl_liquid_solid solids[] = { box(-3, -3, 30, 0), box(-3, 0, 0, 30), box(8, 0, 12, 30) };
    put_solids(&b, solids, 3);
    pl_liquid_grid *g = &b.scratch.grid;
    to_grid(&b);
    assert_true(pl_liquid_plan(&b.memory, &b.scratch));
    pl_liquid_accelerate(g, 0, -1);
    assert_true(pl_liquid_project(&b.memory, &b.scratch, 1000));
    for (int j = 0; j < 10; ++j) {
        const uint32_t c = pl_liquid_cell_at(g, 3, j);
        assert_near((double)g->vectors[PL_LIQUID_P][g->row[c]], 9.5 - j, 1e-3);
        assert_near((double)g->v[g->up[c]], 0, 1e-3);
    }
    close_bench(&b);
}

static void density_is_one_in_the_midst(void **state)
{
    (void)state;
    bench b;
    open_bench(&b);
    add_lattice(&b, 16, 16, 0, 0);
    build(&b);
    const pl_liquid_solid solids[] = { box(-3, -3, 30, 0), box(-3, 0, 0, 30), box(8, 0, 12, 30) };
    put_solids(&b, solids, 3);
    pl_liquid_grid *g = &b.scratch.grid;
    to_grid(&b);
    for (int j = 0; j < 7; ++j) { // along the wall too, and in the corner
        assert_near((double)g->density[pl_liquid_cell_at(g, 0, j)], 1, TOLERANCE);
        assert_near((double)g->density[pl_liquid_cell_at(g, 4, j)], 1, TOLERANCE);
    }
    assert_true(pl_liquid_plan(&b.memory, &b.scratch));
    const uint32_t top = pl_liquid_cell_at(g, 4, 7);
    assert_near((double)pl_liquid_gap(g, top, g->up[top]), 0.5, TOLERANCE);
    close_bench(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chords_are_exact),
        cmocka_unit_test(chords_hold_what_is_inside),
        cmocka_unit_test(chords_of_many_lines_are_those_of_each),
        cmocka_unit_test(tiles_lie_where_particles_are),
        cmocka_unit_test(tiles_are_those_that_particles_reach),
        cmocka_unit_test(linear_fields_survive_the_way),
        cmocka_unit_test(faces_close_as_far_as_they_are_covered),
        cmocka_unit_test(steep_solids_close_nothing_below_them),
        cmocka_unit_test(projection_leaves_no_divergence),
        cmocka_unit_test(pressure_is_hydrostatic),
        cmocka_unit_test(density_is_one_in_the_midst),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
