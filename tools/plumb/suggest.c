/// suggest.c - "did you mean": the nearest of some names, and lists of names in one text.
///
/// Cost: O(length of the word x length of the list).
#include "cli.h"

#include "../scene/slips.h"

static int minimum(int a, int b)
{
    return a < b ? a : b;
}

bool cli_member(const char *list, int index, char *out, size_t out_size)
{
    const char *at = list;
    if (index < 0) {
        return false; // "not given" where an option's value is an index
    }
    for (; index > 0; index--) {
        at = strchr(at, ',');
        if (at == NULL) {
            return false;
        }
        at++;
    }
    size_t length = strcspn(at, ",");
    if (length == 0 || length >= out_size) {
        return false;
    }
    memcpy(out, at, length);
    out[length] = '\0';
    return true;
}

int cli_slips(const char *word)
{
    // A third of the word may be wrong: "substpes" finds "substeps", "xyz" finds nothing.
    return minimum(3, ((int)strlen(word) + 2) / 3) + 1;
}

bool cli_nearer(const char *word, const char *name, int *slips)
{
    int found = sc_slips(word, name);
    // "sub" for "substeps": the beginning of a word is as good as one letter wrong.
    if (strlen(word) >= 2 && strncmp(word, name, strlen(word)) == 0) {
        found = minimum(found, 1);
    }
    bool nearer = found < *slips;
    *slips = minimum(found, *slips);
    return nearer;
}

int cli_nearest(const char *word, const char *names)
{
    char name[SC_SLIPS_LONGEST + 1];
    int best = -1, slips = cli_slips(word);
    for (int i = 0; cli_member(names, i, name, sizeof name); i++) {
        best = cli_nearer(word, name, &slips) ? i : best;
    }
    return best;
}
