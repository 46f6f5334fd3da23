/// engine_lint_units.c - lint: numbers that look like degrees, pixels, densities of a tenth of a percent, or a y that points down.
#include "engine_lint.h"

#include <math.h>

/// [rad] whole numbers from there on are taken for degrees: nobody turns by 30 whole radians.
static const double DEGREES = 10;
/// [m], [m/s^2] from there on lengths look like pixels: half of what falls is thicker than that, or falls faster than that. The
/// largest scenes of ours have blocks of 10 m, and none falls faster than on the sun's planets.
static const double PIXELS = 16, PIXELS_GRAVITY = 100;
/// [-] of the fluid's density: what is lighter than that hardly gets wet.
static const double LIGHT = 0.01;

static bool looks_like_degrees(double angle)
{
    return fabs(angle) >= DEGREES && fabs(angle) <= 3600 && fabs(angle - round(angle)) < 1e-9;
}

static void look_at_angles(lint_job *job)
{
    for (int i = 0; i < pl_lint_body_count(job); i++) {
        const scene_body body = scene_body_get(job->scene, i);
        if (looks_like_degrees(body.angle)) {
            pl_lint_tell(job, "'%s' is turned by %g radians, %.3g turns: degrees are 'angle_deg'",
                         body.name, body.angle, body.angle / (2 * 3.14159265358979323846));
        }
    }
    for (int i = 0; i < scene_joint_count(job->scene); i++) {
        const scene_joint j = scene_joint_get(job->scene, i);
        plumb_joint_desc d;
        if (plumb_joint_settings(job->world, j.entity, &d) == PLUMB_OK &&
            d.kind == PLUMB_REVOLUTE && d.enable_limit &&
            (looks_like_degrees((double)d.lower) || looks_like_degrees((double)d.upper))) {
            pl_lint_tell(job, "'%s' is held between %g and %g radians, which look like degrees",
                         j.name, (double)d.lower, (double)d.upper);
        }
    }
}

/// The first body that falls and is as thick as pixels make it, where half of those that fall are; null: they are not.
static plumb_body first_thick(const lint_job *job, double *thick)
{
    plumb_body first = { 0 };
    int falling = 0, large = 0;
    for (int i = 0; i < pl_lint_body_count(job); i++) {
        const plumb_body body = pl_lint_body_at(job, i);
        const double own = pl_lint_is_dynamic(job, body) ? pl_lint_thickness(job, body) : -1;
        falling += own > 0;
        large += own >= PIXELS;
        if (own >= PIXELS && large == 1) {
            first = body;
            *thick = own;
        }
    }
    return 2 * large >= falling ? first : (plumb_body){ 0 };
}

static void look_at_lengths(lint_job *job)
{
    const plumb_vec2 g = plumb_world_gravity(job->world);
    const double size = hypot((double)g.x, (double)g.y);
    double thick = 0;
    const plumb_body first = size > 0 ? first_thick(job, &thick) : (plumb_body){ 0 };
    if (!plumb_is_null(first)) {
        pl_lint_tell(job,
                     "'%s', as half of what falls, is %.3g m thick and takes %.2g s to fall by "
                     "that: a length in pixels?",
                     pl_lint_name_of(job, first), thick, sqrt(2 * thick / size));
    }
    if (size >= PIXELS_GRAVITY) {
        pl_lint_tell(job, "gravity is %.3g m/s^2, %.3g times the earth's: centimetres or pixels?",
                     size, size / 9.81);
    }
    const bool is_down = job->desc.y_axis == PLUMB_Y_DOWN;
    if ((is_down ? -1 : 1) * (double)g.y > fabs((double)g.x)) {
        pl_lint_tell(job, "gravity is {%g, %g}, and y points %s", (double)g.x, (double)g.y,
                     is_down ? "down" : "up: y = \"down\"");
    }
}

/// [kg/m^2] of the densest fluid that lifts; 0: there is none.
static double densest_fluid(const lint_job *job)
{
    plumb_liquid_desc liquid;
    double most = 0;
    if (plumb_liquid_settings(job->world, &liquid) == PLUMB_OK) {
        most = liquid.density > 0 ? (double)liquid.density : 1000;
    }
    for (int i = 0; i < pl_lint_body_count(job); i++) {
        plumb_shape *list;
        const int count = pl_lint_shapes_of(job, pl_lint_body_at(job, i), &list);
        for (int k = 0; k < count; k++) {
            plumb_material_desc m;
            if (plumb_shape_is_sensor(job->world, list[k]) &&
                plumb_material_settings(job->world, plumb_shape_material(job->world, list[k]),
                                        &m) == PLUMB_OK &&
                m.fluid && !m.weightless) {
                most = fmax(most, (double)m.density);
            }
        }
    }
    return most;
}

/// One finding for all: who leaves a density out leaves it out everywhere.
static void look_at_densities(lint_job *job)
{
    const double fluid = densest_fluid(job);
    const char *first = NULL;
    double lightest = HUGE_VAL;
    int light = 0;
    for (int i = 0; i < pl_lint_body_count(job) && fluid > 0; i++) {
        const plumb_body body = pl_lint_body_at(job, i);
        plumb_shape *list;
        const int count = pl_lint_is_dynamic(job, body) ? pl_lint_shapes_of(job, body, &list) : 0;
        bool is_light = false;
        for (int k = 0; k < count; k++) {
            const double density = (double)plumb_shape_density(job->world, list[k]);
            if (!plumb_shape_is_sensor(job->world, list[k]) && density < LIGHT * fluid) {
                is_light = true;
                lightest = fmin(lightest, density);
            }
        }
        light += is_light;
        first = is_light && first == NULL ? pl_lint_name_of(job, body) : first;
    }
    if (light > 0) {
        pl_lint_tell(
            job,
            "'%s'%s of a density of %.3g kg/m^2 in a scene with a fluid of %.3g: on it, not in it",
            first, light > 1 ? " and others are" : " is", lightest, fluid);
    }
}

void pl_lint_units(lint_job *job)
{
    look_at_angles(job);
    look_at_lengths(job);
    look_at_densities(job);
}
