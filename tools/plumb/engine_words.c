/// engine_words.c - the words of the scene language, from the loader's own lists (lists.c there),
/// so that `plumb list` tells what the loader reads. Compiled once for each precision, as engine.c.
#include "engine_session.h"

#include <string.h>

#include "../scene/internal.h"

/// Constructors in the order in which an author meets them; shapes come after body.
static const sc_list *list_at(int index)
{
    static const sc_list *const before[] = { &sc_list_scene, &sc_list_material, &sc_list_body };
    static const sc_list *const after[] = { &sc_list_camera, &sc_list_contact, &sc_list_expect,
                                            &sc_list_exact, &sc_list_blast };
    const int before_count = 3, after_count = 5;

    if (index < 0 || index >= before_count + SC_SHAPE_KINDS + after_count) {
        return NULL;
    }
    if (index < before_count) {
        return before[index];
    }
    index -= before_count;
    return index < SC_SHAPE_KINDS ? &sc_list_shapes[index] : after[index - SC_SHAPE_KINDS];
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
    }
    return "";
}

bool pl_session_word(int constructor, int key, engine_word *word)
{
    const sc_list *list = list_at(constructor);
    if (list == NULL || key >= list->count) {
        return false;
    }
    if (key < 0) {
        *word = (engine_word){ .name = list->name, .kind = "", .unit = "" };
        return true;
    }
    const sc_field *row = &list->rows[key];
    bool is_bounded = row->kind == SC_NUMBER || row->kind == SC_INTEGER || row->kind == SC_POINTS ||
                      row->kind == SC_VEC2 || row->kind == SC_RANGE || row->kind == SC_BOX;
    *word = (engine_word){ .name = row->name,
                           .kind = kind_name(row->kind),
                           .unit = row->detail != NULL ? row->detail : "",
                           .min = is_bounded ? row->min : 0,
                           .max = is_bounded ? row->max : 0,
                           .position = row->position > 0 ? row->position : 0,
                           .required = (row->flags & SC_REQUIRED) != 0 };
    return true;
}
