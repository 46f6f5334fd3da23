// game_loop.c - the loop of a game: the world steps at a fixed rate, pictures come when they come,
// and what is drawn lies between two steps, so that motion is smooth at any frame rate.
//
//     steps     |-------|-------|-------|     dt apart, always the same: results do not depend
//     frames       ^  ^    ^  ^   ^           on the frame rate
//
// A frame at time t is drawn between the last two steps a and b, at a + alpha (b - a), with alpha
// the part of dt that time has run ahead of b. It shows the world up to one dt late; that is the
// price.
//
// Build: cc game_loop.c $(pkg-config --cflags --libs plumb) -lm
#include <plumb/plumb.h>

#include <math.h>
#include <stdio.h>

enum { CRATES = 5, MAX_STEPS_A_FRAME = 5 };

static const double dt = 1.0 / 60; // [s] of a step

typedef struct pose {
    double x, y;  // [m]
    double angle; // [rad]
} pose;

typedef struct game {
    plumb_world *world;
    plumb_body crates[CRATES];
    pose before[CRATES], now[CRATES]; // after the last step but one, and after the last
    double ahead;                     // [s] time that has passed and is not simulated yet, < dt
} game;

static bool game_start(game *g)
{
    plumb_world_desc settings = { .substeps = 4 };
    if (plumb_world_create(&settings, &g->world) != PLUMB_OK) {
        return false;
    }
    plumb_body_desc ground = { .type = PLUMB_STATIC };
    plumb_shape_desc floor = { .kind = PLUMB_BOX, .half = { 20, 1 }, .center = { 0, -1 } };
    plumb_shape_create(g->world, plumb_body_create(g->world, &ground), &floor);

    plumb_real half = (plumb_real)0.5;
    plumb_shape_desc box = { .kind = PLUMB_BOX, .half = { half, half } };
    for (int i = 0; i < CRATES; ++i) {
        plumb_body_desc crate = { .position = { (plumb_real)(0.3 * i),
                                                (plumb_real)(1 + 1.5 * i) } };
        g->crates[i] = plumb_body_create(g->world, &crate);
        plumb_shape_create(g->world, g->crates[i], &box);
        g->now[i] = (pose){ (double)crate.position.x, (double)crate.position.y, 0 };
        g->before[i] = g->now[i];
    }
    // Every call answers; the last refused one is kept with a message, so one look is enough here.
    plumb_error error = plumb_world_error(g->world);
    if (error.code != PLUMB_OK) {
        fprintf(stderr, "%s\n", error.message);
    }
    return error.code == PLUMB_OK;
}

static bool game_step(game *g)
{
    if (plumb_world_step(g->world, (plumb_real)dt) != PLUMB_OK) {
        fprintf(stderr, "%s\n", plumb_world_error(g->world).message);
        return false;
    }
    for (int i = 0; i < CRATES; ++i) {
        plumb_vec2 p = plumb_body_position(g->world, g->crates[i]);
        g->before[i] = g->now[i];
        g->now[i] =
            (pose){ (double)p.x, (double)p.y, (double)plumb_body_angle(g->world, g->crates[i]) };
    }
    return true;
}

// Takes the steps that are due after a frame of that many seconds.
static bool game_advance(game *g, double frame)
{
    g->ahead += frame;
    for (int n = 0; g->ahead >= dt; ++n) {
        if (n == MAX_STEPS_A_FRAME) {
            // Too slow to keep up: let the game run late rather than fall ever farther behind.
            g->ahead = 0;
            break;
        }
        if (!game_step(g)) {
            return false;
        }
        g->ahead -= dt;
    }
    return true;
}

// Where crate i is to be drawn now. Angles jump from pi to -pi: the shorter way round is taken.
static pose game_pose(const game *g, int i)
{
    const double two_pi = 6.283185307179586;
    double alpha = g->ahead / dt;
    pose a = g->before[i], b = g->now[i];
    double angle = a.angle + alpha * remainder(b.angle - a.angle, two_pi);
    return (pose){ a.x + alpha * (b.x - a.x), a.y + alpha * (b.y - a.y), remainder(angle, two_pi) };
}

int main(void)
{
    // A real game asks its clock; these frames come at about 144 Hz, one of them very late.
    const double frames[] = { 0.007, 0.0068, 0.0071, 0.007, 0.0069, 0.120, 0.007, 0.0072 };
    const int kinds = (int)(sizeof frames / sizeof frames[0]);

    game g = { 0 };
    bool ok = game_start(&g);
    double time = 0;
    for (int frame = 0; ok && frame < 200; ++frame) {
        ok = game_advance(&g, frames[frame % kinds]);
        time += frames[frame % kinds];
        if (ok && frame % 20 == 19) {
            pose top = game_pose(&g, CRATES - 1);
            printf("frame %3d  %.3f s  top crate at (%.3f, %.3f) m, %.3f rad\n", frame + 1, time,
                   top.x, top.y, top.angle);
        }
    }
    plumb_world_destroy(g.world);
    return ok ? 0 : 1;
}
