// draw.h - one drawing under way, for the files of this folder.
#ifndef PL_DRAW_H
#define PL_DRAW_H

#include "plumb/draw.h"
#include "world/state.h"

typedef struct pl_drawing {
    plumb_world *world;
    plumb_draw_calls calls;
    plumb_draw_desc desc; // defaults resolved
    pl_box view;          // [m]
    plumb_vec2 middle;    // of the view
    const plumb_color *palette;
} pl_drawing;

void pl_draw_line(const pl_drawing *d, plumb_vec2 a, plumb_vec2 b, plumb_paint paint);
void pl_draw_point(const pl_drawing *d, plumb_vec2 at, plumb_paint paint);
// Whether the box of two points reaches into the view.
bool pl_draw_sees(const pl_drawing *d, plumb_vec2 a, plumb_vec2 b);
// The image of a point that is nearest to the middle of the view; where a body is drawn, by that image.
plumb_vec2 pl_draw_near(const pl_drawing *d, plumb_vec2 point);
plumb_transform pl_draw_frame(const pl_drawing *d, plumb_body body);

// draw_ties.c. E_MEMORY.
void pl_draw_joints(const pl_drawing *d);
void pl_draw_joint_forces(const pl_drawing *d);
plumb_result pl_draw_contacts(const pl_drawing *d, bool forces);

#endif
