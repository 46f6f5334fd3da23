// rollback.c - see rollback.h.
#include "harness/random.h"
#include "rollback.h"

#include <inttypes.h>
#include <stdlib.h>

#define KEPT    (ROLLBACK_MOST + 1)
#define REBASED 100 // steps after which frames get another base

typedef struct image {
    char *bytes;
    size_t room, size;
} image;

typedef struct history {
    image kept[KEPT]; // of step s in s % KEPT
    image base[2];    // frames of one base are given up before its place is needed again
    int base_of[KEPT];
    int bases;
    uint32_t seed;
} history;

static void make_room(image *i, size_t size)
{
    if (i->room < size) {
        i->room = size + size / 4;
        i->bytes = realloc(i->bytes, i->room);
        assert_non_null(i->bytes);
    }
}

static void keep(history *h, const plumb_world *world, int at, bool frames)
{
    image *i = &h->kept[at % KEPT];
    size_t size = plumb_world_snapshot_size(world);
    make_room(i, size);
    if (!frames) {
        i->size = size;
        assert_int_equal(plumb_world_save(world, i->bytes, i->room), PLUMB_OK);
        return;
    }
    if (at % REBASED == 0) {
        image *base = &h->base[++h->bases % 2];
        make_room(base, size);
        base->size = size;
        assert_int_equal(plumb_world_save(world, base->bytes, base->room), PLUMB_OK);
    }
    const image *base = &h->base[h->bases % 2];
    h->base_of[at % KEPT] = h->bases;
    assert_int_equal(
        plumb_world_save_frame(world, base->bytes, base->size, i->bytes, i->room, &i->size),
        PLUMB_OK);
    assert_true(i->size <= size);
}

static void go_back(const history *h, plumb_world *world, int to, bool frames)
{
    const image *i = &h->kept[to % KEPT];
    const image *base = &h->base[h->base_of[to % KEPT] % 2];
    assert_int_equal(
        frames ? plumb_world_restore_frame(world, base->bytes, base->size, i->bytes, i->size)
               : plumb_world_restore(world, i->bytes, i->size),
        PLUMB_OK);
}

static void check(const plumb_world *world, int at, uint64_t expected)
{
    uint64_t got = plumb_world_hash(world);
    if (got != expected) {
        print_error("step %d: %016" PRIx64 ", without going back %016" PRIx64 "\n", at, got,
                    expected);
    }
    assert_true(got == expected);
}

void rollback_reference(plumb_world *world, rollback_step *step, void *context, int steps,
                        uint64_t *hashes)
{
    for (int at = 0; at <= steps; ++at) {
        hashes[at] = plumb_world_hash(world);
        step(world, context);
    }
}

int rollback_run(plumb_world *world, plumb_world *other, rollback_step *step, void *context,
                 int steps, int most, bool frames, const uint64_t *hashes)
{
    static history h;
    h.seed = 7;
    h.bases = 0;
    int times = 0, newest = 0; // the newest step ever reached
    for (int at = 0; at < steps;) {
        check(world, at, hashes[at]);
        keep(&h, world, at, frames);
        newest = at > newest ? at : newest;
        if (at == newest && sim_random(&h.seed) % 4 == 0) {
            int back = 1 + (int)(sim_random(&h.seed) % (uint32_t)most);
            // Not beyond the first step, nor to one whose base is gone.
            if (at >= back && (!frames || h.base_of[at % KEPT] == h.base_of[(at - back) % KEPT])) {
                at -= back;
                if (other != NULL) {
                    plumb_world *left = world;
                    world = other;
                    other = left;
                }
                go_back(&h, world, at, frames);
                check(world, at, hashes[at]);
                ++times;
            }
        }
        step(world, context);
        ++at;
    }
    check(world, steps, hashes[steps]);
    for (int i = 0; i < KEPT; ++i) {
        free(h.kept[i].bytes);
    }
    free(h.base[0].bytes);
    free(h.base[1].bytes);
    h = (history){ 0 };
    return times;
}
