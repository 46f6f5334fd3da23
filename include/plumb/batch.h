/// batch.h - many small worlds that step together: learning, Monte-Carlo, search.
///
///     plumb_batch *batch;
///     plumb_batch_create(&(plumb_batch_desc){ .count = 4096, .workers = 2, .build = build_cart }, &batch);
///     for (;;) {
///         plumb_batch_observe(batch, &what, states, room);
///         ...                                                // decide
///         plumb_batch_act(batch, &how, actions, room);
///         plumb_batch_step(batch, (plumb_real)(1.0 / 60), 1);
///         plumb_batch_reset(batch, ended, ended_count);
///     }
///
/// Every world is an ordinary world of one thread; the batch shares worlds out among threads, whole. No
/// world knows of another, so its bits are those that it would have alone, whatever the number of
/// workers. There is no lock between worlds: also without a batch, worlds may be made, stepped and
/// destroyed by any threads, each by one at a time. The allocator of the worlds' descriptor is called
/// from the workers: it must bear that (the C library's does).
///
/// Worlds built by the same calls have the same handles, so that one list of bodies means the same
/// bodies in all. A batch is used from one thread at a time; its build and randomise functions do not call it.
#ifndef PLUMB_BATCH_H
#define PLUMB_BATCH_H

#include "plumb/world.h"

PLUMB_BEGIN

// The symbols tell the precision: see plumb_real.
#define plumb_batch_create PLUMB_SYMBOL(plumb_batch_create)
#define plumb_random_range PLUMB_SYMBOL(plumb_random_range)

/// Most worlds of a batch.
#define PLUMB_BATCH_MAX (1u << 20)

//---- random numbers ------------------------------------------------------------------------------

/// A stream of random numbers: the n-th is a function of key and n alone (SplitMix64: Steele, Lea and
/// Flood 2014, "Fast splittable pseudorandom number generators"). Copy it to go back. Not cryptographic.
typedef struct plumb_random {
    uint64_t key;   ///< which stream
    uint64_t drawn; ///< numbers drawn so far
} plumb_random;

/// The stream of that number under a seed: streams of one seed have nothing to do with one another.
PLUMB_API plumb_random plumb_random_stream(uint64_t seed, uint64_t stream);
/// The next 64 bits, all values equally likely. 0 for null.
PLUMB_API uint64_t plumb_random_bits(plumb_random *random);
/// The next number of low <= x < high, evenly; low where high <= low. Of 24 random bits in the float
/// library, 53 in the double one. Always one draw.
PLUMB_API plumb_real plumb_random_range(plumb_random *random, plumb_real low, plumb_real high);

//---- the batch -----------------------------------------------------------------------------------

typedef struct plumb_batch plumb_batch;

/// Makes something of a world; an error that it returns is taken as the world's. `random` is the stream
/// of this world and episode: plumb_random_stream(plumb_random_stream(seed, index).key, episode).
typedef plumb_result plumb_batch_fn(plumb_world *world, uint32_t index, plumb_random *random,
                                    void *context);

/// {0} is not a batch: it needs a count.
typedef struct plumb_batch_desc {
    uint32_t count;                ///< worlds, 1..PLUMB_BATCH_MAX
    int workers;                   ///< threads that share the worlds, 0..64, the caller included; default 1
    plumb_task_hooks tasks;        ///< threads of your own instead, as in the world's descriptor
    void *hook_context;            ///< handed to `tasks`
    const plumb_world_desc *world; ///< of every world; its workers and tasks must be 0. Null: {0}
    plumb_batch_fn *build;         ///< fills a world once, from the calling thread, in order. Null: empty
    plumb_batch_fn *randomise;     ///< varies a world as built: after `build` and after each reset, from
                                   ///< any worker. Null: nothing. Best without adding or removing anything
    void *context;                 ///< handed to `build` and `randomise`
    uint64_t seed;                 ///< of the worlds' random numbers
    plumb_allocator allocator;     ///< of the batch itself and the images of its worlds
} plumb_batch_desc;

/// Makes and builds all worlds and keeps an image of each (one for all that are alike). O(state).
/// Errors: E_NULL (no `batch` or `desc`), E_RANGE, E_MEMORY, what plumb_world_create, `build` or
/// `randomise` said; *batch is null then, and where the world's descriptor has a log it is told.
PLUMB_API plumb_result plumb_batch_create(const plumb_batch_desc *desc, plumb_batch **batch);

/// Destroys all worlds. Null is ignored.
PLUMB_API void plumb_batch_destroy(plumb_batch *batch);

/// How many worlds there are; 0 for null.
PLUMB_API uint32_t plumb_batch_count(const plumb_batch *batch);

/// World `index`, to be read (its columns are spans: see ecs.h) and changed like any other, but not
/// destroyed. Null when there is none such.
PLUMB_API plumb_world *plumb_batch_world(plumb_batch *batch, uint32_t index);

/// [B] held by the batch and all its worlds. O(worlds).
PLUMB_API size_t plumb_batch_bytes(const plumb_batch *batch);

/// Takes `steps` steps of dt [s] in each world. A world whose step is refused takes no more of them;
/// the others go on. Errors: E_NULL, E_RANGE (dt, steps 0..1e6), E_NOT_FINITE (then no world has stepped); else
/// that of the first world, by index, that was refused: see plumb_batch_error.
PLUMB_API plumb_result plumb_batch_step(plumb_batch *batch, plumb_real dt, int steps);

/// Makes worlds what they were when built, as the next episode: then `randomise`. `worlds` null: all. Each
/// at most once. Allocates nothing where `randomise` does not; unless worlds have been given components since.
/// Errors: E_NULL, E_RANGE, E_DUPLICATE (in `worlds`; then nothing is done); else that of the first world
/// that was refused.
PLUMB_API plumb_result plumb_batch_reset(plumb_batch *batch, const uint32_t *worlds,
                                         uint32_t count);

/// Resets of world `index` so far; 0 when there is none such.
PLUMB_API uint64_t plumb_batch_episode(const plumb_batch *batch, uint32_t index);

/// What can be read and written of bodies.
typedef enum plumb_batch_field {
    PLUMB_FIELD_X,       ///< [m] origin
    PLUMB_FIELD_Y,       ///< [m]
    PLUMB_FIELD_COS,     ///< [-] of the angle; read only
    PLUMB_FIELD_SIN,     ///< [-] read only
    PLUMB_FIELD_ANGLE,   ///< [rad] -pi..pi; read only
    PLUMB_FIELD_VX,      ///< [m/s] of the centre of mass
    PLUMB_FIELD_VY,      ///< [m/s]
    PLUMB_FIELD_W,       ///< [rad/s]
    PLUMB_FIELD_FORCE_X, ///< [N] at the centre of mass, for the next step; write only, as are those below
    PLUMB_FIELD_FORCE_Y, ///< [N]
    PLUMB_FIELD_TORQUE   ///< [N m]
} plumb_batch_field;

/// Bodies and fields of every world: number b, f of world w is at (w * body_count + b) * field_count + f.
typedef struct plumb_batch_view {
    const plumb_body *bodies;        ///< handles that hold in every world
    uint32_t body_count;             ///< 0..2^20
    const plumb_batch_field *fields; ///< each at most once where they are written
    uint32_t field_count;            ///< 0..64
} plumb_batch_view;

/// Gathers fields into one array. Where a world lacks a body its numbers are 0. O(worlds x bodies x
/// fields). Errors: E_NULL, E_RANGE (view, field, capacity below worlds x bodies x fields; then nothing is
/// written); E_HANDLE: a world lacks a body, see plumb_batch_error.
PLUMB_API plumb_result plumb_batch_observe(plumb_batch *batch, const plumb_batch_view *view,
                                           plumb_real *numbers, size_t capacity);

/// Scatters fields from one array: velocities are set, the position is (the body is teleported), forces are
/// added. What does not change wakes nobody. A world with a number that is refused keeps what was before it; the
/// others go on. Errors: as plumb_batch_observe, E_DUPLICATE (a field twice), and those of
/// plumb_body_teleport, plumb_body_set_velocity and plumb_body_apply_force.
PLUMB_API plumb_result plumb_batch_act(plumb_batch *batch, const plumb_batch_view *view,
                                       const plumb_real *numbers, size_t capacity);

/// What can be read and written of joints.
typedef enum plumb_batch_joint_field {
    PLUMB_JOINT_FIELD_VALUE,       ///< [rad] or [m] plumb_joint_value; read only, as are those up to torque
    PLUMB_JOINT_FIELD_RATE,        ///< [rad/s] or [m/s] plumb_joint_rate
    PLUMB_JOINT_FIELD_FORCE_X,     ///< [N] plumb_joint_force
    PLUMB_JOINT_FIELD_FORCE_Y,     ///< [N]
    PLUMB_JOINT_FIELD_TORQUE,      ///< [N m] plumb_joint_torque
    PLUMB_JOINT_FIELD_MOTOR_SPEED, ///< [rad/s] or [m/s] of the motor; writing it switches the motor on
    PLUMB_JOINT_FIELD_MAX_MOTOR,   ///< [N m] or [N]; likewise
    PLUMB_JOINT_FIELD_REST         ///< [rad] or [m] at which the spring is at rest: where a servo is to go; of a distance
                                   ///< joint its length, and 0 leaves that as it is
} plumb_batch_joint_field;

/// Joints and fields of every world: number j, f of world w is at (w * joint_count + j) * field_count + f.
typedef struct plumb_batch_joint_view {
    const plumb_joint *joints;             ///< handles that hold in every world
    uint32_t joint_count;                  ///< 0..2^20
    const plumb_batch_joint_field *fields; ///< each at most once where they are written
    uint32_t field_count;                  ///< 0..64
} plumb_batch_joint_view;

/// Gathers fields of joints into one array, as plumb_batch_observe does those of bodies; the same errors.
PLUMB_API plumb_result plumb_batch_observe_joints(plumb_batch *batch,
                                                  const plumb_batch_joint_view *view,
                                                  plumb_real *numbers, size_t capacity);

/// Sets motors and springs from one array. What does not change wakes nobody. A world with a number that is
/// refused keeps what was before it; the others go on. Errors: as plumb_batch_act, and those of
/// plumb_joint_set_motor and plumb_joint_set_spring.
PLUMB_API plumb_result plumb_batch_drive_joints(plumb_batch *batch,
                                                const plumb_batch_joint_view *view,
                                                const plumb_real *numbers, size_t capacity);

/// What the last call that was refused said.
typedef struct plumb_batch_trouble {
    plumb_result code;
    uint32_t world;       ///< the first by index that was refused; 0 when it was an argument
    uint32_t world_count; ///< how many were; 0 when it was an argument
    const char *message;  ///< one sentence; "" when none was refused. Valid until the next call
} plumb_batch_trouble;

/// The last refused call of the batch. Calls that succeed leave it as it is.
PLUMB_API plumb_batch_trouble plumb_batch_error(const plumb_batch *batch);

/// How world `index` took the last step, reset, observe, act or drive; E_RANGE when there is none such.
PLUMB_API plumb_result plumb_batch_result(const plumb_batch *batch, uint32_t index);

PLUMB_END

#endif
