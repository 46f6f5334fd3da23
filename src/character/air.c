// air.c - a character in the air: exact parabolas, sliding along what it meets, landing.
//
// The way of a time t is v t + a t^2 / 2, taken as one straight line per step; velocities change by
// ramps whose integrals are exact, so that where a jump goes does not depend on the step. On the way
// a wall takes its normal part from velocity and way; a slope too steep to stand on is a slide
// downwards and a wall upwards, so that it cannot be climbed by running into it.
//
// Reads: obstacles. Writes: place, velocity. Cost: O(obstacles) a wall met, at most SLIDES.
#include "query/query.h"
#include "character/walker.h"

#include <math.h>

#define SLIDES 8

double pl_ramp(double *v, double target, double rate, double time)
{
    double gap = target - *v;
    if (!(rate > 0)) {
        *v = target;
        return target * time;
    }
    double needed = fabs(gap) / rate;
    if (needed > time) {
        double change = gap > 0 ? rate * time : -rate * time;
        double way = (*v + change / 2) * time;
        *v += change;
        return way;
    }
    double way = (*v + target) / 2 * needed + target * (time - needed);
    *v = target;
    return way;
}

bool pl_walker_steers(const pl_character *c, int slope_side)
{
    return !c->desc.no_air_control && (slope_side == 0 || (double)c->walk * slope_side > 0);
}

// [-] of the half width, [-] of the speed: a surface that it leaves as it starts holds it no more,
// though the straight line of the step may cut its corner.
#define START  1e-2
#define LEAVES 1e-6

typedef struct flight {
    double dx, dy; // [m] what is left of the way
    double left;   // [-] share of the time that is left
    double gone;   // [m] since the start
    double px, py; // normal of the surface slid along before
    int met;
} flight;

static void take_normal(double *x, double *y, double nx, double ny)
{
    double into = *x * nx + *y * ny;
    if (into < 0) {
        *x -= into * nx;
        *y -= into * ny;
    }
}

static void take_from_velocity(pl_walker *m, const pl_touch *t, double nx, double ny)
{
    plumb_vec2 *v = &m->c->velocity;
    double ox, oy;
    pl_obstacle_velocity(t->obstacle, m->x, m->y, &ox, &oy);
    double vx = (double)v->x - ox, vy = (double)v->y - oy;
    take_normal(&vx, &vy, nx, ny);
    v->x = (real)(vx + ox);
    v->y = (real)(vy + oy);
}

// Between two slopes that are too steep it stands.
static bool is_wedged(const pl_walker *m, const flight *f, double nx, double ny)
{
    return f->met > 0 && pl_up(m, nx, ny) > 0 && pl_up(m, f->px, f->py) > 0 &&
           pl_right(m, nx, ny) * pl_right(m, f->px, f->py) < 0;
}

// Turns the rest of the way along what was met. False: there is none.
static bool turn_aside(pl_walker *m, flight *f, const pl_touch *t)
{
    double nx = t->nx, ny = t->ny;
    double rising = pl_most(pl_up(m, f->dx, f->dy), 0);
    plumb_vec2 before = m->c->velocity;
    take_from_velocity(m, t, nx, ny);
    take_normal(&f->dx, &f->dy, nx, ny);
    if (pl_up(m, nx, ny) > 0 && pl_up(m, f->dx, f->dy) > rising) {
        // It would climb: upright, the slope is a wall.
        double side = pl_right(m, nx, ny) > 0 ? 1 : -1;
        m->c->velocity = before;
        take_from_velocity(m, t, side * m->rx, side * m->ry);
        f->dx = rising * m->ux;
        f->dy = rising * m->uy;
    }
    if (f->met > 0 && f->dx * f->px + f->dy * f->py < 0) {
        return false; // a corner
    }
    f->px = nx, f->py = ny;
    ++f->met;
    return f->dx * f->dx + f->dy * f->dy > 1e-18;
}

static void note(pl_walker *m, const pl_touch *t)
{
    pl_character *c = m->c;
    double up = pl_up(m, t->nx, t->ny);
    c->at_ceiling |= up < -0.5;
    c->at_wall |= fabs(up) <= 0.5;
    if (up > 1e-3 && !pl_is_floor(m, t->nx, t->ny)) {
        c->on_slope = true;
        c->slope_side = pl_right(m, t->nx, t->ny) > 0 ? 1 : -1;
    }
}

static double approach_of(const pl_walker *m, const pl_touch *t)
{
    double vx, vy;
    pl_obstacle_velocity(t->obstacle, m->x, m->y, &vx, &vy);
    return (vx - (double)m->c->velocity.x) * t->nx + (vy - (double)m->c->velocity.y) * t->ny;
}

// Whether it was on the way out of the floor it meets when the step began, with velocity v.
static bool is_leaving(const pl_walker *m, const flight *f, const pl_touch *t, plumb_vec2 v)
{
    double ox, oy;
    pl_obstacle_velocity(t->obstacle, m->x, m->y, &ox, &oy);
    double out = ((double)v.x - ox) * t->nx + ((double)v.y - oy) * t->ny;
    double speed = fabs((double)v.x) + fabs((double)v.y);
    return f->gone < START * m->half_width && out > LEAVES * speed;
}

// Back on the ground that it stood on when the step began, as where it pushes and is lifted by a hair.
static bool stands_again(const pl_walker *m, const pl_touch *t)
{
    return pl_is_floor(m, t->nx, t->ny) &&
           plumb_same(m->world->pieces.shape[t->obstacle->piece], m->stood);
}

// Goes along (dx, dy), having begun with velocity v; stops where it lands when `lands`, and returns the
// share that is left.
static double slide(pl_walker *m, double dx, double dy, plumb_vec2 v, bool lands)
{
    flight f = { .dx = dx, .dy = dy, .left = 1 };
    for (int i = 0; i < SLIDES; ++i) {
        pl_touch t;
        if (!pl_walker_sweep(m, f.dx, f.dy, &t)) {
            m->x += f.dx;
            m->y += f.dy;
            return 0;
        }
        m->x += t.fraction * f.dx;
        m->y += t.fraction * f.dy;
        f.gone += t.fraction * sqrt(f.dx * f.dx + f.dy * f.dy);
        f.dx *= 1 - t.fraction;
        f.dy *= 1 - t.fraction;
        f.left *= 1 - t.fraction;
        if (lands && pl_is_floor(m, t.nx, t.ny) && is_leaving(m, &f, &t, v)) {
            take_normal(&f.dx, &f.dy, t.nx, t.ny);
            continue;
        }
        double approach = approach_of(m, &t);
        if (!stands_again(m, &t)) {
            pl_walker_tell(m, &t, approach);
        }
        bool wedged = lands && is_wedged(m, &f, t.nx, t.ny);
        if (lands && (wedged || pl_is_floor(m, t.nx, t.ny)) && approach >= -1e-6) {
            pl_walker_stand(m, &t);
            return wedged ? 0 : f.left;
        }
        note(m, &t);
        pl_walker_push(m, &t, approach);
        if (!turn_aside(m, &f, &t)) {
            return 0;
        }
    }
    return 0;
}

double pl_walker_fall(pl_walker *m, double time)
{
    pl_character *c = m->c;
    plumb_vec2 start = c->velocity;
    double side = pl_right(m, (double)c->velocity.x, (double)c->velocity.y);
    double rise = pl_up(m, (double)c->velocity.x, (double)c->velocity.y);
    double pull = -pl_up(m, m->gravity_x, m->gravity_y);
    double drift = pl_right(m, m->gravity_x, m->gravity_y);
    double way_up =
        pull > 0 ? pl_ramp(&rise, -m->max_fall, pull, time) : rise * time - pull * time * time / 2;
    rise -= pull > 0 ? 0 : pull * time;
    double way = pl_walker_steers(c, m->slope_side)
                     ? pl_ramp(&side, (double)c->walk + (double)c->left, m->air_acceleration, time)
                     : side * time;
    way += drift * time * time / 2;
    side += drift * time;
    c->velocity.x = (real)(side * m->rx + rise * m->ux);
    c->velocity.y = (real)(side * m->ry + rise * m->uy);
    // What carried it in this step has done so for all of it.
    double dx = way * m->rx + way_up * m->ux - m->carried_x * time / m->dt;
    double dy = way * m->ry + way_up * m->uy - m->carried_y * time / m->dt;
    const double over = slide(m, dx, dy, start, true) * time;
    c->left = c->at_wall ? 0 : c->left;
    return over;
}

void pl_walker_fly(pl_walker *m, double time)
{
    pl_character *c = m->c;
    plumb_vec2 start = c->velocity;
    double vx = (double)c->velocity.x, vy = (double)c->velocity.y;
    double gx = (double)c->fly.x - vx, gy = (double)c->fly.y - vy;
    double gap = sqrt(gx * gx + gy * gy);
    double gained = 0; // along the gap
    double way = gap > 0 ? pl_ramp(&gained, gap, m->acceleration, time) : 0;
    double ux = gap > 0 ? gx / gap : 0, uy = gap > 0 ? gy / gap : 0;
    c->velocity.x = (real)(vx + gained * ux);
    c->velocity.y = (real)(vy + gained * uy);
    slide(m, vx * time + way * ux, vy * time + way * uy, start, false);
}
