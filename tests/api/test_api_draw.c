// test_api_draw.c - plumb/draw.h: what each part draws, where, in which colour; what is left out; refusals.
#include "harness/heap.h"
#include "harness/random.h"
#include "world_fixture.h"

enum { MOST = 4000 };

typedef struct stroke {
    plumb_vec2 a, b; // of a fill: its box
    plumb_color color;
    int corners; // of a fill
    double area;
} stroke;

typedef struct canvas {
    stroke lines[MOST], fills[MOST], points[MOST];
    int line_count, fill_count, point_count, text_count;
    const char *last_text;
    plumb_world *world;
} canvas;

static void on_line(void *context, plumb_vec2 a, plumb_vec2 b, plumb_color color)
{
    canvas *c = context;
    assert_true(c->line_count < MOST);
    c->lines[c->line_count++] = (stroke){ .a = a, .b = b, .color = color };
}

static void on_fill(void *context, const plumb_vec2 *points, int count, plumb_color color)
{
    canvas *c = context;
    assert_true(c->fill_count < MOST);
    assert_in_range(count, 3, 64);
    stroke s = { .a = points[0], .b = points[0], .color = color, .corners = count };
    for (int i = 0; i < count; ++i) {
        const plumb_vec2 p = points[i], q = points[(i + 1) % count], r = points[(i + 2) % count];
        s.a = plumb_vec2_min(s.a, p);
        s.b = plumb_vec2_max(s.b, p);
        s.area += (double)plumb_vec2_cross(p, q) / 2;
        // Convex and counter-clockwise.
        assert_true(plumb_vec2_cross(plumb_vec2_sub(q, p), plumb_vec2_sub(r, q)) > R(-1e-4));
    }
    c->fills[c->fill_count++] = s;
}

static void on_point(void *context, plumb_vec2 at, plumb_color color)
{
    canvas *c = context;
    c->points[c->point_count++] = (stroke){ .a = at, .b = at, .color = color };
}

static void on_text(void *context, plumb_vec2 at, const char *text, plumb_color color)
{
    canvas *c = context;
    (void)at;
    (void)color;
    ++c->text_count;
    c->last_text = text;
}

static canvas page;

static const canvas *draw(plumb_world *w, plumb_draw_desc desc)
{
    page = (canvas){ .world = w };
    const plumb_draw_calls calls = {
        .line = on_line, .fill = on_fill, .point = on_point, .text = on_text, .context = &page
    };
    assert_int_equal(plumb_draw(w, &calls, &desc), PLUMB_OK);
    return &page;
}

static bool is_paint(plumb_color c, plumb_paint paint)
{
    return memcmp(&c, &plumb_draw_palette()[paint], sizeof c) == 0;
}

static plumb_world *empty_world(plumb_world_desc desc)
{
    plumb_world *w;
    assert_int_equal(plumb_world_create(&desc, &w), PLUMB_OK);
    return w;
}

static plumb_body add(plumb_world *w, plumb_vec2 at, plumb_shape_desc shape)
{
    const plumb_body body =
        plumb_body_create(w, &(plumb_body_desc){ .position = at, .angle = R(0.7) });
    assert_false(plumb_is_null(plumb_shape_create(w, body, &shape)));
    return body;
}

// Of every kind, what is filled has the area and the box of the shape.
static void shapes_are_where_they_are(void **state)
{
    (void)state;
    const plumb_vec2 corners[] = { { -1, -1 }, { 1, -1 }, { R(0.1), 0 }, { 1, 2 }, { -1, 1 } };
    const plumb_shape_desc shapes[] = {
        { .kind = PLUMB_CIRCLE, .radius = R(0.8), .center = { 1, 0 } },
        { .kind = PLUMB_CAPSULE, .points = corners, .count = 2, .radius = R(0.3) },
        { .kind = PLUMB_BOX, .half = { 1, R(0.5) } },
        { .kind = PLUMB_BOX, .half = { 1, R(0.5) }, .radius = R(0.2) },
        { .kind = PLUMB_POLYGON, .points = corners, .count = 5 },
        { .kind = PLUMB_POLYGON, .points = corners, .count = 5, .radius = R(0.1) },
        { .kind = PLUMB_OUTLINE, .points = corners, .count = 5 },
    };
    for (size_t i = 0; i < sizeof shapes / sizeof shapes[0]; ++i) {
        plumb_world *w = empty_world((plumb_world_desc){ .zero_gravity = true });
        const plumb_body body = add(w, plumb_v2(3, 4), shapes[i]);
        plumb_shape shape;
        assert_int_equal(plumb_body_shapes(w, body, &shape, 1), 1);
        const canvas *c = draw(w, (plumb_draw_desc){ .pixel = R(0.002) });
        plumb_aabb box = { { 1e6f, 1e6f }, { -1e6f, -1e6f } };
        double area = 0;
        for (int k = 0; k < c->fill_count; ++k) {
            box.min = plumb_vec2_min(box.min, c->fills[k].a);
            box.max = plumb_vec2_max(box.max, c->fills[k].b);
            area += c->fills[k].area;
            assert_true(is_paint(c->fills[k].color, PLUMB_PAINT_DYNAMIC));
        }
        const plumb_aabb wanted = plumb_shape_aabb(w, shape);
        assert_near(area, plumb_shape_mass(w, shape).mass, 0.01 * area);
        assert_vec_near(box.min, wanted.min.x, wanted.min.y, 6e-3);
        assert_vec_near(box.max, wanted.max.x, wanted.max.y, 6e-3);
        // Inner cuts are no lines: the outline's perimeter is drawn, no more.
        if (shapes[i].kind == PLUMB_OUTLINE) {
            double length = 0, perimeter = 0;
            for (int k = 0; k < c->line_count; ++k) {
                length += (double)plumb_vec2_distance(c->lines[k].a, c->lines[k].b);
            }
            for (int k = 0; k < 5; ++k) {
                perimeter += (double)plumb_vec2_distance(corners[k], corners[(k + 1) % 5]);
            }
            assert_true(c->fill_count > 1);
            assert_near(length, perimeter, ROUNDED(1e-3));
        }
        plumb_world_destroy(w);
    }
    plumb_world *w = empty_world((plumb_world_desc){ .zero_gravity = true });
    add(w, plumb_v2(0, 0),
        (plumb_shape_desc){ .kind = PLUMB_SEGMENT, .points = corners, .count = 2 });
    const canvas *c = draw(w, (plumb_draw_desc){ 0 });
    assert_int_equal(c->fill_count, 0);
    assert_int_equal(c->line_count, 1);
    assert_near(plumb_vec2_distance(c->lines[0].a, c->lines[0].b), 2, ROUNDED(1e-5));
    plumb_world_destroy(w);
}

static int painted(const canvas *c, plumb_paint paint)
{
    int count = 0;
    for (int i = 0; i < c->fill_count; ++i) {
        count += is_paint(c->fills[i].color, paint);
    }
    return count;
}

static plumb_color rose(void *context, plumb_shape shape, plumb_color by_state)
{
    const canvas *c = context;
    const bool sensor = plumb_shape_is_sensor(c->world, shape);
    return sensor ? by_state : (plumb_color){ 255, 0, 128, by_state.a };
}

static void colours_tell_the_state(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    plumb_shape_create(
        w, f->fixed,
        &(plumb_shape_desc){
            .kind = PLUMB_CIRCLE, .radius = 1, .center = { 30, 0 }, .sensor = true });
    const canvas *c = draw(w, (plumb_draw_desc){ 0 });
    assert_int_equal(painted(c, PLUMB_PAINT_STATIC), 1);
    assert_int_equal(painted(c, PLUMB_PAINT_KINEMATIC), 1);
    assert_int_equal(painted(c, PLUMB_PAINT_DYNAMIC), 1);
    assert_int_equal(painted(c, PLUMB_PAINT_SENSOR), 1);
    assert_int_equal(plumb_body_sleep(w, f->dynamic), PLUMB_OK);
    c = draw(w, (plumb_draw_desc){ 0 });
    assert_int_equal(painted(c, PLUMB_PAINT_ASLEEP), 1);
    assert_int_equal(painted(c, PLUMB_PAINT_DYNAMIC), 0);
    plumb_body_set_enabled(w, f->dynamic, false);
    assert_int_equal(draw(w, (plumb_draw_desc){ 0 })->fill_count, 3);
    plumb_color mine[PLUMB_PAINT_COUNT] = { [PLUMB_PAINT_STATIC] = { 1, 2, 3, 4 } };
    c = draw(w, (plumb_draw_desc){ .palette = mine });
    assert_true(c->fills[0].color.r + c->fills[1].color.r == 1);
    c = draw(w, (plumb_draw_desc){ .color = rose });
    int roses = 0;
    for (int i = 0; i < c->fill_count; ++i) {
        roses += c->fills[i].color.r == 255 && c->fills[i].color.b == 128;
    }
    assert_int_equal(roses, 2);
}

// What is out of view is not even looked at; what reaches into it is.
static void a_view_culls(void **state)
{
    (void)state;
    plumb_world *w = empty_world((plumb_world_desc){ .zero_gravity = true });
    uint32_t seed = 9;
    plumb_body bodies[300];
    for (int i = 0; i < 300; ++i) {
        const plumb_vec2 at =
            plumb_v2(R(sim_uniform(&seed, -100, 100)), R(sim_uniform(&seed, -100, 100)));
        bodies[i] = add(w, at, (plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 1, 1 } });
    }
    for (int round = 0; round < 2; ++round) { // by grids of its own, and by those of the step
        const plumb_aabb view = { { -30, -20 }, { 40, 25 } };
        const canvas *c = draw(w, (plumb_draw_desc){ .view = view });
        int wanted = 0, drawn = 0;
        for (int i = 0; i < 300; ++i) {
            plumb_shape shape;
            plumb_body_shapes(w, bodies[i], &shape, 1);
            const plumb_aabb b = plumb_shape_aabb(w, shape);
            wanted += b.max.x > view.min.x && b.min.x < view.max.x && b.max.y > view.min.y &&
                      b.min.y < view.max.y;
        }
        for (int i = 0; i < c->fill_count; ++i) {
            const stroke *s = &c->fills[i];
            drawn += s->b.x > view.min.x && s->a.x < view.max.x && s->b.y > view.min.y &&
                     s->a.y < view.max.y;
        }
        assert_int_equal(drawn, wanted);
        assert_in_range(c->fill_count, wanted, wanted + wanted / 4);
        assert_in_range(wanted, 10, 60);
        plumb_world_step(w, R(0.01));
    }
    plumb_world_destroy(w);
}

static void worlds_that_wrap_are_drawn_by_every_image(void **state)
{
    (void)state;
    plumb_world *w = empty_world((plumb_world_desc){ .zero_gravity = true, .wrap_x = 20 });
    add(w, plumb_v2(R(9.8), 0), (plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1 });
    const canvas *c = draw(w, (plumb_draw_desc){ .view = { { -10, -5 }, { 10, 5 } } });
    assert_int_equal(c->fill_count, 2); // at both edges
    assert_near(fabs((double)(c->fills[0].a.x - c->fills[1].a.x)), 20, ROUNDED(1e-4));
    c = draw(w, (plumb_draw_desc){ .view = { { -50, -5 }, { 50, 5 } } });
    assert_in_range(c->fill_count, 5, 6);
    c = draw(w, (plumb_draw_desc){ .view = { { R(105), -5 }, { R(114), 5 } } });
    assert_int_equal(c->fill_count, 1);
    assert_near((c->fills[0].a.x + c->fills[0].b.x) / 2, 109.8, 1e-2);
    c = draw(w, (plumb_draw_desc){ 0 });
    assert_in_range(c->fill_count, 1, 2);
    plumb_world_destroy(w);
}

static const char *name_of(void *context, plumb_body body)
{
    const canvas *c = context;
    return plumb_body_get_type(c->world, body) == PLUMB_DYNAMIC ? "crate" : NULL;
}

static void the_other_parts(void **state)
{
    (void)state;
    plumb_world *w = empty_world((plumb_world_desc){ 0 });
    const plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(
        w, ground,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 20, 1 }, .center = { 0, -1 } });
    const plumb_body crate = plumb_body_create(w, &(plumb_body_desc){ .position = { 0, R(0.5) } });
    plumb_shape_create(
        w, crate,
        &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { R(0.5), R(0.5) }, .density = 4 });
    const plumb_body hung = plumb_body_create(w, &(plumb_body_desc){ .position = { 5, 3 } });
    plumb_shape_create(w, hung, &(plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.5) });
    plumb_joint_create(
        w, &(plumb_joint_desc){
               .kind = PLUMB_DISTANCE, .body_b = hung, .anchor = { 5, 6 }, .anchor_b = { 5, 3 } });
    for (int i = 0; i < 20; ++i) {
        plumb_world_step(w, R(1.0 / 60));
    }
    const canvas *c = draw(w, (plumb_draw_desc){ .parts = PLUMB_DRAW_JOINTS });
    assert_int_equal(c->fill_count, 0);
    assert_int_equal(c->line_count, 1);
    assert_vec_near(c->lines[0].a, 5, 6, ROUNDED(1e-3));
    assert_vec_near(c->lines[0].b, 5, 3, 1e-2);
    assert_int_equal(c->point_count, 2);
    c = draw(w, (plumb_draw_desc){ .parts = PLUMB_DRAW_CONTACTS });
    assert_int_equal(c->point_count, 2);
    assert_int_equal(c->line_count, 2);
    assert_near(c->points[0].a.y, 0, 0.01);
    // Two points bear 4 kg; the rod bears the disc.
    c = draw(w, (plumb_draw_desc){ .parts = PLUMB_DRAW_FORCES, .force_scale = R(0.01) });
    double weight = 0;
    for (int i = 0; i < c->line_count; ++i) {
        assert_true(is_paint(c->lines[i].color, PLUMB_PAINT_FORCE));
        weight += fabs((double)(c->lines[i].b.y - c->lines[i].a.y));
    }
    assert_int_equal(c->line_count, 3);
    assert_near(weight, 0.01 * 9.81 * (4 + 3.14159 / 4), 0.01);
    c = draw(w, (plumb_draw_desc){ .parts = PLUMB_DRAW_BOXES });
    assert_int_equal(c->line_count, 12);
    c = draw(w, (plumb_draw_desc){ .parts = PLUMB_DRAW_CENTERS });
    assert_int_equal(c->line_count, 6);
    plumb_body_set_velocity(w, hung, plumb_v2(2, 0));
    c = draw(w, (plumb_draw_desc){ .parts = PLUMB_DRAW_VELOCITIES, .velocity_scale = 1 });
    bool seen = false;
    for (int i = 0; i < c->line_count; ++i) {
        seen |= fabs((double)(c->lines[i].b.x - c->lines[i].a.x) - 2) < 1e-4;
    }
    assert_true(seen);
    c = draw(w, (plumb_draw_desc){ .parts = PLUMB_DRAW_NAMES, .name = name_of });
    assert_int_equal(c->text_count, 2);
    assert_string_equal(c->last_text, "crate");
    // Lines alone are enough, for all there is.
    page = (canvas){ .world = w };
    const plumb_draw_calls calls = { .line = on_line, .context = &page };
    assert_int_equal(plumb_draw(w, &calls, &(plumb_draw_desc){ .parts = PLUMB_DRAW_ALL }),
                     PLUMB_OK);
    assert_true(page.line_count > 40);
    plumb_world_destroy(w);
}

static void a_loop_shows_bodies_between_steps(void **state)
{
    (void)state;
    plumb_world *w = empty_world((plumb_world_desc){ .zero_gravity = true });
    const plumb_body body =
        add(w, plumb_v2(0, 0), (plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = 1 });
    plumb_body_set_velocity(w, body, plumb_v2(10, 0));
    plumb_loop *loop;
    assert_int_equal(plumb_loop_create(w, &(plumb_loop_desc){ .dt = 0.1 }, &loop), PLUMB_OK);
    plumb_loop_step(loop);
    plumb_loop_frame(loop, 0.05);
    const uint64_t hash = plumb_world_hash(w);
    const canvas *c = draw(w, (plumb_draw_desc){ .loop = loop });
    assert_near((c->fills[0].a.x + c->fills[0].b.x) / 2, 0.5, ROUNDED(0.01));
    assert_true(plumb_world_hash(w) == hash);
    plumb_loop_destroy(loop);
    plumb_world_destroy(w);
}

static void draw_in_a_system(const plumb_system_call *call)
{
    const plumb_draw_calls calls = { .line = on_line, .context = &page };
    assert_int_equal(plumb_draw(call->world, &calls, NULL), PLUMB_E_LOCKED);
}

static void drawing_refuses(void **state)
{
    fixture *f = *state;
    plumb_world *w = f->world;
    page = (canvas){ .world = w };
    const plumb_draw_calls none = { .context = &page };
    const plumb_draw_calls calls = { .line = on_line, .context = &page };
    assert_int_equal(plumb_draw(NULL, &calls, NULL), PLUMB_E_NULL);
    REFUSED(E_NULL, "plumb_draw: calls is null; it must be given", plumb_draw(w, NULL, NULL));
    REFUSED(E_NULL, "plumb_draw: calls.line is null; it must be given", plumb_draw(w, &none, NULL));
    REFUSED(E_RANGE, "plumb_draw: parts is 0x100; it must be bits of plumb_draw_part",
            plumb_draw(w, &calls, &(plumb_draw_desc){ .parts = 256 }));
    REFUSED(E_RANGE, "plumb_draw: view is empty; min must be at most max",
            plumb_draw(w, &calls, &(plumb_draw_desc){ .view = { { 1, 0 }, { 0, 1 } } }));
    REFUSED(E_RANGE, "plumb_draw: pixel is -1; it must be at least 0",
            plumb_draw(w, &calls, &(plumb_draw_desc){ .pixel = -1 }));
    REFUSED(E_NOT_FINITE, "plumb_draw: view.max is (1, inf); it must be finite",
            plumb_draw(w, &calls, &(plumb_draw_desc){ .view = { { 0, 0 }, { 1, R(INFINITY) } } }));
    REFUSED(E_NOT_FINITE, "plumb_draw: force_scale is nan; it must be finite",
            plumb_draw(w, &calls, &(plumb_draw_desc){ .force_scale = R(NAN) }));
    REFUSED(E_RANGE, "plumb_draw: velocity_scale is -2; it must be at least 0",
            plumb_draw(w, &calls, &(plumb_draw_desc){ .velocity_scale = -2 }));
    assert_int_equal(page.line_count, 0);
    const plumb_system_desc system = { .name = "look",
                                       .phase = PLUMB_PHASE_END,
                                       .run = draw_in_a_system };
    assert_int_equal(plumb_system_create(w, &system), PLUMB_OK);
    assert_int_equal(plumb_world_step(w, R(0.01)), PLUMB_OK);
}

static void drawing_runs_out_of_memory(void **state)
{
    (void)state;
    heap h = HEAP_INIT;
    plumb_world *w = empty_world((plumb_world_desc){ .allocator = heap_allocator(&h) });
    const plumb_body ground = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    plumb_shape_create(w, ground, &(plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 20, 1 } });
    add(w, plumb_v2(0, R(1.4)), (plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = R(0.5) });
    plumb_world_step(w, R(0.01));
    const plumb_draw_calls calls = { .line = on_line, .context = &page };
    page = (canvas){ .world = w };
    heap_fail(&h, 0);
    assert_int_equal(plumb_draw(w, &calls, &(plumb_draw_desc){ .parts = PLUMB_DRAW_ALL }),
                     PLUMB_E_MEMORY);
    heap_fail(&h, -1);
    assert_int_equal(plumb_draw(w, &calls, &(plumb_draw_desc){ .parts = PLUMB_DRAW_ALL }),
                     PLUMB_OK);
    plumb_world_destroy(w);
    assert_int_equal(h.blocks, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shapes_are_where_they_are),
        API_TEST(colours_tell_the_state),
        cmocka_unit_test(a_view_culls),
        cmocka_unit_test(worlds_that_wrap_are_drawn_by_every_image),
        cmocka_unit_test(the_other_parts),
        cmocka_unit_test(a_loop_shows_bodies_between_steps),
        API_TEST(drawing_refuses),
        cmocka_unit_test(drawing_runs_out_of_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
