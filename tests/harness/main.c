// main.c - one program of the tests of a folder. It runs the one by whose name it is called, or that is its first
// argument. The build gives the names: TESTS is TEST(test_a) TEST(test_b) ..., and the main of each file has
// the file's name.
#include "harness/main.h"

#include <stdio.h>
#include <string.h>

#define TEST(name) int name(void);
TESTS
#undef TEST

#define TEST(name) { #name, name },
static const struct {
    const char *name;
    int (*run)(void);
} tests[] = { TESTS };
#undef TEST

enum { COUNT = sizeof tests / sizeof tests[0] };

int test_argument_count;
char **test_arguments;

static int find(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash != NULL ? slash + 1 : path;
    int i = 0;
    while (i < COUNT && strcmp(tests[i].name, name) != 0) {
        ++i;
    }
    return i;
}

int main(int argc, char **argv)
{
    for (int first = 0; first < argc && first < 2; ++first) {
        const int i = find(argv[first]);
        if (i < COUNT) {
            test_argument_count = argc - first;
            test_arguments = argv + first;
            return tests[i].run();
        }
    }
    fprintf(stderr, "usage: %s test; tests:\n", argv[0]);
    for (int i = 0; i < COUNT; ++i) {
        fprintf(stderr, "    %s\n", tests[i].name);
    }
    return 2;
}
