// internal_edges_fixture.h - what the tests of internal edges share: tiles, and what is known of their corners.
#ifndef INTERNAL_EDGES_FIXTURE_H
#define INTERNAL_EDGES_FIXTURE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>
#include "harness/sim.h"
#include "internal_edges/side.h"
#include "internal_edges/neighbour.h"
#include "world/interval.h"
#include "world/state.h"

#define HZ60 (1 / 60.0)

// A falling ball far away wants collision, so that the passes run.
static inline void take_a_step(plumb_world *w)
{
    sim_step(w, HZ60);
}

#endif
