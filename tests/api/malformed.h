/// malformed.h - a table of malformed scenes, each with the exact code and message that it must give.
#ifndef TESTS_MALFORMED_H
#define TESTS_MALFORMED_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

#include "scene/scene.h"

/// One malformed scene.
typedef struct malformed {
    const char *what; ///< for the reader of a failure
    const char *file; ///< name given to the text; its ending tells Lua from JSON
    const char *text;
    scene_code code;
    const char *message; ///< scene_error.text
    const char *set;     ///< a --set, or null
} malformed;

/// Every scene is loaded with small limits, so that those of them that never end do so soon.
static inline void check_malformed(const malformed *table, int count)
{
    int wrong = 0;
    for (int i = 0; i < count; i++) {
        const malformed *m = &table[i];
        scene_options options = { .path = m->file,
                                  .text = m->text,
                                  .text_size = strlen(m->text),
                                  .sets = &m->set,
                                  .set_count = m->set != NULL,
                                  .memory_limit = (size_t)128 << 20,
                                  .build_instructions = 5000000 };
        scene *s = (scene *)&options; // anything but null
        scene_error e;
        scene_code code = scene_load(&options, &s, &e);
        bool right =
            code == m->code && e.code == code && s == NULL && strcmp(e.text, m->message) == 0;
        if (!right) {
            printf("%s\n  expected %d %s\n  got      %d %s\n", m->what, m->code, m->message, code,
                   e.text);
            wrong++;
        }
        scene_destroy(s);
    }
    assert_int_equal(wrong, 0);
}

#endif
