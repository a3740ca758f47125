/* suggest.c: the name that was probably meant.
 * SPDX-License-Identifier: MIT */
#include "suggest.h"

#include <ctype.h>
#include <stdint.h>
#include <string.h>
#include <strings.h>

enum { LONGEST = 63 };

static size_t smallest(size_t a, size_t b)
{
    return a < b ? a : b;
}

size_t edit_distance(const char *a, const char *b)
{
    const size_t n = strnlen(a, LONGEST), m = strnlen(b, LONGEST);
    size_t rows[3][LONGEST + 1]; /* of the table, the last three */
    for (size_t j = 0; j <= m; j++) rows[0][j] = j;
    for (size_t i = 1; i <= n; i++) {
        const size_t *two_above = rows[(i + 1)%3], *above = rows[(i + 2)%3];
        size_t *row = rows[i%3];
        row[0] = i;
        for (size_t j = 1; j <= m; j++) {
            const int p = tolower((unsigned char)a[i - 1]), q = tolower((unsigned char)b[j - 1]);
            row[j] = smallest(smallest(above[j], row[j - 1]) + 1, above[j - 1] + (p != q));
            if (i > 1 && j > 1 && p == tolower((unsigned char)b[j - 2]) && q == tolower((unsigned char)a[i - 2]))
                row[j] = smallest(row[j], two_above[j - 2] + 1);
        }
    }
    return rows[n%3][m];
}

suggestion suggestion_start(const char *word)
{
    return (suggestion){word, NULL, SIZE_MAX};
}

void suggestion_offer(suggestion *s, const char *name)
{
    const size_t length = strlen(s->word);
    size_t distance = edit_distance(s->word, name);
    if (distance > 0 && length >= 2 && strncasecmp(s->word, name, length) == 0) distance = 1; /* an abbreviation */
    if (distance < s->distance) {
        s->distance = distance;
        s->best = name;
    }
}

const char *suggestion_get(const suggestion *s)
{
    const size_t length = strlen(s->word);
    const size_t allowed = length < 3 ? 1 : length < 6 ? 2 : 3;
    return s->best && s->distance <= allowed ? s->best : NULL;
}
