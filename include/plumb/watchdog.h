/// watchdog.h - alarms: what a step should never do, told with who, where in the step, and what was called last.
///
///     plumb_world_set_watchdog(world, true);
///     plumb_world_step(world, dt);
///     int count;
///     const plumb_alarm *a = plumb_world_alarms(world, &count);
///     for (int i = 0; i < count; ++i)
///         printf("%s at %g s in '%s', after %s\n", plumb_alarm_name(a[i].kind), a[i].time, a[i].pass, a[i].command);
///
/// The log hook is told the same in a sentence. An alarm is told once of an entity and kind, until it has been silent for
/// PLUMB_ALARM_SILENCE steps.
///
/// Watching changes no bit of what the world does. Off it costs a comparison a step. What it knows of the past (last
/// commands, speeds that were given, whom it has told of) is no part of the world's state: images and hashes do not
/// have it, and a world that is restored is watched as one that has just begun.
#ifndef PLUMB_WATCHDOG_H
#define PLUMB_WATCHDOG_H

#include "plumb/alarm_list.h"
#include "plumb/world.h"

PLUMB_BEGIN

/// Kinds of alarms, PLUMB_ALARM_...: plumb/alarm_list.h tells them.
typedef enum plumb_alarm_kind {
#define PLUMB_ALARM_ENUM(NAME, ...) PLUMB_ALARM_##NAME,
    PLUMB_ALARM_LIST(PLUMB_ALARM_ENUM)
#undef PLUMB_ALARM_ENUM
        PLUMB_ALARM_KINDS
} plumb_alarm_kind;

#define PLUMB_ALARM_MAX     64 ///< most that are told of a step; plumb_stats.alarm_count counts all
#define PLUMB_ALARM_SILENCE 30 ///< [steps]

typedef struct plumb_alarm {
    plumb_alarm_kind kind;
    plumb_body body;       ///< whom it is about; of a joint its body B, or A where B is the world
    plumb_body other;      ///< whom it touches, or passed; null: none
    plumb_joint joint;     ///< TORN_JOINT; else null
    plumb_real value;      ///< what was found
    plumb_real bound;      ///< what it exceeds
    plumb_vec2 point;      ///< [m] where: the body's centre as the step ended, the joint's anchor
    uint64_t step;         ///< stats' step_count behind the step
    double time;           ///< [s] likewise
    const char *pass;      ///< row of the schedule that brought it, as far as can be told
    const char *work;      ///< of an energy jump in a world that measures, what brought most of it: plumb_work_name; ""
    const char *command;   ///< the last call that changed the body (of a joint, either body, or itself), as
                           ///< "plumb_body_apply_impulse"; "system 'name'": one that changed it; "": none since it is watched
    uint64_t command_step; ///< stats' step_count when it came
} plumb_alarm;

/// Switches the watchdog, as `watchdog` in the descriptor does. It begins to watch anew. Errors: E_NULL, E_LOCKED.
PLUMB_API plumb_result plumb_world_set_watchdog(plumb_world *world, bool watchdog);
/// Alarms of the last step, by kind; *count is set. Null when there are none. Valid until the next step.
PLUMB_API const plumb_alarm *plumb_world_alarms(const plumb_world *world, int *count);
/// "energy-jump", ..., what it looks for, what to do, the unit of value and bound; null for what is none.
PLUMB_API const char *plumb_alarm_name(plumb_alarm_kind kind);
PLUMB_API const char *plumb_alarm_text(plumb_alarm_kind kind);
PLUMB_API const char *plumb_alarm_advice(plumb_alarm_kind kind);
PLUMB_API const char *plumb_alarm_unit(plumb_alarm_kind kind);
/// The bound of its row in the list; 0 for what is none.
PLUMB_API double plumb_alarm_bound(plumb_alarm_kind kind);

PLUMB_END

#endif
