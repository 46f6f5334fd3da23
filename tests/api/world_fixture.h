// world_fixture.h - what the tests of the world's API share: a world with one body of each type and
// its log kept, a digest of all that a user can see, and the check of a refused call.
#ifndef WORLD_FIXTURE_H
#define WORLD_FIXTURE_H

#include "harness/near.h"
#include "plumb/plumb.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#define R(x) ((plumb_real)(x))

typedef struct fixture {
    plumb_world *world;
    plumb_body dynamic, kinematic, fixed; // a box each
    plumb_shape box;                      // of the dynamic body
    plumb_body stale;
    plumb_material wood;    // not used by any shape
    plumb_material used;    // used by the kinematic body's shape
    plumb_component health; // nobody has it
    char logged[512];       // the last line
    plumb_log_level level;
    int errors, warnings;
} fixture;

static inline void keep_log(void *context, plumb_log_level level, const char *message)
{
    fixture *f = context;
    strncpy(f->logged, message, sizeof f->logged - 1);
    f->level = level;
    f->errors += level == PLUMB_LOG_ERROR;
    f->warnings += level == PLUMB_LOG_WARN;
}

static inline int set_up(void **state)
{
    static fixture f;
    f = (fixture){ .errors = 0 };
    const plumb_world_desc desc = { .log = keep_log, .hook_context = &f };
    if (plumb_world_create(&desc, &f.world) != PLUMB_OK) {
        return -1;
    }
    plumb_world *w = f.world;
    plumb_shape_desc box = { .kind = PLUMB_BOX, .half = { 1, 1 } };
    f.stale = plumb_body_create(w, &(plumb_body_desc){ 0 });
    plumb_body_destroy(w, f.stale);
    f.wood = plumb_material_create(w, &(plumb_material_desc){ .density = 2, .friction = R(0.5) });
    f.used = plumb_material_create(w, &(plumb_material_desc){ .friction = 1 });
    f.dynamic = plumb_body_create(w, &(plumb_body_desc){ .position = { 0, 5 } });
    f.kinematic =
        plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_KINEMATIC, .position = { 10, 0 } });
    f.fixed = plumb_body_create(w, &(plumb_body_desc){ .type = PLUMB_STATIC });
    f.box = plumb_shape_create(w, f.dynamic, &box);
    plumb_shape_create(w, f.fixed, &box);
    box.material = f.used;
    plumb_shape_create(w, f.kinematic, &box);
    f.health = plumb_component_create(
        w, &(plumb_component_desc){ .name = "health", .size = sizeof(float) });
    *state = &f;
    return f.errors;
}

static inline int tear_down(void **state)
{
    plumb_world_destroy(((fixture *)*state)->world);
    return 0;
}

#define NO_ENTITY   ((plumb_entity)PLUMB_NULL_ENTITY_INIT)
#define NO_BODY     ((plumb_body)PLUMB_NULL_INIT)
#define NO_SHAPE    ((plumb_shape)PLUMB_NULL_INIT)
#define NO_MATERIAL ((plumb_material)PLUMB_NULL_INIT)

#define API_TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

//---- digest --------------------------------------------------------------------------------------

// FNV-1a over bytes.
static inline void digest_bytes(uint64_t *digest, const void *data, size_t bytes)
{
    for (size_t i = 0; i < bytes; ++i) {
        *digest = (*digest ^ ((const unsigned char *)data)[i]) * UINT64_C(1099511628211);
    }
}

// All that a user can see of a world: body columns, shapes, counts. Not memory and not the last
// error.
static inline uint64_t digest_world(plumb_world *w)
{
    uint64_t digest = UINT64_C(14695981039346656037);
    plumb_body_span b = plumb_world_bodies(w);
    const plumb_real *columns[] = { b.x,  b.y,      b.center_x, b.center_y,   b.c,
                                    b.s,  b.vx,     b.vy,       b.w,          b.fx,
                                    b.fy, b.torque, b.inv_mass, b.inv_inertia };
    digest_bytes(&digest, b.body, (size_t)b.count * sizeof *b.body);
    for (size_t i = 0; i < sizeof columns / sizeof columns[0] && b.count > 0; ++i) {
        digest_bytes(&digest, columns[i], (size_t)b.count * sizeof(plumb_real));
    }
    plumb_shape shapes[256];
    int count = plumb_world_shapes(w, shapes, 256);
    for (int i = 0; i < count && i < 256; ++i) {
        plumb_aabb box = plumb_shape_aabb(w, shapes[i]);
        plumb_material material = plumb_shape_material(w, shapes[i]);
        digest_bytes(&digest, &shapes[i], sizeof shapes[i]);
        digest_bytes(&digest, &box, sizeof box);
        digest_bytes(&digest, &material, sizeof material);
    }
    plumb_stats stats = plumb_world_stats(w);
    const uint64_t counts[] = { stats.step_count,      stats.body_count,   stats.dynamic_count,
                                stats.kinematic_count, stats.static_count, stats.shape_count,
                                stats.piece_count };
    digest_bytes(&digest, counts, sizeof counts);
    return digest;
}

//---- refused calls -------------------------------------------------------------------------------

// The code of a call that returns a handle: that of the last error when the handle is null.
#define made(w, handle) made_if(w, !plumb_is_null(handle))
static inline plumb_result made_if(const plumb_world *w, bool is)
{
    return is ? PLUMB_OK : plumb_world_error(w).code;
}

// The call gave `code` and left `message`, in the record and in the log, once. `before` is the
// digest.
static inline void check_refused(fixture *f, plumb_result got, uint64_t before, int errors,
                                 plumb_result code, const char *message)
{
    plumb_error error = plumb_world_error(f->world);
    assert_string_equal(error.message, message);
    assert_int_equal(got, code);
    assert_int_equal(error.code, code);
    assert_memory_equal(message, error.function, strlen(error.function));
    assert_int_equal(message[strlen(error.function)], ':');
    assert_string_equal(f->logged, message);
    assert_int_equal(f->errors, errors + 1);
    assert_int_equal(f->level, PLUMB_LOG_ERROR);
    assert_true(digest_world(f->world) == before);
}

#define REFUSED(code, message, call)                                                               \
    do {                                                                                           \
        uint64_t before_ = digest_world(f->world);                                                 \
        int errors_ = f->errors;                                                                   \
        plumb_result got_ = (call);                                                                \
        check_refused(f, got_, before_, errors_, PLUMB_##code, (message));                         \
    } while (0)

#endif
