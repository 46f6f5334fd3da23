// json_write.c - the state of a scene as canonical JSON: sorted keys, bodies in order of making,
// one line each, every number the shortest that reads back to the same bits. What a construct may
// say comes from its list; where the world has moved on (places, velocities, gravity) the world's
// value is written. Handlers, exact{}, test functions and user tables are not state that JSON can
// hold, nor are the impulses with which contacts warm start.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"

/// Where it goes.
typedef struct writer {
    const scene *s;
    FILE *file;
    bool first; ///< no comma before the next member
} writer;

/// Where the numbers of a construct come from.
typedef struct origin {
    bool is_state; ///< the world, as reals; else the author, whose numbers fit both precisions
    const sc_body *body; ///< the body that is being written: its shapes are not in its definition
    const plumb_softbody_desc *soft; ///< the soft body
} origin;

static const origin as_said = { .is_state = false };

// The shortest text that reads back to the same bits (of a plumb_real, or of a double).
static void shortest(char *text, size_t size, double v, bool is_real)
{
    const double plain = 1e15; // integers below are written without an exponent
    if (v == floor(v) && fabs(v) < plain) {
        snprintf(text, size, "%.0f", v);
        return;
    }
    for (int digits = 1; digits <= 17; digits++) {
        snprintf(text, size, "%.*g", digits, v);
        double back = strtod(text, NULL);
        if (back == v || (is_real && (plumb_real)back == (plumb_real)v)) {
            return;
        }
    }
}

static void write_number(writer *w, double v, bool is_real)
{
    char text[40];
    if (!isfinite(v)) { // a world that has diverged: no JSON number
        fputs("null", w->file);
        return;
    }
    shortest(text, sizeof text, v, is_real);
    fputs(text, w->file);
}

// The double that stands for a real when an author writes it: -9.81, not -9.8100004196167.
static double as_written(plumb_real v)
{
    char text[40];
    shortest(text, sizeof text, (double)v, true);
    return strtod(text, NULL);
}

static void write_string(writer *w, const char *text)
{
    fputc('"', w->file);
    for (const unsigned char *p = (const unsigned char *)text; *p != 0; p++) {
        if (*p == '"' || *p == '\\') {
            fprintf(w->file, "\\%c", *p);
        } else if (*p < 0x20) {
            fprintf(w->file, "\\u%04x", *p);
        } else {
            fputc(*p, w->file);
        }
    }
    fputc('"', w->file);
}

static void write_pair(writer *w, const double v[2], bool is_real)
{
    fputc('[', w->file);
    write_number(w, v[0], is_real);
    fputc(',', w->file);
    write_number(w, v[1], is_real);
    fputc(']', w->file);
}

static void write_key(writer *w, const char *name)
{
    if (!w->first) {
        fputc(',', w->file);
    }
    w->first = false;
    write_string(w, name);
    fputc(':', w->file);
}

static void write_choice(writer *w, const char *choices, int number)
{
    const char *p = choices;
    for (; number > 0; number--) {
        p += strcspn(p, "|") + 1;
    }
    fprintf(w->file, "\"%.*s\"", (int)strcspn(p, "|"), p);
}

static void write_points(writer *w, const sc_shape_def *d)
{
    fputc('[', w->file);
    for (int i = 0; i < d->point_count; i++) {
        fputs(i > 0 ? "," : "", w->file);
        write_pair(w, d->points[i], false);
    }
    fputc(']', w->file);
}

static void write_color(writer *w, const sc_color *c)
{
    if (c->palette >= 0) {
        fprintf(w->file, "%d", c->palette);
    } else {
        fprintf(w->file, "\"#%02x%02x%02x\"", c->rgba.r, c->rgba.g, c->rgba.b);
    }
}

static void write_axes(writer *w, int axes)
{
    static const char *const names[] = { "x", "y", "rotation" };
    bool any = false;
    fputc('[', w->file);
    for (int i = 0; i < 3; i++) {
        if ((axes & sc_axis_bit(names[i])) != 0) {
            fprintf(w->file, "%s\"%s\"", any ? "," : "", names[i]);
            any = true;
        }
    }
    fputc(']', w->file);
}

static bool has_json_form(const sc_field *row)
{
    return row->kind != SC_FUNCTION && (row->kind != SC_TABLE || strcmp(row->name, "user") != 0);
}

static void write_shapes(writer *w, const sc_body *b);
static void write_object(writer *w, const sc_list *list, const void *def, const char *kind,
                         const origin *from);

// Categories by name, in the order of names.
static void write_names(writer *w, uint64_t bits)
{
    const char *last = "";
    fputc('[', w->file);
    for (uint64_t left = bits; left != 0;) {
        int next = -1;
        for (int i = 0; i < w->s->categories.count; i++) {
            const char *name = w->s->categories.items[i].name;
            if ((bits >> i & 1) != 0 && strcmp(name, last) > 0 &&
                (next < 0 || strcmp(name, w->s->categories.items[next].name) < 0)) {
                next = i;
            }
        }
        fputs(last[0] != 0 ? "," : "", w->file);
        last = w->s->categories.items[next].name;
        write_string(w, last);
        left &= ~((uint64_t)1 << next);
    }
    fputc(']', w->file);
}

static void write_numbers(writer *w, const double *numbers, size_t count, bool is_real)
{
    fputc('[', w->file);
    for (size_t i = 0; i < count; i++) {
        fputs(i > 0 ? "," : "", w->file);
        write_number(w, numbers[i], is_real);
    }
    fputc(']', w->file);
}

// A particle a line: place, velocity, gradient.
static void write_particles(writer *w)
{
    int count;
    const plumb_particle *p = plumb_liquid_particles(w->s->world, &count);
    fputc('[', w->file);
    for (int i = 0; i < count; i++) {
        const double numbers[8] = { (double)p[i].position.x,  (double)p[i].position.y,
                                    (double)p[i].velocity.x,  (double)p[i].velocity.y,
                                    (double)p[i].gradient[0], (double)p[i].gradient[1],
                                    (double)p[i].gradient[2], (double)p[i].gradient[3] };
        fputs(i > 0 ? ",\n" : "\n", w->file);
        write_numbers(w, numbers, 8, true);
    }
    fputs("\n]", w->file);
}

// A cell a line: velocities, smoke, heat, room.
static void write_cells(writer *w)
{
    plumb_air_box box;
    plumb_air_cells(w->s->world, &box);
    const int count = (box.columns + 1) * (box.rows + 1);
    fputc('[', w->file);
    for (int i = 0; i < count; i++) {
        const double numbers[5] = { (double)box.at[i].u, (double)box.at[i].v,
                                    (double)box.at[i].smoke, (double)box.at[i].heat,
                                    (double)box.at[i].room };
        fputs(i > 0 ? ",\n" : "\n", w->file);
        write_numbers(w, numbers, 5, true);
    }
    fputs("\n]", w->file);
}

static const char *name_of(const scene *s, plumb_body body)
{
    const sc_body *b = sc_body_of(s, body);
    return b != NULL ? b->def.name : "world";
}

// A row a line, in the order in which softbody.c takes them.
static void write_soft_rows(writer *w, const char *what, const plumb_softbody_desc *d)
{
    const bool nodes = strcmp(what, "nodes") == 0, edges = strcmp(what, "edges") == 0;
    const bool bends = strcmp(what, "bends") == 0, triangles = strcmp(what, "triangles") == 0;
    const int count = nodes       ? d->node_count
                      : edges     ? d->edge_count
                      : bends     ? d->bend_count
                      : triangles ? d->triangle_count
                                  : d->ring_count;
    fputc('[', w->file);
    for (int i = 0; i < count; i++) {
        fputs(i > 0 ? ",\n" : "\n", w->file);
        if (nodes) {
            const plumb_softbody_node *n = &d->nodes[i];
            const double v[] = { (double)n->position.x, (double)n->position.y,
                                 (double)n->velocity.x, (double)n->velocity.y,
                                 (double)n->mass,       (double)n->radius };
            write_numbers(w, v, 6, true);
        } else if (edges) {
            const plumb_softbody_edge *e = &d->edges[i];
            const double v[] = { e->a + 1.0,
                                 e->b + 1.0,
                                 (double)e->length,
                                 (double)e->stiffness,
                                 (double)e->damping,
                                 (double)e->break_strain,
                                 (double)e->yield_strain,
                                 e->flags & (PLUMB_EDGE_PULLS | PLUMB_EDGE_TORN) };
            write_numbers(w, v, 8, true);
        } else if (bends) {
            const plumb_softbody_bend *b = &d->bends[i];
            const double v[] = { b->a + 1.0,           b->b + 1.0,        b->c + 1.0,
                                 (double)b->stiffness, (double)b->length, (double)b->angle };
            write_numbers(w, v, 6, true);
        } else if (triangles) {
            const plumb_softbody_triangle *t = &d->triangles[i];
            const double v[] = { t->a + 1.0,       t->b + 1.0,         t->c + 1.0,
                                 (double)t->young, (double)t->poisson, (double)t->damping,
                                 (double)t->ab.x,  (double)t->ab.y,    (double)t->ac.x,
                                 (double)t->ac.y };
            write_numbers(w, v, 10, true);
        } else {
            write_numbers(w, (const double[]){ d->ring[i] + 1.0 }, 1, true);
        }
    }
    fputs("\n]", w->file);
}

static void write_pins(writer *w, const plumb_softbody_desc *d)
{
    fputc('[', w->file);
    for (int i = 0; i < d->pin_count; i++) {
        const plumb_softbody_pin *p = &d->pins[i];
        fprintf(w->file, "%s[%u,", i > 0 ? ",\n" : "\n", (unsigned)p->node + 1);
        write_number(w, (double)p->point.x, true);
        fputc(',', w->file);
        write_number(w, (double)p->point.y, true);
        if (!plumb_is_null(p->body)) {
            fputc(',', w->file);
            write_string(w, name_of(w->s, p->body));
        }
        fputc(']', w->file);
    }
    fputs("\n]", w->file);
}

static void write_value(writer *w, const sc_field *row, const void *def, const origin *from)
{
    const void *member = (const char *)def + row->offset;
    const double *numbers = member;
    bool is_real = from->is_state;
    switch (row->kind) {
    case SC_NUMBER:
    case SC_INTEGER:
        write_number(w, numbers[0], is_real);
        break;
    case SC_BOOL:
        fputs(*(const bool *)member ? "true" : "false", w->file);
        break;
    case SC_STRING:
    case SC_BODY:
    case SC_JOINT:
        write_string(w, member);
        break;
    case SC_VEC2:
    case SC_LIMITS:
        write_pair(w, numbers, is_real);
        break;
    case SC_NUMBERS:
        write_numbers(w, numbers, row->size / sizeof *numbers, is_real);
        break;
    case SC_NAMES:
        write_names(w, *(const uint64_t *)member);
        break;
    case SC_END:
        write_string(w, name_of(w->s, ((const sc_end *)member)->body));
        break;
    case SC_RECORD:
        write_object(w, sc_list_named(row->detail), member, NULL, from);
        break;
    case SC_CHOICE:
        write_choice(w, row->detail, *(const int *)member);
        break;
    case SC_RANGE:
        if (numbers[0] == numbers[1]) {
            write_number(w, numbers[0], false);
        } else {
            write_pair(w, numbers, false);
        }
        break;
    case SC_COLOR:
        write_color(w, member);
        break;
    case SC_MATERIAL:
        write_string(w, (*(sc_material *const *)member)->id);
        break;
    case SC_POINTS:
        write_points(w, def);
        break;
    case SC_SHAPES:
        write_shapes(w, from->body);
        break;
    case SC_AXES:
        write_axes(w, *(const int *)member);
        break;
    case SC_BOX:
        fputc('[', w->file);
        write_pair(w, numbers, false);
        fputc(',', w->file);
        write_pair(w, numbers + 2, false);
        fputc(']', w->file);
        break;
    case SC_TABLE:
        if (from->soft != NULL && strcmp(row->name, "pins") == 0) {
            write_pins(w, from->soft);
        } else if (from->soft != NULL) {
            write_soft_rows(w, row->name, from->soft);
        } else if (strcmp(row->name, "cells") == 0) {
            write_cells(w);
        } else {
            write_particles(w); // no other table has a JSON form
        }
        break;
    case SC_FUNCTION:
        break;
    }
}

// Rows of a list in the order of their names.
static void sort_rows(const sc_list *list, const sc_field *sorted[SC_ROWS_MOST])
{
    for (int i = 0; i < list->count; i++) {
        int k = i;
        for (; k > 0 && strcmp(sorted[k - 1]->name, list->rows[i].name) > 0; k--) {
            sorted[k] = sorted[k - 1];
        }
        sorted[k] = &list->rows[i];
    }
}

// {"a":1,...}: the given fields of a construct; `kind` (may be null) is woven in at its place.
static void write_object(writer *w, const sc_list *list, const void *def, const char *kind,
                         const origin *from)
{
    const sc_field *sorted[SC_ROWS_MOST];
    uint64_t present;
    memcpy(&present, def, sizeof present);
    sort_rows(list, sorted);
    fputc('{', w->file);
    w->first = true;
    for (int i = 0; i < list->count; i++) {
        const sc_field *row = sorted[i];
        if (kind != NULL && strcmp(row->name, "kind") > 0) {
            write_key(w, "kind");
            write_string(w, kind);
            kind = NULL;
        }
        if ((present >> (row - list->rows) & 1) != 0 && has_json_form(row)) {
            write_key(w, row->name);
            write_value(w, row, def, from);
        }
    }
    if (kind != NULL) {
        write_key(w, "kind");
        write_string(w, kind);
    }
    fputc('}', w->file);
    w->first = false;
}

static void write_shapes(writer *w, const sc_body *b)
{
    fputc('[', w->file);
    for (int i = 0; i < b->def.shape_count; i++) {
        sc_shape_def d = b->shapes[i];
        const sc_list *list = &sc_list_shapes[d.kind];
        fputs(i > 0 ? "," : "", w->file);
        write_object(w, list, &d, list->name, &as_said);
    }
    fputc(']', w->file);
}

static void write_body(const scene *s, writer *w, const sc_body *b)
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
    uint64_t hidden = 0;
    for (int i = 0; i < list->count; i++) {
        const char *row = list->rows[i].name;
        // A body that is dynamic no more keeps what it was told, but cannot say it.
        bool cannot = d.type != 0 && sc_motion_is_dynamic(row);
        hidden |= cannot || strcmp(row, "angle_deg") == 0 ? (uint64_t)1 << i : 0;
    }
    d.present &= ~hidden;
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
    write_object(w, list, &d, NULL, &(origin){ .is_state = true, .body = b });
}

static void write_settings(const scene *s, writer *w)
{
    sc_settings d = s->settings;
    plumb_vec2 g = plumb_world_gravity(s->world);
    d.gravity[0] = as_written(g.x);
    d.gravity[1] = as_written(g.y);
    d.dt = s->dt;
    d.duration = s->duration;
    if (d.title[0] == 0) {
        snprintf(d.title, sizeof d.title, "%s", s->title);
    }
    SC_GIVE(&sc_list_scene, &d, sc_settings, gravity);
    SC_GIVE(&sc_list_scene, &d, sc_settings, dt);
    SC_GIVE(&sc_list_scene, &d, sc_settings, duration);
    SC_GIVE(&sc_list_scene, &d, sc_settings, title);
    write_object(w, &sc_list_scene, &d, NULL, &as_said);
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

static void write_expects(const scene *s, writer *w)
{
    bool any = false;
    for (int i = 0; i < s->expects.count; i++) {
        if (is_open(s, &s->expects.items[i].def)) {
            fputs(any ? ",\n" : "\"expect\":[\n", w->file);
            write_object(w, &sc_list_expect, &s->expects.items[i].def, NULL, &as_said);
            any = true;
        }
    }
    fputs(any ? "\n],\n" : "", w->file);
}

static void write_excluded(writer *w)
{
    const scene *s = w->s;
    for (int i = 0; i < s->excluded.count; i++) {
        const sc_excluded *e = &s->excluded.items[i];
        fputs(i > 0 ? "," : "\"excluded\":[", w->file);
        fputc('[', w->file);
        write_string(w, name_of(s, e->a));
        fputc(',', w->file);
        write_string(w, name_of(s, e->b));
        fputc(']', w->file);
    }
    fputs(s->excluded.count > 0 ? "],\n" : "", w->file);
}

static void write_joints(writer *w)
{
    const scene *s = w->s;
    for (int i = 0; i < s->joints.count; i++) {
        sc_joint_def d = sc_joint_now(s, s->joints.items[i]);
        const sc_list *list = &sc_list_joints[d.kind];
        fputs(i > 0 ? ",\n" : "\"joints\":[\n", w->file);
        write_object(w, list, &d, list->name, &(origin){ .is_state = true });
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

static void write_materials(writer *w)
{
    const scene *s = w->s;
    fputs("\"materials\":[\n", w->file);
    for (int i = 0; i < s->materials.count; i++) {
        sc_material_def d = s->materials.items[i]->def;
        snprintf(d.name, sizeof d.name, "%s", s->materials.items[i]->id);
        SC_GIVE(&sc_list_material, &d, sc_material_def, name);
        PL_MATERIAL_ROWS(GIVE_DEFAULT, )
        fputs(i > 0 ? ",\n" : "", w->file);
        write_object(w, &sc_list_material, &d, NULL, &as_said);
    }
    fputs("\n],\n", w->file);
    for (int i = 0; i < s->pairs.count; i++) {
        fputs(i > 0 ? ",\n" : "\"pairs\":[\n", w->file);
        write_object(w, &sc_list_pair, &s->pairs.items[i], NULL, &as_said);
    }
    fputs(s->pairs.count > 0 ? "\n],\n" : "", w->file);
}

// As it is now: shapes and velocity that particles were made with are told by these.
static void write_liquid(writer *w)
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
    SC_MARK(list, &d, sc_liquid_def, particles, count > 0);
    fputs("\"liquid\":", w->file);
    write_object(w, list, &d, NULL, &as_said);
    fputs(",\n", w->file);
}

// As it is now.
static void write_air(writer *w)
{
    sc_air_def d = w->s->air;
    plumb_air_box box;
    if (w->s->air_line == 0 || plumb_air_cells(w->s->world, &box) != PLUMB_OK) {
        return;
    }
    SC_MARK(&sc_list_air, &d, sc_air_def, cells, true);
    fputs("\"air\":", w->file);
    write_object(w, &sc_list_air, &d, NULL, &as_said);
    fputs(",\n", w->file);
}

// As it is now: node by node.
static void write_softbody(writer *w, const sc_softbody *b)
{
    const sc_list *list = &sc_list_softbodies[SC_SOFTBODY], *own = &sc_list_softbodies[b->kind];
    sc_softbody_def d = b->def;
    plumb_softbody_desc now;
    plumb_softbody_get(w->s->world, b->handle, &now);
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
    write_object(w, list, &d, NULL, &(origin){ .is_state = true, .soft = &now });
}

static void write_softbodies(writer *w)
{
    const scene *s = w->s;
    for (int i = 0; i < s->softbodies.count; i++) {
        fputs(i > 0 ? ",\n" : "\"softbodies\":[\n", w->file);
        write_softbody(w, &s->softbodies.items[i]);
    }
    fputs(s->softbodies.count > 0 ? "\n],\n" : "", w->file);
}

static void write_sources(writer *w)
{
    const scene *s = w->s;
    bool any = false;
    for (int i = 0; i < s->sources.count; i++) {
        const sc_source_def *d = &s->sources.items[i].def;
        if (d->body[0] == 0 || sc_body_named(s, d->body) != NULL) {
            fputs(any ? ",\n" : "\"sources\":[\n", w->file);
            write_object(w, &sc_list_source, d, NULL, &as_said);
            any = true;
        }
    }
    fputs(any ? "\n],\n" : "", w->file);
}

static void write_laws(writer *w)
{
    const scene *s = w->s;
    bool any = false;
    for (int i = 0; i < s->laws.count; i++) {
        const sc_law *law = &s->laws.items[i];
        if (plumb_entity_alive(s->world, law->handle.entity)) {
            fputs(any ? ",\n" : "\"laws\":[\n", w->file);
            const sc_list *list = &sc_list_laws[law->def.kind];
            write_object(w, list, &law->def, list->name, &as_said);
            any = true;
        }
    }
    fputs(any ? "\n],\n" : "", w->file);
}

bool scene_to_json(const scene *s, FILE *file)
{
    writer w = { .s = s, .file = file };
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
        write_object(&w, &sc_list_camera, &s->camera, NULL, &as_said);
        fputs(",\n", file);
    }
    write_excluded(&w);
    write_expects(s, &w);
    fputs("\"format\":\"plumb-scene-1\",\n", file);
    write_joints(&w);
    write_laws(&w);
    write_liquid(&w);
    write_materials(&w);
    if (s->orbits.present != 0) {
        fputs("\"orbits\":", file);
        write_object(&w, &sc_list_orbits, &s->orbits, NULL, &as_said);
        fputs(",\n", file);
    }
    fputs("\"scene\":", file);
    write_settings(s, &w);
    fputs(",\n", file);
    write_softbodies(&w);
    write_sources(&w);
    fputs("\"time\":", file);
    write_number(&w, scene_time(s), false);
    fputs("}\n", file);
    return ferror(file) == 0;
}
