// dissection.c - vertices that cut a component in two, and its parts again (nested dissection: George 1973, SIAM J. Numer. Anal. 10).
//
// A part is cut where one of a few functions of its vertices passes a value: differences of distances to vertices far from
// one another, each the farthest from those before. Of all functions and values that cut is taken that has the fewest vertices for the
// balance of what it leaves. What hardly has a shape (few cut it, or very many would) stays whole, and degrees tell its order.
//
// Reads: neighbours. Writes: the order of a component. Cost: O(neighbours) a level of parts, times the functions.
#include "core/dissection.h"

#include <string.h>

#define NONE UINT32_MAX

#define WHOLE 40 // vertices of a part that is not cut
#define THIN  2  // vertices that would cut it: degrees do as well
#define FAT   4  // so many times those that cut it, a part has at least
#define CROWDED                                                                                    \
    48 // neighbours of a vertex that is taken out before: all would be near by way of it
#define LANDMARKS 4

// How many times the distance to each landmark counts.
static const int functions[][LANDMARKS] = {
    { 1, -1, 0, 0 }, { 1, 1, -1, -1 }, { 1, -1, 1, -1 }, { 1, -1, -1, 1 }, { 0, 0, 1, -1 },
    { 1, 0, -1, 0 }, { 1, 0, 0, -1 },  { 0, 1, -1, 0 },  { 0, 1, 0, -1 },
};

typedef struct cutter {
    const pl_elimination *e;
    uint32_t *queue;               // vertices, in parts
    uint32_t *part;                // of a vertex; NONE: it cuts
    uint32_t *distance[LANDMARKS]; // of a vertex
    uint32_t *flooded, *value;     // scratch: vertices; the function of a vertex
    uint32_t *left, *cut, *other;  // of a value: how many have it, cut there from below, from above
    uint32_t parts;
} cutter;

// A way to cut a part.
typedef struct cut {
    double score; // less is better
    int function;
    uint32_t value; // what has at most this is one side
    bool above;     // what cuts is of the other
} cut;

// Distances from a vertex in its part. Returns how many vertices it reaches; they stand in `flooded`, the farthest last.
static uint32_t measure(const cutter *c, uint32_t from, uint32_t *distance)
{
    const pl_elimination *e = c->e;
    uint32_t count = 0;
    c->flooded[count++] = from;
    distance[from] = 0;
    for (uint32_t at = 0; at < count; ++at) {
        const uint32_t v = c->flooded[at];
        for (uint32_t k = 0; k < e->length[v]; ++k) {
            const uint32_t u = e->near[e->first[v] + k];
            if (c->part[u] == c->part[from] && distance[u] == NONE) {
                distance[u] = distance[v] + 1;
                c->flooded[count++] = u;
            }
        }
    }
    return count;
}

static void forget(const cutter *c, uint32_t first, uint32_t end, uint32_t *distance)
{
    for (uint32_t i = first; i < end; ++i) {
        distance[c->queue[i]] = NONE;
    }
}

// The vertex that is farthest from the nearest of so many landmarks, then from all; the last of those that `flooded` has.
static uint32_t farthest(const cutter *c, uint32_t count, int landmarks)
{
    uint32_t best = c->flooded[0], most = 0, most_sum = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t v = c->flooded[i];
        uint32_t least = NONE, sum = 0;
        for (int k = 0; k < landmarks; ++k) {
            const uint32_t d = c->distance[k][v];
            least = d < least ? d : least;
            sum += d;
        }
        if (least > most || (least == most && sum >= most_sum)) {
            best = v, most = least, most_sum = sum;
        }
    }
    return best;
}

// Distances to all landmarks. False: the part does not hang together; what does with its first vertex stands in `flooded`.
static bool survey(const cutter *c, uint32_t first, uint32_t end, uint32_t *reached)
{
    forget(c, first, end, c->distance[0]);
    *reached = measure(c, c->queue[first], c->distance[0]);
    if (*reached < end - first) {
        return false;
    }
    uint32_t from = c->flooded[*reached - 1];
    for (int k = 0; k < LANDMARKS; ++k) {
        forget(c, first, end, c->distance[k]);
        measure(c, from, c->distance[k]);
        from = farthest(c, *reached, k + 1);
    }
    return true;
}

// A function of the vertices of a part, from 0 on. Returns its largest value.
static uint32_t evaluate(const cutter *c, uint32_t first, uint32_t end, int function)
{
    int64_t low = INT64_MAX, high = INT64_MIN;
    for (int pass = 0; pass < 2; ++pass) {
        for (uint32_t i = first; i < end; ++i) {
            const uint32_t v = c->queue[i];
            int64_t sum = 0;
            for (int k = 0; k < LANDMARKS; ++k) {
                sum += functions[function][k] * (int64_t)c->distance[k][v];
            }
            low = sum < low ? sum : low;
            high = sum > high ? sum : high;
            c->value[v] = (uint32_t)(sum - low);
        }
    }
    return (uint32_t)(high - low);
}

// Lowest and highest value of a vertex and of its neighbours in the part.
static void range_of(const cutter *c, uint32_t v, uint32_t *low, uint32_t *high)
{
    const pl_elimination *e = c->e;
    *low = *high = c->value[v];
    for (uint32_t k = 0; k < e->length[v]; ++k) {
        const uint32_t u = e->near[e->first[v] + k];
        if (c->part[u] == c->part[v]) {
            *low = c->value[u] < *low ? c->value[u] : *low;
            *high = c->value[u] > *high ? c->value[u] : *high;
        }
    }
}

// Looks for a better cut by a function.
static void try_function(const cutter *c, uint32_t first, uint32_t end, int function, cut *best)
{
    const uint32_t most = evaluate(c, first, end, function), count = end - first;
    const size_t bytes = ((size_t)most + 2) * sizeof(uint32_t);
    memset(c->left, 0, bytes);
    memset(c->cut, 0, bytes);
    memset(c->other, 0, bytes);
    for (uint32_t i = first; i < end; ++i) {
        const uint32_t v = c->queue[i];
        uint32_t low, high;
        range_of(c, v, &low, &high);
        ++c->left[c->value[v]];
        ++c->cut[c->value[v]], --c->cut[high];    // from its own value to below the highest near it
        ++c->other[low], --c->other[c->value[v]]; // from the lowest near it to below its own
    }
    uint32_t left = 0, cuts[2] = { 0, 0 };
    for (uint32_t value = 0; value < most; ++value) {
        left += c->left[value], cuts[0] += c->cut[value], cuts[1] += c->other[value];
        for (int above = 0; above < 2; ++above) {
            const double one = (double)left - (above ? 0 : cuts[0]);
            const double two = (double)(count - left) - (above ? cuts[1] : 0);
            const double score = cuts[above] / (one * two);
            if (one > 0 && two > 0 && score < best->score) {
                *best = (cut){ score, function, value, above != 0 };
            }
        }
    }
}

static bool cuts(const cutter *c, const cut *by, uint32_t v)
{
    uint32_t low, high;
    range_of(c, v, &low, &high);
    return by->above ? c->value[v] > by->value && low <= by->value
                     : c->value[v] <= by->value && high > by->value;
}

// Sorts the vertices of a part: those of one side, of the other, what cuts. *middle, *last: where the second and the third begin.
static void sort_sides(cutter *c, const cut *by, uint32_t first, uint32_t end, uint32_t *middle,
                       uint32_t *last)
{
    uint32_t count = end - first, at = first;
    memcpy(c->flooded, c->queue + first, count * sizeof *c->flooded);
    uint8_t *side = (uint8_t *)c->left;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t v = c->flooded[i];
        side[i] = cuts(c, by, v) ? 2 : c->value[v] > by->value;
    }
    uint32_t *starts[3] = { NULL, middle, last };
    for (int s = 0; s < 3; ++s) {
        if (starts[s] != NULL) {
            *starts[s] = at;
        }
        for (uint32_t i = 0; i < count; ++i) {
            if (side[i] == s) {
                c->queue[at++] = c->flooded[i];
            }
        }
    }
}

static void name_part(cutter *c, uint32_t first, uint32_t end, uint32_t name)
{
    for (uint32_t i = first; i < end; ++i) {
        c->part[c->queue[i]] = name;
    }
}

// Cuts a part. False: it stays whole.
static bool cut_part(cutter *c, uint32_t first, uint32_t end, uint32_t *middle, uint32_t *last)
{
    uint32_t reached;
    if (end - first <= WHOLE) {
        return false;
    }
    if (!survey(c, first, end, &reached)) {
        uint32_t at = reached, from = end;
        for (uint32_t i = end; i-- > first;) { // what is not reached goes behind the others
            if (c->distance[0][c->queue[i]] == NONE) {
                const uint32_t v = c->queue[i];
                c->queue[i] = c->queue[--from];
                c->queue[from] = v;
            }
        }
        *middle = first + at, *last = end;
        return true;
    }
    cut best = { .score = 1e300, .function = -1 };
    for (size_t k = 0; k < sizeof functions / sizeof functions[0]; ++k) {
        try_function(c, first, end, (int)k, &best);
    }
    if (best.function < 0) {
        return false;
    }
    evaluate(c, first, end, best.function);
    sort_sides(c, &best, first, end, middle, last);
    return end - *last > THIN && (end - first) / FAT >= end - *last;
}

// What is crowded goes last.
static uint32_t take_crowded(cutter *c, uint32_t count)
{
    uint32_t kept = 0, crowded = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t v = c->queue[i];
        if (c->e->length[v] > CROWDED) {
            c->flooded[crowded++] = v;
        } else {
            c->queue[kept++] = v;
        }
    }
    memcpy(c->queue + kept, c->flooded, crowded * sizeof *c->queue);
    name_part(c, kept, count, NONE);
    return kept;
}

// Parts that are left, one after the other: ranges of the queue.
static void cut_all(cutter *c, uint32_t count, uint32_t *stack)
{
    uint32_t length = 0;
    stack[length++] = 0, stack[length++] = take_crowded(c, count);
    name_part(c, 0, stack[1], 0);
    c->parts = 1;
    while (length > 0) {
        const uint32_t end = stack[--length], first = stack[--length];
        uint32_t middle, last;
        if (!cut_part(c, first, end, &middle, &last)) {
            continue;
        }
        name_part(c, first, middle, c->parts++);
        name_part(c, middle, last, c->parts++);
        name_part(c, last, end, NONE);
        stack[length++] = first, stack[length++] = middle;
        stack[length++] = middle, stack[length++] = last;
    }
}

size_t pl_dissection_words(uint32_t vertices)
{
    return (LANDMARKS + 17) * (size_t)vertices + 16;
}

uint32_t pl_dissect(const pl_elimination *e, uint32_t *queue, uint32_t count, uint32_t *scratch)
{
    const size_t n = e->count;
    cutter c = { .e = e, .queue = queue };
    c.part = scratch, scratch += n;
    for (int k = 0; k < LANDMARKS; ++k) {
        c.distance[k] = scratch, scratch += n;
    }
    c.flooded = scratch, scratch += n;
    c.value = scratch, scratch += n;
    c.left = scratch, scratch += 4 * n + 2; // a function has fewer values
    c.cut = scratch, scratch += 4 * n + 2;
    c.other = scratch, scratch += 4 * n + 2;
    memset(c.part, 0xfe, n * sizeof *c.part);
    cut_all(&c, count, scratch);
    uint32_t kept = 0, late = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t v = queue[i];
        if (c.part[v] == NONE) {
            c.flooded[late++] = v;
        } else {
            queue[kept++] = v;
        }
    }
    memcpy(queue + kept, c.flooded, late * sizeof *queue);
    return kept;
}
