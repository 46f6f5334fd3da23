// show.c - a game shows its world: plumb_draw and thirty lines of SDL2 that draw lines and filled polygons.
//
// Press space to throw a ball, P to pause (steps of dt 0), D for all that can be drawn, Q to quit. For machines
// without a screen: show --frames 150 picture.bmp draws so many frames and saves the last one (with a word
// behind it, of all that can be drawn).
//
// Build: cc show.c $(pkg-config --cflags --libs plumb sdl2) -lm
#include <SDL2/SDL.h>
#include <plumb/plumb.h>

#include <stdlib.h>
#include <string.h>

enum { WIDTH = 960, HEIGHT = 420 };

//---- from here on: all that drawing needs -----------------------------------------------------------

typedef struct screen {
    SDL_Renderer *renderer;
    plumb_aabb view; // [m] what the window shows
} screen;

static SDL_FPoint to_pixels(const screen *s, plumb_vec2 p)
{
    const float scale = WIDTH / (float)(s->view.max.x - s->view.min.x);
    return (SDL_FPoint){ (float)(p.x - s->view.min.x) * scale,
                         (float)(s->view.max.y - p.y) * scale };
}

static void draw_line(void *context, plumb_vec2 a, plumb_vec2 b, plumb_color c)
{
    const screen *s = context;
    const SDL_FPoint p = to_pixels(s, a), q = to_pixels(s, b);
    SDL_SetRenderDrawColor(s->renderer, c.r, c.g, c.b, c.a);
    SDL_RenderDrawLineF(s->renderer, p.x, p.y, q.x, q.y);
}

// A fan of triangles about the first corner.
static void draw_fill(void *context, const plumb_vec2 *points, int count, plumb_color c)
{
    SDL_Vertex corners[64];
    int fan[3 * 62];
    for (int i = 0; i < count; ++i) {
        corners[i] =
            (SDL_Vertex){ to_pixels(context, points[i]), { c.r, c.g, c.b, c.a }, { 0, 0 } };
    }
    for (int i = 0; i < 3 * (count - 2); ++i) {
        fan[i] = i % 3 == 0 ? 0 : i / 3 + i % 3;
    }
    SDL_RenderGeometry(((screen *)context)->renderer, NULL, corners, count, fan, 3 * (count - 2));
}

static void show(screen *s, plumb_world *world, const plumb_loop *loop, unsigned parts)
{
    const plumb_draw_calls calls = { .line = draw_line, .fill = draw_fill, .context = s };
    SDL_SetRenderDrawColor(s->renderer, 24, 27, 33, 255);
    SDL_RenderClear(s->renderer);
    plumb_draw(world, &calls,
               &(plumb_draw_desc){ .view = s->view,
                                   .pixel = (s->view.max.x - s->view.min.x) / WIDTH,
                                   .parts = parts,
                                   .loop = loop });
    SDL_RenderPresent(s->renderer);
}

//---- the game ------------------------------------------------------------------------------------

static plumb_body add(plumb_world *world, plumb_body_type type, double x, double y,
                      plumb_shape_desc shape)
{
    const plumb_body_desc desc = { .type = type, .position = { (plumb_real)x, (plumb_real)y } };
    const plumb_body body = plumb_body_create(world, &desc);
    plumb_shape_create(world, body, &shape);
    return body;
}

static void throw_ball(plumb_world *world)
{
    const plumb_body ball =
        add(world, PLUMB_DYNAMIC, -7, 3,
            (plumb_shape_desc){ .kind = PLUMB_CIRCLE, .radius = (plumb_real)0.5, .density = 3 });
    plumb_body_set_velocity(world, ball, plumb_v2(14, 4));
}

// A wall of bricks, a bridge of planks, and what falls on it.
static void build(plumb_world *world)
{
    const plumb_real half = (plumb_real)0.5, thin = (plumb_real)0.12;
    const plumb_vec2 hill[] = { { -10, 3 }, { -8, 1 }, { -6, 0 } };
    const plumb_body ground =
        add(world, PLUMB_STATIC, 0, 0,
            (plumb_shape_desc){ .kind = PLUMB_BOX, .half = { 12, 1 }, .center = { 0, -1 } });
    plumb_shape_create(world, ground,
                       &(plumb_shape_desc){ .kind = PLUMB_CHAIN, .points = hill, .count = 3 });
    for (int row = 0; row < 6; ++row) {
        for (int i = 0; i < 4; ++i) {
            add(world, PLUMB_DYNAMIC, 1.05 * i + (row % 2) * 0.5 - 1, 0.3 + 0.6 * row,
                (plumb_shape_desc){ .kind = PLUMB_BOX, .half = { half, (plumb_real)0.3 } });
        }
    }
    plumb_body before = { 0 };
    for (int i = 0; i <= 6; ++i) { // planks, and a hinge at either end of each
        const plumb_real x = (plumb_real)(4 + 0.7 * i);
        const plumb_body plank =
            i == 6
                ? (plumb_body){ 0 }
                : add(world, PLUMB_DYNAMIC, (double)x + 0.35, 4,
                      (plumb_shape_desc){ .kind = PLUMB_BOX, .half = { (plumb_real)0.33, thin } });
        plumb_joint_create(world, &(plumb_joint_desc){ .kind = PLUMB_REVOLUTE,
                                                       .body_a = before,
                                                       .body_b = plank,
                                                       .anchor = { x, 4 } });
        before = plank;
    }
}

// False when the player has had enough.
static bool play(plumb_world *world, bool *paused, unsigned *parts)
{
    for (SDL_Event event; SDL_PollEvent(&event) != 0;) {
        const SDL_Keycode key = event.type == SDL_KEYDOWN ? event.key.keysym.sym : 0;
        if (event.type == SDL_QUIT || key == SDLK_q) {
            return false;
        }
        if (key == SDLK_SPACE) {
            throw_ball(world);
        }
        *paused ^= key == SDLK_p;
        *parts ^= key == SDLK_d ? PLUMB_DRAW_ALL : 0u; // of {0}: the usual ones
    }
    return true;
}

static bool save(SDL_Renderer *renderer, const char *path)
{
    SDL_Surface *picture =
        SDL_CreateRGBSurfaceWithFormat(0, WIDTH, HEIGHT, 32, SDL_PIXELFORMAT_ARGB8888);
    const bool saved = picture != NULL &&
                       SDL_RenderReadPixels(renderer, NULL, SDL_PIXELFORMAT_ARGB8888,
                                            picture->pixels, picture->pitch) == 0 &&
                       SDL_SaveBMP(picture, path) == 0;
    SDL_FreeSurface(picture);
    return saved;
}

// So many frames for a machine without a player, or until the player quits.
static bool run(screen *s, plumb_world *world, plumb_loop *loop, long frames, unsigned parts)
{
    bool paused = false;
    Uint64 before = SDL_GetPerformanceCounter();
    for (long frame = 0; frames == 0 || frame < frames; ++frame) {
        if (!play(world, &paused, &parts)) {
            break;
        }
        const Uint64 now = SDL_GetPerformanceCounter();
        const double seconds =
            frames > 0 ? 1.0 / 60 : (double)(now - before) / (double)SDL_GetPerformanceFrequency();
        before = now;
        if (paused) {
            plumb_world_step(world, 0); // what was thrown in meanwhile is seen
        } else {
            for (int n = plumb_loop_frame(loop, seconds); n > 0; --n) {
                plumb_loop_step(loop);
            }
        }
        show(s, world, loop, parts);
    }
    return plumb_world_error(world).code == PLUMB_OK;
}

int main(int count, char **arguments)
{
    const bool alone = count >= 4 && strcmp(arguments[1], "--frames") == 0;
    const long frames = alone ? strtol(arguments[2], NULL, 10) : 0;
    screen s = { .view = { { -9, -1 }, { 9, (plumb_real)6.875 } } };
    plumb_world *world;
    plumb_loop *loop;
    if (SDL_Init(SDL_INIT_VIDEO) != 0 || plumb_world_create(NULL, &world) != PLUMB_OK) {
        SDL_Log("%s", SDL_GetError());
        return 1;
    }
    SDL_Window *window =
        SDL_CreateWindow("plumb", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, WIDTH, HEIGHT, 0);
    s.renderer =
        SDL_CreateRenderer(window, -1, alone ? SDL_RENDERER_SOFTWARE : SDL_RENDERER_PRESENTVSYNC);
    SDL_SetRenderDrawBlendMode(s.renderer, SDL_BLENDMODE_BLEND);
    build(world);
    plumb_loop_create(world, NULL, &loop);
    if (alone) {
        throw_ball(world);
    }
    bool ok = run(&s, world, loop, frames, alone && count == 5 ? PLUMB_DRAW_ALL : 0);
    ok = ok && (!alone || save(s.renderer, arguments[3]));
    plumb_loop_destroy(loop);
    plumb_world_destroy(world);
    SDL_DestroyRenderer(s.renderer);
    SDL_DestroyWindow(window);
    SDL_Quit();
    return ok ? 0 : 1;
}
