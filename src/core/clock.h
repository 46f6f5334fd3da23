// clock.h - the clock behind the timers of passes and systems.
#ifndef PL_CLOCK_H
#define PL_CLOCK_H

// [ns] of a clock that only goes forward.
double pl_now_ns(void);

#endif
