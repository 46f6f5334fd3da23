// test_sparse.c - snapshot/sparse.h: what is put is got back, what is cut off is damaged, and how little is
// written for how much.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "harness/random.h"
#include "snapshot/sparse.h"

enum { MOST = 700, ROOM = 4096 };

static size_t code(const char *to, const char *from, size_t bytes, unsigned char *out, size_t room)
{
    pl_sparse_coder c = { .to = out, .size = room };
    pl_sparse_put_number(&c, (uint32_t)bytes);
    pl_sparse_put(&c, to, from, bytes / 3); // in any parts
    pl_sparse_put(&c, to + bytes / 3, from == NULL ? NULL : from + bytes / 3, bytes - bytes / 3);
    pl_sparse_end(&c);
    pl_sparse_put_number(&c, UINT32_MAX);
    return c.used;
}

static bool decode(const unsigned char *in, size_t size, const char *from, size_t bytes, char *to)
{
    pl_sparse_decoder d = { .from = in, .size = size };
    bool good = pl_sparse_get_number(&d) == bytes;
    size_t first = bytes / 2;
    pl_sparse_get(&d, to, from, first);
    pl_sparse_get(&d, to + first, from == NULL ? NULL : from + first, bytes - first);
    pl_sparse_drop(&d);
    good &= pl_sparse_get_number(&d) == UINT32_MAX;
    return good && !d.damaged;
}

static void what_is_put_is_got_back(void **state)
{
    (void)state;
    uint32_t seed = 7;
    for (int round = 0; round < 400; ++round) {
        char from[MOST], to[MOST], got[MOST];
        unsigned char coded[ROOM];
        size_t bytes = sim_random(&seed) % MOST;
        uint32_t rare = 1 + sim_random(&seed) % 60;
        for (size_t i = 0; i < bytes; ++i) {
            from[i] = (char)(sim_random(&seed) % 256);
            to[i] = (sim_random(&seed) % rare) == 0 ? (char)(sim_random(&seed) % 256) : from[i];
        }
        const char *base = round % 5 == 0 ? NULL : from;
        size_t size = code(to, base, bytes, coded, ROOM);
        assert_in_range(size, 1, ROOM);
        assert_true(decode(coded, size, base, bytes, got));
        assert_memory_equal(got, to, bytes);
        for (size_t cut = 0; cut < size; cut += 1 + size / 9) {
            assert_false(decode(coded, cut, base, bytes, got));
        }
        // What has no room is counted, and not written.
        unsigned char small[8] = { 0 };
        assert_int_equal(code(to, base, bytes, small, 7), size);
        assert_int_equal(small[7], 0);
    }
}

static void what_is_alike_costs_next_to_nothing(void **state)
{
    (void)state;
    static const char zeros[64 * PL_SPARSE_GROUP];
    static char one[64 * PL_SPARSE_GROUP];
    unsigned char coded[ROOM];
    const size_t frame = 2 + 5; // the two numbers
    // A count of groups; one byte that differs: the groups before it, three bytes, the groups behind.
    assert_int_equal(code(zeros, NULL, sizeof zeros, coded, ROOM), frame + 2);
    one[1000] = 9;
    assert_int_equal(code(one, zeros, sizeof one, coded, ROOM), frame + 2 + 3 + 2);
    // The last three digits of every number: half a byte more than those three bytes, and a byte for eight.
    for (size_t i = 0; i < sizeof one; ++i) {
        one[i] = (char)(i % 4 == 3 ? 0 : 1);
    }
    assert_int_equal(code(one, zeros, sizeof one, coded, ROOM), frame + 64 * (1 + 4 + 24));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_put_is_got_back),
        cmocka_unit_test(what_is_alike_costs_next_to_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
