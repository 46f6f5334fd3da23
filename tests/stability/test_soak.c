// test_soak.c - some thousand steps of the soak (harness/soak.h): `make soak` takes a million.
// PLUMB_LONG
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/soak.h"
#include "harness/trials.h"

static void a_busy_world_goes_twice_the_same_way(void **state)
{
    (void)state;
    const trials t = trials_from(1, 2);
    for (uint32_t seed = t.first; seed < t.end; ++seed) {
        soak_report report;
        if (!soak_run(&(soak_plan){ .steps = 800, .seed = seed }, &report)) {
            fail_msg("seed %u, step %u: %s", (unsigned)seed, (unsigned)report.fault_step,
                     report.fault);
        }
        // It was busy.
        assert_true(report.made > 40 && report.destroyed > 20);
        assert_true(report.fell_asleep > 0 && report.woke > 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_busy_world_goes_twice_the_same_way),
    };
    return cmocka_run_group_tests_name("soak", tests, NULL, NULL);
}
