/// base.h - what every other header of Plumb needs: the scalar type, result codes, entity
/// handles, and the hooks (memory, log, assert) that belong to a world.
///
/// Units are SI, angles radians, counter-clockwise from +x to +y. Headers compile as C17 and C++17.
#ifndef PLUMB_BASE_H
#define PLUMB_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PLUMB_VERSION_MAJOR 0
#define PLUMB_VERSION_MINOR 1
#define PLUMB_VERSION_PATCH 0
#define PLUMB_VERSION       "0.1.0"

#ifdef __cplusplus
#define PLUMB_BEGIN extern "C" {
#define PLUMB_END   }
#else
#define PLUMB_BEGIN
#define PLUMB_END
#endif

#if defined(PLUMB_BUILD_SHARED) && defined(__GNUC__)
#define PLUMB_API __attribute__((visibility("default")))
#else
#define PLUMB_API
#endif

PLUMB_BEGIN

/// The scalar of the whole library: float by default, double when PLUMB_DOUBLE or PLUMB_FAR is defined to 1.
/// PLUMB_FAR is for worlds that reach far from the origin: places are doubles, to 1e8 m and beyond, but the solver
/// and the narrow phase, which only know how bodies lie to one another, work in floats and cost little more than
/// they do in the float build. Velocities, impulses and contacts are then good to a float's seven digits, and no
/// number may be larger than a float's.
/// The program and the library it links must agree; a mismatch is a link error ("undefined reference to
/// plumb_world_create_double"): all functions that need no object of the library's to be called with, but take
/// or give reals, have symbols with the precision in them.
#if defined(PLUMB_FAR) && PLUMB_FAR
#define PLUMB_IS_FAR         1
#define PLUMB_REAL_IS_DOUBLE 1
#if defined(PLUMB_DOUBLE) && PLUMB_DOUBLE
#error "define PLUMB_DOUBLE or PLUMB_FAR, not both"
#endif
#else
#define PLUMB_IS_FAR 0 ///< positions in double, all else in float
#if defined(PLUMB_DOUBLE) && PLUMB_DOUBLE
#define PLUMB_REAL_IS_DOUBLE 1
#else
#define PLUMB_REAL_IS_DOUBLE 0 ///< whether plumb_real is double
#endif
#endif

#if PLUMB_REAL_IS_DOUBLE
typedef double plumb_real;
#define PLUMB_REAL_EPSILON 2.2204460492503131e-16 ///< [-] spacing of reals at 1
#define PLUMB_REAL_MAX     1.7976931348623157e+308
#if PLUMB_IS_FAR
#define PLUMB_SYMBOL(name) name##_far
#else
#define PLUMB_SYMBOL(name) name##_double
#endif
#else
typedef float plumb_real;
#define PLUMB_REAL_EPSILON 1.1920929e-7f ///< [-] spacing of reals at 1
#define PLUMB_REAL_MAX     3.4028235e+38f
#define PLUMB_SYMBOL(name) name##_float ///< of a function by which a mismatch is found
#endif

/// Every result code: X(name, value, text). The one list: enum, plumb_result_text and tests use it.
// clang-format off
#define PLUMB_RESULT_LIST(X)                                                                     \
    X(OK,             0, "ok")                                                                   \
    X(E_NULL,         1, "a required pointer is null")                                           \
    X(E_HANDLE,       2, "a handle is null, stale, or of another kind")                          \
    X(E_RANGE,        3, "a value is outside its documented range")                              \
    X(E_NOT_FINITE,   4, "a value is NaN or infinite")                                           \
    X(E_MEMORY,       5, "the allocator returned no memory")                                     \
    X(E_LOCKED,       6, "a structural change was made directly while the world steps")          \
    X(E_GEOMETRY,     7, "an outline is degenerate, not convex or crosses itself")               \
    X(E_DUPLICATE,    8, "a name or component is already there")                                 \
    X(E_MISSING,      9, "the thing asked for is not there")                                     \
    X(E_CAPACITY,    10, "a fixed limit is used up")                                             \
    X(E_STATE,       11, "the call does not fit the state of the object")                        \
    X(E_IMAGE,       12, "a snapshot is damaged, or of another build or world")                  \
    X(E_WRITE,       13, "a write function took no more")                                         \
    X(E_UNSUPPORTED, 14, "this library was built without what is asked for")
// clang-format on

/// Result of a call that can fail. On any error the state is as it was before the call.
typedef enum plumb_result {
#define PLUMB_RESULT_ENUM(name, value, text) PLUMB_##name = value,
    PLUMB_RESULT_LIST(PLUMB_RESULT_ENUM)
#undef PLUMB_RESULT_ENUM
} plumb_result;

/// The fixed English text of a result code ("unknown result" for any other value).
PLUMB_API const char *plumb_result_text(plumb_result code);

/// A value handle of anything that lives in a world: a body, a shape, a material, a joint or
/// a bare entity of the user's. {0, 0} is null. A handle of something destroyed is stale and is
/// caught by every call, in release builds too. No world is in it: worlds that come from the same calls, or from
/// one image (rollback, replay, batches, two ends of a network), have the same handles, and one kept from one of
/// them is good in all. So a handle of an unrelated world is only caught where it names nothing of that kind.
typedef struct plumb_entity {
    uint32_t index;      ///< slot in the world's registry
    uint32_t generation; ///< 0 only in the null handle
} plumb_entity;

// Handles of kinds are types of their own, so that a shape in place of a body does not compile. `.entity` is
// what functions for entities of any kind take, plumb_component_set(world, body.entity, ...); and back:
// (plumb_body){ entity }.

typedef struct plumb_body {
    plumb_entity entity; ///< has a body row
} plumb_body;

typedef struct plumb_shape {
    plumb_entity entity; ///< has a shape row
} plumb_shape;

typedef struct plumb_material {
    plumb_entity entity; ///< has a material row; null: the world's default material
} plumb_material;

typedef struct plumb_joint {
    plumb_entity entity; ///< has a joint row
} plumb_joint;

typedef struct plumb_law {
    plumb_entity entity; ///< has a row of plumb/law.h
} plumb_law;

typedef struct plumb_softbody {
    plumb_entity entity; ///< has a row of plumb/softbody.h
} plumb_softbody;

// clang-format off
#define PLUMB_NULL_INIT        { { 0, 0 } } ///< initialiser of the null handle of any type but plumb_entity
#define PLUMB_NULL_ENTITY_INIT { 0, 0 }     ///< of a plumb_entity
// clang-format on

/// True when a handle is null. Says nothing about staleness: see plumb_entity_alive.
static inline bool plumb_entity_is_null(plumb_entity e)
{
    return e.generation == 0;
}

/// True when both handles name the same entity.
static inline bool plumb_entity_same(plumb_entity a, plumb_entity b)
{
    return a.index == b.index && a.generation == b.generation;
}

PLUMB_END

// plumb_is_null(handle) and plumb_same(a, b) take handles of any type, plumb_same two of one type.
// clang-format off
#ifdef __cplusplus
#define PLUMB_HANDLE_TESTS(type, part)                                                              \
    static inline bool plumb_is_null(type handle) { return plumb_entity_is_null(handle part); }     \
    static inline bool plumb_same(type a, type b) { return plumb_entity_same(a part, b part); }
PLUMB_HANDLE_TESTS(plumb_entity, )
PLUMB_HANDLE_TESTS(plumb_body, .entity)
PLUMB_HANDLE_TESTS(plumb_shape, .entity)
PLUMB_HANDLE_TESTS(plumb_material, .entity)
PLUMB_HANDLE_TESTS(plumb_joint, .entity)
PLUMB_HANDLE_TESTS(plumb_law, .entity)
PLUMB_HANDLE_TESTS(plumb_softbody, .entity)
#else
#define PLUMB_HANDLE_TESTS(type)                                                                    \
    static inline bool type##_is_null(type handle) { return plumb_entity_is_null(handle.entity); }  \
    static inline bool type##_same(type a, type b) { return plumb_entity_same(a.entity, b.entity); }
PLUMB_HANDLE_TESTS(plumb_body)
PLUMB_HANDLE_TESTS(plumb_shape)
PLUMB_HANDLE_TESTS(plumb_material)
PLUMB_HANDLE_TESTS(plumb_joint)
PLUMB_HANDLE_TESTS(plumb_law)
PLUMB_HANDLE_TESTS(plumb_softbody)
#define PLUMB_HANDLE_TEST(test, handle)                                                             \
    _Generic((handle),                                                                              \
        plumb_entity: plumb_entity_##test,                                                          \
        plumb_body: plumb_body_##test,                                                              \
        plumb_shape: plumb_shape_##test,                                                            \
        plumb_material: plumb_material_##test,                                                      \
        plumb_joint: plumb_joint_##test,                                                            \
        plumb_law: plumb_law_##test,                                                                \
        plumb_softbody: plumb_softbody_##test)
#define plumb_is_null(handle) PLUMB_HANDLE_TEST(is_null, handle)(handle)
#define plumb_same(a, b)      PLUMB_HANDLE_TEST(same, a)(a, b)
#endif
#undef PLUMB_HANDLE_TESTS
// clang-format on

PLUMB_BEGIN

/// Memory hooks of one world. `resize` behaves like realloc with the old size told:
/// (NULL, 0, n) allocates, (p, old, 0) frees and returns NULL, otherwise grows or shrinks.
/// It returns memory aligned to 64 bytes, or NULL when there is none. All null: the C library.
typedef struct plumb_allocator {
    void *(*resize)(void *context, void *memory, size_t old_size, size_t new_size);
    void *context;
} plumb_allocator;

typedef enum plumb_log_level {
    PLUMB_LOG_ERROR, ///< a call was refused; the message is also plumb_world_error's
    PLUMB_LOG_WARN,  ///< something that is probably not meant
    PLUMB_LOG_INFO   ///< schedule changes and the like
} plumb_log_level;

/// Called with one complete line, without newline. Null: nothing is printed.
typedef void plumb_log_fn(void *context, plumb_log_level level, const char *message);

/// A ready-made log function: one line to stderr, "plumb error: <message>". `context` is not used.
///     plumb_world_create(&(plumb_world_desc){ .log = plumb_log_stderr }, &world);
PLUMB_API void plumb_log_stderr(void *context, plumb_log_level level, const char *message);

/// Called when an internal invariant is broken (debug builds). Return to go on.
/// Null: the message goes to the log hook.
typedef void plumb_assert_fn(void *context, const char *expression, const char *file, int line);

/// Most threads that a world works with.
#define PLUMB_WORKERS_MAX 64

/// Part `chunk` of a job that the library shares out. Calls no function of the library's.
typedef void plumb_task_fn(void *task_context, uint32_t chunk);

/// Takes the place of the library's own threads. `run` calls task(task_context, i) once for every i from 0
/// to chunks - 1, in any order and on any threads, and returns when all are done. It is called some
/// hundred times a step, from the thread that steps the world.
typedef struct plumb_task_hooks {
    void (*run)(void *hook_context, plumb_task_fn *task, void *task_context, uint32_t chunks);
} plumb_task_hooks;

PLUMB_END

#endif
