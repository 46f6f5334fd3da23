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
} word_run;

/// Constructors in the order in which an author meets them.
static const word_run runs[] = {
    { "settings", NULL, &sc_list_scene, 1 },
    { "materials", NULL, &sc_list_material, 1 },
    { "materials", NULL, &sc_list_pair, 1 },
    { "bodies", NULL, &sc_list_body, 1 },
    { "bodies", "the table 'character' of a body", &sc_list_character, 1 },
    { "shapes", NULL, sc_list_shapes, SC_SHAPE_KINDS },
    { "joints", NULL, sc_list_joints, SC_JOINT_KINDS },
    { "joints", "the table 'motor' of a joint", &sc_list_motor, 1 },
    { "joints", "the table 'spring' of a joint", &sc_list_spring, 1 },
    { "camera", NULL, &sc_list_camera, 1 },
    { "events", "on_contact, on_end, on_enter, on_leave, edit_contact", &sc_list_contact, 1 },
    { "events", NULL, &sc_list_hit, 1 },
    { "events", NULL, &sc_list_break, 1 },
    { "effects", NULL, &sc_list_blast, 1 },
    { "queries", NULL, sc_list_queries, SC_QUERIES },
    { "expectations", NULL, &sc_list_expect, 1 },
    { "expectations", NULL, &sc_list_exact, 1 },
};

static const sc_list *list_at(int index, engine_word *word)
{
    for (size_t i = 0; index >= 0 && i < sizeof runs / sizeof *runs; i++) {
        const word_run *r = &runs[i];
        if (index < r->count) {
            const sc_list *list = &r->lists[index];
            *word = (engine_word){ .name = r->name != NULL ? r->name : list->name,
                                   .topic = r->topic,
                                   .kind = "",
                                   .unit = "" };
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

bool pl_session_word(int constructor, int key, engine_word *word)
{
    const sc_list *list = list_at(constructor, word);
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
                           .required = (row->flags & SC_REQUIRED) != 0 };
    return true;
}
