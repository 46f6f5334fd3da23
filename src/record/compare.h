// compare.h - what is not alike in two images of worlds with the same components, in a user's terms.
#ifndef PL_RECORD_COMPARE_H
#define PL_RECORD_COMPARE_H

#include "plumb/record.h"
#include "plumb/snapshot.h"

#include "snapshot/image.h"

// Writes up to `capacity` rows, answers how many there are; see plumb_world_compare. `layout` is a
// world with the components of both. Where A has fewer components than B, those are left out; `settings`
// false: settings, gravity and time are, too.
int pl_compare_images(const plumb_world *layout, const pl_image *a, const pl_image *b,
                      bool settings, plumb_difference *rows, int capacity);

#endif
