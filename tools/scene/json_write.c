// json_write.c - the state of a scene as canonical JSON: sorted keys, bodies in order of making, one line each. What a
// construct may say comes from its list (json_value.c); where the world has moved on (places, velocities, gravity) the world's
// value is written. Handlers, exact{}, test functions and user tables are not state that JSON can hold, nor are the
// impulses with which contacts warm start.
#include <stdio.h>
#include <string.h>

#include "json_write.h"

static void write_body(const scene *s, sc_json_writer *w, const sc_body *b)
{
    const sc_list *list = &sc_list_body;
    sc_body_def d = b->def;
    plumb_vec2 p = plumb_body_position(s->world, b->entity);
    plumb_vec2 v = plumb_body_velocity(s->world, b->entity);
    plumb_rot q = plumb_body_transform(s->world, b->entity).q;
    d.at[0] = (double)p.x;
    d.at[1] = (double)p.y;
    if (q.c != b->set_rot.c ||
        q.s != b->set_rot.s) { // else the angle that was given says it exactly
        d.angle = (double)plumb_body_angle(s->world, b->entity);
    }
    d.velocity[0] = (double)v.x;
    d.velocity[1] = (double)v.y;
    d.spin = (double)plumb_body_angular_velocity(s->world, b->entity);
    if (SC_GIVEN(list, &d, sc_body_def, temperature)) {
        d.temperature = (double)plumb_body_temperature(s->world, b->entity);
    }
    for (int i = 0; i < list->count; i++) {
        const char *row = list->rows[i].name;
        // A body that is dynamic no more keeps what it was told, but cannot say it.
        bool cannot = d.type != 0 && sc_motion_is_dynamic(row);
        if (cannot || strcmp(row, "angle_deg") == 0) {
            sc_row_mark(list, &d, i, false);
        }
    }
    SC_GIVE(list, &d, sc_body_def, at);
    SC_GIVE(list, &d, sc_body_def, angle);
    SC_GIVE(list, &d, sc_body_def, name);
    SC_GIVE(list, &d, sc_body_def, type);
    bool asleep = d.type == 0 && !plumb_body_is_awake(s->world, b->entity);
    if (asleep != d.asleep) {
        d.asleep = asleep;
        SC_GIVE(list, &d, sc_body_def, asleep);
    }
    if (d.type != 2) {
        SC_GIVE(list, &d, sc_body_def, velocity);
        SC_GIVE(list, &d, sc_body_def, spin);
    }
    sc_json_object(w, list, &d, NULL, &(sc_json_origin){ .is_state = true, .body = b });
}

static void write_settings(const scene *s, sc_json_writer *w)
{
    sc_settings d = s->settings;
    plumb_vec2 g = plumb_world_gravity(s->world);
    d.gravity[0] = sc_json_as_written(g.x);
    d.gravity[1] = sc_json_as_written(g.y);
    d.dt = s->dt;
    d.duration = s->duration;
    if (d.title[0] == 0) {
        snprintf(d.title, sizeof d.title, "%s", s->title);
    }
    SC_GIVE(&sc_list_scene, &d, sc_settings, gravity);
    SC_GIVE(&sc_list_scene, &d, sc_settings, dt);
    SC_GIVE(&sc_list_scene, &d, sc_settings, duration);
    SC_GIVE(&sc_list_scene, &d, sc_settings, title);
    sc_json_object(w, &sc_list_scene, &d, NULL, &sc_json_as_said);
}

// Lines whose time has passed are results, not state.
static bool is_open(const scene *s, const sc_expect_def *d)
{
    const sc_list *list = &sc_list_expect;
    if (SC_GIVEN(list, d, sc_expect_def, test) || SC_GIVEN(list, d, sc_expect_def, exact)) {
        return false;
    }
    double now = scene_time(s);
    return !(SC_GIVEN(list, d, sc_expect_def, at) && d->at < now + 0.5 * s->dt) &&
           !(SC_GIVEN(list, d, sc_expect_def, till) && d->till < now);
}

static void write_expects(const scene *s, sc_json_writer *w)
{
    bool any = false;
    for (int i = 0; i < s->expects.count; i++) {
        if (is_open(s, &s->expects.items[i].def)) {
            fputs(any ? ",\n" : "\"expect\":[\n", w->file);
            sc_json_object(w, &sc_list_expect, &s->expects.items[i].def, NULL, &sc_json_as_said);
            any = true;
        }
    }
    fputs(any ? "\n],\n" : "", w->file);
}

static void write_excluded(sc_json_writer *w)
{
    const scene *s = w->s;
    for (int i = 0; i < s->excluded.count; i++) {
        const sc_excluded *e = &s->excluded.items[i];
        fputs(i > 0 ? "," : "\"excluded\":[", w->file);
        fputc('[', w->file);
        sc_json_string(w, sc_json_name_of(s, e->a));
        fputc(',', w->file);
        sc_json_string(w, sc_json_name_of(s, e->b));
        fputc(']', w->file);
    }
    fputs(s->excluded.count > 0 ? "],\n" : "", w->file);
}

static void write_joints(sc_json_writer *w)
{
    const scene *s = w->s;
    for (int i = 0; i < s->joints.count; i++) {
        sc_joint_def d = sc_joint_now(s, s->joints.items[i]);
        const sc_list *list = &sc_list_joints[d.kind];
        fputs(i > 0 ? ",\n" : "\"joints\":[\n", w->file);
        sc_json_object(w, list, &d, list->name, &(sc_json_origin){ .is_state = true });
    }
    fputs(s->joints.count > 0 ? "\n],\n" : "", w->file);
}

// A default that is not 0 is written out.
#define GIVE_DEFAULT(X, store, kind, name, word, unit, range, initial, ...)                        \
    PL_CALL(GIVE_DEFAULT_OF, initial, PL_WORD_##word)
#define GIVE_DEFAULT_OF(initial, how, word)                                                        \
    if ((initial) != 0) {                                                                          \
        SC_GIVE(&sc_list_material, &d, sc_material_def, word);                                     \
    }

static void write_materials(sc_json_writer *w)
{
    const scene *s = w->s;
    fputs("\"materials\":[\n", w->file);
    for (int i = 0; i < s->materials.count; i++) {
        sc_material_def d = s->materials.items[i]->def;
        snprintf(d.name, sizeof d.name, "%s", s->materials.items[i]->id);
        SC_GIVE(&sc_list_material, &d, sc_material_def, name);
        PL_MATERIAL_ROWS(GIVE_DEFAULT, )
        fputs(i > 0 ? ",\n" : "", w->file);
        sc_json_object(w, &sc_list_material, &d, NULL, &sc_json_as_said);
    }
    fputs("\n],\n", w->file);
    for (int i = 0; i < s->pairs.count; i++) {
        fputs(i > 0 ? ",\n" : "\"pairs\":[\n", w->file);
        sc_json_object(w, &sc_list_pair, &s->pairs.items[i], NULL, &sc_json_as_said);
    }
    fputs(s->pairs.count > 0 ? "\n],\n" : "", w->file);
}

// As it is now: shapes and velocity that particles were made with are told by these.
static void write_liquid(sc_json_writer *w)
{
    const sc_list *list = &sc_list_liquid;
    sc_liquid_def d = w->s->liquid;
    int count;
    plumb_liquid_particles(w->s->world, &count);
    if (d.present == 0 && count == 0 && w->s->liquid_line == 0) {
        return;
    }
    SC_MARK(list, &d, sc_liquid_def, shape_count, false);
    SC_MARK(list, &d, sc_liquid_def, velocity, false);
    SC_MARK(list, &d, sc_liquid_def, refill, false);
    SC_MARK(list, &d, sc_liquid_def, phase, false);
    SC_MARK(list, &d, sc_liquid_def, dye, false);
    SC_MARK(list, &d, sc_liquid_def, particles, count > 0);
    fputs("\"liquid\":", w->file);
    sc_json_object(w, list, &d, NULL, &sc_json_as_said);
    fputs(",\n", w->file);
}

// As it is now.
static void write_air(sc_json_writer *w)
{
    sc_air_def d = w->s->air;
    plumb_air_box box;
    if (w->s->air_line == 0 || plumb_air_cells(w->s->world, &box) != PLUMB_OK) {
        return;
    }
    SC_MARK(&sc_list_air, &d, sc_air_def, cells, true);
    fputs("\"air\":", w->file);
    sc_json_object(w, &sc_list_air, &d, NULL, &sc_json_as_said);
    fputs(",\n", w->file);
}

// As it is now: node by node.
static void write_softbody(sc_json_writer *w, const sc_softbody *b)
{
    const sc_list *list = &sc_list_softbodies[SC_SOFTBODY], *own = &sc_list_softbodies[b->kind];
    sc_softbody_def d = b->def;
    plumb_softbody_desc now;
    plumb_softbody_settings(w->s->world, b->handle, &now);
    d.present = 0;
#define KEEP(member)                                                                               \
    SC_MARK(list, &d, sc_softbody_def, member, SC_GIVEN(own, &b->def, sc_softbody_def, member))
    KEEP(color);
    KEEP(filter.category);
    KEEP(filter.collides);
    KEEP(filter.ignores);
#undef KEEP
    d.friction = (double)now.friction;
    d.drag = (double)now.damping;
    d.pressure = (double)now.pressure;
    d.ambient = (double)now.ambient;
    d.area = (double)now.area;
    d.sleep = !now.no_sleep;
    d.asleep = now.asleep;
    SC_GIVE(list, &d, sc_softbody_def, friction);
    SC_GIVE(list, &d, sc_softbody_def, drag);
    SC_GIVE(list, &d, sc_softbody_def, nodes);
    SC_MARK(list, &d, sc_softbody_def, edges, now.edge_count > 0);
    SC_MARK(list, &d, sc_softbody_def, bends, now.bend_count > 0);
    SC_MARK(list, &d, sc_softbody_def, triangles, now.triangle_count > 0);
    SC_MARK(list, &d, sc_softbody_def, pins, now.pin_count > 0);
    SC_MARK(list, &d, sc_softbody_def, ring, now.ring_count > 0);
    SC_MARK(list, &d, sc_softbody_def, pressure, now.ring_count > 0);
    SC_MARK(list, &d, sc_softbody_def, ambient, now.ring_count > 0);
    SC_MARK(list, &d, sc_softbody_def, area, now.ring_count > 0);
    SC_MARK(list, &d, sc_softbody_def, sleep, now.no_sleep);
    SC_MARK(list, &d, sc_softbody_def, asleep, now.asleep);
    sc_json_object(w, list, &d, NULL, &(sc_json_origin){ .is_state = true, .soft = &now });
}

static void write_softbodies(sc_json_writer *w)
{
    const scene *s = w->s;
    for (int i = 0; i < s->softbodies.count; i++) {
        fputs(i > 0 ? ",\n" : "\"softbodies\":[\n", w->file);
        write_softbody(w, &s->softbodies.items[i]);
    }
    fputs(s->softbodies.count > 0 ? "\n],\n" : "", w->file);
}

static void write_sources(sc_json_writer *w)
{
    const scene *s = w->s;
    bool any = false;
    for (int i = 0; i < s->sources.count; i++) {
        const sc_source_def *d = &s->sources.items[i].def;
        if (d->body[0] == 0 || sc_body_named(s, d->body) != NULL) {
            fputs(any ? ",\n" : "\"sources\":[\n", w->file);
            sc_json_object(w, &sc_list_source, d, NULL, &sc_json_as_said);
            any = true;
        }
    }
    fputs(any ? "\n],\n" : "", w->file);
}

static void write_laws(sc_json_writer *w)
{
    const scene *s = w->s;
    bool any = false;
    for (int i = 0; i < s->laws.count; i++) {
        const sc_law *law = &s->laws.items[i];
        if (plumb_entity_alive(s->world, law->handle.entity)) {
            fputs(any ? ",\n" : "\"laws\":[\n", w->file);
            const sc_list *list = &sc_list_laws[law->def.kind];
            sc_json_object(w, list, &law->def, list->name, &sc_json_as_said);
            any = true;
        }
    }
    fputs(any ? "\n],\n" : "", w->file);
}

static void write_lights(sc_json_writer *w)
{
    const scene *s = w->s;
    bool any = false;
    for (int i = 0; i < s->lights.count; i++) {
        const sc_light_def *d = &s->lights.items[i].def;
        if (d->body[0] == 0 || sc_body_named(s, d->body) != NULL) {
            fputs(any ? ",\n" : "\"lights\":[\n", w->file);
            sc_json_object(w, &sc_list_light, d, NULL, &sc_json_as_said);
            any = true;
        }
    }
    fputs(any ? "\n],\n" : "", w->file);
}

// As they are now: mode by mode.
static void write_waves(sc_json_writer *w)
{
    const scene *s = w->s;
    bool any = false;
    for (int i = 0; i < s->waves.count; i++) {
        const sc_waves *waves = &s->waves.items[i];
        sc_waves_def d = waves->def;
        if (plumb_waves_modes(s->world, waves->shape, NULL) != NULL) {
            fputs(any ? ",\n" : ",\n\"waves\":[\n", w->file);
            SC_MARK(&sc_list_waves, &d, sc_waves_def, state, true);
            sc_json_object(w, &sc_list_waves, &d, NULL, &(sc_json_origin){ .waves = waves });
            any = true;
        }
    }
    fputs(any ? "\n]" : "", w->file);
}

bool scene_to_json(const scene *s, FILE *file)
{
    sc_json_writer w = { .s = s, .file = file };
    fputc('{', file);
    write_air(&w);
    fputs("\"bodies\":[\n", file);
    for (int i = 0; i < s->bodies.count; i++) {
        fputs(i > 0 ? ",\n" : "", file);
        write_body(s, &w, s->bodies.items[i]);
    }
    fputs("\n],\n", file);
    if (s->camera.present != 0) {
        fputs("\"camera\":", file);
        sc_json_object(&w, &sc_list_camera, &s->camera, NULL, &sc_json_as_said);
        fputs(",\n", file);
    }
    write_excluded(&w);
    write_expects(s, &w);
    fputs("\"format\":\"plumb-scene-1\",\n", file);
    write_joints(&w);
    write_laws(&w);
    write_lights(&w);
    write_liquid(&w);
    write_materials(&w);
    if (s->orbits.present != 0) {
        fputs("\"orbits\":", file);
        sc_json_object(&w, &sc_list_orbits, &s->orbits, NULL, &sc_json_as_said);
        fputs(",\n", file);
    }
    fputs("\"scene\":", file);
    write_settings(s, &w);
    fputs(",\n", file);
    write_softbodies(&w);
    write_sources(&w);
    fputs("\"time\":", file);
    sc_json_number(&w, scene_time(s), false);
    write_waves(&w);
    fputs("}\n", file);
    return ferror(file) == 0;
}
