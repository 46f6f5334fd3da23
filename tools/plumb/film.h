/// film.h - pictures and films of whatever has a stage: what `plumb render` and `plumb replay --render`
/// share. The options, the camera, overlays, trails, captions and the files.
#ifndef PLUMB_FILM_H
#define PLUMB_FILM_H

#include "engine.h"
#include "scene_args.h"

#include "../render/write.h"

/// Values of FILM_OPTIONS. Begin with FILM_ARGS_INIT.
typedef struct film_args {
    const char *output; ///< NULL: not given
    cli_size size;      ///< [px] 0: the default
    double fps;         ///< 0: not given
    double from, to;    ///< [s]; < 0: not given
    const char *follow;
    double zoom;  ///< 0: not given
    double trail; ///< [s]; < 0: not given
    const char *overlay;
    const char *title;
    unsigned show; ///< from `overlay`, see film_args_check
} film_args;

#define FILM_ARGS_INIT                                                                             \
    {                                                                                              \
        .from = -1, .to = -1, .trail = -1                                                          \
    }

// clang-format off
/// Rows of the option table for a struct `type` whose member `member` is a film_args; `output` has a name of
/// its own in each command.
#define FILM_OPTIONS(type, member)                                                               \
    { "size", 's', CLI_SIZE, offsetof(type, member.size), "WxH", 16, RENDER_SIZE_MAX, NULL,      \
      "in pixels (default 960x540)" },                                                           \
    { "from", 0, CLI_REAL, offsetof(type, member.from), "S", 0, SCENE_TIME_MAX, NULL,            \
      "film: where it begins (default: at the beginning)" },                                     \
    { "to", 0, CLI_REAL, offsetof(type, member.to), "S", 0, SCENE_TIME_MAX, NULL,                \
      "film: where it ends (default: at the end)" },                                             \
    { "fps", 0, CLI_REAL, offsetof(type, member.fps), "N", 0.01, 1000, NULL,                     \
      "film: pictures a simulated second (default 30)" },                                        \
    { "follow", 0, CLI_TEXT, offsetof(type, member.follow), "NAME", 0, 0, NULL,                  \
      "keep the body of that name in the middle" },                                              \
    { "zoom", 0, CLI_REAL, offsetof(type, member.zoom), "F", 0.001, 1000, NULL,                  \
      "show 1/F of the height that would be shown (default 1)" },                                \
    { "overlay", 0, CLI_TEXT, offsetof(type, member.overlay), "LIST", 0, 0, NULL,                \
      "contacts, impulses, velocities, aabbs, cells (of the broad phase), field (what gravity and " \
      "laws do to what has no charge, or, if that is nothing but gravity, to a charge), flow (of air and fluids), legend, names (of all bodies); on unless taken away (no-grid): joints, surfaces (the way they run), dipoles (red: the north pole), grid, "      \
      "labels, scale, title, spokes; none: nothing but the bodies" },                            \
    { "trail", 0, CLI_REAL, offsetof(type, member.trail), "S", 0, SCENE_TIME_MAX, NULL,          \
      "draw behind every moving body where it was in the last S seconds (default: "              \
      "camera{trail} of a scene, else none)" },                                                  \
    { "title", 0, CLI_TEXT, offsetof(type, member.title), "TEXT", 0, 0, NULL,                    \
      "instead of the scene's; \"\" for none" }
// clang-format on

/// What is filmed, and how to move in it.
typedef struct film_source {
    engine_scenery seen; ///< as it is now; `go` may put another stage here
    long long step;      ///< steps taken
    double start, end;   ///< [s] where a film begins and ends unless told otherwise
    const char *verb;    ///< what is done on the way to a picture: label of the progress bar
    bool quiet;          ///< no bar
    void *context;
    /// Goes to where `to` steps have been taken, or as near as the source reaches. A cli_exit, after a message
    /// for which the bar was ended.
    int (*go)(struct film_source *source, long long to, progress *bar);
    /// The step nearest to `time` [s].
    long long (*find)(const struct film_source *source, double time);
    /// True when it goes no further. NULL: never.
    bool (*ended)(const struct film_source *source);
} film_source;

/// True when the name is that of more than one picture.
bool film_is_film(const char *path);
/// Checks what the table cannot, `output` being given, and reads the overlays. CLI_OK or CLI_USAGE after a
/// message.
int film_args_check(const cli_command *command, film_args *args);
/// Takes the picture at `at` [s], or a film, and writes it. The camera looks from where the source stands.
int film_shoot(const film_args *args, film_source *source, double at);

/// Names of overlays, NULL past the end.
const char *film_overlay(int index);

#endif
