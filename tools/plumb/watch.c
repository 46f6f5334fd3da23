/// watch.c - alarms of the watchdog, told while a scene runs, but for what it allows.
///
/// Writes to stdout or stderr, the same on every run.
#include "watch.h"

#include "allow.h"

#include <string.h>

/// Of one kind, so many are told.
enum { TOLD = 3 };

static const char *const names[] = {
#define NAME_OF(NAME, name, ...) name,
    PLUMB_ALARM_LIST(NAME_OF)
#undef NAME_OF
};

bool watch_open(watch_tally *w, const char *path, const cli_texts *options)
{
    const allow_words words = { "-- watchdog: allow ", "alarm", names, WATCH_KINDS };
    const char *slash = strrchr(path, '/');
    *w = (watch_tally){ .scene = slash != NULL ? slash + 1 : path };
    return allow_read(&words, path, options, w->allowed);
}

/// What to do about a kind is told with the first of it.
static void tell(const watch_tally *w, const engine_alarm *alarm, bool first)
{
    if (!w->to_stdout) {
        cli_message("alarm: %s: %s: %s%s%s", w->scene, alarm->kind, alarm->text,
                    first ? "; to do: " : "", first ? alarm->advice : "");
        return;
    }
    printf("alarm %s: %s: %s\n", w->scene, alarm->kind, alarm->text);
    if (first) {
        printf("      to do: %s\n", alarm->advice);
    }
}

int watch_step(watch_tally *w, const engine_api *engine, engine_session *session)
{
    const engine_alarm *list = NULL;
    const int count = engine->alarms(session, &list);
    for (int i = 0; i < count; i++) {
        const int kind = list[i].number;
        if (!w->allowed[kind] && ++w->found[kind] <= TOLD) {
            tell(w, &list[i], w->found[kind] == 1);
        }
    }
    if (count < 0) {
        cli_message("out of memory");
    }
    return count < 0 ? CLI_FAILED : CLI_OK;
}

long long watch_close(watch_tally *w)
{
    long long all = 0;
    for (int kind = 0; kind < WATCH_KINDS; kind++) {
        const long long more = w->found[kind] - TOLD;
        if (more > 0 && w->to_stdout) {
            printf("alarm %s: %s: and %lld more\n", w->scene, names[kind], more);
        } else if (more > 0) {
            cli_message("alarm: %s: %s: and %lld more", w->scene, names[kind], more);
        }
        all += w->found[kind];
        w->found[kind] = 0;
    }
    return all;
}
