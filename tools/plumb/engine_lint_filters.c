/// engine_lint_filters.c - lint: filters that let a shape meet no other, and bodies that begin inside one another.
#include "engine_lint.h"

/// Shapes of equal filters, on bodies that move or do not.
typedef struct filter_kind {
    plumb_filter filter;
    bool moves, several; ///< of several bodies
    plumb_body body;     ///< the first that has one
} filter_kind;

enum { FILTER_KINDS = 256 };

/// What meets everything, or nothing on purpose, says nothing of others.
static bool is_filtered(const plumb_filter *f)
{
    const bool meets_all =
        f->category <= 1 && (f->mask == 0 || f->mask == UINT64_MAX) && f->group == 0;
    return !meets_all && !f->nothing;
}

static bool are_equal(const plumb_filter *a, const plumb_filter *b)
{
    return a->category == b->category && a->mask == b->mask && a->group == b->group &&
           a->nothing == b->nothing;
}

/// Collects them; -1: there are too many to tell.
static int collect_filters(const lint_job *job, filter_kind *kinds)
{
    int count = 0;
    for (int i = 0; i < pl_lint_body_count(job); i++) {
        plumb_shape *list;
        const plumb_body body = pl_lint_body_at(job, i);
        const bool moves = plumb_body_get_type(job->world, body) != PLUMB_STATIC;
        const int shapes = pl_lint_shapes_of(job, body, &list);
        for (int s = 0; s < shapes; s++) {
            const plumb_filter f = plumb_shape_filter(job->world, list[s]);
            int k = 0;
            while (k < count && !(kinds[k].moves == moves && are_equal(&kinds[k].filter, &f))) {
                k++;
            }
            if (k == FILTER_KINDS) {
                return -1;
            }
            if (k == count) {
                kinds[count++] = (filter_kind){ .filter = f, .moves = moves, .body = body };
            }
            kinds[k].several |= !plumb_same(kinds[k].body, body);
        }
    }
    return count;
}

static bool meets_soft(const lint_job *job, const plumb_filter *filter)
{
    plumb_softbody all[256];
    const int count = plumb_world_softbodies(job->world, all, 256);
    bool meets = count > 256; // nobody looks through so many
    for (int i = 0; i < count && !meets; i++) {
        plumb_softbody_desc d;
        meets = plumb_softbody_settings(job->world, all[i], &d) == PLUMB_OK &&
                plumb_filters_meet(*filter, d.filter);
    }
    return meets;
}

void pl_lint_filters(lint_job *job)
{
    filter_kind kinds[FILTER_KINDS];
    const int count = collect_filters(job, kinds);
    for (int i = 0; i < count && pl_lint_body_count(job) > 1; i++) {
        // A group that is negative says that it is not to meet its own.
        bool meets = !is_filtered(&kinds[i].filter) || kinds[i].filter.group < 0;
        for (int k = 0; k < count && !meets; k++) {
            meets = (kinds[i].moves || kinds[k].moves) && (i != k || kinds[i].several) &&
                    plumb_filters_meet(kinds[i].filter, kinds[k].filter);
        }
        meets = meets || meets_soft(job, &kinds[i].filter);
        if (!meets) {
            pl_lint_tell(
                job,
                "the filter of '%s' (category 0x%llx, mask 0x%llx) meets no shape of the scene",
                pl_lint_name_of(job, kinds[i].body), (unsigned long long)kinds[i].filter.category,
                (unsigned long long)kinds[i].filter.mask);
        }
    }
}

void pl_lint_overlaps(lint_job *job)
{
    const engine_overlap *list;
    const int count = pl_session_overlaps(job->session, &list);
    job->failed |= count < 0;
    for (int i = 0; i < count; i++) {
        pl_lint_tell(job, "'%s' and '%s' begin %.3g m inside one another", list[i].a, list[i].b,
                     list[i].depth);
    }
}
