/// suggest.c - "did you mean": the nearest of some names, and lists of names in one text.
///
/// The edit distance is the restricted Damerau-Levenshtein one ("optimal string alignment"): a
/// swap of neighbours counts one, since that is the commonest slip of fingers.
/// Cost: O(length of the word x length of the list).
#include "cli.h"

#include <string.h>

/// Longest word that suggestions are looked for.
enum { WORD_MAX = 48 };

static int minimum(int a, int b)
{
    return a < b ? a : b;
}

static int edit_distance(const char *a, const char *b)
{
    int rows[3][WORD_MAX + 1];
    int *before = rows[0], *above = rows[1], *row = rows[2];
    int a_count = (int)strlen(a), b_count = (int)strlen(b);

    if (a_count > WORD_MAX || b_count > WORD_MAX) {
        return WORD_MAX;
    }
    for (int j = 0; j <= b_count; j++) {
        above[j] = j;
        before[j] = 0;
    }
    for (int i = 1; i <= a_count; i++) {
        row[0] = i;
        for (int j = 1; j <= b_count; j++) {
            int change = above[j - 1] + (a[i - 1] != b[j - 1]);
            row[j] = minimum(change, minimum(above[j], row[j - 1]) + 1);
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                row[j] = minimum(row[j], before[j - 2] + 1);
            }
        }
        int *spare = before;
        before = above;
        above = row;
        row = spare;
    }
    return above[b_count];
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

int cli_nearest(const char *word, const char *names)
{
    char name[WORD_MAX + 1];
    // A third of the word may be wrong: "substpes" finds "substeps", "xyz" finds nothing.
    int best = -1, best_distance = 1 + minimum(3, ((int)strlen(word) + 2) / 3);

    for (int i = 0; cli_member(names, i, name, sizeof name); i++) {
        int distance = edit_distance(word, name);
        // "sub" for "substeps": the beginning of a word is as good as one letter wrong.
        if (strlen(word) >= 2 && strncmp(word, name, strlen(word)) == 0) {
            distance = minimum(distance, 1);
        }
        if (distance < best_distance) {
            best = i;
            best_distance = distance;
        }
    }
    return best;
}
