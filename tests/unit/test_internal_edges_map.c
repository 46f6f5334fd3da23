// test_internal_edges_map.c - maps of cells as tiles: corners and stretches are those of the outline of their union, whatever
// comes and goes.
#include "internal_edges_fixture.h"

#define SIDE 9 // cells

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

static bool corner_allows(const map *m, int x, int y, double nx, double ny)
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
            // Normals are asked at a corner only where the piece alone allows them.
            static const double ax[] = { -1, 1, 1, -1 }, ay[] = { -1, -1, 1, 1 };
            if (nx * ax[k] < -1e-9 || ny * ay[k] < -1e-9) {
                continue;
            }
            assert_int_equal(pl_side_corner_allows(&side, k, nx, ny),
                             corner_allows(m, cx[k], cy[k], nx, ny));
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
    plumb_body_set_no_sleep(m.w, ball, true); // while all sleep, nobody asks for internal edges
    // While somebody sleeps, what is to be seen anew loses its box at once.
    plumb_body sleeper =
        plumb_body_create(m.w, &(plumb_body_desc){ .position = sim_vec(-300, 50), .asleep = true });
    assert_false(plumb_is_null(sleeper));
    fill_map(&m, &seed, 1, PLUMB_STATIC);
    for (int round = 0; round < 400; ++round) {
        int i = (int)(sim_random(&seed) % (unsigned)m.count);
        int x = 1 + (int)(sim_random(&seed) % SIDE), y = 1 + (int)(sim_random(&seed) % SIDE);
        plumb_shape shape;
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
                if (round % 3 > 0) {
                    plumb_shape_set_filter(m.w, shape, (plumb_filter){ .category = 2 });
                    plumb_shape_set_filter(m.w, shape, (plumb_filter){ 0 });
                }
                if (round % 2 > 0) {
                    plumb_body_teleport(m.w, b, sim_vec(500, 0), 0);
                }
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
    assert_int_equal(w->internal_edges.updated, 10000);
    assert_int_equal(w->internal_edges.count, 10000);
    for (int i = 10; i < 90; i += 4) {
        uint64_t before = w->internal_edges.updated;
        plumb_body_destroy(w, tile[i]);
        take_a_step(w);
        assert_int_equal(w->internal_edges.updated - before, 8);
    }
    uint64_t before = w->internal_edges.updated;
    for (int i = 0; i < 10; ++i) {
        take_a_step(w);
    }
    assert_int_equal(w->internal_edges.updated, before);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_have_the_outline_of_their_union),
        cmocka_unit_test(changes_are_followed),
        cmocka_unit_test(digging_is_local),
        cmocka_unit_test(overlaps_cover_what_they_contain),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
