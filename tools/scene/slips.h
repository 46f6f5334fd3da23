// slips.h - how many slips of the pen lie between two words.
//
// The restricted Damerau-Levenshtein distance ("optimal string alignment"): letters inserted, left out,
// replaced, and neighbours swapped, each of which counts one. Cost: O(product of the lengths).
#ifndef SC_SLIPS_H
#define SC_SLIPS_H

#include <string.h>

enum { SC_SLIPS_LONGEST = 63 }; // letters of a word that is compared; longer ones are far from all

static inline int sc_slips(const char *a, const char *b)
{
    int rows[3][SC_SLIPS_LONGEST + 1];
    int a_count = (int)strlen(a), b_count = (int)strlen(b);
    if (a_count > SC_SLIPS_LONGEST || b_count > SC_SLIPS_LONGEST) {
        return 2 * SC_SLIPS_LONGEST;
    }
    for (int j = 0; j <= b_count; j++) {
        rows[0][j] = j;
    }
    for (int i = 1; i <= a_count; i++) {
        int *now = rows[i % 3];
        const int *last = rows[(i + 2) % 3], *before = rows[(i + 1) % 3];
        now[0] = i;
        for (int j = 1; j <= b_count; j++) {
            int least = last[j - 1] + (a[i - 1] != b[j - 1]);
            least = last[j] + 1 < least ? last[j] + 1 : least;
            least = now[j - 1] + 1 < least ? now[j - 1] + 1 : least;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] &&
                before[j - 2] + 1 < least) {
                least = before[j - 2] + 1;
            }
            now[j] = least;
        }
    }
    return rows[a_count % 3][b_count];
}

#endif
