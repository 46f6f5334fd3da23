// test_light.c - rays of light against optics: Snell, Fresnel, Brewster, total reflection, mirrors, slabs, prisms, lenses, media in
// media, absorption, far out. test_light_scenes.c has what must hold in any scene.
#include "light_fixture.h"

//---- one surface ----------------------------------------------------------------------------------

// Any two media, angle, place and polarisation.
static void snell_and_fresnel(void **state)
{
    (void)state;
    double bend = 0, power = 0;
    int total = 0;
    for (int i = 0; i < 4000; ++i) {
        seed = 2654435761u * (uint32_t)(77 + i);
        plumb_world *w = sim_space();
        const double n1 = uniform(1, 2.5), n2 = uniform(1, 2.5), turn = uniform(-3, 3);
        const double angle = uniform(0.01, 1.5), pol = i % 3 - 1;
        const double x = uniform(-3, 3), y = uniform(-3, 3);
        // The face that the ray meets looks to `turn`, and lies 1 m from the body.
        add(w, x, y, turn, box(1, 40), optical(w, n2, 0, 0));
        const double hit_x = x + cos(turn), hit_y = y + sin(turn);
        const double way = turn + SIM_PI + angle; // of the ray
        const plumb_light_desc d = { .from = sim_vec(hit_x - 2 * cos(way), hit_y - 2 * sin(way)),
                                     .direction = sim_vec(cos(way), sin(way)),
                                     .index = (plumb_real)n1,
                                     .polarization = (plumb_real)pol,
                                     .max_bounces = 1,
                                     .min_power = (plumb_real)1e-30 };
        const int count = shine(w, d);
        const plumb_light_segment *through = child_of(count, 0, PLUMB_LIGHT_REFRACTED);
        const plumb_light_segment *back = child_of(count, 0, PLUMB_LIGHT_REFLECTED);
        const double in = (double)path[0].incidence,
                     sine = (double)(plumb_real)n1 / (double)(plumb_real)n2 * sin(in);
        assert_near(in, angle, TOLERANCE(2e-6, 1e-12));
        if (sine >= 1) {
            ++total;
            assert_null(through);
            assert_near(back->power, 1, TOLERANCE(1e-7, 1e-15));
        } else {
            const double out = asin(sine), c1 = cos(in), c2 = cos(out);
            const double a = (double)(plumb_real)n1, b = (double)(plumb_real)n2;
            const double s = (a * c1 - b * c2) / (a * c1 + b * c2);
            const double p = (b * c1 - a * c2) / (b * c1 + a * c2);
            const double share = (s * s * (1 - pol) + p * p * (1 + pol)) / 2;
            double to[2];
            direction_of(through, to);
            const double is = fabs(remainder(atan2(to[1], to[0]) - (turn + SIM_PI), 2 * SIM_PI));
            bend = fmax(bend, fabs(is - out) * c2); // a grazing ray tells angles by their cosine
            power = fmax(power, fabs((double)through->power - (1 - share)));
            if (back != NULL) {
                power = fmax(power, fabs((double)back->power - share));
                direction_of(back, to);
                const double bounced = remainder(atan2(to[1], to[0]) - (turn - angle), 2 * SIM_PI);
                assert_near(bounced, 0, TOLERANCE(4e-6, 1e-12));
            }
        }
        plumb_world_destroy(w);
    }
    print_message("4000 surfaces, %d of total reflection: angle %.2g rad, power %.2g\n", total,
                  bend, power);
    assert_true(total > 300);
    assert_true(bend < TOLERANCE(6e-6, 1e-12) && power < TOLERANCE(3e-5, 1e-12));
}

// The share that comes back from the face x = 0 of a block, by the angle of incidence.
static double reflected(plumb_world *w, double angle, double pol, double around)
{
    const plumb_light_desc d = { .from = sim_vec(-cos(angle), -sin(angle)),
                                 .direction = sim_vec(cos(angle), sin(angle)),
                                 .polarization = (plumb_real)pol,
                                 .index = (plumb_real)around,
                                 .max_bounces = 1,
                                 .min_power = (plumb_real)1e-30 };
    const int count = shine(w, d);
    const plumb_light_segment *back = child_of(count, 0, PLUMB_LIGHT_REFLECTED);
    return back != NULL ? (double)back->power : 0;
}

static void brewster_critical_and_normal(void **state)
{
    (void)state;
    double at_normal = 0, at_brewster = 0, above = 1;
    for (int i = 0; i < 40; ++i) {
        const double n = (double)(plumb_real)(1.05 + 0.05 * i);
        plumb_world *w = sim_space();
        add(w, 5, 0, 0, box(5, 50), optical(w, n, 0, 0));
        at_normal = fmax(at_normal, fabs(reflected(w, 0, 0, 1) - pow((n - 1) / (n + 1), 2)));
        at_brewster = fmax(at_brewster, reflected(w, atan(n), 1, 1));
        assert_true(reflected(w, atan(n), -1, 1) > 1e-4);
        plumb_world_destroy(w);
        // From the dense side: a block of air in glass.
        w = sim_space();
        add(w, 5, 0, 0, box(5, 50), optical(w, 1, 0, 0));
        const double critical = asin(1 / n), off = TOLERANCE(3e-4, 1e-9);
        assert_near(reflected(w, critical + off, 0, n), 1, 1e-6);
        above = fmin(above, 1 - reflected(w, critical - off, 0, n));
        plumb_world_destroy(w);
    }
    print_message("normal incidence %.2g off, at Brewster's angle %.2g, below the critical one "
                  "%.2g goes through\n",
                  at_normal, at_brewster, above);
    assert_true(at_normal < TOLERANCE(1e-7, 1e-15) && at_brewster < TOLERANCE(1e-11, 1e-28));
    assert_true(above > TOLERANCE(1e-3, 1e-6));
}

// Beer and Lambert; half mirrors; films.
static void media_absorb_and_films_part(void **state)
{
    (void)state;
    plumb_world *w = sim_space();
    add(w, 0, 0, 0, box(1, 1), optical(w, 1, 0, 0.7));
    plumb_vec2 ends[] = { sim_vec(3, -1), sim_vec(3, 1) };
    add(w, 0, 0, 0.0, (plumb_shape_desc){ .kind = PLUMB_SEGMENT, .points = ends, .count = 2 },
        optical(w, 1.5, 0.3, 0));
    const int count =
        shine(w, (plumb_light_desc){ .from = sim_vec(-2, 0.1), .direction = sim_vec(1, 0) });
    assert_near(path[2].power, exp(-1.4), TOLERANCE(1e-7, 1e-14));
    assert_near(path[2].to.x, 3, TOLERANCE(1e-6, 1e-14));
    const plumb_light_segment *on = child_of(count, 2, PLUMB_LIGHT_REFRACTED);
    assert_near(on->power, 0.7 * exp(-1.4), TOLERANCE(1e-7, 1e-7 * PLACES + 1e-8));
    assert_near(on->to.y, 0.1, 1e-6);
    assert_near(child_of(count, 2, PLUMB_LIGHT_REFLECTED)->power, 0.3 * exp(-1.4),
                TOLERANCE(1e-7, 1e-8));
    plumb_world_destroy(w);
    // Silver on glass: R + (1 - R) Fresnel, the same from both sides.
    w = sim_space();
    add(w, 5, 0, 0, box(5, 50), optical(w, 1.5, 0.25, 0));
    assert_near(reflected(w, 0, 0, 1), 0.25 + 0.75 * 0.04, 1e-7);
    plumb_world_destroy(w);
}

//---- mirrors --------------------------------------------------------------------------------------

// In a room of mirrors the way is straight in the plane of its images.
static void rooms_of_mirrors_have_images(void **state)
{
    (void)state;
    const double wide = 3, high = 2;
    double worst = 0;
    for (int i = 0; i < 200; ++i) {
        seed = 2654435761u * (uint32_t)(5 + i);
        plumb_world *w = sim_space();
        plumb_vec2 corners[] = { sim_vec(0, 0), sim_vec(wide, 0), sim_vec(wide, high),
                                 sim_vec(0, high) };
        add(w, 0, 0, 0,
            (plumb_shape_desc){
                .kind = PLUMB_CHAIN, .points = corners, .count = 4, .closed = true },
            optical(w, 0, 1, 0));
        const double x = uniform(0.2, 2.8), y = uniform(0.2, 1.8), angle = uniform(-3.1, 3.1);
        const double length = 150;
        const plumb_light_desc d = { .from = sim_vec(x, y),
                                     .direction = sim_vec(cos(angle), sin(angle)),
                                     .length = (plumb_real)length,
                                     .max_bounces = PLUMB_LIGHT_MAX_BOUNCES };
        const int count = shine(w, d);
        if (!(count > 40 && count < 120)) {
            fail_msg("%d: %d pieces", i, count);
        }
        const double ux = (double)d.direction.x, uy = (double)d.direction.y, size = hypot(ux, uy);
        const double ex = (double)d.from.x + length * ux / size,
                     ey = (double)d.from.y + length * uy / size;
        const double fx = fabs(remainder(ex, 2 * wide)), fy = fabs(remainder(ey, 2 * high));
        worst = fmax(worst,
                     hypot((double)path[count - 1].to.x - fx, (double)path[count - 1].to.y - fy));
        assert_near(sum.left, 1, 1e-15);
        plumb_world_destroy(w);
    }
    print_message("150 m between mirrors end %.2g m from where the image is\n", worst);
    assert_true(worst < TOLERANCE(1e-6, 5e-12));
}

// Two mirrors at a right angle send back what comes, their corner too.
static void corners_send_back(void **state)
{
    (void)state;
    double worst = 0;
    for (int i = 0; i < 300; ++i) {
        seed = 2654435761u * (uint32_t)(900 + i);
        plumb_world *w = sim_space();
        const double turn = i % 2 ? 0 : uniform(-3, 3);
        const plumb_material mirror = optical(w, 0, 1, 0);
        const bool blocks = i % 4 < 2;
        if (blocks) {
            add(w, 0, 0, turn,
                (plumb_shape_desc){
                    .kind = PLUMB_BOX, .half = sim_vec(6, 1), .center = sim_vec(4, -1) },
                mirror);
            add(w, 0, 0, turn,
                (plumb_shape_desc){
                    .kind = PLUMB_BOX, .half = sim_vec(1, 5), .center = sim_vec(-1, 5) },
                mirror);
        } else {
            plumb_vec2 points[] = { sim_vec(0, 10), sim_vec(0, 0), sim_vec(10, 0) };
            add(w, 0, 0, turn,
                (plumb_shape_desc){ .kind = PLUMB_CHAIN, .points = points, .count = 3 }, mirror);
        }
        const double way = turn + uniform(0.1, 1.4) + SIM_PI,
                     aside = i % 8 < 4 ? 0 : uniform(-0.5, 0.5);
        const plumb_light_desc d = { .from = sim_vec(-4 * cos(way) - aside * sin(way),
                                                     -4 * sin(way) + aside * cos(way)),
                                     .direction = sim_vec(cos(way), sin(way)) };
        const int count = shine(w, d);
        double to[2];
        direction_of(&path[count - 1], to);
        assert_in_range(count, 3, 3);
        worst = fmax(worst, hypot(to[0] + cos(way), to[1] + sin(way)));
        plumb_world_destroy(w);
    }
    print_message("back from a corner, exact hits too: %.2g rad off\n", worst);
    assert_true(worst < TOLERANCE(2e-6, 1e-12));
}

// Off a round mirror by pi - 2 asin(b / R); within a disc of glass the angle stays what it is.
static void round_surfaces_keep_the_angle(void **state)
{
    (void)state;
    double off = 0, within = 0;
    for (int i = 0; i < 300; ++i) {
        seed = 2654435761u * (uint32_t)(40 + i);
        plumb_world *w = sim_space();
        const double radius = uniform(0.3, 3), b = uniform(-0.999, 0.999) * radius,
                     x = uniform(-2, 2);
        const double r = (double)(plumb_real)radius, aside = (double)(plumb_real)b;
        add(w, x, 0, 0,
            i % 2 ? disc(radius)
                  : (plumb_shape_desc){ .kind = PLUMB_CAPSULE,
                                        .radius = (plumb_real)radius,
                                        .points = (plumb_vec2[]){ sim_vec(0, 0), sim_vec(5, 0) },
                                        .count = 2 },
            optical(w, 0, 0.9, 0));
        shine(w, (plumb_light_desc){ .from = sim_vec(-6, b), .direction = sim_vec(1, 0) });
        double to[2];
        direction_of(&path[1], to);
        const double turn = atan2(to[1], to[0]);
        off = fmax(off, fabs(fabs(turn) - (SIM_PI - 2 * asin(fabs(aside) / r))) *
                            sqrt(1 - pow(aside / r, 2)));
        assert_near(path[1].power, 0.9, 1e-7);
        plumb_world_destroy(w);
        // From within: silver on glass, 128 times round.
        w = sim_space();
        add(w, x, 1, 0, disc(radius), optical(w, 1.5, 1, 0));
        const double at = uniform(-0.9, 0.9) * radius;
        const int count = shine(w, (plumb_light_desc){ .from = sim_vec(x, 1 + at),
                                                       .direction = sim_vec(1, 0),
                                                       .max_bounces = PLUMB_LIGHT_MAX_BOUNCES });
        assert_int_equal(count, PLUMB_LIGHT_MAX_BOUNCES + 1);
        for (int k = 0; k < count; ++k) {
            within = fmax(within, fabs((double)path[k].incidence - (double)path[0].incidence));
        }
        plumb_world_destroy(w);
    }
    print_message("off a disc %.2g rad; within one, 128 times: the angle changes by %.2g\n", off,
                  within);
    assert_true(off < TOLERANCE(3e-6, 1e-12) && within < TOLERANCE(1.3e-7, 3e-11));
}

//---- glass ----------------------------------------------------------------------------------------

// A slab moves a ray aside by d sin(i - r) / cos(r).
static void slabs_move_rays_aside(void **state)
{
    (void)state;
    double worst = 0;
    for (int i = 0; i < 100; ++i) {
        seed = 2654435761u * (uint32_t)(8 + i);
        plumb_world *w = sim_space();
        const double n = (double)(plumb_real)uniform(1.1, 2.4), thick = uniform(0.1, 2),
                     in = uniform(-1.3, 1.3);
        add(w, 0, 0, 0, box(thick / 2, 40), optical(w, n, 0, 0));
        const plumb_light_desc d = { .from = sim_vec(-3, 0),
                                     .direction = sim_vec(cos(in), sin(in)),
                                     .max_bounces = 2 };
        const int count = shine(w, d);
        const plumb_light_segment *in_glass = child_of(count, 0, PLUMB_LIGHT_REFRACTED);
        const plumb_light_segment *out =
            child_of(count, (int)(in_glass - path), PLUMB_LIGHT_REFRACTED);
        const double a = (double)path[0].incidence, r = asin(sin(a) / n),
                     t = (double)(plumb_real)(thick / 2) * 2;
        const double x = (double)out->from.x + 3, y = (double)out->from.y;
        const double aside = fabs(x * sin(in) - y * cos(in));
        worst = fmax(worst, fabs(aside - fabs(t * sin(a - r) / cos(r))));
        double to[2];
        direction_of(out, to);
        assert_near(to[1], sin(in), TOLERANCE(2e-6, 1e-12));
        plumb_world_destroy(w);
    }
    print_message("slabs: %.2g m off\n", worst);
    assert_true(worst < TOLERANCE(2e-6, 1e-13));
}

// The least that a prism turns light by: 2 asin(n sin(A / 2)) - A.
static void prisms_turn_by_the_least(void **state)
{
    (void)state;
    for (int i = 0; i < 8; ++i) {
        plumb_world *w = sim_space();
        const double n = 1.3 + 0.05 * i, apex = SIM_PI / 3;
        plumb_vec2 corners[] = { sim_vec(-1, -sqrt(3) / 3), sim_vec(1, -sqrt(3) / 3),
                                 sim_vec(0, 2 * sqrt(3) / 3) };
        add(w, 0, 0, 0, (plumb_shape_desc){ .kind = PLUMB_POLYGON, .points = corners, .count = 3 },
            optical(w, n, 0, 0));
        const double least = 2 * asin(n * sin(apex / 2)) - apex;
        // Through the middle of the left side, then level.
        const double way = least / 2;
        double to[2], from_x = -0.5, from_y = sqrt(3) / 6;
        const int count =
            shine(w, (plumb_light_desc){ .from = sim_vec(from_x - cos(way), from_y - sin(way)),
                                         .direction = sim_vec(cos(way), sin(way)),
                                         .max_bounces = 2 });
        const plumb_light_segment *in_glass = child_of(count, 0, PLUMB_LIGHT_REFRACTED);
        const plumb_light_segment *out =
            child_of(count, (int)(in_glass - path), PLUMB_LIGHT_REFRACTED);
        direction_of(in_glass, to);
        assert_near(to[1], 0, TOLERANCE(1e-6, 1e-13));
        direction_of(out, to);
        assert_near(atan2(to[1], to[0]), -way, TOLERANCE(2e-6, 1e-13));
        plumb_world_destroy(w);
    }
}

// A ball focuses at n R / (2 (n - 1)) from its middle; what is h off the axis falls short by a share of h^2.
static void balls_focus(void **state)
{
    (void)state;
    const double n = 1.5, focus = n / (2 * (n - 1));
    double error[4];
    for (int i = 0; i < 4; ++i) {
        plumb_world *w = sim_space();
        const double h = 0.4 / (1 << i);
        add(w, 0, 0, 0, disc(1), optical(w, n, 0, 0));
        const int count =
            shine(w, (plumb_light_desc){
                         .from = sim_vec(-3, h), .direction = sim_vec(1, 0), .max_bounces = 2 });
        const plumb_light_segment *in_glass = child_of(count, 0, PLUMB_LIGHT_REFRACTED);
        const plumb_light_segment *out =
            child_of(count, (int)(in_glass - path), PLUMB_LIGHT_REFRACTED);
        double to[2];
        direction_of(out, to);
        error[i] = focus - ((double)out->from.x - (double)out->from.y * to[0] / to[1]);
        // The whole of it: two refractions of a circle, 2 (i - r) in all.
        const double bend = 2 * (asin(h) - asin(h / n));
        assert_near(atan2(to[1], to[0]), -bend, TOLERANCE(1e-6, 1e-13));
        plumb_world_destroy(w);
    }
    const double order = sim_order(error, 4);
    print_message("focus of a ball: %.3g %.3g %.3g %.3g m short, order %.2f\n", error[0], error[1],
                  error[2], error[3], order);
    assert_true(error[3] > 0 && error[3] < 0.003 && order > 1.9 && order < 2.2);
}

// What touches has one surface; what is of one material has none; the smaller of two is within the larger.
static void glass_in_glass(void **state)
{
    (void)state;
    const plumb_light_desc d = { .from = sim_vec(-5, 0.1), .direction = sim_vec(1, 0) };
    for (int i = 0; i < 6; ++i) {
        plumb_world *w = sim_space();
        const plumb_material a = optical(w, 1.5, 0, 0),
                             b = i == 0 || i == 3 ? a : optical(w, 1.8, 0, 0);
        // Flush; with a gap of 4 um; overlapping by 5 cm; the smaller one on the other side.
        const double gap = i % 3 == 1 ? 4e-6 : i % 3 == 2 ? -0.05 : 0;
        const double turn = i >= 3 ? SIM_PI : 0;
        add(w, i >= 3 ? 1 : -1, 0, turn, box(1, 3), a);
        add(w, (i >= 3 ? -1 : 1) * (0.5 + gap), 0, turn, box(0.5, 3), b);
        const int count = shine(w, d);
        // Along the way that goes through.
        int surfaces = 0;
        double power = 1;
        for (const plumb_light_segment *s = path; s != NULL && s->how != PLUMB_LIGHT_REFLECTED;
             s = child_of(count, (int)(s - path), PLUMB_LIGHT_REFRACTED)) {
            surfaces = s->depth;
            power = (double)s->power;
        }
        const double air = 0.04, dense = pow(0.8 / 2.8, 2), between = pow(0.3 / 3.3, 2);
        assert_int_equal(surfaces, b.entity.index == a.entity.index ? 2 : 3);
        assert_near(power,
                    surfaces == 2 ? (1 - air) * (1 - air) : (1 - air) * (1 - dense) * (1 - between),
                    1e-6);
        plumb_world_destroy(w);
    }
    // A bubble in glass, and a lens in water that is a sensor.
    plumb_world *w = sim_space();
    add(w, 0, 0, 0, box(2, 2), optical(w, 1.5, 0, 0));
    add(w, 0, 0, 0, disc(1), optical(w, 1, 0, 0));
    shine(w, d);
    assert_near(path[2].index, 1, 1e-7);
    plumb_world_destroy(w);
    w = sim_space();
    plumb_shape_desc pool = box(4, 2);
    pool.sensor = true;
    add(w, 0, 0, 0, pool, optical(w, 1.33, 0, 0));
    add(w, 0, 0, 0, disc(1), optical(w, 1.5, 0, 0));
    const plumb_query_filter filter = { .sensors = true };
    assert_true(plumb_world_light(w, &d, &filter, path, MOST, &sum) > 3);
    assert_near(path[1].index, 1.33, 1e-6);
    assert_near(path[2].index, 1.5, 1e-6);
    shine(w, d);
    assert_near(path[1].index, 1.5, 1e-6); // who does not see sensors
    plumb_world_destroy(w);
    // A mirror behind glass, 5 um behind it: no film of air.
    w = sim_space();
    add(w, 0, 0, 0, box(1, 1), optical(w, 1.5, 0, 0));
    add(w, 2 + 5e-6, 0, 0, box(1, 1), optical(w, 0, 0.5, 0));
    const int count = shine(
        w,
        (plumb_light_desc){ .from = sim_vec(-3, 0), .direction = sim_vec(1, 0), .max_bounces = 3 });
    assert_near(path[1].absorbed, 0.48, 1e-6);
    assert_true(count >= 4);
    plumb_world_destroy(w);
}

// A hundred kilometres out, where a float is known to 8 mm, a far world has the place of its bodies and the path as at the origin.
static void far_out(void **state)
{
    (void)state;
    const double off = PLACES > 1e-10 ? 64 : 1e7;
    double to[2][2];
    for (int i = 0; i < 2; ++i) {
        plumb_world *w = sim_space();
        add(w, i * off, 0, 0, disc(1), optical(w, 1.5, 0, 0));
        add(w, i * off + 5, 0, 0.75, box(1, 1), optical(w, 0, 1, 0));
        shine(w, (plumb_light_desc){ .from = sim_vec(i * off - 4, 0.25),
                                     .direction = sim_vec(1, 0),
                                     .max_bounces = 3 });
        to[i][0] = (double)path[2].to.x - i * off;
        to[i][1] = (double)path[2].to.y;
        plumb_world_destroy(w);
    }
    print_message("%g m out: %.2g m off\n", off, hypot(to[1][0] - to[0][0], to[1][1] - to[0][1]));
    assert_true(hypot(to[1][0] - to[0][0], to[1][1] - to[0][1]) < 8 * PLACES * off);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(snell_and_fresnel),
        cmocka_unit_test(brewster_critical_and_normal),
        cmocka_unit_test(media_absorb_and_films_part),
        cmocka_unit_test(rooms_of_mirrors_have_images),
        cmocka_unit_test(corners_send_back),
        cmocka_unit_test(round_surfaces_keep_the_angle),
        cmocka_unit_test(slabs_move_rays_aside),
        cmocka_unit_test(prisms_turn_by_the_least),
        cmocka_unit_test(balls_focus),
        cmocka_unit_test(glass_in_glass),
        cmocka_unit_test(far_out),
    };
    return cmocka_run_group_tests_name("rays of light", tests, NULL, NULL);
}
