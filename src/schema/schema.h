// schema.h - the schema for the library's own files.
#ifndef PL_SCHEMA_H
#define PL_SCHEMA_H

#include "plumb/schema.h"

// What the member holds: 0 where the default is meant. Of a vector, along an axis: 0, 1.
double pl_property_member(const plumb_property *property, const void *desc, int axis);

#endif
