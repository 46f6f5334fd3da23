// try.h - a refused call ends its caller.
#ifndef PL_TRY_H
#define PL_TRY_H

// Returns what `call` returned, unless it is PLUMB_OK; there must be nothing to give back yet.
#define PL_TRY(call)                                                                               \
    do {                                                                                           \
        const plumb_result tried = (call);                                                         \
        if (tried != PLUMB_OK) {                                                                   \
            return tried;                                                                          \
        }                                                                                          \
    } while (0)

#endif
