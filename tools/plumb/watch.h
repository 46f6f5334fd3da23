/// watch.h - alarms of the watchdog, told while a scene runs.
#ifndef PLUMB_WATCH_H
#define PLUMB_WATCH_H

#include "engine.h"
#include "plumb/alarm_list.h"

#define WATCH_ONE(...) +1
enum { WATCH_KINDS = 0 PLUMB_ALARM_LIST(WATCH_ONE) };
#undef WATCH_ONE

/// What a run has told so far. {0}: nothing, to stderr.
typedef struct watch_tally {
    const char *scene; ///< name of its file
    bool to_stdout;    ///< alarms are results; else they are messages
    bool allowed[WATCH_KINDS];
    long long found[WATCH_KINDS];
} watch_tally;

/// Reads what the scene's own lines (`-- watchdog: allow torn-joint: why`) and the options allow. False after a message.
bool watch_open(watch_tally *w, const char *path, const cli_texts *options);
/// Tells the alarms of the last step, the first ones of each kind. CLI_FAILED after a message: out of memory.
int watch_step(watch_tally *w, const engine_api *engine, engine_session *session);
/// Tells how many more there were; answers how many in all.
long long watch_close(watch_tally *w);

/// For the help: the kinds in a sentence each.
#define WATCH_TEXT(NAME, name, bound, unit, text, advice) " " name ": " text " (" #bound ")."

#endif
