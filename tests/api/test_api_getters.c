// test_api_getters.c - every getter of a body, a shape or a joint, one by one from a table: a bad handle is told
// in the log, and no answer is other than finite, however large what a session is made of.
#include "getters.h"
#include "world_fixture.h"

#include "harness/random.h"
#include "harness/trials.h"

#include <stdio.h>
#include <stdlib.h>

static bool real_is_finite(plumb_real x)
{
    return plumb_is_finite(x);
}

static bool truth_is_finite(bool x)
{
    return x || !x;
}

static bool int_is_finite(int x)
{
    return x >= 0;
}

static bool pointer_is_finite(const void *x)
{
    return x == NULL;
}

static bool frame_is_finite(plumb_transform t)
{
    return plumb_vec2_is_finite(t.p) && plumb_is_finite(t.q.c) && plumb_is_finite(t.q.s);
}

static bool box_is_finite(plumb_aabb b)
{
    return plumb_vec2_is_finite(b.min) && plumb_vec2_is_finite(b.max);
}

static bool mass_is_finite(plumb_mass_properties m)
{
    return plumb_is_finite(m.mass) && plumb_vec2_is_finite(m.center) && plumb_is_finite(m.inertia);
}

static bool one_way_is_finite(plumb_one_way o)
{
    return plumb_vec2_is_finite(o.direction) && plumb_is_finite(o.angle);
}

#define IS_FINITE(value)                                                                           \
    _Generic((value), plumb_real                                                                   \
             : real_is_finite, bool                                                                \
             : truth_is_finite, int                                                                \
             : int_is_finite, void *                                                               \
             : pointer_is_finite, plumb_vec2                                                       \
             : plumb_vec2_is_finite, plumb_transform                                               \
             : frame_is_finite, plumb_aabb                                                         \
             : box_is_finite, plumb_mass_properties                                                \
             : mass_is_finite, plumb_one_way                                                       \
             : one_way_is_finite)(value)

#define NAME_OF(name, answer) #name,
static const char *const names[] = { BODY_GETTERS(NAME_OF) SHAPE_GETTERS(NAME_OF)
                                         JOINT_GETTERS(NAME_OF) };

//---- bad handles ---------------------------------------------------------------------------------

// One refusal, in the name of the function that was called.
static void check_told(fixture *f, const char *name, int before)
{
    if (f->errors != before + 1 || strncmp(f->logged, name, strlen(name)) != 0 ||
        plumb_world_error(f->world).code != PLUMB_E_HANDLE) {
        fail_msg("%s: %d refusals, the last '%s'", name, f->errors - before, f->logged);
    }
}

#define ASK_BADLY(name, answer)                                                                    \
    {                                                                                              \
        int before = f->errors;                                                                    \
        (void)(answer);                                                                            \
        check_told(f, #name, before);                                                              \
    }

static void bad_handles_are_told_by_every_getter(void **state)
{
    fixture *f = *state;
    const plumb_world *w = f->world;
    const plumb_vec2 point = { 1, 2 };
    const plumb_entity bad[] = {
        PLUMB_NULL_ENTITY_INIT, f->stale.entity, f->wood.entity, { 9999, 1 }
    };
    for (int i = 0; i < 4; ++i) {
        {
            plumb_body h = { bad[i] };
            BODY_GETTERS(ASK_BADLY)
        }
        {
            plumb_shape h = { bad[i] };
            SHAPE_GETTERS(ASK_BADLY)
        }
        plumb_joint h = { bad[i] };
        JOINT_GETTERS(ASK_BADLY)
    }
    int before = f->errors; // questions about the handle itself
    assert_false(plumb_body_valid(w, f->stale) || plumb_entity_alive(w, f->stale.entity));
    assert_int_equal(plumb_entity_get_kind(w, f->stale.entity), PLUMB_KIND_NONE);
    assert_int_equal(f->errors, before);
    assert_null(plumb_component_get(f->world, f->stale.entity, f->health));
    check_told(f, "plumb_component_get", before);
}

// Whether a declaration is that of a getter by one handle, which answers with no result code.
static bool is_getter(const char *declaration)
{
    static const char *const first[] = { "(const plumb_world *world, plumb_body ",
                                         "(const plumb_world *world, plumb_shape ",
                                         "(const plumb_world *world, plumb_joint " };
    bool takes = false; // "plumb_shape " and no star: a handle, not room for some
    for (int i = 0; i < 3; ++i) {
        const char *at = strstr(declaration, first[i]);
        takes = takes || (at != NULL && at[strlen(first[i])] != '*');
    }
    return takes && strncmp(declaration, "PLUMB_API plumb_result ", 23) != 0 &&
           strstr(declaration, "_valid(") == NULL;
}

static bool is_listed(const char *declaration)
{
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        const char *at = strstr(declaration, names[i]);
        if (at != NULL && at[strlen(names[i])] == '(') {
            return true;
        }
    }
    // Both answer -1 on an error, and have tests of their own.
    return strstr(declaration, "plumb_shape_overlaps(") != NULL ||
           strstr(declaration, "plumb_character_hits(") != NULL;
}

// A getter that is new in the headers, and in no table above, fails here.
static void every_getter_of_the_headers_is_tested(void **state)
{
    (void)state;
    static const char *const headers[] = {
        "body", "shape", "joint", "sleep", "character", "event"
    };
    int count = 0;
    for (size_t i = 0; i < sizeof headers / sizeof headers[0]; ++i) {
        char path[64], line[512];
        snprintf(path, sizeof path, "include/plumb/%s.h", headers[i]);
        FILE *file = fopen(path, "r");
        assert_non_null(file);
        while (fgets(line, sizeof line, file) != NULL) {
            if (strncmp(line, "PLUMB_API", 9) == 0 && is_getter(line)) {
                ++count;
                if (!is_listed(line)) {
                    fail_msg("%s: not in the tables of test_api_getters.c: %s", path, line);
                }
            }
        }
        fclose(file);
    }
    assert_true(count > 50);
}

//---- finite answers ------------------------------------------------------------------------------

#define MOST_THINGS 24

typedef struct session {
    plumb_world *world;
    uint64_t seed;
    uint32_t state;
    plumb_body bodies[MOST_THINGS];
    plumb_shape shapes[MOST_THINGS];
    plumb_joint joints[MOST_THINGS];
    int body_count, shape_count, joint_count;
} session;

static double uniform(session *s)
{
    return sim_uniform(&s->state, 0, 1);
}

// 10^low to 10^high, evenly in the exponent; the sign as it comes.
static plumb_real scaled(session *s, double low, double high)
{
    double size = pow(10, low + (high - low) * uniform(s));
    return (plumb_real)(uniform(s) < 0.5 ? -size : size);
}

static plumb_real size_of(session *s, double low, double high)
{
    return plumb_abs(scaled(s, low, high));
}

static plumb_vec2 vec(session *s, double low, double high)
{
    plumb_real x = scaled(s, low, high), y = scaled(s, low, high);
    return plumb_v2(x, y);
}

static plumb_body any_body(session *s)
{
    bool none = s->body_count == 0 || uniform(s) < 0.15;
    return none ? NO_BODY : s->bodies[(int)(uniform(s) * s->body_count)];
}

static void add_body(session *s)
{
    plumb_body_desc d = { .type = (plumb_body_type)(uniform(s) * 2), .position = vec(s, -2, 9) };
    d.velocity = vec(s, -3, 9);
    d.angular_velocity = scaled(s, -3, 6);
    d.mass = d.type == PLUMB_DYNAMIC ? size_of(s, -30, 35) : 0;
    d.inertia = d.type == PLUMB_DYNAMIC && uniform(s) < 0.3 ? size_of(s, -30, 35) : 0;
    plumb_body body = plumb_body_create(s->world, &d);
    plumb_shape_desc circle = { .kind = PLUMB_CIRCLE, .radius = size_of(s, -1, 4) };
    plumb_shape_desc box = { .kind = PLUMB_BOX };
    box.half = plumb_v2(size_of(s, -1, 4), size_of(s, -1, 4));
    plumb_shape shape = plumb_shape_create(s->world, body, uniform(s) < 0.5 ? &circle : &box);
    if (!plumb_is_null(body)) {
        s->bodies[s->body_count++] = body;
    }
    if (!plumb_is_null(shape)) {
        s->shapes[s->shape_count++] = shape;
    }
}

static void add_joint(session *s)
{
    plumb_joint_desc d = { .kind = (plumb_joint_kind)(uniform(s) * (PLUMB_FRICTION + 1)) };
    d.body_a = any_body(s);
    d.body_b = any_body(s);
    d.anchor = vec(s, -2, 9);
    bool sliding = d.kind == PLUMB_PRISMATIC || d.kind == PLUMB_WHEEL;
    if (sliding || d.kind == PLUMB_REVOLUTE) {
        d.enable_motor = uniform(s) < 0.5;
        d.motor_speed = scaled(s, -3, 38);
        d.max_motor = size_of(s, -3, 38);
    }
    if (sliding || d.kind == PLUMB_REVOLUTE || d.kind == PLUMB_WELD || d.kind == PLUMB_MOTOR) {
        d.hertz = uniform(s) < 0.5 ? size_of(s, -3, 9) : 0;
        d.damping = size_of(s, -3, 9);
        d.rest = scaled(s, -3, 38);
        if (uniform(s) < 0.3) {
            d.hertz = d.damping = 0;
            d.stiffness = size_of(s, -3, 38);
            d.damper = uniform(s) < 0.5 ? size_of(s, -3, 38) : 0;
        }
    }
    if (d.kind == PLUMB_DISTANCE || d.kind == PLUMB_PULLEY || d.kind == PLUMB_CABLE) {
        d.anchor_b = vec(s, -2, 9);
    }
    if (d.kind == PLUMB_PULLEY) {
        d.ground_a = vec(s, -2, 9);
        d.ground_b = vec(s, -2, 9);
        d.ratio = size_of(s, -3, 38);
    }
    d.ratio = d.kind == PLUMB_GEAR ? scaled(s, -3, 38) : d.ratio;
    d.pitch = d.kind == PLUMB_RATCHET ? scaled(s, -3, 38) : 0;
    if (d.kind == PLUMB_MOTOR || d.kind == PLUMB_FRICTION) {
        d.max_force = uniform(s) < 0.5 ? size_of(s, -3, 38) : 0;
        d.max_torque = uniform(s) < 0.5 ? size_of(s, -3, 38) : 0;
    }
    plumb_joint joint = plumb_joint_create(s->world, &d);
    if (!plumb_is_null(joint)) {
        s->joints[s->joint_count++] = joint;
        plumb_joint_set_target(s->world, joint, vec(s, -3, 38));
        plumb_joint_set_limit(s->world, joint, uniform(s) < 0.5, 0, size_of(s, -3, 38));
    }
}

static void disturb(session *s)
{
    plumb_body body = s->bodies[(int)(uniform(s) * s->body_count)];
    plumb_body_apply_force(s->world, body, vec(s, -3, 38), vec(s, -3, 9));
    plumb_body_apply_impulse(s->world, body, vec(s, -3, 38), vec(s, -3, 9));
    plumb_body_apply_torque(s->world, body, scaled(s, -3, 38));
    plumb_body_set_velocity(s->world, body, vec(s, -3, 11));
}

static int broken_answers;

static void check_finite(bool finite, const char *name, const session *s)
{
    if (!finite) {
        ++broken_answers;
        print_message("%s is not finite (seed %llu)\n", name, (unsigned long long)s->seed);
    }
}

#define ASK(name, answer) check_finite(IS_FINITE(answer), #name, s);

static void ask_everything(session *s)
{
    const plumb_world *w = s->world;
    const plumb_vec2 point = vec(s, -3, 9);
    for (int i = 0; i < s->body_count; ++i) {
        plumb_body h = s->bodies[i];
        BODY_GETTERS(ASK)
    }
    for (int i = 0; i < s->shape_count; ++i) {
        plumb_shape h = s->shapes[i];
        SHAPE_GETTERS(ASK)
    }
    for (int i = 0; i < s->joint_count; ++i) {
        plumb_joint h = s->joints[i];
        if (!plumb_joint_valid(w, h)) {
            continue;
        }
        JOINT_GETTERS(ASK)
    }
    plumb_energy e = plumb_world_energy(w);
    check_finite(isfinite(e.kinetic) && isfinite(e.potential) && isfinite(e.momentum_x) &&
                     isfinite(e.momentum_y) && isfinite(e.angular_momentum) && isfinite(e.mass),
                 "plumb_world_energy", s);
    plumb_stats stats = plumb_world_stats(w);
    check_finite(plumb_is_finite(stats.max_penetration) && plumb_is_finite(stats.mean_penetration),
                 "plumb_world_stats", s);
}

static void run_session(uint64_t seed)
{
    session s = { .seed = seed, .state = (uint32_t)seed };
    plumb_world_desc d = { .solver = (plumb_solver)(seed % 2), .no_sleep = seed % 3 == 0 };
    assert_int_equal(plumb_world_create(&d, &s.world), PLUMB_OK);
    for (int i = 0; i < 6; ++i) {
        add_body(&s);
    }
    for (int i = 0; i < 8; ++i) {
        add_joint(&s);
    }
    for (int step = 0; step < 6 && s.body_count > 0; ++step) {
        plumb_world_step(s.world, size_of(&s, -4, 0));
        ask_everything(&s);
        disturb(&s);
        ask_everything(&s);
    }
    plumb_world_destroy(s.world);
}

static void answers_are_finite_whatever_a_session_is_made_of(void **state)
{
    (void)state;
    const trials t = trials_from(1, 2000);
    for (uint32_t seed = t.first; seed < t.end && broken_answers < 20; ++seed) {
        run_session(seed * UINT64_C(7919));
    }
    assert_int_equal(broken_answers, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        API_TEST(bad_handles_are_told_by_every_getter),
        cmocka_unit_test(every_getter_of_the_headers_is_tested),
        cmocka_unit_test(answers_are_finite_whatever_a_session_is_made_of),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
