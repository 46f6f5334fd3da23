// use.c - uses what test_extend.sh has added to a copy of the tree: from C, Lua and JSON, saved, replayed, listed, and what
// it does to bodies against closed forms. One line each; exit status 1 if any is wrong.
#include "plumb/plumb.h"
#include "scene/scene.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// [m] what a step of 1/256 s leaves of a way of a second at 8 m/s^2: a h t / 2.
#define FIRST_ORDER (8.0 / 256 / 2 * 1.1)

static int bad;
static char tape[1 << 20], image[1 << 20];
static size_t used;

static void is(const char *what, int good)
{
    printf("%s: %s\n", what, good ? "yes" : "NO");
    bad += !good;
}

// |value - exact| <= error, with the difference.
static void near(const char *what, plumb_real value, double exact, double error)
{
    printf("%s: %.9g, off by %.2g of %.2g: %s\n", what, (double)value, (double)value - exact, error,
           fabs((double)value - exact) <= error ? "yes" : "NO");
    bad += !(fabs((double)value - exact) <= error);
}

static bool keep(void *context, const void *bytes, size_t size)
{
    (void)context;
    if (used + size > sizeof tape) {
        return false;
    }
    memcpy(tape + used, bytes, size);
    used += size;
    return true;
}

static scene *load(const char *path, const char *text, scene_error *error)
{
    scene *s = NULL;
    const scene_options options = { .path = path, .text = text, .text_size = strlen(text) };
    scene_load(&options, &s, error);
    return s;
}

// The scene of the JSON that the scene of a Lua text writes; null if one of them is refused, or lacks `needle`.
static scene *said(const char *lua, const char *needle)
{
    scene_error error = { .text = "" };
    char *json = NULL;
    size_t size;
    scene *copy = NULL, *s = load("a.lua", lua, &error);
    if (s != NULL) {
        FILE *file = open_memstream(&json, &size);
        scene_to_json(s, file);
        fclose(file);
        copy = strstr(json, needle) != NULL ? load("a.json", json, &error) : NULL;
    }
    printf("%s%s", error.text, copy == NULL && json != NULL ? json : "");
    free(json);
    return copy;
}

static plumb_world *weightless(void)
{
    plumb_world *w = NULL;
    plumb_world_create(&(plumb_world_desc){ .zero_gravity = true }, &w);
    plumb_world_watch(w, PLUMB_WATCH_WRITES);
    return w;
}

static void run(plumb_world *w, int steps)
{
    for (int i = 0; i < steps; i++) {
        plumb_world_step(w, (plumb_real)(1.0 / 64));
    }
}

static bool is_scheduled(const plumb_world *w, const char *name)
{
    plumb_pass_info rows[128];
    const int count = plumb_world_schedule(w, rows, 128);
    for (int i = 0; i < count; i++) {
        if (strcmp(rows[i].name, name) == 0) {
            return rows[i].scheduled && rows[i].reason[0] != 0;
        }
    }
    return false;
}

// Runs on for `steps` from an image, and from a recording, to the same bits.
static void comes_again(const char *what, plumb_world *w, int steps)
{
    plumb_world_save(w, image, sizeof image);
    used = 0;
    plumb_recorder_start(w, &(plumb_recorder_desc){ .write = keep });
    run(w, steps);
    plumb_recorder_stop(w);
    const uint64_t hash = plumb_world_hash(w);
    plumb_replay *replay = NULL;
    plumb_replay_open(tape, used, NULL, &replay);
    for (int i = 0; i < steps; i++) {
        plumb_replay_step(replay);
    }
    const bool replayed = plumb_world_hash(plumb_replay_world(replay)) == hash;
    plumb_replay_close(replay);
    plumb_world_restore(w, image, sizeof image);
    run(w, steps);
    is(what, replayed && plumb_world_hash(w) == hash);
}

//---- body property -------------------------------------------------------------------------------

static plumb_real tracing_in(scene *s)
{
    plumb_world *w = scene_world(s);
    return plumb_body_tracing(w, plumb_world_bodies(w).body[0]);
}

static void use_tracing(void)
{
    plumb_world *w;
    plumb_world_create(NULL, &w);
    plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .tracing = 3 });
    is("tracing: made", plumb_body_tracing(w, b) == 3);
    is("tracing: refused",
       plumb_body_set_tracing(w, b, 11) == PLUMB_E_RANGE &&
           strstr(plumb_world_error(w).message, "tracing is 11; it must be 0 to 10") != NULL);
    plumb_world_save(w, image, sizeof image);
    const uint64_t hash = plumb_world_hash(w);
    used = 0;
    plumb_recorder_start(w, &(plumb_recorder_desc){ .write = keep });
    plumb_body_set_tracing(w, b, 5);
    is("tracing: hashed", plumb_world_hash(w) != hash);
    run(w, 1);
    plumb_recorder_stop(w);
    plumb_replay *replay;
    plumb_replay_open(tape, used, NULL, &replay);
    plumb_replay_step(replay);
    is("tracing: replayed", plumb_body_tracing(plumb_replay_world(replay), b) == 5);
    plumb_world_restore(w, image, sizeof image);
    is("tracing: restored", plumb_body_tracing(w, b) == 3);
    const plumb_property *p = plumb_property_find(PLUMB_TABLE_BODY, "tracing");
    is("tracing: listed", p != NULL && p->high == 10 && strcmp(p->unit, "C") == 0);

    scene *s = said("body{ circle{1}, tracing = 4 }", "\"tracing\":4");
    is("tracing: said in Lua and JSON", s != NULL && tracing_in(s) == 4);
    scene_error error;
    is("tracing: refused in Lua",
       load("b.lua", "body{ circle{1}, tracing = 12 }", &error) == NULL &&
           strstr(error.text, "'tracing' of body{} must be at least 0 and at most 10 C"));
}

//---- force effect --------------------------------------------------------------------------------

static void use_wind(void)
{
    plumb_world *w = weightless();
    const plumb_body_desc light = { .mass = 2, .inertia = 1 };
    plumb_body free_one = plumb_body_create(w, &light), pushed = plumb_body_create(w, &light);
    is("wind: none, no row", !is_scheduled(w, "wind"));
    plumb_body_set_wind(w, pushed, 3);
    run(w, 64);
    is("wind: in the schedule", is_scheduled(w, "wind"));
    near("wind: F/m t^2/2", plumb_body_position(w, pushed).x, 0.75, 1e-6);
    near("wind: F/m t", plumb_body_velocity(w, pushed).x, 1.5, 1e-6);
    is("wind: on nobody else", plumb_body_position(w, free_one).x == 0);
    comes_again("wind: saved, replayed", w, 32);
    is("wind: writes what it declares", plumb_world_error(w).code == PLUMB_OK);

    // With damping c: F / (m c) (1 - exp(-c t)).
    plumb_body_set_damping(w, pushed, 2, 0);
    plumb_body_set_velocity(w, pushed, (plumb_vec2){ 0, 0 });
    run(w, 64);
    near("wind: against damping", plumb_body_velocity(w, pushed).x, 0.75 * (1 - exp(-2)), 1e-5);
    plumb_world *classic = NULL;
    plumb_world_create(
        &(plumb_world_desc){ .zero_gravity = true, .solver = PLUMB_SOLVER_PGS, .workers = 2 },
        &classic);
    pushed = plumb_body_create(classic, &(plumb_body_desc){ .mass = 2, .inertia = 1, .wind = 3 });
    run(classic, 64);
    near("wind: by the classic solver", plumb_body_velocity(classic, pushed).x, 1.5, 1e-5);

    // On the ground: (F - mu m g) / m.
    scene *s = said("scene{ gravity = {0, -10} } local m = material{ friction = 0.25 } "
                    "body{ type = 'static', box{100, 2, at = {0, -1}}, material = m } "
                    "body{ box{1, 1}, at = {0, 0.5}, mass = 2, material = m, wind = 9 }",
                    "\"wind\":9");
    is("wind: said in Lua and JSON", s != NULL);
    run(scene_world(s), 64);
    near("wind: against friction", plumb_world_bodies(scene_world(s)).x[0], 1, FIRST_ORDER);
}

//---- pass ----------------------------------------------------------------------------------------

static void use_edge(void)
{
    plumb_world *w = weightless();
    is("edge: nothing, no row", !is_scheduled(w, "edge of the world"));
    plumb_body b = plumb_body_create(
        w,
        &(plumb_body_desc){ .position = { 9, 0 }, .velocity = { 4, 1 }, .mass = 1, .inertia = 1 });
    run(w, 8);
    near("edge: before", plumb_body_position(w, b).x, 9.5, 1e-5);
    comes_again("edge: saved, replayed", w, 56);
    is("edge: held", plumb_body_position(w, b).x == 10 && plumb_body_velocity(w, b).x == 0);
    near("edge: runs along it", plumb_body_position(w, b).y, 1, 1e-5);
    is("edge: in the schedule", is_scheduled(w, "edge of the world"));
    is("edge: writes what it declares", plumb_world_error(w).code == PLUMB_OK);
}

//---- material property ----------------------------------------------------------------------------

static void use_polish(void)
{
    plumb_world *w;
    plumb_world_create(&(plumb_world_desc){ .gravity = { 0, -10 } }, &w);
    plumb_material_desc got;
    plumb_material m =
        plumb_material_create(w, &(plumb_material_desc){ .friction = 0.5f, .polish = 0.5f });
    is("polish: made", plumb_material_settings(w, m, &got) == PLUMB_OK && got.polish == 0.5f);
    is("polish: refused",
       plumb_material_set(w, m, &(plumb_material_desc){ .polish = 2 }) == PLUMB_E_RANGE);
    const plumb_property *p = plumb_property_find(PLUMB_TABLE_MATERIAL, "polish");
    is("polish: listed", p != NULL && p->high == 1 && p->saved);
    // Slides to rest: v^2 / (2 mu g), mu = 0.5 (1 - 0.6).
    scene *s = said("scene{ gravity = {0, -10} } local m = material{ friction = 0.5 } "
                    "local ice = material{ friction = 0.5, polish = 0.6 } "
                    "body{ type = 'static', box{100, 2, at = {0, -1}}, material = ice } "
                    "body{ box{1, 0.2}, at = {0, 0.1}, velocity = {2, 0}, material = m }",
                    "\"polish\":0.6");
    is("polish: said in Lua and JSON", s != NULL);
    run(scene_world(s), 20);
    comes_again("polish: saved, replayed", scene_world(s), 100);
    near("polish: slides to rest", plumb_world_bodies(scene_world(s)).x[0], 1, FIRST_ORDER);
}

//---- kind of joint --------------------------------------------------------------------------------

static void count_line(void *context, plumb_vec2 a, plumb_vec2 b, plumb_color color)
{
    (void)a, (void)b, (void)color;
    ++*(int *)context;
}

static void use_rail(void)
{
    plumb_world *w;
    plumb_world_create(&(plumb_world_desc){ .gravity = { 0, -10 } }, &w);
    plumb_body bead =
        plumb_body_create(w, &(plumb_body_desc){ .mass = 2, .inertia = 1, .angular_velocity = 1 });
    plumb_joint rail = plumb_joint_create(
        w, &(plumb_joint_desc){ .kind = PLUMB_RAIL, .body_b = bead, .axis = { 3, -4 } });
    is("rail: made", plumb_joint_get_kind(w, rail) == PLUMB_RAIL &&
                         strcmp(plumb_joint_kind_name(PLUMB_RAIL), "rail") == 0);
    run(w, 32);
    comes_again("rail: saved, replayed", w, 32);
    const plumb_vec2 at = plumb_body_position(w, bead);
    near("rail: speed", plumb_vec2_magnitude(plumb_body_velocity(w, bead)), 10 * 0.8, 1e-4);
    near("rail: falls along the line", plumb_joint_value(w, rail), 10 * 0.8 / 2, FIRST_ORDER);
    near("rail: stays on the line", 0.8f * at.x + 0.6f * at.y, 0, 1e-4);
    near("rail: turns freely", plumb_body_angular_velocity(w, bead), 1, 1e-5);
    near("rail: bears", plumb_vec2_magnitude(plumb_joint_force(w, rail)), 2 * 10 * 0.6, 1e-3);
    int lines = 0;
    plumb_draw(w, &(plumb_draw_calls){ .line = count_line, .context = &lines },
               &(plumb_draw_desc){ .parts = PLUMB_DRAW_JOINTS });
    is("rail: drawn", lines > 0);
    const plumb_property *p = plumb_property_find(PLUMB_TABLE_JOINT, "kind");
    is("rail: listed", strstr(p->unit, "|rail") != NULL && p->high > PLUMB_RAIL);
    plumb_joint_desc limited = { .kind = PLUMB_RAIL, .body_b = bead, .enable_limit = true };
    is("rail: refused what it has not", plumb_is_null(plumb_joint_create(w, &limited)));

    scene *s = said("scene{ gravity = {0, -10} } body{ name = 'bead', circle{1} } "
                    "rail{ world, 'bead', axis = {3, -4} }",
                    "\"rail\"");
    is("rail: said in Lua and JSON", s != NULL && scene_joint_count(s) == 1);
    run(scene_world(s), 64);
    near("rail: of the scene", plumb_world_bodies(scene_world(s)).y[0], -4 * 0.8, FIRST_ORDER);
    scene_error error;
    is("rail: refused in Lua",
       load("b.lua", "body{ name = 'b', circle{1} } rail{ world, 'b', ratio = 2 }", &error) ==
               NULL &&
           strstr(error.text, "ratio") != NULL && error.line == 1);
}

//---- kind of shape --------------------------------------------------------------------------------

static void use_ellipse(void)
{
    const double half_edge = 3.141592653589793 / 16; // [rad] of the 16 corners
    plumb_world *w = weightless();
    plumb_body b = plumb_body_create(w, &(plumb_body_desc){ .position = { 5, 0 } });
    plumb_shape shape = plumb_shape_create(
        w, b, &(plumb_shape_desc){ .kind = PLUMB_ELLIPSE, .half = { 2, 0.5f }, .density = 3 });
    is("ellipse: made", plumb_shape_get_kind(w, shape) == PLUMB_ELLIPSE);
    near("ellipse: mass", plumb_body_mass(w, b), 3 * 8 * sin(2 * half_edge) * 2 * 0.5, 1e-5);
    plumb_ray_hit hit = { .fraction = 0 };
    is("ellipse: hit by a ray",
       plumb_world_ray(w, (plumb_vec2){ 0, 0 }, (plumb_vec2){ 10, 0 }, NULL, &hit));
    near("ellipse: where", hit.point.x, 5 - 2 * cos(half_edge), 1e-5);
    plumb_shape_desc round = { .kind = PLUMB_ELLIPSE, .half = { 2, 1 }, .radius = 1 };
    is("ellipse: refused what it has not", plumb_is_null(plumb_shape_create(w, b, &round)));
    int lines = 0;
    plumb_draw(w, &(plumb_draw_calls){ .line = count_line, .context = &lines },
               &(plumb_draw_desc){ .parts = PLUMB_DRAW_SHAPES });
    is("ellipse: drawn", lines >= 16);

    scene *s =
        said("scene{ gravity = {0, -10} } body{ type = 'static', box{100, 2, at = {0, -1}} } "
             "body{ ellipse{4, 1}, at = {0, 1} }",
             "\"ellipse\"");
    is("ellipse: said in Lua and JSON", s != NULL);
    run(scene_world(s), 20);
    comes_again("ellipse: saved, replayed", scene_world(s), 100);
    near("ellipse: lies on its edge", plumb_world_bodies(scene_world(s)).y[0], 0.5 * cos(half_edge),
         2e-3);
}

int main(void)
{
    use_tracing();
    use_wind();
    use_edge();
    use_polish();
    use_rail();
    use_ellipse();
    return bad > 0;
}
