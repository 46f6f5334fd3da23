/// drag.h - what linear drag costs, by each way to have it.
#ifndef BENCH_DRAG_H
#define BENCH_DRAG_H

/// Prints a table: ns a body and step without drag, by a user's own array, by a view over a component, by a user's row of
/// the substep, by the built-in damping; of free bodies and of stacked boxes. `core`: pinned to; -1: to none. 0, or 1 when
/// a world cannot be made.
int drag_report(int core);

#endif
