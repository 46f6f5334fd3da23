/// sim.h - short words for building small worlds in tests: makes or aborts, so that a test reads as
/// the physics that it checks. Plumb only, public headers only; everything told in double.
///
///     plumb_world *w = sim_world(&(plumb_world_desc){ 0 });
///     plumb_material wood = sim_material(w, 0.4, 0.0);
///     sim_floor(w, wood);
///     plumb_body crate = sim_crate(w, 0, 0.5, 0.5, 0.5, wood);
///     sim_run(w, 120, 1.0 / 60);
///     double x = sim_x(w, crate);
///     plumb_world_destroy(w);
#ifndef HARNESS_SIM_H
#define HARNESS_SIM_H

#include "harness/random.h"
#include "plumb/plumb.h"

#define SIM_PI 3.14159265358979323846

/// [m/s^2] default gravity of a world
#define SIM_G 9.81

/// Whether what contacts and joints do is rounded to floats: so it is in the far build, too.
#define SIM_IS_FLOAT (sizeof(plumb_real) == 4 || PLUMB_IS_FAR)

/// [-] spacing of the solver's reals of this build at 1, as a double.
#define SIM_EPSILON (SIM_IS_FLOAT ? 1.1920929e-7 : (double)PLUMB_REAL_EPSILON)

/// The tolerance of this build's precision.
#define SIM_TOLERANCE(in_float, in_double) (SIM_IS_FLOAT ? (in_float) : (in_double))

plumb_vec2 sim_vec(double x, double y);

/// World with a log hook that tells refused calls on stderr.
plumb_world *sim_world(const plumb_world_desc *desc);
/// World without gravity, otherwise default.
plumb_world *sim_space(void);

plumb_material sim_material(plumb_world *w, double friction, double restitution);

/// A body without shapes.
plumb_body sim_body(plumb_world *w, plumb_body_type type, double x, double y, double angle);
/// A dynamic body without shapes: a point mass, or with inertia. [kg], [kg m^2]
plumb_body sim_mass(plumb_world *w, double x, double y, double kg, double inertia);
/// A joint by all of a descriptor.
plumb_joint sim_joint(plumb_world *w, plumb_joint_desc desc);
void sim_add_circle(plumb_world *w, plumb_body b, double r, plumb_material m);
void sim_add_box(plumb_world *w, plumb_body b, double hx, double hy, plumb_material m);
void sim_add_segment(plumb_world *w, plumb_body b, plumb_vec2 p, plumb_vec2 q, plumb_material m);

/// Dynamic disc and dynamic box of density 1.
plumb_body sim_ball(plumb_world *w, double x, double y, double r, plumb_material m);
plumb_body sim_crate(plumb_world *w, double x, double y, double hx, double hy, plumb_material m);
/// Static box 400 m wide and 2 m high whose top is the line y = 0.
plumb_body sim_floor(plumb_world *w, plumb_material m);

/// Takes `count` steps of dt.
void sim_run(plumb_world *w, int count, double dt);
void sim_step(plumb_world *w, double dt);

/// An image of a world, for free(), and its size.
void *sim_save(const plumb_world *w, size_t *size);
/// Whether the next step has the pass of that name, of those that there are.
bool sim_has_pass(const plumb_world *w, const char *name);

double sim_x(const plumb_world *w, plumb_body b);
double sim_y(const plumb_world *w, plumb_body b);
double sim_angle(const plumb_world *w, plumb_body b);
double sim_vx(const plumb_world *w, plumb_body b);
double sim_vy(const plumb_world *w, plumb_body b);
double sim_w(const plumb_world *w, plumb_body b);
void sim_launch(plumb_world *w, plumb_body b, double vx, double vy, double spin);

/// [J] kinetic and potential.
double sim_energy(const plumb_world *w);
/// [m/s] fastest dynamic body.
double sim_max_speed(plumb_world *w);
/// [N] force between two bodies along their normals: impulse of the last substep over its length.
double sim_normal_force(const plumb_world *w, plumb_body a, plumb_body b, double dt);

/// Order of convergence: least-squares slope of log error over log h, where h halves from one
/// row to the next.
double sim_order(const double *error, int count);

/// Makes 0 of a joint's members that its kind does not have, and would be refused for.
void sim_fit_joint(plumb_joint_desc *desc);

#endif
