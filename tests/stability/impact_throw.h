// impact_throw.h - one body thrown at another, at random, and an observer who knows of velocities and poses alone:
// is every impact told, once, and nothing else?
//
// An impact is what changes the thrown body's velocity other than gravity does. After each step the observer asks:
//   missed     it was struck and no pair of shapes is told to touch
//   phantom    a touch began of shapes that were clear of one another all the time, and nothing was struck
//   doubled    a touch began that had begun, ended that had not, or ended while its shapes met
//   lingering  a touch goes on of shapes that were apart before the step and did not meet in it
//   mute       a blow faster than the hit speed, of which no hit is told
//   false_hits a hit of a blow slower than that, or of one that was told
//   askew      a begin or hit whose speed is not that of the approach
#ifndef STABILITY_IMPACT_THROW_H
#define STABILITY_IMPACT_THROW_H

#include "plumb/plumb.h"

typedef struct impact_tally {
    long thrown, touches, hits, missed, phantom, doubled, lingering, mute, false_hits, askew;
} impact_tally;

// The throw that follows from this seed; adds what the observer found. `told` is called with one line about
// each thing that is wrong; may be null.
void impact_throw(uint32_t seed, impact_tally *tally, void (*told)(const char *line));

// Things that must not be.
long impact_wrong(const impact_tally *tally);

#endif
