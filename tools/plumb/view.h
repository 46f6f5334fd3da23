/// view.h - where the camera looks.
#ifndef PLUMB_VIEW_H
#define PLUMB_VIEW_H

#include "../render/render.h"
#include "engine.h"

/// What the command line says about the view. {0} with zoom 1: nothing.
typedef struct view_wish {
    const char *follow; ///< body to keep in the middle, NULL = as the scene says
    double zoom;        ///< > 1: nearer
    int width, height;  ///< [px]
} view_wish;

/// A camera being aimed. Feed it the states that must be visible, then ask.
typedef struct view {
    view_wish wish;
    bool y_down;
    engine_camera hint;
    char follow[256]; ///< "" = none
    double size;      ///< [m] of the first state: how far things may stray is measured by it
    engine_box seen;  ///< of all states fed
    bool has_center;  ///< it has been seen; if it vanishes the camera stays
    double x, y;      ///< [m] where it was last
} view;

/// Begins. CLI_OK, or CLI_USAGE after a message when nothing is named as `follow` says.
int view_begin(view *v, const view_wish *wish, const engine_scenery *of);
/// True when the camera depends on states later than the one to be drawn.
bool view_needs_run(const view *v);
/// Begins anew with the states that follow.
void view_forget(view *v);
/// Sees the state now.
void view_feed(view *v, const engine_scenery *of);
/// The camera for the state now.
render_camera view_camera(view *v, const engine_scenery *of);

#endif
