// view.c - walks over the rows that have all of some components.
//
// Each component keeps the runs of its values: rows that follow one another and whose values do, too. A
// view steps through the runs of its components together, by rising row, and hands out what they have in
// common: the join by leapfrogging (Veldhuizen 2014), which costs as the shortest list does, times the
// logarithm of what it leaps over in the others.
//
// Reads: owners, registry. Writes: runs, which are scratch. Cost: some 70 instructions a range.
#include "ecs/view.h"

static pl_keyed *runs_of(const pl_component *c)
{
    return c->runs.data;
}

bool pl_view_prepare(pl_memory *memory, pl_component *c, const pl_registry *registry, uint32_t kind)
{
    if (pl_is_seen(c->viewed, c, registry)) {
        return true;
    }
    if (!pl_buffer_reserve(memory, &c->runs, ((size_t)c->count + 1) * sizeof(pl_keyed))) {
        return false;
    }
    const plumb_entity *owners = pl_component_owners(c);
    pl_keyed *last = runs_of(c); // before the first run: of no row
    bool rising = true;
    *last = (pl_keyed){ 0 };
    c->run_count = 0;
    for (uint32_t place = 0; place < c->count; ++place) {
        const uint32_t row = pl_row_of_kind(registry, owners[place], kind);
        if (row == PL_ABSENT) {
            continue;
        }
        if (c->run_count > 0 && row == last->key + last->order &&
            place == last->value + last->order) {
            ++last->order;
            continue;
        }
        rising &= c->run_count == 0 || row > last->key;
        last = &runs_of(c)[c->run_count++];
        *last = (pl_keyed){ row, 1, place };
    }
    if (!rising) {
        pl_sort_keyed(runs_of(c), c->run_count);
    }
    c->viewed = pl_see(c, registry);
    return true;
}

void pl_view_add(plumb_body_view *view, const pl_component *c)
{
    const int k = view->components++;
    view->of[k].run = runs_of(c);
    view->of[k].end = c->run_count > 0 ? runs_of(c) + c->run_count : runs_of(c);
    view->of[k].values = c->values.data;
    view->of[k].stride = c->desc.size;
}

static bool reaches(const pl_keyed *run, uint32_t row)
{
    return run->key + run->order > row;
}

// The first of the runs from `run` on, which does not reach beyond a row, that does; `end`: none. By leaps
// that double.
static const pl_keyed *leap(const pl_keyed *run, const pl_keyed *end, uint32_t row)
{
    size_t reach = 1;
    while (reach < (size_t)(end - run) && !reaches(run + reach, row)) {
        run += reach;
        reach *= 2;
    }
    size_t low = 0, high = (size_t)(end - run);
    high = reach < high ? reach : high;
    while (high - low > 1) { // run[low] does not reach; run[high], if it is there, does
        size_t middle = low + (high - low) / 2;
        if (reaches(run + middle, row)) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return run + high;
}

// The first run of component k that reaches beyond a row; NULL: none. Mostly that of before, or the next.
static inline const pl_keyed *run_for(plumb_body_view *view, int k, uint32_t row)
{
    const pl_keyed *run = view->of[k].run, *end = view->of[k].end;
    if (run < end && !reaches(run, row)) {
        const bool next = run + 1 < end && reaches(run + 1, row);
        run = view->of[k].run = next ? run + 1 : leap(run, end, row);
    }
    return run < end ? run : NULL;
}

// The first row of the window, at or behind view->first, that all have, and behind which one lacks the next.
static bool find_common(plumb_body_view *view, uint32_t *end)
{
    uint32_t row = view->first;
    int agreed = 0;
    *end = view->last;
    for (int k = 0; agreed < view->components; k = k + 1 < view->components ? k + 1 : 0) {
        const pl_keyed *run = run_for(view, k, row);
        if (run == NULL || run->key >= view->last) {
            return false;
        }
        if (run->key > row) {
            row = (uint32_t)run->key;
            agreed = 0;
            *end = view->last;
        }
        const uint32_t until = (uint32_t)run->key + run->order;
        *end = until < *end ? until : *end;
        ++agreed;
    }
    view->first = row;
    return row < *end;
}

// Where the values of component k begin for a row of its run.
static inline void *values_at(const plumb_body_view *view, int k, uint32_t row)
{
    const pl_keyed *run = view->of[k].run;
    return view->of[k].values + (run->value + (row - (uint32_t)run->key)) * view->of[k].stride;
}

// Goes on in the window; false when nothing is left there.
static bool next_in_window(plumb_body_view *view)
{
    uint32_t end;
    if (view->first >= view->last || !find_common(view, &end)) {
        return false;
    }
    view->row = (int)view->first;
    view->count = (int)(end - view->first);
    for (int k = 0; k < view->components; ++k) {
        view->values[k] = values_at(view, k, view->first);
    }
    view->first = end;
    return true;
}

// The same where there is one component: most views, and a third of the price.
static inline bool next_run(plumb_body_view *view)
{
    const pl_keyed *run = run_for(view, 0, view->first);
    if (run == NULL || run->key >= view->last) {
        return false;
    }
    const uint32_t from = (uint32_t)run->key, until = from + run->order;
    const uint32_t first = from > view->first ? from : view->first;
    const uint32_t end = until < view->last ? until : view->last;
    view->row = (int)first;
    view->count = (int)(end - first);
    view->values[0] = values_at(view, 0, first);
    view->first = end;
    return first < end;
}

bool plumb_body_view_next(plumb_body_view *view)
{
    if (view == NULL || view->components == 0) {
        return false;
    }
    for (;;) {
        if (view->components == 1 ? next_run(view) : next_in_window(view)) {
            return true;
        }
        if (view->more_first >= view->more_last) {
            view->first = view->last;
            view->count = 0;
            return false;
        }
        view->first = view->more_first;
        view->last = view->more_last;
        view->more_first = view->more_last = 0;
    }
}

static void clip(uint32_t *first, uint32_t *last, uint32_t low, uint32_t high)
{
    *first = *first < low ? low : *first;
    *last = *last > high ? high : *last;
}

plumb_body_view plumb_body_view_part(const plumb_body_view *view, int first_row, int end_row)
{
    plumb_body_view part = { 0 };
    if (view != NULL) {
        part = *view;
        part.count = 0;
        const uint32_t low = first_row > 0 ? (uint32_t)first_row : 0;
        const uint32_t high = end_row > 0 ? (uint32_t)end_row : 0;
        clip(&part.first, &part.last, low, high);
        clip(&part.more_first, &part.more_last, low, high);
    }
    return part;
}
