// listed.h - public functions that answer with an array of the world's, and how long it is.
#ifndef PL_LISTED_H
#define PL_LISTED_H

// `function`: the `number` of them at `items`; null for none, or without a world. `count` may be null.
#define PL_LISTED(type, function, items, number)                                                   \
    const type *function(const plumb_world *world, int *count)                                     \
    {                                                                                              \
        const int listed = world == NULL ? 0 : (int)(number);                                      \
        if (count != NULL) {                                                                       \
            *count = listed;                                                                       \
        }                                                                                          \
        return listed == 0 ? NULL : (const type *)(items);                                         \
    }

#endif
