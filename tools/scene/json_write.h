// json_write.h - a scene as JSON: what is written, where to, and where its numbers come from.
#ifndef PL_SCENE_JSON_WRITE_H
#define PL_SCENE_JSON_WRITE_H

#include <stdio.h>

#include "internal.h"

/// Where it goes.
typedef struct sc_json_writer {
    const scene *s;
    FILE *file;
    bool first; ///< no comma before the next member
} sc_json_writer;

/// Where the numbers of a construct come from.
typedef struct sc_json_origin {
    bool is_state; ///< the world, as reals; else the author, whose numbers fit both precisions
    const sc_body *body; ///< the body that is being written: its shapes are not in its definition
    const plumb_softbody_desc *soft; ///< the soft body
    const sc_waves *waves;           ///< the surface
} sc_json_origin;

extern const sc_json_origin sc_json_as_said;

/// null where it is no number.
void sc_json_number(sc_json_writer *w, double v, bool is_real);
void sc_json_string(sc_json_writer *w, const char *text);
/// {"a":1,...}: the given fields of a construct; `kind` (may be null) is woven in at its place.
void sc_json_object(sc_json_writer *w, const sc_list *list, const void *def, const char *kind,
                    const sc_json_origin *from);
/// The double that stands for a real when an author writes it: -9.81, not -9.8100004196167.
double sc_json_as_written(plumb_real v);
const char *sc_json_name_of(const scene *s, plumb_body body);

#endif
