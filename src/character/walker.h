// walker.h - a kinematic character on its way through one step: a point among obstacles that are
// grown by its shape (query/sweep.h) and its skin.
//
// Places are in double, relative to where the body was when the step began. Obstacles stand where
// they will be at the end of the step, so the character is the last to move.
#ifndef PL_WALKER_H
#define PL_WALKER_H

#include "character/character.h"
#include "query/sweep.h"
#include "world/state.h"

typedef struct pl_obstacle {
    pl_sum sum;     // places at which it is touched, skin included
    pl_round fixed; // the shape itself
    uint32_t piece, row;
    double vx, vy, w; // [m/s], [rad/s] as it moves in this step; 0: it stands
    double cx, cy;    // [m] about which it turns
    double travel;    // [m] farthest that a point of it near the character moves in the step
    bool is_dynamic, is_ground;
    bool is_one_way, holds; // one-way: whether it holds the character in this step
    bool is_below;          // whether all of it lies below the character, as it lets pass
    bool under_way, drops;  // whether the character is on its way through it; because it asked to
    double dx, dy, cosine;  // direction in which it lets pass, and the angle
} pl_obstacle;

typedef struct pl_touch {
    const pl_obstacle *obstacle;
    double fraction;
    double nx, ny;
} pl_touch;

typedef struct pl_walker {
    plumb_world *world;
    pl_character *c;
    uint32_t row, piece;
    double step, scale;                         // [s] of the world, [-] own pace
    double dt;                                  // [s] of its own time
    plumb_vec2 start;                           // [m] where (0, 0) is
    pl_round shape;                             // about it
    double x, y;                                // [m] now
    double ux, uy;                              // up
    double rx, ry;                              // right
    double foot;                                // [m] lowest point of the shape, along up
    double half_width, middle;                  // [m] of the shape, along right
    double nx, ny;                              // normal of the ground
    int slope_side;                             // as of the step before
    double carried_x, carried_y;                // [m] by the ground, in this step
    plumb_shape stood;                          // what it stood on when the step began
    bool landed;                                // in this step
    bool pushed;                                // a body, in this step
    double skin, step_height, step_width, snap; // [m]; 0: switched off
    double max_slope_cos;
    double mass, push_force, acceleration, air_acceleration, max_fall;
    double gravity_x, gravity_y; // [m/s^2] on it
    pl_obstacle *obstacles;
    int obstacle_count;
    uint32_t ignored_row; // an obstacle that is not seen now; PL_NONE: none
} pl_walker;

//---- obstacle.c

// Sets the walker up: settings in force, shape, place. False: the body has no shape to walk with.
bool pl_walker_begin(plumb_world *world, pl_character *c, real dt, pl_walker *m);
// Lists what it may meet within `reach` [m]. False when out of memory.
bool pl_walker_look(pl_walker *m, double reach);
// After the move: which one-way shapes it is inside of.
void pl_walker_note_passing(pl_walker *m);
// [m/s] of an obstacle's material at a place (relative to the start).
void pl_obstacle_velocity(const pl_obstacle *o, double x, double y, double *vx, double *vy);
// Where a body row will be at the end of the step.
plumb_transform pl_row_end_pose(const plumb_world *world, uint32_t row, double dt);

//---- walker.c

static inline double pl_up(const pl_walker *m, double x, double y)
{
    return x * m->ux + y * m->uy;
}

static inline double pl_right(const pl_walker *m, double x, double y)
{
    return x * m->rx + y * m->ry;
}

static inline bool pl_is_floor(const pl_walker *m, double nx, double ny)
{
    return pl_up(m, nx, ny) >= m->max_slope_cos;
}

// The first obstacle on the way by (dx, dy) that it approaches. False: none.
bool pl_walker_sweep(const pl_walker *m, double dx, double dy, pl_touch *touch);
// The same for a point of its own at (x, y) [m] against the shapes themselves; overlapping ones too.
bool pl_walker_probe(const pl_walker *m, double x, double y, double dx, double dy, pl_touch *touch,
                     bool *inside);
// Out of what it overlaps; how much is left goes to c->crushed.
void pl_walker_recover(pl_walker *m);
// Where it touches an obstacle, on that [m, relative to the start].
void pl_walker_touch_point(const pl_walker *m, const pl_touch *touch, double *x, double *y);
// Tells a hit; speed of approach [m/s].
void pl_walker_tell(pl_walker *m, const pl_touch *touch, double speed);

//---- ground.c: walking. `way` [m] along the ground, positive to the right, in `time` [s]; returns
// the time that is left when it walks off the ground, else 0.
double pl_walker_walk(pl_walker *m, double way, double time);
// Finds the ground within `reach` [m] below and settles on it. False: there is none.
bool pl_walker_settle(pl_walker *m, double reach);
void pl_walker_stand(pl_walker *m, const pl_touch *touch);
// Keeps for the air what ground at this velocity [m/s] has to the right.
void pl_walker_take_along(pl_walker *m, plumb_vec2 ground);
void pl_walker_leave_ground(pl_walker *m);

//---- air.c: flight over `time` [s]; returns the time that is left when it lands, else 0.
double pl_walker_fall(pl_walker *m, double time);
void pl_walker_fly(pl_walker *m, double time);
// Whether it steers in the air: on a slope that is too steep, only downhill.
bool pl_walker_steers(const pl_character *c, int slope_side);
// Moves *v towards `target` at a rate and stays there; returns the way over `time`. Rate 0: at once.
double pl_ramp(double *v, double target, double rate, double time);

//---- push.c: forces on dynamic bodies.
void pl_walker_push(pl_walker *m, const pl_touch *touch, double speed);
void pl_walker_weigh(pl_walker *m);
// Wakes the body of a row in this step, if it sleeps.
void pl_walker_rouse(plumb_world *world, uint32_t row);
// Adds a force at a point [m, world] of a dynamic row, so that it can be undone. Room is reserved.
// [kg] effective mass of a body at a point, along a direction; 1e30 where it cannot be moved.
double pl_walker_mass_at(const plumb_world *world, uint32_t row, double px, double py, double dx,
                         double dy);
void pl_shove_add(plumb_world *world, uint32_t row, double fx, double fy, double px, double py);

//---- dynamic.c: forces on a dynamic character. False when out of memory.
bool pl_character_drive(plumb_world *world, pl_character *c, real dt);

#endif
