// test_light_scenes.c - rays of light in random scenes: no power is lost, ways can be gone back, no direction, place, size or order
// is another, and what is opaque is met as by any ray.
#include "light_fixture.h"

typedef struct placed {
    plumb_shape_desc shape;
    plumb_vec2 points[6];
    int material;
    double x, y, angle;
} placed;

enum { SHAPES = 14, MATERIALS = 5 };
static const double optics[MATERIALS][3] = {
    { 1.5, 0, 0 }, { 1.3, 0, 0.4 }, { 0, 1, 0 }, { 0, 0.6, 0 }, { 2.2, 0.2, 0 }
};

static void random_scene(uint32_t number, placed out[SHAPES])
{
    static const double star[6][2] = { { -1, -1 }, { 0, -0.4 }, { 1, -1 },
                                       { 0.9, 1 }, { 0, 0.3 },  { -1, 1 } };
    seed = 2654435761u * number + 1;
    memset(out, 0, SHAPES * sizeof *out);
    for (int i = 0; i < SHAPES; ++i) {
        placed *p = &out[i];
        const double size = uniform(0.3, 1.2);
        p->x = uniform(-5, 5);
        p->y = uniform(-5, 5);
        p->angle = uniform(-3, 3);
        p->material = (int)uniform(0, MATERIALS);
        for (int k = 0; k < 6; ++k) {
            p->points[k] = sim_vec(size * star[k][0], size * star[k][1]);
        }
        p->shape.kind = (plumb_shape_kind)(i % PLUMB_SHAPE_KINDS);
        const plumb_shape_kind kind = p->shape.kind;
        if (kind == PLUMB_CIRCLE || kind == PLUMB_CAPSULE) {
            p->shape.radius = (plumb_real)(0.6 * size);
        }
        if (kind == PLUMB_BOX) {
            p->shape.half = sim_vec(size, 0.4 * size);
        }
        if (kind == PLUMB_POLYGON || kind == PLUMB_BOX) {
            p->shape.radius = i > 6 ? (plumb_real)0.1 : 0;
        }
        if (kind != PLUMB_CIRCLE && kind != PLUMB_BOX) {
            p->shape.count = kind == PLUMB_CAPSULE || kind == PLUMB_SEGMENT ? 2
                             : kind == PLUMB_POLYGON                        ? 3
                                                                            : 6;
        }
    }
}

// Turned by `turn`, then mirrored at x = 0 (or not), made larger, moved; made from the last shape on (or the first).
typedef struct change {
    double turn, scale, x, y;
    bool mirrored, backwards;
} change;

static plumb_vec2 changed(const change *c, double x, double y)
{
    const double tx = c->scale * (cos(c->turn) * x - sin(c->turn) * y),
                 ty = c->scale * (sin(c->turn) * x + cos(c->turn) * y);
    return sim_vec((c->mirrored ? -tx : tx) + c->x, ty + c->y);
}

static plumb_world *build(const placed *scene, const change *c)
{
    plumb_world *w = sim_space();
    plumb_material m[MATERIALS];
    for (int k = 0; k < MATERIALS; ++k) {
        m[k] = optical(w, optics[k][0], optics[k][1], optics[k][2] / c->scale);
    }
    for (int i = 0; i < SHAPES; ++i) {
        const placed *p = &scene[c->backwards ? SHAPES - 1 - i : i];
        plumb_shape_desc d = p->shape;
        plumb_vec2 points[6];
        d.radius *= (plumb_real)c->scale;
        d.half = plumb_vec2_scale((plumb_real)c->scale, d.half);
        for (int k = 0; k < d.count; ++k) {
            const double px = c->scale * (double)p->points[k].x,
                         py = c->scale * (double)p->points[k].y;
            points[k] = sim_vec(c->mirrored ? -px : px, py);
        }
        d.points = d.count > 0 ? points : NULL;
        const plumb_vec2 at = changed(c, p->x, p->y);
        const double angle = p->angle + c->turn;
        add(w, (double)at.x, (double)at.y, c->mirrored ? -angle : angle, d, m[p->material]);
    }
    return w;
}

static plumb_light_desc ray_of(const change *c, double x, double y, double way)
{
    const change turn = { c->turn, 1, 0, 0, c->mirrored, false };
    return (plumb_light_desc){ .from = changed(c, x, y),
                               .direction = changed(&turn, cos(way), sin(way)) };
}

static const change as_it_is = { 0, 1, 0, 0, false, false };

static void no_power_is_lost(void **state)
{
    (void)state;
    double worst = 0, cut = 0;
    int pieces = 0;
    for (uint32_t i = 0; i < 3000; ++i) {
        placed scene[SHAPES];
        random_scene(i, scene);
        plumb_world *w = build(scene, &as_it_is);
        plumb_light_desc d = ray_of(&as_it_is, uniform(-5, 5), uniform(-5, 5), uniform(-3, 3));
        d.polarization = (plumb_real)uniform(-1, 1);
        d.min_power = (plumb_real)(i % 3 ? 1e-2 : 1e-4);
        const int count = plumb_world_light(w, &d, NULL, path, i % 5 ? MOST : 7, &sum);
        worst = fmax(worst, fabs(sum.sent - sum.absorbed - sum.left - sum.cut));
        cut += sum.cut;
        pieces += count;
        // Each piece gives what its children have, what is kept and what is cut off: never more.
        for (int k = 0; k < count; ++k) {
            double rest = (double)path[k].power_end - (double)path[k].absorbed;
            for (int j = k + 1; j < count; ++j) {
                rest -= path[j].parent == k ? (double)path[j].power : 0;
            }
            assert_true(rest > -2e-7 && path[k].power_end <= path[k].power && path[k].parent < k);
        }
        plumb_world_destroy(w);
    }
    print_message("3000 scenes, %d pieces: power lost %.2g of 1, cut off %.2g in the mean\n",
                  pieces, worst, cut / 3000);
    assert_true(worst < 4e-15 && pieces > 30000);
}

// The strongest way, gone back from its end, comes to the source.
static void ways_can_be_gone_back(void **state)
{
    (void)state;
    int gone = 0, missed = 0;
    double worst = 0;
    for (uint32_t i = 0; i < 2000; ++i) {
        placed scene[SHAPES];
        random_scene(i, scene);
        plumb_world *w = build(scene, &as_it_is);
        plumb_light_desc d = ray_of(&as_it_is, uniform(-5, 5), uniform(-5, 5), uniform(-3, 3));
        d.max_bounces = 3;
        d.length = 40;
        const int count = shine(w, d);
        const plumb_light_segment *end = path; // first child of each is the strongest
        for (int k = 1; k < count && path[k].parent == k - 1; ++k) {
            end = &path[k];
        }
        double to[2], length = hypot((double)end->to.x - (double)end->from.x,
                                     (double)end->to.y - (double)end->from.y);
        if (end == path || length < 0.1) {
            plumb_world_destroy(w);
            continue;
        }
        direction_of(end, to);
        const double x = ((double)end->from.x + (double)end->to.x) / 2,
                     y = ((double)end->from.y + (double)end->to.y) / 2;
        const double sx = (double)d.from.x, sy = (double)d.from.y;
        const int depth = end->depth;
        d = (plumb_light_desc){ .from = sim_vec(x, y),
                                .direction = sim_vec(-to[0], -to[1]),
                                .max_bounces = depth,
                                .min_power = (plumb_real)1e-7 };
        const int back = shine(w, d);
        double nearest = 1;
        for (int k = 0; k < back; ++k) {
            const double ax = (double)path[k].from.x, ay = (double)path[k].from.y,
                         bx = (double)path[k].to.x - ax, by = (double)path[k].to.y - ay;
            double t = ((sx - ax) * bx + (sy - ay) * by) / (bx * bx + by * by + 1e-300);
            t = fmin(fmax(t, 0), 1);
            nearest = path[k].depth == depth
                          ? fmin(nearest, hypot(ax + t * bx - sx, ay + t * by - sy))
                          : nearest;
        }
        ++gone;
        missed += nearest > TOLERANCE(1e-2, 1e-8);
        worst = nearest > TOLERANCE(1e-2, 1e-8) ? worst : fmax(worst, nearest);
        plumb_world_destroy(w);
    }
    print_message("%d ways gone back: %d miss the source, the others come within %.2g m\n", gone,
                  missed, worst);
    assert_true(gone > 800 && missed <= TOLERANCE(gone / 100, 0));
}

static void any_view_is_the_same(void **state)
{
    (void)state;
    static plumb_light_segment first[MOST];
    const change changes[] = { { 0.7, 1, 0, 0, false, false }, { 0, 1, 0, 0, true, false },
                               { 0, 1, 3, -2, false, false },  { 0, 4, 0, 0, false, false },
                               { 0, 1, 0, 0, false, true },    { -2, 0.5, 1, 1, true, true } };
    static const char *const names[] = { "turned", "mirrored", "moved",
                                         "scaled", "shuffled", "all of it" };
    for (size_t k = 0; k < sizeof changes / sizeof *changes; ++k) {
        const change *c = &changes[k];
        double worst = 0;
        int other = 0, same = 0;
        for (uint32_t i = 0; i < 300; ++i) {
            placed scene[SHAPES];
            random_scene(i, scene);
            const double x = uniform(-5, 5), y = uniform(-5, 5), way = uniform(-3, 3);
            plumb_world *w = build(scene, &as_it_is);
            plumb_light_desc d = ray_of(&as_it_is, x, y, way);
            d.max_bounces = 3;
            d.length = 30;
            d.min_power = (plumb_real)0.02;
            const int count = shine(w, d);
            memcpy(first, path, sizeof path);
            plumb_world_destroy(w);
            w = build(scene, c);
            plumb_light_desc e = ray_of(c, x, y, way);
            e.max_bounces = 3;
            e.length = (plumb_real)(30 * c->scale);
            e.min_power = d.min_power;
            const int again = shine(w, e);
            double apart = again == count ? 0 : 1;
            for (int s = 0; s < count && s < again; ++s) {
                const plumb_vec2 p = changed(c, (double)first[s].to.x, (double)first[s].to.y);
                apart =
                    fmax(apart, hypot((double)(p.x - path[s].to.x), (double)(p.y - path[s].to.y)) /
                                    c->scale);
                apart = fmax(apart, fabs((double)(first[s].power - path[s].power)));
            }
            // What only just passes a corner may not do so again.
            if (apart > TOLERANCE(1e-3, 1e-9)) {
                ++other;
            } else {
                ++same;
                worst = fmax(worst, apart);
            }
            plumb_world_destroy(w);
        }
        print_message("%s: %d the same within %.2g, %d not\n", names[k], same, worst, other);
        assert_true(other <= TOLERANCE(6, 0));
        assert_true(c->turn != 0 || c->mirrored || c->x != 0 || worst == 0);
    }
}

// Whatever is opaque is met where a ray of query.h meets it.
static void opaque_shapes_are_met_as_by_rays(void **state)
{
    (void)state;
    int met = 0;
    double place = 0, normal = 0;
    for (uint32_t i = 0; i < 3000; ++i) {
        placed scene[SHAPES];
        random_scene(i, scene);
        for (int k = 0; k < SHAPES; ++k) {
            scene[k].material = 3;
        }
        plumb_world *w = build(scene, &as_it_is);
        const plumb_light_desc d =
            ray_of(&as_it_is, uniform(-5, 5), uniform(-5, 5), uniform(-3, 3));
        const plumb_vec2 to = plumb_vec2_add_scaled(d.from, 30, d.direction);
        plumb_ray_hit hit;
        shine(w, d);
        const bool hits = plumb_world_ray(w, d.from, to, NULL, &hit);
        assert_true(hits == !plumb_is_null(path[0].shape));
        if (hits) {
            ++met;
            // At a seam of an outline both of its pieces are met.
            assert_true(plumb_same(hit.shape, path[0].shape));
            const double steep = cos((double)path[0].incidence);
            place = fmax(place, steep * hypot((double)(hit.point.x - path[0].to.x),
                                              (double)(hit.point.y - path[0].to.y)));
            const double turn = hypot((double)(hit.normal.x - path[0].normal.x),
                                      (double)(hit.normal.y - path[0].normal.y));
            normal = fmax(normal, steep * turn);
        }
        plumb_world_destroy(w);
    }
    print_message("%d met: places within %.2g m, normals within %.2g\n", met, place, normal);
    assert_true(met > 1500 && place < TOLERANCE(5e-6, 1e-13) && normal < TOLERANCE(3e-5, 1e-12));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_power_is_lost),
        cmocka_unit_test(ways_can_be_gone_back),
        cmocka_unit_test(any_view_is_the_same),
        cmocka_unit_test(opaque_shapes_are_met_as_by_rays),
    };
    return cmocka_run_group_tests_name("rays of light in any scene", tests, NULL, NULL);
}
