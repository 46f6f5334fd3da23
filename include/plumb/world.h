/// world.h - a world: what it is made with, how it steps, what it reports.
///
///     plumb_world *world;
///     if (plumb_world_create(&(plumb_world_desc){ .substeps = 4 }, &world) != PLUMB_OK) ...
///     for (;;) plumb_world_step(world, (plumb_real)(1.0 / 60.0));
///     plumb_world_destroy(world);
///
/// A world is used from one thread at a time, whatever number of threads it works with itself; different
/// worlds share nothing.
#ifndef PLUMB_WORLD_H
#define PLUMB_WORLD_H

#include "plumb/types.h"

PLUMB_BEGIN

// A program for the other precision fails at link time here: see plumb_real.
#define plumb_world_create PLUMB_SYMBOL(plumb_world_create)

typedef struct plumb_world plumb_world;

typedef enum plumb_y_axis {
    PLUMB_Y_UP,  ///< +y is up (mathematics); default gravity (0, -9.81)
    PLUMB_Y_DOWN ///< +y is down (screens); default gravity (0, +9.81). Angles still turn from +x to +y
} plumb_y_axis;

typedef enum plumb_solver {
    PLUMB_SOLVER_SOFT, ///< soft step: substeps, soft contacts, warm starting, relax pass
    PLUMB_SOLVER_PGS,  ///< the classic: projected Gauss-Seidel on velocities, then positions
    PLUMB_SOLVER_EXACT ///< contacts with friction and joints of an island solved together, to a residual, by a direct
                       ///< method, on one thread: heavy on light, long chains, trusses, loops, limits of stability
} plumb_solver;

/// How a world is made. {0} is valid: every zero means the default told beside the field.
typedef struct plumb_world_desc {
    plumb_vec2 gravity;             ///< [m/s^2] finite; {0, 0}: 9.81 downwards as y_axis says
    bool zero_gravity;              ///< true: no gravity at all; `gravity` must then be {0, 0}
    plumb_y_axis y_axis;            ///< default PLUMB_Y_UP
    plumb_solver solver;            ///< default PLUMB_SOLVER_SOFT
    int substeps;                   ///< [-] 1..64, default 4. PGS: sub-steps of the whole step, default 1
    int iterations;                 ///< [-] 1..1000. PGS: sweeps a step, default 10. Soft: sweeps a substep, default 1
    bool direct_joints;             ///< solve all joints of an island together, exactly, by a direct method. Costs some
                                    ///< 2 us a joint and substep, more where joints form nets. Soft step alone; mice,
                                    ///< friction joints and motor joints that give way are swept as ever. Default: so are
                                    ///< all joints but those of bodies that hang together by a light one between heavy
                                    ///< ones, a hub, a row of welds: they are solved together unasked, up to nets of 150
                                    ///< joints. What contacts push apart and joints hold together may be thrown
    plumb_real exact_tolerance;     ///< [-] 0..0.5, default 1e-9 (also of 0): share of the largest speed that contacts and joints
                                    ///< have to undo in a substep which PLUMB_SOLVER_EXACT may leave. What it left:
                                    ///< plumb_stats.exact_residual
    bool no_exact_islands;          ///< Soft step: unless this is set, small islands that sweeps cannot hold (none of which bounces, is
                                    ///< driven or crushed by a kinematic body) are solved as PLUMB_SOLVER_EXACT does: where a body lies
                                    ///< on one that is ten times lighter, 48 contacts and joints in all; where contacts have borne four
                                    ///< times the weight of a body for 16 steps and give way by 2 % of it, 32 more in all. Islands that
                                    ///< were solved so before go on, then small ones come first; the others are swept. Costs some 30 us a
                                    ///< step for two bodies, 1 to 5 ms for 40. How many: plumb_stats.exact_islands
    bool no_fine_islands;           ///< Soft step: unless this is set, and while all contacts and joints that are awake are 512 at
                                    ///< the most, islands in which dynamic bodies touch one another take four substeps in place
                                    ///< of one (16 a step at the most), with contacts, not joints, as much stiffer, recovery from
                                    ///< overlap at a tenth of push_speed and five more sweeps that relax where a substep of the
                                    ///< world ends: 100 us more a step for 55 boxes. Not where restitution is above 0.2, systems
                                    ///< run in substeps or a kinematic body crushes them. How many: plumb_stats.fine_islands
    plumb_real tolerance;           ///< [-] 0..0.5, default 0: none. Error that the world may make: it then chooses
                                    ///< solver, substeps and direct_joints itself, and those given are what it
                                    ///< begins with. See plumb/accuracy.h
    plumb_real contact_hertz;       ///< [1/s] >= 0. Contact stiffness; default: a sixth of the substep rate,
                                    ///< which is also the largest that is used. Where steps become shorter, it
                                    ///< rises by e in half a second at most: no pile is thrown up by that
    plumb_real contact_damping;     ///< [-] >= 0, damping ratio of contacts, default 3
    plumb_real push_speed;          ///< [m/s] >= 0, fastest recovery from overlap, default 6
    plumb_real restitution_speed;   ///< [m/s] >= 0; approach slower than this does not bounce. Default 0:
                                    ///< only a bounce that would end within the substep is swallowed
    plumb_real restitution_cap;     ///< [m/s] > 0, default 20: where restitution is above 1, an impact gives nothing
                                    ///< more to what leaves this fast, and what came faster leaves as it came
    plumb_real hit_speed;           ///< [m/s] >= 0; contacts that approach faster make hit events. Default 0: none
    bool contact_impulses;          ///< add up the impulses of each contact over the step (plumb_contact_point);
                                    ///< done anyway where hit_speed is set
    bool no_sleep;                  ///< bodies at rest stay awake: see plumb/sleep.h
    plumb_real sleep_speed;         ///< [m/s] >= 0; bodies slower than this rest, default 0.05: of v and w times
                                    ///< the farthest point of the body, the root of the sum of squares
    plumb_real sleep_time;          ///< [s] >= 0; how long bodies must have rested to fall asleep, default 0.5
    plumb_real wrap_x, wrap_y;      ///< [m] 0.1..2e9: the world is so long along the axis and closes in on itself,
                                    ///< see plumb_world_wrapped. Default 0: it has no end
    bool no_continuous;             ///< bodies that move fast may pass through thin things: no sweeps. For worlds
                                    ///< in which it does not matter; bodies that move slowly cost nothing anyway
    int simd_width;                 ///< vector registers of the kernels, in floats: 4, 8 or 16; default 0 = best
                                    ///< measured. A pure speed setting: every width gives the same bits
    bool measure;                   ///< each step measures its own error: see plumb/measure.h. Changes no bit
    bool watchdog;                  ///< each step is watched for what it should never do: see plumb/watchdog.h. Changes no
                                    ///< bit
    uint32_t body_capacity;         ///< rows to reserve; 0: grow as needed
    uint32_t shape_capacity;        ///< likewise for shapes, of 4 corners
    uint32_t contact_capacity;      ///< likewise for contacts
    int workers;                    ///< threads that share the work of a step, 0..64, the caller included; default
                                    ///< 1: no thread is made. A pure speed setting: any number gives the same bits.
                                    ///< Pays from some thousand bodies on; no more than there are idle cores
    plumb_task_hooks tasks;         ///< threads of your own instead: `workers` tells how many there are to reckon with
    plumb_allocator allocator;      ///< null members: the C library
    plumb_log_fn *log;              ///< null: silent; plumb_log_stderr: to stderr
    plumb_assert_fn *assert_failed; ///< null: broken invariants go to `log`
    void *hook_context;             ///< handed to `log`, `assert_failed` and `tasks`
    void *user_data;                ///< see plumb_world_user_data
} plumb_world_desc;

/// Makes a world. `desc` may be null (= {0}). On error *world is null and, when the descriptor has
/// a log hook, the message has been sent there.
/// Errors: E_NULL (no `world`), E_RANGE, E_NOT_FINITE, E_MEMORY.
PLUMB_API plumb_result plumb_world_create(const plumb_world_desc *desc, plumb_world **world);

/// Destroys a world and all that lives in it. Null is ignored.
PLUMB_API void plumb_world_destroy(plumb_world *world);

/// The descriptor in force, all defaults resolved but that of contact_hertz, which goes by the steps: it stays 0.
PLUMB_API plumb_world_desc plumb_world_settings(const plumb_world *world);

/// Advances the world by dt [s], 0 <= dt <= 1. Events, spans and contact views of the step before
/// become invalid. Cost: see plumb_world_schedule.
///
/// dt may be another one in each step: what rests stays at rest, piles are not thrown up. Equal steps are more exact.
///
/// dt 0 is for games that pause and for editors: it carries out commands and brings contacts, sensor overlaps,
/// grids and events up to date with what was created, destroyed, moved, filtered or enabled since the last step;
/// what that touches in its sleep wakes. Nothing moves, no velocity, force, impulse, clock or count of steps
/// changes, nobody falls asleep, nothing hits or breaks, melts or grows. Of systems only those of PLUMB_PHASE_CONTACTS run (with
/// dt 0), if something is to be looked at. Where nothing was edited, it costs nothing, contacts stay as the last
/// step left them, and the next step gives the same bits as without it. A recording plays it back.
///
/// Errors: E_RANGE, E_NOT_FINITE, E_LOCKED (called from a system), E_MEMORY (no body has moved, but systems
/// of the phases before may have run: forces they added are still there; bodies touched may have woken).
PLUMB_API plumb_result plumb_world_step(plumb_world *world, plumb_real dt);

/// Sets the simulated time (`time` of plumb_world_stats), 0..1e12 s; a new world's is 0. Gusts, eddies and swell are functions
/// of it. Errors: E_NULL, E_RANGE, E_NOT_FINITE, E_LOCKED.
PLUMB_API plumb_result plumb_world_set_time(plumb_world *world, double time);

/// Changes gravity [m/s^2]; zero is zero here. Errors: E_NOT_FINITE.
PLUMB_API plumb_result plumb_world_set_gravity(plumb_world *world, plumb_vec2 gravity);

/// Changes substeps (1..64) and iterations (1..1000), as in the descriptor; from the next step on.
/// Errors: E_RANGE, E_LOCKED.
PLUMB_API plumb_result plumb_world_set_substeps(plumb_world *world, int substeps, int iterations);
/// Changes how many threads share the work of a step, 0..64, as in the descriptor (0: 1); with task hooks, how many
/// there are to reckon with. Ends and starts threads, so it is nothing for every step; no bit depends on it.
/// Errors: E_NULL, E_RANGE, E_LOCKED, E_MEMORY (memory or threads; those that there were stay).
PLUMB_API plumb_result plumb_world_set_workers(plumb_world *world, int workers);
/// Changes contact_hertz, contact_damping and push_speed; 0 means the default told in the descriptor.
/// Errors: E_RANGE, E_NOT_FINITE, E_LOCKED.
PLUMB_API plumb_result plumb_world_set_contact_tuning(plumb_world *world, plumb_real hertz,
                                                      plumb_real damping, plumb_real push_speed);
/// Changes restitution_speed [m/s] >= 0. Errors: E_RANGE, E_NOT_FINITE, E_LOCKED.
PLUMB_API plumb_result plumb_world_set_restitution_speed(plumb_world *world, plumb_real speed);

/// Gravity in force [m/s^2].
PLUMB_API plumb_vec2 plumb_world_gravity(const plumb_world *world);

/// Unit vector against which "down" is measured: (0, 1) in a y-up world, (0, -1) in a y-down one.
PLUMB_API plumb_vec2 plumb_world_up(const plumb_world *world);

/// Worlds that wrap around (`wrap_x`, `wrap_y`, either or both): what leaves at one edge comes in at the
/// other. The centre of mass of every body lies in -wrap/2 <= x < wrap/2, whatever place it was given; it is
/// brought back at the end of a step, by whole periods, which rounds nothing. Contacts, joints, sweeps,
/// sensors, explosions and queries go by the nearest image, over the edge too; so do places handed to a
/// function (a point that a force acts at, an anchor, a target: the way there is the shortest).
/// - Each convex piece of a shape must be smaller than half the period (shapes refuse others: E_RANGE); a
///   ground that goes all around is made of several. What a joint or a query compares should be nearer than
///   half a period too: of two images, the nearer one counts.
/// - Points that are handed out (contacts, hits) lie beside the body, or the ray, that they belong to, so they
///   may be beyond the edge; bounding boxes too.
/// - A body that crosses half a period in a step may meet things an image too late.
/// - plumb_world_energy: potential energy and angular momentum jump when a body crosses.
/// Returns the image of a point that lies in the world's period; the point itself where it does not wrap.
PLUMB_API plumb_vec2 plumb_world_wrapped(const plumb_world *world, plumb_vec2 point);

/// The shortest way [m] from one point to another: `to` - `from` where the world does not wrap. Of two
/// ways of half a period each, that towards lower coordinates.
PLUMB_API plumb_vec2 plumb_world_way(const plumb_world *world, plumb_vec2 from, plumb_vec2 to);

/// The pointer given in the descriptor.
PLUMB_API void *plumb_world_user_data(const plumb_world *world);
PLUMB_API plumb_result plumb_world_set_user_data(plumb_world *world, void *user_data);

/// The last call on this world that was refused. `function` and `message` are "" when none was.
typedef struct plumb_error {
    plumb_result code;
    const char *function; ///< name of the public function
    const char *message;  ///< function, field and value in one sentence; valid until the next error
} plumb_error;

/// The last refused call. Never null members. Successful calls leave it as it is.
PLUMB_API plumb_error plumb_world_error(const plumb_world *world);
/// Forgets it, so that one look after several calls tells whether any of them was refused. Null is ignored.
PLUMB_API void plumb_world_clear_error(plumb_world *world);

/// Counts and self-measured error of the last step.
typedef struct plumb_stats {
    uint64_t step_count;         ///< steps taken
    double time;                 ///< [s] simulated
    double exact_residual;       ///< [-] largest that was left in that step, as a share: see exact_tolerance
    uint32_t body_count;         ///< all bodies
    uint32_t dynamic_count;      ///< awake dynamic bodies
    uint32_t kinematic_count;    ///< kinematic bodies
    uint32_t static_count;       ///< static bodies
    uint32_t asleep_count;       ///< sleeping dynamic bodies
    uint32_t island_count;       ///< islands that sleep
    uint32_t disabled_count;     ///< bodies out of the simulation, of any type
    uint32_t shape_count;        ///< shapes as the user made them
    uint32_t piece_count;        ///< convex pieces of all shapes
    uint32_t pair_count;         ///< pairs whose fat boxes overlap, and contacts of sleeping bodies
    uint32_t contact_count;      ///< pairs of pieces that touched as the step began, asleep or not. Those that met
                                 ///< in it, or touch on by half a millimetre, are told by plumb_world_contacts
    uint32_t point_count;        ///< manifold points of all pairs, those about to touch included
    uint32_t color_count;        ///< colours of the constraint graph
    uint32_t overflow_count;     ///< contacts that found no colour
    uint32_t pair_rebuilds;      ///< rebuilds of the pair list since the world was made
    uint32_t bounce_count;       ///< impacts resolved with restitution in the last step
    uint32_t cut_chain_count;    ///< contacts in all that had more impacts in a substep than could be followed: what
                                 ///< bounce was left to them is lost; the first one is also a warning in the log
    uint32_t arrested_count;     ///< bodies taken out in all, because a step would have left them with a state
                                 ///< that is not finite or beyond 1e12 m or m/s: see plumb_quarantine
    uint32_t alarm_count;        ///< alarms of the watchdog since it began to watch: see plumb/watchdog.h
    uint32_t exact_factored;     ///< matrices that the exact solver factored in the last step
    uint32_t exact_islands;      ///< islands that a world of the soft step solved exactly in the last step, unasked
    uint32_t exact_missed;       ///< of its solutions in that step, those that missed the tolerance; the first one of a
                                 ///< world is also a warning in the log
    uint32_t fine_islands;       ///< islands of a small world that took finer substeps in the last step
    uint32_t fine_substeps;      ///< as many as each of them took; 0: there are none
    uint32_t soft_missed;        ///< substeps in all whose soft bodies had not settled when the iteration ended (after 48
                                 ///< passes); the first one is also a warning in the log
    uint32_t soft_count;         ///< soft bodies that there are
    uint32_t soft_asleep;        ///< of those, asleep
    uint32_t fast_count;         ///< bodies that moved so fast in the last step that their way was swept
    uint32_t stopped_count;      ///< of those, bodies put back to where they would have passed into something
    int simd_width;              ///< lanes in use: as many as a register holds, but 4 at least (doubles: half)
    plumb_real max_penetration;  ///< [m] deepest overlap after the last step's narrow phase, >= 0
    plumb_real mean_penetration; ///< [m] mean over touching contacts of the deeper point, 0 if apart
    size_t bytes;                ///< [B] memory held by the world
    size_t peak_bytes;           ///< [B] most memory ever held
} plumb_stats;

/// Counters of the last step; of sleeping bodies, as they were when they fell asleep. O(sleeping islands).
PLUMB_API plumb_stats plumb_world_stats(const plumb_world *world);

/// One part of a world's memory.
typedef struct plumb_memory_row {
    const char *name; ///< "bodies", "contacts", ...
    size_t bytes;     ///< [B] held, room for growth included
    uint32_t count;   ///< things in it now; 0 where it is scratch or has no rows
} plumb_memory_row;

/// Where plumb_stats.bytes are, part by part; together they are all of them. Writes up to `capacity` rows,
/// returns how many there are. O(1).
PLUMB_API int plumb_world_memory(const plumb_world *world, plumb_memory_row *rows, int capacity);

/// Cells [m] of the broad phase's grids that shapes were filed in by the last step, each once, for
/// drawing: moving shapes first, small cells before large. Writes up to `capacity`, returns how many
/// there are. O(shapes).
PLUMB_API int plumb_world_cells(const plumb_world *world, plumb_aabb *cells, int capacity);

/// Mechanical state of all dynamic bodies, summed in double in row order, and of the springs of joints. Their sum is
/// kinetic + potential + stored. O(bodies + joints).
typedef struct plumb_energy {
    double kinetic;          ///< [J] translation and rotation
    double potential;        ///< [J] -m g.x against the origin, and of laws (plumb/law.h) that have one: not of
                             ///< zones, nor of what replaces
    double stored;           ///< [J] k x^2 / 2 of each joint with a spring that is on (mouse and motor joints too); where
                             ///< its force is bounded, beyond that force times way
    double momentum_x;       ///< [kg m/s]
    double momentum_y;       ///< [kg m/s]
    double angular_momentum; ///< [kg m^2/s] about the origin
    double mass;             ///< [kg]
} plumb_energy;

/// Energy and momentum of now; all zero for null. O(dynamic bodies + joints).
PLUMB_API plumb_energy plumb_world_energy(const plumb_world *world);

#define PLUMB_VARIANTS_MAX 8 ///< of a pass

/// One line of the schedule: a pass of the step, built in or the user's.
typedef struct plumb_pass_info {
    const char *name;
    const char *phase;  ///< stage: "commands", "begin", "forces", "pairs", "contacts", "edits", "graph", "solve";
                        ///< of the substeps "prepare", "moment", "velocities", "constraints", "positions", "relax",
                        ///< "sums", "store"; "finish", "events", "end"
    const char *reads;  ///< data read: names of plumb_data_name or of components, with commas between them
    const char *writes; ///< data written
    const char *reason; ///< why it runs, or why it was left out
    bool scheduled;     ///< false: wanted by nothing in this world, costs nothing
    bool in_substeps;   ///< runs inside of the solver's pass, in each substep and cluster of islands
    bool is_user;       ///< registered by plumb_system_create
    double last_ns;     ///< [ns] wall time in the last step, without that of rows inside of it; 0 unless watched
    double total_ns;    ///< [ns] while times were watched
    int variant_count;
    const char *variants[PLUMB_VARIANTS_MAX]; ///< which variants of its kernels run: "friction", "rotation", ...
    int away_count;
    const char *away[PLUMB_VARIANTS_MAX]; ///< and which are specialised away: nothing in this world needs them
} plumb_pass_info;

/// The schedule in order, passes left out included. Writes up to `capacity` rows, returns how many
/// there are. Reasons are valid until the next step.
PLUMB_API int plumb_world_schedule(const plumb_world *world, plumb_pass_info *rows, int capacity);

/// What a world notes of its own steps.
typedef enum plumb_watch {
    PLUMB_WATCH_NOTHING = 0,
    PLUMB_WATCH_TIMES = 1, ///< the time that each row of the schedule takes: a look at the clock before and behind it
    PLUMB_WATCH_WRITES = 2 ///< whether each row changes only what it declares to write: digests of all data before and
                           ///< behind it, and substeps on one thread. What changes else is an error in the log
                           ///< (E_STATE, "plumb_world_step"); the step goes on. For tests of systems: some 100
                           ///< times slower
} plumb_watch;

/// Sets what is watched from the next step on: a sum of plumb_watch; nothing by default. Changes no bit of what
/// the world does. With several threads, rows of the substeps have shares of the time that the substeps took.
/// Errors: E_NULL, E_RANGE, E_LOCKED, E_MEMORY.
PLUMB_API plumb_result plumb_world_watch(plumb_world *world, unsigned what);

/// Names of data that rows of the schedule read and write: "velocities", "manifolds", ...; null from the last
/// on.
PLUMB_API const char *plumb_data_name(int index);
/// [B] of that data now, in the columns and lists that hold it; 0 for what is none, and of data that is not counted
/// ("internal edges"). O(rows).
PLUMB_API size_t plumb_data_bytes(const plumb_world *world, int index);

PLUMB_END

#endif
