/* words.h: text as a canvas draws it: valid UTF-8, in stretches that are level, raised or lowered.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Longer text is cut, behind a whole character. */
enum { WORDS_CAP = 1024 };

/* Copies text; a `?` replaces each byte that is not part of a UTF-8 character, and each control character. */
void words_clean(const char *text, char clean[WORDS_CAP]);

/* Copies the stretch at *text, which moves behind it, and returns 1 if it is raised, -1 if it is lowered, 0 otherwise.
 * In formulas `^` and `_` mark these, before one character or a group in braces. */
int words_next(const char **text, bool is_formula, char stretch[WORDS_CAP]);

#ifdef __cplusplus
}
#endif
