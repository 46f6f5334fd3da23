// result.c - the texts of result codes, expanded from the one list in base.h.
#include "plumb/base.h"

const char *plumb_result_text(plumb_result code)
{
    switch (code) {
#define CASE(name, value, text)                                                                    \
    case PLUMB_##name:                                                                             \
        return text;
        PLUMB_RESULT_LIST(CASE)
#undef CASE
    }
    return "unknown result";
}
