// test_answers.c - no answer depends on history: a world that is restored from an image answers every question, draws
// and steps as the one does that was saved, whatever has come, gone, slept or changed its type since grids were filed.
#include "session.h"

#include "harness/random.h"
#include "harness/trials.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 40, SESSIONS = 30, QUESTIONS = 8, MOST = 96 };

// All that a world says to one question.
typedef struct answer {
    int rays, casts, shapes, near, pieces;
    plumb_light_segment light[MOST];
    plumb_light_sum sum;
    plumb_ray_hit ray[MOST];
    plumb_cast_hit cast[MOST];
    plumb_shape shape[MOST];
    plumb_nearest_hit nearest[MOST];
    plumb_ray_hit first;
    plumb_nearest_hit best;
    bool any;
} answer;

typedef struct question {
    plumb_vec2 from, to;
    plumb_query_filter filter;
} question;

static question draw_question(const session *s, uint32_t *seed)
{
    const double range[] = { -8, -1 };
    question q = { 0 };
    q.from = plumb_v2((plumb_real)sim_uniform(seed, range[0], 8),
                      (plumb_real)sim_uniform(seed, range[1], 6));
    q.to = plumb_v2((plumb_real)sim_uniform(seed, range[0], 8),
                    (plumb_real)sim_uniform(seed, range[1], 6));
    const uint32_t bits = sim_random(seed);
    q.filter.ignore_static = bits % 2 != 0;
    q.filter.ignore_dynamic = bits / 2 % 4 == 0;
    q.filter.sensors = bits / 8 % 2 != 0;
    q.filter.one_way = bits / 16 % 2 != 0;
    const plumb_body body = s->body[bits / 64 % SESSION_BODIES];
    if (bits / 32 % 2 != 0 && plumb_body_valid(s->world, body)) {
        q.filter.ignore_body = body;
    }
    return q;
}

static void ask(plumb_world *w, const question *q, answer *a)
{
    plumb_convex disc;
    memset(a, 0, sizeof *a);
    assert_int_equal(plumb_convex_circle((plumb_vec2){ 0, 0 }, (plumb_real)0.3, &disc), PLUMB_OK);
    const plumb_cast cast = { &disc,
                              { q->from, plumb_rot_identity() },
                              plumb_vec2_sub(q->to, q->from) };
    a->rays = plumb_world_ray_all(w, q->from, q->to, &q->filter, a->ray, MOST);
    a->casts = plumb_world_cast_all(w, &cast, &q->filter, a->cast, MOST);
    const plumb_aabb box = { plumb_vec2_min(q->from, q->to), plumb_vec2_max(q->from, q->to) };
    a->shapes = plumb_world_overlap_aabb(w, box, &q->filter, a->shape, MOST);
    a->near = plumb_world_nearest_all(w, q->from, 3, &q->filter, a->nearest, MOST);
    plumb_world_ray(w, q->from, q->to, &q->filter, &a->first);
    plumb_world_nearest(w, q->from, 3, &q->filter, &a->best);
    a->any = plumb_world_ray_any(w, q->from, q->to, &q->filter);
    const plumb_light_desc light = { .from = q->from,
                                     .direction = plumb_vec2_sub(q->to, q->from),
                                     .length = 20 };
    a->pieces = plumb_world_light(w, &light, &q->filter, a->light, MOST, &a->sum);
    assert_true(a->pieces > 0 && a->rays >= 0 && a->casts >= 0 && a->shapes >= 0 && a->near >= 0);
}

static void count_fill(void *context, const plumb_vec2 *points, int count, plumb_color color)
{
    (void)points;
    (void)color;
    *(int *)context += count;
}

static void no_line(void *context, plumb_vec2 a, plumb_vec2 b, plumb_color color)
{
    (void)context;
    (void)a;
    (void)b;
    (void)color;
}

// Corners of all that is drawn.
static int drawn(plumb_world *w)
{
    int corners = 0;
    const plumb_draw_calls calls = { .line = no_line, .fill = count_fill, .context = &corners };
    assert_int_equal(plumb_draw(w, &calls, &(plumb_draw_desc){ .parts = PLUMB_DRAW_SHAPES }),
                     PLUMB_OK);
    return corners;
}

// What one answers otherwise than the other; null: nothing.
static const char *other_answer(const session *a, const session *b, uint32_t *seed)
{
    static answer x, y;
    // What wraps around is drawn by each image whose fat box is in view.
    const bool draws_alike = a->wrapped || drawn(a->world) == drawn(b->world);
    const char *other = draws_alike ? NULL : "drawing";
    for (int i = 0; other == NULL && i < QUESTIONS; ++i) {
        const question q = draw_question(a, seed);
        ask(a->world, &q, &x);
        ask(b->world, &q, &y);
        other = x.rays != y.rays || memcmp(x.ray, y.ray, sizeof x.ray) != 0             ? "ray"
                : x.casts != y.casts || memcmp(x.cast, y.cast, sizeof x.cast) != 0      ? "cast"
                : x.shapes != y.shapes || memcmp(x.shape, y.shape, sizeof x.shape) != 0 ? "overlap"
                : x.near != y.near || memcmp(x.nearest, y.nearest, sizeof x.nearest) != 0
                    ? "nearest"
                : x.pieces != y.pieces || memcmp(x.light, y.light, sizeof x.light) != 0 ? "light"
                : memcmp(&x.first, &y.first, sizeof x.first) != 0 ? "first ray"
                : memcmp(&x.best, &y.best, sizeof x.best) != 0    ? "best"
                : x.any != y.any                                  ? "any"
                                                                  : NULL;
    }
    return other;
}

static void copy_into(const plumb_world *from, plumb_world *to)
{
    const size_t size = plumb_world_snapshot_size(from);
    char *bytes = malloc(size);
    assert_non_null(bytes);
    assert_int_equal(plumb_world_save(from, bytes, size), PLUMB_OK);
    assert_int_equal(plumb_world_restore(to, bytes, size), PLUMB_OK);
    free(bytes);
}

static bool have_equal_images(const plumb_world *a, const plumb_world *b)
{
    const size_t size = plumb_world_snapshot_size(a);
    char *x = malloc(size), *y = malloc(size);
    assert_true(x != NULL && y != NULL);
    const bool same = plumb_world_snapshot_size(b) == size &&
                      plumb_world_save(a, x, size) == PLUMB_OK &&
                      plumb_world_save(b, y, size) == PLUMB_OK && memcmp(x, y, size) == 0;
    free(x);
    free(y);
    return same;
}

// What differs in a session; null: nothing.
static const char *differs(uint32_t number, int *step)
{
    session a, b;
    uint32_t seed = number + 5;
    const char *wrong = NULL;
    session_begin(&a, number, NULL);
    for (*step = 0; wrong == NULL && *step < STEPS; ++*step) {
        session_act(&a);
        session_twin(&b, &a, NULL);
        copy_into(a.world, b.world);
        if (sim_random(&seed) % 2 == 0) { // else the step comes to what nobody has asked
            wrong = other_answer(&a, &b, &seed);
        }
        const plumb_real dt = session_dt(&a);
        assert_int_equal(plumb_world_step(a.world, dt), plumb_world_step(b.world, dt));
        if (wrong == NULL && !have_equal_images(a.world, b.world)) {
            wrong = "image after the step";
        } else if (wrong == NULL) {
            wrong = other_answer(&a, &b, &seed);
        }
        session_end(&b);
    }
    session_end(&a);
    return wrong;
}

static void test_no_answer_depends_on_history(void **state)
{
    (void)state;
    const trials t = trials_from(0, SESSIONS);
    uint32_t failures = 0;
    for (uint32_t i = t.first; i < t.end; ++i) {
        int step;
        const char *wrong = differs(i, &step);
        if (wrong != NULL) {
            print_error("session %" PRIu32 ", step %d: other %s\n", i, step, wrong);
            ++failures;
        }
    }
    print_message("%" PRIu32 " sessions, failures %" PRIu32 "\n", t.end - t.first, failures);
    assert_int_equal(failures, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_answer_depends_on_history),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
