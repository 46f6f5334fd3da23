/// lists.h - ranges and shorthands of the files that hold lists of keys.
#ifndef SCENE_LISTS_H
#define SCENE_LISTS_H

#include "internal.h"

#define FAR  1e9  // [m] plumb_body_desc.position
#define BIG  1e12 // speeds, angles, masses: anything finite that float holds squared
#define SIZE 1e7  // [m] PLUMB_LENGTH_MAX
#define TINY 1e-4 // [m] PLUMB_LENGTH_MIN

#define AT(type, member) offsetof(type, member), sizeof(((type *)0)->member)
#define COUNT(rows)      (int)(sizeof(rows) / sizeof *(rows))

#endif
