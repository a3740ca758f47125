/* document_blocks.h: the blocks of code in the documents, for tests that run them.
 *
 * A block stands between ```LANGUAGE and ``` lines.  One that cannot be run carries a mark, a comment in the line above
 * it that readers do not see:
 *
 *     <!-- not run: it installs packages -->
 *
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>

/* Each block of `language` in all documents of the tree that is not marked: `check` gets the file's path and the text,
 * which ends with a new line and may be changed.  Returns how many there were. */
size_t each_document_block(const char *language, void (*check)(const char *file, char *text));

/* Every block, marked or not: its language ("" if it has none), and the reason of its mark or NULL. */
void each_document_fence(void (*look)(const char *file, const char *language, const char *mark));

/* Each line of the documents outside these blocks. */
void each_document_line(void (*look)(const char *file, const char *line));
