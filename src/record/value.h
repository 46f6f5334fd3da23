// value.h - numbers of the state as text.
#ifndef PL_RECORD_VALUE_H
#define PL_RECORD_VALUE_H

#include "plumb/record.h"

#include "snapshot/section.h"

// Writes the two values of a member into the row; of records of reals, the first that is not alike. They
// are not the same.
void pl_value_texts(plumb_difference *row, const char *a, const char *b, const pl_member *m);

#endif
