// json_value.c - what a construct has, as JSON: a member a row of its list, sorted, every number the shortest that reads back
// to the same bits.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "json_write.h"

const sc_json_origin sc_json_as_said = { .is_state = false };

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

void sc_json_number(sc_json_writer *w, double v, bool is_real)
{
    char text[40];
    if (!isfinite(v)) { // a world that has diverged: no JSON number
        fputs("null", w->file);
        return;
    }
    shortest(text, sizeof text, v, is_real);
    fputs(text, w->file);
}

double sc_json_as_written(plumb_real v)
{
    char text[40];
    shortest(text, sizeof text, (double)v, true);
    return strtod(text, NULL);
}

void sc_json_string(sc_json_writer *w, const char *text)
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

static void write_pair(sc_json_writer *w, const double v[2], bool is_real)
{
    fputc('[', w->file);
    sc_json_number(w, v[0], is_real);
    fputc(',', w->file);
    sc_json_number(w, v[1], is_real);
    fputc(']', w->file);
}

static void write_key(sc_json_writer *w, const char *name)
{
    if (!w->first) {
        fputc(',', w->file);
    }
    w->first = false;
    sc_json_string(w, name);
    fputc(':', w->file);
}

static void write_choice(sc_json_writer *w, const char *choices, int number)
{
    const char *p = choices;
    for (; number > 0; number--) {
        p += strcspn(p, "|") + 1;
    }
    fprintf(w->file, "\"%.*s\"", (int)strcspn(p, "|"), p);
}

static void write_points(sc_json_writer *w, const sc_shape_def *d)
{
    fputc('[', w->file);
    for (int i = 0; i < d->point_count; i++) {
        fputs(i > 0 ? "," : "", w->file);
        write_pair(w, d->points[i], false);
    }
    fputc(']', w->file);
}

static void write_color(sc_json_writer *w, const sc_color *c)
{
    if (c->palette >= 0) {
        fprintf(w->file, "%d", c->palette);
    } else {
        fprintf(w->file, "\"#%02x%02x%02x\"", c->rgba.r, c->rgba.g, c->rgba.b);
    }
}

static void write_axes(sc_json_writer *w, int axes)
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

static void write_shapes(sc_json_writer *w, const sc_body *b);

// Categories by name, in the order of names.
static void write_names(sc_json_writer *w, uint64_t bits)
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
        sc_json_string(w, last);
        left &= ~((uint64_t)1 << next);
    }
    fputc(']', w->file);
}

static void write_numbers(sc_json_writer *w, const double *numbers, size_t count, bool is_real)
{
    fputc('[', w->file);
    for (size_t i = 0; i < count; i++) {
        fputs(i > 0 ? "," : "", w->file);
        sc_json_number(w, numbers[i], is_real);
    }
    fputc(']', w->file);
}

static void write_phases(sc_json_writer *w)
{
    fputc('[', w->file);
    for (int i = 0; i < w->s->phase_count; i++) {
        fputs(i > 0 ? ",\n" : "\n", w->file);
        sc_json_object(w, &sc_list_phase, &w->s->phases[i], NULL, &sc_json_as_said);
    }
    fputs("\n]", w->file);
}

// A particle a line: place, velocity, gradient; of those that have them, phase and tag, and shear stresses behind these.
static void write_particles(sc_json_writer *w)
{
    int count;
    const plumb_particle *p = plumb_liquid_particles(w->s->world, &count);
    fputc('[', w->file);
    for (int i = 0; i < count; i++) {
        const double numbers[12] = { (double)p[i].position.x,
                                     (double)p[i].position.y,
                                     (double)p[i].velocity.x,
                                     (double)p[i].velocity.y,
                                     (double)p[i].gradient[0],
                                     (double)p[i].gradient[1],
                                     (double)p[i].gradient[2],
                                     (double)p[i].gradient[3],
                                     p[i].phase,
                                     p[i].tag,
                                     (double)p[i].shear[0],
                                     (double)p[i].shear[1] };
        const bool bears = p[i].shear[0] != 0 || p[i].shear[1] != 0;
        const int more = bears ? 12 : p[i].phase != 0 || p[i].tag != 0 ? 10 : 8;
        fputs(i > 0 ? ",\n" : "\n", w->file);
        for (int k = 0; k < more; k++) {
            fputc(k > 0 ? ',' : '[', w->file);
            sc_json_number(w, numbers[k], k < 8 || k > 9);
        }
        fputc(']', w->file);
    }
    fputs("\n]", w->file);
}

// A cell a line: velocities, smoke, heat, room.
static void write_cells(sc_json_writer *w)
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

// A mode a line: height, rate.
static void write_modes(sc_json_writer *w, const sc_waves *waves)
{
    int count;
    const plumb_wave_mode *modes = plumb_waves_modes(w->s->world, waves->shape, &count);
    fputc('[', w->file);
    for (int i = 0; i < count; i++) {
        const double numbers[2] = { modes[i].height, modes[i].rate };
        fputs(i > 0 ? ",\n" : "\n", w->file);
        write_numbers(w, numbers, 2, false);
    }
    fputs("\n]", w->file);
}

const char *sc_json_name_of(const scene *s, plumb_body body)
{
    const sc_body *b = sc_body_of(s, body);
    return b != NULL ? b->def.name : "world";
}

// A row a line, in the order in which softbody.c takes them.
static void write_soft_rows(sc_json_writer *w, const char *what, const plumb_softbody_desc *d)
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

static void write_pins(sc_json_writer *w, const plumb_softbody_desc *d)
{
    fputc('[', w->file);
    for (int i = 0; i < d->pin_count; i++) {
        const plumb_softbody_pin *p = &d->pins[i];
        fprintf(w->file, "%s[%u,", i > 0 ? ",\n" : "\n", (unsigned)p->node + 1);
        sc_json_number(w, (double)p->point.x, true);
        fputc(',', w->file);
        sc_json_number(w, (double)p->point.y, true);
        if (!plumb_is_null(p->body)) {
            fputc(',', w->file);
            sc_json_string(w, sc_json_name_of(w->s, p->body));
        }
        fputc(']', w->file);
    }
    fputs("\n]", w->file);
}

static void write_value(sc_json_writer *w, const sc_field *row, const void *def,
                        const sc_json_origin *from)
{
    const void *member = (const char *)def + row->offset;
    const double *numbers = member;
    bool is_real = from->is_state;
    switch (row->kind) {
    case SC_NUMBER:
    case SC_INTEGER:
        sc_json_number(w, numbers[0], is_real);
        break;
    case SC_BOOL:
        fputs(*(const bool *)member ? "true" : "false", w->file);
        break;
    case SC_STRING:
    case SC_BODY:
    case SC_JOINT:
        sc_json_string(w, member);
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
        sc_json_string(w, sc_json_name_of(w->s, ((const sc_end *)member)->body));
        break;
    case SC_RECORD:
        sc_json_object(w, sc_list_named(row->detail), member, NULL, from);
        break;
    case SC_CHOICE:
        write_choice(w, row->detail, *(const int *)member);
        break;
    case SC_RANGE:
        if (numbers[0] == numbers[1]) {
            sc_json_number(w, numbers[0], false);
        } else {
            write_pair(w, numbers, false);
        }
        break;
    case SC_COLOR:
        write_color(w, member);
        break;
    case SC_MATERIAL:
        sc_json_string(w, (*(sc_material *const *)member)->id);
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
        } else if (from->waves != NULL) {
            write_modes(w, from->waves);
        } else if (strcmp(row->name, "cells") == 0) {
            write_cells(w);
        } else if (strcmp(row->name, "phases") == 0) {
            write_phases(w);
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

void sc_json_object(sc_json_writer *w, const sc_list *list, const void *def, const char *kind,
                    const sc_json_origin *from)
{
    const sc_field *sorted[SC_ROWS_MOST];
    sort_rows(list, sorted);
    fputc('{', w->file);
    w->first = true;
    for (int i = 0; i < list->count; i++) {
        const sc_field *row = sorted[i];
        if (kind != NULL && strcmp(row->name, "kind") > 0) {
            write_key(w, "kind");
            sc_json_string(w, kind);
            kind = NULL;
        }
        if (sc_row_given(list, def, (int)(row - list->rows)) && has_json_form(row)) {
            write_key(w, row->name);
            write_value(w, row, def, from);
        }
    }
    if (kind != NULL) {
        write_key(w, "kind");
        sc_json_string(w, kind);
    }
    fputc('}', w->file);
    w->first = false;
}

static void write_shapes(sc_json_writer *w, const sc_body *b)
{
    fputc('[', w->file);
    for (int i = 0; i < b->def.shape_count; i++) {
        sc_shape_def d = b->shapes[i];
        const sc_list *list = &sc_list_shapes[d.kind];
        fputs(i > 0 ? "," : "", w->file);
        sc_json_object(w, list, &d, list->name, &sc_json_as_said);
    }
    fputc(']', w->file);
}
