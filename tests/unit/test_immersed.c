// test_immersed.c - what of a shape is immersed, and its drag, against sums over many points.
#include "unit/geometry_fixture.h"

#include "geometry/immersed.h"

// Points in a square grid over the box around the shape.
#define GRID 400

typedef struct pose {
    plumb_convex shape;
    plumb_transform frame;
    double x, y;
    pl_half_plane by[3];
    int cuts;
} pose;

static pose random_pose(int kind)
{
    pose p = { .shape = random_shape(kind), .x = uniform(-3, 3), .y = uniform(-3, 3) };
    p.frame.p = random_point(3);
    plumb_sincos(R(uniform(-4, 4)), &p.frame.q);
    p.cuts = kind % 3 + 1;
    for (int i = 0; i < p.cuts; ++i) {
        const double angle = uniform(-4, 4);
        const plumb_aabb box = plumb_convex_aabb(&p.shape, p.frame);
        const double mx = (double)(box.min.x + box.max.x) / 2 - p.x;
        const double my = (double)(box.min.y + box.max.y) / 2 - p.y;
        p.by[i] = (pl_half_plane){ cos(angle), sin(angle), 0 };
        p.by[i].d = p.by[i].nx * mx + p.by[i].ny * my + uniform(-0.9, 0.9);
    }
    return p;
}

static bool is_in(const pose *p, double x, double y)
{
    bool in = true;
    for (int i = 0; i < p->cuts; ++i) {
        in = in && p->by[i].nx * x + p->by[i].ny * y <= p->by[i].d;
    }
    return in;
}

static pl_area brute_area(const pose *p)
{
    const plumb_aabb box = plumb_convex_aabb(&p->shape, p->frame);
    const double w = (double)(box.max.x - box.min.x) / GRID;
    const double h = (double)(box.max.y - box.min.y) / GRID;
    plumb_convex placed;
    plumb_convex_transform(&p->shape, p->frame, &placed);
    pl_area sum = { 0 };
    for (int i = 0; i < GRID; ++i) {
        for (int k = 0; k < GRID; ++k) {
            const double x = (double)box.min.x + (i + 0.5) * w;
            const double y = (double)box.min.y + (k + 0.5) * h;
            if (is_in(p, x - p->x, y - p->y) &&
                plumb_convex_contains(&placed, (plumb_vec2){ R(x), R(y) })) {
                sum.area += w * h;
                sum.x += w * h * (x - p->x);
                sum.y += w * h * (y - p->y);
            }
        }
    }
    return sum;
}

static pl_contour cut_contour(const pose *p)
{
    pl_contour contour;
    pl_contour_of(&p->shape, 0, p->frame, p->x, p->y, &contour);
    for (int i = 0; i < p->cuts; ++i) {
        pl_contour_cut(&contour, p->by[i]);
    }
    return contour;
}

static void areas_are_those_of_many_points(void **state)
{
    (void)state;
    double worst = 0;
    int partly = 0;
    for (int i = 0; i < 600; ++i) {
        const pose p = random_pose(i);
        const pl_contour contour = cut_contour(&p);
        const pl_area is = pl_contour_area(&contour), should = brute_area(&p);
        const plumb_aabb box = plumb_convex_aabb(&p.shape, p.frame);
        const double w = (double)(box.max.x - box.min.x), h = (double)(box.max.y - box.min.y);
        // A row of points may be off along the outline.
        const double off = 4 * (w + h) * (w + h) / GRID;
        worst = fmax(worst, fabs(is.area - should.area) / off);
        worst = fmax(worst, fabs(is.x - should.x) / (6 * off));
        worst = fmax(worst, fabs(is.y - should.y) / (6 * off));
        const plumb_mass_properties all = plumb_convex_mass(&p.shape, 1);
        partly += is.area > 0.05 * (double)all.mass && is.area < 0.95 * (double)all.mass;
    }
    print_message("areas off by %.2f of what points resolve; %d cut\n", worst, partly);
    assert_true(worst < 1);
    assert_true(partly > 150);
}

// What is on one side and what is on the other is the whole, to rounding.
static void halves_add_up(void **state)
{
    (void)state;
    double worst = 0;
    for (int i = 0; i < 4000; ++i) {
        pose p = random_pose(i);
        p.cuts = 0;
        pl_contour all = cut_contour(&p), one = all, other = all;
        pl_contour_cut(&one, p.by[0]);
        pl_contour_cut(&other, (pl_half_plane){ -p.by[0].nx, -p.by[0].ny, -p.by[0].d });
        const pl_area a = pl_contour_area(&all), b = pl_contour_area(&one),
                      c = pl_contour_area(&other);
        const plumb_mass_properties mass = plumb_convex_mass(&p.shape, 1);
        worst = fmax(worst, fabs(a.area - b.area - c.area));
        worst = fmax(worst, fabs(a.x - b.x - c.x));
        worst = fmax(worst, fabs(a.y - b.y - c.y));
        assert_true(fabs(a.area - (double)mass.mass) < 1e-5 * (1 + a.area));
    }
    print_message("halves add up to %.2g\n", worst);
    assert_true(worst < 1e-5); // turned corners are rounded to floats
}

//---- drag ----------------------------------------------------------------------------------------

// Many points along each element; an arc's by their angle.
static pl_drag brute_drag(const pl_contour *contour, pl_spin v, double pressure, double skin)
{
    pl_drag d = { 0 };
    for (int i = 0; i < contour->count; ++i) {
        const pl_element *e = &contour->at[i], *f = &contour->at[(i + 1) % contour->count];
        const double from = atan2(e->y - e->cy, e->x - e->cx);
        double turn = atan2(f->y - e->cy, f->x - e->cx) - from;
        turn += turn < 0 ? 2 * PI : 0;
        for (int k = 0; k < 4000 && !e->cut; ++k) {
            const double s = (k + 0.5) / 4000, dx = f->x - e->x, dy = f->y - e->y;
            double ds = hypot(dx, dy), x = e->x + s * dx, y = e->y + s * dy;
            double nx = ds > 0 ? dy / ds : 0, ny = ds > 0 ? -dx / ds : 0;
            if (e->r > 0) {
                nx = cos(from + s * turn), ny = sin(from + s * turn);
                x = e->cx + e->r * nx, y = e->cy + e->r * ny, ds = e->r * turn;
            }
            ds /= 4000;
            const double vx = v.vx - v.w * y, vy = v.vy + v.w * x, vn = vx * nx + vy * ny;
            const double vt = vy * nx - vx * ny, at_n = x * ny - y * nx, at_t = x * nx + y * ny;
            const double p = pressure * fmax(0, vn) * ds, t = skin * fabs(vt) * ds;
            d.xx += p * nx * nx + t * ny * ny, d.xy += p * nx * ny - t * nx * ny;
            d.yy += p * ny * ny + t * nx * nx, d.xw += p * nx * at_n - t * ny * at_t;
            d.yw += p * ny * at_n + t * nx * at_t, d.ww += p * at_n * at_n + t * at_t * at_t;
        }
    }
    return d;
}

static double difference(const pl_drag *a, const pl_drag *b)
{
    const double *p = &a->xx, *q = &b->xx;
    double worst = 0, size = 0;
    for (int i = 0; i < 6; ++i) {
        worst = fmax(worst, fabs(p[i] - q[i]));
        size = fmax(size, fabs(q[i]));
    }
    return size > 0 ? worst / size : worst;
}

static void drag_is_that_of_many_points(void **state)
{
    (void)state;
    double worst = 0;
    for (int i = 0; i < 400; ++i) {
        const pose p = random_pose(i);
        const pl_contour contour = cut_contour(&p);
        const pl_spin v = { uniform(-2, 2), uniform(-2, 2), i % 4 == 0 ? 0 : uniform(-3, 3) };
        const double pressure = i % 5 == 0 ? 0 : 1.8, skin = i % 7 == 0 ? 0 : 0.4;
        pl_drag is = { 0 };
        pl_contour_drag(&contour, v, pressure, skin, &is);
        const pl_drag should = brute_drag(&contour, v, pressure, skin);
        worst = fmax(worst, difference(&is, &should));
    }
    print_message("drag off by %.2g of its size\n", worst);
    assert_true(worst < 2e-5);
}

// A disc has two thirds of the coefficient on its diameter; a plate all of it.
static void a_disc_has_two_thirds(void **state)
{
    (void)state;
    plumb_convex disc;
    SAYS(plumb_convex_circle(plumb_v2(0, 0), R(0.5), &disc), OK);
    plumb_transform still = { .q = { 1, 0 } };
    pl_contour contour;
    pl_contour_of(&disc, 0, still, 0, 0, &contour);
    pl_drag d = { 0 };
    pl_contour_drag(&contour, (pl_spin){ 3, 0, 0 }, 1.8, 0, &d);
    // D v / 2 = C / 2 v^2 times the diameter of 1 m
    assert_true(fabs(d.xx * 3 / 2 - 1.8 / 2 * 9 * 2 / 3) < 1e-12);
    assert_true(fabs(d.xy) + fabs(d.xw) + fabs(d.yw) + fabs(d.ww) < 1e-12);
}

// Two halves of a square have the drag of the square: what is between them feels nothing.
static void inner_cuts_feel_nothing(void **state)
{
    (void)state;
    plumb_convex all, left, right;
    const plumb_transform still = { .q = { 1, 0 } };
    SAYS(plumb_convex_box(plumb_v2(1, 1), plumb_v2(0, 0), 0, 0, &all), OK);
    SAYS(plumb_convex_box(plumb_v2(R(0.5), 1), plumb_v2(R(-0.5), 0), 0, 0, &left), OK);
    SAYS(plumb_convex_box(plumb_v2(R(0.5), 1), plumb_v2(R(0.5), 0), 0, 0, &right), OK);
    pl_contour contour;
    pl_drag one = { 0 }, both = { 0 };
    const pl_spin v = { 2, 1, R(0.5) };
    pl_contour_of(&all, 0, still, 0, 0, &contour);
    pl_contour_drag(&contour, v, 1.8, 0.1, &one);
    pl_contour_of(&left, 1u << 1, still, 0, 0, &contour); // its edge to the right
    pl_contour_drag(&contour, v, 1.8, 0.1, &both);
    pl_contour_of(&right, 1u << 3, still, 0, 0, &contour);
    pl_contour_drag(&contour, v, 1.8, 0.1, &both);
    assert_true(difference(&both, &one) < 1e-12);
}

static void planes_hold_their_shape(void **state)
{
    (void)state;
    for (int i = 0; i < 500; ++i) {
        const pose p = random_pose(i);
        pl_half_plane planes[PL_HALF_PLANES_MOST];
        const int count = pl_half_planes_of(&p.shape, p.frame, p.x, p.y, planes);
        assert_true(count >= 3 && count <= PL_HALF_PLANES_MOST);
        pl_contour contour;
        pl_contour_of(&p.shape, 0, p.frame, p.x, p.y, &contour);
        const double all = pl_contour_area(&contour).area;
        for (int k = 0; k < count; ++k) {
            planes[k].d += 1e-5;
            pl_contour_cut(&contour, planes[k]);
        }
        assert_true(fabs(pl_contour_area(&contour).area - all) <= 1e-9 * (1 + all));
    }
}

// A cut beside the end of an arc leaves a sliver of it, whose radius vectors may have a product that rounds to more
// than the square of the radius.
static void slivers_of_arcs_are_finite(void **state)
{
    (void)state;
    for (int i = 0; i < 20000; ++i) {
        pose p = random_pose(i);
        pl_contour contour;
        pl_contour_of(&p.shape, 0, p.frame, p.x, p.y, &contour);
        const int which = i % contour.count;
        const pl_element *e = &contour.at[which];
        const double angle = uniform(-4, 4), off = uniform(-1, 1) * pow(10, uniform(-17, -7));
        pl_half_plane by = { cos(angle), sin(angle), 0 };
        by.d = by.nx * e->x + by.ny * e->y + off;
        pl_contour_cut(&contour, by);
        const pl_area a = pl_contour_area(&contour);
        assert_true(isfinite(a.area) && isfinite(a.x) && isfinite(a.y));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(areas_are_those_of_many_points, seed),
        cmocka_unit_test_setup(halves_add_up, seed),
        cmocka_unit_test_setup(drag_is_that_of_many_points, seed),
        cmocka_unit_test_setup(a_disc_has_two_thirds, seed),
        cmocka_unit_test_setup(inner_cuts_feel_nothing, seed),
        cmocka_unit_test_setup(planes_hold_their_shape, seed),
        cmocka_unit_test_setup(slivers_of_arcs_are_finite, seed),
    };
    return cmocka_run_group_tests_name("immersed", tests, NULL, NULL);
}
