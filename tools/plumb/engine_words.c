/// engine_words.c - the words of the scene language, from the loader's own lists (lists.c there),
/// so that `plumb list` tells what the loader reads. Compiled once for each precision, as engine.c.
#include "engine_session.h"

#include <string.h>

#include "../scene/internal.h"

/// A run of lists of one topic; `name` (may be null) is told instead of the list's own.
typedef struct word_run {
    const char *topic, *name;
    const sc_list *lists;
    int count;
    plumb_property_table table; ///< which properties keys are; PLUMB_TABLE_COUNT: none
} word_run;

/// Constructors in the order in which an author meets them.
static const word_run runs[] = {
    { "settings", NULL, &sc_list_scene, 1, PLUMB_TABLE_WORLD },
    { "materials", NULL, &sc_list_material, 1, PLUMB_TABLE_MATERIAL },
    { "materials", NULL, &sc_list_pair, 1, PLUMB_TABLE_MATERIAL_PAIR },
    { "bodies", NULL, &sc_list_body, 1, PLUMB_TABLE_BODY },
    { "bodies", "the table 'character' of a body", &sc_list_character, 1, PLUMB_TABLE_COUNT },
    { "shapes", NULL, sc_list_shapes, SC_SHAPE_KINDS, PLUMB_TABLE_COUNT },
    { "joints", NULL, sc_list_joints, SC_JOINT_KINDS, PLUMB_TABLE_JOINT },
    { "joints", "the table 'motor' of a joint", &sc_list_motor, 1, PLUMB_TABLE_COUNT },
    { "joints", "the table 'spring' of a joint", &sc_list_spring, 1, PLUMB_TABLE_COUNT },
    { "camera", NULL, &sc_list_camera, 1, PLUMB_TABLE_COUNT },
    { "events", "on_contact, on_end, on_enter, on_leave, edit_contact", &sc_list_contact, 1,
      PLUMB_TABLE_COUNT },
    { "events", NULL, &sc_list_hit, 1, PLUMB_TABLE_COUNT },
    { "events", "on_shatter, on_gone, on_wet, on_dry", &sc_list_contact, 1, PLUMB_TABLE_COUNT },
    { "events", "on_break, on_strain", &sc_list_break, 1, PLUMB_TABLE_COUNT },
    { "effects", NULL, &sc_list_blast, 1, PLUMB_TABLE_COUNT },
    { "effects", NULL, &sc_list_liquid, 1, PLUMB_TABLE_COUNT },
    { "effects", "tables in 'phases' of liquid{}", &sc_list_phase, 1, PLUMB_TABLE_COUNT },
    { "effects", NULL, &sc_list_air, 1, PLUMB_TABLE_COUNT },
    { "effects", NULL, &sc_list_source, 1, PLUMB_TABLE_COUNT },
    { "effects", NULL, &sc_list_waves, 1, PLUMB_TABLE_COUNT },
    { "effects", NULL, &sc_list_light, 1, PLUMB_TABLE_COUNT },
    { "effects", NULL, sc_list_softbodies, SC_SOFTBODY_KINDS, PLUMB_TABLE_COUNT },
    { "effects", NULL, sc_list_laws, SC_LAW_KINDS, PLUMB_TABLE_COUNT },
    { "effects", NULL, &sc_list_orbits, 1, PLUMB_TABLE_COUNT },
    { "effects", NULL, &sc_list_field, 1, PLUMB_TABLE_COUNT },
    { "queries", NULL, sc_list_queries, SC_QUERIES, PLUMB_TABLE_COUNT },
    { "expectations", NULL, &sc_list_expect, 1, PLUMB_TABLE_COUNT },
    { "expectations", NULL, &sc_list_exact, 1, PLUMB_TABLE_COUNT },
};

static const sc_list *list_at(int index, engine_word *word, plumb_property_table *table)
{
    for (size_t i = 0; index >= 0 && i < sizeof runs / sizeof *runs; i++) {
        const word_run *r = &runs[i];
        if (index < r->count) {
            const sc_list *list = &r->lists[index];
            *word = (engine_word){ .name = r->name != NULL ? r->name : list->name,
                                   .topic = r->topic,
                                   .kind = "",
                                   .unit = "",
                                   .text = "" };
            *table = r->table;
            return list;
        }
        index -= r->count;
    }
    return NULL;
}

static const char *kind_name(sc_kind kind)
{
    switch (kind) {
    case SC_NUMBER:
        return "number";
    case SC_INTEGER:
        return "whole number";
    case SC_BOOL:
        return "true or false";
    case SC_STRING:
        return "text";
    case SC_VEC2:
        return "{x, y}";
    case SC_CHOICE:
        return "one of";
    case SC_RANGE:
        return "number or {min, max}";
    case SC_COLOR:
        return "\"#rrggbb\" or palette number";
    case SC_MATERIAL:
        return "material";
    case SC_POINTS:
        return "list of {x, y}";
    case SC_FUNCTION:
        return "function";
    case SC_BODY:
        return "body or its name";
    case SC_BOX:
        return "{{x, y}, {x, y}}";
    case SC_SHAPES:
        return "shapes";
    case SC_AXES:
        return "list of \"x\", \"y\", \"rotation\"";
    case SC_TABLE:
        return "table";
    case SC_LIMITS:
        return "{lower, upper}";
    case SC_NAMES:
        return "name or list of names";
    case SC_END:
        return "body, its name, or world";
    case SC_JOINT:
        return "joint or its name";
    case SC_RECORD:
        return "table";
    case SC_NUMBERS:
        return "list of numbers";
    }
    return "";
}

static bool is_bounded(sc_kind kind)
{
    return kind == SC_NUMBER || kind == SC_INTEGER || kind == SC_POINTS || kind == SC_VEC2 ||
           kind == SC_RANGE || kind == SC_BOX || kind == SC_LIMITS;
}

static const plumb_property *property_of(plumb_property_table table, const char *word)
{
    int count;
    const plumb_property *rows = plumb_properties(table, &count);
    for (int i = 0; i < count; i++) {
        if (strcmp(rows[i].word, word) == 0) {
            return &rows[i];
        }
    }
    return NULL;
}

bool pl_session_word(int constructor, int key, engine_word *word)
{
    plumb_property_table table;
    const sc_list *list = list_at(constructor, word, &table);
    if (list == NULL || key >= list->count) {
        return false;
    }
    if (key < 0) {
        return true;
    }
    const sc_field *row = &list->rows[key];
    bool has_unit = row->detail != NULL && row->kind != SC_RECORD && strcmp(row->detail, "1") != 0;
    *word = (engine_word){ .name = row->name,
                           .topic = word->topic,
                           .kind = kind_name(row->kind),
                           .unit = has_unit ? row->detail : "",
                           .min = is_bounded(row->kind) ? row->min : 0,
                           .max = is_bounded(row->kind) ? row->max : 0,
                           .position = row->position > 0 ? row->position : 0,
                           .required = (row->flags & SC_REQUIRED) != 0,
                           .above = (row->flags & SC_ABOVE) != 0,
                           .text = "" };
    const plumb_property *property = property_of(table, row->name);
    if (property != NULL) {
        word->initial = property->initial;
        word->text = property->text;
    }
    return true;
}
