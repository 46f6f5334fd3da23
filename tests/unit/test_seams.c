// test_seams.c - what neighbours cover and what corners admit, against brute force: random maps of
// cells, where a raster tells the outline of the union; random overlapping boxes, where points do; and
// every change of the ground, which must leave the same as a world made anew.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "harness/sim.h"
#include "seams/admit.h"
#include "seams/neighbour.h"
#include "seams/span.h"
#include "world/state.h"

#define SIDE 9 // cells
#define HZ60 (1 / 60.0)

//---- cones ---------------------------------------------------------------------------------------

static pl_cone arc(double from, double to)
{
    return (pl_cone){ cos(from), sin(from), cos(to), sin(to), PL_CONE_ARC };
}

// Every arc of whole steps of 30 degrees against every other, asked at every half step.
static void cones_meet_as_sets_do(void **state)
{
    (void)state;
    const double step = SIM_PI / 6;
    for (int a = 0; a < 12; ++a) {
        for (int wide_a = 0; wide_a <= 6; ++wide_a) {
            for (int b = 0; b < 12; ++b) {
                for (int wide_b = 0; wide_b <= 6; ++wide_b) {
                    pl_cone p = arc(a * step, (a + wide_a) * step);
                    pl_cone q = arc(b * step, (b + wide_b) * step);
                    pl_cone both = pl_cone_meet(&p, &q, 1e-3);
                    for (int k = 0; k < 24; ++k) {
                        bool in_p = (k - 2 * a + 48) % 24 <= 2 * wide_a;
                        bool in_q = (k - 2 * b + 48) % 24 <= 2 * wide_b;
                        double x = cos(k * step / 2), y = sin(k * step / 2);
                        assert_int_equal(pl_cone_admits(&p, x, y, 1e-9), in_p);
                        assert_int_equal(pl_cone_admits(&both, x, y, 1e-9), in_p && in_q);
                    }
                }
            }
        }
    }
}

static void nearly_flat_is_flat(void **state)
{
    (void)state;
    for (int i = -1; i <= 1; ++i) { // the neighbour rises, is flush, falls by half the tolerance
        pl_cone own = arc(0, SIM_PI / 2), next = arc(SIM_PI / 2 + i * 5e-4, SIM_PI);
        pl_cone met = pl_cone_meet(&own, &next, PL_SEAM_ANGLE);
        assert_true(pl_cone_is_flat(&met) && met.form == PL_CONE_ARC);
        assert_true(met.lo_x == own.hi_x && met.lo_y == own.hi_y);
    }
    pl_cone own = arc(0, SIM_PI / 2), inner = arc(SIM_PI / 2 + 0.01, SIM_PI);
    assert_int_equal(pl_cone_meet(&own, &inner, PL_SEAM_ANGLE).form, PL_CONE_NONE);
    pl_cone outer = arc(SIM_PI / 2 - 0.01, SIM_PI);
    pl_cone met = pl_cone_meet(&own, &outer, PL_SEAM_ANGLE);
    assert_true(met.form == PL_CONE_ARC && !pl_cone_is_flat(&met));
    // Two lines end to end: both sides, not what lies between.
    pl_cone left = arc(-SIM_PI / 2, SIM_PI / 2), right = arc(SIM_PI / 2, 3 * SIM_PI / 2);
    met = pl_cone_meet(&left, &right, PL_SEAM_ANGLE);
    assert_int_equal(met.form, PL_CONE_ENDS);
    assert_true(pl_cone_is_flat(&met) && pl_cone_admits(&met, 0, 1, 1e-9) &&
                pl_cone_admits(&met, 0, -1, 1e-9) && !pl_cone_admits(&met, 1, 0, 1e-9) &&
                !pl_cone_admits(&met, -1, 0, 1e-9));
    // A third that hangs from there takes the lower side.
    pl_cone hanging = arc(0, SIM_PI);
    met = pl_cone_meet(&met, &hanging, PL_SEAM_ANGLE);
    assert_true(met.form == PL_CONE_ARC && pl_cone_admits(&met, 0, 1, 1e-9) &&
                !pl_cone_admits(&met, 0, -1, 1e-9));
}

//---- stretches -----------------------------------------------------------------------------------

static void stretches_are_merged(void **state)
{
    (void)state;
    unsigned seed = 7;
    for (int round = 0; round < 300; ++round) {
        pl_span spans[40];
        bool covered[400] = { false };
        uint32_t count = sim_random(&seed) % 40;
        for (uint32_t i = 0; i < count; ++i) {
            uint32_t from = sim_random(&seed) % 380, to = from + 1 + sim_random(&seed) % 19;
            spans[i] = (pl_span){ (real)from, (real)to };
            memset(covered + from, true, to - from);
        }
        uint32_t merged = pl_spans_merge(spans, count);
        for (uint32_t i = 0; i + 1 < merged; ++i) {
            assert_true(spans[i].to < spans[i + 1].from);
        }
        for (int k = 0; k < 400; ++k) {
            assert_int_equal(pl_spans_leave_open(spans, merged, k + 0.5, k + 0.5), !covered[k]);
        }
        for (int k = 0; k < 50; ++k) {
            uint32_t low = sim_random(&seed) % 400, high = low + sim_random(&seed) % (400 - low);
            bool open = false;
            for (uint32_t c = low; c <= high; ++c) {
                open |= !covered[c];
            }
            assert_int_equal(pl_spans_leave_open(spans, merged, low + 0.5, high + 0.5), open);
        }
    }
}

//---- maps of cells -------------------------------------------------------------------------------

typedef struct map {
    bool filled[SIDE + 2][SIDE + 2]; // with an empty rim
    plumb_world *w;
    double angle, x, y, size; // of the whole map
    plumb_body body[SIDE * SIDE];
    int at[SIDE * SIDE], row[SIDE * SIDE], wide[SIDE * SIDE]; // in cells
    int count;
} map;

static plumb_vec2 on_map(const map *m, double x, double y)
{
    double c = cos(m->angle), s = sin(m->angle);
    x *= m->size, y *= m->size;
    return sim_vec(m->x + c * x - s * y, m->y + s * x + c * y);
}

// Runs of filled cells become boxes of 1 to `widest` cells, each a static body, or all one body that
// moves.
static void fill_map(map *m, unsigned *seed, int widest, plumb_body_type type)
{
    plumb_body whole = PLUMB_NULL_INIT;
    m->count = 0;
    if (type != PLUMB_STATIC) {
        whole = sim_body(m->w, type, m->x, m->y, m->angle);
    }
    for (int y = 1; y <= SIDE; ++y) {
        for (int x = 1; x <= SIDE; ++x) {
            if (!m->filled[y][x]) {
                continue;
            }
            int wide = 1, most = 1 + (int)(sim_random(seed) % (unsigned)widest);
            while (wide < most && m->filled[y][x + wide]) {
                ++wide;
            }
            plumb_shape_desc desc = { .kind = PLUMB_BOX,
                                      .half = sim_vec(m->size * wide / 2, m->size / 2) };
            plumb_body b = whole;
            if (type == PLUMB_STATIC) {
                plumb_vec2 p = on_map(m, x + wide / 2.0, y + 0.5);
                b = sim_body(m->w, type, (double)p.x, (double)p.y, m->angle);
            } else {
                desc.center = sim_vec(m->size * (x + wide / 2.0), m->size * (y + 0.5));
            }
            assert_true(plumb_shape_valid(m->w, plumb_shape_create(m->w, b, &desc)));
            m->body[m->count] = b;
            m->at[m->count] = x, m->row[m->count] = y, m->wide[m->count] = wide;
            ++m->count;
            x += wide - 1;
        }
    }
}

// A falling ball far away wants collision, so that the passes run.
static void take_a_step(plumb_world *w)
{
    sim_step(w, HZ60);
}

static uint32_t piece_of(const map *m, int i)
{
    // One shape a body, or the i-th oldest shape of the one body.
    uint32_t row = pl_body_row(m->w, m->body[i]);
    uint32_t p = m->w->bodies.first_piece[row];
    for (int k = m->count - 1 - i; m->w->bodies.type[row] != PLUMB_STATIC && k > 0; --k) {
        p = m->w->pieces.next_in_body[p];
    }
    return p;
}

// The four cells around lattice point (x, y): lower left, lower right, upper right, upper left.
static bool cell_at(const map *m, int x, int y, int quadrant)
{
    static const int dx[] = { -1, 0, 0, -1 }, dy[] = { -1, -1, 0, 0 };
    return m->filled[y + dy[quadrant]][x + dx[quadrant]];
}

static bool corner_admits(const map *m, int x, int y, double nx, double ny)
{
    static const double ex[4][2] = { { -1, 0 }, { 1, 0 }, { 1, 0 }, { -1, 0 } };
    static const double ey[4][2] = { { 0, -1 }, { 0, -1 }, { 0, 1 }, { 0, 1 } };
    for (int q = 0; q < 4; ++q) {
        for (int e = 0; e < 2 && cell_at(m, x, y, q); ++e) {
            if (ex[q][e] * nx + ey[q][e] * ny > 1e-9) {
                return false;
            }
        }
    }
    return true;
}

static void check_piece(const map *m, int i)
{
    pl_side side = pl_side_of(m->w, piece_of(m, i));
    assert_int_equal(side.count, 4);
    int x0 = m->at[i], x1 = x0 + m->wide[i], y0 = m->row[i], y1 = y0 + 1;
    const int cx[] = { x0, x1, x1, x0 }, cy[] = { y0, y0, y1, y1 };
    for (int k = 0; k < 4; ++k) {
        int cells = k % 2 == 0 ? m->wide[i] : 1;
        int dx = k == 0 ? 1 : k == 2 ? -1 : 0, dy = k == 1 ? 1 : k == 3 ? -1 : 0;
        for (int c = 0; c < cells; ++c) {
            // The cell in front of the c-th unit of edge k.
            int x = cx[k] + dx * c + (dx < 0 ? -1 : 0) + (k == 3 ? -1 : 0);
            int y = cy[k] + dy * c + (dy < 0 ? -1 : 0) + (k == 0 ? -1 : 0);
            double at = (c + 0.5) * m->size;
            assert_int_equal(pl_side_edge_is_open(&side, k, at, at), !m->filled[y][x]);
        }
        for (int d = 0; d < 16; ++d) {
            double nx = cos(d * SIM_PI / 8), ny = sin(d * SIM_PI / 8);
            // Normals are asked at a corner only where the piece alone admits them.
            static const double ax[] = { -1, 1, 1, -1 }, ay[] = { -1, -1, 1, 1 };
            if (nx * ax[k] < -1e-9 || ny * ay[k] < -1e-9) {
                continue;
            }
            assert_int_equal(pl_side_corner_admits(&side, k, nx, ny),
                             corner_admits(m, cx[k], cy[k], nx, ny));
        }
    }
}

static void check_map(const map *m)
{
    for (int i = 0; i < m->count; ++i) {
        check_piece(m, i);
    }
}

static void random_cells(map *m, unsigned *seed, double density)
{
    memset(m->filled, 0, sizeof m->filled);
    for (int y = 1; y <= SIDE; ++y) {
        for (int x = 1; x <= SIDE; ++x) {
            m->filled[y][x] = sim_uniform(seed, 0, 1) < density;
        }
    }
}

static void maps_have_the_outline_of_their_union(void **state)
{
    (void)state;
    unsigned seed = 12345;
    for (int round = 0; round < 120; ++round) {
        map m = { .size = exp(sim_uniform(&seed, log(0.1), log(4))) };
        m.angle = round % 3 == 0 ? 0 : sim_uniform(&seed, -3, 3);
        double far = round % 4 == 3 ? 1e4 : 10; // in float, positions there are a millimetre apart
        m.size = far > 10 ? 1 : m.size;
        m.x = sim_uniform(&seed, -far, far), m.y = sim_uniform(&seed, -far, far);
        random_cells(&m, &seed, sim_uniform(&seed, 0.3, 0.95));
        m.w = sim_space();
        sim_ball(m.w, -300, 0, 0.5, sim_material(m.w, 0, 0));
        fill_map(&m, &seed, round % 2 == 0 ? 1 : 5,
                 round % 5 == 4 ? PLUMB_KINEMATIC : PLUMB_STATIC);
        take_a_step(m.w);
        check_map(&m);
        plumb_world_destroy(m.w);
    }
}

//---- changes -------------------------------------------------------------------------------------

// Takes tile i out of the map's lists.
static void forget_tile(map *m, int i)
{
    for (int c = 0; c < m->wide[i]; ++c) {
        m->filled[m->row[i]][m->at[i] + c] = false;
    }
    --m->count;
    m->body[i] = m->body[m->count];
    m->at[i] = m->at[m->count], m->row[i] = m->row[m->count], m->wide[i] = m->wide[m->count];
}

static void put_tile(map *m, int x, int y)
{
    plumb_vec2 p = on_map(m, x + 0.5, y + 0.5);
    plumb_body b = sim_body(m->w, PLUMB_STATIC, (double)p.x, (double)p.y, m->angle);
    sim_add_box(m->w, b, m->size / 2, m->size / 2, sim_material(m->w, 0.5, 0));
    m->body[m->count] = b;
    m->at[m->count] = x, m->row[m->count] = y, m->wide[m->count] = 1;
    m->filled[y][x] = true;
    ++m->count;
}

// Tiles are dug out, put back, teleported, turned into sensors, given other filters, disabled, given
// another type: after each step the map is as if it had been made that way.
static void changes_are_followed(void **state)
{
    (void)state;
    unsigned seed = 99;
    map m = { .size = 0.5, .angle = 0.4 };
    random_cells(&m, &seed, 0.8);
    m.w = sim_space();
    plumb_body ball = sim_ball(m.w, -300, 0, 0.5, sim_material(m.w, 0, 0));
    plumb_body_set_no_sleep(m.w, ball, true); // while all sleep, nobody asks for seams
    fill_map(&m, &seed, 1, PLUMB_STATIC);
    for (int round = 0; round < 400; ++round) {
        int i = (int)(sim_random(&seed) % (unsigned)m.count);
        int x = 1 + (int)(sim_random(&seed) % SIDE), y = 1 + (int)(sim_random(&seed) % SIDE);
        plumb_entity shape;
        assert_int_equal(plumb_body_shapes(m.w, m.body[i], &shape, 1), 1);
        const unsigned change = sim_random(&seed) % 7;
        switch (change) {
        case 0:
            plumb_body_destroy(m.w, m.body[i]);
            forget_tile(&m, i);
            break;
        case 1:
            if (!m.filled[y][x]) {
                put_tile(&m, x, y);
            }
            break;
        case 2:
            if (!m.filled[y][x]) { // from where it is to an empty cell
                plumb_vec2 p = on_map(&m, x + 0.5, y + 0.5);
                plumb_body b = m.body[i];
                plumb_body_teleport(m.w, b, p, (plumb_real)m.angle);
                forget_tile(&m, i);
                m.body[m.count] = b;
                m.at[m.count] = x, m.row[m.count] = y, m.wide[m.count] = 1;
                m.filled[y][x] = true;
                ++m.count;
            }
            break;
        case 3: // out and back again, a step between
            plumb_shape_set_sensor(m.w, shape, true);
            m.filled[m.row[i]][m.at[i]] = false;
            take_a_step(m.w);
            for (int k = 0; k < m.count; ++k) {
                if (k != i) {
                    check_piece(&m, k);
                }
            }
            plumb_shape_set_sensor(m.w, shape, false);
            m.filled[m.row[i]][m.at[i]] = true;
            break;
        case 4:
            plumb_shape_set_filter(m.w, shape, (plumb_filter){ .category = 2 });
            m.filled[m.row[i]][m.at[i]] = false;
            take_a_step(m.w);
            for (int k = 0; k < m.count; ++k) {
                if (k != i) {
                    check_piece(&m, k);
                }
            }
            plumb_shape_set_filter(m.w, shape, (plumb_filter){ 0 });
            m.filled[m.row[i]][m.at[i]] = true;
            break;
        default: // disabled, or of another type, for a step
            if (change == 5) {
                plumb_body_set_enabled(m.w, m.body[i], false);
            } else {
                plumb_body_set_type(m.w, m.body[i], PLUMB_KINEMATIC);
            }
            m.filled[m.row[i]][m.at[i]] = false;
            take_a_step(m.w);
            for (int k = 0; k < m.count; ++k) {
                if (k != i) {
                    check_piece(&m, k);
                }
            }
            plumb_body_set_enabled(m.w, m.body[i], true);
            plumb_body_set_type(m.w, m.body[i], PLUMB_STATIC);
            m.filled[m.row[i]][m.at[i]] = true;
            break;
        }
        take_a_step(m.w);
        check_map(&m);
    }
    plumb_world_destroy(m.w);
}

// A tile dug out of 10,000 has its neighbours looked at, not the others.
static void digging_is_local(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_material m = sim_material(w, 0, 0);
    sim_ball(w, -300, 0, 0.5, m);
    plumb_body tile[100];
    for (int y = 0; y < 100; ++y) {
        for (int x = 0; x < 100; ++x) {
            plumb_body b = sim_body(w, PLUMB_STATIC, x, y, 0);
            sim_add_box(w, b, 0.5, 0.5, m);
            if (y == 50) {
                tile[x] = b;
            }
        }
    }
    take_a_step(w);
    assert_int_equal(w->seams.updated, 10000);
    assert_int_equal(w->seams.count, 10000);
    for (int i = 10; i < 90; i += 4) {
        uint64_t before = w->seams.updated;
        plumb_body_destroy(w, tile[i]);
        take_a_step(w);
        assert_int_equal(w->seams.updated - before, 8);
    }
    uint64_t before = w->seams.updated;
    for (int i = 0; i < 10; ++i) {
        take_a_step(w);
    }
    assert_int_equal(w->seams.updated, before);
    plumb_world_destroy(w);
}

//---- overlapping boxes ---------------------------------------------------------------------------

// Points along every edge: covered when the point a little in front of it lies in another box.
static void overlaps_cover_what_they_contain(void **state)
{
    (void)state;
    unsigned seed = 4242;
    int asked = 0, covered = 0;
    for (int round = 0; round < 60; ++round) {
        plumb_world *w = sim_space();
        plumb_material m = sim_material(w, 0, 0);
        sim_ball(w, -300, 0, 0.5, m);
        plumb_body b[12];
        plumb_shape shape[12];
        for (int i = 0; i < 12; ++i) {
            b[i] = sim_body(w, PLUMB_STATIC, sim_uniform(&seed, -1.5, 1.5),
                            sim_uniform(&seed, -1.5, 1.5), sim_uniform(&seed, -3, 3));
            sim_add_box(w, b[i], sim_uniform(&seed, 0.2, 1), sim_uniform(&seed, 0.2, 1), m);
            assert_int_equal(plumb_body_shapes(w, b[i], &shape[i], 1), 1);
        }
        take_a_step(w);
        for (int i = 0; i < 12; ++i) {
            uint32_t p = pl_shape_piece(w, shape[i]);
            pl_side side = pl_side_of(w, p);
            for (int k = 0; k < 4; ++k) {
                const pl_vertex *v = &side.corners[k],
                                *next = &side.corners[pl_side_next(&side, k)];
                for (int s = 0; s < 50; ++s) {
                    real t = (real)((s + 0.5) / 50);
                    plumb_vec2 at = { v->x + t * (next->x - v->x), v->y + t * (next->y - v->y) };
                    double along = hypot((double)(at.x - v->x), (double)(at.y - v->y));
                    // Where points within 5 mm to either side and 4 mm ahead agree, the slop does not
                    // matter.
                    int in = 0, out = 0;
                    for (int e = 0; e < 9; ++e) {
                        static const double heights[] = { 1.5e-5, 5e-4, 4e-3 };
                        real across = (real)(5e-3 * (e / 3 - 1)), ahead = (real)heights[e % 3];
                        plumb_vec2 q = { at.x + ahead * v->nx - across * v->ny,
                                         at.y + ahead * v->ny + across * v->nx };
                        q = plumb_body_world_point(w, b[i], q);
                        bool any = false;
                        for (int j = 0; j < 12; ++j) {
                            any |= j != i && plumb_shape_contains(w, shape[j], q);
                        }
                        in += any;
                        out += !any;
                    }
                    if (in == 0 || out == 0) {
                        assert_int_equal(pl_side_edge_is_open(&side, k, along, along), in == 0);
                        ++asked;
                        covered += in > 0;
                    }
                }
            }
        }
        plumb_world_destroy(w);
    }
    assert_true(asked > 100000 && covered > asked / 4 && covered < asked * 3 / 4);
}

//---- who is a neighbour --------------------------------------------------------------------------

typedef struct two_tiles {
    const char *name;
    double gap, rise; // [m] of the second tile
    double size;      // [m] of both
    double radius;    // [m] rounding of the second
    bool joined;
} two_tiles;

static void neighbours_are_within_the_slop(void **state)
{
    (void)state;
    const two_tiles cases[] = {
        { "touching", 0, 0, 1, 0, true },
        { "0.9 mm apart", 9e-4, 0, 1, 0, true },
        { "1.2 mm apart", 1.2e-3, 0, 1, 0, false },
        { "0.9 mm higher", 0, 9e-4, 1, 0, true },
        { "1.2 mm higher", 0, 1.2e-3, 1, 0, false },
        { "small ones 0.9 mm apart", 9e-4, 0, 0.05, 0, false },
        { "small ones 0.4 mm apart", 4e-4, 0, 0.05, 0, true },
        { "overlapping by 1 cm", -0.01, 0, 1, 0, true },
        { "one rounded", 0, 0, 1, 0.1, false },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const two_tiles *c = &cases[i];
        plumb_world *w = sim_space();
        plumb_material m = sim_material(w, 0, 0);
        sim_ball(w, -300, 0, 0.5, m);
        plumb_body a = sim_body(w, PLUMB_STATIC, 0, 0, 0);
        sim_add_box(w, a, c->size / 2, c->size / 2, m);
        plumb_body b = sim_body(w, PLUMB_STATIC, c->size + c->gap, c->rise, 0);
        plumb_shape_desc desc = { .kind = PLUMB_BOX,
                                  .half = sim_vec(c->size / 2 - c->radius, c->size / 2 - c->radius),
                                  .radius = (plumb_real)c->radius };
        plumb_shape_create(w, b, &desc);
        take_a_step(w);
        pl_side side = pl_side_of(w, w->bodies.first_piece[pl_body_row(w, a)]);
        bool flat = pl_side_edge_end(&side, 2, true) == PL_END_FLAT;
        print_message("%-24s %s\n", c->name, flat ? "one ground" : "two");
        assert_int_equal(flat, c->joined);
        // What lies in front of the side covers it even where the tops differ.
        plumb_world_destroy(w);
    }
}

static uint32_t tile_at(plumb_world *w, double x, plumb_body *b, plumb_material m)
{
    *b = sim_body(w, PLUMB_STATIC, x, 0, 0);
    sim_add_box(w, *b, 0.5, 0.5, m);
    return w->bodies.first_piece[pl_body_row(w, *b)];
}

// What something passes through is not one ground with what it meets.
static void passed_bodies_are_apart(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_material m = sim_material(w, 0, 0);
    plumb_body ball = sim_ball(w, -300, 0, 0.5, m), a, b, c;
    uint32_t p = tile_at(w, 0, &a, m), q = tile_at(w, 1, &b, m), r = tile_at(w, 2, &c, m);
    take_a_step(w);
    assert_true(pl_piece_has_seams(&w->pieces, p) && pl_piece_has_seams(&w->pieces, q));
    plumb_world_exclude_pair(w, a, ball, true);
    take_a_step(w);
    assert_true(!pl_piece_has_seams(&w->pieces, p) && pl_piece_has_seams(&w->pieces, q));
    plumb_joint joint = plumb_joint_create(
        w, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE, .body_a = c, .body_b = ball });
    take_a_step(w);
    assert_true(!pl_piece_has_seams(&w->pieces, q) && !pl_piece_has_seams(&w->pieces, r));
    assert_int_equal(w->seams.count, 0);
    plumb_joint_destroy(w, joint);
    take_a_step(w);
    assert_true(pl_piece_has_seams(&w->pieces, q) && pl_piece_has_seams(&w->pieces, r));
    plumb_world_destroy(w);
}

// A floor of two lines and a ramp: what stands at the end of which face.
static void walls_stand_at_inner_ends(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    sim_ball(w, -300, 0, 0.5, sim_material(w, 0, 0));
    plumb_vec2 p[] = { sim_vec(0, 0), sim_vec(1, 0), sim_vec(2, 0), sim_vec(3, 1) };
    plumb_shape_desc desc = { .kind = PLUMB_CHAIN, .points = p, .count = 4 };
    plumb_shape chain = plumb_shape_create(w, sim_body(w, PLUMB_STATIC, 0, 0, 0), &desc);
    take_a_step(w);
    uint32_t first = pl_shape_piece(w, chain), second = w->pieces.next_in_shape[first];
    uint32_t ramp = w->pieces.next_in_shape[second];
    // Edge 0 of a line is its right side, seen along it: the lower one; edge 1 runs back above.
    pl_side a = pl_side_of(w, first), b = pl_side_of(w, second), c = pl_side_of(w, ramp);
    assert_int_equal(pl_side_edge_end(&a, 1, false), PL_END_OUTER);
    assert_int_equal(pl_side_edge_end(&a, 1, true), PL_END_FLAT);
    assert_int_equal(pl_side_edge_end(&b, 1, false), PL_END_FLAT);
    assert_int_equal(pl_side_edge_end(&b, 1, true), PL_END_INNER);
    assert_int_equal(pl_side_edge_end(&c, 1, false), PL_END_INNER);
    assert_int_equal(pl_side_edge_end(&b, 0, false), PL_END_OUTER); // below, the bend is convex
    assert_int_equal(pl_side_edge_end(&c, 1, true), PL_END_OUTER);
    const real *up = b.seams[1].walls[1], *floor = c.seams[0].walls[0];
    assert_true(fabs((double)up[0] + sqrt(0.5)) < 1e-6 && fabs((double)up[1] - sqrt(0.5)) < 1e-6);
    assert_true(fabs((double)floor[0]) < 1e-6 && fabs((double)floor[1] - 1) < 1e-6);
    assert_true(pl_side_corner_is_flat(&a, 1) && !pl_side_corner_is_flat(&b, 1));
    plumb_world_destroy(w);
}

// The question for impacts, in world axes.
static void normals_are_asked_in_world_axes(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_material m = sim_material(w, 0, 0);
    sim_ball(w, -300, 0, 0.5, m);
    double angle = 0.7, c = cos(angle), s = sin(angle);
    uint32_t piece = PL_NONE;
    for (int i = -1; i <= 1; ++i) {
        plumb_body b = sim_body(w, PLUMB_STATIC, c * i, s * i, angle);
        sim_add_box(w, b, 0.5, 0.5, m);
        piece = i == 0 ? w->bodies.first_piece[pl_body_row(w, b)] : piece;
    }
    take_a_step(w);
    const pl_pose *pose = &pl_poses(w)[w->pieces.body[piece]];
    c = (double)pose->c, s = (double)pose->s; // as rounded: normals are compared to a few roundings
    assert_true(pl_seams_admit(w, piece, -s, c, -0.5 * s, 0.5 * c));    // the top
    assert_true(pl_seams_admit(w, piece, s, -c, 0.5 * s, -0.5 * c));    // the bottom
    assert_false(pl_seams_admit(w, piece, c, s, 0.5 * c, 0.5 * s));     // a covered side
    assert_false(pl_seams_admit(w, piece, -c, -s, -0.5 * c, -0.5 * s)); // the other
    double d = 0.1, nx = -s * cos(d) + c * sin(d), ny = c * cos(d) + s * sin(d);
    assert_false(pl_seams_admit(w, piece, nx, ny, 0, 0)); // leaning on a flat corner
    plumb_world_destroy(w);
}

// A body of several pieces has seams of its own. When it goes as the last one that has any, what was noted
// of its pairs goes too: they name places in a pair list that is no more.
static void what_was_noted_goes_with_the_last_seams(void **state)
{
    (void)state;
    enum { BALLS = 200 };
    for (int how = 0; how < 3; ++how) {
        plumb_world *w = sim_space();
        plumb_material m = sim_material(w, 0, 0);
        plumb_body floor = sim_floor(w, m), balls[BALLS];
        plumb_body tee = sim_body(w, PLUMB_DYNAMIC, 0, 0, 0);
        const plumb_vec2 outline[] = { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } };
        plumb_shape_desc desc = { .kind = PLUMB_OUTLINE, .points = outline, .count = 6, .material = m };
        plumb_shape shape = plumb_shape_create(w, tee, &desc);
        take_a_step(w); // few pairs
        for (int i = 0; i < BALLS; ++i) {
            balls[i] = sim_ball(w, 4 + i, 0.5, 0.4999, m);
        }
        take_a_step(w); // and many, in another buffer
        assert_true(w->seams.pair_count > 0);
        for (int i = 4; i < BALLS; ++i) {
            plumb_body_destroy(w, balls[i]);
        }
        if (how == 0) {
            plumb_body_destroy(w, tee);
        } else if (how == 1) {
            plumb_shape_destroy(w, shape);
        } else {
            plumb_body_set_enabled(w, tee, false);
        }
        for (int step = 0; step < 3; ++step) {
            take_a_step(w);
            assert_int_equal(w->seams.count, 0);
            assert_int_equal(w->seams.pair_count, 0);
        }
        assert_true(plumb_body_valid(w, floor));
        plumb_world_destroy(w);
    }
}

// A body of several pieces has its seams whether it is awake or asleep when they are looked for.
static void bodies_asleep_keep_their_seams(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    plumb_material m = sim_material(w, 0, 0);
    const plumb_vec2 outline[] = { { 0, 0 }, { 2, 0 }, { 2, 1 }, { 1, 1 }, { 1, 2 }, { 0, 2 } };
    const plumb_shape_desc desc = {
        .kind = PLUMB_OUTLINE, .points = outline, .count = 6, .material = m
    };
    sim_ball(w, -300, 0, 0.5, m);
    plumb_body bodies[2];
    for (int i = 0; i < 2; ++i) {
        bodies[i] = plumb_body_create(
            w, &(plumb_body_desc){ .position = sim_vec(10 * i, 0), .asleep = i == 1 });
        assert_true(plumb_shape_valid(w, plumb_shape_create(w, bodies[i], &desc)));
    }
    for (int round = 0; round < 3; ++round) {
        take_a_step(w);
        assert_int_equal(plumb_body_is_awake(w, bodies[1]), round == 2);
        uint32_t p = w->bodies.first_piece[pl_body_row(w, bodies[0])];
        uint32_t q = w->bodies.first_piece[pl_body_row(w, bodies[1])];
        for (; p != PL_NONE; p = w->pieces.next_in_body[p], q = w->pieces.next_in_body[q]) {
            assert_true(pl_piece_has_seams(&w->pieces, p));
            assert_int_equal(w->pieces.seam_corners[p], w->pieces.seam_corners[q]);
            assert_int_equal(w->pieces.seam_edges[p], w->pieces.seam_edges[q]);
        }
        w->seams.all = w->seams.dirty = true; // as after a restore
        w->schedule_dirty = true;
        if (round == 1) {
            plumb_body_wake(w, bodies[1]);
        }
    }
    plumb_world_destroy(w);
}

// A box that slides over tiles, beside boxes that fall asleep meanwhile: its pairs move up in the list,
// and what it bears, and on which tile, with them.
static plumb_world *tiles_and_sleepers(int sleepers, plumb_body *slider)
{
    plumb_world *w = sim_world(&(plumb_world_desc){ .sleep_time = (plumb_real)0.1 });
    plumb_material m = sim_material(w, 0.3, 0);
    for (int i = 0; i < 60; ++i) {
        plumb_body tile = sim_body(w, PLUMB_STATIC, 0.5 * i, -0.25, 0);
        sim_add_box(w, tile, 0.25, 0.25, m);
    }
    for (int i = 0; i < sleepers; ++i) {
        // Each rests a step later than the one before it.
        plumb_body b = sim_crate(w, 0.3 + 0.11 * i, 10 + 0.5, 0.04, 0.5, m);
        plumb_body shelf = sim_body(w, PLUMB_STATIC, 0.3 + 0.11 * i, 9, 0);
        sim_add_box(w, shelf, 0.05, 1, m);
        sim_launch(w, b, 0, 0.01 * i, 0);
    }
    *slider = sim_crate(w, 1, 0.4, 0.9, 0.4, m);
    plumb_body_set_no_sleep(w, *slider, true);
    sim_launch(w, *slider, 5, 0, 0);
    return w;
}

static void those_who_fall_asleep_change_nothing_for_others(void **state)
{
    (void)state;
    plumb_body with, alone;
    plumb_world *w = tiles_and_sleepers(40, &with), *v = tiles_and_sleepers(0, &alone);
    uint32_t asleep = 0, falls = 0;
    for (int step = 0; step < 200; ++step) {
        plumb_contact a[8], b[8];
        take_a_step(w);
        take_a_step(v);
        uint32_t now = plumb_world_stats(w).asleep_count;
        falls += now > asleep;
        asleep = now;
        assert_true(sim_x(w, with) == sim_x(v, alone) && sim_y(w, with) == sim_y(v, alone) &&
                    sim_angle(w, with) == sim_angle(v, alone));
        int count = plumb_body_contacts(w, with, a, 8);
        assert_int_equal(count, plumb_body_contacts(v, alone, b, 8));
        for (int i = 0; i < count; ++i) {
            assert_true(plumb_same(a[i].body_a, with) || plumb_same(a[i].body_b, with));
            assert_memory_equal(&a[i].normal, &b[i].normal, sizeof a[i].normal);
            assert_memory_equal(a[i].points, b[i].points, sizeof a[i].points);
        }
    }
    assert_true(falls > 5 && asleep == 40);
    plumb_world_destroy(w);
    plumb_world_destroy(v);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cones_meet_as_sets_do),
        cmocka_unit_test(nearly_flat_is_flat),
        cmocka_unit_test(stretches_are_merged),
        cmocka_unit_test(maps_have_the_outline_of_their_union),
        cmocka_unit_test(changes_are_followed),
        cmocka_unit_test(digging_is_local),
        cmocka_unit_test(overlaps_cover_what_they_contain),
        cmocka_unit_test(neighbours_are_within_the_slop),
        cmocka_unit_test(passed_bodies_are_apart),
        cmocka_unit_test(walls_stand_at_inner_ends),
        cmocka_unit_test(normals_are_asked_in_world_axes),
        cmocka_unit_test(what_was_noted_goes_with_the_last_seams),
        cmocka_unit_test(bodies_asleep_keep_their_seams),
        cmocka_unit_test(those_who_fall_asleep_change_nothing_for_others),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
