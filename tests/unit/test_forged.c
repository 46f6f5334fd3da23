// test_forged.c - every number of an image is changed to what a stranger would try, with the checksum set right: the
// image is refused, or the world that it makes steps, answers and can be saved. What the fuzz harnesses look for by
// chance, place by place, whatever the order of the sections is.
//
// TRIALS=9: all places.
#include "fuzz/forge.h"

#include "snapshot/section.h"

#include "harness/trials.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static const uint32_t numbers[] = { 0,          1,          2,          UINT32_MAX, UINT32_MAX - 1,
                                    0x7fc00000, 0x7f800000, 0xff800000, 0x7f7fffff, 0x80000000,
                                    0x3f800000, 0xbf800000, 0x5368d4a5, 0x7ff80000, 0x00010101,
                                    0xc1000000 };
enum { NUMBERS = (int)(sizeof numbers / sizeof *numbers) };

// Every so many-th place: a prime, so that columns of all strides are met.
#ifdef __SANITIZE_ADDRESS__
enum { EVERY = 29 };
#else
enum { EVERY = 9 };
#endif

typedef struct forgery {
    const char *good; // an image of a world of that kind
    char *bytes;
    size_t size;
    int which;
    plumb_world *clean; // has taken nothing so far
    uint64_t tried, taken;
} forgery;

static plumb_world *make_clean(int which)
{
    return which == 3 ? make_world(3, 0) : make_empty();
}

static void try_number(forgery *f, char *at, uint32_t number)
{
    uint32_t before;
    memcpy(&before, at, sizeof before);
    memcpy(at, &number, sizeof number);
    mend_image(f->bytes, f->size);
    ++f->tried;
    if (plumb_world_restore(f->clean, f->bytes, f->size) == PLUMB_OK) {
        ++f->taken;
        live(f->clean);
        plumb_world_destroy(f->clean);
        f->clean = make_clean(f->which);
    }
    memcpy(at, &before, sizeof before);
}

static void forge_section(forgery *f, pl_image_cursor at, uint32_t *turn, uint32_t every)
{
    const size_t bytes = (size_t)at.entry.count * at.entry.stride;
    char *data = f->bytes + (at.data - f->good);
    for (size_t place = 0; place + 4 <= bytes; place += 4) {
        for (uint32_t k = 0; k < NUMBERS; ++k) {
            if ((*turn)++ % every == 0) {
                try_number(f, data + place, numbers[k]);
            }
        }
    }
}

static void test_every_number_is_checked(void **state)
{
    (void)state;
    const uint32_t more = trials_count(3), every = more < 3 * EVERY ? 3 * EVERY / more : 1;
    uint32_t turn = 0;
    for (int which = 0; which < WORLDS; ++which) {
        plumb_world *w = make_world(which, which == 1 ? 12 : 6);
        forgery f = { .which = which, .size = plumb_world_snapshot_size(w) };
        char *good = malloc(f.size);
        f.bytes = malloc(f.size);
        assert_true(good != NULL && f.bytes != NULL);
        assert_int_equal(plumb_world_save(w, good, f.size), PLUMB_OK);
        plumb_world_destroy(w);
        memcpy(f.bytes, good, f.size);
        f.good = good;
        f.clean = make_clean(which);
        pl_image view;
        assert_true(pl_image_view(good, f.size, &view));
        pl_image_cursor at = pl_image_begin(&view);
        for (uint64_t i = 0; i < view.header.section_count; ++i) {
            pl_image_next(&view, &at);
            forge_section(&f, at, &turn, every);
        }
        print_message("world %d: %u tried, %u taken\n", which, (unsigned)f.tried,
                      (unsigned)f.taken);
        assert_true(f.taken > 0 && f.taken < f.tried);
        plumb_world_destroy(f.clean);
        free(good);
        free(f.bytes);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_number_is_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
