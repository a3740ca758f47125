/* suggest.h: "did you mean".
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The number of insertions, deletions, changes and swaps of neighbours that turn a into b, without regard
 * to case (optimal string alignment); texts beyond 63 bytes are cut. */
size_t edit_distance(const char *a, const char *b);

/* Holds the closest of the names offered so far. */
typedef struct suggestion {
    const char *word, *best;
    size_t distance;
} suggestion;

suggestion suggestion_start(const char *word);
void suggestion_offer(suggestion *s, const char *name);

/* The best name if it is close enough to be what was meant, else NULL. */
const char *suggestion_get(const suggestion *s);

#ifdef __cplusplus
}
#endif
